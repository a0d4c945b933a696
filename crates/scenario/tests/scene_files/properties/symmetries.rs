//! Changes of a scene that change its motion in a known way.

use super::drawn::{Drawn, Law, Motion as Driven, Placement, Segment, Surface};
use super::motion::{Horizon, Motion, NoMotion, PROBES, extent, motion, run, simulation};
use super::{Checked, check};
use proptest::prelude::*;
use teeter_integrator::Plan;

/// A motion as a changed scene has it, row by row.
fn changed(motion: &Motion, change: impl Fn(usize, &[f64]) -> Vec<f64>) -> Motion {
    Motion { rows: motion.rows.iter().enumerate().map(|(k, row)| change(k, row)).collect(), ..motion.clone() }
}

/// Whether the motion of the scene `other`, changed back, is that of the scene.
fn same(
    drawn: &Drawn,
    other: &Drawn,
    back: impl Fn(usize, &[f64]) -> Vec<f64>,
) -> Result<Result<Checked, String>, NoMotion> {
    let (base, other) = (motion(drawn)?, motion(other)?);
    let horizon = Horizon::of(drawn, &base, extent(drawn, &base).max(extent(drawn, &other)))?;
    let judged = horizon.agree(drawn, &base, &changed(&other, back));
    Ok(judged.map(|judged| Checked { judged, of: base.rows.len() }))
}

fn mirrored(drawn: &Drawn) -> Drawn {
    let mut mirror = drawn.clone();
    let driven = |motion: &mut Option<Driven>| {
        if let Some(Driven::Shaken([x, _]) | Driven::Travelling([x, _])) = motion {
            *x = -*x;
        }
    };
    mirror.gravity[0] = -drawn.gravity[0];
    if let Some(ground) = &mut mirror.ground {
        ground.incline = -ground.incline;
        driven(&mut ground.motion);
    }
    for beam in &mut mirror.beams {
        beam.position[0] = -(beam.position[0] + beam.span);
        beam.supports.reverse();
        if let Some(Segment { from, to, .. }) = &mut beam.segment {
            (*from, *to) = (beam.span - *to, beam.span - *from);
        }
        if let Some([at, _]) = &mut beam.lump {
            *at = beam.span - *at;
        }
        driven(&mut beam.motion);
    }
    for block in &mut mirror.blocks {
        match &mut block.placement {
            Placement::Standing { at, tilt } => (*at, *tilt) = (-*at, -*tilt),
            Placement::Flying { position, angle } => (position[0], *angle) = (-position[0], -*angle),
        }
        block.velocity[0] = -block.velocity[0];
        block.spin = -block.spin;
        if let Some([x, _, couple]) = &mut block.load {
            (*x, *couple) = (-*x, -*couple);
        }
    }
    mirror
}

#[test]
fn a_mirrored_scene_moves_as_the_mirror_image() {
    check("mirror", "proptest-regressions/mirror.txt", Just(()), |drawn, ()| {
        let blocks = 3 * drawn.blocks.len();
        same(drawn, &mirrored(drawn), |_, row| {
            let mut row = row.to_vec();
            let (places, beams) = row.split_at_mut(blocks);
            places.chunks_exact_mut(3).for_each(|q| (q[0], q[2]) = (-q[0], -q[2]));
            beams.chunks_exact_mut(PROBES.len()).for_each(<[f64]>::reverse);
            row
        })
    });
}

#[test]
fn a_frame_that_travels_evenly_changes_nothing() {
    let frame = [-3.0..3.0, -3.0..3.0];
    check("galilei", "proptest-regressions/galilei.txt", frame, |drawn, frame| {
        let mut still = drawn.clone();
        let surfaces = |drawn: &mut Drawn, motion| {
            drawn.beams.iter_mut().for_each(|beam| beam.motion = motion);
            drawn.ground.iter_mut().for_each(|ground| ground.motion = motion);
        };
        surfaces(&mut still, None);
        let mut moving = still.clone();
        surfaces(&mut moving, Some(Driven::Travelling(*frame)));
        for block in &mut moving.blocks {
            block.velocity = [block.velocity[0] + frame[0], block.velocity[1] + frame[1]];
        }
        let blocks = 3 * drawn.blocks.len();
        same(&still, &moving, |step, row| {
            let mut row = row.to_vec();
            let t = step as f64 * drawn.step;
            for q in row[..blocks].chunks_exact_mut(3) {
                (q[0], q[1]) = (q[0] - frame[0] * t, q[1] - frame[1] * t);
            }
            row
        })
    });
}

