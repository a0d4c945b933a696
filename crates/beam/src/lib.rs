//! Plane beams by finite elements: statics, dynamics, modes, and the effective inverse mass of a time step.
//!
//! The model (`docs/theory.md` §1), with w the deflection, positive upwards:
//!
//! ```text
//! EI w'''' + c ẇ + ρA ẅ = f(x, t)        semi-discrete:  M q̈ + C q̇ + K q = P(t) + r(t)
//! ```
//!
//! Two-node elements with two dofs a node: w in m, and the rotation of the section in rad, which is w' for Euler–Bernoulli beams
//! (cubic Hermite elements, consistent mass) and a motion of its own for Timoshenko's (exact at the nodes in statics, so without
//! locking). Sections, supports, springs, lumped masses and Winkler foundations anywhere along the span; axial dofs, a given axial force,
//! or ends held along the axis where asked for. x runs from 0 to the span along the beam's own axis: where the beam stands in
//! the world is not its business, nor is contact. SI units throughout.
//!
//! Every vector has [`Beam::dofs`] entries: w and rotation of each node, node by node, then axial dofs if there are any. What a
//! support holds is among them and stays 0.
//!
//! A [`Beam`] is immutable and can be shared by threads. The calls of a time step (products, energies, shape functions,
//! [`Factor::solve`], [`Beam::refactor`]) allocate nothing.
//!
//! # Example
//!
//! One step of the θ scheme (`docs/theory.md` §5, θ = ½) under a moving force:
//!
//! ```
//! use teeter_beam::{Beam, BeamSpec, Load, MatrixWeights, MovingLoad, Section};
//!
//! let mut spec = BeamSpec::new(0.36, 20, Section::rectangle(0.03, 0.0015, 69e9, 2700.0)?);
//! spec.damping.viscous = spec.viscous_for_ratio(1, 0.01)?;
//! let beam = Beam::new(spec)?;
//! let load = MovingLoad::new(-10.0, 2.0, 0.0)?;
//!
//! let (h, theta) = (1e-4, 0.5);
//! let w = beam.factor(MatrixWeights { mass: 1.0, damping: h * theta, stiffness: h * h * theta * theta })?;
//! let (mut q, mut v) = (vec![0.0; beam.dofs()], vec![0.0; beam.dofs()]);
//! let mut dv = vec![0.0; beam.dofs()];
//! for step in 0..900 {
//!     let t = f64::from(step) * h;
//!     dv.fill(0.0);
//!     load.add(&beam, t, &mut dv);
//!     let p0 = dv.clone();
//!     dv.fill(0.0);
//!     load.add(&beam, t + h, &mut dv);
//!     dv.iter_mut().zip(&p0).for_each(|(p1, p0)| *p1 = theta * *p1 + (1.0 - theta) * p0);
//!     beam.add_stiffness_product(-1.0, &q, &mut dv);
//!     beam.add_stiffness_product(-h * theta, &v, &mut dv);
//!     beam.add_damping_product(-1.0, &v, &mut dv);
//!     w.solve(&mut dv);
//!     for i in 0..beam.dofs() {
//!         let v1 = v[i] + h * dv[i];
//!         q[i] += h * (theta * v1 + (1.0 - theta) * v[i]);
//!         v[i] = v1;
//!     }
//! }
//! let mid = beam.deflection_at(&q, 0.18).ok_or("off the beam")?;
//! assert!(mid.w < -0.015);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Three programs in `examples/` draw what they find: a beam over two spans (`two_span`), the first five modes of a cantilever
//! (`modes`), a force that crosses a bridge with the envelope of the bending moment (`moving_load`). What to model how, and how fine
//! a mesh should be: `docs/beams.md`.
//!
//! # Limits
//!
//! - Small deflections: the slope should stay below a few hundredths. Stretching is left out but for [`Axial::Held`].
//! - The error of the assembled matrices grows with the mesh: cond(K) ~ n⁴. [`Beam::solve_static`] and the products are
//!   built to lose less than that; [`Factor::solve`] with little mass in its weights is not. [`Beam::digits`] tells how much.
//! - A vector of the wrong length is the caller's error: functions that return no `Result` panic on it, and say so.

#![cfg_attr(docsrs, feature(doc_cfg))]

mod assembly;
mod band;
mod bar;
mod basis;
mod beam;
mod blocks;
mod digits;
mod eigen;
mod element;
mod envelope;
mod error;
mod extremes;
mod factor;
mod field;
mod forces;
mod load;
mod matrix;
mod membrane;
mod mesh;
mod modal_damping;
mod modes;
mod product;
mod section;
mod shape;
#[cfg(feature = "faer")]
mod sparse;
mod spec;
mod statics;
mod support;
mod under_load;

pub use basis::ModalBasis;
pub use beam::{Beam, Dof};
pub use digits::Digits;
pub use eigen::Modes;
pub use envelope::Envelope;
pub use error::{BeamError, FactorError, ModalError, ModesError, StaticError};
pub use extremes::DeflectionExtremes;
pub use factor::{Backend, Factor, MatrixWeights};
#[cfg(feature = "faer")]
pub use faer;
pub use forces::{Actions, PeakStress, Reaction, SectionForce, SectionForces, SpanLoad};
pub use load::{DistributedLoad, Load, MovingLoad, NodalLoad};
pub use matrix::MatrixEntry;
pub use section::{Profile, Section};
pub use shape::{AxialShape, Deflection, DeflectionBounds, ShapeAt};
pub use spec::{Axial, BeamSpec, Damping, DampingRatio, Foundation, InnerSupport, Lump, MAX_ELEMENTS, Segment};
pub use statics::RigidMotion;
pub use support::{Hold, Support};
