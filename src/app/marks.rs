//! [`Marks`]: marks on the time line: bookmarks, notes, events, and the starts of branches. Marks closer than a minimum
//! distance are drawn as one.

use std::sync::Arc;

use stillbase_query::{ByIdentity, IncrementalAnswer, Queries, QuickQuery, QuickWork, Shared};
use stillbase_session::events::{Event, EventKind, Gestures};
use stillbase_session::scenario::{Bookmark, Note};
use stillbase_session::{Fork, Session};
use stillbase_settings::number::significant;
use stillbase_study::comparison::{ComparedRun, Comparison};

/// A marked instant.
#[derive(Clone, Debug)]
pub(super) struct TimelineMark {
    /// Time, s.
    pub time: f64,
    /// Its description.
    pub words: String,
    pub tone: Tone,
}

/// Kind of a mark, the most important last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Tone {
    /// An event.
    Event,
    /// The start of a branch.
    Fork,
    /// The peak of the base reaction, or a failed audit.
    Peak,
    /// A note.
    Note,
    /// A bookmark.
    Bookmark,
}

/// Marks that are drawn as one.
#[derive(Clone, Debug)]
pub(super) struct MarkGroup {
    /// Time of its most important mark, s.
    pub time: f64,
    pub tone: Tone,
    /// Times of its first and last mark, s.
    pub span: [f64; 2],
    /// Time, s, and description of its marks; at most `MAX_LINES`.
    pub lines: Vec<(String, String)>,
    /// Number of marks without a line.
    pub more: usize,
    /// The lines as one text.
    pub words: String,
}

/// Marks closer than this are drawn as one, points.
const MIN_SEPARATION_PT: f64 = 10.0;

/// Maximum number of lines in the text of a group.
const MAX_LINES: usize = 6;

/// Number of frames read in one repaint, which takes a few milliseconds.
const FRAMES_PER_REPAINT: usize = 20_000;

/// Query for all marks, sorted by time; of marks at one instant, the most important first.
pub(super) struct MarksByTime;

/// Input of the query for marks.
#[derive(Clone, PartialEq)]
pub(super) struct MarksInput {
    /// Time step, s.
    step: f64,
    /// Gestures of the user.
    gestures: IncrementalAnswer<Gestures>,
    /// Other events.
    events: Shared<Vec<Event>>,
    peak: Option<Event>,
    bookmarks: Shared<Vec<Bookmark>>,
    notes: Shared<Vec<Note>>,
    forks: ByIdentity<Vec<Fork>>,
    /// Runs shown in comparison, with their titles.
    others: Vec<(String, ByIdentity<ComparedRun>)>,
}

impl QuickQuery for MarksByTime {
    type Input = MarksInput;
    type Answer = Vec<TimelineMark>;

    fn answer(of: &MarksInput) -> Vec<TimelineMark> {
        let gestures: Vec<Event> = of.gestures.answer().map_or_else(Vec::new, |all| all.events().collect());
        let events = gestures.iter().chain(&*of.events.0).chain(&of.peak).filter(|event| event.step > 0);
        let event = |event: &Event| {
            let tone = if matches!(event.kind, EventKind::Peak | EventKind::Fault) { Tone::Peak } else { Tone::Event };
            TimelineMark { time: event.step as f64 * of.step, words: event.words.clone(), tone }
        };
        let own = |mark: &Bookmark| TimelineMark { time: mark.time, words: mark.name.clone(), tone: Tone::Bookmark };
        let note = |note: &Note| {
            let words = format!("note: {}", note.text);
            Some(TimelineMark { time: note.time.start()?, words, tone: Tone::Note })
        };
        let fork = |fork: &Fork| TimelineMark {
            time: fork.from,
            words: format!("a branch parts: {}", fork.title),
            tone: Tone::Fork,
        };
        let worst = of.others.iter().filter_map(|(title, run)| worst(title, &run.0));
        let mut marks: Vec<TimelineMark> = events
            .map(event)
            .chain(worst)
            .chain(of.bookmarks.0.iter().map(own))
            .chain(of.notes.0.iter().filter_map(note))
            .chain(of.forks.0.iter().map(fork))
            .collect();
        marks.sort_by(|a, b| a.time.total_cmp(&b.time).then(b.tone.cmp(&a.tone)));
        marks
    }

    fn let_go(of: &mut MarksInput) {
        of.gestures.let_go();
    }
}

/// Query for the groups of marks on a time line of this length, s, and width, points.
struct Grouping;

impl QuickQuery for Grouping {
    type Input = (ByIdentity<Vec<TimelineMark>>, [f64; 2]);
    type Answer = Vec<MarkGroup>;

    fn answer((marks, [length, width]): &Self::Input) -> Vec<MarkGroup> {
        grouped(within(&marks.0, *length), MIN_SEPARATION_PT / width.max(1.0) * length)
    }
}

/// Returns the marks on a time line of this length, s, without bookmarks and notes beyond its end.
fn within(marks: &[TimelineMark], length: f64) -> &[TimelineMark] {
    &marks[..marks.partition_point(|mark| mark.time <= length + 1e-9)]
}

