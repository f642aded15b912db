//! What is derived is made when its input changes, kept until then, and worked on beside.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use stillbase::query::{
    ByIdentity, IncrementalAnswer, IncrementalQuery, Portion, ProgressCallback, Queries, Query, QueryResult,
    QueryStatus, QuickQuery, QuickWork, Sequence, Shared, Work, Workers, answer_now,
};

/// How often something was made: each test has its own.
type Counter = ByIdentity<AtomicUsize>;

fn counter() -> Counter {
    ByIdentity(Arc::new(AtomicUsize::new(0)))
}

fn count(counter: &Counter) -> usize {
    counter.0.load(Ordering::Relaxed)
}

/// A number squared.
struct Square;

impl QuickQuery for Square {
    type Input = (Counter, i64);
    type Answer = i64;

    fn answer((counter, x): &Self::Input) -> i64 {
        counter.0.fetch_add(1, Ordering::Relaxed);
        x * x
    }
}

/// 1 + 2 + … + n, a summand in a portion; 13 breaks off.
struct Sum {
    counter: Counter,
    n: u64,
    at: u64,
    sum: u64,
}

impl Query for Sum {
    type Input = (Counter, u64);
    type Answer = u64;

    fn begin((counter, n): Self::Input) -> Self {
        Self { counter, n, at: 0, sum: 0 }
    }

    fn go_on(&mut self, _: ProgressCallback<'_>) -> Portion<u64> {
        self.counter.0.fetch_add(1, Ordering::Relaxed);
        assert!(self.n != 13, "this one breaks off");
        if self.at == self.n {
            return Portion::Done(self.sum);
        }
        self.at += 1;
        self.sum += self.at;
        Portion::More(self.at as f64 / self.n as f64)
    }
}

/// Someone who does what is given when told to.
#[derive(Clone, Default)]
struct Later(Arc<Mutex<Vec<Work>>>);

impl Workers for Later {
    fn start(&self, work: Work) {
        self.0.lock().expect("no panic").push(work);
    }
}

impl Later {
    fn work(&self) -> usize {
        let all = std::mem::take(&mut *self.0.lock().expect("no panic"));
        let count = all.len();
        all.into_iter().for_each(|work| work());
        count
    }
}

fn with_later() -> (Queries, Later) {
    let (queries, later) = (Queries::default(), Later::default());
    queries.set_workers(Arc::new(later.clone()));
    (queries, later)
}

fn known<A: Copy>(asked: &QueryResult<A>) -> Option<A> {
    asked.known().map(|answer| **answer)
}

#[test]
fn an_answer_is_made_once_for_each_input() {
    let (queries, made) = (Queries::default(), counter());
    let ask = |x: i64| *queries.ask::<QuickWork<Square>>(&(made.clone(), x));
    assert_eq!((ask(3), ask(3), ask(4), ask(4)), (9, 9, 16, 16));
    assert_eq!(count(&made), 2);
    // Copies ask the same store.
    assert_eq!((*queries.clone().ask::<QuickWork<Square>>(&(made.clone(), 4)), count(&made)), (16, 2));
    assert_eq!((ask(3), count(&made)), (9, 3), "only the newest is kept");
    queries.forget::<QuickWork<Square>>();
    assert_eq!((ask(3), count(&made)), (9, 4));
}

#[test]
fn work_beside_shows_the_last_answer_meanwhile() {
    let ((queries, later), made) = (with_later(), counter());
    let woken = counter();
    queries.on_finished({
        let woken = woken.clone();
        move || {
            woken.0.fetch_add(1, Ordering::Relaxed);
        }
    });
    let ask = |n: u64| queries.ask_in_background::<Sum>(&(made.clone(), n));
    let first = ask(4);
    assert!(first.last.is_none() && matches!(first.state, QueryStatus::UnderWay(_)) && queries.is_busy());
    assert_eq!((later.work(), count(&woken)), (1, 1));
    assert_eq!((known(&ask(4)), queries.is_busy()), (Some(10), false));
    let next = ask(5);
    assert_eq!((next.last.as_deref(), known(&next)), (Some(&10), None), "the answer before, and not as this one's");
    later.work();
    assert_eq!(known(&ask(5)), Some(15));
    // An answer at once does for both.
    assert_eq!(*queries.ask::<Sum>(&(made.clone(), 5)), 15);
    let before = count(&made);
    assert_eq!((known(&ask(5)), later.work(), count(&made)), (Some(15), 0, before));
}

#[test]
fn the_newest_asking_counts() {
    let ((queries, later), made) = (with_later(), counter());
    for n in 1..=20 {
        // Each is asked about several times, as by every repaint.
        for _ in 0..3 {
            let _ = queries.ask_in_background::<Sum>(&(made.clone(), n + 20));
        }
    }
    assert_eq!(later.work(), 20);
    // Those before had not begun: nothing is done for them.
    assert_eq!(count(&made), 41);
    assert_eq!(known(&queries.ask_in_background::<Sum>(&(made.clone(), 40))), Some(820));
}

