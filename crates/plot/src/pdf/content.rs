//! The drawing operators of a page.

use super::elements::{Element, Node};
use super::font::Font;
use super::path::{Path, short};
use super::{PdfError, not_ours};
use std::collections::BTreeMap;
use std::fmt::Write;

/// What an element hands down.
#[derive(Debug, Clone)]
struct Style {
    fill: Option<[f64; 3]>,
    stroke: Option<[f64; 3]>,
    stroke_width: f64,
    dashes: String,
    join: u8,
    cap: u8,
    opacity: [f64; 2],
    size: f64,
}

/// Operators, and what they refer to.
pub(super) struct Content<'a> {
    font: &'a Font,
    pub(super) operators: String,
    clips: BTreeMap<String, [f64; 4]>,
    /// Opacities of fills and of strokes, in thousandths.
    pub(super) opacities: Vec<[u16; 2]>,
}

/// A part of a text: the letters, their size, and how far below the line before they stand.
struct Run {
    text: String,
    size: f64,
    down: f64,
}

impl<'a> Content<'a> {
    /// For a document of this height, with so many points to its unit.
    pub(super) fn new(font: &'a Font, height: f64, points: f64) -> Self {
        // SVG counts downwards from the top.
        let operators = format!("{points:.6} 0 0 {:.6} 0 {:.4} cm\n", -points, height * points);
        Self { font, operators, clips: BTreeMap::new(), opacities: Vec::new() }
    }

    /// Draws a document.
    pub(super) fn draw(&mut self, root: &Element) -> Result<(), PdfError> {
        let plain = Style {
            fill: Some([0.0; 3]),
            stroke: None,
            stroke_width: 1.0,
            dashes: String::new(),
            join: 0,
            cap: 0,
            opacity: [1.0; 2],
            size: 11.0,
        };
        let style = plain.with(root)?;
        root.elements().try_for_each(|element| self.element(element, &style))
    }

    fn element(&mut self, element: &Element, outer: &Style) -> Result<(), PdfError> {
        let style = outer.with(element)?;
        match element.name.as_str() {
            "title" => Ok(()),
            "clipPath" => {
                let rect = element.elements().next().ok_or_else(|| not_ours("an empty clipPath"))?;
                self.clips.insert(element.attribute("id")?.to_owned(), area(rect)?);
                Ok(())
            }
            "g" => {
                self.operators.push_str("q\n");
                if let Some(id) = element.given("clip-path") {
                    let id = id.trim_start_matches("url(#").trim_end_matches(')');
                    let [x, y, width, height] =
                        self.clips.get(id).ok_or_else(|| not_ours(format!("no clipPath {id}")))?.map(short);
                    let _ = writeln!(self.operators, "{x} {y} {width} {height} re W n");
                }
                element.elements().try_for_each(|inner| self.element(inner, &style))?;
                self.operators.push_str("Q\n");
                Ok(())
            }
            "rect" => {
                let [x, y, width, height] = area(element)?;
                let operators = format!("{} {} {} {} re\n", short(x), short(y), short(width), short(height));
                self.paint(&Path { operators, encloses: width * height > 0.0 }, &style);
                Ok(())
            }
            "circle" => {
                let centre = [element.number("cx")?, element.number("cy")?];
                self.paint(&Path::circle(centre, element.number("r")?), &style);
                Ok(())
            }
            "path" => {
                self.paint(&Path::of(element.attribute("d")?)?, &style);
                Ok(())
            }
            "text" => self.text(element, &style),
            name => Err(not_ours(format!("the element {name}"))),
        }
    }

    fn paint(&mut self, path: &Path, style: &Style) {
        let fill = style.fill.filter(|_| path.encloses);
        let operator = match (fill, style.stroke) {
            (None, None) => return,
            (Some(_), None) => "f",
            (None, Some(_)) => "S",
            (Some(_), Some(_)) => "B",
        };
        self.operators.push_str("q\n");
        self.set(fill, style);
        let _ = writeln!(self.operators, "{}{operator}\nQ", path.operators);
    }

    /// Sets colours and lines.
    fn set(&mut self, fill: Option<[f64; 3]>, style: &Style) {
        if style.opacity != [1.0; 2] {
            let opacity = style.opacity.map(|part| (1000.0 * part).round() as u16);
            let number = self.opacities.iter().position(|known| *known == opacity).unwrap_or_else(|| {
                self.opacities.push(opacity);
                self.opacities.len() - 1
            });
            let _ = writeln!(self.operators, "/G{number} gs");
        }
        if let Some([r, g, b]) = fill.map(|fill| fill.map(short)) {
            let _ = writeln!(self.operators, "{r} {g} {b} rg");
        }
        if let Some([r, g, b]) = style.stroke.map(|stroke| stroke.map(short)) {
            let _ = writeln!(
                self.operators,
                "{r} {g} {b} RG {} w {} j {} J [{}] 0 d",
                short(style.stroke_width),
                style.join,
                style.cap,
                style.dashes
            );
        }
    }

