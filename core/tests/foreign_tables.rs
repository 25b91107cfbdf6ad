//! Tables of other laboratories, made from known values in many forms: whatever the language, the separators, the units and the layout,
//! the values come out.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]

use pbrdf::measurement::foreign::{Doubt, LabTable, TableOptions};
use pbrdf::measurement::formats::{ImportError, ImportNote, Imported};
use pbrdf::measurement::{BrdfMeaning, Field, unwatched};
use std::fmt::Write as _;

/// θi, signed θr and value, with its standard deviation.
type Value = (f64, f64, f64);

const SIGMA: f64 = 0.004;

fn values() -> Vec<Value> {
    let all = [30.0_f64, 45.0, 60.0].into_iter().flat_map(|theta_i| {
        [20.0_f64, 30.0, 40.0, 55.0].map(|theta_r| (theta_i, theta_r, (10.0 * (theta_i + 3.0 * theta_r)).round() / 10_000.0))
    });
    all.collect()
}

fn read(bytes: impl AsRef<[u8]>, options: &TableOptions) -> Result<Imported, ImportError> {
    LabTable::open(bytes.as_ref().to_vec(), options, &mut unwatched)?.read(options, &mut unwatched)
}

/// The values that are used, of all measurements.
fn used(imported: &Imported, of_brdf: bool) -> Vec<Value> {
    let rows = imported.measurements.iter().flat_map(|measurement| &measurement.rows).filter(|row| !row.masked);
    let mut found: Vec<Value> = rows
        .filter_map(|row| {
            let quantity = if of_brdf { row.brdf } else { row.dolp }?;
            Some((row.geometry.theta_i().0, row.geometry.signed_theta_r().0, quantity.value))
        })
        .collect();
    found.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
    found
}

fn assert_values(text: &str, bytes: &[u8], options: &TableOptions, of_brdf: bool, expected: &[Value]) -> Imported {
    let imported = read(bytes, options).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let found = used(&imported, of_brdf);
    let mut expected = expected.to_vec();
    expected.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
    // Radians and propagated quantities are written with nine digits.
    let is_near = |a: &Value, b: &Value| (a.0 - b.0).abs() < 1e-6 && (a.1 - b.1).abs() < 1e-6 && (a.2 - b.2).abs() < 1e-7;
    let is_same = found.len() == expected.len() && found.iter().zip(&expected).all(|(a, b)| is_near(a, b));
    assert!(is_same, "{found:?}\n{text}");
    imported
}

/// A form of a table: words, separator, decimal mark, units.
struct Form {
    /// θi, θr, DoLP, its standard deviation.
    words: [&'static str; 4],
    separator: &'static str,
    comma: bool,
    /// Percent in the heading, in a row of units, in each cell, or not at all.
    percent: Percent,
    radians: bool,
    preamble: &'static [&'static str],
    footer: &'static [&'static str],
    hash: bool,
}

#[derive(Clone, Copy, PartialEq)]
enum Percent {
    No,
    Heading,
    Units,
    Cells,
}

impl Form {
    fn number(&self, number: f64, digits: usize) -> String {
        let text = format!("{number:.digits$}");
        if self.comma { text.replace('.', ",") } else { text }
    }

    fn table(&self, values: &[Value]) -> String {
        let mut text = String::new();
        self.preamble.iter().for_each(|line| writeln!(text, "{line}").expect("memory"));
        let [theta_i, theta_r, dolp, sigma] = self.words;
        let angle = |word: &str| if self.radians { format!("{word} [rad]") } else { word.to_owned() };
        let dolp = if self.percent == Percent::Heading { format!("{dolp} (%)") } else { dolp.to_owned() };
        let is_blank = self.separator == " ";
        let name = |name: String| if is_blank { name.replace(' ', "_") } else { name };
        let names = [angle(theta_i), angle(theta_r), dolp, sigma.to_owned()].map(name);
        writeln!(text, "{}{}", if self.hash { "# " } else { "" }, names.join(self.separator)).expect("memory");
        if self.percent == Percent::Units {
            let unit = if self.radians { "rad" } else { "deg" };
            writeln!(text, "{}", [unit, unit, "%", "%"].join(self.separator)).expect("memory");
        }
        let scale = if self.percent == Percent::No { 1.0 } else { 100.0 };
        for &(theta_i, theta_r, value) in values {
            let angle = |degrees: f64| if self.radians { self.number(degrees.to_radians(), 12) } else { self.number(degrees, 1) };
            let mark = if self.percent == Percent::Cells { " %" } else { "" };
            let cells = [
                angle(theta_i),
                angle(theta_r),
                format!("{}{mark}", self.number(value * scale, 4)),
                format!("{}{mark}", self.number(SIGMA * scale, 4)),
            ];
            writeln!(text, "{}", cells.join(self.separator)).expect("memory");
        }
        self.footer.iter().for_each(|line| writeln!(text, "{line}").expect("memory"));
        text
    }
}

