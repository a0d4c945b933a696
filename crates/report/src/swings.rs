//! Whether steps were fine enough for the free swings of beams (`docs/resolution.md`).
//!
//! With ρ = exp(iωh)/λ of [`Swing::off_a_step`] a swing a exp(iωt) is off after a step by (ρ − 1) a more, and what is off goes on as a swing of its
//! own:
//!
//! ```text
//! e ← exp((iω − ζω)h) e + (ρ − 1) a,        a = 2ẇ/(iω)
//! ```
//!
//! Of a only the part that turns with ω adds up; ẇ holds it once, and once what turns the other way, which cancels out as all that a load bends slowly.

use crate::probe::Probe;
use crate::resolution::raise;
use crate::verdict::SharedStances;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use teeter_beam::Beam;
use teeter_integrator::State;
use teeter_scenario::scene::Scene;
use teeter_scenario::simulation::{BeamPlace, Layout};
use teeter_scenario::swing::{SWING_OFF, Swing, finer};

/// A deflection below this part of the span is none, and nothing of it is off.
const STILL: f64 = 1e-9;

/// What is known of a beam's swings so far.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Swung {
    /// e at each place, its real and imaginary part, m.
    off: Vec<[f64; 2]>,
    /// The largest deflection, m.
    most: f64,
    /// The largest |e|, m.
    worst: f64,
}

/// What a run has shown so far of how well its steps resolve the swings of its beams.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Swings(Vec<Swung>);

/// A beam whose swings the steps don't resolve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lost {
    /// Its number.
    pub(crate) beam: usize,
    /// How much is off, as a part of the largest deflection.
    pub(crate) part: f64,
    /// The frequency that it was watched at, Hz.
    pub(crate) frequency: f64,
    /// A step to take in its place, s.
    pub(crate) step: f64,
}

/// Where to look at the beams of a scene, and how fast they swing.
#[derive(Debug, Default)]
pub(crate) struct Watch {
    beams: Vec<Watched>,
    theta: f64,
    shared: Option<Arc<SharedStances>>,
}

/// Where to look at a beam, and how it swings.
#[derive(Debug)]
struct Watched {
    /// Quarter points and middles between supports.
    places: Vec<Probe>,
    span: f64,
    beam: Arc<Beam>,
    /// The shape from which it starts.
    shape: Vec<f64>,
    /// Found with the first step; a beam that no frequency is known of is not watched.
    swing: Option<Option<Swing>>,
    /// The step size that the two below are for, s.
    step: f64,
    /// exp((iω − ζω)h).
    turn: [f64; 2],
    /// ρ − 1.
    more: [f64; 2],
}

impl Watch {
    pub(crate) fn of(scene: &Scene, layout: &Layout) -> Self {
        let watched = |place: &BeamPlace| {
            let of = scene.beams.iter().find(|beam| beam.name == place.name);
            let shape = of.map(|beam| beam.shape.clone()).unwrap_or_default();
            let places = place.quarters().into_iter().map(|x| Probe::new(place, place.beam.shape_clamped(x))).collect();
            let span = place.beam.spec().span;
            let beam = Arc::clone(&place.beam);
            Watched { places, span, beam, shape, swing: None, step: 0.0, turn: [1.0, 0.0], more: [0.0, 0.0] }
        };
        let (beams, theta) = (layout.beams.iter().map(watched).collect(), scene.time.theta_of_scheme());
        Self { beams, theta, shared: None }
    }

    /// From now on swings are taken from there, and entered.
    pub(crate) fn share(&mut self, shared: &Arc<SharedStances>) {
        self.shared = Some(Arc::clone(shared));
    }

    /// Whether the steps take something out of a swing.
    pub(crate) fn damps(&self) -> bool {
        self.theta > 0.5
    }
}

impl Watched {
    /// How the beam swings.
    fn swing(&mut self, shared: Option<&SharedStances>) -> Option<Swing> {
        let Self { beam, shape, swing, .. } = self;
        let find = || Swing::of(beam, shape);
        *swing.get_or_insert_with(|| shared.map_or_else(find, |shared| shared.swing(beam, shape, find)))
    }

    /// Takes a step size in.
    fn with_step(&mut self, swing: Swing, theta: f64, h: f64) {
        if self.step == h {
            return;
        }
        let (size, angle) = ((-swing.decay * h).exp(), swing.omega * h);
        (self.step, self.turn, self.more) = (h, [size * angle.cos(), size * angle.sin()], swing.off_a_step(theta, h));
    }
}

impl Swings {
    /// Before the first step.
    pub(crate) fn start(&mut self, watch: &Watch) {
        self.0.clear();
        self.0.extend(
            watch.beams.iter().map(|beam| Swung { off: vec![[0.0; 2]; beam.places.len()], ..Swung::default() }),
        );
    }

    /// Takes a step of length `h` (s) in that ended in `state`; returns the largest rate of deflection of all beams at their places, m/s.
    pub(crate) fn observe(&mut self, watch: &mut Watch, layout: &Layout, h: f64, state: &State) -> f64 {
        let mut fastest = 0.0;
        for ((swung, watched), place) in self.0.iter_mut().zip(&mut watch.beams).zip(&layout.beams) {
            let swing = watched.swing(watch.shared.as_deref());
            if let Some(swing) = swing {
                watched.with_step(swing, watch.theta, h);
            }
            let ([c, d], [r, s]) = (watched.turn, watched.more);
            let (q, v) = (&state.q[place.range.clone()], &state.v[place.range.clone()]);
            let mut worst = 0.0;
            for (off, at) in swung.off.iter_mut().zip(&watched.places) {
                let (w, rate) = (at.deflection(q), at.deflection(v));
                raise(&mut fastest, rate.abs());
                raise(&mut swung.most, w.abs());
                let Some(swing) = swing else { continue };
                // a = 2ẇ/(iω) lies on the imaginary axis.
                let a = -2.0 * rate / swing.omega;
                let [x, y] = *off;
                *off = [c * x - d * y - s * a, d * x + c * y + r * a];
                raise(&mut worst, off[0] * off[0] + off[1] * off[1]);
            }
            raise(&mut swung.worst, worst.sqrt());
        }
        fastest
    }

    /// The beam whose swings steps of length `step` (s) resolve worst, if that is badly.
    pub(crate) fn lost(&self, watch: &Watch, step: f64) -> Option<Lost> {
        let all = self.0.iter().zip(&watch.beams).enumerate();
        let parts = all.filter(|(_, (swung, watched))| swung.most > STILL * watched.span).filter_map(
            |(beam, (swung, watched))| {
                let part = swung.worst / swung.most;
                let frequency = watched.swing??.omega / std::f64::consts::TAU;
                Some(Lost { beam, part, frequency, step: finer(step, part, watch.theta) })
            },
        );
        parts.filter(|lost| lost.part > SWING_OFF).max_by(|a, b| a.part.total_cmp(&b.part))
    }
}
