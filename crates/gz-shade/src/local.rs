//! Local colours: the shading equation at every hit of a tile that counts, light by light.

use crate::eight::{lanes, vector};
use crate::item::{Item, Lit};
use crate::lit::{EightItems, EightLit, LightAll};
use crate::shadow::{ShadowRays, Shadows};
use crate::tree::Tree;
use crate::{FrameStats, GzLight, LightKind, Scene, SceneNeeds, ShadowRule, Surface};
use gz_core::simd::dispatch;
use gz_core::{GzColor, RayQuery, SimdLevel};

/// What one light would add to an item if nothing were in the way.
#[derive(Debug)]
struct Addend {
    item: u32,
    color: [GzColor; 3],
}

/// Room for the shading of a tile, kept from tile to tile.
#[derive(Debug, Default)]
pub(crate) struct Lighting {
    items: Vec<Item>,
    /// The same items, eight at a time.
    eights: Vec<EightItems>,
    lit: Vec<EightLit>,
    addends: Vec<Addend>,
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
            if casting && !self.addends.is_empty() {
                stats.shadow_rays += self.addends.len() as u64;
                let common_direction = matches!(light.kind, LightKind::Directional(_));
                stats.tint_queries += self.shadows.trace(scene, query, &self.rays, common_direction);
            }
            for (ray, addend) in self.addends.iter().enumerate() {
                let share = if casting { self.shadows.shares[ray] } else { GzColor::ONE };
                let sum = &mut self.items[addend.item as usize].sum;
                (0..3).for_each(|corner| sum[corner] += addend.color[corner] * share);
            }
        }
        // 3. The sums are the colours.
        for item in &self.items {
            tree.nodes[item.node as usize].local = item.color(scene.rules.clamp_levels);
        }
    }

    /// The hits that lights shine on.
    fn collect(&mut self, scene: &Scene, needs: SceneNeeds, tree: &mut Tree) {
        self.items.clear();
        self.eights.clear();
        for (number, hits) in tree.hits.iter().enumerate() {
            let mut eight = EightItems::new(number, self.items.len());
            for k in 0..hits.count {
                let node = &mut tree.nodes[hits.nodes[k] as usize];
                if node.keep == 0.0 {
                    continue;
                }
                match scene.material(hits.tris[k]).surface {
                    Surface::AppColor => node.local = scene.tris.color(hits.tris[k]).unwrap_or(GzColor::ONE),
                    Surface::Shaded => {
                        let item = Item::of(scene, needs, node, hits, k);
                        eight.add(k, &item);
                        self.items.push(item);
                    }
                }
            }
            if eight.lanes != 0 {
                self.eights.push(eight);
            }
        }
    }

    /// What `light` would add to each item; its shadow rays when they are `casting`. An item that it adds nothing to has no ray.
    fn gather(
        &mut self,
        scene: &Scene,
        needs: SceneNeeds,
        tree: &Tree,
        light: &GzLight,
        casting: bool,
        stats: &mut FrameStats,
    ) {
        let Self { items, eights, lit, addends, rays, .. } = self;
        dispatch(SimdLevel::best(), LightAll { items: eights, hits: &tree.hits, light, casting, lit });
        addends.clear();
        rays.clear();
        for (eight, lit) in eights.iter().zip(lit) {
            let hits = &tree.hits[eight.hits];
            for (id, k) in (eight.first..).zip(lanes(eight.lanes)) {
                let lit = if lit.open >> k & 1 != 0 {
                    items[id].lit_by(scene, needs, (hits, k), light, casting)
                } else if lit.dark >> k & 1 != 0 {
                    Lit::Nothing
                } else {
                    let color = [lit.color(k), GzColor::ZERO, GzColor::ZERO];
                    let side = if lit.up >> k & 1 != 0 { 1 } else { -1 };
                    let arrival = light.arrive(vector(&hits.at.point, k));
                    Lit::of(scene, (hits, k), color, casting.then_some((&arrival, side)))
                };
                match lit {
                    Lit::Behind | Lit::Nothing => {}
                    Lit::InPlane => stats.absorbed += 1,
                    Lit::Adds { color, start } => {
                        start.iter().for_each(|start| rays.push(start));
                        addends.push(Addend { item: id as u32, color });
                    }
                }
            }
        }
    }
}

/// Whether shadow rays are cast at all.
pub(crate) fn casts_shadow_rays(scene: &Scene, needs: SceneNeeds) -> bool {
    needs.shadows && scene.rules.shadow != ShadowRule::Off && scene.has_secondary_rays()
}
