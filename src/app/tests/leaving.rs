//! Plots, curves, fits and reports as files and on the clipboard.

use crate::app::shell::app::App;
use crate::app::storage::export::ExportKind;
use crate::app::tasks::benchmarks::BenchmarkId;
use crate::app::tests::{explorer, harness, plots, wait};
use crate::app::views::action::{Action, WindowAction};
use crate::app::views::spec;
use crate::app::work::pane_id::PaneId;
use crate::app::work::settings::HemisphereQuantity;
use crate::figure::{Figure, HeatMap, Mark, Panel, Scale, Series};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use pbrdf::model::Pbrdf;
use pbrdf::optics::{Facet, Geometry};
use pbrdf::selftest::Host;

fn order(harness: &mut Harness<'static, Option<App>>, command: Action) {
    explorer(harness).actions.push(command);
    wait(harness);
}

#[test]
fn every_plot_is_a_figure_of_what_is_drawn() {
    let mut harness = harness();
    order(&mut harness, Action::OpenExample(1));
    let explorer = explorer(&mut harness);
    let dolp = explorer.figure(PaneId::Dolp).expect("a plot");
    let curves = explorer.derived.curves.get().expect("curves");
    let drawn = dolp.panels[0].series.iter().find_map(|series| match &series.mark {
        Mark::Line { points, .. } if series.name.starts_with("θi") => Some(points),
        _ => None,
    });
    assert_eq!(drawn.expect("a curve"), &curves.series[0].dolp);
    let marks = explorer.derived.marks.get().expect("points");
    let points: usize = dolp.panels[0]
        .series
        .iter()
        .map(
            |series| {
                if let Mark::Points { points, .. } = &series.mark { points.iter().filter(|point| point.bar.is_some()).count() } else { 0 }
            },
        )
        .sum();
    assert_eq!(points, marks.series.iter().map(|marks| marks.dolp.used.iter().filter(|point| point.bar.is_some()).count()).sum::<usize>());
    assert_eq!(dolp.panels[0].y.title(), "DoLP");
}

/// Brings a pane to the front.
fn show(harness: &mut Harness<'static, Option<App>>, pane: PaneId) {
    if !explorer(harness).dock.is_on_screen(pane) {
        order(harness, Action::Window(WindowAction::ShowPane(pane)));
    }
    wait(harness);
}

/// Panes and a title of an axis or a colour bar in their figures; of the reports those in the tests
/// of the core.
const TITLES: [(PaneId, &[&str]); 15] = [
    (PaneId::Dolp, &["θr / °", "DoLP"]),
    (PaneId::Lobes, &["θr / °", "BRDF / sr⁻¹"]),
    (PaneId::PolarLobes, &["BRDF / sr⁻¹"]),
    (PaneId::Facets, &["α / °", "density / sr⁻¹", "θr / °", "masking–shadowing G"]),
    (PaneId::Convergence, &["residual evaluations", "ΔE"]),
    (PaneId::Metals, &["wavelength / nm", "n", "k"]),
    (PaneId::Hemisphere, &["−θr cos Δφ / °", "−θr sin Δφ / °", "DoLP"]),
    (PaneId::Picture, &["x", "y", "radiance S0 / sr⁻¹"]),
    (PaneId::Mueller, &["θr / °", "m00 / m00", "m01 / m00", "m33 / m00"]),
    (PaneId::Landscape, &["n", "k", "ΔE"]),
    (PaneId::Audit, &["θi / °", "directional-hemispherical reflectance"]),
    (PaneId::ErrorVsTime, &[]),
    (PaneId::Stability, &[]),
    (PaneId::Cost, &[]),
    (PaneId::ResidualsAgainstAngle, &["θr / °", "DoLP: model − measurement / s.d."]),
];

