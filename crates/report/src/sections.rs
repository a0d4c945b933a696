//! What beams bear, for those of the scene that ask for it: columns of `trajectory.csv`, extremes over all steps, `envelopes.csv`, the warning
//! that a beam yields.

use crate::WarningLog;
use crate::first;
use crate::number::{push, push_next};
use crate::own_weight;
use crate::{YIELD, with_digits, with_unit};
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use teeter_beam::{Actions, Beam, Envelope, PeakStress, SectionForces};
use teeter_integrator::{BeamForces, State, StepReport};
use teeter_scenario::scene::{BeamQuantity, BeamScene, LoadKind, Scene};
use teeter_scenario::simulation::{BeamPlace, Layout};

/// What a column of a beam holds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Kind {
    Deflection,
    Moment,
    Shear,
    Stress,
    AxialForce,
    Reaction,
    ReactionCouple,
}

/// A column of a beam in `trajectory.csv`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Column {
    /// The beam's number.
    pub(crate) beam: usize,
    pub(crate) kind: Kind,
    /// Where, m from the left end; not of an axial force.
    pub(crate) x: Option<f64>,
    /// The column's name.
    pub(crate) name: String,
}

/// The columns of a beam's record, in order.
pub(crate) fn columns_of(number: usize, of: &BeamScene, place: &BeamPlace) -> Vec<Column> {
    let column = |kind: Kind, word: &str, x: Option<f64>| {
        let name = x.map_or_else(|| format!("{}.{word}", place.name), |x| format!("{}.{word}@{x}", place.name));
        Column { beam: number, kind, x, name }
    };
    let mut columns = Vec::new();
    for quantity in &of.output.quantities {
        let kind = match quantity {
            BeamQuantity::Moment => Kind::Moment,
            BeamQuantity::Shear => Kind::Shear,
            BeamQuantity::Stress => Kind::Stress,
            BeamQuantity::AxialForce => {
                columns.push(column(Kind::AxialForce, quantity.word(), None));
                continue;
            }
            _ => Kind::Deflection,
        };
        columns.extend(place.probes.iter().map(|x| column(kind, quantity.word(), Some(*x))));
    }
    if of.output.reactions {
        for x in supports(&place.beam) {
            columns.push(column(Kind::Reaction, "reaction", Some(x)));
            columns.push(column(Kind::ReactionCouple, "reaction_couple", Some(x)));
        }
    }
    columns
}

/// Where a beam is supported, m.
fn supports(beam: &Beam) -> Vec<f64> {
    let q = vec![0.0; beam.dofs()];
    // A vector as long as it must be has forces.
    let forces = beam.section_forces(&Actions::at(&q));
    forces.map(|forces| forces.reactions().iter().map(|r| as_given(beam, r.x)).collect()).unwrap_or_default()
}

/// A support's place as the scene has it, 0.342 and not 0.34199999999999997 as the mesh may: names of columns hang on it.
fn as_given(beam: &Beam, x: f64) -> f64 {
    let span = beam.spec().span;
    let given = beam.spec().inner_supports.iter().map(|inner| inner.x).chain([0.0, span]);
    given.into_iter().find(|place| (place - x).abs() <= 1e-9 * span).unwrap_or(x)
}

/// Where loads act that stay in their places, m from the left end of the beam.
fn fixed_loads(scene: &Scene, beam: &str) -> Vec<f64> {
    let own = scene.loads.iter().filter(|load| scene.beams[load.beam].name == beam);
    let fixed = own.filter_map(|load| match load.kind {
        LoadKind::Point { at, .. } => Some(at),
        _ => None,
    });
    fixed.collect()
}

/// The largest normal stress of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LargestStress {
    /// Pa.
    pub stress: f64,
    /// Where, m from the left end.
    pub x: f64,
    /// End of the step in which it was reached first, s.
    pub t: f64,
}

/// What a support bore: the force (N, upwards) and the couple (N·m, counter-clockwise) on the beam.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReactionRange {
    /// Where, m from the left end.
    pub x: f64,
    /// Force and couple at the start.
    pub start: [f64; 2],
    /// Least and largest force.
    pub force: [f64; 2],
    /// Least and largest couple.
    pub couple: [f64; 2],
}

