//! The keys of beams: what each makes of the beam, and what is refused with which words.

use crate::sets;
use teeter_beam::{Axial, Beam, Hold, InnerSupport, Profile, Section, Support};
use teeter_integrator::WBackend;
use teeter_scenario::resolve::Resolved;
use teeter_scenario::scene::{BeamScene, LoadKind};
use teeter_scenario::simulation::Simulation;

/// A beam alone, without the keys of its section and mesh.
const BARE: &str = "[time]\nend = '10 ms'\nstep = '1 ms'\n\
    [material.steel]\ndensity = '7850 kg/m^3'\nyoungs_modulus = '210 GPa'\n\
    [beam.b]\nmaterial = 'steel'\nspan = '2 m'\n";

const SECTION: &str = "width = '5 cm'\nthickness = '1 cm'\n";

fn resolve(text: &str, pairs: &[(&str, &str)]) -> Result<Resolved, String> {
    let resolved =
        teeter_scenario::load_with(text.as_bytes(), "scene.toml", "scene", &sets(pairs), &mut |path| match path {
            "bent.csv" => Ok(b"x,w,slope\n0,0,0.1\n1,0.01,0\n2,0,-0.1\n".to_vec()),
            "broken.csv" => Ok(b"0,0.002\n1,0.01\n2,0\n".to_vec()),
            "short.csv" => Ok(b"0,0\n2,0\n".to_vec()),
            _ => Err("there is no such file".to_owned()),
        });
    resolved.map_err(|errors| errors.to_string())
}

/// The beam of the bare scene with more keys, which runs as it is written out again, to the same
/// bytes.
fn beam(more: &str, pairs: &[(&str, &str)]) -> BeamScene {
    let resolved = resolve(&format!("{BARE}{more}"), pairs).unwrap();
    let written = resolved.document.to_toml();
    let again = resolve(&written, &[]).unwrap();
    assert_eq!(again.document.to_toml(), written);
    assert_eq!(again.scene, resolved.scene);
    let mut simulation = Simulation::new(&resolved.scene).unwrap();
    assert_eq!(simulation.run(&mut []).unwrap(), teeter_integrator::Ended::Complete);
    assert!(simulation.state.q.iter().all(|q| q.is_finite()));
    resolved.scene.beams[0].clone()
}

#[track_caller]
fn refused(more: &str, pairs: &[(&str, &str)], says: &[&str]) {
    let message = resolve(&format!("{BARE}{more}"), pairs).map(drop).expect_err("accepted");
    for part in says {
        assert!(message.contains(part), "«{part}» is missing in:\n{message}");
    }
    assert_eq!(message.matches("error: ").count(), 1, "{message}");
}

/// With the section and four elements.
fn plain(more: &str) -> String {
    format!("{SECTION}elements = 4\n{more}")
}

