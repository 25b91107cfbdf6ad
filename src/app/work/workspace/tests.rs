use super::{Layout, MeasurementList, Settings, Workspace};
use crate::app::work::edit::{Edit, Switch};
use crate::app::work::open_measurement::{EXAMPLES, OpenMeasurement};
use pbrdf::measurement::Measurement;
use pbrdf::model::{Parameter, ParameterSet, Parameters};

fn example(name: &str) -> Edit {
    let measurement = Measurement::read(EXAMPLES[0].text.as_bytes()).expect("an example is a measurement");
    Edit::Open(Box::new(OpenMeasurement::new(name.to_owned(), measurement)))
}

/// Work on an example that holds as many rows as a user would mask by hand.
fn opened() -> Workspace {
    let mut work = Workspace::default();
    work.apply(example("first"));
    work.record_step();
    work
}

#[test]
fn work_can_be_sent_to_another_thread() {
    fn assert_send<T: Send + Sync>() {}
    assert_send::<Workspace>();
}

#[test]
fn every_edit_has_a_revision_of_its_own_and_undo_restores_what_was_recorded() {
    let mut work = opened();
    let mut revisions = vec![work.revision()];
    let before = work.setup();
    let mut surface = work.surface().clone();
    surface.parameters.n = 2.5;
    surface.locked = ParameterSet::EMPTY.with(Parameter::K);
    surface.set_bounds(Parameter::K, 0.5, 4.0).expect("sound bounds");
    for edit in [
        Edit::SetParameters(Parameters { n: 2.5, ..Parameters::default() }),
        Edit::Mask { rows: vec![0, 3], masked: true },
        Edit::SetSwitch(Switch::LogBrdf, true),
        Edit::SetSurface(Box::new(surface.clone())),
    ] {
        work.apply(edit);
        revisions.push(work.revision());
        work.record_step();
    }
    assert!(revisions.is_sorted_by(|one, next| one < next), "{revisions:?}");
    let after = work.setup();
    assert_eq!((work.active().mask().to_vec(), work.surface(), work.settings().log_brdf), (vec![0, 3], &surface, true));
    for _ in 0..4 {
        assert!(work.can_undo());
        work.apply(Edit::Undo);
    }
    assert_eq!(work.setup(), before);
    assert!(!work.can_undo());
    for _ in 0..4 {
        work.apply(Edit::Redo);
    }
    assert_eq!(work.setup(), after);
}

#[test]
fn undo_takes_a_shared_parameter_back_on_every_surface() {
    let open = ["a", "b"].map(|name| OpenMeasurement::new(name.to_owned(), Measurement::default())).to_vec();
    let list = MeasurementList::several(open, 0, ParameterSet::EMPTY.with(Parameter::Sigma));
    let mut work = Workspace::restored(Settings::default(), Layout::default(), list, Vec::new(), []);
    let sigmas = |work: &Workspace| -> Vec<f64> { work.measurements().iter().map(|open| open.surface.parameters.sigma).collect() };
    let before = sigmas(&work);
    work.apply(Edit::SetParameters(Parameters { sigma: 0.125, ..Parameters::default() }));
    work.record_step();
    assert_eq!(sigmas(&work), [0.125, 0.125]);
    work.apply(Edit::Undo);
    assert_eq!(sigmas(&work), before);
}

#[test]
fn a_change_that_is_taken_back_is_no_step() {
    let mut work = opened();
    work.record_step();
    for value in [2.5, work.surface().parameters.n] {
        work.apply(Edit::SetParameters(Parameters { n: value, ..Parameters::default() }));
    }
    work.record_step();
    assert!(!work.can_undo());
}

#[test]
fn opening_a_measurement_is_a_step_and_masks_stay_with_their_rows() {
    let mut work = opened();
    for edit in [Edit::Mask { rows: vec![1], masked: true }, example("second"), Edit::Mask { rows: vec![2], masked: true }] {
        work.apply(edit);
        work.record_step();
    }
    let state = |work: &Workspace| -> Vec<(String, Vec<usize>)> {
        work.measurements().iter().map(|open| (open.name.clone(), open.mask().to_vec())).collect()
    };
    let of = |name: &str, mask: &[usize]| (name.to_owned(), mask.to_vec());
    let expected = [
        vec![of("first", &[1]), of("second", &[2])],
        vec![of("first", &[1]), of("second", &[])],
        vec![of("first", &[1])],
        vec![of("first", &[])],
    ];
    for expected in &expected {
        assert_eq!(state(&work), *expected);
        work.apply(Edit::Undo);
    }
    assert!(!work.can_undo());
    (0..3).for_each(|_| work.apply(Edit::Redo));
    assert_eq!(state(&work), expected[0]);
}

#[test]
fn a_live_refit_is_out_of_date_when_the_user_moves_something_and_not_when_a_fit_does() {
    let mut work = opened();
    let (parameters, model) = (work.surface().parameters, work.surface().model);
    work.apply(Edit::TakeValues { parameters: Parameters { n: 3.5, ..parameters }, model });
    work.apply(Edit::SetSwitch(Switch::Limit, false));
    work.apply(Edit::SetParameters(Parameters { n: 3.5, ..parameters }));
    assert_eq!(work.moved_at(), 0);
    work.apply(Edit::SetParameters(parameters));
    assert_eq!(work.moved_at(), work.revision());
    work.apply(Edit::Mask { rows: vec![1], masked: true });
    assert_eq!(work.moved_at(), work.revision());
}