/// The scene in other units of length, mass and time.
fn scaled(drawn: &Drawn, units: &[f64; 3]) -> Drawn {
    let mut scaled = drawn.clone();
    scaled.each_number(&mut |number, dimension, _| {
        let factors = units.iter().zip(dimension);
        *number *= factors.map(|(unit, power)| unit.powf(power)).product::<f64>();
    });
    scaled
}

fn unscaled(drawn: &Drawn, length: f64, row: &[f64]) -> Vec<f64> {
    let blocks = 3 * drawn.blocks.len();
    let back = |(k, x): (usize, &f64)| if k < blocks && k % 3 == 2 { *x } else { x / length };
    row.iter().enumerate().map(back).collect()
}

#[test]
fn units_by_powers_of_two_change_no_bit() {
    // Of length and mass powers of four: the numbers of N/m^1.5 and of a mode's shape (1/√kg) are
    // in units with their square roots.
    let units = [-4..=4, -4..=4, -8..=8].prop_map(|[l, m, t]| [4.0_f64.powi(l), 4.0_f64.powi(m), 2.0_f64.powi(t)]);
    check("units-exact", "proptest-regressions/units-exact.txt", units, |drawn, units| {
        // The search for an equilibrium begins with a time of its own, 1e-5 s: its rounding depends
        // on units.
        let mut drawn = drawn.clone();
        drawn.beams.iter_mut().for_each(|beam| beam.static_start = false);
        let mut units = *units;
        // A power rounds as it likes; and of a beam the last bit has been seen to follow the unit
        // of length.
        let powers = drawn.contacts.iter().any(|contact| matches!(contact.law, Law::HuntCrossley { .. }));
        if powers || !drawn.beams.is_empty() {
            units[0] = 1.0;
        }
        let units = &units;
        let (base, other) = (motion(&drawn)?, motion(&scaled(&drawn, units))?);
        let back = changed(&other, |_, row| unscaled(&drawn, units[0], row));
        let of = base.rows.len();
        Ok(match base.rows.iter().zip(&back.rows).position(|(row, other)| row != other) {
            None => Ok(Checked { judged: of, of }),
            Some(k) => Err(format!("after {k} steps\n{:?} is not\n{:?}", back.rows[k], base.rows[k])),
        })
    });
}

#[test]
fn units_change_nothing() {
    let units = [-1.5..1.5, -3.0..3.0, -2.0..2.0].prop_map(|powers: [f64; 3]| powers.map(|x| 10.0_f64.powf(x)));
    check("units", "proptest-regressions/units.txt", units, |drawn, units| {
        let (base, other) = (motion(drawn)?, motion(&scaled(drawn, units))?);
        let other = changed(&other, |_, row| unscaled(drawn, units[0], row));
        let horizon = Horizon::of(drawn, &base, extent(drawn, &base))?;
        Ok(horizon.agree(drawn, &base, &other).map(|judged| Checked { judged, of: base.rows.len() }))
    });
}

#[test]
fn a_later_start_changes_nothing() {
    check("later", "proptest-regressions/later.txt", 1..1000_u32, |drawn, later| {
        let mut shifted = drawn.clone();
        shifted.signal.start += f64::from(*later) * drawn.step;
        let mut from_later = simulation(&shifted)?;
        from_later.state.step += u64::from(*later);
        from_later.state.t = from_later.state.step as f64 * from_later.state.dt;
        from_later.plan = Plan::steps(u64::from(drawn.steps + *later)).when_unsolved(from_later.plan.unsolved);
        let (base, other) = (motion(drawn)?, run(&mut from_later)?);
        let of = base.rows.len();
        if !drawn.is_driven() {
            return Ok(match base == other {
                true => Ok(Checked { judged: of, of }),
                false => Err("nothing depends on time, yet bits differ".to_owned()),
            });
        }
        // Times are rounded as they grow, and what depends on them with them: a length at the speed
        // of the signal.
        let t = f64::from(drawn.steps + later) * drawn.step;
        let extent = extent(drawn, &base).max(drawn.length() * t * drawn.signal.frequency * std::f64::consts::TAU);
        let horizon = Horizon::of(drawn, &base, extent)?;
        Ok(horizon.agree(drawn, &base, &other).map(|judged| Checked { judged, of }))
    });
}

