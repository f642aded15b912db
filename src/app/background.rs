//! [`Background`]: what is under way beside the window.

use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::Arc;

use super::change::Change;
use super::given::assess::Assessing;
use super::waiting::{Drawing, Waiting};
use super::{Activity, SessionCommand};
use crate::query::{AtOnce, Job, Poll, Queries, Short, Ticket, Workers};
use crate::session::scenario::Scenario;
use crate::session::{Refusal, Session};
use crate::study::comparison::Ways;
use crate::study::fronts::Fronts;
use crate::study::lengths::Seeking;
use crate::study::tolerance::Studying;

/// Work that changes what is on display once it has ended.
trait Pending<A> {
    /// How much of it is done, from 0 to 1.
    fn progress(&self) -> f64;

    /// Whether it has ended.
    fn has_ended(&mut self) -> bool;

    /// Waits until it has.
    fn wait(&mut self);

    /// Does what is to be done then.
    fn finish(self: Box<Self>, app_state: &mut A);
}

/// A job, what it has come to, and what is to be done then. Nothing comes of a job that broke off.
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

    fn wait(&mut self) {
        self.result = self.job.take().and_then(Job::wait);
    }

    fn finish(self: Box<Self>, app_state: &mut A) {
        (self.then)(app_state, self.result);
    }
}

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

/// What is under way, who does it, and what it changes in `A` once it has ended.
pub(super) struct Background<A> {
    workers: Arc<dyn Workers + Send + Sync>,
    /// Where work waits until the window is drawn; none if it is done at once.
    waiting: Option<Arc<Waiting>>,
    /// What is derived of the session.
    pub queries: Queries,
    /// Woken when a job has ended.
    ctx: Option<egui::Context>,
    /// Work that changes what is on display, in the order in which it began.
    running: Vec<(Activity, Box<dyn Pending<A>>)>,
    /// The change of the session that is being made, and for how many repaints.
    pub change: Option<(Change, u32)>,
    /// What is to be done after that.
    pub later: VecDeque<SessionCommand>,
}

/// What queries are spoken of: their activity, how far they are, and what stops them.
type Told = (Activity, fn(&Queries) -> Option<f64>, fn(&Queries));

const TOLD: [Told; 5] = [
    (Activity::Table, Queries::progress::<Assessing>, Queries::stop::<Assessing>),
    (Activity::Study, Queries::progress::<Studying>, Queries::stop::<Studying>),
    (Activity::Seeking, Queries::progress::<Seeking>, Queries::stop::<Seeking>),
    (Activity::Fronts, Queries::progress::<Fronts>, Queries::stop::<Fronts>),
    (Activity::Ways, Queries::progress::<Ways>, Queries::stop::<Ways>),
];

impl<A> Default for Background<A> {
    fn default() -> Self {
        Self {
            workers: Arc::new(AtOnce),
            waiting: None,
            queries: Queries::default(),
            ctx: None,
            running: Vec::new(),
            change: None,
            later: VecDeque::new(),
        }
    }
}

impl<A> Background<A> {
    /// Has everything done by somebody from now on.
    pub fn hire(&mut self, workers: impl Workers + Send + Sync + 'static) {
        let waiting = Arc::new(Waiting::new(workers));
        self.workers = waiting.clone();
        self.waiting = Some(waiting);
        self.queries.hire(self.workers.clone());
    }

    /// The window is drawn from now on.
    pub fn drawing(&self) -> Drawing {
        Drawing::begin(self.waiting.as_ref())
    }

    /// Repaints this whenever a job has ended.
    pub fn wakes(&mut self, ctx: &egui::Context) {
        if self.ctx.is_none() {
            self.ctx = Some(ctx.clone());
            let ctx = ctx.clone();
            self.queries.wakes(move || ctx.request_repaint());
        }
    }

    /// Starts work beside the window that nobody waits for.
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

    /// Does work beside the window, and something with what it has come to.
    pub fn run<T: Send + 'static>(
        &mut self,
        activity: Activity,
        work: impl FnOnce(&Ticket) -> T + Send + 'static,
        then: impl FnOnce(&mut A, Option<T>) + 'static,
    ) {
        let job = match activity {
            // Most are made by the next repaint.
            Activity::Change => self.start_by(&Short(&*self.workers), work),
            _ => self.start_by(&*self.workers, work),
        };
        self.running.push((activity, Box::new(Running { job: Some(job), result: None, then })));
    }

    /// The first work that has ended and whose turn it is, taken out: what is done to the session comes before another
    /// session is opened, and of one activity the first ends first.
    pub fn ended(&mut self) -> Option<impl FnOnce(&mut A) + use<A>> {
        let is_changing = self.is_changing();
        let (mut place, mut before) = (None, Vec::new());
        for (i, (activity, work)) in self.running.iter_mut().enumerate() {
            let waits = before.contains(activity) || (*activity == Activity::Opening && is_changing);
            if !waits && work.has_ended() {
                place = Some(i);
                break;
            }
            before.push(*activity);
        }
        let (_, work) = self.running.remove(place?);
        Some(|app_state: &mut A| work.finish(app_state))
    }

    /// Whether such work is under way.
    pub fn runs(&self, activity: Activity) -> bool {
        self.running.iter().any(|(own, _)| *own == activity)
    }

    /// Stops it.
    pub fn stop(&mut self, activity: Activity) {
        self.running.retain(|(own, _)| *own != activity);
        if let Some((_, _, stop)) = TOLD.iter().find(|(own, ..)| *own == activity) {
            stop(&self.queries);
        }
        if activity == Activity::Change {
            self.change = None;
            self.later.clear();
        }
    }

    /// Waits for the end of such work; nothing is done then.
    pub fn wait_for(&mut self, activity: Activity) {
        if let Some(waiting) = &self.waiting {
            waiting.open();
        }
        self.running.iter_mut().filter(|(own, _)| *own == activity).for_each(|(_, work)| work.wait());
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
        if let Some((_, shown)) = &mut self.change {
            *shown += 1;
        }
    }

    /// What is under way and how far it is, for the line at the bottom.
    pub fn under_way(&self) -> Option<(Activity, f64)> {
        self.all_under_way().into_iter().next()
    }

    /// All that is under way, what matters most first.
    pub fn all_under_way(&self) -> Vec<(Activity, f64)> {
        let is_unspoken = self.change.as_ref().is_some_and(|(_, shown)| *shown <= UNSPOKEN);
        let running = self.running.iter().filter(|(activity, _)| *activity != Activity::Change || !is_unspoken);
        let running = running.map(|(activity, work)| (*activity, work.progress()));
        let told = TOLD.iter().filter_map(|(activity, progress, _)| Some((*activity, progress(&self.queries)?)));
        let mut all: Vec<(Activity, f64)> = running.chain(told).collect();
        all.sort_by_key(|(activity, _)| *activity);
        // Of several of one kind the first.
        all.dedup_by_key(|(activity, _)| *activity);
        all
    }

    /// Whether anything at all is under way.
    pub fn is_busy(&self) -> bool {
        self.is_changing() || self.queries.is_busy() || !self.running.is_empty()
    }
}
