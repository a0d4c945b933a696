//! Many bodies over time.

use crate::page::bands::{BAND_COLUMNS, BAND_NAMES};
use crate::page::crowd::CrowdCurve;
use crate::page::panels::Panels;
use crate::page::recorder::PageRecorder;
use crate::page::rounded;
use serde::Serialize;

/// Many bodies over time: bands, and a few bodies one by one.
#[derive(Serialize)]
pub(super) struct CrowdData {
    names: [&'static str; BAND_COLUMNS],
    /// Of φ and φ̇, at the times of the curves.
    phi: Vec<Vec<f64>>,
    omega: Vec<Vec<f64>>,
    /// At the times of the pictures, with the bodies that turned and moved furthest.
    turns: ChosenData,
    distances: ChosenData,
}

#[derive(Serialize)]
struct ChosenData {
    bands: Vec<Vec<f64>>,
    /// Numbers of blocks.
    chosen: Vec<usize>,
    values: Vec<Vec<f64>>,
}

pub(super) fn crowd(recorder: &PageRecorder, panels: &Panels) -> CrowdData {
    // A picture doesn't show more.
    let short = |values: Vec<f64>| values.into_iter().map(|x| rounded(x, 4)).collect::<Vec<f64>>();
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
