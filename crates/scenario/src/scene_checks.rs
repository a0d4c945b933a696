//! Checks of a scene that can be run but looks wrong: blocks that overturn by themselves, beams
//! that sag beyond small-deflection theory, steps too coarse for the motion.

mod tilted;

use crate::beam_measures::BeamMeasures;
use crate::diagnostic::Diagnostic;
use crate::document::Document;
use crate::mesh_error::MeshComparison;
use crate::resolve::names::table_of;
use crate::scene::{BeamScene, BlockScene, ForceScene, Placement, Scene, SupportingBody};
use crate::solve_digits::FewDigits;
use crate::{
    deflection, flexibility, mass_ratio, rocking, signal_resolution, stable_step, swing, unused_keys, wording,
};
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};
use teeter_beam::{Axial, Beam};
use teeter_integrator::{ImpactLaw, PairLaw};
use teeter_text::readable::{shortest, with_digits};

/// Findings of the checks.
#[derive(Debug, Default)]
pub(crate) struct SceneFindings {
    pub(crate) warnings: Vec<Diagnostic>,
    /// Warnings that a run measures and gives itself.
    pub(crate) foreseen: Vec<Diagnostic>,
    pub(crate) notes: Vec<Diagnostic>,
}

/// A sag over this fraction of the span gives a warning: deflections are no longer small.
const DEEP_SAG: f64 = 1.0 / 50.0;

/// A sag over this fraction of the span gives a note: at 1/68 the neglected shortening of the axis
/// changes the angle by 3 % (`docs/theory.md` §8).
const NOTABLE_SAG: f64 = 1.0 / 250.0;

/// A thickness over this fraction of the span calls for Timoshenko's theory.
const THICK: f64 = 1.0 / 10.0;

/// Least number of steps for the shortest time scale of a contact.
const STEPS_A_MOTION: f64 = 10.0;

/// Checks a scene.
pub(crate) fn check(scene: &Scene, document: &Document) -> SceneFindings {
    let measures = BeamMeasures::default();
    let mut foreseen = Vec::new();
    // A step too coarse for the motion in contact is also too coarse for its impacts.
    if step(scene, document).is_none() {
        foreseen.extend(rocking::coarse(scene, document));
    }
    foreseen.extend(swing::coarse(scene, document));
    SceneFindings { warnings: warnings(scene, document, &measures), foreseen, notes: notes(scene, document, &measures) }
}

/// The warnings of the checks; `measures` has what earlier scenes have in common with this one.
pub(crate) fn warnings(scene: &Scene, document: &Document, measures: &BeamMeasures) -> Vec<Diagnostic> {
    let mut warnings = Vec::new();
    for (number, block) in scene.blocks.iter().enumerate() {
        warnings.extend(tilted::warning((number, block), incline_under(block, scene), scene, document));
    }
    warnings.extend(scene.forces.iter().filter_map(|force| without_effect(force, scene, document)));
    for (number, beam) in scene.beams.iter().enumerate() {
        warnings.extend(thick(beam, document));
        warnings.extend(bent(beam, document));
        warnings.extend(digits(number, scene, measures, document));
        warnings.extend(under_meshed(number, scene, measures, document));
        warnings.extend(sags_deeply(beam, measures.sag(scene, number), document));
    }
    warnings.extend(signal_resolution::warnings(scene, document));
    warnings.extend(unused_keys::of(scene, document));
    warnings.extend(step(scene, document));
    warnings.extend(loosely_solved(scene, document));
    warnings.extend(unresolved_contacts(scene, document));
    warnings.extend(mass_ratio::warning(scene, document));
    warnings
}

/// What is worth noting of a scene.
fn notes(scene: &Scene, document: &Document, measures: &BeamMeasures) -> Vec<Diagnostic> {
    let mut notes = Vec::new();
    for block in &scene.blocks {
        notes.extend(slides(block, incline_under(block, scene), scene, document));
    }
    for (number, beam) in scene.beams.iter().enumerate() {
        notes.extend(sags_notably(beam, measures.sag(scene, number), document));
    }
    notes.extend(signal_resolution::notes(scene, document));
    notes
}

