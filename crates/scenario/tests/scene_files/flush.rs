//! Sides that meet flush after one of the blocks has landed, and keeps a tilt of what its corners have sunk in.

use super::located::run;

/// A block that landed keeps a tilt, as one corner has sunk in deeper than the other. Where its side meets a wall flush it doesn't turn:
/// both corners of the side strike in one impact. The end is that of `event-driven`, which keeps no tilt: after the blow it slides back
/// and stops.
#[test]
fn a_side_meets_a_wall_flush_after_a_landing() {
    const TEXT: &str = "[time]\nend = '0.8 s'\n[ground]\n\
        [block.b]\ndensity = '1500 kg/m^3'\ndepth = '0.1 m'\nwidth = '0.164 m'\nheight = '0.337 m'\non = 'ground'\nat = '0 m'\n\
        tilt = '0.532 deg'\nvelocity = ['1.627 m/s', '0 m/s']\n\
        [block.wall]\ndensity = '2000 kg/m^3'\ndepth = '0.1 m'\nwidth = '0.2 m'\nheight = '0.6 m'\nposition = ['0.5 m', '0.3 m']\n\
        fixed = true\n\
        [contact.c]\nbetween = ['b', 'ground']\nfriction = 0.13\n\
        [contact.w]\nbetween = ['b', 'wall']\nfriction = 0.13\nlaw = 'energetic'\nrestitution = 0.5\n";
    for step in ["1 ms", "250 us"] {
        let (simulation, seen) = run(TEXT, step);
        let block = simulation.layout.blocks.iter().find(|block| block.name == "b").unwrap().range.clone();
        let [x, phi] = [0, 2].map(|i| simulation.state.q[block.start + i]);
        assert!((x - 0.138_406).abs() < 2e-6 && phi.abs() < 1e-5, "{step}: {x} {phi}, {:?}", seen.impacts);
    }
}

/// The same where a sliding block meets another one that has landed, and both move on together.
#[test]
fn two_sides_meet_flush_after_a_landing() {
    const TEXT: &str = "[time]\nend = '0.6 s'\n[ground]\n\
        [block.b0]\ndensity = '1440 kg/m^3'\ndepth = '0.1 m'\nwidth = '0.30 m'\nheight = '0.21 m'\non = 'ground'\nat = '0 m'\n\
        velocity = ['0.98 m/s', '0 m/s']\n\
        [block.b1]\ndensity = '2160 kg/m^3'\ndepth = '0.1 m'\nwidth = '0.165 m'\nheight = '0.20 m'\non = 'ground'\nat = '0.38 m'\n\
        tilt = '1.0 deg'\n\
        [contact.c]\nbetween = ['*', '*']\nfriction = 0.1\nlaw = 'newton'\nrestitution = 0.0\n";
    let (simulation, seen) = run(TEXT, "1 ms");
    for (name, end) in [("b0", 0.252_774_1), ("b1", 0.486_189_8)] {
        let block = simulation.layout.blocks.iter().find(|block| block.name == name).unwrap().range.clone();
        let x = simulation.state.q[block.start];
        assert!((x - end).abs() < 1e-6, "{name}: {x}, {:?}", seen.impacts);
    }
}
