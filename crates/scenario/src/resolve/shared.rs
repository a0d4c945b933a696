//! What the scenes of a study have in common: the document but for some numbers, records and tables, read and corrected once, and
//! beams with their factors and equilibria.

use super::parts::SceneParts;
use super::records::Scaling;
use crate::beam_measures::BeamMeasures;
use crate::diagnostic::Diagnostics;
use crate::document::Document;
use crate::driven::SharedBeam;
use crate::equilibrium_key::EquilibriumKey;
use crate::held::Held;
use crate::scene::{AngleUnit, BeamScene, LengthUnit, MotionScene, RecordScene, Reduction};
use crate::simulation::BuildError;
use crate::solver_pool::SolverPool;
use crate::static_start::Settled;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use teeter_beam::BeamSpec;
use teeter_contact::ContactSolver;
use teeter_integrator::Table;
use teeter_record::Record;

/// Records held at most, as they are searched one by one.
const MOST_RECORDS: usize = 256;

/// Motions held at most.
const MOST_MOTIONS: usize = 32;

/// Beams and equilibria held at most, each: in studies that vary them, each case has its own.
const MOST_BEAMS: usize = 32;

/// What one scene after another is made of, held for the next one. Their text and files must be the same.
#[derive(Debug, Default)]
pub struct SharedParts {
    /// Those that aren't in use: at most as many as there are threads.
    last: Mutex<Vec<LastScene>>,
    corrected: Mutex<Held<RecordKeys, Record>>,
    used: Mutex<Held<(RecordKeys, Placed), RecordScene>>,
    tables: Mutex<Held<TableKeys, Table>>,
    beams: Mutex<Held<(BeamSpec, Option<Reduction>), SharedBeam>>,
    settled: Mutex<Held<EquilibriumKey, Settled>>,
    /// Of beams, for warnings.
    pub(super) measures: BeamMeasures,
    units: OnceLock<(Option<LengthUnit>, Option<AngleUnit>)>,
    solvers: SolverPool,
    /// By the texts of the paths and values in their tables.
    motions: Mutex<Held<String, MotionScene>>,
    counts: Counts,
}

/// A document, and the parts of the scene last made from it.
#[derive(Debug)]
pub(crate) struct LastScene {
    pub(super) document: Document,
    pub(super) parts: SceneParts,
}

#[derive(Debug, Default)]
struct Counts {
    beams: AtomicU64,
    settled: AtomicU64,
    tables: AtomicU64,
}

/// How often parts were made for scenes that share them: the same on every machine. Two threads may make the same one.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct SharedCounts {
    /// Beams that were meshed and assembled, with their modes.
    pub beams: u64,
    /// Equilibria that were searched for.
    pub equilibria: u64,
    /// Factors of the beams that are held.
    pub factors: u64,
    /// Tables of signals that were read.
    pub tables: u64,
}

/// What decides what a table of a signal is.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TableKeys {
    pub(super) file: String,
    /// The bits of the start, s.
    pub(super) start: u64,
    /// Those of the step, s.
    pub(super) step: Option<u64>,
    pub(super) columns: Option<[String; 2]>,
    pub(super) time_unit: Option<String>,
    /// The word for what it is there.
    pub(super) outside: Option<String>,
}

/// What decides what a record is before it is scaled.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RecordKeys {
    pub(super) file: String,
    /// s.
    pub(super) step: Option<f64>,
    /// m/s².
    pub(super) unit: Option<f64>,
    pub(super) component: Option<String>,
    /// s.
    pub(super) from: Option<f64>,
    /// s.
    pub(super) to: Option<f64>,
    /// The degree.
    pub(super) baseline: Option<usize>,
    pub(super) taper: f64,
}

