//! Imports run downwards: every folder imports only folders of lower floors, and no files import each other in a circle.
//!
//! The test reads the source as text: `use` declarations and the paths that begin with `crate`, `super` or `pbrdf`.
//! Tests inside the source are left out.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]
#![allow(clippy::print_stdout, reason = "what is left is shown with --nocapture")]

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Floors, the lowest first; folders in one line share a floor.
const FLOORS: &[&[&str]] = &[
    &["core/src/optics"],
    &["core/src/model"],
    &["core/src/measurement"],
    &["core/src/fit"],
    &["core/src/selftest"],
    &["core/src"],
    &["src/figure"],
    &["src/report"],
    &["src/files"],
    &["src/cli"],
    &["src/app/platform"],
    &["src/app/text"],
    &["src/app/work"],
    &["src/app/storage"],
    &["src/app/jobs"],
    &["src/app/tasks"],
    &["src/app/plots"],
    &["src/app/views", "src/app/panels"],
    &["src/app/shell"],
    &["src/app"],
    &["src"],
];

/// Folders that still import upwards. The list only shrinks: an arrow that no longer exists must be taken off.
const TOLERATED_ARROWS: &[&str] = &[];

/// Folders that still hold a circle of imports. The list only shrinks as well.
const TOLERATED_CIRCLES: &[&str] = &[];

/// Files of the program by their path from the root, with `/` between folders.
type Sources = BTreeMap<String, Vec<String>>;

#[test]
fn imports_run_downwards() {
    let sources = sources();
    let mut arrows: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for (from, targets) in imports(&sources) {
        for to in targets {
            let (lower, upper) = (floor(&from), floor(&to));
            if lower.0 < upper.0 {
                arrows.entry(format!("{} -> {}", lower.1, upper.1)).or_default().insert(format!("{from} -> {to}"));
            }
        }
    }
    let list = |arrows: &BTreeMap<String, BTreeSet<String>>| -> String {
        arrows.iter().map(|(arrow, files)| format!("{arrow}\n    {}\n", files.iter().cloned().collect::<Vec<_>>().join("\n    "))).collect()
    };
    println!("imports that run upwards:\n{}", list(&arrows));
    let gone: Vec<&&str> = TOLERATED_ARROWS.iter().filter(|arrow| !arrows.contains_key(**arrow)).collect();
    arrows.retain(|arrow, _| !TOLERATED_ARROWS.contains(&arrow.as_str()));
    assert!(arrows.is_empty(), "these imports run upwards:\n{}", list(&arrows));
    assert!(gone.is_empty(), "no longer there, to be taken off TOLERATED_ARROWS: {gone:?}");
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    let circles = circles(&imports(&sources()));
    let mut folders: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for circle in circles {
        folders.entry(common_folder(&circle)).or_default().push(circle.into_iter().collect::<Vec<_>>().join(", "));
    }
    println!("circles of imports: {folders:#?}");
    let gone: Vec<&&str> = TOLERATED_CIRCLES.iter().filter(|folder| !folders.contains_key(**folder)).collect();
    folders.retain(|folder, _| !TOLERATED_CIRCLES.contains(&folder.as_str()));
    assert!(folders.is_empty(), "these files import each other in a circle: {folders:#?}");
    assert!(gone.is_empty(), "no longer there, to be taken off TOLERATED_CIRCLES: {gone:?}");
}

/// Number and name of the floor of a file: the longest folder of [`FLOORS`] that holds it.
fn floor(file: &str) -> (usize, &'static str) {
    let holds = |folder: &str| file.strip_prefix(folder).is_some_and(|rest| rest.starts_with('/'));
    let all = FLOORS.iter().enumerate().flat_map(|(number, folders)| folders.iter().map(move |&folder| (number, folder)));
    all.filter(|(_, folder)| holds(folder)).max_by_key(|(_, folder)| folder.len()).expect("every file has a floor")
}

