//! `fit --batch`: many measurements, each fitted by itself; a row for each, as soon as it is there.

use crate::cli::arguments::{FitArguments, ProblemArguments};
use crate::cli::batch_table::{BatchTable, FileRows, KEYS};
use crate::cli::failure::Failure;
use crate::cli::output::{Progress, exit_code, notice};
use crate::cli::problem::{NoProblem, check_once, described, fitted, model, notice_strangers};
use crate::cli::sets::{MeasurementSets, NamedMeasurement, file_name};
use crate::cli::{input, interrupt};
use crate::files::export;
use pbrdf::fit::{Fit, Observer, StopReason, on_one_thread, row_columns, thread_count};
use pbrdf::measurement::Measurement;
use std::collections::HashSet;
use std::io;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

pub fn run(arguments: &FitArguments) -> Result<ExitCode, Failure> {
    let Some(output) = &arguments.output else {
        return Err(Failure::usage("--batch needs a file for its rows: -o results.csv."));
    };
    check_once(&arguments.problem).map_err(|reason| Failure::usage(format!("{reason}.")))?;
    refuse_targets(&arguments.problem)?;
    let files = expanded(&arguments.inputs)?;
    notice_strangers(arguments.model, &arguments.problem);
    let parameters = model(arguments.model, &arguments.problem).parameters();
    let columns: Vec<String> = KEYS.into_iter().chain(["model"]).map(str::to_owned).chain(row_columns(parameters)).collect();
    let columns: Vec<String> = columns.into_iter().chain(["notices", "error"].map(str::to_owned)).collect();
    let comments = [("program", export::program()), ("options", options(arguments, std::env::args().skip_while(|word| word != "fit")))];
    let table = BatchTable::open(output, &comments, &columns)?;
    let batch = Batch { arguments, files: &files, columns: columns.len(), course: Mutex::new(Course::new(table, files.len())) };
    batch.work();
    let course = batch.course.into_inner().unwrap_or_else(PoisonError::into_inner);
    course.end(&files, output)
}

/// Refuses options for one measurement alone: a batch has the same for all.
fn refuse_targets(options: &ProblemArguments) -> Result<(), Failure> {
    let ProblemArguments { start, fix, free, bounds, .. } = options;
    let start = start.iter().map(|option| &option.set);
    let fix = fix.iter().map(|option| &option.set);
    let free = free.iter().map(|option| &option.set);
    let bounds = bounds.iter().map(|option| &option.set);
    match start.chain(fix).chain(free).chain(bounds).flatten().next() {
        Some(set) => Err(Failure::usage(format!("--batch fits all measurements in the same way; leave @{set} out, or fit it by itself."))),
        None => Ok(()),
    }
}

/// The options as they were typed, without those that say which files.
fn options(arguments: &FitArguments, typed: impl Iterator<Item = String>) -> String {
    let names = arguments.inputs.iter().chain(&arguments.output).map(|path| path.display().to_string());
    let names: HashSet<String> = names.collect();
    let is_of_files = |word: &String| {
        let value = word.strip_prefix("--output=").or_else(|| word.strip_prefix("-o"));
        ["fit", "--batch", "-o", "--output", "--"].contains(&&word[..])
            || names.contains(word)
            || value.is_some_and(|value| names.contains(value))
    };
    let words: Vec<String> = typed.filter(|word| !is_of_files(word)).collect();
    if words.is_empty() { "none".to_owned() } else { words.join(" ") }
}

/// The files that names and patterns mean, each once, in the order of the names; those of a pattern in alphabetical order.
fn expanded(inputs: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let mut files = Vec::new();
    for input in inputs {
        let text = input.to_string_lossy();
        if input.exists() || !text.contains(['*', '?', '[']) {
            files.push(input.clone());
            continue;
        }
        let found = glob::glob(&text).map_err(|error| Failure::usage(format!("{text} is no pattern of file names: {}.", error.msg)))?;
        let before = files.len();
        files.extend(found.filter_map(Result::ok).filter(|path| !path.is_dir()));
        if files.len() == before {
            return Err(Failure::usage(format!("No file has a name such as {text}.")));
        }
    }
    let mut seen = HashSet::new();
    files.retain(|file| seen.insert(file.clone()));
    Ok(files)
}

