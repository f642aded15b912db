//! `stillbase design --counterweights --vary`: counterweights at many points.

use std::ops::Range;
use std::path::PathBuf;

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;
use stillbase_mechanics::machine::{Inertia, KEYS, Machine};
use stillbase_planning::Motion;
use stillbase_session::scenario::DesignBrief;
use stillbase_settings::number::{counted, fixed_or_finer};
use stillbase_settings::text::shell_word;
use stillbase_study::counterweights::CounterweightReport;
use stillbase_study::design_space::{Axis, AxisValues, DesignSpace, MAX_POINTS, NoDesignSpace, non_dominated, typed};
use stillbase_study::front_point::FrontPoint;
use stillbase_study::tolerance::shard;

use super::super::failure::Failure;
use super::super::file_form::FileForm;
use super::super::output::TextTable;
use super::super::progress::check;
use super::super::rows::{RowTarget, Rows};
use super::super::tolerance::parse_shard;
use super::DesignArguments;
use super::brief::report_brief;
use super::weighed::{VARIED_OPTIONS, WeightArguments, gap_cell, report_removed};

/// Which settings vary, and where the designs go.
#[derive(Args)]
pub struct VaryArguments {
    /// Find the counterweights for many machines: with each of these values of a setting, or N of them from LO to HI. KEY
    /// is one of --set, or an option: material, thickness, across, clearance, max-mass, max-radius, max-added, max-inertia
    /// or objective; several make a grid
    #[arg(
        long, value_name = "KEY=V1,V2,…|LO:HI[:N]", requires = "counterweights", value_parser = axis,
        conflicts_with_all = ["other_machines", "output", "length"], allow_hyphen_values = true
    )]
    vary: Vec<Axis>,
    /// Take N points that fill the ranges of --vary evenly, instead of a grid
    #[arg(long, value_name = "N", requires = "vary", value_parser = clap::value_parser!(u64).range(1..=MAX_POINTS))]
    points: Option<u64>,
    /// Only the i-th of n equal parts of the points, i from 1
    #[arg(long, value_name = "i/n", requires = "vary", value_parser = parse_shard)]
    shard: Option<(u64, u64)>,
    /// Write every design to this file, .csv or .parquet; `-` is standard output
    #[arg(long, value_name = "FILE", requires = "vary")]
    table: Option<PathBuf>,
    #[command(flatten)]
    form: FileForm,
}

impl VaryArguments {
    /// Returns whether settings vary.
    pub fn is_asked(&self) -> bool {
        !self.vary.is_empty()
    }
}

/// Parses KEY=V1,V2,… or KEY=LO:HI[:N].
fn axis(text: &str) -> Result<Axis, String> {
    let want = || "want KEY=V1,V2,… or KEY=LO:HI:N, as length.l5=0.3:0.6:7, or KEY=LO:HI with --points".to_owned();
    let (key, words) = text.split_once('=').ok_or_else(want)?;
    let number = |word: &str| word.trim().parse().ok().filter(|x: &f64| x.is_finite());
    let values = match *words.split(':').collect::<Vec<_>>() {
        [list] => {
            let all: Vec<String> = list.split(',').map(|word| word.trim().to_owned()).collect();
            AxisValues::Listed(Some(all).filter(|all| all.iter().all(|word| !word.is_empty())).ok_or_else(want)?)
        }
        [low, high, ref count @ ..] if count.len() < 2 => {
            let ends = number(low).zip(number(high)).filter(|(low, high)| low < high);
            let (low, high) = ends.ok_or_else(want)?;
            match count.first() {
                None => AxisValues::Between([low, high]),
                Some(count) => {
                    let count = count.trim().parse().ok().filter(|n: &u32| (2..=1_000_000).contains(n));
                    let last = count.ok_or_else(want)? - 1;
                    let share = |i: u32| f64::from(i) / f64::from(last);
                    let value = |i| typed(low + (high - low) * share(i)).clamp(low, high).to_string();
                    AxisValues::Listed((0..=last).map(value).collect())
                }
            }
        }
        _ => return Err(want()),
    };
    Ok(Axis { key: key.trim().into(), values })
}

