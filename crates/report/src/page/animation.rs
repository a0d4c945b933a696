//! The motion of a run as one file for slides and web pages: an animated GIF, or an animated PNG.
//!
//! Its pictures are evenly spread over the run, between those that [`PageRecorder`] keeps: of these there are so few that time and
//! size of an animation are bounded for runs of any length.

mod encode;
mod palette;
mod picture;
mod text;
mod timing;
mod view;

use super::recorder::PageRecorder;
use encode::Encoder;
use palette::Palette;
use picture::Painter;
use std::path::Path;
use timing::Timing;
use view::View;

/// Widths of an animation, px.
const WIDTHS: [u32; 2] = [120, 1920];

/// Rates of pictures, 1/s: browsers show GIFs of more than 50 pictures a second slowly.
const RATES: [f64; 2] = [1.0, 50.0];

/// Speeds, as a part of real time.
const SPEEDS: [f64; 2] = [1e-6, 1e6];

/// The file of an animation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum AnimationFormat {
    /// GIF, which every program shows. Times between pictures are whole hundredths of a second.
    Gif,
    /// Animated PNG, which browsers show; other programs show its first picture.
    Png,
}

impl AnimationFormat {
    /// The format that the extension of a file says: `.gif`, `.png` or `.apng`.
    #[must_use]
    pub fn of_file(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "gif" => Some(Self::Gif),
            "png" | "apng" => Some(Self::Png),
            _ => None,
        }
    }
}

/// How a run is animated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Animation {
    format: AnimationFormat,
    width: u32,
    rate: f64,
    speed: Option<f64>,
}

impl Animation {
    /// An animation of 720 px and 25 pictures a second, at the speed at which it takes 5 to 20 s, real time if possible.
    #[must_use]
    pub fn new(format: AnimationFormat) -> Self {
        Self { format, width: 720, rate: 25.0, speed: None }
    }

    /// Sets the width, px, from 120 to 1920; the height follows from the scene. Default: 720.
    ///
    /// # Errors
    /// [`AnimationError::Width`] for any other width.
    pub fn width(mut self, px: u32) -> Result<Self, AnimationError> {
        if !(WIDTHS[0]..=WIDTHS[1]).contains(&px) {
            return Err(AnimationError::Width(px));
        }
        self.width = px;
        Ok(self)
    }

    /// Sets the number of pictures a second, from 1 to 50. There are at most 1000 pictures: of an animation that takes longer than
    /// that, fewer a second. Default: 25.
    ///
    /// # Errors
    /// [`AnimationError::Rate`] for any other rate.
    pub fn rate(mut self, pictures: f64) -> Result<Self, AnimationError> {
        if !(RATES[0]..=RATES[1]).contains(&pictures) {
            return Err(AnimationError::Rate(pictures));
        }
        self.rate = pictures;
        Ok(self)
    }

    /// The number of pictures a second that was asked for.
    #[must_use]
    pub fn pictures_a_second(&self) -> f64 {
        self.rate
    }

    /// Sets the speed as a part of real time, from 1e-6 to 1e6: 0.1 is ten times slower than the motion. Default: 1 for
    /// runs of 5 to 20 s; of others, the one of 1, 2, 5, 10 … times slower or faster that is nearest to it with which the animation takes
    /// that long.
    ///
    /// # Errors
    /// [`AnimationError::Speed`] for any other speed.
    pub fn speed(mut self, speed: f64) -> Result<Self, AnimationError> {
        if !(SPEEDS[0]..=SPEEDS[1]).contains(&speed) {
            return Err(AnimationError::Speed(speed));
        }
        self.speed = Some(speed);
        Ok(self)
    }
}

