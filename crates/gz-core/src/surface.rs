//! Points of surfaces: where a ray has hit a triangle, and where others go on from.

use crate::kernel::{EightPoints, Plane, hit_weights, point_at};
use crate::leave::leave_to;
use crate::simd::dispatch;
use crate::{GzCoord, GzRay, SimdLevel, TriBuffer, TriId, side_of};
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
    /// Unit normal of the triangle, on the side of its winding: [`TriBuffer::face_normal`]. Zero for a triangle without area.
    pub normal: DVec3,
    /// How much the normal's product with a direction may be off for each unit of the direction's coordinates, added.
    pub(crate) lean: f64,
    /// Where rays start to side 1 and to side -1.
    pub(crate) starts: Option<[DVec3; 2]>,
}

impl SurfacePoint {
    /// Of a ray that hits nothing.
    pub const NOWHERE: Self =
        Self { weights: [1.0, 0.0, 0.0], point: DVec3::ZERO, to_side: 0, normal: DVec3::ZERO, lean: f64::INFINITY, starts: None };

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

    /// Adds the points of `hits` to `points`: of each its ray and the triangle of `tris` that it is known to hit; `None`, of a miss, is
    /// [`Self::NOWHERE`]. Eight at a time with the instructions of `level`; the numbers are those of [`Self::of`].
    pub fn of_hits(
        tris: &TriBuffer,
        hits: impl Iterator<Item = Option<(GzRay, TriId)>>,
        leaving: bool,
        level: SimdLevel,
        points: &mut Vec<Self>,
    ) {
        let mut eight = Waiting::default();
        for hit in hits {
            if let Some((ray, tri)) = hit {
                eight.add(ray, tris.position(tri), points.len());
            }
            points.push(Self::NOWHERE);
            if eight.count == 8 {
                eight.settle(leaving, level, points);
            }
        }
        eight.settle(leaving, level, points);
    }
}

/// Hits that wait until there are eight.
#[derive(Default)]
struct Waiting<'t> {
    /// Rays, the corners of their triangles, and their places in the list; unused ones hold what was there.
    hits: Option<([GzRay; 8], [&'t [GzCoord; 3]; 8])>,
    places: [usize; 8],
    count: usize,
}

impl<'t> Waiting<'t> {
    fn add(&mut self, ray: GzRay, corners: &'t [GzCoord; 3], place: usize) {
        let (rays, triangles) = self.hits.get_or_insert(([ray; 8], [corners; 8]));
        (rays[self.count], triangles[self.count], self.places[self.count]) = (ray, corners, place);
        self.count += 1;
    }

    fn settle(&mut self, leaving: bool, level: SimdLevel, points: &mut [SurfacePoint]) {
        let Some((rays, corners)) = &self.hits else { return };
        let (eight, settled) = dispatch(level, EightPoints { rays, corners: *corners, leaving });
        for (k, &place) in self.places[..self.count].iter().enumerate() {
            let settled = settled >> k & 1 != 0;
            points[place] = if settled { eight[k] } else { SurfacePoint::of(&rays[k], corners[k], leaving) };
        }
        self.count = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BruteForce, RayQuery, leave_surface};

    /// Triangles of all kinds side by side, and rays that meet most of them: flat ones, needles, one through the origin of space, tiny and
    /// huge ones, a bent one whose edges round in f64, one without area.
    fn asked() -> (TriBuffer, Vec<(GzRay, TriId)>) {
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
    fn eight_points_at_a_time_are_those_of_one_at_every_level() {
        let (tris, asked) = asked();
        let brute = BruteForce::new(&tris);
        // A miss in between, and a last batch of fewer than eight.
        let hits: Vec<_> = asked
            .iter()
            .enumerate()
            .map(|(k, &(ray, tri))| (k % 11 != 0 && brute.closest_hit(&ray).is_hit()).then_some((ray, tri)))
            .filter(|hit| hit.is_none_or(|(ray, tri)| crate::kernel::is_hit(&ray, tris.position(tri))))
            .collect();
        for leaving in [true, false] {
            let expected: Vec<SurfacePoint> = hits
                .iter()
                .map(|hit| hit.map_or(SurfacePoint::NOWHERE, |(ray, tri)| SurfacePoint::of(&ray, tris.position(tri), leaving)))
                .collect();
            let met = expected.iter().filter(|point| point.to_side != 0).count();
            assert!(met > 1500, "{met} of {}", hits.len());
            for &level in SimdLevel::available() {
                let mut points = Vec::new();
                SurfacePoint::of_hits(&tris, hits.iter().copied(), leaving, level, &mut points);
                assert_eq!(points.len(), expected.len());
                for (k, (point, expected)) in points.iter().zip(&expected).enumerate() {
                    assert_eq!(point, expected, "{k} at {level:?}");
                }
            }
        }
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
