//! The homework's Z-buffer beside the T-value buffer of the same view.

use super::srgb;
use crate::cells;
use crate::model::placed;
use crate::rendered::scene_path;
use crate::report::findings::Numbers;
use crate::report::picture::Picture;
use crate::report::run::Run;
use crate::report::section::{Chapter, Measured, Section};
use crate::report::table::{Column, Kind, Row, Table};
use gz_app::error::AppError;
use gz_app::load::{self, Overrides};
use gz_app::view::{View, trace_hits};
use gz_bsp::BspTree;
use gz_core::glam::DVec2;
use gz_core::{CameraModel, GzColor, Hit, NO_TRI, TileGrid, TriId};
use gz_shade::{Antialias, Scene};

const COLUMNS: [Column; 6] = [
    Column::new("buffer", "buffer", "", Kind::Label),
    Column::new("covered", "covered", "pixels", Kind::Count),
    Column::new("alone", "covered by it alone", "pixels", Kind::Count),
    Column::new("other", "another triangle", "pixels", Kind::Count),
    Column::new("far", "depth apart by more than 1e-5", "pixels", Kind::Count),
    Column::new("worst", "depth apart at most, relative", "", Kind::Figure),
];

/// The section.
pub(in crate::report) const SECTION: Section = Section {
    id: "buffers",
    chapter: Chapter::Pictures,
    title: "Z and T of one view",
    how: "The view of the course's fifth homework (its camera, our teapot on its plane). Z: a plain scan converter as the homework has it, \
          screen z interpolated, the least kept. T: a ray through each pixel, the least distance kept. Depth is compared as z of image space.",
    columns: &COLUMNS,
    charts: &[],
    labels: |_| Ok(["Z-buffer", "T-value buffer"].map(str::to_owned).to_vec()),
    measure,
    says,
};

/// Width and height that a scene has of itself.
pub(super) fn native(name: &str) -> Result<(u32, u32), AppError> {
    let camera = load::scene(&scene_path(name), &Overrides::NONE)?.scene.camera;
    Ok((camera.width(), camera.height()))
}

/// A pixel of the Z-buffer: screen z from 0 to 1, and the triangle.
type Depth = (f64, TriId);

/// The homework's scan conversion: every triangle of image space taken to the screen, its z interpolated there, the least z kept.
fn z_buffer(scene: &Scene) -> Vec<Depth> {
    let (width, height, d) = (scene.camera.width(), scene.camera.height(), scene.camera.focal_distance());
    let mut pixels = vec![(f64::INFINITY, NO_TRI); (width * height) as usize];
    for (tri, corners) in (0..).zip(scene.tris.positions()) {
        let screen = corners.map(|p| {
            let p = p.as_dvec3();
            let w = p.z / d + 1.0;
            let (x, y) = ((p.x / w + 1.0) * f64::from(width) / 2.0, (1.0 - p.y / w) * f64::from(height) / 2.0);
            (DVec2::new(x, y), p.z / d / w)
        });
        let [a, b, c] = screen.map(|(p, _)| p);
        let area = (b - a).perp_dot(c - a);
        if area == 0.0 || !area.is_finite() {
            continue;
        }
        let (lo, hi) = (a.min(b).min(c).ceil().max(DVec2::ZERO), a.max(b).max(c).floor());
        let (x1, y1) = (hi.x.min(f64::from(width - 1)), hi.y.min(f64::from(height - 1)));
        for y in lo.y as i64..=y1 as i64 {
            for x in lo.x as i64..=x1 as i64 {
                let p = DVec2::new(x as f64, y as f64);
                let weights = [(c - b).perp_dot(p - b), (a - c).perp_dot(p - c), (b - a).perp_dot(p - a)].map(|w| w / area);
                if weights.iter().all(|&w| w >= 0.0) {
                    let z = (0..3).map(|k| weights[k] * screen[k].1).sum::<f64>();
                    let pixel = &mut pixels[(y * i64::from(width) + x) as usize];
                    // The first of several at the same depth stays.
                    if z < pixel.0 {
                        *pixel = (z, tri);
                    }
                }
            }
        }
    }
    pixels
}

/// z of image space of each pixel of the T-value buffer.
fn z_of_hits(scene: &Scene, hits: &[Hit]) -> Vec<Option<f64>> {
    hits.iter().map(|hit| hit.is_hit().then(|| scene.tris.hit_point(hit).z)).collect()
}

