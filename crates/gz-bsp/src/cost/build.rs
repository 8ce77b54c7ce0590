//! A tree that chooses its own planes and where to stop.

use super::clip::Reference;
use super::split::{Bins, CostModel, Cut, groups};
use gz_core::{Bounds, GzCoord, TriBuffer, TriId};

/// A node while building: its tight box and two halves, or triangles.
pub(crate) struct Cell {
    pub(crate) bounds: Bounds,
    pub(crate) content: Content,
}

pub(crate) enum Content {
    Halves(Box<[Cell; 2]>),
    Leaf(Vec<TriId>),
}

/// Triangles in a leaf of the finished tree at most: eight groups.
pub(crate) const LARGEST_LEAF: usize = 64;

/// Below this many triangles a subtree is built by one thread.
#[cfg(feature = "rayon")]
const ALONE: usize = 4096;
/// Above this many triangles their binning is shared among threads.
#[cfg(feature = "rayon")]
const SHARED_BINNING: usize = 1 << 16;

struct Builder<'a> {
    positions: &'a [[GzCoord; 3]],
    model: CostModel,
}

/// Cuts `tris` into cells. The same for any number of threads: every decision depends on one cell's references alone.
pub(crate) fn build(tris: &TriBuffer, model: CostModel) -> Cell {
    let positions = tris.positions();
    let references: Vec<Reference> = (0..).zip(positions).map(|(tri, corners)| Reference::whole(tri, corners)).collect();
    // Deep enough for every useful cut, shallow enough that no input makes it endless.
    let depth = 8 + (1.6 * (references.len().max(1) as f32).log2()) as u32;
    // What cutting may add: a fixed multiple of the triangles, shared out among the halves of each cut.
    let room = 4 * references.len() + 64;
    Builder { positions, model }.cell(references, depth, room)
}

impl Builder<'_> {
    fn cell(&self, references: Vec<Reference>, depth: u32, room: usize) -> Cell {
        let bounds = references.iter().fold(Bounds::EMPTY, |all, r| all.union(r.bounds));
        let cut = if depth == 0 { None } else { self.worthwhile_cut(&references, &bounds) };
        let Some((lower, upper)) = cut.and_then(|cut| self.part(&references, cut, room)) else {
            return self.leaf(references, bounds);
        };
        drop(references);
        let grown = lower.len() + upper.len();
        let share = |n: usize| (room as u128 * n as u128 / grown as u128) as usize;
        let (lower_room, upper_room) = (share(lower.len()), share(upper.len()));
        let halves = join(grown, || self.cell(lower, depth - 1, lower_room), || self.cell(upper, depth - 1, upper_room));
        Cell { bounds, content: Content::Halves(Box::new(halves)) }
    }

    /// The cheapest plane, when cutting there is expected to be cheaper than a leaf.
    fn worthwhile_cut(&self, references: &[Reference], bounds: &Bounds) -> Option<Cut> {
        if references.len() < 2 {
            return None;
        }
        let cut = bin(references, bounds).cheapest(bounds, &self.model)?;
        let leaf = bounds.area() * groups(references.len() as u32);
        (cut.cost < leaf).then_some(cut)
    }

    /// The references below and above the plane, those that cross it in both; `None` when the cut parts nothing or makes more
    /// references than there is room for.
    fn part(&self, references: &[Reference], cut: Cut, room: usize) -> Option<(Vec<Reference>, Vec<Reference>)> {
        let Cut { axis, plane, .. } = cut;
        let crossing = |r: &Reference| r.bounds.min[axis] < plane && r.bounds.max[axis] > plane;
        let is_lower = |r: &Reference| r.bounds.max[axis] <= plane;
        let both = references.iter().filter(|r| crossing(r)).count();
        let below = references.iter().filter(|r| is_lower(r)).count() + both;
        let above = references.len() - below + both;
        // Each cut makes both halves smaller or uses up room, so cutting ends.
        if below + above == 2 * references.len() || below + above > room {
            return None;
        }
        let (mut lower, mut upper) = (Vec::with_capacity(below), Vec::with_capacity(above));
        for r in references {
            if crossing(r) {
                let [l, u] = r.split(axis, plane, &self.positions[r.tri as usize]);
                // A box that was cut before may reach over the plane where the triangle itself does not.
                if !l.bounds.is_empty() {
                    lower.push(l);
                }
                if !u.bounds.is_empty() {
                    upper.push(u);
                }
            } else if is_lower(r) {
                lower.push(*r);
            } else {
                upper.push(*r);
            }
        }
        (!lower.is_empty() && !upper.is_empty()).then_some((lower, upper))
    }

    /// A leaf, or halves of it where it would be too large: triangles that no plane parts are parted by the places of their middles.
    fn leaf(&self, mut references: Vec<Reference>, bounds: Bounds) -> Cell {
        if references.len() <= LARGEST_LEAF {
            return Cell { bounds, content: Content::Leaf(references.iter().map(|r| r.tri).collect()) };
        }
        let middles = Bounds::of(references.iter().map(|r| r.bounds.centre()));
        let axis = middles.size().max_position();
        let place = |r: &Reference| (r.bounds.centre()[axis], r.tri);
        // Whole groups in the lower half, so that only the last is part-filled.
        let middle = (references.len() / 2).next_multiple_of(8);
        references.select_nth_unstable_by(middle, |a, b| {
            let ((a, a_tri), (b, b_tri)) = (place(a), place(b));
            a.total_cmp(&b).then(a_tri.cmp(&b_tri))
        });
        let upper = references.split_off(middle);
        let halves = [references, upper].map(|mut half| {
            half.sort_unstable_by_key(|r| r.tri);
            let bounds = half.iter().fold(Bounds::EMPTY, |all, r| all.union(r.bounds));
            self.leaf(half, bounds)
        });
        Cell { bounds, content: Content::Halves(Box::new(halves)) }
    }
}

#[cfg(feature = "rayon")]
fn join(size: usize, a: impl FnOnce() -> Cell + Send, b: impl FnOnce() -> Cell + Send) -> [Cell; 2] {
    if size < ALONE {
        return [a(), b()];
    }
    let (a, b) = rayon::join(a, b);
    [a, b]
}

#[cfg(not(feature = "rayon"))]
fn join(_size: usize, a: impl FnOnce() -> Cell, b: impl FnOnce() -> Cell) -> [Cell; 2] {
    [a(), b()]
}

fn bin(references: &[Reference], bounds: &Bounds) -> Bins {
    let some = |part: &[Reference]| {
        let mut bins = Bins::over(bounds, references.len());
        part.iter().for_each(|r| bins.add(r));
        bins
    };
    #[cfg(feature = "rayon")]
    if references.len() > SHARED_BINNING {
        use rayon::prelude::*;
        return references.par_chunks(SHARED_BINNING / 4).map(some).reduce(
            || Bins::over(bounds, references.len()),
            |mut a, b| {
                a.merge(&b);
                a
            },
        );
    }
    some(references)
}
