//! Hits of rays, eight side by side, with all that mirrors, glass and lights want to know of them.

use crate::eight::{Rows, above, arrays, dot, lanes, load, plus, select, set, signs, times, widen};
use crate::interpolate::{self, LEAST_SQUARE, corner_normals};
use crate::rays::Rays;
use crate::tree::Node;
use crate::{Interpolate, Scene, SceneNeeds};
use glam::DVec3;
use gz_core::simd::{Doubles, Lanes, Simd, Task, dispatch, nine};
use gz_core::{EightPoints, GzCoord, LeavePolicy, SimdLevel, TriId};

/// Up to eight hits.
#[derive(Debug)]
pub(crate) struct EightHits {
    /// The nodes of the rays, and the triangles; lanes beyond the last repeat the first.
    pub(crate) nodes: [u32; 8],
    pub(crate) tris: [TriId; 8],
    pub(crate) count: usize,
    pub(crate) at: EightPoints,
    /// Unit normals as the materials interpolate them, on the outer sides: [`interpolate::normal`].
    pub(crate) normal: Rows,
    /// The outer sides of the triangles: [`interpolate::outside`].
    pub(crate) outside: [i8; 8],
}

impl EightHits {
    /// None.
    pub(crate) const NONE: Self =
        Self { nodes: [0; 8], tris: [0; 8], count: 0, at: EightPoints::NOWHERE, normal: [[0.0; 8]; 3], outside: [0; 8] };

    /// Becomes the hits of the rays of `ids` among `nodes`, 1 to 8.
    pub(crate) fn take(&mut self, scene: &Scene, needs: SceneNeeds, nodes: &[Node], rays: &Rays, ids: &[u32]) {
        self.count = ids.len();
        self.nodes = std::array::from_fn(|k| ids[if k < ids.len() { k } else { 0 }]);
        self.tris = self.nodes.map(|id| nodes[id as usize].hit.tri);
        let corners = self.tris.map(|tri| scene.tris.position(tri));
        let leaving = scene.rules.leave.needs_starts() && scene.has_secondary_rays();
        let level = SimdLevel::best();
        let (origins, directions) = rays.eight(&self.nodes);
        self.at.find(&origins, &directions, &corners, leaving, level);

        let stored = self.tris.map(|tri| corner_normals(&scene.tris, needs, tri));
        let bits = |is: &dyn Fn(usize) -> bool| (0..8).fold(0, |bits, k| bits | u32::from(is(k)) << k);
        let smooth = bits(&|k| stored[k].is_some() && scene.material(self.tris[k]).interpolate != Interpolate::Flat);
        let normals = stored.map(|normals| normals.map_or(&[0.0; 9], nine));
        let stored = bits(&|k| stored[k].is_some());
        let (at, normal, outside) = (&self.at, &mut self.normal, &mut self.outside);
        let open = dispatch(level, FindNormals { at, normals: &normals, stored, smooth, normal, outside });
        for k in lanes(open) {
            let (tri, at) = (self.tris[k], self.at.lane(k));
            self.outside[k] = interpolate::outside(&scene.tris, needs, tri, &at);
            let interpolate = scene.material(tri).interpolate;
            set(&mut self.normal, k, interpolate::normal(&scene.tris, needs, tri, &at, interpolate, at.weights));
        }
    }

    /// What `then` makes of the place where a ray starts that leaves hit `k` along `direction`, to `side` of its triangle; `None` if there is
    /// no way out.
    ///
    /// A place that comes out of a `match` is put together in memory and read back in other pieces, which stalls: hence `then` in each arm.
    #[inline(always)]
    pub(crate) fn leave<R>(
        &self,
        scene: &Scene,
        k: usize,
        direction: GzCoord,
        side: i8,
        then: impl FnOnce(DVec3) -> R,
    ) -> Option<R> {
        match scene.rules.leave {
            LeavePolicy::Exact => self.at.start(k, side).map(then),
            _ => self.other_origin(scene, k, direction).map(then),
        }
    }

    /// By the rules that are no proof.
    #[cold]
    #[inline(never)]
    fn other_origin(&self, scene: &Scene, k: usize, direction: GzCoord) -> Option<DVec3> {
        let weights = self.at.weights.map(|row| row[k]);
        scene.rules.leave.leave(scene.tris.position(self.tris[k]), weights, direction).map(|ray| ray.origin)
    }
}

/// The normals of eight hits.
struct FindNormals<'h> {
    at: &'h EightPoints,
    /// Those of the corners.
    normals: &'h [&'h [f32; 9]; 8],
    /// The lanes that have those, and of them those that are to be interpolated.
    stored: u32,
    smooth: u32,
    normal: &'h mut Rows,
    outside: &'h mut [i8; 8],
}

