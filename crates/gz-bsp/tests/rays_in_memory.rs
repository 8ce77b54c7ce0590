//! Rays of f32 taken as they lie in memory: they are answered as the same rays told property by property.

mod common;

use common::{Lcg, glazed, grid, rays, slivers, soup};
use gz_bsp::{BspTree, Midpoint, MidpointTree};
use gz_core::{
    Attributes, BruteForce, ClassMask, GzCoord, GzRay, GzRay32, GzTri, Hit, NO_TRI, Passages, PerRay, RayBatch, RayQuery,
    SimdLevel, TriBuffer, TriClass, TriId,
};

/// The answers to all three questions.
#[derive(Debug, PartialEq)]
struct Answers(Vec<Hit>, Vec<bool>, Passages);

fn ask(query: &dyn RayQuery, batch: &RayBatch<'_>) -> Answers {
    let (mut hits, mut occluded) = (vec![Hit::MISS; batch.len()], vec![false; batch.len()]);
    query.closest_hits(batch, ClassMask::ALL, &mut hits);
    query.any_hits(batch, ClassMask::ALL, &mut occluded);
    let mut passages = Passages::default();
    query.passages(batch, ClassMask::only(TriClass::Glass), &mut passages);
    Answers(hits, occluded, passages)
}

/// The rays as brute force is told them, each property for each ray; then as they lie in memory, by all trees at all levels. Returns how many
/// hit something.
fn compare(tris: &TriBuffer, rays: &[GzRay32], leaves: Option<&[TriId]>) -> usize {
    let (origins, directions): (Vec<_>, Vec<_>) = rays.iter().map(|ray| (ray.origin.as_dvec3(), ray.direction)).unzip();
    let (tmin, tmax): (Vec<_>, Vec<_>) = rays.iter().map(|ray| (ray.tmin, ray.tmax)).unzip();
    let (origin, direction) = (PerRay::Each(&origins[..]), PerRay::Each(&directions[..]));
    let told = RayBatch::new(rays.len(), origin, direction, PerRay::Each(&tmin), PerRay::Each(&tmax));
    let brute = BruteForce::new(tris);
    let expected = ask(&brute, &told);

    let mut batch = RayBatch::of_rays(rays);
    if let Some(leaves) = leaves {
        batch = batch.leaving(leaves);
    }
    assert_eq!(ask(&brute, &batch), expected);
    assert_eq!(ask(&MidpointTree::build(tris, Midpoint::default()).unwrap(), &batch), expected);
    for &level in SimdLevel::available() {
        assert_eq!(ask(&BspTree::build(tris).with_simd(level), &batch), expected, "{level:?}");
    }
    expected.0.iter().filter(|hit| hit.is_hit()).count()
}

fn narrow(ray: &GzRay) -> GzRay32 {
    GzRay32 { origin: ray.origin.as_vec3(), tmin: ray.tmin, direction: ray.direction, tmax: ray.tmax }
}

#[test]
fn they_are_answered_as_when_told_property_by_property() {
    let (mut lcg, mut hits) = (Lcg(21), 0);
    for tris in [soup(&mut lcg, 300, 0.3), soup(&mut lcg, 3000, 0.06), grid(&mut lcg, 16), slivers(&mut lcg, 200)] {
        let tris = glazed(&tris, 2);
        let all: Vec<GzRay32> = rays(&mut lcg, &tris, 700).iter().map(narrow).collect();
        hits += compare(&tris, &all, None);
        // Bundles and packets that are not whole.
        for len in [0, 1, 7, 15, 16, 17, 63, 65, 130] {
            compare(&tris, &all[..len], None);
        }
    }
    assert!(hits > 300, "{hits}");
}

