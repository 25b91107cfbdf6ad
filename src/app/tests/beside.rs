//! Jobs around fits as texts: what comes back from a worker is what a thread would have found.

use crate::app::shell::app::App;
use crate::app::shell::app::posteriors::job_of_posterior;
use crate::app::tasks::answer::answer;
use crate::app::tasks::fit_work::{
    BootstrapOne, CompareModels, CompareTogether, FindIntervals, FitOneByOne, FitTogether, Fitted, ProfileOne, RefitSliders, Search, Watch,
    WithIntervals, Work,
};
use crate::app::tasks::landscape_message::{ask, told};
use crate::app::tasks::messages::Message;
use crate::app::tasks::wire::Wire;
use crate::app::tests::{explorer, harness};
use crate::app::work::fit_history::FitEntry;
use crate::app::work::fit_setup::{fit_problem, joint_problem, joint_problem_of};
use crate::app::work::open_measurement::OpenMeasurement;
use crate::app::work::posterior::DrawnPosterior;
use pbrdf::fit::posterior::Prior;
use pbrdf::fit::{Course, FitResult, Landscape, LandscapeAxis, Observer, Problem, Starts, free_by_default};
use pbrdf::model::{PRESETS, Parameter, ParameterSet};

const SEARCH: Search = Search { starts: Starts::Exactly(3), seed: 7 };

/// Tells nothing and goes on to the end.
struct Quiet;

impl<P> Watch<P> for Quiet {
    fn is_cancelled(&self) -> bool {
        (Observer::NONE.cancelled)()
    }

    fn report(&self, _: P) {}
}

/// The result by way of a worker.
fn sent<J: Message>(job: J) -> J::Output {
    let request = job.request().expect("it can be written");
    let told = std::sync::Mutex::new(Vec::new());
    let tell = |text: &str| told.lock().expect("nobody panics").push(text.to_owned());
    let answer = answer(&request, &Wire { is_cancelled: &|| false, tell: &tell }).expect("an answer");
    let progress = job.progress();
    let told = told.into_inner().expect("nobody panics");
    assert!(told.iter().all(|text| progress(text).is_some()), "{told:?}");
    job.receive(&answer).expect("a result")
}

/// All but the times, and the way, which a session keeps thinned.
fn numbers(report: &FitResult) -> FitResult {
    let Course { minima, intervals_complete, evaluations, .. } = &report.course;
    let mut course = Course::default();
    (course.minima, course.intervals_complete, course.evaluations) = (minima.clone(), *intervals_complete, *evaluations);
    FitResult { course, ..report.clone() }
}

fn assert_same(one: &[FitEntry], other: &[FitEntry]) {
    assert_eq!(one.len(), other.len());
    for (one, other) in one.iter().zip(other) {
        assert_eq!(numbers(&one.report), numbers(&other.report));
        assert_eq!((&one.document, one.number, one.generation), (&other.document, other.number, other.generation));
        assert_eq!(one.before, other.before);
    }
}

/// The example with some rows masked.
fn example(app: &App) -> OpenMeasurement {
    let mut open = app.work.active().clone();
    open.restore_mask(&[1, 5].into());
    open
}

/// Opens the active measurement under two more names: the first takes the place of the example that nobody has opened.
fn take_twice(app: &mut App) {
    for name in ["again.csv", "twice.csv"] {
        crate::app::tests::take(app, name.to_owned(), app.work.active().measurement.as_ref().clone());
    }
}

fn problem(app: &App, open: &OpenMeasurement) -> Problem {
    let free = free_by_default(open.surface.model, &open.measurement, &app.work.settings().fit_options);
    fit_problem(&open.surface, &open.measurement, open.surface.model, free, app.work.settings().fit_options).expect("a problem")
}

#[test]
fn fits_and_what_follows_from_them_are_the_same_to_the_bit() {
    let mut window = harness();
    let app = explorer(&mut window);
    let open = example(app);
    for intervals in [false, true] {
        let job = || FitOneByOne { about: vec![(problem(app, &open), open.clone()); 2], search: SEARCH, intervals };
        assert_same(&sent(job()), &job().run(&Quiet));
    }
    let about = vec![(problem(app, &open), open.clone())];
    let fit = FitOneByOne { about, search: SEARCH, intervals: false }.run(&Quiet).pop().expect("a fit");
    let fitted = || Fitted { fit: fit.clone(), parts: Vec::new() };
    let report = |result| match result {
        Some(WithIntervals::One(report)) => numbers(&report),
        _ => panic!("no intervals of one measurement"),
    };
    assert_eq!(report(sent(FindIntervals(fitted())).result), report(FindIntervals(fitted()).run(&Quiet).result));
    let profile = || ProfileOne { fit: fitted(), parameter: Parameter::Sigma };
    assert_eq!(sent(profile()), profile().run(&Quiet));
    let bootstrap = || BootstrapOne { fit: fitted(), replicates: 3, seed: 1 };
    assert_eq!(sent(bootstrap()), bootstrap().run(&Quiet));
}

#[test]
fn joint_fits_are_the_same_to_the_bit() {
    let mut window = harness();
    let app = explorer(&mut window);
    take_twice(app);
    let (list, fit_options) = (app.work.measurements(), app.work.settings().fit_options);
    let about: Vec<OpenMeasurement> = list.measured().cloned().collect();
    let job = || {
        let problem = joint_problem(list, ParameterSet::EMPTY, fit_options).expect("a problem");
        FitTogether { problem, about: about.clone(), shared: list.shared(), search: Search { starts: Starts::One, seed: 0 } }
    };
    let parts = job().run(&Quiet);
    assert_same(&sent(job()), &parts);
    let fitted = || Fitted { fit: parts[0].clone(), parts: parts.clone() };
    let profile = || ProfileOne { fit: fitted(), parameter: Parameter::Sigma };
    assert_eq!(sent(profile()), profile().run(&Quiet));
}

