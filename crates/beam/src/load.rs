//! Consistent nodal loads, and loads that vary in time.

use std::fmt;

use crate::beam::Beam;
use crate::element::GAUSS;
use crate::error::{BeamError, check, check_len};
use crate::shape::ShapeAt;

impl Beam {
    /// f += N(x)ᵀ force: a force (N, upwards) at x.
    ///
    /// # Errors
    /// [`BeamError::OutsideSpan`], [`BeamError::Value`] for a force that is not finite,
    /// [`BeamError::Length`].
    ///
    /// ```
    /// # use teeter_beam::{Beam, BeamSpec, Section, Support};
    /// # let beam = Beam::new(BeamSpec::new(1.0, 2, Section::new(1.0, 1.0)?))?;
    /// let mut f = vec![0.0; beam.dofs()];
    /// beam.add_point_load(0.5, -2.0, &mut f)?;
    /// assert_eq!(f, [0.0, 0.0, -2.0, 0.0, 0.0, 0.0]);
    /// assert!(beam.add_point_load(1.5, -2.0, &mut f).is_err());
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn add_point_load(&self, x: f64, force: f64, f: &mut [f64]) -> Result<(), BeamError> {
        check("force", force, true, "finite")?;
        self.shape_for_load(x, f)?.add_load(force, 0.0, f);
        Ok(())
    }

    /// f += N'(x)ᵀ couple: a couple (N m, counter-clockwise) at x.
    ///
    /// # Errors
    /// As [`Beam::add_point_load`].
    ///
    /// ```
    /// # use teeter_beam::{Beam, BeamSpec, Section, Support};
    /// # let beam = Beam::new(BeamSpec::new(1.0, 2, Section::new(1.0, 1.0)?))?;
    /// let mut f = vec![0.0; beam.dofs()];
    /// beam.add_point_couple(0.5, 3.0, &mut f)?;
    /// assert_eq!(f, [0.0, 0.0, 0.0, 3.0, 0.0, 0.0]);
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn add_point_couple(&self, x: f64, couple: f64, f: &mut [f64]) -> Result<(), BeamError> {
        check("couple", couple, true, "finite")?;
        self.shape_for_load(x, f)?;
        // It turns the section, which with shear is another thing than the axis.
        let (element, xi) = self.mesh.locate(x);
        for (f, turn) in f[2 * element..].iter_mut().zip(self.elements[element].rotation(xi)) {
            *f += couple * turn;
        }
        Ok(())
    }

    fn shape_for_load(&self, x: f64, f: &[f64]) -> Result<ShapeAt, BeamError> {
        check_len("f", self.dofs(), f.len())?;
        self.loaded_shape(x).ok_or(BeamError::OutsideSpan { x, span: self.spec.span })
    }

    /// The shape functions at x that a load there goes by; `None` off the beam.
    fn loaded_shape(&self, x: f64) -> Option<ShapeAt> {
        (x >= 0.0 && x <= self.spec.span).then(|| {
            let (element, xi) = self.mesh.locate(x);
            self.whole_shape(element, xi)
        })
    }

    /// f += ∫ Nᵀ p dx for a distributed load p(x), N/m, upwards: four Gauss points an element,
    /// exact where p is a polynomial of degree 4 on each element.
    ///
    /// # Errors
    /// [`BeamError::Length`]; [`BeamError::Value`] for a load that is not finite (f then holds part
    /// of the load).
    ///
    /// ```
    /// # use teeter_beam::{Beam, BeamSpec, Section, Support};
    /// # let beam = Beam::new(BeamSpec::new(1.0, 2, Section::new(1.0, 1.0)?).supported([Support::Free; 2]))?;
    /// let mut f = vec![0.0; beam.dofs()];
    /// beam.add_distributed_load(&|x| 2.0 * x, &mut f)?;
    /// let total: f64 = f.iter().step_by(2).sum();
    /// assert!((total - 1.0).abs() < 1e-15);
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn add_distributed_load(&self, load: &dyn Fn(f64) -> f64, f: &mut [f64]) -> Result<(), BeamError> {
        check_len("f", self.dofs(), f.len())?;
        for (element, e) in self.elements.iter().enumerate() {
            let half = 0.5 * e.length;
            let middle = self.mesh.x[element] + half;
            for (s, weight) in GAUSS {
                let p = load(middle + s * half);
                check("load", p, true, "finite")?;
                self.whole_shape(element, 0.5 * (1.0 + s)).add_load(p * weight * half, 0.0, f);
            }
        }
        Ok(())
    }

