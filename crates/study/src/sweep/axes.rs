//! What varies in a sweep file: axes and random samples.

use super::number::WrittenNumber;
use super::sample::{Distribution, Method, Sampler};
use super::spec::{Node, Reader, entries};
use toml::de::DeTable;

/// Lists the files that match a pattern, as the scene of the file names them; or says why not.
pub(super) type ListFiles<'a> = dyn Fn(&str) -> Result<Vec<String>, String> + 'a;

/// Largest number of values of one axis, and of random samples, which are kept in memory.
const MOST_VALUES: u64 = 1_000_000;

const RANGE: [&str; 5] = ["from", "to", "count", "spacing", "files"];
const DISTRIBUTIONS: [&str; 4] = ["uniform", "log_uniform", "normal", "log_normal"];
const EXAMPLE: &str = "list the values, such as [\"1 mm\", \"2 mm\"], or give { from = \"1 mm\", to = \"9 mm\", count = 5 }, \
    with spacing = \"log\" for a logarithmic range, or { files = \"records/*.AT2\" }";

/// Keys that change together, and their values.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Axis {
    pub(super) keys: Vec<String>,
    /// By keys.
    pub(super) values: Vec<Vec<String>>,
}

impl Axis {
    pub(super) fn len(&self) -> u64 {
        self.values.first().map_or(1, |values| values.len() as u64)
    }
}

/// Keys with random values.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Samples {
    pub(super) keys: Vec<RandomKey>,
    pub(super) count: u64,
    pub(super) sampler: Sampler,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct RandomKey {
    pub(super) key: String,
    pub(super) distribution: Distribution,
    /// A number in the unit of its values.
    pub(super) unit: WrittenNumber,
}

/// Keys with their values in the order of the file: `contact.feet.friction = [0.3, 0.5]`, quoted or not. Dotted keys that begin
/// alike share a table, but need not stand together.
fn leaves<'a, 't>(table: &'a DeTable<'t>, words: &[&str], above: &str) -> Vec<(String, Node<'a, 't>)> {
    let mut all = nested(table, words, above);
    all.sort_by_key(|(_, node)| node.start);
    all
}

/// [`leaves`] by their tables.
fn nested<'a, 't>(table: &'a DeTable<'t>, words: &[&str], above: &str) -> Vec<(String, Node<'a, 't>)> {
    let mut all = Vec::new();
    for (name, node) in entries(table) {
        let key = if above.is_empty() { name.to_owned() } else { format!("{above}.{name}") };
        match node.table() {
            // A range has only keys of a range, whose values are no tables: other tables are part of the
            // path.
            Some(inner) if !is_range(inner, words) => all.extend(nested(inner, words, &key)),
            _ => all.push((key, node)),
        }
    }
    all
}

/// Whether a table gives a key's values, and isn't a part of the key's path. Scenes have keys `from`, `to` and `count` of
/// their own: a list there has the values of that key, since a range has one of each.
fn is_range(table: &DeTable<'_>, words: &[&str]) -> bool {
    let gives = |(name, node): &(&str, Node<'_, '_>)| {
        let list_of_its_own = node.array().is_some() && ["from", "to", "count"].contains(name);
        words.contains(name) && node.table().is_none() && !list_of_its_own
    };
    table.is_empty() || entries(table).iter().any(gives)
}

pub(super) fn grid(reader: &mut Reader<'_>, table: &DeTable<'_>, name: &str, files: &ListFiles<'_>) -> Vec<Axis> {
    let keys = leaves(table, &RANGE, "");
    let read = |(key, node): (String, Node<'_, '_>)| {
        let values = values(reader, &format!("{name}.{key}"), &node, files)?;
        Some(Axis { keys: vec![key], values: vec![values] })
    };
    keys.into_iter().filter_map(read).collect()
}

/// Keys whose first values belong together, and so on.
pub(super) fn together(
    reader: &mut Reader<'_>,
    table: &DeTable<'_>,
    node: &Node<'_, '_>,
    files: &ListFiles<'_>,
) -> Option<Axis> {
    let axes = grid(reader, table, "zip", files);
    let lengths: Vec<u64> = axes.iter().map(Axis::len).collect();
    if lengths.windows(2).any(|pair| pair[0] != pair[1]) {
        let count = |axis: &Axis| format!("{} has {}", axis.keys.join(""), axis.len());
        let rule =
            format!("lists of one length are expected: {}", axes.iter().map(count).collect::<Vec<_>>().join(", "));
        reader.wrong("zip", Some(node), &rule, "give each key one value a case, or move a key to [grid]");
        return None;
    }
    let (keys, values) = axes.into_iter().map(|axis| (axis.keys, axis.values)).fold(
        (Vec::new(), Vec::new()),
        |(mut keys, mut values), (more_keys, more_values)| {
            keys.extend(more_keys);
            values.extend(more_values);
            (keys, values)
        },
    );
    (!keys.is_empty()).then_some(Axis { keys, values })
}

