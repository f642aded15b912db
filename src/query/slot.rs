//! [`Slot`]: the newest answer of a query, and the work on the next one.

use std::any::Any;
use std::sync::Arc;

use super::job::{Job, Poll, Workers};
use super::query_result::{QueryResult, QueryStatus};
use super::question::{Portion, Query};

/// Cache slot of one query: the newest answer with its input, and the work under way.
pub(super) struct Slot<Q: Query> {
    known: Option<(Q::Input, Arc<Q::Answer>)>,
    working: Option<RunningWork<Q>>,
    /// Input whose work was stopped or ended without an answer; it is not tried again.
    given_up: Option<(Q::Input, QueryStatus)>,
}

impl<Q: Query> Default for Slot<Q> {
    fn default() -> Self {
        Self { known: None, working: None, given_up: None }
    }
}

/// A slot of any query, without its type.
pub(super) trait AnySlot: Any + Send {
    /// Returns whether work is under way.
    fn works(&mut self) -> bool;

    /// Returns the number of cached answers.
    fn count(&self) -> usize;

    /// Returns itself, to be cast to its own type.
    fn as_any(&mut self) -> &mut dyn Any;
}

impl<Q: Query> AnySlot for Slot<Q> {
    fn works(&mut self) -> bool {
        self.collect();
        self.working.is_some()
    }

    fn count(&self) -> usize {
        usize::from(self.known.is_some())
    }

    fn as_any(&mut self) -> &mut dyn Any {
        self
    }
}

/// Work on an input.
pub(super) struct RunningWork<Q: Query> {
    of: Q::Input,
    by: By<Q>,
}

/// Where the work is done.
enum By<Q: Query> {
    /// In the background, by a worker.
    Job(Job<Option<Q::Answer>>),
    /// By the caller, a portion at each request; with the fraction done.
    Portions(Q, f64),
    /// The work has ended with this answer.
    Done(Q::Answer),
}

impl<Q: Query> RunningWork<Q> {
    /// Begins work, with workers in the background or else in portions. It starts when the work that it replaces has
    /// stopped. Otherwise two computations of the same query would compete for processors with each other and with the
    /// window.
    pub fn begin(
        of: Q::Input,
        replaced: ReplacedWork<Q>,
        workers: Option<&(dyn Workers + Send + Sync)>,
        wake: Option<Wake>,
    ) -> Self {
        let Some(workers) = workers else {
            let mut new = Self { by: By::Portions(Q::begin(of.clone()), 0.0), of };
            new.go_on();
            return new;
        };
        let input = of.clone();
        let done = move || {
            if let Some(wake) = wake {
                wake();
            }
        };
        let job = Job::start(workers, done, move |ticket| {
            if let ReplacedWork(Some(job)) = replaced {
                job.wait();
            }
            if !ticket.goes_on(0.0) {
                return None;
            }
            let mut work = Q::begin(input);
            loop {
                match work.go_on(&mut |share| ticket.goes_on(share)) {
                    Portion::Done(answer) => return Some(answer),
                    Portion::More(share) if ticket.goes_on(share) => {}
                    Portion::More(_) | Portion::Stopped => return None,
                }
            }
        });
        Self { of, by: By::Job(job) }
    }

    /// Does a portion, if the work is done by the caller.
    pub fn go_on(&mut self) {
        if let By::Portions(work, share) = &mut self.by {
            match work.go_on(&mut |_| true) {
                Portion::More(done) => *share = done,
                // Unreachable: the callback always continues.
                Portion::Stopped => {}
                Portion::Done(answer) => self.by = By::Done(answer),
            }
        }
    }
}

/// Work on an earlier input that was stopped but may still be running.
pub(super) struct ReplacedWork<Q: Query>(Option<Job<Option<Q::Answer>>>);

impl<Q: Query> ReplacedWork<Q> {
    fn by_another(work: Option<RunningWork<Q>>) -> Self {
        match work.map(|work| work.by) {
            Some(By::Job(job)) => {
                job.stop();
                Self(Some(job))
            }
            _ => Self(None),
        }
    }
}

/// Callback after the end of work.
type Wake = Arc<dyn Fn() + Send + Sync>;

impl<Q: Query> Slot<Q> {
    /// Returns the answer if `is_of` accepts its input.
    pub fn known(&self, is_of: impl FnOnce(&Q::Input) -> bool) -> Option<Arc<Q::Answer>> {
        self.known.as_ref().filter(|(of, _)| is_of(of)).map(|(_, answer)| answer.clone())
    }

