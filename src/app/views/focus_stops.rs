//! Where F6 leads: to the menus, into each panel, and to the name of each pane on screen.

use egui::{Context, Id, Key, Modifiers};

/// In the order in which they were drawn, and where F6 led last.
#[derive(Clone, Default)]
struct Stops {
    drawn: Vec<Id>,
    last: usize,
}

fn place() -> Id {
    Id::unique("stops of F6")
}

/// Notes a control that F6 leads to.
pub fn note_stop(ctx: &Context, control: Id) {
    ctx.data_mut(|data| data.get_temp_mut_or_default::<Stops>(place()).drawn.push(control));
}

/// Goes on to the next of them, or with Shift to the one before, if that was asked for; call it when all are drawn.
pub fn follow_f6(ctx: &Context) {
    let Stops { drawn, last } = ctx.data_mut(|data| {
        let stops = data.get_temp_mut_or_default::<Stops>(place());
        Stops { drawn: std::mem::take(&mut stops.drawn), last: stops.last }
    });
    let back = ctx.input_mut(|input| input.consume_key(Modifiers::SHIFT, Key::F6));
    let forth = ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::F6));
    if drawn.is_empty() || !(back || forth) {
        return;
    }
    let here = ctx.memory(egui::Memory::focused).and_then(|focused| drawn.iter().position(|stop| *stop == focused));
    let here = here.unwrap_or(last);
    let next = (here + if back { drawn.len() - 1 } else { 1 }) % drawn.len();
    ctx.memory_mut(|memory| memory.request_focus(drawn[next]));
    ctx.data_mut(|data| data.get_temp_mut_or_default::<Stops>(place()).last = next);
}
