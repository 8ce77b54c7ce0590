//! What a scene needs, and what each need costs.

use crate::stats::rays_by_kind;
use gz_shade::{FrameStats, Scene, SceneNeeds};
use std::fmt::Write;

/// Each need with its name, whether it is there, and what it costs: bytes of one triangle and what is traced for it.
fn table(needs: &SceneNeeds) -> [(&'static str, bool, usize, &'static str); 10] {
    let textures = needs.image_textures || needs.procedural_textures;
    [
        ("shadows", needs.shadows, 0, "shadow rays"),
        ("mirrors", needs.mirrors, 0, "mirror rays"),
        ("glass", needs.glass, 1, "glass rays"),
        ("image textures", needs.image_textures, if textures { 24 } else { 0 }, ""),
        ("procedural textures", needs.procedural_textures, if needs.image_textures { 0 } else { 24 }, ""),
        ("smooth normals", needs.smooth_normals, 36, ""),
        ("gouraud", needs.gouraud, 0, ""),
        ("application colours", needs.app_colors, 12, ""),
        ("several materials", needs.materials, 2, ""),
        ("antialiasing", needs.antialiasing, 0, "primary rays"),
    ]
}

/// The names of the needs that are there.
pub fn needs_in_use(needs: &SceneNeeds) -> Vec<&'static str> {
    table(needs).into_iter().filter(|row| row.1).map(|row| row.0).collect()
}

/// A table of what `scene` needs with the bytes each need stores, one line a need.
pub fn needs_report(scene: &Scene, needs: &SceneNeeds) -> String {
    let mut text = String::new();
    let count = scene.tris.len();
    for (name, needed, bytes, _) in table(needs) {
        let cost = match (needed, bytes) {
            (false, _) => "not needed".to_owned(),
            (true, 0) => "needed".to_owned(),
            (true, bytes) => format!("needed, {bytes} bytes a triangle: {}", bytes * count),
        };
        let _ = writeln!(text, "  {name:<20} {cost}"); // writing to a string cannot fail
    }
    text
}

/// The answer to `--explain`: needs with their bytes, then the rays that a finished render cast for them.
pub fn explain(scene: &Scene, needs: &SceneNeeds, stats: &FrameStats) -> String {
    format!(
        "what the scene needs (positions: 36 bytes a triangle)\n{}  together {} bytes a triangle, {} for {} triangles\n\
         rays cast: {}\n",
        needs_report(scene, needs),
        needs.attributes().bytes_per_triangle(),
        scene.tris.bytes(),
        scene.tris.len(),
        rays_by_kind(stats),
    )
}
