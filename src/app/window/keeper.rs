//! [`Keeper`]: writes the preferences, and the session into its journal.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use crate::jobs::Threads;
use crate::{AppState, LeftSession, Preferences, ResumePoint};
use stillbase_files::journal::{self, Journal, LeftoverJournal};
use stillbase_files::preferences;
use stillbase_picture::scene::palette::Theme;
use stillbase_query::{Job, Poll};

/// Writes the first change at once, later ones within a second; the journal is written in the background.
pub struct Keeper {
    liked: Liked,
    journal: Option<Journal>,
    /// State that the journal contains.
    held: Kept,
    /// State that is being written, and the job that writes it.
    writing: Option<(Kept, Job<bool>)>,
    next: Instant,
    /// File of a recovered session; it is removed once the journal contains the session.
    going: Option<PathBuf>,
}

/// Preferences: the present ones, those in the file, and the time of the last write.
struct Liked {
    now: Preferences,
    written: Preferences,
    when: Instant,
    /// The theme of this start, and the preferred one.
    passing: Option<(Theme, Theme)>,
}

impl Liked {
    /// Writes the preferences if they have changed.
    fn write(&mut self) {
        if self.written != self.now {
            preferences::save(&self.now);
            self.written.clone_from(&self.now);
            self.when = Instant::now();
        }
    }
}

/// Number of changes of a session, and the state of the display that edits do not contain.
type Kept = (u64, ResumePoint);

/// Minimum time between two writes of preferences.
const PREFERENCES_INTERVAL: Duration = Duration::from_secs(1);
/// Minimum time between two writes of the journal: half a second, because it must contain each change within a second.
const JOURNAL_INTERVAL: Duration = Duration::from_millis(500);
/// Maximum time added to [`JOURNAL_INTERVAL`] because a long session takes long to copy.
const MAX_COPY_PAUSE: Duration = Duration::from_millis(250);
/// Maximum number of checks for the end of a write when the program ends.
const MAX_CHECKS: u32 = 1000;
/// Interval of these checks.
const CHECK_INTERVAL: Duration = Duration::from_millis(2);
/// Ratio of the added time to the time that copying the session took; [`MAX_COPY_PAUSE`] limits the result.
const COPY_PAUSE_FACTOR: u32 = 50;

impl Keeper {
    /// Creates the keeper; it takes preferences and session as already stored.
    pub fn new(liked: Preferences, app_state: &AppState) -> Self {
        let now = Instant::now();
        let held = (app_state.changes().0, app_state.left_off());
        let given = app_state.view_state().arrangement.theme;
        // A theme for this start alone stays no preference, unless another is chosen.
        let passing = (given != liked.theme).then_some((given, liked.theme));
        let liked = Liked { now: liked.clone(), written: liked, when: now, passing };
        Self { liked, journal: None, held, writing: None, next: now, going: None }
    }

    /// Writes preferences and journal after a repaint, if they are due.
    pub fn keep(&mut self, ctx: &egui::Context, app_state: &mut AppState) {
        self.keep_preferences(ctx, app_state);
        self.write(ctx, app_state);
    }

    fn keep_preferences(&mut self, ctx: &egui::Context, app_state: &AppState) {
        let size = ctx.content_rect().size();
        let liked = &mut self.liked;
        liked.now = app_state.preferences([size.x, size.y]);
        match liked.passing {
            Some((given, own)) if liked.now.theme == given => liked.now.theme = own,
            Some(_) => liked.passing = None,
            None => {}
        }
        if liked.now == liked.written {
            return;
        }
        // While a window edge is dragged, the file is not written at every step.
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
        // A change of the displayed time alone does not begin a journal, and is not written while the run plays.
        let time_changed =
            self.journal.is_some() && !app_state.own_session().is_playing() && left_off.time != self.held.1.time;
        if *changes == self.held.0 && left_off.is_alike_at_another_time(&self.held.1) && !time_changed {
            self.going.take().iter().for_each(|file| journal::remove_journal(file));
            return;
        }
        // The write under way wakes the window at its end.
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
        let (scenario, left_off) = (app_state.own_session().to_scenario(), left_off.clone());
        self.next += (COPY_PAUSE_FACTOR * now.elapsed()).min(MAX_COPY_PAUSE);
        let wake = ctx.clone();
        let job = Job::start(
            &Threads::Prompt,
            move || wake.request_repaint(),
            move |_| journal::write(&file, &left_off.before(&scenario.to_toml())).is_ok(),
        );
        self.writing = Some((now_is, job));
    }

    /// Waits for the end of a write, for a limited time.
    fn settle(&mut self) {
        let busy = |job: &Job<bool>| matches!(job.poll(), Poll::Working);
        for _ in 0..MAX_CHECKS {
            if !self.writing.as_ref().is_some_and(|(_, job)| busy(job)) {
                break;
            }
            std::thread::sleep(CHECK_INTERVAL);
        }
    }

    /// Writes preferences and journal at once, before an abnormal end; returns the file of the journal. The next start
    /// offers this session.
    pub fn keep_now(&mut self, app_state: &AppState) -> Option<PathBuf> {
        self.liked.write();
        self.settle();
        if app_state.changes().0 != self.held.0 && self.journal.is_none() {
            self.journal = journal::folder().and_then(|folder| Journal::begin(&folder));
        }
        let file = self.journal.as_ref()?.file();
        let session = app_state.own_session().to_scenario().to_toml();
        journal::write(file, &app_state.left_off().before(&session)).ok()?;
        Some(file.to_owned())
    }

    /// Writes the preferences and removes the journal: after a normal end, the next start offers no session.
    pub fn end(&mut self) {
        self.liked.write();
        // A write under way would create the journal again after its removal.
        self.settle();
        if let Some(journal) = self.journal.take() {
            journal.end();
        }
    }
}

/// Returns the newest session that an earlier program run left.
pub fn find_left_session() -> Option<LeftSession> {
    let LeftoverJournal { file, when } = journal::leftover_journals(&journal::folder()?).into_iter().next()?;
    let ago = when.elapsed().unwrap_or_default().as_secs();
    let words = match ago {
        0..=119 => "a moment ago".into(),
        120..=7199 => format!("{} minutes ago", ago / 60),
        7200..=172_799 => format!("{} hours ago", ago / 3600),
        _ => format!("{} days ago", ago / 86_400),
    };
    Some(LeftSession::of(file, words))
}
