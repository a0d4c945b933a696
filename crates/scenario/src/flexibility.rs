//! What a mesh, or modes, leave out of a beam's flexibility where something presses on it.
//!
//! A block that rocks feels its beam through both feet: by how much they sink together, and by how
//! much one sinks more than the other. Few modes, or an element as long as the block is wide, have
//! the first and little of the second, and the motion is another one with every step. A load makes
//! the beam sag everywhere, so what lacks is the largest error of that sag, relative to the largest
//! that the load makes anywhere. Measured on the paper's scene (`docs/resolution.md`): what lacks
//! 0.71, 0.14, 0.08, 0.04 of it (1, 3, 2, 5 elements) is off by 60, 13, 2, 1 % however fine the
//! step.

use crate::scene::{BeamScene, BlockScene, Placement, Scene, Support};
use crate::stability;
use teeter_beam::{Beam, BeamSpec, MatrixWeights, ShapeAt};

/// A part of the flexibility that lacks, from which on motions are likely off by more than 10 %:
/// between the 13.3 % of four modes (off by 1 to 2 %) and the 14.1 % of three elements (off by 13
/// %).
pub(crate) const LACKING: f64 = 0.135;

/// A mesh or a basis that lacks no more than this is advised in place of one that lacks too much.
const ENOUGH: f64 = 0.03;

/// Places along the span at which a load that moves, or one somewhere, is taken.
const PLACES: usize = 16;

/// Elements that stand for the exact beam, at least; nodes at the feet make them exact in statics
/// there.
const FINE: usize = 48;

/// Most elements that are tried for advice.
const MOST_TRIED: usize = 320;

/// Most modes that are: more of them take longer to find than the full model to step.
const MOST_MODES: usize = 20;

/// What lacks of the flexibility of a beam.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Lack {
    /// The largest part of it, over all ways to press.
    pub(crate) part: f64,
    /// What presses.
    pub(crate) what: String,
    /// What to take.
    pub(crate) advice: String,
}

/// What presses on a beam, and where it may.
struct Press {
    what: String,
    at: Vec<f64>,
    how: How,
}

#[derive(Clone, Copy)]
enum How {
    /// With both feet of a block that rocks, or with its only one on the beam: as much with either
    /// as it comes.
    Rocking,
    /// With both feet alike.
    Standing,
    /// At one place after the other.
    Along,
}

/// The worst that lacks of a beam, if that is more than [`LACKING`].
pub(crate) fn lacking(scene: &Scene, number: usize) -> Option<Lack> {
    let of = &scene.beams[number];
    let presses = presses(scene, number);
    // Of a beam that nothing presses on nothing lacks.
    if presses.is_empty() {
        return None;
    }
    let (omega, _) = stability::first_frequency(&of.spec)?;
    // At the pace of the first mode, so that a beam without supports has a flexibility too.
    let mass = omega * omega;
    let exact: Vec<Matrix> = presses
        .iter()
        .map(|press| Beam::new(fine(of, &press.at)).ok().and_then(|beam| of_mesh(&beam, &press.at, mass)))
        .collect::<Option<_>>()?;
    let worst = |has: &dyn Fn(&[f64]) -> Option<Matrix>| {
        let mut worst: Option<(f64, &str)> = None;
        for (press, exact) in presses.iter().zip(&exact) {
            let part = exact.lacks(&has(&press.at)?, press.how);
            if worst.is_none_or(|(most, _)| part > most) {
                worst = Some((part, &press.what));
            }
        }
        worst
    };
    let of_spec = |spec: BeamSpec, reduction: Option<crate::scene::Reduction>| {
        let beam = Beam::new(spec).ok()?;
        match reduction {
            None => worst(&|at| of_mesh(&beam, at, mass)),
            Some(reduction) => {
                let basis = reduction.basis(&beam).ok()?;
                worst(&|at| of_modes(&beam, &basis, basis.len(), at, mass))
            }
        }
    };
    let (part, what) = of_spec(of.spec.clone(), of.reduction)?;
    if part <= LACKING {
        return None;
    }
    let mesh = |elements: usize| {
        let mut spec = of.spec.clone();
        (spec.elements, spec.nodes) = (elements, Vec::new());
        of_spec(spec, None)
    };
    let enough = |found: Option<(f64, &str)>| found.is_some_and(|(part, _)| part <= ENOUGH);
    let full = of_spec(of.spec.clone(), None)?;
    let advice = match of.reduction {
        Some(_) if full.0 <= LACKING => {
            // One basis has all the smaller ones in it.
            let basis = Beam::new(of.spec.clone()).ok().and_then(|beam| {
                let most = MOST_MODES.min(beam.free_dofs());
                Some((crate::scene::Reduction::Modes(most).basis(&beam).ok()?, beam, most))
            });
            let count = basis.and_then(|(basis, beam, most)| {
                let modes = |count: usize| worst(&|at| of_modes(&beam, &basis, count, at, mass));
                doublings(2).take_while(|&count| count <= most).find(|&count| enough(modes(count)))
            });
            match count {
                Some(count) => format!("take modes = {{ count = {count} }} or more, or leave the number out"),
                None => "take model = \"full\"".to_owned(),
            }
        }
        _ => match doublings(2).find(|&elements| enough(mesh(elements))) {
            Some(elements) => format!("take elements = {elements} or more"),
            None => "take more elements where it is pressed".to_owned(),
        },
    };
    Some(Lack { part, what: what.to_owned(), advice })
}