/// A design that no other of the study is better than, in mass and in inertia.
#[derive(Clone, Debug, JsonSchema, Serialize)]
pub struct BestDesign {
    /// Number of the point, from 0.
    point: u64,
    /// The settings as options: with the other options of the study they find this design alone, or its whole front.
    options: String,
    /// Added mass, kg.
    added_mass: f64,
    /// Σ D_k, kg m².
    inertia: f64,
    /// Upper bound on how far the objective lies above its minimum, as a share of it; of a front that of mass or Σ D_k, with
    /// a bound on the other. Absent for discs as they are bought.
    #[serde(skip_serializing_if = "Option::is_none")]
    relative_gap: Option<f64>,
    /// Whether the gap is within rounding.
    certified: bool,
}

/// Answer of a study of designs.
#[derive(JsonSchema, Serialize)]
pub struct Answer {
    /// Number of points of the whole study.
    points: u64,
    /// First point of this part, and its last plus one.
    shard: [u64; 2],
    /// Number of points with a design.
    found: u64,
    /// Number of points that have none.
    refused: u64,
    /// The first reasons why points have no design.
    reasons: Vec<Reason>,
    /// Designs that no other is better than in both added mass and Σ D_k, by rising mass.
    best: Vec<BestDesign>,
    /// The file that was written.
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<String>,
}

/// Why a point has no design.
#[derive(JsonSchema, Serialize)]
pub struct Reason {
    /// Reason, in words.
    why: String,
    /// Number of the point, from 0.
    point: u64,
}

/// Most reasons that are told.
const MAX_REASONS: usize = 3;

/// Columns of numbers after those of the settings.
const HEADS: [&str; 7] =
    ["added_mass kg", "inertia kg m²", "torque N m", "workspace m²", "off_by kg m", "relative_gap 1", "certified 1"];

impl DesignArguments {
    /// Finds the counterweights at every point, and prints the best.
    pub fn vary(&self, machine: &Machine, design: &DesignBrief, motion: Option<&Motion>) -> Result<(), Failure> {
        let of = &self.varying;
        let space = DesignSpace::new(of.vary.clone(), of.points).map_err(|why| match why {
            NoDesignSpace::Endless(key) => Failure::wrong_input(format!(
                "--vary {key}: want LO:HI:N with N values, or --points N for all settings"
            )),
            why => Failure::wrong_input(format!("--vary: {why}")),
        })?;
        self.check_axes(machine, space.axes())?;
        let (i, n) = of.shard.unwrap_or((1, 1));
        let points = shard(space.count(), i, n);
        if points.is_empty() {
            let why = format!("--shard {i}/{n} of {} holds no point: want fewer shards", space.count());
            return Err(Failure::wrong_input(why));
        }
        let target = RowTarget::wanted(&self.format, &of.form, of.table.as_deref(), self.new_machine.replaces())?;
        let brief = self.weighing.brief(machine, design);
        let varies = |key: &str| space.axes().iter().any(|axis| WeightArguments::key_of(&axis.key) == Some(key));
        report_brief(self.machine.name(), design, &brief, |key| self.weighing.asks_for(key) && !varies(key));
        report_removed(machine, "");
        let mut table = target.map(|to| DesignTable::begin(&to, space.axes())).transpose()?;
        let mut findings = Findings::default();
        let mut write = |point: u64, values: &[String], outcome: &str, measures| match &mut table {
            Some(table) => table.row(point, values, outcome, measures),
            None => Ok(()),
        };
        for point in points.clone() {
            check()?;
            let values = space.point(point);
            match self.design_at(machine, design, motion, space.axes(), &values) {
                Ok((machine, report)) => {
                    findings.found += 1;
                    for measures in measures(&machine, &report) {
                        write(point, &values, "found", measures)?;
                        findings.add(BestDesign::of(point, typed_settings(space.axes(), &values), &measures));
                    }
                }
                Err(Failure::NoAnswer(why) | Failure::WrongInput(why)) => {
                    write(point, &values, &why, [None; HEADS.len()])?;
                    findings.refuse(Reason { why, point });
                }
                Err(why) => return Err(why.with_context(typed_settings(space.axes(), &values))),
            }
        }
        // The reasons are worth keeping, too.
        table.map(DesignTable::finish).transpose()?;
        if findings.found == 0 {
            // The first point says what is wrong, as it would alone.
            let values = space.point(points.start);
            let alone = self.design_at(machine, design, motion, space.axes(), &values).map(|_| ());
            let none = format!(
                "none of {} has a design: {}",
                counted(points.end - points.start, "point"),
                typed_settings(space.axes(), &values)
            );
            return alone.map_err(|why| why.with_context(none));
        }
        let Range { start, end } = points;
        let Findings { best, reasons, found, refused } = findings;
        let answer = Answer {
            points: space.count(),
            shard: [start, end],
            found,
            refused,
            reasons,
            best: kept(best),
            file: of.table.as_ref().map(|file| file.display().to_string()),
        };
        self.format.print(&answer, text)
    }

