//! Which instructions carry the lanes, and points and results on their way through them.
//!
//! Every kernel is lane-wise: a point's result depends on that point alone, not on its neighbours, on the width of the vectors or on how
//! the points were shared among threads. With fused multiply–add (AVX2, AVX-512, NEON) it is the same to the bit; without (SSE2, WebAssembly)
//! the same formulas round once more here and there.

use crate::model::batch::prepared::{LANES, PointBlock};
use fearless_simd::{Level, prelude::*};
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

/// Points that one thread takes at once: some 20 µs of work, ten times what handing it over costs.
#[cfg(feature = "threads")]
const GRAIN: usize = 4096;

/// A vector of the width that the instructions have.
pub(crate) type V<S> = <S as Simd>::f64s;
/// Its bits.
pub(crate) type Bits<S> = <V<S> as SimdFloat<S>>::Bits;
/// One truth value per lane.
pub(crate) type Mask<S> = <S as Simd>::mask64s;

/// The same number in every lane.
#[inline(always)]
pub(crate) fn number<S: Simd>(simd: S, value: f64) -> V<S> {
    value.simd_into(simd)
}

/// The instructions to use. What the processor lacks is replaced by the widest it has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Instructions {
    /// The widest that the processor has.
    #[default]
    Widest,
    /// Not AVX-512, even where it is there.
    Avx2,
    /// What every processor of its kind has: SSE2, NEON or WebAssembly's 128 bits.
    Portable,
}

/// Set by [`Instructions::use_portable_only`].
static ARE_PORTABLE: AtomicBool = AtomicBool::new(false);

impl Instructions {
    /// From here on the whole program uses no wider instructions than [`Self::Portable`], none of which multiplies and adds in one
    /// rounding: numbers are then the same to the bit on old processors, on new ones, and in browsers. False, and nothing changes, where
    /// every processor rounds once (NEON).
    #[must_use]
    pub fn use_portable_only() -> bool {
        let rounds_once = matches!(Self::Portable.name(), "NEON");
        ARE_PORTABLE.store(!rounds_once, Ordering::Relaxed);
        !rounds_once
    }

    /// What is used on this machine, for people: `AVX-512`, `AVX2`, `SSE2`, `NEON`, `portable`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self.level() {
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Level::Avx512(_) => "AVX-512",
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Level::Avx2(_) => "AVX2",
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Level::Sse2(_) => "SSE2",
            #[cfg(target_arch = "aarch64")]
            Level::Neon(_) => "NEON",
            _ => "portable",
        }
    }

    fn level(self) -> Level {
        let widest = Level::new();
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        let this = if ARE_PORTABLE.load(Ordering::Relaxed) { Self::Portable } else { self };
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        {
            let avx512 = if this == Self::Widest { widest.as_avx512() } else { None };
            let avx2 = if this == Self::Portable { None } else { widest.as_avx2() };
            // SSE4.2 adds nothing that the kernels use.
            match (avx512, avx2, widest.as_sse2()) {
                (Some(avx512), ..) => return Level::Avx512(avx512),
                (None, Some(avx2), _) => return Level::Avx2(avx2),
                (None, None, Some(sse2)) => return Level::Sse2(sse2),
                (None, None, None) => {}
            }
        }
        widest
    }
}

/// What is computed of a point, `OUT` numbers.
pub(crate) trait Kernel<const OUT: usize>: Sync {
    /// The numbers, and where they are not to be trusted: there the scalar form is asked.
    fn at<S: Simd>(&self, simd: S, points: &Points<'_, S>) -> ([V<S>; OUT], Mask<S>);
}

/// As many prepared points as a vector has lanes.
pub(crate) struct Points<'a, S: Simd> {
    simd: S,
    block: &'a PointBlock,
    first: usize,
}

impl<S: Simd> Points<'_, S> {
    /// A column of [`PointBlock`].
    #[inline(always)]
    pub(crate) fn load(&self, column: impl Fn(&PointBlock) -> &[f64; LANES]) -> V<S> {
        V::<S>::from_slice(self.simd, &column(self.block)[self.first..self.first + V::<S>::LEN])
    }
}

/// Points to be evaluated: whole and broken blocks, where the results go, and the scalar form.
pub(crate) struct KernelRun<'a, const OUT: usize> {
    pub blocks: &'a [PointBlock],
    /// How many points.
    pub count: usize,
    /// A number for each point; a column that is not wanted is empty.
    pub columns: [&'a mut [f64]; OUT],
    /// Number of the first point.
    pub first: usize,
    /// By the number of the point.
    pub scalar: &'a (dyn Fn(usize) -> [f64; OUT] + Sync),
}

