//! The cells of a tree, drawn over the picture.

use crate::accel::Built;
use crate::color_scale::scale_color;
use crate::projection::Projection;
use gz_bsp::{MidpointTree, Node};
use gz_core::glam::{DVec2, DVec3};
use gz_core::{Bounds, GzColor, Hit, Tile};
use gz_shade::{Frame, Scene};

/// A box of a tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Its extent in trace space.
    pub bounds: Bounds,
    /// How deep it lies. In the paper's tree the root has level 1; in the tree that tunes itself the eight cells of the root have.
    pub level: usize,
}

/// The leaves of the tree; or with a `level` its cells of that level, and the leaves above it. None for brute force.
pub fn cells(built: &Built<'_>, level: Option<usize>) -> Vec<Cell> {
    let deepest = level.unwrap_or(usize::MAX);
    let mut cells = Vec::new();
    match built {
        Built::Brute(_) => {}
        Built::Bsp(tree) => tree.visit_cells(|&bounds, level, is_leaf| {
            if level == deepest || (is_leaf && level < deepest) {
                cells.push(Cell { bounds, level });
            }
        }),
        Built::Midpoint(tree) => descend(tree, 0, 1, deepest, &mut cells),
    }
    cells
}

fn descend(tree: &MidpointTree<'_>, id: u32, level: usize, deepest: usize, cells: &mut Vec<Cell>) {
    match tree.nodes()[id as usize] {
        Node::Inner { front, back, .. } if level < deepest => {
            descend(tree, back, level + 1, deepest, cells);
            descend(tree, front, level + 1, deepest, cells);
        }
        Node::Inner { bounds, .. } => cells.push(Cell { bounds, level }),
        // Empty leaves are cells as well, but what a tree without triangles has is no box.
        Node::Leaf { bounds, .. } if bounds.is_empty() => {}
        Node::Leaf { bounds, .. } => cells.push(Cell { bounds, level }),
    }
}

/// How strongly a line covers what is behind it, in front of all triangles and behind one.
const SEEN: f32 = 0.9;
const HIDDEN: f32 = 0.1;
/// What is left of the picture's own light, so that lines stand out.
const DIMMED: f32 = 0.55;
/// A line on a surface is in front of it: T-values as close as this are taken as equal.
const CLOSE: f64 = 2e-3;

/// Draws the edges of `cells` over `frame`, a picture of `scene` whose primary rays hit `hits`; deep cells lighter than shallow ones. What a
/// triangle hides shows through faintly.
pub fn draw(scene: &Scene, cells: &[Cell], frame: &mut Frame, hits: &[Hit]) {
    let (least, most) = cells.iter().fold((usize::MAX, 0), |(lo, hi), cell| (lo.min(cell.level), hi.max(cell.level)));
    let color = |level: usize| match most - least {
        0 => scale_color(0.85),
        levels => scale_color(0.35 + 0.65 * (level - least) as f64 / levels as f64),
    };
    let mut ink = Ink { area: frame.area, hits, covered: vec![(0.0, GzColor::ZERO); frame.colors.len()] };
    let (projection, size) =
        (Projection::of(&scene.camera), DVec2::new(scene.camera.width().into(), scene.camera.height().into()));
    for cell in cells {
        for [a, b] in edges(&cell.bounds) {
            if let Some(line) = projection.segment(a, b, size, 2.0) {
                let steps = (line.pixels[1] - line.pixels[0]).abs().max_element().ceil().max(1.0);
                for k in 0..=steps as u32 {
                    let (pixel, t) = line.at(f64::from(k) / steps);
                    ink.dot(pixel, t, color(cell.level));
                }
            }
        }
    }
    for (color, (share, line)) in frame.colors.iter_mut().zip(&ink.covered) {
        *color = *color * DIMMED * (1.0 - share) + *line * *share;
    }
}

/// The twelve edges of a box.
fn edges(bounds: &Bounds) -> impl Iterator<Item = [DVec3; 2]> + use<> {
    let ends = [bounds.min.as_dvec3(), bounds.max.as_dvec3()];
    let corner = move |k: usize| DVec3::new(ends[k & 1].x, ends[k >> 1 & 1].y, ends[k >> 2].z);
    (0..8).flat_map(move |k| [1, 2, 4].into_iter().filter(move |bit| k & bit == 0).map(move |bit| [corner(k), corner(k | bit)]))
}

/// What lines cover, pixel by pixel: the share, and the colour of the line that covers most.
struct Ink<'h> {
    area: Tile,
    hits: &'h [Hit],
    covered: Vec<(f32, GzColor)>,
}

impl Ink<'_> {
    /// A dot a pixel wide around `at`, over the pixels that it touches.
    fn dot(&mut self, at: DVec2, t: f64, color: GzColor) {
        let (corner, part) = (at.floor(), at.fract_gl());
        for (dx, wide) in [(0.0, 1.0 - part.x), (1.0, part.x)] {
            for (dy, high) in [(0.0, 1.0 - part.y), (1.0, part.y)] {
                self.cover(corner.x + dx, corner.y + dy, wide * high, t, color);
            }
        }
    }

    fn cover(&mut self, x: f64, y: f64, part: f64, t: f64, color: GzColor) {
        let Tile { x0, y0, x1, y1 } = self.area;
        if !((f64::from(x0)..f64::from(x1)).contains(&x) && (f64::from(y0)..f64::from(y1)).contains(&y)) {
            return;
        }
        let k = (y as u32 - y0) as usize * self.area.width() as usize + (x as u32 - x0) as usize;
        let hit = &self.hits[k];
        let is_seen = !hit.is_hit() || t <= f64::from(hit.t) * (1.0 + CLOSE);
        // Twice the part, as a line through the corner of four pixels would fade otherwise.
        let share = (2.0 * part).min(1.0) as f32 * if is_seen { SEEN } else { HIDDEN };
        if share > self.covered[k].0 {
            self.covered[k] = (share, color);
        }
    }
}
