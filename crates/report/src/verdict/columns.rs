//! Blocks that stand on each other and rock as one, or did before they stood still or trembled: on the base of the lowest, with the critical angle of all of them together.

use super::{BodyVerdict, Fate, Fates, ROCKED, SLID, Seen, Watch, Watched, Way};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use teeter_integrator::State;
use teeter_scenario::scene::{Scene, SupportingBody};
use teeter_scenario::simulation::Layout;

/// Blocks rock as one if the joints between them never opened by more than this part of the angle to which they turned; of those that stand by now not
/// when they were turned the farthest.
const AS_ONE: f64 = 0.02;

/// Whether the joints between blocks are to have stayed closed so far, by the largest turns, or to be closed now.
#[derive(Clone, Copy, PartialEq, Eq)]
enum AsOne {
    SoFar,
    Now,
}

/// The column with which a block has turned as one so far, or did until they were past their point of no return.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Column {
    /// The lowest of its blocks.
    root: usize,
    /// The points of no return of all of them together, to the right and to the left, absolute, rad.
    pub(super) tops: [f64; 2],
    /// By how much the block is turned against the lowest, rad.
    ahead: f64,
    /// The angle of the block at the end of the last step, rad.
    angle: f64,
    /// Since when they are past one of them.
    pub(super) beyond: Option<Beyond>,
}

/// A column past its point of no return.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Beyond {
    /// Since when, s.
    pub(super) since: f64,
    /// To which side.
    pub(super) way: Way,
    /// 2 M g R over the moment of inertia about the foot, 1/s²: what turns inwards faster than the root of this times 1 − cos of the way to
    /// the point of no return comes back over it.
    pull: f64,
}

/// How the lowest of a stack is turned against the common point of no return of a part of the stack, from it up to a block.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Lean {
    /// By how much it is past it, rad; negative if it isn't.
    past: f64,
    /// To the side to which it is nearer to it, or past it.
    way: Way,
    /// Since when it is past it, if it is, s.
    since: f64,
    /// The lowest.
    root: usize,
}

impl Column {
    /// By how much a block at an angle (rad) is past the point of no return to a side, rad.
    fn past(&self, angle: f64, way: Way) -> f64 {
        way.sign() * (angle - self.ahead - if way == Way::Left { self.tops[1] } else { self.tops[0] })
    }

    /// Since when and to which side it has overturned with its column, of a block with this spin (rad/s): past the point of no return it stays there if it
    /// rests or hasn't the energy to come back.
    pub(super) fn overturned(&self, spin: f64, rests: bool) -> Option<(f64, Way)> {
        let Beyond { since, way, pull } = self.beyond?;
        let inwards = -way.sign() * spin;
        let comes_back = inwards > 0.0 && inwards * inwards > pull * (1.0 - self.past(self.angle, way).cos());
        (rests || !comes_back).then_some((since, way))
    }
}

/// The block that stands on each, if it is the only one.
pub(super) fn above(on: impl Iterator<Item = Option<SupportingBody>>) -> Vec<Option<usize>> {
    let on: Vec<_> = on.collect();
    let mut above = vec![(0_usize, None); on.len()];
    for (number, on) in on.iter().enumerate() {
        if let Some(SupportingBody::Block(below)) = on {
            above[*below] = (above[*below].0 + 1, Some(number));
        }
    }
    above.into_iter().map(|(count, last)| last.filter(|_| count == 1)).collect()
}

