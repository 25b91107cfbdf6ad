//! What differs between a desktop and a browser.

pub mod heap;
