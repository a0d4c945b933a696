//! Scenes of so many blocks that their pairs are not listed one by one.

use teeter_detect::ContactId;
use teeter_integrator::Ended;
use teeter_scenario::load;
use teeter_scenario::resolve::Resolved;
use teeter_scenario::simulation::Simulation;

const HEAD: &str = "[time]\nend = '50 ms'\nstep = '1 ms'\nscheme = 'moreau-jean-closed'\n[ground]\n[material.m]\ndensity = '700 kg/m^3'\n";

fn loaded(text: &str) -> Resolved {
    load(text.as_bytes(), "f", "f", &[]).unwrap()
}

/// So many boxes of 0.1 m on each other.
fn tower(boxes: usize, contacts: &str) -> String {
    format!(
        "{HEAD}[block.box]\nmaterial = 'm'\nwidth = '10 cm'\nheight = '10 cm'\ndepth = '10 cm'\non = 'ground'\nat = '0 m'\n\
         repeat = {{ count = {boxes}, stacked = true }}\n{contacts}"
    )
}

const ALL: &str = "[contact.floor]\nbetween = ['box-*', 'ground']\nfriction = 0.5\n[contact.joints]\nbetween = ['box-*', 'box-*']\nfriction = 0.5\n";

#[test]
fn few_pairs_are_listed_and_many_are_not() {
    let few = loaded(&tower(28, ALL)).scene;
    assert!(few.crowd.is_none());
    assert_eq!(few.contacts.len(), 28 + 28 * 27 / 2);
    let many = loaded(&tower(100, ALL)).scene;
    let crowd = many.crowd.as_ref().unwrap();
    // Those that stand on each other are listed, as their placement refers to them.
    assert_eq!(many.contacts.len(), 100 + 99);
    assert_eq!(crowd.pair_count(), 100 * 99 / 2 - 99);
    assert_eq!((crowd.contact_of(3, 4), crowd.contact_of(3, 5)), (None, Some(0)));
    assert!(crowd.joins(3, 4) && crowd.joins(5, 3) && !crowd.joins(3, 3));
}

#[test]
fn a_tower_stands_still() {
    let boxes = if cfg!(debug_assertions) { 60 } else { 300 };
    let resolved = loaded(&tower(boxes, ALL));
    let mut simulation = Simulation::new(&resolved.scene).unwrap();
    let start = simulation.state.q.clone();
    assert_eq!(simulation.run(&mut []).unwrap(), Ended::Complete);
    let moved = simulation.state.q.iter().zip(&start).map(|(now, start)| (now - start).abs()).fold(0.0, f64::max);
    // Weights add up to some kN, gaps stay those of a step's tolerance.
    assert!(moved < 1e-9, "{moved:e}");
    assert_eq!(simulation.state.tally.unconverged_steps, 0);
}

/// Stones fall into a container, some of them pegs that pass each other.
fn pile(contacts: &str) -> String {
    let stones = |name: &str, sides: u32, y: &str, count: u32| {
        format!(
            "[block.{name}]\nmaterial = 'm'\nshape = {{ kind = 'regular', sides = {sides}, radius = '5 cm' }}\ndepth = '10 cm'\n\
             position = ['-45 cm', '{y}']\nangle = '7 deg'\nrepeat = {{ count = {count}, shift = ['13 cm', '1 mm'] }}\n"
        )
    };
    let rows = [("a", 3, "6 cm"), ("b", 5, "18 cm"), ("c", 6, "30 cm"), ("peg", 4, "42 cm")];
    let rows: String = rows.iter().map(|(name, sides, y)| stones(name, *sides, y, 8)).collect();
    let head = HEAD.replace(
        "[ground]\n",
        "[ground.profile]\npoints = [['-6 m', '50 m'], ['-55 cm', '0 m'], ['55 cm', '0 m'], ['6 m', '50 m']]\n",
    );
    format!("{}{rows}{contacts}", head.replace("50 ms", "400 ms"))
}

const RULES: &str = "[contact.floor]\nbetween = ['*', 'ground']\nfriction = 0.5\n[contact.all]\nbetween = ['*', '*']\nfriction = 0.4\n\
                     [contact.pegs]\nbetween = ['peg-*', '*']\nfriction = 0.2\n[contact.one]\nbetween = ['a-1', 'b-1']\nfriction = 0.9\n";
const APART: &str = "[world]\napart = [['peg-*', 'peg-*'], ['c-2', 'c-3']]\n";

