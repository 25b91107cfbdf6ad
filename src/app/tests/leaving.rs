//! Plots, curves, fits and reports as files and on the clipboard.

use super::{explorer, harness, wait};
use crate::app::command::Command;
use crate::app::leaving::{Outgoing, PLOTS, figure};
use crate::app::panes::Pane;
use crate::app::reports::Subject;
use crate::app::window::Explorer;
use crate::app::worker::Event;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use pbrdf::report::Surroundings;
use pbrdf::report::figure::{Drawn, Scale};
use std::ops::ControlFlow;

fn order(harness: &mut Harness<'static, Option<Explorer>>, command: Command) {
    explorer(harness).commands.push(command);
    wait(harness);
}

#[test]
fn every_plot_is_a_figure_of_what_is_drawn() {
    let mut harness = harness();
    order(&mut harness, Command::OpenExample(1));
    let explorer = explorer(&mut harness);
    let dolp = figure(explorer, Pane::Dolp).expect("a plot");
    let curves = explorer.derived.curves.get().expect("curves");
    let drawn = dolp.panels[0].series.iter().find_map(|series| match &series.drawn {
        Drawn::Line { points, .. } if series.name.starts_with("θi") => Some(points),
        _ => None,
    });
    let first = &curves.series[0].dolp[0];
    assert!(drawn.expect("a curve").iter().zip(first).all(|(exported, shown)| *exported == [shown.x, shown.y]));
    let marks = explorer.derived.marks.get().expect("points");
    let points: usize =
        dolp.panels[0]
            .series
            .iter()
            .map(|series| {
                if let Drawn::Points { points, .. } = &series.drawn { points.iter().filter(|point| point.bar.is_some()).count() } else { 0 }
            })
            .sum();
    assert_eq!(points, marks.series.iter().map(|marks| marks.dolp.bars.len()).sum::<usize>());
    assert_eq!(dolp.panels[0].y.title(), "DoLP");
}

#[test]
fn a_logarithmic_plot_is_exported_with_its_values() {
    let mut harness = harness();
    explorer(&mut harness).settings.log_brdf = true;
    harness.run();
    let explorer = explorer(&mut harness);
    let panel = &figure(explorer, Pane::Lobes).expect("a plot").panels[0];
    assert_eq!((panel.y.scale, panel.y.title().as_str()), (Scale::Log, "BRDF / sr⁻¹"));
    let total = panel.series.last().expect("the total");
    let Drawn::Line { points, .. } = &total.drawn else { panic!("a curve") };
    let shown = &explorer.derived.curves.get().expect("curves").own.total[0][0];
    assert_eq!(points[0], [shown.x, libm::exp10(shown.y)]);
}

#[test]
fn each_export_writes_its_file_and_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = harness();
    order(&mut harness, Command::StartFit);
    for subject in Subject::ALL {
        let stop = || true;
        let made = Box::new(subject.make(Surroundings { clock: &|| 0.0, cancelled: &stop, progress: &|_| {} }));
        explorer(&mut harness).receive(Event::Reported { made, is_part: true });
    }
    let mut exports =
        vec![(Outgoing::Curves, "c.csv"), (Outgoing::Fitted, "f.csv"), (Outgoing::Report, "r.html"), (Outgoing::Report, "r.md")];
    for pane in PLOTS {
        exports.extend([(Outgoing::Plot(pane), "p.svg"), (Outgoing::Plot(pane), "p.png")]);
    }
    for (what, name) in exports {
        let path = folder.path().join(name);
        order(&mut harness, Command::Export(what, path.clone()));
        let notice = explorer(&mut harness).notice.take().expect("a sentence");
        assert!(notice.contains("is saved to") && notice.contains(name), "{notice}");
        let bytes = std::fs::read(&path).expect("a file");
        match name.rsplit('.').next() {
            Some("csv") => {
                let measurement = pbrdf::measurement::read(bytes.as_slice(), &mut |_| ControlFlow::Continue(())).expect("a table");
                assert!(measurement.rows.len() >= 27);
            }
            Some("png") => assert!(bytes.starts_with(b"\x89PNG")),
            Some("svg") => assert!(roxmltree::Document::parse(std::str::from_utf8(&bytes).expect("text")).is_ok()),
            Some("html") => assert!(bytes.starts_with(b"<!DOCTYPE html>")),
            _ => assert!(bytes.starts_with(b"# Fit of")),
        }
    }
}

#[test]
fn a_typed_path_serves_where_there_is_no_dialog() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("typed");
    let mut harness = harness();
    harness.get_by_label("File").click();
    harness.run();
    // A submenu opens under the pointer; a click would close it again.
    harness.get_by_label_contains("Export").hover();
    harness.run();
    explorer(&mut harness).typed_export = path.display().to_string();
    harness.run();
    harness.get_by_label_contains("Curves as CSV").click();
    wait(&mut harness);
    wait(&mut harness);
    assert!(path.with_extension("csv").exists(), "the usual ending is added");
}

#[test]
fn a_name_of_another_kind_is_refused_in_words() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = harness();
    order(&mut harness, Command::Export(Outgoing::Plot(Pane::Dolp), folder.path().join("plot.pdf")));
    assert!(explorer(&mut harness).notice.take().expect("a sentence").contains(".svg or .png"));
    order(&mut harness, Command::Export(Outgoing::Report, folder.path().join("r.html")));
    assert!(explorer(&mut harness).notice.take().expect("a sentence").contains("no fit yet"));
    assert_eq!(std::fs::read_dir(folder.path()).expect("the folder").count(), 0);
}

#[test]
fn plots_and_tables_go_to_the_clipboard() {
    let mut harness = harness();
    for (command, is_image) in [(Command::CopyPlot(Pane::Dolp), true), (Command::CopyTable, false)] {
        explorer(&mut harness).commands.push(command);
        harness.step();
        let commands = &harness.output().platform_output.commands;
        let found = commands.iter().any(|command| match command {
            egui::OutputCommand::CopyImage(image) => {
                is_image && image.width() > 500 && image.pixels.iter().any(|pixel| *pixel != egui::Color32::WHITE)
            }
            egui::OutputCommand::CopyText(text) => !is_image && text.contains("theta_i,theta_r,dphi,dolp"),
            _ => false,
        });
        assert!(found, "{commands:?}");
    }
}

#[test]
fn a_file_is_known_by_its_hash() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("mine.csv");
    let text = "theta_i,theta_r,dolp\n30,20,0.1\n30,40,0.2\n30,60,0.3\n";
    std::fs::write(&path, text).expect("a writable folder");
    let mut harness = harness();
    assert_eq!(explorer(&mut harness).document.sha256, None);
    order(&mut harness, Command::OpenMeasurement(path));
    assert_eq!(explorer(&mut harness).document.sha256, Some(crate::export::sha256(text.as_bytes())));
}
