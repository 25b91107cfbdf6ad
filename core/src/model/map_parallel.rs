//! One value for each number of a range, on all threads.

/// The values in the order of their numbers; the same without threads.
pub(crate) fn map_parallel<T: Send>(count: usize, of: &(dyn Fn(usize) -> T + Sync)) -> Vec<T> {
    #[cfg(feature = "threads")]
    {
        use rayon::prelude::*;
        (0..count).into_par_iter().map(of).collect()
    }
    #[cfg(not(feature = "threads"))]
    (0..count).map(of).collect()
}