    /// f += ∫ Nᵀ dx · p for a load p, N/m, upwards, the same all along; in closed form.
    ///
    /// # Errors
    /// [`BeamError::Length`]; [`BeamError::Value`] for a load that is not finite.
    ///
    /// ```
    /// # use teeter_beam::{Beam, BeamSpec, Section, Support};
    /// # let beam = Beam::new(BeamSpec::new(1.0, 2, Section::new(1.0, 1.0)?).supported([Support::Free; 2]))?;
    /// let mut f = vec![0.0; beam.dofs()];
    /// beam.add_uniform_load(4.0, &mut f)?;
    /// assert_eq!(f[..4], [1.0, 4.0 * 0.25 / 12.0, 2.0, 0.0]);
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn add_uniform_load(&self, load: f64, f: &mut [f64]) -> Result<(), BeamError> {
        check_len("f", self.dofs(), f.len())?;
        check("load", load, true, "finite")?;
        self.add_uniform(load, f);
        Ok(())
    }

    /// f += ∫ Nᵀ dx · p for a load p, N/m, upwards, the same from one place to another (m); exact.
    ///
    /// # Errors
    /// [`BeamError::Length`]; [`BeamError::OutsideSpan`]; [`BeamError::Value`] for a load that is
    /// not finite, or a part that ends where or before it begins.
    pub fn add_partial_load(&self, part: [f64; 2], load: f64, f: &mut [f64]) -> Result<(), BeamError> {
        check_len("f", self.dofs(), f.len())?;
        check("load", load, true, "finite")?;
        for x in part {
            self.shape_at(x).ok_or(BeamError::OutsideSpan { x, span: self.spec.span })?;
        }
        check("part", part[1], part[1] > part[0], "right of where it begins")?;
        let (bend, _) = self.split_mut(f);
        for (element, e) in self.elements.iter().enumerate() {
            let inside = part.map(|x| ((x - self.mesh.x[element]) / e.length).clamp(0.0, 1.0));
            if inside[1] > inside[0] {
                for (i, share) in e.partial_load(inside).into_iter().enumerate() {
                    bend[element + i / 2][i % 2] += load * share;
                }
            }
        }
        Ok(())
    }

    fn add_uniform(&self, load: f64, f: &mut [f64]) {
        let (bend, _) = self.split_mut(f);
        for (element, e) in self.elements.iter().enumerate() {
            for (i, share) in e.uniform_load().into_iter().enumerate() {
                bend[element + i / 2][i % 2] += load * share;
            }
        }
    }

    /// f += g M 1: the beam's own weight and that of the masses that it carries, by the
    /// acceleration of gravity in the direction of w (m/s², upwards positive), section by section.
    ///
    /// # Errors
    /// [`BeamError::Length`]; [`BeamError::Value`] for an acceleration that is not finite.
    pub fn add_self_weight(&self, gravity: f64, f: &mut [f64]) -> Result<(), BeamError> {
        check_len("f", self.dofs(), f.len())?;
        check("gravity", gravity, true, "finite")?;
        let (bend, _) = self.split_mut(f);
        for (element, e) in self.elements.iter().enumerate() {
            let load = gravity * e.section.mass_per_length;
            for (i, share) in e.uniform_load().into_iter().enumerate() {
                bend[element + i / 2][i % 2] += load * share;
            }
        }
        for (dof, mass) in self.lumps.iter().step_by(2) {
            bend[dof / 2][0] += gravity * mass;
        }
        Ok(())
    }
}

