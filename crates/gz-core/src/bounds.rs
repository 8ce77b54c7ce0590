//! Axis-aligned boxes.

use crate::GzCoord;

/// A closed axis-aligned box, `min <= p <= max` on each axis. Empty when any `min > max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Least corner.
    pub min: GzCoord,
    /// Greatest corner.
    pub max: GzCoord,
}

impl Bounds {
    /// The box that holds nothing; growing it by a point gives that point.
    pub const EMPTY: Self = Self { min: GzCoord::INFINITY, max: GzCoord::NEG_INFINITY };

    /// The least box around `points`; [`Self::EMPTY`] when there are none.
    pub fn of(points: impl IntoIterator<Item = GzCoord>) -> Self {
        points.into_iter().fold(Self::EMPTY, Self::grown_by)
    }

    /// This box grown to hold the point `p`.
    #[must_use]
    pub fn grown_by(self, p: GzCoord) -> Self {
        Self { min: self.min.min(p), max: self.max.max(p) }
    }

    /// The least box around both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Whether no point lies in the box.
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// Whether `p` lies in the closed box.
    pub fn holds(&self, p: GzCoord) -> bool {
        p.cmpge(self.min).all() && p.cmple(self.max).all()
    }

    /// Whether the closed boxes share a point: touching counts.
    pub fn overlaps(&self, other: &Self) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }

    /// Edge lengths, at least 0; 0 for an empty box.
    pub fn size(&self) -> GzCoord {
        if self.is_empty() { GzCoord::ZERO } else { self.max - self.min }
    }

    /// The middle of the box, formed so that it cannot overflow; it lies in the box. NaN for an empty box.
    pub fn centre(&self) -> GzCoord {
        let middle = self.min * 0.5 + self.max * 0.5;
        // Halves of subnormal numbers are rounded, and their sum may be beyond either end.
        if self.is_empty() { middle } else { middle.max(self.min).min(self.max) }
    }

    /// Surface area; 0 for an empty box.
    pub fn area(&self) -> f32 {
        let s = self.size();
        2.0 * (s.x * s.y + s.y * s.z + s.z * s.x)
    }

    /// The greatest magnitude of any coordinate of the box along each axis; 0 when empty.
    pub fn reaches(&self) -> GzCoord {
        if self.is_empty() { GzCoord::ZERO } else { self.min.abs().max(self.max.abs()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn touching_boxes_overlap_and_parted_ones_do_not() {
        let at = |x: f32| Bounds { min: GzCoord::new(x, 0.0, 0.0), max: GzCoord::new(x + 1.0, 1.0, 1.0) };
        assert!(at(0.0).overlaps(&at(1.0)));
        assert!(!at(0.0).overlaps(&at(1.0f32.next_up())));
    }

    #[test]
    fn empty_box_is_empty_and_neutral() {
        let p = GzCoord::new(1.0, -2.0, 3.0);
        assert!(Bounds::EMPTY.is_empty());
        assert_eq!(Bounds::of([p]), Bounds { min: p, max: p });
        assert_eq!((Bounds::EMPTY.area(), Bounds::EMPTY.reaches()), (0.0, GzCoord::ZERO));
    }

    #[test]
    fn centre_of_the_widest_box_does_not_overflow() {
        let b = Bounds { min: GzCoord::splat(3e38), max: GzCoord::splat(3e38) };
        assert_eq!(b.centre(), GzCoord::splat(3e38));
        assert!(Bounds::EMPTY.centre().is_nan());
    }

    #[test]
    fn centre_of_a_subnormal_box_lies_in_it() {
        for (lo, hi) in [(1, 1), (3, 3), (1, 2), (3, 4), (5, 9)] {
            let (min, max) = (GzCoord::splat(f32::from_bits(lo)), GzCoord::splat(f32::from_bits(hi)));
            for b in [Bounds { min, max }, Bounds { min: -max, max: -min }] {
                assert!(b.centre().cmpge(b.min).all() && b.centre().cmple(b.max).all(), "{b:?}");
            }
        }
    }
}
