//! The keyboard's focus: a field is asked for by its name, and panels scroll to what has the focus.

use egui::{Context, Id, Response, Ui, vec2};

/// Key under which egui stores the name of the field that is asked for.
fn asked_id() -> Id {
    Id::unique("field asked for")
}

/// Gives the focus to the field of this name for screen readers when it is drawn next.
pub fn ask(ctx: &Context, name: &str) {
    ctx.data_mut(|data| data.insert_temp(asked_id(), name.to_owned()));
    ctx.request_repaint();
}

/// Returns whether the field of this name was asked for; then it is asked for no more.
pub fn is_asked(ctx: &Context, name: &str) -> bool {
    ctx.data_mut(|data| {
        let is_this = data.get_temp::<String>(asked_id()).is_some_and(|asked| asked == name);
        if is_this {
            data.remove_temp::<String>(asked_id());
        }
        is_this
    })
}

/// Key under which egui stores the name of the widget that has the focus, of those that say so.
fn named_id() -> Id {
    Id::unique("name of the focus")
}

/// Says by which name the widget of a response is known while it has the focus.
pub fn tell(response: &Response, name: &str) {
    if response.has_focus() {
        response.ctx.data_mut(|data| data.insert_temp(named_id(), (response.id, name.to_owned())));
    }
}

/// Returns whether the widget of this name has the focus.
pub fn is_on(ctx: &Context, name: &str) -> bool {
    let known = ctx.data(|data| data.get_temp::<(Id, String)>(named_id()));
    known.is_some_and(|(id, known)| known == name && ctx.memory(|memory| memory.has_focus(id)))
}

/// Room that is shown above and below what has the focus, where the content fades out, points.
const AROUND_PT: f32 = 24.0;

/// The widget that had the focus, and its distance from the top of the content of its scroll area, points.
#[derive(Clone, Copy, PartialEq)]
struct Seen {
    widget: Id,
    depth: f32,
}

/// Scrolls to the widget that has the focus, if it has just got it or has moved within the content. Belongs at the end
/// of the content of every scroll area with fields or buttons. The pointer scrolls nothing: what it presses is in view.
pub fn keep_in_view(ui: &Ui) {
    let id = ui.scope_id().with("focus seen");
    let focused = ui.memory(egui::Memory::focused).and_then(|focused| ui.ctx().read_response(focused));
    let content = ui.min_rect();
    let own = focused.filter(|own| own.layer_id == ui.layer_id() && content.contains(own.rect.center()));
    let seen = own.as_ref().map(|own| Seen { widget: own.id, depth: (own.rect.top() - content.top()).round() });
    let last = ui.data_mut(|data| {
        let last = data.get_temp::<Option<Seen>>(id).flatten();
        data.insert_temp(id, seen);
        last
    });
    let is_pressed = ui.input(|i| i.pointer.any_down() || i.pointer.any_released());
    if let Some(own) = own.filter(|_| seen != last && !is_pressed) {
        ui.scroll_to_rect(own.rect.expand2(vec2(0.0, AROUND_PT)), None);
    }
}
