//! Time histories in a resolved scene: signals, and the motions and loads that they drive.

use std::sync::Arc;

use teeter_integrator::{Chirp, Formula, Given, Motion, Product, Signal, SignalError, Sum, Table};

/// A time history.
#[derive(Debug, Clone, PartialEq)]
pub enum History {
    /// By formula.
    Formula(Formula),
    /// By a sine of changing frequency.
    Chirp(Chirp),
    /// By rows.
    Table(Arc<Table>),
    /// By a recorded acceleration, m/s²: its amplitude is 1 m/s².
    Record(Arc<RecordScene>),
    /// By a sum of histories that are not sums, each with its factor.
    Sum(Arc<[(f64, History)]>),
    /// By a product of histories.
    Product(Arc<ProductScene>),
}

impl History {
    /// The history for the integrator.
    #[must_use]
    pub fn signal(&self) -> Arc<dyn Signal> {
        match self {
            Self::Formula(formula) => Arc::new(*formula),
            Self::Chirp(chirp) => Arc::new(chirp.clone()),
            Self::Table(table) => Arc::clone(table) as Arc<dyn Signal>,
            Self::Record(record) => Arc::clone(&record.table) as Arc<dyn Signal>,
            Self::Sum(terms) => {
                Arc::new(Sum::new(terms.iter().map(|(factor, term)| (*factor, term.signal())).collect()))
            }
            Self::Product(product) => Arc::new(product.signal.clone()),
        }
    }

    /// From which time on it no longer changes, s; infinite if it never stops.
    #[must_use]
    pub fn settles_at(&self) -> f64 {
        match self {
            Self::Formula(formula) => formula.settles_at(),
            Self::Chirp(chirp) => chirp.settles_at(),
            Self::Table(table) => table.ends()[1].0,
            Self::Record(record) => record.table.ends()[1].0,
            Self::Sum(terms) => terms.iter().map(|(_, term)| term.settles_at()).fold(f64::NEG_INFINITY, f64::max),
            Self::Product(product) => product.settles_at(),
        }
    }

    /// Its terms with their factors: those of a sum, otherwise itself.
    pub fn terms(&self) -> impl Iterator<Item = (f64, &History)> {
        let (sum, whole) = match self {
            Self::Sum(terms) => (Some(terms.iter().map(|(factor, term)| (*factor, term))), None),
            _ => (None, Some((1.0, self))),
        };
        sum.into_iter().flatten().chain(whole)
    }

    /// The shortest period of its oscillation, and between which times it oscillates, s; `None` if it
    /// doesn't, or not by a formula.
    #[must_use]
    pub fn swings(&self) -> Option<(f64, [f64; 2])> {
        match self {
            Self::Formula(formula) => formula.swings(),
            Self::Chirp(chirp) => Some(chirp.swings()),
            Self::Product(product) => product.swings(),
            Self::Table(_) | Self::Record(_) | Self::Sum(_) => None,
        }
    }

    /// Its rows, if it has any.
    #[must_use]
    pub fn table(&self) -> Option<&Table> {
        match self {
            Self::Formula(_) | Self::Chirp(_) | Self::Sum(_) | Self::Product(_) => None,
            Self::Table(table) => Some(table),
            Self::Record(record) => Some(&record.table),
        }
    }
}

/// A product of histories.
#[derive(Debug, Clone)]
pub struct ProductScene {
    scale: f64,
    factors: Vec<History>,
    signal: Product,
}

impl ProductScene {
    /// The product of these histories and `scale`; `until` is the end of the run, s.
    ///
    /// # Errors
    /// If it has too many factors, or too many breaks or periods in the run.
    pub fn new(scale: f64, factors: Vec<History>, until: f64) -> Result<Self, SignalError> {
        let signal = Product::new(scale, factors.iter().map(History::signal).collect(), until)?;
        Ok(Self { scale, factors, signal })
    }

    /// The number that multiplies its factors.
    #[must_use]
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// Its factors.
    #[must_use]
    pub fn factors(&self) -> &[History] {
        &self.factors
    }

