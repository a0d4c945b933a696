//! A point mass that falls on a floor and comes back with e times its speed, each time (`docs/theory.md` §9).

/// The point, let go at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BouncingPoint {
    /// Height of the release above the floor, m.
    pub(crate) height: f64,
    /// m/s².
    pub(crate) gravity: f64,
    /// e in [0, 1).
    pub(crate) restitution: f64,
}

impl BouncingPoint {
    /// Speed of the first impact, v₀ = √(2 g h), m/s.
    fn speed(&self) -> f64 {
        (2.0 * self.gravity * self.height).sqrt()
    }

    /// Time of impact `n`, from 1, s: the first at t₁ = v₀/g, flight j between takes 2 eʲ v₀/g, so
    /// t_n = t₁ (1 + 2 (e − eⁿ)/(1 − e)).
    pub(crate) fn impact(&self, n: i32) -> f64 {
        let e = self.restitution;
        self.speed() / self.gravity * (1.0 + 2.0 * (e - e.powi(n)) / (1.0 - e))
    }

    /// Zeno time, s: t₁ (1 + e)/(1 − e), after which it lies.
    pub(crate) fn rest(&self) -> f64 {
        let e = self.restitution;
        self.speed() / self.gravity * (1.0 + e) / (1.0 - e)
    }

    #[cfg_attr(not(test), expect(dead_code, reason = "the case looks at times"))]
    /// Height of the apex after impact `n`, m; the release for 0. The energy after n impacts is m g times this.
    pub(crate) fn apex(&self, n: i32) -> f64 {
        self.height * self.restitution.powi(2 * n)
    }

    #[cfg_attr(not(test), expect(dead_code, reason = "the case looks at times"))]
    /// Height and velocity at time `t` ≥ 0; at an impact, after it.
    pub(crate) fn at(&self, t: f64) -> [f64; 2] {
        if t >= self.rest() {
            return [0.0, 0.0];
        }
        let (mut start, mut n) = (-self.speed() / self.gravity, 0);
        // Flight n ends with impact n + 1; the release is half way up flight 0.
        while self.impact(n + 1) <= t {
            n += 1;
            start = self.impact(n);
        }
        let (up, since) = (self.speed() * self.restitution.powi(n), t - start);
        [since * (up - 0.5 * self.gravity * since), up - self.gravity * since]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BALL: BouncingPoint = BouncingPoint { height: 0.2, gravity: 10.0, restitution: 0.5 };

    #[test]
    fn a_ball_with_round_numbers() {
        // v₀ = 2 m/s: flights of 0.2 (the fall), 0.2, 0.1, 0.05, … s.
        for (n, t) in [(1, 0.2), (2, 0.4), (3, 0.5), (4, 0.55)] {
            assert!((BALL.impact(n) - t).abs() < 1e-15, "{n}");
        }
        assert!((BALL.rest() - 0.6).abs() < 1e-15 && (BALL.impact(60) - 0.6).abs() < 1e-15);
        assert_eq!([BALL.apex(0), BALL.apex(1), BALL.apex(2)], [0.2, 0.05, 0.0125]);
    }

    #[test]
    fn the_path_goes_through_apexes_and_impacts() {
        let close = |t: f64, y: f64, v: f64| {
            let [found_y, found_v] = BALL.at(t);
            assert!((found_y - y).abs() < 1e-15 && (found_v - v).abs() < 1e-14, "{found_y} {found_v} at {t}");
        };
        close(0.0, 0.2, 0.0);
        close(BALL.impact(1), 0.0, 1.0);
        close(0.3, BALL.apex(1), 0.0);
        close(0.45, BALL.apex(2), 0.0);
        close(0.7, 0.0, 0.0);
    }
}
