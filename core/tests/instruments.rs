//! Real files of instruments, with values computed from their text by an independent script: |cos 2ψ|, and directions by the formulas of
//! the module's head.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]

use pbrdf::measurement::foreign::{LabTable, TableOptions};
use pbrdf::measurement::formats::{ForeignFile, ImportError, ImportNote, ImportOptions, Imported, Opened, open, recognise};
use pbrdf::measurement::{Field, unwatched};

fn file(name: &str) -> Vec<u8> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/formats");
    std::fs::read(folder.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn opened(name: &str) -> Box<dyn ForeignFile> {
    match open(file(name), &mut unwatched) {
        Ok(Opened::Foreign(file)) => file,
        Ok(Opened::Measurements(_)) => panic!("{name} is foreign"),
        Err(error) => panic!("{name}: {error}"),
    }
}

fn at(name: &str, wavelength_nm: f64) -> Imported {
    let options = ImportOptions { wavelength_nm: Some(wavelength_nm), ..ImportOptions::default() };
    opened(name).import(&options, &mut unwatched).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// θi and DoLP of each row.
fn specular(imported: &Imported) -> Vec<(f64, f64)> {
    let rows = imported.measurements[0].rows.iter();
    rows.map(|row| (row.geometry.theta_i().0, row.dolp.map_or(f64::NAN, |dolp| dolp.value))).collect()
}

#[test]
fn ellipsometers_give_specular_dolp() {
    for (name, form, wavelength_nm, expected) in [
        (
            "refellips/testData1_11nm_PNIPAM_on_Si_EP4.dat",
            "Accurion EP4",
            658.0,
            &[(55.0, 0.567_843_745_053_101), (60.0, 0.688_354_575_693_754), (65.0, 0.813_100_761_047_028), (70.0, 0.917_754_625_683_981)][..],
        ),
        // Delta stands before Psi.
        (
            "refellips/corefine_polyBrush_ellipsometry.dat",
            "Accurion EP4",
            658.0,
            &[(40.0, 0.276_006_433_483_14), (40.0, 0.279_627_935_523_817)],
        ),
        ("refellips/15-1-1.dat", "Accurion EP4", 658.0, &[(50.0, 0.454_798_964_526_05), (50.0, 0.460_478_677_498_484)]),
        ("refellips/WVASE_lorentz.dat", "psi and delta", 650.0, &[(60.0, 0.744_544_618_419_267)]),
        (
            "refellips/WVASE_Gaussian_example_40nmFilm_MultiWavelength_MultiAngle.txt",
            "Woollam",
            650.0,
            &[(40.0, 0.310_444_165_551_048), (50.0, 0.501_299_325_818_767), (60.0, 0.730_639_113_727_622)],
        ),
        ("refellips/TestData_bareSI.txt", "Woollam", 650.0, &[(45.0, 0.360_941_043_943_614)]),
        (
            "spectraray.txt",
            "SENTECH SpectraRay",
            650.0,
            &[(55.1, 0.077_155_807_270_091), (65.1, 0.120_538_812_690_536), (75.1, 0.184_185_688_941_274)],
        ),
    ] {
        assert!(recognise(&file(name)).is_some_and(|found| found.name().contains(form)), "{name}");
        let rows = specular(&at(name, wavelength_nm));
        for (row, expected) in rows.iter().zip(expected) {
            assert!(row.0 == expected.0 && (row.1 - expected.1).abs() < 1e-12, "{name}: {row:?} {expected:?}");
        }
        assert!(rows.len() >= expected.len(), "{name}");
    }
    let notes = opened("refellips/15-1-1.dat").notes();
    assert_eq!(notes, [ImportNote::IgnoredRows { name: "psi without a value".to_owned(), count: 6 }]);
}

#[test]
fn film_sense_asks_for_the_angle_that_it_does_not_state() {
    let file = opened("refellips/Filmsense_staticTest.txt");
    let options = ImportOptions { wavelength_nm: Some(656.32), ..ImportOptions::default() };
    assert!(matches!(file.import(&options, &mut unwatched), Err(ImportError::NoThetaI)));
    let imported = file.import(&ImportOptions { theta_i: vec![65.0], ..options }, &mut unwatched).expect("an angle and a wavelength");
    // |N|/√(N² + C² + S²) of the fifth line.
    let rows = specular(&imported);
    assert!(rows.len() == 1 && rows[0].0 == 65.0 && (rows[0].1 - 0.936_561_512_267_095).abs() < 1e-12, "{rows:?}");
}

#[test]
fn zemax_scatter_angles_count_from_the_specular_ray() {
    let file = opened("ansys/test_13_planesymmetric_brdf_zemax.bsdf");
    assert!(file.questions().is_empty());
    let imported = file.import(&ImportOptions::default(), &mut unwatched).expect("it asks nothing");
    let brdf = |theta_i: f64, theta_r: f64, dphi: f64| {
        let is_near = |a: f64, b: f64| (a - b).abs() < 1e-9;
        let found = imported.measurements[0].rows.iter().find(|row| {
            let geometry = row.geometry;
            geometry.theta_i().0 == theta_i && is_near(geometry.theta_r().0, theta_r) && is_near(geometry.dphi().0, dphi)
        });
        found.and_then(|row| row.brdf).map(|brdf| brdf.value)
    };
    // Lines 1, 19 and 10 of the first block, θi = 15°; lines 1 and 19 of the seventh, θi = 45°.
    for (theta_i, theta_r, dphi, expected) in [
        (15.0, 15.0, 180.0, 6.375e-2),
        (15.0, 5.0, 180.0, 5.879e-2),
        (15.0, 65.0, 0.0, 3.219e-2),
        (15.0, 45.0, 180.0, 5.400e-2),
        (15.0, 33.225_942_203_287_58, 114.146_108_451_302_91, 4.881e-2),
        (45.0, 25.0, 180.0, 7.236e-2),
        (45.0, 75.0, 180.0, 2.080e-1),
    ] {
        assert_eq!(brdf(theta_i, theta_r, dphi), Some(expected), "{theta_i} {theta_r} {dphi}");
    }
    assert!(matches!(file.notes()[..], [ImportNote::NoValue { count: 440 }]));
}

#[test]
fn a_goniometer_table_with_a_column_for_each_wavelength_asks_for_its_quantity() {
    let options = |wide| TableOptions { wide, wavelength_nm: Some(550.0), ..TableOptions::default() };
    let table = LabTable::open(file("ansys/brdf_viewer_2d_first_rows.csv"), &options(None), &mut unwatched).expect("a table");
    assert!(matches!(table.read(&options(None), &mut unwatched), Err(ImportError::Undecided { .. })));
    let imported = table.read(&options(Some(Field::Brdf)), &mut unwatched).expect("the question is answered");
    let [measurement] = &imported.measurements[..] else { panic!("one wavelength") };
    let value = |signed: f64| {
        let row = measurement.rows.iter().find(|row| row.geometry.signed_theta_r().0 == signed).expect("the angle is there");
        (row.brdf.map(|brdf| brdf.value), row.masked)
    };
    assert_eq!((value(-78.0), value(12.0)), ((Some(0.7078), false), (Some(12.9957), false)));
    // The detector stands in the way of the light.
    assert_eq!(value(-10.0 + 1.0), (None, true));
}

#[test]
fn forms_that_are_not_read_are_named_with_what_to_do() {
    for (bytes, name, advice) in [
        (&b"SAMPLE: a\nVARS=theta_i,phi_i,theta_s,phi_s,brdf\n30.0,0.0,10.0,180.0,0.21\n30,0,20,180,0.5\n"[..], "ASTM E1392", "--columns"),
        (b"<?xml version=\"1.0\"?>\n<WindowElement></WindowElement>\n", "Radiance", "CSV table"),
        (b"\x89HDF\r\n\x1a\n\0\0", "HDF5", "CSV table"),
        (b"%PDF-1.4\n", "PDF", "CSV table"),
    ] {
        let error = open(bytes.to_vec(), &mut unwatched).err().expect(name).to_string();
        assert!(error.contains(name) && error.contains(advice), "{error}");
    }
    // The columns of ASTM text are named by the user.
    let mapping = pbrdf::measurement::Mapping::from_text("theta_i=1,theta_r=3,brdf=5").expect("a mapping");
    let text =
        b"SAMPLE: plate A\nWAVELENGTH 0.65\nVARS=theta_i,phi_i,theta_s,phi_s,brdf\n30.0,0.0,10.0,180.0,0.21\n30.0,0.0,20.0,180.0,0.55\n";
    let imported = mapping.read_table(text, &mut unwatched).expect("a table under its head");
    let measurement = &imported.measurements[0];
    assert_eq!((measurement.rows.len(), measurement.wavelength_nm()), (2, Some(650.0)));
    assert_eq!(measurement.rows[1].brdf.map(|brdf| brdf.value), Some(0.55));
}
