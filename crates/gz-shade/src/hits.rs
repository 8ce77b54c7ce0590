//! Hits of rays, eight side by side, with all that mirrors, glass and lights want to know of them.

use crate::eight::{Rows, above, arrays, dot, lanes, load, plus, select, set, signs, times, widen};
use crate::interpolate::{corner_normals, normal, outside};
use crate::tree::Node;
use crate::{Interpolate, Scene, SceneNeeds};
use gz_core::simd::{Doubles, Lanes, Simd, Task, dispatch, nine};
use glam::DVec3;
use gz_core::{EightPoints, GzCoord, SimdLevel, TriId};

/// Up to eight hits.
#[derive(Debug)]
pub(crate) struct EightHits {
    /// The nodes of the rays, and the triangles; lanes beyond the last repeat the first.
    pub(crate) nodes: [u32; 8],
    pub(crate) tris: [TriId; 8],
    pub(crate) count: usize,
    pub(crate) at: EightPoints,
    /// Unit normals as the materials interpolate them, on the outer sides: [`normal`].
    pub(crate) normal: Rows,
    /// The outer sides of the triangles: [`outside`].
    pub(crate) outside: [i8; 8],
}

impl EightHits {
    /// The hits of the rays of `ids` among `nodes`, 1 to 8.
    pub(crate) fn of(scene: &Scene, needs: SceneNeeds, nodes: &[Node], ids: &[u32]) -> Self {
        let of = std::array::from_fn(|k| ids[if k < ids.len() { k } else { 0 }]);
        let hits = of.map(|id| &nodes[id as usize]);
        let tris = hits.map(|node| node.hit.tri);
        let leaving = scene.rules.leave.needs_starts() && scene.has_secondary_rays();
        let corners = tris.map(|tri| scene.tris.position(tri));
        let level = SimdLevel::best();
        let at = EightPoints::of(&hits.map(|node| node.ray), &corners, leaving, level);

        let normals = tris.map(|tri| corner_normals(&scene.tris, needs, tri));
        let stored = (0..8).fold(0, |bits, k| bits | u32::from(normals[k].is_some()) << k);
        let is_smooth = |k: &usize| scene.material(tris[*k]).interpolate != Interpolate::Flat;
        let smooth = lanes(stored).filter(is_smooth).fold(0, |bits, k| bits | 1 << k);
        let normals = normals.map(|normals| normals.map_or(&[0.0; 9], nine));
        let Normals { normal: rows, outside: sides, open } = dispatch(level, FindNormals { at: &at, normals: &normals, stored, smooth });

        let mut hits = Self { nodes: of, tris, count: ids.len(), at, normal: rows, outside: sides };
        for k in lanes(open) {
            let (tri, at) = (tris[k], hits.at.lane(k));
            hits.outside[k] = outside(&scene.tris, needs, tri, &at);
            let n = normal(&scene.tris, needs, tri, &at, scene.material(tri).interpolate, at.weights);
            set(&mut hits.normal, k, n);
        }
        hits
    }

    /// Where a ray starts that leaves hit `k` along `direction`, to `side` of its triangle; `None` if there is no way out.
    #[inline]
    pub(crate) fn origin(&self, scene: &Scene, k: usize, direction: GzCoord, side: i8) -> Option<DVec3> {
        let (corners, weights) = (scene.tris.position(self.tris[k]), self.at.weights.map(|row| row[k]));
        scene.rules.leave.origin(self.at.start(k, side), corners, weights, direction)
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
}

struct Normals {
    normal: Rows,
    outside: [i8; 8],
    /// The lanes that one has to look at by itself.
    open: u32,
}

impl Task for FindNormals<'_> {
    type Output = Normals;

    #[inline(always)]
    fn run<S: Simd>(self) -> Normals {
        let Self { at, normals, stored, smooth } = self;
        let n = S::corners(normals);
        // 1. The outer side is where the corner normals point, that of the winding where there are none.
        let sum = [n[0].plus(n[3]).plus(n[6]), n[1].plus(n[4]).plus(n[7]), n[2].plus(n[5]).plus(n[8])];
        let (up, down) = at.sides(&widen::<S>(&sum));
        let up = up | !stored;
        let mut outside = [-1; 8];
        for (k, side) in outside.iter_mut().enumerate() {
            if up >> k & 1 != 0 {
                *side = 1;
            }
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
            let certain = above(square, <S::Doubles>::splat(crate::interpolate::LEAST_SQUARE));
            let unit = times(&sum, <S::Doubles>::splat(1.0).over(square.sqrt()));
            normal = select(&unit, smooth & certain, &normal);
        }
        Normals { normal: arrays(&normal), outside, open: !(up | down) & 0xff }
    }
}

#[cfg(test)]
mod tests {}
