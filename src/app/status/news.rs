//! The problem message over the lower edge of the scene, with a button for each way out.

use egui::{Align2, Area, Button, Context, Frame, Id, Label, Rect, RichText, vec2};

use super::power;
use crate::theme::{colour, plain};
use crate::widgets::name;
use crate::{Command, ViewChange, ViewState, lamp, notation};
use stillbase_session::{OutsideLimits, Proposal, Session};
use stillbase_simulation::frame::Frame as RunFrame;

/// Beginning of the sentence that says why the run waits.
const WAITS: &str = "The run waits: ";

/// Width that the button beside the text takes, points.
const CLOSE_WIDTH_PT: f32 = 26.0;

/// Why a problem message is shown.
#[derive(Clone, Debug, PartialEq)]
enum Reason {
    /// The last message reports this problem.
    Message(String),
    /// An audit has failed, in a sentence.
    Fault(String),
    /// The run waits, in a sentence.
    Waits(String),
    /// Joint limits leave out the present pose.
    OutsideLimits(OutsideLimits),
}

/// A problem that is reported.
#[derive(Clone, Debug, PartialEq)]
pub struct News {
    reason: Reason,
    /// Why the run waits, in a sentence, if the reason is another.
    also: Option<String>,
    /// What holds on of all this, by what tells it from another problem.
    holds_on: Vec<String>,
}

impl News {
    /// Returns the most urgent problem that the user has not put away; `None` if there is none, or while a dialog is
    /// open.
    pub fn of(session: &Session, view_state: &ViewState) -> Option<Self> {
        if view_state.open.dialog.is_some() {
            return None;
        }
        let waits = session.run().waiting().map(|waits| waits.why.to_string());
        // A refusal for which the run waits is told once.
        let message = view_state.status.problem().filter(|problem| waits.as_ref() != Some(problem));
        let is_new = |problem: &String| !view_state.put_away.contains(problem);
        let said = wait(session).filter(is_new);
        let of_wait: Vec<String> = said.iter().cloned().collect();
        // While the run waits, a refused edit hides neither the reason for the wait nor the remedy.
        if let Some(problem) = message {
            return Some(Self { reason: Reason::Message(problem.clone()), also: said, holds_on: of_wait });
        }
        let fault = fault(session.frame()).filter(|(kind, _)| is_new(kind) && view_state.status.problem().is_none());
        if let Some((kind, fault)) = fault {
            let holds_on = [of_wait, vec![kind]].concat();
            return Some(Self { reason: Reason::Fault(fault), also: said, holds_on });
        }
        if let Some(said) = said {
            return Some(Self { reason: Reason::Waits(said), also: None, holds_on: of_wait });
        }
        let outside = session.outside_limits().filter(|outside| waits.is_none() && is_new(&outside.why))?;
        let holds_on = vec![outside.why.clone()];
        Some(Self { reason: Reason::OutsideLimits(outside), also: None, holds_on })
    }

    /// Returns the problems that were put away and still hold on as they were; the others come back when they recur.
    pub fn still_put_away(session: &Session, put_away: &[String]) -> Vec<String> {
        if put_away.is_empty() {
            return Vec::new();
        }
        let waits = wait(session);
        let outside = session.outside_limits().map(|outside| outside.why);
        let now = [waits, fault(session.frame()).map(|(kind, _)| kind), outside];
        put_away.iter().filter(|problem| now.iter().flatten().any(|one| one == *problem)).cloned().collect()
    }

    /// Returns whether a problem that was put away is a reason why the run waits.
    pub fn is_wait(problem: &str) -> bool {
        problem.starts_with(WAITS)
    }

    /// Returns the change of the display that puts it away.
    pub fn put_away(self) -> ViewChange {
        ViewChange::PutAway(self.holds_on)
    }

    /// Whether it is about the run, not about what the user has just done.
    pub fn is_of_run(&self) -> bool {
        !matches!(self.reason, Reason::Message(_))
    }

    /// Whether it says that the run waits.
    pub fn says_wait(&self) -> bool {
        matches!(self.reason, Reason::Waits(_))
    }

