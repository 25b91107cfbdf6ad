//! Reading and writing measurements: what is accepted is read right, what is refused says where and why.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]

use pbrdf::fit::Bounds;
use pbrdf::measurement::formats::{ImportError, Imported};
use pbrdf::measurement::{ImportNote, LineList, Mapping, Measurement, ReadError, append_columns, unwatched, write_measurements};
use pbrdf::model::{Parameter, assignment_from_text};
use pbrdf::optics::{Geometry, shortest};
use std::ops::ControlFlow;

fn read(text: impl AsRef<[u8]>) -> Result<Measurement, ReadError> {
    Measurement::read(text.as_ref())
}

fn accepted(text: impl AsRef<[u8]>) -> Measurement {
    read(text.as_ref()).unwrap_or_else(|error| panic!("{error}: {:?}", String::from_utf8_lossy(text.as_ref())))
}

#[test]
fn separators_and_decimal_commas_are_understood() {
    let expected = accepted("theta_i,theta_r,dolp,dolp_sigma\n30.5,20,0.125,0.01\n");
    for text in [
        "theta_i;theta_r;dolp;dolp_sigma\n30,5;20;0,125;0,01\n",
        "theta_i\ttheta_r\tdolp\tdolp_sigma\n30,5\t20\t0.125\t1e-2\n",
        "\u{feff}theta_i,theta_r,dolp,dolp_sigma\r\n30.5,20,0.125,0.01\r\n",
        "dolp_sigma,dolp,theta_r,theta_i\n0.01,0.125,20,30.5\n",
        "theta_i,theta_r,dphi,dolp_percent,dolp_sigma\n30.5,20,180,12.5,0.01\n",
        "  theta_i , theta_r,\"dolp\",dolp_sigma\n\n \n30.5, 20 ,\"0.125\",0.01",
        "theta_i,theta_r,dolp,dolp_sigma\r30.5,20,0.125,0.01\r",
    ] {
        assert_eq!(accepted(text).rows, expected.rows, "{text:?}");
    }
}

#[test]
fn comments_stand_anywhere_and_carry_metadata() {
    let text = b"# material: steel\n#no colon\n   # note: a, \"b; c\ntheta_i,theta_r,dolp\n# f\xfcr: Stra\xdfe\n30,20,0.1\n#: no key\n";
    let measurement = accepted(text);
    assert_eq!(measurement.rows.len(), 1);
    assert_eq!(measurement.metadata("material"), Some("steel"));
    assert_eq!(measurement.metadata("note"), Some("a, \"b; c"));
    assert_eq!(measurement.metadata.len(), 3);
}

#[test]
fn a_negative_theta_r_is_the_backscatter_side() {
    let rows = accepted("theta_i,theta_r,dphi,brdf\n30,-20,180,1\n30,20,0,1\n30,20,540,1\n").rows;
    assert_eq!(rows[0], rows[1]);
    assert_eq!(rows[0].geometry.signed_theta_r().0, -20.0);
    assert_eq!(rows[2].geometry.dphi().0, 540.0);
}

#[test]
fn an_empty_cell_is_a_value_not_measured() {
    let rows =
        accepted("theta_i,theta_r,dolp,dolp_sigma,brdf,masked,colour\n30,20,0.1,0.01,,0,red\n30,25,,,0.4,1,\n30,30,0.2,,1,,x\n").rows;
    assert_eq!((rows[0].dolp.map(|q| q.value), rows[0].brdf), (Some(0.1), None));
    assert_eq!((rows[1].dolp, rows[1].masked), (None, true));
    assert_eq!(rows[2].dolp.and_then(|q| q.sigma), None);
}

#[test]
fn unknown_columns_are_named_and_ignored() {
    let measurement = accepted("theta_i,theta_r,dolp,colour,comment\n30,20,0.1,red,\"a, b\"\n");
    assert_eq!(measurement.ignored_columns, ["colour", "comment"]);
}

