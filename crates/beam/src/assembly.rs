//! From the numbers of a beam to its matrices.

use crate::bar::Bar;
use crate::beam::Beam;
use crate::blocks::Blocks;
use crate::element::{Element, Matrix4};
use crate::error::BeamError;
use crate::field::{Field, Natural};
use crate::membrane::Membrane;
use crate::mesh::Mesh;
use crate::modal_damping::ModalDamping;
use crate::section::Section;
use crate::spec::{Axial, BeamSpec, Foundation};
use crate::support::{Hold, Support};

impl Beam {
    /// Checks every value of `spec`, then assembles.
    ///
    /// # Errors
    /// [`BeamError`] that names the field, its value and the rule.
    ///
    /// ```
    /// use teeter_beam::{Beam, BeamSpec, Section};
    /// let spec = BeamSpec::new(0.36, 20, Section::rectangle(0.03, 0.0015, 69e9, 2700.0)?);
    /// let beam = Beam::new(spec.clone())?;
    /// assert_eq!((beam.dofs(), beam.free_dofs()), (42, 40));
    ///
    /// let mut wrong = spec;
    /// wrong.span = -1.0;
    /// assert_eq!(Beam::new(wrong).unwrap_err().to_string(), "span = -1: must be finite and > 0");
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn new(spec: BeamSpec) -> Result<Self, BeamError> {
        spec.validate()?;
        let mesh = Mesh::new(&spec)?;
        let elements = elements(&spec, &mesh);
        let supported = Supported::new(&spec, &mesh)?;
        let inertia = Inertia::new(&spec, &mesh, &elements)?;
        let elasticity = Elasticity::new(&spec, &mesh, &elements, &supported.springs);
        let viscosity = Viscosity::new(&spec, &mesh, &elements, &supported.dashpots);
        let mut beam = Self {
            membrane: (spec.axial == Axial::Held).then(|| membrane(&elements)),
            bar: bar(&spec, &elements, &inertia.lumps),
            held: supported.held,
            springs: supported.springs,
            dashpots: supported.dashpots,
            mass: inertia.mass,
            lumps: inertia.lumps,
            m: inertia.assembled,
            bending: elasticity.bending,
            foundation: elasticity.foundation,
            k: elasticity.assembled,
            damping_of_mass: viscosity.of_mass + spec.damping.rayleigh_mass,
            residual_damping: viscosity.residual,
            c: viscosity.assembled,
            modal: None,
            spec,
            mesh,
            elements,
        };
        // Ratios are those of the modes of a beam that is complete but for them.
        if beam.spec.damping.modal.iter().any(|ratio| *ratio > 0.0) {
            beam.modal = Some(ModalDamping::new(&beam, &beam.spec.damping.modal)?);
        }
        Ok(beam)
    }
}

/// Every element with the section in its middle: the mesh has nodes where sections change.
fn elements(spec: &BeamSpec, mesh: &Mesh) -> Vec<Element> {
    let section = |x: f64| -> Section {
        let own = spec.segments.iter().rev().find(|segment| segment.from < x && x < segment.to);
        own.map_or(spec.section, |segment| segment.section)
    };
    (0..mesh.elements()).map(|k| Element::new(mesh.length(k), section(mesh.middle(k)))).collect()
}

/// The supports by their nodes, the ends first.
pub(crate) fn supports<'a>(spec: &'a BeamSpec, mesh: &'a Mesh) -> impl Iterator<Item = (usize, Support)> + use<'a> {
    let ends = [(0, spec.supports[0]), (mesh.elements(), spec.supports[1])];
    let inner = spec.inner_supports.iter().filter_map(|inner| Some((mesh.node(inner.x)?, inner.support)));
    ends.into_iter().chain(inner)
}

/// What supports do to each dof.
struct Supported {
    held: Vec<[bool; 2]>,
    /// Springs and dashpots, by dof.
    springs: Vec<(usize, f64)>,
    dashpots: Vec<(usize, f64)>,
}

impl Supported {
    fn new(spec: &BeamSpec, mesh: &Mesh) -> Result<Self, BeamError> {
        let mut held = vec![[false; 2]; mesh.x.len()];
        let (mut springs, mut dashpots) = (Vec::new(), Vec::new());
        for (node, support) in supports(spec, mesh) {
            for (i, hold) in support.holds().into_iter().enumerate() {
                match hold {
                    Hold::Free => {}
                    Hold::Fixed => held[node][i] = true,
                    Hold::Spring { stiffness, damping } => {
                        springs.extend((stiffness > 0.0).then_some((2 * node + i, stiffness)));
                        dashpots.extend((damping > 0.0).then_some((2 * node + i, damping)));
                    }
                }
            }
        }
        if held.iter().all(|node| *node == [true; 2]) {
            let rule = "at least 2 between two clamped ends, else nothing can move";
            return Err(BeamError::Count { field: "elements", value: spec.elements, rule });
        }
        Ok(Self { held, springs, dashpots })
    }
}

/// M in bending: ∫ ρA NᵀN + ρI N_ψᵀN_ψ dx and lumped masses.
struct Inertia {
    mass: Field,
    /// Masses and inertias of nodes, by dof; both of a lump, even where one is 0.
    lumps: Vec<(usize, f64)>,
    assembled: Blocks,
}

