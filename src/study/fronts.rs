//! [`Fronts`]: Pareto fronts of added mass against inertia, for several machines under the same bounds.

use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

use super::front_point::FrontPoint;
use stillbase_mechanics::counterweights::{CounterweightError, CounterweightSpec, Front, FrontSearch};
use stillbase_mechanics::machine::Machine;
use stillbase_planning::Motion;
use stillbase_query::{ByIdentity, Portion, ProgressCallback, Query};
use stillbase_session::design::DesignBrief;

/// A machine whose Pareto front is requested.
#[derive(Clone, Debug, PartialEq)]
pub struct FrontCase {
    /// Name in the answer.
    pub name: String,
    /// The machine; its counterweights are removed first, except fixed ones.
    pub machine: Machine,
    /// Bounds on the counterweights: the same for all machines, applied to the links of this one.
    pub spec: CounterweightSpec,
}

impl FrontCase {
    /// Builds the request from a brief, which states the same bounds for machines with different links.
    pub fn of(name: impl Into<String>, machine: &Machine, brief: &DesignBrief) -> Self {
        // Counterweights are removed here, so that changing them does not change the request.
        let machine = machine.without_counterweights().unwrap_or_else(|_| machine.clone());
        Self { name: name.into(), spec: brief.lightest_problem(&machine), machine }
    }
}

/// Request for Pareto fronts.
#[derive(Clone, Debug, PartialEq)]
pub struct FrontsRequest {
    /// The machines.
    pub machines: Vec<FrontCase>,
    /// Number of machines on each front, at least two.
    pub count: usize,
    /// Motion for the torque, used for machines with the same number of drives.
    pub motion: Option<ByIdentity<Motion>>,
    /// Whether to compute the areas of workspaces, which take longer than all other measures.
    pub workspace: bool,
}

/// Pareto front of one of several machines.
#[derive(Clone, Debug, PartialEq)]
pub struct MachineFront {
    /// Name of the machine.
    pub name: String,
    /// Its Pareto front, or why it has none.
    pub outcome: Result<MeasuredFront, CounterweightError>,
}

/// A Pareto front with the measures of its machines.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredFront {
    /// The machines, from the lightest to the one with the least inertia.
    pub front: Front,
    /// Measures of each machine, in the same order.
    pub points: Vec<FrontPoint>,
}

impl MeasuredFront {
    /// Returns added mass, kg, and Σ D_k, kg m², of each machine.
    pub fn measures(&self) -> Vec<[f64; 2]> {
        self.points.iter().map(FrontPoint::measures).collect()
    }
}

impl Serialize for MachineFront {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("machine", &self.name)?;
        match &self.outcome {
            Ok(measured) => {
                map.serialize_entry("front", &measured.measures())?;
                map.serialize_entry("front_points", &measured.points)?;
            }
            Err(why) => map.serialize_entry("refused", &why.to_string())?,
        }
        map.end()
    }
}

/// Query for the Pareto fronts of several machines, in their order. For a machine that cannot be balanced, the answer
/// has the reason in place of a front.
#[derive(Debug)]
pub struct Fronts {
    request: FrontsRequest,
    done: Vec<MachineFront>,
    now: Stage,
}

/// Progress on the front of one machine.
#[derive(Debug)]
enum Stage {
    /// The machines of the front are being computed.
    Search(Box<FrontSearch>),
    /// The measures of these machines are being computed.
    Telling(Front, Vec<FrontPoint>),
}

impl Query for Fronts {
    type Input = FrontsRequest;
    type Answer = Vec<MachineFront>;

    fn begin(request: FrontsRequest) -> Self {
        Self { now: Stage::of(&request, 0), done: Vec::with_capacity(request.machines.len()), request }
    }

    /// Computes one machine of a front, or its measures.
    fn go_on(&mut self, goes_on: ProgressCallback<'_>) -> Portion<Self::Answer> {
        let (known, all) = (self.done.len(), self.request.machines.len() as f64);
        let Some(of) = self.request.machines.get(known) else {
            return Portion::Done(std::mem::take(&mut self.done));
        };
        // For each machine, the search is one half of the work and the measures are the other.
        let share = |half: f64| (known as f64 + 0.5 * half) / all;
        let outcome = match &mut self.now {
            Stage::Search(search) => match search.go_on(&mut |found| goes_on(share(found))) {
                Portion::More(found) => return Portion::More(share(found)),
                Portion::Stopped => return Portion::Stopped,
                Portion::Done(Err(why)) => Err(why),
                Portion::Done(Ok(front)) => {
                    self.now = Stage::Telling(front, Vec::new());
                    return Portion::More(share(1.0));
                }
            },
            Stage::Telling(front, points) => match front.points.get(points.len()) {
                Some(placed) => {
                    let motion = self.request.motion.as_ref().map(|motion| &*motion.0);
                    let motion = motion.filter(|motion| motion.at(0.0).q.len() == of.machine.drives());
                    points.push(FrontPoint::of(placed, motion, self.request.workspace));
                    return Portion::More(share(1.0 + points.len() as f64 / front.points.len() as f64));
                }
                None => {
                    let front = Front { points: std::mem::take(&mut front.points) };
                    Ok(MeasuredFront { front, points: std::mem::take(points) })
                }
            },
        };
        self.done.push(MachineFront { name: of.name.clone(), outcome });
        self.now = Stage::of(&self.request, known + 1);
        Portion::More(share(2.0))
    }
}

impl Stage {
    /// Returns the first stage for machine `i`; after the last machine, an empty stage that is never run.
    fn of(request: &FrontsRequest, i: usize) -> Self {
        match request.machines.get(i) {
            Some(of) => {
                let search = FrontSearch::begin((of.machine.clone(), of.spec.clone(), request.count));
                Self::Search(Box::new(search))
            }
            None => Self::Telling(Front { points: Vec::new() }, Vec::new()),
        }
    }
}
