//! Runs a scenario once before it is recorded. Its extreme values determine the layout and the scales, which come first
//! in the file. A scenario that cannot run is refused before anything is written.

use crate::rerun::EntityPath;
use crate::rerun::EntityPathPart;

use super::blocks::seen_points;
use super::design::RecordedDesign;
use super::eye::Eye;
use super::steps;
use super::topic::Topic;
use stillbase_mechanics::machine::Machine;
use stillbase_picture::charts::drawn::shows_limit;
use stillbase_picture::charts::{Chart, charts};
use stillbase_picture::scene::camera::Orbit;
use stillbase_picture::scene::linkage::LinkageModel;
use stillbase_picture::scene::reaction::Scale;
use stillbase_picture::scene::views::{ViewKind, Views};
use stillbase_query::Queries;
use stillbase_session::scenario::Scenario;
use stillbase_session::{Refusal, WholeFrame, replay_while, signals_of_whole, with_start_edits};
use stillbase_simulation::frame::{Frame, Peaks};
use stillbase_study::comparison::DesignCandidate;

/// Extreme values of a run, and the views and charts that they determine.
#[derive(Debug)]
pub struct Preview {
    /// Name of the scenario.
    pub name: String,
    /// Title of the case.
    pub title: String,
    /// Path of the scenario's entities.
    pub root: EntityPath,
    /// Number of steps.
    pub steps: u64,
    /// Peak values.
    pub peaks: Peaks,
    /// Minimum and maximum of b, rad.
    pub b: [f64; 2],
    /// Recorded signals.
    pub topics: Vec<Topic>,
    /// Charts that apply, with the minimum and maximum of the values in each.
    pub charts: Vec<(Chart, [f64; 2])>,
    /// Of an assembly, the minimum and maximum of the values of each topic; empty for a machine by itself.
    pub ranges: Vec<[f64; 2]>,
    /// Eye of the view of the machine.
    pub scene: Eye,
    /// Points between which the machine moves, m.
    pub extent: Vec<[f64; 3]>,
    /// Cache of the results derived from the run.
    pub queries: Queries,
    /// Eye of the view of joint space, if there is one.
    pub joints: Option<Eye>,
    /// Eye of the view of the tower, if there is one.
    pub tower: Option<Eye>,
    /// Design of the machine.
    pub design: RecordedDesign,
    /// Design of the machine for comparison with other cases.
    pub candidate: DesignCandidate,
}

