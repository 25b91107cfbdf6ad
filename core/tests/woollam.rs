//! Woollam's ellipsometry text: what is accepted is read right, what is refused says where and why.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]

use pbrdf::measurement::{Ellipsometry, ReadError, WavelengthError, is_woollam};
use std::ops::ControlFlow;

fn read(text: impl AsRef<[u8]>) -> Result<Ellipsometry, ReadError> {
    Ellipsometry::read(text.as_ref())
}

fn accepted(text: impl AsRef<[u8]>) -> Ellipsometry {
    read(text.as_ref()).unwrap_or_else(|error| panic!("{error}: {:?}", String::from_utf8_lossy(text.as_ref())))
}

const WVASE: &str = "A film, \u{e9}paisse\r\nVASEmethod[X=1, Y=2]\r\nOriginal[a.dat]\r\nnm\r\n\
    500\t60\t40\t150\t0.01\t0.02\r\n600\t60\t41\t150\t0.01\t0.02\r\n500\t70\t42\t150\t0.01\t0.02\r\ndpolE\t500\t60\t0.4\t1";

#[test]
fn the_three_forms_say_the_same() {
    let expected = accepted(WVASE);
    assert_eq!((expected.rows.len(), expected.rows[0].line, expected.rows[2].psi), (3, 5, 42.0));
    assert_eq!(expected.metadata[0], ("sample".to_owned(), "A film, \u{e9}paisse".to_owned()));
    assert_eq!(expected.metadata[1].1, "X=1, Y=2");
    assert_eq!(expected.depolarisation[0].percent, 0.4);
    let complete = "A film\nVASEmethod[X]\nAngstroms\nE 5000 60 40 150 0.01 0.02\nuR 5000 60 inf 1\nE 6000 60 41 150 0.01 0.02\nE 5000 70 42 150 0.01 0.02\n";
    let short = "nm\taoi\tPsi\tDelta\n\n500\t60.00\t40\t150\n600\t60.00\t41\t150\n500\t70.00\t42\t150";
    for (text, sigma) in [(complete, Some(0.01)), (short, None), (&short.replace('\n', "\r"), None)] {
        let other = accepted(text);
        assert!(is_woollam(text.as_bytes()));
        assert_eq!(other.rows.len(), 3);
        for (row, expected) in other.rows.iter().zip(&expected.rows) {
            assert_eq!(
                (row.wavelength_nm, row.theta_i, row.psi, row.delta),
                (expected.wavelength_nm, expected.theta_i, expected.psi, expected.delta)
            );
            assert_eq!(row.sigma_psi, sigma);
        }
    }
    assert_eq!(accepted(complete).ignored, [("uR".to_owned(), 1)]);
}

#[test]
fn other_units_of_the_wavelength_are_converted() {
    for (unit, value) in [("eV", "2.4796839686640052"), ("microns", "0.5"), ("1/cm", "20000")] {
        let nm = accepted(format!("x\n{unit}\n{value} 60 40 150\n")).rows[0].wavelength_nm;
        // One rounding of the division, one of the text.
        assert!((nm - 500.0).abs() < 1e-12, "{unit}: {nm}");
    }
}

#[test]
fn dolp_is_the_cosine_of_two_psi_with_its_error() {
    let slice = accepted(WVASE).specular_dolp(Some(500.0)).expect("a wavelength of the file");
    assert_eq!((slice.wavelengths_nm.as_slice(), slice.left_out.len()), (&[500.0][..], 0));
    let rows = &slice.measurement.rows;
    assert_eq!(rows.len(), 2);
    let dolp = rows[0].dolp.expect("a DoLP");
    // cos 80° and 2 sin 80° · 0.01°.
    assert!((dolp.value - 0.173_648_177_666_930_34).abs() < 1e-15);
    assert!((dolp.sigma.expect("a sigma") / (2.0 * 0.984_807_753_012_208 * 0.01 * std::f64::consts::PI / 180.0) - 1.0).abs() < 1e-14);
    assert_eq!(
        (rows[0].geometry.theta_i(), rows[0].geometry.theta_r(), rows[0].geometry.dphi().0),
        (rows[0].geometry.theta_r(), rows[0].geometry.theta_i(), 180.0)
    );
    assert_eq!(slice.measurement.metadata("depolarisation"), Some("0.4 % at 60 degrees; not applied"));
}

