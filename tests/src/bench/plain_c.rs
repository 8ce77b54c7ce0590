//! The plain C brute force: compiled when a bench runs, fed through files.

use super::rays::RaySet;
use gz_app::error::AppError;
use gz_core::{Hit, NO_TRI, TriBuffer};
use std::path::{Path, PathBuf};
use std::process::Command;

const SOURCE: &str = include_str!("brute.c");

/// The compiled program with its input, in a folder of its own that goes when it does.
#[derive(Debug)]
pub struct PlainC {
    folder: PathBuf,
}

impl PlainC {
    /// Compiles the program with `cc -O2` and writes the files that it reads; nothing when there is no C compiler.
    ///
    /// Origins are rounded to f32, as such a program has them; a ray skips the triangle that it leaves, by number.
    ///
    /// # Errors
    ///
    /// If a file cannot be written or the program is refused.
    pub fn new(tris: &TriBuffer, rays: &RaySet) -> Result<Option<Self>, AppError> {
        if Command::new("cc").arg("--version").output().is_err() {
            return Ok(None);
        }
        let folder = std::env::temp_dir().join(format!("gz-plain-c-{}", std::process::id()));
        std::fs::create_dir_all(&folder).map_err(|error| io(&folder, &error))?;
        let this = Self { folder };
        this.write("brute.c", SOURCE.as_bytes())?;
        let floats = |values: &[f32]| values.iter().flat_map(|x| x.to_ne_bytes()).collect::<Vec<u8>>();
        let corners: Vec<f32> = tris.positions().iter().flatten().flat_map(|p| p.to_array()).collect();
        this.write("triangles", &floats(&corners))?;
        let (mut numbers, mut leaves) = (Vec::new(), Vec::new());
        for (ray, leaving) in rays.rays() {
            numbers.extend(ray.origin.as_vec3().to_array());
            numbers.push(ray.tmin);
            numbers.extend(ray.direction.to_array());
            numbers.push(ray.tmax);
            // Triangle numbers of a bench's scenes fit.
            leaves.extend(leaving.map_or(-1, |tri| tri as i32).to_ne_bytes());
        }
        this.write("rays", &floats(&numbers))?;
        this.write("leaves", &leaves)?;
        let mut cc = Command::new("cc");
        cc.current_dir(&this.folder).args(["-O2", "-std=c11", "-D_POSIX_C_SOURCE=199309L", "-o", "brute", "brute.c", "-lm"]);
        let output = cc.output().map_err(|error| AppError::Io(format!("cc cannot be started: {error}")))?;
        if output.status.success() {
            return Ok(Some(this));
        }
        let text = String::from_utf8_lossy(&output.stderr).replace('\n', "; ");
        Err(AppError::Io(format!("cc refuses the plain brute force: {text}")))
    }

    /// Lets it trace all rays once; the seconds that tracing alone took, by its own clock.
    ///
    /// # Errors
    ///
    /// If the program fails.
    pub fn seconds(&self) -> Result<f64, AppError> {
        let mut brute = Command::new(self.folder.join("brute"));
        let output = brute.current_dir(&self.folder).args(["triangles", "rays", "leaves", "hits"]).output();
        let output = output.map_err(|error| AppError::Io(format!("the plain brute force cannot be started: {error}")))?;
        let text = String::from_utf8_lossy(&output.stdout);
        match text.trim().parse() {
            Ok(seconds) if output.status.success() => Ok(seconds),
            _ => Err(AppError::Io(format!("the plain brute force failed: {}", String::from_utf8_lossy(&output.stderr).trim()))),
        }
    }

    /// The answers of the last run, t and triangle only.
    ///
    /// # Errors
    ///
    /// If there was none.
    pub fn hits(&self) -> Result<Vec<Hit>, AppError> {
        let path = self.folder.join("hits");
        let bytes = std::fs::read(&path).map_err(|error| io(&path, &error))?;
        let hit = |bytes: &[u8; 8]| {
            let [t, tri] = [0, 4].map(|k| [bytes[k], bytes[k + 1], bytes[k + 2], bytes[k + 3]]);
            match i32::from_ne_bytes(tri) {
                -1 => Hit::MISS,
                tri => Hit { t: f32::from_ne_bytes(t), tri: u32::try_from(tri).unwrap_or(NO_TRI), u: 0.0, v: 0.0 },
            }
        };
        Ok(bytes.as_chunks().0.iter().map(hit).collect())
    }

    fn write(&self, name: &str, bytes: &[u8]) -> Result<(), AppError> {
        let path = self.folder.join(name);
        std::fs::write(&path, bytes).map_err(|error| io(&path, &error))
    }
}

impl Drop for PlainC {
    fn drop(&mut self) {
        // A folder that stays behind in the system's own place for such is no harm.
        let _ = std::fs::remove_dir_all(&self.folder);
    }
}

fn io(path: &Path, error: &std::io::Error) -> AppError {
    AppError::Io(format!("{}: {error}", path.display()))
}
