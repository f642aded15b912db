//! [`front`]: the Pareto front of added mass and inertia.

use super::place::{PlacedCounterweights, place};
use super::refusal::CounterweightError;
use super::spec::{CounterweightSpec, Objective};
use super::subject::{SpatialGoal, Subject};
use crate::assembly::Assembly;
use crate::machine::{Inertia, Machine};
use stillbase_query::{Portion, ProgressCallback, Query, answer_now, answer_while};

/// Points of the Pareto front, from the least added mass to the least inertia: no machine, or no assembly, is better than
/// another in both.
#[derive(Clone, Debug, PartialEq)]
pub struct Front<Carrier = Machine> {
    /// The points, by increasing mass and decreasing inertia.
    pub points: Vec<PlacedCounterweights<Carrier>>,
}

impl Front {
    /// Returns added mass, kg, and Σ D_k, kg m², of each point.
    pub fn measures(&self) -> Vec<[f64; 2]> {
        let of = |placed: &PlacedCounterweights| Inertia::of(&placed.machine).total_momentum();
        self.points.iter().map(|placed| [placed.added_mass, of(placed)]).collect()
    }
}

/// Returns added mass, kg, and Σ D_k, kg m².
fn measures(placed: &PlacedCounterweights<Assembly>) -> [f64; 2] {
    [placed.added_mass, placed.machine.total_momentum()]
}

/// Relative amount by which an end of the Pareto front may lie above the least inertia or mass. Near a minimum, a small
/// part of one measure is worth much of the other: its square root.
pub const END_TOLERANCE: f64 = 1e-6;

/// Returns `count` points of the Pareto front, at least two, or one if a single machine is best in both measures. The
/// search begins with the points of least inertia and of least mass. At each of these, the other measure is minimised
/// within [`END_TOLERANCE`] of the first. Each further point bisects the widest gap, in the measure in which its
/// neighbours differ most.
///
/// # Errors
/// As [`place_weights`](super::place_weights), and if a rotor is free.
pub fn front(machine: &Machine, request: &CounterweightSpec, count: usize) -> Result<Front, CounterweightError> {
    answer_now::<FrontSearch>((machine.clone(), request.clone(), count))
}

/// Does the same as [`front`]; `None` if `goes_on` ends the search. It is called between two points.
pub fn front_while(
    machine: &Machine,
    request: &CounterweightSpec,
    count: usize,
    goes_on: ProgressCallback<'_>,
) -> Option<Result<Front, CounterweightError>> {
    answer_while::<FrontSearch>((machine.clone(), request.clone(), count), goes_on)
}

/// The search for the Pareto front that [`front`] returns; each portion of work finds one point.
#[derive(Clone, Debug)]
pub struct FrontSearch(FrontWalk);

impl Query for FrontSearch {
    type Input = (Machine, CounterweightSpec, usize);
    type Answer = Result<Front, CounterweightError>;

    fn begin((machine, request, count): Self::Input) -> Self {
        Self(FrontWalk::begin(Assembly::from(machine), None, request, count))
    }

    fn go_on(&mut self, _: ProgressCallback<'_>) -> Portion<Self::Answer> {
        let of_machines = |front: Front<Assembly>| Front {
            points: front.points.into_iter().map(PlacedCounterweights::of_machine).collect(),
        };
        match self.0.go_on() {
            Portion::More(share) => Portion::More(share),
            Portion::Stopped => Portion::Stopped,
            Portion::Done(found) => Portion::Done(found.map(of_machines)),
        }
    }
}

/// The points of a Pareto front found so far, of a machine by itself or of an assembly.
#[derive(Clone, Debug)]
pub(super) struct FrontWalk {
    whole: Assembly,
    /// Further conditions of the blocks of an assembly.
    goals: Option<Vec<SpatialGoal>>,
    mass: CounterweightSpec,
    inertia: CounterweightSpec,
    count: usize,
    /// The points, by increasing mass, with their measures.
    points: Vec<([f64; 2], PlacedCounterweights<Assembly>)>,
}

impl FrontWalk {
    pub fn begin(whole: Assembly, goals: Option<Vec<SpatialGoal>>, request: CounterweightSpec, count: usize) -> Self {
        let mass = CounterweightSpec { objective: Objective::mass(), ..request.clone() };
        let inertia = CounterweightSpec { objective: Objective::inertia(), ..request };
        Self { whole, goals, mass, inertia, count, points: Vec::with_capacity(count) }
    }

