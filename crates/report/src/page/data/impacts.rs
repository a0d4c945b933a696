//! Impacts: each, or where they are many how many about each time.

use super::{digits, time};
use crate::page::recorder::{ImpactMark, MANY_IMPACTS, PageRecorder};
use serde::Serialize;

#[derive(Serialize)]
pub(super) struct DensityData {
    end: f64,
    all: Vec<u32>,
    contacts: std::collections::BTreeMap<usize, Vec<u32>>,
}

/// Contacts whose own density is on the page.
const OWN_DENSITY: usize = 20;

pub(super) fn density(recorder: &PageRecorder) -> Option<DensityData> {
    let kept = &recorder.kept;
    (kept.impact_count > MANY_IMPACTS).then(|| DensityData {
        end: time(recorder.end),
        all: recorder.impacts_about(None).into_iter().map(|(_, count)| count).collect(),
        contacts: kept.density.iter().take(OWN_DENSITY).map(|(pair, counts)| (*pair, counts.clone())).collect(),
    })
}

#[derive(Serialize)]
pub(super) struct ImpactData {
    t: f64,
    contact: usize,
    block: usize,
    point: usize,
    impulse: [f64; 2],
}

pub(super) fn impacts(recorder: &PageRecorder) -> Vec<ImpactData> {
    let of = |i: &ImpactMark| ImpactData {
        t: time(i.t),
        contact: i.contact,
        block: i.block,
        point: i.point,
        impulse: i.impulse.map(digits),
    };
    recorder.kept.impacts.iter().map(of).collect()
}
