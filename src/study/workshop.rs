//! [`balance_as_cut`]: counterweights for a machine whose bars are cut as long as these counterweights ask for.
//!
//! A disc behind the root of its link needs a longer bar, and the longer bar needs another disc. So bars of many lengths
//! are tried, and on each the best discs are found that lie on these bars. Those discs are certified; that no other bars
//! do with less is not proved.

use serde::Serialize;
use thiserror::Error;

use stillbase_exchange::cut::Cut;
use stillbase_mechanics::counterweights::{
    CounterweightError, CounterweightSite, CounterweightSpec, CounterweightStock, PlacedCounterweights, place_weights,
};
use stillbase_mechanics::machine::{BarStock, Inertia, Link, LinkNumber, Machine, MachineError, Part};
use stillbase_query::QuickQuery;
use stillbase_session::scenario::DesignBrief;

/// Shares of the greatest tails that are tried first, for all links alike.
const SHARES: [f64; 8] = [1.0, 0.75, 0.55, 0.4, 0.25, 0.12, 0.05, 0.0];
/// Factors by which each tail is then changed by itself, and the number of passes over all.
const FACTORS: [f64; 3] = [0.0, 0.7, 1.3];
const PASSES: usize = 2;
/// Maximum number of rounds until discs beside their bars agree with their arms, and until nothing is left to trim.
const MAX_ROUNDS: usize = 60;
/// Largest residual of (7), kg m, and (8), kg m², at which bars and discs agree.
const RESIDUAL: f64 = 1e-12;
/// Weight of the mass of bars against objectives without mass, 1/kg.
const TIE_BREAK: f64 = 1e-6;
/// Places closer than this are one, m.
const SAME_PLACE: f64 = 1e-9;
/// Steps of radii and places of discs as they are bought and bored, m.
const STEP_M: f64 = 1e-4;

/// A balanced machine as it is cut.
#[derive(Clone, Debug, PartialEq)]
pub struct CutMachine {
    /// The machine, with its parts, and the discs on it.
    pub placed: PlacedCounterweights,
    /// Number of sets of bars that were tried.
    pub tried: usize,
    /// Greatest length by which a bar reaches beyond its pins, m.
    pub tail: f64,
    /// Largest residual of (7), kg m, and of (8), kg m².
    pub residual: [f64; 2],
    /// The machine with its bars alone, without counterweights and arms.
    pub bars: Machine,
    /// Ends of the bar of each link, m from its root.
    pub reach: Vec<[f64; 2]>,
    /// Names of the links whose typed numbers gave way to those of their bars.
    pub replaced_links: Vec<String>,
}

/// Returns the dimensions of bars, pins and discs of a machine: those of its parts, or else those of a design.
pub fn cut_of(design: &DesignBrief, machine: &Machine) -> Cut {
    let stated = Cut {
        bar_width: design.bar_width,
        plate_thickness: design.bar_thickness,
        pin_diameter: design.pin_diameter,
        density: design.density,
        ..Cut::default()
    };
    stated.fitting(machine)
}

/// Returns the names of the links whose typed numbers give way to those of the bars that are cut for them: links that
/// have no parts, or only such bars.
pub fn replaced_links(machine: &Machine) -> Vec<String> {
    let keeps_parts = |link: &Link| machine.spec().parts.iter().any(|part| part.link == link.name && !part.is_cut());
    let is_typed = |link: &Link| LinkNumber::ALL.iter().any(|number| !link.follows(*number));
    let replaced = machine.spec().links.iter().filter(|link| !keeps_parts(link) && is_typed(link));
    replaced.map(|link| link.name.clone()).collect()
}

/// Reason that no machine can be cut so that it is balanced.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum NoCut {
    /// The stock does not fit the machine.
    #[error("bars cannot be cut: {0}")]
    Bars(#[from] MachineError),
    /// No discs balance the machine.
    #[error(transparent)]
    Weights(#[from] CounterweightError),
    /// Arms and discs do not agree.
    #[error(
        "after {MAX_ROUNDS} rounds, the arms are still {residual:.1e} kg m off the discs that they carry: want lighter \
         bars, or a smaller distance of counterweights from the axes"
    )]
    Unsettled {
        /// The residual of (7), kg m.
        residual: f64,
    },
}

