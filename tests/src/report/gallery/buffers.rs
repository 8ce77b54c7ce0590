//! The homework's Z-buffer beside the T-value buffer of the same view, and what else a T-value buffer tells.

use super::srgb;
use crate::cells;
use crate::model::{placed, sized};
use crate::report::findings::Numbers;
use crate::report::picture::Picture;
use crate::report::run::Run;
use crate::report::section::{Chapter, Measured, Section};
use crate::report::table::{Column, Kind, Row, Table};
use crate::z_buffer::{Difference, teapot_view};
use gz_app::error::AppError;
use gz_app::view::{View, trace_hits};
use gz_bsp::BspTree;
use gz_core::TileGrid;

const COLUMNS: [Column; 5] = [
    Column::new("buffer", "buffer", "", Kind::Label),
    Column::new("covered", "covered", "pixels", Kind::Count),
    Column::new("alone", "covered by it alone", "pixels", Kind::Count),
    Column::new("other", "another triangle than the other", "pixels", Kind::Count),
    Column::new("depths", "different depths in it", "", Kind::Count),
];

/// The section.
pub(in crate::report) const SECTION: Section = Section {
    id: "buffers",
    chapter: Chapter::Pictures,
    title: "Z and T of one view",
    how: "A teapot on a floor through the homework's camera. Z: scan conversion as in the homework, in f32, screen z interpolated along edges \
          and rows, the least kept. T: a ray through each pixel, the least distance kept. Below, what the T-value buffer of the scene \
          <code>paper-reflection</code> holds, as <code>gz render --view t</code>, <code>id</code> and <code>normal</code> show it.",
    columns: &COLUMNS,
    charts: &[],
    labels: |_| Ok(["Z-buffer", "T-value buffer"].map(str::to_owned).to_vec()),
    measure,
    says,
};

/// Width and height that a scene has of itself.
pub(super) fn native(name: &str) -> Result<(u32, u32), AppError> {
    let path = crate::rendered::scene_path(name);
    let camera = gz_app::load::scene(&path, &gz_app::load::Overrides::NONE)?.scene.camera;
    Ok((camera.width(), camera.height()))
}

fn measure(run: &Run) -> Result<Measured, AppError> {
    let size = run.size(32, 320, 512);
    let view = teapot_view(size)?;
    let Difference { both, other, only_z, only_t, depths_z, depths_t } = view.difference();
    let settings = format!("{}; {size}x{size}", run.mode.name());
    let row = |name: &str, alone: usize, depths: usize| Row {
        cells: cells![name, both + alone, alone, other, depths],
        n: u64::from(size * size),
        settings: settings.clone(),
    };
    let rows = vec![row("Z-buffer", only_z, depths_z), row("T-value buffer", only_t, depths_t)];

    let (width, height) = run.size((16, 16), (256, 256), (512, 512));
    let (scene, _) = placed("paper-reflection", &sized(width, height))?;
    let grid = TileGrid::whole(width, height, 32);
    let hits = trace_hits(&scene, &BspTree::build(&scene.tris), &grid);
    let by_view = |name: &str, caption: &str, view: View| {
        Picture::drawing(name, caption, width, height, &srgb(&view.colors(&scene, &hits, &grid)))
    };
    let shot = |name: &str, caption: &str, shot: &crate::failures::Shot| {
        Picture::drawing(name, caption, shot.width, shot.height, &shot.rgb)
    };
    let pictures = vec![
        shot(
            "z.before",
            "Z, by scan conversion. Left, the homework's buffer: screen z crowds towards its far end, where f32 tells few depths apart.",
            &view.z_shot(),
        )?,
        shot(
            "z.after",
            "T, by a ray a pixel. Right, the T-value buffer: distance along the ray, even all the way.",
            &view.t_shot(),
        )?,
        shot(
            "z.difference",
            "Beside it where they differ: grey is the same triangle, yellow another, red only Z, blue only T.",
            &view.difference_shot(),
        )?,
        by_view("t", "T-values. White where the scene's box begins, dark where it ends; black is no hit.", View::T)?,
        by_view("ids", "Which triangle. Each number in a colour of its own.", View::Id)?,
        by_view("normals", "Which way it faces. Face normals as colours: what shading has to smooth over.", View::Normal)?,
    ];
    Ok(Measured { rows, pictures })
}

fn says(table: &Table) -> String {
    let mut numbers = Numbers::default();
    let (Some(z), Some(t)) = (table.row("buffer", "Z-buffer"), table.row("buffer", "T-value buffer")) else {
        return String::new();
    };
    let of = |row: usize, name: &str| table.number(row, name).unwrap_or(f64::NAN);
    let alone = of(z, "alone") + of(t, "alone");
    let same = match alone {
        0.0 => "Both buffers cover the same pixels".to_owned(),
        alone => format!("The buffers cover the same pixels but for {}", numbers.count("alone", alone, "alone")),
    };
    let other = match of(t, "other") {
        0.0 => "name the same triangle on every one".to_owned(),
        other => format!("name another triangle on {}, along edges", numbers.count("other", other, "other")),
    };
    format!(
        "{same}, {} in all, and {other}. Z holds {} different depths, T {}. From each T a further ray can be sent, which a scan converter \
         cannot do.",
        numbers.count("covered", of(t, "covered"), "covered"),
        numbers.count("depths of z", of(z, "depths"), "depths"),
        numbers.count("depths of t", of(t, "depths"), "depths"),
    )
}
