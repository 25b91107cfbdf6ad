//! What a scene costs, and what is left out because it does not need it.
//!
//! Every row evaluates prepared points under one surface and is compared with the full evaluation: all terms (those that the scene has not, with
//! weight 0), BRDF and DoLP with all derivatives, in the scalar form.

use crate::fit::{Bounds, FitOptions, Landscape, LandscapeAxis, Problem};
use crate::measurement::{Columns, Measurement, Simulation};
use crate::model;
use crate::model::{
    Batch, Diffuse, DolpGradients, GradientRequest, Instructions, Model, Parameter, ParameterSet, Parameters, Pbrdf, PerParameter,
    Radiances,
};
use crate::optics::{Facet, Geometry, RefractiveIndex, SlopeDistribution};
use crate::selftest::{BenchmarkRow, Cell, Host, Machine, Note, Report, Timing, gradient_error, relative_error};
use std::hint::black_box;

/// Points of the scalar rows.
const SCALAR_POINTS: u32 = 1 << 11;
/// Points of the batch rows on one thread: a map of 256² directions.
const BATCH_POINTS: u32 = 1 << 16;
/// Points of the batch row on all threads.
const MANY_POINTS: u32 = 1 << 20;
/// Nodes along an edge of the landscape.
const NODES: usize = 256;
/// Surfaces on which a row is compared with the full evaluation.
const SURFACES: u32 = 12;
/// Points under each of them.
const COMPARED: usize = 500;

/// What a row evaluates of each point.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Asked {
    Dolp,
    Brdf,
    Mueller,
    /// DoLP and its derivatives.
    Gradient,
    /// DoLP and its derivatives but those by n and k.
    GradientOfLobes,
    /// Mueller matrix, and DoLP and BRDF with all derivatives.
    Everything,
    Landscape,
}

/// How.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Means {
    Scalar,
    Batch(Instructions),
    AllThreads,
}

/// A scene.
#[derive(Debug, Clone, Copy)]
struct CostScene {
    name: &'static str,
    distribution: SlopeDistribution,
    diffuse: Diffuse,
    volume: bool,
    in_plane: bool,
    asked: Asked,
    means: Means,
    left_out: &'static str,
}

/// What a scene costs.
#[derive(Debug, Clone, PartialEq)]
pub struct Cost {
    /// What is looked at.
    pub scene: &'static str,
    /// Slope distribution.
    pub distribution: SlopeDistribution,
    /// `scalar` or `batch`.
    pub kernel: &'static str,
    /// Threads.
    pub threads: usize,
    /// `dolp`, `brdf`, `mueller`, `gradient` or `landscape`.
    pub output: &'static str,
    /// The terms that are there, joined by `+`.
    pub terms: String,
    /// Points in one evaluation.
    pub points: usize,
    /// Time of a point.
    pub time: Timing,
    /// What the scene does not need.
    pub left_out: &'static str,
    /// Largest difference to the full evaluation in units of the last place; none for the batch kernel.
    pub max_ulp: Option<f64>,
    /// Largest relative difference to the full evaluation; of gradients in the measure of [`gradient_error`].
    pub max_relative_error: f64,
}

impl BenchmarkRow for Cost {
    const COLUMNS: &'static [&'static str] = &[
        "scene",
        "distribution",
        "kernel",
        "threads",
        "output",
        "terms",
        "points",
        "ns_per_point",
        "left_out",
        "max_ulp",
        "max_relative_error",
    ];

    fn cells(&self) -> Vec<Cell> {
        vec![
            Cell::Text(self.scene.to_owned()),
            Cell::Text(self.distribution.key().to_owned()),
            Cell::Text(self.kernel.to_owned()),
            Cell::Count(self.threads),
            Cell::Text(self.output.to_owned()),
            Cell::Text(self.terms.clone()),
            Cell::Count(self.points),
            Cell::Number(self.time.median_ns),
            Cell::Text(self.left_out.to_owned()),
            Cell::maybe(self.max_ulp),
            Cell::Number(self.max_relative_error),
        ]
    }
}

