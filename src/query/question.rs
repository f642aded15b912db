//! [`Query`]: a computation whose answer depends on its input alone.

/// A computation whose answer depends on its input alone, with its work in progress.
pub trait Query: Send + Sized + 'static {
    /// Everything that the answer depends on. It is cloned only when it has changed.
    type Input: Clone + PartialEq + Send + 'static;
    /// Result of the computation.
    type Answer: Send + Sync + 'static;

    /// Whether work under way runs to its end even if another input is requested meanwhile. Short work does, so that
    /// answers keep coming while the input changes continuously.
    const RUNS_TO_END: bool = false;

    /// Returns the work for an input, not yet started.
    fn begin(input: Self::Input) -> Self;

    /// Does a portion of the work, a few milliseconds at most if possible. A longer portion calls `goes_on` with the
    /// fraction done, from 0 to 1, and stops if it returns `false`.
    fn go_on(&mut self, goes_on: ProgressCallback<'_>) -> Portion<Self::Answer>;

    /// Drops those parts of a cached input that are not compared: see
    /// [`IncrementalAnswer::let_go`](super::IncrementalAnswer::let_go).
    fn let_go(_: &mut Self::Input) {}
}

/// Progress callback: takes the fraction done, from 0 to 1; returns whether the work is to continue.
pub type ProgressCallback<'a> = &'a mut dyn FnMut(f64) -> bool;

/// Returns a progress callback for the part of the work between the fractions `from` and `to` of the whole.
pub fn part(goes_on: ProgressCallback<'_>, [from, to]: [f64; 2]) -> impl FnMut(f64) -> bool {
    move |done| goes_on(from + (to - from) * done)
}

/// Outcome of a portion of work.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Portion<A> {
    /// More work remains. Fraction done of the whole, from 0 to 1.
    More(f64),
    /// The answer.
    Done(A),
    /// No answer: the progress callback ended the work.
    Stopped,
}

/// Returns the answer to an input, computed at once and without a cache entry.
pub fn answer_now<Q: Query>(input: Q::Input) -> Q::Answer {
    let mut work = Q::begin(input);
    loop {
        // The callback always continues, so the work never stops early.
        if let Portion::Done(answer) = work.go_on(&mut |_| true) {
            return answer;
        }
    }
}

/// Returns the answer to an input, computed at once and without a cache entry; `None` if `goes_on` ends the work. It is
/// called between portions, too.
pub fn answer_while<Q: Query>(input: Q::Input, goes_on: ProgressCallback<'_>) -> Option<Q::Answer> {
    let mut work = Q::begin(input);
    loop {
        match work.go_on(goes_on) {
            Portion::Done(answer) => return Some(answer),
            Portion::More(done) if goes_on(done) => {}
            Portion::More(_) | Portion::Stopped => return None,
        }
    }
}

/// A query that is computed in one portion.
pub trait QuickQuery: 'static {
    /// As [`Query::Input`].
    type Input: Clone + PartialEq + Send + 'static;
    /// As [`Query::Answer`].
    type Answer: Send + Sync + 'static;

    /// Returns the answer.
    fn answer(input: &Self::Input) -> Self::Answer;

    /// As [`Query::let_go`].
    fn let_go(_: &mut Self::Input) {}
}

/// Work of a quick query.
pub struct QuickWork<Q: QuickQuery>(Q::Input);

impl<Q: QuickQuery> Query for QuickWork<Q> {
    type Input = Q::Input;
    type Answer = Q::Answer;

    const RUNS_TO_END: bool = true;

    fn begin(input: Q::Input) -> Self {
        Self(input)
    }

    fn go_on(&mut self, _: ProgressCallback<'_>) -> Portion<Q::Answer> {
        Portion::Done(Q::answer(&self.0))
    }

    fn let_go(input: &mut Q::Input) {
        Q::let_go(input);
    }
}