/// The bytes of a text in the encodings that can hold it.
fn encoded(text: &str) -> Vec<Vec<u8>> {
    let utf_16: Vec<u8> = [0xfeff].into_iter().chain(text.encode_utf16()).flat_map(u16::to_le_bytes).collect();
    let mut all = vec![text.as_bytes().to_vec(), format!("\u{feff}{text}").replace('\n', "\r\n").into_bytes(), utf_16];
    // Latin letters are the same in Windows-1252, which is told by bytes that are no UTF-8.
    if text.contains('ü') && text.chars().all(|letter| (letter as u32) < 256) {
        all.push(text.chars().map(|letter| u8::try_from(letter as u32).expect("a Latin letter")).collect());
    }
    all
}

const WORDS: [[&str; 4]; 12] = [
    ["AOI", "view", "DoLP", "DoLP_err"],
    ["theta_i", "theta_det", "P", "uncertainty"],
    ["Angle of incidence", "Viewing angle", "Degree of linear polarization", "std"],
    ["inc_angle", "VA", "DOP", "σ"],
    ["θ_i", "θ_r", "dolp", "u(dolp)"],
    ["source angle", "detector angle", "lin. polarisation", "error"],
    ["Einfallswinkel", "Beobachtungswinkel", "Polarisationsgrad", "Standardabweichung"],
    ["Beleuchtungswinkel", "Detektorwinkel", "linearer Polarisationsgrad", "Fehler"],
    ["Lichteinfallswinkel", "Streuwinkel", "Polarisationsgrad für S", "Messunsicherheit"],
    ["入射角", "观测角", "偏振度", "误差"],
    ["光源角度", "探测角", "线偏振度", "偏振度标准差"],
    ["入射天顶角", "散射角", "线性偏振度", "不确定度"],
];

const PREAMBLES: [&[&str]; 5] = [
    &[],
    &["Messung Probe 7", "Datum: 3. Mai", ""],
    &["# Goniometer scan 7", "# date 2024-05-01 12:30", "# Integration time (ms): 200"],
    &["Operator;J. Lee", "Instrument: GON-360, SN 1234", "Laser power 5 mW", "Averages = 3", "", ""],
    &["测量报告", "日期：2024-05-01", "样品：铝板"],
];

#[test]
fn plain_tables_in_every_language_notation_and_encoding() {
    let values = values();
    let mut number = 0;
    for words in WORDS {
        for (separator, comma) in
            [(",", false), (";", true), (";", false), ("\t", true), ("\t", false), (" ", false), (" ", true), ("   ", false)]
        {
            for percent in [Percent::No, Percent::Heading, Percent::Units, Percent::Cells] {
                number += 1;
                if separator == " " && percent == Percent::Cells {
                    continue;
                }
                let form = Form {
                    words,
                    separator,
                    comma,
                    percent,
                    radians: number % 5 == 0,
                    preamble: PREAMBLES[number % PREAMBLES.len()],
                    footer: [&[][..], &["", "Mittelwert"], &["end of file"]][number % 3],
                    hash: number % 7 == 0,
                };
                let text = form.table(&values);
                let bytes = encoded(&text);
                let imported = assert_values(&text, &bytes[number % bytes.len()], &TableOptions::default(), false, &values);
                let sigmas = imported.measurements[0].rows.iter().map(|row| row.dolp.and_then(|dolp| dolp.sigma).unwrap_or(0.0));
                assert!(sigmas.into_iter().all(|sigma| (sigma - SIGMA).abs() < 1e-12), "{text}");
                let skipped = imported.notes.iter().any(|note| matches!(note, ImportNote::SkippedLines(_)));
                assert_eq!(skipped, number % 3 != 0, "{text}");
            }
        }
    }
    assert!(number > 300);
}

