//! One picture of an animation.

use super::super::placed::{self, Points};
use super::super::recorder::PageRecorder;
use super::palette::{BEAM, BLOCK, EDGE, FIXED, GROUND, INK, PAPER, Rgb};
use super::text::Font;
use super::timing::Timing;
use super::view::View;
use teeter_scenario::scene::Display;
use tiny_skia::{Color, FillRule, LineJoin, Paint, Path, PathBuilder, Pixmap, Rect, Stroke, Transform};

/// Sizes in nominal pixels: lines, letters, supports, the part of the width that the scale bar takes at most.
const LINE: f64 = 1.6;
const LETTERS: f64 = 16.0;
const SUPPORT: f64 = 9.0;
const BAR: f64 = 0.2;

/// Draws the pictures of an animation, all into the same memory.
pub(super) struct Painter<'a> {
    recorder: &'a PageRecorder,
    view: &'a View,
    pixels: Pixmap,
    font: Font,
    decimals: usize,
    /// What is said of the speed.
    speed: String,
    /// Length of the scale bar, m, and what it says.
    bar: (f64, String),
    /// Width of the edges of blocks, px: of small blocks less.
    edge: f32,
}

impl<'a> Painter<'a> {
    pub(super) fn new(recorder: &'a PageRecorder, view: &'a View, timing: &Timing) -> Option<Self> {
        let mut reaches: Vec<f64> = recorder.scenery.blocks.iter().map(|block| block.reach).collect();
        reaches.sort_by(f64::total_cmp);
        let usual = reaches.get(reaches.len() / 2).map_or(LINE, |reach| 0.1 * reach * view.scale / view.unit);
        Some(Self {
            recorder,
            view,
            pixels: Pixmap::new(view.width, view.height)?,
            font: Font::new()?,
            decimals: timing.decimals(),
            speed: speed_in_words(timing.speed),
            bar: scale_bar(BAR * f64::from(view.width) / view.scale, &recorder.scenery.display),
            edge: (LINE.min(usual) * view.unit) as f32,
        })
    }

    /// The pixels of a picture, four bytes each.
    pub(super) fn paint(&mut self, row: &[f64], t: f64) -> &[u8] {
        self.pixels.fill(Color::from_rgba8(PAPER[0], PAPER[1], PAPER[2], 255));
        let line = (LINE * self.view.unit) as f32;
        self.ground(row, line);
        for (number, outline) in placed::beams(self.recorder, row).iter().enumerate() {
            self.beam(number, outline, line);
        }
        for (number, parts) in placed::blocks(self.recorder, row).iter().enumerate() {
            let (fill, edge) = if self.recorder.scenery.blocks[number].driven { (FIXED, INK) } else { (BLOCK, EDGE) };
            if let Some(path) = self.path(parts.iter().map(Vec::as_slice), true) {
                self.fill(&path, fill);
                self.stroke(&path, edge, self.edge);
            }
        }
        self.caption(t, line);
        self.pixels.data()
    }

    fn ground(&mut self, row: &[f64], line: f32) {
        let [left, right] = self.view.sides();
        let Some(surface) = placed::ground(self.recorder, row, left, right) else { return };
        let deep = 2.0 * (right - left) + f64::from(self.view.height) / self.view.scale;
        let below = surface.iter().rev().map(|(x, y)| (*x, y - deep));
        let area: Points = surface.iter().copied().chain(below).collect();
        if let Some(path) = self.path([area.as_slice()], true) {
            self.fill(&path, GROUND);
        }
        if let Some(path) = self.path([surface.as_slice()], false) {
            self.stroke(&path, INK, line);
        }
    }

