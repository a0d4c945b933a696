//! Blocks of other shapes: discs, kinds of polygons, roundings, parts.

use std::f64::consts::PI;
use teeter_integrator::Ended;
use teeter_rigid::MassProperties;
use teeter_scenario::load;
use teeter_scenario::scene::{BlockScene, Scene};
use teeter_scenario::simulation::Simulation;

const HEAD: &str = "[time]\nend = '1 s'\nstep = '1 ms'\n[ground]\n[material.m]\ndensity = '2000 kg/m^3'\n";

fn scene(text: &str) -> Scene {
    load(text.as_bytes(), "scene", "scene", &[]).unwrap_or_else(|errors| panic!("{errors}\n{text}")).scene
}

/// A block of these keys, 10 cm deep.
fn block(keys: &str) -> BlockScene {
    let text = format!("{HEAD}[block.b]\nmaterial = 'm'\ndepth = '10 cm'\nposition = ['0 m', '1 m']\n{keys}\n");
    scene(&text).blocks.remove(0)
}

fn told(keys: &str) -> String {
    let text = format!("{HEAD}[block.b]\nposition = ['0 m', '1 m']\n{keys}\n");
    load(text.as_bytes(), "scene", "scene", &[]).map(|_| ()).unwrap_err().to_string()
}

/// What stands on the ground, with this friction, and how it has ended.
fn run(ground: &str, keys: &str, friction: f64, end: &str) -> Simulation {
    let text = format!(
        "[time]\nend = '{end}'\nstep = '1 ms'\n{ground}\n[material.m]\ndensity = '2000 kg/m^3'\n[block.b]\n\
         material = 'm'\ndepth = '10 cm'\n{keys}\n[contact.c]\nbetween = ['b', 'ground']\nfriction = {friction:?}\n"
    );
    let mut simulation = Simulation::new(&scene(&text)).unwrap_or_else(|error| panic!("{error}\n{text}"));
    assert_eq!(simulation.run(&mut []).unwrap(), Ended::Complete);
    simulation
}

fn assert_near(got: f64, wanted: f64, within: f64, what: &str) {
    assert!((got - wanted).abs() <= within * wanted.abs().max(1e-300), "{what}: {got}, not {wanted}");
}

#[test]
fn mass_and_inertia_are_those_of_the_shape() {
    // By formulas of their own: a disc, a regular hexagon of side a, a stadium by rectangle and disc.
    let per_area = 2000.0 * 0.1;
    let check = |keys: &str, area: f64, polar: f64| {
        let of = block(keys).mass_properties().unwrap();
        assert_near(of.mass, per_area * area, 1e-12, keys);
        assert_near(of.inertia, per_area * polar, 1e-12, keys);
    };
    check("radius = '5 cm'", PI * 0.0025, 0.5 * PI * 0.05_f64.powi(4));
    let a: f64 = 0.05;
    let hexagon = (1.5 * 3.0_f64.sqrt() * a * a, 5.0 * 3.0_f64.sqrt() / 8.0 * a.powi(4));
    check("shape = { kind = 'regular', sides = 6, radius = '5 cm' }", hexagon.0, hexagon.1);
    // About its centre: the rectangle l × 2r, and two halves of a disc at ± l/2.
    let (l, r) = (0.06_f64, 0.02_f64);
    let halves = 0.5 * PI * r.powi(4) + PI * r * r * 0.25 * l * l + 2.0 * 0.5 * l * 2.0 / 3.0 * r.powi(3) * 2.0;
    check(
        "shape = { kind = 'stadium', length = '6 cm', radius = '2 cm' }",
        2.0 * l * r + PI * r * r,
        2.0 * l * r * (l * l + 4.0 * r * r) / 12.0 + halves,
    );
    // A rectangle by a trapezoid with equal sides, and the same with a corner cut at each end.
    check(
        "shape = { kind = 'trapezoid', bottom = '8 cm', top = '8 cm', height = '4 cm' }",
        0.0032,
        0.0032 * (0.0064 + 0.0016) / 12.0,
    );
    let c: f64 = 0.004;
    // Four right triangles with legs c (c⁴/18 about their centres), whose centres are a third of c from both sides.
    let (x, y) = (0.04 - c / 3.0, 0.02 - c / 3.0);
    let cut = 4.0 * (c.powi(4) / 18.0 + 0.5 * c * c * (x * x + y * y));
    check(
        "width = '8 cm'\nheight = '4 cm'\nchamfer = '4 mm'",
        0.0032 - 2.0 * c * c,
        0.0032 * (0.0064 + 0.0016) / 12.0 - cut,
    );
    let given = block("width = '8 cm'\nheight = '4 cm'\nrounding = '4 mm'");
    assert_near(given.mass(), per_area * (0.0032 - (4.0 - PI) * c * c), 1e-12, "rounded");
    assert_eq!((given.corner_name(0), given.width, given.height), ("bottom-left".to_owned(), 0.08, 0.04));
}

