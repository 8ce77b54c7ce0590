//! The most memory that `gz render` takes for a scene of many triangles, and how long it takes.

use super::options::Options;
use super::timing::seconds;
use crate::rendered::scene_path;
use glam::DVec2;
use gz_app::error::AppError;
use gz_app::hits_file;
use gz_app::load::{self, Overrides};
use gz_core::{BruteForce, Hit, RayQuery};
use gz_shade::SceneNeeds;
use std::path::{Path, PathBuf};

/// The scene, unless the options name another: 10.24 million triangles.
pub const SCENE: &str = "teapot:400";
/// What it may take, in GiB.
const GOAL: f64 = 16.0;
/// Brute force checks so many triangle tests' worth of the pixels.
const CHECKED_TESTS: f64 = 4e9;

/// `cargo xtask bench memory`: renders one scene as the command does, checks its T-values, and prints the peak of resident memory.
///
/// # Errors
///
/// If more than one scene is named, it cannot be rendered, a T-value is wrong, or the goal is missed.
pub fn run(options: &Options) -> Result<(), AppError> {
    let name = match &options.scenes[..] {
        [] => SCENE,
        [name] => name,
        _ => return Err(AppError::Usage("bench memory takes one scene: the peak is that of the process".to_owned())),
    };
    let folder = Folder::new()?;
    let scene = scene_file(name, &folder)?;
    let (picture, hits) = (folder.0.join("picture.png"), folder.0.join("picture.hits"));
    let threads = options.threads.to_string();
    let words = ["gz".as_ref(), "render".as_ref(), scene.as_os_str(), "-o".as_ref(), picture.as_os_str()];
    let options =
        ["--tbuffer".as_ref(), hits.as_os_str(), "--threads".as_ref(), threads.as_ref(), "--aa".as_ref(), "none".as_ref()];
    let (time, code) = seconds(|| gz_app::cli::run(words.into_iter().chain(options).map(std::ffi::OsStr::to_owned)));
    if code != 0 {
        return Err(AppError::Io(format!("gz render {name} ended with exit code {code}")));
    }
    // Before the check, which takes memory of its own.
    let peak = peak_bytes();

    let (checked, differing, triangles) = check(&scene, &Overrides::default(), &hits)?;
    println!("{name}: {triangles} triangles; {checked} pixels checked by brute force, {differing} differ");
    if differing > 0 {
        return Err(AppError::Differs(format!("{differing} of {checked} T-values differ from those of brute force")));
    }
    println!("loaded, built and rendered in {time:.1} s on {} threads", if threads == "0" { "all" } else { &threads });
    let Some(peak) = peak else {
        println!("peak of resident memory: this system does not say (there is no VmHWM in /proc/self/status)");
        return Ok(());
    };
    let gib = peak / f64::from(1 << 30);
    let each = peak / triangles.max(1) as f64;
    let verdict = if gib <= GOAL { "reached" } else { "NOT reached" };
    println!("peak of resident memory: {gib:.2} GiB, {each:.0} bytes a triangle; goal of {GOAL} GiB: {verdict}");
    if gib > GOAL { Err(AppError::Differs(format!("{gib:.2} GiB are more than {GOAL}"))) } else { Ok(()) }
}

/// The most memory that this process ever had, in bytes; `None` where the system does not say.
pub fn peak_bytes() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024.0)
}

/// The scene as a file: `teapot:SEGMENTS` becomes one in `folder`.
fn scene_file(name: &str, folder: &Folder) -> Result<PathBuf, AppError> {
    let Some(segments) = name.strip_prefix("teapot:") else {
        return Ok(if Path::new(name).extension().is_some() { PathBuf::from(name) } else { scene_path(name) });
    };
    let path = folder.0.join("teapot.toml");
    let text = format!(
        "[render]\nsize = [640, 480]\n[camera]\nposition = [5.0, 4.5, 7.0]\nlook_at = [0.0, 1.5, 0.0]\nfov = 40.0\n\
         [[light]]\ndirection = [-0.5, 0.8, 0.55]\ncolor = [1.0, 1.0, 1.0]\n\
         [[mesh]]\nteapot = {{ segments = {segments}, bottom = true }}\n"
    );
    std::fs::write(&path, text).map_err(|error| AppError::Io(format!("{}: {error}", path.display())))?;
    Ok(path)
}

/// Asks brute force about evenly spaced pixels of the T-buffer: how many were asked about, how many differ, and of how many triangles.
pub(super) fn check(scene: &Path, overrides: &Overrides, hits: &Path) -> Result<(usize, usize, usize), AppError> {
    let bytes = std::fs::read(hits).map_err(|error| AppError::Io(format!("{}: {error}", hits.display())))?;
    let found = hits_file::decode(&bytes).map_err(|reason| AppError::Io(format!("{}: {reason}", hits.display())))?;
    let draft = load::scene(scene, overrides)?;
    let needs = SceneNeeds::of(&draft.scene);
    let scene = draft.place(needs)?;
    let (brute, width) = (BruteForce::new(&scene.tris), scene.camera.width() as usize);
    let step = found.len().div_ceil((CHECKED_TESTS / scene.tris.len().max(1) as f64) as usize).max(1);
    let bits = |hit: &Hit| (hit.t.to_bits(), hit.tri, hit.u.to_bits(), hit.v.to_bits());
    let is_right = |k: &usize| {
        let ray = scene.camera.ray((k % width) as u32, (k / width) as u32, DVec2::ZERO);
        bits(&brute.closest_hit(&ray)) == bits(&found[*k])
    };
    let asked: Vec<usize> = (0..found.len()).step_by(step).collect();
    let right = asked.iter().filter(|k| is_right(k)).count();
    Ok((asked.len(), asked.len() - right, scene.tris.len()))
}

/// A folder for temporary files that goes when it does.
struct Folder(PathBuf);

impl Folder {
    fn new() -> Result<Self, AppError> {
        let path = std::env::temp_dir().join(format!("gz-memory-{}", std::process::id()));
        std::fs::create_dir_all(&path).map_err(|error| AppError::Io(format!("{}: {error}", path.display())))?;
        Ok(Self(path))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // One that stays behind in the system's own place for such is no harm.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_render_is_checked_and_its_peak_is_told() {
        let words = ["memory", "--scene", "teapot:3"].map(str::to_owned);
        run(&Options::parse(&words).unwrap()).unwrap();
        if cfg!(target_os = "linux") {
            let peak = peak_bytes().unwrap();
            assert!(peak > 1e6 && peak < 1e12, "{peak}");
        }
    }

    #[test]
    fn one_process_has_one_peak() {
        let words = ["memory", "--scene", "teapot:3", "--scene", "uneven"].map(str::to_owned);
        assert_eq!(run(&Options::parse(&words).unwrap()).unwrap_err().exit_code(), 2);
    }
}