fn sources() -> Sources {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut sources = Sources::new();
    for folder in ["core/src", "src"] {
        read(root, folder, &mut sources);
    }
    assert!(sources.len() > 100, "the source is where this test looks for it");
    sources
}

/// Reads a folder and all that it holds.
fn read(root: &Path, folder: &str, sources: &mut Sources) {
    for entry in std::fs::read_dir(root.join(folder)).expect("a folder of the source") {
        let entry = entry.expect("an entry");
        let name = entry.file_name().into_string().expect("a name in UTF-8");
        let path = format!("{folder}/{name}");
        if entry.file_type().expect("a type").is_dir() {
            if name != "tests" {
                read(root, &path, sources);
            }
        } else if name.ends_with(".rs") && name != "tests.rs" {
            sources.insert(path, tokens(&std::fs::read_to_string(entry.path()).expect("a text")));
        }
    }
}

/// How a test module begins.
const TEST_MODULE: [&str; 8] = ["#", "[", "cfg", "(", "test", ")", "]", "mod"];

/// Words, `::` and single signs, without comments, literals and test modules.
fn tokens(text: &str) -> Vec<String> {
    let letters: Vec<char> = text.chars().collect();
    let starts = |at: usize, mark: &str| letters[at..].iter().copied().take(mark.len()).eq(mark.chars());
    let (mut tokens, mut at): (Vec<String>, usize) = (Vec::new(), 0);
    while let Some(&letter) = letters.get(at) {
        let is_word = |c: &char| c.is_alphanumeric() || *c == '_';
        if starts(at, "//") {
            at += letters[at..].iter().take_while(|c| **c != '\n').count();
        } else if let Some(length) = literal(&letters[at..]) {
            at += length;
        } else if is_word(&letter) {
            let word: String = letters[at..].iter().copied().take_while(is_word).collect();
            at += word.chars().count();
            tokens.push(word);
        } else {
            let sign = if starts(at, "::") { "::".to_owned() } else { letter.to_string() };
            at += sign.len().clamp(1, 2);
            if !letter.is_whitespace() {
                tokens.push(sign);
            }
        }
        // The test module is the last item of its file.
        if tokens.iter().rev().take(TEST_MODULE.len()).eq(TEST_MODULE.iter().rev()) {
            break;
        }
    }
    tokens
}

/// Length of the string or character that begins here.
fn literal(letters: &[char]) -> Option<usize> {
    let ended = |close: char, from: usize| {
        let mut at = from;
        while letters.get(at).is_some_and(|c| *c != close) {
            at += if letters[at] == '\\' { 2 } else { 1 };
        }
        at + 1
    };
    match letters {
        ['r', '#', '"', ..] => letters.windows(2).position(|end| end == ['"', '#']).map(|at| at + 2).or(Some(letters.len())),
        ['r', '"', ..] => letters[2..].iter().position(|c| *c == '"').map(|at| at + 3),
        ['"', ..] => Some(ended('"', 1)),
        ['\'', '\\', ..] => Some(ended('\'', 1)),
        ['\'', _, '\'', ..] => Some(3),
        _ => None,
    }
}

/// A path that a file names, and whether the file hands it on by `pub use`.
struct Named {
    path: Vec<String>,
    is_public: bool,
}

/// All paths of `use` declarations, and those elsewhere that begin at a crate or a parent.
fn named(tokens: &[String]) -> Vec<Named> {
    let (mut all, mut at) = (Vec::new(), 0);
    while at < tokens.len() {
        if tokens[at] == "use" {
            let end = at + tokens[at..].iter().position(|token| token == ";").unwrap_or(tokens.len() - at - 1);
            let before = tokens[..at].iter().rev().take_while(|token| !matches!(token.as_str(), ";" | "}" | "]" | "{"));
            let is_public = before.into_iter().any(|token| token == "pub");
            let mut paths = Vec::new();
            tree(&tokens[at + 1..end], &[], &mut paths);
            all.extend(paths.into_iter().map(|path| Named { path, is_public }));
            at = end;
        } else if begins_a_path(tokens, at) {
            let rest = tokens[at..].chunks(2).take_while(|pair| pair.get(1).is_some_and(|sign| sign == "::"));
            let length = rest.count();
            let words = tokens[at..].iter().step_by(2).take(length + 1);
            let path = words.take_while(|word| word.starts_with(|c: char| c.is_alphabetic() || c == '_')).cloned().collect();
            all.push(Named { path, is_public: false });
            at += 2 * length;
        }
        at += 1;
    }
    all
}

