//! Impacts of several contacts, and what Newton's law with friction does to the energy.

use crate::case::{Case, Check, Depth, Findings, Result};
use crate::exact::three_balls::{HERTZ, ONE_AFTER_THE_OTHER, at_once, linear_springs};
use crate::figure::{Axes, Figure, Series};
use crate::scene::{PAPER_BLOCK, Runner, Start, Stepping, block_over};
use nalgebra::{Matrix2, Rotation2, Vector2};
use std::ops::ControlFlow;
use teeter_detect::{
    Anchor, BodyId, Candidate, Candidates, ContactDetector, ContactId, DetectorMemory, Geometry, LawId, plane_frame,
};
use teeter_integrator::{Block, Blocks, Ground, ImpactLaw, Model, ModelBuilder, PairLaw};
use teeter_rigid::{MassProperties, Rectangle};

pub(crate) struct ImpactLaws;

/// Rounding of a step.
const EXACT: f64 = 1e-12;

impl Case for ImpactLaws {
    fn name(&self) -> &'static str {
        "impact_laws"
    }

    fn about(&self) -> &'static str {
        "**Three balls in a row** (equal, no friction, the first arrives at 1 m/s, the others are at rest): both \
         contacts at once by Newton's, Poisson's and the energetic law; with a small gap between the second and the \
         third, one impact after the other; with duration, by springs k δ and k δ^{3/2} without damping, compared \
         with a closed form and an integration (k = 1e6, h = 1e-6 s, some thousand steps per contact: second order, \
         some 1e-6). With e > 0 at the second contact only (`docs/laws.md`), Newton's law has no restitution, as \
         that contact doesn't approach, while Poisson's law has: (1/6, 1/6, 2/3). **Kane and Levinson's energy \
         gain**: the slender block, tilted by 20°, hits the ground with its left corner at 1 m/s, e = 1, μ = 0.5, no \
         weight. Energy after over before, compared with the law solved by hand with the corner's H: by Newton's law \
         it grows if the corner sticks against a slow slide of the right sign; the energetic law has f < 1 there, so \
         that it is conserved; `moreau-jean-closed` restores the tangential velocity instead."
    }

    fn run(&self, _: Depth) -> Result<Findings> {
        let mut findings = Findings::default();
        let mut runners = Stepping::ALL.map(Runner::new);
        for runner in &mut runners {
            balls(runner, &mut findings)?;
        }
        gain(&mut runners, &mut findings)?;
        findings.checks.extend(runners.iter().flat_map(Runner::account));
        Ok(findings)
    }
}

/// Contacts between neighbours in a row along x.
#[derive(Debug)]
struct Row {
    laws: Vec<LawId>,
}

/// Half the width of a ball, m.
const HALF: f64 = 0.5;

impl ContactDetector<2> for Row {
    fn detect(&self, at: &dyn Geometry<2>, margin: f64, _: &mut DetectorMemory, out: &mut Candidates<2>) {
        out.clear();
        for (k, &law) in self.laws.iter().enumerate() {
            let k = k as u32;
            // Of the right one on the left one: a velocity > 0 parts them.
            let sides =
                [(k + 1, -HALF), (k, HALF)].map(|(body, x)| Anchor { body: BodyId(body), point: Vector2::new(x, 0.0) });
            let [right, left] = sides.each_ref().map(|side| {
                let mut place = [Vector2::zeros()];
                at.place(side.body, &[side.point], &mut place);
                place[0].x
            });
            let gap = right - left;
            if gap <= margin {
                out.push(Candidate { id: ContactId::new(k, 0), law, sides, frame: plane_frame(&Vector2::x()), gap });
            }
        }
    }

    fn capacity(&self) -> usize {
        self.laws.len()
    }
}

/// Three balls of 1 kg with these laws between them.
fn row(laws: [PairLaw; 2]) -> Result<Model<2>> {
    let shape = Rectangle::new(2.0 * HALF, 2.0 * HALF)?;
    let mass = MassProperties::rectangle(&shape, 1.0, 1.0)?;
    let mut parts = ModelBuilder::new();
    parts.add(Blocks::new(vec![Block::new(mass, &shape); 3], Vector2::zeros()));
    let laws = laws.map(|law| parts.law(law)).to_vec();
    Ok(parts.build(Box::new(Row { laws }))?)
}

