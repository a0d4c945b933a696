//! What the beam has to bear inside: bending moment, shear force, stress, and what its supports
//! bear.
//!
//! Not from derivatives of the deflection, which lose two orders, but from equilibrium: an
//! element's end forces are K_e q_e + C_e v_e + M_e a_e − P_e with all that acts on it, and between
//! the ends the load itself is integrated. In statics that is exact at every place; in a time step
//! of the θ scheme, with q_θ, v_θ and a = Δv/h, the end forces of all elements, the loads and the
//! reactions balance to rounding.
//!
//! Signs: M = EI w'' (with shear EI ψ'), positive where the lower fibre is pulled; V = M', positive
//! where the part to the left of a cut pushes the part to the right upwards. So V' = f for a load f
//! upwards, and a clamped beam under its weight has M < 0 at its ends. Of a beam under an axial
//! force N the transverse force V includes N w'.

mod stress;

pub use stress::PeakStress;

use crate::beam::Beam;
use crate::error::{BeamError, check, check_len};
use crate::membrane::Membrane;

/// A load on the beam, upwards positive.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum SpanLoad {
    /// At a place.
    Point {
        /// Where, m.
        x: f64,
        /// Force, N.
        force: f64,
        /// Couple, N m, counter-clockwise.
        couple: f64,
    },
    /// The same all along a part.
    Uniform {
        /// Its left end, m.
        from: f64,
        /// Its right end, m.
        to: f64,
        /// Load per length, N/m.
        load: f64,
    },
    /// The weight of the beam and of what it carries, by the acceleration of gravity in the
    /// direction of w, m/s².
    Weight {
        /// Upwards positive.
        gravity: f64,
    },
}

/// The state that section forces are asked for.
#[derive(Debug, Clone, Copy, Default)]
#[non_exhaustive]
pub struct Actions<'a> {
    /// Deflection, as every vector.
    pub q: &'a [f64],
    /// Velocity; empty for a beam at rest.
    pub velocity: &'a [f64],
    /// Acceleration; empty for none. That of the supports, where they move, belongs to it.
    pub acceleration: &'a [f64],
    /// All loads but those of supports.
    pub loads: &'a [SpanLoad],
    /// Of a beam held along its axis, in a time step: what the step took for the axial force that the
    /// deflection adds, N; EA/(4L) (s⁰ + s¹) with s = ∫w'² dx at both ends of a θ step. `None`: that
    /// of `q`.
    pub tension: Option<f64>,
}

impl<'a> Actions<'a> {
    /// A beam at rest with the deflection `q`, as long as every vector, and no loads.
    #[must_use]
    pub fn at(q: &'a [f64]) -> Self {
        Self { q, ..Self::default() }
    }

    /// With this velocity.
    #[must_use]
    pub fn with_velocity(self, velocity: &'a [f64]) -> Self {
        Self { velocity, ..self }
    }

    /// With this acceleration, that of moving supports included.
    #[must_use]
    pub fn with_acceleration(self, acceleration: &'a [f64]) -> Self {
        Self { acceleration, ..self }
    }

    /// With these loads, all but those of supports.
    #[must_use]
    pub fn with_loads(self, loads: &'a [SpanLoad]) -> Self {
        Self { loads, ..self }
    }

    /// With what a time step took for the axial force that the deflection adds, N; `None`: that of the
    /// deflection.
    #[must_use]
    pub fn with_tension(self, tension: Option<f64>) -> Self {
        Self { tension, ..self }
    }
}

/// What a support bears: the force and the couple of the support on the beam.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Reaction {
    /// Where, m.
    pub x: f64,
    /// Force, N, upwards.
    pub force: f64,
    /// Couple, N m, counter-clockwise.
    pub couple: f64,
}

/// Moment and shear at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct SectionForce {
    /// Bending moment M, N m.
    pub moment: f64,
    /// Transverse force V, N.
    pub shear: f64,
}

