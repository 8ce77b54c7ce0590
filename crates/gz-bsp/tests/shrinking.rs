//! Brute force and both trees on inputs that look for trouble; a failure is shrunk to its core and its seed kept.

use gz_bsp::{BspTree, Midpoint, MidpointTree};
use gz_core::{BruteForce, ClassMask, GzCoord, GzRay, GzTri, Hit, PerRay, RayBatch, RayQuery, TriBuffer};
use proptest::prelude::*;

/// Numbers that meet each other: small integers, tenths, neighbours of both, powers of two, zeros of both signs, subnormal ones.
fn number() -> impl Strategy<Value = f32> {
    prop_oneof![
        4 => (-4i8..=4).prop_map(f32::from),
        3 => (-40i8..=40).prop_map(|k| f32::from(k) / 10.0),
        2 => (-4i8..=4).prop_map(|k| f32::from(k).next_up()),
        1 => (-20i32..=20).prop_map(|k| 2f32.powi(k)),
        1 => prop_oneof![Just(0.0), Just(-0.0), Just(1e-40), Just(-1e-45)],
        1 => (-1e6f32..1e6).prop_map(|x| x),
    ]
}

fn point() -> impl Strategy<Value = GzCoord> {
    [number(), number(), number()].prop_map(GzCoord::from_array)
}

/// Triangles over few points, so that they share corners and edges, repeat, lie in one plane and lose their area.
fn triangles() -> impl Strategy<Value = Vec<[GzCoord; 3]>> {
    (prop::collection::vec(point(), 3..12), prop::collection::vec([any::<u8>(), any::<u8>(), any::<u8>()], 1..60))
        .prop_map(|(points, picks)| picks.iter().map(|pick| pick.map(|k| points[usize::from(k) % points.len()])).collect())
}

#[derive(Clone, Debug)]
struct Shot {
    origin: GzCoord,
    aim: GzCoord,
    /// Which triangle to aim at and how much of `aim` to keep: corners, edges, and anything.
    target: u8,
    mix: u8,
    tmin: f32,
    tmax: f32,
}

fn shots() -> impl Strategy<Value = Vec<Shot>> {
    let ends = prop_oneof![4 => Just((0.0, f32::INFINITY)), 1 => (number(), number()), 1 => Just((f32::NEG_INFINITY, 1.0))];
    let shot = (point(), point(), any::<u8>(), any::<u8>(), ends).prop_map(|(origin, aim, target, mix, (tmin, tmax))| Shot {
        origin,
        aim,
        target,
        mix,
        tmin,
        tmax,
    });
    prop::collection::vec(shot, 1..40)
}

fn ray(shot: &Shot, triangles: &[[GzCoord; 3]]) -> GzRay {
    let [a, b, c] = triangles[usize::from(shot.target) % triangles.len()];
    let direction = match shot.mix % 6 {
        0 => a - shot.origin,
        1 => (a + b) * 0.5 - shot.origin,
        2 => (a + b + c) / 3.0 - shot.origin,
        3 => GzCoord::AXES[usize::from(shot.target) % 3],
        4 => b - a,
        _ => shot.aim,
    };
    GzRay { tmin: shot.tmin, tmax: shot.tmax, ..GzRay::new(shot.origin, direction) }
}

proptest! {
    #[test]
    fn all_queries_give_one_answer(
        triangles in triangles(),
        shots in shots(),
        max_depth in 1u32..12,
        min_size in 0usize..12,
    ) {
        let mut tris = TriBuffer::new();
        for &positions in &triangles {
            tris.push(&GzTri { positions, ..GzTri::default() }).unwrap();
        }
        let rays: Vec<GzRay> = shots.iter().map(|shot| ray(shot, &triangles)).collect();
        let brute = BruteForce::new(&tris);
        let tree = BspTree::build(&tris);
        tree.assert_well_formed();
        let midpoint = MidpointTree::build(&tris, Midpoint { max_depth, min_size, node_budget: 1 << 13 });
        if let Ok(midpoint) = &midpoint {
            midpoint.assert_well_formed();
        }
        let (origins, directions): (Vec<_>, Vec<_>) = rays.iter().map(|ray| (ray.origin, ray.direction)).unzip();
        let (tmin, tmax): (Vec<_>, Vec<_>) = rays.iter().map(|ray| (ray.tmin, ray.tmax)).unzip();
        let each = (PerRay::Each(&origins[..]), PerRay::Each(&directions[..]), PerRay::Each(&tmin[..]), PerRay::Each(&tmax[..]));
        let batch = RayBatch::new(rays.len(), each.0, each.1, each.2, each.3);
        let mut together = vec![Hit::MISS; rays.len()];
        tree.closest_hits(&batch, ClassMask::ALL, &mut together);
        for (ray, together) in rays.iter().zip(&together) {
            let expected = brute.closest_hit(ray);
            prop_assert_eq!(tree.closest_hit(ray), expected);
            prop_assert_eq!(*together, expected);
            prop_assert_eq!(tree.any_hit(ray), expected.is_hit());
            prop_assert_eq!(brute.any_hit(ray), expected.is_hit());
            if let Ok(midpoint) = &midpoint {
                prop_assert_eq!(midpoint.closest_hit(ray), expected);
                prop_assert_eq!(midpoint.any_hit(ray), expected.is_hit());
            }
        }
    }
}
