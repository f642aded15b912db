//! The lamps: statements about machine, plan and run with their reasons; for machine and plan also improvements.

use std::sync::Arc;

use egui::{Popup, RectAlign, RichText, Sense, Ui, vec2};

use super::notation;
use super::theme::{bold, colour, plain};
use super::{Command, RefusedEdit, SessionCommand, ViewChange};
use stillbase_picture::charts::choice::PlotChange;
use stillbase_picture::scene::Rgba;
use stillbase_picture::scene::options::Handle;
use stillbase_picture::scene::palette::Palette;
use stillbase_picture::scene::views::ViewKind;
use stillbase_session::verdict::{Statement, Statements, StatusLight};
use stillbase_session::{Proposal, Session};

/// Width of the panel that a lamp opens, points.
const POPUP_WIDTH_PT: f32 = 320.0;

/// Returns the statements about machine, plan and the run so far.
pub fn statements(session: &Session) -> Statements {
    Statements::of(session.run(), session.frames().last().unwrap_or(session.frame()))
}

/// Draws a statement with its lamp: a disc if it is good, a triangle if it is bad, a ring if it is undecided.
pub fn show(ui: &mut Ui, named: (&str, &Statement), size: f32, p: &Palette) {
    paint(ui, named, size, Sense::hover(), p).on_hover_text(&named.1.why);
}

/// Draws a statement that opens its reason, what would improve it, and the place where it is decided.
pub fn button(
    ui: &mut Ui,
    named: (&str, &Statement),
    size: f32,
    improvements: &dyn Fn() -> Option<Arc<Vec<Proposal>>>,
    p: &Palette,
    commands: &mut Vec<Command>,
) {
    let (about, statement) = named;
    let response = paint(ui, named, size, Sense::click(), p).on_hover_text(&statement.why);
    let popup = Popup::menu(&response).align(RectAlign::TOP_START).gap(8.0).width(POPUP_WIDTH_PT);
    popup.show(|ui| {
        let title = format!("{about}: {}", statement.words);
        let (title, why) = (notation::sentence(ui.ctx(), &title), notation::sentence(ui.ctx(), &statement.why));
        ui.add(egui::Label::new(RichText::new(title).font(bold(13.0)).color(colour(p.ink))).wrap());
        ui.add(egui::Label::new(RichText::new(why).font(plain(12.0)).color(colour(p.dim))).wrap());
        // Improvements of plan and machine are searched for only while this panel is open.
        let asks = about != Statements::RUN && statement.outcome != StatusLight::Good;
        if let Some(improvements) = asks.then(improvements).flatten() {
            let is_here = |one: &&Proposal| one.is_of_machine() == (about == Statements::MACHINE);
            improvements.iter().filter(is_here).for_each(|one| proposal(ui, one, None, commands));
        }
        let (words, to) = place(about);
        if ui.button(words).clicked() {
            commands.push(to.into());
        }
    });
}

/// Returns the place where a statement is decided, in words, and the way there.
fn place(about: &str) -> (&'static str, ViewChange) {
    match about {
        Statements::MACHINE => ("show its masses and their balance", ViewChange::Kind(ViewKind::Design)),
        Statements::PLAN => ("show its points and its path", ViewChange::Reveal(Handle::Waypoint(0))),
        _ => ("plot the turning moment on the base", ViewChange::Charts(PlotChange::Plot("moment/total".into()))),
    }
}

/// Draws the button of a proposal. A click also does what was `refused`, if anything was.
pub fn proposal(ui: &mut Ui, proposal: &Proposal, refused: Option<&RefusedEdit>, commands: &mut Vec<Command>) {
    let text = notation::sentence(ui.ctx(), &proposal.text);
    let response = ui.button(text).on_hover_text(proposal.how());
    if response.clicked() {
        let own = || proposal.edits().into_iter().map(SessionCommand::Edit).collect();
        let done: Vec<SessionCommand> = refused.map_or_else(own, |refused| refused.commands_with(proposal));
        commands.extend(done.into_iter().chain([SessionCommand::EndGesture]).map(Command::Session));
    }
}

fn paint(ui: &mut Ui, (about, statement): (&str, &Statement), size: f32, sense: Sense, p: &Palette) -> egui::Response {
    let tone = tone_of(statement.outcome, p);
    let ink = if statement.outcome == StatusLight::Bad { tone } else { p.ink };
    // The words are painted instead of added as a widget, so that a screen reader announces lamp and words as one
    // item.
    let words = format!("{about}: {}", statement.words);
    let words = notation::sentence(ui.ctx(), &words).into_owned();
    let words = ui.painter().layout_no_wrap(words, plain(size), colour(ink));
    let [disc, gap] = [0.8 * size, 0.4 * size];
    let (rect, response) = ui.allocate_exact_size(vec2(disc + gap + words.size().x, words.size().y), sense);
    if response.hovered() && sense.senses_click() || response.has_focus() {
        ui.painter().rect_filled(rect.expand2(vec2(4.0, 3.0)), 4.0, colour(p.line));
    }
    let middle = rect.left_center() + vec2(0.5 * disc, 0.0);
    sign(ui.painter(), egui::Rect::from_center_size(middle, vec2(disc, disc)), statement.outcome, colour(tone));
    ui.painter().galley(rect.left_top() + vec2(disc + gap, 0.0), words, colour(ink));
    let spoken = format!("{about}: {}, {}", statement.words, statement.outcome.name());
    let role = if sense.senses_click() { egui::Role::Button } else { egui::Role::Image };
    response.widget_info(|| egui::WidgetInfo::labeled(role, true, &spoken));
    super::pointing::drawn(&response, &spoken);
    response
}

fn tone_of(outcome: StatusLight, p: &Palette) -> Rgba {
    match outcome {
        StatusLight::Good => p.zero,
        StatusLight::Bad => p.reaction,
        StatusLight::Open => p.dim,
    }
}

/// Draws a lamp whose shape shows the state without the colour.
fn sign(painter: &egui::Painter, rect: egui::Rect, outcome: StatusLight, tone: egui::Color32) {
    let (middle, r) = (rect.center(), 0.5 * rect.height());
    match outcome {
        StatusLight::Good => {
            painter.circle_filled(middle, 0.9 * r, tone);
        }
        StatusLight::Open => {
            painter.circle_stroke(middle, 0.75 * r, egui::Stroke::new(0.3 * r, tone));
        }
        StatusLight::Bad => {
            let corners = [vec2(0.0, -1.0), vec2(1.05, 0.85), vec2(-1.05, 0.85)].map(|at| middle + at * r);
            painter.add(egui::Shape::convex_polygon(corners.to_vec(), tone, egui::Stroke::NONE));
        }
    }
}
