//! What rays meet that go through some triangles: the tree finds it in one walk, and it is what questions one by one find.

mod common;

use common::{Lcg, glazed, grid, rays, slivers, soup};
use gz_bsp::{BspTree, MidpointTree};
use gz_core::{
    BruteForce, ClassMask, GzCoord, GzRay, Passages, PerRay, RayBatch, RayQuery, SimdLevel, TriBuffer, TriClass, TriId,
};

const GLASS: ClassMask = ClassMask::only(TriClass::Glass);

fn passages(query: &dyn RayQuery, rays: &RayBatch<'_>) -> Passages {
    let mut passages = Passages { blocked: vec![true], met: Vec::new() };
    query.passages(rays, GLASS, &mut passages);
    passages
}

/// How many rays were let through by something, how many met more than one triangle, how many were stopped.
#[derive(Debug, Default)]
struct Seen([usize; 3]);

impl Seen {
    /// Compares the tree at every level with brute force, by whose questions the expected answers are found.
    fn compare(&mut self, tris: &TriBuffer, batch: &RayBatch<'_>) {
        let expected = passages(&BruteForce::new(tris), batch);
        for &level in SimdLevel::available() {
            let found = passages(&BspTree::build(tris).with_simd(level), batch);
            assert_eq!(found.blocked, expected.blocked, "{level:?}");
            assert_eq!(found.met, expected.met, "{level:?}");
        }
        assert_eq!(passages(&MidpointTree::build(tris, gz_bsp::Midpoint::default()).unwrap(), batch), expected);
        for ray in 0..batch.len() as u32 {
            let met = expected.of(ray).len();
            assert!(met == 0 || !expected.blocked[ray as usize]);
            self.0[0] += usize::from(met > 0);
            self.0[1] += usize::from(met > 1);
        }
        self.0[2] += expected.blocked.iter().filter(|&&blocked| blocked).count();
    }
}

/// The rays as a batch with everything per ray.
fn compare_each(seen: &mut Seen, tris: &TriBuffer, rays: &[GzRay]) {
    let (origins, directions): (Vec<_>, Vec<_>) = rays.iter().map(|ray| (ray.origin, ray.direction)).unzip();
    let (tmin, tmax): (Vec<_>, Vec<_>) = rays.iter().map(|ray| (ray.tmin, ray.tmax)).unzip();
    let (origin, direction) = (PerRay::Each(&origins[..]), PerRay::Each(&directions[..]));
    seen.compare(tris, &RayBatch::new(rays.len(), origin, direction, PerRay::Each(&tmin), PerRay::Each(&tmax)));
}

#[test]
fn one_walk_finds_what_questions_one_by_one_find() {
    let (mut lcg, mut seen) = (Lcg(11), Seen::default());
    let scenes = [soup(&mut lcg, 300, 0.3), soup(&mut lcg, 3000, 0.06), grid(&mut lcg, 16), slivers(&mut lcg, 200)];
    for tris in &scenes {
        for opaque in [2, 7, usize::MAX] {
            let tris = glazed(tris, opaque);
            compare_each(&mut seen, &tris, &rays(&mut lcg, &tris, 700));
        }
    }
    println!("{seen:?}");
    assert!(seen.0[0] > 1000 && seen.0[1] > 500 && seen.0[2] > 500, "{seen:?}");
}

#[test]
fn shadow_rays_of_one_light_are_answered_together() {
    let (mut lcg, mut seen) = (Lcg(12), Seen::default());
    for (tris, opaque) in [(soup(&mut lcg, 1000, 0.1), 9), (grid(&mut lcg, 20), 5)] {
        let tris = glazed(&tris, opaque);
        let bounds = tris.bounds();
        for direction in [GzCoord::Z, GzCoord::new(0.3, -0.2, 1.0), GzCoord::new(1.0, 0.0, 0.0)] {
            let start = |k: usize| {
                let across = GzCoord::new((k % 20) as f32, (k / 20) as f32, (k % 7) as f32) / 20.0;
                (bounds.min + across * bounds.size()).as_dvec3() - direction.as_dvec3() * 0.25
            };
            let origins: Vec<_> = (0..333).map(start).collect();
            let leaves: Vec<u32> = (0..333).map(|k| k % 40).collect();
            let batch = RayBatch::unbounded(333, PerRay::Each(&origins), PerRay::One(direction));
            seen.compare(&tris, &batch);
            // Only triangles that are not hit may be promised to be left.
            let expected = passages(&BruteForce::new(&tris), &batch);
            let missed = |k: usize| expected.of(k as u32).iter().all(|(_, tri)| *tri != leaves[k]);
            let promised: Vec<u32> =
                (0..333).map(|k| if missed(k) && !expected.blocked[k] { leaves[k] } else { gz_core::NO_TRI }).collect();
            assert_eq!(passages(&BspTree::build(&tris), &batch.leaving(&promised)), expected);
        }
    }
    assert!(seen.0[0] > 300 && seen.0[1] > 100 && seen.0[2] > 100, "{seen:?}");
}

#[test]
fn walls_within_one_step_count_once_and_rays_from_afar_are_answered_too() {
    let wall = |z: f32| [[-9.0, -9.0, z], [9.0, -9.0, z], [0.0, 9.0, z]].map(GzCoord::from_array);
    // Glass from 1 to 39, some of it twice and some of it one or two steps of f32 behind another; what stops rays stands at 40.
    let mut walls = vec![wall(40.0)];
    for k in 1..40u32 {
        let z = k as f32;
        walls.extend([wall(z), wall(z), wall(z.next_up()), wall(z.next_up().next_up()), wall(z)][..=k as usize % 5].iter());
    }
    let tris = glazed(&common::buffer(walls), usize::MAX);
    let mut seen = Seen::default();
    let rays: Vec<GzRay> = [1.0f32, 0.7, 3.0, 1.3e-7]
        .iter()
        .flat_map(|&speed| {
            [0.0, -1e30, 0.5, 7.0, 38.5].map(|z| {
                let from = GzCoord::new(0.1, 0.2, z);
                GzRay {
                    tmax: if speed > 1.0 { f32::INFINITY } else { (39.5 - z) / speed },
                    ..GzRay::new(from, GzCoord::Z * speed)
                }
            })
        })
        .collect();
    compare_each(&mut seen, &tris, &rays);
    assert!(seen.0[1] >= 12 && seen.0[2] >= 4, "{seen:?}");

    let ray = GzRay { tmax: 39.5, ..GzRay::new(GzCoord::new(0.1, 0.2, 0.0), GzCoord::Z) };
    let (origin, direction) = (PerRay::One(ray.origin), PerRay::One(ray.direction));
    let found = passages(&BspTree::build(&tris), &RayBatch::new(1, origin, direction, PerRay::One(0.0), PerRay::One(39.5)));
    // One for each wall, and one more where another stands two steps behind it.
    let expected: Vec<f32> =
        (1..40).flat_map(|k| [k as f32, (k as f32).next_up().next_up()].into_iter().take(1 + usize::from(k % 5 > 2))).collect();
    let height = |&(_, tri): &(u32, TriId)| tris.position(tri)[0].z;
    assert_eq!(found.met.iter().map(height).collect::<Vec<_>>(), expected);
}
