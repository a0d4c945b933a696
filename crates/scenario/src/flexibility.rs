//! Flexibility of a beam that is missing in a mesh, or in modes, at its loaded points.
//!
//! The motion of a rocking block depends on how far both of its feet sink together, and on how much
//! more one sinks than the other. Few modes, or an element as long as the block is wide, represent
//! the first and little of the second, and the motion is wrong with any step. A load deflects the
//! whole beam, so for a load the missing part is the largest error of the deflection, relative to
//! the largest deflection. Measured on the paper's scene (`docs/resolution.md`): models that lack
//! 0.71, 0.14, 0.08, 0.04 of it (1, 3, 2, 5 elements) are off by 60, 13, 2, 1 % however fine the
//! step.

use crate::scene::{BeamScene, BlockScene, Placement, Reduction, Scene, SupportingBody};
use crate::stable_step;
use teeter_beam::{Beam, BeamSpec, MatrixWeights, ShapeAt};

/// If more than this part of the flexibility is missing, motions are likely off by more than 10 %:
/// between the 13.3 % of four modes (off by 1 to 2 %) and the 14.1 % of three elements (off by 13
/// %).
pub(crate) const MOST_MISSING: f64 = 0.135;

/// A mesh or a basis that lacks no more than this is recommended instead of one that lacks too
/// much.
const ENOUGH: f64 = 0.03;

/// Positions along the span at which a moving or distributed load is evaluated.
const PLACES: usize = 16;

/// Least number of elements that represent the exact beam; nodes at the feet make them exact there
/// in statics.
const FINE: usize = 48;

/// Most elements tried for a recommendation.
const MOST_TRIED: usize = 320;

/// Most modes tried: more take longer to find than to step the full model.
const MOST_MODES: usize = 20;

/// The missing part of the flexibility of a beam.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MissingFlexibility {
    /// The largest missing part, over all load patterns.
    pub(crate) part: f64,
    /// What loads the beam.
    pub(crate) what: String,
    /// The remedy.
    pub(crate) advice: String,
}

/// A load on a beam, and where it may act.
#[derive(Debug, Clone, PartialEq)]
struct LoadedPoints {
    what: String,
    at: Vec<f64>,
    how: LoadPattern,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum LoadPattern {
    /// Both feet of a rocking block, or its only one on the beam: any distribution between them.
    Rocking,
    /// Both feet equally.
    Standing,
    /// At one of several positions.
    Along,
}

/// What the flexibility that a model of a beam lacks depends on.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Flexibility {
    spec: BeamSpec,
    reduction: Option<Reduction>,
    loaded_points: Vec<LoadedPoints>,
}

impl Flexibility {
    /// That of a beam of the scene; `None` for one without loads, which lacks nothing.
    pub(crate) fn of(scene: &Scene, number: usize) -> Option<Self> {
        let BeamScene { spec, reduction, .. } = &scene.beams[number];
        let loaded_points = Some(loaded_points(scene, number)).filter(|points| !points.is_empty())?;
        Some(Self { spec: spec.clone(), reduction: *reduction, loaded_points })
    }

