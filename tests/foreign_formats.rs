//! The program by process: metals, import, export.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]
#![cfg(feature = "cli")]

mod common;

use common::program::{Folder, answer, refusal, run, text};
use serde_json::Value;

#[test]
fn metals_lists_names_sources_and_values() {
    let table = answer(&["metals"]);
    for name in ["Cu", "stainless-steel", "brass", "refractiveindex.info"] {
        assert!(table.contains(name), "{name}");
    }
    let at = answer(&["metals", "--wavelength", "100"]);
    assert!(at.contains("outside the tabulated range"));
    let copper = answer(&["metals", "copper", "--wavelength", "650"]);
    // The value that the database's page of Hagemann gives at 650 nm.
    assert!(copper.contains("n = 0.2184  k = 3.6370") && copper.contains("Phys. Rev. B 6, 4370"), "{copper}");
    let json: Value = serde_json::from_str(&answer(&["metals", "Ag", "--wavelength", "250", "--json"])).expect("JSON");
    assert_eq!(json["wavelength_nm"].as_f64(), Some(250.0));
    let rows = json["rows"].as_array().expect("rows");
    let row = |source: &str| rows.iter().find(|row| row["source"] == source).expect("a source of silver");
    assert!(row("Johnson")["n"].is_f64() && row("Jiang")["n"].is_null() && row("Jiang")["from_nm"].as_f64() == Some(300.0));
    for (arguments, expected) in [
        (vec!["metals", "unobtainium"], "not among the tabulated metals"),
        (vec!["metals", "Al", "--wavelength", "100"], "No source of aluminium has 100 nm"),
        (vec!["metals", "Al", "--wavelength", "100", "--json"], "No source of aluminium has 100 nm"),
        (vec!["metals", "--wavelength", "0"], "not above 0"),
    ] {
        let message = refusal(&arguments);
        assert!(message.contains(expected), "{arguments:?}: {message}");
    }
}

#[test]
fn import_turns_woollam_text_into_specular_dolp() {
    let folder = Folder::new();
    let rows = "649.5\t55\t43.2138\t160.0\t0.004678\t0.0063\r\n651\t55\t43.1\t160.1\t0.004678\t0.0063\r\n";
    let file = folder.file("vase.dat", format!("A film\r\nVASEmethod[X=1]\r\nnm\r\n{rows}dpolE\t649.5\t55\t-0.1\t1\r\n"));
    let output = folder.path("out.csv");
    let run = run(&["import", &file, "--wavelength", "650", "-o", &output.display().to_string()]);
    let said = text(&run.stderr);
    assert_eq!((run.status.code(), said.contains("the nearest was taken, 649.5 nm")), (Some(0), true), "{said}");
    assert!(said.contains("dpolE"));
    let written = std::fs::read_to_string(&output).expect("the import wrote it");
    for part in ["# sample: A film\n", "# wavelength_nm: 649.5\n", "# depolarisation: -0.1 % at 55 degrees", "# imported_from: vase.dat\n"]
    {
        assert!(written.contains(part), "{part}: {written}");
    }
    // |cos 2ψ| and 2 |sin 2ψ| σψ, by hand.
    assert!(written.contains("\n55,55,180,6.2309") && written.contains(",0.00016297570356"), "{written}");
    answer(&["fit", &output.display().to_string(), "--model", "fresnel"]);
    let damaged = folder.file("damaged.dat", format!("A film\nnm\n{rows}651\t60\t143.1\t160.1\n"));
    for (arguments, expected) in [
        (vec!["import", &file], "vase.dat: the file has 2 wavelengths, 649.5, 651 nm; one has to be chosen with --wavelength"),
        (vec!["import", &file, "--wavelength", "700"], "vase.dat: 700 nm is outside"),
        (vec!["import", &damaged, "--wavelength", "650"], "damaged.dat: line 5, column 3 (psi): found \"143.1\""),
    ] {
        let message = refusal(&arguments);
        assert!(message.contains(expected), "{arguments:?}: {message}");
    }
}
