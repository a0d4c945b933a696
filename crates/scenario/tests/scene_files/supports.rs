//! What lies over the supports of beams that are straight there.

use super::sides::{forces, simulation};

const G: f64 = 9.81;

/// A plank of 28 cm over two piers, 20 cm apart, of a strip without weight of its own: it doesn't come out over them before it is pressed beside them.
const PLANK: &str = "[time]\nend = '0.1 s'\nstep = '200 us'\nscheme = 'moreau-jean-closed'\n\
     [material.a]\ndensity = '2700 kg/m^3'\nyoungs_modulus = '69 GPa'\n[material.s]\ndensity = '7850 kg/m^3'\n\
     [beam.strip]\nmaterial = 'a'\nspan = '80 cm'\nwidth = '3 cm'\nthickness = '3 mm'\nelements = 24\nstart = 'static'\nsurface = 'axis'\n\
     [beam.strip.support.one]\nat = '30 cm'\ndeflection = 'fixed'\nrotation = 'free'\n\
     [beam.strip.support.two]\nat = '50 cm'\ndeflection = 'fixed'\nrotation = 'free'\n\
     [block.p]\nmaterial = 's'\nwidth = '28 cm'\nheight = '1 cm'\ndepth = '3 cm'\non = 'strip'\nat = '41 cm'\n\
     [contact.c]\nbetween = ['p', 'strip']\nfriction = 0.5\n";

/// N.
const WEIGHT: f64 = 7850.0 * 0.28 * 0.01 * 0.03 * G;

/// Runs a scene in which nothing moves, and returns the vertical forces of its end, N.
fn resting(text: &str, sets: &[(&str, &str)]) -> Vec<(String, f64)> {
    let mut simulation = simulation(text, sets);
    let put = simulation.state.q.clone();
    let found = forces(&mut simulation);
    let moved = put.iter().zip(&simulation.state.q).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(moved < 1e-12, "{sets:?}: {moved:e}");
    found.on.into_iter().map(|(name, force)| (name, force[1])).filter(|(_, force)| *force > 1e-12 * WEIGHT).collect()
}

fn is_near(found: f64, wanted: f64) -> bool {
    (found / wanted - 1.0).abs() < 1e-8
}

#[test]
fn a_plank_rests_on_two_piers_of_a_strip_that_is_straight_over_them() {
    for (scheme, start, rotation, surface) in [
        ("closed", "static", "free", "axis"),
        ("closed", "undeformed", "free", "top"),
        ("projected", "static", "fixed", "axis"),
        ("located", "undeformed", "free", "axis"),
        // Held against turning, the strip is straight at the pier to the last digit, but for rounding.
        ("closed", "undeformed", "fixed", "axis"),
        ("closed", "static", "fixed", "top"),
    ] {
        let [scheme, start, rotation, surface] =
            [&format!("moreau-jean-{scheme}"), start, rotation, surface].map(|value| format!("'{value}'"));
        let forces = resting(
            PLANK,
            &[
                ("time.scheme", &scheme),
                ("beam.strip.start", &start),
                ("beam.strip.support.one.rotation", &rotation),
                ("beam.strip.support.two.rotation", &rotation),
                ("beam.strip.surface", &surface),
            ],
        );
        // By levers: 9 cm to the right of 41 cm, 11 cm to its left.
        let [(one, left), (two, right)] = &forces[..] else { panic!("{forces:?}") };
        assert_eq!([one.as_str(), two], ["c hump-1", "c hump-2"]);
        assert!(is_near(*left, 0.45 * WEIGHT) && is_near(*right, 0.55 * WEIGHT), "{scheme} {start}: {forces:?}");
    }
}

#[test]
fn a_support_under_a_corner_is_no_second_contact() {
    for at in ["40 cm", "40.000001 cm"] {
        for surface in ["'axis'", "'top'"] {
            let at = format!("'{at}'");
            let sets = [("block.p.at", at.as_str()), ("block.p.width", "'20 cm'"), ("beam.strip.surface", surface)];
            let forces = resting(PLANK, &sets);
            let names: Vec<&str> = forces.iter().map(|(name, _)| name.as_str()).collect();
            assert_eq!(names, ["c bottom-left", "c bottom-right"], "{at} {surface}");
        }
    }
}

/// More supports than summits that are told apart: of those under a level base, the outer ones stay. On the eight from the left alone it would tip.
#[test]
fn a_plank_over_thirteen_piers_rests_on_the_outer_ones() {
    let [strip, _, block] = [0, 1, 2].map(|k| PLANK.split("[beam.strip.support.").nth(k).unwrap());
    let block = &block[block.find("[block.p]").unwrap()..];
    let piers = (40..53).map(|at| format!("[beam.strip.support.p{at}]\nat = '{at} cm'\ndeflection = 'fixed'\n"));
    let text = format!("{strip}{}{block}", piers.collect::<String>());
    let forces = resting(&text, &[("block.p.at", "'50 cm'")]);
    let sum: f64 = forces.iter().map(|(_, force)| force).sum();
    let right: f64 = forces.iter().filter(|(name, _)| name.as_str() >= "c hump-5").map(|(_, force)| force).sum();
    assert!(is_near(sum, WEIGHT) && right > 0.5 * WEIGHT, "{forces:?}");
}
