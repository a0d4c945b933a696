//! Reads a table of measured motion.

use super::LARGEST_FILE;
use super::columns::Columns;
use super::layout::{ColumnLayout, ColumnSpec};
use super::markers::{MarkerResidual, rigid_fit, size_of};
use super::motion::{Channel, MeasuredMotion, Sign};
use super::table::TextTable;
use std::collections::BTreeSet;
use std::ops::RangeInclusive;
use teeter_scenario::diagnostic::printable;
use teeter_scenario::dimension::Dimension;

/// Fewest rows of a motion: less shows no half-cycle.
const FEWEST: usize = 8;

/// The largest angle accepted, rad: beyond it the unit is wrong.
const LARGEST_ANGLE: f64 = std::f64::consts::PI;

/// Why a table can't be read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeasuredError {
    /// The file is too large.
    #[error("larger than {} MB, the limit of a table", LARGEST_FILE / 1_000_000)]
    TooLarge,
    /// The file isn't text.
    #[error("not a text file in UTF-8: byte {0} is wrong")]
    NotText(usize),
    /// Nothing is in it.
    #[error("the file is empty")]
    Empty,
    /// All lines are skipped.
    #[error("all of its {lines} line{} are skipped: `skip` is the number of lines before the heading", if *.lines == 1 { "" } else { "s" })]
    AllSkipped {
        /// Number of lines of the file.
        lines: usize,
    },
    /// There is a heading only.
    #[error("there is a heading, but no row of numbers")]
    NoRows,
    /// A mistake in a line.
    #[error("line {line}: {what}")]
    Line {
        /// The line, from 1.
        line: usize,
        /// The mistake.
        what: String,
    },
    /// A column is missing or its unit is wrong.
    #[error("{0}")]
    Columns(String),
    /// Too few rows have a value.
    #[error("{channel} has {found} value{}, but a motion needs {FEWEST} or more", if *.found == 1 { "" } else { "s" })]
    TooFew {
        /// The quantity.
        channel: &'static str,
        /// Number of values.
        found: usize,
    },
}

impl MeasuredError {
    pub(super) fn line(line: usize, what: impl Into<String>) -> Self {
        Self::Line { line, what: what.into() }
    }
}

/// A table of measured motion, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    t: Vec<f64>,
    /// The line of each row.
    lines: Vec<usize>,
    channels: Vec<(Channel, Vec<f64>)>,
    markers: Vec<Marker>,
    unread: Vec<String>,
    /// What was read without a unit.
    without_unit: BTreeSet<String>,
}

/// The coordinates of a marker.
#[derive(Clone, Debug, PartialEq)]
struct Marker {
    x: Vec<f64>,
    y: Vec<f64>,
    at: Option<[f64; 2]>,
}

