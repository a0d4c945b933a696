//! The observer that writes the tables and keeps what the summary needs.

use crate::bounces::Bounces;
use crate::closed::Closed;
use crate::contacts::{self, AtEnd, Impulses, push_names};
use crate::deflections::{LargestDeflection, Places};
use crate::driven::Driven;
use crate::feet_lines::FeetLine;
use crate::meetings::Met;
use crate::number::{push, push_next};
use crate::resolution::{Bodies, Resolution};
use crate::sections::{BeamRecord, Sections, Values};
use crate::swings::{Swings, Watch};
use crate::table::Table;
use crate::verdict::{self, Fates, Tilt};
use crate::{EndedWord, Results, ResultsError, Schedule, SharedStances, WarningLog};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::ops::ControlFlow;
use std::sync::Arc;
use teeter_integrator::{
    Closing, ClosingMonitor, Ended, Model, Observer, ObserverError, PhaseKind, RockingMonitor, State, StepReport,
};
use teeter_scenario::Shapes;
use teeter_scenario::diagnostic::Diagnostic;
use teeter_scenario::scene::{Scene, SchemeName};
use teeter_scenario::simulation::{BlockPlace, Layout};

mod alarms;

/// An impact as the summary lists it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ImpactRow {
    /// End of the step, s.
    pub t: f64,
    /// The contact's name.
    pub contact: String,
    /// The corner.
    pub point: Cow<'static, str>,
    /// Normal impulse, N·s.
    pub impulse_n: f64,
    /// Normal velocity before, m/s.
    pub u_n_before: f64,
}

/// Impacts that the summary lists; `impacts.csv` has all.
const LISTED_IMPACTS: usize = 1000;

/// What a run showed, beside its tables.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Record {
    /// The step before the first one: 0, but for a run that starts from the state of another one.
    pub first_step: u64,
    /// The first impacts.
    pub impacts: Vec<ImpactRow>,
    /// All impacts, counted.
    pub impact_count: u64,
    /// How often a contact was lost for a moment and found again, without having been truly open.
    pub reclosure_count: u64,
    /// Up to when the motion was found to be as accurate as was asked for, s.
    pub horizon: Option<f64>,
    /// Zero crossings and peaks, by block; on a beam from its undeformed axis.
    pub rocking: Vec<RockingMonitor>,
    /// The same on a beam from the line between the block's feet.
    #[serde(default)]
    pub feet_lines: Vec<FeetLine>,
    /// What beams bore, of those that are asked.
    pub beams: Vec<BeamRecord>,
    /// The largest deflections, of a scene without blocks.
    #[serde(default)]
    pub deflections: Vec<LargestDeflection>,
    /// The deflections at the times told of these, m.
    #[serde(default)]
    pub first_deflections: Vec<f64>,
    /// The deepest penetration at the end of the last step, m.
    #[serde(default)]
    pub last_penetration: f64,
    /// What became of the blocks.
    pub fates: Fates,
    /// What the run warned of.
    pub warnings: WarningLog,
}

impl Record {
    /// The word for the end of the run that this is the record of.
    #[must_use]
    pub fn ended(&self, ended: &Ended) -> EndedWord {
        match ended {
            // By `time.stop`, not by the user.
            Ended::Interrupted if self.fates.stopped().is_some() => EndedWord::Stopped,
            ended => EndedWord::from(ended),
        }
    }
}

/// The tables, in the order in which a checkpoint has their lengths.
pub(crate) const TABLES: [&str; 5] = ["trajectory.csv", "contacts.csv", "impacts.csv", "energy.csv", BLOCKS];

/// The table that scenes of very many blocks have instead of columns of theirs.
pub(crate) const BLOCKS: &str = "blocks.csv";

pub(crate) const IMPACTS_HEADER: &str = "t,contact,a,b,point,impulse_n,impulse_t,u_n_before,u_n_after\n";

