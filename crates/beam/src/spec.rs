//! The numbers that make a beam: mesh, sections, supports, what it carries and rests on, damping.

use crate::error::{BeamError, check};
use crate::mesh::SHORTEST;
use crate::modal_damping::MOST;
use crate::modes;
use crate::section::{Section, not_negative, positive};
use crate::support::Support;

/// The finest mesh that a beam may have.
///
/// cond(K) grows like the fourth power of the element count: beyond this, K has no correct digit
/// left in double precision.
pub const MAX_ELEMENTS: usize = 10_000;

/// Linear damping: `C = c ∫NᵀN dx + a₀M + a₁K`, and ratios of single modes.
///
/// What each does to high modes: viscous damping gives mode i the ratio c/(2ρA ω_i), ever less; a₀
/// likewise, a₀/(2ω_i); a₁ gives a₁ω_i/2, ever more: a high mode of a fine mesh is overdamped by
/// it. Ratios of single modes damp those and leave the others alone.
///
/// ```
/// let damping = teeter_beam::Damping::none().with_viscous(0.4);
/// assert_eq!(damping.rayleigh_stiffness, 0.0);
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct Damping {
    /// External viscous damping c per length, N s/m².
    pub viscous: f64,
    /// Rayleigh's factor a₀ of the mass matrix, 1/s.
    pub rayleigh_mass: f64,
    /// Rayleigh's factor a₁ of the stiffness matrix, s.
    pub rayleigh_stiffness: f64,
    /// Damping ratios of the first elastic modes of the finite-element beam, on top of the rest.
    pub modal: Vec<f64>,
}

impl Damping {
    /// None.
    #[must_use]
    pub fn none() -> Self {
        Self::default()
    }

    /// With this viscous damping c per length, N s/m², at least 0.
    #[must_use]
    pub fn with_viscous(self, viscous: f64) -> Self {
        Self { viscous, ..self }
    }

    /// With this factor a₀ of the mass matrix, 1/s, at least 0.
    #[must_use]
    pub fn with_rayleigh_mass(self, rayleigh_mass: f64) -> Self {
        Self { rayleigh_mass, ..self }
    }

    /// With this factor a₁ of the stiffness matrix, s, at least 0.
    #[must_use]
    pub fn with_rayleigh_stiffness(self, rayleigh_stiffness: f64) -> Self {
        Self { rayleigh_stiffness, ..self }
    }

    /// With these damping ratios of the first elastic modes, each at least 0, at most 64 of them.
    #[must_use]
    pub fn with_modal(self, modal: Vec<f64>) -> Self {
        Self { modal, ..self }
    }

    /// Rayleigh's factors that give two circular frequencies their damping ratios:
    /// ζ_i = a₀/(2ω_i) + a₁ω_i/2.
    ///
    /// # Errors
    /// [`BeamError::Value`] for frequencies that are not positive and different, ratios that are
    /// negative, and pairs that only a negative factor would give (one of the two ratios too large
    /// for the other).
    ///
    /// ```
    /// use teeter_beam::{Damping, DampingRatio};
    /// let damping = Damping::rayleigh([DampingRatio::new(100.0, 0.02), DampingRatio::new(400.0, 0.02)])?;
    /// assert!((damping.rayleigh_mass - 3.2).abs() < 1e-12);
    /// assert!((damping.rayleigh_stiffness - 8e-5).abs() < 1e-17);
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn rayleigh(ratios: [DampingRatio; 2]) -> Result<Self, BeamError> {
        for DampingRatio { circular_frequency, ratio } in ratios {
            positive("circular_frequency", circular_frequency)?;
            not_negative("ratio", ratio)?;
        }
        let [w1, w2] = ratios.map(|at| at.circular_frequency);
        let [z1, z2] = ratios.map(|at| at.ratio);
        check("circular_frequency", w2, w1 != w2, "other than the first one")?;
        let (low, high) = (w1 / w2, w2 / w1);
        // ζ₁ω₂ − ζ₂ω₁ and ζ₂ω₂ − ζ₁ω₁ over ω₂² − ω₁², in quotients that neither overflow nor
        // underflow.
        let stiffness = 2.0 * (z2 - z1 * low) / (w2 * (1.0 - low * low));
        let mass = 2.0 * w1 * (z1 - z2 * low) / (1.0 - low * low);
        let rule =
            "between ratio 1 times the quotient of the frequencies and ratio 1 over it; else a factor is negative";
        check("ratio", z2, mass >= 0.0 && stiffness >= 0.0 && high.is_finite(), rule)?;
        Ok(Self { rayleigh_mass: mass, rayleigh_stiffness: stiffness, ..Self::default() })
    }