#[test]
fn parts_of_several_materials_have_a_common_mass_centre() {
    let text = format!(
        "{HEAD}[material.heavy]\ndensity = '4000 kg/m^3'\n[block.b]\ndepth = '10 cm'\nmaterial = 'm'\n\
         parts = [{{ width = '10 cm', height = '10 cm' }}, {{ width = '10 cm', height = '10 cm', at = ['20 cm', '0 cm'], \
         angle = '90 deg', material = 'heavy' }}, {{ radius = '1 cm', at = ['10 cm', '0 cm'] }}]\n"
    );
    let scene = scene(&text);
    let of = &scene.blocks[0];
    let (light, heavy, disc) = (0.1 * 0.1 * 0.1 * 2000.0, 0.1 * 0.1 * 0.1 * 4000.0, PI * 1e-4 * 0.1 * 2000.0);
    assert_near(of.mass(), light + heavy + disc, 1e-12, "mass");
    let centre = (0.2 * heavy + 0.1 * disc) / (light + heavy + disc);
    let at = |x: f64| (x - centre).powi(2);
    let own = 0.02 / 12.0 * (light + heavy) + 0.5 * disc * 1e-4;
    let polar = own + light * at(0.0) + heavy * at(0.2) + disc * at(0.1);
    assert_near(of.mass_properties().unwrap().inertia, polar, 1e-12, "inertia");
    let teeter_scenario::scene::Placement::Free { position, .. } = of.placement else { panic!("{of:?}") };
    assert_near(position[0], centre, 1e-12, "where it is drawn");
    assert_eq!((of.corner_name(4), of.corner_name(8)), ("part-2.bottom-left".to_owned(), "part-3.rim".to_owned()));
    let found = load(text.as_bytes(), "scene", "scene", &[]).unwrap().warnings;
    let warnings: Vec<String> = found.iter().map(ToString::to_string).collect();
    assert!(!warnings.iter().any(|warning| warning.contains("not used")), "{warnings:?}");
}

#[test]
fn given_mass_and_inertia_replace_material_and_depth() {
    let text = format!(
        "{HEAD}[block.b]\nradius = '5 cm'\nmass = '2 kg'\ninertia = '3e-4 kg m^2'\nposition = ['0 m', '1 m']\n"
    );
    let given = MassProperties::new(2.0, 3e-4).unwrap();
    assert_eq!(scene(&text).blocks[0].mass_properties().unwrap(), given);
}

/// A disc without slip: ẍ = ⅔ g sin α along the slope, and it turns by x/r. With little friction it
/// slides at g (sin α − μ cos α).
#[test]
fn a_disc_rolls_down_a_slope() {
    let (angle, r) = (10.0_f64.to_radians(), 0.05);
    for (friction, rate) in [(0.4, 2.0 / 3.0 * angle.sin()), (0.02, angle.sin() - 0.02 * angle.cos())] {
        let end = run("[ground]\nincline = '10 deg'", "radius = '5 cm'\non = 'ground'\nat = '0 m'", friction, "1 s");
        let [x, y, phi] = [0, 1, 2].map(|k| end.state.q[k]);
        let down = 0.5 * 9.81 * rate;
        let start = [-r * angle.sin(), r * angle.cos()];
        assert_near(x - start[0], -down * angle.cos(), 1e-9, "x");
        assert_near(y - start[1], -down * angle.sin(), 1e-9, "y");
        // Without slip φ = s/r; a sliding one turns by its friction, r μ m g cos α / I.
        let turn = if friction > 0.1 { down / r } else { 9.81 * friction * angle.cos() / r };
        assert_near(phi - angle, turn, 1e-9, "φ");
    }
}

