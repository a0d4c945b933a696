//! Where arches of rigid voussoirs stand, by limit analysis: the answers that assemblages of many blocks are compared with.

use crate::case::{Case, Check, Depth, Findings, Result};
use std::f64::consts::PI;
use teeter_validation::limit_analysis::{
    VoussoirWeight, minimum_thickness, minimum_thickness_with, thrust_line_thickness,
};

pub(crate) struct LimitAnalysis;

const FRICTION: f64 = 0.5;

/// Of t/R: the linear programme's margin is told from zero to 1e-7 of a block's weight, and changes by more than that.
const THICKNESS: f64 = 1e-6;

/// Half a unit of the last of four digits.
const FOUR_DIGITS: f64 = 5e-5;

impl Case for LimitAnalysis {
    fn name(&self) -> &'static str {
        "limit_analysis"
    }

    fn about(&self) -> &'static str {
        "A check of the limit analysis with which assemblages of rigid blocks are compared. By the static theorem a \
         plane assemblage with frictional, tensionless joints can stand only if forces in the friction cones at the \
         ends of all joints hold every block in equilibrium: a linear programme (`limit_analysis`, solved by \
         Clarabel). Below: the smallest t/R at which an arch of equal radial voussoirs stands under its weight, R to \
         the centre line, found by bisection, compared with the thrust line (without a programme: two unknowns, all \
         pairs of hinges). The literature's 0.1067 for the semicircle of 27 voussoirs applies to polygons: corners \
         on the circles of intrados and extrados, straight chords, weight at the polygon's centroid. With the weight \
         of true ring sectors it is 0.1068. 181 of these need slightly less than the continuous arch: 0.107478 with \
         the weight at the sector's centroid (Milankovitch), 0.107426 with it on the centre line (Cocchetti, \
         Colasante and Rizzi 2011). A semicircle with μ = 0.3 slides off its springers at any thickness; from 160° \
         down this friction is as good as 0.5. Stacks, overhangs, piles and pyramids are in \
         `validation/tests/limit_analysis.rs`."
    }

    fn run(&self, depth: Depth) -> Result<Findings> {
        let mut findings = Findings::default();
        let counts: &[usize] = if depth == Depth::Full { &[9, 15, 27, 51] } else { &[9, 27] };
        for &n in counts {
            for degrees in [180.0_f64, 160.0, 140.0, 120.0] {
                let angle = degrees.to_radians();
                let known = thrust_line_thickness(n, angle)?.ok_or("no thrust line")?;
                let found = minimum_thickness(n, angle, FRICTION)?.ok_or("no arch stands")?;
                let quantity = format!("{n} voussoirs, {degrees}°, μ = 0.5: t/R");
                findings.checks.push(Check::absolute(quantity, known, found, THICKNESS));
            }
        }
        let found = minimum_thickness(27, 160.0_f64.to_radians(), 0.3)?.ok_or("no arch stands")?;
        let known = thrust_line_thickness(27, 160.0_f64.to_radians())?.ok_or("no thrust line")?;
        findings.checks.push(Check::absolute("27 voussoirs, 160°, μ = 0.3: t/R", known, found, THICKNESS));
        semicircles(&mut findings)?;
        Ok(findings)
    }
}

/// Against the literature, for all conventions of weight.
fn semicircles(findings: &mut Findings) -> Result<()> {
    let thickness = |n: usize, weight: VoussoirWeight| -> Result<f64> {
        Ok(minimum_thickness_with(n, PI, FRICTION, weight)?.ok_or("no semicircle stands")?)
    };
    let polygons = thickness(27, VoussoirWeight::Polygon)?;
    findings.checks.push(Check::absolute("27 polygons, 180°: t/R of the literature", 0.1067, polygons, FOUR_DIGITS));
    for (weight, what, limit, least) in [
        (VoussoirWeight::Sector, "sectors", 0.107_478, 0.107_428),
        (VoussoirWeight::CentreLine, "weights on the centre line", 0.107_426, 0.107_376),
    ] {
        findings.checks.push(Check::reported(format!("27 {what}, 180°: t/R"), thickness(27, weight)?));
        let many = format!("181 {what}, 180°: t/R, of endlessly many");
        findings.checks.push(Check::between(many, limit, thickness(181, weight)?, least, limit));
    }
    Ok(())
}
