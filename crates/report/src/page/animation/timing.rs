//! When the pictures of an animation are, and how long each is shown.

/// Most pictures of an animation.
const MOST: usize = 1000;

/// How long an animation takes if nobody asks for another speed, s.
const PLAYED: [f64; 2] = [5.0, 20.0];

/// How long its last picture is shown, s.
const REST: f64 = 1.0;

/// The times of an animation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Timing {
    /// Number of pictures, the first at the start of the run and the last at its end.
    pub(super) pictures: usize,
    /// As a part of real time.
    pub(super) speed: f64,
    /// Pictures a second.
    pub(super) rate: f64,
    /// How long the run lasted, s.
    lasted: f64,
}

impl Timing {
    pub(super) fn new(lasted: f64, rate: f64, speed: Option<f64>) -> Self {
        let lasted = if lasted.is_finite() { lasted.max(0.0) } else { 0.0 };
        let speed = speed.unwrap_or_else(|| suitable_speed(lasted));
        let played = lasted / speed;
        let wanted = (played * rate).round();
        if wanted < MOST as f64 {
            return Self { pictures: (wanted as usize).max(usize::from(lasted > 0.0)) + 1, speed, rate, lasted };
        }
        Self { pictures: MOST, speed, rate: (MOST - 1) as f64 / played, lasted }
    }

    /// The time of a picture since the start of the run, s.
    pub(super) fn time(&self, picture: usize) -> f64 {
        self.lasted * picture as f64 / (self.pictures - 1).max(1) as f64
    }

    /// How long a picture is shown, s.
    pub(super) fn shown(&self, picture: usize) -> f64 {
        if picture + 1 == self.pictures { REST } else { 1.0 / self.rate }
    }

    /// Decimals that tell the times of two pictures apart, s.
    pub(super) fn decimals(&self) -> usize {
        let between = self.lasted / (self.pictures - 1).max(1) as f64;
        if between > 0.0 { (-between.log10()).ceil().clamp(0.0, 9.0) as usize } else { 0 }
    }
}

/// The speed nearest to 1 of 1, 2, 5, 10 … times slower or faster with which a run is shown in a time that one likes to watch.
fn suitable_speed(lasted: f64) -> f64 {
    let factors = || (0..=6).flat_map(|power| [1.0, 2.0, 5.0].map(|factor| factor * 10f64.powi(power)));
    if lasted < PLAYED[0] {
        factors().find(|slower| lasted * slower >= PLAYED[0]).map_or(1e-6, |slower| 1.0 / slower)
    } else {
        factors().find(|faster| lasted / faster <= PLAYED[1]).unwrap_or(1e6)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speeds_are_round_and_make_an_animation_of_5_to_20_s() {
        for (lasted, speed) in
            [(0.5, 0.1), (2.0, 0.2), (5.0, 1.0), (20.0, 1.0), (21.0, 2.0), (400.0, 20.0), (1e-3, 2e-4)]
        {
            let found = suitable_speed(lasted);
            assert!((found / speed - 1.0).abs() < 1e-12, "{lasted}: {found}");
        }
        for k in 0..200 {
            let lasted = 1e-4 * 1.1f64.powi(k);
            let played = lasted / suitable_speed(lasted);
            assert!((PLAYED[0] - 1e-9..=PLAYED[1]).contains(&played) || lasted > 1e7, "{lasted}: {played}");
        }
    }

    #[test]
    fn pictures_go_from_start_to_end_and_are_not_too_many() {
        let timing = Timing::new(0.5, 25.0, Some(0.1));
        assert_eq!((timing.pictures, timing.time(0), timing.time(125)), (126, 0.0, 0.5));
        assert_eq!((timing.shown(0), timing.shown(125)), (0.04, REST));
        let long = Timing::new(1000.0, 25.0, Some(1.0));
        assert_eq!((long.pictures, long.time(MOST - 1)), (MOST, 1000.0));
        assert!((long.shown(0) * (MOST - 1) as f64 - 1000.0).abs() < 1e-9);
        // A run that ended at its start, and one shorter than a picture.
        assert_eq!(Timing::new(0.0, 25.0, None).pictures, 1);
        assert_eq!(Timing::new(1e-3, 25.0, Some(1.0)).pictures, 2);
    }
}