/// The values of a key: listed, a range, or files.
fn values(reader: &mut Reader<'_>, path: &str, node: &Node<'_, '_>, files: &ListFiles<'_>) -> Option<Vec<String>> {
    if let Some(items) = node.array() {
        if items.is_empty() {
            reader.wrong(path, Some(node), "no values", EXAMPLE);
            return None;
        }
        return Some(items.iter().map(|item| reader.setting(item)).collect());
    }
    let Some(table) = node.table() else {
        reader.wrong(path, Some(node), "a list of values is expected", EXAMPLE);
        return None;
    };
    let (mut ends, mut count, mut log) = ([None, None], None, false);
    for (word, value) in entries(table) {
        let inner = format!("{path}.{word}");
        match word {
            "files" => return listed_files(reader, &inner, &value, files),
            "from" | "to" => ends[usize::from(word == "to")] = Some(end(reader, &inner, &value)?),
            "count" => match value.whole() {
                Some(number) if (2..=MOST_VALUES).contains(&number) => count = Some(number),
                _ => {
                    let rule = format!("a whole number from 2 to {MOST_VALUES} is expected");
                    reader.wrong(&inner, Some(&value), &rule, "both ends are among the values");
                    return None;
                }
            },
            "spacing" => match value.text() {
                Some("linear") => {}
                Some("log") => log = true,
                _ => {
                    reader.wrong(
                        &inner,
                        Some(&value),
                        "\"linear\" or \"log\" is expected",
                        "leave it out for \"linear\"",
                    );
                    return None;
                }
            },
            other => {
                reader.unknown(&inner, &value, other, &RANGE);
                return None;
            }
        }
    }
    let ([Some(from), Some(to)], Some(count)) = (&ends, count) else {
        reader.wrong(path, Some(node), "from, to and count belong together", EXAMPLE);
        return None;
    };
    if !same_unit(reader, path, node, from, to) {
        return None;
    }
    if log && !(from.value > 0.0 && to.value > 0.0) {
        reader.wrong(
            path,
            Some(node),
            "a logarithmic range is between positive numbers",
            "leave out spacing = \"log\"",
        );
        return None;
    }
    let value = |k: u64| {
        let share = k as f64 / (count - 1) as f64;
        match k {
            0 => from.value,
            k if k == count - 1 => to.value,
            _ if log => from.value * (to.value / from.value).powf(share),
            _ => without_rounding(from.value + (to.value - from.value) * share),
        }
    };
    Some((0..count).map(|k| from.text_of(value(k))).collect())
}

/// The value with its last digits rounded off, if that makes it much shorter: 1.1400000000000001 becomes 1.14.
fn without_rounding(value: f64) -> f64 {
    let length = |value: f64| format!("{value:?}").len();
    let digits = f64::DIGITS as usize;
    let short = format!("{value:.*e}", digits - 1).parse().unwrap_or(value);
    // Of thirds, 15 digits are hardly shorter than 16.
    if length(short) + 2 < length(value) { short } else { value }
}

pub(crate) fn end(reader: &mut Reader<'_>, path: &str, node: &Node<'_, '_>) -> Option<WrittenNumber> {
    let number = WrittenNumber::read(&reader.setting(node));
    if number.is_none() {
        reader.wrong(path, Some(node), "a number is expected, with the unit of its key", EXAMPLE);
    }
    number
}

pub(crate) fn same_unit(
    reader: &mut Reader<'_>,
    path: &str,
    node: &Node<'_, '_>,
    a: &WrittenNumber,
    b: &WrittenNumber,
) -> bool {
    if a.unit == b.unit {
        return true;
    }
    let or_none = |unit: &str| if unit.is_empty() { "none".to_owned() } else { format!("`{unit}`") };
    let rule = format!("the units differ: {} and {}", or_none(&a.unit), or_none(&b.unit));
    reader.wrong(path, Some(node), &rule, "write both numbers in one unit; the values between are in it, too");
    false
}

fn listed_files(
    reader: &mut Reader<'_>,
    path: &str,
    node: &Node<'_, '_>,
    files: &ListFiles<'_>,
) -> Option<Vec<String>> {
    let patterns: Option<Vec<&str>> = match (node.text(), node.array()) {
        (Some(text), _) => Some(vec![text]),
        (None, Some(items)) => items.iter().map(Node::text).collect(),
        (None, None) => None,
    };
    let Some(patterns) = patterns else {
        reader.wrong(path, Some(node), "a pattern, or a list of file names, is expected", EXAMPLE);
        return None;
    };
    let mut all = Vec::new();
    for pattern in patterns {
        match files(pattern) {
            Ok(found) => all.extend(found),
            Err(why) => {
                reader.wrong(
                    path,
                    Some(node),
                    &format!("`{pattern}`: {why}"),
                    "patterns are relative to the sweep file",
                );
                return None;
            }
        }
    }
    Some(all)
}

