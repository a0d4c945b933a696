//! Beams at the edges of what can be asked: finite numbers or an error that says why, never a NaN and never a panic.

use std::fmt::Debug;

use proptest::prelude::*;
use teeter_beam::{
    Actions, Axial, Backend, Beam, BeamSpec, Damping, Foundation, Hold, MatrixWeights, Profile, Section, SpanLoad,
    Support,
};

/// 10 to the power of a number from a range, evenly.
fn decades(range: std::ops::RangeInclusive<f64>) -> impl Strategy<Value = f64> {
    range.prop_map(|exponent| 10.0_f64.powf(exponent))
}

fn hold() -> impl Strategy<Value = Hold> {
    prop_oneof![
        Just(Hold::Free),
        Just(Hold::Fixed),
        (decades(-12.0..=18.0), decades(-12.0..=6.0))
            .prop_map(|(stiffness, damping)| Hold::Spring { stiffness, damping }),
    ]
}

fn support() -> impl Strategy<Value = Support> {
    prop_oneof![
        Just(Support::Free),
        Just(Support::Pinned),
        Just(Support::Clamped),
        Just(Support::Guided),
        (hold(), hold()).prop_map(|(deflection, rotation)| Support::Elastic { deflection, rotation }),
    ]
}

/// A rectangle: span, thickness over span, E, density; Euler–Bernoulli or Timoshenko.
fn section(span: f64, slenderness: f64, youngs_modulus: f64, density: f64, shear: bool) -> Section {
    let thickness = slenderness * span;
    let profile = Profile::Rectangle { width: 2.0 * thickness, thickness };
    if shear {
        Section::timoshenko(profile, youngs_modulus, density, 0.3).unwrap()
    } else {
        Section::of(profile, youngs_modulus, density).unwrap()
    }
}

fn elements() -> impl Strategy<Value = usize> {
    prop_oneof![1..10_usize, 10..100_usize, 100..2001_usize]
}

/// N₀ in units of Euler's buckling load of the pinned beam.
fn axial_force() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), -0.9..0.0, decades(-3.0..=3.0)]
}

fn axial() -> impl Strategy<Value = Axial> {
    prop_oneof![Just(Axial::Free), Just(Axial::Held), any::<[bool; 2]>().prop_map(Axial::elastic),]
}

/// What stands, hangs and rests along the span: inner support, lump, foundation, segment.
type Furniture = (Option<(f64, Support)>, Option<[f64; 3]>, Option<[f64; 3]>, Option<f64>);

fn furniture() -> impl Strategy<Value = Furniture> {
    (
        proptest::option::of((0.01..0.99, support())),
        proptest::option::of((0.0..=1.0, decades(-12.0..=6.0), decades(-12.0..=3.0)).prop_map(|(x, m, i)| [x, m, i])),
        proptest::option::of((0.0..0.5, 0.5..=1.0, decades(-9.0..=15.0)).prop_map(|(from, to, k)| [from, to, k])),
        proptest::option::of(0.1..10.0),
    )
}

fn spec() -> impl Strategy<Value = BeamSpec> {
    let sizes = (decades(-3.0..=3.0), decades(-4.0..=-0.301), decades(3.0..=12.0), decades(0.0..=4.301), any::<bool>());
    let ratios = prop_oneof![3 => Just(vec![]), 1 => Just(vec![0.02, 0.0, 1.5])];
    (sizes, elements(), [support(), support()], axial_force(), axial(), furniture(), ratios).prop_map(
        |(
            (span, slenderness, e, density, shear),
            elements,
            supports,
            force,
            axial,
            (inner, lump, bed, other),
            modal,
        )| {
            let own = section(span, slenderness, e, density, shear);
            let euler = own.bending_stiffness * (std::f64::consts::PI / span).powi(2);
            let mut spec =
                BeamSpec::new(span, elements, own).supported(supports).axial(axial).axial_force(force * euler).damped(
                    Damping::none()
                        .with_viscous(0.1 * own.mass_per_length)
                        .with_rayleigh_stiffness(1e-6)
                        .with_modal(modal),
                );
            if let Some((x, support)) = inner {
                spec = spec.support_at(x * span, support);
            }
            if let Some([x, mass, inertia]) = lump {
                spec = spec.lump(x * span, mass, inertia);
            }
            if let Some([from, to, stiffness]) = bed {
                spec = spec.foundation(Foundation::new(from * span, to * span, stiffness).with_damping(1.0));
            }
            if let Some(times) = other {
                spec = spec.segment(
                    0.2 * span,
                    0.7 * span,
                    section(span, times.min(0.5 / slenderness) * slenderness, e, density, !shear),
                );
            }
            spec
        },
    )
}

/// The value, or `None` where an error says why there is none.
fn told<T, E: Debug + std::fmt::Display>(result: Result<T, E>) -> Option<T> {
    match result {
        Ok(value) => Some(value),
        Err(error) => {
            let text = error.to_string();
            assert!(text.len() > 10 && !text.contains("NaN"), "{text}");
            None
        }
    }
}

fn finite(what: &str, values: &[f64]) {
    assert!(values.iter().all(|value| value.is_finite()), "{what}");
}

