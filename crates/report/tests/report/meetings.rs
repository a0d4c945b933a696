//! What is inside what without a contact is said: before the run under what is left out, in it as a warning, once a pair.

use crate::impacts::{scenario, summary};
use teeter_report::Summary;

const CODES: [&str; 3] = ["passes-through", "between-corners", "past-the-end"];

/// Warnings of meetings: their codes and counts.
fn met(summary: &Summary) -> Vec<(String, u64)> {
    let met = summary.warnings.iter().filter(|warning| CODES.contains(&warning.code.as_ref()));
    met.map(|warning| (warning.code.to_string(), warning.count)).collect()
}

fn only(summary: &Summary, code: &str, texts: &[&str]) {
    assert_eq!(met(summary), [(code.to_owned(), 1)]);
    let warning = summary.warnings.iter().find(|warning| warning.code == code).unwrap();
    for text in texts {
        assert!(warning.text.contains(text), "{}", warning.text);
    }
}

fn left_out(summary: &Summary, text: &str) -> bool {
    summary.model.left_out.iter().any(|left_out| left_out.contains(text))
}

const HEAD: &str = "time = { end = \"0.5 s\", step = \"1 ms\" }\nmaterial.s = { density = \"7850 kg/m^3\", youngs_modulus = \"210 GPa\" }\n";

fn block(name: &str, width: &str, place: &str) -> String {
    format!(
        "block.{name} = {{ material = \"s\", width = \"{width}\", height = \"10 cm\", depth = \"10 cm\", {place} }}\n"
    )
}

#[test]
fn blocks_that_pass_through_each_other_are_told_once() {
    let scene = format!(
        "{HEAD}ground = {{}}\n{}{}contact.g = {{ between = [\"p\", \"ground\"], friction = 0.1 }}\n\
         contact.h = {{ between = [\"q\", \"ground\"], friction = 0.1 }}\n",
        block("p", "10 cm", "on = \"ground\", at = \"0 m\", velocity = [\"2 m/s\", \"0 m/s\"]"),
        block("q", "10 cm", "on = \"ground\", at = \"20 cm\""),
    );
    let found = summary("pounding", &scene, &[]);
    only(&found, "passes-through", &["`p` and `q` overlap", "no contact joins the two"]);
    assert!(left_out(&found, "contact between blocks"));
    // They are apart again at the only rows, its start and its end.
    only(&summary("unseen-pounding", &scene, &[("output.every", "0.5 s")]), "passes-through", &["`p` and `q` overlap"]);
    let slow = summary("no-pounding", &scene, &[("block.p.velocity", "['0.1 m/s', '0 m/s']")]);
    assert!(met(&slow).is_empty());
}

#[test]
fn a_block_in_ground_or_a_beam_that_no_contact_names_is_told() {
    let scene = format!("{HEAD}ground = {{}}\n{}", block("p", "10 cm", "position = [\"0 m\", \"10 cm\"]"));
    let found = summary("no-ground-contact", &scene, &[]);
    only(&found, "passes-through", &["`p`", "below the ground", "no contact joins the two"]);
    assert!(left_out(&found, "with the ground or a beam without a [contact]"));

    let beam = "beam.b = { material = \"s\", span = \"1 m\", width = \"5 cm\", thickness = \"1 cm\", elements = 4 }\n";
    let scene = format!("{HEAD}{beam}{}", block("p", "10 cm", "position = [\"0.5 m\", \"10 cm\"]"));
    only(&summary("no-beam-contact", &scene, &[]), "passes-through", &["`b` is inside `p`"]);
}