/// Warns of a sag beyond small-deflection theory.
fn sags_deeply(beam: &BeamScene, sag: Option<MeshComparison>, document: &Document) -> Option<Diagnostic> {
    let sag = sag.filter(|sag| sag.larger() > DEEP_SAG * beam.spec.span)?;
    let rule = format!("{}: beyond 1/50 small-deflection theory is unreliable", sagging(beam, sag));
    let remedy = "use a thicker or shorter beam, or lighter blocks";
    Some(document.error(&format!("beam.{}.thickness", beam.name), rule, remedy).as_warning())
}

/// Notes a sag at which the shortening of the axis begins to matter. A held beam includes its stretching.
fn sags_notably(beam: &BeamScene, sag: Option<MeshComparison>, document: &Document) -> Option<Diagnostic> {
    let notable = NOTABLE_SAG * beam.spec.span..=DEEP_SAG * beam.spec.span;
    let sag = sag.filter(|sag| sag.larger() > *notable.start() && sag.larger() <= *notable.end())?;
    if beam.spec.axial == Axial::Held {
        return None;
    }
    let rule = format!(
        "{}: linear theory, which neglects the shortening of its axis, has an error of some per cent{}",
        sagging(beam, sag),
        if beam.spec.axial == Axial::Free { "; ends held along the axis would stretch it" } else { "" }
    );
    let remedy =
        "no change is needed if that is accurate enough; otherwise use a thicker or shorter beam, or axial = held";
    Some(document.error(&format!("beam.{}.thickness", beam.name), rule, remedy).as_note())
}

fn sagging(beam: &BeamScene, sag: MeshComparison) -> String {
    let weight = if beam.self_weight { "its own weight and that of the blocks" } else { "the blocks' weight" };
    let own = sag.beam.unwrap_or(sag.model);
    let part = wording::part_of(own, beam.spec.span);
    match sag.exact_if_different() {
        None => format!("the beam sags by {} under {weight}, {part}", with_digits(own, "m", 3)),
        Some(_) => {
            let [own, model] = [own, sag.model].map(|sag| with_digits(sag, "m", 3));
            format!("the beam sags by {own} under {weight}, {part} ({model} in the model)")
        }
    }
}

/// Warns of a large initial shape.
fn bent(beam: &BeamScene, document: &Document) -> Option<Diagnostic> {
    if beam.shape.is_empty() {
        return None;
    }
    let large = deflection::large(&Beam::new(beam.spec.clone()).ok()?, &beam.shape)?;
    let (path, rule) = (format!("beam.{}.start", beam.name), format!("the initial shape is not small: {large}"));
    Some(document.error(&path, rule, "start from a smaller shape").as_warning())
}

/// With up to this many elements, the mesh is not the cause of lost digits.
const COARSE: usize = 100;

/// Warns if solves leave few digits.
fn digits(number: usize, scene: &Scene, measures: &BeamMeasures, document: &Document) -> Option<Diagnostic> {
    let beam = &scene.beams[number];
    let FewDigits { correct, what, elements } = measures.few_digits(scene, number)?;
    let path = |key: &str| format!("beam.{}.{key}", beam.name);
    let key = if document.has(&path("nodes")) { "nodes" } else { "elements" };
    let rule = format!("only {correct:.1} digits of {what} are correct because of rounding");
    let remedy = if elements > COARSE {
        "use a coarser mesh: 20 to 100 elements are more accurate than the model"
    } else {
        "use elements of more equal length, and less different stiffnesses of beam and supports"
    };
    Some(document.error(&path(key), rule, remedy).as_warning())
}

