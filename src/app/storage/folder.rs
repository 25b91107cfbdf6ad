//! The measurements of a folder.

use pbrdf::measurement::formats::extensions;
use std::cmp::Ordering;
use std::io;
use std::path::{Path, PathBuf};

/// The files of a folder that may be measurements, by their extensions, in the order in which people
/// count: 5 nm before 450 nm before 1000 nm.
///
/// # Errors
/// The folder cannot be read.
pub fn measurements_in(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let known = extensions();
    let is_known = |path: &PathBuf| {
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
        path.is_file() && extension.is_some_and(|extension| known.contains(&extension.as_str()))
    };
    let paths = std::fs::read_dir(folder)?.map(|entry| entry.map(|entry| entry.path())).collect::<io::Result<Vec<PathBuf>>>()?;
    let name = |path: &PathBuf| path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let mut files: Vec<(String, PathBuf)> = paths.into_iter().filter(is_known).map(|path| (name(&path), path)).collect();
    files.retain(|(name, _)| !name.starts_with('.'));
    files.sort_by(|(one, _), (other, _)| counted(one, other));
    Ok(files.into_iter().map(|(_, path)| path).collect())
}

/// Compares names, numbers in them by their size.
fn counted(mut one: &str, mut other: &str) -> Ordering {
    while let (Some(a), Some(b)) = (one.chars().next(), other.chars().next()) {
        if a.is_ascii_digit() && b.is_ascii_digit() {
            let (number, rest) = split_number(one);
            let (other_number, other_rest) = split_number(other);
            match number.len().cmp(&other_number.len()).then_with(|| number.cmp(other_number)) {
                Ordering::Equal => (one, other) = (rest, other_rest),
                different => return different,
            }
        } else if a == b {
            (one, other) = (&one[a.len_utf8()..], &other[b.len_utf8()..]);
        } else {
            return a.cmp(&b);
        }
    }
    one.len().cmp(&other.len())
}

/// The digits that a text begins with, without leading zeros, and the rest.
fn split_number(text: &str) -> (&str, &str) {
    let end = text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
    let (digits, rest) = text.split_at(end);
    (digits.trim_start_matches('0'), rest)
}

#[cfg(test)]
mod tests {
    use super::{counted, measurements_in};

    #[test]
    fn files_come_as_people_count_and_others_are_left_alone() {
        let folder = tempfile::tempdir().expect("a folder");
        for name in ["s 450.csv", "s 1000.csv", "s 05.csv", "notes.md", "figure.png", ".hidden.csv", "t.CSV"] {
            std::fs::write(folder.path().join(name), "").expect("a file");
        }
        std::fs::create_dir(folder.path().join("inner.csv")).expect("a folder");
        let found = measurements_in(folder.path()).expect("a folder that can be read");
        let names: Vec<&str> = found.iter().filter_map(|path| path.file_name()?.to_str()).collect();
        assert_eq!(names, ["s 05.csv", "s 450.csv", "s 1000.csv", "t.CSV"]);
        assert!(measurements_in(&folder.path().join("not there")).is_err());
        assert!(counted("a9b10", "a9b9").is_gt() && counted("a", "a1").is_lt() && counted("1a", "01b").is_lt());
    }
}
