//! The course's triangle files.

use crate::error::LoadError;
use crate::mesh::{Mesh, MeshTri};
use gz_core::{GzCoord, GzTextureIndex};
use std::path::Path;

/// Loads a file of triangles: a word, then three times x y z nx ny nz u v.
///
/// # Errors
///
/// If the file cannot be read or a number is missing.
pub fn load(path: &Path) -> Result<Mesh, LoadError> {
    let text = std::fs::read_to_string(path).map_err(|error| LoadError::io(path, &error))?;
    let mut words = text.split_whitespace();
    let mut mesh = Mesh::default();
    while words.next().is_some() {
        let first = mesh.positions.len() as u32;
        for _ in 0..3 {
            let mut number = || words.next().and_then(|w| w.parse::<f32>().ok());
            let mut numbers = [0.0; 8];
            for value in &mut numbers {
                *value = number().ok_or_else(|| LoadError::bad(path, None, "a number is missing"))?;
            }
            let [x, y, z, nx, ny, nz, u, v] = numbers;
            mesh.positions.push(GzCoord::new(x, y, z));
            mesh.normals.push(GzCoord::new(nx, ny, nz));
            mesh.uvs.push(GzTextureIndex::new(u, v));
        }
        let corners = [first, first + 1, first + 2];
        mesh.triangles.push(MeshTri { position: corners, normal: Some(corners), uv: Some(corners), material: None });
    }
    Ok(mesh)
}
