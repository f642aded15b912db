//! [`search`]: optimises the lengths of the links together with the counterweights.
//!
//! For given lengths the counterweights solve a cone program, with a certified minimum. The problem is not convex in
//! the lengths. So the search runs Nelder–Mead from the present lengths and from random ones, and reports how many of
//! these starts ended at the best value. The result is the best machine evaluated, without a proof that it is optimal.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};
use serde::Serialize;
use thiserror::Error;

use stillbase_mechanics::counterweights::{
    CounterweightError, CounterweightSite, CounterweightSpec, Objective, PlacedCounterweights, place_weights,
};
use stillbase_mechanics::machine::{Length, Link, Machine, MachineSpec};
use stillbase_planning::pose_space::plane_area;
use stillbase_query::{Portion, ProgressCallback, Query, Shared};
use stillbase_session::design::DesignBrief;

/// A length to optimise: one under `[lengths]`, which several links may share, or that of one link.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeLength {
    /// Name of the length, or of the link.
    pub name: String,
    /// Lower and upper bound, m.
    pub bounds: [f64; 2],
}

/// Request for a search.
#[derive(Clone, Debug, PartialEq)]
pub struct LengthSearch {
    /// Lengths to optimise. Links keep their mass per metre; com scales with the length, inertia with its cube.
    pub lengths: Vec<FreeLength>,
    /// Sites of the counterweights, and the objective.
    pub spec: CounterweightSpec,
    /// Whether bounds of sites that are at plus or minus the length of a link change with this length.
    pub anywhere: bool,
    /// Lower bound on the reach Σ |L_k|, m.
    pub least_reach: Option<f64>,
    /// Lower bound on the area of the reactionless workspace, m².
    pub least_workspace: Option<f64>,
    /// Number of starting points; the first is the present lengths, moved into their intervals if outside.
    pub starts: usize,
    /// Seed of the other starting points.
    pub seed: u64,
}

/// Result of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundLengths {
    /// The machine with its counterweights, which are certified for these lengths.
    pub placed: PlacedCounterweights,
    /// Lengths in the order of the request, m.
    pub lengths: Vec<f64>,
    /// Number of starts, and number of those that ended within a thousandth of the best.
    pub starts: [usize; 2],
    /// Number of machines evaluated.
    pub machines: usize,
}

/// Progress of a search.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SearchProgress {
    /// Number of finished starts.
    pub starts: usize,
    /// Number of machines evaluated.
    pub machines: usize,
    /// Smallest objective so far; infinite before the first feasible machine.
    pub best: f64,
}

