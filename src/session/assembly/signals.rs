//! The signals of an assembly: those of its base in space, and those of its blocks with the block before the name of a
//! drive, as `torque/wrist.1`.

use super::file::AssemblyBase;
use super::run::{AssemblyFrame, AssemblyRun};

/// Returns the value of a signal at an instant.
type Value = Box<dyn Fn(&AssemblyFrame) -> f64 + Send + Sync>;

/// A signal.
pub struct AssemblySignal {
    /// Path, such as `torque/wrist.1`.
    pub path: String,
    /// Unit, `1` for none.
    pub unit: &'static str,
    value: Value,
}

impl AssemblySignal {
    fn new(
        path: impl Into<String>,
        unit: &'static str,
        value: impl Fn(&AssemblyFrame) -> f64 + Send + Sync + 'static,
    ) -> Self {
        Self { path: path.into(), unit, value: Box::new(value) }
    }

    /// Returns its value at an instant.
    pub fn value(&self, frame: &AssemblyFrame) -> f64 {
        (self.value)(frame)
    }
}

const AXES: [&str; 3] = ["x", "y", "z"];

/// Returns the signals of a run.
pub fn assembly_signals(run: &AssemblyRun) -> Vec<AssemblySignal> {
    let (mut all, scenario) = (Vec::new(), run.scenario());
    let mut add = |path: String, unit, value: Value| all.push(AssemblySignal::new(path, unit, value));
    for (i, block) in scenario.assembly.blocks().iter().enumerate() {
        let (own, lambda) = (&block.name, scenario.assembly.conditions(i).inertia.lambda());
        for (k, drive) in block.machine.spec().drives.iter().enumerate() {
            let name = format!("{own}.{}", drive.name);
            // Torques are those on a base at rest.
            if scenario.base == AssemblyBase::Fixed {
                add(format!("torque/{name}"), "N m", Box::new(move |frame| frame.torques[i][k]));
            }
            add(format!("angle/{name}"), "rad", Box::new(move |frame| frame.states[i].q[k]));
            add(format!("rate/{name}"), "rad/s", Box::new(move |frame| frame.states[i].qd[k]));
            add(format!("acceleration/{name}"), "rad/s²", Box::new(move |frame| frame.states[i].qdd[k]));
        }
        add(format!("pose/{own}.b"), "rad", Box::new(move |frame| lambda.dot(&frame.states[i].q)));
        for (axis, name) in AXES.into_iter().enumerate() {
            add(format!("tip/{own}.{name}"), "m", Box::new(move |frame| frame.in_space(&frame.tips[i])[axis]));
        }
    }
    match scenario.base {
        AssemblyBase::Fixed => {
            for (axis, name) in AXES.into_iter().enumerate() {
                add(format!("force/dynamic_{name}"), "N", Box::new(move |frame| frame.loads.motion.force[axis]));
                add(format!("moment/dynamic_{name}"), "N m", Box::new(move |frame| frame.loads.motion.moment[axis]));
                add(format!("force/static_{name}"), "N", Box::new(move |frame| frame.loads.weight.force[axis]));
                add(format!("moment/static_{name}"), "N m", Box::new(move |frame| frame.loads.weight.moment[axis]));
            }
        }
        AssemblyBase::Free(_) => {
            for (i, name) in ["w", "x", "y", "z"].into_iter().enumerate() {
                add(format!("attitude/base_{name}"), "1", Box::new(move |frame| frame.attitude.components()[i]));
            }
            for (axis, name) in AXES.into_iter().enumerate() {
                add(format!("attitude_rate/base_{name}"), "rad/s", Box::new(move |frame| frame.rate[axis]));
                add(format!("base/{name}"), "m", Box::new(move |frame| frame.origin[axis]));
            }
        }
    }
    all
}
