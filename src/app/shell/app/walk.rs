//! Sliders that move by themselves from a fit along the direction that its data determine least.

use crate::app::shell::app::App;
use crate::app::shell::app::fits::whole;
use crate::app::tasks::inquiry_work::FollowWeakest;
use crate::app::text::localized::Localized as _;
use crate::app::work::edit::Edit;
use crate::app::work::weakest_walk::WeakestWalk;
use pbrdf::fit::GeodesicWay;
use std::sync::Arc;
use tr::tr;

/// Time that the whole way takes, in seconds.
const DURATION: f64 = 8.0;

/// Looks for the way; sliders begin to move once it is found.
pub fn start_walk(app: &mut App, way: GeodesicWay) -> Result<(), String> {
    let Some(fit) = app.work.shown_fit().cloned() else { return Err(tr!("Fit first (F5).")) };
    app.jobs.fits.walking_since = None;
    let fit = whole(&app.work, &fit);
    let is_joint = fit.fit.joint.is_some();
    let numbers = if is_joint { fit.parts.iter().map(|part| part.number).collect() } else { vec![fit.fit.number] };
    app.jobs.fits.walk(FollowWeakest { fit, numbers, way })
}

/// The way is found: sliders go to its beginning, as one step of undo with all that follows.
pub fn walk_found(app: &mut App, walk: Arc<WeakestWalk>) {
    if app.work.shown_fit().is_none_or(|fit| fit.id != walk.fit) {
        return;
    }
    app.work.record_step();
    app.work.apply(Edit::UseFit);
    app.work.apply(Edit::SetWalk(walk));
    // The next frame begins the clock.
    app.jobs.fits.walking_since = Some(f64::NAN);
}

/// Moves the sliders on; tells whether they go on moving. A press of the mouse stops them.
pub fn walk_on(app: &mut App, ctx: &egui::Context) -> bool {
    let Some(mut since) = app.jobs.fits.walking_since else { return false };
    let now = ctx.input(|input| input.time);
    if since.is_nan() {
        since = now;
        app.jobs.fits.walking_since = Some(now);
    }
    let is_moved = app.work.moved_at() > 0 && since < now;
    if app.work.walk().is_none() || is_moved || ctx.input(|input| input.pointer.any_pressed()) {
        app.jobs.fits.walking_since = None;
        return false;
    }
    let share = ((now - since) / DURATION).min(1.0);
    app.work.apply(Edit::WalkTo(share));
    if share >= 1.0 {
        app.jobs.fits.walking_since = None;
        if let Some((walk, _)) = app.work.walk() {
            app.toasts.info(tr!("At its end: {}.", walk.geodesic.end.localized()));
        }
        return false;
    }
    ctx.request_repaint();
    true
}

/// Back to the fit.
pub fn cancel_walk(app: &mut App) {
    app.jobs.fits.walking_since = None;
    app.jobs.fits.walk.abandon();
    app.work.apply(Edit::WalkTo(0.0));
}