#[test]
fn fits_from_moving_sliders_are_the_same_to_the_bit() {
    let mut window = harness();
    let app = explorer(&mut window);
    let open = example(app);
    let job = || RefitSliders::one(problem(app, &open), open.clone());
    assert_eq!(sent(job()).0, job().run(&Quiet).0);
    take_twice(app);
    let (list, fit_options) = (app.work.measurements(), app.work.settings().fit_options);
    let job = || {
        let problem = joint_problem(list, [Parameter::N].into_iter().collect(), fit_options).expect("a problem");
        RefitSliders::joint(problem, list.measured().cloned().collect(), list.shared())
    };
    let found = job().run(&Quiet).0;
    assert_eq!(found.len(), 2);
    assert_eq!(sent(job()).0, found);
}

#[test]
fn landscapes_are_the_same_to_the_bit() {
    let mut window = harness();
    let app = explorer(&mut window);
    let open = example(app);
    let problem = problem(app, &open);
    let axis = |parameter, low, high| LandscapeAxis { parameter, low, high, count: 9, logarithmic: false };
    let axes = [axis(Parameter::N, 0.5, 4.0), axis(Parameter::K, 0.0, 5.0)];
    let request = ask(&problem, None, axes, &open).expect("it can be written");
    let answered = |is_cancelled: &(dyn Fn() -> bool + Sync)| answer(&request, &Wire { is_cancelled, tell: &|_| {} }).expect("an answer");
    let landscape = told(&answered(&|| false), axes).flatten().expect("heights");
    let bits = |of: &Landscape| of.objective.iter().map(|height| height.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&landscape), bits(&Landscape::minimised(&problem, axes[0], axes[1], &|| false).expect("heights")));
    assert_eq!(told(&answered(&|| true), axes), Some(None), "stopped");
}

/// All but the time and the stamp.
fn draws(mut drawn: DrawnPosterior) -> DrawnPosterior {
    (drawn.draws.elapsed_ms, drawn.stamp) = (0.0, 0);
    drawn
}

#[test]
fn draws_from_a_posterior_are_the_same_to_the_bit() {
    let mut window = harness();
    let app = explorer(&mut window);
    let free = [Parameter::N, Parameter::Kd];
    app.work.surface_mut().locked = free.into_iter().fold(ParameterSet::ALL, ParameterSet::without);
    let options = &mut app.work.settings_mut().panes.posterior;
    (options.draws, options.chains) = (100, 2);
    options.set_prior(Parameter::N, Prior::Normal { mean: 2.0, sd: 0.3 });
    let same = |app: &App| {
        let one = sent(job_of_posterior(app).expect("a posterior")).expect("draws");
        let other = job_of_posterior(app).expect("a posterior").run(&Quiet).expect("draws");
        assert_eq!(other.draws.len(), 200);
        assert_eq!(draws(DrawnPosterior::clone(&one)), draws(DrawnPosterior::clone(&other)));
    };
    same(app);
    take_twice(app);
    same(app);
}

#[test]
fn models_are_compared_the_same_way() {
    let mut window = harness();
    let app = explorer(&mut window);
    let open = example(app);
    let job = || {
        let problems = PRESETS.iter().take(3).map(|preset| {
            let free = free_by_default(preset.model, &open.measurement, &app.work.settings().fit_options);
            (preset, fit_problem(&open.surface, &open.measurement, preset.model, free, app.work.settings().fit_options))
        });
        CompareModels { about: open.clone(), problems: problems.collect(), search: Search { starts: Starts::One, seed: 0 } }
    };
    let (sent, run) = (sent(job()), job().run(&Quiet));
    assert_eq!((&sent.numbers, sent.models.len()), (&run.numbers, run.models.len()));
    for (one, other) in sent.models.iter().zip(&run.models) {
        assert_eq!(one.preset.key, other.preset.key);
        assert_same(one.result.as_ref().expect("a fit"), other.result.as_ref().expect("a fit"));
    }
}

#[test]
fn models_are_compared_together_the_same_way() {
    let mut window = harness();
    let app = explorer(&mut window);
    take_twice(app);
    let (list, fit_options) = (app.work.measurements(), app.work.settings().fit_options);
    let job = || {
        let problems = PRESETS.iter().take(2).map(|preset| (preset, joint_problem_of(list, preset.model, fit_options)));
        let (about, search) = (list.measured().cloned().collect(), Search { starts: Starts::One, seed: 0 });
        CompareTogether { about, shared: list.shared(), problems: problems.collect(), search }
    };
    let (sent, run) = (sent(job()), job().run(&Quiet));
    assert_eq!(sent.models.len(), 2);
    for (one, other) in sent.models.iter().zip(&run.models) {
        assert_same(one.result.as_ref().expect("a fit"), other.result.as_ref().expect("a fit"));
    }
}

#[test]
fn no_text_is_an_order_by_chance() {
    let wire = Wire { is_cancelled: &|| false, tell: &|_| {} };
    for text in ["", "{}", "null", r#"{"order": "Intervals", "session": {}}"#] {
        assert_eq!(answer(text, &wire), None);
    }
}
