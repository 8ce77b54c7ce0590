//! `gz pixel`: one pixel explained.

use crate::accel::{Accel, Built};
use crate::cli::{AccelArgs, PixelArgs};
use crate::error::AppError;
use crate::progress::say;
use crate::{args, job, load, output, stats, threads};
use gz_bsp::VisitCount;
use gz_core::glam::{DVec2, DVec3};
use gz_core::{BruteForce, GzColor, GzRay, Hit, Kernel, RayQuery, Tile, TileGrid, TriBuffer};
use gz_shade::{ExplainNode, RayKind, Scene, SceneNeeds, Sight, explain_pixel, shade_frame};
use std::fmt::Write;

/// Triangles on the ray that are listed at most.
const LISTED: usize = 16;

/// What `gz pixel` found.
#[derive(Debug)]
pub struct Explained {
    /// The pixel, as lines of text.
    pub report: String,
    /// An error when `--compare` found another answer.
    pub verdict: Result<(), AppError>,
}

/// Does what `gz pixel` is asked for.
///
/// # Errors
///
/// If the scene cannot be used or has no such pixel. A difference under `--compare` is no error here: see [`Explained::verdict`].
pub fn explain(args: &PixelArgs) -> Result<Explained, AppError> {
    let accel = Accel::of(&args.scene.accel)?;
    let other = args.compare.map(|kind| Accel::of(&AccelArgs { accel: Some(kind), ..NO_CHOICE })).transpose()?;
    threads::with(args.scene.threads, || {
        let draft = load::scene(&args.scene.scene, &job::overrides(&args.scene))?;
        draft.warnings.iter().for_each(|warning| say(&format!("gz: warning: {warning}")));
        let (width, height) = (draft.scene.camera.width(), draft.scene.camera.height());
        if args.x >= width || args.y >= height {
            return Err(AppError::Usage(format!("pixel {} {} is outside of the picture of {width}x{height}", args.x, args.y)));
        }
        let needs = SceneNeeds::of(&draft.scene);
        let scene = draft.place(needs)?;
        let built = accel.build(&scene.tris)?;
        let report = describe(&scene, needs, &built, args);
        let verdict = match other {
            Some(other) => agree(&scene, other.build(&scene.tris)?.query(), built.query(), args),
            None => Ok(()),
        };
        Ok(Explained { report, verdict })
    })
}

fn describe(scene: &Scene, needs: SceneNeeds, built: &Built<'_>, args: &PixelArgs) -> String {
    let query = built.query();
    let ray = scene.camera.ray(args.x, args.y, DVec2::ZERO);
    let hit = query.closest_hit(&ray);
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = writeln!(text, "pixel      {} {}, camera {}", args.x, args.y, args::camera_name(scene.camera.model()));
    let (origin, direction) = (triple(ray.origin), triple(ray.direction.as_dvec3()));
    let (tmin, tmax) = (short(ray.tmin), short(ray.tmax));
    let _ = writeln!(text, "ray        origin {origin}, direction {direction}, t from {tmin} to {tmax}");
    let _ = match hit.is_hit() {
        true => writeln!(text, "hit        {}", hit_line(scene, &hit)),
        false => writeln!(text, "hit        nothing"),
    };
    let _ = match built.visits(&ray) {
        Some(VisitCount { nodes, leaves, groups, tests, .. }) => {
            writeln!(text, "visited    {nodes} nodes, {leaves} leaves, {groups} groups of eight triangles, {tests} tests in f64")
        }
        None => writeln!(text, "visited    {} triangles, all that there are", scene.tris.len()),
    };
    let all = all_hits(&scene.tris, &ray);
    let _ = writeln!(text, "on the ray {} triangles, front to back", all.len());
    for hit in all.iter().take(LISTED) {
        let _ = writeln!(text, "  {}", hit_line(scene, hit));
    }
    if all.len() > LISTED {
        let _ = writeln!(text, "  and {} more", all.len() - LISTED);
    }
    let area = Tile { x0: args.x, y0: args.y, x1: args.x + 1, y1: args.y + 1 };
    let frame = shade_frame(scene, needs, query, &TileGrid::of(area, 1), &|_| ());
    let _ = writeln!(text, "rays       {}", stats::rays_by_kind(&frame.stats));
    ray_tree(scene, &explain_pixel(scene, needs, query, args.x, args.y), &mut text);
    for color in &frame.colors {
        let bytes = color.to_array().map(|channel| output::byte(channel, scene.rules.color_code));
        let _ = writeln!(text, "colour     {} linear, {bytes:?} in a picture", triple(color.as_dvec3()));
    }
    text
}