    fn validate(&self) -> Result<(), BeamError> {
        not_negative("damping.viscous", self.viscous)?;
        not_negative("damping.rayleigh_mass", self.rayleigh_mass)?;
        not_negative("damping.rayleigh_stiffness", self.rayleigh_stiffness)?;
        if self.modal.len() > MOST {
            return Err(BeamError::Count {
                field: "damping.modal",
                value: self.modal.len(),
                rule: "at most 64 ratios",
            });
        }
        self.modal.iter().try_for_each(|ratio| not_negative("damping.modal", *ratio))
    }
}

/// A damping ratio and the frequency that is to have it, for [`Damping::rayleigh`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct DampingRatio {
    /// Circular frequency ω, rad/s.
    pub circular_frequency: f64,
    /// Damping ratio ζ, of the critical damping; without unit.
    pub ratio: f64,
}

impl DampingRatio {
    /// ζ at ω, rad/s.
    #[must_use]
    pub fn new(circular_frequency: f64, ratio: f64) -> Self {
        Self { circular_frequency, ratio }
    }
}

/// A part of the span with a section of its own.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Segment {
    /// Its left end, m.
    pub from: f64,
    /// Its right end, m.
    pub to: f64,
    /// Its section.
    pub section: Section,
}

impl Segment {
    /// From one place to another, m.
    #[must_use]
    pub fn new(from: f64, to: f64, section: Section) -> Self {
        Self { from, to, section }
    }
}

/// A support between the ends.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct InnerSupport {
    /// Where, m.
    pub x: f64,
    /// How the beam is held there.
    pub support: Support,
}

impl InnerSupport {
    /// At x, m.
    #[must_use]
    pub fn new(x: f64, support: Support) -> Self {
        Self { x, support }
    }
}

/// A mass that the beam carries.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Lump {
    /// Where, m.
    pub x: f64,
    /// Mass, kg.
    pub mass: f64,
    /// Rotatory inertia about the axis, kg m².
    pub inertia: f64,
}

impl Lump {
    /// A point mass: x in m, mass in kg.
    #[must_use]
    pub fn new(x: f64, mass: f64) -> Self {
        Self { x, mass, inertia: 0.0 }
    }

    /// With a rotatory inertia about the axis, kg m².
    #[must_use]
    pub fn with_inertia(self, inertia: f64) -> Self {
        Self { inertia, ..self }
    }
}

/// Winkler's foundation under a part of the span: a force per length −k w − c ẇ.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Foundation {
    /// Its left end, m.
    pub from: f64,
    /// Its right end, m.
    pub to: f64,
    /// Stiffness k per length, N/m².
    pub stiffness: f64,
    /// Damping c per length, N s/m².
    pub damping: f64,
}

impl Foundation {
    /// An elastic one from one place to another, m, with its stiffness k per length, N/m².
    #[must_use]
    pub fn new(from: f64, to: f64, stiffness: f64) -> Self {
        Self { from, to, stiffness, damping: 0.0 }
    }

    /// With a damping c per length, N s/m².
    #[must_use]
    pub fn with_damping(self, damping: f64) -> Self {
        Self { damping, ..self }
    }
}

/// What happens along the axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Axial {
    /// The supports leave it free: no axial motion is modelled, and none costs anything.
    #[default]
    Free,
    /// Both ends are held along the axis. A deflection stretches the beam and with it grows an
    /// axial force, the same all along (axial inertia left out): N = N₀ + (EA)/(2L) ∫w'² dx, with
    /// 1/EA the mean over the span. Woinowsky-Krieger (1950, J. Appl. Mech. 17, 35–36).
    Held,
    /// Axial dofs u with their inertia; made by [`Axial::elastic`]. Linear: they don't feel the
    /// deflection.
    #[non_exhaustive]
    Elastic {
        /// Whether u = 0 at the left and at the right end.
        held: [bool; 2],
    },
}

impl Axial {
    /// Axial dofs, held at the left and at the right end or not.
    #[must_use]
    pub fn elastic(held: [bool; 2]) -> Self {
        Self::Elastic { held }
    }
}

/// All that [`crate::Beam::new`] needs. Made by [`BeamSpec::new`] and the methods that follow it;
/// every field may be written to.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct BeamSpec {
    /// Length between the ends, m.
    pub span: f64,
    /// Number of elements, of one length as far as nodes at supports, lumps and ends of segments
    /// allow; these may take a few more. See [`BeamSpec::nodes`].
    pub elements: usize,
    /// The cross-section, where no segment has another one.
    pub section: Section,
    /// The supports at x = 0 and at x = span.
    pub supports: [Support; 2],
    /// Damping.
    pub damping: Damping,
    /// Parts with sections of their own; the last one that covers a place holds there.
    pub segments: Vec<Segment>,
    /// Supports between the ends.
    pub inner_supports: Vec<InnerSupport>,
    /// Masses that it carries.
    pub lumps: Vec<Lump>,
    /// What it rests on.
    pub foundations: Vec<Foundation>,
    /// What happens along its axis.
    pub axial: Axial,
    /// Axial force N₀ that is there whatever the beam does, N; tension is positive. It stiffens the
    /// beam against bending by N₀ ∫N'ᵀN' dx.
    pub axial_force: f64,
    /// Nodes of a mesh of one's own, m, rising from 0 to the span; replaces `elements` where it
    /// isn't empty.
    pub nodes: Vec<f64>,
}

