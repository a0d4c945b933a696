//! Plots of contact forces of long runs: no peak is averaged away.

use crate::page::{data, numbers, run, scenario};
use crate::plots::table;
use crate::table::column;
use std::path::Path;
use teeter_report::figures;

/// A block of 10 kg on ground that goes to and fro, so that its feet are pressed by turns, in more steps than are drawn one by one.
const SHAKEN: &str = "[time]\nend = '20 s'\nstep = '500 us'\n[ground]\nmotion = { acceleration = ['1 m/s^2', '0 m/s^2'], signal = 'shake' }\n\
    [signal.shake]\nshape = 'harmonic'\nfrequency = '25 Hz'\n[block.post]\ndensity = '2500 kg/m^3'\nwidth = '10 cm'\nheight = '40 cm'\ndepth = '10 cm'\n\
    on = 'ground'\nat = '0 m'\n[contact.feet]\nbetween = ['post', 'ground']\nfriction = 0.6\n[output]\nevery = '500 us'\n";

#[test]
fn the_peaks_of_a_rigid_contact_that_is_shaken_for_long_are_plotted_as_large_as_they_are() {
    let run = run("long-shaken", SHAKEN);
    let written = table(&run.folder.join("contacts.csv"));
    let page = data(&run.html);
    let last = |values: &[f64]| values.iter().skip(values.len() / 2).copied().collect::<Vec<_>>();
    let ends = |values: &[f64]| {
        let fold = |f: fn(f64, f64) -> f64| values.iter().copied().filter(|x| x.is_finite()).reduce(f).unwrap();
        [fold(f64::min), fold(f64::max)]
    };
    for point in page["forces"]["points"].as_array().unwrap() {
        let drawn = ends(&last(&numbers(&point["course"][0]["y"])));
        let wanted = ends(&last(&column(&written, "p_n").iter().map(|p| p / 500e-6).collect::<Vec<_>>()));
        // Means over two of the eighty steps of a period.
        for k in 0..2 {
            assert!((drawn[k] - wanted[k]).abs() < 0.01 * wanted[1], "{drawn:?} N, not {wanted:?} N");
        }
    }
}

#[test]
fn plots_of_contact_forces_say_that_they_show_extremes_of_means_over_two_steps() {
    let run = run("long-shaken-figures", SHAKEN);
    let (_, svg) = figures(&run.page).into_iter().find(|(file, _)| file.starts_with("contact_forces")).unwrap();
    let told = data(&run.html)["forces"]["rigid"].as_str().unwrap().to_owned();
    assert!(
        told.starts_with("the least and the largest of every ") && told.ends_with(", of means over 1 ms"),
        "{told}"
    );
    assert!(svg.contains("of means over 1 ms"), "{svg}");
    // Both feet stick: of how they share the tangential force only the sum is decided, and so are its extremes.
    let page = data(&run.html);
    let sum = numbers(&page["forces"]["sums"][0][1]);
    let most = sum.iter().skip(sum.len() / 2).fold(0.0_f64, |most, force| most.max(force.abs()));
    let wanted = 10.0 * (std::f64::consts::PI * 25.0 * 1e-3).sin() / (std::f64::consts::PI * 25.0 * 1e-3);
    assert!((most / wanted - 1.0).abs() < 0.01, "{most} N, not {wanted} N");
}

/// A statue on two springs that sways as the cart below it is pushed.
const PADDED: &str = "[time]\nend = '2 s'\nstep = '100 us'\n[ground]\nmotion = { acceleration = ['0.4 m/s^2', '0 m/s^2'], signal = 'shake' }\n\
    [signal.shake]\nshape = 'one-sine'\nperiod = '400 ms'\n[block.statue]\ndensity = '2500 kg/m^3'\nwidth = '10 cm'\nheight = '30 cm'\ndepth = '10 cm'\n\
    on = 'ground'\nat = '0 m'\n[contact.pads]\nbetween = ['statue', 'ground']\nfriction = 0.6\nlaw = 'kelvin-voigt'\nstiffness = '200 kN/m'\n\
    damping = '20 N s/m'\n";

#[test]
fn tangential_forces_of_feet_on_springs_are_plotted_as_their_sum() {
    let run = run("padded", PADDED);
    let page = data(&run.html);
    assert_eq!(page["forces"]["shares"], serde_json::json!([0]));
    // What moves 7.5 kg, not the limit of friction of each foot.
    let sum = numbers(&page["forces"]["sums"][0][1]);
    let most = sum.iter().fold(0.0_f64, |most, force| most.max(force.abs()));
    assert!((1.0..8.0).contains(&most), "{most} N");
    let (_, svg) = figures(&run.page).into_iter().find(|(file, _)| file.starts_with("contact_forces")).unwrap();
    assert!(svg.contains("sum over the points"));
}

fn two_blocks() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/two-blocks-on-beam.toml");
    std::fs::read_to_string(path).unwrap()
}

#[test]
fn slip_that_counts_only_while_a_foot_presses_says_so_where_feet_differ() {
    let note = |html: &str| {
        let page = data(html);
        let panels = page["panels"].as_array().unwrap().iter();
        let slips = panels.filter(|panel| panel["id"].as_str().unwrap().starts_with("slip"));
        slips.filter(|panel| panel["note"].as_str().is_some_and(|note| note.contains("only while it presses"))).count()
    };
    assert!(note(&run("chattering", &two_blocks()).html) > 0, "its blocks chatter");
    assert_eq!(note(&scenario("sliding").html), 0);
}

#[test]
fn a_note_on_ratios_that_are_left_out_names_the_blocks_whose_they_are() {
    let text = "[time]\nend = '0.5 s'\nstep = '50 us'\n[ground]\n[material.steel]\ndensity = '7850 kg/m^3'\nyoungs_modulus = '210 GPa'\n[beam.deck]\n\
        material = 'steel'\nspan = '1 m'\nposition = ['0 m', '50 cm']\nwidth = '12 cm'\nthickness = '12 mm'\nelements = 10\nsupports = ['pinned', 'pinned']\n\
        [block.post]\ndensity = '2400 kg/m^3'\nwidth = '6 cm'\nheight = '30 cm'\ndepth = '8 cm'\non = 'deck'\nat = '50 cm'\ntilt = '5 deg'\n\
        [block.stone]\ndensity = '2400 kg/m^3'\nwidth = '6 cm'\nheight = '30 cm'\ndepth = '8 cm'\non = 'ground'\nat = '2 m'\ntilt = '5 deg'\n\
        [contact.c]\nbetween = ['post', 'deck']\nfriction = 0.5\n[contact.d]\nbetween = ['stone', 'ground']\nfriction = 0.5\n";
    let html = &run("two-ratios", text).html;
    assert!(html.contains(">ω⁺/ω⁻</th>") && html.contains("Of post, on a beam, no ω⁺/ω⁻ is given"));
    // Each has the column that tells of it.
    assert!(html.contains(">Next peak / previous</th>") && html.contains(">Next lift / previous</th>"));
}
