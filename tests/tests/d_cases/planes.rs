//! D1 to D11: rays, triangles and origins in and at the planes of cuts.

use super::{agree, both_happen, buffer, cube, shell, turned, v};
use gz_core::{GzCoord, GzRay};

/// Planes of the first four cuts of [0, 12] along any axis.
const PLANES: [f32; 8] = [6.0, 3.0, 9.0, 1.5, 4.5, 0.75, 12.0, 0.0];

#[test]
fn d01_ray_in_a_split_plane() {
    let mut rays = vec![GzRay::new(v(6.0, 1.0, -1.0), v(0.0, 0.3, 1.0)), GzRay::new(v(6.0, 1.0, -1.0), v(-0.0, 0.3, 1.0))];
    for k in 0..3 {
        for plane in PLANES {
            for zero in [0.0, -0.0] {
                for (b, c) in [(0.3, 1.0), (1.0, -0.7), (0.0, 1.0), (1.0, -0.0), (-1.0, -1.0)] {
                    let start = |x: f32| if x > 0.0 { -1.0 } else { 13.0 };
                    rays.push(GzRay::new(turned(k, plane, start(b) + 0.5, start(c)), turned(k, zero, b, c)));
                }
            }
        }
    }
    both_happen(&agree("D1", &buffer(cube()), &rays), true);
}

#[test]
fn d02_ray_in_the_plane_with_triangles_on_both_sides() {
    let mut triangles = cube();
    // Triangles that end at, just before, just beyond the plane x = 6 and its counterparts, and some across it.
    for k in 0..3 {
        for (i, end) in [6.0f32, 6.0f32.next_down(), 6.0f32.next_up(), 6.5, 5.5].into_iter().enumerate() {
            let at = 2.0 + 1.5 * i as f32;
            triangles.push([turned(k, 5.0, 1.0, at), turned(k, end, 9.0, at), turned(k, 5.0, 9.0, at)]);
            triangles.push([turned(k, 7.0, 1.0, at + 0.5), turned(k, end, 9.0, at + 0.5), turned(k, 7.0, 9.0, at + 0.5)]);
        }
    }
    let mut rays = Vec::new();
    for k in 0..3 {
        for b in [1.0, 8.0, 9.0, 9.5] {
            for zero in [0.0, -0.0] {
                rays.push(GzRay::new(turned(k, 6.0, b, -1.0), turned(k, zero, 0.0, 1.0)));
                rays.push(GzRay::new(turned(k, 6.0, b, 5.2), turned(k, zero, 0.0, -1.0)));
                rays.push(GzRay::new(turned(k, 6.0, b, 1.0), turned(k, zero, 0.01, 1.0)));
            }
        }
    }
    both_happen(&agree("D2", &buffer(triangles), &rays), false);
}

#[test]
fn d03_triangle_exactly_in_a_split_plane_is_found_from_either_side() {
    let mut triangles = cube();
    let walls = triangles.len() as u32;
    for k in 0..3 {
        triangles.push([turned(k, 6.0, 0.0, 0.0), turned(k, 6.0, 12.0, 0.0), turned(k, 6.0, 0.0, 12.0)]);
    }
    let tris = buffer(triangles);
    let mut rays = Vec::new();
    for k in 0..3 {
        for (from, to) in [(5.9, 1.0), (6.1, -1.0), (5.5, 0.25), (6.5, -0.25)] {
            rays.push(GzRay::new(turned(k, from, 2.0, 3.0), turned(k, to, 0.0, 0.0)));
            rays.push(GzRay::new(turned(k, from, 2.0, 3.0), turned(k, to, 0.1, -0.05)));
        }
    }
    let hits = agree("D3", &tris, &rays);
    assert!(hits.iter().filter(|hit| hit.tri >= walls).count() >= rays.len() / 2, "{hits:?}");
}

