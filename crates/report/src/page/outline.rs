//! The outline of a block where it stands, and the sides that lie against each other.

use super::scenery::BlockDrawn;

/// A stretch from one point to another, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Side {
    pub(super) from: [f64; 2],
    pub(super) to: [f64; 2],
}

impl Side {
    fn along(&self) -> ([f64; 2], f64) {
        let d = [self.to[0] - self.from[0], self.to[1] - self.from[1]];
        let length = d[0].hypot(d[1]);
        (d.map(|d| d / length), length)
    }

    /// The distance of a point from it, m.
    fn distance(&self, at: [f64; 2]) -> f64 {
        let (unit, length) = self.along();
        let r = [at[0] - self.from[0], at[1] - self.from[1]];
        let s = (r[0] * unit[0] + r[1] * unit[1]).clamp(0.0, length);
        (r[0] - s * unit[0]).hypot(r[1] - s * unit[1])
    }

    /// The part of it that lies beside another side.
    fn beside(&self, other: &Self) -> Option<Self> {
        let (unit, length) = self.along();
        let place = |at: [f64; 2]| (at[0] - self.from[0]) * unit[0] + (at[1] - self.from[1]) * unit[1];
        let (a, b) = (place(other.from), place(other.to));
        let (low, high) = (a.min(b).max(0.0), a.max(b).min(length));
        let at = |s: f64| [self.from[0] + s * unit[0], self.from[1] + s * unit[1]];
        (high > low).then(|| Self { from: at(low), to: at(high) })
    }
}

/// The outline of a block, part by part.
#[derive(Debug, Clone)]
pub(super) struct Outline {
    parts: Vec<(Vec<[f64; 2]>, f64)>,
    reach: f64,
}

/// Points of a full circle.
const CIRCLE: usize = 48;

/// Sides further from a contact than this part of the block's reach don't touch there.
const NEAR: f64 = 0.02;

impl Outline {
    pub(super) fn of(block: &BlockDrawn, [x, y, phi]: [f64; 3]) -> Self {
        let (sin, cos) = phi.sin_cos();
        let placed = |[a, b]: &[f64; 2]| [x + cos * a - sin * b, y + sin * a + cos * b];
        let mut corners = block.corners.iter();
        let part = |&(count, radius): &(usize, f64)| (corners.by_ref().take(count).map(placed).collect(), radius);
        Self { parts: block.parts.iter().map(part).collect(), reach: block.reach }
    }

    /// Straight sides, moved out to the outline of a round part, counter-clockwise.
    fn sides(&self) -> impl Iterator<Item = Side> + '_ {
        self.parts.iter().filter(|(core, _)| core.len() > 1).flat_map(|(core, radius)| {
            core.iter().enumerate().map(move |(k, &from)| {
                let side = Side { from, to: core[(k + 1) % core.len()] };
                let ([dx, dy], _) = side.along();
                let out = |at: [f64; 2]| [at[0] + radius * dy, at[1] - radius * dx];
                Side { from: out(side.from), to: out(side.to) }
            })
        })
    }

    /// Closed lines around the parts, corners rounded by short pieces.
    pub(super) fn lines(&self) -> Vec<Vec<(f64, f64)>> {
        let round = |[x, y]: [f64; 2], radius: f64, from: f64, turn: f64| {
            let pieces =
                if radius > 0.0 { ((turn / std::f64::consts::TAU * CIRCLE as f64).ceil() as usize).max(1) } else { 0 };
            (0..=pieces).map(move |k| {
                let angle = from + turn * k as f64 / pieces.max(1) as f64;
                (x + radius * angle.cos(), y + radius * angle.sin())
            })
        };
        let part = |(core, radius): &(Vec<[f64; 2]>, f64)| -> Vec<(f64, f64)> {
            if core.len() == 1 {
                return round(core[0], *radius, 0.0, std::f64::consts::TAU).collect();
            }
            let n = core.len();
            let out = |k: usize| {
                let ([dx, dy], _) = Side { from: core[k % n], to: core[(k + 1) % n] }.along();
                (-dx).atan2(dy)
            };
            let corner = |k: usize| {
                let (before, after) = (out(k + n - 1), out(k));
                round(core[k], *radius, before, (after - before).rem_euclid(std::f64::consts::TAU))
            };
            (0..n).flat_map(corner).collect()
        };
        self.parts.iter().map(part).collect()
    }

    /// Whether a side of this block lies flat against one of the other at a contact, so that it can press at both ends, whichever it does at.
    pub(super) fn lies_flat_on(&self, other: &Self, at: [f64; 2]) -> bool {
        let reach = self.reach.min(other.reach);
        let near = |side: &Side| side.along().1 > 0.0 && side.distance(at) <= NEAR * reach;
        self.sides().filter(near).any(|a| {
            other.sides().filter(near).any(|b| {
                let (([ax, ay], _), ([bx, by], _)) = (a.along(), b.along());
                let faces = ax * bx + ay * by < 0.0 && (ax * by - ay * bx).abs() < FLAT;
                faces && a.beside(&b).is_some_and(|joint| joint.along().1 > NEAR * reach)
            })
        })
    }

    /// The joint at a contact: the stretch along which a side of this block lies beside one of the other body, if it has
    /// sides; the two that face each other best. Against a body without an outline, the side that the force is nearest to
    /// being perpendicular to.
    pub(super) fn joint(&self, other: Option<&Self>, at: [f64; 2], force: [f64; 2]) -> Option<Side> {
        let near = |of: &Self, reach: f64| -> Vec<Side> {
            of.sides().filter(|side| side.along().1 > 0.0 && side.distance(at) <= NEAR * reach).collect()
        };
        let reach = other.map_or(self.reach, |other| self.reach.min(other.reach));
        let own = near(self, reach);
        let Some(other) = other else {
            let size = force[0].hypot(force[1]);
            let slant = |side: &Side| {
                let ([dx, dy], _) = side.along();
                (force[0] * dx + force[1] * dy).abs() / size
            };
            return own.into_iter().min_by(|a, b| slant(a).total_cmp(&slant(b)));
        };
        let theirs = near(other, reach);
        let facing = own.iter().flat_map(|a| theirs.iter().map(move |b| (a, b)));
        let dot = |a: &Side, b: &Side| {
            let (([ax, ay], _), ([bx, by], _)) = (a.along(), b.along());
            ax * bx + ay * by
        };
        let (a, b) = facing.min_by(|one, two| dot(one.0, one.1).total_cmp(&dot(two.0, two.1)))?;
        // Corners on a side that is far from parallel to theirs touch it at a point.
        (dot(a, b) < -0.9).then(|| a.beside(b)).flatten()
    }
}