/// What a beam bore in a run: its extremes over all steps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BeamRecord {
    /// The beam's name.
    pub beam: String,
    /// The largest stress; none where the section doesn't know its modulus.
    pub largest: Option<LargestStress>,
    /// The same with the beam's own weight, where the scene leaves that out and it is known what it does.
    #[serde(default)]
    pub largest_with_weight: Option<LargestStress>,
    /// The stresses at the times told of these two, Pa.
    #[serde(default)]
    pub first: [f64; 2],
    /// The supports, where the scene asks for reactions.
    pub reactions: Vec<ReactionRange>,
    /// Extremes by nodes, where the scene asks for them.
    #[serde(with = "kept_envelope")]
    pub envelope: Option<Envelope>,
}

/// The beam's layers know no files: an envelope in a checkpoint.
mod kept_envelope {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};
    use teeter_beam::{Envelope, EnvelopePlace};

    #[derive(Serialize, Deserialize)]
    struct Kept {
        deflection: Vec<[f64; 2]>,
        moment: Vec<[f64; 2]>,
        shear: Vec<[f64; 2]>,
        moment_ends: Vec<[[f64; 2]; 2]>,
        shear_ends: Vec<[[f64; 2]; 2]>,
        stress: Vec<f64>,
        places: Vec<KeptPlace>,
    }

    #[derive(Serialize, Deserialize)]
    struct KeptPlace {
        x: f64,
        deflection: [f64; 2],
        moment: [[f64; 2]; 2],
        shear: [[f64; 2]; 2],
        stress: f64,
    }

    pub(super) fn serialize<S: Serializer>(envelope: &Option<Envelope>, to: S) -> Result<S::Ok, S::Error> {
        let kept = envelope.clone().map(|envelope| Kept {
            deflection: envelope.deflection,
            moment: envelope.moment,
            shear: envelope.shear,
            moment_ends: envelope.moment_ends,
            shear_ends: envelope.shear_ends,
            stress: envelope.stress,
            places: envelope.places.into_iter().map(kept_place).collect(),
        });
        kept.serialize(to)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Option<Envelope>, D::Error> {
        let kept = Option::<Kept>::deserialize(from)?;
        Ok(kept.map(|kept| Envelope {
            deflection: kept.deflection,
            moment: kept.moment,
            shear: kept.shear,
            moment_ends: kept.moment_ends,
            shear_ends: kept.shear_ends,
            stress: kept.stress,
            places: kept.places.into_iter().map(place).collect(),
        }))
    }

    fn kept_place(of: EnvelopePlace) -> KeptPlace {
        let EnvelopePlace { x, deflection, moment, shear, stress } = of;
        KeptPlace { x, deflection, moment, shear, stress }
    }

    fn place(of: KeptPlace) -> EnvelopePlace {
        let KeptPlace { x, deflection, moment, shear, stress } = of;
        EnvelopePlace { x, deflection, moment, shear, stress }
    }
}

/// A beam whose section forces are looked at in every step.
struct Watched {
    forces: BeamForces,
    columns: Vec<Column>,
    /// Of its columns the first that is not a deflection's, among those of all beams.
    first: usize,
    yield_strength: Option<f64>,
    /// Whether gravity acts in the scene, but not on it; and the forces of its weight then, if they are known.
    is_without_weight: bool,
    own_weight: Option<SectionForces>,
}

/// The beams that ask for more than deflections, or whose material's yield strength is known.
pub(crate) struct Sections {
    watched: Vec<Watched>,
    columns: Vec<Vec<Column>>,
}

/// What a checkpoint has of it, beside the [`BeamRecord`]s: the values of the last step, of all columns but deflections.
pub(crate) type Values = Vec<f64>;

impl Sections {
    pub(crate) fn new(scene: &Scene, layout: &Layout) -> Self {
        let beams = || scene.beams.iter().zip(&layout.beams).enumerate();
        let columns: Vec<_> = beams().map(|(number, (of, place))| columns_of(number, of, place)).collect();
        let mut first = 0;
        let mut watched = Vec::new();
        for (number, (of, place)) in beams() {
            let columns: Vec<_> =
                columns[number].iter().filter(|column| column.kind != Kind::Deflection).cloned().collect();
            if of.output.needs_forces() || of.yield_strength.is_some() {
                let own = columns.len();
                let forces = layout.beam_forces(scene, number);
                watched.push(Watched {
                    forces,
                    columns,
                    first,
                    yield_strength: of.yield_strength,
                    is_without_weight: own_weight::is_left_out(scene, of),
                    own_weight: own_weight::left_out(scene, of, &place.beam),
                });
                first += own;
            }
        }
        Self { watched, columns }
    }