#[test]
fn a_beams_support_in_a_base_between_the_corners_is_told() {
    // Both corners sink with the spans, the support between them doesn't.
    let scene = format!(
        "{HEAD}beam.b = {{ material = \"s\", span = \"1 m\", width = \"1 cm\", thickness = \"5 mm\", elements = 20, start = \"static\", \
         support.pier = {{ at = \"50 cm\", kind = \"pinned\" }} }}\n{}contact.c = {{ between = [\"p\", \"b\"], friction = 0.5 }}\n",
        block("p", "40 cm", "on = \"b\", at = \"50 cm\"")
    );
    let held = summary("support-held", &scene, &[("time.end", "10 ms")]);
    assert!(met(&held).is_empty() && !left_out(&held, "a hump or a support"), "{:?}", met(&held));
    let found = summary("support", &scene, &[("time.end", "10 ms"), ("contact.c.points", "corners")]);
    assert!(found.max_penetration < 1e-6, "{}", found.max_penetration);
    only(&found, "between-corners", &["`b` is", "inside `p` between its corners", "max_penetration"]);
    assert!(left_out(&found, "a hump or a support"));
}

#[test]
fn a_corner_past_the_end_of_a_beam_is_told() {
    let scene = format!(
        "{HEAD}beam.cant = {{ material = \"s\", span = \"50 cm\", width = \"5 cm\", thickness = \"6 mm\", elements = 25, \
         supports = [\"clamped\", \"free\"] }}\n{}contact.k = {{ between = [\"b\", \"cant\"], friction = 0.3 }}\n",
        block("b", "4 cm", "position = [\"49.5 cm\", \"8 cm\"]")
    );
    let found = summary("off-the-end", &scene, &[("time.step", "200 us"), ("contact.k.points", "corners")]);
    // Then the block falls on, the beam through its base.
    let first = found.warnings.iter().find(|warning| CODES.contains(&warning.code.as_ref())).unwrap();
    assert_eq!((first.code.as_ref(), first.count), ("past-the-end", 1));
    assert!(first.text.contains("the end of `cant`") && first.text.contains("inside `b`"), "{}", first.text);
}

#[test]
fn scenarios_have_no_meetings() {
    for name in ["free-rocking-on-beam", "free-rocking-on-ground", "drop", "sliding", "held-beam", "two-span-beam"] {
        let found = summary(&format!("met-{name}"), &scenario(name), &[("time.end", "0.2 s")]);
        assert!(met(&found).is_empty(), "{name}: {:?}", met(&found));
    }
}

#[test]
fn thin_plates_that_pass_through_each_other_are_told() {
    // Their overlap is 1 mm at the most, a five hundredth of their length.
    let plate = |name: &str, place: &str| {
        format!(
            "block.{name} = {{ material = \"s\", width = \"1 mm\", height = \"50 cm\", depth = \"10 cm\", {place} }}\n"
        )
    };
    let scene = format!(
        "{HEAD}world.gravity = [\"0 m/s^2\", \"0 m/s^2\"]\n{}{}",
        plate("a", "position = [\"0 m\", \"0 m\"], velocity = [\"4 cm/s\", \"0 m/s\"]"),
        plate("b", "position = [\"1 cm\", \"0 m\"]")
    );
    only(&summary("plates", &scene, &[]), "passes-through", &["`a` and `b` overlap"]);
}

#[test]
fn blocks_that_a_step_may_take_past_each_other_are_told_once() {
    let scene = |speed: &str| {
        format!(
            "{HEAD}world.gravity = \"1e-9 m/s^2\"\n{}{}contact.c = {{ between = [\"p\", \"q\"], friction = 0.5 }}\n",
            block("p", "10 cm", &format!("position = [\"-1 m\", \"0 m\"], velocity = [\"{speed}\", \"0 m/s\"]")),
            block("q", "1 cm", "position = [\"1 m\", \"0 m\"]"),
        )
    };
    // The scheme that is chosen finds the touch within the step; one with fixed steps looks at their ends.
    let located = summary("located-bullet", &scene("300 m/s"), &[("time.end", "10 ms")]);
    assert!(located.warnings.iter().all(|warning| warning.code != "fast-pass"), "{:?}", located.warnings);
    assert!((located.impacts[0].t - (2.0 - 0.055) / 300.0).abs() < 1e-12, "{:?}", located.impacts);
    let fixed = [("time.end", "10 ms"), ("time.scheme", "moreau-jean-closed")];
    let found = summary("bullet", &scene("300 m/s"), &fixed);
    let told: Vec<_> = found.warnings.iter().filter(|warning| warning.code == "fast-pass").collect();
    assert_eq!(told.len(), 1, "{:?}", found.warnings);
    assert!(told[0].text.contains("`p` and `q` come 300 mm past each other"), "{}", told[0].text);
    let slow = summary("no-bullet", &scene("30 m/s"), &[("time.end", "100 ms")]);
    assert!(slow.warnings.iter().all(|warning| warning.code != "fast-pass"), "{:?}", slow.warnings);
    assert!(!slow.impacts.is_empty());
}

