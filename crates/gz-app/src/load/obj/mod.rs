//! OBJ files.

use crate::error::LoadError;
use crate::mesh::{Mesh, MeshTri};
use gz_core::{GzCoord, GzTextureIndex};
use std::path::Path;

/// Loads triangles with positions, texture coordinates and normals.
///
/// # Errors
///
/// If the file cannot be read or a line cannot be understood.
pub fn load(path: &Path) -> Result<Mesh, LoadError> {
    let text = std::fs::read_to_string(path).map_err(|error| LoadError::io(path, &error))?;
    let mut mesh = Mesh::default();
    for (n, line) in text.lines().enumerate() {
        let bad = || LoadError::bad(path, n + 1, format!("cannot be read: {line}"));
        let mut words = line.split_whitespace();
        let keyword = words.next().unwrap_or_default();
        let rest: Vec<&str> = words.collect();
        let numbers = || rest.iter().map(|w| w.parse::<f32>().map_err(|_| bad())).collect::<Result<Vec<_>, _>>();
        match keyword {
            "v" => mesh.positions.push(<[f32; 3]>::try_from(numbers()?).map(GzCoord::from_array).map_err(|_| bad())?),
            "vn" => mesh.normals.push(<[f32; 3]>::try_from(numbers()?).map(GzCoord::from_array).map_err(|_| bad())?),
            "vt" => mesh.uvs.push(<[f32; 2]>::try_from(numbers()?).map(GzTextureIndex::from_array).map_err(|_| bad())?),
            "f" => {
                let corner = |k: usize, field: usize| -> Option<u32> {
                    rest.get(k)?.split('/').nth(field)?.parse::<u32>().ok()?.checked_sub(1)
                };
                let three = |field| Some([corner(0, field)?, corner(1, field)?, corner(2, field)?]);
                let position = three(0).ok_or_else(bad)?;
                if position.iter().any(|&k| k as usize >= mesh.positions.len()) {
                    return Err(bad());
                }
                mesh.triangles.push(MeshTri { position, normal: three(2), uv: three(1), material: None });
            }
            _ => {}
        }
    }
    if mesh.triangles.is_empty() {
        return Err(LoadError::bad(path, None, "no triangles"));
    }
    Ok(mesh)
}
