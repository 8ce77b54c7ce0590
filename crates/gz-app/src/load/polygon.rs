//! Polygons into triangles: n corners always give n - 2.

use glam::{DVec2, DVec3};
use gz_core::GzCoord;

/// The most corners of a polygon that is not convex; ear clipping takes time with their square or worse.
pub(crate) const MAX_CONCAVE: usize = 4096;

/// Cuts polygons, keeping its memory from one to the next.
#[derive(Default)]
pub(crate) struct Triangulator {
    flat: Vec<DVec2>,
    left: Vec<u32>,
    /// For each corner one that lay in its ear when it was last tried; itself where there was none.
    blocker: Vec<u32>,
    is_cut: Vec<bool>,
    triangles: Vec<[u32; 3]>,
}

impl Triangulator {
    /// The triangles of a polygon, as numbers of its corners, each with the winding of the polygon.
    ///
    /// A convex polygon gives the fan from its first corner. Every other one is seen along the axis nearest to its Newell normal
    /// and loses ears, in this order: corners are tried one after another, from the second on and around; an ear is cut as soon
    /// as it is met, and the search goes on at the corner after it. For a convex polygon that order is the fan again. When a
    /// round finds no ear (the outline crosses itself or is flat), the corner at which the round began is cut regardless. A
    /// polygon without a normal (all corners on a line) gives the fan.
    ///
    /// Fewer than three corners give none; `None` is a polygon that is not convex and has more than [`MAX_CONCAVE`] corners.
    ///
    /// Source: G. H. Meisters 1975, "Polygons Have Ears", for the existence of ears.
    pub(crate) fn cut(&mut self, corners: &[GzCoord]) -> Option<&[[u32; 3]]> {
        self.triangles.clear();
        let count = corners.len() as u32;
        if count < 3 {
            return Some(&self.triangles);
        }
        if count == 3 || !self.flatten(corners) || self.is_convex() {
            self.triangles.extend((1..count - 1).map(|k| [0, k, k + 1]));
        } else if corners.len() <= MAX_CONCAVE {
            self.clip_ears();
        } else {
            return None;
        }
        Some(&self.triangles)
    }

    /// Sees the polygon along the axis nearest to its normal, counter-clockwise. False without a normal.
    fn flatten(&mut self, corners: &[GzCoord]) -> bool {
        let origin = corners[0].as_dvec3();
        let seen = |k: usize| corners[k].as_dvec3() - origin;
        // Newell's normal: the sum of the fan's cross products.
        let normal = (1..corners.len() - 1).map(|k| seen(k).cross(seen(k + 1))).fold(DVec3::ZERO, |sum, n| sum + n);
        let size = normal.abs();
        let onto = |p: DVec3| match () {
            () if size.z >= size.x && size.z >= size.y => (DVec2::new(p.x, p.y), normal.z),
            () if size.x >= size.y => (DVec2::new(p.y, p.z), normal.x),
            () => (DVec2::new(p.z, p.x), normal.y),
        };
        self.flat.clear();
        self.flat
            .extend((0..corners.len()).map(seen).map(onto).map(|(p, side)| if side < 0.0 { DVec2::new(p.y, p.x) } else { p }));
        normal != DVec3::ZERO
    }

    /// No turn to the right, and once around: a star turns left at every tip too, but some triangle of its fan is turned over.
    fn is_convex(&self) -> bool {
        let (flat, n) = (&self.flat, self.flat.len());
        (0..n).all(|k| turn(flat[k], flat[(k + 1) % n], flat[(k + 2) % n]) >= 0.0)
            && (1..n - 1).all(|k| turn(flat[0], flat[k], flat[k + 1]) >= 0.0)
    }

