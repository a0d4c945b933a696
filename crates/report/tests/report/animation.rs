//! What animations draw of a scene.

use teeter_report::{Animation, AnimationFormat, animate};

/// At rest a dashpot changes nothing but the picture.
#[test]
fn a_dashpot_is_drawn() {
    let film = |name: &str, dashpot: &str| {
        let text = format!(
            "[time]\nend = '10 ms'\nstep = '1 ms'\n[material.s]\ndensity = '7850 kg/m^3'\nyoungs_modulus = '210 GPa'\n\
             [beam.t]\nmaterial = 's'\nspan = '1 m'\nwidth = '5 cm'\nthickness = '2 cm'\nelements = 4\n\
             support.a = {{ at = '0.5 m', spring = '5 MN/m'{dashpot} }}\n"
        );
        let page = crate::page::run(name, &text).page;
        animate(&page, &Animation::new(AnimationFormat::Gif).width(480).unwrap()).unwrap().0
    };
    let without = film("undamped", "");
    assert!(without == film("undamped-again", ""));
    assert!(without != film("dashpot", ", dashpot = '2 kN s/m'"));
}
