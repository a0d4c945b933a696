//! Deflection, section forces and reactions of a uniform beam at rest under forces, couples and a uniform load, held at its ends in any
//! way: Euler–Bernoulli, or Timoshenko with a shear stiffness.
//!
//! From the left end on, with w₀, r₀, M₀, T₀ there and ⟨x⟩ = max(x, 0) (Macaulay 1919; Timoshenko and Young, *Elements of Strength of
//! Materials*; Cowper 1966, doi 10.1115/1.3625046, for the shear), a force P at a, a couple C at b and a load q per length give
//!
//! ```text
//! T = T₀ − P⟨x−a⟩⁰ − q x
//! M = M₀ − T₀ x + P⟨x−a⟩ − C⟨x−b⟩⁰ + q x²/2
//! r = r₀ + (M₀ x − T₀ x²/2 + P⟨x−a⟩²/2 − C⟨x−b⟩ + q x³/6)/EI
//! w = w₀ + r₀ x + (M₀ x²/2 − T₀ x³/6 + P⟨x−a⟩³/6 − C⟨x−b⟩²/2 + q x⁴/24)/EI + (T₀ x − P⟨x−a⟩ − q x²/2)/GA_s
//! ```
//!
//! and two conditions at each end: w = 0 or T₀ = k w₀, T(L) = −k w(L); r = 0 or M₀ = k r₀, M(L) = −k r(L).

use super::ends::{End, Hold, hold_still};
use nalgebra::{Matrix4, Vector4};

/// A load of a [`Problem`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Load {
    /// A force at a point, m and N, upwards.
    Force(f64, f64),
    /// A couple at a point, m and N·m, counter-clockwise.
    Couple(f64, f64),
    /// A force per length over the whole span, N/m, upwards.
    Uniform(f64),
}

/// A beam, its ends and its loads.
#[derive(Clone, Debug)]
pub(crate) struct Problem {
    /// L, m.
    pub(crate) span: f64,
    /// EI, N·m².
    pub(crate) bending: f64,
    /// GA_s, N; infinite for an Euler–Bernoulli beam.
    pub(crate) shear: f64,
    /// Left and right.
    pub(crate) ends: [End; 2],
    /// What acts on it.
    pub(crate) loads: Vec<Load>,
}

/// What there is at a section: w (m), r (rad), M (N·m), T (N). Where a force or a couple acts, left of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Station {
    pub(crate) deflection: f64,
    pub(crate) rotation: f64,
    pub(crate) moment: f64,
    pub(crate) shear_force: f64,
}

/// What a support does to the beam: a force upwards, N, and a couple counter-clockwise, N·m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Reaction {
    pub(crate) force: f64,
    pub(crate) couple: f64,
}

/// A beam in equilibrium.
#[derive(Clone, Debug)]
pub(crate) struct Bent {
    problem: Problem,
    start: Vector4<f64>,
}

impl Problem {
    /// Its equilibrium; `None` if the ends don't hold it.
    pub(crate) fn solve(self) -> Option<Bent> {
        if !hold_still(self.ends) {
            return None;
        }
        // Unit span and unit EI, so that the matrix is free of units.
        let (l, ei) = (self.span, self.bending);
        let scales = Vector4::new(l, 1.0, ei / l, ei / (l * l));
        let unloaded = Self { loads: Vec::new(), ..self.clone() };
        let (mut matrix, mut right) = (Matrix4::zeros(), Vector4::zeros());
        // The state at an end is A·start + b.
        let far = Matrix4::from_fn(|row, column| {
            let mut start = Vector4::zeros();
            start[column] = scales[column];
            unloaded.state(&start, l, true)[row] / scales[row]
        });
        let loaded = self.state(&Vector4::zeros(), l, true).component_div(&scales);
        for (e, (a, b)) in [(Matrix4::identity(), Vector4::zeros()), (far, loaded)].iter().enumerate() {
            let sign = if e == 0 { 1.0 } else { -1.0 };
            let End { shift, turn } = self.ends[e];
            for (row, hold, place, answer, unit) in
                [(2 * e, shift, 0, 3, l.powi(3) / ei), (2 * e + 1, turn, 1, 2, l / ei)]
            {
                // k·place − sign·answer = 0, divided by 1 + k: held is the limit.
                let (of_place, of_answer) = match hold {
                    Hold::Free => (0.0, 1.0),
                    Hold::Spring(k) => (k * unit / (1.0 + k * unit), 1.0 / (1.0 + k * unit)),
                    Hold::Held => (1.0, 0.0),
                };
                matrix.set_row(row, &(of_place * a.row(place) - sign * of_answer * a.row(answer)));
                right[row] = -(of_place * b[place] - sign * of_answer * b[answer]);
            }
        }
        let start = matrix.lu().solve(&right)?.component_mul(&scales);
        Some(Bent { problem: self, start })
    }

