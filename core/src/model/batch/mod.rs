//! Many prepared points at once: DoLP, BRDF and derivatives in vectors of doubles.
//!
//! A [`Batch`] holds geometries side by side, prepared once; a surface is evaluated on all of them with the widest instructions that the
//! processor has, found out at run time, and on all processors where there are points enough. The scalar [`Pbrdf`] is the
//! reference: results agree with it to about 10⁻¹⁴, and wherever a lobe comes near the ends of f64, or a surface has no specular
//! light, it is the scalar form that answers, point by point. Terms that are absent or have no weight are left out.
//!
//! A point's result depends on that point alone: it is the same to the bit with or without threads, at any place of the list and for
//! all vector widths with fused multiply–add (AVX2, AVX-512, NEON). SSE2 and WebAssembly lack that; there the last digits may differ.

mod angles;
mod coefficients;
mod elementary;
mod gradient;
mod kernels;
pub(crate) mod lanes;
pub(crate) mod prepared;
pub(crate) mod runner;
pub(crate) mod surface_row;
mod trigonometry;

use crate::model::{GeometrySet, GradientRequest, Parameter, ParameterSet, Pbrdf, PerParameter};
use crate::optics::{Facet, Geometry};
pub use angles::{AngleColumns, AngleColumnsError, PreparedAngles};
use coefficients::Coefficients;
use gradient::{BrdfGradient, COLUMNS, DolpGradient, Slopewise};
use kernels::{Both, Brdf, Dolp};
pub use lanes::Instructions;
use lanes::{Kernel, KernelRun};
use prepared::{PointBlock, blocks};
use runner::{Runner, run_with_terms};

/// Geometries prepared for many evaluations at once.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Batch {
    /// For the scalar form.
    set: GeometrySet,
    blocks: Vec<PointBlock>,
    instructions: Instructions,
    single_threaded: bool,
}

