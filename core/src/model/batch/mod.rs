//! Many prepared points at once: DoLP, BRDF and derivatives in vectors of doubles.
//!
//! A [`Batch`] holds geometries side by side, prepared once; a surface is evaluated on all of them with the widest instructions that the
//! processor has, found out at run time, and on all processors where there are points enough. The scalar [`Pbrdf`] is the
//! reference: results agree with it to about 10⁻¹⁴, and wherever a lobe comes near the ends of f64, or a surface has no specular
//! light, it is the scalar form that answers, point by point. Terms that are absent or have no weight are left out.
//!
//! A point's result depends on that point alone: it is the same to the bit with or without threads, at any place of the list and for
//! all vector widths with fused multiply–add (AVX2, AVX-512, NEON). SSE2 and WebAssembly lack that; there the last digits may differ.

mod coefficients;
mod elementary;
mod gradient;
mod kernels;
mod lanes;
mod prepared;

use crate::model::{Diffuse, GeometrySet, GradientRequest, ParameterSet, Pbrdf};
use crate::optics::{Facet, Geometry, SlopeDistribution};
use coefficients::Coefficients;
use gradient::DolpGradient;
use kernels::{Both, Brdf, Dolp, LAMBERT, MINNAERT, NONE};
pub use lanes::Instructions;
use lanes::{Kernel, Run};
use prepared::{Block, blocks};

/// Geometries prepared for many evaluations at once.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Batch {
    /// For the scalar form.
    scene: GeometrySet,
    blocks: Vec<Block>,
    instructions: Instructions,
    single_threaded: bool,
}

/// DoLP, BRDF and the specular part of it, of each point of a batch.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Radiances {
    /// Degree of linear polarisation.
    pub dolp: Vec<f64>,
    /// BRDF, F00, in sr⁻¹.
    pub brdf: Vec<f64>,
    /// Specular part of the BRDF, k_s F^s, in sr⁻¹.
    pub specular: Vec<f64>,
}

/// DoLP and its derivatives, of each point of a batch.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DolpGradients {
    /// Degree of linear polarisation.
    pub dolp: Vec<f64>,
    /// ∂DoLP/∂p in the order of [`Parameter::ALL`](crate::model::Parameter::ALL); 0 for parameters that play no part in the model.
    pub by: [Vec<f64>; 9],
}

/// Runs a kernel with the terms that a model has: `$kernel::<CAUCHY, DIFFUSE, VOLUME>`.
macro_rules! run_with_terms {
    ($batch:expr, $job:expr, $kernel:ident, $of:expr) => {
        match ($of.model.distribution == SlopeDistribution::Cauchy, $of.model.diffuse, $of.model.volume) {
            (false, Diffuse::Absent, false) => $batch.run($job, &$kernel::<false, NONE, false>($of)),
            (false, Diffuse::Absent, true) => $batch.run($job, &$kernel::<false, NONE, true>($of)),
            (false, Diffuse::Lambert, false) => $batch.run($job, &$kernel::<false, LAMBERT, false>($of)),
            (false, Diffuse::Lambert, true) => $batch.run($job, &$kernel::<false, LAMBERT, true>($of)),
            (false, Diffuse::Minnaert, false) => $batch.run($job, &$kernel::<false, MINNAERT, false>($of)),
            (false, Diffuse::Minnaert, true) => $batch.run($job, &$kernel::<false, MINNAERT, true>($of)),
            (true, Diffuse::Absent, false) => $batch.run($job, &$kernel::<true, NONE, false>($of)),
            (true, Diffuse::Absent, true) => $batch.run($job, &$kernel::<true, NONE, true>($of)),
            (true, Diffuse::Lambert, false) => $batch.run($job, &$kernel::<true, LAMBERT, false>($of)),
            (true, Diffuse::Lambert, true) => $batch.run($job, &$kernel::<true, LAMBERT, true>($of)),
            (true, Diffuse::Minnaert, false) => $batch.run($job, &$kernel::<true, MINNAERT, false>($of)),
            (true, Diffuse::Minnaert, true) => $batch.run($job, &$kernel::<true, MINNAERT, true>($of)),
            (_, Diffuse::Hyde, _) => $job.run_scalar(),
        }
    };
}

impl Batch {
    /// Prepares geometries, keeping their order.
    #[must_use]
    pub fn new(geometries: impl IntoIterator<Item = Geometry>) -> Self {
        Self::from_facets(geometries.into_iter().map(Facet::new).collect())
    }