impl BeamSpec {
    /// A beam of one section between two pins, undamped.
    ///
    /// ```
    /// use teeter_beam::{Beam, BeamSpec, Section, Support};
    /// let section = Section::rectangle(0.03, 0.0015, 69e9, 2700.0)?;
    /// let two_spans = BeamSpec::new(0.72, 40, section).supported([Support::Clamped; 2]).support_at(0.36, Support::Pinned);
    /// assert_eq!(Beam::new(two_spans)?.free_dofs(), 2 * 41 - 4 - 1);
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    #[must_use]
    pub fn new(span: f64, elements: usize, section: Section) -> Self {
        Self {
            span,
            elements,
            section,
            supports: [Support::Pinned; 2],
            damping: Damping::default(),
            segments: Vec::new(),
            inner_supports: Vec::new(),
            lumps: Vec::new(),
            foundations: Vec::new(),
            axial: Axial::Free,
            axial_force: 0.0,
            nodes: Vec::new(),
        }
    }

    /// With these supports at its ends.
    #[must_use]
    pub fn supported(self, supports: [Support; 2]) -> Self {
        Self { supports, ..self }
    }

    /// With this damping.
    #[must_use]
    pub fn damped(self, damping: Damping) -> Self {
        Self { damping, ..self }
    }

    /// With another section between two places, m.
    #[must_use]
    pub fn segment(mut self, from: f64, to: f64, section: Section) -> Self {
        self.segments.push(Segment::new(from, to, section));
        self
    }

    /// With one more support, at x (m).
    #[must_use]
    pub fn support_at(mut self, x: f64, support: Support) -> Self {
        self.inner_supports.push(InnerSupport::new(x, support));
        self
    }

    /// With a mass (kg) and a rotatory inertia (kg m²) at x (m).
    #[must_use]
    pub fn lump(mut self, x: f64, mass: f64, inertia: f64) -> Self {
        self.lumps.push(Lump::new(x, mass).with_inertia(inertia));
        self
    }

    /// On one more foundation.
    #[must_use]
    pub fn foundation(mut self, foundation: Foundation) -> Self {
        self.foundations.push(foundation);
        self
    }

    /// With this along its axis.
    #[must_use]
    pub fn axial(self, axial: Axial) -> Self {
        Self { axial, ..self }
    }

    /// Under a given axial force, N; tension is positive.
    #[must_use]
    pub fn axial_force(self, axial_force: f64) -> Self {
        Self { axial_force, ..self }
    }

    /// With the nodes of a mesh of one's own, m, rising from 0 to the span.
    #[must_use]
    pub fn meshed(self, nodes: Vec<f64>) -> Self {
        Self { nodes, ..self }
    }

    pub(crate) fn validate(&self) -> Result<(), BeamError> {
        self.validate_continuous()?;
        let count = |rule| BeamError::Count { field: "elements", value: self.elements, rule };
        if self.nodes.is_empty() {
            if self.elements == 0 || self.elements > MAX_ELEMENTS {
                return Err(count("1 to 10000"));
            }
        } else {
            self.validate_nodes()?;
        }
        self.damping.validate()?;
        let on_beam = |field, x: f64| check(field, x, (0.0..=self.span).contains(&x), "on the beam, in [0, span]");
        let part = |fields: [&'static str; 2], from: f64, to: f64| {
            on_beam(fields[0], from)?;
            on_beam(fields[1], to)?;
            let long = to - from >= SHORTEST * self.span;
            check(fields[1], to, long, "right of where it begins, by at least a millionth of the span")
        };
        for segment in &self.segments {
            part(["segment.from", "segment.to"], segment.from, segment.to)?;
            segment.section.validate()?;
        }
        for foundation in &self.foundations {
            part(["foundation.from", "foundation.to"], foundation.from, foundation.to)?;
            not_negative("foundation.stiffness", foundation.stiffness)?;
            not_negative("foundation.damping", foundation.damping)?;
        }
        for support in self.supports {
            support.validate()?;
        }
        for &InnerSupport { x, support } in &self.inner_supports {
            check("support.x", x, x > 0.0 && x < self.span, "between the ends; these have supports of their own")?;
            support.validate()?;
        }
        for lump in &self.lumps {
            on_beam("lump.x", lump.x)?;
            not_negative("lump.mass", lump.mass)?;
            not_negative("lump.inertia", lump.inertia)?;
        }
        check("axial_force", self.axial_force, true, "finite")?;
        if self.axial != Axial::Free {
            for section in self.segments.iter().map(|segment| &segment.section).chain([&self.section]) {
                let (field, reason) = ("section.axial_stiffness", "where the axis is held or has dofs");
                section.axial_stiffness.ok_or(BeamError::Missing { field, reason })?;
            }
        }
        // l³ and EI/l³ enter the matrices: a span that is a valid number can still overflow them.
        let l = self.span / self.elements.max(1) as f64;
        let stiffest = self.section.bending_stiffness / (l * l * l);
        let heaviest = self.section.mass_per_length * l * l * l;
        let rule = "such that EI/l³ and ρA l³ (l the element length) are finite and > 0";
        check("span", self.span, stiffest.is_normal() && heaviest.is_normal(), rule)
    }