#[test]
fn the_contact_of_two_blocks_is_the_one_that_a_list_would_have() {
    let scene = loaded(&(pile(RULES) + APART)).scene;
    let crowd = scene.crowd.as_ref().unwrap();
    let number = |name: &str| scene.blocks.iter().position(|block| block.name == name).unwrap();
    let name = |a: &str, b: &str| crowd.contact_of(number(a), number(b)).map(|of| crowd.contacts()[of].name.as_str());
    assert_eq!(name("a-2", "b-3"), Some("all"));
    assert_eq!(name("c-8", "peg-1"), Some("pegs"), "more letters");
    assert_eq!(name("peg-2", "peg-1"), None, "apart by a pattern");
    assert_eq!(name("c-2", "c-3"), None, "apart by names");
    assert_eq!(name("a-1", "b-1"), None, "listed");
    assert!(crowd.joins(number("a-1"), number("b-1")) && !crowd.joins(number("c-3"), number("c-2")));
}

/// The same scene with its pairs written out one by one moves alike until contacts make rounding grow, and has contacts of the same names.
#[test]
fn a_crowd_moves_as_the_same_pairs_listed() {
    let crowded = loaded(&(pile(RULES) + APART));
    let scene = &crowded.scene;
    let crowd = scene.crowd.as_ref().unwrap();
    let mut listed = String::from(
        "[contact.floor]\nbetween = ['*', 'ground']\nfriction = 0.5\n[contact.one]\nbetween = ['a-1', 'b-1']\nfriction = 0.9\n",
    );
    for a in 0..scene.blocks.len() {
        for b in a + 1..scene.blocks.len() {
            if let Some(of) = crowd.contact_of(a, b) {
                let [first, second] = [a, b].map(|k| scene.blocks[k].name.as_str());
                let friction = crowd.contacts()[of].law.friction;
                listed += &format!("[contact.x{a}y{b}]\nbetween = ['{first}', '{second}']\nfriction = {friction}\n");
            }
        }
    }
    let listed = loaded(&pile(&listed));
    assert!(listed.scene.crowd.is_none() && listed.scene.contacts.len() > 400);
    let mut one = Simulation::new(scene).unwrap();
    let mut other = Simulation::new(&listed.scene).unwrap();
    let mut names = 0;
    for _ in 0..150 {
        let step = one.step().unwrap();
        let ids: Vec<ContactId> = step.contacts().map(|contact| contact.id).collect();
        other.step().unwrap();
        for id in ids {
            let names_now = one.layout.names_of(id).unwrap();
            names += usize::from(names_now.contact == "all" || names_now.contact == "pegs");
            assert!(
                names_now.between.contains(&"ground") || names_now.point.to_string().contains('.'),
                "{names_now:?}"
            );
        }
    }
    assert!(names > 100, "{names}");
    let off = one.state.q.iter().zip(&other.state.q).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off < 1e-7, "{off:e}");
    assert!(one.state.tally.max_penetration < 2e-3);
}

#[test]
fn what_a_crowd_cannot_have_is_refused() {
    let refused = |text: &str| load(text.as_bytes(), "f", "f", &[]).expect_err("taken").to_string();
    let contested = RULES.replace("['peg-*', '*']", "['*', '*']");
    assert!(refused(&pile(&contested)).contains("says no more of the bodies than `all`"));
    let driven = pile(RULES) + "[block.c.motion]\nvelocity = ['1 m/s', '0 m/s']\nangular_velocity = '0 rad/s'\n";
    let driven = refused(&driven);
    assert!(driven.contains("contact.all") && driven.contains("can't yield"), "{driven}");
    let own = pile(RULES) + "[world]\napart = [['a-*', 'b-*']]\n";
    let own = refused(&own);
    assert!(own.contains("contact.one.between") && own.contains("world.apart"), "{own}");
}

#[test]
fn blocks_of_a_crowd_that_start_inside_each_other_are_refused() {
    let text = pile(RULES).replace("'18 cm'", "'12 cm'");
    let resolved = loaded(&text);
    let error = Simulation::new(&resolved.scene).unwrap_err().to_string();
    assert!(error.contains("overlaps"), "{error}");
}

