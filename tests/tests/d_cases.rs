//! The hard cases of BSP and kd trees, D1 to D21, one test each: what brute force and both trees answer is the independent truth.

#[path = "d_cases/bounds.rs"]
mod bounds;
#[path = "d_cases/builds.rs"]
mod builds;
#[path = "d_cases/planes.rs"]
mod planes;

use gz_bsp::{Midpoint, MidpointTree};
use gz_core::{GzCoord, GzRay, Hit, RayQuery, TriBuffer};
use gz_tests::judge::{buffer, settled};

fn v(x: f32, y: f32, z: f32) -> GzCoord {
    GzCoord::new(x, y, z)
}

/// Axis `k` of the answer is `a`, the next ones `b` and `c`.
fn turned(k: usize, a: f32, b: f32, c: f32) -> GzCoord {
    let mut p = GzCoord::ZERO;
    p[k] = a;
    p[(k + 1) % 3] = b;
    p[(k + 2) % 3] = c;
    p
}

/// Settings of the paper's tree that cut early, late, to the bottom and hardly at all.
const SETTINGS: [(u32, usize); 7] = [(1, 0), (2, 1), (3, 0), (4, 1), (8, 1), (12, 2), (15, 5)];

/// Settles the rays with everyone against the independent truth, and asks the paper's tree at more settings besides; returns the hits.
fn agree(name: &str, tris: &TriBuffer, rays: &[GzRay]) -> Vec<Hit> {
    let truth = settled(name, tris, rays);
    let mut compared = 0;
    for (max_depth, min_size) in SETTINGS {
        let tree = MidpointTree::build(tris, Midpoint { max_depth, min_size, ..Midpoint::default() }).expect("within budget");
        if max_depth <= 8 {
            tree.assert_well_formed();
        }
        for (ray, truth) in rays.iter().zip(&truth) {
            assert_eq!(tree.closest_hit(ray), *truth, "{name}, ({max_depth}, {min_size}): {ray:?}");
            assert_eq!(tree.any_hit(ray), truth.is_hit(), "{name}, ({max_depth}, {min_size}), any: {ray:?}");
            compared += 1;
        }
    }
    println!(
        "{name}: {} rays, {compared} answers more, 0 differ, {} hits",
        rays.len(),
        truth.iter().filter(|hit| hit.is_hit()).count()
    );
    truth
}

/// Whether some rays of a case hit and, with `misses`, some do not: a case in which nothing happens shows nothing.
fn both_happen(hits: &[Hit], misses: bool) {
    assert!(hits.iter().any(Hit::is_hit), "no ray hits");
    assert!(!misses || hits.iter().any(|hit| !hit.is_hit()), "every ray hits");
}

/// Two triangles for each square of a 6 by 6 grid on every face of the box [0, 12]^3, so that planes of cuts fall on edges.
fn shell() -> Vec<[GzCoord; 3]> {
    let mut triangles = Vec::new();
    for k in 0..3 {
        for side in [0.0, 12.0] {
            for (i, j) in (0..6).flat_map(|i| (0..6).map(move |j| (2.0 * i as f32, 2.0 * j as f32))) {
                let at = |b: f32, c: f32| turned(k, side, i + b, j + c);
                triangles.push([at(0.0, 0.0), at(2.0, 0.0), at(0.0, 2.0)]);
                triangles.push([at(2.0, 2.0), at(0.0, 2.0), at(2.0, 0.0)]);
            }
        }
    }
    triangles
}

/// The shell with slanted triangles inside.
fn cube() -> Vec<[GzCoord; 3]> {
    let slanted = |k: usize, x: f32| [turned(k, x, 1.0, 2.0), turned(k, x + 1.0, 11.0, 3.0), turned(k, x - 0.5, 5.0, 10.0)];
    let inside = (0..3).flat_map(|k| (0..5).map(move |i| slanted(k, 1.0 + 2.5 * i as f32)));
    shell().into_iter().chain(inside).collect()
}

/// Numbers in [0, 1) from a seed.
struct Lcg(u64);

impl Lcg {
    fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1u64 << 24) as f32
    }

    fn point(&mut self) -> GzCoord {
        GzCoord::from_array(std::array::from_fn(|_| self.unit()))
    }

    /// Small triangles anywhere in the unit cube.
    fn soup(&mut self, n: usize, size: f32) -> Vec<[GzCoord; 3]> {
        (0..n)
            .map(|_| {
                let centre = self.point();
                std::array::from_fn(|_| centre + (self.point() - 0.5) * size)
            })
            .collect()
    }

    /// Rays around and in a box, at corners and anywhere.
    fn rays(&mut self, tris: &TriBuffer, n: usize) -> Vec<GzRay> {
        let bounds = tris.bounds();
        (0..n)
            .map(|k| {
                let origin = bounds.centre() + (self.point() - 0.5) * bounds.size() * 2.5;
                let aim = match tris.len() {
                    0 => self.point(),
                    len => tris.position((self.unit() * len as f32) as u32 % len as u32)[k % 3],
                };
                GzRay::new(origin, if k % 3 == 0 { self.point() - 0.5 } else { aim - origin })
            })
            .collect()
    }
}
