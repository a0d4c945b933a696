//! Limit analysis against closed forms and published limits of stacks, piles and arches.

use std::f64::consts::PI;
use teeter_validation::limit_analysis::{
    Assemblage, Block, LimitError, Load, LoadFactor, Point, VoussoirWeight, accelerated, arch, load_factor, margin,
    minimum_thickness, minimum_thickness_with, stands, thrust_line_thickness,
};

type Tested = Result<(), LimitError>;

fn rectangle(left: f64, bottom: f64, width: f64, height: f64) -> Vec<Point> {
    [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)].map(|(x, y)| Point::new(left + x, bottom + y)).to_vec()
}

/// Bricks of width 1 and height 0.4, each given by its left end and its row, on a table that ends at `edge`.
fn pile(bricks: &[(f64, usize)], edge: f64) -> Result<Assemblage, LimitError> {
    let brick = |&(left, row): &(f64, usize)| Block::uniform(rectangle(left, 0.4 * row as f64, 1.0, 0.4), 1.0);
    let blocks = bricks.iter().map(brick).collect::<Result<_, _>>()?;
    Assemblage::new(blocks, &[rectangle(edge - 10.0, -1.0, 10.0, 1.0)])
}

/// By how much the pile, without friction, reaches beyond the table that it just stands on. At `near` it falls, at `far` it stands.
fn overhang(bricks: &[(f64, usize)], near: f64, far: f64) -> Result<f64, LimitError> {
    let edge = limit(near, far, |edge| stands(&pile(bricks, edge)?, 0.0))?;
    Ok(bricks.iter().fold(f64::NEG_INFINITY, |most, (left, _)| most.max(left + 1.0)) - edge)
}

/// Between a number that doesn't pass and one that does, where it changes.
fn limit(
    mut fails: f64,
    mut passes: f64,
    passing: impl Fn(f64) -> Result<bool, LimitError>,
) -> Result<f64, LimitError> {
    assert!(!passing(fails)? && passing(passes)?, "no limit between {fails} and {passes}");
    while (passes - fails).abs() > 1e-8 {
        let middle = 0.5 * (fails + passes);
        if passing(middle)? { passes = middle } else { fails = middle }
    }
    Ok(passes)
}

#[test]
fn a_tilted_stack_topples_or_slides_at_the_known_angle() -> Tested {
    let (width, height) = (1.0, 0.3);
    for n in 1..=6_usize {
        for friction in [0.1, 0.4, 2.0] {
            let standing = |angle: f64| {
                let block = |i: usize| Block::uniform(rectangle(0.0, height * i as f64, width, height), 1.0);
                let blocks = (0..n).map(block).collect::<Result<_, _>>()?;
                let stack = Assemblage::new(blocks, &[rectangle(-1.0, -1.0, 3.0, 1.0)])?;
                stands(&stack.tilted(angle), friction)
            };
            let known = (width / (n as f64 * height)).min(friction).atan();
            let found = limit(1.5, 0.0, standing)?;
            assert!((found - known).abs() < 1e-6, "{n} blocks, μ = {friction}: {found}, not {known}");
        }
    }
    Ok(())
}

#[test]
fn a_pushed_block_slides_at_its_friction_and_topples_at_its_slenderness() -> Tested {
    let block =
        Assemblage::new(vec![Block::uniform(rectangle(0.0, 0.0, 1.0, 2.0), 3.0)?], &[rectangle(-1.0, -1.0, 3.0, 1.0)])?;
    for friction in [0.0, 0.2, 0.49, 0.51, 5.0] {
        let loads = accelerated(&block, Point::new(1.0, 0.0));
        let LoadFactor::Largest(found) = load_factor(&block, friction, &loads)? else { panic!("no largest factor") };
        assert!((found - friction.min(0.5)).abs() < 1e-8, "μ = {friction}: {found}");
    }
    let pressed = [Load { block: 0, at: Point::new(0.5, 2.0), force: Point::new(0.1, -1.0) }];
    assert_eq!(load_factor(&block, 0.5, &pressed)?, LoadFactor::Unbounded);
    let lifted = [Load { block: 0, at: Point::new(3.0, 2.0), force: Point::new(0.0, 1.0) }];
    // Weight 6 at 0.5, lift at 3: about the left end 6 · 0.5 = 3 λ.
    let LoadFactor::Largest(found) = load_factor(&block, 0.5, &lifted)? else { panic!("no largest factor") };
    assert!((found - 1.0).abs() < 1e-8, "{found}");
    let nowhere = [Load { block: 1, ..lifted[0] }];
    assert_eq!(load_factor(&block, 0.5, &nowhere), Err(LimitError::Load));
    Ok(())
}

