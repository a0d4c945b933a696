//! When blocks that fall come to lie on each other, and what a step costs then: an estimate before the run.

use crate::output_size::CONTACTS_OF_STONE;
use crate::scene::{BlockScene, Scene, mass_of};
use crate::simulation::Layout;

/// Part of a pile's area that its stones fill.
const FILLED: f64 = 0.8;

/// Time of a step for each stone of a pile and each layer of it, s, while it jams, to a tolerance of 1e-4, and once it lies: the
/// solver's iterations grow with the height of what lies on each other. Measured are, of 1000 stones in 14 layers, 90 ms a step
/// while they jam and 13 ms once they lie.
const JAMMING: f64 = 6e-6;
const LYING: f64 = 0.9e-6;

/// By so much a step takes longer, while a pile jams, from a tolerance of 1e-6 on: measured are 3.1 for 1e-6, 3.2 for 1e-10.
/// Stones that lie keep their impulses, to any tolerance.
const TIGHT: f64 = 3.0;

/// A pile jams until so many times the fall of its last block.
const JAMS_UNTIL: f64 = 1.3;

/// When the blocks of a scene come to lie on each other, and what a step costs then.
///
/// Each block falls freely from where it is to where it would lie if those below it filled the width over which all blocks are
/// spread. Walls of a trough and velocities at the start are left out.
#[derive(Debug, Clone, PartialEq)]
pub struct PileEstimate {
    /// When each block that moves lands, s after the state that was looked at; infinite without gravity.
    lands: Vec<f64>,
    /// Layers of blocks in the pile.
    layers: f64,
    /// Time of a step for each block and layer while it jams, s.
    jamming: f64,
}

impl PileEstimate {
    /// From the positions in the state's coordinates `q`.
    #[must_use]
    pub fn of(scene: &Scene, layout: &Layout, q: &[f64]) -> Self {
        let [gx, gy] = scene.gravity;
        let g = gx.hypot(gy);
        let up = if g > 0.0 { [-gx / g, -gy / g] } else { [0.0, 1.0] };
        let place = |k: usize| layout.blocks.get(k).and_then(|of| q.get(of.range.clone())).map(|q| [q[0], q[1]]);
        let placed = scene.blocks.iter().enumerate().filter_map(|(k, block)| Some((block, place(k)?)));
        let along = |[x, y]: [f64; 2]| [x * up[1] - y * up[0], x * up[0] + y * up[1]];
        // Size, and where it is: across gravity, and upwards.
        let all: Vec<(f64, [f64; 2], bool)> = placed
            .map(|(block, at)| (area(block).max(f64::MIN_POSITIVE).sqrt(), along(at), block.motion.is_whole()))
            .collect();
        let ground = scene.ground.as_ref().map(|ground| {
            let points =
                ground.profile.iter().flat_map(|profile| profile.points().map(|point| along([point.x, point.y])[1]));
            points.fold(f64::INFINITY, f64::min)
        });
        // Flat ground is at 0, if the blocks are above that.
        let ground = ground.map(|lowest| if lowest.is_finite() { lowest } else { 0.0 });
        let lowest = all.iter().map(|(size, [_, height], _)| height - 0.5 * size).fold(f64::INFINITY, f64::min);
        let base = ground.map_or(lowest, |ground| ground.min(lowest));
        let mut moving: Vec<(f64, [f64; 2])> =
            all.iter().filter(|(.., is_held)| !is_held).map(|(size, at, _)| (*size, *at)).collect();
        let ends = moving.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], (size, [x, _])| {
            [low.min(x - 0.5 * size), high.max(x + 0.5 * size)]
        });
        let width = FILLED * (ends[1] - ends[0]);
        moving.sort_by(|(_, [_, a]), (_, [_, b])| a.total_cmp(b));
        let mut filled = 0.0;
        let lands = moving
            .iter()
            .map(|(size, [_, height])| {
                let drop = (height - 0.5 * size - base - filled / width).max(0.0);
                filled += size * size;
                (2.0 * drop / g).sqrt()
            })
            .map(|t| if t.is_nan() { f64::INFINITY } else { t })
            .collect::<Vec<f64>>();
        let usual = (filled / lands.len().max(1) as f64).sqrt();
        let tightness = (0.5 * (1e-4 / scene.solver.tolerance).log10()).clamp(0.0, 1.0);
        let jamming = JAMMING * TIGHT.powf(tightness);
        Self { lands, layers: (filled / width / usual).max(1.0), jamming }
    }

    /// Time of a step while all blocks jam, and once all lie, s.
    #[must_use]
    pub fn steps(&self) -> [f64; 2] {
        [self.jamming, LYING].map(|each| each * self.layers * self.lands.len() as f64)
    }

    /// Time that contacts of the pile take in a run up to `end` by so long steps, s.
    #[must_use]
    pub fn seconds(&self, end: f64, step: f64) -> f64 {
        let calm = JAMS_UNTIL * self.landing(f64::INFINITY).unwrap_or(f64::INFINITY);
        let of_block = |lands: &f64| {
            let jams = (calm.min(end) - lands).max(0.0);
            let lies = (end - calm).max(0.0);
            self.jamming * jams + LYING * lies
        };
        self.layers * self.lands.iter().map(of_block).sum::<f64>() / step
    }

    /// When the last block lands, s; `None` if it does after `end`.
    #[must_use]
    pub fn landing(&self, end: f64) -> Option<f64> {
        Some(self.lands.iter().copied().fold(0.0, f64::max)).filter(|last| *last < end)
    }

    /// The mean part of the blocks that lie, over a run up to `end`, s.
    #[must_use]
    pub fn part_landed(&self, end: f64) -> f64 {
        if self.lands.is_empty() {
            return 0.0;
        }
        self.lands.iter().map(|t| (end - t).max(0.0)).sum::<f64>() / (end * self.lands.len() as f64)
    }

    /// Contacts at once, on average over a run up to `end`, s.
    #[must_use]
    pub fn contacts(&self, end: f64) -> usize {
        (CONTACTS_OF_STONE * self.part_landed(end) * self.lands.len() as f64) as usize
    }
}