    /// Returns what is wrong, in a sentence.
    fn text(&self) -> &str {
        match &self.reason {
            Reason::Message(text) | Reason::Fault(text) | Reason::Waits(text) => text,
            Reason::OutsideLimits(outside) => &outside.why,
        }
    }

    /// Returns the ways out of what is said, not of what stands behind it: those of the message or, without any, those
    /// that were `found` for the session.
    fn proposals<'a>(&'a self, of_message: &'a [Proposal], found: &'a [Proposal]) -> &'a [Proposal] {
        match (&self.reason, of_message) {
            (Reason::OutsideLimits(outside), _) => &outside.proposals,
            (_, []) => found,
            (_, known) => known,
        }
    }
}

/// Returns why the run waits, in a sentence. What an unfinished drawing lacks stands in place of its scene.
fn wait(session: &Session) -> Option<String> {
    let waits = session.run().waiting().filter(|_| session.run().unfinished().is_none())?;
    Some(format!("{WAITS}{}", waits.why))
}

/// Returns which audit has failed, and the warning about it, whose numbers change while the run goes on.
fn fault(frame: &RunFrame) -> Option<(String, String)> {
    let figure = frame.first_violation()?;
    let limit = figure.limit.unwrap_or_default();
    let warning = format!(
        "This run cannot be trusted: {} ({}) is off by {} {}, at most {} is right. A smaller step or softer gains help.",
        figure.name,
        figure.meaning,
        power(figure.value),
        figure.unit,
        power(limit)
    );
    Some((format!("audit {}", figure.name), warning))
}

/// Returns the rectangle of the problem message in the last pass.
pub fn rect(ctx: &Context) -> Option<Rect> {
    ctx.memory(|memory| memory.area_rect(Id::unique("news")))
}

/// Draws the problem message in full over the lower edge of a scene, with a button for each proposal.
pub fn show(
    ctx: &Context,
    scene: Rect,
    news: &News,
    view_state: &ViewState,
    found: &[Proposal],
    commands: &mut Vec<Command>,
) {
    let (p, status) = (view_state.palette(), &view_state.status);
    let proposals = news.proposals(&status.proposals, found);
    let refused = status.refused.as_ref().filter(|_| !matches!(news.reason, Reason::OutsideLimits(_)));
    let frame = Frame::new().fill(colour(p.panel)).stroke((1.0, colour(p.reaction))).corner_radius(8).inner_margin(10);
    // The message does not cover the panels.
    let width = (0.42 * ctx.content_rect().width()).clamp(320.0, (scene.width() - 40.0).max(320.0));
    let area = Area::new(Id::unique("news")).pivot(Align2::CENTER_BOTTOM);
    area.fixed_pos(scene.center_bottom() - vec2(0.0, 34.0)).show(ctx, |ui| {
        frame.show(ui, |ui| {
            ui.set_max_width(width);
            ui.horizontal_top(|ui| {
                ui.vertical(|ui| {
                    ui.set_max_width(width - CLOSE_WIDTH_PT);
                    let lines = [(Some(news.text()), p.ink), (news.also.as_deref(), p.dim)];
                    for (text, tone) in lines.into_iter().filter_map(|(text, tone)| Some((text?, tone))) {
                        let text = notation::sentence(ui.ctx(), text);
                        ui.add(Label::new(RichText::new(text).font(plain(12.0)).color(colour(tone))).wrap());
                    }
                });
                let close = ui.add(Button::new("×").frame(false).min_size(vec2(16.0, 16.0)));
                name(&close, "Put this message away");
                let close = close.on_hover_text("Put away (Esc); it comes back when something changes about it");
                if close.clicked() {
                    commands.push(news.clone().put_away().into());
                }
            });
            if proposals.is_empty() && status.entry.is_none() {
                return;
            }
            ui.horizontal_wrapped(|ui| {
                if let Some(entry) = &status.entry {
                    entry.button(ui);
                }
                for proposal in proposals {
                    lamp::proposal(ui, proposal, refused, commands);
                }
            });
        });
    });
}