impl Task for FindNormals<'_> {
    /// The lanes that one has to look at by itself.
    type Output = u32;

    #[inline(always)]
    fn run<S: Simd>(self) -> u32 {
        let Self { at, normals, stored, smooth, normal: to, outside } = self;
        let n = S::corners(normals);
        // 1. The outer side is where the corner normals point, that of the winding where there are none.
        let sum = [n[0].plus(n[3]).plus(n[6]), n[1].plus(n[4]).plus(n[7]), n[2].plus(n[5]).plus(n[8])];
        let (up, down) = at.sides(&widen::<S>(&sum));
        let up = up | !stored;
        for (k, side) in outside.iter_mut().enumerate() {
            *side = if up >> k & 1 != 0 { 1 } else { -1 };
        }
        // 2. Flat normals, and smooth ones where the corner normals do not cancel.
        let mut normal = times(&load::<S::Doubles>(&at.normal), signs(up));
        if smooth != 0 {
            let [a, b, c] = load::<S::Doubles>(&at.weights);
            let sum = plus(
                &plus(&times(&widen::<S>(&[n[0], n[1], n[2]]), a), &times(&widen::<S>(&[n[3], n[4], n[5]]), b)),
                &times(&widen::<S>(&[n[6], n[7], n[8]]), c),
            );
            let square = dot(&sum, &sum);
            let certain = above(square, <S::Doubles>::splat(LEAST_SQUARE));
            let unit = times(&sum, <S::Doubles>::splat(1.0).over(square.sqrt()));
            normal = select(&unit, smooth & certain, &normal);
        }
        *to = arrays(&normal);
        !(up | down) & 0xff
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::eight::vector;
    use gz_core::{Attributes, GzRay, GzTri, TriBuffer, side_of};

    /// Numbers from -1 to 1.
    pub(crate) fn dice() -> impl FnMut() -> f32 {
        let mut state = 7u64;
        move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f32 / (1u64 << 23) as f32 - 1.0
        }
    }

    /// Eight triangles with normals of all kinds (leaning, opposite, none, in the plane), and rays that hit them.
    pub(crate) fn eight(unit: &mut impl FnMut() -> f32) -> (TriBuffer, EightHits, [GzRay; 8]) {
        let mut tris = TriBuffer::with_attributes(Attributes::ALL, 1);
        let mut any = || GzCoord::new(unit(), unit(), unit());
        let rays = std::array::from_fn(|k| {
            let positions = [any(), any(), any()];
            let face = (positions[1] - positions[0]).cross(positions[2] - positions[0]).normalize();
            let normals = match k {
                0 => [GzCoord::ZERO; 3],
                1 => [GzCoord::X, GzCoord::NEG_X, GzCoord::ZERO],
                2 => [(positions[1] - positions[0]).normalize(); 3],
                3 => [-face; 3],
                _ => std::array::from_fn(|_| (face + any() * 0.7).normalize()),
            };
            tris.push(&GzTri { positions, normals, ..GzTri::default() }).unwrap();
            let towards = any();
            GzRay::new((positions[0] + positions[1] + positions[2]) / 3.0 - towards, towards)
        });
        let mut hits = EightHits { count: 8, tris: std::array::from_fn(|k| k as TriId), ..EightHits::NONE };
        let corners = hits.tris.map(|tri| tris.position(tri));
        let (origins, directions) = (rays.map(|ray| ray.origin.to_array()), rays.map(|ray| ray.direction.to_array()));
        hits.at.find(&origins, &directions, &corners, true, SimdLevel::Portable);
        (tris, hits, rays)
    }

    #[test]
    fn normals_and_outer_sides_are_those_of_one_hit_at_every_level() {
        let (mut unit, mut open_lanes) = (dice(), 0);
        for round in 0..200u32 {
            let (tris, hits, _) = eight(&mut unit);
            let (stored, smooth) = (0xff & !(round & 16), 0xff & !(round & 16) & !(round & 15));
            let normals = hits.tris.map(|tri| nine(tris.normals(tri).unwrap()));
            let bare =
                TriBuffer::from_indexed(tris.positions().as_flattened(), &hits.tris.map(|t| [3 * t, 3 * t + 1, 3 * t + 2]));
            let bare = bare.unwrap();
            for &level in SimdLevel::available() {
                let (mut rows, mut sides) = ([[0.0; 8]; 3], [0; 8]);
                let (at, normal, outside) = (&hits.at, &mut rows, &mut sides);
                let open = dispatch(level, FindNormals { at, normals: &normals, stored, smooth, normal, outside });
                open_lanes += open.count_ones();
                for k in lanes(0xff & !open) {
                    let tris = if stored >> k & 1 != 0 { &tris } else { &bare };
                    let how = if smooth >> k & 1 != 0 { Interpolate::Phong } else { Interpolate::Flat };
                    let at = hits.at.lane(k);
                    let n = interpolate::normal(tris, SceneNeeds::ALL, hits.tris[k], &at, how, at.weights);
                    assert_eq!((vector(&rows, k), sides[k]), (n, interpolate::outside(tris, SceneNeeds::ALL, hits.tris[k], &at)));
                }
            }
        }
        // Normals that cancel, or lie in the plane to a rounding or two, are open; the others are not.
        let of = 200 * 8 * SimdLevel::available().len() as u32;
        assert!(open_lanes > of / 8 && open_lanes < of / 2, "{open_lanes} of {of} open");
    }

    #[test]
    fn a_ray_leaves_to_the_side_that_it_is_told() {
        let (tris, hits, _) = eight(&mut dice());
        for k in 0..8 {
            let corners = tris.position(hits.tris[k]);
            for direction in [GzCoord::X, GzCoord::new(0.3, -0.4, 0.5)] {
                let side = side_of(corners, direction);
                assert_eq!(hits.at.start(k, side), gz_core::leave_surface(corners, hits.at.lane(k).weights, direction));
            }
        }
    }
}