/// The rays of the pixel as a tree, each below the one it goes on from, with its share of the colour.
fn ray_tree(scene: &Scene, nodes: &[ExplainNode], text: &mut String) {
    let mut children = vec![Vec::new(); nodes.len()];
    for (k, node) in nodes.iter().enumerate() {
        if let Some(parent) = node.parent {
            children[parent].push(k);
        }
    }
    for (k, node) in nodes.iter().enumerate().filter(|(_, node)| node.parent.is_none()) {
        let _ = writeln!(text, "sample {}, weight {}", node.sample, short(node.sample_weight));
        branch(scene, nodes, &children, k, 1, text);
    }
}

/// Node `k` and those below it, `level` steps in.
fn branch(scene: &Scene, nodes: &[ExplainNode], children: &[Vec<usize>], k: usize, level: usize, text: &mut String) {
    let (node, indent) = (&nodes[k], "  ".repeat(level));
    let kind = match node.kind {
        RayKind::Primary => "primary ray",
        RayKind::Mirror => "mirror ray",
        RayKind::Glass => "glass ray",
    };
    let (origin, direction) = (triple(node.ray.origin), triple(node.ray.direction.as_dvec3()));
    let _ = writeln!(text, "{indent}{kind} from {origin} along {direction}, counts {}", triple(node.factor.as_dvec3()));
    let what = if node.hit.is_hit() { hit_line(scene, &node.hit) } else { "nothing: background".to_owned() };
    let _ = writeln!(text, "{indent}  hits {what}");
    color_sum(scene, node, &indent, text);
    // The depth of a scene is at most 32, so this goes no deeper either.
    for &child in &children[k] {
        branch(scene, nodes, children, child, level + 1, text);
    }
}

/// How the colour of a node comes together: ambient light, light by light, own colour, with what comes from below.
fn color_sum(scene: &Scene, node: &ExplainNode, indent: &str, text: &mut String) {
    let color = |color: GzColor| triple(color.as_dvec3());
    if node.ambient != GzColor::ZERO || !node.lights.is_empty() {
        let _ = writeln!(text, "{indent}  ambient adds {}", color(node.ambient));
    }
    for part in &node.lights {
        let _ = write!(text, "{indent}  light {} adds {}: ", part.light, color(part.color));
        let _ = match part.sight {
            Sight::Behind => writeln!(text, "it is behind the triangle"),
            Sight::Nothing => writeln!(text, "the shading equation gives nothing"),
            Sight::InPlane => writeln!(text, "its shadow ray would run in the plane of the triangle"),
            Sight::Unasked => writeln!(text, "no shadow ray is needed"),
            Sight::Cast { ray, share, blocker } => {
                let (origin, direction) = (triple(ray.origin), triple(ray.direction.as_dvec3()));
                let found = match blocker.is_hit() {
                    true => format!("blocked by {}", hit_line(scene, &blocker)),
                    false if share == GzColor::ONE => "nothing in the way".to_owned(),
                    false => format!("tinted {} by glass in the way", color(share)),
                };
                writeln!(text, "shadow ray from {origin} along {direction}, t to {}, {found}", short(ray.tmax))
            }
        };
    }
    let (local, keep, all) = (color(node.local), short(node.keep), color(node.color));
    let _ = writeln!(text, "{indent}  own colour {local} times {keep}, with what comes from below: {all}");
}

