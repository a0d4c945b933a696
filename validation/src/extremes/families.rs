//! The table's rows: families of scenes, each swept over an extreme.

use super::row::{Base, Row, Scheme, Sets};
use teeter_integrator::EventDriven;

/// Scenes in which one thing goes from one extreme to the other.
#[derive(Clone, Debug)]
pub(crate) struct Family {
    pub(crate) name: &'static str,
    /// What is swept, for the page.
    pub(crate) about: &'static str,
    pub(crate) rows: Vec<Row>,
}

const BOTH: [Base; 2] = [Base::Ground, Base::Beam];

/// Block's mass over beam's mass in the base scene.
const MASS_RATIO: f64 = 7.5;

/// First frequency of the base scene's beam, Hz.
const FREQUENCY: f64 = 26.531_268;

/// End of a row that doesn't say otherwise, s: that of the base scenes.
const END: f64 = 0.4;

/// Families that go to the fastest of modes, or on for long. `event-driven` takes steps as short as these turn, and follows every rattle: its
/// rows on beams are left out there.
const TOO_DEAR: [&str; 9] = ["beam-mass", "neighbour", "dt", "f-dt", "elements", "modulus", "size", "sides", "impacts"];

/// How much of a row `event-driven` computes on a beam: there it follows every rattle.
const PART: f64 = 0.1;

/// Steps of a row that doesn't say otherwise.
const STEPS: f64 = 4000.0;

impl Family {
    fn new(name: &'static str, about: &'static str) -> Self {
        Self { name, about, rows: Vec::new() }
    }

    /// Adds a value's rows: each base, every scheme, e = 0 and 1.
    fn add(&mut self, value: &str, bases: &[Base], sets: impl Fn(Base) -> Sets) {
        for &base in bases {
            for scheme in Scheme::all() {
                let dear = scheme.0 == EventDriven::NAME && base != Base::Ground;
                if dear && TOO_DEAR.contains(&self.name) {
                    continue;
                }
                for e in ["0", "1"] {
                    let mut all = sets(base);
                    all.push(("time.scheme".to_owned(), scheme.word().to_owned()));
                    for contact in base.contacts() {
                        all.push((format!("contact.{contact}.restitution"), e.to_owned()));
                    }
                    if dear {
                        all.push(set("time.end", format!("{:e} s", end(&all) * PART)));
                    }
                    self.rows.push(Row {
                        name: format!("{}/{value}/{}/{}/e={e}", self.name, base.word(), scheme.short()),
                        base,
                        scheme,
                        sets: all,
                        long: dear,
                    });
                }
            }
        }
    }

    /// The rows added last, `count` of them, are for full runs only.
    fn long(&mut self, count: usize) {
        self.rows.iter_mut().rev().take(count).for_each(|row| row.long = true);
    }
}

fn set(key: &str, value: impl Into<String>) -> (String, String) {
    (key.to_owned(), value.into())
}

/// The end that these keys give, s.
fn end(sets: &[(String, String)]) -> f64 {
    let given = sets.iter().rev().find(|(key, _)| key == "time.end");
    given.and_then(|(_, end)| end.strip_suffix(" s")?.parse().ok()).unwrap_or(END)
}

fn length(value: f64) -> String {
    format!("{value:e} m")
}

/// A step, and an end so many steps later.
fn stepped(dt: f64, steps: f64) -> Sets {
    vec![set("time.step", format!("{dt:e} s")), set("time.end", format!("{:e} s", dt * steps))]
}

fn powers(low: i32, high: i32, by: usize) -> impl Iterator<Item = (String, f64)> {
    (low..=high).step_by(by).map(|n| (format!("1e{n}"), 10_f64.powi(n)))
}

/// All rows.
pub(crate) fn all() -> Vec<Family> {
    vec![
        block_mass(),
        beam_mass(),
        neighbours(),
        slenderness(),
        theta(),
        step(),
        frequency_step(),
        friction(),
        elements(),
        modulus(),
        size(),
        tilt(),
        place(),
        sides(),
        impacts(),
        tolerance(),
        restitution(),
    ]
}

fn block_mass() -> Family {
    let mut family = Family::new("block-mass", "Ratio of the block's mass to the beam's, by the block's density.");
    for (value, ratio) in powers(-6, 6, 1) {
        let density = format!("{:e} kg/m^3", 2700.0 * ratio / MASS_RATIO);
        family.add(&value, &[Base::Beam], |_| vec![set("material.aluminium.density", density.as_str())]);
    }
    family
}