/// Warns of a beam so thick that shear matters, with a theory without it. At midspan of a pinned
/// rectangular beam the shear deflection under a force is E/(κG) (t/L)² times that of bending, some
/// 3 (t/L)² for metals.
fn thick(beam: &BeamScene, document: &Document) -> Option<Diagnostic> {
    let part = beam.thickness / beam.spec.span;
    if part <= THICK || beam.is_sheared() {
        return None;
    }
    let rule = format!(
        "its thickness is {part:.2} of the span: shear, which is neglected, would add some {:.0} % to the deflection",
        300.0 * part * part
    );
    let remedy = "use theory = \"timoshenko\" (the material then needs poisson_ratio)";
    Some(document.error(&format!("beam.{}.theory", beam.name), rule, remedy).as_warning())
}

/// Warns of a mesh, or modes, that lack flexibility where the beam is loaded.
fn under_meshed(number: usize, scene: &Scene, measures: &BeamMeasures, document: &Document) -> Option<Diagnostic> {
    let lack = measures.missing_flexibility(scene, number)?;
    let beam = &scene.beams[number];
    let path = |key: &str| format!("beam.{}.{key}", beam.name);
    let key = match beam.reduction {
        Some(_) if document.has(&path("modes")) => "modes",
        Some(_) => "model",
        None if document.has(&path("nodes")) => "nodes",
        None => "elements",
    };
    let rule = format!(
        "under-resolved: {:.0} % of the flexibility under {} is missing; above {:.1} % motions are likely off by more than 10 %, \
         however fine the step",
        100.0 * lack.part,
        lack.what,
        100.0 * flexibility::MOST_MISSING
    );
    let remedy = format!("{}; `teeter tradeoff` measures the gain in accuracy", lack.advice);
    Some(document.error(&path(key), rule, remedy).as_warning())
}

/// The slope of the ground under a block; 0 on anything else.
fn incline_under(block: &BlockScene, scene: &Scene) -> f64 {
    match block.placement {
        Placement::On { support: SupportingBody::Ground, .. } => {
            scene.ground.as_ref().map_or(0.0, |ground| ground.incline)
        }
        _ => 0.0,
    }
}

/// Notes a block on an incline that friction doesn't hold.
fn slides(block: &BlockScene, incline: f64, scene: &Scene, document: &Document) -> Option<Diagnostic> {
    let Placement::On { contact, .. } = block.placement else { return None };
    // With feet of different friction, what is too steep for both.
    let (slope, [_, friction]) = (incline.tan().abs(), scene.contacts[contact].friction_of_feet());
    if slope <= friction {
        return None;
    }
    let rule =
        format!("too steep for the friction: its tangent, {slope:.3}, is over {friction}, so `{}` slides", block.name);
    Some(document.error("ground.incline", rule, "no change is needed if that is intended").as_note())
}

/// Warns of a force whose block can't follow it.
fn without_effect(force: &ForceScene, scene: &Scene, document: &Document) -> Option<Diagnostic> {
    let block = &scene.blocks[force.block];
    let given = [force.force[0], force.force[1], force.couple];
    let moves = given.iter().zip(&block.motion.0).any(|(given, prescribed)| *given != 0.0 && prescribed.is_none());
    if moves || !block.motion.is_given() || given == [0.0; 3] {
        return None;
    }
    let table = table_of(document, &block.name);
    let (why, remedy) = if document.flag(&format!("block.{table}.fixed")) == Some(true) {
        ("is fixed", "put it on a block that can move, or leave out `fixed`")
    } else {
        (
            "moves as prescribed, whatever acts on it in this direction",
            "put it on a block that can move, or leave out `motion`",
        )
    };
    let rule = format!("has no effect: `{}` {why}", block.name);
    Some(document.error(&format!("force.{}.on", force.name), rule, remedy).as_warning())
}

/// A solver tolerance over this gives visibly wrong impulses.
const LOOSE: f64 = 1e-4;

/// Warns of a solver tolerance too loose to solve contacts properly.
fn loosely_solved(scene: &Scene, document: &Document) -> Option<Diagnostic> {
    let tolerance = scene.solver.tolerance;
    if tolerance <= LOOSE || !scene.has_contacts() {
        return None;
    }
    let rule = format!(
        "contact impulses off by some {} % of the largest would still count as solved",
        shortest(100.0 * tolerance, 2)
    );
    let remedy = "use at most 1e-4; 1e-10, the default, costs little more";
    Some(document.error("solver.tolerance", rule, remedy).as_warning())
}

