//! The pictures: where everything is at the times of the slider, with the loads.

use super::column::{Column, SEEN};
use super::time;
use crate::page::packed::Packed;
use crate::page::recorder::{BEAM_MOVED, BLOCK_FRAME, PageRecorder};
use crate::page::{DIGITS, rounded};
use serde::Serialize;
use teeter_scenario::scene::{History, LoadKind};

/// The pictures: `blocks[k].x[i]` at `t[i]`, of many blocks packed; `beams[k].w` packed, picture by picture in units of `beams[k].unit`. How far beams have moved as a
/// whole, and the ground, where they do.
#[derive(Serialize)]
pub(super) struct FrameData {
    t: Vec<f64>,
    blocks: Vec<BlockFrames>,
    #[serde(skip_serializing_if = "Option::is_none")]
    packed: Option<PackedFrames>,
    beams: Vec<BeamFrames>,
    ground: Option<GroundFrames>,
}

/// Poses of many blocks, block by block: x in all pictures, then y, then φ, each as differences from the picture
/// before, in these units.
#[derive(Serialize)]
struct PackedFrames {
    length: f64,
    angle: f64,
    blocks: Vec<String>,
}

/// A force on a block or a beam at the times of the pictures: N and N·m, and where.
#[derive(Serialize)]
pub(super) struct LoadData {
    name: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    block: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    beam: Option<usize>,
    /// Force along x and y at full size, N; the couple, N·m.
    force: [f64; 2],
    couple: f64,
    /// Places along the beam where it begins and ends, m, and how fast they move, m/s.
    span: [f64; 2],
    speed: f64,
    /// By what force and couple are multiplied.
    factor: Column,
}

#[derive(Serialize)]
struct GroundFrames {
    x: Column,
    y: Column,
    slope: Column,
}

#[derive(Serialize)]
struct BlockFrames {
    x: Column,
    y: Column,
    phi: Column,
}

#[derive(Serialize)]
struct BeamFrames {
    unit: f64,
    /// Second differences along the span, which are small, as those before its left end were 0.
    w: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    moved: Option<[Column; 2]>,
}

/// A deflection is sent in this part of the span: finer than a picture shows, with few digits.
const BEAM_UNIT: f64 = 1e-7;

pub(super) fn frames(recorder: &PageRecorder) -> FrameData {
    let scenery = &recorder.scenery;
    let column = |k: usize| {
        let values: Vec<f64> = recorder.kept.frames.rows().map(|(_, row)| row[k]).collect();
        Column::of_pose(&values)
    };
    let blocks = (0..scenery.blocks.len()).map(|k| BLOCK_FRAME * k);
    let mut start = BLOCK_FRAME * scenery.blocks.len();
    let mut moved = start + scenery.beams.iter().map(|beam| beam.points).sum::<usize>();
    let beams = scenery.beams.iter().zip(&recorder.layout.beams).map(|(beam, place)| {
        let unit = rounded(BEAM_UNIT * beam.span, DIGITS);
        let points = start..start + beam.points;
        start = points.end;
        let mut packed = Packed::default();
        for (_, row) in recorder.kept.frames.rows() {
            let mut before = [0, 0];
            for w in &row[points.clone()] {
                let now = whole(w / unit);
                packed.push_signed(now - 2 * before[1] + before[0]);
                before = [before[1], now];
            }
        }
        let own = beam.moves(place).then(|| {
            moved += BEAM_MOVED;
            [column(moved - 2), column(moved - 1)]
        });
        BeamFrames { unit, w: packed.text(), moved: own }
    });
    let beams: Vec<BeamFrames> = beams.collect();
    let ground = recorder.layout.ground.as_ref().map(|_| GroundFrames {
        x: column(moved),
        y: column(moved + 1),
        slope: column(moved + 2),
    });
    let packed = scenery.is_crowded().then(|| packed(recorder));
    let blocks = blocks.filter(|_| packed.is_none());
    FrameData {
        t: recorder.kept.frames.rows().map(|(t, _)| time(t)).collect(),
        blocks: blocks.map(|k| BlockFrames { x: column(k), y: column(k + 1), phi: column(k + 2) }).collect(),
        packed,
        beams,
        ground,
    }
}

/// Lengths are sent in this part of the scene's size, angles in this part of a radian: finer than a picture shows.
const LENGTH_UNIT: f64 = 2e-5;
const ANGLE_UNIT: f64 = 1e-3;

/// The nearest whole number: far away the largest that differences can be taken of; what isn't finite becomes 0.
fn whole(x: f64) -> i64 {
    x.round().clamp(-1e15, 1e15) as i64
}

fn packed(recorder: &PageRecorder) -> PackedFrames {
    let blocks = recorder.scenery.blocks.len();
    // Where the bodies began: one that flies off doesn't make all others coarse.
    let first = recorder.kept.frames.rows().next().map_or(&[][..], |(_, row)| row);
    let extent = |k: usize| {
        let places = first.chunks_exact(BLOCK_FRAME).take(blocks).map(|pose| pose[k]).filter(|x| x.is_finite());
        let (low, high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
        high - low
    };
    let reach = recorder.scenery.blocks.iter().fold(0.0, |most: f64, block| most.max(block.reach));
    let length = rounded(LENGTH_UNIT * (extent(0).max(extent(1)) + 2.0 * reach), 3);
    let of_block = |block: usize| {
        let mut packed = Packed::default();
        for (k, unit) in [(0, length), (1, length), (2, ANGLE_UNIT)] {
            let mut before = 0;
            for (_, row) in recorder.kept.frames.rows() {
                let now = whole(row[BLOCK_FRAME * block + k] / unit);
                packed.push_signed(now - before);
                before = now;
            }
        }
        packed.text()
    };
    PackedFrames { length, angle: ANGLE_UNIT, blocks: (0..blocks).map(of_block).collect() }
}

pub(super) fn loads(recorder: &PageRecorder) -> Vec<LoadData> {
    let factor = |history: &History| {
        let signal = history.signal();
        Column::of(&recorder.kept.frames.rows().map(|(t, _)| signal.value(t)).collect::<Vec<_>>(), SEEN)
    };
    let on_blocks = recorder.scenery.forces.iter().map(|force| LoadData {
        name: force.name.clone(),
        block: Some(force.block),
        beam: None,
        force: force.force,
        couple: force.couple,
        span: [0.0; 2],
        speed: 0.0,
        factor: factor(&force.history),
    });
    let on_beams = recorder.scenery.loads.iter().map(|load| {
        let (up, couple, span, speed) = match load.kind {
            LoadKind::Point { at, force, couple } => (force, couple, [at; 2], 0.0),
            LoadKind::Distributed { load, from, to } => (load * (to - from), 0.0, [from, to], 0.0),
            LoadKind::Moving { force, at, speed } => (force, 0.0, [at; 2], speed),
        };
        LoadData {
            name: load.name.clone(),
            block: None,
            beam: Some(load.beam),
            force: [0.0, up],
            couple,
            span,
            speed,
            factor: factor(&load.history),
        }
    });
    on_blocks.chain(on_beams).collect()
}
