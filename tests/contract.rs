//! The contract of the command line: whole answers of the program, snapshot by snapshot.
//!
//! `INSTA_UPDATE=always cargo test --test contract` rewrites the snapshots. With `PBRDF_EXPLORER` set to the path of
//! another build, that program answers instead; the snapshots are those of release 0.1.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]
#![cfg(all(feature = "cli", feature = "gui"))]

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

fn program() -> PathBuf {
    std::env::var_os("PBRDF_EXPLORER").map_or_else(|| PathBuf::from(env!("CARGO_BIN_EXE_pbrdf-explorer")), PathBuf::from)
}

/// A folder with all inputs, where the commands of one snapshot run.
fn working_folder() -> tempfile::TempDir {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    for source in ["tests/contract/input", "assets/examples"] {
        for entry in std::fs::read_dir(root.join(source)).expect("a folder of the repository") {
            let path = entry.expect("an entry").path();
            std::fs::copy(&path, folder.path().join(path.file_name().expect("a name"))).expect("a copy");
        }
    }
    std::fs::create_dir(folder.path().join("folder")).expect("a folder");
    folder
}

/// Exit code, standard output and standard error of one command.
fn run(folder: &Path, arguments: &str) -> String {
    if let Some(file) = arguments.strip_prefix("cat ") {
        return format!("$ cat {file}\n{}\n", std::fs::read_to_string(folder.join(file)).expect("a text"));
    }
    let output = Command::new(program())
        .args(arguments.split_whitespace())
        .current_dir(folder)
        .env("COLUMNS", "100")
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        .output()
        .expect("the program runs");
    let mut text = format!("$ pbrdf-explorer {arguments}\n");
    let code = output.status.code().expect("no signal");
    writeln!(text, "exit code: {code}").expect("memory");
    for (name, bytes) in [("stdout", &output.stdout), ("stderr", &output.stderr)] {
        let said = without_times(&String::from_utf8_lossy(bytes));
        if !said.is_empty() {
            write!(text, "--- {name} ---\n{said}").expect("memory");
        }
    }
    text.push('\n');
    text
}

/// The same without what differs from run to run: progress, durations, date and machine.
fn without_times(text: &str) -> String {
    let is_progress = |line: &str| {
        let end = line.split_once(": ").map_or("", |(_, end)| end);
        end.ends_with(" %") && end.len() <= 5 || end.contains(" evaluations, ΔE = ")
    };
    // Columns of `compare` that hold a duration end below this word.
    let mut time_column = None;
    let lines = text.lines().filter(|line| !is_progress(line)).map(|line| {
        if let Some(at) = line.find("time/ms") {
            time_column = Some(line[..at].chars().count() + "time/ms".len());
        } else if line.is_empty() {
            time_column = None;
        } else if let Some(end) = time_column {
            let cells: Vec<char> = line.chars().collect();
            let cut = |from: usize, to: usize| cells[from..to].iter().collect::<String>();
            if cells.len() > end && cut(end - 10, end).trim().parse::<f64>().is_ok() {
                return format!("{}{:>10}{}", cut(0, end - 10), "[ms]", cut(end, cells.len()));
            }
        }
        for (key, mark) in
            [("\"elapsed_ms\": ", "[ms]"), ("\"intervals_ms\": ", "[ms]"), ("\"date\": ", "[date]"), ("\"machine\": ", "[machine]")]
        {
            if let Some(at) = line.find(key) {
                let comma = if line.ends_with(',') { "," } else { "" };
                return format!("{}{mark}{comma}", &line[..at + key.len()]);
            }
        }
        match line.find(" evaluations, ").filter(|_| line.ends_with(" ms)")) {
            Some(at) => format!("{} evaluations, [ms] ms)", &line[..at]),
            None => line.to_owned(),
        }
    });
    lines.fold(String::new(), |all, line| all + &line + "\n")
}

/// Compares what the program answers to these commands, one a line, with the snapshot of that name.
fn check(name: &str, commands: &str) {
    let folder = working_folder();
    let lines = commands.lines().map(str::trim).filter(|line| !line.is_empty());
    let text = lines.fold(String::new(), |all, line| all + &run(folder.path(), line));
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("contract/snapshots");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_snapshot!(name, text));
}

#[test]
fn help() {
    check(
        "help",
        "--help
        -h
        --version
        help fit
        evaluate --help
        fit --help
        simulate --help
        compare --help
        posterior --help
        plan --help
        report --help
        picture --help
        import --help
        export --help
        export mitsuba --help
        metals --help",
    );
}

