//! What a step of a lesson puts on the stage besides sliders: the picture, pinned surfaces, what is
//! read out, measurements made by simulation, and which form of Eq. (17) is used.

use crate::app::work::lesson_error::LessonErrorKind;
use crate::app::work::picture_options::{PictureCompanion, PictureOptions};
use crate::app::work::surface::{Surface, another, sigma_of_equal_median};
use crate::report::PictureQuantity;
use pbrdf::measurement::{Columns, Measurement, Simulation};
use pbrdf::model::{DolpFormula, Model, Parameter, Parameters, Pbrdf, Preset, Shape, assignment_from_text, assignments_from_text};
use tr::tr;

/// What a step shows besides its sliders; what is not set stays as it is.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Staging {
    pub picture: Vec<PictureSetting>,
    /// Pinned surfaces in the place of those before.
    pub pins: Option<Vec<LessonPin>>,
    /// While the step is shown.
    pub readings: Vec<ReadoutPlace>,
    pub formula: Option<DolpFormula>,
}

/// A place where the read-out says what the model says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ReadoutPlace {
    Mirror,
    /// At that angle of view, degrees, in the plane that the lobes are seen in.
    ThetaR(f64),
}

/// A surface that a step pins.
#[derive(Debug, Clone, PartialEq)]
pub enum LessonPin {
    /// That of the sliders with the other distribution of slopes, at equal median slope.
    OtherDistribution,
    /// That of the sliders but for these values, and what it is called.
    Changed(String, Vec<(Parameter, f64)>),
}

impl LessonPin {
    /// The surface beside that of the sliders.
    pub fn of(&self, surface: &Surface) -> (String, Model, Parameters) {
        let (model, mut parameters) = (surface.model, surface.parameters);
        match self {
            Self::OtherDistribution => {
                let distribution = another(model.distribution);
                parameters.sigma = sigma_of_equal_median(model.distribution, parameters.sigma, parameters.q);
                (format!("{distribution:?}"), Model { distribution, ..model }, parameters)
            }
            Self::Changed(name, values) => {
                values.iter().for_each(|(parameter, value)| parameters[*parameter] = *value);
                (name.clone(), model, parameters)
            }
        }
    }
}

/// A value of the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PictureSetting {
    Shape(Shape),
    Quantity(PictureQuantity),
    Lamp(bool),
    Polar(f64),
    Azimuth(f64),
    Sky(bool),
    Analyser(f64),
    Beside(PictureCompanion),
    Difference(bool),
}

const PICTURE: &str = "shape, show, lamp, polar, azimuth, sky, analyser, beside or difference with a value, such as shape=sphere";
const READOUT: &str = "mirror, or angles of view in degrees";
const FORMULA: &str = "consistent or printed";
const PINS: &str = "other, none, or parameters such as n=3, k=10";
const SIMULATION: &str = "seed, noise, brdf_noise, columns, theta_i, theta_r and parameters, such as seed=1, theta_i=30:50:10";

fn wrong(found: &str, expected: &'static str) -> LessonErrorKind {
    LessonErrorKind::Setting { found: found.to_owned(), expected }
}

impl PictureSetting {
    fn from_text(text: &str) -> Option<Self> {
        let (key, value) = text.split_once('=')?;
        let value = value.trim();
        let yes = || match value {
            "yes" => Some(true),
            "no" => Some(false),
            _ => None,
        };
        let degrees = || value.parse::<f64>().ok().filter(|value| value.is_finite());
        Some(match key.trim() {
            "shape" => Self::Shape(Shape::ALL.iter().copied().find(|shape| shape.key() == value)?),
            "show" => Self::Quantity(PictureQuantity::from_key(value)?),
            "lamp" => Self::Lamp(yes()?),
            "polar" => Self::Polar(degrees().filter(|value| (0.0..=180.0).contains(value))?),
            "azimuth" => Self::Azimuth(degrees()?),
            "sky" => Self::Sky(yes()?),
            "analyser" => Self::Analyser(degrees()?),
            "beside" => Self::Beside(match value {
                "nothing" => PictureCompanion::Nothing,
                "other" => PictureCompanion::OtherDistribution,
                "pin" => PictureCompanion::Pinned(0),
                _ => return None,
            }),
            "difference" => Self::Difference(yes()?),
            _ => return None,
        })
    }

