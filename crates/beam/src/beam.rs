//! The beam: an immutable model, and the map between its dofs and its nodes.

use std::sync::Arc;

use faer::sparse::SparseColMat;
use faer::sparse::linalg::cholesky::simplicial::SymbolicSimplicialCholesky;

use crate::assembly::{assemble, pattern};
use crate::element::Element;
use crate::error::{BeamError, check_len};
use crate::factor::analyse;
use crate::layout::{Dof, Layout};
use crate::spec::{BeamSpec, Support};

/// What a support lets pass as "zero" in a nodal shape, relative to the largest such value of the shape: nine digits, so
/// that sin(π) = 1.2e-16 or a value from a text file is one.
const SUPPORT_TOLERANCE: f64 = 1e-9;

/// A straight, uniform beam by finite elements. Immutable: all that moves is in the caller's vectors of [`Beam::dofs`]
/// entries.
#[derive(Debug, Clone)]
pub struct Beam {
    pub(crate) spec: BeamSpec,
    pub(crate) layout: Layout,
    pub(crate) element: Element,
    /// c/ρA + a₀: the part of C that is a multiple of M.
    pub(crate) damping_of_mass: f64,
    pub(crate) elements_per_length: f64,
    mass: SparseColMat<usize, f64>,
    damping: SparseColMat<usize, f64>,
    stiffness: SparseColMat<usize, f64>,
    pub(crate) symbolic: Arc<SymbolicSimplicialCholesky<usize>>,
}

impl Beam {
    /// Checks every value of `spec`, then assembles.
    ///
    /// # Errors
    /// [`BeamError`] that names the field, its value and the rule.
    ///
    /// ```
    /// use teeter_beam::{Beam, BeamSpec, Damping, Section, Support};
    /// let spec = BeamSpec {
    ///     span: 0.36,
    ///     elements: 20,
    ///     section: Section::rectangle(0.03, 0.0015, 69e9, 2700.0)?,
    ///     supports: [Support::Pinned, Support::Pinned],
    ///     damping: Damping::default(),
    /// };
    /// assert_eq!(Beam::new(spec)?.dofs(), 40);
    ///
    /// let error = Beam::new(BeamSpec { span: -1.0, ..spec }).unwrap_err();
    /// assert_eq!(error.to_string(), "span = -1: must be finite and > 0");
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn new(spec: BeamSpec) -> Result<Self, BeamError> {
        spec.validate()?;
        let layout = Layout::new(spec.elements, spec.supports);
        let length = spec.span / spec.elements as f64;
        let element = Element::new(length, spec.section.bending_stiffness, spec.section.mass_per_length);
        let damping_of_mass = spec.damping.viscous / spec.section.mass_per_length + spec.damping.rayleigh_mass;
        let (m, k) = (element.mass_matrix(), element.stiffness());
        let c = std::array::from_fn(|i| {
            std::array::from_fn(|j| damping_of_mass * m[i][j] + spec.damping.rayleigh_stiffness * k[i][j])
        });
        let pattern = pattern(&layout);
        // The analysis of a valid band can only fail for want of memory.
        let symbolic = analyse(&pattern).ok_or(BeamError::Count {
            field: "elements",
            value: spec.elements,
            rule: "few enough for the memory at hand",
        })?;
        Ok(Self {
            spec,
            layout,
            element,
            damping_of_mass,
            elements_per_length: spec.elements as f64 / spec.span,
            mass: assemble(&layout, &pattern, &m),
            damping: assemble(&layout, &pattern, &c),
            stiffness: assemble(&layout, &pattern, &k),
            symbolic: Arc::new(symbolic),
        })
    }

    /// The numbers it was made from.
    pub fn spec(&self) -> &BeamSpec {
        &self.spec
    }

    /// Free degrees of freedom: the length of every vector.
    pub fn dofs(&self) -> usize {
        self.layout.dofs()
    }

    /// Nodes, one more than elements.
    pub fn nodes(&self) -> usize {
        self.layout.elements + 1
    }

    /// Length of an element, m.
    pub fn element_length(&self) -> f64 {
        self.element.length
    }

    /// Whether C is not zero.
    pub fn is_damped(&self) -> bool {
        self.damping_of_mass != 0.0 || self.spec.damping.rayleigh_stiffness != 0.0
    }

    /// Index of a dof in the vectors; `None` where the support fixes it, or where there is no such node.
    ///
    /// ```
    /// # use teeter_beam::{Beam, BeamSpec, Damping, Dof, Section, Support};
    /// # let beam = Beam::new(BeamSpec { span: 1.0, elements: 4, section: Section::new(1.0, 1.0)?,
    /// #     supports: [Support::Pinned; 2], damping: Damping::default() })?;
    /// assert_eq!(beam.dof(0, Dof::Deflection), None);
    /// assert_eq!(beam.dof(1, Dof::Deflection), Some(1));
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn dof(&self, node: usize, kind: Dof) -> Option<usize> {
        self.layout.dof(node, kind)
    }

    /// The consistent mass matrix, upper triangle. M, C and K have one pattern; entries that cancel to 0 are kept.
    pub fn mass(&self) -> &SparseColMat<usize, f64> {
        &self.mass
    }

    /// The damping matrix, upper triangle, on the pattern of [`Beam::mass`].
    pub fn damping(&self) -> &SparseColMat<usize, f64> {
        &self.damping
    }

    /// The stiffness matrix, upper triangle, on the pattern of [`Beam::mass`].
    pub fn stiffness(&self) -> &SparseColMat<usize, f64> {
        &self.stiffness
    }