/// A stadium tilted onto one of its half circles rocks until it lies on its side.
#[test]
fn shapes_come_to_rest_on_their_sides() {
    let end = run(
        "[ground]",
        "shape = { kind = 'stadium', length = '6 cm', radius = '2 cm' }\non = 'ground'\nat = '0 m'\ntilt = '30 deg'",
        0.5,
        "4 s",
    );
    assert!((end.state.q[1] - 0.02).abs() < 1e-6 && end.state.q[2].abs() < 1e-4, "{:?}", end.state.q);
    let hexagon = "shape = { kind = 'regular', sides = 6, radius = '5 cm' }\non = 'ground'\nat = '1 m'";
    let end = run("[ground]", hexagon, 0.5, "0.2 s");
    assert!((end.state.q[1] - 0.05 * (PI / 6.0).cos()).abs() < 1e-12 && (end.state.q[0] - 1.0).abs() < 1e-12);
}

#[test]
fn every_shape_is_placed_by_its_lowest_point() {
    let height = |keys: &str| {
        let text = format!(
            "{HEAD}[block.b]\nmaterial = 'm'\ndepth = '10 cm'\n{keys}\n[contact.c]\nbetween = ['b', 'ground']\nfriction = 0.5\n"
        );
        let simulation = Simulation::new(&scene(&text)).unwrap();
        let of = &scene(&text).blocks[0];
        let (q, corners) = (&simulation.state.q, of.corners());
        let low = |k: usize| q[1] + corners[k].x * q[2].sin() + corners[k].y * q[2].cos() - of.corner_radius(k);
        (0..corners.len()).map(low).fold(f64::INFINITY, f64::min)
    };
    for shape in [
        "radius = '5 cm'",
        "shape = { kind = 'regular', sides = 5, radius = '5 cm' }",
        "shape = { kind = 'trapezoid', bottom = '8 cm', top = '5 cm', height = '4 cm', shift = '1 cm' }",
        "shape = { kind = 'stadium', length = '6 cm', radius = '2 cm' }",
        "points = [['0 cm', '0 cm'], ['30 cm', '0 cm'], ['20 cm', '15 cm']]",
        "width = '8 cm'\nheight = '4 cm'\nrounding = '1 cm'",
        "parts = [{ width = '4 cm', height = '2 cm' }, { radius = '1 cm', at = ['0 cm', '2 cm'] }]",
    ] {
        for tilt in ["0 deg", "10 deg", "-25 deg"] {
            let low = height(&format!("{shape}\non = 'ground'\nat = '3 cm'\ntilt = '{tilt}'"));
            assert!(low.abs() < 1e-15, "{shape}, {tilt}: {low:e}");
        }
    }
}

/// A disc in the notch of two others, and a block on a trapezoid: dropped on what is below them.
#[test]
fn blocks_stand_on_any_shape() {
    let text = format!(
        "{HEAD}[block.a]\nmaterial = 'm'\ndepth = '1 m'\nradius = '10 cm'\non = 'ground'\nat = '0 m'\n\
         [block.b]\nmaterial = 'm'\ndepth = '1 m'\nradius = '5 cm'\non = 'a'\nat = '9 cm'\n\
         [block.c]\nmaterial = 'm'\ndepth = '1 m'\nshape = {{ kind = 'trapezoid', bottom = '8 cm', top = '5 cm', height = '4 cm' }}\n\
         on = 'ground'\nat = '1 m'\nrepeat = {{ count = 3, stacked = true }}\n\
         [contact.d]\nbetween = ['*', '*']\nfriction = 0.5\n[contact.g]\nbetween = ['c-1', 'ground']\nfriction = 0.5\n"
    )
    .replace("[contact.g]", "[contact.h]\nbetween = ['a', 'c-2']\nfriction = 0.1\n[contact.g]");
    let text = format!("{text}[contact.k]\nbetween = ['a', 'ground']\nfriction = 0.5\n");
    let simulation = Simulation::new(&scene(&text)).unwrap();
    let q = &simulation.state.q;
    assert_near((q[3] - q[0]).hypot(q[4] - q[1]), 0.15, 1e-14, "the disc on the disc");
    let centre = 0.04 / 3.0 * (0.08 + 2.0 * 0.05) / 0.13;
    for (k, first) in [6, 9, 12].into_iter().enumerate() {
        assert!((q[first] - 1.0).abs() < 1e-15, "{q:?}");
        assert_near(q[first + 1], 0.04 * k as f64 + centre, 1e-14, "the pile of trapezoids");
    }
}

