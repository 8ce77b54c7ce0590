//! Which arithmetic settles a ray and a triangle, for who wants to know.

use super::certify::{Verdict, certify};
use super::{Candidates, FilterRay, FilterSpace, TriGroup, is_hit};
use crate::simd::{Simd, Task, dispatch};
use crate::{GzCoord, GzRay, SimdLevel};

/// The arithmetic whose error bound proved whether a ray hits a triangle; the closer and slower, the higher.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rung {
    /// f32, eight triangles at a time.
    F32,
    /// f64, where f32 left it open.
    F64,
    /// Whole numbers, where both left it open.
    Exact,
}

/// Whether a valid ray hits the triangle within its interval of t, and what proved it.
///
/// As the walk of a single ray has it, with the instructions that every machine has, so that the answer is the same everywhere; fused
/// multiply-adds may prove a little more. Without a `space` f32 is not asked. The order of two hits is another question, which may climb
/// higher.
pub fn rung(ray: &GzRay, corners: &[GzCoord; 3], space: Option<&FilterSpace>) -> (bool, Rung) {
    if let Some((space, filter)) = space.and_then(|space| Some((space, FilterRay::new(ray, space)?))) {
        let group = TriGroup::new(&[0], std::slice::from_ref(corners), space);
        match dispatch(SimdLevel::Portable, Filter { group: &group, ray: &filter }).filter(|found| found.possible & 1 != 0) {
            None => return (false, Rung::F32),
            Some(found) if found.sure & 1 != 0 => {
                let (lo, hi) = (found.lo[0], found.hi[0]);
                if lo > ray.tmin && hi < ray.tmax {
                    return (true, Rung::F32);
                }
                if lo > ray.tmax || hi < ray.tmin {
                    return (false, Rung::F32);
                }
            }
            Some(_) => {}
        }
    }
    match certify(ray, corners) {
        Verdict::Miss => (false, Rung::F64),
        Verdict::Hit { .. } => (true, Rung::F64),
        Verdict::Unsure => (is_hit(ray, corners), Rung::Exact),
    }
}

struct Filter<'f> {
    group: &'f TriGroup,
    ray: &'f FilterRay,
}

impl Task for Filter<'_> {
    type Output = Option<Candidates>;

    #[inline(always)]
    fn run<S: Simd>(self) -> Option<Candidates> {
        self.group.candidates::<S>(self.ray)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn triangle() -> [GzCoord; 3] {
        [[0.0, 0.0, 4.0], [8.0, 0.0, 4.0], [0.0, 8.0, 4.0]].map(GzCoord::from_array)
    }

    fn asked(origin: [f64; 3]) -> (bool, Rung) {
        let corners = triangle();
        let ray = GzRay::from_f64(DVec3::from_array(origin), GzCoord::Z);
        let space = FilterSpace::new(GzCoord::splat(8.0));
        let (hit, rung) = rung(&ray, &corners, Some(&space));
        assert_eq!(hit, is_hit(&ray, &corners), "{origin:?}");
        (hit, rung)
    }

    #[test]
    fn the_nearer_the_edge_the_higher_the_rung() {
        assert_eq!(asked([2.0, 2.0, 0.0]), (true, Rung::F32));
        assert_eq!(asked([9.0, 9.0, 0.0]), (false, Rung::F32));
        for side in [-1.0, 1.0] {
            assert_eq!(asked([2.0, side * 1e-9, 0.0]), (side > 0.0, Rung::F64));
        }
        assert_eq!(asked([2.0, 0.0, 0.0]), (true, Rung::Exact), "on the edge itself");
        assert_eq!(asked([4.0, 4.0, 0.0]), (true, Rung::Exact));
        let ray = GzRay::new(GzCoord::new(2.0, 2.0, 0.0), GzCoord::Z);
        assert_eq!(rung(&ray, &triangle(), None), (true, Rung::F64));
    }

    #[test]
    fn a_wide_ground_leaves_to_f32_what_stands_on_it() {
        // A post 5 high and 0.1 wide on a ground of 1260 by 1260, a ray to a point of it near an edge.
        let post = [[4.91, 0.1, -3.25], [4.82, 5.38, -3.34], [4.82, 0.22, -3.34]].map(GzCoord::from_array);
        let eye = GzCoord::new(0.7, 4.7, 13.2);
        let ray = GzRay::new(eye, post[0].lerp(post[1], 0.5).lerp(post[2], 0.01) - eye);
        let reach = GzCoord::new(630.0, 5.6, 630.0);
        assert_eq!(rung(&ray, &post, Some(&FilterSpace::new(reach))), (true, Rung::F32));
        // The same with the ground's height stretched to its width.
        let scale = GzCoord::new(1.0, 64.0, 1.0);
        let stretched = FilterSpace { scale, reach: reach * scale };
        assert_eq!(rung(&ray, &post, Some(&stretched)), (true, Rung::F64));
    }

    #[test]
    fn rays_beyond_the_range_of_f32_begin_in_f64() {
        let ray = GzRay::from_f64(DVec3::new(1.0, 1.0, -1e30), GzCoord::Z);
        assert_eq!(rung(&ray, &triangle(), Some(&FilterSpace::new(GzCoord::splat(8.0)))), (true, Rung::F64));
    }
}