#[test]
fn what_does_not_fit_is_refused_with_its_place() {
    let head = "# a: b\ntheta_i,theta_r,dphi,dolp,dolp_sigma,masked\n";
    for (row, place, reason) in [
        ("30,20,180,abc,0.1,0", "line 3, column 4 (dolp)", "found \"abc\""),
        ("30,20,180,inf,0.1,0", "line 3, column 4 (dolp)", "found inf"),
        ("30,20,180,1e999,0.1,0", "line 3, column 4 (dolp)", "found 1e999"),
        ("30,20,180,1.01,0.1,0", "line 3, column 4 (dolp)", "from 0 to 1"),
        ("30,20,180,-0.01,0.1,0", "line 3, column 4 (dolp)", "from 0 to 1"),
        ("30,20,180,0.5,0,0", "line 3, column 5 (dolp_sigma)", "above 0"),
        ("30,20,180,0.5,-1,0", "line 3, column 5 (dolp_sigma)", "above 0"),
        ("30,20,180,0.5,0.1,2", "line 3, column 6 (masked)", "0 or 1"),
        ("30,20,180,,,0", "line 2", "no row has a value"),
        (",20,180,0.5,0.1,0", "line 3, column 1 (theta_i)", "empty"),
        ("30,,180,0.5,0.1,0", "line 3, column 2 (theta_r)", "empty"),
        ("30,20,,0.5,0.1,0", "line 3, column 3 (dphi)", "empty"),
        ("90,20,180,0.5,0.1,0", "line 3, column 1 (theta_i)", "θi < 90"),
        ("-1,20,180,0.5,0.1,0", "line 3, column 1 (theta_i)", "θi < 90"),
        ("30,90,180,0.5,0.1,0", "line 3, column 2 (theta_r)", "θr < 90"),
        ("30,-90,180,0.5,0.1,0", "line 3, column 2 (theta_r)", "θr < 90"),
        ("30,-20,0,0.5,0.1,0", "line 3, column 2 (theta_r)", "backscatter"),
        ("30,20,inf,0.5,0.1,0", "line 3, column 3 (dphi)", "found inf"),
        ("30,20,180,0.5,0.1", "line 3", "5 cells; expected 6"),
        ("30,20,180,0.5,0.1,0,7", "line 3", "7 cells; expected 6"),
        ("30,20,180,\"0.5,0.1,0", "line 3, column 4", "quote"),
        ("30,20,180,0.5\0,0.1,0", "line 3, column 4", "NUL"),
    ] {
        let error = read(format!("{head}{row}\n")).expect_err(row).to_string();
        assert!(error.starts_with(place) && error.contains(reason), "{row:?}: {error}");
    }
}

#[test]
fn places_count_comments_empty_lines_and_all_line_ends() {
    let head = "# a: b\n\n   # c\ntheta_i,theta_r,dolp\n";
    for (text, place) in [
        ("# a: b\n# c\n\nAOI,theta_r,dolp\n30,20,0.1\n".to_owned(), "line 4: the column theta_i"),
        ("# a: b\n# c\ntheta_i,theta_r\n30,20\n".to_owned(), "line 3: neither"),
        ("# a: b\n\n30,20,0.1\n".to_owned(), "line 3: there is no header"),
        (format!("{head}# d\n"), "line 4: there is a header but no row"),
        ("#\ntheta_i,theta_r,dolp,dolp\n30,20,0.1,0.1\n".to_owned(), "line 2, column 4 (dolp)"),
        (format!("{head}# d\n30,20,1.5\n"), "line 6, column 3 (dolp)"),
        (format!("{head}30,20,0.1\n \n# d\n\n30,20,x"), "line 9, column 3 (dolp)"),
        (format!("{head}30,20,0.1\n\n30,20,0.1,7\n"), "line 7: the row has 4 cells"),
    ] {
        for line_end in ["\n", "\r\n", "\r"] {
            let text = text.replace('\n', line_end);
            let error = read(&text).expect_err(place).to_string();
            assert!(error.starts_with(place), "{text:?}: {error}");
        }
    }
    let measurement = accepted(format!("{head}30,20,0.1\r\n\r\n# d\r\n30,25,0.1"));
    assert_eq!(measurement.lines, [5, 8]);
}

