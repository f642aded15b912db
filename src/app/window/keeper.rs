//! [`Keeper`]: writes down how the window is liked, and the session into its journal.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use crate::app::jobs::Threads;
use crate::app::{AppState, LeftOff, Preferences};
use crate::files::journal::{self, Journal, Left};
use crate::files::preferences;
use crate::query::{Job, Poll};

/// Writes what changes, beside the window: the first change at once, later ones within a second.
pub struct Keeper {
    liked: Liked,
    journal: Option<Journal>,
    /// What the journal holds, and what is being written.
    held: Kept,
    writing: Option<(Kept, Job<bool>)>,
    next: Instant,
    /// What was left behind and goes when the journal holds it again.
    going: Option<PathBuf>,
}

/// How the window is liked, how its file has it, and since when.
struct Liked {
    now: Preferences,
    written: Preferences,
    when: Instant,
}

impl Liked {
    /// Brings the file up to date.
    fn write(&mut self) {
        if self.written != self.now {
            preferences::save(&self.now);
            self.written.clone_from(&self.now);
            self.when = Instant::now();
        }
    }
}

/// What of a session on display is kept: the count of its changes, and what is in none of them.
type Kept = (u64, LeftOff);

/// The least time between two writes of preferences.
const PREFERENCES_INTERVAL: Duration = Duration::from_secs(1);
/// The least time between two writes of the journal: half of the second within which it holds a change.
const JOURNAL_INTERVAL: Duration = Duration::from_millis(500);
/// The most that copying a long session adds to this time.
const MAX_COPY_PAUSE: Duration = Duration::from_millis(250);
/// How often and how long a write is waited for when the window closes.
const LOOKS: u32 = 1000;
const LOOK: Duration = Duration::from_millis(2);
/// Copying a session takes at most this fraction of the time between two copies, as far as the pause allows.
const COPY_SHARE: u32 = 50;

impl Keeper {
    /// What is liked is in its file already.
    pub fn new(liked: Preferences, app_state: &AppState) -> Self {
        let now = Instant::now();
        let held = (app_state.changes().0, app_state.left_off());
        let liked = Liked { now: liked.clone(), written: liked, when: now };
        Self { liked, journal: None, held, writing: None, next: now, going: None }
    }

    /// After a repaint.
    pub fn keep(&mut self, ctx: &egui::Context, app_state: &mut AppState) {
        self.like(ctx, app_state);
        self.write(ctx, app_state);
    }

    fn like(&mut self, ctx: &egui::Context, app_state: &AppState) {
        let size = ctx.content_rect().size();
        let liked = &mut self.liked;
        liked.now = app_state.preferences([size.x, size.y]);
        if liked.now == liked.written {
            return;
        }
        // While an edge is dragged it is not written at every step.
        match PREFERENCES_INTERVAL.checked_sub(liked.when.elapsed()) {
            Some(wait) if !wait.is_zero() => ctx.request_repaint_after(wait),
            _ => liked.write(),
        }
    }

    fn write(&mut self, ctx: &egui::Context, app_state: &mut AppState) {
        if let Some((of, job)) = self.writing.take() {
            match job.poll() {
                Poll::Working => self.writing = Some((of, job)),
                Poll::Done(true) => self.held = of,
                Poll::Done(false) | Poll::Broken => {}
            }
        }
        self.going = app_state.take_recovered().or(self.going.take());
        let now_is = (app_state.changes().0, app_state.left_off());
        let (changes, left_off) = &now_is;
        // An instant alone is no reason to begin a journal, and while time runs it is not followed.
        let elsewhere =
            self.journal.is_some() && !app_state.session().is_playing() && left_off.time != self.held.1.time;
        if *changes == self.held.0 && left_off.plots == self.held.1.plots && !elsewhere {
            self.going.take().iter().for_each(|file| journal::forget(file));
            return;
        }
        // What is being written wakes the window when it is done.
        if self.writing.is_some() {
            return;
        }
        let now = Instant::now();
        if now < self.next {
            ctx.request_repaint_after(self.next - now);
            return;
        }
        if self.journal.is_none() {
            self.journal = journal::folder().and_then(|folder| Journal::begin(&folder));
        }
        self.next = now + JOURNAL_INTERVAL;
        let Some(file) = self.journal.as_ref().map(|journal| journal.file().to_owned()) else { return };
        let (scenario, left_off) = (app_state.session().to_scenario(), left_off.clone());
        self.next += (COPY_SHARE * now.elapsed()).min(MAX_COPY_PAUSE);
        let wake = ctx.clone();
        let job = Job::start(
            &Threads::Prompt,
            move || wake.request_repaint(),
            move |_| journal::write(&file, &left_off.before(&scenario.to_toml())).is_ok(),
        );
        self.writing = Some((now_is, job));
    }

    /// Waits for what is being written. A disk that hangs is not waited for.
    fn settle(&mut self) {
        let busy = |job: &Job<bool>| matches!(job.poll(), Poll::Working);
        for _ in 0..LOOKS {
            if !self.writing.as_ref().is_some_and(|(_, job)| busy(job)) {
                break;
            }
            std::thread::sleep(LOOK);
        }
    }

    /// The window ends out of order: what was done is written at once, to be offered at the next start; where.
    pub fn keep_now(&mut self, app_state: &AppState) -> Option<PathBuf> {
        self.liked.write();
        self.settle();
        if app_state.changes().0 != self.held.0 && self.journal.is_none() {
            self.journal = journal::folder().and_then(|folder| Journal::begin(&folder));
        }
        let file = self.journal.as_ref()?.file();
        let session = app_state.session().to_scenario().to_toml();
        journal::write(file, &app_state.left_off().before(&session)).ok()?;
        Some(file.to_owned())
    }

    /// The window closes in order: nothing is to be offered at the next start.
    pub fn end(&mut self) {
        self.liked.write();
        // What is being written would come back after it was removed.
        self.settle();
        if let Some(journal) = self.journal.take() {
            journal.end();
        }
    }
}

/// The newest session that a program left behind, with when that was, in words.
pub fn found() -> Option<(PathBuf, String)> {
    let Left { file, when } = journal::left(&journal::folder()?).into_iter().next()?;
    let ago = when.elapsed().unwrap_or_default().as_secs();
    let words = match ago {
        0..=119 => "a moment ago".into(),
        120..=7199 => format!("{} minutes ago", ago / 60),
        7200..=172_799 => format!("{} hours ago", ago / 3600),
        _ => format!("{} days ago", ago / 86_400),
    };
    Some((file, words))
}