#[test]
fn each_section_has_its_own_keys() {
    let (e, rho) = (210e9, 7850.0);
    for (keys, profile) in [
        ("section = 'circle'\ndiameter = '4 cm'", Profile::Circle { diameter: 0.04 }),
        ("section = 'tube'\ndiameter = '4 cm'\nwall = '3 mm'", Profile::Tube { diameter: 0.04, wall: 0.003 }),
        (
            "section = 'i-section'\nheight = '10 cm'\nwidth = '5 cm'\nweb = '4 mm'\nflange = '6 mm'",
            Profile::ISection { height: 0.1, width: 0.05, web: 0.004, flange: 0.006 },
        ),
    ] {
        let beam = beam(&format!("{keys}\nelements = 4\n"), &[]);
        assert_eq!(beam.spec.section, Section::of(profile, e, rho).unwrap());
        assert_eq!(beam.thickness, 2.0 * profile.fibre());
    }
    let direct = "[time]\nend = '10 ms'\nstep = '1 ms'\n[beam.b]\nspan = '2 m'\nelements = 4\nsection = 'direct'\n\
                  bending_stiffness = '50 N m^2'\nmass_per_length = '2 kg/m'\n";
    let resolved = resolve(direct, &[]).unwrap();
    assert_eq!(resolved.scene.beams[0].spec.section, Section::new(50.0, 2.0).unwrap());
    assert_eq!(resolved.scene.beams[0].thickness, 0.0);
    let sheared = [
        ("beam.b.theory", "timoshenko"),
        ("beam.b.shear_stiffness", "1 kN"),
        ("beam.b.rotatory_inertia", "0.01 kg m"),
        ("beam.b.axial_stiffness", "3 MN"),
    ];
    let section = resolve(direct, &sheared).unwrap().scene.beams[0].spec.section;
    assert_eq!((section.shear_stiffness, section.rotatory_inertia, section.axial_stiffness), (1e3, 0.01, Some(3e6)));
    let message = |pairs: &[(&str, &str)]| resolve(direct, pairs).map(drop).unwrap_err();
    assert!(message(&sheared[..1]).contains("missing, where theory = timoshenko"));
    assert!(message(&sheared[1..2]).contains("has no meaning with theory = euler-bernoulli"));
    assert!(message(&[("beam.b.axial", "held")]).contains("required with axial = held or elastic"));
    assert!(message(&[("beam.b.surface", "top")]).contains("missing, where surface = top"));
    refused("section = 'circle'\nelements = 4\ndiameter = '4 cm'\nwidth = '4 cm'\n", &[], &["width has no meaning"]);
    refused(
        "section = 'tube'\nelements = 4\ndiameter = '4 cm'\nwall = '3 cm'\n",
        &[],
        &["beam.b.wall = '3 cm'", "at most half the diameter"],
    );
}

#[test]
fn timoshenko_takes_poissons_ratio() {
    let poisson = ("material.steel.poisson_ratio", "0.3");
    let beam = beam(&plain("theory = 'timoshenko'\n"), &[poisson]);
    let profile = Profile::Rectangle { width: 0.05, thickness: 0.01 };
    assert_eq!(beam.spec.section, Section::timoshenko(profile, 210e9, 7850.0, 0.3).unwrap());
    refused(&plain("theory = 'timoshenko'\n"), &[], &["material.steel.poisson_ratio", "used by beam.b with theory"]);
    refused(&plain("theory = 'timoshenk'\n"), &[], &["did you mean `timoshenko`", "euler-bernoulli, timoshenko"]);
    refused(&plain(""), &[("material.steel.poisson_ratio", "0.6")], &["must be greater than -1 and at most 0.5"]);
}

#[test]
fn supports_are_words_or_tables() {
    let elastic = "supports = ['guided', { spring = '1 kN/m', dashpot = '2 N s/m', rotation = 'fixed' }]\n";
    let beam = beam(&plain(elastic), &[]);
    let spring = Hold::Spring { stiffness: 1000.0, damping: 2.0 };
    assert_eq!(beam.spec.supports, [Support::Guided, Support::Elastic { deflection: spring, rotation: Hold::Fixed }]);
    for (supports, says) in [
        ("[{ sprin = '1 N/m' }, 'free']", ["beam.b.supports.sprin", "did you mean `spring`"]),
        ("[{ spring = '1 N' }, 'free']", ["beam.b.supports.spring = '1 N'", "a force (N)"]),
        ("[{ spring = '1 N/m', deflection = 'fixed' }, 'free']", ["deflection and spring both determine", "keep one"]),
        ("['pined', 'free']", ["did you mean `pinned`", "tables of spring"]),
        ("['pinned']", ["an array of two", "got 1"]),
        ("['pinned', 3]", ["a word in quotes or a table", "an integer"]),
    ] {
        refused(&plain(&format!("supports = {supports}\n")), &[], &says);
    }
}

