//! [`DesignFacts`]: values that the panels of the design view show, requested from the query cache at each repaint.

use std::sync::Arc;

use super::layers;
use super::lengths::LengthsResult;
use super::lesson::MachineEquations;
use stillbase_mechanics::balance::{Breakdown, Condition};
use stillbase_mechanics::counterweights::{
    CounterweightError, Front, FrontSearch, PayloadResidual, PlacedCounterweights, over_payloads,
};
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_picture::scene::mesh::SEGMENTS;
use stillbase_picture::scene::options::WeightOption;
use stillbase_planning::Motion;
use stillbase_planning::pose_space::{Planes, PoseSpace};
use stillbase_query::{
    ByIdentity, Portion, ProgressCallback, Queries, Query, QueryResult, QueryStatus, QuickQuery, QuickWork,
};
use stillbase_session::Session;
use stillbase_session::design::DesignBrief;
use stillbase_settings::number::subscript;
use stillbase_study::front_point::FrontMeasure;
use stillbase_study::fronts::{FrontCase, Fronts, FrontsRequest, MachineFront};
use stillbase_study::layers::{LayersAnswer, LayersQuery};
use stillbase_study::lengths::LengthsQuery;
use stillbase_study::measures::Measures;
use stillbase_study::workshop::{CutMachine, CutQuery, CutRequest, NoCut};

/// Number of points of a Pareto front.
const FRONT_POINTS: usize = 25;
/// Number of payloads at which the balance is evaluated.
const PAYLOAD_POINTS: usize = 41;

/// Values of the machine on display.
pub struct DesignFacts {
    /// The lines of Eqs. (7) and (8).
    pub(super) terms: Arc<Vec<BalanceBars>>,
    sums: Arc<Sums>,
    /// The machine on display: that of the session, or the one that a drag previews.
    pub(super) machine: Machine,
    /// Area of its reactionless workspace, m².
    pub(super) workspace: Option<WorkspaceSize>,
    /// Whether a drag previews the machine.
    pub(super) is_preview: bool,
    /// Cost of the balance, in comparison with the machine without its counterweights.
    pub(super) measures: Option<Arc<Measures>>,
    /// Residual of the balance over the payloads of the brief.
    pub(super) payloads: Option<Arc<Vec<PayloadResidual>>>,
    /// Pareto front of added mass and inertia; `None` beside the equations, or without a valid bare machine.
    front: Option<QueryResult<Points>>,
    /// The search for lengths of this machine, if there is one.
    pub(super) length_search: Option<LengthsResult>,
    /// The machine as it is cut; `None` if that is not asked for.
    pub(super) cut: Option<QueryResult<Result<CutMachine, NoCut>>>,
    /// Pareto fronts of other machines; `None` without such machines, or while the equations are on display.
    other_fronts: Option<QueryResult<Vec<MachineFront>>>,
    /// The measure that colours the points of the front.
    pub(super) front_measure: Option<Arc<MeasureValues>>,
    /// Layers of the links, or the reason why there are none.
    pub(super) layers: QueryResult<LayersAnswer>,
    /// Equations of the machine; `None` while the front is on display.
    pub(super) lesson: Option<Arc<MachineEquations>>,
}

/// The points of a Pareto front, by increasing mass, or the reason why there are none.
type Points = Result<Vec<FrontMachine>, CounterweightError>;

/// Sums over a machine.
struct Sums {
    /// λ of the drives.
    lambda: Vec<f64>,
    /// Total mass of the counterweights, kg, and Σ D_k, kg m².
    now: [f64; 2],
    /// Whether Eqs. (7) and (8) hold.
    balanced: bool,
    /// The machine without its counterweights, except fixed ones; `None` if it would not be valid.
    bare: Option<Machine>,
}

impl QuickQuery for Sums {
    type Input = Machine;
    type Answer = Self;

