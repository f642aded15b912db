//! [`Background`]: work in the background.

use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::Arc;

use super::change::SessionChange;
use super::given::assess::AssessmentQuery;
use super::waiting::{DeferredWorkers, DrawingGuard};
use super::{Activity, SessionCommand};
use stillbase_query::{InlineWorkers, Job, Poll, Queries, ShortJobs, Ticket, Workers};
use stillbase_session::scenario::Scenario;
use stillbase_session::{Refusal, Session};
use stillbase_study::comparison::AlternativeRuns;
use stillbase_study::fronts::Fronts;
use stillbase_study::lengths::LengthsQuery;
use stillbase_study::tolerance::StudyQuery;

/// Work whose result changes the display.
trait Pending<A> {
    /// Returns the fraction that is done, from 0 to 1.
    fn progress(&self) -> f64;

    /// Whether the work has ended.
    fn has_ended(&mut self) -> bool;

    /// Waits until the work has ended.
    #[cfg(feature = "window")]
    fn wait(&mut self);

    /// Runs the follow-up with the result.
    fn finish(self: Box<Self>, app_state: &mut A);
}

/// A job, its result, and the follow-up. A job that panicked has no result.
struct Running<T, F> {
    job: Option<Job<T>>,
    result: Option<T>,
    then: F,
}

impl<A, T: Send + 'static, F: FnOnce(&mut A, Option<T>)> Pending<A> for Running<T, F> {
    fn progress(&self) -> f64 {
        self.job.as_ref().map_or(1.0, Job::progress)
    }

    fn has_ended(&mut self) -> bool {
        match self.job.as_ref().map(Job::poll) {
            Some(Poll::Working) => return false,
            Some(Poll::Done(result)) => self.result = Some(result),
            Some(Poll::Broken) | None => {}
        }
        self.job = None;
        true
    }

    #[cfg(feature = "window")]
    fn wait(&mut self) {
        self.result = self.job.take().and_then(Job::wait);
    }

    fn finish(self: Box<Self>, app_state: &mut A) {
        (self.then)(app_state, self.result);
    }
}

/// Actions and messages after a session has been opened.
#[derive(Clone, Debug, Default)]
pub(super) struct Opening {
    /// Whether the run plays at once.
    pub plays: bool,
    /// Whether the file dialog closes.
    pub closes: bool,
    /// Whether a table is added to the one on display.
    pub adds: bool,
    /// The message.
    pub message: Option<String>,
    /// Title in the history, if it is not the usual one.
    pub title: Option<&'static str>,
    /// The file of the session.
    pub file: Option<SessionFile>,
    /// The scenario to open instead if this one cannot be opened, and its message.
    pub instead: Option<Box<(Scenario, String)>>,
}

/// The file of a session.
#[derive(Clone, Debug)]
pub(super) enum SessionFile {
    /// A file chosen by the user.
    Own(PathBuf),
    /// A journal left by an earlier program run.
    LeftBehind(PathBuf),
}

/// The changed session, and the message or the reason of a refusal.
pub(super) type SessionResult = (Session, Result<Option<String>, Refusal>);

/// Sessions with more frames are freed in the background, because freeing them takes milliseconds.
const MAX_FRAMES_FREED_AT_ONCE: usize = 20_000;

/// Number of repaints before a change is reported in the status line; most changes finish earlier.
const SILENT_REPAINTS: u32 = 6;

/// Work in the background, its worker threads, and its follow-ups, which change the program's state `A`.
pub(super) struct Background<A> {
    workers: Arc<dyn Workers + Send + Sync>,
    /// Queue in which work waits until the window is drawn; `None` if work is done at once.
    waiting: Option<Arc<DeferredWorkers>>,
    /// Queries about the session.
    pub queries: Queries,
    /// Context that is repainted when a job has ended.
    ctx: Option<egui::Context>,
    /// Work whose result changes the display, in the order of its start.
    running: Vec<(Activity, Box<dyn Pending<A>>)>,
    /// The change of the session under way, and the number of repaints since its start.
    pub change: Option<(SessionChange, u32)>,
    /// Session commands that wait until the change has ended.
    pub waiting_commands: VecDeque<SessionCommand>,
}

