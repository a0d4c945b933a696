//! The files: GIF and animated PNG, each picture as the rectangle that changed.

use super::palette::Palette;
use super::{AnimationError, AnimationFormat};
use std::io::Write;

/// A file to which pictures are added.
pub(super) struct Encoder {
    file: File,
    size: [usize; 2],
    unchanged: u8,
    last: Vec<u8>,
    /// How long the pictures so far are shown: as it should be, s, and as written, in the file's unit.
    shown: (f64, u64),
}

enum File {
    Gif(Box<gif::Encoder<Vec<u8>>>),
    Png(Box<png::Writer<Shared>>, Shared),
}

/// A rectangle: left, top, width, height.
type Area = [usize; 4];

/// Memory that a PNG writer, which doesn't give it back, writes to.
#[derive(Clone, Default)]
struct Shared(std::rc::Rc<std::cell::RefCell<Vec<u8>>>);

impl Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.borrow_mut().write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

fn failed(error: impl ToString) -> AnimationError {
    AnimationError::Encoding(error.to_string())
}

impl Encoder {
    pub(super) fn new(
        format: AnimationFormat,
        size: [u32; 2],
        palette: &Palette,
        pictures: usize,
    ) -> Result<Self, AnimationError> {
        let colours: Vec<u8> = palette.colours().concat();
        let unchanged = palette.unchanged();
        let file = match format {
            AnimationFormat::Gif => {
                let [width, height] = size.map(|px| px as u16);
                let mut encoder = gif::Encoder::new(Vec::new(), width, height, &colours).map_err(failed)?;
                encoder.set_repeat(gif::Repeat::Infinite).map_err(failed)?;
                File::Gif(Box::new(encoder))
            }
            AnimationFormat::Png => {
                let bytes = Shared::default();
                let mut encoder = png::Encoder::new(bytes.clone(), size[0], size[1]);
                encoder.set_color(png::ColorType::Indexed);
                encoder.set_depth(png::BitDepth::Eight);
                let white = [0xff; 3];
                encoder.set_palette([colours.as_slice(), &white].concat());
                // All colours are opaque but the one for pixels that stay.
                let mut opacity = vec![0xff; usize::from(unchanged)];
                opacity.push(0);
                encoder.set_trns(opacity);
                encoder.set_animated(pictures as u32, 0).map_err(failed)?;
                encoder.set_dispose_op(png::DisposeOp::None).map_err(failed)?;
                encoder.set_filter(png::FilterType::NoFilter);
                encoder.set_compression(png::Compression::Default);
                File::Png(Box::new(encoder.write_header().map_err(failed)?), bytes)
            }
        };
        Ok(Self { file, size: size.map(|px| px as usize), unchanged, last: Vec::new(), shown: (0.0, 0) })
    }

    /// Adds a picture, shown for so many seconds.
    pub(super) fn add(&mut self, pixels: &[u8], seconds: f64) -> Result<(), AnimationError> {
        let (area, changed) = self.changed(pixels);
        let first = self.last.is_empty();
        self.last.clear();
        self.last.extend_from_slice(pixels);
        let delay = self.delay(seconds);
        match &mut self.file {
            File::Gif(encoder) => {
                let [left, top, width, height] = area.map(|px| px as u16);
                let frame = gif::Frame {
                    delay,
                    dispose: gif::DisposalMethod::Keep,
                    transparent: (!first).then_some(self.unchanged),
                    left,
                    top,
                    width,
                    height,
                    buffer: changed.into(),
                    ..gif::Frame::default()
                };
                encoder.write_frame(&frame).map_err(failed)
            }
            File::Png(writer, _) => {
                let [left, top, width, height] = area.map(|px| px as u32);
                if !first {
                    // A position is refused where the rectangle before, moved there, would leave the picture.
                    writer.set_frame_dimension(1, 1).map_err(failed)?;
                    writer.set_frame_position(left, top).map_err(failed)?;
                    writer.set_frame_dimension(width, height).map_err(failed)?;
                    writer.set_blend_op(png::BlendOp::Over).map_err(failed)?;
                }
                writer.set_frame_delay(delay, 1000).map_err(failed)?;
                writer.write_image_data(&changed).map_err(failed)
            }
        }
    }

    pub(super) fn finish(self) -> Result<Vec<u8>, AnimationError> {
        match self.file {
            File::Gif(encoder) => encoder.into_inner().map_err(failed),
            File::Png(writer, bytes) => {
                writer.finish().map_err(failed)?;
                Ok(bytes.0.take())
            }
        }
    }

    /// The rectangle that changed, and its pixels, with those that stay marked. A picture without a change has one pixel.
    fn changed(&self, pixels: &[u8]) -> (Area, Vec<u8>) {
        let [width, height] = self.size;
        if self.last.is_empty() {
            return ([0, 0, width, height], pixels.to_vec());
        }
        let rows = || pixels.chunks_exact(width).zip(self.last.chunks_exact(width));
        let differ = |(new, old): &(&[u8], &[u8])| new != old;
        let Some(top) = rows().position(|row| differ(&row)) else { return ([0, 0, 1, 1], vec![self.unchanged]) };
        let bottom = height - rows().rev().position(|row| differ(&row)).unwrap_or(0);
        let (mut left, mut right) = (width, 0);
        for (new, old) in rows().take(bottom).skip(top) {
            let changes = |k: &usize| new[*k] != old[*k];
            left = (0..left).find(changes).unwrap_or(left);
            right = (right..width).rev().find(changes).map_or(right, |last| last + 1);
        }
        let marked = rows().take(bottom).skip(top).flat_map(|(new, old)| {
            let pixels = new[left..right].iter().zip(&old[left..right]);
            pixels.map(|(new, old)| if new == old { self.unchanged } else { *new })
        });
        ([left, top, right - left, bottom - top], marked.collect())
    }

    /// How long a picture is shown, in the unit of the file. Rounding doesn't add up.
    fn delay(&mut self, seconds: f64) -> u16 {
        let unit = match self.file {
            File::Gif(_) => 100.0,
            File::Png(..) => 1000.0,
        };
        self.shown.0 += seconds;
        let delay = ((self.shown.0 * unit).round() as u64).saturating_sub(self.shown.1);
        self.shown.1 += delay;
        delay.min(u64::from(u16::MAX)) as u16
    }
}
