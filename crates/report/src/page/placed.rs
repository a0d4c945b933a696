//! What is drawn of the bodies where they are in a picture: outlines of blocks and beams, the surface of the ground.

use super::outline::Outline;
use super::recorder::{BEAM_MOVED, BLOCK_FRAME, PageRecorder};

/// Points in a row, m.
pub(super) type Points = Vec<(f64, f64)>;

/// The poses of the blocks in a row of [`Frames`](super::frames::Frames).
pub(super) fn poses(recorder: &PageRecorder, row: &[f64]) -> impl Iterator<Item = [f64; BLOCK_FRAME]> {
    row.chunks_exact(BLOCK_FRAME).take(recorder.scenery.blocks.len()).map(|pose| [pose[0], pose[1], pose[2]])
}

/// The closed lines around each block.
pub(super) fn blocks(recorder: &PageRecorder, row: &[f64]) -> Vec<Vec<Points>> {
    let blocks = recorder.scenery.blocks.iter().zip(poses(recorder, row));
    blocks.map(|(block, pose)| Outline::of(block, pose).lines()).collect()
}

/// The closed line around each beam. As in the moving picture, the line that is touched, the axis or the top fibre, is its upper
/// edge: the first half of the points, from the left on.
pub(super) fn beams(recorder: &PageRecorder, row: &[f64]) -> Vec<Points> {
    let scenery = &recorder.scenery;
    let mut first = BLOCK_FRAME * scenery.blocks.len();
    let mut moved_at = first + scenery.beams.iter().map(|beam| beam.points).sum::<usize>();
    let mut beams = Vec::with_capacity(scenery.beams.len());
    for (beam, place) in scenery.beams.iter().zip(&recorder.layout.beams) {
        let shift = if beam.moves(place) {
            moved_at += BEAM_MOVED;
            [row[moved_at - 2], row[moved_at - 1]]
        } else {
            [0.0; 2]
        };
        let w = &row[first..first + beam.points];
        first += beam.points;
        let x = |k: usize| beam.x + shift[0] + beam.span * k as f64 / (beam.points - 1) as f64;
        let top = if beam.top { 0.5 * beam.thickness } else { 0.0 };
        let y = |k: usize| beam.y + shift[1] + w[k] + top;
        let above = (0..beam.points).map(|k| (x(k), y(k)));
        let below = (0..beam.points).rev().map(|k| (x(k), y(k) - beam.thickness));
        beams.push(above.chain(below).collect());
    }
    beams
}

/// The surface of the ground from one x of the world to another, about; none in a scene without ground.
pub(super) fn ground(recorder: &PageRecorder, row: &[f64], from: f64, to: f64) -> Option<Points> {
    let scenery = &recorder.scenery;
    if !scenery.ground {
        return None;
    }
    let [x, y, slope] = recorder.layout.ground.as_ref().map_or([0.0, 0.0, scenery.incline], |range| {
        let start = row.len() - range.len();
        [row[start], row[start + 1], row[start + 2]]
    });
    let (sin, cos) = slope.sin_cos();
    // Along the surface, in its own coordinates.
    let own = |at: f64| (at - x) / cos.abs().max(1e-3);
    let (left, right) = (own(from), own(to));
    let profile = &scenery.profile;
    let height = |at: f64| match profile.iter().position(|point| point[0] > at) {
        None => profile.last().map_or(0.0, |point| point[1]),
        Some(0) => profile[0][1],
        Some(next) => {
            let ([x0, y0], [x1, y1]) = (profile[next - 1], profile[next]);
            y0 + (at - x0) / (x1 - x0) * (y1 - y0)
        }
    };
    let within = profile.iter().copied().filter(|point| point[0] > left && point[0] < right);
    let surface = std::iter::once([left, height(left)]).chain(within).chain([[right, height(right)]]);
    Some(surface.map(|[a, b]| (x + cos * a - sin * b, y + sin * a + cos * b)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;
    use teeter_integrator::Ended;
    use teeter_scenario::simulation::Simulation;

    /// Columns of blocks take a beam along that nothing else holds: it is drawn where it lies on them, elements or modes.
    #[test]
    fn a_beam_is_drawn_where_its_axial_motion_has_brought_it() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../.ci/scenes/beam-taken-along.toml");
        let text = std::fs::read_to_string(file).unwrap();
        for modes in [vec![], vec![("beam.lintel.model", "modes"), ("beam.lintel.modes.count", "12")]] {
            let sets: Vec<_> = modes.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
            // The damping of its elements couples modes.
            let text = if sets.is_empty() {
                text.clone()
            } else {
                text.replace("damping_ratio = { mode = 3, ratio = 0.2 }\n", "")
            };
            let resolved = teeter_scenario::load(text.as_bytes(), "beam.toml", "beam", &sets).unwrap();
            let mut simulation = Simulation::new(&resolved.scene).unwrap();
            let mut recorder = PageRecorder::new(&resolved.scene, &simulation.layout);
            assert_eq!(simulation.run(&mut [&mut recorder]).unwrap(), Ended::Complete);
            let rows: Vec<_> = recorder.kept.frames.rows().collect();
            let [first, last] = [rows[0].1, rows[rows.len() - 1].1];
            let column = |row: &[f64]| row[0] - first[0];
            let ends = |row: &[f64]| {
                let outline = &beams(&recorder, row)[0];
                [outline[0].0, outline[outline.len() / 2 - 1].0]
            };
            assert!(column(last) > 0.4, "the columns move by {} m", column(last));
            let [left, right] = ends(last);
            // Friction of 0.8 holds it on columns that start at less than 0.5 g.
            assert!(
                (left - column(last)).abs() < 1e-3 && (right - left - 1.0).abs() < 1e-9,
                "{left} {right} {modes:?}"
            );
            assert_eq!(ends(first), [0.0, 1.0]);
        }
    }
}
