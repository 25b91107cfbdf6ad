//! The program's own sources, searched for the texts that they say.

use std::path::Path;

/// The sources of a folder with their paths, without the command line and tests.
pub fn sources(folder: &str) -> Vec<(String, String)> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut all = Vec::new();
    for entry in std::fs::read_dir(here.join(folder)).expect("a folder of sources") {
        let name = entry.expect("an entry").file_name().to_string_lossy().into_owned();
        let path = format!("{folder}/{name}");
        if name == "cli" || name == "tests" {
            continue;
        } else if name.ends_with(".rs") {
            let source = std::fs::read_to_string(here.join(&path)).expect("a source file");
            // What tests say nobody reads.
            all.push((path, source.split("mod tests {").next().unwrap_or_default().to_owned()));
        } else {
            all.extend(sources(&path));
        }
    }
    all
}

/// The literal at the beginning of a piece of source, as it is at run time.
pub fn literal(source: &str) -> Option<String> {
    let mut text = String::new();
    let mut letters = source.trim_start().strip_prefix('"')?.chars();
    while let Some(letter) = letters.next() {
        match letter {
            '"' => return Some(text),
            '\\' => match letters.next()? {
                'n' => text.push('\n'),
                // A line that goes on: blanks at the beginning of the next one do not count.
                '\n' => letters = letters.as_str().trim_start().chars(),
                other => text.push(other),
            },
            other => text.push(other),
        }
    }
    None
}

/// Literals right behind those words, where these are no end of a longer word.
pub fn literals_after(source: &str, words: &str) -> Vec<String> {
    let is_whole = |at: usize| !source[..at].ends_with(|before: char| before.is_alphanumeric() || before == '_');
    source.match_indices(words).filter(|(at, _)| is_whole(*at)).filter_map(|(at, _)| literal(&source[at + words.len()..])).collect()
}
