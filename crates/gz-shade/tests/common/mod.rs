//! Small scenes made by hand, and a query that counts.
#![allow(dead_code, unreachable_pub)] // each test program includes this file and uses a part of it

use gz_core::glam::DVec3;
use gz_core::{
    Attributes, BruteForce, CameraModel, CameraSpec, ClassMask, GzCamera, GzColor, GzCoord, GzTextureIndex, GzTri, Hit,
    MaterialId, RayBatch, RayQuery, TileGrid, TriBuffer, View,
};
use gz_shade::*;
use std::sync::atomic::{AtomicU64, Ordering};

pub const SIZE: u32 = 16;

/// A scene in the making. Starts empty, black, unlit, under [`ShadeRules::PHYSICAL`], seen along -z from (0, 0, 5).
#[derive(Clone)]
pub struct Made {
    pub tris: Vec<GzTri>,
    pub materials: Vec<Material>,
    pub lights: Vec<GzLight>,
    pub textures: Vec<Texture>,
    pub ambient: GzColor,
    pub background: Background,
    pub rules: ShadeRules,
    pub camera: CameraSpec,
}

impl Default for Made {
    fn default() -> Self {
        Self {
            tris: Vec::new(),
            materials: Vec::new(),
            lights: Vec::new(),
            textures: Vec::new(),
            ambient: GzColor::ZERO,
            background: Background::Plain(GzColor::ZERO),
            rules: ShadeRules::PHYSICAL,
            camera: looking([0.0, 0.0, 5.0], [0.0; 3], 40.0),
        }
    }
}

/// A pinhole camera, [`SIZE`] pixels square.
pub fn looking(position: [f64; 3], look_at: [f64; 3], fov: f64) -> CameraSpec {
    let (position, look_at) = (DVec3::from_array(position), DVec3::from_array(look_at));
    let view = View { position, look_at, up: DVec3::new(0.01, 1.0, 0.02), fov };
    CameraSpec { model: CameraModel::Pinhole, view: Some(view), width: SIZE, height: SIZE }
}

/// A material with nothing but its kind: no light of its own.
pub fn dark(kind: MaterialKind) -> Material {
    let zero = GzColor::ZERO;
    Material { name: "dark".into(), ka: zero, kd: zero, ks: zero, kind, interpolate: Interpolate::Flat, ..Material::default() }
}

/// White, matt, flat.
pub fn matt() -> Material {
    Material { name: "matt".into(), ks: GzColor::ZERO, interpolate: Interpolate::Flat, ..Material::default() }
}

pub fn sun(to_light: [f64; 3]) -> GzLight {
    GzLight { kind: LightKind::Directional(DVec3::from_array(to_light).normalize()), color: GzColor::ONE }
}

pub fn lamp(position: [f64; 3]) -> GzLight {
    GzLight { kind: LightKind::Point { position: DVec3::from_array(position), falloff: Falloff::NONE }, color: GzColor::ONE }
}

impl Made {
    pub fn material(&mut self, material: Material) -> MaterialId {
        self.materials.push(material);
        (self.materials.len() - 1) as MaterialId
    }

    /// A flat four-cornered face, two triangles, with `normal` at its corners.
    pub fn quad(&mut self, corners: [[f32; 3]; 4], normal: [f32; 3], material: MaterialId) -> &mut Self {
        let uvs = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(GzTextureIndex::from_array);
        for [a, b, c] in [[0, 1, 2], [0, 2, 3]] {
            let at = |k: usize| GzCoord::from_array(corners[k]);
            self.tris.push(GzTri {
                positions: [at(a), at(b), at(c)],
                normals: [GzCoord::from_array(normal).normalize(); 3],
                uvs: [uvs[a], uvs[b], uvs[c]],
                color: GzColor::new(0.25, 0.5, 0.75),
                material,
                ..GzTri::default()
            });
        }
        self
    }

    /// A square of half-width `r` at height `z` that faces +z.
    pub fn wall(&mut self, z: f32, r: f32, material: MaterialId) -> &mut Self {
        self.quad([[-r, -r, z], [r, -r, z], [r, r, z], [-r, r, z]], [0.0, 0.0, 1.0], material)
    }

