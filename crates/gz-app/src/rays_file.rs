//! The rays format: eight numbers a ray, little-endian, no header.
//!
//! ox oy oz tmin dx dy dz tmax, as f32 (32 bytes a ray) or as f64 (64 bytes). Rays keep an f64 origin and f32 for the rest; a wider number
//! is rounded once to nearest, and so is an origin that is written as f32.

use gz_core::glam::{DVec2, DVec3};
use gz_core::{GzCamera, GzCoord, GzRay, Tile};
use std::path::Path;

/// How wide the numbers of a file of rays are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayFormat {
    /// f32, the usual one.
    F32,
    /// f64, which keeps the origins of rays that leave a surface.
    F64,
}

/// The rays of the pixels of `area`, row-major, each through the middle of its pixel.
pub fn primary(camera: &GzCamera, area: &Tile, format: RayFormat) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(area.len() * format.ray_bytes());
    area.pixels().for_each(|(i, j)| format.encode(&camera.ray(i, j, DVec2::ZERO), &mut bytes));
    bytes
}

impl RayFormat {
    /// The format of a file of this name: f64 for the extension `.rays64`, f32 for any other.
    pub fn of(path: &Path) -> Self {
        if path.extension().is_some_and(|extension| extension == "rays64") { Self::F64 } else { Self::F32 }
    }

    /// Bytes of one ray.
    pub fn ray_bytes(self) -> usize {
        match self {
            Self::F32 => 32,
            Self::F64 => 64,
        }
    }

    /// Appends a ray.
    pub fn encode(self, ray: &GzRay, bytes: &mut Vec<u8>) {
        let ([ox, oy, oz], [dx, dy, dz]) = (ray.origin.to_array(), ray.direction.as_dvec3().to_array());
        for number in [ox, oy, oz, ray.tmin.into(), dx, dy, dz, ray.tmax.into()] {
            match self {
                Self::F32 => bytes.extend((number as f32).to_le_bytes()),
                Self::F64 => bytes.extend(number.to_le_bytes()),
            }
        }
    }

    /// The rays of `bytes`; bytes at the end that make no whole ray are left out.
    pub fn decode(self, bytes: &[u8]) -> impl Iterator<Item = GzRay> + '_ {
        let number = move |ray: &[u8], k: usize| match self {
            Self::F32 => f64::from(f32::from_le_bytes(std::array::from_fn(|i| ray[4 * k + i]))),
            Self::F64 => f64::from_le_bytes(std::array::from_fn(|i| ray[8 * k + i])),
        };
        bytes.chunks_exact(self.ray_bytes()).map(move |ray| {
            let [ox, oy, oz, tmin, dx, dy, dz, tmax] = std::array::from_fn(|k| number(ray, k));
            GzRay {
                origin: DVec3::new(ox, oy, oz),
                direction: GzCoord::new(dx as f32, dy as f32, dz as f32),
                tmin: tmin as f32,
                tmax: tmax as f32,
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_come_back_with_their_bits() {
        let rays = [
            GzRay::new(GzCoord::new(1.0, -0.0, f32::MAX), GzCoord::new(0.1, f32::from_bits(1), -3.0)),
            GzRay { tmin: f32::NEG_INFINITY, tmax: 7.5, ..GzRay::new(GzCoord::ZERO, GzCoord::Z) },
        ];
        for format in [RayFormat::F32, RayFormat::F64] {
            let mut bytes = Vec::new();
            rays.iter().for_each(|ray| format.encode(ray, &mut bytes));
            assert_eq!(bytes.len(), 2 * format.ray_bytes());
            let back: Vec<GzRay> = format.decode(&bytes).collect();
            assert_eq!(back, rays);
            assert!(back[0].origin.y.is_sign_negative());
            assert_eq!(format.decode(&bytes[..bytes.len() - 1]).count(), 1);
        }
        let mut bytes = Vec::new();
        RayFormat::F32.encode(&rays[0], &mut bytes);
        assert_eq!(bytes[..4], 1f32.to_le_bytes());
        assert_eq!((&bytes[12..16], &bytes[28..]), (&0f32.to_le_bytes()[..], &f32::INFINITY.to_le_bytes()[..]));
    }

    #[test]
    fn f64_keeps_an_origin_that_f32_rounds() {
        let ray = GzRay::from_f64(DVec3::new(1.0 + 1e-12, 0.1, 0.0), GzCoord::X);
        let through = |format: RayFormat| {
            let mut bytes = Vec::new();
            format.encode(&ray, &mut bytes);
            format.decode(&bytes).next().unwrap()
        };
        assert_eq!(through(RayFormat::F64), ray);
        assert_eq!(through(RayFormat::F32).origin, DVec3::new(1.0, 0.1f32.into(), 0.0));
    }
}
