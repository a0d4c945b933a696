//! `teeter check`: shows what a run would model, cost and write, and what looks wrong, without
//! writing anything. Of a scene of many contacts it takes some steps, to measure them.

use crate::console::{Console, print_all};
use crate::render::{Presenter, refusal};
use crate::run::Exit;
use crate::scene;
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::PathBuf;
use teeter_scenario::output_size::{OutputSize, accuracy_of_seconds, has_many_contacts, writing_seconds};
use teeter_scenario::pile::PileEstimate;
use teeter_scenario::preview::{BeamPreview, BlockPreview, FEW_DIGITS, Preview, ShapesPreview};
use teeter_scenario::readable::{shortest, with_mass, with_unit};
use teeter_scenario::resolve::Resolved;
use teeter_scenario::scene::{GroundScene, Scene, SchemeName};
use teeter_scenario::simulation::Simulation;
use teeter_scenario::{Extent, Removed, wording};
use teeter_study::FirstSteps;

#[derive(Debug)]
pub(crate) struct Options {
    pub(crate) scene: PathBuf,
    /// Folder of the files that the scene names, if it is another than by default.
    pub(crate) base: Option<PathBuf>,
    pub(crate) set: Vec<(String, String)>,
    pub(crate) extent: Extent,
}

pub(crate) fn check(options: &Options) -> Exit {
    let console = Console::new(false);
    let refuse = |text: &str| {
        console.error(text);
        Exit::BadInput
    };
    let resolved =
        match scene::source(&options.scene, options.base.as_deref()).and_then(|source| source.load(&options.set)) {
            Ok(resolved) => resolved,
            Err(error) => return refuse(&refusal(&error)),
        };
    let presenter = Presenter::new(resolved.document.source());
    let mut simulation = match Simulation::with_extent(&resolved.scene, options.extent, |solver| solver) {
        Ok(simulation) => simulation,
        Err(error) => return refuse(&presenter.one(&error.diagnostic(&resolved.document))),
    };
    let preview = Preview::new(&resolved, &simulation);
    let scene = &resolved.scene;
    let measured = (has_many_contacts(scene) && scene.time.accuracy.is_none()).then(|| {
        let pile = PileEstimate::of(scene, &simulation.layout, &simulation.state.q);
        let steps = FirstSteps::measured(&mut simulation);
        let free = scene.blocks.iter().filter(|block| !block.motion.is_whole()).count();
        // Most blocks touch nothing yet.
        let pile = (steps.contacts < free).then_some(pile);
        Measured { steps, free, pile }
    });
    let text = format_preview(&resolved, &preview, measured.as_ref());
    let exit = print_all(&text);
    for finding in resolved.warnings.iter().chain(&resolved.foreseen).chain(&resolved.notes) {
        console.note(&format!("\n{}", presenter.one(finding)));
    }
    exit
}

fn format_preview(resolved: &Resolved, preview: &Preview, measured: Option<&Measured>) -> String {
    let scene = &resolved.scene;
    let mut text = format!("{}\n", scene.title);
    section(&mut text, "bodies", &bodies(scene, preview));
    section(&mut text, "model", &model(scene, preview));
    section(&mut text, "run", &run(scene, preview, measured));
    if !preview.left_out.is_empty() {
        section(&mut text, "left out", &preview.left_out);
    }
    if !preview.removed.is_empty() {
        let mut lines: Vec<String> = preview.removed.iter().take(LISTED).map(removed).collect();
        lines.extend(more(preview.removed.len(), "removal"));
        section(&mut text, "not required, and therefore not modelled (--model full includes it)", &lines);
    }
    text
}

fn removed(removed: &Removed) -> String {
    let how = match &removed.accuracy {
        None => "exact: every number stays the same".to_owned(),
        Some(accuracy) => format!("within {accuracy}"),
    };
    format!("{}\n    {}\n    {how}", removed.what, removed.why)
}

fn section(text: &mut String, title: &str, lines: &[impl AsRef<str>]) {
    let _ = writeln!(text, "\n{title}");
    for line in lines {
        let _ = writeln!(text, "  {}", line.as_ref());
    }
}

/// Largest number of bodies of a kind that are listed; the rest is counted.
const LISTED: usize = 20;

