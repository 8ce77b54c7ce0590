//! The walk of a primary ray: where it went, and what became of each triangle on the way.

use crate::accel::Built;
use gz_bsp::Step;
use gz_core::kernel::{FilterSpace, Rung, plain, rung};
use gz_core::{ClassMask, GzRay, Kernel, TriBuffer, TriId};

/// A triangle that was looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tried {
    pub(super) tri: TriId,
    /// Its T-value, if the ray hits it.
    pub(super) t: Option<f32>,
    /// What proved that; `None` for a test that proves nothing.
    pub(super) by: Option<Rung>,
}

/// A node or leaf on the way.
pub(super) struct Place {
    pub(super) step: Step,
    /// For a leaf: its triangles in the order in which they are looked at.
    pub(super) tried: Vec<Tried>,
}

/// The nodes and leaves on the walk of `ray`, in the order of visit; none for brute force.
pub(super) fn places(built: &Built<'_>, ray: &GzRay) -> Vec<Place> {
    let (steps, space) = match built {
        Built::Brute(_) => return Vec::new(),
        Built::Bsp(tree) => (tree.steps(ray, ClassMask::ALL).1, Some(space(built.query().tris()))),
        // The paper's walk has no test in f32.
        Built::Midpoint(tree) => (tree.steps(ray, ClassMask::ALL).1, None),
    };
    let tris = built.query().tris();
    let place = |step: Step| {
        let listed = step.triangles.iter().flatten();
        Place { tried: listed.map(|&tri| tried(tris, ray, tri, space.as_ref())).collect(), step }
    };
    steps.into_iter().map(place).collect()
}

/// What became of every triangle by brute force; nothing for a tree.
pub(super) fn all_tried(built: &Built<'_>, ray: &GzRay) -> Vec<Tried> {
    let Built::Brute(brute) = built else { return Vec::new() };
    if !ray.is_valid() {
        return Vec::new();
    }
    let tris = built.query().tris();
    let all = 0..tris.len() as TriId;
    match brute.kernel() {
        Kernel::Certified => {
            let space = space(tris);
            all.map(|tri| tried(tris, ray, tri, Some(&space))).collect()
        }
        kernel => all.map(|tri| Tried { tri, t: plain(kernel, ray, tris.position(tri)).map(|(t, _, _)| t), by: None }).collect(),
    }
}

fn space(tris: &TriBuffer) -> FilterSpace {
    FilterSpace::new(tris.bounds().reaches())
}

fn tried(tris: &TriBuffer, ray: &GzRay, tri: TriId, space: Option<&FilterSpace>) -> Tried {
    let corners = tris.position(tri);
    let (is_hit, by) = rung(ray, corners, space);
    let t = is_hit.then(|| plain(Kernel::Certified, ray, corners)).flatten().map(|(t, _, _)| t);
    Tried { tri, t, by: Some(by) }
}

/// How many triangles were missed, in words: `6 missed by f32, 1 by f64`.
pub(super) fn missed(tried: &[Tried]) -> String {
    let count = |by: Option<Rung>| tried.iter().filter(|it| it.t.is_none() && it.by == by).count();
    let kinds = [Some(Rung::F32), Some(Rung::F64), Some(Rung::Exact), None];
    let told: Vec<String> = kinds
        .into_iter()
        .filter(|&by| count(by) > 0)
        .map(|by| match by {
            Some(by) => format!("{} missed by {}", count(Some(by)), name(by)),
            None => format!("{} missed", count(None)),
        })
        .collect();
    if told.is_empty() { "none missed".to_owned() } else { told.join(", ") }
}

/// The arithmetic by name.
pub(super) fn name(by: Rung) -> &'static str {
    match by {
        Rung::F32 => "f32",
        Rung::F64 => "f64",
        Rung::Exact => "whole numbers",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn misses_are_told_by_what_proved_them() {
        let tried = |t, by| Tried { tri: 0, t, by };
        let list = [
            tried(None, Some(Rung::F32)),
            tried(Some(1.0), Some(Rung::F32)),
            tried(None, Some(Rung::F32)),
            tried(None, Some(Rung::Exact)),
        ];
        assert_eq!(missed(&list), "2 missed by f32, 1 missed by whole numbers");
        assert_eq!(missed(&list[1..2]), "none missed");
        assert_eq!(missed(&[tried(None, None)]), "1 missed");
    }
}
