//! An elastic bar that flies against a rigid wall (St-Venant 1867; Goldsmith, *Impact*, 1960): d'Alembert's solution.
//!
//! The wave that stops the bar runs from the wall to the free end and comes back as one that sets it going the other way. A point at the distance
//! s from the front end moves with v until the first wave arrives, t₁ = t_c + s/c, stands until the second, t₂ = t_c + (2L − s)/c, then moves with −v:
//!
//! ```text
//! u = v min(t, t₁) − v max(t − t₂, 0),      c = √(E/ρ),  t_c = gap/v
//! ```
//!
//! The wall pushes with EA v/c from t_c to t_c + 2L/c, when the whole bar is free of stress and leaves with −v.

/// The bar, towards the wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bar {
    /// E, Pa.
    pub(crate) young: f64,
    /// ρ, kg/m³.
    pub(crate) density: f64,
    /// A, m².
    pub(crate) area: f64,
    /// L, m.
    pub(crate) length: f64,
    /// v, m/s, towards the wall.
    pub(crate) speed: f64,
    /// Between the front end and the wall at t = 0, m.
    pub(crate) gap: f64,
}

impl Bar {
    /// c, m/s.
    pub(crate) fn wave_speed(&self) -> f64 {
        (self.young / self.density).sqrt()
    }

    /// Of the wall on the bar while they touch, N.
    pub(crate) fn force(&self) -> f64 {
        self.area * self.density * self.wave_speed() * self.speed
    }

    /// When contact begins and ends, s.
    pub(crate) fn contact(&self) -> [f64; 2] {
        let begin = self.gap / self.speed;
        [begin, begin + self.duration()]
    }

    /// 2L/c, s.
    pub(crate) fn duration(&self) -> f64 {
        2.0 * self.length / self.wave_speed()
    }

    /// u towards the wall since t = 0, m, of the point at `s` behind the front end.
    pub(crate) fn displacement(&self, s: f64, t: f64) -> f64 {
        let [stopped, sent_back] = self.waves(s);
        self.speed * (t.min(stopped) - (t - sent_back).max(0.0))
    }

    /// Of the same point, m/s; at a wave's arrival that behind it.
    pub(crate) fn velocity(&self, s: f64, t: f64) -> f64 {
        let [stopped, sent_back] = self.waves(s);
        if t < stopped {
            self.speed
        } else if t < sent_back {
            0.0
        } else {
            -self.speed
        }
    }

    /// Normal force at the same point, N, compression negative.
    #[cfg_attr(not(test), expect(dead_code, reason = "no case compares with it yet"))]
    pub(crate) fn normal_force(&self, s: f64, t: f64) -> f64 {
        if self.velocity(s, t) == 0.0 { -self.force() } else { 0.0 }
    }

    /// When the two waves arrive at `s`.
    fn waves(&self, s: f64) -> [f64; 2] {
        let begin = self.gap / self.speed;
        [begin + s / self.wave_speed(), begin + (2.0 * self.length - s) / self.wave_speed()]
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::agree;
    use super::*;

    /// The bar of the literature on schemes for impact (Doyen, Ern and Piperno 2011, doi 10.1137/100791440, have one like it).
    const BAR: Bar = Bar { young: 210e9, density: 7800.0, area: 3.14e-4, length: 1.0, speed: 0.1, gap: 5e-5 };

    #[test]
    fn the_numbers_of_the_example() {
        agree(BAR.force(), 1_270.827_478_456_458_3, 1e-14);
        agree(BAR.duration(), 3.854_496_446_637_726e-4, 1e-14);
        let [begin, end] = BAR.contact();
        agree(begin, 5e-4, 1e-15);
        agree(end, 8.854_496_446_637_726e-4, 1e-14);
    }

    #[test]
    fn the_front_end_waits_at_the_wall() {
        let [begin, end] = BAR.contact();
        for t in [begin, 0.5 * (begin + end), end] {
            agree(BAR.displacement(0.0, t), BAR.gap, 1e-14);
        }
        agree(BAR.displacement(0.0, end + 1e-4), BAR.gap - 1e-5, 1e-12);
    }

    /// At every time: ½ρA∫v² + ½EA∫u′² is that of the flight, and the impulse of the wall what the momentum has lost.
    #[test]
    fn energy_and_momentum() {
        let n = 4000;
        let h = BAR.length / f64::from(n);
        for t in [4e-4, 5.7e-4, 6.9e-4, 7.3e-4, 8.5e-4, 9.9e-4] {
            let (mut energy, mut momentum) = (0.0, 0.0);
            for i in 0..n {
                let s = (f64::from(i) + 0.5) * h;
                let (v, f) = (BAR.velocity(s, t), BAR.normal_force(s, t));
                energy += 0.5 * h * (BAR.density * BAR.area * v * v + f * f / (BAR.young * BAR.area));
                momentum += h * BAR.density * BAR.area * v;
            }
            let mass = BAR.density * BAR.area;
            agree(energy, 0.5 * mass * 0.01, 1e-10);
            let [begin, end] = BAR.contact();
            let impulse = BAR.force() * (t.clamp(begin, end) - begin);
            assert!((momentum - (0.1 * mass - impulse)).abs() < 1e-3 * 0.1 * mass, "{momentum} {impulse}");
        }
    }

    /// The stress is EA ∂u/∂x, x against s.
    #[test]
    fn the_force_is_that_of_the_strain() {
        let (t, d) = (5.9e-4, 1e-4);
        for s in [0.1, 0.3, 0.8] {
            let strain = -(BAR.displacement(s + d, t) - BAR.displacement(s - d, t)) / (2.0 * d);
            assert!((BAR.young * BAR.area * -strain.abs() - BAR.normal_force(s, t)).abs() < 1e-6, "{s}");
        }
    }
}
