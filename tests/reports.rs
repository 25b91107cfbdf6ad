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

/// What a value of the JSON may be.
#[derive(Clone, Copy)]
enum Kind {
    Text,
    Number,
    /// A number, or null where there is none or it is not finite.
    Optional,
    Count,
    Flag,
}

impl Kind {
    fn fits(self, value: &Value) -> bool {
        match self {
            Self::Text => value.is_string(),
            Self::Number => value.is_number(),
            Self::Optional => value.is_number() || value.is_null(),
            Self::Count => value.is_u64(),
            Self::Flag => value.is_boolean(),
        }
    }
}

/// The rows of a report's JSON, which has exactly these keys of these kinds, and nothing else beside machine and date.
fn rows(arguments: &[&str], keys: &[(&str, Kind)]) -> Vec<Value> {
    let output = run(&[&["report", "--json"], arguments].concat());
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let json: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let top: Vec<&str> = json.as_object().expect("an object").keys().map(String::as_str).collect();
    assert_eq!(top, ["date", "machine", "rows"]);
    assert!(json["machine"].is_string() && json["date"].is_string(), "{json}");
    let rows = json["rows"].as_array().expect("rows").clone();
    assert!(!rows.is_empty());
    for row in &rows {
        let mut found: Vec<&str> = row.as_object().expect("a flat object").keys().map(String::as_str).collect();
        let mut expected: Vec<&str> = keys.iter().map(|(key, _)| *key).collect();
        found.sort_unstable();
        expected.sort_unstable();
        assert_eq!(found, expected);
        for (key, kind) in keys {
            assert!(kind.fits(&row[*key]), "{key} in {row}");
        }
    }
    rows
}

/// `error-vs-time` once, for all that is to be said of it: it is the long one.
#[test]
fn error_against_time_goes_to_standard_output_and_into_a_folder() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let target = folder.path().join("new").join("folder");
    let rows = rows(
        &["error-vs-time", "-o", &target.display().to_string()],
        &[
            ("task", Kind::Text),
            ("method", Kind::Text),
            ("ns_per_point", Kind::Optional),
            ("elapsed_ms", Kind::Optional),
            ("worst_relative_error", Kind::Number),
            ("median_relative_error", Kind::Number),
            ("success_rate", Kind::Optional),
        ],
    );
    let row = |method: &str| rows.iter().find(|row| row["method"] == method).expect("a row of that method");
    let worst = |method: &str| row(method)["worst_relative_error"].as_f64().expect("a number");
    assert!(worst("cancellation-free, prepared scene") <= 1e-13 && worst("batch kernel, prepared scene") <= 1e-13);
    assert_eq!(worst("textbook, f64"), 1.0);
    assert_eq!(row("this program, many starts")["success_rate"], 1.0);
    assert!(row("model cauchy")["elapsed_ms"].is_number() && row("model cauchy")["ns_per_point"].is_null());
    let markdown = std::fs::read_to_string(target.join("error-vs-time.md")).expect("the report as Markdown");
    assert!(markdown.contains("| task"), "{markdown}");
    let json = std::fs::read(target.join("error-vs-time.json")).expect("the report as JSON");
    let json: Value = serde_json::from_slice(&json).expect("JSON");
    assert!(json["rows"].is_array() && json["curves"].is_array() && json["profiles"].is_array());
    for figure in ["evaluate", "fit", "profile", "models", "ladder"] {
        let svg = std::fs::read_to_string(target.join(format!("error-vs-time-{figure}.svg"))).expect("a figure");
        assert!(svg.starts_with("<svg") || svg.starts_with("<?xml"));
        let png = std::fs::read(target.join(format!("error-vs-time-{figure}.png"))).expect("a figure");
        assert!(png.starts_with(b"\x89PNG"));
    }
}

#[test]
fn the_cost_of_scenes_comes_with_what_they_leave_out_and_how_exact_they_stay() {
    let keys = [
        ("scene", Kind::Text),
        ("distribution", Kind::Text),
        ("kernel", Kind::Text),
        ("threads", Kind::Count),
        ("output", Kind::Text),
        ("terms", Kind::Text),
        ("points", Kind::Count),
        ("ns_per_point", Kind::Number),
        ("left_out", Kind::Text),
        ("max_ulp", Kind::Optional),
        ("max_relative_error", Kind::Number),
    ];
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let rows = rows(&["cost", "-o", &folder.path().display().to_string()], &keys);
    assert!(std::fs::read(folder.path().join("cost-time.png")).expect("a figure").starts_with(b"\x89PNG"));
    assert!(rows.len() >= 12, "{}", rows.len());
    for row in &rows {
        assert!(["gauss", "cauchy"].iter().any(|name| row["distribution"] == *name), "{row}");
        assert!(["scalar", "batch"].iter().any(|name| row["kernel"] == *name), "{row}");
        assert!(["dolp", "brdf", "mueller", "gradient", "landscape"].iter().any(|name| row["output"] == *name), "{row}");
        assert!(row["ns_per_point"].as_f64().expect("a time") > 0.0, "{row}");
        let everything = row["scene"].as_str().expect("a name").starts_with("everything");
        assert_eq!(row["left_out"].as_str().expect("words").is_empty(), everything, "{row}");
        if row["kernel"] == "scalar" {
            // The same operations without those of what is left out: rotations alone round anew.
            assert!(row["max_ulp"].as_f64().expect("a number") <= 4.0, "{row}");
        } else {
            // Elementary functions of the kernel's own; squares and a sum of 27 more in the landscape.
            assert!(row["max_ulp"].is_null() && row["max_relative_error"].as_f64().expect("a number") <= 1e-13, "{row}");
        }
    }
    let has = |kernel: &str, output: &str| {
        rows.iter().any(|row| {
            let named = row["kernel"] == kernel && row["output"] == output && row["threads"] == 1;
            named && row["distribution"] == "cauchy" && row["terms"] == "specular+diffuse+volume"
        })
    };
    assert!(has("batch", "dolp") && has("batch", "gradient") && has("scalar", "gradient"));
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
fn the_stability_gallery_passes_and_the_textbook_does_not() {
    let keys = [
        ("case", Kind::Text),
        ("brdf_error", Kind::Optional),
        ("dolp_error", Kind::Optional),
        ("gradient_error", Kind::Optional),
        ("textbook_error", Kind::Optional),
        ("condition", Kind::Optional),
        ("outcome", Kind::Text),
        ("pass", Kind::Flag),
    ];
    let rows = rows(&["stability"], &keys);
    let failed: Vec<&Value> = rows.iter().filter(|row| row["pass"] != true).collect();
    assert!(failed.is_empty(), "{failed:#?}");
    let evaluations: Vec<&Value> = rows.iter().filter(|row| row["brdf_error"].is_number()).collect();
    assert!(evaluations.len() >= 60 && rows.len() - evaluations.len() >= 12, "{} rows", rows.len());
    assert!(evaluations.iter().filter(|row| row["textbook_error"].as_f64().expect("a number") > 1e-13).count() > 20);
}