#[test]
fn files_that_are_no_table_are_refused() {
    for (text, reason) in [
        (&b""[..], "empty"),
        (b"\n\n", "empty"),
        (b"# only: a comment\n", "empty"),
        (b"theta_i,theta_r,dolp\n", "no row"),
        (b"30,20,0.1\n30,25,0.2\n", "no header"),
        (b"theta_i,dolp\n30,0.1\n", "theta_r"),
        (b"theta_r,dolp\n30,0.1\n", "theta_i"),
        (b"theta_i,theta_r\n30,20\n", "neither dolp nor brdf"),
        (b"theta_i,theta_r,dolp,dolp\n30,20,0.1,0.1\n", "column 4 (dolp)"),
        (b"theta_i,theta_r,dolp,dolp_percent\n30,20,0.1,10\n", "column 4 (dolp_percent)"),
        (b"theta_i,theta_r,theta_i,dolp\n30,20,30,0.1\n", "column 3 (theta_i)"),
        (b"\xff\xfet\0h\0e\0", "UTF-16"),
        (b"t\0h\0e\0t\0a\0", "NUL"),
    ] {
        let error = read(text).expect_err("a refusal").to_string();
        assert!(error.contains(reason), "{:?}: {error}", String::from_utf8_lossy(text));
    }
}

#[test]
fn a_million_rows_tell_progress_and_can_be_stopped() {
    let mut text = String::from("theta_i,theta_r,dolp\n");
    for i in 0..1_000_000 {
        text.push_str(if i % 2 == 0 { "30,20,0.1\n" } else { "30,25.5,0.25\n" });
    }
    let mut reports = 0;
    let measurement = Measurement::read_with(text.as_bytes(), &mut |done| {
        reports += 1;
        assert!((0.0..=1.0).contains(&done));
        ControlFlow::Continue(())
    });
    assert_eq!(measurement.expect("a good file").rows.len(), 1_000_000);
    assert!(reports > 100);
    let stopped = Measurement::read_with(text.as_bytes(), &mut |_| ControlFlow::Break(()));
    assert!(stopped.expect_err("a stop").to_string().contains("cancelled"));
}

#[test]
fn what_is_written_reads_back_the_same() {
    let text =
        "# material: x\ntheta_i,theta_r,dphi,dolp,dolp_sigma,brdf,masked\n30,20,180,0.1,0.003,,0\n30.1,25,33.3,,,0.3333333333333333,1\n";
    let measurement = accepted(text);
    let mut written = Vec::new();
    measurement.write(&mut written).expect("memory takes everything");
    assert_eq!(accepted(&written), measurement);
}

#[test]
fn numbers_are_written_in_the_shortest_form_that_reads_back() {
    for (number, text) in [
        (0.1, "0.1"),
        (1.0 / 3.0, "0.3333333333333333"),
        (30.0, "30"),
        (-0.0, "0"),
        (1e-7, "1e-7"),
        (2.5e300, "2.5e300"),
        (5e-324, "5e-324"),
        (f64::MAX, "1.7976931348623157e308"),
    ] {
        assert_eq!((shortest(number).as_str(), text.parse()), (text, Ok(number)));
    }
}

#[test]
fn sentences_write_numbers_as_short() {
    let geometry = Geometry::new(1e300, 0.0, 180.0).expect_err("no such angle");
    assert_eq!(geometry.to_string(), "theta_i = 1e300 is outside 0 ≤ θi < 90 degrees");
    let value = assignment_from_text("n=1e308").expect_err("n has an end");
    assert_eq!(value.to_string(), "n = 1e308 is not allowed: expected a number from 0 to 1e10");
    let bounds = Bounds::default().set(Parameter::N, 1e-320, 1e300).expect_err("n has an end");
    assert_eq!(bounds.to_string(), "bound 1e300 of n is not allowed: expected a number from 0 to 1e10");
}

const SETS: &str = "# operator: JL\nset,wavelength_nm,theta_i,theta_r,dolp\nplate; \"a\",450,40,20,0.1\nb,650,40,20,0.2\nplate; \"a\",450,40,25,0.3\nb,550,40,20,0.4\n";