/// Keys with random values: `count`, `seed`, `method`, and the keys.
pub(super) fn samples(reader: &mut Reader<'_>, table: &DeTable<'_>, node: &Node<'_, '_>) -> Option<Samples> {
    let (mut count, mut seed, mut method) = (None, 0, Method::Independent);
    let mut of_keys = Vec::new();
    let before = reader.found.0.len();
    for (name, value) in entries(table) {
        let path = format!("random.{name}");
        match name {
            "count" => match value.whole() {
                Some(number) if (1..=MOST_VALUES).contains(&number) => count = Some(number),
                _ => {
                    // What is refused isn't missing.
                    count = Some(1);
                    let rule = format!("a whole number from 1 to {MOST_VALUES} is expected");
                    reader.wrong(&path, Some(&value), &rule, "it is the number of samples");
                }
            },
            "seed" => match value.whole() {
                Some(number) => seed = number,
                None => reader.wrong(
                    &path,
                    Some(&value),
                    "a whole number from 0 on is expected",
                    "the same seed gives the same samples",
                ),
            },
            "method" => match value.text() {
                Some("independent") => method = Method::Independent,
                Some("latin-hypercube") => method = Method::LatinHypercube,
                _ => {
                    let rule = "\"independent\" or \"latin-hypercube\" is expected";
                    reader.wrong(&path, Some(&value), rule, "leave it out for \"independent\"");
                }
            },
            _ => match value.table() {
                Some(inner) if !is_range(inner, &DISTRIBUTIONS) => of_keys.extend(nested(inner, &DISTRIBUTIONS, name)),
                _ => of_keys.push((name.to_owned(), value)),
            },
        }
    }
    of_keys.sort_by_key(|(_, node)| node.start);
    let keys: Vec<RandomKey> = of_keys.into_iter().filter_map(|(key, node)| random_key(reader, key, &node)).collect();
    let Some(count) = count else {
        reader.wrong("random.count", Some(node), "missing: how many samples?", "such as count = 100");
        return None;
    };
    // A distribution that is refused is one.
    if keys.is_empty() && reader.found.0.len() == before {
        let remedy = "give a key its distribution, such as contact.feet.friction = { uniform = [0.2, 0.6] }";
        reader.wrong("random", Some(node), "nothing is random", remedy);
    }
    if keys.is_empty() {
        return None;
    }
    let sampler = Sampler::new(seed, method, keys.len(), u32::try_from(count).unwrap_or(u32::MAX));
    Some(Samples { keys, count, sampler })
}

fn random_key(reader: &mut Reader<'_>, key: String, node: &Node<'_, '_>) -> Option<RandomKey> {
    let path = format!("random.{key}");
    let example = "give one of { uniform = [low, high] }, { log_uniform = [low, high] }, { normal = [mean, standard \
        deviation] } or { log_normal = [median, standard deviation of the logarithm] }";
    let words = node.table().map(entries).unwrap_or_default();
    let [(word, value)] = words.as_slice() else {
        reader.wrong(&path, Some(node), "a distribution is expected", example);
        return None;
    };
    if !DISTRIBUTIONS.contains(word) {
        reader.unknown(&format!("{path}.{word}"), value, word, &DISTRIBUTIONS);
        return None;
    }
    let numbers = value.array().unwrap_or_default();
    let [a, b] = numbers.as_slice() else {
        reader.wrong(&format!("{path}.{word}"), Some(value), "two numbers are expected", example);
        return None;
    };
    let (first, second) = (end(reader, &path, a)?, end(reader, &path, b)?);
    // The standard deviation of a logarithm has no unit.
    if *word != "log_normal" && !same_unit(reader, &path, value, &first, &second) {
        return None;
    }
    let (x, y) = (first.value, second.value);
    let (distribution, rule) = match *word {
        "uniform" => {
            (Distribution::Uniform { low: x, high: y }, (x < y).then_some(()).ok_or("the lower end comes first"))
        }
        "log_uniform" => {
            let fine = 0.0 < x && x < y;
            (
                Distribution::LogUniform { low: x, high: y },
                fine.then_some(()).ok_or("two positive numbers, the smaller one first"),
            )
        }
        "normal" => (
            Distribution::Normal { mean: x, deviation: y },
            (y > 0.0).then_some(()).ok_or("a standard deviation is positive"),
        ),
        _ => {
            let fine = x > 0.0 && y > 0.0 && second.unit.is_empty();
            let rule = "a positive median and the standard deviation of the logarithm, which has no unit";
            (Distribution::LogNormal { median: x, deviation: y }, fine.then_some(()).ok_or(rule))
        }
    };
    if let Err(rule) = rule {
        reader.wrong(&format!("{path}.{word}"), Some(value), rule, example);
        return None;
    }
    Some(RandomKey { key, distribution, unit: first })
}

