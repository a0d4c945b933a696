//! The data of the page: what its script draws.

use super::recorder::{BLOCK_COLUMNS, BLOCK_FRAME, ENERGIES, MANY_IMPACTS, PageRecorder};
use super::scenery::Scenery;
use super::{DIGITS, TIME_DIGITS, rounded};
use crate::Summary;
use crate::sections::Kind;
use serde::Serialize;
use teeter_integrator::ContactState;

#[derive(Serialize)]
struct Data<'a> {
    dt: f64,
    scenery: &'a Scenery,
    frames: FrameData,
    curves: CurveData,
    forces: ForceData,
    impacts: Vec<ImpactData>,
    impact_count: u64,
    /// Where they are many: how many in each part of the run up to `end`, of all contacts and of each.
    #[serde(skip_serializing_if = "Option::is_none")]
    density: Option<DensityData>,
    sections: Vec<SectionData>,
}

#[derive(Serialize)]
struct DensityData {
    end: f64,
    all: Vec<u32>,
    contacts: std::collections::BTreeMap<usize, Vec<u32>>,
}

/// Contacts whose own density is on the page.
const OWN_DENSITY: usize = 20;

fn density(recorder: &PageRecorder) -> Option<DensityData> {
    let kept = &recorder.kept;
    (kept.impact_count > MANY_IMPACTS).then(|| DensityData {
        end: time(recorder.end),
        all: recorder.impacts_about(None).into_iter().map(|(_, count)| count).collect(),
        contacts: kept.density.iter().take(OWN_DENSITY).map(|(pair, counts)| (*pair, counts.clone())).collect(),
    })
}

/// What a beam bears over time, at the times of the curves.
#[derive(Serialize)]
struct SectionData {
    kind: Kind,
    label: String,
    values: Vec<f64>,
}

/// The pictures: `blocks[k].x[i]` at `t[i]`; `beams[k].w` row by row in units of `beams[k].unit`. Displacements of supports
/// and ground where they move.
#[derive(Serialize)]
struct FrameData {
    t: Vec<f64>,
    blocks: Vec<BlockFrames>,
    beams: Vec<BeamFrames>,
    ground: Option<GroundFrames>,
}

#[derive(Serialize)]
struct GroundFrames {
    x: Vec<f64>,
    y: Vec<f64>,
    slope: Vec<f64>,
}

#[derive(Serialize)]
struct BlockFrames {
    x: Vec<f64>,
    y: Vec<f64>,
    phi: Vec<f64>,
}

#[derive(Serialize)]
struct BeamFrames {
    unit: f64,
    w: Vec<i64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    supports: Option<[Vec<f64>; 2]>,
}

#[derive(Serialize)]
struct CurveData {
    t: Vec<f64>,
    blocks: Vec<BlockCurves>,
    w_mid: Vec<Vec<f64>>,
    energies: Vec<EnergyCurve>,
}

#[derive(Serialize)]
struct BlockCurves {
    phi: Vec<f64>,
    omega: Vec<f64>,
}

#[derive(Serialize)]
struct EnergyCurve {
    name: &'static str,
    values: Vec<f64>,
}

/// Means between the times `borders`.
#[derive(Serialize)]
struct ForceData {
    borders: Vec<f64>,
    points: Vec<PointForces>,
}

#[derive(Serialize)]
struct PointForces {
    contact: usize,
    point: usize,
    normal: Vec<f64>,
    tangential: Vec<f64>,
    /// A letter a value: `o` open, `k` stick, `l` slip.
    state: String,
}

#[derive(Serialize)]
struct ImpactData {
    t: f64,
    contact: usize,
    block: usize,
    point: usize,
    impulse: [f64; 2],
}

/// A deflection is sent in this part of the span: finer than a picture shows, with few digits.
const BEAM_UNIT: f64 = 1e-7;

