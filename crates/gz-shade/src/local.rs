//! Local colours: the shading equation at every hit of a tile that counts, light by light.

use crate::interpolate;
use crate::phong::{Coefficients, light_share};
use crate::shadow::{ShadowRay, ShadowRays, Shadows};
use crate::tree::{Node, Tree};
use crate::{Eye, FrameStats, GzLight, Interpolate, LightKind, Material, Scene, SceneNeeds, ShadowRule, Surface, Texture};
use glam::DVec3;
use gz_core::{GzColor, GzCoord, GzRay, RayQuery, SurfacePoint, TriId};

/// A hit that is shaded.
#[derive(Debug)]
pub(crate) struct Item {
    node: u32,
    tri: TriId,
    corners: [GzCoord; 3],
    at: SurfacePoint,
    /// Weights for colours and normals: linear in screen space where the rules say so.
    weights: [f64; 3],
    /// Shaded at the corners instead of at the hit.
    at_corners: bool,
    /// Unit normal at the hit; unused when shaded at the corners.
    n: DVec3,
    /// To the viewer.
    e: DVec3,
    /// The side of the triangle that the viewer is on; 0 when normals alone decide which lights count.
    viewer: i8,
    k: Coefficients,
    /// Multiplies the interpolated corner colours.
    texture: GzColor,
    /// The equation so far, at the hit or at each corner.
    sum: [GzColor; 3],
}

/// How one light meets an item, before anything in the way is asked for.
pub(crate) enum Lit {
    /// The light is behind the triangle.
    Behind,
    /// The equation gives nothing.
    Nothing,
    /// The shadow ray would run in the plane of the triangle.
    InPlane,
    /// The light adds `color`, at the hit or at each corner, times what its shadow ray says; without one when none is cast.
    Adds { color: [GzColor; 3], start: Option<ShadowRay> },
}

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
        self.items.clear();
        let counting = |(_, (node, _)): &(usize, (&mut Node, _))| node.hit.is_hit() && node.keep != 0.0;
        for (id, (node, point)) in tree.nodes.iter_mut().zip(&tree.points).enumerate().filter(counting) {
            match scene.material(node.hit.tri).surface {
                Surface::AppColor => node.local = scene.tris.color(node.hit.tri).unwrap_or(GzColor::ONE),
                Surface::Shaded => self.items.push(Item::of(scene, needs, id as u32, node, point)),
            }
        }
        // 2. Light by light.
        let casting = casts_shadow_rays(scene, needs);
        for light in &scene.lights {
            self.gather(scene, needs, light, casting, stats);
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

    /// What `light` would add to each item; its shadow rays when they are `casting`. An item that it adds nothing to has no ray.
    fn gather(&mut self, scene: &Scene, needs: SceneNeeds, light: &GzLight, casting: bool, stats: &mut FrameStats) {
        self.addends.clear();
        self.rays.clear();
        for (id, item) in self.items.iter().enumerate() {
            let (color, start) = match item.lit_by(scene, needs, light, casting) {
                Lit::Behind | Lit::Nothing => continue,
                Lit::InPlane => {
                    stats.absorbed += 1;
                    continue;
                }
                Lit::Adds { color, start } => (color, start),
            };
            if let Some(start) = start {
                self.rays.push(&start);
            }
            self.addends.push(Addend { item: id as u32, color });
        }
    }
}

/// Whether shadow rays are cast at all.
pub(crate) fn casts_shadow_rays(scene: &Scene, needs: SceneNeeds) -> bool {
    needs.shadows && scene.rules.shadow != ShadowRule::Off && scene.has_secondary_rays()
}

