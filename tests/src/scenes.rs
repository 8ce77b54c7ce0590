//! The scenes of `assets/scenes` as tests use them: every one that this machine can load, small.

use crate::homework::data_folder;
use crate::rendered::scene_path;
use gz_app::load::{self, Draft, Overrides};
use gz_core::{GzColor, Hit, RayQuery, TileGrid};
use gz_shade::{Frame, Scene, SceneNeeds, shade_frame};

/// The names of all scenes, sorted.
///
/// # Panics
///
/// If the folder cannot be read.
pub fn names() -> Vec<String> {
    let file = scene_path("any");
    let folder = file.parent().expect("a scene lies in a folder");
    let entries = std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut names: Vec<String> = entries
        .map(|entry| entry.expect("a readable folder").path())
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .map(|path| path.file_stem().unwrap_or_default().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

/// [`names`] without those that cannot be loaded for want of course data; a line is printed for each left out.
///
/// # Panics
///
/// If a scene is wrong.
pub fn usable() -> Vec<String> {
    let mut names = names();
    names.retain(|name| match load::scene(&scene_path(name), &Overrides::default()) {
        Ok(_) => true,
        Err(error) if data_folder().is_none() && !error.io && error.message.contains("GZ_HW_DATA") => {
            println!("skipped: {error}");
            false
        }
        Err(error) => panic!("{error}"),
    });
    names
}

/// A scene by its name, ready to be placed.
///
/// # Panics
///
/// If it cannot be loaded.
pub fn draft(name: &str, overrides: &Overrides) -> Draft {
    load::scene(&scene_path(name), overrides).unwrap_or_else(|error| panic!("{error}"))
}

/// A scene by its name, placed with the needs that it has.
///
/// # Panics
///
/// If it cannot be loaded or placed.
pub fn placed(name: &str, overrides: &Overrides) -> (Scene, SceneNeeds) {
    let draft = draft(name, overrides);
    let needs = SceneNeeds::of(&draft.scene);
    (draft.place(needs).unwrap_or_else(|error| panic!("{error}")), needs)
}

/// The whole picture of `scene` in tiles of `tile`.
pub fn shade(scene: &Scene, needs: SceneNeeds, query: &dyn RayQuery, tile: u32) -> Frame {
    let grid = TileGrid::whole(scene.camera.width(), scene.camera.height(), tile);
    shade_frame(scene, needs, query, &grid, &|_| {})
}

/// The bits of colours: what `==` on floats does not tell apart, this does.
pub fn color_bits(colors: &[GzColor]) -> Vec<[u32; 3]> {
    colors.iter().map(|color| color.to_array().map(f32::to_bits)).collect()
}

/// The bits of hits: T-value, triangle, u, v.
pub fn hit_bits(hits: &[Hit]) -> Vec<[u32; 4]> {
    hits.iter().map(|hit| [hit.t.to_bits(), hit.tri, hit.u.to_bits(), hit.v.to_bits()]).collect()
}
