//! A scene as plain data.

use crate::{GzLight, Material, ShadeRules, Texture};
use glam::DVec3;
use gz_core::{CameraModel, GzCamera, GzColor, TriBuffer, TriId};

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

impl Background {
    /// The colour seen along `direction`, of any length; `up` is world up at length 1, both in trace space.
    ///
    /// A zero direction sees the middle of a gradient.
    pub fn color(&self, direction: DVec3, up: DVec3) -> GzColor {
        match *self {
            Self::Plain(color) => color,
            Self::Gradient { bottom, top } => {
                let height = direction.normalize_or_zero().dot(up).clamp(-1.0, 1.0);
                let t = ((height + 1.0) / 2.0) as f32;
                bottom * (1.0 - t) + top * t
            }
        }
    }
}

impl Scene {
    /// The material of triangle `tri`.
    ///
    /// # Panics
    ///
    /// If the triangle names a material that the scene does not have.
    pub fn material(&self, tri: TriId) -> &Material {
        &self.materials[usize::from(self.tris.material(tri))]
    }

    /// World up (+y) in trace space, at length 1.
    pub fn up(&self) -> DVec3 {
        self.camera.shading_from_world().vector(DVec3::Y).normalize_or_zero()
    }

    /// Whether shadow, mirror and glass rays make sense: not under the screen camera, whose triangles are projected already while
    /// normals and lights are not.
    pub fn has_secondary_rays(&self) -> bool {
        self.camera.model() != CameraModel::Screen
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gradient_is_linear_in_height() {
        let sky = Background::Gradient { bottom: GzColor::ZERO, top: GzColor::ONE };
        assert_eq!(sky.color(DVec3::Y * 7.0, DVec3::Y), GzColor::ONE);
        assert_eq!(sky.color(DVec3::NEG_Y, DVec3::Y), GzColor::ZERO);
        assert_eq!(sky.color(DVec3::X, DVec3::Y), GzColor::splat(0.5));
        assert_eq!(sky.color(DVec3::new(0.0, 3.0, 4.0), DVec3::Y), GzColor::splat(0.8));
        assert_eq!(sky.color(DVec3::ZERO, DVec3::Y), GzColor::splat(0.5));
    }
}