#[test]
fn a_block_in_the_air_has_no_equilibrium() -> Tested {
    let block =
        Assemblage::new(vec![Block::uniform(rectangle(0.0, 0.5, 1.0, 1.0), 1.0)?], &[rectangle(-1.0, -1.0, 3.0, 1.0)])?;
    assert!(!stands(&block, 0.5)?);
    assert_eq!(load_factor(&block, 0.5, &accelerated(&block, Point::new(1.0, 0.0)))?, LoadFactor::NoEquilibrium);
    assert!(matches!(stands(&block, -0.5), Err(LimitError::Friction(_))));
    Ok(())
}

#[test]
fn a_stack_reaches_as_far_as_the_harmonic_series() -> Tested {
    for n in 1..=10_usize {
        // From the top down each reaches 1/(2k) beyond the next.
        let mut left = 0.0;
        let mut bricks = vec![(0.0, n - 1)];
        for k in 1..n {
            left -= 0.5 / k as f64;
            bricks.push((left, n - 1 - k));
        }
        let known = (1..=n).map(|k| 0.5 / k as f64).sum::<f64>();
        let found = overhang(&bricks, left, left + 1.0)?;
        assert!((found - known).abs() < 1e-6, "{n} bricks: {found}, not {known}");
    }
    Ok(())
}

/// M. Paterson, U. Zwick, *Overhang*, Amer. Math. Monthly 116, 2009: the best piles of three and of four bricks.
#[test]
fn the_best_piles_of_three_and_four_bricks_reach_as_far_as_published() -> Tested {
    let three = [(-0.5, 0), (-1.0, 1), (0.0, 1)];
    let found = overhang(&three, -0.4, 0.4)?;
    assert!((found - 1.0).abs() < 1e-6, "{found}");
    // The share √2 − 1 of the highest brick presses on the end of the one that reaches out, the rest on the counterweight.
    let root = 2.0_f64.sqrt();
    let foot = 0.25 * (3.5 - root);
    let reaching = foot - 0.5 / root;
    let (counterweight, top) = (-0.9, top_of_four(foot, reaching, -0.4));
    let four = [(foot - 1.0, 0), (counterweight, 1), (reaching, 1), (top - 0.5, 2)];
    let found = overhang(&four, -0.3, 0.3)?;
    assert!((found - (15.0 - 4.0 * root) / 8.0).abs() < 1e-6, "{found}");
    Ok(())
}

/// Centre of the highest brick, such that it and the counterweight, centred at `centre`, press on the left end of the lowest.
fn top_of_four(foot: f64, reaching: f64, centre: f64) -> f64 {
    let share = 2.0_f64.sqrt() - 1.0;
    let pressed = ((2.0 - share) * (foot - 1.0) - centre) / (1.0 - share);
    share * reaching + (1.0 - share) * pressed
}

/// Rows of bricks side by side, each row centred.
fn rows(counts: &[usize]) -> Vec<(f64, usize)> {
    let row = |(row, &count): (usize, &usize)| (0..count).map(move |i| (i as f64 - 0.5 * count as f64, row));
    counts.iter().enumerate().flat_map(row).collect()
}

