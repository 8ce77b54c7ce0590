//! Lights.

use glam::DVec3;
use gz_core::GzColor;

/// A light. Positions and directions are in shading space: image space under the course's cameras, world space under pinhole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GzLight {
    /// Where its light comes from.
    pub kind: LightKind,
    /// Colour and strength, linear, at least 0.
    pub color: GzColor,
}

/// Where a light's light comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// From infinitely far away: the vector from the surface *to* the light, as given and not renormalised (the course's
    /// directions are unit to four digits only).
    Directional(DVec3),
    /// From a point, weakening with distance.
    Point {
        /// Where the light stands.
        position: DVec3,
        /// How it weakens.
        falloff: Falloff,
    },
}

/// Weakening with the distance r: 1 / (c0 + c1 r + c2 r^2). Not all may be 0, none negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Falloff {
    /// Constant part.
    pub c0: f32,
    /// Part linear in the distance.
    pub c1: f32,
    /// Part quadratic in the distance.
    pub c2: f32,
}

impl Falloff {
    /// No weakening.
    pub const NONE: Self = Self { c0: 1.0, c1: 0.0, c2: 0.0 };

    /// The factor at distance `r`.
    pub fn at(&self, r: f32) -> f32 {
        1.0 / (self.c0 + self.c1 * r + self.c2 * r * r)
    }
}