#[test]
fn supports_stand_between_the_ends_as_well() {
    let more = "[beam.b.support.pier]\nat = '80 cm'\nkind = 'pinned'\n\
                [beam.b.support.prop]\nat = '1.5 m'\nrotational_spring = '5 N m/rad'\ndeflection = 'fixed'\n";
    let beam = beam(&plain(more), &[]);
    let turns = Hold::Spring { stiffness: 5.0, damping: 0.0 };
    let prop = Support::Elastic { deflection: Hold::Fixed, rotation: turns };
    assert_eq!(beam.spec.inner_supports, [InnerSupport::new(0.8, Support::Pinned), InnerSupport::new(1.5, prop)]);
    for (keys, says) in [
        ("at = '0 m'\nkind = 'pinned'", "must be between the ends"),
        ("at = '2.5 m'\nkind = 'pinned'", "outside the span [0, 2] m"),
        ("at = '1 m'", "the kind of support is missing"),
        ("at = '1 m'\nkind = 'pinned'\nspring = '1 N/m'", "kind already determines how"),
        ("at = '80 cm'\nkind = 'clamped'", "the support `pier` is at the same position"),
        ("kind = 'pinned'", "beam.b.support.second.at: missing"),
        ("at = '1 m'\nkind = 'pinned'\nplace = '1 m'", "unknown key"),
    ] {
        let pier = "[beam.b.support.pier]\nat = '80 cm'\nkind = 'pinned'\n";
        refused(&plain(&format!("{pier}[beam.b.support.second]\n{keys}\n")), &[], &[says]);
    }
}

#[test]
fn segments_masses_and_foundations_are_taken_in() {
    let more = "[beam.b.segment.haunch]\nfrom = '0 m'\nto = '50 cm'\nwidth = '5 cm'\nthickness = '3 cm'\n\
                [beam.b.segment.wood]\nmaterial = 'oak'\nfrom = '1 m'\nto = '2 m'\nsection = 'circle'\ndiameter = '4 cm'\n\
                [beam.b.mass.bell]\nat = '1 m'\nmass = '3 kg'\n\
                [beam.b.foundation.soil]\nstiffness = '10 kN/m^2'\n\
                [beam.b.foundation.mud]\nfrom = '1 m'\nto = '1.5 m'\nstiffness = '0 N/m^2'\ndamping = '5 N s/m^2'\n\
                [material.oak]\ndensity = '700 kg/m^3'\nyoungs_modulus = '11 GPa'\n";
    let spec = beam(&plain(more), &[]).spec;
    let haunch = Section::rectangle(0.05, 0.03, 210e9, 7850.0).unwrap();
    let wood = Section::of(Profile::Circle { diameter: 0.04 }, 11e9, 700.0).unwrap();
    let segments: Vec<_> = spec.segments.iter().map(|s| (s.from, s.to, s.section)).collect();
    assert_eq!(segments, [(0.0, 0.5, haunch), (1.0, 2.0, wood)]);
    assert_eq!((spec.lumps[0].x, spec.lumps[0].mass, spec.lumps[0].inertia), (1.0, 3.0, 0.0));
    let foundations: Vec<_> = spec.foundations.iter().map(|f| [f.from, f.to, f.stiffness, f.damping]).collect();
    assert_eq!(foundations, [[0.0, 2.0, 1e4, 0.0], [1.0, 1.5, 0.0, 5.0]]);
    for (table, says) in [
        (
            "[beam.b.segment.s]\nfrom = '1 m'\nto = '1 m'\nwidth = '1 cm'\nthickness = '1 cm'",
            "must be greater than from, 1 m",
        ),
        ("[beam.b.segment.s]\nfrom = '1 m'\nto = '3 m'\nwidth = '1 cm'\nthickness = '1 cm'", "outside the span"),
        ("[beam.b.segment.s]\nfrom = '0 m'\nto = '1 m'\nwidth = '1 cm'", "beam.b.segment.s.thickness: missing"),
        ("[beam.b.mass.m]\nat = '3 m'\nmass = '1 kg'", "outside the span"),
        ("[beam.b.mass.m]\nat = '1 m'\nmass = '-1 kg'", "must be at least 0 kg"),
        ("[beam.b.foundation.f]\nfrom = '-1 m'\nstiffness = '1 N/m^2'", "must be at least 0 m"),
        ("[beam.b.mass]\nat = '3 m'", "[beam.b.mass.NAME]"),
    ] {
        refused(&plain(&format!("{table}\n")), &[], &[says]);
    }
}

