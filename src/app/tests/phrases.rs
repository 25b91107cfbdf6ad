//! What the core says in English is said in Chinese: its errors, its verdicts, the names in its reports.

use crate::app::shell::app::App;
use crate::app::shell::benchmarks::{BenchmarkId, BenchmarkResult};
use crate::app::shell::commands::Command;
use crate::app::storage::export::ExportKind;
use crate::app::storage::session::{Session, SessionError};
use crate::app::tests::sources::{literal, literals_after, sources};
use crate::app::tests::{explorer, harness, wait};
use crate::app::text::i18n;
use crate::app::text::i18n::{Language, phrase};
use crate::app::work::document::Document;
use crate::app::work::fit_history::FitEntry;
use crate::app::work::lesson::{Lesson, LessonError, LessonErrorKind};
use crate::export::{picture_kind, report_kind};
use crate::figure::PngError;
use crate::open_file::open_file;
use pbrdf::fit::{BoundsError, DesignError, DistributionComparison, FitResult, ProblemError, StopReason};
use pbrdf::measurement::{
    Column, ColumnChoice, Field, MappedColumn, Mapping, MappingError, ReadError, ReadErrorKind, TensorError, TensorErrorKind, Unit,
    WavelengthError, read, read_mapped, read_woollam, tensor_from_bytes,
};
use pbrdf::model::{AssignmentError, Domain, FINISHES, PRESETS, Parameter, ParameterError, Preset, assignments_from_text};
use pbrdf::optics::{GeometryError, MetalsError, MetalsErrorKind, OutsideRange, RefractiveIndexError, metals};
use pbrdf::selftest::Host;
use std::fmt::Display;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

/// Words that are the same in Chinese: keys of files and options, names of quantities, units, formats, people and methods.
const SAME: &[&str] = &[
    "AICc",
    "AOI",
    "AVX2",
    "Angstroms",
    "BRDF",
    "Beckmann",
    "DoLP",
    "GGX",
    "Germer",
    "Header",
    "Hyde",
    "JSON",
    "Lambert",
    "Levenberg",
    "Marquardt",
    "Minnaert",
    "NUL",
    "Priest",
    "Sparrow",
    "Thilak",
    "Torrance",
    "UTF",
    "Unicode",
    "Wang",
    "Zhu",
    "about",
    "account",
    "aoi",
    "benches",
    "bounds",
    "brdf",
    "brdf_sigma",
    "callgrind",
    "condition",
    "cos",
    "cost",
    "csv",
    "degrees",
    "delta",
    "depolarisation",
    "dolp",
    "dolp_percent",
    "dolp_sigma",
    "dphi",
    "dpi",
    "dpolE",
    "elapsed_ms",
    "example",
    "field=column",
    "fraction",
    "high",
    "html",
    "inf",
    "log",
    "masked",
    "max",
    "measurement",
    "minima",
    "model",
    "move",
    "name=low",
    "name=value",
    "nan",
    "null",
    "metal",
    "panes",
    "parameters",
    "percent",
    "phi_d",
    "plan",
    "png",
    "program",
    "psi",
    "rad",
    "radians",
    "range",
    "set",
    "settings",
    "sigma",
    "sin",
    "sigma_psi",
    "sigma_v",
    "soft",
    "source",
    "step",
    "svg",
    "table",
    "tensor_file",
    "textbook_error",
    "theta_d",
    "theta_i",
    "theta_r",
    "title",
    "ulp",
    "valgrind",
    "watch",
    "wavelength",
    "wavelength_nm",
    "why",
    "wvls",
    "yes",
];

