//! Points of surfaces: where a ray has hit a triangle, and where others go on from.

use crate::kernel::{Plane, hit_weights, point_at};
use crate::leave::leave_to;
use crate::{GzCoord, GzRay, side_of};
use glam::DVec3;

/// The point where a ray has hit a triangle, in f64, and the places from which rays leave it there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Weights of the corners, as [`crate::kernel::hit_weights`] has them.
    pub weights: [f64; 3],
    /// The point, trace space.
    pub point: DVec3,
    /// The side of the triangle's plane that the ray goes to, see [`side_of`].
    pub to_side: i8,
    /// Unit normal of the triangle, on the side of its winding: [`crate::TriBuffer::face_normal`]. Zero for a triangle without area.
    pub normal: DVec3,
    /// How much the normal's product with a direction may be off for each unit of the direction's coordinates, added.
    pub(crate) lean: f64,
    /// Where rays start to side 1 and to side -1.
    pub(crate) starts: Option<[DVec3; 2]>,
}

impl SurfacePoint {
    /// Where `ray` meets the triangle with these corners, which it is known to hit. Without `leaving` there is no place to leave from.
    pub fn of(ray: &GzRay, corners: &[GzCoord; 3], leaving: bool) -> Self {
        let weights = hit_weights(ray, corners);
        let start = |side| leave_to(corners, weights, side).filter(|_| leaving);
        let starts = start(1).zip(start(-1)).map(|(above, below)| [above, below]);
        let (normal, lean) = Plane::of(&corners.map(|p| p.as_dvec3().to_array())).unit();
        // The length of a normal without a direction has no reciprocal.
        let (normal, lean) = if lean.is_finite() { (normal.into(), lean) } else { (DVec3::ZERO, f64::INFINITY) };
        let (point, to_side) = (point_at(corners, weights), side_of(corners, ray.direction));
        Self { weights, point, to_side, normal, lean, starts }
    }

    /// The side of the triangle that `direction` points to, as [`side_of`] has it: seen by the normal in most cases. `corners` are the
    /// triangle's.
    pub fn side_of(&self, corners: &[GzCoord; 3], direction: GzCoord) -> i8 {
        let d = direction.as_dvec3();
        let (slope, error) = (self.normal.dot(d), self.lean * (d.x.abs() + d.y.abs() + d.z.abs()));
        if slope > error {
            1
        } else if slope < -error {
            -1
        } else {
            side_of(corners, direction)
        }
    }

    /// Where a ray starts that leaves to `side`, as [`crate::leave_surface`] has it. `None` for side 0, from a triangle without area, and
    /// where no place was asked for.
    pub fn start(&self, side: i8) -> Option<DVec3> {
        let [above, below] = self.starts?;
        match side {
            1 => Some(above),
            -1 => Some(below),
            _ => None,
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::{TriBuffer, TriId, leave_surface};

    /// Triangles of all kinds side by side, and rays that meet most of them: flat ones, needles, one through the origin of space, tiny and
    /// huge ones, a bent one whose edges round in f64, one without area.
    pub(crate) fn asked() -> (TriBuffer, Vec<(GzRay, TriId)>) {
        let mut triangles = Vec::new();
        for k in 0..40u32 {
            let (x, thin) = (k as f32, 1.0 / (1u32 << (k % 24)) as f32);
            let scale = [1.0, 1e-18, 1e15, 1e-3, 1024.0][k as usize % 5];
            triangles.push([[0.0, 0.0, 0.0], [1.0, 0.1, 0.3], [0.5, 0.05 + thin, 0.15]].map(|p| GzCoord::from_array(p) * scale));
            triangles.push([[x, -1.5, 2.0], [x + 1.0, -1.5, 2.0], [x, -1.5, 3.0 + thin]].map(GzCoord::from_array));
            triangles.push([[-x, 0.3, 1e-17], [x + 0.7, 0.1, 7.0], [1e-30, -0.4 * x, -7.0]].map(GzCoord::from_array));
            triangles.push([[x, x, x], [x + 1.0, x, x], [x + 2.0, x, x]].map(GzCoord::from_array));
        }
        let indices: Vec<[u32; 3]> = (0..triangles.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        let tris = TriBuffer::from_indexed(triangles.as_flattened(), &indices).unwrap();
        let mut asked = Vec::new();
        for (tri, [a, b, c]) in (0..).zip(&triangles) {
            for step in 0..30u32 {
                // Corners, edges and the inside; from a point off the triangle by about its size.
                let (v, w) = ((step % 6) as f32 / 5.0, (step / 6) as f32 / 5.0);
                let w = w.min(1.0 - v);
                let target = *a + (*b - *a) * v + (*c - *a) * w;
                let size = (*b - *a).length();
                let away = GzCoord::new(0.3, 0.9 - 0.1 * step as f32, 0.7) * size;
                asked.push((GzRay::from_f64((target + away).as_dvec3(), -away), tri));
            }
        }
        (tris, asked)
    }

    #[test]
    fn sides_and_starts_are_those_of_side_of_and_leave_surface() {
        let (tris, asked) = asked();
        let mut left = 0;
        for (ray, tri) in asked {
            let corners = tris.position(tri);
            let point = SurfacePoint::of(&ray, corners, true);
            assert_eq!(point.normal, tris.face_normal(tri), "{corners:?}");
            let along = corners[1] - corners[0];
            for direction in [ray.direction, -ray.direction, GzCoord::new(0.1, -0.8, 0.3), GzCoord::Z, along] {
                assert_eq!(point.side_of(corners, direction), side_of(corners, direction), "{corners:?} {direction}");
                let start = point.start(side_of(corners, direction));
                assert_eq!(start, leave_surface(corners, point.weights, direction), "{corners:?} {direction}");
                left += u32::from(start.is_some());
            }
            assert_eq!((point.start(0), SurfacePoint::of(&ray, corners, false).start(1)), (None, None));
        }
        assert!(left > 10_000, "{left}");
    }
}
