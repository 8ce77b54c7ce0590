//! What a scene needs: nothing else is stored or traced.

use crate::{Interpolate, Material, MaterialKind, Scene, ShadowRule, Surface, Texture};
use gz_core::Attributes;

/// Which features the triangles in use ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SceneNeeds {
    /// Shadow rays: a light, something that casts, and a rule that lets it.
    pub shadows: bool,
    /// Mirror rays.
    pub mirrors: bool,
    /// Rays through glass, and light tinted by it.
    pub glass: bool,
    /// Texture pictures.
    pub image_textures: bool,
    /// Texture formulas.
    pub procedural_textures: bool,
    /// Corner normals: some material in use interpolates, or is glass and has to know its outside.
    pub smooth_normals: bool,
    /// Colours shaded at corners.
    pub gouraud: bool,
    /// The application's triangle colours.
    pub app_colors: bool,
    /// Material numbers: a material other than the scene's first is in use.
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

    /// What `scene` needs, from its materials in use, camera, lights and rules. Its triangle buffer is not looked at: it may still be
    /// empty.
    ///
    /// A need is left out only where its work could not change a bit of the picture.
    pub fn of(scene: &Scene) -> Self {
        let [
            shadows,
            mirrors,
            glass,
            image_textures,
            procedural_textures,
            smooth_normals,
            gouraud,
            app_colors,
            materials,
            antialiasing,
        ] = Self::reasons(scene).map(|reason| reason.because.is_some());
        Self {
            shadows,
            mirrors,
            glass,
            image_textures,
            procedural_textures,
            smooth_normals,
            gouraud,
            app_colors,
            materials,
            antialiasing,
        }
    }

    /// Each need with what asks for it, for `--explain`; in the order of the fields.
    pub fn reasons(scene: &Scene) -> [NeedReason; 10] {
        let rules = &scene.rules;
        let in_use = |what: &dyn Fn(&Material) -> bool| {
            let found = scene.materials.iter().zip(&scene.used).find(|(material, used)| **used > 0 && what(material))?;
            Some(format!("material \"{}\" on {} triangles", found.0.name, found.1))
        };
        let bounces = rules.depth > 0 && scene.has_secondary_rays();
        let shaded = |m: &Material| m.surface == Surface::Shaded;
        let is_mirror = |m: &Material| matches!(m.kind, MaterialKind::Mirror { .. });
        let is_glass = |m: &Material| matches!(m.kind, MaterialKind::Glass { .. });
        let interpolates = |m: &Material| m.interpolate != Interpolate::Flat;
        let texture = |m: &Material| {
            let seen = shaded(m) && (interpolates(m) || rules.flat_textures);
            m.texture.filter(|_| seen).and_then(|texture| scene.textures.get(texture))
        };

        // Any triangle casts a shadow on another, so a shaded material and a light are enough.
        let may_cast = rules.shadow != ShadowRule::Off && scene.has_secondary_rays() && !scene.lights.is_empty();
        let shadows = in_use(&shaded).filter(|_| may_cast).map(|it| format!("{} lights on {it}", scene.lights.len()));
        let tints = shadows.is_some() && rules.shadow == ShadowRule::Tinted;
        let other = in_use(&|m| scene.materials.first().is_some_and(|first| !std::ptr::eq(m, first)));
        let samples = crate::samples(rules.antialias).len();
        [
            ("shadows", shadows),
            ("mirrors", in_use(&is_mirror).filter(|_| bounces)),
            ("glass", in_use(&is_glass).filter(|_| bounces || tints)),
            ("image_textures", in_use(&|m| matches!(texture(m), Some(Texture::Image(_))))),
            ("procedural_textures", in_use(&|m| matches!(texture(m), Some(Texture::Procedural(_))))),
            (
                "smooth_normals",
                in_use(&|m| {
                    interpolates(m) && (shaded(m) || (bounces && (is_mirror(m) || is_glass(m)))) || bounces && is_glass(m)
                }),
            ),
            ("gouraud", in_use(&|m| shaded(m) && m.interpolate == Interpolate::Gouraud)),
            ("app_colors", in_use(&|m| m.surface == Surface::AppColor)),
            ("materials", other),
            ("antialiasing", (samples > 1).then(|| format!("{samples} samples a pixel"))),
        ]
        .map(|(need, because)| NeedReason { need, because })
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

/// A need, and what in the scene asks for it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NeedReason {
    /// The name of the field of [`SceneNeeds`].
    pub need: &'static str,
    /// The first thing found that asks for it; `None` when nothing does.
    pub because: Option<String>,
}
