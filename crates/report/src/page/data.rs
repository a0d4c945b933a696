//! The data of the page: what its script draws.

mod column;
mod crowd;
mod impacts;
mod network;
mod pictures;
mod plots;

use super::opening::{Opening, opening};
use super::panels::Panels;
use super::recorder::PageRecorder;
use super::scenery::Scenery;
use super::{DIGITS, TIME_DIGITS, rounded};
use crate::Summary;
use crowd::CrowdData;
use impacts::{DensityData, ImpactData};
use network::NetworkData;
use pictures::{FrameData, LoadData};
use plots::{ForceData, PanelData, PortraitData};
use serde::Serialize;

#[derive(Serialize)]
struct Data<'a> {
    dt: f64,
    scenery: &'a Scenery,
    frames: FrameData,
    curves: CurveData,
    #[serde(skip_serializing_if = "Option::is_none")]
    crowd: Option<CrowdData>,
    #[serde(skip_serializing_if = "Option::is_none")]
    network: Option<NetworkData>,
    /// On which part of the run the plots open, if that is a small one.
    #[serde(skip_serializing_if = "Option::is_none")]
    moving: Option<Opening>,
    loads: Vec<LoadData>,
    forces: ForceData,
    impacts: Vec<ImpactData>,
    impact_count: u64,
    /// Where they are many: how many in each part of the run up to `end`, of all contacts and of each.
    #[serde(skip_serializing_if = "Option::is_none")]
    density: Option<DensityData>,
    panels: Vec<PanelData>,
    portraits: Vec<PortraitData>,
}

#[derive(Serialize)]
struct CurveData {
    /// Whether they show the extremes of many steps.
    thinned: bool,
    t: Vec<f64>,
}

/// The data as JSON that is safe inside a `script` element.
pub(crate) fn json(recorder: &PageRecorder, panels: &Panels, summary: &Summary) -> String {
    let data = Data {
        dt: summary.dt,
        scenery: &recorder.scenery,
        frames: pictures::frames(recorder),
        curves: CurveData {
            thinned: panels.curves.is_thinned(),
            t: panels.curves.times().into_iter().map(time).collect(),
        },
        crowd: recorder.scenery.is_crowded().then(|| crowd::crowd(recorder, panels)),
        network: recorder
            .scenery
            .has_network()
            .then(|| network::network(recorder))
            .filter(|network| !network.pairs.is_empty()),
        moving: opening(recorder, panels).map(|opening| Opening {
            moves: opening.moves.map(time),
            shown: opening.shown.map(time),
            ..opening
        }),
        loads: pictures::loads(recorder),
        forces: plots::forces(recorder, panels),
        impacts: impacts::impacts(recorder),
        impact_count: recorder.kept.impact_count,
        density: impacts::density(recorder),
        panels: plots::time_panels(recorder, panels),
        portraits: plots::portraits(panels),
    };
    // Strings, vectors and numbers (null where not finite) always serialise.
    serde_json::to_string(&data).unwrap_or_default().replace('<', "\\u003c")
}

fn digits(x: f64) -> f64 {
    rounded(x, DIGITS)
}

fn time(t: f64) -> f64 {
    rounded(t, TIME_DIGITS)
}