#[test]
fn nodes_are_even_graded_or_given() {
    assert_eq!(beam(&plain(""), &[]).spec.nodes.len(), 0);
    let graded = beam(&plain("mesh = { towards = '1 m', ratio = 3.0 }\n"), &[]).spec.nodes;
    assert_eq!((graded.len(), graded[0], graded[2], graded[4]), (5, 0.0, 1.0, 2.0));
    assert!(graded[1] > 0.5 && (graded[1] + graded[3] - 2.0).abs() < 1e-15);
    let given = beam(&format!("{SECTION}nodes = ['0 m', '30 cm', '200 cm']\n"), &[]).spec;
    assert_eq!((given.nodes.as_slice(), given.elements), ([0.0, 0.3, 2.0].as_slice(), 2));
    refused(SECTION, &[], &["beam.b.elements: missing"]);
    for (keys, says) in [
        ("nodes = ['0 m', '2 m']\nelements = 4\n", "nodes already determine the elements"),
        ("nodes = ['0 m', '1 m']\n", "must extend from 0 m to the span, 2 m"),
        ("nodes = ['0 m', '1 m', '0.5 m', '2 m']\n", "must rise: 0.5 m follows 1 m"),
        ("nodes = ['0 m', '1e-9 m', '2 m']\n", "rising, by at least a millionth of the span"),
        ("nodes = ['0 m']\n", "at least two"),
        ("elements = 4\nmesh = { towards = '3 m', ratio = 3.0 }\n", "outside the span"),
        ("elements = 4\nmesh = { towards = '1 m', ratio = 0.3 }\n", "must lie in [1, 1000]"),
    ] {
        refused(&format!("{SECTION}{keys}"), &[], &[says]);
    }
}

#[test]
fn the_axis_is_free_held_or_elastic() {
    assert_eq!(beam(&plain(""), &[]).spec.axial, Axial::Free);
    assert_eq!(beam(&plain("axial = 'held'\naxial_force = '-10 N'\n"), &[]).spec.axial, Axial::Held);
    let elastic = "axial = 'elastic'\naxial_supports = ['held', 'free']\n";
    assert_eq!(beam(&plain(elastic), &[]).spec.axial, Axial::elastic([true, false]));
    refused(&plain("axial_supports = ['held', 'free']\n"), &[], &["has no meaning with axial = free"]);
    for (supports, end) in
        [("['pinned', 'free']", "right"), ("['free', 'clamped']", "left"), ("['pinned', {}]", "right")]
    {
        let text = plain(&format!("axial = 'held'\nsupports = {supports}\n"));
        refused(&text, &[], &["beam.b.axial", &format!("the {end} end is free, so nothing holds it along the axis")]);
    }
    beam(&plain("axial = 'held'\nsupports = ['pinned', 'guided']\n"), &[]);
    refused(&plain("axial = 'held'\n"), &[("time.theta", "0.7")], &["time.theta", "`b` is held along its axis", "0.5"]);
    // Euler: π² EI/L² = 2159 N.
    beam(&plain("axial_force = '-2150 N'\n"), &[]);
    refused(
        &plain("axial_force = '-2200 N'\n"),
        &[],
        &["beam.b.axial_force = '-2200 N'", "buckles under it", "tension is positive"],
    );
    refused(
        &plain("axial = 'elastic'\nmotion = { velocity = ['1 m/s', '0 m/s'] }\n"),
        &[],
        &["can't move an elastic beam along its axis"],
    );
}

