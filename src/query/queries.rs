//! [`Queries`]: where answers are kept.

use std::any::TypeId;
use std::collections::HashMap;
use std::fmt;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};

use super::asked::Asked;
use super::growing::{Growing, Grown, Growth, Growths};
use super::job::{AtOnce, Workers};
use super::question::{Query, answered};
use super::sequence::Sequence;
use super::slot::{Kept, Slot, Working};

/// Answers that are known, and the work on others. Copies share both.
#[derive(Clone)]
pub struct Queries(Arc<Store>);

/// The same from an input, which is kept in them: they end when nobody else has them.
#[derive(Clone)]
pub struct Asking(Weak<Store>);

impl Asking {
    /// They, or none that are known.
    pub fn queries(&self) -> Queries {
        self.0.upgrade().map_or_else(Queries::default, Queries)
    }
}

impl fmt::Debug for Asking {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Asking")
    }
}

struct Store {
    /// One for each query that was asked, by its own type.
    slots: Mutex<HashMap<TypeId, Box<dyn Kept>>>,
    place: Mutex<Place>,
}

/// How many stores there are: one that keeps itself would never go.
static STORES: AtomicUsize = AtomicUsize::new(0);

impl Drop for Store {
    fn drop(&mut self) {
        STORES.fetch_sub(1, Ordering::SeqCst);
    }
}

/// Who works, and who is told.
struct Place {
    workers: Option<Arc<dyn Workers + Send + Sync>>,
    wake: Option<Arc<dyn Fn() + Send + Sync>>,
}

impl Default for Queries {
    /// Work beside is done at once.
    fn default() -> Self {
        let place = Place { workers: Some(Arc::new(AtOnce)), wake: None };
        STORES.fetch_add(1, Ordering::SeqCst);
        Self(Arc::new(Store { slots: Mutex::default(), place: Mutex::new(place) }))
    }
}

impl fmt::Debug for Queries {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Queries({})", self.slots().len())
    }
}

impl Queries {
    /// For an input that asks others.
    pub fn asking(&self) -> Asking {
        Asking(Arc::downgrade(&self.0))
    }

    /// Has work done beside by somebody from now on.
    pub fn hire(&self, workers: Arc<dyn Workers + Send + Sync>) {
        self.place().workers = Some(workers);
    }

    /// From now on work is done in portions, one for each time it is asked about.
    pub fn work_in_portions(&self) {
        self.place().workers = None;
    }

    /// Calls this whenever work beside has ended.
    pub fn wakes(&self, wake: impl Fn() + Send + Sync + 'static) {
        self.place().wake = Some(Arc::new(wake));
    }

    /// The answer, at once.
    pub fn ask<Q: Query>(&self, input: &Q::Input) -> Arc<Q::Answer> {
        self.ask_if::<Q>(|known| known == input, || input.clone())
    }

    /// The same of an input that is made only if it is not the one that is known.
    pub fn ask_if<Q: Query>(
        &self,
        is_known: impl FnOnce(&Q::Input) -> bool,
        input: impl FnOnce() -> Q::Input,
    ) -> Arc<Q::Answer> {
        if let Some(answer) = self.slot::<Q, _>(|slot| slot.known(is_known)) {
            return answer;
        }
        let input = input();
        // The slots are free meanwhile: what is asked may ask others.
        let answer = Arc::new(answered::<Q>(input.clone()));
        self.slot::<Q, _>(|slot| slot.keep(input, answer.clone()));
        answer
    }

    /// The answer if it is known; if not, it is worked on beside, and there is the last one so long.
    pub fn ask_beside<Q: Query>(&self, input: &Q::Input) -> Asked<Q::Answer> {
        if let Some(replaced) = self.slot::<Q, _>(|slot| slot.replaced_by(input)) {
            let (workers, wake) = {
                let place = self.place();
                (place.workers.clone(), place.wake.clone())
            };
            // Begun outside of the slots, as work that is done at once may ask others.
            let work = Working::begin(input.clone(), replaced, workers.as_deref(), wake);
            self.slot::<Q, _>(|slot| slot.work_on(work));
        } else if let Some(mut work) = self.slot::<Q, _>(|slot| slot.take_portions()) {
            work.go_on();
            self.slot::<Q, _>(|slot| slot.work_on(work));
        }
        self.slot::<Q, _>(|slot| slot.asked(input))
    }

