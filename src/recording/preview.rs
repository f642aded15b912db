//! Runs a scenario once before it is recorded. Its extremes decide the layout and the scales, which stand at the head of
//! the file; and a scenario that cannot run is refused before anything is written.

use rerun::EntityPath;
use rerun::external::re_log_types::EntityPathPart;

use super::design::Design;
use super::eye::Eye;
use super::topic::Topic;
use crate::picture::charts::{Chart, charts};
use crate::picture::scene::camera::Orbit;
use crate::picture::scene::linkage::Linkage;
use crate::picture::scene::reaction::Scale;
use crate::picture::scene::views::{ViewKind, Views};
use crate::query::Queries;
use crate::session::scenario::Scenario;
use crate::session::{Refusal, replay_while};
use crate::simulation::frame::Peaks;
use crate::simulation::signals::{Signal, signals};
use crate::study::comparison::Candidate;

/// What a run will come to.
#[derive(Debug)]
pub struct Preview {
    /// Name of the scenario.
    pub name: String,
    /// A line about it.
    pub title: String,
    /// Where its entities are.
    pub root: EntityPath,
    /// Steps.
    pub steps: u64,
    /// The largest of everything.
    pub peaks: Peaks,
    /// Least and greatest b, rad.
    pub b: [f64; 2],
    /// The signals that it records.
    pub topics: Vec<Topic>,
    /// The charts that tell something of it, with the least and the greatest value in each.
    pub charts: Vec<(Chart, [f64; 2])>,
    /// From where the machine is seen.
    pub scene: Eye,
    /// What is derived of the run.
    pub queries: Queries,
    /// From where joint space is seen, if there is one.
    pub joints: Option<Eye>,
    /// From where the tower is seen, if there is one.
    pub tower: Option<Eye>,
    /// The machine as it is designed.
    pub design: Design,
    /// The same, to be set beside those of others.
    pub candidate: Candidate,
}

impl Preview {
    /// Runs a scenario; `tick` hears of steps that are done, and says whether the rest is still wanted.
    ///
    /// # Errors
    /// If it cannot start, one of its edits cannot apply, or it is not wanted any more.
    pub fn of(scenario: &Scenario, tick: &mut dyn FnMut(u64) -> bool) -> Result<Self, Refusal> {
        let none = [f64::INFINITY, f64::NEG_INFINITY];
        let wider = |range: &mut [f64; 2], x: f64| *range = [range[0].min(x), range[1].max(x)];
        let signals = signals(&scenario.machine);
        let charts = charts(scenario);
        let topics = Topic::all(signals.clone(), &charts);
        let mut charts: Vec<_> = charts.into_iter().map(|chart| (chart, none)).collect();
        charts.retain(|(chart, _)| signals.iter().any(|signal| chart.holds(signal)));
        let held = |signal: &Signal| charts.iter().position(|(chart, _)| chart.holds(signal));
        let drawn: Vec<_> = signals.iter().filter_map(|signal| Some((held(signal)?, signal.clone()))).collect();
        let (mut b, mut first) = (none, None);
        let run = replay_while(scenario, |_, frame| {
            first.get_or_insert(*frame);
            wider(&mut b, frame.b);
            drawn.iter().for_each(|(i, signal)| wider(&mut charts[*i].1, signal.value(frame)));
            !frame.step.is_multiple_of(1024) || tick(frame.step)
        })?;
        let last = run.frame();
        let reach = Linkage::of(&run.scenario().machine).reach();
        let views = Views::over(&run, b, run.queries());
        let eye = |kind: ViewKind, axes| views.shows(kind).then(|| Eye::of(&views.camera(kind), axes));
        let (joints, tower) = (eye(ViewKind::Joints, views.joint_axes()), eye(ViewKind::Tower, [0, 1, 2]));
        Ok(Self {
            name: scenario.name.clone(),
            title: if scenario.title.is_empty() { scenario.name.clone() } else { scenario.title.clone() },
            root: EntityPath::new(vec![EntityPathPart::new(scenario.name.as_str())]),
            steps: last.step,
            peaks: last.peaks,
            b,
            topics,
            charts,
            scene: near(reach),
            joints,
            candidate: Candidate::of(&run),
            design: Design::of(scenario, &run, first.unwrap_or(last))?,
            tower,
            queries: run.queries().clone(),
        })
    }
}

/// Where the machines of several cases are set side by side.
pub const DESIGNS: &str = "comparison/designs";

/// Whether the machines of several cases differ.
pub fn have_designs(cases: &[Preview]) -> bool {
    cases.iter().any(|case| !case.candidate.is_alike(&cases[0].candidate))
}

/// What full arrows and arcs stand for in all of them, so that they can be compared.
pub fn scale(cases: &[Preview]) -> Scale {
    let largest = |of: fn(&Preview) -> f64| cases.iter().map(of).fold(0.0, f64::max);
    Scale::of(largest(|c| c.peaks.force), largest(|c| c.peaks.moment))
}

/// From the front and above, so near that the arm and its workspaces fill the view.
fn near(reach: f64) -> Eye {
    Eye::upright(Orbit { centre: [-0.04 * reach, 0.06 * reach, 0.0], distance: 1.75 * reach, yaw: 0.3, pitch: 0.95 })
}