impl Beam {
    /// What the way of a point is in time that moves at x = `start` + `speed` t (m, m/s): the
    /// stretches of the time from `times[0]` to `times[1]` in each of which it stays within one
    /// element, in their order; none while it is off the beam. Deflections at the point are smooth
    /// in each. Allocates nothing.
    pub fn passages(&self, start: f64, speed: f64, times: [f64; 2]) -> impl Iterator<Item = [f64; 2]> {
        let nodes = &self.mesh.x;
        let (at, span) = (move |t: f64| start + speed * t, self.spec.span);
        let (first, last) = (at(times[0]), at(times[1]));
        // The nodes strictly between its first and last place, by number; and whether it is on the
        // beam before the first of them.
        let (low, high) = (first.min(last), first.max(last));
        let between = nodes.partition_point(|x| *x <= low)..nodes.partition_point(|x| *x < high);
        let n = between.len();
        // Of stretches: one more than nodes passed.
        (0..=n).filter_map(move |k| {
            let node = |k: usize| if speed < 0.0 { between.end - 1 - k } else { between.start + k };
            let passed = |k: usize| ((nodes[node(k)] - start) / speed).clamp(times[0], times[1]);
            let from = if k == 0 { times[0] } else { passed(k - 1) };
            let to = if k == n { times[1] } else { passed(k) };
            let middle = at(0.5 * (from + to));
            (from < to && (0.0..=span).contains(&middle)).then_some([from, to])
        })
    }
}

/// A load P(t) on a beam.
pub trait Load: Send + Sync {
    /// f += P(t), one entry per dof of `beam`.
    ///
    /// # Panics
    /// The implementations of this crate do if `f` has not [`Beam::dofs`] entries.
    fn add(&self, beam: &Beam, t: f64, f: &mut [f64]);

    /// f += the mean of P over the time from `times[0]` to `times[1]` (s), which is later: what a
    /// step takes. `scratch` is as long as `f`, and what is in it means nothing.
    ///
    /// The default takes four Gauss points, exact for a polynomial of degree 7; what is shorter
    /// than the stretch, jumps or has kinks in it needs a mean of its own.
    ///
    /// # Panics
    /// As [`Load::add`].
    fn add_mean(&self, beam: &Beam, times: [f64; 2], scratch: &mut [f64], f: &mut [f64]) {
        for (t, share) in gauss(times) {
            scratch.fill(0.0);
            self.add(beam, t, scratch);
            f.iter_mut().zip(scratch.iter()).for_each(|(f, p)| *f += share * p);
        }
    }

    /// The first time after `t` (s) at which P isn't smooth, s; infinity, the default, for none. A
    /// time scheme of high order ends a step there.
    fn next_break(&self, beam: &Beam, t: f64) -> f64 {
        let _ = (beam, t);
        f64::INFINITY
    }
}

/// Gauss' four points of a stretch of time, and their shares of its mean.
fn gauss([from, to]: [f64; 2]) -> impl Iterator<Item = (f64, f64)> {
    GAUSS.into_iter().map(move |(s, weight)| (0.5 * (from + to) + 0.5 * (to - from) * s, 0.5 * weight))
}

/// The mean of a history by Gauss' points.
fn mean(history: &History, times: [f64; 2]) -> f64 {
    gauss(times).map(|(t, share)| share * history(t)).sum()
}

/// A value that depends on time.
type History = Box<dyn Fn(f64) -> f64 + Send + Sync>;

/// A force at a fixed point, its consistent nodal load.
pub struct NodalLoad {
    x: f64,
    history: History,
}

impl NodalLoad {
    /// A force `history(t)` (N, upwards) at x, which must be on `beam`. The history must return
    /// finite values.
    ///
    /// # Errors
    /// [`BeamError::OutsideSpan`].
    ///
    /// ```
    /// # use teeter_beam::{Beam, BeamSpec, Load, NodalLoad, Section, Support};
    /// # let beam = Beam::new(BeamSpec::new(1.0, 2, Section::new(1.0, 1.0)?))?;
    /// let load = NodalLoad::new(&beam, 0.5, |t| -10.0 * t)?;
    /// let mut f = vec![0.0; beam.dofs()];
    /// load.add(&beam, 0.2, &mut f);
    /// assert_eq!(f, [0.0, 0.0, -2.0, 0.0, 0.0, 0.0]);
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn new(beam: &Beam, x: f64, history: impl Fn(f64) -> f64 + Send + Sync + 'static) -> Result<Self, BeamError> {
        beam.shape_at(x).ok_or(BeamError::OutsideSpan { x, span: beam.spec.span })?;
        Ok(Self { x, history: Box::new(history) })
    }
}

