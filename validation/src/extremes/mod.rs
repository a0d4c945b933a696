//! The extremes: scenes at the ends of what can be asked for, each measured, held to what every run must keep and to
//! its own stored bounds; and maps of where the model stops making sense. Writes `docs/extremes.md`.

mod bounds;
mod demands;
mod families;
mod maps;
mod measure;
mod page;
mod row;
mod watched;

use crate::case::{Depth, Result};
use crate::options::Options;
use bounds::{Bound, Bounds};
use demands::Demand;
use families::Family;
use measure::Measured;
use row::Row;
use std::fs;
use std::io::Write;
use std::path::Path;

/// A row with what came of it.
pub(crate) struct Finding {
    row: Row,
    measured: Measured,
    missed: Vec<Demand>,
}

/// Prints the scene of a row.
pub(crate) fn scene(name: &str, out: &mut dyn Write) -> Result<bool> {
    let rows = families::all().into_iter().flat_map(|family| family.rows);
    let row = rows.into_iter().find(|row| row.name == name);
    let row = row.ok_or_else(|| format!("there is no row `{name}`; docs/extremes.md lists them"))?;
    write!(out, "{}", row.scene()?)?;
    Ok(true)
}

/// Runs the rows; whether all of them keep what they must.
pub(crate) fn run(options: &Options, out: &mut dyn Write) -> Result<bool> {
    let file = Path::new(bounds::FILE);
    let stored = if options.write_bounds { Bounds::new() } else { bounds::read(file)? };
    let mut found: Vec<(Family, Vec<Finding>)> = Vec::new();
    let mut fresh = Bounds::new();
    let (mut rows, mut failed) = (0_usize, 0_usize);
    for family in families::all() {
        let wanted = |row: &&Row| options.depth == Depth::Full || !row.long;
        let mut findings = Vec::new();
        if options.only.as_deref().is_some_and(|only| only != family.name) {
            continue;
        }
        for row in family.rows.iter().filter(wanted) {
            let measured = measure::measure(row)?;
            let missed = demands::missed(row, &measured);
            let mut wrong: Vec<String> = missed
                .iter()
                .filter(|demand| demands::reason(row, **demand).is_none())
                .map(|demand| format!("misses `{}`", demand.word()))
                .collect();
            if options.write_bounds {
                fresh.insert(row.name.clone(), Bound::around(&measured));
            } else {
                match stored.get(&row.name) {
                    Some(bound) => wrong.extend(bound.worse(&measured)),
                    None => wrong.push("no bound is stored for it".to_owned()),
                }
            }
            page::write_line(out, row, &measured, &wrong)?;
            rows += 1;
            failed += usize::from(!wrong.is_empty());
            findings.push(Finding { row: row.clone(), measured, missed });
        }
        found.push((family, findings));
    }
    if rows == 0 {
        let names: Vec<_> = families::all().iter().map(|family| family.name).collect();
        return Err(format!("no such family; there are {}", names.join(", ")).into());
    }
    if options.depth == Depth::Full && options.only.is_none() {
        let findings = found.iter().flat_map(|(_, findings)| findings);
        let missed = findings.flat_map(|finding| finding.missed.iter().map(|demand| (&finding.row, *demand)));
        for name in demands::outlived(missed) {
            failed += 1;
            writeln!(out, "{name}: listed as missed, and isn't")?;
        }
        let known = |name: &&String| !found.iter().any(|(_, of)| of.iter().any(|finding| finding.row.name == **name));
        for name in stored.keys().filter(known) {
            failed += 1;
            writeln!(out, "{name}: a bound is stored, and there is no such row")?;
        }
    }
    writeln!(out, "{rows} rows, {failed} of them worse than they must be")?;
    if options.write_bounds {
        fs::write(file, bounds::write(&fresh)?)?;
        writeln!(out, "bounds written to {}", file.display())?;
    }
    if let Some(folder) = &options.out {
        // Maps show, and judge nothing: what they show of the rows is in the bounds.
        let maps = if options.depth == Depth::Full { maps::all()? } else { Vec::new() };
        page::write(folder, options.depth, &found, &maps)?;
        writeln!(out, "written to {}", folder.display())?;
    }
    Ok(failed == 0)
}
