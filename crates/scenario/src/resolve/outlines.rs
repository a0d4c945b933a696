//! Resolves the shapes of blocks and of their parts: one way to give each, as convex polygons,
//! discs and rounded polygons.

use nalgebra::{Rotation2, Vector2};
use teeter_detect::{Disc, Polygon, Rounded, Shape, ShapeError};

use crate::document::Document;
use crate::value::Item;
use crate::words::{ShapeKind, Word};

/// The keys that give a shape: of the table of a block, or of one of its parts.
#[derive(Clone, Copy)]
pub(super) enum ShapeKeys<'a> {
    /// The table with this path; a voussoir is turned by an angle, rad.
    Block(&'a Document, &'a str, f64),
    /// A part.
    Part(&'a Item),
}

/// What is wrong with a shape: the key, the rule that it breaks, and what would be right.
pub(super) struct Refusal {
    pub(super) key: &'static str,
    pub(super) rule: String,
    pub(super) remedy: String,
}

impl Refusal {
    fn new(key: &'static str, rule: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { key, rule: rule.into(), remedy: remedy.into() }
    }
}

/// A shape in the coordinates in which it is drawn.
pub(super) struct Drawn {
    pub(super) shape: Shape,
    /// Whether it is a rectangle, perhaps with rounded corners.
    pub(super) is_rectangle: bool,
}

/// The ways to give a shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    Sides,
    Points,
    Radius,
    Kind,
    Parts,
}

/// What a block accepts, for messages.
const WAYS: &str = "give one of: width and height, points, radius, shape, parts";

impl<'a> ShapeKeys<'a> {
    fn length(&self, key: &str) -> Option<f64> {
        match self {
            Self::Block(doc, path, _) => doc.quantity(&format!("{path}.{key}")),
            Self::Part(item) => item.number(key),
        }
    }

