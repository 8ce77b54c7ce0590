//! The test by Plücker coordinates: on which side of each edge's line does the ray's line pass?
//!
//! Source: the inner product of Plücker coordinates, as T. Davidovič, T. Engelhardt, I. Georgiev, P. Slusallek and C. Dachsbacher 2012,
//! "3D Rasterization: A Bridge between Rasterization and Ray Casting", have it, with the ray's origin as the origin of space.

use crate::{GzCoord, GzRay};

/// T-value and weights of the second and third corner in f32; `None` for a miss.
///
/// A shared edge gives both triangles the same number with the other sign, so rays do not slip through edges; t is not bounded by the
/// triangle's corners.
pub(super) fn pluecker(ray: &GzRay, corners: &[GzCoord; 3]) -> Option<(f32, f32, f32)> {
    let (o, d) = (ray.origin.as_vec3(), ray.direction);
    let [a, b, c] = corners.map(|p| p - o);
    // (p - q) x (p + q) is twice q x p: the edge's moment about the origin of the ray, and odd under a swap of p and q.
    let side = |p: GzCoord, q: GzCoord| (p - q).cross(p + q).dot(d);
    let (u, v, w) = (side(c, b), side(a, c), side(b, a));
    if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
        return None;
    }
    let whole = u + v + w;
    let n = (b - a).cross(c - a);
    let t = n.dot(a) / n.dot(d);
    // Written so that NaN is a miss.
    (whole != 0.0 && t > ray.tmin && t < ray.tmax).then(|| (t, v / whole, w / whole))
}
