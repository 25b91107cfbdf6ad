//! How long frames take: eframe's `cpu_usage` (drawing and logic, without the swap of buffers) over the last five seconds.
//!
//! The status line tells them, and the program on its way out, where *Frame times* is on in the *View* menu. To measure the window
//! rather than a software rasteriser, whose share `cpu_usage` includes: start it under Xvfb with Mesa's `GALLIUM_NOOP=1`, which draws
//! nothing, hold a slider down, move it for more than five seconds (`xdotool mousemove`), and leave with Ctrl+Q.

use std::collections::VecDeque;
use std::time::{Duration, Instant};
use tr::tr;

/// The frames of the last five seconds.
#[derive(Debug, Default)]
pub struct FrameTimes {
    frames: VecDeque<(Instant, f32)>,
}

const WINDOW: Duration = Duration::from_secs(5);

impl FrameTimes {
    /// Takes down one frame, in seconds.
    pub fn push(&mut self, cpu_usage: f32) {
        self.frames.push_back((Instant::now(), cpu_usage));
        while self.frames.front().is_some_and(|(at, _)| at.elapsed() > WINDOW) {
            self.frames.pop_front();
        }
    }

    /// Median, 99th percentile and number.
    pub fn text(&self) -> String {
        let mut times: Vec<f32> = self.frames.iter().map(|(_, time)| 1e3 * time).collect();
        times.sort_by(f32::total_cmp);
        let Some(last) = times.len().checked_sub(1) else { return tr!("no frames") };
        let (median, p99) = (times[last / 2], times[last * 99 / 100]);
        tr!("frames: median {0} ms, p99 {1} ms of {2}", format!("{median:.2}"), format!("{p99:.2}"), times.len())
    }
}
