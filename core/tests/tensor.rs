//! Tensors of Mueller matrices: what is written reads back, damaged files are refused with their place.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]

use pbrdf::measurement::{Tensor, TensorError, TensorErrorKind, TensorGrid, TensorResolution, grid_geometries, unwatched, write_tensor};
use pbrdf::model::{Model, Parameters, Pbrdf};
use pbrdf::optics::{Facet, Geometry, SlopeDistribution};
use std::ops::ControlFlow;

fn surface() -> Pbrdf {
    let parameters = Parameters { n: 2.07, k: 2.9, sigma: 0.3, kd: 0.12, kv: 0.2, c: -0.4, sigma_v: 0.6, ..Parameters::default() };
    Pbrdf::new(Model::full(SlopeDistribution::Gauss), parameters).expect("parameters in the domain")
}

fn file(resolution: TensorResolution) -> Vec<u8> {
    let surface = surface();
    let mut bytes = Vec::new();
    let grid = TensorGrid::new(&surface, resolution);
    write_tensor(&surface, &grid, 546, &mut unwatched, &mut bytes).expect("memory takes everything");
    bytes
}

fn small() -> Vec<u8> {
    file(TensorResolution { phi_d: 3, theta_d: 3, theta_h: 2 })
}

fn read(bytes: &[u8]) -> Result<Tensor, TensorError> {
    Tensor::read(bytes)
}

/// Where the data of the field of that name begin, by its entry in the header.
fn offset_of(bytes: &[u8], name: &str) -> (usize, usize) {
    let needle = [&u16::try_from(name.len()).expect("a short name").to_le_bytes()[..], name.as_bytes()].concat();
    let entry = bytes.windows(needle.len()).position(|window| window == needle).expect("the field is there");
    let at = entry + needle.len() + 3;
    let offset = u64::from_le_bytes(bytes[at..at + 8].try_into().expect("eight bytes"));
    (entry, usize::try_from(offset).expect("a small file"))
}

#[test]
fn slices_of_an_export_are_the_model_to_its_resolution() {
    let tensor = read(&file(TensorResolution::default())).expect("what was written");
    assert_eq!((tensor.wavelengths_nm(), tensor.shape(), tensor.assumed_grids().len()), (&[546.0][..], [73, 61, 64], 0));
    let surface = surface();
    // At a node: θ_h = 0, θ_d = 45°, whatever φ_d; f32 rounds once.
    let node = Geometry::new(45.0, 45.0, 180.0).expect("angles in range");
    let (slice, model) = (tensor.slice(&[node], None).expect("its only band"), surface.reflection(&Facet::new(node)));
    let row = slice.measurement.rows[0];
    let (brdf, dolp) = (row.brdf.expect("a BRDF").value, row.dolp.expect("a DoLP").value);
    // θ_h = 0 exactly needs an acos of nothing: a rounding of the half vector moves 1e-8 along the lobe.
    assert!((brdf / model.brdf - 1.0).abs() < 1e-6 && (dolp - model.dolp).abs() < 1e-6, "{brdf} {dolp}");
    for (dphi, theta_r) in [(180.0, vec![-70.0, -33.0, 3.0, 28.0, 61.0, 77.0]), (71.0, vec![11.0, 47.0, 72.0]), (-130.0, vec![36.0])] {
        let geometries = grid_geometries(&[7.0, 31.0, 64.0], &theta_r, dphi).expect("angles in range");
        let slice = tensor.slice(&geometries, Some(546.0)).expect("its only band");
        assert_eq!((slice.measurement.rows.len(), slice.without_value, slice.beyond_one), (geometries.len(), 0, 0));
        for (row, &geometry) in slice.measurement.rows.iter().zip(&geometries) {
            let model = surface.reflection(&Facet::new(geometry));
            let (brdf, dolp) = (row.brdf.expect("a BRDF").value, row.dolp.expect("a DoLP").value);
            // Twice what Mitsuba's own check finds as the worst of 100 directions at this resolution.
            assert!((brdf / model.brdf - 1.0).abs() < 0.04 && (dolp - model.dolp).abs() < 0.004, "{geometry:?}: {brdf} {dolp} {model:?}");
        }
    }
}

#[test]
fn light_and_eye_are_not_interchanged() {
    let tensor = read(&file(TensorResolution::default())).expect("what was written");
    let brdf = |theta_i, theta_r| {
        let geometry = Geometry::new(theta_i, theta_r, 90.0).expect("angles in range");
        tensor.slice(&[geometry], None).expect("its only band").measurement.rows[0].brdf.expect("a BRDF").value
    };
    // The volume lobe is bright for an eye near the normal, wherever the light is.
    assert!(brdf(60.0, 10.0) > 1.3 * brdf(10.0, 60.0));
}