#[test]
fn rows_of_copies_are_numbered_row_after_row() {
    let rows = |more: &str| {
        format!(
            "{HEAD}[block.b]\nmaterial = 'm'\nwidth = '1 cm'\nheight = '1 cm'\ndepth = '10 cm'\n\
             repeat = {{ count = 3, shift = ['2 cm', '0 cm'], rows = 2, row_shift = ['1 cm', '5 cm']{more} }}\n\
             [contact.floor]\nbetween = ['*', 'ground']\nfriction = 0.5\n"
        )
    };
    let scene = loaded(&rows("").replace("repeat", "position = ['1 m', '1 m']\nrepeat")).scene;
    let last = &scene.blocks[4];
    let teeter_scenario::scene::Placement::Free { position, .. } = last.placement else { panic!("{last:?}") };
    assert_eq!((last.name.as_str(), scene.blocks.len()), ("b-5", 6));
    assert!((position[0] - 1.03).abs() < 1e-15 && (position[1] - 1.05).abs() < 1e-15, "{position:?}");
    let refused = |text: String| load(text.as_bytes(), "f", "f", &[]).map(|_| ()).expect_err("taken").to_string();
    let piles = refused(rows(", stacked = true").replace("repeat", "on = 'ground'\nat = '1 m'\nrepeat"));
    assert!(piles.contains("block.b.repeat.rows") && piles.contains("one pile"), "{piles}");
    let many = rows("").replace("rows = 2", "rows = 9000").replace("count = 3", "count = 9000");
    let many = refused(many.replace("repeat", "position = ['1 m', '1 m']\nrepeat"));
    assert!(many.contains("9000 rows of 9000 blocks"), "{many}");
}

#[test]
fn rows_of_many_blocks_are_thinned_and_that_is_told() {
    let every = |boxes: usize, set: &[(&str, &str)]| {
        let sets: Vec<_> = set.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
        let resolved = load(tower(boxes, ALL).replace("50 ms", "1 s").as_bytes(), "f", "f", &sets).unwrap();
        let told = resolved.notes.iter().any(|note| note.path == "output.every");
        assert_eq!(resolved.document.quantity("output.every"), resolved.scene.every);
        (resolved.scene.every.map(|every| (every / 1e-3).round()), told)
    };
    assert_eq!(every(300, &[]), (None, false));
    assert_eq!(every(1000, &[]), (Some(5.0), true));
    assert_eq!(every(5000, &[]), (Some(10.0), true));
    assert_eq!(every(5000, &[("output.every", "1 ms")]), (Some(1.0), false));
}

/// The wall of the file, lower and for a short time: it is not thrown down, and its bricks don't sink into each other.
#[test]
fn a_wall_in_running_bond_holds_together() {
    let sets = [("time.end", "0.1 s"), ("block.odd.repeat.rows", "3"), ("block.even.repeat.rows", "2")];
    let sets = sets.map(|(key, value)| (key.to_owned(), value.to_owned()));
    let scene = load(include_bytes!("brick-wall.toml"), "f", "f", &sets).unwrap().scene;
    // A star stands for the ground, too.
    assert_eq!((scene.blocks.len(), scene.contacts.len()), (100, 100));
    let mut simulation = Simulation::new(&scene).unwrap();
    let start = simulation.state.q.clone();
    assert_eq!(simulation.run(&mut []).unwrap(), Ended::Complete);
    let heights = simulation.state.q.iter().zip(&start).skip(1).step_by(3).take(100);
    let moved = heights.map(|(now, start)| (now - start).abs()).fold(0.0, f64::max);
    assert!(moved < 1e-3 && simulation.state.tally.max_penetration < 1e-4, "{moved:e}");
    assert_eq!(simulation.state.tally.unconverged_steps, 0);
}

/// Their list would take gigabytes.
#[test]
fn too_many_blocks_are_refused_before_anything_is_listed() {
    let rows = "repeat = { count = 200, rows = 165, shift = ['1 m', '0 m'], row_shift = ['0 m', '1 m'] }";
    let text = format!(
        "{HEAD}[block.box]\nmaterial = 'm'\nwidth = '10 cm'\nheight = '10 cm'\ndepth = '10 cm'\nposition = ['0 m', '1 m']\n{rows}\n{ALL}"
    );
    let told = load(text.as_bytes(), "f", "f", &[]).unwrap_err();
    let rules: Vec<&str> = told.0.iter().map(|found| found.rule.as_str()).collect();
    assert_eq!(rules, ["33000 blocks of which any two may touch, more than the limit of 32768"]);
}