/// What is left of English in a text: words outside quotes that are no names and longer than symbols.
pub(crate) fn english(text: &str) -> Vec<String> {
    let mut rest = String::new();
    for (i, part) in text.split(['"', '`']).enumerate() {
        if i % 2 == 0 {
            rest.push_str(part);
        }
        rest.push(' ');
    }
    let words = rest.split(|letter: char| !(letter.is_ascii_alphanumeric() || "_=".contains(letter)));
    let is_english = |word: &&str| {
        let letters = word.chars().filter(char::is_ascii_alphabetic).count();
        letters > 2 && !SAME.contains(word) && !word.starts_with("1e") && word.chars().all(|c| c.is_ascii_alphabetic() || c == '_')
    };
    words.filter(is_english).map(str::to_owned).collect()
}

fn chinese() {
    i18n::install();
    i18n::set(Language::Chinese);
}

/// Texts of the core that stay in English, wholly or in part.
fn untranslated(texts: impl IntoIterator<Item = String>) -> Vec<String> {
    chinese();
    let left = |text: String| {
        let said = phrase(&text);
        let words = english(&said);
        (!words.is_empty()).then(|| format!("{text}\n  {said}\n  {words:?}"))
    };
    texts.into_iter().filter_map(left).collect()
}

fn says<E: Display>(errors: impl IntoIterator<Item = E>) -> Vec<String> {
    errors.into_iter().map(|error| error.to_string()).collect()
}

/// Two forms in one: with the place in a file's tree, and without.
const BOTH_FORMS: [(&str, [&str; 2]); 1] = [(
    "line {line}, column {column}{at}: {reason}",
    ["line {line}, column {column}: {reason}", "line {line}, column {column}, {at}: {reason}"],
)];

#[test]
fn every_form_of_an_error_is_in_the_catalogue() {
    let all = sources("src");
    let mut forms: Vec<String> = all.iter().flat_map(|(_, source)| literals_after(source, "#[error(")).collect();
    assert!(forms.len() > 80, "{}", forms.len());
    forms.retain(|form| form.replace(":?}", "}").split(['{', '}']).step_by(2).any(|own| !own.is_empty()));
    for (both, single) in BOTH_FORMS {
        forms.retain(|form| form != both);
        forms.extend(single.map(str::to_owned));
    }
    let missing: Vec<String> = forms.into_iter().filter(|form| !i18n::has_phrase(&form.replace(":?}", "}"))).collect();
    assert!(missing.is_empty(), "not in assets/locales/zh_CN.core.po: {missing:#?}");
}

#[test]
fn errors_of_tables_are_said_in_chinese() {
    let text = || "x".to_owned();
    let kinds = || {
        use ReadErrorKind as E;
        vec![
            E::Empty,
            E::HeaderOnly,
            E::NoHeader { found: text() },
            E::MissingColumn { name: "theta_i", similar: None },
            E::MissingColumn { name: "theta_i", similar: Some("Theta_I".to_owned()) },
            E::NoQuantity { names: "dolp, brdf".to_owned() },
            E::RepeatedColumn { first: 1 },
            E::RowLength { found: 2, expected: 3 },
            E::EmptyCell { expected: "0 or 1" },
            E::NoData,
            E::SigmaWithoutValue,
            E::NotANumber { found: text(), expected: "0 or 1" },
            E::OutOfRange { found: text(), expected: "0 or 1".to_owned() },
            E::NegativeThetaR { found: "-3".to_owned(), dphi: 90.0 },
            E::EmptyText,
            E::Unexpected { found: text(), expected: "0 or 1" },
            E::Numbers { found: 5, expected: "4, or 6 with standard deviations" },
            E::NoPsi,
            E::UnknownColumn { field: "dolp", found: "\"x\"".to_owned(), names: "dolp, brdf".to_owned() },
            E::UnknownColumn { field: "dolp", found: "number 7".to_owned(), names: "dolp, brdf".to_owned() },
            E::NotMapped { field: "theta_i" },
            E::NotMapped { field: "dolp or brdf" },
            E::Nul,
            E::Utf16,
            E::UnclosedQuote,
            E::Cancelled,
        ]
    };
    let column = |name: &str| Some(Column { number: 2, name: name.to_owned() });
    let at = |line| move |kind| ReadError { line, column: None, kind };
    let mut texts = says(kinds().into_iter().map(at(None)));
    texts.extend(says(kinds().into_iter().map(at(Some(3)))));
    texts.extend(kinds().into_iter().map(|kind| ReadError { line: Some(3), column: column(""), kind }.to_string()));
    texts.extend(kinds().into_iter().map(|kind| ReadError { line: Some(3), column: column("dolp"), kind }.to_string()));
    let left = untranslated(texts);
    assert!(left.is_empty(), "{}", left.join("\n"));
}