/// Why there is no animation.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AnimationError {
    /// The width is out of range, px.
    #[error("an animation is {} to {} px wide, got {}", WIDTHS[0], WIDTHS[1], .0)]
    Width(u32),
    /// The rate of pictures is out of range, 1/s.
    #[error("an animation has {} to {} pictures a second, got {}", RATES[0], RATES[1], .0)]
    Rate(f64),
    /// The speed is out of range.
    #[error("the speed of an animation is {:e} to {:e} times that of the motion, got {}", SPEEDS[0], SPEEDS[1], .0)]
    Speed(f64),
    /// Nothing of the scene is at a finite place.
    #[error("nothing in the scene can be drawn")]
    Nothing,
    /// The file can't be made.
    #[error("the animation can't be encoded: {0}")]
    Encoding(String),
}

/// What an animation became.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct AnimationInfo {
    /// Width and height, px.
    pub size: [u32; 2],
    /// Number of pictures.
    pub pictures: usize,
    /// How long it plays, s, with the rest at its end.
    pub seconds: f64,
    /// Its speed as a part of real time.
    pub speed: f64,
    /// Pictures a second: fewer than asked for, if there would be too many.
    pub rate: f64,
}

/// The animation of what a recorder saw, as the bytes of a file. It is played again and again, and rests for a second at its end.
///
/// ```
/// use teeter_report::{Animation, AnimationFormat, PageRecorder, animate};
/// use teeter_scenario::simulation::Simulation;
/// # let text = r#"
/// # time = { end = "0.1 s", step = "1 ms" }
/// # ground = {}
/// # material.wood.density = "600 kg/m^3"
/// # block.cube = { material = "wood", width = "10 cm", height = "10 cm", depth = "10 cm", position = ["0 m", "6 cm"] }
/// # contact.floor = { between = ["cube", "ground"], friction = 0.4 }
/// # "#;
/// # let resolved = teeter_scenario::load(text.as_bytes(), "cube.toml", "cube", &[])?;
/// let mut simulation = Simulation::new(&resolved.scene)?;
/// let mut page = PageRecorder::new(&resolved.scene, &simulation.layout);
/// simulation.run(&mut [&mut page])?;
/// let (file, made) = animate(&page, &Animation::new(AnimationFormat::Gif).width(240)?.speed(0.1)?)?;
/// assert!(file.starts_with(b"GIF89a") && made.pictures == 26);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`AnimationError::Nothing`] if nothing can be drawn, [`AnimationError::Encoding`] if the file can't be made.
pub fn animate(recorder: &PageRecorder, animation: &Animation) -> Result<(Vec<u8>, AnimationInfo), AnimationError> {
    let rows: Vec<(f64, &[f64])> = recorder.kept.frames.rows().collect();
    let view = View::new(recorder, &rows, animation.width).ok_or(AnimationError::Nothing)?;
    let (Some((first, _)), Some((last, _))) = (rows.first(), rows.last()) else { return Err(AnimationError::Nothing) };
    let timing = Timing::new(last - first, animation.rate, animation.speed);
    let size = [view.width, view.height];
    let palette = Palette::default();
    let mut painter = Painter::new(recorder, &view, &timing).ok_or(AnimationError::Nothing)?;
    let mut encoder = Encoder::new(animation.format, size, &palette, timing.pictures)?;
    let (mut row, mut before) = (vec![0.0; rows[0].1.len()], 0);
    for picture in 0..timing.pictures {
        let t = first + timing.time(picture);
        // The kept pictures on either side, between which the bodies move evenly.
        while before + 2 < rows.len() && rows[before + 1].0 <= t {
            before += 1;
        }
        let ((t0, start), (t1, end)) = (rows[before], rows[(before + 1).min(rows.len() - 1)]);
        let part = if t1 > t0 { ((t - t0) / (t1 - t0)).clamp(0.0, 1.0) } else { 0.0 };
        row.iter_mut().zip(start.iter().zip(end)).for_each(|(at, (a, b))| *at = a + part * (b - a));
        let pixels = painter.paint(&row, t);
        encoder.add(&palette.indices(pixels), timing.shown(picture))?;
    }
    let file = encoder.finish()?;
    let seconds = (0..timing.pictures).map(|picture| timing.shown(picture)).sum();
    let info = AnimationInfo { size, pictures: timing.pictures, seconds, speed: timing.speed, rate: timing.rate };
    Ok((file, info))
}