impl Measured {
    /// Reads a table. Of columns named `BLOCK.phi`, as in `trajectory.csv`, those of `block` count.
    ///
    /// # Errors
    /// What is wrong, with the line.
    ///
    /// ```
    /// use teeter_study::measured::{Channel, ColumnLayout, Measured, Sign};
    /// let text: String = (0..20).map(|k| format!("{};{}\n", 6 * k, 20 - k)).collect();
    /// let table = format!("t [ms]; phi [deg]\n{text}");
    /// let motion = Measured::read(table.as_bytes(), &ColumnLayout::default(), "rocker")?.motion(Sign::AsIs);
    /// assert_eq!(motion.t[1], 0.006);
    /// assert_eq!(motion.values(Channel::Phi).map(|phi| phi[0]), Some(20.0_f64.to_radians()));
    /// # Ok::<(), teeter_study::measured::MeasuredError>(())
    /// ```
    pub fn read(bytes: &[u8], layout: &ColumnLayout, block: &str) -> Result<Self, MeasuredError> {
        if bytes.len() > LARGEST_FILE {
            return Err(MeasuredError::TooLarge);
        }
        let text = std::str::from_utf8(bytes).map_err(|error| MeasuredError::NotText(error.valid_up_to()))?;
        if let Some(at) = text.find('\0') {
            return Err(MeasuredError::NotText(at));
        }
        let table = TextTable::split(text, layout.separator, layout.skip)?;
        let columns = Columns::new(&table);
        let t = columns.times(layout, block)?;
        let mut markers = Vec::new();
        for spec in &layout.markers {
            let column = |axis: &ColumnSpec, name: &str| {
                columns.read(axis, &format!("marker.{}.{name}", spec.name), Dimension::LENGTH)
            };
            let (x, mut y) = (column(&spec.x, "x")?, column(&spec.y, "y")?);
            if layout.y_down {
                y.iter_mut().for_each(|y| *y = -*y);
            }
            let marker = Marker { x, y, at: spec.at };
            // By name or by number, the same columns twice: a line without length has no angle.
            if let Some(place) = markers.iter().position(|other: &Marker| other.is_always_at(&marker)) {
                let (first, second) = (&layout.markers[place].name, &spec.name);
                return Err(MeasuredError::Columns(format!(
                    "the markers `{first}` and `{second}` are at the same place in all rows, so that they show no angle: give \
                     each its own columns"
                )));
            }
            markers.push(marker);
        }
        let mut channels = Vec::new();
        for channel in Channel::ALL {
            let from_markers = matches!(channel, Channel::Phi | Channel::X | Channel::Y) && !markers.is_empty();
            let wanted = columns.wanted(layout, channel.word(), block).filter(|_| !from_markers);
            let Some(spec) = wanted else {
                // What is said of a column that isn't read would be lost.
                if layout.columns.contains_key(channel.word()) {
                    let word = channel.word();
                    return Err(match from_markers {
                        true => MeasuredError::Columns(format!(
                            "{word} comes from the markers: leave its column and unit out, and give the markers their own `unit`"
                        )),
                        false => columns.missing(word, word),
                    });
                }
                continue;
            };
            let mut values = columns.read(&spec, channel.word(), channel.dimension())?;
            if layout.y_down && matches!(channel, Channel::Y | Channel::Vy) {
                values.iter_mut().for_each(|y| *y = -*y);
            }
            channels.push((channel, values));
        }
        let lines: Vec<usize> = table.rows.iter().map(|(line, _)| *line).collect();
        leave_out(&layout.leave_out, &lines, &mut channels, &mut markers)?;
        let without_unit = columns.without_unit.take();
        let measured = Self { t, lines, channels, markers, unread: columns.unread(), without_unit };
        measured.check(&columns, block)?;
        Ok(measured)
    }

    /// Whether `t` or a quantity was taken to be in its SI unit, as neither the heading of its column nor the layout gives one.
    #[must_use]
    pub fn is_without_unit(&self, name: &str) -> bool {
        self.without_unit.contains(name)
    }

    fn check(&self, columns: &Columns<'_>, block: &str) -> Result<(), MeasuredError> {
        if self.channels.is_empty() && self.markers.is_empty() {
            let names: Vec<String> = columns.names.iter().map(|(name, _)| format!("`{}`", printable(name))).collect();
            let there = match names.as_slice() {
                [] => format!("the table has {} columns without headings", columns.count()),
                names => format!("the table has {}", names.join(", ")),
            };
            return Err(MeasuredError::Columns(format!(
                "no column of the motion of `{block}` is known: {there}; name it, such as --column phi=2 or --column \
                 phi=\"Angle\""
            )));
        }
        for (channel, values) in &self.channels {
            let found = values.iter().filter(|value| value.is_finite()).count();
            if found < FEWEST {
                return Err(MeasuredError::TooFew { channel: channel.word(), found });
            }
            if let Some(row) = values.iter().position(|phi| *channel == Channel::Phi && phi.abs() > LARGEST_ANGLE) {
                let line = columns.table.rows[row].0;
                // As it is written: in its unit, not in rad.
                let (cell, column) = columns.cell_of(channel.word(), row).unwrap_or_default();
                let told = match self.is_without_unit(channel.word()) {
                    true => format!(
                        "phi = {} rad is more than half a turn; if the angles are in degrees, say so: --unit phi=deg, or \
                         the heading `phi [deg]`",
                        values[row]
                    ),
                    false => format!(
                        "`{}` in column {column} (phi) is more than half a turn; if that frame is wrong, leave it out \
                         (--leave-out {line}), or leave its cell empty",
                        printable(cell)
                    ),
                };
                return Err(MeasuredError::line(line, told));
            }
        }
        let complete = (0..self.t.len()).filter(|&row| self.markers.iter().all(|marker| marker.is_seen(row))).count();
        if !self.markers.is_empty() && complete < FEWEST {
            return Err(MeasuredError::Columns(format!(
                "all markers are seen together in {complete} rows, but a motion needs {FEWEST} or more"
            )));
        }
        Ok(())
    }

    /// The headings of columns that hold none of the quantities known here, and were not read.
    #[must_use]
    pub fn unread(&self) -> &[String] {
        &self.unread
    }