    fn text(&mut self, element: &Element, style: &Style) -> Result<(), PdfError> {
        let mut runs = Vec::new();
        for node in &element.inside {
            runs.push(match node {
                Node::Text(text) => Run { text: text.clone(), size: style.size, down: 0.0 },
                Node::Element(inner) if inner.name == "tspan" => {
                    let text = inner.inside.iter().map(|node| match node {
                        Node::Text(text) => Ok(text.as_str()),
                        Node::Element(_) => Err(not_ours("a tspan in a tspan")),
                    });
                    let text = text.collect::<Result<String, _>>()?;
                    Run { text, size: style.with(inner)?.size, down: inner.number_or("dy", 0.0)? }
                }
                Node::Element(inner) => return Err(not_ours(format!("{} in a text", inner.name))),
            });
        }
        let width: f64 = runs.iter().map(|run| run.size * self.font.width(&run.text)).sum();
        let before = match element.given("text-anchor") {
            None | Some("start") => 0.0,
            Some("middle") => 0.5 * width,
            Some("end") => width,
            Some(other) => return Err(not_ours(format!("text-anchor = {other}"))),
        };
        self.operators.push_str("q\n");
        let (x, mut y) = match element.given("transform") {
            None => (element.number("x")?, element.number("y")?),
            // Titles of y axes.
            Some(transform) => {
                let wrong = || not_ours(format!("transform = {transform}"));
                let numbers = transform.strip_prefix("translate(").and_then(|rest| rest.strip_suffix(") rotate(-90)"));
                let (x, y) = numbers.and_then(|numbers| numbers.split_once(' ')).ok_or_else(wrong)?;
                let (x, y): (f64, f64) = (x.parse().map_err(|_| wrong())?, y.parse().map_err(|_| wrong())?);
                let _ = writeln!(self.operators, "0 -1 1 0 {} {} cm", short(x), short(y));
                (0.0, 0.0)
            }
        };
        self.set(style.fill, style);
        let mut x = x - before;
        let mut shown = String::new();
        for run in runs {
            y += run.down;
            let _ = writeln!(
                shown,
                "/F1 {} Tf 1 0 0 -1 {} {} Tm <{}> Tj",
                short(run.size),
                short(x),
                short(y),
                self.font.string(&run.text)
            );
            x += run.size * self.font.width(&run.text);
        }
        // A stroke is only given to texts that it lies behind.
        if style.stroke.is_some() {
            let _ = writeln!(self.operators, "BT 1 Tr\n{shown}ET");
        }
        let _ = writeln!(self.operators, "BT 0 Tr\n{shown}ET\nQ");
        Ok(())
    }
}

impl Style {
    /// With the attributes of an element.
    fn with(&self, element: &Element) -> Result<Self, PdfError> {
        let dashes = match element.given("stroke-dasharray") {
            None => self.dashes.clone(),
            Some("none") => String::new(),
            Some(_) => element.numbers("stroke-dasharray")?.into_iter().map(short).collect::<Vec<_>>().join(" "),
        };
        let round = |key: &str, before: u8| match element.given(key) {
            None => Ok(before),
            Some("round") => Ok(1),
            Some(other) => Err(not_ours(format!("{key} = {other}"))),
        };
        Ok(Self {
            fill: colour(element, "fill", self.fill)?,
            stroke: colour(element, "stroke", self.stroke)?,
            stroke_width: element.number_or("stroke-width", self.stroke_width)?,
            dashes,
            join: round("stroke-linejoin", self.join)?,
            cap: round("stroke-linecap", self.cap)?,
            opacity: [
                element.number_or("fill-opacity", self.opacity[0])?,
                element.number_or("stroke-opacity", self.opacity[1])?,
            ],
            size: element.number_or("font-size", self.size)?,
        })
    }
}

/// Left, top, width and height of a rectangle.
fn area(element: &Element) -> Result<[f64; 4], PdfError> {
    Ok([
        element.number_or("x", 0.0)?,
        element.number_or("y", 0.0)?,
        element.number("width")?,
        element.number("height")?,
    ])
}

/// A colour `#rgb` or `#rrggbb`; none for `none`.
fn colour(element: &Element, key: &str, before: Option<[f64; 3]>) -> Result<Option<[f64; 3]>, PdfError> {
    let Some(text) = element.given(key) else { return Ok(before) };
    if text == "none" {
        return Ok(None);
    }
    let digits: Option<Vec<u32>> = text.strip_prefix('#').and_then(|hex| hex.chars().map(|c| c.to_digit(16)).collect());
    match digits.as_deref() {
        Some([r, g, b]) => Ok(Some([*r, *g, *b].map(|part| f64::from(part) / 15.0))),
        Some([r, s, g, h, b, c]) => Ok(Some([(r, s), (g, h), (b, c)].map(|(a, b)| f64::from(16 * a + b) / 255.0))),
        // Figures of web pages follow the page.
        _ => Err(not_ours(format!("{key} = {text}"))),
    }
}
