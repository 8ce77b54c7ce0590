//! One pixel, taken apart: every ray that had a part in its colour.

use crate::frame::{ShadeScratch, samples_of, trace_and_shade};
use crate::tree::{NO_PARENT, RayKind};
use crate::{FrameStats, Scene, SceneNeeds};
use gz_core::{GzColor, GzRay, Hit, RayQuery, Tile};

/// One ray of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExplainNode {
    /// Which sample of the pixel it belongs to, from 0.
    pub sample: usize,
    /// How much that sample counts.
    pub sample_weight: f64,
    /// The node that this ray goes on from; `None` for a camera ray.
    pub parent: Option<usize>,
    /// What kind of ray it is.
    pub kind: RayKind,
    /// Bounces since the camera.
    pub depth: u32,
    /// The ray.
    pub ray: GzRay,
    /// What it hit.
    pub hit: Hit,
    /// Colour of the hit by itself, or what the ray shows that hit nothing. Not computed, and 0, where `keep` is 0.
    pub local: GzColor,
    /// What `local` is multiplied by.
    pub keep: f32,
    /// What the parent multiplies `color` by.
    pub factor: GzColor,
    /// The colour that comes back along the ray: local * keep + the sum over children of factor * color, clamped where the rules
    /// clamp.
    pub color: GzColor,
}

/// All rays of pixel (`i`, `j`), column and row from the top left; parents come before their children, samples one after another.
///
/// Shadow rays are not listed; their effect is in `local`.
pub fn explain_pixel(scene: &Scene, needs: SceneNeeds, query: &dyn RayQuery, i: u32, j: u32) -> Vec<ExplainNode> {
    let tile = Tile { x0: i, y0: j, x1: i.saturating_add(1), y1: j.saturating_add(1) };
    let (mut scratch, mut stats, mut list) = (ShadeScratch::default(), FrameStats::default(), Vec::new());
    for (sample, it) in samples_of(scene, needs).iter().enumerate() {
        trace_and_shade(scene, needs, query, &tile, it.offset, &mut scratch, &mut stats);
        let first = list.len();
        list.extend(scratch.nodes().iter().map(|node| ExplainNode {
            sample,
            sample_weight: it.weight,
            parent: (node.parent != NO_PARENT).then(|| first + node.parent as usize),
            kind: node.kind,
            depth: node.depth,
            ray: node.ray,
            hit: node.hit,
            local: node.local,
            keep: node.keep,
            factor: node.factor,
            color: node.color,
        }));
    }
    list
}
