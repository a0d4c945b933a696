//! From dofs to the points of the beam, and back from forces there.

use crate::beam::Beam;

/// The shape functions at a point of the beam, constrained columns left out:
/// `w = Σ n[i] q[columns[i]]` and `w' = Σ dn[i] q[columns[i]]` over `i < len`.
///
/// What lies beyond `len` is 0 (column 0, value 0), so a sum over all four is the same where the
/// beam has any dof.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ShapeAt {
    /// How many of the four places are in use.
    pub len: usize,
    /// Indices of free dofs, ascending.
    pub columns: [usize; 4],
    /// N: of a deflection dimensionless, of a slope in m.
    pub n: [f64; 4],
    /// dN/dx: of a deflection in 1/m, of a slope dimensionless.
    pub dn: [f64; 4],
}

impl ShapeAt {
    /// Deflection and slope (or their rates) for the dofs `q` (or their rates).
    ///
    /// # Panics
    /// If `q` is shorter than the beam's vectors.
    #[inline]
    pub fn deflection(&self, q: &[f64]) -> Deflection {
        let mut d = Deflection { w: 0.0, slope: 0.0 };
        for i in 0..self.len.min(4) {
            let value = q[self.columns[i]];
            d.w += self.n[i] * value;
            d.slope += self.dn[i] * value;
        }
        d
    }

    /// f += force Nᵀ + couple N'ᵀ: the consistent nodal load of a force (N) and a couple (N m,
    /// counter-clockwise) there.
    ///
    /// # Panics
    /// If `f` is shorter than the beam's vectors.
    #[inline]
    pub fn add_load(&self, force: f64, couple: f64, f: &mut [f64]) {
        for i in 0..self.len.min(4) {
            f[self.columns[i]] += force * self.n[i] + couple * self.dn[i];
        }
    }
}

/// The axial shape functions at a point of a beam with axial dofs, held ones left out:
/// `u = Σ n[i] q[columns[i]]` over `i < len`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct AxialShape {
    /// How many of the two places are in use; 0 for a beam without axial dofs.
    pub len: usize,
    /// Indices of free dofs, ascending.
    pub columns: [usize; 2],
    /// Values, without unit.
    pub n: [f64; 2],
}

impl AxialShape {
    /// The axial displacement (or its rate) for the dofs `q` (or their rates).
    ///
    /// # Panics
    /// If `q` is shorter than the beam's vectors.
    #[inline]
    pub fn displacement(&self, q: &[f64]) -> f64 {
        (0..self.len.min(2)).map(|i| self.n[i] * q[self.columns[i]]).sum()
    }

    /// f += force Nᵀ: the nodal load of an axial force (N, in the direction of rising x) there.
    ///
    /// # Panics
    /// If `f` is shorter than the beam's vectors.
    #[inline]
    pub fn add_load(&self, force: f64, f: &mut [f64]) {
        for i in 0..self.len.min(2) {
            f[self.columns[i]] += force * self.n[i];
        }
    }
}

/// Deflection and slope of a point of the beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deflection {
    /// w, m, upwards.
    pub w: f64,
    /// w', rad.
    pub slope: f64,
}

/// What deflection and slope of a beam do not exceed anywhere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DeflectionBounds {
    /// No w is above it, m.
    pub highest: f64,
    /// No |w'| is above it, rad.
    pub steepest: f64,
}

