//! The part of the plane that an animation shows: everything at all times.

use super::super::placed;
use super::super::recorder::PageRecorder;

/// Sizes in px of an animation this wide; in another they change with its width.
const NOMINAL: f64 = 720.0;

const MARGIN: f64 = 24.0;

/// Height of the row of text at the bottom.
const CAPTION: f64 = 34.0;

/// Height of an animation as a part of its width.
const HEIGHTS: [f64; 2] = [0.25, 0.9];

/// What an animation shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct View {
    /// px.
    pub(super) width: u32,
    pub(super) height: u32,
    /// Pixels a metre.
    pub(super) scale: f64,
    /// The place at the middle of the lower edge above the caption, m.
    middle: f64,
    bottom: f64,
    /// Size of one nominal pixel.
    pub(super) unit: f64,
}

impl View {
    /// None if nothing is at a finite place.
    pub(super) fn new(recorder: &PageRecorder, rows: &[(f64, &[f64])], width: u32) -> Option<Self> {
        let [left, low, right, high] = bounds(recorder, rows)?;
        let unit = f64::from(width) / NOMINAL;
        let (across, up) = ((right - left).max(1e-9), (high - low).max(1e-9));
        let room = [f64::from(width) - 2.0 * MARGIN * unit, HEIGHTS[1] * f64::from(width) - (MARGIN + CAPTION) * unit];
        let scale = (room[0] / across).min(room[1] / up);
        let height = (MARGIN + CAPTION) * unit + (up * scale).max(0.0);
        let height = height.max(HEIGHTS[0] * f64::from(width));
        // Whole pairs of pixels, as films need them.
        let even = |px: f64| 2 * (0.5 * px).ceil() as u32;
        let finite = scale.is_finite() && scale > 0.0;
        finite.then(|| Self {
            width: even(f64::from(width)),
            height: even(height),
            scale,
            middle: 0.5 * (left + right),
            bottom: low,
            unit,
        })
    }

    /// A place in the picture, px from its upper left corner.
    pub(super) fn px(&self, (x, y): (f64, f64)) -> [f32; 2] {
        let across = 0.5 * f64::from(self.width) + (x - self.middle) * self.scale;
        let down = f64::from(self.height) - CAPTION * self.unit - (y - self.bottom) * self.scale;
        [across as f32, down as f32]
    }

    /// The x of the world at the left and at the right edge, m.
    pub(super) fn sides(&self) -> [f64; 2] {
        let half = 0.5 * f64::from(self.width) / self.scale;
        [self.middle - half, self.middle + half]
    }
}

/// Left, low, right and high end of everything at all times.
fn bounds(recorder: &PageRecorder, rows: &[(f64, &[f64])]) -> Option<[f64; 4]> {
    let mut ends = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
    let mut see = |x: f64, y: f64, radius: f64| {
        if x.is_finite() && y.is_finite() {
            ends = [ends[0].min(x - radius), ends[1].min(y - radius), ends[2].max(x + radius), ends[3].max(y + radius)];
        }
    };
    for (_, row) in rows {
        for (block, [x, y, phi]) in recorder.scenery.blocks.iter().zip(placed::poses(recorder, row)) {
            let (sin, cos) = phi.sin_cos();
            let mut corners = block.corners.iter();
            for (count, radius) in &block.parts {
                for [a, b] in corners.by_ref().take(*count) {
                    see(x + cos * a - sin * b, y + sin * a + cos * b, *radius);
                }
            }
        }
        placed::beams(recorder, row).iter().flatten().for_each(|(x, y)| see(*x, *y, 0.0));
    }
    let (_, first) = rows.first()?;
    let (from, to) = if ends[0] <= ends[2] { (ends[0], ends[2]) } else { (-1.0, 1.0) };
    // The surface where the bodies are.
    for (x, y) in placed::ground(recorder, first, from, to).into_iter().flatten() {
        if (from..=to).contains(&x) {
            ends[1] = ends[1].min(y);
            ends[3] = ends[3].max(y);
            ends[0] = ends[0].min(x);
            ends[2] = ends[2].max(x);
        }
    }
    (ends[0] <= ends[2] && ends[1] <= ends[3]).then_some(ends)
}