/// From the least to everything.
fn scenes() -> Vec<CostScene> {
    use Asked::{Brdf, Dolp, Everything, Gradient, GradientOfLobes, Mueller};
    use SlopeDistribution::{Cauchy, Gauss};
    let specular = CostScene {
        name: "specular in plane, DoLP only",
        distribution: Cauchy,
        diffuse: Diffuse::Absent,
        volume: false,
        in_plane: true,
        asked: Dolp,
        means: Means::Scalar,
        left_out: "diffuse and volume terms, slope distribution, masking, BRDF, rotations, derivatives",
    };
    let full = CostScene {
        name: "all terms, DoLP only",
        diffuse: Diffuse::Minnaert,
        volume: true,
        in_plane: false,
        left_out: "BRDF, rotations, derivatives",
        ..specular
    };
    let batch = |instructions| Means::Batch(instructions);
    let widest = batch(Instructions::Widest);
    let gauss = "q and its logarithm, BRDF, rotations, derivatives";
    vec![
        specular,
        CostScene { name: "specular out of plane, DoLP only", in_plane: false, ..specular },
        CostScene { name: "specular, DoLP only", in_plane: false, means: widest, ..specular },
        CostScene {
            name: "specular out of plane, BRDF",
            in_plane: false,
            asked: Brdf,
            left_out: "diffuse and volume terms, rotations, derivatives",
            ..specular
        },
        CostScene {
            name: "two components, DoLP only",
            distribution: Gauss,
            diffuse: Diffuse::Lambert,
            volume: false,
            left_out: "volume term, exponent c, q and its logarithm, BRDF, rotations, derivatives",
            ..full
        },
        CostScene { name: "all terms, Gauss, DoLP only", distribution: Gauss, left_out: gauss, ..full },
        CostScene { name: "all terms, Gauss, DoLP only", distribution: Gauss, left_out: gauss, means: widest, ..full },
        full,
        CostScene { means: widest, ..full },
        CostScene { name: "all terms, DoLP only, no wider than AVX2", means: batch(Instructions::Avx2), ..full },
        CostScene { name: "all terms, DoLP only, all threads", means: Means::AllThreads, ..full },
        CostScene { name: "all terms, BRDF", asked: Brdf, left_out: "rotations, derivatives", ..full },
        CostScene { name: "all terms, BRDF", asked: Brdf, left_out: "DoLP, rotations, derivatives", means: widest, ..full },
        CostScene {
            name: "all terms, DoLP and nine derivatives",
            asked: Gradient,
            left_out: "BRDF and its derivatives, rotations",
            means: widest,
            ..full
        },
        CostScene {
            name: "all terms, derivatives, n and k fixed",
            asked: GradientOfLobes,
            left_out: "Fresnel reflection (once per fit), derivatives by n and k, BRDF and its derivatives, rotations",
            ..full
        },
        CostScene {
            name: "all terms, DoLP and nine derivatives",
            asked: Gradient,
            left_out: "BRDF and its derivatives, rotations",
            ..full
        },
        CostScene {
            name: "landscape of ΔE over n and k, 27 points, all threads",
            in_plane: true,
            asked: Asked::Landscape,
            means: Means::AllThreads,
            ..full
        },
        CostScene { name: "all terms, Mueller matrix", asked: Mueller, left_out: "derivatives", ..full },
        CostScene { name: "everything: all terms, Mueller matrix, derivatives of DoLP and BRDF", asked: Everything, left_out: "", ..full },
    ]
}

impl Cost {
    /// The name of each scene, and what it leaves out.
    #[must_use]
    pub fn scenes() -> Vec<(&'static str, &'static str)> {
        scenes().iter().map(|scene| (scene.name, scene.left_out)).collect()
    }

    /// Makes the report; fewer rows if it is cancelled.
    #[must_use]
    pub fn run(machine: Machine, date: String, host: Host<'_>) -> Report<Self> {
        let scenes = scenes();
        let mut rows = Vec::new();
        for (done, scene) in scenes.iter().enumerate() {
            if (host.cancelled)() {
                break;
            }
            #[expect(clippy::cast_precision_loss, reason = "a number of scenes")]
            (host.progress)(done as f64 / scenes.len() as f64);
            rows.extend(scene.cost(&machine, host));
        }
        let notes = vec![Note::CostReference, Note::CostInstructions];
        Report::new("What a scene costs", machine, date, rows, notes)
    }
}