#[test]
fn wide_tables_by_angle_and_by_wavelength() {
    let values = values();
    let titles = ["Degree of linear polarisation", "# DoLP of plate 3", "Polarisationsgrad", "偏振度测量"];
    for (index, corner) in ["view angle\\AOI", "view", "Detektorwinkel \\ Einfallswinkel", "观测角\\入射角", "θr"].into_iter().enumerate()
    {
        for place in ["{}", "{}°", "AOI {}", "θi={}°", "{} deg", "入射角{}°"] {
            let mut text = format!("{}\n\n{corner}", titles[index % titles.len()]);
            for theta_i in ["30", "45", "60"] {
                write!(text, ";{}", place.replace("{}", theta_i)).expect("memory");
            }
            for theta_r in [20.0, 30.0, 40.0, 55.0] {
                write!(text, "\n{theta_r}").expect("memory");
                for value in values.iter().filter(|value| value.1 == theta_r) {
                    write!(text, ";{}", value.2.to_string().replace('.', ",")).expect("memory");
                }
            }
            assert_values(&text, text.as_bytes(), &TableOptions::default(), false, &values);
            let untitled = text.lines().skip(1).collect::<Vec<_>>().join("\n");
            assert!(
                matches!(read(&untitled, &TableOptions::default()), Err(ImportError::Undecided { doubts })
                if matches!(doubts[..], [Doubt::WideQuantity { .. }])),
                "{untitled}"
            );
            let brdf = TableOptions { wide: Some(Field::Brdf), ..TableOptions::default() };
            assert_values(&untitled, untitled.as_bytes(), &brdf, true, &values);
        }
    }
    for names in ["DoLP 450 nm,DoLP 550 nm", "450nm DoLP,550nm DoLP", "DoLP (450),DoLP (550)", "DoLP_450,DoLP_550"] {
        let text = format!("AOI,view,{names}\n40,20,0.1,0.2\n40,30,0.3,0.4\n");
        let imported = read(&text, &TableOptions::default()).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let told: Vec<_> = imported.measurements.iter().map(|one| (one.name.as_str(), one.wavelength_nm(), one.rows.len())).collect();
        assert_eq!(told, [("450 nm", Some(450.0), 2), ("550 nm", Some(550.0), 2)], "{text}");
    }
}

#[test]
fn blocks_repeated_headers_and_long_tables() {
    let values = values();
    for title in
        ["AOI = {} deg", "Angle of incidence: {}°", "# theta_i={}", "Einfallswinkel {}°", "入射角：{}°", "--- Scan at AOI {} deg ---"]
    {
        for (repeats, header) in
            [(true, "view DoLP"), (false, "view DoLP"), (true, "Detektorwinkel;Polarisationsgrad"), (true, "观测角,偏振度")]
        {
            let separator = [" ", ";", ","].into_iter().find(|separator| header.contains(separator)).expect("two names");
            let mut text = String::new();
            for (block, theta_i) in [30.0, 45.0, 60.0].into_iter().enumerate() {
                writeln!(text, "{}", title.replace("{}", &theta_i.to_string())).expect("memory");
                if repeats || block == 0 {
                    writeln!(text, "{header}").expect("memory");
                }
                for value in values.iter().filter(|value| value.0 == theta_i) {
                    writeln!(text, "{}{separator}{}", value.1, value.2).expect("memory");
                }
                text.push('\n');
            }
            assert_values(&text, text.as_bytes(), &TableOptions::default(), false, &values);
        }
    }
    let text = "AOI,view,DoLP\n30,20,0.1\nAOI,view,DoLP\n40,20,0.2\n";
    assert_values(text, text.as_bytes(), &TableOptions::default(), false, &[(30.0, 20.0, 0.1), (40.0, 20.0, 0.2)]);
    let text =
        "Probe;Wellenlänge (µm);Einfallswinkel;Blickwinkel;P\ncopper A;0,45;40;20;0,1\ncopper A;0,65;40;20;0,2\nsteel;0,45;40;20;0,3\n";
    let imported = read(text, &TableOptions::default()).expect("a long table");
    let told: Vec<_> = imported.measurements.iter().map(|one| (one.name.as_str(), one.wavelength_nm())).collect();
    assert_eq!(told, [("copper A 450 nm", Some(450.0)), ("copper A 650 nm", Some(650.0)), ("steel", Some(450.0))]);
}