    fn answer(machine: &Machine) -> Self {
        let inertia = Inertia::of(machine);
        let added = machine.spec().counterweights.iter().map(|weight| weight.mass).sum();
        Self {
            lambda: inertia.lambda().to_vec(),
            now: [added, inertia.total_momentum()],
            balanced: inertia.is_balanced(),
            bare: machine.without_counterweights().ok(),
        }
    }
}

/// Area of a workspace.
#[derive(Clone, Copy)]
pub(super) struct WorkspaceSize {
    /// m².
    pub area: f64,
    pub is_reactionless: bool,
}

fn area_of(planes: &Planes) -> WorkspaceSize {
    WorkspaceSize { area: planes.boundary().area(), is_reactionless: planes.is_reactionless() }
}

/// Query for the area of the reactionless workspace of a machine; `None` if it has no planes.
struct WorkspaceArea;

impl QuickQuery for WorkspaceArea {
    type Input = Machine;
    type Answer = Option<WorkspaceSize>;

    fn answer(machine: &Machine) -> Self::Answer {
        PoseSpace::of(machine).ok()?.planes().ok().map(|planes| area_of(planes))
    }
}

/// Query for the lines of Eqs. (7) and (8) of a machine.
struct Terms;

impl QuickQuery for Terms {
    type Input = Machine;
    type Answer = Vec<BalanceBars>;

    fn answer(machine: &Machine) -> Vec<BalanceBars> {
        terms(machine)
    }
}

/// Query for the cost of balancing a machine, in comparison with the machine without counterweights in the same
/// motion.
struct Cost;

impl QuickQuery for Cost {
    type Input = (Machine, Machine, Option<ByIdentity<Motion>>);
    type Answer = Measures;

    fn answer((bare, machine, motion): &Self::Input) -> Measures {
        Measures::of(bare, machine, motion.as_ref().map(|motion| &*motion.0))
    }
}

/// Query for the residual of a machine's balance over an interval of payloads, kg.
struct OverPayloads;

impl QuickQuery for OverPayloads {
    type Input = (Machine, [f64; 2]);
    type Answer = Vec<PayloadResidual>;

    fn answer((machine, ends): &Self::Input) -> Vec<PayloadResidual> {
        over_payloads(machine, *ends, PAYLOAD_POINTS).unwrap_or_default()
    }
}

/// Query for the points of a Pareto front with Σ D_k of their machines.
struct FrontPoints;

impl QuickQuery for FrontPoints {
    type Input = ByIdentity<Result<Front, CounterweightError>>;
    type Answer = Points;

    fn answer(front: &Self::Input) -> Points {
        let front = front.0.as_ref().as_ref().map_err(Clone::clone)?;
        let measures = front.measures().into_iter();
        let point = |(placed, [_, inertia]): (&PlacedCounterweights, [f64; 2])| FrontMachine {
            placed: placed.clone(),
            inertia,
        };
        Ok(front.points.iter().zip(measures).map(point).collect())
    }
}

/// A measure of the machines of a Pareto front.
pub(super) struct MeasureValues {
    pub measure: FrontMeasure,
    /// Its value for each machine; `None` where a machine has none.
    pub values: Vec<Option<f64>>,
}

/// Query for the measure of each machine, one machine per portion.
struct MeasureQuery {
    of: <Self as Query>::Input,
    values: Vec<Option<f64>>,
}

impl Query for MeasureQuery {
    /// The front, the measure, and the motion.
    type Input = (ByIdentity<Points>, FrontMeasure, Option<ByIdentity<Motion>>);
    type Answer = MeasureValues;

    fn begin(of: Self::Input) -> Self {
        Self { of, values: Vec::new() }
    }

    fn go_on(&mut self, _: ProgressCallback<'_>) -> Portion<Self::Answer> {
        let (front, by, motion) = &self.of;
        let points = front.0.as_deref().unwrap_or_default();
        match points.get(self.values.len()) {
            Some(point) => {
                self.values.push(by.of(&point.placed, motion.as_ref().map(|motion| &*motion.0)));
                Portion::More(self.values.len() as f64 / points.len() as f64)
            }
            None => Portion::Done(MeasureValues { measure: *by, values: std::mem::take(&mut self.values) }),
        }
    }
}