/// Bars of which links are cut, and whether discs are taken as they are bought.
#[derive(Clone, Debug, PartialEq)]
pub struct CutRequest {
    /// The bars.
    pub stock: BarStock,
    /// Whether radii and places of discs are rounded to 0.1 mm, which leaves a residual.
    pub bought: bool,
}

/// What is told of a machine that is balanced as it is cut.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BarsReport {
    /// Mass of all parts and lumps, kg.
    pub mass: f64,
    /// Greatest length by which a bar reaches beyond its pins, m.
    pub tail: f64,
    /// Number of sets of bars that were tried.
    pub tried: usize,
    /// Largest residual of (7), kg m.
    pub force_residual: f64,
    /// Largest residual of (8), kg m².
    pub coupling_residual: f64,
    /// Names of the links whose typed mass, centre of mass and inertia gave way to those of their bars.
    pub replaced_links: Vec<String>,
}

impl BarsReport {
    /// Reports on a machine.
    pub fn of(cut: &CutMachine) -> Self {
        let [force_residual, coupling_residual] = cut.residual;
        let mass = cut.placed.machine.part_bodies().iter().map(|part| part.body.mass).sum();
        let replaced_links = cut.replaced_links.clone();
        Self { mass, tail: cut.tail, tried: cut.tried, force_residual, coupling_residual, replaced_links }
    }

    /// Says which typed numbers gave way to those of bars; `None` if none did.
    pub fn replaced(&self) -> Option<String> {
        let links = match self.replaced_links.as_slice() {
            [] => return None,
            [one] => format!("link {one}"),
            [first @ .., last] => format!("links {} and {last}", first.join(", ")),
        };
        let bars = if self.replaced_links.len() == 1 { "its bar" } else { "their bars" };
        Some(format!("Mass, centre of mass and inertia typed for {links} are replaced by those of {bars}."))
    }
}

impl CutRequest {
    /// Balances a machine as it is cut, as [`balance_as_cut`], with discs as they are bought if this is asked for.
    ///
    /// # Errors
    /// As [`balance_as_cut`].
    pub fn balance(&self, machine: &Machine, request: &CounterweightSpec) -> Result<CutMachine, NoCut> {
        let exact = balance_as_cut(machine, request, &self.stock)?;
        if self.bought { Ok(as_bought(&exact, &request.stock, &self.stock)?) } else { Ok(exact) }
    }
}

/// Query for the machine that is balanced as it is cut, with discs of the given request.
pub struct CutQuery;

impl QuickQuery for CutQuery {
    type Input = (Machine, CounterweightSpec, CutRequest);
    type Answer = Result<CutMachine, NoCut>;

    fn answer((machine, request, cut): &Self::Input) -> Self::Answer {
        cut.balance(machine, request)
    }
}

/// Balances a machine whose links are bars of a stock, with the tails, arms and holes that they are cut with.
/// Counterweights of the machine are removed first, except fixed ones. Every disc lies on its bar, and no bar is longer
/// than its pins and its disc ask for, unless nothing shorter was found that balances the machine.
///
/// # Errors
/// If the stock does not fit the machine, or if no counterweights within the bounds of the request balance it.
pub fn balance_as_cut(machine: &Machine, request: &CounterweightSpec, stock: &BarStock) -> Result<CutMachine, NoCut> {
    let bare = machine.without_counterweights()?;
    let mut search = TailSearch { bare: &bare, request, stock, tried: 0 };
    // If nothing does, the longest bars say why.
    let first = search.reach(SHARES[0]);
    let mut found = search.attempt(&first);
    for share in &SHARES[1..] {
        let reach = search.reach(*share);
        match (&found, search.attempt(&reach)) {
            (Ok(best), Ok(other)) if other.value >= best.value => {}
            (_, Ok(other)) => found = Ok(other),
            (_, Err(_)) => {}
        }
    }
    let mut best = found?;
    for factor in FACTORS.iter().cycle().take(PASSES * FACTORS.len()) {
        for i in 0..request.sites.len() {
            let reach = search.stretched(&best.reach, i, *factor);
            search.improve(&mut best, &reach);
        }
    }
    search.trim(&mut best);
    let machine = &best.placed.machine;
    let (residual, tail) = (residual(machine), longest_tail(machine));
    let (replaced_links, bars) = (replaced_links(&bare), bare.with_bars(stock, &best.reach)?);
    Ok(CutMachine { placed: best.placed, tried: search.tried, tail, residual, bars, reach: best.reach, replaced_links })
}