#[cfg(test)]
mod tests {
    use crate::sweep::Sweep;

    fn read(text: &str) -> Result<Sweep, String> {
        Sweep::read(text, "f", &|_, _| Err("none".to_owned())).map_err(|found| found.to_string())
    }

    #[test]
    fn keys_are_in_the_order_of_the_file_even_where_they_begin_alike() {
        let text = "scene = 's.toml'\n[grid]\ntime.end = ['1 s', '2 s']\ncontact.feet.friction = [0.3, 0.4]\n\
            time.step = ['1 ms', '2 ms']\n[random]\nblock.b.width = { uniform = ['1 cm', '2 cm'] }\ncount = 2\n\
            material.m.density = { uniform = ['1 kg/m^3', '2 kg/m^3'] }\nblock.b.height = { uniform = ['1 cm', '2 cm'] }\n";
        let sweep = read(text).unwrap();
        let fixed = ["time.end", "contact.feet.friction", "time.step"];
        assert_eq!(sweep.keys(), [&fixed[..], &["block.b.width", "material.m.density", "block.b.height"]].concat());
        // The samples of a combination follow each other; of the grid the last key varies fastest.
        let values = |case: u64| sweep.case(case).into_iter().take(3).map(|(_, value)| value).collect::<Vec<_>>();
        assert_eq!(
            (values(0), values(2)),
            (
                vec!["1 s".into(), "0.3".into(), "1 ms".into()],
                vec!["1 s".to_owned(), "0.3".to_owned(), "2 ms".to_owned()]
            )
        );
    }

    #[test]
    fn values_of_a_range_are_those_that_one_would_write() {
        let values = |range: &str| {
            let sweep = read(&format!("scene = 's.toml'\n[grid]\nk = {range}\n")).unwrap();
            (0..sweep.cases()).map(|case| sweep.case(case)[0].1.clone()).collect::<Vec<_>>()
        };
        assert_eq!(
            values("{ from = 1.0, to = 1.2, count = 11 }"),
            ["1", "1.02", "1.04", "1.06", "1.08", "1.1", "1.12", "1.14", "1.16", "1.18", "1.2"]
        );
        assert_eq!(
            values("{ from = '0 m', to = '1 m', count = 4 }")[1..3],
            ["0.3333333333333333 m", "0.6666666666666666 m"]
        );
    }

    #[test]
    fn a_number_of_samples_that_is_refused_is_not_missing() {
        for count in ["0", "-1", "1000001", "1.5"] {
            let text = format!("scene = 's.toml'\n[random]\ncount = {count}\nk = {{ uniform = [1, 2] }}\n");
            let found = read(&text).unwrap_err();
            assert!(found.contains("a whole number from 1 to 1000000 is expected"), "{found}");
            assert!(!found.contains("missing"), "{found}");
        }
    }

    #[test]
    fn from_and_to_with_lists_are_keys_of_the_scene() {
        let keys = |grid: &str| -> Result<(Vec<String>, u64), String> {
            let text = format!("scene = 's.toml'\n[grid]\n{grid}\n[outputs]\nover = 'overturned'\n");
            let sweep = Sweep::read(&text, "f", &|_, _| Err("none".to_owned())).map_err(|found| found.to_string())?;
            Ok((sweep.keys().into_iter().map(str::to_owned).collect(), sweep.cases()))
        };
        let [chirp, block] = ["signal.chirp", "block"].map(|table| move |key: &str| format!("{table}.{key}"));
        assert_eq!(keys("signal.chirp.from = ['1 Hz', '2 Hz']"), Ok((vec![chirp("from")], 2)));
        let both = "signal.chirp.from = ['1 Hz', '2 Hz']\nsignal.chirp.to = { from = '9 Hz', to = '12 Hz', count = 4 }";
        assert_eq!(keys(both), Ok((vec![chirp("from"), chirp("to")], 8)));
        assert_eq!(keys("repeat.wall.count = [5, 10]"), Ok((vec!["repeat.wall.count".to_owned()], 2)));
        assert_eq!(keys("block.tilt = { from = '1 deg', to = '3 deg', count = 3 }"), Ok((vec![block("tilt")], 3)));
        let mixed = keys("block.tilt = { from = ['1 deg'], to = '3 deg', count = 3 }").unwrap_err();
        assert!(mixed.contains("block.tilt.from"), "{mixed}");
    }
}
