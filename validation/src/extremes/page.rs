//! The rows on the screen, and the page.

use super::families::Family;
use super::maps::Map;
use super::measure::{Ending, Measured};
use super::row::Row;
use super::{Finding, demands};
use crate::case::{Depth, Result};
use crate::figure;
use std::fmt::Write as _;
use std::fs;
use std::io::Write;
use std::path::Path;

/// A row on the screen.
pub(crate) fn write_line(out: &mut dyn Write, row: &Row, m: &Measured, wrong: &[String]) -> Result<()> {
    let told = match &m.ending {
        Ending::Complete => {
            format!(
                "gain {:.0e} residual {:.0e} depth {:.0e} ({:.2}) solver {:.0e} unconverged {} iterations {} solves {} impacts {}{}",
                m.gain,
                m.residual,
                m.depth,
                m.penetration,
                m.solver,
                m.unconverged,
                m.iterations,
                m.solves,
                m.impacts,
                if m.warnings.is_empty() { String::new() } else { format!(" warnings {}", m.warnings.len()) }
            )
        }
        Ending::Refused(message) | Ending::Failed(message) => {
            format!("{} after {} steps: {message}", m.ending.word(), m.steps)
        }
    };
    let verdict = if wrong.is_empty() { String::new() } else { format!("  WORSE: {}", wrong.join("; ")) };
    Ok(writeln!(out, "{:<44} {told}{verdict}", row.name)?)
}

/// A relative number; rounding has no digits on the page, as it would change with the processor.
fn relative(value: f64) -> String {
    if value < 1e-13 { "< 1e-13".to_owned() } else { format!("{value:.0e}") }
}

/// Writes the page.
pub(crate) fn write(folder: &Path, depth: Depth, found: &[(Family, Vec<Finding>)], maps: &[Map]) -> Result<()> {
    let figures = folder.join("figures");
    fs::create_dir_all(&figures)?;
    for figure in maps.iter().flat_map(|map| &map.figures) {
        fs::write(figures.join(figure.file), figure::svg(figure)?)?;
    }
    Ok(fs::write(folder.join("extremes.md"), page(depth, found, maps)?)?)
}

fn page(depth: Depth, found: &[(Family, Vec<Finding>)], maps: &[Map]) -> Result<String> {
    let command = match depth {
        Depth::Full => "cargo run --release -p teeter-validation -- --extremes",
        Depth::Short => "cargo run --release -p teeter-validation -- --extremes --short --out DIR",
    };
    let mut page = HEAD.replace("COMMAND", command);
    let all = || found.iter().flat_map(|(_, findings)| findings);
    let count = |of: &dyn Fn(&Finding) -> bool| all().filter(|finding| of(finding)).count();
    writeln!(
        page,
        "\n{} rows: {} complete, {} refused with a reason, {} failed; {} miss a requirement and are listed \
         first.\n",
        all().count(),
        count(&|f| f.measured.ending == Ending::Complete),
        count(&|f| matches!(f.measured.ending, Ending::Refused(_))),
        count(&|f| matches!(f.measured.ending, Ending::Failed(_))),
        count(&|f| !f.missed.is_empty()),
    )?;
    page.push_str("## Missed\n\n");
    if all().all(|finding| finding.missed.is_empty()) {
        page.push_str("Nothing.\n");
    } else {
        page.push_str("| row | misses | why |\n|---|---|---|\n");
        for finding in all() {
            for demand in &finding.missed {
                let why = demands::reason(&finding.row, *demand).unwrap_or("new");
                writeln!(page, "| {} | {} | {why} |", finding.row.name, demand.word())?;
            }
        }
    }
    for Map { title, about, says, figures } in maps {
        write!(page, "\n## {title}\n\n{about}\n\n**{says}**\n")?;
        for figure in figures {
            write!(page, "\n![{}](figures/{})\n", figure.title, figure.file)?;
        }
    }
    page.push_str(HEAVY);
    for (family, findings) in found {
        write!(page, "\n## {}\n\n{}\n\n{TABLE}", family.name, family.about)?;
        for Finding { row, measured: m, .. } in findings {
            let name = row.name.trim_start_matches(family.name).trim_start_matches('/');
            if m.ending == Ending::Complete {
                writeln!(
                    page,
                    "| {name} | {} | {} | {} | {:.0e} | {:.2} | {} | {} | {} | {} | {} |",
                    m.steps,
                    relative(m.gain),
                    relative(m.residual),
                    m.depth,
                    m.penetration,
                    relative(m.solver),
                    m.unconverged,
                    m.iterations,
                    m.impacts,
                    m.warnings.len(),
                )?;
            } else {
                let (Ending::Refused(message) | Ending::Failed(message)) = &m.ending else { continue };
                writeln!(page, "| {name} | {} | {}: {message} | | | | | | | | |", m.steps, m.ending.word())?;
            }
        }
    }
    Ok(page)
}

const TABLE: &str = "| row | steps | gain | account | depth, m | of bound | solver | unconverged | iterations | impacts | warnings |\n\
                     |---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n";

const HEAD: &str = "# The extremes

Scenes with extreme parameters: each runs without a NaN, without running endlessly and without generating energy, or is refused with a
reason. This page is written by