/// A number after some waiting in many portions; tells how many of its kind work at the same time, at most.
struct Slow {
    input: (ByIdentity<[AtomicUsize; 2]>, u64),
    left: u32,
}

impl Query for Slow {
    type Input = (ByIdentity<[AtomicUsize; 2]>, u64);
    type Answer = u64;

    fn begin(input: Self::Input) -> Self {
        let [now, most] = &*input.0.0;
        let working = now.fetch_add(1, Ordering::SeqCst) + 1;
        most.fetch_max(working, Ordering::SeqCst);
        Self { input, left: 20 }
    }

    fn go_on(&mut self, _: ProgressCallback<'_>) -> Portion<u64> {
        std::thread::sleep(std::time::Duration::from_millis(1));
        self.left -= 1;
        if self.left > 0 { Portion::More(0.5) } else { Portion::Done(self.input.1) }
    }
}

impl Drop for Slow {
    fn drop(&mut self) {
        self.input.0.0[0].fetch_sub(1, Ordering::SeqCst);
    }
}

/// Each work on a thread of its own.
struct OnThreads;

impl Workers for OnThreads {
    fn start(&self, work: Work) {
        std::thread::spawn(work);
    }
}

#[test]
fn work_begins_when_what_it_replaces_has_stopped() {
    let queries = Queries::default();
    queries.set_workers(Arc::new(OnThreads));
    let counts = ByIdentity(Arc::new([AtomicUsize::new(0), AtomicUsize::new(0)]));
    let ask = |n: u64| queries.ask_in_background::<Slow>(&(counts.clone(), n));
    for n in 0..40 {
        ask(n);
        // Some of them have begun by then, and others have not.
        std::thread::sleep(std::time::Duration::from_micros(n * 400 % 3000));
    }
    let answer = (0..5000).find_map(|_| {
        std::thread::sleep(std::time::Duration::from_millis(1));
        known(&ask(39))
    });
    assert_eq!(answer, Some(39));
    let [now, most] = &*counts.0;
    assert_eq!((now.load(Ordering::SeqCst), most.load(Ordering::SeqCst)), (0, 1));
}

#[test]
fn short_work_ends_while_the_input_changes_all_the_time() {
    let ((queries, later), made) = (with_later(), counter());
    let ask = |x: i64| queries.ask_in_background::<QuickWork<Square>>(&(made.clone(), x));
    let mut seen = Vec::new();
    for x in 1..=6 {
        seen.push(ask(x).last.map(|answer| *answer));
        if x % 2 == 0 {
            later.work();
        }
    }
    // Those that had begun, one after the other; the newest in the end.
    assert_eq!(seen, [None, None, Some(1), Some(1), Some(9), Some(9)]);
    assert_eq!((known(&ask(6)), later.work(), known(&ask(6)), count(&made)), (None, 1, Some(36), 4));
}

#[test]
fn what_was_stopped_or_broke_off_is_not_begun_again() {
    let ((queries, later), made) = (with_later(), counter());
    let ask = |n: u64| queries.ask_in_background::<Sum>(&(made.clone(), n));
    let _ = ask(6);
    queries.stop::<Sum>();
    later.work();
    assert_eq!((ask(6).state, later.work()), (QueryStatus::Stopped, 0));
    assert_eq!(queries.newest::<Sum>().map(|asked| asked.state), Some(QueryStatus::Stopped));
    let _ = ask(7);
    assert_eq!((later.work(), known(&ask(7))), (1, Some(28)));
    let _ = ask(6);
    assert_eq!((later.work(), known(&ask(6))), (1, Some(21)), "another input lets it begin again");
    let _ = ask(13);
    let broke = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| later.work()));
    assert!(broke.is_err());
    let asked = ask(13);
    assert_eq!((asked.state, asked.last.as_deref(), queries.is_busy()), (QueryStatus::Broken, Some(&21), false));
    assert_eq!(later.work(), 0);
}

#[test]
fn without_threads_work_is_done_in_portions() {
    let (queries, made) = (Queries::default(), counter());
    queries.work_in_portions();
    let ask = |n: u64| queries.ask_in_background::<Sum>(&(made.clone(), n));
    for i in 1..=4 {
        let asked = ask(4);
        assert_eq!((asked.state, count(&made)), (QueryStatus::UnderWay(f64::from(i) / 4.0), i as usize));
    }
    assert_eq!((known(&ask(4)), count(&made), queries.is_busy()), (Some(10), 5, false));
    assert_eq!((known(&ask(4)), count(&made)), (Some(10), 5));
    // What is new begins anew.
    assert_eq!(ask(2).state, QueryStatus::UnderWay(0.5));
    assert_eq!(ask(8).state, QueryStatus::UnderWay(0.125));
}