    /// From geometries that are prepared already.
    #[must_use]
    pub fn from_facets(facets: Vec<Facet>) -> Self {
        Self::from_scene(GeometrySet::from_facets(facets))
    }

    /// From a scene, and all that is prepared in it.
    #[must_use]
    pub fn from_scene(scene: GeometrySet) -> Self {
        Self { blocks: blocks(scene.facets()), scene, ..Self::default() }
    }

    /// With other instructions than the widest that the processor has.
    #[must_use]
    pub fn with_instructions(self, instructions: Instructions) -> Self {
        Self { instructions, ..self }
    }

    /// On the calling thread alone, however many points there are.
    #[must_use]
    pub fn single_threaded(self) -> Self {
        Self { single_threaded: true, ..self }
    }

    /// How many points.
    #[must_use]
    pub fn len(&self) -> usize {
        self.scene.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.scene.is_empty()
    }

    /// The prepared geometries.
    #[must_use]
    pub fn facets(&self) -> &[Facet] {
        self.scene.facets()
    }

    /// DoLP of each point, as [`Pbrdf::dolp`] has it; `out` takes as many numbers as there are points.
    pub fn dolp(&self, surface: &Pbrdf, out: &mut Vec<f64>) {
        let scalar = |point: usize| [self.scene.dolp(surface, point)];
        let job = self.job([out], &scalar);
        match Coefficients::new(surface).map(Coefficients::without_zero_terms) {
            Some(of) => run_with_terms!(self, job, Dolp, &of),
            None => job.run_scalar(),
        }
    }

    /// BRDF of each point in sr⁻¹, as [`Pbrdf::reflection`] has it; `out` takes as many numbers as there are points.
    pub fn brdf(&self, surface: &Pbrdf, out: &mut Vec<f64>) {
        let scalar = |point: usize| [self.scene.reflection(surface, point).brdf];
        let job = self.job([out], &scalar);
        match Coefficients::new(surface).map(Coefficients::without_zero_terms) {
            Some(of) => run_with_terms!(self, job, Brdf, &of),
            None => job.run_scalar(),
        }
    }

    /// DoLP, BRDF and its specular part of each point, as [`Pbrdf::reflection`] has them.
    pub fn radiances(&self, surface: &Pbrdf, out: &mut Radiances) {
        let scalar = |point: usize| {
            let reflection = self.scene.reflection(surface, point);
            [reflection.dolp, reflection.brdf, reflection.specular]
        };
        let job = self.job([&mut out.dolp, &mut out.brdf, &mut out.specular], &scalar);
        match Coefficients::new(surface).map(Coefficients::without_zero_terms) {
            Some(of) => run_with_terms!(self, job, Both, &of),
            None => job.run_scalar(),
        }
    }

    /// DoLP of each point and its derivatives by the nine parameters, as [`Pbrdf::reflection_and_gradient`] has them.
    pub fn dolp_gradients(&self, surface: &Pbrdf, out: &mut DolpGradients) {
        let wanted = GradientRequest { by: ParameterSet::ALL, brdf: false, dolp: true };
        let scalar = |point: usize| {
            let (reflection, gradient) = self.scene.reflection_and_gradient(surface, point, wanted);
            std::array::from_fn(|column| if column == 0 { reflection.dolp } else { gradient.dolp[column - 1] })
        };
        let DolpGradients { dolp, by: [n, k, sigma, ks, kd, kv, q, c, sigma_v] } = out;
        let job = self.job([dolp, n, k, sigma, ks, kd, kv, q, c, sigma_v], &scalar);
        match Coefficients::new(surface) {
            Some(of) => run_with_terms!(self, job, DolpGradient, &of),
            None => job.run_scalar(),
        }
    }

    /// All points, with columns of their number.
    fn job<'a, const OUT: usize>(
        &'a self,
        columns: [&'a mut Vec<f64>; OUT],
        scalar: &'a (dyn Fn(usize) -> [f64; OUT] + Sync),
    ) -> Run<'a, OUT> {
        let columns = columns.map(|column| {
            column.resize(self.len(), 0.0);
            column.as_mut_slice()
        });
        Run { blocks: &self.blocks, columns, first: 0, scalar }
    }

    fn run<const OUT: usize>(&self, job: Run<'_, OUT>, kernel: &impl Kernel<OUT>) {
        if self.single_threaded {
            job.run(kernel, self.instructions);
        } else {
            job.run_parallel(kernel, self.instructions);
        }
    }
}