    fn validate_nodes(&self) -> Result<(), BeamError> {
        let (count, last) = (self.nodes.len(), self.nodes[self.nodes.len() - 1]);
        if !(2..=MAX_ELEMENTS + 1).contains(&count) {
            return Err(BeamError::Count { field: "nodes", value: count, rule: "2 to 10001 of them" });
        }
        check("nodes", self.nodes[0], self.nodes[0] == 0.0, "0 at the left end")?;
        check("nodes", last, last == self.span, "the span at the right end")?;
        let least = SHORTEST * self.span;
        for pair in self.nodes.windows(2) {
            check("nodes", pair[1], pair[1] - pair[0] >= least, "rising, by at least a millionth of the span")?;
        }
        Ok(())
    }

    fn validate_continuous(&self) -> Result<(), BeamError> {
        positive("span", self.span)?;
        self.section.validate()
    }

    /// Whether this is the uniform Euler–Bernoulli beam between two ends that the frequency
    /// equations are for.
    fn is_elementary(&self) -> bool {
        let s = &self.section;
        self.segments.is_empty()
            && self.inner_supports.is_empty()
            && self.lumps.is_empty()
            && self.foundations.is_empty()
            && self.axial_force == 0.0
            && s.shear_stiffness == f64::INFINITY
            && s.rotatory_inertia == 0.0
    }

    /// Exact circular frequency, rad/s, of elastic mode `mode` (from 1) of the continuous, undamped
    /// Euler–Bernoulli beam between free, pinned, clamped or guided ends: `(β/L)² √(EI/ρA)`. The
    /// rigid motions of a beam that its supports leave free are not counted.
    ///
    /// The finite elements reproduce it from above, with an error of order n⁻⁴.
    ///
    /// # Errors
    /// [`BeamError`] for a span or section that is not finite and positive, or a mode outside 1..=1
    /// 000 000; [`BeamError::NoFrequencyEquation`] for a beam with springs, inner supports, lumps,
    /// a foundation, segments, shear or an axial force: its modes are those of
    /// [`crate::Beam::modes`].
    ///
    /// ```
    /// use teeter_beam::{BeamSpec, Section};
    /// let spec = BeamSpec::new(0.36, 20, Section::rectangle(0.03, 0.0015, 69e9, 2700.0)?);
    /// assert!((spec.circular_frequency(1)? - 166.70093785911652).abs() < 1e-11);
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn circular_frequency(&self, mode: usize) -> Result<f64, BeamError> {
        self.validate_continuous()?;
        if !self.is_elementary() {
            return Err(BeamError::NoFrequencyEquation);
        }
        let wave_number = modes::beta(self.supports, mode)? / self.span;
        let omega = wave_number * wave_number * (self.section.bending_stiffness / self.section.mass_per_length).sqrt();
        check("span", self.span, omega.is_normal(), "such that the circular frequency is finite and > 0")?;
        Ok(omega)
    }

    /// The viscous damping c = 2ζω ρA (N s/m²) that gives mode `mode` the damping ratio `ratio`.
    ///
    /// # Errors
    /// As [`BeamSpec::circular_frequency`]; [`BeamError::Value`] for a ratio that is not finite and
    /// ≥ 0.
    ///
    /// ```
    /// # use teeter_beam::{BeamSpec, Section};
    /// let mut spec = BeamSpec::new(0.36, 20, Section::rectangle(0.03, 0.0015, 69e9, 2700.0)?);
    /// spec.damping.viscous = spec.viscous_for_ratio(1, 0.01)?;
    /// assert!((spec.damping.viscous - 0.4050832790).abs() < 1e-10);
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn viscous_for_ratio(&self, mode: usize, ratio: f64) -> Result<f64, BeamError> {
        not_negative("ratio", ratio)?;
        Ok(2.0 * ratio * self.circular_frequency(mode)? * self.section.mass_per_length)
    }
}
