//! What is asked of a case: whether a block overturned, or an output passed a value.

use super::output::Output;
use super::spec::{Node, Reader, entries};

/// The place in the summary that tells whether a block overturned.
const OVERTURNED_AT: &str = "overturned_at";

/// Lists of a summary whose items are events: a run that hasn't got one has had no such event.
const EVENTS: [&str; 3] = ["impacts", "peaks", "crossings"];

/// A yes or no about a case that ran.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Criterion {
    /// A block overturned.
    Overturned,
    /// An output is above a value.
    Above {
        /// The name of the output.
        output: String,
        /// The value, in SI units.
        value: f64,
    },
}

const WORDS: [&str; 2] = ["output", "above"];
const EXAMPLE: &str = "write \"overturned\", or the name of an output and a number in SI units, such as { output = \"largest\", above = 0.2 }";

impl Criterion {
    /// Reads `"overturned"` or `{ output = "largest", above = 0.2 }`.
    pub(crate) fn read(reader: &mut Reader<'_>, path: &str, node: &Node<'_, '_>) -> Option<Self> {
        if node.text() == Some("overturned") {
            return Some(Self::Overturned);
        }
        let Some(table) = node.table() else {
            reader.wrong(path, Some(node), "\"overturned\", or an output with a value is expected", EXAMPLE);
            return None;
        };
        let (mut output, mut above) = (None, None);
        for (word, value) in entries(table) {
            match word {
                "output" => output = value.text().map(str::to_owned),
                "above" => {
                    above = reader.written(&value).replace('_', "").parse::<f64>().ok().filter(|x| x.is_finite())
                }
                other => {
                    reader.unknown(&format!("{path}.{other}"), &value, other, &WORDS);
                    return None;
                }
            }
        }
        let (Some(output), Some(value)) = (output, above) else {
            reader.wrong(path, Some(node), "an output and a number are expected", EXAMPLE);
            return None;
        };
        Some(Self::Above { output, value })
    }

    /// Its meaning after "where" and "that", for titles.
    pub(crate) fn clause(&self) -> String {
        match self {
            Self::Overturned => "a block overturns".to_owned(),
            Self::Above { output, value } => format!("{output} is above {value}"),
        }
    }

    /// In how many cases it holds, as a sentence.
    pub(crate) fn counted(&self, events: usize, cases: usize) -> String {
        match self {
            Self::Overturned => format!("A block overturns in {events} of {}.", super::counted(cases as u64)),
            Self::Above { output, value } => {
                format!("{output} is above {value} in {events} of {}.", super::counted(cases as u64))
            }
        }
    }

    /// What holds of the other cases, for legends.
    pub(crate) fn opposite(&self) -> String {
        match self {
            Self::Overturned => "not overturned".to_owned(),
            Self::Above { output, value } => format!("{output} at most {value}"),
        }
    }

    /// Its meaning, for figures and columns.
    pub(crate) fn words(&self) -> String {
        match self {
            Self::Overturned => "overturned".to_owned(),
            Self::Above { output, value } => format!("{output} above {value}"),
        }
    }

    /// Adds the output that it needs, if there is none yet; refuses one that isn't there.
    pub(crate) fn claim(&self, reader: &mut Reader<'_>, path: &str, outputs: &mut Vec<Output>) {
        match self {
            Self::Overturned => {
                if !outputs.iter().any(|output| output.summary_path() == Some(OVERTURNED_AT)) {
                    outputs.push(Output::summary(OVERTURNED_AT));
                }
            }
            Self::Above { output, .. } => {
                if !outputs.iter().any(|known| known.name() == output) {
                    reader.wrong(path, None, &format!("there is no output `{output}`"), "define it under [outputs]");
                }
            }
        }
    }

    /// The name of the column that decides.
    pub(crate) fn column<'o>(&self, outputs: &'o [Output]) -> Option<&'o str> {
        let ours = |output: &&Output| match self {
            Self::Overturned => output.summary_path() == Some(OVERTURNED_AT),
            Self::Above { output: name, .. } => output.name() == name,
        };
        outputs.iter().find(ours).map(Output::name)
    }

    /// Whether it holds, by the cell of its column among these outputs; `None` where the cell doesn't say. An impact, a peak or a crossing
    /// that a run hasn't got is above nothing; of all else that is missing, as when a block came to rest that still moves, nothing is known.
    pub(crate) fn holds(&self, cell: &str, outputs: &[Output]) -> Option<bool> {
        match self {
            Self::Overturned => Some(!cell.is_empty()),
            Self::Above { value, .. } => match cell.is_empty() {
                true => self.is_absent(cell, outputs).then_some(false),
                false => cell.parse::<f64>().ok().map(|number| number > *value),
            },
        }
    }

    /// Whether the cell is that of a run that hasn't got so many impacts, peaks or crossings.
    fn is_absent(&self, cell: &str, outputs: &[Output]) -> bool {
        let Self::Above { output: name, .. } = self else { return false };
        let of_event =
            |path: &str| EVENTS.iter().any(|list| path.strip_prefix(list).is_some_and(|rest| rest.starts_with('.')));
        cell.is_empty()
            && outputs.iter().any(|output| output.name() == name && output.summary_path().is_some_and(of_event))
    }

    /// How many cases haven't got the event of the output, as a sentence; none where all have.
    pub(crate) fn absent(&self, cells: &[&str], outputs: &[Output]) -> Option<String> {
        let Self::Above { output, .. } = self else { return None };
        let absent = cells.iter().filter(|cell| self.is_absent(cell, outputs)).count();
        let count = if absent == 1 { "counts" } else { "count" };
        (absent > 0)
            .then(|| format!("{} without any {output} {count} as without the event.", super::counted(absent as u64)))
    }
}
