//! Pointer events in the order in which they happened.
//!
//! egui looks at the pointer once a frame, at its last position. On a slow or remote display one frame may bring a
//! press, a drag, a release and whatever the hand did afterwards; the widget would then be let go where the pointer is
//! now, not where the button came up. So a frame is given no more than one change of a button, and nothing after it.

use egui::{Context, Event, Plugin, RawInput, Ui};

/// Holds back what comes after a press or a release, for the next frame.
#[derive(Debug, Default)]
pub struct Order {
    waiting: Vec<Event>,
}

impl Plugin for Order {
    fn debug_name(&self) -> &'static str {
        "order of pointer events"
    }

    fn input_hook(&mut self, _: &Context, input: &mut RawInput) {
        self.waiting.append(&mut input.events);
        input.events = first_part(&mut self.waiting);
    }

    fn on_end_pass(&mut self, ui: &mut Ui) {
        if !self.waiting.is_empty() {
            ui.ctx().request_repaint();
        }
    }
}

/// Takes events off the front up to the first press, or up to before the first release; a release that comes first is
/// taken alone, and so are keys before a press: an Esc that closed something must not give up the drag after it.
fn first_part(events: &mut Vec<Event>) -> Vec<Event> {
    let turn = |event: &Event| match event {
        Event::PointerButton { pressed, .. } => Some(*pressed),
        _ => None,
    };
    let cut = match events.iter().enumerate().find_map(|(i, event)| Some((i, turn(event)?))) {
        None => events.len(),
        Some((at, true)) if events[..at].iter().any(|event| matches!(event, Event::Key { .. })) => at,
        Some((at, true)) => at + 1,
        // A drag has to be seen as one before it ends.
        Some((at, false)) if events[..at].iter().any(|event| matches!(event, Event::PointerMoved(_))) => at,
        Some((at, false)) => at + 1,
    };
    let rest = events.split_off(cut);
    std::mem::replace(events, rest)
}
