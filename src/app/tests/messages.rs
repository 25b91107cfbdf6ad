//! Messages of the core and the program in both languages.

use crate::app::shell::app::App;
use crate::app::storage::export::ExportKind;
use crate::app::storage::fit_record::FitRecordError;
use crate::app::storage::session::Session;
use crate::app::storage::session_error::SavedFitError;
use crate::app::tasks::benchmarks::{BenchmarkId, BenchmarkResult};
use crate::app::tests::languages::is_english;
use crate::app::tests::{explorer, harness, wait};
use crate::app::text::i18n;
use crate::app::text::i18n::{Language, MISSED, translated};
use crate::app::text::localized::Localized;
use crate::app::text::messages::{advised, short_method};
use crate::app::views::action::{Action, WindowAction};
use crate::app::work::fit_history::FitEntry;
use crate::app::work::lesson::Lesson;
use crate::app::work::lesson_error::{LessonError, LessonErrorKind};
use crate::app::work::open_measurement::OpenMeasurement;
use crate::app::work::settings_error::SettingsError;
use crate::figure::PngError;
use crate::files::export::{expect_ending, picture_kind, report_kind};
use crate::files::open_file::{OpenError, open_file};
use pbrdf::fit::{
    BoundsError, DesignError, DistributionComparison, ProblemError, StopReason, Undetermined, UndeterminedDirection, UndeterminedReason,
};
use pbrdf::measurement::foreign::{Doubt, OtherFormat};
use pbrdf::measurement::formats::{
    ImportError, ImportNote, TensorAxis, TensorCount, TensorError, TensorErrorKind, TensorShape, TensorType,
};
use pbrdf::measurement::{
    ColumnChoice, ColumnPlace, Expected, Field, Hint, LineList, Measurement, ReadError, ReadErrorKind, WavelengthError,
};
use pbrdf::model::{Check, Domain, FINISHES, Finding, PRESETS, Parameter, ParameterError, Preset, assignments_from_text};
use pbrdf::optics::{GeometryError, metals};
use pbrdf::selftest::{BenchmarkMethod, Cost, Host, Machine, Stability, StabilityOutcome};
use std::path::Path;
use std::sync::atomic::{AtomicU32, Ordering};

fn chinese() {
    i18n::install();
    i18n::set(Language::Chinese);
}

/// The catalogue has every text that the window says of the messages.
fn assert_localized<M: Localized>(messages: impl IntoIterator<Item = M>) {
    chinese();
    messages.into_iter().for_each(|message| _ = message.localized());
    assert_found();
}

/// No text was looked up in vain.
fn assert_found() {
    let missed = MISSED.with_borrow(Clone::clone);
    assert!(missed.is_empty(), "not in assets/locales/zh_CN.po: {missed:#?}");
}

#[test]
fn errors_of_tables_are_said_in_chinese() {
    let text = || "x".to_owned();
    let names = || vec!["dolp".to_owned(), "brdf".to_owned()];
    let kinds = || {
        use ReadErrorKind as E;
        vec![
            E::Empty,
            E::HeaderOnly,
            E::NoHeader { found: text() },
            E::MissingColumn { name: "theta_i", similar: None },
            E::MissingColumn { name: "theta_i", similar: Some("Theta_I".to_owned()) },
            E::NoQuantity { names: names() },
            E::RepeatedColumn { first: 1 },
            E::RowLength { found: 2, expected: 3, separator: ',' },
            E::EmptyCell { expected: Expected::Mask },
            E::NoData,
            E::TwoDecimalMarks { found: text(), other: text(), other_line: 2 },
            E::NotANumber { found: text(), expected: Expected::Mask },
            E::OutOfRange { found: text(), expected: Expected::Mask },
            E::NegativeThetaR { found: "-3".to_owned(), dphi: 90.0 },
            E::EmptyText,
            E::Unexpected { found: text(), expected: Expected::Mask },
            E::Numbers { found: 5, without_sigmas: 4, with_sigmas: 6 },
            E::NoPsi,
            E::UnknownColumn { field: Field::Dolp, found: ColumnChoice::Name("x".to_owned()), names: names() },
            E::UnknownColumn { field: Field::Dolp, found: ColumnChoice::Number(7), names: names() },
            E::NoNumbers,
            E::LongCell { bytes: 70_000 },
            E::FortranExponent { found: text() },
            E::Nul,
            E::Utf16,
            E::UnclosedQuote,
            E::Cancelled,
        ]
    };
    let column = |name: &str| Some(ColumnPlace { number: 2, name: name.to_owned() });
    let at = |line| move |kind| ReadError { line, column: None, kind };
    assert_localized(kinds().into_iter().map(at(None)));
    assert_localized(kinds().into_iter().map(at(Some(3))));
    assert_localized(kinds().into_iter().map(|kind| ReadError { line: Some(3), column: column(""), kind }));
    assert_localized(kinds().into_iter().map(|kind| ReadError { line: Some(3), column: column("dolp"), kind }));
}

