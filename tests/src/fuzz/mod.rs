//! What the fuzz targets of `tests/fuzz` do with their bytes.
//!
//! It is here so that `cargo test` runs it over the seeds and over whatever once crashed, on any toolchain. A target returns when all is
//! well and panics when it is not.

mod bytes;
pub mod seeds;

use crate::judge::{SETTINGS, Verdict, buffer, judge, truth_ray, truth_triangle};
use crate::truth::{Found, Meeting, Truth, plain};
use bytes::Bytes;
use gz_bsp::{BspTree, CostStats, Midpoint, MidpointTree, TreeStats};
use gz_core::glam::DVec3;
use gz_core::{BruteForce, ClassMask, GzCoord, GzRay, GzTri, Hit, PerRay, RayBatch, RayQuery, SimdLevel, TriBuffer};

/// The most triangles that [`trace`] takes.
const TRACED: usize = 64;
/// The most that [`build_tree`] takes.
const BUILT: usize = 2048;

/// Raw bits as up to 64 triangles and as many rays: nothing panics, and brute force, both trees and plain integers agree.
pub fn trace(data: &[u8]) {
    let mut bytes = Bytes::new(data);
    let mut tris = TriBuffer::new();
    for _ in 0..bytes.below(TRACED + 1) {
        // A corner is raw bits or one that was there before.
        let positions = std::array::from_fn(|_| match bytes.below(4) {
            0 if !tris.is_empty() => tris.position(bytes.below(tris.len()) as u32)[bytes.below(3)],
            _ => bytes.point(),
        });
        let finite = positions.iter().all(|p: &GzCoord| p.is_finite());
        assert_eq!(tris.push(&GzTri { positions, ..GzTri::default() }).is_ok(), finite, "what is not finite is refused");
    }
    let triangles: Vec<_> = tris.positions().iter().map(truth_triangle).collect();
    let brute = BruteForce::new(&tris);
    let tree = BspTree::build(&tris);
    let paper = MidpointTree::build(&tris, Midpoint { max_depth: 6, min_size: 2, node_budget: 1 << 12 });
    let rays: Vec<GzRay> = (0..1 + bytes.below(8)).map(|_| any_ray(&mut bytes, &tris)).collect();
    let mut together = vec![Hit::MISS; rays.len()];
    with_batch(&rays, |batch| tree.closest_hits(batch, ClassMask::ALL, &mut together));
    for (ray, together) in rays.iter().zip(&together) {
        let hit = brute.closest_hit(ray);
        assert_eq!(judge(&hit, plain::closest(&truth_ray(ray), &triangles)), Verdict::Right, "{ray:?} {hit:?}");
        for found in [tree.closest_hit(ray), *together, paper.as_ref().map_or(hit, |paper| paper.closest_hit(ray))] {
            assert!(found == hit && found.t.to_bits() == hit.t.to_bits(), "{ray:?}: {found:?}, not {hit:?}");
        }
        assert_eq!((brute.any_hit(ray), tree.any_hit(ray)), (hit.is_hit(), hit.is_hit()), "{ray:?}");
    }
}

