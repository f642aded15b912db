//! [`Contact`]: two solids that overlap in plan, where and in which pose, and how many layers must lie between them.

use serde::Serialize;
use stillbase_exchange::cut::Cut;
use stillbase_exchange::solids::{Axle, LinkSolid, axles, link_solids};
use stillbase_mechanics::machine::Machine;

use super::overlap::{Overlap, Pair};
use super::plan::{Nearness, PlanSolid};
use super::range::PoseRange;
use super::way::TaskPoses;

/// Cells of poses that are examined for one pair of solids, and for all pairs together.
const CELLS_PER_PAIR: usize = 100_000;
const CELLS: usize = 2_000_000;

/// Two solids that overlap in plan in some pose, so that they cannot lie in one layer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Contact {
    /// Name of the first: a bar or a disc.
    pub a: String,
    /// Name of the second: a bar, a disc or a pin.
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

impl Solids {
    /// Returns the solids of a machine.
    pub fn of(machine: &Machine, cut: &Cut) -> Self {
        let (links, axles) = (link_solids(machine, cut), axles(machine));
        let plans = links.iter().map(|solid| PlanSolid::of(machine, solid)).collect();
        let pins = axles.iter().map(|axle| PlanSolid::of_pin(axle, cut.spacer_radius())).collect();
        Self { links, axles, plans, pins }
    }

    /// Returns the contacts of a machine.
    pub fn contacts(&self, machine: &Machine, cut: &Cut, way: &Way<'_>) -> Vec<Contact> {
        let mut left = CELLS;
        let mut contacts = Vec::new();
        for (i, a) in self.links.iter().enumerate() {
            for (j, b) in self.links.iter().enumerate().skip(i + 1).filter(|(_, b)| b.link != a.link) {
                let apart = layers_between(cut, a.thickness, b.thickness);
                let contact = meeting(&Pair::of(&self.plans[i], &self.plans[j]), way, &mut left);
                contacts.extend(
                    contact.map(|met| {
                        met.contact([a.name(machine), b.name(machine)], apart, Between::Links(a.link, b.link))
                    }),
                );
            }
            for (j, axle) in self.axles.iter().enumerate().filter(|(_, axle)| axle.is_pin() && !axle.joins(a.link)) {
                let apart = layers_between(cut, a.thickness, cut.plate_thickness);
                let contact = meeting(&Pair::of(&self.plans[i], &self.pins[j]), way, &mut left);
                contacts.extend(
                    contact
                        .map(|met| met.contact([a.name(machine), axle.name(machine)], apart, Between::Pin(a.link, j))),
                );
            }
        }
        contacts
    }
}

/// Returns how many layers further one solid must lie than another of these thicknesses, m, that it overlaps.
pub fn layers_between(cut: &Cut, a: f64, b: f64) -> usize {
    // What rounding adds is no layer.
    (((0.5 * (a + b) + cut.spacer) / cut.layer_pitch() - 1e-9).ceil() as usize).max(1)
}

/// A pose in which two solids meet.
struct Met {
    q: Vec<f64>,
    near: Nearness,
    time: Option<f64>,
    decided: bool,
}

impl Met {
    fn contact(self, [a, b]: [String; 2], apart: usize, between: Between) -> Contact {
        let at = [self.near.at.re, self.near.at.im];
        Contact { a, b, at, q: self.q, time: self.time, decided: self.decided, apart, between }
    }
}

fn meeting(pair: &Pair<'_>, way: &Way<'_>, left: &mut usize) -> Option<Met> {
    match way {
        Way::Limits(range) => {
            let given = CELLS_PER_PAIR.min(*left);
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
            let (pose, near, decided) = task.first_meeting(pair)?;
            Some(Met { q: pose.q.to_vec(), near, time: Some(pose.time), decided })
        }
    }
}