    /// The motion as seen from one side.
    #[must_use]
    pub fn motion(&self, sign: Sign) -> MeasuredMotion {
        let factor = |channel: Channel| if channel.is_mirrored() { sign.factor() } else { 1.0 };
        let turned = |(channel, values): &(Channel, Vec<f64>)| {
            (*channel, values.iter().map(|value| factor(*channel) * value).collect())
        };
        let mut channels: Vec<(Channel, Vec<f64>)> = self.channels.iter().map(turned).collect();
        let (poses, residual, placed) = self.poses(sign);
        if residual.is_some() {
            let of = |pick: &dyn Fn(&[f64; 3]) -> f64| poses.iter().map(pick).collect::<Vec<f64>>();
            channels.push((Channel::Phi, of(&|pose| pose[2])));
            if placed {
                channels.push((Channel::X, of(&|pose| pose[0])));
                channels.push((Channel::Y, of(&|pose| pose[1])));
            }
        }
        channels.sort_by_key(|(channel, _)| *channel);
        let phi_from_first_row = residual.is_some() && !placed;
        let (t, lines) = (self.t.clone(), self.lines.clone());
        MeasuredMotion { t, lines, channels, markers: residual, phi_from_first_row }
    }

    /// x, y and φ of the body in each row by a rigid fit to the markers, NaN in rows where one isn't
    /// seen.
    fn poses(&self, sign: Sign) -> (Vec<[f64; 3]>, Option<MarkerResidual>, bool) {
        let seen = |row: usize| -> Option<Vec<[f64; 2]>> {
            let each = self.markers.iter();
            each.map(|marker| marker.is_seen(row).then(|| [sign.factor() * marker.x[row], marker.y[row]])).collect()
        };
        let given: Option<Vec<[f64; 2]>> = self.markers.iter().map(|marker| marker.at).collect();
        let placed = given.is_some();
        let first = || (0..self.t.len()).find_map(seen);
        let Some(body) = given.filter(|at| !at.is_empty()).or_else(first).filter(|body| body.len() > 1) else {
            return (Vec::new(), None, false);
        };
        let (mut poses, mut sum, mut mirrored, mut count, mut worst) = (Vec::new(), 0.0, 0.0, 0_usize, (0.0, 0.0));
        let mut last = 0.0;
        for row in 0..self.t.len() {
            let Some(points) = seen(row) else {
                poses.push([f64::NAN; 3]);
                continue;
            };
            let pose = rigid_fit(&body, &points);
            let upside_down: Vec<[f64; 2]> = points.iter().map(|[x, y]| [*x, -y]).collect();
            let turned = rigid_fit(&body, &upside_down);
            for (point, place) in upside_down.iter().zip(&body) {
                let at = turned.of(*place);
                mirrored += (point[0] - at[0]).powi(2) + (point[1] - at[1]).powi(2);
            }
            for (point, place) in points.iter().zip(&body) {
                let at = pose.of(*place);
                let off = (point[0] - at[0]).hypot(point[1] - at[1]);
                sum += off * off;
                count += 1;
                if off > worst.0 {
                    worst = (off, self.t[row]);
                }
            }
            // The branch of the angle that is nearest to the row before.
            let phi = pose.phi + std::f64::consts::TAU * ((last - pose.phi) / std::f64::consts::TAU).round();
            last = phi;
            poses.push([pose.origin[0], pose.origin[1], phi]);
        }
        let [rms, mirrored] = [sum, mirrored].map(|sum: f64| (sum / count.max(1) as f64).sqrt());
        let size = size_of(&body);
        let residual = MarkerResidual { markers: body.len(), rms, max: worst.0, t: worst.1, size, mirrored, placed };
        (poses, Some(residual), placed)
    }
}

impl Marker {
    /// Whether another one is at the same place in all rows that have both.
    fn is_always_at(&self, other: &Self) -> bool {
        let same = |row: usize| self.x[row] == other.x[row] && self.y[row] == other.y[row];
        let mut both = (0..self.x.len()).filter(|&row| self.is_seen(row) && other.is_seen(row)).peekable();
        both.peek().is_some() && both.all(same)
    }

    fn is_seen(&self, row: usize) -> bool {
        self.x[row].is_finite() && self.y[row].is_finite()
    }
}

