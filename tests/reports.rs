//! The reports by process: keys, exit codes, files.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]
#![cfg(feature = "cli")]

use serde_json::Value;
use std::process::{Command, Output};

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pbrdf-explorer")).args(arguments).output().expect("the program was built beside this test")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// The JSON of a report, its rows checked for exactly these keys.
fn rows(subject: &str, keys: &[&str]) -> Vec<Value> {
    let output = run(&["report", subject, "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let json: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert!(json["machine"].is_string() && json["date"].is_string(), "{json}");
    let rows = json["rows"].as_array().expect("rows").clone();
    assert!(!rows.is_empty());
    for row in &rows {
        let mut found: Vec<&str> = row.as_object().expect("a flat object").keys().map(String::as_str).collect();
        let mut expected = keys.to_vec();
        found.sort_unstable();
        expected.sort_unstable();
        assert_eq!(found, expected);
        assert!(row.as_object().expect("a flat object").values().all(|value| !value.is_object() && !value.is_array()), "{row}");
    }
    rows
}

#[test]
fn a_report_goes_into_a_folder_too() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let target = folder.path().join("new").join("folder");
    let output = run(&["report", "error-vs-time", "-o", &target.display().to_string()]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let markdown = std::fs::read_to_string(target.join("error-vs-time.md")).expect("the report as Markdown");
    assert_eq!(markdown, text(&output.stdout));
    assert!(markdown.contains("| task"), "{markdown}");
    let json = std::fs::read(target.join("error-vs-time.json")).expect("the report as JSON");
    assert!(serde_json::from_slice::<Value>(&json).expect("JSON")["rows"].is_array());
}

#[test]
fn a_folder_that_cannot_be_written_is_found_out_before_the_work() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let file = folder.path().join("file");
    std::fs::write(&file, "").expect("a writable folder");
    for target in [file.display().to_string(), "/proc/nowhere".to_owned()] {
        let output = run(&["report", "error-vs-time", "-o", &target]);
        assert_eq!((output.status.code(), text(&output.stdout)), (Some(1), String::new()));
        assert!(text(&output.stderr).contains(&target), "{}", text(&output.stderr));
    }
}

#[test]
fn an_unknown_subject_is_refused_with_the_known_ones() {
    let output = run(&["report", "weather"]);
    assert_eq!((output.status.code(), text(&output.stdout)), (Some(2), String::new()));
    let sentence = text(&output.stderr);
    assert!(["error-vs-time", "stability", "cost"].iter().all(|subject| sentence.contains(subject)), "{sentence}");
}

#[test]
fn the_cancellation_free_form_holds_its_digits_where_the_textbook_loses_all() {
    let keys = ["task", "method", "ns_per_point", "worst_relative_error", "median_relative_error", "success_rate"];
    let rows = rows("error-vs-time", &keys);
    let worst = |method: &str| {
        let row = rows.iter().find(|row| row["method"] == method).expect("a row of that method");
        row["worst_relative_error"].as_f64().expect("a number")
    };
    assert!(worst("cancellation-free, prepared scene") <= 1e-13);
    assert_eq!(worst("textbook, f64"), 1.0);
}

#[test]
fn the_stability_gallery_passes_and_the_textbook_does_not() {
    let keys = ["case", "brdf_error", "dolp_error", "gradient_error", "textbook_error", "condition", "outcome", "pass"];
    let rows = rows("stability", &keys);
    let failed: Vec<&Value> = rows.iter().filter(|row| row["pass"] != true).collect();
    assert!(failed.is_empty(), "{failed:#?}");
    let evaluations: Vec<&Value> = rows.iter().filter(|row| row["brdf_error"].is_number()).collect();
    assert!(evaluations.len() >= 60 && rows.len() - evaluations.len() >= 12, "{} rows", rows.len());
    assert!(evaluations.iter().filter(|row| row["textbook_error"].as_f64().expect("a number") > 1e-13).count() > 20);
}