#[test]
fn a_fixed_block_stays() {
    let text = format!(
        "{HEAD}[block.post]\nmaterial = 'm'\ndepth = '1 m'\nwidth = '20 cm'\nheight = '10 cm'\nposition = ['0 m', '1 m']\nfixed = true\n\
         [block.b]\nmaterial = 'm'\ndepth = '1 m'\nradius = '5 cm'\nposition = ['2 cm', '1.15 m']\n\
         [contact.c]\nbetween = ['b', 'post']\nfriction = 0.5\n"
    );
    let mut simulation = Simulation::new(&scene(&text)).unwrap();
    assert_eq!(simulation.run(&mut []).unwrap(), Ended::Complete);
    assert_eq!(simulation.state.q[..3], [0.0, 1.0, 0.0]);
    assert!((simulation.state.q[4] - 1.10).abs() < 1e-9, "it lands on the post");
}

#[test]
fn bad_shapes_are_refused_with_what_would_be_right() {
    let of = |keys: &str| told(&format!("material = 'm'\ndepth = '1 m'\n{keys}"));
    for (keys, wanted) in [
        ("radius = '5 cm'\nwidth = '1 cm'", "radius already gives the shape"),
        ("radius = '5 cm'\nrounding = '1 cm'", "the shape has no corners"),
        ("radius = '-5 cm'", "must be greater than 0 m"),
        ("width = '8 cm'\nheight = '4 cm'\nrounding = '2 cm'", "give a radius of less than 0.02 m"),
        ("width = '8 cm'\nheight = '4 cm'\nchamfer = '2 cm'", "give less than 0.02 m"),
        ("width = '8 cm'\nheight = '4 cm'\nchamfer = '1 cm'\nrounding = '1 cm'", "give rounding or chamfer"),
        ("width = '8 cm'", "block.b.height: missing"),
        ("shape = { kind = 'regular', radius = '5 cm' }", "block.b.shape.sides: missing"),
        ("shape = { kind = 'regular', sides = 2, radius = '5 cm' }", "must be at least 3"),
        ("shape = { kind = 'regular', sides = 5, radius = '5 cm', top = '1 cm' }", "block.b.shape.top"),
        (
            "shape = { kind = 'voussoir', inner = '2 m', outer = '1 m', from = '0 deg', to = '9 deg' }",
            "must be more than inner",
        ),
        (
            "shape = { kind = 'voussoir', inner = '1 m', outer = '2 m', from = '9 deg', to = '0 deg' }",
            "to must be larger",
        ),
        ("radius = '5 cm'\ncentre = ['0 m', '0 m']", "position already gives the place"),
        ("parts = []", "there are no parts"),
        ("parts = [{ radius = '1 cm' }, { at = ['0 m', '0 m'] }]", "part 2: the shape is missing"),
        ("parts = [{ radius = '1 cm', colour = 3 }]", "unknown key"),
        ("parts = [{ width = '1 cm' }]", "part 1: height: height is missing"),
        ("parts = [{ shape = { kind = 'regular', sides = 5 } }]", "radius is missing"),
        ("radius = '5 cm'\nmass = '1 kg'", "mass needs inertia"),
        ("radius = '5 cm'\nmass = '1 kg'\ninertia = '1 kg m^2'", "mass and inertia are given already"),
        ("radius = '5 cm'\nfixed = true\nmotion = { velocity = ['1 m/s', '0 m/s'] }", "a fixed block has no motion"),
    ] {
        let found = of(keys);
        assert!(found.contains(wanted), "{keys}:\n{found}");
    }
    let found = told("depth = '1 m'\nradius = '5 cm'");
    assert!(found.contains("block.b.material: missing"), "{found}");
    let found = told("material = 'm'\ndepth = '1 m'");
    assert!(found.contains("block.b.width: missing") && found.contains("block.b.height: missing"), "{found}");
}

