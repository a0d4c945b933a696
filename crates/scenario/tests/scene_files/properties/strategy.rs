//! Which scenes are drawn: one to three blocks that stand, slide, tip, fly or fall on ground and
//! beams.

use super::drawn::{
    Beam, Block, Contact, Damping, Drawn, Ground, Law, Motion, Placement, Scheme, Segment, Signal, Support, Surface,
};
use proptest::prelude::*;
use proptest::sample::select;

/// A number from a range, or one that degenerates.
fn or(special: f64, range: std::ops::Range<f64>) -> impl Strategy<Value = f64> + Clone {
    prop_oneof![1 => Just(special), 2 => range]
}

/// 10 to the power of a number from a range.
fn decades(range: std::ops::Range<f64>) -> impl Strategy<Value = f64> + Clone {
    range.prop_map(|exponent| 10.0_f64.powf(exponent))
}

/// A place on a beam that makes no element much shorter than others: such a mesh rounds by more
/// than a nudge.
fn eighth(from: u32, to: u32) -> impl Strategy<Value = f64> + Clone {
    (from..=to).prop_map(|eighths| 0.125 * f64::from(eighths))
}

/// Nothing more often than something, and nothing where a case shrinks.
fn seldom<S: Strategy + Clone>(strategy: S) -> impl Strategy<Value = Option<S::Value>> + Clone
where
    S::Value: Clone,
{
    proptest::option::weighted(0.25, strategy)
}

/// What there is to fall on.
#[derive(Clone, Copy, Debug)]
enum Below {
    Ground,
    Beam,
    BeamOverGround,
    TwoBeams,
}

/// A block in parts of its slot, before it has a place in a scene.
#[derive(Clone, Debug)]
struct RawBlock {
    density: f64,
    width: f64,
    aspect: f64,
    depth: f64,
    offset: f64,
    standing: bool,
    angle: f64,
    clearance: f64,
    velocity: [f64; 2],
    spin: f64,
    load: Option<[f64; 3]>,
    second_beam: bool,
}

fn raw_block() -> impl Strategy<Value = RawBlock> + Clone {
    let shape = (500.0..8000.0, 0.05..0.3, 0.4..3.0, 0.02..0.2, or(0.0, -0.15..0.15));
    let start = (any::<bool>(), or(0.0, -0.35..0.35), 0.0..0.3, [or(0.0, -1.0..1.0), or(0.0, -2.0..0.5)]);
    let more = (or(0.0, -5.0..5.0), seldom([-0.5..0.5, -0.5..0.5, -0.1..0.1]), any::<bool>());
    (shape, start, more).prop_map(
        |((density, width, aspect, depth, offset), (flies, angle, clearance, velocity), (spin, load, second_beam))| {
            RawBlock {
                density,
                width,
                aspect,
                depth,
                offset,
                standing: !flies,
                angle,
                clearance,
                velocity,
                spin,
                load,
                second_beam,
            }
        },
    )
}

fn law() -> impl Strategy<Value = Law> + Clone {
    let instant = |word| {
        (or(0.0, 0.05..0.95), prop_oneof![3 => Just(0.0), 1 => 0.05..0.95])
            .prop_map(move |(normal, tangential)| Law::Instant { word, normal, tangential })
    };
    prop_oneof![
        4 => instant("newton"),
        1 => instant("poisson"),
        1 => instant("energetic"),
        1 => (decades(3.0..7.0), or(0.0, 0.1..20.0))
            .prop_map(|(stiffness, damping)| Law::KelvinVoigt { stiffness, damping }),
        1 => (decades(4.0..8.0), or(0.0, 0.05..1.0), select(vec![1.0, 1.5, 2.0]))
            .prop_map(|(stiffness, damping, exponent)| Law::HuntCrossley { stiffness, damping, exponent }),
    ]
}

/// A support in units of the beam's own stiffness EI/L³; free and guided ends only on the right.
fn support(right: bool) -> impl Strategy<Value = Support> + Clone {
    let words = if right { vec!["pinned", "clamped", "free", "guided"] } else { vec!["pinned", "clamped", "pinned"] };
    prop_oneof![
        3 => select(words).prop_map(Support::Word),
        1 => (decades(0.0..4.0), or(0.0, 0.01..1.0), or(0.0, 0.1..10.0)).prop_map(|(k, c, turn)| Support::Spring([k, c, turn])),
    ]
}

