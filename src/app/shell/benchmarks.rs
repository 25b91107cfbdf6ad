//! The reports of the program about itself, made in the background one after the other, since each measures times, and kept until they are made again.

use crate::app::jobs::worker::{Job, Worker};
use crate::app::plots::FigurePlot;
use crate::app::text::i18n::{self, Language};
use crate::app::text::messages::WindowWording;
#[cfg(test)]
use crate::app::work::pane_id::PaneId;
use crate::export::{machine, now};
use crate::figure::Figure;
use crate::report::BenchmarkFigures;
use pbrdf::selftest::{Cost, ErrorVsTime, Host, Report, Row, Stability};

/// Which report.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BenchmarkId {
    ErrorVsTime,
    Stability,
    Cost,
}

impl BenchmarkId {
    #[cfg(test)]
    pub const ALL: [Self; 3] = [Self::ErrorVsTime, Self::Stability, Self::Cost];

    /// Where it is shown.
    #[cfg(test)]
    pub fn pane(self) -> PaneId {
        match self {
            Self::ErrorVsTime => PaneId::ErrorVsTime,
            Self::Stability => PaneId::Stability,
            Self::Cost => PaneId::Cost,
        }
    }

    /// Makes it; takes seconds to a minute.
    pub fn make(self, surroundings: Host<'_>) -> BenchmarkResult {
        match self {
            Self::ErrorVsTime => BenchmarkResult::ErrorVsTime(ErrorVsTime::run(machine(), now(), surroundings)),
            Self::Stability => BenchmarkResult::Stability(Stability::run(machine(), now(), surroundings)),
            Self::Cost => BenchmarkResult::Cost(Cost::run(machine(), now(), surroundings)),
        }
    }
}

/// A report of one kind or another.
pub enum BenchmarkResult {
    ErrorVsTime(Report<ErrorVsTime>),
    Stability(Report<Stability>),
    Cost(Report<Cost>),
}

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

impl<R: Row> BenchmarkView<R>
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

/// The reports that there are, and the one that is being made.
#[derive(Default)]
pub struct Benchmarks {
    pub running: Option<(BenchmarkId, Job<f64>)>,
    /// Those that come next.
    waiting: Vec<BenchmarkId>,
    pub error_vs_time: Option<BenchmarkView<ErrorVsTime>>,
    pub stability: Option<BenchmarkView<Stability>>,
    pub cost: Option<BenchmarkView<Cost>>,
}

impl Benchmarks {
    /// Begins one, or puts it behind the one that is being made: the two would disturb each other.
    pub fn start(&mut self, subject: BenchmarkId, worker: &mut Worker) -> Result<(), String> {
        if self.running.is_none() {
            self.running = Some((subject, worker.start_report(subject)?));
        } else if self.can_start(subject) {
            self.waiting.push(subject);
        }
        Ok(())
    }

    /// Begins the one that waits longest, once nothing is being made.
    pub fn go_on(&mut self, worker: &mut Worker) -> Result<(), String> {
        if self.running.is_some() || self.waiting.is_empty() {
            return Ok(());
        }
        let next = self.waiting.remove(0);
        self.start(next, worker)
    }

    /// Whether it is neither being made nor waiting.
    pub fn can_start(&self, subject: BenchmarkId) -> bool {
        !self.is_waiting(subject) && self.running.as_ref().is_none_or(|(running, _)| *running != subject)
    }

    /// Whether it comes after another one.
    pub fn is_waiting(&self, subject: BenchmarkId) -> bool {
        self.waiting.contains(&subject)
    }

    /// Takes it out of the row of those that wait.
    pub fn forget(&mut self, subject: BenchmarkId) {
        self.waiting.retain(|other| *other != subject);
    }

    /// Takes the report that was being made in the place of the one before.
    pub fn take(&mut self, made: BenchmarkResult, is_part: bool) {
        self.running = None;
        fn again<R: Row>(slot: &mut Option<BenchmarkView<R>>, report: Report<R>, is_part: bool)
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

    /// The one that was being made came to nothing.
    pub fn give_up(&mut self) {
        self.running = None;
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

    /// How far the one that is being made is.
    pub fn progress(&self) -> Option<(BenchmarkId, f64)> {
        self.running.as_ref().map(|(subject, job)| (*subject, job.progress().unwrap_or(0.0)))
    }
}
