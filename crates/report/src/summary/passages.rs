//! Crossings and peaks of the angles of blocks.

use serde::Serialize;
use teeter_integrator::{Peak, RockingMonitor};
use teeter_scenario::simulation::Layout;

/// A zero crossing of a block's angle against what carries it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CrossingRow {
    /// When, s.
    pub t: f64,
    /// The block.
    pub body: String,
}

/// A peak of a block's angle against what carries it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PeakRow {
    /// When, s.
    pub t: f64,
    /// The block.
    pub body: String,
    /// The angle, rad.
    pub phi: f64,
    /// Of a peak from the line between the block's feet on its beam: the line's slope then, rad.
    #[serde(skip)]
    pub(crate) line: Option<f64>,
}

/// Crossings and peaks of all blocks, in order of time.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Passages {
    pub(crate) crossings: Vec<CrossingRow>,
    pub(crate) peaks: Vec<PeakRow>,
}

impl Passages {
    /// Those that the monitors of the blocks have found; with each come the peak that no crossing has followed yet and the slopes of the line from which
    /// its peaks count.
    pub(super) fn of<'a>(
        layout: &Layout,
        monitors: impl Iterator<Item = (&'a RockingMonitor, Option<Peak>, Vec<Option<f64>>)>,
    ) -> Self {
        let mut all = Self::default();
        for (block, (monitor, turned, lines)) in layout.blocks.iter().zip(monitors) {
            let body = || block.name.clone();
            all.crossings.extend(monitor.crossings().iter().map(|of| CrossingRow { t: of.t, body: body() }));
            // With the one that the headline has, which no crossing has followed yet; not behind a list that is full.
            let turned = turned.filter(|_| monitor.crossings().len() as u64 == monitor.count());
            let row = |(k, of): (usize, &Peak)| PeakRow {
                t: of.t,
                body: body(),
                phi: of.phi,
                line: lines.get(k).copied().flatten(),
            };
            all.peaks.extend(monitor.peaks().iter().chain(&turned).enumerate().map(row));
        }
        all.crossings.sort_by(|a, b| a.t.total_cmp(&b.t));
        all.peaks.sort_by(|a, b| a.t.total_cmp(&b.t));
        all
    }
}