#[test]
fn what_turns_past_another_block_is_found_or_told() {
    // A rod, 4 mm thick, whose point at the ball moves by 22 mm in a step.
    let scene = |angle: f64| {
        let ball = [0.45 * angle.cos(), 0.45 * angle.sin()];
        let of = "density = \"1000 kg/m^3\", depth = \"1 m\"";
        format!(
            "time = {{ end = \"20 ms\", step = \"1 ms\" }}\nworld.gravity = \"0 m/s^2\"\n\
             block.rod = {{ {of}, width = \"1 m\", height = \"4 mm\", position = [\"0 m\", \"0 m\"], spin = \"50 rad/s\" }}\n\
             block.ball = {{ {of}, radius = \"3 mm\", position = [\"{} m\", \"{} m\"] }}\n\
             contact.c = {{ between = [\"rod\", \"ball\"], friction = 0.0 }}\n",
            ball[0], ball[1]
        )
    };
    for k in 0..12 {
        let scene = scene(0.5 + 0.005 * f64::from(k));
        for scheme in ["moreau-jean-located", "event-driven"] {
            let found = summary(&format!("rod-{scheme}-{k}"), &scene, &[("time.scheme", scheme)]);
            assert_eq!(found.impacts.len(), 1, "{scheme}, {k}");
        }
        let found = summary(&format!("rod-closed-{k}"), &scene, &[("time.scheme", "moreau-jean-closed")]);
        let told = found.warnings.iter().any(|warning| warning.code == "fast-pass");
        assert!(told, "{k}: {:?}", found.warnings);
    }
}

#[test]
fn a_step_through_a_crest_of_the_ground_is_told() {
    let scene = |speed: &str| {
        format!(
            "time = {{ end = \"20 ms\", step = \"1 ms\", scheme = \"moreau-jean-closed\" }}\n\
             ground.profile.points = [[\"-1 m\", \"0 m\"], [\"-2 mm\", \"0 m\"], [\"0 m\", \"3 cm\"], [\"2 mm\", \"0 m\"], [\"1 m\", \"0 m\"]]\n\
             block.b = {{ density = \"1000 kg/m^3\", depth = \"1 m\", width = \"2 cm\", height = \"2 cm\", position = [\"-9.2 cm\", \"1 cm\"], \
             velocity = [\"{speed}\", \"0 m/s\"] }}\ncontact.c = {{ between = [\"b\", \"ground\"], friction = 0.0 }}\n"
        )
    };
    let told = |speed: &str| {
        let found = summary(&format!("spike-{}", &speed[..2]), &scene(speed), &[]);
        found.warnings.iter().find(|warning| warning.code == "fast-pass").map(|warning| warning.text.clone())
    };
    assert!(told("20.5 m/s").is_some_and(|text| text.contains("`b` went through a crest of the ground")));
    assert_eq!(told("10 m/s"), None);
}

/// The beam is taken along by the columns that it lies on, into a post that it doesn't touch at the start.
#[test]
fn a_beam_that_drifts_along_its_axis_is_found_where_it_is() {
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../.ci/scenes/beam-taken-along.toml");
    let scene = std::fs::read_to_string(file).unwrap();
    assert!(met(&summary("taken-along-freely", &scene, &[])).is_empty());
    let post = "\n[block.post]\ndensity = \"2400 kg/m^3\"\nwidth = \"10 cm\"\nheight = \"10 cm\"\ndepth = \"10 cm\"\nposition = [\"1.3 m\", \"0 m\"]\nfixed = true\n";
    only(&summary("taken-into-a-post", &(scene + post), &[]), "passes-through", &["`lintel` is inside `post`"]);
}
