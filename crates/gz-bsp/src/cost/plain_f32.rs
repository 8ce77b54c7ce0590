//! The same walk without proof, to be measured against.

use super::batch::{AnyTask, ClosestTask};
use super::wide::BspTree;
use gz_core::kernel::{InPlainF32, Stopped};
use gz_core::simd::dispatch;
use gz_core::{ClassMask, Hit, RayBatch, RayQuery, Targets, TriBuffer, with_default_float_control};

/// A [`BspTree`] that is asked in plain f32: answers may be wrong, and that is the point.
///
/// Nodes, leaves, packets and the order of visits are those of the tree, and the triangle test is the same arithmetic; left out are bounds,
/// intervals of t, the certified f64 test and the exact stage, and T, u and v are formed in f32. What the tree takes longer is what
/// exactness costs.
#[derive(Clone, Copy, Debug)]
pub struct PlainF32Tree<'a>(pub &'a BspTree<'a>);

impl RayQuery for PlainF32Tree<'_> {
    fn tris(&self) -> &TriBuffer {
        self.0.tris
    }

    fn closest_hits(&self, rays: &RayBatch<'_>, classes: ClassMask, hits: &mut [Hit]) {
        assert_eq!(rays.len(), hits.len(), "one hit a ray");
        let (tree, targets) = (self.0, Targets::new(self.0.tris, classes));
        let task = ClosestTask { tree, rays, targets, hits, visits: &mut () };
        with_default_float_control(|| dispatch(tree.level, InPlainF32(task)));
    }

    fn any_hits(&self, rays: &RayBatch<'_>, classes: ClassMask, occluded: &mut [bool]) {
        assert_eq!(rays.len(), occluded.len(), "one answer a ray");
        let (tree, targets) = (self.0, Targets::new(self.0.tris, classes));
        let task = AnyTask { tree, rays, targets, occluded, on_hit: Stopped, visits: &mut () };
        with_default_float_control(|| dispatch(tree.level, InPlainF32(task)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gz_core::{BruteForce, GzCoord, GzRay, PerRay, SimdLevel};

    /// A bumpy sheet of 2 * 32 * 32 triangles.
    fn sheet() -> TriBuffer {
        let at = |k: usize| GzCoord::new((k % 33) as f32, (k / 33) as f32, ((k * 7919) % 101) as f32 / 50.0);
        let corners: Vec<GzCoord> = (0..33 * 33).map(at).collect();
        let cell = |k: u32| {
            let a = k / 32 * 33 + k % 32;
            [[a, a + 1, a + 33], [a + 1, a + 34, a + 33]]
        };
        TriBuffer::from_indexed(&corners, &(0..32 * 32).flat_map(cell).collect::<Vec<_>>()).unwrap()
    }

    #[test]
    fn where_nothing_is_close_plain_f32_finds_the_same_triangles() {
        let tris = sheet();
        let eye = GzCoord::new(15.3, 17.9, -40.0);
        // Inside of triangles: a third of each corner, a little moved.
        let directions: Vec<GzCoord> = tris.positions().iter().map(|[a, b, c]| *a * 0.31 + *b * 0.33 + *c * 0.36 - eye).collect();
        let n = directions.len();
        let from_eye = RayBatch::unbounded(n, PerRay::One(eye.as_dvec3()), PerRay::Each(&directions));
        let origins: Vec<_> = directions.iter().map(|d| (eye + *d * 0.5).as_dvec3()).collect();
        let apart = RayBatch::unbounded(n, PerRay::Each(&origins), PerRay::Each(&directions));
        let brute = BruteForce::new(&tris);
        for level in SimdLevel::available() {
            let tree = BspTree::build(&tris).with_simd(*level);
            let plain = PlainF32Tree(&tree);
            for rays in [&from_eye, &apart] {
                let (mut truth, mut found) = (vec![Hit::MISS; n], vec![Hit::MISS; n]);
                brute.closest_hits(rays, ClassMask::ALL, &mut truth);
                plain.closest_hits(rays, ClassMask::ALL, &mut found);
                for (a, b) in truth.iter().zip(&found) {
                    assert_eq!(a.tri, b.tri, "{level:?}");
                    assert!(
                        (a.t - b.t).abs() <= 1e-5 * a.t && (a.u - b.u).abs() < 1e-3 && (a.v - b.v).abs() < 1e-3,
                        "{a:?} {b:?}"
                    );
                }
                let mut blocked = vec![false; n];
                plain.any_hits(rays, ClassMask::ALL, &mut blocked);
                assert!(blocked.iter().all(|blocked| *blocked));
            }
            let one = GzRay::new(eye, directions[77]);
            assert_eq!(plain.closest_hit(&one).tri, brute.closest_hit(&one).tri);
        }
    }

    #[test]
    fn it_is_wrong_where_proof_is_needed() {
        // Through corners and edges of the sheet: f32 lets rays slip between neighbours, or has them hit another one.
        let tris = sheet();
        let eye = GzCoord::new(15.3, 17.9, -40.0);
        let directions: Vec<GzCoord> = tris.positions().iter().map(|[a, b, _]| (*a + *b) * 0.5 - eye).collect();
        let n = directions.len();
        let rays = RayBatch::unbounded(n, PerRay::One(eye.as_dvec3()), PerRay::Each(&directions));
        let (mut truth, mut found) = (vec![Hit::MISS; n], vec![Hit::MISS; n]);
        BruteForce::new(&tris).closest_hits(&rays, ClassMask::ALL, &mut truth);
        let tree = BspTree::build(&tris);
        PlainF32Tree(&tree).closest_hits(&rays, ClassMask::ALL, &mut found);
        let wrong = truth.iter().zip(&found).filter(|(a, b)| a.tri != b.tri).count();
        assert!(wrong > 0, "{n} rays through edges, and plain f32 has every triangle right");
        let mut exact = vec![Hit::MISS; n];
        tree.closest_hits(&rays, ClassMask::ALL, &mut exact);
        assert_eq!(exact, truth);
    }
}
