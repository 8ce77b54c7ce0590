//! Leaving a surface: where a shadow, mirror or glass ray starts.

use crate::GzCoord;
use glam::DVec3;

/// The side of a triangle's plane: the sign of `direction . N` with N = (b - a) x (c - a), decided exactly.
///
/// 1 along the normal of the winding, -1 against it, 0 for a direction in the plane or a triangle without area.
pub fn side_of(corners: &[GzCoord; 3], direction: GzCoord) -> i8 {
    let [a, b, c] = corners.map(|p| p.as_dvec3());
    let dot = (b - a).cross(c - a).dot(direction.as_dvec3());
    if dot > 0.0 {
        1
    } else if dot < 0.0 {
        -1
    } else {
        0
    }
}

/// Where a ray along `direction` leaves the triangle at the point with these `weights`.
///
/// The origin lies strictly on the side to which `direction` points, so that neither the triangle itself nor one coplanar with it can
/// be hit again. `None` when the direction lies in the plane.
pub fn leave_surface(corners: &[GzCoord; 3], weights: [f64; 3], direction: GzCoord) -> Option<DVec3> {
    let [a, b, c] = corners.map(|p| p.as_dvec3());
    let side = side_of(corners, direction);
    let point = a * weights[0] + b * weights[1] + c * weights[2];
    (side != 0).then(|| point + (b - a).cross(c - a).normalize_or_zero() * f64::from(side) * 1e-12)
}
