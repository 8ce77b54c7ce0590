//! Scenes and rays that look for trouble.

use gz_core::glam::DVec3;
use gz_core::{GzCoord, GzRay};
use proptest::prelude::*;

/// Corners of a triangle.
pub(super) type Corners = [GzCoord; 3];

/// Numbers that meet each other and lie at the ends of ranges: whole ones, tenths, their neighbours, powers of two and of ten, zeros of
/// both signs, subnormal ones, and small ones beside a large offset.
pub(super) fn number() -> impl Strategy<Value = f32> {
    prop_oneof![
        6 => (-4i8..=4).prop_map(f32::from),
        4 => (-40i8..=40).prop_map(|k| f32::from(k) / 10.0),
        3 => (-4i8..=4).prop_map(|k| f32::from(k).next_up()),
        3 => (-4i8..=4).prop_map(|k| f32::from(k).next_down()),
        2 => (-20i32..=20, any::<bool>()).prop_map(|(k, minus)| if minus { -(2f32.powi(k)) } else { 2f32.powi(k) }),
        2 => (-8.0f64..8.0, any::<bool>()).prop_map(|(k, minus)| if minus { -(10f64.powf(k)) } else { 10f64.powf(k) } as f32),
        2 => prop_oneof![Just(0.0), Just(-0.0), Just(1e-40), Just(-1e-45)],
        1 => (-1.0f32..1.0).prop_map(|x| 1e6 + x),
    ]
}

/// Numbers of one size: what they are multiplied by, or added to, stays in range.
pub(super) fn plain_number() -> impl Strategy<Value = f32> {
    prop_oneof![
        3 => (-4i8..=4).prop_map(f32::from),
        3 => (-40i8..=40).prop_map(|k| f32::from(k) / 10.0),
        2 => -4.0f32..4.0,
    ]
}

pub(super) fn point() -> BoxedStrategy<GzCoord> {
    [number(), number(), number()].prop_map(GzCoord::from_array).boxed()
}

pub(super) fn plain_point() -> BoxedStrategy<GzCoord> {
    [plain_number(), plain_number(), plain_number()].prop_map(GzCoord::from_array).boxed()
}

/// Triangles over few points, so that they share corners and edges, repeat and lose their area; some drawn out to needles, some laid into
/// a plane across an axis.
pub(super) fn triangles_over(point: BoxedStrategy<GzCoord>) -> impl Strategy<Value = Vec<Corners>> {
    let picks = prop::collection::vec((any::<[u8; 3]>(), 0u8..8), 1..50);
    (prop::collection::vec(point, 3..12), picks).prop_map(|(points, picks)| {
        picks
            .iter()
            .map(|(pick, kind)| {
                let mut corners = pick.map(|k| points[usize::from(k) % points.len()]);
                match kind {
                    0 => corners[2] = corners[0] + (corners[1] - corners[0]) * 0.5 + (corners[2] - corners[0]) * 1e-6,
                    1..=2 => {
                        let (axis, [a, b, c]) = (usize::from(pick[0]) % 3, &mut corners);
                        (b[axis], c[axis]) = (a[axis], a[axis]);
                    }
                    _ => {}
                }
                corners
            })
            .filter(|corners| corners.iter().all(|p| p.is_finite()))
            .collect()
    })
}

pub(super) fn triangles() -> impl Strategy<Value = Vec<Corners>> {
    triangles_over(point())
}

/// How a ray is aimed; it becomes one when there are triangles to aim at.
#[derive(Clone, Debug)]
pub(super) struct Shot {
    origin: GzCoord,
    aim: GzCoord,
    target: u8,
    how: u8,
    weights: [f64; 2],
    tmin: f32,
    tmax: f32,
}

pub(super) fn shots() -> impl Strategy<Value = Vec<Shot>> {
    shots_from(point())
}

pub(super) fn shots_from(point: BoxedStrategy<GzCoord>) -> impl Strategy<Value = Vec<Shot>> {
    let ends =
        prop_oneof![5 => Just((0.0, f32::INFINITY)), 1 => (number(), number()), 1 => Just((f32::NEG_INFINITY, f32::INFINITY))];
    let shot = (point.clone(), point, any::<u8>(), any::<u8>(), [0.0..1.0f64, 0.0..1.0f64], ends);
    let shot =
        shot.prop_map(|(origin, aim, target, how, weights, (tmin, tmax))| Shot { origin, aim, target, how, weights, tmin, tmax });
    prop::collection::vec(shot, 1..30)
}

impl Shot {
    /// At the inside, an edge or a corner of a triangle; at the middle of the scene's box; along an axis, in the middle plane of the box;
    /// from a corner, or from a point of a triangle's plane; along an edge; at anything.
    pub(super) fn ray(&self, triangles: &[Corners]) -> GzRay {
        let Some(&[a, b, c]) = triangles.get(usize::from(self.target) % triangles.len().max(1)) else {
            return GzRay::new(self.origin, self.aim - self.origin);
        };
        let (lo, hi) = triangles.iter().flatten().fold((a, a), |(lo, hi), p| (lo.min(*p), hi.max(*p)));
        let middle = lo * 0.5 + hi * 0.5;
        let [u, v] = self.weights;
        let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
        let on = |u: f64, v: f64| a.as_dvec3() * (1.0 - u - v) + b.as_dvec3() * u + c.as_dvec3() * v;
        let axis = usize::from(self.target) % 3;
        let to = |point: DVec3| GzRay::new(self.origin, (point - self.origin.as_dvec3()).as_vec3());
        let ray = match self.how % 12 {
            0 | 1 => to(on(u, v)),
            2 => to(on(u, 0.0)),
            3 => to(on(0.5, 0.0)),
            4 => to(a.as_dvec3()),
            5 => to(middle.as_dvec3()),
            6 => GzRay::new(self.origin, GzCoord::AXES[axis] * if self.how & 16 == 0 { 1.0 } else { -1.0 }),
            7 => {
                let (mut origin, mut direction) = (self.origin, self.aim - self.origin);
                (origin[axis], direction[axis]) = (middle[axis], if self.how & 16 == 0 { 0.0 } else { -0.0 });
                GzRay::new(origin, direction)
            }
            8 => GzRay::new(a, self.aim - a),
            9 => GzRay::from_f64(on(u, v), self.aim),
            10 => GzRay::new(self.origin, b - a),
            _ => GzRay::new(self.origin, self.aim - self.origin),
        };
        GzRay { tmin: self.tmin, tmax: self.tmax, ..ray }
    }
}

/// The rays of `shots` at `triangles`.
pub(super) fn rays(shots: &[Shot], triangles: &[Corners]) -> Vec<GzRay> {
    shots.iter().map(|shot| shot.ray(triangles)).collect()
}
