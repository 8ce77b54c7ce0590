//! Woop, Benthin and Wald's test: shear space so that the ray is the z axis, then three edge functions in the plane.
//!
//! Source: S. Woop, C. Benthin, I. Wald 2013, "Watertight Ray/Triangle Intersection", JCGT 2:1. It differs from theirs in that both faces
//! count and the axes are not swapped to keep the winding.

use crate::{GzCoord, GzRay};

/// T-value and weights of the second and third corner in f32; `None` for a miss.
///
/// Two triangles that share an edge compute the same edge function with the other sign, so no ray slips between them. With `FUSED`
/// products are fused with the sums that take them, and the one rounding of an edge function is not the same from both sides: the property
/// is lost. That is what a compiler does to the test when it is allowed to.
pub(super) fn woop<const FUSED: bool>(ray: &GzRay, corners: &[GzCoord; 3]) -> Option<(f32, f32, f32)> {
    let (o, d) = (ray.origin.as_vec3(), ray.direction);
    let size = d.abs();
    let kz = if size.x >= size.y && size.x >= size.z { 0 } else { 1 + usize::from(size.z > size.y) };
    let (kx, ky) = ((kz + 1) % 3, (kz + 2) % 3);
    let (sx, sy, sz) = (d[kx] / d[kz], d[ky] / d[kz], 1.0 / d[kz]);
    let [a, b, c] = corners.map(|p| p - o);
    let sheared = |p: GzCoord| (less_product::<FUSED>(p[kx], sx, p[kz]), less_product::<FUSED>(p[ky], sy, p[kz]));
    let ((ax, ay), (bx, by), (cx, cy)) = (sheared(a), sheared(b), sheared(c));
    let mut u = edge::<FUSED>(cx, by, cy, bx);
    let mut v = edge::<FUSED>(ax, cy, ay, cx);
    let mut w = edge::<FUSED>(bx, ay, by, ax);
    if u == 0.0 || v == 0.0 || w == 0.0 {
        // Products of two f32 numbers are exact in f64: signs are those of the sheared corners.
        let exact = |p: f32, q: f32, r: f32, s: f32| (f64::from(p) * f64::from(q) - f64::from(r) * f64::from(s)) as f32;
        u = exact(cx, by, cy, bx);
        v = exact(ax, cy, ay, cx);
        w = exact(bx, ay, by, ax);
    }
    if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
        return None;
    }
    let det = u + v + w;
    let scaled = u * (sz * a[kz]) + v * (sz * b[kz]) + w * (sz * c[kz]);
    let t = scaled / det;
    // With a determinant of 0, or of NaN, t is infinite or NaN, and a miss.
    (det != 0.0 && t > ray.tmin && t < ray.tmax).then(|| (t, v / det, w / det))
}

/// `x - p q`, rounded twice or once.
fn less_product<const FUSED: bool>(x: f32, p: f32, q: f32) -> f32 {
    if FUSED { (-p).mul_add(q, x) } else { x - p * q }
}

/// `p q - r s`, rounded three times or twice.
fn edge<const FUSED: bool>(p: f32, q: f32, r: f32, s: f32) -> f32 {
    if FUSED { p.mul_add(q, -(r * s)) } else { p * q - r * s }
}
