//! `posterior` as its users call it: draws of one measurement and of several, and what is refused.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]
#![cfg(feature = "cli")]

mod common;

use common::program::{answer, run, text};
use common::repository_file;
use serde_json::Value;

/// Three wavelengths of one sample, simulated: n differs, all else is shared.
fn wavelengths(folder: &tempfile::TempDir) -> Vec<String> {
    let one = |(name, n): (&str, &str)| {
        let path = folder.path().join(name).display().to_string();
        let surface = format!("n={n},k=2.9");
        let angles = ["--theta-i", "20:80:20", "--theta-r", "0:80:10"];
        let noise = ["--noise", "0.005", "--model", "gauss", "-o", &path];
        answer(&[&["simulate", "--set", &surface][..], &angles, &noise].concat());
        path
    };
    [("blue.csv", "1.8"), ("red.csv", "2.4")].into_iter().map(one).collect()
}

#[test]
fn own_parameters_are_named_by_their_measurement() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let files = wavelengths(&folder);
    let draws = folder.path().join("draws.csv").display().to_string();
    let options = ["--model", "gauss", "--own", "n,k", "--draws", "300", "--chains", "2", "--json", "-o", &draws];
    let json: Value = serde_json::from_str(&answer(&[&["posterior", &files[0], &files[1]][..], &options].concat())).expect("JSON");
    let names: Vec<&str> = json["parameters"].as_object().expect("parameters").keys().map(String::as_str).collect();
    let expected = ["n@blue.csv", "k@blue.csv", "n@red.csv", "k@red.csv", "sigma", "kd", "kv", "c", "sigma_v"];
    assert!(expected.iter().all(|name| names.contains(name)) && names.len() == expected.len(), "{names:?}");
    for (name, truth) in [("n@blue.csv", 1.8), ("n@red.csv", 2.4)] {
        let of = &json["parameters"][name];
        let (mean, sd) = (of["mean"].as_f64().expect("a mean"), of["sd"].as_f64().expect("a deviation"));
        assert!((mean - truth).abs() < 4.0 * sd, "{name}: {mean} ± {sd}");
    }
    let table = std::fs::read_to_string(draws).expect("the draws");
    let mut lines = table.lines();
    assert_eq!(lines.next(), Some("n@blue.csv,k@blue.csv,n@red.csv,k@red.csv,sigma,kd,kv,c,sigma_v,log_posterior,chain"));
    assert_eq!(lines.count(), 600);
}

#[test]
fn what_cannot_be_drawn_is_refused_in_a_sentence() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let files = wavelengths(&folder);
    let steel = repository_file("assets/examples/steel45_simulated.csv").display().to_string();
    let (blue, red) = (files[0].as_str(), files[1].as_str());
    for (arguments, expected) in [
        (vec![steel.as_str(), "--draws", "10"], "are too few: at least 100 draws"),
        (vec![&steel, "--starts", "3"], "A posterior takes no --starts"),
        (vec![&steel, "--loss", "huber"], "A posterior takes no --starts and no --loss"),
        (vec![&steel, "--prior", "n=normal(40,0.1)"], "the prior of n lies outside its bounds"),
        (vec![&steel, "--prior", "n=normal(2,0)"], "the standard deviation must be above 0"),
        (vec![&steel, "--fix", "n=2", "--prior", "n=normal(2,1)"], "n is not free and has no prior"),
        (vec![&steel, "--prior", "n=normal(2,1),n=uniform(1,2)"], "n has two priors"),
        (vec![&steel, "--model", "specular", "--own", "kd"], "No measurement can have its own kd"),
        (vec![blue, red, "--own", "n", "--prior", "n@green.csv=normal(2,1)"], "No measurement is called green.csv"),
        (vec![blue, red, "--own", "k", "--prior", "n@red.csv=normal(2,1)"], "n is not free and has no prior"),
        (vec![blue, blue], "Two measurements are called"),
    ] {
        let output = run(&[&["posterior"][..], &arguments].concat());
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
        assert!(said.contains(expected), "{arguments:?}: {said}");
    }
}
