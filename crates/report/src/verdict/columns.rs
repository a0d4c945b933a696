//! Blocks that stand on each other and rock as one, or did before they came to rest: on the base of the lowest, with the critical angle of all of them together.

use super::{BodyVerdict, Fate, ROCKED, SLID, Seen, Watched};
use std::collections::BTreeMap;
use teeter_integrator::State;
use teeter_scenario::scene::{Scene, SupportingBody};
use teeter_scenario::simulation::Layout;

/// Blocks rock as one if the joints between them never opened by more than this part of the angle to which they turned; of those that came to rest not
/// when they were turned the farthest.
const AS_ONE: f64 = 0.02;

/// Says of each block that rocks on another one without turning relative to it with which it does, and of the lowest how far all of them together are from
/// overturning.
pub(super) fn find(
    watched: &[Watched],
    seen: &[Seen],
    scene: &Scene,
    layout: &Layout,
    state: &State,
    verdict: &mut [BodyVerdict],
) {
    // Verdicts are of the blocks that aren't driven, in their order.
    let mut told = 0..verdict.len();
    let places: Vec<Option<usize>> = watched.iter().map(|of| if of.driven { None } else { told.next() }).collect();
    let rocks = |number: usize, verdict: &[BodyVerdict]| {
        places[number].filter(|of| match verdict[*of].what {
            Fate::Rocks => verdict[*of].tips.is_none(),
            // What never moved didn't rock.
            Fate::Rests => verdict[*of].t > Some(0.0),
            _ => false,
        })
    };
    // The angle to which a block of which φ/α is known has turned, rad.
    let turned = |number: usize, part: Option<f64>| Some(part? * scene.blocks[number].critical_angle()?);
    let lowest_below = |number: usize| {
        let mut block = number;
        // At most as many storeys as there are blocks.
        for _ in 0..watched.len() {
            let Some(SupportingBody::Block(below)) = watched[block].on else { break };
            let (Some(of), Some(foot)) = (rocks(block, verdict), rocks(below, verdict)) else { break };
            if verdict[of].what != verdict[foot].what {
                break;
            }
            let [turned, beneath] =
                [(block, of), (below, foot)].map(|(block, of)| turned(block, verdict[of].max_phi_over_alpha));
            let Some((turned, beneath)) = turned.zip(beneath) else { break };
            let opened = match verdict[of].what {
                // While the last small swings die out the joints open one by one: its largest swing tells how it rocked.
                Fate::Rests => seen[block].joint.max((turned - beneath).abs()),
                _ => seen[block].turned[0].max(seen[block].turned[1]),
            };
            if watched[below].driven || opened > AS_ONE * turned {
                break;
            }
            block = below;
        }
        block
    };
    let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for number in 0..watched.len() {
        groups.entry(lowest_below(number)).or_default().push(number);
    }
    for (root, group) in groups.into_iter().filter(|(_, group)| group.len() > 1) {
        let stays =
            |number: usize| rocks(number, verdict).is_some_and(|of| keeps_its_place(&watched[number], &verdict[of]));
        let above = |below: usize| {
            group.iter().filter(|number| watched[**number].on == Some(SupportingBody::Block(below))).count()
        };
        let in_column = group.iter().all(|number| above(*number) <= 1)
            && group.iter().all(|number| *number == root || stays(*number));
        let Some(base) = rocks(root, verdict) else { continue };
        let column = critical_angles(watched, layout, state, &group, root).filter(|_| in_column).map(|alpha| {
            let parts = seen[root].turned.into_iter().zip(alpha).filter(|(_, alpha)| *alpha > 0.0);
            parts.fold(0.0, |most: f64, (turned, alpha)| most.max(turned / alpha))
        });
        // What came to rest rocked if the column as a whole did; drums that are much wider than it is hardly turned.
        if verdict[base].what == Fate::Rests && column.is_none_or(|part| part < ROCKED) {
            continue;
        }
        for number in group.iter().filter(|number| **number != root) {
            if let Some(of) = rocks(*number, verdict) {
                verdict[of].turns_with = Some(layout.blocks[root].name.clone());
                verdict[of].in_column = in_column;
            }
        }
        verdict[base].column = column;
    }
}

/// Whether a block never slid along what carries it by as much as is told.
fn keeps_its_place(of: &Watched, verdict: &BodyVerdict) -> bool {
    let base = of.feet.map_or(0.0, |[left, right]| right[0] - left[0]);
    verdict.farthest.is_none() && verdict.slid.is_some_and(|slid| slid.abs() < SLID * base)
}

/// The angles by which blocks turn about the left and the right foot of the lowest until their common mass centre is over it, rad.
fn critical_angles(
    watched: &[Watched],
    layout: &Layout,
    state: &State,
    group: &[usize],
    root: usize,
) -> Option<[f64; 2]> {
    let place = |number: usize| &state.q[layout.blocks[number].range.clone()];
    let mass: f64 = group.iter().map(|number| watched[*number].mass).sum();
    let centre =
        [0, 1].map(|k| group.iter().map(|number| watched[*number].mass * place(*number)[k]).sum::<f64>() / mass);
    let (own, feet) = (place(root), watched[root].feet?);
    let (sin, cos) = own[2].sin_cos();
    let [dx, dy] = [centre[0] - own[0], centre[1] - own[1]];
    let [x, y] = [cos * dx + sin * dy, cos * dy - sin * dx];
    let slope = watched[root].slope(&state.q);
    let [left, right] = feet.map(|foot| (x - foot[0]).atan2(y - foot[1]));
    Some([left - slope, slope - right])
}
