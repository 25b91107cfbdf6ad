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
    assert!(written.contains("\n55,55,180,0.062309") && written.contains(",0.00016297570356"), "{written}");
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

#[test]
fn import_offers_a_guess_for_a_foreign_table_and_applies_only_what_is_chosen() {
    let folder = Folder::new();
    let file = folder.file("lab.csv", "AOI (deg),View angle,DoLP %\n30,-20,12.5\n");
    let message = refusal(&["import", &file]);
    assert!(
        message.contains("column 1 (AOI (deg)): theta_i in degrees")
            && message.contains("column 3 (DoLP %): dolp in percent")
            && message.contains("--auto"),
        "{message}"
    );
    let out = answer(&["import", &file, "--columns", "theta_i=AOI (deg),theta_r=2,dolp=3:percent"]);
    assert!(out.contains("\n30,20,0,0.125") && out.contains("# imported_from: lab.csv\n"), "{out}");
    let single = folder.file("single.csv", "# angle of incidence: 45 deg\n# by JL\nview,dolp,sd\n20,0.125,0.01\n");
    let message = refusal(&["import", &single]);
    assert!(message.contains("--auto"), "{message}");
    let out = answer(&["import", &single, "--columns", "theta_r=1,dolp=2", "--theta-i", "45", "--dphi", "90"]);
    assert!(out.contains("\n45,20,90,0.125") && out.contains("# comment: by JL\n"), "{out}");
    for (arguments, expected) in [
        (vec!["import", &file, "--columns", "theta_i=AOI,theta_r=2,dolp=3"], "lab.csv: line 1: there is no column \"AOI\""),
        (vec!["import", &file, "--columns", "theta=1"], "\"theta\" is no field"),
        (vec!["import", &single, "--columns", "theta_r=1,dolp=2", "--theta-i", "40,45"], "--theta-i has to be one angle"),
        (vec!["import", "no/such.dat"], "there is no such file"),
    ] {
        let message = refusal(&arguments);
        assert!(message.contains(expected), "{arguments:?}: {message}");
    }
}

#[test]
fn an_exported_surface_can_be_imported_again() {
    let folder = Folder::new();
    let path = folder.path("steel.pbsdf").display().to_string();
    let surface = "n=2.07,k=2.9,sigma=0.3,kd=0.12,kv=0.2";
    let export =
        ["export", "mitsuba", "--model", "gauss", "--set", surface, "--wavelength", "546", "--resolution", "37,31,32", "-o", &path];
    assert_eq!(answer(&export), "");
    let out = answer(&["import", &path, "--theta-i", "40", "--theta-r=-30:30:30", "--dphi", "180"]);
    assert!(out.contains("# wavelength_nm: 546\n"), "{out}");
    let rows: Vec<Vec<f64>> = out
        .lines()
        .filter(|line| line.starts_with("40,"))
        .map(|line| line.split(',').map(|cell| cell.parse().expect("a number")).collect())
        .collect();
    let dphis: Vec<f64> = rows.iter().map(|row| row[2]).collect();
    assert_eq!(dphis, [0.0, 180.0, 180.0]);
    assert!(answer(&["import", &path, "--theta-i", "40", "--theta-r", "30", "--dphi", "90"]).contains("\n40,30,90,"));

    let whole = std::fs::read(&path).expect("the export wrote it");
    let cut = folder.file("cut.pbsdf", &whole[..whole.len() / 2]);
    let mut huge = whole.clone();
    // The number of values of the first field, which the header holds as eight bytes.
    huge[18 + 2 + 5 + 2 + 1 + 8 + 8..][..8].fill(0xff);
    let huge = folder.file("huge.pbsdf", &huge);
    let data = whole.len() - 37 * 31 * 32 * 64;
    let mut nothing = whole.clone();
    nothing[data..].chunks_exact_mut(4).for_each(|number| number.copy_from_slice(&f32::NAN.to_le_bytes()));
    let nothing = folder.file("nothing.pbsdf", &nothing);
    let nowhere = folder.path("no/such/folder/x.pbsdf").display().to_string();
    for (arguments, expected) in [
        (vec!["import", &cut], "cut.pbsdf: byte "),
        (vec!["import", &huge], "field phi_d: the file ends early"),
        (vec!["import", &nothing], "nothing.pbsdf: none of the geometries has a value"),
        (vec!["import", &path, "--wavelength", "650"], "650 nm is outside what the file has: 546 nm"),
        (vec!["export", "mitsuba", "--model", "fresnel", "-o", &path], "predicts DoLP only"),
        (vec!["export", "mitsuba", "--set", "n=-1", "-o", &path], "not allowed"),
        (vec!["export", "mitsuba", "--resolution", "2,2", "-o", &path], "three whole numbers"),
        (vec!["export", "mitsuba", "--resolution", "2000,2000,2000", "-o", &path], "more than 32000000 matrices"),
        (vec!["export", "mitsuba"], "--output"),
    ] {
        let message = refusal(&arguments);
        assert!(message.contains(expected), "{arguments:?}: {message}");
    }
    assert_eq!(std::fs::read(&path).expect("it stays"), whole);
    assert_eq!(run(&["export", "mitsuba", "-o", &nowhere]).status.code(), Some(1));
}
