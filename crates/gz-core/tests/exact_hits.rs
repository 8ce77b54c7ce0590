//! Hits against integer arithmetic and against hand-made cases, at every SIMD level.

use gz_core::glam::DVec3;
use gz_core::{BruteForce, ClassMask, GzCoord, GzRay, Hit, PerRay, RayBatch, RayQuery, SimdLevel, TriBuffer};

/// A small generator; the seed is in the test, so a failure repeats.
struct Lcg(u64);

impl Lcg {
    fn below(&mut self, n: u64) -> i64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) % n) as i64
    }

    fn within(&mut self, n: i64) -> i64 {
        self.below(2 * n as u64 + 1) - n
    }

    fn point(&mut self, n: i64) -> [i64; 3] {
        std::array::from_fn(|_| self.within(n))
    }

    fn unit(&mut self) -> f32 {
        self.below(1 << 24) as f32 / (1 << 24) as f32
    }
}

fn coord(p: [i64; 3]) -> GzCoord {
    GzCoord::from_array(p.map(|x| x as f32))
}

/// The truth on integers: t as a fraction and the triangle, by the definition and nothing else. (m, d, V, W, triangle), d > 0.
fn integer_truth(o: [i64; 3], d: [i64; 3], triangles: &[[[i64; 3]; 3]]) -> Option<(i128, i128, i128, i128, usize)> {
    let cross = |a: [i128; 3], b: [i128; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let dot = |a: [i128; 3], b: [i128; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let mut best: Option<(i128, i128, i128, i128, usize)> = None;
    for (id, triangle) in triangles.iter().enumerate() {
        let [a, b, c] = triangle.map(|p| [0, 1, 2].map(|k| i128::from(p[k] - o[k])));
        let d = d.map(i128::from);
        let (u, v, w) = (dot(d, cross(b, c)), dot(d, cross(c, a)), dot(d, cross(a, b)));
        let (sum, m) = (u + v + w, dot(a, cross(b, c)));
        let s = sum.signum();
        if s == 0 || u * s < 0 || v * s < 0 || w * s < 0 || m * s <= 0 {
            continue;
        }
        let (m, sum) = (m * s, sum * s);
        if best.is_none_or(|(bm, bd, ..)| m * bd < bm * sum) {
            best = Some((m, sum, v * s, w * s, id));
        }
    }
    best
}

#[test]
fn integer_grids_full_of_ties_are_answered_as_integers_answer() {
    let mut lcg = Lcg(7);
    let (mut rays, mut hits) = (0u32, 0u32);
    for scene in 0..60 {
        let range = [2, 3, 5, 20][scene % 4];
        let mut triangles: Vec<[[i64; 3]; 3]> = (0..40).map(|_| [lcg.point(range), lcg.point(range), lcg.point(range)]).collect();
        // Duplicates and reversed copies.
        triangles.extend_from_within(0..5);
        triangles.push([triangles[3][2], triangles[3][1], triangles[3][0]]);
        let mut tris = TriBuffer::new();
        for t in &triangles {
            tris.push(&gz_core::GzTri { positions: t.map(coord), ..Default::default() }).unwrap();
        }
        let brutes: Vec<_> = SimdLevel::available().iter().map(|&level| BruteForce::new(&tris).with_simd(level)).collect();
        for _ in 0..400 {
            let o = lcg.point(range + 2);
            // Aimed at a vertex, a midpoint of an edge (twice over) or anywhere.
            let t = triangles[lcg.below(triangles.len() as u64) as usize];
            let target = match lcg.below(3) {
                0 => t[0],
                1 => [0, 1, 2].map(|k| t[0][k] + t[1][k] - o[k]),
                _ => lcg.point(range),
            };
            let d = [0, 1, 2].map(|k| target[k] - o[k]);
            if d == [0; 3] {
                continue;
            }
            let ray = GzRay::new(coord(o), coord(d));
            let expected = integer_truth(o, d, &triangles).map_or(Hit::MISS, |(m, d, v, w, tri)| Hit {
                // Numerators and denominators are far below 2^53 and the quotients of such small integers are never within 2^-53
                // of a rounding boundary without being on it.
                t: (m as f64 / d as f64) as f32,
                tri: tri as u32,
                u: (v as f64 / d as f64) as f32,
                v: (w as f64 / d as f64) as f32,
            });
            for brute in &brutes {
                let hit = brute.closest_hit(&ray);
                assert_eq!((hit.tri, hit.t), (expected.tri, expected.t), "{ray:?} {triangles:?}");
                assert!((hit.u - expected.u).abs() <= f32::EPSILON && (hit.v - expected.v).abs() <= f32::EPSILON);
                assert_eq!(brute.any_hit(&ray), expected.is_hit());
            }
            rays += 1;
            hits += u32::from(expected.is_hit());
        }
    }
    println!("{rays} rays, {hits} hits, 0 differ");
    assert!(rays > 20_000 && hits > 8_000, "{rays} rays, {hits} hits");
}

#[test]
fn t_is_the_exact_one_where_f64_is_not_enough() {
    // f64 gives 2.99992 by N.A / N.d; exactly it is 3.
    let corners = [
        [-4_181_166.0, -2_325_873.0, 2_636_640.0],
        [-3_520_566.0, -2_287_287.0, 2_458_607.0],
        [-3_158_845.0, -1_460_238.0, 1_776_593.0],
    ]
    .map(GzCoord::from_array);
    let tris = TriBuffer::from_indexed(&corners, &[[0, 1, 2], [2, 1, 0], [1, 2, 0]]).unwrap();
    let ray = GzRay::new(GzCoord::ZERO, GzCoord::new(-1_393_722.0, -775_291.0, 878_880.0));
    let hit = BruteForce::new(&tris).closest_hit(&ray);
    assert_eq!((hit.t, hit.tri), (3.0, 0));
}

#[test]
fn scaling_by_powers_of_two_scales_t_and_changes_nothing_else() {
    let mut lcg = Lcg(11);
    for _ in 0..300 {
        let corners: [GzCoord; 3] = std::array::from_fn(|_| GzCoord::from_array(std::array::from_fn(|_| lcg.unit() - 0.5)));
        let [a, b, c] = corners;
        let ray = GzRay::new(GzCoord::new(0.3, -2.0, 0.1), (a * 0.25 + b * 0.25 + c * 0.5) - GzCoord::new(0.3, -2.0, 0.1));
        let plain = hit_of(&corners, &ray);
        assert!(plain.is_hit());
        for k in (-95..=110).step_by(5) {
            let s = 2f32.powi(k);
            let scaled = corners.map(|p| p * s);
            // Scaling a small coordinate far down may lose bits: then it is another scene.
            if scaled.iter().zip(&corners).any(|(x, y)| *x / s != *y) {
                continue;
            }
            let moved = GzRay { origin: ray.origin * f64::from(s), ..ray };
            let hit = hit_of(&scaled, &moved);
            assert_eq!((hit.tri, hit.u, hit.v), (plain.tri, plain.u, plain.v), "2^{k}");
            assert_eq!(hit.t, plain.t * s, "2^{k}");
        }
    }
}

fn hit_of(corners: &[GzCoord; 3], ray: &GzRay) -> Hit {
    let tris = TriBuffer::from_indexed(corners, &[[0, 1, 2]]).unwrap();
    let hits: Vec<Hit> =
        SimdLevel::available().iter().map(|&level| BruteForce::new(&tris).with_simd(level).closest_hit(ray)).collect();
    assert!(hits.iter().all(|h| h == &hits[0]), "{hits:?}");
    hits[0]
}

const WALL: [GzCoord; 3] = [GzCoord::new(-9.0, -9.0, 2.0), GzCoord::new(9.0, -9.0, 2.0), GzCoord::new(0.0, 9.0, 2.0)];

#[test]
fn both_ends_of_the_interval_are_strict() {
    let ray = GzRay::new(GzCoord::ZERO, GzCoord::Z);
    assert_eq!(hit_of(&WALL, &ray).t, 2.0);
    assert!(!hit_of(&WALL, &GzRay { tmax: 2.0, ..ray }).is_hit());
    assert!(hit_of(&WALL, &GzRay { tmax: 2f32.next_up(), ..ray }).is_hit());
    assert!(!hit_of(&WALL, &GzRay { tmin: 2.0, ..ray }).is_hit());
    assert!(hit_of(&WALL, &GzRay { tmin: 2f32.next_down(), ..ray }).is_hit());
    // An origin on the triangle does not hit it at t = 0; a negative tmin does.
    let on = GzRay { origin: DVec3::Z * 2.0, ..ray };
    assert!(!hit_of(&WALL, &on).is_hit());
    assert_eq!(hit_of(&WALL, &GzRay { tmin: -f32::from_bits(1), ..on }).t, 0.0);
    assert_eq!(hit_of(&WALL, &GzRay { origin: DVec3::Z * 5.0, tmin: f32::NEG_INFINITY, ..ray }).t, -3.0);
}

#[test]
fn what_cannot_be_hit_is_missed() {
    let ray = GzRay::new(GzCoord::ZERO, GzCoord::Z);
    for bad in [
        GzRay { direction: GzCoord::ZERO, ..ray },
        GzRay { direction: GzCoord::NAN, ..ray },
        GzRay { origin: DVec3::splat(f64::INFINITY), ..ray },
        GzRay { tmin: 3.0, tmax: 1.0, ..ray },
        GzRay { origin: DVec3::splat(1e-60), ..ray },
    ] {
        assert!(!hit_of(&WALL, &bad).is_hit(), "{bad:?}");
    }
    // No area: one point, two points, collinear.
    for flat in
        [[GzCoord::Z; 3], [GzCoord::Z, GzCoord::Z, GzCoord::ONE], [GzCoord::ZERO, GzCoord::splat(1.0), GzCoord::splat(2.0)]]
    {
        assert!(!hit_of(&flat, &GzRay::new(GzCoord::splat(-1.0), GzCoord::ONE)).is_hit());
        assert!(!hit_of(&flat, &ray).is_hit());
    }
    // In the plane.
    assert!(!hit_of(&WALL, &GzRay::new(GzCoord::new(-20.0, 0.0, 2.0), GzCoord::X)).is_hit());
}

#[test]
fn coordinates_beyond_the_filter_and_subnormal_ones_are_answered() {
    for scale in [1e-44f32, 1e-38, 1e-20, 1e18, 1e30, 1e38] {
        let tiny = [[-1.0, -1.0, 1.0], [1.0, -1.0, 1.0], [0.0, 1.0, 1.0]].map(|p| GzCoord::from_array(p) * scale);
        let hit = hit_of(&tiny, &GzRay::new(GzCoord::ZERO, GzCoord::Z));
        assert_eq!(hit.t, tiny[0].z, "{scale}");
        // And far to the side it is missed.
        assert!(!hit_of(&tiny, &GzRay::new(GzCoord::ZERO, GzCoord::new(1.0, 0.0, 0.1))).is_hit());
    }
}

#[test]
fn a_batch_answers_like_its_rays_one_by_one_and_sees_only_its_classes() {
    let mut lcg = Lcg(5);
    let mut tris = TriBuffer::with_attributes(gz_core::Attributes { classes: true, ..Default::default() }, 0);
    for k in 0..300 {
        let centre = GzCoord::from_array(std::array::from_fn(|_| lcg.unit()));
        let positions = std::array::from_fn(|_| centre + GzCoord::from_array(std::array::from_fn(|_| 0.2 * lcg.unit())));
        let class = if k % 3 == 0 { gz_core::TriClass::Glass } else { gz_core::TriClass::Opaque };
        tris.push(&gz_core::GzTri { positions, class, ..Default::default() }).unwrap();
    }
    let brute = BruteForce::new(&tris);
    let origin = DVec3::new(-0.2, -0.1, -0.3);
    let directions: Vec<GzCoord> =
        (0..500).map(|_| GzCoord::from_array(std::array::from_fn(|_| lcg.unit())) - origin.as_vec3()).collect();
    let rays = RayBatch::unbounded(directions.len(), PerRay::One(origin), PerRay::Each(&directions));
    let mut all = vec![Hit::MISS; rays.len()];
    brute.closest_hits(&rays, ClassMask::ALL, &mut all);
    let mut seen = [0, 0];
    for class in [gz_core::TriClass::Opaque, gz_core::TriClass::Glass] {
        let (mut hits, mut occluded) = (vec![Hit::MISS; rays.len()], vec![false; rays.len()]);
        brute.closest_hits(&rays, ClassMask::only(class), &mut hits);
        brute.any_hits(&rays, ClassMask::only(class), &mut occluded);
        for (i, hit) in hits.iter().enumerate() {
            assert_eq!(brute.closest_hit(&rays.ray(i)), all[i]);
            assert_eq!(hit.is_hit(), occluded[i]);
            if hit.is_hit() {
                assert_eq!(tris.class(hit.tri), class);
                assert!(hit.t >= all[i].t);
                seen[class as usize] += 1;
            }
            if all[i].is_hit() && tris.class(all[i].tri) == class {
                assert_eq!(*hit, all[i]);
            }
        }
    }
    assert!(seen[0] > 100 && seen[1] > 50, "{seen:?}");
}

#[test]
fn the_paper_kernel_agrees_away_from_edges_and_grazing_angles() {
    let mut lcg = Lcg(3);
    let mut compared = 0;
    for _ in 0..4000 {
        let corners: [GzCoord; 3] = std::array::from_fn(|_| GzCoord::from_array(std::array::from_fn(|_| 4.0 * lcg.unit() - 2.0)));
        let tris = TriBuffer::from_indexed(&corners, &[[0, 1, 2]]).unwrap();
        let o = GzCoord::new(5.0 * lcg.unit(), -6.0, 3.0 * lcg.unit());
        let target = corners[0] * lcg.unit() + corners[1] * lcg.unit() + corners[2] * lcg.unit();
        let ray = GzRay::new(o, (target - o).normalize());
        let exact = BruteForce::new(&tris).closest_hit(&ray);
        let w = gz_core::kernel::hit_weights(&ray, &corners);
        let steep = tris.face_normal(0).dot(ray.direction.as_dvec3()).abs() > 1e-3;
        if !(exact.is_hit() && steep && w.iter().all(|&w| w > 1e-4)) {
            continue;
        }
        let plain = BruteForce::with_kernel(&tris, gz_core::Kernel::Plane).closest_hit(&ray);
        assert_eq!(plain.tri, exact.tri);
        // t of the plain kernel errs with the inverse of the angle, down to 1e-3 here.
        assert!((plain.t - exact.t).abs() < 2e-2 && (plain.u - exact.u).abs() < 0.2, "{plain:?} {exact:?}");
        compared += 1;
    }
    assert!(compared > 800, "{compared}");
}
