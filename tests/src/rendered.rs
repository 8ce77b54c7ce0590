//! Scenes of `assets/scenes`, rendered for a measurement.

use gz_app::error::LoadError;
use gz_app::load::{self, Overrides};
use gz_app::output::rgb8;
use gz_core::{BruteForce, TBuffer, TileGrid};
use gz_shade::{Frame, Scene, SceneNeeds, shade_frame};
use std::path::PathBuf;

/// A scene, its picture and its T-value buffer.
#[derive(Debug)]
pub struct Rendered {
    /// The scene as placed.
    pub scene: Scene,
    /// Colours and counts.
    pub frame: Frame,
    /// One hit a pixel, without antialiasing.
    pub hits: TBuffer,
    /// The picture in bytes, as a file would have it.
    pub rgb: Vec<u8>,
}

/// The scene file of this name.
pub fn scene_path(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("../assets/scenes/{name}.toml"))
}

/// Renders a scene of `assets/scenes` by brute force, after `change` has had a look at it.
///
/// # Errors
///
/// If the scene cannot be loaded.
pub fn render(name: &str, change: impl FnOnce(&mut Scene)) -> Result<Rendered, LoadError> {
    let mut draft = load::scene(&scene_path(name), &Overrides::default())?;
    change(&mut draft.scene);
    let needs = SceneNeeds::of(&draft.scene);
    let scene = draft.place(needs)?;
    let query = BruteForce::new(&scene.tris);
    let grid = TileGrid::whole(scene.camera.width(), scene.camera.height(), 32);
    let frame = shade_frame(&scene, needs, &query, &grid, &|_| {});
    let hits = TBuffer::trace(&scene.camera, &query);
    let rgb = rgb8(&frame.colors, scene.rules.color_code);
    Ok(Rendered { scene, frame, hits, rgb })
}
