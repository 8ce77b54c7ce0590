//! The paper's test, plain: the plane first, then whether its point lies inside.

use crate::{GzCoord, GzRay};

/// T-value and weights of the second and third corner, by the paper's section 2.3.2 in f32; `None` for a miss.
///
/// With N the normal and D = -N.a the plane's offset, t = -(D + N.o) / (N.d); the point at t is inside when its three edge cross
/// products point the way of N. Kept for comparison: rounding the point before the inside test lets rays slip between neighbours, so
/// it differs from the exact kernel near edges and at small angles.
pub(super) fn plane_then_inside(ray: &GzRay, corners: &[GzCoord; 3]) -> Option<(f32, f32, f32)> {
    let [a, b, c] = *corners;
    let (o, d) = (ray.origin.as_vec3(), ray.direction);
    let n = (b - a).cross(c - a);
    let along = n.dot(d);
    if along == 0.0 {
        return None;
    }
    let t = -(n.dot(o) - n.dot(a)) / along;
    // Written so that NaN is a miss.
    if !(t > ray.tmin && t < ray.tmax) {
        return None;
    }
    let p = o + d * t;
    let inside = [(b - a).cross(p - a), (c - b).cross(p - b), (a - c).cross(p - c)].map(|e| e.dot(n));
    if !inside.iter().all(|&e| e >= 0.0) {
        return None;
    }
    let whole = n.dot(n);
    Some((t, inside[2] / whole, inside[0] / whole))
}