/// 2, 4, 6, 8, 10, 20, 40, …
fn doublings(from: usize) -> impl Iterator<Item = usize> {
    [from, 4, 6, 8].into_iter().chain(std::iter::successors(Some(10), |n| Some(2 * n))).take_while(|n| *n <= MOST_TRIED)
}

fn presses(scene: &Scene, number: usize) -> Vec<Press> {
    let of = &scene.beams[number];
    let on = |x: &f64| *x > 0.0 && *x < of.spec.span;
    let mut presses = Vec::new();
    for contact in scene.contacts.iter().filter(|contact| contact.surface == Support::Beam(number)) {
        let block: &BlockScene = &scene.blocks[contact.block];
        let middle = match block.placement {
            Placement::On { at, .. } => at,
            Placement::Free { position, .. } => position[0],
        } - of.position[0];
        let feet = [middle - 0.5 * block.width, middle + 0.5 * block.width];
        let at: Vec<f64> = feet.into_iter().filter(on).collect();
        if !at.is_empty() {
            let stands = matches!(block.placement, Placement::On { tilt: 0.0, .. });
            let how = if at.len() < 2 || !stands || scene.is_driven(contact) { How::Rocking } else { How::Standing };
            presses.push(Press { what: format!("the feet of `{}`", block.name), at, how });
        }
    }
    for load in scene.loads.iter().filter(|load| load.beam == number) {
        let at = (1..PLACES).map(|place| of.spec.span * place as f64 / PLACES as f64).collect();
        presses.push(Press { what: format!("the load `{}`", load.name), at, how: How::Along });
    }
    presses
}

/// The beam with a mesh that is as good as exact for forces at some places.
fn fine(of: &BeamScene, at: &[f64]) -> BeamSpec {
    let span = of.spec.span;
    let mut nodes: Vec<f64> = Beam::new(of.spec.clone()).map(|beam| beam.node_positions().to_vec()).unwrap_or_default();
    let parts = FINE.div_ceil(nodes.len().saturating_sub(1).max(1));
    let between: Vec<f64> = nodes
        .windows(2)
        .flat_map(|ends| (1..parts).map(|k| ends[0] + (ends[1] - ends[0]) * k as f64 / parts as f64))
        .collect();
    nodes.extend(between);
    // Nodes nearer to each other than this would make a sliver of an element.
    let apart = 1e-4 * span;
    for x in at {
        if nodes.iter().all(|node| (node - x).abs() > apart) {
            nodes.push(*x);
        }
    }
    nodes.sort_by(f64::total_cmp);
    of.spec.clone().meshed(nodes)
}

/// How far places sink under unit forces at them, m/N: a row each.
struct Matrix {
    places: usize,
    entries: Vec<f64>,
}

impl Matrix {
    fn of(places: usize, entry: &dyn Fn(usize, usize) -> f64) -> Self {
        let entries = (0..places * places).map(|k| entry(k / places, k % places)).collect();
        Self { places, entries }
    }

    fn at(&self, i: usize, j: usize) -> f64 {
        self.entries[i * self.places + j]
    }

    /// The largest part that `has` lacks, or has too much, of this one, over the ways to press.
    fn lacks(&self, has: &Self, how: How) -> f64 {
        let sum = |entries: &[f64]| entries.iter().sum::<f64>();
        match how {
            How::Rocking => self.lacks_over_all(has),
            How::Standing => (1.0 - sum(&has.entries) / sum(&self.entries)).abs(),
            How::Along => {
                let largest = (0..self.places).map(|i| self.at(i, i)).fold(0.0, f64::max);
                let errors = self.entries.iter().zip(&has.entries).map(|(exact, has)| (exact - has).abs());
                errors.fold(0.0, f64::max) / largest
            }
        }
    }

