//! `stillbase plan`

use std::path::{Path, PathBuf};

use clap::Args;
use stillbase_files::{FoundMachine, is_standard, scenario_on_free_base, text};
use stillbase_mechanics::arm_on_base::FloatingBase;
use stillbase_mechanics::planar::Vector;
use stillbase_planning::common::starting_b;
use stillbase_planning::off_plane::least_reaction::FixedB;
use stillbase_planning::pose_constant::PoseConstant;
use stillbase_planning::pose_space::PoseSpace;
use stillbase_planning::timing::TimeLaw;
use stillbase_session::scenario::{FileContent, PathShape, Scenario, Task, TaskChange, TaskKind, content};
use stillbase_session::verdict::{Statements, StatusLight};
use stillbase_session::{Run, with_start_edits};
use stillbase_simulation::plant::{BaseKind, PlantDifferences};
use stillbase_study::plan_summary::PlanSummary;

use super::exit::print_message;
use super::failure::Failure;
use super::input::{
    DEFAULT_SCENARIO, Settings, above_zero, change_task, choice, no_use, overlay_settings, overlay_unchecked, point,
    pose_constant, pose_space, refuse_ineffective, report_idle, report_left_out, report_tolerance,
};
use super::output::{Format, TextTable, write_file};
use super::progress::{check, goes_on};
use super::strict::{Strict, bad_statements};
use stillbase_settings::number::{counted, fixed, significant};
use stillbase_settings::word::Choice;

/// Name of a plan for a machine, unless an output file gives it another.
const DEFAULT_NAME: &str = "plan";

/// Plan a motion through points: find a feasible b, the path, the timing and the cost
///
/// A path that cannot be followed is refused before anything moves. The message names the first infeasible point, the
/// reason, the nearest feasible b and the longest feasible part. The plan can be written as a scenario, to be
/// simulated, recorded, or opened in the window.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase plan nine-link 0.5,0.5 0.6,0.7 0.55,0.9 --shape spline
  stillbase plan nine-link 0.5,0.5 0.55,0.9 --shape line --b 2.4 --law fastest
  stillbase plan nine-link 0.6,0.6 0.52,0.68 0.44,0.6 --shape arc --closed -o circle.toml
  stillbase plan case-3 --set task.law=septic --json")]
pub struct PlanArguments {
    /// A built-in machine or scenario, or a TOML file of either
    #[arg(value_name = "MACHINE|SCENARIO")]
    name: String,
    /// Points of the end effector in base axes, m, in order; default: those of the scenario
    #[arg(value_name = "X,Y", value_parser = point)]
    points: Vec<Vector>,
    /// Pose constant at the first point, rad. Default: the middle of the interval feasible for all points, or else for
    /// the first point. Without points, the default is that of the scenario
    #[arg(long, value_name = "B", value_parser = pose_constant)]
    b: Option<f64>,
    /// Method that resolves the redundancy
    #[arg(long, value_parser = choice(kinds()))]
    kind: Option<TaskKind>,
    /// Shape of the path between the points
    #[arg(long, value_parser = choice(PathShape::ALL.iter().copied()))]
    shape: Option<PathShape>,
    /// Return to the first point
    #[arg(long)]
    closed: bool,
    /// Round corners off, from this distance before them, m (rad for joint lines); by default the motion rests there
    #[arg(long, value_name = "DISTANCE", value_parser = above_zero)]
    blend: Option<f64>,
    /// Time law
    #[arg(long, value_name = "LAW", value_parser = choice(TimeLaw::ALL.iter().copied()))]
    law: Option<TimeLaw>,
    /// Duration, s, for time laws that do not determine it themselves
    #[arg(long, value_name = "T", value_parser = above_zero)]
    time: Option<f64>,
    /// Number of cycles along a closed path, for zero-momentum
    #[arg(long, value_name = "N")]
    cycles: Option<u32>,
    /// Pose constant at the last point, rad; default: for change-b the nearest that is feasible there, for
    /// least-reaction free
    #[arg(long, value_name = "B", value_parser = pose_constant)]
    b_to: Option<f64>,
    /// Upper bound on |n_B| while b changes, N m, for change-b; it determines the time
    #[arg(long, value_name = "N_B", value_parser = above_zero)]
    moment_limit: Option<f64>,
    /// Mass, kg, and inertia, kg m², of a freely floating base, to compute by how much change-b would turn it
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
    strict: Strict,
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

/// Returns the kinds of tasks that can be planned from points alone.
fn kinds() -> impl Iterator<Item = TaskKind> {
    TaskKind::ALL.iter().copied().filter(|kind| !matches!(kind, TaskKind::SameTip | TaskKind::Given))
}

impl PlanArguments {
    /// Plans, prints, and writes the scenario if requested.
    pub fn run(&self) -> Result<(), Failure> {
        if let Some(file) = &self.output {
            self.format.check_output(file, self.force, &["toml"])?;
        }
        let mut scenario = self.scenario()?;
        // A motion can be planned for a machine without a pose space, too.
        let space = pose_space(&scenario.machine).ok();
        let run = Run::new(&scenario);
        let answer = PlanSummary::of(&scenario, space.as_ref(), run.as_ref(), self.base.as_ref(), &mut |_| goes_on());
        check()?;
        let answer = answer.map_err(|e| Failure::wrong_input(e).with_context("--base"))?;
        if run.is_ok() || self.format.json {
            self.format.print(&answer, table)?;
        }
        let run = match run {
            Ok(run) => run,
            Err(refusal) => {
                let refusal = Failure::from(refusal);
                let proposals = answer.obstacle.map(|obstacle| obstacle.proposals).unwrap_or_default();
                return Err(refusal.with_proposals(proposals));
            }
        };
        let Statements { machine, plan, .. } = Statements::of(&run, &run.frame());
        let over = answer.cost.and_then(|cost| cost.over);
        let over = over
            .map(|(limit, factor)| format!("past a limit of a drive: {limit}, by the factor {}", significant(factor)));
        if let Some(file) = &self.output {
            // The name of the file tells plans apart in a recording or a table.
            if scenario.name == DEFAULT_NAME {
                let stem = file.file_stem().filter(|_| !is_standard(file));
                scenario.name = stem.map_or_else(|| DEFAULT_NAME.into(), |s| s.to_string_lossy().into());
            }
            write_file(file, scenario.to_toml().as_bytes(), self.force)?;
        }
        // On a free base, a plan without momentum makes up for a machine that is not balanced.
        let is_made_up = scenario.base.kind == BaseKind::Free && plan.outcome == StatusLight::Good;
        let statements = [("machine", &machine), ("plan", &plan)].into_iter().skip(usize::from(is_made_up));
        self.strict.require(bad_statements(statements).chain(over))
    }