#[test]
fn a_table_holds_several_measurements() {
    let text = SETS.replace("plate; \"a\"", "\"plate; a\"");
    let all = Measurement::read_sets(text.as_bytes(), &mut unwatched).expect("a good table");
    let told: Vec<_> = all.iter().map(|one| (one.name.as_str(), one.wavelength_nm(), one.rows.len(), one.metadata("operator"))).collect();
    let operator = Some("JL");
    assert_eq!(told, [("plate; a", Some(450.0), 2, operator), ("b", Some(650.0), 1, operator), ("b", Some(550.0), 1, operator)]);
    assert_eq!(accepted(&text).rows.len(), 4);
    let mut written = Vec::new();
    write_measurements(&all, &mut written).expect("memory takes everything");
    let mut again = Measurement::read_sets(&written[..], &mut unwatched).expect("what was written");
    for (again, one) in again.iter_mut().zip(&all) {
        again.lines.clone_from(&one.lines);
    }
    assert_eq!(again, all);
    let error = Measurement::read_sets(&b"wavelength_nm,theta_i,theta_r,dolp\n0,40,20,0.1\n"[..], &mut unwatched).expect_err("0 nm");
    assert!(error.to_string().contains("line 2, column 1 (wavelength_nm): found 0"), "{error}");
}

#[test]
fn words_for_what_was_not_measured_mask_their_row() {
    for word in ["nan", "NaN", "NA", "N/A", "n.a.", "#N/A", "#DIV/0!", "-", "--", ""] {
        let measurement =
            accepted(format!("theta_i,theta_r,dolp,dolp_sigma,brdf\n30,20,0.1,,1\n30,25,{word},0.1,{word}\n30,30,{word},NaN,2\n"));
        let rows: Vec<_> = measurement.rows.iter().map(|row| (row.dolp.is_some(), row.brdf.is_some(), row.masked)).collect();
        assert_eq!(rows, [(true, true, false), (false, false, true), (false, true, false)], "{word}");
        let lines: Vec<u64> = if word.is_empty() { vec![3] } else { vec![3, 4] };
        assert_eq!(measurement.notes, [ImportNote::NotMeasured(LineList { count: lines.len(), first: lines })], "{word}");
    }
    let error = read("theta_i,theta_r,dolp\n30,20,NaN\n30,25,-\n").expect_err("nothing is measured").to_string();
    assert!(error.contains("no row has a value of DoLP or BRDF"), "{error}");
}

#[test]
fn a_masked_row_may_hold_what_is_impossible() {
    let measurement = accepted("theta_i,theta_r,dolp,masked\n30,5,-0.0012,1\n30,20,0.1,0\n30,-90,0.2,1\n");
    assert_eq!((measurement.rows[0].dolp, measurement.rows[0].masked), (None, true));
    assert_eq!((measurement.rows.len(), measurement.beyond_horizon[0].theta_r), (2, -90.0));
    let lines = |line| LineList { count: 1, first: vec![line] };
    assert_eq!(measurement.notes, [ImportNote::NotMeasured(lines(2)), ImportNote::BeyondHorizon(lines(4))]);
    let mut written = Vec::new();
    measurement.write(&mut written).expect("memory takes everything");
    let again = accepted(&written);
    assert_eq!((again.rows, again.beyond_horizon), (measurement.rows, measurement.beyond_horizon));
}

#[test]
fn rows_of_nothing_but_separators_are_skipped_with_a_notice() {
    let measurement = accepted("theta_i,theta_r,dolp\n30,20,0.1\n,,\n30,25,0.2\n , ,\n");
    assert_eq!((measurement.rows.len(), measurement.lines.clone()), (2, vec![2, 4]));
    assert_eq!(measurement.notes, [ImportNote::BlankRows(LineList { count: 2, first: vec![3, 5] })]);
}

#[test]
fn a_column_has_one_decimal_mark() {
    for (text, place) in [
        ("theta_i;theta_r;brdf\n30;20;87,3\n30;28;532,5\n30;30;1.234\n", "line 4, column 3 (brdf): found \"1.234\""),
        ("theta_i\ttheta_r\tbrdf\n30\t20\t87.3\n30\t30\t\"1,234\"\n", "line 3, column 3 (brdf): found \"1,234\""),
    ] {
        let error = read(text).expect_err(text).to_string();
        assert!(error.starts_with(place) && error.contains("1.234 with a decimal mark and 1234 with a thousands separator"), "{error}");
    }
}

#[test]
fn a_header_may_hold_a_number_and_separators_in_quotes() {
    let measurement = accepted("theta_i,theta_r,dolp,550\n30,20,0.1,7\n");
    assert_eq!((measurement.rows.len(), measurement.ignored_columns), (1, vec!["550".to_owned()]));
    for (text, name) in [
        ("theta_i,theta_r,dolp,\"remark; free text\"\n30,20,0.1,ok\n", "remark; free text"),
        ("theta_i;theta_r;dolp;\"remark, free text\"\n30;20;0,1;ok\n", "remark, free text"),
    ] {
        assert_eq!(accepted(text).ignored_columns, [name]);
    }
}