    fn clip_ears(&mut self) {
        self.left.clear();
        self.left.extend(0..self.flat.len() as u32);
        self.blocker.clear();
        self.blocker.extend(0..self.flat.len() as u32);
        self.is_cut.clear();
        self.is_cut.resize(self.flat.len(), false);
        let (mut at, mut tried) = (1, 0);
        while self.left.len() > 3 {
            let n = self.left.len();
            let ear = [self.left[(at + n - 1) % n], self.left[at], self.left[(at + 1) % n]];
            if tried == n || self.is_ear(ear) {
                self.triangles.push(ear);
                self.is_cut[ear[1] as usize] = true;
                self.left.remove(at);
                at %= n - 1;
                tried = 0;
            } else {
                at = (at + 1) % n;
                tried += 1;
            }
        }
        self.triangles.push([self.left[0], self.left[1], self.left[2]]);
    }

    /// A left turn whose triangle, edges included, holds no other corner that is left; corners at the same place do not count.
    ///
    /// A corner that was in the way is asked again first: mostly it still is, and the others need not be looked at.
    fn is_ear(&mut self, ear: [u32; 3]) -> bool {
        let [a, b, c] = ear.map(|k| self.flat[k as usize]);
        let inside = |k: u32| {
            let p = self.flat[k as usize];
            p != a && p != b && p != c && turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0
        };
        if turn(a, b, c) <= 0.0 {
            return false;
        }
        let last = self.blocker[ear[1] as usize];
        if !self.is_cut[last as usize] && inside(last) {
            return false;
        }
        let found = self.left.iter().copied().find(|&k| inside(k));
        self.blocker[ear[1] as usize] = found.unwrap_or(ear[1]);
        found.is_none()
    }
}

