//! Frequencies 1 to 10 of beams of every kind against frequency equations.

use crate::case::{Case, Check, Depth, Findings, Result};
use crate::cases::beam_supports::support;
use crate::exact::beams::end_conditions::{self, LoadedEnd};
use crate::exact::beams::ends::{CLAMPED, End, FREE, GUIDED, Hold, PINNED};
use crate::exact::beams::timoshenko::PinnedTimoshenko;
use crate::exact::beams::{Uniform, axial_force, frequencies, lump, two_spans, winkler};
use crate::fit::power_law;
use crate::modes::lowest_modes;
use std::f64::consts::PI;
use teeter_beam::{Beam, BeamSpec, Foundation, Section, Support};

pub(crate) struct BeamSpectrum;

const BEAM: Uniform = Uniform { span: 0.37, bending: 0.58, mass: 0.12 };

/// From where the tenth mode has some three elements a half wave to where the first mode's error is still far above rounding.
const MESHES: [usize; 4] = [30, 40, 60, 80];

/// Frequencies compared.
const COUNT: usize = 10;

/// A beam, and what its frequencies should be.
struct Known {
    name: String,
    /// With so many elements.
    spec: Box<dyn Fn(usize) -> Result<BeamSpec>>,
    /// rad/s; those of rigid motions come before these.
    exact: Vec<f64>,
    rigid: usize,
    /// The order that its elements have, and the largest error of ten modes on the finest mesh.
    order: f64,
    bound: f64,
}

/// (10π/80)⁴/1440 for the tenth mode between whatever ends, with a margin for a wave number a little above 10π.
const CUBIC: (f64, f64) = (4.0, 2.2e-5);

/// With elements shorter than the beam is high, Φ = 12 EI/(GA_s l²) is large, and Timoshenko's shape functions tend to straight lines: the order is that of
/// the linear elements of a rod, whose error is (10π/80)²/24.
const STUBBY: (f64, f64) = (2.0, 6.5e-3);

impl Case for BeamSpectrum {
    fn name(&self) -> &'static str {
        "beam_spectrum"
    }

    fn about(&self) -> &'static str {
        "Frequencies 1 to 10 (subspace iteration with the beam's products and one factor) compared with the roots of \
         the frequency equations: five pairs of supports and two with guided ends, Timoshenko (rectangle, h/L = 0.1, \
         ν = 0.3, with rotary inertia), two spans, Winkler's foundation, end springs, a mass at midspan and at 0.3 \
         of the span, at a cantilever's tip, tension and compression. Orders are fitted over meshes of 30, 40, 60 \
         and 80 elements; the least and the largest of ten modes are shown. Timoshenko's element has order 2 if \
         elements are shorter than the beam is high. The error of Euler–Bernoulli elements of length l is (β \
         l/L)⁴/1440 to leading order for any supports; for beams with supports only, it is shown as a multiple of \
         this."
    }

    fn run(&self, _: Depth) -> Result<Findings> {
        let mut findings = Findings::default();
        for (name, ends) in [
            ("pinned–pinned", [PINNED, PINNED]),
            ("clamped–clamped", [CLAMPED, CLAMPED]),
            ("clamped–free", [CLAMPED, FREE]),
            ("free–free", [FREE, FREE]),
            ("clamped–pinned", [CLAMPED, PINNED]),
            ("clamped–guided", [CLAMPED, GUIDED]),
            ("pinned–guided", [PINNED, GUIDED]),
        ] {
            let betas = frequencies::wave_numbers(ends, COUNT).ok_or("ends without a frequency equation")?;
            let rigid = if ends == [FREE, FREE] { 2 } else { 0 };
            let errors = check(&held(name, ends, &betas, rigid), &mut findings)?;
            let finest = MESHES[MESHES.len() - 1] as f64;
            let multiples: Vec<f64> =
                errors.iter().zip(&betas).map(|(error, beta)| error / ((beta / finest).powi(4) / 1440.0)).collect();
            // The next terms of the error, of order (β l/L)² less, and rounding of the first mode.
            extremes(name, "error/((β l/L)⁴/1440), 80 elements", &multiples, 1.0, [0.95, 1.05], &mut findings);
        }
        for known in others()? {
            check(&known, &mut findings)?;
        }
        Ok(findings)
    }
}

/// Fits the orders; the relative errors on the finest mesh.
fn check(known: &Known, findings: &mut Findings) -> Result<Vec<f64>> {
    let mut points = vec![Vec::new(); COUNT];
    for elements in MESHES {
        let beam = Beam::new((known.spec)(elements)?)?;
        let found = lowest_modes(&beam, known.exact[0], COUNT + known.rigid)?;
        for ((points, (found, _)), exact) in points.iter_mut().zip(&found[known.rigid..]).zip(&known.exact) {
            points.push((1.0 / elements as f64, (found / exact - 1.0).abs()));
        }
    }
    let orders: Vec<f64> = points.iter().map(|points| power_law(points).order).collect();
    let (order, range) = (known.order, [known.order - 0.1, known.order + 0.1]);
    extremes(&known.name, "order in the element length", &orders, order, range, findings);
    let last: Vec<f64> = points.iter().filter_map(|points| points.last()).map(|point| point.1).collect();
    let worst = last.iter().fold(0.0, |a: f64, b| if a.is_nan() || *b <= a { a } else { *b });
    findings.checks.push(Check::worst(
        format!("{}: worst of ten, 80 elements, relative", known.name),
        worst,
        known.bound,
    ));
    Ok(last)
}

