//! What each scene of assets needs, and what each need costs.

use crate::bench::timing::{median, take_turns};
use crate::cells;
use crate::model::{shot_by, sized};
use crate::rendered::scene_path;
use crate::report::findings::Numbers;
use crate::report::run::Run;
use crate::report::section::{Chapter, ChartSpec, Drawn, Measured, Section};
use crate::report::table::{Cell, Column, Kind, Row, Table};
use crate::scenes::names;
use gz_app::error::AppError;
use gz_app::explain::needs_in_use;
use gz_app::load::{self, Overrides};
use gz_bsp::BspTree;
use gz_core::{Attributes, TriBuffer};
use gz_shade::{Antialias, Scene, SceneNeeds};

const COLUMNS: [Column; 24] = [
    Column::new("scene", "scene", "", Kind::Label),
    Column::new("needs", "needs", "", Kind::Note),
    Column::new("triangles", "triangles", "", Kind::Count),
    Column::new("primary", "primary", "rays", Kind::Count),
    Column::new("shadow", "shadow", "rays", Kind::Count),
    Column::new("tint", "through glass to a light", "rays", Kind::Count),
    Column::new("mirror", "mirror", "rays", Kind::Count),
    Column::new("glass", "glass", "rays", Kind::Count),
    Column::new("positions", "positions", "kB", Kind::Figure),
    Column::new("normals", "normals", "kB", Kind::Figure),
    Column::new("uvs", "texture coordinates", "kB", Kind::Figure),
    Column::new("colors", "triangle colours", "kB", Kind::Figure),
    Column::new("materials", "material numbers", "kB", Kind::Figure),
    Column::new("classes", "classes", "kB", Kind::Figure),
    Column::new("all_kb", "with all needs on", "kB", Kind::Figure),
    Column::new("all_rays", "rays with all needs on", "rays", Kind::Count),
    Column::new("same", "picture with all needs on differs", "pixels", Kind::Count),
    Column::new("ms", "time", "ms", Kind::Time),
    Column::new("all_ms", "time with all needs on", "ms", Kind::Time),
    Column::new("base_ms", "nothing but hits and local colour", "ms", Kind::Time),
    Column::new("shadows_ms", "shadows", "ms", Kind::Time),
    Column::new("mirrors_ms", "mirrors", "ms", Kind::Time),
    Column::new("glass_ms", "glass", "ms", Kind::Time),
    Column::new("textures_ms", "textures", "ms", Kind::Time),
];

const CHARTS: [ChartSpec; 3] = [
    ChartSpec {
        title: "Rays by kind",
        caption: "A scene without shadows casts no shadow rays, one without glass no glass rays.",
        only: ("", ""),
        drawn: Drawn::Bars { parts: &["primary", "shadow", "tint", "mirror", "glass"], title: "rays, one sample a pixel →" },
    },
    ChartSpec {
        title: "Bytes by array",
        caption: "Corners are always there. Normals, texture coordinates, materials and classes only where something in use asks for them.",
        only: ("", ""),
        drawn: Drawn::Bars {
            parts: &["positions", "normals", "uvs", "colors", "materials", "classes"],
            title: "kB of triangles →",
        },
    },
    ChartSpec {
        title: "Time by need",
        caption: "What each need takes away with it when it is turned off by itself. Rays that two needs make together, such as the shadow rays of \
                  what is seen through glass, count in both, so that the rest may vanish.",
        only: ("", ""),
        drawn: Drawn::Bars {
            parts: &["base_ms", "shadows_ms", "mirrors_ms", "glass_ms", "textures_ms"],
            title: "ms for the picture, one thread →",
        },
    },
];

/// The section.
pub(super) const SECTION: Section = Section {
    id: "needs",
    chapter: Chapter::Needs,
    title: "Scene by scene",
    how: "Every scene of <code>assets/scenes</code> that needs no course data, one sample a pixel. Rays and bytes are counted in a run of their \
          own, in which the picture with the computed needs is compared with that of all needs on, bit by bit. Then times, one thread, in \
          turns: with the computed needs, with all on, and with each need off by itself; the difference is what that need costs. Costs below \
          nothing, which is noise, are shown as nothing in the bars.",
    columns: &COLUMNS,
    charts: &CHARTS,
    labels: |run| Ok(scenes(run)),
    measure,
    says,
};

/// Scenes that need no course data, or all that can be loaded where it may be used.
fn scenes(run: &Run) -> Vec<String> {
    let mut scenes = names();
    scenes.retain(|name| run.course || !name.starts_with("hw"));
    scenes.retain(|name| load::scene(&scene_path(name), &Overrides::NONE).is_ok());
    scenes.truncate(run.size(2, usize::MAX, usize::MAX));
    scenes
}

/// The variants that are timed: with the computed needs, with all, and without each of four kinds.
fn variants(needs: SceneNeeds) -> [SceneNeeds; 6] {
    [
        needs,
        SceneNeeds::ALL,
        SceneNeeds { shadows: false, ..needs },
        SceneNeeds { mirrors: false, ..needs },
        SceneNeeds { glass: false, ..needs },
        SceneNeeds { image_textures: false, procedural_textures: false, ..needs },
    ]
}

