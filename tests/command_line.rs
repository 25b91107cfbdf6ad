//! The program by process: commands, exit codes, sentences, JSON.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]
#![cfg(feature = "cli")]

mod common;

use common::program::{Folder, answer, refusal, run, text};
use common::repository_file;
use pbrdf::selftest::{golden, relative_error};
use serde_json::Value;
use std::path::Path;
use std::process::Command;

fn example(name: &str) -> String {
    repository_file(&format!("assets/examples/{name}")).display().to_string()
}

#[test]
fn evaluate_gives_the_golden_values_row_by_row() {
    let table = repository_file("core/assets/reference/golden.csv").display().to_string();
    let out = answer(&["evaluate", &table, "--mueller", "--gradient"]);
    let mut lines = out.lines();
    let header: Vec<&str> = lines.next().expect("a header").split(',').collect();
    assert_eq!(header[..6], ["brdf", "dolp", "specular", "diffuse", "volume", "m00"]);
    assert_eq!((header.len(), header[20], header[21], header[38]), (39, "m33", "dbrdf_dn", "ddolp_dsigma_v"));
    let reference = golden();
    let rows: Vec<Vec<f64>> = lines.map(|line| line.split(',').map(|cell| cell.parse().expect("a number")).collect()).collect();
    assert_eq!(rows.len(), reference.len());
    for (row, reference) in rows.iter().zip(&reference) {
        // The bar of golden.rs, at the critical angle included.
        assert!(relative_error(row[0], reference.brdf) <= 1e-13, "{reference:?}");
        assert!(row.iter().all(|number| !number.is_nan()));
    }
}

#[test]
fn evaluate_writes_nothing_before_all_rows_are_right() {
    let folder = Folder::new();
    let head = "distribution,n,k,sigma,ks,kd,kv,q,c,sigma_v,theta_i,theta_r,dphi\n";
    let good = "gauss,2,3,0.3,1,0.1,0.1,,-0.5,0.5,30,30,180\n";
    for (row, place) in [
        ("gaus,2,3,0.3,1,0.1,0.1,2,-0.5,0.5,30,30,180", "line 3, column 1 (distribution)"),
        ("gauss,0,0,0.3,1,0.1,0.1,2,-0.5,0.5,30,30,180", "line 3, column 2 (n)"),
        ("gauss,2,3,0,1,0.1,0.1,2,-0.5,0.5,30,30,180", "line 3, column 4 (sigma)"),
        ("cauchy,2,3,0.3,1,0.1,0.1,1,-0.5,0.5,30,30,180", "line 3, column 8 (q)"),
        ("gauss,2,3,0.3,1,0.1,0.1,2,-0.5,0.5,90,30,180", "line 3, column 11 (theta_i)"),
        ("gauss,2,3,0.3,1,0.1,0.1,2,-0.5,0.5,30,-1,180", "line 3, column 12 (theta_r)"),
        ("gauss,2,3,x,1,0.1,0.1,2,-0.5,0.5,30,30,180", "line 3, column 4 (sigma)"),
    ] {
        let input = folder.file("in.csv", format!("{head}{good}{row}\n"));
        let output = folder.path("out.csv");
        let message = refusal(&["evaluate", &input, "-o", &output.display().to_string()]);
        assert!(message.contains("in.csv") && message.contains(place), "{message}");
        assert!(!output.exists());
    }
    let without_dphi = "distribution,n,k,sigma,ks,kd,kv,c,sigma_v,theta_i,theta_r\ngauss,2,3,0.3,1,0.1,0.1,-0.5,0.5,30,30\n";
    assert_eq!(
        answer(&["evaluate", &folder.file("in.csv", without_dphi)]),
        answer(&["evaluate", &folder.file("in.csv", format!("{head}{good}"))])
    );
}