    /// The records and values to start with.
    pub(crate) fn empty(&self, scene: &Scene, layout: &Layout) -> (Vec<BeamRecord>, Values) {
        let asked = scene.beams.iter().zip(&layout.beams);
        let asked = asked.filter(|(of, _)| of.output.needs_forces() || of.yield_strength.is_some());
        let record = |(of, place): (&BeamScene, &BeamPlace)| BeamRecord {
            beam: place.name.clone(),
            largest: None,
            largest_with_weight: None,
            first: [0.0; 2],
            reactions: Vec::new(),
            envelope: of
                .output
                .envelope
                .then(|| Envelope::new(&place.beam).with_places(&place.beam, fixed_loads(scene, &place.name))),
        };
        let values = self.watched.iter().map(|watched| watched.columns.len()).sum();
        (asked.map(record).collect(), vec![f64::NAN; values])
    }

    /// The names of a beam's columns, each after a comma.
    pub(crate) fn push_header(&self, beam: usize, header: &mut String) {
        for column in &self.columns[beam] {
            header.push(',');
            header.push_str(&column.name);
        }
    }

    /// The values of a beam's columns, each after a comma; `values` are those of all beams' columns but deflections, of which those of
    /// the beams before have been taken.
    pub(crate) fn push_row<'v>(
        &self,
        beam: usize,
        place: &BeamPlace,
        q: &[f64],
        values: &mut impl Iterator<Item = &'v f64>,
        line: &mut String,
    ) {
        for column in &self.columns[beam] {
            match (column.kind, column.x) {
                (Kind::Deflection, Some(x)) => push_next(line, place.deflection(&place.beam.shape_clamped(x), q).w),
                _ => push_next(line, values.next().copied().unwrap_or(f64::NAN)),
            }
        }
    }

    /// Takes the start of the run, which belongs to the extremes, and warns of yielding.
    pub(crate) fn start(
        &mut self,
        layout: &Layout,
        state: &State,
        (records, values): (&mut [BeamRecord], &mut Values),
        warnings: &mut WarningLog,
    ) {
        let beams = self.watched.len().min(records.len());
        for beam in 0..beams {
            let (watched, record) = (&mut self.watched[beam], &mut records[beam]);
            let Some(place) = layout.beams.iter().find(|place| place.name == record.beam) else { continue };
            // An equilibrium is one at t = 0; a run that goes on from another's state is in motion.
            let pressed = place.pressed.as_deref().filter(|_| state.step == 0);
            let fine = watched.forces.start(state, pressed).is_ok();
            watched.fill(fine, values);
            if !fine {
                continue;
            }
            let forces = watched.forces.forces();
            if watched.columns.iter().any(|column| column.kind == Kind::Reaction) {
                let range = |x: f64| [x, x];
                record.reactions = forces
                    .reactions()
                    .iter()
                    .map(|r| ReactionRange {
                        x: as_given(watched.forces.beam(), r.x),
                        start: [r.force, r.couple],
                        force: range(r.force),
                        couple: range(r.couple),
                    })
                    .collect();
            }
            let both = (forces, watched.own_weight.as_ref());
            let stress = record.take(watched.forces.beam(), watched.forces.dofs(), both, state.t);
            self.warn_of_yielding(records, (beam, stress), "at the start", warnings);
        }
    }

    /// Takes a step in, and warns of yielding.
    pub(crate) fn observe(
        &mut self,
        step: &StepReport<'_, 2>,
        (records, values): (&mut [BeamRecord], &mut Values),
        warnings: &mut WarningLog,
    ) {
        let beams = self.watched.len().min(records.len());
        for beam in 0..beams {
            let (watched, record) = (&mut self.watched[beam], &mut records[beam]);
            // A motion that goes beyond all bounds is about to end the run: its forces are no numbers, and no reason to end it.
            let entered = watched.forces.enter_step(step).map(|forces| forces.is_some());
            if entered == Ok(false) {
                continue;
            }
            watched.fill(entered.is_ok(), values);
            if entered.is_err() {
                continue;
            }
            let forces = watched.forces.forces();
            let both = (forces, watched.own_weight.as_ref());
            let stress = record.take(watched.forces.beam(), watched.forces.dofs(), both, step.t_end);
            let step = format!("in the step to t = {}", with_digits(step.t_end, "s", 7));
            self.warn_of_yielding(records, (beam, stress), &step, warnings);
        }
    }

    /// Warns if the largest stress that a beam has now is above its yield strength; `when` says in words when that is.
    fn warn_of_yielding(
        &self,
        records: &[BeamRecord],
        (beam, stress): (usize, Option<LargestStress>),
        when: &str,
        warnings: &mut WarningLog,
    ) {
        let (watched, record) = (&self.watched[beam], &records[beam]);
        let (Some(now), Some(strength)) = (stress, watched.yield_strength) else { return };
        if now.stress <= strength {
            return;
        }
        // Of several beams the one that is furthest beyond its strength.
        let part = now.stress / strength;
        let most = self.watched.iter().zip(records).filter_map(|(of, record)| {
            Some((record.decisive()?, of.yield_strength?)).map(|(largest, strength)| largest.stress / strength)
        });
        let is_largest = !first::exceeds(most.fold(0.0, f64::max), part)
            && record.decisive().is_some_and(|largest| largest.t == now.t);
        warnings.enter_largest(YIELD, now.t, is_largest, || watched.yielding(&record.beam, now, (strength, when)));
    }
}

