//! The scenes that benches run on, with their rays.

use super::rays::{RaySet, TILE, frame_rays, paper_rays};
use crate::rendered::scene_path;
use glam::DVec3;
use gz_app::error::AppError;
use gz_app::load::{self, Overrides};
use gz_app::teapot::{MAX_SEGMENTS, tessellate};
use gz_bsp::BspTree;
use gz_core::{CameraModel, CameraSpec, GzCamera, GzColor, GzCoord, GzTri, TriBuffer, View};
use gz_shade::{Antialias, Background, GzLight, Interpolate, LightKind, Material, Scene, SceneNeeds, ShadeRules};
use std::path::{Path, PathBuf};

/// Triangles and the rays to ask about.
#[derive(Debug)]
pub struct BenchScene {
    /// What it is called, and where it comes from if that is not what the name says.
    pub name: String,
    /// The triangles, in trace space.
    pub tris: TriBuffer,
    /// The rays of its picture at [`WIDTH`].
    pub rays: RaySet,
}

/// Width of the pictures whose rays are asked about, in pixels.
pub const WIDTH: u32 = 256;

/// The scene of the paper's figures and tables.
pub const PAPER: &str = "paper-reflection";

/// The scene that `cargo xtask render` renders.
pub const DEFAULT: &str = "teapot";

/// Whether the course's data is there, so that [`PAPER`] is the paper's own scene and not its stand-in.
pub fn has_course_data() -> bool {
    std::env::var_os("GZ_HW_DATA").is_some_and(|folder| Path::new(&folder).join("paper/reflection.asc").is_file())
}

/// The scene of this name with its rays: those of the paper's program for the paper's scene, for every other one the rays of its own
/// render, one sample a pixel. Names are those of [`scene_of`].
///
/// # Errors
///
/// If it cannot be loaded.
pub fn bench_scene(name: &str) -> Result<BenchScene, AppError> {
    let (scene, needs) = scene_of(name)?;
    let tree = BspTree::build(&scene.tris);
    let is_paper = Path::new(name).file_stem().is_some_and(|stem| stem == PAPER);
    let rays = if is_paper { paper_rays(&scene, &tree) } else { frame_rays(&scene, needs, &tree, TILE)? };
    drop(tree);
    let stand_in = if is_paper && !has_course_data() { " (its stand-in: GZ_HW_DATA names no course data)" } else { "" };
    Ok(BenchScene { name: format!("{name}{stand_in}"), tris: scene.tris, rays })
}

/// The scene of this name: a stem of `assets/scenes`, a scene or mesh file, `teapot:SEGMENTS` or `uneven`, both made here.
///
/// # Errors
///
/// If it cannot be loaded.
pub fn scene_of(name: &str) -> Result<(Scene, SceneNeeds), AppError> {
    match name.strip_prefix("teapot:") {
        Some(segments) => {
            let segments = segments.parse().ok().filter(|n| (1..=MAX_SEGMENTS).contains(n)).ok_or_else(|| {
                AppError::Usage(format!("teapot:{segments} is not a number of segments from 1 to {MAX_SEGMENTS}"))
            })?;
            made(teapot(segments), DVec3::new(1.0, 0.6, 1.4).normalize() * 9.0 + DVec3::Y * 1.5, DVec3::Y * 1.5)
        }
        None if name == "uneven" => made(uneven(), DVec3::new(2.4, 1.1, 2.0), DVec3::Y * 0.12),
        None => loaded(&path_of(name), WIDTH),
    }
}

/// A name as a file: a stem of `assets/scenes`, or a file as it is.
fn path_of(name: &str) -> PathBuf {
    if Path::new(name).extension().is_some() { PathBuf::from(name) } else { scene_path(name) }
}

/// The scene of a file, placed, with a picture `width` pixels wide and one sample a pixel.
///
/// # Errors
///
/// If it cannot be loaded.
pub fn loaded(path: &Path, width: u32) -> Result<(Scene, SceneNeeds), AppError> {
    let full = load::scene(path, &Overrides::default())?.scene.camera;
    let height = (width * full.height()).div_ceil(full.width());
    let overrides = Overrides { size: Some((width, height)), aa: Some(Antialias::None), ..Overrides::default() };
    let draft = load::scene(path, &overrides)?;
    let needs = SceneNeeds::of(&draft.scene);
    Ok((draft.place(needs)?, needs))
}