#[test]
fn every_pane_with_a_plot_exports_it_with_the_titles_of_its_axes() {
    // Tables and text.
    let without = [PaneId::Data, PaneId::Models, PaneId::Results];
    assert!(PaneId::ALL.iter().all(|pane| spec(*pane).has_figure != without.contains(pane)));
    let mut harness = harness();
    order(&mut harness, Action::StartFit);
    for (pane, titles) in TITLES.into_iter().filter(|(_, titles)| !titles.is_empty()) {
        show(&mut harness, pane);
        let figure = explorer(&mut harness).figure(pane).expect("a plot");
        let svg = figure.svg();
        let svg = roxmltree::Document::parse(&svg).expect("XML");
        let words: Vec<&str> = svg.descendants().filter_map(|node| node.attribute("aria-label").or(node.text())).collect();
        for title in titles {
            assert!(words.contains(title), "{pane:?}: {title} is not in {words:?}");
        }
        assert!(figure.panels.iter().all(|panel| !panel.x.title().is_empty() && !panel.y.title().is_empty()), "{pane:?}");
        // A frame, marks and words are there without any curve.
        let drawn = figure.panels.iter().all(|panel| {
            let bare = Figure { panels: vec![Panel { series: Vec::new(), ..panel.clone() }], ..figure.clone() };
            let full = Figure { panels: vec![Panel { legend: false, ..panel.clone() }], ..figure.clone() };
            full.svg().matches("<path").count() > bare.svg().matches("<path").count()
        });
        assert!(drawn, "{pane:?}: a panel without curves");
    }
}

fn map_of(figure: &Figure) -> &HeatMap {
    let is_map = |series: &&Series| matches!(series.mark, Mark::HeatMap(_));
    match figure.panels[0].series.iter().find(is_map).map(|series| &series.mark) {
        Some(Mark::HeatMap(map)) => map,
        _ => panic!("no map"),
    }
}

#[test]
fn an_exported_hemisphere_has_the_models_values_where_its_axes_say() {
    let mut harness = harness();
    show(&mut harness, PaneId::Hemisphere);
    for quantity in [HemisphereQuantity::Dolp, HemisphereQuantity::Brdf] {
        explorer(&mut harness).work.settings_mut().view_options.hemisphere = quantity;
        wait(&mut harness);
        let explorer = explorer(&mut harness);
        let exported = explorer.figure(PaneId::Hemisphere).expect("a map");
        let map = map_of(&exported);
        let (row, column) = (60, 170);
        let middle = |edges: &[f64], i: usize| f64::midpoint(edges[i], edges[i + 1]);
        let (x, y) = (middle(&map.x_edges, column), middle(&map.y_edges, row));
        let (theta_r, dphi) = (libm::hypot(x, y), libm::atan2(-y, -x).to_degrees().rem_euclid(360.0));
        let (settings, surface) = (explorer.work.settings(), explorer.work.surface());
        let surface = Pbrdf::new(surface.model, surface.parameters).expect("a surface");
        let geometry = Geometry::new(settings.theta_i, theta_r, dphi).expect("a direction");
        let reflection = surface.reflection(&Facet::new(geometry));
        let expected = if quantity == HemisphereQuantity::Dolp { reflection.dolp } else { reflection.brdf };
        let value = map.values[row * (map.x_edges.len() - 1) + column];
        // Angles went through degrees and back, and the BRDF through its logarithm.
        assert!((value / expected - 1.0).abs() < 1e-9, "{quantity:?}: {value} {expected}");
        assert_eq!(map.color_axis.scale == Scale::Log, quantity == HemisphereQuantity::Brdf);
    }
}

#[test]
fn an_exported_landscape_has_its_nodes_where_its_axes_say() {
    let mut harness = harness();
    order(&mut harness, Action::StartFit);
    show(&mut harness, PaneId::Landscape);
    let explorer = explorer(&mut harness);
    let exported = explorer.figure(PaneId::Landscape).expect("a map");
    let map = map_of(&exported);
    let fit = explorer.work.shown_fit().expect("a fit");
    let [n, k] = [fit.report.parameters.n, fit.report.parameters.k];
    let cell = |edges: &[f64], value: f64| edges.windows(2).position(|pair| (pair[0]..pair[1]).contains(&value)).expect("inside");
    let at = |n: f64, k: f64| map.values[cell(&map.y_edges, k) * (map.x_edges.len() - 1) + cell(&map.x_edges, n)];
    // The sliders stand where the fit ended: there it is lower than a few cells away on each side.
    let around = [at(1.3 * n, k), at(n / 1.3, k), at(n, k + 0.5), at(n, k - 0.5)];
    assert!(around.iter().all(|height| *height > at(n, k)), "{around:?} {}", at(n, k));
    let names: Vec<&str> = exported.panels[0].series.iter().map(|series| series.name.as_str()).collect();
    for name in ["way of the last fit", "minima", "metals", "sliders"] {
        assert!(names.contains(&name), "{name}");
    }
}

