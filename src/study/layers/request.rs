//! [`find_layers`]: an order of the links of a machine, or the reason why there is none.

use std::fmt;

use stillbase_exchange::cut::{Cut, CutError};
use stillbase_mechanics::machine::{Machine, MachineError};
use stillbase_planning::Motion;
use stillbase_query::{ByIdentity, QuickQuery};
use stillbase_settings::number::fixed;
use thiserror::Error;

use super::clash::Clash;
use super::clearance::Clearance;
use super::contact::{Between, Contact, Solids, Way};
use super::range::PoseRange;
use super::report::{Change, LayersReport, LinkLayer};
use super::stack::{Ended, MAX_LAYERS, Stack};
use super::tilt::{LeastTilt, TiltMeasure, largest_tilt, tilt_coefficient};
use super::way::TaskPoses;

/// Partial orders, of machines of a few links, that are examined to find the fewest layers, to explain a conflict, and to tilt the base least.
const ORDERS: usize = 400_000;

/// What layers are asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct LayersRequest {
    /// The machine.
    pub machine: Machine,
    /// Dimensions of its parts.
    pub cut: Cut,
    /// The motion of a task, which says what tilts.
    pub motion: Option<ByIdentity<Motion>>,
    /// Whether nothing may meet along that motion alone, instead of everywhere within the joint limits.
    pub along_task: bool,
}

/// Reason that there are no layers.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum NoLayers {
    /// The links cannot be cut with these dimensions.
    #[error(transparent)]
    Cut(#[from] CutError),
    /// The layers make no valid machine.
    #[error(transparent)]
    Machine(#[from] MachineError),
    /// The task has no motion, or one of another number of drives.
    #[error("no motion of {0} drives: want a task of this machine")]
    Motion(usize),
    /// No order exists.
    #[error("{0}")]
    NoOrder(Conflict),
    /// No order was found.
    #[error(
        "no order found within {ORDERS} partial orders and {MAX_LAYERS} layers, and no proof that there is none: \
         want fewer links, or thinner discs"
    )]
    NotFound,
}

/// Links that cannot be stacked, and what they meet.
#[derive(Clone, Debug, PartialEq)]
pub struct Conflict {
    /// Names of the links.
    pub links: Vec<String>,
    /// The fewest contacts that leave no order.
    pub contacts: Vec<Contact>,
}

impl fmt::Display for Conflict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no order of links {} keeps them apart", listed(&self.links))?;
        for (i, contact) in self.contacts.iter().enumerate() {
            let q: Vec<String> = contact.q.iter().map(|q| fixed(*q, 3)).collect();
            let [x, y] = contact.at.map(|metres| fixed(metres, 3));
            let verb = if contact.decided { "meets" } else { "may meet" };
            write!(
                f,
                "{} {} {verb} {} at ({x}, {y}) m, q = {} rad",
                if i == 0 { ":" } else { ";" },
                contact.a,
                contact.b,
                q.join(", ")
            )?;
            if let Some(time) = contact.time {
                write!(f, ", {} s", fixed(time, 3))?;
            }
        }
        f.write_str("; want narrower limits, or narrower bars; along one task an order may exist")
    }
}

fn listed(names: &[String]) -> String {
    match names {
        [first @ .., last] if !first.is_empty() => format!("{} and {last}", first.join(", ")),
        _ => names.concat(),
    }
}

impl LayersRequest {
    /// Returns the poses of the task, if there is one.
    fn task(&self) -> Result<Option<TaskPoses>, NoLayers> {
        match &self.motion {
            Some(motion) if motion.0.at(0.0).q.len() == self.machine.drives() => Ok(Some(TaskPoses::of(&motion.0))),
            None if !self.along_task => Ok(None),
            _ => Err(NoLayers::Motion(self.machine.drives())),
        }
    }

    fn contacts(&self, task: Option<&TaskPoses>) -> Result<(Solids, Vec<Contact>), NoLayers> {
        let (machine, cut) = (&self.machine, &self.cut);
        machine.check_all_turn("layers")?;
        cut.check(machine)?;
        let solids = Solids::of(machine, cut);
        let range = PoseRange::of(machine);
        let way = match task.filter(|_| self.along_task) {
            Some(task) => Way::Task(task),
            None => Way::Limits(&range),
        };
        let contacts = solids.contacts(machine, cut, &way);
        Ok((solids, contacts))
    }
}

/// Finds the solids of a machine that overlap in plan.
///
/// # Errors
/// If the parts cannot be cut, or the motion is of another machine.
pub fn find_contacts(request: &LayersRequest) -> Result<Vec<Contact>, NoLayers> {
    let task = request.task()?;
    Ok(request.contacts(task.as_ref())?.1)
}

