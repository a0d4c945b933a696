//! How much a run writes and how long it takes: estimates, before anything is run.

use crate::scene::Scene;

/// Rows of a run without `output.every`: every step up to here, thinned evenly past that.
const ROWS: f64 = 10_000.0;

/// Characters of a number in a table, its comma included: what the scenarios' tables come to on the average.
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
    /// An estimate from the scene, within a factor of two: each contact pair touches with one corner in every row.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        let steps = scene.time.steps as f64;
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

/// Time of a step by what the scene has, measured in release builds on one core of a server (`benches/results`: 0.60 µs on
/// rigid ground; 1.70, 2.28 and 3.54 µs on beams of 20, 40 and 80 dofs).
mod cost {
    /// A block in contact, µs.
    pub(super) const PAIR: f64 = 0.6;
    /// A beam, µs.
    pub(super) const BEAM: f64 = 0.5;
    /// A degree of freedom of a beam, µs.
    pub(super) const DOF: f64 = 0.031;
    /// A number written, µs.
    pub(super) const NUMBER: f64 = 0.1;
}

/// Time that a run of `scene` takes, s: a rule of thumb, good to a factor of two or three on today's machines while few
/// contacts close at once; `beam_dofs` are those of all beams together.
#[must_use]
pub fn expected_seconds(scene: &Scene, beam_dofs: usize) -> f64 {
    let bodies = scene.contacts.len().max(scene.blocks.len()) as f64;
    let step = cost::PAIR * bodies + cost::BEAM * scene.beams.len() as f64 + cost::DOF * beam_dofs as f64;
    let writing = cost::NUMBER * Volume::of(scene).bytes / BYTES_A_NUMBER;
    (step * scene.time.steps as f64 + writing) * 1e-6
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
