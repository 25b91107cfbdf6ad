//! The lessons: those that are bundled, those in the user's own folder, and the one that is open.
//!
//! A lesson works on a workspace of its own; the user's workspace is saved meanwhile and comes back
//! when the lesson ends.

use crate::app::platform;
use crate::app::storage::settings_file;
use crate::app::text::localized::Localized as _;
use crate::app::work::lesson::{Lesson, Step};
use crate::app::work::workspace::Workspace;
use pbrdf::model::{Parameter, PerParameter};
use std::ops::RangeInclusive;
use std::path::Path;
use tr::tr;

/// The bundled lessons, in their order; a test sees to it that none of the folder is missing.
const BUNDLED: [&str; 20] = [
    include_str!("../../../assets/lessons/01-pseudo-brewster.md"),
    include_str!("../../../assets/lessons/02-fresnel-limit.md"),
    include_str!("../../../assets/lessons/03-what-dolp-forgets.md"),
    include_str!("../../../assets/lessons/04-ratios-only.md"),
    include_str!("../../../assets/lessons/05-what-q-does.md"),
    include_str!("../../../assets/lessons/06-ggx-and-beckmann.md"),
    include_str!("../../../assets/lessons/07-three-angles.md"),
    include_str!("../../../assets/lessons/08-masking-shadowing.md"),
    include_str!("../../../assets/lessons/09-not-reciprocal.md"),
    include_str!("../../../assets/lessons/10-minnaert-and-energy.md"),
    include_str!("../../../assets/lessons/11-out-of-plane.md"),
    include_str!("../../../assets/lessons/12-colour-of-copper.md"),
    include_str!("../../../assets/lessons/13-depolarised-sphere.md"),
    include_str!("../../../assets/lessons/14-analyser.md"),
    include_str!("../../../assets/lessons/15-second-brewster-ring.md"),
    include_str!("../../../assets/lessons/16-when-the-error-lies.md"),
    include_str!("../../../assets/lessons/17-gauss-or-cauchy.md"),
    include_str!("../../../assets/lessons/18-eq-17-as-printed.md"),
    include_str!("../../../assets/lessons/19-brdf-column.md"),
    include_str!("../../../assets/lessons/20-psi-and-delta.md"),
];

/// Own lessons that are read at most, and the largest file that is taken for one.
const MOST: usize = 100;
const LARGEST: u64 = 1 << 18;

/// All lessons, and the one that is open.
#[derive(Default)]
pub struct Lessons {
    pub all: Vec<Lesson>,
    pub session: Option<Box<LessonSession>>,
    /// Whether the text of the open lesson is away, so that plots have its room.
    pub is_folded: bool,
}

/// The lesson that is open, and the user's own work meanwhile.
pub struct LessonSession {
    /// The lesson by its place in the list.
    pub lesson: usize,
    pub step: usize,
    /// The user's own work as it was when the lesson began.
    pub saved: Workspace,
}

impl Lessons {
    /// The bundled ones, those of a folder, and a sentence for each file of the folder that is no
    /// lesson.
    pub fn load(own: Option<&Path>) -> (Self, Vec<String>) {
        let mut all: Vec<Lesson> = BUNDLED.iter().filter_map(|text| Lesson::from_text(text).ok()).collect();
        let mut faults = Vec::new();
        for path in own.map(text_files).unwrap_or_default() {
            match std::fs::read_to_string(&path).map_err(|error| error.localized()).and_then(|text| lesson(&text)) {
                Ok(lesson) => {
                    faults.extend(lesson.notes.iter().map(|note| tr!("{0}: {1}.", path.display(), note.localized())));
                    all.push(lesson);
                }
                Err(reason) => faults.push(tr!("{0} is no lesson: {1}.", path.display(), reason)),
            }
        }
        (Self { all, ..Self::default() }, faults)
    }

    /// The ends of each slider: as the open step wants them, else its own.
    pub fn ranges(&self) -> PerParameter<RangeInclusive<f64>> {
        let mut ranges = PerParameter::from_fn(Parameter::range);
        for &(parameter, low, high) in self.current().map_or(&[][..], |(_, step)| &step.ranges) {
            ranges[parameter] = low..=high;
        }
        ranges
    }

    /// The places of the open lesson in the list, and of its step.
    pub fn open(&self) -> Option<(usize, usize)> {
        self.session.as_ref().map(|session| (session.lesson, session.step))
    }

    /// The place of the lesson of that title, if it has that step.
    pub fn find(&self, title: &str, step: usize) -> Option<usize> {
        self.all.iter().position(|lesson| lesson.title.original() == title && step < lesson.steps.len())
    }

    /// The open step with its lesson.
    pub fn current(&self) -> Option<(&Lesson, &Step)> {
        let (lesson, step) = self.open()?;
        let lesson = self.all.get(lesson)?;
        Some((lesson, lesson.steps.get(step)?))
    }
}

/// Where a user's own lessons lie.
pub fn own_folder() -> Option<std::path::PathBuf> {
    platform::data_folder(settings_file::APP).map(|folder| folder.join("lessons"))
}

fn lesson(text: &str) -> Result<Lesson, String> {
    Lesson::from_text(text).map_err(|error| error.localized())
}

/// The text files of a folder that are small enough, in the order of their names.
fn text_files(folder: &Path) -> Vec<std::path::PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let is_text = |entry: &std::fs::DirEntry| {
        entry.path().extension().is_some_and(|extension| extension == "md" || extension == "txt")
            && entry.metadata().is_ok_and(|data| data.len() <= LARGEST)
    };
    let mut paths: Vec<_> = entries.filter(is_text).map(|entry| entry.path()).take(MOST).collect();
    paths.sort();
    paths
}

#[cfg(test)]
mod tests {
    use super::{BUNDLED, Lessons};
    use crate::app::work::lesson::Data;
    use crate::app::work::open_measurement::EXAMPLES;

    #[test]
    fn every_file_of_the_folder_is_bundled() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/lessons");
        assert_eq!(std::fs::read_dir(folder).expect("the folder of lessons").count(), BUNDLED.len());
        assert_eq!(Lessons::load(None).0.all.len(), BUNDLED.len());
    }

    #[test]
    fn lessons_name_examples_that_exist() {
        for lesson in Lessons::load(None).0.all {
            for step in &lesson.steps {
                if let Some(Data::Example(name)) = &step.data {
                    assert!(EXAMPLES.iter().any(|example| example.name == name), "{name}");
                }
            }
        }
    }

    #[test]
    fn a_damaged_lesson_is_named_and_the_others_are_read() {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join("a.txt"), "title: Mine\nstep: One\nset: n=1.5\n").expect("a file");
        std::fs::write(folder.path().join("b.txt"), "title: Mine\nstep: One\nset: n=x\n").expect("a file");
        std::fs::write(folder.path().join("c.csv"), "theta_i").expect("a file");
        let unknown = "---\ntitle: Odd\n---\n## One\n- example: my steel\n- panes: dolp, dlop\n";
        std::fs::write(folder.path().join("d.md"), unknown).expect("a file");
        let (lessons, faults) = Lessons::load(Some(folder.path()));
        assert_eq!(lessons.all.len(), BUNDLED.len() + 2);
        assert_eq!(faults.len(), 3);
        assert!(faults[1].contains("line 5") && faults[1].contains("my steel"), "{faults:?}");
        assert!(faults[2].contains("line 6") && faults[2].contains("dlop"), "{faults:?}");
        assert!(faults[0].contains("b.txt") && faults[0].contains("line 3"), "{faults:?}");
    }
}