    /// The vector of a nodal shape: `[w, w']` (m, rad; or their rates) for every node.
    ///
    /// # Errors
    /// [`BeamError::Length`]; [`BeamError::Value`] for an entry that is not finite; [`BeamError::BrokenSupport`] for one
    /// that is not zero where a support holds it (to 1e-9 of the largest such value of the shape).
    ///
    /// ```
    /// # use teeter_beam::{Beam, BeamSpec, Damping, Section, Support};
    /// # let beam = Beam::new(BeamSpec { span: 1.0, elements: 2, section: Section::new(1.0, 1.0)?,
    /// #     supports: [Support::Clamped, Support::Pinned], damping: Damping::default() })?;
    /// let q = beam.from_nodes(&[[0.0, 0.0], [0.1, 0.2], [0.0, -0.3]])?;
    /// assert_eq!(q, [0.1, 0.2, -0.3]);
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
        for (node, pair) in nodal.iter().enumerate() {
            let fixed = 2 - self.layout.free(node);
            for component in 0..fixed {
                let value = pair[component];
                if value.abs() > zero[component] {
                    let support = self.support_of(node);
                    return Err(BeamError::BrokenSupport { node, component, value, support });
                }
            }
            q.extend(&pair[fixed..]);
        }
        Ok(q)
    }

    fn support_of(&self, node: usize) -> Support {
        self.spec.supports[usize::from(node > 0)]
    }

    /// `[w, w']` of every node, zero where a support holds it.
    ///
    /// # Panics
    /// If `q` has not [`Beam::dofs`] entries.
    pub fn to_nodes(&self, q: &[f64]) -> Vec<[f64; 2]> {
        let (head, inner, tail) = self.layout.split(q);
        let mut nodal = Vec::with_capacity(self.nodes());
        nodal.push(head);
        nodal.extend(inner);
        nodal.push(tail);
        nodal
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
    use crate::spec::{Damping, Section};

    pub(crate) fn all_supports() -> Vec<[Support; 2]> {
        let kinds = [Support::Free, Support::Pinned, Support::Clamped];
        kinds.iter().flat_map(|a| kinds.map(|b| [*a, b])).collect()
    }

    fn build(elements: usize, supports: [Support; 2], damping: Damping) -> Beam {
        let section = Section::new(2.0, 3.0).unwrap();
        Beam::new(BeamSpec { span: 1.0, elements, section, supports, damping }).unwrap()
    }

    pub(crate) fn beam(elements: usize, supports: [Support; 2]) -> Beam {
        build(elements, supports, Damping::default())
    }

    pub(crate) fn damped(elements: usize, supports: [Support; 2]) -> Beam {
        build(elements, supports, Damping { viscous: 0.7, rayleigh_mass: 0.3, rayleigh_stiffness: 0.01 })
    }

    /// Values without a pattern that a support or a symmetry could hide.
    pub(crate) fn wave(len: usize) -> Vec<f64> {
        (0..len).map(|i| (1.3 * i as f64 + 0.4).sin()).collect()
    }

    pub(crate) fn dense(upper: &SparseColMat<usize, f64>) -> Vec<Vec<f64>> {
        let n = upper.ncols();
        let mut full = vec![vec![0.0; n]; n];
        for entry in upper.triplet_iter() {
            assert!(entry.row <= entry.col);
            full[entry.row][entry.col] = *entry.val;
            full[entry.col][entry.row] = *entry.val;
        }
        full
    }

    #[test]
    fn the_three_matrices_have_one_pattern_with_its_structural_zeros() {
        for supports in all_supports() {
            let beam = beam(3, supports);
            for matrix in [beam.damping(), beam.stiffness()] {
                assert_eq!(matrix.symbolic().col_ptr(), beam.mass().symbolic().col_ptr());
                assert_eq!(matrix.symbolic().row_idx(), beam.mass().symbolic().row_idx());
            }
            let (w, slope) = (beam.dof(1, Dof::Deflection).unwrap(), beam.dof(1, Dof::Slope).unwrap());
            for matrix in [beam.mass(), beam.damping(), beam.stiffness()] {
                assert_eq!(matrix.get(w, slope), Some(&0.0), "{supports:?}");
            }
        }
    }

    #[test]
    fn rigid_motions_of_a_free_beam_cost_no_force() {
        let beam = beam(7, [Support::Free; 2]);
        let l = beam.element_length();
        let matrix = dense(beam.stiffness());
        let size = matrix.iter().flatten().fold(0.0_f64, |m, a| m.max(a.abs()));
        let rotation: Vec<[f64; 2]> = (0..8).map(|i| [f64::from(i) * l, 1.0]).collect();
        for nodes in [vec![[1.0, 0.0]; 8], rotation] {
            let q = beam.from_nodes(&nodes).unwrap();
            for row in &matrix {
                let force: f64 = row.iter().zip(&q).map(|(a, x)| a * x).sum();
                assert!(force.abs() < 1e-15 * size);
            }
        }
    }

    #[test]
    fn nodes_and_dofs_are_two_views_of_one_shape() {
        for supports in all_supports() {
            let beam = beam(4, supports);
            let q = wave(beam.dofs());
            assert_eq!(beam.from_nodes(&beam.to_nodes(&q)).unwrap(), q, "{supports:?}");
        }
    }

    #[test]
    fn a_beam_and_its_factor_may_go_to_other_threads() {
        fn shared<T: Send + Sync>() {}
        shared::<Beam>();
        shared::<crate::Factor>();
    }
}