/// Tables and other files that are each damaged in a way of their own.
fn damaged_files() -> Vec<String> {
    let mut going_on = |_: f64| ControlFlow::Continue(());
    let mut texts = Vec::new();
    for cells in
        ["x,0,0.5,1,0", "90,0,0.5,1,0", "10,95,0.5,1,0", "10,0,2,1,0", "10,0,0.5,-1,0", "10,0,0.5,1,2", ",0,0.5,1,0", "10,nan,0.5,1,0"]
    {
        let table = format!("theta_i,theta_r,dolp,brdf,masked\n{cells}\n");
        texts.push(read(table.as_bytes(), &mut going_on).expect_err(cells).to_string());
    }
    for cells in ["10,0,inf,50,1", "10,0,180,120,1", "10,0,180,50,0", "10,0,180,50,x"] {
        let table = format!("theta_i,theta_r,dphi,dolp_percent,dolp_sigma\n{cells}\n");
        texts.push(read(table.as_bytes(), &mut going_on).expect_err(cells).to_string());
    }
    let column = |field, number, unit| MappedColumn { field, column: ColumnChoice::Number(number), unit };
    let mapping =
        Mapping { columns: vec![column(Field::ThetaI, 1, Unit::Usual), column(Field::ThetaR, 9, Unit::Usual)], ..Mapping::default() };
    texts.push(read_mapped(&b"a,b,c\n1,2,3\n"[..], &mapping, &mut going_on).expect_err("no ninth column").to_string());
    for rows in [
        "nm\n0 55 43 160",
        "nm\n650 95 43 160",
        "nm\n650 55 99 160",
        "nm\n650 55 43 x",
        "nm\n650 55 43 160 -1 1",
        "nm\ndpolE 650 55 x",
        "nm\n650 55 43",
        "nm\ndpolE 650 55",
        "nm\n?",
        "sample\n1 2 3 4",
        " ",
        "nm\n",
    ] {
        texts.push(read_woollam(rows.as_bytes(), &mut going_on).expect_err(rows).to_string());
    }
    texts
}

#[test]
fn what_is_expected_of_damaged_files_is_said_in_chinese() {
    let left = untranslated(damaged_files());
    assert!(left.is_empty(), "{}", left.join("\n"));
}

