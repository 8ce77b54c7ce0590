//! POV-Ray 3.7, the Debian package `povray`.

use super::contender::{Contender, Rays, Turn, copy, number_before};
use crate::bench::indexed::Indexed;
use crate::bench::timing::seconds;
use crate::bench::tools::said;
use gz_app::error::AppError;
use gz_app::new_file::NewFile;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

/// POV-Ray with the scene in its own words.
#[derive(Debug)]
pub(super) struct Povray {
    folder: PathBuf,
    version: String,
    depth: u32,
}

impl Povray {
    /// Puts the scene into `folder`; `None` where there is no POV-Ray.
    ///
    /// # Errors
    ///
    /// If a file cannot be written.
    pub(super) fn new(folder: &Path, depth: u32, teapots: &[(&str, Indexed)]) -> Result<Option<Self>, AppError> {
        let Some(version) = version() else { return Ok(None) };
        for (name, mesh) in teapots {
            NewFile::at(&folder.join(format!("{name}.inc")))?.write(mesh_text(mesh).as_bytes())?;
        }
        copy("teapots.pov", folder)?;
        Ok(Some(Self { folder: folder.to_owned(), version, depth }))
    }

    /// Its rays by kind for a picture of this size, from three runs that are not timed.
    ///
    /// It counts the rays of the last level that it cuts; so bounces are counted with a level less. Of shadow rays it counts the surfaces
    /// that they meet; so they are counted with glass that casts no shadow, where that is one for each ray.
    ///
    /// # Errors
    ///
    /// If it fails.
    pub(super) fn rays(&self, side: u32) -> Result<Rays, AppError> {
        let count = |levels: u32, declared: &[&str]| {
            let text = self.run(1, side, levels, declared)?;
            Counts::of(&text).ok_or_else(|| AppError::Io("POV-Ray prints no statistics".to_owned()))
        };
        let (bounces, shadows, all) =
            (count(self.depth, &[])?, count(self.depth + 1, &["Count=1"])?, count(self.depth + 1, &[])?);
        Ok(Rays {
            primary: bounces.pixels,
            bounced: bounces.reflected + bounces.refracted,
            shadow: shadows.shadow,
            shadow_questions: all.shadow,
        })
    }

    /// Renders; gives what it prints.
    fn run(&self, threads: usize, side: u32, levels: u32, declared: &[&str]) -> Result<String, AppError> {
        let mut command = Command::new("povray");
        // No antialiasing, no window; it may write into its own folder only.
        command.current_dir(&self.folder).args(["+Iteapots.pov", "+Opovray.png", "-A", "-D"]);
        command.args([format!("+W{side}"), format!("+H{side}"), format!("+WT{threads}"), format!("Declare=Levels={levels}")]);
        command.args(declared.iter().map(|what| format!("Declare={what}")));
        Ok(said(&mut command, "POV-Ray")?.errors)
    }
}

impl Contender for Povray {
    fn name(&self) -> String {
        self.version.clone()
    }

    fn frame(&self, threads: usize, side: u32) -> Result<Turn, AppError> {
        let (whole, text) = seconds(|| self.run(threads, side, self.depth + 1, &[]));
        let trace = trace_seconds(&text?).ok_or_else(|| AppError::Io("POV-Ray prints no trace time".to_owned()))?;
        Ok(Turn { trace, whole })
    }

    fn picture(&self) -> PathBuf {
        self.folder.join("povray.png")
    }
}

/// What it calls itself, such as `POV-Ray 3.7.0.10.unofficial`.
fn version() -> Option<String> {
    let output = Command::new("povray").arg("--version").output().ok()?;
    let text = String::from_utf8_lossy(&output.stderr).into_owned() + &String::from_utf8_lossy(&output.stdout);
    Some(text.lines().find(|line| line.starts_with("POV-Ray"))?.trim().to_owned())
}

/// The inside of a `mesh2`.
fn mesh_text(mesh: &Indexed) -> String {
    let mut text = format!("vertex_vectors {{ {}", mesh.vertices.len());
    for p in &mesh.vertices {
        // Writing to a string never fails. The shortest digits that give the same f32.
        let _ = write!(text, ",\n<{},{},{}>", p.x, p.y, p.z);
    }
    let _ = write!(text, " }}\nface_indices {{ {}", mesh.triangles.len());
    for [a, b, c] in &mesh.triangles {
        let _ = write!(text, ",\n<{a},{b},{c}>");
    }
    text + " }\n"
}

/// From the line `Trace Time: 0 hours 0 minutes 7 seconds (7.123 seconds)`.
fn trace_seconds(text: &str) -> Option<f64> {
    let line = text.split(['\n', '\r']).rfind(|line| line.trim_start().starts_with("Trace Time"))?;
    number_before(line.rsplit_once('(')?.1, " seconds")
}

/// What it counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Counts {
    pixels: u64,
    reflected: u64,
    refracted: u64,
    shadow: u64,
}

impl Counts {
    /// From its statistics. Lines of counts that are 0 are not printed.
    fn of(text: &str) -> Option<Self> {
        let count = |name: &str| {
            let after = text.split(['\n', '\r']).find_map(|line| line.trim_start().strip_prefix(name))?;
            after.split_whitespace().next()?.parse::<u64>().ok()
        };
        Some(Self {
            pixels: count("Pixels:")?,
            reflected: count("Reflected Rays:").unwrap_or(0),
            refracted: count("Refracted Rays:").unwrap_or(0) + count("Transmitted Rays:").unwrap_or(0),
            shadow: count("Shadow Ray Tests:").unwrap_or(0),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gz_core::GzCoord;

    const SAID: &str = "Rendered 1024 of 65536 pixels (1%)\rRendered 65536 of 65536 pixels (100%)\n\
        Pixels:            65536   Samples:               0   Smpls/Pxl: 0.00\n\
        Rays:             295722   Saved:               139   Max Level: 4/4\n\
        Shadow Ray Tests:            563893   Succeeded:                204098\n\
        Reflected Rays:              163038\nRefracted Rays:               67148\n\
        \x20 Photon Time:      No photons\n\
        \x20 Trace Time:       0 hours  0 minutes 45 seconds (45.327 seconds)\n\
        \x20             using 1 thread(s) with 22.278 CPU-seconds total\n";

    #[test]
    fn what_it_prints_is_read() {
        assert_eq!(trace_seconds(SAID), Some(45.327));
        let counts = Counts { pixels: 65536, reflected: 163_038, refracted: 67148, shadow: 563_893 };
        assert_eq!(Counts::of(SAID), Some(counts));
        assert_eq!((trace_seconds("no time"), Counts::of("Rays: 3")), (None, None));
    }

    #[test]
    fn a_mesh_is_written_in_its_words() {
        let corners = [[0.0, 0.5, -1.0], [1.0, 0.0, 0.0], [0.0, 0.1, 0.0]].map(GzCoord::from_array);
        let text = mesh_text(&Indexed::of(&[corners]));
        assert_eq!(text, "vertex_vectors { 3,\n<0,0.5,-1>,\n<1,0,0>,\n<0,0.1,0> }\nface_indices { 1,\n<0,1,2> }\n");
    }
}
