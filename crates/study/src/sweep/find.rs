//! Limits: the value of a key at which a block begins to overturn, by bisection.
//!
//! Whether a block overturns need not be monotone in any key: past the first amplitude that
//! overturns it there are often others that don't. Bisection finds one change between two ends that
//! differ. So the states at both ends are part of the result, values between them can be scanned
//! first, and the number of changes that were seen is told.

use super::axes::{end, same_unit};
use super::criterion::Criterion;
use super::number::{WrittenNumber, in_table};
use super::spec::{Node, Reader, entries};
use toml::de::DeTable;

/// What is searched in each case.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Find {
    pub(crate) key: String,
    /// The ends of the bracket, in the same unit.
    low: WrittenNumber,
    high: WrittenNumber,
    /// In their unit.
    tolerance: f64,
    /// Number of values between the ends that are run before the bisection.
    scan: u64,
    pub(crate) until: Criterion,
}

const WORDS: [&str; 6] = ["key", "low", "high", "tolerance", "until", "scan"];
const EXAMPLE: &str = "such as find = { key = \"ground.motion.x.scale\", low = 0.1, high = 3, until = \"overturned\", \
    tolerance = 0.01 }";
/// More are no bisection but a grid.
const MOST_SCANNED: u64 = 10_000;

/// The columns of a limit after that of its key.
pub(crate) const COLUMNS: [&str; 5] = ["find.beside", "find.at_low", "find.at_high", "find.changes", "find.runs"];

impl Find {
    /// Reads the table `[find]`.
    pub(crate) fn read(reader: &mut Reader<'_>, table: &DeTable<'_>, node: &Node<'_, '_>) -> Option<Self> {
        let (mut key, mut until, mut scan) = (None, None, 0);
        let (mut low, mut high, mut tolerance) = (None, None, None);
        for (word, value) in entries(table) {
            let path = format!("find.{word}");
            match word {
                "key" => match value.text() {
                    Some(text) if !text.trim().is_empty() => key = Some(text.trim().to_owned()),
                    _ => {
                        reader.wrong(&path, Some(&value), "the path of a key of the scene is expected", EXAMPLE);
                        return None;
                    }
                },
                "low" => low = Some(end(reader, &path, &value)?),
                "high" => high = Some(end(reader, &path, &value)?),
                "tolerance" => tolerance = Some(end(reader, &path, &value)?),
                "until" => until = Some(Criterion::read(reader, &path, &value)?),
                "scan" => match value.whole() {
                    Some(number) if number <= MOST_SCANNED => scan = number,
                    _ => {
                        let rule = format!("a whole number from 0 to {MOST_SCANNED} is expected");
                        reader.wrong(&path, Some(&value), &rule, "so many values between the ends are run first");
                        return None;
                    }
                },
                other => {
                    reader.unknown(&path, &value, other, &WORDS);
                    return None;
                }
            }
        }
        let (Some(key), Some(low), Some(high), Some(tolerance), Some(until)) = (key, low, high, tolerance, until)
        else {
            reader.wrong("find", Some(node), "key, low, high, tolerance and until belong together", EXAMPLE);
            return None;
        };
        if !same_unit(reader, "find", node, &low, &high) || !same_unit(reader, "find", node, &low, &tolerance) {
            return None;
        }
        if !(low.value < high.value) {
            reader.wrong("find", Some(node), "low must be below high", EXAMPLE);
            return None;
        }
        if !(tolerance.value > 0.0) {
            reader.wrong("find.tolerance", Some(node), "must be greater than 0", EXAMPLE);
            return None;
        }
        if tolerance.value >= high.value - low.value {
            let rule = "must be less than high - low, or there is nothing to search";
            reader.wrong("find.tolerance", Some(node), rule, EXAMPLE);
            return None;
        }
        Some(Self { key, low, high, tolerance: tolerance.value, scan, until })
    }

    /// A value as `--set` takes it.
    fn text(&self, value: f64) -> String {
        self.low.text_of(value)
    }

    /// The lower end of the bracket, as `--set` takes it.
    pub(crate) fn low_text(&self) -> String {
        self.text(self.low.value)
    }

    /// The upper end.
    pub(crate) fn high_text(&self) -> String {
        self.text(self.high.value)
    }

    /// Whether values between the ends are run before the bisection.
    pub(crate) fn scans(&self) -> bool {
        self.scan > 0
    }

