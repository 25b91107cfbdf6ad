//! A list of geometries prepared once for many evaluations.

use super::{Gradient, Pbrdf, Reflection, Wanted};
use crate::optics::{Facet, Geometry};

/// Geometries, prepared.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Scene {
    facets: Vec<Facet>,
}

impl Scene {
    /// Prepares geometries, keeping their order.
    #[must_use]
    pub fn new(geometries: impl IntoIterator<Item = Geometry>) -> Self {
        Self { facets: geometries.into_iter().map(Facet::new).collect() }
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

    /// BRDF, DoLP and terms of each.
    pub fn reflections<'a>(&'a self, surface: &'a Pbrdf) -> impl Iterator<Item = Reflection> + 'a {
        self.facets.iter().map(|facet| surface.reflection(facet))
    }

    /// The same with derivatives.
    pub fn reflections_and_gradients<'a>(
        &'a self,
        surface: &'a Pbrdf,
        wanted: Wanted,
    ) -> impl Iterator<Item = (Reflection, Gradient)> + 'a {
        self.facets.iter().map(move |facet| surface.reflection_and_gradient(facet, wanted))
    }
}
