//! Assemblages of many blocks stand when and only when limit analysis says so: arches, stacks, overhangs, piles.

use crate::case::{Case, Check, Depth, Findings, Result};
use std::fmt::Write;
use teeter_scenario::simulation::Simulation;
use teeter_validation::limit_analysis::{
    Assemblage, Block, Point, Side, VoussoirWeight, arch, minimum_thickness, stands, voussoirs,
};

pub(crate) struct Assemblages;

/// Of arches.
const FRICTION: f64 = 0.5;

/// Relative: where an arch's limit must lie.
const OF_THICKNESS: f64 = 0.01;

/// Relative: the width of the last bracket of an arch's limit.
const BRACKET: f64 = 1e-4;

/// Degrees: where a stack's critical tilt must lie.
const TILT: f64 = 0.01;

/// Of a side of 0.1 m: where the limits of overhangs must lie, 0.01 mm.
const EDGE: f64 = 1e-5 / 0.1;

/// For so long all must stand, s.
const DURATION: f64 = 2.0;

/// So far nothing may move, in parts of the size given.
const MOVED: f64 = 1e-3;

impl Case for Assemblages {
    fn name(&self) -> &'static str {
        "assemblages"
    }

    fn about(&self) -> &'static str {
        "Blocks given by their corners, as scenes with default settings and steps of 1 ms. Whatever moves by less than \
         1e-3 of the thickness, side or brick in 2 s stands. The limits of standing, by bisection, compared with limit \
         analysis (case `limit_analysis`) or statics: **arches** of radial voussoirs between fixed springers (μ = 0.5), \
         t/R to 1 %; **stacks** of 0.1 m cubes on a tilted base (μ = 2), the critical angle to 0.01°; one block that \
         **overhangs** a table, the place of its centre to 0.01 mm; the **harmonic stack** of five bricks, whose \
         overhangs w/2, w/4, w/6, w/8, w/10 are all scaled by the same factor, and the best **pile** of three bricks by \
         Paterson and Zwick (*Overhang*, Amer. Math. Monthly 116, 2009; μ = 0.5), the limit to 0.01 mm of 0.1 m; and \
         whether **pyramids**, inverted pyramids and diamonds of bricks stand."
    }

    fn run(&self, depth: Depth) -> Result<Findings> {
        let mut findings = Findings::default();
        arches(depth, &mut findings)?;
        tilted_stacks(depth, &mut findings)?;
        overhangs(depth, &mut findings)?;
        if depth == Depth::Full {
            pyramids(&mut findings)?;
        }
        Ok(findings)
    }
}

/// Blocks at rest, and what doesn't move.
struct Scene {
    blocks: Vec<Vec<Point>>,
    ground: Vec<Vec<Point>>,
    /// Of gravity against −y, rad: the −x side goes down.
    tilt: f64,
    friction: f64,
    /// What motions are compared with, m.
    size: f64,
}

impl Scene {
    fn assemblage(&self) -> Result<Assemblage> {
        let blocks = self.blocks.iter().map(|polygon| Block::uniform(polygon.clone(), 1.0));
        Ok(Assemblage::new(blocks.collect::<std::result::Result<_, _>>()?, &self.ground)?.tilted(self.tilt))
    }

    /// Whether limit analysis finds it standing.
    fn can_stand(&self) -> Result<bool> {
        Ok(stands(&self.assemblage()?, self.friction)?)
    }

    /// The scene file. What limit analysis sees as joints are the contacts.
    fn text(&self) -> Result<String> {
        let assemblage = self.assemblage()?;
        let down = assemblage.down() * 9.81;
        let mut text = format!(
            "[time]\nend = \"{DURATION} s\"\nstep = \"1 ms\"\n[world]\ngravity = [\"{:?} m/s^2\", \"{:?} m/s^2\"]\n\
             [material.stone]\ndensity = \"2000 kg/m^3\"\n",
            down.x, down.y
        );
        let mut add = |name: String, polygon: &[Point], more: &str| {
            let corners: Vec<String> = polygon.iter().map(|p| format!("[\"{:?} m\", \"{:?} m\"]", p.x, p.y)).collect();
            write!(
                text,
                "[block.{name}]\nmaterial = \"stone\"\ndepth = \"1 m\"\npoints = [{}]\n{more}",
                corners.join(", ")
            )
        };
        for (i, polygon) in self.blocks.iter().enumerate() {
            add(format!("b{i}"), polygon, "")?;
        }
        for (i, polygon) in self.ground.iter().enumerate() {
            add(format!("g{i}"), polygon, "motion = { displacement = [\"0 m\", \"0 m\"], angle = \"0 rad\" }\n")?;
        }
        let mut pairs: Vec<[String; 2]> = Vec::new();
        for joint in assemblage.joints() {
            let [Side::Block(i), other] = joint.sides else { return Err("a joint of the ground alone".into()) };
            match other {
                Side::Block(j) => pairs.push([format!("b{i}"), format!("b{j}")]),
                Side::Ground => pairs.extend((0..self.ground.len()).map(|g| [format!("b{i}"), format!("g{g}")])),
            }
        }
        pairs.sort();
        pairs.dedup();
        for (number, [a, b]) in pairs.iter().enumerate() {
            write!(
                text,
                "[contact.c{number}]\nbetween = [\"{a}\", \"{b}\"]\nfriction = {}\nrestitution = 0.0\n",
                self.friction
            )?;
        }
        Ok(text)
    }

