//! Möller and Trumbore's test: solve for t, u and v at once, by Cramer's rule.
//!
//! Source: T. Möller, B. Trumbore 1997, "Fast, Minimum Storage Ray/Triangle Intersection". It differs from the printed code in that only
//! a determinant of exactly 0 is a miss: the printed tolerance is an absolute one and loses small triangles.

use crate::{GzCoord, GzRay};
use glam::DVec3;

/// T-value and weights of the second and third corner in f32; `None` for a miss.
///
/// Two triangles that share an edge compute it from different sides, so that rays slip between them.
pub(super) fn moeller_trumbore(ray: &GzRay, corners: &[GzCoord; 3]) -> Option<(f32, f32, f32)> {
    let [a, b, c] = *corners;
    let (o, d) = (ray.origin.as_vec3(), ray.direction);
    let (e1, e2) = (b - a, c - a);
    let p = d.cross(e2);
    let det = e1.dot(p);
    if det == 0.0 {
        return None;
    }
    let inverse = 1.0 / det;
    let s = o - a;
    let u = s.dot(p) * inverse;
    let q = s.cross(e1);
    let v = d.dot(q) * inverse;
    let t = e2.dot(q) * inverse;
    // Written so that NaN is a miss.
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > ray.tmin && t < ray.tmax).then_some((t, u, v))
}

/// The same in f64, from the ray's own f64 origin; T, u and v are rounded at the end.
///
/// Far more digits, and no proof: it still misses rays through corners and edges, only more rarely.
pub(super) fn moeller_trumbore_f64(ray: &GzRay, corners: &[GzCoord; 3]) -> Option<(f32, f32, f32)> {
    let [a, b, c] = corners.map(|p| p.as_dvec3());
    let (o, d): (DVec3, DVec3) = (ray.origin, ray.direction.as_dvec3());
    let (e1, e2) = (b - a, c - a);
    let p = d.cross(e2);
    let det = e1.dot(p);
    if det == 0.0 {
        return None;
    }
    let inverse = 1.0 / det;
    let s = o - a;
    let u = s.dot(p) * inverse;
    let q = s.cross(e1);
    let v = d.dot(q) * inverse;
    let t = e2.dot(q) * inverse;
    let inside = u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > f64::from(ray.tmin) && t < f64::from(ray.tmax);
    inside.then_some((t as f32, u as f32, v as f32))
}
