//! `cargo xtask verify scene`: whole frames, ray by ray.

use super::certifier::{Certificate, Kind, certify};
use super::options::SceneOptions;
use super::tables::bounded;
use crate::bench::scenes::{asset_scenes, has_course_data};
use crate::rendered::scene_path;
use gz_app::error::AppError;
use gz_app::load::{self, Overrides};
use gz_bsp::BspTree;
use gz_core::SimdLevel;
use gz_shade::SceneNeeds;
use std::path::{Path, PathBuf};

/// Triangles tested with integers alone, a frame: some seconds.
const PLAIN_TESTS: u64 = 1_000_000;

/// Certifies the frames of all scenes named, printing as it goes.
///
/// # Errors
///
/// Scenes that cannot be loaded, and [`AppError::Differs`] if anything is wrong.
pub fn verify_scenes(options: &SceneOptions) -> Result<(), AppError> {
    let paths = match options.scenes.as_slice() {
        [all] if all == "all" => asset_scenes()?,
        names => names.iter().map(|name| path_of(name)).collect(),
    };
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads)
        .build()
        .map_err(|error| AppError::Io(format!("no threads to work with: {error}")))?;
    let mut wrong = Vec::new();
    let mut all = Certificate::default();
    for path in &paths {
        let needs_course_data = std::fs::read_to_string(path).is_ok_and(|text| text.contains("hw:"));
        let certificate = match of_scene(path, options, &pool) {
            Ok(certificate) => certificate,
            Err(AppError::Load(error)) if paths.len() > 1 && needs_course_data && !has_course_data() => {
                println!("skipped: {error}\n");
                continue;
            }
            Err(error) => return Err(error),
        };
        if !certificate.is_clean() {
            wrong.push(shown(path));
        }
        all += certificate;
    }
    if paths.len() > 1 {
        print!("all of them\n{}", report(&all));
    }
    if wrong.is_empty() {
        return Ok(());
    }
    Err(AppError::Differs(format!("wrong answers in {}", wrong.join(", "))))
}

/// A stem of `assets/scenes`, or a file as it is.
fn path_of(name: &str) -> PathBuf {
    if Path::new(name).extension().is_some() { PathBuf::from(name) } else { scene_path(name) }
}

/// A scene of assets by its stem, any other by its path.
fn shown(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    if scene_path(&stem) == path { stem } else { path.display().to_string() }
}

fn of_scene(path: &Path, options: &SceneOptions, pool: &rayon::ThreadPool) -> Result<Certificate, AppError> {
    let draft = load::scene(path, &Overrides { size: options.size, ..Overrides::NONE })?;
    let needs = SceneNeeds::of(&draft.scene);
    let scene = draft.place(needs)?;
    let tree = BspTree::build(&scene.tris);
    let (width, height) = (scene.camera.width(), scene.camera.height());
    println!("{}: {width}x{height}, {} triangles, {:?}", shown(path), scene.tris.len(), SimdLevel::best());
    let certificate = certify(&scene, needs, &tree, pool, PLAIN_TESTS);
    println!("{}", report(&certificate));
    Ok(certificate)
}

/// The certificate as lines of text.
fn report(certificate: &Certificate) -> String {
    use std::fmt::Write;
    let mut text = format!(
        "{:<8} {:>10} {:>10} {:>18} {:>18} {:>18} {:>8} {:>18}\n",
        "", "rays", "hits", "wrong hit or miss", "wrong triangle", "wrong T", "worst T", "wrong u or v"
    );
    let mut line = |name: &str, tally: &crate::judge::Tally| {
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{name:<8} {:>10} {:>10} {:>18} {:>18} {:>18} {:>8} {:>18}",
            tally.rays,
            tally.hits,
            bounded(tally.false_hits + tally.false_misses, tally.rays),
            bounded(tally.triangles, tally.rays),
            bounded(tally.t, tally.rays),
            tally.worst_t,
            bounded(tally.weights, tally.rays)
        );
    };
    for (kind, tally) in Kind::ALL.iter().zip(&certificate.kinds).filter(|(_, tally)| tally.rays > 0) {
        line(kind.name(), tally);
    }
    line("all", &certificate.all());
    let Certificate { leaving, astray, undecided, acne, leaks, plain, plain_differing, .. } = *certificate;
    let rays = certificate.all().rays;
    let _ = writeln!(
        text,
        "coverage: all {rays} rays the frame asked; {plain} of them by integers over every triangle too, {plain_differing} differ\n\
         leaving a surface: {leaving} rays, acne {}, light leaks {}, undecided {undecided}, astray {astray}; NaN pixels {}",
        bounded(acne, leaving),
        bounded(leaks, leaving),
        certificate.stats.nan_pixels
    );
    text
}
