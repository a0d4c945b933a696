//! Beams that never move.

use super::{InitialMotion, Removed};
use nalgebra::Vector2;
use teeter_beam::{Beam, DeflectionExtremes};
use teeter_detect::Frame;
use teeter_integrator::{BeamFace, Bodies, Compliance, Dynamics, Energy, FactorError, Rows, Size, Traits, Weights};
use teeter_text::readable::{with_digits, with_unit};

/// A beam that stays in its initial state unless something touches it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BeamAtRest {
    /// Its energy.
    pub(super) energy: Energy,
    /// Its motion due to rounding in the full model, m; 0 if its forces are exactly 0.
    pub(super) trembles: f64,
    /// Its deflection, including between its nodes.
    pub(super) shape: DeflectionExtremes,
}

/// Rounding motion over this fraction of the deflection is too large.
const ROUNDING: f64 = 1e-9;

/// Rounding motion is bounded by this many times the deflection due to the rounding of the forces
/// in one step, or by the number of steps if that is more: the contributions of steps add up, in
/// the worst case in phase with a mode.
const STEPS_ADD: f64 = 1e3;

impl BeamAtRest {
    /// The rest state of a beam, by its number, in a run of `steps` steps; `None` for one that
    /// moves.
    pub(super) fn of(start: &InitialMotion<'_>, beam: usize, steps: u64) -> Option<Self> {
        let place = &start.layout.beams[beam];
        let (_, part, _) = start.model.owner(place.body)?;
        let system = &part.system;
        let (q, v) = (&start.q[part.q.clone()], &start.v[part.v.clone()]);
        let Traits { loaded, driven, held, .. } = system.traits();
        if loaded || !driven.is_empty() || v.iter().any(|v| *v != 0.0) {
            return None;
        }
        let mut force = vec![0.0; v.len()];
        system.internal_force(q, v, &mut force);
        held.iter().for_each(|k| force[*k] = 0.0);
        let energy = system.energy(q, v);
        if force.iter().all(|f| *f == 0.0) && q.iter().all(|q| *q == 0.0) {
            return Some(Self { energy, trembles: 0.0, shape: DeflectionExtremes::default() });
        }
        // For θ < ½ rounding grows from step to step.
        if place.basis.is_some() || place.beam.is_stretched() || start.scene.time.theta < 0.5 {
            return None;
        }
        place.beam.solve_static(&mut force).ok()?;
        let (trembles, shape) =
            (STEPS_ADD.max(steps as f64) * size(&place.beam, &force), place.beam.deflection_extremes(q));
        (trembles <= ROUNDING * shape.largest()).then_some(Self { energy, trembles, shape })
    }

    pub(super) fn removed(&self, name: &str) -> Removed {
        let deflection = self.shape.largest();
        let (why, accuracy) = if deflection == 0.0 {
            (
                "nothing touches, loads or drives it, and it starts undeformed and at rest, so no force acts on it"
                    .to_owned(),
                None,
            )
        } else {
            (
                format!(
                    "nothing touches or drives it, and it starts in equilibrium, deflected by {}, so its forces are 0 to rounding",
                    with_unit(deflection, "m")
                ),
                Some(format!(
                    "{}, a thousand times its deflection due to the rounding of its forces",
                    with_digits(self.trembles, "m", 2)
                )),
            )
        };
        Removed { what: format!("beam `{name}`: its motion"), why, accuracy }
    }
}

/// A bound on the displacement of any point of a beam, m, transverse or axial: from all its dofs,
/// so that it is 0 only for the straight beam. In an element of length l the shape functions of the
/// two w sum to 1, those of the two rotations to l/4 at most.
fn size(beam: &Beam, q: &[f64]) -> f64 {
    let longest = beam.node_positions().windows(2).map(|ends| ends[1] - ends[0]).fold(0.0, f64::max);
    let [w, rotation] =
        beam.to_nodes(q).iter().fold([0.0_f64; 2], |[w, r], node| [w.max(node[0].abs()), r.max(node[1].abs())]);
    let along = q[2 * beam.node_positions().len()..].iter().fold(0.0_f64, |most, u| most.max(u.abs()));
    w + 0.25 * longest * rotation + along
}

/// A beam at rest: it has coordinates in the state and bodies, but takes no part in any step.
#[derive(Debug)]
pub(crate) struct RestingBody {
    held: Vec<usize>,
    energy: Energy,
}

impl RestingBody {
    /// A body with this number of coordinates.
    pub(crate) fn new(coordinates: usize, energy: Energy) -> Self {
        Self { held: (0..coordinates).collect(), energy }
    }
}

impl Dynamics<2> for RestingBody {
    fn size(&self) -> Size {
        Size { q: self.held.len(), v: self.held.len(), bodies: BeamFace::BODIES, row: 0 }
    }

    fn internal_force(&self, _q: &[f64], _v: &[f64], _f: &mut [f64]) {}

    fn apply(&self, _w: Weights, _q: &[f64], _x: &[f64], _y: &mut [f64]) {}

    fn energy(&self, _q: &[f64], _v: &[f64]) -> Energy {
        self.energy
    }

    fn factor(&self, w: Weights, _q: &[f64]) -> Result<Box<dyn Compliance<2>>, FactorError> {
        Ok(Box::new(ZeroCompliance(w)))
    }
}

impl Bodies<2> for RestingBody {
    /// No contact refers to its points.
    fn place(&self, _body: u32, _q: &[f64], local: &[Vector2<f64>], out: &mut [Vector2<f64>]) {
        out.copy_from_slice(local);
    }

    fn fastest(&self, _: &[f64]) -> f64 {
        0.0
    }

    fn rows(&self, _: u32, _: &[f64], _: &Vector2<f64>, _: &Frame<2>, _: &mut Rows<'_, 2>) -> usize {
        0
    }
}

/// W = 0.
struct ZeroCompliance(Weights);

impl Compliance<2> for ZeroCompliance {
    fn weights(&self) -> Weights {
        self.0
    }

    fn refactor(&mut self, w: Weights, _q: &[f64]) -> Result<(), FactorError> {
        self.0 = w;
        Ok(())
    }

    fn solve(&mut self, f: &mut [f64]) {
        f.fill(0.0);
    }
}
