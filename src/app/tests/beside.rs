//! Jobs around fits as texts: what comes back from a worker is what a thread would have found.

use crate::app::rehearsal::rehearse;
use crate::app::shell::app::App;
use crate::app::shell::app::posteriors::job_of_posterior;
use crate::app::tasks::answer::answer;
use crate::app::tasks::fit_work::{
    BootstrapOne, CompareModels, CompareTogether, FindIntervals, FitOneByOne, FitTogether, Fitted, ProfileOne, RefitSliders, Search, Watch,
    WithIntervals, Work,
};
use crate::app::tasks::inquiry_work::{ChooseAngles, EvidenceRow, FindEvidence, FollowWeakest, NotChosen};
use crate::app::tasks::landscape_message::{ask, told};
use crate::app::tasks::messages::Message;
use crate::app::tasks::view_message::{ask_audit, ask_scene, told_audit, told_scene};
use crate::app::tasks::wire::Wire;
use crate::app::tests::{explorer, harness};
use crate::app::text::i18n::Language;
use crate::app::work::design::{AngleRange, DesignSettings};
use crate::app::work::edit::Edit;
use crate::app::work::fit_history::FitEntry;
use crate::app::work::fit_setup::{fit_problem, joint_problem, joint_problem_of};
use crate::app::work::open_measurement::OpenMeasurement;
use crate::app::work::picture_options::{PictureCompanion, PictureOptions};
use crate::app::work::picture_scene::{Scene, SceneKey};
use crate::app::work::posterior::{DrawnPosterior, PosteriorOptions};
use crate::app::work::workspace::Workspace;
use pbrdf::fit::posterior::Prior;
use pbrdf::fit::{Course, FitResult, GeodesicWay, Landscape, LandscapeAxis, Observer, Problem, Starts, free_by_default};
use pbrdf::model::{Audit, PRESETS, Parameter, ParameterSet, Parameters, Pbrdf, Quality, StokesImage};

const SEARCH: Search = Search { starts: Starts::Exactly(3), seed: 7 };

/// Tells nothing and goes on to the end.
struct Quiet;

impl<P> Watch<P> for Quiet {
    fn is_cancelled(&self) -> bool {
        (Observer::NONE.cancelled)()
    }

    fn report(&self, _: P) {}
}

