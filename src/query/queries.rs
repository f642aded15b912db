//! [`Queries`]: the cache of answers.

use std::any::TypeId;
use std::collections::HashMap;
use std::fmt;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};

use super::growing::{IncrementalAnswer, IncrementalAnswers, IncrementalQuery, IncrementalState};
use super::job::{InlineWorkers, Workers};
use super::query_result::QueryResult;
use super::question::{Query, answer_now};
use super::sequence::Sequence;
use super::slot::{AnySlot, RunningWork, Slot};

/// Cache of answers, with the work in progress on new ones. Clones share both.
#[derive(Clone)]
pub struct Queries(Arc<Store>);

/// Weak reference to [`Queries`], for an input that is itself cached there: it does not keep the cache alive.
#[derive(Clone)]
pub struct WeakQueries(Weak<Store>);

impl WeakQueries {
    /// Returns the cache, or an empty one if it no longer exists.
    pub fn queries(&self) -> Queries {
        self.0.upgrade().map_or_else(Queries::default, Queries)
    }
}

impl fmt::Debug for WeakQueries {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("WeakQueries")
    }
}

struct Store {
    /// One slot for each type of query that was requested.
    slots: Mutex<HashMap<TypeId, Box<dyn AnySlot>>>,
    execution: Mutex<Execution>,
}

/// Number of stores in existence. A store that referred to itself would never be dropped; tests detect that by this
/// count.
static STORE_COUNT: AtomicUsize = AtomicUsize::new(0);

impl Drop for Store {
    fn drop(&mut self) {
        STORE_COUNT.fetch_sub(1, Ordering::SeqCst);
    }
}

/// How background work is run, and the callback after its end.
struct Execution {
    workers: Option<Arc<dyn Workers + Send + Sync>>,
    wake: Option<Arc<dyn Fn() + Send + Sync>>,
}

impl Default for Queries {
    /// Returns an empty cache that does background work at once.
    fn default() -> Self {
        let execution = Execution { workers: Some(Arc::new(InlineWorkers)), wake: None };
        STORE_COUNT.fetch_add(1, Ordering::SeqCst);
        Self(Arc::new(Store { slots: Mutex::default(), execution: Mutex::new(execution) }))
    }
}

impl fmt::Debug for Queries {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Queries({})", self.slots().len())
    }
}

impl Queries {
    /// Returns the answer, computed at once if it is not cached.
    pub fn ask<Q: Query>(&self, input: &Q::Input) -> Arc<Q::Answer> {
        self.ask_if::<Q>(|known| known == input, || input.clone())
    }
}

#[doc(hidden)]
impl Queries {
    /// Returns a weak reference, for an input that makes requests of its own.
    pub fn downgrade(&self) -> WeakQueries {
        WeakQueries(Arc::downgrade(&self.0))
    }

    /// Sets the workers that run background work from now on.
    pub fn set_workers(&self, workers: Arc<dyn Workers + Send + Sync>) {
        self.execution().workers = Some(workers);
    }

    /// Does work in portions from now on, one at each request.
    pub fn work_in_portions(&self) {
        self.execution().workers = None;
    }

    /// Sets the callback for the end of background work.
    pub fn on_finished(&self, wake: impl Fn() + Send + Sync + 'static) {
        self.execution().wake = Some(Arc::new(wake));
    }

    /// Returns the answer as [`ask`](Self::ask) does, but builds the input only if `is_known` rejects the cached one.
    pub fn ask_if<Q: Query>(
        &self,
        is_known: impl FnOnce(&Q::Input) -> bool,
        input: impl FnOnce() -> Q::Input,
    ) -> Arc<Q::Answer> {
        if let Some(answer) = self.slot::<Q, _>(|slot| slot.known(is_known)) {
            return answer;
        }
        let input = input();
        // The lock is not held meanwhile: the work may make requests of its own.
        let answer = Arc::new(answer_now::<Q>(input.clone()));
        self.slot::<Q, _>(|slot| slot.keep(input, answer.clone()));
        answer
    }

