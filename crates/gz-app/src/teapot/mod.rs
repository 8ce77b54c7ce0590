//! The Utah teapot.

use crate::mesh::{Mesh, MeshTri};
use gz_core::{GzCoord, GzTextureIndex};

/// The teapot with `segments` quads along each side of each patch.
pub fn tessellate(segments: u32, bottom: bool) -> Mesh {
    let mut mesh = Mesh::default();
    for patch in 0..if bottom { 32 } else { 28 } {
        for k in 0..segments * segments {
            let (i, j) = ((k % segments) as f32, (k / segments) as f32);
            let first = mesh.positions.len() as u32;
            for (x, y) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
                mesh.positions.push(GzCoord::new(i + x, j + y, patch as f32));
                mesh.normals.push(GzCoord::Z);
                mesh.uvs.push(GzTextureIndex::new(i + x, j + y) / segments as f32);
            }
            for corners in [[0, 1, 2], [0, 2, 3]] {
                let corners = corners.map(|c| c + first);
                mesh.triangles.push(MeshTri { position: corners, normal: Some(corners), uv: Some(corners), material: None });
            }
        }
    }
    mesh
}
