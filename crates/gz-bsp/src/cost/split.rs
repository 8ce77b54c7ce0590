//! Where to cut: the plane of least expected cost.

// Lanes are numbers into several arrays at once.
#![allow(clippy::needless_range_loop)]

use super::clip::Reference;
use super::tight::TightBox;
use gz_core::SimdLevel;
use gz_core::simd::{Simd, Task, dispatch};

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

/// Bins of all three axes over one box. Made once and used again and again.
pub(crate) struct Bins {
    /// As a [`TightBox`] has its numbers: the box's lower corner, and the same negated.
    origin: [f32; 8],
    /// Bins a unit of length, and the same negated; 0 for an axis without extent.
    scale: [f32; 8],
    width: [f32; 3],
    count: usize,
    bins: [[Bin; MOST_BINS]; 3],
}

impl Bins {
    pub(crate) fn new() -> Self {
        Self { origin: [0.0; 8], scale: [0.0; 8], width: [0.0; 3], count: 0, bins: [[EMPTY_BIN; MOST_BINS]; 3] }
    }

    /// Empty bins over `bounds`, for so many triangles.
    pub(crate) fn reset(&mut self, bounds: &TightBox, triangles: usize) {
        self.count = bins_for(triangles);
        for axis in 0..3 {
            let width = (bounds.max(axis) - bounds.min(axis)) / self.count as f32;
            let width = if width > 0.0 && width.is_finite() && (1.0 / width).is_finite() { width } else { 0.0 };
            let scale = if width > 0.0 { 1.0 / width } else { 0.0 };
            (self.origin[axis], self.origin[4 + axis]) = (bounds.min(axis), -bounds.min(axis));
            (self.scale[axis], self.scale[4 + axis]) = (scale, -scale);
            self.width[axis] = width;
            self.bins[axis][..self.count].fill(EMPTY_BIN);
        }
    }

    fn plane(&self, axis: usize, bin: usize) -> f32 {
        self.origin[axis] + bin as f32 * self.width[axis]
    }

    /// The bins of a box's ends, as the box has its numbers, and of its middle; rounding may give a neighbour, which only blurs an
    /// estimate.
    #[inline(always)]
    fn ends(&self, bounds: &TightBox) -> ([u32; 8], [u32; 4]) {
        // Number by number, so that it is done for all at once.
        let last = WHOLE + (self.count - 1) as f32;
        let (mut places, mut ends, mut middles) = ([0.0; 8], [0; 8], [0; 4]);
        for k in 0..8 {
            places[k] = (bounds.numbers()[k] - self.origin[k]) * self.scale[k] - 0.5;
        }
        for k in 0..8 {
            ends[k] = whole(places[k], last);
        }
        for k in 0..4 {
            middles[k] = whole((places[k] + places[4 + k]) * 0.5, last);
        }
        (ends, middles)
    }

    #[inline(always)]
    fn add(&mut self, reference: &Reference) {
        let bounds = &reference.bounds;
        let (ends, middles) = self.ends(bounds);
        for axis in 0..3 {
            let (first, last) = (ends[axis] as usize % MOST_BINS, ends[4 + axis] as usize % MOST_BINS);
            if last <= first + 1 {
                // Small as it is, it will most likely stand on one side alone.
                let bin = &mut self.bins[axis][middles[axis] as usize % MOST_BINS];
                bin.begin += 1;
                bin.end += 1;
                bin.bounds.join(bounds);
                continue;
            }
            self.bins[axis][first].begin += 1;
            self.bins[axis][last].end += 1;
            let across = bounds.across(axis);
            let (mut low, last_high) = (bounds.min(axis), bounds.max(axis));
            for k in first..=last {
                let end = self.plane(axis, k + 1);
                let bin = &mut self.bins[axis][k];
                bin.bounds.join(&across);
                bin.low = if low < bin.low { low } else { bin.low };
                let high = if k == last { last_high } else { end };
                bin.high = if high > bin.high { high } else { bin.high };
                low = end;
            }
        }
    }

    /// Adds all `references`, with the instructions of this machine's best level.
    #[cfg(feature = "rayon")]
    pub(crate) fn add_all(&mut self, references: &[Reference]) {
        dispatch(SimdLevel::best(), AddAll { bins: self, references });
    }

    /// Adds all `references` to empty bins, and gives the cheapest plane, as [`Self::cheapest`] does.
    pub(crate) fn cheapest_for(&mut self, references: &[Reference], bounds: &TightBox, model: &CostModel) -> Option<Cut> {
        dispatch(SimdLevel::best(), Cheapest { bins: self, references, bounds, model })
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
    #[inline(always)]
    pub(crate) fn cheapest(&self, bounds: &TightBox, model: &CostModel) -> Option<Cut> {
        let mut best: Option<Cut> = None;
        let whole = bounds.area();
        for axis in 0..3 {
            if self.width[axis] == 0.0 {
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

/// 2^23: beyond it a float's last bits are a whole number.
const WHOLE: f32 = (1u32 << 23) as f32;

/// The number of the bin at `place`, half a bin less than its distance from the first; `last` stands for the last bin.
#[inline(always)]
fn whole(place: f32, last: f32) -> u32 {
    let place = (if place > 0.0 { place } else { 0.0 }) + WHOLE;
    (if place < last { place } else { last }).to_bits() & 0xff
}

#[cfg(feature = "rayon")]
struct AddAll<'a> {
    bins: &'a mut Bins,
    references: &'a [Reference],
}

#[cfg(feature = "rayon")]
impl Task for AddAll<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        for reference in self.references {
            self.bins.add(reference);
        }
    }
}

struct Cheapest<'a> {
    bins: &'a mut Bins,
    references: &'a [Reference],
    bounds: &'a TightBox,
    model: &'a CostModel,
}

impl Task for Cheapest<'_> {
    type Output = Option<Cut>;

    #[inline(always)]
    fn run<S: Simd>(self) -> Option<Cut> {
        for reference in self.references {
            self.bins.add(reference);
        }
        self.bins.cheapest(self.bounds, self.model)
    }
}

/// Groups of eight that hold `n` triangles: what a leaf costs.
pub(crate) fn groups(n: u32) -> f32 {
    n.div_ceil(8) as f32
}
