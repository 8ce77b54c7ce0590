//! The keys of a scene file, table by table, as serde reads them. What they mean is in docs/SCENE.md.

use super::values::{Aa, BackgroundValue, Color, Number, OneOrMany, OneOrThree, Tint, Xyz};
use super::words::{Kind, LightSpace, Mode, NormalsRule, Word};
use gz_core::CameraModel;
use gz_shade::{ColorCode, Eye, Fresnel, GlassBlend, Interpolate, MirrorBlend, ShadowRule, Surface, TextureLookup};
use serde::Deserialize;
use toml::Spanned;

/// The whole file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneKeys {
    #[serde(default)]
    pub(super) render: RenderKeys,
    pub(super) camera: Option<Spanned<CameraKeys>>,
    pub(super) background: Option<BackgroundValue>,
    pub(super) ambient: Option<Color>,
    #[serde(default)]
    pub(super) light: Vec<Spanned<LightKeys>>,
    #[serde(default)]
    pub(super) texture: Vec<Spanned<TextureKeys>>,
    #[serde(default)]
    pub(super) material: Vec<Spanned<MaterialKeys>>,
    #[serde(default)]
    pub(super) mesh: Vec<Spanned<MeshKeys>>,
}

/// `[render]`.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RenderKeys {
    pub(super) size: Option<Spanned<[i64; 2]>>,
    pub(super) mode: Option<Word<Mode>>,
    pub(super) depth: Option<Spanned<i64>>,
    pub(super) aa: Option<Aa>,
    pub(super) fresnel: Option<Word<Fresnel>>,
    pub(super) shadow: Option<Word<ShadowRule>>,
    pub(super) eye: Option<Word<Eye>>,
    pub(super) mirror_blend: Option<Word<MirrorBlend>>,
    pub(super) glass_blend: Option<Word<GlassBlend>>,
    pub(super) reflect_last_light: Option<bool>,
    pub(super) clamp_levels: Option<bool>,
    pub(super) screen_interpolation: Option<bool>,
    pub(super) geometric_sides: Option<bool>,
    pub(super) flat_textures: Option<bool>,
    pub(super) color_code: Option<Word<ColorCode>>,
}

/// `[camera]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CameraKeys {
    pub(super) model: Option<Word<CameraModel>>,
    pub(super) position: Option<Xyz>,
    pub(super) look_at: Option<Xyz>,
    pub(super) up: Option<Xyz>,
    pub(super) fov: Option<Spanned<Number>>,
}

/// `[[light]]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LightKeys {
    pub(super) direction: Option<Spanned<Xyz>>,
    pub(super) position: Option<Spanned<Xyz>>,
    pub(super) falloff: Option<Spanned<[Number; 3]>>,
    pub(super) color: Color,
    pub(super) space: Option<Word<LightSpace>>,
}

/// `[[texture]]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TextureKeys {
    pub(super) name: Spanned<String>,
    pub(super) file: Option<Spanned<String>>,
    pub(super) lookup: Option<Word<TextureLookup>>,
    pub(super) shift: Option<bool>,
    pub(super) srgb: Option<bool>,
    pub(super) checker: Option<Spanned<CheckerKeys>>,
    pub(super) or: Option<Spanned<TextureOrKeys>>,
}

/// `or` of a texture: what stands in for a course file that is not there.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TextureOrKeys {
    pub(super) file: Option<Spanned<String>>,
    pub(super) checker: Option<Spanned<CheckerKeys>>,
}

/// `checker` of a texture.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CheckerKeys {
    pub(super) across: Number,
    pub(super) down: Number,
    pub(super) colors: Option<[Color; 2]>,
}

/// `[[material]]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MaterialKeys {
    pub(super) name: Spanned<String>,
    pub(super) ka: Option<Color>,
    pub(super) kd: Option<Color>,
    pub(super) ks: Option<Color>,
    pub(super) power: Option<Spanned<Number>>,
    pub(super) kind: Option<Word<Kind>>,
    pub(super) ior: Option<Spanned<Number>>,
    pub(super) tint: Option<Tint>,
    pub(super) texture: Option<Spanned<String>>,
    pub(super) interpolate: Option<Word<Interpolate>>,
    pub(super) surface: Option<Word<Surface>>,
}

/// `[[mesh]]`, and each `or` of one.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MeshKeys {
    pub(super) file: Option<Spanned<String>>,
    pub(super) teapot: Option<Spanned<TeapotKeys>>,
    pub(super) quad: Option<[Xyz; 4]>,
    pub(super) triangles: Option<Vec<[Xyz; 3]>>,
    pub(super) material: Option<Spanned<String>>,
    pub(super) normals: Option<Word<NormalsRule>>,
    pub(super) crease: Option<Spanned<Number>>,
    pub(super) place: Option<Vec<Spanned<PlaceKeys>>>,
    #[serde(default, rename = "override")]
    pub(super) overrides: Vec<Spanned<OverrideKeys>>,
    pub(super) app_color: Option<AppColorKeys>,
    pub(super) or: Option<Spanned<OneOrMany<MeshKeys>>>,
}

/// `teapot` of a mesh.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TeapotKeys {
    pub(super) segments: Spanned<i64>,
    pub(super) bottom: Option<bool>,
}

/// One step of `place`: exactly one key.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PlaceKeys {
    pub(super) scale: Option<OneOrThree>,
    pub(super) rotate_x: Option<Number>,
    pub(super) rotate_y: Option<Number>,
    pub(super) rotate_z: Option<Number>,
    pub(super) translate: Option<Xyz>,
    pub(super) matrix: Option<[[Number; 4]; 4]>,
}

/// One `override` of a mesh.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct OverrideKeys {
    pub(super) triangle: Spanned<i64>,
    pub(super) image_vertices: Option<Spanned<[Xyz; 3]>>,
    pub(super) normal: Option<Spanned<Xyz>>,
    pub(super) material: Option<Spanned<String>>,
}

/// `app_color` of a mesh.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AppColorKeys {
    pub(super) direction: Xyz,
    pub(super) color: Color,
}
