//! The T-value pixel and buffer: what the homework's Z-buffer became.

use crate::camera::PrimaryRays;
use crate::{ClassMask, GzCamera, Hit, RayQuery, Tile, TileGrid, TriBuffer};
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

/// The primary rays of a tile, traced: pixel `k` of `out` is pixel `k` of the tile, row by row.
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
    scratch.places.clear();
    scratch.places.extend(tile.pixels());
    let rays = camera.rays(&scratch.places, offset, &mut scratch.rays);
    scratch.hits.clear();
    scratch.hits.resize(rays.len(), Hit::MISS);
    query.closest_hits(&rays, ClassMask::ALL, &mut scratch.hits);
    out.clear();
    out.extend(scratch.hits.iter().map(|&hit| GzPixel::of(hit, query.tris())));
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

impl TBuffer {
    /// A buffer in which nothing was hit.
    pub fn empty(width: u32, height: u32) -> Self {
        Self { width, height, hits: vec![Hit::MISS; width as usize * height as usize] }
    }

    /// Traces the primary rays of a whole picture, without antialiasing.
    pub fn trace(camera: &GzCamera, query: &(impl RayQuery + ?Sized)) -> Self {
        let mut buffer = Self::empty(camera.width(), camera.height());
        let (mut scratch, mut pixels) = (TileScratch::default(), Vec::new());
        for tile in TileGrid::whole(camera.width(), camera.height(), 64).tiles() {
            trace_tile(&tile, DVec2::ZERO, camera, query, &mut scratch, &mut pixels);
            for ((i, j), pixel) in tile.pixels().zip(&pixels) {
                buffer.hits[j as usize * camera.width() as usize + i as usize] = pixel.hit;
            }
        }
        buffer
    }

    /// The hit of pixel (`i`, `j`), column and row.
    pub fn at(&self, i: u32, j: u32) -> &Hit {
        &self.hits[j as usize * self.width as usize + i as usize]
    }
}