/// Velocities after everything is over, with gaps between the balls.
fn collide(runner: &mut Runner, laws: [PairLaw; 2], gaps: [f64; 2], dt: f64, steps: u64) -> Result<[f64; 3]> {
    let model = row(laws)?;
    let (mut q, mut v) = (vec![0.0; 9], vec![0.0; 9]);
    q[3] = 2.0 * HALF + gaps[0];
    q[6] = q[3] + 2.0 * HALF + gaps[1];
    v[0] = 1.0;
    let end = runner.run(&model, &Start { q, v, dt, theta: 0.5 }, steps, |_, _| ControlFlow::Continue(()))?;
    Ok([end.v[0], end.v[3], end.v[6]])
}

fn balls(runner: &mut Runner, findings: &mut Findings) -> Result<()> {
    let name = runner.name();
    let mut check = |what: &str, exact: [f64; 3], found: [f64; 3], bound: f64| {
        let off = found.iter().zip(exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let exact = exact.map(|v| format!("{v:.6}")).join(", ");
        findings.checks.push(Check::worst(format!("{name}, {what}: ({exact}), worst, m/s"), off, bound));
    };
    let laws = |impact, e: [f64; 2]| e.map(|e| PairLaw::new(0.0, e).with_impact(impact));
    for (word, impact) in
        [("Newton", ImpactLaw::Newton), ("Poisson", ImpactLaw::Poisson), ("energetic", ImpactLaw::Energetic)]
    {
        for e in [0.0, 0.5, 1.0] {
            let found = collide(runner, laws(impact, [e, e]), [0.0, 0.0], 1e-3, 10)?;
            check(&format!("{word}, e = {e}"), at_once(e), found, EXACT);
        }
    }
    let third = 1.0 / 3.0;
    let found = collide(runner, laws(ImpactLaw::Newton, [0.0, 1.0]), [0.0, 0.0], 1e-3, 10)?;
    check("Newton, e = (0, 1)", [third; 3], found, EXACT);
    let found = collide(runner, laws(ImpactLaw::Newton, [1.0, 1.0]), [0.0, 0.01], 1e-3, 100)?;
    check("Newton, e = 1, a gap of 0.01 m", ONE_AFTER_THE_OTHER, found, EXACT);
    let stiffness = 1e6;
    let spring = ImpactLaw::KelvinVoigt { stiffness, damping: 0.0 };
    let found = collide(runner, laws(spring, [0.0; 2]), [0.0; 2], 1e-6, 10_000)?;
    check("springs k δ", linear_springs(), found, 5e-6);
    let hertz = ImpactLaw::HuntCrossley { stiffness: 1e8, damping: 0.0, exponent: 1.5 };
    let found = collide(runner, laws(hertz, [0.0; 2]), [0.0; 2], 1e-6, 20_000)?;
    check("springs k δ^{3/2}", HERTZ, found, 5e-6);
    let found = collide(runner, laws(ImpactLaw::Poisson, [0.0, 1.0]), [0.0, 0.0], 1e-3, 10)?;
    let sixth = 1.0 / 6.0;
    check("Poisson, e = (0, 1)", [sixth, sixth, 4.0 * sixth], found, EXACT);
    Ok(())
}

const FRICTION: f64 = 0.5;
const TILT_DEGREES: f64 = 20.0;

/// The corner's inverse effective masses, (normal, tangential), by the block's numbers.
fn delassus() -> Matrix2<f64> {
    let (mass, spec) = (PAPER_BLOCK.mass(), PAPER_BLOCK);
    let inertia = mass * (spec.width * spec.width + spec.height * spec.height) / 12.0;
    let arm = Rotation2::new(TILT_DEGREES.to_radians()) * Vector2::new(-0.5 * spec.width, -0.5 * spec.height);
    // U_n = Ẏ + φ̇ r_x, U_t = Ẋ − φ̇ r_y.
    let turn = Vector2::new(arm.x, -arm.y);
    Matrix2::identity() / mass + turn * turn.transpose() / inertia
}

/// Velocity and impulse (normal, tangential) after an impact that ends with U_n = −e U_n⁻: sticking, or sliding at friction's limit.
fn newton(h: &Matrix2<f64>, u: &Vector2<f64>, e: f64) -> Option<[Vector2<f64>; 2]> {
    let wanted = Vector2::new(-e * u.x, 0.0);
    let stick = h.try_inverse()? * (wanted - u);
    if stick.y.abs() <= FRICTION * stick.x {
        return Some([wanted, stick]);
    }
    let slides = [1.0, -1.0].map(|sign| {
        let p = Vector2::new(1.0, sign * FRICTION) * (-(1.0 + e) * u.x / (h[(0, 0)] + sign * FRICTION * h[(0, 1)]));
        [u + h * p, p]
    });
    slides.into_iter().find(|[after, p]| p.x > 0.0 && after.y * p.y < 0.0)
}

/// Energy after an impact over that before, where only the corner's impulse acts: 1 + ½(U⁻ + U⁺)·p/T⁻.
fn gain([page, closed]: &mut [Runner; 2], findings: &mut Findings) -> Result<()> {
    let mut newton_points = Vec::new();
    let (mut energetic_points, mut closed_points) = (Vec::new(), Vec::new());
    let (mut curve, mut worst) = (Vec::new(), [0.0_f64; 2]);
    let h = delassus();
    let (mut most_energetic, mut most_closed) = (0.0_f64, 0.0_f64);
    for k in -40..=40 {
        let slide = f64::from(k) * 0.05;
        let u = Vector2::new(-1.0, slide);
        let mass = PAPER_BLOCK.mass();
        let before = 0.5 * mass * u.norm_squared();
        let [after, p] = newton(&h, &u, 1.0).ok_or("an impact without an answer")?;
        let exact = 1.0 + 0.5 * (u + after).dot(&p) / before;
        let found = thrown(page, ImpactLaw::Newton, slide)?;
        worst[0] = worst[0].max((found - exact).abs());
        let energetic = thrown(page, ImpactLaw::Energetic, slide)?;
        most_energetic = most_energetic.max(energetic - 1.0);
        // Where Newton's law makes none, the energetic one is it; elsewhere none is lost, if e alone may be made smaller.
        if exact <= 1.0 {
            worst[1] = worst[1].max((energetic - exact).abs());
        }
        let by_closed = thrown(closed, ImpactLaw::Newton, slide)?;
        most_closed = most_closed.max(by_closed - 1.0);
        curve.push((slide, exact));
        newton_points.push((slide, found));
        energetic_points.push((slide, energetic));
        closed_points.push((slide, by_closed));
    }
    let most = curve.iter().fold(0.0_f64, |most, point| most.max(point.1));
    let kept = energetic_points.iter().zip(&curve).filter(|(_, exact)| exact.1 > 1.0);
    let kept = kept.fold(0.0_f64, |worst, (found, _)| worst.max((found.1 - 1.0).abs()));
    findings.checks.extend([
        Check::reported("Newton's law: largest energy after over before", most),
        Check::worst("moreau-jean, Newton: energy after over before, worst of 81 slides", worst[0], EXACT),
        Check::worst("moreau-jean, energetic: gain of energy, largest", most_energetic, EXACT),
        Check::worst("moreau-jean, energetic: difference from Newton's law where it gains nothing", worst[1], EXACT),
        Check::worst("moreau-jean, energetic: difference from 1 where Newton's law gains", kept, 1e-9),
        Check::worst("moreau-jean-closed, Newton: gain of energy, largest", most_closed, EXACT),
    ]);
    findings.figures.push(Figure {
        file: "kane_levinson.svg",
        title: "Energy of an impact with friction, e = 1",
        x: "Tangential velocity before (m/s)",
        y: "Energy after / energy before",
        axes: Axes::Linear,
        caption: "The slender block, tilted by 20°, hits the ground with a corner at 1 m/s, e = 1, μ = 0.5: Newton's \
             law generates energy where the curve is above 1. There the energetic law and `moreau-jean-closed` \
             conserve it; their marks coincide.",
        series: vec![
            Series::marks("moreau-jean, Newton", newton_points),
            Series::line("Newton's law on paper", curve),
            Series::marks("moreau-jean, energetic", energetic_points),
            Series::marks("moreau-jean-closed, Newton", closed_points),
        ],
    });
    Ok(())
}

/// Energy after over before: the tilted block without spin, its corner on the ground.
fn thrown(runner: &mut Runner, impact: ImpactLaw, slide: f64) -> Result<f64> {
    let law = PairLaw::new(FRICTION, 1.0).with_impact(impact);
    let model = block_over(&PAPER_BLOCK, Vector2::zeros(), law, Box::new(Ground::flat(0.0)))?;
    let q = PAPER_BLOCK.on_left_corner(Vector2::zeros(), TILT_DEGREES.to_radians());
    // So short a step that the corner's H is that of the start, and yet the corner sinks in by more than rounding.
    let start = Start { q: q.to_vec(), v: vec![slide, -1.0, 0.0], dt: 1e-10, theta: 0.5 };
    let end = runner.run(&model, &start, 1, |_, _| ControlFlow::Continue(()))?;
    Ok(end.ledger.current.total() / end.ledger.initial.total())
}