impl CutMachine {
    /// Returns the request for other counterweights on the same bars: their places are those of `request` that lie on
    /// the bar of their link, so that none needs an arm.
    pub fn on_bars(&self, request: &CounterweightSpec) -> CounterweightSpec {
        let mut request = request.clone();
        on_reach(&mut request.sites, &self.reach);
        for site in &mut request.sites {
            let spine = self.bars.spine(site.link).map(|i| &self.bars.spec().parts[i]);
            let breadth = spine.and_then(Part::breadth).unwrap_or_default();
            site.across = site.across.min(0.5 * breadth);
        }
        request
    }
}

/// Limits the places of counterweights to the bars of their links with these ends, m.
fn on_reach(sites: &mut Vec<CounterweightSite>, reach: &[[f64; 2]]) {
    sites.retain_mut(|site| {
        // A site on a link that does not exist is refused later.
        let Some([from, to]) = reach.get(site.link) else { return true };
        (site.from, site.to) = (site.from.max(*from), site.to.min(*to));
        site.from <= site.to
    });
}

/// Discs on bars of known lengths.
#[derive(Clone)]
struct Attempt {
    /// Ends of the bar of each link, m from its root.
    reach: Vec<[f64; 2]>,
    placed: PlacedCounterweights,
    /// Value of the objective, with the mass of the bars.
    value: f64,
}

/// A search for the lengths of bars.
struct TailSearch<'a> {
    bare: &'a Machine,
    request: &'a CounterweightSpec,
    stock: &'a BarStock,
    tried: usize,
}

impl TailSearch<'_> {
    /// Returns the ends of all bars if each takes a share of the length that the bounds allow beyond its pins.
    fn reach(&self, share: f64) -> Vec<[f64; 2]> {
        let mut reach: Vec<[f64; 2]> = (0..self.bare.links().len()).map(|link| self.bare.least_extent(link)).collect();
        for site in &self.request.sites {
            let Some([from, to]) = reach.get_mut(site.link) else { continue };
            *from += share * (site.from - *from).min(0.0);
            *to += share * (site.to - *to).max(0.0);
        }
        reach
    }

    /// Returns the ends of all bars, with the tail at one site longer by a factor; 0 leaves none.
    fn stretched(&self, reach: &[[f64; 2]], i: usize, factor: f64) -> Vec<[f64; 2]> {
        let site = &self.request.sites[i];
        let [from, to] = self.bare.least_extent(site.link);
        let [low, high] = reach[site.link];
        let mut reach = reach.to_vec();
        reach[site.link] =
            [(from + factor * (low - from)).max(site.from.min(from)), (to + factor * (high - to)).min(site.to.max(to))];
        reach
    }

    /// Places discs on bars with these ends.
    fn attempt(&mut self, reach: &[[f64; 2]]) -> Result<Attempt, NoCut> {
        self.tried += 1;
        let placed = self.placed(reach)?;
        let bars: f64 = placed.machine.part_bodies().iter().map(|part| part.body.mass).sum();
        // Mass breaks ties between bars that any other objective does not tell apart.
        let value = placed.value + self.request.objective.mass.max(TIE_BREAK) * bars;
        Ok(Attempt { reach: reach.to_vec(), placed, value })
    }

    /// Takes bars with these ends if they are better; returns whether they are.
    fn improve(&mut self, best: &mut Attempt, reach: &[[f64; 2]]) -> bool {
        let found = if reach == best.reach { None } else { self.attempt(reach).ok() };
        match found.filter(|found| found.value < best.value) {
            Some(found) => {
                *best = found;
                true
            }
            None => false,
        }
    }

    /// Places discs on bars with these ends; the arms of discs beside their bars are weighed.
    fn placed(&self, reach: &[[f64; 2]]) -> Result<PlacedCounterweights, NoCut> {
        let mut request = self.request.clone();
        on_reach(&mut request.sites, reach);
        let mut bars = self.bare.with_bars(self.stock, reach)?;
        let mut off = f64::INFINITY;
        for _ in 0..MAX_ROUNDS {
            let placed = place_weights(&bars, &request)?;
            let cut = with_arms(&placed.machine, self.stock, reach)?;
            let [force, coupling] = residual(&cut);
            if force.max(coupling) <= RESIDUAL {
                return Ok(PlacedCounterweights { machine: cut, ..placed });
            }
            (bars, off) = (cut, force);
        }
        Err(NoCut::Unsettled { residual: off })
    }

    /// Cuts off what reaches beyond pins and discs, as long as discs on the shorter bars are better.
    fn trim(&mut self, best: &mut Attempt) {
        for _ in 0..MAX_ROUNDS {
            let needed = |(link, reach): (usize, &[f64; 2])| {
                let [from, to] = best.placed.machine.extent_with(link, |_| true);
                [from.max(reach[0]), to.min(reach[1])]
            };
            let shorter: Vec<[f64; 2]> = best.reach.iter().enumerate().map(needed).collect();
            let cut_off = |(was, is): (&[f64; 2], &[f64; 2])| (is[0] - was[0]).max(was[1] - is[1]);
            let most = best.reach.iter().zip(&shorter).map(cut_off).fold(0.0, f64::max);
            if most <= SAME_PLACE || !self.improve(best, &shorter) {
                return;
            }
        }
    }
}

