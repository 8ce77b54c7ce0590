//! The command line of `gz`: its options, and how it ends.

use crate::accel::{AccelKind, Split};
use crate::args;
use crate::error::AppError;
use crate::heat::Spread;
use crate::progress::{ProgressMode, say};
use crate::show::Show;
use crate::{compare, info, job, pixel_report, query, render};
use clap::{Args, CommandFactory, Parser, Subcommand};
use gz_core::{CameraModel, Kernel, LeavePolicy, Tile};
use gz_shade::{Antialias, Fresnel};
use std::ffi::OsString;
use std::io::Write;
use std::path::PathBuf;

/// A ray tracer for triangles whose hits are exact.
#[derive(Debug, Parser)]
#[command(name = "gz", version, after_help = EXIT_CODES)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
}

const EXIT_CODES: &str = "\
Exit codes: 0 done, 1 input or output failed, 2 wrong usage, 3 bad scene or asset, 4 a comparison failed.
A scene is a .toml file, or a bare .obj or .asc mesh.";

#[derive(Debug, Subcommand)]
enum Command {
    /// Render a scene to a picture
    Render(Box<RenderArgs>),
    /// Compare two pictures (png, ppm, pfm) or T-buffers (hits): exit code 4 when they differ by more than the tolerance
    Compare(CompareArgs),
    /// Print what a scene holds and needs
    Info(InfoArgs),
    /// Cast a file of rays at a mesh and write their hits
    Query(QueryArgs),
    /// Explain one pixel: its ray, what the ray meets, and its colour
    Pixel(PixelArgs),
}

/// What changes a scene, the same for each command that reads one.
#[derive(Args, Clone, Debug)]
pub struct SceneArgs {
    /// Scene file (.toml), or a bare mesh (.obj, .asc)
    pub scene: PathBuf,
    /// Picture size in pixels, in place of the scene's
    #[arg(long, value_name = "WxH", value_parser = args::size)]
    pub size: Option<(u32, u32)>,
    /// Camera model, in place of the scene's: homework, paper, screen or pinhole
    #[arg(long, value_name = "MODEL", value_parser = args::camera)]
    pub camera: Option<CameraModel>,
    /// Mirror and glass bounces after the primary ray, 0 to 32
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=32))]
    pub depth: Option<u32>,
    /// Reflected share at glass: exact or schlick (the paper's equations 2 and 3)
    #[arg(long, value_name = "HOW", value_parser = args::fresnel)]
    pub fresnel: Option<Fresnel>,
    /// How shadow, mirror and glass rays leave a surface: exact; or for comparison bare, identity (the paper's), epsilon,
    /// epsilon=T, waechter-binder, error-bound
    #[arg(long, value_name = "POLICY", value_parser = args::leave)]
    pub leave: Option<LeavePolicy>,
    /// Samples a pixel: none, hw6 (the course's six) or a number
    #[arg(long, value_name = "none|hw6|N", value_parser = args::antialias)]
    pub aa: Option<Antialias>,
    /// What answers rays.
    #[command(flatten)]
    pub accel: AccelArgs,
    /// Threads, 0 for all cores
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub threads: usize,
}

/// What answers rays.
#[derive(Args, Clone, Copy, Debug)]
pub struct AccelArgs {
    /// Ray-triangle test: certified (exact); or for comparison, by brute force, plane (the paper's), moeller-trumbore,
    /// moeller-trumbore-f64, woop, woop-fused, pluecker, baldwin-weber
    #[arg(long, value_name = "NAME", value_parser = args::kernel, default_value = "certified")]
    pub kernel: Kernel,
    /// What answers rays: bsp (the tree, the default) or brute (every triangle)
    #[arg(long, value_name = "HOW", value_parser = args::accel)]
    pub accel: Option<AccelKind>,
    /// Where the tree is cut: sah (by expected cost, the default) or midpoint (the paper's)
    #[arg(long, value_name = "RULE", value_parser = args::split)]
    pub split: Option<Split>,
    /// The paper's MAX_DEPTH, 0 to 64, for --split midpoint
    #[arg(long, value_name = "N")]
    pub max_depth: Option<u32>,
    /// The paper's MIN_SIZE, for --split midpoint
    #[arg(long, value_name = "N")]
    pub min_size: Option<usize>,
}