    /// (w, r, M, T) at `x` of a beam that starts with `start`; right of what acts at `x` itself if `behind`.
    fn state(&self, start: &Vector4<f64>, x: f64, behind: bool) -> Vector4<f64> {
        let (ei, flexibility) = (self.bending, 1.0 / self.shear);
        let [w, r, m, t] = [start[0], start[1], start[2], start[3]];
        let mut state = Vector4::new(
            w + r * x + (m * x * x / 2.0 - t * x.powi(3) / 6.0) / ei + t * x * flexibility,
            r + (m * x - t * x * x / 2.0) / ei,
            m - t * x,
            t,
        );
        let passed = |at: f64| x > at || (behind && x == at);
        for load in &self.loads {
            match *load {
                Load::Force(at, p) if passed(at) => {
                    let d = x - at;
                    state += p * Vector4::new(d.powi(3) / (6.0 * ei) - d * flexibility, d * d / (2.0 * ei), d, -1.0);
                }
                Load::Couple(at, c) if passed(at) => {
                    let d = x - at;
                    state -= c * Vector4::new(d * d / (2.0 * ei), d / ei, 1.0, 0.0);
                }
                Load::Uniform(q) => {
                    state += q * Vector4::new(
                        x.powi(4) / (24.0 * ei) - x * x / 2.0 * flexibility,
                        x.powi(3) / (6.0 * ei),
                        x * x / 2.0,
                        -x,
                    );
                }
                Load::Force(..) | Load::Couple(..) => {}
            }
        }
        state
    }
}

impl Bent {
    /// The section at `x`.
    pub(crate) fn at(&self, x: f64) -> Station {
        let [deflection, rotation, moment, shear_force] = self.problem.state(&self.start, x, false).into();
        Station { deflection, rotation, moment, shear_force }
    }

    /// What the two supports do to the beam; for a spring, its force.
    pub(crate) fn reactions(&self) -> [Reaction; 2] {
        let end = self.problem.state(&self.start, self.problem.span, true);
        [Reaction { force: -self.start[3], couple: -self.start[2] }, Reaction { force: end[3], couple: end[2] }]
    }
}

#[cfg(test)]
mod tests {
    use super::super::ends::{CLAMPED, FREE, GUIDED, PINNED, holding_pairs};
    use super::super::tests::agree;
    use super::*;

    fn unit(ends: [End; 2], shear: f64, loads: &[Load]) -> Bent {
        Problem { span: 1.0, bending: 1.0, shear, ends, loads: loads.to_vec() }.solve().unwrap()
    }

    const RIGID: f64 = f64::INFINITY;

