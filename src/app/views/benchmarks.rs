//! The reports of benchmarks as the window shows them.

use crate::app::plots::FigurePlot;
use crate::app::tasks::benchmarks::{BenchmarkId, BenchmarkResult};
use crate::app::text::i18n::{self, Language};
use crate::app::text::messages::WindowWording;
use crate::figure::Figure;
use crate::report::BenchmarkFigures;
use pbrdf::selftest::{BenchmarkRow, Cost, ErrorVsTime, Report, Stability};

/// A report as it is shown.
pub struct BenchmarkView<R> {
    pub report: Report<R>,
    /// Whether it was stopped before its end.
    pub is_part: bool,
    /// The language of its figures.
    language: Option<Language>,
    /// The table, row by row.
    pub cells: Vec<Vec<String>>,
    /// Its figures.
    pub plots: Vec<FigurePlot<Language>>,
    /// 0 is the table, then the figures.
    pub page: usize,
}

impl<R: BenchmarkRow> BenchmarkView<R>
where
    Report<R>: BenchmarkFigures,
{
    fn new(report: Report<R>, is_part: bool, page: usize) -> Self {
        let cells = report.rows.iter().map(|row| row.cells().iter().map(ToString::to_string).collect()).collect();
        let mut view = Self { report, is_part, language: None, cells, plots: Vec::new(), page };
        view.refresh();
        view.page = page.min(view.plots.len());
        view
    }

    /// Makes the figures again where the language of the window has changed.
    pub fn refresh(&mut self) {
        let language = i18n::current();
        if self.language == Some(language) {
            return;
        }
        self.language = Some(language);
        let figures = self.report.figures(&WindowWording);
        self.plots.resize_with(figures.len(), FigurePlot::default);
        for (plot, (_, figure)) in self.plots.iter_mut().zip(figures) {
            plot.refresh(language, |_| Some(figure));
        }
    }

    /// The figure that is in front.
    fn figure(&self) -> Option<&Figure> {
        // Of the table it is the first.
        self.plots.get(self.page.saturating_sub(1))?.figure()
    }
}

/// The reports of benchmarks, each kept until the benchmark runs again.
#[derive(Default)]
pub struct Benchmarks {
    pub error_vs_time: Option<BenchmarkView<ErrorVsTime>>,
    pub stability: Option<BenchmarkView<Stability>>,
    pub cost: Option<BenchmarkView<Cost>>,
}

impl Benchmarks {
    /// Shows a report in place of the one before; on the same page.
    pub fn take(&mut self, made: BenchmarkResult, is_part: bool) {
        fn again<R: BenchmarkRow>(slot: &mut Option<BenchmarkView<R>>, report: Report<R>, is_part: bool)
        where
            Report<R>: BenchmarkFigures,
        {
            let page = slot.as_ref().map_or(0, |before| before.page);
            *slot = Some(BenchmarkView::new(report, is_part, page));
        }
        match made {
            BenchmarkResult::ErrorVsTime(report) => again(&mut self.error_vs_time, report, is_part),
            BenchmarkResult::Stability(report) => again(&mut self.stability, report, is_part),
            BenchmarkResult::Cost(report) => again(&mut self.cost, report, is_part),
        }
    }

    /// The figure in front of a report that was made.
    pub fn figure(&self, subject: BenchmarkId) -> Option<&Figure> {
        match subject {
            BenchmarkId::ErrorVsTime => self.error_vs_time.as_ref()?.figure(),
            BenchmarkId::Stability => self.stability.as_ref()?.figure(),
            BenchmarkId::Cost => self.cost.as_ref()?.figure(),
        }
    }

    /// Puts the figures of a report into the language of the window.
    pub fn refresh_plots(&mut self, subject: BenchmarkId) {
        match subject {
            BenchmarkId::ErrorVsTime => self.error_vs_time.iter_mut().for_each(BenchmarkView::refresh),
            BenchmarkId::Stability => self.stability.iter_mut().for_each(BenchmarkView::refresh),
            BenchmarkId::Cost => self.cost.iter_mut().for_each(BenchmarkView::refresh),
        }
    }
}
