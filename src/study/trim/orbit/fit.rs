//! [`OrbitFit`]: least squares of the base rates, with the uncertainty of all unknowns. Symbols as in [`super`].

use nalgebra::{DMatrix, DVector, SVD};

use super::craft::Craft;
use super::motion::{OrbitBase, OrbitMotion};
use crate::trim::error::TrimError;
use crate::trim::fit::{IdentifiedNumbers, confounded};
use crate::trim::long_run::{bartlett_lags, correlation_length, long_run, neighbour_products, t_quantile};
use stillbase_mechanics::machine::{Inertia, Machine};

/// Maximum number of Gauss–Newton steps.
const MAX_STEPS: usize = 40;
/// Steps below this fraction of the scales of the unknowns end the iteration.
const STEP_TOLERANCE: f64 = 1e-10;
/// Singular values below this fraction of the largest are treated as zero.
const RANK_TOLERANCE: f64 = 1e-9;
/// Steps with a threshold of their own; later ones share one, so that they converge.
const FREE_STEPS: usize = 10;
/// Singular values of parameters below this fraction of the largest are treated as zero.
const UNTOLD: f64 = 1e-3;
/// A fit from another start counts if its residuals are below this fraction of those from the file.
const MUCH_BETTER: f64 = 0.9;
/// A direction is determined if the standard deviation along it is below this fraction of the scales: the fit is linear
/// in no larger region.
pub(super) const MAX_DEVIATION: f64 = 0.2;
/// Factor on the residual of the machine's file that no step may exceed.
const WORSE_THAN_FILE: f64 = 1.1;
/// Maximum number of times a step is halved.
const MAX_HALVINGS: usize = 12;
/// Minimum degrees of freedom, as a fraction of the rows, for the scale of intervals.
const MIN_FREEDOM: f64 = 0.1;

/// Result of the least-squares fit of motions in orbit.
pub(super) struct OrbitFit {
    pub craft: Craft,
    /// Values of the unknowns.
    pub numbers: IdentifiedNumbers,
    /// Groups of unknowns that are only identifiable in combination.
    pub confounded: Vec<Vec<usize>>,
    /// Number of rows of each motion.
    pub counts: Vec<usize>,
    /// Measured less predicted ω of each row, rad/s.
    pub errors: DVector<f64>,
    /// Root mean square of `errors`.
    pub noise: f64,
    /// Root mean square of measured less predicted ω by the machine's file, rad/s.
    pub off: f64,
    /// Root mean square of ω, rad/s.
    pub size: f64,
    /// Largest root mean square ω that a machine of this size could have in these motions, rad/s.
    pub largest: f64,
    /// Number of lags over which errors are correlated.
    pub lags: usize,
    /// Effective number of independent rows.
    pub effective: f64,
    /// Number of fitted parameters that the data determine, with L of each motion.
    pub rank: usize,
    /// Unknowns, then L of each motion.
    x: DVector<f64>,
    /// Derivatives of ω by `x`.
    slopes: DMatrix<f64>,
    /// Pseudo-inverse of slopesᵀ slopes over the identifiable directions.
    inverse: DMatrix<f64>,
}

/// Rows of all motions.
struct Rows<'a> {
    craft: &'a Craft,
    motions: &'a [OrbitMotion],
    unknowns: usize,
}