#[test]
fn errors_of_tensors_mappings_and_wavelengths_are_said_in_chinese() {
    use TensorErrorKind as E;
    let kinds = || {
        vec![
            E::NoTensor,
            E::Version(2, 1),
            E::Truncated { expected: 12, found: 7 },
            E::TooMany { what: "the length of a name", found: 99, most: 64 },
            E::TooMany { what: "the number of dimensions", found: 99, most: 8 },
            E::TooMany { what: "the number of fields", found: 99, most: 64 },
            E::TooMany { what: "the number of angles", found: 99, most: 64 },
            E::Missing,
            E::Type { found: 4, expected: "10 (f32)" },
            E::Shape { found: "3 × 4".to_owned(), expected: "1 × the number of angles".to_owned() },
            E::Shape { found: "3 × 4".to_owned(), expected: "the number of wavelengths".to_owned() },
            E::Shape { found: "3 × 4".to_owned(), expected: "3 × 5".to_owned() },
            E::Grid { index: 3, found: -1.5, expected: "angles in radians, within ±π" },
            E::Grid { index: 3, found: 0.0, expected: "wavelengths in nm" },
        ]
    };
    let mut texts = Vec::new();
    for (byte, field) in [(None, None), (Some(12), None), (None, Some("wvls")), (Some(12), Some("wvls"))] {
        texts.extend(kinds().into_iter().map(|kind| TensorError { byte, field: field.map(str::to_owned), kind }.to_string()));
    }
    texts.push(tensor_from_bytes(b"tensor_file\0\x01\0\xff\0\0\0".to_vec()).expect_err("too many fields").to_string());
    texts.extend(says([MappingError::Form("x".to_owned()), MappingError::Field("x".to_owned()), MappingError::Repeated("dolp")]));
    texts.extend(
        ["theta_i=1:percent", "brdf=1:percent", "dolp=1:radians"].map(|text| Mapping::from_text(text).expect_err(text).to_string()),
    );
    let many: Vec<f64> = (400..=420).map(f64::from).collect();
    for available_nm in [Vec::new(), vec![450.0, 650.0], many] {
        texts.push(WavelengthError::NotChosen { count: available_nm.len(), available_nm: available_nm.clone() }.to_string());
        texts.push(WavelengthError::Outside { wanted_nm: 900.0, available_nm }.to_string());
    }
    let left = untranslated(texts);
    assert!(left.is_empty(), "{}", left.join("\n"));
}

#[test]
fn errors_of_parameters_problems_and_lessons_are_said_in_chinese() {
    let mut texts = Vec::new();
    for text in ["hello", "m=3", "n=abc", "k=-2", "q=1", "c=inf", "sigma=0", "n=1, n=2"] {
        texts.push(assignments_from_text(text).expect_err(text).to_string());
        texts.push(Lesson::from_text(&format!("title: a\nstep: b\nset: {text}")).expect_err(text).to_string());
    }
    let (n, low, high) = (Parameter::N, 0.5, 1.5);
    texts.extend(says([AssignmentError::Outside { parameter: n, value: -1.0, expected: Domain::Finite }]));
    texts.extend(says([ParameterError::NoIndex, ParameterError::Outside { parameter: n, value: -1.0 }]));
    texts.extend(says([BoundsError::Order { parameter: n, low, high }, BoundsError::Domain { parameter: n, value: -1.0 }]));
    let problems = [
        ProblemError::MissingSigma { row: 3, quantity: "dolp" },
        ProblemError::NothingToPredict,
        ProblemError::StartOutsideBounds { parameter: n, value: 3.0, low, high },
    ];
    texts.extend(says(problems.iter()));
    texts.push(DesignError::Parameters(ParameterError::NoIndex).to_string());
    texts.push(DesignError::Problem(ProblemError::NothingToPredict).to_string());
    texts.extend(says([RefractiveIndexError::N(-1.0), RefractiveIndexError::K(-1.0), RefractiveIndexError::Zero]));
    texts.extend(says([
        GeometryError::ThetaI(95.0),
        GeometryError::ThetaR(95.0),
        GeometryError::SignedThetaR(95.0),
        GeometryError::Dphi(f64::INFINITY),
    ]));
    for text in [
        "hello",
        "  indented",
        "title: a\nstep: b\nmodel: phong",
        "title: a\nstep: b\ntheta_i: 90",
        "title: a\nstep: b\ndphi: inf",
        "title: a\nstep: b\nmetal: Xx",
        "title: a\nstep: b\nwavelength: red",
        "title: a\nstep: b\nlog: maybe",
        "title: a\nstep: b\nwatch: c\nwatch: d",
        "title: a\nstep: b\nlog.zh: yes",
        "title: a\nstep: b\nwhy:",
        "title: a\nwhy: b",
        "title: a\nstep: b\nwhat: b",
        "title: a",
        "step: a",
    ] {
        texts.push(Lesson::from_text(text).expect_err(text).to_string());
    }
    for range in ["k", "k=3..0", "m=0..1", "k=a..b"] {
        texts.push(Lesson::from_text(&format!("title: a\nstep: b\nrange: {range}")).expect_err(range).to_string());
    }
    texts.push(LessonError { line: 1, kind: LessonErrorKind::NoStep }.to_string());
    let left = untranslated(texts);
    assert!(left.is_empty(), "{}", left.join("\n"));
}