/// Least number of steps for the duration of a compliant contact.
const STEPS_A_CONTACT: f64 = 20.0;

/// Warns of compliant contacts that the step doesn't resolve.
fn unresolved_contacts(scene: &Scene, document: &Document) -> Vec<Diagnostic> {
    // A contact by patterns is for many pairs: the lightest block stays for the shortest time.
    let mut lightest_of: BTreeMap<&str, (f64, &PairLaw)> = BTreeMap::new();
    let mut enter = |name, mass: f64, law| {
        let known = lightest_of.entry(name).or_insert((mass, law));
        known.0 = known.0.min(mass);
    };
    for contact in &scene.contacts {
        enter(&contact.name, scene.blocks[contact.block].mass(), &contact.law);
    }
    for (number, contact) in scene.crowd.iter().flat_map(|crowd| crowd.contacts().iter().enumerate()) {
        let takes_part = |block: &usize| scene.crowd.as_ref().is_some_and(|of| of.takes_part(*block, Some(number)));
        let blocks = (0..scene.blocks.len()).filter(takes_part);
        blocks.for_each(|block| enter(&contact.name, scene.blocks[block].mass(), &contact.law));
    }
    let all = lightest_of.into_iter();
    all.filter_map(|(name, (mass, law))| resolved_in_time(name, law, mass, scene, document)).collect()
}

/// Warns of a compliant contact that the step doesn't resolve. On a spring k a mass m stays for
/// half a period, π√(m/k); for a force k δⁿ the spring is linearised at the depth at which the
/// contact carries the block.
fn resolved_in_time(name: &str, law: &PairLaw, mass: f64, scene: &Scene, document: &Document) -> Option<Diagnostic> {
    let spring = match law.impact {
        ImpactLaw::KelvinVoigt { stiffness, .. } => stiffness,
        ImpactLaw::HuntCrossley { stiffness, exponent, .. } => {
            let weight = mass * scene.gravity[0].hypot(scene.gravity[1]);
            exponent * stiffness.powf(exponent.recip()) * weight.powf(1.0 - exponent.recip())
        }
        _ => return None,
    };
    let half_period = PI * (mass / spring).sqrt();
    if !half_period.is_finite() || scene.time.step <= half_period / STEPS_A_CONTACT {
        return None;
    }
    let rule = format!(
        "the contact of a block of {mass:.3} kg lasts some {}, less than {STEPS_A_CONTACT} steps: it is \
         not resolved",
        wording::seconds(half_period, 2)
    );
    let remedy =
        format!("use a step of at most {}, or a softer contact", wording::seconds(half_period / STEPS_A_CONTACT, 1));
    Some(document.error(&format!("contact.{name}.stiffness"), rule, remedy).as_warning())
}

/// Warns of a step too coarse for the motion in contact. The time scales are those of the model: a
/// block on its corner moves as exp(±pt), p = √(3g/4R) (Housner 1963), whatever its angle; a beam
/// under it vibrates with its first period.
fn step(scene: &Scene, document: &Document) -> Option<Diagnostic> {
    if scene.time.scheme.has_own_steps() {
        return None;
    }
    let gravity = scene.gravity[0].hypot(scene.gravity[1]);
    let mut shortest: Option<(f64, String)> = None;
    let mut enter = |time: f64, what: String| {
        if time.is_finite() && time > 0.0 && shortest.as_ref().is_none_or(|(least, _)| time < *least) {
            shortest = Some((time, what));
        }
    };
    let rocks = |block: &BlockScene, enter: &mut dyn FnMut(f64, String)| {
        let time = (4.0 * block.radius() / (3.0 * gravity)).sqrt();
        enter(time, format!("the rocking time sqrt(4R/3g) of `{}`", block.name));
    };
    let of_crowd = |block: &usize| scene.crowd.as_ref().is_some_and(|crowd| crowd.takes_part(*block, None));
    (0..scene.blocks.len()).filter(of_crowd).for_each(|block| rocks(&scene.blocks[block], &mut enter));
    for contact in &scene.contacts {
        rocks(&scene.blocks[contact.block], &mut enter);
        if let SupportingBody::Beam(number) = contact.surface {
            let beam = &scene.beams[number];
            let period = stable_step::first_frequency(&beam.spec).map_or(f64::NAN, |(omega, _)| TAU / omega);
            enter(period, format!("the first period of `{}`", beam.name));
        }
    }
    let (time, what) = shortest?;
    if scene.time.step <= time / STEPS_A_MOTION {
        return None;
    }
    let rule =
        format!("longer than a tenth of {what}, {}: the motion in contact is not resolved", wording::seconds(time, 4));
    let remedy = format!("use a step of at most {}", wording::seconds(time / STEPS_A_MOTION, 2));
    Some(document.error("time.step", rule, remedy).as_warning())
}