/// What has been done.
struct Course {
    table: BatchTable,
    progress: Progress,
    begun: Instant,
    files: usize,
    /// Files that were there already, files fitted now, and rows without a fit among both.
    found: usize,
    made: usize,
    failures: usize,
    rows: usize,
    /// Why nothing more is written.
    broken: Option<io::Error>,
}

impl Course {
    fn new(table: BatchTable, files: usize) -> Self {
        let (progress, begun) = (Progress::new("fitting"), Instant::now());
        Self { table, progress, begun, files, found: 0, made: 0, failures: 0, rows: 0, broken: None }
    }

    fn count(&mut self, failures: usize, rows: usize) {
        self.failures += failures;
        self.rows += rows;
        let (done, files) = (self.found + self.made, self.files);
        let left = time_left(self.begun.elapsed(), self.made, files - done.min(files));
        let failures = if self.failures == 0 { String::new() } else { format!(", {} without a fit", self.failures) };
        self.progress.tell(|| format!("{done} of {files} files{failures}{left}"));
    }

    fn take(&mut self, rows: FileRows) {
        let (failures, count) = (rows.failures(), rows.rows.len());
        match self.table.append(rows) {
            Ok(()) => {
                self.made += 1;
                self.count(failures, count);
            }
            Err(error) => self.broken = Some(error),
        }
    }

    fn end(self, files: &[PathBuf], output: &Path) -> Result<ExitCode, Failure> {
        let Self { table, progress, found, made, failures, rows, broken, .. } = self;
        drop(progress);
        if let Some(error) = broken {
            return Err(Failure::output(output.display(), &error));
        }
        let path = output.display();
        if found + made < files.len() {
            notice(format_args!(
                "Interrupted: {path} holds {} of {} files; the same command goes on from there.",
                found + made,
                files.len()
            ));
            return Ok(exit_code());
        }
        let names: Vec<String> = files.iter().map(|file| file.display().to_string()).collect();
        table.finish(&names).map_err(|error| Failure::output(&path, &error))?;
        let already = if found == 0 { String::new() } else { format!("; {found} files were there already") };
        let without = if failures == 0 { String::new() } else { format!(", {failures} of them without a fit: see the column error") };
        notice(format_args!("{path}: {rows} measurements of {} files{without}{already}.", files.len()));
        Ok(ExitCode::SUCCESS)
    }
}

/// How long the rest takes, where some is done.
fn time_left(elapsed: Duration, made: usize, left: usize) -> String {
    let (Ok(made), Ok(left)) = (u32::try_from(made), u32::try_from(left)) else { return String::new() };
    let Some(each) = elapsed.checked_div(made) else { return String::new() };
    let seconds = (each * left).as_secs();
    match seconds {
        0..60 => format!(", {seconds} s left"),
        60..3600 => format!(", {} min {} s left", seconds / 60, seconds % 60),
        _ => format!(", {} h {} min left", seconds / 3600, seconds / 60 % 60),
    }
}

struct Batch<'a> {
    arguments: &'a FitArguments,
    files: &'a [PathBuf],
    columns: usize,
    course: Mutex<Course>,
}

