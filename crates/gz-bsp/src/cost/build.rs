//! A tree that chooses its own planes and where to stop.

use super::clip::Reference;
use super::forest::Forest;
use super::split::{Bins, CostModel, Cut, groups};
use super::tight::TightBox;
use gz_core::{Bounds, GzCoord, TriBuffer, TriId};
#[cfg(feature = "rayon")]
use rayon::prelude::*;
use std::cell::RefCell;

/// A node while building: its tight box and two halves, or triangles.
pub(crate) struct Cell {
    pub(crate) bounds: Bounds,
    pub(crate) content: Content,
    pub(crate) forest: Forest,
}

pub(crate) enum Content {
    Halves(Box<[Cell; 2]>),
    Leaf(Vec<TriId>),
}

impl Cell {
    fn leaf(bounds: Bounds, tris: Vec<TriId>) -> Self {
        Self { bounds, content: Content::Leaf(tris), forest: Forest::LEAF }
    }

    fn halves(bounds: Bounds, halves: [Self; 2]) -> Self {
        let forest = Forest::of(&bounds, &halves[0].forest, &halves[1].forest);
        Self { bounds, content: Content::Halves(Box::new(halves)), forest }
    }
}

/// Triangles in a leaf of the finished tree at most: eight groups.
pub(crate) const LARGEST_LEAF: usize = 64;

/// Below this many triangles a subtree is built by one thread.
#[cfg(feature = "rayon")]
const ALONE: usize = 4096;
/// Above this many triangles their binning is shared among threads.
#[cfg(feature = "rayon")]
const SHARED_BINNING: usize = 1 << 16;

/// Up to so many triangles are a leaf without a look at where to cut: they share a group.
const WORTH_A_LOOK: usize = 4;

struct Builder<'a> {
    positions: &'a [[GzCoord; 3]],
    model: CostModel,
}

/// Cuts `tris` into cells. The same for any number of threads: every decision depends on one cell's references alone.
pub(crate) fn build(tris: &TriBuffer, model: CostModel) -> Cell {
    let positions = tris.positions();
    let whole = |(tri, corners): (usize, &[GzCoord; 3])| Reference::whole(tri as TriId, corners);
    #[cfg(feature = "rayon")]
    let references: Vec<Reference> = positions.par_iter().enumerate().map(whole).collect();
    #[cfg(not(feature = "rayon"))]
    let references: Vec<Reference> = positions.iter().enumerate().map(whole).collect();
    // Deep enough for every useful cut, shallow enough that no input makes it endless.
    let depth = most_cuts(references.len());
    // What cutting may add: a fixed multiple of the triangles, shared out among the halves of each cut.
    let room = 4 * references.len() + 64;
    Builder { positions, model }.cell(Part::of(references), depth, room)
}

/// Cuts one below the other, before leaves that are too large are halved.
const fn most_cuts(triangles: usize) -> u32 {
    // 1.6 for each doubling.
    8 + (triangles as u64 + 1).ilog2() * 8 / 5
}

/// Levels of any tree: the cuts, and the halvings of the largest leaf.
pub(super) const MOST_LEVELS: usize = most_cuts(u32::MAX as usize) as usize + 35;

/// The references of a cell and the box around them.
struct Part {
    references: Vec<Reference>,
    bounds: Option<TightBox>,
}

impl Part {
    fn with_capacity(n: usize) -> Self {
        Self { references: Vec::with_capacity(n), bounds: None }
    }

    fn of(references: Vec<Reference>) -> Self {
        let mut bounds = TightBox::EMPTY;
        references.iter().for_each(|r| bounds.join(&r.bounds));
        Self { bounds: (!references.is_empty()).then_some(bounds), references }
    }

    fn push(&mut self, reference: Reference) {
        self.bounds.get_or_insert(TightBox::EMPTY).join(&reference.bounds);
        self.references.push(reference);
    }

    fn len(&self) -> usize {
        self.references.len()
    }
}