impl Beam {
    /// Bounds of the deflection for the dofs `q`, from its nodes alone: in an element of length l
    /// the shape functions of the two w are not negative and sum to 1, those of the two ψ sum to at
    /// most l/4; of their derivatives the first are at most 3/(2l), the second sum to at most 1.
    ///
    /// # Panics
    /// If `q` has not [`Beam::dofs`] entries.
    ///
    /// ```
    /// # use teeter_beam::{Beam, BeamSpec, Section, Support};
    /// # let beam = Beam::new(BeamSpec::new(1.0, 4, Section::new(1.0, 1.0)?).supported([Support::Free; 2]))?;
    /// let rising = beam.from_nodes(&[[0.5, 0.0]; 5])?;
    /// assert_eq!(beam.deflection_bounds(&rising).highest, 0.5);
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    #[must_use]
    pub fn deflection_bounds(&self, q: &[f64]) -> DeflectionBounds {
        assert_eq!(q.len(), self.dofs(), "a vector must have one entry per degree of freedom");
        let [least, most] = self.mesh.lengths;
        // w and ψ side by side, by comparisons that know no NaN: the machine's own.
        let (mut high, mut low) = ([f64::NEG_INFINITY; 2], [f64::INFINITY; 2]);
        for node in self.bend(q) {
            for k in 0..2 {
                high[k] = if node[k] > high[k] { node[k] } else { high[k] };
                low[k] = if node[k] < low[k] { node[k] } else { low[k] };
            }
        }
        let ([high, turn], [low, back]) = (high, low);
        let turn = turn.max(-back);
        DeflectionBounds { highest: high + 0.25 * most * turn, steepest: 1.5 * (high - low) / least + turn }
    }

    /// The shape functions at x; `None` outside the closed [0, span], and for NaN.
    ///
    /// ```
    /// # use teeter_beam::{Beam, BeamSpec, Section, Support};
    /// # let beam = Beam::new(BeamSpec::new(1.0, 4, Section::new(1.0, 1.0)?))?;
    /// let shape = beam.shape_at(0.1).ok_or("off the beam")?;
    /// assert_eq!(shape.columns[..shape.len], [1, 2, 3]); // w of the pinned node is not a dof
    /// assert!(beam.shape_at(1.0).is_some() && beam.shape_at(1.0 + 1e-12).is_none());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[inline]
    pub fn shape_at(&self, x: f64) -> Option<ShapeAt> {
        (x >= 0.0 && x <= self.spec.span).then(|| self.shape_inside(x))
    }

    /// The shape functions at the point of [0, span] nearest to x; at 0 for NaN.
    ///
    /// ```
    /// # use teeter_beam::{Beam, BeamSpec, Dof, Section, Support};
    /// # let beam = Beam::new(BeamSpec::new(1.0, 4, Section::new(1.0, 1.0)?))?;
    /// assert_eq!(Some(beam.shape_clamped(1.5)), beam.shape_at(1.0));
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    #[inline]
    pub fn shape_clamped(&self, x: f64) -> ShapeAt {
        // f64::max returns the other operand for NaN; `clamp` would keep it.
        self.shape_inside(x.max(0.0).min(self.spec.span))
    }

    #[inline]
    fn shape_inside(&self, x: f64) -> ShapeAt {
        let (element, xi) = self.mesh.locate(x);
        self.shape_in(element, xi)
    }

    /// The axial shape functions at the point of [0, span] nearest to x; empty for a beam without
    /// axial dofs.
    #[inline]
    pub fn axial_shape_clamped(&self, x: f64) -> AxialShape {
        let Some(bar) = &self.bar else { return AxialShape::default() };
        let (element, xi) = self.mesh.locate(x.max(0.0).min(self.spec.span));
        let first = 2 * self.nodes() + element;
        let mut shape = AxialShape::default();
        for (local, n) in [1.0 - xi, xi].into_iter().enumerate() {
            if !bar.held[element + local] {
                (shape.columns[shape.len], shape.n[shape.len]) = (first + local, n);
                shape.len += 1;
            }
        }
        shape
    }

    /// The shape functions in an element, at ξ in [0, 1], those of held dofs among them: what a
    /// load gives to a support is part of the reaction.
    #[inline]
    pub(crate) fn whole_shape(&self, element: usize, xi: f64) -> ShapeAt {
        let (e, first) = (&self.elements[element], 2 * element);
        ShapeAt { len: 4, columns: [first, first + 1, first + 2, first + 3], n: e.shape(xi), dn: e.shape_slope(xi) }
    }

