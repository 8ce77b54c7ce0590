//! Leaving a surface: where a shadow, mirror or glass ray starts.

use crate::GzCoord;
use crate::kernel::{Leaving, Plane, side_sign, without_tiny};
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
    leave_to(corners, weights, side_of(corners, direction))
}

/// The same for a ray to `side`, see [`side_of`].
pub(crate) fn leave_to(corners: &[GzCoord; 3], weights: [f64; 3], side: i8) -> Option<DVec3> {
    if side == 0 {
        return None;
    }
    let numbers = corners.map(|p| p.as_dvec3().to_array());
    let Leaving { plane, mut point, mut step } = Leaving::of(Plane::of(&numbers), &numbers, weights);
    let (axis, towards) = way_out(corners, plane.normal, side)?;
    point = point.map(without_tiny);
    // Steps double, so that the end is certain.
    while plane.side(corners, point) != i32::from(side) {
        point[axis] = without_tiny(point[axis] + towards * step);
        step *= 2.0;
    }
    Some(DVec3::from_array(point))
}

/// The axis to step along and the direction on it that leads to `side`: the axis of the largest normal component, unless rounding
/// has emptied the normal.
fn way_out(corners: &[GzCoord; 3], normal: [f64; 3], side: i8) -> Option<(usize, f64)> {
    let largest = largest_axis(normal.map(f64::abs));
    [largest, 0, 1, 2].into_iter().find_map(|axis| match side_of(corners, GzCoord::AXES[axis]) {
        0 => None,
        sign => Some((axis, f64::from(side * sign))),
    })
}

fn largest_axis([x, y, z]: [f64; 3]) -> usize {
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

    /// Whether `point` is strictly on the given side of the plane.
    fn is_beyond(corners: &[GzCoord; 3], point: DVec3, side: i8) -> bool {
        let coord = |p: DVec3| robust::Coord3D { x: p.x, y: p.y, z: p.z };
        let [a, b, c] = corners.map(|p| coord(p.as_dvec3()));
        // Positive where the winding's normal points away from the point.
        robust::orient3d(a, b, c, coord(point)) * f64::from(side) < 0.0
    }

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
