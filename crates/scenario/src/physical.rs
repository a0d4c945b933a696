//! The physical data of a scene in words, as a page shows them: sizes, masses, sections, friction.

use crate::mesh_error;
use crate::scene::{BeamScene, BlockPart, BlockScene, ContactScene, Matter, Scene};
use crate::simulation::{BeamPlace, Layout};
use crate::wording;
use teeter_beam::Damping;
use teeter_detect::Shape;
use teeter_integrator::ImpactLaw;
use teeter_text::readable::{shortest, with_mass, with_unit};

/// Bodies and contacts of a table at most.
pub const LISTED: usize = 20;

/// Elements up to which a first frequency without a closed form is looked for: it is only to be shown.
const QUICK: usize = 500;

/// A table of physical data: what is not given or not known is a dash; columns of dashes only are left out.
#[derive(Debug, Clone, PartialEq)]
pub struct PhysicalTable {
    /// What its rows are: `Blocks`.
    pub title: &'static str,
    /// The names of its columns, that of the rows first.
    pub head: Vec<&'static str>,
    /// Its rows.
    pub rows: Vec<Vec<String>>,
    /// How many more there are.
    pub more: usize,
    /// What is to be said of its columns; empty if nothing is.
    pub note: String,
}

/// The tables of blocks, beams and contacts of a scene, without those that would be empty.
#[must_use]
pub fn tables(scene: &Scene, layout: &Layout) -> Vec<PhysicalTable> {
    let gravity = scene.gravity[0].hypot(scene.gravity[1]);
    let blocks = scene.blocks.iter().take(LISTED).map(|of| block(of, gravity)).collect();
    let beams = scene.beams.iter().zip(&layout.beams).take(LISTED).map(|(of, place)| beam(of, place)).collect();
    // A [contact] of patterns joins many pairs by one law.
    let mut laws: Vec<(&ContactScene, usize)> = Vec::new();
    for of in &scene.contacts {
        match laws.last_mut().filter(|(first, _)| first.name == of.name && first.law == of.law) {
            Some((_, pairs)) => *pairs += 1,
            None => laws.push((of, 1)),
        }
    }
    let contacts = laws.iter().take(LISTED).map(|(of, pairs)| contact(scene, of, *pairs)).collect();
    let has = |is: fn(&BlockScene) -> bool| scene.blocks.iter().take(LISTED).any(is);
    let is_power = |of: &ContactScene| matches!(of.law.impact, ImpactLaw::HuntCrossley { .. });
    let of_blocks = [
        ("Size", has(|of| of.parts.is_none()), "Size of a rectangle: width b × height H × depth"),
        ("Size", has(|of| of.parts.is_some() && diameter(of).is_none()), "extents: of the block before it is turned"),
        ("α", true, "α = atan(b/H)"),
        ("p", true, "p = √(3g/(4R)), R half the diagonal"),
    ];
    let of_beams = [("ρA", true, "ρA: mass per length")];
    let is_told = laws.iter().take(LISTED).any(|(of, _)| is_power(of));
    let of_contacts = [("Law", is_told, "Hunt–Crossley: force k δⁿ (1 + d dδ/dt) at a penetration δ")];
    let beam_columns = ["Beam", "Span", "Thickness", "EI", "ρA", "f₁", "Damping", "Supports"];
    let tables = [
        table("Blocks", &["Block", "Size", "Mass", "α", "p"], blocks, scene.blocks.len(), &of_blocks),
        table("Beams", &beam_columns, beams, scene.beams.len(), &of_beams),
        table("Contacts", &["Contact", "Between", "μ", "e", "Law"], contacts, laws.len(), &of_contacts),
    ];
    tables.into_iter().flatten().collect()
}

const NOTHING: &str = "–";