/// The section forces of a beam, in memory that is kept: [`SectionForces::update`] allocates
/// nothing unless there are more point loads than ever before.
#[derive(Debug, Clone, Default)]
pub struct SectionForces {
    /// By elements: V and M at the left end, V and M at the right end.
    ends: Vec<[f64; 4]>,
    /// Loads inside elements: element, ξ, force, couple.
    inside: Vec<(usize, f64, f64, f64)>,
    /// Uniform loads that cover a part of an element: element, ξ from and to, N/m.
    parts: Vec<(usize, [f64; 2], f64)>,
    reactions: Vec<Reaction>,
    axial: Vec<f64>,
    /// M⁻¹C v of the damping ratios of modes.
    deceleration: Vec<f64>,
}

/// A load this near to a node (in lengths of the element) is at the node.
const AT_NODE: f64 = 1e-9;

impl SectionForces {
    /// No forces yet, with room for those of a beam.
    #[must_use]
    pub fn new(beam: &Beam) -> Self {
        let borne = (0..beam.nodes()).filter(|node| beam.bears(*node)).count();
        Self {
            ends: vec![[0.0; 4]; beam.elements()],
            inside: Vec::with_capacity(16),
            parts: Vec::with_capacity(16),
            reactions: Vec::with_capacity(borne),
            axial: vec![beam.spec.axial_force; beam.elements()],
            deceleration: vec![0.0; if beam.modal.is_some() { beam.dofs() } else { 0 }],
        }
    }

    /// Becomes the section forces of a beam in a state.
    ///
    /// # Errors
    /// [`BeamError::Length`] for vectors of another length; [`BeamError::OutsideSpan`] for a load
    /// that is not on the beam.
    pub fn update(&mut self, beam: &Beam, actions: &Actions<'_>) -> Result<(), BeamError> {
        let dofs = beam.dofs();
        check_len("q", dofs, actions.q.len())?;
        for (name, vector) in [("velocity", actions.velocity), ("acceleration", actions.acceleration)] {
            if !vector.is_empty() {
                check_len(name, dofs, vector.len())?;
            }
        }
        if let Some(tension) = actions.tension {
            check("tension", tension, true, "finite")?;
        }
        self.elastic_forces(beam, actions);
        self.inside.clear();
        self.parts.clear();
        for load in actions.loads {
            self.take_off(beam, load)?;
        }
        self.react(beam, actions);
        // From forces on the ends to section forces: V and −M on the left one, −V and M on the
        // right one.
        for end in &mut self.ends {
            *end = [end[0], -end[1], -end[2], end[3]];
        }
        Ok(())
    }

    /// K_e q_e + C_e v_e + M_e a_e.
    fn elastic_forces(&mut self, beam: &Beam, actions: &Actions<'_>) {
        let q = beam.bend(actions.q);
        let tension = |membrane: &Membrane| actions.tension.unwrap_or_else(|| membrane.force(q));
        let stretching = beam.membrane.as_ref().map(|membrane| (membrane, tension(membrane)));
        let damping = &beam.spec.damping;
        self.deceleration.fill(0.0);
        if let (Some(modal), false) = (&beam.modal, actions.velocity.is_empty()) {
            self.deceleration.resize(beam.dofs(), 0.0);
            modal.add_deceleration(actions.velocity, &mut self.deceleration);
        }
        let add = |end: &mut [f64; 4], factor: f64, forces: [f64; 4]| {
            end.iter_mut().zip(forces).for_each(|(end, force)| *end += factor * force);
        };
        self.ends.resize(beam.elements(), [0.0; 4]);
        for (e, end) in self.ends.iter_mut().enumerate() {
            *end = beam.bending.on_nodes(e, q);
            if let Some(foundation) = &beam.foundation {
                add(end, 1.0, foundation.on_nodes(e, q));
            }
            if let Some((membrane, force)) = stretching {
                add(end, force, membrane.slopes.on_nodes(e, q));
            }
            if !actions.velocity.is_empty() && beam.is_damped() {
                let v = beam.bend(actions.velocity);
                add(end, beam.damping_of_mass, beam.mass.on_nodes(e, v));
                if let Some(residual) = &beam.residual_damping {
                    add(end, 1.0, residual.on_nodes(e, v));
                }
                if damping.rayleigh_stiffness != 0.0 {
                    add(end, damping.rayleigh_stiffness, beam.bending.on_nodes(e, v));
                    if let Some(foundation) = &beam.foundation {
                        add(end, damping.rayleigh_stiffness, foundation.on_nodes(e, v));
                    }
                }
            }
            if !self.deceleration.is_empty() {
                add(end, 1.0, beam.mass.on_nodes(e, beam.bend(&self.deceleration)));
            }
            if !actions.acceleration.is_empty() {
                add(end, 1.0, beam.mass.on_nodes(e, beam.bend(actions.acceleration)));
            }
        }
        let common = beam.spec.axial_force + stretching.map_or(0.0, |(_, force)| force);
        self.axial.clear();
        self.axial.resize(beam.elements(), common);
        if let Some(bar) = &beam.bar {
            let forces = bar.forces(&actions.q[2 * beam.nodes()..]);
            self.axial.iter_mut().zip(forces).for_each(|(axial, force)| *axial += force);
        }
    }

