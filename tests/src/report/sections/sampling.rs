//! Samples a pixel: seconds against the error to a picture of many samples.

use crate::bench::timing::seconds;
use crate::cells;
use crate::model::{Shot, shot, sized};
use crate::report::findings::Numbers;
use crate::report::run::Run;
use crate::report::section::{Axis, Chapter, ChartSpec, Drawn, Measured, Scale, Section};
use crate::report::table::{Column, Kind, Row, Table};
use gz_app::error::AppError;
use gz_app::load::Overrides;
use gz_shade::Antialias;

const COLUMNS: [Column; 9] = [
    Column::new("scene", "scene", "", Kind::Label),
    Column::new("samples", "samples", "a pixel", Kind::Label),
    Column::new("seconds", "time", "s", Kind::Time),
    Column::new("rmse", "RMSE", "of 255", Kind::Figure),
    Column::new("psnr", "PSNR", "dB", Kind::Figure),
    Column::new("rmse_linear", "RMSE, linear", "", Kind::Figure),
    Column::new("worst", "worst channel", "of 255", Kind::Count),
    Column::new("differing", "pixels that differ", "%", Kind::Figure),
    Column::new("line", "line", "", Kind::Note),
];

const X: Axis = Axis { column: "seconds", title: "seconds for the picture →", scale: Scale::Log };

const CHARTS: [ChartSpec; 2] = [
    ChartSpec {
        title: "Seconds against RMSE",
        caption: "Each line is a scene, from one sample a pixel to 64. The course's six weighted samples (hw6) are a softer filter than \
                  the pixel's square: they come close quickly, without tending to the same picture.",
        only: ("", ""),
        drawn: Drawn::Points {
            x: X,
            y: Axis { column: "rmse", title: "↑ RMSE to the reference, of 255", scale: Scale::Log },
            series: "line",
            label: "samples",
            joined: true,
            zeros: "",
        },
    },
    ChartSpec {
        title: "The same as PSNR",
        caption: "Up and to the left is better; six decibels are half the error.",
        only: ("", ""),
        drawn: Drawn::Points {
            x: X,
            y: Axis { column: "psnr", title: "↑ PSNR, dB", scale: Scale::Linear },
            series: "line",
            label: "samples",
            joined: true,
            zeros: "",
        },
    },
];

/// The section.
pub(super) const SECTION: Section = Section {
    id: "sampling",
    chapter: Chapter::Sampling,
    title: "One sample, the course's six, and many",
    how: "Small pictures of three scenes against the same with many samples (see settings). Written pictures are compared, channel by \
          channel, 0 to 255; linear values are those before encoding. The pictures that are compared and the ones that are timed are \
          different runs; times are of one thread and include shading.",
    columns: &COLUMNS,
    charts: &CHARTS,
    labels: |_| Ok(SCENES.iter().flat_map(|scene| WAYS.iter().map(move |(way, _)| format!("{scene}, {way}"))).collect()),
    measure,
    says,
};

const SCENES: [&str; 3] = ["plain", "refraction", "teapot"];
const WAYS: [(&str, Antialias); 5] = [
    ("1", Antialias::None),
    ("hw6", Antialias::Hw6),
    ("4", Antialias::Samples(4)),
    ("16", Antialias::Samples(16)),
    ("64", Antialias::Samples(64)),
];

fn measure(run: &Run) -> Result<Measured, AppError> {
    let (width, height) = run.size((8, 6), (64, 48), (320, 240));
    let many = run.size(64, 256, 1024);
    let by = |scene: &str, aa: Antialias| -> Result<Shot, AppError> {
        Ok(shot(scene, &Overrides { aa: Some(aa), ..sized(width, height) })?)
    };
    let settings = format!("{}; {width}x{height} against {many} samples; timed once each, 1 thread", run.mode.name());
    let mut rows = Vec::new();
    for scene in SCENES {
        let reference = by(scene, Antialias::Samples(many))?;
        run.progress.say(&format!("  sampling: reference of {scene}"));
        for (way, aa) in WAYS {
            let (linear, bytes) = by(scene, aa)?.differences(&reference);
            let seconds = gz_app::threads::with(1, || seconds_of(scene, &Overrides { aa: Some(aa), ..sized(width, height) }))?;
            let share = 100.0 * bytes.differing as f64 / bytes.pixels as f64;
            // Another filter is not on the way from one sample to many.
            let line = if aa == Antialias::Hw6 { format!("{scene}, hw6") } else { scene.to_owned() };
            let cells = cells![scene, way, seconds, bytes.rmse, bytes.psnr(255.0), linear.rmse, bytes.max, share, line];
            rows.push(Row { cells, n: bytes.pixels as u64, settings: settings.clone() });
        }
    }
    Ok(Measured { rows, pictures: Vec::new() })
}

/// Seconds to shade a picture; loading, placing and building do not count.
fn seconds_of(scene: &str, overrides: &Overrides) -> Result<f64, AppError> {
    let (scene, needs) = crate::model::placed(scene, overrides)?;
    let tree = gz_bsp::BspTree::build(&scene.tris);
    Ok(seconds(|| std::hint::black_box(crate::model::shot_by(&scene, needs, &tree))).0)
}

fn says(table: &Table) -> String {
    let mut numbers = Numbers::default();
    let find = |scene: &str, way: &str| {
        (0..table.rows.len()).find(|&row| table.words(row, "scene") == scene && table.words(row, "samples") == way)
    };
    let (Some(one), Some(six), Some(four), Some(most)) =
        (find("teapot", "1"), find("teapot", "hw6"), find("teapot", "4"), find("teapot", "64"))
    else {
        return String::new();
    };
    let rmse = |row: usize| table.number(row, "rmse").unwrap_or(f64::NAN);
    let six_is = if rmse(six) < rmse(four) { "less" } else { "more" };
    format!(
        "On the default scene one sample is off by {} of 255, the course's six by {}, which is {six_is} than four samples of equal weight \
         ({}), and 64 by {}.",
        numbers.say("one", rmse(one), "rmse", ""),
        numbers.say("six", rmse(six), "rmse", ""),
        numbers.say("four", rmse(four), "rmse", ""),
        numbers.say("many", rmse(most), "rmse", ""),
    )
}
