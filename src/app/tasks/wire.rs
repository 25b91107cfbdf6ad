//! Between a worker and its page while the worker works.

use crate::app::tasks::fit_work::Watch;
use pbrdf::fit::TracePoint;

/// What a worker asks the page and tells it while it works.
pub struct Wire<'a> {
    pub is_cancelled: &'a (dyn Fn() -> bool + Sync),
    /// Takes what [`Message::progress`] reads.
    pub tell: &'a (dyn Fn(&str) + Sync),
}

impl Watch<TracePoint> for Wire<'_> {
    fn is_cancelled(&self) -> bool {
        (self.is_cancelled)()
    }

    fn report(&self, TracePoint { elapsed_ms, evaluations, objective }: TracePoint) {
        (self.tell)(&format!("[{},{evaluations},{}]", elapsed_ms.to_bits(), objective.to_bits()));
    }
}

impl Watch<&'static str> for Wire<'_> {
    fn is_cancelled(&self) -> bool {
        (self.is_cancelled)()
    }

    fn report(&self, progress: &'static str) {
        (self.tell)(progress);
    }
}

impl Watch<f64> for Wire<'_> {
    fn is_cancelled(&self) -> bool {
        (self.is_cancelled)()
    }

    fn report(&self, share: f64) {
        (self.tell)(&share.to_bits().to_string());
    }
}

impl Watch<()> for Wire<'_> {
    fn is_cancelled(&self) -> bool {
        (self.is_cancelled)()
    }

    fn report(&self, (): ()) {}
}
