//! Fragility curves.

use super::super::Sweep;
use super::super::criterion::Criterion;
use super::super::spec::{Node, Reader, entries};
use super::label::{common, label};
use super::{Ensemble, SHARE_ROOM, StudyFigure, digits, text};
use crate::statistics::{LognormalFit, NoFit, Observation, interval, resamples};
use crate::write::quoted;
use std::collections::BTreeMap;
use std::fmt::Write;
use teeter_plot::{Axis, AxisError, Figure, Legend, Mark, Panel, Series};
use toml::de::DeTable;

/// `[fragility]` of a sweep file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fragility {
    pub(crate) event: Criterion,
    /// Columns; a curve over each.
    pub(crate) intensities: Vec<String>,
    /// Their labels on the axes; as many, or none.
    labels: Vec<String>,
}

const WORDS: [&str; 3] = ["event", "intensity", "label"];
const EXAMPLE: &str = "such as event = \"overturned\" and intensity = \"ground.motion.x.peak\"";

/// Figures of a study: one for each intensity.
const MOST_INTENSITIES: usize = 4;
/// Of what the intervals hold the middle.
const CONFIDENCE: f64 = 0.95;
const RESAMPLES: u64 = 1000;
const SEED: u64 = 20_150_521;
/// A curve with a smaller p is said not to describe the cases.
const DOUBTFUL: f64 = 0.01;
/// Points of a curve in its table and figure.
const POINTS: usize = 121;
/// What is drawn of each study, beside its name.
const SYMBOLS: &str = "line: lognormal fit; band: 95 % of resampled fits; marks: shares of the cases";
/// Different intensities up to which shares are those at each; above, those of groups.
const MOST_STRIPES: usize = 40;
/// Groups of equally many cases for clouds.
const GROUPS: usize = 10;

impl Fragility {
    pub(super) fn read(reader: &mut Reader<'_>, table: &DeTable<'_>, node: &Node<'_, '_>) -> Option<Self> {
        let (mut event, mut intensities, mut labels) = (None, Vec::new(), Vec::new());
        for (word, value) in entries(table) {
            let path = format!("fragility.{word}");
            match word {
                "event" => event = Some(Criterion::read(reader, &path, &value)?),
                "intensity" | "label" => {
                    let items = value.array().unwrap_or_else(|| vec![value]);
                    let texts =
                        items.iter().map(|item| text(reader, &path, item, EXAMPLE)).collect::<Option<Vec<_>>>()?;
                    if word == "label" { labels = texts } else { intensities = texts }
                }
                other => {
                    reader.unknown(&path, &value, other, &WORDS);
                    return None;
                }
            }
        }
        let (Some(event), false) = (event, intensities.is_empty()) else {
            reader.wrong("fragility", Some(node), "event and intensity belong together", EXAMPLE);
            return None;
        };
        if intensities.len() > MOST_INTENSITIES {
            let rule = format!("at most {MOST_INTENSITIES} intensities");
            reader.wrong("fragility.intensity", Some(node), &rule, "leave some out");
            return None;
        }
        if !labels.is_empty() && labels.len() != intensities.len() {
            reader.wrong("fragility.label", Some(node), "a label for each intensity is expected", "or leave it out");
            return None;
        }
        Some(Self { event, intensities, labels })
    }

    /// The keys whose values tell the groups of cases apart that aren't independent.
    pub(super) fn grouping_keys<'s>(&self, sweep: &'s Sweep) -> Vec<&'s str> {
        let keys = sweep.keys();
        // Over an output each case has its own intensity, and runs of one record belong together however
        // it is scaled.
        let scales = |key: &str| is_size(key) || self.intensities.iter().any(|name| name == key);
        // Of cases that differ in other properties, too, those under one record are still not independent.
        let by_record = keys.iter().any(|key| is_record(key));
        let tells = |key: &&str| if by_record { is_record(key) } else { !scales(key) };
        keys.into_iter().filter(tells).collect()
    }

    fn label(&self, place: usize, study: &Ensemble) -> String {
        let column = self.intensities.get(place).map(String::as_str).unwrap_or_default();
        self.labels.get(place).cloned().unwrap_or_else(|| label(&study.sweep, column))
    }
}

/// Keys of a motion that set the size of its record.
const SIZES: [&str; 5] = ["scale", "peak", "peak_velocity", "arias", "spectral_acceleration"];