    /// Once all factors have settled, or one has settled at 0.
    fn settles_at(&self) -> f64 {
        let settled = |history: &History| {
            let at = history.settles_at();
            // At any later time.
            (at, at.is_finite() && history.signal().value(at + 1.0) == 0.0)
        };
        let all = self.factors.iter().map(settled);
        let (mut last, mut first_zero) = (f64::NEG_INFINITY, f64::INFINITY);
        for (at, at_zero) in all {
            last = last.max(at);
            first_zero = if at_zero { first_zero.min(at) } else { first_zero };
        }
        last.min(first_zero)
    }

    /// The shortest period of its oscillation, and between which times it oscillates, if two factors
    /// do: their frequencies add. A single one is checked by itself.
    fn swings(&self) -> Option<(f64, [f64; 2])> {
        let swings: Vec<(f64, [f64; 2])> = self.factors.iter().filter_map(History::swings).collect();
        let rate: f64 = swings.iter().map(|(period, _)| period.recip()).sum();
        let from = swings.iter().map(|(_, [from, _])| *from).fold(f64::NEG_INFINITY, f64::max);
        let to = swings.iter().map(|(_, [_, to])| *to).fold(f64::INFINITY, f64::min);
        (swings.len() > 1 && from < to).then_some((rate.recip(), [from, to]))
    }
}

impl PartialEq for ProductScene {
    fn eq(&self, other: &Self) -> bool {
        self.scale == other.scale && self.factors == other.factors
    }
}

/// A recorded acceleration that prescribes a component of a motion.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordScene {
    /// The table of the scene that names it, such as `ground.motion.x`.
    pub path: String,
    /// The file, as named in the scene.
    pub file: String,
    /// The record as used: cut, corrected and scaled.
    pub record: teeter_record::Record,
    /// The velocity with which it ends, and the largest one, m/s.
    pub(crate) last_velocity: f64,
    pub(crate) largest_velocity: f64,
    /// When 95 % of its Arias intensity are over, s; none for one that is 0 throughout. Every scene of a study asks for it.
    pub(crate) strong_until: Option<f64>,
    /// Its accelerations over time, m/s²: linear between the values, and falling to 0 within a step
    /// after the last one.
    table: Arc<Table>,
}

impl RecordScene {
    /// The motion by a record.
    ///
    /// # Errors
    /// If its values are too large to be integrated.
    pub fn new(path: &str, file: &str, record: teeter_record::Record) -> Result<Self, SignalError> {
        let mut values = record.accelerations().to_vec();
        // Otherwise the last value would go on for ever.
        if values.last().is_some_and(|last| *last != 0.0) {
            values.push(0.0);
        }
        let times = (0..values.len()).map(|k| record.time(k)).collect();
        let table = Arc::new(Table::new(times, values)?);
        let [last_velocity, _] = record.at_the_end();
        let largest_velocity = record.velocity_peak().size;
        let strong_until = record.husid_times([0.05, 0.95]).ok().map(|[_, strong]| strong);
        let (path, file) = (path.to_owned(), file.to_owned());
        Ok(Self { path, file, record, last_velocity, largest_velocity, strong_until, table })
    }

    /// Its spectral acceleration at a natural period (s), for 5 % damping, m/s²; `None` if it can't be
    /// computed.
    #[must_use]
    pub fn spectral_acceleration(&self, period: f64) -> Option<f64> {
        self.record.intensity(teeter_record::IntensityMeasure::SpectralAcceleration { period }).ok()
    }

    /// Its accelerations over time, m/s².
    #[must_use]
    pub fn table(&self) -> &Arc<Table> {
        &self.table
    }
}

/// A signal of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct SignalScene {
    /// Its name.
    pub name: String,
    /// Its history.
    pub history: History,
    /// Factor of the amplitudes that it multiplies.
    pub scale: f64,
}

/// The prescribed motion of one coordinate.
#[derive(Debug, Clone, PartialEq)]
pub struct AxisScene {
    /// The given quantity.
    pub given: Given,
    /// Amplitude: m, m/s, m/s², or the same with rad.
    pub amplitude: f64,
    /// The signal that multiplies it.
    pub history: History,
}

