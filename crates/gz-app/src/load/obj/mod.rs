//! OBJ meshes with their MTL materials.
//!
//! `tobj` reads the MTL records (behind checks, see `load/mtl.rs`) but not the faces. It starts a new model at every group and
//! material and so loses the order that triangle numbers follow, takes `l 1 2 3` for a triangle, fans every polygon, drops
//! the vertex behind a byte order mark, and has no line numbers. Before it could be trusted with a line, the line would have to
//! be parsed, resolved and rewritten, which is all the work of reading it; a file of 10 million triangles, 1.1 GB, which takes
//! this reader about 6 s and 1.7 GB, would take 11 s and 2.1 GB more. So where `tobj` is right it serves as the judge: the tests
//! hold this reader to its triangles, bit for bit.

mod faces;
mod vertices;

#[cfg(test)]
mod hard_cases;
#[cfg(test)]
mod tests;

use super::{mtl, text};
use crate::error::LoadError;
use crate::mesh::{Mesh, MeshMaterial};
use std::collections::HashMap;
use std::path::Path;
use vertices::Vertices;

/// The longest OBJ file that is read, in bytes: 4 GiB.
pub const MAX_FILE: u64 = 4 << 30;
/// The longest line, in bytes: 16 MiB, continuations included.
pub const MAX_LINE: usize = 16 << 20;
/// The most triangles of one mesh; they take 48 bytes each.
pub const MAX_TRIANGLES: usize = 100_000_000;
/// The most names that are listed in warnings of one kind.
const MAX_NAMED: usize = 20;

/// The mesh in the OBJ file at `path`, and the materials of its `mtllib` files.
///
/// Triangles are numbered in file order over all groups and materials. A polygon of n corners gives n - 2: the fan from its first
/// corner when it is convex, else its ears in the order that `load/polygon.rs` states. Repeated corners stay and count; points,
/// lines and faces of fewer than three corners do not. A triangle has texture coordinates, or normals, only if the file gives
/// them for all three corners. Normals become unit length; those of length 0 count as not given. `v x y z w` is divided by w;
/// vertex colours and the third texture coordinate are passed over.
///
/// Lines end in LF, CR or CRLF; `\` continues them; a `#` starts a comment. Text that is not UTF-8 counts as Latin-1.
/// What is odd but usable is in [`Mesh::warnings`].
///
/// # Errors
///
/// With file and line: a number that is none or not finite, an index of 0 or out of range, a concave polygon of more than 4096
/// corners, a library or texture outside the folder of the OBJ file, a value in an MTL file that is out of range. Without: a file
/// that cannot be read, is beyond [`MAX_FILE`] or [`MAX_TRIANGLES`], or has no triangles.
pub fn load(path: &Path) -> Result<Mesh, LoadError> {
    parse(path, &text::read_text(path, MAX_FILE)?)
}

/// As [`load`], with the bytes of the OBJ file given.
fn parse(path: &Path, bytes: &[u8]) -> Result<Mesh, LoadError> {
    let mut warnings = Vec::new();
    // One pass for vertices, so that faces may name vertices that come later, and so that sizes are known before memory is taken.
    let vertices = vertices::read(path, bytes, &mut warnings)?;
    if vertices.triangles == 0 {
        return Err(LoadError::bad(path, None, "no triangles"));
    }
    if vertices.triangles > MAX_TRIANGLES {
        let message = format!("{} triangles: more than {MAX_TRIANGLES}, the most that are read", vertices.triangles);
        return Err(LoadError::bad(path, None, message));
    }
    let mut materials = Materials::default();
    load_libraries(path, &vertices, &mut materials, &mut warnings)?;
    let (triangles, smoothing) = faces::read(path, bytes, &vertices, &materials, &mut warnings)?;
    let Vertices { positions, uvs, normals, .. } = vertices;
    Ok(Mesh { positions, normals, uvs, triangles, smoothing, materials: materials.list, warnings })
}

/// Materials in the order of their first `newmtl`, and their numbers by name.
#[derive(Default)]
pub(super) struct Materials {
    pub(super) list: Vec<MeshMaterial>,
    pub(super) numbers: HashMap<String, u16>,
}

impl Materials {
    /// Adds a material; true when it replaced one of that name, at whose place it then is. `None` beyond 65536.
    pub(super) fn put(&mut self, material: MeshMaterial) -> Option<bool> {
        if let Some(&number) = self.numbers.get(&material.name) {
            self.list[usize::from(number)] = material;
            return Some(true);
        }
        self.numbers.insert(material.name.clone(), u16::try_from(self.list.len()).ok()?);
        self.list.push(material);
        Some(false)
    }
}

/// Reads every library named by `mtllib`, each once.
fn load_libraries(
    path: &Path,
    vertices: &Vertices,
    materials: &mut Materials,
    warnings: &mut Vec<String>,
) -> Result<(), LoadError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut seen = Vec::new();
    for (line, names) in &vertices.libraries {
        // A name may hold blanks, and a line may hold several names: a file of the whole name decides.
        let whole = mtl::inside(names).is_some_and(|name| folder.join(name).is_file());
        let names: Vec<&str> = if whole { vec![names] } else { names.split_whitespace().collect() };
        for name in names {
            let Some(inside) = mtl::inside(name) else {
                let message = format!("material library {name:?} is outside the folder of the mesh");
                return Err(LoadError::bad(path, *line, message));
            };
            let library = folder.join(&inside);
            if seen.contains(&library) {
                continue;
            }
            match text::read_text(&library, mtl::MAX_FILE) {
                Ok(bytes) => mtl::read(&library, folder, &bytes, materials, warnings)?,
                Err(error) if error.io => {
                    warnings.push(text::warning(path, *line, format!("material library {name:?}: {}", error.message)));
                }
                Err(error) => return Err(error),
            }
            seen.push(library);
        }
    }
    Ok(())
}
