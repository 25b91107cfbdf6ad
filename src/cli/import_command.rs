//! The command line that imports a file, to be told where another command refuses the file.

use pbrdf::measurement::foreign::{LabTable, OtherFormat, TableOptions};
use pbrdf::measurement::formats::recognise;
use std::path::Path;

/// How to import a file that is no measurement of this project's own: the options after its name.
/// None where it is no table of numbers either.
pub fn options_for(bytes: &[u8]) -> Option<String> {
    if recognise(bytes).is_some() {
        return Some(String::new());
    }
    if OtherFormat::of(bytes).is_some() {
        return None;
    }
    let table = LabTable::open(bytes.to_vec(), &TableOptions::default(), &mut pbrdf::measurement::unwatched).ok()?;
    let guess = table.guess(&TableOptions::default()).ok()?;
    let answers: Vec<&str> = guess.doubts.iter().map(pbrdf::measurement::foreign::Doubt::answer).collect();
    let names_columns = answers.iter().find(|answer| answer.starts_with("--columns"));
    Some(names_columns.map_or_else(|| [&["--auto"], &answers[..]].concat().join(" "), |answer| (*answer).to_owned()))
}

/// The command that imports a file with those options.
pub fn command(path: &Path, options: &str) -> String {
    let output = if path == Path::new("-") { "imported.csv".into() } else { path.with_extension("imported.csv") };
    let word = |path: &Path| quoted(&path.display().to_string());
    let space = if options.is_empty() { "" } else { " " };
    format!("pbrdf-explorer import {}{space}{options} -o {}", word(path), word(&output))
}

/// A word as a shell takes it, on one line.
pub fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_=.,:/+".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''").replace(['\n', '\r'], " "))
    }
}
