//! Leaving a surface: where a shadow, mirror or glass ray starts.

use crate::GzCoord;
use crate::kernel::side_sign;
use crate::ray::LEAST_ORIGIN;
use glam::DVec3;

const U: f64 = f64::EPSILON / 2.0;

/// The side of a triangle's plane that `direction` points to: the sign of `direction . N` with N = (b - a) x (c - a), decided exactly.
///
/// 1 along the normal of the winding, -1 against it, 0 for a direction in the plane or a triangle without area. `direction` is finite.
pub fn side_of(corners: &[GzCoord; 3], direction: GzCoord) -> i8 {
    // Edges of f32 corners round once in f64: 7 roundings as in the certified test, so 8u of the permanent is a proof.
    let [a, b, c] = corners.map(|p| p.as_dvec3());
    let (e1, e2, d) = (b - a, c - a, direction.as_dvec3());
    let (p, q) = (DVec3::new(e1.y * e2.z, e1.z * e2.x, e1.x * e2.y), DVec3::new(e1.z * e2.y, e1.x * e2.z, e1.y * e2.x));
    let (dot, permanent) = (d.dot(p - q), d.abs().dot(p.abs() + q.abs()));
    if dot.abs() > 8.0 * U * permanent { if dot > 0.0 { 1 } else { -1 } } else { side_sign(corners, direction) as i8 }
}

/// Where a ray along `direction` leaves the triangle at the point with these `weights`, in f64.
///
/// The origin lies strictly on the side of the plane to which `direction` points, by an exact predicate, so neither this triangle nor
/// one that continues its plane can be hit by the ray; and a few roundings within the edges, so that it does not slip past a neighbour.
/// `weights` come from [`crate::kernel::hit_weights`] or a [`crate::Hit`]. `None` when the direction lies in the plane or the triangle
/// has no area.
///
/// After the scheme of NUMERICS 4.4: pull in, form the point, step until the side is proved.
pub fn leave_surface(corners: &[GzCoord; 3], weights: [f64; 3], direction: GzCoord) -> Option<DVec3> {
    let side = side_of(corners, direction);
    if side == 0 {
        return None;
    }
    let [a, b, c] = corners.map(|p| p.as_dvec3());
    let normal = (b - a).cross(c - a);
    let combine = |w: [f64; 3]| a * w[0] + b * w[1] + c * w[2];
    let corner_reach = corners.iter().fold(0f32, |reach, p| reach.max(p.abs().max_element()));
    let mut point = combine(pulled_in(corners, weights, f64::from(corner_reach), normal.length()));

    // A step of u times the largest coordinate is one rounding of the point; the point's own coordinate may be near 0, where its ulp
    // would never get away. Steps double, so that the end is certain.
    let (axis, towards) = way_out(corners, normal, side)?;
    let mut step = U * point.abs().max_element().max(f64::from(corner_reach) * LEAST_SHARE);
    point = without_tiny(point);
    while !is_beyond(corners, point, side) {
        point[axis] += towards * step;
        point = without_tiny(point);
        step *= 2.0;
    }
    Some(point)
}

/// The least step in roundings of the largest corner coordinate, for a point at the origin of space: 2^-20.
const LEAST_SHARE: f64 = 1.0 / (1u64 << 20) as f64;

/// The axis to step along and the direction on it that leads to `side`: the axis of the largest normal component, unless rounding
/// has emptied the normal.
fn way_out(corners: &[GzCoord; 3], normal: DVec3, side: i8) -> Option<(usize, f64)> {
    let largest = largest_axis(normal);
    [largest, 0, 1, 2].into_iter().find_map(|axis| match side_of(corners, GzCoord::AXES[axis]) {
        0 => None,
        sign => Some((axis, f64::from(side * sign))),
    })
}

/// The weights moved at least a few roundings of the point away from each edge.
///
/// `reach` is the greatest coordinate of the corners: the sum that forms the point rounds in units of its largest addend, also where the
/// point itself is near the origin of space.
fn pulled_in(corners: &[GzCoord; 3], weights: [f64; 3], reach: f64, double_area: f64) -> [f64; 3] {
    let [a, b, c] = corners.map(|p| p.as_dvec3());
    // The height over an edge is twice the area by its length; a weight of 1 is the whole height.
    let edges = [c - b, a - c, b - a].map(DVec3::length);
    let pulled: [f64; 3] = std::array::from_fn(|k| {
        let least = (16.0 * U * reach * edges[k] / double_area).clamp(LEAST_WEIGHT, 1.0 / 3.0);
        weights[k].max(least)
    });
    let sum = pulled[0] + pulled[1] + pulled[2];
    pulled.map(|w| w / sum)
}

/// 2^-44, a few roundings of a weight.
const LEAST_WEIGHT: f64 = 1.0 / (1u64 << 44) as f64;

/// Whether `point` is strictly on the given side of the plane.
fn is_beyond(corners: &[GzCoord; 3], point: DVec3, side: i8) -> bool {
    let coord = |p: DVec3| robust::Coord3D { x: p.x, y: p.y, z: p.z };
    let [a, b, c] = corners.map(|p| coord(p.as_dvec3()));
    // Positive where the winding's normal points away from the point.
    let volume = robust::orient3d(a, b, c, coord(point));
    if side > 0 { volume < 0.0 } else { volume > 0.0 }
}

