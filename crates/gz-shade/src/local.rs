//! Local colours: the shading equation at every hit of a tile that counts, light by light.

use crate::eight::{lanes, vector};
use crate::item::{Item, Lit};
use crate::lit::{EightItems, EightLit, LightAll};
use crate::shadow::{ShadowRay, ShadowRays, Shadows};
use crate::tree::Tree;
use crate::{Arrival, FrameStats, GzLight, LightKind, Scene, SceneNeeds, ShadowRule, Surface};
use gz_core::simd::dispatch;
use gz_core::{GzColor, RayQuery, SimdLevel};

/// What one light would add to a hit if nothing were in the way.
#[derive(Debug)]
struct Addend {
    /// Where among the eights the hit is.
    eight: u32,
    k: u32,
    color: GzColor,
}

/// Room for the shading of a tile, kept from tile to tile.
#[derive(Debug, Default)]
pub(crate) struct Lighting {
    /// The hits that are shaded, eight at a time.
    eights: Vec<EightItems>,
    lit: Vec<EightLit>,
    addends: Vec<Addend>,
    /// Hits that are shaded at the corners: their hits and places there; then what one light would add, by their numbers here.
    at_corners: Vec<(usize, usize, Item)>,
    corner_addends: Vec<(usize, [GzColor; 3])>,
    /// Those of `addends`, then those of `corner_addends`.
    rays: ShadowRays,
    shadows: Shadows,
}

impl Lighting {
    /// Gives every hit of `tree` whose local colour counts that colour. The shadow rays of one light are one batch.
    pub(crate) fn shade(
        &mut self,
        scene: &Scene,
        needs: SceneNeeds,
        query: &dyn RayQuery,
        tree: &mut Tree,
        stats: &mut FrameStats,
    ) {
        // 1. Ambient light, and what the lights will need.
        self.collect(scene, needs, tree);
        // 2. Light by light.
        let casting = casts_shadow_rays(scene, needs);
        for light in &scene.lights {
            self.gather(scene, needs, tree, light, casting, stats);
            if casting && self.rays.len() > 0 {
                stats.shadow_rays += self.rays.len() as u64;
                stats.tint_queries += self.shadows.trace(scene, query, &self.rays);
            }
            self.add(casting);
        }
        // 3. The sums are the colours.
        let (nodes, _, all) = tree.parts();
        for eight in &self.eights {
            for k in lanes(eight.lanes) {
                let (node, sum) = (all[eight.hits].nodes[k], eight.sum(k));
                let clamps = scene.rules.clamp_levels;
                nodes[node as usize].local = if clamps { sum.clamp(GzColor::ZERO, GzColor::ONE) } else { sum };
            }
        }
        for (hits, k, item) in &self.at_corners {
            nodes[all[*hits].nodes[*k] as usize].local = item.color(scene.rules.clamp_levels);
        }
    }

    /// The hits that lights shine on.
    fn collect(&mut self, scene: &Scene, needs: SceneNeeds, tree: &mut Tree) {
        self.eights.clear();
        self.at_corners.clear();
        let (nodes, rays, all) = tree.parts();
        for (number, hits) in all.iter().enumerate() {
            self.eights.push(EightItems::new(number, hits));
            let [.., eight] = &mut self.eights[..] else { continue };
            for k in 0..hits.count {
                let node = &mut nodes[hits.nodes[k] as usize];
                if node.keep == 0.0 {
                    continue;
                }
                match scene.material(hits.tris[k]).surface {
                    Surface::AppColor => node.local = scene.tris.color(hits.tris[k]).unwrap_or(GzColor::ONE),
                    Surface::Shaded => match Item::of(scene, needs, node, rays.directions[hits.nodes[k] as usize], hits, k) {
                        item if item.is_at_corners() => self.at_corners.push((number, k, item)),
                        item => eight.add(k, &item),
                    },
                }
            }
            if eight.lanes == 0 {
                self.eights.pop();
            }
        }
    }

    /// What `light` would add to each hit; its shadow rays when they are `casting`. A hit that it adds nothing to has no ray.
    fn gather(&mut self, scene: &Scene, needs: SceneNeeds, tree: &Tree, light: &GzLight, casting: bool, stats: &mut FrameStats) {
        let Self { eights, lit, addends, at_corners, corner_addends, rays, .. } = self;
        addends.clear();
        corner_addends.clear();
        rays.clear(matches!(light.kind, LightKind::Directional(_)));
        dispatch(SimdLevel::best(), LightAll { items: eights, hits: tree.hits(), light, casting, lit });
        for (number, (eight, lit)) in eights.iter().zip(lit).enumerate() {
            let hits = &tree.hits()[eight.hits];
            for k in lanes(eight.lanes & lit.open) {
                let id = hits.nodes[k] as usize;
                let item = Item::of(scene, needs, &tree.nodes[id], tree.rays.directions[id], hits, k);
                let lit = item.lit_by(scene, needs, (hits, k), light, casting);
                if let Some([color, ..]) = cast(lit, rays, stats) {
                    addends.push(Addend { eight: number as u32, k: k as u32, color });
                }
            }
            for k in lanes(eight.lanes & !lit.open & !lit.dark) {
                if casting {
                    let Arrival { direction, tmax, .. } = light.arrive(vector(&hits.at.point, k));
                    let (side, leaves) = (if lit.up >> k & 1 != 0 { 1 } else { -1 }, hits.tris[k]);
                    let cast = |origin| rays.push(&ShadowRay { origin, direction, tmax, leaves });
                    if hits.leave(scene, k, direction, side, cast).is_none() {
                        stats.absorbed += 1;
                        continue;
                    }
                }
                addends.push(Addend { eight: number as u32, k: k as u32, color: lit.color(k) });
            }
        }
        for (number, (hits, k, item)) in at_corners.iter().enumerate() {
            let lit = item.lit_by(scene, needs, (&tree.hits()[*hits], *k), light, casting);
            if let Some(color) = cast(lit, rays, stats) {
                corner_addends.push((number, color));
            }
        }
    }

    /// Adds what the light does add, now that it is known what is in its way if rays were `casting`.
    fn add(&mut self, casting: bool) {
        let mut shares = self.shadows.shares.iter();
        let mut share = || if casting { shares.next().copied().unwrap_or(GzColor::ONE) } else { GzColor::ONE };
        for &Addend { eight, k, color } in &self.addends {
            self.eights[eight as usize].brighten(k as usize, color * share());
        }
        for &(number, colors) in &self.corner_addends {
            let (sum, share) = (&mut self.at_corners[number].2.sum, share());
            (0..3).for_each(|corner| sum[corner] += colors[corner] * share);
        }
    }
}

/// What a light adds that meets a hit so, once its shadow ray, if it has one, is among `rays`.
#[inline]
fn cast(lit: Lit, rays: &mut ShadowRays, stats: &mut FrameStats) -> Option<[GzColor; 3]> {
    match lit {
        Lit::Behind | Lit::Nothing => None,
        Lit::InPlane => {
            stats.absorbed += 1;
            None
        }
        Lit::Adds { color, start } => {
            start.iter().for_each(|start| rays.push(start));
            Some(color)
        }
    }
}

/// Whether shadow rays are cast at all.
pub(crate) fn casts_shadow_rays(scene: &Scene, needs: SceneNeeds) -> bool {
    needs.shadows && scene.rules.shadow != ShadowRule::Off && scene.has_secondary_rays()
}
