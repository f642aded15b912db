//! The status line at the bottom: the verdict, and a hint on what to do next.

pub mod news;

use std::sync::Arc;

use egui::{Align, Layout, Margin, Panel, RichText, Sense, Ui, vec2};

use super::facts::ScenarioFacts;
use super::notation;
use super::theme::{colour, plain};
use super::widgets::name;
use super::{Activity, Command, Message, SessionCommand, Tool, ViewState, WindowCommand};
use super::{fit, lamp};
use stillbase_picture::numbers::signed;
use stillbase_picture::scene::palette::{Palette, faded};
use stillbase_planning::pose_space::NoPoseSpace;
use stillbase_session::verdict::{StatusLight, Verdict};
use stillbase_session::{Proposal, Session};
use stillbase_simulation::frame::{Frame, Reach};

/// Draws a dot for each figure of the audit: small within its limit, large and red beyond it.
fn audit_dots(ui: &mut Ui, frame: &Frame, p: &Palette) {
    ui.add_space(4.0);
    ui.spacing_mut().item_spacing.x = 1.0;
    for figure in frame.audit.figures(&frame.peaks, &frame.totals) {
        let good = figure.is_within_tolerance();
        let (dot, response) = ui.allocate_exact_size(vec2(12.0, 18.0), Sense::hover());
        let tone = colour(if good { faded(p.zero, 0.75) } else { p.reaction });
        ui.painter().circle_filled(dot.center(), if good { 2.8 } else { 4.2 }, tone);
        let word = if good { "good" } else { "too large" };
        let words = format!("audit {}: {} {}, {word}", figure.name, power(figure.value), figure.unit);
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, &words));
        let limit = match figure.limit {
            Some(limit) => format!("should be at most {} {}", power(limit), figure.unit),
            None => "tells how well the plane is held; no limit".into(),
        };
        response.on_hover_text(format!(
            "{}: {}\n{} {}, {limit}",
            figure.name,
            figure.meaning,
            power(figure.value),
            figure.unit
        ));
    }
    ui.spacing_mut().item_spacing.x = 8.0;
    ui.add_space(4.0);
}

/// Returns a number with two digits and its power of ten.
fn power(x: f64) -> String {
    if x == 0.0 { "0".into() } else { format!("{x:.1e}").replace("e-", "e−") }
}

/// What stands between the pieces of a text.
const PIECES: &str = "  ·  ";
/// Width of the dots of the audit, points.
const DOTS_WIDTH_PT: f32 = 120.0;

/// Joins as many of the pieces, the most important first, as have room whole.
fn fitting<'a>(ui: &Ui, pieces: impl Iterator<Item = &'a str>, room: f32) -> String {
    let mut text = String::new();
    for piece in pieces {
        let longer = if text.is_empty() { piece.to_owned() } else { format!("{text}{PIECES}{piece}") };
        if fit::width_of(ui, &longer, &plain(12.0)) > room {
            break;
        }
        text = longer;
    }
    text
}

