//! The deflection between nodes of a beam that bears loads there.
//!
//! A static solution is exact at the nodes, wherever the loads are; between them the shape
//! functions leave out what a load bends its own element by with both nodes held. That is the
//! element's particular solution. It is that of the element cut free at its right end, by
//! singularity functions ⟨s − a⟩ⁿ, and on top of it the shape functions that take the right node
//! back to where it was:
//!
//! ```text
//! EI ψ' = M,   w' = ψ − V/(GA_s)
//! force P at a:         M = P⟨s − a⟩                         V = P⟨s − a⟩⁰
//! couple C at a:        M = −C⟨s − a⟩⁰                       V = 0
//! load p from a to b:   M = ½p(⟨s − a⟩² − ⟨s − b⟩²)          V = p(⟨s − a⟩ − ⟨s − b⟩)
//! ```

use crate::beam::Beam;
use crate::element::Element;
use crate::error::{BeamError, check};
use crate::forces::SpanLoad;
use crate::shape::Deflection;

/// Deflection, rotation of the section and slope of the axis of an element cut free at its right
/// end.
#[derive(Debug, Clone, Copy, Default)]
struct Free {
    w: f64,
    rotation: f64,
    slope: f64,
}

impl Free {
    /// Adds what a term M = m ⟨s − a⟩ⁿ/n! of the moment bends, `beyond` = s − a, and its V = M'.
    fn add(&mut self, element: &Element, m: f64, n: i32, beyond: f64) {
        if beyond <= 0.0 {
            return;
        }
        let power = |k: i32| beyond.powi(k) / (1..=k).map(f64::from).product::<f64>();
        let (bend, shear) = (m / element.section.bending_stiffness, m / element.section.shear_stiffness);
        let rotation = bend * power(n + 1);
        self.rotation += rotation;
        self.w += bend * power(n + 2);
        self.slope += rotation;
        if n > 0 {
            self.w -= shear * power(n);
            self.slope -= shear * power(n - 1);
        }
    }
}

/// A load on one element, its places from the element's left end, m.
#[derive(Debug, Clone, Copy)]
enum Own {
    Point { at: f64, force: f64, couple: f64 },
    Uniform { part: [f64; 2], load: f64 },
}

impl Own {
    /// What of a load is on element `e`.
    fn of(beam: &Beam, e: usize, load: &SpanLoad) -> Self {
        let (left, element) = (beam.mesh.x[e], &beam.elements[e]);
        match *load {
            SpanLoad::Point { x, force, couple } => Self::Point { at: x - left, force, couple },
            SpanLoad::Uniform { from, to, load } => {
                Self::Uniform { part: [from, to].map(|x| (x - left).clamp(0.0, element.length)), load }
            }
            SpanLoad::Weight { gravity } => {
                Self::Uniform { part: [0.0, element.length], load: gravity * element.section.mass_per_length }
            }
        }
    }

    fn bend(&self, element: &Element, s: f64, free: &mut Free) {
        match *self {
            Self::Point { at, force, couple } => {
                // Off the element, or at one of its nodes, it bends nothing between them.
                if at > 0.0 && at < element.length {
                    free.add(element, force, 1, s - at);
                    free.add(element, -couple, 0, s - at);
                }
            }
            Self::Uniform { part: [from, to], load } => {
                free.add(element, load, 2, s - from);
                free.add(element, -load, 2, s - to);
            }
        }
    }
}

impl Beam {
    /// Deflection and slope at x of the beam in the shape `q` under these loads, those between
    /// nodes with what they bend their own elements by: exact between the nodes where it is at
    /// them, as after [`solve_static`](Self::solve_static) with the same loads, Euler–Bernoulli's
    /// or Timoshenko's. [`deflection_at`](Self::deflection_at) leaves that part out: for a force P
    /// in the middle of an element of length l it is Pl³/(192 EI) (and Pl/(4 GA_s)).
    ///
    /// Of a beam on a foundation or under an axial force nodes are not exact either; there the part
    /// that is added is that of the element without them. The slope is that of the axis; where
    /// shear makes it jump, at a force, that on one side or the other.
    ///
    /// # Errors
    /// [`BeamError::OutsideSpan`] for a place or a load that is not on the beam;
    /// [`BeamError::Value`] for a load that is not finite.
    ///
    /// # Panics
    /// If `q` has not [`Beam::dofs`] entries.
    ///
    /// ```
    /// use teeter_beam::{Beam, BeamSpec, Section, SpanLoad};
    /// let beam = Beam::new(BeamSpec::new(2.0, 1, Section::new(5.0, 1.0)?))?; // one element, pinned at both ends
    /// let mut q = vec![0.0; beam.dofs()];
    /// beam.add_point_load(1.0, -3.0, &mut q)?;
    /// beam.solve_static(&mut q)?;
    /// let loads = [SpanLoad::Point { x: 1.0, force: -3.0, couple: 0.0 }];
    /// let exact = -3.0 * 2.0_f64.powi(3) / (48.0 * 5.0); // P L³/(48 EI)
    /// assert!((beam.deflection_under(&q, &loads, 1.0)?.w / exact - 1.0).abs() < 1e-14);
    /// assert!(beam.deflection_at(&q, 1.0).is_some_and(|d| (d.w / exact - 0.75).abs() < 1e-14));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn deflection_under(&self, q: &[f64], loads: &[SpanLoad], x: f64) -> Result<Deflection, BeamError> {
        let span = self.spec.span;
        let on_beam = |x: f64| if (0.0..=span).contains(&x) { Ok(()) } else { Err(BeamError::OutsideSpan { x, span }) };
        let mut d = self.deflection_at(q, x).ok_or(BeamError::OutsideSpan { x, span })?;
        let (e, xi) = self.mesh.locate(x);
        let element = &self.elements[e];
        let (mut here, mut end) = (Free::default(), Free::default());
        for load in loads {
            match *load {
                SpanLoad::Point { x, force, couple } => {
                    on_beam(x)?;
                    check("force", force, true, "finite")?;
                    check("couple", couple, true, "finite")?;
                }
                SpanLoad::Uniform { from, to, load } => {
                    on_beam(from)?;
                    on_beam(to)?;
                    check("load", load, true, "finite")?;
                }
                SpanLoad::Weight { gravity } => {
                    check("gravity", gravity, true, "finite")?;
                }
            }
            let own = Own::of(self, e, load);
            own.bend(element, xi * element.length, &mut here);
            own.bend(element, element.length, &mut end);
        }
        let (n, dn) = (element.shape(xi), element.shape_slope(xi));
        d.w += here.w - (n[2] * end.w + n[3] * end.rotation);
        d.slope += here.slope - (dn[2] * end.w + dn[3] * end.rotation);
        Ok(d)
    }
}