/// Whether a path to another module begins here; `pub(in crate::fit)` has none.
fn begins_a_path(tokens: &[String], at: usize) -> bool {
    matches!(tokens[at].as_str(), "crate" | "super" | "pbrdf")
        && tokens.get(at + 1).is_some_and(|token| token == "::")
        && (at == 0 || !matches!(tokens[at - 1].as_str(), "::" | "in"))
}

/// The paths of a tree of `use`, such as `a::{b, c::{d, e}}`.
fn tree(tokens: &[String], before: &[String], paths: &mut Vec<Vec<String>>) {
    let (mut path, mut depth, mut begin) = (before.to_vec(), 0, 0);
    let is_group = tokens.iter().position(|token| token == "{");
    let Some(open) = is_group else {
        let words = tokens.iter().take_while(|token| *token != "as").filter(|token| *token != "::");
        path.extend(words.cloned());
        paths.push(path);
        return;
    };
    path.extend(tokens[..open].iter().filter(|token| *token != "::").cloned());
    let inside = &tokens[open + 1..tokens.len() - 1];
    for (at, token) in inside.iter().enumerate() {
        match token.as_str() {
            "{" => depth += 1,
            "}" => depth -= 1,
            "," if depth == 0 => {
                tree(&inside[begin..at], &path, paths);
                begin = at + 1;
            }
            _ => {}
        }
    }
    if begin < inside.len() {
        tree(&inside[begin..], &path, paths);
    }
}

/// Module path of a file, its crate's folder first.
fn module(file: &str) -> Vec<String> {
    let root = if file.starts_with("core/") { "core/src" } else { "src" };
    let inner = file[root.len() + 1..].trim_end_matches(".rs");
    let parts = inner.split('/').filter(|part| !matches!(*part, "mod" | "lib" | "main"));
    std::iter::once(root).chain(parts).map(str::to_owned).collect()
}

struct Modules<'a> {
    /// The file of every module.
    files: BTreeMap<Vec<String>, &'a str>,
    /// What every file hands on by `pub use`.
    handed_on: BTreeMap<&'a str, Vec<Vec<String>>>,
}

impl Modules<'_> {
    /// The module and the item that a path means in a file.
    fn absolute(&self, file: &str, path: &[String]) -> Option<Vec<String>> {
        let mut at = module(file);
        let child: Vec<String> = at.iter().chain(path.first()).cloned().collect();
        let mut rest = path;
        match path.first()?.as_str() {
            _ if self.files.contains_key(&child) => {}
            "crate" => {
                at.truncate(1);
                rest = &rest[1..];
            }
            "pbrdf" => {
                at = vec!["core/src".to_owned()];
                rest = &rest[1..];
            }
            "super" | "self" => {
                while let Some(word @ ("super" | "self")) = rest.first().map(String::as_str) {
                    if word == "super" {
                        at.pop();
                    }
                    rest = &rest[1..];
                }
            }
            _ => return None,
        }
        Some(at.into_iter().chain(rest.iter().cloned()).collect())
    }

    /// The file that defines what an absolute path means.
    fn file_of(&self, path: &[String], depth: usize) -> Option<&str> {
        let length = (1..=path.len()).rev().find(|&length| self.files.contains_key(&path[..length]))?;
        let file = self.files[&path[..length]];
        let Some(name) = path.get(length).filter(|_| depth < 8) else { return Some(file) };
        let handed_on = self.handed_on.get(file).into_iter().flatten();
        let mut sources = handed_on.filter(|path| path.last() == Some(name)).filter_map(|path| self.absolute(file, path));
        match sources.find(|source| source.as_slice() != path) {
            Some(source) => self.file_of(&source, depth + 1),
            None => Some(file),
        }
    }
}

