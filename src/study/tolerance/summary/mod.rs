//! [`Summary`]: the results of any number of machines in bounded memory, which add up exactly.
//!
//! Each of the four numbers of an outcome falls into a bin at most 0.1 % wide. Of a bin the summary holds how many machines
//! it has; of an exponent ([`Octave`]) the least and the greatest number, their machines, and exact sums. Two summaries of
//! different machines of one study add up to the summary of both: in any order and grouping the same, to the last bit.
//! Means and deviations are those of the numbers themselves. Quantiles lie within their bin; they are exact with
//! [`Recount`], for which the machines are drawn again.

mod bin;
mod exact;

use std::collections::BTreeMap;
use std::ops::Range;

use super::report::{Distribution, Distributions, LimitYield, Yields};
use super::statistics::{Histogram, Quantiles, Yield, ranks};
use super::{PartResults, SampleOutcome};

pub use bin::{BIN_WIDTH, Extreme, OCTAVE_BINS, OCTAVES, Octave, bin_of, lower_edge};
pub use exact::{BinPlace, BinValues, KnownRanks, MAX_VALUES, Recount};

/// The numbers of one exponent: their sums, and how many are in each bin.
#[derive(Clone, Debug, PartialEq)]
struct Page {
    octave: Octave,
    bins: Box<[u64]>,
}

impl Page {
    fn new() -> Self {
        Self { octave: Octave::EMPTY, bins: vec![0; OCTAVE_BINS as usize].into() }
    }
}

/// One number of the outcomes of many machines: a page for each exponent that occurs.
#[derive(Clone, Debug, Default, PartialEq)]
struct Pages {
    pages: Vec<Option<Page>>,
}

impl Pages {
    #[inline]
    fn page_mut(&mut self, octave: u64) -> &mut Page {
        let at = octave as usize;
        if self.pages.len() <= at {
            self.pages.resize(at + 1, None);
        }
        self.pages[at].get_or_insert_with(Page::new)
    }

    #[inline]
    fn add(&mut self, x: f64, machine: u64) {
        let bin = bin_of(x);
        let page = self.page_mut(bin / OCTAVE_BINS);
        page.octave.add(x, machine);
        page.bins[(bin % OCTAVE_BINS) as usize] += 1;
    }

    fn filled(&self) -> impl Iterator<Item = (u64, &Page)> {
        (0..).zip(&self.pages).filter_map(|(octave, page)| Some((octave, page.as_ref()?)))
    }

    /// Returns the bins with machines, in ascending order, with their numbers of machines.
    fn bins(&self) -> impl Iterator<Item = (u64, u64)> {
        let all = self.filled().flat_map(|(octave, page)| (octave * OCTAVE_BINS..).zip(page.bins.iter().copied()));
        all.filter(|(_, count)| *count > 0)
    }

    fn merge(&mut self, other: &Self) {
        for (octave, page) in other.filled() {
            let own = self.page_mut(octave);
            own.octave.merge(&page.octave);
            own.bins.iter_mut().zip(&page.bins).for_each(|(own, other)| *own = own.saturating_add(*other));
        }
    }
}

/// Limits of a study, within which a summary counts machines.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// Largest permitted peak |n_B|, N m.
    pub moment: Option<f64>,
    /// Largest permitted peak |f_B|, N.
    pub force: Option<f64>,
}

impl Limits {
    /// Adds a machine to the numbers of those within the limit of the moment, that of the force, and both.
    pub fn count(&self, outcome: &SampleOutcome, kept: &mut [u64; 3]) {
        let within = |limit: Option<f64>, x: f64| limit.is_some_and(|limit| x <= limit);
        let [moment, force] = [within(self.moment, outcome.peak_moment), within(self.force, outcome.peak_force)];
        kept.iter_mut().zip([moment, force, moment && force]).for_each(|(kept, is)| *kept += u64::from(is));
    }