/// An answer may be asked for while another is made.
struct Twice;

impl QuickQuery for Twice {
    type Input = (ByIdentity<Queries>, i64);
    type Answer = i64;

    fn answer((queries, x): &Self::Input) -> i64 {
        2 * *queries.0.ask::<QuickWork<Square>>(&(counter(), *x))
    }
}

#[test]
fn answers_build_on_others() {
    let queries = Queries::default();
    let same = ByIdentity(Arc::new(queries.clone()));
    assert_eq!(*queries.ask::<QuickWork<Twice>>(&(same.clone(), 5)), 50);
    assert_eq!(known(&queries.ask_in_background::<QuickWork<Twice>>(&(same.clone(), 6))), Some(72));
    assert_eq!(answer_now::<QuickWork<Twice>>((same, 7)), 98);
}

#[test]
fn shared_inputs_are_compared_by_what_they_hold_and_same_ones_are_not() {
    let [one, other] = [(); 2].map(|()| Arc::new(vec![1.0, 2.0]));
    assert!(Shared(one.clone()) == Shared(other.clone()) && Shared(one.clone()) != Shared(Arc::new(vec![1.0])));
    assert!(ByIdentity(one.clone()) == ByIdentity(one.clone()) && ByIdentity(one) != ByIdentity(other));
}

/// Sums of the first so many numbers, with an input that they are multiplied by; how many it was given in all.
#[derive(Clone)]
struct Sums {
    input: (Counter, u64),
    sums: Vec<u64>,
}

impl IncrementalQuery for Sums {
    type Item = u64;
    type Input = (Counter, u64);

    fn begin(input: &Self::Input) -> Self {
        Self { input: input.clone(), sums: Vec::new() }
    }

    fn count(&self) -> usize {
        self.sums.len()
    }

    fn take(&mut self, items: &[u64]) {
        self.input.0.0.fetch_add(items.len(), Ordering::Relaxed);
        for item in items {
            self.sums.push(self.sums.last().unwrap_or(&0) + self.input.1 * item);
        }
    }

    fn truncate(&mut self, count: usize) {
        // It may go back further than is asked.
        self.sums.truncate(count / 3 * 3);
    }
}

fn sums(grown: &IncrementalAnswer<Sums>) -> Vec<u64> {
    grown.answer().expect("it was not let go").sums.clone()
}

#[test]
fn a_growing_answer_takes_each_item_once() {
    let (queries, made) = (Queries::default(), counter());
    let input = (made.clone(), 1);
    let mut items: Sequence<u64> = (1..=1000).collect();
    let first = queries.grow::<Sums>(&input, &items, 300);
    assert_eq!((sums(&first).len(), first.is_whole, count(&made)), (300, false, 300), "no more than so many");
    let where_it_is = Arc::as_ptr(first.answer().expect("it was not let go"));
    drop(first);
    let mut portions = 1;
    while !queries.grow::<Sums>(&input, &items, 300).is_whole {
        portions += 1;
    }
    assert_eq!((portions, count(&made)), (3, 1000));
    for i in 1001..=1100 {
        items.push(i);
        let grown = queries.grow::<Sums>(&input, &items, 1);
        assert_eq!((grown.is_whole, sums(&grown)[i as usize - 1]), (true, i * (i + 1) / 2));
        assert_eq!(Arc::as_ptr(grown.answer().expect("it was not let go")), where_it_is, "nothing is copied");
    }
    assert_eq!(count(&made), 1100);
    let [one, same] = [(); 2].map(|()| queries.grow::<Sums>(&input, &items, 10));
    assert!(one == same, "nothing has changed");
    items.replace_last(0);
    let other = queries.grow::<Sums>(&input, &items, 10);
    assert!(one != other && sums(&one)[1099] == 1100 * 1101 / 2 && sums(&other)[1099] == 1099 * 1100 / 2);
    assert!(count(&made) <= 1103, "only the last is taken again");
    // Of another input all is.
    let twice = queries.grow::<Sums>(&(made.clone(), 2), &items, usize::MAX);
    assert_eq!((sums(&twice)[1098], count(&made) > 2100), (1099 * 1100, true));
}

