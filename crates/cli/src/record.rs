//! `teeter record`.

use crate::console::{Console, print};
use crate::render::Presenter;
use crate::run::Exit;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use teeter_record::{Record, STANDARD_GRAVITY};
use teeter_report::{RecordSummary, Results, record_figures, record_page, spectrum_periods};
use teeter_scenario::diagnostic::{Diagnostic, Diagnostics};
use teeter_scenario::dimension::Dimension;
use teeter_scenario::quantity;
use teeter_scenario::readable::{shortest, with_digits, with_unit};
use teeter_scenario::record_alone;
use teeter_scenario::scene::RecordScene;

/// All files that it may write.
const FILES: [&str; 5] = ["record.json", "record.csv", "record.html", "figures/records.svg", "figures/spectra.svg"];

/// Damping ratio of the spectrum.
const DAMPING_RATIO: f64 = 0.05;

/// Natural periods of the spectrum that are printed, s.
const PRINTED_PERIODS: [f64; 8] = [0.1, 0.2, 0.3, 0.5, 1.0, 2.0, 3.0, 5.0];

#[derive(Debug)]
pub(crate) struct Options {
    pub(crate) file: PathBuf,
    /// The corrections, by the keys of a recorded motion in a scene.
    pub(crate) keys: Vec<(String, String)>,
    pub(crate) json: bool,
    /// Width of the figures, m.
    pub(crate) figure_width: f64,
    pub(crate) out: Option<PathBuf>,
    pub(crate) force: bool,
}

/// The option of commands that write figures with their results.
#[derive(Clone, Copy, Debug, clap::Args)]
pub(crate) struct FigureWidth {
    /// Width of the figures: 84 mm and 174 mm are one and two columns of most journals
    #[arg(long = "figure-width", value_name = "WIDTH", default_value = "120 mm", value_parser = figure_width)]
    pub(crate) metres: f64,
}

/// `84 mm` and the like, in m.
pub(crate) fn figure_width(text: &str) -> Result<f64, String> {
    match quantity::parse(text, Dimension::LENGTH) {
        Ok(width) if (0.06..=0.3).contains(&width) => Ok(width),
        Ok(_) => Err("figures are 60 mm to 300 mm wide, such as \"84 mm\"".to_owned()),
        Err(error) => Err(error.to_string()),
    }
}

pub(crate) fn record(options: &Options) -> Exit {
    let console = Console::new(false);
    let name = options.file.display().to_string();
    let refused = |text: &str| {
        console.error(text);
        Exit::BadInput
    };
    let unreadable =
        |why: String| Diagnostics::from(Diagnostic::error(&name, format!("the record can't be read: {why}")));
    let found = teeter_run::read_regular(&options.file, teeter_record::LARGEST_FILE)
        .map_err(unreadable)
        .and_then(|bytes| record_alone(&name, &bytes, &options.keys));
    let scene = match found {
        Ok(scene) => scene,
        Err(found) => return refused(&Presenter::new("").all(&as_options(found))),
    };
    let held = Held::new(&name, &scene, &options.keys);
    let results = match &options.out {
        None => None,
        Some(folder) => {
            let free = Results::spares(&FILES, folder, std::slice::from_ref(&options.file))
                .and_then(|()| Results::create_of(&FILES, folder, options.force));
            match free {
                Ok(results) => Some(results),
                Err(error) => return refused(&format!("error: {error}")),
            }
        }
    };
    let text = if options.json { held.json_text() } else { held.text() };
    let written =
        results.map_or(Ok(()), |results| held.write(&results, options.figure_width).map_err(|error| error.to_string()));
    match print(&text).and(written) {
        Ok(()) => Exit::FinishedRun,
        Err(why) => {
            console.error(&format!("error: {why}"));
            Exit::Failed
        }
    }
}