impl Watched {
    /// That a beam's stress passes its yield strength, Pa.
    fn yielding(
        &self,
        beam: &str,
        LargestStress { stress, x, .. }: LargestStress,
        (strength, when): (f64, &str),
    ) -> String {
        let weight = match (self.is_without_weight, &self.own_weight) {
            (false, _) => "",
            (true, Some(_)) => " with the beam's own weight, which `self_weight = false` leaves out of the run,",
            (true, None) => ", even without the beam's own weight,",
        };
        format!(
            "the stress in `{beam}`{weight} passes its yield strength: up to {} of {} at x = {}, {when}; the model \
             stays elastic",
            with_digits(stress, "Pa", 4),
            with_unit(strength, "Pa"),
            with_unit(x, "m")
        )
    }

    /// The values of the step entered last; NaN where it has none.
    fn fill(&self, fine: bool, values: &mut Values) {
        let (beam, forces) = (self.forces.beam(), self.forces.forces());
        let mut reactions = forces.reactions().iter();
        let mut couple = f64::NAN;
        for (column, value) in self.columns.iter().zip(&mut values[self.first..]) {
            let x = column.x.unwrap_or(0.5 * beam.spec().span);
            let at = || forces.at(beam, x).ok().filter(|_| fine);
            *value = match column.kind {
                Kind::Deflection => None,
                Kind::Moment => at().map(|force| force.moment),
                Kind::Shear => at().map(|force| force.shear),
                Kind::Stress => at().and_then(|force| forces.stress(beam, x, force.moment)),
                Kind::AxialForce => fine.then(|| forces.axial_force(beam, x)),
                Kind::Reaction => reactions.next().filter(|_| fine).map(|reaction| {
                    couple = reaction.couple;
                    reaction.force
                }),
                Kind::ReactionCouple => fine.then_some(couple),
            }
            .unwrap_or(f64::NAN);
        }
    }
}

impl BeamRecord {
    /// Takes the forces of a step in, and those of the beam's own weight where they are known beside them. Returns the largest stress of
    /// the step: of both together.
    fn take(
        &mut self,
        beam: &Arc<Beam>,
        q: &[f64],
        (forces, own_weight): (&SectionForces, Option<&SectionForces>),
        t: f64,
    ) -> Option<LargestStress> {
        if let Some(envelope) = &mut self.envelope {
            envelope.take(beam, q, forces);
        }
        let widen = |range: &mut [f64; 2], value: f64| *range = [range[0].min(value), range[1].max(value)];
        for (range, reaction) in self.reactions.iter_mut().zip(forces.reactions()) {
            widen(&mut range.force, reaction.force);
            widen(&mut range.couple, reaction.couple);
        }
        let Self { largest, largest_with_weight, first: [first, first_with_weight], .. } = self;
        let found = largest_of((largest, first), forces.largest_stress(beam), t);
        match own_weight {
            None => found,
            weight => {
                largest_of((largest_with_weight, first_with_weight), forces.largest_stress_beside(beam, weight), t)
            }
        }
    }