/// A point of a Pareto front.
pub(super) struct FrontMachine {
    /// The machine with its counterweights.
    pub placed: PlacedCounterweights,
    /// Σ D_k, kg m².
    pub inertia: f64,
}

/// One line of Eq. (7) or (8), shown as a bar.
pub(super) struct BalanceBars {
    /// Its symbol.
    pub symbol: String,
    /// Meaning of a zero residual.
    pub meaning: &'static str,
    pub unit: &'static str,
    /// Residual along the axes of the links, and across them, in `unit`.
    pub residual: [f64; 2],
    pub is_balanced: bool,
    /// Index of each link, and its contribution along the axes with its payload and discs; the largest comes first.
    /// Negligible contributions are omitted.
    pub parts: Vec<(usize, f64)>,
}

impl BalanceBars {
    /// Returns the larger of the sums of positive and of negative contributions.
    pub fn greatest(&self) -> f64 {
        let sum = |sign: f64| self.parts.iter().map(|(_, part)| (sign * part).max(0.0)).sum::<f64>();
        sum(1.0).max(sum(-1.0))
    }
}

/// Contributions below this fraction of the largest are treated as zero.
const ROUNDING_TOLERANCE: f64 = 1e-9;

impl DesignFacts {
    /// Queries the values of the machine on display, with its Pareto front and those of other machines. While a drag
    /// previews another machine, its balance is shown; the front stays that of the session.
    pub fn weighed(
        queries: &Queries,
        (session, preview): (&Session, Option<&Machine>),
        by: Option<FrontMeasure>,
        others: &[FrontCase],
    ) -> Self {
        let mut facts = Self::of(queries, session, preview);
        facts.other_fronts = (!others.is_empty()).then(|| {
            let machines = others.to_vec();
            let request = FrontsRequest { machines, count: FRONT_POINTS, motion: None, workspace: false };
            queries.ask_in_background::<Fronts>(&request)
        });
        let bare = &queries.ask::<QuickWork<Sums>>(&session.scenario().machine).bare;
        let cut = facts.cut.as_ref().map(|cut| cut.known().map(|found| &**found));
        let Some(request) = front_request(session, bare.as_ref(), cut) else { return facts };
        let front = queries.ask_in_background::<FrontSearch>(&request);
        let points = front.last.map(|front| queries.ask::<QuickWork<FrontPoints>>(&ByIdentity(front)));
        // A run that waits has no motion.
        let motion = session.run().shared_motion().filter(|_| session.run().waiting().is_none());
        facts.front_measure = by.zip(points.clone()).and_then(|(by, points)| {
            let told = queries.ask_in_background::<MeasureQuery>(&(ByIdentity(points.clone()), by, motion)).last?;
            // Values of another front do not apply to this one.
            (told.measure == by && told.values.len() == points.as_deref().map_or(0, <[FrontMachine]>::len))
                .then_some(told)
        });
        facts.front = Some(QueryResult { last: points, state: front.state });
        facts
    }

    /// Queries the values of the machine on display, with its equations.
    pub fn learned(queries: &Queries, session: &Session, preview: Option<&Machine>) -> Self {
        let lesson = MachineEquations::of(queries, session, session.scenario().design.penalties);
        Self { lesson, ..Self::of(queries, session, preview) }
    }

