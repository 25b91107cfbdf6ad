//! `fit --batch` by process: a row for each measurement, whatever becomes of the run.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]
#![cfg(feature = "cli")]

mod common;

use common::program::{Folder, answer, refusal, run, text};
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Simulated measurements of a steel surface, each with noise of its own.
fn measured(folder: &Folder, count: usize) {
    for seed in 0..count {
        let path = folder.path(&format!("run{seed:02}.csv")).display().to_string();
        let seed = seed.to_string();
        let angles = ["--theta-i", "30,50,70", "--theta-r", "10:80:10"];
        answer(&[&["simulate", "--set", "n=2.07,k=2.9", "--noise", "0.005", "--seed", &seed, "-o", &path], &angles[..]].concat());
    }
}

fn pattern(folder: &Folder) -> String {
    folder.path("run*.csv").display().to_string()
}

/// The cells of a table of results by the names of their columns.
fn rows(path: &Path) -> Vec<Vec<(String, String)>> {
    let mut table = csv::ReaderBuilder::new().comment(Some(b'#')).from_path(path).expect("a table");
    let names: Vec<String> = table.headers().expect("a header").iter().map(str::to_owned).collect();
    let row = |record: csv::StringRecord| names.iter().cloned().zip(record.iter().map(str::to_owned)).collect();
    table.records().map(|record| row(record.expect("as many cells as columns"))).collect()
}

fn cell<'a>(row: &'a [(String, String)], name: &str) -> &'a str {
    &row.iter().find(|(column, _)| column == name).expect("a column of this name").1
}

#[test]
fn a_batch_has_the_numbers_of_single_fits_and_a_sentence_for_a_damaged_file() {
    let folder = Folder::new();
    measured(&folder, 3);
    folder.file("run01b.csv", "theta_i,theta_r,dolp\n30,95,0.1\n");
    folder.file("run03.csv", "theta_i,theta_r,dolp,set\n30,30,0.1,a\n50,50,0.2,a\n60,60,0.3,b\n70,70,0.4,b\n");
    let table = folder.path("results.csv");
    let output = run(&["fit", "--batch", &pattern(&folder), "-o", &table.display().to_string(), "--starts", "1", "--fix", "ks=1"]);
    assert_eq!((output.status.code(), text(&output.stdout)), (Some(0), String::new()), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("6 measurements of 5 files, 1 of them without a fit"), "{}", text(&output.stderr));
    let rows = rows(&table);
    let names: Vec<(&str, &str)> =
        rows.iter().map(|row| (cell(row, "file").rsplit('/').next().unwrap_or_default(), cell(row, "set"))).collect();
    assert_eq!(
        names,
        [("run00.csv", ""), ("run01.csv", ""), ("run01b.csv", ""), ("run02.csv", ""), ("run03.csv", "a"), ("run03.csv", "b")]
    );
    assert!(cell(&rows[2], "error").contains("run01b.csv") && cell(&rows[2], "error").contains("line 2"), "{:?}", rows[2]);
    assert_eq!((cell(&rows[2], "n"), cell(&rows[2], "objective")), ("", ""));
    let single = answer(&["fit", cell(&rows[1], "file"), "--starts", "1", "--fix", "ks=1", "--json"]);
    let single: Value = serde_json::from_str(&single).expect("JSON");
    let number = |name: &str| cell(&rows[1], name).parse::<f64>().ok();
    assert_eq!(number("objective"), single["objective"].as_f64());
    for name in ["n", "k", "sigma", "kd", "kv"] {
        let estimate = &single["parameters"][name];
        assert_eq!(number(name), estimate["value"].as_f64());
        assert_eq!(number(&format!("{name}_std_error")), estimate["std_error"].as_f64());
        assert_eq!(number(&format!("{name}_low95")), estimate["interval95"][0].as_f64());
        assert_eq!(cell(&rows[1], &format!("{name}_determined")), estimate["determined"].to_string());
    }
}