    /// Whether its motion stays at the start.
    fn stays(&self) -> Result<bool> {
        let text = self.text()?;
        let resolved = teeter_scenario::load(text.as_bytes(), "assemblage", "assemblage", &[])
            .map_err(|errors| format!("{errors}\n{text}"))?;
        let mut simulation = Simulation::new(&resolved.scene)?;
        simulation.keep_account(teeter_integrator::Account::LeftOut);
        let start = simulation.state.q.clone();
        let moved = |q: &[f64]| start.iter().zip(q).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        while simulation.state.t < DURATION - 1e-9 {
            simulation.step()?;
            let moved = moved(&simulation.state.q);
            if !(moved < MOVED * self.size) {
                return Ok(false);
            }
        }
        Ok(true)
    }
}

/// Between a number at which the scene falls and one at which it stays, where that changes; `None` where it is not so.
fn limit(scene: impl Fn(f64) -> Result<Scene>, mut falls: f64, mut stays: f64, bracket: f64) -> Result<Option<f64>> {
    if scene(falls)?.stays()? || !scene(stays)?.stays()? {
        return Ok(None);
    }
    while (stays - falls).abs() > bracket {
        let middle = 0.5 * (falls + stays);
        if scene(middle)?.stays()? { stays = middle } else { falls = middle }
    }
    Ok(Some(0.5 * (falls + stays)))
}

fn arches(depth: Depth, findings: &mut Findings) -> Result<()> {
    let cases: &[(usize, f64)] = match depth {
        Depth::Short => &[(27, 180.0)],
        Depth::Full => &[(9, 180.0), (15, 180.0), (27, 180.0), (51, 180.0), (27, 160.0), (15, 140.0), (10, 120.0)],
    };
    for &(n, degrees) in cases {
        let angle: f64 = f64::to_radians(degrees);
        let known = minimum_thickness(n, angle, FRICTION)?.ok_or("no arch stands")?;
        let scene = |thickness: f64| -> Result<Scene> {
            let springer = 0.1_f64;
            let turned = |centre: f64| -> Result<Vec<Point>> {
                let mut one = voussoirs(1, springer, 1.0, thickness)?;
                let (sin, cos) = centre.sin_cos();
                let turn = |p: Point| Point::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y);
                Ok(one.remove(0).into_iter().map(turn).collect())
            };
            let beside = 0.5 * (angle + springer);
            Ok(Scene {
                blocks: voussoirs(n, angle, 1.0, thickness)?,
                ground: vec![turned(-beside)?, turned(beside)?],
                tilt: 0.0,
                friction: FRICTION,
                size: thickness,
            })
        };
        // The springers of the two analyses are the same.
        let theirs = arch(n, angle, 1.0, known, VoussoirWeight::Polygon)?;
        if scene(known)?.assemblage()?.joints().len() != theirs.joints().len() {
            return Err("the arches of scene and limit analysis differ".into());
        }
        let [low, high] = [1.0 - OF_THICKNESS, 1.0 + OF_THICKNESS].map(|factor| factor * known);
        let bracket = if depth == Depth::Full { BRACKET * known } else { high - low };
        let found = limit(scene, low, high, bracket)?.unwrap_or(f64::NAN);
        let quantity = format!("arch of {n} voussoirs, {degrees}°: t/R, relative");
        findings.checks.push(Check::relative(quantity, known, found, OF_THICKNESS));
    }
    Ok(())
}

