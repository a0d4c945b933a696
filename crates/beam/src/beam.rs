//! The beam: an immutable model, and the map between its dofs and its nodes.

use crate::assembly::supports;
use crate::bar::Bar;
use crate::blocks::Blocks;
use crate::element::Element;
use crate::error::{BeamError, check_len};
use crate::field::{Field, Natural};
use crate::membrane::Membrane;
use crate::mesh::Mesh;
use crate::modal_damping::ModalDamping;
use crate::spec::BeamSpec;
use crate::support::Support;

/// What a support lets pass as "zero" in a nodal shape, relative to the largest such value of the
/// shape: nine digits, so that sin(π) = 1.2e-16 or a value from a text file is one.
const SUPPORT_TOLERANCE: f64 = 1e-9;

/// One of the degrees of freedom of a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Dof {
    /// w, m.
    Deflection,
    /// The rotation of the section, rad: w' for Euler–Bernoulli.
    Slope,
}

impl Dof {
    /// Its place in the values of a node.
    pub(crate) fn component(self) -> usize {
        match self {
            Self::Deflection => 0,
            Self::Slope => 1,
        }
    }
}

/// A straight beam by finite elements. Immutable: all that moves is in the caller's vectors of
/// [`Beam::dofs`] entries.
///
/// Every node has its two dofs in every vector, w and the rotation, node by node; axial dofs follow
/// after them all. What a support holds is there too and stays 0:
/// [`Factor::solve`](crate::Factor::solve) returns 0 there, products write there what the support
/// has to bear.
#[derive(Debug, Clone)]
pub struct Beam {
    pub(crate) spec: BeamSpec,
    pub(crate) mesh: Mesh,
    pub(crate) elements: Vec<Element>,
    pub(crate) held: Vec<[bool; 2]>,
    /// Bending, shear and N₀.
    pub(crate) bending: Natural,
    /// Winkler's foundation.
    pub(crate) foundation: Option<Field>,
    /// Springs and dashpots of supports, by dof.
    pub(crate) springs: Vec<(usize, f64)>,
    pub(crate) dashpots: Vec<(usize, f64)>,
    pub(crate) mass: Field,
    /// Masses and inertias of nodes, by dof.
    pub(crate) lumps: Vec<(usize, f64)>,
    /// The part of C in bending that is a multiple of M.
    pub(crate) damping_of_mass: f64,
    /// What of C is no multiple of M or K, by elements.
    pub(crate) residual_damping: Option<Field>,
    pub(crate) bar: Option<Bar>,
    pub(crate) membrane: Option<Membrane>,
    pub(crate) modal: Option<ModalDamping>,
    /// M, K and what of C is no multiple of them, in bending.
    pub(crate) m: Blocks,
    pub(crate) k: Blocks,
    pub(crate) c: Option<Blocks>,
}

impl Beam {
    /// The numbers it was made from.
    pub fn spec(&self) -> &BeamSpec {
        &self.spec
    }

    /// Length of every vector: two entries a node, and one more with axial dofs.
    pub fn dofs(&self) -> usize {
        let nodes = self.nodes();
        2 * nodes + if self.bar.is_some() { nodes } else { 0 }
    }

    /// Unknowns: dofs that no support holds.
    pub fn free_dofs(&self) -> usize {
        (0..self.dofs()).filter(|dof| !self.is_held(*dof)).count()
    }

    /// Whether a support holds this dof; false where there is none.
    pub fn is_held(&self, dof: usize) -> bool {
        let bending = 2 * self.nodes();
        if dof < bending {
            return self.held[dof / 2][dof % 2];
        }
        self.bar.as_ref().and_then(|bar| bar.held.get(dof - bending)).copied().unwrap_or(false)
    }

    /// The entry of M on the diagonal, kg or kg m².
    pub(crate) fn mass_of(&self, dof: usize) -> f64 {
        let bending = 2 * self.nodes();
        match &self.bar {
            Some(bar) if dof >= bending => bar.m.0[dof - bending][0],
            _ => self.m.0[dof / 2].own[2 * (dof % 2)],
        }
    }

    /// Nodes, one more than elements.
    pub fn nodes(&self) -> usize {
        self.mesh.x.len()
    }

    /// Elements.
    pub fn elements(&self) -> usize {
        self.elements.len()
    }

    /// Where the nodes are, m, rising from 0 to the span.
    pub fn node_positions(&self) -> &[f64] {
        &self.mesh.x
    }

    /// Its mass with all that it carries, kg.
    pub fn total_mass(&self) -> f64 {
        let own: f64 = self.elements.iter().map(|e| e.section.mass_per_length * e.length).sum();
        own + self.spec.lumps.iter().map(|lump| lump.mass).sum::<f64>()
    }

    /// Whether C is not zero.
    pub fn is_damped(&self) -> bool {
        self.damping_of_mass != 0.0
            || self.spec.damping.rayleigh_stiffness != 0.0
            || self.c.is_some()
            || self.modal.is_some()
    }