fn beam_mass() -> Family {
    let mut family =
        Family::new("beam-mass", "The same ratio by the beam's density: light and heavy beams of the same stiffness.");
    for (value, ratio) in powers(-6, 6, 1) {
        let density = format!("{:e} kg/m^3", 2700.0 * MASS_RATIO / ratio);
        family.add(&value, &[Base::Beam], |_| vec![set("material.spring.density", density.as_str())]);
    }
    family
}

fn neighbours() -> Family {
    let mut family =
        Family::new("neighbour", "Two blocks on one beam: ratio of the cube's density to that of the rocking block.");
    for (value, ratio) in powers(-6, 6, 2) {
        let density = format!("{:e} kg/m^3", 2700.0 * ratio);
        family.add(&value, &[Base::Two], |_| vec![set("material.other.density", density.as_str())]);
    }
    family
}

fn slenderness() -> Family {
    let mut family =
        Family::new("slenderness", "H/b of the block, released from half its critical angle, at constant mass.");
    for (value, ratio) in
        [("0.1", 0.1), ("0.3", 0.3), ("1", 1.0), ("3", 3.0), ("10", 10.0), ("30", 30.0), ("100", 100.0)]
    {
        family.add(value, &BOTH, |_| {
            vec![
                set("block.rocker.height", length(0.03 * ratio)),
                set("block.rocker.tilt", format!("{:e} rad", 0.5 * (1.0 / ratio).atan())),
                set("material.aluminium.density", format!("{:e} kg/m^3", 2700.0 * 4.5 / ratio)),
            ]
        });
    }
    family
}

fn theta() -> Family {
    let mut family = Family::new(
        "theta",
        "θ of the scheme. All schemes but `moreau-jean` require ½, and θ below ½ must be allowed by the scene; other \
         rows are refused.",
    );
    for value in ["0.4", "0.5", "0.500001", "0.51", "0.6", "0.75", "0.9", "0.999", "1"] {
        family.add(value, &BOTH, |_| vec![set("time.theta", value)]);
    }
    family
}

/// A block that turns back to its other foot at 1 rad/s, or as fast as half its critical angle allows: within the run there is an impact
/// whatever the step.
fn turning_back(end: f64) -> Sets {
    let alpha = (0.03_f64 / 0.135).atan();
    let tilt = (0.4 * end).min(0.5 * alpha);
    vec![
        set("block.rocker.tilt", format!("{tilt:e} rad")),
        set("block.rocker.spin", "-1 rad/s"),
        set("block.rocker.velocity", velocity(tilt)),
    ]
}

/// Of the mass centre, where the block turns about its left foot at −1 rad/s.
fn velocity(tilt: f64) -> String {
    let (sin, cos) = tilt.sin_cos();
    // r from the foot to the centre, then ω k × r = ω (−r_y, r_x).
    let r = [0.015 * cos - 0.0675 * sin, 0.015 * sin + 0.0675 * cos];
    format!("[\"{:e} m/s\", \"{:e} m/s\"]", r[1], -r[0])
}

fn step() -> Family {
    let mut family = Family::new(
        "dt",
        "The step, for 4000 steps: the block rotates about its left foot at 1 rad/s towards its right one.",
    );
    for (value, dt) in powers(-8, 0, 1) {
        family.add(&value, &BOTH, |_| [stepped(dt, STEPS), turning_back(dt * STEPS)].concat());
    }
    family
}

fn frequency_step() -> Family {
    let mut family = Family::new("f-dt", "The step times the first frequency of the beam, for the same motion.");
    for (value, steps) in powers(-6, 4, 1) {
        let dt = steps / FREQUENCY;
        family.add(&value, &[Base::Beam], |_| [stepped(dt, STEPS), turning_back(dt * STEPS)].concat());
    }
    family
}

fn friction() -> Family {
    let mut family = Family::new("friction", "The coefficient of friction.");
    for value in ["0", "1e-6", "1e-3", "0.1", "0.22", "1", "10", "1e3", "1e6"] {
        family.add(value, &BOTH, |_| vec![set("contact.feet.friction", value)]);
    }
    family
}