#[test]
fn simulate_gives_the_same_bytes_and_says_what_it_is() {
    let folder = Folder::new();
    let arguments = |path: &Path| -> Vec<String> {
        let words = "simulate --model gauss --set n=1.5,k=4 --theta-i 30,40 --theta-r -20:60:20 --noise 0.01 --columns both --brdf-noise 0.1 --seed 3 -o";
        words.split(' ').map(str::to_owned).chain([path.display().to_string()]).collect()
    };
    let mut bytes = Vec::new();
    for name in ["a.csv", "b.csv"] {
        let path = folder.path(name);
        let arguments = arguments(&path);
        answer(&arguments.iter().map(String::as_str).collect::<Vec<_>>());
        bytes.push(std::fs::read_to_string(path).expect("the simulation wrote it"));
    }
    assert_eq!(bytes[0], bytes[1]);
    for line in [
        "# simulated: true\n",
        "# command: pbrdf-explorer simulate --model gauss",
        "# model: gauss\n",
        "# n: 1.5\n",
        "# seed: 3\n",
        "dolp_sigma",
        "brdf_sigma",
    ] {
        assert!(bytes[0].contains(line), "{line}");
    }
    assert_eq!(bytes[0].lines().filter(|line| !line.starts_with('#')).count(), 11);
}

#[test]
fn the_examples_are_what_their_own_command_makes() {
    for name in ["steel45_simulated.csv", "copper_650nm_simulated.csv", "aluminium_650nm_simulated.csv"] {
        let expected = std::fs::read_to_string(repository_file(&format!("assets/examples/{name}"))).expect("a bundled example");
        let command = expected.lines().find_map(|line| line.strip_prefix("# command: pbrdf-explorer ")).expect("the command that made it");
        let folder = Folder::new();
        let path = folder.path(name).display().to_string();
        let arguments: Vec<&str> = command.split(' ').chain(["-o", path.as_str()]).collect();
        answer(&arguments);
        assert_eq!(std::fs::read_to_string(path).expect("the simulation wrote it"), expected, "{name}");
    }
}

#[test]
fn fit_prints_the_agreed_json() {
    let out = answer(&["fit", &example("aluminium_650nm_simulated.csv"), "--json"]);
    let json: Value = serde_json::from_str(&out).expect("JSON");
    for key in [
        "model",
        "distribution",
        "objective",
        "sum_of_squares",
        "chi2",
        "dof",
        "aicc",
        "stop_reason",
        "evaluations",
        "elapsed_ms",
        "parameters",
        "undetermined",
        "correlations",
        "starts",
        "trace",
    ] {
        assert!(json.get(key).is_some(), "{key}");
    }
    assert_eq!((&json["model"], &json["distribution"], &json["stop_reason"]), (&"cauchy".into(), &"cauchy".into(), &"converged".into()));
    assert!(json["chi2"].is_null());
    let ks = &json["parameters"]["ks"];
    assert_eq!((ks["free"].as_bool(), ks["at_bound"].is_null()), (Some(true), true));
    // The simulation's truth is 1; five standard errors.
    let (value, error) = (ks["value"].as_f64().expect("a value"), ks["std_error"].as_f64().expect("an error"));
    assert!((value - 1.0).abs() < 5.0 * error);
    let names = json["correlations"]["names"].as_array().expect("names").len();
    assert_eq!((names, json["correlations"]["matrix"].as_array().map(Vec::len)), (9, Some(9)));
    assert_eq!(json["starts"][0]["objective"], json["objective"]);
    assert!(json["trace"].as_array().is_some_and(|trace| trace.iter().all(|point| point["evaluations"].is_u64())));
}

#[test]
fn fit_heeds_start_fix_free_and_bounds() {
    let steel = example("steel45_simulated.csv");
    let fit = |more: &[&str]| -> Value {
        let arguments: Vec<&str> = ["fit", &steel, "--json"].into_iter().chain(more.iter().copied()).collect();
        serde_json::from_str(&answer(&arguments)).expect("JSON")
    };
    let fixed = fit(&["--fix", "c,q=2.2,sigma=0.35", "--start", "c=-0.4,n=2.5", "--bounds", "n=2.3..3"]);
    assert_eq!((fixed["parameters"]["c"]["value"].as_f64(), fixed["parameters"]["c"]["free"].as_bool()), (Some(-0.4), Some(false)));
    assert_eq!(fixed["parameters"]["sigma"]["value"].as_f64(), Some(0.35));
    let n = fixed["parameters"]["n"]["value"].as_f64().expect("a value");
    assert!((2.3..=3.0).contains(&n));
    assert_eq!(fixed["parameters"]["ks"]["free"].as_bool(), Some(false));
    let freed = fit(&["--free", "ks"]);
    assert_eq!((freed["parameters"]["ks"]["free"].as_bool(), &freed["stop_reason"]), (Some(true), &"underdetermined".into()));
    assert!(freed["parameters"]["ks"]["std_error"].is_null());
    assert!(freed["undetermined"][0]["direction"].get("ks").is_some());
}

