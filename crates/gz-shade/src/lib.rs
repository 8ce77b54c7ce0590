//! Materials, lights, textures, shadows, mirrors and glass: from T-value pixels to colours.
//!
//! Nothing here names a tree or reads a file; visibility is asked through [`gz_core::RayQuery`]. The steps, each in its own file:
//! `frame` goes tile by tile, `tree` follows mirror and glass rays (`bounce` says where they go, by the formulas in `reflection`,
//! `refraction`, `optics` and `media`, `crowd` which of too many end, `flock` in which order they are asked), `local` shades hits light by
//! light (`phong` with `interpolate`, `texture`, `shadow`), `aa` sums samples, and `color` writes channels. `hits`, `bend` and `lit` work on
//! eight hits at once what `item` and those formulas say of one, with the same bits. `needs` says which of these a scene can do without.
#![forbid(unsafe_code)]

mod aa;
mod bend;
mod bounce;
pub mod color;
mod crowd;
mod eight;
mod explain;
mod flock;
mod frame;
mod hits;
mod interpolate;
mod item;
mod light;
mod lit;
mod local;
mod material;
mod media;
mod needs;
pub mod optics;
pub mod phong;
mod powers;
mod rays;
pub mod reflection;
pub mod refraction;
mod rules;
mod scene;
mod shadow;
mod source;
mod stats;
mod texture;
mod tree;

pub use aa::{Sample, samples};
pub use explain::{ExplainNode, LightPart, Sight, explain_pixel};
pub use frame::{Frame, ShadeScratch, shade_frame, shade_tile};
pub use light::{Arrival, Falloff, GzLight, LightKind};
pub use material::{Interpolate, Material, MaterialKind, Surface};
pub use needs::{NeedReason, SceneNeeds};
pub use rules::{Antialias, ColorCode, Eye, Fresnel, GlassBlend, MirrorBlend, ShadeRules, ShadowRule};
pub use scene::{Background, Scene};
pub use shadow::ShadowRay;
pub use stats::FrameStats;
pub use texture::{ImageTexture, Procedural, Texture, TextureLookup};
pub use tree::RayKind;
