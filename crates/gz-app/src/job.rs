//! A render as asked for: options checked as far as they can be without the scene.

use crate::accel::Accel;
use crate::cli::{RenderArgs, SceneArgs};
use crate::error::AppError;
use crate::heat::Effort;
use crate::load::{Overrides, expect_scene};
use crate::new_file::NewFile;
use crate::output::ImageFormat;
use crate::progress::ProgressMode;
use crate::show::Show;
use gz_core::Tile;
use gz_shade::{Antialias, Scene};
use std::path::{Path, PathBuf};

/// The greatest number of pixels rendered at once: 3 GB of colours.
pub const MAX_PIXELS: u64 = 1 << 28;

/// What `gz render` was asked to do.
#[derive(Clone, Debug)]
pub struct RenderJob {
    /// The scene file.
    pub scene: PathBuf,
    /// What the command line says over the scene.
    pub overrides: Overrides,
    /// The picture.
    pub output: NewFile,
    /// Its format.
    pub format: ImageFormat,
    /// What answers rays.
    pub accel: Accel,
    /// Threads; 0 for all cores.
    pub threads: usize,
    /// Edge length of a tile.
    pub tile: u32,
    /// The part of the picture to render, if not all.
    pub crop: Option<Tile>,
    /// How progress is shown.
    pub progress: ProgressMode,
    /// Where statistics go.
    pub stats_json: Option<NewFile>,
    /// Where the T-buffer goes.
    pub tbuffer: Option<NewFile>,
    /// Where the primary rays go.
    pub rays_out: Option<NewFile>,
    /// What to show in place of colours.
    pub show: Option<Show>,
    /// Whether to say what the scene needs.
    pub explain: bool,
}

impl RenderJob {
    /// The job of these options. All that can be refused without rendering is refused here.
    ///
    /// # Errors
    ///
    /// [`AppError::Usage`] for options that contradict each other, [`AppError::Load`] for a name that is no scene's,
    /// [`AppError::Io`] for a file that cannot be written.
    pub fn of(args: &RenderArgs) -> Result<Self, AppError> {
        let accel = Accel::of(&args.scene.accel)?;
        let scene = args.scene.scene.clone();
        expect_scene(&scene)?;
        let output = match &args.output {
            Some(path) => path.clone(),
            None => default_output(&scene),
        };
        let format = ImageFormat::of(&output)?;
        if args.scene.aa.is_some_and(takes_many) {
            one_sample(args.tbuffer.is_some(), args.rays_out.is_some())?;
        }
        // Everything is asked for before anything is touched: two names for one file would lose one of them.
        let mut taken = vec![("", scene.clone())];
        let mut new_file = |option: &'static str, path: &Path| -> Result<NewFile, AppError> {
            let file = NewFile::at(path)?;
            if let Some((other, _)) = taken.iter().find(|(_, other)| file.is(other)) {
                let path = path.display();
                return Err(AppError::Usage(match *other {
                    "" => format!("{path}: {option} would overwrite the scene itself"),
                    other => format!("{path}: {other} and {option} name the same file"),
                }));
            }
            taken.push((option, path.to_owned()));
            Ok(file)
        };
        Ok(Self {
            output: new_file("--output", &output)?,
            format,
            stats_json: args.stats_json.as_deref().map(|path| new_file("--stats-json", path)).transpose()?,
            tbuffer: args.tbuffer.as_deref().map(|path| new_file("--tbuffer", path)).transpose()?,
            rays_out: args.rays_out.as_deref().map(|path| new_file("--rays-out", path)).transpose()?,
            overrides: overrides(&args.scene),
            scene,
            accel,
            threads: args.scene.threads,
            tile: args.tile,
            crop: args.crop,
            progress: args.progress,
            show: shown(args, &accel)?,
            explain: args.explain,
        })
    }

    /// The pixels to render of `scene`, having checked that this job can be done on it.
    ///
    /// # Errors
    ///
    /// [`AppError::Usage`] for a crop outside of the picture, too many pixels, or a T-buffer or rays of an antialiased scene.
    pub fn area(&self, scene: &Scene) -> Result<Tile, AppError> {
        let (width, height) = (scene.camera.width(), scene.camera.height());
        let area = self.crop.unwrap_or(Tile { x0: 0, y0: 0, x1: width, y1: height });
        if area.x1 > width || area.y1 > height {
            return Err(AppError::Usage(format!(
                "--crop {},{},{},{} reaches beyond the picture of {width}x{height}",
                area.x0, area.y0, area.x1, area.y1
            )));
        }
        if u64::from(area.width()) * u64::from(area.height()) > MAX_PIXELS {
            return Err(AppError::Usage(format!(
                "a picture of {}x{} has more than {MAX_PIXELS} pixels: render it in parts with --crop",
                area.width(),
                area.height()
            )));
        }
        if takes_many(scene.rules.antialias) {
            one_sample(self.tbuffer.is_some(), self.rays_out.is_some())?;
        }
        Ok(area)
    }
}

