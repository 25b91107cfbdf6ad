//! What a window does first, done once for nobody to see.
//!
//! Browsers translate a function of the program when it is first called, and the thread that calls it waits: eight hundred in the frame
//! that begins a fit. What a worker has translated, the page has too.

use crate::app::platform::Instant;
use crate::app::shell::app::App;
use crate::app::shell::app::fits::{fitted, intervals_found, problem_of, whole};
use crate::app::shell::app::logic::logic;
use crate::app::shell::app::open::begin;
use crate::app::shell::app::ui::ui;
use crate::app::storage::session::Session;
use crate::app::storage::settings_file::SettingsFile;
use crate::app::tasks::answer::answer;
use crate::app::tasks::fit_work::{FindIntervals, FitOneByOne, Search};
use crate::app::tasks::messages::Message;
use crate::app::tasks::wire::Wire;
use crate::app::views::action::{Action, WindowAction};
use crate::files::packed::pack;
use egui::{Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, PointerButton, Pos2, RawInput, Rect, TouchPhase, Vec2};
use pbrdf::fit::Starts;

/// Sizes in points of a laptop and of a phone.
const SIZES: [Vec2; 2] = [Vec2::new(1366.0, 768.0), Vec2::new(844.0, 390.0)];

/// A window without a screen.
struct Rehearsal {
    ctx: egui::Context,
    app: App,
    size: Vec2,
    begun: Instant,
}

/// Plays the first minutes with a window; whether a fit got its intervals.
pub fn rehearse() -> bool {
    let ctx = egui::Context::default();
    let mut app = App::new(&ctx, SettingsFile::default());
    begin(&mut app);
    let mut rehearsal = Rehearsal { ctx, app, size: SIZES[0], begun: Instant::now() };
    rehearsal.frame(Vec::new());
    let is_fitted = rehearsal.fit().is_some();
    // There is no other worker that would do it.
    rehearsal.press(Key::F5, Modifiers::NONE);
    rehearsal.keep();
    rehearsal.touch_all();
    rehearsal.press(Key::Z, Modifiers::COMMAND);
    rehearsal.look_around();
    is_fitted
}

impl Rehearsal {
    fn frame(&mut self, events: Vec<Event>) {
        let Self { ctx, app, size, begun } = self;
        app.dialogs.room.may_be_small = true;
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, *size)),
            time: Some(begun.elapsed().as_secs_f64()),
            focused: true,
            events,
            ..RawInput::default()
        };
        let mut output = ctx.run_ui(input, |screen| {
            logic(app, &screen.ctx().clone());
            ui(app, screen);
        });
        // Nobody paints it.
        output.textures_delta.clear();
        ctx.tessellate(output.shapes, output.pixels_per_point);
    }

    fn order(&mut self, action: Action) {
        self.app.actions.push(action);
        // What comes to the screen may want a second one.
        self.frame(Vec::new());
        self.frame(Vec::new());
    }

    fn press(&mut self, key: Key, modifiers: Modifiers) {
        let event = |pressed| Event::Key { key, physical_key: None, pressed, repeat: false, modifiers };
        self.frame(vec![event(true)]);
        self.frame(vec![event(false)]);
    }

    /// Fits as a page does: by messages, whose other side is this worker.
    fn fit(&mut self) -> Option<()> {
        let wire = Wire { is_cancelled: &|| false, tell: &|_| {} };
        let active = self.app.work.active().clone();
        let problem = problem_of(&self.app, &active).ok()?;
        let search = Search { starts: Starts::One, seed: 0 };
        let job = FitOneByOne { about: vec![(problem, active)], search, intervals: false };
        let reply = answer(&job.request()?, &wire)?;
        fitted(&mut self.app, job.receive(&reply)?);
        self.frame(Vec::new());
        let job = FindIntervals(whole(&self.app.work, self.app.work.shown_fit()?));
        let reply = answer(&job.request()?, &wire)?;
        intervals_found(&mut self.app, job.receive(&reply)?);
        self.frame(Vec::new());
        self.app.work.shown_fit()?.report.course.intervals_complete.map(drop)
    }

    /// Writes the work as it is kept.
    fn keep(&self) {
        if let Ok(text) = Session::of(&self.app.work).to_json() {
            pack(text.as_bytes());
        }
    }

    /// Moves the pointer over everything, and in the middle moves and zooms a plot.
    fn touch_all(&mut self) {
        const STEP: f32 = 96.0;
        let middle = (0.5 * self.size).to_pos2();
        let mut y = 0.5 * STEP;
        while y < self.size.y {
            let mut x = 0.5 * STEP;
            while x < self.size.x {
                self.frame(vec![Event::PointerMoved(Pos2::new(x, y))]);
                x += 2.0 * STEP;
            }
            y += STEP;
        }
        let button = |pressed| Event::PointerButton { pos: middle, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE };
        self.frame(vec![Event::PointerMoved(middle)]);
        self.frame(vec![button(true)]);
        self.frame(vec![Event::PointerMoved(middle + Vec2::new(40.0, 10.0))]);
        self.frame(vec![button(false)]);
        self.frame(vec![Event::MouseWheel {
            unit: MouseWheelUnit::Point,
            delta: Vec2::new(0.0, 40.0),
            phase: TouchPhase::Move,
            source: MouseWheelSource::Unknown,
            modifiers: Modifiers::COMMAND,
        }]);
    }

    /// Opens the menus, the palette, a lesson and the panes of the first arrangement, and the same window small.
    fn look_around(&mut self) {
        for letter in [Key::F, Key::V, Key::L] {
            self.press(letter, Modifiers::ALT);
            self.press(Key::Escape, Modifiers::NONE);
        }
        self.order(Action::Window(WindowAction::OpenPalette));
        self.frame(vec![Event::Text("fit".to_owned())]);
        self.app.dialogs.palette.is_open = false;
        for pane in self.app.dock.open() {
            self.order(Action::Window(WindowAction::ShowPane(pane)));
        }
        self.order(Action::ShowStep(0, 0));
        self.size = SIZES[1];
        self.frame(Vec::new());
        self.frame(Vec::new());
    }
}
