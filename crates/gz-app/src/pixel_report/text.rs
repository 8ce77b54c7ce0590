//! A pixel told to people.

use super::facts::{Facts, bits};
use super::walk::{Tried, missed, name};
use crate::{args, output, stats};
use gz_bsp::VisitCount;
use gz_core::glam::DVec3;
use gz_core::{GzColor, Hit};
use gz_shade::{ExplainNode, RayKind, Sight};
use std::fmt::Write;

/// Triangles on the ray that are listed at most.
const LISTED: usize = 16;
/// Nodes and leaves that are listed at most.
const STEPS: usize = 64;

impl Facts<'_> {
    /// All of it, as lines of text.
    pub(super) fn text(&self) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = writeln!(text, "pixel      {} {}, camera {}", self.x, self.y, args::camera_name(self.scene.camera.model()));
        let (origin, direction) = (triple(self.ray.origin), triple(self.ray.direction.as_dvec3()));
        let (tmin, tmax) = (short(self.ray.tmin), short(self.ray.tmax));
        let _ = writeln!(text, "ray        origin {origin}, direction {direction}, t from {tmin} to {tmax}");
        let _ = writeln!(text, "hit        {}", self.hit_line(&self.hit));
        let [t, _, u, v] = bits(&self.hit);
        let _ = writeln!(text, "bits       T {t:08x}, u {u:08x}, v {v:08x}");
        self.compared_line(&mut text);
        let _ = match self.visits {
            Some(VisitCount { nodes, leaves, groups, tests, .. }) => {
                writeln!(
                    text,
                    "visited    {nodes} nodes, {leaves} leaves, {groups} groups of eight triangles, {tests} tests in f64"
                )
            }
            None => writeln!(text, "visited    {} triangles, all that there are", self.scene.tris.len()),
        };
        self.walk(&mut text);
        let _ = writeln!(text, "on the ray {} triangles, front to back", self.on_ray.len());
        for hit in self.on_ray.iter().take(LISTED) {
            let _ = writeln!(text, "  {}", self.hit_line(hit));
        }
        if self.on_ray.len() > LISTED {
            let _ = writeln!(text, "  and {} more", self.on_ray.len() - LISTED);
        }
        let _ = writeln!(text, "rays       {}", stats::rays_by_kind(&self.frame.stats));
        self.ray_tree(&mut text);
        for color in &self.frame.colors {
            let bytes = color.to_array().map(|channel| output::byte(channel, self.scene.rules.color_code));
            let _ = writeln!(text, "colour     {} linear, {bytes:?} in a picture", triple(color.as_dvec3()));
        }
        text
    }

    fn compared_line(&self, text: &mut String) {
        let Some((other, hit)) = &self.compared else { return };
        let _ = match self.agrees() {
            true => writeln!(text, "compare    {other} has the same triangle, T, u and v, to the bit"),
            false => writeln!(text, "compare    {other} differs: {}", self.hit_line(hit)),
        };
    }

    /// Nodes and leaves in the order of visit, and what became of each triangle.
    fn walk(&self, text: &mut String) {
        if self.places.is_empty() {
            if !self.tried.is_empty() {
                let _ = writeln!(text, "tested     {}", missed(&self.tried));
                hits_of(&self.tried, text);
            }
            return;
        }
        let _ = writeln!(text, "walk       in the order of visit, with the distances between which the ray is in each");
        for place in self.places.iter().take(STEPS) {
            let step = &place.step;
            let kind = if step.triangles.is_some() { "leaf" } else { "node" };
            let (number, enter, leave) = (step.number, short(step.enter), short(step.leave));
            let _ = write!(text, "  {kind} {number:<6} {enter} to {leave}");
            let _ = match step.triangles {
                Some(_) => writeln!(text, ", {} triangles: {}", place.tried.len(), missed(&place.tried)),
                None => writeln!(text),
            };
            hits_of(&place.tried, text);
        }
        if self.places.len() > STEPS {
            let _ = writeln!(text, "  and {} more", self.places.len() - STEPS);
        }
    }

    /// The rays of the pixel as a tree, each below the one it goes on from, with its share of the colour.
    fn ray_tree(&self, text: &mut String) {
        let mut children = vec![Vec::new(); self.nodes.len()];
        for (k, node) in self.nodes.iter().enumerate() {
            if let Some(parent) = node.parent {
                children[parent].push(k);
            }
        }
        for (k, node) in self.nodes.iter().enumerate().filter(|(_, node)| node.parent.is_none()) {
            let _ = writeln!(text, "sample {}, weight {}", node.sample, short(node.sample_weight));
            self.branch(&children, k, 1, text);
        }
    }

    /// Node `k` and those below it, `level` steps in.
    fn branch(&self, children: &[Vec<usize>], k: usize, level: usize, text: &mut String) {
        let (node, indent) = (&self.nodes[k], "  ".repeat(level));
        let (origin, direction) = (triple(node.ray.origin), triple(node.ray.direction.as_dvec3()));
        let (counts, share) = (triple(node.factor.as_dvec3()), triple(self.shares[k].as_dvec3()));
        let kind = kind(node.kind);
        let _ = writeln!(text, "{indent}{kind} ray from {origin} along {direction}, counts {counts}, of the pixel {share}");
        let what = if node.hit.is_hit() { self.hit_line(&node.hit) } else { "nothing: background".to_owned() };
        let _ = writeln!(text, "{indent}  hits {what}");
        if let Some(VisitCount { nodes, leaves, .. }) = self.walks[k] {
            let _ = writeln!(text, "{indent}  visits {nodes} nodes and {leaves} leaves");
        }
        self.color_sum(node, &indent, text);
        // The depth of a scene is at most 32, so this goes no deeper either.
        for &child in &children[k] {
            self.branch(children, child, level + 1, text);
        }
    }

    /// How the colour of a node comes together: ambient light, light by light, own colour, with what comes from below.
    fn color_sum(&self, node: &ExplainNode, indent: &str, text: &mut String) {
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
                        true => format!("blocked by {}", self.hit_line(&blocker)),
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

    /// `triangle 12 (brass) at T = 4.5, weights 0.2 0.3 0.5, point [1, 2, 3]`, or `nothing`.
    pub(super) fn hit_line(&self, hit: &Hit) -> String {
        if !hit.is_hit() {
            return "nothing".to_owned();
        }
        let [a, b, c] = hit.weights().map(short);
        let (tri, material, point) = (hit.tri, self.material(hit), triple(self.point(hit)));
        format!("triangle {tri} ({material}) at T = {}, weights {a} {b} {c}, point {point}", short(hit.t))
    }
}

/// The triangles of a list that were hit, one a line.
fn hits_of(tried: &[Tried], text: &mut String) {
    for it in tried {
        if let Some(t) = it.t {
            let by = it.by.map_or_else(String::new, |by| format!(", by {}", name(by)));
            let _ = writeln!(text, "    triangle {} hit at T = {}{by}", it.tri, short(t));
        }
    }
}

/// `primary`, `mirror` or `glass`.
pub(super) fn kind(kind: RayKind) -> &'static str {
    match kind {
        RayKind::Primary => "primary",
        RayKind::Mirror => "mirror",
        RayKind::Glass => "glass",
    }
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

#[cfg(test)]
mod tests {
    use super::*;

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