impl fmt::Debug for NodalLoad {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("NodalLoad").field("x", &self.x).finish_non_exhaustive()
    }
}

impl Load for NodalLoad {
    fn add(&self, beam: &Beam, t: f64, f: &mut [f64]) {
        if let Some(shape) = beam.loaded_shape(self.x) {
            shape.add_load((self.history)(t), 0.0, f);
        }
    }

    fn add_mean(&self, beam: &Beam, times: [f64; 2], _: &mut [f64], f: &mut [f64]) {
        if let Some(shape) = beam.loaded_shape(self.x) {
            shape.add_load(mean(&self.history, times), 0.0, f);
        }
    }
}

/// A distributed load, the same all along the beam.
pub struct DistributedLoad {
    history: History,
}

impl DistributedLoad {
    /// A load `history(t)`, N/m, upwards. The history must return finite values.
    ///
    /// ```
    /// # use teeter_beam::{Beam, BeamSpec, DistributedLoad, Load, Section, Support};
    /// # let beam = Beam::new(BeamSpec::new(1.0, 2, Section::new(1.0, 1.0)?).supported([Support::Free; 2]))?;
    /// let weight = DistributedLoad::new(|_| -9.81);
    /// let mut f = vec![0.0; beam.dofs()];
    /// weight.add(&beam, 0.0, &mut f);
    /// assert!((f[0] + f[2] + f[4] + 9.81).abs() < 1e-14);
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn new(history: impl Fn(f64) -> f64 + Send + Sync + 'static) -> Self {
        Self { history: Box::new(history) }
    }
}

impl fmt::Debug for DistributedLoad {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("DistributedLoad").finish_non_exhaustive()
    }
}

impl Load for DistributedLoad {
    fn add(&self, beam: &Beam, t: f64, f: &mut [f64]) {
        beam.add_uniform((self.history)(t), f);
    }

    fn add_mean(&self, beam: &Beam, times: [f64; 2], _: &mut [f64], f: &mut [f64]) {
        beam.add_uniform(mean(&self.history, times), f);
    }
}

/// A constant force that crosses the beam at constant speed; no load while it is off the beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MovingLoad {
    force: f64,
    speed: f64,
    start: f64,
}

impl MovingLoad {
    /// `force` (N, upwards) at x = `start` + `speed` t (m, m/s).
    ///
    /// # Errors
    /// [`BeamError::Value`] for a number that is not finite.
    ///
    /// ```
    /// # use teeter_beam::{Beam, BeamSpec, Load, MovingLoad, Section, Support};
    /// # let beam = Beam::new(BeamSpec::new(1.0, 2, Section::new(1.0, 1.0)?))?;
    /// let load = MovingLoad::new(-10.0, 2.0, 0.0)?;
    /// let mut f = vec![0.0; beam.dofs()];
    /// load.add(&beam, 0.25, &mut f); // at x = 0.5
    /// load.add(&beam, 0.75, &mut f); // gone
    /// assert_eq!(f, [0.0, 0.0, -10.0, 0.0, 0.0, 0.0]);
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn new(force: f64, speed: f64, start: f64) -> Result<Self, BeamError> {
        check("force", force, true, "finite")?;
        check("speed", speed, true, "finite")?;
        check("start", start, true, "finite")?;
        Ok(Self { force, speed, start })
    }

    /// Where it is at time t, m.
    pub fn position(&self, t: f64) -> f64 {
        self.start + self.speed * t
    }
}

impl Load for MovingLoad {
    fn add(&self, beam: &Beam, t: f64, f: &mut [f64]) {
        if let Some(shape) = beam.loaded_shape(self.position(t)) {
            shape.add_load(self.force, 0.0, f);
        }
    }

