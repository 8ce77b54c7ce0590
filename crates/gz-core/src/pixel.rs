//! The T-value pixel and buffer: what the homework's Z-buffer became.

use crate::{ClassMask, GzCamera, Hit, PrimaryRays, RayBatch, RayQuery, Tile, TileGrid, TriBuffer};
use glam::{DVec2, DVec3};

/// What a primary ray found: the triangle, its T-value in place of the homework's z, and the point of the hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GzPixel {
    /// Triangle, T-value and weights.
    pub hit: Hit,
    /// Where the hit lies in trace space; 0 for a miss.
    pub point: DVec3,
}

impl GzPixel {
    /// A pixel whose ray met nothing.
    pub const EMPTY: Self = Self { hit: Hit::MISS, point: DVec3::ZERO };

    /// The pixel of `hit`.
    pub fn of(hit: Hit, tris: &TriBuffer) -> Self {
        let point = if hit.is_hit() { tris.hit_point(&hit) } else { DVec3::ZERO };
        Self { hit, point }
    }
}

/// The primary rays of a tile, traced: pixel `k` of `out` is pixel `k` of [`Tile::in_squares`].
///
/// `offset` moves every ray by a part of a pixel, x right and y down; antialiasing traces a tile once per offset.
pub fn trace_tile(
    tile: &Tile,
    offset: DVec2,
    camera: &GzCamera,
    query: &(impl RayQuery + ?Sized),
    scratch: &mut TileScratch,
    out: &mut Vec<GzPixel>,
) {
    let (_, hits) = tile_hits(tile, offset, camera, query, scratch);
    out.clear();
    out.extend(hits.iter().map(|&hit| GzPixel::of(hit, query.tris())));
}

/// The same without the points of the hits: the primary rays and what each hits.
pub fn tile_hits<'s>(
    tile: &Tile,
    offset: DVec2,
    camera: &GzCamera,
    query: &(impl RayQuery + ?Sized),
    scratch: &'s mut TileScratch,
) -> (RayBatch<'s>, &'s [Hit]) {
    let TileScratch { places, rays, hits } = scratch;
    places.clear();
    places.extend(tile.in_squares());
    let rays = camera.rays(places, offset, rays);
    hits.clear();
    hits.resize(rays.len(), Hit::MISS);
    query.closest_hits(&rays, ClassMask::ALL, hits);
    (rays, hits)
}

/// Room for one tile's primary rays, kept from tile to tile.
#[derive(Debug, Default)]
pub struct TileScratch {
    places: Vec<(u32, u32)>,
    rays: PrimaryRays,
    hits: Vec<Hit>,
}

/// The T-value buffer of a whole picture: one [`Hit`] a pixel, row-major, row 0 on top.
///
/// Made only when asked for; a render works tile by tile.
#[derive(Clone, Debug, PartialEq)]
pub struct TBuffer {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// `width * height` hits.
    pub hits: Vec<Hit>,
}

/// Rows of a band, and the side of its tiles.
const BAND: u32 = 16;

impl TBuffer {
    /// A buffer in which nothing was hit.
    pub fn empty(width: u32, height: u32) -> Self {
        Self { width, height, hits: vec![Hit::MISS; width as usize * height as usize] }
    }

    /// Traces the primary rays of a whole picture, without antialiasing; over all cores with the feature `rayon`.
    pub fn trace(camera: &GzCamera, query: &(impl RayQuery + ?Sized)) -> Self {
        let mut buffer = Self::empty(camera.width(), camera.height());
        let width = camera.width() as usize;
        // A band of rows is one slice of the buffer, so that bands can be filled side by side.
        let fill = |(band, hits): (usize, &mut [Hit])| {
            let y0 = band as u32 * BAND;
            let rows = Tile { x0: 0, y0, x1: camera.width(), y1: y0 + (hits.len() / width) as u32 };
            let (mut scratch, mut pixels) = (TileScratch::default(), Vec::new());
            for tile in TileGrid::of(rows, BAND).tiles() {
                trace_tile(&tile, DVec2::ZERO, camera, query, &mut scratch, &mut pixels);
                for ((i, j), pixel) in tile.in_squares().zip(&pixels) {
                    hits[(j - y0) as usize * width + i as usize] = pixel.hit;
                }
            }
        };
        #[cfg(feature = "rayon")]
        {
            use rayon::prelude::*;
            buffer.hits.par_chunks_mut(width * BAND as usize).enumerate().for_each(fill);
        }
        #[cfg(not(feature = "rayon"))]
        buffer.hits.chunks_mut(width * BAND as usize).enumerate().for_each(fill);
        buffer
    }

    /// The hit of pixel (`i`, `j`), column and row.
    pub fn at(&self, i: u32, j: u32) -> &Hit {
        &self.hits[j as usize * self.width as usize + i as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BruteForce, CameraModel, CameraSpec, GzCoord, View};

    #[test]
    fn the_buffer_of_a_picture_holds_the_hit_of_every_pixel() {
        let corners = [[-3.0, -1.0, 0.0], [2.0, -2.0, 1.0], [0.0, 2.5, -1.0], [1.0, 1.0, -4.0]].map(GzCoord::from_array);
        let tris = TriBuffer::from_indexed(&corners, &[[0, 1, 2], [1, 2, 3]]).unwrap();
        let brute = BruteForce::new(&tris);
        let view = View { position: DVec3::Z * 6.0, look_at: DVec3::ZERO, up: DVec3::Y, fov: 50.0 };
        let spec = CameraSpec { model: CameraModel::Pinhole, view: Some(view), width: 37, height: 41 };
        let camera = GzCamera::new(spec).unwrap();
        let buffer = TBuffer::trace(&camera, &brute);
        let mut covered = 0;
        for (i, j) in TileGrid::whole(37, 41, 64).tile(0).pixels() {
            let ray = camera.ray(i, j, DVec2::ZERO);
            assert_eq!(*buffer.at(i, j), brute.closest_hit(&ray));
            if buffer.at(i, j).is_hit() {
                let pixel = GzPixel::of(*buffer.at(i, j), &tris);
                assert!((pixel.point - ray.at(pixel.hit.t)).length() < 1e-5);
                covered += 1;
            }
        }
        assert!(covered > 100 && covered < 37 * 41, "{covered}");
    }
}