#[test]
fn fitted_columns_stand_beside_the_input() {
    let folder = Folder::new();
    let input = folder.file("in.csv", "# a: b\ntheta_i;dolp;theta_r;mine\n55;0,0623;55;x\n65;0,0976;65;y\n75;0,1484;75;z\n");
    let output = folder.path("out.csv").display().to_string();
    answer(&["fit", &input, "--model", "fresnel", "-o", &output]);
    let written = std::fs::read_to_string(output).expect("the fit wrote it");
    let lines: Vec<&str> = written.lines().collect();
    assert_eq!((lines[0], lines[1]), ("# a: b", "theta_i;dolp;theta_r;mine;dolp_model;dolp_residual;brdf_model;brdf_residual"));
    let cells: Vec<&str> = lines[2].split(';').collect();
    assert_eq!(cells[..4], ["55", "0,0623", "55", "x"]);
    let (model, residual): (f64, f64) = (cells[4].parse().expect("a number"), cells[5].parse().expect("a number"));
    assert_eq!(model - 0.0623, residual);
}

#[test]
fn bad_usage_and_input_end_with_two_and_a_sentence() {
    let folder = Folder::new();
    let bad = folder.file("bad.csv", "theta_i,theta_r,dolp\n30,20,x\n");
    let steel = example("steel45_simulated.csv");
    let missing = folder.path("none.csv").display().to_string();
    let a_folder = folder.0.path().display().to_string();
    for (arguments, expected) in [
        (vec!["fit", &bad], "bad.csv: line 2, column 3 (dolp): found \"x\""),
        (vec!["fit", &bad, "--json"], "bad.csv: line 2, column 3 (dolp)"),
        (vec!["fit", &missing], "none.csv: there is no such file"),
        (vec!["evaluate", &a_folder], "directory"),
        (vec!["fit", &steel, "--fix", "m"], "\"m\" is no parameter"),
        (vec!["fit", &steel, "--start", "n=-1"], "not allowed"),
        (vec!["fit", &steel, "--bounds", "n=5..2"], "must be below"),
        (vec!["fit", &steel, "--start", "n=12"], "outside its bounds"),
        (vec!["fit", &steel, "--model", "phong"], "expected one of"),
        (vec!["fit", &steel, "--weights", "tons"], "tons"),
        (vec!["simulate", "--theta-i", "95", "--theta-r", "0", "-o", &missing], "theta_i = 95"),
        (vec!["no.csv"], "No display is available"),
        (vec![], "pbrdf-explorer"),
    ] {
        if cfg!(feature = "gui") || !expected.contains("display") {
            let message = refusal(&arguments);
            assert!(message.contains(expected), "{arguments:?}: {message}");
        }
    }
}

#[test]
fn what_is_said_of_a_parameter_that_the_model_lacks_is_ignored_with_a_notice() {
    let folder = Folder::new();
    let path = folder.path("out.csv").display().to_string();
    let steel = example("steel45_simulated.csv");
    for arguments in [
        vec!["simulate", "--model", "gauss", "--set", "q=3", "--theta-i", "30", "--theta-r", "30", "-o", &path],
        vec!["fit", &steel, "--model", "gauss", "--fix", "q=2", "--starts", "1"],
        vec!["plan", "--model", "gauss", "--fix", "q", "--theta-i", "30", "--theta-r", "0:80:5"],
    ] {
        let output = run(&arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}");
        assert!(text(&output.stderr).contains("has no parameter q"), "{arguments:?}");
    }
}

#[test]
fn output_that_cannot_be_written_ends_with_one() {
    let folder = Folder::new();
    let nowhere = folder.path("no/such/folder/out.csv").display().to_string();
    let output = run(&["simulate", "--theta-i", "30", "--theta-r", "30", "-o", &nowhere]);
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains("could not be written"));
}