    fn points(&self) -> Option<&'a [[f64; 2]]> {
        match self {
            Self::Block(doc, path, _) => doc.points(&format!("{path}.points")),
            Self::Part(item) => item.points("points"),
        }
    }

    /// Whether a key is given, validly or not.
    fn is_given(&self, key: &str) -> bool {
        match self {
            Self::Block(doc, path, _) => {
                let path = format!("{path}.{key}");
                doc.is_given(&path) || doc.is_refused(&path) || doc.has_table(&path)
            }
            Self::Part(item) => {
                item.number(key).is_some()
                    || (key == "points" && item.points(key).is_some())
                    || item.item(key).is_some()
            }
        }
    }

    fn kind(&self) -> Option<&'a str> {
        match self {
            Self::Block(doc, path, _) => doc.text(&format!("{path}.shape.kind")),
            Self::Part(item) => item.item("shape")?.text("kind"),
        }
    }

    /// A length or an angle of the shape's own table.
    fn of_kind(&self, key: &'static str) -> Option<f64> {
        match self {
            Self::Block(doc, path, turn) => {
                let given = doc.quantity(&format!("{path}.shape.{key}"))?;
                Some(if matches!(key, "from" | "to") { given + turn } else { given })
            }
            Self::Part(item) => item.item("shape")?.number(key),
        }
    }

    fn sides(&self) -> Option<i64> {
        match self {
            Self::Block(doc, path, _) => doc.integer(&format!("{path}.shape.sides")),
            Self::Part(item) => item.item("shape")?.integer("sides"),
        }
    }

    /// The one way in which the shape is given.
    pub(super) fn way(&self) -> Result<Way, Refusal> {
        let ways = [
            (Way::Parts, "parts"),
            (Way::Points, "points"),
            (Way::Radius, "radius"),
            (Way::Kind, "shape"),
            (Way::Sides, "width"),
            (Way::Sides, "height"),
        ];
        let mut given = ways.into_iter().filter(|(_, key)| self.is_given(key));
        let Some((way, key)) = given.next() else {
            return Err(Refusal::new("", "the shape is missing", WAYS));
        };
        match given.find(|(other, _)| *other != way) {
            Some((_, second)) => Err(Refusal::new(
                second,
                format!("{key} already give{} the shape", if key.ends_with('s') && key != "radius" { "" } else { "s" }),
                WAYS,
            )),
            None => Ok(way),
        }
    }

    /// The shape of that way, which is not by parts; `None` where a value of it was refused before.
    pub(super) fn drawn(&self, way: Way) -> Result<Option<Drawn>, Refusal> {
        let corners: Vec<Vector2<f64>> = match way {
            Way::Parts => return Err(Refusal::new("parts", "a part has no parts of its own", WAYS)),
            Way::Sides => {
                let (Some(width), Some(height)) = (self.length("width"), self.length("height")) else {
                    let key = if self.is_given("width") { "height" } else { "width" };
                    return match self {
                        Self::Part(_) => Err(Refusal::new(key, format!("{key} is missing"), "a rectangle has both")),
                        Self::Block(..) => Ok(None),
                    };
                };
                rectangle(width, height)
            }
            Way::Points => {
                let Some(points) = self.points() else { return Ok(None) };
                points.iter().copied().map(Vector2::from).collect()
            }
            Way::Radius => {
                let Some(radius) = self.length("radius") else { return Ok(None) };
                self.has_no_corners()?;
                return round(Disc::new(Vector2::zeros(), radius).map(Shape::from), "radius");
            }
            Way::Kind => match self.of_its_kind()? {
                Some(OfKind::Corners(corners)) => corners,
                Some(OfKind::Shape(shape)) => {
                    self.has_no_corners()?;
                    return Ok(Some(Drawn { shape, is_rectangle: false }));
                }
                None => return Ok(None),
            },
        };
        let key = if way == Way::Points { "points" } else { "shape" };
        let polygon =
            Polygon::new(corners).map_err(|error| what_is_wrong(key, self.points().unwrap_or(&[]), &error))?;
        let is_rectangle = way == Way::Sides;
        match (self.length("rounding"), self.length("chamfer")) {
            (Some(_), Some(_)) => {
                Err(Refusal::new("chamfer", "the corners are rounded already", "give rounding or chamfer"))
            }
            (Some(radius), None) => match Rounded::inside(&polygon, radius) {
                Ok(rounded) => Ok(Some(Drawn { shape: rounded.into(), is_rectangle })),
                Err(ShapeError::Rounding { most, .. }) => {
                    let rule = format!("a circle of {radius} m doesn't fit into the corners");
                    Err(Refusal::new("rounding", rule, format!("give a radius of less than {} m", few_digits(most))))
                }
                Err(error) => Err(Refusal::new("rounding", error.to_string(), "give a smaller radius")),
            },
            (None, Some(length)) => {
                let shape = chamfered(&polygon, length)?.into();
                Ok(Some(Drawn { shape, is_rectangle: false }))
            }
            (None, None) => Ok(Some(Drawn { shape: polygon.into(), is_rectangle })),
        }
    }

    fn has_no_corners(&self) -> Result<(), Refusal> {
        match ["rounding", "chamfer"].into_iter().find(|key| self.is_given(key)) {
            Some(key) => Err(Refusal::new(key, "the shape has no corners", "leave it out")),
            None => Ok(()),
        }
    }

    /// The shape of a kind.
    fn of_its_kind(&self) -> Result<Option<OfKind>, Refusal> {
        let Some(word) = self.kind() else {
            return match self {
                Self::Part(_) => Err(Refusal::new("shape", "its kind is missing", "such as kind = \"regular\"")),
                Self::Block(..) => Ok(None),
            };
        };
        let Some(kind) = ShapeKind::of(word) else { return Ok(None) };
        let keys: &[&'static str] = match kind {
            ShapeKind::Regular => &["sides", "radius"],
            ShapeKind::Trapezoid => &["bottom", "top", "height"],
            ShapeKind::Voussoir => &["inner", "outer", "from", "to"],
            ShapeKind::Stadium => &["length", "radius"],
        };
        let mut values = [0.0; 4];
        for (value, key) in values.iter_mut().zip(keys) {
            let given = if *key == "sides" { self.sides().map(|sides| sides as f64) } else { self.of_kind(key) };
            let Some(given) = given else {
                let rule = format!("{key} is missing, which a {word} has");
                return match self {
                    Self::Part(_) => Err(Refusal::new("shape", rule, format!("its keys are {}", keys.join(", ")))),
                    Self::Block(..) => Ok(None),
                };
            };
            *value = given;
        }
        let [a, b, c, d] = values;
        Ok(Some(match kind {
            ShapeKind::Regular => {
                // The first side is at the bottom, and level.
                let turn = std::f64::consts::TAU / a;
                let corner = |k: f64| {
                    let (sin, cos) = ((k - 0.5) * turn).sin_cos();
                    Vector2::new(b * sin, -b * cos)
                };
                OfKind::Corners((0..a as usize).map(|k| corner(k as f64)).collect())
            }
            ShapeKind::Trapezoid => {
                let shift = self.of_kind("shift").unwrap_or_default();
                OfKind::Corners(vec![
                    Vector2::new(-0.5 * a, 0.0),
                    Vector2::new(0.5 * a, 0.0),
                    Vector2::new(shift + 0.5 * b, c),
                    Vector2::new(shift - 0.5 * b, c),
                ])
            }
            ShapeKind::Voussoir => {
                if b <= a {
                    let rule = format!("outer is {b} m, but must be more than inner, {a} m");
                    return Err(Refusal::new(
                        "shape",
                        rule,
                        "give the distances of its corners from the arch's centre",
                    ));
                }
                let opens = d - c;
                if !(opens > 0.0 && opens < std::f64::consts::PI) {
                    let rule = format!("it opens by {:.4} deg", opens.to_degrees());
                    let remedy = "from and to are counter-clockwise: to must be larger, by less than 180 deg";
                    return Err(Refusal::new("shape", rule, remedy));
                }
                let at = |radius: f64, angle: f64| radius * Vector2::new(angle.cos(), angle.sin());
                OfKind::Corners(vec![at(a, c), at(b, c), at(b, d), at(a, d)])
            }
            ShapeKind::Stadium => {
                let half = Vector2::new(0.5 * a, 0.0);
                let shape = Rounded::new(vec![-half, half], b)
                    .map_err(|error| Refusal::new("shape", error.to_string(), "give a positive length and radius"))?;
                OfKind::Shape(shape.into())
            }
        }))
    }
}