/// Remedies that name keys of a scene, with the options of this command instead.
fn as_options(mut found: Diagnostics) -> Diagnostics {
    for remedy in found.0.iter_mut().filter_map(|finding| finding.remedy.as_mut()) {
        for key in ["step", "component", "period", "unit"] {
            *remedy = remedy
                .replace(&format!("add {key}, such as {key} = "), &format!("add --{key} "))
                .replace(&format!("{key} = "), &format!("--{key} "));
        }
        *remedy = remedy.replace("leave this key out", "leave this option out");
    }
    found
}

/// What a record holds, as used.
struct Held<'a> {
    name: &'a str,
    scene: &'a Arc<RecordScene>,
    keys: &'a [(String, String)],
    numbers: RecordSummary,
}

impl<'a> Held<'a> {
    fn new(name: &'a str, scene: &'a Arc<RecordScene>, keys: &'a [(String, String)]) -> Self {
        Self { name, scene, keys, numbers: RecordSummary::new(scene) }
    }

    fn record(&self) -> &Record {
        &self.scene.record
    }

    /// The corrections in words; empty for none.
    fn corrections(&self) -> String {
        self.keys.iter().map(|(key, value)| format!("{key} = {value}")).collect::<Vec<_>>().join(", ")
    }

    /// The part that `--from` and `--to` leave, as it holds whole steps and ends with the file.
    fn part(&self) -> Option<String> {
        let time = |key: &str| {
            let (_, text) = self.keys.iter().find(|(name, _)| name == key)?;
            quantity::parse(text, Dimension::TIME).ok()
        };
        let (from, to) = (time("from"), time("to"));
        from.or(to)?;
        let dt = self.record().dt();
        // As a cut does, which keeps the values between both times.
        let start = (from.unwrap_or(0.0) / dt - 1e-6).ceil().max(0.0) * dt;
        let end = start + self.record().duration();
        let times = [start, end].map(|t| with_digits(t, "s", 9));
        let ends = match to {
            Some(to) if to >= end + (1.0 - 1e-6) * dt => ", where the record ends",
            _ => "",
        };
        let off = |wanted: Option<f64>, got: f64| wanted.is_some_and(|t| (t - got).abs() > 1e-6 * dt);
        let whole = if ends.is_empty() && (off(from, start) || off(to, end)) {
            ": the values between these times, as none is interpolated"
        } else {
            ""
        };
        Some(format!("{} to {}{ends}{whole}", times[0], times[1]))
    }

    fn text(&self) -> String {
        let (record, numbers) = (self.record(), &self.numbers);
        let [a, v, d] = [record.acceleration_peak(), record.velocity_peak(), record.displacement_peak()];
        let [velocity, displacement] = self.record().at_the_end();
        let mut lines = vec![
            [self.name, &numbers.station, &numbers.description]
                .into_iter()
                .filter(|part| !part.is_empty())
                .collect::<Vec<_>>()
                .join(", "),
        ];
        let mut row = |name: &str, text: String| lines.push(format!("  {name:<22}{text}"));
        row(
            "values",
            format!(
                "{}, every {}, over {}",
                record.len(),
                with_digits(record.dt(), "s", 9),
                with_digits(record.duration(), "s", 9)
            ),
        );
        if record.assumes_its_unit() {
            row("unit", "m/s^2, as the file names none; --unit gives another".to_owned());
        }
        if let Some(part) = self.part() {
            row("part used", part);
        }
        if !self.keys.is_empty() {
            row("corrections", self.corrections());
        }
        // Digits enough to compare with those that come with the record.
        let gravities = shortest(a.size / STANDARD_GRAVITY, 5);
        let peak = format!("{} m/s^2 = {gravities} gn at {}", shortest(a.size, 5), with_digits(a.time, "s", 5));
        row("peak acceleration", peak);
        row("peak velocity", format!("{} at {}", with_digits(v.size, "m/s", 5), with_digits(v.time, "s", 5)));
        row("peak displacement", format!("{} at {}", with_digits(d.size, "m", 5), with_digits(d.time, "s", 5)));
        let arias = format!(
            "{}, linear between values; {} by the plain sum",
            with_digits(numbers.arias_intensity, "m/s", 5),
            with_digits(record.arias_sum(), "m/s", 5)
        );
        row("Arias intensity", arias);
        match record.husid_times([0.05, 0.95]) {
            Ok([from, to]) => {
                let [long, from, to] = [to - from, from, to].map(|t| with_unit(t, "s"));
                row("5 % to 95 % of it", format!("{long}, from {from} to {to}"));
            }
            Err(why) => row("5 % to 95 % of it", why.to_string()),
        }
        row(
            "at the end",
            format!("velocity {}, displacement {}", with_unit(velocity, "m/s"), with_unit(displacement, "m")),
        );
        if let Ok(responses) = record.spectrum(DAMPING_RATIO, &PRINTED_PERIODS) {
            row("spectrum, 5 % damping", "period T, pseudo-acceleration Sa, displacement Sd".to_owned());
            for of in responses {
                let [sa, sd] = [of.pseudo_acceleration(), 1e3 * of.displacement].map(|x| shortest(x, 4));
                row("", format!("{:>4} s {sa:>10} m/s^2 {sd:>10} mm", of.period));
            }
        }
        lines.join("\n") + "\n"
    }