/// Finds layers for the links of a machine.
///
/// # Errors
/// If the parts cannot be cut, the motion is of another machine, or no order exists or is found.
pub fn find_layers(request: &LayersRequest) -> Result<LayersReport, NoLayers> {
    let LayersRequest { machine, cut, .. } = request;
    let task = request.task()?;
    let (solids, meetings) = request.contacts(task.as_ref())?;
    let links = machine.links().len();
    let stack = Stack::of(links, &solids, cut, &meetings);
    let mut budget = ORDERS;
    if stack.has_order(&mut budget) == Some(false) {
        return Err(NoLayers::NoOrder(conflict(machine, cut, &solids, &stack, &meetings)));
    }
    let mut budget = ORDERS;
    let (first, count, minimal) = stack.lowest(&mut budget).ok_or(NoLayers::NotFound)?;
    let pitch = cut.layer_pitch();
    let mut visitor = LeastTilt::from(TiltMeasure::of(machine, task.as_ref(), pitch), first);
    let mut budget = ORDERS;
    let least_tilt = stack.search(count, &mut visitor, &mut budget) == Ended::Complete;
    let layers = visitor.best.0;
    let heights: Vec<f64> = layers.iter().map(|layer| *layer as f64 * pitch).collect();
    // Along the task no two links meet, elsewhere they may: the machine is shown where the task begins.
    let pose = request.motion.as_ref().filter(|_| request.along_task).map(|motion| motion.0.at(0.0).q.to_vec());
    let stacked = at_heights(machine, &heights, pose)?;
    let row = |(link, &layer): (&stillbase_mechanics::machine::Link, &usize)| LinkLayer {
        link: link.name.clone(),
        layer,
        height: layer as f64 * pitch,
    };
    let [low, high] = ends(&stacked, &solids);
    // A payload above its link is kept as far away on both sides.
    let is_exact = solids.links.iter().all(|solid| solid.rise == 0.0);
    // Pairs that are not decided count as meeting. If they do not meet, another order may have fewer layers or less tilt.
    let certain: Vec<Contact> = meetings.iter().filter(|contact| contact.decided).cloned().collect();
    let is_decided = certain.len() == meetings.len();
    let needs_as_many = || {
        let lowest = Stack::of(links, &solids, cut, &certain).lowest(&mut { ORDERS });
        lowest.is_some_and(|(_, fewest, minimal)| minimal && fewest == count)
    };
    let minimal = minimal && is_exact && (is_decided || needs_as_many());
    Ok(LayersReport {
        layers: machine.spec().links.iter().zip(&layers).map(row).collect(),
        count,
        height: high - low,
        tilt: task
            .as_ref()
            .map(|task| Change { before: largest_tilt(machine, task), after: largest_tilt(&stacked, task) }),
        tilt_coefficient: Change { before: tilt_coefficient(machine), after: tilt_coefficient(&stacked) },
        minimal,
        least_tilt: least_tilt && is_exact && is_decided,
        clashes: Clash::all(machine, &meetings),
        meetings,
        clearance: task.as_ref().and_then(|task| Clearance::least(&stacked, cut, task)),
        machine: stacked,
    })
}

/// Returns the machine with its links at heights, m, drawn in a pose, rad, if one is given; the payload keeps its height
/// above the link that holds it.
fn at_heights(machine: &Machine, heights: &[f64], pose: Option<Vec<f64>>) -> Result<Machine, MachineError> {
    let mut spec = machine.spec().clone();
    spec.pose = pose.or(spec.pose);
    let end = machine.end_link();
    // The height of a payload that is not there has no use.
    if spec.payload.mass > 0.0 || spec.payload.axial != 0.0 {
        spec.payload.axial += heights[end] - spec.links[end].axial;
    }
    for (link, height) in spec.links.iter_mut().zip(heights) {
        link.axial = *height;
    }
    Machine::new(spec)
}

/// Returns the lowest and the uppermost face of the solids of a machine, m.
fn ends(machine: &Machine, solids: &Solids) -> [f64; 2] {
    let faces = solids.links.iter().flat_map(|solid| solid.faces(machine));
    faces.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], face| [low.min(face), high.max(face)])
}

/// Returns the fewest links without an order, and contacts of these that leave none.
fn conflict(machine: &Machine, cut: &Cut, solids: &Solids, stack: &Stack, contacts: &[Contact]) -> Conflict {
    let mut budget = ORDERS;
    let links = stack.conflict(&mut budget);
    let is_among = |contact: &&Contact| match contact.between {
        Between::Links(a, b) => links.contains(&a) && links.contains(&b),
        Between::Pin(a, _) => links.contains(&a),
    };
    let mut left: Vec<Contact> = contacts.iter().filter(is_among).cloned().collect();
    // What can be left out without an order coming up explains nothing.
    let mut i = 0;
    while i < left.len() && budget > 0 {
        let mut without = left.clone();
        without.remove(i);
        let lacks = Stack::of(machine.links().len(), solids, cut, &without).has_order(&mut budget) == Some(false);
        if lacks { left = without } else { i += 1 }
    }
    let names = links.iter().map(|link| machine.spec().links[*link].name.clone());
    Conflict { links: names.collect(), contacts: left }
}

/// Layers of a machine within its joint limits, and else along its task.
#[derive(Clone, Debug)]
pub struct LayersAnswer {
    /// Layers in which nothing meets within the joint limits.
    pub within_limits: Result<LayersReport, NoLayers>,
    /// Layers in which nothing meets along the task, if there are none within the limits but a task.
    pub along_task: Option<Result<LayersReport, NoLayers>>,
}

impl LayersAnswer {
    /// Returns the layers of the first kind that exists.
    pub fn report(&self) -> Option<&LayersReport> {
        let along_task = self.along_task.as_ref().and_then(|report| report.as_ref().ok());
        self.within_limits.as_ref().ok().or(along_task)
    }
}

/// Query for the layers of a machine.
pub struct LayersQuery;

impl QuickQuery for LayersQuery {
    /// The machine, the dimensions of its parts, and the motion of its task.
    type Input = (Machine, Cut, Option<ByIdentity<Motion>>);
    type Answer = LayersAnswer;

    fn answer((machine, cut, motion): &Self::Input) -> LayersAnswer {
        let (machine, motion) = (machine.clone(), motion.clone());
        let request = LayersRequest { machine, cut: *cut, motion, along_task: false };
        let within_limits = find_layers(&request);
        let lacks = matches!(within_limits, Err(NoLayers::NoOrder(_) | NoLayers::NotFound));
        let has_task = request.motion.is_some();
        let along_task = (lacks && has_task).then(|| find_layers(&LayersRequest { along_task: true, ..request }));
        LayersAnswer { within_limits, along_task }
    }
}