/// The table that names a record, and how it scales it.
type Placed = (String, Option<(&'static str, Scaling)>);

impl SharedParts {
    /// What `of` makes of the document with these settings: that of an earlier scene with other numbers if that is all they change, or
    /// one that is made now.
    pub(crate) fn with_document<T>(
        &self,
        sets: &[(String, String)],
        make: impl FnOnce() -> Result<Document, Diagnostics>,
        of: impl FnOnce(&mut LastScene) -> T,
    ) -> Result<T, Diagnostics> {
        let lock = || self.last.lock().unwrap_or_else(PoisonError::into_inner);
        let earlier = lock().pop();
        let earlier = earlier.and_then(|mut last| last.document.take_numbers(sets).then_some(last));
        let mut last = match earlier {
            Some(last) => last,
            None => LastScene { document: make()?, parts: SceneParts::default() },
        };
        let found = of(&mut last);
        lock().push(last);
        Ok(found)
    }

    /// The record as corrected, from earlier or made now.
    pub(super) fn corrected(&self, keys: &RecordKeys, make: impl FnOnce() -> Option<Record>) -> Option<Arc<Record>> {
        Held::find_or(&self.corrected, keys, MOST_RECORDS, make, Record::len)
    }

    /// The record as used, from earlier or made now.
    pub(super) fn used(
        &self,
        keys: &(RecordKeys, Placed),
        make: impl FnOnce() -> Option<RecordScene>,
    ) -> Option<Arc<RecordScene>> {
        Held::find_or(&self.used, keys, MOST_RECORDS, make, |of| 4 * of.record.len())
    }

    /// The table of a signal, from earlier or read now.
    pub(super) fn table(&self, keys: &TableKeys, make: impl FnOnce() -> Option<Table>) -> Option<Arc<Table>> {
        let count = |_: &Table| _ = self.counts.tables.fetch_add(1, Ordering::Relaxed);
        Held::find_or(&self.tables, keys, MOST_RECORDS, || make().inspect(count), |of| 4 * of.rows().count())
    }

    /// A contact solver with this name; `None` if there is none.
    pub(crate) fn solver(&self, name: &str) -> Option<Box<dyn ContactSolver<2>>> {
        self.solvers.take(name)
    }

    /// The prescribed motion of a body, from earlier or resolved now.
    pub(super) fn motion(
        &self,
        keys: String,
        resolve: impl FnOnce() -> Option<MotionScene>,
    ) -> Option<Arc<MotionScene>> {
        let size = |motion: &MotionScene| {
            let tables = motion.0.iter().flatten().filter_map(|axis| axis.history.table());
            tables.map(|table| 4 * table.rows().count()).sum()
        };
        Held::try_find_or(&self.motions, keys, MOST_MOTIONS, || resolve().ok_or(()), size).ok()
    }

    /// The units that the text of the scenes uses most.
    pub(super) fn units(
        &self,
        find: impl FnOnce() -> (Option<LengthUnit>, Option<AngleUnit>),
    ) -> (Option<LengthUnit>, Option<AngleUnit>) {
        *self.units.get_or_init(find)
    }

    /// A beam, from earlier or made now.
    pub(crate) fn beam(&self, of: &BeamScene) -> Result<Arc<SharedBeam>, BuildError> {
        let count = |_: &SharedBeam| _ = self.counts.beams.fetch_add(1, Ordering::Relaxed);
        let key = (of.spec.clone(), of.reduction);
        let made = |shared: &SharedBeam| shared.size();
        Held::try_find_or(&self.beams, key, MOST_BEAMS, || SharedBeam::new(of).inspect(count), made)
    }

    /// A configuration in equilibrium, from earlier or found now.
    pub(crate) fn settled<E>(
        &self,
        key: EquilibriumKey,
        find: impl FnOnce() -> Result<Settled, E>,
    ) -> Result<Arc<Settled>, E> {
        let count = |_: &Settled| _ = self.counts.settled.fetch_add(1, Ordering::Relaxed);
        let size = key.size();
        Held::try_find_or(&self.settled, key, MOST_BEAMS, || find().inspect(count), |of| size + of.size())
    }

    /// What was made so far.
    #[must_use]
    pub fn counts(&self) -> SharedCounts {
        let of = |count: &AtomicU64| count.load(Ordering::Relaxed);
        let beams = self.beams.lock().unwrap_or_else(PoisonError::into_inner);
        SharedCounts {
            beams: of(&self.counts.beams),
            equilibria: of(&self.counts.settled),
            factors: beams.values().map(|beam| beam.factors.made()).sum(),
            tables: of(&self.counts.tables),
        }
    }
}