#[test]
fn damping_is_fitted_to_ratios_and_to_any_mode() {
    let fitted = "rayleigh = { frequencies = ['10 Hz', '80 Hz'], ratios = [0.01, 0.02] }\n";
    let damping = beam(&plain(fitted), &[]).spec.damping;
    for (frequency, ratio) in [(10.0, 0.01), (80.0, 0.02)] {
        let omega = std::f64::consts::TAU * frequency;
        let found = 0.5 * (damping.rayleigh_mass / omega + damping.rayleigh_stiffness * omega);
        assert!((found / ratio - 1.0).abs() < 1e-13);
    }
    for (rayleigh, says) in [
        ("frequencies = ['10 Hz', '80 Hz']", "two ratios are expected, one for each frequency, got 0"),
        ("frequencies = ['10 Hz', '80 Hz'], ratios = [0.01]", "two ratios are expected"),
        ("frequencies = ['10 Hz', '80 Hz'], ratios = [0.01, 0.01], a0 = '1 1/s'", "already determine the factors"),
        ("frequencies = ['10 Hz', '10 Hz'], ratios = [0.01, 0.01]", "other than the first one"),
        ("frequencies = ['10 Hz', '80 Hz'], ratios = [0.01, 0.5]", "else a factor is negative"),
        ("ratios = [0.01, 0.01]", "the frequencies of these ratios are missing"),
    ] {
        refused(&plain(&format!("rayleigh = {{ {rayleigh} }}\n")), &[], &[says]);
    }
    let modal = beam(&plain("modal_damping = [0.01, 0.02]\n"), &[]).spec;
    assert_eq!(modal.damping.modal, [0.01, 0.02]);
    let model = Beam::new(modal).unwrap();
    let modes = model.modes(2).unwrap();
    let rate = model.damping_power(modes.shape(1)).abs() / (2.0 * modes.circular_frequencies()[1]);
    assert!((rate / 0.02 - 1.0).abs() < 1e-9, "{rate}");
    let many = ["0.01"; 9].join(", ");
    refused(&plain(&format!("modal_damping = [{many}]\n")), &[], &["beam.b.modal_damping", "9 ratios"]);
    // Of the uniform beam the modes are known, and the finite elements give the same; a mass in the
    // middle slows the first.
    let ratio = "damping_ratio = { mode = 1, ratio = 0.02 }\n";
    let exact = beam(&plain(ratio), &[]).spec.damping.viscous;
    let with = |mass: &str| format!("{ratio}[beam.b.mass.m]\nat = '1 m'\nmass = '{mass}'\n");
    let near = beam(&plain(&with("1e-9 kg")), &[]).spec.damping.viscous;
    assert!((near / exact - 1.0).abs() < 1e-3, "{near} {exact}");
    let laden = beam(&plain(&with("5 kg")), &[]).spec;
    let modes = Beam::new(laden.clone()).unwrap().modes(1).unwrap();
    // φᵀC φ = 2ζω.
    let damped = Beam::new(laden).unwrap().damping_power(modes.shape(0));
    assert!((damped.abs() / (2.0 * 0.02 * modes.circular_frequencies()[0]) - 1.0).abs() < 1e-9);
    // A dashpot damps on top of it, however much.
    let beside = |dashpot: &str| format!("{ratio}[beam.b.support.s]\nat = '1 m'\ndashpot = '{dashpot} N s/m'\n");
    let viscous = |dashpot: &str| beam(&plain(&beside(dashpot)), &[]).spec.damping.viscous;
    assert_eq!(viscous("1e12"), viscous("0"));
    refused(&plain(&with("1 kg").replace("mode = 1", "mode = 30")), &[], &["beam.b.damping_ratio", "first 20"]);
    refused(&plain(&with("1 kg").replace("mode = 1", "mode = 9")), &[], &["have 8 elastic modes"]);
}

