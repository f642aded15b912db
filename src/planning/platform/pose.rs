//! Poses of a chain at a place of its platform.

use nalgebra::{DMatrix, DVector, Vector3};

use super::chain::PlatformChain;

/// Largest error of a place that counts as reached, as a fraction of the reach.
pub(super) const PLACE_TOLERANCE: f64 = 1e-11;

/// Number of samples of the angles from which poses are sought, and maximum number of steps of each descent.
const STARTS: usize = 96;
const MAX_STEPS: usize = 80;

/// Primes, whose square roots generate the sequence of samples.
const PRIMES: [f64; 16] = [2.0, 3.0, 5.0, 7.0, 11.0, 13.0, 17.0, 19.0, 23.0, 29.0, 31.0, 37.0, 41.0, 43.0, 47.0, 53.0];

/// The nearest place that was found to one that is not reached.
#[derive(Clone, Debug, PartialEq)]
pub struct NearestPlace {
    /// p, m.
    pub place: Vector3<f64>,
    /// Its distance, m.
    pub distance: f64,
    /// The angles there, rad.
    pub angles: DVector<f64>,
}

/// Returns the angles of the pose at a place, m, within all limits; of the poses that a search from many starts finds,
/// that nearest to `near`, rad, by Σ ((a − near)/h)².
///
/// # Errors
/// The nearest place that was found, if there is no pose.
pub fn pose_at(chain: &PlatformChain, p: &Vector3<f64>, near: &DVector<f64>) -> Result<DVector<f64>, NearestPlace> {
    let (middle, half) = chain.middles();
    let tolerance = PLACE_TOLERANCE * chain.reach();
    let start = |i: usize| {
        DVector::from_fn(chain.freedoms(), |k, _| match i {
            0 => near[k],
            i => middle[k] + half[k] * (2.0 * (i as f64 * PRIMES[k % PRIMES.len()].sqrt()).fract() - 1.0),
        })
    };
    let (mut best, mut nearest) = (None::<(f64, DVector<f64>)>, None::<NearestPlace>);
    for i in 0..STARTS {
        let (a, distance) = descended(chain, p, clamped(chain, start(i)));
        if distance > tolerance {
            if nearest.as_ref().is_none_or(|known| distance < known.distance) {
                nearest = Some(NearestPlace { place: chain.place(a.as_slice()), distance, angles: a });
            }
            continue;
        }
        // A pose nearer to what is wanted, if it keeps the limits.
        let refined = nearest_pose(chain, p, &a, near, &half).filter(|refined| is_within(chain, refined));
        for a in refined.into_iter().chain([a]) {
            let far = (0..chain.freedoms()).map(|k| ((a[k] - near[k]) / half[k]).powi(2)).sum::<f64>();
            if best.as_ref().is_none_or(|(least, _)| far < *least) {
                best = Some((far, a));
            }
        }
    }
    match (best, nearest) {
        (Some((_, a)), _) => Ok(a),
        (None, Some(nearest)) => Err(nearest),
        (None, None) => {
            let (place, angles) = (chain.place(near.as_slice()), near.clone());
            Err(NearestPlace { place, distance: f64::INFINITY, angles })
        }
    }
}

/// Returns whether angles keep their bounds.
pub(super) fn is_within(chain: &PlatformChain, a: &DVector<f64>) -> bool {
    chain.bounds().iter().zip(a.iter()).all(|([low, high], a)| (low - 1e-9..=high + 1e-9).contains(a))
}

fn clamped(chain: &PlatformChain, mut a: DVector<f64>) -> DVector<f64> {
    a.iter_mut().zip(chain.bounds()).for_each(|(a, [low, high])| *a = a.clamp(low, high));
    a
}