    /// Searches; `run` runs the case with a value and returns whether the criterion holds there,
    /// with the run's results.
    ///
    /// # Errors
    /// The first result of a run that has no answer.
    pub(crate) fn search<R>(&self, mut run: impl FnMut(String) -> Result<(bool, R), R>) -> Result<(Found, R), R> {
        let (low, high) = (self.low.value, self.high.value);
        let mut runs = 0;
        let mut tried = |value: f64| {
            runs += 1;
            run(self.text(value)).map(|(holds, result)| Tried { value, holds, result })
        };
        let last = self.scan + 1;
        let value = |k: u64| if k == last { high } else { low + (high - low) * (k as f64 / last as f64) };
        let mut scanned = (0..=last).map(|k| tried(value(k))).collect::<Result<Vec<_>, R>>()?;
        let ends = [scanned.first(), scanned.last()].map(|tried| tried.is_some_and(|tried| tried.holds));
        let changes: Vec<usize> = (1..scanned.len()).filter(|k| scanned[*k].holds != scanned[k - 1].holds).collect();
        let mut pair = scanned.drain(changes.first().map_or(scanned.len() - 1, |k| k - 1)..);
        let found = |limit: Option<f64>, beside: Option<f64>, runs: u64| Found {
            limit: limit.map(|value| self.text(value)),
            beside: beside.map(|value| self.text(value)),
            at_low: ends[0],
            at_high: ends[1],
            changes: changes.len() as u64,
            runs,
        };
        match (pair.next(), pair.next()) {
            (Some(mut before), Some(mut after)) => {
                while after.value - before.value > self.tolerance {
                    let middle = before.value + 0.5 * (after.value - before.value);
                    // Neighbouring doubles, for a tolerance below their distance.
                    if !(middle > before.value && middle < after.value) {
                        break;
                    }
                    let next = tried(middle)?;
                    if next.holds == before.holds { before = next } else { after = next }
                }
                let (limit, beside) = if after.holds { (after, before) } else { (before, after) };
                Ok((found(Some(limit.value), Some(beside.value), runs), limit.result))
            }
            (Some(only), None) => Ok((found(None, None, runs), only.result)),
            // There are two ends at least.
            (None, _) => tried(high).map(|only| (found(None, None, runs), only.result)),
        }
    }
}

/// A value and what came of it.
struct Tried<R> {
    value: f64,
    holds: bool,
    result: R,
}

/// A limit, or that there is none between the ends. Values are as `--set` takes them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Found {
    /// The value at the limit where the criterion holds; `None` if no change was seen.
    pub(crate) limit: Option<String>,
    /// The value closest to it that was run and where it doesn't.
    beside: Option<String>,
    /// Whether it holds at the ends of the bracket.
    at_low: bool,
    at_high: bool,
    /// Changes between neighbouring values of the scan, the ends included.
    pub(crate) changes: u64,
    runs: u64,
}

impl Found {
    /// The cells of the key's column and of [`COLUMNS`].
    pub(crate) fn cells(&self, key: &str) -> [String; 6] {
        let value = |text: &Option<String>| text.as_ref().map(|text| in_table(key, text)).unwrap_or_default();
        let yes = |holds: bool| if holds { "yes" } else { "no" }.to_owned();
        let (limit, beside) = (value(&self.limit), value(&self.beside));
        [limit, beside, yes(self.at_low), yes(self.at_high), self.changes.to_string(), self.runs.to_string()]
    }

    /// Why there is no limit.
    pub(crate) fn no_limit(&self, find: &Find) -> Option<String> {
        let state = if self.at_low { "true" } else { "false" };
        let (low, high) = (find.low_text(), find.high_text());
        let scanned = if find.scans() { ", and at all values scanned between them" } else { "" };
        let words = find.until.words();
        self.limit.is_none().then(|| format!("no limit: `{words}` is {state} at {low} and at {high}{scanned}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn find(scan: u64, tolerance: f64) -> Find {
        let number = |value: f64| WrittenNumber { value, unit: "mm".to_owned() };
        let until = Criterion::Overturned;
        Find { key: "beam.b.width".to_owned(), low: number(0.0), high: number(8.0), tolerance, scan, until }
    }

    /// Holds from `from` to `to`.
    fn searched(find: &Find, holds: impl Fn(f64) -> bool) -> Found {
        let value = |text: &str| text.trim_end_matches(" mm").parse::<f64>().unwrap();
        find.search(|text| Ok::<_, ()>((holds(value(&text)), ()))).unwrap().0
    }

    #[test]
    fn a_limit_is_bracketed_to_the_tolerance_whichever_side_holds() {
        let above = searched(&find(0, 1e-3), |x| x >= 2.7);
        let [limit, beside, low, high, changes, runs] = above.cells("beam.b.width");
        let (limit, beside): (f64, f64) = (limit.parse().unwrap(), beside.parse().unwrap());
        assert!(limit >= 2.7e-3 && beside < 2.7e-3 && limit - beside <= 1e-6, "{limit} {beside}");
        assert_eq!([low, high, changes, runs], ["no", "yes", "1", "15"], "13 halvings of 8, and the ends");
        let below = searched(&find(0, 1e-3), |x| x <= 2.7);
        assert_eq!((below.at_low, below.at_high), (true, false));
        assert!(below.limit.unwrap() < below.beside.unwrap());
    }

    #[test]
    fn a_window_between_ends_that_agree_is_seen_by_a_scan_only() {
        let window = |x: f64| (3.0..5.0).contains(&x);
        let blind = searched(&find(0, 0.1), window);
        assert_eq!((blind.limit.clone(), blind.changes, blind.runs), (None, 0, 2));
        let why = blind.no_limit(&find(0, 0.1)).unwrap();
        assert_eq!(why, "no limit: `overturned` is false at 0.0 mm and at 8.0 mm");
        let seen = searched(&find(7, 0.1), window);
        assert_eq!(seen.changes, 2);
        let limit: f64 = seen.limit.unwrap().trim_end_matches(" mm").parse().unwrap();
        assert!((3.0..=3.1).contains(&limit), "the lowest of both: {limit}");
    }

    #[test]
    fn a_tolerance_below_rounding_ends_and_a_run_without_an_answer_breaks_off() {
        assert!(searched(&find(0, 1e-300), |x| x > 1.0 / 3.0).runs < 1200);
        assert_eq!(find(0, 0.1).search(|_| Err::<(bool, &str), _>("diverged")).unwrap_err(), "diverged");
    }
}
