//! Coulomb's law in the plane as four cells with two coordinates each.
//!
//! The pairs (p, u) that satisfy the law at one contact form a surface of four plane pieces around
//! the origin. With the edges of the friction cone as basis, p = a (1, −μ) + b (1, μ), they are
//!
//! ```text
//! open     (u_N ≥ 0, u_T)    p = 0
//! forward  (a ≥ 0, u_T ≥ 0)  u_N = 0, b = 0
//! backward (b ≥ 0, u_T ≤ 0)  u_N = 0, a = 0
//! stick    (a ≥ 0, b ≥ 0)    u = 0
//! ```
//!
//! Where a coordinate reaches its bound, another takes its place in the neighbouring cell. This is
//! the complementarity problem of [`Lemke`](crate::Lemke) with two rows instead of three, and
//! without the pivots that change only the sign of an open contact's u_T.

/// The state of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cell {
    Open,
    /// Slides with u_T ≥ 0.
    Forward,
    /// Slides with u_T ≤ 0.
    Backward,
    Stick,
}

/// A coordinate of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Coordinate {
    /// The impulse along (1, −μ).
    A,
    /// The impulse along (1, μ).
    B,
    /// The normal velocity.
    Normal,
    /// The tangential velocity.
    Tangential,
}

impl Coordinate {
    pub(crate) const ALL: [Self; 4] = [Self::A, Self::B, Self::Normal, Self::Tangential];

    pub(crate) fn is_impulse(self) -> bool {
        matches!(self, Self::A | Self::B)
    }
}

impl Cell {
    pub(crate) fn coordinates(self) -> [Coordinate; 2] {
        use Coordinate::{A, B, Normal, Tangential};
        match self {
            Self::Open => [Normal, Tangential],
            Self::Forward => [A, Tangential],
            Self::Backward => [B, Tangential],
            Self::Stick => [A, B],
        }
    }

    /// 1 if a coordinate has to be ≥ 0, −1 if ≤ 0, and 0 if it is free. Without friction a contact
    /// that presses is `Forward` with free u_T.
    pub(crate) fn sign(self, coordinate: Coordinate, rubs: bool) -> f64 {
        match (coordinate, self) {
            (Coordinate::Tangential, Self::Forward) if rubs => 1.0,
            (Coordinate::Tangential, Self::Backward) => -1.0,
            (Coordinate::Tangential, _) => 0.0,
            _ => 1.0,
        }
    }

    /// The cell beyond the bound of a coordinate, and the coordinate that enters there. `slip` is
    /// the tangential velocity.
    pub(crate) fn beyond(self, leaving: Coordinate, slip: f64, rubs: bool) -> (Self, Coordinate) {
        use Coordinate::{A, B, Normal, Tangential};
        match (self, leaving) {
            (Self::Stick, A) => (Self::Backward, Tangential),
            (Self::Stick, _) => (Self::Forward, Tangential),
            (Self::Forward, Tangential) => (Self::Stick, B),
            (Self::Backward, Tangential) => (Self::Stick, A),
            (Self::Forward | Self::Backward, _) => (Self::Open, Normal),
            (Self::Open, _) if slip < 0.0 && rubs => (Self::Backward, B),
            (Self::Open, _) => (Self::Forward, A),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_bound_leads_to_the_neighbour_and_back() {
        for cell in [Cell::Open, Cell::Forward, Cell::Backward, Cell::Stick] {
            for leaving in cell.coordinates().into_iter().filter(|&c| cell.sign(c, true) != 0.0) {
                for slip in [-1.0, 1.0] {
                    let (next, entering) = cell.beyond(leaving, slip, true);
                    assert!(next != cell && next.coordinates().contains(&entering));
                    let slip = if cell == Cell::Backward { -1.0 } else { 1.0 };
                    assert_eq!(next.beyond(entering, slip, true), (cell, leaving));
                }
            }
        }
    }
}
