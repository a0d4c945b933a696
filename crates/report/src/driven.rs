//! The prescribed motion of ground and supports: columns of `trajectory.csv`, and plots.

use std::fmt::Write;
use teeter_integrator::{Motion, State};
use teeter_scenario::scene::{MotionScene, Scene};
use teeter_scenario::simulation::Layout;

/// A prescribed coordinate of the ground or of a beam's supports.
#[derive(Debug, Clone)]
pub(crate) struct Driven {
    /// Whose: `ground`, or the beam's name with `.support`.
    pub(crate) name: String,
    /// x, y, or rotation (2).
    pub(crate) component: usize,
    /// Its place in the state.
    index: usize,
    motion: Motion,
}

/// What the coordinates are called, with their velocities and accelerations.
const COLUMNS: [[&str; 3]; 3] = [["x", "vx", "ax"], ["y", "vy", "ay"], ["phi", "omega", "angular_acceleration"]];

impl Driven {
    /// All of a scene: of the ground, then of the beams, in the order of the file.
    pub(crate) fn of(scene: &Scene, layout: &Layout) -> Vec<Self> {
        let of = |name: String, motion: &MotionScene, first: usize| {
            let axes = motion.0.iter().zip(motion.motions()).enumerate();
            let given = axes.filter(|(_, (axis, _))| axis.is_some());
            given
                .map(|(component, (_, motion))| Self {
                    name: name.clone(),
                    component,
                    index: first + component,
                    motion,
                })
                .collect()
        };
        let ground = scene.ground.as_ref().zip(layout.ground.as_ref());
        let mut driven: Vec<Self> =
            ground.map(|(ground, range)| of("ground".to_owned(), &ground.motion, range.start)).unwrap_or_default();
        for (beam, place) in scene.beams.iter().zip(&layout.beams) {
            if let Some(range) = &place.supports {
                driven.extend(of(format!("{}.support", beam.name), &beam.motion, range.start));
            }
        }
        driven
    }

    /// Its displacement, velocity and acceleration: m or rad, and the same over s and s². Ground's rotation has its incline.
    #[inline]
    pub(crate) fn values(&self, state: &State) -> [f64; 3] {
        [state.q[self.index], state.v[self.index], self.motion.acceleration(state.t)]
    }

    /// The same at any time, s, as it is prescribed; without the incline.
    pub(crate) fn prescribed(&self, t: f64) -> [f64; 3] {
        [self.motion.displacement(t), self.motion.velocity(t), self.motion.acceleration(t)]
    }

    /// Appends the names of its columns, each after a comma.
    pub(crate) fn push_header(&self, header: &mut String) {
        for column in COLUMNS[self.component] {
            let _ = write!(header, ",{}.{column}", self.name);
        }
    }
}
