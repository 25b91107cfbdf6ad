//! Linear least squares of three unknowns in a box, by normal equations: good enough for a guess.

/// The determinant, relative to the product of the diagonal, below which the matrix counts as singular.
pub(crate) const SINGULAR: f64 = 1e-12;

/// `Σ (aᵀx − y)²`, to be minimised over a box.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BoxLeastSquares {
    /// Σ a aᵀ, on and above the diagonal.
    pub square: [[f64; 3]; 3],
    /// Σ a y.
    pub right: [f64; 3],
    /// Σ y².
    pub constant: f64,
    /// The box; an unknown whose range is a point is held there.
    pub ranges: [(f64, f64); 3],
}

impl BoxLeastSquares {
    fn at(&self, i: usize, j: usize) -> f64 {
        self.square[i.min(j)][i.max(j)]
    }

    /// The sum of squares.
    pub(crate) fn value(&self, x: [f64; 3]) -> f64 {
        let product = |i: usize| (0..3).map(|j| self.at(i, j) * x[j]).sum::<f64>();
        ((0..3).map(|i| x[i] * (product(i) - 2.0 * self.right[i])).sum::<f64>() + self.constant).max(0.0)
    }

    /// The minimum in the box. An unknown without a column stays at the lower end of its range.
    pub(crate) fn minimum(&self) -> [f64; 3] {
        let mut order = [0; 3];
        let mut count = 0;
        for i in 0..3 {
            if self.square[i][i] > 0.0 && self.ranges[i].0 < self.ranges[i].1 {
                order[count] = i;
                count += 1;
            }
        }
        self.minimum_over(&order[..count], self.ranges.map(|range| range.0))
    }

    /// The minimum over those unknowns, the others where they are. Where the minimum without the box lies outside, that in the box has
    /// one of the unknowns that are outside on the bound that it crosses: the sum of squares is convex, and nothing else is in the way.
    /// A singular matrix has a line of minima, which meets some bound.
    fn minimum_over(&self, free: &[usize], x: [f64; 3]) -> [f64; 3] {
        if let &[i] = free {
            let mut x = x;
            x[i] = ((self.right[i] - self.held(i, free, &x)) / self.square[i][i]).clamp(self.ranges[i].0, self.ranges[i].1);
            return x;
        }
        let unbounded = self.unbounded(free, x);
        let mut lowest = (f64::INFINITY, unbounded.unwrap_or(x));
        for &i in free {
            let (low, high) = self.ranges[i];
            let (is_below, is_above) = unbounded.map_or((true, true), |solution| (solution[i] < low, solution[i] > high));
            for (is_crossed, bound) in [(is_below, low), (is_above, high)] {
                if is_crossed {
                    let mut on_bound = x;
                    on_bound[i] = bound;
                    let (rest, count) = without(free, i);
                    let candidate = self.minimum_over(&rest[..count], on_bound);
                    let value = self.value(candidate);
                    if value < lowest.0 {
                        lowest = (value, candidate);
                    }
                }
            }
        }
        lowest.1
    }

    /// The part of a row's product that belongs to the unknowns that are not free.
    fn held(&self, i: usize, free: &[usize], x: &[f64; 3]) -> f64 {
        (0..3).filter(|j| !free.contains(j)).map(|j| self.at(i, j) * x[j]).sum()
    }

    /// The minimum over those unknowns without the box, the others where they are; none where the matrix is singular.
    fn unbounded(&self, free: &[usize], mut x: [f64; 3]) -> Option<[f64; 3]> {
        let mut a = [[0.0; 4]; 3];
        for (row, &i) in free.iter().enumerate() {
            for (column, &j) in free.iter().enumerate() {
                a[row][column] = self.at(i, j);
            }
            a[row][3] = self.right[i] - self.held(i, free, &x);
        }
        let count = free.len();
        for i in 0..count {
            // A positive definite matrix needs no pivoting.
            if a[i][i] <= SINGULAR * self.square[free[i]][free[i]] {
                return None;
            }
            for row in i + 1..count {
                let factor = a[row][i] / a[i][i];
                let pivot = a[i];
                a[row].iter_mut().zip(pivot).skip(i).for_each(|(value, above)| *value -= factor * above);
            }
        }
        for i in (0..count).rev() {
            let rest: f64 = (i + 1..count).map(|j| a[i][j] * x[free[j]]).sum();
            x[free[i]] = (a[i][3] - rest) / a[i][i];
        }
        Some(x)
    }
}