#[test]
fn what_is_expected_and_what_helps_is_said_in_chinese() {
    use Expected as E;
    assert_localized([
        E::FiniteNumber,
        E::Parameter(Domain::Between(0.0, 1.0)),
        E::Parameter(Domain::ZeroOrBetween(0.5, 1.0)),
        E::Index,
        E::Distribution,
        E::Angle,
        E::ModelThetaI,
        E::ModelThetaR,
        E::ThetaI,
        E::ThetaR,
        E::Dphi,
        E::Dolp,
        E::DolpPercent,
        E::Brdf,
        E::Sigma,
        E::Mask,
        E::Wavelength,
        E::Psi,
        E::Delta,
        E::SigmaOrZero,
        E::Depolarisation,
        E::WoollamRow,
        E::WavelengthUnit,
        E::PolarAngle,
        E::Line("1 2 3"),
    ]);
    use Hint as H;
    assert_localized([
        H::Import,
        H::NameDolpPercent,
        H::PercentOrLeaveOut,
        H::LeaveOut,
        H::SaveAsUtf8,
        H::NameThousands('.'),
        H::SeparateBySemicolons,
    ]);
    let error = Measurement::read(&b"theta_i,theta_r,dolp\n10,0,50\n"[..]).expect_err("percent");
    assert_eq!(
        advised(&error, error.hint()),
        "第 2 行第 3 列（dolp）：读到 50，应为0 至 1 的 DoLP（若此列为百分数，请命名为 dolp_percent）"
    );
    assert_localized([
        ImportNote::IgnoredColumns { names: vec![String::new()] },
        ImportNote::IgnoredColumns { names: vec!["a".to_owned(), "b".to_owned()] },
        ImportNote::NotMeasured(LineList { count: 7, first: vec![1, 2, 3, 4, 5] }),
        ImportNote::BeyondHorizon(LineList { count: 1, first: vec![1] }),
        ImportNote::BlankRows(LineList { count: 2, first: vec![1, 2] }),
        ImportNote::SkippedLines(LineList { count: 1, first: vec![9] }),
        ImportNote::ZeroSigma(LineList { count: 1, first: vec![9] }),
        ImportNote::BiasedDolp(LineList { count: 1, first: vec![9] }),
        ImportNote::TakenAsPercent { name: "P".to_owned() },
        ImportNote::NormalisedElements,
        ImportNote::WrappedAngles,
        ImportNote::NegativeIncidence,
        ImportNote::AllBackscatter,
        ImportNote::FilledDown,
        ImportNote::IgnoredRows { name: "a".to_owned(), count: 2 },
        ImportNote::DepolarisationNotApplied { count: 2 },
        ImportNote::NearestWavelength { wanted_nm: 650.0, taken_nm: vec![649.5] },
        ImportNote::NoWavelengthNear { theta_i: 30.0 },
        ImportNote::AssumedGrids { names: vec!["theta_h"] },
        ImportNote::NoValue { count: 1 },
        ImportNote::Transmission { count: 1 },
        ImportNote::BrdfBelowZero { count: 1 },
        ImportNote::DolpAboveOne { count: 1 },
    ]);
}

