//! A block on a floor that moves by x_g = A sin ωt: slides at ±μg, sticks where the floor accelerates by no more; piecewise in closed form.
//!
//! While it slides, v = v_s + σμg (t − t_s) with σ the sign of the floor's velocity relative to it, w = ẋ_g − v. Between two
//! times where ẇ = −Aω² sin ωt − σμg is zero w is monotone, so that each interval holds at most one time where it reaches
//! zero. There the block sticks if Aω²|sin ωt| ≤ μg, until that no longer holds; else it slides on, the other way.
//!
//! In the steady state it never sticks if η = μg/(Aω²) < 2/√(4 + π²) (Westermo and Udwadia 1983, Earthq. Eng. Struct. Dyn. 11): sliding
//! only, v is a triangle of height πμg/(2ω), which the floor meets at its tips, where |cos ωt| = πη/2, and |sin ωt| > η there.

use super::root::boundary;
use std::f64::consts::PI;

/// The floor and the friction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShakenBlock {
    /// A, m.
    pub(crate) amplitude: f64,
    /// ω, rad/s.
    pub(crate) frequency: f64,
    /// μ.
    pub(crate) friction: f64,
    /// m/s².
    pub(crate) gravity: f64,
}

/// A stretch of motion of one kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Phase {
    /// Its start, s.
    pub(crate) start: f64,
    /// Position (m) and velocity (m/s) of the block there.
    pub(crate) x: f64,
    pub(crate) v: f64,
    /// Sign of the block's acceleration while it slides; 0 where it sticks.
    pub(crate) slides: f64,
}

impl ShakenBlock {
    /// Position and velocity of the floor.
    pub(crate) fn floor(&self, t: f64) -> [f64; 2] {
        let (sin, cos) = (self.frequency * t).sin_cos();
        [self.amplitude * sin, self.amplitude * self.frequency * cos]
    }

    fn floor_acceleration(&self, t: f64) -> f64 {
        -self.frequency * self.frequency * self.floor(t)[0]
    }

    /// η = μg/(Aω²): friction's share of the floor's largest acceleration.
    pub(crate) fn share(&self) -> f64 {
        self.friction * self.gravity / (self.amplitude * self.frequency * self.frequency)
    }

    /// The phases up to time `end`, from position 0 and rest. For η < 1: otherwise it sticks once and for all.
    pub(crate) fn phases(&self, end: f64) -> Vec<Phase> {
        // The floor starts with its largest velocity, Aω.
        let mut phases = vec![Phase { start: 0.0, x: 0.0, v: 0.0, slides: 1.0 }];
        let mut next = self.after(&phases[0]);
        while next.start <= end {
            phases.push(next);
            next = self.after(&next);
        }
        phases
    }

    /// Position and velocity of the block at `t`, which lies in this phase.
    pub(crate) fn at(&self, phase: &Phase, t: f64) -> [f64; 2] {
        let tau = t - phase.start;
        if phase.slides == 0.0 {
            let [x, v] = self.floor(t);
            return [phase.x + x - self.floor(phase.start)[0], v];
        }
        let a = phase.slides * self.friction * self.gravity;
        [phase.x + tau * (phase.v + 0.5 * a * tau), phase.v + a * tau]
    }

    /// The phase that follows another.
    fn after(&self, phase: &Phase) -> Phase {
        let end = if phase.slides == 0.0 { self.end_of_stick(phase.start) } else { self.end_of_slide(phase) };
        let [x, v] = self.at(phase, end);
        let pull = self.floor_acceleration(end);
        // A stick ends where friction's limit is reached: there rounding must not decide.
        let sticks = phase.slides != 0.0 && pull.abs() <= self.friction * self.gravity;
        Phase { start: end, x, v, slides: if sticks { 0.0 } else { pull.signum() } }
    }

    /// The next time at which |sin ωt| grows beyond η.
    fn end_of_stick(&self, start: f64) -> f64 {
        self.next(start, self.share().asin(), PI)
    }