/// The data as JSON that is safe inside a `script` element.
pub(crate) fn json(recorder: &PageRecorder, summary: &Summary) -> String {
    let data = Data {
        dt: summary.dt,
        scenery: &recorder.scenery,
        frames: frames(recorder),
        curves: curves(recorder),
        forces: forces(recorder),
        impacts: recorder
            .kept
            .impacts
            .iter()
            .map(|i| ImpactData {
                t: time(i.t),
                contact: i.contact,
                block: i.block,
                point: i.point,
                impulse: i.impulse.map(digits),
            })
            .collect(),
        impact_count: recorder.kept.impact_count,
        density: density(recorder),
        sections: sections(recorder),
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

fn frames(recorder: &PageRecorder) -> FrameData {
    let scenery = &recorder.scenery;
    let column = |k: usize| recorder.kept.frames.rows().map(|(_, row)| digits(row[k])).collect();
    let blocks = (0..scenery.blocks.len()).map(|k| BLOCK_FRAME * k);
    let mut start = BLOCK_FRAME * scenery.blocks.len();
    let mut moved = start + scenery.beams.iter().map(|beam| beam.points).sum::<usize>();
    let beams = scenery.beams.iter().zip(&recorder.layout.beams).map(|(beam, place)| {
        let unit = rounded(BEAM_UNIT * beam.span, DIGITS);
        let points = start..start + beam.points;
        start = points.end;
        let w = |row: &[f64]| row[points.clone()].iter().map(|w| (w / unit).round() as i64).collect::<Vec<_>>();
        let supports = place.supports.as_ref().map(|range| {
            let first = moved;
            moved += range.len();
            [column(first), column(first + 1)]
        });
        BeamFrames { unit, w: recorder.kept.frames.rows().flat_map(|(_, row)| w(row)).collect(), supports }
    });
    let beams: Vec<BeamFrames> = beams.collect();
    let ground = recorder.layout.ground.as_ref().map(|_| GroundFrames {
        x: column(moved),
        y: column(moved + 1),
        slope: column(moved + 2),
    });
    FrameData {
        t: recorder.kept.frames.rows().map(|(t, _)| time(t)).collect(),
        blocks: blocks.map(|k| BlockFrames { x: column(k), y: column(k + 1), phi: column(k + 2) }).collect(),
        beams,
        ground,
    }
}

fn curves(recorder: &PageRecorder) -> CurveData {
    let (blocks, beams) = (recorder.scenery.blocks.len(), recorder.scenery.beams.len());
    let column = |k: usize| recorder.kept.curves.curve(k).into_iter().map(digits).collect::<Vec<_>>();
    let beam = BLOCK_COLUMNS * blocks;
    CurveData {
        t: recorder.kept.curves.times().into_iter().map(time).collect(),
        blocks: (0..blocks)
            .map(|k| BlockCurves { phi: column(BLOCK_COLUMNS * k), omega: column(BLOCK_COLUMNS * k + 1) })
            .collect(),
        w_mid: (beam..beam + beams).map(column).collect(),
        energies: ENERGIES
            .iter()
            .enumerate()
            .map(|(k, name)| EnergyCurve { name, values: column(beam + beams + k) })
            .collect(),
    }
}

fn sections(recorder: &PageRecorder) -> Vec<SectionData> {
    let curves = recorder.sections.iter().zip(recorder.first_section()..).map(|(column, k)| SectionData {
        kind: column.kind,
        label: recorder.section_label(column),
        values: recorder.kept.curves.curve(k).into_iter().map(digits).collect(),
    });
    // Of a recorder on its own, which has seen no section forces, there is nothing to draw.
    curves.filter(|curve| curve.values.iter().any(|value| value.is_finite())).collect()
}

fn forces(recorder: &PageRecorder) -> ForceData {
    let contacts = recorder.scenery.contacts.iter().enumerate();
    let all = contacts.flat_map(|(contact, drawn)| (0..drawn.points.len()).map(move |point| (contact, drawn, point)));
    let points = all.filter_map(|(contact, drawn, point)| {
        let forces = recorder.kept.curves.forces(drawn.first + point)?;
        let state = forces.state.iter().map(|state| match state {
            ContactState::Open => 'o',
            ContactState::Stick => 'k',
            ContactState::Slip => 'l',
        });
        Some(PointForces {
            contact,
            point,
            normal: forces.normal.into_iter().map(digits).collect(),
            tangential: forces.tangential.into_iter().map(digits).collect(),
            state: state.collect(),
        })
    });
    ForceData { borders: recorder.kept.curves.borders().into_iter().map(time).collect(), points: points.collect() }
}
