//! Cells that a company of rays has still to visit.

use super::wide::WIDTH;
use gz_core::kernel::Rays;
use gz_core::simd::Lanes;

/// A node that was visited, and by which rays.
#[derive(Clone, Copy)]
pub(super) struct Visit {
    pub(super) rays: Rays,
    pub(super) node: u32,
}

/// Cells that wait, each a number: where the interval enters it in the upper half, in the lower the visit of its node and its place there. So
/// they are put there, taken and brought into the order of distance without a guess. Below are three of [`LAST`]. Made once.
pub(super) struct Queue {
    cells: Vec<i64>,
    /// The place of the last.
    last: usize,
    visits: Vec<Visit>,
}

/// No cell.
const LAST: i64 = i64::MAX;
/// The last of a queue in which there is nothing.
const EMPTY: usize = 2;

impl Queue {
    pub(super) fn new() -> Self {
        Self { cells: vec![LAST; 256], last: EMPTY, visits: Vec::with_capacity(64) }
    }

    pub(super) fn clear(&mut self) {
        self.last = EMPTY;
        self.visits.clear();
    }

    /// Has the cells of a node whose bit is set wait for `rays`.
    #[inline(always)]
    pub(super) fn push<L: Lanes<WIDTH>>(&mut self, node: usize, rays: &Rays, entries: L, crossed: u32) {
        if self.last + 1 + WIDTH > self.cells.len() {
            self.grow();
        }
        let first = (self.visits.len() * WIDTH) as u32;
        self.visits.push(Visit { rays: *rays, node: node as u32 });
        let mut numbers = [0; WIDTH];
        for (slot, number) in numbers.iter_mut().enumerate() {
            *number = first + slot as u32;
        }
        if let Some(room) = self.cells[self.last + 1..].first_chunk_mut() {
            entries.front(&numbers, crossed, room);
        }
        self.last += crossed.count_ones() as usize;
    }

    /// The cell that came last or, if they are `ordered`, the nearest of the last three, which is nearly the nearest of all. Where the interval
    /// enters it, its visit and its slot.
    #[inline(always)]
    pub(super) fn pop(&mut self, ordered: bool) -> Option<(f32, Visit, usize)> {
        if self.last <= EMPTY {
            return None;
        }
        let three: &mut [i64; 3] = self.cells[self.last - 2..].first_chunk_mut()?;
        self.last -= 1;
        let [c, b, a] = *three;
        let mut next = a;
        if ordered {
            let (near, far) = (a.min(b), a.max(b));
            *three = [near.max(c), far, a];
            next = near.min(c);
        }
        let place = next as u32 as usize;
        Some((f32::from_bits((next >> 32) as u32), self.visits[place / WIDTH], place % WIDTH))
    }

    #[cold]
    #[inline(never)]
    fn grow(&mut self) {
        self.cells.resize(2 * self.cells.len(), LAST);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gz_core::simd::{Simd, SimdLevel, Task, dispatch};

    /// The cells of `visits` nodes, pushed and taken: the first five and the last of a node each time.
    struct Ask(u32, bool);

    impl Task for Ask {
        type Output = Vec<(f32, u32, usize)>;

        #[inline(always)]
        fn run<S: Simd>(self) -> Self::Output {
            let Self(visits, ordered) = self;
            let mut queue = Queue::new();
            for node in 0..visits {
                let near = node as f32 * 10.0;
                let entries = <S::Eight>::load(&[5.0, 1.0, 4.0, 2.0, 3.0, -1.0, -1.0, 9.0].map(|entry| near + entry));
                queue.push(node as usize + 7, &[node, 0, 0, 1], entries, 0b1001_1111);
            }
            let mut taken = Vec::new();
            while let Some((entry, visit, slot)) = queue.pop(ordered) {
                assert_eq!(visit.rays, [visit.node - 7, 0, 0, 1]);
                taken.push((entry - (visit.node - 7) as f32 * 10.0, visit.node - 7, slot));
            }
            assert!(queue.cells[..=EMPTY].iter().all(|&cell| cell == LAST), "the next rays find none below");
            taken
        }
    }

    #[test]
    fn cells_come_nearly_in_order_or_the_last_first_and_each_once() {
        for &level in SimdLevel::available() {
            let near = [(2.0, 0, 3), (3.0, 0, 4), (1.0, 0, 1), (4.0, 0, 2), (5.0, 0, 0), (9.0, 0, 7)];
            assert_eq!(dispatch(level, Ask(1, true)), near, "{level:?}");
            let last = [(9.0, 0, 7), (3.0, 0, 4), (2.0, 0, 3), (4.0, 0, 2), (1.0, 0, 1), (5.0, 0, 0)];
            assert_eq!(dispatch(level, Ask(1, false)), last, "{level:?}");
            // More than there is room for at first.
            for ordered in [false, true] {
                let mut taken = dispatch(level, Ask(300, ordered));
                taken.sort_by(|a, b| a.partial_cmp(b).expect("no NaN"));
                let each = |(entry, slot)| (0..300).map(move |node| (entry, node, slot));
                let all: Vec<_> =
                    [(1.0, 1), (2.0, 3), (3.0, 4), (4.0, 2), (5.0, 0), (9.0, 7)].into_iter().flat_map(each).collect();
                assert_eq!(taken, all, "{level:?}");
            }
        }
    }
}
