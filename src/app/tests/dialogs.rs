//! Dialogs of the desktop, where there are some and where there are none.

use crate::app::platform::DialogUnavailable;
use crate::app::shell::file_dialogs::command_for;
use crate::app::storage::export::ExportKind;
use crate::app::tasks::file_request::{FileReply, FileRequest, ask_user};
use crate::app::views::action::Action;
use crate::app::work::pane_id::PaneId;
use std::path::Path;
#[cfg(target_os = "linux")]
use std::process::{Command as Process, Stdio};

/// Tells the process below what the desktop of its test is like.
const DESKTOP: &str = "PBRDF_TEST_DESKTOP";

/// The process that asks on that desktop.
#[test]
fn asker() {
    let expected: FileReply = match std::env::var(DESKTOP).as_deref() {
        Ok("empty") => Err(DialogUnavailable),
        Ok("cancelled") => Ok(Vec::new()),
        Ok(path) => Ok(vec![path.into()]),
        Err(_) => return,
    };
    for question in [FileRequest::Open, FileRequest::Save("a.csv".to_owned()), FileRequest::OpenSession, FileRequest::OpenFolder] {
        assert_eq!(ask_user(question), expected);
    }
}

/// Asks in a process that has no portal and finds that in the place of zenity; whether all is as
/// expected.
#[cfg(target_os = "linux")]
fn asked(expected: &str, zenity: Option<&str>) -> bool {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    if let Some(script) = zenity {
        let path = folder.path().join("zenity");
        std::fs::write(&path, format!("#!/bin/sh\n{script}\n")).expect("a writable folder");
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o700)).expect("a file of our own");
    }
    let output = Process::new(std::env::current_exe().expect("this test"))
        .args(["app::tests::dialogs::asker", "--exact"])
        .env(DESKTOP, expected)
        .env("PATH", folder.path())
        .env("DBUS_SESSION_BUS_ADDRESS", "unix:path=/nonexistent/bus")
        .stderr(Stdio::null())
        .output()
        .expect("this test again");
    // A name that no test has makes none fail.
    output.status.success() && String::from_utf8_lossy(&output.stdout).contains("1 passed")
}

#[cfg(target_os = "linux")]
#[test]
fn a_dialog_that_cannot_open_is_told_from_one_that_is_cancelled() {
    assert!(asked("empty", None));
    assert!(asked("cancelled", Some("exit 1")));
    assert!(asked("/tmp/chosen.csv", Some("echo /tmp/chosen.csv")));
}

#[test]
fn an_ending_that_the_desktop_did_not_see_is_asked_about() {
    let export =
        |path: &str| command_for(&FileRequest::Export(ExportKind::Plot(PaneId::Dolp), String::new()), vec![path.into()]).expect("a path");
    assert_eq!(export("/a/plot.png"), Action::Export(ExportKind::Plot(PaneId::Dolp), "/a/plot.png".into()));
    assert_eq!(export("/a/plot"), Action::ExportNew(ExportKind::Plot(PaneId::Dolp), Path::new("/a/plot.svg").into()));
}
