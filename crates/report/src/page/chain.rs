//! The line of thrust: where the forces pass through a chain of bodies of which each touches the next, such
//! as an arch or a column. Chains are recognised by what touches what, not by names.

use super::network::{Link, cosine};
use super::outline::{Outline, Side};
use super::recorder::{BLOCK_FRAME, PageRecorder};
use teeter_scenario::scene::SupportingBody;

/// Where one body of a chain touches the next.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// The bodies, in the order of the chain.
    pub between: [String; 2],
    /// The centre of pressure, through which the resultant passes, m.
    pub at: [f64; 2],
    /// The force on the second body, N: a mean over the interval of the line.
    pub force: [f64; 2],
    /// The joint's depth: the length over which the two bodies lie against each other, m; `None`
    /// where no two sides do, as of discs.
    pub depth: Option<f64>,
    /// The distance of the centre of pressure from the joint's middle, m, to the left as one goes
    /// along the chain: in an arch that starts at the left, towards its extrados.
    pub eccentricity: Option<f64>,
    /// The force across the joint and along it, N; `None` without a depth.
    pub normal_and_shear: Option<[f64; 2]>,
}

/// A line of thrust.
#[derive(Debug, Clone, PartialEq)]
pub struct ThrustLine {
    /// The blocks, from a support on; of two supports from that further left.
    pub blocks: Vec<String>,
    /// The joints in the order of the blocks: the first is that between the support and the first
    /// block.
    pub joints: Vec<Joint>,
    /// The time over which the forces are means, s.
    pub interval: [f64; 2],
}

/// Fewest blocks of a chain, and of a network of forces: one on its support, or two, show no way of the forces.
pub(super) const FEWEST: usize = 3;

/// A pair whose force is below this part of the largest doesn't carry.
const CARRIES: f64 = 1e-9;

/// What a pair exchanged, with the numbers of its bodies.
#[derive(Debug, Clone, Copy)]
pub(super) struct Thrust {
    pub(super) block: usize,
    pub(super) other: SupportingBody,
    /// Force on the block, N.
    pub(super) force: [f64; 2],
    /// Where, m.
    pub(super) at: [f64; 2],
}

impl Thrust {
    pub(super) fn size(&self) -> f64 {
        self.force[0].hypot(self.force[1])
    }
}

/// The last picture: when, the poses, and the forces since the one before it.
pub(super) struct LastPicture<'a> {
    pub(super) interval: [f64; 2],
    pub(super) poses: Vec<[f64; BLOCK_FRAME]>,
    pub(super) row: &'a [f64],
    pub(super) thrusts: Vec<Thrust>,
}

impl<'a> LastPicture<'a> {
    /// `None` of a run without a step.
    pub(super) fn of(recorder: &'a PageRecorder) -> Option<Self> {
        let rows: Vec<(f64, &[f64])> = recorder.kept.frames.rows().collect();
        let [.., (from, _), (to, row)] = rows[..] else { return None };
        let poses: Vec<_> = row.chunks_exact(BLOCK_FRAME).take(recorder.scenery.blocks.len()).collect();
        let poses: Vec<[f64; 3]> = poses.into_iter().map(|pose| [pose[0], pose[1], pose[2]]).collect();
        let thrust = |link: &Link| {
            let (block, other) = recorder.scenery.bodies_of(link.pair)?;
            let [x, y, phi] = *poses.get(block)?;
            let ([a, b], (sin, cos)) = (link.place()?, phi.sin_cos());
            let force = link.impulse.map(|impulse| impulse / (to - from));
            Some(Thrust { block, other, force, at: [x + cos * a - sin * b, y + sin * a + cos * b] })
        };
        let links = recorder.kept.network.pictures(rows.len()).last().unwrap_or_default();
        let thrusts = links.iter().filter_map(thrust).collect();
        Some(Self { interval: [from, to], poses, row, thrusts })
    }

    /// By blocks: how many free ones forces link with each other there; supports end the way of a force.
    pub(super) fn linked(&self, is_free: impl Fn(usize) -> bool) -> Vec<usize> {
        let mut parents: Vec<usize> = (0..self.poses.len()).collect();
        fn root(parents: &mut [usize], mut block: usize) -> usize {
            while parents[block] != block {
                parents[block] = parents[parents[block]];
                block = parents[block];
            }
            block
        }
        let largest = self.thrusts.iter().map(Thrust::size).fold(0.0, f64::max);
        for thrust in self.thrusts.iter().filter(|thrust| thrust.size() > CARRIES * largest) {
            if let SupportingBody::Block(other) = thrust.other
                && is_free(thrust.block)
                && is_free(other)
            {
                let (one, other) = (root(&mut parents, thrust.block), root(&mut parents, other));
                parents[one] = other;
            }
        }
        let mut counts = vec![0; parents.len()];
        for block in (0..parents.len()).filter(|block| is_free(*block)) {
            counts[root(&mut parents, block)] += 1;
        }
        (0..self.poses.len()).map(|block| counts[root(&mut parents, block)]).collect()
    }
}

