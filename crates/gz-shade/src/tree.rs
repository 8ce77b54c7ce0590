//! The rays of pixels as trees: camera rays are the roots, mirror and glass rays their descendants.

use crate::bounce::{Bouncer, Branch};
use crate::crowd::Crowd;
use crate::flock::Flock;
use crate::hits::EightHits;
use crate::media::{Media, MediaStacks};
use crate::rays::Rays;
use crate::source::closest_hits;
use crate::{FrameStats, GlassBlend, MirrorBlend, Scene, SceneNeeds};
use glam::DVec3;
use gz_core::{ClassMask, GzColor, Hit, RayBatch, RayQuery, TriId};
use std::ops::Range;

/// What kind of ray it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayKind {
    /// From the camera.
    Primary,
    /// Reflected by a mirror.
    Mirror,
    /// Reflected or refracted by glass.
    Glass,
}

/// The parent of a node that has none.
pub(crate) const NO_PARENT: u32 = u32::MAX;

/// The most nodes that a tree of several roots grows to: about 400 bytes each, with what shading them takes.
pub(crate) const MAX_NODES: usize = 1 << 16;

/// A tree of several roots would pass [`MAX_NODES`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct TooLarge;

/// One ray, what it hit, and its part in the pixel's colour.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub(crate) parent: u32,
    /// The camera ray that it descends from.
    pub(crate) root: u32,
    pub(crate) kind: RayKind,
    /// 0 for a camera ray.
    pub(crate) depth: u32,
    pub(crate) hit: Hit,
    /// What the ray runs through.
    pub(crate) media: Media,
    /// What the parent multiplies this node's colour by.
    pub(crate) factor: GzColor,
    /// The product of the factors from here to the root.
    pub(crate) weight: GzColor,
    /// What the local colour is multiplied by: less than 1 where a mirror takes its place.
    pub(crate) keep: f32,
    /// Local colour of a hit; what a miss shows.
    pub(crate) local: GzColor,
    /// local * keep + sum over children of factor * color.
    pub(crate) color: GzColor,
}

impl Node {
    /// A camera ray, node `id`.
    pub(crate) fn root(id: u32, hit: Hit) -> Self {
        Self {
            parent: NO_PARENT,
            root: id,
            kind: RayKind::Primary,
            depth: 0,
            hit,
            media: Media::AIR,
            factor: GzColor::ONE,
            weight: GzColor::ONE,
            keep: 1.0,
            local: GzColor::ZERO,
            color: GzColor::ZERO,
        }
    }
}

/// All nodes of a tile or of a part of one, children after their parents, and the room that growing them takes.
#[derive(Debug, Default)]
pub(crate) struct Tree {
    pub(crate) nodes: Vec<Node>,
    pub(crate) rays: Rays,
    /// Where the rays of the nodes hit, in the order of the nodes: the first `eights`; behind them is room.
    hits: Vec<EightHits>,
    eights: usize,
    /// How many nodes have been looked at for that.
    met: usize,
    media: MediaStacks,
    branches: Vec<Branch>,
    crowd: Crowd,
    flock: Flock,
    leaves: Vec<TriId>,
    answers: Vec<Hit>,
}

impl Tree {
    /// Begins anew with some camera rays and their hits.
    pub(crate) fn plant(&mut self, rays: &RayBatch<'_>, hits: &[Hit], pixels: Range<usize>) {
        self.nodes.clear();
        self.rays.clear(rays.ray(pixels.start).tmin);
        for (id, pixel) in (0..).zip(pixels) {
            let ray = rays.ray(pixel);
            self.nodes.push(Node::root(id, hits[pixel]));
            self.rays.push(ray.origin, ray.direction);
        }
        self.eights = 0;
        self.met = 0;
        self.media.clear();
    }

    /// Finds where the rays of the nodes added last hit: of all that have not been looked at.
    pub(crate) fn meet(&mut self, scene: &Scene, needs: SceneNeeds) {
        let (mut ids, mut count) = ([0; 8], 0);
        for id in self.met..self.nodes.len() {
            if self.nodes[id].hit.is_hit() {
                ids[count] = id as u32;
                count += 1;
            }
            if count == 8 {
                self.take(scene, needs, &ids);
                count = 0;
            }
        }
        if count > 0 {
            self.take(scene, needs, &ids[..count]);
        }
        self.met = self.nodes.len();
    }

    fn take(&mut self, scene: &Scene, needs: SceneNeeds, ids: &[u32]) {
        if self.eights == self.hits.len() {
            self.hits.push(EightHits::NONE);
        }
        self.hits[self.eights].take(scene, needs, &self.nodes, &self.rays, ids);
        self.eights += 1;
    }

    /// The nodes, their rays, and where those hit: in the order of the nodes, eight at a time.
    pub(crate) fn parts(&mut self) -> (&mut [Node], &Rays, &[EightHits]) {
        (&mut self.nodes, &self.rays, &self.hits[..self.eights])
    }

