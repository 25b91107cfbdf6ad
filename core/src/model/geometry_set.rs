//! A list of geometries prepared once for many evaluations, and, where the index stays the same, their Fresnel reflection as well.

use crate::model::prepared::PreparedGeometry;
use crate::model::{Gradient, GradientRequest, Pbrdf, Reflection};
use crate::optics::{Facet, Fresnel, Geometry, RefractiveIndex};
use std::sync::Arc;

/// Geometries, prepared.
#[derive(Debug, Clone, Default)]
pub struct GeometrySet {
    facets: Vec<Facet>,
    /// Of each facet, for surfaces of that index.
    fresnel: Option<(RefractiveIndex, Arc<[Fresnel]>)>,
}

/// Equal where the geometries are: what else is prepared changes no result.
impl PartialEq for GeometrySet {
    fn eq(&self, other: &Self) -> bool {
        self.facets == other.facets
    }
}

impl GeometrySet {
    /// Prepares geometries, keeping their order.
    #[must_use]
    pub fn new(geometries: impl IntoIterator<Item = Geometry>) -> Self {
        Self::from_facets(geometries.into_iter().map(Facet::new).collect())
    }

    /// From geometries that are prepared already.
    #[must_use]
    pub fn from_facets(facets: Vec<Facet>) -> Self {
        Self { facets, ..Self::default() }
    }

    /// With the Fresnel reflection of all facets prepared for surfaces of one index; others are evaluated as before.
    #[must_use]
    pub fn with_index(self, index: RefractiveIndex) -> Self {
        if self.fresnel.as_ref().is_some_and(|(prepared, _)| *prepared == index) {
            return self;
        }
        let fresnel = self.facets.iter().map(|facet| Fresnel::new(index, facet)).collect();
        Self { fresnel: Some((index, fresnel)), ..self }
    }

    /// How many geometries.
    #[must_use]
    pub fn len(&self) -> usize {
        self.facets.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.facets.is_empty()
    }

    /// The prepared geometries.
    #[must_use]
    pub fn facets(&self) -> &[Facet] {
        &self.facets
    }

    /// DoLP of the geometry of that number, as [`Pbrdf::dolp`] has it.
    #[must_use]
    pub fn dolp(&self, surface: &Pbrdf, point: usize) -> f64 {
        surface.dolp_with(&self.at(point))
    }

    /// BRDF, DoLP and terms of the geometry of that number, as [`Pbrdf::reflection`] has them.
    #[must_use]
    pub fn reflection(&self, surface: &Pbrdf, point: usize) -> Reflection {
        surface.reflection_with(&self.at(point))
    }

    /// The same with derivatives, as [`Pbrdf::reflection_and_gradient`] has them.
    #[must_use]
    pub fn reflection_and_gradient(&self, surface: &Pbrdf, point: usize, wanted: GradientRequest) -> (Reflection, Gradient) {
        surface.reflection_and_gradient_with(&self.at(point), wanted)
    }

    /// BRDF, DoLP and terms of each.
    pub fn reflections<'a>(&'a self, surface: &'a Pbrdf) -> impl Iterator<Item = Reflection> + 'a {
        (0..self.len()).map(|point| self.reflection(surface, point))
    }

    /// The same with derivatives.
    pub fn reflections_and_gradients<'a>(
        &'a self,
        surface: &'a Pbrdf,
        wanted: GradientRequest,
    ) -> impl Iterator<Item = (Reflection, Gradient)> + 'a {
        (0..self.len()).map(move |point| self.reflection_and_gradient(surface, point, wanted))
    }

    fn at(&self, point: usize) -> PreparedPoint<'_> {
        PreparedPoint { set: self, point }
    }
}

/// One geometry of a set.
struct PreparedPoint<'a> {
    set: &'a GeometrySet,
    point: usize,
}

impl PreparedGeometry for PreparedPoint<'_> {
    fn facet(&self) -> &Facet {
        &self.set.facets[self.point]
    }

    fn fresnel(&self, wanted: RefractiveIndex) -> Fresnel {
        match &self.set.fresnel {
            Some((index, fresnel)) if *index == wanted => fresnel[self.point],
            _ => Fresnel::new(wanted, self.facet()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::GeometrySet;
    use crate::model::{GradientRequest, Model, Parameters, Pbrdf};
    use crate::optics::{Facet, Geometry, RefractiveIndex, SlopeDistribution};

    #[test]
    fn a_prepared_index_serves_its_own_surfaces_and_no_others() {
        let geometries = [(30.0, 50.0, 180.0), (0.0, 0.0, 0.0), (80.0, 10.0, 75.0)];
        let geometries = geometries.map(|(theta_i, theta_r, dphi)| Geometry::new(theta_i, theta_r, dphi).expect("angles in range"));
        let defaults = Parameters::default();
        let index = RefractiveIndex::new(defaults.n, defaults.k).expect("an index");
        let set = GeometrySet::new(geometries).with_index(index);
        for parameters in [defaults, Parameters { sigma: 0.1, ..defaults }, Parameters { n: 1.5, ..defaults }] {
            let surface = Pbrdf::new(Model::full(SlopeDistribution::Cauchy), parameters).expect("in range");
            for (point, geometry) in geometries.into_iter().enumerate() {
                let facet = Facet::new(geometry);
                assert_eq!(set.dolp(&surface, point), surface.dolp(&facet));
                assert_eq!(set.reflection(&surface, point), surface.reflection(&facet));
                let expected = surface.reflection_and_gradient(&facet, GradientRequest::ALL);
                assert_eq!(set.reflection_and_gradient(&surface, point, GradientRequest::ALL), expected);
            }
        }
    }
}
