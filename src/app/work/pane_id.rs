//! Which panes there are.

use serde::{Deserialize, Serialize};

/// Hands every pane to the macro `$then`: its variant, its name in files, which is that of its
/// module in `views` too, and where it opens. Here the list becomes [`PaneId`], in `views` the
/// table of what the panes are.
macro_rules! with_panes {
    ($then:ident) => {
        $then! {
            Dolp dolp Upper,
            Lobes lobes Lower,
            Picture picture Upper,
            PolarLobes polar_lobes Lower,
            Facets facets Lower,
            Convergence convergence Upper,
            Data data Lower,
            Planner planner Lower,
            Models models Lower,
            Results results Lower,
            Posterior posterior Upper,
            Metals metals Lower,
            Hemisphere hemisphere Upper,
            Mueller mueller Upper,
            Landscape landscape Lower,
            Audit audit Lower,
            ErrorVsTime error_vs_time Upper,
            Stability stability Upper,
            Cost cost Upper,
            ResidualsAgainstAngle residuals_against_angle Lower,
        }
    };
}
pub(crate) use with_panes;

macro_rules! declare_panes {
    ($($variant:ident $key:ident $area:ident,)*) => {
        /// Which pane.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
        #[serde(try_from = "String", into = "&'static str")]
        pub enum PaneId {
            $($variant,)*
        }

        impl PaneId {
            /// All panes, in the order of menus.
            pub const ALL: &'static [Self] = &[$(Self::$variant,)*];

            /// Name in files.
            pub fn key(self) -> &'static str {
                match self {
                    $(Self::$variant => stringify!($key),)*
                }
            }

            /// Where it opens.
            pub fn area(self) -> DockArea {
                match self {
                    $(Self::$variant => DockArea::$area,)*
                }
            }
        }
    };
}
with_panes!(declare_panes);

impl PaneId {
    /// Whether it is on a tab before the user opens it.
    pub fn opens_first(self) -> bool {
        matches!(self, Self::Dolp | Self::Picture | Self::Lobes | Self::Data | Self::Models)
    }

    /// Whether it is about the program rather than about a surface.
    pub fn judges_program(self) -> bool {
        matches!(self, Self::ErrorVsTime | Self::Stability | Self::Cost | Self::Convergence)
    }
}

/// Where a pane lies until the user moves it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DockArea {
    Upper,
    Lower,
}

impl From<PaneId> for &'static str {
    fn from(pane: PaneId) -> Self {
        pane.key()
    }
}

impl TryFrom<String> for PaneId {
    type Error = String;

    fn try_from(key: String) -> Result<Self, String> {
        Self::ALL.iter().copied().find(|pane| pane.key() == key).ok_or_else(|| format!("there is no pane {key:?}"))
    }
}

#[cfg(test)]
mod tests {
    use super::PaneId;

    #[test]
    fn a_pane_is_found_by_its_name_in_files_and_no_name_is_there_twice() {
        for pane in PaneId::ALL {
            assert_eq!(PaneId::try_from(pane.key().to_owned()), Ok(*pane));
            assert_eq!(PaneId::ALL.iter().filter(|other| other.key() == pane.key()).count(), 1);
        }
        assert!(PaneId::try_from("no such pane".to_owned()).is_err());
    }
}