/// A number below 1 for each index, spread evenly.
fn spread(index: u32, step: f64) -> f64 {
    (f64::from(index) * step).fract()
}

/// Directions to 85°, spread evenly.
fn facets(count: u32, in_plane: bool) -> Vec<(Geometry, Facet)> {
    let geometry = |index| {
        let (theta_i, theta_r) = (85.0 * spread(index, 0.618_034), 85.0 * spread(index, 0.754_878));
        let dphi = if in_plane { 180.0 } else { 360.0 * spread(index, 0.569_84) };
        Geometry::new(theta_i, theta_r, dphi)
    };
    (0..count).filter_map(|index| geometry(index).ok()).map(|geometry| (geometry, Facet::new(geometry))).collect()
}

impl CostScene {
    fn model(&self) -> Model {
        Model { diffuse: self.diffuse, volume: self.volume, ..Model::full(self.distribution) }
    }

    fn terms(&self) -> String {
        let terms = [(true, "specular"), (self.diffuse != Diffuse::Absent, "diffuse"), (self.volume, "volume")];
        terms.iter().filter(|(there, _)| *there).map(|(_, name)| *name).collect::<Vec<_>>().join("+")
    }

    fn cost(&self, machine: &Machine, host: Host<'_>) -> Option<Cost> {
        let surface = Pbrdf::new(self.model(), Parameters::default()).ok()?;
        let (points, time) = self.time(&surface, host)?;
        let (max_ulp, max_relative_error) = self.differences()?;
        let output = match self.asked {
            Asked::Dolp => "dolp",
            Asked::Brdf => "brdf",
            Asked::Mueller | Asked::Everything => "mueller",
            Asked::Gradient | Asked::GradientOfLobes => "gradient",
            Asked::Landscape => "landscape",
        };
        #[expect(clippy::cast_precision_loss, reason = "a number of points")]
        let time = Timing { median_ns: time.median_ns / points as f64, ..time };
        Some(Cost {
            scene: self.name,
            distribution: self.distribution,
            kernel: if self.means == Means::Scalar { "scalar" } else { "batch" },
            threads: if self.means == Means::AllThreads { machine.threads } else { 1 },
            output,
            terms: self.terms(),
            points,
            time,
            left_out: self.left_out,
            max_ulp: (self.means == Means::Scalar).then_some(max_ulp),
            max_relative_error,
        })
    }

    /// Points in one evaluation, and its time.
    fn time(&self, surface: &Pbrdf, host: Host<'_>) -> Option<(usize, Timing)> {
        if self.asked == Asked::Landscape {
            let (problem, across, up) = landscape(surface)?;
            let time = Timing::of(host.clock, || _ = black_box(Landscape::new(black_box(&problem), across, up, &|| false)));
            return Some((across.count * up.count * problem.len(), time));
        }
        let count = match self.means {
            Means::Scalar => SCALAR_POINTS,
            Means::Batch(_) => BATCH_POINTS,
            Means::AllThreads => MANY_POINTS,
        };
        let facets = facets(count, self.in_plane);
        let time = if self.asked == Asked::GradientOfLobes {
            let index = RefractiveIndex::new(surface.parameters().n, surface.parameters().k).ok()?;
            let prepared = model::GeometrySet::new(facets.iter().map(|(geometry, _)| *geometry)).with_index(index);
            Timing::of(host.clock, || {
                prepared.reflections_and_gradients(black_box(surface), self.wanted()).for_each(|at| _ = black_box(at));
            })
        } else if self.means == Means::Scalar {
            Timing::of(host.clock, || {
                for (geometry, facet) in &facets {
                    self.evaluate(black_box(surface), *geometry, facet);
                }
            })
        } else {
            let batch = self.batch(facets.iter().map(|(_, facet)| *facet).collect());
            let (mut radiances, mut gradients) = (Radiances::default(), DolpGradients::default());
            Timing::of(host.clock, || match self.asked {
                Asked::Brdf => batch.brdf(black_box(surface), &mut radiances.brdf),
                Asked::Gradient => batch.dolp_gradients(black_box(surface), &mut gradients),
                _ => batch.dolp(black_box(surface), &mut radiances.dolp),
            })
        };
        Some((facets.len(), time))
    }