/// A shape of a kind: by its corners, or one without.
enum OfKind {
    Corners(Vec<Vector2<f64>>),
    Shape(Shape),
}

/// A number with six digits, for messages.
pub(super) fn few_digits(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap_or(x)
}

fn rectangle(width: f64, height: f64) -> Vec<Vector2<f64>> {
    let (x, y) = (0.5 * width, 0.5 * height);
    [[-x, -y], [x, -y], [x, y], [-x, y]].map(Vector2::from).to_vec()
}

fn round(shape: Result<Shape, ShapeError>, key: &'static str) -> Result<Option<Drawn>, Refusal> {
    match shape {
        Ok(shape) => Ok(Some(Drawn { shape, is_rectangle: false })),
        Err(error) => Err(Refusal::new(key, error.to_string(), "give a positive radius")),
    }
}

/// A polygon with a length cut off both sides at each corner.
fn chamfered(polygon: &Polygon, length: f64) -> Result<Polygon, Refusal> {
    let corners = polygon.corners();
    let next = |k: usize| corners[(k + 1) % corners.len()];
    let shortest = (0..corners.len()).map(|k| (next(k) - corners[k]).norm()).fold(f64::INFINITY, f64::min);
    let cut = (0..corners.len()).flat_map(|k| {
        let before = corners[(k + corners.len() - 1) % corners.len()];
        let toward = |other: Vector2<f64>| corners[k] + length * (other - corners[k]).normalize();
        [toward(before), toward(next(k))]
    });
    let refusal = || {
        let rule = format!(
            "it takes {length} m of both ends of each side, of which the shortest has {} m",
            few_digits(shortest)
        );
        Refusal::new("chamfer", rule, format!("give less than {} m", few_digits(0.5 * shortest)))
    };
    if length >= 0.5 * shortest {
        return Err(refusal());
    }
    Polygon::new(cut.collect()).map_err(|_| refusal())
}

