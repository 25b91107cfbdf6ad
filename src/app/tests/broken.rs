//! Jobs that panic: their slot is free again, and the window says so.

use crate::app::storage::export::ExportKind;
use crate::app::tasks::benchmarks::BenchmarkId;
use crate::app::tasks::file_request::FileRequest;
use crate::app::tests::{PATIENCE, explorer, harness, wait};
use crate::app::views::action::Action;
use std::time::Instant;

#[test]
fn a_job_that_panics_frees_its_slot_and_the_window_says_so() {
    let mut harness = harness();
    let count = explorer(&mut harness).jobs.slots().len();
    for index in 0..count {
        let jobs = &mut explorer(&mut harness).jobs;
        let spawner = jobs.spawner.clone();
        jobs.slots()[index].start_panicking(&spawner);
        // Ends when every slot is free.
        wait(&mut harness);
        let toast = explorer(&mut harness).toasts.take().expect("a sentence");
        assert!(toast.contains("ended unexpectedly") && !toast.contains('\n'), "slot {index}: {toast}");
    }
    // Nobody hears of a job that was abandoned.
    let jobs = &mut explorer(&mut harness).jobs;
    let spawner = jobs.spawner.clone();
    jobs.slots().iter_mut().for_each(|slot| slot.start_panicking(&spawner));
    jobs.fits.abandon();
    jobs.files.abandon_reading();
    wait(&mut harness);
    let toasts = explorer(&mut harness).toasts.take().expect("sentences about the other jobs");
    assert!(!toasts.contains("The fit") && !toasts.contains("Reading"), "{toasts}");
    assert!(toasts.contains("Writing") && toasts.contains("dialog"), "{toasts}");
}

#[test]
fn what_panicked_can_start_again() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let path = folder.path().join("curves.csv");
    let mut harness = harness();
    let files = &mut explorer(&mut harness).jobs.files;
    files.export(ExportKind::Curves, 0, path.clone(), Box::new(|_| std::panic::panic_any("on purpose"))).expect("a job");
    files.ask = |_| std::panic::panic_any("on purpose");
    files.ask(FileRequest::Open).expect("a job");
    wait(&mut harness);
    let toasts = explorer(&mut harness).toasts.take().expect("two sentences");
    assert!(toasts.contains("Writing the file ended") && toasts.contains("The file dialog ended"), "{toasts}");
    explorer(&mut harness).jobs.files.ask = |_| Ok(vec!["/no/such/file.csv".into()]);
    explorer(&mut harness).actions.extend([Action::Export(ExportKind::Curves, path.clone()), Action::ChooseMeasurement]);
    wait(&mut harness);
    assert!(path.exists() && explorer(&mut harness).toasts.take().is_some_and(|toast| toast.contains("/no/such/file.csv")));
}

#[test]
fn a_benchmark_that_waits_comes_after_one_that_panics() {
    let mut harness = harness();
    let app = explorer(&mut harness);
    let spawner = app.jobs.spawner.clone();
    app.jobs.benchmarks.slots()[0].start_panicking(&spawner);
    app.actions.push(Action::RunBenchmark(BenchmarkId::Stability));
    let begun = Instant::now();
    while explorer(&mut harness).jobs.benchmarks.progress().is_none() {
        assert!(begun.elapsed() < PATIENCE, "the second benchmark does not start");
        harness.step();
    }
    explorer(&mut harness).actions.push(Action::CancelBenchmark);
    wait(&mut harness);
    assert!(explorer(&mut harness).benchmarks.stability.is_some());
}
