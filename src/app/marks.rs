//! [`Marks`]: what stands on the time line: bookmarks, events, and where branches part. It is made when the run changes;
//! what lies too close to be told apart is one mark.

use std::sync::Arc;

use crate::session::events::{Event, Kind, Watched, gestures};
use crate::session::scenario::Bookmark;
use crate::session::{Fork, Made, Session};
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

/// All of them, and the branches they tell of.
#[derive(Default)]
pub(super) struct Marks {
    watched: Watched,
    /// What hands did, and in which making of the run.
    hands: (Option<Made>, Vec<Event>),
    key: Option<Key>,
    marks: Vec<Mark>,
    forks: Vec<Fork>,
    groups: Vec<Group>,
    /// What the groups were made for: how long the time line is, s and points.
    line: [f64; 2],
}

/// What the marks depend on.
struct Key {
    made: Made,
    events: usize,
    peak: Option<Event>,
    bookmarks: Vec<Bookmark>,
    branches: usize,
    /// Runs that are laid over.
    others: Vec<Arc<Compared>>,
}

/// Marks closer than this are one, points.
const APART: f64 = 10.0;

/// Lines that one of them says.
const LINES: usize = 6;

/// Frames that are read in one repaint: they take a few milliseconds.
const AT_ONCE: usize = 20_000;

impl Marks {
    /// Finds what has changed, of the session and of the runs beside it; whether that was all.
    pub fn follow(&mut self, session: &Session, beside: Option<&Comparison>) -> bool {
        let made = session.made();
        let all = self.watched.follow(made, session.frames(), session.scenario(), AT_ONCE);
        let shakes = session.frames().last().is_some_and(|newest| !newest.peaks.is_reactionless());
        let same = self.key.as_ref().is_some_and(|key| {
            key.made == *made
                && key.events == self.watched.events().len()
                && key.peak.as_ref().map(|peak| peak.step) == shakes.then(|| self.watched.peak_step())
                && key.bookmarks == session.bookmarks()
                && key.branches == session.branch_count()
                && key.others.iter().map(Arc::as_ptr).eq(laid_over(beside).map(|(_, run)| Arc::as_ptr(run)))
        });
        if same {
            return all;
        }
        let step = session.scenario().step;
        if self.hands.0.as_ref() != Some(made) {
            self.hands = (Some(made.clone()), gestures(session.script(), step));
        }
        let key = Key {
            made: made.clone(),
            events: self.watched.events().len(),
            peak: shakes.then(|| self.watched.peak()),
            bookmarks: session.bookmarks().to_vec(),
            branches: session.branch_count(),
            others: laid_over(beside).map(|(_, run)| run.clone()).collect(),
        };
        self.forks = session.forks();
        let told = self.hands.1.iter().chain(self.watched.events()).chain(&key.peak).filter(|event| event.step > 0);
        let event = |event: &Event| {
            let tone = if matches!(event.kind, Kind::Peak | Kind::Fault) { Tone::Peak } else { Tone::Event };
            Mark { time: event.step as f64 * step, words: event.words.clone(), tone }
        };
        let own = |mark: &Bookmark| Mark { time: mark.time, words: mark.name.clone(), tone: Tone::Own };
        let fork =
            |fork: &Fork| Mark { time: fork.from, words: format!("a branch parts: {}", fork.title), tone: Tone::Fork };
        let worst = laid_over(beside).filter_map(|(title, run)| worst(title, run));
        self.marks = told
            .map(event)
            .chain(worst)
            .chain(key.bookmarks.iter().map(own))
            .chain(self.forks.iter().map(fork))
            .collect();
        self.marks.sort_by(|a, b| a.time.total_cmp(&b.time).then(b.tone.cmp(&a.tone)));
        self.key = Some(key);
        self.line = [0.0; 2];
        all
    }

    /// What tells branches from the run on display.
    pub fn forks(&self) -> &[Fork] {
        &self.forks
    }

    /// The first mark after the instant on display, or the last before it, s.
    pub fn beside(&self, session: &Session, on: bool) -> Option<f64> {
        let (time, step) = (session.frame().time, session.scenario().step);
        let mut times = self.seen(session.length()).iter().map(|mark| mark.time);
        match on {
            true => times.find(|mark| *mark > time + 0.5 * step),
            false => times.rfind(|mark| *mark < time - 0.5 * step),
        }
    }

    /// Those on a time line so long, s: a bookmark may stand beyond it.
    fn seen(&self, length: f64) -> &[Mark] {
        &self.marks[..self.marks.partition_point(|mark| mark.time <= length + 1e-9)]
    }

    /// Marks on a time line so long, s, and so wide, points.
    pub fn on_line(&mut self, length: f64, width: f64) -> &[Group] {
        if self.line != [length, width] {
            self.line = [length, width];
            let near = APART / width.max(1.0) * length;
            self.groups = parted(self.seen(length), near);
        }
        &self.groups
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