    /// Where the rays of the nodes hit.
    pub(crate) fn hits(&self) -> &[EightHits] {
        &self.hits[..self.eights]
    }

    /// Follows mirror and glass rays, level by level, from the roots; each kind of a level is one batch. With a depth limit of 0 no
    /// bounce was asked for, and none counts as cut.
    ///
    /// A single root is always grown to the end, as [`Crowd`] limits what descends from it.
    ///
    /// # Errors
    ///
    /// [`TooLarge`] if there are several roots and more nodes than [`MAX_NODES`]; tree and `stats` are then of no use.
    pub(crate) fn grow(
        &mut self,
        scene: &Scene,
        needs: SceneNeeds,
        query: &dyn RayQuery,
        stats: &mut FrameStats,
    ) -> Result<(), TooLarge> {
        if !(needs.mirrors || needs.glass) || scene.rules.depth == 0 || !scene.has_secondary_rays() {
            return Ok(());
        }
        let roots = self.nodes.len();
        let mut level = 0..self.eights;
        while !level.is_empty() {
            // 1. Where do the hits of this level go on?
            self.branches.clear();
            let (media, branches) = (&mut self.media, &mut self.branches);
            let mut bouncer = Bouncer { scene, needs, media, branches, stats };
            for hits in &self.hits[level] {
                bouncer.bounce(hits, &mut self.nodes, &self.rays);
            }
            // 2. The heaviest of those rays are the next level.
            self.crowd.thin(&mut self.branches, &mut self.nodes, scene.rules.mirror_blend, stats);
            if roots > 1 && self.nodes.len() + self.branches.len() > MAX_NODES {
                return Err(TooLarge);
            }
            let first = self.eights;
            for kind in [RayKind::Mirror, RayKind::Glass] {
                self.trace(kind, scene, needs, query, stats);
            }
            level = first..self.eights;
        }
        Ok(())
    }

    /// Traces the branches of one kind as a batch and adds them as nodes.
    fn trace(&mut self, kind: RayKind, scene: &Scene, needs: SceneNeeds, query: &dyn RayQuery, stats: &mut FrameStats) {
        let first = self.nodes.len();
        self.leaves.clear();
        for &number in self.flock.order(&self.branches, kind) {
            let branch = &self.branches[number as usize];
            let parent = &self.nodes[branch.parent as usize];
            self.leaves.push(parent.hit.tri);
            self.rays.push(branch.origin, branch.direction);
            self.nodes.push(Node {
                parent: branch.parent,
                kind,
                depth: parent.depth + 1,
                media: branch.media,
                factor: branch.factor,
                weight: parent.weight * branch.factor,
                ..Node::root(parent.root, Hit::MISS)
            });
        }
        let count = self.nodes.len() - first;
        if count == 0 {
            return;
        }
        let rays = self.rays.batch(first, scene.rules.leave).leaving(&self.leaves);
        self.answers.clear();
        self.answers.resize(count, Hit::MISS);
        closest_hits(query, scene.rules.leave, &rays, ClassMask::ALL, &mut self.answers);
        for (id, &hit) in (first..).zip(&self.answers) {
            self.nodes[id].hit = hit;
            stats.secondary_hits += u64::from(hit.is_hit());
            if !hit.is_hit() && kind == RayKind::Mirror && scene.rules.mirror_blend == MirrorBlend::Replace {
                // Nothing to replace the mirror's own colour with.
                let parent = self.nodes[id].parent as usize;
                self.nodes[parent].keep = 1.0;
            }
        }
        self.meet(scene, needs);
        match kind {
            RayKind::Mirror => stats.mirror_rays += count as u64,
            _ => stats.glass_rays += count as u64,
        }
    }

    /// What rays that hit nothing show: the background where colours blend as in physics, else a secondary ray adds nothing.
    pub(crate) fn show_background(&mut self, scene: &Scene, up: DVec3) {
        for (node, direction) in self.nodes.iter_mut().zip(&self.rays.directions).filter(|(node, _)| !node.hit.is_hit()) {
            let shows = match node.kind {
                RayKind::Primary => true,
                RayKind::Mirror => scene.rules.mirror_blend == MirrorBlend::Physical,
                RayKind::Glass => scene.rules.glass_blend == GlassBlend::Physical,
            };
            if shows {
                node.local = scene.background.color(direction.as_dvec3(), up);
            }
        }
    }

    /// Combines colours from the leaves to the roots.
    ///
    /// The backward sweep meets children before their parents, and always in the same order.
    pub(crate) fn combine(&mut self, clamp_levels: bool) {
        for node in &mut self.nodes {
            node.color = if node.keep == 0.0 { GzColor::ZERO } else { node.local * node.keep };
        }
        for id in (0..self.nodes.len()).rev() {
            let node = &mut self.nodes[id];
            if clamp_levels {
                node.color = node.color.clamp(GzColor::ZERO, GzColor::ONE);
            }
            let (parent, share) = (node.parent, node.factor * node.color);
            if parent != NO_PARENT {
                self.nodes[parent as usize].color += share;
            }
        }
    }
}
