//! [`Fronts`]: Pareto fronts of added mass against inertia, for several machines under the same bounds.

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Serialize;
use std::borrow::Cow;

use super::front_point::FrontPoint;
use super::workshop::{CutMachine, CutRequest, NoCut};
use stillbase_mechanics::counterweights::{CounterweightSpec, Front, FrontSearch};
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
    /// Bars of which its links are cut, if they are: its counterweights are those on these bars.
    pub bars: Option<CutRequest>,
}

impl FrontCase {
    /// Builds the request from a brief, which states the same bounds and bars for machines with different links.
    pub fn of(name: impl Into<String>, machine: &Machine, brief: &DesignBrief) -> Self {
        // Counterweights are removed here, so that changing them does not change the request.
        let mut machine = machine.without_counterweights().unwrap_or_else(|_| machine.clone());
        let mut bars = None;
        if let (true, Ok((with_material, stock))) = (brief.as_cut, brief.stock(&machine)) {
            (machine, bars) = (with_material, Some(CutRequest { stock, bought: false }));
        }
        Self { name: name.into(), spec: brief.lightest_problem(&machine), machine, bars }
    }

    /// Begins the search for its front with so many machines, on the bars of which it is cut.
    fn search(&self, count: usize) -> Result<Stage, NoCut> {
        let Some(bars) = &self.bars else {
            let search = FrontSearch::begin((self.machine.clone(), self.spec.clone(), count));
            return Ok(Stage::Search(Box::new(search), None));
        };
        let found = bars.balance(&self.machine, &self.spec)?;
        let search = FrontSearch::begin((found.bars.clone(), found.on_bars(&self.spec), count));
        Ok(Stage::Search(Box::new(search), Some(Box::new(found))))
    }

    /// Returns a front as its machines are built: with discs as they are bought, if this is asked for.
    fn as_built(&self, front: Front, found: Option<&CutMachine>) -> Result<Front, NoCut> {
        let Some((found, bars)) = found.zip(self.bars.as_ref()) else { return Ok(front) };
        let built = front.points.into_iter().map(|placed| found.as_built(placed, &self.spec, &bars.stock));
        Ok(Front { points: built.collect::<Result<_, _>>()? })
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
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(into = "StatedFront")]
pub struct MachineFront {
    /// Name of the machine.
    pub name: String,
    /// Its Pareto front, or why it has none.
    pub outcome: Result<MeasuredFront, NoCut>,
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

/// How a front is serialised.
#[derive(JsonSchema, Serialize)]
struct StatedFront {
    machine: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    front: Option<Vec<[f64; 2]>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    front_points: Option<Vec<FrontPoint>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    refused: Option<String>,
}

impl From<MachineFront> for StatedFront {
    fn from(MachineFront { name: machine, outcome }: MachineFront) -> Self {
        match outcome {
            Ok(measured) => {
                let front = Some(measured.measures());
                Self { machine, front, front_points: Some(measured.points), refused: None }
            }
            Err(why) => Self { machine, front: None, front_points: None, refused: Some(why.to_string()) },
        }
    }
}

impl JsonSchema for MachineFront {
    fn schema_name() -> Cow<'static, str> {
        StatedFront::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        StatedFront::json_schema(generator)
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
    /// Its bars are being cut, if it has any.
    Begin,
    /// The machines of the front are being computed, on the bars of a machine that is cut.
    Search(Box<FrontSearch>, Option<Box<CutMachine>>),
    /// The measures of these machines are being computed.
    Telling(Front, Vec<FrontPoint>),
}

impl Query for Fronts {
    type Input = FrontsRequest;
    type Answer = Vec<MachineFront>;

    fn begin(request: FrontsRequest) -> Self {
        Self { now: Stage::Begin, done: Vec::with_capacity(request.machines.len()), request }
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
            Stage::Begin => match of.search(self.request.count) {
                Ok(search) => {
                    self.now = search;
                    return Portion::More(share(0.0));
                }
                Err(why) => Err(why),
            },
            Stage::Search(search, found) => match search.go_on(&mut |found| goes_on(share(found))) {
                Portion::More(found) => return Portion::More(share(found)),
                Portion::Stopped => return Portion::Stopped,
                Portion::Done(Err(why)) => Err(why.into()),
                Portion::Done(Ok(front)) => match of.as_built(front, found.as_deref()) {
                    Ok(front) => {
                        self.now = Stage::Telling(front, Vec::new());
                        return Portion::More(share(1.0));
                    }
                    Err(why) => Err(why),
                },
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
        self.now = Stage::Begin;
        Portion::More(share(2.0))
    }
}
