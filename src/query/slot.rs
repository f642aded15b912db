//! A [`Slot`]: the newest answer of a query, and the work on the next.

use std::any::Any;
use std::sync::Arc;

use super::asked::{Asked, State};
use super::job::{Job, Poll, Workers};
use super::question::{Portion, Query};

/// The answer that is known, with what it is of, and what is under way.
pub(super) struct Slot<Q: Query> {
    known: Option<(Q::Input, Arc<Q::Answer>)>,
    working: Option<Working<Q>>,
    /// What is not worked on again: it was stopped, or broke off.
    left: Option<(Q::Input, State)>,
}

impl<Q: Query> Default for Slot<Q> {
    fn default() -> Self {
        Self { known: None, working: None, left: None }
    }
}

/// A slot of any query.
pub(super) trait Kept: Any + Send {
    /// Whether work is under way.
    fn works(&mut self) -> bool;

    /// How many answers are kept.
    fn count(&self) -> usize;

    /// To be told from others.
    fn as_any(&mut self) -> &mut dyn Any;
}

impl<Q: Query> Kept for Slot<Q> {
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
pub(super) struct Working<Q: Query> {
    of: Q::Input,
    by: By<Q>,
}

/// Who does it.
enum By<Q: Query> {
    /// Somebody beside.
    Job(Job<Option<Q::Answer>>),
    /// Whoever asks, a portion each time; and how much is done.
    Portions(Q, f64),
    /// It has ended.
    Done(Q::Answer),
}

impl<Q: Query> Working<Q> {
    /// Begins it, with somebody who works beside or in portions. It starts when what it replaces has stopped: two searches
    /// for one answer would take processors from each other, and from the window.
    pub fn begin(
        of: Q::Input,
        replaced: Replaced<Q>,
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
            if let Replaced(Some(job)) = replaced {
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

    /// Does a portion, if whoever asks does the work.
    pub fn go_on(&mut self) {
        if let By::Portions(work, share) = &mut self.by {
            match work.go_on(&mut |_| true) {
                Portion::More(done) => *share = done,
                // All of it is wanted.
                Portion::Stopped => {}
                Portion::Done(answer) => self.by = By::Done(answer),
            }
        }
    }
}

/// Work on another input that was told to stop, and may not have heard it yet.
pub(super) struct Replaced<Q: Query>(Option<Job<Option<Q::Answer>>>);

impl<Q: Query> Replaced<Q> {
    fn by_another(work: Option<Working<Q>>) -> Self {
        match work.map(|work| work.by) {
            Some(By::Job(job)) => {
                job.stop();
                Self(Some(job))
            }
            _ => Self(None),
        }
    }
}

/// Called when work has ended.
type Wake = Arc<dyn Fn() + Send + Sync>;

impl<Q: Query> Slot<Q> {
    /// The answer, if it is of this input.
    pub fn known(&self, is_of: impl FnOnce(&Q::Input) -> bool) -> Option<Arc<Q::Answer>> {
        self.known.as_ref().filter(|(of, _)| is_of(of)).map(|(_, answer)| answer.clone())
    }

    /// The newest answer.
    pub fn last(&mut self) -> Option<Arc<Q::Answer>> {
        self.collect();
        self.known.as_ref().map(|(_, answer)| answer.clone())
    }

    /// Takes an answer; work on the same is wanted no more.
    pub fn keep(&mut self, mut of: Q::Input, answer: Arc<Q::Answer>) {
        self.working = self.working.take().filter(|working| working.of != of);
        Q::let_go(&mut of);
        self.known = Some((of, answer));
        self.left = None;
    }

    /// If work on an input is to begin, what it replaces: the input is neither known nor left, and nothing is under way that
    /// ends first. Other work stops.
    pub fn replaced_by(&mut self, input: &Q::Input) -> Option<Replaced<Q>> {
        self.collect();
        let stays = |work: &mut Working<Q>| Q::ENDS || work.of == *input;
        let replaced = Replaced::by_another(self.working.take_if(|work| !stays(work)));
        self.left = self.left.take().filter(|(of, _)| of == input);
        let known = self.known.as_ref().is_some_and(|(of, _)| of == input);
        let new = !(known || self.left.is_some() || self.working.is_some());
        new.then_some(replaced)
    }

    /// Work that whoever asks does, to be done outside of the slot.
    pub fn take_portions(&mut self) -> Option<Working<Q>> {
        let here = self.working.as_ref().is_some_and(|working| matches!(working.by, By::Portions(..)));
        if here { self.working.take() } else { None }
    }

    /// Takes work; that before is wanted no more.
    pub fn work_on(&mut self, working: Working<Q>) {
        self.working = Some(working);
        self.left = None;
        self.collect();
    }

    /// Takes what work has come to.
    pub fn collect(&mut self) {
        let Some(Working { mut of, by }) = self.working.take() else { return };
        let by = match by {
            By::Job(job) => match job.poll() {
                Poll::Working => By::Job(job),
                Poll::Done(Some(answer)) => By::Done(answer),
                // Nobody stops work but by letting go of it.
                Poll::Done(None) | Poll::Broken => {
                    self.left = Some((of, State::Broken));
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
            by => self.working = Some(Working { of, by }),
        }
    }

    /// The newest answer, and what it is to an input.
    pub fn asked(&self, input: &Q::Input) -> Asked<Q::Answer> {
        let last = self.known.as_ref().map(|(_, answer)| answer.clone());
        let is_known = self.known.as_ref().is_some_and(|(of, _)| of == input);
        let state = match (&self.working, &self.left) {
            _ if is_known => State::Known,
            (Some(_), _) => State::UnderWay(self.progress().unwrap_or(0.0)),
            (None, Some((_, state))) => *state,
            (None, None) => State::Broken,
        };
        Asked { last, state }
    }

    /// The newest answer, and what it is to what was asked last.
    pub fn newest(&mut self) -> Option<Asked<Q::Answer>> {
        self.collect();
        let last = self.known.as_ref().map(|(_, answer)| answer.clone());
        let state = match (self.progress(), &self.left, &last) {
            (Some(share), ..) => State::UnderWay(share),
            (None, Some((_, state)), _) => *state,
            (None, None, Some(_)) => State::Known,
            (None, None, None) => return None,
        };
        Some(Asked { last, state })
    }

    /// How much of the work is done, from 0 to 1.
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
            self.left = Some((working.of, State::Stopped));
        }
    }
}