fn elements() -> Family {
    let mut family = Family::new("elements", "Elements of the beam; from 200 elements on only 500 steps.");
    for value in ["1", "2", "3", "5", "10", "50", "100", "200", "500", "1000", "2000"] {
        let many = value.len() > 2 && value != "100";
        family.add(value, &[Base::Beam], |_| {
            let steps = if many { stepped(1e-3, 500.0) } else { Sets::new() };
            [vec![set("beam.table.elements", value)], steps].concat()
        });
        if many {
            family.long(2 * (Scheme::all().count() - 1));
        }
    }
    family
}

fn modulus() -> Family {
    let mut family = Family::new("modulus", "Young's modulus of the beam, Pa.");
    for (value, modulus) in powers(3, 15, 1) {
        let modulus = format!("{modulus:e} Pa");
        family.add(&value, &[Base::Beam], |_| vec![set("material.spring.youngs_modulus", modulus.as_str())]);
    }
    family
}

fn size() -> Family {
    let mut family = Family::new(
        "size",
        "All lengths scaled, with the block's width given in m; the step scales with the root of the size, as for \
         motion under gravity. Young's modulus is constant, so large beams are soft and small ones stiff.",
    );
    for (value, width) in powers(-6, 3, 1) {
        family.add(&value, &BOTH, |base| {
            let size = width / 0.03;
            let mut sets = stepped(1e-4 * size.sqrt(), STEPS);
            let block = [("width", 0.03), ("height", 0.135), ("depth", 0.03), ("at", 0.18)];
            sets.extend(block.iter().map(|(key, x)| set(&format!("block.rocker.{key}"), length(x * size))));
            if base == Base::Beam {
                let beam = [("span", 0.36), ("width", 0.03), ("thickness", 0.0015)];
                sets.extend(beam.iter().map(|(key, x)| set(&format!("beam.table.{key}"), length(x * size))));
            }
            sets
        });
    }
    family
}

fn tilt() -> Family {
    let mut family = Family::new(
        "tilt",
        "The initial tilt, in rad or as a fraction of the critical angle α: flat, flat up to rounding, almost \
         overturned, overturned, on its side.",
    );
    let alpha = (0.03_f64 / 0.135).atan();
    let parts = [("0.9999999α", 0.999_999_9), ("α", 1.0), ("1.0000001α", 1.000_000_1), ("2α", 2.0)];
    let angles = [("0", 0.0), ("1e-15", 1e-15), ("1e-12", 1e-12), ("1e-8", 1e-8), ("1e-4", 1e-4)].into_iter();
    let angles = angles.chain(parts.map(|(value, part)| (value, part * alpha)));
    for (value, angle) in angles.chain([("pi/2", std::f64::consts::FRAC_PI_2)]) {
        family.add(value, &BOTH, |_| vec![set("block.rocker.tilt", format!("{angle:e} rad"))]);
    }
    family
}

fn place() -> Family {
    let mut family = Family::new(
        "place",
        "The position of the block's left foot on the beam of 20 elements: on a node, between nodes, off a node by \
         rounding, over a support, off an end; and a flat block that overhangs an end.",
    );
    // The left foot is at `at` less half a width.
    let feet = [
        ("node", 0.18),
        ("node+1e-16", 0.18 + 3e-17),
        ("node+1e-12", 0.18 + 1e-12),
        ("between", 0.189),
        ("support", 0.0),
        ("support+1e-12", 1e-12),
        ("before-support", -1e-9),
        ("off", -0.01),
        ("far-off", -1.0),
        ("right-foot-off", 0.35),
        ("last-node", 0.36),
    ];
    for (value, foot) in feet {
        family.add(value, &[Base::Beam], |_| vec![set("block.rocker.at", length(foot + 0.015))]);
    }
    for (value, at) in
        [("flat-inside", 0.02), ("flat-over-support", 0.015), ("flat-half-off", 0.005), ("flat-mostly-off", -0.005)]
    {
        family
            .add(value, &[Base::Beam], |_| vec![set("block.rocker.at", length(at)), set("block.rocker.tilt", "0 deg")]);
    }
    family
}

