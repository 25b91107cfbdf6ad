//! Files by their paths, and the clock that dates them: those of the system, or in a browser those
//! that the page keeps.

#[cfg(not(target_arch = "wasm32"))]
mod native;
#[cfg(target_arch = "wasm32")]
mod web;

#[cfg(all(not(target_arch = "wasm32"), feature = "gui"))]
pub use native::FileLock as Lock;
#[cfg(not(target_arch = "wasm32"))]
pub use native::*;
#[cfg(target_arch = "wasm32")]
pub use web::PageLock as Lock;
#[cfg(target_arch = "wasm32")]
pub use web::*;