    /// Returns the yields of as many machines, of which so many are within the limit of the moment, that of the force, and
    /// both.
    pub fn yields(&self, kept: [u64; 3], total: u64) -> Yields {
        let of = |limit: Option<f64>, good: u64| LimitYield { limit, count: Yield::new(good, total) };
        Yields {
            moment: self.moment.map(|_| of(self.moment, kept[0])),
            force: self.force.map(|_| of(self.force, kept[1])),
            both: self.moment.and(self.force).map(|_| of(None, kept[2])),
        }
    }
}

/// Results of some machines of a study.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Summary {
    /// Sample numbers of the machines: ascending, with gaps between.
    machines: Vec<Range<u64>>,
    numbers: [Pages; SampleOutcome::NUMBERS],
    limits: Limits,
    /// Number of machines within the limit of the moment, that of the force, and both.
    kept: [u64; 3],
}

/// Why two summaries do not add up.
#[derive(Clone, Debug, PartialEq)]
pub enum Unmergeable {
    /// Both hold these machines.
    Twice(Range<u64>),
    /// Their limits differ.
    Limits(Limits, Limits),
}

impl Summary {
    /// Returns the summary of no machines, which will count those within limits.
    pub fn new(limits: Limits) -> Self {
        Self { limits, ..Self::default() }
    }

    /// Counts consecutive machines, from the sample number `first` on. They must not be in the summary yet; [`hold`] says
    /// that they are.
    ///
    /// [`hold`]: Self::hold
    pub fn add(&mut self, first: u64, outcomes: &[SampleOutcome]) {
        for (machine, outcome) in (first..).zip(outcomes) {
            for (pages, x) in self.numbers.iter_mut().zip(outcome.numbers()) {
                pages.add(x, machine);
            }
            self.limits.count(outcome, &mut self.kept);
        }
    }

    /// Adds machines to a bin of one of the numbers of an outcome, by its place in [`SampleOutcome::numbers`].
    pub fn add_bin(&mut self, number: usize, at: u64, count: u64) {
        let own = &mut self.numbers[number].page_mut(at / OCTAVE_BINS).bins[(at % OCTAVE_BINS) as usize];
        *own = own.saturating_add(count);
    }

    /// Adds the machines of an octave of one of the numbers of an outcome.
    pub fn add_octave(&mut self, number: usize, at: u64, octave: &Octave) {
        self.numbers[number].page_mut(at).octave.merge(octave);
    }

    /// Adds machines within the limit of the moment, that of the force, and both.
    pub fn add_kept(&mut self, kept: [u64; 3]) {
        self.kept.iter_mut().zip(kept).for_each(|(own, kept)| *own = own.saturating_add(kept));
    }

    /// Notes that machines are in the summary. Returns those that were before.
    pub fn hold(&mut self, machines: Range<u64>) -> Option<Range<u64>> {
        if machines.is_empty() {
            return None;
        }
        let at = self.machines.partition_point(|own| own.end < machines.start);
        let twice = self.machines[at..].iter().find(|own| own.start < machines.end && machines.start < own.end);
        if let Some(own) = twice {
            return Some(own.start.max(machines.start)..own.end.min(machines.end));
        }
        // Those that touch become one.
        let until = at + self.machines[at..].iter().take_while(|own| own.start <= machines.end).count();
        let touching = &self.machines[at..until];
        let start = touching.first().map_or(machines.start, |own| own.start.min(machines.start));
        let end = touching.last().map_or(machines.end, |own| own.end.max(machines.end));
        self.machines.splice(at..until, std::iter::once(start..end));
        None
    }

    /// Adds the machines of another summary.
    ///
    /// # Errors
    /// If both hold the same machines, or if their limits differ.
    pub fn merge(&mut self, other: &Self) -> Result<(), Unmergeable> {
        if self.limits != other.limits {
            return Err(Unmergeable::Limits(self.limits, other.limits));
        }
        for machines in &other.machines {
            if let Some(twice) = self.hold(machines.clone()) {
                return Err(Unmergeable::Twice(twice));
            }
        }
        self.numbers.iter_mut().zip(&other.numbers).for_each(|(own, other)| own.merge(other));
        self.add_kept(other.kept);
        Ok(())
    }