/// DoLP, BRDF and the specular part of it, of each point of a batch.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
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
#[non_exhaustive]
pub struct DolpGradients {
    /// Degree of linear polarisation.
    pub dolp: Vec<f64>,
    /// ∂DoLP/∂p; 0 for parameters that play no part in the model.
    pub by: PerParameter<Vec<f64>>,
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
        Self::from_set(GeometrySet::from_facets(facets))
    }

    /// From a set, and all that is prepared in it.
    #[must_use]
    pub fn from_set(set: GeometrySet) -> Self {
        Self { blocks: blocks(set.facets()), set, ..Self::default() }
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
        self.set.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.set.is_empty()
    }

    /// The geometries, for the scalar form.
    pub(crate) fn geometries(&self) -> &GeometrySet {
        &self.set
    }

    /// The prepared geometries.
    #[must_use]
    pub fn facets(&self) -> &[Facet] {
        self.set.facets()
    }

    /// DoLP of each point, as [`Pbrdf::dolp`] has it; `out` takes as many numbers as there are points.
    pub fn dolp(&self, surface: &Pbrdf, out: &mut Vec<f64>) {
        let scalar = |point: usize| [self.set.dolp(surface, point)];
        let run = self.kernel_run([self.resized(out)], &scalar);
        match Coefficients::new(surface).map(Coefficients::without_zero_terms) {
            Some(of) => run_with_terms!(self, run, Dolp, of.model, &of),
            None => run.run_scalar(),
        }
    }

    /// BRDF of each point in sr⁻¹, as [`Pbrdf::reflection`] has it; `out` takes as many numbers as there are points.
    pub fn brdf(&self, surface: &Pbrdf, out: &mut Vec<f64>) {
        let scalar = |point: usize| [self.set.reflection(surface, point).brdf];
        let run = self.kernel_run([self.resized(out)], &scalar);
        match Coefficients::new(surface).map(Coefficients::without_zero_terms) {
            Some(of) => run_with_terms!(self, run, Brdf, of.model, &of),
            None => run.run_scalar(),
        }
    }

    /// DoLP, BRDF and its specular part of each point, as [`Pbrdf::reflection`] has them.
    pub fn radiances(&self, surface: &Pbrdf, out: &mut Radiances) {
        let scalar = |point: usize| {
            let reflection = self.set.reflection(surface, point);
            [reflection.dolp, reflection.brdf, reflection.specular]
        };
        let columns = [&mut out.dolp, &mut out.brdf, &mut out.specular].map(|column| self.resized(column));
        let run = self.kernel_run(columns, &scalar);
        match Coefficients::new(surface).map(Coefficients::without_zero_terms) {
            Some(of) => run_with_terms!(self, run, Both, of.model, &of),
            None => run.run_scalar(),
        }
    }

    /// DoLP of each point and its derivatives by the parameters, as [`Pbrdf::reflection_and_gradient`] has them.
    pub fn dolp_gradients(&self, surface: &Pbrdf, out: &mut DolpGradients) {
        let dolp = self.resized(&mut out.dolp);
        let columns = PerParameter(out.by.0.each_mut().map(|column| self.resized(column)));
        self.dolp_gradient_columns(surface, dolp, columns);
    }

    /// The same into columns with a number for each point. What is not wanted has an empty column.
    pub(crate) fn dolp_gradient_columns<'a>(&'a self, surface: &Pbrdf, dolp: &'a mut [f64], by: PerParameter<&'a mut [f64]>) {
        let wanted = GradientRequest { by: wanted(&by), brdf: false, dolp: true };
        let scalar = |point: usize| {
            let (reflection, gradient) = self.set.reflection_and_gradient(surface, point, wanted);
            value_and_slopes(reflection.dolp, &gradient.dolp)
        };
        let run = self.kernel_run(value_and_columns(dolp, by), &scalar);
        match Coefficients::new(surface) {
            Some(of) => run_with_terms!(self, run, DolpGradient, of.model, Slopewise { of: &of, by_index: wants_index(wanted.by) }),
            None => run.run_scalar(),
        }
    }

    /// BRDF of each point in sr⁻¹ and its derivatives, as [`Self::dolp_gradient_columns`] has those of DoLP.
    pub(crate) fn brdf_gradient_columns<'a>(&'a self, surface: &Pbrdf, brdf: &'a mut [f64], by: PerParameter<&'a mut [f64]>) {
        let wanted = GradientRequest { by: wanted(&by), brdf: true, dolp: false };
        let scalar = |point: usize| {
            let (reflection, gradient) = self.set.reflection_and_gradient(surface, point, wanted);
            value_and_slopes(reflection.brdf, &gradient.brdf)
        };
        let run = self.kernel_run(value_and_columns(brdf, by), &scalar);
        match Coefficients::new(surface) {
            Some(of) => run_with_terms!(self, run, BrdfGradient, of.model, Slopewise { of: &of, by_index: wants_index(wanted.by) }),
            None => run.run_scalar(),
        }
    }

    /// A column with a number for each point.
    fn resized<'a>(&self, column: &'a mut Vec<f64>) -> &'a mut [f64] {
        column.resize(self.len(), 0.0);
        column.as_mut_slice()
    }

    /// A run over all points.
    fn kernel_run<'a, const OUT: usize>(
        &'a self,
        columns: [&'a mut [f64]; OUT],
        scalar: &'a (dyn Fn(usize) -> [f64; OUT] + Sync),
    ) -> KernelRun<'a, OUT> {
        KernelRun { blocks: &self.blocks, count: self.len(), columns, first: 0, scalar }
    }

    fn run<const OUT: usize>(&self, run: KernelRun<'_, OUT>, kernel: &impl Kernel<OUT>) {
        Runner { instructions: self.instructions, single_threaded: self.single_threaded }.run(run, kernel);
    }
}

/// The parameters with a column.
fn wanted(columns: &PerParameter<&mut [f64]>) -> ParameterSet {
    Parameter::ALL.into_iter().filter(|&parameter| !columns[parameter].is_empty()).collect()
}

fn wants_index(by: ParameterSet) -> bool {
    by.contains(Parameter::N) || by.contains(Parameter::K)
}

/// The columns of a gradient kernel.
fn value_and_columns<'a>(value: &'a mut [f64], by: PerParameter<&'a mut [f64]>) -> [&'a mut [f64]; COLUMNS] {
    let mut columns = std::iter::once(value).chain(by.0);
    std::array::from_fn(|_| columns.next().unwrap_or_default())
}

/// The numbers of a gradient kernel.
fn value_and_slopes(value: f64, slopes: &PerParameter<f64>) -> [f64; COLUMNS] {
    let mut numbers = [value; COLUMNS];
    numbers[1..].copy_from_slice(&slopes.0);
    numbers
}
