//! How much a run writes and how long it takes: estimates, before anything is run.

use crate::scene::{Scene, Support};

/// Rows of a run without `output.every`: every step up to here, thinned evenly past that.
const ROWS: f64 = 10_000.0;

/// Characters of a number in a table, its comma included: what the scenarios' tables come to on the
/// average.
const BYTES_A_NUMBER: f64 = 16.0;

/// What the tables of a run will hold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Volume {
    /// Rows of `trajectory.csv` and `energy.csv`.
    pub rows: f64,
    /// Size of all tables, bytes.
    pub bytes: f64,
}

impl Volume {
    /// An estimate from the scene, within a factor of two: each contact pair touches with one
    /// corner in every row.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        let steps = scene.time.steps() as f64;
        let rows = match scene.every {
            Some(every) => steps.min((scene.time.end / every).ceil()),
            None => (steps / (steps / ROWS).ceil()).ceil(),
        };
        let rows = rows + 1.0;
        let probes: usize = scene.beams.iter().map(|beam| beam.probes.len()).sum();
        let trajectory = 1 + 6 * scene.blocks.len() + 2 * scene.beams.len() + probes;
        let (energy, contacts) = (11, 11 * scene.contacts.len());
        Self { rows, bytes: rows * (trajectory + energy + contacts) as f64 * BYTES_A_NUMBER }
    }
}

/// Time of a step by what the scene has, measured in release builds on one core of a server
/// (`benches/results`: 0.60 µs on rigid ground; 1.70, 2.28 and 3.54 µs on beams of 20, 40 and 80
/// dofs).
mod cost {
    /// A block in contact, µs.
    pub(super) const PAIR: f64 = 0.6;
    /// A beam, µs.
    pub(super) const BEAM: f64 = 0.5;
    /// A degree of freedom of a beam, µs.
    pub(super) const DOF: f64 = 0.031;
    /// A number written, µs.
    pub(super) const NUMBER: f64 = 0.1;
    /// A pair of contacts of one dense operator, whether they feel each other or not, µs: its place
    /// is cleared, looked at for islands, and looked at for coupling (3000 blocks on the ground,
    /// 36e6 of them: 0.7 s a step, when they were one).
    pub(super) const PAIR_OF_CONTACTS: f64 = 0.02;
}

/// Contacts that can be closed at once as a rule: a block rests on two corners.
#[must_use]
pub fn usual_contacts(scene: &Scene) -> usize {
    2 * scene.contacts.len()
}

/// Most bytes that the dense operator of all contacts may take: some 11 000 contacts.
pub const MOST_OPERATOR_BYTES: f64 = 4e9;

/// Bytes of the dense operator of so many contacts in the plane: four numbers for each two of them.
#[must_use]
pub fn operator_bytes(contacts: usize) -> f64 {
    32.0 * (contacts as f64) * (contacts as f64)
}

/// Up to so many contacts the time of a step is known to a factor of three; of more, how many of
/// them feel each other and how their solver fares decides, and an order of magnitude is all that
/// is known.
const FEW_CONTACTS: usize = 8;

/// The factor to which [`expected_seconds`] is good, in words.
#[must_use]
pub fn accuracy_of_seconds(scene: &Scene) -> &'static str {
    if usual_contacts(scene) > FEW_CONTACTS {
        "to an order of magnitude, for so many contacts"
    } else {
        "to a factor of three"
    }
}

/// Time that a run of `scene` takes, s: a rule of thumb, good to a factor of two or three on
/// today's machines while few contacts close at once; `beam_dofs` are those of all beams together.
#[must_use]
pub fn expected_seconds(scene: &Scene, beam_dofs: usize) -> f64 {
    let bodies = scene.contacts.len().max(scene.blocks.len()) as f64;
    let few = scene.contacts.len() <= 1;
    let on_beams = scene.contacts.iter().filter(|contact| matches!(contact.surface, Support::Beam(_))).count();
    // The contacts of blocks that stand apart on the ground are solved island by island.
    let contacts = 2.0 * on_beams as f64;
    // A block's two contacts use columns of W that are there; those of many are solved for in each
    // step, a substitution each.
    let substitutions = if few { 0.0 } else { 2.0 * on_beams as f64 / scene.beams.len().max(1) as f64 };
    let step = cost::PAIR * bodies
        + cost::BEAM * scene.beams.len() as f64
        + cost::DOF * beam_dofs as f64 * (1.0 + substitutions)
        + if few { 0.0 } else { cost::PAIR_OF_CONTACTS * contacts * contacts };
    let writing = cost::NUMBER * Volume::of(scene).bytes / BYTES_A_NUMBER;
    (step * scene.time.steps() as f64 + writing) * 1e-6
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(edit: &[(&str, &str)]) -> f64 {
        let text = "[time]\nend = '1 s'\nstep = '1 ms'\n[ground]\n[material.m]\ndensity = '1 kg/m^3'\n\
                    [block.b]\nmaterial = 'm'\nwidth = '1 m'\nheight = '1 m'\ndepth = '1 m'\nposition = ['0 m', '1 m']\n";
        let sets: Vec<_> = edit.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
        Volume::of(&crate::load(text.as_bytes(), "f", "f", &sets).unwrap().scene).rows
    }

    #[test]
    fn rows_are_those_that_the_recorder_writes() {
        assert_eq!(rows(&[]), 1001.0);
        assert_eq!(rows(&[("output.every", "10 ms")]), 101.0);
        assert_eq!(rows(&[("output.every", "1 us")]), 1001.0);
        assert_eq!(rows(&[("time.step", "99 us")]), 5052.0, "10 102 steps, every second one");
    }
}
