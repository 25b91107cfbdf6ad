//! Workbooks of three kinds hold the same table; whatever a sheet holds elsewhere, nothing is lost and memory suffices.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]
#![cfg(feature = "workbooks")]

use pbrdf::measurement::foreign::{LabTable, TableOptions};
use pbrdf::measurement::formats::{ImportError, ImportOptions, Imported, Opened, Question, open};
use pbrdf::measurement::unwatched;
use std::path::Path;

fn read(name: &str, sheet: Option<&str>) -> Result<Imported, ImportError> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/workbooks").join(name);
    let bytes = std::fs::read(path).expect("a file of the repository");
    let options = TableOptions { sheet: sheet.map(str::to_owned), ..TableOptions::default() };
    LabTable::open(bytes, &options, &mut unwatched)?.read(&options, &mut unwatched)
}

#[test]
fn a_table_is_the_same_in_every_kind_of_workbook() {
    for name in ["steel.xlsx", "steel.xls", "steel.ods", "backwards.xlsx"] {
        let imported = read(name, Some("data")).unwrap_or_else(|error| panic!("{name}: {error}"));
        let [measurement] = &imported.measurements[..] else { panic!("{name}: {} measurements", imported.measurements.len()) };
        let values: Vec<(f64, f64, f64)> = measurement
            .rows
            .iter()
            .filter(|row| !row.masked)
            .filter_map(|row| Some((row.geometry.theta_i().0, row.geometry.signed_theta_r().0, row.dolp?.value)))
            .collect();
        let expected = (0..8).filter(|&i| i != 5).map(|i| (30.0, f64::from(10 * i), (10.0 + f64::from(i) / 4.0) / 100.0));
        assert!(values.iter().copied().eq(expected), "{name}: {values:?}");
        assert_eq!(measurement.metadata("comment").map(str::trim), Some("sample steel"), "{name}");
    }
}

#[test]
fn without_a_name_the_sheets_to_choose_from_are_told() {
    for name in ["steel.xlsx", "steel.xls", "steel.ods"] {
        for sheet in [None, Some("none")] {
            let Err(error) = read(name, sheet) else { panic!("{name}: {sheet:?} was read") };
            let ImportError::NoSheet { names, .. } = &error else { panic!("{name}: {error}") };
            assert_eq!(names, &["notes", "data"], "{name}");
        }
    }
}

/// One word in the last cell of a sheet made a table of 17 billion cells of it, and the program was ended by the system.
#[test]
fn a_word_in_the_last_cell_of_a_sheet_costs_a_word() {
    let imported = read("far.xlsx", Some("data")).expect("a table");
    assert_eq!(imported.measurements[0].rows.len(), 8);
}

/// The window shows the first sheet that is a table, and any other on demand.
#[test]
fn a_workbook_opens_at_its_first_table_and_another_sheet_is_asked_for() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/workbooks/steel.ods");
    let Ok(Opened::Foreign(file)) = open(std::fs::read(path).expect("a file of the repository"), &mut unwatched) else {
        panic!("a foreign table")
    };
    let Some(Question::Columns(sample)) = file.questions().pop() else { panic!("a table asks for its columns") };
    assert_eq!((sample.sheets.as_slice(), sample.sheet.as_deref()), (&["notes".to_owned(), "data".to_owned()][..], Some("data")));
    let offered = ImportOptions::offered(&file.questions());
    assert_eq!(file.import(&offered, &mut unwatched).expect("a table").measurements[0].rows.len(), 8);
    assert!(file.reopened(&offered.table, &mut unwatched).expect("it is read so").is_none());
    let other = TableOptions { sheet: Some("notes".to_owned()), ..TableOptions::default() };
    assert!(file.reopened(&other, &mut unwatched).is_err(), "words alone");
    let separated = TableOptions { thousands: Some(','), ..offered.table };
    let again = file.reopened(&separated, &mut unwatched).expect("a table").expect("read anew");
    let Some(Question::Columns(sample)) = again.questions().pop() else { panic!("a table asks for its columns") };
    assert_eq!((sample.sheet.as_deref(), sample.thousands), (Some("data"), Some(',')), "the sheet stays");
}
