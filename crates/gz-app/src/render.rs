//! The frame, from scene file to picture: each step once, in order.

use crate::error::AppError;
use crate::job::RenderJob;
use crate::progress::Progress;
use crate::rays_file::RayFormat;
use crate::show::{Show, Shown};
use crate::stats::{Clock, RenderStats};
use crate::view::trace_hits;
use crate::{explain, hits_file, load, output, rays_file, threads};
use gz_core::TileGrid;
use gz_shade::{SceneNeeds, shade_frame};

/// Does a render job: writes its picture and whatever else was asked for. Returns what is printed: the range of a heat map, what `--explain` tells.
///
/// # Errors
///
/// If the scene cannot be used, the job does not fit it, or a file cannot be written.
pub fn render(job: &RenderJob) -> Result<String, AppError> {
    threads::with(job.threads, || frame(job))
}

fn frame(job: &RenderJob) -> Result<String, AppError> {
    let (mut clock, mut progress) = (Clock::start(), Progress::new(job.progress));

    // Scene file -> camera, lights, materials; no triangle is stored yet.
    let draft = load::scene(&job.scene, &job.overrides)?;
    let area = job.area(&draft.scene)?;
    draft.warnings.iter().for_each(|warning| progress.warn(warning));
    clock.lap("load");

    // What this scene can show; nothing else is stored or traced.
    let needs = SceneNeeds::of(&draft.scene);

    // Meshes -> triangle buffer in trace space.
    let scene = draft.place(needs)?;
    clock.lap("place");

    // Triangle buffer -> what answers rays.
    let built = job.accel.build(&scene.tris)?;
    let query = built.query();
    clock.lap("build");

    // Primary rays -> T-values, where they are asked for by themselves.
    let grid = TileGrid::of(area, job.tile);
    let takes_hits = job.tbuffer.is_some() || job.show.is_some_and(Show::takes_hits);
    let hits = if takes_hits { trace_hits(&scene, query, &grid) } else { Vec::new() };

    // Tile by tile: T-values -> shadow, mirror and glass rays -> colours.
    progress.begin(area.len() as u64);
    let shade = || shade_frame(&scene, needs, query, &grid, &|tile| progress.advance(tile));
    let Shown { frame, code, legend } = match job.show {
        Some(show) => show.picture(&scene, &built, &grid, &hits, shade),
        None => Shown { frame: shade(), code: scene.rules.color_code, legend: String::new() },
    };
    clock.lap("trace");

    // Colours -> picture.
    job.output.write(&output::picture(&frame, job.format, code)?)?;
    if let Some(file) = &job.tbuffer {
        file.write(&hits_file::encode(&hits))?;
    }
    if let Some(file) = &job.rays_out {
        file.write(&rays_file::primary(&scene.camera, &area, RayFormat::of(file.path())))?;
    }
    clock.lap("write");

    if frame.stats.nan_pixels > 0 {
        progress.warn(&format!("{} samples came out as NaN: please report the scene", frame.stats.nan_pixels));
    }
    let threads = rayon::current_num_threads();
    let stats = RenderStats { job, scene: &scene, area, frame: &frame.stats, threads, clock: &clock };
    if let Some(file) = &job.stats_json {
        file.write(format!("{:#}\n", stats.json()).as_bytes())?;
    }
    progress.finish(&stats.summary(), &stats.json());
    Ok(if job.explain { legend + &explain::explain(&scene, &frame.stats) } else { legend })
}