/// `gz render`.
#[derive(Args, Clone, Debug)]
pub struct RenderArgs {
    /// The scene and what changes it.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Picture file: .png, .ppm or .pfm (linear floats); without it, the scene's name with .png in the current folder
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Edge length of the tiles that threads work on, in pixels
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..=65535))]
    pub tile: u32,
    /// Render only columns x0 to x1 - 1 and rows y0 to y1 - 1 from the top
    #[arg(long, value_name = "x0,y0,x1,y1", value_parser = args::crop)]
    pub crop: Option<Tile>,
    /// How to show progress: auto (a bar on a terminal), plain lines, json lines, or none
    #[arg(long, value_name = "HOW", value_parser = args::progress, default_value = "auto")]
    pub progress: ProgressMode,
    /// Write what was done, how often and how long it took, as JSON
    #[arg(long, value_name = "FILE")]
    pub stats_json: Option<PathBuf>,
    /// Write the T-value of each pixel: 16 bytes each, f32 t, u32 triangle, f32 u, f32 v, row 0 on top
    #[arg(long, value_name = "FILE")]
    pub tbuffer: Option<PathBuf>,
    /// Write the primary ray of each pixel, 32 bytes each as gz query reads them, row 0 on top; with the extension .rays64 as f64, which
    /// keeps the origin's bits. They are in the space in which the camera model traces, under pinhole the world
    #[arg(long, value_name = "FILE")]
    pub rays_out: Option<PathBuf>,
    /// Show in place of colours: T-values (t), triangles (id), face normals (normal); how much work each primary ray is by itself, nodes and
    /// leaves entered (visits) or triangles looked at (tests); or over the colours the tree's leaves (cells)
    #[arg(long, value_name = "WHAT", value_parser = args::view)]
    pub view: Option<Show>,
    /// For --view visits or tests: the count that has the lightest colour, so that several pictures share one scale; without it, the
    /// greatest of the picture
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub view_max: Option<u64>,
    /// For --view visits or tests: colours in even steps (even) or by the logarithm (log), for trees that are far apart
    #[arg(long, value_name = "HOW", value_parser = args::spread)]
    pub view_scale: Option<Spread>,
    /// For --view cells: the cells of this level, and the leaves above it, in place of all leaves
    #[arg(long, value_name = "N")]
    pub view_level: Option<usize>,
    /// Print what the scene needs and what each need costs
    #[arg(long)]
    pub explain: bool,
}

/// `gz compare`.
#[derive(Args, Clone, Debug)]
pub struct CompareArgs {
    /// The expected picture or T-buffer
    pub expected: PathBuf,
    /// The actual one
    pub actual: PathBuf,
    /// Greatest difference that still counts as equal: of a channel from 0 to 255 (PFM: linear), of T-values relative
    #[arg(long, value_name = "N", default_value_t = 0.0, value_parser = args::tolerance)]
    pub tolerance: f64,
    /// Size of the T-buffers' picture, to name pixels by column and row
    #[arg(long, value_name = "WxH", value_parser = args::size)]
    pub size: Option<(u32, u32)>,
    /// Write expected, difference and actual side by side, as a picture
    #[arg(long, value_name = "FILE")]
    pub sheet: Option<PathBuf>,
}

/// `gz info`.
#[derive(Args, Clone, Debug)]
pub struct InfoArgs {
    /// The scene and what changes it.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Print what the tree looks like, and what random lines visit in it beside what its builder expects
    #[arg(long)]
    pub tree: bool,
}

/// `gz pixel`.
#[derive(Args, Clone, Debug)]
pub struct PixelArgs {
    /// The scene and what changes it.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Column, from 0 on the left
    pub x: u32,
    /// Row, from 0 on top
    pub y: u32,
    /// Ask this as well (brute: every triangle, exactly) and fail when the answers differ
    #[arg(long, value_name = "HOW", value_parser = args::accel)]
    pub compare: Option<AccelKind>,
    /// Print all of it as JSON, numbers in full
    #[arg(long)]
    pub json: bool,
}