/// The contacts of a scene: their names, and the bodies.
fn joined(contacts: &str) -> Vec<String> {
    let text = format!(
        "{HEAD}[material.s]\ndensity = '8000 kg/m^3'\nyoungs_modulus = '210 GPa'\n\
         [beam.b]\nmaterial = 's'\nspan = '1 m'\nwidth = '1 cm'\nthickness = '1 cm'\nelements = 4\nposition = ['9 m', '0 m']\n\
         [block.stone]\nmaterial = 'm'\nradius = '5 cm'\ndepth = '1 m'\nposition = ['0 m', '1 m']\nrepeat = {{ count = 2, shift = ['1 m', '0 m'] }}\n\
         [block.wall]\nmaterial = 's'\nwidth = '5 cm'\nheight = '1 m'\ndepth = '1 m'\nposition = ['3 m', '1 m']\nfixed = true\n\
         repeat = {{ count = 2, shift = ['1 m', '0 m'] }}\n{contacts}"
    );
    let joined =
        |contact: &teeter_scenario::scene::ContactScene| format!("{} {}", contact.name, contact.between.join(" "));
    scene(&text).contacts.iter().map(joined).collect()
}

#[test]
fn a_pattern_for_all_joins_all_that_can_touch() {
    let all = joined("[contact.all]\nbetween = ['*', '*']\nfriction = 0.5\n");
    // No wall with a wall or the ground, as neither can move, no beam with the ground.
    let expected = [
        "stone-1 stone-2",
        "stone-1 wall-1",
        "stone-1 wall-2",
        "stone-1 b",
        "stone-1 ground",
        "stone-2 wall-1",
        "stone-2 wall-2",
        "stone-2 b",
        "stone-2 ground",
        "wall-1 b",
        "wall-2 b",
    ];
    assert_eq!(all, expected.map(|pair| format!("all {pair}")));
}

#[test]
fn the_contact_that_says_most_of_a_pair_holds() {
    let all = joined(
        "[contact.all]\nbetween = ['*', '*']\nfriction = 0.1\n[contact.steel]\nmaterials = ['m', 's']\nfriction = 0.2\n\
         [contact.near]\nbetween = ['stone-?', 'wall-1']\nfriction = 0.3\n[contact.own]\nbetween = ['stone-2', 'wall-1']\nfriction = 0.4\n\
         [world]\napart = [['wall-*', 'b'], ['stone-1', 'ground']]\n",
    );
    let expected = [
        "own stone-2 wall-1",
        "all stone-1 stone-2",
        "all stone-2 ground",
        "steel stone-1 b",
        "steel stone-1 wall-2",
        "steel stone-2 b",
        "steel stone-2 wall-2",
        "near stone-1 wall-1",
    ];
    let mut found = all.clone();
    let mut expected = expected.map(str::to_owned).to_vec();
    found.sort();
    expected.sort();
    assert_eq!(found, expected);
    assert_eq!(all[0], "own stone-2 wall-1", "full names come first");
}

#[test]
fn contacts_that_contradict_each_other_are_refused() {
    let told = |contacts: &str| {
        let text = format!(
            "{HEAD}[block.a]\nmaterial = 'm'\nradius = '5 cm'\ndepth = '1 m'\nposition = ['0 m', '1 m']\n\
             [block.b]\nmaterial = 'm'\nradius = '5 cm'\ndepth = '1 m'\nposition = ['1 m', '1 m']\n{contacts}"
        );
        load(text.as_bytes(), "scene", "scene", &[]).map(|_| ()).unwrap_err().to_string()
    };
    let tie =
        told("[contact.x]\nbetween = ['a', '*']\nfriction = 0.1\n[contact.y]\nbetween = ['*', 'b']\nfriction = 0.2\n");
    assert!(tie.contains("it says no more of the bodies than `x`") && tie.contains("`a` and `b`"), "{tie}");
    let apart = told("[contact.x]\nbetween = ['a', 'b']\nfriction = 0.1\n[world]\napart = [['a', 'b']]\n");
    assert!(apart.contains("according to world.apart"), "{apart}");
    assert!(told("[contact.x]\nmaterials = ['m', 'n']\nfriction = 0.1\n").contains("`n` is not defined"));
    let both = told("[contact.x]\nmaterials = ['m', 'm']\nbetween = ['a', 'b']\nfriction = 0.1\n");
    assert!(both.contains("between already names the bodies"), "{both}");
    assert!(told("[contact.x]\nbetween = ['c*', 'b']\nfriction = 0.1\n").contains("no body matches `c*`"));
    assert!(told("[contact.x]\nfriction = 0.1\n").contains("contact.x.between: missing"));
}