/// Which files every file imports from.
fn imports(sources: &Sources) -> BTreeMap<String, BTreeSet<String>> {
    let named: BTreeMap<&str, Vec<Named>> = sources.iter().map(|(file, tokens)| (file.as_str(), named(tokens))).collect();
    // The face of a folder hands on what its files define, and defines nothing that they could import.
    let is_face = |file: &str| (file.ends_with("/mod.rs") || file.ends_with("/lib.rs")) && !sources[file].iter().any(|token| token == "fn");
    let public = |paths: &[Named]| paths.iter().filter(|named| named.is_public).map(|named| named.path.clone()).collect();
    let modules = Modules {
        files: sources.keys().filter(|file| *file != "src/main.rs").map(|file| (module(file), file.as_str())).collect(),
        handed_on: named.iter().map(|(file, paths)| (*file, public(paths))).collect(),
    };
    let mut imports = BTreeMap::new();
    for (file, paths) in &named {
        let own = paths.iter().filter(|named| !(named.is_public && is_face(file)));
        let absolute = own.filter_map(|named| modules.absolute(file, &named.path));
        let targets: BTreeSet<String> = absolute.filter_map(|path| modules.file_of(&path, 0).map(str::to_owned)).collect();
        imports.insert((*file).to_owned(), targets.into_iter().filter(|target| target != file).collect());
    }
    imports
}

/// Groups of files of which each reaches each other.
fn circles(imports: &BTreeMap<String, BTreeSet<String>>) -> BTreeSet<BTreeSet<String>> {
    let reach: BTreeMap<&String, BTreeSet<&String>> = imports.keys().map(|file| (file, reached(imports, file))).collect();
    let circle = |file: &String| -> BTreeSet<String> {
        reach[file]
            .iter()
            .filter(|other| reach.get(**other).is_some_and(|back| back.contains(file)))
            .map(|other| (*other).clone())
            .collect()
    };
    imports.keys().map(circle).filter(|circle| circle.len() > 1).collect()
}

/// All files that a file imports, and those that they import.
fn reached<'a>(imports: &'a BTreeMap<String, BTreeSet<String>>, from: &String) -> BTreeSet<&'a String> {
    let mut seen: BTreeSet<&String> = imports[from].iter().collect();
    let mut open: Vec<&String> = seen.iter().copied().collect();
    while let Some(file) = open.pop() {
        open.extend(imports.get(file).into_iter().flatten().filter(|next| seen.insert(*next)));
    }
    seen
}

/// The innermost folder that holds all of them.
fn common_folder(files: &BTreeSet<String>) -> String {
    let mut folder = files.first().map_or("", |file| file.rsplit_once('/').map_or("", |(folder, _)| folder));
    while !files.iter().all(|file| file.starts_with(&format!("{folder}/"))) {
        folder = folder.rsplit_once('/').map_or("", |(parent, _)| parent);
    }
    folder.to_owned()
}

#[test]
fn paths_are_read_as_the_compiler_reads_them() {
    let text = "use crate::a::{self, b as c, d::{E, F}}; // use crate::no::No;\npub(crate) use x::Y;\nfn f() { super::g::<u8>(\"crate::no\", 'a', '\\''); }";
    let paths: Vec<(String, bool)> = named(&tokens(text)).into_iter().map(|named| (named.path.join("::"), named.is_public)).collect();
    let expected = ["crate::a::self", "crate::a::b", "crate::a::d::E", "crate::a::d::F", "x::Y", "super::g"];
    assert_eq!(paths.iter().map(|(path, _)| path.as_str()).collect::<Vec<_>>(), expected);
    assert_eq!(paths.iter().filter(|(_, is_public)| *is_public).count(), 1);
}
