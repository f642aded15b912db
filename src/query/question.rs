//! A [`Query`]: a question whose answer follows from its input alone.

/// A question whose answer follows from its input alone, with the work of answering it.
pub trait Query: Send + Sized + 'static {
    /// All that the answer depends on. Copies are made only where it has changed.
    type Input: Clone + PartialEq + Send + 'static;
    /// What it comes to.
    type Answer: Send + Sync + 'static;

    /// Whether work that has begun ends although another input is asked about by then: short work does, so that answers
    /// keep coming while the input changes all the time.
    const ENDS: bool = false;

    /// The work, yet to be done.
    fn begin(input: Self::Input) -> Self;

    /// Does a portion of it, best of some milliseconds at most. One that takes longer tells how much is done of all of
    /// it, from 0 to 1, and hears whether the rest is still wanted.
    fn go_on(&mut self, goes_on: Watch<'_>) -> Portion<Self::Answer>;

    /// Takes out of an input that was answered what it is not compared by: see [`Grown::let_go`](super::Grown::let_go).
    fn let_go(_: &mut Self::Input) {}
}

/// Told how much is done, from 0 to 1; says whether the rest is still wanted.
pub type Watch<'a> = &'a mut dyn FnMut(f64) -> bool;

/// The same of a part of the work, from one share of the whole to another.
pub fn part(goes_on: Watch<'_>, [from, to]: [f64; 2]) -> impl FnMut(f64) -> bool {
    move |done| goes_on(from + (to - from) * done)
}

/// What a portion of work has come to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Portion<A> {
    /// How much is done of all of it, from 0 to 1.
    More(f64),
    /// The answer.
    Done(A),
    /// Nothing: it heard that the rest is not wanted.
    Stopped,
}

/// The answer to an input, at once and not kept.
pub fn answered<Q: Query>(input: Q::Input) -> Q::Answer {
    let mut work = Q::begin(input);
    loop {
        // All of it is wanted, so it never stops.
        if let Portion::Done(answer) = work.go_on(&mut |_| true) {
            return answer;
        }
    }
}

/// A query that is answered in one portion.
pub trait Quick: 'static {
    /// As [`Query::Input`].
    type Input: Clone + PartialEq + Send + 'static;
    /// As [`Query::Answer`].
    type Answer: Send + Sync + 'static;

    /// The answer.
    fn answer(input: &Self::Input) -> Self::Answer;

    /// As [`Query::let_go`].
    fn let_go(_: &mut Self::Input) {}
}

/// The work of a quick query.
pub struct Whole<Q: Quick>(Q::Input);

impl<Q: Quick> Query for Whole<Q> {
    type Input = Q::Input;
    type Answer = Q::Answer;

    const ENDS: bool = true;

    fn begin(input: Q::Input) -> Self {
        Self(input)
    }

    fn go_on(&mut self, _: Watch<'_>) -> Portion<Q::Answer> {
        Portion::Done(Q::answer(&self.0))
    }

    fn let_go(input: &mut Q::Input) {
        Q::let_go(input);
    }
}