#[test]
fn errors_of_tensors_and_wavelengths_are_said_in_chinese() {
    use TensorErrorKind as E;
    let kinds = || {
        vec![
            E::NoTensor,
            E::Version(2, 1),
            E::Truncated { expected: 12, found: 7 },
            E::TooMany { what: TensorCount::NameLength, found: 99, most: 64 },
            E::TooMany { what: TensorCount::Dimensions, found: 99, most: 8 },
            E::TooMany { what: TensorCount::Fields, found: 99, most: 64 },
            E::TooMany { what: TensorCount::Angles, found: 99, most: 64 },
            E::Missing,
            E::Type { found: 4, expected: TensorType::F32 },
            E::Shape { found: vec![3, 4], expected: TensorShape::Angles },
            E::Shape { found: vec![3, 4], expected: TensorShape::Wavelengths },
            E::Shape { found: vec![3, 4], expected: TensorShape::Matrices([3, 5, 2, 1, 4, 4]) },
            E::Grid { index: 3, found: -1.5, expected: TensorAxis::Angles },
            E::Grid { index: 3, found: 0.0, expected: TensorAxis::Wavelengths },
        ]
    };
    for (byte, field) in [(None, None), (Some(12), None), (None, Some("wvls")), (Some(12), Some("wvls"))] {
        assert_localized(kinds().into_iter().map(|kind| TensorError { byte, field: field.map(str::to_owned), kind }));
    }
    let many: Vec<f64> = (400..=420).map(f64::from).collect();
    for available_nm in [Vec::new(), vec![450.0, 650.0], many] {
        let not_chosen = WavelengthError::NotChosen { count: available_nm.len(), available_nm: available_nm.clone() };
        assert_localized([not_chosen, WavelengthError::Outside { wanted_nm: 900.0, available_nm }]);
    }
    let names = || vec!["a".to_owned(), "b".to_owned()];
    let columns = vec![(1, "a".to_owned()), (2, "b".to_owned())];
    assert_localized([
        ImportError::NoValue { notes: Vec::new() },
        ImportError::NoThetaI,
        ImportError::OtherFormat(OtherFormat { name: "an XML document", advice: "save it", options: None }),
        ImportError::Workbook { reason: "it is damaged".to_owned() },
        ImportError::NoSheet { wanted: String::new(), names: names() },
        ImportError::NoSheet { wanted: "c".to_owned(), names: names() },
        ImportError::Undecided {
            doubts: vec![
                Doubt::NoHeader { columns: 3 },
                Doubt::NoAngle { field: Field::ThetaI, names: names() },
                Doubt::NoAngle { field: Field::ThetaR, names: names() },
                Doubt::NoQuantity { names: names() },
                Doubt::WideQuantity { names: names() },
                Doubt::Several { field: Field::Dolp, columns },
                Doubt::BrdfMeaning { name: "R".to_owned() },
                Doubt::MuellerCount,
            ],
        },
    ]);
}

#[test]
fn errors_of_parameters_problems_and_lessons_are_said_in_chinese() {
    for text in ["hello", "m=3", "n=abc", "k=-2", "q=1", "c=inf", "sigma=0", "n=1, n=2"] {
        assert_localized([assignments_from_text(text).expect_err(text)]);
        assert_localized(Lesson::from_text(&format!("title: a\nstep: b\nset: {text}")).err());
    }
    let (n, low, high) = (Parameter::N, 0.5, 1.5);
    assert_localized([ParameterError::NoIndex, ParameterError::Outside { parameter: n, value: -1.0 }]);
    assert_localized([BoundsError::Order { parameter: n, low, high }, BoundsError::Domain { parameter: n, value: -1.0 }]);
    let problems = [
        ProblemError::MissingSigma { row: 3, quantity: "dolp" },
        ProblemError::NothingToPredict,
        ProblemError::StartOutsideBounds { parameter: n, value: 3.0, low, high },
    ];
    assert_localized(problems);
    assert_localized([DesignError::Parameters(ParameterError::NoIndex), DesignError::Problem(ProblemError::NothingToPredict)]);
    assert_localized([
        GeometryError::ThetaI(95.0),
        GeometryError::ThetaR(95.0),
        GeometryError::SignedThetaR(95.0),
        GeometryError::Dphi(f64::INFINITY),
    ]);
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
        assert_localized(Lesson::from_text(text).err());
    }
    for range in ["k", "k=3..0", "m=0..1", "k=a..b"] {
        assert_localized(Lesson::from_text(&format!("title: a\nstep: b\nrange: {range}")).err());
    }
    assert_localized([LessonError { line: 1, kind: LessonErrorKind::NoStep }]);
}

