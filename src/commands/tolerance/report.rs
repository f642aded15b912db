//! What a study comes to, as JSON and as text.

use serde::Serialize;
use stillbase::study::tolerance::{Agreement, Bands, Histogram, Outcome, Parameter, Quantiles, Shares, Yield};

use super::rows::StudyId;
use crate::commands::output::Table;
use stillbase::settings::number::{counted, fixed, shown};

/// A quantity over all machines.
#[derive(Serialize)]
pub struct Distribution {
    mean: f64,
    deviation: f64,
    quantiles: Quantiles,
    histogram: Histogram,
}

const BINS: usize = 50;

impl Distribution {
    fn of(mut values: Vec<f64>) -> Option<Self> {
        values.sort_unstable_by(f64::total_cmp);
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|x| (x - mean).powi(2)).sum();
        Some(Self {
            mean,
            deviation: (squares / (n - 1.0).max(1.0)).sqrt(),
            quantiles: Quantiles::of_sorted(&values, &Quantiles::LEVELS)?,
            histogram: Histogram::of_sorted(&values, BINS)?,
        })
    }
}

/// The four numbers of every machine.
#[derive(Serialize)]
pub struct Distributions {
    peak_moment: Distribution,
    peak_force: Distribution,
    rms_moment: Distribution,
    rms_force: Distribution,
}

impl Distributions {
    /// Of machines; `None` if there are none.
    pub fn of(outcomes: &[Outcome]) -> Option<Self> {
        let of = |f: fn(&Outcome) -> f64| Distribution::of(outcomes.iter().map(f).collect());
        Some(Self {
            peak_moment: of(|o| o.peak_moment)?,
            peak_force: of(|o| o.peak_force)?,
            rms_moment: of(|o| o.rms_moment)?,
            rms_force: of(|o| o.rms_force)?,
        })
    }

    fn table(&self, nominal: Option<&Outcome>) -> Table {
        let head = ["", "nominal", "mean", "deviation", "least", "5 %", "50 %", "95 %", "99 %", "greatest"];
        let mut table = Table::new(head);
        type Row<'a> = (&'a str, &'a Distribution, fn(&Outcome) -> f64);
        let rows: [Row; 4] = [
            ("peak |n_B| N m", &self.peak_moment, |o| o.peak_moment),
            ("RMS n_B N m", &self.rms_moment, |o| o.rms_moment),
            ("peak |f_B| N", &self.peak_force, |o| o.peak_force),
            ("RMS |f_B| N", &self.rms_force, |o| o.rms_force),
        ];
        for (name, d, of) in rows {
            let q = &d.quantiles.values;
            let nominal = nominal.map_or_else(|| "–".into(), |o| shown(of(o), 6));
            let numbers = [d.mean, d.deviation, q[0], q[2], q[4], q[6], q[7], q[8]].map(|x| shown(x, 6));
            table.row([name.to_owned(), nominal].into_iter().chain(numbers));
        }
        table
    }
}

/// How many keep within a limit.
#[derive(Serialize)]
pub struct Kept {
    #[serde(skip_serializing_if = "Option::is_none")]
    limit: Option<f64>,
    #[serde(flatten)]
    count: Yield,
}

/// How many keep within the limits that were given.
#[derive(Serialize)]
pub struct Yields {
    #[serde(skip_serializing_if = "Option::is_none")]
    moment: Option<Kept>,
    #[serde(skip_serializing_if = "Option::is_none")]
    force: Option<Kept>,
    #[serde(skip_serializing_if = "Option::is_none")]
    both: Option<Kept>,
}

impl Yields {
    /// Of machines, by limits on peak |n_B|, N m, and peak |f_B|, N.
    pub fn of(outcomes: &[Outcome], moment: Option<f64>, force: Option<f64>) -> Self {
        let count = |good: &dyn Fn(&Outcome) -> bool| {
            Yield::new(outcomes.iter().filter(|o| good(o)).count() as u64, outcomes.len() as u64)
        };
        let kept = |limit: Option<f64>, of: fn(&Outcome) -> f64| {
            limit.map(|most| Kept { limit, count: count(&|o| of(o) <= most) })
        };
        let both = moment
            .zip(force)
            .map(|(n, f)| Kept { limit: None, count: count(&|o| o.peak_moment <= n && o.peak_force <= f) });
        Self { moment: kept(moment, |o| o.peak_moment), force: kept(force, |o| o.peak_force), both }
    }

    fn table(&self) -> Option<Table> {
        let mut table = Table::new(["yield", "limit", "machines", "share %", "95 % between %"]);
        let rows = [("|n_B| N m", &self.moment), ("|f_B| N", &self.force), ("both", &self.both)];
        let mut any = false;
        for (name, kept) in rows {
            let Some(Kept { limit, count }) = kept else { continue };
            let percent = |x: f64| fixed(100.0 * x, 3);
            let limit = limit.map_or_else(String::new, |x| shown(x, 6));
            let between = format!("{} … {}", percent(count.interval[0]), percent(count.interval[1]));
            table.row([name.to_owned(), limit, count.good.to_string(), percent(count.share), between]);
            any = true;
        }
        any.then_some(table)
    }
}

