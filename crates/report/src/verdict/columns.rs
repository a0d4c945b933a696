//! Blocks that stand on each other and rock as one: on the base of the lowest, with the critical angle of all of them together.

use super::{BodyVerdict, Fate, Watched};
use std::collections::BTreeMap;
use teeter_integrator::{RockingMonitor, State};
use teeter_scenario::scene::{Scene, SupportingBody};
use teeter_scenario::simulation::Layout;

/// Blocks rock as one if the joints between them never opened by more than this part of the angle to which they turned.
const AS_ONE: f64 = 0.02;

/// Says of each block that rocks on another one without turning relative to it with which it does, and of the lowest how far all of them together are from
/// overturning.
pub(super) fn find(
    watched: &[Watched],
    scene: &Scene,
    layout: &Layout,
    state: &State,
    rocking: &[RockingMonitor],
    verdict: &mut [BodyVerdict],
) {
    // Verdicts are of the blocks that aren't driven, in their order.
    let mut told = 0..verdict.len();
    let places: Vec<Option<usize>> = watched.iter().map(|of| if of.driven { None } else { told.next() }).collect();
    let rocks = |number: usize, verdict: &[BodyVerdict]| {
        places[number].filter(|of| verdict[*of].what == Fate::Rocks && verdict[*of].tips.is_none())
    };
    // The angle to which a block of which φ/α is known has turned, rad.
    let turned = |number: usize, part: Option<f64>| Some(part? * scene.blocks[number].critical_angle()?);
    let lowest_below = |number: usize| {
        let mut block = number;
        // At most as many storeys as there are blocks.
        for _ in 0..watched.len() {
            let Some(SupportingBody::Block(below)) = watched[block].on else { break };
            let (Some(of), Some(_)) = (rocks(block, verdict), rocks(below, verdict)) else { break };
            let opened = rocking.get(block).map_or(f64::INFINITY, opened);
            let Some(turned) = turned(block, verdict[of].max_phi_over_alpha) else { break };
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
        for number in group.iter().filter(|number| **number != root) {
            if let Some(of) = rocks(*number, verdict) {
                verdict[of].turns_with = Some(layout.blocks[root].name.clone());
            }
        }
        let Some(of) = rocks(root, verdict) else { continue };
        let alpha = critical_angle(watched, layout, state, &group, root);
        verdict[of].column =
            turned(root, verdict[of].max_phi_over_alpha).zip(alpha).map(|(turned, alpha)| turned / alpha);
    }
}

/// How far a block has turned at most relative to what carries it, rad.
fn opened(monitor: &RockingMonitor) -> f64 {
    monitor
        .peaks()
        .iter()
        .map(|peak| peak.phi)
        .chain([monitor.extreme().phi])
        .fold(0.0, |most: f64, phi| most.max(phi.abs()))
}

/// The angle by which blocks turn about the nearer foot of the lowest until their common mass centre is over it, rad.
fn critical_angle(watched: &[Watched], layout: &Layout, state: &State, group: &[usize], root: usize) -> Option<f64> {
    let place = |number: usize| &state.q[layout.blocks[number].range.clone()];
    let mass: f64 = group.iter().map(|number| watched[*number].mass).sum();
    let centre =
        [0, 1].map(|k| group.iter().map(|number| watched[*number].mass * place(*number)[k]).sum::<f64>() / mass);
    let (own, feet) = (place(root), watched[root].feet?);
    let (sin, cos) = own[2].sin_cos();
    let [dx, dy] = [centre[0] - own[0], centre[1] - own[1]];
    let [x, y] = [cos * dx + sin * dy, cos * dy - sin * dx];
    let alpha = feet.map(|foot| (x - foot[0]).abs().atan2(y - foot[1]));
    Some(alpha[0].min(alpha[1])).filter(|alpha| *alpha > 0.0)
}