/// All that one asks a beam for.
fn ask(spec: BeamSpec) {
    let span = spec.span;
    let Some(beam) = told(Beam::new(spec)) else { return };
    let weight = [SpanLoad::Weight { gravity: -9.81 }];
    let mut load = vec![0.0; beam.dofs()];
    beam.add_self_weight(-9.81, &mut load).unwrap();

    for h in [1e-2, 1e-4, 1e-6] {
        let weights = MatrixWeights { mass: 1.0, damping: 0.5 * h, stiffness: 0.25 * h * h };
        for backend in Backend::available() {
            let Some(factor) = told(beam.factor_with(weights, *backend)) else { continue };
            let mut x = load.clone();
            factor.solve(&mut x);
            finite("a step", &x);
        }
        if let Some(digits) = told(beam.digits(weights)) {
            assert!(digits.refined > 0.0 && digits.refined <= digits.solve && digits.solve <= 1.0, "{digits:?}");
        }
    }

    let mut q = load.clone();
    if told(beam.solve_static(&mut q)).is_some() {
        finite("statics", &q);
        let actions = Actions::at(&q).with_loads(&weight);
        let forces = beam.section_forces(&actions).unwrap();
        for element in 0..beam.elements() {
            for end in forces.ends(element) {
                finite("section forces", &[end.moment, end.shear]);
            }
        }
        for part in [0.0, 0.3, 0.77, 1.0] {
            let force = forces.at(&beam, part * span).unwrap();
            finite("section forces at a place", &[force.moment, force.shear]);
            assert!(forces.stress(&beam, part * span, force.moment).is_some_and(f64::is_finite));
        }
        for reaction in forces.reactions() {
            finite("reactions", &[reaction.force, reaction.couple]);
        }
        finite("energy", &[beam.elastic_energy(&q), beam.kinetic_energy(&q), beam.axial_force(&q)]);
    } else {
        assert_eq!(q, load, "after an error the load is as it was");
    }

    let count = beam.free_dofs().min(3);
    if let Some(modes) = told(beam.modes(count)) {
        finite("frequencies", modes.circular_frequencies());
        assert!(modes.circular_frequencies().is_sorted());
        (0..count).for_each(|mode| finite("shapes", modes.shape(mode)));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 128, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn whatever_is_asked_is_answered_or_refused_with_a_reason(spec in spec()) {
        ask(spec);
    }
}

/// Every corner of the ranges has its answer, and the right one: the uniform load of a pinned beam and of a cantilever, the first
/// frequency of both.
#[test]
fn plain_beams_at_all_corners_are_answered_to_many_digits() {
    for bits in 0..16_u32 {
        let at = |bit: u32, low: f64, high: f64| if bits >> bit & 1 == 1 { high } else { low };
        let span = at(0, 1e-3, 1e3);
        let own = section(span, at(1, 1e-4, 0.5), at(2, 1e3, 1e12), at(3, 1.0, 2e4), false);
        for (supports, x, sag) in
            [([Support::Pinned; 2], 0.5, 5.0 / 384.0), ([Support::Clamped, Support::Free], 1.0, 1.0 / 8.0)]
        {
            for elements in [2, 30, 2000] {
                let beam = Beam::new(BeamSpec::new(span, elements, own).supported(supports)).unwrap();
                let mut q = vec![0.0; beam.dofs()];
                beam.add_uniform_load(-3.0, &mut q).unwrap();
                beam.solve_static(&mut q).unwrap();
                let w = beam.deflection_at(&q, x * span).unwrap().w;
                let exact = -3.0 * sag * span.powi(4) / own.bending_stiffness;
                assert!((w / exact - 1.0).abs() < 1e-13, "{:?}: {w:e} {exact:e}", beam.spec());
                let omega = beam.modes(1).unwrap().circular_frequencies()[0];
                let wave = 3.2 / elements as f64;
                let error = omega / beam.circular_frequency(1).unwrap() - 1.0;
                assert!(error.abs() < wave.powi(4) / 1440.0 + 1e-12, "{:?}: {error:e}", beam.spec());
            }
        }
    }
}

/// The stiffest spring is a support, in statics and in the frequencies; the softest is none.
#[test]
fn a_stiff_spring_is_a_support_and_a_soft_one_is_none() {
    let spring = |stiffness| Hold::Spring { stiffness, damping: 0.0 };
    let sprung = |elements, stiffness| {
        let end = Support::Elastic { deflection: spring(stiffness), rotation: spring(stiffness) };
        super::beam(elements, [end; 2])
    };
    for elements in [4, 40, 400, 2000] {
        let (clamped, free) = (super::beam(elements, [Support::Clamped; 2]), super::beam(elements, [Support::Free; 2]));
        let stiff = sprung(elements, 1e18);
        let [mut a, mut b] = [&clamped, &stiff].map(|beam| {
            let mut q = vec![0.0; beam.dofs()];
            beam.add_uniform_load(-3.0, &mut q).unwrap();
            beam.solve_static(&mut q).unwrap();
            beam.deflection_at(&q, 0.17).unwrap().w
        });
        assert!((a / b - 1.0).abs() < 1e-12, "{elements}: {a} {b}");
        [a, b] = [&clamped, &stiff].map(|beam| beam.modes(3).unwrap().circular_frequencies()[2]);
        assert!((a / b - 1.0).abs() < 1e-9, "{elements}: {a} {b}");
        [a, b] = [&free, &sprung(elements, 1e-12)].map(|beam| beam.modes(3).unwrap().circular_frequencies()[2]);
        assert!((a / b - 1.0).abs() < 1e-9, "{elements}: {a} {b}");
    }
}

#[test]
fn springs_too_soft_for_statics_are_named() {
    let end = Support::Elastic { deflection: Hold::Spring { stiffness: 1e-12, damping: 0.0 }, rotation: Hold::Fixed };
    let beam = super::beam(300, [Support::Guided, end]);
    let mut q = vec![0.0; beam.dofs()];
    beam.add_uniform_load(-3.0, &mut q).unwrap();
    let text = beam.solve_static(&mut q).unwrap_err().to_string();
    assert!(text.contains("springs") && text.contains("too soft"), "{text}");
}