/// Whatever comes first in the file; the same in a list.
#[test]
fn a_closer_contact_settles_what_two_others_leave_open() {
    let table = |name: &str, a: &str, b: &str| format!("[contact.{name}]\nbetween = ['{a}', '{b}']\nfriction = 0.5\n");
    let [a, b] = [table("a", "bo*", "*"), table("b", "*ox*", "*")];
    let closer = table("c", "box-*", "box-*") + &table("d", "box-*", "ground");
    for boxes in [5, 60] {
        for contacts in [format!("{a}{b}{closer}"), format!("{closer}{a}{b}")] {
            let scene = loaded(&tower(boxes, &contacts)).scene;
            assert!(scene.contacts.iter().all(|contact| ["c", "d"].contains(&contact.name.as_str())), "{boxes}");
            assert_eq!(scene.crowd.map_or(0, |crowd| crowd.contacts().len()), usize::from(boxes > 28));
        }
        let told = load(tower(boxes, &format!("{a}{b}")).as_bytes(), "f", "f", &[]).unwrap_err().to_string();
        assert!(told.contains("it says no more of the bodies than"), "{told}");
    }
}

#[test]
fn of_two_blocks_on_each_other_the_lower_number_comes_first_in_a_crowd_too() {
    for boxes in [20, 40] {
        let scene = loaded(&tower(boxes, ALL)).scene;
        let joint = scene.contacts.iter().find(|contact| contact.name == "joints").unwrap();
        assert_eq!(joint.between, ["box-1", "box-2"], "{boxes}");
    }
}

#[test]
fn a_row_that_rises_off_its_support_is_told_where_it_is_written() {
    let text = tower(6, ALL).replace(
        "repeat = { count = 6, stacked = true }",
        "repeat = { count = 3, shift = ['12 cm', '0 cm'], rows = 2, row_shift = ['0 cm', '12 cm'] }",
    );
    let told = load(text.as_bytes(), "f", "f", &[]).unwrap_err();
    let paths: Vec<&str> = told.0.iter().map(|found| found.path.as_str()).collect();
    assert_eq!(paths, ["block.box.repeat.row_shift"]);
}

#[test]
fn a_row_shift_without_rows_is_told() {
    let rows = "repeat = { count = 3, shift = ['12 cm', '0 cm'], row_shift = ['1 m', '0 cm'] }";
    let resolved = loaded(&tower(6, ALL).replace("repeat = { count = 6, stacked = true }", rows));
    let told: Vec<&str> = resolved.warnings.iter().map(|found| found.path.as_str()).collect();
    assert_eq!(told, ["block.box.repeat.row_shift"]);
}

#[test]
fn a_contact_by_a_pattern_that_is_not_resolved_is_told_once() {
    for boxes in [20, 40] {
        let soft = "[contact.all]\nbetween = ['*', '*']\nfriction = 0.5\nlaw = 'kelvin-voigt'\nstiffness = '1e6 N/m'\ndamping = '0 N s/m'\n";
        let resolved = loaded(&tower(boxes, soft));
        let told = resolved.warnings.iter().filter(|found| found.rule.contains("it is not resolved"));
        assert_eq!(told.count(), 1, "{boxes}");
    }
}

/// Stones at random places.
fn jittered(more: &str) -> Result<Resolved, String> {
    let rows =
        format!("repeat = {{ count = 6, shift = ['13 cm', '0 cm'], rows = 5, row_shift = ['0 cm', '13 cm']{more} }}");
    let text = tower(6, ALL)
        .replace("repeat = { count = 6, stacked = true }", &rows)
        .replace("on = 'ground'\nat = '0 m'", "position = ['0 m', '10 cm']");
    load(text.as_bytes(), "f", "f", &[]).map_err(|found| found.to_string())
}