impl Fates {
    /// Looks at the end of a step that began at `before` (s) which blocks have turned as one so far, and whether they are past their point of no return.
    pub(super) fn look_at_columns(&mut self, watch: &Watch, layout: &Layout, before: f64, state: &State) {
        if watch.above.iter().all(Option::is_none) {
            return;
        }
        let angle = |number: usize| state.q[layout.blocks[number].range.start + 2];
        for (number, seen) in self.blocks.iter_mut().enumerate() {
            let Some(column) = &mut seen.column else { continue };
            let is_back = |beyond: Beyond| column.past(angle(number), beyond.way) <= 0.0;
            if column.beyond.is_none_or(is_back) {
                column.beyond = None;
            } else {
                column.angle = angle(number);
            }
        }
        let is_on_single = |number: usize| matches!(watch.blocks[number].on, Some(SupportingBody::Block(below)) if watch.above[below] == Some(number) && !watch.blocks[below].driven);
        for lowest in (0..watch.blocks.len()).filter(|number| !is_on_single(*number)) {
            self.look_at_leans(watch, layout, (before, lowest), state);
            let mut next = Some(lowest);
            while let Some(root) = next {
                let [group, now] =
                    [AsOne::SoFar, AsOne::Now].map(|when| self.group(watch, layout, root, (when, state)));
                next = watch.above[group[group.len() - 1]];
                self.enter_column(watch, layout, (before, &group), (AsOne::SoFar, state));
                if now.len() > group.len() {
                    self.enter_column(watch, layout, (before, &now), (AsOne::Now, state));
                }
            }
        }
    }

    /// Looks since when the lowest of a stack is turned past the common points of no return of its parts, from it up to each of its other blocks, whether
    /// they turn as one or not.
    fn look_at_leans(&mut self, watch: &Watch, layout: &Layout, (before, root): (f64, usize), state: &State) {
        if watch.above[root].is_none() {
            return;
        }
        let mut part = Weight::default();
        for top in std::iter::successors(Some(root), |below| watch.above[*below]) {
            part.add(&watch.blocks[top], layout, top, state);
            if top != root {
                self.look_at_lean(watch, layout, before, (root, top, part), state);
            }
        }
    }

    fn look_at_lean(
        &mut self,
        watch: &Watch,
        layout: &Layout,
        before: f64,
        (root, top, part): (usize, usize, Weight),
        state: &State,
    ) {
        let lean = &mut self.blocks[top].lean;
        let Some([left, right]) = part.edges(&watch.blocks[root], layout, root, state) else { return };
        let level = watch.blocks[root].outline.as_ref().map_or(0.0, |of| of.level());
        let angle = state.q[layout.blocks[root].range.start + 2];
        let past = [(angle - left - level, Way::Left), (right + level - angle, Way::Right)];
        let (past, way) = if past[0].0 > past[1].0 { past[0] } else { past[1] };
        let since = match lean.filter(|lean| lean.way == way) {
            Some(lean) if lean.past < 0.0 && past > 0.0 => passed_at([before, state.t], [lean.past, past]),
            Some(lean) if lean.past > 0.0 => lean.since,
            _ => before,
        };
        *lean = Some(Lean { past, way, since, root });
    }

    /// The blocks that turn as one with the lowest of them, that first.
    fn group(&self, watch: &Watch, layout: &Layout, root: usize, (when, state): (AsOne, &State)) -> Vec<usize> {
        let is_as_one = |number: &usize| self.is_as_one(watch, layout, [*number, root], (when, state));
        let above = |below: &usize| watch.above[*below].filter(is_as_one);
        std::iter::successors(Some(root), above).collect()
    }

    /// Whether a block only turns with the one below it, as seen from the lowest of them, and stays in its place.
    fn is_as_one(
        &self,
        watch: &Watch,
        layout: &Layout,
        [number, root]: [usize; 2],
        (when, state): (AsOne, &State),
    ) -> bool {
        let turn = |number: usize| match when {
            AsOne::SoFar => self.blocks[number].turned.into_iter().fold(0.0, f64::max),
            AsOne::Now => self.blocks[number].tilt.rocking().abs(),
        };
        let (seen, watched) = (&self.blocks[number], &watch.blocks[number]);
        let least = SLID * watched.base();
        // Hops and flights take it aside, too.
        let is_there = || {
            let moved = seen.stood.zip(watched.place(layout, number, state)).map(|(from, to)| to - from);
            moved.is_none_or(|moved| moved.abs() < least)
        };
        let together = !watch.blocks[root].driven && turn(number) <= AS_ONE * turn(root);
        together && seen.slides.most() < least && is_there()
    }