    /// Takes a load's share off the end forces of the elements that it is on.
    fn take_off(&mut self, beam: &Beam, load: &SpanLoad) -> Result<(), BeamError> {
        let span = beam.spec.span;
        let on_beam = |x: f64| if (0.0..=span).contains(&x) { Ok(x) } else { Err(BeamError::OutsideSpan { x, span }) };
        match *load {
            SpanLoad::Point { x, force, couple } => {
                check("force", force, true, "finite")?;
                check("couple", couple, true, "finite")?;
                let (e, xi) = beam.mesh.locate(on_beam(x)?);
                // At a node it is a jump between two elements and in neither.
                if xi > AT_NODE && xi < 1.0 - AT_NODE {
                    let element = &beam.elements[e];
                    let (n, dn) = (element.shape(xi), element.rotation(xi));
                    for (end, (n, dn)) in self.ends[e].iter_mut().zip(n.into_iter().zip(dn)) {
                        *end -= force * n + couple * dn;
                    }
                    self.inside.push((e, xi, force, couple));
                }
            }
            SpanLoad::Uniform { from, to, load } => {
                check("load", load, true, "finite")?;
                let (from, to) = (on_beam(from)?, on_beam(to)?);
                for (e, end) in self.ends.iter_mut().enumerate() {
                    let (left, length) = (beam.mesh.x[e], beam.elements[e].length);
                    let part = [(from - left) / length, (to - left) / length].map(|xi| xi.clamp(0.0, 1.0));
                    if part[1] > part[0] {
                        let share = beam.elements[e].partial_load(part);
                        end.iter_mut().zip(share).for_each(|(end, share)| *end -= load * share);
                        if part != [0.0, 1.0] {
                            self.parts.push((e, part, load));
                        }
                    }
                }
            }
            SpanLoad::Weight { gravity } => {
                check("gravity", gravity, true, "finite")?;
                for (end, element) in self.ends.iter_mut().zip(&beam.elements) {
                    let load = gravity * element.section.mass_per_length;
                    end.iter_mut().zip(element.uniform_load()).for_each(|(end, share)| *end -= load * share);
                }
            }
        }
        Ok(())
    }

    /// What supports bear: what the elements at their nodes, masses and loads there leave over.
    fn react(&mut self, beam: &Beam, actions: &Actions<'_>) {
        let spring = |entries: &[(usize, f64)], x: &[f64], dof: usize| -> f64 {
            let of_dof = entries.iter().filter(|(own, _)| *own == dof);
            if x.is_empty() { 0.0 } else { of_dof.map(|(_, value)| value * x[dof]).sum() }
        };
        self.reactions.clear();
        for node in (0..beam.nodes()).filter(|node| beam.bears(*node)) {
            let x = beam.mesh.x[node];
            let mut borne = [0.0; 2];
            for (i, borne) in borne.iter_mut().enumerate() {
                let dof = 2 * node + i;
                if beam.held[node][i] {
                    let from_left = if node > 0 { self.ends[node - 1][2 + i] } else { 0.0 };
                    let from_right = if node < beam.elements() { self.ends[node][i] } else { 0.0 };
                    *borne = from_left + from_right + spring(&beam.lumps, actions.acceleration, dof);
                    *borne -= actions.loads.iter().map(|load| at_node(beam, load, node, i)).sum::<f64>();
                } else {
                    let a1 = beam.spec.damping.rayleigh_stiffness;
                    *borne = -spring(&beam.springs, actions.q, dof)
                        - spring(&beam.dashpots, actions.velocity, dof)
                        - a1 * spring(&beam.springs, actions.velocity, dof);
                }
            }
            self.reactions.push(Reaction { x, force: borne[0], couple: borne[1] });
        }
    }

