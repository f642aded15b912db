//! [`front`]: what less inertia costs in mass.

use super::problem::{NoWeights, Objective, Placed, Weighing, place};
use crate::mechanics::machine::{Inertia, Machine};

/// Machines from the least added mass to the least inertia: none is better than another in both.
#[derive(Clone, Debug, PartialEq)]
pub struct Front {
    /// From light to quick.
    pub points: Vec<Placed>,
}

impl Front {
    /// Added mass, kg, and Σ D_k, kg m², of each point.
    pub fn measures(&self) -> Vec<[f64; 2]> {
        self.points.iter().map(|placed| [placed.added_mass, total(&placed.machine)]).collect()
    }
}

/// Σ D_k, kg m².
fn total(machine: &Machine) -> f64 {
    Inertia::of(machine).momenta().iter().sum()
}

/// `count` machines, at least two, at equal steps of Σ D_k between those of least mass and of least inertia.
///
/// # Errors
/// As [`place`].
pub fn front(machine: &Machine, asked: &Weighing, count: usize) -> Result<Front, NoWeights> {
    let quick = place(machine, &Weighing { objective: Objective::inertia(), ..asked.clone() })?;
    let mass = Weighing { objective: Objective::mass(), ..asked.clone() };
    // Of those of least mass the one of least inertia: a gram is worth it.
    let light =
        place(machine, &Weighing { objective: Objective { inertia: 1e-6, ..Objective::mass() }, ..asked.clone() })?;
    let (least, most) = (total(&quick.machine), total(&light.machine));
    let steps = count.max(2) - 1;
    let mut points = vec![light];
    for i in 1..steps {
        let level = most + (least - most) * i as f64 / steps as f64;
        points.push(place(machine, &Weighing { most_inertia: Some(level), ..mass.clone() })?);
    }
    points.push(quick);
    Ok(Front { points })
}