    /// Takes in blocks that turn as one, the lowest first; those that do so only now if they are past their point of no return.
    fn enter_column(
        &mut self,
        watch: &Watch,
        layout: &Layout,
        (before, group): (f64, &[usize]),
        (when, state): (AsOne, &State),
    ) {
        let root = group[0];
        let angle = |number: usize| state.q[layout.blocks[number].range.start + 2];
        let (blocks, level) = (&watch.blocks, watch.blocks[root].outline.as_ref().map_or(0.0, |of| of.level()));
        let edges = edges(blocks, layout, state, group, root).filter(|[left, right]| {
            let slope = blocks[root].slope(&state.q);
            let room = |edge: f64| edge - slope;
            let [to_left, to_right] = self.blocks[root].turned;
            let (left, right) = (room(*left), -room(*right));
            group.len() > 1 && left > 0.0 && right > 0.0 && (to_left / left).max(to_right / right) >= ROCKED
        });
        let earlier = self.blocks[root].column;
        let lean = self.blocks[group[group.len() - 1]].lean.filter(|lean| lean.root == root && lean.past > 0.0);
        for number in group {
            let known = &mut self.blocks[*number].column;
            let now = edges.map(|[left, right]| {
                let tops = [right + level, left + level];
                let ahead = angle(*number) - angle(root);
                let mut column = Column { root, tops, ahead, angle: angle(*number), beyond: None };
                let way = if angle(root) > tops[1] { Way::Left } else { Way::Right };
                let past = column.past(angle(*number), way);
                if past > 0.0 {
                    // As the lowest of them passed it.
                    let from = earlier.map_or(0.0, |earlier| column.past(earlier.angle + ahead, way));
                    // Where joints opened on the way it is a column again by now, but was past it before.
                    let whole = lean.filter(|lean| lean.way == way);
                    let since = match from < 0.0 {
                        true => passed_at([before, state.t], [from, past]),
                        false => whole.map_or(before, |lean| lean.since),
                    };
                    column.beyond = Some(Beyond { since, way, pull: pull(blocks, layout, state, group, way) });
                }
                column
            });
            // What passed it together is past it, whether it stays together or not; unless it did so as a part of what had passed its own before.
            let since = |column: &Option<Column>| column.and_then(|column| column.beyond).map(|beyond| beyond.since);
            let is_new = since(known).is_none_or(|known| since(&now).is_some_and(|now| now < known));
            if is_new && (when == AsOne::SoFar || since(&now).is_some()) {
                *known = now;
            }
        }
    }
}

/// When something that was `past` a point by less than nothing and then by more passed it, in a straight line between two times, s.
fn passed_at([before, after]: [f64; 2], [from, past]: [f64; 2]) -> f64 {
    before + from / (from - past) * (after - before)
}

/// [`Beyond::pull`] of blocks, the lowest first, that turn about the foot of that on a side.
fn pull(watched: &[Watched], layout: &Layout, state: &State, group: &[usize], way: Way) -> f64 {
    let place = |number: usize| &state.q[layout.blocks[number].range.clone()];
    let Some([left, right]) = watched[group[0]].feet else { return 0.0 };
    let own = place(group[0]);
    let (sin, cos) = own[2].sin_cos();
    let [x, y] = if way == Way::Left { left } else { right };
    let foot = [own[0] + cos * x - sin * y, own[1] + sin * x + cos * y];
    let (mut moment, mut inertia) = ([0.0; 2], 0.0);
    for number in group {
        let Watched { mass, inertia: about_centre, .. } = watched[*number];
        let arm = [0, 1].map(|k| place(*number)[k] - foot[k]);
        moment = [0, 1].map(|k| moment[k] + mass * arm[k]);
        inertia += about_centre + mass * (arm[0] * arm[0] + arm[1] * arm[1]);
    }
    2.0 * watched[group[0]].gravity * moment[0].hypot(moment[1]) / inertia
}