```sh
COMMAND
```

which exits with 1 if a row misses something without a known reason, or is worse than its stored bound (`validation/bounds.toml`). A row's
scene is one of `validation/extremes/` with some keys changed; this prints it, with the command, and runs it:

```sh
cargo run --release -p teeter-validation -- --scene dt/1e0/beam/closed/e=1 > scene.toml
cargo run --release -- run scene.toml
```

Names of rows: value / base scene / scheme (`open` is moreau-jean, `closed`, `located` and `projected` are moreau-jean-closed, -located and
-projected) / restitution. Every scheme runs every family, with two exceptions: `event-driven`, which takes a tenth of a row's time on beams,
skips the families with fast modes or long runs there, and the solver tolerances are varied with `open` and `closed` only, four of them with
all schemes. Measured over all steps:

- **gain**: the largest gain of energy in a step, Δ(T+V) minus the work of loads, over the scene's energy scale. It must be rounding (1e-13, or
  a thousandth of the contact solver's tolerance) with `closed` and `located`, and is only reported for the others, which don't guarantee it.
- **account**: the largest residual of a step's energy account over the same scale; it must be rounding (1e-12; 1e-10 with `event-driven`, which
  takes many steps of its own, each accurate to 1e-12).
- **depth**: the deepest penetration at the end of a step, m, also as a fraction **of its bound**

      h (c |U_n| + 2σ|U|) + 2 R (h ω)² + 2 gap_tolerance,      c = ½ (moreau-jean-closed), 1 (all others; moreau-jean with γ = ½, θ ≥ ½)

  with the fastest approach |U_n| of an active contact, its fastest relative velocity |U|, the steepest slope σ of the surface under one, the
  fastest spin ω, and R from the mass centre to a corner. A contact that isn't detected in a step ends it at most (1−γ)h|U_n| + θh²a below the
  surface, a being the free acceleration, and is detected in the next, in which its mean normal velocity is still (1−θ)U_n; the acceleration is
  included in |U_n| as measured there, so the sum is h|U_n|. The closed scheme detects it in the step itself: ½h|U_n|. J is evaluated once per
  step, so a rotation by hω moves the corner off its straight path by at most ½R(hω)² before the position of J and R(hω)² after it, and the normal
  of a bending surface can rotate by 2σ until the end of the step. Against sides of a block (family `sides`) c is 1 and 100 m/s² h² is added: a beam rises
  between the corners by its own accelerations before its contact is seen. A depth that first occurs in the last step, without an active contact, is left
  out, as its impact is not part of the run.
- **solver**: the largest residual of a converged solve, over the tolerance; it is recomputed by the judge in every solve, and the row fails if it
  differs from the solver's. **unconverged**: steps reported as unsolved.
- **iterations**: the most in a step, over all its solves. Nothing is timed: an endless run shows as work.
- **warnings**: the number of warnings of `teeter check`.
";

/// What was measured by hand, beside the families.
const HEAVY: &str = "
## Heavy loads on light blocks

What presses on a light block from both sides is millions of times its weight, and rounding and the solver leave some 1e-16 to 1e-13 of it: at a
ratio of masses r the light one is tilted by a share of that times r, and a load r times its weight on a tilt φ squeezes it out with r g φ. So drifts
grow with r². Where corners of blocks of the same width pass each other, a foot is without support for some 0.2 ms, in which the load sinks by some 2e-7 m:
from r = 3e5 on that throws the pile over. (Five blocks of which each is 1 mm narrower than the one below, without friction, drift by 2e-6 at 3e5, and by
1e-4 at 1e6.) Measured: stacks of boxes of 10 cm on the ground, the top one r times as heavy, default settings, steps of
1 ms; the largest change of any coordinate (m, rad) in 0.5 s, of stacks of 3, 5, 8, 12, 16 and 20 the largest:

| r | no friction | friction 0.01 | 0.3 | 0.5 | 0.8 |
|---|---|---|---|---|---|
| 1e4 | 2e-9 | 7e-10 | 8e-11 | 1e-10 | 2e-11 |
| 1e5 | 1e-6 | 2e-6 | 6e-10 | 5e-10 | 1e-10 |
| 3e5 | falls | 1e-3 | 5e-9 | 4e-9 | 2e-10 |
| 1e6 | falls | falls | 2e-8 | 8e-8 | 5e-9 |
| 3e6 | falls | 8e-4 | 5e-2 | 1e-1 | 5e-2 |
| 1e7 | falls | falls | 3e-4 | 4e-2 | 1e-1 |

A smaller `solver.tolerance`, another solver or another scheme is no cure; a shorter step helps: five boxes without friction at r = 1e6 drift by 130 µm at
1 ms, by 52 nm at 0.1 ms. With a light block on top of 4 or 19 that are 1e6 times as heavy it is 5e-7, at 1e8 8e-4; with a heavy one at the bottom 2e-10 at
1e6. On a beam, stacks of five drift by 2e-4 without friction at 1e5, by 3e-12 with 0.5, and from 1e6 on a static start may not be found: it is then refused as if
a block slid or tipped. `teeter check` and a run warn of blocks that can touch and differ by more than 1e6, and with less friction than 0.1 by more than
1e5, unless the heavy one is below.
";