    /// The largest missing part, if that is more than [`MOST_MISSING`].
    pub(crate) fn missing(&self) -> Option<MissingFlexibility> {
        let Self { spec: of, reduction, loaded_points } = self;
        let own = Beam::new(of.clone()).ok()?;
        let (omega, _) = stable_step::first_frequency(of)?;
        // At the frequency of the first mode, so that a beam without supports has a flexibility too.
        let mass = omega * omega;
        let exact: Vec<FlexibilityMatrix> = loaded_points
            .iter()
            .map(|points| {
                let beam = Beam::new(fine(&own, &points.at)).ok()?;
                of_mesh(&beam, &points.at, mass)
            })
            .collect::<Option<_>>()?;
        let worst = |has: &dyn Fn(&[f64]) -> Option<FlexibilityMatrix>| {
            let mut worst: Option<(f64, &str)> = None;
            for (points, exact) in loaded_points.iter().zip(&exact) {
                let part = exact.missing(&has(&points.at)?, points.how);
                if worst.is_none_or(|(most, _)| part > most) {
                    worst = Some((part, &points.what));
                }
            }
            worst
        };
        let of_beam = |beam: &Beam, reduction: Option<Reduction>| match reduction {
            None => worst(&|at| of_mesh(beam, at, mass)),
            Some(reduction) => {
                let basis = reduction.basis(beam).ok()?;
                worst(&|at| of_modes(beam, &basis, basis.len(), at, mass))
            }
        };
        let (part, what) = of_beam(&own, *reduction)?;
        if part <= MOST_MISSING {
            return None;
        }
        let mesh = |elements: usize| {
            let mut spec = of.clone();
            (spec.elements, spec.nodes) = (elements, Vec::new());
            of_beam(&Beam::new(spec).ok()?, None)
        };
        let enough = |found: Option<(f64, &str)>| found.is_some_and(|(part, _)| part <= ENOUGH);
        let full = of_beam(&own, None)?;
        let advice = match reduction {
            Some(_) if full.0 <= MOST_MISSING => {
                // A basis contains all smaller ones.
                let most = MOST_MODES.min(own.free_dofs());
                let count = Reduction::Modes(most).basis(&own).ok().and_then(|basis| {
                    let modes = |count: usize| worst(&|at| of_modes(&own, &basis, count, at, mass));
                    doublings(2).take_while(|&count| count <= most).find(|&count| enough(modes(count)))
                });
                match count {
                    Some(count) => format!("use modes = {{ count = {count} }} or more, or leave the number out"),
                    None => "use model = \"full\"".to_owned(),
                }
            }
            _ => match doublings(2).find(|&elements| enough(mesh(elements))) {
                Some(elements) => format!("use elements = {elements} or more"),
                None => "use more elements where it is loaded".to_owned(),
            },
        };
        Some(MissingFlexibility { part, what: what.to_owned(), advice })
    }
}

/// 2, 4, 6, 8, 10, 20, 40, …
fn doublings(from: usize) -> impl Iterator<Item = usize> {
    [from, 4, 6, 8].into_iter().chain(std::iter::successors(Some(10), |n| Some(2 * n))).take_while(|n| *n <= MOST_TRIED)
}

fn loaded_points(scene: &Scene, number: usize) -> Vec<LoadedPoints> {
    let of = &scene.beams[number];
    let on = |x: &f64| *x > 0.0 && *x < of.spec.span;
    let mut loaded_points = Vec::new();
    for contact in scene.contacts.iter().filter(|contact| contact.surface == SupportingBody::Beam(number)) {
        let block: &BlockScene = &scene.blocks[contact.block];
        let middle = match block.placement {
            Placement::On { at, .. } => at,
            Placement::Free { position, .. } => position[0],
        } - of.start_position()[0];
        let feet = [middle - 0.5 * block.width, middle + 0.5 * block.width];
        let at: Vec<f64> = feet.into_iter().filter(on).collect();
        if !at.is_empty() {
            let stands = matches!(block.placement, Placement::On { tilt: 0.0, .. });
            let how = if at.len() < 2 || !stands || scene.is_driven(contact) {
                LoadPattern::Rocking
            } else {
                LoadPattern::Standing
            };
            loaded_points.push(LoadedPoints { what: format!("the feet of `{}`", block.name), at, how });
        }
    }
    for load in scene.loads.iter().filter(|load| load.beam == number) {
        let at = (1..PLACES).map(|place| of.spec.span * place as f64 / PLACES as f64).collect();
        loaded_points.push(LoadedPoints { what: format!("the load `{}`", load.name), at, how: LoadPattern::Along });
    }
    loaded_points
}

/// The beam with a mesh that is practically exact for forces at the given positions.
pub(crate) fn fine(of: &Beam, at: &[f64]) -> BeamSpec {
    let span = of.spec().span;
    let mut nodes = of.node_positions().to_vec();
    let parts = FINE.div_ceil(nodes.len().saturating_sub(1).max(1));
    let between: Vec<f64> = nodes
        .windows(2)
        .flat_map(|ends| (1..parts).map(|k| ends[0] + (ends[1] - ends[0]) * k as f64 / parts as f64))
        .collect();
    nodes.extend(between);
    // Nodes nearer to each other than this would create a very short element.
    let apart = 1e-4 * span;
    for x in at {
        if nodes.iter().all(|node| (node - x).abs() > apart) {
            nodes.push(*x);
        }
    }
    nodes.sort_by(f64::total_cmp);
    of.spec().clone().meshed(nodes)
}

