//! Limits, figures, comparisons and bands of studies.

use super::running::{done, teeter};
use super::{study, table};
use std::path::{Path, PathBuf};

/// ω² times the largest displacement of an oscillator of this period and 5 % damping, whose support is
/// accelerated by one sine of 0.2 s, linear between 20 values, then and in the free vibration of 0.5 s after it: by the
/// classical Runge–Kutta method.
pub(super) fn oscillator(period: f64) -> f64 {
    let value = |k: u32| (std::f64::consts::PI * 0.1 * f64::from(k)).sin();
    let ground = |t: f64| {
        let k = ((t / 0.01).floor() as u32).min(19);
        let part = t / 0.01 - f64::from(k);
        if t < 0.2 { value(k) + (value(k + 1) - value(k)) * part } else { 0.0 }
    };
    let omega = std::f64::consts::TAU / period;
    let rate = |t: f64, [x, v]: [f64; 2]| [v, -ground(t) - 2.0 * 0.05 * omega * v - omega * omega * x];
    let (h, mut state, mut largest) = (1e-5, [0.0, 0.0], 0.0_f64);
    for k in 0..70_000_u32 {
        let t = h * f64::from(k);
        let after = |slope: [f64; 2], h: f64| [state[0] + h * slope[0], state[1] + h * slope[1]];
        let a = rate(t, state);
        let b = rate(t + 0.5 * h, after(a, 0.5 * h));
        let c = rate(t + 0.5 * h, after(b, 0.5 * h));
        let d = rate(t + h, after(c, h));
        let mean = [0, 1].map(|i| (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]) / 6.0);
        state = after(mean, h);
        largest = largest.max(state[0].abs());
    }
    omega * omega * largest
}

/// The folder of sweeps of the project.
fn sweeps() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../sweeps")
}

/// Theory §9: the amplitudes A/(g tan α) from which one sine overturns the block after one impact.
#[test]
fn the_limit_of_overturning_is_that_of_the_formula() {
    let sweep = "scene = \"block-under-one-sine.toml\"\n[grid]\nsignal.shake.frequency = [\"2 Hz\", \"3 Hz\"]\n\
        [find]\nkey = \"signal.shake.scale\"\nlow = 1.01\nhigh = 2.2\ntolerance = 1e-4\nuntil = \"overturned\"\n";
    let folder = study("limits", sweep);
    std::fs::copy(sweeps().join("block-under-one-sine.toml"), folder.join("block-under-one-sine.toml")).unwrap();
    let told = done(&folder, &["sweep", "sweep.toml", "--out", "out"]);
    assert!(told.contains("a bisection sees one limit of several"), "{told}");
    let rows = table(&folder.join("out/results.csv"));
    let header = "case,signal.shake.frequency,signal.shake.scale,find.beside,find.at_low,find.at_high,find.changes,find.runs,\
        overturned_at,status,unsolved_steps,warnings,error";
    assert_eq!(rows[0].join(","), header);
    for (row, limit) in rows[1..].iter().zip([1.2237, 1.4019]) {
        let cell = |k: usize| row[k].parse::<f64>().unwrap();
        // The bracket, and four digits of the table.
        assert!(cell(2) - cell(3) <= 1e-4 && cell(2) > cell(3), "{row:?}");
        assert!((cell(2) - limit).abs() < 3e-4, "{row:?}");
        assert_eq!(row[4..8], ["no", "yes", "1", "16"], "{row:?}");
        assert!(cell(8) > 0.0 && row[9] == "stopped", "the run at the limit overturns: {row:?}");
    }
    // Both sides of the window in which it overturns after one impact are safe.
    let sweep = sweep.replace("high = 2.2", "high = 2.34").replace("\"2 Hz\", \"3 Hz\"", "\"2 Hz\"");
    std::fs::write(folder.join("sweep.toml"), &sweep).unwrap();
    done(&folder, &["sweep", "sweep.toml", "--out", "blind"]);
    let rows = table(&folder.join("blind/results.csv"));
    assert_eq!(rows[1][9], "no-limit", "{rows:?}");
    assert_eq!(rows[1][2], "", "{rows:?}");
    std::fs::write(folder.join("sweep.toml"), sweep.replace("[find]\n", "[find]\nscan = 4\n")).unwrap();
    let told = done(&folder, &["sweep", "sweep.toml", "--out", "seen"]);
    assert!(told.contains("in 1 of 1 case there are several limits"), "{told}");
    let rows = table(&folder.join("seen/results.csv"));
    assert_eq!(rows[1][4..7], ["no", "no", "2"], "{rows:?}");
    assert!((rows[1][2].parse::<f64>().unwrap() - 1.2237).abs() < 3e-4, "{rows:?}");
}