    /// Refuses, before any design is sought, what is no setting, has no effect, or is given once more.
    fn check_axes(&self, machine: &Machine, axes: &[Axis]) -> Result<(), Failure> {
        for Axis { key, values } in axes {
            let wrong = |why: &str| Failure::wrong_input(format!("--vary {key}: {why}"));
            let is_option = VARIED_OPTIONS.contains(&key.as_str());
            let is_given = if is_option { self.weighing.gives(key) } else { self.machine.sets(key) };
            if is_given {
                return Err(wrong("it is given by another option, too: want one of both"));
            }
            if key == "objective" && self.weighing.has_front() {
                return Err(wrong("a front minimises mass and inertia, so it has no effect: want no --front"));
            }
            if !is_option && (!KEYS.iter().any(|own| own.matches(key)) || !machine.uses(key, false)) {
                let options = VARIED_OPTIONS.join(", ");
                return Err(wrong(&format!(
                    "no setting of this machine: want a key of --set, as length.NAME or payload.mass, or one of {options}"
                )));
            }
            if is_option {
                let mut tried = (*self.weighing).clone();
                let words: Vec<String> = match values {
                    AxisValues::Listed(all) => all.clone(),
                    AxisValues::Between(ends) => ends.iter().map(f64::to_string).collect(),
                };
                words.iter().try_for_each(|word| tried.give(key, word)).map_err(|why| wrong(&why))?;
            }
        }
        Ok(())
    }

    /// Finds the counterweights of a machine with settings and options changed.
    fn design_at(
        &self,
        machine: &Machine,
        design: &DesignBrief,
        motion: Option<&Motion>,
        axes: &[Axis],
        values: &[String],
    ) -> Result<(Machine, CounterweightReport), Failure> {
        let mut weighing = (*self.weighing).clone();
        let mut pairs = Vec::new();
        for (Axis { key, .. }, value) in axes.iter().zip(values) {
            match VARIED_OPTIONS.contains(&key.as_str()) {
                true => weighing.give(key, value).map_err(Failure::wrong_input)?,
                false => pairs.push((key.as_str(), value.as_str())),
            }
        }
        let machine = machine.set_all(pairs).map_err(Failure::wrong_input)?;
        let brief = weighing.brief(&machine, design);
        weighing.find(&machine, &brief, motion)
    }
}

/// The table of a study: a row for each design, or for the reason why there is none.
struct DesignTable {
    rows: Rows,
    /// Whether the values of each setting are numbers; others are columns of text.
    numeric: Vec<bool>,
}

impl DesignTable {
    fn begin(to: &RowTarget, axes: &[Axis]) -> Result<Self, Failure> {
        let is_number = |axis: &Axis| match &axis.values {
            AxisValues::Between(_) => true,
            AxisValues::Listed(all) => all.iter().all(|word| word.parse::<f64>().is_ok_and(f64::is_finite)),
        };
        let numeric: Vec<bool> = axes.iter().map(is_number).collect();
        let heads = |are_numbers: bool| {
            let own = axes.iter().zip(&numeric).filter(move |(_, numeric)| **numeric == are_numbers);
            own.map(|(axis, _)| axis.key.as_str())
        };
        let words: Vec<&str> = ["outcome"].into_iter().chain(heads(false)).collect();
        let columns: Vec<String> = ["point"].into_iter().chain(heads(true)).chain(HEADS).map(String::from).collect();
        Ok(Self { rows: Rows::begin_with(to, ("design", &words), &columns)?, numeric })
    }

