//! `stillbase import`

use std::f64::consts::TAU;
use std::path::{Path as FilePath, PathBuf};

use clap::{Args, ValueEnum};
use serde::Serialize;
use stillbase::dynamics::{Surroundings, angular_momentum};
use stillbase::files::{check_new, write_new};
use stillbase::machine::{self, Inertia, Machine};
use stillbase::plan::nearest::{Deviation, nearest_b, same_tip, turned};
use stillbase::plan::path::minimum_norm_curve;
use stillbase::plan::{Forecast, Limits, Motion, Path, Profile, Rule, Samples, trace};
use stillbase::planar::{DriveAngles, Vector};
use stillbase::pose_constant::Planes;
use stillbase::scenario::{Scenario, Task, TaskKind};
use stillbase::session::replay;

use super::columns::{Content, Read, samples};
use super::failure::Failure;
use super::input::{DEFAULT_SCENARIO, Settings, pose_constant, read};
use super::output::{Format, Table, fixed, say, yes};

/// Read a motion of your own from CSV, report what it does to the base, and propose the nearest reactionless one
///
/// The file has a header: t,q1,q2,q3 for absolute drive angles, or t,x,y for the end effector, in any order, with units if
/// wanted: "t (ms)", "q1 (deg)", "x (mm)"; without them s, rad, m. Other columns are left alone. A quintic spline goes
/// through every sample. The proposal keeps the timing and holds b: with the end effector where it was if some plane
/// reaches all of its path, else with the arm turned as a whole. It is simulated before it is called reactionless.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase import motion.csv
  stillbase import motion.csv --smooth 20 -o quiet.toml     also writes quiet-given.toml
  stillbase headless quiet.toml quiet-given.toml -o both.rrd
  stillbase export quiet.toml --rate 500 -o quiet.csv")]
pub struct Import {
    /// A CSV file with a header
    #[arg(value_name = "FILE.csv")]
    file: PathBuf,
    /// A built-in machine or a TOML file
    #[arg(long, value_name = "MACHINE", default_value = "nine-link")]
    machine: String,
    /// Pose constant of the proposal, rad; by default the mean of the given one, or the middle of what serves x-y
    #[arg(long, value_name = "B", value_parser = pose_constant)]
    b: Option<f64>,
    /// Smooth the samples without delay: half of the amplitude is left at this frequency, Hz
    #[arg(long, value_name = "HZ", value_parser = above_zero)]
    smooth: Option<f64>,
    /// Which columns to take, where a file has both; by default the drives
    #[arg(long, value_enum)]
    columns: Option<Content>,
    /// What the proposal keeps of given drive angles: the end effector's motion, or the relative joint angles; by default
    /// the end effector's, if some plane reaches all of it
    #[arg(long, value_enum)]
    keep: Option<Keep>,
    /// Let the spline bridge gaps in time
    #[arg(long)]
    gaps: bool,
    /// Write the proposal as a scenario, and the given motion beside it as FILE-given.toml
    #[arg(short, long, value_name = "FILE.toml")]
    output: Option<PathBuf>,
    /// Replace files that exist
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    settings: Settings,
    #[command(flatten)]
    format: Format,
}