/// Says of blocks that overturned as one with which they did: the lowest of them. Of a column whose lower blocks came back those above that
/// still turn as one.
fn find_overturned(
    watched: &[Watched],
    places: &[Option<usize>],
    seen: &[Seen],
    layout: &Layout,
    verdict: &mut [BodyVerdict],
) {
    let mut columns: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (number, (of, seen)) in places.iter().zip(seen).enumerate() {
        let overturned = of.is_some_and(|of| verdict[of].what == Fate::Overturned);
        if let Some(column) = seen.column.filter(|column| overturned && column.beyond.is_some()) {
            columns.entry(column.root).or_default().push(number);
        }
    }
    for (root, column) in columns.into_iter().filter(|(_, column)| column.len() > 1) {
        let is_on_another = |number: &usize| matches!(watched[*number].on, Some(SupportingBody::Block(below)) if column.contains(&below));
        let lowest: Vec<usize> = match column.contains(&root) {
            true => vec![root],
            false => column.iter().copied().filter(|number| !is_on_another(number)).collect(),
        };
        let [lowest] = lowest[..] else { continue };
        let apart = |number: &usize| (seen[*number].angle - seen[lowest].angle).abs();
        if lowest != root && column.iter().any(|number| apart(number) > AS_ONE * seen[lowest].angle.abs()) {
            continue;
        }
        for of in column.iter().filter_map(|number| places[*number]) {
            verdict[of].overturned_with = Some(layout.blocks[lowest].name.clone());
        }
    }
}

/// Says of each block that rocks, or rocked before it stood, on another one without turning relative to it with which it does, and of the lowest how far all of them together are from
/// overturning.
pub(super) fn find(
    watched: &[Watched],
    seen: &[Seen],
    scene: &Scene,
    layout: &Layout,
    state: &State,
    verdict: &mut [BodyVerdict],
) {
    // Verdicts are of the blocks that aren't driven, in their order.
    let mut told = 0..verdict.len();
    let places: Vec<Option<usize>> = watched.iter().map(|of| if of.driven { None } else { told.next() }).collect();
    find_overturned(watched, &places, seen, layout, verdict);
    let rocks = |number: usize, verdict: &[BodyVerdict]| {
        places[number].filter(|of| match verdict[*of].what {
            Fate::Rocks => verdict[*of].tips.is_none(),
            _ => verdict[*of].stays(),
        })
    };
    // The angle to which a block of which φ/α is known has turned, rad.
    let turned = |number: usize, part: Option<f64>| Some(part? * scene.blocks[number].critical_angle()?);
    let lowest_below = |number: usize| {
        let mut block = number;
        // At most as many storeys as there are blocks.
        for _ in 0..watched.len() {
            let Some(SupportingBody::Block(below)) = watched[block].on else { break };
            let (Some(of), Some(foot)) = (rocks(block, verdict), rocks(below, verdict)) else { break };
            let rocks_on = verdict[of].what == Fate::Rocks;
            if rocks_on != (verdict[foot].what == Fate::Rocks) {
                break;
            }
            let [turned, beneath] =
                [(block, of), (below, foot)].map(|(block, of)| turned(block, verdict[of].max_phi_over_alpha));
            let Some((turned, beneath)) = turned.zip(beneath) else { break };
            let opened = match rocks_on {
                // While the last small swings die out the joints open one by one: its largest swing tells how it rocked.
                false => seen[block].joint.max((turned - beneath).abs()),
                true => seen[block].turned[0].max(seen[block].turned[1]),
            };
            if watched[below].driven || opened > AS_ONE * turned {
                break;
            }
            block = below;
        }
        block
    };
    let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for number in 0..watched.len() {
        groups.entry(lowest_below(number)).or_default().push(number);
    }
    for (root, group) in groups.into_iter().filter(|(_, group)| group.len() > 1) {
        let stays =
            |number: usize| rocks(number, verdict).is_some_and(|of| keeps_its_place(&watched[number], &verdict[of]));
        let above = |below: usize| {
            group.iter().filter(|number| watched[**number].on == Some(SupportingBody::Block(below))).count()
        };
        let in_column = group.iter().all(|number| above(*number) <= 1)
            && group.iter().all(|number| *number == root || stays(*number));
        let Some(base) = rocks(root, verdict) else { continue };
        let column = critical_angles(watched, layout, state, &group, root).filter(|_| in_column).map(|alpha| {
            let parts = seen[root].turned.into_iter().zip(alpha).filter(|(_, alpha)| *alpha > 0.0);
            parts.fold(0.0, |most: f64, (turned, alpha)| most.max(turned / alpha))
        });
        // What stands by now rocked if the column as a whole did; drums that are much wider than it is hardly turned.
        if verdict[base].what != Fate::Rocks && column.is_none_or(|part| part < ROCKED) {
            continue;
        }
        for number in group.iter().filter(|number| **number != root) {
            if let Some(of) = rocks(*number, verdict) {
                verdict[of].turns_with = Some(layout.blocks[root].name.clone());
                verdict[of].in_column = in_column;
            }
        }
        verdict[base].column = column;
    }
}

