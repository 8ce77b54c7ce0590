//! E: the range of numbers, NaN and infinities.

use super::v;
use gz_bsp::{BspTree, Midpoint, MidpointTree, VisitCount};
use gz_core::glam::DVec3;
use gz_core::kernel::plain;
use gz_core::{BruteForce, ClassMask, GzCoord, GzRay, GzTri, Hit, Kernel, RayQuery, TriBuffer, TriError};
use gz_tests::folder::Folder;
use gz_tests::hard::{Dice, meshes};
use gz_tests::judge::{buffer, settled};

/// Soup in the cube [-1, 1]^3 and rays at it, from around.
fn scene(dice: &mut Dice, triangles: usize, rays: usize) -> (Vec<[GzCoord; 3]>, Vec<GzRay>) {
    let triangles = meshes::soup(dice, triangles, 0.4);
    let rays = (0..rays)
        .map(|k| {
            let [a, b, c] = dice.pick(&triangles).map(|p| p.as_dvec3());
            let [wa, wb, wc] = [dice.weights(), [1.0, 0.0, 0.0], [0.5, 0.5, 0.0]][k % 3];
            let origin = (dice.direction() * 2.0).as_vec3();
            GzRay::new(origin, (a * wa + b * wb + c * wc - origin.as_dvec3()).as_vec3())
        })
        .collect();
    (triangles, rays)
}

#[test]
fn e01_far_from_the_origin() {
    let mut dice = Dice::new(1);
    for (offset, expected) in [(1e2f32, 150), (1e4, 150), (1e6, 100)] {
        let (triangles, rays) = scene(&mut dice, 60, 400);
        let moved = triangles.iter().map(|t| t.map(|p| p + offset));
        let rays: Vec<GzRay> = rays.iter().map(|ray| GzRay::new(ray.origin.as_vec3() + offset, ray.direction)).collect();
        let hits = settled("E1", &buffer(moved), &rays);
        assert!(hits.iter().filter(|hit| hit.is_hit()).count() > expected, "{offset}");
    }
}

#[test]
fn e02_scaling_by_powers_of_two_is_exact() {
    let mut dice = Dice::new(2);
    let (triangles, rays) = scene(&mut dice, 60, 150);
    let hits = settled("E2", &buffer(triangles.iter().copied()), &rays);
    for k in (-60..=60).step_by(12) {
        let s = 2f32.powi(k);
        let scaled = buffer(triangles.iter().map(|t| t.map(|p| p * s)));
        // Origins scale with the scene, directions stay: t scales.
        let moved: Vec<GzRay> = rays.iter().map(|ray| GzRay { origin: ray.origin * f64::from(s), ..*ray }).collect();
        for (hit, found) in hits.iter().zip(settled("E2, scaled", &scaled, &moved)) {
            assert_eq!((found.tri, found.u, found.v), (hit.tri, hit.u, hit.v), "2^{k}");
            assert_eq!(found.t, hit.t * s, "2^{k}");
        }
    }
}

#[test]
fn e03_subnormal_corners_and_t() {
    let mut dice = Dice::new(3);
    // Coordinates of a few steps of the least number: the whole scene is subnormal. With a direction of whole numbers t is so too.
    let least = f32::from_bits(1);
    let triangles: Vec<[GzCoord; 3]> = (0..40).map(|_| std::array::from_fn(|_| dice.whole_point(40) * least)).collect();
    let rays: Vec<GzRay> = (0..400)
        .map(|k| {
            let (origin, way) = (dice.whole_point(40), dice.whole_point(40));
            GzRay::new(origin * least, if k % 2 == 0 { way } else { way * least })
        })
        .collect();
    let hits = settled("E3", &buffer(triangles), &rays);
    let is_subnormal = |hit: &&Hit| hit.is_hit() && hit.t.is_subnormal();
    assert!(hits.iter().filter(|hit| hit.is_hit()).count() > 100 && hits.iter().filter(is_subnormal).count() > 20);
    // That a caller's flush-to-zero changes nothing takes setting it, which is unsafe and done beside the code that undoes it: the test
    // `flushing_is_off_inside_and_back_on_afterwards` in gz-core, src/simd/control.rs. Every query runs inside of what it tests.
    assert_eq!(gz_core::with_default_float_control(|| std::hint::black_box(f32::from_bits(3)) * 1.0), f32::from_bits(3));
}

