//! The product's own rays: those that a picture of a mesh asks about, with f64 origins.
//!
//! The mesh and its ground mirror half of what falls on them, under one directional light, seen as `harness/make_rays.hpp` sees it:
//! 1024 by 1024 pixels and three bounces. The shadow rays are one set, the mirror rays another, both in the order in which the render asks.

use super::meshes::Mesh;
use crate::bench::rays::{RaySet, answers, differing, frame_rays};
use glam::DVec3;
use gz_app::error::AppError;
use gz_app::new_file::NewFile;
use gz_bsp::BspTree;
use gz_core::{BruteForce, CameraModel, CameraSpec, GzCamera, GzColor, GzCoord, NO_TRI, TriBuffer, View};
use gz_shade::{Background, GzLight, Interpolate, LightKind, Material, MaterialKind, Scene, SceneNeeds, ShadeRules};
use std::path::PathBuf;

/// The sets.
pub(super) const SETS: [&str; 2] = ["frame-shadow", "frame-reflect"];
/// Pixels of a side, as of the other sets.
pub(super) const SIDE: u32 = 1024;
/// Side of a tile, as of `gz render`.
const TILE: u32 = 64;
/// An index with which a mirror takes about half of the light, so that shadow rays are asked too.
const HALF: f32 = 5.83;
/// Brute force checks so many triangle tests' worth of the rays.
const CHECKED_TESTS: f64 = 1e9;

/// Writes both sets of `mesh` for a picture of this side, `to` giving the file of each, after brute force has had a look at our answers to some of the rays.
///
/// # Errors
///
/// If the mesh cannot be used, an answer differs or a file cannot be written.
pub(super) fn make(mesh: &Mesh, side: u32, to: impl Fn(&str) -> PathBuf) -> Result<(), AppError> {
    let bytes = std::fs::read(&mesh.path).map_err(|error| AppError::Io(format!("{}: {error}", mesh.path.display())))?;
    let tris = read_mesh(&bytes).ok_or_else(|| AppError::Io(format!("{}: is no mesh file", mesh.path.display())))?;
    let (scene, needs) = scene_of(tris, side)?;
    let tree = BspTree::build(&scene.tris);
    let rays = frame_rays(&scene, needs, &tree, TILE)?;
    let brute = BruteForce::new(&scene.tris);
    for (set, rays) in SETS.into_iter().zip([rays.shadow(), rays.bounced()]) {
        let few = rays.sample((CHECKED_TESTS / scene.tris.len().max(1) as f64) as usize);
        let wrong = differing(&answers(&brute, &few), &answers(&tree, &few));
        println!("{}, {set}: {} rays, {} checked by brute force, {wrong} differ", mesh.name, rays.len(), few.len());
        if wrong > 0 {
            return Err(AppError::Differs(format!("{wrong} answers to {} {set} differ from those of brute force", mesh.name)));
        }
        if rays.is_empty() {
            return Err(AppError::Usage(format!("{}: the camera sees nothing of which {set} could start", mesh.name)));
        }
        NewFile::at(&to(set))?.write(&ray_bytes(&rays))?;
    }
    Ok(())
}

/// The triangles of a mesh file, see `harness/files.hpp`.
fn read_mesh(bytes: &[u8]) -> Option<TriBuffer> {
    let (words, _) = bytes.strip_prefix(b"TRIM")?.as_chunks::<4>();
    let ([vertices, triangles], words) = words.split_first_chunk()?;
    let count = |n: &[u8; 4]| (u32::from_le_bytes(*n) as usize).checked_mul(3);
    let (positions, words) = words.split_at_checked(count(vertices)?)?;
    let (indices, _) = words.split_at_checked(count(triangles)?)?;
    let number = |k: usize| f32::from_le_bytes(positions[k]);
    let corners: Vec<GzCoord> =
        (0..positions.len() / 3).map(|k| GzCoord::new(number(3 * k), number(3 * k + 1), number(3 * k + 2))).collect();
    let triples: Vec<[u32; 3]> = indices.as_chunks().0.iter().map(|triple| triple.map(u32::from_le_bytes)).collect();
    TriBuffer::from_indexed(&corners, &triples).ok()
}

/// A ray as the harness has it, `PeerRay64`.
fn ray_bytes(rays: &RaySet) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(48 * rays.len());
    for (ray, leaves) in rays.rays() {
        bytes.extend(ray.origin.to_array().into_iter().flat_map(f64::to_le_bytes));
        let [x, y, z] = ray.direction.to_array();
        bytes.extend([ray.tmin, x, y, z, ray.tmax].into_iter().flat_map(f32::to_le_bytes));
        bytes.extend(leaves.unwrap_or(NO_TRI).to_le_bytes());
    }
    bytes
}