impl Rows<'_> {
    fn samples(&self) -> impl Iterator<Item = (usize, &OrbitMotion, usize)> {
        let rows = |(i, motion)| (0..OrbitMotion::rows(motion)).map(move |row| (i, motion, row));
        self.motions.iter().enumerate().flat_map(rows)
    }

    /// Returns measured less predicted ω of each row.
    fn errors(&self, x: &DVector<f64>) -> DVector<f64> {
        let of = self.craft.coefficients(x);
        let error = |(i, motion, row): (usize, &OrbitMotion, usize)| {
            let left = x[self.unknowns + i] - self.craft.wheel * motion.wheel_rate[row];
            let [still, turning] = self.craft.row(&of, &motion.angles[row], &motion.rates[row], None, &mut []);
            motion.base_rate[row] - (left - still) / turning
        };
        let count = self.motions.iter().map(OrbitMotion::rows).sum();
        DVector::from_iterator(count, self.samples().map(error))
    }

    /// Returns the derivatives of ω by the unknowns and L of each motion.
    fn slopes(&self, x: &DVector<f64>) -> DMatrix<f64> {
        let (p, of) = (self.unknowns, self.craft.coefficients(x));
        let count = self.motions.iter().map(OrbitMotion::rows).sum();
        let (mut slopes, mut own) = (DMatrix::zeros(count, x.len()), vec![0.0; p]);
        for (at, (i, motion, row)) in self.samples().enumerate() {
            let left = x[p + i] - self.craft.wheel * motion.wheel_rate[row];
            let [_, turning] = self.craft.row(&of, &motion.angles[row], &motion.rates[row], Some(left), &mut own);
            own.iter().enumerate().for_each(|(j, slope)| slopes[(at, j)] = *slope);
            slopes[(at, p + i)] = 1.0 / turning;
        }
        slopes
    }

    /// Returns the solution of least squares of L, which is linear in other coefficients: near the least residuals of ω,
    /// however far from the machine's `file`, but with a bias by noise.
    fn linear(&self, file: &DVector<f64>, scale: &[f64]) -> Option<DVector<f64>> {
        let (p, all) = (self.unknowns, file.len());
        let count = self.motions.iter().map(OrbitMotion::rows).sum();
        let home = self.craft.to_linear(file);
        let turning = self.craft.inertia.max(scale[p - 1]);
        let (mut table, mut own) = (DMatrix::zeros(count, all + 1), vec![0.0; p]);
        for (at, (i, motion, row)) in self.samples().enumerate() {
            let rate = motion.base_rate[row];
            self.craft.linear_row(&motion.angles[row], &motion.rates[row], rate, &mut own);
            let known = self.craft.inertia * rate + self.craft.wheel * motion.wheel_rate[row];
            let momentum: f64 = (0..p).map(|j| own[j] * home[j]).sum();
            own.iter().enumerate().for_each(|(j, slope)| table[(at, j)] = turning * slope);
            table[(at, p + i)] = -turning;
            table[(at, all)] = file[p + i] - known - momentum;
        }
        let r = table.qr().unpack_r();
        let (slopes, right) = (r.columns(0, all).clone_owned(), r.column(all).clone_owned());
        let svd = SVD::try_new(slopes.clone(), true, true, 5.0 * f64::EPSILON, 10_000)?;
        let mut deviation = DVector::zeros(all);
        let mut threshold = RANK_TOLERANCE * svd.singular_values.max();
        // First with all directions, then without those in which the noise that is left would lead far.
        for _ in 0..2 {
            deviation = svd.solve(&right, threshold).ok()?;
            threshold = threshold.max((&slopes * &deviation - &right).norm() / (count as f64).sqrt() / MAX_DEVIATION);
        }
        let x = home + turning * deviation;
        Some(self.craft.unknowns_of(file, &x)).filter(|x| x.iter().all(|x| x.is_finite()))
    }
}

/// Unknowns and L of each motion where Gauss–Newton steps end.
struct Descent {
    x: DVector<f64>,
    slopes: DMatrix<f64>,
    errors: DVector<f64>,
    /// Pseudo-inverse of slopesᵀ slopes over the identifiable directions.
    inverse: DMatrix<f64>,
    /// Orthonormal basis of the other directions, in units of the scales.
    free: DMatrix<f64>,
}

/// Returns the root mean square of errors.
fn rms(errors: &DVector<f64>) -> f64 {
    (errors.norm_squared() / errors.len() as f64).sqrt()
}

impl Descent {
    /// Descends from a start. What is not determined becomes as in the machine's `file`.
    fn from(rows: &Rows<'_>, file: &DVector<f64>, scale: &[f64], start: DVector<f64>) -> Result<Self, TrimError> {
        let all = file.len();
        let (mut errors, mut x) = (rows.errors(&start), start);
        let off_file = rms(&rows.errors(file));
        let (mut fixed_threshold, mut solved) = (None, None);
        for iteration in 0..MAX_STEPS {
            let slopes = rows.slopes(&x);
            let off = rms(&errors);
            let mut scaled = slopes.clone();
            (0..all).for_each(|j| scaled.column_mut(j).scale_mut(scale[j]));
            let svd = SVD::try_new(scaled.qr().unpack_r(), false, true, 5.0 * f64::EPSILON, 10_000)
                .ok_or(TrimError::NotFinite)?;
            let v = svd.v_t.ok_or(TrimError::NotFinite)?.transpose();
            // A direction in which noise alone could lead far from the file is not determined.
            let threshold = match fixed_threshold {
                Some(fixed) => fixed,
                None => (RANK_TOLERANCE * svd.singular_values.max()).max(off / MAX_DEVIATION),
            };
            if iteration + 1 >= FREE_STEPS {
                fixed_threshold = Some(threshold);
            }
            let is_kept = |i: &usize| svd.singular_values[*i] > threshold;
            let (kept, rest): (Vec<usize>, Vec<usize>) = (0..all).partition(is_kept);
            let mut inverse = DMatrix::zeros(all, all);
            for i in kept {
                let column = DVector::from_fn(all, |j, _| v[(j, i)] * scale[j]);
                inverse += &column * column.transpose() / svd.singular_values[i].powi(2);
            }
            let mut step = &inverse * slopes.tr_mul(&errors);
            // What is not determined goes back to the file, whatever earlier steps have made of it.
            for i in &rest {
                let way: f64 = (0..all).map(|j| v[(j, *i)] * (file[j] - x[j]) / scale[j]).sum();
                (0..all).for_each(|j| step[j] += way * v[(j, *i)] * scale[j]);
            }
            let size = (0..all).map(|j| (step[j] / scale[j]).abs()).fold(0.0, f64::max);
            if !size.is_finite() {
                return Err(TrimError::NotFinite);
            }
            // A step that leads to larger errors than the file's is too long for a linear model.
            let tried = (0..=MAX_HALVINGS).map(|halvings| &x + &step * 0.5_f64.powi(halvings as i32));
            let most = WORSE_THAN_FILE * off_file.max(off) + f64::MIN_POSITIVE;
            let next = tried.map(|x| (rows.errors(&x), x)).find(|(errors, _)| rms(errors) <= most);
            let reached = next.is_none() || size < STEP_TOLERANCE;
            solved = Some((slopes, inverse, v.select_columns(&rest)));
            if let Some(next) = next {
                (errors, x) = next;
            }
            if reached {
                break;
            }
        }
        let (slopes, inverse, free) = solved.ok_or(TrimError::NotFinite)?;
        Ok(Self { x, slopes, errors, inverse, free })
    }
}

