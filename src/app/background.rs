//! [`Background`]: what is under way beside the window.

use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::Arc;

use super::change::{Change, NotOpened, Opened};
use super::given::Assessing;
use super::{Activity, SessionCommand};
use crate::query::{AtOnce, Job, Poll, Queries, Short, Ticket, Workers};
use crate::session::scenario::Scenario;
use crate::session::{Refusal, Session};
use crate::study::comparison::{Compared, Ways};
use crate::study::tolerance::Studying;

/// A job and what it is of, while it is under way.
pub(super) type Slot<K, T> = Option<(K, Job<T>)>;

/// A run to keep, with what to say when it is there.
pub(super) type Keeping = (Option<&'static str>, Job<Result<Compared, Refusal>>);

/// What to do with a session that has been opened.
#[derive(Clone, Debug, Default)]
pub(super) struct Opening {
    /// Whether time passes at once.
    pub plays: bool,
    /// Whether the dialog closes that asked for it.
    pub closes: bool,
    /// What to say then.
    pub news: Option<String>,
    /// Where it comes from.
    pub file: Option<File>,
    /// What is opened where this cannot be, and what to say then.
    pub instead: Option<Box<(Scenario, String)>>,
}

/// A file that a session comes from.
#[derive(Clone, Debug)]
pub(super) enum File {
    /// One that the person named.
    Own(PathBuf),
    /// One that the program left behind.
    LeftBehind(PathBuf),
}

/// A session with a change made, or why it was not.
pub(super) type Changed = (Session, Result<Option<String>, Refusal>);

/// Frames that take some milliseconds to free.
const LONG: usize = 20_000;

/// Repaints for which a change is not spoken of: most are made by then.
const UNSPOKEN: u32 = 6;

/// What is under way, and who does it.
pub(super) struct Background {
    workers: Arc<dyn Workers + Send + Sync>,
    /// What is derived of the session.
    pub queries: Queries,
    /// Woken when a job has ended.
    ctx: Option<egui::Context>,
    /// A change of the session, made of a copy; and for how many repaints.
    pub change: Slot<(Change, u32), Changed>,
    /// What is to be done after that.
    pub later: VecDeque<SessionCommand>,
    /// A session that takes the place of the present one.
    pub opening: Slot<Opening, Result<Opened, NotOpened>>,
    /// Runs to keep beside them, each with what to say when it is there.
    pub kept: VecDeque<Keeping>,
    /// What to say when the recording is there.
    pub recording: Slot<(), Result<String, String>>,
    /// What to say when a file is saved; of a session, after how many changes, and where.
    pub saving: Slot<Option<(u64, PathBuf)>, Result<String, String>>,
}

impl Default for Background {
    fn default() -> Self {
        Self {
            workers: Arc::new(AtOnce),
            queries: Queries::default(),
            ctx: None,
            change: None,
            later: VecDeque::new(),
            opening: None,
            kept: VecDeque::new(),
            recording: None,
            saving: None,
        }
    }
}

impl Background {
    /// Has everything done by somebody from now on.
    pub fn hire(&mut self, workers: impl Workers + Send + Sync + 'static) {
        self.workers = Arc::new(workers);
        self.queries.hire(self.workers.clone());
    }

    /// Repaints this whenever a job has ended.
    pub fn wakes(&mut self, ctx: &egui::Context) {
        if self.ctx.is_none() {
            self.ctx = Some(ctx.clone());
            let ctx = ctx.clone();
            self.queries.wakes(move || ctx.request_repaint());
        }
    }

    /// Starts work beside the window.
    pub fn start<T: Send + 'static>(&self, work: impl FnOnce(&Ticket) -> T + Send + 'static) -> Job<T> {
        self.start_by(&*self.workers, work)
    }

    /// The same of work that is done by the next repaint as a rule.
    pub fn start_short<T: Send + 'static>(&self, work: impl FnOnce(&Ticket) -> T + Send + 'static) -> Job<T> {
        self.start_by(&Short(&*self.workers), work)
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

    /// Lets go of a session in whose place there is another; of a long one that shares nothing where nobody waits for it.
    pub fn let_go(&self, old: Session, now: &Session) {
        let shares = now.frames().revision().kept_of(&old.frames().revision().mark()) > 0;
        if old.frames().len() > LONG && !shares {
            drop(self.start(move |_| drop(old)));
        }
    }

    /// Whether the session is being changed: what is done to it has to wait.
    pub fn is_changing(&self) -> bool {
        self.change.is_some() || !self.later.is_empty()
    }

    /// Does something to the session after all that waits already. Of a drag only the newest edit counts, and of
    /// instants to show the newest.
    pub fn after(&mut self, command: SessionCommand) {
        let replaced = match (self.later.back(), &command) {
            (Some(SessionCommand::Edit(earlier)), SessionCommand::Edit(later)) => earlier.is_replaced_by(later),
            (Some(SessionCommand::Seek(_)), SessionCommand::Seek(_)) => true,
            _ => false,
        };
        if replaced {
            self.later.pop_back();
        }
        self.later.push_back(command);
    }

    /// One more repaint during which the session is being changed.
    pub fn count(&mut self) {
        if let Some(((_, shown), _)) = &mut self.change {
            *shown += 1;
        }
    }

    /// What is under way and how far it is, for the line at the bottom.
    pub fn under_way(&self) -> Option<(Activity, f64)> {
        self.all_under_way().next()
    }

    /// All that is under way, what matters most first.
    pub fn all_under_way(&self) -> impl Iterator<Item = (Activity, f64)> {
        let change = self.change.as_ref().filter(|((_, shown), _)| *shown > UNSPOKEN);
        let change = change.map(|(_, job)| (Activity::Change, job.progress()));
        let opening = self.opening.as_ref().map(|(_, job)| (Activity::Opening, job.progress()));
        let recording = self.recording.as_ref().map(|(_, job)| (Activity::Recording, job.progress()));
        let saving = self.saving.as_ref().map(|(_, job)| (Activity::Saving, job.progress()));
        let study = self.queries.progress::<Studying>().map(|share| (Activity::Study, share));
        let ways = self.queries.progress::<Ways>().map(|share| (Activity::Ways, share));
        let given = self.queries.progress::<Assessing>().map(|share| (Activity::Given, share));
        let kept = self.kept.front().map(|(_, job)| (Activity::Kept, job.progress()));
        [change, opening, saving, recording, given, study, ways, kept].into_iter().flatten()
    }

    /// Whether anything at all is under way.
    pub fn is_busy(&self) -> bool {
        self.is_changing() || self.queries.is_busy() || self.under_way().is_some()
    }
}

/// What a job has come to, with what it is of, once it has ended; nothing came of one that broke off.
pub(super) fn ended<K, T: Send + 'static>(slot: &mut Slot<K, T>) -> Option<(K, Option<T>)> {
    let result = match slot.as_ref()?.1.poll() {
        Poll::Working => return None,
        Poll::Done(result) => Some(result),
        Poll::Broken => None,
    };
    slot.take().map(|(of, _)| (of, result))
}
