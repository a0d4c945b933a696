//! Which blocks touch the ground at the start.

use crate::scene::{BlockScene, Placement, Scene, SupportingBody};
use nalgebra::{Rotation2, Vector2};

/// A block that is no higher over the ground than this part of its size stands on it.
const TOUCHES: f64 = 1e-6;

/// Whether a block touches the ground at the start.
pub(crate) fn is_on_ground(scene: &Scene, block: &BlockScene) -> bool {
    let (at, angle) = match block.placement {
        Placement::On { support, .. } => return support == SupportingBody::Ground,
        Placement::Free { position, angle } => (Vector2::from(position), angle),
    };
    let Some(ground) = &scene.ground else { return false };
    let turned = |angle: f64, point: Vector2<f64>| Rotation2::new(angle) * point;
    // As the ground sees it, from which a profile counts.
    let corners = block
        .corners()
        .into_iter()
        .enumerate()
        .map(|(number, corner)| (turned(-ground.incline, at + turned(angle, corner)), block.corner_radius(number)));
    let least = TOUCHES * block.radius();
    let profile: Option<Vec<Vector2<f64>>> = ground.profile.as_deref().map(|profile| profile.points().collect());
    corners.into_iter().any(|(corner, radius)| match &profile {
        None => corner.y - radius <= least,
        Some(points) => points.windows(2).any(|ends| distance(corner, ends[0], ends[1]) - radius <= least),
    })
}

/// How far a point is from the line between two others, m.
fn distance(point: Vector2<f64>, from: Vector2<f64>, to: Vector2<f64>) -> f64 {
    let along = to - from;
    let share = ((point - from).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
    (point - from - share * along).norm()
}