#[test]
fn e04_corners_that_are_not_numbers() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut tris = TriBuffer::new();
        tris.push(&GzTri::default()).expect("zeros are numbers");
        let tri = GzTri { positions: [GzCoord::X, v(0.0, bad, 0.0), GzCoord::Y], ..GzTri::default() };
        assert_eq!(tris.push(&tri), Err(TriError::NotFinite(1)));
        let points = [GzCoord::X, v(bad, 0.0, 0.0), GzCoord::Y];
        assert_eq!(TriBuffer::from_indexed(&points, &[[0, 1, 2]]).unwrap_err(), TriError::NotFinite(0));
    }
    let folder = Folder::new("e04");
    for (text, line) in [("v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n", 2), ("v 0 0 0\nv 1 0 0\nv 0 1e999 0\nf 1 2 3\n", 3)] {
        let path = folder.write("bad.obj", text);
        let error = gz_app::load::obj::load(&path).unwrap_err();
        assert_eq!((error.line, error.io), (Some(line), false), "{error}");
        assert!(error.to_string().starts_with(&format!("{}:{line}: ", path.display())), "{error}");
    }
}

#[test]
fn e05_rays_that_are_not_numbers_miss_at_once() {
    let (triangles, _) = scene(&mut Dice::new(5), 300, 1);
    let tris = buffer(triangles);
    let good = GzRay::new(v(-3.0, 0.1, 0.2), GzCoord::X);
    let mut rays = vec![GzRay { direction: GzCoord::ZERO, ..good }, GzRay { direction: v(-0.0, 0.0, 0.0), ..good }];
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for axis in 0..3 {
            let (mut origin, mut direction) = (good, good);
            origin.origin[axis] = bad;
            direction.direction[axis] = bad as f32;
            rays.extend([origin, direction]);
        }
    }
    rays.extend([GzRay { tmin: f32::NAN, ..good }, GzRay { tmax: f32::NAN, ..good }]);
    rays.extend([GzRay { origin: DVec3::splat(1e-60), ..good }, GzRay { origin: DVec3::splat(1e60), ..good }]);
    assert!(settled("E5", &tris, &rays).iter().all(|hit| !hit.is_hit()));
    let tree = BspTree::build(&tris);
    let paper = MidpointTree::build(&tris, Midpoint::default()).expect("within budget");
    for ray in &rays {
        let (mut visits, mut paper_visits) = (VisitCount::default(), VisitCount::default());
        tree.closest_hit_counted(ray, ClassMask::ALL, &mut visits);
        paper.closest_hit_counted(ray, ClassMask::ALL, &mut paper_visits);
        for visits in [visits, paper_visits] {
            assert!(visits.nodes + visits.leaves <= 1 && visits.tests == 0, "{ray:?}: {visits:?}");
        }
    }
}

/// The plane z = 2, large enough.
const WALL: [GzCoord; 3] = [GzCoord::new(-9.0, -9.0, 2.0), GzCoord::new(9.0, -9.0, 2.0), GzCoord::new(0.0, 9.0, 2.0)];

#[test]
fn e06_empty_intervals() {
    let ray = GzRay::new(GzCoord::ZERO, GzCoord::Z);
    let on = GzRay::new(GzCoord::Z * 2.0, GzCoord::Z);
    let rays = [
        GzRay { tmin: 2.0, tmax: 2.0, ..ray },
        GzRay { tmin: 3.0, tmax: 1.0, ..ray },
        GzRay { tmin: f32::INFINITY, ..ray },
        GzRay { tmax: f32::NEG_INFINITY, ..ray },
        // On the triangle, t = 0 does not count from 0 on.
        on,
        GzRay { tmin: -0.0, ..on },
        GzRay { tmin: -f32::from_bits(1), ..on },
    ];
    let hits = settled("E6", &buffer([WALL]), &rays);
    assert_eq!(hits.iter().map(Hit::is_hit).collect::<Vec<_>>(), [false, false, false, false, false, false, true]);
    assert_eq!(hits[6].t.to_bits(), 0);
}

