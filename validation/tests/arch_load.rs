//! The load that the arch of the scenario `masonry-arch` bears.
#![allow(clippy::unwrap_used, clippy::panic)]

use nalgebra::Vector2;
use std::f64::consts::PI;
use teeter_validation::limit_analysis::{Load, LoadFactor, VoussoirWeight, arch, load_factor};

/// In `teeter run` it stands under 1009.7 N on its fifth voussoir and falls under 1011.2 N.
#[test]
fn the_arch_of_the_scenario_bears_1010_newtons() {
    let weight_per_area = 2400.0 * 0.3 * 9.81;
    let assemblage = arch(15, PI, 1.0, 0.15, VoussoirWeight::Polygon).unwrap();
    let block = 4;
    let at = assemblage.blocks()[block].centroid;
    let loads = [Load { block, at, force: Vector2::new(0.0, -1.0 / weight_per_area) }];
    let LoadFactor::Largest(newtons) = load_factor(&assemblage, 0.6, &loads).unwrap() else {
        panic!("no limit");
    };
    assert!((1009.7..1011.2).contains(&newtons), "{newtons} N");
}
