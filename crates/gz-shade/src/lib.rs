//! Materials, lights, textures, shadows, mirrors and glass: from T-value pixels to colours.
//!
//! Nothing here names a tree or reads a file; visibility is asked through [`gz_core::RayQuery`].
#![forbid(unsafe_code)]

mod light;
mod material;
mod needs;
mod rules;
mod scene;
mod texture;

pub use light::{Falloff, GzLight, LightKind};
pub use material::{Interpolate, Material, MaterialKind, Surface};
pub use needs::SceneNeeds;
pub use rules::{Antialias, ColorCode, Eye, Fresnel, GlassBlend, MirrorBlend, ShadeRules, ShadowRule};
pub use scene::{Background, Scene};
pub use texture::{ImageTexture, Procedural, Texture, TextureLookup};