    /// Returns the newest answer.
    pub fn last(&mut self) -> Option<Arc<Q::Answer>> {
        self.collect();
        self.known.as_ref().map(|(_, answer)| answer.clone())
    }

    /// Stores an answer and drops work on the same input.
    pub fn keep(&mut self, mut of: Q::Input, answer: Arc<Q::Answer>) {
        self.working = self.working.take().filter(|working| working.of != of);
        Q::let_go(&mut of);
        self.known = Some((of, answer));
        self.given_up = None;
    }

    /// Stops work on another input, unless such work runs to its end. New work must begin if the answer is neither
    /// known nor given up and no work remains; then returns the stopped work.
    pub fn replaced_by(&mut self, input: &Q::Input) -> Option<ReplacedWork<Q>> {
        self.collect();
        let stays = |work: &mut RunningWork<Q>| Q::RUNS_TO_END || work.of == *input;
        let replaced = ReplacedWork::by_another(self.working.take_if(|work| !stays(work)));
        self.given_up = self.given_up.take().filter(|(of, _)| of == input);
        let known = self.known.as_ref().is_some_and(|(of, _)| of == input);
        let new = !(known || self.given_up.is_some() || self.working.is_some());
        new.then_some(replaced)
    }

    /// Removes and returns work that is done by the caller, to be continued without holding the lock.
    pub fn take_portions(&mut self) -> Option<RunningWork<Q>> {
        let here = self.working.as_ref().is_some_and(|working| matches!(working.by, By::Portions(..)));
        if here { self.working.take() } else { None }
    }

    /// Stores work in progress and drops the work before it.
    pub fn work_on(&mut self, working: RunningWork<Q>) {
        self.working = Some(working);
        self.given_up = None;
        self.collect();
    }

    /// Stores the answer of work that has ended.
    pub fn collect(&mut self) {
        let Some(RunningWork { mut of, by }) = self.working.take() else { return };
        let by = match by {
            By::Job(job) => match job.poll() {
                Poll::Working => By::Job(job),
                Poll::Done(Some(answer)) => By::Done(answer),
                // Stopped work leaves the slot at once, so a job that is still here without an answer is a fault.
                Poll::Done(None) | Poll::Broken => {
                    self.given_up = Some((of, QueryStatus::Broken));
                    return;
                }
            },
            by => by,
        };
        match by {
            By::Done(answer) => {
                Q::let_go(&mut of);
                self.known = Some((of, Arc::new(answer)));
            }
            by => self.working = Some(RunningWork { of, by }),
        }
    }

    /// Returns the newest answer and its state relative to an input.
    pub fn asked(&self, input: &Q::Input) -> QueryResult<Q::Answer> {
        let last = self.known.as_ref().map(|(_, answer)| answer.clone());
        let is_known = self.known.as_ref().is_some_and(|(of, _)| of == input);
        let state = match (&self.working, &self.given_up) {
            _ if is_known => QueryStatus::Known,
            (Some(_), _) => QueryStatus::UnderWay(self.progress().unwrap_or(0.0)),
            (None, Some((_, state))) => *state,
            (None, None) => QueryStatus::Broken,
        };
        QueryResult { last, state }
    }

    /// Returns the newest answer and its state relative to the last input requested.
    pub fn newest(&mut self) -> Option<QueryResult<Q::Answer>> {
        self.collect();
        let last = self.known.as_ref().map(|(_, answer)| answer.clone());
        let state = match (self.progress(), &self.given_up, &last) {
            (Some(share), ..) => QueryStatus::UnderWay(share),
            (None, Some((_, state)), _) => *state,
            (None, None, Some(_)) => QueryStatus::Known,
            (None, None, None) => return None,
        };
        Some(QueryResult { last, state })
    }

    /// Returns the fraction of the work that is done, from 0 to 1.
    pub fn progress(&self) -> Option<f64> {
        self.working.as_ref().map(|working| match &working.by {
            By::Job(job) => job.progress(),
            By::Portions(_, share) => *share,
            By::Done(_) => 1.0,
        })
    }

    /// Stops the work.
    pub fn stop(&mut self) {
        if let Some(working) = self.working.take() {
            self.given_up = Some((working.of, QueryStatus::Stopped));
        }
    }
}