/// Paterson and Zwick, section 3: inverted triangles of three rows and more fall apart, diamonds from five rows at their widest.
#[test]
fn pyramids_stand_and_inverted_ones_and_wide_diamonds_do_not() -> Tested {
    for m in 1..=6_usize {
        let upright: Vec<_> = (1..=m).rev().collect();
        assert!(stands(&pile(&rows(&upright), 5.0)?, 0.0)?, "pyramid of {m}");
        let inverted: Vec<_> = (1..=m).collect();
        assert_eq!(stands(&pile(&rows(&inverted), 5.0)?, 0.0)?, m < 3, "inverted pyramid of {m}");
        let diamond: Vec<_> = (1..=m).chain((1..m).rev()).collect();
        assert_eq!(stands(&pile(&rows(&diamond), 5.0)?, 0.0)?, m < 5, "diamond of {m}");
    }
    Ok(())
}

#[test]
fn an_arch_stands_from_the_thickness_that_holds_a_thrust_line() -> Tested {
    for n in [2, 5, 9, 10, 15, 26, 27, 51] {
        for degrees in [180.0_f64, 160.0, 140.0, 120.0, 90.0] {
            let angle = degrees.to_radians();
            let pair = minimum_thickness(n, angle, 0.7)?.zip(thrust_line_thickness(n, angle)?);
            assert!(pair.is_some_and(|(found, known)| (found - known).abs() < 1e-6), "{n}, {degrees}°: {pair:?}");
        }
    }
    Ok(())
}

#[test]
fn only_polygons_give_the_literature_s_0_1067_of_27_voussoirs() -> Tested {
    let weights = [VoussoirWeight::Polygon, VoussoirWeight::Sector, VoussoirWeight::CentreLine];
    for (weight, four_digits) in weights.into_iter().zip([0.1067, 0.1068, 0.1068]) {
        let found = minimum_thickness_with(27, PI, 0.5, weight)?;
        assert!(found.is_some_and(|t| (t - four_digits).abs() < 5e-5), "{weight:?}: {found:?}");
    }
    Ok(())
}

/// Arches of endlessly many joints, R to the centre line: 0.107478 (Milankovitch, weight at the sector's centroid) and 0.107426
/// (weight on the centre line; G. Cocchetti, G. Colasante, E. Rizzi, Appl. Mech. Rev. 64, 2011). Fewer joints need less.
#[test]
fn many_voussoirs_need_the_thickness_of_the_continuous_arch() -> Tested {
    for (weight, known) in [(VoussoirWeight::Sector, 0.107_478), (VoussoirWeight::CentreLine, 0.107_426)] {
        let found = minimum_thickness_with(181, PI, 0.5, weight)?;
        assert!(found.is_some_and(|t| t < known + 1e-6 && t > known - 5e-5), "{weight:?}: {found:?}, not {known}");
    }
    Ok(())
}

#[test]
fn the_margin_of_an_arch_changes_sign_at_its_minimum_thickness() -> Tested {
    let Some(limit) = minimum_thickness(27, PI, 0.5)? else { panic!("no thickness stands") };
    let at = |thickness| margin(&arch(27, PI, 1.0, thickness, VoussoirWeight::Polygon)?, 0.5);
    let (thinner, thicker) = (at(limit - 1e-5)?, at(limit + 1e-5)?);
    assert!(thinner < 0.0 && thicker > 0.0, "{thinner}, {thicker}");
    assert!((thinner + thicker).abs() < 0.1 * thicker, "not proportional: {thinner}, {thicker}");
    // An arch of another size stands alike.
    assert!(stands(&arch(27, PI, 1e3, 1e3 * (limit + 1e-5), VoussoirWeight::Polygon)?, 0.5)?);
    assert!(!stands(&arch(27, PI, 1e3, 1e3 * (limit - 1e-5), VoussoirWeight::Polygon)?, 0.5)?);
    Ok(())
}

#[test]
fn a_semicircle_slides_off_its_springers_where_friction_is_small() -> Tested {
    assert_eq!(minimum_thickness(27, PI, 0.3)?, None);
    let (enough, plenty) = (minimum_thickness(27, PI, 0.5)?, minimum_thickness(27, PI, 2.0)?);
    assert!(enough.zip(plenty).is_some_and(|(a, b)| (a - b).abs() < 1e-6), "{enough:?}, {plenty:?}");
    let little = minimum_thickness(27, PI, 0.35)?;
    assert!(little.zip(enough).is_some_and(|(a, b)| a > b + 1e-3), "{little:?}, {enough:?}");
    Ok(())
}

