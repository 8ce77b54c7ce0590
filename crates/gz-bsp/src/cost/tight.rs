//! A box as the builder keeps it: one operation joins two.

use glam::Vec3;
use gz_core::Bounds;

/// A closed box as x, y, z of its lower corner and x, y, z of its upper corner negated, each padded to four: joining two boxes is the
/// lesser of each number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TightBox([f32; 8]);

/// For each axis: what raises its two numbers to infinity and no other.
const HIDDEN: [[f32; 8]; 3] = {
    let (show, hide) = (f32::NEG_INFINITY, f32::INFINITY);
    [
        [hide, show, show, show, hide, show, show, show],
        [show, hide, show, show, show, hide, show, show],
        [show, show, hide, show, show, show, hide, show],
    ]
};

impl TightBox {
    pub(crate) const EMPTY: Self = Self([f32::INFINITY; 8]);

    pub(crate) fn of(bounds: &Bounds) -> Self {
        let (lo, hi) = (bounds.min, -bounds.max);
        Self([lo.x, lo.y, lo.z, 0.0, hi.x, hi.y, hi.z, 0.0])
    }

    pub(crate) fn bounds(&self) -> Bounds {
        let [lx, ly, lz, _, hx, hy, hz, _] = self.0;
        Bounds { min: Vec3::new(lx, ly, lz), max: -Vec3::new(hx, hy, hz) }
    }

    /// x, y, z of the lower corner and x, y, z of the upper one negated, each padded to four.
    #[inline(always)]
    pub(crate) fn numbers(&self) -> &[f32; 8] {
        &self.0
    }

    #[inline(always)]
    pub(crate) fn min(&self, axis: usize) -> f32 {
        self.0[axis]
    }

    #[inline(always)]
    pub(crate) fn max(&self, axis: usize) -> f32 {
        -self.0[4 + axis]
    }

    /// The box without its extent along `axis`: joined to another, it leaves that one's extent there.
    #[inline(always)]
    pub(crate) fn across(mut self, axis: usize) -> Self {
        // Number by number against a constant, so that it stays one operation on a register.
        for (mine, hidden) in self.0.iter_mut().zip(&HIDDEN[axis]) {
            *mine = if *hidden > *mine { *hidden } else { *mine };
        }
        self
    }

    /// Grows this box along `axis` to hold `low` and `high`.
    pub(crate) fn reach(&mut self, axis: usize, low: f32, high: f32) {
        self.0[axis] = self.0[axis].min(low);
        self.0[4 + axis] = self.0[4 + axis].min(-high);
    }

    /// Grows this box to hold the other.
    #[inline(always)]
    pub(crate) fn join(&mut self, other: &Self) {
        for (mine, theirs) in self.0.iter_mut().zip(&other.0) {
            // Written as the processor's minimum; no number here is NaN.
            *mine = if *theirs < *mine { *theirs } else { *mine };
        }
    }

    /// Surface area; meaningless for an empty box.
    #[inline(always)]
    pub(crate) fn area(&self) -> f32 {
        let [lx, ly, lz, _, hx, hy, hz, _] = self.0;
        let (x, y, z) = (-hx - lx, -hy - ly, -hz - lz);
        2.0 * (x * y + y * z + z * x)
    }
}