#[test]
fn quantities_of_a_polarimeter() {
    // S0 = 1000, DoLP 0.5 along 30°: S1 = 433.0127019, S2 = 250.
    let (s1, s2) = (433.012_701_9, 250.0);
    let i = |sign_1: f64, sign_2: f64| 500.0 + 0.5 * (sign_1 * s1 + sign_2 * s2);
    let (i0, i45, i90, i135) = (i(1.0, 0.0), i(0.0, 1.0), i(-1.0, 0.0), i(0.0, -1.0));
    let expected = [(40.0, 20.0, 0.5), (40.0, 30.0, 0.5)];
    let mueller = |base: u32, divisor: f64| {
        let names: Vec<String> = (0..16).map(|index| format!("m{}{}", index / 4 + base, index % 4 + base)).collect();
        let element = |index: usize| match index {
            0 => 0.25,
            4 => 0.25 * 0.433_012_701_9 / divisor,
            8 => 0.25 * 0.25 / divisor,
            5 | 10 | 15 => 0.2 / divisor,
            _ => 0.0,
        };
        (names.join(","), (0..16).map(|index| element(index).to_string()).collect::<Vec<_>>().join(","))
    };
    let mut tables: Vec<(String, String)> = ["S0,S1,S2", "s_0,s_1,s_2", "Stokes S0,Stokes S1,Stokes S2", "I,Q,U"]
        .map(|names| (names.to_owned(), format!("1000,{s1},{s2}")))
        .to_vec();
    tables.extend(
        ["I0,I45,I90,I135", "I_0,I_45,I_90,I_135", "I(0°),I(45°),I(90°),I(135°)", "Intensity 0,Intensity 45,Intensity 90,Intensity 135"]
            .map(|names| (names.to_owned(), format!("{i0},{i45},{i90},{i135}"))),
    );
    tables.extend([mueller(0, 1.0), mueller(1, 1.0), mueller(1, 0.25), mueller(0, 0.25)]);
    tables.extend([("S0,S1/S0,S2/S0".to_owned(), format!("1000,{},{}", s1 / 1000.0, s2 / 1000.0))]);
    for (names, cells) in tables {
        let text = format!("AOI,view,{names}\n40,20,{cells}\n40,30,{cells}\n");
        assert_values(&text, text.as_bytes(), &TableOptions::default(), false, &expected);
    }
    for (names, cells, dolp) in [("Rs,Rp", "0.6,0.2", 0.5), ("Rp,Rs", "20,60", 0.5), ("Psi,Delta", "30,120", 0.5), ("Δ,ψ", "120,30", 0.5)]
    {
        let text = format!("Angle (deg);{}\n50;{}\n60;{}\n", names.replace(',', ";"), cells.replace(',', ";"), cells.replace(',', ";"));
        assert_values(&text, text.as_bytes(), &TableOptions::default(), false, &[(50.0, 50.0, dolp), (60.0, 60.0, dolp)]);
    }
    // The error of each is that of the first derivatives: √(0.5² 1² + 0.75 2² + 0.25 2²)/1000.
    let text = format!("AOI,view,S0,S0_err,S1,S1_err,S2,S2_err\n40,20,1000,1,{s1},2,{s2},2\n40,30,1000,1,{s1},2,{s2},2\n");
    let imported = assert_values(&text, text.as_bytes(), &TableOptions::default(), false, &expected);
    let sigma = imported.measurements[0].rows[0].dolp.and_then(|dolp| dolp.sigma).expect("all errors are stated");
    assert!((sigma - 4.25_f64.sqrt() / 1000.0).abs() < 1e-9, "{sigma}");
    // S0 is a BRDF where its heading says so.
    let text = "AOI,view,S0 [1/sr],S1,S2\n40,20,2,1,0\n40,30,4,1,0\n";
    assert_values(text, text.as_bytes(), &TableOptions::default(), true, &[(40.0, 20.0, 2.0), (40.0, 30.0, 4.0)]);
    let small = "AOI,view,S0,S0_err,S1,S1_err,S2,S2_err\n40,20,1000,1,2,2,0,2\n40,30,1000,1,300,2,0,2\n";
    let notes = read(small, &TableOptions::default()).expect("a good table").notes;
    assert!(notes.iter().any(|note| matches!(note, ImportNote::BiasedDolp(lines) if lines.first == [2])), "{notes:?}");
    let open = read("AOI,view,m11,m21,m31\n40,20,1,0.1,0\n40,30,1,0.1,0\n", &TableOptions::default());
    assert!(matches!(open, Err(ImportError::Undecided { doubts }) if doubts[..] == [Doubt::MuellerCount]));
}