#[test]
fn errors_of_metals_and_pictures_are_said_in_chinese() {
    let text = || "x".to_owned();
    let mut texts = says([OutsideRange { wavelength_nm: 2000.0, range_nm: (200.0, 1000.0) }]);
    let kinds = vec![
        MetalsErrorKind::Header { found: text() },
        MetalsErrorKind::Parts { found: 2, expected: 4 },
        MetalsErrorKind::StrayHead { found: text() },
        MetalsErrorKind::Repeated { found: text() },
        MetalsErrorKind::Cells { found: 3 },
        MetalsErrorKind::UnknownSource { found: text() },
        MetalsErrorKind::Number { column: "wavelength_nm", found: text() },
        MetalsErrorKind::Wavelength { found: 400.0, before: 500.0 },
        MetalsErrorKind::NoSamples(text()),
        MetalsErrorKind::Empty,
    ];
    texts.extend(kinds.into_iter().map(|kind| MetalsError { line: 3, kind }.to_string()));
    texts.push(PngError::Size { width_mm: 1e9, height_mm: 10.0, dpi: 300.0 }.to_string());
    texts
        .extend(says([picture_kind(Path::new("1.bmp")).expect_err("no picture"), report_kind(Path::new("1.pdf")).expect_err("no report")]));
    texts.push(open_file(Path::new("/")).expect_err("a directory"));
    texts.push(open_file(Path::new("/there is none")).expect_err("no file"));
    texts.extend(says([std::fs::read("/there is none").expect_err("no file")]));
    let left = untranslated(texts.into_iter().map(|text| text.replace("1.bmp", "").replace("1.pdf", "")));
    assert!(left.is_empty(), "{}", left.join("\n"));
}

#[test]
fn damaged_sessions_are_refused_in_chinese() {
    let head = "\"format\":\"pbrdf-session\",\"version\":";
    let mut texts = Vec::new();
    for text in [
        String::new(),
        "{".to_owned(),
        "{\"a\"".to_owned(),
        "[".to_owned(),
        "[1 2]".to_owned(),
        "x".to_owned(),
        "{} {}".to_owned(),
        "3".to_owned(),
        "{\"format\":3}".to_owned(),
        "{\"format\":\"x".to_owned(),
        "{\"a\":1,}".to_owned(),
        "{1:2}".to_owned(),
        "{}".to_owned(),
        format!("{{{head}2}}"),
        format!("{{{head}1}}"),
        format!("{{{head}true}}"),
        format!("{{{head}-1}}"),
        format!("{{{head}1,\"program\":null}}"),
        format!("{{{head}1,\"settings\":{{\"theta_i\":\"x\"}}}}"),
    ] {
        texts.push(Session::read(&text).expect_err(&text).to_string());
    }
    texts.push(SessionError::Settings("parameters: n = -1 is not allowed: expected a finite number ≥ 0".to_owned()).to_string());
    texts.push(SessionError::Settings("theta_i, dphi: theta_i = 95 is outside 0 ≤ θi < 90 degrees".to_owned()).to_string());
    let faults = literals_after(include_str!("../storage/fit_record.rs"), "Some(");
    texts.extend(faults.into_iter().filter(|fault| fault.starts_with("account")));
    texts.push(SessionError::Fit { number: 2, reason: ProblemError::NothingToPredict.to_string() }.to_string());
    let left = untranslated(texts);
    assert!(left.is_empty(), "{}", left.join("\n"));
}

