//! Stand-in: files in, always the same triangle.

use crate::error::LoadError;
use gz_core::{CameraModel, CameraSpec, GzCamera, GzCoord, GzTri, TriBuffer, View, glam::DVec3};
use gz_shade::{Antialias, Background, Fresnel, Material, Scene, SceneNeeds, ShadeRules};
use std::path::Path;

/// What the command line says over the scene.
#[derive(Clone, Debug, Default)]
pub struct Overrides {
    /// Picture size.
    pub size: Option<(u32, u32)>,
    /// Camera model.
    pub camera: Option<CameraModel>,
    /// Depth.
    pub depth: Option<u32>,
    /// Antialiasing.
    pub aa: Option<Antialias>,
    /// Fresnel.
    pub fresnel: Option<Fresnel>,
}

/// A scene without triangles yet.
#[derive(Debug)]
pub struct Draft {
    /// The scene.
    pub scene: Scene,
    /// What was odd.
    pub warnings: Vec<String>,
    /// Triangles that the camera drops.
    pub dropped: u64,
}

/// Reads a scene.
///
/// # Errors
///
/// If it cannot be read.
pub fn scene(path: &Path, overrides: &Overrides) -> Result<Draft, LoadError> {
    if !path.extension().is_some_and(|e| ["toml", "obj", "asc"].iter().any(|known| e == *known)) {
        return Err(LoadError::bad(path, None, "a scene is a .toml, .obj or .asc file"));
    }
    std::fs::metadata(path).map_err(|e| LoadError::io(path, &e))?;
    let (width, height) = overrides.size.unwrap_or((64, 48));
    let view = View { position: DVec3::Z * 5.0, look_at: DVec3::ZERO, up: DVec3::Y, fov: 40.0 };
    let model = overrides.camera.unwrap_or(CameraModel::Pinhole);
    let camera = GzCamera::new(CameraSpec { model, view: Some(view), width, height });
    let mut rules = ShadeRules::PHYSICAL;
    rules.antialias = overrides.aa.unwrap_or(rules.antialias);
    rules.depth = overrides.depth.unwrap_or(rules.depth);
    let scene = Scene {
        tris: TriBuffer::new(),
        camera: camera.map_err(|e| LoadError::bad(path, None, e.to_string()))?,
        lights: vec![],
        ambient: GzCoord::ZERO,
        background: Background::Plain(GzCoord::new(0.1, 0.2, 0.3)),
        materials: vec![Material::default()],
        used: vec![1],
        textures: vec![],
        rules,
    };
    Ok(Draft { scene, warnings: vec![], dropped: 0 })
}

impl Draft {
    /// Places the triangles.
    ///
    /// # Errors
    ///
    /// If one is refused.
    pub fn place(mut self, needs: SceneNeeds) -> Result<Scene, LoadError> {
        let positions = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]].map(GzCoord::from_array);
        self.scene.tris = TriBuffer::with_attributes(needs.attributes(), 1);
        let tri = GzTri { positions, normals: [GzCoord::Z; 3], ..GzTri::default() };
        self.scene.tris.push(&tri).map_err(|e| LoadError::bad(Path::new("-"), None, e.to_string()))?;
        Ok(self.scene)
    }
}