/// What a variant takes away, if the scene has it.
fn takes_something(needs: SceneNeeds, variant: SceneNeeds) -> bool {
    variant != needs && variant != SceneNeeds::ALL
}

fn kb_of(tris: &TriBuffer, keep: Attributes) -> f64 {
    (keep.bytes_per_triangle() * tris.len()) as f64 / 1e3
}

fn measure(run: &Run) -> Result<Measured, AppError> {
    let width = run.size(16, 200, 640);
    let rounds = run.size(1, 5, 15);
    let settings = format!("{}; {width} pixels wide, one sample a pixel; {rounds} rounds, 1 thread", run.mode.name());
    let mut rows = Vec::new();
    for name in scenes(run) {
        run.progress.say(&format!("  needs: {name}"));
        let full = load::scene(&scene_path(&name), &Overrides::NONE)?.scene.camera;
        let size = Overrides { aa: Some(Antialias::None), ..sized(width, (width * full.height()).div_ceil(full.width())) };
        let place = |needs: Option<SceneNeeds>| -> Result<(Scene, SceneNeeds), AppError> {
            let draft = load::scene(&scene_path(&name), &size)?;
            let needs = needs.unwrap_or_else(|| SceneNeeds::of(&draft.scene));
            Ok((draft.place(needs)?, needs))
        };
        // Counts.
        let (scene, needs) = place(None)?;
        let (all, _) = place(Some(SceneNeeds::ALL))?;
        let (tree, tree_of_all) = (BspTree::build(&scene.tris), BspTree::build(&all.tris));
        let (shot, shot_of_all) = (shot_by(&scene, needs, &tree), shot_by(&all, SceneNeeds::ALL, &tree_of_all));
        let bits = |color: &gz_core::GzColor| color.to_array().map(f32::to_bits);
        let differing = shot.frame.colors.iter().zip(&shot_of_all.frame.colors).filter(|(a, b)| bits(a) != bits(b)).count();
        let stats = &shot.frame.stats;
        let keep = scene.tris.attributes();
        let none = Attributes::default();
        let kb = |kept: Attributes| kb_of(&scene.tris, kept) - kb_of(&scene.tris, none);
        // Times.
        let timed = variants(needs);
        let asked: Vec<usize> = (0..timed.len()).filter(|&k| k < 2 || takes_something(needs, timed[k])).collect();
        let times = gz_app::threads::with(1, || {
            let mut turns: Vec<Box<dyn FnMut() + '_>> = Vec::new();
            for &k in &asked {
                let (scene, query) = if k == 1 { (&all, &tree_of_all) } else { (&scene, &tree) };
                let needs = timed[k];
                turns.push(Box::new(move || {
                    std::hint::black_box(shot_by(scene, needs, query));
                }));
            }
            Ok(take_turns(rounds, &mut turns))
        })?;
        let ms = |k: usize| asked.iter().position(|&asked| asked == k).map(|at| median(&times[at]) * 1e3);
        let whole = ms(0).unwrap_or(f64::NAN);
        let cost = |k: usize| ms(k).map(|without| (whole - without).max(0.0));
        let base = whole - (2..timed.len()).filter_map(cost).sum::<f64>();
        let mut cells = cells![
            name.as_str(),
            needs_in_use(&scene).join(", ").replace('_', " "),
            scene.tris.len(),
            stats.primary_rays,
            stats.shadow_rays,
            stats.tint_queries,
            stats.mirror_rays,
            stats.glass_rays,
            kb_of(&scene.tris, none),
            kb(Attributes { normals: keep.normals, ..none }),
            kb(Attributes { uvs: keep.uvs, ..none }),
            kb(Attributes { colors: keep.colors, ..none }),
            kb(Attributes { materials: keep.materials, ..none }),
            kb(Attributes { classes: keep.classes, ..none }),
            kb_of(&all.tris, Attributes::ALL),
            shot_of_all.frame.stats.rays(),
            differing,
            whole,
            ms(1),
            base.max(0.0),
        ];
        cells.extend((2..timed.len()).map(|k| Cell::from(cost(k))));
        rows.push(Row { cells, n: stats.primary_rays, settings: settings.clone() });
    }
    Ok(Measured { rows, pictures: Vec::new() })
}

fn says(table: &Table) -> String {
    let mut numbers = Numbers::default();
    let rows = 0..table.rows.len();
    let share = |row: usize| {
        let own: f64 =
            ["positions", "normals", "uvs", "colors", "materials", "classes"].iter().filter_map(|c| table.number(row, c)).sum();
        Some(100.0 * own / table.number(row, "all_kb")?)
    };
    let Some(least) = rows
        .clone()
        .filter(|&row| share(row).is_some())
        .min_by(|&a, &b| share(a).partial_cmp(&share(b)).unwrap_or(std::cmp::Ordering::Equal))
    else {
        return String::new();
    };
    let differing: f64 = rows.filter_map(|row| table.number(row, "same")).sum();
    let same = if differing == 0.0 {
        "With all needs on every picture comes out the same to the bit."
    } else {
        "With all needs on some pictures differ, which is a bug."
    };
    format!(
        "The scene <i>{}</i> stores {} of what it would with all needs on. {same}",
        super::super::chart::escape(table.words(least, "scene")),
        numbers.say("share", share(least).unwrap_or(f64::NAN), "positions to classes, all_kb", " %"),
    )
}