#[test]
fn the_verdict_of_gauss_against_cauchy_is_said_in_chinese() {
    let mut texts = Vec::new();
    for aicc_gain in [None, Some(-20.0), Some(-5.0), Some(-3.0), Some(-1.0), Some(1.0), Some(3.0), Some(5.0), Some(20.0)] {
        for (gauss, cauchy) in [(1.0, 1.0), (2.0, 1.0), (1.0, 2.0), (1.0, 0.0), (0.0, 1.0)] {
            for is_delta_e in [true, false] {
                texts.push(DistributionComparison { gauss, cauchy, aicc_gain, is_delta_e }.text());
            }
        }
    }
    let left = untranslated(texts);
    assert!(left.is_empty(), "{}", left.join("\n"));
    let contest = DistributionComparison { gauss: 2.0, cauchy: 1.0, aicc_gain: Some(20.0), is_delta_e: true };
    assert_eq!(phrase(&contest.text()), "柯西优于高斯：ΔE 小至 1/2.0000；柯西的 AICc 低 20.0：另一个基本得不到支持。");
}

#[test]
fn what_stays_open_keeps_its_parameters_in_chinese() {
    chinese();
    for (english, chinese) in [
        ("q has no effect on these data", "q 对这些数据没有影响"),
        ("n and k trade off: these data fix a combination of them, not each", "n 与 k 相互补偿：这些数据只确定其组合，而非各自的值"),
        ("n, k, σ together: these data fix combinations of them, not each", "n, k, σ 一起：这些数据只确定其组合，而非各自的值"),
        ("something else", "something else"),
    ] {
        assert_eq!(phrase(english), chinese);
    }
}

#[test]
fn names_of_models_finishes_metals_and_ends_of_fits_are_there_in_chinese() {
    let mut texts: Vec<String> = PRESETS.iter().map(|preset| preset.name.to_owned()).collect();
    texts.extend(FINISHES.iter().map(|finish| finish.name.to_owned()));
    texts.extend(metals().expect("the bundled table").iter().map(|metal| metal.name.clone()));
    use StopReason as S;
    let ends =
        [S::Converged, S::ResidualsZero, S::NoImprovement, S::EvaluationLimit, S::Cancelled, S::Underdetermined, S::NoData, S::Numerical];
    texts.extend(ends.map(|end| end.text().to_owned()));
    let left = untranslated(texts);
    assert!(left.is_empty(), "{}", left.join("\n"));
}

#[test]
fn cases_scenes_and_methods_of_the_reports_are_there_in_chinese() {
    let gallery = include_str!("../../../core/assets/reference/stability_gallery.csv");
    let mut texts: Vec<String> = gallery.lines().filter_map(literal).collect();
    assert!(texts.len() > 40, "{}", texts.len());
    let fits = include_str!("../../../core/src/selftest/stability_fits.rs");
    texts.extend(literals_after(fits.split("impl Bar").next().unwrap_or_default(), "Self::new("));
    texts.push("converged, ΔE 1.2e-30, 2 directions open".to_owned());
    let cost = include_str!("../../../core/src/selftest/cost.rs");
    texts.extend(["name: ", "left_out: ", "gauss = "].iter().flat_map(|key| literals_after(cost, key)));
    texts.extend(literals_after(include_str!("../../../core/src/selftest/accuracy_vs_time.rs"), "Method { name: "));
    for kind in ["analytic Jacobian, scaled", "finite-difference Jacobian, unscaled"] {
        for starts in ["one start", "5 starts"] {
            texts.push(format!("Levenberg–Marquardt, {kind}, {starts}"));
            texts.push(format!("LM, {}, {starts}", kind.replace(" Jacobian", "").replace("finite-difference", "differences")));
        }
    }
    texts.extend(["this program, one start", "this program, many starts", "this program, 5 starts"].map(str::to_owned));
    assert!(texts.len() > 100, "{}", texts.len());
    let left = untranslated(texts);
    assert!(left.is_empty(), "{}", left.join("\n"));
}