impl OrbitFit {
    /// Fits the unknowns of a machine. What the motions do not determine stays as in the machine's file.
    ///
    /// # Errors
    /// If there are too few rows, a motion has lists of different lengths, a wheel turns that the base does not have, or a
    /// result is not finite.
    pub fn of(machine: &Machine, base: &OrbitBase, motions: &[OrbitMotion]) -> Result<Self, TrimError> {
        let (craft, inertia) = (Craft::of(machine, base), Inertia::of(machine));
        let (p, counts) = (craft.unknowns.count(), motions.iter().map(OrbitMotion::rows).collect::<Vec<_>>());
        let (count, all) = (counts.iter().sum::<usize>(), p + motions.len());
        for (i, motion) in motions.iter().enumerate() {
            motion.check(i, machine.drives())?;
        }
        let wheel_rate =
            motions.iter().flat_map(|motion| &motion.wheel_rate).fold(0.0_f64, |most, rate| most.max(rate.abs()));
        if base.wheel == 0.0 && wheel_rate > 0.0 {
            return Err(TrimError::NoWheel { rate: wheel_rate });
        }
        if count < 2 * all {
            return Err(TrimError::TooFew { rows: count, unknowns: p });
        }
        let nominal = DVector::from_vec(craft.unknowns.nominal(&inertia));
        let scales = craft.unknowns.scales(&inertia);
        let rows = Rows { craft: &craft, motions, unknowns: p };
        // L of each motion, as the machine's file has it on average.
        let mut x = nominal.clone().resize_vertically(all, 0.0);
        let of = craft.coefficients(&nominal);
        for (i, motion, row) in rows.samples() {
            let [still, turning] = craft.row(&of, &motion.angles[row], &motion.rates[row], None, &mut []);
            let momentum = still + turning * motion.base_rate[row] + craft.wheel * motion.wheel_rate[row];
            x[p + i] += momentum / counts[i] as f64;
        }
        let scale: Vec<f64> = (0..all).map(|j| if j < p { scales[j] } else { craft.inertia }).collect();
        let file = rms(&rows.errors(&x));
        let mut found = Descent::from(&rows, &x, &scale, x.clone())?;
        // Far from the file, steps may end elsewhere than at the least residuals.
        let linear = rows.linear(&x, &scale).filter(|start| rms(&rows.errors(start)) < rms(&found.errors));
        if let Some(other) = linear.and_then(|start| Descent::from(&rows, &x, &scale, start).ok())
            && rms(&other.errors) < MUCH_BETTER * rms(&found.errors)
        {
            found = other;
        }
        let Descent { x, slopes, errors, inverse, free } = found;
        let lags = bartlett_lags(&[errors.as_slice()], &counts, 1);
        let scores = DMatrix::from_fn(count, all, |i, j| slopes[(i, j)] * errors[i]);
        let rank = all - free.ncols();
        let share = (1.0 - rank as f64 / count as f64).max(MIN_FREEDOM);
        let covariance = &inverse * (long_run(&scores, &counts, lags, 1) / share) * inverse.transpose();
        let (confounded, identifiable) = confounded(&free.rows(0, p).clone_owned(), p);
        let [noise, size] =
            [rms(&errors), rms(&DVector::from_iterator(count, rows.samples().map(|(_, m, row)| m.base_rate[row])))];
        let correlation =
            correlation_length(&DMatrix::from_column_slice(count, 1, errors.as_slice()), &counts, lags, 1);
        let own = slopes.columns(0, p);
        let largest = own.column_iter().zip(&scales).map(|(column, scale)| column.norm_squared() * scale * scale);
        let numbers = IdentifiedNumbers {
            unknowns: craft.unknowns.clone(),
            nominal,
            measured: x.rows(0, p).clone_owned(),
            covariance: covariance.view((0, 0), (p, p)).clone_owned(),
            critical: t_quantile(lags as f64 / count as f64),
            identifiable,
            information: information(&slopes, p) / (noise * noise * correlation).max(f64::MIN_POSITIVE),
        };
        Ok(Self {
            largest: (largest.sum::<f64>() / count as f64).sqrt(),
            effective: count as f64 / correlation,
            craft,
            numbers,
            confounded,
            counts,
            errors,
            noise,
            off: file,
            size,
            lags,
            rank,
            x,
            slopes,
            inverse,
        })
    }