    pub fn apply(self, options: &mut PictureOptions) {
        match self {
            Self::Shape(shape) => options.shape = shape,
            Self::Quantity(quantity) => options.quantity = quantity,
            Self::Lamp(lamp) => options.lamp = lamp,
            Self::Polar(polar) => options.polar = polar,
            Self::Azimuth(azimuth) => options.azimuth = azimuth,
            Self::Sky(sky) => options.sky = sky,
            Self::Analyser(analyser) => options.analyser = analyser,
            Self::Beside(companion) => options.companion = companion,
            Self::Difference(difference) => options.difference = difference,
        }
    }
}

impl Staging {
    /// Takes up a setting; `false` where the key is none of these.
    ///
    /// # Errors
    /// The text means nothing.
    pub fn take(&mut self, key: &str, text: &str) -> Result<bool, LessonErrorKind> {
        let parts = || text.split(',').map(str::trim).filter(|part| !part.is_empty());
        match key {
            "picture" => {
                self.picture =
                    parts().map(|part| PictureSetting::from_text(part).ok_or_else(|| wrong(part, PICTURE))).collect::<Result<_, _>>()?;
            }
            "readout" => self.readings = parts().map(|part| reading(part).ok_or_else(|| wrong(part, READOUT))).collect::<Result<_, _>>()?,
            "formula" => {
                self.formula = Some(match text {
                    "consistent" => DolpFormula::Consistent,
                    "printed" => DolpFormula::AsPrinted,
                    _ => return Err(wrong(text, FORMULA)),
                });
            }
            "pin" if text == "none" => self.pins = Some(Vec::new()),
            "pin" => self.pins = Some(text.split(';').map(|part| pin(part.trim())).collect::<Result<_, _>>()?),
            _ => return Ok(false),
        }
        Ok(true)
    }
}

fn reading(text: &str) -> Option<ReadoutPlace> {
    if text == "mirror" {
        return Some(ReadoutPlace::Mirror);
    }
    text.parse().ok().filter(|theta_r: &f64| theta_r.abs() < 90.0).map(ReadoutPlace::ThetaR)
}

fn pin(text: &str) -> Result<LessonPin, LessonErrorKind> {
    match text {
        "other" => Ok(LessonPin::OtherDistribution),
        "" => Err(wrong(text, PINS)),
        _ => Ok(LessonPin::Changed(text.to_owned(), assignments_from_text(text)?)),
    }
}

/// A measurement that a lesson simulates with the nine-parameter model of Cauchy facets.
#[derive(Debug, Clone, PartialEq)]
pub struct LessonSimulation {
    pub seed: u64,
    pub noise: f64,
    pub brdf_noise: f64,
    pub columns: Columns,
    pub theta_i: Vec<f64>,
    pub theta_r: Vec<f64>,
    pub truth: Vec<(Parameter, f64)>,
}

impl LessonSimulation {
    /// Reads a list of `name=value`; angles are a number or `first:last:step`.
    ///
    /// # Errors
    /// A part means nothing, or no angles are given.
    pub fn from_text(text: &str) -> Result<Self, LessonErrorKind> {
        let mut made = Self {
            seed: 1,
            noise: 0.0,
            brdf_noise: 0.0,
            columns: Columns::Dolp,
            theta_i: Vec::new(),
            theta_r: Vec::new(),
            truth: Vec::new(),
        };
        for part in text.split(',').map(str::trim) {
            let fault = || wrong(part, SIMULATION);
            let (key, value) = part.split_once('=').map(|(key, value)| (key.trim(), value.trim())).ok_or_else(fault)?;
            let noise = || value.parse::<f64>().ok().filter(|noise| (0.0..1.0).contains(noise)).ok_or_else(fault);
            match key {
                "seed" => made.seed = value.parse().map_err(|_| fault())?,
                "noise" => made.noise = noise()?,
                "brdf_noise" => made.brdf_noise = noise()?,
                "columns" => {
                    made.columns = match value {
                        "dolp" => Columns::Dolp,
                        "brdf" => Columns::Brdf,
                        "both" => Columns::Both,
                        _ => return Err(fault()),
                    };
                }
                "theta_i" => made.theta_i = angles(value).ok_or_else(fault)?,
                "theta_r" => made.theta_r = angles(value).ok_or_else(fault)?,
                _ => made.truth.push(assignment_from_text(part)?),
            }
        }
        if made.measurement().is_none() { Err(wrong(text, SIMULATION)) } else { Ok(made) }
    }