fn sides() -> Family {
    let mut family = Family::new(
        "sides",
        "Whole sides of the block against the beam (`points = \"all\"`; the other families have corners only): flat, on \
         its long side, overturned, across the middle third of the beam, past its end; soft and stiff beams, short and \
         long steps.",
    );
    let wide = [("block.rocker.width", "12 cm"), ("block.rocker.height", "6 cm"), ("block.rocker.tilt", "2 deg")];
    let flat = [("block.rocker.tilt", "0 deg")];
    let past_end = [("block.rocker.at", "35 cm"), ("block.rocker.width", "6 cm"), ("block.rocker.tilt", "3 deg")];
    let mut add = |value: &str, given: &[&[(&str, &str)]]| {
        let given = given.iter().flat_map(|given| given.iter()).map(|(key, to)| set(key, *to));
        let all: Sets = given.chain([set("contact.feet.points", "all")]).collect();
        family.add(value, &[Base::Beam], |_| all.clone());
    };
    add("flat", &[&flat]);
    add("flat-up-to-rounding", &[&[("block.rocker.tilt", "1e-12 rad")]]);
    add("5deg", &[]);
    add("2α", &[&[("block.rocker.tilt", "25 deg")]]);
    add("pi/2", &[&[("block.rocker.tilt", "90 deg")]]);
    add("wide", &[&wide]);
    add("past-end", &[&past_end]);
    for modulus in ["1e8", "1e9", "1e13"] {
        let modulus_of = format!("{modulus} Pa");
        add(&format!("wide-{modulus}"), &[&wide, &[("material.spring.youngs_modulus", &modulus_of)]]);
    }
    for (value, step, end) in [("1e-6", "1 us", "4 ms"), ("1e-3", "1 ms", "0.4 s"), ("1e-2", "10 ms", "0.4 s")] {
        add(&format!("wide-dt-{value}"), &[&wide, &[("time.step", step), ("time.end", end)]]);
    }
    family
}

fn impacts() -> Family {
    let mut family = Family::new(
        "impacts",
        "A flat block thrown up so that it bounces a thousand, ten thousand, a million times (e = 1); with e = 0 it \
         falls once and stays, for the same number of steps.",
    );
    // A flight of 10 steps, or 100; two feet land each time.
    for (value, steps, flight) in [("1e3", 1e4, 10.0), ("1e6", 5.6e6, 10.0), ("1e4-slow", 1e6, 100.0)] {
        let (dt, bases): (f64, &[Base]) = (1e-4, if value == "1e6" { &[Base::Ground] } else { &BOTH });
        let velocity = format!("[\"0 m/s\", \"{:e} m/s\"]", 0.5 * 9.81 * flight * dt);
        family.add(value, bases, |_| {
            let thrown = [set("block.rocker.tilt", "0 deg"), set("block.rocker.velocity", velocity.as_str())];
            [stepped(dt, steps), thrown.to_vec()].concat()
        });
        if steps > 1e5 {
            family.long(2 * Scheme::all().count() * bases.len());
        }
    }
    family
}

fn tolerance() -> Family {
    let mut family = Family::new("tolerance", "The contact solver's tolerance, by method.");
    for method in ["auto", "pgs", "enumeration"] {
        for (value, tolerance) in powers(-15, -2, 1) {
            family.add(&format!("{method}-{value}"), &BOTH, |_| {
                vec![set("solver.method", method), set("solver.tolerance", format!("{tolerance:e}"))]
            });
        }
    }
    // All methods against all tolerances once; the other schemes at four of them.
    let told = ["auto-1e-15/", "auto-1e-10/", "auto-1e-6/", "auto-1e-2/"];
    family.rows.retain(|row| {
        [Scheme::OPEN, Scheme::CLOSED].contains(&row.scheme) || told.iter().any(|value| row.name.contains(value))
    });
    family
}

fn restitution() -> Family {
    let mut family = Family::new("restitution", "Restitution near 0 and 1; the row's e is the value in its name.");
    for value in ["1e-15", "0.5", "0.999999"] {
        family.add(value, &BOTH, |_| Sets::new());
        let rows = family.rows.len();
        // Not crossed with e: it is what is swept.
        let added = family.rows.split_off(rows - 2 * Scheme::all().count() * BOTH.len());
        for mut row in added.into_iter().filter(|row| row.name.ends_with("e=0")) {
            row.name.truncate(row.name.len() - "/e=0".len());
            row.sets.retain(|(key, _)| key != "contact.feet.restitution");
            row.sets.push(set("contact.feet.restitution", value));
            family.rows.push(row);
        }
    }
    family
}
