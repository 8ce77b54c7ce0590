//! D17 to D19: rays at the faces of the root's box, and from far away.

use super::{agree, both_happen, buffer, cube, turned};
use gz_core::{GzCoord, GzRay};

#[test]
fn d17_ray_in_a_face_of_the_scenes_box() {
    // Triangles that stand on the face and reach it with a corner or an edge are hit by rays that lie in it.
    let mut triangles = cube();
    let standing = triangles.len() as u32;
    for k in 0..3 {
        for (face, inward) in [(0.0, 3.0), (12.0, 9.0)] {
            triangles.push([turned(k, face, 3.0, 5.0), turned(k, face, 7.0, 5.0), turned(k, inward, 5.0, 5.0)]);
            triangles.push([turned(k, face, 8.0, 8.0), turned(k, inward, 9.0, 7.0), turned(k, inward, 7.0, 9.0)]);
        }
    }
    let mut rays = Vec::new();
    for k in 0..3 {
        for face in [0.0, 12.0] {
            for zero in [0.0, -0.0] {
                for b in [3.0, 5.0, 7.0, 8.0] {
                    rays.push(GzRay::new(turned(k, face, b, -1.0), turned(k, zero, 0.0, 1.0)));
                    rays.push(GzRay::new(turned(k, face, b, 13.0), turned(k, zero, 0.0, -1.0)));
                    rays.push(GzRay::new(turned(k, face, 13.0, b), turned(k, zero, -1.0, 0.0)));
                    // From within the face, where no edge of the box is in the way.
                    rays.push(GzRay::new(turned(k, face, b, 1.0), turned(k, zero, 0.0, 1.0)));
                }
            }
        }
    }
    let hits = agree("D17", &buffer(triangles), &rays);
    assert!(hits.iter().any(|hit| hit.is_hit() && hit.tri >= standing), "the box's face is part of the scene");
}

#[test]
fn d18_origin_inside_outside_and_on_every_face_edge_and_corner() {
    let places = [-1.0, 0.0, 5.0, 12.0, 13.0];
    let directions = [-1.0, 0.0, 1.0];
    let mut rays = Vec::new();
    for (x, y) in places.into_iter().flat_map(|x| places.map(|y| (x, y))) {
        for z in places {
            for (dx, dy) in directions.into_iter().flat_map(|dx| directions.map(|dy| (dx, dy))) {
                for dz in directions {
                    let direction = GzCoord::new(dx, dy, dz);
                    if direction != GzCoord::ZERO {
                        rays.push(GzRay::new(GzCoord::new(x, y, z), direction));
                    }
                }
            }
        }
    }
    assert_eq!(rays.len(), 125 * 26);
    both_happen(&agree("D18", &buffer(cube()), &rays), true);
}

#[test]
fn d19_ray_from_a_million_units_away() {
    let mut rays = Vec::new();
    for k in 0..3 {
        for i in 0..150 {
            let aim = turned(k, 0.08 * i as f32, 12.0 - 0.07 * i as f32, 0.05 * i as f32);
            for away in [1e6, -1e6] {
                let origin = turned(k, away, 0.3 * away, -0.7 * away);
                rays.push(GzRay::new(origin, aim - origin));
                rays.push(GzRay::new(origin, (aim - origin).normalize()));
            }
            // Aimed at the edges and corners of the box itself.
            let origin = turned(k, 1e6, i as f32, -3e5);
            rays.push(GzRay::new(origin, turned(k, 12.0, 12.0 * (i % 2) as f32, 0.0) - origin));
        }
    }
    both_happen(&agree("D19", &buffer(cube()), &rays), true);
}
