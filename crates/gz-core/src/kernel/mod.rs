//! Ray against triangle.

use crate::{GzCoord, GzRay, Hit};

/// Which ray-triangle test answers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kernel {
    /// Exact: the specification.
    #[default]
    Certified,
    /// The paper's: plane first, then inside test.
    Plane,
}

/// Weights of the three corners where the line of `ray` meets the triangle, in f64; at least 0, sum 1 up to rounding.
pub fn hit_weights(ray: &GzRay, corners: &[GzCoord; 3]) -> [f64; 3] {
    let d = ray.direction.as_dvec3();
    let [a, b, c] = corners.map(|p| p.as_dvec3() - ray.origin);
    let (u, v, w) = (d.dot(b.cross(c)), d.dot(c.cross(a)), d.dot(a.cross(b)));
    let sum = u + v + w;
    [u / sum, v / sum, w / sum]
}

pub(crate) fn plain(ray: &GzRay, corners: &[GzCoord; 3]) -> Option<Hit> {
    let d = ray.direction.as_dvec3();
    let [a, b, c] = corners.map(|p| p.as_dvec3() - ray.origin);
    let (u, v, w) = (d.dot(b.cross(c)), d.dot(c.cross(a)), d.dot(a.cross(b)));
    let sum = u + v + w;
    if sum == 0.0 || !((u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0)) {
        return None;
    }
    let t = (a.dot(b.cross(c)) / sum) as f32;
    (t > ray.tmin && t < ray.tmax).then(|| Hit { t, tri: 0, u: (v / sum) as f32, v: (w / sum) as f32 })
}
