//! The threads that a command works with.

use crate::error::AppError;

/// More threads than this are never made, whatever is asked for: beyond it they cost memory and bring nothing.
pub const MAX_THREADS: usize = 256;

/// Runs `work` with `threads` threads, 0 meaning one for each core. At most [`MAX_THREADS`] are made.
///
/// # Errors
///
/// [`AppError::Io`] if the system gives no threads, and whatever `work` fails with.
pub fn with<T: Send>(threads: usize, work: impl FnOnce() -> Result<T, AppError> + Send) -> Result<T, AppError> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads.min(MAX_THREADS))
        .build()
        .map_err(|error| AppError::Io(format!("no threads to work with: {error}")))?
        .install(work)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_number_asked_for_is_made() {
        let count = |threads| with(threads, || Ok(rayon::current_num_threads())).unwrap();
        assert_eq!((count(1), count(7)), (1, 7));
        assert!(count(0) >= 1);
        assert_eq!(count(usize::MAX), MAX_THREADS);
    }
}