#[test]
fn d04_triangle_touching_the_plane_at_a_corner_or_an_edge() {
    let mut triangles = cube();
    let touching = triangles.len() as u32;
    for k in 0..3 {
        for side in [-2.0, 2.0] {
            triangles.push([turned(k, 6.0, 4.0, 4.0), turned(k, 6.0 + side, 2.0, 4.0), turned(k, 6.0 + side, 4.0, 2.0)]);
            triangles.push([turned(k, 6.0, 8.0, 7.0), turned(k, 6.0, 10.0, 7.0), turned(k, 6.0 + side, 9.0, 9.0)]);
        }
    }
    let mut rays = Vec::new();
    for k in 0..3 {
        // At the corner and along the edge, from every side, straight and in the plane.
        for (b, c) in [(4.0, 4.0), (8.0, 7.0), (9.0, 7.0), (10.0, 7.0)] {
            for d in [turned(k, 1.0, 0.0, 0.0), turned(k, 0.0, 1.0, 0.0), turned(k, 0.0, 0.0, 1.0), turned(k, 0.5, 0.25, 1.0)] {
                for sign in [1.0, -1.0] {
                    rays.push(GzRay::new(turned(k, 6.0, b, c) - d * sign * 0.5, d * sign));
                }
            }
        }
    }
    let hits = agree("D4", &buffer(triangles), &rays);
    assert!(hits.iter().any(|hit| hit.is_hit() && hit.tri >= touching));
}

#[test]
fn d05_origin_on_a_split_plane() {
    let mut rays = Vec::new();
    for k in 0..3 {
        for plane in PLANES {
            for a in [1.0, -1.0, 0.0, -0.0, 1e-30] {
                rays.push(GzRay::new(turned(k, plane, 3.3, 4.4), turned(k, a, 0.2, 0.1)));
                rays.push(GzRay::new(turned(k, plane, 3.0, 6.0), turned(k, a, 0.0, -1.0)));
            }
        }
    }
    both_happen(&agree("D5", &buffer(cube()), &rays), false);
}

#[test]
fn d06_zero_components_of_either_sign() {
    let mut rays = Vec::new();
    for k in 0..3 {
        for zero in [0.0, -0.0] {
            for from in [5.0, 6.0, 7.0] {
                for (b, c) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
                    rays.push(GzRay::new(turned(k, from, 6.0 - 7.0 * b, 6.5 - 7.0 * c), turned(k, zero, b, c)));
                }
            }
        }
    }
    assert_eq!(rays.len(), 72);
    both_happen(&agree("D6", &buffer(cube()), &rays), false);

    let two = [1.0, 2.1].map(|z| [v(-1.0, -1.0, z), v(2.0, -1.0, z), v(-1.0, 2.0, z)]);
    let hits = agree("D6, two triangles", &buffer(two), &[GzRay::new(v(0.25, 0.25, 0.0), v(0.0, -0.0, 1.0))]);
    assert_eq!((hits[0].tri, hits[0].t), (0, 1.0));
}

#[test]
fn d07_subnormal_components() {
    let mut rays = Vec::new();
    for k in 0..3 {
        for tiny in [1e-40, -1e-40, f32::from_bits(1), -f32::from_bits(1)] {
            for plane in [6.0, 5.0, 12.0, 0.0] {
                rays.push(GzRay::new(turned(k, plane, 1.0, -1.0), turned(k, tiny, 0.3, 1.0)));
                rays.push(GzRay::new(turned(k, plane, 1.0, 5.0), turned(k, tiny, -tiny, 1.0)));
            }
            // All three subnormal: t is beyond f32, and the hit counts.
            rays.push(GzRay::new(v(5.0, 5.5, 6.5), turned(k, tiny, tiny, -tiny)));
        }
    }
    both_happen(&agree("D7", &buffer(cube()), &rays), false);
}

#[test]
fn d08_distances_to_planes_that_overflow() {
    let mut rays = Vec::new();
    for k in 0..3 {
        for (tiny, away) in [(1e-30, 1e-10), (1e-38, 1.0), (-1e-30, -1e-10), (-1e-38, -1.0), (1e-38, -1.0)] {
            // In f64, as 6 + 1e-10 is not an f32.
            let mut ray = GzRay::new(turned(k, 6.0, 1.0, -1.0), turned(k, tiny, 0.3, 1.0));
            ray.origin[k] -= away;
            rays.push(ray);
        }
    }
    both_happen(&agree("D8", &buffer(cube()), &rays), false);
}