/// A parameter as it was drawn.
#[derive(Serialize)]
pub struct Drawn {
    key: String,
    unit: &'static str,
    nominal: f64,
    spread: String,
    deviation: f64,
    mean_deviation: f64,
    cut: f64,
}

impl Drawn {
    /// Of a parameter.
    pub fn of(parameter: &Parameter) -> Self {
        let Parameter { key, unit, nominal, spread, deviation, cut, .. } = parameter;
        Self {
            key: key.clone(),
            unit,
            nominal: *nominal,
            spread: spread.to_string(),
            deviation: *deviation,
            mean_deviation: parameter.mean_deviation(),
            cut: *cut,
        }
    }
}

/// Simulated machines against the same ones with perfect tracking.
#[derive(Serialize)]
pub struct Compared {
    /// Largest difference of peak |n_B|, N m.
    peak_moment_difference: f64,
    /// Largest difference of peak |f_B|, N.
    peak_force_difference: f64,
    /// Mean of peak |n_B| simulated, by that with perfect tracking.
    peak_moment_ratio: f64,
    /// Mean of peak |f_B| simulated, by that with perfect tracking.
    peak_force_ratio: f64,
}

impl Compared {
    /// Of the same machines in the same order; `None` if nothing was simulated.
    pub fn of(simulated: &[Outcome], tracking: &[Outcome]) -> Option<Self> {
        if tracking.is_empty() {
            return None;
        }
        let difference = |of: fn(&Outcome) -> f64| {
            simulated.iter().zip(tracking).map(|(a, b)| (of(a) - of(b)).abs()).fold(0.0, f64::max)
        };
        let ratio = |of: fn(&Outcome) -> f64| {
            let sum = |all: &[Outcome]| all.iter().map(of).sum::<f64>();
            if sum(tracking) > 0.0 { sum(simulated) / sum(tracking) } else { 1.0 }
        };
        Some(Self {
            peak_moment_difference: difference(|o| o.peak_moment),
            peak_force_difference: difference(|o| o.peak_force),
            peak_moment_ratio: ratio(|o| o.peak_moment),
            peak_force_ratio: ratio(|o| o.peak_force),
        })
    }
}

/// What merged parts come to.
#[derive(Serialize)]
pub struct Merged {
    /// The file that was written.
    pub file: String,
    /// Machines.
    pub samples: u64,
    /// Which random machines.
    pub seed: u64,
    /// Peaks and root mean squares.
    #[serde(flatten)]
    pub distributions: Distributions,
    /// How many keep within limits.
    #[serde(rename = "yield")]
    pub yields: Yields,
}

impl Merged {
    /// As text.
    pub fn text(&self) -> String {
        let head = format!("{} · {}, seed {}", self.file, counted(self.samples, "machine"), self.seed);
        let yields = self.yields.table().map(|t| format!("\n{t}")).unwrap_or_default();
        format!("{head}\n\n{}{yields}", self.distributions.table(None))
    }
}

/// What a study comes to.
#[derive(Serialize)]
pub struct Answer {
    /// Its name.
    pub scenario: String,
    /// Whether machines were simulated; else they track perfectly.
    pub simulated: bool,
    /// Machines of the whole study.
    pub samples: u64,
    /// First sample of this shard, and the one after its last.
    pub shard: [u64; 2],
    /// Which random machines.
    pub seed: u64,
    /// s.
    pub motion_time: f64,
    /// What varies.
    pub parameters: Vec<Drawn>,
    /// The machine without deviations, by perfect tracking or simulated, as the machines are.
    pub nominal: Peaks,
    /// Peaks and root mean squares.
    #[serde(flatten)]
    pub distributions: Distributions,
    /// How many keep within limits.
    #[serde(rename = "yield")]
    pub yields: Yields,
    /// Which tolerance matters.
    pub shares: Shares,
    /// n_B and |f_B| over time.
    pub bands: Bands,
    /// Of first order with all orders.
    pub agreement: Agreement,
    /// Of perfect tracking with the simulation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub against_tracking: Option<Compared>,
    /// The file that was written.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
}

/// An outcome in JSON.
#[derive(Clone, Copy, Serialize)]
pub struct Peaks {
    peak_moment: f64,
    peak_force: f64,
    rms_moment: f64,
    rms_force: f64,
}

impl From<Outcome> for Peaks {
    fn from(o: Outcome) -> Self {
        let Outcome { peak_moment, peak_force, rms_moment, rms_force } = o;
        Self { peak_moment, peak_force, rms_moment, rms_force }
    }
}

/// Fewer machines than this say nothing about means and deviations.
const FEW: u64 = 100;

/// Rows of the table of shares; the rest is one row.
const SHOWN: usize = 12;

