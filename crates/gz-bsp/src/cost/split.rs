//! Where to cut: the plane of least expected cost.

use super::clip::Reference;
use super::tight::TightBox;

/// What the steps of a walk cost, in units of one group of eight triangles tested.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CostModel {
    /// One binary cut; a node of the finished tree holds up to seven.
    pub cut: f32,
    /// A triangle that crosses a plane stands in both halves, or whole in one whose box grows around it. This share of what the growth
    /// costs counts in that choice, from 0 (hardly any triangle stands twice) to 1: cuts further down part grown boxes again.
    pub growth: f32,
}

impl Default for CostModel {
    /// Measured on bundles and single rays through eight-cell nodes. Of the growths 0, 1/4, 1/2 and 1 a quarter was the fastest for nearly
    /// every kind of ray and mesh, in three fifths of the memory of a tree in which every such triangle stands twice.
    fn default() -> Self {
        Self { cut: 0.8, growth: 0.25 }
    }
}

/// A plane and what it is expected to cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cut {
    pub(crate) axis: usize,
    pub(crate) plane: f32,
    pub(crate) cost: f32,
}

/// Bins along each axis for many triangles; for fewer they are not worth their sweep.
const MOST_BINS: usize = 32;

fn bins_for(triangles: usize) -> usize {
    match triangles {
        0..32 => 8,
        32..256 => 16,
        _ => MOST_BINS,
    }
}

/// What falls into one bin.
#[derive(Clone, Copy)]
struct Bin {
    begin: u32,
    end: u32,
    /// Around all parts in the bin; along the bin's axis of those only that lie in it whole.
    bounds: TightBox,
    /// Along the bin's axis, of the parts that reach into other bins. Kept apart, as changing one number of a box that is worked on as a
    /// whole makes the processor wait.
    low: f32,
    high: f32,
}

const EMPTY_BIN: Bin = Bin { begin: 0, end: 0, bounds: TightBox::EMPTY, low: f32::INFINITY, high: f32::NEG_INFINITY };

impl Bin {
    /// Around all parts in the bin.
    fn whole(&self, axis: usize) -> TightBox {
        let mut bounds = self.bounds;
        bounds.reach(axis, self.low, self.high);
        bounds
    }
}

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
    pub(crate) fn over(bounds: &TightBox, triangles: usize) -> Self {
        let count = bins_for(triangles);
        let width: [f32; 3] = std::array::from_fn(|axis| {
            let width = (bounds.max(axis) - bounds.min(axis)) / count as f32;
            if width > 0.0 && width.is_finite() && (1.0 / width).is_finite() { width } else { 0.0 }
        });
        Self {
            origin: std::array::from_fn(|axis| bounds.min(axis)),
            scale: width.map(|w| if w > 0.0 { 1.0 / w } else { 0.0 }),
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
        // The cast saturates, also from below.
        (((x - self.origin[axis]) * self.scale[axis]) as usize).min(self.count - 1)
    }

    pub(crate) fn add(&mut self, reference: &Reference) {
        let bounds = &reference.bounds;
        for axis in 0..3 {
            let (first, last) = (self.bin(axis, bounds.min(axis)), self.bin(axis, bounds.max(axis)));
            self.bins[axis][first].begin += 1;
            self.bins[axis][last].end += 1;
            if first == last {
                self.bins[axis][first].bounds.join(bounds);
                continue;
            }
            let across = bounds.across(axis);
            let (mut low, last_high) = (bounds.min(axis), bounds.max(axis));
            for k in first..=last {
                let end = self.plane(axis, k + 1);
                let bin = &mut self.bins[axis][k];
                bin.bounds.join(&across);
                bin.low = bin.low.min(low);
                bin.high = bin.high.max(if k == last { last_high } else { end });
                low = end;
            }
        }
    }

    /// Takes over what `other`, made for the same box, has seen. Counts and boxes do not depend on the order.
    #[cfg(feature = "rayon")]
    pub(crate) fn merge(&mut self, other: &Self) {
        for (mine, theirs) in self.bins.iter_mut().flatten().zip(other.bins.iter().flatten()) {
            mine.begin += theirs.begin;
            mine.end += theirs.end;
            mine.bounds.join(&theirs.bounds);
            mine.low = mine.low.min(theirs.low);
            mine.high = mine.high.max(theirs.high);
        }
    }

    /// The cheapest plane; `None` when no plane parts anything. Costs are areas times groups.
    pub(crate) fn cheapest(&self, bounds: &TightBox, model: &CostModel) -> Option<Cut> {
        let mut best: Option<Cut> = None;
        let whole = bounds.area();
        for axis in 0..3 {
            if self.scale[axis] == 0.0 {
                continue;
            }
            let bins = &self.bins[axis][..self.count];
            // What lies above the lower end of each bin.
            let mut above = [(0, 0.0); MOST_BINS];
            let (mut count, mut union) = (0, TightBox::EMPTY);
            for k in (1..self.count).rev() {
                count += bins[k].end;
                union.join(&bins[k].whole(axis));
                above[k] = (count, union.area() * groups(count));
            }
            let (mut below, mut union) = (0, TightBox::EMPTY);
            for k in 1..self.count {
                below += bins[k - 1].begin;
                union.join(&bins[k - 1].whole(axis));
                let (above, upper_cost) = above[k];
                if below == 0 || above == 0 {
                    continue;
                }
                let cost = model.cut * whole + union.area() * groups(below) + upper_cost;
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