    /// The next time at which the floor's velocity is the block's.
    fn end_of_slide(&self, phase: &Phase) -> f64 {
        let relative = |t: f64| phase.slides * (self.floor(t)[1] - self.at(phase, t)[1]);
        // sin ωt = −ση at angles α and π − α, once each in a turn.
        let angle = (-phase.slides * self.share()).asin();
        let mut from = phase.start;
        loop {
            let to = self.next(from, angle, 2.0 * PI).min(self.next(from, PI - angle, 2.0 * PI));
            if relative(to) < 0.0 {
                return boundary(from, to, |t| relative(t) < 0.0);
            }
            from = to;
        }
    }

    /// The first time after `start` at which ωt is `angle` but for multiples of `period`.
    fn next(&self, start: f64, angle: f64, period: f64) -> f64 {
        let turns = ((self.frequency * start - angle) / period).floor();
        let at = |turns: f64| (angle + turns * period) / self.frequency;
        // `start` may be such a time itself, to rounding on either side.
        let next = at(turns + 1.0);
        if next > start + 1e-9 * period / self.frequency { next } else { at(turns + 2.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A floor with Aω² = 10 m/s² and ω = 5 rad/s, and friction with this share of it.
    fn block(share: f64) -> ShakenBlock {
        ShakenBlock { amplitude: 0.4, frequency: 5.0, friction: share, gravity: 10.0 }
    }

    /// The laws, phase by phase: friction opposes sliding, a stick is within the limit, nothing jumps.
    #[test]
    fn every_phase_obeys_coulomb() {
        for share in [0.05, 0.3, 0.5, 0.55, 0.7, 0.95, 0.999] {
            let block = block(share);
            let phases = block.phases(20.0);
            assert!(phases.len() > 25, "{share}: {}", phases.len());
            for pair in phases.windows(2) {
                let [now, next] = [pair[0], pair[1]];
                assert!(next.start > now.start);
                let [x, v] = block.at(&now, next.start);
                assert!((x - next.x).abs() < 1e-14 && (v - next.v).abs() < 1e-13, "{now:?} {next:?}");
                assert!((block.floor(next.start)[1] - v).abs() < 1e-12, "not yet at the floor's speed: {next:?}");
                for part in 1..100 {
                    let t = now.start + f64::from(part) / 100.0 * (next.start - now.start);
                    let relative = block.floor(t)[1] - block.at(&now, t)[1];
                    if now.slides == 0.0 {
                        assert!(block.floor_acceleration(t).abs() <= share * 10.0 && relative == 0.0);
                    } else {
                        assert!(relative * now.slides > 0.0, "{share}: friction drives at {t}: {now:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn the_steady_state_sticks_from_the_known_share_on() {
        let border = 2.0 / (4.0 + PI * PI).sqrt();
        for (share, sticks) in [(border - 0.005, false), (border + 0.005, true), (0.2, false), (0.9, true)] {
            let phases = block(share).phases(200.0);
            let late = &phases[phases.len() - 20..];
            assert_eq!(late.iter().any(|phase| phase.slides == 0.0), sticks, "{share}");
        }
    }

    #[test]
    fn the_steady_slide_is_the_triangle_of_the_closed_form() {
        let block = block(0.4);
        let phases = block.phases(400.0);
        for phase in &phases[phases.len() - 20..] {
            let height = 0.5 * PI * 0.4 * 10.0 / 5.0;
            assert!((phase.v.abs() - height).abs() < 1e-11, "{phase:?}");
            assert!(((5.0 * phase.start).cos().abs() - 0.5 * PI * 0.4).abs() < 1e-11, "{phase:?}");
        }
    }

    #[test]
    fn the_first_slide_with_round_numbers() {
        // η = ½: ẋ_g = 2 cos 5t meets 5t where 2 cos s = s.
        let phases = block(0.5).phases(1.0);
        let s = boundary(0.0, 2.0, |s: f64| 2.0 * s.cos() < s);
        assert!((phases[1].start - s / 5.0).abs() < 1e-15 && (phases[1].v - s).abs() < 1e-14, "{phases:?}");
        // Then 10 sin s = 8.6 > 5 m/s²: it slides on, the other way.
        assert_eq!(phases[1].slides, -1.0);
    }
}