#[test]
fn the_same_seed_gives_the_same_places_within_their_bounds() {
    let places = |more: &str| Simulation::new(&jittered(more).unwrap().scene).unwrap().state.q;
    let even = places("");
    let one = places(", jitter = ['9 mm', '4 mm'], jitter_angle = '3 deg', seed = 5");
    assert_eq!(one, places(", jitter = ['9 mm', '4 mm'], jitter_angle = '3 deg', seed = 5"));
    let other = places(", jitter = ['9 mm', '4 mm'], jitter_angle = '3 deg', seed = 6");
    let half = places(", jitter = ['4.5 mm', '2 mm'], jitter_angle = '1.5 deg', seed = 5");
    for (k, most) in [9e-3, 4e-3, 3_f64.to_radians()].into_iter().enumerate() {
        let off = |q: &[f64]| -> Vec<f64> { (k..q.len()).step_by(3).map(|i| q[i] - even[i]).collect() };
        let (one, other, half) = (off(&one), off(&other), off(&half));
        assert!(one.iter().zip(&other).all(|(a, b)| a != b));
        assert!(one.iter().zip(&half).all(|(a, b)| (a - 2.0 * b).abs() < 1e-12), "the same places, but nearer");
        let largest = one.iter().fold(0.0_f64, |largest, off| largest.max(off.abs()));
        assert!(largest <= most && largest > 0.8 * most, "{largest} of {most}");
    }
    let on_ground = "repeat = { count = 6, shift = ['13 cm', '0 cm'], jitter = ['9 mm', '0 mm'] }";
    let resolved = loaded(&tower(6, ALL).replace("repeat = { count = 6, stacked = true }", on_ground));
    let q = Simulation::new(&resolved.scene).unwrap().state.q;
    assert!(
        (0..6)
            .all(|k| q[3 * k] != 0.13 * k as f64 && (q[3 * k] - 0.13 * k as f64).abs() < 9e-3 && q[3 * k + 1] == 0.05)
    );
    // Those of a stack lie off the ones below.
    let stacked = "repeat = { count = 6, stacked = true, jitter = ['9 mm', '0 mm'] }";
    let resolved = loaded(&tower(6, ALL).replace("repeat = { count = 6, stacked = true }", stacked));
    let q = Simulation::new(&resolved.scene).unwrap().state.q;
    assert!((1..6).all(|k| (q[3 * k] - q[3 * k - 3]).abs() < 9e-3 && q[3 * k] != q[3 * k - 3]));
}

#[test]
fn jitter_that_makes_no_sense_is_told() {
    assert!(jittered(", jitter = ['-1 mm', '0 mm']").unwrap_err().contains("block.box.repeat.jitter"));
    let warned = jittered(", seed = 3").unwrap().warnings;
    assert_eq!(warned.iter().map(|found| found.path.as_str()).collect::<Vec<_>>(), ["block.box.repeat.seed"]);
    let overlaps = Simulation::new(&jittered(", jitter = ['5 cm', '5 cm']").unwrap().scene).unwrap_err();
    assert!(overlaps.to_string().contains("overlaps"), "{overlaps}");
}

#[test]
fn a_crowd_on_a_beam_with_a_static_start_is_refused_with_its_remedy() {
    let beam = "[beam.floor]\nmaterial = 'm'\nspan = '6 m'\nwidth = '20 cm'\nthickness = '30 cm'\nelements = 20\n\
                supports = ['pinned', 'pinned']\nstart = 'static'\n";
    let on_beam = |start: &str| {
        let text = tower(30, "[contact.all]\nbetween = ['*', '*']\nfriction = 0.5\n")
            .replace("on = 'ground'\nat = '0 m'", "on = 'floor'\nat = '3 m'")
            .replace("[ground]\n", "")
            .replace("density = '700 kg/m^3'", "density = '700 kg/m^3'\nyoungs_modulus = '11 GPa'");
        load((text + &beam.replace("static", start)).as_bytes(), "f", "f", &[])
    };
    let told = on_beam("static").unwrap_err();
    assert_eq!(told.0.iter().map(|found| found.path.as_str()).collect::<Vec<_>>(), ["beam.floor.start"]);
    let told = told.to_string();
    assert!(told.contains("only with up to 400") && told.contains("start undeformed"), "{told}");
    assert!(on_beam("undeformed").is_ok());
}

/// Stones that jam between two walls, by Poisson's law at a large friction: their impulses against each other do nothing, and were 1 + e
/// times as large after each blow, until the rounding of 1e17 N s threw the stones away.
#[test]
fn a_jam_is_not_blown_up_by_what_is_given_back() {
    let resolved = loaded(include_str!("jam.toml"));
    let mut simulation = Simulation::new(&resolved.scene).unwrap();
    assert_eq!(simulation.run(&mut []).unwrap(), Ended::Complete);
    let ledger = &simulation.state.ledger;
    assert!(ledger.relative_residual() < 1e-13, "{:e} of the energy unexplained", ledger.relative_residual());
    let gain = ledger.positive_contact_work.largest;
    assert!(gain <= 1e-12 * ledger.scale, "contacts gave {gain:e} J in a step, of {:e} J", ledger.scale);
}
