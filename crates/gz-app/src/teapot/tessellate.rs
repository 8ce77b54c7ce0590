//! Triangles from the teapot's patches.

use super::bezier::{Patch, Weights};
use super::patches::{COURSE_LID_TIP, LID_TIP, PATCHES, WITHOUT_BOTTOM};
use crate::mesh::{Mesh, MeshTri};
use glam::DVec3;
use gz_core::{GzCoord, GzTextureIndex};
use rayon::prelude::*;

/// The finest tessellation: 400 segments make 10 240 000 triangles of 32 patches.
pub const MAX_SEGMENTS: u32 = 400;

/// Lowest height of the body's foot above Newell's origin. The bottom fills what is below it.
const FOOT: f64 = 0.15;

/// The number of triangles of [`tessellate`]: 2 `segments`^2 a patch, 32 patches with the bottom and 28 without.
pub fn triangle_count(segments: u32, bottom: bool) -> usize {
    let segments = segments.clamp(1, MAX_SEGMENTS) as usize;
    patch_count(bottom) * segments * segments * 2
}

/// The teapot in model space, y up, standing on y = 0 around the y axis, the spout towards +x and the handle towards -x.
///
/// Each patch becomes `segments` by `segments` quads of two triangles, `segments` being 1 to [`MAX_SEGMENTS`] (what is beyond is
/// taken as the nearest of these; scene files refuse it earlier). With `bottom` there are all 32 patches, heights 0 to 3.15; without
/// it the course's 28, heights 0 to 3, and at 4 segments the course's own triangles, in its order, to the digits of its files.
///
/// Normals come from the patches' derivatives, outward. Texture coordinates run from 0 to 1 over each patch: u around, v from the
/// rim down (along handle and spout; from the lid's tip outward). Corners that two patches share have equal bits, so the mesh has
/// no seams; it is open only where the model is: between lid and body, at both ends of handle and spout, which stand inside the
/// body or end freely, and at the foot when there is no bottom. Where a patch runs together in one point, at the lid's tip and in
/// the middle of the bottom, half of its first triangles have no area: they stay, numbered and never hit, so that the count is
/// always [`triangle_count`]. The course's version has tiny loops at the lid's tip instead, and no such triangle.
pub fn tessellate(segments: u32, bottom: bool) -> Mesh {
    let n = segments.clamp(1, MAX_SEGMENTS);
    let weights: Vec<Weights> = (0..=n).map(|k| Weights::at(k, n)).collect();
    let patches: Vec<TeapotPatch> = (0..patch_count(bottom)).map(|k| TeapotPatch::new(k, bottom)).collect();

    // Vertex i + (n + 1) j of a patch: i down the rows, j across them.
    let columns: Vec<(&TeapotPatch, &Weights)> =
        patches.iter().flat_map(|patch| weights.iter().map(move |across| (patch, across))).collect();
    let drop = if bottom { 0.0 } else { FOOT };
    let vertices: Vec<Vec<(GzCoord, GzCoord)>> =
        columns.into_par_iter().map(|(patch, across)| patch.column(across, &weights, drop)).collect();
    let mut mesh = Mesh::default();
    let corners = (n as usize + 1) * (n as usize + 1);
    mesh.positions.reserve_exact(corners * patches.len());
    mesh.normals.reserve_exact(corners * patches.len());
    for (position, normal) in vertices.into_iter().flatten() {
        mesh.positions.push(position);
        mesh.normals.push(normal);
    }

    // One grid of texture coordinates serves every patch.
    let part = |k: u32| (f64::from(k) / f64::from(n)) as f32;
    mesh.uvs = (0..=n).flat_map(|j| (0..=n).map(move |i| GzTextureIndex::new(part(j), part(i)))).collect();
    mesh.triangles = (0..patches.len() as u32 * n)
        .into_par_iter()
        .flat_map_iter(|strip| {
            let (patch, j) = (strip / n, strip % n);
            (0..n).flat_map(move |i| quad(n, i, j).map(|uv| triangle(uv, patch * (n + 1) * (n + 1))))
        })
        .collect();
    mesh
}

fn patch_count(bottom: bool) -> usize {
    if bottom { PATCHES.len() } else { WITHOUT_BOTTOM }
}

/// The two triangles of quad (`i`, `j`) within one patch, wound so that (b - a) x (c - a) points outward.
fn quad(n: u32, i: u32, j: u32) -> [[u32; 3]; 2] {
    let at = |i: u32, j: u32| j * (n + 1) + i;
    [[at(i, j), at(i, j + 1), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i + 1, j)]]
}

/// A triangle with these corners of the patch whose vertices begin at `first`.
fn triangle(uv: [u32; 3], first: u32) -> MeshTri {
    let corners = uv.map(|k| first + k);
    MeshTri { position: corners, normal: Some(corners), uv: Some(uv), material: None }
}

/// A patch of the teapot, and where it differs at its first row, the one that normals are taken from there.
#[derive(Clone, Copy, Debug)]
struct TeapotPatch {
    patch: Patch,
    /// The patch without the loops of the course's lid tip: within a loop the surface folds and its normal looks into the pot.
    without_loops: Option<Patch>,
}

impl TeapotPatch {
    fn new(k: usize, bottom: bool) -> Self {
        let patch = Patch::new(&PATCHES[k]);
        let loops = k.checked_sub(LID_TIP).and_then(|tip| COURSE_LID_TIP.get(tip)).filter(|_| !bottom);
        let Some(first) = loops else { return Self { patch, without_loops: None } };
        let mut indices = PATCHES[k];
        indices[..4].copy_from_slice(first);
        Self { patch: Patch::new(&indices), without_loops: Some(patch) }
    }

    /// Positions and normals down one column, lowered by `drop`.
    fn column(&self, across: &Weights, weights: &[Weights], drop: f64) -> Vec<(GzCoord, GzCoord)> {
        let column = self.patch.column(across);
        let lowered = |p: DVec3| DVec3::new(p.x, p.y - drop, p.z).as_vec3();
        let mut corners: Vec<_> =
            weights.iter().map(|down| (lowered(column.point(down)), column.normal(down).as_vec3())).collect();
        if let Some(patch) = self.without_loops {
            corners[0].1 = patch.column(across).normal(&weights[0]).as_vec3();
        }
        corners
    }
}

#[cfg(test)]
#[path = "tests.rs"]
mod tests;