/// Which axis is up: the one that the ground, the last triangle, does not extend along.
fn up_axis(tris: &TriBuffer) -> usize {
    let [a, b, c] = tris.positions().last().copied().unwrap_or_default();
    (0..3).find(|&k| a[k] == b[k] && a[k] == c[k]).unwrap_or(2)
}

/// The scene of a mesh whose last two triangles are its ground.
fn scene_of(tris: TriBuffer, side: u32) -> Result<(Scene, SceneNeeds), AppError> {
    let up = up_axis(&tris);
    // A vector given as if z were up, as the harness turns it.
    let turned = |a: f64, b: f64, c: f64| match up {
        0 => DVec3::new(c, a, b),
        1 => DVec3::new(b, c, a),
        _ => DVec3::new(a, b, c),
    };
    let object = &tris.positions()[..tris.len().saturating_sub(2)];
    let corners = || object.iter().flatten().map(|p| p.as_dvec3());
    let low = corners().fold(DVec3::INFINITY, DVec3::min);
    let high = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
    let middle = (low + high) / 2.0;
    let position = middle + turned(0.55, -0.8, 0.42).normalize() * (0.85 * (high - low).length());
    let view = View { position, look_at: middle, up: turned(0.0, 0.0, 1.0), fov: 42.0 };
    let spec = CameraSpec { model: CameraModel::Pinhole, view: Some(view), width: side, height: side };
    let camera = GzCamera::new(spec).map_err(|error| AppError::Usage(format!("the camera of a mesh: {error}")))?;
    let light = turned(0.45, -0.35, 0.8).normalize();
    let mirror =
        Material { kind: MaterialKind::Mirror { ior: Some(HALF) }, interpolate: Interpolate::Flat, ..Material::default() };
    let scene = Scene {
        used: vec![tris.len() as u64],
        tris,
        camera,
        lights: vec![GzLight { kind: LightKind::Directional(light), color: GzColor::ONE }],
        ambient: GzColor::ZERO,
        background: Background::Plain(GzColor::ZERO),
        materials: vec![mirror],
        textures: Vec::new(),
        rules: ShadeRules::PHYSICAL,
    };
    let needs = SceneNeeds::of(&scene);
    Ok((scene, needs))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::peers::meshes::mesh_bytes;

    /// A mesh file of two triangles and their ground.
    fn file() -> Vec<u8> {
        let corners = [[0.0, 1.0, 0.0], [2.0, 1.0, 0.0], [0.0, 3.0, 0.0], [2.0, 3.0, 1.0]].map(GzCoord::from_array);
        mesh_bytes(&TriBuffer::from_indexed(&corners, &[[0, 1, 2], [2, 1, 3]]).unwrap())
    }

    #[test]
    fn a_mesh_file_is_read_with_its_ground() {
        let tris = read_mesh(&file()).unwrap();
        assert_eq!((tris.len(), up_axis(&tris)), (4, 1));
        assert_eq!(tris.position(1)[2], GzCoord::new(2.0, 3.0, 1.0));
        assert!(read_mesh(b"TRIM\x01\0\0\0").is_none() && read_mesh(b"PLY").is_none());
        assert!(read_mesh(b"TRIM\xff\xff\xff\xff\x01\0\0\0").is_none());
    }

    #[test]
    fn a_picture_of_a_mesh_has_shadow_and_mirror_rays_that_name_what_they_leave() {
        let folder = std::env::temp_dir().join(format!("gz-frame-rays-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let mesh = Mesh { name: "m".to_owned(), path: folder.join("m.trim"), triangles: 4 };
        std::fs::write(&mesh.path, file()).unwrap();
        make(&mesh, 64, |set| folder.join(set)).unwrap();
        let files: Vec<Vec<u8>> = SETS.iter().map(|set| std::fs::read(folder.join(set)).unwrap()).collect();
        let counts: Vec<usize> = files.iter().map(|bytes| bytes.len() / 48).collect();
        std::fs::remove_dir_all(&folder).unwrap();
        assert!(counts[0] > 500 && counts[1] > 500, "{counts:?}");
        for bytes in files {
            let leaves = |ray: &[u8]| u32::from_le_bytes([ray[44], ray[45], ray[46], ray[47]]);
            assert!(bytes.chunks_exact(48).all(|ray| leaves(ray) < 4));
        }
    }
}
