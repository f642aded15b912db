//! Joint space of more than three drives: the choice of the three drives along the axes, and the angles of the others.

use egui::{Align2, Area, Id, Order, Rect, RichText, vec2};

use super::theme::{bold, card, colour, plain};
use super::widgets::name;
use super::{Command, ViewChange, ViewState};
use stillbase_picture::scene::joints::{JointSpace, SYMBOLS};
use stillbase_picture::scene::views::{ViewKind, Views};
use stillbase_session::Session;

/// Returns the rectangle of a scene that the choice of axes covers, if it is shown.
pub fn covers(rect: Rect, views: &Views, view_state: &ViewState) -> Option<Rect> {
    chosen(views, view_state).map(|_| Rect::from_min_size(rect.min, vec2(rect.width().min(260.0), 56.0)))
}

/// Returns the joint space on display if its axes can be chosen.
fn chosen<'a>(views: &'a Views, view_state: &ViewState) -> Option<&'a JointSpace> {
    views.joints().filter(|joints| view_state.view == ViewKind::Joints && joints.has_choice())
}

/// Draws the choice of axes in the upper left corner of a scene. In the tower view, draws a message while the tower
/// is being computed.
pub fn show(
    ui: &egui::Ui,
    rect: Rect,
    session: &Session,
    views: &Views,
    view_state: &ViewState,
    commands: &mut Vec<Command>,
) {
    let p = view_state.palette();
    if view_state.view == ViewKind::Tower && views.tower().is_none() {
        let words = "The workspace is being outlined; its tower follows in a moment.";
        let at = rect.center_top() + vec2(0.0, 24.0);
        ui.painter().text(at, Align2::CENTER_TOP, words, plain(13.0), colour(p.ink));
    }
    let Some(joints) = chosen(views, view_state) else { return };
    let (shown, frame) = (joints.drives(), session.frame());
    let area = Area::new(Id::unique("drives with an axis")).order(Order::Middle).fixed_pos(rect.min + vec2(14.0, 12.0));
    area.show(ui.ctx(), |ui| {
        card(&p).inner_margin(8).show(ui, |ui| {
            ui.set_max_width((rect.width() - 44.0).max(120.0));
            ui.horizontal_wrapped(|ui| {
                ui.spacing_mut().item_spacing = vec2(4.0, 4.0);
                ui.label(RichText::new("axes").font(plain(11.5)).color(colour(p.dim)));
                for (k, symbol) in SYMBOLS.iter().enumerate().take(frame.q.len()) {
                    let on = shown.contains(&k);
                    let words = if on {
                        (*symbol).to_owned()
                    } else {
                        format!("{symbol} = {}", view_state.arrangement.notation.write(frame.relative(k), 3, "rad"))
                    };
                    let ink = if on { p.drive(k) } else { p.dim };
                    let words = RichText::new(words).font(bold(12.0)).color(colour(ink));
                    let button = egui::Button::new(words).selected(false).frame(on);
                    let tip = match on {
                        true => "This drive has an axis",
                        false => "This drive keeps its present angle; click to give it an axis, in place of the first",
                    };
                    let button = ui.add(button).on_hover_text(tip);
                    name(
                        &button,
                        &format!("{symbol} {}", if on { "has an axis" } else { "stands still: give it an axis" }),
                    );
                    if let (true, false, [_, second, third]) = (button.clicked(), on, shown) {
                        commands.push(ViewChange::Drives([*second, *third, k]).into());
                    }
                }
            });
        });
    });
}