#[test]
fn angles_are_put_in_this_programs_convention() {
    let with = |flip| TableOptions { flip, ..TableOptions::default() };
    let around = "AOI,view,DoLP\n45,340,0.1\n45,0,0.2\n45,20,0.3\n";
    let imported =
        assert_values(around, around.as_bytes(), &with(false), false, &[(45.0, -20.0, 0.1), (45.0, 0.0, 0.2), (45.0, 20.0, 0.3)]);
    assert!(imported.notes.contains(&ImportNote::WrappedAngles));
    let negative = "AOI,view,DoLP\n45,-40,0.1\n45,-20,0.3\n";
    let imported = assert_values(negative, negative.as_bytes(), &with(false), false, &[(45.0, -40.0, 0.1), (45.0, -20.0, 0.3)]);
    assert!(imported.notes.contains(&ImportNote::AllBackscatter) && ImportNote::AllBackscatter.to_string().contains("--flip"));
    assert_values(negative, negative.as_bytes(), &with(true), false, &[(45.0, 40.0, 0.1), (45.0, 20.0, 0.3)]);
    let horizon = "AOI,view,DoLP\n45,-90,0\n45,20,0.3\n45,90,0\n";
    let imported = assert_values(horizon, horizon.as_bytes(), &with(false), false, &[(45.0, 20.0, 0.3)]);
    assert_eq!(imported.measurements[0].beyond_horizon.len(), 2);
    let azimuths = "theta_i,phi_i,theta_s,phi_s,brdf\n30,10,20,190,1\n30,10,20,100,2\n";
    let rows = read(azimuths, &with(false)).expect("two azimuths").measurements.swap_remove(0).rows;
    assert_eq!([rows[0].geometry.dphi().0, rows[1].geometry.dphi().0], [180.0, 90.0]);
}

#[test]
fn what_brdf_means_is_asked_where_the_heading_does_not_say() {
    let table = |heading: &str| format!("AOI,view,{heading}\n30,60,0.35\n30,20,0.5\n");
    let read_as = |heading: &str, brdf_is| read(table(heading), &TableOptions { brdf_is, ..TableOptions::default() });
    for heading in ["reflectance", "Reflexionsgrad", "反射率"] {
        let open = read_as(heading, None);
        assert!(matches!(open, Err(ImportError::Undecided { doubts }) if matches!(doubts[..], [Doubt::BrdfMeaning { .. }])), "{heading}");
    }
    for (heading, chosen, divisor) in [
        ("reflectance", Some(BrdfMeaning::Factor), std::f64::consts::PI),
        ("reflectance factor", None, std::f64::consts::PI),
        ("Reflexionsfaktor", None, std::f64::consts::PI),
        ("BRDF cos", None, 0.5),
        ("reflectance", Some(BrdfMeaning::BrdfCos), 0.5),
        ("BRDF", None, 1.0),
        ("reflectance", Some(BrdfMeaning::Brdf), 1.0),
    ] {
        let imported = read_as(heading, chosen).unwrap_or_else(|error| panic!("{heading}: {error}"));
        let measurement = &imported.measurements[0];
        let brdf = measurement.rows[0].brdf.expect("a value").value;
        assert!((brdf - 0.35 / divisor).abs() < 1e-12 && measurement.metadata("brdf_is").is_some(), "{heading}: {brdf}");
    }
}

