//! Time histories in a resolved scene: signals, and the motions and loads that they drive.

use std::sync::Arc;

use teeter_integrator::{Formula, Given, Motion, Signal, Table};

/// A time history.
#[derive(Debug, Clone, PartialEq)]
pub enum History {
    /// By formula.
    Formula(Formula),
    /// By rows.
    Table(Arc<Table>),
}

impl History {
    /// The history for the integrator.
    #[must_use]
    pub fn signal(&self) -> Arc<dyn Signal> {
        match self {
            Self::Formula(formula) => Arc::new(*formula),
            Self::Table(table) => Arc::clone(table) as Arc<dyn Signal>,
        }
    }
}

/// A signal of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct SignalScene {
    /// Its name.
    pub name: String,
    /// Its history.
    pub history: History,
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

    /// The motions of x, y and rotation; those not prescribed are zero.
    #[must_use]
    pub fn motions(&self) -> [Motion; 3] {
        self.0.each_ref().map(|axis| axis.as_ref().map_or_else(Motion::still, AxisScene::motion))
    }
}

impl AxisScene {
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