/// A query that the status line reports: its activity, its progress, and the function that stops it.
type ReportedQuery = (Activity, fn(&Queries) -> Option<f64>, fn(&Queries));

const REPORTED_QUERIES: [ReportedQuery; 5] = [
    (Activity::Table, Queries::progress::<AssessmentQuery>, Queries::stop::<AssessmentQuery>),
    (Activity::Study, Queries::progress::<StudyQuery>, Queries::stop::<StudyQuery>),
    (Activity::Seeking, Queries::progress::<LengthsQuery>, Queries::stop::<LengthsQuery>),
    (Activity::Fronts, Queries::progress::<Fronts>, Queries::stop::<Fronts>),
    (Activity::TaskVariants, Queries::progress::<AlternativeRuns>, Queries::stop::<AlternativeRuns>),
];

impl<A> Default for Background<A> {
    fn default() -> Self {
        Self {
            workers: Arc::new(InlineWorkers),
            waiting: None,
            queries: Queries::default(),
            ctx: None,
            running: Vec::new(),
            change: None,
            waiting_commands: VecDeque::new(),
        }
    }
}

impl<A> Background<A> {
    /// Sets the worker threads.
    pub fn set_workers(&mut self, workers: impl Workers + Send + Sync + 'static) {
        let waiting = Arc::new(DeferredWorkers::new(workers));
        self.workers = waiting.clone();
        self.waiting = Some(waiting);
        self.queries.set_workers(self.workers.clone());
    }

    /// Returns a guard that delays new work while the window is drawn.
    pub fn drawing(&self) -> DrawingGuard {
        DrawingGuard::begin(self.waiting.as_ref())
    }

    /// Sets the context that is repainted when a job has ended.
    pub fn set_context(&mut self, ctx: &egui::Context) {
        if self.ctx.is_none() {
            self.ctx = Some(ctx.clone());
            let ctx = ctx.clone();
            self.queries.on_finished(move || ctx.request_repaint());
        }
    }