#[test]
fn usage_that_is_refused() {
    check(
        "refused_usage",
        "fit
        fitt fifteen_rows.csv
        fit fifteen_rows.csv --model phong
        fit fifteen_rows.csv --fix m
        fit fifteen_rows.csv --start n=-1
        fit fifteen_rows.csv --start n=x
        fit fifteen_rows.csv --start n=12
        fit fifteen_rows.csv --bounds n=5..2
        fit fifteen_rows.csv --bounds n=-1..2
        fit fifteen_rows.csv --bounds n
        fit fifteen_rows.csv --weights tons
        fit fifteen_rows.csv --weights sigma
        fit fifteen_rows.csv --loss-scale 0
        fit fifteen_rows.csv --starts 0
        fit fifteen_rows.csv --fix n --free n
        fit fifteen_rows.csv --fix n,k,sigma,ks,kd,kv,q,c,sigma_v
        fit fifteen_rows.csv --bootstrap 1
        fit fifteen_rows.csv --profile m
        fit brdf_alone.csv --model fresnel
        fit fifteen_rows.csv --no-such-option
        compare fifteen_rows.csv --models cauchy,phong
        simulate --theta-i 95 --theta-r 0 -o out.csv
        simulate --theta-i 30 --theta-r 20:10:5 -o out.csv
        simulate --theta-i 30 --theta-r 0:1:0 -o out.csv
        simulate --theta-i 30 --theta-r 20 --set sigma=0 -o out.csv
        simulate --theta-i 30 --theta-r 20 --set n=0,k=0 -o out.csv
        simulate --theta-i 30 --theta-r 20 --noise -1 -o out.csv
        simulate --theta-i 30 --theta-r 20 -o no/such/folder/out.csv
        plan --theta-i 30
        plan --theta-i 30 --theta-r 20 --fix n,k,sigma,kd,kv,q,c,sigma_v
        export mitsuba --resolution 3,4 -o out.pbsdf
        picture
        picture -o out.svg
        picture --lamp 30 -o out.png
        picture --lamp 190,0 -o out.png
        picture --lamp 30,x -o out.png
        picture --sky -1 -o out.png
        picture --size 1 -o out.png
        picture --shape cube -o out.png
        picture --show s3 -o out.png
        picture --model fresnel -o out.png
        picture --set c=-2 --sky 1 -o out.png
        picture -o no/such/folder/out.png
        metals unobtainium
        metals Cu --wavelength -5
        report speed",
    );
}

#[test]
fn files_that_are_refused() {
    let names = "none.csv folder empty.csv header_alone.csv no_header.csv missing_column.csv no_value_column.csv \
        repeated_column.csv short_row.csv long_row.csv empty_angle.csv nothing_measured.csv word_for_number.csv infinite.csv \
        too_large.csv angle_out_of_range.csv backscatter_out_of_plane.csv error_of_zero.csv negative_brdf.csv mask_of_two.csv \
        dolp_below_zero.csv dolp_above_one.csv null_bytes.csv utf_16.csv unclosed_quote.csv two_decimal_signs.csv \
        preamble.txt hash_in_header.csv foreign.csv woollam.dat astm.txt";
    let commands: Vec<String> = names.split_whitespace().map(|name| format!("fit {name} --model fresnel")).collect();
    check("refused_files", &commands.join("\n"));
    check("refused_files_with_json", "fit word_for_number.csv --json\ncompare foreign.csv --json");
    let surfaces = "none.csv folder empty.csv unknown_distribution.csv no_surface.csv q_of_one.csv surface_without_columns.csv";
    let commands: Vec<String> = surfaces.split_whitespace().map(|name| format!("evaluate {name}")).collect();
    check("refused_surfaces", &commands.join("\n"));
}

#[test]
fn files_that_are_read_with_a_notice() {
    let names = "masked_out_of_range.csv not_measured_nan.csv not_measured_na.csv not_measured_dash.csv blank_rows.csv \
        separator_in_quotes.csv byte_order_mark.csv two_rows.csv zeros.csv";
    let commands: Vec<String> = names.split_whitespace().map(|name| format!("fit {name} --model fresnel --starts 1")).collect();
    check("read_with_a_notice", &commands.join("\n"));
}

#[test]
fn without_a_command() {
    check("without_a_command", "none.csv\nsteel45_simulated.csv");
}

#[test]
fn evaluate() {
    check(
        "evaluate",
        "evaluate surfaces.csv
        evaluate surfaces.csv --mueller
        evaluate surfaces.csv --gradient
        evaluate surfaces.csv --mueller --gradient -o out.csv
        cat out.csv
        evaluate surfaces.csv -o no/such/folder/out.csv",
    );
}

#[test]
fn fit() {
    check(
        "fit",
        "fit fifteen_rows.csv
        fit fifteen_rows.csv --model fresnel
        fit fifteen_rows.csv --model specular --fix sigma=0.2,q --start n=1.5,k=2 --bounds n=0.1..3 --starts 1
        fit stated_errors.csv --model lambert --weights sigma
        fit brdf_alone.csv --model gauss --fix n=2,k=3,c=-0.5
        fit copper_650nm_simulated.csv --model gauss --fix q=2 --starts 1
        fit aluminium_650nm_simulated.csv --model three-component --starts 1 --fix n=1.24,k=6.6
        fit two_rows.csv --model minnaert --starts 3",
    );
    check(
        "fit_to_a_file",
        "fit fifteen_rows.csv --model lambert -o out.csv
        cat out.csv
        fit byte_order_mark.csv --model fresnel -o out.csv
        cat out.csv
        fit fifteen_rows.csv --model fresnel -o no/such/folder/out.csv",
    );
}

