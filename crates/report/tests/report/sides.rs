//! On which side blocks stand that don't rest, or rest on one that isn't their base; and columns that rocked before they stood.

use crate::page::run;
use crate::sizes::tile;

/// A crate on its right side on a beam that rings; it slides before.
#[test]
fn what_stands_on_another_side_on_what_moves_is_told_to() {
    for (name, velocity, how) in [
        ("trembles", "0 m/s", "`crate` is still trembling where it stands, on its right side, on a beam that moves"),
        ("slid", "0.3 m/s", " and lies on its right side on a beam that moves"),
    ] {
        let text = format!(
            "[time]\nend = '0.5 s'\nstep = '100 us'\n[material.steel]\ndensity = '7850 kg/m^3'\nyoungs_modulus = '210 GPa'\n[beam.t]\n\
             material = 'steel'\nspan = '1 m'\nwidth = '5 cm'\nthickness = '5 mm'\nelements = 20\n\
             damping_ratio = {{ mode = 1, ratio = 0.01 }}\n[block.crate]\nmaterial = 'steel'\nwidth = '1 cm'\nheight = '10 cm'\ndepth = '5 cm'\n\
             position = ['50 cm', '0.6 cm']\nangle = '-90 deg'\nvelocity = ['{velocity}', '0 m/s']\n[contact.f]\nbetween = ['crate', 't']\n\
             friction = 0.3\nrestitution = 0.2\n"
        );
        let ran = run(&format!("on-its-side-{name}"), &text).summary;
        assert!(ran.headline.contains(how), "{}", ran.headline);
        // The key is of what rests.
        assert_eq!((ran.verdict[0].rests_from, ran.verdict[0].lies_on.is_none()), (None, true));
    }
}

/// A hexagon that lies on the side beside its base isn't on its base, whatever it looks like.
#[test]
fn all_shapes_on_other_sides_are_counted() {
    let text = "[time]\nend = '1 s'\nstep = '500 us'\n[ground]\n[block.hexagon]\ndensity = '1000 kg/m^3'\ndepth = '10 cm'\n\
        shape = { kind = 'regular', sides = 6, radius = '8 cm' }\nposition = ['0 m', '7.5 cm']\nangle = '60 deg'\n[block.box]\n\
        density = '1000 kg/m^3'\nwidth = '10 cm'\nheight = '20 cm'\ndepth = '10 cm'\nposition = ['1 m', '5.5 cm']\nangle = '90 deg'\n\
        [block.stays]\ndensity = '1000 kg/m^3'\nwidth = '10 cm'\nheight = '20 cm'\ndepth = '10 cm'\nposition = ['2 m', '10.5 cm']\n\
        [contact.c]\nbetween = ['*', 'ground']\nfriction = 0.4\n";
    let headline = run("other-sides", text).summary.headline;
    assert!(
        headline.starts_with("all 3 blocks came to rest (2 on another side than the base), last at "),
        "{headline}"
    );
}

/// Boxes that rock as one under a pulse: whatever they do when the run ends, that they did is told, with the same φ/α.
#[test]
fn a_column_that_rocked_is_told_to_have_whenever_the_run_ends() {
    let at = |end: &str| {
        let text = format!(
            "[time]\nend = '{end}'\nstep = '500 us'\n[signal.pulse]\nshape = 'ricker'\nfrequency = '1.5 Hz'\npeak = '1 s'\n[ground]\n\
             motion = {{ acceleration = ['4 m/s^2', '0 m/s^2'], signal = 'pulse' }}\n[block.box]\ndensity = '600 kg/m^3'\nwidth = '40 cm'\n\
             height = '30 cm'\ndepth = '40 cm'\non = 'ground'\nat = '0 m'\nrepeat = {{ count = 5, stacked = true }}\n[contact.all]\n\
             between = ['*', '*']\nfriction = 0.5\n"
        );
        run(&format!("stack-to-{end}"), &text)
    };
    for (end, how) in [
        ("3 s", "rock on as one column on the base of `box-1`"),
        ("5 s", "rocked as one column on the base of `box-1` and still tremble"),
        ("6 s", "rocked as one column on the base of `box-1`, came to rest, last at t = 5.286 s"),
    ] {
        let ran = at(end);
        assert_eq!(ran.summary.headline, format!("all 5 blocks {how}; largest φ/α of the column 0.186"));
        assert_eq!(tile(&ran.html, "verdict.0.column_phi_over_alpha"), Some("0.186"), "{end}");
    }
}