#[test]
fn a_run_goes_on_from_its_state_to_the_same_bits() {
    check("resume", "proptest-regressions/resume.txt", 0.0..1.0_f64, |drawn, part| {
        let whole = motion(drawn)?;
        let mut first = simulation(drawn)?;
        let steps = (part * f64::from(drawn.steps)) as u64;
        first.plan = Plan::steps(steps).when_unsolved(first.plan.unsolved);
        let mut rows = run(&mut first)?.rows;
        let mut second = simulation(drawn)?;
        second.state = first.state;
        rows.extend(run(&mut second)?.rows.into_iter().skip(1));
        let of = rows.len();
        Ok(match rows.iter().zip(&whole.rows).position(|(row, other)| row != other) {
            None if of == whole.rows.len() => Ok(Checked { judged: of, of }),
            at => Err(format!("interrupted after {steps} steps it differs at {at:?}")),
        })
    });
}

/// The scene with its tables in the opposite order, and blocks turned about by `shift` places.
fn reordered(drawn: &Drawn, shift: usize) -> (Drawn, Vec<usize>) {
    let mut other = drawn.clone();
    let n = drawn.blocks.len();
    // Block k of the scene is block place[k] of the other one.
    let place: Vec<usize> = (0..n).map(|k| n - 1 - (k + shift) % n).collect();
    for k in 0..n {
        other.blocks[place[k]] = drawn.blocks[k].clone();
    }
    let beam = |surface: &mut Surface| {
        if let Surface::Beam(k) = surface {
            *k = drawn.beams.len() - 1 - *k;
        }
    };
    other.beams.reverse();
    other.blocks.iter_mut().for_each(|block| beam(&mut block.over));
    for contact in &mut other.contacts {
        contact.block = place[contact.block];
        beam(&mut contact.surface);
    }
    other.contacts.reverse();
    (other, place)
}

#[test]
fn the_order_of_tables_changes_nothing() {
    check("order", "proptest-regressions/order.txt", 0..3_usize, |drawn, shift| {
        let (other, place) = reordered(drawn, *shift);
        let blocks = 3 * drawn.blocks.len();
        same(drawn, &other, |_, row| {
            let mut back: Vec<f64> = place.iter().flat_map(|at| row[3 * at..3 * at + 3].to_vec()).collect();
            let beams = row[blocks..].chunks_exact(PROBES.len()).rev();
            back.extend(beams.flatten());
            back
        })
    });
}

/// Found by the mirror image: both corners press, and one of the two scenes dropped a corner by a
/// velocity of 1e-18 m/s.
#[test]
fn a_wedged_block_stays_at_rest_on_either_side() {
    let scene = |side: &str| {
        format!(
            r#"
            [time]
            end = "50 ms"
            step = "5.011872336272725 ms"
            gap_tolerance = "7e-13 m"
            scheme = "moreau-jean-closed"
            [world]
            gravity = "10.89575752358922 m/s^2"
            [ground]
            [material.light]
            density = "500 kg/m^3"
            [block.slab]
            material = "light"
            width = "7.113225030460098 cm"
            height = "2.845290012184039 cm"
            depth = "2 cm"
            on = "ground"
            at = "{side}15 cm"
            tilt = "{side}0.04123508778438135 rad"
            velocity = ["0 m/s", "-0.9851399170661461 m/s"]
            [contact.base]
            between = ["slab", "ground"]
            friction = 1.1418389107681761
            "#
        )
    };
    for side in ["", "-"] {
        let resolved = teeter_scenario::load(scene(side).as_bytes(), "slab.toml", "slab", &[]).unwrap();
        let motion = run(&mut teeter_scenario::simulation::Simulation::new(&resolved.scene).unwrap()).unwrap();
        let (caught, last) = (&motion.rows[1], &motion.rows[motion.rows.len() - 1]);
        assert_eq!(motion.rows.len(), 11);
        for k in 0..3 {
            // Both corners are held in place; what is left is rounding.
            assert!((caught[k] - last[k]).abs() < 1e-15, "{side}: {caught:?} {last:?}");
        }
    }
}
