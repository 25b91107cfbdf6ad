//! A joint fit as a least squares problem, with local coordinates in which its valleys are straight.
//!
//! They are those of one measurement ([`crate::fit::local::reparametrisation`]): a weight follows the height of the specular peak when σ or q
//! moves. A measurement's own weight follows its own peak, whether σ and q are shared or own. A shared weight has one peak to follow only
//! where σ and q are shared too.

use crate::fit::joint::problem::JointProblem;
use crate::fit::least_squares::LeastSquares;
use crate::fit::local::reparametrisation::{ROUNDING_OBJECTIVE, Unknowns, local_bounds, moved};
use crate::model::Parameter;
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

impl JointProblem {
    /// The exponent with which a weight follows the peak; 0 for unknowns that are not coupled.
    pub(crate) fn coupling(&self, unknown: usize) -> i32 {
        if !self.model().specular {
            return 0;
        }
        let is_free = |parameter: Parameter| self.unknowns().iter().any(|other| other.parameter == parameter && other.set.is_none());
        let set = self.set_of(unknown);
        let has_one_peak = [Parameter::Sigma, Parameter::Q].iter().all(|&parameter| !self.own().contains(parameter));
        if set.is_none() && !has_one_peak {
            return 0;
        }
        let knows_only_ratios = match set {
            // A shared k_s that other data determine takes the place of k_d and k_v even where there is DoLP alone.
            Some(part) => self.parts()[part].knows_only_ratios() && (self.knows_only_ratios() || !is_free(Parameter::Ks)),
            None => self.knows_only_ratios(),
        };
        match self.unknowns()[unknown].parameter {
            Parameter::Kd | Parameter::Kv if knows_only_ratios => 1,
            Parameter::Ks if !knows_only_ratios => -1,
            _ => 0,
        }
    }

    /// Whether a weight follows the peak that an unknown σ or q moves.
    fn is_coupled(&self, weight: usize, shape: usize) -> bool {
        match (self.set_of(weight), self.set_of(shape)) {
            (Some(one), Some(other)) => one == other,
            _ => true,
        }
    }
}

impl LeastSquares for JointProblem {
    fn residual_count(&self) -> usize {
        self.len()
    }

    fn start(&self) -> DVector<f64> {
        self.unknowns_at(Self::start(self))
    }

    fn bounds_of(&self, unknown: usize) -> (f64, f64) {
        let (part, place) = self.home(unknown);
        self.parts()[part].bounds_of(place)
    }

    fn rows_of(&self, unknown: usize) -> Range<usize> {
        self.set_of(unknown).map_or(0..self.len(), |set| self.rows()[set].clone())
    }

    fn residuals_at(&self, x: &DVector<f64>, out: &mut DVector<f64>) -> bool {
        self.write_residuals(&self.parameters_of(x), out)
    }

    fn jacobian_at(&self, x: &DVector<f64>, out: &mut DMatrix<f64>) -> bool {
        self.write_jacobian(&self.parameters_of(x), out)
    }

    fn objective_at(&self, sum_of_squares: f64, x: &DVector<f64>) -> f64 {
        if self.minimises_delta_e() { sum_of_squares } else { self.delta_e(&self.parameters_of(x)).unwrap_or(sum_of_squares) }
    }

    fn negligible(&self) -> f64 {
        ROUNDING_OBJECTIVE
    }

    fn to_local(&self, x: &DVector<f64>, moving: &[usize], jacobian: &mut DMatrix<f64>) {
        let unknowns = Unknowns {
            distribution: self.model().distribution,
            parameter: &|unknown| self.unknowns()[unknown].parameter,
            weight_exponent: &|weight, by| if self.is_coupled(weight, by) { self.weight_exponent(weight) } else { 0 },
        };
        unknowns.to_local(x, moving, jacobian);
    }

    fn local_bounds(&self, x: &DVector<f64>, unknown: usize) -> (f64, f64) {
        local_bounds(self.unknowns()[unknown].parameter, x[unknown], self.bounds_of(unknown))
    }

    fn straight(&self, unknown: usize, value: f64) -> f64 {
        let (part, place) = self.home(unknown);
        self.parts()[part].straight(place, value)
    }

    fn at_straight(&self, unknown: usize, coordinate: f64) -> f64 {
        let (part, place) = self.home(unknown);
        self.parts()[part].at_straight(place, coordinate)
    }

    fn retract(&self, x: &DVector<f64>, moving: &[usize], step: &[f64], out: &mut DVector<f64>) {
        out.copy_from(x);
        for (&j, step) in moving.iter().zip(step) {
            out[j] = moved(self.unknowns()[j].parameter, x[j], *step);
        }
        let (from, to) = (self.parameters_of(x), self.parameters_of(out));
        for &j in moving {
            let weight_exponent = self.weight_exponent(j);
            if weight_exponent == 0 {
                continue;
            }
            let set = self.set_of(j).unwrap_or(0);
            let part = &self.parts()[set];
            let flatter = part.inverse_peak_height(&to[set]) / part.inverse_peak_height(&from[set]);
            out[j] *= if weight_exponent > 0 { 1.0 / flatter } else { flatter };
        }
    }
}