    /// The largest stress by which the beam is judged: with its own weight where that is known.
    pub(crate) fn decisive(&self) -> Option<LargestStress> {
        self.largest_with_weight.or(self.largest)
    }
}

/// Takes the largest stress of a step for that of the run if it is; with the stress at the time told of that, Pa.
fn largest_of(
    (largest, first): (&mut Option<LargestStress>, &mut f64),
    peak: Option<PeakStress>,
    t: f64,
) -> Option<LargestStress> {
    let found = peak.map(|PeakStress { x, stress, .. }| LargestStress { stress, x, t })?;
    let largest = largest.get_or_insert(found);
    if first::enter(found.stress, &mut largest.stress, first) {
        *largest = found;
    }
    Some(found)
}

pub(crate) const ENVELOPES_HEADER: &str = "beam,x,w_min,w_max,moment_min,moment_max,shear_min,shear_max,stress_max,\
    moment_left_min,moment_left_max,moment_right_min,moment_right_max,\
    shear_left_min,shear_left_max,shear_right_min,shear_right_max\n";

/// A row of `envelopes.csv`: extremes at a place, and of moment and transverse force just left and just right of it.
struct EnvelopeRow {
    x: f64,
    ranges: [[f64; 2]; 3],
    stress: f64,
    sides: [[Option<[f64; 2]>; 2]; 2],
}

impl EnvelopeRow {
    fn push(&self, beam: &str, text: &mut String) {
        text.push_str(beam);
        text.push(',');
        push(text, self.x);
        self.ranges.iter().flatten().for_each(|value| push_next(text, *value));
        if self.stress.is_nan() {
            text.push(',');
        } else {
            push_next(text, self.stress);
        }
        for side in self.sides.iter().flatten() {
            match side {
                Some(range) => range.iter().for_each(|value| push_next(text, *value)),
                None => text.push_str(",,"),
            }
        }
        text.push('\n');
    }
}

/// The text of `envelopes.csv`: the extremes over all steps by nodes and fixed loads between them, of the beams that ask for it; `None` where none does.
#[must_use]
pub fn envelopes(layout: &Layout, records: &[BeamRecord]) -> Option<String> {
    let mut text = ENVELOPES_HEADER.to_owned();
    let header = text.len();
    for record in records {
        let place = layout.beams.iter().find(|place| place.name == record.beam);
        let (Some(place), Some(envelope)) = (place, &record.envelope) else { continue };
        let ends = |ends: &[[[f64; 2]; 2]], node: usize| {
            // Just left of the node, in the element that ends there, and just right of it.
            [node.checked_sub(1).and_then(|e| ends.get(e)).map(|e| e[1]), ends.get(node).map(|e| e[0])]
        };
        let at_nodes = place.beam.node_positions().iter().enumerate().map(|(node, x)| EnvelopeRow {
            x: *x,
            ranges: [envelope.deflection[node], envelope.moment[node], envelope.shear[node]],
            stress: envelope.stress[node],
            sides: [ends(&envelope.moment_ends, node), ends(&envelope.shear_ends, node)],
        });
        let either = |[left, right]: [[f64; 2]; 2]| [left[0].min(right[0]), left[1].max(right[1])];
        let between = envelope.places.iter().map(|of| EnvelopeRow {
            x: of.x,
            ranges: [of.deflection, either(of.moment), either(of.shear)],
            stress: of.stress,
            sides: [of.moment.map(Some), of.shear.map(Some)],
        });
        let mut rows: Vec<EnvelopeRow> = at_nodes.chain(between).collect();
        rows.sort_by(|a, b| a.x.total_cmp(&b.x));
        rows.iter().for_each(|row| row.push(&record.beam, &mut text));
    }
    (text.len() > header).then_some(text)
}
