//! Frame times, as eframe's `cpu_usage` measures them (logic and drawing without the swap of
//! buffers), and how many frames the maps on screen are behind the sliders, over the last five
//! seconds.
//!
//! With *View › Frame times* the status line shows them, and the program prints them when it ends.
//! Mesa's `GALLIUM_NOOP=1` under Xvfb leaves out the share of a software rasteriser: hold a slider,
//! move it for more than five seconds (`xdotool mousemove`), leave with Ctrl+Q.

use crate::app::platform::Instant;
use std::collections::VecDeque;
use std::time::Duration;
use tr::tr;

/// The frames of the last five seconds.
#[derive(Debug, Default)]
pub struct FrameTimes {
    frames: VecDeque<Frame>,
}

#[derive(Debug)]
struct Frame {
    at: Instant,
    /// Seconds.
    cpu_usage: f32,
    /// Age of the oldest map on screen, in frames.
    frames_behind: u64,
}

const WINDOW: Duration = Duration::from_secs(5);

impl FrameTimes {
    /// Adds a frame; `cpu_usage` in seconds.
    pub fn push(&mut self, cpu_usage: f32, frames_behind: u64) {
        self.frames.push_back(Frame { at: Instant::now(), cpu_usage, frames_behind });
        while self.frames.front().is_some_and(|frame| frame.at.elapsed() > WINDOW) {
            self.frames.pop_front();
        }
    }

    /// Median and 99th percentile of the times, their number, and the delay of maps.
    pub fn text(&self) -> String {
        let mut times: Vec<f32> = self.frames.iter().map(|frame| 1e3 * frame.cpu_usage).collect();
        times.sort_by(f32::total_cmp);
        let Some(last) = times.len().checked_sub(1) else { return tr!("no frames") };
        let (median, p99) = (times[last / 2], times[last * 99 / 100]);
        let mut behind: Vec<u64> = self.frames.iter().map(|frame| frame.frames_behind).collect();
        behind.sort_unstable();
        let times = tr!("frames: median {0} ms, p99 {1} ms of {2}", format!("{median:.2}"), format!("{p99:.2}"), times.len());
        match behind[last] {
            0 => times,
            worst => {
                let maps = tr!("maps behind: median {0}, p99 {1}, at most {2} frames", behind[last / 2], behind[last * 99 / 100], worst);
                format!("{times}; {maps}")
            }
        }
    }
}
