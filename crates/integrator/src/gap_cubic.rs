//! The cubic of a gap through what is known of it at two times.

/// A gap over a part of the way from one time to another, by its values and rates there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GapCubic {
    /// Its values at both ends, m.
    ends: [f64; 2],
    /// Its rate at the first, times the time in between, m.
    slope: f64,
    /// The coefficients of the square and the cube.
    c2: f64,
    c3: f64,
}

impl GapCubic {
    /// Through these gaps (m) with these rates (m/s), a time of `h` (s) apart.
    pub(crate) fn new([a, b]: [f64; 2], [rate, end_rate]: [f64; 2], h: f64) -> Self {
        let (da, db) = (h * rate, h * end_rate);
        let (c2, c3) = (3.0 * (b - a) - 2.0 * da - db, 2.0 * (a - b) + da + db);
        Self { ends: [a, b], slope: da, c2, c3 }
    }

    /// The gap at the part `s` of the way, m.
    fn value(&self, s: f64) -> f64 {
        ((self.c3 * s + self.c2) * s + self.slope) * s + self.ends[0]
    }

    /// The part of the way at which a gap that is positive first and negative last is 0, by this
    /// many halvings.
    pub(crate) fn zero(&self, halvings: usize) -> f64 {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..halvings {
            let s = 0.5 * (low + high);
            *(if self.value(s) > 0.0 { &mut low } else { &mut high }) = s;
        }
        0.5 * (low + high)
    }

    /// Where it may be lowest on the way, and how low, m, for one that may fall at first and rises in the end: the cubic's lowest point, and
    /// where the tangents at both ends meet. A gap to something round, which is passed from one side to the other, is no cubic.
    pub(crate) fn lows(&self) -> [(f64, f64); 2] {
        let [a, b] = self.ends;
        let (da, db) = (self.slope, 2.0 * self.c2 + 3.0 * self.c3 + self.slope);
        let s = (b - a - db) / (da - db);
        let meet = if da < 0.0 && db > 0.0 { (s, a + da * s) } else { (0.5, f64::INFINITY) };
        [self.lowest(), meet]
    }

    fn lowest(&self) -> (f64, f64) {
        let Self { slope: da, c2, c3, .. } = *self;
        let root = (c2 * c2 - 3.0 * c3 * da).max(0.0).sqrt();
        // 3 c3 s² + 2 c2 s + da = 0, without a difference of like numbers.
        let s = if c2 + root > 0.0 { -da / (c2 + root) } else { 0.5 };
        (s, self.value(s))
    }
}
