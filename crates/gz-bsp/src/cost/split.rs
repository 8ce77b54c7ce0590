//! Where to cut: the plane of least expected cost.

use super::clip::Reference;
use gz_core::Bounds;

/// What the steps of a walk cost, in units of one group of eight triangles tested.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CostModel {
    /// One binary cut; a node of the finished tree holds up to seven.
    pub cut: f32,
}

impl Default for CostModel {
    /// Measured on the eight-cell walk.
    fn default() -> Self {
        Self { cut: 0.8 }
    }
}

/// A plane and what it is expected to cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cut {
    pub(crate) axis: usize,
    pub(crate) plane: f32,
    pub(crate) cost: f32,
}

/// Bins along each axis; fewer for few triangles.
const MOST_BINS: usize = 32;

/// What falls into one bin.
#[derive(Clone, Copy)]
struct Bin {
    begin: u32,
    end: u32,
    bounds: Bounds,
}

const EMPTY_BIN: Bin = Bin { begin: 0, end: 0, bounds: Bounds::EMPTY };

/// Bins of all three axes over one box.
pub(crate) struct Bins {
    origin: [f32; 3],
    /// Bins a unit of length; 0 for an axis without extent.
    scale: [f32; 3],
    width: [f32; 3],
    count: usize,
    bins: [[Bin; MOST_BINS]; 3],
}

impl Bins {
    pub(crate) fn over(bounds: &Bounds, triangles: usize) -> Self {
        let count = if triangles < 32 { 16 } else { MOST_BINS };
        let size = bounds.max - bounds.min;
        let usable = size.to_array().map(|s| s > 0.0 && s.is_finite());
        let width: [f32; 3] = std::array::from_fn(|k| if usable[k] { size[k] / count as f32 } else { 0.0 });
        Self {
            origin: bounds.min.to_array(),
            scale: width.map(|w| if w > 0.0 && (1.0 / w).is_finite() { 1.0 / w } else { 0.0 }),
            width,
            count,
            bins: [[EMPTY_BIN; MOST_BINS]; 3],
        }
    }

    fn plane(&self, axis: usize, bin: usize) -> f32 {
        self.origin[axis] + bin as f32 * self.width[axis]
    }

    /// The bin of a coordinate; rounding may give its neighbour, which only blurs an estimate.
    fn bin(&self, axis: usize, x: f32) -> usize {
        // Casting saturates, also from below and from NaN.
        (((x - self.origin[axis]) * self.scale[axis]) as usize).min(self.count - 1)
    }

    pub(crate) fn add(&mut self, reference: &Reference) {
        let bounds = &reference.bounds;
        for axis in 0..3 {
            if self.scale[axis] == 0.0 {
                continue;
            }
            let (first, last) = (self.bin(axis, bounds.min[axis]), self.bin(axis, bounds.max[axis]));
            self.bins[axis][first].begin += 1;
            self.bins[axis][last].end += 1;
            if first == last {
                let bin = &mut self.bins[axis][first];
                bin.bounds = bin.bounds.union(*bounds);
                continue;
            }
            for k in first..=last {
                let mut part = *bounds;
                part.min[axis] = part.min[axis].max(self.plane(axis, k));
                part.max[axis] = part.max[axis].min(self.plane(axis, k + 1));
                let bin = &mut self.bins[axis][k];
                bin.bounds = bin.bounds.union(part);
            }
        }
    }

    /// Takes over what `other`, made for the same box, has seen. Counts and boxes do not depend on the order.
    pub(crate) fn merge(&mut self, other: &Self) {
        for (mine, theirs) in self.bins.iter_mut().flatten().zip(other.bins.iter().flatten()) {
            mine.begin += theirs.begin;
            mine.end += theirs.end;
            mine.bounds = mine.bounds.union(theirs.bounds);
        }
    }

    /// The cheapest plane, its cost relative to the area of `bounds`; `None` when no plane parts anything.
    pub(crate) fn cheapest(&self, bounds: &Bounds, model: &CostModel) -> Option<Cut> {
        let mut best: Option<Cut> = None;
        let whole = bounds.area();
        for axis in 0..3 {
            if self.scale[axis] == 0.0 {
                continue;
            }
            let bins = &self.bins[axis][..self.count];
            // Boxes and counts of everything from a bin upwards.
            let mut above = [(0u32, Bounds::EMPTY); MOST_BINS];
            let (mut count, mut union) = (0, Bounds::EMPTY);
            for k in (1..self.count).rev() {
                count += bins[k].end;
                union = union.union(bins[k].bounds);
                above[k] = (count, union);
            }
            let (mut below, mut union) = (0, Bounds::EMPTY);
            for k in 1..self.count {
                below += bins[k - 1].begin;
                union = union.union(bins[k - 1].bounds);
                let (upper_count, upper) = above[k];
                if below == 0 || upper_count == 0 {
                    continue;
                }
                let cost = model.cut * whole + union.area() * groups(below) + upper.area() * groups(upper_count);
                if best.is_none_or(|best| cost < best.cost) {
                    best = Some(Cut { axis, plane: self.plane(axis, k), cost });
                }
            }
        }
        best
    }
}

/// Groups of eight that hold `n` triangles: what a leaf costs.
pub(crate) fn groups(n: u32) -> f32 {
    n.div_ceil(8) as f32
}
