//! [`Marks`]: what stands on the time line: bookmarks, events, and where branches part. What lies too close to be told
//! apart is one mark.

use std::sync::Arc;

use crate::query::{Grown, Queries, Quick, Same, Shared, Whole};
use crate::session::events::{Event, Gestures, Kind};
use crate::session::scenario::Bookmark;
use crate::session::{Fork, Session};
use crate::settings::number::significant;
use crate::study::comparison::{Compared, Comparison};

/// An instant worth to be found again.
#[derive(Clone, Debug)]
pub(super) struct Mark {
    /// s.
    pub time: f64,
    /// What is there.
    pub words: String,
    pub tone: Tone,
}

/// What a mark is about, what matters most last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Tone {
    /// Something happens.
    Event,
    /// A branch parts.
    Fork,
    /// The base feels most, or an audit fails.
    Peak,
    /// A bookmark.
    Own,
}

/// Marks that are drawn as one.
#[derive(Clone, Debug)]
pub(super) struct Group {
    /// Of the mark in it that matters most, s.
    pub time: f64,
    pub tone: Tone,
    /// From the first of them to the last, s.
    pub span: [f64; 2],
    /// When, s, and what, one after the other; at most so many that they can be read.
    pub lines: Vec<(String, String)>,
    /// How many more there are.
    pub more: usize,
    /// The same as one text.
    pub words: String,
}

/// Marks closer than this are one, points.
const APART: f64 = 10.0;

/// Lines that one of them says.
const LINES: usize = 6;

/// Frames that are read in one repaint: they take a few milliseconds.
const AT_ONCE: usize = 20_000;

/// All marks by time, what matters most first of those at one instant.
pub(super) struct Marking;

/// What the marks depend on.
#[derive(Clone, PartialEq)]
pub(super) struct Marked {
    /// How long a step lasts, s.
    step: f64,
    /// What hands did.
    gestures: Grown<Gestures>,
    /// What else has happened.
    events: Shared<Vec<Event>>,
    peak: Option<Event>,
    bookmarks: Shared<Vec<Bookmark>>,
    forks: Same<Vec<Fork>>,
    /// Runs that are laid over, with their titles.
    others: Vec<(String, Same<Compared>)>,
}

impl Quick for Marking {
    type Input = Marked;
    type Answer = Vec<Mark>;

    fn answer(of: &Marked) -> Vec<Mark> {
        let gestures: Vec<Event> = of.gestures.answer().map_or_else(Vec::new, |all| all.told().collect());
        let told = gestures.iter().chain(&*of.events.0).chain(&of.peak).filter(|event| event.step > 0);
        let event = |event: &Event| {
            let tone = if matches!(event.kind, Kind::Peak | Kind::Fault) { Tone::Peak } else { Tone::Event };
            Mark { time: event.step as f64 * of.step, words: event.words.clone(), tone }
        };
        let own = |mark: &Bookmark| Mark { time: mark.time, words: mark.name.clone(), tone: Tone::Own };
        let fork =
            |fork: &Fork| Mark { time: fork.from, words: format!("a branch parts: {}", fork.title), tone: Tone::Fork };
        let worst = of.others.iter().filter_map(|(title, run)| worst(title, &run.0));
        let mut marks: Vec<Mark> = told
            .map(event)
            .chain(worst)
            .chain(of.bookmarks.0.iter().map(own))
            .chain(of.forks.0.iter().map(fork))
            .collect();
        marks.sort_by(|a, b| a.time.total_cmp(&b.time).then(b.tone.cmp(&a.tone)));
        marks
    }

    fn let_go(of: &mut Marked) {
        of.gestures.let_go();
    }
}

/// Marks on a time line so long, s, and so wide, points, each group as one.
struct Grouping;

impl Quick for Grouping {
    type Input = (Same<Vec<Mark>>, [f64; 2]);
    type Answer = Vec<Group>;

    fn answer((marks, [length, width]): &Self::Input) -> Vec<Group> {
        parted(seen(&marks.0, *length), APART / width.max(1.0) * length)
    }
}

/// Those on a time line so long, s: a bookmark may stand beyond it.
fn seen(marks: &[Mark], length: f64) -> &[Mark] {
    &marks[..marks.partition_point(|mark| mark.time <= length + 1e-9)]
}

/// All of them, as far as the run is read.
pub(super) struct Marks {
    queries: Queries,
    marks: Arc<Vec<Mark>>,
    /// Whether all frames are read.
    pub is_whole: bool,
}

