//! H: cameras and the rays of pixels.

use super::v;
use gz_core::glam::{DVec2, DVec3};
use gz_core::{CameraError, CameraModel, CameraSpec, GzCamera, GzCoord, GzRay, Hit, View};
use gz_tests::hard::{Dice, meshes};
use gz_tests::judge::{buffer, settled};

fn pinhole(position: DVec3, look_at: DVec3, fov: f64, width: u32, height: u32) -> Result<GzCamera, CameraError> {
    let view = View { position, look_at, up: DVec3::Y, fov };
    GzCamera::new(CameraSpec { model: CameraModel::Pinhole, view: Some(view), width, height })
}

fn rays(camera: &GzCamera) -> Vec<GzRay> {
    let (width, height) = (camera.width(), camera.height());
    (0..height).flat_map(|j| (0..width).map(move |i| (i, j))).map(|(i, j)| camera.ray(i, j, DVec2::ZERO)).collect()
}

#[test]
fn h01_camera_in_and_on_the_scene() {
    let cube = meshes::cube().triangles();
    // On a triangle, in the planes of cuts, on an edge, on a corner, inside, far away.
    let places = [
        v(8.0, 1.0, 2.0),
        v(0.0, 0.0, 0.0),
        v(8.0, 8.0, 1.0),
        v(8.0, 4.0, 4.0),
        v(-8.0, -8.0, -8.0),
        v(1.0, 2.0, 3.0),
        v(1e6, 1e6, -1e6),
    ];
    for place in places {
        let camera = pinhole(place.as_dvec3(), DVec3::new(-1.0, 0.5, 0.25), 60.0, 24, 18).expect("a camera");
        let hits = settled("H1", &buffer(cube.iter().copied()), &rays(&camera));
        if place.abs().max_element() < 8.0 {
            assert!(hits.iter().all(Hit::is_hit), "the cube is closed: {place}");
        }
    }
}

#[test]
fn h02_fields_of_view_and_views() {
    let at = |position, look_at, fov| pinhole(position, look_at, fov, 16, 16);
    let cube = buffer(meshes::cube().triangles());
    for (fov, hits) in [(1e-3, 256), (179.9, 256)] {
        let camera = at(DVec3::new(1.0, 2.0, 3.0), DVec3::ZERO, fov).expect("a camera");
        let all = rays(&camera);
        assert!(all.iter().all(GzRay::is_valid));
        assert_eq!(settled("H2", &cube, &all).iter().filter(|hit| hit.is_hit()).count(), hits);
    }
    for fov in [0.0, 180.0, -30.0, f64::NAN, f64::INFINITY] {
        assert_eq!(at(DVec3::Z, DVec3::ZERO, fov).unwrap_err(), CameraError::Fov, "{fov}");
    }
    assert_eq!(at(DVec3::Z, DVec3::Z, 60.0).unwrap_err(), CameraError::NoDirection);
    assert_eq!(at(DVec3::Y, DVec3::ZERO, 60.0).unwrap_err(), CameraError::UpIsParallel);
    assert_eq!(at(DVec3::NAN, DVec3::ZERO, 60.0).unwrap_err(), CameraError::NotFinite);
}

#[test]
fn h03_rays_exactly_through_corners() {
    // The screen camera's rays run along z through whole points; the field's corners are whole too, and so are its walls.
    let mut dice = Dice::new(3);
    let field = meshes::integer_field(&mut dice, 12);
    let spec = CameraSpec { model: CameraModel::Screen, view: None, width: 13, height: 13 };
    let camera = GzCamera::new(spec).expect("a camera");
    let tris = buffer(field.iter().map(|t| t.map(|p| p + GzCoord::Z * 8.0)));
    let all = rays(&camera);
    assert!(all.iter().all(|ray| ray.origin.fract() == DVec3::ZERO && ray.direction == GzCoord::Z));
    let hits = settled("H3", &tris, &all);
    assert!(hits.iter().all(|hit| hit.is_hit() && hit.t.fract() == 0.0));
    // A pinhole camera on the axis, its picture a power of two wide: rays through corners of a grid that round nowhere.
    let camera = pinhole(DVec3::new(0.0, 0.0, 8.0), DVec3::ZERO, 90.0, 16, 16).expect("a camera");
    let grid: Vec<[GzCoord; 3]> = (0..16)
        .flat_map(|i| (0..16).map(move |j| (i as f32 - 8.0, j as f32 - 8.0)))
        .flat_map(|(x, y)| {
            [
                [v(x, y, 0.0), v(x + 1.0, y, 0.0), v(x + 1.0, y + 1.0, 0.0)],
                [v(x, y, 0.0), v(x + 1.0, y + 1.0, 0.0), v(x, y + 1.0, 0.0)],
            ]
        })
        .map(|t| t.map(|p| p * 0.5))
        .collect();
    let hits = settled("H3, pinhole", &buffer(grid), &rays(&camera));
    assert!(hits.iter().filter(|hit| hit.is_hit()).count() >= 64);
}

#[test]
fn h04_picture_sizes() {
    let cube = buffer(meshes::cube().triangles());
    let eye = DVec3::new(1.0, 2.0, 3.0);
    for (width, height) in [(1, 1), (1, 64), (64, 1), (1, 65535), (65535, 1)] {
        let camera = pinhole(eye, DVec3::ZERO, 40.0, width, height).expect("a camera");
        // Every 16th of the long ones.
        let all: Vec<GzRay> = rays(&camera).into_iter().step_by(if width * height > 64 { 16 } else { 1 }).collect();
        assert!(all.iter().all(GzRay::is_valid), "{width}x{height}");
        assert!(settled("H4", &cube, &all).iter().all(Hit::is_hit));
    }
    for (width, height) in [(0, 4), (4, 0), (65536, 1), (1, u32::MAX)] {
        assert_eq!(pinhole(eye, DVec3::ZERO, 40.0, width, height).unwrap_err(), CameraError::Size);
    }
}

#[test]
fn h05_dominant_axes_that_tie() {
    // Directions whose components are equal in size, in every sign and at every place of zeros.
    let mut dice = Dice::new(5);
    let triangles = meshes::soup(&mut dice, 200, 0.5);
    let mut all = Vec::new();
    for signs in 0..27 {
        let direction = GzCoord::new((signs % 3) as f32 - 1.0, (signs / 3 % 3) as f32 - 1.0, (signs / 9) as f32 - 1.0);
        if direction == GzCoord::ZERO {
            continue;
        }
        for _ in 0..40 {
            let aim = dice.pick(&triangles)[0];
            all.push(GzRay::new(aim - direction * 2.0, direction));
            all.push(GzRay::new(dice.point(1.0).as_vec3() - direction * 2.0, direction * 0.37));
        }
    }
    let hits = settled("H5", &buffer(triangles), &all);
    assert!(hits.iter().filter(|hit| hit.is_hit()).count() > 500);
}
