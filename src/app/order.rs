//! Pointer events in the order in which they happened.
//!
//! egui reads the pointer once for each frame, at its last position. On a slow or remote display one frame may
//! contain a press, a drag, a release and later movements. A widget would then be released at the present position,
//! not at that of the release. So each frame gets at most one press or release, and no event after it.

use egui::{Context, Event, Plugin, RawInput, Ui, ViewportIdMap};

/// Plugin that keeps the events after a press or a release for the next frame of their window.
#[derive(Debug, Default)]
pub struct EventQueue {
    waiting: ViewportIdMap<Vec<Event>>,
}

impl Plugin for EventQueue {
    fn debug_name(&self) -> &'static str {
        "order of pointer events"
    }

    fn input_hook(&mut self, _: &Context, input: &mut RawInput) {
        let waiting = self.waiting.entry(input.viewport_id).or_default();
        waiting.append(&mut input.events);
        input.events = first_part(waiting);
    }

    fn on_end_pass(&mut self, ui: &mut Ui) {
        let window = ui.ctx().viewport_id();
        match self.waiting.get(&window) {
            Some(waiting) if !waiting.is_empty() => ui.ctx().request_repaint(),
            // A window that closes leaves nothing behind.
            _ => _ = self.waiting.remove(&window),
        }
    }
}

/// Removes and returns the events of this frame: those up to the first press or release, which is included except in
/// two cases. A press waits if a key comes before it: an Esc that closes something must not cancel the drag after it.
/// A release waits if a movement comes before it.
fn first_part(events: &mut Vec<Event>) -> Vec<Event> {
    let pressed_in = |event: &Event| match event {
        Event::PointerButton { pressed, .. } => Some(*pressed),
        _ => None,
    };
    let split = match events.iter().enumerate().find_map(|(i, event)| Some((i, pressed_in(event)?))) {
        None => events.len(),
        Some((at, true)) if events[..at].iter().any(|event| matches!(event, Event::Key { .. })) => at,
        Some((at, true)) => at + 1,
        // egui must notice a drag before it ends.
        Some((at, false)) if events[..at].iter().any(|event| matches!(event, Event::PointerMoved(_))) => at,
        Some((at, false)) => at + 1,
    };
    let rest = events.split_off(split);
    std::mem::replace(events, rest)
}