/// t/R at which the half arch turns about the crown's extrados and a haunch's intrados while its foot slides outwards: by the moments
/// of polygons, no programme. At a springing β from the crown sliding bounds the thrust by H ≤ V / tan(β − arctan μ).
fn mixed_mode_thickness(n: usize, angle: f64, friction: f64) -> f64 {
    let (step, beta) = (angle / n as f64, 0.5 * angle);
    let (first, key) = if n.is_multiple_of(2) { (0.0, 0.0) } else { (0.5 * step, 0.5) };
    let thrust = 0.5 * n as f64 / (beta - friction.atan()).tan();
    let holds = |thickness: f64| {
        let [inner, outer] = [1.0 - 0.5 * thickness, 1.0 + 0.5 * thickness];
        let centroid = (1.0 + thickness * thickness / 12.0) * (0.5 * step).cos();
        let crown = (outer * f64::sin(first), outer * f64::cos(first));
        (1..n / 2).all(|k| {
            let hinge = first + step * k as f64;
            let x = inner * hinge.sin();
            let blocks = (0..k).map(|i| x - centroid * (first + step * (i as f64 + 0.5)).sin());
            thrust * (crown.1 - inner * hinge.cos()) >= key * (x - crown.0) + blocks.sum::<f64>()
        })
    };
    let (mut low, mut high) = (0.0, 0.5);
    while high - low > 1e-12 {
        let middle = 0.5 * (low + high);
        if holds(middle) { high = middle } else { low = middle }
    }
    high
}

#[test]
fn an_arch_that_slides_at_its_springers_has_the_thickness_of_the_mixed_mode() -> Tested {
    for n in [9, 15, 26, 27, 51] {
        for (degrees, friction) in [(180.0_f64, 0.35), (160.0, 0.25), (140.0, 0.2)] {
            let angle = degrees.to_radians();
            let known = mixed_mode_thickness(n, angle, friction);
            let found = minimum_thickness(n, angle, friction)?;
            assert!(found.is_some_and(|t| (t - known).abs() < 1e-6), "{n}, {degrees}°: {found:?}, not {known}");
        }
    }
    Ok(())
}

/// Running bond of `courses` with half bricks at every second course's ends, four bricks wide.
fn wall(courses: usize) -> Result<Assemblage, LimitError> {
    let mut blocks = Vec::new();
    for course in 0..courses {
        let cuts: &[f64] = if course % 2 == 0 { &[0.0, 1.0, 2.0, 3.0, 4.0] } else { &[0.0, 0.5, 1.5, 2.5, 3.5, 4.0] };
        for ends in cuts.windows(2) {
            blocks.push(Block::uniform(rectangle(ends[0], 0.4 * course as f64, ends[1] - ends[0], 0.4), 1.0)?);
        }
    }
    Assemblage::new(blocks, &[rectangle(-1.0, -1.0, 6.0, 1.0)])
}

#[test]
fn a_pushed_brick_wall_slides_at_its_friction_and_is_weaker_than_one_block_of_its_size() -> Tested {
    for courses in [1, 2, 5, 10] {
        let wall = wall(courses)?;
        assert!(stands(&wall, 0.0)?, "{courses} courses");
        let factor = |friction| load_factor(&wall, friction, &accelerated(&wall, Point::new(1.0, 0.0)));
        let LoadFactor::Largest(slides) = factor(0.1)? else { panic!("no largest factor") };
        assert!((slides - 0.1).abs() < 1e-8, "{courses} courses: {slides}");
        let LoadFactor::Largest(breaks) = factor(0.7)? else { panic!("no largest factor") };
        assert!(breaks <= (4.0 / (0.4 * courses as f64)).min(0.7) + 1e-8, "{courses} courses: {breaks}");
        // Ten courses come apart along the stepped joints before they slide; one block would topple at 1.
        assert!(courses < 10 || breaks < 0.65, "{courses} courses: {breaks}");
    }
    Ok(())
}
