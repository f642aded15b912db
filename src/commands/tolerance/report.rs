//! Results of a study, as JSON and as text.

use schemars::JsonSchema;
use serde::Serialize;
use stillbase_settings::number::{counted, fixed, fixed_or_scientific};
use stillbase_study::tolerance::{Distribution, Distributions, LimitYield, PartReport, SampleOutcome, Share, Yields};

use crate::output::TextTable;

/// Formats the distributions of the four results of a machine, one in each row.
fn distributions_table(all: &Distributions, nominal: Option<&SampleOutcome>) -> TextTable {
    let head = ["", "nominal", "mean", "deviation", "least", "5 %", "50 %", "95 %", "99 %", "greatest"];
    let mut table = TextTable::new(head);
    type Row<'a> = (&'a str, &'a Distribution, fn(&SampleOutcome) -> f64);
    let rows: [Row; 4] = [
        ("peak |n_B| N m", &all.peak_moment, |o| o.peak_moment),
        ("RMS n_B N m", &all.rms_moment, |o| o.rms_moment),
        ("peak |f_B| N", &all.peak_force, |o| o.peak_force),
        ("RMS |f_B| N", &all.rms_force, |o| o.rms_force),
    ];
    for (name, d, of) in rows {
        let q = &d.quantiles.values;
        let nominal = nominal.map_or_else(|| "–".into(), |o| fixed_or_scientific(of(o), 6));
        let numbers = [d.mean, d.deviation, q[0], q[2], q[4], q[6], q[7], q[8]].map(|x| fixed_or_scientific(x, 6));
        table.row([name.to_owned(), nominal].into_iter().chain(numbers));
    }
    table
}

/// Formats the numbers of machines within the limits; `None` if there are no limits.
fn yields_table(yields: &Yields) -> Option<TextTable> {
    let mut table = TextTable::new(["yield", "limit", "machines", "share %", "95 % between %"]);
    let rows = [("|n_B| N m", &yields.moment), ("|f_B| N", &yields.force), ("both", &yields.both)];
    let mut any = false;
    for (name, kept) in rows {
        let Some(LimitYield { limit, count }) = kept else { continue };
        let percent = |x: f64| fixed(100.0 * x, 3);
        let limit = limit.map_or_else(String::new, |x| fixed_or_scientific(x, 6));
        let between = format!("{} … {}", percent(count.interval[0]), percent(count.interval[1]));
        table.row([name.to_owned(), limit, count.good.to_string(), percent(count.share), between]);
        any = true;
    }
    any.then_some(table)
}

/// Results of merged parts.
#[derive(JsonSchema, Serialize)]
pub struct MergedParts {
    /// The file that was written.
    pub file: String,
    /// Number of machines.
    pub samples: u64,
    /// Seed of the random machines.
    pub seed: u64,
    /// Machines that are in no part of a summary: the first of each gap, and the last plus one.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub missing: Vec<[u64; 2]>,
    /// Distributions of peaks and root mean squares.
    #[serde(flatten)]
    pub distributions: Distributions,
    /// Numbers of machines within limits.
    #[serde(rename = "yield")]
    pub yields: Yields,
}

impl MergedParts {
    /// Formats the results as text.
    pub fn text(&self) -> String {
        let missing: u64 = self.missing.iter().map(|[from, to]| to - from).sum();
        let of = if missing > 0 { format!("{} of ", self.samples - missing) } else { String::new() };
        let head = format!("{} · {of}{}, seed {}", self.file, counted(self.samples, "machine"), self.seed);
        let yields = yields_table(&self.yields).map(|t| format!("\n{t}")).unwrap_or_default();
        format!("{head}\n\n{}{yields}", distributions_table(&self.distributions, None))
    }
}

/// Results of a study.
#[derive(JsonSchema, Serialize)]
pub struct ToleranceAnswer {
    /// Report on its machines.
    #[serde(flatten)]
    pub report: PartReport,
    /// Machines that are in no part of a summary: the first of each gap, and the last plus one.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub missing: Vec<[u64; 2]>,
    /// The file that was written.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
}

/// Minimum number of machines for a statement on means and deviations.
const MIN_SAMPLES: u64 = 100;

/// Maximum number of rows of the table of shares; the other parameters share one more row.
const MAX_SHARE_ROWS: usize = 12;

impl ToleranceAnswer {
    /// Formats the report as text.
    pub fn text(&self) -> String {
        let report = &self.report;
        let [from, to] = report.shard;
        let missing: u64 = self.missing.iter().map(|[from, to]| to - from).sum();
        let which = match to - from == report.samples {
            _ if missing > 0 => format!("{} of {}", report.samples - missing, counted(report.samples, "machine")),
            true => counted(report.samples, "machine"),
            false => format!("machines {from} to {} of {}", to - 1, report.samples),
        };
        text(report, &which)
    }
}