/// What to show in place of colours, with its own options.
fn shown(args: &RenderArgs, accel: &Accel) -> Result<Option<Show>, AppError> {
    let refuse = |what: &str| Err(AppError::Usage(what.to_owned()));
    let is_brute = matches!(accel, Accel::Brute(_));
    let is_heat = matches!(args.view, Some(Show::Heat { .. }));
    if !is_heat && args.view_max.is_some() {
        return refuse("--view-max is the end of a scale: use it with --view visits or tests");
    }
    if !is_heat && args.view_scale.is_some() {
        return refuse("--view-scale is of colours that stand for counts: use it with --view visits or tests");
    }
    if !matches!(args.view, Some(Show::Cells { .. })) && args.view_level.is_some() {
        return refuse("--view-level is a level of cells: use it with --view cells");
    }
    match args.view {
        Some(Show::Heat { effort: Effort::Visits, .. }) if is_brute => {
            refuse("--view visits: brute force visits no nodes, --view tests counts the triangles that it looks at")
        }
        Some(Show::Cells { .. }) if is_brute => refuse("--view cells: brute force has no cells"),
        Some(Show::Heat { effort, .. }) => {
            Ok(Some(Show::Heat { effort, full: args.view_max, spread: args.view_scale.unwrap_or_default() }))
        }
        Some(Show::Cells { .. }) => Ok(Some(Show::Cells { level: args.view_level })),
        show => Ok(show),
    }
}

/// The changes to the scene that these options ask for.
pub fn overrides(args: &SceneArgs) -> Overrides {
    Overrides { size: args.size, camera: args.camera, depth: args.depth, aa: args.aa, fresnel: args.fresnel, leave: args.leave }
}

/// The scene's name with `.png`, in the current folder.
fn default_output(scene: &Path) -> PathBuf {
    let mut name = scene.file_stem().unwrap_or("picture".as_ref()).to_owned();
    name.push(".png");
    PathBuf::from(name)
}

/// Whether a pixel has more samples than the one at the pixel itself.
fn takes_many(rule: Antialias) -> bool {
    !matches!(rule, Antialias::None | Antialias::Samples(0 | 1))
}

/// Refuses under antialiasing what there is one of a pixel.
fn one_sample(tbuffer: bool, rays_out: bool) -> Result<(), AppError> {
    match (tbuffer, rays_out) {
        (true, _) => Err(AppError::Usage("--tbuffer: an antialiased pixel has no single T-value, use --aa none".to_owned())),
        (_, true) => Err(AppError::Usage("--rays-out: an antialiased pixel has no single ray, use --aa none".to_owned())),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_picture_is_named_after_the_scene() {
        assert_eq!(default_output(Path::new("assets/scenes/teapot.toml")), Path::new("teapot.png"));
        assert_eq!(default_output(Path::new("a.b.obj")), Path::new("a.b.png"));
    }
}
