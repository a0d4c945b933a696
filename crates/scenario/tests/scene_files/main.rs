//! Scene files from outside: what is accepted, what is refused, and with which words; and the
//! motions they give.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stderr)]

mod accumulating;
mod allocations;
mod around_ends;
mod beams;
mod carried;
mod couples;
mod crowds;
mod discs;
mod divided;
mod driven;
mod event_driven;
mod feet;
mod flush;
mod friction;
mod located;
mod many;
mod modes;
mod other_numbers;
mod painleve;
mod polygons;
mod profiles;
mod projected;
mod properties;
mod reading;
mod records;
mod refusing;
mod required;
mod resolved;
mod resolving;
mod resting;
mod rises;
mod running;
mod settings;
mod shapes;
mod sides;
mod stacks;
mod static_starts;
mod supports;
#[cfg(feature = "parallel")]
mod threads;
mod together;
mod too_fast;
mod ways_out;
mod work;
mod writing;

use teeter_scenario::decode::parse;
use teeter_scenario::diagnostic::Diagnostics;
use teeter_scenario::document::Document;

/// The scene of the interface.
const ROCKING: &str = r#"# Free rocking of a rigid block on an elastic beam
title   = "Free rocking of a rigid block on an elastic beam"
version = 1                            # of the scene format; may be left out

[time]
end    = "0.5 s"
step   = "100 us"
scheme = "moreau-jean"
theta  = 0.5

[world]
gravity = "9.81 m/s^2"                 # downwards

[material.aluminium]
density        = "2700 kg/m^3"
youngs_modulus = "69 GPa"

[beam.table]
material  = "aluminium"
span      = "36 cm"
width     = "3 cm"
thickness = "0.15 cm"
elements  = 20
supports  = ["pinned", "pinned"]
damping_ratio = { mode = 1, ratio = 0.01 }
start     = "static"
surface   = "axis"

[block.rocker]
material = "aluminium"
width    = "3 cm"
height   = "13.5 cm"
depth    = "3 cm"
on       = "table"
at       = "18 cm"
tilt     = "5 deg"

[contact.feet]
between     = ["rocker", "table"]
friction    = 0.5
restitution = 0.0
kinematics  = "deformed"

[solver]
method         = "auto"
tolerance      = 1e-10
max_iterations = 10000
require_convergence = false

[output]
every = "1 ms"
"#;

const SHORT: &str = "[time]\nend = '1 s'\nstep = '1 ms'\n";

fn sets(pairs: &[(&str, &str)]) -> Vec<(String, String)> {
    pairs.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect()
}

fn read(source: &str, pairs: &[(&str, &str)]) -> Result<Document, Diagnostics> {
    parse(source, "scene.toml", &sets(pairs))
}

/// "line:column path: rule" of each finding.
fn findings(source: &str, pairs: &[(&str, &str)]) -> Vec<String> {
    let Err(found) = read(source, pairs) else {
        return Vec::new();
    };
    found
        .iter()
        .map(|found| match (&found.set, found.position) {
            (Some(set), _) => format!("--set {set} {}: {}", found.path, found.rule),
            (None, Some((line, column))) => {
                format!("{line}:{column} {}: {}", found.path, found.rule)
            }
            (None, None) => format!("{}: {}", found.path, found.rule),
        })
        .collect()
}