/// Reason that the search found no machine.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum NoLengths {
    /// The machine has no such length.
    #[error("no length {name}: want one of {known}")]
    Unknown {
        /// The name requested.
        name: String,
        /// Names of the machine's lengths.
        known: String,
    },
    /// An invalid interval of a length.
    #[error("length {name} from {from} to {to}: want two lengths above 0 in m, the first below the second")]
    Range {
        /// Name of the length.
        name: String,
        /// Lower bound, m.
        from: f64,
        /// Upper bound, m.
        to: f64,
    },
    /// A length is requested twice.
    #[error("length {0} is sought in two ranges: want one")]
    Twice(String),
    /// No lengths or no starts are requested.
    #[error("{0}")]
    Nothing(&'static str),
    /// No machine evaluated was feasible.
    #[error("none of {machines} machines with lengths in these intervals is feasible: {why}")]
    None {
        /// Number of machines evaluated.
        machines: usize,
        /// Reason that the first start's lengths give no machine, or else the bound violations of the nearest machine.
        why: String,
    },
    /// The lower bound of the reach or of the workspace is out of range.
    #[error(transparent)]
    Weights(#[from] CounterweightError),
}

/// Smallest objective value assigned to an infeasible machine, above that of any feasible one. The value grows with the
/// constraint violation.
const INFEASIBLE: f64 = 1e30;

/// [`search`] as a query that runs in a single call; its progress is the fraction of finished starts.
pub struct LengthsQuery {
    machine: Shared<Machine>,
    search: LengthSearch,
}

impl Query for LengthsQuery {
    type Input = (Shared<Machine>, LengthSearch);
    type Answer = Result<FoundLengths, NoLengths>;

    fn begin((machine, search): Self::Input) -> Self {
        Self { machine, search }
    }

    fn go_on(&mut self, goes_on: ProgressCallback<'_>) -> Portion<Self::Answer> {
        let (starts, mut wanted) = (self.search.starts.max(1) as f64, true);
        let found = search(&self.machine.0, &self.search, &mut |progress| {
            wanted = goes_on(progress.starts as f64 / starts);
            wanted
        });
        if wanted { Portion::Done(found) } else { Portion::Stopped }
    }
}

/// Maximum number of Nelder–Mead iterations of one start, per length.
const ITERATIONS_PER_LENGTH: usize = 70;

/// A start has converged when its simplex is narrower than this fraction of every length's interval.
const CONVERGED_BELOW: f64 = 1e-5;

/// Searches for the lengths with the smallest objective. Calls `go_on` after every machine; once it returns `false`,
/// the best machine so far is the result.
///
/// # Errors
/// Fails if the request is invalid, or no machine evaluated is feasible.
pub fn search(
    machine: &Machine,
    request: &LengthSearch,
    go_on: &mut dyn FnMut(SearchProgress) -> bool,
) -> Result<FoundLengths, NoLengths> {
    check(machine, request)?;
    let mut seen = Seen {
        machine,
        search: request,
        go_on,
        stopped: false,
        machines: 0,
        ended: 0,
        best: None,
        least_violations: [f64::INFINITY; 2],
    };
    let present =
        request.lengths.iter().map(|free| fraction_of_interval(free.bounds, length(machine.spec(), &free.name)));
    let present: Vec<f64> = present.collect();
    let mut draws = ChaCha8Rng::seed_from_u64(request.seed);
    let mut final_values = Vec::new();
    for start in 0..request.starts {
        let drawn = present.iter().map(|_| (draws.next_u64() >> 11) as f64 / (1_u64 << 53) as f64).collect();
        let from = if start == 0 { present.clone() } else { drawn };
        final_values.push(nelder_mead(&mut seen, from));
        seen.ended += 1;
        if seen.stopped {
            break;
        }
    }
    let machines = seen.machines;
    let Some((value, lengths, placed)) = seen.best else {
        let why = match seen.search.at(machine, &present) {
            Err(why) => why,
            Ok(_) => describe_violations(seen.least_violations),
        };
        return Err(NoLengths::None { machines, why });
    };
    let alike = final_values.iter().filter(|end| (**end - value).abs() <= 1e-3 * value.abs()).count();
    Ok(FoundLengths { placed, lengths, starts: [final_values.len(), alike], machines })
}

fn check(machine: &Machine, request: &LengthSearch) -> Result<(), NoLengths> {
    if request.lengths.is_empty() || request.starts == 0 {
        return Err(NoLengths::Nothing("nothing to seek: want at least one length and one start"));
    }
    for (what, least) in [("reach", request.least_reach), ("workspace", request.least_workspace)] {
        if let Some(least) = least.filter(|least| !(least.is_finite() && *least >= 0.0)) {
            return Err(CounterweightError::OutOfRange {
                what: format!("a {what} of at least"),
                value: least,
                want: "a number not below 0".into(),
            }
            .into());
        }
    }
    let known: Vec<&str> = machine.spec().own_lengths().map(|(name, _)| name).collect();
    for (i, FreeLength { name, bounds: [from, to] }) in request.lengths.iter().enumerate() {
        if !known.contains(&name.as_str()) {
            return Err(NoLengths::Unknown { name: name.clone(), known: known.join(", ") });
        }
        if !(*from > 0.0 && from < to && *to < 1e6) {
            return Err(NoLengths::Range { name: name.clone(), from: *from, to: *to });
        }
        if request.lengths[..i].iter().any(|other| other.name == *name) {
            return Err(NoLengths::Twice(name.clone()));
        }
    }
    Ok(())
}

fn has_length(link: &Link, name: &str) -> bool {
    match &link.length {
        Length::Named(shared) => shared == name,
        Length::Metres(_) => link.name == name,
    }
}

fn length(spec: &MachineSpec, name: &str) -> f64 {
    spec.own_lengths().find(|(own, _)| *own == name).map(|(_, length)| length).unwrap_or_default()
}

fn fraction_of_interval([from, to]: [f64; 2], x: f64) -> f64 {
    ((x - from) / (to - from)).clamp(0.0, 1.0)
}

/// Number of starting points unless the request states another.
const DEFAULT_STARTS: usize = 6;

impl LengthSearch {
    /// Builds the search from a brief, for a machine and an objective.
    pub fn of(brief: &DesignBrief, machine: &Machine, objective: Objective) -> Self {
        let lengths = brief.length.iter().map(|(name, ends)| FreeLength { name: name.clone(), bounds: *ends });
        Self {
            lengths: lengths.collect(),
            spec: CounterweightSpec { objective, ..brief.lightest_problem(machine) },
            anywhere: true,
            least_reach: brief.reach,
            least_workspace: brief.workspace,
            starts: DEFAULT_STARTS,
            seed: 1,
        }
    }

    /// Returns the lengths, m, and the machine with these lengths; `shares` gives each as a fraction of its interval.
    /// Links keep their mass per metre.
    fn changed(&self, machine: &Machine, shares: &[f64]) -> Result<(Vec<f64>, Machine), String> {
        let mut spec = machine.spec().clone();
        let mut lengths = Vec::with_capacity(shares.len());
        for (FreeLength { name, bounds: [from, to] }, share) in self.lengths.iter().zip(shares) {
            let (was, now) = (length(&spec, name), from + (to - from) * share);
            let scale = now / was;
            for link in spec.links.iter_mut().filter(|link| has_length(link, name)) {
                link.mass *= scale;
                link.com *= scale;
                link.com_normal *= scale;
                link.scale_inertia(scale.powi(3));
                if let Length::Metres(x) = &mut link.length {
                    *x = now;
                }
            }
            if let Some(x) = spec.lengths.get_mut(name) {
                *x = now;
            }
            lengths.push(now);
        }
        Ok((lengths, Machine::new(spec).map_err(|why| why.to_string())?))
    }

    /// Returns lengths, machine with counterweights, and constraint violations of reach, m, and area, m²; or the reason
    /// that there is no machine.
    fn at(&self, machine: &Machine, shares: &[f64]) -> Result<(Vec<f64>, PlacedCounterweights, [f64; 2]), String> {
        let (lengths, changed) = self.changed(machine, shares)?;
        let mut violations = [(self.least_reach.unwrap_or(0.0) - changed.reach()).max(0.0), 0.0];
        let weighing = match self.anywhere {
            true => CounterweightSpec { sites: stretched(&self.spec.sites, machine, &changed), ..self.spec.clone() },
            false => self.spec.clone(),
        };
        let placed = place_weights(&changed, &weighing).map_err(|why| why.to_string())?;
        if let Some(least) = self.least_workspace {
            let area = plane_area(&placed.machine).unwrap_or(0.0);
            violations[1] = (least - area).max(0.0);
        }
        Ok((lengths, placed, violations))
    }
}

/// Returns the constraint violations of the nearest machine in words.
fn describe_violations([reach, area]: [f64; 2]) -> String {
    let missing = [(reach, "m", "reach"), (area, "m²", "workspace")];
    let missing = missing.iter().filter(|(by, ..)| *by > 0.0).map(|(by, unit, of)| format!("{by:.4} {unit} of {of}"));
    format!("the nearest is {} short", missing.collect::<Vec<_>>().join(" and "))
}

/// Changes bounds of sites that are at plus or minus the length of their link to plus or minus the new length.
pub(crate) fn stretched(sites: &[CounterweightSite], machine: &Machine, changed: &Machine) -> Vec<CounterweightSite> {
    let stretch = |site: &CounterweightSite| {
        let [was, is] = [machine, changed].map(|machine| machine.resolved_links()[site.link].length);
        let end = |at: f64| if at.abs() == was { is.copysign(at) } else { at };
        CounterweightSite { from: end(site.from), to: end(site.to), ..*site }
    };
    sites.iter().map(stretch).collect()
}

/// State of a search.
struct Seen<'a> {
    machine: &'a Machine,
    search: &'a LengthSearch,
    go_on: &'a mut dyn FnMut(SearchProgress) -> bool,
    stopped: bool,
    machines: usize,
    ended: usize,
    best: Option<(f64, Vec<f64>, PlacedCounterweights)>,
    /// Violations of the bounds on reach, m, and on area, m², of the machine with the smallest sum of both.
    least_violations: [f64; 2],
}

