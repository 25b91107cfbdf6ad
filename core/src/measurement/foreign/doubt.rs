//! What a foreign table leaves open.

use crate::measurement::Field;

/// A question that the guess cannot answer.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Doubt {
    /// No row names the columns.
    NoHeader {
        /// How many columns there are.
        columns: usize,
    },
    /// No column and no text holds the angle.
    NoAngle {
        /// θi or θr.
        field: Field,
        /// The names of the columns.
        names: Vec<String>,
    },
    /// No column holds DoLP or BRDF, or what they follow from.
    NoQuantity {
        /// The names of the columns.
        names: Vec<String>,
    },
    /// Nothing says whether the columns of a wide table are DoLP or BRDF.
    WideQuantity {
        /// The names of the columns.
        names: Vec<String>,
    },
    /// Several columns look like the same field.
    Several {
        /// The field.
        field: Field,
        /// Number from 1 and name of each.
        columns: Vec<(usize, String)>,
    },
    /// The heading does not say what a BRDF is.
    BrdfMeaning {
        /// The name of the column.
        name: String,
    },
    /// Neither index 0 nor index 4 tells how Mueller elements are counted.
    MuellerCount,
}

impl Doubt {
    /// The option of `import` that answers, by an example.
    #[must_use]
    pub fn answer(&self) -> &'static str {
        match self {
            Self::NoAngle { field: Field::ThetaI, .. } => "--theta-i 45",
            Self::WideQuantity { .. } => "--wide dolp",
            Self::BrdfMeaning { .. } => "--brdf-is brdf",
            Self::MuellerCount => "--columns theta_i=1,theta_r=2,m00=3,m10=7,m20=11",
            Self::NoHeader { .. } | Self::NoAngle { .. } | Self::NoQuantity { .. } | Self::Several { .. } => {
                "--columns theta_i=1,theta_r=2,dolp=3"
            }
        }
    }
}

/// At most so many names are told.
const NAMED: usize = 12;

fn listed(names: &[String]) -> String {
    let shown: Vec<String> = names.iter().take(NAMED).map(|name| crate::measurement::quote(name)).collect();
    format!("{}{}", shown.join(", "), if names.len() > NAMED { ", …" } else { "" })
}

/// A question with the option that answers it.
impl std::fmt::Display for Doubt {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NoHeader { columns } => {
                write!(f, "no row names the {columns} columns; name them, as in --columns theta_i=1,theta_r=2,dolp=3")
            }
            Self::NoAngle { field: Field::ThetaI, names } => {
                write!(
                    f,
                    "no angle of incidence was found among {}; give it with --theta-i, or name its column with --columns",
                    listed(names)
                )
            }
            Self::NoAngle { names, .. } => {
                write!(f, "no angle of view was found among {}; name its column, as in --columns theta_i=1,theta_r=2,dolp=3", listed(names))
            }
            Self::NoQuantity { names } => {
                write!(
                    f,
                    "no column for DoLP or BRDF was found among {}; name it, as in --columns theta_i=1,theta_r=2,dolp=3",
                    listed(names)
                )
            }
            Self::WideQuantity { names } => {
                write!(f, "nothing says whether the columns {} are DoLP or BRDF: use --wide dolp or --wide brdf", listed(names))
            }
            Self::Several { field, columns } => {
                let names: Vec<String> = columns.iter().map(|(number, name)| format!("{number} ({name})")).collect();
                write!(
                    f,
                    "{} columns look like {field}: {}; choose one with --columns {field}={}",
                    columns.len(),
                    names.join(", "),
                    columns.first().map_or(1, |(number, _)| *number)
                )
            }
            Self::BrdfMeaning { name } => write!(
                f,
                "the column {} may be a BRDF, a BRDF times cos θr, or a reflectance factor: use --brdf-is brdf, brdf-cos or factor",
                crate::measurement::quote(name)
            ),
            Self::MuellerCount => {
                f.write_str("the Mueller elements may be counted from 0 or from 1: name them with --columns, as in m00=3,m10=7,m20=11")
            }
        }
    }
}
