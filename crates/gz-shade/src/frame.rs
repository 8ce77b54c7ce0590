//! Stand-in: the frame, each hit in its material's diffuse colour.

use crate::{Background, Scene, SceneNeeds};
use gz_core::{GzColor, RayQuery, Tile, TileGrid, TileScratch, glam::DVec2, trace_tile};

/// What was traced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrameStats {
    /// Primary rays.
    pub primary_rays: u64,
    /// Shadow rays.
    pub shadow_rays: u64,
    /// Mirror rays.
    pub mirror_rays: u64,
    /// Glass rays.
    pub glass_rays: u64,
    /// NaN pixels.
    pub nan_pixels: u64,
}

impl FrameStats {
    /// Rays of all kinds.
    pub fn rays(&self) -> u64 {
        self.primary_rays + self.shadow_rays + self.mirror_rays + self.glass_rays
    }

    /// Each count with its name.
    pub fn rows(&self) -> [(&'static str, u64); 5] {
        [
            ("primary_rays", self.primary_rays),
            ("shadow_rays", self.shadow_rays),
            ("mirror_rays", self.mirror_rays),
            ("glass_rays", self.glass_rays),
            ("nan_pixels", self.nan_pixels),
        ]
    }
}

/// A shaded picture.
#[derive(Clone, Debug)]
pub struct Frame {
    /// The pixels that were shaded.
    pub area: Tile,
    /// Linear colours, row-major.
    pub colors: Vec<GzColor>,
    /// What was traced.
    pub stats: FrameStats,
}

/// Shades `grid`.
pub fn shade_frame(
    scene: &Scene,
    _needs: SceneNeeds,
    query: &dyn RayQuery,
    grid: &TileGrid,
    on_tile: &(dyn Fn(&Tile) + Sync),
) -> Frame {
    let area = grid.area();
    let mut frame = Frame { area, colors: vec![GzColor::ZERO; area.len()], stats: FrameStats::default() };
    let (mut scratch, mut pixels) = (TileScratch::default(), Vec::new());
    for tile in grid.tiles() {
        trace_tile(&tile, DVec2::ZERO, &scene.camera, query, &mut scratch, &mut pixels);
        for ((i, j), pixel) in tile.pixels().zip(&pixels) {
            frame.stats.primary_rays += 1;
            frame.colors[((j - area.y0) * area.width() + i - area.x0) as usize] = match (pixel.hit.is_hit(), scene.background) {
                (true, _) => scene.materials[scene.tris.material(pixel.hit.tri) as usize].kd,
                (false, Background::Plain(color)) => color,
                (false, Background::Gradient { bottom, .. }) => bottom,
            };
        }
        on_tile(&tile);
    }
    frame
}
