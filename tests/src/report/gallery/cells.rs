//! The cells of the paper's tree, painted on what the picture shows.

use super::srgb;
use crate::cells;
use crate::model::{placed, shot_by};
use crate::report::picture::Picture;
use crate::report::run::Run;
use crate::report::section::{Chapter, Measured, Section};
use crate::report::table::{Column, Kind, Row, Table};
use gz_app::accel::Accel;
use gz_app::cells::{cells as cells_of, draw};
use gz_app::error::AppError;
use gz_app::load::Overrides;
use gz_app::view::trace_hits;
use gz_bsp::{BspTree, Midpoint, MidpointTree, Node};
use gz_core::glam::DVec3;
use gz_core::{GzColor, TileGrid};
use gz_shade::Antialias;

const COLUMNS: [Column; 4] = [
    Column::new("depth", "MAX_DEPTH", "", Kind::Label),
    Column::new("leaves", "leaves", "", Kind::Count),
    Column::new("seen", "leaves seen", "", Kind::Count),
    Column::new("most", "most triangles in a leaf seen", "", Kind::Count),
];

/// The section.
pub(in crate::report) const SECTION: Section = Section {
    id: "cells",
    chapter: Chapter::Tree,
    title: "Cells on the scene",
    how: "The paper's scene with each point painted by the leaf that holds it, MIN_SIZE 5; then the edges of cells of one level, as <code>gz \
          render --view cells</code> draws them.",
    columns: &COLUMNS,
    charts: &[],
    labels: |_| Ok(DEPTHS.map(|depth| depth.to_string()).to_vec()),
    measure,
    says: |_: &Table| String::new(),
};

const DEPTHS: [u32; 3] = [5, 10, 15];

/// The leaf that holds a point, and how many triangles are listed there.
fn leaf_at(tree: &MidpointTree<'_>, point: DVec3) -> (u32, u32) {
    let mut id = 0;
    loop {
        match tree.nodes()[id as usize] {
            Node::Inner { axis, plane, front, back, .. } => id = if point[axis] < f64::from(plane) { back } else { front },
            Node::Leaf { count, .. } => return (id, count),
        }
    }
}

/// A light colour of its own for each number.
fn tint(id: u32) -> GzColor {
    let mixed = id.wrapping_add(1).wrapping_mul(0x9e37_79b1);
    let hue = (mixed >> 8) as f32 / (1u32 << 24) as f32 * std::f32::consts::TAU;
    let channel = |turn: f32| 0.62 + 0.38 * wave(hue + turn);
    GzColor::new(channel(0.0), channel(2.1), channel(4.2))
}

/// A wave like the cosine's, the same on every machine.
fn wave(x: f32) -> f32 {
    // A parabola on each half turn is enough for colours.
    let turns = x / std::f32::consts::TAU;
    let half = 2.0 * (turns - turns.floor());
    let hump = |h: f32| 4.0 * h * (1.0 - h);
    if half < 0.5 {
        hump(half + 0.5)
    } else if half < 1.5 {
        -hump(half - 0.5)
    } else {
        hump(half - 1.5)
    }
}

fn measure(run: &Run) -> Result<Measured, AppError> {
    let size = run.size(24, 320, 512);
    let (scene, needs) =
        placed("paper-reflection", &Overrides { size: Some((size, size)), aa: Some(Antialias::None), ..Overrides::NONE })?;
    let tuned = BspTree::build(&scene.tris);
    let hits = trace_hits(&scene, &tuned, &TileGrid::whole(size, size, 32));
    let frame = shot_by(&scene, needs, &tuned).frame;
    let mut measured = Measured::default();
    for max_depth in DEPTHS {
        let setting = Midpoint { max_depth, min_size: 5, ..Midpoint::default() };
        let tree = MidpointTree::build(&scene.tris, setting).map_err(|error| AppError::Usage(error.to_string()))?;
        let of_pixel: Vec<Option<(u32, u32)>> =
            hits.iter().map(|hit| hit.is_hit().then(|| leaf_at(&tree, scene.tris.hit_point(hit)))).collect();
        let painted = |k: usize| {
            let Some((leaf, _)) = of_pixel[k] else { return GzColor::splat(0.92) };
            let shade = frame.colors[k].dot(GzColor::new(0.3, 0.6, 0.1)).clamp(0.0, 1.0);
            let differs = |other: usize| of_pixel.get(other).copied().flatten().is_some_and(|(it, _)| it != leaf);
            let edge = (k as u32 % size + 1 < size && differs(k + 1)) || differs(k + size as usize);
            tint(leaf) * (0.35 + 0.65 * shade) * if edge { 0.25 } else { 1.0 }
        };
        let colors: Vec<GzColor> = (0..hits.len()).map(painted).collect();
        let mut seen: Vec<(u32, u32)> = of_pixel.iter().flatten().copied().collect();
        seen.sort_unstable();
        seen.dedup();
        let leaves = tree.nodes().iter().filter(|node| matches!(node, Node::Leaf { .. })).count();
        let most = seen.iter().map(|(_, count)| *count).max().unwrap_or(0);
        let cells = cells![max_depth.to_string(), leaves, seen.len(), most];
        measured.rows.push(Row { cells, n: hits.len() as u64, settings: format!("{}; {size}x{size}", run.mode.name()) });
        let caption = match max_depth {
            5 => "MAX_DEPTH 5. A few large cells, all of the pot in a handful.",
            10 => "MAX_DEPTH 10. The pot is cut into blocks; where fewer than five triangles are left, cutting has stopped.",
            _ => {
                "MAX_DEPTH 15. Cells the size of a patch on the pot; the plane's two triangles are listed in every cell they cross."
            }
        };
        measured.pictures.push(Picture::drawing(&format!("depth{max_depth}"), caption, size, size, &srgb(&colors))?);
    }
    // The same as lines: every edge of every cell of a level.
    let lines: [(&str, Accel, Option<usize>, &str); 2] = [
        (
            "lines-midpoint",
            Accel::Midpoint(Midpoint::default()),
            Some(7),
            "Cells of level 7. The paper's tree halves boxes, whatever is in them. Lines behind a surface are faint.",
        ),
        (
            "lines-tuned",
            Accel::Bsp,
            Some(2),
            "Cells of level 2, self-tuned. Cut where it pays, eight cells a node, each shrunk to what it holds.",
        ),
    ];
    for (name, accel, level, caption) in lines {
        let built = accel.build(&scene.tris)?;
        let mut drawn = frame.clone();
        draw(&scene, &cells_of(&built, level), &mut drawn, &hits);
        measured.pictures.push(Picture::drawing(name, caption, size, size, &srgb(&drawn.colors))?);
    }
    Ok(measured)
}