pub(crate) const BLOCKS_HEADER: &str = "t,block,x,y,phi,vx,vy,omega\n";

pub(crate) const ENERGY_HEADER: &str =
    "t,kinetic,elastic,gravity,external,contact,friction,viscous,numerical,projection,residual\n";

/// What a recorder knows of the run so far, beside the lengths of its tables.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Kept {
    schedule: Schedule,
    closings: ClosingMonitor<2>,
    met: Met,
    impulses: Impulses,
    /// The contacts of the last step, for a row after the run's early end.
    contacts_now: Vec<AtEnd>,
    /// The step of the last row.
    row_at: u64,
    /// Of the last step, for a row after the run's early end too.
    section_values: Values,
    resolution: Resolution,
    swings: Swings,
    #[serde(default)]
    bounces: Bounces,
    /// How far anything may have moved since it was last looked who meets whom, m.
    travelled: f64,
    record: Record,
}

/// Writes the tables of a run as it goes.
pub struct Recorder<'a> {
    layout: &'a Layout,
    shapes: Shapes,
    trajectory: Table,
    contacts: Table,
    impacts: Table,
    energy: Table,
    blocks: Table,
    /// The blocks that have columns in the trajectory, by their numbers.
    columns: Vec<usize>,
    sections: Sections,
    driven: Vec<Driven>,
    bodies: Bodies,
    places: Places,
    watch: Watch,
    fate_watch: verdict::Watch,
    /// The shorter side of the block whose that is the shortest, m.
    shortest_side: f64,
    /// Whether the scheme locates closings, and ends bounces by its step: of one that locates none the other warnings tell more.
    locates: bool,
    line: String,
    /// The contacts that closed in the last step.
    closed: Vec<Closed>,
    kept: Kept,
    tell: &'a mut dyn FnMut(&str),
}

impl std::fmt::Debug for Recorder<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Recorder").field("record", &self.kept.record).finish_non_exhaustive()
    }
}

impl<'a> Recorder<'a> {
    /// Opens the tables of a run of `scene`; `tell` hears warnings as they come.
    ///
    /// # Errors
    /// If a table can't be written.
    pub fn new(
        results: &Results,
        scene: &Scene,
        layout: &'a Layout,
        tell: &'a mut dyn FnMut(&str),
    ) -> Result<Self, ResultsError> {
        let table = |k, header: &dyn Fn() -> String| match is_written(TABLES[k], scene) {
            true => results.table(TABLES[k], &header()),
            false => Ok(Table::nowhere()),
        };
        Self::fresh(table, blocks_in_columns(scene, layout), scene, layout, tell)
    }

    /// A recorder of a run of `scene` that writes no tables: for what a run shows and warns of.
    ///
    /// # Errors
    /// None today; as [`Recorder::new`].
    pub fn watching(scene: &Scene, layout: &'a Layout, tell: &'a mut dyn FnMut(&str)) -> Result<Self, ResultsError> {
        Self::fresh(|_, _| Ok(Table::nowhere()), Vec::new(), scene, layout, tell)
    }

    /// A recorder of a run of `scene` that keeps the rows of its trajectory in memory, for
    /// [`Self::trajectory`], with columns of all blocks whatever the scene chooses, and writes no tables.
    ///
    /// # Errors
    /// None today; as [`Recorder::new`].
    pub fn in_memory(scene: &Scene, layout: &'a Layout, tell: &'a mut dyn FnMut(&str)) -> Result<Self, ResultsError> {
        let table = |k, _: &dyn Fn() -> String| Ok(if k == 0 { Table::in_memory() } else { Table::nowhere() });
        Self::fresh(table, (0..layout.blocks.len()).collect(), scene, layout, tell)
    }

    /// The header of the trajectory table and its rows so far, as `trajectory.csv` would hold them,
    /// of a recorder made by [`Self::in_memory`].
    #[must_use]
    pub fn trajectory(&self) -> (String, &str) {
        let header = trajectory_header(self.layout, &self.columns, &self.sections, &self.driven);
        (header, std::str::from_utf8(self.trajectory.kept()).unwrap_or_default())
    }

