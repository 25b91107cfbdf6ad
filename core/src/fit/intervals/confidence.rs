//! Profile-likelihood intervals of all unknowns of a minimum (Raue et al., Bioinformatics 25, 1923 (2009)).
//!
//! Each side of each unknown is a [`Walk`]. What one walk finds serves the others: a point below a limit that lies outside another
//! unknown's interval shows that the interval reaches farther, and its walk goes on from there. A point below the minimum shows that
//! the search has missed the best one.

use crate::fit::intervals::walk::{Landmarks, ProfileFit, Walk};
use crate::fit::least_squares::LeastSquares;

/// Rounds in which walks go on from what others have found, at most.
const ROUNDS: usize = 4;
/// A point lies outside an interval if it does by more than this fraction of the distance of the end from the minimum.
const OUTSIDE: f64 = 0.01;
/// A point is better than the minimum if its sum of squares is smaller by this fraction of the first limit's rise.
const BETTER: f64 = 1e-6;

/// What the walks have found.
pub(crate) struct Profiles {
    /// Of each unknown, the ends at 68.3 and at 95 % below and above the minimum; none on an open side.
    pub ends: Vec<[[Option<f64>; 2]; 2]>,
    /// Of each unknown, the points of its profile in ascending order.
    pub points: Vec<Vec<ProfileFit>>,
    /// The best point of each walk that came below the minimum, the lowest first.
    pub better: Vec<ProfileFit>,
    /// Whether all walks came to their ends.
    pub is_complete: bool,
}

impl Profiles {
    /// Nothing is known of so many unknowns.
    pub(crate) fn open(count: usize) -> Self {
        Self { ends: vec![[[None; 2]; 2]; count], points: vec![Vec::new(); count], better: Vec::new(), is_complete: true }
    }
}

/// Walks both sides of those unknowns. `errors` are the standard errors that first steps go by; `rises` the rises of the sum of squares at
/// the two limits of each unknown.
pub(crate) fn profiles<P: LeastSquares + Sync>(
    at: &Landmarks<'_, P>,
    unknowns: &[usize],
    errors: &[Option<f64>],
    rises: &[[f64; 2]],
) -> Profiles {
    let sides = || unknowns.iter().flat_map(|&unknown| [(unknown, false), (unknown, true)]);
    let mut walks: Vec<Walk<'_, P>> =
        sides().map(|(unknown, upwards)| Walk::new(at, unknown, upwards, rises[unknown], errors[unknown])).collect();
    for_each(&mut walks, &|walk| walk.run(0, None));
    for _ in 0..ROUNDS {
        if (at.observer.cancelled)() || !better(at, &walks).is_empty() {
            break;
        }
        let pool: Vec<ProfileFit> = walks.iter().flat_map(|walk| walk.points.iter().cloned()).collect();
        let mut wider: Vec<(&mut Walk<'_, P>, usize, ProfileFit)> = Vec::new();
        for walk in &mut walks {
            if let Some((level, point)) = walk.widest(&pool, OUTSIDE) {
                wider.push((walk, level, point));
            }
        }
        if wider.is_empty() {
            break;
        }
        for_each(&mut wider, &|(walk, level, point)| walk.run(*level, Some(point.clone())));
    }
    collect(at, unknowns, walks)
}

/// The best point of each walk that is better than the minimum, the lowest first.
fn better<P: LeastSquares>(at: &Landmarks<'_, P>, walks: &[Walk<'_, P>]) -> Vec<ProfileFit> {
    let lowest = |walk: &Walk<'_, P>| {
        let lowest = walk.points.iter().min_by(|a, b| a.sum_of_squares.total_cmp(&b.sum_of_squares));
        lowest.filter(|point| point.sum_of_squares < at.minimum.sum_of_squares - BETTER * walk.rises[0]).cloned()
    };
    let mut better: Vec<ProfileFit> = walks.iter().filter_map(lowest).collect();
    better.sort_by(|a, b| a.sum_of_squares.total_cmp(&b.sum_of_squares));
    better
}

fn collect<P: LeastSquares>(at: &Landmarks<'_, P>, unknowns: &[usize], walks: Vec<Walk<'_, P>>) -> Profiles {
    let mut found = Profiles {
        better: better(at, &walks),
        is_complete: walks.iter().all(|walk| !walk.is_incomplete),
        ..Profiles::open(at.minimum.x.len())
    };
    for (walk, side) in walks.into_iter().zip([0, 1].into_iter().cycle()) {
        found.ends[walk.unknown][side] = walk.ends;
        found.points[walk.unknown].extend(walk.points.into_iter().skip(side));
    }
    for &unknown in unknowns {
        found.points[unknown].sort_by(|a, b| a.x[unknown].total_cmp(&b.x[unknown]));
    }
    found
}

/// Does it to each, on all threads.
fn for_each<T: Send>(items: &mut [T], of: &(dyn Fn(&mut T) + Sync)) {
    #[cfg(feature = "threads")]
    {
        use rayon::prelude::*;
        items.par_iter_mut().with_max_len(1).for_each(of);
    }
    #[cfg(not(feature = "threads"))]
    items.iter_mut().for_each(of);
}