fn bodies(scene: &Scene, preview: &Preview) -> Vec<String> {
    let mut lines: Vec<String> = preview.blocks.iter().take(LISTED).map(block).collect();
    lines.extend(more(preview.blocks.len(), "block"));
    lines.extend(preview.beams.iter().take(LISTED).map(beam));
    lines.extend(more(preview.beams.len(), "beam"));
    lines.extend(scene.ground.as_ref().map(ground));
    lines.extend(driven(scene));
    lines
}

fn ground(ground: &GroundScene) -> String {
    let mut text = "ground: rigid".to_owned();
    if let Some(profile) = &ground.profile {
        let (low, high) = (profile.points().next(), profile.points().last());
        let between = low.zip(high).map_or_else(String::new, |(low, high)| {
            format!(" from x = {} m to {} m, level beyond", digits(low.x), digits(high.x))
        });
        let _ = write!(text, ", with a profile of {}{between}", count(profile.points().count() as u64, "point"));
    } else if ground.incline == 0.0 {
        text.push_str(", flat at y = 0");
    } else {
        let _ = write!(text, ", inclined by {} deg through the origin", degrees(ground.incline));
    }
    if ground.motion.is_given() {
        text.push_str(", moving");
    }
    text
}

/// Prescribed motions and loads.
fn driven(scene: &Scene) -> Vec<String> {
    let beams = scene.beams.iter().filter(|beam| beam.motion.is_given());
    let mut lines: Vec<String> = beams
        .take(LISTED)
        .map(|beam| format!("supports of {}: moving; its deflections are relative to them", beam.name))
        .collect();
    for block in scene.blocks.iter().filter(|block| block.motion.is_given()).take(LISTED) {
        let axes = ["x", "y", "angle"].iter().zip(&block.motion.0);
        let given: Vec<&str> = axes.filter_map(|(name, axis)| axis.as_ref().map(|_| *name)).collect();
        lines.push(format!("motion of {}: {} prescribed", block.name, given.join(", ")));
    }
    let forces = scene.forces.iter().take(LISTED);
    lines.extend(forces.map(|force| format!("force {}: on {}", force.name, scene.blocks[force.block].name)));
    let loads = scene.loads.iter().take(LISTED);
    lines.extend(loads.map(|load| format!("load {}: on {}", load.name, scene.beams[load.beam].name)));
    lines
}

fn more(n: usize, what: &str) -> Option<String> {
    (n > LISTED).then(|| format!("and {} more", count((n - LISTED) as u64, what)))
}

fn block(block: &BlockPreview) -> String {
    let place = match &block.on {
        Some(on) => format!("on {on}, tilted by {} deg", degrees(block.angle)),
        None => format!("placed by its mass centre, at {} deg", degrees(block.angle)),
    };
    let from =
        if block.flat == 0.0 { String::new() } else { format!(" from lying flat at {} deg", degrees(block.flat)) };
    let overturns = block
        .critical_angle
        .map_or_else(String::new, |angle| format!("; overturns beyond {} deg{from} (critical angle)", degrees(angle)));
    format!("block {}: {}, {place}{overturns}", block.name, with_mass(block.mass))
}

/// Digits are shown if they are fewer than this.
const WORTH_TELLING: f64 = 10.0;

