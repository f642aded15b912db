//! The problem message over the lower edge of the scene, with a button for each way out.

use egui::{Align2, Area, Context, Frame, Id, Label, Rect, RichText, vec2};

use super::power;
use crate::theme::{colour, plain};
use crate::{Command, ViewState, lamp, notation};
use stillbase_session::{OutsideLimits, Proposal, Session};
use stillbase_simulation::frame::Frame as RunFrame;

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
}

impl News {
    /// Returns the most urgent problem; `None` if there is none, or while a dialog is open.
    pub fn of(session: &Session, view_state: &ViewState) -> Option<Self> {
        if view_state.open.dialog.is_some() {
            return None;
        }
        let waits = session.run().waiting().map(|waits| waits.why.to_string());
        let said = waits.as_ref().map(|why| format!("The run waits: {why}"));
        // A refusal for which the run waits is told once.
        let message = view_state.status.problem().filter(|problem| waits.as_ref() != Some(problem));
        // While the run waits, a refused edit hides neither the reason for the wait nor the remedy.
        if let Some(problem) = message {
            return Some(Self { reason: Reason::Message(problem.clone()), also: said });
        }
        if let Some(fault) = fault(session.frame()).filter(|_| view_state.status.problem().is_none()) {
            return Some(Self { reason: Reason::Fault(fault), also: said });
        }
        let reason = said.map(Reason::Waits).or_else(|| session.outside_limits().map(Reason::OutsideLimits))?;
        Some(Self { reason, also: None })
    }

    /// Whether it is about the run, not about what the user has just done.
    pub fn is_of_run(&self) -> bool {
        !matches!(self.reason, Reason::Message(_))
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

/// Returns the warning about a failed audit.
fn fault(frame: &RunFrame) -> Option<String> {
    let figure = frame.first_violation()?;
    let limit = figure.limit.unwrap_or_default();
    Some(format!(
        "This run cannot be trusted: {} ({}) is off by {} {}, at most {} is right. A smaller step or softer gains help.",
        figure.name,
        figure.meaning,
        power(figure.value),
        figure.unit,
        power(limit)
    ))
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
            let lines = [(Some(news.text()), p.ink), (news.also.as_deref(), p.dim)];
            for (text, tone) in lines.into_iter().filter_map(|(text, tone)| Some((text?, tone))) {
                let text = notation::sentence(ui.ctx(), text);
                ui.add(Label::new(RichText::new(text).font(plain(12.0)).color(colour(tone))).wrap());
            }
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
