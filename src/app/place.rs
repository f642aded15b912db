//! The rows of scene objects in the panel of settings. A click on an object opens, scrolls to and marks its rows for a
//! moment. With the pointer or keyboard focus on its rows, the object lights up in the scene.

use egui::{Align, Context, Id, Rect, Shape, Ui};

use super::theme::colour;
use stillbase_picture::scene::options::Handle;
use stillbase_picture::scene::palette::{Palette, faded};
use stillbase_session::Session;

/// Duration of the mark on an object's rows, s.
const MARK_DURATION_S: f64 = 1.6;

/// State shared by the rows of all objects in a pass.
#[derive(Clone, Copy, Default)]
struct Places {
    /// The object whose rows are marked, and the time at which the mark ends, s; no time until the rows are drawn.
    marked: Option<(Handle, Option<f64>)>,
    /// The object whose rows are under the pointer or have the keyboard focus, or that a panel mentions.
    panel_object: Option<Handle>,
}

fn id() -> Id {
    Id::unique("places")
}

/// Key under which egui stores whether a section is unfolded.
pub fn fold_id(title: &str) -> Id {
    Id::unique(("fold", title))
}

/// Key under which egui stores the chosen link or length of a list of differences.
pub fn chosen_id(what: &str) -> Id {
    Id::unique(("differs", what))
}

/// Name of the list of links that differ from the model.
pub const LINK_LIST: &str = "a link differs";

/// Whether an object has rows in the panel.
pub fn is_in_panel(thing: Handle) -> bool {
    use Handle::{Base, Boundary, Joint, Limit, Link, Payload, Ring, Target, Waypoint};
    matches!(thing, Target | Link(_) | Joint(_) | Limit(..) | Base | Payload | Waypoint(_) | Ring | Boundary)
}

/// Returns the object whose rows are shown for this one.
fn standing_for(thing: Handle) -> Handle {
    match thing {
        Handle::Boundary => Handle::Ring,
        Handle::Joint(_) | Handle::Limit(..) => Handle::Joint(0),
        thing => thing,
    }
}

/// Opens the rows of an object; they are scrolled to and marked when they are drawn next.
pub fn open(ctx: &Context, thing: Handle, session: &Session) {
    let thing = standing_for(thing);
    ctx.data_mut(|data| {
        let section = match thing {
            Handle::Link(_) | Handle::Payload => Some("Plant"),
            Handle::Base => Some("Base"),
            _ => None,
        };
        if let Some(title) = section {
            data.insert_temp(fold_id(title), true);
        }
        if let Handle::Link(i) = thing
            && let Some(link) = session.scenario().machine.links().get(i)
        {
            data.insert_temp(chosen_id(LINK_LIST), link.name.clone());
        }
        data.insert_temp(id(), Places { marked: Some((thing, None)), panel_object: None });
    });
}

/// Removes and returns the object whose rows are under the pointer or have the focus, or that a panel mentions. To be
/// called after all rows have been drawn.
pub fn lit(ctx: &Context) -> Option<Handle> {
    ctx.data_mut(|data| data.get_temp_mut_or_default::<Places>(id()).panel_object.take())
}

/// Key under which egui stores the links to light up, until the end of the pass.
fn links_id() -> Id {
    Id::unique("links that are spoken of")
}

/// Lights up links that a panel mentions.
pub fn highlight_links(ctx: &Context, links: Vec<usize>) {
    ctx.data_mut(|data| data.insert_temp(links_id(), links));
}

/// Removes and returns the links that the panels mention; to be called after all panels have been drawn.
pub fn lit_links(ctx: &Context) -> Vec<usize> {
    ctx.data_mut(|data| data.remove_temp::<Vec<usize>>(links_id())).unwrap_or_default()
}

/// Lights up an object that a panel mentions.
pub fn highlight(ctx: &Context, thing: Handle) {
    ctx.data_mut(|data| data.get_temp_mut_or_default::<Places>(id()).panel_object = Some(thing));
}

/// Draws the rows of an object.
pub fn place_of_thing<R>(ui: &mut Ui, thing: Handle, p: &Palette, add: impl FnOnce(&mut Ui) -> R) -> R {
    let behind = ui.painter().add(Shape::Noop);
    let shown = ui.scope(add);
    let rect = shown.response.rect;
    let focused = ui.memory(egui::Memory::focused).and_then(|id| ui.ctx().read_response(id));
    // The limits of all joints share one set of rows, so these rows light up no joint.
    let alone = !matches!(thing, Handle::Joint(_));
    let over = ui.rect_contains_pointer(rect) || focused.is_some_and(|r| r.has_focus() && rect.contains_rect(r.rect));
    if alone && over {
        ui.data_mut(|data| data.get_temp_mut_or_default::<Places>(id()).panel_object = Some(thing));
    }
    let marked = ui.data(|data| data.get_temp::<Places>(id())).and_then(|places| places.marked);
    if let Some((_, until)) = marked.filter(|(of, _)| *of == thing) {
        mark(ui, rect, behind, thing, until, p);
    }
    shown.inner
}

fn mark(ui: &Ui, rect: Rect, behind: egui::layers::ShapeIdx, thing: Handle, until: Option<f64>, p: &Palette) {
    let now = ui.input(|i| i.time);
    let until = until.unwrap_or_else(|| {
        ui.scroll_to_rect(rect, Some(Align::Center));
        now + MARK_DURATION_S
    });
    let marked = (now < until).then_some((thing, Some(until)));
    ui.data_mut(|data| data.get_temp_mut_or_default::<Places>(id()).marked = marked);
    if marked.is_some() {
        let fill = colour(faded(p.amber, 0.22));
        ui.painter().set(behind, Shape::rect_filled(rect.expand2(egui::vec2(6.0, 3.0)), 5.0, fill));
        ui.ctx().request_repaint_after_secs((until - now) as f32);
    }
}
