//! What stands for the scene where `shadows` does not show a failure well.

use crate::bench::scenes::teapot;
use glam::DVec3;
use gz_app::error::AppError;
use gz_core::{CameraModel, CameraSpec, GzCamera, GzColor, GzCoord, GzTri, LeavePolicy, TriBuffer, View};
use gz_shade::{Background, GzLight, Interpolate, LightKind, Material, Scene, ShadeRules};

/// Where the fine ground is: a coordinate of this size has steps of 2^-14.
const CENTRE: DVec3 = DVec3::new(1000.0, 1001.0, 1002.0);
/// Quads along a side, each a hundredth wide.
const QUADS: u32 = 200;
const STEP: f64 = 0.01;

/// Half the floor's quads along a side, and how wide each is.
const FLOOR_HALF: i32 = 8;
const FLOOR_STEP: f32 = 1.25;
const FLOOR_TRIANGLES: usize = 2 * (2 * FLOOR_HALF as usize) * (2 * FLOOR_HALF as usize);

/// A ground of many small triangles far from the origin, under a low light, with a pillar that throws a shadow.
///
/// # Errors
///
/// If a triangle is refused, which none is.
pub(super) fn ground(width: u32, height: u32, leave: LeavePolicy) -> Result<Scene, AppError> {
    // A frame that no axis is of, so that every coordinate is rounded.
    let up = DVec3::new(0.31, 0.9, -0.23).normalize();
    let right = up.cross(DVec3::new(0.2, 0.1, 1.0)).normalize();
    let forward = right.cross(up);
    let at = |x: f64, y: f64, z: f64| CENTRE + right * x + up * y + forward * z;

    let mut corners = Vec::new();
    let half = f64::from(QUADS) * STEP / 2.0;
    for (i, j) in (0..QUADS).flat_map(|i| (0..QUADS).map(move |j| (i, j))) {
        let corner = |i: u32, j: u32| at(f64::from(i) * STEP - half, 0.0, f64::from(j) * STEP - half);
        let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
        corners.extend([[a, b, c], [a, c, d]]);
    }
    // The four sides and the top of the pillar.
    let (base, wide, tall) = ((-0.35, 0.1), 0.06, 0.12);
    let ring =
        |y: f64| [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(i, j)| at(base.0 + f64::from(i) * wide, y, base.1 + f64::from(j) * wide));
    let (low, high) = (ring(-0.02), ring(tall));
    for k in 0..4 {
        let l = (k + 1) % 4;
        corners.extend([[low[k], low[l], high[l]], [low[k], high[l], high[k]]]);
    }
    corners.extend([[high[0], high[1], high[2]], [high[0], high[2], high[3]]]);

    let bad = |why: String| AppError::Usage(format!("the fine ground: {why}"));
    let mut tris = TriBuffer::new();
    for positions in corners {
        let tri = GzTri { positions: positions.map(|p| p.as_vec3()), ..GzTri::default() };
        tris.push(&tri).map_err(|error| bad(error.to_string()))?;
    }
    let view = View { position: at(0.5, 0.75, 1.5), look_at: at(0.0, 0.0, 0.0), up, fov: 40.0 };
    let spec = CameraSpec { model: CameraModel::Pinhole, view: Some(view), width, height };
    let camera = GzCamera::new(spec).map_err(|error| bad(error.to_string()))?;
    // About three degrees above the ground.
    let toward = (right * -0.96 + up * 0.05 + forward * -0.27).normalize();
    Ok(Scene {
        used: vec![tris.len() as u64],
        tris,
        camera,
        // Strong, as little of it falls on the ground.
        lights: vec![GzLight { kind: LightKind::Directional(toward), color: GzColor::new(12.0, 10.8, 9.0) }],
        ambient: GzColor::new(0.16, 0.19, 0.25),
        background: Background::Plain(GzColor::new(0.05, 0.07, 0.1)),
        materials: vec![Material {
            interpolate: Interpolate::Flat,
            ks: GzColor::ZERO,
            ka: GzColor::splat(0.6),
            kd: GzColor::splat(0.6),
            ..Material::default()
        }],
        textures: Vec::new(),
        rules: ShadeRules { leave, ..ShadeRules::PHYSICAL },
    })
}

/// A floor in small quads, and a teapot turned as in `shadows` on it; the floor's triangles come first.
pub fn turned_teapot_floor(pot: Vec<[GzCoord; 3]>) -> Vec<[GzCoord; 3]> {
    // By about -28 degrees.
    let (sin, cos) = (-0.469_471_56, 0.882_947_6);
    let turned = |p: GzCoord| GzCoord::new(cos * p.x + sin * p.z, p.y, cos * p.z - sin * p.x);
    let quad = |i: i32, j: i32| {
        let corner = |i: i32, j: i32| GzCoord::new(i as f32, 0.0, j as f32) * FLOOR_STEP;
        let [a, b, c, d] = [corner(i, j), corner(i, j + 1), corner(i + 1, j + 1), corner(i + 1, j)];
        [[a, b, c], [a, c, d]]
    };
    let floor = (-FLOOR_HALF..FLOOR_HALF).flat_map(|i| (-FLOOR_HALF..FLOOR_HALF).flat_map(move |j| quad(i, j)));
    floor.chain(pot.into_iter().map(|corners| corners.map(turned))).collect()
}

/// `shadows` with a coarse teapot, shaded flat, and a floor in small quads, so that some triangles are larger than a voxel and some are not.
///
/// # Errors
///
/// If a triangle is refused, which none is.
pub(super) fn coarse(scene: Scene) -> Result<Scene, AppError> {
    // The floor comes first in the file, so that its first triangle names its material, and the last the teapot's.
    let (floor, clay) = (scene.tris.material(0), scene.tris.material(scene.tris.len() as u32 - 1));
    let mut tris = TriBuffer::with_attributes(scene.tris.attributes(), 0);
    for (k, positions) in turned_teapot_floor(teapot(4)).into_iter().enumerate() {
        let material = if k < FLOOR_TRIANGLES { floor } else { clay };
        let tri = GzTri { positions, material, ..GzTri::default() };
        tris.push(&tri).map_err(|error| AppError::Usage(format!("the coarse teapot: {error}")))?;
    }
    let materials = scene.materials.iter().map(|m| Material { interpolate: Interpolate::Flat, ..m.clone() }).collect();
    Ok(Scene { tris, materials, ..scene })
}
