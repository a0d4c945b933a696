//! Paths of SVG as operators of PDF.

use super::{PdfError, not_ours};
use std::fmt::Write;

/// A path as operators that construct it.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Path {
    pub(super) operators: String,
    /// Whether it encloses anything that could be filled.
    pub(super) encloses: bool,
}

/// A number for a content stream, with as many digits as a printer can use.
pub(super) fn short(x: f64) -> String {
    let text = format!("{x:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// Reads numbers between blanks, commas and signs.
struct Numbers<'a>(&'a str);

impl Numbers<'_> {
    fn next(&mut self) -> Option<f64> {
        self.0 = self.0.trim_start_matches(|c: char| c.is_whitespace() || c == ',');
        let mut end = 0;
        let (mut point, mut before) = (false, ' ');
        for (at, c) in self.0.char_indices() {
            let goes_on = match c {
                '0'..='9' => true,
                '.' => !std::mem::replace(&mut point, true),
                'e' | 'E' => at > 0,
                '-' | '+' => at == 0 || matches!(before, 'e' | 'E'),
                _ => false,
            };
            if !goes_on {
                break;
            }
            (end, before) = (at + c.len_utf8(), c);
        }
        let number = self.0[..end].parse().ok()?;
        self.0 = &self.0[end..];
        Some(number)
    }
}

impl Path {
    /// The path of the attribute `d`: lines and circular arcs.
    pub(super) fn of(d: &str) -> Result<Self, PdfError> {
        let mut pen = Pen::default();
        let mut rest = d.trim();
        while let Some(command) = rest.chars().next() {
            let (of, after) = rest[command.len_utf8()..].split_at(
                rest[command.len_utf8()..]
                    .find(|c: char| c.is_ascii_alphabetic() && c != 'e')
                    .unwrap_or(rest.len() - command.len_utf8()),
            );
            rest = after;
            let mut numbers = Numbers(of);
            let wrong = || not_ours(format!("the path {command}{of}"));
            if command.eq_ignore_ascii_case(&'z') {
                pen.close();
                continue;
            }
            let mut any = false;
            while let Some(first) = numbers.next() {
                let relative = command.is_ascii_lowercase();
                let [x, y] = if relative { pen.at } else { [0.0; 2] };
                match command.to_ascii_lowercase() {
                    // More pairs after the first are lines.
                    'm' | 'l' => {
                        let to = [x + first, y + numbers.next().ok_or_else(wrong)?];
                        if command.eq_ignore_ascii_case(&'m') && !any { pen.start(to) } else { pen.line(to) }
                    }
                    'h' => pen.line([x + first, pen.at[1]]),
                    'v' => pen.line([pen.at[0], y + first]),
                    'a' => {
                        let mut next = || numbers.next().ok_or_else(wrong);
                        let [other, _, large, sweep, dx, dy] = [next()?, next()?, next()?, next()?, next()?, next()?];
                        if first != other || first <= 0.0 {
                            return Err(wrong());
                        }
                        pen.arc(first, large != 0.0, sweep != 0.0, [x + dx, y + dy]);
                    }
                    _ => return Err(wrong()),
                }
                any = true;
            }
            if !any || !numbers.0.trim().is_empty() {
                return Err(wrong());
            }
        }
        pen.finish();
        Ok(pen.path)
    }

    /// A circle.
    pub(super) fn circle([x, y]: [f64; 2], r: f64) -> Self {
        let mut pen = Pen::default();
        pen.start([x - r, y]);
        pen.arc(r, false, true, [x + r, y]);
        pen.arc(r, false, true, [x - r, y]);
        pen.close();
        pen.finish();
        pen.path
    }
}

/// Constructs a path.
#[derive(Default)]
struct Pen {
    path: Path,
    at: [f64; 2],
    begin: [f64; 2],
    /// Twice the area of the part so far.
    area: f64,
}

impl Pen {
    fn start(&mut self, to: [f64; 2]) {
        self.finish();
        let _ = writeln!(self.path.operators, "{} {} m", short(to[0]), short(to[1]));
        (self.at, self.begin, self.area) = (to, to, 0.0);
    }