    /// Returns the answer if it is cached. If not, starts or continues background work and returns the last answer
    /// meanwhile.
    pub fn ask_in_background<Q: Query>(&self, input: &Q::Input) -> QueryResult<Q::Answer> {
        if let Some(replaced) = self.slot::<Q, _>(|slot| slot.replaced_by(input)) {
            let (workers, wake) = {
                let execution = self.execution();
                (execution.workers.clone(), execution.wake.clone())
            };
            // Begun without holding the lock, as work that is done at once may make requests of its own.
            let work = RunningWork::begin(input.clone(), replaced, workers.as_deref(), wake);
            self.slot::<Q, _>(|slot| slot.work_on(work));
        } else if let Some(mut work) = self.slot::<Q, _>(|slot| slot.take_portions()) {
            work.go_on();
            self.slot::<Q, _>(|slot| slot.work_on(work));
        }
        self.slot::<Q, _>(|slot| slot.asked(input))
    }

    /// Returns the answer if it is cached.
    pub fn known<Q: Query>(&self, input: &Q::Input) -> Option<Arc<Q::Answer>> {
        self.slot::<Q, _>(|slot| {
            slot.collect();
            slot.known(|known| known == input)
        })
    }

    /// Returns the newest answer, whatever its input; `None` if there is none.
    pub fn last<Q: Query>(&self) -> Option<Arc<Q::Answer>> {
        self.slot::<Q, _>(|slot| slot.last())
    }

    /// Returns the fraction of the background work that is done, from 0 to 1; `None` if no work is under way.
    pub fn progress<Q: Query>(&self) -> Option<f64> {
        self.slot::<Q, _>(|slot| {
            slot.collect();
            slot.progress()
        })
    }

    /// Returns the newest answer and its state relative to the last input requested; `None` without an answer and
    /// without work.
    pub fn newest<Q: Query>(&self) -> Option<QueryResult<Q::Answer>> {
        self.slot::<Q, _>(|slot| slot.newest())
    }

    /// Returns whether any background work is under way.
    pub fn is_busy(&self) -> bool {
        self.slots().values_mut().any(|slot| slot.works())
    }

    /// Stops work that is under way; it does not start again until the input changes.
    pub fn stop<Q: Query>(&self) {
        self.slot::<Q, _>(Slot::stop);
    }

    /// Stops work that is under way and forgets the last answer; the next request starts the work anew. Without such
    /// work, nothing changes.
    pub fn give_up<Q: Query>(&self) {
        if self.progress::<Q>().is_some() {
            self.forget::<Q>();
        }
    }

    /// Stops the work and removes the answer from the cache.
    pub fn forget<Q: Query>(&self) {
        self.slots().remove(&TypeId::of::<Slot<Q>>());
    }

    /// Returns the answer that grows with a sequence, after it has taken at most `at_most` new items. The answer grows
    /// in place while nothing else refers to it; otherwise it is copied.
    pub fn grow<G: IncrementalQuery>(
        &self,
        input: &G::Input,
        items: &Sequence<G::Item>,
        at_most: usize,
    ) -> IncrementalAnswer<G> {
        let known = self.kept(|growths: &mut IncrementalAnswers<G>| growths.take(items.revision()));
        let mut growth = known.unwrap_or_else(|| IncrementalState::begin(items.revision(), input));
        growth.follow(input, items, at_most);
        let grown = growth.grown(items.len());
        self.kept(|growths: &mut IncrementalAnswers<G>| growths.keep(growth));
        grown
    }

    /// Returns the number of cached answers; a growing answer counts once for each sequence.
    pub fn count(&self) -> usize {
        self.slots().values().map(|slot| slot.count()).sum()
    }

    /// Stops all work and removes all answers.
    pub fn forget_all(&self) {
        self.slots().clear();
    }

    /// Returns the number of stores in this program; zero after every window and recording has been dropped.
    pub fn stores() -> usize {
        STORE_COUNT.load(Ordering::SeqCst)
    }

    fn slot<Q: Query, T>(&self, with: impl FnOnce(&mut Slot<Q>) -> T) -> T {
        self.kept(with)
    }

    fn kept<S: AnySlot + Default, T>(&self, with: impl FnOnce(&mut S) -> T) -> T {
        let mut slots = self.slots();
        let slot = slots.entry(TypeId::of::<S>()).or_insert_with(|| Box::new(S::default()));
        match slot.as_any().downcast_mut() {
            Some(slot) => with(slot),
            // Unreachable: the key is the type itself.
            None => with(&mut S::default()),
        }
    }

    fn slots(&self) -> MutexGuard<'_, HashMap<TypeId, Box<dyn AnySlot>>> {
        // A panic leaves slots consistent: each changes in one step.
        self.0.slots.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn execution(&self) -> MutexGuard<'_, Execution> {
        self.0.execution.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
