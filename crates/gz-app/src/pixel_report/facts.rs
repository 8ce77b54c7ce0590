//! What is known of a pixel, before it is told.

use super::walk::{Place, Tried, all_tried, places};
use crate::accel::Built;
use gz_bsp::VisitCount;
use gz_core::glam::{DVec2, DVec3};
use gz_core::kernel::plain;
use gz_core::{GzColor, GzRay, Hit, Kernel, Tile, TileGrid, TriBuffer};
use gz_shade::{ExplainNode, Frame, Scene, SceneNeeds, explain_pixel, shade_frame};

/// One pixel, taken apart.
pub(super) struct Facts<'s> {
    pub(super) scene: &'s Scene,
    pub(super) x: u32,
    pub(super) y: u32,
    /// The primary ray through the pixel itself, and its front-most hit.
    pub(super) ray: GzRay,
    pub(super) hit: Hit,
    /// What the walk to it visits; `None` by brute force.
    pub(super) visits: Option<VisitCount>,
    /// The nodes and leaves on that walk; none by brute force.
    pub(super) places: Vec<Place>,
    /// By brute force: what became of every triangle. None by a tree, where places have their own.
    pub(super) tried: Vec<Tried>,
    /// Every triangle on the ray, front to back.
    pub(super) on_ray: Vec<Hit>,
    /// The rays that have a part in the colour; parents come before their children.
    pub(super) nodes: Vec<ExplainNode>,
    /// For each of them its share of the pixel, and what its walk visits.
    pub(super) shares: Vec<GzColor>,
    pub(super) walks: Vec<Option<VisitCount>>,
    /// The pixel as it is rendered.
    pub(super) frame: Frame,
    /// What else was asked, and its answer.
    pub(super) compared: Option<(&'static str, Hit)>,
}

impl<'s> Facts<'s> {
    pub(super) fn of(scene: &'s Scene, needs: SceneNeeds, built: &Built<'_>, x: u32, y: u32) -> Self {
        let ray = scene.camera.ray(x, y, DVec2::ZERO);
        let nodes = explain_pixel(scene, needs, built.query(), x, y);
        let area = Tile { x0: x, y0: y, x1: x + 1, y1: y + 1 };
        Self {
            scene,
            x,
            y,
            ray,
            hit: built.query().closest_hit(&ray),
            visits: built.visits(&ray),
            places: places(built, &ray),
            tried: all_tried(built, &ray),
            on_ray: all_hits(&scene.tris, &ray),
            shares: shares(&nodes),
            walks: nodes.iter().map(|node| built.visits(&node.ray)).collect(),
            nodes,
            frame: shade_frame(scene, needs, built.query(), &TileGrid::of(area, 1), &|_| ()),
            compared: None,
        }
    }

    /// Whether what was compared has the same answer, to the bit.
    pub(super) fn agrees(&self) -> bool {
        self.compared.is_none_or(|(_, other)| bits(&other) == bits(&self.hit))
    }

    /// The name of a triangle's material.
    pub(super) fn material(&self, hit: &Hit) -> &str {
        let material = self.scene.materials.get(usize::from(self.scene.tris.material(hit.tri)));
        material.map_or("", |material| &material.name)
    }

    /// Where a hit lies.
    pub(super) fn point(&self, hit: &Hit) -> DVec3 {
        self.scene.tris.hit_point(hit)
    }
}

/// The bits of T, u and v, and the triangle.
pub(super) fn bits(hit: &Hit) -> [u32; 4] {
    [hit.t.to_bits(), hit.tri, hit.u.to_bits(), hit.v.to_bits()]
}

/// Of the pixel's colour, what one part of each ray's colour is: its sample's weight times all factors on the way.
fn shares(nodes: &[ExplainNode]) -> Vec<GzColor> {
    let mut shares: Vec<GzColor> = Vec::with_capacity(nodes.len());
    for node in nodes {
        let above = node.parent.map_or(GzColor::splat(node.sample_weight as f32), |parent| shares[parent]);
        shares.push(above * node.factor);
    }
    shares
}

/// Every triangle that the ray meets, by exact T-value as far as f32 tells it, then by number.
pub(super) fn all_hits(tris: &TriBuffer, ray: &GzRay) -> Vec<Hit> {
    if !ray.is_valid() {
        return Vec::new();
    }
    let alone = |(tri, corners)| plain(Kernel::Certified, ray, corners).map(|(t, u, v)| Hit { t, tri, u, v });
    let mut hits: Vec<Hit> = (0..).zip(tris.positions()).filter_map(alone).collect();
    hits.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.tri.cmp(&b.tri)));
    hits
}

#[cfg(test)]
mod tests {
    use super::*;
    use gz_core::GzCoord;

    #[test]
    fn all_triangles_on_a_ray_are_listed_front_to_back() {
        let at = |z: f32| [[-1.0, -1.0, z], [3.0, -1.0, z], [-1.0, 3.0, z]].map(GzCoord::from_array);
        let corners: Vec<GzCoord> = [at(5.0), at(2.0), at(-1.0), at(2.0)].concat();
        let tris = TriBuffer::from_indexed(&corners, &[[0, 1, 2], [3, 4, 5], [6, 7, 8], [9, 10, 11]]).unwrap();
        let hits = all_hits(&tris, &GzRay::new(GzCoord::ZERO, GzCoord::Z));
        assert_eq!(hits.iter().map(|hit| (hit.tri, hit.t)).collect::<Vec<_>>(), [(1, 2.0), (3, 2.0), (0, 5.0)]);
    }
}