    fn line(&mut self, to: [f64; 2]) {
        let _ = writeln!(self.path.operators, "{} {} l", short(to[0]), short(to[1]));
        self.go(to);
    }

    fn go(&mut self, to: [f64; 2]) {
        let [[x0, y0], [x1, y1], [x, y]] = [self.begin, self.at, to];
        self.area += (x1 - x0) * (y - y0) - (x - x0) * (y1 - y0);
        self.at = to;
    }

    fn close(&mut self) {
        self.path.operators.push_str("h\n");
        self.go(self.begin);
    }

    /// Ends a part of the path.
    fn finish(&mut self) {
        self.path.encloses |= self.area.abs() > 1e-6;
    }

    /// An arc of a circle, by pieces of a quarter at most.
    fn arc(&mut self, r: f64, large: bool, sweep: bool, to: [f64; 2]) {
        let ([x0, y0], [x1, y1]) = (self.at, to);
        let (dx, dy) = (x1 - x0, y1 - y0);
        let chord = dx.hypot(dy);
        if !(chord > 0.0) {
            return;
        }
        // Half circles are given with the diameter as their chord, up to rounding.
        let r = r.max(0.5 * chord);
        let off = (r * r - 0.25 * chord * chord).max(0.0).sqrt() * if large == sweep { -1.0 } else { 1.0 };
        let centre = [0.5 * (x0 + x1) - off * dy / chord, 0.5 * (y0 + y1) + off * dx / chord];
        let angle = |[x, y]: [f64; 2]| (y - centre[1]).atan2(x - centre[0]);
        let (from, turn) = (angle(self.at), angle(to) - angle(self.at));
        let turn =
            if sweep { turn.rem_euclid(std::f64::consts::TAU) } else { -(-turn).rem_euclid(std::f64::consts::TAU) };
        let pieces = (turn.abs() / std::f64::consts::FRAC_PI_2 - 1e-9).ceil().max(1.0);
        let step = turn / pieces;
        let handle = 4.0 / 3.0 * (0.25 * step).tan() * r;
        for k in 0..pieces as usize {
            let (a, b) = (from + step * k as f64, from + step * (k + 1) as f64);
            let place = |angle: f64, along: f64| {
                let (sin, cos) = angle.sin_cos();
                [centre[0] + r * cos - along * sin, centre[1] + r * sin + along * cos]
            };
            let points = [place(a, handle), place(b, -handle), place(b, 0.0)];
            for [x, y] in points {
                let _ = write!(self.path.operators, "{} {} ", short(x), short(y));
            }
            self.path.operators.push_str("c\n");
            // Its own bulge, besides the chord.
            self.area += r * r * (step - step.sin());
            self.go(points[2]);
        }
        self.at = to;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_go_where_they_go_in_svg() {
        let path = Path::of("M1 2L3.5-1h2v-.5m1 1l-1 .25z").unwrap();
        assert_eq!(path.operators, "1 2 m\n3.5 -1 l\n5.5 -1 l\n5.5 -1.5 l\n6.5 -0.5 m\n5.5 -0.25 l\nh\n");
        assert!(!Path::of("M0 0h4m0 1v3").unwrap().encloses && Path::of("M0 0h4v3").unwrap().encloses);
        for wrong in ["M1", "M1 2Q3 4", "L", "M1 2 3", "Mx", "M1 2a1 2 0 0 0 1 1"] {
            assert!(Path::of(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn two_half_circles_are_a_circle() {
        let path = Path::of("M-2.6 0a2.6 2.6 0 1 0 5.2 0a2.6 2.6 0 1 0 -5.2 0z").unwrap();
        assert!(path.encloses);
        let mut ends = Vec::new();
        for line in path.operators.lines().filter(|line| line.ends_with('c')) {
            let numbers: Vec<f64> = line.trim_end_matches(" c").split(' ').map(|n| n.parse().unwrap()).collect();
            ends.push([numbers[4], numbers[5]]);
        }
        assert_eq!(ends, [[0.0, 2.6], [2.6, 0.0], [0.0, -2.6], [-2.6, 0.0]]);
    }
}
