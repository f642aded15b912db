//! `stillbase tolerance`

mod parallel;
mod report;

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use stillbase_files::is_standard;
use stillbase_files::row_file::{ROW_ENDINGS, RowForm};
use stillbase_files::shards::{
    ShardError, ShardHeader, StudyId, Writer, is_summary, merge, merge_summaries, read_summary, write_summary,
};
use stillbase_session::scenario::{MAX_SAMPLES, Scenario, Spread, Tolerance as Section};
use stillbase_session::{Run, with_start_edits};
use stillbase_study::tolerance::{
    Batch, BinValues, CHUNK, Ensemble, EnsemblePart, GoesOn, KnownRanks, Limits, MAX_VALUES, Mode, PartReport,
    PartResults, Recount, SampleOutcome, Summary, ToleranceError, Yields,
};

pub use self::report::{MergedParts, ToleranceAnswer};
use crate::exit::{is_quiet, print_message};
use crate::failure::Failure;
use crate::file_form::FileForm;
use crate::input::{DEFAULT_SCENARIO, Settings, overlay_for_study};
use crate::output::{Format, say_written};
use crate::progress::{Progress, goes_on};
use crate::strict::Strict;
use stillbase_settings::number::counted;

/// Sample machines within tolerances, and evaluate their reactions on the base
///
/// The spreads come from [tolerance] of the scenario and from --spread. By default all are normal. The standard
/// deviations are 0.5 mm for both coordinates of a centre of mass and 0.05 mm for lengths. Masses have 0.5 % and
/// inertias 2 %. Every machine tracks the planned motion perfectly. Its wrench is linear in g_k and C_kl, Eqs (7) and
/// (8), and in H_kk. With --simulate each machine is simulated, with control that knows only the nominal machine.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase tolerance case-3 --limit-moment 0.02 --limit-force 0.6
  stillbase tolerance case-3 --spread link.*.com=normal:0.0005 --spread link.*.mass=uniform:1%
  stillbase tolerance case-3 --samples 1000000 --shard 1/2 -o part-1.parquet
  stillbase tolerance --merge part-1.parquet part-2.parquet -o whole.parquet
  stillbase tolerance case-3 --samples 1000000000 --summary --shard 1/1000 -o part-0001.parquet
  stillbase tolerance case-1 --simulate --samples 500

A file has one row a machine: its number, its parameters, peak |n_B|, peak dynamic |f_B|, and the root mean square of
both over time. Its head holds a checksum of it all, which --merge looks at. Machine i depends on the seed and on i only,
so shards put together are the whole, exactly.

A summary counts machines in bins at most 0.1 % wide instead, with extremes and exact sums for each power of two. It
takes some 60 kB for a million machines, less than 1 MB for any number, and merging is addition. With --simulate it
compares nothing with perfect tracking.

