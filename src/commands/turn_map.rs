//! `stillbase turn-map`

use std::path::PathBuf;

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;
use stillbase_session::{Run, with_start_edits};
use stillbase_settings::number::fixed;
use stillbase_study::turn_map::{TurnMap, turn_limits};

use super::failure::Failure;
use super::file_form::FileForm;
use super::input::{Settings, no_use, scenario};
use super::output::{Format, TextTable};
use super::progress::{check, goes_on};
use super::rows::{RowTarget, Rows};

/// Map where the end effector gets along straight rays at zero angular momentum, and while the base turns a little
///
/// The rays go from the start of a scenario's task, for machines of three drives. At zero momentum a ray ends at a
/// dynamic singularity, where the end effector moves that way only with momentum; or at a joint limit. With a free base,
/// the motion of least momentum leads on from there, and the base turns. The areas are nested. They hold for straight
/// rays from this pose: other paths lead to other poses, and to other places. The exit status is 1 for machines that
/// have no such rays.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase turn-map spot
  stillbase turn-map spot --turn-limit 0,1 --set task.start=1.2,0.4,-0.6
  stillbase turn-map spot --turn-limit 0 --set base.kind=fixed -o map.csv")]
pub struct TurnMapArguments {
    /// A built-in scenario (spot, spacecraft …; an unknown name lists them all) or a TOML file
    #[arg(value_name = "SCENARIO")]
    scenario: String,
    /// Angles by which the base may turn, °, 0 to 180; default: 0,0.5,1,2,5, or 0 if the base is not free
    #[arg(long, value_name = "°,…", value_delimiter = ',', value_parser = turn_limit)]
    turn_limit: Vec<f64>,
    /// Write the rays to this file, .csv or .parquet
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    settings: Settings,
    #[command(flatten)]
    form: FileForm,
    #[command(flatten)]
    format: Format,
}

#[derive(JsonSchema, Serialize)]
pub struct Answer {
    scenario: String,
    #[serde(flatten)]
    map: TurnMap,
}

fn turn_limit(text: &str) -> Result<f64, String> {
    let limit = text.trim().parse().ok().filter(|limit| (0.0..=180.0).contains(limit));
    limit.ok_or_else(|| "want an angle in degrees, 0 to 180, such as 0.5".into())
}

impl TurnMapArguments {
    /// Prints the area within each turn limit, and how far rays lead.
    pub fn run(&self) -> Result<(), Failure> {
        let to = RowTarget::wanted(&self.format, &self.form, self.output.as_deref(), self.force)?;
        let scenario = scenario(&self.scenario, &self.settings)?;
        let run = Run::or_waiting(&with_start_edits(&scenario)?.0)?;
        let (scenario, turns) = (run.scenario(), run.scenario().base.floats());
        let mut limits = self.turn_limit.clone();
        if limits.is_empty() {
            limits.extend(turn_limits(turns));
        }
        limits.sort_by(f64::total_cmp);
        limits.dedup();
        if !turns && limits.iter().any(|limit| *limit > 0.0) {
            return Err(no_use("--turn-limit", "base.kind = free without a wheel: no other base turns"));
        }
        let rays = run.rays().map_err(|why| Failure::no_answer(format!("{}: {why}", scenario.name)))?;
        let map = TurnMap::of(&rays, &limits, &mut |_| goes_on());
        check()?;
        let map = map.ok_or_else(|| Failure::no_answer("there is no map"))?;
        if let Some(to) = &to {
            write(to, &map)?;
        }
        self.format.print(&Answer { scenario: scenario.name.clone(), map }, text)
    }
}

fn text(answer: &Answer) -> String {
    let map = &answer.map;
    let mut table = TextTable::new(["base turns by at most °", "area m²", "nearest end m", "farthest end m"]);
    for (i, (limit, area)) in map.turn_limits.iter().zip(&map.areas).enumerate() {
        let ends = || map.rays_of(i).map(|ray| ray.reaches[i]);
        let extremes = [ends().fold(f64::INFINITY, f64::min), ends().fold(0.0, f64::max)];
        table.row([limit.to_string(), fixed(*area, 6)].into_iter().chain(extremes.map(|x| fixed(x, 6))));
    }
    let q: Vec<String> = map.q_start.iter().map(|q| fixed(*q, 6)).collect();
    let [x, y] = map.tip_start.map(|x| fixed(x, 6));
    let mut stops: Vec<(&str, usize)> = Vec::new();
    for ray in map.rays_of(0) {
        let Some(first) = ray.stops.first() else { continue };
        match stops.iter_mut().find(|(stop, _)| stop == first) {
            Some((_, count)) => *count += 1,
            None => stops.push((first, 1)),
        }
    }
    let stops: Vec<String> = stops.iter().map(|(stop, count)| format!("{stop} ({count})")).collect();
    format!(
        "{}: straight rays from ({x}, {y}) m at q = {} rad; other paths lead elsewhere\n\n{table}\n\
         rays of the first row end at: {}\n",
        answer.scenario,
        q.join(", "),
        stops.join(", ")
    )
}

fn write(to: &RowTarget, map: &TurnMap) -> Result<(), Failure> {
    let stops: Vec<String> = map.turn_limits.iter().map(|limit| format!("stop at {limit}°")).collect();
    let stops: Vec<&str> = stops.iter().map(String::as_str).collect();
    let reaches = map.turn_limits.iter().map(|limit| format!("reach at {limit}° m"));
    let head: Vec<String> = ["direction rad".to_owned()].into_iter().chain(reaches).collect();
    let mut rows = Rows::begin_with(to, ("ray", &stops), &head)?;
    for ray in &map.rays {
        let texts: Vec<&str> = ray.stops.iter().map(String::as_str).collect();
        rows.named_row(&texts, [ray.direction].into_iter().chain(ray.reaches.iter().copied()))?;
    }
    rows.finish()
}