    /// The largest |λ| of (F − F') p = λ F p, for one place or two.
    fn lacks_over_all(&self, has: &Self) -> f64 {
        let a = self.at(0, 0);
        if self.places < 2 {
            return (1.0 - has.at(0, 0) / a).abs();
        }
        let (b, c) = (self.at(0, 1), self.at(1, 1));
        let (d, e, f) = (a - has.at(0, 0), b - has.at(0, 1), c - has.at(1, 1));
        let determinant = a * c - b * b;
        // Feet that sink as one, as near a support, have one way to press only.
        if determinant <= 1e-9 * a * c {
            return (d / a).abs().max((f / c).abs());
        }
        let mean = 0.5 * (c * d - 2.0 * b * e + a * f) / determinant;
        let product = (d * f - e * e) / determinant;
        let half = (mean * mean - product).max(0.0).sqrt();
        (mean + half).abs().max((mean - half).abs())
    }
}

fn of_mesh(beam: &Beam, at: &[f64], mass: f64) -> Option<Matrix> {
    let factor = beam.factor(MatrixWeights { mass, damping: 0.0, stiffness: 1.0 }).ok()?;
    let shapes: Vec<ShapeAt> = at.iter().map(|x| beam.shape_clamped(*x)).collect();
    let sunk: Vec<Vec<f64>> = shapes
        .iter()
        .map(|shape| {
            let mut q = vec![0.0; beam.dofs()];
            shape.add_load(1.0, 0.0, &mut q);
            factor.solve(&mut q);
            q
        })
        .collect();
    Some(Matrix::of(at.len(), &|i, j| shapes[i].deflection(&sunk[j]).w))
}

/// With the first `count` shapes of a basis.
fn of_modes(beam: &Beam, basis: &teeter_beam::ModalBasis, count: usize, at: &[f64], mass: f64) -> Option<Matrix> {
    let shapes: Vec<ShapeAt> = at.iter().map(|x| beam.shape_clamped(*x)).collect();
    let entry = |i: usize, j: usize| {
        let modes = basis.circular_frequencies()[..count].iter().enumerate();
        modes
            .map(|(k, omega)| {
                let [a, b] = [i, j].map(|at: usize| shapes[at].deflection(basis.shape(k)).w);
                a * b / (mass + omega * omega)
            })
            .sum()
    };
    Some(Matrix::of(at.len(), &entry))
}

#[cfg(test)]
mod tests {
    use super::lacking;
    use crate::resolve::Resolved;

    fn resolved(sets: &[(&str, &str)]) -> Resolved {
        const SCENE: &str = "[time]\nend = '0.5 s'\nstep = '100 us'\n[material.a]\ndensity = '2700 kg/m^3'\nyoungs_modulus = '69 GPa'\n\
            [beam.t]\nmaterial = 'a'\nspan = '36 cm'\nwidth = '3 cm'\nthickness = '0.15 cm'\nelements = 20\nstart = 'static'\n\
            [block.r]\nmaterial = 'a'\nwidth = '3 cm'\nheight = '13.5 cm'\ndepth = '3 cm'\non = 't'\nat = '18 cm'\ntilt = '5 deg'\n\
            [contact.f]\nbetween = ['r', 't']\nfriction = 0.5\n";
        let sets: Vec<_> = sets.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
        crate::load(SCENE.as_bytes(), "f", "f", &sets).unwrap()
    }

    #[test]
    fn what_a_mesh_or_modes_lack_under_two_feet_is_that_of_an_independent_solution() {
        let elements = |n: &str| lacking(&resolved(&[("beam.t.elements", n)]).scene, 0);
        // By a dense solve of the same matrices in another language.
        assert!((elements("1").unwrap().part - 0.705).abs() < 2e-3, "{:?}", elements("1"));
        assert!((elements("3").unwrap().part - 0.1411).abs() < 1e-3, "{:?}", elements("3"));
        assert!(elements("3").unwrap().advice.contains("elements = "), "{:?}", elements("3"));
        for enough in ["2", "4", "5", "20"] {
            assert_eq!(elements(enough), None, "{enough}");
        }
        let modes = |n: &str| {
            let count = format!("{{ count = {n} }}");
            lacking(&resolved(&[("beam.t.model", "modes"), ("beam.t.modes", &count)]).scene, 0)
        };
        // One mode is level at midspan: both feet sink together, and no couple turns them.
        assert!((modes("1").unwrap().part - 1.0).abs() < 1e-3, "{:?}", modes("1"));
        assert!((modes("2").unwrap().part - 0.3051).abs() < 1e-3, "{:?}", modes("2"));
        assert!(modes("2").unwrap().advice.contains("count = "), "{:?}", modes("2"));
        assert_eq!(modes("8"), None);
    }
}