impl Marks {
    /// Of the session and of the runs beside it.
    pub fn of(queries: &Queries, session: &Session, beside: Option<&Comparison>) -> Self {
        let watched = session.events(queries, AT_ONCE);
        let shakes = session.frames().last().is_some_and(|newest| !newest.peaks.is_reactionless());
        let marked = Marked {
            step: session.scenario().step,
            gestures: session.gestures(queries),
            events: watched.answer().map_or_else(|| Shared(Arc::default()), |watched| watched.shared_events()),
            peak: watched.answer().filter(|_| shakes).map(|watched| watched.peak()),
            bookmarks: session.shared_bookmarks(),
            forks: Same(session.forks()),
            others: laid_over(beside).map(|(title, run)| (title.to_owned(), Same(run.clone()))).collect(),
        };
        let marks = queries.ask::<Whole<Marking>>(&marked);
        Self { queries: queries.clone(), marks, is_whole: watched.is_whole }
    }

    /// Marks on a time line so long, s, and so wide, points.
    pub fn on_line(&self, length: f64, width: f64) -> Arc<Vec<Group>> {
        self.queries.ask::<Whole<Grouping>>(&(Same(self.marks.clone()), [length, width]))
    }
}

/// Of the marks that are shown the first after the instant on display, or the last before it, s.
pub(super) fn beside(queries: &Queries, session: &Session, on: bool) -> Option<f64> {
    let (time, step) = (session.frame().time, session.scenario().step);
    let marks = queries.last::<Whole<Marking>>()?;
    let mut times = seen(&marks, session.length()).iter().map(|mark| mark.time);
    match on {
        true => times.find(|mark| *mark > time + 0.5 * step),
        false => times.rfind(|mark| *mark < time - 0.5 * step),
    }
}

/// Runs that are laid over plots and scene, with their titles.
fn laid_over(beside: Option<&Comparison>) -> impl Iterator<Item = (&str, &Arc<Compared>)> {
    let shown = beside.map_or(&[][..], Comparison::entries).iter().filter(|entry| entry.shown);
    shown.filter_map(|entry| Some((entry.title.as_str(), entry.outcome.as_ref().ok()?)))
}

/// The worst moment of such a run, if its base feels the arm.
fn worst(title: &str, run: &Compared) -> Option<Mark> {
    let peaks = run.frames.last().map(|last| &last.peaks).filter(|peaks| !peaks.is_reactionless())?;
    let first = run.frames.iter().find(|frame| frame.peaks.arm_moment >= peaks.arm_moment)?;
    let words = format!("{title}: peak |n_B| {} N m", significant(peaks.arm_moment));
    Some(Mark { time: first.time, words, tone: Tone::Peak })
}

/// Marks by time in groups, so that none is drawn closer to the next than so much, s.
fn parted(marks: &[Mark], near: f64) -> Vec<Group> {
    // Where each begins, and its mark that matters most, the first of equals: there it is drawn.
    let mut groups: Vec<(usize, &Mark)> = Vec::new();
    for (i, mark) in marks.iter().enumerate() {
        let (mut start, mut best) = (i, mark);
        // Joined to the group before, it may be drawn too close to the one before that.
        while let Some((before, other)) = groups.pop_if(|(_, other)| best.time - other.time < near) {
            (start, best) = (before, if other.tone >= best.tone { other } else { best });
        }
        groups.push((start, best));
    }
    let ends = groups.iter().skip(1).map(|(start, _)| *start).chain([marks.len()]);
    groups.iter().zip(ends).map(|((start, best), end)| Group::of(&marks[*start..end], best)).collect()
}

impl Group {
    fn of(marks: &[Mark], best: &Mark) -> Self {
        let line = |mark: &Mark| (format!("{:.3} s", mark.time), mark.words.clone());
        let lines: Vec<(String, String)> = marks.iter().take(LINES).map(line).collect();
        let more = marks.len() - lines.len();
        let mut words: Vec<String> = lines.iter().map(|(when, what)| format!("{what} at {when}")).collect();
        words.extend((more > 0).then(|| format!("and {more} more")));
        let span = [marks.first(), marks.last()].map(|mark| mark.map_or(best.time, |mark| mark.time));
        Self { time: best.time, tone: best.tone, span, lines, more, words: words.join("\n") }
    }
}