#[cfg(test)]
mod tests {
    use crate::mesh_error;
    use crate::resolve::Resolved;

    const SCENE: &str = "[time]\nend = '1 s'\nstep = '1 ms'\n[ground]\n\
        [material.m]\ndensity = '2700 kg/m^3'\nyoungs_modulus = '69 GPa'\n\
        [beam.b]\nmaterial = 'm'\nspan = '1 m'\nwidth = '3 cm'\nthickness = '5 mm'\nelements = 20\n\
        [block.k]\nmaterial = 'm'\nwidth = '10 cm'\nheight = '20 cm'\ndepth = '10 cm'\non = 'b'\nat = '50 cm'\n\
        [contact.c]\nbetween = ['k', 'b']\nfriction = 0.5\n";

    fn resolved(sets: &[(&str, &str)]) -> Resolved {
        let sets: Vec<_> = sets.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
        crate::load(SCENE.as_bytes(), "f", "f", &sets).unwrap()
    }

    #[test]
    fn the_sag_is_that_of_two_point_loads() {
        // P = m g / 2 at a = 0.45 m from either end: w = P a (3 L² − 4 a²) / (24 E I) at midspan.
        let scene = resolved(&[]).scene;
        let (p, a, ei) = (0.5 * 5.4 * 9.81, 0.45, 69e9 * 0.03 * 0.005_f64.powi(3) / 12.0);
        let exact = p * a * (3.0 - 4.0 * a * a) / (24.0 * ei);
        let found = mesh_error::sag(&scene, 0).unwrap();
        for found in [found.model, found.beam.unwrap()] {
            assert!((found / exact - 1.0).abs() < 1e-12, "{found} {exact}");
        }
        assert_eq!(mesh_error::sag(&resolved(&[("beam.b.supports", "['free', 'free']")]).scene, 0), None);
    }

    /// With few elements, where nodes don't sag, and in one mode too.
    #[test]
    fn a_sag_is_warned_of_whatever_the_mesh() {
        for more in [vec![], vec![("beam.b.model", "modes"), ("beam.b.modes.count", "1")]] {
            let fine = mesh_error::sag(&resolved(&[("beam.b.thickness", "4 mm")]).scene, 0).unwrap();
            for elements in ["1", "2", "3", "5"] {
                let mut sets = vec![("beam.b.thickness", "4 mm"), ("beam.b.elements", elements)];
                sets.extend(&more);
                let found = resolved(&sets);
                assert!(found.warnings.iter().any(|found| found.rule.contains("1/10 of its span")), "{sets:?}");
                let sag = mesh_error::sag(&found.scene, 0).unwrap();
                assert!((sag.beam.unwrap() / fine.model - 1.0).abs() < 2e-3, "{sets:?} {sag:?}");
                assert_eq!(
                    sag.exact_if_different().is_some(),
                    (sag.model / fine.model - 1.0).abs() > 0.01,
                    "{sets:?} {sag:?}"
                );
                assert!(elements != "1" || sag.exact_if_different().is_some());
            }
        }
    }