/// A block on ground shaken by three pulses of different length, each scaled to six peaks.
fn shaken_study(name: &str) -> PathBuf {
    let sweep = "scene = \"shaken.toml\"\n[grid]\nground.motion.x.record = { files = \"pulse-*.csv\" }\n\
        ground.motion.x.peak = [\"2.5 m/s^2\", \"3.2 m/s^2\", \"3.8 m/s^2\", \"5 m/s^2\", \"7 m/s^2\", \"10 m/s^2\"]\n\
        [outputs]\nlargest = \"max_phi_over_alpha\"\n\
        [fragility]\nevent = \"overturned\"\nintensity = \"ground.motion.x.peak\"\n\
        [distribution]\nof = \"largest\"\nat_most = 1\n";
    let folder = study(name, sweep);
    for (k, frequency) in [2.0, 4.0, 6.0].into_iter().enumerate() {
        let value = |t: f64| if t * frequency <= 1.0 { (std::f64::consts::TAU * frequency * t).sin() } else { 0.0 };
        let rows: String = (0..=200).map(|k| 0.01 * f64::from(k)).map(|t| format!("{t:.2},{}\n", value(t))).collect();
        std::fs::write(folder.join(format!("pulse-{k}.csv")), rows).unwrap();
    }
    let scene = "[time]\nend = '2 s'\nstep = '1 ms'\nstop = ['overturned']\n[material.m]\ndensity = '1000 kg/m^3'\n[ground]\n\
        [ground.motion.x]\nrecord = 'pulse-0.csv'\n\
        [block.b]\nmaterial = 'm'\nwidth = '5 cm'\nheight = '20 cm'\ndepth = '5 cm'\non = 'ground'\nat = '0 m'\n\
        [contact.f]\nbetween = ['b', 'ground']\nfriction = 2\n";
    std::fs::write(folder.join("shaken.toml"), scene).unwrap();
    folder
}