    fn beam(&mut self, number: usize, outline: &Points, line: f32) {
        let beam = &self.recorder.scenery.beams[number];
        let points = outline.len() / 2;
        // The middle of the lower edge and of the beam, and its half height.
        let at = |part: f64| {
            let k = (part * (points - 1) as f64).round() as usize;
            let ([x, top], [_, low]) = (self.view.px(outline[k]), self.view.px(outline[outline.len() - 1 - k]));
            (x, low, 0.5 * (top + low), 0.5 * (low - top))
        };
        let ends = beam.supports.iter().enumerate().map(|(side, kind)| (at(side as f64), *kind, [-1.0, 1.0][side]));
        let inner = beam.inner.iter().map(|(x, kind)| (at(x / beam.span), *kind, 0.0));
        let supports: Vec<_> = ends.chain(inner).collect();
        let dashpots: Vec<_> =
            supports.iter().zip(&beam.dashpots).filter(|(_, has)| **has).map(|(of, _)| of.0).collect();
        if let Some(path) = self.path([outline.as_slice()], true) {
            self.fill(&path, BEAM);
            self.stroke(&path, BEAM, line);
        }
        let size = (SUPPORT * self.view.unit) as f32;
        let foundations = beam.foundations.iter().map(|(from, to)| [at(from / beam.span), at(to / beam.span)]);
        let foundations: Vec<_> = foundations.collect();
        let masses: Vec<_> = beam.masses.iter().map(|x| at(x / beam.span)).collect();
        for [(left, low, ..), (right, ..)] in foundations {
            self.foundation([left, right], low, size, line);
        }
        for (x, low, ..) in dashpots {
            self.dashpot(x, low, size, line);
        }
        for (x, _, middle, _) in masses {
            if let Some(path) = PathBuilder::from_circle(x, middle, 0.6 * size) {
                self.fill(&path, INK);
            }
        }
        for ((x, low, middle, half), kind, outwards) in supports {
            let mut path = PathBuilder::new();
            match kind {
                "free" => continue,
                "clamped" if outwards != 0.0 => {
                    let (width, reach) = (0.6 * size, half + size);
                    let left = if outwards < 0.0 { x - width } else { x };
                    if let Some(rect) = Rect::from_xywh(left, middle - reach, width, 2.0 * reach) {
                        path.push_rect(rect);
                    }
                }
                _ => {
                    path.move_to(x, low);
                    path.line_to(x - 0.7 * size, low + size);
                    path.line_to(x + 0.7 * size, low + size);
                    path.close();
                }
            }
            if let Some(path) = path.finish() {
                self.fill(&path, INK);
            }
        }
    }

    /// A row of springs under a beam, on a line.
    fn foundation(&mut self, [left, right]: [f32; 2], low: f32, size: f32, line: f32) {
        let count = ((right - left) / (2.0 * size)).round().max(2.0);
        let mut path = PathBuilder::new();
        for k in 0..count as usize {
            let x = left + (k as f32 + 0.5) / count * (right - left);
            path.move_to(x, low);
            for (across, down) in [(-0.4, 0.3), (0.4, 0.6), (-0.4, 0.9), (0.4, 1.2), (0.0, 1.5)] {
                path.line_to(x + across * size, low + down * size);
            }
        }
        path.move_to(left, low + 1.5 * size);
        path.line_to(right, low + 1.5 * size);
        if let Some(path) = path.finish() {
            self.stroke(&path, INK, 0.7 * line);
        }
    }

    /// A dashpot beside a support under a beam: a piston in an open cylinder.
    fn dashpot(&mut self, x: f32, low: f32, size: f32, line: f32) {
        let mut path = PathBuilder::new();
        let strokes: [&[(f32, f32)]; 4] = [
            &[(0.0, 0.0), (1.2, 0.0), (1.2, 0.7)],
            &[(0.9, 0.7), (1.5, 0.7)],
            &[(0.75, 0.4), (0.75, 1.1), (1.65, 1.1), (1.65, 0.4)],
            &[(1.2, 1.1), (1.2, 1.5)],
        ];
        for stroke in strokes {
            for (k, (across, down)) in stroke.iter().enumerate() {
                let (x, y) = (x + across * size, low + down * size);
                if k == 0 { path.move_to(x, y) } else { path.line_to(x, y) }
            }
        }
        if let Some(path) = path.finish() {
            self.stroke(&path, INK, 0.7 * line);
        }
    }

