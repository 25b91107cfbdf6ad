//! A guided experiment: settings of the model in steps, with what to move, what to watch and why.
//!
//! [`crate::app::work::lesson_text`] says how a lesson is written down.
//!
//! A lesson begins with the program's default settings and with a measurement of its own: the first
//! bundled example, if it does not name one; `example: none` is for lessons that points in the
//! plots would only hide. A step shows what the lesson's beginning and all steps up to it set,
//! whichever way one came to it. When the lesson is closed, all is as it was before.
//!
//! | key | where | meaning |
//! |---|---|---|
//! | `title`, `about` | first | what the lesson is called, and what it shows, in a sentence |
//! | `step` | begins a step | its heading |
//! | `model` | step | name of a preset, such as `cauchy` |
//! | `set` | step | parameters, such as `n=1.5, k=0`; the others stay as the step before left them |
//! | `range` | step | ends of sliders while the step is shown, such as `k=0..3, sigma=0.05..0.5`; the others have their own |
//! | `theta_i`, `dphi` | step | angles of the lobes in degrees |
//! | `log` | step | `yes` or `no`: logarithmic BRDF |
//! | `example` | step | name of the bundled example to open, or `none` for no measurement |
//! | `metal` | step | symbol or name of the tabulated metal to look at, such as `Cu` |
//! | `wavelength` | step | vacuum wavelength in nm at which to look at it |
//! | `panes` | step | names of the views to bring to the front |
//! | `simulate` | step | a measurement to simulate, such as `seed=1, noise=0.005, theta_i=30:50:10, theta_r=20:60:5, n=2` |
//! | `picture` | step | what the picture shows, such as `shape=sphere, show=dolp, polar=60, sky=no` |
//! | `pin` | step | surfaces to pin: `other`, `none`, or parameters that differ; `;` between them |
//! | `readout` | step | `mirror`, or angles of view at which the model is read out |
//! | `formula` | step | Eq. (17): `consistent` or `printed` |
//! | `move`, `watch`, `why` | step | what to do, what to look at, and the reason |

use crate::app::work::lesson_error::{LessonError, LessonErrorKind};
use crate::app::work::lesson_stage::{LessonSimulation, Staging};
use crate::app::work::lesson_text::{LessonEntry, entries};
use crate::app::work::open_measurement::EXAMPLES;
use crate::app::work::pane_id::PaneId;
use crate::app::work::talk::TalkSlider;
use pbrdf::model::{AssignmentError, Parameter, Preset, assignment_from_text, assignments_from_text};
use pbrdf::optics;
use pbrdf::optics::{Geometry, Metal};

/// A text in one language or more.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Wording {
    plain: String,
    translations: Vec<(String, String)>,
}

impl Wording {
    /// The text in that language, else as it was written first.
    #[must_use]
    pub fn in_language(&self, language: &str) -> &str {
        self.translations.iter().find(|(other, _)| other == language).map_or(&self.plain, |(_, text)| text)
    }

    /// The text as it was written first.
    #[must_use]
    pub fn original(&self) -> &str {
        &self.plain
    }

    /// Whether there is no text.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.plain.is_empty()
    }

    /// Whether the text is there in that language.
    #[cfg(test)]
    #[must_use]
    pub fn is_translated(&self, language: &str) -> bool {
        self.translations.iter().any(|(other, _)| other == language)
    }

    fn set(&mut self, language: Option<&str>, text: String) {
        match language {
            None => self.plain = text,
            Some(language) => self.translations.push((language.to_owned(), text)),
        }
    }
}

/// What is measured in a lesson.
#[derive(Debug, Clone, PartialEq)]
pub enum Data {
    /// Nothing: curves alone.
    Nothing,
    /// A bundled example, by name.
    Example(String),
    /// One that is simulated.
    Simulated(Box<LessonSimulation>),
}

