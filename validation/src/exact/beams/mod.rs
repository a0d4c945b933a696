//! Plane beams and bars: closed forms and scalar equations, with nothing of teeter-beam in them.
//!
//! x runs along the span, w > 0 is upwards, forces are positive upwards, couples and rotations counter-clockwise. With the section's
//! rotation r (Euler–Bernoulli: r = w′), moment M = EI r′ and shear force T = GA_s (w′ − r) are what the part right of a section
//! does to the part left of it:
//!
//! ```text
//! T′ = −f + ρA ẅ,   M′ = −T + ρI r̈        (Euler–Bernoulli: EI w″″ + ρA ẅ = f, M = EI w″, T = −EI w‴)
//! ```

pub(crate) mod axial_force;
pub(crate) mod bar_impact;
pub(crate) mod decay;
pub(crate) mod duffing;
pub(crate) mod end_conditions;
pub(crate) mod ends;
pub(crate) mod frequencies;
pub(crate) mod lump;
pub(crate) mod membrane;
pub(crate) mod moving_force;
pub(crate) mod statics;
pub(crate) mod timoshenko;
pub(crate) mod two_spans;
pub(crate) mod winkler;

/// A uniform Euler–Bernoulli beam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Uniform {
    /// L, m.
    pub(crate) span: f64,
    /// EI, N·m².
    pub(crate) bending: f64,
    /// ρA, kg/m.
    pub(crate) mass: f64,
}

impl Uniform {
    /// ω = (β/L)² √(EI/ρA), rad/s, of a wave number β (βL of the books).
    pub(crate) fn frequency(&self, beta: f64) -> f64 {
        (beta / self.span).powi(2) * (self.bending / self.mass).sqrt()
    }
}

/// sinh a · sinh b / sinh c for 0 ≤ a + b ≤ c, without large numbers on the way.
fn sinh_ratio(a: f64, b: f64, c: f64) -> f64 {
    let part = |x: f64| -(-2.0 * x).exp_m1();
    0.5 * (a + b - c).exp() * part(a) * part(b) / part(c)
}

/// The first `count` roots of `f` after `start`, each between two neighbours of a grid of width `step`: none may be double, no two
/// nearer than that.
fn roots(f: impl Fn(f64) -> f64, start: f64, step: f64, count: usize) -> Vec<f64> {
    let mut found = Vec::with_capacity(count);
    let (mut k, mut before) = (0_u32, f(start));
    while found.len() < count {
        let low = start + f64::from(k) * step;
        let after = f(low + step);
        if before.is_nan() || after.is_nan() {
            break;
        }
        if (before > 0.0) != (after > 0.0) {
            found.push(super::root::boundary(low, low + step, |x| (f(x) > 0.0) == (after > 0.0)));
        }
        (k, before) = (k + 1, after);
    }
    found
}

#[cfg(test)]
mod tests {
    /// Whether |a/b − 1| ≤ `within`; tells both if not.
    pub(super) fn agree(a: f64, b: f64, within: f64) {
        assert!(if b == 0.0 { a.abs() <= within } else { (a / b - 1.0).abs() <= within }, "{a} {b}");
    }

    #[test]
    fn hyperbolic_ratios() {
        agree(super::sinh_ratio(0.3, 0.5, 1.1), 0.3_f64.sinh() * 0.5_f64.sinh() / 1.1_f64.sinh(), 1e-15);
        agree(super::sinh_ratio(400.0, 600.0, 1000.0), 0.5, 1e-15);
    }

    #[test]
    fn roots_of_a_sine() {
        let found = super::roots(f64::sin, 0.5, 0.1, 5);
        for (k, root) in (1..).zip(&found) {
            agree(*root, f64::from(k) * std::f64::consts::PI, 1e-15);
        }
        assert_eq!(found.len(), 5);
    }

    #[test]
    fn a_frequency_has_its_unit() {
        // The source paper's beam: 166.700 937 859 rad/s.
        let beam = super::Uniform { span: 0.36, bending: 0.582_187_5, mass: 0.1215 };
        agree(beam.frequency(std::f64::consts::PI), 166.700_937_859_116_52, 1e-15);
    }
}
