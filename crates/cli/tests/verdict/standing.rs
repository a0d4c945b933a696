//! What has stopped sliding or rocking, though it isn't still.

use super::{folder, written};

const STEEL: &str = "[material.stone]\ndensity = '2400 kg/m^3'\n[material.steel]\ndensity = '7850 kg/m^3'\nyoungs_modulus = '210 GPa'\n";

/// A crate that slides on a deck released from straight: it has stopped long before the deck has.
#[test]
fn what_only_sways_with_its_beam_does_not_slide_on() {
    let text = format!(
        "[time]\nend = '1.5 s'\nstep = '200 us'\n{STEEL}[beam.deck]\nmaterial = 'steel'\nspan = '2 m'\nwidth = '20 cm'\n\
         thickness = '20 mm'\nelements = 20\nsupports = ['pinned', 'pinned']\ndamping_ratio = {{ mode = 1, ratio = 0.002 }}\n\
         start = 'undeformed'\nself_weight = true\n[block.low]\nmaterial = 'stone'\nwidth = '20 cm'\nheight = '10 cm'\ndepth = '20 cm'\n\
         on = 'deck'\nat = '1.2 m'\nvelocity = ['0.5 m/s', '0 m/s']\n[contact.d]\nbetween = ['low', 'deck']\nfriction = 0.5\n"
    );
    let ran = written(&folder("verdict-sways"), &text);
    let (t, x) = (ran.column("t"), ran.column("low.x"));
    let late: Vec<f64> = t.iter().zip(&x).filter(|(t, _)| **t > 1.0).map(|(_, x)| *x).collect();
    let spread = late.iter().fold(f64::MIN, |a, x| a.max(*x)) - late.iter().fold(f64::MAX, |a, x| a.min(*x));
    let headline = ran.summary["headline"].as_str().unwrap();
    assert!(spread < 3e-4, "{spread}: it has stopped");
    assert!(
        headline.starts_with("`low` slid by ") && headline.contains(" and stands on a beam that moves"),
        "{headline}"
    );
    assert!(ran.verdict("low")["speed"].is_null());
}

/// A statue that leans is jolted; with both feet on its pads it sways on about its lean.
#[test]
fn what_stands_on_pads_with_both_feet_does_not_rock() {
    let text = format!(
        "[time]\nend = '3 s'\nstep = '100 us'\n{STEEL}[signal.jolt]\nshape = 'ricker'\npeak = '0.7 s'\nfrequency = '1.4 Hz'\n\
         [block.cart]\nmaterial = 'stone'\nwidth = '2 m'\nheight = '20 cm'\ndepth = '50 cm'\nposition = ['0 m', '40 cm']\n\
         motion = {{ acceleration = ['4 m/s^2', '0 m/s^2'], angle = '0 deg', signal = 'jolt' }}\n[block.padded]\nmaterial = 'stone'\n\
         shape = {{ kind = 'trapezoid', bottom = '20 cm', top = '12 cm', height = '70 cm', shift = '6 cm' }}\ndepth = '20 cm'\non = 'cart'\n\
         at = '50 cm'\n[contact.p]\nbetween = ['padded', 'cart']\nfriction = 0.6\nlaw = 'kelvin-voigt'\nstiffness = '4e5 N/m'\n\
         damping = '600 N s/m'\n"
    );
    let ran = written(&folder("verdict-pads"), &text);
    let headline = ran.summary["headline"].as_str().unwrap();
    assert!(headline.starts_with("`padded` is still vibrating on its contacts"), "{headline}");
    assert!(ran.verdict("padded")["last_peak"].is_null());
    // As it is jolted it does rock.
    let jolted = written(&folder("verdict-pads-jolted"), &text.replace("end = '3 s'", "end = '0.9 s'"));
    assert!(jolted.summary["headline"].as_str().unwrap().contains("rock"), "{}", jolted.summary["headline"]);
}

/// It rocks for half a second, then both of its feet ride on a beam that hardly loses energy: its angle is that of the beam.
#[test]
fn what_stands_on_a_beam_that_rings_does_not_rock_on() {
    for end in ["1.5 s", "1.58 s", "2 s", "2.4 s"] {
        let text = format!(
            "[time]\nend = '{end}'\nstep = '100 us'\n{STEEL}[beam.deck]\nmaterial = 'steel'\nspan = '1 m'\nwidth = '5 cm'\nthickness = '8 mm'\n\
             elements = 20\nsupports = ['pinned', 'pinned']\ndamping_ratio = {{ mode = 1, ratio = 0.001 }}\nstart = 'static'\n\
             probes = ['32 cm', '38 cm']\n[block.b]\nmaterial = 'stone'\nwidth = '6 cm'\nheight = '12 cm'\ndepth = '5 cm'\non = 'deck'\n\
             at = '35 cm'\ntilt = '8 deg'\n[contact.c]\nbetween = ['b', 'deck']\nfriction = 0.5\n"
        );
        let ran = written(&folder(&format!("verdict-rings-{}", end.replace(' ', "-"))), &text);
        let (t, phi) = (ran.column("t"), ran.column("b.phi"));
        let [left, right] = ["deck.w@0.32", "deck.w@0.38"].map(|name| ran.column(name));
        let alpha = 0.5_f64.atan();
        let angle = |k: usize| phi[k] - (right[k] - left[k]).atan2(0.06);
        let lifted = (0..t.len()).rfind(|k| angle(*k).abs() > 0.01 * alpha);
        let stands_from = t[lifted.unwrap()];
        assert!((0.2..0.9).contains(&stands_from), "{stands_from}");
        // Small swings to both sides are turns by a hundredth of α, though no angle is as large any more.
        let (mut low, mut high, mut turned) = (angle(0), angle(0), 0.0);
        for (k, t) in t.iter().enumerate() {
            (low, high) = (low.min(angle(k)), high.max(angle(k)));
            if high - low >= 0.01 * alpha {
                (low, high, turned) = (angle(k), angle(k), *t);
            }
        }
        let headline = ran.summary["headline"].as_str().unwrap();
        let at = headline.split_once("at t = ").map_or("", |(_, rest)| rest);
        let told: f64 = at.split(' ').next().and_then(|number| number.parse().ok()).unwrap_or(0.0);
        assert!(
            headline.starts_with("`b` stopped rocking at t = ") || headline.starts_with("`b` came to rest at t = "),
            "{end}: {headline}"
        );
        assert!(
            headline.starts_with("`b` came") || (stands_from - 0.01..turned + 0.01).contains(&(1e-3 * told)),
            "{stands_from} to {turned}: {headline}"
        );
        assert!(ran.verdict("b")["last_peak"].is_null(), "{headline}");
    }
}
