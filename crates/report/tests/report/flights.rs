//! What is told of blocks in the air.

use crate::page::run;
use crate::plots::table;
use crate::table::column;

/// A block that rocks is thrown up and turns in the air by far more than α: there is no foot about which it could overturn.
#[test]
fn an_angle_in_flight_is_no_part_of_the_critical_one() {
    let text = "[time]\nend = '170 ms'\nstep = '200 us'\n[ground]\n[signal.kick]\nshape = 'half-sine'\nstart = '0 s'\nduration = '30 ms'\n\
        [force.push]\non = 'box'\nforce = ['0 N', '150 N']\ncouple = '2 N m'\nsignal = 'kick'\n[block.box]\ndensity = '1000 kg/m^3'\n\
        width = '10 cm'\nheight = '20 cm'\ndepth = '10 cm'\non = 'ground'\nat = '0 m'\ntilt = '4 deg'\n[contact.base]\n\
        between = ['box', 'ground']\nfriction = 0.6\n";
    let ran = run("turns-in-the-air", text);
    let largest = ran.summary.max_phi_over_alpha.unwrap();
    let rows = table(&ran.folder.join("trajectory.csv"));
    let alpha = 0.5_f64.atan();
    let highest = column(&rows, "box.y").iter().copied().fold(0.0, f64::max);
    let most = column(&rows, "box.phi").iter().map(|phi| phi.abs() / alpha).fold(0.0, f64::max);
    assert!(highest > 0.14, "it flies: {highest}");
    assert!(most > 1.3 && largest < 0.5, "{most} in the air, {largest} on a foot");
    assert!(largest >= 4_f64.to_radians() / alpha - 1e-9, "{largest}");
}
