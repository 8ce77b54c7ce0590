//! Where a ray goes on at a mirror or at glass, and how much each branch counts.

use crate::bend::{Bends, Meetings};
use crate::eight::{lanes, vector};
use crate::hits::EightHits;
use crate::media::{Media, MediaStacks};
use crate::rays::Rays;
use crate::reflection::reflect;
use crate::refraction::refract;
use crate::tree::{Node, RayKind};
use crate::{FrameStats, GlassBlend, MaterialKind, MirrorBlend, Scene, SceneNeeds};
use glam::DVec3;
use gz_core::{GzColor, GzCoord, side_of};

/// Branches that weigh less than this of their pixel, in their strongest channel, end. It is a sixteenth of a step of a 12-bit
/// picture and less than a hundredth of one of an 8-bit picture, as long as what the branch sees is not much brighter than 1.
const LEAST_WEIGHT: f32 = 1.0 / 65536.0;

/// A ray that goes on from a hit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Branch {
    pub(crate) parent: u32,
    pub(crate) kind: RayKind,
    /// It goes through the surface.
    pub(crate) refracted: bool,
    pub(crate) origin: DVec3,
    pub(crate) direction: GzCoord,
    /// What the parent multiplies the branch's colour by.
    pub(crate) factor: GzColor,
    pub(crate) media: Media,
}

/// What a branch is but for its ray.
#[derive(Clone, Copy)]
struct Bounce {
    kind: RayKind,
    refracted: bool,
    factor: GzColor,
    media: Media,
}

/// What happens at the hits of a level.
pub(crate) struct Bouncer<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) needs: SceneNeeds,
    pub(crate) media: &'a mut MediaStacks,
    pub(crate) branches: &'a mut Vec<Branch>,
    pub(crate) stats: &'a mut FrameStats,
}

/// One of eight hits, as a mirror or glass sees it.
#[derive(Clone, Copy)]
struct Spot<'h> {
    hits: &'h EightHits,
    meetings: &'h Meetings,
    bends: &'h Bends,
    k: usize,
}

impl Spot<'_> {
    /// The ray's direction, at length 1, and the shading normal turned against it.
    fn directions(&self) -> (DVec3, DVec3) {
        (vector(&self.meetings.d, self.k), vector(&self.meetings.n, self.k))
    }

    /// The side of the triangle that the ray goes to.
    fn goes_to(&self) -> i8 {
        self.meetings.to_side[self.k]
    }

    /// d - 2 |d.n| n with the normal as it is stored: where the ray comes against that normal, the paper's refraction program turned
    /// the cosine and forgot the normal.
    fn mistaken_reflection(&self) -> GzCoord {
        let (d, n) = self.directions();
        let stored = if self.meetings.entering >> self.k & 1 != 0 { n } else { -n };
        (d - stored * (2.0 * self.meetings.cos[self.k])).normalize_or_zero().as_vec3()
    }
}

/// n1 / n2 as the paper's program has it, without media: a ray along the normal goes from air into `ior`, one against it comes
/// out. That is the wrong way round for normals that point outside, and its refraction figure shows it.
fn sheet_eta(entering: bool, ior: f32) -> f64 {
    if entering { f64::from(ior) } else { 1.0 / f64::from(ior) }
}

/// The boundaries that eight rays come to.
struct Boundaries {
    /// n1 / n2; 1 where it does not matter.
    eta: [f64; 8],
    /// What rays are in that go through.
    after: [Media; 8],
    /// The lanes whose rays leave what they never entered.
    unmatched: u32,
}

