//! Which blocks fell from their places in a wall, an arch or a pile (`docs/verdict.md`).

use super::{Fates, Watch, Watched};
use serde::{Deserialize, Serialize};
use teeter_integrator::State;
use teeter_scenario::scene::BlockScene;
use teeter_scenario::simulation::Layout;

/// Two blocks that touched at the start still stand together while one has turned against the other by less than this, rad (10°), and moved by less
/// than the size of the smaller one: joints that open as hinges do so by less.
const APART: f64 = 10.0 * std::f64::consts::PI / 180.0;

/// What held blocks at the start.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Joints {
    /// Blocks that touched each other, and where the second was as seen from the first: m, m, rad.
    between: Vec<([usize; 2], [f64; 3])>,
    /// Of each block, whether it touched ground or a beam, or its motion is prescribed.
    held: Vec<bool>,
}

impl Joints {
    /// `pairs` are the numbers of blocks that touch at the start; a number beyond the blocks is ground or a beam.
    pub(super) fn new(pairs: &[[usize; 2]], blocks: &[Watched], layout: &Layout, state: &State) -> Self {
        let mut held: Vec<bool> = blocks.iter().map(|block| block.driven).collect();
        let mut between = Vec::new();
        for pair in pairs {
            match *pair {
                [a, b] if a.max(b) < blocks.len() => between.push(([a, b], seen_from(a, b, layout, state))),
                [a, b] => {
                    if let Some(held) = held.get_mut(a.min(b)) {
                        *held = true;
                    }
                }
            }
        }
        Self { between, held }
    }

    /// Whether a block was held by other blocks only.
    pub(super) fn only_by_blocks(&self, number: usize) -> bool {
        !self.held.get(number).is_some_and(|held| *held) && self.between.iter().any(|(pair, _)| pair.contains(&number))
    }
}

/// Where block `b` is as seen from block `a`: m, m, rad.
fn seen_from(a: usize, b: usize, layout: &Layout, state: &State) -> [f64; 3] {
    let [from, to] = [a, b].map(|number| &state.q[layout.blocks[number].range.clone()]);
    let ((sin, cos), [x, y]) = (from[2].sin_cos(), [to[0] - from[0], to[1] - from[1]]);
    [cos * x + sin * y, cos * y - sin * x, to[2] - from[2]]
}

impl Fates {
    /// Of each block, whether no chain of blocks that still stand together as they did at the start holds it on ground, a beam or a block with a
    /// prescribed motion. A block that overturned holds nothing.
    pub(super) fn loose(&self, watch: &Watch, layout: &Layout, state: &State) -> Vec<bool> {
        let together = |([a, b], began): &([usize; 2], [f64; 3])| {
            let now = seen_from(*a, *b, layout, state);
            let size = watch.blocks[*a].reach.min(watch.blocks[*b].reach);
            (now[0] - began[0]).hypot(now[1] - began[1]) < size && (now[2] - began[2]).abs() < APART
        };
        let kept: Vec<_> = self.joints.between.iter().filter(|joint| together(joint)).map(|(pair, _)| *pair).collect();
        let mut loose = vec![true; watch.blocks.len()];
        let stands = |number: &usize| self.joints.held[*number] && self.blocks[*number].beyond.is_none();
        let mut next: Vec<usize> = (0..self.joints.held.len()).filter(stands).collect();
        while let Some(at) = next.pop() {
            if std::mem::replace(&mut loose[at], false) {
                next.extend(kept.iter().filter(|pair| pair.contains(&at)).map(|[a, b]| if *a == at { *b } else { *a }));
            }
        }
        loose
    }
}

/// The least width of a block between two parallel lines, m: what it falls by when it leaves its place.
pub(super) fn thickness(block: &BlockScene) -> f64 {
    let corners = block.corners();
    let across = |from: usize| {
        let side = corners[(from + 1) % corners.len()] - corners[from];
        let length = side.norm();
        let distances = corners.iter().map(|at| *at - corners[from]).map(|to| (side.x * to.y - side.y * to.x).abs());
        (length > 0.0).then(|| distances.fold(0.0, f64::max) / length)
    };
    let least = (0..corners.len()).filter_map(across).fold(f64::INFINITY, f64::min);
    if corners.len() > 2 && least.is_finite() { least } else { 2.0 * block.radius() }
}
