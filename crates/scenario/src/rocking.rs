//! What a step does to a block that is let go tilted, before anything is run.
//!
//! Each impact is caught up to a step late, so the foot is off by up to h b |ω|, b the block's width. Added up over the impacts and relative to the swing b Δφ
//! this is what a run measures as `under-resolved` (`docs/resolution.md`). Housner's block (1963) says beforehand how many impacts there are and how fast.

use crate::diagnostic::Diagnostic;
use crate::document::Document;
use crate::scene::{BlockScene, Placement, Scene};

/// A sum above this part of the swing: on a beam a run's own is larger than on rigid ground, and a block that overturns has few impacts, so only what is
/// twice as much as a run may show is warned of before it.
const COARSE: f64 = 0.02;

/// The time between impacts shrinks with the swing; by this part, about, over the first ones.
const SHRINKS: f64 = 0.8;

/// A block whose impacts the step makes too coarse.
pub(crate) fn coarse(scene: &Scene, document: &Document) -> Option<Diagnostic> {
    let worst = scene.blocks.iter().filter_map(|block| Some((block, sum(scene, block)?)));
    let (block, (impacts, part)) = worst.max_by(|(_, (_, a)), (_, (_, b))| a.total_cmp(b))?;
    if part <= COARSE {
        return None;
    }
    let rule = format!(
        "under-resolved: `{}` rocks with some {impacts} impacts, each up to a step late, {:.0} % of its swing together: the motion is likely off by more \
         than 10 %",
        block.name,
        100.0 * part
    );
    let step = 0.25 * COARSE / part * scene.time.step;
    let remedy = format!("take a step of at most {step:.0e} s; `teeter tradeoff` measures what accuracy it gives");
    Some(document.error("time.step", rule, remedy).as_warning())
}

/// The number of impacts of a block let go tilted, and h Σ|ω| of them over the swing.
fn sum(scene: &Scene, block: &BlockScene) -> Option<(u64, f64)> {
    let Placement::On { tilt, .. } = block.placement else { return None };
    let part = tilt.abs() / block.critical_angle();
    if !(part > 0.0 && part < 1.0) {
        return None;
    }
    let gravity = scene.gravity[0].hypot(scene.gravity[1]);
    let p = (0.75 * gravity / (0.5 * block.width.hypot(block.height))).sqrt();
    // To the first impact, and between two.
    let quarter = (1.0 - part).recip().acosh() / p;
    let rest = (scene.time.end - quarter) / (2.0 * SHRINKS * quarter);
    if !(rest >= 0.0 && rest.is_finite()) {
        return None;
    }
    let impacts = 1 + rest.floor() as u64;
    // At an impact ω = p α √(x (2 − x)), x = φ₀/α; the swing is 2 φ₀.
    Some((impacts, impacts as f64 * scene.time.step * p * ((2.0 - part) / part).sqrt() / 2.0))
}

#[cfg(test)]
mod tests {
    use super::sum;

    #[test]
    fn the_sum_of_housners_block_is_that_of_a_run() {
        let scene = "[time]\nend = '1 s'\nstep = '100 us'\n[ground]\n[material.a]\ndensity = '2700 kg/m^3'\n\
            [block.r]\nmaterial = 'a'\nwidth = '3 cm'\nheight = '13.5 cm'\ndepth = '3 cm'\non = 'ground'\nat = '0 m'\ntilt = '5 deg'\n\
            [contact.f]\nbetween = ['r', 'ground']\nfriction = 0.5\n";
        let resolved = crate::load(scene.as_bytes(), "f", "f", &[]).unwrap();
        let (impacts, part) = sum(&resolved.scene, &resolved.scene.blocks[0]).unwrap();
        // A run of it has six or seven impacts, and 0.0064.
        assert_eq!(impacts, 6);
        assert!((part / 0.0064 - 1.0).abs() < 0.1, "{part}");
        assert!(resolved.warnings.is_empty());
        let coarse = crate::load(scene.as_bytes(), "f", "f", &[("time.step".to_owned(), "1 ms".to_owned())]).unwrap();
        assert!(coarse.warnings[0].rule.starts_with("under-resolved"), "{:?}", coarse.warnings);
    }
}
