//! Lights.

use glam::DVec3;
use gz_core::{GzColor, GzCoord};

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

/// A light as one point sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrival {
    /// L of the shading equation: from the point to the light. A directional light's as given, else of length 1; zero when the
    /// point is the light's own place.
    pub to_light: DVec3,
    /// The same direction as shadow rays have it, in f32.
    pub direction: GzCoord,
    /// Where shadow rays end, t in lengths of `direction`: infinite for a directional light, else just before the light.
    pub tmax: f32,
    /// Colour and strength that arrive where nothing is in the way.
    pub color: GzColor,
}

/// Shadow rays end at this share of the distance to a point light. The direction is rounded to f32 (2^-24), so that a triangle which
/// the light sits on is met within a few 2^-24 of the distance, on either side; 2^-20 leaves it out, as an open interval should.
const BEFORE_LIGHT: f64 = 1.0 - 1.0 / 1_048_576.0;

impl GzLight {
    /// How this light reaches `point`.
    pub fn arrive(&self, point: DVec3) -> Arrival {
        match self.kind {
            LightKind::Directional(to_light) => {
                Arrival { to_light, direction: to_light.as_vec3(), tmax: f32::INFINITY, color: self.color }
            }
            LightKind::Point { position, falloff } => {
                let way = position - point;
                let distance = way.length();
                let Some(to_light) = way.try_normalize() else {
                    return Arrival { to_light: DVec3::ZERO, direction: GzCoord::ZERO, tmax: 0.0, color: GzColor::ZERO };
                };
                let tmax = (distance * BEFORE_LIGHT) as f32;
                Arrival { to_light, direction: to_light.as_vec3(), tmax, color: self.color * falloff.at(distance as f32) }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_light_weakens_with_distance_and_its_rays_end_before_it() {
        let falloff = Falloff { c0: 1.0, c1: 0.0, c2: 1.0 };
        let light = GzLight { kind: LightKind::Point { position: DVec3::Y * 3.0, falloff }, color: GzColor::ONE };
        let arrival = light.arrive(DVec3::ZERO);
        assert_eq!((arrival.to_light, arrival.direction), (DVec3::Y, GzCoord::Y));
        assert_eq!(arrival.color, GzColor::splat(0.1));
        assert!(arrival.tmax < 3.0 && arrival.tmax > 2.9999);
        // At its own place it has no direction, and gives nothing rather than NaN.
        assert_eq!(light.arrive(DVec3::Y * 3.0).color, GzColor::ZERO);
    }

    #[test]
    fn a_directional_light_is_the_same_everywhere_and_keeps_its_length() {
        let light = GzLight { kind: LightKind::Directional(DVec3::new(0.0, -0.6, -0.9)), color: GzColor::ONE };
        assert_eq!(light.arrive(DVec3::ZERO), light.arrive(DVec3::splat(1e6)));
        assert_eq!(light.arrive(DVec3::ZERO).to_light, DVec3::new(0.0, -0.6, -0.9));
    }
}
