//! Estimates, before a run, of the size of its output and of its time.

use crate::scene::{Scene, SupportingBody};

/// Most rows of a run without `output.every`: every step up to this number, evenly thinned beyond.
const ROWS: f64 = 10_000.0;

/// From so many blocks on, rows are thinned further if `output.every` is left out.
const MANY_BLOCKS: usize = 300;

/// Rows times blocks of such a run, and its least number of rows: some 100 to 300 MB of tables.
const ROWS_OF_BLOCKS: f64 = 200_000.0;
const LEAST_ROWS: f64 = 100.0;

/// The time between rows (s) of a run of many blocks for which none is given; `None` for few
/// blocks, or if every step is a row.
pub(crate) fn thinned(blocks: usize, steps: u64, step: f64) -> Option<f64> {
    let rows = (ROWS_OF_BLOCKS / blocks as f64).max(LEAST_ROWS);
    let stride = (steps as f64 / rows).ceil();
    (blocks > MANY_BLOCKS && stride > 1.0).then_some(stride * step)
}

/// Contacts of each block that act at once: 2 in a tower of boxes, 4 in a wall.
const CONTACTS_OF_BLOCK: usize = 3;

/// Those of each stone of a pile.
pub(crate) const CONTACTS_OF_STONE: f64 = 2.0;

/// Characters of a number in a table of positions and velocities, including its comma: the average over the scenarios' tables.
const BYTES_A_NUMBER: f64 = 20.0;

/// Characters of a row of `energy.csv`, and of `contacts.csv`: alike.
const BYTES_OF_ENERGY: f64 = 145.0;
const BYTES_OF_CONTACT: f64 = 180.0;

/// Size of the tables of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutputSize {
    /// Rows of `trajectory.csv` and `energy.csv`.
    pub rows: f64,
    /// Size of all tables, bytes.
    pub bytes: f64,
}

impl OutputSize {
    /// An estimate from the scene, within a factor of two, assuming that each contact pair touches
    /// with one corner in every row.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        let at_most = CONTACTS_OF_BLOCK * scene.blocks.len();
        let acting = match scene.crowd {
            // Most blocks of a crowd don't touch the ground.
            Some(_) => at_most,
            // Of pairs by patterns few touch.
            None => scene.contacts.len().min(at_most),
        };
        Self::with_contacts(scene, acting)
    }

    /// The same with so many contacts in every row, as one that was measured.
    #[must_use]
    pub fn with_contacts(scene: &Scene, acting: usize) -> Self {
        let steps = scene.time.steps() as f64;
        let rows = match scene.every {
            Some(every) => steps.min((scene.time.end / every).ceil()),
            None => (steps / (steps / ROWS).ceil()).ceil(),
        };
        let rows = rows + 1.0;
        let probes: usize = scene.beams.iter().map(|beam| beam.probes.len()).sum();
        let blocks = scene.blocks.len();
        let in_columns = 6 * scene.block_tables.columns(blocks).count();
        // Each has its time and the name of its block, too.
        let in_rows = if scene.block_tables.has_rows() { 7 * blocks } else { 0 };
        let numbers = 1 + in_columns + in_rows + 2 * scene.beams.len() + probes;
        let row = BYTES_A_NUMBER * numbers as f64 + BYTES_OF_ENERGY + BYTES_OF_CONTACT * acting as f64;
        Self { rows, bytes: rows * row }
    }
}

/// Time of a step by the contents of the scene, measured in release builds on one core of a server
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
    /// A pair of contacts of one dense operator, coupled or not, µs: its block is cleared, and
    /// examined for islands and coupling (3000 blocks on the ground, 36e6 pairs: 0.7 s per step,
    /// when they were one problem).
    pub(super) const PAIR_OF_CONTACTS: f64 = 0.02;
}

/// Usual number of simultaneously closed contacts: a block rests on two corners.
#[must_use]
pub fn usual_contacts(scene: &Scene) -> usize {
    match scene.crowd {
        Some(_) => CONTACTS_OF_BLOCK * scene.blocks.len(),
        None => 2 * scene.contacts.len(),
    }
}

/// Estimated memory of a run of a crowd, bytes: measured are 41 MB for 1000 blocks in a tower or in
/// a pile, 68 MB for a shaken wall of 500, 100 to 130 MB for 5000. `None` without a crowd.
#[must_use]
pub fn expected_memory(scene: &Scene) -> Option<f64> {
    scene.crowd.as_ref().map(|_| 20e6 + 22e3 * scene.blocks.len() as f64)
}

