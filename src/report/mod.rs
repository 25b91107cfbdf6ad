//! Results in the forms that leave the program.

mod benchmark_figures;
mod comparison_figure;
mod curves;
mod document;
mod fit_comments;
mod fit_document;
mod fit_figures;
mod fit_json;
mod joint_document;
mod joint_json;
mod language;
mod latex_table;
mod number;
mod picture;
mod residual_table;
mod result_table;

pub use benchmark_figures::BenchmarkFigures;
pub use comparison_figure::{ComparedMeasurement, comparison_figure};
pub use curves::{CurvePoint, curve, directions, write_curves};
pub use document::{DocumentPart, ReportDocument};
pub use fit_comments::fit_comments;
pub use fit_document::{DataSource, FitDocument};
pub use fit_figures::FitFigures;
pub use fit_json::fit_json;
pub use joint_document::{JointDocument, JointSource};
pub use joint_json::joint_json;
pub use language::{English, ReportLanguage};
pub use picture::{PictureQuantity, picture_figure, picture_map};
pub use residual_table::{fitted_cells, write_beside, write_fitted, write_fitted_sets};
pub use result_table::{ResultCells, ResultColumn, ResultTable, TableFormat, bracketed};
