//! Follows a path of the platform.

use nalgebra::{DMatrix, DVector, Vector3};

use super::chain::PlatformChain;
use super::choice::{FreedomChoice, least_norm};
use super::pose::{PLACE_TOLERANCE, is_within, nearest_pose};

/// Largest change of an angle from one point to the next, rad: above it a pose is not the continuation of the one before.
const MAX_TURN: f64 = 0.2;

/// Maximum number of corrections of a place.
const MAX_CORRECTIONS: usize = 20;

/// Why a path is not followed to its end.
#[derive(Clone, Debug, PartialEq)]
pub struct Stopped {
    /// Index of the first point that is not reached.
    pub point: usize,
    /// The reason.
    pub why: StopReason,
}

/// A reason why a path is not followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StopReason {
    /// Angle `angle` of block `block` of the chain would leave its limits.
    Limit {
        /// Index of the block in the chain.
        block: usize,
        /// Index of the angle among those of the block.
        angle: usize,
    },
    /// No rates of the drives lead on.
    Singular,
}

/// Returns the angles of all blocks at points, m, that lie close to each other; `start` are those of the first.
///
/// # Errors
/// If a point is not reached.
pub fn follow(
    chain: &PlatformChain,
    choice: FreedomChoice,
    start: DVector<f64>,
    points: &[Vector3<f64>],
) -> Result<Vec<DVector<f64>>, Stopped> {
    let (middle, half) = chain.middles();
    let mut all = vec![start];
    for (i, pair) in points.windows(2).enumerate() {
        let stopped = |why| Stopped { point: i + 1, why };
        let from = &all[i];
        let way = pair[1] - pair[0];
        let next = match choice {
            FreedomChoice::MidRange => nearest_pose(chain, &pair[1], from, &middle, &half),
            choice => stepped(chain, choice, from, &way).and_then(|a| corrected(chain, &pair[1], a)),
        };
        let next = next.filter(|a| (a - from).amax() <= MAX_TURN).ok_or_else(|| stopped(StopReason::Singular))?;
        if !is_within(chain, &next) {
            let bounds = chain.bounds();
            let past = |k: &usize| (bounds[*k][0] - next[*k]).max(next[*k] - bounds[*k][1]);
            let worst = (0..chain.freedoms()).max_by(|k, l| past(k).total_cmp(&past(l))).unwrap_or(0);
            let block = (0..chain.blocks().len()).find(|block| chain.range(*block).contains(&worst)).unwrap_or(0);
            return Err(stopped(StopReason::Limit { block, angle: worst - chain.range(block).start }));
        }
        all.push(next);
    }
    Ok(all)
}

/// Returns the angles after a way of the place, m, by the method of Runge and Kutta of fourth order.
fn stepped(
    chain: &PlatformChain,
    choice: FreedomChoice,
    from: &DVector<f64>,
    way: &Vector3<f64>,
) -> Option<DVector<f64>> {
    if way.norm() == 0.0 {
        return Some(from.clone());
    }
    let rates = |a: &DVector<f64>| {
        let (rates, left) = chain.rates(choice, a.as_slice(), way)?;
        (left.norm() <= 1e-6 * way.norm()).then_some(rates)
    };
    let first = rates(from)?;
    let second = rates(&(from + 0.5 * &first))?;
    let third = rates(&(from + 0.5 * &second))?;
    let fourth = rates(&(from + &third))?;
    Some(from + (first + 2.0 * (second + third) + fourth) / 6.0)
}

/// Returns the angles with the place corrected by steps of least rates; `None` if that does not converge.
fn corrected(chain: &PlatformChain, p: &Vector3<f64>, mut a: DVector<f64>) -> Option<DVector<f64>> {
    let tolerance = PLACE_TOLERANCE * chain.reach();
    for _ in 0..MAX_CORRECTIONS {
        let off = p - chain.place(a.as_slice());
        if off.norm() <= tolerance {
            return Some(a);
        }
        let jacobian = chain.jacobian(a.as_slice());
        let own = DMatrix::from_fn(3, chain.freedoms(), |row, k| jacobian[(row, k)]);
        a += least_norm(&own, &off, 1e-7);
    }
    None
}
