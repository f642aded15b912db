//! [`front`]: what less inertia costs in mass.

use super::asked::{Objective, Weighing};
use super::place::{Placed, place};
use super::refusal::NoWeights;
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
        self.points.iter().map(measures).collect()
    }
}

fn measures(placed: &Placed) -> [f64; 2] {
    [placed.added_mass, Inertia::of(&placed.machine).total_momentum()]
}

/// `count` machines, at least two: those of least mass and of least inertia, and between them always one more where two
/// lie furthest apart, halfway in what they differ in most.
///
/// # Errors
/// As [`place`].
pub fn front(machine: &Machine, asked: &Weighing, count: usize) -> Result<Front, NoWeights> {
    let mass = Weighing { objective: Objective::mass(), ..asked.clone() };
    let inertia = Weighing { objective: Objective::inertia(), ..asked.clone() };
    let quick = place(machine, &inertia)?;
    let light = place(machine, &mass)?;
    let mut points: Vec<([f64; 2], Placed)> = [light, quick].map(|placed| (measures(&placed), placed)).into();
    let size = [0, 1].map(|i| (points[1].0[i] - points[0].0[i]).abs().max(f64::MIN_POSITIVE));
    while points.len() < count {
        let apart = |i: usize| [0, 1].map(|axis| (points[i + 1].0[axis] - points[i].0[axis]).abs() / size[axis]);
        let furthest = (0..points.len() - 1).map(|i| (i, apart(i)));
        let Some((i, [by_mass, by_inertia])) =
            furthest.max_by(|a, b| a.1[0].hypot(a.1[1]).total_cmp(&b.1[0].hypot(b.1[1])))
        else {
            break;
        };
        let halfway = |axis: usize| Some(0.5 * (points[i].0[axis] + points[i + 1].0[axis]));
        let between = match by_mass > by_inertia {
            true => place(machine, &Weighing { most_mass: halfway(0), ..inertia.clone() }),
            false => place(machine, &Weighing { most_inertia: halfway(1), ..mass.clone() }),
        }?;
        points.insert(i + 1, (measures(&between), between));
    }
    Ok(Front { points: points.into_iter().map(|(_, placed)| placed).collect() })
}