/// Whether a block never slid along what carries it by as much as is told, and no hop took it aside by that.
fn keeps_its_place(of: &Watched, verdict: &BodyVerdict) -> bool {
    let is_less = |way: f64| way.abs() < SLID * of.base();
    verdict.farthest.is_none() && verdict.slid.is_some_and(is_less) && verdict.displaced.is_none_or(is_less)
}

/// The angles by which blocks turn about the left and the right foot of the lowest until their common mass centre is over it, rad.
fn critical_angles(
    watched: &[Watched],
    layout: &Layout,
    state: &State,
    group: &[usize],
    root: usize,
) -> Option<[f64; 2]> {
    let slope = watched[root].slope(&state.q);
    edges(watched, layout, state, group, root).map(|[left, right]| [left - slope, slope - right])
}

/// The angles of the lowest of some blocks at which their common mass centre is over its left and its right foot, against the level of gravity, rad.
fn edges(watched: &[Watched], layout: &Layout, state: &State, group: &[usize], root: usize) -> Option<[f64; 2]> {
    let mut all = Weight::default();
    group.iter().for_each(|number| all.add(&watched[*number], layout, *number, state));
    all.edges(&watched[root], layout, root, state)
}

/// Some blocks together: their mass, kg, and its moment about the origin, kg m.
#[derive(Clone, Copy, Debug, Default)]
struct Weight {
    mass: f64,
    moment: [f64; 2],
}

impl Weight {
    fn add(&mut self, watched: &Watched, layout: &Layout, number: usize, state: &State) {
        let at = &state.q[layout.blocks[number].range.clone()];
        self.mass += watched.mass;
        self.moment = [0, 1].map(|k| self.moment[k] + watched.mass * at[k]);
    }