/// A table without the columns in which all cells are dashes; of `notes`, each of a column, those that are true of it.
fn table(
    title: &'static str,
    head: &[&'static str],
    mut rows: Vec<Vec<String>>,
    all: usize,
    notes: &[(&str, bool, &'static str)],
) -> Option<PhysicalTable> {
    let shown: Vec<bool> = (0..head.len()).map(|k| rows.iter().any(|row| row[k] != NOTHING)).collect();
    let is_shown = |k: usize| shown.get(k).copied().unwrap_or(false);
    for row in &mut rows {
        let mut k = 0..;
        row.retain(|_| k.next().is_some_and(is_shown));
    }
    let head: Vec<&str> = head.iter().enumerate().filter(|(k, _)| is_shown(*k)).map(|(_, name)| *name).collect();
    let more = all - rows.len();
    let notes = notes.iter().filter(|(column, is_true, _)| *is_true && head.contains(column));
    let note = notes.map(|(.., text)| *text).collect::<Vec<_>>().join("; ");
    (!rows.is_empty()).then_some(PhysicalTable { title, head, rows, more, note })
}

fn or_nothing(value: Option<String>) -> String {
    value.unwrap_or_else(|| NOTHING.to_owned())
}

/// The diameter of a block that is a disc, m.
fn diameter(of: &BlockScene) -> Option<f64> {
    match of.parts.as_deref() {
        Some([BlockPart { shape: Shape::Disc(disc), .. }]) => Some(2.0 * disc.radius()),
        _ => None,
    }
}

/// The sides of a rectangle, the diameter of a disc, of other shapes how far they extend along their own axes; with the depth, if it is known.
fn size(of: &BlockScene) -> String {
    let depth = match of.matter {
        Matter::Homogeneous { depth, .. } => Some(with_unit(depth, "m")),
        Matter::Given(_) => None,
    };
    let sides = |sides: [f64; 2]| sides.map(|side| with_unit(side, "m")).join(" × ");
    if of.parts.is_none() {
        return [Some(sides([of.width, of.height])), depth].into_iter().flatten().collect::<Vec<_>>().join(" × ");
    }
    let size = match diameter(of) {
        Some(diameter) => format!("diameter {}", with_unit(diameter, "m")),
        None => {
            let corners = of.corners();
            let extent = |axis: usize| {
                let reaches = corners.iter().enumerate().map(|(k, corner)| (corner[axis], of.corner_radius(k)));
                let ends = reaches.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], (at, radius)| {
                    [low.min(at - radius), high.max(at + radius)]
                });
                ends[1] - ends[0]
            };
            format!("extents {}", sides([extent(0), extent(1)]))
        }
    };
    match depth {
        Some(depth) => format!("{size}, depth {depth}"),
        None => size,
    }
}

/// Size, mass, α and Housner's p of an upright rectangle.
fn block(of: &BlockScene, gravity: f64) -> Vec<String> {
    let alpha = of.critical_angle();
    // p² = m g R / I of the corner, which is 3 g / (4 R) of a homogeneous one.
    let homogeneous = of.parts.is_none() && matches!(of.matter, Matter::Homogeneous { .. }) && gravity > 0.0;
    let p = homogeneous.then(|| (0.75 * gravity / of.radius()).sqrt());
    vec![
        of.name.clone(),
        size(of),
        with_mass(of.mass()),
        or_nothing(alpha.map(|alpha| format!("{}°", shortest(alpha.to_degrees(), 4)))),
        or_nothing(p.map(|p| format!("{} rad/s", shortest(p, 4)))),
    ]
}

fn beam(of: &BeamScene, place: &BeamPlace) -> Vec<String> {
    let spec = &of.spec;
    let section = &spec.section;
    let varies = if spec.segments.is_empty() { "" } else { ", varies" };
    let frequency = mesh_error::model_frequency(&place.beam, place.basis.as_deref(), QUICK);
    let mut supports: Vec<String> = vec![spec.supports.map(wording::held).join(", ")];
    supports.extend(wording::furniture(spec));
    vec![
        of.name.clone(),
        with_unit(spec.span, "m"),
        or_nothing((of.thickness > 0.0).then(|| with_unit(of.thickness, "m"))),
        format!("{}{varies}", with_unit(section.bending_stiffness, "N m²")),
        format!("{} kg/m{varies}", shortest(section.mass_per_length, 4)),
        or_nothing(frequency.map(|frequency| with_unit(frequency, "Hz"))),
        or_nothing(damping(&spec.damping)),
        supports.join("; "),
    ]
}

fn damping(of: &Damping) -> Option<String> {
    let plain = |value: f64, unit: &str| format!("{} {unit}", shortest(value, 4));
    let named = [
        ("c", of.viscous, plain(of.viscous, "N s/m²")),
        ("a₀", of.rayleigh_mass, plain(of.rayleigh_mass, "1/s")),
        // Some microseconds, for which there is a prefix.
        ("a₁", of.rayleigh_stiffness, with_unit(of.rayleigh_stiffness, "s")),
    ];
    let named = named.into_iter().filter(|(_, value, _)| *value != 0.0);
    let mut told: Vec<String> = named.map(|(name, _, told)| format!("{name} = {told}")).collect();
    if !of.modal.is_empty() {
        let ratios: Vec<String> = of.modal.iter().take(4).map(|ratio| shortest(*ratio, 3)).collect();
        let more = if of.modal.len() > ratios.len() { ", …" } else { "" };
        told.push(format!("ζ = {}{more}", ratios.join(", ")));
    }
    (!told.is_empty()).then(|| told.join("; "))
}

/// How many pairs a contact has beside the one that is named, in words after that.
fn more_pairs(pairs: usize) -> String {
    match pairs.saturating_sub(1) {
        0 => String::new(),
        1 => " and 1 more pair".to_owned(),
        more => format!(" and {more} more pairs"),
    }
}

fn contact(scene: &Scene, of: &ContactScene, pairs: usize) -> Vec<String> {
    let [low, high] = of.friction_of_feet();
    let friction =
        if low == high { shortest(low, 4) } else { format!("{} to {}", shortest(low, 4), shortest(high, 4)) };
    let bodies = format!("{}, {}", scene.blocks[of.block].name, scene.name_of(of.surface));
    let between = bodies + &more_pairs(pairs);
    let (restitution, law) = match of.law.impact {
        ImpactLaw::Newton => (Some(of.law.restitution), None),
        ImpactLaw::Poisson => (Some(of.law.restitution), Some("Poisson".to_owned())),
        ImpactLaw::Energetic => (Some(of.law.restitution), Some("energetic".to_owned())),
        ImpactLaw::KelvinVoigt { stiffness, damping } => {
            let [k, c] = [with_unit(stiffness, "N/m"), with_unit(damping, "N s/m")];
            (None, Some(format!("Kelvin–Voigt, k = {k}, c = {c}")))
        }
        ImpactLaw::HuntCrossley { stiffness, damping, exponent } => {
            let n = shortest(exponent, 4);
            let [k, d] = [with_unit(stiffness, &format!("N/m^{n}")), with_unit(damping, "s/m")];
            (None, Some(format!("Hunt–Crossley, k = {k}, d = {d}, n = {n}")))
        }
        _ => (None, Some("with duration".to_owned())),
    };
    vec![of.name.clone(), between, friction, or_nothing(restitution.map(|e| shortest(e, 4))), or_nothing(law)]
}

#[cfg(test)]
mod tests {
    use crate::simulation::Simulation;

    #[test]
    fn one_more_pair_is_told_as_one() {
        assert_eq!([1, 2, 3].map(super::more_pairs), ["", " and 1 more pair", " and 2 more pairs"]);
    }

    #[test]
    fn the_data_of_a_scene_are_those_of_its_file() {
        let text = "[time]\nend = '1 s'\nstep = '100 us'\n[material.a]\ndensity = '2700 kg/m^3'\nyoungs_modulus = '70 GPa'\n\
            [beam.footing]\nmaterial = 'a'\nspan = '3 m'\nwidth = '10 cm'\nthickness = '2 cm'\nelements = 12\n\
            supports = ['free', 'free']\nfoundation.soil = { stiffness = '20 MN/m^2' }\nmass.pump = { at = '2.4 m', mass = '40 kg' }\n\
            support.a = { at = '1 m', spring = '5 MN/m', dashpot = '2 kN s/m' }\ndamping_ratio = { mode = 1, ratio = 0.02 }\n\
            [block.b]\nmaterial = 'a'\nwidth = '10 cm'\nheight = '40 cm'\ndepth = '10 cm'\non = 'footing'\nat = '1.5 m'\n\
            [contact.feet]\nbetween = ['b', 'footing']\nfriction = 0.5\nrestitution = 0.1\n";
        let resolved = crate::load(text.as_bytes(), "f", "f", &[]).unwrap();
        let simulation = Simulation::new(&resolved.scene).unwrap();
        let tables = super::tables(&resolved.scene, &simulation.layout);
        let titles: Vec<&str> = tables.iter().map(|table| table.title).collect();
        assert_eq!(titles, ["Blocks", "Beams", "Contacts"]);
        // p = √(3 g/(4 R)) with R = 0.2062 m.
        assert_eq!(tables[0].rows, [["b", "100 mm × 400 mm × 100 mm", "10.8 kg", "14.04°", "5.974 rad/s"]]);
        assert_eq!(tables[1].head[..5], ["Beam", "Span", "Thickness", "EI", "ρA"]);
        assert_eq!(tables[1].rows[0][1..5], ["3 m", "20 mm", "4.667 kN m²", "5.4 kg/m"]);
        let supports = tables[1].rows[0].last().unwrap();
        for part in
            ["free, free", "20 MN/m²", "spring of 5 MN/m and dashpot of 2 kN s/m at 1 m", "mass of 40 kg at 2.4 m"]
        {
            assert!(supports.contains(part), "{part}: {supports}");
        }
        assert_eq!(tables[2].head, ["Contact", "Between", "μ", "e"], "Newton's law is the usual one");
        assert_eq!(tables[2].rows, [["feet", "b, footing", "0.5", "0.1"]]);
        let notes: Vec<&str> = tables.iter().map(|table| table.note.as_str()).collect();
        let of_blocks =
            "Size of a rectangle: width b × height H × depth; α = atan(b/H); p = √(3g/(4R)), R half the diagonal";
        assert_eq!(notes, [of_blocks, "ρA: mass per length", ""]);
    }

    #[test]
    fn sizes_are_those_of_the_shape_and_a_law_with_duration_has_its_numbers() {
        let text = "[time]\nend = '1 s'\nstep = '100 us'\n[material.a]\ndensity = '2700 kg/m^3'\n[ground]\n\
            [block.roll]\nmaterial = 'a'\nradius = '10 cm'\ndepth = '5 cm'\nposition = ['0 m', '1 m']\n\
            [block.wedge]\nmaterial = 'a'\npoints = [['0 m', '0 m'], ['30 cm', '0 m'], ['0 m', '40 cm']]\ndepth = '5 cm'\n\
            position = ['2 m', '1 m']\n\
            [contact.feet]\nbetween = ['roll', 'ground']\nfriction = 0.5\nlaw = 'hunt-crossley'\nstiffness = '1e8 N/m^1.5'\n\
            damping = '0.2 s/m'\n";
        let resolved = crate::load(text.as_bytes(), "f", "f", &[]).unwrap();
        let simulation = Simulation::new(&resolved.scene).unwrap();
        let tables = super::tables(&resolved.scene, &simulation.layout);
        let sizes: Vec<&str> = tables[0].rows.iter().map(|row| row[1].as_str()).collect();
        assert_eq!(sizes, ["diameter 200 mm, depth 50 mm", "extents 300 mm × 400 mm, depth 50 mm"]);
        assert_eq!(tables[0].note, "extents: of the block before it is turned");
        assert_eq!(tables[1].rows[0].last().unwrap(), "Hunt–Crossley, k = 100 MN/m^1.5, d = 200 ms/m, n = 1.5");
        assert!(tables[1].note.starts_with("Hunt–Crossley: force k δⁿ"), "{}", tables[1].note);
    }
}
