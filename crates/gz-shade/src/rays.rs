//! The rays of a tree's nodes.

use crate::Scene;
use crate::tree::{NO_PARENT, Node};
use glam::DVec3;
use gz_core::{GzCoord, GzRay, LeavePolicy, PerRay, RayBatch};

/// The rays of nodes, by their numbers: two lists, which batches are parts of.
#[derive(Debug, Default)]
pub(crate) struct Rays {
    origins: Vec<DVec3>,
    pub(crate) directions: Vec<GzCoord>,
    /// Where camera rays begin to count.
    first_tmin: f32,
}

impl Rays {
    /// Forgets all rays; the next are camera rays that count from `tmin`.
    pub(crate) fn clear(&mut self, tmin: f32) {
        self.origins.clear();
        self.directions.clear();
        self.first_tmin = tmin;
    }

    /// Adds the ray of the next node.
    pub(crate) fn push(&mut self, origin: DVec3, direction: GzCoord) {
        self.origins.push(origin);
        self.directions.push(direction);
    }

    /// The ray of node `id`.
    pub(crate) fn ray(&self, id: u32, node: &Node, scene: &Scene) -> GzRay {
        let tmin = if node.parent == NO_PARENT { self.first_tmin } else { scene.rules.leave.tmin() };
        GzRay { tmin, ..GzRay::from_f64(self.origins[id as usize], self.directions[id as usize]) }
    }

    /// Origins and directions of eight rays.
    pub(crate) fn eight(&self, ids: &[u32; 8]) -> ([[f64; 3]; 8], [[f32; 3]; 8]) {
        (ids.map(|id| self.origins[id as usize].to_array()), ids.map(|id| self.directions[id as usize].to_array()))
    }

    /// The rays from number `first` on, which leave surfaces by `policy`.
    pub(crate) fn batch(&self, first: usize, policy: LeavePolicy) -> RayBatch<'_> {
        let (origins, directions) = (PerRay::Each(&self.origins[first..]), PerRay::Each(&self.directions[first..]));
        let (tmin, tmax) = (PerRay::One(policy.tmin()), PerRay::One(f32::INFINITY));
        RayBatch::new(self.origins.len() - first, origins, directions, tmin, tmax)
    }
}