impl Batch<'_> {
    /// Fits all files, one on each thread.
    fn work(&self) {
        let next = AtomicUsize::new(0);
        std::thread::scope(|scope| {
            for _ in 1..thread_count().min(self.files.len()) {
                let begun =
                    std::thread::Builder::new().name("batch".to_owned()).spawn_scoped(scope, || on_one_thread(|| self.work_off(&next)));
                if begun.is_err() {
                    break;
                }
            }
            on_one_thread(|| self.work_off(&next));
        });
    }

    fn work_off(&self, next: &AtomicUsize) {
        while let Some(path) = self.files.get(next.fetch_add(1, Ordering::Relaxed)) {
            if interrupt::asked() || self.course().broken.is_some() {
                return;
            }
            self.file(path);
        }
    }

    fn course(&self) -> std::sync::MutexGuard<'_, Course> {
        self.course.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Fits the measurements of a file, unless its rows are there.
    fn file(&self, path: &Path) {
        let name = path.display().to_string();
        let read = input::bytes(path);
        let hash = read.as_ref().map_or_else(|_| String::new(), |bytes| export::sha256(bytes));
        {
            let mut course = self.course();
            if let Some(rows) = course.table.found(&name, &hash) {
                let (failures, count) = (rows.failures(), rows.rows.len());
                course.found += 1;
                course.count(failures, count);
                return;
            }
        }
        let sets = read.and_then(|bytes| {
            let measurements = Measurement::read_sets(&bytes[..], &mut |_| std::ops::ControlFlow::Continue(()));
            let measurements = measurements.map_err(|error| input::measurement_failure(path, &bytes, &error))?;
            MeasurementSets::of_file(path, bytes, measurements)
        });
        let row = |sets: usize, set: &str, cells: Vec<String>| -> Vec<String> {
            let keys = [name.clone(), sets.to_string(), set.to_owned(), hash.clone(), self.arguments.model.key.to_owned()];
            let mut row: Vec<String> = keys.into_iter().chain(cells).collect();
            // A failure is told in the last column; the cells of the fit stay empty.
            let last = row.pop().unwrap_or_default();
            row.resize(self.columns - 1, String::new());
            row.push(last);
            row
        };
        let rows = match &sets {
            Err(failure) => vec![row(1, "", vec![failure.sentence().to_owned()])],
            Ok(sets) => {
                let all = sets.all.len();
                let fits = sets.all.iter().map(|set| {
                    let name = if all == 1 && set.name == file_name(path) { "" } else { &set.name };
                    self.fit(path, set).map(|cells| row(all, name, cells))
                });
                let Some(rows) = fits.collect() else { return };
                rows
            }
        };
        self.course().take(FileRows { rows });
    }

    /// The cells of a fit, its notices and an empty error; or its error alone. None where the user asked to stop.
    fn fit(&self, path: &Path, set: &NamedMeasurement) -> Option<Vec<String>> {
        let (preset, options) = (self.arguments.model, &self.arguments.problem);
        let measurement = &set.measurement;
        let fit = described(Fit::new(measurement, model(preset, options)), options, preset.dolp_only, &|_| true);
        let problem = match fit.problem() {
            Ok(problem) => problem,
            Err(error) => return Some(vec![NoProblem::from(error).about(path, measurement).sentence().to_owned()]),
        };
        let result = fitted(&problem, options, Observer { cancelled: &interrupt::asked, ..Observer::NONE });
        if result.stop_reason == StopReason::Cancelled || interrupt::asked() {
            return None;
        }
        let rows = measurement.used_rows();
        let cells = result.row(rows).iter().map(ToString::to_string).collect::<Vec<_>>();
        Some(cells.into_iter().chain([input::notices(measurement).join("; "), String::new()]).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::time_left;
    use std::time::Duration;

    #[test]
    fn the_time_left_follows_from_what_is_done() {
        assert_eq!(time_left(Duration::from_secs(10), 0, 5), "");
        assert_eq!(time_left(Duration::from_secs(10), 5, 5), ", 10 s left");
        assert_eq!(time_left(Duration::from_secs(10), 1, 61), ", 10 min 10 s left");
        assert_eq!(time_left(Duration::from_secs(3600), 1, 2), ", 2 h 0 min left");
    }
}