/// Draws this panel.
pub fn show(
    ui: &mut Ui,
    session: &Session,
    found: &ScenarioFacts<'_>,
    improvements: &dyn Fn() -> Option<Arc<Vec<Proposal>>>,
    view_state: &ViewState,
    under_way: Option<(Activity, f64)>,
    commands: &mut Vec<Command>,
) {
    let p = view_state.palette();
    let frame = egui::Frame::new().inner_margin(Margin::symmetric(16, 0));
    Panel::bottom("status").exact_size(30.0).resizable(false).frame(frame).show(ui, |ui| {
        ui.horizontal_centered(|ui| {
            let f = session.frame();
            ui.spacing_mut().item_spacing.x = 14.0;
            let mut statements = lamp::statements(session);
            // Beside the message of a refusal, a good plan is that of the task before.
            let is_refused = view_state.status.refused.as_ref().is_some_and(|refused| refused.refused.is_some());
            if is_refused && statements.plan.outcome == StatusLight::Good {
                statements.plan.outcome = StatusLight::Open;
                statements.plan.words.insert_str(0, "as before, ");
            }
            let unfinished = session.run().unfinished();
            for named in statements.named() {
                match unfinished {
                    Some(_) => lamp::show(ui, named, 12.5, &p),
                    None => lamp::button(ui, named, 12.5, improvements, &p, commands),
                }
            }
            if unfinished.is_none() && ui.available_width() > DOTS_WIDTH_PT {
                audit_dots(ui, f, &p);
            }
            let mut facts: Vec<String> = Vec::new();
            // Nothing is said of the machine before a drawing.
            let remarks = unfinished.map_or_else(|| Verdict::of(session.scenario(), f).so_far(), |_| Vec::new());
            facts.extend(remarks.iter().filter(|_| ui.available_width() > 460.0).map(|remark| remark.short.clone()));
            if unfinished.is_none() && session.run().pose_space().is_ok() {
                facts.push(format!("b {:.3} rad", f.b));
            }
            let bad_news = view_state.status.problem().is_some();
            if let Some((poses, distance)) =
                found.standing.filter(|_| unfinished.is_none() && !bad_news && ui.available_width() > 460.0)
            {
                let many = if poses == 1 { "one pose".into() } else { format!("{poses} poses") };
                // A narrow window keeps the space for the hint.
                facts.push(match ui.available_width() > 900.0 {
                    true => format!("{many}, {} m from the boundary", signed(distance.abs(), 3)),
                    false => many,
                });
            }
            if let Some(drawing) = unfinished {
                fit::label(ui, &notation::sentence(ui.ctx(), &drawing.first_of()), plain(12.0), colour(p.dim));
            }
            let facts: Vec<_> = facts.iter().map(|fact| notation::sentence(ui.ctx(), fact)).collect();
            let facts = fitting(ui, facts.iter().map(|fact| &**fact), ui.available_width());
            let label = ui.label(RichText::new(facts).font(plain(12.0)).color(colour(p.dim)));
            if !remarks.is_empty() {
                let long: Vec<&str> = remarks.iter().map(|r| r.long.as_str()).collect();
                label.on_hover_text(long.join("\n"));
            }
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                if let Some((activity, done)) = under_way.filter(|_| !bad_news) {
                    if activity.can_stop() {
                        let stop = ui.button("Cancel").on_hover_text("Stops it; what is shown stays as it is");
                        name(&stop, &format!("Cancel {}", activity.words()));
                        if stop.clicked() {
                            commands.push(WindowCommand::Cancel(activity).into());
                        }
                    }
                    let text = format!("{}, {:.0} %", activity.words(), 100.0 * done);
                    fit::label(ui, &text, plain(12.0), colour(p.dim));
                    return;
                }
                let (text, tone) = match (&view_state.status.message, f.target.reach) {
                    (Some(Message { is_problem: true, .. }), _) => (String::new(), p.reaction),
                    (Some(Message { text, .. }), _) => {
                        let newest = session.branch_count().checked_sub(1).filter(|_| view_state.status.left_branch);
                        if let Some(branch) = newest {
                            let back = ui.button("show it").on_hover_text("Shows the branch; G leads there and back");
                            name(&back, "Show the branch");
                            if back.clicked() {
                                commands.push(SessionCommand::Branch(branch).into());
                            }
                        }
                        (text.clone(), p.ink)
                    }
                    (None, _) if session.is_full() => {
                        ("this session is full: save or record it, then start over".into(), p.reaction)
                    }
                    (None, _) if unfinished.is_some() => {
                        let words = match view_state.drawing_pen() {
                            Some(_) => "the list on the left mends what is missing  ·  F1 keys",
                            None => "Shift D draws on  ·  F1 keys",
                        };
                        (words.into(), p.dim)
                    }
                    (None, Reach::Outside { feasible_b, other_sheet, .. }) => {
                        for way_out in found.target_proposals.iter().rev() {
                            lamp::proposal(ui, way_out, None, commands);
                        }
                        let why = match (feasible_b, other_sheet) {
                            (Some(_), _) => "the target is outside",
                            (None, true) => "the target is beyond a fold or a change point",
                            (None, false) => "no b reaches the target",
                        };
                        (why.into(), p.ink)
                    }
                    (None, Reach::Stopped { why, .. }) => {
                        (format!("at zero momentum the end effector stops here: {why}"), p.ink)
                    }
                    (None, _) if matches!(view_state.tool, Tool::Draw(_)) => {
                        ("draw with the pointer  ·  Esc stops drawing".into(), p.ink)
                    }
                    (None, _) if let Tool::Measure(points) = &view_state.tool => {
                        let words = match points.len() {
                            0 => "click two points: their distance  ·  Esc stops measuring",
                            1 => "click the second point  ·  Esc stops measuring",
                            _ => "click a third point: the angle at the second  ·  Enter keeps the distance alone",
                        };
                        (words.into(), p.ink)
                    }
                    (None, _) if view_state.tool == Tool::Push => {
                        ("drag the end effector to push it, 20 N for each metre  ·  U lets go".into(), p.ink)
                    }
                    (None, _) if session.run().waiting().is_some() => {
                        ("the run waits: change points, limits or b  ·  F1 keys".into(), p.ink)
                    }
                    (None, _) if session.is_dragged() => {
                        ("led by hand  ·  key B: back to the path  ·  F1 keys".into(), p.dim)
                    }
                    (None, _) if view_state.view.shows_machine() && session.run().pose_space().is_ok() => {
                        ("drag the target, a point or the b ring  ·  Space plays  ·  F1 keys".into(), p.dim)
                    }
                    (None, _) if view_state.view.shows_machine() && session.can_be_dragged() => {
                        ("drag the target or a point: the arm follows at zero momentum  ·  F1 keys".into(), p.dim)
                    }
                    (None, _) if matches!(session.run().pose_space(), Err(NoPoseSpace::Free)) => {
                        ("any path is reactionless: drag A, B, or draw one (P)  ·  F1 keys".into(), p.dim)
                    }
                    (None, _) => ("Space plays  ·  F1 keys".into(), p.dim),
                };
                let text = notation::sentence(ui.ctx(), &text);
                // A hint loses whole pieces from its end; a sentence alone is shortened.
                let shown = fitting(ui, text.split(PIECES), ui.available_width());
                if shown.is_empty() {
                    fit::label(ui, &text, plain(12.0), colour(tone));
                    return;
                }
                let label = ui.label(RichText::new(&shown).font(plain(12.0)).color(colour(tone)));
                if shown != text {
                    fit::say(&label, &text);
                    label.on_hover_text(text.as_ref());
                }
            });
        });
    });
}