/// Those unknowns but one, and how many they are.
fn without(free: &[usize], held: usize) -> ([usize; 2], usize) {
    let mut rest = [0; 2];
    let mut count = 0;
    for &i in free.iter().filter(|&&i| i != held) {
        rest[count] = i;
        count += 1;
    }
    (rest, count)
}

#[cfg(test)]
mod tests {
    use super::BoxLeastSquares;

    #[test]
    fn the_minimum_stays_in_the_box() {
        let box_of_two = |[dd, dv, vv]: [f64; 3], [dy, vy]: [f64; 2]| {
            let [_, x, y] = BoxLeastSquares {
                square: [[0.0; 3], [0.0, dd, dv], [0.0, 0.0, vv]],
                right: [0.0, dy, vy],
                constant: 0.0,
                ranges: [(1.0, 1.0), (0.0, 10.0), (0.0, 10.0)],
            }
            .minimum();
            (x, y)
        };
        assert_eq!(box_of_two([1.0, 0.0, 1.0], [2.0, 3.0]), (2.0, 3.0));
        assert_eq!(box_of_two([1.0, 0.0, 1.0], [2.0, -3.0]), (2.0, 0.0));
        assert_eq!(box_of_two([1.0, 0.0, 1.0], [-2.0, -3.0]), (0.0, 0.0));
        assert_eq!(box_of_two([1.0, 1.0, 1.0], [1.0, 2.0]), (0.0, 2.0));
        // Without edges (14, −4) and (10, 4): the second lies on one edge, the first is moved along it to the corner.
        assert_eq!(box_of_two([1.0, 0.5, 0.5], [12.0, 5.0]), (10.0, 0.0));
        assert_eq!(box_of_two([1.0, 0.5, 0.5], [12.0, 7.0]), (10.0, 4.0));
    }

    /// Three correlated columns: coordinate descent would need many sweeps.
    const CORRELATED: [[f64; 3]; 3] = [[1.0, 0.9, 0.8], [0.0, 1.0, 0.95], [0.0, 0.0, 1.0]];

    #[test]
    fn no_point_of_the_box_is_below_the_minimum() {
        for right in [[1.0, -0.4, 0.3], [0.2, 3.0, -2.0], [-1.0, 2.0, 2.2], [4.0, 3.5, 3.1], [-1.0, -1.0, -1.0]] {
            let problem = BoxLeastSquares { square: CORRELATED, right, constant: 10.0, ranges: [(0.0, 1.0); 3] };
            let lowest = problem.value(problem.minimum());
            for place in 0..11 * 11 * 11 {
                let x = [place % 11, place / 11 % 11, place / 121].map(|step| f64::from(step) / 10.0);
                // Rounding of ten.
                assert!(problem.value(x) >= lowest - 1e-14, "{right:?}: {x:?}");
            }
        }
    }

    #[test]
    fn a_singular_matrix_has_its_minimum_on_a_bound() {
        let square = [[0.0; 3], [0.0, 1.0, 1.0], [0.0, 0.0, 1.0]];
        let problem = BoxLeastSquares { square, right: [0.0, 3.0, 3.0], constant: 9.0, ranges: [(1.0, 1.0), (0.0, 2.0), (0.0, 2.0)] };
        let found = problem.minimum();
        assert!(problem.value(found) < 1e-14 && (found[1] + found[2] - 3.0).abs() < 1e-14, "{found:?}");
    }

    #[test]
    fn three_unknowns_are_found_again() {
        let truth = [0.7, 2.0, 0.3];
        let mut problem = BoxLeastSquares { square: [[0.0; 3]; 3], right: [0.0; 3], constant: 0.0, ranges: [(0.0, 10.0); 3] };
        for t in (0..9).map(f64::from) {
            let a = [1.0, t, t * t];
            let y = a[0] * truth[0] + a[1] * truth[1] + a[2] * truth[2];
            for i in 0..3 {
                (i..3).for_each(|j| problem.square[i][j] += a[i] * a[j]);
                problem.right[i] += a[i] * y;
            }
            problem.constant += y * y;
        }
        let found = problem.minimum();
        assert!(found.iter().zip(truth).all(|(found, truth)| (found - truth).abs() < 1e-9), "{found:?}");
        assert!(problem.value(found) < 1e-9);
    }
}