    fn batch(&self, facets: Vec<Facet>) -> Batch {
        let batch = Batch::from_facets(facets);
        match self.means {
            Means::Batch(instructions) => batch.with_instructions(instructions).single_threaded(),
            _ => batch,
        }
    }

    fn wanted(&self) -> GradientRequest {
        let by = match self.asked {
            Asked::GradientOfLobes => ParameterSet::ALL.without(Parameter::N).without(Parameter::K),
            _ => ParameterSet::ALL,
        };
        GradientRequest { by, brdf: self.asked == Asked::Everything, dolp: true }
    }

    /// One point by the scalar form, for its time.
    fn evaluate(&self, surface: &Pbrdf, geometry: Geometry, facet: &Facet) {
        match self.asked {
            Asked::Dolp | Asked::Landscape => _ = black_box(surface.dolp(facet)),
            Asked::Brdf => _ = black_box(surface.reflection(facet)),
            Asked::Mueller => _ = black_box(surface.mueller(geometry)),
            Asked::Gradient | Asked::GradientOfLobes => _ = black_box(surface.reflection_and_gradient(facet, self.wanted())),
            Asked::Everything => {
                _ = black_box(surface.mueller(geometry));
                _ = black_box(surface.reflection_and_gradient(facet, self.wanted()));
            }
        }
    }

    /// Largest difference to the full evaluation over some surfaces: in units of the last place, and relative.
    fn differences(&self) -> Option<(f64, f64)> {
        if self.asked == Asked::Landscape {
            return landscape_difference(&Pbrdf::new(self.model(), Parameters::default()).ok()?).map(|error| (f64::NAN, error));
        }
        let facets: Vec<Facet> = facets(SCALAR_POINTS, self.in_plane).into_iter().map(|(_, facet)| facet).take(COMPARED).collect();
        let batch = self.batch(facets.clone());
        let mut worst = (0.0, 0.0);
        for index in 0..SURFACES {
            let parameters = self.parameters(index);
            let surface = Pbrdf::new(self.model(), parameters).ok()?;
            let full = Pbrdf::new(Model::full(self.distribution), parameters).ok()?;
            let values = self.values(&surface, &facets, &batch);
            for (facet, values) in facets.iter().zip(values) {
                let (reflection, gradient) = full.reflection_and_gradient(facet, GradientRequest::ALL);
                let reference = if matches!(self.asked, Asked::Brdf | Asked::Mueller) { reflection.brdf } else { reflection.dolp };
                worst.0 = f64::max(worst.0, ulps(values.value, reference));
                worst.1 = f64::max(worst.1, relative_error(values.value, reference));
                if let Some(mut derivatives) = values.derivatives {
                    for parameter in ParameterSet::ALL.without_all(self.wanted().by) {
                        derivatives[parameter] = gradient.dolp[parameter];
                    }
                    let pairs = derivatives.iter().zip(&gradient.dolp);
                    worst.0 = pairs.map(|(value, reference)| ulps(*value, *reference)).fold(worst.0, f64::max);
                    worst.1 = f64::max(worst.1, gradient_error(&derivatives, &gradient.dolp, &parameters));
                }
            }
        }
        Some(worst)
    }

    /// Parameters in the range, with weight 0 for the terms that are not there.
    fn parameters(&self, index: u32) -> Parameters {
        let mut parameters = Parameters::default();
        let count = u32::try_from(Parameter::COUNT).unwrap_or(u32::MAX);
        for (j, parameter) in (0..).zip(Parameter::ALL) {
            let (low, high) = (*parameter.range().start(), *parameter.range().end());
            parameters[parameter] = low + (high - low) * (0.02 + 0.96 * spread(count * index + j + 1, 0.618_034));
        }
        if self.diffuse == Diffuse::Absent {
            parameters.kd = 0.0;
        }
        if self.diffuse == Diffuse::Lambert {
            parameters.c = 0.0;
        }
        if !self.volume {
            parameters.kv = 0.0;
        }
        parameters
    }