    /// Takes how blocks stand and beams swing from what recorders of earlier runs found, and leaves there what it finds.
    #[must_use]
    pub fn sharing(mut self, stances: &Arc<SharedStances>) -> Self {
        self.fate_watch.share(stances);
        self.watch.share(stances);
        self
    }

    fn fresh(
        table: impl Fn(usize, &dyn Fn() -> String) -> Result<Table, ResultsError>,
        columns: Vec<usize>,
        scene: &Scene,
        layout: &'a Layout,
        tell: &'a mut dyn FnMut(&str),
    ) -> Result<Self, ResultsError> {
        let sections = Sections::new(scene, layout);
        let (beams, section_values) = sections.empty(scene, layout);
        // Only of tables that are written.
        let header = |k: usize| match k {
            0 => trajectory_header(layout, &columns, &Sections::new(scene, layout), &Driven::of(scene, layout)),
            _ => [contacts::HEADER, IMPACTS_HEADER, ENERGY_HEADER, BLOCKS_HEADER][k - 1].to_owned(),
        };
        let kept = Kept {
            schedule: Schedule::new(scene.every, scene.time.steps(), scene.time.step),
            closings: ClosingMonitor::default(),
            met: Met::default(),
            impulses: Impulses::default(),
            contacts_now: Vec::new(),
            row_at: 0,
            section_values,
            resolution: Resolution::default(),
            swings: Swings::default(),
            bounces: Bounces::default(),
            travelled: 0.0,
            record: Record { beams, ..Record::default() },
        };
        Self::with(|k| table(k, &|| header(k)), columns.clone(), kept, sections, scene, layout, tell)
    }

    /// Opens the tables of a run of `scene` again where a checkpoint left them; what was written past that goes.
    pub(crate) fn resume(
        results: &Results,
        (kept, lengths): (Kept, [u64; TABLES.len()]),
        scene: &Scene,
        layout: &'a Layout,
        tell: &'a mut dyn FnMut(&str),
    ) -> Result<Self, ResultsError> {
        let sections = Sections::new(scene, layout);
        let table = |k: usize| match is_written(TABLES[k], scene) {
            true => results.reopened_table(TABLES[k], lengths[k]),
            false => Ok(Table::nowhere()),
        };
        Self::with(table, blocks_in_columns(scene, layout), kept, sections, scene, layout, tell)
    }

    fn with(
        table: impl Fn(usize) -> Result<Table, ResultsError>,
        columns: Vec<usize>,
        kept: Kept,
        sections: Sections,
        scene: &Scene,
        layout: &'a Layout,
        tell: &'a mut dyn FnMut(&str),
    ) -> Result<Self, ResultsError> {
        Ok(Self {
            layout,
            shapes: Shapes::new(scene),
            trajectory: table(0)?,
            contacts: table(1)?,
            impacts: table(2)?,
            energy: table(3)?,
            blocks: table(4)?,
            columns,
            sections,
            driven: Driven::of(scene, layout),
            bodies: Bodies::of(scene),
            places: Places::of(scene, layout),
            watch: Watch::of(scene, layout),
            fate_watch: verdict::Watch::of(scene, layout),
            shortest_side: layout.blocks.iter().map(|place| place.side).fold(f64::INFINITY, f64::min),
            locates: scene.time.scheme == SchemeName::MoreauJeanLocated,
            line: String::new(),
            closed: Vec::new(),
            kept,
            tell,
        })
    }

    /// What a checkpoint keeps: all rows are on disk then, in tables of these lengths.
    pub(crate) fn keep(&mut self) -> Result<(&Kept, [u64; TABLES.len()]), ResultsError> {
        self.flush()?;
        let tables = [&self.trajectory, &self.contacts, &self.impacts, &self.energy, &self.blocks];
        let lengths = tables.map(Table::written);
        Ok((&self.kept, lengths))
    }

