//! Writes a synthetic record to standard output: the ground acceleration of the scenario
//! `rocking-under-earthquake`.
//!
//! ```text
//! cargo run -p teeter-record --example synthetic_record > scenarios/rocking-under-earthquake.csv
//! ```
//!
//! White noise of a fixed seed under an envelope in time goes through two filters of one degree of
//! freedom: that of Kanai and Tajimi for the soil (K. Kanai, Bull. Earthq. Res. Inst. 35 (1957)
//! 309–325; H. Tajimi, Proc. 2nd World Conf. Earthq. Eng. (1960) 781–797), whose absolute
//! acceleration is the ground's, and the high-pass filter of R. W. Clough and J. Penzien (Dynamics
//! of Structures, 1975), without which the displacement would grow without bounds. The rest of the
//! drift is a quadratic baseline, which is subtracted.

use std::f64::consts::{PI, TAU};
use std::io::Write;
use teeter_record::{Record, RecordError, STANDARD_GRAVITY};

/// Time between two values, s, and how many there are.
const STEP: f64 = 0.01;
const VALUES: usize = 2001;

/// Circular frequency (rad/s) and damping ratio of the soil, and of the high-pass filter.
const SOIL: (f64, f64) = (5.0 * PI, 0.6);
const HIGH_PASS: (f64, f64) = (1.5, 0.6);

/// The envelope rises with the square of time, is constant, and decays exponentially: s, s, 1/s.
const STRONG: [f64; 2] = [2.0, 9.0];
const DECAY: f64 = 0.45;

/// Peak ground acceleration, m/s².
const PEAK: f64 = 0.35 * STANDARD_GRAVITY;

/// The record.
///
/// # Errors
/// None with these constants.
pub(crate) fn synthetic() -> Result<Record, RecordError> {
    let mut noise = Noise(1957);
    let [mut soil, mut high_pass] = [SOIL, HIGH_PASS].map(|(omega, zeta)| Oscillator::new(omega, zeta));
    let values = (0..VALUES).map(|k| {
        let base = envelope(k as f64 * STEP) * noise.normal();
        let soil = soil.step(base);
        let absolute = base + soil;
        // Relative to a slow oscillator: what is much faster passes.
        high_pass.step(absolute)
    });
    let record = Record::new("synthetic", STEP, values.collect())?;
    let corrected = record.baseline_corrected(2)?.tapered(0.02)?.scaled_to_peak(PEAK)?;
    // A hundredth of a mm/s² is finer than any instrument, and makes a short file.
    let rounded = corrected.accelerations().iter().map(|a| (a * 1e5).round() / 1e5 + 0.0).collect();
    Record::new("synthetic", STEP, rounded)
}

fn envelope(t: f64) -> f64 {
    let [rise, fall] = STRONG;
    if t < rise {
        (t / rise).powi(2)
    } else if t < fall {
        1.0
    } else {
        (-DECAY * (t - fall)).exp()
    }
}

/// Normal numbers: SplitMix64 and the transform of Box and Muller.
struct Noise(u64);

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        // In (0, 1), of 53 bits.
        (((z ^ (z >> 31)) >> 11) as f64 + 0.5) / 9_007_199_254_740_992.0
    }

    fn normal(&mut self) -> f64 {
        let (u, v) = (self.uniform(), self.uniform());
        (-2.0 * u.ln()).sqrt() * (TAU * v).cos()
    }
}

/// ü + 2ζω u̇ + ω² u = −a from rest, by the trapezoidal rule.
struct Oscillator {
    omega: f64,
    zeta: f64,
    u: f64,
    v: f64,
    relative: f64,
}

impl Oscillator {
    fn new(omega: f64, zeta: f64) -> Self {
        Self { omega, zeta, u: 0.0, v: 0.0, relative: 0.0 }
    }

    /// The acceleration ü relative to the base at the end of the next step, at which the base has
    /// the acceleration `a`.
    fn step(&mut self, a: f64) -> f64 {
        let (h, friction, stiffness) = (STEP, 2.0 * self.zeta * self.omega, self.omega * self.omega);
        let (u, v) = (self.u + h * self.v + 0.25 * h * h * self.relative, self.v + 0.5 * h * self.relative);
        let relative = -(a + friction * v + stiffness * u) / (1.0 + 0.5 * h * friction + 0.25 * h * h * stiffness);
        (self.u, self.v, self.relative) = (u + 0.25 * h * h * relative, v + 0.5 * h * relative, relative);
        relative
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let record = synthetic()?;
    let mut out = std::io::stdout().lock();
    writeln!(out, "# Synthetic record, no measured one: Kanai-Tajimi noise, high-pass filtered, under an envelope")?;
    writeln!(out, "# (cargo run -p teeter-record --example synthetic_record)")?;
    writeln!(out, "t [s],a [m/s^2]")?;
    for (k, a) in record.accelerations().iter().enumerate() {
        writeln!(out, "{:.2},{a:.5}", record.time(k))?;
    }
    Ok(())
}