#[test]
fn a_study_has_its_figures_and_shards_lead_to_the_same() {
    let folder = shaken_study("figures");
    done(&folder, &["sweep", "sweep.toml", "--out", "all"]);
    let rows = table(&folder.join("all/fragility.csv"));
    let column = |name: &str| rows[1][rows[0].iter().position(|cell| cell == name).unwrap()].as_str();
    let number = |name: &str| column(name).parse::<f64>().unwrap();
    assert_eq!([column("cases"), column("groups"), column("error")], ["18", "3", ""]);
    assert!(number("median") > 2.5 && number("median") < 10.0 && number("beta") > 0.0, "{rows:?}");
    assert!(number("median_low") <= number("median") && number("median") <= number("median_high"), "{rows:?}");
    // What is observed is what the table of results has.
    let results = table(&folder.join("all/results.csv"));
    let overturned = results[0].iter().position(|cell| cell == "overturned_at").unwrap();
    let seen = results[1..].iter().filter(|row| !row[overturned].is_empty()).count();
    assert_eq!(number("events"), seen as f64);
    let data = table(&folder.join("all/fragility_data.csv"));
    assert_eq!(data[1..].iter().map(|row| row[4].parse::<usize>().unwrap()).sum::<usize>(), seen);
    let page = std::fs::read_to_string(folder.join("all/study.html")).unwrap();
    assert!(
        page.contains("id=\"fragility\"")
            && page.contains("id=\"distribution\"")
            && !page.contains("http-equiv=\"refresh")
    );
    // Columns are named as one would say them.
    assert!(page.contains("Peak acceleration of ground x (m/s²)") && !page.contains(">ground.motion.x.peak"), "{page}");
    let shares = table(&folder.join("all/distribution.csv"));
    assert_eq!(shares.last().unwrap()[3], "1.0");
    for shard in ["1", "2"] {
        let (part, number) = (format!("part-{shard}"), format!("{shard}/2"));
        done(&folder, &["sweep", "sweep.toml", "--out", &part, "--shard", &number]);
        assert!(!folder.join(&part).join("study.html").exists(), "a part of the cases has no figures");
    }
    done(&folder, &["sweep", "--merge", "part-1", "part-2", "--out", "merged"]);
    for file in ["results.csv", "fragility.csv", "fragility_curves.csv", "distribution.csv", "figures/fragility.svg"] {
        let bytes = |name: &str| std::fs::read(folder.join(name).join(file)).unwrap();
        assert_eq!(bytes("merged"), bytes("all"), "{file}");
    }
}

#[test]
fn studies_are_compared_and_a_study_does_not_differ_from_itself() {
    let folder = shaken_study("compared");
    done(&folder, &["sweep", "sweep.toml", "--out", "one"]);
    let scene = std::fs::read_to_string(folder.join("shaken.toml")).unwrap();
    std::fs::write(folder.join("shaken.toml"), scene.replace("'20 cm'", "'17 cm'")).unwrap();
    done(&folder, &["sweep", "sweep.toml", "--out", "squat"]);
    let told = teeter(&folder, &["sweep", "--compare", "one", "one", "--out", "same"]);
    let said = String::from_utf8(told.stdout).unwrap();
    assert!(
        said.contains(
            "the median of `one` is 1 times that of `one`, 95 % from 1 to 1 (the same records drawn for both)"
        ),
        "{said}"
    );
    assert!(said.contains("(largest distance 0, Kolmogorov–Smirnov p = 1)"), "{said}");
    done(&folder, &["sweep", "--compare", "one", "squat", "--out", "both"]);
    let rows = table(&folder.join("both/fragility.csv"));
    let median = |row: &[String]| row[2].parse::<f64>().unwrap();
    assert_eq!((rows[1][0].as_str(), rows[2][0].as_str()), ("one", "squat"));
    assert!(median(&rows[2]) > 1.05 * median(&rows[1]), "a squatter block takes more: {rows:?}");
    // Of the same name, studies are told apart by the folders that they are in.
    for (study, above) in [("one", "a"), ("squat", "b")] {
        std::fs::create_dir_all(folder.join(above)).unwrap();
        std::fs::rename(folder.join(study), folder.join(above).join("s")).unwrap();
    }
    done(&folder, &["sweep", "--compare", "a/s", "b/s", "--out", "named"]);
    let named = table(&folder.join("named/fragility.csv"));
    assert_eq!((named[1][0].as_str(), named[2][0].as_str()), ("a/s", "b/s"));
    for (study, above) in [("one", "a"), ("squat", "b")] {
        std::fs::rename(folder.join(above).join("s"), folder.join(study)).unwrap();
    }
    let tests = table(&folder.join("both/distribution_tests.csv"));
    assert_eq!((tests.len(), tests[1][0].as_str(), tests[1][1].as_str()), (2, "squat", "one"));
    let refused = teeter(&folder, &["sweep", "--compare", "one", "none", "--out", "x"]);
    assert_eq!(refused.status.code(), Some(2));
    let again = teeter(&folder, &["sweep", "--compare", "one", "squat", "--out", "both"]);
    assert_eq!(again.status.code(), Some(2), "results are not overwritten");
}