/// Deflections of points under unit forces at these points, m/N, by rows.
struct FlexibilityMatrix {
    places: usize,
    entries: Vec<f64>,
}

impl FlexibilityMatrix {
    fn of(places: usize, entry: &dyn Fn(usize, usize) -> f64) -> Self {
        let entries = (0..places * places).map(|k| entry(k / places, k % places)).collect();
        Self { places, entries }
    }

    fn at(&self, i: usize, j: usize) -> f64 {
        self.entries[i * self.places + j]
    }

    /// The largest relative error of `has` against this one, over the load patterns.
    fn missing(&self, has: &Self, how: LoadPattern) -> f64 {
        let sum = |entries: &[f64]| entries.iter().sum::<f64>();
        match how {
            LoadPattern::Rocking => self.missing_over_all(has),
            LoadPattern::Standing => (1.0 - sum(&has.entries) / sum(&self.entries)).abs(),
            LoadPattern::Along => {
                let largest = (0..self.places).map(|i| self.at(i, i)).fold(0.0, f64::max);
                let errors = self.entries.iter().zip(&has.entries).map(|(exact, has)| (exact - has).abs());
                errors.fold(0.0, f64::max) / largest
            }
        }
    }

    /// The largest |λ| of (F − F') p = λ F p, for one place or two.
    fn missing_over_all(&self, has: &Self) -> f64 {
        let a = self.at(0, 0);
        if self.places < 2 {
            return (1.0 - has.at(0, 0) / a).abs();
        }
        let (b, c) = (self.at(0, 1), self.at(1, 1));
        let (d, e, f) = (a - has.at(0, 0), b - has.at(0, 1), c - has.at(1, 1));
        let determinant = a * c - b * b;
        // Feet that sink together, as near a support, have only one load pattern.
        if determinant <= 1e-9 * a * c {
            return (d / a).abs().max((f / c).abs());
        }
        let mean = 0.5 * (c * d - 2.0 * b * e + a * f) / determinant;
        let product = (d * f - e * e) / determinant;
        let half = (mean * mean - product).max(0.0).sqrt();
        (mean + half).abs().max((mean - half).abs())
    }
}

fn of_mesh(beam: &Beam, at: &[f64], mass: f64) -> Option<FlexibilityMatrix> {
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
    Some(FlexibilityMatrix::of(at.len(), &|i, j| shapes[i].deflection(&sunk[j]).w))
}

/// With the first `count` shapes of a basis.
fn of_modes(
    beam: &Beam,
    basis: &teeter_beam::ModalBasis,
    count: usize,
    at: &[f64],
    mass: f64,
) -> Option<FlexibilityMatrix> {
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
    Some(FlexibilityMatrix::of(at.len(), &entry))
}

#[cfg(test)]
mod tests {
    use super::{Flexibility, MissingFlexibility};
    use crate::resolve::Resolved;
    use crate::scene::Scene;

    fn missing_flexibility(scene: &Scene, number: usize) -> Option<MissingFlexibility> {
        Flexibility::of(scene, number)?.missing()
    }

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
        let elements = |n: &str| missing_flexibility(&resolved(&[("beam.t.elements", n)]).scene, 0);
        // By a dense solve of the same matrices in another language.
        assert!((elements("1").unwrap().part - 0.705).abs() < 2e-3, "{:?}", elements("1"));
        assert!((elements("3").unwrap().part - 0.1411).abs() < 1e-3, "{:?}", elements("3"));
        assert!(elements("3").unwrap().advice.contains("elements = "), "{:?}", elements("3"));
        for enough in ["2", "4", "5", "20"] {
            assert_eq!(elements(enough), None, "{enough}");
        }
        let modes = |n: &str| {
            let count = format!("{{ count = {n} }}");
            missing_flexibility(&resolved(&[("beam.t.model", "modes"), ("beam.t.modes", &count)]).scene, 0)
        };
        // One mode is level at midspan: both feet sink together, and no couple turns them.
        assert!((modes("1").unwrap().part - 1.0).abs() < 1e-3, "{:?}", modes("1"));
        assert!((modes("2").unwrap().part - 0.3051).abs() < 1e-3, "{:?}", modes("2"));
        assert!(modes("2").unwrap().advice.contains("count = "), "{:?}", modes("2"));
        assert_eq!(modes("8"), None);
    }
}