    fn of(queries: &Queries, session: &Session, preview: Option<&Machine>) -> Self {
        let run = session.run();
        let machine = preview.unwrap_or(&session.scenario().machine);
        let asked = |machine: &Machine| queries.ask_in_background::<QuickWork<WorkspaceArea>>(machine).last;
        let workspace = preview.map(|machine| asked(machine).and_then(|area| *area));
        let sums = queries.ask::<QuickWork<Sums>>(machine);
        let cost = |bare: &Machine| {
            queries.ask_in_background::<QuickWork<Cost>>(&(bare.clone(), machine.clone(), run.shared_motion())).last
        };
        let over = |ends| queries.ask_in_background::<QuickWork<OverPayloads>>(&(machine.clone(), ends)).last;
        let layers = queries.ask_in_background::<QuickWork<LayersQuery>>(&layers_request(session, machine));
        Self {
            terms: queries.ask::<QuickWork<Terms>>(machine),
            layers,
            measures: sums.bare.as_ref().and_then(cost),
            payloads: session.scenario().design.payload.and_then(over),
            machine: machine.clone(),
            workspace: workspace.unwrap_or_else(|| run.planes().map(|planes| area_of(planes))),
            is_preview: preview.is_some(),
            sums,
            front: None,
            length_search: queries.newest::<LengthsQuery>(),
            cut: cut_request(session).map(|request| queries.ask_in_background::<QuickWork<CutQuery>>(&request)),
            other_fronts: None,
            front_measure: None,
            lesson: None,
        }
    }

    /// λ of the drives.
    pub(super) fn lambda(&self) -> &[f64] {
        &self.sums.lambda
    }

    /// Returns the total mass of the counterweights, kg, and Σ D_k, kg m².
    pub(super) fn now(&self) -> [f64; 2] {
        self.sums.now
    }

    /// Returns whether the machine is balanced, as are all machines of the front.
    pub(super) fn is_balanced(&self) -> bool {
        self.sums.balanced
    }

    /// Returns the points of the front, by increasing mass; empty before the first front is found.
    pub(super) fn front(&self) -> Result<&[FrontMachine], &CounterweightError> {
        match self.front.as_ref().and_then(|front| front.last.as_deref()) {
            Some(Ok(points)) => Ok(points),
            Some(Err(why)) => Err(why),
            None => Ok(&[]),
        }
    }

    /// Returns the Pareto fronts of other machines, as far as they are known.
    pub(super) fn other_fronts(&self) -> &[MachineFront] {
        self.other_fronts.as_ref().and_then(|beside| beside.last.as_deref()).map_or(&[], Vec::as_slice)
    }

    /// Returns the fraction of the fronts of other machines that is computed, while the work is under way.
    pub(super) fn other_fronts_progress(&self) -> Option<f64> {
        match self.other_fronts.as_ref()?.state {
            QueryStatus::UnderWay(share) => Some(share),
            _ => None,
        }
    }

    /// Returns the fraction of the front of the machine on display that is computed, while the work is under way.
    pub(super) fn front_under_way(&self) -> Option<f64> {
        match self.front.as_ref()?.state {
            QueryStatus::UnderWay(share) => Some(share),
            _ => None,
        }
    }

    /// Returns the counterweights of a point of the front, by the index of the point.
    pub fn weights(&self, i: usize) -> Vec<WeightOption> {
        let point = self.front().ok().and_then(|points| points.get(i));
        let spec = point.map(|point| point.placed.machine.spec());
        let weights = spec.iter().flat_map(|spec| {
            spec.counterweights.iter().filter_map(move |weight| {
                let link = spec.link_index(&weight.link)?;
                Some(weight.outlines(SEGMENTS).into_iter().map(move |outline| WeightOption { link, outline }))
            })
        });
        weights.flatten().collect()
    }
}

/// Returns a machine of the Pareto front for the present machine and brief, by its index.
pub fn of_front(queries: &Queries, session: &Session, i: usize) -> Option<Machine> {
    let sums = queries.ask::<QuickWork<Sums>>(&session.scenario().machine);
    let cut = as_cut(queries, session);
    let request = front_request(session, sums.bare.as_ref(), cut.as_ref().map(|cut| Some(&**cut)))?;
    let front = queries.ask::<FrontSearch>(&request);
    Some(front.as_ref().as_ref().ok()?.points.get(i)?.machine.clone())
}

/// Returns the machine of a session as it is cut, found now if it is not known; `None` if that is not asked for.
pub fn as_cut(queries: &Queries, session: &Session) -> Option<Arc<Result<CutMachine, NoCut>>> {
    Some(queries.ask::<QuickWork<CutQuery>>(&cut_request(session)?))
}

