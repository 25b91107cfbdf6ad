//! Kernels on blocks of prepared points, with the terms that a model has.

use crate::model::batch::coefficients::Coefficients;
use crate::model::batch::kernels::Both;
use crate::model::batch::lanes::{Instructions, Kernel, KernelRun};
use crate::model::batch::prepared::PointBlock;
use crate::model::{Pbrdf, Reflection};

/// Runs a kernel with the terms that a model has: `$kernel::<CAUCHY, DIFFUSE, VOLUME>`.
macro_rules! run_with_terms {
    ($batch:expr, $run:expr, $kernel:ident, $model:expr, $of:expr) => {{
        use $crate::model::Diffuse;
        use $crate::model::batch::kernels::{LAMBERT, MINNAERT, NONE};
        use $crate::optics::SlopeDistribution;
        match ($model.distribution == SlopeDistribution::Cauchy, $model.diffuse, $model.volume) {
            (false, Diffuse::Absent, false) => $batch.run($run, &$kernel::<false, NONE, false>($of)),
            (false, Diffuse::Absent, true) => $batch.run($run, &$kernel::<false, NONE, true>($of)),
            (false, Diffuse::Lambert, false) => $batch.run($run, &$kernel::<false, LAMBERT, false>($of)),
            (false, Diffuse::Lambert, true) => $batch.run($run, &$kernel::<false, LAMBERT, true>($of)),
            (false, Diffuse::Minnaert, false) => $batch.run($run, &$kernel::<false, MINNAERT, false>($of)),
            (false, Diffuse::Minnaert, true) => $batch.run($run, &$kernel::<false, MINNAERT, true>($of)),
            (true, Diffuse::Absent, false) => $batch.run($run, &$kernel::<true, NONE, false>($of)),
            (true, Diffuse::Absent, true) => $batch.run($run, &$kernel::<true, NONE, true>($of)),
            (true, Diffuse::Lambert, false) => $batch.run($run, &$kernel::<true, LAMBERT, false>($of)),
            (true, Diffuse::Lambert, true) => $batch.run($run, &$kernel::<true, LAMBERT, true>($of)),
            (true, Diffuse::Minnaert, false) => $batch.run($run, &$kernel::<true, MINNAERT, false>($of)),
            (true, Diffuse::Minnaert, true) => $batch.run($run, &$kernel::<true, MINNAERT, true>($of)),
            (_, Diffuse::Hyde, _) => $run.run_scalar(),
        }
    }};
}
pub(crate) use run_with_terms;

/// How kernels are run.
pub(crate) struct Runner {
    pub instructions: Instructions,
    pub single_threaded: bool,
}

impl Runner {
    pub(crate) fn run<const OUT: usize>(&self, run: KernelRun<'_, OUT>, kernel: &impl Kernel<OUT>) {
        if self.single_threaded {
            run.run(kernel, self.instructions);
        } else {
            run.run_parallel(kernel, self.instructions);
        }
    }
}

/// DoLP, BRDF and its specular part of `count` prepared points that no [`crate::model::Batch`] holds, on the calling thread.
/// A column that is not wanted is empty; `reflection` is the scalar form at the point of that number.
pub(crate) fn radiances_of_blocks(
    surface: &Pbrdf,
    blocks: &[PointBlock],
    count: usize,
    columns: [&mut [f64]; 3],
    reflection: &(dyn Fn(usize) -> Reflection + Sync),
) {
    let scalar = |point: usize| {
        let reflection = reflection(point);
        [reflection.dolp, reflection.brdf, reflection.specular]
    };
    let run = KernelRun { blocks, count, columns, first: 0, scalar: &scalar };
    let runner = Runner { instructions: Instructions::Widest, single_threaded: true };
    match Coefficients::new(surface).map(Coefficients::without_zero_terms) {
        Some(of) => run_with_terms!(runner, run, Both, of.model, &of),
        None => run.run_scalar(),
    }
}