/// Listens to the model that is being fitted.
#[derive(Default)]
struct Listening(std::sync::Mutex<Vec<&'static str>>);

impl Watch<&'static str> for Listening {
    fn is_cancelled(&self) -> bool {
        (Observer::NONE.cancelled)()
    }

    fn report(&self, key: &'static str) {
        self.0.lock().expect("nobody panics").push(key);
    }
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
    let heard = Listening::default();
    let (sent, run) = (sent(job()), job().run(&heard));
    // Only a key becomes the name that the window shows.
    let mut heard = heard.0.into_inner().expect("nobody panics");
    heard.sort_unstable_by_key(|key| PRESETS.iter().position(|preset| preset.key == *key));
    assert_eq!(heard, PRESETS.iter().take(3).map(|preset| preset.key).collect::<Vec<_>>());
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

#[test]
fn evidence_and_the_weakest_direction_are_the_same_to_the_bit() {
    let mut window = harness();
    let app = explorer(&mut window);
    take_twice(app);
    let (list, fit_options) = (app.work.measurements(), app.work.settings().fit_options);
    let about: Vec<OpenMeasurement> = list.measured().cloned().collect();
    let open = about[0].clone();
    let alone = FitOneByOne { about: vec![(problem(app, &open), open.clone())], search: SEARCH, intervals: false };
    let alone = Fitted { fit: alone.run(&Quiet).remove(0), parts: Vec::new() };
    let joint = joint_problem(list, [Parameter::N].into_iter().collect(), fit_options).expect("a problem");
    let together = FitTogether { problem: joint, about, shared: list.shared(), search: Search { starts: Starts::One, seed: 0 } };
    let parts = together.run(&Quiet);
    let together = Fitted { fit: parts[1].clone(), parts: parts.clone() };
    for fit in [&alone, &together] {
        for way in [GeodesicWay::Nearer, GeodesicWay::Farther] {
            let whole = || Fitted { fit: fit.fit.clone(), parts: fit.parts.clone() };
            let numbers: Vec<u64> =
                if fit.parts.is_empty() { vec![fit.fit.number] } else { parts.iter().map(|part| part.number).collect() };
            let job = || FollowWeakest { fit: whole(), numbers: numbers.clone(), way };
            let walk = job().run(&Quiet);
            assert!(walk.geodesic.points.len() > 1);
            assert_eq!(sent(job()), walk);
        }
    }
    let options = PosteriorOptions { draws: 200, chains: 2, ..PosteriorOptions::default() };
    let job = || {
        let row =
            |row, fit: &Fitted| EvidenceRow { row, model: PRESETS[0].key, fit: Fitted { fit: fit.fit.clone(), parts: fit.parts.clone() } };
        FindEvidence { number: 4, rows: vec![row(2, &alone), row(5, &alone)], options: options.clone(), seed: 3 }
    };
    let found = job().run(&Quiet);
    assert_eq!((found.0, found.1.iter().map(|(row, _)| *row).collect::<Vec<_>>()), (4, vec![2, 5]));
    assert!(found.1.iter().all(|(_, evidence)| evidence.is_some()));
    assert_eq!(sent(job()), found);
}

#[test]
fn chosen_angles_are_the_same_to_the_bit_and_so_is_the_sentence_of_a_fault() {
    let mut window = harness();
    let app = explorer(&mut window);
    let range = |from, to| vec![AngleRange::new(from, to, 20.0)];
    let plan = |count| DesignSettings { theta_i: range(30.0, 70.0), theta_r: range(10.0, 70.0), count, ..DesignSettings::default() };
    let job =
        |count| ChooseAngles { surface: app.work.surface().clone(), design: plan(count), about: example(app), language: Language::English };
    let chosen = job(6).run(&Quiet).expect("angles");
    assert_eq!(chosen.angles.len(), 6);
    assert_eq!(sent(job(6)), Ok(chosen));
    let fault = job(100).run(&Quiet);
    assert!(matches!(&fault, Err(NotChosen::Because(sentence)) if sentence.contains("candidates")), "{fault:?}");
    assert_eq!(sent(job(100)), fault);
}

#[test]
fn pictures_and_audits_are_the_same_to_the_bit() {
    let bits = |image: &StokesImage| [&image.s0, &image.s1, &image.s2].map(|part| part.iter().map(|at| at.to_bits()).collect::<Vec<_>>());
    let mut before: Option<Scene> = None;
    for (sky, companion) in [(false, PictureCompanion::Nothing), (true, PictureCompanion::OtherDistribution)] {
        let mut work = Workspace::default();
        work.apply(Edit::SetPictureOptions(PictureOptions { sky, companion, ..PictureOptions::default() }));
        let key = SceneKey::of(&work);
        let request = ask_scene(&key, 24).expect("it can be written");
        let answered =
            |is_cancelled: &(dyn Fn() -> bool + Sync)| answer(&request, &Wire { is_cancelled, tell: &|_| {} }).expect("an answer");
        let scene = told_scene(&answered(&|| false), key.clone(), 24, before.as_ref()).flatten().expect("a picture");
        let wanted = Scene::new(key.clone(), 24, Quality::Fast, None, &|| false).expect("a picture");
        assert_eq!((&scene.key, bits(&scene.image)), (&wanted.key, bits(&wanted.image)));
        assert_eq!((scene.other.as_ref().map(bits), &scene.picture), (wanted.other.as_ref().map(bits), &wanted.picture));
        assert!(told_scene(&answered(&|| true), key.clone(), 24, None).is_some_and(|stopped| stopped.is_none()));
        assert!(told_scene(&answered(&|| false), key, 25, None).is_none(), "of another size it is none");
        before = Some(scene);
    }
    for preset in PRESETS {
        let parameters = Parameters { c: -1.5, ..Parameters::default() };
        let surface = Pbrdf::new(preset.model, parameters).expect("a surface");
        let request = ask_audit(&surface).expect("it can be written");
        let answer = answer(&request, &Wire { is_cancelled: &|| false, tell: &|_| {} }).expect("an answer");
        // Reflectances may be no numbers, which are not equal to themselves.
        assert_eq!(format!("{:?}", told_audit(&answer).expect("an audit")), format!("{:?}", Audit::new(&surface)));
    }
}

#[test]
fn a_worker_that_rehearses_fits_finds_intervals_and_comes_to_its_end() {
    assert!(rehearse());
}
