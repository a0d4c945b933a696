//! The recorded earthquakes of `../shared/records`, against the numbers beside them.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::path::{Path, PathBuf};

use teeter_record::{Format, Record, STANDARD_GRAVITY};

/// The folder of records; none where this isn't a working copy beside it.
fn folder() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/records");
    if folder.join("records.csv").is_file() {
        return Some(folder);
    }
    println!("skipped: there is no {}", folder.display());
    None
}

/// What the table says of a file: number of values, step, peak in g, Arias intensity.
fn table(folder: &Path) -> BTreeMap<String, [f64; 4]> {
    let text = std::fs::read_to_string(folder.join("records.csv")).unwrap();
    let row = |line: &str| {
        let (file, rest) = line.split_once(',').unwrap();
        // The title has commas, and numbers stand behind it.
        let numbers: Vec<f64> = rest.rsplit(',').take(4).map(|cell| cell.parse().unwrap()).collect();
        (file.to_owned(), [numbers[3], numbers[2], numbers[1], numbers[0]])
    };
    text.lines().skip(1).map(row).collect()
}

fn records(folder: &Path) -> impl Iterator<Item = (String, Record, [f64; 4])> {
    let folder = folder.to_owned();
    table(&folder).into_iter().map(move |(file, numbers)| {
        let bytes = std::fs::read(folder.join(&file)).unwrap();
        assert_eq!(Format::of(&String::from_utf8_lossy(&bytes)), Ok(Format::Peer), "{file}");
        let record = Record::read(&bytes, &file).unwrap_or_else(|error| panic!("{file}: {error}"));
        (file, record, numbers)
    })
}

#[test]
fn peaks_and_intensities_are_those_of_the_table() {
    let Some(folder) = folder() else { return };
    let mut count = 0;
    for (file, record, [values, dt, pga, arias]) in records(&folder) {
        assert_eq!((record.len() as f64, record.dt()), (values, dt), "{file}");
        // The table has seven digits of the peak and ten of the intensity.
        let peak = record.peak_acceleration() / STANDARD_GRAVITY;
        assert!((peak - pga).abs() <= 0.5000001e-7, "{file}: {peak} {pga}");
        let a = record.accelerations();
        let factor = PI / (2.0 * STANDARD_GRAVITY) * dt;
        let sum = record.arias_sum();
        let digit = 10f64.powf(arias.log10().floor() - 9.0);
        assert!((sum - arias).abs() <= 0.500001 * digit, "{file}: {sum} {arias}");
        assert!((sum - arias).abs() <= 1e-9, "{file}: {sum} {arias}");
        // The table sums squares; of linear pieces each square of a difference counts a sixth less,
        // and both ends half.
        let ends = 0.5 * (a[0].powi(2) + a[a.len() - 1].powi(2));
        let differences = a.windows(2).map(|a| (a[1] - a[0]).powi(2)).sum::<f64>() / 6.0;
        let exact = sum - factor * (ends + differences);
        assert!((record.arias_intensity() / exact - 1.0).abs() < 1e-12, "{file}");
        count += 1;
    }
    assert_eq!(count, 40);
}

#[test]
fn titles_and_stations_are_read() {
    let Some(folder) = folder() else { return };
    for (file, record, _) in records(&folder) {
        assert!(!record.station().is_empty(), "{file}: {}", record.description());
        assert!(record.significant_duration() > 0.0 && record.significant_duration() < record.duration(), "{file}");
    }
    let bytes = std::fs::read(folder.join("AZF225.AT2")).unwrap();
    let record = Record::read(&bytes, "AZF225").unwrap();
    assert_eq!(record.station(), "ANZA FIRE STATION");
    assert_eq!(record.description(), "ANZA 02/25/80 1047, ANZA FIRE STATION, 225 (USGS STATION 5160)");
}

/// What is known of a spectrum whatever the record.
#[test]
fn spectra_have_their_limits() {
    let Some(folder) = folder() else { return };
    for (file, record, _) in records(&folder).step_by(8) {
        let (pga, pgd) = (record.peak_acceleration(), record.displacement_peak().size);
        let [stiff, middle] = <[_; 2]>::try_from(record.spectrum(0.05, &[record.dt() * 0.25, 0.3]).unwrap()).unwrap();
        assert!((stiff.acceleration / pga - 1.0).abs() < 0.01, "{file}: {} {pga}", stiff.acceleration);
        // The softest stays behind by the ground's displacement, and if that goes on evenly after the record swings up to
        // √(d² + (v/ω)²).
        let (mut v, mut d) = (0.0, 0.0);
        for a in record.accelerations().windows(2) {
            d += record.dt() * (v + record.dt() * (2.0 * a[0] + a[1]) / 6.0);
            v += 0.5 * record.dt() * (a[0] + a[1]);
        }
        let soft = record.spectrum(0.0, &[1e5]).unwrap()[0].displacement;
        let bound = pgd.max(d.hypot(v * 1e5 / (2.0 * PI)));
        assert!((soft / bound - 1.0).abs() < 1e-3, "{file}: {soft} {bound}");
        // Damping only takes: Sd falls with it.
        let less = record.spectrum(0.2, &[0.3]).unwrap()[0];
        assert!(less.displacement < middle.displacement, "{file}");
    }
}