    /// What is measured; none where the surface or the angles are not possible.
    pub fn measurement(&self) -> Option<Measurement> {
        let preset = Preset::from_key("cauchy")?;
        let mut parameters = Parameters::default();
        self.truth.iter().for_each(|(parameter, value)| parameters[*parameter] = *value);
        let simulation = Simulation {
            model_name: preset.key.to_owned(),
            surface: Pbrdf::new(preset.model, parameters).ok()?,
            theta_i: self.theta_i.clone(),
            theta_r: self.theta_r.clone(),
            dphi: 180.0,
            columns: self.columns,
            noise: self.noise,
            brdf_noise: self.brdf_noise,
            seed: self.seed,
        };
        simulation.run().ok().filter(|measurement| !measurement.rows.is_empty())
    }

    /// What it is called in the list.
    pub fn name(&self) -> String {
        tr!("simulated, seed {0}, {1} × {2}", self.seed, self.theta_i.len(), self.theta_r.len())
    }
}

/// Angles of a lesson at most.
const MOST_ANGLES: usize = 200;

/// A number, or `first:last:step`.
fn angles(text: &str) -> Option<Vec<f64>> {
    let numbers: Vec<f64> = text.split(':').map(|number| number.trim().parse().ok()).collect::<Option<_>>()?;
    match numbers[..] {
        [one] => Some(vec![one]),
        [first, last, step] if step > 0.0 && first <= last && ((last - first) / step) < 200.0 => {
            #[expect(clippy::cast_precision_loss, reason = "a number up to 200")]
            let at = |i: usize| first + step * i as f64;
            Some((0..MOST_ANGLES).map(at).take_while(|angle| *angle <= last + 1e-9 * step).collect())
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::{LessonSimulation, PictureSetting, ReadoutPlace, Staging};
    use crate::app::text::localized::Localized as _;
    use crate::report::PictureQuantity;
    use pbrdf::model::Shape;

    #[test]
    fn the_stage_is_read_and_what_means_nothing_is_named() {
        let mut stage = Staging::default();
        for (key, text) in [
            ("picture", "shape=plate, show=dolp, polar=60"),
            ("readout", "mirror, 60"),
            ("formula", "printed"),
            ("pin", "other; n=3, k=10"),
        ] {
            assert_eq!(stage.take(key, text), Ok(true), "{key}");
        }
        assert_eq!(
            stage.picture,
            [PictureSetting::Shape(Shape::Plate), PictureSetting::Quantity(PictureQuantity::Dolp), PictureSetting::Polar(60.0)]
        );
        assert_eq!(stage.readings, [ReadoutPlace::Mirror, ReadoutPlace::ThetaR(60.0)]);
        assert_eq!(stage.pins.as_ref().map(Vec::len), Some(2));
        assert_eq!(stage.take("move", "x"), Ok(false));
        for (key, text, expected) in [
            ("picture", "shape=cube", "shape=cube"),
            ("picture", "polar=400", "polar"),
            ("readout", "95", "angles of view"),
            ("formula", "new", "printed"),
            ("pin", "m=3", "no parameter"),
        ] {
            let error = stage.take(key, text).expect_err(text).localized();
            assert!(error.contains(expected), "{error}");
        }
    }

    #[test]
    fn a_simulation_is_read_and_run() {
        let simulation =
            LessonSimulation::from_text("seed=3, noise=0.005, theta_i=30:50:10, theta_r=20:60:5, n=2.07").expect("a simulation");
        assert_eq!(simulation.measurement().map(|measurement| measurement.rows.len()), Some(27));
        for text in [
            "seed=3",
            "theta_i=30, theta_r=95",
            "theta_i=1:2:0, theta_r=1",
            "theta_i=0:80:1e-9, theta_r=1",
            "noise=7, theta_i=1, theta_r=1",
            "x",
        ] {
            assert!(LessonSimulation::from_text(text).is_err(), "{text}");
        }
    }
}
