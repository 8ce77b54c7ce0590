//! `gz info`: what a scene holds and needs.

use crate::accel::Accel;
use crate::args;
use crate::cli::InfoArgs;
use crate::error::AppError;
use crate::progress::say;
use crate::{explain, job, load, threads, tree_report};
use gz_core::{GzColor, GzCoord};
use gz_shade::{MaterialKind, Scene, SceneNeeds, Texture};
use std::fmt::Write;

/// Counts, bounds, needs and memory of a scene, as lines of text; with `--tree` also what the tree looks like.
///
/// # Errors
///
/// If the scene cannot be used, or there is no tree to be looked at.
pub fn report(info: &InfoArgs) -> Result<String, AppError> {
    let args = &info.scene;
    let accel = Accel::of(&args.accel)?;
    if info.tree && matches!(accel, Accel::Brute(_)) {
        return Err(AppError::Usage("--tree: brute force has no tree".to_owned()));
    }
    threads::with(args.threads, || {
        let draft = load::scene(&args.scene, &job::overrides(args))?;
        draft.warnings.iter().for_each(|warning| say(&format!("gz: warning: {warning}")));
        let (needs, dropped) = (SceneNeeds::of(&draft.scene), draft.dropped);
        let scene = draft.place(needs)?;
        let built = accel.build(&scene.tris)?;
        let mut text = describe(&args.scene.display().to_string(), &scene, dropped);
        let per_triangle = built.bytes() as f64 / scene.tris.len().max(1) as f64;
        let _ = writeln!(text, "tree       {}, {per_triangle:.1} a triangle", built.describe());
        if info.tree {
            text += &tree_report::report(&built).unwrap_or_default();
        }
        Ok(text)
    })
}

fn describe(name: &str, scene: &Scene, dropped: u64) -> String {
    let mut text = String::new();
    let camera = &scene.camera;
    let used = scene.used.iter().filter(|&&n| n > 0).count();
    let point = |p: GzCoord| format!("({}, {}, {})", p.x, p.y, p.z);
    let bounds = scene.tris.bounds();
    // Writing to a string cannot fail.
    let _ = writeln!(text, "scene      {name}");
    let _ = writeln!(text, "picture    {}x{}, camera {}", camera.width(), camera.height(), args::camera_name(camera.model()));
    let _ = writeln!(
        text,
        "rules      depth {}, fresnel {}, antialiasing {}",
        scene.rules.depth,
        args::fresnel_name(scene.rules.fresnel),
        args::antialias_name(scene.rules.antialias)
    );
    let _ = writeln!(text, "triangles  {}, {dropped} dropped by the camera", scene.tris.len());
    if !bounds.is_empty() {
        let _ = writeln!(text, "bounds     {} to {} in trace space", point(bounds.min), point(bounds.max));
    }
    let _ = writeln!(text, "lights     {}", scene.lights.len());
    let _ = writeln!(text, "materials  {}, {used} in use", scene.materials.len());
    for (material, count) in scene.materials.iter().zip(&scene.used).filter(|(_, count)| **count > 0) {
        let kind = match material.kind {
            MaterialKind::Phong => "phong".to_owned(),
            MaterialKind::Mirror { ior: None } => "ideal mirror".to_owned(),
            MaterialKind::Mirror { ior: Some(ior) } => format!("mirror, index {ior}"),
            MaterialKind::Glass { ior } => format!("glass, index {ior}"),
        };
        let name = if material.name.is_empty() { "(unnamed)" } else { &material.name };
        let _ = writeln!(text, "  {name:<20} {kind}, {count} triangles");
    }
    let _ = writeln!(text, "textures   {}, {} bytes", scene.textures.len(), texture_bytes(scene));
    let _ = write!(text, "needs\n{}", explain::needs_report(scene));
    let per_triangle = scene.tris.attributes().bytes_per_triangle();
    let _ = writeln!(text, "memory     {} bytes, {per_triangle} a triangle", scene.tris.bytes());
    text
}

/// Bytes of all texels of a scene's pictures.
pub fn texture_bytes(scene: &Scene) -> usize {
    let texels = |texture: &Texture| match texture {
        Texture::Image(image) => image.texels.len() * size_of::<GzColor>(),
        Texture::Procedural(_) => 0,
    };
    scene.textures.iter().map(texels).sum()
}