/// Returns the layers of the machine of a session, found now if they are not known.
pub fn layers_of(queries: &Queries, session: &Session) -> Arc<LayersAnswer> {
    queries.ask::<QuickWork<LayersQuery>>(&layers_request(session, &session.scenario().machine))
}

/// Returns the question for the layers of a machine in the task of a session.
fn layers_request(session: &Session, machine: &Machine) -> <LayersQuery as QuickQuery>::Input {
    let run = session.run();
    // A run that waits has no motion.
    let motion = run.shared_motion().filter(|_| run.waiting().is_none());
    (machine.clone(), layers::cut(session), motion)
}

/// Returns the question for the machine as it is cut, if its design asks for it.
fn cut_request(session: &Session) -> Option<<CutQuery as QuickQuery>::Input> {
    let (machine, brief) = (&session.scenario().machine, &session.scenario().design);
    if !brief.as_cut {
        return None;
    }
    let (machine, stock) = brief.stock(machine).ok()?;
    let request = brief_of(session).lightest_problem(&machine);
    Some((machine, request, CutRequest { stock, bought: false }))
}

/// Stops the unfinished queries of the design view.
pub fn leave(queries: &Queries) {
    queries.give_up::<FrontSearch>();
    queries.give_up::<Fronts>();
    queries.give_up::<MeasureQuery>();
}

/// Returns the brief of a session; a machine from a file may have counterweights farther off the axes than it says.
fn brief_of(session: &Session) -> DesignBrief {
    session.scenario().design.fitting(&session.scenario().machine)
}

/// Returns the request for a Pareto front of a machine without counterweights; on the bars of `cut`, if links are cut
/// from bars. `None` if there is no such machine, or its bars are not known yet.
fn front_request(
    session: &Session,
    bare: Option<&Machine>,
    cut: Option<Option<&Result<CutMachine, NoCut>>>,
) -> Option<<FrontSearch as Query>::Input> {
    let (bare, brief) = (bare?, brief_of(session));
    let request = brief.lightest_problem(bare);
    match cut {
        None => Some((bare.clone(), request, FRONT_POINTS)),
        Some(cut) => {
            let cut = cut?.as_ref().ok()?;
            Some((cut.bars.clone(), cut.on_bars(&request), FRONT_POINTS))
        }
    }
}

fn terms(machine: &Machine) -> Vec<BalanceBars> {
    let breakdown = Breakdown::of(machine);
    let term = |term: &stillbase_mechanics::balance::BalanceTerm| {
        let links = (0..machine.links().len()).map(|link| (link, breakdown.of_link(term, link).re));
        let mut parts: Vec<(usize, f64)> = links.collect();
        let most = parts.iter().fold(0.0_f64, |most, (_, part)| most.max(part.abs()));
        parts.retain(|(_, part)| part.abs() > ROUNDING_TOLERANCE * most);
        parts.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
        let (symbol, meaning, unit) = match term.condition {
            Condition::Force(k) => (format!("g{}", subscript(k + 1)), "no force", "kg m"),
            Condition::Coupling(k, l) => (format!("C{}{}", subscript(k + 1), subscript(l + 1)), "no coupling", "kg m²"),
        };
        let residual = [term.residual.re, term.residual.im];
        BalanceBars { symbol, meaning, unit, residual, is_balanced: term.balanced, parts }
    };
    let mut terms: Vec<BalanceBars> = breakdown.terms.iter().map(term).collect();
    // Contributions that are rounding errors in comparison with the other lines are not drawn.
    for unit in ["kg m", "kg m²"] {
        let alike = || terms.iter().filter(|term| term.unit == unit);
        let most = alike().map(BalanceBars::greatest).fold(0.0, f64::max);
        for term in terms.iter_mut().filter(|term| term.unit == unit && term.greatest() < ROUNDING_TOLERANCE * most) {
            term.parts.clear();
        }
    }
    terms
}
