//! The compression under which a beam has no stiffness left.

use crate::case::{Case, Check, Depth, Findings, Result};
use crate::cases::beam_supports::support;
use crate::exact::beams::axial_force::buckling_load;
use crate::exact::beams::ends::{CLAMPED, FREE, GUIDED, PINNED};
use crate::exact::root::boundary;
use crate::fit::power_law;
use teeter_beam::{Beam, BeamSpec, MatrixWeights, Section};

pub(crate) struct BeamBuckling;

const SPAN: f64 = 0.37;
const STIFFNESS: f64 = 0.58;

/// Coarse: the error is (π/n)⁴/720 for a pinned beam, and rounding moves the pivot of 32 elements by some 1e-11 only.
const MESHES: [usize; 5] = [6, 8, 12, 16, 24];

impl Case for BeamBuckling {
    fn name(&self) -> &'static str {
        "beam_buckling"
    }

    fn about(&self) -> &'static str {
        "The least compression for which K has a pivot that isn't positive, by bisection with the factorisation, \
         compared with Euler's loads of the four columns and two with a guided end. Cubic elements with the \
         consistent geometric stiffness have order 4."
    }

    fn run(&self, _: Depth) -> Result<Findings> {
        let mut findings = Findings::default();
        for (name, ends) in [
            ("pinned–pinned", [PINNED, PINNED]),
            ("clamped–clamped", [CLAMPED, CLAMPED]),
            ("clamped–free", [CLAMPED, FREE]),
            ("clamped–pinned", [CLAMPED, PINNED]),
            ("clamped–guided", [CLAMPED, GUIDED]),
            ("pinned–guided", [PINNED, GUIDED]),
        ] {
            let exact = buckling_load(SPAN, STIFFNESS, ends).ok_or("ends without a buckling load")?;
            let section = Section::new(STIFFNESS, 0.12)?;
            let mut points = Vec::new();
            let mut finest = f64::NAN;
            for elements in MESHES {
                let spec = BeamSpec::new(SPAN, elements, section).supported(ends.map(support));
                let beam = |load: f64| Beam::new(spec.clone().axial_force(-load));
                // So that an error here isn't taken for buckling below.
                beam(exact)?;
                let stiffness = MatrixWeights { mass: 0.0, damping: 0.0, stiffness: 1.0 };
                let buckles = |load: f64| beam(load).is_ok_and(|beam| beam.factor(stiffness).is_err());
                finest = boundary(0.5 * exact, 1.5 * exact, buckles);
                points.push((1.0 / elements as f64, finest / exact - 1.0));
            }
            let order = power_law(&points).order;
            findings.checks.push(Check::between(format!("{name}: order in the element length"), 4.0, order, 3.9, 4.1));
            // Twice a half wave between clamped ends: (2π/24)⁴/720.
            findings.checks.push(Check::relative(format!("{name}: 24 elements, N, relative"), exact, finest, 6.6e-6));
        }
        Ok(findings)
    }
}