#[test]
fn a_file_cut_off_anywhere_in_its_head_is_refused() {
    let bytes = small();
    let (_, data) = offset_of(&bytes, "M");
    for length in (0..data).chain([bytes.len() - 1]) {
        let error = read(&bytes[..length]).expect_err("half a file");
        assert!(matches!(error.kind, TensorErrorKind::NoTensor | TensorErrorKind::Truncated { .. }), "{length}: {error}");
    }
    let error = read(&bytes[..bytes.len() - 1]).expect_err("half a file").to_string();
    assert!(error.contains("field M") && error.contains("ends early"), "{error}");
}

#[test]
fn what_a_header_says_is_not_believed() {
    let good = small();
    let with = |at: usize, new: &[u8]| {
        let mut bytes = good.clone();
        bytes[at..at + new.len()].copy_from_slice(new);
        read(&bytes).expect_err("a damaged file").to_string()
    };
    let (m, _) = offset_of(&good, "M");
    let (phi, phi_data) = offset_of(&good, "phi_d");
    let (waves, waves_data) = offset_of(&good, "wvls");
    let huge = u64::MAX.to_le_bytes();
    for (at, new, part) in [
        (0, &b"tensor_fils"[..], "no tensor file"),
        (12, &[2, 0], "version is 2.0"),
        (14, &[0xff; 4], "number of fields is 4294967295"),
        (18, &[0xff, 0xff], "length of a name is 65535"),
        (phi + 2, b"x", "field phi_d: the field is missing"),
        (phi + 7, &[9, 0], "number of dimensions is 9"),
        (phi + 9, &[11], "field phi_d: the type is 11"),
        (phi + 10, &huge, "ends early"),
        (phi + 18, &[2], "the shape is 2 × 3"),
        (phi + 18, &[0], "the shape is"),
        (phi + 26, &huge, "ends early"),
        (waves + 8, &[10], "field wvls: the type is 10"),
        (waves_data, &[0, 0], "field wvls: entry 0 is 0"),
        (phi_data, &f32::NAN.to_le_bytes(), "field phi_d: entry 0 is NaN"),
        (phi_data + 4, &(-4.0_f32).to_le_bytes(), "field phi_d: entry 1 is -4"),
        (m + 14, &huge, "expected 3 × 3 × 2 × 1 × 4 × 4"),
        (m + 6, &huge, "ends early"),
    ] {
        let is_assumed = at == phi + 18 && new == [0];
        if is_assumed {
            // No angles at all: even ones are taken, and the reader says so.
            let mut bytes = good.clone();
            bytes[at] = 0;
            assert_eq!(read(&bytes).expect("angles may be absent").assumed_grids(), ["phi_d"]);
        } else {
            let message = with(at, new);
            assert!(message.contains(part), "{at}: {message}");
        }
    }
}

#[test]
fn nodes_without_a_value_are_left_out_and_counted() {
    let mut bytes = small();
    let (_, data) = offset_of(&bytes, "M");
    let geometries = grid_geometries(&[20.0], &[10.0, 50.0], 180.0).expect("angles in range");
    for nothing in [f32::NAN, 0.0, f32::INFINITY] {
        bytes[data..].chunks_exact_mut(4).for_each(|chunk| chunk.copy_from_slice(&nothing.to_le_bytes()));
        let slice = read(&bytes).expect("whole").slice(&geometries, None).expect("its only band");
        assert_eq!((slice.measurement.rows.len(), slice.without_value), (0, 2));
    }
    // M10 above M00: a BRDF, but no DoLP.
    bytes[data..].chunks_exact_mut(4).enumerate().for_each(|(i, chunk)| {
        let value: f32 = if i % 16 == 4 { 2.0 } else { 1.0 };
        chunk.copy_from_slice(&value.to_le_bytes());
    });
    let slice = read(&bytes).expect("whole").slice(&geometries, None).expect("its only band");
    assert_eq!(
        (slice.beyond_one, slice.measurement.rows[0].dolp, slice.measurement.rows[1].brdf.map(|brdf| brdf.value)),
        (2, None, Some(1.0))
    );
}

#[test]
fn an_export_can_be_stopped() {
    let surface = surface();
    let grid = TensorGrid::new(&surface, TensorResolution { phi_d: 3, theta_d: 3, theta_h: 3 });
    let result = write_tensor(&surface, &grid, 550, &mut |_| ControlFlow::Break(()), Vec::new());
    assert_eq!(result.expect_err("a stop").kind(), std::io::ErrorKind::Interrupted);
}