JSON keys: scenario, simulated, samples, shard [from, to), seed, duration; parameters [{key, unit, nominal, spread,
deviation, mean_deviation, cut}]; nominal {peak_base_moment, peak_base_force, rms_base_moment, rms_base_force};
the same four {mean, deviation, quantiles {levels, values}, histogram {edges, counts}}; yield {moment, force,
both: {limit, good, of, share, interval}}; shares {parameters [{key, unit, deviation, moment_slope, force_slope,
moment_share, force_share}], moment_first_order, force_first_order}; bands {time, samples, moment, force} with percentiles
5, 25, 50, 75, 95; agreement {tolerance, sampled_tolerance; moment_mean, moment_deviation, force_rms, force_mean, force_deviation, sampling:
{worst, time, share}}; against_tracking with --simulate; file with -o. With --merge: file, samples, seed, the four
distributions, yield; with summaries missing [[from, to)], if machines are. The distributions of a summary have
quantile_error unless they are exact. Older names stay until version 0.3: `stillbase results older`.")]
pub struct ToleranceArguments {
    /// A built-in scenario (case-1, spacecraft …; an unknown name lists them all) or a TOML file; by default case-3
    #[arg(value_name = "SCENARIO")]
    scenario: Option<String>,
    /// Number of machines; default: that of the scenario, or else 100000, or 1000 with --simulate
    #[arg(long, value_name = "N", value_parser = samples)]
    samples: Option<u64>,
    /// Seed of the random machines; default: that of the scenario, or else 1
    #[arg(long, value_name = "S")]
    seed: Option<u64>,
    /// A parameter and its spread; may be repeated: link.*.com=normal:0.0005 (standard deviation, in the setting's
    /// unit), link.*.mass=uniform:1% (half-width, relative to the nominal value). Parameters are link.NAME.com,
    /// com_normal, mass, inertia, length.NAME, payload.mass, payload.inertia; a name overrides *
    #[arg(long = "spread", value_name = "KEY=SPREAD", value_parser = spread)]
    spreads: Vec<(String, Spread)>,
    /// Maximum permitted peak |n_B|, N m
    #[arg(long, value_name = "X", value_parser = limit)]
    limit_moment: Option<f64>,
    /// Maximum permitted peak dynamic |f_B|, N
    #[arg(long, value_name = "X", value_parser = limit)]
    limit_force: Option<f64>,
    /// Number of instants of the motion to evaluate; peaks between them are missed, so take more for long motions
    #[arg(long, value_name = "N", default_value_t = 200, value_parser = clap::value_parser!(u32).range(2..=100_000))]
    instants: u32,
    /// Only the i-th of n equal parts of the samples, i from 1
    #[arg(long, value_name = "i/n", value_parser = parse_shard)]
    shard: Option<(u64, u64)>,
    /// Simulate each machine under control instead of perfect tracking
    #[arg(long)]
    simulate: bool,
    /// Keep a summary in bins instead of every machine, for any number of machines; -o writes it, as .parquet
    #[arg(long)]
    summary: bool,
    /// Draw the machines of this summary again, find its quantiles exactly, and count those within any limits; with the
    /// scenario and options that it was made with
    #[arg(long, value_name = "SUMMARY", conflicts_with_all = ["shard", "output", "summary"])]
    exact: Option<PathBuf>,
    /// Merge these parts, in any order, into the file of -o; summaries of some parts may be merged again
    #[arg(
        long, value_name = "PART", num_args = 1.., requires = "output",
        conflicts_with_all = [
            "scenario", "samples", "seed", "spreads", "instants", "shard", "simulate", "summary", "exact", "pairs"
        ]
    )]
    merge: Vec<PathBuf>,
    /// Write every machine to this file, .csv or .parquet, or the summary, .parquet; `-` is standard output
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    settings: Settings,
    #[command(flatten)]
    strict: Strict,
    #[command(flatten)]
    form: FileForm,
    #[command(flatten)]
    format: Format,
}

/// Maximum number of machines of one run, because all of their results are held in memory.
const MAX_MACHINES: u64 = 20_000_000;

/// Number of machines after which a thread hands over the numbers that it has collected.
const WAITING_MACHINES: u64 = 1 << 14;

fn samples(text: &str) -> Result<u64, String> {
    let count = text.trim().parse().ok().filter(|n| (1..=MAX_SAMPLES).contains(n));
    count.ok_or_else(|| format!("want a whole number from 1 to {MAX_SAMPLES}"))
}

fn limit(text: &str) -> Result<f64, String> {
    text.trim().parse().ok().filter(|x: &f64| x.is_finite() && *x > 0.0).ok_or_else(|| "want a number above 0".into())
}

fn spread(text: &str) -> Result<(String, Spread), String> {
    let (key, spread) = text.split_once('=').ok_or("want KEY=SPREAD, such as link.*.com=normal:0.0005")?;
    Ok((key.trim().into(), spread.parse()?))
}

/// Parses i/n.
pub fn parse_shard(text: &str) -> Result<(u64, u64), String> {
    let pair = text.split_once('/').and_then(|(i, n)| Some((i.trim().parse().ok()?, n.trim().parse().ok()?)));
    let ok = pair.filter(|(i, n)| (1..=*n).contains(i) && *n <= MAX_SAMPLES);
    ok.ok_or_else(|| "want i/n with i from 1 to n, such as 2/8".into())
}

fn row_form(ending: &str) -> RowForm {
    RowForm::of_ending(ending).unwrap_or(RowForm::Csv)
}

impl From<ToleranceError> for Failure {
    fn from(e: ToleranceError) -> Self {
        Self::wrong_input(e)
    }
}

