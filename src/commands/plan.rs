//! `stillbase plan`

use std::path::{Path, PathBuf};

use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::{Args, ValueEnum};
use serde::Serialize;
use stillbase::files::{text, write_new};
use stillbase::mechanics::machine::Inertia;
use stillbase::mechanics::planar::Vector;
use stillbase::planning::common;
use stillbase::planning::following::Blocked;
use stillbase::planning::off_plane::least_reaction::{FixedB, Verdicts};
use stillbase::planning::off_plane::price::FloatingBase;
use stillbase::planning::pose_constant::PoseConstant;
use stillbase::planning::pose_space::PoseSpace;
use stillbase::planning::reactionless::BSet;
use stillbase::planning::timing::TimeLaw;
use stillbase::session::scenario::{Change, Content, Scenario, Task, TaskKind, content};
use stillbase::session::{Refusal, Run, settled};
use stillbase::simulation::plant::PlantDifferences;

use super::exit::say;
use super::failure::Failure;
use super::input::{
    DEFAULT_SCENARIO, Settings, above_zero, change_task, laid, no_use, none_idle, point, pose_constant, pose_space,
    stated, tell_idle, tell_tolerance,
};
use super::output::{Format, Table, check_output};
use super::reach::OfMend;
use stillbase::settings::number::{counted, fixed};
use stillbase::settings::word::{Choice, Words};

/// What a plan of a machine is called until a file gives it a name.
const NAMELESS: &str = "plan";

/// Plan a motion through points: which b serves them, along what, how fast, at what cost
///
/// What cannot be followed is refused before anything moves, with the first point of failure, its reason, the nearest b
/// that would do and the longest part that can be followed. The plan can be written as a scenario, to be simulated,
/// recorded, or opened in the window.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase plan nine-link 0.5,0.5 0.6,0.7 0.55,0.9 --shape spline
  stillbase plan nine-link 0.5,0.5 0.55,0.9 --shape line --b 2.4 --law fastest
  stillbase plan nine-link 0.6,0.6 0.52,0.68 0.44,0.6 --shape arc --closed -o circle.toml
  stillbase plan case-3 --set task.law=septic --json")]
pub struct Plan {
    /// A built-in machine or scenario, or a TOML file of either
    #[arg(value_name = "MACHINE|SCENARIO")]
    name: String,
    /// Points of the end effector in base axes, m: from the first to the last; none keeps a scenario's own
    #[arg(value_name = "X,Y", value_parser = point)]
    points: Vec<Vector>,
    /// Pose constant at the first point, rad; by default the middle of what serves all points, or else the first point;
    /// without points the scenario's
    #[arg(long, value_name = "B", value_parser = pose_constant)]
    b: Option<f64>,
    /// How the redundancy is resolved
    #[arg(long, value_enum)]
    kind: Option<Kind>,
    /// What joins the points
    #[arg(long, value_enum)]
    shape: Option<ShapeName>,
    /// Return to the first point
    #[arg(long)]
    closed: bool,
    /// Round corners off, from this far before them, m (rad for joint lines); otherwise the motion rests there
    #[arg(long, value_name = "DISTANCE", value_parser = above_zero)]
    blend: Option<f64>,
    /// Time law
    #[arg(long, value_name = "LAW", value_parser = laws())]
    law: Option<String>,
    /// Time, s, for the laws that do not find it themselves
    #[arg(long, value_name = "T", value_parser = above_zero)]
    time: Option<f64>,
    /// How often a closed path is run through, for zero-momentum
    #[arg(long, value_name = "N")]
    cycles: Option<u32>,
    /// Pose constant at the last point, rad: for change-b by default the nearest that serves it, for least-reaction
    /// free
    #[arg(long, value_name = "B", value_parser = pose_constant)]
    b_to: Option<f64>,
    /// Bound on |n_B| while b changes, N m, for change-b: it sets the time
    #[arg(long, value_name = "N_B", value_parser = above_zero)]
    moment_limit: Option<f64>,
    /// A base that floats freely, with its mass, kg, and inertia, kg m²: by how much would change-b turn it
    #[arg(long, value_name = "MASS,INERTIA", value_parser = floating_base)]
    base: Option<FloatingBase>,
    /// Write the plan as a scenario
    #[arg(short, long, value_name = "FILE.toml")]
    output: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    settings: Settings,
    #[command(flatten)]
    format: Format,
}

