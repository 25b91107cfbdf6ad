//! What an evaluation needs of a geometry: the facet, and its Fresnel reflection, which may be prepared.

use crate::optics::{Facet, Fresnel, RefractiveIndex};

/// A geometry as an evaluation sees it.
pub(crate) trait PreparedGeometry {
    fn facet(&self) -> &Facet;

    /// Its Fresnel reflection on surfaces of that index.
    fn fresnel(&self, index: RefractiveIndex) -> Fresnel {
        Fresnel::new(index, self.facet())
    }
}

impl PreparedGeometry for Facet {
    fn facet(&self) -> &Facet {
        self
    }
}
