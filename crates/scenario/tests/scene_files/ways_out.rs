//! Refusals advise what isn't refused in its turn, and stand at keys that the file has.

use teeter_scenario::{load, simulation::Simulation};

const HEAD: &str = "[time]\nend = '1 s'\nstep = '1 ms'\n[ground]\n";
const SLAB: &str = "[block.slab]\ndensity = '2000 kg/m^3'\nwidth = '25 cm'\nheight = '10 cm'\ndepth = '1 m'\n";
const GROUND: &str = "[contact.g]\nbetween = ['slab', 'ground']\nfriction = 0.5\n";

/// Why a scene is refused.
fn told(scene: &str) -> String {
    let scene = format!("{HEAD}{scene}");
    match load(scene.as_bytes(), "scene", "scene", &[]) {
        Err(found) => found.to_string(),
        Ok(resolved) => match Simulation::new(&resolved.scene) {
            Err(error) => error.diagnostic(&resolved.document).to_string(),
            Ok(_) => panic!("accepted:\n{scene}"),
        },
    }
}

fn says(found: &str, wanted: &[&str]) {
    for part in wanted {
        assert!(found.contains(part), "no `{part}` in\n{found}");
    }
}

fn is_accepted(scene: &str) {
    let scene = format!("{HEAD}{scene}");
    let resolved = load(scene.as_bytes(), "scene", "scene", &[]).unwrap_or_else(|errors| panic!("{errors}\n{scene}"));
    assert!(Simulation::new(&resolved.scene).is_ok(), "{scene}");
}

/// No contact is advised that two bodies without motion can't have, and where there is one, `position` is named.
#[test]
fn a_fixed_block_on_the_ground_needs_a_position() {
    let on = format!("{SLAB}on = 'ground'\nat = '0 m'\nfixed = true\n");
    let any = "[contact.g]\nbetween = ['*', '*']\nfriction = 0.5\n";
    for contact in ["", any] {
        let found = told(&format!("{on}{contact}"));
        says(&found, &["block.slab.on", "a fixed block and the ground have no contact", "give position (and angle)"]);
        assert!(!found.contains("add [contact"), "{found}");
    }
    let found = told(&format!("{on}{GROUND}"));
    says(&found, &["contact.g.between", "fully prescribed", "leave the contact out and give position"]);
    is_accepted(&format!("{SLAB}position = ['0 m', '5 cm']\nfixed = true\n"));
    let elsewhere = told(&format!("{SLAB}position = ['0 m', '5 cm']\nfixed = true\n{GROUND}"));
    says(&elsewhere, &["fully prescribed", "leave the contact out"]);
    assert!(!elsewhere.contains("give position"), "{elsewhere}");
}

#[test]
fn a_fixed_block_on_another_needs_a_position() {
    let upper = SLAB.replace("slab", "upper");
    let found = told(&format!(
        "{SLAB}position = ['0 m', '5 cm']\nfixed = true\n{upper}on = 'slab'\nat = '0 m'\nfixed = true\n"
    ));
    says(&found, &["block.upper.on", "two fixed blocks have no contact", "give position (and angle)"]);
}

/// A contact by patterns holds for this pair, too, and it is `apart` that takes it away.
#[test]
fn what_is_apart_is_said_to_be() {
    for apart in ["'slab', 'ground'", "'ground', 'sl*'"] {
        let found = told(&format!(
            "[world]\napart = [[{apart}]]\n{SLAB}on = 'ground'\nat = '0 m'\n[contact.g]\nbetween = ['*', '*']\nfriction = 0.5\n"
        ));
        says(&found, &["block.slab.on", "world.apart says that the two don't touch", "leave that pair out of apart"]);
        assert!(!found.contains("add [contact"), "{found}");
    }
}

/// The moment of inertia is that of all the mass at the furthest corner, or at the rim, at most.
#[test]
fn inertia_is_no_more_than_that_of_the_mass_at_the_furthest_point() {
    let block = |shape: &str, inertia: &str| {
        format!("[block.b]\nmass = '2 kg'\ninertia = '{inertia} kg m^2'\nposition = ['0 m', '5 m']\n{shape}\n")
    };
    for (shape, most, more) in [
        ("width = '1 m'\nheight = '0.5 m'", "0.625", "0.6251"),
        ("radius = '5 cm'", "0.005", "0.00501"),
        // Its mass centre, that of the area, is at (1, 1) m; the furthest corner is √29 m from there.
        ("points = [['0 m', '0 m'], ['4 m', '-3 m'], ['-1 m', '6 m']]", "58", "58.1"),
        ("width = '2.6 m'\nheight = '2.2 m'\nrounding = '0.5 m'", "4.5", "4.501"),
        (
            "parts = [{ width = '2 m', height = '1 m' }, { width = '2 m', height = '1 m', at = ['0 m', '1 m'] }]",
            "4",
            "4.01",
        ),
    ] {
        is_accepted(&block(shape, most));
        let found = told(&block(shape, more));
        says(
            &found,
            &["block.b.inertia", "no distribution of 2 kg over this shape", &format!("at most {most} kg m^2")],
        );
    }
    let found = told(
        "[block.b]\nmass = '1 kg'\ninertia = '1000 kg m^2'\nposition = ['0 m', '5 m']\nwidth = '1 m'\nheight = '0.5 m'\n",
    );
    says(&found, &["at most 0.3125 kg m^2"]);
}

