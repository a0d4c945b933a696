//! Predicts, before a run, the effect of the step on a block released at a tilt.
//!
//! Each impact occurs up to a step late, so the foot is off by up to h b |ω|, b the block's width.
//! Summed over the impacts, carried on by the swings after them and relative to the swing b Δφ,
//! this is what a run measures as `under-resolved` (`docs/resolution.md`). Housner's formulas
//! (1963, doi 10.1785/BSSA0530020403) predict number and speed of the impacts.

use crate::diagnostic::Diagnostic;
use crate::document::Document;
use crate::scene::{ContactScene, GroundScene, Placement, Scene, SupportingBody};
use crate::wording;

/// A sum above this fraction of the swing gives a warning: on a beam the sum is smaller than
/// predicted, and a block that overturns has few impacts, so the limit is twice that of a run.
const COARSE: f64 = 0.02;

/// Most impacts that are counted.
const MOST_IMPACTS: u64 = 1000;

/// Swings below this fraction of the first count as rest.
const STILL: f64 = 1e-3;

/// Warns of a block whose impacts the step doesn't resolve.
pub(crate) fn coarse(scene: &Scene, document: &Document) -> Option<Diagnostic> {
    if scene.time.scheme.locates() {
        return None;
    }
    let worst = scene.contacts.iter().filter_map(|contact| {
        let block = &scene.blocks[contact.block];
        Some((block, late(scene, contact)?))
    });
    let (block, (impacts, part)) = worst.max_by(|(_, (_, a)), (_, (_, b))| a.total_cmp(b))?;
    if part <= COARSE {
        return None;
    }
    let rule = format!(
        "under-resolved: `{}` rocks with some {impacts} impacts, each up to a step late, together {} its swing: the motion is likely off by more \
         than 10 %",
        block.name,
        wording::share_of(part)
    );
    let step = 0.25 * COARSE / part * scene.time.step;
    let remedy =
        format!("use a step of at most {}; `teeter tradeoff` measures the accuracy", wording::seconds(step, 1));
    Some(document.error("time.step", rule, remedy).as_warning())
}

/// Whether a block behaves like Housner's: only its weight acts on it, on level ground or a beam
/// where it doesn't slide or bounce.
fn is_housners(scene: &Scene, contact: &ContactScene) -> bool {
    let block = &scene.blocks[contact.block];
    let bent = |ground: &GroundScene| ground.incline != 0.0 || ground.profile.is_some();
    let inclined = contact.surface == SupportingBody::Ground && scene.ground.as_ref().is_some_and(bent);
    let level = !inclined && scene.gravity[0] == 0.0;
    let law = &contact.law;
    let bounces = law.restitution > 0.0 || law.impact.has_duration();
    let slides = contact.friction_of_feet()[0] < block.width / block.height;
    level && !(bounces || slides || scene.is_driven(contact))
}

/// The number of impacts of a block released at a tilt, and their total delay as a fraction of its
/// swing: what a run measures as `under-resolved`.
fn late(scene: &Scene, contact: &ContactScene) -> Option<(u64, f64)> {
    let block = &scene.blocks[contact.block];
    let Placement::On { tilt, .. } = block.placement else { return None };
    if !is_housners(scene, contact) {
        return None;
    }
    let critical = block.critical_angle()?;
    let mut amplitude = tilt.abs() / critical;
    if !(amplitude > 0.0 && amplitude < 1.0) {
        return None;
    }
    let gravity = scene.gravity[0].hypot(scene.gravity[1]);
    let p = (0.75 * gravity / (0.5 * block.width.hypot(block.height))).sqrt();
    if !(p > 0.0 && p.is_finite()) {
        return None;
    }
    // Housner's coefficient of restitution. All angles are relative to the critical one.
    let kept = 1.0 - 1.5 * critical.sin().powi(2);
    let quarter = |amplitude: f64| (1.0 - amplitude).recip().acosh() / p;
    let (mut t, mut impacts) = (quarter(amplitude), 0);
    let (mut swing, mut way) = (amplitude, amplitude);
    let (mut late, mut carried) = (0.0, 0.0);
    while t <= scene.time.end && impacts < MOST_IMPACTS {
        let before = amplitude * (2.0 - amplitude);
        late += scene.time.step * p * before.sqrt();
        impacts += 1;
        amplitude = 1.0 - (1.0 - kept * kept * before).sqrt();
        if impacts == 1 {
            swing += amplitude;
        }
        if amplitude < STILL * swing {
            break;
        }
        way += 2.0 * amplitude;
        carried += late * 2.0 * amplitude;
        t += 2.0 * quarter(amplitude);
    }
    Some((impacts, (2.0 * carried / way * late).sqrt() / swing))
}

#[cfg(test)]
mod tests {
    use super::late;

    #[test]
    fn the_sum_of_housners_block_is_that_of_a_run() {
        let scene = "[time]\nend = '1 s'\nstep = '100 us'\nscheme = 'moreau-jean'\n[ground]\n[material.a]\ndensity = '2700 kg/m^3'\n\
            [block.r]\nmaterial = 'a'\nwidth = '3 cm'\nheight = '13.5 cm'\ndepth = '3 cm'\non = 'ground'\nat = '0 m'\ntilt = '5 deg'\n\
            [contact.f]\nbetween = ['r', 'ground']\nfriction = 0.5\n";
        let resolved = crate::load(scene.as_bytes(), "f", "f", &[]).unwrap();
        let (impacts, part) = late(&resolved.scene, &resolved.scene.contacts[0]).unwrap();
        // A run of it with steps of 10 µs has seven impacts; one with steps of 1 ms measures 0.061.
        assert_eq!(impacts, 7);
        assert!((part / 0.0061 - 1.0).abs() < 0.05, "{part}");
        assert!(resolved.warnings.is_empty() && resolved.foreseen.is_empty());
        let shaken = scene.replace("[ground]", "[ground]\nmotion = { velocity = ['1 m/s', '0 m/s'] }");
        let shaken = crate::load(shaken.as_bytes(), "f", "f", &[]).unwrap();
        assert_eq!(late(&shaken.scene, &shaken.scene.contacts[0]), None);
        let coarse = crate::load(scene.as_bytes(), "f", "f", &[("time.step".to_owned(), "1 ms".to_owned())]).unwrap();
        // A run measures it by itself.
        assert!(
            coarse.foreseen[0].rule.starts_with("under-resolved") && coarse.warnings.is_empty(),
            "{:?}",
            coarse.foreseen
        );
    }
}
