//! The heap of the C library, which a software rasteriser uses anew in each frame.
//!
//! Mesa's llvmpipe takes and frees some megabytes of small blocks a frame. glibc gives what lies free at the end of its heap back to the
//! system beyond 128 KiB, and the next frame pays for every page again: half of the time of a frame. It raises that threshold by
//! itself, to twice the size of a large block that is freed (mallopt(3), `M_MMAP_THRESHOLD` and `M_TRIM_THRESHOLD`).

use std::hint::black_box;

/// Of the block that sets the threshold: no page of it is ever touched.
const BLOCK: usize = 12 << 20;

/// Lets the C library keep up to twice [`BLOCK`] bytes that are free; other ones do as they always do.
pub fn raise_trim_threshold() {
    drop(black_box(Vec::<u8>::with_capacity(black_box(BLOCK))));
}