    /// Notes what looked wrong before the run.
    pub fn note(&mut self, findings: &[Diagnostic]) {
        for finding in findings {
            // The recorder hears of them late: they have been told.
            self.kept.record.warnings.enter_finding("scene", finding.to_string());
        }
    }

    /// Brings all rows to disk.
    fn flush(&mut self) -> Result<(), ResultsError> {
        [&mut self.trajectory, &mut self.contacts, &mut self.impacts, &mut self.energy, &mut self.blocks]
            .into_iter()
            .try_for_each(Table::flush)
    }

    /// The values of the last step: of the columns of what beams bear, deflections left out.
    pub(crate) fn section_values(&self) -> &[f64] {
        &self.kept.section_values
    }

    /// Between which angles each block stood, rad.
    pub(crate) fn points_of_no_return(&self) -> Vec<Option<[f64; 2]>> {
        self.kept.record.fates.points_of_no_return(&self.fate_watch)
    }

    /// What was seen.
    #[must_use]
    pub fn into_record(self) -> Record {
        self.kept.record
    }

    fn write_row(&mut self, state: &State) -> Result<(), ResultsError> {
        self.warn_of_row(state);
        if self.trajectory.takes_rows() {
            self.write_trajectory_row(state)?;
        }
        if self.blocks.takes_rows() {
            self.write_block_rows(state)?;
        }
        if self.energy.takes_rows() { self.write_energy_row(state) } else { Ok(()) }
    }

    fn write_trajectory_row(&mut self, state: &State) -> Result<(), ResultsError> {
        self.line.clear();
        push(&mut self.line, state.t);
        for block in self.columns.iter().map(|&block| &self.layout.blocks[block]) {
            push_motion(&mut self.line, block, state);
        }
        let mut section_values = self.kept.section_values.iter();
        for (number, beam) in self.layout.beams.iter().enumerate() {
            let (q, v) = (&state.q[beam.range.clone()], &state.v[beam.range.clone()]);
            let middle = beam.beam.shape_clamped(0.5 * beam.beam.spec().span);
            push_next(&mut self.line, beam.deflection(&middle, q).w);
            push_next(&mut self.line, beam.deflection(&middle, v).w);
            self.sections.push_row(number, beam, q, &mut section_values, &mut self.line);
        }
        for driven in &self.driven {
            driven.values(state).into_iter().for_each(|x| push_next(&mut self.line, x));
        }
        self.line.push('\n');
        self.trajectory.rows(&self.line)
    }

    /// A row for each block.
    fn write_block_rows(&mut self, state: &State) -> Result<(), ResultsError> {
        for block in &self.layout.blocks {
            self.line.clear();
            push(&mut self.line, state.t);
            self.line.push(',');
            self.line.push_str(&block.name);
            push_motion(&mut self.line, block, state);
            self.line.push('\n');
            self.blocks.rows(&self.line)?;
        }
        Ok(())
    }

    fn write_energy_row(&mut self, state: &State) -> Result<(), ResultsError> {
        self.line.clear();
        push(&mut self.line, state.t);
        let (now, sum) = (&state.ledger.current, &state.ledger.sum);
        for x in [
            now.kinetic,
            now.elastic,
            now.gravity,
            sum.external,
            sum.contact,
            sum.friction,
            sum.viscous,
            sum.numerical,
            sum.projection,
            sum.residual,
        ] {
            push_next(&mut self.line, x);
        }
        self.line.push('\n');
        self.energy.rows(&self.line)
    }

    /// The rows of all tables at the state's time.
    fn write_rows(&mut self, model: &Model<2>, state: &State) -> Result<(), ResultsError> {
        self.kept.row_at = state.step;
        self.write_row(state)?;
        self.line.clear();
        self.kept.impulses.rows(self.layout, model, state, &self.kept.contacts_now, &mut self.line);
        self.contacts.rows(&self.line)
    }

