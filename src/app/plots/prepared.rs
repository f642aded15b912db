//! What plots show, made when it changes and kept until then.

use std::sync::Arc;

use crate::picture::charts::choice::{Choice, Plot};
use crate::picture::charts::drawn::Drawn;
use crate::picture::charts::range::Extent;
use crate::session::{Made, Session};
use crate::simulation::frame::Frame;
use crate::simulation::signals::Signal;
use crate::study::comparison::{Compared, Comparison};
use crate::study::samples::Samples;

/// The samples of the runs on display, and what is drawn of them.
#[derive(Default)]
pub struct Prepared {
    samples: Samples,
    others: Vec<Other>,
    key: Option<Key>,
    drawn: Vec<Drawn>,
    /// A signal is to be sought.
    looks: bool,
}

/// A run that is laid over.
struct Other {
    place: usize,
    run: Arc<Compared>,
    made: Made,
    samples: Samples,
}

/// All that the drawn lines depend on.
#[derive(PartialEq)]
struct Key {
    made: Made,
    count: usize,
    last: Option<Frame>,
    names: Vec<String>,
    choice: Choice,
    others: Vec<(usize, Made, usize)>,
    shown: [f64; 2],
    columns: usize,
}

/// Frames taken up in one repaint: of ten signals they take a few milliseconds.
const AT_ONCE: usize = 4_000;

/// How much time there is to show of a session.
pub fn extent(session: &Session) -> Extent {
    let (now, end) = (session.frame().time, session.frames().last().map_or(0.0, |f| f.time).max(session.length()));
    match session.is_led() {
        true => Extent::open_ended(session.run().planned_time(), end, now),
        false => Extent::of(end, now),
    }
}

impl Prepared {
    /// Makes what has changed; whether that was all of it.
    pub fn follow(
        &mut self,
        session: &Session,
        comparison: Option<&Comparison>,
        plots: &[Plot<'_>],
        choice: &Choice,
        columns: usize,
    ) -> bool {
        let shown = extent(session).shown(choice.range);
        let mut wanted: Vec<&Signal> = Vec::new();
        for plot in plots {
            for signal in plot.curves.iter().map(|curve| curve.signal).chain(plot.against) {
                if !wanted.iter().any(|known| known.path == signal.path) {
                    wanted.push(signal);
                }
            }
        }
        let own = self.samples.follow_some(session.made(), session.frames(), &wanted, AT_ONCE);
        let all = self.lay_over(comparison, &wanted) && own;
        let key = Key {
            made: session.made().clone(),
            count: self.samples.times().len(),
            last: self.samples.times().len().checked_sub(1).and_then(|i| session.frames().get(i).copied()),
            names: plots.iter().map(|plot| plot.name.clone()).collect(),
            choice: choice.clone(),
            others: self.others.iter().map(|o| (o.place, o.made.clone(), o.samples.times().len())).collect(),
            shown,
            columns,
        };
        if self.key.as_ref() == Some(&key) {
            return all;
        }
        let others: Vec<(usize, &Samples)> = self.others.iter().map(|other| (other.place, &other.samples)).collect();
        let of = |plot: &Plot<'_>| Drawn::of(plot, &self.samples, &others, shown, columns, choice.statistics);
        self.drawn = plots.iter().map(of).collect();
        self.key = Some(key);
        all
    }

    fn lay_over(&mut self, comparison: Option<&Comparison>, wanted: &[&Signal]) -> bool {
        let mut all = true;
        let mut known = std::mem::take(&mut self.others);
        let entries = comparison.map_or(&[][..], Comparison::entries).iter().enumerate();
        for (place, run) in entries.filter(|(_, e)| e.shown).filter_map(|(i, e)| Some((i, e.outcome.as_ref().ok()?))) {
            let mut other = match known.iter().position(|other| Arc::ptr_eq(&other.run, run)) {
                Some(i) => known.swap_remove(i),
                None => Other { place, run: run.clone(), made: Made::new(), samples: Samples::default() },
            };
            other.place = place;
            all &= other.samples.follow_some(&other.made, &other.run.frames, wanted, AT_ONCE);
            self.others.push(other);
        }
        all
    }

    /// Has a signal sought in the next pass.
    pub fn look_for(&mut self) {
        self.looks = true;
    }

    /// Whether one is to be sought now.
    pub fn is_to_look(&mut self) -> bool {
        std::mem::take(&mut self.looks)
    }

    /// What is drawn of each plot.
    pub fn drawn(&self) -> &[Drawn] {
        &self.drawn
    }

    /// The session's own samples.
    pub fn samples(&self) -> &Samples {
        &self.samples
    }
}
