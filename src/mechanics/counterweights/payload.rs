//! [`over_payloads`]: residuals of balance over a range of payloads.

use schemars::JsonSchema;
use serde::Serialize;

use crate::balance::Condition;
use crate::machine::{Inertia, Machine, MachineError};

/// Largest residuals of (7) and of (8) with one payload.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize)]
pub struct PayloadResidual {
    /// Mass of the payload, kg.
    pub payload: f64,
    /// Largest residual of (7), |g_k|, kg m.
    pub force: f64,
    /// Largest residual of (8), |C_kl|, kg m².
    pub coupling: f64,
}

/// Returns the residuals at `count` payloads, at least two, in equal steps from `low` to `high`, kg.
///
/// # Errors
/// If the machine is not valid with one of the payloads.
pub fn over_payloads(
    machine: &Machine,
    [low, high]: [f64; 2],
    count: usize,
) -> Result<Vec<PayloadResidual>, MachineError> {
    let steps = count.max(2) - 1;
    let at = |i: usize| {
        let mut spec = machine.spec().clone();
        spec.payload.mass = low + (high - low) * i as f64 / steps as f64;
        let payload = spec.payload.mass;
        let inertia = Inertia::of(&Machine::new(spec)?);
        let greatest = |of_force: bool| {
            let all = Condition::all_of(machine);
            let alike = all.filter(|condition| matches!(condition, Condition::Force(_)) == of_force);
            alike.map(|condition| condition.residual(&inertia).norm()).fold(0.0, f64::max)
        };
        Ok(PayloadResidual { payload, force: greatest(true), coupling: greatest(false) })
    };
    (0..=steps).map(at).collect()
}
