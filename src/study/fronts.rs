//! [`Fronts`]: what less inertia costs in mass, of several machines under the same bounds, side by side.

use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

use super::front_point::FrontPoint;
use crate::mechanics::counterweights::{Front, FrontSearch, NoWeights, Weighing};
use crate::mechanics::machine::Machine;
use crate::planning::Motion;
use crate::query::{Portion, Query, Same, Watch};
use crate::session::design::Brief;

/// A machine whose front is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct FrontOf {
    /// What it is called in the answer.
    pub name: String,
    /// It; counterweights that it has are taken off first, but for fixed ones.
    pub machine: Machine,
    /// The bounds that are the same for all, as they are for its links.
    pub asked: Weighing,
}

impl FrontOf {
    /// As a brief has it: the one way to ask the same of machines whose links differ.
    pub fn of(name: impl Into<String>, machine: &Machine, brief: &Brief) -> Self {
        // So that the answer stays the same while the counterweights that are taken off change.
        let machine = machine.without_counterweights().unwrap_or_else(|_| machine.clone());
        Self { name: name.into(), asked: brief.weighing(&machine), machine }
    }
}

/// What fronts are asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct FrontsRequest {
    /// Of these machines.
    pub machines: Vec<FrontOf>,
    /// How many machines each front has, at least two.
    pub count: usize,
    /// The motion whose torque is told, of machines with as many drives as it has.
    pub motion: Option<Same<Motion>>,
    /// Whether the areas of workspaces are told: they take longer than all else.
    pub workspace: bool,
}

/// The front of one of several machines.
#[derive(Clone, Debug, PartialEq)]
pub struct MachineFront {
    /// What it is called.
    pub name: String,
    /// Its front, or why it has none.
    pub outcome: Result<ToldFront, NoWeights>,
}

/// A front, and what each of its machines comes to.
#[derive(Clone, Debug, PartialEq)]
pub struct ToldFront {
    /// From light to quick.
    pub front: Front,
    /// Of each machine, in the same order.
    pub points: Vec<FrontPoint>,
}

impl ToldFront {
    /// Added mass, kg, and Σ D_k, kg m², of each machine.
    pub fn measures(&self) -> Vec<[f64; 2]> {
        self.points.iter().map(FrontPoint::measures).collect()
    }
}

impl Serialize for MachineFront {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("machine", &self.name)?;
        match &self.outcome {
            Ok(told) => {
                map.serialize_entry("front", &told.measures())?;
                map.serialize_entry("front_points", &told.points)?;
            }
            Err(why) => map.serialize_entry("refused", &why.to_string())?,
        }
        map.end()
    }
}

/// The fronts of several machines, in their order; a machine that nothing balances has its reason, and the others stand.
#[derive(Debug)]
pub struct Fronts {
    asked: FrontsRequest,
    done: Vec<MachineFront>,
    now: Stage,
}

/// How far the front of one machine has come.
#[derive(Debug)]
enum Stage {
    /// Its machines are looked for.
    Search(Box<FrontSearch>),
    /// What they come to is found.
    Telling(Front, Vec<FrontPoint>),
}

impl Query for Fronts {
    type Input = FrontsRequest;
    type Answer = Vec<MachineFront>;

    fn begin(asked: FrontsRequest) -> Self {
        Self { now: Stage::of(&asked, 0), done: Vec::with_capacity(asked.machines.len()), asked }
    }

    /// A machine of a front in a portion, found or told.
    fn go_on(&mut self, goes_on: Watch<'_>) -> Portion<Self::Answer> {
        let (known, all) = (self.done.len(), self.asked.machines.len() as f64);
        let Some(of) = self.asked.machines.get(known) else {
            return Portion::Done(std::mem::take(&mut self.done));
        };
        // Of one machine the search is one half, what is told the other.
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
                    let motion = self.asked.motion.as_ref().map(|motion| &*motion.0);
                    let motion = motion.filter(|motion| motion.at(0.0).q.len() == of.machine.drives());
                    points.push(FrontPoint::of(placed, motion, self.asked.workspace));
                    return Portion::More(share(1.0 + points.len() as f64 / front.points.len() as f64));
                }
                None => {
                    let front = Front { points: std::mem::take(&mut front.points) };
                    Ok(ToldFront { front, points: std::mem::take(points) })
                }
            },
        };
        self.done.push(MachineFront { name: of.name.clone(), outcome });
        self.now = Stage::of(&self.asked, known + 1);
        Portion::More(share(2.0))
    }
}

impl Stage {
    /// The beginning for one of the machines; after the last, nothing that is asked.
    fn of(asked: &FrontsRequest, i: usize) -> Self {
        match asked.machines.get(i) {
            Some(of) => {
                let search = FrontSearch::begin((of.machine.clone(), of.asked.clone(), asked.count));
                Self::Search(Box::new(search))
            }
            None => Self::Telling(Front { points: Vec::new() }, Vec::new()),
        }
    }
}
