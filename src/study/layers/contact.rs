//! [`Contact`]: two solids that overlap in plan, where and in which pose, and how many layers must lie between them.

use schemars::JsonSchema;
use serde::Serialize;
use stillbase_exchange::cut::Cut;
use stillbase_exchange::solids::{Axle, LinkSolid, axles, link_solids};
use stillbase_mechanics::machine::Machine;

use super::clearance::pin_faces;
use super::overlap::{Overlap, Pair};
use super::plan::{Nearness, PlanSolid};
use super::range::PoseRange;
use super::way::TaskPoses;

/// Work within the joint limits for one pair of solids, and for all pairs together: a unit divides a cell of poses of two
/// bars, or compares two sides of plates.
const WORK_PER_PAIR: usize = 100_000;
const WORK: usize = 2_000_000;
/// Work along a task for all pairs together: a unit places two bars in a pose.
const WORK_OF_TASK: usize = 40_000_000;

/// Two solids that overlap in plan in some pose, so that they cannot lie in one layer.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Contact {
    /// Name of the first: a solid of a link.
    pub a: String,
    /// Name of the second: a solid of a link, or a pin.
    pub b: String,
    /// A point of both, m, in the pose `q`.
    #[serde(rename = "where")]
    pub at: [f64; 2],
    /// Angles of the drives, rad.
    pub q: Vec<f64>,
    /// Time along the task, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time: Option<f64>,
    /// Whether they overlap for certain; else the work could not exclude it.
    pub decided: bool,
    /// Least difference between their layers. A pin counts as the link that it joins.
    pub apart: usize,
    /// Heights of the lower and the upper face of each, m, in the given machine.
    #[serde(skip)]
    pub faces: [[f64; 2]; 2],
    /// What meets.
    #[serde(skip)]
    pub between: Between,
}

/// What meets in a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Between {
    /// Solids of two links, counted from 0.
    Links(usize, usize),
    /// A solid of a link, and a pin of other links, both counted from 0.
    Pin(usize, usize),
}

/// The solids of a machine that lie in layers.
#[derive(Clone, Debug)]
pub struct Solids {
    pub(super) links: Vec<LinkSolid>,
    pub(super) axles: Vec<Axle>,
    pub(super) plans: Vec<PlanSolid>,
    pub(super) pins: Vec<PlanSolid>,
}

/// The poses in which solids must not meet.
pub enum Way<'a> {
    /// All within the joint limits.
    Limits(&'a PoseRange),
    /// Those of a task.
    Task(&'a TaskPoses),
}

impl Way<'_> {
    /// Returns the work for all pairs of solids.
    fn work(&self) -> usize {
        match self {
            Self::Limits(_) => WORK,
            Self::Task(_) => WORK_OF_TASK,
        }
    }
}

impl Solids {
    /// Returns the solids of a machine.
    pub fn of(machine: &Machine, cut: &Cut) -> Self {
        let (links, axles) = (link_solids(machine, cut), axles(machine));
        let plans = links.iter().map(|solid| PlanSolid::of(machine, solid)).collect();
        let pins = axles.iter().map(|axle| PlanSolid::of_pin(axle, cut.spacer_radius())).collect();
        Self { links, axles, plans, pins }
    }

    /// Returns the contacts of a machine. Once the work is used up, what is left counts as meeting, named once for each
    /// two links and each distance.
    pub fn contacts(&self, machine: &Machine, cut: &Cut, way: &Way<'_>) -> Vec<Contact> {
        let mut contacts = Contacts { way, left: way.work(), found: Vec::new() };
        for (i, a) in self.links.iter().enumerate() {
            for (j, b) in self.links.iter().enumerate().skip(i + 1).filter(|(_, b)| b.link != a.link) {
                let pair = Pair::of(&self.plans[i], &self.plans[j]);
                let apart = layers_between(cut, [a.thickness, a.rise], [b.thickness, b.rise]);
                let distance = Distance { apart, faces: [a, b].map(|x| x.faces(machine)) };
                contacts.examine(&pair, distance, Between::Links(a.link, b.link), &|| [a, b].map(|x| x.name(machine)));
            }
            for (j, axle) in self.axles.iter().enumerate().filter(|(_, axle)| axle.is_pin() && !axle.joins(a.link)) {
                let pair = Pair::of(&self.plans[i], &self.pins[j]);
                let apart = layers_between(cut, [a.thickness, a.rise], [cut.plate_thickness, 0.0]);
                let names = || [a.name(machine), axle.name(machine)];
                let distance = Distance { apart, faces: [a.faces(machine), pin_faces(machine, cut, axle)] };
                contacts.examine(&pair, distance, Between::Pin(a.link, j), &names);
            }
        }
        contacts.found
    }
}

/// How far two solids must lie apart, and how they lie.
struct Distance {
    /// Least difference between their layers.
    apart: usize,
    /// Heights of the lower and the upper face of each, m.
    faces: [[f64; 2]; 2],
}

/// Contacts as they are found.
struct Contacts<'a> {
    way: &'a Way<'a>,
    /// Work that is left, in pairs of sides.
    left: usize,
    found: Vec<Contact>,
}

impl Contacts<'_> {
    fn examine(&mut self, pair: &Pair<'_>, distance: Distance, between: Between, names: &dyn Fn() -> [String; 2]) {
        let Distance { apart, faces } = distance;
        let is_known = |own: &Contact| own.between == between && own.apart >= apart;
        if self.left < pair.cost() && self.found.iter().any(is_known) {
            return;
        }
        self.left = self.left.saturating_sub(pair.cost());
        let Some(met) = meeting(pair, self.way, &mut self.left) else { return };
        let (at, [a, b]) = ([met.near.at.re, met.near.at.im], names());
        self.found.push(Contact { a, b, at, q: met.q, time: met.time, decided: met.decided, apart, faces, between });
    }
}

/// Returns how many layers further one solid must lie than another that it overlaps, for thickness and rise above its
/// link of each, m.
pub fn layers_between(cut: &Cut, [a, rise_a]: [f64; 2], [b, rise_b]: [f64; 2]) -> usize {
    let apart = 0.5 * (a + b) + (rise_a - rise_b).abs() + cut.spacer;
    // What rounding adds is no layer.
    ((apart / cut.layer_pitch() - 1e-9).ceil() as usize).max(1)
}

/// A pose in which two solids meet.
struct Met {
    q: Vec<f64>,
    near: Nearness,
    time: Option<f64>,
    decided: bool,
}

fn meeting(pair: &Pair<'_>, way: &Way<'_>, left: &mut usize) -> Option<Met> {
    match way {
        Way::Limits(range) => {
            let given = WORK_PER_PAIR.min(*left);
            let mut budget = given;
            let overlap = pair.overlap(range, &mut budget);
            *left -= given - budget;
            match overlap {
                Overlap::Never => None,
                Overlap::In(q, near) => Some(Met { q, near, time: None, decided: true }),
                Overlap::Undecided(q, near) => Some(Met { q, near, time: None, decided: false }),
            }
        }
        Way::Task(task) => {
            let (pose, near, decided) = task.first_meeting(pair, left)?;
            Some(Met { q: pose.q.to_vec(), near, time: Some(pose.time), decided })
        }
    }
}
