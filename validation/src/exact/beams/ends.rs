//! How the end of a beam is held.

/// What opposes a displacement or a rotation of an end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Hold {
    /// Nothing.
    Free,
    /// A spring, N/m or N·m (per radian).
    Spring(f64),
    /// Everything.
    Held,
}

/// An end of a beam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct End {
    /// Against its deflection w.
    pub(crate) shift: Hold,
    /// Against its rotation r.
    pub(crate) turn: Hold,
}

/// No force, no couple.
pub(crate) const FREE: End = End { shift: Hold::Free, turn: Hold::Free };
/// w = 0, no couple.
pub(crate) const PINNED: End = End { shift: Hold::Held, turn: Hold::Free };
/// w = 0, r = 0.
pub(crate) const CLAMPED: End = End { shift: Hold::Held, turn: Hold::Held };
/// r = 0, no force.
pub(crate) const GUIDED: End = End { shift: Hold::Free, turn: Hold::Held };

/// The four with their names.
pub(crate) const ENDS: [(&str, End); 4] =
    [("free", FREE), ("pinned", PINNED), ("clamped", CLAMPED), ("guided", GUIDED)];

/// Whether a rigid beam could not move: w = a + bx costs something for every a, b. A force at one end holds a, two forces or a couple
/// hold b.
pub(crate) fn hold_still(ends: [End; 2]) -> bool {
    let holds = |hold: Hold| hold != Hold::Free && hold != Hold::Spring(0.0);
    let shifts = ends.iter().filter(|end| holds(end.shift)).count();
    shifts == 2 || (shifts == 1 && ends.iter().any(|end| holds(end.turn)))
}

/// All pairs of [`ENDS`] that hold a beam, left end first, with a name like "clamped–free".
pub(crate) fn holding_pairs() -> Vec<(String, [End; 2])> {
    let pairs = ENDS.iter().flat_map(|left| ENDS.iter().map(move |right| (left, right)));
    let named = pairs.map(|(left, right)| (format!("{}–{}", left.0, right.0), [left.1, right.1]));
    named.filter(|(_, ends)| hold_still(*ends)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ten_pairs_hold_a_beam() {
        let names: Vec<_> = holding_pairs().into_iter().map(|(name, _)| name).collect();
        assert_eq!(
            names,
            [
                "free–clamped",
                "pinned–pinned",
                "pinned–clamped",
                "pinned–guided",
                "clamped–free",
                "clamped–pinned",
                "clamped–clamped",
                "clamped–guided",
                "guided–pinned",
                "guided–clamped",
            ]
        );
    }

    #[test]
    fn springs_hold_too() {
        let spring = End { shift: Hold::Spring(3.0), turn: Hold::Free };
        assert!(hold_still([spring, spring]) && hold_still([GUIDED, spring]) && !hold_still([FREE, spring]));
        assert!(!hold_still([End { shift: Hold::Spring(0.0), turn: Hold::Held }, FREE]));
    }
}
