//! A job that does not start.

use crate::app::text::localized::Localized as _;
use std::io;
use tr::tr;

/// Why a job did not start, as a sentence.
#[expect(clippy::needless_pass_by_value, reason = "an argument of map_err")]
pub(super) fn start_error(error: io::Error) -> String {
    tr!("The job cannot be started: {}.", error.localized())
}