    /// Takes the contacts of a step in, for the next row.
    fn take_contacts(&mut self, step: &StepReport<'_, 2>) {
        let Kept { impulses, contacts_now, .. } = &mut self.kept;
        contacts_now.clear();
        let mut last = None;
        for part in step.active() {
            impulses.add(part.contacts, part.duration, part.balance);
            // Those of its last part, and of an impact at its very end.
            if part.is_last_lasting {
                contacts_now.extend(part.contacts.iter().map(AtEnd::of));
            }
            last = Some(part);
        }
        if let Some(last) = last.filter(|part| part.kind == PhaseKind::Impact) {
            contacts_now.extend(last.contacts.iter().filter(|contact| contact.p[0] > 0.0).map(AtEnd::of));
        }
    }

    /// Tells impacts from contacts that were lost for a moment, and writes the impacts.
    fn take_closings(
        &mut self,
        model: &Model<2>,
        step: &StepReport<'_, 2>,
        state: &State,
    ) -> Result<(), ObserverError> {
        let Self { layout, closed, kept: Kept { closings, record, .. }, .. } = self;
        Closed::of_step(closings, model, step, state, layout, closed)?;
        if self.closed.is_empty() {
            return Ok(());
        }
        (record.impact_count, record.reclosure_count) = (closings.impacts(), closings.reclosures());
        Ok(self.write_impacts()?)
    }

    fn write_impacts(&mut self) -> Result<(), ResultsError> {
        let Self { layout, closed, impacts, line, kept: Kept { record, .. }, .. } = self;
        for Closed { t, contact, .. } in closed.iter().filter(|closed| closed.closing == Closing::Impact) {
            let Some(names) = layout.names_of(contact.id) else { continue };
            line.clear();
            push(line, *t);
            push_names(&names, line);
            for x in [contact.p[0], contact.p[1], contact.u_before[0], contact.u_after[0]] {
                push_next(line, x);
            }
            line.push('\n');
            impacts.rows(line)?;
            if record.impacts.len() < LISTED_IMPACTS {
                record.impacts.push(ImpactRow {
                    t: *t,
                    contact: names.contact.to_owned(),
                    point: names.point.to_string().into(),
                    impulse_n: contact.p[0],
                    u_n_before: contact.u_before[0],
                });
            }
        }
        Ok(())
    }

    /// The contacts that closed in the last step.
    pub(crate) fn closed(&self) -> &[Closed] {
        &self.closed
    }

    fn look_at_deflections(&mut self, state: &State) {
        let Record { deflections, first_deflections, .. } = &mut self.kept.record;
        self.places.look(self.layout, state, deflections, first_deflections);
    }
}

