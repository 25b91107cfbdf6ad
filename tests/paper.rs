//! The commands of the book that make the paper's figure and tables make what stands there.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]
#![cfg(all(unix, feature = "cli"))]

mod common;

use common::repository_file;
use std::path::Path;
use std::process::Command;

#[test]
fn the_papers_figure_and_tables_are_what_their_commands_make() {
    let section = std::fs::read_to_string(repository_file("docs/paper.md")).expect("the chapter");
    let blocks = section.split("```sh\n").skip(1).map(|rest| rest.split("```").next().expect("an end"));
    let blocks: Vec<&str> = blocks.filter(|block| block.contains("--table markdown")).collect();
    assert_eq!(blocks.len(), 2, "one for each table");
    let folder = tempfile::tempdir().expect("a folder");
    let program = Path::new(env!("CARGO_BIN_EXE_pbrdf-explorer")).parent().expect("a folder");
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap_or_default());
    for block in blocks {
        let shell = Command::new("sh").args(["-euc", block]).env("PATH", &path).current_dir(folder.path()).output().expect("a shell");
        assert!(shell.status.success(), "{block}: {}", String::from_utf8_lossy(&shell.stderr));
        let table = String::from_utf8(shell.stdout).expect("UTF-8");
        assert!(table.starts_with("|  | ") && section.contains(table.trim()), "not in docs/paper.md:\n{table}");
    }
    let made = std::fs::read_to_string(folder.path().join("figure5.svg")).expect("the figure");
    let shown = std::fs::read_to_string(repository_file("docs/figure5.svg")).expect("the figure of the chapter");
    assert!(made == shown, "docs/figure5.svg is not what the command of docs/paper.md makes");
}