impl From<ShardError> for Failure {
    fn from(e: ShardError) -> Self {
        match e {
            ShardError::Write(e) => e.into(),
            e => Self::wrong_input(e),
        }
    }
}

/// Prints which machines are not in a summary.
fn say_missing(missing: &[Range<u64>]) {
    for Range { start, end } in missing {
        print_message(format!("note: machines {start} to {} are in no part", end - 1));
    }
}

/// Results of a summary whose machines were drawn again.
struct DrawnAgain {
    /// The first machine, and the last plus one.
    machines: Range<u64>,
    /// Machines in between, and of the whole study, that are in no part.
    missing: Vec<Range<u64>>,
    results: Option<PartResults>,
}

/// Returns that machines of a study are in no part, if some are.
fn lacking(missing: &[Range<u64>], samples: u64) -> Option<String> {
    let count: u64 = missing.iter().map(|gap| gap.end - gap.start).sum();
    (count > 0).then(|| format!("{count} of {} in no part", counted(samples, "machine")))
}

/// Returns of which limits how many machines are past.
fn past_limits(yields: &Yields) -> impl Iterator<Item = String> {
    let Yields { moment, force, .. } = yields;
    [("moment", moment), ("force", force)].into_iter().filter_map(|(what, limit)| {
        let count = limit.as_ref()?.count;
        let past = count.total - count.good;
        (past > 0).then(|| format!("{past} of {} past the limit of the {what}", counted(count.total, "machine")))
    })
}

impl ToleranceArguments {
    /// Samples and evaluates the machines, or merges parts.
    pub fn run(&self) -> Result<(), Failure> {
        match self.merge.is_empty() {
            true => self.study(),
            false => self.merge_parts(),
        }
    }

    fn merge_parts(&self) -> Result<(), Failure> {
        let Some(whole) = &self.output else { return Err(Failure::wrong_input("--merge: want -o FILE")) };
        let ending = self.form.check(&self.format, Some(whole), self.force, &ROW_ENDINGS)?;
        let kinds = self.merge.iter().map(|part| is_summary(part)).collect::<Result<Vec<_>, _>>()?;
        let (study, results, missing) = if kinds.iter().all(|is_summary| *is_summary) {
            let (study, sum) = merge_summaries(&self.merge)?;
            self.say_uncounted(&sum)?;
            write_summary(whole, self.force, &study, &sum)?;
            (study, sum.results(&KnownRanks::default()), sum.missing(study.samples))
        } else if let Some((part, _)) = self.merge.iter().zip(&kinds).find(|(_, is_summary)| **is_summary) {
            let why = format!("{}: a summary, but other parts have every machine: want one kind", part.display());
            return Err(Failure::wrong_input(why));
        } else {
            let merged = merge(&self.merge, (whole, row_form(ending)), self.force, &goes_on)?;
            let (study, outcomes) = merged.ok_or(Failure::Stopped)?;
            (study, PartResults::of(&outcomes, &[], self.limits()), Vec::new())
        };
        let Some(results) = results else { return Err(Failure::no_answer("the parts hold no machine")) };
        say_missing(&missing);
        let answer = MergedParts {
            file: whole.display().to_string(),
            samples: study.samples,
            seed: study.seed,
            missing: missing.iter().map(|gap| [gap.start, gap.end]).collect(),
            distributions: results.distributions,
            yields: results.yields,
        };
        say_written(whole);
        self.format.print(&answer, MergedParts::text)?;
        let lacks = lacking(&missing, study.samples);
        self.strict.require(lacks.into_iter().chain(past_limits(&answer.yields)))
    }

    fn limits(&self) -> Limits {
        Limits { moment: self.limit_moment, force: self.limit_force }
    }

    /// Refuses limits that the parts of a summary did not count, and says what their bins tell.
    fn say_uncounted(&self, sum: &Summary) -> Result<(), Failure> {
        let (asked, counted) = (self.limits(), sum.limits());
        let limits =
            [("--limit-moment", 0, asked.moment, counted.moment), ("--limit-force", 1, asked.force, counted.force)];
        for (option, number, asked, counted) in limits {
            let Some(limit) = asked.filter(|_| asked != counted) else { continue };
            let [least, most] = sum.within(number, limit);
            let had = counted.map_or_else(|| "none".to_owned(), |limit| limit.to_string());
            return Err(Failure::wrong_input(format!(
                "{option} {limit}: the parts did not count it (their limit: {had}); by their bins, {least} to {most} of \
                 {} machines are within: want {option} with every part, or with --exact",
                sum.count()
            )));
        }
        Ok(())
    }