fn measure(run: &Run) -> Result<Measured, AppError> {
    let size = run.size(32, 256, 256);
    let overrides =
        Overrides { camera: Some(CameraModel::Homework), size: Some((size, size)), aa: Some(Antialias::None), ..Overrides::NONE };
    let (scene, _) = placed("paper-reflection", &overrides)?;
    let tree = BspTree::build(&scene.tris);
    let grid = TileGrid::whole(size, size, 32);
    let hits = trace_hits(&scene, &tree, &grid);
    let depths = z_buffer(&scene);
    let d = scene.camera.focal_distance();
    // Screen z is s = (z / d) / (z / d + 1).
    let image_z = |&(s, tri): &Depth| (tri != NO_TRI).then(|| d * s / (1.0 - s));
    let (z, t) = (depths.iter().map(image_z).collect::<Vec<_>>(), z_of_hits(&scene, &hits));

    let both = || z.iter().zip(&t).filter_map(|(z, t)| Some(((*z)?, (*t)?)));
    let apart = |(z, t): (f64, f64)| (z / t - 1.0).abs();
    let far = both().filter(|pair| apart(*pair) > 1e-5).count();
    let worst = both().map(apart).fold(0.0, f64::max);
    let alone =
        |one: &[Option<f64>], other: &[Option<f64>]| one.iter().zip(other).filter(|(a, b)| a.is_some() && b.is_none()).count();
    let others = depths.iter().zip(&hits).filter(|((_, a), b)| *a != NO_TRI && b.is_hit() && *a != b.tri).count();
    let settings = format!("{}; {size}x{size}", run.mode.name());
    let n = u64::from(size * size);
    let row = |name: &str, own: &[Option<f64>], other: &[Option<f64>]| Row {
        cells: cells![name, own.iter().flatten().count(), alone(own, other), others, far, worst],
        n,
        settings: settings.clone(),
    };
    let rows = vec![row("Z-buffer", &z, &t), row("T-value buffer", &t, &z)];

    // Pictures: nearest white, farthest dark, each by its own numbers.
    let shown = |values: &[Option<f64>]| -> Vec<u8> {
        let (lo, hi) = values.iter().flatten().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), &x| (lo.min(x), hi.max(x)));
        let grey = |value: &Option<f64>| {
            value.map_or(GzColor::ZERO, |x| GzColor::splat((1.0 - 0.94 * (x - lo) / (hi - lo).max(1e-30)) as f32))
        };
        srgb(&values.iter().map(grey).collect::<Vec<_>>())
    };
    let screen_z: Vec<Option<f64>> = depths.iter().map(|&(s, tri)| (tri != NO_TRI).then_some(s)).collect();
    let distances: Vec<Option<f64>> = hits.iter().map(|hit| hit.is_hit().then_some(f64::from(hit.t))).collect();
    let picture = |name: &str, caption: &str, rgb: &[u8]| Picture::drawing(name, caption, size, size, rgb);
    let by_view = |view: View| srgb(&view.colors(&scene, &hits, &grid));
    let pictures = vec![
        picture(
            "z.before",
            "Z, by scan conversion. Left, the homework's buffer: screen z is nearly one number wherever something is far, so most of its \
             range is spent close to the eye.",
            &shown(&screen_z),
        )?,
        picture(
            "z.after",
            "T, by a ray a pixel. Right, the T-value buffer: distance along the ray, even all the way. The covered pixels are the same.",
            &shown(&distances),
        )?,
        picture(
            "ids",
            "Which triangle. Each number in a colour of its own; the plane is two triangles, the mirror one.",
            &by_view(View::Id),
        )?,
        picture(
            "normals",
            "Which way it faces. Face normals as colours: what shading has to smooth over.",
            &by_view(View::Normal),
        )?,
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
    let same = if alone == 0.0 {
        "Both buffers cover the same pixels".to_owned()
    } else {
        format!("The buffers cover the same pixels but for {}", numbers.count("alone", alone, "alone"))
    };
    let other = match of(t, "other") {
        0.0 => "name the same triangle on every one".to_owned(),
        other => format!("name another triangle on {} of them, along edges", numbers.count("other", other, "other")),
    };
    format!(
        "{same}, {} in all, and {other}. A ray can then be sent on from each, which a scan converter cannot do.",
        numbers.count("covered", of(t, "covered"), "covered"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::run::Mode;

    #[test]
    fn scan_conversion_and_rays_see_the_same() {
        let table = Table { columns: COLUMNS.to_vec(), rows: measure(&Run::new(Mode::Tiny, 1, false)).unwrap().rows };
        let of = |name: &str| table.number(0, name).unwrap();
        assert!(of("covered") > 100.0 && of("alone") <= 2.0 && of("other") < 0.05 * of("covered"), "{table:?}");
        assert!(of("far") <= of("other"), "{table:?}");
    }
}
