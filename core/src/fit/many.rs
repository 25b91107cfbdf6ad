//! Many fits at once: one on each thread, rather than one after the other on all of them.

/// Stack of the threads: as much as a main thread has on most systems.
#[cfg(feature = "threads")]
const STACK: usize = 8 << 20;

/// How many threads work is spread over: that of the processors, or what `RAYON_NUM_THREADS` says; 1 without the feature `threads`.
#[must_use]
pub fn thread_count() -> usize {
    #[cfg(feature = "threads")]
    {
        rayon::current_num_threads()
    }
    #[cfg(not(feature = "threads"))]
    1
}

/// Does work on one thread alone: searches and intervals in it are not spread over others. No result changes by a bit. The calling thread
/// waits.
///
/// ```
/// use pbrdf::fit::on_one_thread;
///
/// assert_eq!(on_one_thread(|| 6 * 7), 42);
/// ```
pub fn on_one_thread<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    #[cfg(feature = "threads")]
    {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).stack_size(STACK).thread_name(|_| "fits".to_owned()).build();
        // Where the system gives no thread, the work is done here.
        match pool {
            Ok(pool) => pool.install(work),
            Err(_) => work(),
        }
    }
    #[cfg(not(feature = "threads"))]
    work()
}
