//! The table on the screen, and the page.

use crate::case::{Bound, Case, Check, Depth, Findings, Result};
use crate::figure;
use std::fmt::Write as _;
use std::fs;
use std::io::Write;
use std::path::Path;

/// Widths of the columns on the screen: case, quantity, exact, computed, error, bound.
const WIDTHS: [usize; 6] = [16, 72, 14, 14, 9, 11];

/// The head of the table.
pub(crate) fn write_head(out: &mut dyn Write) -> Result<()> {
    let cells = ["case", "quantity", "exact", "computed", "error", "bound"].map(str::to_owned);
    Ok(writeln!(out, "{}ok", padded(&cells))?)
}

/// The rows of a case.
pub(crate) fn write_rows(out: &mut dyn Write, case: &str, findings: &Findings) -> Result<()> {
    if let Some(failure) = &findings.failure {
        writeln!(out, "{case}: COULD NOT RUN: {failure}")?;
    }
    for check in &findings.checks {
        let [quantity, exact, computed, error, bound, ok] = cells(check, Digits::All);
        writeln!(out, "{}{ok}", padded(&[case.to_owned(), quantity, exact, computed, error, bound]))?;
    }
    Ok(out.flush()?)
}

fn padded(cells: &[String; 6]) -> String {
    let mut line = String::new();
    for (cell, width) in cells.iter().zip(WIDTHS) {
        line.push_str(cell);
        // By characters: a Greek letter has two bytes.
        line.extend(std::iter::repeat_n(' ', width.saturating_sub(cell.chars().count()) + 1));
    }
    line
}

/// Which numbers to tell.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Digits {
    /// As computed.
    All,
    /// Those that another processor, or another order of a sum, would find too: the page is kept, and must change only
    /// where the program does.
    Lasting,
}

/// An error below this is rounding: on the page it has no digits.
const ROUNDING: f64 = 1e-13;

fn cells(check: &Check, digits: Digits) -> [String; 6] {
    // A bound may be smaller still: an error that misses it is told in digits.
    let floor = if let Bound::Error(bound) = check.bound { bound.min(ROUNDING) } else { ROUNDING };
    let is_rounding = |value: f64| digits == Digits::Lasting && value.abs() < floor;
    let short = |value: f64| format!("{value:.1e}");
    let error = |value: f64| if is_rounding(value) { format!("< {floor:e}") } else { short(value) };
    let number = |value: f64| number(if is_rounding(value) { 0.0 } else { value });
    let bound = match check.bound {
        Bound::Error(bound) => short(bound),
        Bound::Between(low, high) => format!("{low} … {high}"),
        Bound::Reported => String::new(),
    };
    let ok = match check.holds() {
        Some(true) => "yes",
        Some(false) => "NO",
        None => "",
    };
    [
        check.quantity.clone(),
        check.exact.map(number).unwrap_or_default(),
        check.computed.map(number).unwrap_or_default(),
        check.error.map(error).unwrap_or_default(),
        bound,
        ok.to_owned(),
    ]
}

/// Ten digits, and a power of ten only where the plain number would hide them.
fn number(value: f64) -> String {
    let size = value.abs();
    if value == value.round() && size < 1e9 {
        format!("{value}")
    } else if (1e-3..1e6).contains(&size) {
        let digits = 9 - size.log10().floor() as i32;
        format!("{value:.*}", digits.max(0) as usize)
    } else {
        format!("{value:.3e}")
    }
}

/// Writes `validation.md` and its figures.
pub(crate) fn write_page(folder: &Path, depth: Depth, all: &[(Box<dyn Case>, Findings)]) -> Result<()> {
    let figures = folder.join("figures");
    fs::create_dir_all(&figures)?;
    for figure in all.iter().flat_map(|(_, findings)| &findings.figures) {
        fs::write(figures.join(figure.file), figure::svg(figure)?)?;
    }
    Ok(fs::write(folder.join("validation.md"), page(depth, all)?)?)
}

fn page(depth: Depth, all: &[(Box<dyn Case>, Findings)]) -> Result<String> {
    let command = match depth {
        Depth::Full => "cargo run --release -p teeter-validation",
        Depth::Short => "cargo run --release -p teeter-validation -- --short --out DIR",
    };
    let mut page = format!(
        "# Validation\n\n\
         Cases with known answers, from a beam at rest to a rocking block. This page is written by\n\n\
         ```sh\n{command}\n```\n\n\
         which exits with 1 if any bound is missed. Every case compares with something independent of the program: a \
         closed form, a quadrature, an identity. Errors below 1e-13 are rounding and are not shown in digits here \
         (the program prints them). SI units; an error is absolute unless its row says *relative*; rows without a \
         bound are only reported.\n"
    );
    for (case, findings) in all {
        write!(page, "\n## {}\n\n{}\n", case.name(), case.about())?;
        if let Some(failure) = &findings.failure {
            write!(page, "\n**Could not run:** {failure}\n")?;
            continue;
        }
        page.push_str("\n| quantity | exact | computed | error | bound | ok |\n|---|---:|---:|---:|---:|---|\n");
        for check in &findings.checks {
            writeln!(page, "| {} |", cells(check, Digits::Lasting).join(" | "))?;
        }
        for figure in &findings.figures {
            write!(page, "\n![{}](figures/{})\n\n{}\n", figure.title, figure.file, figure.caption)?;
        }
    }
    Ok(page)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_ten_digits_where_that_is_readable() {
        assert_eq!(number(0.106_510_249_425_778_7), "0.1065102494");
        assert_eq!(number(166.700_937_859), "166.7009379");
        assert_eq!(number(1.0), "1");
        assert_eq!(number(-4.2e-7), "-4.200e-7");
    }

    #[test]
    fn a_missed_bound_stands_out() {
        let missed = Check::absolute("x, m", 1.0, 2.0, 0.5);
        assert_eq!(cells(&missed, Digits::Lasting).join("|"), "x, m|1|2|1.0e0|5.0e-1|NO");
    }

    #[test]
    fn the_page_has_no_digits_of_rounding_and_the_screen_has() {
        let check = Check::absolute("x, m", 0.0, 2e-16, 1e-10);
        assert_eq!(cells(&check, Digits::All).join("|"), "x, m|0|2.000e-16|2.0e-16|1.0e-10|yes");
        assert_eq!(cells(&check, Digits::Lasting).join("|"), "x, m|0|0|< 1e-13|1.0e-10|yes");
        let strict = Check::worst("x, m", 2e-16, 1e-16);
        assert_eq!(cells(&strict, Digits::Lasting).join("|"), "x, m|||2.0e-16|1.0e-16|NO");
    }
}