    /// A closed box with its normals outside, or inside where `hollow`: a cavity in what surrounds it.
    pub fn block(&mut self, low: [f32; 3], high: [f32; 3], hollow: bool, material: MaterialId) -> &mut Self {
        for axis in 0..3 {
            let (s, t) = ((axis + 1) % 3, (axis + 2) % 3);
            for end in [low, high] {
                let corner = |on_s: [f32; 3], on_t: [f32; 3]| {
                    let mut p = end;
                    (p[s], p[t]) = (on_s[s], on_t[t]);
                    p
                };
                let mut normal = [0.0; 3];
                normal[axis] = if (end == high) != hollow { 1.0 } else { -1.0 };
                let corners = [corner(low, low), corner(high, low), corner(high, high), corner(low, high)];
                self.quad(corners, normal, material);
            }
        }
        self
    }

    /// The scene with the shading data that `needs` of it asks for, or all.
    pub fn scene(&self, needs: Option<SceneNeeds>) -> Scene {
        let mut used = vec![0; self.materials.len()];
        for tri in &self.tris {
            used[usize::from(tri.material)] += 1;
        }
        let mut scene = Scene {
            tris: TriBuffer::new(),
            camera: GzCamera::new(self.camera).unwrap(),
            lights: self.lights.clone(),
            ambient: self.ambient,
            background: self.background,
            materials: self.materials.clone(),
            used,
            textures: self.textures.clone(),
            rules: self.rules,
        };
        let keep = needs.unwrap_or_else(|| SceneNeeds::of(&scene)).attributes();
        scene.tris = fill(&self.tris, &self.materials, keep);
        scene
    }

    /// The whole picture, with the needs that it has.
    pub fn shade(&self) -> Frame {
        let scene = self.scene(None);
        shade_with(&scene, SceneNeeds::of(&scene), 8)
    }

    /// The colour in the middle.
    pub fn middle(&self) -> GzColor {
        self.shade().colors[(SIZE * SIZE / 2 + SIZE / 2) as usize]
    }

    /// The rays of one pixel.
    pub fn explain(&self, i: u32, j: u32) -> Vec<ExplainNode> {
        let scene = self.scene(None);
        explain_pixel(&scene, SceneNeeds::of(&scene), &BruteForce::new(&scene.tris), i, j)
    }
}

fn fill(tris: &[GzTri], materials: &[Material], keep: Attributes) -> TriBuffer {
    let mut buffer = TriBuffer::with_attributes(keep, tris.len());
    for tri in tris {
        buffer.push(&GzTri { class: materials[usize::from(tri.material)].class(), ..*tri }).unwrap();
    }
    buffer
}

/// The whole picture in tiles of `size`.
pub fn shade_with(scene: &Scene, needs: SceneNeeds, size: u32) -> Frame {
    let grid = TileGrid::whole(scene.camera.width(), scene.camera.height(), size);
    shade_frame(scene, needs, &BruteForce::new(&scene.tris), &grid, &|_| {})
}

/// The ray that carries most of a pixel's colour from a hit or from the background: the heaviest node without children.
pub fn heaviest_leaf(nodes: &[ExplainNode]) -> ExplainNode {
    let weight = |mut k: usize| {
        let mut weight = 1.0;
        while let Some(parent) = nodes[k].parent {
            weight *= nodes[k].factor.max_element();
            k = parent;
        }
        weight
    };
    let is_leaf = |k: &usize| !nodes.iter().any(|node| node.parent == Some(*k));
    let best = (0..nodes.len()).filter(is_leaf).max_by(|&a, &b| f32::total_cmp(&weight(a), &weight(b)));
    nodes[best.unwrap()].clone()
}

/// Counts the rays that pass to brute force.
pub struct Counted<'a> {
    pub brute: BruteForce<'a>,
    pub closest: AtomicU64,
    pub any: AtomicU64,
}

impl<'a> Counted<'a> {
    pub fn new(tris: &'a TriBuffer) -> Self {
        Self { brute: BruteForce::new(tris), closest: AtomicU64::new(0), any: AtomicU64::new(0) }
    }
}

impl RayQuery for Counted<'_> {
    fn tris(&self) -> &TriBuffer {
        self.brute.tris()
    }

    fn closest_hits(&self, rays: &RayBatch<'_>, classes: ClassMask, hits: &mut [Hit]) {
        self.closest.fetch_add(rays.len() as u64, Ordering::Relaxed);
        self.brute.closest_hits(rays, classes, hits);
    }

    fn any_hits(&self, rays: &RayBatch<'_>, classes: ClassMask, occluded: &mut [bool]) {
        // A question about opaque triangles alone is a further one about glass, which `closest` has the others of.
        let counter = if classes == ClassMask::ALL { &self.any } else { &self.closest };
        counter.fetch_add(rays.len() as u64, Ordering::Relaxed);
        self.brute.any_hits(rays, classes, occluded);
    }
}
