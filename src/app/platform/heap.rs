//! The heap of the C library.
//!
//! Mesa's software rasteriser llvmpipe allocates and frees some megabytes of small blocks in each
//! frame. glibc returns free memory at the end of its heap to the system beyond 128 KiB, and the
//! next frame faults in every page again: half of the time of a frame. glibc raises this threshold
//! to twice the size of a large block that is freed (mallopt(3), `M_MMAP_THRESHOLD` and
//! `M_TRIM_THRESHOLD`).

use std::hint::black_box;

/// Bytes of the block that sets the threshold; no page of the block is ever touched.
const BLOCK: usize = 12 << 20;

/// Lets glibc keep up to twice [`BLOCK`] free bytes; other C libraries are not affected.
pub fn raise_trim_threshold() {
    drop(black_box(Vec::<u8>::with_capacity(black_box(BLOCK))));
}