/// One step of a lesson; what is not set stays as it is.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Step {
    /// Its heading.
    pub heading: Wording,
    /// The model to switch to.
    pub preset: Option<&'static Preset>,
    /// The parameters to set.
    pub set: Vec<(Parameter, f64)>,
    /// Ends of sliders while the step is shown: parameter, lower, upper.
    pub ranges: Vec<(Parameter, f64, f64)>,
    /// Angle of incidence of the lobes, degrees.
    pub theta_i: Option<f64>,
    /// Relative azimuth of the lobes, degrees.
    pub dphi: Option<f64>,
    /// Whether BRDF is drawn logarithmically.
    pub log: Option<bool>,
    /// The measurement to open.
    pub data: Option<Data>,
    /// The tabulated metal to look at.
    pub metal: Option<&'static Metal>,
    /// The wavelength to look at it, nm.
    pub wavelength_nm: Option<f64>,
    /// The views to bring to the front, by name.
    pub panes: Vec<String>,
    /// What it shows besides sliders and panes.
    pub staging: Staging,
    /// What to move.
    pub action: Wording,
    /// What to look at.
    pub watch: Wording,
    /// The reason.
    pub why: Wording,
}

impl Step {
    /// What the setting of that key names and there is not.
    fn missed(&self, key: Option<&String>) -> Vec<LessonErrorKind> {
        match (key.map(String::as_str), &self.data) {
            (Some("panes"), _) => {
                let unknown = self.panes.iter().filter(|name| PaneId::try_from((*name).clone()).is_err());
                unknown.map(|name| LessonErrorKind::Pane(name.clone())).collect()
            }
            (Some("example"), Some(Data::Example(name))) if EXAMPLES.iter().all(|example| example.name != name) => {
                vec![LessonErrorKind::Example(name.clone())]
            }
            _ => Vec::new(),
        }
    }

    /// The sliders that the step speaks of: those with ends of their own.
    pub fn sliders(&self) -> Vec<TalkSlider> {
        self.ranges.iter().map(|(parameter, ..)| TalkSlider::Of(*parameter)).collect()
    }
}

/// A lesson.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Lesson {
    /// What it is called.
    pub title: Wording,
    /// What it shows, in a sentence.
    pub about: Wording,
    /// Its steps, at least one.
    pub steps: Vec<Step>,
    /// What it names and there is not, which it goes on without.
    pub notes: Vec<LessonError>,
}

const HEAD_KEYS: &str = "title, about, step";
const STEP_KEYS: &str = "step, model, set, range, theta_i, dphi, log, example, simulate, metal, wavelength, panes, picture, pin, readout, formula, move, watch, why";

impl Lesson {
    /// Reads a lesson.
    pub fn from_text(text: &str) -> Result<Self, LessonError> {
        let mut lesson = Self::default();
        let mut seen: Vec<String> = Vec::new();
        let mut last = 1;
        for entry in entries(text)? {
            let LessonEntry { line, ref key, ref language, .. } = entry;
            let at = |kind| LessonError { line, kind };
            last = line;
            let whole = language.as_ref().map_or_else(|| key.clone(), |language| format!("{key}.{language}"));
            if entry.text.is_empty() {
                return Err(at(LessonErrorKind::Empty(whole)));
            }
            if key == "step" && language.is_none() {
                lesson.steps.push(Step::default());
                seen.clear();
            }
            if seen.contains(&whole) {
                return Err(at(LessonErrorKind::Twice(whole)));
            }
            seen.push(whole);
            match lesson.steps.last_mut() {
                Some(step) => step.take(entry),
                None => lesson.take(entry),
            }
            .map_err(at)?;
            if let Some(step) = lesson.steps.last() {
                lesson.notes.extend(step.missed(seen.last()).into_iter().map(at));
            }
        }
        let missing = |kind| LessonError { line: last, kind };
        if lesson.title.is_empty() {
            return Err(missing(LessonErrorKind::NoTitle));
        }
        if lesson.steps.is_empty() {
            return Err(missing(LessonErrorKind::NoStep));
        }
        Ok(lesson)
    }

    fn take(&mut self, entry: LessonEntry) -> Result<(), LessonErrorKind> {
        let wording = match entry.key.as_str() {
            "title" => &mut self.title,
            "about" => &mut self.about,
            _ => return Err(LessonErrorKind::Key { found: entry.key, expected: HEAD_KEYS }),
        };
        wording.set(entry.language.as_deref(), entry.text);
        Ok(())
    }
}

impl Step {
    fn take(&mut self, entry: LessonEntry) -> Result<(), LessonErrorKind> {
        let LessonEntry { key, language, text, .. } = entry;
        let wording = match key.as_str() {
            "step" => &mut self.heading,
            "move" => &mut self.action,
            "watch" => &mut self.watch,
            "why" => &mut self.why,
            _ if language.is_some() => return Err(LessonErrorKind::Language(key)),
            _ => return self.take_setting(key, text),
        };
        wording.set(language.as_deref(), text);
        Ok(())
    }