    /// Roark, *Formulas for Stress and Strain*, table 8.1 (7th edition), cases 1 and 2: deflections and end couples.
    #[test]
    fn handbook_values() {
        let force = |ends, at, x: f64| unit(ends, RIGID, &[Load::Force(at, 1.0)]).at(x).deflection;
        agree(force([PINNED, PINNED], 0.5, 0.5), 1.0 / 48.0, 1e-14);
        agree(force([CLAMPED, CLAMPED], 0.5, 0.5), 1.0 / 192.0, 1e-14);
        agree(force([CLAMPED, FREE], 1.0, 1.0), 1.0 / 3.0, 1e-14);
        agree(force([FREE, CLAMPED], 0.0, 0.0), 1.0 / 3.0, 1e-14);
        agree(force([CLAMPED, PINNED], 0.5, 0.5), 7.0 / 768.0, 1e-14);
        // A guided end is the middle of a symmetric beam of twice the span.
        agree(force([PINNED, GUIDED], 1.0, 1.0), 2.0 * 8.0 / 48.0, 1e-14);
        agree(force([GUIDED, CLAMPED], 0.0, 0.0), 2.0 * 8.0 / 192.0, 1e-14);
        let load = |ends, x: f64| unit(ends, RIGID, &[Load::Uniform(1.0)]).at(x).deflection;
        agree(load([PINNED, PINNED], 0.5), 5.0 / 384.0, 1e-14);
        agree(load([CLAMPED, CLAMPED], 0.5), 1.0 / 384.0, 1e-14);
        agree(load([CLAMPED, FREE], 1.0), 1.0 / 8.0, 1e-14);
        agree(load([CLAMPED, PINNED], 0.5), 1.0 / 192.0, 1e-14);
        agree(load([GUIDED, PINNED], 0.0), 16.0 * 5.0 / 384.0, 1e-14);
        agree(load([CLAMPED, GUIDED], 1.0), 16.0 / 384.0, 1e-14);
        // A couple at the right end turns it by 1/3 (pinned–pinned), 1/4 (clamped–pinned), 1 (clamped–free).
        for (ends, turn) in [([PINNED, PINNED], 3.0), ([CLAMPED, PINNED], 4.0), ([CLAMPED, FREE], 1.0)] {
            agree(unit(ends, RIGID, &[Load::Couple(1.0, 1.0)]).at(1.0).rotation, 1.0 / turn, 1e-14);
        }
    }

    #[test]
    fn handbook_reactions() {
        let [left, right] = unit([CLAMPED, PINNED], RIGID, &[Load::Uniform(-1.0)]).reactions();
        agree(left.force, 5.0 / 8.0, 1e-14);
        agree(left.couple, 1.0 / 8.0, 1e-14);
        agree(right.force, 3.0 / 8.0, 1e-14);
        agree(right.couple, 0.0, 1e-15);
        // P a b²/L², P a² b/L² and P b² (3a + b)/L³ of a clamped beam.
        let [left, right] = unit([CLAMPED, CLAMPED], RIGID, &[Load::Force(0.3, -1.0)]).reactions();
        agree(left.couple, 0.3 * 0.49, 1e-14);
        agree(right.couple, -0.09 * 0.7, 1e-14);
        agree(left.force, 0.49 * 1.6, 1e-14);
        // 6 C a b/L³ of a couple on it, and C b (2a − b)/L², which is C/4 at both ends for one at midspan.
        let [left, right] = unit([CLAMPED, CLAMPED], RIGID, &[Load::Couple(0.5, 1.0)]).reactions();
        agree(left.force, 1.5, 1e-14);
        agree(right.force, -1.5, 1e-14);
        agree(left.couple, 0.25, 1e-14);
        agree(right.couple, 0.25, 1e-14);
    }

    /// Timoshenko: force at midspan adds P L/(4 GA_s), uniform load q L²/(8 GA_s), a cantilever's tip P L/GA_s; statically determinate
    /// or symmetric, the moments stay.
    #[test]
    fn shear_adds_to_the_deflection() {
        let (g, p) = (7.0, [Load::Force(0.5, 1.0)]);
        agree(unit([PINNED, PINNED], g, &p).at(0.5).deflection, 1.0 / 48.0 + 0.25 / g, 1e-14);
        agree(unit([CLAMPED, CLAMPED], g, &p).at(0.5).deflection, 1.0 / 192.0 + 0.25 / g, 1e-14);
        agree(unit([CLAMPED, FREE], g, &[Load::Force(1.0, 1.0)]).at(1.0).deflection, 1.0 / 3.0 + 1.0 / g, 1e-14);
        let q = [Load::Uniform(1.0)];
        agree(unit([PINNED, PINNED], g, &q).at(0.5).deflection, 5.0 / 384.0 + 0.125 / g, 1e-14);
        agree(unit([CLAMPED, FREE], g, &q).at(1.0).deflection, 1.0 / 8.0 + 0.5 / g, 1e-14);
        // A propped cantilever: the prop carries (1/8 + 1/(2g))/(1/3 + 1/g).
        let prop = unit([CLAMPED, PINNED], g, &[Load::Uniform(-1.0)]).reactions()[1];
        agree(prop.force, (1.0 / 8.0 + 0.5 / g) / (1.0 / 3.0 + 1.0 / g), 1e-14);
    }