#[test]
fn what_they_share_is_seen() {
    let (mut lcg, mut hits) = (Lcg(22), 0);
    let tris = glazed(&soup(&mut lcg, 2000, 0.08), 2);
    let all: Vec<GzRay32> = rays(&mut lcg, &tris, 400).iter().map(narrow).collect();
    let (eye, light) = (GzCoord::new(0.4, -3.0, 0.6), GzCoord::new(0.2, 1.0, -0.1));
    let bounds = tris.bounds();
    let towards = |k: usize| {
        let across = GzCoord::new((k % 20) as f32, (k / 20) as f32, (k % 7) as f32) / 20.0;
        bounds.min + across * bounds.size()
    };
    let unbounded = |origin, direction| GzRay32 { origin, tmin: 0.0, direction, tmax: f32::INFINITY };
    let from_eye: Vec<GzRay32> = (0..400).map(|k| unbounded(eye, towards(k) - eye)).collect();
    let to_light: Vec<GzRay32> = (0..400).map(|k| unbounded(towards(k) - light * 0.5, light)).collect();
    for shared in [&from_eye, &to_light] {
        hits += compare(&tris, shared, None);
        // In some bundles only, and in all of a bundle but for one ray, the first or the last or one that cannot hit.
        let mixed: Vec<GzRay32> = (0..400).map(|k| if k / 64 % 2 == 0 { shared[k] } else { all[k] }).collect();
        compare(&tris, &mixed, None);
        for other in [0, 63, 100] {
            let mut but_one = shared.clone();
            but_one[other] = all[other];
            but_one[150].direction = GzCoord::ZERO;
            but_one[200].origin.x = f32::NAN;
            but_one[399].tmax = f32::NAN;
            compare(&tris, &but_one, None);
        }
    }
    // Zeros of both signs are one place, and nothing else.
    let zeros: Vec<GzRay32> = (0..64)
        .map(|k| unbounded(GzCoord::new(if k % 2 == 0 { 0.0 } else { -0.0 }, -1.0, 0.5), towards(k * 6) - GzCoord::NEG_Y))
        .collect();
    compare(&tris, &zeros, None);
    assert!(hits > 200, "{hits}");
}

#[test]
fn coordinates_of_all_sizes_keep_their_bits() {
    // A space whose axes are stretched, and origins that are tiny, huge, infinite, zero.
    let mut lcg = Lcg(23);
    let flat = soup(&mut lcg, 500, 0.1);
    let mut tris = TriBuffer::with_attributes(Attributes::ALL, flat.len());
    for tri in flat.positions() {
        let positions = tri.map(|p| p * GzCoord::new(1.0, 1e-7, 30.0));
        tris.push(&GzTri { positions, ..GzTri::default() }).unwrap();
    }
    let all: Vec<GzRay32> = rays(&mut lcg, &tris, 300).iter().map(narrow).collect();
    let mut hits = compare(&tris, &all, None);
    let odd = [1e-45f32, 1e-40, f32::MIN_POSITIVE, -0.0, 0.0, 1e-20, 1e20, f32::MAX, f32::INFINITY, f32::NAN];
    let mut strange = all.clone();
    for (k, ray) in strange.iter_mut().enumerate().filter(|(k, _)| k % 3 == 0) {
        ray.origin[k / 3 % 3] = odd[k % odd.len()];
        if k % 2 == 0 {
            ray.direction[k % 3] *= odd[k / 3 % 7];
        }
    }
    hits += compare(&tris, &strange, None);
    // From the eye of a needle: one tiny origin for all.
    let tiny: Vec<GzRay32> = all.iter().map(|ray| GzRay32 { origin: GzCoord::new(1e-42, -1e-38, 1e-45), ..*ray }).collect();
    hits += compare(&tris, &tiny, None);
    assert!(hits > 30, "{hits}");
}

#[test]
fn they_may_leave_triangles() {
    let mut lcg = Lcg(24);
    let tris = glazed(&grid(&mut lcg, 20), 2);
    let all: Vec<GzRay32> = rays(&mut lcg, &tris, 500).iter().map(narrow).collect();
    // Only triangles that are not hit may be promised.
    let brute = BruteForce::new(&tris);
    let leaves: Vec<TriId> = (0..)
        .zip(&all)
        .map(|(k, ray)| {
            let left = k % tris.len() as TriId;
            let alone = TriBuffer::from_indexed(tris.position(left), &[[0, 1, 2]]).unwrap();
            if BruteForce::new(&alone).any_hit(&(*ray).into()) { NO_TRI } else { left }
        })
        .collect();
    assert!(leaves.iter().filter(|&&left| left != NO_TRI).count() > 400);
    assert!(all.iter().any(|ray| brute.any_hit(&(*ray).into())));
    compare(&tris, &all, Some(&leaves));
}