    /// Returns the sample numbers of the machines: ascending, with gaps between.
    pub fn machines(&self) -> &[Range<u64>] {
        &self.machines
    }

    /// Returns the number of machines.
    pub fn count(&self) -> u64 {
        self.machines.iter().map(|machines| machines.end - machines.start).sum()
    }

    /// Returns the limits.
    pub fn limits(&self) -> Limits {
        self.limits
    }

    /// Returns the number of machines within the limit of the moment, that of the force, and both; 0 without a limit.
    pub fn kept(&self) -> [u64; 3] {
        self.kept
    }

    /// Returns the bins with machines of one of the numbers of an outcome, in ascending order, with their numbers of
    /// machines.
    pub fn bins(&self, number: usize) -> impl Iterator<Item = (u64, u64)> {
        self.numbers[number].bins()
    }

    /// Returns the octaves of one of the numbers of an outcome, in ascending order, with their exponents.
    pub fn octaves(&self, number: usize) -> impl Iterator<Item = (u64, &Octave)> {
        self.numbers[number].filled().map(|(at, page)| (at, &page.octave))
    }

    /// Returns the octaves of one of the numbers of an outcome, in ascending order, with their exponents and the numbers of
    /// machines of their bins.
    pub fn octaves_with_bins(&self, number: usize) -> impl Iterator<Item = (u64, &Octave, &[u64])> {
        self.numbers[number].filled().map(|(at, page)| (at, &page.octave, &*page.bins))
    }

    /// Returns the least and the greatest number of each octave, with the place of the number in an outcome.
    pub fn extremes(&self) -> impl Iterator<Item = (usize, Extreme)> {
        let all =
            (0..SampleOutcome::NUMBERS).flat_map(|number| self.octaves(number).map(move |(_, own)| (number, own)));
        all.flat_map(|(number, octave)| [(number, octave.least), (number, octave.greatest)])
    }

    /// Returns an octave whose extremes or sums do not fit its bins: the place of the number, and the exponent.
    pub fn implausible(&self) -> Option<(usize, u64)> {
        let all = (0..).zip(&self.numbers).flat_map(|(number, pages)| pages.filled().map(move |page| (number, page)));
        let mut wrong = all.filter(|(_, (octave, page))| !page.octave.is_plausible(*octave, &page.bins));
        wrong.next().map(|(number, (octave, _))| (number, octave))
    }

    /// Returns the machines of a study that are not in the summary, in ascending order.
    pub fn missing(&self, samples: u64) -> Vec<Range<u64>> {
        let ends = [0].into_iter().chain(self.machines.iter().map(|own| own.end));
        let starts = self.machines.iter().map(|own| own.start).chain([samples]);
        ends.zip(starts).map(|(from, to)| from..to).filter(|gap| !gap.is_empty()).collect()
    }

    /// Returns the bins whose numbers have to be collected for exact quantiles, with their counts.
    pub fn quantile_bins(&self) -> BTreeMap<BinPlace, u64> {
        self.open_ranks().map(|(place, _, count)| (place, count)).collect()
    }

    /// Returns the ranks in bins that quantiles need and no extreme tells, with the numbers of machines of the bins.
    fn open_ranks(&self) -> impl Iterator<Item = (BinPlace, u64, u64)> {
        (0..SampleOutcome::NUMBERS).flat_map(|number| {
            let ranked = RankedBins::of(&self.numbers[number]);
            let ranks = Quantiles::LEVELS.iter().filter_map(|level| ranks(ranked.count(), *level));
            let both: Vec<u64> = ranks.flat_map(|(below, above, _)| [below, above]).collect();
            both.into_iter().filter_map(move |rank| {
                let own = ranked.at(rank);
                own.known().is_none().then_some(((number, own.bin), own.rank, own.count))
            })
        })
    }