    fn json(&self) -> Value {
        let record = self.record();
        let [velocity, displacement] = self.record().at_the_end();
        let mut value = serde_json::to_value(&self.numbers).unwrap_or_default();
        let peaks = [record.acceleration_peak(), record.velocity_peak(), record.displacement_peak()];
        let periods = spectrum_periods();
        let spectrum: Vec<Value> = record
            .spectrum(DAMPING_RATIO, &periods)
            .unwrap_or_default()
            .iter()
            .map(|of| {
                json!({
                    "period": of.period,
                    "pseudo_acceleration": of.pseudo_acceleration(),
                    "displacement": of.displacement,
                    "velocity": of.velocity,
                    "acceleration": of.acceleration,
                })
            })
            .collect();
        let more = json!({
            "file": self.name,
            "values": record.len(),
            "corrections": self.keys.iter().map(|(key, value)| (key.clone(), json!(value))).collect::<serde_json::Map<_, _>>(),
            "peak_acceleration_gn": peaks[0].size / STANDARD_GRAVITY,
            "peak_acceleration_time": peaks[0].time,
            "peak_velocity_time": peaks[1].time,
            "peak_displacement_time": peaks[2].time,
            "arias_sum": record.arias_sum(),
            "significant": record.husid_times([0.05, 0.95]).ok(),
            "final_velocity": velocity,
            "final_displacement": displacement,
            "damping_ratio": DAMPING_RATIO,
            "spectrum": spectrum,
        });
        if let (Some(value), Value::Object(more)) = (value.as_object_mut(), more) {
            // It names the place in a scene, and here there is none.
            value.remove("motion");
            value.extend(more);
        }
        value
    }

    fn json_text(&self) -> String {
        format!("{:#}\n", self.json())
    }

    fn csv(&self) -> String {
        let record = self.record();
        let (velocities, displacements) = record.motion();
        let mut text = String::from("t,a,v,d\n");
        for (k, a) in record.accelerations().iter().enumerate() {
            let (v, d) = (velocities.get(k).copied().unwrap_or(0.0), displacements.get(k).copied().unwrap_or(0.0));
            text.push_str(&format!("{:?},{a:?},{v:?},{d:?}\n", record.time(k)));
        }
        text
    }

    fn write(&self, results: &Results, figure_width: f64) -> Result<(), teeter_report::ResultsError> {
        results.write("record.csv", self.csv())?;
        for (name, svg) in record_figures(self.scene, 1e3 * figure_width) {
            results.write(&format!("figures/{name}"), svg)?;
        }
        let corrections = match self.corrections() {
            none if none.is_empty() => "as recorded".to_owned(),
            some => some,
        };
        let file = Path::new(self.name).file_name().map_or_else(|| self.name.into(), |name| name.to_string_lossy());
        results.write("record.html", record_page(self.scene, &file, &corrections))?;
        results.write("record.json", self.json_text())
    }
}