#[test]
fn d09_plane_exactly_at_an_end_of_the_ray() {
    let mut triangles = cube();
    triangles.push([v(0.0, 0.0, 6.0), v(12.0, 0.0, 6.0), v(0.0, 12.0, 6.0)]);
    let wall = triangles.len() as u32 - 1;
    triangles.push([v(0.0, 0.0, 8.0), v(12.0, 0.0, 8.0), v(0.0, 12.0, 8.0)]);
    let straight = GzRay::new(v(0.5, 0.25, 0.0), GzCoord::Z);
    let rays = [
        GzRay { tmax: 6.0, ..straight },
        GzRay { tmax: 6.0f32.next_up(), ..straight },
        GzRay { tmin: 6.0, ..straight },
        GzRay { tmin: 6.0f32.next_down(), ..straight },
        GzRay { tmin: 6.0, tmax: 6.0f32.next_up(), ..straight },
        GzRay { tmin: 3.0, tmax: 9.0, ..straight },
    ];
    let hits = agree("D9", &buffer(triangles), &rays);
    let found: Vec<u32> = hits.iter().map(|hit| hit.tri).collect();
    // Both ends are strict.
    assert_eq!((found[0], found[1], found[3], found[4]), (gz_core::NO_TRI, wall, wall, gz_core::NO_TRI));
    assert_eq!((found[2], found[5]), (wall + 1, wall));
}

#[test]
fn d10_hit_exactly_on_a_boundary_of_cells() {
    let mut triangles = shell();
    let wall = triangles.len() as u32;
    for plane in [6.0, 3.0, 9.0] {
        triangles.push([v(0.0, 0.0, plane), v(12.0, 0.0, plane), v(0.0, 12.0, plane)]);
        triangles.push([v(12.0, 12.0, plane), v(12.0, 0.0, plane), v(0.0, 12.0, plane)]);
    }
    // Slanted rays whose distance to the plane rounds both ways.
    let mut rays = Vec::new();
    for i in 0..400 {
        let (x, y) = (0.013 * i as f32, 0.029 * i as f32);
        rays.push(GzRay::new(v(5.9, 5.8, 0.1), v(x - 2.5, y - 5.5, 5.9)));
        rays.push(GzRay::new(v(x + 1.0, 0.3, 11.9), v(0.37, 0.0007 * y, -1.0)));
    }
    let hits = agree("D10", &buffer(triangles), &rays);
    assert!(hits.iter().filter(|hit| hit.is_hit() && hit.tri >= wall).count() > 400);
}

#[test]
fn d11_triangle_of_many_cells_hit_in_a_later_one() {
    // Two rectangles that cross, seen under 45 degrees: each is listed in cells where the other is hit.
    let rectangle = |a: GzCoord, b: GzCoord, c: GzCoord, d: GzCoord| [[a, b, c], [a, c, d]];
    let mut triangles = Vec::new();
    triangles.extend(rectangle(v(0.0, 0.0, 0.0), v(12.0, 0.0, 12.0), v(12.0, 12.0, 12.0), v(0.0, 12.0, 0.0)));
    triangles.extend(rectangle(v(12.0, 0.0, 0.0), v(0.0, 0.0, 12.0), v(0.0, 12.0, 12.0), v(12.0, 12.0, 0.0)));
    triangles.extend((0..40).map(|k| {
        let p = v((k % 7) as f32 * 1.7, (k % 11) as f32, (k % 5) as f32 * 2.3);
        [p, p + GzCoord::X * 0.2, p + GzCoord::Y * 0.2]
    }));
    let mut rays = Vec::new();
    for (i, j) in (0..30).flat_map(|i| (0..30).map(move |j| (0.4 * i as f32, 0.4 * j as f32))) {
        rays.push(GzRay::new(v(-3.0 + i, j, -3.0), v(1.0, 0.0, 1.0)));
        rays.push(GzRay::new(v(i, j, -5.0), v(0.1, 0.05, 1.0)));
        rays.push(GzRay::new(v(15.0 - i, j, -3.0), v(-1.0, 0.1, 1.0)));
    }
    both_happen(&agree("D11", &buffer(triangles), &rays), true);
}