    /// Keeps what quantiles need of the numbers of bins.
    ///
    /// # Errors
    /// If a bin has other numbers than its count and the extremes of its octave say.
    pub fn learn(&self, values: BinValues, known: &mut KnownRanks) -> Result<(), BinPlace> {
        let values = values.into_sorted();
        for (place, rank, count) in self.open_ranks() {
            let Some(values) = values.get(&place) else { continue };
            let (number, bin) = place;
            let octave = &self.numbers[number].pages[(bin / OCTAVE_BINS) as usize];
            let extremes = octave.as_ref().map(|page| [page.octave.least.value, page.octave.greatest.value]);
            let found = [values.first(), values.last()].map(|x| x.copied().unwrap_or(f64::NAN));
            let fits = extremes.is_some_and(|[least, greatest]| least <= found[0] && found[1] <= greatest);
            if values.len() as u64 != count || !fits {
                return Err(place);
            }
            known.values.insert((place, rank), values[rank as usize]);
        }
        Ok(())
    }

    /// Returns the distributions over the machines; `None` if there are none. Quantiles are exact
    /// where their ranks are known.
    pub fn distributions(&self, known: &KnownRanks) -> Option<Distributions> {
        let of = |number: usize| self.distribution(number, known);
        Some(Distributions { peak_moment: of(0)?, peak_force: of(1)?, rms_moment: of(2)?, rms_force: of(3)? })
    }

    fn distribution(&self, number: usize, known: &KnownRanks) -> Option<Distribution> {
        let ranked = RankedBins::of(&self.numbers[number]);
        let count = ranked.count();
        let mut octaves = self.octaves(number).filter(|(_, octave)| octave.count > 0).map(|(_, octave)| octave);
        let first = octaves.next()?;
        let (least, greatest) = (first.least, octaves.last().unwrap_or(first).greatest);
        let mean = self.octaves(number).map(|(at, octave)| octave.total(at)).sum::<f64>() / count as f64;
        let squares: f64 = self.octaves(number).map(|(at, octave)| octave.squares_about(at, mean)).sum();
        let mut is_exact = true;
        let mut at_rank = |rank: u64| {
            let own = ranked.at(rank);
            let exact = own.known().or_else(|| known.values.get(&((number, own.bin), own.rank)).copied());
            is_exact &= exact.is_some();
            exact.unwrap_or_else(|| own.estimate())
        };
        let mut value = |level: f64| {
            let (below, above, part) = ranks(count, level)?;
            let [low, high] = [below, above].map(&mut at_rank);
            Some(low + part * (high - low))
        };
        let levels = Quantiles::LEVELS;
        let values = levels.iter().map(|level| value(*level)).collect::<Option<Vec<f64>>>()?;
        Some(Distribution {
            mean,
            deviation: (squares.max(0.0) / (count as f64 - 1.0).max(1.0)).sqrt(),
            quantiles: Quantiles { levels: levels.to_vec(), values },
            quantile_error: (!is_exact).then_some(BIN_WIDTH),
            extreme_machines: Some([least.machine, greatest.machine]),
            histogram: histogram(&ranked.bins, [least.value, greatest.value]),
        })
    }

    /// Returns the numbers of machines within the limits.
    pub fn yields(&self) -> Yields {
        self.limits.yields(self.kept, self.count())
    }

    /// Returns the least and the greatest possible number of machines within a limit that were not counted.
    pub fn within(&self, number: usize, limit: f64) -> [u64; 2] {
        let ranked = RankedBins::of(&self.numbers[number]);
        let sum = |is_within: fn([f64; 2], f64) -> bool| {
            let places = ranked.bins.iter().filter(|place| is_within(place.ends(), limit));
            places.map(|place| place.count).sum()
        };
        [sum(|[_, high], limit| high <= limit), sum(|[low, _], limit| low <= limit)]
    }