fn floating_base(text: &str) -> Result<FloatingBase, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|x| x.trim().parse()).collect();
    match numbers.as_deref() {
        Ok(&[mass, inertia]) => Ok(FloatingBase { mass, inertia, com: Vector::default() }),
        _ => Err("want MASS,INERTIA, such as 40,3".into()),
    }
}

#[derive(Clone, Copy, ValueEnum)]
enum Kind {
    /// b is held: nothing reaches the base
    Reactionless,
    /// Minimum-norm joint rates
    MinimumNorm,
    /// b changes as little as it must
    LeastReaction,
    /// From one plane to another, at a price
    ChangeB,
    /// At zero momentum, whatever the machine
    ZeroMomentum,
}

#[derive(Clone, Copy, ValueEnum)]
enum ShapeName {
    JointLine,
    Line,
    Arc,
    Spline,
    Freehand,
}

/// Every time law by its name in files.
fn laws() -> PossibleValuesParser {
    PossibleValuesParser::new(TimeLaw::ALL.iter().map(|law| {
        let Words { file, meaning, .. } = law.words();
        PossibleValue::new(file).help(meaning)
    }))
}

#[derive(Serialize)]
struct Answer {
    feasible: bool,
    /// Why there is no plan.
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
    scenario: String,
    /// At the start.
    b: f64,
    #[serde(skip)]
    has_b: bool,
    b_common: Vec<[f64; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    duration: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    q_start: Option<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    q_end: Option<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    b_range: Option<[f64; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    peak_torque: Option<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    peak_speed: Option<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    peak_base_moment: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    moment_impulse: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    peak_base_force: Option<f64>,
    /// For the fastest motion: the limit that leads.
    #[serde(skip_serializing_if = "Option::is_none")]
    limiting: Option<String>,
    /// For the fastest smooth motion: T/T* − 1, T* without limits on jerk.
    #[serde(skip_serializing_if = "Option::is_none")]
    gap: Option<f64>,
    /// T with corners rounded off, where the motion rests at them because that is faster.
    #[serde(skip_serializing_if = "Option::is_none")]
    blended: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    price: Option<OfPrice>,
    #[serde(skip_serializing_if = "Option::is_none")]
    alternatives: Option<OfVerdicts>,
    /// The limit of a drive that is passed by most, and by what factor.
    #[serde(skip_serializing_if = "Option::is_none")]
    over: Option<(String, f64)>,
    #[serde(skip)]
    closed: bool,
    /// The drives at the start and after each cycle.
    #[serde(skip_serializing_if = "Option::is_none")]
    cycles: Option<Vec<Vec<f64>>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    blocked: Option<OfBlocked>,
    /// The b nearest to the one asked for at which it can be done.
    #[serde(skip_serializing_if = "Option::is_none")]
    mending_b: Option<f64>,
    /// The least move of one point after which all have a b in common.
    #[serde(skip_serializing_if = "Option::is_none")]
    mend: Option<OfMend>,
}

/// What a change of b costs.
#[derive(Serialize)]
struct OfPrice {
    delta_b: f64,
    /// Of any motion in this time.
    least_peak: f64,
    /// How much a base given by --base turns.
    #[serde(skip_serializing_if = "Option::is_none")]
    base_turn: Option<f64>,
}

/// Three ways to make the same motion of the end effector.
#[derive(Serialize)]
struct OfVerdicts {
    fixed_b_serves: bool,
    /// t/T from which on it does not.
    #[serde(skip_serializing_if = "Option::is_none")]
    fixed_b_until: Option<f64>,
    least_peak: f64,
    least_rms: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    minimum_norm_peak: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    minimum_norm_rms: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    minimum_norm_keeps_limits: Option<bool>,
}

impl From<&Verdicts> for OfVerdicts {
    fn from(verdicts: &Verdicts) -> Self {
        let until = match verdicts.fixed {
            FixedB::Serves => None,
            FixedB::Leaves { u, .. } => Some(u),
        };
        let norm = verdicts.minimum_norm.as_ref().ok();
        Self {
            fixed_b_serves: until.is_none(),
            fixed_b_until: until,
            least_peak: verdicts.least.peak,
            least_rms: verdicts.least.rms,
            minimum_norm_peak: norm.map(|n| n.reaction.peak),
            minimum_norm_rms: norm.map(|n| n.reaction.rms),
            minimum_norm_keeps_limits: norm.map(|n| n.keeps_limits),
        }
    }
}

#[derive(Serialize)]
struct OfBlocked {
    s: f64,
    point: [f64; 2],
    reason: String,
    leaves_workspace: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    nearest_b: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    longest: Option<[f64; 2]>,
}

impl From<&Blocked> for OfBlocked {
    fn from(blocked: &Blocked) -> Self {
        Self {
            s: blocked.s,
            point: [blocked.at.re, blocked.at.im],
            reason: blocked.stop.to_string(),
            leaves_workspace: blocked.leaves_workspace,
            nearest_b: blocked.nearest_b,
            longest: blocked.longest,
        }
    }
}

impl Plan {
    /// Plans, prints, and writes the scenario if asked.
    pub fn run(&self) -> Result<(), Failure> {
        if let Some(file) = &self.output {
            check_output(file, self.force, &["toml"])?;
        }
        let mut scenario = self.scenario()?;
        // What a machine without a b can do all the same, its plan says.
        let space = pose_space(&scenario.machine).ok();
        let has_b = space.is_some();
        let common = space.and_then(|space| common::common(&space, &scenario.task.points()));
        let common = common.map_or(Vec::new(), |set: BSet| set.intervals);
        let mut answer = Answer {
            feasible: true,
            scenario: scenario.name.clone(),
            b: scenario.task.b,
            has_b,
            reason: None,
            b_common: common,
            duration: None,
            q_start: None,
            q_end: None,
            b_range: None,
            peak_torque: None,
            peak_speed: None,
            peak_base_moment: None,
            moment_impulse: None,
            peak_base_force: None,
            limiting: None,
            gap: None,
            blended: None,
            price: None,
            alternatives: None,
            over: None,
            closed: scenario.task.closed,
            cycles: None,
            blocked: None,
            mending_b: None,
            mend: None,
        };
        match Run::new(&scenario) {
            Ok(run) => {
                let plan = run.plan();
                let (forecast, end) = (&plan.forecast, run.planned_time());
                answer.b = forecast.b_start;
                answer.duration = Some(forecast.time);
                answer.q_start = Some(plan.motion.at(0.0).q.to_vec());
                answer.q_end = Some(plan.motion.at(end).q.to_vec());
                answer.over = forecast.over.map(|(limit, factor)| (limit.to_string(), factor));
                answer.b_range = Some(forecast.b);
                answer.peak_torque = Some(forecast.torque.to_vec());
                answer.peak_speed = Some(forecast.speed.to_vec());
                answer.peak_base_moment = Some(forecast.moment);
                answer.moment_impulse = Some(forecast.impulse);
                answer.peak_base_force = Some(forecast.force);
                answer.limiting = plan.pace.and_then(|pace| pace.leading).map(|limit| limit.to_string());
                answer.alternatives = plan.verdicts.as_ref().map(OfVerdicts::from);
                answer.cycles = (!plan.cycles.is_empty()).then(|| plan.cycles.iter().map(|q| q.to_vec()).collect());
                if let Some(price) = plan.price {
                    let model = Inertia::of(&run.scenario().machine);
                    let base_turn = self.base.map(|base| price.base_turn(&model, &base)).transpose();
                    answer.price = Some(OfPrice {
                        delta_b: price.delta_b(),
                        least_peak: price.least_peak(forecast.time),
                        base_turn: base_turn.map_err(|e| Failure::wrong_input(e).of("--base"))?,
                    });
                }
                answer.gap = plan.pace.and_then(|pace| pace.gap());
                answer.blended = plan.blended;
                self.format.print(&answer, table)?;
                if let Some(file) = &self.output {
                    // Several plans can stand in one recording or table then.
                    if scenario.name == NAMELESS {
                        scenario.name =
                            file.file_stem().map_or_else(|| NAMELESS.into(), |s| s.to_string_lossy().into());
                    }
                    write_new(file, scenario.to_toml().as_bytes(), self.force)?;
                    say(format!("wrote {}", file.display()));
                }
                Ok(())
            }
            Err(refusal) => {
                answer.feasible = false;
                answer.reason = Some(refusal.to_string());
                answer.mending_b = refusal.mending_b();
                match &refusal {
                    Refusal::Blocked(blocked) => answer.blocked = Some(blocked.as_ref().into()),
                    Refusal::NoCommonPlane { why, .. } => answer.mend = why.mend.as_ref().map(OfMend::from),
                    _ => {}
                }
                if self.format.json {
                    self.format.print(&answer, |_| String::new())?;
                }
                Err(refusal.into())
            }
        }
    }

    /// Refuses options that the task has no use for, and tells what it leaves out.
    fn check_use(&self, scenario: &Scenario) -> Result<(), Failure> {
        let task = &scenario.task;
        for (given, key) in [
            (!self.points.is_empty(), "from"),
            (self.b.is_some(), "b"),
            (self.shape.is_some(), "shape"),
            (self.law.is_some(), "law"),
            (self.b_to.is_some(), "b_to"),
            (self.moment_limit.is_some(), "moment_limit"),
            (self.cycles.is_some(), "cycles"),
            (self.blend.is_some(), "blend"),
            (self.time.is_some(), "time"),
        ] {
            if let Some(want) = scenario.idle(&format!("task.{key}")).filter(|_| given) {
                let option = if key == "from" { "X,Y".into() } else { format!("--{}", key.replace('_', "-")) };
                return Err(no_use(&option, want));
            }
        }
        if self.base.is_some() && task.kind != TaskKind::ChangeB {
            return Err(no_use("--base", "the kind change-b: only a change of b turns the base"));
        }
        if scenario.plant != PlantDifferences::default() || scenario.base.moves() {
            say("note: a plan is of the model; what differs in the plant or the base shows in `simulate`");
        }
        Ok(())
    }

    /// The scenario that the arguments ask for.
    fn scenario(&self) -> Result<Scenario, Failure> {
        let as_machine = stillbase::files::machine(&self.name, None);
        let known = Scenario::builtin(&self.name).is_some();
        if self.output.is_none() {
            self.settings.none_of_tolerance()?;
        }
        let mut scenario = match as_machine {
            Ok(machine) if !known => {
                if self.points.is_empty() {
                    return Err(Failure::wrong_input("a machine alone is no task: want points X,Y, or a scenario"));
                }
                let own = stated(DEFAULT_SCENARIO, &Settings::default())?;
                let with = Scenario { machine, name: NAMELESS.into(), title: String::new(), compare_b: None, ..own };
                laid(with, &self.settings)?
            }
            // The reader of machines or of scenarios says what is wrong with the file, by what it was meant to be.
            Err(wrong) if meant(&self.name) == Some(Content::Machine) => return Err(wrong.into()),
            _ => {
                let found = stated(&self.name, &self.settings)?;
                // What is written keeps its tolerances for others.
                if self.output.is_none() {
                    tell_tolerance(&found);
                }
                let (start, later) = settled(&found)?;
                if later > 0 {
                    say(format!("note: the plan leaves out {} after the start", counted(later, "edit")));
                }
                start
            }
        };
        let mut change = Change::new();
        match Task::visiting(&self.points) {
            Some(points) => change.extend(points),
            None if self.points.is_empty() => {}
            None => return Err(Failure::wrong_input("one point is no path: want at least two")),
        }
        let word = |value: Option<clap::builder::PossibleValue>| value.map(|v| v.get_name().to_owned());
        let words = [
            ("kind", self.kind.and_then(|k| word(k.to_possible_value()))),
            ("shape", self.shape.and_then(|s| word(s.to_possible_value()))),
            ("law", self.law.clone()),
        ];
        for (key, value) in words.into_iter().filter_map(|(key, value)| Some((key, value?))) {
            change.insert(key.into(), value.into());
        }
        let numbers = [
            ("blend", self.blend),
            ("time", self.time),
            ("b", self.b),
            ("b_to", self.b_to),
            ("moment_limit", self.moment_limit),
        ];
        change.extend(self.cycles.map(|n| ("cycles".to_owned(), i64::from(n).into())));
        for (key, value) in numbers {
            change.extend(value.map(|value| (key.to_owned(), value.into())));
        }
        if self.blend.is_some() {
            change.insert("corners".into(), "blend".into());
        }
        if self.closed {
            change.insert("closed".into(), true.into());
        }
        change_task(&mut scenario, &change)?;
        let points = scenario.task.points();
        let chosen = self.kind.is_some() || self.settings.sets("task.kind") || known;
        // What has no b to hold moves by least rates.
        if !chosen
            && !self.points.is_empty()
            && let none @ PoseConstant::None(_) = PoseConstant::of(&scenario.machine)
        {
            say(format!(
                "note: {}: pose constant {none}; planned as minimum-norm, with what that does to the base",
                scenario.machine.name()
            ));
            scenario.task.kind = TaskKind::MinimumNorm;
        }
        self.check_use(&scenario)?;
        none_idle(&scenario, &self.settings)?;
        // What a built-in task says for its own kind is no word of the person's, who asks for another.
        if self.kind.is_none() || Scenario::builtin(&scenario.name).is_none() {
            tell_idle(&scenario);
        }
        if self.b.is_none() && !self.settings.sets("task.b") && !self.points.is_empty() {
            // As far from every end as it gets; what does not serve all points begins in the middle of what serves the
            // first.
            let machine = &scenario.machine;
            let space = PoseSpace::of(machine).or_else(|_| PoseSpace::nominal(machine)).ok();
            let middle = |points: &[Vector]| common::middle(space.as_ref()?, points);
            scenario.task.b = middle(&points).or_else(|| middle(&points[..1])).unwrap_or(0.0);
        }
        Ok(scenario)
    }
}

/// What a file is meant to be, if there is one of that name.
fn meant(name: &str) -> Option<Content> {
    if Scenario::builtin(name).is_some() { None } else { content(&text::read(Path::new(name)).ok()?) }
}

fn table(answer: &Answer) -> String {
    let mut table = Table::new(["", "", ""]).with_words(2);
    let mut row = |name: String, value: Option<f64>, decimals: usize, unit: &str| {
        if let Some(value) = value {
            table.row([name, fixed(value, decimals), unit.into()]);
        }
    };
    row("b".into(), Some(answer.b).filter(|_| answer.has_b), 6, "rad");
    for [low, high] in &answer.b_common {
        row("all points from b".into(), Some(*low), 6, "rad");
        row("            to b".into(), Some(*high), 6, "rad");
    }
    row("time".into(), answer.duration, 6, "s");
    for (k, value) in answer.peak_torque.iter().flatten().enumerate() {
        row(format!("peak |τ_{}|", k + 1), Some(*value), 6, "N m");
    }
    for (k, value) in answer.peak_speed.iter().flatten().enumerate() {
        row(format!("peak |q̇_{}|", k + 1), Some(*value), 6, "rad/s");
    }
    row("peak |n_B|".into(), answer.peak_base_moment, 9, "N m");
    row("∫ |n_B| dt".into(), answer.moment_impulse, 9, "N m s");
    row("peak |f_B|".into(), answer.peak_base_force, 9, "N");
    let mut row = |name: String, value: Option<f64>, unit: &str| {
        if let Some(value) = value {
            table.row([name, fixed(value, 6), unit.into()]);
        }
    };
    if let Some(price) = &answer.price {
        row("Δb".into(), Some(price.delta_b), "rad");
        row("least peak |n_B| of any motion".into(), Some(price.least_peak), "N m");
        row("the base turns by".into(), price.base_turn, "rad");
    }
    if let Some(ways) = &answer.alternatives {
        row("least reaction: peak |n_B|".into(), Some(ways.least_peak), "N m");
        row("                root mean square".into(), Some(ways.least_rms), "N m");
        row("minimum norm: peak |n_B|".into(), ways.minimum_norm_peak, "N m");
        row("              root mean square".into(), ways.minimum_norm_rms, "N m");
        row("fixed b: serves until".into(), ways.fixed_b_until, "of T");
    }
    if let Some((first, others)) = answer.cycles.iter().flatten().collect::<Vec<_>>().split_first() {
        for (i, q) in others.iter().enumerate() {
            if !answer.closed {
                break;
            }
            let drift = q.iter().zip(first.iter()).map(|(q, start)| (q - start).abs()).fold(0.0, f64::max);
            row(format!("drift after cycle {}", i + 1), Some(drift), "rad");
        }
    }
    if let Some((limit, factor)) = &answer.over {
        row(format!("{limit} over its limit"), Some(*factor), "times");
    }
    let held = answer.limiting.iter().map(|limit| {
        let gap = answer.gap.filter(|gap| *gap > 5e-4);
        let gap =
            gap.map_or(String::new(), |gap| format!(", {:.1} % over the motion with unlimited jerk", 100.0 * gap));
        format!("\nheld back by the {limit}{gap}\n")
    });
    let rests = answer.blended.map_or(String::new(), |blended| {
        format!("\nrests at its corners, which is faster: rounded off it would take {blended:.6} s\n")
    });
    format!("{}{}{rests}", table.to_string().trim_start(), held.collect::<String>())
}
