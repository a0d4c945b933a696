//! Many bodies over time.

use super::column::Column;
use crate::page::bands::{BAND_COLUMNS, BAND_NAMES};
use crate::page::crowd::CrowdCurve;
use crate::page::panels::Panels;
use crate::page::recorder::PageRecorder;
use serde::Serialize;

/// Steps into which the range of a band or a body is divided.
const BANDS_SEEN: f64 = 1e4;

/// Many bodies over time: bands, and a few bodies one by one.
#[derive(Serialize)]
pub(super) struct CrowdData {
    names: [&'static str; BAND_COLUMNS],
    /// Of φ and ω, at the times of the curves.
    phi: Vec<Column>,
    omega: Vec<Column>,
    /// At the times of the pictures, with the bodies that turned and moved furthest.
    turns: ChosenData,
    distances: ChosenData,
}

#[derive(Serialize)]
struct ChosenData {
    bands: Vec<Column>,
    /// Numbers of blocks.
    chosen: Vec<usize>,
    values: Vec<Column>,
}

pub(super) fn crowd(recorder: &PageRecorder, panels: &Panels) -> CrowdData {
    // A picture doesn't show more.
    let short = |values: Vec<f64>| Column::of(&values, BANDS_SEEN);
    let band = |first: usize| (first..first + BAND_COLUMNS).map(|k| short(panels.curves.curve(k))).collect();
    let chosen = |curve: CrowdCurve| {
        let (chosen, values): (Vec<usize>, Vec<_>) = curve.chosen.into_iter().unzip();
        let values = values.into_iter().map(short).collect();
        ChosenData { bands: curve.bands.into_iter().map(short).collect(), chosen, values }
    };
    CrowdData {
        names: BAND_NAMES,
        phi: band(0),
        omega: band(BAND_COLUMNS),
        turns: chosen(CrowdCurve::turns(recorder)),
        distances: chosen(CrowdCurve::distances(recorder)),
    }
}