#[test]
fn a_wavelength_is_never_guessed() {
    let file = accepted(WVASE);
    assert!(matches!(file.specular_dolp(None), Err(WavelengthError::NotChosen { count: 2, .. })));
    assert!(matches!(file.specular_dolp(Some(700.0)), Err(WavelengthError::Outside { .. })));
    let nearest = file.specular_dolp(Some(590.0)).expect("near one of the file");
    // 70° was measured at 500 nm alone.
    assert_eq!((nearest.wavelengths_nm, nearest.left_out, nearest.measurement.rows.len()), (vec![600.0], vec![70.0], 1));
}

#[test]
fn what_does_not_fit_is_refused_with_its_place() {
    let head = "sample\nnm\n500 60 40 150\n";
    for (text, place, reason) in [
        (String::new(), "", "empty"),
        (" \r\n".to_owned(), "", "empty"),
        ("sample\nsomething\n".to_owned(), "", "unit of the wavelength"),
        ("sample\n500 60 40 150\n".to_owned(), "line 2", "unit of the wavelength"),
        ("x\n".repeat(30), "line 21", "unit of the wavelength"),
        ("sample\nnm\n".to_owned(), "line 2", "no row of psi"),
        (format!("{head}500 60 40\n"), "line 4", "3 numbers; expected 4"),
        (format!("{head}500 60 40 150 0.1\n"), "line 4", "5 numbers"),
        (format!("{head}E 500 60 40\n"), "line 4", "3 numbers"),
        (format!("{head}dpolE 500 60\n"), "line 4", "2 numbers"),
        (format!("{head}-500 60 40 150\n"), "line 4, column 1 (wavelength)", "above 0"),
        (format!("{head}500 90 40 150\n"), "line 4, column 2 (aoi)", "θi < 90"),
        (format!("{head}500 60 91 150\n"), "line 4, column 3 (psi)", "found \"91\""),
        (format!("{head}E 500 60 NaN 150\n"), "line 4, column 4 (psi)", "found \"NaN\""),
        (format!("{head}500 60 40 inf\n"), "line 4, column 4 (delta)", "found \"inf\""),
        (format!("{head}500 60 40 150 -1 0\n"), "line 4, column 5 (sigma_psi)", "0 or more"),
        (format!("{head}500,60,40,150\n"), "line 4", "expected a row such as"),
        (format!("{head}500 60 4\0 150\n"), "line 4", "NUL"),
        ("sample\neV\n1e-320 60 40 150\n".to_owned(), "line 3, column 1 (wavelength)", "above 0"),
    ] {
        let error = read(&text).expect_err(&text).to_string();
        assert!(error.starts_with(place) && error.contains(reason), "{text:?}: {error}");
    }
    assert!(read(b"\xff\xfen\0m\0").expect_err("UTF-16").to_string().contains("UTF-16"));
}

#[test]
fn reading_tells_progress_and_can_be_stopped() {
    let text = format!("sample\nnm\n{}", "500 60 40 150\n".repeat(100_000));
    let mut reports = 0;
    let found = Ellipsometry::read_with(text.as_bytes(), &mut |done| {
        reports += 1;
        assert!((0.0..=1.0).contains(&done));
        ControlFlow::Continue(())
    });
    assert_eq!((found.expect("a good file").rows.len(), reports), (100_000, 24));
    let stopped = Ellipsometry::read_with(text.as_bytes(), &mut |_| ControlFlow::Break(()));
    assert!(stopped.expect_err("a stop").to_string().contains("cancelled"));
}

#[test]
fn a_wavelength_that_no_angle_has_is_refused_and_not_answered_with_an_empty_table() {
    // Within 400 to 600 nm, but either angle has one of them alone.
    let file = accepted("x\nnm\n400 60 40 150\n600 70 41 150\n");
    assert!(matches!(file.specular_dolp(Some(500.0)), Err(WavelengthError::Outside { .. })));
    assert_eq!(file.specular_dolp(Some(600.0)).map(|found| found.left_out), Ok(vec![60.0]));
}