#[test]
fn errors_of_files_and_pictures_are_said_in_chinese() {
    assert_localized([PngError::Size { width_mm: 1e9, height_mm: 10.0, dpi: 300.0 }]);
    let endings = [picture_kind(Path::new("1")).expect_err("no picture"), report_kind(Path::new("1")).expect_err("no report")];
    assert_localized(endings.into_iter().chain([expect_ending(Path::new("1"), "csv").expect_err("no table")]));
    let refused = std::io::Error::from(std::io::ErrorKind::StorageFull);
    assert_localized([
        open_file(Path::new("/")).expect_err("a directory"),
        open_file(Path::new("/there is none")).expect_err("no file"),
        OpenError::Denied,
        OpenError::Other(refused),
    ]);
    use std::io::ErrorKind as K;
    let kinds = [K::NotFound, K::PermissionDenied, K::IsADirectory, K::NotADirectory, K::ReadOnlyFilesystem, K::QuotaExceeded];
    assert_localized(kinds.map(std::io::Error::from));
    assert_localized([std::io::Error::other(PngError::Size { width_mm: 1e9, height_mm: 10.0, dpi: 300.0 })]);
}

#[test]
fn damaged_sessions_are_refused_in_chinese() {
    let head = "\"format\":\"pbrdf-session\",\"version\":";
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
        assert_localized(Session::read(&text).err());
    }
    assert_localized([
        SettingsError::Parameters(ParameterError::NoIndex),
        SettingsError::Angles(GeometryError::ThetaI(95.0)),
        SettingsError::OutOfRange("plan"),
    ]);
    assert_localized([SavedFitError::Mask, SavedFitError::Problem(ProblemError::NothingToPredict)]);
    use FitRecordError as R;
    assert_localized([R::Place, R::Starts, R::LossScale, R::BlockWeight, R::Intervals, R::Negative]);
}

#[test]
fn the_verdict_of_gauss_against_cauchy_is_said_in_chinese() {
    let mut texts = Vec::new();
    for aicc_gain in [None, Some(-20.0), Some(-5.0), Some(-3.0), Some(-1.0), Some(1.0), Some(3.0), Some(5.0), Some(20.0)] {
        for (gauss, cauchy) in [(1.0, 1.0), (2.0, 1.0), (1.0, 2.0), (1.0, 0.0), (0.0, 1.0)] {
            for (is_delta_e, is_nested, is_exact) in [(true, true, false), (false, true, false), (true, false, false), (true, true, true)] {
                texts.push(DistributionComparison { gauss, cauchy, aicc_gain, is_delta_e, is_nested, is_exact });
            }
        }
    }
    assert_localized(texts);
    let comparison =
        DistributionComparison { gauss: 2.0, cauchy: 1.0, aicc_gain: Some(20.0), is_delta_e: true, is_nested: true, is_exact: false };
    assert_eq!(comparison.localized(), "柯西优于高斯：ΔE 小至 1/2.0000；柯西的 AICc 低 20.0：另一个基本得不到支持。");
    assert_eq!(
        comparison.to_string(),
        "Cauchy wins over Gauss: ΔE 2.0000 times smaller; AICc lower by 20.0 for Cauchy: essentially no support for the other."
    );
}