impl Answer {
    /// As text.
    pub fn text(&self, study: &StudyId, nominal: &Outcome) -> String {
        let [from, to] = self.shard;
        let mode = if self.simulated { "each simulated" } else { "perfect tracking" };
        let which = match to - from == study.samples {
            true => counted(study.samples, "machine"),
            false => format!("machines {from} to {} of {}", to - 1, study.samples),
        };
        let (seed, instants, time) = (study.seed, self.bands.time.len(), fixed(self.motion_time, 3));
        let mut text = format!(
            "{} · {which}, {mode}, seed {seed}, varied in {}, {instants} instants in {time} s\n\n{}",
            self.scenario,
            counted(self.parameters.len(), "number"),
            self.distributions.table(Some(nominal)),
        );
        if let Some(yields) = self.yields.table() {
            text += &format!("\n{yields}");
        }
        text += &format!("\n{}\n{}", self.shares_table(), self.orders());
        for drawn in self.parameters.iter().filter(|d| d.cut > 0.0) {
            let share = shown(100.0 * drawn.cut, 3);
            text += &format!("{}: {share} % of its distribution lies below 0 and is never drawn\n", drawn.key);
        }
        if let Some(c) = &self.against_tracking {
            let percent = |ratio: f64| format!("{:+.2} %", 100.0 * (ratio - 1.0));
            text += &format!(
                "Simulated at every step against perfect tracking at the instants: mean peak |n_B| {}, differing by at most \
                 {} N m; mean peak |f_B| {}, by at most {} N\n",
                percent(c.peak_moment_ratio),
                fixed(c.peak_moment_difference, 6),
                percent(c.peak_force_ratio),
                fixed(c.peak_force_difference, 6),
            );
        }
        text
    }

    /// The parameters that bring in the most variance, by the larger of their two shares.
    fn shares_table(&self) -> Table {
        let mut shares: Vec<_> = self.shares.parameters.iter().collect();
        let rank = |s: &stillbase::study::tolerance::Share| s.moment_share.max(s.force_share);
        shares.sort_by(|a, b| rank(b).total_cmp(&rank(a)));
        let mut table = Table::new(["what matters", "σ", "unit", "|∂n_B| σ N m", "of n_B %", "|∂f_B| σ N", "of f_B %"])
            .with_words(2);
        let percent = |x: f64| fixed(100.0 * x, 2);
        for s in shares.iter().take(SHOWN) {
            table.row([
                s.key.clone(),
                shown(s.deviation, 6),
                s.unit.to_owned(),
                fixed(s.moment_slope * s.deviation, 6),
                percent(s.moment_share),
                fixed(s.force_slope * s.deviation, 6),
                percent(s.force_share),
            ]);
        }
        if let Some(rest) = shares.get(SHOWN..).filter(|rest| !rest.is_empty()) {
            let sum = |f: fn(&stillbase::study::tolerance::Share) -> f64| percent(rest.iter().map(|s| f(s)).sum());
            let [moment, force] = [sum(|s| s.moment_share), sum(|s| s.force_share)];
            let empty = String::new;
            table.row([counted(rest.len(), "other"), empty(), empty(), empty(), moment, empty(), force]);
        }
        table
    }

    /// Where first order holds, and where it does not.
    fn orders(&self) -> String {
        let a = &self.agreement;
        let mut table =
            Table::new(["first order against all", "worst, in σ", "at s", "of the time %", "verdict"]).with_words(4);
        let rows = [
            ("mean of n_B: nominal, exact", &a.moment_mean, a.tolerance),
            ("deviation of n_B: first order, exact", &a.moment_deviation, a.tolerance),
            ("RMS of |f_B|: first order, exact", &a.force_rms, a.tolerance),
            ("mean of |f_B|: nominal, sampled", &a.force_mean, a.sampled_tolerance),
            ("deviation of |f_B|: first order, sampled", &a.force_deviation, a.sampled_tolerance),
        ];
        for (name, gap, tolerance) in rows {
            let verdict = match gap.worst <= tolerance {
                _ if name.ends_with("sampled") && self.bands.samples < FEW => "too few samples".into(),
                true => "agree".to_owned(),
                false => format!("part, by more than {} σ", fixed(tolerance, 2)),
            };
            let numbers = [fixed(gap.worst, 4), fixed(gap.time, 3), fixed(100.0 * gap.share, 1)];
            table.row([name.to_owned()].into_iter().chain(numbers).chain([verdict]));
        }
        let explained = |x: f64| fixed(100.0 * x, 2);
        let mut text = format!(
            "{table}\nFirst order explains {} % of the variance of n_B and {} % of that of f_B; the shares above are of that \
             part.\n",
            explained(self.shares.moment_first_order),
            explained(self.shares.force_first_order),
        );
        let parts = [a.force_mean, a.force_deviation].iter().any(|gap| gap.worst > a.sampled_tolerance);
        if parts && self.bands.samples >= FEW {
            text += "|f_B| is a norm: near a balanced machine its mean and deviation are not of first order, so read its \
                     percentiles and RMS.\n";
        }
        text
    }
}