/// Rays at edges, corners and insides of triangles that share them: no triangle that is truly hit is filtered out, alone, among others or for
/// rays in company, at any SIMD level.
pub fn filter_soundness(data: &[u8]) {
    let mut bytes = Bytes::new(data);
    let (scale, offset) = (bytes.power(40), bytes.power(20) * f32::from(bytes.byte() % 3));
    let point = |bytes: &mut Bytes<'_>| GzCoord::from_array(std::array::from_fn(|_| bytes.short() * scale + offset * scale));
    let points: Vec<GzCoord> = (0..3 + bytes.below(6)).map(|_| point(&mut bytes)).collect();
    let mut triangles = Vec::new();
    for _ in 0..1 + bytes.below(16) {
        let mut corners: [GzCoord; 3] = std::array::from_fn(|_| points[bytes.below(points.len())]);
        if bytes.below(4) == 0 {
            // A needle: the third corner at a hair from the line of the others.
            let t = f32::from(bytes.byte()) / 255.0;
            corners[2] = corners[0] + (corners[1] - corners[0]) * t + (corners[2] - corners[0]) * bytes.power(24);
        }
        triangles.push(corners);
    }
    let tris = buffer(triangles.iter().copied().filter(|t| t.iter().all(|p| p.is_finite())));
    if tris.is_empty() {
        return;
    }
    let truth = Truth::new(&tris.positions().iter().map(truth_triangle).collect::<Vec<_>>());
    for _ in 0..1 + bytes.below(8) {
        let [a, b, c] = tris.position(bytes.below(tris.len()) as u32).map(|p| p.as_dvec3());
        let (u, v) = (f64::from(bytes.byte()) / 255.0, f64::from(bytes.byte()) / 255.0);
        let aim = match bytes.below(4) {
            0 => a,
            1 => a + (b - a) * u,
            2 => a + (b - a) * u + (c - b) * v * u,
            _ => a + (b - a) * (1.0 + f64::EPSILON) * u,
        };
        let origin = point(&mut bytes).as_dvec3() * f64::from(1 + bytes.byte() % 4);
        let ray = GzRay::from_f64(origin, (aim - origin).as_vec3());
        let expected = truth.closest(&truth_ray(&ray));
        for &level in SimdLevel::available() {
            let hit = BruteForce::new(&tris).with_simd(level).closest_hit(&ray);
            assert_eq!(judge(&hit, expected), Verdict::Right, "{level:?}: {ray:?} {hit:?} {expected:?}");
            let hit = BspTree::build(&tris).with_simd(level).closest_hit(&ray);
            assert_eq!(judge(&hit, expected), Verdict::Right, "{level:?}, tree: {ray:?} {hit:?} {expected:?}");
        }
        in_company(&tris, &truth, origin, 1 + bytes.below(40), bytes.power(30));
        for corners in tris.positions() {
            let exact = truth_ray(&ray).line().and_then(|line| Meeting::of(&line, &truth_triangle(corners)));
            let alone = buffer([*corners]);
            for &level in SimdLevel::available() {
                let found = BruteForce::new(&alone).with_simd(level).any_hit(&ray);
                assert_eq!(found, exact.is_some(), "{level:?}: {ray:?} {corners:?}");
            }
        }
    }
}

/// Asks the tree about `count` rays together, from `origin` or from within `apart` of it, at corners, edges and insides of all triangles.
fn in_company(tris: &TriBuffer, truth: &Truth, origin: DVec3, count: usize, apart: f32) {
    let aim = |k: usize| {
        let [a, b, c] = tris.position((k / 3 % tris.len()) as u32).map(|p| p.as_dvec3());
        let t = (k * 37 % 256) as f64 / 255.0;
        [a, a + (b - a) * t, a + (b - a) * t + (c - b) * (t * t)][k % 3]
    };
    for apart in [0.0, f64::from(apart)] {
        let origins: Vec<DVec3> = (0..count).map(|k| origin + DVec3::new(1.0, -0.5, 0.25) * (apart * k as f64)).collect();
        let directions: Vec<GzCoord> = origins.iter().enumerate().map(|(k, origin)| (aim(k) - origin).as_vec3()).collect();
        let from = if apart == 0.0 { PerRay::One(origin) } else { PerRay::Each(&origins[..]) };
        let batch = RayBatch::unbounded(count, from, PerRay::Each(&directions));
        let expected: Vec<Option<Found>> = (0..count).map(|k| truth.closest(&truth_ray(&batch.ray(k)))).collect();
        for &level in SimdLevel::available() {
            let tree = BspTree::build(tris).with_simd(level);
            let (mut hits, mut any) = (vec![Hit::MISS; count], vec![false; count]);
            tree.closest_hits(&batch, ClassMask::ALL, &mut hits);
            tree.any_hits(&batch, ClassMask::ALL, &mut any);
            for (k, expected) in expected.iter().enumerate() {
                let verdict = judge(&hits[k], *expected);
                assert_eq!(
                    (verdict, any[k]),
                    (Verdict::Right, expected.is_some()),
                    "{level:?}: {:?} {:?}",
                    batch.ray(k),
                    hits[k]
                );
            }
        }
    }
}