    /// What each support bears, from left to right.
    #[must_use]
    pub fn reactions(&self) -> &[Reaction] {
        &self.reactions
    }

    /// The section forces at both ends of an element: just right of its left node, and just left of
    /// its right node.
    ///
    /// # Panics
    /// If there is no such element.
    #[must_use]
    pub fn ends(&self, element: usize) -> [SectionForce; 2] {
        let [v0, m0, v1, m1] = self.ends[element];
        [SectionForce { moment: m0, shear: v0 }, SectionForce { moment: m1, shear: v1 }]
    }

    /// The section forces at x; right of it where a load or a support at x makes them jump, left of
    /// it at the right end.
    ///
    /// # Errors
    /// [`BeamError::OutsideSpan`].
    pub fn at(&self, beam: &Beam, x: f64) -> Result<SectionForce, BeamError> {
        Ok(self.sides(beam, x)?[1])
    }

    /// The section forces just left and just right of x, which differ where a load inside an element makes them jump; at a node
    /// both are those of [`SectionForces::at`], and [`SectionForces::ends`] tells them apart.
    ///
    /// # Errors
    /// [`BeamError::OutsideSpan`].
    pub fn sides(&self, beam: &Beam, x: f64) -> Result<[SectionForce; 2], BeamError> {
        let span = beam.spec.span;
        if !(0.0..=span).contains(&x) {
            return Err(BeamError::OutsideSpan { x, span });
        }
        let (mut e, mut xi) = beam.mesh.locate(x);
        // Rounding must not put a node's right side to its left.
        if xi > 1.0 - AT_NODE && e + 1 < beam.elements() {
            (e, xi) = (e + 1, 0.0);
        }
        let [v0, ..] = self.ends[e];
        let points = self.passed(e, xi).map(|(_, _, force, _)| force).sum::<f64>();
        let shear = v0 + self.spread(beam, e) * xi + points + self.carried(beam, e, xi)[0];
        let right = SectionForce { moment: self.moment_in(beam, e, xi), shear };
        // A couple lowers the moment to its right.
        let here = self.inside.iter().filter(|(element, at, ..)| *element == e && *at == xi);
        let [force, couple] = here.fold([0.0; 2], |sum, (_, _, force, couple)| [sum[0] + force, sum[1] + couple]);
        Ok([SectionForce { moment: right.moment + couple, shear: right.shear - force }, right])
    }

    /// What uniform loads on a part of an element have added up to ξ: to V, and to M.
    fn carried(&self, beam: &Beam, e: usize, xi: f64) -> [f64; 2] {
        let length = beam.elements[e].length;
        let mut sum = [0.0; 2];
        for (_, [from, to], load) in self.parts.iter().filter(|(element, ..)| *element == e) {
            let on = (xi.min(*to) - from).max(0.0) * length;
            let beyond = (xi - to).max(0.0) * length;
            sum[0] += load * on;
            sum[1] += load * on * (0.5 * on + beyond);
        }
        sum
    }

    /// The point loads inside an element up to ξ.
    fn passed(&self, e: usize, xi: f64) -> impl Iterator<Item = &(usize, f64, f64, f64)> {
        self.inside.iter().filter(move |(element, at, ..)| *element == e && *at <= xi)
    }

    /// By how much the transverse force changes over an element other than by jumps at point loads
    /// and by loads on a part of it: by loads all along it and inertia.
    fn spread(&self, beam: &Beam, e: usize) -> f64 {
        let [v0, _, v1, _] = self.ends[e];
        v1 - v0 - self.passed(e, 1.0).map(|(_, _, force, _)| force).sum::<f64>() - self.carried(beam, e, 1.0)[0]
    }

