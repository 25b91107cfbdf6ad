//! The measurements of a command: of one file or several, each with a name.

use crate::cli::arguments::ProblemArguments;
use crate::cli::failure::Failure;
use crate::cli::input;
use crate::cli::values::Targeted;
use pbrdf::fit::JointUnknown;
use pbrdf::measurement::Measurement;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// One measurement of a command.
pub struct NamedMeasurement {
    /// What it is called: by its column `set`, else by its file.
    pub name: String,
    /// Its place among the files of the command.
    pub file: usize,
    pub measurement: Measurement,
}

/// All measurements of a command, and the files that they come from.
pub struct MeasurementSets {
    pub paths: Vec<PathBuf>,
    /// What stands in the files.
    pub bytes: Vec<Vec<u8>>,
    pub all: Vec<NamedMeasurement>,
}

impl MeasurementSets {
    /// Reads all files. Where some cannot be read, the failure names each of them.
    pub fn read(paths: &[PathBuf]) -> Result<Self, Failure> {
        let mut sets = Self { paths: paths.to_vec(), bytes: Vec::new(), all: Vec::new() };
        let mut failures = Vec::new();
        for (file, path) in paths.iter().enumerate() {
            match input::bytes(path).and_then(|bytes| Ok((input::measurements(path, &bytes)?, bytes))) {
                Ok((measurements, bytes)) => {
                    sets.bytes.push(bytes);
                    let named = |measurement: Measurement| NamedMeasurement { name: String::new(), file, measurement };
                    sets.all.extend(measurements.into_iter().map(named));
                }
                Err(failure) => failures.push(failure),
            }
        }
        if !failures.is_empty() {
            return Err(Failure::all(failures));
        }
        sets.with_names()
    }

    /// The measurements that were read from one file.
    ///
    /// # Errors
    ///
    /// A failure where two of them have one name.
    pub fn of_file(path: &Path, bytes: Vec<u8>, measurements: Vec<Measurement>) -> Result<Self, Failure> {
        let named = |measurement: Measurement| NamedMeasurement { name: String::new(), file: 0, measurement };
        Self { paths: vec![path.to_owned()], bytes: vec![bytes], all: measurements.into_iter().map(named).collect() }.with_names()
    }

    /// With a name for each measurement.
    fn with_names(mut self) -> Result<Self, Failure> {
        self.name();
        match self.all.iter().enumerate().find(|(index, set)| self.all[..*index].iter().any(|other| other.name == set.name)) {
            Some((_, twice)) => Err(Failure::usage(format!("Two measurements are called {}; each needs a name of its own.", twice.name))),
            None => Ok(self),
        }
    }

    /// Names each measurement: by its set, with its wavelength where a set has several; without one by its file name, or by the path where two
    /// file names are equal.
    fn name(&mut self) {
        let files: Vec<String> = self.paths.iter().map(|path| file_name(path)).collect();
        let of_file = |file: usize| {
            let is_twice = files.iter().filter(|other| **other == files[file]).count() > 1;
            if is_twice { self.paths[file].display().to_string() } else { files[file].clone() }
        };
        let is_split = |set: &NamedMeasurement| {
            self.all.iter().filter(|other| other.file == set.file && other.measurement.name == set.measurement.name).count() > 1
        };
        let names: Vec<String> = self
            .all
            .iter()
            .map(|set| {
                let wavelength = set.measurement.metadata("wavelength_nm").filter(|_| is_split(set)).map(|nm| format!("{nm} nm"));
                let set_name = Some(set.measurement.name.clone()).filter(|name| !name.is_empty());
                match [set_name, wavelength].into_iter().flatten().collect::<Vec<_>>() {
                    parts if parts.is_empty() => of_file(set.file),
                    parts => parts.join(" "),
                }
            })
            .collect();
        for (set, name) in self.all.iter_mut().zip(names) {
            set.measurement.name.clone_from(&name);
            set.name = name;
        }
    }

    /// The path of a measurement's file.
    pub fn path(&self, set: &NamedMeasurement) -> &Path {
        &self.paths[set.file]
    }

    /// Whether a name on the command line means that measurement: its own name, or the path of its file where that holds nothing else.
    pub fn is_meant(&self, set: &NamedMeasurement, name: &str) -> bool {
        let is_alone = self.all.iter().filter(|other| other.file == set.file).count() == 1;
        set.name == name || (is_alone && (self.path(set).display().to_string() == name || file_name(self.path(set)) == name))
    }

    /// The unknown that an option means.
    ///
    /// # Errors
    ///
    /// A failure where no measurement, or more than one, has the name in the option.
    pub fn unknown<T>(&self, option: &Targeted<T>) -> Result<JointUnknown, Failure> {
        let set = option.set.as_ref().map(|name| self.named(name)).transpose()?;
        Ok(JointUnknown { parameter: option.parameter, set: set.map(|set| Arc::from(set.name.as_str())) })
    }

    /// The measurement that a name on the command line means.
    fn named(&self, name: &str) -> Result<&NamedMeasurement, Failure> {
        let known = || self.all.iter().map(|set| set.name.as_str()).collect::<Vec<_>>().join(", ");
        let meant: Vec<&NamedMeasurement> = self.all.iter().filter(|set| self.is_meant(set, name)).collect();
        match meant[..] {
            [set] => Ok(set),
            [] => Err(Failure::usage(format!("No measurement is called {name}; there are {}.", known()))),
            _ => Err(Failure::usage(format!("{name} may be several measurements; there are {}.", known()))),
        }
    }

    /// Refuses options about a measurement that is not there, or that may be several.
    pub fn check(&self, options: &ProblemArguments) -> Result<(), Failure> {
        fn sets<T>(options: &[Targeted<T>]) -> impl Iterator<Item = &String> {
            options.iter().filter_map(|option| option.set.as_ref())
        }
        let mut named = sets(&options.start).chain(sets(&options.fix)).chain(sets(&options.free)).chain(sets(&options.bounds));
        named.try_for_each(|name| self.named(name).map(|_| ()))
    }
}

/// The name of a file without its folder.
pub fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
}