/// Raw bits as corners: every tree is built within bounds, is well formed, and finds what brute force finds.
pub fn build_tree(data: &[u8]) {
    let mut bytes = Bytes::new(data);
    // Each triangle as often as is asked for, as it is or a step of f32 further each time.
    let (copies, moved) = (1 + bytes.below(40), bytes.below(2) == 1);
    let mut triangles = Vec::new();
    while !bytes.is_empty() && triangles.len() < BUILT {
        let mut corners: [GzCoord; 3] = std::array::from_fn(|_| bytes.point());
        for _ in 0..copies {
            if corners.iter().all(|p| p.is_finite()) && triangles.len() < BUILT {
                triangles.push(corners);
            }
            if moved {
                corners = corners.map(|p| GzCoord::from_array(p.to_array().map(f32::next_up)));
            }
        }
    }
    let tris = buffer(triangles.iter().copied());
    let tree = BspTree::build(&tris);
    tree.assert_well_formed();
    let stats = CostStats::of(&tree);
    assert!(stats.references <= 5 * tris.len() + 64 && stats.nodes <= 64 * tris.len().max(1), "{stats:?}");
    for (max_depth, min_size) in SETTINGS {
        let setting = Midpoint { max_depth, min_size, node_budget: 1 << 12 };
        if let Ok(paper) = MidpointTree::build(&tris, setting) {
            paper.assert_well_formed();
            let stats = TreeStats::of(&paper);
            assert!(stats.nodes <= setting.node_budget && stats.references <= 16 * setting.node_budget, "{stats:?}");
        }
    }
    // A few rays along axes and through corners.
    let brute = BruteForce::new(&tris);
    for k in 0..tris.len().min(6) {
        let at = tris.position((k * tris.len() / 6) as u32)[k % 3];
        for ray in [GzRay::new(GzCoord::ZERO, at), GzRay { tmin: f32::NEG_INFINITY, ..GzRay::new(at, GzCoord::AXES[k % 3]) }] {
            assert_eq!(tree.closest_hit(&ray), brute.closest_hit(&ray), "{ray:?}");
        }
    }
}

/// Raw bits, or aimed at a corner, an edge or the plane of a triangle.
fn any_ray(bytes: &mut Bytes<'_>, tris: &TriBuffer) -> GzRay {
    let origin = match bytes.below(4) {
        0 if !tris.is_empty() => tris.position(bytes.below(tris.len()) as u32)[bytes.below(3)].as_dvec3(),
        1 => bytes.point_f64(),
        _ => bytes.point().as_dvec3(),
    };
    let direction = match bytes.below(4) {
        0 if !tris.is_empty() => {
            let [a, b, _] = tris.position(bytes.below(tris.len()) as u32);
            ((*a + (*b - *a) * (f32::from(bytes.byte()) / 255.0)).as_dvec3() - origin).as_vec3()
        }
        1 => GzCoord::AXES[bytes.below(3)],
        _ => bytes.point(),
    };
    match bytes.below(3) {
        0 => GzRay { origin, direction, tmin: bytes.float(), tmax: bytes.float() },
        _ => GzRay::from_f64(origin, direction),
    }
}

fn with_batch(rays: &[GzRay], ask: impl FnOnce(&RayBatch<'_>)) {
    let (origins, directions): (Vec<_>, Vec<_>) = rays.iter().map(|ray| (ray.origin, ray.direction)).unzip();
    let (tmin, tmax): (Vec<_>, Vec<_>) = rays.iter().map(|ray| (ray.tmin, ray.tmax)).unzip();
    let (origin, direction) = (PerRay::Each(&origins[..]), PerRay::Each(&directions[..]));
    ask(&RayBatch::new(rays.len(), origin, direction, PerRay::Each(&tmin), PerRay::Each(&tmax)));
}