#[test]
fn what_leaves_room_for_doubt_is_refused_with_its_place() {
    for (text, parts) in [
        ("theta_i;theta_r;brdf\n30;20;87,3\n30;28;532,5\n30;30;1.234\n", &["line 4, column 3 (brdf)", "1.234", "1234"][..]),
        ("theta_i\ttheta_r\tbrdf\n30\t20\t87.3\n30\t28\t532.5\n30\t30\t\"1,234\"\n", &["line 4, column 3 (brdf)", "1.234", "1234"]),
        ("AOI,view,DoLP\n30,20,1.5D-01\n30,30,0.1\n", &["line 2, column 3 (DoLP)", "Fortran"]),
        ("AOI,view,DoLP\n30,20,0.1\n30,30,about 0.2\n30,40,0.3\n", &["line 3, column 3 (DoLP)", "about 0.2"]),
        ("AOI,view,DoLP\n30,20,0.1\n3O,30,0.2\n30,40,0.3\n", &["line 3, column 1 (AOI)", "3O"]),
        ("AOI,view,DoLP\n30,20,0.1\n30,,0.2\n30,40,0.3\n", &["line 3, column 2 (view)", "empty"]),
        ("AOI,view,DoLP red,DoLP green\n30,20,0.1,0.2\n30,30,0.1,0.2\n", &["2 columns look like dolp", "3 (DoLP red)"]),
        ("AOI,view\n30,20\n30,30\n", &["no column for DoLP or BRDF"]),
        ("view,DoLP\n30,0.1\n40,0.2\n", &["no angle of incidence", "--theta-i"]),
        ("30,20,0.1\n30,30,0.2\n", &["no row names the 3 columns"]),
    ] {
        let error = read(text, &TableOptions::default()).expect_err(text).to_string();
        assert!(parts.iter().all(|part| error.contains(part)), "{error}\n{text}");
    }
    let thousands = TableOptions { thousands: Some('.'), ..TableOptions::default() };
    let text = "theta_i;theta_r;brdf\n30;20;87,3\n30;30;1.234\n30;40;1.234,5\n";
    assert_values(text, text.as_bytes(), &thousands, true, &[(30.0, 20.0, 87.3), (30.0, 30.0, 1234.0), (30.0, 40.0, 1234.5)]);
}

#[test]
fn an_angle_of_incidence_of_90_degrees_in_a_heading_is_refused_with_its_column() {
    let table = |last: &str| format!("theta_r,DoLP AOI 30,DoLP AOI {last}\n20,0.1,0.2\n30,0.2,0.3\n");
    assert!(read(table("89"), &TableOptions::default()).is_ok());
    for last in ["90", "120", "-90"] {
        let error = read(table(last), &TableOptions::default()).expect_err("no light arrives at grazing incidence").to_string();
        assert!(["line 2", "column 3", last, "angle of incidence"].iter().all(|part| error.contains(part)), "{error}");
    }
}

#[test]
fn odd_rows_are_told() {
    let text = "#;theta_i;theta_r;dolp\n1;30;20;0,0441\n2;30;30;nan\n\n3;30;40;0,09\nMittelwert;;;0,07\n";
    let imported = assert_values(text, text.as_bytes(), &TableOptions::default(), false, &[(30.0, 20.0, 0.0441), (30.0, 40.0, 0.09)]);
    let lines = |note: fn(&ImportNote) -> bool| {
        imported.notes.iter().find(|found| note(found)).and_then(ImportNote::lines).map(|lines| lines.first.clone())
    };
    assert_eq!(lines(|note| matches!(note, ImportNote::NotMeasured(_))), Some(vec![3]));
    assert_eq!(lines(|note| matches!(note, ImportNote::SkippedLines(_))), Some(vec![6]));
    // Cells that were merged in a spreadsheet.
    let text = "AOI;view;DoLP\n30;20;0.1\n;30;0.2\n;40;0.3\n45;20;0.4\n;30;0.5\n;40;0.6\n";
    let expected = [(30.0, 20.0, 0.1), (30.0, 30.0, 0.2), (30.0, 40.0, 0.3), (45.0, 20.0, 0.4), (45.0, 30.0, 0.5), (45.0, 40.0, 0.6)];
    assert!(assert_values(text, text.as_bytes(), &TableOptions::default(), false, &expected).notes.contains(&ImportNote::FilledDown));
    // Names of two rows.
    let text = ";AOI 20°;;AOI 45°;\nview;DoLP;σ;DoLP;σ\n10;0.1;0.004;0.2;0.004\n20;0.3;0.004;0.4;0.004\n";
    let expected = [(20.0, 10.0, 0.1), (45.0, 10.0, 0.2), (20.0, 20.0, 0.3), (45.0, 20.0, 0.4)];
    let imported = assert_values(text, text.as_bytes(), &TableOptions::default(), false, &expected);
    assert!(imported.measurements[0].rows.iter().all(|row| row.dolp.is_some_and(|dolp| dolp.sigma == Some(SIGMA))));
    let percent = "AOI,view,DoLP\n30,20,3.69\n30,30,12\n";
    let imported = assert_values(percent, percent.as_bytes(), &TableOptions::default(), false, &[(30.0, 20.0, 0.0369), (30.0, 30.0, 0.12)]);
    assert!(imported.notes.contains(&ImportNote::TakenAsPercent { name: "DoLP".to_owned() }));
}
