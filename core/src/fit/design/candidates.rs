//! Angles that might be measured: lists, each angle of one with each of the others.

use crate::optics::{Geometry, GeometryError};

/// Most candidates of a grid.
pub(crate) const MOST_CANDIDATES: usize = 10_000_000;

/// Every θi with every θr and every Δφ.
#[derive(Debug, Clone, PartialEq)]
pub struct CandidateGrid {
    theta_i: Vec<f64>,
    theta_r: Vec<f64>,
    dphi: Vec<f64>,
}

/// Why lists of angles make no grid.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CandidateError {
    /// An angle is outside its range.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
    /// The product of the lists is too large.
    #[error("the lists make {count} pairs of directions, and at most {MOST_CANDIDATES} are allowed; use coarser steps")]
    TooMany {
        /// Product of the lengths of the lists.
        count: u128,
    },
    /// A list is empty.
    #[error("a list of angles is empty")]
    Empty,
}

impl CandidateGrid {
    /// Of lists in degrees; a negative θr is the backscatter side of the plane of incidence, allowed only with Δφ = 180. Angles that
    /// stand twice in a list count once.
    ///
    /// # Errors
    ///
    /// [`CandidateError`] where a list is empty, an angle outside its range, or the product of the lists above ten million.
    pub fn new(theta_i: &[f64], theta_r: &[f64], dphi: &[f64]) -> Result<Self, CandidateError> {
        let count = [theta_i, theta_r, dphi].iter().map(|list| list.len() as u128).product();
        if count == 0 {
            return Err(CandidateError::Empty);
        }
        if count > MOST_CANDIDATES as u128 {
            return Err(CandidateError::TooMany { count });
        }
        let once = |list: &[f64]| {
            let mut kept: Vec<f64> = Vec::with_capacity(list.len());
            let mut seen: std::collections::HashSet<u64> = std::collections::HashSet::new();
            kept.extend(list.iter().filter(|angle| seen.insert((**angle + 0.0).to_bits())));
            kept
        };
        let grid = Self { theta_i: once(theta_i), theta_r: once(theta_r), dphi: once(dphi) };
        // Each angle by itself: the range of one does not depend on the others, but for a negative θr.
        let (first_i, first_r) = (grid.theta_i[0], grid.theta_r[0]);
        grid.theta_i.iter().try_for_each(|&theta_i| geometry([theta_i, first_r.abs(), 180.0]).map(|_| ()))?;
        for &dphi in &grid.dphi {
            grid.theta_r.iter().try_for_each(|&theta_r| geometry([first_i, theta_r, dphi]).map(|_| ()))?;
        }
        Ok(grid)
    }

    /// How many candidates.
    #[must_use]
    pub fn len(&self) -> usize {
        self.theta_i.len() * self.theta_r.len() * self.dphi.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// θi, θr and Δφ of a candidate in degrees, as the lists have them; θi changes slowest, then Δφ.
    #[must_use]
    pub fn angles(&self, candidate: usize) -> [f64; 3] {
        let (rest, r) = (candidate / self.theta_r.len(), candidate % self.theta_r.len());
        [self.theta_i[rest / self.dphi.len()], self.theta_r[r], self.dphi[rest % self.dphi.len()]]
    }

    /// The geometry of a candidate.
    ///
    /// # Errors
    ///
    /// [`GeometryError`] of no candidate of the grid.
    pub fn geometry(&self, candidate: usize) -> Result<Geometry, GeometryError> {
        geometry(self.angles(candidate))
    }
}

fn geometry([theta_i, theta_r, dphi]: [f64; 3]) -> Result<Geometry, GeometryError> {
    if theta_r < 0.0 && dphi == 180.0 { Geometry::in_plane(theta_i, theta_r) } else { Geometry::new(theta_i, theta_r, dphi) }
}

#[cfg(test)]
mod tests {
    use super::{CandidateError, CandidateGrid};

    #[test]
    fn a_grid_is_the_product_of_its_lists() {
        let grid = CandidateGrid::new(&[10.0, 20.0], &[-5.0, 0.0, 5.0, 0.0], &[180.0]).unwrap();
        let angles: Vec<[f64; 3]> = (0..grid.len()).map(|i| grid.angles(i)).collect();
        assert_eq!(angles.len(), 6);
        assert_eq!((angles[0], angles[5]), ([10.0, -5.0, 180.0], [20.0, 5.0, 180.0]));
        assert!((0..grid.len()).all(|i| grid.geometry(i).is_ok()));
    }

    #[test]
    fn lists_that_make_no_grid_are_refused() {
        let many = vec![1.0; 4000];
        assert!(matches!(CandidateGrid::new(&many, &many, &[180.0]), Err(CandidateError::TooMany { count: 16_000_000 })));
        assert_eq!(CandidateGrid::new(&[], &[0.0], &[180.0]), Err(CandidateError::Empty));
        assert!(CandidateGrid::new(&[95.0], &[0.0], &[180.0]).is_err());
        assert!(CandidateGrid::new(&[10.0], &[-5.0], &[90.0]).is_err());
    }
}
