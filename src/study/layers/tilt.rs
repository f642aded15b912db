//! [`TiltMeasure`]: how much the order of the links tilts the base, as a function of their layers, and the search for
//! the order that tilts it least.
//!
//! The tilting moment is linear in the heights. Along a task it is n_t(t) = i Σ_j m_j h_j (g − r̈_j), and the largest
//! |n_t| counts. Without a task, Σ_k |s_k − z̄ g_k| counts, the first moments weighted by height about that of the
//! centre of mass (see [`AxialMoments`]).

use stillbase_mechanics::dynamics::ExternalLoads;
use stillbase_mechanics::joint_forces::AxialMoments;
use stillbase_mechanics::machine::Machine;
use stillbase_mechanics::planar::{MAX_DRIVES, Vector};

use super::stack::Visitor;
use super::way::TaskPoses;

/// Number of instants of a task at which a partial order is assessed.
const BOUND_SAMPLES: usize = 24;
/// A tilt must be smaller by this fraction to count as smaller.
const ROUNDING: f64 = 1e-12;

/// A measure of tilt that is linear in layers before magnitudes are taken.
#[derive(Clone, Debug)]
pub struct TiltMeasure {
    /// Coefficients of the layers, by component and link.
    terms: Vec<Vec<Vector>>,
    /// Part that no layer changes, by component.
    fixed: Vec<Vector>,
    /// Whether the sum over the components counts; else the largest.
    adds: bool,
}

impl TiltMeasure {
    /// Returns the measure of a machine, along a task if there is one. `pitch` is the height of a layer, m.
    pub fn of(machine: &Machine, task: Option<&TaskPoses>, pitch: f64) -> Self {
        let spec = machine.spec();
        let (end, payload) = (machine.end_link(), spec.payload);
        // The payload moves up with the link that holds it.
        let offset = payload.axial - machine.links()[end].axial;
        let links = machine.links().iter().enumerate().map(|(j, link)| (j, link.mass, machine.com_chain(j)));
        let bodies: Vec<(usize, f64, [Vector; MAX_DRIVES])> =
            links.chain([(end, payload.mass, machine.payload_chain())]).collect();
        let mut measure = Self { terms: Vec::new(), fixed: Vec::new(), adds: task.is_none() };
        let count = machine.links().len();
        let mut component = |pull: &dyn Fn(&[Vector; MAX_DRIVES]) -> Vector| {
            let mut terms = vec![Vector::default(); count];
            for (j, mass, chain) in &bodies {
                terms[*j] += pull(chain) * (mass * pitch);
            }
            measure.terms.push(terms);
            measure.fixed.push(pull(&machine.payload_chain()) * (payload.mass * offset));
        };
        match task {
            None => {
                let mass = machine.mass();
                for k in 0..machine.drives() {
                    let mean: Vector = bodies.iter().map(|(_, m, chain)| chain[k] * (*m / mass)).sum();
                    component(&|chain| chain[k] - mean);
                }
            }
            Some(task) => {
                for pose in task.poses() {
                    let turned = |k: usize| Vector::new(-pose.qd[k] * pose.qd[k], pose.qdd[k]) * pose.e[k];
                    component(&|chain| {
                        let acceleration: Vector = (0..machine.drives()).map(|k| chain[k] * turned(k)).sum();
                        Vector::new(0.0, 1.0) * (machine.gravity() - acceleration)
                    });
                }
            }
        }
        measure
    }

    /// Returns the measure at a subset of the instants, for bounds; a measure without a task has few components.
    fn thinned(&self) -> Self {
        if self.adds {
            return self.clone();
        }
        let every = (self.terms.len() / BOUND_SAMPLES).max(1);
        let terms = self.terms.iter().step_by(every).cloned().collect();
        Self { terms, fixed: self.fixed.iter().step_by(every).copied().collect(), adds: false }
    }

    fn gathered(&self, each: impl Iterator<Item = f64>) -> f64 {
        if self.adds { each.sum() } else { each.fold(0.0, f64::max) }
    }

    /// Returns the measure of an order.
    pub fn value(&self, layers: &[usize]) -> f64 {
        let moment = |(terms, fixed): (&Vec<Vector>, &Vector)| {
            let sum: Vector = terms.iter().zip(layers).map(|(term, layer)| term * (*layer as f64)).sum();
            (sum + fixed).norm()
        };
        self.gathered(self.terms.iter().zip(&self.fixed).map(moment))
    }

    /// Returns a lower bound of the measure over orders whose layers lie in sets.
    fn bound(&self, sets: &[u128]) -> f64 {
        let ends = |set: &u128| [f64::from(set.trailing_zeros()), f64::from(127 - set.leading_zeros())];
        let ends: Vec<[f64; 2]> = sets.iter().map(ends).collect();
        let moment = |(terms, fixed): (&Vec<Vector>, &Vector)| {
            let least = |part: fn(&Vector) -> f64| {
                let (mut low, mut high) = (part(fixed), part(fixed));
                for (term, [bottom, top]) in terms.iter().zip(&ends) {
                    let own = part(term);
                    low += (own * bottom).min(own * top);
                    high += (own * bottom).max(own * top);
                }
                low.max(-high).max(0.0)
            };
            least(|v| v.re).hypot(least(|v| v.im))
        };
        self.gathered(self.terms.iter().zip(&self.fixed).map(moment))
    }
}

/// Visitor that keeps the order with the least tilt.
pub struct LeastTilt {
    measure: TiltMeasure,
    thinned: TiltMeasure,
    /// The best order and its measure.
    pub best: (Vec<usize>, f64),
}

impl LeastTilt {
    /// Returns a visitor that begins with an order.
    pub fn from(measure: TiltMeasure, layers: Vec<usize>) -> Self {
        let value = measure.value(&layers);
        Self { thinned: measure.thinned(), measure, best: (layers, value) }
    }

    fn is_less(&self, value: f64) -> bool {
        value < self.best.1 * (1.0 - ROUNDING)
    }
}

impl Visitor for LeastTilt {
    fn is_worth(&mut self, sets: &[u128]) -> bool {
        self.is_less(self.thinned.bound(sets))
    }

    fn visit(&mut self, layers: &[usize]) -> bool {
        let value = self.measure.value(layers);
        if self.is_less(value) {
            self.best = (layers.to_vec(), value);
        }
        true
    }
}

/// Returns the largest tilting moment of a machine along a task, N m.
pub fn largest_tilt(machine: &Machine, task: &TaskPoses) -> f64 {
    let axial = AxialMoments::of(machine);
    let around = ExternalLoads { gravity: machine.gravity(), force: Vector::default() };
    let tilt = |pose: &super::way::TaskPose| axial.tilt(&pose.e, &pose.qd, &pose.qdd, &around).total().norm();
    task.poses().iter().map(tilt).fold(0.0, f64::max)
}

/// Returns Σ_k |s_k − z̄ g_k| of a machine, kg m².
pub fn tilt_coefficient(machine: &Machine) -> f64 {
    AxialMoments::of(machine).sum()
}
