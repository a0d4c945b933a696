//! The embedded font, and which of its glyphs a document uses.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use subsetter::GlyphRemapper;
use ttf_parser::{Face, GlyphId};

/// The font of figures.
pub(super) struct Font {
    face: Face<'static>,
    used: RefCell<Used>,
}

/// What a document uses of it.
#[derive(Default)]
struct Used {
    /// The numbers of its glyphs in the document.
    numbers: GlyphRemapper,
    /// The glyphs by these numbers, with a letter that each stands for.
    glyphs: BTreeMap<u16, (u16, char)>,
    /// Letters that the font lacks.
    missing: BTreeSet<char>,
}

impl Font {
    pub(super) fn new() -> Option<Self> {
        Some(Self { face: Face::parse(crate::FONT, 0).ok()?, used: RefCell::default() })
    }

    /// Thousandths of the font size that a design unit is.
    fn per_mille(&self) -> f64 {
        1000.0 / f64::from(self.face.units_per_em())
    }

    fn advance(&self, glyph: u16) -> f64 {
        f64::from(self.face.glyph_hor_advance(GlyphId(glyph)).unwrap_or(0)) * self.per_mille()
    }

    fn glyphs(&self, text: &str) -> impl Iterator<Item = (u16, char)> {
        let shown = text.chars().filter(|letter| *letter != '\u{200b}');
        shown.map(|letter| (self.face.glyph_index(letter).unwrap_or_default().0, letter))
    }

    /// The width of a text in parts of the font size.
    pub(super) fn width(&self, text: &str) -> f64 {
        self.glyphs(text).map(|(glyph, _)| self.advance(glyph)).sum::<f64>() / 1000.0
    }

    /// A text as the string of its glyphs.
    pub(super) fn string(&self, text: &str) -> String {
        let mut used = self.used.borrow_mut();
        self.glyphs(text)
            .map(|(glyph, letter)| {
                if glyph == 0 {
                    used.missing.insert(letter);
                }
                let number = used.numbers.remap(glyph);
                used.glyphs.entry(number).or_insert((glyph, letter));
                format!("{number:04x}")
            })
            .collect()
    }

    /// The font with the glyphs used, as a file.
    pub(super) fn file(&self) -> Option<Vec<u8>> {
        subsetter::subset(crate::FONT, 0, &self.used.borrow().numbers).ok()
    }

    /// The letters used that it lacks, which are drawn as boxes.
    pub(super) fn missing(&self) -> Vec<char> {
        self.used.borrow().missing.iter().copied().collect()
    }

    /// The widths of the glyphs used, as an array of PDF.
    pub(super) fn widths(&self) -> String {
        let used = self.used.borrow();
        used.glyphs.iter().map(|(number, (glyph, _))| format!("{number} [{:.0}] ", self.advance(*glyph))).collect()
    }

    /// What the glyphs used stand for, so that text can be copied and searched.
    pub(super) fn to_unicode(&self) -> String {
        let used = self.used.borrow();
        let used: Vec<(u16, char)> = used.glyphs.iter().map(|(number, (_, letter))| (*number, *letter)).collect();
        let mut map =
            "/CIDInit /ProcSet findresource begin\n12 dict begin\nbegincmap\n/CIDSystemInfo << /Registry (Adobe) \
                       /Ordering (UCS) /Supplement 0 >> def\n/CMapName /Adobe-Identity-UCS def\n/CMapType 2 def\n\
                       1 begincodespacerange\n<0000> <ffff>\nendcodespacerange\n"
                .to_owned();
        for some in used.chunks(100) {
            map.push_str(&format!("{} beginbfchar\n", some.len()));
            for (glyph, letter) in some {
                let units: String = letter.encode_utf16(&mut [0; 2]).iter().map(|unit| format!("{unit:04x}")).collect();
                map.push_str(&format!("<{glyph:04x}> <{units}>\n"));
            }
            map.push_str("endbfchar\n");
        }
        map.push_str("endcmap\nCMapName currentdict /CMap defineresource pop\nend\nend\n");
        map
    }

    /// What a PDF says of the font.
    pub(super) fn descriptor(&self) -> String {
        let (unit, bounds) = (self.per_mille(), self.face.global_bounding_box());
        let scaled = |x: i16| (f64::from(x) * unit).round();
        format!(
            "/FontBBox [{} {} {} {}] /Ascent {} /Descent {} /CapHeight {} /ItalicAngle 0 /StemV 80 /Flags 4",
            scaled(bounds.x_min),
            scaled(bounds.y_min),
            scaled(bounds.x_max),
            scaled(bounds.y_max),
            scaled(self.face.ascender()),
            scaled(self.face.descender()),
            scaled(self.face.capital_height().unwrap_or(self.face.ascender())),
        )
    }
}