    /// The bending moment in an element at ξ. That the rest of the transverse force is spread
    /// evenly is exact for uniform loads; what other loads and inertia make of it is shared out
    /// over the element.
    fn moment_in(&self, beam: &Beam, e: usize, xi: f64) -> f64 {
        let [v0, m0, _, m1] = self.ends[e];
        let (length, spread) = (beam.elements[e].length, self.spread(beam, e));
        let moment = |to: f64| {
            let by_points: f64 =
                self.passed(e, to).map(|(_, at, force, couple)| force * (to - at) * length - couple).sum();
            m0 + length * to * (v0 + 0.5 * spread * to) + by_points + self.carried(beam, e, to)[1]
        };
        moment(xi) + (m1 - moment(1.0)) * xi
    }

    /// The axial force at x, N, tension positive.
    #[must_use]
    pub fn axial_force(&self, beam: &Beam, x: f64) -> f64 {
        let (e, _) = beam.mesh.locate(x.clamp(0.0, beam.spec.span));
        self.axial.get(e).copied().unwrap_or(0.0)
    }
}

/// What a load at a node itself gives to its dof: point loads there, and the weight of masses.
fn at_node(beam: &Beam, load: &SpanLoad, node: usize, component: usize) -> f64 {
    match *load {
        SpanLoad::Point { x, force, couple } => {
            let (e, xi) = beam.mesh.locate(x.clamp(0.0, beam.spec.span));
            let here = (xi <= AT_NODE && e == node) || (xi >= 1.0 - AT_NODE && e + 1 == node);
            if here { [force, couple][component] } else { 0.0 }
        }
        SpanLoad::Weight { gravity } if component == 0 => {
            let masses = beam.lumps.iter().filter(|(dof, _)| *dof == 2 * node);
            gravity * masses.map(|(_, mass)| mass).sum::<f64>()
        }
        _ => 0.0,
    }
}

impl Beam {
    /// Whether a support, fixed or elastic, bears something at a node.
    fn bears(&self, node: usize) -> bool {
        let at = |(dof, _): &(usize, f64)| dof / 2 == node;
        self.held[node] != [false; 2] || self.springs.iter().any(at) || self.dashpots.iter().any(at)
    }