/// More pairs of fixed blocks than a scene may have contacts.
#[test]
fn pairs_that_can_not_move_and_those_apart_are_no_contacts() {
    let text = |more: &str| {
        format!(
            "{HEAD}[block.a-wall]\nmaterial = 'm'\nwidth = '1 cm'\nheight = '1 cm'\ndepth = '1 m'\nposition = ['10 m', '1 m']\n\
             repeat = {{ count = 230, shift = ['2 cm', '0 m'] }}\n{more}\
             [block.z]\nmaterial = 'm'\nwidth = '1 cm'\nheight = '1 cm'\ndepth = '1 m'\nposition = ['0 m', '1 m']\n\
             [contact.all]\nbetween = ['*', '*']\nfriction = 0.1\n[contact.near]\nbetween = ['z', 'gr*']\nfriction = 0.5\n"
        )
    };
    let still = scene(&text("fixed = true\n"));
    assert_eq!(still.contacts.len(), 231);
    let own = still.contacts.iter().find(|contact| contact.surface == teeter_scenario::scene::SupportingBody::Ground);
    assert_eq!(own.unwrap().name, "near");
    let apart = scene(&text("").replace("[ground]", "[world]\napart = [['a-*', 'a-*']]\n[ground]"));
    assert_eq!(apart.contacts.len(), 230 + 231);
    // Pairs of blocks needn't be listed, but those of blocks and beams are.
    assert!(scene(&text("")).crowd.is_some());
    let beam = |name: &str| {
        format!(
            "[beam.{name}]\nmaterial = 'e'\nspan = '1 m'\nwidth = '1 cm'\nthickness = '1 cm'\nelements = 4\n\
             supports = ['pinned', 'pinned']\nposition = ['0 m', '-9 m']\n"
        )
    };
    let material = "[material.e]\ndensity = '1000 kg/m^3'\nyoungs_modulus = '1 GPa'\n";
    let many = text("").replace("count = 230", "count = 7000") + material + &beam("p") + &beam("q");
    let errors = teeter_scenario::load(many.as_bytes(), "s", "s", &[]).map(|_| ()).unwrap_err().to_string();
    assert!(errors.contains("more than 20000 pairs"), "{errors}");
}

#[test]
fn one_rectangle_may_be_the_only_part_and_stadiums_may_stand_above_each_other() {
    let one = block("parts = [{ width = '10 cm', height = '20 cm' }]");
    assert!((one.mass() - block("width = '10 cm'\nheight = '20 cm'").mass()).abs() < 1e-12);
    let stadiums = |shift: &str| {
        let text = format!(
            "{HEAD}[block.s]\nmaterial = 'm'\ndepth = '1 m'\nshape = {{ kind = 'stadium', length = '10 cm', radius = '2 cm' }}\n\
             position = ['0 m', '1 m']\nangle = '90 deg'\nrepeat = {{ count = 2, shift = ['0 m', '{shift}'] }}\n\
             [contact.c]\nbetween = ['s-1', 's-2']\nfriction = 0.5\n"
        );
        Simulation::new(&scene(&text)).map(|_| ())
    };
    assert!(stadiums("30 cm").is_ok());
    let overlap = stadiums("9 cm").unwrap_err().to_string();
    assert!(overlap.contains("overlaps"), "{overlap}");
}

#[test]
fn a_voussoir_without_a_place_is_where_its_arch_has_it() {
    let placed = |keys: &str| {
        let text = format!(
            "{HEAD}[block.b]\nmaterial = 'm'\ndepth = '1 m'\n\
             shape = {{ kind = 'voussoir', inner = '1 m', outer = '2 m', from = '80 deg', to = '100 deg' }}\n{keys}\n"
        );
        scene(&text).blocks.remove(0).placement
    };
    assert_eq!(placed(""), placed("centre = ['0 m', '0 m']"));
}

