//! The numbers that make a beam: section, supports, damping, mesh.

use crate::error::{BeamError, check};
use crate::modes;

/// The finest mesh that [`BeamSpec::elements`] may ask for.
///
/// cond(K) grows like the fourth power of the element count (`docs/theory.md` §1, *Conditioning*): beyond this, K has no
/// correct digit left in double precision.
pub const MAX_ELEMENTS: usize = 10_000;

/// What a cross-section contributes to the equation of motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    /// Bending stiffness EI, N m².
    pub bending_stiffness: f64,
    /// Mass per length ρA, kg/m.
    pub mass_per_length: f64,
}

impl Section {
    /// A section by its bending stiffness EI (N m²) and its mass per length ρA (kg/m).
    ///
    /// # Errors
    /// [`BeamError::Value`] where one is not finite and positive.
    ///
    /// ```
    /// let section = teeter_beam::Section::new(0.5821875, 0.1215)?;
    /// assert_eq!(section.mass_per_length, 0.1215);
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn new(bending_stiffness: f64, mass_per_length: f64) -> Result<Self, BeamError> {
        let section = Self { bending_stiffness, mass_per_length };
        section.validate()?;
        Ok(section)
    }

    /// A solid rectangle of `width` and `thickness` (m; the beam bends across its thickness), Young's modulus (Pa) and
    /// density (kg/m³): EI = E b t³/12, ρA = ρ b t.
    ///
    /// # Errors
    /// [`BeamError::Value`] where one, or a product of them, is not finite and positive.
    ///
    /// ```
    /// let section = teeter_beam::Section::rectangle(0.03, 0.0015, 69e9, 2700.0)?;
    /// assert!((section.bending_stiffness - 0.5821875).abs() < 1e-15);
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn rectangle(width: f64, thickness: f64, youngs_modulus: f64, density: f64) -> Result<Self, BeamError> {
        positive("width", width)?;
        positive("thickness", thickness)?;
        positive("youngs_modulus", youngs_modulus)?;
        positive("density", density)?;
        Self::new(youngs_modulus * width * thickness * thickness * thickness / 12.0, density * width * thickness)
    }

    fn validate(&self) -> Result<(), BeamError> {
        positive("section.bending_stiffness", self.bending_stiffness)?;
        positive("section.mass_per_length", self.mass_per_length)
    }
}

/// How an end of the beam is held.
///
/// No support holds the beam along its axis: axial motion is not part of the model (`docs/theory.md` §1).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Support {
    /// Not held.
    Free,
    /// w = 0, free of moment.
    Pinned,
    /// w = w' = 0.
    Clamped,
}

impl Support {
    /// How many of the node's two dofs are left, the slope being the last one to go.
    pub(crate) fn free_dofs(self) -> usize {
        match self {
            Self::Free => 2,
            Self::Pinned => 1,
            Self::Clamped => 0,
        }
    }
}

/// Linear damping: `C = c ∫NᵀN dx + a₀M + a₁K`.
///
/// ```
/// let damping = teeter_beam::Damping { viscous: 0.4, ..Default::default() };
/// assert_eq!(damping.rayleigh_stiffness, 0.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Damping {
    /// External viscous damping c per length, N s/m².
    pub viscous: f64,
    /// Rayleigh's factor a₀ of the mass matrix, 1/s.
    pub rayleigh_mass: f64,
    /// Rayleigh's factor a₁ of the stiffness matrix, s.
    pub rayleigh_stiffness: f64,
}

/// All that [`crate::Beam::new`] needs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeamSpec {
    /// Length between the ends, m.
    pub span: f64,
    /// Number of elements, all of one length.
    pub elements: usize,
    /// The cross-section, the same all along.
    pub section: Section,
    /// The supports at x = 0 and at x = span.
    pub supports: [Support; 2],
    /// Damping.
    pub damping: Damping,
}