#[test]
fn it_starts_in_the_shape_of_a_file_or_a_mode() {
    let two = |start: &str| format!("{SECTION}elements = 2\nstart = {start}\n");
    assert_eq!(beam(&two("{ file = 'bent.csv' }"), &[]).shape, [0.0, 0.1, 0.01, 0.0, 0.0, -0.1]);
    let mode = beam(&plain("start = { mode = 2, amplitude = '-2 mm' }\n"), &[]).shape;
    assert!((mode[2].abs() - 0.002).abs() < 1e-15 && (mode[2] + mode[6]).abs() < 1e-12 && mode[4].abs() < 1e-12);
    // All of these modes is inside the elements: nodes of the pinned beam stand still.
    for (elements, mode, peaks) in [(1, 1, 1), (2, 2, 2), (20, 20, 20)] {
        let start = format!("{SECTION}elements = {elements}\nstart = {{ mode = {mode}, amplitude = '-2 mm' }}\n");
        let scene = beam(&start, &[]);
        let model = Beam::new(scene.spec).unwrap();
        let at = |k: i32| model.shape_clamped(2.0 * f64::from(k) / f64::from(32 * peaks)).deflection(&scene.shape).w;
        let largest = (0..=32 * peaks).map(|k| at(k).abs()).fold(0.0, f64::max);
        assert!((largest / 0.002 - 1.0).abs() < 1e-9, "{elements}: {largest}");
        assert!(at(16) < 0.0, "the first peak has the sign");
    }
    for (start, says) in [
        ("{ file = 'broken.csv' }", "breaks the pinned support at x = 0 m: w = 0.002 m, but must be 0 there"),
        ("{ file = 'short.csv' }", "expected 3 rows, one for each node, got 2"),
        ("{ file = 'none.csv' }", "there is no such file"),
        ("{ file = 'bent.csv', mode = 1, amplitude = '1 mm' }", "file and mode both give the shape"),
        ("{ mode = 1 }", "the shape is missing"),
        ("{}", "the shape is missing"),
        ("{ mode = 5, amplitude = '1 mm' }", "have 4 elastic modes"),
        ("'statik'", "did you mean `static`"),
    ] {
        refused(&two(start), &[], &[says]);
    }
    let elsewhere = resolve(&format!("{BARE}{}", two("{ file = 'bent.csv' }")), &[]).unwrap().document;
    assert!(elsewhere.to_toml_elsewhere(|file| format!("../{file}")).contains("start = { file = \"../bent.csv\" }"));
}

