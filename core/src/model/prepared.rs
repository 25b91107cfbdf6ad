//! What an evaluation needs of a geometry, and may find prepared: the facet, its Fresnel reflection, and the digits for far tails.

use crate::optics::{Facet, Fresnel, RefractiveIndex, SharpFacet};

/// A geometry as an evaluation sees it.
pub(crate) trait PreparedGeometry {
    fn facet(&self) -> &Facet;

    /// Its Fresnel reflection on surfaces of that index.
    fn fresnel(&self, index: RefractiveIndex) -> Fresnel {
        Fresnel::new(index, self.facet())
    }

    /// What exponents need where f64 has too few digits; costly to make, and seldom asked for.
    fn sharp(&self) -> SharpFacet {
        SharpFacet::new(self.facet().geometry)
    }
}

impl PreparedGeometry for Facet {
    fn facet(&self) -> &Facet {
        self
    }
}