    #[inline]
    fn shape_in(&self, element: usize, xi: f64) -> ShapeAt {
        let whole = self.whole_shape(element, xi);
        let held = [self.held[element], self.held[element + 1]];
        if held == [[false; 2]; 2] {
            return whole;
        }
        let mut shape = ShapeAt { len: 0, columns: [0; 4], n: [0.0; 4], dn: [0.0; 4] };
        for local in (0..4).filter(|local| !held[local / 2][local % 2]) {
            let i = shape.len;
            (shape.columns[i], shape.n[i], shape.dn[i]) = (whole.columns[local], whole.n[local], whole.dn[local]);
            shape.len += 1;
        }
        shape
    }

    /// Deflection and slope at x; `None` outside [0, span]. For rates give the rates of `q`.
    ///
    /// That is the shape functions', as contacts and time steps have it. Between nodes it lacks
    /// what a load there bends its element by; [`deflection_under`](Self::deflection_under) adds
    /// that.
    ///
    /// # Panics
    /// If `q` has not [`Beam::dofs`] entries.
    ///
    /// ```
    /// # use teeter_beam::{Beam, BeamSpec, Dof, Section, Support};
    /// # let beam = Beam::new(BeamSpec::new(1.0, 4, Section::new(1.0, 1.0)?).supported([Support::Free; 2]))?;
    /// let rising = beam.from_nodes(&[[0.5, 0.0]; 5])?;
    /// assert!(beam.deflection_at(&rising, 0.3).is_some_and(|d| (d.w - 0.5).abs() < 1e-15 && d.slope.abs() < 1e-14));
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn deflection_at(&self, q: &[f64], x: f64) -> Option<Deflection> {
        assert_eq!(q.len(), self.dofs(), "a vector must have one entry per degree of freedom");
        if !(x >= 0.0 && x <= self.spec.span) {
            return None;
        }
        let (element, xi) = self.mesh.locate(x);
        let (e, nodes) = (&self.elements[element], self.bend(q));
        let [[a, b], [c, d]] = [nodes[element], nodes[element + 1]];
        // What is held is 0 in q.
        let sum = |n: [f64; 4]| ((n[0] * a + n[1] * b) + n[2] * c) + n[3] * d;
        Some(Deflection { w: sum(e.shape(xi)), slope: sum(e.shape_slope(xi)) })
    }
}

#[cfg(test)]
mod tests {
    use crate::beam::tests::{all_supports, beam};
    use crate::support::Support;

    #[test]
    fn shapes_reproduce_a_cubic_everywhere_for_all_supports() {
        for supports in all_supports() {
            let beam = beam(6, supports);
            // Zero at both ends, and flat at the left one: every support but a clamp at the right.
            let cubic = |x: f64| [x * x * (1.0 - x), 2.0 * x - 3.0 * x * x];
            let nodes: Vec<[f64; 2]> = (0..7).map(|i| cubic(f64::from(i) / 6.0)).collect();
            let Ok(q) = beam.from_nodes(&nodes) else {
                assert!(matches!(supports[1], Support::Clamped | Support::Guided), "only the far slope is not zero");
                continue;
            };
            for k in 0..=60 {
                let x = f64::from(k) / 60.0;
                let d = beam.deflection_at(&q, x).unwrap();
                assert!((d.w - cubic(x)[0]).abs() < 1e-15 && (d.slope - cubic(x)[1]).abs() < 1e-14, "{supports:?} {x}");
            }
        }
    }

    #[test]
    fn shapes_end_at_the_closed_span() {
        let beam = beam(3, [Support::Free, Support::Pinned]);
        for x in [-1e-300, 1.0 + f64::EPSILON, f64::NAN, f64::INFINITY] {
            assert_eq!(beam.shape_at(x), None, "{x}");
        }
        assert_eq!(beam.shape_clamped(7.0), beam.shape_at(1.0).unwrap());
        assert_eq!(beam.shape_clamped(f64::NEG_INFINITY), beam.shape_at(0.0).unwrap());
        assert_eq!(beam.shape_clamped(f64::NAN), beam.shape_at(0.0).unwrap());
        let end = beam.shape_at(1.0).unwrap();
        assert_eq!((end.len, end.columns[..3].to_vec()), (3, vec![4, 5, 7]));
    }
}
