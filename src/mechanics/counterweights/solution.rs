//! Evaluates a solution of the cone program: its objective, and the blocks with counterweights and rotors.

use super::cell::DiscPlace;
use super::problem::CounterweightProblem;
use super::refusal::CounterweightError;
use super::residual::ConditionResidual;
use super::search_node::{BalanceGoal, SearchNode};
use super::spec::{CounterweightSite, CounterweightSpec, RotorFreedom};
use super::unknowns::{AffineForm, UnknownIndices};
use crate::assembly::Assembly;
use crate::balance::{LinearEquation, SolutionSpace};
use crate::machine::{Counterweight, Machine, MachineError, Rotor};

/// Mass w and first moments s = w x and t = w y, in the units of the machine, of each counterweight, with its site.
type Found = Vec<(CounterweightSite, [f64; 3])>;

/// Smallest mass of a counterweight, in the unit of mass; lighter ones are omitted.
pub(super) const MIN_MASS: f64 = 1e-7;

/// Smallest |gear ratio|: a ratio of zero is not valid.
const MIN_RATIO: f64 = 1e-9;

impl CounterweightProblem {
    /// Returns a solution with every inertia, momentum and torque at its exact value instead of a bound.
    pub fn with_exact_values(&self, request: &CounterweightSpec, x: &[f64]) -> Vec<f64> {
        let unknowns = UnknownIndices::of(request, self.drives());
        let mut x = x.to_vec();
        for (i, rotor) in request.rotors.iter().enumerate() {
            let inertia = self.rotor_inertia(rotor.drive) * self.ratio_units[i].powi(2);
            x[unknowns.turned(i)] = match rotor.parameter {
                RotorFreedom::Inertia(_) => 0.0,
                RotorFreedom::Ratio(_) => inertia * x[unknowns.rotor(i)].powi(2),
            };
        }
        if !unknowns.inertia {
            return x;
        }
        let places = (0..request.sites.len()).map(|j| self.disc(request, &x, j, 0.0).unwrap_or_default());
        let places: Vec<DiscPlace> = places.collect();
        for (j, DiscPlace { mass, at, across }) in places.iter().enumerate() {
            x[unknowns.u(j)] = mass * (at * at + across * across);
            x[unknowns.v(j)] = request.stock.own(*mass);
        }
        let of = |sum: &AffineForm, x: &[f64]| sum.constant + sum.terms.iter().map(|(i, by)| by * x[*i]).sum::<f64>();
        let mut torque = 0.0_f64;
        for k in 0..self.drives() {
            let h = of(&self.linear_diagonal(request, &unknowns, k, &places), &x);
            x[unknowns.h(k)] = h;
            let [momentum, turned] = self.of_rotors(request, k);
            let (momentum, turned) = (h + self.constant(k) + of(&momentum, &x), h + of(&turned, &x));
            if unknowns.momentum {
                x[unknowns.momentum(k)] = momentum.abs();
            }
            torque = torque.max(request.objective.accelerations.get(k).copied().unwrap_or_default() * turned);
        }
        if request.objective.torque > 0.0 {
            x[unknowns.torque()] = torque;
        }
        x
    }

    /// Returns the value of the objective.
    pub fn value(&self, request: &CounterweightSpec, x: &[f64]) -> f64 {
        let costs = self.program(request, &[], &SearchNode::unconstrained(request, BalanceGoal::Exact)).linear;
        costs.iter().zip(x).map(|(cost, x)| cost * x).sum()
    }

    /// Returns the excess of u and v over the exact inertias at each site.
    pub fn excess(&self, request: &CounterweightSpec, x: &[f64]) -> Vec<[f64; 2]> {
        let (unknowns, settled) = (UnknownIndices::of(request, self.drives()), self.with_exact_values(request, x));
        let excess = |i: usize| x[i] - settled[i];
        (0..request.sites.len()).map(|j| [excess(unknowns.u(j)), excess(unknowns.v(j))]).collect()
    }

    /// Returns the mass w and the first moments s and t at site j.
    fn moments(&self, request: &CounterweightSpec, x: &[f64], j: usize) -> [f64; 3] {
        let unknowns = UnknownIndices::of(request, self.drives());
        [x[unknowns.w(j)], x[unknowns.s(j)], unknowns.t(j).map_or(0.0, |t| x[t])]
    }

    /// Returns the disc at site j; `None` if its mass is at most `min_mass`.
    pub fn disc(&self, request: &CounterweightSpec, x: &[f64], j: usize, min_mass: f64) -> Option<DiscPlace> {
        let [w, s, t] = self.moments(request, x, j);
        (w > min_mass).then(|| DiscPlace { mass: w, at: s / w, across: t / w })
    }