    /// The time, the speed, and a scale.
    fn caption(&mut self, t: f64, line: f32) {
        let size = (LETTERS * self.view.unit) as f32;
        let (width, y) = (self.view.width as f32, self.view.height as f32 - 0.6 * size);
        let margin = 0.8 * size;
        let time = format!("t = {t:.*} s", self.decimals);
        let bar = (self.bar.0 * self.view.scale) as f32;
        let (length, text) = (bar, self.bar.1.clone());
        let text_at = width - margin - self.font.width(&text, size);
        let right = text_at - 0.5 * size;
        let mut path = PathBuilder::new();
        let (middle, tick) = (y - 0.36 * size, 0.3 * size);
        for (x, from, to) in [(right - length, middle - tick, middle + tick), (right, middle - tick, middle + tick)] {
            path.move_to(x, from);
            path.line_to(x, to);
        }
        path.move_to(right - length, middle);
        path.line_to(right, middle);
        // Behind the text, so that it can be read over the ground.
        if let Some(path) = path.finish() {
            self.stroke(&path, PAPER, 2.5 * line);
            self.stroke(&path, INK, line);
        }
        let time_ends = margin + self.font.width(&time, size);
        let (from, to) = (time_ends + size, right - length - size);
        let speed = self.speed.clone();
        let speed_width = self.font.width(&speed, size);
        self.write(&time, size, margin, y, line);
        self.write(&text, size, text_at, y, line);
        if to - from >= speed_width {
            self.write(&speed, size, 0.5 * (from + to - speed_width), y, line);
        }
    }

    fn write(&mut self, text: &str, size: f32, x: f32, y: f32, line: f32) {
        if let Some(path) = self.font.outline(text, size, x, y) {
            self.stroke(&path, PAPER, 2.0 * line);
            self.fill(&path, INK);
        }
    }

    fn path<'p>(&self, lines: impl IntoIterator<Item = &'p [(f64, f64)]>, closed: bool) -> Option<Path> {
        let mut path = PathBuilder::new();
        for line in lines {
            let places = line.iter().map(|at| self.view.px(*at)).filter(|[x, y]| x.is_finite() && y.is_finite());
            for (k, [x, y]) in places.enumerate() {
                if k == 0 { path.move_to(x, y) } else { path.line_to(x, y) }
            }
            if closed && !path.is_empty() {
                path.close();
            }
        }
        path.finish()
    }

    fn fill(&mut self, path: &Path, colour: Rgb) {
        self.pixels.fill_path(path, &paint(colour), FillRule::Winding, Transform::identity(), None);
    }

    fn stroke(&mut self, path: &Path, colour: Rgb, width: f32) {
        let stroke = Stroke { width, line_join: LineJoin::Round, ..Stroke::default() };
        self.pixels.stroke_path(path, &paint(colour), &stroke, Transform::identity(), None);
    }
}

fn paint(colour: Rgb) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color_rgba8(colour[0], colour[1], colour[2], 255);
    paint.anti_alias = true;
    paint
}

fn speed_in_words(speed: f64) -> String {
    let round = |x: f64| teeter_scenario::readable::shortest(x, 3);
    if (speed - 1.0).abs() < 1e-9 {
        "real time".to_owned()
    } else if speed < 1.0 {
        format!("{} times slower", round(1.0 / speed))
    } else {
        format!("{} times faster", round(speed))
    }
}

/// The longest length of 1, 2 or 5 · 10ⁿ of the scene's unit of length that isn't longer than this, m.
fn scale_bar(longest: f64, display: &Display) -> (f64, String) {
    let unit = display.length;
    let longest = longest * unit.per_metre();
    let power = 10f64.powf(longest.log10().floor());
    let factor = [5.0, 2.0, 1.0].into_iter().find(|factor| factor * power <= longest).unwrap_or(1.0);
    let length = factor * power;
    (length / unit.per_metre(), format!("{} {}", teeter_scenario::readable::shortest(length, 1), unit.word()))
}