/// A rectangle by its left bottom corner and its sides, m.
fn rectangle(left: f64, bottom: f64, width: f64, height: f64) -> Vec<Point> {
    [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)].map(|(x, y)| Point::new(left + x, bottom + y)).to_vec()
}

/// Of cubes and bricks, m.
const SIDE: f64 = 0.1;

fn tilted_stacks(depth: Depth, findings: &mut Findings) -> Result<()> {
    let counts: &[usize] = if depth == Depth::Full { &[1, 2, 5, 10] } else { &[5] };
    for &n in counts {
        let known = (1.0 / n as f64).atan().to_degrees();
        let scene = |degrees: f64| Scene {
            blocks: (0..n).map(|i| rectangle(0.0, SIDE * i as f64, SIDE, SIDE)).collect(),
            ground: vec![rectangle(-1.0, -1.0, 3.0, 1.0)],
            tilt: degrees.to_radians(),
            friction: 2.0,
            size: SIDE,
        };
        let found = limit(|degrees| Ok(scene(degrees)), known + 0.5 * TILT, known - 0.5 * TILT, 0.1 * TILT)?
            .unwrap_or(f64::NAN);
        findings.checks.push(Check::absolute(format!("stack of {n} cubes: critical tilt, °"), known, found, TILT));
    }
    Ok(())
}

/// Bricks of width [`SIDE`] and 0.4 of its height, each given by its left end, in its widths, and its row; on a table that
/// ends at `edge`.
fn pile(bricks: &[(f64, usize)], edge: f64) -> Scene {
    let brick = |&(left, row): &(f64, usize)| rectangle(SIDE * left, 0.4 * SIDE * row as f64, SIDE, 0.4 * SIDE);
    Scene {
        blocks: bricks.iter().map(brick).collect(),
        ground: vec![rectangle(SIDE * (edge - 10.0), -1.0, SIDE * 10.0, 1.0)],
        tilt: 0.0,
        friction: FRICTION,
        size: SIDE,
    }
}

fn overhangs(depth: Depth, findings: &mut Findings) -> Result<()> {
    let mut add = |what: &str, scene: &dyn Fn(f64) -> Scene, known: f64, steps: f64| -> Result<()> {
        let found =
            limit(|edge| Ok(scene(edge)), known - steps * EDGE, known + steps * EDGE, 0.1 * EDGE)?.unwrap_or(f64::NAN);
        findings.checks.push(Check::absolute(what, known, found, EDGE));
        Ok(())
    };
    add("one brick: the table's edge from its middle, widths", &|edge| pile(&[(-0.5, 0)], edge), 0.0, 1.0)?;
    if depth == Depth::Short {
        return Ok(());
    }
    // From the top down each reaches 1/(2k) beyond the next.
    let harmonic = |edge: f64| {
        let scale = 1.0 - edge;
        let mut left = 0.0;
        let mut bricks = vec![(0.0, 4)];
        for k in 1..5 {
            left -= scale * 0.5 / f64::from(k);
            bricks.push((left, 4 - k as usize));
        }
        pile(&bricks, left + 1.0 - scale * 0.1)
    };
    add("harmonic stack of five: what its overhangs fall short by, relative", &harmonic, 0.0, 1.0)?;
    let three = [(-0.5, 0), (-1.0, 1), (0.0, 1)];
    add("best pile of three: the table's edge from its middle, widths", &|edge| pile(&three, edge), 0.0, 1.0)?;
    Ok(())
}

/// Rows of bricks side by side, each row centred.
fn rows(counts: &[usize]) -> Vec<(f64, usize)> {
    let row = |(row, &count): (usize, &usize)| (0..count).map(move |i| (i as f64 - 0.5 * count as f64, row));
    counts.iter().enumerate().flat_map(row).collect()
}

fn pyramids(findings: &mut Findings) -> Result<()> {
    let mut wrong = 0_u32;
    let mut compared = 0_u32;
    for m in 1..=6_usize {
        let upright: Vec<_> = (1..=m).rev().collect();
        let inverted: Vec<_> = (1..=m).collect();
        let diamond: Vec<_> = (1..=m).chain((1..m).rev()).collect();
        for counts in [upright, inverted, diamond] {
            let scene = pile(&rows(&counts), 5.0);
            compared += 1;
            if scene.stays()? != scene.can_stand()? {
                wrong += 1;
            }
        }
    }
    let quantity = format!("pyramids, inverted ones, diamonds of 1 to 6 rows: wrong of {compared}");
    findings.checks.push(Check::worst(quantity, f64::from(wrong), 0.0));
    Ok(())
}