    /// Returns the tolerances of the scenario, overridden by those of the command line.
    fn section(&self, scenario: &Scenario) -> Section {
        let mut section = scenario.tolerance.clone();
        section.spreads.extend(self.spreads.iter().cloned());
        section.spreads = section.spreads_or_default(&scenario.machine);
        section.seed = self.seed.or(section.seed);
        section.samples = self.samples.or(section.samples);
        section.moment_limit = self.limit_moment.or(section.moment_limit);
        section.force_limit = self.limit_force.or(section.force_limit);
        section
    }

    fn study(&self) -> Result<(), Failure> {
        let name = self.scenario.as_deref().unwrap_or(DEFAULT_SCENARIO);
        let (scenario, others) = with_start_edits(&overlay_for_study(name, &self.settings)?)?;
        if others > 0 {
            let edits = counted(others, "edit");
            print_message(format!(
                "note: {}: the planned motion counts, without {edits} after its start",
                scenario.name
            ));
        }
        let left_out = stillbase_study::tolerance::neglected_effects(&scenario);
        if !left_out.is_empty() && !self.simulate {
            let what = left_out.join(", ");
            print_message(format!(
                "note: {}: perfect tracking on a fixed base leaves out {what}: --simulate has it",
                scenario.name
            ));
        }
        if self.simulate && scenario.base.wheel.is_some() {
            print_message(format!(
                "note: {}: |n_B| of the simulated machines is without the part that the reaction wheel takes up",
                scenario.name
            ));
        }
        let section = self.section(&scenario);
        let samples = section.samples.unwrap_or(if self.simulate { 1000 } else { 100_000 });
        let (i, n) = self.shard.unwrap_or((1, 1));
        let range = stillbase_study::tolerance::shard(samples, i, n);
        let is_summarized = self.summary || self.exact.is_some();
        if range.end - range.start > MAX_MACHINES && !is_summarized {
            let why = format!(
                "{} machines at once: want at most {MAX_MACHINES}, in shards, or --summary",
                range.end - range.start
            );
            return Err(Failure::wrong_input(why));
        }
        if range.is_empty() {
            let why = format!("--shard {i}/{n} of {samples} samples holds no machine: want fewer shards");
            return Err(Failure::wrong_input(why));
        }
        let endings = if self.summary { &[RowForm::Parquet.ending()][..] } else { &ROW_ENDINGS };
        let ending = self.form.check_wanted(&self.format, self.output.as_deref(), self.force, endings)?;
        if self.summary && self.output.as_deref().is_some_and(is_standard) {
            return Err(Failure::wrong_input("-o -: a summary is a file: want a name that ends in .parquet"));
        }
        let to = self.output.as_deref().zip(ending.map(row_form));
        let run = Run::new(&scenario).map_err(|e| Failure::refused(&scenario, e))?;
        let plant = scenario.plant_machine()?;
        let seed = section.seed.unwrap_or(1);
        let motion = &run.plan().motion;
        let ensemble = Ensemble::new(&plant, motion, self.instants as usize, &section.spreads, seed)?;
        let study = StudyId::of(&scenario, &section, [samples, seed], self.instants, self.simulate);
        let limits = Limits { moment: section.moment_limit, force: section.force_limit };
        let mut missing = Vec::new();
        let (machines, results) = match &self.exact {
            Some(file) => {
                let again = self.exact_results(&ensemble, &run, (&study, file), limits)?;
                missing = again.missing;
                (again.machines, again.results)
            }
            None if self.summary => {
                let sum = self.summarize(&ensemble, &run, limits, &range)?;
                self.output.iter().try_for_each(|file| write_summary(file, self.force, &study, &sum))?;
                (range, sum.results(&KnownRanks::default()))
            }
            None => {
                let (outcomes, tracking) = self.evaluate(&ensemble, &run, (&study, to), range.clone())?;
                (range, PartResults::of(&outcomes, &tracking, limits))
            }
        };
        let results = results.ok_or_else(|| Failure::no_answer("no machine was drawn"))?;
        let part = EnsemblePart { run: &run, ensemble: &ensemble, samples, machines, simulated: self.simulate };
        let progress = Progress::hidden();
        let report =
            PartReport::of(&part, results, &|| progress.goes_on()).map_err(|e| Failure::refused(&scenario, e))?;
        let file = self.output.as_ref().map(|file| file.display().to_string());
        let gaps = missing.iter().map(|gap| [gap.start, gap.end]).collect();
        let answer = ToleranceAnswer { report, missing: gaps, file };
        self.output.iter().for_each(|file| say_written(file));
        self.format.print(&answer, ToleranceAnswer::text)?;
        let lacks = lacking(&missing, samples);
        self.strict.require(lacks.into_iter().chain(past_limits(&answer.report.yields)))
    }