    fn add_mean(&self, beam: &Beam, times: [f64; 2], _: &mut [f64], f: &mut [f64]) {
        let all = times[1] - times[0];
        for within in beam.passages(self.start, self.speed, times) {
            let part = (within[1] - within[0]) / all;
            // Within an element N is cubic in time: two points do.
            let (middle, away) = (0.5 * (within[0] + within[1]), 0.5 * (within[1] - within[0]) / 3.0_f64.sqrt());
            for t in [middle - away, middle + away] {
                let (element, xi) = beam.mesh.locate(self.position(t).clamp(0.0, beam.spec.span));
                beam.whole_shape(element, xi).add_load(0.5 * self.force * part, 0.0, f);
            }
        }
    }

    fn next_break(&self, beam: &Beam, t: f64) -> f64 {
        if self.speed == 0.0 {
            return f64::INFINITY;
        }
        let passes = beam.node_positions().iter().map(|x| (x - self.start) / self.speed);
        passes.filter(|passes| *passes > t).fold(f64::INFINITY, f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::beam::tests::{all_supports, beam};

    #[test]
    fn quadrature_is_the_closed_form_for_a_uniform_load_and_exact_to_degree_four() {
        for supports in all_supports() {
            let beam = beam(5, supports);
            let (mut a, mut b) = (vec![0.0; beam.dofs()], vec![0.0; beam.dofs()]);
            beam.add_uniform_load(3.0, &mut a).unwrap();
            beam.add_distributed_load(&|_| 3.0, &mut b).unwrap();
            assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-15), "{supports:?}");
        }
        // Work of x⁴ on the rigid motions of a free beam: 1/5 and 1/6.
        let beam = beam(3, [crate::Support::Free; 2]);
        let mut f = vec![0.0; beam.dofs()];
        beam.add_distributed_load(&|x| x.powi(4), &mut f).unwrap();
        let work = |q: Vec<f64>| f.iter().zip(&q).map(|(f, q)| f * q).sum::<f64>();
        let turned: Vec<[f64; 2]> = (0..4).map(|i| [f64::from(i) / 3.0, 1.0]).collect();
        assert!((work(beam.from_nodes(&[[1.0, 0.0]; 4]).unwrap()) - 0.2).abs() < 1e-15);
        assert!((work(beam.from_nodes(&turned).unwrap()) - 1.0 / 6.0).abs() < 1e-15);
    }

    #[test]
    fn a_couple_is_the_limit_of_two_forces() {
        let beam = beam(4, [crate::Support::Free; 2]);
        let (mut couple, mut pair) = (vec![0.0; beam.dofs()], vec![0.0; beam.dofs()]);
        let arm = 1e-4;
        beam.add_point_couple(0.3, 2.0, &mut couple).unwrap();
        beam.add_point_load(0.3 + 0.5 * arm, 2.0 / arm, &mut pair).unwrap();
        beam.add_point_load(0.3 - 0.5 * arm, -2.0 / arm, &mut pair).unwrap();
        assert!(couple.iter().zip(&pair).all(|(a, b)| (a - b).abs() < 1e-5));
    }

    #[test]
    fn bad_loads_are_named() {
        let beam = beam(4, [crate::Support::Pinned; 2]);
        let mut f = vec![0.0; beam.dofs()];
        let named = |error: Result<(), BeamError>, words: &[&str]| {
            let text = error.unwrap_err().to_string();
            assert!(words.iter().all(|word| text.contains(word)), "{text}");
        };
        named(beam.add_point_load(0.5, f64::NAN, &mut f), &["force", "NaN", "finite"]);
        named(beam.add_point_load(1.5, 1.0, &mut f), &["x = 1.5", "[0, 1]"]);
        named(beam.add_point_couple(-0.5, 1.0, &mut f), &["x = -0.5", "[0, 1]"]);
        named(beam.add_point_load(0.5, 1.0, &mut [0.0]), &["f:", "1 entries", "10"]);
        named(beam.add_uniform_load(f64::INFINITY, &mut f), &["load", "inf"]);
        named(beam.add_distributed_load(&|_| f64::NAN, &mut f), &["load", "NaN"]);
        named(NodalLoad::new(&beam, 2.0, |_| 0.0).map(drop), &["x = 2"]);
        named(MovingLoad::new(1.0, f64::NAN, 0.0).map(drop), &["speed", "NaN"]);
        assert!(f.iter().all(|f| *f == 0.0));
    }
}