    /// Starts work in the background without a follow-up.
    fn start<T: Send + 'static>(&self, work: impl FnOnce(&Ticket) -> T + Send + 'static) -> Job<T> {
        self.start_by(&*self.workers, work)
    }

    fn start_by<T: Send + 'static>(
        &self,
        workers: &dyn Workers,
        work: impl FnOnce(&Ticket) -> T + Send + 'static,
    ) -> Job<T> {
        let ctx = self.ctx.clone();
        let wake = move || {
            if let Some(ctx) = ctx {
                ctx.request_repaint();
            }
        };
        Job::start(workers, wake, work)
    }

    /// Runs work in the background, then calls `then` with its result, or with `None` if the work panicked.
    pub fn run<T: Send + 'static>(
        &mut self,
        activity: Activity,
        work: impl FnOnce(&Ticket) -> T + Send + 'static,
        then: impl FnOnce(&mut A, Option<T>) + 'static,
    ) {
        let job = match activity {
            // Most changes are finished by the next repaint.
            Activity::Change => self.start_by(&ShortJobs(&*self.workers), work),
            _ => self.start_by(&*self.workers, work),
        };
        self.running.push((activity, Box::new(Running { job: Some(job), result: None, then })));
    }

    /// Removes the first finished work whose turn has come, and returns its follow-up. An opening waits until changes
    /// of the session have ended. Work of one activity is followed up in the order of its start.
    pub fn ended(&mut self) -> Option<impl FnOnce(&mut A) + use<A>> {
        let is_changing = self.is_changing();
        let (mut index, mut before) = (None, Vec::new());
        for (i, (activity, work)) in self.running.iter_mut().enumerate() {
            let waits = before.contains(activity) || (*activity == Activity::Opening && is_changing);
            if !waits && work.has_ended() {
                index = Some(i);
                break;
            }
            before.push(*activity);
        }
        let (_, work) = self.running.remove(index?);
        Some(|app_state: &mut A| work.finish(app_state))
    }

    /// Whether work of this activity is under way.
    pub fn runs(&self, activity: Activity) -> bool {
        self.running.iter().any(|(own, _)| *own == activity)
    }

    /// Stops the work of this activity.
    pub fn stop(&mut self, activity: Activity) {
        self.running.retain(|(own, _)| *own != activity);
        if let Some((_, _, stop)) = REPORTED_QUERIES.iter().find(|(own, ..)| *own == activity) {
            stop(&self.queries);
        }
        if activity == Activity::Change {
            self.change = None;
            self.waiting_commands.clear();
        }
    }

    /// Waits for the end of the work of this activity, without its follow-up.
    #[cfg(feature = "window")]
    pub fn wait_for(&mut self, activity: Activity) {
        if let Some(waiting) = &self.waiting {
            waiting.open();
        }
        self.running.iter_mut().filter(|(own, _)| *own == activity).for_each(|(_, work)| work.wait());
    }

    /// Frees a replaced session. A long one that shares no frames with the present one is freed in the background.
    pub fn free(&self, old: Session, now: &Session) {
        let shares = now.frames().revision().unchanged_since(&old.frames().revision().mark()) > 0;
        if old.frames().len() > MAX_FRAMES_FREED_AT_ONCE && !shares {
            drop(self.start(move |_| drop(old)));
        }
    }

    /// Whether the session is being changed, so that session commands have to wait.
    pub fn is_changing(&self) -> bool {
        self.change.is_some() || !self.waiting_commands.is_empty()
    }

    /// Appends a session command to those that wait. Of the edits of one drag, and of consecutive seeks, only the
    /// newest is kept.
    pub fn enqueue(&mut self, command: SessionCommand) {
        let replaced = match (self.waiting_commands.back(), &command) {
            (Some(SessionCommand::Edit(earlier)), SessionCommand::Edit(later)) => earlier.is_replaced_by(later),
            (Some(SessionCommand::Seek(_)), SessionCommand::Seek(_)) => true,
            _ => false,
        };
        if replaced {
            self.waiting_commands.pop_back();
        }
        self.waiting_commands.push_back(command);
    }

    /// Counts one more repaint during the change of the session.
    pub fn count_repaint(&mut self) {
        if let Some((_, shown)) = &mut self.change {
            *shown += 1;
        }
    }

    /// Returns the most important activity under way and its progress, for the status line.
    pub fn under_way(&self) -> Option<(Activity, f64)> {
        self.all_under_way().into_iter().next()
    }

    /// Returns all activities under way with their progress, the most important first.
    pub fn all_under_way(&self) -> Vec<(Activity, f64)> {
        let is_silent = self.change.as_ref().is_some_and(|(_, shown)| *shown <= SILENT_REPAINTS);
        let running = self.running.iter().filter(|(activity, _)| *activity != Activity::Change || !is_silent);
        let running = running.map(|(activity, work)| (*activity, work.progress()));
        let queries_under_way =
            REPORTED_QUERIES.iter().filter_map(|(activity, progress, _)| Some((*activity, progress(&self.queries)?)));
        let mut all: Vec<(Activity, f64)> = running.chain(queries_under_way).collect();
        all.sort_by_key(|(activity, _)| *activity);
        // Of several with the same activity, the first is kept.
        all.dedup_by_key(|(activity, _)| *activity);
        all
    }

    /// Whether any work is under way.
    pub fn is_busy(&self) -> bool {
        self.is_changing() || self.queries.is_busy() || !self.running.is_empty()
    }
}