/// `gz query`.
#[derive(Args, Clone, Debug)]
pub struct QueryArgs {
    /// Mesh (.obj, .asc) or scene (.toml, in world space)
    #[arg(long, value_name = "FILE")]
    pub mesh: PathBuf,
    /// Rays: 32 bytes each, f32 ox oy oz tmin dx dy dz tmax, little-endian, no header
    #[arg(long, value_name = "FILE", required_unless_present = "rays64", conflicts_with = "rays64")]
    pub rays: Option<PathBuf>,
    /// Rays as f64, 64 bytes each; all but the origin is rounded to f32
    #[arg(long, value_name = "FILE")]
    pub rays64: Option<PathBuf>,
    /// Hits: 16 bytes each, f32 t (infinity for a miss), u32 triangle (0xffffffff for a miss), f32 u, f32 v
    #[arg(long, value_name = "FILE")]
    pub hits: PathBuf,
    /// Only ask whether a ray meets anything: 16 zero bytes if it does, a miss if not
    #[arg(long)]
    pub any: bool,
    /// What answers rays.
    #[command(flatten)]
    pub accel: AccelArgs,
    /// Threads, 0 for all cores
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub threads: usize,
}

/// Runs `gz` with these arguments, the program's name first. Returns the exit code, having said on standard error why it is not 0.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let done = match Cli::try_parse_from(arguments) {
        Ok(Cli { command: None }) => print(&Cli::command().render_help().to_string()),
        Ok(Cli { command: Some(command) }) => execute(&command),
        // Help and version come as errors that are none.
        Err(error) if !error.use_stderr() => print(&error.to_string()),
        Err(error) => Err(AppError::Usage(args::one_line(&error.to_string()))),
    };
    match done {
        Ok(()) => 0,
        Err(error) => {
            say(&format!("gz: {error}"));
            error.exit_code()
        }
    }
}

fn execute(command: &Command) -> Result<(), AppError> {
    match command {
        Command::Render(args) => {
            let job = job::RenderJob::of(args)?;
            let explained = render::render(&job)?;
            print(&explained)
        }
        Command::Compare(args) => {
            let comparison = compare::compare(args)?;
            print(&comparison.report)?;
            comparison.verdict
        }
        Command::Info(args) => print(&info::report(args)?),
        Command::Query(args) => print(&query::query(args)?),
        Command::Pixel(args) => {
            let explained = pixel_report::explain(args)?;
            print(&explained.report)?;
            explained.verdict
        }
    }
}

/// Text to standard output. A reader that has gone away (`| head`) is no error.
fn print(text: &str) -> Result<(), AppError> {
    match std::io::stdout().write_all(text.as_bytes()).and_then(|()| std::io::stdout().flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(AppError::Io(format!("standard output: {error}"))),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::View;

    #[test]
    fn options_are_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn every_render_option_is_understood() {
        let line = "gz render a.toml -o b.png --size 320x200 --camera paper --accel brute --depth 4 --fresnel schlick --kernel plane --leave identity \
                    --aa 16 --threads 3 --tile 8 --crop 1,2,30,40 --progress json --stats-json s.json --explain --view id";
        let Some(Command::Render(args)) = Cli::try_parse_from(line.split_whitespace()).unwrap().command else {
            panic!("not a render");
        };
        assert_eq!((args.scene.size, args.scene.camera), (Some((320, 200)), Some(CameraModel::Paper)));
        assert_eq!((args.scene.depth, args.scene.fresnel), (Some(4), Some(Fresnel::Schlick)));
        assert_eq!(args.scene.leave, Some(LeavePolicy::Identity));
        assert_eq!((args.scene.accel.kernel, args.scene.aa), (Kernel::Plane, Some(Antialias::Samples(16))));
        assert_eq!((args.crop, args.tile), (Some(Tile { x0: 1, y0: 2, x1: 30, y1: 40 }), 8));
        assert_eq!((args.progress, args.view, args.explain), (ProgressMode::Json, Some(Show::Hits(View::Id)), true));
    }
}