#[test]
fn appended_columns_leave_the_rest_as_it_was() {
    let text = "\u{feff}# a: b\r\ntheta_i;dolp;theta_r\r\n\r\n30;0,1;20\r\n# c\r\n30;0,2;25";
    let mut out = Vec::new();
    append_columns(text.as_bytes(), &["x", "y"], &[4, 6], &[vec!["1".into(), String::new()], vec!["2".into(), "3".into()]], &mut out)
        .expect("memory takes everything");
    let expected = "\u{feff}# a: b\r\ntheta_i;dolp;theta_r;x;y\r\n\r\n30;0,1;20;1;\r\n# c\r\n30;0,2;25;2;3\n";
    assert_eq!(String::from_utf8_lossy(&out), expected);
}

#[test]
fn a_mapped_table_is_the_same_measurement() {
    let expected = accepted("theta_i,theta_r,dolp,dolp_sigma,brdf\n30,-20,0.125,0.01,2\n40,25,0.25,0.02,\n");
    let foreign = "AOI;View;note;DoLP %;err;f\n30;-0,3490658503988659;x;12,5;1;2\n40;0,4363323129985824;y;25;2;\n";
    let mapping = Mapping::from_text("theta_i=AOI,theta_r=2:radians,dolp=DoLP %:percent,dolp_sigma=err:percent,brdf=6").expect("a mapping");
    let imported = mapping.read_table(foreign.as_bytes(), &mut unwatched).expect("a good table");
    assert_eq!(imported.notes, [ImportNote::IgnoredColumns { names: vec!["note".to_owned()] }]);
    let read = &imported.measurements[0];
    for (row, expected) in read.rows.iter().zip(&expected.rows) {
        // An ulp of the conversion from radians and percent.
        assert!((row.geometry.theta_r().0 - expected.geometry.theta_r().0).abs() < 1e-13);
        assert_eq!((row.geometry.theta_i(), row.geometry.dphi()), (expected.geometry.theta_i(), expected.geometry.dphi()));
        assert_eq!((row.dolp, row.brdf), (expected.dolp, expected.brdf));
    }
    assert_eq!(read.rows.len(), expected.rows.len());
}

fn mapped(table: &str, mapping: &Mapping) -> Result<Measurement, ImportError> {
    mapping.read_table(table.as_bytes(), &mut unwatched).map(|mut imported| imported.measurements.swap_remove(0))
}

#[test]
fn an_angle_that_no_column_holds_is_a_constant() {
    let columns = Mapping::from_text("theta_r=1,dolp=2").expect("a mapping");
    let at = |theta_i, dphi| mapped("view,pol\n20,0.1\n25,0.2\n", &Mapping { theta_i, dphi, ..columns.clone() });
    let expected = accepted("theta_i,theta_r,dphi,dolp\n45,20,90,0.1\n45,25,90,0.2\n");
    assert_eq!(at(Some(45.0), Some(90.0)).expect("a good table").rows, expected.rows);
    let in_plane = at(Some(45.0), None).expect("a good table").rows;
    assert_eq!(in_plane[0].geometry.dphi().0, 180.0);
    for (theta_i, dphi, reason) in [
        (None, None, "no angle of incidence was found"),
        (Some(90.0), None, "theta_i = 90 is outside"),
        (Some(45.0), Some(f64::NAN), "dphi = NaN"),
    ] {
        let error = at(theta_i, dphi).expect_err(reason).to_string();
        assert!(error.contains(reason), "{error}");
    }
}

#[test]
fn a_table_without_anything_measured_is_told_so_whatever_its_angles_are_called() {
    for (header, names) in [("inc,view", "inc, view"), ("AOI (deg),view,colour", "AOI (deg), view, colour"), ("view,x", "view, x")] {
        let error = read(format!("{header}\n30,20,1\n")).expect_err(header).to_string();
        assert!(error.contains("neither dolp nor brdf") && error.ends_with(names), "{error}");
    }
}

