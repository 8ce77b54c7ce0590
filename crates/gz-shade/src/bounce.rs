//! Where a ray goes on at a mirror or at glass, and how much each branch counts.

use crate::interpolate::{normal, outside};
use crate::media::{Media, MediaStacks};
use crate::optics::reflectance;
use crate::reflection::reflect;
use crate::refraction::refract;
use crate::tree::{Node, RayKind};
use crate::{FrameStats, GlassBlend, MaterialKind, MirrorBlend, Scene, SceneNeeds};
use glam::DVec3;
use gz_core::{GzColor, GzCoord, GzRay, SurfacePoint};

/// Branches that weigh less than this of their pixel, in their strongest channel, end. It is a sixteenth of a step of a 12-bit
/// picture and less than a hundredth of one of an 8-bit picture, as long as what the branch sees is not much brighter than 1.
const LEAST_WEIGHT: f32 = 1.0 / 65536.0;

/// A ray that goes on from a hit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Branch {
    pub(crate) parent: u32,
    pub(crate) kind: RayKind,
    pub(crate) ray: GzRay,
    /// What the parent multiplies the branch's colour by.
    pub(crate) factor: GzColor,
    pub(crate) media: Media,
}

/// What happens at the hits of a level.
pub(crate) struct Bouncer<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) needs: SceneNeeds,
    pub(crate) media: &'a mut MediaStacks,
    pub(crate) branches: &'a mut Vec<Branch>,
    pub(crate) stats: &'a mut FrameStats,
}

/// How a ray meets a surface.
struct Meeting<'p> {
    at: &'p SurfacePoint,
    corners: &'p [GzCoord; 3],
    /// Direction of the ray, at length 1.
    d: DVec3,
    /// Shading normal at length 1, turned against the ray: d.n <= 0.
    n: DVec3,
    /// The side of the triangle that the ray goes to, as [`side_of`] has it.
    to_side: i8,
    /// The ray comes from outside.
    entering: bool,
}

impl Meeting<'_> {
    /// Cosine between the normal and the incoming ray, in [0, 1].
    fn cos(&self) -> f64 {
        (-self.d.dot(self.n)).clamp(0.0, 1.0)
    }

    /// d - 2 |d.n| n with the normal as it is stored: where the ray comes against that normal, the paper's refraction program turned
    /// the cosine and forgot the normal.
    fn mistaken_reflection(&self) -> GzCoord {
        let stored = if self.entering { self.n } else { -self.n };
        (self.d - stored * (2.0 * self.cos())).normalize_or_zero().as_vec3()
    }

    /// n1 / n2 as the paper's program has it, without media: a ray along the normal goes from air into `ior`, one against it comes
    /// out. That is the wrong way round for normals that point outside, and its refraction figure shows it.
    fn sheet_eta(&self, ior: f32) -> f64 {
        if self.entering { f64::from(ior) } else { 1.0 / f64::from(ior) }
    }
}

impl<'a> Bouncer<'a> {
    /// Adds the branches that go on from node `id`, which hits at `point`, and returns what its local colour is multiplied by.
    ///
    /// At the depth limit a hit has no branches and keeps its local colour whole.
    pub(crate) fn bounce(&mut self, id: u32, node: &Node, point: &'a SurfacePoint) -> f32 {
        match self.scene.material(node.hit.tri).kind {
            MaterialKind::Mirror { ior } if self.needs.mirrors => self.mirror(id, node, point, ior),
            MaterialKind::Glass { ior } if self.needs.glass => self.glass(id, node, point, ior),
            _ => 1.0,
        }
    }

    fn mirror(&mut self, id: u32, node: &Node, point: &'a SurfacePoint, ior: Option<f32>) -> f32 {
        let rules = &self.scene.rules;
        let mistaken = self.last_light(node).filter(|_| rules.reflect_last_light);
        let meeting = self.meet(node, point, mistaken);
        // 1. The reflected share: all of it at an ideal mirror and where the paper's program does not ask.
        let share = match (rules.mirror_blend, ior) {
            (MirrorBlend::Physical, Some(ior)) => {
                reflectance(rules.fresnel, meeting.cos(), self.media.ior(node.media) / f64::from(ior))
            }
            (MirrorBlend::Add, Some(ior)) => reflectance(rules.fresnel, meeting.cos(), meeting.sheet_eta(ior)),
            _ => 1.0,
        };
        let factor = self.scene.material(node.hit.tri).tint * share as f32;
        if self.is_cut(node, factor) {
            return 1.0;
        }
        // 2. The direction.
        let direction = match mistaken {
            Some(_) => Some(meeting.mistaken_reflection()).map(|d| (d, meeting.at.side_of(meeting.corners, d))),
            None => self.on_side(&meeting, reflect(meeting.d, meeting.n), -meeting.to_side),
        };
        let branch = Branch { parent: id, kind: RayKind::Mirror, ray: node.ray, factor, media: node.media };
        let goes_on = self.emit(node, &meeting, direction, branch);
        // 3. What is left of the local colour. Under Replace a miss will bring it back.
        match rules.mirror_blend {
            MirrorBlend::Physical => (1.0 - share) as f32,
            MirrorBlend::Replace => f32::from(u8::from(!goes_on)),
            MirrorBlend::Add => 1.0,
        }
    }

