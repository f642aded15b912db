//! [`Saving`]: which of the changes of a session are in a file, and the questions about those that are not.

use std::path::{Path, PathBuf};

use egui::{Frame, Id, Key, Modal, Modifiers, RichText};

use super::theme::{bold, colour, plain};
use super::{Command, FileDialog, Purpose, Recovery, SessionCommand, ViewChange, ViewState, WindowCommand};
use crate::picture::scene::palette::faded;
use crate::session::Session;

/// How much of a session is in a file.
#[derive(Clone, Debug, Default)]
pub(super) struct Saving {
    /// Counts up with every change of the session.
    pub changes: u64,
    /// What the count was when it was opened or saved.
    pub saved: u64,
    /// The window was asked to close.
    pub asks: bool,
    /// It may close without saving.
    pub leaves: bool,
    /// A session that a program left behind, and when, in words.
    pub found: Option<(PathBuf, String)>,
    /// What was left behind and is open now, or is to be forgotten: its file is to go when a journal holds it again.
    pub recovered: Option<PathBuf>,
    /// Files that were opened and saved, newest first.
    pub recent: Vec<PathBuf>,
    /// The file that may be replaced, as the person has agreed.
    pub replaces: Option<PathBuf>,
}

/// How many files are remembered.
const RECENT: usize = 8;

impl Saving {
    /// Whether something has changed that is in no file of the person's own.
    pub fn is_unsaved(&self) -> bool {
        self.changes != self.saved
    }

    /// The session is another one, as its file has it.
    pub fn opened(&mut self) {
        self.changes += 1;
        self.saved = self.changes;
    }

    /// Whether a question is open: until it is answered nothing else is done.
    pub fn has_question(&self) -> bool {
        self.asks || self.found.is_some()
    }

    /// Remembers a file by the whole of its path; a name that is no file is not remembered.
    pub fn uses(&mut self, file: &Path) {
        let Some(file) = crate::files::whole(file) else { return };
        self.recent.retain(|other| *other != file);
        self.recent.insert(0, file);
        self.recent.truncate(RECENT);
    }

    /// Forgets a file that is gone.
    pub fn misses(&mut self, file: &Path) {
        self.recent.retain(|other| other != file || crate::files::whole(file).is_some());
    }
}

/// Asks what to do with a session that was left behind, or with changes before the window closes.
pub(super) fn show(
    ctx: &egui::Context,
    saving: &Saving,
    session: &Session,
    view_state: &ViewState,
    commands: &mut Vec<Command>,
) {
    if saving.asks {
        let changes = saving.changes - saving.saved;
        let words = match changes {
            0 => "A change of this session is being made.".to_owned(),
            1 => "One change of this session is in no file.".to_owned(),
            n => format!("{n} changes of this session are in no file."),
        };
        let save = Command::View(ViewChange::Dialog(Some(FileDialog::suggest(session, Purpose::Save))));
        card(
            ctx,
            view_state,
            "Save before closing?",
            &words,
            commands,
            [
                ("Save…", vec![Command::Window(WindowCommand::AskToLeave(false)), save]),
                ("Close without saving", vec![Command::Window(WindowCommand::Leave)]),
                ("Cancel", vec![Command::Window(WindowCommand::AskToLeave(false))]),
            ],
        );
    } else if let Some((_, when)) = &saving.found {
        let words = format!("The program did not end in order {when}. What was done then is still there.");
        card(
            ctx,
            view_state,
            "Go on where you were?",
            &words,
            commands,
            [
                ("Open that session", vec![Command::Session(SessionCommand::Recover(Recovery::Open))]),
                ("Forget it", vec![Command::Session(SessionCommand::Recover(Recovery::Forget))]),
                ("Later", vec![Command::Session(SessionCommand::Recover(Recovery::Later))]),
            ],
        );
    }
}

fn card<const N: usize>(
    ctx: &egui::Context,
    view_state: &ViewState,
    title: &str,
    words: &str,
    commands: &mut Vec<Command>,
    answers: [(&str, Vec<Command>); N],
) {
    let p = view_state.palette();
    let frame = Frame::new().fill(colour(p.panel)).stroke((1.0, colour(p.amber))).corner_radius(10).inner_margin(16);
    let area = Modal::default_area(Id::unique("question"));
    // A question that appears takes the keys.
    let mut appears = !ctx.memory(|m| m.areas().visible_last_frame(&area.layer()));
    let shade = colour(faded(p.background, 0.6));
    let shown = Modal::new(Id::unique("question")).area(area).frame(frame).backdrop_color(shade).show(ctx, |ui| {
        ui.set_width(430.0);
        ui.label(RichText::new(title).font(bold(15.0)).color(colour(p.ink)));
        ui.add(egui::Label::new(RichText::new(words).font(plain(12.5)).color(colour(p.dim))).wrap());
        ui.add_space(6.0);
        let mut given = None;
        ui.horizontal(|ui| {
            for (i, (answer, _)) in answers.iter().enumerate() {
                let button = ui.button(*answer);
                if std::mem::take(&mut appears) {
                    button.request_focus();
                }
                given = given.or(button.clicked().then_some(i));
            }
        });
        given
    });
    // The last answer changes nothing: so does Esc.
    let leaves_it = ctx.input_mut(|i| i.consume_key(Modifiers::NONE, Key::Escape)).then_some(N - 1);
    commands
        .extend(shown.inner.or(leaves_it).and_then(|i| answers.into_iter().nth(i)).into_iter().flat_map(|(_, c)| c));
}
