//! [`Saving`]: the saved and unsaved changes of a session, and the questions about unsaved ones.

use std::path::{Path, PathBuf};

use egui::{Frame, Id, Key, Modal, Modifiers, RichText};

use super::theme::{bold, colour, plain};
use super::{Command, Recovery, SessionCommand, ViewState, WindowCommand};
use super::{ResumePoint, notation};
use stillbase_picture::scene::palette::faded;
use stillbase_session::ChangesMade;
use stillbase_session::scenario::Scenario;
use stillbase_settings::number::counted;
use stillbase_settings::text::shorten_message;

/// Record of the saved and unsaved changes of a session, and of its files.
#[derive(Clone, Debug, Default)]
pub(super) struct Saving {
    /// Number of changes of the session.
    pub changes: u64,
    /// The value of `changes` when the session was opened or saved last.
    pub saved: u64,
    /// Whether the question before closing is open.
    pub asks: bool,
    /// Whether the window must close.
    pub leaves: bool,
    /// A session left by an earlier program run.
    pub left_session: Option<LeftSession>,
    /// The file of a recovered or discarded session; it is removed once a journal contains the present session.
    pub recovered: Option<PathBuf>,
    /// The files of this session and of the earlier sessions in its undo history. Each was written by this program,
    /// and the session was opened from it or saved to it. Files written by hand are not listed, so that saving never
    /// drops their comments.
    pub own: Vec<OwnFile>,
    /// Recently opened and saved files, newest first.
    pub recent: Vec<PathBuf>,
    /// The file that the user has agreed to replace.
    pub replaces: Option<PathBuf>,
}

/// A session left by an earlier program run.
#[derive(Clone, Debug)]
pub struct LeftSession {
    /// Its file.
    pub file: PathBuf,
    /// The time of its writing, in words.
    when: String,
    /// What it holds, in sentences.
    holds: String,
}

impl LeftSession {
    /// Reads what a file holds that was written `when`, in words.
    pub fn of(file: PathBuf, when: String) -> Self {
        let found = stillbase_files::any_scenario(&file.display().to_string());
        let holds = found.map_or_else(
            |why| format!("Its session cannot be read: {}", shorten_message(&why.to_string())),
            |found| contents(&found.scenario, &file),
        );
        Self { file, when, holds }
    }
}

/// Says which session a file holds, how many changes, and what the last one was.
fn contents(scenario: &Scenario, file: &Path) -> String {
    let title = if scenario.title.is_empty() { &scenario.name } else { &scenario.title };
    let own = stillbase_files::text::read(file).ok().and_then(|text| ResumePoint::of(&text)?.file);
    let own = own.and_then(|own| Some(format!(" of {}", own.file_name()?.display()))).unwrap_or_default();
    let ChangesMade { count, last } = ChangesMade::of(scenario);
    let changes = match count {
        0 => "no change of the scenario".to_owned(),
        n => counted(n, "change"),
    };
    let held =
        format!("It left the session \u{201c}{title}\u{201d}{own}, with {}, {changes}.", scenario.machine.name());
    let last = last.map(|(words, time)| match time {
        0.0 => format!("\nThe last: {words}."),
        time => format!("\nThe last: {words}, at {time:.3} s."),
    });
    shorten_message(&(held + &last.unwrap_or_default())).into_owned()
}

/// The file of a session, valid from a number of undo entries on. Undoing the opening of a file leads back to the
/// previous session, and to the file of that session.
#[derive(Clone, Debug)]
pub(super) struct OwnFile {
    /// Number of undo entries right after the session was opened.
    since: usize,
    file: Option<PathBuf>,
}

/// Maximum number of recent files.
const MAX_RECENT_FILES: usize = 8;

impl Saving {
    /// Returns the file of the session that has this number of undo entries.
    pub fn own_file(&self, undo_count: usize) -> Option<&PathBuf> {
        self.own.iter().rev().find(|own| own.since <= undo_count)?.file.as_ref()
    }

    /// Begins a session that has this number of undo entries, and no file yet.
    pub fn begin_file(&mut self, undo_count: usize) {
        self.own.retain(|own| own.since < undo_count);
        self.own.push(OwnFile { since: undo_count, file: None });
    }

    /// Sets the file of the session that has this number of undo entries.
    pub fn keep_file(&mut self, undo_count: usize, file: PathBuf) {
        match self.own.iter_mut().rev().find(|own| own.since <= undo_count) {
            Some(own) => own.file = Some(file),
            None => self.own.push(OwnFile { since: 0, file: Some(file) }),
        }
    }

    /// Whether some changes are in no file of the user.
    pub fn is_unsaved(&self) -> bool {
        self.changes != self.saved
    }

    /// Marks a newly opened session as saved.
    pub fn opened(&mut self) {
        self.changes += 1;
        self.saved = self.changes;
    }

    /// Whether a question is open: until it is answered, it alone receives the keys.
    pub fn has_question(&self) -> bool {
        self.asks || self.left_session.is_some()
    }

    /// Adds a file to the recent files, by its absolute path; ignores a file that does not exist.
    pub fn uses(&mut self, file: &Path) {
        let Some(file) = stillbase_files::absolute_path(file) else { return };
        self.recent.retain(|other| *other != file);
        self.recent.insert(0, file);
        self.recent.truncate(MAX_RECENT_FILES);
    }

    /// Removes a file from the recent files if it does not exist any more.
    pub fn misses(&mut self, file: &Path) {
        self.recent.retain(|other| other != file || stillbase_files::absolute_path(file).is_some());
    }
}

/// Drops the keys that answer no question, so that nothing behind the question receives them.
pub(super) fn keep_keys(ctx: &egui::Context) {
    let answers = |key: Key| {
        use Key::{ArrowDown, ArrowLeft, ArrowRight, ArrowUp, Enter, Escape, Space, Tab};
        matches!(key, Tab | Enter | Space | Escape | ArrowLeft | ArrowRight | ArrowUp | ArrowDown)
    };
    ctx.input_mut(|input| {
        input.events.retain(|event| match event {
            egui::Event::Key { key, .. } => answers(*key),
            egui::Event::Text(_) | egui::Event::Copy | egui::Event::Cut | egui::Event::Paste(_) => false,
            _ => true,
        });
    });
}

/// Shows the question about a session left by an earlier program run, or about unsaved changes before the window
/// closes.
pub(super) fn show(
    ctx: &egui::Context,
    (saving, undo_count): (&Saving, usize),
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
        let (save, own) = (Command::Session(SessionCommand::Save), saving.own_file(undo_count).is_some());
        card(
            ctx,
            view_state,
            "Save before closing?",
            &words,
            commands,
            [
                (if own { "Save" } else { "Save…" }, vec![Command::Window(WindowCommand::AskToLeave(false)), save]),
                ("Close without saving", vec![Command::Window(WindowCommand::Leave)]),
                ("Cancel", vec![Command::Window(WindowCommand::AskToLeave(false))]),
            ],
        );
    } else if let Some(LeftSession { when, holds, .. }) = &saving.left_session {
        let words = format!("The program did not end properly {when}.\n{}", notation::sentence(ctx, holds));
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
    // A question that appears takes the keyboard focus.
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
    // Esc chooses the last answer, which changes nothing.
    let leaves_it = ctx.input_mut(|i| i.consume_key(Modifiers::NONE, Key::Escape)).then_some(N - 1);
    commands
        .extend(shown.inner.or(leaves_it).and_then(|i| answers.into_iter().nth(i)).into_iter().flat_map(|(_, c)| c));
}
