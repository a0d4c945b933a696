//! Many bodies over time: how far they are from where they began, and the few that are drawn one by one.

use super::bands::{BAND_COLUMNS, Bands};
use super::recorder::{BLOCK_FRAME, PageRecorder};

/// A quantity of many bodies at the times of the pictures.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct CrowdCurve {
    /// Bands, each over time.
    pub(crate) bands: Vec<Vec<f64>>,
    /// The bodies in which it becomes largest, by their numbers, largest first, each over time.
    pub(crate) chosen: Vec<(usize, Vec<f64>)>,
}

/// Bodies that are drawn one by one.
const CHOSEN: usize = 3;

impl CrowdCurve {
    /// Of each body the value in a picture, with the one at the start.
    fn of(recorder: &PageRecorder, value: impl Fn(&[f64], &[f64]) -> f64) -> Self {
        let blocks = recorder.scenery.blocks.len();
        let pose = |row: &[f64], k: usize| [0, 1, 2].map(|i| row[BLOCK_FRAME * k + i]);
        let rows: Vec<&[f64]> = recorder.kept.frames.rows().map(|(_, row)| row).collect();
        let first = rows.first().copied().unwrap_or_default();
        let values =
            |k: usize| rows.iter().map(move |row| (k, row)).map(|(k, row)| value(&pose(first, k), &pose(row, k)));
        let mut largest: Vec<(usize, f64)> =
            (0..blocks).map(|k| (k, values(k).fold(0.0, |most: f64, x| most.max(x.abs())))).collect();
        largest.sort_by(|a, b| b.1.total_cmp(&a.1));
        let (mut sorter, mut bands) = (Bands::default(), vec![Vec::new(); BAND_COLUMNS]);
        for row in &rows {
            let mut of_picture = [0.0; BAND_COLUMNS];
            sorter.fill((0..blocks).map(|k| value(&pose(first, k), &pose(row, k))), &mut of_picture);
            bands.iter_mut().zip(of_picture).for_each(|(band, x)| band.push(x));
        }
        let chosen = largest.iter().take(CHOSEN).map(|&(k, _)| (k, values(k).collect())).collect();
        Self { bands, chosen }
    }

    /// How far the bodies' mass centres are from where they were at the start, m.
    pub(crate) fn distances(recorder: &PageRecorder) -> Self {
        Self::of(recorder, |first, now| (now[0] - first[0]).hypot(now[1] - first[1]))
    }

    /// How far they have turned since the start, rad.
    pub(crate) fn turns(recorder: &PageRecorder) -> Self {
        Self::of(recorder, |first, now| now[2] - first[2])
    }
}
