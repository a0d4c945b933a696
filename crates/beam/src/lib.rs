//! Plane beams by finite elements: statics, dynamics, modes, and the effective inverse mass of a
//! time step.
//!
//! The model, with w the deflection, positive upwards:
//!
//! ```text
//! EI w'''' + c ẇ + ρA ẅ = f(x, t)        semi-discrete:  M q̈ + C q̇ + K q = P(t) + r(t)
//! ```
//!
//! Two-node elements with two dofs a node: w in m, and the rotation of the section in rad, which is
//! w' for Euler–Bernoulli beams (cubic Hermite elements, consistent mass) and a motion of its own
//! for Timoshenko's (exact at the nodes in statics, so without locking). Sections, supports,
//! springs, lumped masses and Winkler foundations anywhere along the span; axial dofs, a given
//! axial force, or ends held along the axis where asked for. x runs from 0 to the span along the
//! beam's own axis: where the beam stands in the world is not its business, nor is contact. SI
//! units throughout.
//!
//! Every vector has [`Beam::dofs`] entries: w and rotation of each node, node by node, then axial
//! dofs if there are any. What a support holds is among them and stays 0.
//!
//! A [`Beam`] is immutable and can be shared by threads. The calls of a time step (products,
//! energies, shape functions, [`Factor::solve`], [`Beam::refactor`]) allocate nothing.
//!
//! # A beam
//!
//! [`BeamSpec`] has its numbers, [`Beam::new`] checks and assembles them. Here a steel tube,
//! clamped at the left, on a spring at the right, with a mass on it:
//!
//! ```
//! use teeter_beam::{Beam, BeamSpec, Hold, Profile, Section, Support};
//!
//! let section = Section::of(Profile::Tube { diameter: 0.1, wall: 0.005 }, 210e9, 7850.0)?;
//! let spring = Hold::Spring { stiffness: 2e4, damping: 0.0 };
//! let right = Support::Elastic { deflection: spring, rotation: Hold::Free };
//! let spec = BeamSpec::new(3.0, 24, section).supported([Support::Clamped, right]).lump(1.5, 10.0, 0.0);
//! let beam = Beam::new(spec)?;
//! assert_eq!(beam.dofs() - beam.free_dofs(), 2);
//! assert!((beam.total_mass() - (3.0 * section.mass_per_length + 10.0)).abs() < 1e-9);
//! # Ok::<(), teeter_beam::BeamError>(())
//! ```
//!
//! # Its deflection under a load
//!
//! Loads are added to a vector of nodal loads, which [`Beam::solve_static`] turns into the
//! deflection under them. Bending moment, transverse force, stress and reactions follow by
//! equilibrium from [`Beam::section_forces`].
//!
//! ```
//! use teeter_beam::{Actions, Beam, BeamSpec, Section, SpanLoad};
//!
//! let beam = Beam::new(BeamSpec::new(2.0, 10, Section::new(5.0, 1.0)?))?; // EI in N m², ρA in kg/m; pinned at both ends
//! let mut q = vec![0.0; beam.dofs()];
//! beam.add_point_load(1.0, -3.0, &mut q)?; // 3 N downwards at x = 1 m
//! beam.solve_static(&mut q)?;
//! let middle = beam.deflection_at(&q, 1.0).ok_or("off the beam")?;
//! assert!((middle.w / (-3.0 * 8.0 / (48.0 * 5.0)) - 1.0).abs() < 1e-13); // P L³/(48 EI)
//!
//! let loads = [SpanLoad::Point { x: 1.0, force: -3.0, couple: 0.0 }];
//! let forces = beam.section_forces(&Actions::at(&q).with_loads(&loads))?;
//! assert!((forces.at(&beam, 1.0)?.moment - 3.0 * 2.0 / 4.0).abs() < 1e-13); // P L/4
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Its frequencies
//!
//! [`Beam::modes`] finds the lowest modes of any beam, [`BeamSpec::circular_frequency`] the exact
//! frequencies of a plain one; [`ModalBasis`] describes a beam by a few of its modes.
//!
//! ```
//! use teeter_beam::{Beam, BeamSpec, Section, Support};
//!
//! let section = Section::rectangle(0.03, 0.001, 210e9, 7850.0)?; // a steel ruler
//! let beam = Beam::new(BeamSpec::new(0.3, 20, section).supported([Support::Clamped, Support::Free]))?;
//! let modes = beam.modes(3)?;
//! for (mode, omega) in (1..).zip(modes.circular_frequencies()) {
//!     assert!((omega / beam.circular_frequency(mode)? - 1.0).abs() < 2e-5); // rad/s; the error falls with l⁴
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Its factor
//!
//! [`Beam::factor`] factorises any weighted sum of M, C and K. That of a θ step of length h gives
//! W = (M + hθC + h²θ²K)⁻¹, the effective inverse mass, which turns impulses into velocities. Steps
//! under a moving force:
//!
//! ```
//! use teeter_beam::{Beam, BeamSpec, Load, MatrixWeights, MovingLoad, Section};
//!
//! let mut spec = BeamSpec::new(0.36, 20, Section::rectangle(0.03, 0.0015, 69e9, 2700.0)?);
//! spec.damping.viscous = spec.viscous_for_ratio(1, 0.01)?;
//! let beam = Beam::new(spec)?;
//! let force = MovingLoad::new(-10.0, 2.0, 0.0)?; // 10 N downwards, at 2 m/s from the left end
//!
//! let (h, theta) = (1e-4, 0.5);
//! let w = beam.factor(MatrixWeights { mass: 1.0, damping: h * theta, stiffness: h * h * theta * theta })?;
//! let (mut q, mut v) = (vec![0.0; beam.dofs()], vec![0.0; beam.dofs()]);
//! let (mut a, mut scratch) = (vec![0.0; beam.dofs()], vec![0.0; beam.dofs()]);
//! for step in 0..900 {
//!     let t = f64::from(step) * h;
//!     // The mean of the load less K(q + hθv) and C v; W makes of it the mean acceleration.
//!     a.fill(0.0);
//!     force.add_mean(&beam, [t, t + h], &mut scratch, &mut a);
//!     beam.add_stiffness_product(-1.0, &q, &mut a);
//!     beam.add_stiffness_product(-h * theta, &v, &mut a);
//!     beam.add_damping_product(-1.0, &v, &mut a);
//!     w.solve(&mut a);
//!     for i in 0..beam.dofs() {
//!         q[i] += h * (v[i] + theta * h * a[i]);
//!         v[i] += h * a[i];
//!     }
//! }
//! let middle = beam.deflection_at(&q, 0.18).ok_or("off the beam")?;
//! assert!(middle.w < -0.015);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The examples of the package draw what they find: a beam over two spans (`two_span`), the first
//! five modes of a cantilever (`modes`), a force that crosses a bridge with the envelope of the
//! bending moment (`moving_load`).
//!
//! # Features
//!
//! - `faer` (default): M, C and K as sparse matrices of [faer](https://docs.rs/faer)
//!   (`Beam::mass_matrix`, `damping_matrix`, `stiffness_matrix`), and [`Backend::Sparse`], its
//!   Cholesky factorisation. The version of faer is `teeter_beam::faer`.
//!
//! Without it the crate needs thiserror only, and builds in about a seventh of the time. All else
//! is there, with the banded factor, which is the faster one at every size;
//! [`Beam::matrix_entries`] gives the matrices entry by entry to any other library.
//!
//! # Limits
//!
//! - Small deflections: the slope should stay below a few hundredths. Stretching is left out but
//!   for [`Axial::Held`].
//! - The error of the assembled matrices grows with the mesh: cond(K) ~ n⁴. [`Beam::solve_static`]
//!   and the products are built to lose less than that; [`Factor::solve`] with little mass in its
//!   weights is not. [`Beam::digits`] tells how much.
//! - A vector of the wrong length is the caller's error: functions that return no `Result` panic on
//!   it, and say so.
//!
//! # Sources
//!
//! - The equation of motion and the θ step: Tutić, Mudrić, Čeh and Arnold 2025, doi
//!   [10.32762/zt.2025.20](https://doi.org/10.32762/zt.2025.20).
//! - The consistent mass: Archer 1963, doi
//!   [10.1061/JSDEAG.0000939](https://doi.org/10.1061/JSDEAG.0000939).
//! - The elements with and without shear: Friedman and Kosmatka 1993, doi
//!   [10.1016/0045-7949(93)90243-7](https://doi.org/10.1016/0045-7949(93)90243-7); shear
//!   coefficients: Cowper 1966, doi [10.1115/1.3625046](https://doi.org/10.1115/1.3625046).
//! - Stretching of a beam held along its axis: Woinowsky-Krieger 1950, J. Appl. Mech. 17, 35–36;
//!   how a time step keeps its energy: after Yang 2016, doi
//!   [10.1016/j.jcp.2016.09.029](https://doi.org/10.1016/j.jcp.2016.09.029).
//! - Modes by subspace iteration: Bathe and Wilson 1973, doi
//!   [10.1002/nme.1620060207](https://doi.org/10.1002/nme.1620060207); static corrections of a
//!   modal basis: MacNeal 1971, doi
//!   [10.1016/0045-7949(71)90031-9](https://doi.org/10.1016/0045-7949(71)90031-9).

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
pub use envelope::{Envelope, EnvelopePlace};
pub use error::{BeamError, CholeskyError, ModalError, ModesError, StaticError};
pub use extremes::DeflectionExtremes;
pub use factor::{Backend, Factor, MatrixWeights};
#[cfg(feature = "faer")]
pub use faer;
pub use forces::{Actions, PeakStress, Reaction, SectionForce, SectionForces, SpanLoad};
pub use load::{DistributedLoad, Load, MovingLoad, NodalLoad};
pub use matrix::MatrixEntry;
pub use mesh::SAME_PLACE;
pub use section::{Profile, Section};
pub use shape::{AxialShape, Deflection, DeflectionBounds, ShapeAt};
pub use spec::{Axial, BeamSpec, Damping, DampingRatio, Foundation, InnerSupport, Lump, MAX_ELEMENTS, Segment};
pub use statics::RigidMotion;
pub use support::{Hold, Support};