#[test]
fn a_mapped_table_may_be_without_a_header() {
    let mapping = Mapping::from_text("theta_i=2,theta_r=3,dolp=5").expect("a mapping");
    let text = "# steel\nsteel;30,5;20;7;0,1\nsteel;30,5;25;7;0,2\n";
    let Imported { measurements, notes } = mapping.read_table(text.as_bytes(), &mut unwatched).expect("a good table");
    let table = &measurements[0];
    assert_eq!(table.rows, accepted("theta_i,theta_r,dolp\n30.5,20,0.1\n30.5,25,0.2\n").rows);
    let names = vec!["1".to_owned(), "4".to_owned()];
    assert_eq!((table.lines.clone(), notes), (vec![2, 3], vec![ImportNote::IgnoredColumns { names }]));
    let error = mapped("30,20,0.1\n", &Mapping::from_text("theta_i=1,theta_r=2,dolp=4").expect("a mapping")).expect_err("no column 4");
    assert!(error.to_string().ends_with("no column number 4 for dolp; the columns are 1, 2, 3"), "{error}");
    // A number as a name leaves a header one.
    let named = Mapping::from_text("theta_i=AOI,theta_r=view,dolp=3").expect("a mapping");
    assert_eq!(mapped("AOI,view,633\n30,20,0.1\n", &named).expect("a good table").rows.len(), 1);
}

#[test]
fn comments_of_a_mapped_table_are_kept_and_survive_writing() {
    let table = "# date 2024-05-01 12:30 operator JL, 633 nm HeNe\n# material: steel\n#\n# ----\nAOI,view,dolp\n30,20,0.1\n# lamp off\n";
    let measurement = mapped(table, &Mapping::from_text("theta_i=1,theta_r=2,dolp=3").expect("a mapping")).expect("a good table");
    let expected = [
        ("comment", "date 2024-05-01 12:30 operator JL, 633 nm HeNe"),
        ("material", "steel"),
        ("comment", "lamp off"),
        ("wavelength_nm", "633"),
    ];
    assert_eq!(measurement.metadata, expected.map(|(key, value)| (key.to_owned(), value.to_owned())));
    let mut written = Vec::new();
    measurement.write(&mut written).expect("memory takes everything");
    assert_eq!(accepted(&written).metadata, measurement.metadata);
}

#[test]
fn a_mapping_that_does_not_fit_its_table_is_refused_with_its_place() {
    for (mapping, table, place, reason) in [
        ("theta_i=AOI,theta_r=2,dolp=3", "a,b,c\n1,2,0.3\n", "line 1", "no column \"AOI\" for theta_i; the columns are a, b, c"),
        ("theta_i=1,theta_r=0,dolp=3", "a,b,c\n1,2,0.3\n", "line 1", "no column number 0 for theta_r"),
        ("theta_i=1,theta_r=9,dolp=3", "a,b,c\n1,2,0.3\n", "line 1", "no column number 9 for theta_r"),
        ("theta_i=1,dolp=3", "a,b,c\n1,2,0.3\n", "", "no angle of view was found"),
        ("theta_i=1,theta_r=2", "a,b,c\n1,2,0.3\n", "", "no column for DoLP or BRDF was found"),
        ("theta_i=a,theta_r=2,dolp=3", "a,a,c\n1,2,0.3\n", "line 1, column 2 (a)", "only one is allowed"),
        ("theta_i=1,theta_r=2,dolp=3:percent", "a,b,c\n1,2,130\n", "line 2, column 3 (c)", "0 to 100 percent"),
        ("theta_i=1:radians,theta_r=2,dolp=3", "a,b,c\n1.6,2,0.3\n", "line 2, column 1 (a)", "found 1.6"),
        ("theta_i=1:radians,theta_r=2,dolp=3", "a,b,c\n1e308,2,0.3\n", "line 2, column 1 (a)", "found 1e308"),
        ("theta_i=1,theta_r=2,dolp=3", "a,b,c\n1,2,3D-1\n", "line 2, column 3 (c)", "exponent of Fortran"),
    ] {
        let mapping = Mapping::from_text(mapping).expect("a mapping");
        let error = mapped(table, &mapping).expect_err(table).to_string();
        assert!(error.starts_with(place) && error.contains(reason), "{table:?}: {error}");
    }
}