/// Sides that are parallel to this angle, rad, lie flat on each other: over 20 cm they part by 2 µm, less than a joint does that opens.
const FLAT: f64 = 1e-5;

#[cfg(test)]
mod tests {
    use super::*;

    fn block(corners: &[[f64; 2]], radius: f64) -> BlockDrawn {
        let reach = corners.iter().fold(0.0, |most: f64, c| most.max(c[0].hypot(c[1]) + radius));
        let parts = vec![(corners.len(), radius)];
        let corners = corners.to_vec();
        BlockDrawn {
            name: String::new(),
            corners,
            parts,
            upright: false,
            alpha: None,
            reach,
            driven: false,
            prescribed: [false; 3],
        }
    }

    const SQUARE: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

    #[test]
    fn the_joint_is_where_both_sides_are() {
        let (below, above) =
            (Outline::of(&block(&SQUARE, 0.0), [0.0; 3]), Outline::of(&block(&SQUARE, 0.0), [0.5, 2.0, 0.0]));
        let joint = above.joint(Some(&below), [0.3, 1.0], [0.1, 5.0]).unwrap();
        assert_eq!((joint.from, joint.to), ([-0.5, 1.0], [1.0, 1.0]));
        // At a corner of both, the sides that face each other count, not those that go on.
        let joint = above.joint(Some(&below), [1.0, 1.0], [0.1, 5.0]).unwrap();
        assert_eq!((joint.from, joint.to), ([-0.5, 1.0], [1.0, 1.0]));
        let ground = below.joint(None, [1.0, -1.0], [0.3, 5.0]).unwrap();
        assert_eq!((ground.from, ground.to), ([-1.0, -1.0], [1.0, -1.0]));
    }

    #[test]
    fn a_tilted_block_does_not_lie_flat() {
        let of = |phi: f64| {
            let above = Outline::of(&block(&SQUARE, 0.0), [0.5, 2.0, phi]);
            above.lies_flat_on(&Outline::of(&block(&SQUARE, 0.0), [0.0; 3]), [1.0, 1.0])
        };
        assert!(of(0.0) && of(1e-6) && !of(1e-4));
    }

    #[test]
    fn a_disc_has_no_joint_and_a_round_outline() {
        let disc = Outline::of(&block(&[[0.0, 0.0]], 0.5), [3.0, 0.0, 1.0]);
        assert!(disc.joint(None, [3.0, -0.5], [0.0, 1.0]).is_none());
        assert!(disc.lines()[0].iter().all(|(x, y)| ((x - 3.0).hypot(*y) - 0.5).abs() < 1e-12));
        let rounded = Outline::of(&block(&SQUARE, 0.5), [0.0; 3]);
        let farthest = rounded.lines()[0].iter().fold(0.0, |most: f64, (x, _)| most.max(*x));
        assert!((farthest - 1.5).abs() < 1e-12 && rounded.lines()[0].len() > 40);
    }
}
