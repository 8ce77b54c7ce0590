//! Approximations of the model: the error of each, and the time that it saves.

use crate::bench::timing::{Ratio, median, take_turns};
use crate::cells;
use crate::model::{Shot, placed, shot_by, sized};
use crate::report::findings::Numbers;
use crate::report::run::Run;
use crate::report::section::{Axis, Chapter, ChartSpec, Drawn, Measured, Scale, Section};
use crate::report::table::{Column, Kind, Row, Table};
use gz_app::error::AppError;
use gz_app::load::Overrides;
use gz_bsp::BspTree;
use gz_shade::{Fresnel, Scene, SceneNeeds};

const COLUMNS: [Column; 9] = [
    Column::new("scene", "scene", "", Kind::Label),
    Column::new("approximation", "approximation", "", Kind::Label),
    Column::new("rmse", "RMSE", "of 255", Kind::Figure),
    Column::new("worst", "worst channel", "of 255", Kind::Count),
    Column::new("differing", "pixels that differ", "%", Kind::Figure),
    Column::new("rays", "rays of the reference", "%", Kind::Figure),
    Column::new("ms", "time", "ms", Kind::Time),
    Column::new("saved", "time saved", "%", Kind::Time),
    Column::new("saved_low", "at least, at 95%", "%", Kind::Time),
];

const CHARTS: [ChartSpec; 1] = [ChartSpec {
    title: "Time saved against error",
    caption: "To the right and down is better. Cutting bounces saves time where there is glass to bounce in, and it shows: a ray that is \
              cut inside glass ends in black. A formula for a formula changes little of either, as the time goes into finding hits.",
    only: ("", ""),
    drawn: Drawn::Points {
        x: Axis { column: "saved", title: "time saved, % →", scale: Scale::Linear },
        y: Axis { column: "rmse", title: "↑ RMSE to the reference, of 255", scale: Scale::Log },
        series: "scene",
        label: "approximation",
        joined: false,
        zeros: "the same picture",
    },
}];

/// The section.
pub(super) const SECTION: Section = Section {
    id: "model",
    chapter: Chapter::Model,
    title: "Schlick for Fresnel, few bounces for many",
    how: "Pictures with one sample a pixel: <code>--fresnel schlick</code> against <code>exact</code>, <code>--depth</code> 1, 2, 3, 5 \
          against 16. Errors of the written pictures first; times in a run of their own, one thread, approximation and reference in turns. \
          Caustics, soft shadows and light from surface to surface are not modelled at all (docs/MODEL.md has the list), and this says \
          nothing of them.",
    columns: &COLUMNS,
    charts: &CHARTS,
    labels: |_| Ok(SCENES.iter().flat_map(|scene| ways().map(move |(way, _)| format!("{scene}, {way}"))).collect()),
    measure,
    says,
};

const SCENES: [&str; 2] = ["refraction", "teapot"];
const DEEP: u32 = 16;

/// The approximations: what is changed in the reference, which is exact Fresnel at depth 16.
fn ways() -> impl Iterator<Item = (String, (Fresnel, u32))> {
    let depths = [1, 2, 3, 5].map(|depth| (format!("depth {depth}"), (Fresnel::Exact, depth)));
    [("schlick".to_owned(), (Fresnel::Schlick, DEEP))].into_iter().chain(depths)
}

/// A scene with what an approximation changes.
fn scene_with(name: &str, size: &Overrides, (fresnel, depth): (Fresnel, u32)) -> Result<(Scene, SceneNeeds), AppError> {
    Ok(placed(name, &Overrides { fresnel: Some(fresnel), depth: Some(depth), ..*size })?)
}

fn measure(run: &Run) -> Result<Measured, AppError> {
    let (width, height) = run.size((16, 12), (112, 84), (640, 480));
    let size = sized(width, height);
    let settings = format!("{}; {width}x{height}, one sample a pixel; {} rounds, 1 thread", run.mode.name(), run.rounds());
    let mut rows = Vec::new();
    for name in SCENES {
        let scenes = [("reference".to_owned(), (Fresnel::Exact, DEEP))]
            .into_iter()
            .chain(ways())
            .map(|(way, change)| Ok((way, scene_with(name, &size, change)?)))
            .collect::<Result<Vec<_>, AppError>>()?;
        let tree = BspTree::build(&scenes[0].1.0.tris);
        // Errors.
        let shots: Vec<Shot> = scenes.iter().map(|(_, (scene, needs))| shot_by(scene, *needs, &tree)).collect();
        // Times.
        let times = gz_app::threads::with(1, || {
            let mut turns: Vec<Box<dyn FnMut() + '_>> = Vec::new();
            for (_, (scene, needs)) in &scenes {
                let tree = &tree;
                turns.push(Box::new(move || {
                    std::hint::black_box(shot_by(scene, *needs, tree));
                }));
            }
            Ok(take_turns(run.rounds(), &mut turns))
        })?;
        let rays = |shot: &Shot| shot.frame.stats.rays() as f64;
        for (k, (way, _)) in scenes.iter().enumerate().skip(1) {
            let (_, bytes) = shots[k].differences(&shots[0]);
            let ratio = Ratio::of(&times[k], &times[0]);
            let cells = cells![
                name,
                way.as_str(),
                bytes.rmse,
                bytes.max,
                100.0 * bytes.differing as f64 / bytes.pixels as f64,
                100.0 * rays(&shots[k]) / rays(&shots[0]),
                median(&times[k]) * 1e3,
                100.0 * (1.0 - ratio.mean),
                100.0 * (1.0 - ratio.high),
            ];
            rows.push(Row { cells, n: bytes.pixels as u64, settings: settings.clone() });
        }
    }
    Ok(Measured { rows, pictures: Vec::new() })
}

fn says(table: &Table) -> String {
    let mut numbers = Numbers::default();
    let find = |way: &str| {
        (0..table.rows.len()).find(|&row| table.words(row, "scene") == "teapot" && table.words(row, "approximation") == way)
    };
    let (Some(schlick), Some(three), Some(five)) = (find("schlick"), find("depth 3"), find("depth 5")) else {
        return String::new();
    };
    let of = |row: usize, name: &str| table.number(row, name).unwrap_or(f64::NAN);
    format!(
        "On the default scene Schlick's formula is off by {} of 255 and saves {} of the time. The paper's depth of 3 is off by {} and \
         saves {}; depth 5 still by {}.",
        numbers.say("schlick", of(schlick, "rmse"), "rmse", ""),
        numbers.say("schlick saved", of(schlick, "saved"), "saved", " %"),
        numbers.say("three", of(three, "rmse"), "rmse", ""),
        numbers.say("three saved", of(three, "saved"), "saved", " %"),
        numbers.say("five", of(five, "rmse"), "rmse", ""),
    )
}