/// Whether a key sets the size of a motion and leaves its shape: of a signal that is its scale alone.
fn is_size(key: &str) -> bool {
    let parts: Vec<&str> = key.split('.').collect();
    match parts.as_slice() {
        ["signal", _, last] => *last == "scale",
        [.., "motion", last] | [.., "motion", _, last] => SIZES.contains(last),
        _ => false,
    }
}

/// Whether a key names the record of a motion.
fn is_record(key: &str) -> bool {
    key.contains("motion.") && key.ends_with(".record")
}

/// The observations of a study, with the group of each: the cases under one record or, without records that vary, those that differ
/// in the intensity and the size of the motion alone.
struct Seen {
    observations: Vec<Observation>,
    /// By group, in the order of the groups' names.
    groups: Vec<Vec<Observation>>,
    names: Vec<String>,
    /// Of cases whose event or intensity isn't there.
    notes: Vec<String>,
}

impl Seen {
    fn of(study: &Ensemble, asked: &Fragility, column: &str) -> Self {
        let event = asked.event.column(study.sweep.outputs()).unwrap_or_default();
        let cells = study.table.completed(event);
        let intensities = study.table.numbers(column);
        let others: Vec<Vec<&str>> =
            asked.grouping_keys(&study.sweep).into_iter().map(|key| study.table.completed(key)).collect();
        let mut groups: BTreeMap<String, Vec<Observation>> = BTreeMap::new();
        let mut observations = Vec::new();
        for (k, (cell, intensity)) in cells.iter().zip(&intensities).enumerate() {
            let event = asked.event.holds(cell, study.sweep.outputs());
            let Some(event) = event.filter(|_| intensity.is_finite()) else { continue };
            let seen = Observation { intensity: *intensity, event };
            observations.push(seen);
            let alone = || k.to_string();
            let name = others.iter().filter_map(|column| column.get(k).copied()).collect::<Vec<_>>().join("\u{1f}");
            groups.entry(if others.is_empty() { alone() } else { name }).or_default().push(seen);
        }
        let mut notes: Vec<String> = Vec::new();
        if let Some(absent) = asked.event.absent(&cells, study.sweep.outputs()) {
            notes.push(if study.name.is_empty() { absent } else { format!("`{}`: {absent}", study.name) });
        }
        if cells.len() > observations.len() {
            let what = format!("a number for the event or for {column}");
            notes.push(study.left_out(cells.len() - observations.len(), &what));
        }
        let (names, groups) = groups.into_iter().unzip();
        Self { observations, groups, names, notes }
    }

    /// Fits of resampled groups, in the order of the draws.
    fn resampled(&self) -> Vec<Option<LognormalFit>> {
        let fit = |draw: Vec<usize>| {
            let drawn: Vec<Observation> =
                draw.iter().filter_map(|group| self.groups.get(*group)).flatten().copied().collect();
            LognormalFit::of(&drawn).ok()
        };
        resamples(self.groups.len(), RESAMPLES, SEED).map(fit).collect()
    }

    /// At each intensity, or in groups of equally many cases where there are many intensities.
    fn shares(&self) -> Shares {
        let mut sorted = self.observations.clone();
        sorted.sort_by(|a, b| a.intensity.total_cmp(&b.intensity));
        let count = |part: &[Observation]| {
            let mean = part.iter().map(|seen| seen.intensity.ln()).sum::<f64>() / part.len() as f64;
            let one = part.iter().all(|seen| seen.intensity == part[0].intensity);
            let middle = if one { part[0].intensity } else { mean.exp() };
            (middle, part.len(), part.iter().filter(|seen| seen.event).count())
        };
        let stripes: Vec<_> = sorted.chunk_by(|a, b| a.intensity == b.intensity).map(count).collect();
        if stripes.len() <= MOST_STRIPES {
            return Shares { of: stripes, grouped: false };
        }
        let cases = sorted.len();
        let group = |k: usize| count(&sorted[k * cases / GROUPS..(k + 1) * cases / GROUPS]);
        Shares { of: (0..GROUPS).map(group).collect(), grouped: true }
    }
}

/// Shares of cases with the event, as marked in the figure.
struct Shares {
    /// Intensity, cases and events; of a group its geometric mean.
    of: Vec<(f64, usize, usize)>,
    /// Whether they are those of groups of cases rather than of single intensities.
    grouped: bool,
}