    /// The section forces of a beam in equilibrium or in motion.
    ///
    /// # Errors
    /// As [`SectionForces::update`].
    ///
    /// ```
    /// use teeter_beam::{Actions, Beam, BeamSpec, Section, SpanLoad};
    /// let beam = Beam::new(BeamSpec::new(2.0, 4, Section::new(5.0, 1.0)?))?;
    /// let mut q = vec![0.0; beam.dofs()];
    /// beam.add_point_load(0.7, -3.0, &mut q)?;
    /// beam.solve_static(&mut q)?;
    /// let loads = [SpanLoad::Point { x: 0.7, force: -3.0, couple: 0.0 }];
    /// let forces = beam.section_forces(&Actions::at(&q).with_loads(&loads))?;
    /// assert!((forces.reactions()[0].force - 3.0 * 1.3 / 2.0).abs() < 1e-13);
    /// assert!((forces.at(&beam, 0.7)?.moment - 3.0 * 0.7 * 1.3 / 2.0).abs() < 1e-13); // P a b/L
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn section_forces(&self, actions: &Actions<'_>) -> Result<SectionForces, BeamError> {
        let mut forces = SectionForces::new(self);
        forces.update(self, actions)?;
        Ok(forces)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Support::{Clamped, Free};
    use crate::beam::tests::{beam, furnished, wave};

    /// A cantilever under a uniform load, a force and a couple: all by hand.
    #[test]
    fn a_cantilever_bears_what_statics_says_at_every_place() {
        let cantilever = beam(7, [Clamped, Free]);
        let loads = [
            SpanLoad::Uniform { from: 0.2, to: 0.9, load: -4.0 },
            SpanLoad::Point { x: 0.55, force: 3.0, couple: -0.7 },
        ];
        let mut q = vec![0.0; cantilever.dofs()];
        cantilever.add_partial_load([0.2, 0.9], -4.0, &mut q).unwrap();
        cantilever.add_point_load(0.55, 3.0, &mut q).unwrap();
        cantilever.add_point_couple(0.55, -0.7, &mut q).unwrap();
        cantilever.solve_static(&mut q).unwrap();
        let forces = cantilever.section_forces(&Actions::at(&q).with_loads(&loads)).unwrap();
        for k in 0..=100 {
            let x = f64::from(k) / 100.0;
            // What lies to the right of the cut.
            let part = (0.9 - x.max(0.2)).max(0.0);
            let arm = 0.9 - 0.5 * part - x;
            let beyond = if x < 0.55 { 1.0 } else { 0.0 };
            let shear = 4.0 * part - 3.0 * beyond;
            let moment = -4.0 * part * arm + beyond * (3.0 * (0.55 - x) - 0.7);
            let found = forces.at(&cantilever, x).unwrap();
            assert!((found.shear - shear).abs() < 1e-11, "V at {x}: {} {shear}", found.shear);
            assert!((found.moment - moment).abs() < 1e-12, "M at {x}: {} {moment}", found.moment);
        }
        let [wall] = forces.reactions() else { panic!("{:?}", forces.reactions()) };
        assert!((wall.force - (2.8 - 3.0)).abs() < 1e-13);
        assert!((wall.couple - (2.8 * 0.55 - 3.0 * 0.55 + 0.7)).abs() < 1e-12, "{}", wall.couple);
    }

    /// Any state at all of a beam with everything, at any velocity and acceleration: what acts on
    /// the whole balances.
    #[test]
    fn reactions_balance_loads_inertia_and_damping() {
        let beam = furnished();
        let q = wave(&beam);
        let v: Vec<f64> = q.iter().map(|q| 0.7 * q * q.signum()).collect();
        let loads = [
            SpanLoad::Point { x: 0.33, force: 5.0, couple: 0.4 },
            SpanLoad::Point { x: 0.75, force: 2.0, couple: 0.0 },
            SpanLoad::Uniform { from: 0.1, to: 0.5, load: -3.0 },
            SpanLoad::Weight { gravity: -9.81 },
        ];
        // The acceleration that these loads give.
        let mut f = vec![0.0; beam.dofs()];
        beam.add_point_load(0.33, 5.0, &mut f).unwrap();
        beam.add_point_couple(0.33, 0.4, &mut f).unwrap();
        beam.add_point_load(0.75, 2.0, &mut f).unwrap();
        beam.add_partial_load([0.1, 0.5], -3.0, &mut f).unwrap();
        beam.add_self_weight(-9.81, &mut f).unwrap();
        beam.add_elastic_force(&q, &mut f);
        beam.add_damping_product(-1.0, &v, &mut f);
        beam.factor(crate::MatrixWeights::MASS).unwrap().solve(&mut f);
        let actions = Actions::at(&q).with_velocity(&v).with_acceleration(&f).with_loads(&loads);
        let forces = beam.section_forces(&actions).unwrap();
        // Reactions by the residual of the held dofs, independently.
        let mut residual = vec![0.0; beam.dofs()];
        beam.add_mass_product(1.0, &f, &mut residual);
        beam.add_damping_product(1.0, &v, &mut residual);
        beam.add_stiffness_product(1.0, &q, &mut residual);
        let mut load = vec![0.0; beam.dofs()];
        beam.add_point_load(0.33, 5.0, &mut load).unwrap();
        beam.add_point_couple(0.33, 0.4, &mut load).unwrap();
        beam.add_point_load(0.75, 2.0, &mut load).unwrap();
        beam.add_partial_load([0.1, 0.5], -3.0, &mut load).unwrap();
        beam.add_self_weight(-9.81, &mut load).unwrap();
        let size = residual.iter().fold(0.0_f64, |m, r| m.max(r.abs()));
        assert_eq!(forces.reactions().len(), 3);
        for reaction in &forces.reactions()[..2] {
            let node = beam.mesh.node(reaction.x).unwrap();
            assert!((reaction.force - (residual[2 * node] - load[2 * node])).abs() < 1e-12 * size);
            let couple = residual[2 * node + 1] - load[2 * node + 1];
            assert!((reaction.couple - if beam.held[node][1] { couple } else { 0.0 }).abs() < 1e-12 * size);
        }
        let end = forces.reactions()[2];
        let last = 2 * beam.elements();
        // Springs with their share of a₁K.
        assert!((end.force + 30.0 * (q[last] + 0.01 * v[last]) + 0.4 * v[last]).abs() < 1e-13);
        assert!((end.couple + 1.5 * (q[last + 1] + 0.01 * v[last + 1])).abs() < 1e-13);
    }
}