#[test]
fn notes_under_the_reports_are_said_in_chinese() {
    let looks = AtomicU32::new(0);
    let clock = || 10.0 * f64::from(looks.fetch_add(1, Ordering::Relaxed));
    for subject in BenchmarkId::ALL {
        // Evaluations alone, which have spreads, since fits take long.
        let asked = AtomicU32::new(0);
        let cancelled = || asked.fetch_add(1, Ordering::Relaxed) >= 5;
        let made = subject.make(Host { clock: &clock, cancelled: &cancelled, progress: &|_| {} });
        let notes = match made {
            BenchmarkResult::ErrorVsTime(report) => report.notes,
            BenchmarkResult::Stability(report) => report.notes,
            BenchmarkResult::Cost(report) => report.notes,
        };
        assert!(notes.len() > 1, "{subject:?}");
        let left = untranslated(notes);
        assert!(left.is_empty(), "{}", left.join("\n"));
    }
}

/// The texts of an HTML file outside its figures, with those of its figures as they are read out.
fn texts_of(html: &str) -> Vec<String> {
    let body = &html[html.find("<body>").expect("a body")..html.find("</html>").expect("an end")];
    let document = roxmltree::Document::parse(body).expect("XML");
    let said = |node: roxmltree::Node<'_, '_>| node.text().or(node.attribute("aria-label")).map(str::to_owned);
    document.descendants().filter_map(said).collect()
}

#[test]
fn the_report_of_a_fit_is_in_chinese_where_the_window_is() {
    let mut harness = harness();
    explorer(&mut harness).commands.push(Command::SetLanguage(Language::Chinese));
    let folder = tempfile::tempdir().expect("a folder");
    for (example, model) in [(0, "hyde"), (1, "cauchy"), (1, "three-component")] {
        explorer(&mut harness).commands.push(Command::OpenExample(example));
        wait(&mut harness);
        explorer(&mut harness).work.settings.model = Preset::from_key(model).expect("a model").model;
        explorer(&mut harness).commands.push(Command::StartFit);
        wait(&mut harness);
        let path = folder.path().join("report.html");
        let mut left = Vec::new();
        // The second time it does not know how it came about, like one out of an old session.
        for _ in 0..2 {
            ExportKind::Report.taken_from(explorer(&mut harness)).expect("a report")(&path).expect("a file");
            left.extend(english_in(&std::fs::read_to_string(&path).expect("the file"), &explorer(&mut harness).work.document));
            without_account(explorer(&mut harness));
        }
        assert!(left.is_empty(), "{model}: {left:#?}");
    }
}

/// The fit that is shown without an account of how it came about.
fn without_account(explorer: &mut App) {
    let fit = explorer.work.shown_fit.as_ref().expect("a fit");
    let report = FitResult { minima: Vec::new(), ..fit.report.clone() };
    let FitEntry { id, ref problem, before, ref document, number, generation, ref mask, .. } = **fit;
    let (problem, document, mask) = (problem.clone(), document.clone(), mask.clone());
    explorer.work.shown_fit = Some(Arc::new(FitEntry { id, report, problem, before, document, number, generation, mask }));
}

/// What is English in the report of a fit.
fn english_in(html: &str, document: &Document) -> Vec<String> {
    assert!(html.contains("lang=\"zh-CN\"") && html.contains("数据未能确定的量"));
    // What stands in the data's file, its name, and literature stay as they are.
    let quoted = |text: &str| {
        document.measurement.metadata.iter().any(|(key, value)| key == text || value == text)
            || PRESETS.iter().any(|preset| preset.citation == text)
            || text.starts_with("pbrdf-explorer")
    };
    let texts = texts_of(html).into_iter().map(|text| text.replace(&document.name, "")).filter(|text| !quoted(text));
    texts.filter(|text| !english(text).is_empty()).collect()
}

#[test]
fn every_part_of_a_phrase_is_in_its_translation() {
    let torn = i18n::torn_phrases();
    assert!(torn.is_empty(), "{torn:#?}");
}