    fn row(
        &mut self,
        point: u64,
        values: &[String],
        outcome: &str,
        measures: [Option<f64>; HEADS.len()],
    ) -> Result<(), Failure> {
        let of = |are_numbers: bool| {
            let own = values.iter().zip(&self.numeric).filter(move |(_, numeric)| **numeric == are_numbers);
            own.map(|(value, _)| value.as_str())
        };
        let texts: Vec<&str> = [outcome].into_iter().chain(of(false)).collect();
        let numbers: Vec<Option<f64>> = of(true).map(|value| value.parse().ok()).collect();
        self.rows.named_row(&texts, [Some(point as f64)].into_iter().chain(numbers).chain(measures))
    }

    fn finish(self) -> Result<(), Failure> {
        self.rows.finish()
    }
}

/// Number of designs after which only the best are kept.
const WAITING_DESIGNS: usize = 4096;

/// What a study has found so far.
#[derive(Default)]
struct Findings {
    best: Vec<BestDesign>,
    reasons: Vec<Reason>,
    /// Number of points with a design, and of those without.
    found: u64,
    refused: u64,
}

impl Findings {
    fn add(&mut self, design: BestDesign) {
        self.best.push(design);
        if self.best.len() > WAITING_DESIGNS {
            self.best = kept(std::mem::take(&mut self.best));
        }
    }

    fn refuse(&mut self, reason: Reason) {
        self.refused += 1;
        if self.reasons.len() < MAX_REASONS {
            self.reasons.push(reason);
        }
    }
}

impl BestDesign {
    fn of(point: u64, options: String, measures: &[Option<f64>; HEADS.len()]) -> Self {
        let [added_mass, inertia, .., relative_gap, certified] = *measures;
        let [added_mass, inertia] = [added_mass, inertia].map(|x| x.unwrap_or(f64::NAN));
        Self { point, options, added_mass, inertia, relative_gap, certified: certified == Some(1.0) }
    }
}

/// Returns settings as a command line takes them.
fn typed_settings(axes: &[Axis], values: &[String]) -> String {
    let one = |(axis, value): (&Axis, &String)| match axis.key.as_str() {
        key if VARIED_OPTIONS.contains(&key) => format!("--{key} {}", shell_word(value)),
        key => format!("--set {}", shell_word(&format!("{key}={value}"))),
    };
    axes.iter().zip(values).map(one).collect::<Vec<_>>().join(" ")
}

/// Returns the measures of a design, in the order of their columns: one row, or one for each machine of its front.
fn measures(machine: &Machine, report: &CounterweightReport) -> Vec<[Option<f64>; HEADS.len()]> {
    let is = |certified: bool| Some(f64::from(u8::from(certified)));
    if report.front_points.is_empty() {
        let inertia = Inertia::of(machine).total_momentum();
        let added = Some(report.measures.added_mass);
        return vec![[added, Some(inertia), report.torque, None, None, report.relative_gap, is(report.certified)]];
    }
    let of = |p: &FrontPoint| {
        let off_by = Some(p.residual_if_misplaced);
        [Some(p.added_mass), Some(p.inertia), p.torque, p.workspace, off_by, p.relative_gap, is(p.certified)]
    };
    report.front_points.iter().map(of).collect()
}

/// Returns the designs that no other is better than.
fn kept(all: Vec<BestDesign>) -> Vec<BestDesign> {
    let measures: Vec<[f64; 2]> = all.iter().map(|design| [design.added_mass, design.inertia]).collect();
    non_dominated(&measures).into_iter().map(|i| all[i].clone()).collect()
}

fn text(answer: &Answer) -> String {
    let [from, to] = answer.shard;
    let mut table = TextTable::new(["point", "added kg", "Σ D_k kg m²", "relative gap", "settings"]).with_words(4);
    for design in &answer.best {
        let gap = gap_cell(design.relative_gap, design.certified);
        let [mass, inertia] = [design.added_mass, design.inertia].map(|x| fixed_or_finer(x, 6));
        table.row([design.point.to_string(), mass, inertia, gap, design.options.clone()]);
    }
    let mut text = format!(
        "points {from} to {} of {}: {} with a design, {} without\n\nno other is better in both mass and inertia\n\n{table}",
        to - 1,
        answer.points,
        answer.found,
        answer.refused
    );
    for Reason { why, point } in &answer.reasons {
        text.push_str(&format!("\npoint {point}: {why}\n"));
    }
    text
}