/// All marks of the frames that have been read so far.
pub(super) struct Marks {
    queries: Queries,
    marks: Arc<Vec<TimelineMark>>,
    /// Whether all frames have been read.
    pub is_whole: bool,
}

impl Marks {
    /// Queries the marks of the session and of the runs shown in comparison.
    pub fn of(queries: &Queries, session: &Session, beside: Option<&Comparison>) -> Self {
        let watched = session.events(queries, FRAMES_PER_REPAINT);
        let shakes = session.frames().last().is_some_and(|newest| !newest.was_reactionless());
        let marked = MarksInput {
            step: session.scenario().step,
            gestures: session.gestures(queries),
            events: watched.answer().map_or_else(|| Shared(Arc::default()), |watched| watched.shared_events()),
            peak: watched.answer().filter(|_| shakes).map(|watched| watched.peak()),
            bookmarks: session.shared_bookmarks(),
            notes: session.shared_notes(),
            forks: ByIdentity(session.forks()),
            others: laid_over(beside).map(|(title, run)| (title.to_owned(), ByIdentity(run.clone()))).collect(),
        };
        let marks = queries.ask::<QuickWork<MarksByTime>>(&marked);
        Self { queries: queries.clone(), marks, is_whole: watched.is_whole }
    }

    /// Returns the groups of marks on a time line of this length, s, and width, points.
    pub fn on_line(&self, length: f64, width: f64) -> Arc<Vec<MarkGroup>> {
        self.queries.ask::<QuickWork<Grouping>>(&(ByIdentity(self.marks.clone()), [length, width]))
    }
}

/// Returns the time, s, of the next mark after the instant on display if `forward`, otherwise of the last mark before
/// it.
pub(super) fn neighbour(queries: &Queries, session: &Session, forward: bool) -> Option<f64> {
    let (time, step) = (session.frame().time, session.scenario().step);
    let marks = queries.last::<QuickWork<MarksByTime>>()?;
    let mut times = within(&marks, session.length()).iter().map(|mark| mark.time);
    match forward {
        true => times.find(|mark| *mark > time + 0.5 * step),
        false => times.rfind(|mark| *mark < time - 0.5 * step),
    }
}

/// Returns the runs shown in plots and scene, with their titles.
fn laid_over(beside: Option<&Comparison>) -> impl Iterator<Item = (&str, &Arc<ComparedRun>)> {
    let shown = beside.map_or(&[][..], Comparison::entries).iter().filter(|entry| entry.shown);
    shown.filter_map(|entry| Some((entry.title.as_str(), entry.outcome.as_ref().ok()?)))
}

/// Returns the mark at the peak base moment of a run, if it has reactions.
fn worst(title: &str, run: &ComparedRun) -> Option<TimelineMark> {
    let peaks = run.frames.last().filter(|last| !last.was_reactionless()).map(|last| &last.peaks)?;
    let first = run.frames.iter().find(|frame| frame.peaks.arm_moment >= peaks.arm_moment)?;
    let words = format!("{title}: peak |n_B| {} N m", significant(peaks.arm_moment));
    Some(TimelineMark { time: first.time, words, tone: Tone::Peak })
}

/// Groups marks, which are sorted by time, so that the drawn marks are at least `min_separation`, s, apart.
fn grouped(marks: &[TimelineMark], min_separation: f64) -> Vec<MarkGroup> {
    // First index and most important mark of each group, the earliest of equal ones. The group is drawn at this mark.
    let mut groups: Vec<(usize, &TimelineMark)> = Vec::new();
    for (i, mark) in marks.iter().enumerate() {
        let (mut start, mut best) = (i, mark);
        // A group never moves to an earlier time, so at most the last one is removed here.
        while let Some((before, other)) = groups.pop_if(|(_, other)| best.time - other.time < min_separation) {
            (start, best) = (before, if other.tone >= best.tone { other } else { best });
        }
        groups.push((start, best));
    }
    let ends = groups.iter().skip(1).map(|(start, _)| *start).chain([marks.len()]);
    groups.iter().zip(ends).map(|((start, best), end)| MarkGroup::of(&marks[*start..end], best)).collect()
}

impl MarkGroup {
    fn of(marks: &[TimelineMark], best: &TimelineMark) -> Self {
        let line = |mark: &TimelineMark| (format!("{:.3} s", mark.time), mark.words.clone());
        let lines: Vec<(String, String)> = marks.iter().take(MAX_LINES).map(line).collect();
        let more = marks.len() - lines.len();
        let mut words: Vec<String> = lines.iter().map(|(when, what)| format!("{what} at {when}")).collect();
        words.extend((more > 0).then(|| format!("and {more} more")));
        let span = [marks.first(), marks.last()].map(|mark| mark.map_or(best.time, |mark| mark.time));
        Self { time: best.time, tone: best.tone, span, lines, more, words: words.join("\n") }
    }
}
