//! C: rays in the plane of a triangle or nearly so.

use super::v;
use gz_core::glam::DVec3;
use gz_core::kernel::plain;
use gz_core::{GzCoord, GzRay, Hit, Kernel};
use gz_tests::hard::{Dice, meshes};
use gz_tests::judge::{buffer, settled};

#[test]
fn c01_ray_in_the_plane() {
    let alone = [v(0.0, 0.0, 0.0), v(1.0, 0.0, 0.0), v(0.0, 1.0, 0.0)];
    let rays = [
        GzRay::new(v(-1.0, 0.25, 0.0), GzCoord::X),
        GzRay::new(v(-1.0, 0.25, 0.0), v(1.0, 0.1, 0.0)),
        GzRay::new(v(0.25, 0.25, 0.0), GzCoord::X),
        GzRay::new(v(-1.0, 0.25, f32::from_bits(1)), GzCoord::X),
    ];
    assert!(settled("C1", &buffer([alone]), &rays).iter().all(|hit| !hit.is_hit()));
    // In a wall of a closed box it hits the wall that stands across.
    let mesh = meshes::block(GzCoord::ZERO, GzCoord::splat(4.0));
    let rays = [
        GzRay::new(v(1.0, 0.0, 1.5), GzCoord::X),
        GzRay::new(v(1.0, 4.0, 1.5), v(1.0, 0.0, 0.25)),
        GzRay::new(v(2.0, 2.0, 0.0), v(-1.0, -1.0, 0.0)),
        GzRay::new(v(0.0, 0.0, 1.0), GzCoord::Z),
        GzRay::new(v(-3.0, 4.0, 4.0), GzCoord::X),
    ];
    let t: Vec<f32> = settled("C1, in a box", &buffer(mesh.triangles()), &rays).iter().map(|hit| hit.t).collect();
    assert_eq!(t, [3.0, 3.0, 2.0, 3.0, 3.0]);
}

#[test]
fn c02_ray_along_a_shared_edge() {
    let pair = [[v(0.0, 0.0, 0.0), v(1.0, 0.0, 0.0), v(0.0, 1.0, 0.0)], [v(1.0, 0.0, 0.0), v(0.0, 0.0, 0.0), v(0.0, -1.0, 0.5)]];
    let across = [v(0.5, -1.0, -1.0), v(0.5, 1.0, -1.0), v(0.5, 0.0, 1.0)];
    let along = [GzRay::new(v(-1.0, 0.0, 0.0), GzCoord::X), GzRay::new(v(2.0, 0.0, 0.0), GzCoord::NEG_X)];
    assert!(settled("C2", &buffer(pair), &along).iter().all(|hit| !hit.is_hit()), "both planes hold the ray");
    let hits = settled("C2, with one across", &buffer([pair[0], pair[1], across]), &along);
    assert_eq!(hits.iter().map(|hit| (hit.tri, hit.t)).collect::<Vec<_>>(), [(2, 1.5), (2, 1.5)]);
}

#[test]
fn c03_grazing_angles() {
    // Triangles of the size 11 by 10 by 1.4 from 50 to 600 away.
    let mut dice = Dice::new(3);
    let rounded = [Kernel::MoellerTrumbore, Kernel::Pluecker, Kernel::Woop];
    let (mut beyond, mut wrong) = ([0; 3], [0; 3]);
    for angle in [1e-3f64, 1e-5, 1e-7] {
        let (mut true_hits, mut asked) = (0, 0);
        for _ in 0..120 {
            let mut corner = || dice.point(1.0) * DVec3::new(5.6, 4.85, 0.7);
            let corners = [corner(), corner(), corner()].map(|p| p.as_vec3());
            let [a, b, c] = corners.map(|p| p.as_dvec3());
            let Some(n) = (b - a).cross(c - a).try_normalize() else { continue };
            let rays: Vec<GzRay> = (0..20)
                .map(|_| {
                    let [wa, wb, wc] = dice.weights();
                    let aim = a * wa + b * wb + c * wc;
                    let [x, ..] = dice.frame();
                    let flat = (x - n * x.dot(n)).normalize();
                    let d = flat * angle.cos() + n * (angle.sin() * dice.sign());
                    GzRay::new((aim - d * f64::from(dice.between(50.0, 600.0))).as_vec3(), d.as_vec3())
                })
                .collect();
            let hits = settled("C3", &buffer([corners]), &rays);
            for (ray, hit) in rays.iter().zip(&hits) {
                asked += 1;
                true_hits += usize::from(hit.is_hit());
                let d = ray.direction.as_dvec3();
                let at = [a, b, c].map(|p| (p - ray.origin).dot(d) / d.length_squared());
                let (least, most) = (at[0].min(at[1]).min(at[2]), at[0].max(at[1]).max(at[2]));
                for (k, kernel) in rounded.into_iter().enumerate() {
                    let found = plain(kernel, ray, &corners);
                    wrong[k] += usize::from(found.is_some() != hit.is_hit());
                    // Off the triangle by more than rounding of T makes.
                    let off = found.is_some_and(|(t, ..)| f64::from(t) < least * 0.9999 || f64::from(t) > most * 1.0001);
                    beyond[k] += usize::from(off);
                }
            }
        }
        println!("C3, {angle:e} rad: {asked} rays, {true_hits} hits, 0 wrong");
        assert!(true_hits > 20 && asked > 2000, "{angle}: {true_hits} of {asked}");
    }
    println!("C3: wrong hits or misses {wrong:?}, T off the triangle {beyond:?} of {rounded:?}");
    // Woop's T is a mean of the corners' and stays among them; that of the others is anything.
    assert!(beyond[0] > 0 && beyond[1] > 0 && beyond[2] == 0 && wrong.iter().all(|&n| n > 50));
}

