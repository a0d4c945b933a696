//! What a sweep file asks to be made of its table: fragility curves, distributions, bands, maps of
//! overturning. The same for several studies side by side.

mod bands;
mod comparable;
mod distribution;
mod fragility;
mod label;
mod overturning;
mod page;
mod table;

use super::output::Output;
use super::spec::{Node, Reader};
use super::{Sweep, counted};
use crate::write::typeset;
pub(crate) use bands::Bands;
pub use comparable::incomparable;
pub(crate) use distribution::Distribution;
pub(crate) use fragility::Fragility;
pub(crate) use overturning::Overturning;
pub use page::study_page;
pub use table::{StudyTable, TableError};
use teeter_plot::{AxisError, Figure};
use teeter_report::{SIDE_BY_SIDE, for_any_width};
use toml::de::DeTable;

/// What is to be made of the table of a study.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Wanted {
    pub(crate) fragility: Option<Fragility>,
    pub(crate) distribution: Option<Distribution>,
    pub(crate) overturning: Option<Overturning>,
    pub(crate) bands: Option<Bands>,
}

/// The tables of a sweep file that ask for something.
pub(crate) const TABLES: [&str; 4] = ["fragility", "distribution", "overturning", "bands"];

/// The files that they lead to.
pub const FIGURE_FILES: [&str; 15] = [
    "study.html",
    "figures/fragility.svg",
    "figures/fragility-2.svg",
    "figures/fragility-3.svg",
    "figures/fragility-4.svg",
    "figures/distribution.svg",
    "figures/overturning.svg",
    "fragility.csv",
    "fragility_curves.csv",
    "fragility_data.csv",
    "distribution.csv",
    "distribution_tests.csv",
    "overturning.csv",
    "figures/bands.svg",
    "bands.csv",
];

impl Wanted {
    /// Reads one of [`TABLES`].
    pub(crate) fn read(&mut self, reader: &mut Reader<'_>, name: &str, table: &DeTable<'_>, node: &Node<'_, '_>) {
        match name {
            "fragility" => self.fragility = Fragility::read(reader, table, node),
            "distribution" => self.distribution = Distribution::read(reader, table, node),
            "bands" => self.bands = Bands::read(reader, table, node),
            _ => self.overturning = Overturning::read(reader, table, node),
        }
    }

    /// Whether nothing is asked for.
    pub(crate) fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// Adds the outputs that are needed.
    pub(crate) fn claim(&self, reader: &mut Reader<'_>, outputs: &mut Vec<Output>) {
        if let Some(of) = &self.fragility {
            of.event.claim(reader, "fragility.event", outputs);
        }
        if let Some(of) = &self.overturning {
            of.event.claim(reader, "overturning.event", outputs);
        }
        if let Some(of) = &self.bands {
            let new = of.outputs().filter(|output| !outputs.iter().any(|known| known.name() == output.name()));
            outputs.extend(new.collect::<Vec<_>>());
        }
    }

    /// The columns of the table that figures are made of: those of numbers, and those whose cells are taken as texts.
    pub(crate) fn columns(&self, sweep: &Sweep) -> (Vec<String>, Vec<String>) {
        let mut numbers: Vec<String> = self.of_numbers().into_iter().map(|(_, name)| name.to_owned()).collect();
        numbers.extend(self.bands.iter().flat_map(Bands::outputs).map(|output| output.name().to_owned()));
        let events = [self.fragility.as_ref().map(|of| &of.event), self.overturning.as_ref().map(|of| &of.event)];
        let by = [self.distribution.as_ref().map(|of| &of.by), self.overturning.as_ref().map(|of| &of.by)];
        let mut words: Vec<String> =
            events.into_iter().flatten().filter_map(|event| event.column(sweep.outputs())).map(str::to_owned).collect();
        words.extend(by.into_iter().flatten().flatten().cloned());
        if let Some(of) = &self.fragility {
            words.extend(of.grouping_keys(sweep).into_iter().map(str::to_owned));
        }
        for names in [&mut numbers, &mut words] {
            names.sort_unstable();
            names.dedup();
        }
        (numbers, words)
    }

    /// The columns that have to be numbers, each with its place in the sweep file.
    pub(crate) fn of_numbers(&self) -> Vec<(&'static str, &str)> {
        let mut all: Vec<(&str, &str)> = Vec::new();
        if let Some(of) = &self.fragility {
            all.extend(of.intensities.iter().map(|name| ("fragility.intensity", name.as_str())));
        }
        all.extend(self.distribution.iter().map(|of| ("distribution.of", of.of.as_str())));
        if let Some(of) = &self.overturning {
            all.extend([("overturning.x", of.x.as_str()), ("overturning.y", of.y.as_str())]);
        }
        all
    }