/// A beam of span 1, without its place; stiffnesses and dampings in units of the beam's own.
fn raw_beam() -> impl Strategy<Value = Beam> + Clone {
    let section = (0.02..0.1, 0.008..0.03, 500.0..8000.0, decades(9.5..11.3), 1..8_u32);
    let held = (support(false), support(true), any::<bool>());
    let damping = prop_oneof![
        Just(Damping::None),
        (0.001..0.1).prop_map(Damping::Ratio),
        (0.01..1.0).prop_map(Damping::Viscous),
        [0.1..5.0, 1e-6..1e-4].prop_map(Damping::Rayleigh),
    ];
    let furniture = (
        seldom((eighth(1, 3), eighth(5, 7), 0.008..0.03)),
        seldom((eighth(1, 7), 0.1..2.0).prop_map(|(at, mass)| [at, mass])),
        seldom((decades(0.0..3.0), or(0.0, 0.01..1.0)).prop_map(|(k, c)| [k, c])),
    );
    let words = (any::<[bool; 4]>(), seldom(1..4_u32));
    (section, held, damping, furniture, words).prop_map(
        |(
            (width, thickness, density, modulus, elements),
            (left, right, turned),
            damping,
            (segment, lump, foundation),
            ([timoshenko, top, static_start, self_weight], modes),
        )| {
            let supports = if turned { [right, left] } else { [left, right] };
            let holds = |support: &Support| !matches!(support, Support::Word("free" | "guided"));
            Beam {
                name: String::new(),
                position: [0.0, 0.0],
                span: 1.0,
                width,
                thickness,
                density,
                modulus,
                elements: elements.max(modes.map_or(1, |_| 3)),
                static_start: static_start && supports.iter().all(holds),
                supports,
                damping,
                segment: segment.map(|(from, to, thickness)| Segment { from, to, thickness }),
                lump,
                foundation,
                timoshenko,
                top,
                self_weight,
                modes,
                motion: None,
            }
        },
    )
}

impl Beam {
    /// The same with a span, so far 1, and a name and a place.
    fn placed(mut self, name: &str, position: [f64; 2], span: f64, motion: Option<Motion>) -> Self {
        self.span = span;
        self.width *= span;
        self.thickness *= span;
        let stiffness = self.modulus * self.width * self.thickness.powi(3) / 12.0;
        let mass_per_length = self.density * self.width * self.thickness;
        // c of a beam that is damped by about its own first circular frequency.
        let damping = (stiffness * mass_per_length).sqrt() / (span * span);
        for support in &mut self.supports {
            if let Support::Spring([spring, dashpot, rotational]) = support {
                *spring *= stiffness / span.powi(3);
                *dashpot *= damping * span;
                *rotational *= stiffness / span;
            }
        }
        if let Damping::Viscous(c) = &mut self.damping {
            *c *= damping;
        }
        if let Some(Segment { from, to, thickness }) = &mut self.segment {
            [from, to, thickness].into_iter().for_each(|length| *length *= span);
        }
        if let Some([at, mass]) = &mut self.lump {
            *at *= span;
            *mass *= mass_per_length * span;
        }
        if let Some([k, c]) = &mut self.foundation {
            *k *= stiffness / span.powi(4);
            *c *= damping;
        }
        name.clone_into(&mut self.name);
        self.position = position;
        self.motion = motion;
        self
    }
}