    /// A cantilever on a spring at its tip shares the load: k/(k + 3 EI/L³); on a spring at its root it turns by the root's couple.
    #[test]
    fn springs_share_the_load() {
        let tip = End { shift: Hold::Spring(6.0), turn: Hold::Free };
        let bent = unit([CLAMPED, tip], RIGID, &[Load::Force(1.0, -1.0)]);
        agree(bent.at(1.0).deflection, -1.0 / 9.0, 1e-14);
        agree(bent.reactions()[1].force, 6.0 / 9.0, 1e-14);
        let root = End { shift: Hold::Held, turn: Hold::Spring(5.0) };
        let bent = unit([root, FREE], RIGID, &[Load::Force(1.0, 1.0)]);
        agree(bent.at(1.0).deflection, 1.0 / 3.0 + 1.0 / 5.0, 1e-14);
        agree(bent.at(0.0).rotation, 1.0 / 5.0, 1e-14);
        let bent = unit([FREE, root], RIGID, &[Load::Force(0.0, 1.0)]);
        agree(bent.at(0.0).deflection, 1.0 / 3.0 + 1.0 / 5.0, 1e-14);
        // A rigid-like beam on two springs: force at 0.25 presses 3/4 and 1/4.
        let soft = End { shift: Hold::Spring(1e-6), turn: Hold::Free };
        let bent = unit([soft, soft], RIGID, &[Load::Force(0.25, -1.0)]);
        agree(bent.reactions()[0].force, 0.75, 1e-9);
        agree(bent.at(1.0).deflection, -0.25e6, 1e-9);
    }

    /// Maxwell and Betti between a force, a couple and a load, equilibrium of the whole, units: for all pairs, with shear and springs.
    #[test]
    fn all_pairs_are_reciprocal_and_in_equilibrium() {
        let spring = End { shift: Hold::Spring(40.0), turn: Hold::Spring(3.0) };
        let mut pairs: Vec<_> = holding_pairs().into_iter().map(|(_, ends)| ends).collect();
        pairs.extend([[spring, FREE], [GUIDED, spring], [spring, spring]]);
        for ends in pairs {
            for shear in [RIGID, 33.0] {
                let (span, bending) = (1.7, 2.3);
                let solve = |load| Problem { span, bending, shear, ends, loads: vec![load] }.solve().unwrap();
                let (a, b) = (0.4, 1.1);
                let (force, couple) = (solve(Load::Force(a, 1.0)), solve(Load::Couple(b, 1.0)));
                agree(force.at(b).rotation, couple.at(a).deflection, 1e-12);
                agree(solve(Load::Force(b, 1.0)).at(a).deflection, force.at(b).deflection, 1e-13);
                let loads = vec![Load::Force(a, -2.0), Load::Couple(b, 0.7), Load::Uniform(1.3)];
                let [left, right] = Problem { span, bending, shear, ends, loads }.solve().unwrap().reactions();
                agree(left.force + right.force, 2.0 - 1.3 * span, 1e-13);
                let turned = left.couple + right.couple + right.force * span;
                agree(turned, 2.0 * a - 0.7 - 1.3 * span * span / 2.0, 1e-13);
            }
        }
    }

    #[test]
    fn a_beam_that_nothing_holds_has_no_equilibrium() {
        let loads = vec![Load::Uniform(1.0)];
        for ends in [[FREE, FREE], [GUIDED, GUIDED], [PINNED, FREE], [GUIDED, FREE]] {
            assert!(Problem { span: 1.0, bending: 1.0, shear: RIGID, ends, loads: loads.clone() }.solve().is_none());
        }
    }
}
