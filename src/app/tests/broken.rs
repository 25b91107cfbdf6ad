//! Jobs that panic: nothing waits for them, and the window says so.

use crate::app::jobs::kind::JobKind;
use crate::app::shell::app::App;
use crate::app::shell::benchmarks::BenchmarkId;
use crate::app::shell::commands::Command;
use crate::app::shell::file_dialogs::FileRequest;
use crate::app::storage::export::ExportKind;
use crate::app::tests::{PATIENCE, explorer, harness, wait};
use std::time::Instant;

/// Begins a job of that kind in its place.
type Begin = fn(&mut App, JobKind);

const JOBS: [(JobKind, Begin); 12] = [
    (JobKind::Read, |e, task| e.worker.load = Some(e.worker.start_broken(task))),
    (JobKind::ImportDialog, |e, task| e.worker.load = Some(e.worker.start_broken(task))),
    (JobKind::ReadSession, |e, task| e.worker.session = Some(e.worker.start_broken(task))),
    (JobKind::Save, |e, task| e.worker.save = Some(e.worker.start_broken(task))),
    (JobKind::Export, |e, task| e.worker.export = Some(e.worker.start_broken(task))),
    (JobKind::Autosave, |e, task| e.worker.autosave = Some(e.worker.start_broken(task))),
    (JobKind::Fit, |e, task| e.worker.fit = Some(e.worker.start_broken(task))),
    (JobKind::Refit, |e, task| e.worker.refit = Some(e.worker.start_broken(task))),
    (JobKind::Compare, |e, task| e.worker.comparison = Some(e.worker.start_broken(task))),
    (JobKind::Profile, |e, task| e.worker.scan = Some(e.worker.start_broken(task))),
    (JobKind::Bootstrap, |e, task| e.worker.scan = Some(e.worker.start_broken(task))),
    (JobKind::Report, |e, task| e.reports.running = Some((BenchmarkId::Cost, e.worker.start_broken(task)))),
];

#[test]
fn a_job_that_panics_is_over_and_told_of() {
    let mut harness = harness();
    for (task, begin) in JOBS {
        begin(explorer(&mut harness), task);
        // Ends when no job is on its way.
        wait(&mut harness);
        assert_eq!(explorer(&mut harness).notices.take(), Some(task.broken()), "{task:?}");
    }
    // What was replaced meanwhile is nobody's matter.
    explorer(&mut harness).worker.fit = Some(explorer(&mut harness).worker.start_broken(JobKind::Fit));
    explorer(&mut harness).worker.abandon();
    explorer(&mut harness).worker.scan = Some(explorer(&mut harness).worker.start_broken(JobKind::Profile));
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).notices.take(), Some(JobKind::Profile.broken()));
}

#[test]
fn what_panicked_can_be_begun_again() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let path = folder.path().join("curves.csv");
    let mut harness = harness();
    let explorer_of = explorer(&mut harness);
    explorer_of.worker.export(ExportKind::Curves, path.clone(), Box::new(|_| std::panic::panic_any("on purpose"))).expect("a job");
    explorer_of.worker.ask = |_| std::panic::panic_any("on purpose");
    explorer_of.worker.ask(FileRequest::Open).expect("a job");
    wait(&mut harness);
    let said = explorer(&mut harness).notices.take().expect("two sentences");
    assert!(said.contains(&JobKind::Export.broken()) && said.contains(&JobKind::Dialog.broken()), "{said}");
    explorer(&mut harness).worker.ask = |_| Ok(Some("/no/such/file.csv".into()));
    explorer(&mut harness).commands.extend([Command::Export(ExportKind::Curves, path.clone()), Command::ChooseMeasurement]);
    wait(&mut harness);
    assert!(path.exists() && explorer(&mut harness).notices.take().is_some_and(|said| said.contains("/no/such/file.csv")));
}

#[test]
fn a_report_that_waits_comes_after_one_that_panics() {
    let mut harness = harness();
    let e = explorer(&mut harness);
    e.reports.running = Some((BenchmarkId::Cost, e.worker.start_broken(JobKind::Report)));
    e.commands.push(Command::MakeReport(BenchmarkId::Stability));
    let begun = Instant::now();
    while explorer(&mut harness).reports.progress().is_none_or(|(subject, _)| subject == BenchmarkId::Cost) {
        assert!(begun.elapsed() < PATIENCE, "the second report does not begin");
        harness.step();
    }
    explorer(&mut harness).commands.push(Command::CancelReport);
    wait(&mut harness);
    assert!(explorer(&mut harness).reports.cost.is_none() && explorer(&mut harness).reports.stability.is_some());
}