    /// Refuses options that have no effect on the task. Prints a note if the plan leaves out properties of plant or
    /// base.
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
            if let Some(want) = scenario.condition_for_effect(&format!("task.{key}")).filter(|_| given) {
                let option = if key == "from" { "X,Y".into() } else { format!("--{}", key.replace('_', "-")) };
                return Err(no_use(&option, want));
            }
        }
        if self.base.is_some() && task.kind != TaskKind::ChangeB {
            return Err(no_use("--base", "the kind change-b: only a change of b turns the base"));
        }
        if scenario.plant != PlantDifferences::default() || scenario.base.kind == BaseKind::Compliant {
            print_message("note: a plan is of the model; what differs in the plant or the base shows in `simulate`");
        }
        Ok(())
    }

    /// Returns the scenario that the arguments define.
    fn scenario(&self) -> Result<Scenario, Failure> {
        let known = Scenario::builtin(&self.name).is_some();
        let is_scenario = known || content_of(&self.name) == Some(FileContent::Scenario);
        let as_machine = stillbase_files::found_machine(&self.name);
        if self.output.is_none() {
            self.settings.refuse_tolerances()?;
        }
        let mut scenario = match as_machine {
            Ok(FoundMachine { machine, design, left_out, base, .. }) if !is_scenario => {
                report_left_out(&self.name, &left_out);
                if self.points.is_empty() {
                    return Err(Failure::wrong_input("a machine alone is no task: want points X,Y, or a scenario"));
                }
                if base.is_some() || scenario_on_free_base(&machine).is_some() {
                    print_message(format!(
                        "note: {}: planned on a base that is held, though it floats elsewhere: want a scenario, as \
                         import-model writes one, to plan with its base",
                        self.name
                    ));
                }
                let own = overlay_unchecked(DEFAULT_SCENARIO, &Settings::default())?;
                let with = Scenario {
                    machine,
                    design,
                    name: DEFAULT_NAME.into(),
                    title: String::new(),
                    summary: String::new(),
                    compare_b: None,
                    ..own
                };
                overlay_settings(with, &self.settings)?
            }
            // An invalid file of a machine gives the error of a machine; any other name, that of a scenario.
            Err(wrong) if content_of(&self.name) == Some(FileContent::Machine) => return Err(wrong.into()),
            _ => {
                let found = overlay_unchecked(&self.name, &self.settings)?;
                // A written scenario keeps its tolerances for other commands.
                if self.output.is_none() {
                    report_tolerance(&found);
                }
                let (start, later) = with_start_edits(&found)?;
                if later > 0 {
                    print_message(format!("note: the plan leaves out {} after the start", counted(later, "edit")));
                }
                start
            }
        };
        let mut change = TaskChange::new();
        match Task::visiting(&self.points) {
            Some(points) => change.extend(points),
            None if self.points.is_empty() => {}
            None => return Err(Failure::wrong_input("one point is no path: want at least two")),
        }
        let words = [
            ("kind", self.kind.map(|kind| kind.words().file)),
            ("shape", self.shape.map(|shape| shape.words().file)),
            ("law", self.law.map(|law| law.words().file)),
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
        // A setting wins over the option for the same key, so that a proposed setting works behind any command line.
        if !change.is_empty() {
            scenario = overlay_settings(scenario, &self.settings)?;
        }
        let points = scenario.task.points();
        let chosen = self.kind.is_some() || self.settings.sets("task.kind") || known;
        // A machine without a pose constant moves with minimum-norm rates.
        if !chosen
            && !self.points.is_empty()
            && let none @ PoseConstant::None(_) = PoseConstant::of(&scenario.machine)
        {
            print_message(format!(
                "note: {}: pose constant {none}; planned as minimum-norm, which may cause reactions on the base",
                scenario.machine.name()
            ));
            scenario.task.kind = TaskKind::MinimumNorm;
        }
        self.check_use(&scenario)?;
        refuse_ineffective(&scenario, &self.settings)?;
        // With another kind, keys of a built-in task may lose their effect, but the user has not given them.
        if self.kind.is_none() || Scenario::builtin(&scenario.name).is_none() {
            report_idle(&scenario);
        }
        let is_stated = self.b.is_some() || self.settings.sets("task.b") || scenario.task.start.is_some();
        if !is_stated && !self.points.is_empty() {
            let machine = &scenario.machine;
            let space = PoseSpace::of(machine).or_else(|_| PoseSpace::nominal(machine)).ok();
            scenario.task.b = space.and_then(|space| starting_b(&space, &points)).unwrap_or(0.0);
        }
        Ok(scenario)
    }
}