    fn take_setting(&mut self, key: String, text: String) -> Result<(), LessonErrorKind> {
        match key.as_str() {
            "model" => self.preset = Some(Preset::from_key(&text).ok_or(LessonErrorKind::Model(text))?),
            "set" => self.set = assignments_from_text(&text)?,
            "range" => self.ranges = ranges(&text)?,
            "theta_i" => self.theta_i = Some(angle(text, "0 ≤ θi < 90 degrees", |theta_i| Geometry::new(theta_i, 0.0, 0.0).is_ok())?),
            "dphi" => self.dphi = Some(angle(text, "a finite angle in degrees", f64::is_finite)?),
            "log" => {
                self.log = Some(match text.as_str() {
                    "yes" => true,
                    "no" => false,
                    _ => return Err(LessonErrorKind::YesOrNo(text)),
                });
            }
            "example" => self.data = Some(if text == "none" { Data::Nothing } else { Data::Example(text) }),
            "metal" => self.metal = Some(optics::metal(&text).ok().flatten().ok_or(LessonErrorKind::Metal(text))?),
            "wavelength" => {
                let stated = text.parse().ok().filter(|nm: &f64| nm.is_finite() && *nm > 0.0);
                self.wavelength_nm = Some(stated.ok_or(LessonErrorKind::Wavelength(text))?);
            }
            "simulate" => self.data = Some(Data::Simulated(Box::new(LessonSimulation::from_text(&text)?))),
            "panes" => self.panes = text.split(',').map(|name| name.trim().to_owned()).filter(|name| !name.is_empty()).collect(),
            _ if self.staging.take(&key, &text)? => {}
            _ => return Err(LessonErrorKind::Key { found: key, expected: STEP_KEYS }),
        }
        Ok(())
    }
}

/// A list of `name=low..high`, each parameter at most once.
fn ranges(text: &str) -> Result<Vec<(Parameter, f64, f64)>, LessonErrorKind> {
    let mut ranges: Vec<(Parameter, f64, f64)> = Vec::new();
    for part in text.split(',').map(str::trim) {
        let form = || LessonErrorKind::Range(part.to_owned());
        let (name, ends) = part.split_once('=').ok_or_else(form)?;
        let (low, high) = ends.split_once("..").ok_or_else(form)?;
        // Each end is a value that the parameter can have.
        let end = |value: &str| assignment_from_text(&format!("{name}={value}"));
        let ((parameter, low), (_, high)) = (end(low)?, end(high)?);
        if low >= high {
            return Err(LessonErrorKind::Order { low, high });
        }
        if ranges.iter().any(|(other, ..)| *other == parameter) {
            return Err(AssignmentError::Twice(parameter).into());
        }
        ranges.push((parameter, low, high));
    }
    Ok(ranges)
}

fn angle(text: String, expected: &'static str, is_allowed: impl Fn(f64) -> bool) -> Result<f64, LessonErrorKind> {
    text.parse().ok().filter(|&angle| is_allowed(angle)).ok_or(LessonErrorKind::Angle { found: text, expected })
}

#[cfg(test)]
mod tests {
    use super::{Data, Lesson, LessonErrorKind};
    use crate::app::text::localized::Localized as _;
    use pbrdf::model::Parameter;

    const SMALL: &str = "# a comment\ntitle: Brewster\ntitle.zh: 布儒斯特\nabout: Where it sits\n\nstep: Glass\nmodel: fresnel\nset: n=1.5, k=0\nrange: k=0..3, sigma = 0.05 .. 0.5\n\
                         theta_i: 56.3\nlog: no\npanes: dolp, lobes\nwatch: the maximum,\n  which is 1\nstep: Metal\nset: k=3\nexample: none\nmetal: copper\nwavelength: 450.5\n\
                         step: Steel\nexample: 45# steel (simulated)\n";