/// Copies of a sequence go on in ways of their own, each with an answer of its own.
#[test]
fn copies_of_a_sequence_part() {
    let (queries, made) = (Queries::default(), counter());
    let input = (made.clone(), 1);
    for length in [255, 256, 257, 512, 700] {
        let mut one: Sequence<u64> = (0..length).collect();
        let _ = queries.grow::<Sums>(&input, &one, usize::MAX);
        let mut other = one.clone();
        let before = count(&made);
        for i in 0..5 {
            one.push(i);
            other.push(10 * i);
            assert!(one != other || i == 0);
            for sequence in [&one, &other] {
                let (grown, fresh) = (queries.grow::<Sums>(&input, sequence, usize::MAX), sequence.to_vec());
                let want: Vec<u64> = grown_sums(&fresh);
                assert_eq!(sums(&grown), want);
            }
        }
        assert!(count(&made) - before < 2 * length as usize, "what both begin with is taken twice at most");
        assert_eq!(one.len(), length as usize + 5);
    }
    let all: Sequence<u64> = (0..2000).collect();
    for i in [0, 1, 255, 256, 257, 1999, 2000] {
        assert_eq!(all.partition_point(|x| *x < i), i as usize);
        assert_eq!(all.get(i as usize).copied(), Some(i).filter(|i| *i < 2000));
    }
    assert!(all.iter().rev().copied().eq((0..2000).rev()) && all == (0..2000).collect::<Vec<_>>());
    assert!((&all).into_iter().count() == 2000 && all.from(2000).is_empty() && all[300] == 300);
    assert!(queries.count() <= 2, "of sequences that are gone nothing is kept: {}", queries.count());
}

fn grown_sums(items: &[u64]) -> Vec<u64> {
    let add = |sum: &mut u64, x: &u64| {
        *sum += x;
        Some(*sum)
    };
    items.iter().scan(0, add).collect()
}

/// The largest sum, which depends on a growing answer.
struct Largest;

impl QuickQuery for Largest {
    type Input = (Counter, IncrementalAnswer<Sums>);
    type Answer = u64;

    fn answer((counter, grown): &Self::Input) -> u64 {
        counter.0.fetch_add(1, Ordering::Relaxed);
        grown.answer().and_then(|sums| sums.sums.last().copied()).unwrap_or(0)
    }

    fn let_go((_, grown): &mut Self::Input) {
        grown.let_go();
    }
}

#[test]
fn answers_build_on_growing_ones_without_keeping_them() {
    let (queries, made) = (Queries::default(), counter());
    let input = (counter(), 1);
    let mut items: Sequence<u64> = (1..=10).collect();
    let largest = |items: &Sequence<u64>| {
        let grown = queries.grow::<Sums>(&input, items, usize::MAX);
        let place = Arc::as_ptr(grown.answer().expect("it was not let go"));
        (*queries.ask::<QuickWork<Largest>>(&(made.clone(), grown)), place)
    };
    let (first, place) = largest(&items);
    assert_eq!((first, largest(&items).0, count(&made)), (55, 55, 1));
    items.push(11);
    assert_eq!((largest(&items), count(&made)), ((66, place), 2));
    items.replace_last(1);
    assert_eq!((largest(&items), count(&made)), ((56, place), 3));
}

/// A sequence at random, changed at random: the answer is always that of its items.
#[test]
fn whatever_becomes_of_a_sequence_its_answer_is_that_made_afresh() {
    use proptest::prelude::*;
    use proptest::test_runner::{Config, TestRunner};
    let mut runner = TestRunner::new(Config { cases: 200, failure_persistence: None, ..Config::default() });
    let steps = prop::collection::vec((0..6_u8, 0..400_usize, 1..4_u64), 1..30);
    let result = runner.run(&steps, |steps| {
        let (queries, made) = (Queries::default(), counter());
        let mut all: Vec<Sequence<u64>> = vec![Sequence::default()];
        for (what, n, times) in steps {
            let at = n % all.len();
            match what {
                0 | 1 => (0..n as u64).for_each(|i| all[at].push(i)),
                2 => all[at].replace_last(n as u64),
                3 => all.push(all[at].clone()),
                4 if all.len() > 1 => drop(all.swap_remove(at)),
                4 => all[at] = Sequence::default(),
                _ => {}
            }
            let at = n % all.len();
            let input = (made.clone(), times);
            let mut grown = queries.grow::<Sums>(&input, &all[at], 100);
            while !grown.is_whole {
                grown = queries.grow::<Sums>(&input, &all[at], 100);
            }
            let want: Vec<u64> = all[at].iter().map(|x| times * x).collect();
            prop_assert_eq!(sums(&grown), grown_sums(&want));
            prop_assert_eq!(sums(&grown), stillbase::query::answer_sequence::<Sums>(&input, &all[at]).sums);
        }
        for sequence in &all {
            let _ = queries.grow::<Sums>(&(made.clone(), 1), sequence, 100);
        }
        prop_assert!(queries.count() <= all.len(), "{} of {}", queries.count(), all.len());
        Ok(())
    });
    result.unwrap_or_else(|why| panic!("{why}"));
}
