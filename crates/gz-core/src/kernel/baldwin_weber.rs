//! Baldwin and Weber's test: one affine map per triangle takes it to the corner of the unit square.
//!
//! Source: D. Baldwin, M. Weber 2016, "Fast Ray-Triangle Intersections by Coordinate Transformation", JCGT 5:3. It differs from theirs in
//! that the map is formed anew for each ray instead of being stored: this is about its answers, not its speed.

use crate::{GzCoord, GzRay};

/// T-value and weights of the second and third corner in f32; `None` for a miss.
///
/// The map is rounded in the coordinates of space, not of the ray, so that errors grow with the distance from the origin of space.
pub(super) fn baldwin_weber(ray: &GzRay, corners: &[GzCoord; 3]) -> Option<(f32, f32, f32)> {
    let (o, d) = (ray.origin.as_vec3(), ray.direction);
    let [a, b, c] = *corners;
    let (e1, e2) = (b - a, c - a);
    let n = e1.cross(e2);
    let size = n.abs();
    let k = if size.x >= size.y && size.x >= size.z { 0 } else { 1 + usize::from(size.z > size.y) };
    let (i, j) = ((k + 1) % 3, (k + 2) % 3);
    if n[k] == 0.0 {
        return None;
    }
    // Three rows of the map: u, v and the distance from the plane. In each one the column of axis k is 0, 0 and 1.
    let u_row = [e2[j] / n[k], -e2[i] / n[k], c.cross(a)[k] / n[k]];
    let v_row = [-e1[j] / n[k], e1[i] / n[k], -b.cross(a)[k] / n[k]];
    let z_row = [n[i] / n[k], n[j] / n[k], -n.dot(a) / n[k]];
    let height = o[k] + z_row[0] * o[i] + z_row[1] * o[j] + z_row[2];
    let t = -height / (d[k] + z_row[0] * d[i] + z_row[1] * d[j]);
    // Written so that NaN is a miss; a ray in the plane divides by 0.
    if !(t > ray.tmin && t < ray.tmax) {
        return None;
    }
    let p = o + d * t;
    let u = u_row[0] * p[i] + u_row[1] * p[j] + u_row[2];
    let v = v_row[0] * p[i] + v_row[1] * p[j] + v_row[2];
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then_some((t, u, v))
}