/// Returns the largest residual of (7), kg m, and of (8), kg m².
pub fn residual(machine: &Machine) -> [f64; 2] {
    let inertia = Inertia::of(machine);
    [inertia.force_residual(), inertia.invariance_residual()]
}

/// Returns a machine with arms for the discs beside its bars, which reach over `reach`, m, the feet of their arms, and the
/// walls of half rings.
fn with_arms(machine: &Machine, stock: &BarStock, reach: &[[f64; 2]]) -> Result<Machine, MachineError> {
    let armed = machine.with_bars(stock, reach)?.with_arms(stock)?;
    let mut feet = reach.to_vec();
    for weight in &machine.spec().counterweights {
        let Some(link) = machine.spec().link_index(&weight.link) else { continue };
        let at = weight.carried_at();
        // A bar that reaches its centre of mass goes on to its wall.
        if at != weight.at {
            feet[link] = [feet[link][0].min(at), feet[link][1].max(at)];
        }
    }
    for arm in armed.spec().parts.iter().filter(|part| part.is_arm()) {
        let Some(link) = armed.spec().link_index(&arm.link) else { continue };
        for [at, _] in &arm.polygon {
            feet[link] = [feet[link][0].min(*at), feet[link][1].max(*at)];
        }
    }
    if feet == reach { Ok(armed) } else { machine.with_bars(stock, &feet)?.with_arms(stock) }
}

/// Returns the greatest length by which a bar reaches beyond root, tip and pins of its link, m.
fn longest_tail(machine: &Machine) -> f64 {
    let beyond = (0..machine.links().len()).filter_map(|j| {
        let [low, high] = machine.part_ends(machine.spine(j)?)?;
        let [first, last] = machine.extent_with(j, |_| false);
        Some((first - low).max(high - last))
    });
    beyond.fold(0.0, f64::max)
}

/// Returns the machine with counterweights as they are bought: radii, lengths and places in steps of 0.1 mm, and the
/// masses that follow from their plate. Its bars are cut for these; what is left of (7) and (8) is its residual.
///
/// # Errors
/// If the machine is not valid.
pub fn as_bought(
    machine: &CutMachine,
    plate: &CounterweightStock,
    stock: &BarStock,
) -> Result<CutMachine, MachineError> {
    let mut spec = machine.placed.machine.spec().clone();
    let round = |x: f64| (x / STEP_M).round() * STEP_M;
    for weight in spec.counterweights.iter_mut().filter(|weight| !weight.fixed) {
        let (circle, outward) = (round(weight.circle_at()), weight.outward());
        let shape = plate.shape(weight.mass).rounded(STEP_M);
        (weight.at, weight.across) = (circle + outward * shape.from_circle(), round(weight.across));
        weight.mass = plate.mass(shape);
        weight.set_shape(shape);
    }
    let rounded = Machine::new(spec)?;
    let reach: Vec<[f64; 2]> = (0..rounded.links().len()).map(|link| rounded.extent_with(link, |_| true)).collect();
    let cut = with_arms(&rounded, stock, &reach)?;
    let (residual, tail) = (residual(&cut), longest_tail(&cut));
    let added_mass = cut.spec().counterweights.iter().filter(|weight| !weight.fixed).map(|weight| weight.mass).sum();
    let placed = PlacedCounterweights { machine: cut, added_mass, ..machine.placed.clone() };
    Ok(CutMachine { placed, residual, tail, ..machine.clone() })
}