impl Observer<2> for Recorder<'_> {
    fn start(&mut self, model: &Model<2>, state: &State) -> Result<(), ObserverError> {
        // A run that starts from the state of another one has its rows from there on.
        self.kept.schedule = self.kept.schedule.clone().starting_at(state.step);
        (self.kept.row_at, self.kept.record.first_step) = (state.step, state.step);
        self.kept.closings = ClosingMonitor::new(model, state, &self.layout.openings)?;
        self.kept.resolution.start(self.layout, state);
        self.kept.swings.start(&self.watch);
        self.kept.record.fates.start(&self.fate_watch, self.layout, model, state)?;
        let Record { rocking, feet_lines, fates, .. } = &mut self.kept.record;
        let monitor = |tilt: f64, least: f64| RockingMonitor::new(state.t, tilt).with_least(least);
        let line = |((tilt, place), rocks): ((Tilt, &BlockPlace), f64)| {
            // A beam that vibrates lifts the feet of what stands on it by turns, which is no rocking.
            let least = if tilt.line.is_some() { place.still.max(rocks) } else { place.still };
            FeetLine::new(monitor(tilt.rocking(), least), tilt.line)
        };
        let started = || fates.tilts().zip(&self.layout.blocks);
        *feet_lines = started().zip(self.fate_watch.least_swings()).map(line).collect();
        *rocking = started().map(|(tilt, place)| monitor(tilt.carrier, place.still)).collect();
        self.look_at_deflections(state);
        let (record, values) = (&mut self.kept.record, &mut self.kept.section_values);
        self.sections.start(self.layout, state, (&mut record.beams, values), &mut record.warnings);
        Ok(self.write_row(state)?)
    }

    fn observe(
        &mut self,
        model: &Model<2>,
        step: &StepReport<'_, 2>,
        state: &State,
    ) -> Result<ControlFlow<()>, ObserverError> {
        self.take_contacts(step);
        self.take_closings(model, step, state)?;
        self.warn_of_crests();
        self.warn_of_unsolved(step);
        self.warn_of_limits(state);
        let swing = self.kept.swings.observe(&mut self.watch, self.layout, step.h, state);
        self.warn_of_motion(step, state, swing);
        self.kept.resolution.observe(&self.bodies, self.layout, step, state);
        self.warn_of_bounces(model, step);
        let Kept { record, section_values, .. } = &mut self.kept;
        record.last_penetration = step.penetration;
        let kept = (record.beams.as_mut_slice(), section_values);
        self.sections.observe(step, kept, &mut record.warnings);
        self.look_at_deflections(state);
        self.kept.record.fates.observe(&self.fate_watch, self.layout, step, state);
        let Record { rocking, feet_lines, fates, .. } = &mut self.kept.record;
        for ((monitor, line), tilt) in rocking.iter_mut().zip(feet_lines).zip(fates.tilts()) {
            monitor.enter(state.t, tilt.carrier);
            line.enter(state.t, tilt.rocking(), tilt.line);
        }
        if self.kept.schedule.takes(state.step, state.t) {
            self.write_rows(model, state)?;
        }
        // The others see the step, too, before it ends the run.
        Ok(if self.kept.record.fates.stopped().is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
    }

    /// The last step always is a row, also of a run that ended before its time.
    fn finish(&mut self, model: &Model<2>, state: &State) -> Result<(), ObserverError> {
        if state.step != self.kept.row_at {
            self.write_rows(model, state)?;
        }
        self.warn_of_resolution(state);
        Ok(self.flush()?)
    }
}

/// Position, angle and their velocities, each after a comma.
fn push_motion(line: &mut String, block: &BlockPlace, state: &State) {
    for x in state.q[block.range.clone()].iter().chain(&state.v[block.range.clone()]) {
        push_next(line, *x);
    }
}

/// Whether a run of this scene has this one of the [`TABLES`].
pub(crate) fn is_written(table: &str, scene: &Scene) -> bool {
    table != BLOCKS || scene.block_tables.has_rows()
}

/// The blocks that have columns in the trajectory, by their numbers.
pub(crate) fn blocks_in_columns(scene: &Scene, layout: &Layout) -> Vec<usize> {
    scene.block_tables.columns(layout.blocks.len()).collect()
}

/// The header of the trajectory, with columns of these blocks.
pub(crate) fn trajectory_header(layout: &Layout, blocks: &[usize], sections: &Sections, driven: &[Driven]) -> String {
    let mut header = String::from("t");
    for block in blocks.iter().map(|&block| &layout.blocks[block]) {
        for column in ["x", "y", "phi", "vx", "vy", "omega"] {
            header.push_str(&format!(",{}.{column}", block.name));
        }
    }
    for (number, beam) in layout.beams.iter().enumerate() {
        header.push_str(&format!(",{0}.w_mid,{0}.v_mid", beam.name));
        sections.push_header(number, &mut header);
    }
    driven.iter().for_each(|driven| driven.push_header(&mut header));
    header.push('\n');
    header
}