/// The lines of thrust at the end of a run: of each chain of three blocks or more that stands on a support (ground, a
/// beam, a block whose motion is prescribed) with its first block and ends at one or is free at its end, each of whose
/// blocks touches no others, and none of which two neighbours bear together, as a lintel on its posts.
#[must_use]
pub fn thrust_lines(recorder: &PageRecorder) -> Vec<ThrustLine> {
    let Some(last) = LastPicture::of(recorder) else { return Vec::new() };
    let blocks = &recorder.scenery.blocks;
    let largest = last.thrusts.iter().map(Thrust::size).fold(0.0, f64::max);
    // The neighbours of each free block: a block that is a support has none.
    let is_free = |block: usize| !blocks[block].driven;
    let mut touching: Vec<Vec<&Thrust>> = vec![Vec::new(); blocks.len()];
    for thrust in last.thrusts.iter().filter(|thrust| thrust.size() > CARRIES * largest) {
        let other = match thrust.other {
            SupportingBody::Block(other) => Some(other),
            SupportingBody::Ground | SupportingBody::Beam(_) => None,
        };
        for block in [Some(thrust.block), other].into_iter().flatten().filter(|block| is_free(*block)) {
            touching[block].push(thrust);
        }
    }
    // The block on the other side of a thrust; none of a support.
    let beyond = |thrust: &Thrust, block: usize| {
        let other = match thrust.other {
            SupportingBody::Block(other) if other == block => thrust.block,
            SupportingBody::Block(other) => other,
            SupportingBody::Ground | SupportingBody::Beam(_) => return None,
        };
        is_free(other).then_some(other)
    };
    let on =
        |thrust: &Thrust, block: usize| if thrust.block == block { thrust.force } else { thrust.force.map(|x| -x) };
    let mut seen = vec![false; blocks.len()];
    let mut starts: Vec<(usize, &Thrust)> = Vec::new();
    for (block, thrusts) in touching.iter().enumerate() {
        starts.extend(thrusts.iter().filter(|thrust| beyond(thrust, block).is_none()).map(|thrust| (block, *thrust)));
    }
    starts.sort_by(|a, b| a.1.at[0].total_cmp(&b.1.at[0]));
    let mut lines = Vec::new();
    for (first, start) in starts {
        let (mut chain, mut thrusts) = (vec![first], vec![start]);
        let whole = loop {
            let block = chain[chain.len() - 1];
            let entered = thrusts[thrusts.len() - 1];
            let mut onwards = touching[block].iter().filter(|thrust| !std::ptr::eq(**thrust, entered));
            match (onwards.next(), onwards.next()) {
                (None, _) => break true,
                (Some(_), Some(_)) => break false,
                // What lies on two supports hands no force on from one to the other: a line through both is the way of none.
                (Some(next), None) if cosine(on(entered, block), on(next, block)) > 0.0 => break false,
                (Some(next), None) => {
                    thrusts.push(next);
                    match beyond(next, block) {
                        None => break true,
                        Some(other) if chain.contains(&other) => break false,
                        Some(other) => chain.push(other),
                    }
                }
            }
        };
        if whole && chain.len() >= FEWEST && !seen[chain[0]] {
            chain.iter().for_each(|block| seen[*block] = true);
            lines.push(line(recorder, &last, &chain, &thrusts));
        }
    }
    lines
}

fn line(recorder: &PageRecorder, last: &LastPicture<'_>, chain: &[usize], thrusts: &[&Thrust]) -> ThrustLine {
    let blocks = &recorder.scenery.blocks;
    let name = |thrust: &Thrust, than: usize| match thrust.other {
        SupportingBody::Ground => "ground".to_owned(),
        SupportingBody::Beam(beam) => recorder.scenery.beams[beam].name.clone(),
        SupportingBody::Block(other) if other == than => blocks[thrust.block].name.clone(),
        SupportingBody::Block(other) => blocks[other].name.clone(),
    };
    let outline = |block: usize| Outline::of(&blocks[block], last.poses[block]);
    let joints = thrusts.iter().enumerate().map(|(number, thrust)| {
        let block = chain[number.min(chain.len() - 1)];
        // Past the last block the chain comes to its second support.
        let (leaves, own) = (number == chain.len(), blocks[block].name.clone());
        let other = name(thrust, block);
        let between = if leaves { [own, other] } else { [other, own] };
        let on_block = if thrust.block == block { thrust.force } else { thrust.force.map(|force| -force) };
        let force = if leaves { on_block.map(|force| -force) } else { on_block };
        let beyond = match thrust.other {
            SupportingBody::Block(other) => Some(outline(if other == block { thrust.block } else { other })),
            SupportingBody::Ground | SupportingBody::Beam(_) => None,
        };
        let side = outline(block).joint(beyond.as_ref(), thrust.at, thrust.force);
        // Along the chain, from below the joint to above it.
        let [x, y, _] = last.poses[block];
        let ahead = [x - thrust.at[0], y - thrust.at[1]].map(|d| if leaves { -d } else { d });
        let mut joint =
            Joint { between, at: thrust.at, force, depth: None, eccentricity: None, normal_and_shear: None };
        if let Some(Side { from, to }) = side {
            let along = [to[0] - from[0], to[1] - from[1]];
            let depth = along[0].hypot(along[1]);
            let left = ahead[0] * along[1] - ahead[1] * along[0] > 0.0;
            let unit = along.map(|d| if left { d / depth } else { -d / depth });
            let normal = [unit[1], -unit[0]];
            let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
            let middle = [0, 1].map(|k| thrust.at[k] - 0.5 * (from[k] + to[k]));
            joint.depth = Some(depth);
            joint.eccentricity = Some(dot(middle, unit));
            joint.normal_and_shear = Some([dot(force, normal), dot(force, unit)]);
        }
        joint
    });
    ThrustLine {
        blocks: chain.iter().map(|block| blocks[*block].name.clone()).collect(),
        joints: joints.collect(),
        interval: last.interval,
    }
}
