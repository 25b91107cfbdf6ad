//! What is set for a talk: the sliders in the strip, how large everything is, the spotlight.

use pbrdf::model::Parameter;
use serde::{Deserialize, Deserializer, Serialize};

/// A slider in the strip of a presentation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "&'static str")]
pub enum TalkSlider {
    Of(Parameter),
    ThetaI,
    Dphi,
    /// Angle of the picture's lamp from the camera.
    Lamp,
    /// Angle of the picture's analyser.
    Analyser,
}

/// The angles, with their keys and what they are called.
const ANGLES: [(TalkSlider, &str, &str); 4] = [
    (TalkSlider::ThetaI, "theta_i", "θi"),
    (TalkSlider::Dphi, "dphi", "Δφ"),
    (TalkSlider::Lamp, "lamp", "Lamp"),
    (TalkSlider::Analyser, "analyser", "Analyser"),
];

impl TalkSlider {
    pub fn all() -> impl Iterator<Item = Self> {
        Parameter::ALL.into_iter().map(Self::Of).chain(ANGLES.map(|(angle, ..)| angle))
    }

    /// Name in files and lessons.
    pub fn key(self) -> &'static str {
        match self {
            Self::Of(parameter) => parameter.key(),
            _ => ANGLES.iter().find(|(angle, ..)| *angle == self).map_or("", |(_, key, _)| key),
        }
    }

    /// What it is called, to be translated.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Of(parameter) => parameter.symbol(),
            _ => ANGLES.iter().find(|(angle, ..)| *angle == self).map_or("", |(.., symbol)| symbol),
        }
    }
}

impl From<TalkSlider> for &'static str {
    fn from(slider: TalkSlider) -> Self {
        slider.key()
    }
}

impl TryFrom<String> for TalkSlider {
    type Error = String;

    fn try_from(key: String) -> Result<Self, String> {
        Self::all().find(|slider| slider.key() == key).ok_or_else(|| format!("there is no slider {key:?}"))
    }
}

/// What is set for a talk.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Talk {
    /// In the strip; the others are in the window alone.
    pub sliders: Vec<TalkSlider>,
    /// Points of the screen for a point of the window.
    pub zoom: f32,
    /// Whether all but the surroundings of the pointer is dimmed.
    pub spotlight: bool,
}

impl Default for Talk {
    fn default() -> Self {
        Self { sliders: vec![TalkSlider::Of(Parameter::Sigma), TalkSlider::ThetaI], zoom: 1.5, spotlight: false }
    }
}

impl Talk {
    /// What a file says, or the default where that is damaged: settings are not lost for a talk.
    ///
    /// # Errors
    /// The file is no well-formed document at all.
    pub fn lenient<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = serde_json::Value::deserialize(deserializer)?;
        Ok(serde_json::from_value(value).ok().filter(|talk: &Self| is_zoom(talk.zoom)).unwrap_or_default())
    }

    /// Puts a slider into the strip, or takes it out.
    pub fn toggle(&mut self, slider: TalkSlider) {
        let before = self.sliders.len();
        self.sliders.retain(|other| *other != slider);
        if self.sliders.len() == before {
            self.sliders.push(slider);
        }
    }
}

/// Whether a window can be drawn at this zoom.
pub fn is_zoom(zoom: f32) -> bool {
    (0.5..=4.0).contains(&zoom)
}

#[cfg(test)]
mod tests {
    use super::{Talk, TalkSlider};

    #[derive(serde::Deserialize)]
    struct Holder {
        #[serde(deserialize_with = "Talk::lenient")]
        talk: Talk,
    }

    #[test]
    fn a_talk_survives_files_and_a_damaged_one_is_the_default() {
        let read = |text: &str| serde_json::from_str::<Holder>(&format!("{{\"talk\": {text}}}")).expect("lenient").talk;
        let talk = Talk { sliders: TalkSlider::all().collect(), zoom: 2.0, spotlight: true };
        assert_eq!(read(&serde_json::to_string(&talk).expect("a talk is JSON")), talk);
        for damage in ["3", "{\"sliders\": [\"no such slider\"]}", "{\"zoom\": 0.0}", "{\"zoom\": 1e9}"] {
            assert_eq!(read(damage), Talk::default(), "{damage}");
        }
    }

    #[test]
    fn a_slider_is_chosen_and_left() {
        let mut talk = Talk::default();
        talk.toggle(TalkSlider::Lamp);
        assert_eq!(talk.sliders.last(), Some(&TalkSlider::Lamp));
        talk.toggle(TalkSlider::Lamp);
        assert_eq!(talk, Talk::default());
    }
}
