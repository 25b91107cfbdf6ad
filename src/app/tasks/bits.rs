//! Numbers of orders and answers between a page and its worker that JSON would not keep to the bit.

use pbrdf::model::{Model, Parameter, Parameters, Shape};
use serde::{Deserialize, Serialize};

/// A way that sliders go: all numbers as text, unknowns by their places in the problem.
#[derive(Serialize, Deserialize)]
pub struct WalkBits {
    /// Of each point the sum of squares, the length, and nine parameters of each measurement.
    pub points: String,
    /// Part of each unknown in the direction.
    pub direction: Vec<(usize, u64)>,
    pub limit: u64,
    pub end: EndBits,
}

#[derive(Serialize, Deserialize)]
pub enum EndBits {
    Bound { unknown: usize, is_upper: bool, value: u64 },
    Misfit,
    NothingMoves,
    Lost,
    Endless,
    Cancelled,
}

/// What came of a choice of angles.
#[derive(Serialize, Deserialize)]
pub enum ChoiceBits {
    Chosen { angles: String, value: u64, efficiency: u64, limits: Vec<(Parameter, u64)> },
    Cancelled,
    Because(String),
}

/// What a picture shows.
#[derive(Serialize, Deserialize)]
pub struct SceneOrder {
    pub shape: Shape,
    /// Direction of the lamp in degrees: from the camera, and from right to up.
    pub lamp: Option<[f64; 2]>,
    pub sky: Option<f64>,
    pub surface: (Model, Parameters),
    pub companion: Option<(Model, Parameters)>,
    pub size: usize,
}

/// What was looked at, and numbers to the bit.
#[derive(Serialize, Deserialize)]
pub struct AuditBits {
    pub findings: Vec<FindingBits>,
    /// θi, the three terms and the error of each.
    pub reflectance: String,
}

/// One number with its verdict.
#[derive(Serialize, Deserialize)]
pub struct FindingBits {
    /// Its place in a list of all.
    pub check: usize,
    pub value: u64,
    pub bar: u64,
    pub pass: bool,
    /// θi, θr and Δφ in degrees.
    pub at: Option<[u64; 3]>,
}