impl<const OUT: usize> KernelRun<'_, OUT> {
    /// Evaluates all points with those instructions, on several threads where that pays.
    #[cfg(feature = "threads")]
    pub(crate) fn run_parallel<K: Kernel<OUT>>(self, kernel: &K, instructions: Instructions) {
        if self.count <= GRAIN {
            return self.run(kernel, instructions);
        }
        let middle = (self.count / 2).next_multiple_of(LANES);
        let (left, right) = self.split(middle);
        rayon::join(|| left.run_parallel(kernel, instructions), || right.run_parallel(kernel, instructions));
    }

    /// Evaluates all points with those instructions.
    #[cfg(not(feature = "threads"))]
    pub(crate) fn run_parallel<K: Kernel<OUT>>(self, kernel: &K, instructions: Instructions) {
        self.run(kernel, instructions);
    }

    /// Two jobs: the points before `middle`, a multiple of [`LANES`], and the others.
    #[cfg(feature = "threads")]
    fn split(self, middle: usize) -> (Self, Self) {
        let (left_blocks, right_blocks) = self.blocks.split_at(middle / LANES);
        let mut right_columns = Vec::with_capacity(OUT);
        let left_columns = self.columns.map(|column| {
            let (left, right) = column.split_at_mut(middle.min(column.len()));
            right_columns.push(right);
            left
        });
        let mut right_columns = right_columns.into_iter();
        let right_columns = std::array::from_fn(|_| right_columns.next().unwrap_or_default());
        (
            Self { blocks: left_blocks, count: middle, columns: left_columns, ..self },
            Self {
                blocks: right_blocks,
                count: self.count - middle,
                columns: right_columns,
                first: self.first + middle,
                scalar: self.scalar,
            },
        )
    }

    /// Evaluates all points with those instructions on this thread.
    pub(crate) fn run<K: Kernel<OUT>>(self, kernel: &K, instructions: Instructions) {
        dispatch(instructions, KernelTask { run: self, kernel });
    }

    #[inline(always)]
    fn run_on<S: Simd, K: Kernel<OUT>>(mut self, simd: S, kernel: &K) {
        let count = self.count;
        let whole = count / LANES;
        for (i, block) in self.blocks.iter().enumerate().take(whole) {
            for first in (0..LANES).step_by(V::<S>::LEN) {
                let (values, needs_scalar) = kernel.at(simd, &Points { simd, block, first });
                let at = LANES * i + first;
                // By reference: moved, the vectors would go through memory.
                for (column, value) in self.columns.iter_mut().zip(&values) {
                    if !column.is_empty() {
                        value.store_slice(&mut column[at..at + V::<S>::LEN]);
                    }
                }
                if needs_scalar.any_true() {
                    self.repair(at..at + V::<S>::LEN, needs_scalar.to_bitmask());
                }
            }
        }
        if let Some(block) = self.blocks.get(whole) {
            self.run_tail(simd, kernel, block, LANES * whole..count);
        }
    }

    /// The last block, of which only a part is wanted.
    #[inline(always)]
    fn run_tail<S: Simd, K: Kernel<OUT>>(&mut self, simd: S, kernel: &K, block: &PointBlock, wanted: Range<usize>) {
        for first in (0..wanted.len()).step_by(V::<S>::LEN) {
            let (values, needs_scalar) = kernel.at(simd, &Points { simd, block, first });
            let at = wanted.start + first;
            let end = wanted.end.min(at + V::<S>::LEN);
            for (column, value) in self.columns.iter_mut().zip(values).filter(|(column, _)| !column.is_empty()) {
                column[at..end].copy_from_slice(&value.as_slice()[..end - at]);
            }
            if needs_scalar.any_true() {
                self.repair(at..end, needs_scalar.to_bitmask());
            }
        }
    }

    /// Puts the scalar form's numbers where the lane of that bit is needs_scalar.
    #[cold]
    #[inline(never)]
    fn repair(&mut self, points: Range<usize>, needs_scalar: u64) {
        for (lane, point) in points.enumerate() {
            if needs_scalar >> lane & 1 == 1 {
                self.put(point);
            }
        }
    }

    /// Evaluates all points by the scalar form.
    #[cold]
    pub(crate) fn run_scalar(mut self) {
        for point in 0..self.count {
            self.put(point);
        }
    }

    fn put(&mut self, point: usize) {
        let values = (self.scalar)(self.first + point);
        for (column, value) in self.columns.iter_mut().zip(values).filter(|(column, _)| !column.is_empty()) {
            column[point] = value;
        }
    }
}

/// Work that is compiled for each kind of instructions.
pub(crate) trait Vectorised {
    /// With vectors.
    fn run<S: Simd>(self, simd: S);
    /// Where the processor has none.
    fn run_scalar(self);
}

/// Does the work with those instructions.
pub(crate) fn dispatch(instructions: Instructions, task: impl Vectorised) {
    match instructions.level() {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        Level::Avx512(simd) => simd.vectorize(
            #[inline(always)]
            || task.run(simd),
        ),
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        Level::Avx2(simd) => simd.vectorize(
            #[inline(always)]
            || task.run(simd),
        ),
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        Level::Sse2(simd) => simd.vectorize(
            #[inline(always)]
            || task.run(simd),
        ),
        #[cfg(target_arch = "aarch64")]
        Level::Neon(simd) => simd.vectorize(
            #[inline(always)]
            || task.run(simd),
        ),
        #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
        Level::WasmSimd128(simd) => simd.vectorize(
            #[inline(always)]
            || task.run(simd),
        ),
        _ => task.run_scalar(),
    }
}

/// A kernel on its points.
struct KernelTask<'a, 'k, const OUT: usize, K> {
    run: KernelRun<'a, OUT>,
    kernel: &'k K,
}

impl<const OUT: usize, K: Kernel<OUT>> Vectorised for KernelTask<'_, '_, OUT, K> {
    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        self.run.run_on(simd, self.kernel);
    }

    fn run_scalar(self) {
        self.run.run_scalar();
    }
}

/// The first where the mask is true, else the second.
#[inline(always)]
pub(crate) fn choose<S: Simd>(mask: Mask<S>, yes: V<S>, no: V<S>) -> V<S> {
    mask.select(yes, no)
}
