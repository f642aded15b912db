//! The main results in large type over the scene, in the layout *Present*.

use egui::{Align, Layout, Rect, RichText, Ui, UiBuilder, pos2, vec2};

use super::icon::{Icon, IconButton};
use super::theme::{bold, colour, plain};
use super::{Command, Layout as WindowLayout, ViewChange, ViewState, lamp};
use stillbase_picture::numbers::signed;
use stillbase_session::Session;

/// Smaller moments are shown as zero, N m.
const ZERO_BELOW_N_M: f64 = 0.005;

/// Returns the height of the largest digits in a scene, points.
pub fn size(rect: Rect) -> f32 {
    (0.075 * rect.height()).min(rect.width() / 7.5).clamp(30.0, 110.0)
}

/// Returns the rectangle of a scene that the results cover.
pub fn covers(rect: Rect) -> Rect {
    Rect::from_min_size(rect.min, vec2(6.6 * size(rect), 4.6 * size(rect)))
}

/// Draws the results; returns the rectangles that they cover.
pub fn show(
    ui: &mut Ui,
    rect: Rect,
    session: &Session,
    view_state: &ViewState,
    commands: &mut Vec<Command>,
) -> [Rect; 2] {
    let (p, f, large) = (view_state.palette(), session.frame(), size(rect));
    let corner = covers(rect).shrink(0.4 * large);
    let mut corner = ui.new_child(UiBuilder::new().max_rect(corner).layout(Layout::top_down(Align::Min)));
    corner.spacing_mut().item_spacing.y = 0.08 * large;
    let (scenario, notation) = (session.scenario(), view_state.arrangement.notation);
    let title = if scenario.title.is_empty() { &scenario.name } else { &scenario.title };
    let line = |ui: &mut Ui, text: RichText| ui.add(egui::Label::new(text).extend());
    line(&mut corner, RichText::new(title).font(bold(0.4 * large)).color(colour(p.ink)));
    let moment = f.wrench.total().moment;
    let (number, tone) = match moment.abs() < ZERO_BELOW_N_M {
        true => (signed(0.0, 2), p.zero),
        false => (signed(moment, 2), p.reaction),
    };
    let number = format!("{number} N m");
    line(&mut corner, RichText::new(number).font(bold(large)).color(colour(tone)));
    line(
        &mut corner,
        RichText::new(notation.name("turning moment on the base", "n_B"))
            .font(plain(0.32 * large))
            .color(colour(p.dim)),
    );
    for named in lamp::statements(session).named() {
        lamp::show(&mut corner, named, 0.32 * large, &p);
    }
    let b = session.run().pose_space().ok().map(|_| f.b);
    let b = b.map_or_else(String::new, |b| format!("b = {}   ·   ", notation.write(b, 3, "rad")));
    let now = format!("{b}{:.2} s of {:.2} s", f.time, session.length());
    line(&mut corner, RichText::new(now).font(plain(0.32 * large)).color(colour(p.dim)));
    // A progress bar of the run along the lower edge.
    let share = (f.time / session.length().max(1e-9)).clamp(0.0, 1.0) as f32;
    let low = rect.bottom() - 4.0;
    let done = Rect::from_min_max(pos2(rect.left(), low), pos2(rect.left() + share * rect.width(), rect.bottom()));
    ui.painter().rect_filled(done, 0.0, colour(p.amber));
    let at = Rect::from_min_size(rect.right_top() + vec2(-52.0, 16.0), vec2(36.0, 32.0));
    let mut right = ui.new_child(UiBuilder::new().max_rect(at));
    let tip = "Back to Explore (Esc or 5); Space plays";
    let back = IconButton { size: at.size(), ..IconButton::of(Icon::Panes, "Leave the presentation", tip) };
    if back.show_in(&mut right, &p, colour(p.dim)).clicked() {
        commands.push(ViewChange::Layout(WindowLayout::Explore).into());
    }
    [corner.min_rect(), at]
}
