//! Deflections too large for the theory of small slopes.

use std::fmt;
use teeter_beam::{Beam, Dof};
use teeter_text::readable::with_unit;

/// A deflection over this part of the span is large.
pub const LARGE_DEFLECTION: f64 = 0.1;

/// A slope over this is large: the theory neglects its square, here 9 %, against 1.
pub const LARGE_SLOPE: f64 = 0.3;

/// A large deflection or slope.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LargeDeflection {
    /// Where, m from the left end.
    pub x: f64,
    /// Deflection w there, m.
    pub w: f64,
    /// Slope there.
    pub slope: f64,
}

/// The leftmost node at which the deflection or the slope of a beam with coordinates `q` is large;
/// `None` if all are small, or if the coordinates are not those of its nodes.
///
/// ```
/// use teeter_beam::{Beam, BeamSpec, Section};
/// let beam = Beam::new(BeamSpec::new(1.0, 2, Section::new(1.0, 1.0)?))?;
/// let bent = |w| beam.from_nodes(&[[0.0, 0.0], [w, 0.0], [0.0, 0.0]]);
/// assert_eq!(teeter_scenario::deflection::large(&beam, &bent(0.09)?), None);
/// assert_eq!(teeter_scenario::deflection::large(&beam, &bent(-0.11)?).map(|large| large.x), Some(0.5));
/// # Ok::<(), teeter_beam::BeamError>(())
/// ```
#[must_use]
pub fn large(beam: &Beam, q: &[f64]) -> Option<LargeDeflection> {
    if q.len() != beam.dofs() {
        return None;
    }
    let most = LARGE_DEFLECTION * beam.spec().span;
    let value = |node, kind| beam.dof(node, kind).map_or(0.0, |dof| q[dof]);
    let nodes = beam.node_positions().iter().enumerate();
    nodes
        .map(|(node, x)| LargeDeflection { x: *x, w: value(node, Dof::Deflection), slope: value(node, Dof::Slope) })
        .find(|at| at.w.abs() > most || at.slope.abs() > LARGE_SLOPE)
}

impl fmt::Display for LargeDeflection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { x, w, slope } = self;
        write!(
            f,
            "w = {}, slope {slope:.3} at x = {}; the theory is for small slopes, and beyond {LARGE_DEFLECTION} of the span or \
             a slope of {LARGE_SLOPE} not to be trusted",
            with_unit(*w, "m"),
            with_unit(*x, "m")
        )
    }
}