    fn values(&self, surface: &Pbrdf, facets: &[Facet], batch: &Batch) -> Vec<Values> {
        let gradient = matches!(self.asked, Asked::Gradient | Asked::GradientOfLobes | Asked::Everything);
        if self.means == Means::Scalar {
            let scalar = |facet: &Facet| match self.asked {
                Asked::Brdf => Values::from(surface.reflection(facet).brdf),
                Asked::Mueller => Values::from(surface.mueller(facet.geometry).element(0, 0)),
                _ if gradient => {
                    let (reflection, gradient) = surface.reflection_and_gradient(facet, self.wanted());
                    Values { value: reflection.dolp, derivatives: Some(gradient.dolp) }
                }
                _ => Values::from(surface.dolp(facet)),
            };
            return facets.iter().map(scalar).collect();
        }
        let (mut values, mut gradients) = (Vec::new(), DolpGradients::default());
        match self.asked {
            Asked::Brdf => batch.brdf(surface, &mut values),
            _ if gradient => {
                batch.dolp_gradients(surface, &mut gradients);
                let derivatives = |point: usize| Some(PerParameter::from_fn(|parameter| gradients.by[parameter][point]));
                return gradients.dolp.iter().enumerate().map(|(i, &value)| Values { value, derivatives: derivatives(i) }).collect();
            }
            _ => batch.dolp(surface, &mut values),
        }
        values.into_iter().map(Values::from).collect()
    }
}

/// DoLP or BRDF at a point, and the derivatives of DoLP where they are asked for.
struct Values {
    value: f64,
    derivatives: Option<PerParameter<f64>>,
}

impl From<f64> for Values {
    fn from(value: f64) -> Self {
        Self { value, derivatives: None }
    }
}

/// The difference in units of the reference's last place.
fn ulps(value: f64, reference: f64) -> f64 {
    let size = reference.abs();
    if value == reference { 0.0 } else { (value - reference).abs() / (size.next_up() - size) }
}

/// The paper's 27 angles under a surface, around it.
fn landscape(surface: &Pbrdf) -> Option<(Problem, LandscapeAxis, LandscapeAxis)> {
    let model = surface.model();
    let parameters = *surface.parameters();
    let problem =
        Problem::new(&steel_angles(surface)?, model, parameters, ParameterSet::ALL, Bounds::default(), FitOptions::default()).ok()?;
    let axis = |parameter, low, high| LandscapeAxis { parameter, low, high, count: NODES, logarithmic: false };
    Some((problem, axis(Parameter::N, 0.5, 6.0), axis(Parameter::K, 0.5, 8.0)))
}

fn steel_angles(surface: &Pbrdf) -> Option<Measurement> {
    let simulation = Simulation {
        model_name: String::new(),
        surface: *surface,
        theta_i: vec![30.0, 40.0, 50.0],
        theta_r: (4..13).map(|i| 5.0 * f64::from(i)).collect(),
        dphi: 180.0,
        columns: Columns::Dolp,
        noise: 0.005,
        brdf_noise: 0.0,
        seed: 1,
    };
    simulation.run().ok()
}

/// Largest relative difference between nodes of the landscape and the plain objective.
fn landscape_difference(surface: &Pbrdf) -> Option<f64> {
    let (problem, across, up) = landscape(surface)?;
    let (across, up) = (LandscapeAxis { count: 31, ..across }, LandscapeAxis { count: 31, ..up });
    let landscape = Landscape::new(&problem, across, up, &|| false)?;
    let mut worst: f64 = 0.0;
    for (row, k) in up.values().into_iter().enumerate() {
        for (column, n) in across.values().into_iter().enumerate() {
            let reference = problem.delta_e(&Parameters { n, k, ..*problem.start() })?;
            worst = worst.max(relative_error(landscape.objective[row * across.count + column], reference));
        }
    }
    Some(worst)
}
