//! A scene as plain data.

use crate::{GzLight, Material, ShadeRules, Texture};
use gz_core::{GzCamera, GzColor, TriBuffer};

/// What a ray sees that hits nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Background {
    /// One colour.
    Plain(GzColor),
    /// From `bottom` straight down to `top` straight up, by the ray's direction along world up: colour at height h in [-1, 1] is
    /// linear in h.
    Gradient {
        /// Straight down.
        bottom: GzColor,
        /// Straight up.
        top: GzColor,
    },
}

/// A scene: triangles, camera, lights, materials, textures and the rules of shading.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The placed triangles, in trace space, with the shading data that the scene needs.
    pub tris: TriBuffer,
    /// The camera.
    pub camera: GzCamera,
    /// Lights.
    pub lights: Vec<GzLight>,
    /// Ambient light.
    pub ambient: GzColor,
    /// What a ray sees that hits nothing.
    pub background: Background,
    /// Materials; a triangle names one by its index. Never empty.
    pub materials: Vec<Material>,
    /// Triangles in use of each material, parallel to `materials`. Needs are counted over materials in use.
    pub used: Vec<u64>,
    /// Textures; a material names one by its index.
    pub textures: Vec<Texture>,
    /// The rules of shading.
    pub rules: ShadeRules,
}