impl Seen<'_> {
    fn value(&mut self, shares: &[f64]) -> f64 {
        self.machines += 1;
        let value = match self.search.at(self.machine, shares) {
            Ok((lengths, placed, [0.0, 0.0])) => {
                let value = placed.value;
                if self.best.as_ref().is_none_or(|(best, ..)| value < *best) {
                    self.best = Some((value, lengths, placed));
                }
                value
            }
            Ok((.., violations)) => {
                let all = violations.iter().sum::<f64>();
                if all < self.least_violations.iter().sum::<f64>() {
                    self.least_violations = violations;
                }
                INFEASIBLE * (1.0 + all)
            }
            Err(_) => f64::INFINITY,
        };
        let best = self.best.as_ref().map_or(f64::INFINITY, |(best, ..)| *best);
        self.stopped |= !(self.go_on)(SearchProgress { starts: self.ended, machines: self.machines, best });
        value
    }
}

/// Runs Nelder–Mead within the box of fractions 0 to 1; returns the smallest value it finds.
fn nelder_mead(seen: &mut Seen<'_>, from: Vec<f64>) -> f64 {
    let n = from.len();
    let mut corners: Vec<(f64, Vec<f64>)> = vec![(seen.value(&from), from.clone())];
    for i in 0..n {
        let mut corner = from.clone();
        corner[i] += if corner[i] > 0.5 { -0.25 } else { 0.25 };
        corners.push((seen.value(&corner), corner));
    }
    for _ in 0..ITERATIONS_PER_LENGTH * n {
        corners.sort_by(|a, b| a.0.total_cmp(&b.0));
        let wide = |i: usize| corners.iter().map(|(_, at)| (at[i] - corners[0].1[i]).abs()).fold(0.0, f64::max);
        if seen.stopped || (0..n).all(|i| wide(i) < CONVERGED_BELOW) {
            break;
        }
        let worst = corners[n].clone();
        let centroid: Vec<f64> =
            (0..n).map(|i| corners[..n].iter().map(|(_, at)| at[i]).sum::<f64>() / n as f64).collect();
        // The worst corner, reflected through the centroid of the others at a distance scaled by a factor.
        let reflected = |by: f64| -> Vec<f64> {
            centroid.iter().zip(&worst.1).map(|(m, w)| (m + by * (m - w)).clamp(0.0, 1.0)).collect()
        };
        let over = reflected(1.0);
        let value = seen.value(&over);
        let better = match value {
            _ if value < corners[0].0 => {
                let far = reflected(2.0);
                let further = seen.value(&far);
                Some(if further < value { (further, far) } else { (value, over) })
            }
            _ if value < corners[n - 1].0 || (n == 1 && value < worst.0) => Some((value, over)),
            _ => {
                let near = reflected(if value < worst.0 { 0.5 } else { -0.5 });
                let nearer = seen.value(&near);
                (nearer < worst.0.min(value)).then_some((nearer, near))
            }
        };
        match better {
            Some(corner) => corners[n] = corner,
            None => {
                let best = corners[0].1.clone();
                for (value, at) in &mut corners[1..] {
                    at.iter_mut().zip(&best).for_each(|(x, best)| *x = 0.5 * (*x + best));
                    *value = seen.value(at);
                }
            }
        }
    }
    corners.iter().map(|(value, _)| *value).fold(f64::INFINITY, f64::min)
}
