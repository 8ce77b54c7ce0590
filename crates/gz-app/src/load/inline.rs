//! Small meshes written into the scene file: floors, walls, mirrors.

use super::values::Xyz;
use crate::mesh::{Mesh, MeshTri};
use gz_core::{GzCoord, GzTextureIndex};

/// Two triangles (a, b, c) and (a, c, d), with texture coordinates (0, 0), (1, 0), (1, 1), (0, 1) at a, b, c, d.
///
/// Seen from the side on which a, b, c, d run counter-clockwise, the quad faces the viewer.
pub(super) fn quad(corners: &[Xyz; 4]) -> Mesh {
    let triangle = |k: [u32; 3]| MeshTri { position: k, normal: None, uv: Some(k), material: None };
    Mesh {
        positions: corners.iter().map(position).collect(),
        uvs: [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(GzTextureIndex::from_array).to_vec(),
        triangles: vec![triangle([0, 1, 2]), triangle([0, 2, 3])],
        ..Mesh::default()
    }
}

/// Triangles by their corners, with neither normals nor texture coordinates.
pub(super) fn triangles(corners: &[[Xyz; 3]]) -> Mesh {
    let starts = (0..).step_by(3).take(corners.len());
    Mesh {
        positions: corners.iter().flatten().map(position).collect(),
        triangles: starts.map(|k| MeshTri { position: [k, k + 1, k + 2], normal: None, uv: None, material: None }).collect(),
        ..Mesh::default()
    }
}

fn position(p: &Xyz) -> GzCoord {
    p.0.as_vec3()
}
