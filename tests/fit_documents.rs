//! Reports and figures of fits as files, by process.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]
#![cfg(feature = "cli")]

mod common;

use common::repository_file;
use roxmltree::Document;
use std::path::Path;
use std::process::{Command, Output};

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pbrdf-explorer")).args(arguments).output().expect("the program was built beside this test")
}

fn fit(arguments: &[&str]) {
    let output = run(&[&["fit", "--starts", "1"], arguments].concat());
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}

fn steel() -> String {
    repository_file("assets/examples/steel45_simulated.csv").display().to_string()
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).expect("a file that the program wrote")
}

#[test]
fn an_html_report_is_whole_in_one_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("report.html");
    fit(&[&steel(), "--report", path.to_str().expect("a path of letters")]);
    let html = read(&path);
    let body = Document::parse(&html[html.find("<body>").expect("a body")..html.find("</html>").expect("an end")]).expect("well-formed");
    let words: String = body.descendants().filter_map(|node| node.text().filter(|_| node.is_text())).collect::<Vec<_>>().join("\n");
    for part in [
        "steel45_simulated.csv",
        "27",
        "SHA-256",
        "Cauchy facets",
        "Acta Opt. Sin.",
        "σ_v",
        "ΔE",
        "Eq. (17)",
        "pbrdf-explorer 0.1.0",
        "AICc",
    ] {
        assert!(words.contains(part), "{part} is missing");
    }
    assert!(words.contains("The volume term depends on the angle of view alone: it cannot be reciprocal."));
    // Metadata of the file are provenance.
    assert!(words.contains("simulated") && words.contains("seed"));
    // The paper's own angles do not pin n down.
    assert!(words.contains("not determined"));
    let headings: Vec<&str> = body.descendants().filter(|node| node.has_tag_name("h2")).filter_map(|node| node.text()).collect();
    for heading in ["Figures", "Parameters", "What the data leave open", "Data", "Model and choices", "Goodness of fit", "Audit"] {
        assert!(headings.contains(&heading), "{heading} is missing among {headings:?}");
    }
    assert_eq!(body.descendants().filter(|node| node.tag_name().name() == "svg").count(), 2);
    assert!(!["src=", "href=", "url(", "<script", "@import"].iter().any(|outside| html.contains(outside)), "it needs nothing else");
    assert_eq!(std::fs::read_dir(folder.path()).expect("the folder").count(), 1);
}

#[test]
fn the_hash_is_that_of_the_bytes() {
    let folder = tempfile::tempdir().expect("a folder");
    let data = folder.path().join("abc <b> & co.csv");
    let table = "# material: <img src=x onerror=alert(1)> & \"steel\"\ntheta_i,theta_r,dolp\n30,30,0.05\n40,40,0.1\n50,50,0.2\n";
    std::fs::write(&data, table).expect("a writable folder");
    let report = folder.path().join("r.html");
    fit(&[data.to_str().expect("letters"), "--model", "fresnel", "--report", report.to_str().expect("letters")]);
    let html = read(&report);
    // sha256sum of that table.
    assert!(html.contains("3693872ff17baed1b85e54282100c3b735e114d729becf5b33d852fb3200dba7"), "{html}");
    assert!(html.contains("&lt;img src=x onerror=alert(1)&gt; &amp; &quot;steel&quot;") && !html.contains("<img"));
    assert!(html.contains("Fit of abc &lt;b&gt; &amp; co.csv"));
}

#[test]
fn a_markdown_report_has_its_figures_beside_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("my report.md");
    fit(&[&steel(), "--report", path.to_str().expect("letters")]);
    let markdown = read(&path);
    assert!(markdown.starts_with("# Fit of steel45\\_simulated.csv\n"));
    for name in ["my report-dolp.svg", "my report-brdf.svg"] {
        assert!(markdown.contains(&format!("](<{name}>)")), "{name}");
        Document::parse(&read(&folder.path().join(name))).expect("well-formed");
    }
}

#[test]
fn an_undetermined_fit_says_so_in_words() {
    let folder = tempfile::tempdir().expect("a folder");
    let data = folder.path().join("few.csv");
    std::fs::write(&data, "theta_i,theta_r,dolp,masked\n30,30,0.05,0\n40,40,0.1,0\n50,50,0.2,1\n").expect("a writable folder");
    let report = folder.path().join("r.html");
    fit(&[data.to_str().expect("letters"), "--report", report.to_str().expect("letters")]);
    let html = read(&report);
    assert!(html.contains("one choice among many") && html.contains("not determined"));
    assert!(html.contains("2 of 3 rows") && html.contains("3, 1 of them masked"));
}

#[test]
fn figures_are_svg_or_png_by_their_names() {
    let folder = tempfile::tempdir().expect("a folder");
    let svg = folder.path().join("f.svg");
    fit(&[&steel(), "--figure", svg.to_str().expect("letters")]);
    let text = read(&svg);
    let document = Document::parse(&text).expect("well-formed");
    let labels: Vec<&str> = document.descendants().filter_map(|node| node.attribute("aria-label")).collect();
    for label in ["θi = 30°", "θi = 40°", "θi = 50°", "Fresnel limit", "θr / °", "DoLP", "model − measured"] {
        assert!(labels.contains(&label), "{label} is missing among {labels:?}");
    }
    let png = folder.path().join("f.PNG");
    fit(&[&steel(), "--figure", png.to_str().expect("letters")]);
    let bytes = std::fs::read(&png).expect("a picture");
    let reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().expect("a PNG");
    // 160 mm × 130 mm at 300 dots an inch.
    assert_eq!(reader.info().size(), (1890, 1535));
}

#[test]
fn other_names_are_refused_before_the_fit() {
    for (option, name, expected) in [("--figure", "f.pdf", ".svg or .png"), ("--report", "r", ".html or .md")] {
        let output = run(&["fit", &steel(), option, name]);
        let sentence = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2));
        assert!(output.stdout.is_empty() && sentence.contains(expected) && sentence.contains(name), "{sentence}");
    }
}

#[test]
fn a_report_that_cannot_be_written_is_exit_code_one() {
    let output = run(&["fit", &steel(), "--starts", "1", "--report", "/nowhere/at/all/r.html"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("/nowhere/at/all/r.html"));
}