/// Limit analysis (`validation`, case `assemblages`): it stands from t/R = 0.1067 on.
#[test]
fn an_arch_of_one_table_stands_if_it_is_thick_enough() {
    let moved = |thickness: f64| {
        let (inner, outer) = (1.0 - 0.5 * thickness, 1.0 + 0.5 * thickness);
        let text = format!(
            "{HEAD}[block.v]\nmaterial = 'm'\ndepth = '1 m'\n\
             shape = {{ kind = 'voussoir', inner = '{inner} m', outer = '{outer} m', from = '0 deg', to = '{:?} deg' }}\n\
             repeat = {{ count = 27, turn = '{:?} deg' }}\n[contact.c]\nbetween = ['v-*', '*']\nfriction = 0.5\n",
            180.0 / 27.0,
            180.0 / 27.0
        );
        let mut simulation = Simulation::new(&scene(&text)).unwrap();
        let start = simulation.state.q.clone();
        assert_eq!(simulation.run(&mut []).unwrap(), Ended::Complete);
        start.iter().zip(&simulation.state.q).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()))
    };
    assert!(moved(0.1078) < 1e-9);
    assert!(moved(0.1056) > 1e-3);
}

#[test]
fn only_voussoirs_are_turned_about_an_arch() {
    let found = told("material = 'm'\ndepth = '1 m'\nradius = '1 m'\nrepeat = { count = 2, turn = '5 deg' }");
    assert!(found.contains("block.b.repeat.turn") && found.contains("only voussoirs"), "{found}");
}

/// What has sunk deeper into a block below than both roundings stands on it: not beside its corner, to which it is as near. On springs, and
/// where a step has carried it so deep.
#[test]
fn rounded_blocks_stand_on_each_other_however_deep() {
    let spring = "law = 'kelvin-voigt'\nstiffness = '1e4 N/m'\ndamping = '20 N s/m'";
    for (scheme, step, rounding, height, law, wanted) in [
        ("auto", "250 us", "0.1 mm", 9.0, spring, 0.09 - 0.000294),
        ("moreau-jean", "250 us", "0.1 mm", 9.0, spring, 0.09 - 0.000294),
        ("auto", "250 us", "2 mm", 19.0, spring, 0.09 - 0.000294),
        ("moreau-jean-closed", "1 ms", "0.1 mm", 12.0, "", 0.09),
        ("moreau-jean-closed", "1 ms", "0.1 mm", 12.7, "", 0.09),
        ("moreau-jean-closed", "250 us", "0.02 mm", 12.3, "", 0.09),
        ("moreau-jean-located", "1 ms", "0.1 mm", 12.0, "", 0.09),
    ] {
        let end = if law.is_empty() { "0.5 s" } else { "4 s" };
        let block = "density = '1000 kg/m^3'\nwidth = '10 cm'\nheight = '6 cm'\ndepth = '10 cm'";
        let text = format!(
            "[time]\nend = '{end}'\nstep = '{step}'\nscheme = '{scheme}'\n[ground]\n\
             [block.lower]\n{block}\nrounding = '{rounding}'\nfixed = true\nposition = ['0 m', '3 cm']\n\
             [block.upper]\n{block}\nrounding = '{rounding}'\nposition = ['0 m', '{height} cm']\n\
             [contact.c]\nbetween = ['lower', 'upper']\nfriction = 0.5\n{law}\n"
        );
        let resolved = load(text.as_bytes(), "stack", "stack", &[]).unwrap_or_else(|errors| panic!("{errors}"));
        let mut run = Simulation::new(&resolved.scene).unwrap();
        assert_eq!(run.run(&mut []).unwrap(), Ended::Complete);
        let upper = run.layout.blocks.last().unwrap().range.clone();
        let q = &run.state.q[upper];
        // A rigid one keeps how deep the step of its impact has carried it, at 0.8 m/s.
        let off = if law.is_empty() { 8e-4 } else { 2e-6 };
        assert!((q[1] - wanted).abs() < off && q[2].abs() < 1e-9, "{scheme}, {step}, {rounding}, {height}: {q:?}");
    }
}