fn beam(beam: &BeamPreview) -> String {
    let mut text = format!(
        "beam {}: {}{}, {}, {}",
        beam.name,
        count(beam.elements as u64, "element"),
        beam.shapes.as_ref().map_or_else(String::new, shapes),
        count(beam.dofs as u64, "degree of freedom"),
        beam.backend
    );
    let nodes = if beam.shapes.is_some() { "" } else { ", all its nodes" };
    let _ = write!(text, "\n    {}{nodes}; ends {}, {}", beam.theory, beam.supports[0], beam.supports[1]);
    if let Some(axial) = beam.axial {
        let _ = write!(text, "; {axial}");
    }
    for what in beam.furniture.iter().take(LISTED) {
        let _ = write!(text, "\n    with {what}");
    }
    if let Some(n) = beam.furniture.len().checked_sub(LISTED).filter(|n| *n > 0) {
        let _ = write!(text, "\n    and {n} more");
    }
    if let Some(frequency) = beam.first_frequency {
        let own = if beam.frequency_is_exact { "the continuous beam" } else { "a mesh eight times as fine" };
        let _ = write!(
            text,
            "\n    first frequency {} Hz (period {}){}",
            digits(frequency.model),
            with_unit(1.0 / frequency.model, "s"),
            match frequency.exact_if_different() {
                Some(beam) =>
                    format!(" of the model, {} the {} Hz of {own}", beside(frequency.model, beam), digits(beam)),
                None if beam.frequency_is_exact => String::new(),
                None => ", of the finite elements".to_owned(),
            }
        );
    }
    if let Some(product) = beam.highest_frequency_step {
        let meaning = if product > 1.0 {
            "above 1, which is usual: such modes are stable, but not resolved in time"
        } else {
            "all modes are resolved in time"
        };
        let _ = write!(
            text,
            "\n    highest frequency of the {} × step = {} ({meaning})",
            if beam.shapes.is_some() { "shapes" } else { "mesh" },
            digits(product)
        );
    }
    // Full precision is not mentioned.
    if let Some(correct) = beam.digits.filter(|correct| *correct < WORTH_TELLING) {
        let few = if correct < FEW_DIGITS { ": too few, use a coarser mesh or a shorter step" } else { "" };
        let _ = write!(text, "\n    {correct:.1} digits of a step's solve are correct{few}");
    }
    if let Some(sag) = beam.sag.filter(|sag| sag.larger() > 0.0) {
        let _ = write!(
            text,
            "\n    sags by {} under {}the resting blocks, {}",
            with_unit(sag.model, "m"),
            if beam.self_weight { "its own weight and " } else { "" },
            wording::part_of(sag.model, beam.span)
        );
        if let Some(own) = sag.exact_if_different() {
            let part = wording::part_of(own, beam.span);
            let _ = write!(text, "; {} the {} ({part}) of a finer mesh", beside(sag.model, own), with_unit(own, "m"));
        }
    }
    if let Some(moment) = beam.yield_moment {
        let _ = write!(text, "\n    yields at a bending moment of {} N m", digits(moment));
    }
    text
}

/// "11 % above"
fn beside(model: f64, beam: f64) -> String {
    let percent = 100.0 * (model / beam - 1.0);
    format!("{:.0} % {}", percent.abs(), if percent < 0.0 { "below" } else { "above" })
}

/// " in 6 modes and 3 static corrections (flexibility over [0.1, 0.26] m to 7e-5)"
fn shapes(shapes: &ShapesPreview) -> String {
    let mut text = format!(" in {}", count(shapes.modes as u64, "mode"));
    if shapes.corrections > 0 {
        let _ = write!(text, " and {}", count(shapes.corrections as u64, "static correction"));
    }
    if let Some(error) = shapes.error {
        let [from, to] = shapes.region;
        let _ = write!(text, " (flexibility over [{from}, {to}] m to {error:.0e})");
    }
    text
}

fn model(scene: &Scene, preview: &Preview) -> Vec<String> {
    let mut lines = vec![
        format!(
            "{}, {}",
            count(preview.possible_contacts as u64, "possible contact"),
            count(preview.dofs as u64, "degree of freedom")
        ),
        format!("contact solver {}, to a residual of {:e}", scene.solver.method, scene.solver.tolerance),
    ];
    if !preview.on_sides.is_empty() {
        let names: BTreeSet<&str> = preview.on_sides.iter().map(|k| scene.contacts[*k].name.as_str()).collect();
        let shown: Vec<&str> = names.iter().take(LISTED).copied().collect();
        let more = if names.len() > LISTED { format!(" and {} more", names.len() - LISTED) } else { String::new() };
        lines.push(format!(
            "besides them, ends of beams and humps under the sides of blocks: contact {}{more}",
            shown.join(", ")
        ));
    }
    if let [first, others @ ..] = preview.coupled_frequencies.as_slice() {
        let all = others.iter().fold(digits(*first), |all, next| format!("{all}, {}", digits(*next)));
        lines.push(format!("small vibrations of blocks and beams about the initial state: {all} Hz"));
    }
    // The default is not mentioned.
    if scene.time.gap_tolerance != 1e-12 {
        lines.push(format!(
            "a gap below {} counts as closed (usually 1 pm; derived from the largest block side unless given)",
            with_unit(scene.time.gap_tolerance, "m")
        ));
    }
    lines
}