#[test]
fn fit_as_json() {
    check("fit_as_json", "fit steel45_simulated.csv --json");
    check("fit_as_json_brdf", "fit aluminium_650nm_simulated.csv --json --starts 4 --seed 3");
    check(
        "fit_as_json_options",
        "fit steel45_simulated.csv --json --model lambert --loss huber --seed 7
        fit steel45_simulated.csv --json --model hyde --loss soft-l1 --loss-scale 0.01 --starts 3
        fit steel45_simulated.csv --json --model gauss --starts 1 --weights sigma --fix ks=0.8,c --eq17 printed
        fit steel45_simulated.csv --json --model cauchy --starts 1 --free ks
        fit aluminium_650nm_simulated.csv --json --model cauchy --starts 1 --brdf-residuals log
        fit aluminium_650nm_simulated.csv --json --model cauchy --starts 1 --brdf-residuals absolute
        fit brdf_alone.csv --json --model gauss --starts 1 --fix n=2,k=3,c=-0.5
        fit two_rows.csv --json --model fresnel
        fit zeros.csv --json --model fresnel",
    );
    check(
        "fit_as_json_diagnostics",
        "fit steel45_simulated.csv --json --model lambert --profile n,sigma --bootstrap 20
        fit steel45_simulated.csv --model lambert --profile kd --bootstrap 20",
    );
}

#[test]
fn compare() {
    check(
        "compare",
        "compare fifteen_rows.csv
        compare brdf_alone.csv --models fresnel,specular,gauss,cauchy --fix n=2,k=3
        compare copper_650nm_simulated.csv --models gauss,cauchy --starts 1",
    );
    check("compare_as_json", "compare steel45_simulated.csv --json\ncompare brdf_alone.csv --json --models fresnel,specular --starts 1");
}

#[test]
fn plan() {
    check(
        "plan",
        "plan --theta-i 30,40,50 --theta-r 20:60:5
        plan --theta-i 30,40,50 --theta-r 20:60:5 --json
        plan --model gauss --set n=2.07,k=2.9 --theta-i 10:80:10 --theta-r -40:85:5 --columns both --noise 0.002 --brdf-noise 0.05 --json
        plan --model lambert --theta-i 30 --theta-r 30 --fix sigma --free ks --columns brdf --json",
    );
}

#[test]
fn simulate() {
    check(
        "simulate",
        "simulate --theta-i 30,40 --theta-r -20:60:20 -o out.csv
        cat out.csv
        simulate --model gauss --set n=1.5,k=4 --theta-i 30 --theta-r 0:60:20 --noise 0.01 --columns both --brdf-noise 0.1 --seed 3 -o out.csv
        cat out.csv
        simulate --model lambert --set q=3 --theta-i 30 --theta-r 0:60:20 --dphi 90 --columns brdf -o out.csv
        cat out.csv",
    );
}

#[test]
fn picture() {
    check(
        "picture",
        "picture --size 6 -o out.csv
        cat out.csv
        picture --model gauss --set n=1.5,k=0,kd=0.02 --lamp 70,-20 --sky 0.5 --shape relief --size 4 -o out.csv
        cat out.csv
        picture --shape plate --sky 1 --size 5 -o out.csv
        cat out.csv
        picture --shape cylinder --size 16 --show aop -o out.png
        picture --size 16 -o out.exr",
    );
}

#[test]
fn import() {
    check(
        "import",
        "import foreign.csv
        import foreign.csv --columns theta_i=2,theta_r=3:radians,dolp=4:percent
        import foreign.csv --columns theta_i=AOI,theta_r=3
        import one_angle_of_incidence.csv --columns theta_r=view,dolp=dolp --theta-i 45 -o out.csv
        cat out.csv
        import woollam.dat
        import woollam.dat --wavelength 640
        import woollam.dat --wavelength 600 -o out.csv
        cat out.csv
        import preamble.txt
        import preamble.txt --columns theta_i=1,theta_r=2,dolp=3
        import hash_in_header.csv --columns theta_i=2,theta_r=3,dolp=4
        import astm.txt
        import astm.txt --columns theta_i=1,theta_r=3,brdf=5
        import wide.csv
        import not_a_tensor.pbsdf
        import empty.csv
        import none.csv
        import folder
        import fifteen_rows.csv",
    );
    check(
        "export_and_import_of_a_tensor",
        "export mitsuba --model gauss --set n=2,k=3 --resolution 5,6,7 --wavelength 546 -o out.pbsdf
        import out.pbsdf --theta-i 30,45 --theta-r -10:30:10
        import out.pbsdf --theta-i 30 --theta-r 0:80:40 --dphi 90
        import out.pbsdf --theta-i 30 --theta-r -10 --dphi 90
        fit out.pbsdf",
    );
}

#[test]
fn metals() {
    check("metals", "metals\nmetals Cu\nmetals copper --wavelength 650\nmetals Al --wavelength 650 --json\nmetals Fe --json");
}

#[test]
fn report_on_stability() {
    check("report_on_stability", "report stability --json");
}
