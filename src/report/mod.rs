//! Floor 5: results in the forms that leave the program.

mod fit_json;

pub use fit_json::fit_json;
