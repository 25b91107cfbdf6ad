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

/// The names of the parameters in the order of a table.
const NAMES: [&str; 9] = ["n", "k", "sigma", "ks", "kd", "kv", "q", "c", "sigma_v"];

/// A surface: its model, and the values of the parameters that this model has.
fn surface(number: u32) -> (&'static str, Vec<(&'static str, f64)>) {
    // Additive recurrences of the square roots of primes: even over their ranges, and no two surfaces alike.
    let even = |root: f64| (f64::from(number + 1) * root.sqrt()).fract();
    let (n, k) = (0.2 + 3.0 * even(2.0), if number.is_multiple_of(4) { 0.0 } else { 6.0 * even(3.0) });
    let (sigma, q, c) = (0.05 + 0.6 * even(5.0), 1.2 + 4.0 * even(7.0), -0.9 + 1.4 * even(11.0));
    let values = [n, k, sigma, 0.2 + 0.8 * even(13.0), 0.3 * even(17.0), 0.3 * even(19.0), q, c, 0.1 + 0.8 * even(23.0)];
    let (model, absent): (_, &[&str]) = match number % 5 {
        0 | 3 => ("cauchy", &[]),
        1 => ("gauss", &["q"]),
        2 => ("specular", &["kd", "kv", "c", "sigma_v"]),
        _ => ("specular-gauss", &["kd", "kv", "q", "c", "sigma_v"]),
    };
    (model, NAMES.into_iter().zip(values).filter(|(name, _)| !absent.contains(name)).collect())
}

/// The azimuth of the normal in the image, from the angles between lamp, camera and normal: in the spherical triangle of the
/// three the angle at the normal is Δφ, and that at the camera lies between the azimuths of lamp and normal.
fn azimuth_of_normal(lamp: f64, [theta_i, theta_r, dphi]: [f64; 3]) -> f64 {
    let ((sin_i, cos_i), (sin_r, cos_r)) = (libm::sincos(theta_i.to_radians()), libm::sincos(theta_r.to_radians()));
    let (sin, cos) = libm::sincos(dphi.to_radians());
    lamp.to_radians() - libm::atan2(sin_i * sin, cos_i * sin_r - sin_i * cos_r * cos)
}

#[test]
fn every_row_of_twenty_pictures_is_what_evaluate_says_turned_into_the_cameras_frame() {
    let folder = Folder::new();
    let file = |name: &str| folder.path(name).display().to_string();
    for number in 0..20 {
        let (model, values) = surface(number);
        let set = values.iter().map(|(name, value)| format!("{name}={value}")).collect::<Vec<_>>().join(",");
        let shape = ["sphere", "relief", "cylinder", "plate"][number as usize % 4];
        // The plate and the relief are dark where the lamp stands low behind them.
        let highest = if matches!(shape, "plate" | "relief") { 40.0 } else { 180.0 };
        let polar = [30.0, 65.0, 100.0, 20.0, 5.0, 130.0, 80.0_f64][number as usize % 7].min(highest);
        let azimuth = [135.0, -40.0, 10.0, 0.0, 200.0, 90.0][number as usize % 6];
        let lamp = format!("{polar},{azimuth}");
        let picture = ["picture", "--model", model, "--set", &set, "--shape", shape, "--lamp", &lamp, "--size", "20", "-o"];
        answer(&[&picture[..], &[&file("out.csv")]].concat());
        let rows = numbers(&std::fs::read_to_string(folder.path("out.csv")).expect("a table"));
        assert!(rows.len() > 20, "{shape}: {} rows", rows.len());
        // A term that the model lacks has the weight 0; the other numbers that it lacks play no part.
        let lacking = |name| if name == "kd" || name == "kv" { 0.0 } else { 2.0 };
        let value = |name| values.iter().find(|(own, _)| *own == name).map_or(lacking(name), |(_, value)| *value);
        let distribution = if model.contains("gauss") { "gauss" } else { "cauchy" };
        let all = NAMES.map(|name| value(name).to_string()).join(",");
        let mut table = format!("distribution,{},theta_i,theta_r,dphi\n", NAMES.join(","));
        rows.iter().for_each(|row| table += &format!("{distribution},{all},{},{},{}\n", row[2], row[3], row[4]));
        let evaluated = answer(&["evaluate", &folder.file("in.csv", table), "--mueller"]);
        let header = evaluated.lines().next().expect("names").to_owned();
        let column = |name: &str| header.split(',').position(|column| column == name).expect("a column");
        let (first, second, third) = (column("m00"), column("m10"), column("m20"));
        for (row, evaluated) in rows.iter().zip(&numbers(&evaluated)) {
            let cos_i = libm::cos(row[2].to_radians());
            let [m00, m10, m20] = [first, second, third].map(|column| evaluated[column] * cos_i);
            let (sin, cos) = libm::sincos(2.0 * azimuth_of_normal(azimuth, [row[2], row[3], row[4]]));
            let expected = [m00, -(m10 * cos - m20 * sin), -(m10 * sin + m20 * cos), 0.0];
            for (component, expected) in expected.into_iter().enumerate() {
                // The bar of 1e-12 is of the radiance, and of 1e-3 where it is darker.
                let apart = (row[5 + component] - expected).abs() / m00.max(1e-3);
                assert!(apart <= 1e-12, "{number}: {model} {set} {shape} {lamp}: S{component} of {row:?} is {expected}");
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