#[test]
fn english_is_what_the_core_says() {
    i18n::install();
    for aicc_gain in [None, Some(-5.0), Some(1.0)] {
        for (gauss, cauchy) in [(1.0, 1.0), (2.0, 1.0), (1.0, 2.0), (1.0, 0.0)] {
            for (is_nested, is_exact) in [(true, false), (false, false), (true, true)] {
                let comparison = DistributionComparison { gauss, cauchy, aicc_gain, is_delta_e: true, is_nested, is_exact };
                assert_eq!(comparison.localized(), comparison.to_string());
            }
        }
    }
    for direction in directions() {
        assert_eq!(direction.localized(), direction.to_string());
    }
    for undetermined in [Undetermined::Poorly, Undetermined::Parameters].map(|of| of(vec![Parameter::N, Parameter::K])) {
        assert_eq!(undetermined.localized(), undetermined.to_string());
    }
    let error = ProblemError::MissingSigma { row: 3, quantity: "dolp" };
    assert_eq!(error.localized(), error.to_string());
    for outcome in outcomes() {
        assert_eq!(outcome.localized(), outcome.to_string());
    }
    for method in methods() {
        assert_eq!((method.localized(), short_method(method)), (method.to_string(), method.short_name()));
    }
    for threads in [1, 2] {
        let machine = Machine::new("", threads);
        assert_eq!(machine.localized(), machine.to_string());
    }
}

/// One for each reason.
fn directions() -> Vec<UndeterminedDirection> {
    use Parameter::{K, Kd, Ks, N, Q, Sigma};
    let along = |reason, parameters: &[Parameter]| UndeterminedDirection {
        reason,
        direction: parameters.iter().map(|&parameter| (parameter, 1.0)).collect(),
    };
    vec![
        along(UndeterminedReason::NoEffect, &[Q]),
        along(UndeterminedReason::RatiosOnly, &[Ks, Kd]),
        along(UndeterminedReason::TradeOff, &[N, K]),
        along(UndeterminedReason::TradeOff, &[N, K, Sigma]),
    ]
}

#[test]
fn what_stays_open_keeps_its_parameters_in_chinese() {
    chinese();
    let texts: Vec<String> = directions().iter().map(Localized::localized).collect();
    let expected = [
        "q 对这些数据没有影响",
        "k_s, k_d 一起：只有它们的比值进入 DoLP",
        "n 与 k 相互补偿：这些数据只确定其组合，而非各自的值",
        "n, k, σ 一起：这些数据只确定其组合，而非各自的值",
    ];
    assert_eq!(texts, expected);
}

#[test]
fn names_of_models_finishes_metals_and_ends_of_fits_are_there_in_chinese() {
    chinese();
    PRESETS.iter().for_each(|preset| _ = translated(preset.name));
    FINISHES.iter().for_each(|finish| _ = translated(finish.name));
    metals().expect("the bundled table").iter().for_each(|metal| _ = translated(&metal.name));
    Parameter::ALL.into_iter().for_each(|parameter| _ = [parameter.name(), parameter.help()].map(translated));
    use StopReason as S;
    assert_localized([
        S::Converged,
        S::ResidualsZero,
        S::NoImprovement,
        S::EvaluationLimit,
        S::Cancelled,
        S::Underdetermined,
        S::NoData,
        S::Numerical,
    ]);
}

#[test]
fn findings_of_the_audit_are_said_in_chinese() {
    use Check as C;
    let checks = [
        C::SpecularReciprocity,
        C::DiffuseReciprocity,
        C::VolumeReciprocity,
        C::Reflectance,
        C::FresnelLimit,
        C::Admissibility,
        C::Normalisation,
    ];
    let findings = checks.into_iter().flat_map(|check| [true, false].map(|pass| Finding { check, value: 0.0, bar: 0.0, pass, at: None }));
    assert_localized(findings);
}

fn outcomes() -> Vec<StabilityOutcome> {
    let mut outcomes = vec![StabilityOutcome::NoProblem, StabilityOutcome::Digits { values: 15.3, gradient: 14.0, textbook: 3.25 }];
    for objective in [None, Some(1.2e-30)] {
        for undetermined in 0..3 {
            outcomes.push(StabilityOutcome::Fit { stop_reason: StopReason::Converged, objective, undetermined });
        }
    }
    outcomes
}

fn methods() -> Vec<BenchmarkMethod> {
    use BenchmarkMethod as M;
    let mut methods = vec![M::TextbookF32, M::TextbookF64, M::FromAngles, M::Prepared, M::Batch, M::OneStart, M::ManyStarts];
    methods.push(M::Model("cauchy"));
    for (analytic, scaled, starts) in [(true, true, 1), (false, false, 1), (true, false, 5)] {
        methods.push(M::LevenbergMarquardt { analytic, scaled, starts });
    }
    methods
}