    /// The [`edges`] of the blocks, of which this is the lowest.
    fn edges(&self, lowest: &Watched, layout: &Layout, number: usize, state: &State) -> Option<[f64; 2]> {
        let (own, feet) = (&state.q[layout.blocks[number].range.clone()], lowest.feet?);
        let (sin, cos) = own[2].sin_cos();
        let [dx, dy] = [0, 1].map(|k| self.moment[k] / self.mass - own[k]);
        let [x, y] = [cos * dx + sin * dy, cos * dy - sin * dx];
        Some(feet.map(|foot| (x - foot[0]).atan2(y - foot[1])))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use teeter_scenario::simulation::Simulation;

    /// Three stones on each other, at the start of a run, with what is known of them then.
    fn stack() -> (Scene, Layout, State, Fates) {
        let text = "[time]\nend = '1 s'\nstep = '1 ms'\n[ground]\n[block.b]\ndensity = '2400 kg/m^3'\nwidth = '20 cm'\nheight = '30 cm'\n\
            depth = '10 cm'\non = 'ground'\nat = '0 m'\nrepeat = { count = 3, stacked = true }\n[contact.c]\nbetween = ['*', 'ground']\n\
            friction = 0.5\n[contact.d]\nbetween = ['*', '*']\nfriction = 0.5\n";
        let scene = teeter_scenario::load(text.as_bytes(), "f", "f", &[]).unwrap().scene;
        let Simulation { layout, state, model, .. } = Simulation::new(&scene).unwrap();
        let mut fates = Fates::default();
        fates.start(&Watch::of(&scene, &layout), &layout, &model, &state).unwrap();
        (scene, layout, state, fates)
    }

    #[test]
    fn what_hopped_aside_turns_with_its_column_no_more() {
        let (scene, layout, mut state, mut fates) = stack();
        let watch = Watch::of(&scene, &layout);
        fates.blocks[0].turned = [0.05, 0.0];
        assert_eq!(fates.group(&watch, &layout, 0, (AsOne::SoFar, &state)), [0, 1, 2]);
        state.q[layout.blocks[2].range.start] += 0.02;
        assert_eq!(fates.group(&watch, &layout, 0, (AsOne::SoFar, &state)), [0, 1]);
    }

    #[test]
    fn what_slid_or_hopped_by_a_hundredth_of_its_base_kept_no_place() {
        let (scene, layout, state, fates) = stack();
        let mut watch = Watch::of(&scene, &layout);
        let [_, _, mut of] = fates.verdict(&scene, &layout, &state, &[]).try_into().unwrap();
        for (slid, displaced, keeps) in
            [(0.001, 0.001, true), (-0.003, 0.0, false), (0.001, 0.02, false), (0.0, -0.003, false)]
        {
            (of.slid, of.displaced) = (Some(slid), Some(displaced));
            assert_eq!(keeps_its_place(&watch.blocks[2], &of), keeps, "{slid} {displaced}");
        }
        // Of what has no base nothing is told to have slid, here as elsewhere.
        watch.blocks[2].feet = None;
        assert!(keeps_its_place(&watch.blocks[2], &of));
    }

    /// All three passed their point of no return together, and the lowest came back from it.
    #[test]
    fn what_goes_on_above_a_block_that_came_back_overturns_as_one() {
        let (scene, layout, mut state, mut fates) = stack();
        for (turned, with) in [([0.4, 0.4], Some("b-2")), ([0.4, 0.5], None)] {
            for (number, angle) in [1, 2].into_iter().zip(turned) {
                let beyond = Some(Beyond { since: 0.0, way: Way::Left, pull: 1.0 });
                let column = Column { root: 0, tops: [-0.2, 0.2], ahead: 0.0, angle, beyond };
                (fates.blocks[number].column, fates.blocks[number].angle) = (Some(column), angle);
            }
            state.t = 1.0;
            let verdict = fates.verdict(&scene, &layout, &state, &[]);
            let found: Vec<_> = verdict.iter().map(|of| of.overturned_with.as_deref()).collect();
            assert_eq!(found, [None, with, with]);
        }
    }

    /// The weight of a part of a stack, one block after the other, is that of all of them at once.
    #[test]
    fn parts_of_a_stack_lean_as_their_blocks_together() {
        let (scene, layout, mut state, mut fates) = stack();
        let watch = Watch::of(&scene, &layout);
        for (number, by) in [(1, 0.03), (2, 0.09)] {
            state.q[layout.blocks[number].range.start] += by;
        }
        fates.look_at_leans(&watch, &layout, (0.0, 0), &state);
        // To the right by 3 cm, and by 4 cm, the mean of 0, 3 and 9 cm; 45 cm and 30 cm high.
        for (top, [x, y]) in [(1, [0.015, 0.3]), (2, [0.04, 0.45])] {
            let past = fates.blocks[top].lean.unwrap().past;
            assert!((past + (0.1_f64 - x).atan2(y)).abs() < 1e-12, "{top}: {past}");
        }
    }
}