impl Preview {
    /// Runs a scenario; `tick` is called with the number of completed steps and returns whether to continue.
    ///
    /// # Errors
    /// If the scenario cannot start, one of its edits cannot be applied, its state diverges, or `tick` returns false.
    pub fn of(scenario: &Scenario, tick: &mut dyn FnMut(u64) -> bool) -> Result<Self, Refusal> {
        let none = [f64::INFINITY, f64::NEG_INFINITY];
        let wider = |range: &mut [f64; 2], x: f64| *range = [range[0].min(x), range[1].max(x)];
        // The first edits may draw another machine.
        let (start, _) = with_start_edits(scenario)?;
        let signals = signals_of_whole(&start);
        // Of an assembly, each topic has a plot.
        let charts = if start.assembly.is_some() { Vec::new() } else { charts(&start, false) };
        let topics = Topic::all(signals.clone(), &charts, start.assembly.is_some());
        let mut ranges = vec![none; if start.assembly.is_some() { topics.len() } else { 0 }];
        let mut charts: Vec<_> = charts.into_iter().map(|chart| (chart, none)).collect();
        charts.retain(|(chart, _)| signals.iter().any(|signal| chart.contains(signal)));
        let held = |(i, (chart, _)): (usize, &(Chart, _))| {
            let held = signals.iter().filter(|signal| chart.contains(signal));
            held.map(|signal| (i, signal.clone())).collect::<Vec<_>>()
        };
        let drawn: Vec<_> = charts.iter().enumerate().flat_map(held).collect();
        let (mut b, mut first) = (none, None);
        let (mut extent, mut linkage) = (Vec::new(), None::<(Machine, LinkageModel)>);
        let every = (steps(scenario) / EXTENT_POSES).max(1);
        let run = replay_while(scenario, |run, frame| {
            first.get_or_insert(*frame);
            if let Some(shared) = run.shared() {
                if frame.step.is_multiple_of(every) {
                    extent.extend(seen_points(shared.block(), shared.now()));
                }
                let whole = WholeFrame::of(run, frame);
                for (range, topic) in ranges.iter_mut().zip(&topics) {
                    topic.signals.iter().for_each(|signal| wider(range, whole.value(signal)));
                }
            } else if frame.step.is_multiple_of(every) {
                let machine = &run.scenario().machine;
                let known = linkage.take().filter(|(of, _)| of == machine);
                let (_, known) = linkage.insert(known.unwrap_or_else(|| (machine.clone(), LinkageModel::of(machine))));
                extent.extend(ends(known, frame));
            }
            wider(&mut b, frame.b);
            drawn.iter().for_each(|(i, signal)| wider(&mut charts[*i].1, signal.value(frame)));
            !frame.step.is_multiple_of(1024) || tick(frame.step)
        })?;
        // A limit is drawn under the same condition as in the window.
        let mut topics = topics;
        for (topic, range) in topics.iter_mut().zip(&mut ranges) {
            for (i, signal) in topic.signals.iter().enumerate() {
                let Some(limit) = signal.limit.filter(|limit| shows_limit(*limit, range[0].abs().max(range[1].abs())))
                else {
                    continue;
                };
                topic.limits.push((i, limit));
            }
            for (_, limit) in &topic.limits {
                wider(range, *limit);
                wider(range, -limit);
            }
        }
        for topic in &mut topics {
            for (i, signal) in topic.signals.iter().enumerate() {
                let chart = charts.iter_mut().find(|(chart, _)| chart.contains(signal));
                let Some((limit, (_, range))) = signal.limit.zip(chart) else { continue };
                if shows_limit(limit, range[0].abs().max(range[1].abs())) {
                    topic.limits.push((i, limit));
                }
            }
        }
        for (i, limit) in topics.iter().flat_map(|topic| topic.limits.iter().map(move |(i, l)| (&topic.signals[*i], l)))
        {
            if let Some((_, range)) = charts.iter_mut().find(|(chart, _)| chart.contains(i)) {
                wider(range, *limit);
                wider(range, -limit);
            }
        }
        let last = run.frame();
        let reach = match &linkage {
            Some((of, known)) if *of == run.scenario().machine => known.reach(),
            _ => LinkageModel::of(&run.scenario().machine).reach(),
        };
        let views = Views::over(&run, b, run.queries());
        let eye = |kind: ViewKind, axes| views.shows(kind).then(|| Eye::of(&views.camera(kind), axes));
        let (mut joints, mut tower) = (eye(ViewKind::Joints, views.joint_axes()), eye(ViewKind::Tower, [0, 1, 2]));
        let mut scene = near(reach);
        if run.shared().is_some() {
            // What one block is by itself is in its own recording.
            (joints, tower, scene) = (None, None, around().filled(&extent, 1.3));
        }
        Ok(Self {
            name: scenario.name.clone(),
            title: if scenario.title.is_empty() { scenario.name.clone() } else { scenario.title.clone() },
            root: EntityPath::new(vec![EntityPathPart::new(scenario.name.as_str())]),
            steps: last.step,
            peaks: last.peaks,
            b,
            topics,
            charts,
            ranges,
            scene,
            extent,
            joints,
            candidate: DesignCandidate::of(&run),
            design: RecordedDesign::of(scenario, &run, first.unwrap_or(last))?,
            tower,
            queries: run.queries().clone(),
        })
    }
}

/// Number of poses of a run by which the space that its machine needs is found.
const EXTENT_POSES: u64 = 24;

/// Returns where the links of a machine end at an instant, m.
fn ends(linkage: &LinkageModel, frame: &Frame) -> impl Iterator<Item = [f64; 3]> {
    let ends = linkage.flat(&frame.q.units()).into_iter().flat_map(|bar| bar.ends);
    ends.map(|end| end + frame.base.at).map(|end| [end.re, end.im, 0.0])
}

/// Path of the comparison of the machines of several cases.
pub const DESIGNS_PATH: &str = "comparison/designs";

/// Returns whether the machines of several cases differ.
pub fn machines_differ(cases: &[Preview]) -> bool {
    cases.iter().any(|case| !case.candidate.is_alike(&cases[0].candidate))
}

/// Returns the common scale of arrows and arcs of all cases.
pub fn scale(cases: &[Preview]) -> Scale {
    let largest = |of: fn(&Preview) -> f64| cases.iter().map(of).fold(0.0, f64::max);
    Scale::of(largest(|c| c.peaks.force), largest(|c| c.peaks.moment))
}

/// Returns an eye in front and above, towards blocks in space.
fn around() -> Eye {
    Eye::upright(Orbit { centre: [0.0; 3], distance: 3.0, yaw: 0.5, pitch: 0.55 })
}

/// Returns an eye in front and above, at which the arm and its workspaces fill the view; `reach` in m.
fn near(reach: f64) -> Eye {
    Eye::upright(Orbit { centre: [-0.04 * reach, 0.06 * reach, 0.0], distance: 1.75 * reach, yaw: 0.3, pitch: 0.95 })
}