    /// Refuses columns that the table won't have.
    pub(crate) fn check(&self, reader: &mut Reader<'_>, columns: &[&str]) {
        let mut named = self.of_numbers();
        if let Some(by) = self.distribution.as_ref().and_then(|of| of.by.as_deref()) {
            named.push(("distribution.by", by));
        }
        if let Some(by) = self.overturning.as_ref().and_then(|of| of.by.as_deref()) {
            named.push(("overturning.by", by));
        }
        for (path, name) in named.into_iter().filter(|(_, name)| !columns.contains(name)) {
            let rule = format!("results.csv has no column `{name}`");
            reader.wrong(path, None, &rule, &format!("these are there: {}", columns.join(", ")));
        }
    }
}

/// A study with its table.
#[derive(Debug)]
pub struct Ensemble {
    /// Its name in legends and tables.
    pub name: String,
    /// How it was asked for.
    pub sweep: Sweep,
    /// Its rows.
    pub table: StudyTable,
}

impl Ensemble {
    /// What a sentence is about: a quantity, of this study where it has a name, as one of several.
    fn about(&self, quantity: &str) -> String {
        if self.name.is_empty() { quantity.to_owned() } else { format!("`{}`, {quantity}", self.name) }
    }

    /// A sentence on cases that lack something.
    fn left_out(&self, cases: usize, what: &str) -> String {
        let name = if self.name.is_empty() { String::new() } else { format!("`{}`: ", self.name) };
        let are = if cases == 1 { "is" } else { "are" };
        format!("{name}{} without {what} {are} left out.", counted(cases as u64))
    }
}

/// Room below and above axes of shares, so that curves at 0 and 1 aren't hidden by the frame.
const SHARE_ROOM: f64 = 0.03;

/// A figure with its numbers, and what is said of it on the page.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct StudyFigure {
    /// `fragility`, `distribution`, `bands` or `overturning`: the name of its file.
    pub name: &'static str,
    /// Its heading.
    pub title: String,
    /// The figure.
    figure: Figure,
    /// Figures over other quantities, with their names; in files of their own.
    more: Vec<(String, Figure)>,
    /// Its numbers: names and contents of tables.
    pub tables: Vec<(&'static str, String)>,
    /// Sentences: what it shows, and what limits it.
    pub notes: Vec<String>,
    /// The table on the page: its header and rows.
    pub summary: (Vec<String>, Vec<Vec<String>>),
}

impl StudyFigure {
    /// As SVG for files, of a width in mm from 60 to 300, with their names.
    #[must_use]
    pub fn svgs(&self, width: f64) -> Vec<(String, String)> {
        let svg = |figure: &Figure| figure.clone().width_mm(width).to_svg();
        let more = self.more.iter().enumerate();
        let more = more.map(|(k, (_, figure))| (format!("figures/{}-{}.svg", self.name, k + 2), svg(figure)));
        std::iter::once((format!("figures/{}.svg", self.name), svg(&self.figure))).chain(more).collect()
    }

    /// As HTML for a page.
    fn on_page(&self) -> String {
        let all = std::iter::once(&self.figure).chain(self.more.iter().map(|(_, figure)| figure));
        all.map(|figure| format!("<div>{}</div>\n", for_any_width(figure, SIDE_BY_SIDE))).collect()
    }
}

/// The figures that the sweep files ask for, of one study or of several side by side; those that not
/// all of them ask for are left out.
///
/// # Errors
/// If a value can't be shown on an axis.
pub fn study_figures(studies: &[Ensemble]) -> Result<Vec<StudyFigure>, AxisError> {
    let mut figures = Vec::new();
    if studies.is_empty() {
        return Ok(figures);
    }
    let all = |asks: fn(&Wanted) -> bool| studies.iter().all(|study| asks(study.sweep.wanted()));
    if all(|wanted| wanted.fragility.is_some()) {
        figures.push(fragility::figure(studies)?);
    }
    if all(|wanted| wanted.distribution.is_some()) {
        figures.push(distribution::figure(studies)?);
    }
    if all(|wanted| wanted.bands.is_some()) {
        figures.push(bands::figure(studies)?);
    }
    // Maps of several studies would hide each other.
    if let [study] = studies
        && let Some(asked) = &study.sweep.wanted().overturning
    {
        figures.push(overturning::figure(study, asked)?);
    }
    Ok(figures)
}

/// A number with four digits, for pages.
fn digits(x: f64) -> String {
    let rounded: f64 = format!("{x:.3e}").parse().unwrap_or(x);
    let plain = rounded == 0.0 || (1e-3..1e5).contains(&rounded.abs());
    if plain { format!("{rounded}") } else { typeset(&format!("{rounded:e}")) }
}

/// A text under a word of a table.
fn text(reader: &mut Reader<'_>, path: &str, node: &Node<'_, '_>, remedy: &str) -> Option<String> {
    match node.text() {
        Some(text) if !text.trim().is_empty() => Some(text.to_owned()),
        _ => {
            reader.wrong(path, Some(node), "a text is expected", remedy);
            None
        }
    }
}
