//! Memory in large pages, for arrays that are read here and there: of a few thousand small pages the processor does not know the places.

use std::alloc::{Layout, alloc, dealloc, handle_alloc_error};
use std::fmt;
use std::ops::Deref;
use std::ptr::NonNull;

/// A large page of x86-64 and of most others: 2 MiB.
const LARGE: usize = 1 << 21;

/// An array that never grows. From half a large page on it begins at one, and the system is asked for such.
pub struct Pages<T: Copy> {
    start: NonNull<T>,
    len: usize,
}

// SAFETY: it owns its elements, as a boxed slice does.
unsafe impl<T: Copy + Send> Send for Pages<T> {}
// SAFETY: shared it gives out shared elements only.
unsafe impl<T: Copy + Sync> Sync for Pages<T> {}

/// How `len` elements lie in memory, of more than 0 bytes in all; `None` beyond what an address holds.
fn layout<T>(len: usize) -> Option<Layout> {
    let own = Layout::array::<T>(len).ok()?;
    if own.size() < LARGE / 2 {
        return Some(own);
    }
    Some(own.align_to(LARGE).ok()?.pad_to_align())
}

impl<T: Copy> Pages<T> {
    /// A copy of `elements`.
    pub fn copy_of(elements: &[T]) -> Self {
        let len = elements.len();
        if size_of_val(elements) == 0 {
            return Self { start: NonNull::dangling(), len };
        }
        let Some(layout) = layout::<T>(len) else { unreachable!("a slice lies within what an address holds") };
        // SAFETY: the layout has a size above 0.
        let Some(start) = NonNull::new(unsafe { alloc(layout) }) else { handle_alloc_error(layout) };
        if layout.align() == LARGE {
            advise(start.as_ptr(), layout.size());
        }
        let start = start.cast::<T>();
        // SAFETY: both hold `len` elements, do not overlap, and are aligned; elements are `Copy`.
        unsafe { std::ptr::copy_nonoverlapping(elements.as_ptr(), start.as_ptr(), len) };
        Self { start, len }
    }
}

/// Asks for large pages for the room that `elements` have, filled or not. It is theirs until they move, and what they hold stays.
pub fn advise_large<T: Copy>(elements: &mut Vec<T>) {
    const SMALL: usize = 1 << 12;
    let (start, bytes) = (elements.as_mut_ptr().cast::<u8>(), elements.capacity() * size_of::<T>());
    // Pages are advised about whole; what lies before the first one and behind the last is not theirs alone.
    let before = start.addr().wrapping_neg() % SMALL;
    if bytes >= LARGE + before {
        advise(start.wrapping_add(before), (bytes - before) / SMALL * SMALL);
    }
}

/// Asks for large pages. A system that has none ignores it.
#[cfg(target_os = "linux")]
fn advise(start: *mut u8, bytes: usize) {
    // SAFETY: the range is allocated and its owner's alone, and begins at a page; the advice changes how it is backed and not what it holds.
    let _ = unsafe { libc::madvise(start.cast(), bytes, libc::MADV_HUGEPAGE) };
}

#[cfg(not(target_os = "linux"))]
fn advise(_start: *mut u8, _bytes: usize) {}

impl<T: Copy> Drop for Pages<T> {
    fn drop(&mut self) {
        if self.len * size_of::<T>() != 0
            && let Some(layout) = layout::<T>(self.len)
        {
            // SAFETY: `copy_of` allocated it with this layout.
            unsafe { dealloc(self.start.as_ptr().cast(), layout) };
        }
    }
}

impl<T: Copy> Deref for Pages<T> {
    type Target = [T];

    #[inline(always)]
    fn deref(&self) -> &[T] {
        // SAFETY: `len` elements were written from `start` on, which is aligned and not null.
        unsafe { std::slice::from_raw_parts(self.start.as_ptr(), self.len) }
    }
}

impl<T: Copy> Clone for Pages<T> {
    fn clone(&self) -> Self {
        Self::copy_of(self)
    }
}

impl<T: Copy + PartialEq> PartialEq for Pages<T> {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl<T: Copy + fmt::Debug> fmt::Debug for Pages<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn copies_hold_what_they_are_copies_of_and_large_ones_begin_at_a_large_page() {
        for len in [0, 1, 1000, LARGE / 16 - 1, LARGE / 16, LARGE / 8 + 1, 3 * LARGE / 8] {
            let numbers: Vec<u64> = (0..len as u64).map(|k| k * k).collect();
            let pages = Pages::copy_of(&numbers);
            assert_eq!(&*pages, &numbers[..]);
            assert_eq!((pages.clone() == pages, pages.first()), (true, numbers.first()));
            let at = pages.as_ptr().addr();
            assert!(at.is_multiple_of(if len < LARGE / 16 { align_of::<u64>() } else { LARGE }), "{len} at {at:x}");
        }
        assert_eq!(format!("{:?}", Pages::copy_of(&[1u8, 2])), "[1, 2]");
        assert_eq!(Pages::copy_of(&[(); 5]).len(), 5);
    }

    #[test]
    fn advice_changes_no_element() {
        for len in [0, 3, LARGE / 8, LARGE / 2] {
            let mut numbers: Vec<u64> = Vec::with_capacity(len);
            advise_large(&mut numbers);
            numbers.extend((0..len as u64).map(|k| k * k));
            advise_large(&mut numbers);
            assert!(numbers.iter().zip(0..).all(|(&number, k)| number == k * k) && numbers.len() == len);
        }
    }

    #[test]
    fn aligned_elements_stay_aligned() {
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[repr(align(64))]
        struct Line([f32; 16]);

        let lines = Pages::copy_of(&[Line([1.5; 16]); 7]);
        assert_eq!((lines.as_ptr().addr() % 64, lines[6]), (0, Line([1.5; 16])));
    }
}