/// Time of a step in which so many blocks lie on each other and move, s, to an order of magnitude.
/// Nearly all of it is the solver's, whose iterations grow with the height of what lies on each other, here as high as wide:
/// measured are 28 ms on average while 1000 stones fall into a pile, 1.4 ms of 100, and 17 ms in a wall of 500.
fn step_of_pile(blocks: usize) -> f64 {
    1e-6 * (blocks as f64).powf(1.5)
}

/// Largest size of the dense operator of all contacts, bytes: some 11 000 contacts.
pub const MOST_OPERATOR_BYTES: f64 = 4e9;

/// Bytes of the dense operator of this number of plane contacts: four numbers for each pair.
#[must_use]
pub fn operator_bytes(contacts: usize) -> f64 {
    32.0 * (contacts as f64) * (contacts as f64)
}

/// Up to this many contacts the time of a step is known to a factor of three; with more it depends
/// on their coupling and on the solver, and only its order of magnitude is known.
const FEW_CONTACTS: usize = 8;

/// Whether the scene has so many contacts that [`expected_seconds`] is only an order of magnitude.
#[must_use]
pub fn has_many_contacts(scene: &Scene) -> bool {
    usual_contacts(scene) > FEW_CONTACTS
}

/// Estimated time of writing the tables of a run with so many contacts in every row, s.
#[must_use]
pub fn writing_seconds(scene: &Scene, contacts: usize) -> f64 {
    1e-6 * cost::NUMBER * OutputSize::with_contacts(scene, contacts).bytes / BYTES_A_NUMBER
}

/// The accuracy of [`expected_seconds`], in words.
#[must_use]
pub fn accuracy_of_seconds(scene: &Scene) -> &'static str {
    if has_many_contacts(scene) {
        "to an order of magnitude, because of the many contacts"
    } else {
        "to a factor of three"
    }
}

/// Estimated time of a run of `scene`, s, within a factor of two or three on today's machines if
/// few contacts are closed at once; `beam_dofs` are those of all beams together.
#[must_use]
pub fn expected_seconds(scene: &Scene, beam_dofs: usize) -> f64 {
    let of_crowd = scene.crowd.as_ref().map_or(0.0, |_| step_of_pile(scene.blocks.len()));
    let bodies = scene.contacts.len().max(scene.blocks.len()) as f64;
    let few = scene.contacts.len() <= 1;
    let on_beams = scene.contacts.iter().filter(|contact| matches!(contact.surface, SupportingBody::Beam(_))).count();
    // The contacts of separate blocks on the ground are solved island by island.
    let contacts = 2.0 * on_beams as f64;
    // A block's two contacts use stored columns of W; those of many blocks need a substitution each
    // in every step.
    let substitutions = if few { 0.0 } else { 2.0 * on_beams as f64 / scene.beams.len().max(1) as f64 };
    let step = cost::PAIR * bodies
        + cost::BEAM * scene.beams.len() as f64
        + cost::DOF * beam_dofs as f64 * (1.0 + substitutions)
        + if few { 0.0 } else { cost::PAIR_OF_CONTACTS * contacts * contacts };
    let writing = cost::NUMBER * OutputSize::of(scene).bytes / BYTES_A_NUMBER;
    (step * scene.time.steps() as f64 + writing) * 1e-6 + of_crowd * scene.time.steps() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(edit: &[(&str, &str)]) -> f64 {
        let text = "[time]\nend = '1 s'\nstep = '1 ms'\n[ground]\n[material.m]\ndensity = '1 kg/m^3'\n\
                    [block.b]\nmaterial = 'm'\nwidth = '1 m'\nheight = '1 m'\ndepth = '1 m'\nposition = ['0 m', '1 m']\n";
        let sets: Vec<_> = edit.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
        OutputSize::of(&crate::load(text.as_bytes(), "f", "f", &sets).unwrap().scene).rows
    }

    #[test]
    fn rows_are_those_that_the_recorder_writes() {
        assert_eq!(rows(&[]), 1001.0);
        assert_eq!(rows(&[("output.every", "10 ms")]), 101.0);
        assert_eq!(rows(&[("output.every", "1 us")]), 1001.0);
        assert_eq!(rows(&[("time.step", "99 us")]), 5052.0, "10 102 steps, every second one");
    }
}
