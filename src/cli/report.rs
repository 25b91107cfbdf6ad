//! `report`: benchmarks as a table, as JSON, and as files in a folder.

use crate::cli::arguments::{ReportArguments, ReportSubject};
use crate::cli::failure::Failure;
use crate::cli::output::Progress;
use crate::cli::{interrupt, output};
use crate::figure::Figure;
use crate::files::export::{machine, now};
use crate::report::{BenchmarkFigures, English};
use pbrdf::selftest::{BenchmarkRow, Cost, ErrorVsTime, Host, Report, Stability};
use serde_json::Value;
use std::path::Path;
use std::process::ExitCode;
use std::sync::Mutex;
use std::time::Instant;

/// Resolution of PNG figures, in dots per inch: sharp on paper and on dense screens.
const DPI: f64 = 200.0;

/// A finished report in the forms that leave the program.
struct Answer {
    /// As printed with `--json`.
    json: Value,
    /// As it goes into the folder, with curves.
    whole_json: Value,
    /// As printed without.
    markdown: String,
    /// Pictures, with the ends of their files' names.
    figures: Vec<(&'static str, Figure)>,
}

impl Answer {
    fn new<R: BenchmarkRow>(report: &Report<R>) -> Self
    where
        Report<R>: BenchmarkFigures,
    {
        Self { json: report.json(), whole_json: report.json_with_curves(), markdown: report.markdown(), figures: report.figures(&English) }
    }
}

pub fn run(arguments: &ReportArguments) -> Result<ExitCode, Failure> {
    interrupt::watch();
    if let Some(folder) = &arguments.output {
        // Fails before minutes of work.
        prepare(folder)?;
    }
    let begun = Instant::now();
    let progress = Mutex::new(Progress::new(arguments.subject.key()));
    let host = Host {
        clock: &|| begun.elapsed().as_secs_f64() * 1e3,
        cancelled: &interrupt::asked,
        progress: &|fraction| {
            if let Ok(mut progress) = progress.lock() {
                progress.tell_fraction(fraction);
            }
        },
    };
    let answer = match arguments.subject {
        ReportSubject::ErrorVsTime => Answer::new(&ErrorVsTime::run(machine(), now(), host)),
        ReportSubject::Stability => Answer::new(&Stability::run(machine(), now(), host)),
        ReportSubject::Cost => Answer::new(&Cost::run(machine(), now(), host)),
    };
    drop(progress);
    if arguments.json {
        output::write_json(&answer.json)?;
    } else {
        output::write(None, |out| out.write_all(answer.markdown.as_bytes()))?;
    }
    if let Some(folder) = &arguments.output {
        save(folder, arguments.subject.key(), &answer)?;
    }
    Ok(output::exit_code())
}

/// Creates the folder and checks that it is writable.
fn prepare(folder: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(folder)
        .and_then(|()| tempfile::tempfile_in(folder).map(drop))
        .map_err(|error| Failure::output(format_args!("The folder {}", folder.display()), &error.kind().into()))
}

fn save(folder: &Path, name: &str, answer: &Answer) -> Result<(), Failure> {
    let json = serde_json::to_string_pretty(&answer.whole_json).map_err(|error| Failure::output("JSON", &error.into()))?;
    output::write(Some(&folder.join(format!("{name}.json"))), |out| writeln!(out, "{json}"))?;
    output::write(Some(&folder.join(format!("{name}.md"))), |out| out.write_all(answer.markdown.as_bytes()))?;
    for (suffix, figure) in &answer.figures {
        let svg = folder.join(format!("{name}-{suffix}.svg"));
        output::write(Some(&svg), |out| out.write_all(figure.svg().as_bytes()))?;
        let png = folder.join(format!("{name}-{suffix}.png"));
        let pixels = figure.png(DPI).map_err(|error| Failure::output(png.display(), &std::io::Error::other(error)))?;
        output::write(Some(&png), |out| out.write_all(&pixels))?;
    }
    Ok(())
}
