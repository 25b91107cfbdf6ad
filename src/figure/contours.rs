//! Lines of equal height over a grid, by marching squares: crossings on the edges of cells, joined
//! into long lines.
//!
//! A cell with a corner without a value has no line. In a saddle the mean of the corners says which
//! of them belong together.

use std::collections::HashMap;

/// A place on a grid, in columns and rows from its first node.
pub type Place = (f64, f64);

/// An edge of a cell: the node that it begins at, and whether it goes up rather than across.
type Edge = (usize, bool);

/// Heights at nodes, row by row.
#[derive(Debug, Clone, Copy)]
pub struct Heights<'a> {
    /// Row by row from the lowest.
    pub values: &'a [f64],
    /// Nodes of a row.
    pub columns: usize,
}

impl Heights<'_> {
    /// The lines at that height.
    #[must_use]
    pub fn lines(&self, level: f64) -> Vec<Vec<Place>> {
        let rows = self.values.len() / self.columns.max(1);
        let mut neighbours: HashMap<Edge, Vec<Edge>> = HashMap::new();
        let mut order: Vec<Edge> = Vec::new();
        for row in 0..rows.saturating_sub(1) {
            for column in 0..self.columns - 1 {
                for (from, to) in self.segments(row * self.columns + column, level) {
                    for (edge, other) in [(from, to), (to, from)] {
                        let known = neighbours.entry(edge).or_insert_with(|| {
                            order.push(edge);
                            Vec::with_capacity(2)
                        });
                        known.push(other);
                    }
                }
            }
        }
        // Lines that end at the rim begin there; what is left are rings.
        let (ends, rings): (Vec<Edge>, Vec<Edge>) = order.iter().partition(|edge| neighbours[*edge].len() == 1);
        let mut lines = Vec::new();
        for start in ends.into_iter().chain(rings) {
            let edges = follow(start, &mut neighbours);
            if edges.len() > 1 {
                lines.push(edges.into_iter().map(|edge| self.crossing(edge, level)).collect());
            }
        }
        lines
    }

    /// What crosses the cell whose lower left node that is: none, one or two segments from edge to
    /// edge.
    fn segments(&self, node: usize, level: f64) -> Vec<(Edge, Edge)> {
        let corners = [node, node + 1, node + self.columns + 1, node + self.columns];
        let heights = corners.map(|corner| self.values[corner]);
        if heights.iter().any(|height| !height.is_finite()) {
            return Vec::new();
        }
        let above = heights.map(|height| height > level);
        // Lower, right, upper, left.
        let edges = [(corners[0], false), (corners[1], true), (corners[3], false), (corners[0], true)];
        let crossed: Vec<Edge> = (0..4).filter(|&i| above[i] != above[(i + 1) % 4]).map(|i| edges[i]).collect();
        match crossed[..] {
            [a, b] => vec![(a, b)],
            [lower, right, upper, left] => {
                let middle_is_above = heights.iter().sum::<f64>() > 4.0 * level;
                if above[0] == middle_is_above { vec![(lower, right), (upper, left)] } else { vec![(left, lower), (right, upper)] }
            }
            _ => Vec::new(),
        }
    }

    #[expect(clippy::cast_precision_loss, reason = "numbers of columns and rows")]
    fn crossing(&self, (node, goes_up): Edge, level: f64) -> Place {
        let other = node + if goes_up { self.columns } else { 1 };
        let (low, high) = (self.values[node], self.values[other]);
        let share = (level - low) / (high - low);
        let (column, row) = ((node % self.columns) as f64, (node / self.columns) as f64);
        if goes_up { (column, row + share) } else { (column + share, row) }
    }
}

/// Walks from crossing to crossing as far as it goes, and takes away what it passes.
fn follow(start: Edge, neighbours: &mut HashMap<Edge, Vec<Edge>>) -> Vec<Edge> {
    let mut line = vec![start];
    let mut here = start;
    while let Some(next) = neighbours.get_mut(&here).and_then(Vec::pop) {
        if let Some(back) = neighbours.get_mut(&next)
            && let Some(i) = back.iter().position(|edge| *edge == here)
        {
            back.swap_remove(i);
        }
        line.push(next);
        here = next;
    }
    line
}

#[cfg(test)]
mod tests {
    use super::Heights;

    fn bowl(columns: i32, center: i32) -> Vec<f64> {
        let square = |i: i32| f64::from((i - center) * (i - center));
        (0..columns * columns).map(|i| square(i % columns) + square(i / columns)).collect()
    }

    #[test]
    fn a_bowl_has_one_closed_ring_at_each_height() {
        let values = bowl(41, 20);
        let lines = Heights { values: &values, columns: 41 }.lines(100.5);
        assert_eq!(lines.len(), 1);
        assert_eq!(lines[0].first(), lines[0].last(), "a ring is closed");
        for (x, y) in &lines[0] {
            let radius = libm::hypot(x - 20.0, y - 20.0);
            // Straight between nodes: half of the second difference of the squares, over the slope.
            assert!((radius - 100.5_f64.sqrt()).abs() < 0.25 / 20.0, "{radius}");
        }
    }

    #[test]
    fn a_line_that_leaves_the_grid_is_open_and_a_node_without_a_value_cuts_it() {
        let values: Vec<f64> = (0..100).map(|i| f64::from(i % 10)).collect();
        let lines = Heights { values: &values, columns: 10 }.lines(4.5);
        assert_eq!(lines.len(), 1);
        assert_eq!(lines[0].len(), 10);
        assert!(lines[0].iter().all(|(x, _)| (x - 4.5).abs() < 1e-12));
        let mut cut = values;
        cut[55] = f64::NAN;
        assert_eq!(Heights { values: &cut, columns: 10 }.lines(4.5).len(), 2);
    }

    #[test]
    fn a_saddle_is_two_lines_that_do_not_cross() {
        for (values, middle) in [([1.0, 0.0, 0.0, 0.9], "below"), ([1.0, 0.2, 0.2, 1.0], "above")] {
            let lines = Heights { values: &values, columns: 2 }.lines(0.5);
            assert_eq!(lines.len(), 2, "{middle}");
        }
        // Low corners are cut off where the middle is high: each line stays with its corner.
        let lines = Heights { values: &[1.0, 0.2, 0.2, 1.0], columns: 2 }.lines(0.5);
        assert!(lines.iter().all(|line| line.iter().all(|(x, y)| x > y) || line.iter().all(|(x, y)| x < y)));
    }

    #[test]
    fn nothing_and_a_single_row_have_no_lines() {
        assert!(Heights { values: &[], columns: 0 }.lines(0.0).is_empty());
        assert!(Heights { values: &[1.0, 2.0], columns: 2 }.lines(1.5).is_empty());
    }
}
