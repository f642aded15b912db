//! `stillbase import`

mod answer;
mod freedoms;
mod judge;
mod table;
mod ways;

use std::f64::consts::TAU;
use std::path::{Path as FilePath, PathBuf};

use clap::Args;
use stillbase::files::{finish_all, made};
use stillbase::mechanics::dynamics::Surroundings;
use stillbase::mechanics::machine::{Inertia, Machine};
use stillbase::mechanics::planar::Vector;
use stillbase::planning::Motion;
use stillbase::planning::curves::Samples;
use stillbase::planning::pose_space::{NoPoseSpace, PoseSpace};
use stillbase::session::scenario::{Scenario, Task, TaskKind};

use super::columns::{Content, Read, samples};
use super::exit::say;
use super::failure::Failure;
use super::input::{DEFAULT_SCENARIO, Settings, above_zero, pose_constant, read};
use super::output::{Format, check_output};
use answer::Answer;
use judge::Judge;
use stillbase::settings::number::fixed;
use table::table;
use ways::{Asked, Keep, Ways, of_drives, of_tip};

/// Read a motion of your own from CSV, report what it does to the base, and propose the nearest reactionless one
///
/// The file has a header: t,q1,q2,q3 for absolute drive angles, or t,x,y for the end effector, in any order, with units
/// if wanted: "t (ms)", "q1 (deg)", "x (mm)"; without them s, rad, m. Other columns are left alone. A quintic spline
/// goes through every sample. The proposal keeps the timing and holds b: with the end effector where it was if some
/// plane reaches all of its path, else with the arm turned as a whole. It is simulated before it is called
/// reactionless.
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
    /// Pose constant of the proposal, rad; by default the one that moves the drives least, or the middle of what serves
    /// x and y
    #[arg(long, value_name = "B", value_parser = pose_constant)]
    b: Option<f64>,
    /// Smooth the samples without delay: half of the amplitude is left at this frequency, Hz
    #[arg(long, value_name = "HZ", value_parser = above_zero)]
    smooth: Option<f64>,
    /// Which columns to take, where a file has both; by default the drives
    #[arg(long, value_enum)]
    columns: Option<Content>,
    /// What the proposal keeps of given drive angles: the end effector's motion, or the relative joint angles; by
    /// default the end effector's, if some plane reaches all of it
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

impl Import {
    /// Reads the samples, prints what they do to the base, and writes the proposal if asked.
    pub fn run(&self) -> Result<(), Failure> {
        let files = self.output.as_deref().map(|file| [file.to_owned(), beside(file)]);
        for file in files.iter().flatten() {
            check_output(file, self.force, &["toml"])?;
        }
        let machine = self.settings.apply(stillbase::files::machine(&self.machine, None)?)?;
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
            space: PoseSpace::of(&machine),
            instants: (8 * samples.count()).clamp(4000, 200_000),
            machine,
        };
        let asked = Asked { b: self.b, keep: self.keep };
        let drives = found.content == Content::Drives;
        let Ways { given: motion, candidates } = match &judge.space {
            Ok(space) => match space.planes() {
                Ok(planes) if drives => of_drives(&asked, &judge, planes, &samples)?,
                Ok(planes) => of_tip(&asked, &judge, (space, planes), &samples)?,
                Err(_) if drives => freedoms::of_drives(&asked, &judge, space, &samples)?,
                Err(_) => freedoms::of_tip(&asked, &judge, space, &samples)?,
            },
            Err(NoPoseSpace::Free) => freedoms::as_given(&judge, &samples, drives)?,
            Err(why) => {
                let given = freedoms::as_given(&judge, &samples, drives)?;
                Ways { candidates: Err(why.to_string()), ..given }
            }
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
            b_samples: (found.content == Content::Drives).then(|| {
                let lambda = judge.model.lambda();
                let all = (0..samples.count()).map(|i| lambda.dot(samples.values(i)));
                all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], b| [low.min(b), high.max(b)])
            }),
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
                            answer.reason = Some(judge.why_not_reactionless(&proposal, answer.given.as_ref()));
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
            // Where the proposal is, what it was made of is too.
            let given_first = [(given, own.to_toml()), (file, chosen.to_toml())];
            let [given_file, chosen_file] = given_first.map(|(file, text)| made(file, text.as_bytes(), self.force));
            finish_all([given_file?, chosen_file?])?;
            say(format!("wrote {} and {}", file.display(), given.display()));
        }
        Ok(())
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
                    if self.smooth.is_some() { "" } else { "; --smooth HZ removes higher frequencies" },
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

/// The angles of single drives lifted by whole turns where that brings the first pose within the joint limits: a file
/// may hold angles that were wrapped.
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

/// `quiet.toml` gives `quiet-given.toml`.
fn beside(file: &FilePath) -> PathBuf {
    file.with_file_name(format!("{}-given.toml", stem(file)))
}

fn stem(file: &FilePath) -> String {
    file.file_stem().map_or_else(|| "import".into(), |stem| stem.to_string_lossy().into_owned())
}