/// The files of `assets/scenes`, by name.
///
/// # Errors
///
/// If the folder cannot be read.
pub fn asset_scenes() -> Result<Vec<PathBuf>, AppError> {
    let folder = scene_path("").parent().map(Path::to_owned).unwrap_or_default();
    let entries = std::fs::read_dir(&folder).map_err(|error| AppError::Io(format!("{}: {error}", folder.display())))?;
    let mut scenes: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    scenes.retain(|path| path.extension().is_some_and(|e| e == "toml"));
    scenes.sort();
    Ok(scenes)
}

/// A teapot with its bottom, 64 `segments`^2 triangles, as the scene file's `teapot` makes it.
pub fn teapot(segments: u32) -> Vec<[GzCoord; 3]> {
    let mesh = tessellate(segments, true);
    mesh.triangles.iter().map(|tri| tri.position.map(|k| mesh.positions[k as usize])).collect()
}

/// Very uneven triangles: a fine teapot a tenth of its size on a ground a hundred times as wide, which is a fan of slivers.
pub fn uneven() -> Vec<[GzCoord; 3]> {
    let mut triangles: Vec<[GzCoord; 3]> = teapot(24).into_iter().map(|corners| corners.map(|p| p * 0.1)).collect();
    // 1500 slivers from a point below the teapot to a wide rim; a few meet there, the others pass by at some distance.
    const SLIVERS: usize = 1500;
    const RADIUS: f32 = 30.0;
    let rim = |k: usize| {
        let angle = std::f64::consts::TAU * k as f64 / SLIVERS as f64;
        GzCoord::new(angle.cos() as f32 * RADIUS, 0.0, angle.sin() as f32 * RADIUS)
    };
    let centre = GzCoord::new(0.31, -0.01, 0.17);
    triangles.extend((0..SLIVERS).map(|k| [centre, rim(k + 1), rim(k)]));
    // Long thin beams over the whole scene at several heights, across the axes.
    triangles.extend((0..300).map(|k| {
        let (a, b) = (rim(5 * k), rim(5 * k + 740));
        let height = GzCoord::Y * (2.0 + 0.1 * k as f32);
        [a + height, b + height, b + height + GzCoord::Y * 0.05]
    }));
    triangles
}

/// A grey scene of `triangles` with two lights, seen from `eye`.
fn made(triangles: Vec<[GzCoord; 3]>, eye: DVec3, look_at: DVec3) -> Result<(Scene, SceneNeeds), AppError> {
    let mut tris = TriBuffer::new();
    for positions in triangles {
        let tri = GzTri { positions, ..GzTri::default() };
        tris.push(&tri).map_err(|error| AppError::Usage(format!("a made scene: {error}")))?;
    }
    let view = View { position: eye, look_at, up: DVec3::Y, fov: 40.0 };
    let spec = CameraSpec { model: CameraModel::Pinhole, view: Some(view), width: WIDTH, height: WIDTH };
    let camera = GzCamera::new(spec).map_err(|error| AppError::Usage(format!("a made scene: {error}")))?;
    let light = |direction: DVec3| GzLight { kind: LightKind::Directional(direction.normalize()), color: GzColor::splat(0.5) };
    let scene = Scene {
        used: vec![tris.len() as u64],
        tris,
        camera,
        lights: vec![light(DVec3::new(-0.5, 0.8, 0.55)), light(DVec3::new(0.7, 0.4, -0.2))],
        ambient: GzColor::splat(0.2),
        background: Background::Plain(GzColor::ZERO),
        materials: vec![Material { interpolate: Interpolate::Flat, ..Material::default() }],
        textures: Vec::new(),
        rules: ShadeRules::PHYSICAL,
    };
    let needs = SceneNeeds::of(&scene);
    Ok((scene, needs))
}
