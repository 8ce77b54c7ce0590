//! One pixel, taken apart: every ray that had a part in its colour.

use crate::frame::{ShadeScratch, samples_of, trace_and_shade};
use crate::hits::EightHits;
use crate::item::{Item, Lit};
use crate::local::casts_shadow_rays;
use crate::shadow::{ShadowRay, look};
use crate::tree::{NO_PARENT, Node, RayKind};
use crate::{FrameStats, Scene, SceneNeeds, Surface};
use gz_core::{GzColor, GzCoord, GzRay, Hit, RayQuery, Tile};

/// Why a light adds to a hit what it does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sight {
    /// It adds nothing: it is behind the triangle, as the viewer sees it.
    Behind,
    /// It adds nothing: the shading equation gives 0.
    Nothing,
    /// It adds nothing: the shadow ray would run in the plane of the triangle.
    InPlane,
    /// No shadow ray was needed.
    Unasked,
    /// A shadow ray was cast.
    Cast {
        /// The ray.
        ray: ShadowRay,
        /// The share of the light that came through, channel by channel in [0, 1]: less than 1 behind tinted glass.
        share: GzColor,
        /// The front-most triangle on the ray that lets no light through; a miss if there is none.
        blocker: Hit,
    },
}

/// What one light adds to a hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightPart {
    /// Which of the scene's lights it is.
    pub light: usize,
    /// What it adds, shadow and tint included, before the rules clamp.
    pub color: GzColor,
    /// Why.
    pub sight: Sight,
}

/// One ray of a pixel.
#[derive(Clone, Debug, PartialEq)]
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
    /// The part of `local` that ambient light makes, before the rules clamp; 0 where no shading equation was computed.
    pub ambient: GzColor,
    /// The other parts of `local`, one for each light of the scene; empty where no shading equation was computed.
    pub lights: Vec<LightPart>,
    /// What `local` is multiplied by.
    pub keep: f32,
    /// What the parent multiplies `color` by.
    pub factor: GzColor,
    /// The colour that comes back along the ray: local * keep + the sum over children of factor * color, clamped where the rules
    /// clamp.
    pub color: GzColor,
}

/// All rays of pixel (`i`, `j`), column and row from the top left; parents come before their children, samples one after another.
pub fn explain_pixel(scene: &Scene, needs: SceneNeeds, query: &dyn RayQuery, i: u32, j: u32) -> Vec<ExplainNode> {
    let tile = Tile { x0: i, y0: j, x1: i.saturating_add(1), y1: j.saturating_add(1) };
    let (mut scratch, mut stats, mut list) = (ShadeScratch::default(), FrameStats::default(), Vec::new());
    for (sample, it) in samples_of(scene, needs).iter().enumerate() {
        trace_and_shade(scene, needs, query, &tile, it.offset, &mut scratch, &mut stats);
        let first = list.len();
        let tree = scratch.tree();
        let mut hits = tree.hits().iter().flat_map(|hits| (0..hits.count).map(move |k| (hits, k)));
        list.extend((0..).zip(&tree.nodes).map(|(id, node)| {
            let ray = tree.rays.ray(id, node, scene);
            let hit = if node.hit.is_hit() { hits.next() } else { None };
            let (ambient, lights) = parts(scene, needs, query, node, ray.direction, hit);
            ExplainNode {
                sample,
                sample_weight: it.weight,
                parent: (node.parent != NO_PARENT).then(|| first + node.parent as usize),
                kind: node.kind,
                depth: node.depth,
                ray,
                hit: node.hit,
                local: node.local,
                ambient,
                lights,
                keep: node.keep,
                factor: node.factor,
                color: node.color,
            }
        }));
    }
    list
}

/// The parts of the local colour of `node`, whose ray goes along `direction` and has the hit `hit` if any: by ambient light, and by each light.
fn parts(
    scene: &Scene,
    needs: SceneNeeds,
    query: &dyn RayQuery,
    node: &Node,
    direction: GzCoord,
    hit: Option<(&EightHits, usize)>,
) -> (GzColor, Vec<LightPart>) {
    let shaded = |(hits, k): &(&EightHits, usize)| node.keep != 0.0 && scene.material(hits.tris[*k]).surface == Surface::Shaded;
    let Some((hits, k)) = hit.filter(shaded) else { return (GzColor::ZERO, Vec::new()) };
    let item = Item::of(scene, needs, node, direction, hits, k);
    let part = |(light, it)| {
        let (color, sight) = match item.lit_by(scene, needs, (hits, k), it, casts_shadow_rays(scene, needs)) {
            Lit::Behind => (GzColor::ZERO, Sight::Behind),
            Lit::Nothing => (GzColor::ZERO, Sight::Nothing),
            Lit::InPlane => (GzColor::ZERO, Sight::InPlane),
            Lit::Adds { color, start: None } => (item.at_hit(color), Sight::Unasked),
            Lit::Adds { color, start: Some(ray) } => {
                let (share, blocker) = look(scene, query, &ray);
                (item.at_hit(color.map(|color| color * share)), Sight::Cast { ray, share, blocker })
            }
        };
        LightPart { light, color, sight }
    };
    (item.ambient(scene), scene.lights.iter().enumerate().map(part).collect())
}