/// The area of a block, m²; overlaps of its parts count for each.
fn area(block: &BlockScene) -> f64 {
    let of_part = |shape| mass_of(shape, 1.0, 1.0).map_or(0.0, |(mass, _)| mass.mass);
    match &block.parts {
        None => block.width * block.height,
        Some(parts) => parts.iter().map(|part| of_part(&part.shape)).sum(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulation::Simulation;

    /// Of so many blocks of 10 cm, 30 cm above each other, over flat ground.
    fn of_column(blocks: usize, more: &str) -> PileEstimate {
        let text = format!(
            "[time]\nend = '1 s'\nstep = '1 ms'\n{more}[ground]\n[block.b]\ndensity = '1000 kg/m^3'\nwidth = '10 cm'\nheight = '10 cm'\n\
             depth = '1 m'\nposition = ['0 m', '5 cm']\nrepeat = {{ count = {blocks}, shift = ['0 m', '30 cm'] }}\n\
             [contact.c]\nbetween = ['*', '*']\nfriction = 0.5\n"
        );
        let scene = crate::load(text.as_bytes(), "f", "f", &[]).unwrap().scene;
        let simulation = Simulation::new(&scene).unwrap();
        PileEstimate::of(&scene, &simulation.layout, &simulation.state.q)
    }

    #[test]
    fn blocks_land_after_their_free_fall_onto_those_below() {
        let pile = of_column(3, "");
        // In a column the pile is as wide as the blocks, of which it would fill 4/5.
        for (k, lands) in pile.lands.iter().enumerate() {
            let drop = (0.3 - 0.1 / FILLED) * k as f64;
            assert!((lands - (2.0 * drop / 9.81).sqrt()).abs() < 1e-12, "{k}: {lands}");
        }
        assert!((pile.layers - 3.0 / FILLED).abs() < 1e-12);
        let last = pile.lands[2];
        assert_eq!((pile.landing(1.0), pile.landing(0.9 * last)), (Some(last), None));
        let mean = (3.0 - pile.lands.iter().sum::<f64>()) / 3.0;
        assert!((pile.part_landed(1.0) - mean).abs() < 1e-12);
        assert_eq!(pile.contacts(1.0), (6.0 * mean) as usize);
        let [jams, lies] = pile.steps();
        assert!((jams - 3.0 * pile.layers * TIGHT * JAMMING).abs() < 1e-12, "to a tolerance of 1e-10");
        let calm = JAMS_UNTIL * last;
        let jamming = jams * (calm - pile.lands.iter().sum::<f64>() / 3.0);
        assert!((pile.seconds(1.0, 1e-3) - 1e3 * (jamming + lies * (1.0 - calm))).abs() < 1e-12);
        assert!((pile.seconds(0.1, 1e-3) - 1e3 * jams * 0.1 / 3.0).abs() < 1e-12, "the first lies where it is");
    }

    #[test]
    fn without_gravity_nothing_lands() {
        let pile = of_column(3, "[world]\ngravity = '0 m/s^2'\n");
        assert_eq!((pile.landing(1e9), pile.part_landed(1e9) < 1.0), (None, true));
        assert_eq!(pile.lands[1], f64::INFINITY);
    }
}
