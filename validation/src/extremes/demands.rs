//! What every row must keep, whatever its scene, and the misses that are known.

use super::measure::{Ending, Measured};
use super::row::Row;
use teeter_integrator::EventDriven;

/// What a step may gain by rounding, relative to the scene's energy scale.
const GAIN: f64 = 1e-13;

/// The same as a part of the contact solver's tolerance: the law holds, and with it the promise, to no more than that.
const GAIN_OF_TOLERANCE: f64 = 1e-3;

/// Largest residual of a step's energy account, relative to the same.
const RESIDUAL: f64 = 1e-12;

/// The same of `event-driven`, whose smooth motion is right to 1e-12 in each of its own steps, of which one of the output has many.
const RESIDUAL_OF_STEPS: f64 = 1e-10;

/// What a row can miss.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Demand {
    /// No number is lost.
    Finite,
    /// It ends, or is refused before it begins, with a reason.
    Ends,
    /// No step gains energy, in the scheme that promises it.
    Gain,
    /// The energy account closes.
    Account,
    /// Penetration keeps within its bound.
    Penetration,
    /// Residuals are what the judge says.
    Honest,
}

impl Demand {
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Finite => "finite",
            Self::Ends => "ends",
            Self::Gain => "gain",
            Self::Account => "account",
            Self::Penetration => "penetration",
            Self::Honest => "honest",
        }
    }
}

/// What a row misses of them.
pub(crate) fn missed(row: &Row, measured: &Measured) -> Vec<Demand> {
    let mut missed = Vec::new();
    let mut demand = |demand, kept: bool| {
        if !kept {
            missed.push(demand);
        }
    };
    demand(Demand::Finite, measured.finite);
    demand(
        Demand::Ends,
        match &measured.ending {
            Ending::Complete => true,
            Ending::Refused(message) => !message.is_empty(),
            Ending::Failed(_) => false,
        },
    );
    demand(
        Demand::Gain,
        !row.scheme.keeps_energy() || measured.gain <= GAIN.max(GAIN_OF_TOLERANCE * measured.tolerance),
    );
    let residual = if row.scheme.0 == EventDriven::NAME { RESIDUAL_OF_STEPS } else { RESIDUAL };
    demand(Demand::Account, measured.residual <= residual);
    demand(Demand::Penetration, measured.penetration <= 1.0);
    demand(Demand::Honest, measured.dishonest == 0);
    missed
}

/// Misses that are known: the rows, by the beginning of their names, the demand, and why.
pub(crate) const KNOWN: &[(&str, Demand, &str)] = &[
    ("beam-mass/1e6/beam/open/e=1", Demand::Account, FAST_MODES),
    ("beam-mass/1e6/beam/generalized-alpha", Demand::Account, FAST_MODES),
    ("dt/1e-2/beam/generalized-alpha", Demand::Account, FAST_MODES),
    ("dt/1e-1/beam/open/e=0", Demand::Account, FAST_MODES),
    ("f-dt/1e-1/beam/generalized-alpha", Demand::Account, FAST_MODES),
    ("f-dt/1e0/beam/located", Demand::Account, FAST_MODES),
    ("elements/200/beam/open", Demand::Account, FAST_MODES),
    ("elements/200/beam/generalized-alpha", Demand::Account, FAST_MODES),
    ("modulus/1e15/beam/generalized-alpha/e=1", Demand::Account, FAST_MODES),
    ("sides/wide-dt-1e-2/beam/generalized-alpha", Demand::Account, FAST_MODES),
    ("size/1e-6/beam/generalized-alpha/e=0", Demand::Account, FAST_MODES),
    (
        "modulus/1e4/beam/located/e=1",
        Demand::Account,
        "the block folds a beam of 10 kPa around itself and jams with impulses of 2e5 N s, 1e5 times its momentum, \
         whose rounding shows.",
    ),
    ("place/support/beam/event-driven", Demand::Account, AT_THE_END),
    ("place/support/beam/event-driven/e=0", Demand::Penetration, AT_THE_END),
    ("elements/500/beam", Demand::Account, FAST_MODES),
    ("elements/1000/beam", Demand::Account, FAST_MODES),
    ("elements/2000/beam", Demand::Account, FAST_MODES),
    (
        "f-dt/1e1/beam/open",
        Demand::Penetration,
        "the block falls by 0.7 m in a step, from above the beam to below it, and past its end in the next: it is \
         below the beam once, without an active contact. `check` warns of the step.",
    ),
    (
        "place/last-node/beam",
        Demand::Penetration,
        "the block falls off the end and swings under the beam. A surface has no sides and no thickness, so a point \
         below it counts as penetrating (theory.md §3). Only `max_penetration` shows this.",
    ),
    (
        "tolerance/pgs-1e-2/beam/closed",
        Demand::Penetration,
        "the law is satisfied only to one per cent, and a lasting contact penetrates by the residual in each step.",
    ),
];

const AT_THE_END: &str = "the corner stands at the end of the surface and slides off and on: the motion isn't smooth \
     there, and steps are left to the located scheme (`unlocated_steps`).";

const FAST_MODES: &str = "the highest modes of the mesh have ωh of 1e4 and more: their forces are small differences \
     of numbers (ωh)² times larger, with correspondingly larger rounding.";

/// The entries of [`KNOWN`] that none of these misses needs.
pub(crate) fn outlived<'a>(missed: impl Iterator<Item = (&'a Row, Demand)> + Clone) -> Vec<&'static str> {
    let needed = |name: &str, demand| missed.clone().any(|(row, of)| of == demand && row.name.starts_with(name));
    KNOWN.iter().filter(|(name, demand, _)| !needed(name, *demand)).map(|(name, ..)| *name).collect()
}

/// Why a row misses a demand; `None` for a miss that is new.
pub(crate) fn reason(row: &Row, demand: Demand) -> Option<&'static str> {
    KNOWN.iter().find(|(name, of, _)| row.name.starts_with(name) && *of == demand).map(|(_, _, why)| *why)
}
