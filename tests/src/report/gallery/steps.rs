//! The steps of the paper as pictures.

use crate::bench::timing::seconds;
use crate::cells;
use crate::model::{placed, shot_by};
use crate::report::picture::Picture;
use crate::report::run::Run;
use crate::report::section::{Chapter, Measured, Section};
use crate::report::table::{Column, Kind, Row, Table};
use gz_app::error::AppError;
use gz_app::load::Overrides;
use gz_bsp::BspTree;
use gz_shade::Antialias;

const COLUMNS: [Column; 8] = [
    Column::new("picture", "picture", "", Kind::Label),
    Column::new("triangles", "triangles", "", Kind::Count),
    Column::new("primary", "primary", "rays", Kind::Count),
    Column::new("shadow", "shadow", "rays", Kind::Count),
    Column::new("mirror", "mirror", "rays", Kind::Count),
    Column::new("glass", "glass", "rays", Kind::Count),
    Column::new("nan", "NaN", "pixels", Kind::Count),
    Column::new("seconds", "time, all threads", "s", Kind::Time),
];

/// The section.
pub(in crate::report) const SECTION: Section = Section {
    id: "steps",
    chapter: Chapter::Pictures,
    title: "Step by step",
    how: "The scenes of <code>assets/scenes</code>, one for each step of the paper; <code>cargo xtask render all</code> makes them large. The \
          paper's figures are of our own teapot here, as the course's data is not ours to show.",
    columns: &COLUMNS,
    charts: &[],
    labels: |_| Ok(PICTURES.iter().map(|(name, ..)| (*name).to_owned()).collect()),
    measure,
    says: |_: &Table| String::new(),
};

/// Scene, width of the quick and of the full picture, and what it shows.
const PICTURES: [(&str, u32, u32, &str); 7] = [
    (
        "teapot",
        640,
        800,
        "The default scene. Porcelain, glass, a mirror and a stone floor, each ray's front-most triangle found exactly.",
    ),
    ("plain", 300, 400, "Primary rays. The nearest T wins, as the nearest Z did (the paper's 2.3.1 to 2.3.3)."),
    ("shadows", 300, 400, "Shadow rays. One to each light from every hit (2.3.4)."),
    ("reflection", 300, 400, "Mirror rays. The mirror shows the back of the pot (2.3.5)."),
    ("refraction", 300, 400, "Glass rays. A leaning pane shifts what is behind it (2.3.6)."),
    ("paper-reflection", 256, 256, "The paper's figure 1. Its camera, lights and mirror, around our teapot."),
    ("paper-refraction", 256, 256, "The paper's figure 2. With the mistake at its mirror that its program had."),
];

fn measure(run: &Run) -> Result<Measured, AppError> {
    let mut measured = Measured::default();
    for (name, quick, full, caption) in PICTURES {
        let width = run.size(16, quick, full);
        let native = crate::report::gallery::buffers::native(name)?;
        let samples = run.size(1, 3, 16);
        // The paper has one sample a pixel, and its camera one size.
        let aa = if name.starts_with("paper") { Antialias::None } else { Antialias::Samples(samples) };
        let size = (width, (width * native.1).div_ceil(native.0));
        let (scene, needs) = placed(name, &Overrides { size: Some(size), aa: Some(aa), ..Overrides::NONE })?;
        let tree = BspTree::build(&scene.tris);
        let (time, shot) = seconds(|| shot_by(&scene, needs, &tree));
        let stats = &shot.frame.stats;
        let cells = cells![
            name,
            scene.tris.len(),
            stats.primary_rays,
            stats.shadow_rays,
            stats.mirror_rays,
            stats.glass_rays,
            stats.nan_pixels,
            time,
        ];
        let settings = format!("{}; {}x{}, {}", run.mode.name(), size.0, size.1, gz_app::args::antialias_name(aa));
        measured.rows.push(Row { cells, n: u64::from(size.0 * size.1), settings });
        measured.pictures.push(Picture::of_frame(name, caption, &shot.frame, shot.code)?);
    }
    Ok(measured)
}