/// A prescribed motion: x, y and rotation; `None` for components that are not prescribed.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MotionScene(pub [Option<AxisScene>; 3]);

impl MotionScene {
    /// Whether anything is prescribed.
    #[must_use]
    pub fn is_given(&self) -> bool {
        self.0.iter().any(Option::is_some)
    }

    /// Whether all of x, y and rotation are prescribed.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.0.iter().all(Option::is_some)
    }

    /// From which time on its signals no longer change, s; infinite if one never stops. The motion
    /// itself may go on: see [`Self::ends_at`].
    #[must_use]
    pub fn settles_at(&self) -> f64 {
        self.0.iter().flatten().map(|axis| axis.history.settles_at()).fold(0.0, f64::max)
    }

    /// From which time on nothing of it moves any more, s, or, where it may `drift`, moves by more
    /// than a constant velocity of x and y; infinite if it goes on for ever.
    #[must_use]
    pub fn ends_at(&self, drift: bool) -> f64 {
        let axes = self.0.iter().enumerate();
        axes.filter_map(|(k, axis)| Some(axis.as_ref()?.ends_at(drift && k < 2))).fold(0.0, f64::max)
    }

    /// The motions of x, y and rotation; those not prescribed are zero.
    #[must_use]
    pub fn motions(&self) -> [Motion; 3] {
        self.0.each_ref().map(|axis| axis.as_ref().map_or_else(Motion::still, AxisScene::motion))
    }
}

/// A velocity below this part of what the amplitude gives until the signal ends is the rounding of
/// its integral.
const ROUNDING: f64 = 1e-9;

impl AxisScene {
    /// From which time on it stands still, s, or, where it may `drift`, isn't accelerated.
    fn ends_at(&self, drift: bool) -> f64 {
        let settled = self.history.settles_at().max(0.0);
        if self.amplitude == 0.0 {
            return 0.0;
        }
        if self.given == Given::Displacement || settled.is_infinite() {
            return settled;
        }
        // From here on the velocity is constant or, by an acceleration, a straight line.
        let motion = self.motion();
        let [first, second] = [1.0, 2.0].map(|later| motion.velocity(settled + later));
        let is_zero = |v: f64| v.abs() <= ROUNDING * self.amplitude.abs() * (settled + 2.0);
        let is_over = is_zero(second - first) && (drift || is_zero(first));
        if is_over { settled } else { f64::INFINITY }
    }

    /// The motion for the integrator.
    #[must_use]
    pub fn motion(&self) -> Motion {
        Motion::still().with(self.given, self.amplitude, self.history.signal())
    }
}

/// A force and a couple on a block.
#[derive(Debug, Clone, PartialEq)]
pub struct ForceScene {
    /// Its name.
    pub name: String,
    /// The block, by its number in the scene.
    pub block: usize,
    /// Force through the mass centre, N.
    pub force: [f64; 2],
    /// Couple, N·m.
    pub couple: f64,
    /// The signal that multiplies it.
    pub history: History,
}

/// A load on a beam.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadScene {
    /// Its name.
    pub name: String,
    /// The beam, by its number in the scene.
    pub beam: usize,
    /// Position and size.
    pub kind: LoadKind,
    /// The signal that multiplies it.
    pub history: History,
}

/// Where a load acts on a beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LoadKind {
    /// At a point.
    Point {
        /// Place along the beam, m.
        at: f64,
        /// N, upwards.
        force: f64,
        /// N·m, counter-clockwise.
        couple: f64,
    },
    /// Uniform over a part of the beam.
    Distributed {
        /// N/m, upwards.
        load: f64,
        /// Where it begins, m.
        from: f64,
        /// Where it ends, m.
        to: f64,
    },
    /// A force that moves along the beam.
    Moving {
        /// N, upwards.
        force: f64,
        /// Where it is at t = 0, m.
        at: f64,
        /// m/s.
        speed: f64,
    },
}