    #[test]
    fn a_lesson_is_read_with_its_steps() {
        let lesson = Lesson::from_text(SMALL).expect("a lesson");
        assert_eq!((lesson.title.in_language("en"), lesson.title.in_language("zh")), ("Brewster", "布儒斯特"));
        assert_eq!(lesson.steps.len(), 3);
        let data = lesson.steps.iter().map(|step| step.data.clone()).collect::<Vec<_>>();
        assert_eq!(data, [None, Some(Data::Nothing), Some(Data::Example("45# steel (simulated)".to_owned()))]);
        let second = &lesson.steps[1];
        assert_eq!((second.metal.map(|metal| metal.key.as_str()), second.wavelength_nm), (Some("Cu"), Some(450.5)));
        let first = &lesson.steps[0];
        assert_eq!(first.preset.map(|preset| preset.key), Some("fresnel"));
        assert_eq!(first.set, [(Parameter::N, 1.5), (Parameter::K, 0.0)]);
        assert_eq!(first.ranges, [(Parameter::K, 0.0, 3.0), (Parameter::Sigma, 0.05, 0.5)]);
        assert_eq!((first.theta_i, first.log), (Some(56.3), Some(false)));
        assert_eq!(first.watch.in_language("zh"), "the maximum, which is 1");
        assert_eq!(first.panes, ["dolp", "lobes"]);
    }

    #[test]
    fn errors_name_their_line_and_what_was_expected() {
        for (text, line, expected) in [
            ("hello", 1, "expected key: text"),
            ("  indented", 1, "expected key: text"),
            ("title: a\nstep: b\nmodel: phong", 3, "\"phong\" is no model"),
            ("title: a\nstep: b\nset: n=0x", 3, "finite number"),
            ("title: a\nstep: b\nset: sigma=-1", 3, "not allowed"),
            ("title: a\nstep: b\nrange: k=3", 3, "name=low..high"),
            ("title: a\nstep: b\nrange: m=0..3", 3, "no parameter"),
            ("title: a\nstep: b\nrange: k=0..x", 3, "finite number"),
            ("title: a\nstep: b\nrange: q=1..3", 3, "not allowed"),
            ("title: a\nstep: b\nrange: k=3..0", 3, "from 3 to 0"),
            ("title: a\nstep: b\nrange: k=0..3, k=0..4", 3, "twice"),
            ("title: a\nstep: b\ntheta_i: 90", 3, "0 ≤ θi < 90"),
            ("title: a\nstep: b\ndphi: inf", 3, "finite angle"),
            ("title: a\nstep: b\nmetal: Xx", 3, "no tabulated metal"),
            ("title: a\nstep: b\nwavelength: red", 3, "positive number of nanometres"),
            ("title: a\nstep: b\nwavelength: 0", 3, "positive number of nanometres"),
            ("title: a\nstep: b\nwavelength: inf", 3, "positive number of nanometres"),
            ("title: a\nstep: b\nwavelength: 650\nwavelength: 450", 4, "twice"),
            ("title: a\nstep: b\nlog: maybe", 3, "yes or no"),
            ("title: a\nstep: b\nwatch: c\nwatch: d", 4, "twice"),
            ("title: a\nstep: b\nlog.zh: yes", 3, "language"),
            ("title: a\nstep: b\nwhy:", 3, "no text"),
            ("title: a\nwhy: b", 2, "expected one of title"),
            ("title: a", 1, "no step"),
            ("step: a", 1, "no title"),
        ] {
            let error = Lesson::from_text(text).expect_err(text);
            assert_eq!(error.line, line, "{text:?}");
            assert!(error.localized().contains(expected), "{text:?}: {error:?}");
        }
        assert_eq!(Lesson::from_text("").map_err(|error| error.kind), Err(LessonErrorKind::NoTitle));
    }

    const MARKDOWN: &str = "---\ntitle: Brewster\ntitle.zh: 布儒斯特\nabout: Where it sits\n---\n\n## Glass\n\n- step.zh: 玻璃\n- model: fresnel\n- set: n=1.5, k=0\n\n<!-- nobody reads this -->\n**Watch** the maximum,\nwhich is 1\n\n**Watch.zh** 极大值，\n为 1\n\n## Metal\n- set: k=3\n";
    const PLAIN: &str = "title: Brewster\ntitle.zh: 布儒斯特\nabout: Where it sits\nstep: Glass\nstep.zh: 玻璃\nmodel: fresnel\nset: n=1.5, k=0\nwatch: the maximum, which is 1\nwatch.zh: 极大值，为 1\nstep: Metal\nset: k=3\n";

    #[test]
    fn both_forms_say_the_same() {
        let [one, other] = [MARKDOWN, PLAIN].map(|text| Lesson::from_text(text).expect("a lesson"));
        assert_eq!(one, other);
        assert_eq!(Lesson::from_text(&MARKDOWN.replace('\n', "\r\n")), Ok(one));
    }
}