    fn glass(&mut self, id: u32, node: &Node, point: &'a SurfacePoint, ior: f32) -> f32 {
        let rules = &self.scene.rules;
        let meeting = self.meet(node, point, None);
        // 1. From which medium to which, and how much is reflected.
        let (eta, after, unmatched, share) = match rules.glass_blend {
            GlassBlend::Physical => {
                let medium = self.scene.tris.material(node.hit.tri);
                let crossing = self.media.cross(node.media, medium, f64::from(ior), meeting.entering);
                let eta = crossing.n1 / crossing.n2;
                (eta, crossing.after, crossing.unmatched, reflectance(rules.fresnel, meeting.cos(), eta) as f32)
            }
            GlassBlend::Add => (meeting.sheet_eta(ior), node.media, false, 0.0),
        };
        let refracted = refract(meeting.d, meeting.n, eta);
        let through = if refracted.is_some() { self.scene.material(node.hit.tri).tint * (1.0 - share) } else { GzColor::ZERO };
        if self.is_cut(node, through + share) {
            return 1.0;
        }
        self.stats.unmatched_exits += u64::from(unmatched);
        self.stats.total_reflections += u64::from(refracted.is_none());
        // 2. The reflected branch stays in its medium, the refracted one changes it.
        let branch = Branch { parent: id, kind: RayKind::Glass, ray: node.ray, factor: GzColor::splat(share), media: node.media };
        if share > 0.0 {
            let direction = self.on_side(&meeting, reflect(meeting.d, meeting.n), -meeting.to_side);
            self.emit(node, &meeting, direction, branch);
        }
        if let Some(refracted) = refracted {
            let direction = self.on_side(&meeting, refracted, meeting.to_side);
            self.emit(node, &meeting, direction, Branch { factor: through, media: after, ..branch });
        }
        1.0
    }

    /// The geometry of a hit at `at` as mirrors and glass see it: by the node's ray, or one along another direction that it is mistaken for.
    ///
    /// With geometric sides the triangle itself says where the ray comes from and whether that is outside; the shading normal, taken
    /// on that side, only bends directions. Where it leans away from the ray all the same (at the silhouette of a coarse mesh) it is
    /// brought back to where the ray grazes it: there all is reflected, as it is in the limit.
    fn meet(&self, node: &Node, at: &'a SurfacePoint, mistaken: Option<GzCoord>) -> Meeting<'a> {
        let tris = &self.scene.tris;
        let tri = node.hit.tri;
        let corners = tris.position(tri);
        let d = mistaken.unwrap_or(node.ray.direction).as_dvec3().normalize_or_zero();
        let n = normal(tris, self.needs, tri, at, self.scene.material(tri).interpolate, at.weights);
        let to_side = mistaken.map_or(at.to_side, |direction| at.side_of(corners, direction));
        if !self.scene.rules.geometric_sides {
            let entering = d.dot(n) < 0.0;
            return Meeting { at, corners, d, n: if entering { n } else { -n }, to_side, entering };
        }
        let entering = outside(tris, self.needs, tri, at) != to_side;
        let n = if entering { n } else { -n };
        let slope = d.dot(n);
        let n = if slope <= 0.0 { n } else { (n - d * slope).try_normalize().unwrap_or_else(|| at.normal * -f64::from(to_side)) };
        Meeting { at, corners, d, n, to_side, entering }
    }

    /// `direction` in f32 if it leads to `side` of the triangle; else mirrored at the triangle's plane and counted, which is the
    /// same direction in the limit. `None` if that lies in the plane. Without geometric sides any direction will do. Beside it the
    /// side that it leads to.
    fn on_side(&mut self, meeting: &Meeting<'_>, direction: DVec3, side: i8) -> Option<(GzCoord, i8)> {
        let rounded = direction.as_vec3();
        let leads_to = meeting.at.side_of(meeting.corners, rounded);
        if !self.scene.rules.geometric_sides || leads_to == side {
            return Some((rounded, leads_to));
        }
        self.stats.below_surface += 1;
        let mirrored = reflect(direction, meeting.at.normal).as_vec3();
        (meeting.at.side_of(meeting.corners, mirrored) == side).then_some((mirrored, side))
    }

    /// The direction to the last light, which the mistake behind the paper's refraction figure takes for the ray's own.
    fn last_light(&self, node: &Node) -> Option<GzCoord> {
        self.scene.lights.last().map(|light| light.arrive(node.ray.at(node.hit.t)).direction)
    }

    /// Adds `branch` along `direction`, with the side that it leads to, unless it weighs too little or has no way to go; returns whether it
    /// was added.
    fn emit(&mut self, node: &Node, meeting: &Meeting<'_>, direction: Option<(GzCoord, i8)>, branch: Branch) -> bool {
        let weight = (node.weight * branch.factor).max_element();
        if weight < LEAST_WEIGHT {
            self.stats.weak_branches += u64::from(weight > 0.0);
            self.stats.weak_weight = self.stats.weak_weight.saturating_add(FrameStats::units(weight));
            return false;
        }
        let policy = self.scene.rules.leave;
        let Some(ray) = direction.and_then(|(d, side)| policy.leave_at(meeting.corners, meeting.at, d, side)) else {
            self.stats.absorbed += 1;
            return false;
        };
        self.branches.push(Branch { ray, ..branch });
        true
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