/// `triangle 12 (brass) at T = 4.5, weights 0.2 0.3 0.5, point [1, 2, 3]`.
fn hit_line(scene: &Scene, hit: &Hit) -> String {
    let [a, b, c] = hit.weights().map(short);
    let material = scene.materials.get(usize::from(scene.tris.material(hit.tri))).map_or("", |material| &material.name);
    let point = triple(scene.tris.hit_point(hit));
    format!("triangle {} ({material}) at T = {}, weights {a} {b} {c}, point {point}", hit.tri, short(hit.t))
}

/// A number to at most 7 significant digits, with an exponent where it is far from 1.
fn short(number: impl Into<f64>) -> String {
    // The shortest text of the number after rounding has no digits beyond those.
    let rounded: f64 = format!("{:.6e}", number.into()).parse().unwrap_or(f64::NAN);
    match rounded.abs() {
        0.0 => "0".to_owned(), // of either sign
        size if size.is_finite() && !(1e-4..1e7).contains(&size) => format!("{rounded:e}"),
        _ => rounded.to_string(),
    }
}

/// `[1, 2, 3]`, each as [`short`] has it.
fn triple(of: DVec3) -> String {
    let [x, y, z] = of.to_array().map(short);
    format!("[{x}, {y}, {z}]")
}

/// Every triangle that the ray meets, by exact T-value as far as f32 tells it, then by number.
fn all_hits(tris: &TriBuffer, ray: &GzRay) -> Vec<Hit> {
    let alone = |(tri, corners): (usize, &[gz_core::GzCoord; 3])| {
        let buffer = TriBuffer::from_indexed(corners, &[[0, 1, 2]]).ok()?;
        let hit = BruteForce::new(&buffer).closest_hit(ray);
        hit.is_hit().then_some(Hit { tri: tri as u32, ..hit })
    };
    let mut hits: Vec<Hit> = tris.positions().iter().enumerate().filter_map(alone).collect();
    hits.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.tri.cmp(&b.tri)));
    hits
}

/// The options of nobody who has not said anything.
const NO_CHOICE: AccelArgs = AccelArgs { kernel: Kernel::Certified, accel: None, split: None, max_depth: None, min_size: None };

/// Whether `query` answers as `other` does.
fn agree(scene: &Scene, other: &dyn RayQuery, query: &dyn RayQuery, args: &PixelArgs) -> Result<(), AppError> {
    let ray = scene.camera.ray(args.x, args.y, DVec2::ZERO);
    let (expected, actual) = (other.closest_hit(&ray), query.closest_hit(&ray));
    let text = |hit: &Hit| if hit.is_hit() { hit_line(scene, hit) } else { "nothing".to_owned() };
    match expected == actual {
        true => Ok(()),
        false => Err(AppError::Differs(format!("the one hits {}, the other {}", text(&expected), text(&actual)))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gz_core::GzCoord;

    #[test]
    fn all_triangles_on_a_ray_are_listed_front_to_back() {
        let at = |z: f32| [[-1.0, -1.0, z], [3.0, -1.0, z], [-1.0, 3.0, z]].map(GzCoord::from_array);
        let corners: Vec<GzCoord> = [at(5.0), at(2.0), at(-1.0), at(2.0)].concat();
        let tris = TriBuffer::from_indexed(&corners, &[[0, 1, 2], [3, 4, 5], [6, 7, 8], [9, 10, 11]]).unwrap();
        let hits = all_hits(&tris, &GzRay::new(GzCoord::ZERO, GzCoord::Z));
        assert_eq!(hits.iter().map(|hit| (hit.tri, hit.t)).collect::<Vec<_>>(), [(1, 2.0), (3, 2.0), (0, 5.0)]);
    }

    #[test]
    fn numbers_are_short() {
        let cases = [
            (0.1f32.into(), "0.1"),
            (1.0 / 3.0, "0.3333333"),
            (-1234567.89, "-1234568"),
            (2.0789143e-37, "2.078914e-37"),
            (-0.0, "0"),
            (9_999_999.7, "1e7"),
            (f64::INFINITY, "inf"),
            (f64::NAN, "NaN"),
        ];
        for (number, text) in cases {
            assert_eq!(short(number), text);
        }
    }
}