#[test]
fn a_batch_that_was_killed_goes_on_where_it_was() {
    let folder = Folder::new();
    measured(&folder, 24);
    let (whole, broken) = (folder.path("whole.csv"), folder.path("broken.csv"));
    answer(&["fit", "--batch", &pattern(&folder), "-o", &whole.display().to_string()]);
    let mut program = Command::new(env!("CARGO_BIN_EXE_pbrdf-explorer"))
        .args(["fit", "--batch", &pattern(&folder), "-o", &broken.display().to_string()])
        .stderr(Stdio::null())
        .spawn()
        .expect("the program was built beside this test");
    let lines = || std::fs::read(&broken).unwrap_or_default().iter().filter(|&&byte| byte == b'\n').count();
    let begun = Instant::now();
    // Two comments, the header, and three rows.
    while lines() < 6 && begun.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(2));
    }
    program.kill().expect("it runs, or has ended");
    program.wait().expect("its end");
    let done = lines() - 3;
    assert!((3..24).contains(&done), "{done} files before the end");
    // As if it had been killed while writing.
    let mut torn = std::fs::read(&broken).expect("what is there");
    torn.truncate(torn.len() - 20);
    std::fs::write(&broken, torn).expect("a writable file");
    let output = run(&["fit", "--batch", &pattern(&folder), "-o", &broken.display().to_string()]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains(&format!("{} files were there already", done - 1)), "{done}: {}", text(&output.stderr));
    let bytes = |path: &Path| text(&std::fs::read(path).expect("a table"));
    assert_eq!(bytes(&broken), bytes(&whole));
}

#[test]
fn only_what_changed_is_fitted_again_and_nothing_else_is_overwritten() {
    let folder = Folder::new();
    measured(&folder, 2);
    let table = folder.path("results.csv").display().to_string();
    let options = ["--starts", "1", "--intervals", "linear"];
    let batch = |more: &[&str]| run(&[&["fit", "--batch", &pattern(&folder), "-o", &table], &options[..], more].concat());
    assert_eq!(batch(&[]).status.code(), Some(0));
    let before = rows(Path::new(&table));
    let changed = before[1].iter().find(|(name, _)| name == "file").expect("a file").1.clone();
    let data = std::fs::read_to_string(&changed).expect("a measurement");
    std::fs::write(&changed, data.trim_end().rsplit_once('\n').expect("rows").0).expect("a writable file");
    let output = batch(&[]);
    assert!(text(&output.stderr).contains("1 files were there already"), "{}", text(&output.stderr));
    let after = rows(Path::new(&table));
    assert_eq!((&after[0], after.len()), (&before[0], 2));
    assert_eq!((cell(&before[1], "rows"), cell(&after[1], "rows")), ("24", "23"));

    let bytes = std::fs::read(&table).expect("a table");
    assert!(text(&batch(&["--seed", "2"]).stderr).contains("holds fits with other options"));
    assert_eq!(std::fs::read(&table).expect("a table"), bytes);
    let other = folder.file("notes.csv", "what I need\n");
    let message = refusal(&["fit", "--batch", &pattern(&folder), "-o", &other]);
    assert!(message.contains("is no table"), "{message}");
    assert_eq!(std::fs::read(&other).expect("notes"), b"what I need\n");
}

#[test]
fn a_batch_refuses_what_it_has_no_place_for() {
    let folder = Folder::new();
    measured(&folder, 1);
    let pattern = pattern(&folder);
    let message = refusal(&["fit", "--batch", &pattern]);
    assert!(message.contains("--output"), "{message}");
    let message = refusal(&["fit", "--batch", &pattern, "-o", "x.csv", "--json"]);
    assert!(message.contains("--json"), "{message}");
    let message = refusal(&["fit", "--batch", &pattern, "-o", "x.csv", "--fix", "n@a.csv=2"]);
    assert!(message.contains("@a.csv"), "{message}");
    let message = refusal(&["fit", "--batch", &folder.path("none*.csv").display().to_string(), "-o", "x.csv"]);
    assert!(message.contains("none*.csv"), "{message}");
    let message = refusal(&["fit", "--batch", &pattern, "-o", "/dev/null"]);
    assert!(message.contains("is no file"), "{message}");
}
