//! A run before it is recorded: its extremes decide the layout and the scales, which stand at the head of the file, and
//! a scenario that cannot run is refused before anything is written.

use rerun::EntityPath;
use rerun::external::re_log_types::EntityPathPart;

use super::eye::Eye;
use super::{joints, tower};
use crate::picture::scene::linkage::Linkage;
use crate::picture::scene::palette::{Theme, palette};
use crate::session::scenario::Scenario;
use crate::session::{Refusal, replay};
use crate::simulation::frame::Peaks;
use crate::simulation::signals::{Signal, signals};

/// What a run will come to.
#[derive(Debug)]
pub struct Rehearsal {
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
    /// The first audit that fails, in words.
    pub fault: Option<String>,
    /// Least and greatest b, rad.
    pub b: [f64; 2],
    /// The farthest the end effector gets from B, m.
    pub reach: f64,
    /// What it records.
    pub signals: Vec<Signal>,
    /// From where joint space is seen, if there are planes.
    pub joints: Option<Eye>,
    /// From where the tower is seen.
    pub tower: Option<Eye>,
}

impl Rehearsal {
    /// Runs a scenario.
    ///
    /// # Errors
    /// If it cannot start, or one of its edits cannot apply.
    pub fn of(scenario: &Scenario, tick: &mut dyn FnMut(u64)) -> Result<Self, Refusal> {
        let mut b = [f64::INFINITY, f64::NEG_INFINITY];
        let run = replay(scenario, |_, frame| {
            b = [b[0].min(frame.b), b[1].max(frame.b)];
            if frame.step.is_multiple_of(1024) {
                tick(frame.step);
            }
        })?;
        let last = run.frame();
        Ok(Self {
            fault: last.fault().map(|lamp| lamp.to_string()),
            name: scenario.name.clone(),
            title: if scenario.title.is_empty() { scenario.name.clone() } else { scenario.title.clone() },
            root: EntityPath::new(vec![EntityPathPart::new(scenario.name.as_str())]),
            steps: last.step,
            peaks: last.peaks,
            b,
            reach: Linkage::of(&run.scenario().machine).reach(),
            signals: signals(&scenario.machine),
            joints: joints::eye(&run, b, &palette(Theme::Dark)),
            tower: tower::eye(&run, b),
        })
    }
}
