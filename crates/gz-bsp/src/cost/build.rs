//! A tree that chooses its own planes and where to stop.

use super::clip::Reference;
use super::split::{Bins, CostModel, Cut, groups};
use super::tight::TightBox;
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
        Cell { bounds, content: Content::Halves(Box::new(halves)) }
    }

    /// The cheapest plane, when cutting there is expected to be cheaper than a leaf.
    fn worthwhile_cut(&self, part: &Part) -> Option<Cut> {
        let bounds = part.bounds.as_ref().filter(|_| part.len() > 1)?;
        let cut = bin(&part.references, bounds).cheapest(bounds, &self.model)?;
        (cut.cost < bounds.area() * groups(part.len() as u32)).then_some(cut)
    }

    /// The references below and above the plane, those that cross it in both; `None` when the cut parts nothing or makes more
    /// references than there is room for.
    fn cut(&self, references: &[Reference], cut: Cut, room: usize) -> Option<(Part, Part)> {
        let Cut { axis, plane, .. } = cut;
        let is_lower = |r: &Reference| r.bounds.max(axis) <= plane;
        let is_upper = |r: &Reference| r.bounds.min(axis) >= plane;
        let (mut below, mut above) = (0, 0);
        for r in references {
            let lower = is_lower(r);
            below += usize::from(lower || !is_upper(r));
            above += usize::from(!lower);
        }
        // Each cut makes both halves smaller or uses up room, so cutting ends.
        if below + above == 2 * references.len() || below + above > room {
            return None;
        }
        let (mut lower, mut upper) = (Part::with_capacity(below), Part::with_capacity(above));
        for r in references {
            if is_lower(r) {
                lower.push(*r);
            } else if is_upper(r) {
                upper.push(*r);
            } else {
                let [l, u] = r.split(axis, plane, &self.positions[r.tri as usize]);
                l.into_iter().for_each(|l| lower.push(l));
                u.into_iter().for_each(|u| upper.push(u));
            }
        }
        (lower.len() > 0 && upper.len() > 0).then_some((lower, upper))
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
        return Cell { bounds, content: Content::Leaf(references.iter().map(|r| r.tri).collect()) };
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
    Cell { bounds, content: Content::Halves(Box::new(halves)) }
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

fn bin(references: &[Reference], bounds: &TightBox) -> Bins {
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
