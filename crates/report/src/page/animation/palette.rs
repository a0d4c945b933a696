//! The colours of an animation: a fixed palette, as its files number their colours.

use std::cell::RefCell;
use std::collections::HashMap;

/// A colour: red, green, blue.
pub(super) type Rgb = [u8; 3];

pub(super) const PAPER: Rgb = [0xff, 0xff, 0xff];
pub(super) const INK: Rgb = [0x22, 0x22, 0x22];
pub(super) const GROUND: Rgb = [0xe6, 0xe6, 0xe6];
pub(super) const FIXED: Rgb = [0xc4, 0xc4, 0xc4];
pub(super) const BEAM: Rgb = [0x6a, 0x72, 0x7c];
pub(super) const BLOCK: Rgb = [0xcf, 0xdf, 0xf2];
pub(super) const EDGE: Rgb = [0x00, 0x50, 0xb0];

/// Colours that are drawn with.
const BASE: [Rgb; 7] = [PAPER, INK, GROUND, FIXED, BEAM, BLOCK, EDGE];

/// Shades between each two of them, which smooth the edges.
const BETWEEN: usize = 11;

/// All colours that are drawn with, and shades between each two.
#[derive(Debug)]
pub(super) struct Palette {
    colours: Vec<Rgb>,
    /// Numbers of colours met so far.
    known: RefCell<HashMap<Rgb, u8>>,
}

impl Default for Palette {
    fn default() -> Self {
        let mut colours = BASE.to_vec();
        for (k, one) in BASE.iter().enumerate() {
            for other in &BASE[k + 1..] {
                colours.extend((1..=BETWEEN).map(|step| {
                    let mix = |a: u8, b: u8| {
                        let (a, b) = (usize::from(a), usize::from(b));
                        ((a * (BETWEEN + 1 - step) + b * step) / (BETWEEN + 1)) as u8
                    };
                    [mix(one[0], other[0]), mix(one[1], other[1]), mix(one[2], other[2])]
                }));
            }
        }
        Self { colours, known: RefCell::default() }
    }
}

impl Palette {
    pub(super) fn colours(&self) -> &[Rgb] {
        &self.colours
    }

    /// The number that stands for a pixel that stays as it was.
    pub(super) fn unchanged(&self) -> u8 {
        self.colours.len() as u8
    }

    /// The number of the nearest colour of each pixel; four bytes a pixel, of which the last is ignored.
    pub(super) fn indices(&self, rgba: &[u8]) -> Vec<u8> {
        let mut known = self.known.borrow_mut();
        let mut last = (PAPER, 0);
        let number = |pixel: &[u8]| {
            let colour = [pixel[0], pixel[1], pixel[2]];
            if colour != last.0 {
                last = (colour, *known.entry(colour).or_insert_with(|| self.nearest(colour)));
            }
            last.1
        };
        rgba.chunks_exact(4).map(number).collect()
    }

    fn nearest(&self, colour: Rgb) -> u8 {
        let distance = |other: &Rgb| -> i32 {
            colour.iter().zip(other).map(|(a, b)| (i32::from(*a) - i32::from(*b)).pow(2)).sum()
        };
        let best = self.colours.iter().enumerate().min_by_key(|(_, other)| distance(other));
        best.map_or(0, |(number, _)| number as u8)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_colour_and_the_unchanged_pixel_have_a_number() {
        let palette = Palette::default();
        assert!(palette.colours().len() < 256);
        assert_eq!(usize::from(palette.unchanged()), palette.colours().len());
        for (number, [r, g, b]) in BASE.into_iter().enumerate() {
            assert_eq!(palette.indices(&[r, g, b, 255]), [number as u8]);
        }
        // A shade is nearer than any of the colours that it is between.
        let number = palette.indices(&[0x90, 0x90, 0x90, 255])[0];
        assert!(usize::from(number) >= BASE.len() && palette.colours()[usize::from(number)][0].abs_diff(0x90) < 12);
    }
}
