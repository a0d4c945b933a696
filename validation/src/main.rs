//! The validation ladder: cases with known answers, from a beam at rest to a rocking block.
//!
//! Every case compares the program with something that isn't the program: a closed form, a quadrature, an identity, a
//! bound derived on paper. The program prints one table, writes `validation.md` with its figures, and exits with 1 if
//! any bound is missed. A new case is a file in `cases/` and a line in [`cases::all`].

mod case;
mod cases;
mod exact;
mod extremes;
mod figure;
mod fit;
mod modes;
mod options;
mod report;
mod scene;

use case::{Findings, Result};
use options::{Asked, Options};
use std::io::Write;
use std::process::ExitCode;

fn main() -> ExitCode {
    let mut out = std::io::stdout().lock();
    let done = match options::parse(std::env::args().skip(1)) {
        Ok(Asked::Help) => out.write_all(options::HELP.as_bytes()).map(|()| true).map_err(Into::into),
        Ok(Asked::Scene(row)) => extremes::scene(&row, &mut out),
        Ok(Asked::Run(options)) if options.extremes => extremes::run(&options, &mut out),
        Ok(Asked::Run(options)) => validate(&options, &mut out),
        Err(wrong) => {
            let _ = writeln!(std::io::stderr(), "{wrong}\n\n{}", options::HELP);
            return ExitCode::from(2);
        }
    };
    match done {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            let _ = writeln!(std::io::stderr(), "{error}");
            ExitCode::FAILURE
        }
    }
}

/// Runs all cases; whether every bound holds.
fn validate(options: &Options, out: &mut dyn Write) -> Result<bool> {
    let mut all = Vec::new();
    let mut broken = 0;
    report::write_head(out)?;
    let wanted = |name: &str| options.only.as_deref().is_none_or(|only| only == name);
    let cases: Vec<_> = cases::all().into_iter().filter(|case| wanted(case.name())).collect();
    if cases.is_empty() {
        let names: Vec<_> = cases::all().iter().map(|case| case.name()).collect();
        return Err(format!("no such case; there are {}", names.join(", ")).into());
    }
    for case in cases {
        let findings = case.run(options.depth).unwrap_or_else(|error| {
            broken += 1;
            Findings::broken(error.as_ref())
        });
        report::write_rows(out, case.name(), &findings)?;
        all.push((case, findings));
    }
    let missed = all.iter().map(|(_, findings)| findings.missed()).sum::<usize>();
    let checks = all.iter().map(|(_, findings)| findings.checks.len()).sum::<usize>();
    writeln!(out, "{checks} rows, {missed} bounds missed, {broken} cases that could not run")?;
    if let Some(folder) = &options.out {
        report::write_page(folder, options.depth, &all)?;
        writeln!(out, "written to {}", folder.display())?;
    } else {
        writeln!(out, "a short run, or one of a single case, writes no files unless --out says where")?;
    }
    Ok(missed + broken == 0)
}