    /// Returns the results as those of a part of a study; `None` if there are no machines.
    pub fn results(&self, known: &KnownRanks) -> Option<PartResults> {
        let distributions = self.distributions(known)?;
        Some(PartResults { distributions, yields: self.yields(), against_tracking: None })
    }
}

/// A place among the numbers of a bin.
#[derive(Clone, Copy)]
struct RankedBin<'a> {
    bin: u64,
    /// Number of machines of the bin.
    count: u64,
    octave: &'a Octave,
    /// Rank within the bin, from 0.
    rank: u64,
}

impl RankedBin<'_> {
    /// Returns the least and the greatest number that the bin can have.
    fn ends(&self) -> [f64; 2] {
        let [least, greatest] = [self.octave.least, self.octave.greatest].map(|of| of.value);
        [lower_edge(self.bin).max(least), lower_edge(self.bin + 1).next_down().min(greatest)]
    }

    /// Returns the number at the rank, if an extreme of the octave tells it.
    fn known(&self) -> Option<f64> {
        let [least, greatest] = [self.octave.least, self.octave.greatest].map(|of| of.value);
        let is_least = self.rank == 0 && bin_of(least) == self.bin;
        let is_greatest = self.rank + 1 == self.count && bin_of(greatest) == self.bin;
        match () {
            () if is_least || least == greatest => Some(least),
            () => is_greatest.then_some(greatest),
        }
    }

    /// Returns the number at the rank as if those of the bin lay evenly.
    fn estimate(&self) -> f64 {
        let [low, high] = self.ends();
        low + (high - low) * ((self.rank as f64 + 0.5) / self.count as f64)
    }
}

/// Bins in ascending order, and the count of machines up to each.
struct RankedBins<'a> {
    bins: Vec<RankedBin<'a>>,
    ends: Vec<u64>,
}

impl<'a> RankedBins<'a> {
    fn of(pages: &'a Pages) -> Self {
        let all = pages.filled().flat_map(|(octave, page)| {
            let bins = (octave * OCTAVE_BINS..).zip(page.bins.iter().copied());
            bins.map(|(bin, count)| RankedBin { bin, count, octave: &page.octave, rank: 0 })
        });
        let bins: Vec<_> = all.filter(|own| own.count > 0).collect();
        let end = |sum: &mut u64, own: &RankedBin<'_>| {
            *sum += own.count;
            Some(*sum)
        };
        let ends = bins.iter().scan(0, end).collect();
        Self { bins, ends }
    }

    /// Returns the number of machines.
    fn count(&self) -> u64 {
        self.ends.last().copied().unwrap_or(0)
    }

    /// Returns the place of the machine at a rank below the count.
    fn at(&self, rank: u64) -> RankedBin<'a> {
        let place = self.ends.partition_point(|end| *end <= rank);
        let own = self.bins[place];
        RankedBin { rank: rank - (self.ends[place] - own.count), ..own }
    }
}

/// Number of intervals of a histogram.
const INTERVALS: usize = 50;

/// Returns a histogram of bins, ascending: its counts are exact, and its inner edges are edges of bins, as near to equal
/// intervals as they are.
fn histogram(bins: &[RankedBin<'_>], [least, greatest]: [f64; 2]) -> Histogram {
    let even = (1..INTERVALS).map(|i| least + (greatest - least) * i as f64 / INTERVALS as f64);
    let mut edges: Vec<f64> = even.map(|x| lower_edge(bin_of(x))).filter(|x| (least..greatest).contains(x)).collect();
    edges.dedup();
    let edges: Vec<f64> =
        [least].into_iter().chain(edges.into_iter().filter(|x| *x > least)).chain([greatest]).collect();
    let mut counts = vec![0; edges.len() - 1];
    for own in bins {
        let above = edges[1..edges.len() - 1].partition_point(|edge| *edge <= lower_edge(own.bin));
        counts[above] += own.count;
    }
    Histogram { edges, counts }
}