#[test]
fn e07_hit_exactly_at_tmax() {
    // Excluded, as DXR has it: a light that stands on a surface is not in the shadow of that surface.
    let ray = GzRay::new(GzCoord::ZERO, GzCoord::Z);
    let ends = [2.0f32.next_down(), 2.0, 2.0f32.next_up()];
    let hits = settled("E7", &buffer([WALL]), &ends.map(|tmax| GzRay { tmax, ..ray }));
    assert_eq!(hits.iter().map(Hit::is_hit).collect::<Vec<_>>(), [false, false, true]);
    // An exact t that f32 does not hold rounds to T: whether it lies before the end is asked of the exact one.
    let slanted = GzRay::new(GzCoord::ZERO, v(0.0, 0.0, 3.0));
    let t = 2.0f32 / 3.0;
    let hits = settled("E7, rounded", &buffer([WALL]), &[GzRay { tmax: t, ..slanted }, GzRay { tmax: t.next_up(), ..slanted }]);
    assert!(f64::from(t) > 2.0 / 3.0, "the third is rounded up");
    assert_eq!(hits.iter().map(|hit| (hit.is_hit(), hit.t)).collect::<Vec<_>>(), [(true, t), (true, t)]);
}

#[test]
fn e07_rays_that_end_or_begin_where_they_hit() {
    let mut dice = Dice::new(77);
    let (triangles, rays) = scene(&mut dice, 60, 400);
    let tris = buffer(triangles.iter().copied());
    let hits = settled("E7, whole rays", &tris, &rays);
    // T is the exact t rounded, so of the ends T and both its neighbours one lies on the other side of t than the others.
    let mut ended = Vec::new();
    for (ray, hit) in rays.iter().zip(&hits).filter(|(_, hit)| hit.is_hit()) {
        for end in [hit.t.next_down(), hit.t, hit.t.next_up()] {
            ended.push((hit, true, GzRay { tmax: end, ..*ray }));
            ended.push((hit, false, GzRay { tmin: end, ..*ray }));
        }
    }
    let alone: Vec<GzRay> = ended.iter().map(|(_, _, ray)| *ray).collect();
    let found = settled("E7, ends at hits", &tris, &alone);
    let (mut before, mut beyond) = (0, 0);
    for (k, ((whole, ends, _), hit)) in ended.iter().zip(&found).enumerate() {
        let same = hit.tri == whole.tri && hit.t.to_bits() == whole.t.to_bits();
        match (*ends, k % 6 / 2) {
            // Ends before T's lower neighbour, or begins after the upper one: the hit is left out.
            (true, 0) | (false, 2) => assert!(!same, "{whole:?}"),
            (true, 2) | (false, 0) => assert!(same, "{whole:?}: {hit:?}"),
            (true, _) => before += u32::from(same),
            (false, _) => beyond += u32::from(same),
        }
    }
    // At T itself the rounding has gone either way.
    assert!(before > 20 && beyond > 20, "{before} and {beyond} of {}", ended.len() / 6);
}

#[test]
fn e08_sixty_orders_of_magnitude_in_one_scene() {
    let triangles: Vec<[GzCoord; 3]> = (-30..=30)
        .map(|k| [[-1.0, -1.0, 1.0], [1.0, -1.0, 1.0], [0.0, 1.0, 1.0]].map(|p| GzCoord::from_array(p) * 10f32.powi(k)))
        .collect();
    let mut rays: Vec<GzRay> =
        (-30..30).map(|k| GzRay { tmin: 2.0 * 10f32.powi(k), ..GzRay::new(GzCoord::ZERO, GzCoord::Z) }).collect();
    rays.push(GzRay::new(GzCoord::ZERO, GzCoord::Z));
    rays.push(GzRay::new(v(0.1, -0.2, -5.0), v(0.01, 0.02, 1.0)));
    let hits = settled("E8", &buffer(triangles), &rays);
    for (k, hit) in (0..60).zip(&hits) {
        assert_eq!((hit.tri, hit.t), (k + 1, 10f32.powi(k as i32 - 29)));
    }
    assert_eq!((hits[60].tri, hits[60].t), (0, 10f32.powi(-30)));
}