    fn mode<'a>(&self, run: &'a Run) -> Mode<'a> {
        if self.simulate { Mode::Simulated(run) } else { Mode::Tracking }
    }

    /// Evaluates the machines of a range and keeps their summary.
    fn summarize(
        &self,
        ensemble: &Ensemble,
        run: &Run,
        limits: Limits,
        range: &Range<u64>,
    ) -> Result<Summary, Failure> {
        let progress = self.progress(range.end - range.start);
        let workers = parallel::share_out(
            ensemble,
            self.mode(run),
            std::slice::from_ref(range),
            || Summary::new(limits),
            |sum, batch| {
                sum.add(batch.samples.start, &batch.outcomes);
                progress.add(batch.samples.end - batch.samples.start);
            },
            &|| progress.goes_on(),
        );
        progress.finish();
        let mut whole = Summary::new(limits);
        for sum in workers.map_err(|e| Failure::refused(run.scenario(), e))? {
            // They have the same limits, and say nothing of their machines: each was given to one of them.
            whole.merge(&sum).map_err(|_| Failure::no_answer("a machine was counted twice"))?;
        }
        whole.hold(range.clone());
        Ok(whole)
    }

    /// Draws the machines of a summary again. Returns the range that they lie in, which of the study are missing, and the
    /// results with exact quantiles.
    fn exact_results(
        &self,
        ensemble: &Ensemble,
        run: &Run,
        (study, file): (&StudyId, &Path),
        limits: Limits,
    ) -> Result<DrawnAgain, Failure> {
        let (own, sum) = read_summary(file)?;
        if own != *study {
            let why = "want the scenario and options that it was made with, --samples and --seed included";
            return Err(Failure::wrong_input(format!("{}: a summary of another study: {why}", file.display())));
        }
        let bins = sum.quantile_bins();
        if let Some(count) = bins.values().max().filter(|count| **count > MAX_VALUES) {
            let why =
                format!("{count} machines lie in one bin: want at most {MAX_VALUES}; quantiles are right within 0.1 %");
            return Err(Failure::no_answer(format!("--exact {}: {why}", file.display())));
        }
        let mut known = KnownRanks::default();
        let counts_anew = limits != Limits::default() && limits != sum.limits();
        let (mut passes, mut kept) = (BinValues::passes(&bins), None);
        if passes.is_empty() && counts_anew {
            passes.push(BinValues::default());
        }
        let progress = self.progress(sum.count() * passes.len() as u64);
        let failed = |e| Failure::refused(run.scenario(), e);
        let foreign = || {
            let why = "it holds other machines than this program draws: want it made by the same version";
            Failure::wrong_input(format!("{}: {why}", file.display()))
        };
        for values in passes {
            // The first pass counts for all.
            let limits = if counts_anew && kept.is_none() { limits } else { Limits::default() };
            let empty = Recount { values, limits, ..Recount::default() };
            let mut whole = empty.clone();
            whole.values.reserve(&bins);
            let all = Mutex::new(whole);
            let take_over = |found: &mut Recount| all.lock().unwrap_or_else(PoisonError::into_inner).take_over(found);
            let workers = parallel::share_out(
                ensemble,
                self.mode(run),
                sum.machines(),
                || empty.clone(),
                |found, batch| {
                    found.add(&batch.outcomes);
                    // What waits on a thread stays small.
                    if found.waiting >= WAITING_MACHINES {
                        take_over(found);
                    }
                    progress.add(batch.samples.end - batch.samples.start);
                },
                &|| progress.goes_on(),
            );
            workers.map_err(failed)?.iter_mut().for_each(take_over);
            let whole = all.into_inner().unwrap_or_else(PoisonError::into_inner);
            kept.get_or_insert(whole.kept);
            sum.learn(whole.values, &mut known).map_err(|_| foreign())?;
        }
        self.check_extremes(ensemble, run, &sum, &|| progress.goes_on())?.then_some(()).ok_or_else(foreign)?;
        progress.finish();
        let missing = sum.missing(study.samples);
        say_missing(&missing);
        let held = sum.machines();
        let machines = held.first().map_or(0, |own| own.start)..held.last().map_or(0, |own| own.end);
        let yields = kept.filter(|_| counts_anew).map_or_else(|| sum.yields(), |kept| limits.yields(kept, sum.count()));
        let results = sum.results(&known).map(|results| PartResults { yields, ..results });
        Ok(DrawnAgain { machines, missing, results })
    }

    /// Returns whether the extremes of a summary are those of their machines, which are drawn again.
    fn check_extremes(
        &self,
        ensemble: &Ensemble,
        run: &Run,
        sum: &Summary,
        goes_on: GoesOn<'_>,
    ) -> Result<bool, Failure> {
        let mut by_machine = BTreeMap::<u64, Vec<(usize, f64)>>::new();
        for (number, extreme) in sum.extremes() {
            by_machine.entry(extreme.machine).or_default().push((number, extreme.value));
        }
        let mut sampler = ensemble.sampler();
        for (machine, told) in by_machine {
            let (chunk, alone) = (machine / CHUNK as u64, machine..machine + 1);
            let drawn = Batch::of(ensemble, &mut sampler, self.mode(run), chunk, &alone, (false, goes_on));
            let drawn = drawn.map_err(|e| Failure::refused(run.scenario(), e))?;
            let is_so =
                |(number, value): &(usize, f64)| drawn.outcomes.iter().any(|of| of.numbers()[*number] == *value);
            if !told.iter().all(is_so) {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Evaluates the machines of a range and writes them if requested. Returns their outcomes and, if these are
    /// simulated, those of perfect tracking.
    fn evaluate(
        &self,
        ensemble: &Ensemble,
        run: &Run,
        (study, to): (&StudyId, Option<(&Path, RowForm)>),
        range: Range<u64>,
    ) -> Result<(Vec<SampleOutcome>, Vec<SampleOutcome>), Failure> {
        let parameters = ensemble.parameters();
        let mut writer = match to {
            Some(to) => {
                let names = parameters.iter().map(|p| format!("{} {}", p.key, p.unit));
                Some(Writer::create(to, self.force, &ShardHeader::new(*study, names))?)
            }
            None => None,
        };
        let mode = self.mode(run);
        let progress = self.progress(range.end - range.start);
        let mut outcomes = Vec::with_capacity((range.end - range.start) as usize);
        let (mut tracking, mut numbers) = (Vec::new(), Vec::new());
        let goes_on = || progress.goes_on();
        let done = parallel::evaluate(ensemble, mode, range, (writer.is_some(), &goes_on), |batch| {
            if let Some(writer) = &mut writer {
                for ((sample, deviations), outcome) in batch.samples.clone().zip(&batch.deviations).zip(&batch.outcomes)
                {
                    numbers.clear();
                    numbers.extend(parameters.iter().zip(deviations).map(|(p, deviation)| p.nominal + deviation));
                    writer.machine(sample, &numbers, outcome)?;
                }
            }
            progress.add(batch.samples.end - batch.samples.start);
            outcomes.extend(batch.outcomes);
            tracking.extend(batch.tracking);
            Ok::<_, Failure>(())
        });
        progress.finish();
        done?;
        if let Some(writer) = writer {
            writer.finish()?;
        }
        Ok((outcomes, tracking))
    }

    fn progress(&self, machines: u64) -> Progress {
        if !self.simulate && machines <= MAX_MACHINES || is_quiet() {
            return Progress::hidden();
        }
        let style = ProgressStyle::with_template("{bar:30} {human_pos} of {human_len} machines, {eta} left");
        let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
        Progress::with_bar(ProgressBar::new(machines).with_style(style))
    }
}
