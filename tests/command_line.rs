//! The program by process: commands, exit codes, sentences, JSON.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]
#![cfg(feature = "cli")]

mod common;

use common::program::{Folder, answer, answer_to, output_to, refusal, run, text};
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
fn instructions_are_chosen_by_name_or_refused() {
    let answer = |instructions: &str| {
        let mut program = Command::new(env!("CARGO_BIN_EXE_pbrdf-explorer"));
        program.args(["metals", "--help"]).env("PBRDF_INSTRUCTIONS", instructions).output().expect("the program")
    };
    let refused = answer("fast");
    assert_eq!(refused.status.code(), Some(2));
    assert!(text(&refused.stderr).contains("PBRDF_INSTRUCTIONS: found \"fast\", expected \"portable\"."), "{refused:?}");
    // An ARM processor has no other numbers, and the program says so.
    assert_eq!(answer("portable").status.success(), !cfg!(target_arch = "aarch64"));
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
fn simulate_goes_out_of_the_plane_in_one_file() {
    let folder = Folder::new();
    let simulate = |name: &str, dphi: &str| {
        let path = folder.path(name);
        let angles = ["--theta-i", "30,40", "--theta-r", "20,50", "--dphi", dphi, "-o"];
        let words = ["simulate", "--set", "n=1.5,k=4"].into_iter().chain(angles);
        answer(&words.chain([path.to_str().expect("a path")]).collect::<Vec<_>>());
        let measurement = pbrdf::measurement::Measurement::read(std::fs::File::open(path).expect("a file")).expect("a measurement");
        measurement.rows.iter().map(|row| (row.geometry, row.dolp.expect("DoLP").value)).collect::<Vec<_>>()
    };
    let all = simulate("all.csv", "90,135:180:45");
    let [side, aslant, forward] = ["90", "135", "180"].map(|dphi| simulate("one.csv", dphi));
    // The planes of one angle of incidence stand together.
    assert_eq!(all, [&side[..2], &aslant[..2], &forward[..2], &side[2..], &aslant[2..], &forward[2..]].concat());
    assert!(side[0].1 != forward[0].1);
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
    assert_eq!(lines[0], "# a: b");
    assert!(lines[1].starts_with("# fitted_model: "), "{}", lines[1]);
    let lines: Vec<&str> = lines.into_iter().filter(|line| !line.starts_with("# fitted_")).collect();
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
        (vec!["fit", &steel, "--start", "n=2,n=3"], "--start names n twice"),
        (vec!["compare", &steel, "--start", "n=2", "--start", "k=1,n=2"], "--start names n twice"),
        (vec!["fit", &steel, "--fix", "n,n=2"], "--fix names n twice"),
        (vec!["fit", &steel, "--bounds", "n=1..2,n=1..3"], "--bounds names n twice"),
        (vec!["fit", &steel, "--fix", "n", "--free", "ks,n"], "--fix and --free both name n"),
        (vec!["posterior", &steel, "--fix", "n", "--free", "n"], "--fix and --free both name n"),
        (vec!["plan", "--fix", "n", "--free", "n", "--theta-i", "30", "--theta-r", "30"], "--fix and --free both name n"),
        (vec!["simulate", "--set", "n=2,n=3", "--theta-i", "30", "--theta-r", "0", "-o", &missing], "--set names n twice"),
        (vec!["simulate", "--theta-i", "0:89:0.001", "--theta-r", "0:89:0.001", "-o", &missing], "7921178001 rows"),
        (vec!["plan", "--theta-i", "0:89:0.001", "--theta-r", "0:89:0.001"], "7921178001"),
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
fn compare_gives_its_verdict_in_a_sentence_and_none_between_perfect_fits() {
    let folder = Folder::new();
    let two = folder.file("two.csv", "theta_i,theta_r,dolp\n40,45,0.06\n60,60,0.15\n");
    let zeros: String = (2..=6).map(|i| format!("30,{i}0,0\n45,{i}0,0\n60,{i}0,0\n")).collect();
    let zeros = folder.file("zeros.csv", format!("theta_i,theta_r,dolp\n{zeros}"));
    for data in [&two, &zeros] {
        let table = answer(&["compare", data, "--models", "gauss,cauchy"]);
        let verdict = table.lines().last().expect("a verdict");
        assert_eq!(verdict, "gauss and cauchy: Gauss and Cauchy both meet these data to the last digits: there is no winner.");
    }
    // Seed 3 of README: equal ΔE, so that the lower AICc of Gauss is the price of a parameter.
    let steel = folder.path("steel.csv").display().to_string();
    let surface = "n=2.07,k=2.9,sigma=0.67,kd=0.12,kv=0.25,q=2.2,c=-0.4,sigma_v=0.6";
    let angles = ["--theta-i", "30,40,50", "--theta-r", "20:60:5", "--noise", "0.005", "--seed", "3", "-o", &steel];
    answer(&["simulate", "--set", surface].into_iter().chain(angles).collect::<Vec<_>>());
    let table = answer(&["compare", &steel, "--models", "gauss,cauchy"]);
    let verdict = table.lines().last().expect("a verdict");
    assert!(verdict.contains("no evidence for a heavier tail") && verdict.matches('.').count() <= 3, "{verdict}");
    // The measure that it names is the one of the table.
    let delta_e = table.lines().nth(1).and_then(|line| line.split_whitespace().nth(1)).expect("ΔE of Gauss").to_owned();
    assert!(!verdict.contains("alike") || verdict.contains(&format!("ΔE {delta_e}")), "{verdict} {delta_e}");
}

#[test]
fn a_dash_is_standard_input() {
    let steel = example("steel45_simulated.csv");
    let rows = std::fs::read(&steel).expect("an example");
    let fit = |path: &str| answer_to(&["fit", path, "--model", "lambert", "--starts", "1", "--json"], &rows);
    let parameters = |json: &str| serde_json::from_str::<Value>(json).expect("JSON")["parameters"].clone();
    assert_eq!(parameters(&fit("-")), parameters(&fit(&steel)));
    assert!(answer_to(&["compare", "-", "--models", "fresnel"], &rows).contains("fresnel"));
    let wrong = output_to(&["fit", "-"], b"theta_i,theta_r,dolp\n30,20,x\n");
    assert_eq!(wrong.status.code(), Some(2));
    assert!(text(&wrong.stderr).starts_with("Standard input: line 2, column 3 (dolp): found \"x\""), "{}", text(&wrong.stderr));
}

#[test]
fn messages_quote_the_beginning_of_a_cell() {
    let folder = Folder::new();
    let long = "x".repeat(100_000);
    let head = "distribution,n,k,sigma,ks,kd,kv,q,c,sigma_v,theta_i,theta_r";
    for (command, table) in [
        ("fit", format!("theta_i,theta_r,dolp\n30,20,{long}\n")),
        ("fit", format!("theta_i,theta_r,{long}\n30,20,0.1\n")),
        ("fit", format!("theta_i,theta_r,dolp,dolp\n30,20,0.1,{long}\n")),
        ("fit", format!("{long}\n")),
        ("evaluate", format!("{head}\n{long},2,3,0.3,1,0,0,2,0,0.5,30,30\n")),
        ("evaluate", format!("{head}\ngauss,{long},3,0.3,1,0,0,2,0,0.5,30,30\n")),
        ("evaluate", format!("{head},{long}\ngauss,-1,3,0.3,1,0,0,2,0,0.5,30,30,1\n")),
    ] {
        let path = folder.file("long.csv", &table);
        let message = refusal(&[command, &path]);
        // No part of the message is longer than what may be quoted.
        let longest = message.split(|letter| letter != 'x').map(str::len).max().unwrap_or(0);
        assert!(longest <= 80, "{command}: {longest} letters of a cell in {}", &message[..200.min(message.len())]);
    }
}

/// Runs until the first line of progress, sends a signal, and gives the rest.
#[cfg(unix)]
fn interrupted(arguments: &[&str], signal: &str) -> (Option<i32>, Value) {
    use std::io::{BufRead as _, BufReader, Read as _};
    let mut program = Command::new(env!("CARGO_BIN_EXE_pbrdf-explorer"))
        .args(arguments)
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .expect("the program was built beside this test");
    let mut stderr = BufReader::new(program.stderr.take().expect("a pipe"));
    let mut line = String::new();
    stderr.read_line(&mut line).expect("a line of progress");
    let status = Command::new("kill").args([signal, &program.id().to_string()]).status().expect("kill");
    assert!(status.success());
    stderr.read_to_string(&mut line).expect("its rest");
    let output = program.wait_with_output().expect("its end");
    (output.status.code(), serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{error}: {line}")))
}

#[cfg(unix)]
#[test]
fn an_interruption_ends_the_wait_for_standard_input() {
    use std::io::Write as _;
    let mut program = Command::new(env!("CARGO_BIN_EXE_pbrdf-explorer"))
        .args(["fit", "-"])
        .stdin(std::process::Stdio::piped())
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::null())
        .spawn()
        .expect("the program was built beside this test");
    let mut stdin = program.stdin.take().expect("a pipe");
    // More than a pipe holds: when all is written, the program is reading, and no end comes.
    stdin.write_all("theta_i,theta_r,dolp\n".repeat(1 << 14).as_bytes()).expect("a reader");
    let status = Command::new("kill").args(["-INT", &program.id().to_string()]).status().expect("kill");
    assert!(status.success());
    let ended = (0..600).find_map(|_| {
        std::thread::sleep(std::time::Duration::from_millis(50));
        program.try_wait().expect("a process")
    });
    if ended.is_none() {
        program.kill().expect("a running process");
    }
    assert_eq!(ended.expect("it goes on waiting").code(), Some(130));
    drop(stdin);
}

#[cfg(unix)]
#[test]
fn an_interruption_gives_the_best_so_far_and_says_that_it_is_incomplete() {
    let steel = example("steel45_simulated.csv");
    for signal in ["-INT", "-TERM"] {
        let (code, json) = interrupted(&["fit", &steel, "--bootstrap", "1000000", "--profile", "n", "--json"], signal);
        assert_eq!((code, &json["bootstrap"]["complete"]), (Some(130), &Value::from(false)), "{signal}");
        assert!(json["bootstrap"]["replicates"].as_u64().expect("a number") < 1_000_000 && json["objective"].is_f64());
        let (code, json) = interrupted(&["compare", &steel, "--starts", "100000", "--json"], signal);
        assert_eq!((code, &json["complete"]), (Some(130), &Value::from(false)), "{signal}");
        let fits = json["fits"].as_array().expect("fits");
        assert_eq!(fits.len(), pbrdf::model::PRESETS.len());
        assert!(fits.iter().any(|fit| fit["objective"].is_f64()) && fits.iter().any(|fit| fit["skipped"].is_string()), "{json}");
    }
}

#[test]
fn a_grid_of_more_than_a_million_rows_tells_its_progress() {
    let output = run(&["plan", "--theta-i", "0:79:0.1", "--theta-r", "0:89:0.05"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(text(&output.stderr).contains("predicting: "), "{}", text(&output.stderr));
    let folder = Folder::new();
    let path = folder.path("many.csv").display().to_string();
    let output = run(&["simulate", "--theta-i", "0:79:0.1", "--theta-r", "0:89:0.05", "-o", &path]);
    assert!(text(&output.stderr).contains("writing: "), "{}", text(&output.stderr));
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
    assert_eq!((&json["bootstrap"]["replicates"], &json["bootstrap"]["complete"]), (&Value::from(100), &Value::Null));
    let scatter = json["bootstrap"]["parameters"]["n"]["std_error"].as_f64().expect("an error");
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

/// Two wavelengths of one sample, few rows.
fn two_wavelengths(folder: &Folder) -> [String; 2] {
    [("blue.csv", "n=1.6,k=2.4"), ("red.csv", "n=2.6,k=3.6")].map(|(name, set)| {
        let path = folder.path(name).display().to_string();
        answer(&[
            "simulate",
            "--model",
            "specular",
            "--set",
            set,
            "--theta-i",
            "30,50,70",
            "--theta-r",
            "20:80:20",
            "--noise",
            "0.002",
            "-o",
            &path,
        ]);
        path
    })
}

#[test]
fn several_measurements_are_fitted_with_shared_and_own_parameters() {
    let folder = Folder::new();
    let [blue, red] = two_wavelengths(&folder);
    let output = folder.path("all.csv").display().to_string();
    let fit = ["fit", &blue, &red, "--model", "specular", "--own", "n,k", "--fix", "k@red.csv=3.6"];
    let json: Value = serde_json::from_str(&answer(&[&fit[..], &["--json", "-o", &output]].concat())).expect("JSON");
    let names = |value: &Value| value.as_object().expect("an object").keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&json["parameters"]), ["ks", "q", "sigma"]);
    let sets = json["sets"].as_array().expect("a list");
    assert_eq!((sets.len(), names(&sets[1]["parameters"])), (2, vec!["k".to_owned(), "n".to_owned()]));
    assert_eq!(
        (&sets[0]["file"], &sets[0]["set"], &sets[0]["rows"]),
        (&Value::from(blue.as_str()), &Value::from("blue.csv"), &Value::from(12))
    );
    let k_of_red = &sets[1]["parameters"]["k"];
    assert_eq!((&k_of_red["value"], &k_of_red["free"]), (&Value::from(3.6), &Value::from(false)));
    assert!(json["correlations"]["names"].as_array().expect("a list").contains(&Value::from("n@red.csv")));
    let written = std::fs::read_to_string(&output).expect("the fit wrote it");
    let header = written.lines().find(|line| !line.starts_with('#')).expect("a header");
    assert_eq!(header, "set,theta_i,theta_r,dphi,dolp,dolp_sigma,dolp_model,dolp_residual,brdf_model,brdf_residual");
    // What was written is read as two measurements again.
    let again: Value = serde_json::from_str(&answer(&[&["fit", &output][..], &fit[3..], &["--json"]].concat())).expect("JSON");
    assert_eq!(again["objective"], json["objective"]);
    let table = answer(&[&fit[..], &["--table", "markdown"]].concat());
    assert!(table.starts_with("|  | blue.csv | red.csv |\n") && table.contains("held fixed"), "{table}");
}

#[test]
fn several_measurements_that_do_not_go_together_are_refused_in_a_sentence() {
    let folder = Folder::new();
    let [blue, red] = two_wavelengths(&folder);
    let absent = folder.path("absent.csv").display().to_string();
    let empty = folder.file("empty.csv", "");
    let [blue, red, absent, empty] = [&blue, &red, &absent, &empty].map(String::as_str);
    for (arguments, sentence) in [
        (vec![blue, absent, empty], "absent.csv: there is no such file."),
        (vec![blue, absent, empty], "empty.csv: "),
        (vec![blue, blue], "Two measurements are called "),
        (vec![blue, red, "--own", "q", "--model", "gauss"], "No measurement can have its own q"),
        (vec![blue, red, "--fix", "n@green.csv=2"], "No measurement is called green.csv; there are blue.csv, red.csv."),
        (vec![blue, red, "--fix", "n@red.csv=2"], "n is shared, and what is said of it for red.csv differs from the others"),
    ] {
        let message = refusal(&[&["fit"][..], &arguments].concat());
        assert!(message.contains(sentence), "{message}");
    }
}

#[test]
fn joint_fits_have_profiles_bootstrap_report_and_figure() {
    let folder = Folder::new();
    let [blue, red] = two_wavelengths(&folder);
    let [report, figure] = ["report.md", "figure.svg"].map(|name| folder.path(name).display().to_string());
    let fit = ["fit", &blue, &red, "--model", "specular", "--own", "n,k", "--json"];
    let more = ["--profile", "n", "--bootstrap", "20", "--report", &report, "--figure", &figure];
    let json: Value = serde_json::from_str(&answer(&[&fit[..], &more].concat())).expect("JSON");
    // Of an own parameter, the profile of each measurement; it is the interval of the fit.
    for (set, name) in ["n@blue.csv", "n@red.csv"].into_iter().enumerate() {
        let (profile, interval) = (&json["profile"][name], &json["sets"][set]["parameters"]["n"]["interval68"]);
        for (end, of_fit) in [("low", 0), ("high", 1)] {
            let [one, other] = [&profile[end], &interval[of_fit]].map(|end| end.as_f64().expect("an end"));
            // Both end where the same sum of squares is met, to the tolerance of that search.
            assert!((one / other - 1.0).abs() < 1e-3, "{name}: {profile} {interval}");
        }
        let scatter = json["bootstrap"]["parameters"][name]["std_error"].as_f64().expect("an error");
        let error = json["sets"][set]["parameters"]["n"]["std_error"].as_f64().expect("an error");
        // Twenty replicates know their scatter to 16 %, and the residuals of twelve rows are few.
        assert!((0.3..3.0).contains(&(scatter / error)), "{scatter} {error}");
    }
    assert_eq!((&json["bootstrap"]["replicates"], &json["complete"]), (&Value::from(20), &Value::Null));
    let text = std::fs::read_to_string(&report).expect("the fit wrote it");
    for part in ["# Joint fit of 2 measurements", "Each measurement has its own n, k", "## Data: red.csv", "report-dolp-2.svg"] {
        assert!(text.contains(part), "{part} is missing in {text}");
    }
    assert!(folder.path("report-dolp-1.svg").exists() && folder.path("report-dolp-2.svg").exists());
    let svg = std::fs::read_to_string(&figure).expect("the fit wrote it");
    assert_eq!(svg.matches("<g transform=").count(), 2, "a figure for each measurement");
    let refused = refusal(&[&fit[..], &["--fix", "q", "--profile", "q"]].concat());
    assert!(refused.contains("q is not free in this fit and has no profile."), "{refused}");
}

#[test]
fn a_joint_comparison_gives_the_verdict_and_ends_above_no_special_case() {
    let folder = Folder::new();
    let [blue, red] = two_wavelengths(&folder);
    let figure = folder.path("figure.svg").display().to_string();
    let compare = ["compare", &blue, &red, "--models", "specular,specular-gauss,gauss,cauchy", "--own", "n,k"];
    let text = answer(&[&compare[..], &["--figure", &figure]].concat());
    assert!(text.contains("\nspecular-gauss and specular: ") && text.contains("\ngauss and cauchy: "), "{text}");
    assert!(std::fs::read_to_string(&figure).expect("a figure").contains("<g transform="));
    let json: Value = serde_json::from_str(&answer(&[&compare[..], &["--json"]].concat())).expect("JSON");
    let objective = |model: &str| {
        let fit = json["fits"].as_array().expect("fits").iter().find(|fit| fit["model"] == model).expect("a fit");
        fit["objective"].as_f64().expect("a number")
    };
    // A thousandth of a percent is where a search ends in a flat valley.
    for (general, special) in [("gauss", "specular-gauss"), ("cauchy", "specular"), ("cauchy", "gauss"), ("specular", "specular-gauss")] {
        assert!(objective(general) <= objective(special) * (1.0 + 1e-5), "{general} {special}");
    }
}

#[cfg(unix)]
#[test]
fn an_interrupted_joint_fit_says_that_it_is_incomplete() {
    let folder = Folder::new();
    let [blue, red] = two_wavelengths(&folder);
    let (code, json) = interrupted(&["fit", &blue, &red, "--own", "n,k", "--starts", "1000000", "--json"], "-INT");
    assert_eq!((code, &json["complete"]), (Some(130), &Value::from(false)));
    assert!(json["objective"].is_f64());
    let (code, json) = interrupted(&["compare", &blue, &red, "--own", "n,k", "--starts", "100000", "--json"], "-INT");
    assert_eq!((code, &json["complete"]), (Some(130), &Value::from(false)));
    assert!(json["fits"].as_array().expect("fits").iter().any(|fit| fit["skipped"].is_string()));
}
