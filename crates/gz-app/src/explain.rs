//! What a scene needs, and what each need costs.

use crate::stats::rays_by_kind;
use gz_shade::{FrameStats, Scene, SceneNeeds};
use std::fmt::Write;

/// The names of the needs of a scene, as the fields of [`SceneNeeds`] are called.
pub fn needs_in_use(scene: &Scene) -> Vec<&'static str> {
    SceneNeeds::reasons(scene).into_iter().filter(|reason| reason.because.is_some()).map(|reason| reason.need).collect()
}

/// What `scene` needs, one line a need: what asks for it, and the bytes that it stores with each triangle.
///
/// The two kinds of texture share one array of texture coordinates, told at the first of them that is needed.
pub fn needs_report(scene: &Scene) -> String {
    let mut text = String::new();
    let mut uvs_told = false;
    for reason in SceneNeeds::reasons(scene) {
        let Some(because) = reason.because else {
            let _ = writeln!(text, "  {:<20} no", reason.need); // writing to a string cannot fail
            continue;
        };
        let bytes = match reason.need {
            "smooth_normals" => 36,
            "image_textures" | "procedural_textures" if !std::mem::replace(&mut uvs_told, true) => 24,
            "app_colors" => 12,
            "materials" => 2,
            "glass" => 1,
            _ => 0,
        };
        let cost = match bytes {
            0 => String::new(),
            1 => "; 1 byte a triangle".to_owned(),
            bytes => format!("; {bytes} bytes a triangle"),
        };
        let _ = writeln!(text, "  {:<20} yes: {because}{cost}", reason.need);
    }
    text
}

/// The answer to `--explain`: needs with their bytes, then the rays that a finished render cast for them.
pub fn explain(scene: &Scene, stats: &FrameStats) -> String {
    format!(
        "what the scene needs\n{}  positions            always; 36 bytes a triangle\n  together             {} bytes a triangle, {} for {} \
         triangles\nrays cast\n  {}\n",
        needs_report(scene),
        scene.tris.attributes().bytes_per_triangle(),
        scene.tris.bytes(),
        scene.tris.len(),
        rays_by_kind(stats),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use gz_core::glam::DVec3;
    use gz_core::{Attributes, CameraModel, CameraSpec, GzCamera, GzColor, TriBuffer, View};
    use gz_shade::{Background, ImageTexture, Material, MaterialKind, Procedural, ShadeRules, Texture, TextureLookup};

    /// A scene in which every need that stores something is there.
    fn rich() -> Scene {
        let view = View { position: DVec3::Z, look_at: DVec3::ZERO, up: DVec3::Y, fov: 40.0 };
        let spec = CameraSpec { model: CameraModel::Pinhole, view: Some(view), width: 8, height: 8 };
        let material = |k: usize| Material {
            texture: (k < 2).then_some(k),
            kind: if k == 2 { MaterialKind::Glass { ior: 1.5 } } else { MaterialKind::Phong },
            surface: if k == 3 { gz_shade::Surface::AppColor } else { gz_shade::Surface::Shaded },
            ..Material::default()
        };
        let image = ImageTexture { width: 1, height: 1, texels: vec![GzColor::ONE], lookup: TextureLookup::Repeat };
        Scene {
            tris: TriBuffer::new(),
            camera: GzCamera::new(spec).unwrap(),
            lights: Vec::new(),
            ambient: GzColor::ONE,
            background: Background::Plain(GzColor::ZERO),
            materials: (0..4).map(material).collect(),
            used: vec![1; 4],
            textures: vec![
                Texture::Image(image),
                Texture::Procedural(Procedural::Checker { across: 1.0, down: 1.0, colors: [GzColor::ZERO, GzColor::ONE] }),
            ],
            rules: ShadeRules::PHYSICAL,
        }
    }

    #[test]
    fn the_bytes_told_are_the_bytes_stored() {
        let scene = rich();
        assert_eq!(SceneNeeds::of(&scene).attributes(), Attributes::ALL);
        let told = |line: &str| line.split("; ").nth(1).and_then(|rest| rest.split(' ').next()?.parse::<usize>().ok());
        let sum: usize = needs_report(&scene).lines().filter_map(told).sum();
        assert_eq!(sum + 36, Attributes::ALL.bytes_per_triangle());
    }

    #[test]
    fn needs_that_nothing_asks_for_are_not_listed_as_in_use() {
        let scene = rich();
        let names = needs_in_use(&scene);
        assert!(names.contains(&"glass") && names.contains(&"app_colors"));
        assert!(!names.contains(&"shadows") && !names.contains(&"antialiasing"), "{names:?}");
    }
}