fn run(scene: &Scene, preview: &Preview, measured: Option<&Measured>) -> Vec<String> {
    let (time, tables) = (&scene.time, tables(scene, preview, measured));
    if let Some(accuracy) = time.accuracy {
        return vec![format!(
            "to {} s, with the longest steps for an accuracy of {accuracy}, by {}: the run finds them",
            time.end,
            time.scheme.word()
        )];
    }
    let mut lines = vec![
        format!(
            "{} of {} s to {} s, theta = {}{}",
            count(time.steps(), "step"),
            time.step,
            time.steps() as f64 * time.step,
            time.theta,
            // The default is not mentioned.
            if time.scheme == SchemeName::default() { String::new() } else { format!(", by {}", time.scheme.word()) }
        ),
        time_of_run(scene, preview, measured),
        format!("tables: about {} in {} rows", wording::bytes(tables.bytes), tables.rows),
    ];
    lines.extend(preview.memory.map(|bytes| format!("memory: about {}", wording::bytes(bytes))));
    lines
}

/// What was found out about a scene of many contacts.
struct Measured {
    steps: FirstSteps,
    /// Blocks whose motion isn't prescribed.
    free: usize,
    /// How those that fall at first come to lie on each other.
    pile: Option<PileEstimate>,
}

impl Measured {
    /// Contacts at once over the run, on average.
    fn contacts(&self, end: f64) -> usize {
        self.steps.contacts.max(self.pile.as_ref().map_or(0, |pile| pile.contacts(end)))
    }
}

/// The size of the tables: with the contacts that were found, if any.
fn tables(scene: &Scene, preview: &Preview, measured: Option<&Measured>) -> OutputSize {
    match measured.filter(|measured| measured.steps.steps > 0) {
        Some(measured) => OutputSize::with_contacts(scene, measured.contacts(scene.time.end)),
        None => preview.volume,
    }
}

fn time_of_run(scene: &Scene, preview: &Preview, measured: Option<&Measured>) -> String {
    let Some(Measured { steps: measured, free, pile }) = measured else {
        return format!(
            "time: {} (estimated from times measured on a server, accurate {})",
            wording::duration(preview.seconds),
            accuracy_of_seconds(scene)
        );
    };
    if measured.steps == 0 {
        return format!(
            "time: {} (estimated {}; the first step alone takes longer than this check measures)",
            wording::duration(preview.seconds),
            accuracy_of_seconds(scene)
        );
    }
    let end = scene.time.end;
    let writing = |contacts| writing_seconds(scene, contacts);
    let whole = measured.seconds() + writing(measured.contacts);
    if measured.is_whole() {
        return format!("time: {} (measured here, without its tables, which are estimated)", wording::duration(whole));
    }
    let others = match measured.steps - 1 {
        0 => "its first step".to_owned(),
        n => format!("{} for its first step, {} for each of the next {n}", spent(measured.first), spent(measured.each)),
    };
    let contacts = count(measured.contacts as u64, "contact");
    if let Some(pile) = pile {
        let of_pile = pile.seconds(end, scene.time.step);
        let [jams, lies] = pile.steps();
        let when = match pile.landing(end) {
            Some(last) => format!("all from some {} on", wording::seconds(last, 1)),
            None if pile.part_landed(end) > 0.0 => "not all before the end".to_owned(),
            None => "none before the end".to_owned(),
        };
        return format!(
            "time: {}, to a factor of three\n    \
             (measured here: {others}, with {contacts} of {free} blocks; estimated: {} a step while all blocks jam, {} once they \
             lie on each other, {when})",
            wording::duration(measured.seconds() + of_pile + writing(pile.contacts(end))),
            spent(jams),
            spent(lies)
        );
    }
    format!(
        "time: {}, to a factor of three while the motion stays as it starts\n    \
         (measured here: {others}, with {contacts}; blocks that begin to slide or fall cost more)",
        wording::duration(whole)
    )
}

/// A CPU time in two digits: 2.7 s, 130 ms, 85 us.
fn spent(seconds: f64) -> String {
    let (value, unit) = match seconds {
        long if long >= 1.0 => (long, "s"),
        short if short >= 1e-3 => (1e3 * short, "ms"),
        short => (1e6 * short, "us"),
    };
    let rounded: f64 = format!("{value:.1e}").parse().unwrap_or(value);
    format!("{rounded} {unit}")
}

fn count(n: u64, what: &str) -> String {
    match (n, what.strip_prefix("degree")) {
        (1, _) => format!("1 {what}"),
        (_, Some(rest)) => format!("{n} degrees{rest}"),
        (_, None) => format!("{n} {what}s"),
    }
}

fn degrees(radians: f64) -> String {
    digits(radians.to_degrees())
}

/// A number with four digits.
fn digits(x: f64) -> String {
    shortest(x, 4)
}
