//! `teeter pdf`: figures as PDF beside the SVG that they are made from.

use crate::console::Console;
use crate::run::Exit;
use std::collections::BTreeSet;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use teeter_plot::svg_to_pdf;
use teeter_report::{ResultsError, write_whole};

#[derive(Debug)]
pub(crate) struct Options {
    /// Figures, and folders of figures or of results.
    pub(crate) paths: Vec<PathBuf>,
    pub(crate) force: bool,
    pub(crate) quiet: bool,
}

pub(crate) fn pdf(options: &Options) -> Exit {
    let console = Console::new(options.quiet);
    let bad_input = |text: String| {
        console.error(&format!("error: {text}"));
        Exit::BadInput
    };
    let mut figures = Vec::new();
    for path in &options.paths {
        match figures_at(path) {
            Ok(found) => figures.extend(found),
            Err(error) => return bad_input(error),
        }
    }
    // Of one that is named twice, by itself and by its folder.
    figures.sort();
    figures.dedup();
    let mut files = Vec::with_capacity(figures.len());
    let mut missing = BTreeSet::new();
    for figure in figures {
        let file = figure.with_extension("pdf");
        // A link is there, too, wherever it leads.
        if !options.force && std::fs::symlink_metadata(&file).is_ok() {
            return bad_input(format!("{} already exists; --force replaces it", file.display()));
        }
        let svg = match std::fs::read_to_string(&figure) {
            Ok(svg) => svg,
            Err(error) if error.kind() == ErrorKind::InvalidData => {
                return bad_input(format!("{} is not text", figure.display()));
            }
            Err(error) => return bad_input(format!("{} can't be read: {error}", figure.display())),
        };
        match svg_to_pdf(&svg) {
            Ok(pdf) => {
                missing.extend(pdf.missing);
                files.push((file, pdf.bytes));
            }
            Err(error) => return bad_input(format!("{}: {error}", figure.display())),
        }
    }
    for (file, pdf) in &files {
        if let Err(error) = write_whole(file, pdf) {
            console.error(&format!("error: {error}"));
            return if matches!(error, ResultsError::Io { .. }) { Exit::Failed } else { Exit::BadInput };
        }
    }
    if !missing.is_empty() {
        let letters = missing.iter().map(char::to_string).collect::<Vec<_>>().join(" ");
        console.note(&format!(
            "warning: the font of PDF figures has Latin, Greek and Cyrillic letters; boxes stand for {letters}. A browser prints the SVG to PDF with the \
             fonts of your system"
        ));
    }
    console.note(&match &files[..] {
        [(file, _)] => format!("{}", file.display()),
        files => format!("{} figures as PDF, each beside its SVG", files.len()),
    });
    Exit::FinishedRun
}

/// The figure, or those of a folder and of its subfolder `figures`.
fn figures_at(path: &Path) -> Result<Vec<PathBuf>, String> {
    let is_svg = |path: &Path| path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("svg"));
    if !path.exists() {
        return Err(format!("there is no {}", path.display()));
    }
    if !path.is_dir() {
        let rule = || format!("{} is no figure: give files that end in .svg, or folders with some", path.display());
        return if is_svg(path) { Ok(vec![path.to_owned()]) } else { Err(rule()) };
    }
    let mut found = Vec::new();
    for folder in [path.to_owned(), path.join("figures")].into_iter().filter(|folder| folder.is_dir()) {
        let entries =
            std::fs::read_dir(&folder).map_err(|error| format!("{} can't be read: {error}", folder.display()))?;
        found.extend(entries.flatten().map(|entry| entry.path()).filter(|path| path.is_file() && is_svg(path)));
    }
    if found.is_empty() {
        return Err(format!("{} has no figures (*.svg), nor has its subfolder `figures`", path.display()));
    }
    Ok(found)
}