    #[test]
    fn sags_are_warned_of_noted_or_passed_over_by_their_part_of_the_span() {
        let count = |thickness| {
            let found = resolved(&[("beam.b.thickness", thickness)]);
            (found.warnings.len(), found.notes.len())
        };
        assert_eq!(count("4 mm"), (1, 0), "1/14");
        assert_eq!(count("7 mm"), (0, 1), "1/77");
        assert_eq!(count("2 cm"), (0, 0), "1/1800");
    }

    #[test]
    fn an_incline_counts_with_the_tilt_and_against_friction() {
        let found = |incline: &str, tilt: &str| {
            let text = SCENE
                .replace("[ground]\n", &format!("[ground]\nincline = '{incline}'\n"))
                .replace("on = 'b'", &format!("on = 'ground'\ntilt = '{tilt}'"))
                .replace("['k', 'b']", "['k', 'ground']")
                .replace("step = '1 ms'", "step = '100 us'");
            let found = crate::load(text.as_bytes(), "f", "f", &[]).unwrap();
            (found.warnings.len(), found.notes.len())
        };
        // Critical angle 26.6 degrees, as is that of the friction of 0.5.
        assert_eq!(found("20 deg", "0 deg"), (0, 0));
        assert_eq!(found("20 deg", "10 deg"), (1, 0));
        assert_eq!(found("28 deg", "0 deg"), (1, 1));
        assert_eq!(found("28 deg", "-10 deg"), (0, 1));
    }

    #[test]
    fn a_signal_that_nothing_uses_is_warned_of() {
        let count = |more: &str| {
            let text = format!("{SCENE}[signal.s]\nshape = 'ramp'\nduration = '1 s'\n{more}");
            let sets = [("beam.b.thickness".to_owned(), "2 cm".to_owned())];
            crate::load(text.as_bytes(), "f", "f", &sets).unwrap().warnings.len()
        };
        assert_eq!(count(""), 1);
        assert_eq!(count("[force.f]\non = 'k'\ncouple = '1 N m'\nsignal = 's'\n"), 0);
        assert_eq!(count("[beam.b.motion]\nvelocity = ['1 m/s', '0 m/s']\nsignals = ['s', 's']\n"), 0);
    }

    #[test]
    fn a_contact_too_stiff_for_the_step_is_warned_of() {
        let count = |law: &str, stiffness: &str| {
            let text = SCENE.replace("friction = 0.5\n", &format!("friction = 0.5\nlaw = '{law}'\n{stiffness}\n"));
            let found = crate::load(text.as_bytes(), "f", "f", &[("beam.b.thickness".to_owned(), "2 cm".to_owned())]);
            found.unwrap().warnings.len()
        };
        // 5.4 kg: π√(m/k) is 20 ms at 133 kN/m.
        assert_eq!(count("kelvin-voigt", "stiffness = '130 kN/m'\ndamping = '0 N s/m'"), 0);
        assert_eq!(count("kelvin-voigt", "stiffness = '140 kN/m'\ndamping = '0 N s/m'"), 1);
        assert_eq!(count("hunt-crossley", "stiffness = '1e5 N/m^1.5'\ndamping = '0 s/m'"), 0);
        assert_eq!(count("hunt-crossley", "stiffness = '1e9 N/m^1.5'\ndamping = '0 s/m'"), 1);
    }

    #[test]
    fn a_block_in_the_air_may_have_any_angle() {
        let free = |height: &str, contact: &str| {
            let text = SCENE
                .replace("on = 'b'\nat = '50 cm'", &format!("position = ['0.5 m', '{height}']\nangle = '40 deg'"))
                .replace("[contact.c]\nbetween = ['k', 'b']\nfriction = 0.5\n", contact);
            crate::load(text.as_bytes(), "f", "f", &[]).unwrap().warnings.len()
        };
        assert_eq!(free("2 m", ""), 0);
        let contact = "[contact.c]\nbetween = ['k', 'b']\nfriction = 0.5\n";
        assert_eq!(free("2 m", contact), 0);
        // With its lowest corner on the beam.
        assert_eq!(free("10.88 cm", contact), 1);
        assert_eq!(free("10.88 cm", ""), 0);
    }
}
