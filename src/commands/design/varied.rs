//! `stillbase design --counterweights --vary`: counterweights at many points.

use std::ops::Range;
use std::path::PathBuf;

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_planning::Motion;
use stillbase_session::scenario::{DesignBrief, key_of};
use stillbase_settings::number::{counted, fixed_or_finer};
use stillbase_settings::text::shell_word;
use stillbase_study::counterweights::CounterweightReport;
use stillbase_study::design_space::{Axis, AxisValues, DesignSpace, MAX_POINTS, NoDesignSpace, non_dominated, typed};
use stillbase_study::tolerance::shard;

use super::super::dimensions::density;
use super::super::failure::Failure;
use super::super::file_form::FileForm;
use super::super::output::TextTable;
use super::super::progress::check;
use super::super::rows::{RowTarget, Rows};
use super::super::tolerance::parse_shard;
use super::DesignArguments;
use super::brief::report_brief;
use super::weighed::report_removed;

/// Which settings vary, and where the designs go.
#[derive(Args)]
pub struct VaryArguments {
    /// Find the counterweights for many machines: with each of these values of a setting, or N of them from LO to HI. KEY
    /// is one of --set, or material or thickness; several make a grid
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
    /// The settings as options: with the other options of the study they find this design alone.
    options: String,
    /// Added mass, kg.
    added_mass: f64,
    /// Σ D_k, kg m².
    inertia: f64,
    /// Upper bound on what the objective may lie above its minimum; absent of a front.
    #[serde(skip_serializing_if = "Option::is_none")]
    gap: Option<f64>,
    /// Whether the gap is within rounding; absent of a front.
    #[serde(skip_serializing_if = "Option::is_none")]
    certified: Option<bool>,
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
    ["added_mass kg", "inertia kg m²", "torque N m", "workspace m²", "off_by kg m", "gap 1", "certified 1"];

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
        report_brief(self.machine.name(), design, &brief, |key| self.weighing.asks_for(key));
        report_removed(machine, "");
        let is_number = |axis: &&Axis| match &axis.values {
            AxisValues::Between(_) => true,
            AxisValues::Listed(all) => all.iter().all(|word| word.parse::<f64>().is_ok_and(f64::is_finite)),
        };
        let numeric: Vec<bool> = space.axes().iter().map(|axis| is_number(&axis)).collect();
        let heads = |which: bool| {
            space.axes().iter().zip(&numeric).filter(move |(_, own)| **own == which).map(|(axis, _)| axis.key.clone())
        };
        let words: Vec<String> = ["outcome".to_owned()].into_iter().chain(heads(false)).collect();
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let columns: Vec<String> =
            ["point".to_owned()].into_iter().chain(heads(true)).chain(HEADS.map(String::from)).collect();
        let mut rows = target.map(|to| Rows::begin_with(&to, ("design", &words), &columns)).transpose()?;
        let (mut best, mut reasons, mut found, mut refused) = (Vec::<BestDesign>::new(), Vec::new(), 0, 0);
        for point in points.clone() {
            check()?;
            let values = space.point(point);
            let texts = |outcome: String| {
                let own = values.iter().zip(&numeric).filter(|(_, numeric)| !**numeric).map(|(value, _)| value.clone());
                [outcome].into_iter().chain(own).collect::<Vec<_>>()
            };
            let numbers =
                values.iter().zip(&numeric).filter(|(_, numeric)| **numeric).map(|(value, _)| value.parse().ok());
            let numbers: Vec<Option<f64>> = [Some(point as f64)].into_iter().chain(numbers).collect();
            let mut write = |outcome: String, measures: [Option<f64>; 7]| match &mut rows {
                Some(rows) => {
                    let texts = texts(outcome);
                    let texts: Vec<&str> = texts.iter().map(String::as_str).collect();
                    rows.named_row(&texts, numbers.iter().copied().chain(measures))
                }
                None => Ok(()),
            };
            match self.design_at(machine, &brief, motion, space.axes(), &values) {
                Ok((machine, report)) => {
                    found += 1;
                    for measures in measures(&machine, &report) {
                        write("found".into(), measures)?;
                        best.push(best_design(point, typed_settings(space.axes(), &values), &measures));
                    }
                }
                Err(Failure::NoAnswer(why) | Failure::WrongInput(why)) => {
                    refused += 1;
                    write(why.clone(), [None; 7])?;
                    if reasons.len() < MAX_REASONS {
                        reasons.push(Reason { why, point });
                    }
                }
                Err(why) => return Err(why.with_context(typed_settings(space.axes(), &values))),
            }
            // The best so far suffice.
            if best.len() > 4096 {
                best = kept(best);
            }
        }
        // The reasons are worth keeping, too.
        rows.map(Rows::finish).transpose()?;
        if found == 0 {
            // The first point says what is wrong, as it would alone.
            let values = space.point(points.start);
            let alone = self.design_at(machine, &brief, motion, space.axes(), &values).map(|_| ());
            let none = format!(
                "none of {} has a design: {}",
                counted(points.end - points.start, "point"),
                typed_settings(space.axes(), &values)
            );
            return alone.map_err(|why| why.with_context(none));
        }
        let Range { start, end } = points;
        let file = of.table.as_ref().map(|file| file.display().to_string());
        let answer =
            Answer { points: space.count(), shard: [start, end], found, refused, reasons, best: kept(best), file };
        self.format.print(&answer, text)
    }

    /// Refuses, before any design is sought, what is no setting, has no effect, or is given once more.
    fn check_axes(&self, machine: &Machine, axes: &[Axis]) -> Result<(), Failure> {
        for Axis { key, values } in axes {
            let wrong = |why: &str| Failure::wrong_input(format!("--vary {key}: {why}"));
            let is_given = match key.as_str() {
                "material" => self.weighing.material.is_some(),
                "thickness" => self.weighing.thickness.is_some(),
                key => self.machine.sets(key),
            };
            if is_given {
                return Err(wrong("it is given by another option, too: want one of both"));
            }
            match (key.as_str(), values) {
                ("material", AxisValues::Listed(all)) => {
                    all.iter().try_for_each(|word| density(word).map(|_| ())).map_err(|why| wrong(&why))?;
                }
                ("material" | "thickness", _) => {}
                (key, _) if key_of(key).is_none() || !machine.uses(key, false) => {
                    return Err(wrong(
                        "no setting of this machine: want a key of --set, as length.NAME or payload.mass, or material or \
                         thickness",
                    ));
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Finds the counterweights of a machine with settings changed.
    fn design_at(
        &self,
        machine: &Machine,
        brief: &DesignBrief,
        motion: Option<&Motion>,
        axes: &[Axis],
        values: &[String],
    ) -> Result<(Machine, CounterweightReport), Failure> {
        let mut brief = brief.clone();
        let mut pairs = Vec::new();
        for (axis, value) in axes.iter().zip(values) {
            let number = || value.parse().map_err(|_| Failure::wrong_input("want a number"));
            match axis.key.as_str() {
                "material" => brief.density = density(value).map_err(Failure::wrong_input)?,
                "thickness" => brief.thickness = number()?,
                key => pairs.push((key, value.as_str())),
            }
        }
        let machine = machine.set_all(pairs).map_err(Failure::wrong_input)?;
        self.weighing.find(&machine, &brief, motion)
    }
}

fn best_design(point: u64, options: String, measures: &[Option<f64>; 7]) -> BestDesign {
    let [added_mass, inertia, .., gap, certified] = *measures;
    let [added_mass, inertia] = [added_mass, inertia].map(|x| x.unwrap_or(f64::NAN));
    BestDesign { point, options, added_mass, inertia, gap, certified: certified.map(|x| x == 1.0) }
}

/// Returns settings as a command line takes them.
fn typed_settings(axes: &[Axis], values: &[String]) -> String {
    let one = |(axis, value): (&Axis, &String)| match axis.key.as_str() {
        key @ ("material" | "thickness") => format!("--{key} {}", shell_word(value)),
        key => format!("--set {}", shell_word(&format!("{key}={value}"))),
    };
    axes.iter().zip(values).map(one).collect::<Vec<_>>().join(" ")
}

/// Returns the measures of a design, in the order of their columns: one row, or one for each machine of its front.
fn measures(machine: &Machine, report: &CounterweightReport) -> Vec<[Option<f64>; 7]> {
    if report.front_points.is_empty() {
        let inertia = Inertia::of(machine).total_momentum();
        let certified = Some(f64::from(u8::from(report.certified)));
        let added = Some(report.measures.added_mass);
        return vec![[added, Some(inertia), report.torque, None, None, Some(report.gap), certified]];
    }
    let of = |p: &stillbase_study::front_point::FrontPoint| {
        [Some(p.added_mass), Some(p.inertia), p.torque, p.workspace, Some(p.residual_if_misplaced), None, None]
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
    let mut table = TextTable::new(["point", "added kg", "Σ D_k kg m²", "gap", "settings"]).with_words(4);
    for design in &answer.best {
        let mark = if design.certified == Some(false) { ", not certified" } else { "" };
        let gap = design.gap.map_or_else(|| "–".into(), |gap| format!("{gap:.1e}{mark}"));
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