impl Builder<'_> {
    fn cell(&self, part: Part, depth: u32, room: usize) -> Cell {
        let cut = if depth == 0 { None } else { self.worthwhile_cut(&part) };
        let Some((lower, upper)) = cut.and_then(|cut| self.cut(&part.references, cut, room)) else {
            return leaf(part);
        };
        let bounds = bounds_of(&part);
        drop(part);
        let grown = lower.len() + upper.len();
        let share = |n: usize| (room as u128 * n as u128 / grown as u128) as usize;
        let (lower_room, upper_room) = (share(lower.len()), share(upper.len()));
        let halves = join(grown, || self.cell(lower, depth - 1, lower_room), || self.cell(upper, depth - 1, upper_room));
        Cell::halves(bounds, halves)
    }

    /// The cheapest plane, when cutting there is expected to be cheaper than a leaf.
    fn worthwhile_cut(&self, part: &Part) -> Option<Cut> {
        let bounds = part.bounds.as_ref().filter(|_| part.len() > WORTH_A_LOOK)?;
        let cut = cheapest(&part.references, bounds, &self.model)?;
        (cut.cost < bounds.area() * groups(part.len() as u32)).then_some(cut)
    }

    /// The references below and above the plane, those that cross it in both or, where that is cheaper, in one; `None` when the cut parts
    /// nothing or makes more references than there is room for.
    fn cut(&self, references: &[Reference], cut: Cut, room: usize) -> Option<(Part, Part)> {
        let Cut { axis, plane, .. } = cut;
        let is_lower = |r: &Reference| r.bounds.max(axis) <= plane;
        let is_upper = |r: &Reference| r.bounds.min(axis) >= plane;
        // Room that is not used is memory that is not touched.
        let (mut lower, mut upper) = (Part::with_capacity(references.len()), Part::with_capacity(references.len()));
        let mut crossing = Vec::new();
        for r in references {
            if is_lower(r) {
                lower.push(*r);
            } else if is_upper(r) {
                upper.push(*r);
            } else {
                match r.split(axis, plane, &self.positions[r.tri as usize]) {
                    [Some(l), Some(u)] => crossing.push((*r, l, u)),
                    [l, u] => {
                        l.into_iter().for_each(|l| lower.push(l));
                        u.into_iter().for_each(|u| upper.push(u));
                    }
                }
            }
        }
        self.place_crossing(&crossing, &mut lower, &mut upper);
        // Each cut makes both halves smaller or uses up room, so cutting ends.
        let grown = lower.len() + upper.len();
        (lower.len() > 0 && upper.len() > 0 && grown < 2 * references.len() && grown <= room).then_some((lower, upper))
    }

    /// Puts triangles that cross a plane into both halves, or whole into one whose box then grows around them, whichever is expected to cost
    /// less by areas times numbers: the rule of Stich, Friedrich and Dietrich (HPG 2009) for taking a split back.
    fn place_crossing(&self, crossing: &[(Reference, Reference, Reference)], lower: &mut Part, upper: &mut Part) {
        let grown = |before: &TightBox, after: &TightBox| before.area() + (after.area() - before.area()) * self.model.growth;
        // Boxes and numbers with all of them in both.
        let (mut low, mut high) = (lower.bounds.unwrap_or(TightBox::EMPTY), upper.bounds.unwrap_or(TightBox::EMPTY));
        for (_, l, u) in crossing {
            low.join(&l.bounds);
            high.join(&u.bounds);
        }
        let (mut below, mut above) = ((lower.len() + crossing.len()) as f32, (upper.len() + crossing.len()) as f32);
        for (whole, l, u) in crossing {
            let (mut low_with, mut high_with) = (low, high);
            low_with.join(&whole.bounds);
            high_with.join(&whole.bounds);
            let both = low.area() * below + high.area() * above;
            let in_lower = grown(&low, &low_with) * below + high.area() * (above - 1.0);
            let in_upper = low.area() * (below - 1.0) + grown(&high, &high_with) * above;
            // The last one that a half has stays: a cut parts something.
            if in_lower < both && in_lower <= in_upper && above > 1.0 {
                lower.push(*whole);
                (low, above) = (low_with, above - 1.0);
            } else if in_upper < both && below > 1.0 {
                upper.push(*whole);
                (high, below) = (high_with, below - 1.0);
            } else {
                lower.push(*l);
                upper.push(*u);
            }
        }
    }
}

fn bounds_of(part: &Part) -> Bounds {
    part.bounds.map_or(Bounds::EMPTY, |bounds| bounds.bounds())
}

/// A leaf, or halves of it where it would be too large: triangles that no plane parts are parted by the places of their middles.
fn leaf(part: Part) -> Cell {
    let bounds = bounds_of(&part);
    let mut references = part.references;
    if references.len() <= LARGEST_LEAF {
        return Cell::leaf(bounds, references.iter().map(|r| r.tri).collect());
    }
    let middle_of = |r: &Reference| r.bounds.bounds().centre();
    let axis = Bounds::of(references.iter().map(middle_of)).size().max_position();
    // Whole groups in the lower half, so that only the last is part-filled.
    let middle = (references.len() / 2).next_multiple_of(8);
    references.select_nth_unstable_by(middle, |a, b| middle_of(a)[axis].total_cmp(&middle_of(b)[axis]).then(a.tri.cmp(&b.tri)));
    let upper = references.split_off(middle);
    let halves = [references, upper].map(|mut half| {
        half.sort_unstable_by_key(|r| r.tri);
        leaf(Part::of(half))
    });
    Cell::halves(bounds, halves)
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

thread_local! {
    /// Memory alone, kept from cell to cell.
    static BINS: RefCell<Box<Bins>> = RefCell::new(Box::new(Bins::new()));
}

/// The cheapest plane for `references`; `None` when no plane parts anything.
fn cheapest(references: &[Reference], bounds: &TightBox, model: &CostModel) -> Option<Cut> {
    #[cfg(feature = "rayon")]
    if references.len() > SHARED_BINNING {
        let some = |part: &[Reference]| {
            let mut bins = Box::new(Bins::new());
            bins.reset(bounds, references.len());
            bins.add_all(part);
            bins
        };
        let merged = references.par_chunks(SHARED_BINNING / 4).map(some).reduce_with(|mut a, b| {
            a.merge(&b);
            a
        });
        return merged?.cheapest(bounds, model);
    }
    BINS.with_borrow_mut(|bins| {
        bins.reset(bounds, references.len());
        bins.cheapest_for(references, bounds, model)
    })
}
