//! What carries a block that wasn't placed on anything.

use crate::page::run;

/// A post stands on the ground, and can be touched by a ball, which its contacts name first: neither one beside it, which rolls away, nor one above it,
/// which flies away, carries it.
#[test]
fn what_goes_away_carried_nothing() {
    for (name, ball, at) in [("beside", "5 cm", "6.1 cm"), ("above", "5 cm", "30 cm"), ("level", "20 cm", "22 cm")] {
        let text = format!(
            "[time]\nend = '0.5 s'\nstep = '500 us'\n[ground]\nincline = '2 deg'\n[block.post]\ndensity = '2000 kg/m^3'\nwidth = '10 cm'\n\
             height = '40 cm'\ndepth = '10 cm'\nposition = ['0 m', '20.1 cm']\nangle = '2 deg'\n[block.ball]\ndensity = '2000 kg/m^3'\n\
             radius = '{ball}'\ndepth = '10 cm'\nposition = ['27 cm', '{at}']\nvelocity = ['2 m/s', '0 m/s']\n[contact.c]\n\
             between = ['*', '*']\nfriction = 0.6\n"
        );
        let ran = run(&format!("goes-away-{name}"), &text);
        let of = &ran.summary.verdict[0];
        // It comes down by a millimetre.
        let displaced = of.displaced.unwrap();
        assert!(displaced.abs() < 1e-3, "{name}: {displaced}");
        // Its angle counts from the slope on which it stands.
        assert!(of.max_phi_over_alpha.unwrap() < 0.02, "{name}: {of:?}");
    }
}
