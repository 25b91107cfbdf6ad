//! Bundled refractive indices against samples of the database that they were thinned from.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]

mod common;

use pbrdf::optics::metals;

/// What thinning was allowed to lose of n and of k, and the rounding to six digits.
fn tolerance(value: f64) -> f64 {
    (1e-3 * value).max(2e-4) + 1e-5 * value
}

#[test]
fn the_bundled_table_reproduces_random_samples_of_the_database() {
    let metals = metals().expect("the bundled table is whole");
    let samples = common::table("optical_constants_check.csv");
    let mut sources = std::collections::BTreeSet::new();
    for sample in &samples {
        let (metal, key) = sample.text("source").split_once('/').expect("metal/source");
        let source = metals.iter().find(|known| known.key == metal).and_then(|metal| metal.source(key)).expect("a bundled source");
        let index = source.index_at(sample.number("wavelength_nm")).expect("within the range");
        for (name, value) in [("n", index.n()), ("k", index.k_m())] {
            let expected = sample.number(name);
            assert!((value - expected).abs() <= tolerance(expected), "line {}: {name} = {value}", sample.line);
        }
        sources.insert(sample.text("source").to_owned());
    }
    assert_eq!(sources.len(), metals.iter().map(|metal| metal.sources.len()).sum::<usize>());
}