/// Stones of an arch have no `at`: it is the angle between them that is wrong.
#[test]
fn overlapping_stones_of_an_arch_are_placed_by_their_angle() {
    let arch = |repeat: &str| {
        told(&format!(
            "[block.a]\ndensity = '2000 kg/m^3'\ndepth = '1 m'\n\
             shape = {{ kind = 'voussoir', inner = '1 m', outer = '2 m', from = '10 deg', to = '20 deg' }}\n\
             repeat = {{ count = 3{repeat} }}\n[contact.c]\nbetween = ['a-*', '*']\nfriction = 0.5\n"
        ))
    };
    for (repeat, wanted) in [
        (", turn = '0 deg'", "block.a.repeat.turn"),
        (", turn = '5 deg'", "block.a.repeat.turn"),
        ("", "block.a.repeat"),
    ] {
        let found = arch(repeat);
        says(&found, &[wanted, "overlaps `a-"]);
        assert!(!found.contains("block.a.at"), "{found}");
    }
    let two = told(
        "[block.a]\ndensity = '2000 kg/m^3'\ndepth = '1 m'\npoints = [['0 m', '0 m'], ['1 m', '0 m'], ['0 m', '1 m']]\n\
         [block.b]\ndensity = '2000 kg/m^3'\ndepth = '1 m'\npoints = [['0.1 m', '0.1 m'], ['1 m', '0.1 m'], ['0.1 m', '1 m']]\n\
         [contact.c]\nbetween = ['a', 'b']\nfriction = 0.5\n",
    );
    says(&two, &["block.b.points", "overlaps `a`"]);
}

#[test]
fn a_pattern_in_place_of_one_name_is_told() {
    let free = format!("{SLAB}position = ['0 m', '1 m']\n");
    for table in
        ["[force.f]\non = 'sl*'\nforce = ['1 N', '0 N']\n", "[load.f]\non = 'sl?b'\nforce = '1 N'\nat = '1 m'\n"]
    {
        let found = told(&format!("{free}{table}"));
        says(&found, &["f.on", "may contain only letters", "give one name: no patterns are possible here"]);
    }
    let found = told(&format!("{free}[force.f]\non = 'sl/b'\nforce = ['1 N', '0 N']\n"));
    assert!(!found.contains("patterns"), "{found}");
}

/// Columns are chosen among blocks, and that there are none of very many is noted with the way to them.
#[test]
fn columns_are_of_blocks_that_there_are() {
    let row = |count: usize, output: &str| {
        format!(
            "{output}{SLAB}position = ['0 m', '1 m']\nrepeat = {{ count = {count}, shift = ['1 m', '0 m'] }}\n\
             [contact.g]\nbetween = ['*', 'ground']\nfriction = 0.5\n"
        )
    };
    let of = |names: &str| format!("[output]\nblocks = [{names}]\n");
    for (names, wanted) in [
        ("'slab-1', 'wall-*'", "no body matches `wall-*`"),
        ("'slab-4'", "there is no body `slab-4`"),
        ("'ground'", "`ground` is no block"),
        ("'g*d'", "`g*d` is no block"),
        ("", "must have one name or more"),
        ("'sl ab'", "may contain only letters"),
    ] {
        says(&told(&row(3, &of(names))), &["output.blocks", wanted]);
    }
    let read = |scene: &str| load(format!("{HEAD}{scene}").as_bytes(), "scene", "scene", &[]).unwrap();
    let columns = |scene: &str| read(scene).scene.block_tables.columns(2001).collect::<Vec<_>>();
    assert_eq!(columns(&row(2001, &of("'slab-?', 'slab-2', 'slab-2001'"))), [0, 1, 2, 3, 4, 5, 6, 7, 8, 2000]);
    let noted = |count: usize, output: &str| {
        let notes = read(&row(count, output)).notes;
        notes.iter().map(ToString::to_string).filter(|note| note.contains("blocks.csv")).collect::<String>()
    };
    says(
        &noted(2001, ""),
        &["2001 blocks", "trajectory.csv has no columns of them", "blocks = [\"slab-1\"] in [output]"],
    );
    assert_eq!((noted(2000, ""), noted(2001, &of("'*'"))), (String::new(), String::new()));
}