#[test]
fn compare_lists_the_ladder_and_skips_what_cannot_predict() {
    let out = answer(&["compare", &example("copper_650nm_simulated.csv"), "--models", "fresnel,lambert,gauss,cauchy", "--json"]);
    let json: Value = serde_json::from_str(&out).expect("JSON");
    let fits = json["fits"].as_array().expect("fits");
    let models: Vec<&str> = fits.iter().filter_map(|fit| fit["model"].as_str()).collect();
    assert_eq!(models, ["fresnel", "lambert", "gauss", "cauchy"]);
    let objective = |i: usize| fits[i]["objective"].as_f64().expect("an objective");
    // Each is a special case of the next but one; the data are Cauchy's.
    assert!(objective(3) <= objective(2) && objective(2) <= objective(1) && objective(1) <= objective(0));
    let folder = Folder::new();
    let brdf = folder.file("brdf.csv", "theta_i,theta_r,brdf\n30,20,1\n30,30,3\n30,40,1\n");
    let json: Value = serde_json::from_str(&answer(&["compare", &brdf, "--models", "fresnel,specular", "--json"])).expect("JSON");
    assert!(json["fits"][0]["skipped"].is_string() && json["fits"][1]["objective"].is_f64());
    let table = answer(&["compare", &example("steel45_simulated.csv"), "--models", "gauss,cauchy", "--fix", "q"]);
    assert!(table.contains("truth") && table.contains("2.07"));
}

#[test]
fn plan_predicts_what_angles_determine() {
    let surface = ["--set", "n=2.07,k=2.9,sigma=0.35,kd=0.12,kv=0.2,q=2.2,c=-0.4,sigma_v=0.6", "--noise", "0.005", "--json"];
    let error = |angles: [&str; 4]| -> f64 {
        let arguments: Vec<&str> = ["plan"].into_iter().chain(surface).chain(angles).collect();
        let json: Value = serde_json::from_str(&answer(&arguments)).expect("JSON");
        assert!(json["undetermined"].as_array().is_some_and(Vec::is_empty));
        json["std_error"]["n"].as_f64().expect("n is determined")
    };
    let few = error(["--theta-i", "30,40,50", "--theta-r", "20:60:5"]);
    let many = error(["--theta-i", "10:80:10", "--theta-r", "0:85:5"]);
    // The paper's angles leave n more open than its own size; dense ones fix it to a few hundredths.
    assert!(few > 1.0 && many < 0.05, "{few} {many}");
    let json: Value = serde_json::from_str(&answer(&["plan", "--theta-i", "30", "--theta-r", "30", "--json"])).expect("JSON");
    assert!(json["std_error"]["n"].is_null() && !json["undetermined"].as_array().expect("a list").is_empty());
}

#[test]
fn profile_and_bootstrap_agree_with_the_standard_error_where_the_problem_is_nearly_linear() {
    let folder = Folder::new();
    let dense = folder.path("dense.csv").display().to_string();
    let surface = "n=2.07,k=2.9,sigma=0.35,kd=0.12,kv=0.2,q=2.2,c=-0.4,sigma_v=0.6";
    answer(&["simulate", "--set", surface, "--theta-i", "10:80:10", "--theta-r", "0:85:5", "--noise", "0.002", "-o", &dense]);
    let out = answer(&["fit", &dense, "--profile", "n", "--bootstrap", "100", "--json"]);
    let json: Value = serde_json::from_str(&out).expect("JSON");
    let error = json["parameters"]["n"]["std_error"].as_f64().expect("an error");
    let profile = &json["profile"]["n"];
    let half_width = (profile["high"].as_f64().expect("an end") - profile["low"].as_f64().expect("an end")) / 2.0;
    assert!((half_width / error - 1.0).abs() < 0.1, "{half_width} {error}");
    // A hundred replicates know their scatter to 7 %; residuals of rows that know n differ from the others.
    let scatter = json["bootstrap"]["n"]["std_error"].as_f64().expect("an error");
    assert!((0.5..2.0).contains(&(scatter / error)), "{scatter} {error}");
}

#[test]
fn the_same_seed_finds_the_same_fit_on_any_number_of_threads() {
    let steel = example("steel45_simulated.csv");
    let fit = |threads: &str| -> Value {
        let output = Command::new(env!("CARGO_BIN_EXE_pbrdf-explorer"))
            .args(["fit", &steel, "--json", "--seed", "5"])
            .env("RAYON_NUM_THREADS", threads)
            .output()
            .expect("the program was built beside this test");
        serde_json::from_slice(&output.stdout).expect("JSON")
    };
    let (one, two) = (fit("1"), fit("3"));
    for key in ["parameters", "starts", "evaluations", "objective"] {
        assert_eq!(one[key], two[key], "{key}");
    }
}
