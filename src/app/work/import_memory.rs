//! The answers that foreign tables were opened with, kept for tables of the same shape. Only corrections are kept: what the user left to
//! the guess is guessed anew, since the next table may state something else.

use pbrdf::measurement::formats::{ImportOptions, Question, TableSample};
use pbrdf::measurement::{BrdfMeaning, ColumnChoice, Field, Mapping};
use serde::{Deserialize, Serialize};

/// What tables of one shape have in common: the sheets of the workbook, and the names of the columns as the guess finds them.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct TableShape {
    sheets: Vec<String>,
    header: Vec<String>,
}

impl TableShape {
    /// The shape of a file that asks those questions; none of a file that is no table.
    pub fn of(questions: &[Question]) -> Option<Self> {
        sample_of(questions).map(|sample| Self { sheets: sample.sheets.clone(), header: sample.header.clone() })
    }
}

/// The table that is asked about.
pub fn sample_of(questions: &[Question]) -> Option<&TableSample> {
    questions.iter().find_map(|question| match question {
        Question::Columns(sample) => Some(&**sample),
        _ => None,
    })
}

/// How a table was read otherwise than guessed, in the words of the command line.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct KeptAnswers {
    shape: TableShape,
    /// As [`Mapping`] has it as text, with numbers of columns; empty where the guess was right.
    columns: String,
    /// Angle of incidence of all rows, degrees.
    theta_i: Option<f64>,
    /// Relative azimuth of all rows, degrees.
    dphi: Option<f64>,
    sheet: Option<String>,
    thousands: Option<char>,
    flip: bool,
    normalised: bool,
    /// What the columns of a wide table hold: the key of the field.
    wide: Option<String>,
    /// Its name on the command line.
    brdf_is: Option<String>,
}

impl KeptAnswers {
    /// What was chosen of a table of that shape; `guessed` is what was offered for its cells as they were read at last, `first` the sheet
    /// that it was first shown by.
    pub fn new(shape: TableShape, guessed: &ImportOptions, first: Option<&str>, chosen: &ImportOptions) -> Self {
        let different = |one: Option<f64>, guessed: Option<f64>| one.filter(|_| one != guessed);
        let (columns, offered) = (&chosen.columns, &guessed.columns);
        let is_numbered = columns.columns.iter().all(|column| matches!(column.column, ColumnChoice::Number(_)));
        let is_corrected = columns.columns != offered.columns && is_numbered;
        let corrected = Mapping { columns: columns.columns.clone(), ..Mapping::default() };
        let table = &chosen.table;
        let brdf_is = BrdfMeaning::ALL.iter().find(|(_, meaning)| table.brdf_is == Some(*meaning));
        Self {
            shape,
            columns: if is_corrected { corrected.to_string() } else { String::new() },
            theta_i: different(columns.theta_i, offered.theta_i),
            dphi: different(columns.dphi, offered.dphi),
            sheet: table.sheet.clone().filter(|sheet| Some(&**sheet) != first),
            thousands: table.thousands,
            flip: table.flip,
            normalised: table.normalised,
            wide: table.wide.map(|field| field.key().to_owned()),
            brdf_is: brdf_is.map(|(name, _)| (*name).to_owned()),
        }
    }

    /// Whether the guess was right in everything.
    fn is_guess(&self) -> bool {
        *self == Self { shape: self.shape.clone(), ..Self::default() }
    }

    /// The same answers to the questions of another table of that shape; none where its shape is another. What a table itself states goes
    /// before what was said of the other one.
    pub fn of(&self, questions: &[Question]) -> Option<ImportOptions> {
        (TableShape::of(questions).as_ref() == Some(&self.shape)).then(|| self.adapted(questions))
    }

