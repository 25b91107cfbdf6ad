//! Jobs: work off the thread of the window, with progress, cancel and result; nothing of fits is known here.

pub mod async_memo;
pub mod kind;
pub mod memo;
pub mod worker;