    /// Returns the root mean square of the part of the errors, rad/s, by which neighbouring rows are alike: of white noise
    /// nearly zero.
    pub fn slow_noise(&self) -> f64 {
        let [_, next] = neighbour_products(self.errors.as_slice(), &self.counts);
        (next.max(0.0) / self.errors.len() as f64).sqrt()
    }

    /// Returns by how much a parameter of motions, beside the unknowns, changes in one Gauss–Newton step with all of them, and
    /// its standard deviation; `None` if nothing tells it. `changed` are the motions with the parameter larger by `change`.
    pub fn parameter(&self, changed: &[OrbitMotion], change: f64) -> Option<[f64; 2]> {
        let rows = Rows { craft: &self.craft, motions: changed, unknowns: self.numbers.unknowns.count() };
        let slope = (rows.errors(&self.x) - &self.errors) / change;
        let alone = &slope - &self.slopes * (&self.inverse * self.slopes.tr_mul(&slope));
        let size = alone.norm();
        let step = -alone.dot(&self.errors) / (size * size);
        let deviation = self.noise * (self.errors.len() as f64 / self.effective).sqrt() / size;
        step.is_finite().then_some([step, deviation])
    }

    /// Returns by how much several parameters of motions change in one Gauss–Newton step with all unknowns, as
    /// [`parameter`](Self::parameter) does for one. What nothing tells does not change.
    pub fn parameters(&self, changed: impl Iterator<Item = Vec<OrbitMotion>>, change: f64) -> Option<DVector<f64>> {
        let alone = |motions: Vec<OrbitMotion>| {
            let rows = Rows { craft: &self.craft, motions: &motions, unknowns: self.numbers.unknowns.count() };
            let slope = (rows.errors(&self.x) - &self.errors) / change;
            &slope - &self.slopes * (&self.inverse * self.slopes.tr_mul(&slope))
        };
        let columns: Vec<DVector<f64>> = changed.map(alone).collect();
        let svd = SVD::try_new(DMatrix::from_columns(&columns), true, true, 5.0 * f64::EPSILON, 10_000)?;
        // Zeros that all motions have in common turn the unknowns only.
        let step = svd.solve(&-&self.errors, UNTOLD * svd.singular_values.max()).ok()?;
        step.iter().all(|x| x.is_finite()).then_some(step)
    }

    /// Returns how far each unknown moves if the craft is another one, in one Gauss–Newton step.
    pub fn shift(&self, craft: &Craft, motions: &[OrbitMotion]) -> DVector<f64> {
        let rows = Rows { craft, motions, unknowns: self.numbers.unknowns.count() };
        &self.inverse * self.slopes.tr_mul(&(rows.errors(&self.x) - &self.errors))
    }

    /// Returns the information that a motion from rest adds, where `noise` is the variance of each of its rows.
    pub fn information(&self, motion: &OrbitMotion, noise: f64) -> DMatrix<f64> {
        let p = self.numbers.unknowns.count();
        let x = self.numbers.measured.clone().resize_vertically(p + 1, 0.0);
        let motions = std::slice::from_ref(motion);
        information(&Rows { craft: &self.craft, motions, unknowns: p }.slopes(&x), p) / noise.max(f64::MIN_POSITIVE)
    }
}

/// Returns slopesᵀ slopes of the p unknowns, where L of each motion takes up what it can.
fn information(slopes: &DMatrix<f64>, p: usize) -> DMatrix<f64> {
    let own = slopes.columns(0, p);
    let mut all = own.tr_mul(&own);
    // L of different motions are in different rows, so they are orthogonal.
    for momentum in slopes.columns(p, slopes.ncols() - p).column_iter() {
        let along = own.tr_mul(&momentum);
        all.ger(-1.0 / momentum.norm_squared().max(f64::MIN_POSITIVE), &along, &along, 1.0);
    }
    all
}