    /// Finds one more point, or returns all of them.
    pub fn go_on(&mut self) -> Portion<Result<Front<Assembly>, CounterweightError>> {
        match self.one_more() {
            Ok(true) => Portion::More(self.points.len() as f64 / self.count.max(2) as f64),
            Ok(false) => {
                let points = std::mem::take(&mut self.points);
                Portion::Done(Ok(Front { points: points.into_iter().map(|(_, placed)| placed).collect() }))
            }
            Err(why) => Portion::Done(Err(why)),
        }
    }

    fn subject(&self) -> Subject<'_> {
        match &self.goals {
            Some(goals) => Subject::assembly(&self.whole, goals),
            None => Subject::machine(&self.whole, &[]),
        }
    }
}

/// Returns whether two measures of the ends are equal: each end is exact to [`END_TOLERANCE`].
fn alike(a: f64, b: f64) -> bool {
    (a - b).abs() <= 2.0 * END_TOLERANCE * a.abs().max(b.abs()).max(f64::MIN_POSITIVE)
}

/// Returns the end of the front with the least mass (axis 0) or inertia (axis 1), with the least of the other measure.
fn end_of(
    subject: Subject,
    [mass, inertia]: [&CounterweightSpec; 2],
    axis: usize,
) -> Result<PlacedCounterweights<Assembly>, CounterweightError> {
    let first = place(subject, [mass, inertia][axis])?;
    let bound = |asked: Option<f64>| {
        let near = measures(&first)[axis] * (1.0 + END_TOLERANCE);
        Some(asked.map_or(near, |most| most.min(near)))
    };
    let other = match axis {
        0 => CounterweightSpec { max_added_mass: bound(mass.max_added_mass), ..inertia.clone() },
        _ => CounterweightSpec { max_inertia: bound(inertia.max_inertia), ..mass.clone() },
    };
    // The second search can fail only by rounding at its bound, which has one solution.
    let better = |second: &PlacedCounterweights<Assembly>| measures(second)[1 - axis] < measures(&first)[1 - axis];
    Ok(place(subject, &other).ok().filter(better).unwrap_or(first))
}

impl FrontWalk {
    /// Adds one more point; returns false if the Pareto front is complete.
    fn one_more(&mut self) -> Result<bool, CounterweightError> {
        let subject = self.subject();
        let Self { mass, inertia, count, points, .. } = &*self;
        if let Some(free) = inertia.rotors.first() {
            let name = subject.drive_name(free.drive);
            return Err(CounterweightError::FreeRotorOfFront(name));
        }
        let (i, request) = match points.len() {
            // Least inertia comes first, so that it reports the errors that both objectives share.
            end @ (0 | 1) => {
                let placed = end_of(subject, [mass, inertia], 1 - end)?;
                self.points.insert(0, (measures(&placed), placed));
                return Ok(true);
            }
            // If one machine is best in both measures, it is the whole Pareto front.
            last if [0, 1].iter().all(|axis| alike(points[0].0[*axis], points[last - 1].0[*axis])) => {
                self.points.truncate(1);
                return Ok(false);
            }
            known if known >= *count => return Ok(false),
            last => {
                let size =
                    [0, 1].map(|axis| (points[last - 1].0[axis] - points[0].0[axis]).abs().max(f64::MIN_POSITIVE));
                let apart =
                    |i: usize| [0, 1].map(|axis| (points[i + 1].0[axis] - points[i].0[axis]).abs() / size[axis]);
                let furthest = (0..last - 1).map(|i| (i, apart(i)));
                let Some((i, [by_mass, by_inertia])) =
                    furthest.max_by(|a, b| a.1[0].hypot(a.1[1]).total_cmp(&b.1[0].hypot(b.1[1])))
                else {
                    return Ok(false);
                };
                let halfway = |axis: usize| Some(0.5 * (points[i].0[axis] + points[i + 1].0[axis]));
                let between = match by_mass > by_inertia {
                    true => CounterweightSpec { max_added_mass: halfway(0), ..inertia.clone() },
                    false => CounterweightSpec { max_inertia: halfway(1), ..mass.clone() },
                };
                (i + 1, between)
            }
        };
        let placed = place(subject, &request)?;
        self.points.insert(i, (measures(&placed), placed));
        Ok(true)
    }
}
