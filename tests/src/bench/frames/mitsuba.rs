//! Mitsuba 3 in its variant `scalar_rgb`, the Python package `mitsuba`.

use super::contender::{Contender, Turn, source};
use crate::bench::indexed::Indexed;
use crate::bench::timing::seconds;
use crate::bench::tools::{Venv, said};
use gz_app::error::AppError;
use gz_app::new_file::NewFile;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What pip fetches.
const PACKAGE: &str = "mitsuba==3.9.1";

/// Mitsuba with the scene in its own words.
#[derive(Debug)]
pub(super) struct Mitsuba {
    folder: PathBuf,
    python: PathBuf,
    depth: u32,
}

impl Mitsuba {
    /// Puts the scene into `folder`, and Mitsuba into `dir` if it is not there.
    ///
    /// # Errors
    ///
    /// If Mitsuba cannot be had or a file cannot be written.
    pub(super) fn new(dir: &Path, folder: &Path, depth: u32, teapots: &[(&str, Indexed)]) -> Result<Self, AppError> {
        let python = Venv::of(dir).with(&[PACKAGE], "mitsuba")?;
        for (name, mesh) in teapots {
            NewFile::at(&folder.join(format!("{name}.ply")))?.write(&ply_bytes(mesh))?;
        }
        Ok(Self { folder: folder.to_owned(), python, depth })
    }
}

impl Contender for Mitsuba {
    fn name(&self) -> String {
        format!("{} scalar_rgb", PACKAGE.replace("==", " "))
    }

    fn frame(&self, threads: usize, side: u32) -> Result<Turn, AppError> {
        let mut command = Command::new(&self.python);
        command.arg(source("teapots.py")).arg(&self.folder);
        command.args([threads.to_string(), side.to_string(), self.depth.to_string()]);
        let (whole, said) = seconds(|| said(&mut command, "Mitsuba"));
        let trace = trace_seconds(&said?.output).ok_or_else(|| AppError::Io("Mitsuba prints no trace time".to_owned()))?;
        Ok(Turn { trace, whole })
    }

    fn picture(&self) -> PathBuf {
        self.folder.join("mitsuba.png")
    }
}

/// From the line `trace 1.25`.
fn trace_seconds(text: &str) -> Option<f64> {
    text.lines().rev().find_map(|line| line.strip_prefix("trace "))?.trim().parse().ok()
}

/// A binary PLY file.
fn ply_bytes(mesh: &Indexed) -> Vec<u8> {
    let (vertices, triangles) = (mesh.vertices.len(), mesh.triangles.len());
    let head = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {triangles}\nproperty list uchar int vertex_indices\nend_header\n"
    );
    let mut bytes = head.into_bytes();
    bytes.extend(mesh.vertices.iter().flat_map(|p| p.to_array()).flat_map(f32::to_le_bytes));
    for triangle in &mesh.triangles {
        bytes.push(3);
        bytes.extend(triangle.iter().flat_map(|k| k.to_le_bytes()));
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use gz_core::GzCoord;

    #[test]
    fn the_last_time_that_it_prints_is_read() {
        assert_eq!(trace_seconds("a warning\ntrace 1.5\n"), Some(1.5));
        assert_eq!((trace_seconds("trace x"), trace_seconds("")), (None, None));
    }

    #[test]
    fn a_mesh_file_holds_vertices_and_triangles() {
        let bytes = ply_bytes(&Indexed::of(&[[GzCoord::X, GzCoord::Y, GzCoord::Z]]));
        let text = String::from_utf8_lossy(&bytes);
        assert!(text.starts_with("ply\n") && text.contains("element vertex 3\n") && text.contains("element face 1\n"));
        let body = bytes.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
        assert_eq!(bytes.len() - body, 3 * 12 + 13);
        assert_eq!(bytes[body + 36..], [3, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0]);
    }
}