/// Descends from angles to those whose place is nearest to p, within all limits; returns them with the distance, m.
///
/// # Source
/// The method of Levenberg and Marquardt on the angles that are not held by a limit.
fn descended(chain: &PlatformChain, p: &Vector3<f64>, from: DVector<f64>) -> (DVector<f64>, f64) {
    let (bounds, reach) = (chain.bounds(), chain.reach());
    let (mut a, mut damping) = (from, 1e-4);
    let mut off = p - chain.place(a.as_slice());
    for _ in 0..MAX_STEPS {
        let jacobian = chain.jacobian(a.as_slice());
        let down = jacobian.transpose() * off;
        let free: Vec<usize> = (0..chain.freedoms())
            .filter(|k| {
                let [low, high] = bounds[*k];
                !(a[*k] <= low && down[*k] < 0.0 || a[*k] >= high && down[*k] > 0.0)
            })
            .collect();
        let own = DMatrix::from_fn(3, free.len(), |row, k| jacobian[(row, free[k])]);
        let mut normal = own.transpose() * &own;
        (0..free.len()).for_each(|k| normal[(k, k)] += damping * reach * reach);
        let wanted = DVector::from_fn(free.len(), |k, _| down[free[k]]);
        let Some(step) = normal.cholesky().map(|factors| factors.solve(&wanted)) else { break };
        let mut next = a.clone();
        free.iter().zip(step.iter()).for_each(|(k, step)| next[*k] += step);
        let next = clamped(chain, next);
        let left = p - chain.place(next.as_slice());
        if left.norm() < off.norm() {
            let gain = off.norm() - left.norm();
            (a, off) = (next, left);
            damping = (0.1 * damping).max(1e-14);
            if off.norm() <= 1e-3 * PLACE_TOLERANCE * reach || gain <= 1e-12 * off.norm() {
                break;
            }
        } else {
            damping *= 10.0;
            if damping > 1e8 {
                break;
            }
        }
    }
    let distance = off.norm();
    (a, distance)
}

/// Returns the pose at p for which Σ ((a − near)/h)² is stationary, by Newton's method from a pose at p; `None` if that does
/// not converge.
pub(super) fn nearest_pose(
    chain: &PlatformChain,
    p: &Vector3<f64>,
    from: &DVector<f64>,
    near: &DVector<f64>,
    half: &DVector<f64>,
) -> Option<DVector<f64>> {
    let (n, reach) = (chain.freedoms(), chain.reach());
    let mut a = from.clone();
    let weight = |k: usize| 1.0 / (half[k] * half[k]);
    // Multipliers that fit the start best.
    let slope = |a: &DVector<f64>| DVector::from_fn(n, |k, _| weight(k) * (a[k] - near[k]));
    let jacobian = chain.jacobian(a.as_slice());
    let columns = DMatrix::from_fn(n, 3, |k, row| jacobian[(row, k)]);
    let svd = columns.svd(true, true);
    let most = svd.singular_values.max();
    let mut mu = svd.solve(&-slope(&a), 1e-9 * most).ok()?;
    for _ in 0..40 {
        let jacobian = chain.jacobian(a.as_slice());
        let curvature = chain.curvature(a.as_slice(), &Vector3::new(mu[0], mu[1], mu[2]));
        let off = p - chain.place(a.as_slice());
        let mut system = DMatrix::zeros(n + 3, n + 3);
        let mut right = DVector::zeros(n + 3);
        let own = slope(&a);
        for k in 0..n {
            for l in 0..n {
                system[(k, l)] = curvature[(k, l)] + if k == l { weight(k) } else { 0.0 };
            }
            for row in 0..3 {
                system[(k, n + row)] = jacobian[(row, k)];
                system[(n + row, k)] = jacobian[(row, k)];
            }
            right[k] = -own[k] - (0..3).map(|row| jacobian[(row, k)] * mu[row]).sum::<f64>();
        }
        (0..3).for_each(|row| right[n + row] = off[row]);
        let svd = system.svd(true, true);
        let most = svd.singular_values.max();
        let step = svd.solve(&right, 1e-10 * most).ok()?;
        // Longer steps leave the neighbourhood in which the linear system tells anything.
        let longest = step.rows(0, n).amax();
        let share = if longest > 0.3 { 0.3 / longest } else { 1.0 };
        a += share * step.rows(0, n);
        mu += share * step.rows(n, 3);
        if longest < 1e-13 || longest < 1e-11 && off.norm() <= 0.1 * PLACE_TOLERANCE * reach {
            break;
        }
    }
    ((p - chain.place(a.as_slice())).norm() <= PLACE_TOLERANCE * reach).then_some(a)
}
