//! What the tests of the program share.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]
#![allow(dead_code, reason = "each test file uses its own part of this module")]

#[cfg(feature = "cli")]
pub mod program;

use std::path::{Path, PathBuf};

/// A file of the repository, named from its root.
pub fn repository_file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}