    /// The answer, if it is known.
    pub fn known<Q: Query>(&self, input: &Q::Input) -> Option<Arc<Q::Answer>> {
        self.slot::<Q, _>(|slot| {
            slot.collect();
            slot.known(|known| known == input)
        })
    }

    /// The newest answer, whatever it is of; none if there is none.
    pub fn last<Q: Query>(&self) -> Option<Arc<Q::Answer>> {
        self.slot::<Q, _>(|slot| slot.last())
    }

    /// How much of the work beside is done, from 0 to 1, while it is under way.
    pub fn progress<Q: Query>(&self) -> Option<f64> {
        self.slot::<Q, _>(|slot| {
            slot.collect();
            slot.progress()
        })
    }

    /// The newest answer, and how it stands to the input that was asked about last; none if nothing was asked beside.
    pub fn newest<Q: Query>(&self) -> Option<Asked<Q::Answer>> {
        self.slot::<Q, _>(|slot| slot.newest())
    }

    /// Whether any work beside is under way.
    pub fn is_busy(&self) -> bool {
        self.slots().values_mut().any(|slot| slot.works())
    }

    /// Stops work that is under way; it is not begun again until the input changes.
    pub fn stop<Q: Query>(&self) {
        self.slot::<Q, _>(Slot::stop);
    }

    /// Gives up work that is under way; what is known stays, and what is not is begun anew when it is asked about.
    pub fn give_up<Q: Query>(&self) {
        if self.progress::<Q>().is_some() {
            self.forget::<Q>();
        }
    }

    /// Stops work and forgets the answer.
    pub fn forget<Q: Query>(&self) {
        self.slots().remove(&TypeId::of::<Slot<Q>>());
    }

    /// The answer that grows with a sequence, once it has taken what there is more than before, so many items at most.
    /// Nothing is copied while nobody else keeps the answer.
    pub fn grow<G: Growing>(&self, input: &G::Input, items: &Sequence<G::Item>, at_most: usize) -> Grown<G> {
        let known = self.kept(|growths: &mut Growths<G>| growths.take(items.revision()));
        let mut growth = known.unwrap_or_else(|| Growth::begin(items.revision(), input));
        growth.follow(input, items, at_most);
        let grown = growth.grown(items.len());
        self.kept(|growths: &mut Growths<G>| growths.keep(growth));
        grown
    }

    /// How many answers are kept: of a growing one, one for each sequence.
    pub fn count(&self) -> usize {
        self.slots().values().map(|slot| slot.count()).sum()
    }

    /// Stops all work and forgets all answers.
    pub fn forget_all(&self) {
        self.slots().clear();
    }

    /// How many stores there are in this program. None is left once every window and recording is gone.
    pub fn stores() -> usize {
        STORES.load(Ordering::SeqCst)
    }

    fn slot<Q: Query, T>(&self, with: impl FnOnce(&mut Slot<Q>) -> T) -> T {
        self.kept(with)
    }

    fn kept<S: Kept + Default, T>(&self, with: impl FnOnce(&mut S) -> T) -> T {
        let mut slots = self.slots();
        let slot = slots.entry(TypeId::of::<S>()).or_insert_with(|| Box::new(S::default()));
        match slot.as_any().downcast_mut() {
            Some(slot) => with(slot),
            // Of its own type there is no other.
            None => with(&mut S::default()),
        }
    }

    fn slots(&self) -> MutexGuard<'_, HashMap<TypeId, Box<dyn Kept>>> {
        // What a panic left is whole: slots change in one go.
        self.0.slots.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn place(&self) -> MutexGuard<'_, Place> {
        self.0.place.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
