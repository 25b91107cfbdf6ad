//! Forms of foreign files: each is recognised by its content, asks its questions, and says what it leaves out.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]

use pbrdf::measurement::formats::{FORMATS, ImportError, ImportNote, ImportOptions, Opened, Question, extensions, open, recognise};
use pbrdf::measurement::{Expected, Hint, Measurement, ReadErrorKind, TensorGrid, TensorResolution, unwatched, write_tensor};
use pbrdf::model::{Model, Parameters, Pbrdf};
use pbrdf::optics::SlopeDistribution;

const WOOLLAM: &str =
    "sample\nVASEmethod[x]\nnm\n600\t55\t43\t150\n640\t55\t43\t150\n640\t65\t42\t140\nuR\t640\t55\t1\t1\ndpolE\t640\t55\t1.5\n";
/// Made from known values: θi = 40°, 21 angles of view on either side.
const PGII: &[u8] = include_bytes!("data/formats/pgii.txt");
const TABLE: &str = "AOI,View (rad),DoLP %\n30,0.3,12.5\n40,-0.2,1\n";

fn tensor() -> Vec<u8> {
    let surface = Pbrdf::new(Model::full(SlopeDistribution::Gauss), Parameters::default()).expect("the defaults");
    let grid = TensorGrid::new(&surface, TensorResolution { phi_d: 3, theta_d: 3, theta_h: 2 });
    let mut bytes = Vec::new();
    write_tensor(&surface, &grid, 550, &mut unwatched, &mut bytes).expect("memory takes everything");
    bytes
}

#[test]
fn a_form_is_recognised_by_its_content_alone() {
    for (bytes, name) in [
        (WOOLLAM.as_bytes().to_vec(), Some("Woollam ellipsometry text")),
        (tensor(), Some("a tensor file (.pbsdf)")),
        (PGII.to_vec(), Some("pab pgII text")),
        (TABLE.as_bytes().to_vec(), None),
        (b"theta_i,theta_r,dolp\n30,20,0.1\n".to_vec(), None),
        (Vec::new(), None),
    ] {
        assert_eq!(recognise(&bytes).map(pbrdf::measurement::formats::Format::name), name);
        assert!(FORMATS.iter().filter(|format| format.sniff(&bytes)).count() <= 1);
    }
    assert_eq!(extensions()[..8], ["csv", "tsv", "txt", "xlsx", "xls", "ods", "dat", "pbsdf"]);
}

#[test]
fn a_file_asks_its_questions_and_the_offered_answers_import_it() {
    let opened = |bytes: &[u8]| match open(bytes.to_vec(), &mut unwatched).expect("a good file") {
        Opened::Foreign(file) => file,
        Opened::Measurements(_) => panic!("a foreign file"),
    };
    let file = opened(WOOLLAM.as_bytes());
    assert!(matches!(&file.questions()[..], [Question::Wavelength { available_nm }] if available_nm == &[600.0, 640.0]));
    let options = ImportOptions::offered(&file.questions());
    assert_eq!(options.wavelength_nm, Some(640.0));
    assert_eq!(file.import(&options, &mut unwatched).expect("a wavelength of the file").rows(), 2);
    let ignored = ImportNote::IgnoredRows { name: "uR".to_owned(), count: 1 };
    assert_eq!(file.notes(), [ignored, ImportNote::DepolarisationNotApplied { count: 1 }]);
    let other = ImportOptions { wavelength_nm: Some(605.0), ..options };
    let notes = file.import(&other, &mut unwatched).expect("a wavelength near one of the file").notes;
    let nearest = ImportNote::NearestWavelength { wanted_nm: 605.0, taken_nm: vec![600.0] };
    assert_eq!(nearest.to_string(), "has no 605 nm; the nearest was taken, 600 nm");
    assert_eq!(notes, [nearest, ImportNote::NoWavelengthNear { theta_i: 65.0 }]);
    assert!(matches!(file.import(&ImportOptions::default(), &mut unwatched), Err(ImportError::Wavelength(_))));

    let file = opened(&tensor());
    assert!(matches!(&file.questions()[..], [Question::Wavelength { .. }, Question::Directions]));
    let options = ImportOptions { theta_i: vec![30.0], theta_r: vec![-20.0, 20.0], ..ImportOptions::offered(&file.questions()) };
    assert_eq!(file.import(&options, &mut unwatched).expect("angles in range").rows(), 2);
    let outside = ImportOptions { theta_i: vec![90.0], ..options };
    assert!(matches!(file.import(&outside, &mut unwatched), Err(ImportError::Geometry(_))));

    let file = opened(TABLE.as_bytes());
    let options = ImportOptions::offered(&file.questions());
    assert_eq!(options.columns.to_string(), "theta_i=1,theta_r=2:radians,dolp=3:percent");
    let imported = file.import(&options, &mut unwatched).expect("the guess fits");
    assert_eq!(imported, file.preview(&options).expect("the guess fits"));
    assert_eq!((imported.rows(), file.preview_is_whole()), (2, true));
}

