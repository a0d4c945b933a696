//! What a program that simulates blocks on beams needs, in one line: `use teeter_sim::prelude::*;`.

pub use crate::{At, BeamHandle, BlockHandle, SimError, Simulation, SurfaceHandle, World};
pub use nalgebra::{Vector2, Vector3};
pub use teeter_beam::{Beam, BeamSpec, Damping, Hold, Profile, Section, Support};
pub use teeter_contact::ContactSolver;
pub use teeter_detect::Kinematics;
pub use teeter_integrator::{
    BeamBody, BeamSurface, BlockCoordinate, Ended, Formula, Given, Ground, ImpactLaw, MoreauJean, MoreauJeanClosed,
    MoreauJeanClosedSettings, MoreauJeanSettings, Motion, Observer, PairLaw, Plan, Scheme, Signal, SolverSettings,
    State, StepReport, Unsolved, schemes,
};
pub use teeter_rigid::{MassProperties, Pose, Rectangle};
pub use teeter_solvers::{Auto, plane_solver};