#[test]
fn large_starts_and_lost_digits_are_warned_of() {
    let warnings = |elements: u32, more: &str, step: &str| {
        let text = format!("{BARE}{SECTION}elements = {elements}\n{more}");
        let found = resolve(&text, &[("time.step", step)]).unwrap().warnings;
        found.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    assert!(warnings(20, "start = { mode = 1, amplitude = '19 cm' }\n", "1 ms").is_empty());
    let [large] = &warnings(20, "start = { mode = 1, amplitude = '21 cm' }\n", "1 ms")[..] else { panic!() };
    assert!(large.contains("beam.b.start") && large.contains("theory is for small slopes"), "{large}");
    let [few] = &warnings(5000, "", "1 ms")[..] else { panic!() };
    assert!(
        few.contains("beam.b.elements") && few.contains("digits of a step's solve") && few.contains("20 to 100"),
        "{few}"
    );
}

#[test]
fn self_weight_bends_the_beam_from_its_straight_axis() {
    let resolved = resolve(&format!("{BARE}{}", plain("self_weight = true\nstart = 'static'\n")), &[]).unwrap();
    let mut simulation = Simulation::new(&resolved.scene).unwrap();
    let place = &simulation.layout.beams[0];
    let (range, ei, load) = (place.range.clone(), 210e9 * 0.05 * 0.01_f64.powi(3) / 12.0, 7850.0 * 0.05 * 0.01 * 9.81);
    let middle = simulation.state.q[range.start + 4];
    assert!((middle / (-5.0 * load * 16.0 / (384.0 * ei)) - 1.0).abs() < 1e-12, "{middle}");
    let before = simulation.state.q.clone();
    assert_eq!(simulation.run(&mut []).unwrap(), teeter_integrator::Ended::Complete);
    let moved = simulation.state.q.iter().zip(&before).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(moved < 1e-12, "it stays where it is: {moved:e}");
    let energy = |simulation: &Simulation| {
        let energy = simulation.model.energy(&simulation.state.q, &simulation.state.v).unwrap();
        energy.kinetic + energy.elastic + energy.gravity
    };
    let mut falling =
        Simulation::new(&resolve(&format!("{BARE}{}", plain("self_weight = true\n")), &[]).unwrap().scene).unwrap();
    let start = energy(&falling);
    assert_eq!(falling.run(&mut []).unwrap(), teeter_integrator::Ended::Complete);
    assert!(falling.state.q[4] < 0.0 && (energy(&falling) - start).abs() < 1e-12, "{start} {}", energy(&falling));
}

#[test]
fn loads_act_on_a_part_of_the_span_or_move() {
    let scene = |load: &str| resolve(&format!("{BARE}{}[load.l]\non = 'b'\n{load}\n", plain("")), &[]);
    let kind = |load: &str| scene(load).unwrap().scene.loads[0].kind;
    assert_eq!(kind("distributed = '-3 N/m'"), LoadKind::Distributed { load: -3.0, from: 0.0, to: 2.0 });
    assert_eq!(kind("distributed = '-3 N/m'\nfrom = '1 m'"), LoadKind::Distributed { load: -3.0, from: 1.0, to: 2.0 });
    let moving = "at = '50 cm'\nforce = '-10 N'\nspeed = '2 m/s'";
    assert_eq!(kind(moving), LoadKind::Moving { force: -10.0, at: 0.5, speed: 2.0 });
    let entering = "at = '-50 cm'\nforce = '-10 N'\nspeed = '2 m/s'";
    assert_eq!(kind(entering), LoadKind::Moving { force: -10.0, at: -0.5, speed: 2.0 });
    for (load, says) in [
        ("distributed = '-3 N/m'\nfrom = '2 m'\nto = '1 m'", "must be greater than from, 2 m"),
        ("distributed = '-3 N/m'\nspeed = '1 m/s'", "it doesn't apply to a distributed load"),
        ("at = '1 m'\nforce = '1 N'\nto = '1 m'", "it applies only with distributed"),
        ("at = '1 m'\ncouple = '1 N m'\nspeed = '1 m/s'", "only a force can move along the beam"),
        ("at = '3 m'\nforce = '1 N'", "outside the span"),
        ("at = '-1 m'\nforce = '1 N'", "outside the span"),
    ] {
        let message = scene(load).map(drop).expect_err(load);
        assert!(message.contains(says), "{message}");
    }
    // One that moves with no speed is one that stands.
    let end = |load: &str| {
        let mut simulation = Simulation::new(&scene(load).unwrap().scene).unwrap();
        assert_eq!(simulation.run(&mut []).unwrap(), teeter_integrator::Ended::Complete);
        simulation.state.q.clone()
    };
    assert_eq!(end("at = '50 cm'\nforce = '-10 N'\nspeed = '0 m/s'"), end("at = '50 cm'\nforce = '-10 N'"));
    assert_ne!(end(moving), end("at = '50 cm'\nforce = '-10 N'"));
    assert_eq!(end("distributed = '-3 N/m'"), end("distributed = '-3 N/m'\nfrom = '0 m'\nto = '2 m'"));
}

#[test]
fn backends_give_the_same_motion() {
    let of = |word: &str, backend| {
        let found = beam(&plain(&format!("backend = '{word}'\n")), &[]);
        assert_eq!(found.backend, backend);
        let text = format!("{BARE}{}backend = '{word}'\n[load.l]\non = 'b'\nat = '1 m'\nforce = '-10 N'\n", plain(""));
        let mut simulation = Simulation::new(&resolve(&text, &[]).unwrap().scene).unwrap();
        assert_eq!(simulation.run(&mut []).unwrap(), teeter_integrator::Ended::Complete);
        simulation.state.q[4]
    };
    let auto = of("auto", WBackend::Auto);
    for (word, backend) in
        [("banded", WBackend::Banded), ("sparse", WBackend::Sparse), ("cached-columns", WBackend::CachedColumns)]
    {
        assert!((of(word, backend) / auto - 1.0).abs() < 1e-12, "{word}");
    }
}