impl Item {
    /// The hit of `node`, at `point`, before any light.
    pub(crate) fn of(scene: &Scene, needs: SceneNeeds, id: u32, node: &Node, point: &SurfacePoint) -> Self {
        let (tris, rules, tri) = (&scene.tris, &scene.rules, node.hit.tri);
        let material = scene.material(tri);
        let (at, corners) = (*point, *tris.position(tri));
        let weights = if rules.screen_interpolation && node.depth == 0 {
            scene.camera.screen_weights(&corners, at.weights)
        } else {
            at.weights
        };
        let at_corners = needs.gouraud && material.interpolate == Interpolate::Gouraud;
        let n = if at_corners { DVec3::ZERO } else { interpolate::normal(tris, needs, tri, &at, material.interpolate, weights) };
        let e = match rules.eye {
            Eye::Ray => -node.ray.direction.as_dvec3(),
            Eye::Fixed => DVec3::NEG_Z,
        };
        let geometric = rules.geometric_sides && scene.has_secondary_rays();
        let viewer = if geometric { -at.to_side } else { 0 };

        let mut k = Coefficients { ka: material.ka, kd: material.kd, ks: material.ks, power: material.power };
        let mut texture = GzColor::ONE;
        if let Some(color) = texture_of(scene, needs, material).map(|it| it.color(interpolate::uv(tris, tri, at.weights))) {
            if at_corners {
                // Corners are shaded white; the texture multiplies highlights too.
                k = Coefficients { ka: GzColor::ONE, kd: GzColor::ONE, ks: GzColor::ONE, ..k };
                texture = color;
            } else {
                // The texture is what the surface scatters.
                k = Coefficients { ka: color, kd: color, ..k };
            }
        }
        let sum = [k.ka * scene.ambient; 3];
        Self { node: id, tri, corners, at, weights, at_corners, n, e, viewer, k, texture, sum }
    }

    /// How `light` meets it, and its shadow ray when they are `casting`.
    pub(crate) fn lit_by(&self, scene: &Scene, needs: SceneNeeds, light: &GzLight, casting: bool) -> Lit {
        let arrival = light.arrive(self.at.point);
        let side = if self.viewer != 0 || casting { self.at.side_of(&self.corners, arrival.direction) } else { 0 };
        if self.viewer != 0 && side != self.viewer {
            return Lit::Behind;
        }
        let color = if self.at_corners {
            let normals = interpolate::normals_at_corners(&scene.tris, needs, self.tri, &self.at);
            std::array::from_fn(|corner| {
                let arrival = light.arrive(self.corners[corner].as_dvec3());
                light_share(&self.k, normals[corner], arrival.to_light, self.e) * arrival.color
            })
        } else {
            [light_share(&self.k, self.n, arrival.to_light, self.e) * arrival.color, GzColor::ZERO, GzColor::ZERO]
        };
        if color == [GzColor::ZERO; 3] {
            return Lit::Nothing;
        }
        if !casting {
            return Lit::Adds { color, start: None };
        }
        match scene.rules.leave.leave_at(&self.corners, &self.at, arrival.direction, side) {
            Some(GzRay { origin, direction, .. }) => {
                Lit::Adds { color, start: Some(ShadowRay { origin, direction, tmax: arrival.tmax, leaves: self.tri }) }
            }
            None => Lit::InPlane,
        }
    }

    /// The colour, once every light has been added.
    fn color(&self, clamp: bool) -> GzColor {
        let limit = |color: GzColor| if clamp { color.clamp(GzColor::ZERO, GzColor::ONE) } else { color };
        self.at_hit(self.sum.map(limit))
    }

    /// The part of the sum that ambient light makes, before any clamp.
    pub(crate) fn ambient(&self, scene: &Scene) -> GzColor {
        self.at_hit([self.k.ka * scene.ambient; 3])
    }

    /// What colours at the hit or at each corner are at the hit.
    pub(crate) fn at_hit(&self, color: [GzColor; 3]) -> GzColor {
        if self.at_corners { interpolate::color(color, self.weights) * self.texture } else { color[0] }
    }
}

/// The texture that colours a material, if any.
fn texture_of<'a>(scene: &'a Scene, needs: SceneNeeds, material: &Material) -> Option<&'a Texture> {
    if material.interpolate == Interpolate::Flat && !scene.rules.flat_textures {
        return None;
    }
    let texture = scene.textures.get(material.texture?)?;
    let needed = match texture {
        Texture::Image(_) => needs.image_textures,
        Texture::Procedural(_) => needs.procedural_textures,
    };
    needed.then_some(texture)
}