/// Any scene. Blocks that turn out to overlap, or beams without an equilibrium, are refused by the
/// program: such a draw is none.
pub(crate) fn scene() -> impl Strategy<Value = Drawn> {
    let grid = (decades(-4.0..-2.3), 10..120_u32);
    let scheme = prop_oneof![
        (or(0.5, 0.5..1.0), or(0.5, 0.0..1.0)).prop_map(|(theta, gamma)| Scheme::MoreauJean { theta, gamma }),
        Just(Scheme::Closed),
        Just(Scheme::Located),
        Just(Scheme::Projected),
        Just(Scheme::GeneralizedAlpha),
    ];
    let world = (
        select(vec![Below::Ground, Below::Beam, Below::BeamOverGround, Below::TwoBeams]),
        0.3..2.0,
        or(0.0, -1.0..1.0),
        (or(0.0, -2.0..2.0), prop_oneof![1 => Just(0.0), 9 => 5.0..12.0]),
        or(0.0, -0.2..0.2),
    );
    let driven = (0.001..0.05, 2.0..40.0, seldom([-5.0..5.0, -5.0..5.0]), seldom([-5.0..5.0, -5.0..5.0]));
    let solver = (select(vec!["auto", "auto", "auto", "enumeration", "pgs"]), select(vec![1e-10, 1e-12]));
    let beams = [raw_beam(), raw_beam()];
    let blocks = proptest::collection::vec(raw_block(), 1..=3);
    let contact = (or(0.0, 0.05..1.3), law(), any::<bool>());
    (grid, scheme, world, driven, solver, beams, blocks, proptest::collection::vec(contact, 6)).prop_map(
        |((step, steps), scheme, (below, span, start, gravity, incline), driven, solver, beams, blocks, laws)| {
            let (ground_motion, beam_motion) = (driven.2.map(Motion::Shaken), driven.3.map(Motion::Shaken));
            let left = start * span;
            let [first, second] = beams;
            let ground = Ground { incline: 0.0, motion: ground_motion };
            let height = 2.0 * span;
            let (ground, beams) = match below {
                Below::Ground => (Some(Ground { incline, ..ground }), vec![]),
                Below::Beam => (None, vec![first.placed("left", [left, 0.0], span, beam_motion)]),
                Below::BeamOverGround => (Some(ground), vec![first.placed("left", [left, height], span, beam_motion)]),
                Below::TwoBeams => {
                    let right = second.placed("right", [left + 1.5 * span, 0.3], 0.8 * span, None);
                    (None, vec![first.placed("left", [left, 0.0], span, beam_motion), right])
                }
            };
            let mut drawn = Drawn {
                step,
                steps,
                scheme,
                gap_tolerance: 0.0,
                gravity: [gravity.0, -gravity.1],
                ground,
                beams,
                blocks: Vec::new(),
                contacts: Vec::new(),
                signal: Signal { start: driven.0, frequency: driven.1 },
                // Which is quick up to three contacts.
                method: if solver.0 == "enumeration" && blocks.len() > 1 { "auto" } else { solver.0 },
                tolerance: solver.1,
            };
            let slots = blocks.len() as f64;
            for (k, raw) in blocks.into_iter().enumerate() {
                let slot = (k as f64 + 0.5 + raw.offset) / slots;
                drawn.put(k, slot, 1.0 / slots, raw, [left, span]);
            }
            drawn.gap_tolerance = 1e-11 * drawn.length();
            for (k, block) in drawn.blocks.iter().enumerate() {
                let fallen = (block.over != Surface::Ground && drawn.ground.is_some()).then_some(Surface::Ground);
                for surface in [Some(block.over), fallen].into_iter().flatten() {
                    let (friction, law, linear) = laws[drawn.contacts.len()];
                    let name = format!("{}-{}", block.name, if surface == Surface::Ground { "ground" } else { "beam" });
                    drawn.contacts.push(Contact { name, block: k, surface, friction, law, linear });
                }
            }
            if drawn.contacts.iter().any(|contact| contact.law.is_poisson()) {
                // Who parts in expansion is told to 1e-11; a solver that stops before that can't
                // tell a tie from a choice.
                (drawn.method, drawn.tolerance) = ("auto", 1e-12);
            }
            drawn
        },
    )
}

impl Drawn {
    /// Puts a block over its part of the ground or of a beam.
    fn put(&mut self, number: usize, slot: f64, room: f64, raw: RawBlock, [left, span]: [f64; 2]) {
        let over = match self.beams.len() {
            0 => Surface::Ground,
            beams => Surface::Beam(usize::from(raw.second_beam && beams > 1)),
        };
        let ([left, level], span) = match over {
            Surface::Ground => ([left, 0.0], span),
            Surface::Beam(k) => {
                let Beam { position, span, top, thickness, .. } = self.beams[k];
                ([position[0], position[1] + if top { 0.5 * thickness } else { 0.0 }], span)
            }
        };
        let width = raw.width * room * span;
        let height = width * raw.aspect;
        let x = left + slot * span;
        let slope = self.ground.filter(|_| over == Surface::Ground).map_or(0.0, |ground| ground.incline.tan());
        let reach = 0.5 * width.hypot(height);
        let placement = if raw.standing {
            Placement::Standing { at: x, tilt: raw.angle }
        } else {
            let y = level + slope * x + reach * (1.0 + slope.abs()) + raw.clearance * height;
            Placement::Flying { position: [x, y], angle: raw.angle }
        };
        let weight = raw.density * width * height * raw.depth * 9.81;
        self.blocks.push(Block {
            name: format!("block-{number}"),
            density: raw.density,
            size: [width, height, raw.depth],
            over,
            placement,
            velocity: raw.velocity,
            spin: raw.spin,
            load: raw.load.map(|[x, y, couple]| [x * weight, y * weight, couple * weight * width]),
        });
    }
}