    /// Whether it has axial dofs.
    pub fn has_axial_dofs(&self) -> bool {
        self.bar.is_some()
    }

    /// Whether a deflection stretches it, so that its elastic force is not linear.
    pub fn is_stretched(&self) -> bool {
        self.membrane.is_some()
    }

    /// Index of a dof in the vectors; `None` where the support holds it, or where there is no such
    /// node.
    ///
    /// ```
    /// # use teeter_beam::{Beam, BeamSpec, Dof, Section};
    /// # let beam = Beam::new(BeamSpec::new(1.0, 4, Section::new(1.0, 1.0)?))?;
    /// assert_eq!(beam.dof(0, Dof::Deflection), None);
    /// assert_eq!(beam.dof(1, Dof::Deflection), Some(2));
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn dof(&self, node: usize, kind: Dof) -> Option<usize> {
        let component = kind.component();
        (!self.held.get(node)?[component]).then_some(2 * node + component)
    }

    /// The vector of a nodal shape: w (m) and rotation (rad) of every node, or their rates. Axial
    /// dofs are 0.
    ///
    /// # Errors
    /// [`BeamError::Length`]; [`BeamError::Value`] for an entry that is not finite;
    /// [`BeamError::BrokenSupport`] for one that is not zero where a support holds it (to 1e-9 of
    /// the largest such value of the shape).
    ///
    /// ```
    /// # use teeter_beam::{Beam, BeamSpec, Section, Support};
    /// # let spec = BeamSpec::new(1.0, 2, Section::new(1.0, 1.0)?);
    /// let beam = Beam::new(spec.supported([Support::Clamped, Support::Pinned]))?;
    /// let q = beam.from_nodes(&[[0.0, 0.0], [0.1, 0.2], [0.0, -0.3]])?;
    /// assert_eq!(beam.to_nodes(&q)[2], [0.0, -0.3]);
    /// assert!(beam.from_nodes(&[[0.0, 0.1], [0.1, 0.2], [0.0, -0.3]]).is_err());
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn from_nodes(&self, nodal: &[[f64; 2]]) -> Result<Vec<f64>, BeamError> {
        check_len("nodal", self.nodes(), nodal.len())?;
        if let Some(&value) = nodal.iter().flatten().find(|value| !value.is_finite()) {
            return Err(BeamError::Value { field: "nodal", value, rule: "finite" });
        }
        let largest = |k: usize| nodal.iter().fold(0.0_f64, |m, pair| m.max(pair[k].abs()));
        let zero = [largest(0), largest(1)].map(|size| SUPPORT_TOLERANCE * size);
        let mut q = Vec::with_capacity(self.dofs());
        for (node, (pair, held)) in nodal.iter().zip(&self.held).enumerate() {
            for (component, dof) in [Dof::Deflection, Dof::Slope].into_iter().enumerate() {
                let value = pair[component];
                if held[component] && value.abs() > zero[component] {
                    let support = self.support_of(node);
                    return Err(BeamError::BrokenSupport { node, dof, value, support });
                }
                q.push(if held[component] { 0.0 } else { value });
            }
        }
        q.resize(self.dofs(), 0.0);
        Ok(q)
    }

    fn support_of(&self, node: usize) -> Support {
        let last = |support: Support, (at, found)| if at == node { found } else { support };
        supports(&self.spec, &self.mesh).fold(Support::Free, last)
    }

    /// w and rotation of every node.
    ///
    /// # Panics
    /// If `q` has not [`Beam::dofs`] entries.
    pub fn to_nodes(&self, q: &[f64]) -> Vec<[f64; 2]> {
        self.bend(q).to_vec()
    }