fn above_zero(text: &str) -> Result<f64, String> {
    text.trim().parse().ok().filter(|x: &f64| *x > 0.0 && x.is_finite()).ok_or_else(|| "want a number above 0".into())
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Keep {
    Tip,
    Joints,
}

#[derive(Serialize)]
struct Answer {
    file: String,
    machine: String,
    /// `drives` or `tip`.
    content: &'static str,
    samples: usize,
    start: f64,
    duration: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    smoothed_at: Option<f64>,
    /// Greatest change of a sample by smoothing, rad or m.
    #[serde(skip_serializing_if = "Option::is_none")]
    smoothed_by: Option<f64>,
    /// How far the second derivative of each column can be trusted, rad/s² or m/s².
    uncertainty: Vec<f64>,
    /// For the end effector: with minimum-norm rates; none where these cannot follow.
    #[serde(skip_serializing_if = "Option::is_none")]
    given: Option<Account>,
    feasible: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    proposal: Option<Proposal>,
}

/// What a motion does, if it is followed exactly.
#[derive(Serialize)]
struct Account {
    peak_base_moment: f64,
    rms_base_moment: f64,
    moment_impulse: f64,
    peak_base_force: f64,
    rms_base_force: f64,
    peak_torque: Vec<f64>,
    peak_speed: Vec<f64>,
    /// The limit of a drive that is passed by most, and by what factor.
    #[serde(skip_serializing_if = "Option::is_none")]
    over: Option<(String, f64)>,
    /// By how much a relative angle passes its limits at most, rad; 0 if all keep them.
    past_limits: f64,
    b_range: [f64; 2],
    b_mean: f64,
    angular_momentum_start: f64,
    angular_momentum_end: f64,
    /// Largest |q̇_k| at the end.
    speed_end: f64,
}

#[derive(Serialize)]
struct Proposal {
    /// `same-tip`, `turned` or `on-plane`.
    way: &'static str,
    why: String,
    b: f64,
    /// Greatest distance of the end effector from the given motion.
    tip_deviation: f64,
    joint_deviation: Vec<f64>,
    /// Root mean square over time and drives in the metric of kinetic energy.
    rms_deviation: f64,
    #[serde(flatten)]
    account: Account,
    /// As simulated.
    simulated_peak_base_moment: f64,
    simulated_peak_base_force: f64,
    reactionless: bool,
}

/// A motion that might be proposed.
struct Candidate {
    way: &'static str,
    why: String,
    task: Task,
}

/// The machine with what is needed to judge motions of it.
struct Judge {
    machine: Machine,
    model: Inertia,
    around: Surroundings,
    planes: Planes,
    instants: usize,
}

impl Judge {
    fn past_limits(&self, motion: &Motion) -> f64 {
        let past = |i: usize| {
            let q = motion.path.at(i as f64 / self.instants as f64).q;
            let angles = self.machine.angles().iter().map(|angle| {
                let a = q[angle.to] - q[angle.from] + angle.offset;
                (angle.limits.start() - a).max(a - angle.limits.end())
            });
            angles.fold(0.0, f64::max)
        };
        let most = (0..=self.instants).map(past).fold(0.0, f64::max);
        // What rounding passes by is none.
        if most > 1e-6 { most } else { 0.0 }
    }

    fn account(&self, motion: &Motion) -> Account {
        let f = Forecast::at(motion, &self.model, &self.around, &Limits::of(&self.machine), self.instants);
        let ends = [0.0, motion.duration()].map(|t| motion.at(t));
        let [start, end] = [0, 1].map(|i| angular_momentum(&self.model, &ends[i].q.units(), &ends[i].qd) + 0.0);
        Account {
            peak_base_moment: f.moment,
            rms_base_moment: f.moment_rms,
            moment_impulse: f.impulse,
            peak_base_force: f.force,
            rms_base_force: f.force_rms,
            peak_torque: f.torque.to_vec(),
            peak_speed: f.speed.to_vec(),
            over: f.over.map(|(limit, factor)| (limit.to_string(), factor)),
            past_limits: self.past_limits(motion),
            b_range: f.b,
            b_mean: f.b_mean,
            angular_momentum_start: start,
            angular_momentum_end: end,
            speed_end: ends[1].qd.max_abs(),
        }
    }
}

impl Import {
    /// Runs it.
    pub fn run(&self) -> Result<(), Failure> {
        let files = self.output.as_deref().map(|file| [file.to_owned(), beside(file)]);
        for file in files.iter().flatten() {
            check_new(file, self.force)?;
        }
        let machine = self.settings.apply(machine::find(&self.machine, None)?)?;
        let name = self.file.display().to_string();
        let found = samples(&read(&self.file)?, &name, &machine, self.columns, self.gaps)?;
        for (column, turns) in found.names.iter().zip(&found.unwrapped).filter(|(_, turns)| **turns > 0) {
            say(format!("note: {column} was wrapped: a whole turn taken out at {turns} places"));
        }
        let raw = match found.content {
            Content::Drives => within_limits(&machine, &found.samples),
            Content::Tip => found.samples.clone(),
        };
        let samples = match self.smooth {
            Some(cut_off) => raw.smoothed(cut_off).map_err(|e| Failure::wrong_input(e).of("--smooth"))?,
            None => raw.clone(),
        };
        if found.content == Content::Tip && self.keep == Some(Keep::Joints) {
            return Err(Failure::wrong_input("--keep joints has no use here: x and y give no joint angles to be kept"));
        }
        let judge = Judge {
            model: Inertia::of(&machine),
            around: Surroundings { gravity: machine.gravity(), force: Vector::default() },
            planes: Planes::of(&machine)?,
            instants: (8 * samples.count()).clamp(4000, 200_000),
            machine,
        };
        let (motion, candidates) = match found.content {
            Content::Drives => self.of_drives(&judge, &samples)?,
            Content::Tip => self.of_tip(&judge, &samples)?,
        };
        let changed = |i: usize| samples.values(i).iter().zip(raw.values(i)).map(|(a, b)| (a - b).abs());
        let mut answer = Answer {
            machine: judge.machine.name().to_owned(),
            content: if found.content == Content::Drives { "drives" } else { "tip" },
            samples: samples.count(),
            start: samples.time(0),
            duration: samples.duration(),
            smoothed_at: self.smooth,
            smoothed_by: self.smooth.map(|_| (0..samples.count()).flat_map(changed).fold(0.0, f64::max)),
            uncertainty: (0..samples.columns()).map(|k| samples.uncertainty(k)).collect(),
            given: motion.as_ref().map(|motion| judge.account(motion)),
            feasible: false,
            reason: None,
            proposal: None,
            file: name,
        };
        self.warn(&found, &samples, motion.as_ref(), &answer);
        let base = Scenario::builtin(DEFAULT_SCENARIO)
            .ok_or_else(|| Failure::wrong_input("the built-in scenarios are gone: want a whole installation"))?;
        let file_name = self.file.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
        let stem = files.as_ref().map_or_else(|| "import".to_owned(), |[file, _]| stem(file));
        let scenario = |task: &Task, name: String, title: String| Scenario {
            name,
            title,
            machine: judge.machine.clone(),
            task: task.clone(),
            step: samples.spacing().clamp(1e-4, base.step),
            compare_b: None,
            edits: Vec::new(),
            ..base.clone()
        };
        let mut chosen = None;
        match candidates {
            Err(why) => answer.reason = Some(why),
            Ok(candidates) => {
                for candidate in candidates {
                    let title = format!("{file_name} · {}", candidate.way);
                    let own = scenario(&candidate.task, stem.clone(), title);
                    match judge.proposal(&candidate, &own, motion.as_ref()) {
                        Ok(proposal) if proposal.reactionless => {
                            answer.reason = None;
                            answer.proposal = Some(proposal);
                            chosen = Some(own);
                            break;
                        }
                        Ok(proposal) => {
                            answer.reason = Some(judge.not_quiet(&proposal, answer.given.as_ref()));
                        }
                        Err(why) => answer.reason = Some(why),
                    }
                }
            }
        }
        answer.feasible = chosen.is_some();
        if let Some((limit, factor)) = answer.proposal.as_ref().and_then(|p| p.account.over.as_ref()) {
            say(format!(
                "note: the proposal asks for {} times the {limit}; slower samples, or another --b",
                fixed(*factor, 2)
            ));
        }
        self.format.print(&answer, table)?;
        let Some(chosen) = chosen else {
            return Err(Failure::no_answer(answer.reason.unwrap_or_default()));
        };
        if let Some([file, given]) = &files {
            let kind = if found.content == Content::Drives { TaskKind::Given } else { TaskKind::MinimumNorm };
            let task = Task::sampled(kind, samples.clone(), Some(chosen.task.b), &judge.machine)
                .map_err(|key| Failure::wrong_input(format!("no {key}: want --{key}")))?;
            let task = match found.content {
                Content::Drives => Task { b: judge.model.lambda().dot(samples.values(0)), ..task },
                Content::Tip => task,
            };
            let own = scenario(&task, format!("{stem}-given"), format!("{file_name} · as given"));
            write_new(file, chosen.to_toml().as_bytes(), self.force)?;
            write_new(given, own.to_toml().as_bytes(), self.force)?;
            say(format!("wrote {} and {}", file.display(), given.display()));
        }
        Ok(())
    }

    /// The motion given by drive angles, and what might be proposed, the best first.
    #[allow(clippy::type_complexity)]
    fn of_drives(
        &self,
        judge: &Judge,
        samples: &Samples,
    ) -> Result<(Option<Motion>, Result<Vec<Candidate>, String>), Failure> {
        let path = samples.path(0.0).ok_or_else(|| Failure::wrong_input("want times further apart"))?;
        let motion = Motion { path: Path::Table(path), profile: Profile::running(samples.duration()) };
        let lambda = judge.model.lambda();
        let mean = judge.account(&motion).b_mean;
        let map = judge.planes.map();
        // Whole turns of all drives are nothing: the one nearest to where the motion is.
        let wanted = self.b.map_or(mean, |b| b + map.period() * ((mean - b) / map.period()).round());
        let which = if self.b.is_some() { "the b asked for" } else { "the mean b" };
        let task = |samples: Samples| Task::sampled(TaskKind::Given, samples, None, &judge.machine).ok();
        let mut candidates = Vec::new();
        let mut blocked = None;
        if self.keep != Some(Keep::Joints) {
            let mut add = |b: f64, why: String| match same_tip(map, judge.machine.tip(), samples, b, Rule::default()) {
                Ok(moved) => {
                    let made = moved.and_then(task).map(|task| Candidate { way: "same-tip", why, task });
                    candidates.extend(made);
                    None
                }
                Err(blocked) => Some(blocked),
            };
            let near =
                self.b.is_none().then(|| nearest_b(map, judge.machine.tip(), &judge.model, samples, Rule::default()));
            blocked = match near.flatten() {
                Some((b, _)) => {
                    add(b, "of all b that reach every point of its path, the one that moves the drives least".into())
                }
                None => add(wanted, format!("{which} reaches every point of its path")),
            };
        }
        match (self.keep, &blocked) {
            (Some(Keep::Tip), Some(stop)) if candidates.is_empty() => return Ok((Some(motion), Err(stop.to_string()))),
            (Some(Keep::Tip), _) => {}
            _ => {
                let why = match (self.keep, blocked) {
                    (Some(_), _) => "the relative joint angles are to be kept".into(),
                    (None, Some(stop)) => format!("the end effector's path cannot be kept: {stop}"),
                    (None, None) => "the end effector's path cannot be kept within the rules".into(),
                };
                let made = turned(&lambda, samples, wanted).and_then(task);
                candidates.extend(made.map(|task| Candidate { way: "turned", why, task }));
            }
        }
        Ok((Some(motion), Ok(candidates)))
    }

    /// The usual inverse of a motion given by the end effector, and the one on a plane.
    #[allow(clippy::type_complexity)]
    fn of_tip(
        &self,
        judge: &Judge,
        samples: &Samples,
    ) -> Result<(Option<Motion>, Result<Vec<Candidate>, String>), Failure> {
        let (planes, map) = (&judge.planes, judge.planes.map());
        let curve = samples.curve().ok_or_else(|| Failure::wrong_input("want times further apart"))?;
        let curves = [curve];
        let (b, why) = match self.b {
            Some(b) => (b, "b is the one asked for".to_owned()),
            None => {
                let serves = |set: stillbase::reactionless::BSet| {
                    set.intervals.into_iter().max_by(|x, y| (x[1] - x[0]).total_cmp(&(y[1] - y[0])))
                };
                let all = serves(trace::common_b(map, &curves, 257));
                // Where no b serves all points, the first one's gives the reason.
                let first = map.reach(samples.point(0)).ok().and_then(serves);
                let range = all.or(first).unwrap_or([0.0; 2]);
                let b = 0.5 * (range[0] + range[1]);
                (b, format!("b is the middle of what reaches all of the path, {:.4} to {:.4} rad", range[0], range[1]))
            }
        };
        let follow = |b: f64| trace::follow(map, &curves, b, None, Rule::default()).map(|_| b);
        let followed = follow(b).map(|b| (b, why)).or_else(|stop| match (stop.nearest_b, self.b) {
            (Some(b), None) => {
                follow(b).map(|b| (b, format!("b = {b:.4} rad is one at which all of it can be followed")))
            }
            _ => Err(stop),
        });
        let b = followed.as_ref().map_or(b, |(b, _)| *b);
        let starts = planes.serve(&[samples.point(0)], b).ok().and_then(|poses| poses.first().copied());
        let usual = starts.and_then(|pose| {
            let q = DriveAngles::from(map.lift(pose));
            let table = minimum_norm_curve(judge.machine.tip(), q, &curves[0]).ok()?;
            Some(Motion { path: Path::Table(table), profile: Profile::running(samples.duration()) })
        });
        let candidates = followed.map_err(|stop| stop.to_string()).map(|(b, why)| {
            let task = Task::sampled(TaskKind::Given, samples.clone(), Some(b), &judge.machine).ok();
            task.map(|task| Candidate { way: "on-plane", why, task }).into_iter().collect()
        });
        Ok((usual, candidates))
    }

    /// Says what a person should know of the samples.
    fn warn(&self, found: &Read, samples: &Samples, motion: Option<&Motion>, answer: &Answer) {
        let unit = if found.content == Content::Drives { "rad/s²" } else { "m/s²" };
        let Some(peaks) = second_derivatives(samples) else { return };
        for ((name, uncertainty), peak) in found.names.iter().zip(&answer.uncertainty).zip(peaks) {
            if *uncertainty > 0.05 * peak && peak > 1e-9 {
                say(format!(
                    "note: the second derivative of {name} is uncertain by some {} {unit}, of a peak of {}: noise, or too \
                     few digits or samples{}",
                    fixed(*uncertainty, 4),
                    fixed(peak, 4),
                    if self.smooth.is_some() { "" } else { "; --smooth HZ takes what is faster out" },
                ));
            }
        }
        if let Some(account) = answer.given.as_ref().filter(|account| account.past_limits > 0.0) {
            let what = if found.content == Content::Drives { "the motion as given" } else { "minimum-norm rates" };
            say(format!(
                "note: {what}: relative angles pass their limits by up to {} rad",
                fixed(account.past_limits, 4)
            ));
        }
        if let (Some(account), Some(_)) = (&answer.given, motion)
            && account.speed_end > 1e-3 * account.peak_speed.iter().fold(0.0, |m: f64, x| m.max(*x))
        {
            say(format!(
                "note: the motion does not end at rest ({} rad/s): after it control brakes",
                fixed(account.speed_end, 4)
            ));
        }
    }
}

/// The angles of single drives lifted by whole turns where that brings the first pose within the joint limits: a file may
/// hold angles that were wrapped.
fn within_limits(machine: &Machine, samples: &Samples) -> Samples {
    let first = samples.values(0);
    let mut lift = vec![0.0; samples.columns()];
    for angle in machine.angles() {
        let a = first[angle.to] + lift[angle.to] - first[angle.from] - lift[angle.from] + angle.offset;
        let (low, high) = (*angle.limits.start(), *angle.limits.end());
        let turns = ((low - a) / TAU).ceil() * TAU;
        if !(low..=high).contains(&a) && a + turns <= high {
            lift[angle.to] += turns;
        }
    }
    for (k, lift) in lift.iter().enumerate().filter(|(_, lift)| **lift != 0.0) {
        let turns = lift / TAU;
        say(format!(
            "note: q{} lifted by {turns:+.0} turns, so that the relative angles begin within their limits",
            k + 1
        ));
    }
    let row = |i: usize| samples.values(i).iter().zip(&lift).map(|(q, lift)| q + lift).collect();
    if lift.iter().all(|lift| *lift == 0.0) {
        return samples.clone();
    }
    samples.with_values((0..samples.count()).map(row)).unwrap_or_else(|| samples.clone())
}

/// Largest second derivative of each column at the samples, its unit/s².
fn second_derivatives(samples: &Samples) -> Option<Vec<f64>> {
    let path = samples.path(0.0)?;
    let per = samples.duration().powi(-2);
    let peak = |k: usize| path.nodes().iter().fold(0.0, |m: f64, node| m.max((node.second[k] * per).abs()));
    Some((0..samples.columns()).map(peak).collect())
}

impl Judge {
    /// A candidate, planned and simulated.
    ///
    /// Errors say why it cannot be carried out.
    fn proposal(&self, candidate: &Candidate, scenario: &Scenario, given: Option<&Motion>) -> Result<Proposal, String> {
        let run = replay(scenario, |_, _| {}).map_err(|refusal| refusal.to_string())?;
        let peaks = run.frame().peaks;
        let motion = &run.plan().motion;
        let deviation =
            given.map(|given| Deviation::between(self.machine.tip(), &self.model, given, motion, self.instants));
        let account = self.account(motion);
        Ok(Proposal {
            way: candidate.way,
            why: candidate.why.clone(),
            b: account.b_mean,
            tip_deviation: deviation.as_ref().map_or(0.0, |d| d.tip),
            joint_deviation: deviation.as_ref().map_or_else(Vec::new, |d| d.joints.to_vec()),
            rms_deviation: deviation.as_ref().map_or(0.0, |d| d.rms),
            account,
            simulated_peak_base_moment: peaks.moment,
            simulated_peak_base_force: peaks.force,
            reactionless: peaks.is_reactionless(),
        })
    }

    /// Why holding b is not enough.
    fn not_quiet(&self, proposal: &Proposal, given: Option<&Account>) -> String {
        let most = |a: &Account| a.peak_torque.iter().fold(0.0, |m: f64, x| m.max(*x));
        if given.is_some_and(|given| most(&proposal.account) < 1e-6 * most(given)) {
            return "on a plane nothing of the motion is left: all of it turns the arm as a whole".into();
        }
        let what = format!(
            "with b held the machine still transmits up to {:.2e} N m and {:.2e} N",
            proposal.simulated_peak_base_moment, proposal.simulated_peak_base_force
        );
        let balanced = self.model.is_force_balanced() && self.model.is_invariant();
        match balanced {
            false => format!("{what}: it is not balanced; `stillbase design` mends that, `stillbase check` says where"),
            true => format!("{what}: the samples are too rough or too dense for their digits; want --smooth, or fewer"),
        }
    }
}

/// `quiet.toml` gives `quiet-given.toml`.
fn beside(file: &FilePath) -> PathBuf {
    file.with_file_name(format!("{}-given.toml", stem(file)))
}

fn stem(file: &FilePath) -> String {
    file.file_stem().map_or_else(|| "import".into(), |stem| stem.to_string_lossy().into_owned())
}

fn table(answer: &Answer) -> String {
    let usual = if answer.content == "tip" { "minimum norm" } else { "as given" };
    let mut table = Table::new(["", usual, "proposed", ""]).with_words(3);
    let cell = |value: Option<f64>, decimals| value.map_or_else(|| "-".into(), |x| fixed(x, decimals));
    let (given, proposal) = (answer.given.as_ref(), answer.proposal.as_ref());
    let mut row = |name: &str, of: &dyn Fn(&Account) -> f64, decimals: usize, unit: &str| {
        let both = [given.map(of), proposal.map(|p| of(&p.account))];
        table.row([name.into(), cell(both[0], decimals), cell(both[1], decimals), unit.into()]);
    };
    row("peak |n_B|", &|a| a.peak_base_moment, 9, "N m");
    row("rms n_B", &|a| a.rms_base_moment, 9, "N m");
    row("∫ |n_B| dt", &|a| a.moment_impulse, 9, "N m s");
    row("peak |f_B|", &|a| a.peak_base_force, 9, "N");
    row("rms f_B", &|a| a.rms_base_force, 9, "N");
    let drives = given.or(proposal.map(|p| &p.account)).map_or(0, |a| a.peak_torque.len());
    for k in 0..drives {
        row(&format!("peak |τ_{}|", k + 1), &|a| a.peak_torque[k], 6, "N m");
    }
    row("least b", &|a| a.b_range[0], 6, "rad");
    row("greatest b", &|a| a.b_range[1], 6, "rad");
    row("momentum at the end", &|a| a.angular_momentum_end, 9, "kg m²/s");
    if let Some(p) = proposal {
        let mut row = |name: String, value: f64, decimals: usize, unit: &str| {
            table.row([name, String::new(), fixed(value, decimals), unit.into()]);
        };
        if given.is_some() {
            row("end effector off by up to".into(), p.tip_deviation, 9, "m");
            for (k, off) in p.joint_deviation.iter().enumerate() {
                row(format!("drive {} off by up to", k + 1), *off, 6, "rad");
            }
            row("drives off, rms".into(), p.rms_deviation, 6, "rad");
        }
        row("simulated: peak |n_B|".into(), p.simulated_peak_base_moment, 9, "N m");
    }
    let way = proposal.map(|p| {
        let kept = match p.way {
            "turned" => "the relative joint angles kept, the arm turned as a whole",
            "same-tip" => "the end effector's motion kept",
            _ => "the end effector's motion on one plane",
        };
        format!("\nproposed: b = {} rad, {kept}: {}\nreactionless: {}\n", fixed(p.b, 6), p.why, yes(p.reactionless))
    });
    let smoothed = answer
        .smoothed_at
        .zip(answer.smoothed_by)
        .map(|(at, by)| format!("smoothed at {} Hz, samples moved by up to {}\n", fixed(at, 3), fixed(by, 9)));
    format!(
        "{} samples over {} s\n{}{}{}",
        answer.samples,
        fixed(answer.duration, 6),
        smoothed.unwrap_or_default(),
        table.to_string().trim_start_matches('\n'),
        way.unwrap_or_default()
    )
}