/// Returns the kind of content of a file; `None` for a built-in scenario, or if there is no such file.
fn content_of(name: &str) -> Option<FileContent> {
    if Scenario::builtin(name).is_some() { None } else { content(&text::read(Path::new(name)).ok()?) }
}

fn table(answer: &PlanSummary) -> String {
    let mut table = TextTable::new(["", "", ""]).with_words(2);
    let mut row = |name: &str, value: f64, decimals: usize, unit: &str| {
        table.row([name.to_owned(), fixed(value, decimals), unit.into()]);
    };
    if answer.has_b {
        row("b", answer.b, 6, "rad");
    }
    for [low, high] in &answer.b_common {
        row("all points from b", *low, 6, "rad");
        row("            to b", *high, 6, "rad");
    }
    let Some(cost) = &answer.cost else { return table.to_string().trim_start().to_owned() };
    row("time", cost.duration, 6, "s");
    for (k, value) in cost.peak_torque.iter().enumerate() {
        row(&format!("peak |τ_{}|", k + 1), *value, 6, "N m");
    }
    for (k, value) in cost.peak_speed.iter().enumerate() {
        row(&format!("peak |q̇_{}|", k + 1), *value, 6, "rad/s");
    }
    row("peak |n_B|", cost.peak_base_moment, 9, "N m");
    row("∫ |n_B| dt", cost.moment_impulse, 9, "N m s");
    row("peak |f_B|", cost.peak_base_force, 9, "N");
    for (name, value, unit) in [
        ("the base turns by up to", cost.base_angle, "rad"),
        ("angle of the base at the end", cost.base_angle_end, "rad"),
        ("the base shifts by up to", cost.base_shift, "m"),
        ("momentum of a wheel that holds it", cost.wheel_momentum, "N m s"),
        ("torque of this wheel", cost.peak_wheel_torque, "N m"),
    ] {
        value.into_iter().for_each(|value| row(name, value, 9, unit));
    }
    let mut row = |name: &str, value: f64, unit: &str| table.row([name.to_owned(), fixed(value, 6), unit.into()]);
    cost.loop_length.into_iter().for_each(|length| row("length of a loop of the drives", length, "rad"));
    if let Some(price) = &cost.price {
        row("Δb", price.delta_b, "rad");
        row("least peak |n_B| of any motion", price.least_peak, "N m");
        price.base_turn.iter().for_each(|turn| row("the base turns by", *turn, "rad"));
    }
    if let Some(ways) = &cost.alternatives {
        row("least reaction: peak |n_B|", ways.least.peak, "N m");
        row("                root mean square", ways.least.rms, "N m");
        if let Ok(norm) = &ways.minimum_norm {
            row("minimum norm: peak |n_B|", norm.reaction.peak, "N m");
            row("              root mean square", norm.reaction.rms, "N m");
        }
        if let FixedB::Leaves { u, .. } = ways.fixed {
            row("fixed b: serves until", u, "of T");
        }
    }
    for (i, drift) in cost.drift.iter().enumerate() {
        row(&format!("drift after cycle {}", i + 1), *drift, "rad");
    }
    if let Some((limit, factor)) = &cost.over {
        row(&format!("{limit} over its limit"), *factor, "times");
    }
    let held = cost.limiting.iter().map(|limit| {
        let gap = cost.gap.filter(|gap| *gap > 5e-4);
        let gap = gap.map_or(String::new(), |gap| format!(", {:.1} % longer than with unlimited jerk", 100.0 * gap));
        format!("\nheld back by the {limit}{gap}\n")
    });
    let rests = cost.blended.map_or(String::new(), |blended| {
        format!("\nrests at its corners, which is faster: rounded off it would take {blended:.6} s\n")
    });
    format!("{}{}{rests}", table.to_string().trim_start(), held.collect::<String>())
}