/// A curve with its confidence.
struct Curve {
    seen: Seen,
    fit: Result<LognormalFit, NoFit>,
    resampled: Vec<Option<LognormalFit>>,
}

impl Curve {
    fn of(seen: Seen) -> Self {
        let fit = LognormalFit::of(&seen.observations);
        let resampled = if fit.is_ok() { seen.resampled() } else { Vec::new() };
        Self { seen, fit, resampled }
    }

    fn fits(&self) -> impl Iterator<Item = &LognormalFit> {
        self.resampled.iter().flatten()
    }

    fn band(&self, of: impl Fn(&LognormalFit) -> f64) -> [f64; 2] {
        interval(self.fits().map(of).collect(), CONFIDENCE).unwrap_or([f64::NAN; 2])
    }

    /// The ratio of medians, other over this, with its interval: groups of the same names are drawn
    /// together.
    fn ratio(&self, other: &Self) -> Option<(f64, [f64; 2], bool)> {
        let (ours, theirs) = (self.fit.as_ref().ok()?, other.fit.as_ref().ok()?);
        let paired = self.seen.names == other.seen.names;
        let mut of_others: Vec<Option<LognormalFit>> = other.resampled.clone();
        if !paired {
            // Independent draws: any other order than ours.
            of_others.rotate_left(1);
        }
        let both = self.resampled.iter().zip(&of_others);
        let ratios = both.filter_map(|(a, b)| Some(b.as_ref()?.median / a.as_ref()?.median)).collect();
        Some((theirs.median / ours.median, interval(ratios, CONFIDENCE)?, paired))
    }
}

/// The figure of one study, or of several side by side.
pub(super) fn figure(studies: &[Ensemble]) -> Result<StudyFigure, AxisError> {
    let mut parts = Parts::default();
    let mut panels = Vec::new();
    let asked: Vec<&Fragility> = studies.iter().filter_map(|study| study.sweep.wanted().fragility.as_ref()).collect();
    let places = asked.iter().map(|asked| asked.intensities.len()).min().unwrap_or(0);
    for place in 0..places {
        let curves: Vec<Curve> = studies
            .iter()
            .zip(&asked)
            .map(|(study, asked)| Curve::of(Seen::of(study, asked, &asked.intensities[place])))
            .collect();
        let labels: Vec<String> = asked.iter().zip(studies).map(|(asked, study)| asked.label(place, study)).collect();
        let label = common(&labels);
        panels.push((label.clone(), parts.panel(studies, &label, &curves)?));
        parts.compared(studies, &label, &curves);
    }
    let mut notes = parts.notes;
    notes.push(format!(
        "P(event | x) = Φ(ln(x/θ)/β) by maximum likelihood over the cases. Bands and intervals hold {} % of {RESAMPLES} fits to \
         groups drawn with replacement. A group is the cases under one record, as these are not independent; in a study whose record doesn't \
         vary, the cases whose keys but the intensity and the scale of the motion are the same.",
        100.0 * CONFIDENCE
    ));
    let event = asked.first().map(|asked| asked.event.clause()).unwrap_or_default();
    let title = format!("Fragility: probability that {event}");
    let mut all = panels.into_iter();
    let (_, (axis, panel)) = match all.next() {
        Some(first) => first,
        None => (String::new(), (Axis::between("", 0.0, 1.0), Panel::new(Axis::between("", 0.0, 1.0)))),
    };
    let figure = Figure::new("fragility", title.clone(), axis).legend(Legend::Rows).panel(panel);
    let more: Vec<_> = (2..)
        .zip(all)
        .map(|(k, (label, (axis, panel)))| {
            (label, Figure::new(&format!("fragility-{k}"), title.clone(), axis).legend(Legend::Rows).panel(panel))
        })
        .collect();
    Ok(StudyFigure {
        name: "fragility",
        title,
        figure,
        more,
        tables: vec![
            ("fragility.csv", parts.fits),
            ("fragility_curves.csv", parts.curves),
            ("fragility_data.csv", parts.data),
        ],
        notes,
        summary: (
            ["Study", "Intensity", "Median θ", "95 % of θ", "Dispersion β", "95 % of β", "Cases", "Events", "Records"]
                .map(str::to_owned)
                .into(),
            parts.rows,
        ),
    })
}