#[test]
fn a_logarithmic_plot_is_exported_with_its_values() {
    let mut harness = harness();
    explorer(&mut harness).work.settings_mut().log_brdf = true;
    harness.run();
    let explorer = explorer(&mut harness);
    let panel = &explorer.figure(PaneId::Lobes).expect("a plot").panels[0];
    assert_eq!((panel.y.scale, panel.y.title().as_str()), (Scale::Log, "BRDF / sr⁻¹"));
    let total = panel.series.last().expect("the total");
    let Mark::Line { points, .. } = &total.mark else { panic!("a curve") };
    assert_eq!(*points, explorer.derived.curves.get().expect("curves").own.total);
}

#[test]
fn each_export_writes_its_file_and_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = harness();
    order(&mut harness, Action::StartFit);
    for subject in BenchmarkId::ALL {
        let stop = || true;
        let result = Box::new(subject.run(Host { clock: &|| 0.0, cancelled: &stop, progress: &|_| {} }));
        explorer(&mut harness).benchmarks.take(*result, true);
    }
    let mut exports =
        vec![(ExportKind::Curves, "c.csv"), (ExportKind::Fitted, "f.csv"), (ExportKind::Report, "r.html"), (ExportKind::Report, "r.md")];
    for pane in plots() {
        show(&mut harness, pane);
        exports.extend([(ExportKind::Plot(pane), "p.svg"), (ExportKind::Plot(pane), "p.png")]);
    }
    for (what, name) in exports {
        let path = folder.path().join(name);
        order(&mut harness, Action::Export(what, path.clone()));
        let notice = explorer(&mut harness).toasts.take().expect("a sentence");
        assert!(notice.contains("is saved to") && notice.contains(name), "{notice}");
        let bytes = std::fs::read(&path).expect("a file");
        match name.rsplit('.').next() {
            Some("csv") => {
                let measurement = pbrdf::measurement::Measurement::read(bytes.as_slice()).expect("a table");
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
    explorer(&mut harness).dialogs.path_entry.export = path.display().to_string();
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
    order(&mut harness, Action::Export(ExportKind::Plot(PaneId::Dolp), folder.path().join("plot.pdf")));
    assert!(explorer(&mut harness).toasts.take().expect("a sentence").contains(".svg or .png"));
    order(&mut harness, Action::Export(ExportKind::Report, folder.path().join("r.html")));
    assert!(explorer(&mut harness).toasts.take().expect("a sentence").contains("no fit yet"));
    assert_eq!(std::fs::read_dir(folder.path()).expect("the folder").count(), 0);
}

#[test]
fn plots_and_tables_go_to_the_clipboard() {
    let mut harness = harness();
    for (command, is_image) in [(Action::CopyPlot(PaneId::Dolp), true), (Action::CopyTable, false)] {
        explorer(&mut harness).actions.push(command);
        harness.step();
        let commands = &harness.output().platform_output.commands;
        let found = commands.iter().any(|command| match command {
            egui::OutputCommand::CopyImage(image) => {
                is_image && image.width() > 500 && image.pixels.iter().any(|pixel| *pixel != egui::Color32::WHITE)
            }
            egui::OutputCommand::CopyText(text) => {
                !is_image && text.starts_with("row\tmask\tθi / °\tθr / °\tΔφ / °\tDoLP\tDoLP ± s.d.\tDoLP model\tDoLP residual")
            }
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
    assert_eq!(explorer(&mut harness).work.active().sha256, None);
    order(&mut harness, Action::OpenMeasurements(vec![path]));
    assert_eq!(explorer(&mut harness).work.active().sha256, Some(crate::files::export::sha256(text.as_bytes())));
}