/// Tells the least and the largest of ten numbers.
fn extremes(name: &str, what: &str, values: &[f64], exact: f64, [low, high]: [f64; 2], findings: &mut Findings) {
    let least = values.iter().copied().fold(f64::INFINITY, |a, b| if a.is_nan() || a <= b { a } else { b });
    let largest = values.iter().copied().fold(f64::NEG_INFINITY, |a, b| if a.is_nan() || a >= b { a } else { b });
    for (which, value) in [("least", least), ("largest", largest)] {
        findings.checks.push(Check::between(format!("{name}: {what}, {which} of ten"), exact, value, low, high));
    }
}

fn section() -> Result<Section> {
    Ok(Section::new(BEAM.bending, BEAM.mass)?)
}

fn held(name: &str, ends: [End; 2], betas: &[f64], rigid: usize) -> Known {
    let spec = move |elements| Ok(BeamSpec::new(BEAM.span, elements, section()?).supported(ends.map(support)));
    let exact = betas.iter().map(|beta| BEAM.frequency(*beta)).collect();
    let (order, bound) = CUBIC;
    Known { name: name.to_owned(), spec: Box::new(spec), exact, rigid, order, bound }
}

/// Beams with more to them than two ends.
fn others() -> Result<Vec<Known>> {
    let Uniform { span, bending, mass } = BEAM;
    let plain = move |elements| -> Result<BeamSpec> { Ok(BeamSpec::new(span, elements, section()?)) };
    let by_beta = |betas: Vec<f64>| betas.into_iter().map(|beta| BEAM.frequency(beta)).collect::<Vec<_>>();
    let sines = || (1..=COUNT as u32).map(|i| f64::from(i) * PI);
    let mut all = Vec::new();
    let height = 0.1 * span;
    let shear = 5.0 / 6.0 / 2.6 * 12.0 / (height * height) * bending;
    let rotary_inertia = mass * height * height / 12.0;
    let stubby = PinnedTimoshenko { span, bending, shear, mass, rotary_inertia };
    let with_shear = move |elements| Ok(BeamSpec::new(span, elements, section()?.with_shear(shear, rotary_inertia)?));
    let (order, bound) = STUBBY;
    let (name, exact) = ("Timoshenko, pinned–pinned".to_owned(), stubby.frequencies(COUNT));
    all.push(Known { name, spec: Box::new(with_shear), exact, rigid: 0, order, bound });

    let mut add = |name: &str, exact: Vec<f64>, spec: Box<dyn Fn(usize) -> Result<BeamSpec>>| {
        let (order, bound) = CUBIC;
        all.push(Known { name: name.to_owned(), spec, exact, rigid: 0, order, bound });
    };
    let third = move |elements| Ok(plain(elements)?.support_at(0.4 * span, Support::Pinned));
    add("two spans, 0.4 and 0.6", by_beta(two_spans::wave_numbers(0.4, COUNT)), Box::new(third));

    let stiffness = 3e4 * bending / span.powi(4);
    let bed = Foundation::new(0.0, span, stiffness);
    let exact = sines().map(|beta| winkler::frequency(BEAM, stiffness, beta)).collect();
    add("Winkler's foundation", exact, Box::new(move |elements| Ok(plain(elements)?.foundation(bed))));

    // Of unit beams, and of this one.
    let spring = |k: f64| End { shift: Hold::Spring(k), turn: Hold::Free };
    let unit = bending / span.powi(3);
    let exact = end_conditions::wave_numbers([spring(50.0), spring(200.0)].map(LoadedEnd::massless), COUNT);
    let supports = [spring(50.0 * unit), spring(200.0 * unit)].map(support);
    add("end springs", by_beta(exact), Box::new(move |elements| Ok(plain(elements)?.supported(supports))));
    let root = |k: f64| End { shift: Hold::Held, turn: Hold::Spring(k) };
    let exact = end_conditions::wave_numbers([root(3.0), spring(20.0)].map(LoadedEnd::massless), COUNT);
    let supports = [root(3.0 * bending / span), spring(20.0 * unit)].map(support);
    add("root and tip springs", by_beta(exact), Box::new(move |elements| Ok(plain(elements)?.supported(supports))));

    for (name, place, ratio) in [("mass at midspan", 0.5, 1.0), ("mass at 0.3 of the span", 0.3, 0.5)] {
        let lumped = move |elements| Ok(plain(elements)?.lump(place * span, ratio * mass * span, 0.0));
        add(name, by_beta(lump::wave_numbers(ratio, place, COUNT)), Box::new(lumped));
    }
    let tip = LoadedEnd { end: FREE, mass: 0.5, inertia: 0.01 };
    let exact = end_conditions::wave_numbers([LoadedEnd::massless(CLAMPED), tip], COUNT);
    let lumped = move |elements| {
        let cantilever = plain(elements)?.supported([CLAMPED, FREE].map(support));
        Ok(cantilever.lump(span, 0.5 * mass * span, 0.01 * mass * span.powi(3)))
    };
    add("mass and inertia at a cantilever's tip", by_beta(exact), Box::new(lumped));

    for (name, part) in [("tension", 3.0), ("compression, 0.6 of buckling", -0.6)] {
        let force = part * bending * (PI / span).powi(2);
        let exact = (1..=COUNT as u32).map(|mode| axial_force::pinned_frequency(BEAM, force, mode)).collect();
        add(name, exact, Box::new(move |elements| Ok(plain(elements)?.axial_force(force))));
    }
    Ok(all)
}