/// Formats the report on some machines, which are named, as text.
fn text(report: &PartReport, which: &str) -> String {
    let mode = if report.simulated { "each simulated" } else { "perfect tracking" };
    let (seed, instants, time) = (report.seed, report.bands.time.len(), fixed(report.duration, 3));
    let mut text = format!(
        "{} · {which}, {mode}, seed {seed}, varied in {}, {instants} instants in {time} s\n\n{}",
        report.scenario,
        counted(report.parameters.len(), "number"),
        distributions_table(&report.distributions, Some(&report.nominal)),
    );
    if let Some(yields) = yields_table(&report.yields) {
        text += &format!("\n{yields}");
    }
    text += &format!("\n{}\n{}", shares_table(report), orders(report));
    for drawn in report.parameters.iter().filter(|d| d.cut > 0.0) {
        let share = fixed_or_scientific(100.0 * drawn.cut, 3);
        text += &format!("{}: {share} % of its distribution lies below 0 and is never drawn\n", drawn.key);
    }
    if let Some(c) = &report.against_tracking {
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

/// Returns the table of the parameters that cause the most variance, sorted by the larger of the two shares of each.
fn shares_table(report: &PartReport) -> TextTable {
    let mut shares: Vec<_> = report.shares.parameters.iter().collect();
    let rank = |s: &Share| s.moment_share.max(s.force_share);
    shares.sort_by(|a, b| rank(b).total_cmp(&rank(a)));
    let mut table = TextTable::new(["what matters", "σ", "unit", "|∂n_B| σ N m", "of n_B %", "|∂f_B| σ N", "of f_B %"])
        .with_words(2);
    let percent = |x: f64| fixed(100.0 * x, 2);
    for s in shares.iter().take(MAX_SHARE_ROWS) {
        table.row([
            s.key.clone(),
            fixed_or_scientific(s.deviation, 6),
            s.unit.to_owned(),
            fixed(s.moment_slope * s.deviation, 6),
            percent(s.moment_share),
            fixed(s.force_slope * s.deviation, 6),
            percent(s.force_share),
        ]);
    }
    if let Some(rest) = shares.get(MAX_SHARE_ROWS..).filter(|rest| !rest.is_empty()) {
        let sum = |f: fn(&Share) -> f64| percent(rest.iter().map(|s| f(s)).sum());
        let [moment, force] = [sum(|s| s.moment_share), sum(|s| s.force_share)];
        let empty = String::new;
        table.row([counted(rest.len(), "other"), empty(), empty(), empty(), moment, empty(), force]);
    }
    table
}

/// Formats the comparison of nominal and first-order results with exact or sampled ones.
fn orders(report: &PartReport) -> String {
    let a = &report.agreement;
    let mut table =
        TextTable::new(["first order, compared", "worst, in σ", "at s", "of the time %", "verdict"]).with_words(4);
    let rows = [
        ("mean of n_B: nominal, exact", &a.moment_mean, a.tolerance),
        ("deviation of n_B: first order, exact", &a.moment_deviation, a.tolerance),
        ("RMS of |f_B|: first order, exact", &a.force_rms, a.tolerance),
        ("mean of |f_B|: nominal, sampled", &a.force_mean, a.sampled_tolerance),
        ("deviation of |f_B|: first order, sampled", &a.force_deviation, a.sampled_tolerance),
    ];
    for (name, gap, tolerance) in rows {
        let verdict = match gap.largest <= tolerance {
            _ if name.ends_with("sampled") && report.bands.samples < MIN_SAMPLES => "too few samples".into(),
            true => "agree".to_owned(),
            false => format!("differ by more than {} σ", fixed(tolerance, 2)),
        };
        let numbers = [fixed(gap.largest, 4), fixed(gap.time, 3), fixed(100.0 * gap.share, 1)];
        table.row([name.to_owned()].into_iter().chain(numbers).chain([verdict]));
    }
    let explained = |x: f64| fixed(100.0 * x, 2);
    let mut text = format!(
        "{table}\nFirst order explains {} % of the variance of n_B and {} % of that of f_B; the shares above are of that \
             part.\n",
        explained(report.shares.moment_first_order),
        explained(report.shares.force_first_order),
    );
    let parts = [a.force_mean, a.force_deviation].iter().any(|gap| gap.largest > a.sampled_tolerance);
    if parts && report.bands.samples >= MIN_SAMPLES {
        text += "|f_B| is a norm: near a balanced machine its mean and deviation are not of first order, so read its \
                     percentiles and RMS.\n";
    }
    text
}