#[test]
fn c04_near_parallel_to_a_huge_floor() {
    let r = 1e8;
    let floor = [[v(-r, -r, 0.0), v(r, -r, 0.0), v(r, r, 0.0)], [v(-r, -r, 0.0), v(r, r, 0.0), v(-r, r, 0.0)]];
    let eye = v(0.0, 0.0, 1.0);
    let mut rays: Vec<GzRay> = (0..=80).map(|k| GzRay::new(eye, v(1.0, 0.3, -(10f32.powf(-9.0 + 0.1 * k as f32))))).collect();
    // The row of pixels at the horizon: level, and one step of f32 to either side.
    rays.extend([0.0, -0.0, f32::from_bits(1), -f32::from_bits(1), 1e-30].map(|z| GzRay::new(eye, v(1.0, 0.0, z))));
    let hits = settled("C4", &buffer(floor), &rays);
    let straight = settled("C4, at 1e7", &buffer(floor), &[GzRay::new(eye, v(1.0, 0.0, -1e-7))])[0];
    assert_eq!(straight.t, (1.0 / f64::from(1e-7f32)) as f32);
    let reach = hits.iter().filter(|hit| hit.is_hit()).count();
    // Slopes below 1e-8 leave the floor before they meet it.
    assert!((60..76).contains(&reach) && hits[81..].iter().all(|hit| !hit.is_hit()), "{reach}");
}

#[test]
fn c05_long_triangles_seen_along_their_length() {
    let mut dice = Dice::new(5);
    let triangles: Vec<[GzCoord; 3]> = (0..80)
        .map(|k| {
            let at = dice.point(0.5).with_x(0.0).as_vec3();
            let up = v(0.0, dice.between(-1e-3, 1e-3), dice.between(-1e-3, 1e-3));
            [at - GzCoord::X * 10.0, at + GzCoord::X * 10.0, at + up + GzCoord::X * (k % 3) as f32]
        })
        .collect();
    let rays: Vec<GzRay> = (0..1200)
        .map(|k| {
            let [a, b, c] = dice.pick(&triangles).map(|p| p.as_dvec3());
            let [wa, wb, wc] = dice.weights();
            let aim = a * wa + b * wb + c * wc;
            let angle = dice.magnitude(-6.0, -2.0);
            let d =
                DVec3::new(1.0, angle * (dice.unit() - 0.5), angle * (dice.unit() - 0.5)) * if k % 2 == 0 { 1.0 } else { -1.0 };
            GzRay::new((aim - d * 15.0).as_vec3(), d.as_vec3())
        })
        .collect();
    let hits = settled("C5", &buffer(triangles), &rays);
    let count = hits.iter().filter(|hit| hit.is_hit()).count();
    assert!(count > 200 && count < 1200, "{count}");
}

#[test]
fn c06_tube_seen_along_its_axis() {
    // An octagon of whole numbers, walls along z, closed by a fan at either end.
    let rim = [(4, 2), (2, 4), (-2, 4), (-4, 2), (-4, -2), (-2, -4), (2, -4), (4, -2)].map(|(x, y)| (x as f32, y as f32));
    let mut triangles = Vec::new();
    for k in 0..8 {
        let ((ax, ay), (bx, by)) = (rim[k], rim[(k + 1) % 8]);
        triangles.push([v(ax, ay, 0.0), v(bx, by, 0.0), v(bx, by, 10.0)]);
        triangles.push([v(ax, ay, 0.0), v(bx, by, 10.0), v(ax, ay, 10.0)]);
    }
    let caps = triangles.len() as u32;
    for z in [0.0, 10.0] {
        triangles
            .extend((0..8).map(|k| [v(0.0, 0.0, z), v(rim[k].0, rim[k].1, z), v(rim[(k + 1) % 8].0, rim[(k + 1) % 8].1, z)]));
    }
    let mut rays = Vec::new();
    for (x, y) in (-20..=20).flat_map(|x| (-20..=20).map(move |y| (0.25 * x as f32, 0.25 * y as f32))) {
        rays.push(GzRay::new(v(x, y, -1.0), GzCoord::Z));
        rays.push(GzRay::new(v(x, y, 5.0), GzCoord::NEG_Z));
    }
    let hits = settled("C6", &buffer(triangles), &rays);
    assert!(hits.iter().filter(|hit| hit.is_hit()).all(|hit| hit.tri >= caps && hit.t == hit.t.round()));
    // Rays in the walls, rim included, end on a cap as those inside do.
    let inside = |ray: &GzRay| {
        let (x, y) = (ray.origin.x.abs(), ray.origin.y.abs());
        x <= 4.0 && y <= 4.0 && x + y <= 6.0
    };
    assert!(rays.iter().zip(&hits).all(|(ray, hit): (&GzRay, &Hit)| hit.is_hit() == inside(ray)));
}