/// Turned about the origin of the drawing and moved.
pub(super) fn moved(shape: &Shape, angle: f64, by: Vector2<f64>) -> Result<Shape, ShapeError> {
    let turn = Rotation2::new(angle);
    let place = |corner: &Vector2<f64>| if angle == 0.0 { corner + by } else { turn * corner + by };
    let core: Vec<Vector2<f64>> = shape.core().iter().map(place).collect();
    Ok(match shape {
        Shape::Disc(disc) => Disc::new(core.first().copied().unwrap_or_default(), disc.radius())?.into(),
        Shape::Rounded(rounded) => Rounded::new(core, rounded.radius())?.into(),
        _ => Polygon::new(core)?.into(),
    })
}

/// The largest and the smallest of a shape's extents across its sides, m.
pub(super) fn extents(shape: &Shape) -> [f64; 2] {
    let (core, radius) = (shape.core(), shape.radius());
    if core.len() == 1 {
        return [2.0 * radius; 2];
    }
    let across = |k: usize| {
        let side = (core[(k + 1) % core.len()] - core[k]).normalize();
        core.iter().map(|corner| side.perp(&(corner - core[k]))).fold(0.0, f64::max)
    };
    let all = (0..core.len()).map(across);
    let [large, small] = all.fold([0.0_f64, f64::INFINITY], |[large, small], x| [large.max(x), small.min(x)]);
    let large = if core.len() == 2 { (core[1] - core[0]).norm() } else { large };
    [large + 2.0 * radius, small + 2.0 * radius]
}

/// Why points are no convex polygon, in their own numbers, and what would be right.
fn what_is_wrong(key: &'static str, points: &[[f64; 2]], error: &ShapeError) -> Refusal {
    let at = |k: usize| Vector2::from(points[k % points.len()]);
    let n = points.len();
    match *error {
        ShapeError::Twice { corner } if n > 0 => {
            let rule = format!("points {} and {} are in the same place", corner + 1, (corner + 1) % n + 1);
            Refusal::new(key, rule, "leave one of them out")
        }
        ShapeError::NotConvex { corner } if n > 0 => {
            let size = (0..n).map(|k| (at(k) - at(0)).norm()).fold(0.0, f64::max);
            let furthest =
                (0..n).max_by(|a, b| (at(*a) - at(0)).norm().total_cmp(&(at(*b) - at(0)).norm())).unwrap_or(0);
            let line = at(furthest) - at(0);
            if (0..n).all(|k| line.perp(&(at(k) - at(0))).abs() <= ON_LINE * size * size) {
                let remedy = "a polygon has an area: move a point off that line";
                return Refusal::new(key, "all points are on one line", remedy);
            }
            if let Some([a, b]) = crossing(n, at) {
                let rule = format!("the sides from point {} and from point {} cross", a + 1, b + 1);
                return Refusal::new(key, rule, "give the corners in order around the polygon");
            }
            let (before, after) = (at(corner) - at(corner + n - 1), at(corner + 1) - at(corner));
            if before.perp(&after).abs() <= ON_LINE * size * size {
                let rule =
                    format!("point {} is on the line between its neighbours: the polygon goes straight on", corner + 1);
                return Refusal::new(key, rule, "leave it out");
            }
            let rule = format!("at point {} the polygon turns inwards", corner + 1);
            Refusal::new(key, rule, "give the corners of a convex polygon, or several convex parts")
        }
        _ => {
            Refusal::new(key, error.to_string(), "give at least three corners of a convex polygon, in order around it")
        }
    }
}

/// Points this far from a line, relative to the size of the polygon, are on it.
const ON_LINE: f64 = 1e-9;

/// The first two sides that cross, by the numbers of their first points.
fn crossing(n: usize, at: impl Fn(usize) -> Vector2<f64>) -> Option<[usize; 2]> {
    let parts = |a: usize, b: usize| {
        let side = at(a + 1) - at(a);
        side.perp(&(at(b) - at(a))) * side.perp(&(at(b + 1) - at(a))) < 0.0
    };
    let pairs = (0..n).flat_map(|a| (a + 1..n).map(move |b| [a, b]));
    let mut crossing = pairs.filter(|&[a, b]| parts(a, b) && parts(b, a));
    crossing.next()
}