impl Inertia {
    fn new(spec: &BeamSpec, mesh: &Mesh, elements: &[Element]) -> Result<Self, BeamError> {
        let masses: Vec<Matrix4> = elements.iter().map(Element::mass).collect();
        let mut assembled = Blocks::assemble(mesh.x.len(), masses.iter().copied());
        let mut lumps = Vec::new();
        for lump in &spec.lumps {
            let node = mesh.node(lump.x).ok_or(BeamError::OutsideSpan { x: lump.x, span: spec.span })?;
            assembled.add_own(node, [lump.mass, 0.0, lump.inertia]);
            lumps.extend([(2 * node, lump.mass), (2 * node + 1, lump.inertia)]);
        }
        Ok(Self { mass: Field::new(masses.iter()), lumps, assembled })
    }
}

/// K in bending: the elements with their axial force, Winkler's foundation, springs of supports.
struct Elasticity {
    bending: Natural,
    foundation: Option<Field>,
    assembled: Blocks,
}

impl Elasticity {
    fn new(spec: &BeamSpec, mesh: &Mesh, elements: &[Element], springs: &[(usize, f64)]) -> Self {
        let nodes = mesh.x.len();
        let mut bending = Natural::bending(elements);
        if spec.axial_force != 0.0 {
            bending.add_scaled(spec.axial_force, &Natural::geometric(elements));
        }
        let mut assembled = Blocks::assemble(nodes, bending.matrices());
        let layer = Layer::new(spec, mesh, elements, |foundation| foundation.stiffness, 0.0);
        let foundation = layer.field();
        if foundation.is_some() {
            assembled.add_scaled(1.0, &Blocks::assemble(nodes, layer.matrices.into_iter()));
        }
        add_by_dof(&mut assembled, springs);
        Self { bending, foundation, assembled }
    }
}

/// C in bending but for Rayleigh's part and ratios of modes: viscous damping, foundations, dashpots
/// of supports.
struct Viscosity {
    /// The part that is a multiple of M, 1/s.
    of_mass: f64,
    /// The rest of the elements'.
    residual: Option<Field>,
    /// The rest, assembled, with dashpots.
    assembled: Option<Blocks>,
}

impl Viscosity {
    fn new(spec: &BeamSpec, mesh: &Mesh, elements: &[Element], dashpots: &[(usize, f64)]) -> Self {
        // c ∫NᵀN dx is a multiple of M where M is ρA ∫NᵀN dx with one ρA and nothing else.
        let rho_a = elements[0].section.mass_per_length;
        let plain = |e: &Element| e.section.mass_per_length == rho_a && e.section.rotatory_inertia == 0.0;
        let proportional = elements.iter().all(plain) && spec.lumps.is_empty();
        let viscous = spec.damping.viscous;
        let (of_mass, everywhere) = if proportional { (viscous / rho_a, 0.0) } else { (0.0, viscous) };
        let layer = Layer::new(spec, mesh, elements, |foundation| foundation.damping, everywhere);
        let residual = layer.field();
        let assembled = (residual.is_some() || !dashpots.is_empty()).then(|| {
            let mut c = Blocks::assemble(mesh.x.len(), layer.matrices.into_iter());
            add_by_dof(&mut c, dashpots);
            c
        });
        Self { of_mass, residual, assembled }
    }
}

/// p ∫NᵀN dx element by element, with p the sum of what all foundations under it have and what is
/// everywhere.
struct Layer {
    matrices: Vec<Matrix4>,
    is_zero: bool,
}

impl Layer {
    fn new(
        spec: &BeamSpec,
        mesh: &Mesh,
        elements: &[Element],
        of: impl Fn(&Foundation) -> f64,
        everywhere: f64,
    ) -> Self {
        let under = |k: usize| {
            let x = mesh.middle(k);
            let covering = spec.foundations.iter().filter(|f| f.from < x && x < f.to);
            everywhere + covering.map(&of).sum::<f64>()
        };
        let values: Vec<f64> = (0..elements.len()).map(under).collect();
        let matrices = elements.iter().zip(&values).map(|(e, value)| e.foundation(*value)).collect();
        Self { matrices, is_zero: values.iter().all(|value| *value == 0.0) }
    }

    /// None where it is zero.
    fn field(&self) -> Option<Field> {
        (!self.is_zero).then(|| Field::new(self.matrices.iter()))
    }
}

fn add_by_dof(blocks: &mut Blocks, values: &[(usize, f64)]) {
    for &(dof, value) in values {
        blocks.add_own(dof / 2, if dof % 2 == 0 { [value, 0.0, 0.0] } else { [0.0, 0.0, value] });
    }
}

/// The stretching of a beam held along its axis, by L/EA, the sum of l/EA over the elements.
fn membrane(elements: &[Element]) -> Membrane {
    let slopes = Natural::geometric(elements);
    let matrix = Blocks::assemble(elements.len() + 1, slopes.matrices());
    let flexibility: f64 = elements.iter().map(|e| e.length / e.section.axial()).sum();
    Membrane { slopes, matrix, stiffness: 1.0 / flexibility }
}

/// The axial dofs, where there are any.
fn bar(spec: &BeamSpec, elements: &[Element], lumps: &[(usize, f64)]) -> Option<Bar> {
    let Axial::Elastic { held } = spec.axial else { return None };
    let parts: Vec<_> = elements.iter().map(|e| (e.section.axial(), e.section.mass_per_length, e.length)).collect();
    let masses = lumps.iter().step_by(2).map(|(dof, mass)| (dof / 2, *mass)).collect();
    Some(Bar::new(&parts, masses, held))
}