/// Says which cases each mark stands for, where it isn't those of one intensity.
fn grouping(about: &str, cases: usize) -> String {
    let size = match (cases / GROUPS, cases.div_ceil(GROUPS)) {
        (size, same) if size == same => size.to_string(),
        (least, most) => format!("{least} or {most}"),
    };
    format!(
        "{about}: as there are more than {MOST_STRIPES} different intensities, the marks (fragility_data.csv) are shares in {GROUPS} groups \
         of {size} cases each, in the order of their intensity and at the geometric mean of a group’s intensities."
    )
}

/// The tables and sentences, as they grow.
struct Parts {
    fits: String,
    curves: String,
    data: String,
    notes: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Default for Parts {
    fn default() -> Self {
        Self {
            fits: "study,intensity,median,median_low,median_high,beta,beta_low,beta_high,log_likelihood,cases,events,\
                groups,resamples,resamples_without_fit,error\n"
                .to_owned(),
            curves: "study,intensity,x,probability,low,high\n".to_owned(),
            data: "study,intensity,x,cases,events\n".to_owned(),
            notes: Vec::new(),
            rows: Vec::new(),
        }
    }
}

impl Parts {
    fn panel(&mut self, studies: &[Ensemble], label: &str, curves: &[Curve]) -> Result<(Axis, Panel), AxisError> {
        let observed = curves.iter().flat_map(|curve| curve.seen.observations.iter().map(|seen| seen.intensity));
        let positive: Vec<f64> = observed.filter(|x| *x > 0.0).collect();
        let (low, high) = (
            positive.iter().copied().reduce(f64::min).unwrap_or(0.1),
            positive.iter().copied().reduce(f64::max).unwrap_or(1.0),
        );
        let axis = Axis::logarithmic(label, [low, high])?;
        let grid: Vec<f64> = (0..POINTS).map(|k| low * (high / low).powf(k as f64 / (POINTS - 1) as f64)).collect();
        let mut series = Vec::new();
        for (number, (study, curve)) in studies.iter().zip(curves).enumerate() {
            let start = format!("{},{}", quoted(&study.name), quoted(label));
            let shares = curve.seen.shares();
            if shares.grouped {
                self.notes.push(grouping(&study.about(label), curve.seen.observations.len()));
            }
            for (x, cases, events) in &shares.of {
                let _ = writeln!(self.data, "{start},{x:?},{cases},{events}");
            }
            self.fit(study, label, curve, &start);
            let points = shares.of.iter().map(|(x, cases, events)| (*x, *events as f64 / *cases as f64));
            if let Ok(fit) = &curve.fit {
                let bands: Vec<(f64, f64, f64)> = grid
                    .iter()
                    .map(|&x| {
                        let [low, high] = curve.band(|fit| fit.probability(x));
                        let _ = writeln!(self.curves, "{start},{x:?},{:?},{low:?},{high:?}", fit.probability(x));
                        (x, low, high)
                    })
                    .collect();
                series.push(Series::area("", bands).number(number));
                let line = grid.iter().map(|&x| (x, fit.probability(x)));
                series.push(Series::line(study.name.clone(), line.collect::<Vec<_>>()).number(number));
            }
            let name = if curve.fit.is_ok() { "" } else { study.name.as_str() };
            series.push(Series::marks(name, points.collect::<Vec<_>>(), Mark::of(number)).number(number));
        }
        let panel = Panel::new(Axis::between("Probability", -SHARE_ROOM, 1.0 + SHARE_ROOM)).with(series);
        Ok((axis, panel.note(SYMBOLS.to_owned())))
    }