#[test]
fn a_scan_of_a_gonio_photometer_becomes_brdf_on_both_sides() {
    let Opened::Foreign(file) = open(PGII.to_vec(), &mut unwatched).expect("a good file") else { panic!("a foreign file") };
    let measurement = file.import(&ImportOptions::default(), &mut unwatched).expect("it asks nothing").measurements.swap_remove(0);
    assert_eq!((measurement.rows.len(), measurement.incidence_angles()), (42, vec![40.0]));
    assert_eq!((measurement.metadata("wavelength_nm"), measurement.has_dolp()), (Some("650"), false));
    let brdf = |theta_r: f64| {
        let row = measurement.rows.iter().find(|row| row.geometry.signed_theta_r().0 == theta_r).expect("the angle is there");
        row.brdf.expect("a BRDF").value
    };
    assert_eq!((brdf(80.0), brdf(-80.0)), (0.6929483, 0.09232988));
}

#[test]
fn files_of_one_wavelength_and_this_projects_own_ask_nothing() {
    let one = open(b"nm\taoi\tPsi\tDelta\n650\t65\t42\t140\n".to_vec(), &mut unwatched).expect("a good file");
    assert!(matches!(one, Opened::Foreign(file) if file.questions().is_empty()
        && file.import(&ImportOptions::default(), &mut unwatched).is_ok_and(|imported| imported.rows() == 1)));
    let own = open(b"theta_i,theta_r,dolp\n30,20,0.1\n".to_vec(), &mut unwatched).expect("a good file");
    assert!(matches!(own, Opened::Measurements(all) if all.len() == 1 && all[0].rows.len() == 1));
}

#[test]
fn what_is_no_table_is_refused_for_its_first_fault() {
    for (text, reason) in [
        ("Dear reader, this is a letter.\nYours\n", "the column theta_i is missing"),
        ("theta_i,theta_r\n30,20\n", "neither dolp nor brdf"),
        ("theta_i,theta_r,dolp\n30,20,x\n", "line 2, column 3 (dolp)"),
    ] {
        let error = open(text.as_bytes().to_vec(), &mut unwatched).err().expect(text).to_string();
        assert!(error.contains(reason), "{error}");
    }
}

#[test]
fn errors_carry_the_hint_that_helps() {
    let head = "theta_i,theta_r,dolp,dolp_sigma";
    for (text, hint) in [
        ("AOI,view,DoLP\n30,20,0.1\n".to_owned(), Some(Hint::Import)),
        ("30,20,0.1\n".to_owned(), Some(Hint::Import)),
        // The sentence itself names the column.
        ("Theta_i,theta_r,dolp\n30,20,0.1\n".to_owned(), None),
        (format!("{head}\n30,20,12.5,0.1\n"), Some(Hint::NameDolpPercent)),
        (format!("{head}\n30,20,125,0.1\n"), Some(Hint::LeaveOut)),
        // Noise around 1, or percent.
        (format!("{head}\n30,20,1.03,0.1\n"), Some(Hint::PercentOrLeaveOut)),
        (format!("{head}\nNaN,20,0.1,0.1\n"), None),
        (format!("{head}\n30,5,20,0,1,0,01\n"), Some(Hint::SeparateBySemicolons)),
        (format!("{head}\n30,20\n"), None),
        ("theta_i;theta_r;brdf\n30;20;1.234,5\n".to_owned(), Some(Hint::NameThousands('.'))),
        ("t\0h\0e\0".to_owned(), Some(Hint::SaveAsUtf8)),
    ] {
        assert_eq!(Measurement::read(text.as_bytes()).expect_err(&text).hint(), hint, "{text:?}");
    }
}

#[test]
fn errors_hold_values_and_say_them_in_english() {
    let error = Measurement::read(&b"theta_i,theta_r,dolp\n90,20,0.1\n"[..]).expect_err("an angle of 90 degrees");
    assert!(matches!(&error.kind, ReadErrorKind::OutOfRange { found, expected: Expected::ThetaI } if found == "90"));
    assert_eq!(error.to_string(), "line 2, column 1 (theta_i): found 90, expected an angle of incidence, 0 ≤ θi < 90 degrees");
}