impl BeamSpec {
    pub(crate) fn validate(&self) -> Result<(), BeamError> {
        self.validate_continuous()?;
        let count = |rule| BeamError::Count { field: "elements", value: self.elements, rule };
        if self.elements == 0 || self.elements > MAX_ELEMENTS {
            return Err(count("1 to 10000"));
        }
        if self.elements == 1 && self.supports == [Support::Clamped; 2] {
            return Err(count("at least 2 between two clamped ends, else nothing can move"));
        }
        let d = &self.damping;
        not_negative("damping.viscous", d.viscous)?;
        not_negative("damping.rayleigh_mass", d.rayleigh_mass)?;
        not_negative("damping.rayleigh_stiffness", d.rayleigh_stiffness)?;
        // l³ and EI/l³ enter the matrices: a span that is a valid number can still overflow them.
        let l = self.span / self.elements as f64;
        let stiffest = self.section.bending_stiffness / (l * l * l);
        let heaviest = self.section.mass_per_length * l * l * l;
        let rule = "such that EI/l³ and ρA l³ (l the element length) are finite and > 0";
        check("span", self.span, stiffest.is_normal() && heaviest.is_normal(), rule)
    }

    fn validate_continuous(&self) -> Result<(), BeamError> {
        positive("span", self.span)?;
        self.section.validate()
    }

    /// Exact circular frequency, rad/s, of elastic mode `mode` (from 1) of the continuous, undamped beam:
    /// `(β/L)² √(EI/ρA)`. The rigid motions of a beam that its supports leave free are not counted.
    ///
    /// The finite elements reproduce it from above, with an error of order n⁻⁴.
    ///
    /// # Errors
    /// [`BeamError`] for a span or section that is not finite and positive, or a mode outside 1..=1 000 000.
    ///
    /// ```
    /// use teeter_beam::{BeamSpec, Damping, Section, Support};
    /// let spec = BeamSpec {
    ///     span: 0.36,
    ///     elements: 20,
    ///     section: Section::rectangle(0.03, 0.0015, 69e9, 2700.0)?,
    ///     supports: [Support::Pinned, Support::Pinned],
    ///     damping: Damping::default(),
    /// };
    /// assert!((spec.circular_frequency(1)? - 166.70093785911652).abs() < 1e-11);
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn circular_frequency(&self, mode: usize) -> Result<f64, BeamError> {
        self.validate_continuous()?;
        let wave_number = modes::beta(self.supports, mode)? / self.span;
        let omega = wave_number * wave_number * (self.section.bending_stiffness / self.section.mass_per_length).sqrt();
        check("span", self.span, omega.is_normal(), "such that the circular frequency is finite and > 0")?;
        Ok(omega)
    }

    /// The viscous damping c = 2ζω ρA (N s/m²) that gives mode `mode` the damping ratio `ratio`.
    ///
    /// # Errors
    /// As [`BeamSpec::circular_frequency`]; [`BeamError::Value`] for a ratio that is not finite and ≥ 0.
    ///
    /// ```
    /// # use teeter_beam::{BeamSpec, Damping, Section, Support};
    /// let mut spec = BeamSpec {
    ///     span: 0.36,
    ///     elements: 20,
    ///     section: Section::rectangle(0.03, 0.0015, 69e9, 2700.0)?,
    ///     supports: [Support::Pinned, Support::Pinned],
    ///     damping: Damping::default(),
    /// };
    /// spec.damping.viscous = spec.viscous_for_ratio(1, 0.01)?;
    /// assert!((spec.damping.viscous - 0.4050832790).abs() < 1e-10);
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn viscous_for_ratio(&self, mode: usize, ratio: f64) -> Result<f64, BeamError> {
        not_negative("ratio", ratio)?;
        Ok(2.0 * ratio * self.circular_frequency(mode)? * self.section.mass_per_length)
    }
}

fn positive(field: &'static str, value: f64) -> Result<(), BeamError> {
    check(field, value, value > 0.0, "finite and > 0")
}

fn not_negative(field: &'static str, value: f64) -> Result<(), BeamError> {
    check(field, value, value >= 0.0, "finite and >= 0")
}
