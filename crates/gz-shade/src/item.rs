//! A hit that is shaded, by itself: what the shading equation needs of it, and how one light meets it.

use crate::eight::vector;
use crate::hits::EightHits;
use crate::interpolate;
use crate::phong::{Coefficients, light_share};
use crate::shadow::ShadowRay;
use crate::tree::Node;
use crate::{Arrival, Eye, GzLight, Interpolate, Material, Scene, SceneNeeds, Texture};
use glam::DVec3;
use gz_core::{GzColor, GzCoord};

/// A hit that is shaded.
#[derive(Debug)]
pub(crate) struct Item {
    /// Where it is shaded at the corners.
    pub(crate) corners: Option<AtCorners>,
    /// The unit normal, where it is not that of the hit.
    pub(crate) n: Option<DVec3>,
    /// To the viewer.
    pub(crate) e: GzCoord,
    /// The side of the triangle that the viewer is on; 0 when normals alone decide which lights count.
    pub(crate) viewer: i8,
    pub(crate) k: Coefficients,
    /// The equation so far, at the hit or at each corner.
    pub(crate) sum: [GzColor; 3],
}

/// What becomes of colours at the corners.
#[derive(Debug)]
pub(crate) struct AtCorners {
    /// The weights of the corners: linear in screen space where the rules say so.
    weights: [f64; 3],
    /// Multiplies the interpolated colour.
    texture: GzColor,
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

impl Lit {
    /// Of a light that would add `color` to hit `k` of `hits`; that casts a shadow ray if it says how it arrives, to which side.
    pub(crate) fn of(
        scene: &Scene,
        (hits, k): (&EightHits, usize),
        color: [GzColor; 3],
        casting: Option<(&Arrival, i8)>,
    ) -> Self {
        let Some((arrival, side)) = casting else { return Self::Adds { color, start: None } };
        let (leaves, direction) = (hits.tris[k], arrival.direction);
        let ray = |origin| ShadowRay { origin, direction, tmax: arrival.tmax, leaves };
        match hits.leave(scene, k, direction, side, ray) {
            Some(ray) => Self::Adds { color, start: Some(ray) },
            None => Self::InPlane,
        }
    }
}

impl Item {
    /// Hit `k` of `hits`, that of `node`, whose ray goes along `direction`, before any light.
    #[inline(always)]
    pub(crate) fn of(scene: &Scene, needs: SceneNeeds, node: &Node, direction: GzCoord, hits: &EightHits, k: usize) -> Self {
        let (tris, rules, tri) = (&scene.tris, &scene.rules, hits.tris[k]);
        let material = scene.material(tri);
        let at_hit = || hits.at.weights.map(|row| row[k]);
        let on_screen = rules.screen_interpolation && node.depth == 0;
        let weights = || if on_screen { scene.camera.screen_weights(tris.position(tri), at_hit()) } else { at_hit() };
        let at_corners = needs.gouraud && material.interpolate == Interpolate::Gouraud;
        let n = (on_screen && !at_corners)
            .then(|| interpolate::normal(tris, needs, tri, &hits.at.lane(k), material.interpolate, weights()));
        let e = match rules.eye {
            Eye::Ray => -direction,
            Eye::Fixed => GzCoord::NEG_Z,
        };
        let geometric = rules.geometric_sides && scene.has_secondary_rays();
        let viewer = if geometric { -hits.at.to_side[k] } else { 0 };

        let texture = texture_of(scene, needs, material).map(|it| it.color(interpolate::uv(tris, tri, at_hit())));
        let ks = material.ks;
        let (ka, kd, ks) = match texture {
            // Corners are shaded white; the texture multiplies highlights too.
            Some(_) if at_corners => (GzColor::ONE, GzColor::ONE, GzColor::ONE),
            // The texture is what the surface scatters.
            Some(color) => (color, color, ks),
            None => (material.ka, material.kd, ks),
        };
        let corners = at_corners.then(|| AtCorners { weights: weights(), texture: texture.unwrap_or(GzColor::ONE) });
        let k = Coefficients { ka, kd, ks, power: material.power };
        Self { corners, n, e, viewer, k, sum: [ka * scene.ambient; 3] }
    }

    /// Whether it is shaded at the corners instead of at the hit.
    pub(crate) fn is_at_corners(&self) -> bool {
        self.corners.is_some()
    }

    /// How `light` meets it, hit `k` of `hits`, and its shadow ray when they are `casting`.
    pub(crate) fn lit_by(
        &self,
        scene: &Scene,
        needs: SceneNeeds,
        (hits, k): (&EightHits, usize),
        light: &GzLight,
        casting: bool,
    ) -> Lit {
        let tri = hits.tris[k];
        let (at, corners, e) = (hits.at.lane(k), scene.tris.position(tri), self.e.as_dvec3());
        let arrival = light.arrive(at.point);
        let side = if self.viewer != 0 || casting { at.side_of(corners, arrival.direction) } else { 0 };
        if self.viewer != 0 && side != self.viewer {
            return Lit::Behind;
        }
        let color = if self.is_at_corners() {
            let normals = interpolate::normals_at_corners(&scene.tris, needs, tri, &at);
            std::array::from_fn(|corner| {
                let arrival = light.arrive(corners[corner].as_dvec3());
                light_share(&self.k, normals[corner], arrival.to_light, e) * arrival.color
            })
        } else {
            let n = self.n.unwrap_or_else(|| vector(&hits.normal, k));
            [light_share(&self.k, n, arrival.to_light, e) * arrival.color, GzColor::ZERO, GzColor::ZERO]
        };
        if color == [GzColor::ZERO; 3] {
            return Lit::Nothing;
        }
        Lit::of(scene, (hits, k), color, casting.then_some((&arrival, side)))
    }

    /// The colour, once every light has been added.
    pub(crate) fn color(&self, clamp: bool) -> GzColor {
        let limit = |color: GzColor| if clamp { color.clamp(GzColor::ZERO, GzColor::ONE) } else { color };
        self.at_hit(self.sum.map(limit))
    }

    /// The part of the sum that ambient light makes, before any clamp.
    pub(crate) fn ambient(&self, scene: &Scene) -> GzColor {
        self.at_hit([self.k.ka * scene.ambient; 3])
    }

    /// What colours at the hit or at each corner are at the hit.
    pub(crate) fn at_hit(&self, color: [GzColor; 3]) -> GzColor {
        match &self.corners {
            Some(AtCorners { weights, texture }) => interpolate::color(color, *weights) * *texture,
            None => color[0],
        }
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
