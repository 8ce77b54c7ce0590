//! Triangles as a builder sees them: a number and the box of the part that lies in a cell.

use super::tight::TightBox;
use glam::{DVec3, Vec3};
use gz_core::{Bounds, TriId};

/// A triangle's part in a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Reference {
    /// A box around the part, never too small.
    pub(crate) bounds: TightBox,
    pub(crate) tri: TriId,
}

impl Reference {
    /// The whole triangle.
    pub(crate) fn whole(tri: TriId, corners: &[Vec3; 3]) -> Self {
        Self { tri, bounds: TightBox::of(&Bounds::of(*corners)) }
    }

    /// The parts below and above `axis = plane`, for a part whose box crosses the plane: boxes around the corners of each side and the
    /// points where edges cross, cut with the box before. `None` for a side on which the earlier cuts have left nothing.
    pub(crate) fn split(&self, axis: usize, plane: f32, corners: &[Vec3; 3]) -> [Option<Self>; 2] {
        let mut sides = [Bounds::EMPTY; 2];
        let p = f64::from(plane);
        for k in 0..3 {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            if a[axis] <= plane {
                sides[0] = sides[0].grown_by(a);
            }
            if a[axis] >= plane {
                sides[1] = sides[1].grown_by(a);
            }
            if (a[axis] < plane && b[axis] > plane) || (a[axis] > plane && b[axis] < plane) {
                let (a, b) = (a.as_dvec3(), b.as_dvec3());
                let at = a + (b - a) * ((p - a[axis]) / (b[axis] - a[axis]));
                // Six roundings of numbers up to twice the largest coordinate of the edge, and one to f32: 16 u of it covers them.
                let pad = a.abs().max(b.abs()) * (8.0 * f64::EPSILON);
                let (low, high) = (round_down(at - pad), round_up(at + pad));
                sides = sides.map(|s| s.grown_by(low).grown_by(high));
            }
        }
        let before = self.bounds.bounds();
        let [mut lower, mut upper] = sides.map(|s| Bounds { min: s.min.max(before.min), max: s.max.min(before.max) });
        lower.max[axis] = lower.max[axis].min(plane);
        upper.min[axis] = upper.min[axis].max(plane);
        [lower, upper].map(|part| (!part.is_empty()).then(|| Self { tri: self.tri, bounds: TightBox::of(&part) }))
    }
}

fn round_down(p: DVec3) -> Vec3 {
    Vec3::from_array(p.to_array().map(|x| {
        let r = x as f32;
        if f64::from(r) > x { r.next_down() } else { r }
    }))
}

fn round_up(p: DVec3) -> Vec3 {
    -round_down(-p)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_cover_the_triangle_and_stay_on_their_side() {
        let corners = [[0.0, 0.0, 0.0], [3.0, 0.1, 7.0], [0.7, 5.0, -2.0]].map(Vec3::from_array);
        let whole = Reference::whole(0, &corners);
        for (axis, plane) in [(0, 1.0), (1, 0.05), (2, 0.3), (2, -1.9)] {
            let [lower, upper] = whole.split(axis, plane, &corners).map(|part| part.unwrap().bounds.bounds());
            assert!(lower.max[axis] <= plane && upper.min[axis] >= plane);
            for k in 0..400 {
                let (u, v) = ((k % 20) as f32 / 19.0, (k / 20) as f32 / 19.0);
                let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
                let p = corners[0] + (corners[1] - corners[0]) * u + (corners[2] - corners[0]) * v;
                let part = if p[axis] <= plane { lower } else { upper };
                let slack = Vec3::splat(1e-6);
                assert!(Bounds { min: part.min - slack, max: part.max + slack }.holds(p), "{axis} {plane} {p}");
            }
            assert!(lower.area() < whole.bounds.area() && upper.area() < whole.bounds.area());
        }
    }

    /// Corners and planes are whole numbers, so that f64 holds every number compared here exactly: 13 bits, 26 after one product.
    #[test]
    fn where_edges_cross_a_plane_both_parts_reach_and_hardly_further() {
        let mut state = 11u64;
        let mut whole = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 52) as f32 - 2048.0
        };
        let (mut crossings, mut rounded) = (0, 0);
        for round in 0..20_000 {
            let corners: [Vec3; 3] = std::array::from_fn(|_| Vec3::new(whole(), whole(), whole()));
            let (axis, plane) = (round % 3, whole());
            let bounds = Bounds::of(corners);
            if !(bounds.min[axis] < plane && plane < bounds.max[axis]) {
                continue;
            }
            let parts = Reference::whole(0, &corners).split(axis, plane, &corners).map(|part| part.unwrap().bounds.bounds());
            for corner in corners {
                let part = &parts[usize::from(corner[axis] > plane)];
                assert!(part.holds(corner), "{corners:?} {axis} {plane}");
            }
            // What each part must hold along an axis: its corners, and where edges cross.
            for k in 0..3 {
                let (a, b) = (corners[k].as_dvec3(), corners[(k + 1) % 3].as_dvec3());
                let (way, along) = (b[axis] - a[axis], f64::from(plane) - a[axis]);
                if along * (b[axis] - f64::from(plane)) <= 0.0 {
                    continue;
                }
                crossings += 1;
                for other in (0..3).filter(|&other| other != axis) {
                    // The crossing times |way|.
                    let exact = (a[other] * way + (b[other] - a[other]) * along) * way.signum();
                    for part in &parts {
                        let [low, high] = [part.min[other], part.max[other]].map(|end| f64::from(end) * way.abs());
                        assert!(low <= exact && exact <= high, "{corners:?} {axis} {plane}: {low} {exact} {high}");
                        rounded += u32::from(low == exact || exact == high);
                    }
                }
            }
            for (side, part) in parts.iter().enumerate() {
                for other in (0..3).filter(|&other| other != axis) {
                    let near = |p: &Vec3| if side == 0 { p[axis] <= plane } else { p[axis] >= plane };
                    let mut ends = [f64::INFINITY, f64::NEG_INFINITY];
                    let mut take = |x: f64| ends = [ends[0].min(x), ends[1].max(x)];
                    for k in 0..3 {
                        let (a, b) = (corners[k], corners[(k + 1) % 3]);
                        if near(&a) {
                            take(f64::from(a[other]));
                        }
                        if (a[axis] - plane) * (b[axis] - plane) < 0.0 {
                            let (a, b) = (a.as_dvec3(), b.as_dvec3());
                            take(a[other] + (b[other] - a[other]) * ((f64::from(plane) - a[axis]) / (b[axis] - a[axis])));
                        }
                    }
                    // Two steps of f32 at 2048 at most.
                    let slack = 2.0 / 4096.0;
                    assert!(f64::from(part.min[other]) >= ends[0] - slack && f64::from(part.max[other]) <= ends[1] + slack);
                }
            }
        }
        assert!(crossings > 15_000, "{crossings} crossings, {rounded} ends exactly there");
    }

    #[test]
    fn a_part_that_earlier_cuts_removed_is_none() {
        let corners = [[0.0, 0.0, 0.0], [4.0, 4.0, 0.0], [0.0, 0.1, 0.0]].map(Vec3::from_array);
        // The upper part begins at y = 2, so below x = 1 there is nothing left of it.
        let [_, upper] = Reference::whole(0, &corners).split(1, 2.0, &corners);
        let upper = upper.unwrap();
        let [lower, _] = upper.split(0, 1.0, &corners);
        assert!(lower.is_none());
    }
}