    fn fit(&mut self, study: &Ensemble, label: &str, curve: &Curve, start: &str) {
        let (cases, groups) = (curve.seen.observations.len(), curve.seen.groups.len());
        let events = curve.seen.observations.iter().filter(|seen| seen.event).count();
        let failed = curve.resampled.iter().filter(|fit| fit.is_none()).count();
        match &curve.fit {
            Ok(fit) => {
                let ([a, b], [c, d]) = (curve.band(|fit| fit.median), curve.band(|fit| fit.beta));
                let LognormalFit { median, beta, log_likelihood } = fit;
                let _ = writeln!(
                    self.fits,
                    "{start},{median:?},{a:?},{b:?},{beta:?},{c:?},{d:?},{log_likelihood:?},{cases},{events},{groups},\
                     {RESAMPLES},{failed},"
                );
                let range = |low: f64, high: f64| format!("{} to {}", digits(low), digits(high));
                self.rows.push(vec![
                    study.name.clone(),
                    label.to_owned(),
                    digits(*median),
                    range(a, b),
                    digits(*beta),
                    range(c, d),
                    cases.to_string(),
                    events.to_string(),
                    groups.to_string(),
                ]);
                self.doubted(&study.about(label), fit, curve);
                if failed > 0 {
                    self.notes.push(format!(
                        "{}: {failed} of {RESAMPLES} resamples have no fit and are left out of the intervals, which \
                         are too narrow then.",
                        study.about(label)
                    ));
                }
            }
            Err(why) => {
                let _ =
                    writeln!(self.fits, "{start},,,,,,,,{cases},{events},{groups},0,0,{}", quoted(&why.to_string()));
                self.notes.push(format!("{}: no curve, as {why}.", study.about(label)));
            }
        }
        let incomplete = study.table.incomplete();
        let incomplete = (incomplete > 0).then(|| study.left_out(incomplete, "a result"));
        for note in curve.seen.notes.iter().cloned().chain(incomplete) {
            if !self.notes.contains(&note) {
                self.notes.push(note);
            }
        }
    }

    /// Tells of a curve that doesn't describe the cases.
    fn doubted(&mut self, about: &str, fit: &LognormalFit, curve: &Curve) {
        let Some(misfit) = fit.misfit(&curve.seen.observations).filter(|misfit| misfit.p < DOUBTFUL) else { return };
        let [low, high] = misfit.range.map(digits);
        let place = if low == high { format!("at {low}") } else { format!("from {low} to {high}") };
        self.notes.push(format!(
            "{about}: the lognormal curve doesn't describe these cases: {place} the event comes in {} of {}, where the curve lets one expect \
             {:.1} (χ², p = {}). Use the shares observed (fragility_data.csv); median, dispersion and the ends of the curve rest on its form.",
            misfit.events,
            misfit.cases,
            misfit.expected,
            digits(misfit.p)
        ));
    }