/// Coordinates too small for a ray's origin become 0.
fn without_tiny(p: DVec3) -> DVec3 {
    DVec3::from_array(p.to_array().map(|x| if x.abs() < LEAST_ORIGIN { 0.0 } else { x }))
}

fn largest_axis(v: DVec3) -> usize {
    let [x, y, z] = v.abs().to_array();
    if x >= y && x >= z {
        0
    } else if y >= z {
        1
    } else {
        2
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BruteForce, GzRay, RayQuery, TriBuffer};

    fn square(tilt: f32, offset: f32) -> [GzCoord; 4] {
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
            .map(|[x, y]| GzCoord::new(x + offset, y - offset, 0.3 * x + tilt * y + offset))
    }

    #[test]
    fn rays_that_leave_a_flat_square_never_meet_it_again() {
        // Grazing rays from points at and near the diagonal, where skipping the source triangle alone fails.
        let mut count = 0;
        for offset in [0.0, 1e2, 1e4] {
            let corners = square(0.1, offset);
            let tris = TriBuffer::from_indexed(&corners, &[[0, 1, 2], [0, 2, 3]]).unwrap();
            let brute = BruteForce::new(&tris);
            let normal = tris.face_normal(0);
            for k in 0..2000 {
                let s = f64::from(k) / 2000.0;
                let weights = [s * 0.999_999, 1e-9 * s, 1.0 - s];
                let along = DVec3::new((7.0 * s).sin(), (7.0 * s).cos(), 0.0);
                let flat = along - normal * along.dot(normal);
                let direction = (flat + normal * 1e-3).as_vec3();
                let triangle = tris.position(0);
                let Some(origin) = leave_surface(triangle, weights, direction) else { continue };
                assert!(is_beyond(triangle, origin, side_of(triangle, direction)));
                // At an offset the square is folded by rounding, and the other half may truly rise in front.
                if offset == 0.0 || side_of(tris.position(1), direction) == 0 {
                    assert!(!brute.any_hit(&GzRay::from_f64(origin, direction)), "{k} at {offset}");
                }
                count += 1;
            }
        }
        assert!(count > 5900, "{count} of 6000 rays left");
    }

    #[test]
    fn rays_from_the_edge_of_a_needle_do_not_slip_past_a_wall_on_that_edge() {
        // The edge runs through the origin of space, where a point is small and its rounding is not.
        let mut count = 0;
        for (half, height) in [(1.0, 1e-3), (40.0, 1e-2), (40.0, 1e-4), (1000.0, 1.0), (1000.0, 1e-2)] {
            let (a, b) = (GzCoord::new(-half, -0.3 * half, 0.7 * half), GzCoord::new(half, 0.3 * half, -0.7 * half));
            let across = (b - a).cross(GzCoord::new(0.2, 1.0, 0.1)).normalize();
            let up = across.cross(b - a).normalize();
            let c = (a + b) * 0.5 + across * height;
            let needle = [a, b, c];
            // A wall that stands on the very edge.
            let wall = [a, b, (a + b) * 0.5 + up * half];
            let tris = TriBuffer::from_indexed(&[needle, wall].concat(), &[[0, 1, 2], [3, 4, 5]]).unwrap();
            let brute = BruteForce::new(&tris);
            for k in 0..4000 {
                let s = 0.05 + 0.9 * f64::from(k) / 4000.0;
                for weight in [0.0, 1e-15, 1e-13] {
                    let weights = [s * (1.0 - weight), (1.0 - s) * (1.0 - weight), weight];
                    let direction = (up * 1e-3 - across).normalize();
                    let origin = leave_surface(&needle, weights, direction).unwrap();
                    assert!(brute.any_hit(&GzRay::from_f64(origin, direction)), "{half} {height} {k} {weight}");
                    count += 1;
                }
            }
        }
        assert_eq!(count, 60_000);
    }

    #[test]
    fn a_direction_in_the_plane_and_a_triangle_without_area_have_no_way_out() {
        let corners = square(0.0, 0.0);
        let triangle = [corners[0], corners[1], corners[2]];
        assert_eq!(leave_surface(&triangle, [0.3, 0.3, 0.4], corners[1] - corners[0]), None);
        assert_eq!(leave_surface(&[GzCoord::ONE; 3], [0.3, 0.3, 0.4], GzCoord::X), None);
    }

    #[test]
    fn needles_tiny_and_huge_triangles_are_left_on_the_right_side() {
        for scale in [1e-30f32, 1e-18, 1e-6, 1.0, 1e12, 1e30] {
            for thin in [1.0f32, 1e-3, 1e-6] {
                let triangle =
                    [[0.0, 0.0, 0.0], [1.0, 0.1, 0.3], [0.5, 0.05 + thin, 0.15]].map(|p| GzCoord::from_array(p) * scale);
                for (weights, direction) in
                    [([1.0, 0.0, 0.0], GzCoord::Z), ([0.0, 0.5, 0.5], GzCoord::NEG_Z), ([0.2, 0.2, 0.6], GzCoord::X)]
                {
                    let side = side_of(&triangle, direction);
                    let origin = leave_surface(&triangle, weights, direction).unwrap();
                    assert!(side != 0 && is_beyond(&triangle, origin, side), "{scale} {thin} {direction}");
                    let moved = (origin - triangle[0].as_dvec3()).length();
                    assert!(moved < 2.0 * f64::from(scale), "{moved} at {scale}");
                }
            }
        }
    }
}
