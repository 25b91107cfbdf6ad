//! Profiles and bootstrap of a fit: their JSON and their text.

use crate::cli::interrupt;
use pbrdf::fit::{Bootstrap, BootstrapEstimate, Course, Profile, StopReason, UnknownName};
use serde_json::{Map, Value, json};
use std::io::{self, Write};

/// Whether an interruption left a search or its intervals without their ends.
pub fn is_cut_short<T>(stop_reason: StopReason, course: &Course<T>) -> bool {
    stop_reason == StopReason::Cancelled || interrupt::asked() && course.intervals_complete == Some(false)
}

/// Says that a fit was cut short, where it was.
pub fn print_cut_short(out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "\nInterrupted: this is the best so far; intervals that were not followed to their ends are not known.")
}

/// Profiles and bootstrap beside the agreed keys.
pub fn add_scans<N: UnknownName>(json: &mut Value, profiles: &[Profile<N>], scatter: Option<&Bootstrap<N>>) {
    let Some(object) = json.as_object_mut() else { return };
    if !profiles.is_empty() {
        let of = |profile: &Profile<N>| {
            let Profile { points, interval68, interval95, is_complete, .. } = profile;
            let (low, high) = (interval68.low, interval68.high);
            let json = json!({ "low": low, "high": high, "interval95": interval95, "points": points, "complete": is_complete });
            (profile.parameter.key().into_owned(), json)
        };
        object.insert("profile".to_owned(), Value::Object(profiles.iter().map(of).collect::<Map<_, _>>()));
    }
    if let Some(scatter) = scatter {
        let of = |scatter: &BootstrapEstimate<N>| {
            (scatter.parameter.key().into_owned(), json!({ "std_error": scatter.std_error, "low": scatter.low, "high": scatter.high }))
        };
        let parameters = Value::Object(scatter.estimates.iter().map(of).collect::<Map<_, _>>());
        let mut bootstrap = json!({ "replicates": scatter.replicates, "parameters": parameters });
        if let Some(bootstrap) = bootstrap.as_object_mut().filter(|_| !scatter.is_complete()) {
            bootstrap.insert("complete".to_owned(), json!(false));
        }
        object.insert("bootstrap".to_owned(), bootstrap);
    }
}

/// The same for a person.
pub fn print_scans<N: UnknownName>(out: &mut dyn Write, profiles: &[Profile<N>], scatter: Option<&Bootstrap<N>>) -> io::Result<()> {
    for profile in profiles {
        let (open, note) = if profile.is_complete { ("open", "") } else { ("not known", " (interrupted)") };
        let end = |end: Option<f64>| end.map_or_else(|| open.to_owned(), |value| format!("{value:.6}"));
        writeln!(
            out,
            "\nprofile of {}: one-standard-error interval {} … {}{note}",
            profile.parameter.key(),
            end(profile.interval68.low),
            end(profile.interval68.high)
        )?;
        for point in &profile.points {
            writeln!(out, "  {:>14.8} sum of squares {:.6e}, ΔE {:.6e}", point.value, point.rss, point.objective)?;
        }
    }
    let Some(scatter) = scatter else { return Ok(()) };
    let (made, of) =
        (scatter.replicates, if scatter.is_complete() { String::new() } else { format!(" of {}: interrupted", scatter.asked) });
    writeln!(out, "\nbootstrap over {made} data sets{of}: standard deviation, 16th and 84th percentile")?;
    for scatter in &scatter.estimates {
        writeln!(out, "  {:<8} {:>12.3e} {:>14.8} {:>14.8}", scatter.parameter.key(), scatter.std_error, scatter.low, scatter.high)?;
    }
    Ok(())
}
