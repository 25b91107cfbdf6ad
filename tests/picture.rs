//! The command `picture` by process: its files against each other and against `evaluate`.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]
#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "numbers of pixels, and the numbers of an .exr")]
#![cfg(feature = "cli")]

mod common;

use common::program::{Folder, answer};
use exr::prelude::read_first_flat_layer_from_file;

/// The cells of a table of numbers, an empty one as NaN.
fn numbers(text: &str) -> Vec<Vec<f64>> {
    let cell = |cell: &str| if cell.is_empty() { f64::NAN } else { cell.parse().expect("a number") };
    text.lines().skip(1).map(|line| line.split(',').map(cell).collect()).collect()
}

#[test]
fn every_row_is_what_evaluate_says_turned_into_the_cameras_frame() {
    let folder = Folder::new();
    let set = "n=1.5,k=0.2,sigma=0.25,ks=0.9,kd=0.1,kv=0.2,q=1.7,c=-0.3,sigma_v=0.4";
    let values = "1.5,0.2,0.25,0.9,0.1,0.2,1.7,-0.3,0.4";
    let file = |name: &str| folder.path(name).display().to_string();
    for (shape, lamp) in [("sphere", "30,135"), ("relief", "65,-40"), ("cylinder", "100,10"), ("plate", "20,0")] {
        answer(&["picture", "--set", set, "--shape", shape, "--lamp", lamp, "--size", "20", "-o", &file("out.csv")]);
        let rows = numbers(&std::fs::read_to_string(folder.path("out.csv")).expect("a table"));
        assert!(rows.len() > 20, "{shape}: {} rows", rows.len());
        let mut table = "distribution,n,k,sigma,ks,kd,kv,q,c,sigma_v,theta_i,theta_r,dphi\n".to_owned();
        for row in &rows {
            table += &format!("cauchy,{values},{},{},{}\n", row[2], row[3], row[4]);
        }
        let evaluated = numbers(&answer(&["evaluate", &folder.file("in.csv", table), "--mueller"]));
        for (row, evaluated) in rows.iter().zip(&evaluated) {
            let cos_i = libm::cos(row[2].to_radians());
            let (m00, m10, m20) = (evaluated[5], evaluated[9], evaluated[13]);
            assert!((row[5] - m00 * cos_i).abs() <= 1e-12 * row[5].max(1e-3), "{shape} {row:?} {m00}");
            let polarised = libm::hypot(m10, m20) * cos_i;
            assert!((libm::hypot(row[6], row[7]) - polarised).abs() <= 1e-12 * row[5].max(1e-3), "{shape} {row:?}");
            assert_eq!(row[8], 0.0);
            if shape == "sphere" {
                // The normal of a sphere of radius 1 is its own place.
                let (sin, cos) = libm::sincos(2.0 * libm::atan2(row[1], row[0]));
                let (s1, s2) = (-(m10 * cos - m20 * sin) * cos_i, -(m10 * sin + m20 * cos) * cos_i);
                assert!((row[6] - s1).abs() <= 1e-12 && (row[7] - s2).abs() <= 1e-12, "{row:?} {s1} {s2}");
            }
        }
    }
}

#[test]
fn an_image_of_numbers_has_the_pixels_of_the_table() {
    let folder = Folder::new();
    let file = |name: &str| folder.path(name).display().to_string();
    let common = ["picture", "--lamp", "50,70", "--sky", "0.3", "--size", "24", "-o"];
    for name in ["out.csv", "out.exr", "out.png"] {
        answer(&[&common[..], &[&file(name)]].concat());
    }
    let rows = numbers(&std::fs::read_to_string(folder.path("out.csv")).expect("a table"));
    let image = read_first_flat_layer_from_file(folder.path("out.exr")).expect("an image of numbers");
    let channels = &image.layer_data.channel_data.list;
    let names: Vec<String> = channels.iter().map(|channel| channel.name.to_string()).collect();
    assert_eq!(names, ["S0", "S1", "S2", "S3"]);
    let columns: Vec<Vec<f32>> = channels.iter().map(|channel| channel.sample_data.values_as_f32().collect()).collect();
    for row in &rows {
        // Centres are (2 i + 1)/24 − 1.
        let index = |along: f64| ((along + 1.0) * 12.0) as usize;
        let pixel = index(-row[1]) * 24 + index(row[0]);
        for (component, column) in columns.iter().enumerate() {
            assert_eq!(column[pixel], row[5 + component] as f32, "{row:?}");
        }
    }
    let lit = columns[0].iter().filter(|s0| **s0 > 0.0).count();
    assert_eq!(lit, rows.len());
    let bytes = std::fs::read(folder.path("out.png")).expect("a picture");
    // Width and height stand in the first chunk of a PNG.
    let number = |at: usize| u32::from_be_bytes(*bytes[at..].first_chunk().expect("a header"));
    assert!(bytes.starts_with(b"\x89PNG") && number(20) == 24 && number(16) > 24, "{} {}", number(16), number(20));
}