    /// Returns the added mass, kg, and the blocks with the counterweights and rotors of a solution. With exact balance
    /// they are balanced to rounding. `asked` is the request in SI units, and `request` in those of the problem.
    ///
    /// # Errors
    /// If a machine is not valid.
    pub fn machine(
        &self,
        asked: &CounterweightSpec,
        request: &CounterweightSpec,
        x: &[f64],
        balance: BalanceGoal,
    ) -> Result<(f64, Assembly), CounterweightError> {
        let sites = request.sites.iter().enumerate();
        let all = sites.map(|(j, site)| {
            let [w, s, t] = self.moments(request, x, j);
            (*site, [w, s, if site.across > 0.0 { t } else { 0.0 }])
        });
        let mut found: Found = all.filter(|(_, [w, ..])| *w > MIN_MASS).collect();
        // The residual from the solver's rounding and from omitted counterweights is removed by the least change of the
        // others.
        for _ in 0..if balance == BalanceGoal::Exact { 3 } else { 0 } {
            self.refine(request, &mut found);
        }
        let whole = self.bare.clone().with_machines(|name, machine| self.loaded(name, &machine, asked, x, &found))?;
        let added: f64 = found.iter().map(|(_, [w, ..])| w).sum();
        Ok((self.units.mass * added, whole))
    }

    /// Returns the machine of a block with the counterweights and rotors of a solution.
    fn loaded(
        &self,
        name: &str,
        bare: &Machine,
        asked: &CounterweightSpec,
        x: &[f64],
        found: &Found,
    ) -> Result<Machine, MachineError> {
        let (unknowns, mut spec) = (UnknownIndices::of(asked, self.drives()), bare.spec().clone());
        let is_own = |block: usize| self.bare.blocks()[block].name == name;
        for (site, [w, s, t]) in found {
            let Some((_, link)) = self.bare.link_at(site.link).filter(|(block, _)| is_own(*block)) else { continue };
            let (link, mass) = (bare.links()[link].name.clone(), self.units.mass * w);
            let place = [s, t].map(|moment| moment / w * self.units.length);
            spec.counterweights.push(Counterweight::new(link, mass, place, asked.stock.shape(mass)));
        }
        for (i, rotor) in asked.rotors.iter().enumerate() {
            let (block, drive) = self.drive_at(rotor.drive);
            if !is_own(block) {
                continue;
            }
            let (present, value) = (self.rotors[rotor.drive], x[unknowns.rotor(i)]);
            let found = match rotor.parameter {
                RotorFreedom::Inertia([low, high]) => {
                    Rotor { inertia: (value * self.units.inertia()).clamp(low, high), ..present }
                }
                RotorFreedom::Ratio([low, high]) => {
                    let ratio = (value * self.ratio_units[i]).clamp(low, high);
                    Rotor { ratio: other_than_zero(ratio), ..present }
                }
            };
            spec.drives[drive].rotor = (found.inertia > 0.0).then_some(found);
        }
        Machine::new(spec)
    }

    /// Removes the residual of the conditions by the least change of the counterweights.
    fn refine(&self, request: &CounterweightSpec, found: &mut Found) {
        // A solution without counterweights needs no change: the links balance each other.
        if found.is_empty() {
            return;
        }
        let place = |site: &CounterweightSite| {
            request.sites.iter().position(|other| other.link == site.link).unwrap_or_default()
        };
        let sites: Vec<usize> = found.iter().map(|(site, _)| place(site)).collect();
        // The real parts depend on w and s, the imaginary parts on t alone.
        for moments in [0..2, 2..3] {
            let is_real = moments.start == 0;
            let residual = |condition: &ConditionResidual| {
                let changed = sites
                    .iter()
                    .zip(found.iter())
                    .map(|(j, (_, of))| moments.clone().map(|i| condition.changes[*j][i] * of[i]).sum::<f64>());
                let bare = if is_real { condition.residual.re } else { condition.residual.im };
                bare + changed.sum::<f64>()
            };
            // Changes are measured relative to each mass, so that light counterweights keep their positions.
            let equation = |condition: &ConditionResidual| {
                let each = sites.iter().zip(found.iter());
                let a = each.flat_map(|(j, (_, of))| moments.clone().map(|i| condition.changes[*j][i] * of[0]));
                LinearEquation { a: a.collect(), right: residual(condition), tolerance: f64::INFINITY }
            };
            let equations: Vec<LinearEquation> = self.conditions.iter().map(equation).collect();
            let n = moments.len();
            let change = SolutionSpace::of(&equations, n * sites.len()).particular;
            for (j, (_, of)) in found.iter_mut().enumerate() {
                let by = of[0];
                moments.clone().enumerate().for_each(|(i, of_i)| of[of_i] -= by * change[n * j + i]);
            }
        }
    }
}

/// Returns a gear ratio of at least [`MIN_RATIO`] in magnitude, with the same sign.
fn other_than_zero(ratio: f64) -> f64 {
    if ratio.abs() < MIN_RATIO { MIN_RATIO.copysign(ratio) } else { ratio }
}