#[test]
fn rows_and_notes_of_the_reports_are_in_chinese() {
    chinese();
    assert_localized(outcomes());
    assert_localized(methods().into_iter().filter(|method| !matches!(method, BenchmarkMethod::Model(_))));
    assert_localized([Machine::new("", 1), Machine::new("", 4)].map(|machine| Machine { processor: String::new(), ..machine }));
    assert_localized(Stability::cases());
    Cost::scenes().iter().for_each(|(name, left_out)| _ = [name, left_out].map(|text| translated(text)));
    let looks = AtomicU32::new(0);
    let clock = || 10.0 * f64::from(looks.fetch_add(1, Ordering::Relaxed));
    for subject in BenchmarkId::ALL {
        // Fits and large scenes take long.
        let asked = AtomicU32::new(0);
        let cancelled = || asked.fetch_add(1, Ordering::Relaxed) >= 5;
        match subject.run(Host { clock: &clock, cancelled: &cancelled, progress: &|_| {} }) {
            BenchmarkResult::ErrorVsTime(report) => {
                _ = translated(report.title);
                assert_localized(report.notes);
            }
            BenchmarkResult::Stability(report) => {
                _ = translated(report.title);
                assert_localized(report.notes);
            }
            BenchmarkResult::Cost(report) => {
                _ = translated(report.title);
                assert_localized(report.notes);
                for row in &report.rows {
                    _ = [row.kernel, &row.terms].map(translated);
                }
            }
        }
        assert_found();
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
    explorer(&mut harness).actions.push(Action::Window(WindowAction::SetLanguage(Language::Chinese)));
    let folder = tempfile::tempdir().expect("a folder");
    for (example, model) in [(0, "hyde"), (1, "cauchy"), (1, "three-component")] {
        explorer(&mut harness).actions.push(Action::OpenExample(example));
        wait(&mut harness);
        explorer(&mut harness).work.surface_mut().model = Preset::from_key(model).expect("a model").model;
        explorer(&mut harness).actions.push(Action::StartFit);
        wait(&mut harness);
        let path = folder.path().join("report.html");
        let mut left = Vec::new();
        // The second time it does not know how it came about, like one out of an old session.
        for _ in 0..2 {
            ExportKind::Report.snapshot(&explorer(&mut harness).work, None).expect("a report")(&path).expect("a file");
            left.extend(english_in(&std::fs::read_to_string(&path).expect("the file"), explorer(&mut harness).work.active()));
            without_account(explorer(&mut harness));
        }
        assert!(left.is_empty(), "{model}: {left:#?}");
    }
}

/// The fit that is shown without an account of how it came about.
fn without_account(explorer: &mut App) {
    let fit = explorer.work.shown_fit().expect("a fit");
    let mut report = fit.report.clone();
    report.course.minima.clear();
    let FitEntry { id, ref problem, before, ref document, ref sha256, ref data, number, generation, ref mask, .. } = **fit;
    let (problem, document, mask) = (problem.clone(), document.clone(), mask.clone());
    let (sha256, data) = (sha256.clone(), data.clone());
    let fit = FitEntry { id, report, problem, before, document, sha256, data, number, generation, mask, joint: None };
    explorer.work.set_shown_fit(fit);
}

/// What is English in the report of a fit.
fn english_in(html: &str, document: &OpenMeasurement) -> Vec<String> {
    assert!(html.contains("lang=\"zh-CN\"") && html.contains("数据未能确定的量"));
    // What stands in the data's file, its name, and literature stay as they are.
    let quoted = |text: &str| {
        document.measurement.metadata.iter().any(|(key, value)| key == text || value == text)
            || PRESETS.iter().any(|preset| preset.citation == text)
            || text.starts_with("pbrdf-explorer")
    };
    let texts = texts_of(html).into_iter().map(|text| text.replace(&document.name, "")).filter(|text| !quoted(text));
    texts.filter(|text| is_english(text)).collect()
}
