//! What primary rays found, as T-buffers and as pictures.

use gz_core::glam::DVec2;
use gz_core::{CameraModel, GzColor, Hit, RayQuery, TileGrid, TileScratch, trace_tile};
use gz_shade::{Frame, Scene};
use rayon::prelude::*;

/// What a picture shows in place of colours. A pixel without a hit is black.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum View {
    /// The T-value: white where the scene's box begins as seen from the camera, dark where it ends. The same in every crop.
    T,
    /// The triangle, each number in a colour of its own.
    Id,
    /// The face normal n in trace space turned towards the viewer, as (n + 1) / 2.
    Normal,
}

/// The hit of each pixel of `grid`'s area, row-major, without antialiasing. Bits do not depend on tiles or threads.
pub fn trace_hits(scene: &Scene, query: &dyn RayQuery, grid: &TileGrid) -> Vec<Hit> {
    let tiles: Vec<_> = (0..grid.len())
        .into_par_iter()
        .map_init(TileScratch::default, |scratch, k| {
            let mut pixels = Vec::new();
            trace_tile(&grid.tile(k), DVec2::ZERO, &scene.camera, query, scratch, &mut pixels);
            pixels
        })
        .collect();
    let area = grid.area();
    let mut hits = vec![Hit::MISS; area.len()];
    for (tile, pixels) in grid.tiles().zip(&tiles) {
        for ((i, j), pixel) in tile.in_squares().zip(pixels) {
            hits[(j - area.y0) as usize * area.width() as usize + (i - area.x0) as usize] = pixel.hit;
        }
    }
    hits
}

impl View {
    /// Colours in [0, 1] for `hits`, the hits of `grid`'s area. Encoded like any picture.
    pub fn colors(self, scene: &Scene, hits: &[Hit], grid: &TileGrid) -> Vec<GzColor> {
        let (near, far) = t_range(scene);
        let color = |(pixel, hit): ((u32, u32), &Hit)| match self {
            _ if !hit.is_hit() => GzColor::ZERO,
            // From 1 down to 0.1, so that the farthest hit is still told from none; one depth alone is white.
            Self::T if far > near => {
                let depth = (f64::from(hit.t) - near) / (far - near);
                GzColor::splat(1.0 - 0.9 * depth.clamp(0.0, 1.0) as f32)
            }
            Self::T => GzColor::ONE,
            Self::Id => id_color(hit.tri),
            Self::Normal => {
                let n = scene.tris.face_normal(hit.tri);
                let away = scene.camera.ray(pixel.0, pixel.1, DVec2::ZERO).direction.as_dvec3().dot(n) > 0.0;
                ((if away { -n } else { n }) * 0.5 + 0.5).as_vec3()
            }
        };
        grid.area().pixels().zip(hits).map(color).collect()
    }

    /// The same as a frame: see [`Frame`] for its parts; only primary rays are counted.
    pub fn frame(self, scene: &Scene, hits: &[Hit], grid: &TileGrid) -> Frame {
        let stats = gz_shade::FrameStats { primary_rays: hits.len() as u64, ..Default::default() };
        Frame { area: grid.area(), colors: self.colors(scene, hits, grid), stats }
    }
}

/// The least and the greatest T-value that the box of all triangles leaves to a primary ray, to rounding.
///
/// It does not depend on what is rendered of the picture, so that a crop is that part of the whole.
fn t_range(scene: &Scene) -> (f64, f64) {
    let bounds = scene.tris.bounds();
    let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    if scene.camera.model() == CameraModel::Screen {
        // Parallel rays along z, from 0.
        return (min.z.max(0.0), max.z);
    }
    // All other rays start at one point and are of unit length: T is the distance from there.
    let eye = scene.camera.ray(0, 0, DVec2::ZERO).origin;
    let nearest = eye.clamp(min, max);
    let farthest = (eye - min).abs().max((eye - max).abs());
    (eye.distance(nearest), farthest.length())
}

/// A colour that neighbouring numbers do not share: the number, well mixed, as three bytes from a quarter up.
pub(crate) fn id_color(tri: u32) -> GzColor {
    // An odd multiplier permutes the numbers; the shift brings high bits down (both from the usual 32-bit finalisers).
    let mixed = (tri ^ (tri >> 16)).wrapping_add(1).wrapping_mul(0x9e37_79b1);
    let mixed = (mixed ^ (mixed >> 15)).wrapping_mul(0x85eb_ca77);
    let channel = |shift: u32| 0.25 + 0.75 * ((mixed >> shift) & 0xff) as f32 / 255.0;
    GzColor::new(channel(24), channel(16), channel(8))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbouring_triangles_differ_visibly() {
        for tri in 0..1000u32 {
            let apart = (id_color(tri) - id_color(tri + 1)).abs().max_element();
            assert!(apart > 4.0 / 255.0, "triangles {tri} and the next are {apart} apart");
        }
    }
}