#[test]
fn e09_directions_of_any_length() {
    let mut dice = Dice::new(9);
    let (triangles, rays) = scene(&mut dice, 60, 200);
    let tris = buffer(triangles);
    let rays: Vec<GzRay> = rays.iter().map(|ray| GzRay { direction: ray.direction.normalize(), ..*ray }).collect();
    let hits = settled("E9", &tris, &rays);
    for k in [-66, -20, 20, 66] {
        let s = 2f32.powi(k);
        let scaled: Vec<GzRay> = rays.iter().map(|ray| GzRay { direction: ray.direction * s, ..*ray }).collect();
        for (hit, found) in hits.iter().zip(settled("E9, scaled", &tris, &scaled)) {
            assert_eq!((found.tri, found.t), (hit.tri, hit.t / s), "2^{k}");
        }
    }
    // Lengths of 1e-20 and 1e20, which round: the truth is what the stored direction says.
    for s in [1e-20f32, 1e20] {
        let scaled: Vec<GzRay> = rays.iter().map(|ray| GzRay { direction: ray.direction * s, ..*ray }).collect();
        let found = settled("E9, rounded", &tris, &scaled);
        let same = hits.iter().zip(&found).filter(|(a, b)| a.tri == b.tri).count();
        assert!(same > 150, "{same}");
    }
}

#[test]
fn e10_t_at_the_end_of_the_range() {
    // A true T at the greatest number is no miss, and a T that overflows is a hit at infinity: the triangle tells.
    let far = [v(-1e3, -1e3, f32::MAX), v(1e3, -1e3, f32::MAX), v(0.0, 1e3, f32::MAX)];
    let rays = [
        GzRay::new(GzCoord::ZERO, GzCoord::Z),
        GzRay::new(GzCoord::ZERO, v(0.0, 0.0, 0.5)),
        GzRay::new(v(9e3, 0.0, 0.0), GzCoord::Z),
    ];
    let hits = settled("E10", &buffer([far]), &rays);
    assert_eq!((hits[0].tri, hits[0].t), (0, f32::MAX));
    assert_eq!((hits[1].tri, hits[1].t), (0, f32::INFINITY));
    assert_eq!((hits[2], hits[2].is_hit()), (Hit::MISS, false));
    // And with the greatest number as the end of the ray, strictly before it.
    assert!(!settled("E10, end", &buffer([far]), &[GzRay { tmax: f32::MAX, ..rays[0] }])[0].is_hit());
}

#[test]
fn e11_negative_zero_is_zero() {
    let mut dice = Dice::new(11);
    // Corners and origins on the axes' planes, with zeros of one sign and of the other.
    let triangles: Vec<[GzCoord; 3]> = (0..150).map(|_| std::array::from_fn(|_| dice.whole_point(2))).collect();
    let rays: Vec<GzRay> = (0..400).map(|_| GzRay::new(dice.whole_point(3), dice.whole_point(1))).collect();
    let negative = |p: GzCoord| GzCoord::from_array(p.to_array().map(|x| if x == 0.0 { -0.0 } else { x }));
    let hits = settled("E11", &buffer(triangles.iter().copied()), &rays);
    let minus = buffer(triangles.iter().map(|t| t.map(negative)));
    let minus_rays: Vec<GzRay> =
        rays.iter().map(|ray| GzRay::new(negative(ray.origin.as_vec3()), negative(ray.direction))).collect();
    let same = |a: &[Hit], b: &[Hit]| a.iter().zip(b).all(|(a, b)| a.t.to_bits() == b.t.to_bits() && a == b);
    assert!(same(&hits, &settled("E11, triangles", &minus, &rays)));
    assert!(same(&hits, &settled("E11, rays", &buffer(triangles), &minus_rays)));
    assert!(same(&hits, &settled("E11, both", &minus, &minus_rays)));
    assert!(hits.iter().filter(|hit| hit.is_hit()).count() > 100);
    // Where everything is on one plane through the origin, a sign bit is all that differs.
    assert_eq!(BruteForce::new(&minus).closest_hit(&rays[0]), hits[0]);
    assert!(plain(Kernel::Plane, &GzRay::new(GzCoord::ZERO, -GzCoord::Z), &WALL).is_none());
}
