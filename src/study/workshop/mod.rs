//! [`balance_as_cut`]: counterweights for a machine whose bars are cut as long as these counterweights ask for.
//!
//! A disc behind the root of its link needs a longer bar, and the longer bar needs another disc. So bars of many lengths
//! are tried, and on each the best discs are found that lie on these bars. Those discs are certified; that no other bars
//! do with less is not proved.

mod bought;
mod tails;

use std::fmt;

use schemars::JsonSchema;
use serde::Serialize;
use thiserror::Error;

use stillbase_exchange::cut::Cut;
use stillbase_mechanics::balance::Condition;
use stillbase_mechanics::counterweights::{
    CounterweightError, CounterweightSite, CounterweightSpec, PlacedCounterweights,
};
use stillbase_mechanics::machine::{BarStock, Inertia, Link, LinkNumber, Machine, MachineError, Part};
use stillbase_query::QuickQuery;
use stillbase_session::scenario::DesignBrief;

use tails::{MAX_ROUNDS, TailSearch};

pub use bought::{Rounding, as_bought, rounded};

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
    /// What rounding changed, if discs are as they are bought.
    pub rounding: Option<Rounding>,
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
    /// No discs balance the machine, on whatever bars.
    #[error(transparent)]
    Weights(#[from] CounterweightError),
    /// On none of the bars that were tried do discs within the bounds balance the machine.
    #[error("on none of {tried} cuts of its bars: {why}")]
    Bounds {
        /// Number of sets of bars that were tried.
        tried: usize,
        /// The bounds in conflict on the bars that come nearest to them, and bounds that would do on some bars.
        #[source]
        why: CounterweightError,
    },
    /// Arms and discs do not agree.
    #[error("{0}")]
    Unsettled(Unsettled),
}

/// What arms and discs still change in the last round.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unsettled {
    /// The condition of (7) or (8) that changes most, compared with its tolerance.
    pub condition: Condition,
    /// Its change, kg m or kg m².
    pub change: f64,
    /// Number of drives of the machine.
    pub drives: usize,
}

impl fmt::Display for Unsettled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { condition, change, drives } = self;
        let equation = if matches!(condition, Condition::Force(_)) { "(7)" } else { "(8)" };
        write!(
            f,
            "after {MAX_ROUNDS} rounds, new arms for the discs still change {} of {equation} by {change:.1e} {}: want \
             lighter bars, or a smaller distance of counterweights from the axes",
            condition.symbol(*drives),
            condition.unit()
        )
    }
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
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
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
    /// Value of the objective before discs were rounded as they are bought, certified for these bars.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exact_value: Option<f64>,
    /// Bounds that the rounded discs break, in words.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub broken_bounds: Vec<String>,
}

impl BarsReport {
    /// Reports on a machine.
    pub fn of(cut: &CutMachine) -> Self {
        let [force_residual, coupling_residual] = cut.residual;
        let mass = cut.placed.machine.part_bodies().iter().map(|part| part.body.mass).sum();
        let broken = cut.rounding.iter().flat_map(|rounding| &rounding.broken);
        Self {
            mass,
            tail: cut.tail,
            tried: cut.tried,
            force_residual,
            coupling_residual,
            replaced_links: cut.replaced_links.clone(),
            exact_value: cut.rounding.as_ref().map(|rounding| rounding.exact_value),
            broken_bounds: broken.map(ToString::to_string).collect(),
        }
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
        if self.bought { Ok(as_bought(&exact, request, &self.stock)?) } else { Ok(exact) }
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
    let mut search = TailSearch::new(&bare, request, stock);
    let best = search.best()?;
    let machine = &best.placed.machine;
    let (residual, tail) = (residual(machine), longest_tail(machine));
    let (replaced_links, bars) = (replaced_links(&bare), bare.with_bars(stock, &best.reach)?);
    Ok(CutMachine {
        placed: best.placed,
        tried: search.tried,
        tail,
        residual,
        bars,
        reach: best.reach,
        replaced_links,
        rounding: None,
    })
}

impl CutMachine {
    /// Returns a machine on these bars as it is built: its discs as they are bought, if those of this machine are.
    ///
    /// # Errors
    /// If the machine is not valid.
    pub fn as_built(
        &self,
        placed: PlacedCounterweights,
        request: &CounterweightSpec,
        stock: &BarStock,
    ) -> Result<PlacedCounterweights, MachineError> {
        match self.rounding {
            Some(_) => rounded(&placed, request, stock, &self.reach),
            None => Ok(placed),
        }
    }

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

/// Returns the largest residual of (7), kg m, and of (8), kg m².
pub fn residual(machine: &Machine) -> [f64; 2] {
    let inertia = Inertia::of(machine);
    [inertia.force_residual(), inertia.invariance_residual()]
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