    /// The ratios of medians to that of the first study.
    fn compared(&mut self, studies: &[Ensemble], label: &str, curves: &[Curve]) {
        let (Some((first, rest)), Some(study)) = (curves.split_first(), studies.first()) else { return };
        for (other, curve) in studies.iter().skip(1).zip(rest) {
            let Some((ratio, [low, high], paired)) = first.ratio(curve) else { continue };
            let says = if low > 1.0 || high < 1.0 { "the medians differ" } else { "the medians can't be told apart" };
            let drawn = if paired { "the same records drawn for both" } else { "drawn independently" };
            self.notes.push(format!(
                "{label}: the median of `{}` is {} times that of `{}`, 95 % from {} to {} ({drawn}): {says}.",
                other.name,
                digits(ratio),
                study.name,
                digits(low),
                digits(high)
            ));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{StudyTable, Wanted};
    use super::*;
    use crate::sweep::Sweep;
    use crate::sweep::number::in_table;

    /// The groups of a study of three records at four sizes each.
    fn groups(sizes: &str, intensity: &str) -> Vec<usize> {
        let text = format!(
            "scene = \"s.toml\"\n[grid]\nground.motion.x.record = [\"a\", \"b\", \"c\"]\n{sizes}\n[outputs]\npga = \"records.0.peak_acceleration\"\n\
             overturned = \"overturned_at\"\n[fragility]\nevent = \"overturned\"\nintensity = {intensity}\n"
        );
        let sweep = Sweep::read(&text, "f", &|_, _| Err("none".to_owned())).unwrap();
        let header: Vec<&str> = sweep.keys();
        let mut table = format!("case,{},pga,overturned,status,error\n", header.join(","));
        for number in 0..sweep.cases() {
            let values: Vec<String> = sweep.case(number).iter().map(|(key, value)| in_table(key, value)).collect();
            let time = if number % 3 == 0 { "1.5" } else { "" };
            let _ = writeln!(table, "{number},{},{:?},{time},complete,", values.join(","), 1.0 + number as f64);
        }
        let Wanted { fragility, .. } = sweep.wanted().clone();
        let table = StudyTable::read(table.as_bytes(), &sweep).unwrap();
        let study = Ensemble { name: "s".to_owned(), sweep, table };
        let asked = fragility.unwrap();
        Seen::of(&study, &asked, &asked.intensities[0]).groups.iter().map(Vec::len).collect()
    }

    #[test]
    fn marks_are_of_each_intensity_or_of_groups_of_equally_many_cases() {
        let shares = |intensities: u32| {
            let observations = (0..2 * intensities)
                .map(|k| Observation { intensity: 1.0 + f64::from(k % intensities), event: k % 2 == 0 })
                .collect();
            Seen { observations, groups: Vec::new(), names: Vec::new(), notes: Vec::new() }.shares()
        };
        let (few, many) = (shares(40), shares(41));
        assert_eq!((few.of.len(), few.grouped), (40, false));
        let cases: Vec<usize> = many.of.iter().map(|share| share.1).collect();
        assert!(many.grouped && cases.iter().sum::<usize>() == 82, "{cases:?}");
        assert!(cases.len() == 10 && cases.iter().all(|cases| [8, 9].contains(cases)), "{cases:?}");
        assert!(grouping("s", 82).contains("10 groups of 8 or 9 cases") && grouping("s", 90).contains("of 9 cases"));
    }

    /// A run without a second impact is one in which none was strong; what a table doesn't have otherwise isn't known.
    #[test]
    fn what_a_run_has_not_got_is_not_above() {
        let study = |outputs: &str| {
            let text = format!(
                "scene = \"s.toml\"\n[grid]\ntime.end = [\"1 s\", \"2 s\", \"3 s\", \"4 s\"]\n[outputs]\n{outputs}\n[fragility]\n\
                 event = {{ output = \"blow\", above = 1.0 }}\nintensity = \"time.end\"\n"
            );
            let sweep = Sweep::read(&text, "f", &|_, _| Err("none".to_owned())).unwrap();
            let table = "case,time.end,blow,status,error\n0,1.0,,complete,\n1,2.0,0.5,complete,\n2,3.0,2.0,complete,\n3,4.0,,complete,\n";
            let table = StudyTable::read(table.as_bytes(), &sweep).unwrap();
            Ensemble { name: String::new(), sweep, table }
        };
        let seen = |study: &Ensemble| {
            let asked = study.sweep.wanted().fragility.clone().unwrap();
            let seen = Seen::of(study, &asked, "time.end");
            (seen.observations.iter().map(|one| one.event).collect::<Vec<_>>(), seen.notes)
        };
        let (events, notes) = seen(&study("blow = \"impacts.1.impulse_n\""));
        assert_eq!(events, [false, false, true, false]);
        assert_eq!(notes, ["2 cases without any blow count as without the event."]);
        // A block that still moves has come to no rest yet, and one that fell has slid more than any.
        for unknown in ["{ at = \"0.5 s\", of = \"b.phi\" }", "\"rests_from\"", "\"verdict.0.slid\""] {
            let (events, notes) = seen(&study(&format!("blow = {unknown}")));
            assert_eq!(events, [false, true], "{unknown}");
            assert_eq!(notes, ["2 cases without a number for the event or for time.end are left out."]);
        }
    }

    #[test]
    fn runs_of_one_record_are_one_group_by_whatever_they_are_scaled() {
        let scales = "ground.motion.x.scale = [0.5, 1, 2, 4]";
        let peaks = "ground.motion.x.peak = [\"1 m/s^2\", \"2 m/s^2\", \"3 m/s^2\", \"4 m/s^2\"]";
        assert_eq!(groups(peaks, "\"ground.motion.x.peak\""), [4, 4, 4]);
        assert_eq!(groups(peaks, "[\"pga\", \"ground.motion.x.peak\"]"), [4, 4, 4]);
        assert_eq!(groups(peaks, "\"pga\""), [4, 4, 4]);
        assert_eq!(groups(scales, "\"pga\""), [4, 4, 4]);
        // A key that doesn't scale the motion: other blocks under the same record.
        assert_eq!(groups("block.b.mass = [\"1 kg\", \"2 kg\"]", "\"pga\""), [2; 3]);
        // Under one record, whatever else varies.
        assert_eq!(groups(&format!("{peaks}\ncontact.c.friction = [0.4, 0.5]"), "\"ground.motion.x.peak\""), [8, 8, 8]);
        // The time of the peak of a wavelet is none of its size.
        assert!(is_size("signal.w.scale") && !is_size("signal.w.peak"));
    }
}