/// Empties the cells of the lines that are left out.
fn leave_out(
    wanted: &[RangeInclusive<usize>],
    lines: &[usize],
    channels: &mut [(Channel, Vec<f64>)],
    markers: &mut [Marker],
) -> Result<(), MeasuredError> {
    for range in wanted {
        let rows =
            lines.partition_point(|line| line < range.start())..lines.partition_point(|line| line <= range.end());
        if rows.is_empty() {
            return Err(MeasuredError::line(*range.start(), "to be left out, but there is no row of numbers"));
        }
        let columns = channels.iter_mut().map(|(_, values)| values);
        let columns = columns.chain(markers.iter_mut().flat_map(|marker| [&mut marker.x, &mut marker.y]));
        columns.for_each(|values| values[rows.clone()].fill(f64::NAN));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measured::line_ranges;

    fn read(text: &str, layout: &ColumnLayout) -> Result<Measured, String> {
        Measured::read(text.as_bytes(), layout, "rocker").map_err(|error| error.to_string())
    }

    fn rows(row: impl Fn(usize) -> String) -> String {
        (0..20).map(|k| row(k) + "\n").collect()
    }

    #[test]
    fn what_contradicts_the_table_is_refused() {
        let unit = |name: &str, unit: &str| {
            let mut layout = ColumnLayout::default();
            layout.set_unit(name, unit).unwrap();
            read(&format!("t [s],phi [deg]\n{}", rows(|k| format!("{k},{}", 20 - k))), &layout)
        };
        assert!(unit("phi", "mrad").unwrap_err().contains("contradicts its heading, which says `deg`"));
        assert!(unit("phi", "deg").is_ok() && unit("t", "ms").unwrap_err().contains("`s`"));
        assert!(unit("x", "mm").unwrap_err().contains("no column `x` for x"));
    }

    #[test]
    fn a_column_of_frames_that_skips_some_is_refused_for_rows_at_a_rate() {
        let layout = ColumnLayout { rate: Some(165.0), ..ColumnLayout::default() };
        let table = |heading: &str, frame: &dyn Fn(usize) -> usize| {
            read(&format!("{heading},phi\n{}", rows(|k| format!("{},0.{k:02}", frame(k)))), &layout)
        };
        let skips = |k: usize| if k < 9 { k } else { k + 4 };
        let error = table("Frame", &skips).unwrap_err();
        assert!(
            error.contains("line 11") && error.contains("goes from 8 to 13") && error.contains("t=\"Frame\""),
            "{error}"
        );
        assert!(table("Frame", &|k| 10 * k).is_ok() && table("x in frame", &skips).is_ok());
    }

    #[test]
    fn frames_and_lost_cells_are_understood() {
        let mut layout = ColumnLayout { rate: Some(165.0), ..ColumnLayout::default() };
        let text = rows(|k| format!("{},{}", 100 + k, if k == 3 { String::new() } else { k.to_string() }));
        layout.set_column("phi", "2").unwrap();
        layout.set_unit("phi", "deg").unwrap();
        layout.set_column("t", "1").unwrap();
        let motion = read(&text, &layout).unwrap().motion(Sign::Reversed);
        assert_eq!(motion.t[2], 102.0 / 165.0);
        let phi = motion.values(Channel::Phi).unwrap();
        assert!(phi[3].is_nan() && (phi[4] + 4.0_f64.to_radians()).abs() < 1e-15);
    }

    #[test]
    fn lines_that_are_left_out_are_lost_frames() {
        let text = format!("t,phi\n{}", rows(|k| format!("{k},0.{k:02}")));
        let leave_out =
            |lines: &str| ColumnLayout { leave_out: line_ranges(lines).unwrap(), ..ColumnLayout::default() };
        let measured = read(&text, &leave_out("4, 10-12")).unwrap();
        assert!(measured.is_without_unit("phi") && measured.is_without_unit("t") && !measured.is_without_unit("x"));
        let motion = measured.motion(Sign::AsIs);
        let phi = motion.values(Channel::Phi).unwrap();
        let lost: Vec<usize> = (0..20).filter(|&row| phi[row].is_nan()).map(|row| motion.lines[row]).collect();
        assert_eq!((lost.as_slice(), motion.t.len()), (&[4, 10, 11, 12][..], 20));
        assert_eq!(read(&text, &leave_out("1")).unwrap_err(), "line 1: to be left out, but there is no row of numbers");
        for wrong in ["", "4;5", "12-10", "-3", "0", "a"] {
            assert!(line_ranges(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn markers_of_the_same_columns_are_refused() {
        let rows: String = (0..20).map(|k| format!("{k},{},{},{},{}\n", 3 * k, 2 * k, 3 * k, 2 * k)).collect();
        let read = |toml: &str| {
            Measured::read(format!("t,ax,ay,bx,by\n{rows}").as_bytes(), &ColumnLayout::read(toml, "l").unwrap(), "b")
        };
        let a = "[marker.a]\nx = \"ax\"\ny = \"ay\"\n";
        let with_b =
            |x: &str, y: &str| read(&format!("{a}[marker.b]\nx = {x}\ny = {y}\n")).map_err(|error| error.to_string());
        let found = with_b("2", "3").unwrap_err();
        assert!(found.contains("column 2 (`ax`) is read both as marker.a.x and as marker.b.x"), "{found}");
        let found = with_b("4", "\"by\"").unwrap_err();
        assert!(found.contains("the markers `a` and `b` are at the same place in all rows"), "{found}");
        assert!(with_b("\"by\"", "\"bx\"").is_ok());
    }

    #[test]
    fn markers_give_position_and_angle_from_both_sides() {
        let toml = "[marker.a]\nx = \"ax\"\ny = \"ay\"\nunit = \"mm\"\nat = [\"-1 cm\", \"2 cm\"]\n\
            [marker.b]\nx = \"bx\"\ny = \"by\"\nunit = \"mm\"\nat = [\"1 cm\", \"3 cm\"]\n";
        let of_pixels = toml.replace("unit = \"mm\"", "unit = \"0.5 mm\"");
        let in_pixels = toml.replace("unit = \"mm\"", "unit = \"px\"");
        let text = "t\tax\tay\tbx\tby\n".to_owned() + &rows(|k| format!("{k}\t{k}\t40\t{}\t60", k + 40));
        let scaled = read(&text, &ColumnLayout::read(&of_pixels, "f").unwrap()).unwrap().motion(Sign::AsIs);
        assert!((scaled.values(Channel::X).unwrap()[7] - 0.0135).abs() < 1e-12, "{:?}", scaled.values(Channel::X));
        let error = read(&text, &ColumnLayout::read(&in_pixels, "f").unwrap()).unwrap_err().to_string();
        assert!(error.ends_with("give the length of a pixel instead, such as unit = \"0.21 mm\""), "{error}");
        let layout = ColumnLayout::read(toml, "f").unwrap();
        for (sign, name) in [(1.0, Sign::AsIs), (-1.0, Sign::Reversed)] {
            let row = |k: usize| {
                let phi: f64 = 0.01 * k as f64;
                let place =
                    |x: f64, y: f64| (40.0 + x * phi.cos() - y * phi.sin(), 70.0 + x * phi.sin() + y * phi.cos());
                let (a, b) = (place(-10.0, 20.0), place(10.0, 30.0));
                format!("{}\t{}\t{}\t{}\t{}", 0.01 * k as f64, sign * a.0, a.1, sign * b.0, b.1)
            };
            let text = format!("t\tax\tay\tbx\tby\n{}", rows(row));
            let motion = read(&text, &layout).unwrap().motion(name);
            let close = |channel, value: f64| (motion.values(channel).unwrap()[7] - value).abs() < 1e-12;
            assert!(close(Channel::Phi, 0.07) && close(Channel::X, 0.04) && close(Channel::Y, 0.07));
            assert!(motion.markers.unwrap().rms < 1e-12);
        }
    }

    #[test]
    fn a_length_in_pixels_is_given_as_the_text_says() {
        let table = format!("t,x [Px],vx [px/s],phi [px]\n{}", rows(|k| format!("{k},{k},{k},0.{k:02}")));
        let of = |units: &[(&str, &str)], columns: &str| {
            let mut layout = ColumnLayout::default();
            units.iter().for_each(|(name, unit)| layout.set_unit(name, unit).unwrap());
            let table: String = table
                .lines()
                .map(|line| line.splitn(5, ',').take(columns.len()).collect::<Vec<_>>().join(",") + "\n")
                .collect();
            read(&table, &layout)
        };
        assert!(of(&[], "tx").unwrap_err().ends_with("such as --unit x=\"0.21 mm\""));
        let x = ("x", "0.21 mm");
        assert!(of(&[x], "txv").unwrap_err().ends_with("such as --unit vx=\"0.21 mm/s\""));
        let vx = ("vx", "0.21 mm/s");
        let motion = of(&[x, vx], "txv").unwrap().motion(Sign::AsIs);
        assert!((motion.values(Channel::Vx).unwrap()[10] - 2.1e-3).abs() < 1e-12);
        assert!(!of(&[x, vx], "txvp").unwrap_err().contains("length of a pixel"), "an angle has none");
    }

    #[test]
    fn a_column_is_named_with_its_unit_or_without() {
        let text = format!(
            "Time [s],Angle [rad],Angle [deg]\n{}",
            rows(|k| format!("{},{},{k}", 0.1 * k as f64, 0.02 * k as f64))
        );
        for (t, phi, exact) in [("time", "angle", 0.14), ("Time [s]", "Angle [deg]", 7_f64.to_radians())] {
            let layout = ColumnLayout::read(&format!("[columns]\nt = \"{t}\"\nphi = \"{phi}\"\n"), "f").unwrap();
            let motion = read(&text, &layout).unwrap().motion(Sign::AsIs);
            assert!((motion.values(Channel::Phi).unwrap()[7] - exact).abs() < 1e-12, "{phi}");
        }
    }

    #[test]
    fn a_column_holds_one_quantity_in_the_unit_of_its_heading() {
        let text = format!("t,phi [deg],y [px]\n{}", rows(|k| format!("{},{k},{k}", 0.1 * k as f64)));
        let message = |columns: &str| read(&text, &ColumnLayout::read(columns, "f").unwrap()).err();
        let twice = "column 2 (`phi [deg]`) is read both as phi and as x: give each its own column";
        assert_eq!(message("[columns]\nx = { column = 2, unit = \"mm\" }\n").as_deref(), Some(twice));
        let contradicts =
            "the unit `mm` of x contradicts its heading, which says `deg`: leave the unit out, or correct the heading";
        let other = "[columns]\nphi = { column = 3, unit = \"deg\" }\nx = { column = 2, unit = \"mm\" }\n";
        assert_eq!(message(other).as_deref(), Some(contradicts));
        let pixels = |size: &str| message(&format!("[columns]\ny = {{ column = 3, unit = \"{size}\" }}\n"));
        assert_eq!(pixels("0.21 mm"), None, "a heading in pixels says nothing of their size");
        assert_eq!(pixels("0 mm").as_deref(), Some("the unit `0 mm` of y has no size: it must be positive"));
        let counted = message("rate = \"10 Hz\"\n[columns]\nt = { column = 1, unit = \"ms\" }\n");
        assert!(counted.unwrap().starts_with("with a rate the rows or frames are counted"));
    }

    #[test]
    fn mistakes_name_the_line() {
        let plain = ColumnLayout::default();
        let message = |text: &str| read(text, &plain).unwrap_err();
        let good = rows(|k| format!("{k},0.1"));
        assert_eq!(message(""), "the file is empty");
        assert_eq!(message("t,phi\n"), "there is a heading, but no row of numbers");
        assert_eq!(message("t,phi\n0,0.1\n"), "phi has 1 value, but a motion needs 8 or more");
        assert_eq!(message(&format!("t,phi\n{good}5,0.1\n")), "line 22: t = 5 s is not after the row before, t = 19 s");
        assert_eq!(
            message(&format!("t,phi [deg]\n{}20,-999\n", rows(|k| format!("{k},5")))),
            "line 22: `-999` in column 2 (phi) is more than half a turn; if that frame is wrong, leave it out (--leave-out 22), \
             or leave its cell empty"
        );
        let skipping = ColumnLayout { skip: 9999, ..ColumnLayout::default() };
        assert_eq!(
            read("t,phi\n0,0.1\n", &skipping).unwrap_err(),
            "all of its 2 lines are skipped: `skip` is the number of lines before the heading"
        );
        assert_eq!(
            message("t,phi\n0,0.1\n1,nan\n"),
            "line 3: `nan` in column 2 (phi) is not a number; leave the cell of a lost frame empty"
        );
        assert_eq!(message("t,phi\n0,0.1\n1\n"), "line 3: 1 column, but the rows before have 2");
        assert!(
            message(&format!("t,angle\n{good}"))
                .starts_with("no column of the motion of `rocker` is known: the table has `t`, `angle`")
        );
        assert!(message(&good).starts_with("the table has 2 columns without headings"));
        assert!(message(&format!("t,phi [kg]\n{good}")).starts_with("the unit `kg` of phi"));
        assert!(
            message(&format!("t,phi\n{}", rows(|k| format!("{k},5"))))
                .starts_with("line 2: phi = 5 rad is more than half a turn")
        );
        assert_eq!(
            Measured::read(b"\xff\xd8\0", &plain, "b").unwrap_err().to_string(),
            "not a text file in UTF-8: byte 0 is wrong"
        );
    }
}