    /// The answers to the questions of a table whose cells were read as they say, or are to be read so.
    pub fn adapted(&self, questions: &[Question]) -> ImportOptions {
        let mut options = ImportOptions::offered(questions);
        let Some(sample) = sample_of(questions) else { return options };
        if self.sheet.is_some() {
            options.table.sheet.clone_from(&self.sheet);
        }
        options.table.thousands = self.thousands;
        let is_as_read = options.table.sheet == sample.sheet && options.table.thousands == sample.thousands;
        let corrected = Mapping::from_text(&self.columns).map(|mapping| mapping.columns);
        options.columns.columns = match corrected {
            Ok(columns) => columns,
            Err(_) if is_as_read => options.columns.columns,
            // The guess of the columns is that of other cells.
            Err(_) => Vec::new(),
        };
        options.columns.theta_i = options.columns.theta_i.or(self.theta_i);
        options.columns.dphi = options.columns.dphi.or(self.dphi);
        (options.table.flip, options.table.normalised) = (self.flip, self.normalised);
        options.table.wide = self.wide.as_deref().and_then(Field::from_key);
        let brdf_is = BrdfMeaning::ALL.into_iter().find(|(name, _)| self.brdf_is.as_deref() == Some(name));
        options.table.brdf_is = brdf_is.map(|(_, meaning)| meaning);
        options
    }
}

/// The answers of the last tables, one for each shape.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct ImportMemory {
    /// The last one last.
    kept: Vec<KeptAnswers>,
}

/// Shapes that are remembered.
const REMEMBERED: usize = 50;

impl ImportMemory {
    /// Keeps the answers of a table that was opened; where the guess was right nothing has to be.
    pub fn keep(&mut self, answers: &KeptAnswers) {
        self.kept.retain(|other| other.shape != answers.shape);
        if !answers.is_guess() {
            self.kept.push(answers.clone());
        }
        if self.kept.len() > REMEMBERED {
            self.kept.remove(0);
        }
    }

    /// The answers that a table of that shape was opened with.
    pub fn recall(&self, shape: &TableShape) -> Option<&KeptAnswers> {
        self.kept.iter().find(|kept| kept.shape == *shape)
    }
}

#[cfg(test)]
mod tests {
    use super::{ImportMemory, KeptAnswers, TableShape};
    use pbrdf::measurement::formats::{ForeignFile, ImportOptions, Opened, open};
    use pbrdf::measurement::{Mapping, unwatched};

    fn foreign(text: &str) -> Box<dyn ForeignFile> {
        let Ok(Opened::Foreign(file)) = open(text.as_bytes().to_vec(), &mut unwatched) else { panic!("a foreign table: {text}") };
        file
    }

    fn kept(file: &dyn ForeignFile, change: impl FnOnce(&mut ImportOptions)) -> KeptAnswers {
        let questions = file.questions();
        let guessed = ImportOptions::offered(&questions);
        let mut chosen = guessed.clone();
        change(&mut chosen);
        KeptAnswers::new(TableShape::of(&questions).expect("a table"), &guessed, None, &chosen)
    }

    #[test]
    fn corrections_return_from_the_file_of_settings_and_what_was_guessed_is_guessed_again() {
        let first = foreign("a,b,DoLP\n30,20,12\n30,40,14\n");
        let answers =
            kept(&*first, |options| options.columns = Mapping::from_text("theta_i=1,theta_r=2,dolp=3:percent").expect("a mapping"));
        let mut memory = ImportMemory::default();
        memory.keep(&answers);
        let memory: ImportMemory = serde_json::from_str(&serde_json::to_string(&memory).expect("JSON")).expect("a memory");
        let next = foreign("a,b,DoLP\n50,20,17\n50,40,18\n");
        let shape = TableShape::of(&next.questions()).expect("a table");
        let options = memory.recall(&shape).expect("a table of that shape").of(&next.questions()).expect("the same shape");
        let imported = next.import(&options, &mut unwatched).expect("its answers");
        assert_eq!(imported.measurements[0].rows[0].dolp.expect("a DoLP").value, 0.17);
        // Taken as guessed, the shape is forgotten.
        let mut memory = memory;
        memory.keep(&kept(&*next, |_| {}));
        assert!(memory.recall(&shape).is_none());
    }

    #[test]
    fn an_angle_that_a_table_states_goes_before_that_of_another_one() {
        let first = foreign("view,dolp\n20,0.1\n25,0.2\n");
        let answers = kept(&*first, |options| options.columns.theta_i = Some(45.0));
        let theta_i = |text: &str| answers.of(&foreign(text).questions()).map(|options| options.columns.theta_i);
        assert_eq!(theta_i("view,dolp\n20,0.3\n25,0.4\n"), Some(Some(45.0)));
        assert_eq!(theta_i("AOI: 60 deg\nview,dolp\n20,0.3\n25,0.4\n"), Some(Some(60.0)));
        assert_eq!(theta_i("view,dolp,note\n20,0.3,a\n25,0.4,b\n"), None, "another shape");
    }
}