impl Bouncer<'_> {
    /// Adds the branches that go on from `hits` and tells their nodes what the local colour is multiplied by.
    ///
    /// At the depth limit a hit has no branches and keeps its local colour whole.
    pub(crate) fn bounce(&mut self, hits: &EightHits, nodes: &mut [Node], rays: &Rays) {
        let scene = self.scene;
        let (mut mirrors, mut glass) = (0, 0);
        for k in 0..hits.count {
            match scene.material(hits.tris[k]).kind {
                MaterialKind::Mirror { .. } if self.needs.mirrors => mirrors |= 1 << k,
                MaterialKind::Glass { .. } if self.needs.glass => glass |= 1 << k,
                _ => {}
            }
        }
        if mirrors | glass == 0 {
            return;
        }
        // 1. Where do the rays come from?
        let mut directions = hits.nodes.map(|id| rays.directions[id as usize]);
        let mut to_side = hits.at.to_side;
        for k in lanes(if scene.rules.reflect_last_light { mirrors } else { 0 }) {
            if let Some(mistaken) = self.last_light(hits.nodes[k], &nodes[hits.nodes[k] as usize], rays) {
                directions[k] = mistaken;
                to_side[k] = side_of(scene.tris.position(hits.tris[k]), mistaken);
            }
        }
        let meetings = Meetings::of(hits, &directions, to_side, scene.rules.geometric_sides);
        // 2. From which medium to which, and where does that bend them to?
        let Boundaries { eta, after, unmatched } = self.boundaries(hits, mirrors | glass, &meetings, nodes);
        let bends = Bends::of(hits, &meetings, &eta, scene.rules.fresnel, glass != 0);
        // 3. What goes on?
        for k in lanes(mirrors | glass) {
            let (id, spot) = (hits.nodes[k], Spot { hits, meetings: &meetings, bends: &bends, k });
            let node = &nodes[id as usize];
            let keep = if mirrors >> k & 1 != 0 {
                self.mirror(id, node, spot)
            } else {
                self.glass(id, node, spot, eta[k], after[k], unmatched >> k & 1 != 0)
            };
            nodes[id as usize].keep = keep;
        }
    }

    fn boundaries(&mut self, hits: &EightHits, bouncing: u32, meetings: &Meetings, nodes: &[Node]) -> Boundaries {
        let mut found = Boundaries { eta: [1.0; 8], after: [Media::AIR; 8], unmatched: 0 };
        let (scene, rules) = (self.scene, &self.scene.rules);
        for k in lanes(bouncing) {
            let (media, entering) = (nodes[hits.nodes[k] as usize].media, meetings.entering >> k & 1 != 0);
            found.after[k] = media;
            found.eta[k] = match (scene.material(hits.tris[k]).kind, rules.mirror_blend, rules.glass_blend) {
                (MaterialKind::Mirror { ior: Some(ior) }, MirrorBlend::Physical, _) => self.media.ior(media) / f64::from(ior),
                (MaterialKind::Mirror { ior: Some(ior) }, MirrorBlend::Add, _) => sheet_eta(entering, ior),
                (MaterialKind::Glass { ior }, _, GlassBlend::Physical) => {
                    let crossing = self.media.cross(media, scene.tris.material(hits.tris[k]), f64::from(ior), entering);
                    found.after[k] = crossing.after;
                    found.unmatched |= u32::from(crossing.unmatched) << k;
                    crossing.n1 / crossing.n2
                }
                (MaterialKind::Glass { ior }, _, GlassBlend::Add) => sheet_eta(entering, ior),
                _ => 1.0,
            };
        }
        found
    }

    fn mirror(&mut self, id: u32, node: &Node, spot: Spot<'_>) -> f32 {
        let scene = self.scene;
        let rules = &scene.rules;
        let material = scene.material(node.hit.tri);
        // 1. The reflected share: all of it at an ideal mirror and where the paper's program does not ask.
        let asks = matches!(material.kind, MaterialKind::Mirror { ior: Some(_) }) && rules.mirror_blend != MirrorBlend::Replace;
        let share = if asks { spot.bends.share[spot.k] } else { 1.0 };
        let factor = material.tint * share as f32;
        if self.is_cut(node, factor) {
            return 1.0;
        }
        // 2. The direction.
        let direction = if rules.reflect_last_light && !scene.lights.is_empty() {
            let direction = spot.mistaken_reflection();
            Some((direction, side_of(scene.tris.position(node.hit.tri), direction)))
        } else {
            self.reflected(spot)
        };
        let goes_on =
            self.emit(id, node, spot, direction, Bounce { kind: RayKind::Mirror, refracted: false, factor, media: node.media });
        // 3. What is left of the local colour. Under Replace a miss will bring it back.
        match rules.mirror_blend {
            MirrorBlend::Physical => (1.0 - share) as f32,
            MirrorBlend::Replace => f32::from(u8::from(!goes_on)),
            MirrorBlend::Add => 1.0,
        }
    }

    fn glass(&mut self, id: u32, node: &Node, spot: Spot<'_>, eta: f64, after: Media, unmatched: bool) -> f32 {
        let scene = self.scene;
        // 1. How much is reflected, and how much goes through?
        let share = match scene.rules.glass_blend {
            GlassBlend::Physical => spot.bends.share[spot.k] as f32,
            GlassBlend::Add => 0.0,
        };
        let passes = spot.bends.total >> spot.k & 1 == 0;
        let through = if passes { scene.material(node.hit.tri).tint * (1.0 - share) } else { GzColor::ZERO };
        if self.is_cut(node, through + share) {
            return 1.0;
        }
        self.stats.unmatched_exits += u64::from(unmatched);
        self.stats.total_reflections += u64::from(!passes);
        // 2. The reflected branch stays in its medium, the refracted one changes it.
        let back = Bounce { kind: RayKind::Glass, refracted: false, factor: GzColor::splat(share), media: node.media };
        if share > 0.0 {
            let direction = self.reflected(spot);
            self.emit(id, node, spot, direction, back);
        }
        if passes {
            let (bent, to_side) = (spot.bends.refracted.lane(spot.k, &scene.tris, spot.hits), spot.goes_to());
            let direction = self.on_side(spot, bent, to_side, |d, n| refract(d, n, eta).unwrap_or(d));
            self.emit(id, node, spot, direction, Bounce { refracted: true, factor: through, media: after, ..back });
        }
        1.0
    }

    /// Where light is reflected to, and the side of the triangle that that is.
    #[inline(always)]
    fn reflected(&mut self, spot: Spot<'_>) -> Option<(GzCoord, i8)> {
        let bent = spot.bends.reflected.lane(spot.k, &self.scene.tris, spot.hits);
        self.on_side(spot, bent, -spot.goes_to(), reflect)
    }

    /// The direction `bent` if it leads to `side` of the triangle; else mirrored at the triangle's plane and counted, which is the same
    /// direction in the limit. `None` if that lies in the plane. Without geometric sides any direction will do. Beside it the side that it
    /// leads to. `bend` makes the direction in f64 from those of the ray and the normal.
    #[inline(always)]
    fn on_side(
        &mut self,
        spot: Spot<'_>,
        bent: (GzCoord, i8),
        side: i8,
        bend: impl Fn(DVec3, DVec3) -> DVec3,
    ) -> Option<(GzCoord, i8)> {
        if !self.scene.rules.geometric_sides || bent.1 == side {
            return Some(bent);
        }
        self.stats.below_surface += 1;
        let (d, n) = spot.directions();
        let mirrored = reflect(bend(d, n), vector(&spot.hits.at.normal, spot.k)).as_vec3();
        let corners = self.scene.tris.position(spot.hits.tris[spot.k]);
        (side_of(corners, mirrored) == side).then_some((mirrored, side))
    }

    /// The direction to the last light, which the mistake behind the paper's refraction figure takes for the ray's own.
    fn last_light(&self, id: u32, node: &Node, rays: &Rays) -> Option<GzCoord> {
        self.scene.lights.last().map(|light| light.arrive(rays.ray(id, node, self.scene).at(node.hit.t)).direction)
    }

    /// Adds a branch to node `id` along `direction`, with the side that it leads to, unless it weighs too little or has no way to go; returns
    /// whether it was added.
    #[inline]
    fn emit(&mut self, id: u32, node: &Node, spot: Spot<'_>, direction: Option<(GzCoord, i8)>, bounce: Bounce) -> bool {
        let Bounce { kind, refracted, factor, media } = bounce;
        let weight = (node.weight * factor).max_element();
        if weight < LEAST_WEIGHT {
            self.stats.weak_branches += u64::from(weight > 0.0);
            self.stats.weak_weight = self.stats.weak_weight.saturating_add(FrameStats::units(weight));
            return false;
        }
        let branches = &mut *self.branches;
        let went = direction.and_then(|(direction, side)| {
            spot.hits.leave(self.scene, spot.k, direction, side, |origin| {
                branches.push(Branch { parent: id, kind, refracted, origin, direction, factor, media });
            })
        });
        self.stats.absorbed += u64::from(went.is_none());
        went.is_some()
    }

    /// Whether the depth limit forbids branches here; counted, with the weight that they would have had.
    fn is_cut(&mut self, node: &Node, factor: GzColor) -> bool {
        let cut = node.depth >= self.scene.rules.depth;
        if cut {
            self.stats.depth_cuts += 1;
            let weight = FrameStats::units((node.weight * factor).max_element());
            self.stats.depth_cut_weight = self.stats.depth_cut_weight.saturating_add(weight);
        }
        cut
    }
}
