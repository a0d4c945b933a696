//! Blocks that press on much lighter ones: whether the digits of their impulses are enough to hold these.

use crate::diagnostic::Diagnostic;
use crate::document::Document;
use crate::scene::{Placement, Scene, SupportingBody};
use teeter_text::readable::shortest;

/// How many times as heavy a block may be as one that it touches. Stacks of 3 to 20 boxes of 0.1 m under a heavy one, with a friction of at least
/// [`ROUGH`], are off by less than 1e-7 m after 0.5 s up to this ratio, and by up to 0.1 m at three times it (`docs/extremes.md`).
const MOST: f64 = 1e6;

/// The same where friction hardly holds what is squeezed out sideways, and the heavy block is not below the light one.
const MOST_SMOOTH: f64 = 1e5;

/// Least friction that holds it.
const ROUGH: f64 = 0.1;

/// Two blocks of very different mass.
struct Unequal<'a> {
    contact: &'a str,
    /// The heavy one and the light one, by their numbers.
    blocks: [usize; 2],
    ratio: f64,
    most: f64,
}

/// Warns of the two blocks that can touch and are the most unequal, if they are too much so.
pub(crate) fn warning(scene: &Scene, document: &Document) -> Option<Diagnostic> {
    let masses: Vec<f64> = scene.blocks.iter().map(|block| block.mass()).collect();
    let moves = |block: usize| scene.blocks[block].motion.0.iter().any(Option::is_none);
    let mut worst: Option<Unequal<'_>> = None;
    let mut enter = |contact, friction: f64, [a, b]: [usize; 2]| {
        let blocks = if masses[a] < masses[b] { [b, a] } else { [a, b] };
        let [heavy, light] = blocks;
        // What is prescribed moves whatever presses on it.
        let ratio = if moves(heavy) && moves(light) { masses[heavy] / masses[light] } else { 1.0 };
        let is_below = matches!(scene.blocks[light].placement, Placement::On { support: SupportingBody::Block(below), .. } if below == heavy);
        let most = if friction < ROUGH && !is_below { MOST_SMOOTH } else { MOST };
        if ratio > most && worst.as_ref().is_none_or(|known| ratio > known.ratio) {
            worst = Some(Unequal { contact, blocks, ratio, most });
        }
    };
    for contact in &scene.contacts {
        if let Some(other) = contact.other_block() {
            enter(contact.name.as_str(), contact.law.friction, [contact.block, other]);
        }
    }
    if let Some(crowd) = &scene.crowd {
        // Of each contact the lightest and the heaviest: in a crowd nearly any two can touch.
        for (number, contact) in crowd.contacts().iter().enumerate() {
            let members = || (0..masses.len()).filter(|block| moves(*block) && crowd.takes_part(*block, Some(number)));
            let lightest = members().min_by(|a, b| masses[*a].total_cmp(&masses[*b]));
            let heaviest = members().max_by(|a, b| masses[*a].total_cmp(&masses[*b]));
            if let (Some(lightest), Some(heaviest)) = (lightest, heaviest) {
                enter(contact.name.as_str(), contact.law.friction, [heaviest, lightest]);
            }
        }
    }
    let Unequal { contact, blocks, ratio, most } = worst?;
    let [heavy, light] = blocks.map(|block| &scene.blocks[block].name);
    let smooth = most == MOST_SMOOTH;
    let rule = format!(
        "`{heavy}` is {} times as heavy as `{light}`, more than {most:e}{}: what rounding and the gap tolerance leave of its weight is a load to \
         the light one, and may tilt it, squeeze it out or let the pile fall",
        shortest(ratio, 2),
        if smooth { " where there is hardly any friction" } else { "" }
    );
    let remedy = format!(
        "make the light block heavier or the heavy one lighter{}; otherwise compare with a step a tenth as long",
        if smooth { format!(", or give friction of at least {ROUGH}") } else { String::new() }
    );
    Some(document.error(&format!("contact.{contact}.between"), rule, remedy).as_warning())
}