/// Twice the area of a triangle, positive when it turns left.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(corners: &[[f32; 3]]) -> Vec<[u32; 3]> {
        let corners: Vec<_> = corners.iter().map(|&c| GzCoord::from_array(c)).collect();
        Triangulator::default().cut(&corners).unwrap().to_vec()
    }

    fn area(corners: &[[f32; 3]], triangles: &[[u32; 3]]) -> f64 {
        let at = |k: u32| GzCoord::from_array(corners[k as usize]).as_dvec3();
        triangles.iter().map(|&[a, b, c]| (at(b) - at(a)).cross(at(c) - at(a)).length() / 2.0).sum()
    }

    #[test]
    fn convex_polygons_are_fans_on_every_axis_and_both_windings() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.5, 1.0], [0.0, 1.0]];
        let fan = [[0, 1, 2], [0, 2, 3], [0, 3, 4]];
        for axis in 0..3 {
            let place = |[u, v]: [f32; 2]| std::array::from_fn(|k| [3.0, u, v][(k + axis) % 3]);
            let there: Vec<[f32; 3]> = square.iter().copied().map(place).collect();
            let back: Vec<[f32; 3]> = there.iter().copied().rev().collect();
            assert_eq!((cut(&there), cut(&back)), (fan.to_vec(), fan.to_vec()), "axis {axis}");
        }
    }

    #[test]
    fn an_arrow_is_cut_inside_whatever_corner_comes_first() {
        let arrow = [[0.0, 0.0, 0.0], [2.0, -1.0, 0.0], [0.0, 3.0, 0.0], [-2.0, -1.0, 0.0]];
        for first in 0..4 {
            let mut turned = arrow;
            turned.rotate_left(first);
            let triangles = cut(&turned);
            assert_eq!((triangles.len(), area(&turned, &triangles)), (2, 6.0), "{first}");
        }
        // The reflex corner comes first, so the second is an ear only where the fan would be right too.
        assert_eq!(cut(&arrow), [[0, 1, 2], [0, 2, 3]]);
        // The reflex corner comes second: it is no ear, the third is the first one met.
        assert_eq!(cut(&[[-2.0, -1.0, 0.0], [0.0, 0.0, 0.0], [2.0, -1.0, 0.0], [0.0, 3.0, 0.0]]), [[1, 2, 3], [0, 1, 3]]);
    }

    #[test]
    fn a_comb_keeps_its_area_and_its_winding() {
        let mut comb = Vec::new();
        for tooth in 0..50 {
            let x = tooth as f32 * 2.0;
            comb.extend([[x, 1.0, 0.0], [x + 1.0, 9.0, 0.0]]);
        }
        comb.extend([[100.0, 0.0, 0.0], [0.0, 0.0, 0.0]]);
        let shoelace = |k: usize| {
            let ([ax, ay, _], [bx, by, _]) = (comb[k], comb[(k + 1) % comb.len()]);
            f64::from(ax) * f64::from(by) - f64::from(bx) * f64::from(ay)
        };
        let expected = (0..comb.len()).map(shoelace).sum::<f64>() / 2.0;
        let triangles = cut(&comb);
        assert_eq!(triangles.len(), comb.len() - 2);
        assert_eq!(area(&comb, &triangles), expected.abs());
        for [a, b, c] in triangles {
            let flat = |k: u32| DVec2::new(f64::from(comb[k as usize][0]), f64::from(comb[k as usize][1]));
            assert!(turn(flat(a), flat(b), flat(c)) < 0.0, "the comb winds clockwise");
        }
    }

    #[test]
    fn whatever_the_outline_n_corners_give_n_minus_two() {
        let star = [0.0f32, 2.0, 4.0, 1.0, 3.0].map(|k| {
            let angle = k * std::f32::consts::TAU / 5.0;
            [angle.cos(), angle.sin(), 0.0]
        });
        assert_eq!(cut(&star).len(), 3);
        let bow = [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        assert_eq!(cut(&bow).len(), 2);
        let line = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [3.0, 0.0, 0.0]];
        assert_eq!(cut(&line), [[0, 1, 2], [0, 2, 3]]);
        let point = [[1.0; 3]; 6];
        assert_eq!(cut(&point).len(), 4);
        let bent = [[0.0, 0.0, 0.0], [1.0, 0.0, 5.0], [1.0, 1.0, -5.0], [0.2, 0.2, 3.0], [0.0, 1.0, 0.0]];
        assert_eq!(cut(&bent).len(), 3);
        assert!(cut(&[[0.0; 3], [1.0; 3]]).is_empty());
    }

    #[test]
    fn a_huge_polygon_is_cut_when_convex_and_refused_when_not() {
        // On a parabola of whole numbers, so that every turn is exact.
        let mut corners: Vec<_> = (0..5000u32).map(|k| GzCoord::new(k as f32, (k * (k + 1) / 2) as f32, 0.0)).collect();
        let mut cutter = Triangulator::default();
        assert_eq!(cutter.cut(&corners).unwrap().len(), 4998);
        corners[7].y += 100.0;
        assert!(cutter.cut(&corners).is_none());
        assert_eq!(cutter.cut(&corners[..MAX_CONCAVE]).unwrap().len(), MAX_CONCAVE - 2);
    }

    #[test]
    fn a_long_spiral_is_cut_without_overlap() {
        // Two arms of a spiral, out along one and back along the other: half of the corners turn the wrong way.
        let arm = |k: usize, width: f32| {
            let turn = k as f32 * 0.1;
            [libm::cosf(turn) * (turn + width), libm::sinf(turn) * (turn + width), 0.0]
        };
        let half = MAX_CONCAVE / 2;
        let spiral: Vec<[f32; 3]> =
            (0..half).map(|k| arm(k + 20, 1.0)).chain((0..half).rev().map(|k| arm(k + 20, 0.0))).collect();
        let triangles = cut(&spiral);
        let flat: Vec<DVec2> = spiral.iter().map(|&[x, y, _]| DVec2::new(f64::from(x), f64::from(y))).collect();
        let outline = (0..flat.len()).map(|k| flat[k].perp_dot(flat[(k + 1) % flat.len()])).sum::<f64>() / 2.0;
        let inside = area(&spiral, &triangles);
        assert_eq!(triangles.len(), MAX_CONCAVE - 2);
        assert!((inside - outline.abs()).abs() < 1e-6 * inside, "{inside} {outline}");
    }
}