    /// The part of a vector that bends, node by node.
    ///
    /// # Panics
    /// If `q` has not [`Beam::dofs`] entries.
    #[inline]
    pub(crate) fn bend<'a>(&self, q: &'a [f64]) -> &'a [[f64; 2]] {
        assert_eq!(q.len(), self.dofs(), "a vector must have one entry per degree of freedom");
        q[..2 * self.nodes()].as_chunks().0
    }

    /// As [`Beam::bend`], with the axial part.
    #[inline]
    pub(crate) fn split_mut<'a>(&self, f: &'a mut [f64]) -> (&'a mut [[f64; 2]], &'a mut [f64]) {
        assert_eq!(f.len(), self.dofs(), "a vector must have one entry per degree of freedom");
        let (bend, axial) = f.split_at_mut(2 * self.nodes());
        (bend.as_chunks_mut().0, axial)
    }

    /// [`BeamSpec::circular_frequency`] of this beam.
    ///
    /// # Errors
    /// As there.
    pub fn circular_frequency(&self, mode: usize) -> Result<f64, BeamError> {
        self.spec.circular_frequency(mode)
    }

    /// [`BeamSpec::viscous_for_ratio`] of this beam.
    ///
    /// # Errors
    /// As there.
    pub fn viscous_for_ratio(&self, mode: usize, ratio: f64) -> Result<f64, BeamError> {
        self.spec.viscous_for_ratio(mode, ratio)
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::{Axial, Damping, Foundation, Hold, MatrixWeights, Section};

    pub(crate) fn all_supports() -> Vec<[Support; 2]> {
        let kinds = [Support::Free, Support::Pinned, Support::Clamped, Support::Guided];
        kinds.iter().flat_map(|a| kinds.map(|b| [*a, b])).collect()
    }

    pub(crate) fn spec(elements: usize, supports: [Support; 2]) -> BeamSpec {
        BeamSpec::new(1.0, elements, Section::new(2.0, 3.0).unwrap()).supported(supports)
    }

    pub(crate) fn beam(elements: usize, supports: [Support; 2]) -> Beam {
        Beam::new(spec(elements, supports)).unwrap()
    }

    pub(crate) fn damped(elements: usize, supports: [Support; 2]) -> Beam {
        let damping = Damping::none()
            .with_viscous(0.7)
            .with_rayleigh_mass(0.3)
            .with_rayleigh_stiffness(0.01)
            .with_modal(Vec::new());
        Beam::new(spec(elements, supports).damped(damping)).unwrap()
    }

    /// A beam with everything: shear, segments, an inner support, springs, a lump, a foundation,
    /// axial dofs under tension.
    pub(crate) fn furnished() -> Beam {
        let plain = Section::new(2.0, 3.0).unwrap().with_axial_stiffness(50.0).unwrap();
        let thick = Section::new(5.0, 4.0).unwrap().with_shear(40.0, 0.02).unwrap().with_axial_stiffness(70.0).unwrap();
        let spring = |stiffness, damping| Hold::Spring { stiffness, damping };
        let end = Support::Elastic { deflection: spring(30.0, 0.4), rotation: spring(1.5, 0.0) };
        let foundation = Foundation::new(0.1, 0.65, 80.0).with_damping(0.3);
        let spec = spec(7, [Support::Clamped, end])
            .segment(0.3, 0.5, thick)
            .support_at(0.75, Support::Pinned)
            .lump(0.4, 0.5, 0.01)
            .foundation(foundation)
            .axial(Axial::elastic([true, false]))
            .axial_force(3.0)
            .damped(
                Damping::none()
                    .with_viscous(0.7)
                    .with_rayleigh_mass(0.3)
                    .with_rayleigh_stiffness(0.01)
                    .with_modal(Vec::new()),
            );
        Beam::new(BeamSpec { section: plain, ..spec }).unwrap()
    }

    /// Values without a pattern that a support or a symmetry could hide; 0 where the beam is held.
    pub(crate) fn wave(beam: &Beam) -> Vec<f64> {
        let value = |i: usize| if beam.is_held(i) { 0.0 } else { (1.3 * i as f64 + 0.4).sin() };
        (0..beam.dofs()).map(value).collect()
    }

    #[test]
    fn rigid_motions_of_a_free_beam_cost_no_force() {
        let beam = beam(8, [Support::Free; 2]);
        let rotation: Vec<[f64; 2]> = beam.node_positions().iter().map(|x| [*x, 1.0]).collect();
        for nodes in [vec![[1.0, 0.0]; 9], rotation] {
            let q = beam.from_nodes(&nodes).unwrap();
            let mut force = vec![0.0; beam.dofs()];
            beam.add_stiffness_product(1.0, &q, &mut force);
            assert!(force.iter().all(|f| *f == 0.0));
        }
    }

    #[test]
    fn nodes_and_dofs_are_two_views_of_one_shape() {
        for supports in all_supports() {
            let beam = beam(4, supports);
            let q = wave(&beam);
            assert_eq!(beam.from_nodes(&beam.to_nodes(&q)).unwrap(), q, "{supports:?}");
        }
    }

    #[test]
    fn what_a_support_holds_stays_where_it_is() {
        let beam = furnished();
        let held: Vec<usize> = (0..beam.dofs()).filter(|dof| beam.is_held(*dof)).collect();
        let inner = beam.mesh.node(0.75).unwrap();
        assert_eq!(held, [0, 1, 2 * inner, 2 * beam.nodes()]);
        assert_eq!(beam.free_dofs(), beam.dofs() - 4);
        let mut x = vec![1.0; beam.dofs()];
        beam.factor(MatrixWeights { mass: 1.0, damping: 0.1, stiffness: 0.01 }).unwrap().solve(&mut x);
        assert!(held.iter().all(|dof| x[*dof] == 0.0));
    }

    #[test]
    fn a_beam_and_its_factor_may_go_to_other_threads() {
        fn shared<T: Send + Sync>() {}
        shared::<Beam>();
        shared::<crate::Factor>();
    }
}