/// Until the block has turned back, larger tilts lie farther out: the bands are those of the runs with the tilts at these shares.
#[test]
fn bands_are_quantiles_of_the_motions() {
    let sweep = "scene = \"rocking.toml\"\n[grid]\nblock.rocker.tilt = { from = \"1 deg\", to = \"9 deg\", count = 41 }\n\
        [bands]\nof = \"rocker.phi\"\nuntil = \"50 ms\"\ntimes = 5\n";
    let folder = study("bands", sweep);
    done(&folder, &["sweep", "sweep.toml", "--out", "all"]);
    let (bands, results) = (table(&folder.join("all/bands.csv")), table(&folder.join("all/results.csv")));
    assert_eq!(bands[0].join(","), "study,t,cases,p2.5,p16,median,p84,p97.5");
    assert_eq!((bands.len(), results.len()), (7, 42));
    let place = results[0].iter().position(|name| name == "rocker.phi@0.05").unwrap();
    let number = |cell: &String| cell.parse::<f64>().unwrap();
    let of_case = |case: usize| number(&results[1 + case][place]).abs();
    let last: Vec<f64> = bands[6][3..].iter().map(|cell| number(cell).abs()).collect();
    let mut shown = [last[0], last[2], last[4]];
    shown.sort_by(f64::total_cmp);
    // A share of 2.5 % of 41 cases is the second, and 97.5 % the last but one.
    for (found, case) in shown.iter().zip([1, 20, 39]) {
        assert!((found - of_case(case)).abs() < 1e-12, "{case}: {found} {}", of_case(case));
    }
    let page = std::fs::read_to_string(folder.join("all/study.html")).unwrap();
    assert!(page.contains("id=\"bands\"") && page.contains("φ of rocker (rad)"), "no figure");
    for (text, told) in [
        ("of = \"rocker.phy\"\nuntil = \"50 ms\"", "rocker.phy"),
        ("of = \"rocker.phi\"\nuntil = \"5 s\"", "after the end of the runs"),
        ("of = \"rocker.phi\"\nuntil = 5", "with its unit"),
        ("of = \"rocker.phi\"\nuntil = \"5 kg\"", "bands.until"),
        ("until = \"5 s\"", "bands.of"),
        ("of = \"rocker.phi\"\nuntil = \"50 s\"", "bands.until = \"50 s\""),
        ("of = \"rocker.phi\"\nuntil = \"50 s\"", "after the end of the runs, t = "),
        ("of = \"rocker.phi\"\nuntil = \"50 ms\"\ntimes = 0", "bands.times"),
    ] {
        let sweep = format!("scene = \"rocking.toml\"\n[grid]\nblock.rocker.tilt = [\"2 deg\"]\n[bands]\n{text}\n");
        std::fs::write(folder.join("wrong.toml"), sweep).unwrap();
        let output = teeter(&folder, &["sweep", "wrong.toml", "--out", "wrong"]);
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(!output.status.success() && error.contains(told), "{text}: {error}");
        assert_eq!(error.matches("error: ").count(), 1, "{text}: {error}");
    }
}

#[test]
fn whether_a_block_overturned_is_an_output() {
    let sweep = "scene = \"rocking.toml\"\n[grid]\nblock.rocker.tilt = [\"2 deg\", \"14 deg\"]\ntime.end = [\"1 s\"]\n\
        [outputs]\nover = \"overturned\"\n";
    let folder = study("overturned", sweep);
    done(&folder, &["sweep", "sweep.toml", "--out", "all"]);
    let rows = table(&folder.join("all/results.csv"));
    let place = rows[0].iter().position(|name| name == "over").unwrap();
    assert_eq!([rows[1][place].as_str(), rows[2][place].as_str()], ["false", "true"]);
}
