//! When what beams carry is jolted: forces change at once then, and a mean that reached across would change before.

use super::recorder::{PARTS, PageRecorder};
use teeter_scenario::scene::{History, LoadKind, LoadScene};

/// The times of jolts.
#[derive(Debug, Clone, Default)]
pub(super) struct Jolts {
    /// s, in ascending order.
    pub(super) times: Vec<f64>,
    /// What they are.
    pub(super) what: &'static str,
}

/// Most jumps of a load that are looked for.
const MOST_JUMPS: usize = 200;

/// A load jumps where it changes by more than this part of itself.
const JUMP: f64 = 0.1;

impl Jolts {
    pub(super) fn of(recorder: &PageRecorder) -> Self {
        let (impacts, loads) = (impacts(recorder), loads(recorder));
        let what = match (impacts.is_empty(), loads.is_empty()) {
            (false, false) => "impacts or jumps of loads",
            (true, false) => "jumps of loads",
            _ => "impacts",
        };
        let mut times = [impacts, loads].concat();
        times.sort_by(f64::total_cmp);
        Self { times, what }
    }

    /// The same for transverse forces at these places of beams (number, m), which jump where a moving load passes.
    pub(super) fn with_passages(&self, recorder: &PageRecorder, places: impl Iterator<Item = (usize, f64)>) -> Self {
        let passed = |(beam, x): (usize, f64)| {
            let loads = recorder.scenery.loads.iter().filter(move |load| load.beam == beam);
            loads.filter_map(move |load| passage(load, x))
        };
        let passages = places.flat_map(passed).filter(|t| *t > 0.0 && *t < recorder.end);
        let mut times: Vec<f64> = self.times.iter().copied().chain(passages).collect();
        times.sort_by(f64::total_cmp);
        let what = match self.what {
            _ if times.len() == self.times.len() => self.what,
            "impacts" if self.times.is_empty() => "passages of loads",
            "jumps of loads" => "jumps or passages of loads",
            _ => "impacts, jumps or passages of loads",
        };
        Self { times, what }
    }
}

/// Each impact, and of those after the last one that is kept the beginning of each part of the run that has some.
fn impacts(recorder: &PageRecorder) -> Vec<f64> {
    let rings = |pair: usize| recorder.scenery.contacts.get(pair).is_some_and(|contact| contact.rings);
    let (kept, end) = (&recorder.kept, recorder.end);
    let known = kept.impacts.iter().filter(|impact| rings(impact.contact)).map(|impact| impact.t);
    let are_all_known = kept.impact_count <= kept.impacts.len() as u64;
    let known_until = if are_all_known { end } else { kept.impacts.last().map_or(0.0, |last| last.t) };
    let has_some = |part: &usize| kept.density.iter().any(|(pair, counts)| counts[*part] > 0 && rings(*pair));
    let begin = |part: usize| part as f64 * end / PARTS as f64;
    let later = (0..PARTS).filter(|part| begin(*part) >= known_until).filter(has_some).map(begin);
    known.chain(later).collect()
}

/// Where loads jump within the run, or come onto a beam, or leave it.
fn loads(recorder: &PageRecorder) -> Vec<f64> {
    let scenery = &recorder.scenery;
    // Forces on blocks that no beam carries shake none.
    let on_beams = |block: usize| {
        scenery.contacts.iter().any(|contact| contact.rings && (contact.block == block || contact.other == Some(block)))
    };
    let forces = scenery.forces.iter().filter(|force| on_beams(force.block)).map(|force| &force.history);
    let histories = forces.chain(scenery.loads.iter().map(|load| &load.history));
    let ends = scenery.loads.iter().flat_map(|load| [0.0, scenery.beams[load.beam].span].map(|end| passage(load, end)));
    let times = histories.flat_map(|history| jumps(history, recorder.end)).chain(ends.flatten());
    times.filter(|t| *t > 0.0 && *t < recorder.end).collect()
}

/// When a load that moves passes a place of its beam (m), s.
fn passage(load: &LoadScene, x: f64) -> Option<f64> {
    match load.kind {
        LoadKind::Moving { at, speed, .. } if speed != 0.0 => Some((x - at) / speed),
        _ => None,
    }
}

fn jumps(history: &History, end: f64) -> Vec<f64> {
    let signal = history.signal();
    let next = |t: &f64| Some(signal.next_break(*t)).filter(|next| next > t && *next < end);
    let breaks = std::iter::successors(next(&0.0), next).take(MOST_JUMPS);
    let jumps = |t: &f64| {
        let [before, after] = [-1e-9, 1e-9].map(|part| signal.value(t + part * end));
        (after - before).abs() > JUMP * before.abs().max(after.abs())
    };
    breaks.filter(jumps).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use teeter_scenario::simulation::Simulation;

    #[test]
    fn a_load_jolts_a_beam_where_it_comes_leaves_and_jumps() {
        let text = "[time]\nend = '2 s'\nstep = '1 ms'\n[material.steel]\ndensity = '7850 kg/m^3'\nyoungs_modulus = '210 GPa'\n\
            [beam.deck]\nmaterial = 'steel'\nspan = '3 m'\nwidth = '10 cm'\nthickness = '2 cm'\nelements = 6\n\
            [load.cart]\non = 'deck'\nat = '-1 m'\nforce = '-1 kN'\nspeed = '4 m/s'\n\
            [load.stone]\non = 'deck'\nat = '1 m'\nforce = '-1 kN'\nsignal = 'put'\n[signal.put]\nshape = 'constant'\nstart = '1.5 s'\n";
        let resolved = teeter_scenario::load(text.as_bytes(), "loads", "loads", &[]).unwrap();
        let simulation = Simulation::new(&resolved.scene).unwrap();
        let jolts = Jolts::of(&PageRecorder::new(&resolved.scene, &simulation.layout));
        assert_eq!((jolts.times.as_slice(), jolts.what), (&[0.25, 1.0, 1.5][..], "jumps of loads"));
    }

    #[test]
    fn a_load_that_passes_a_place_is_a_jolt_of_the_transverse_force_there() {
        let text = "[time]\nend = '2 s'\nstep = '1 ms'\n[material.steel]\ndensity = '7850 kg/m^3'\nyoungs_modulus = '210 GPa'\n\
            [beam.deck]\nmaterial = 'steel'\nspan = '3 m'\nwidth = '10 cm'\nthickness = '2 cm'\nelements = 6\n\
            [load.cart]\non = 'deck'\nat = '-1 m'\nforce = '-1 kN'\nspeed = '4 m/s'\n\
            [load.back]\non = 'deck'\nat = '3 m'\nforce = '-1 kN'\nspeed = '-2 m/s'\n";
        let resolved = teeter_scenario::load(text.as_bytes(), "loads", "loads", &[]).unwrap();
        let simulation = Simulation::new(&resolved.scene).unwrap();
        let recorder = PageRecorder::new(&resolved.scene, &simulation.layout);
        let jolts = Jolts::of(&recorder);
        assert_eq!(jolts.times, [0.25, 1.0, 1.5]);
        let passed = jolts.with_passages(&recorder, [(0, 1.0)].into_iter());
        assert_eq!(
            (passed.times.as_slice(), passed.what),
            (&[0.25, 0.5, 1.0, 1.0, 1.5][..], "jumps or passages of loads")
        );
        assert_eq!(jolts.with_passages(&recorder, [(1, 1.0)].into_iter()).times, jolts.times);
    }
}
