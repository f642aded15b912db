//! [`fit`]: least-squares estimate of all unknowns, with their uncertainty.

use nalgebra::{DMatrix, DVector, SVD};

use super::error::TrimError;
use super::long_run::{bartlett_lags, correlation_length, long_run, t_quantile};
use super::rows::{Channel, Regressor, RegressorSource, TREND_PARAMETERS};
use super::unknowns::Unknowns;
use stillbase_mechanics::machine::{Inertia, Machine};

/// Values of all unknowns, with their uncertainty, whatever they were measured by.
#[derive(Clone, Debug)]
pub struct IdentifiedNumbers {
    /// The unknowns.
    pub unknowns: Unknowns,
    /// Values in the machine's file.
    pub nominal: DVector<f64>,
    /// Measured values; nominal where the data do not identify them.
    pub measured: DVector<f64>,
    /// Covariance of the measured values, over the identifiable directions only.
    pub covariance: DMatrix<f64>,
    /// Ratio of the half width of a 95 % interval to the standard deviation.
    pub critical: f64,
    /// Whether each unknown is identifiable from the data.
    pub identifiable: Vec<bool>,
    /// Information on the unknowns: the inverse of their covariance, 0 along directions that are not identifiable. Correlated
    /// rows count as the effective number of rows.
    pub(super) information: DMatrix<f64>,
}

/// Result of the least-squares fit.
#[derive(Clone, Debug)]
pub struct Fit {
    /// Values of the unknowns.
    pub numbers: IdentifiedNumbers,
    /// Groups of unknowns that are only identifiable in combination; a group of one is not identifiable at
    /// all.
    pub confounded: Vec<Vec<usize>>,
    /// Standard deviation σ of the residuals of force, N, and of moment, N m.
    pub noise: [f64; 2],
    /// Root mean square of the measured force, N, and moment, N m, without offset and drift.
    pub size: [f64; 2],
    /// Largest root mean square force, N, and moment, N m, that a machine of this size could have in these motions.
    pub(super) largest: [f64; 2],
    /// Effective number of independent rows of force and of moment.
    pub effective: [f64; 2],
    /// Pseudo-inverse of XᵀX over the identifiable directions, rows weighted by 1/σ.
    pub(super) inverse: DMatrix<f64>,
    /// σ² times the correlation time of the residuals, of force and of moment, N² s and N² m² s.
    pub(super) density: [f64; 2],
}

/// Singular values below this fraction of the largest are treated as zero.
const RANK_TOLERANCE: f64 = 1e-9;
/// The rank tolerance is at least this factor times the relative noise of the accelerations.
const NOISE_FACTOR: f64 = 4.0;
/// An unknown is identifiable if the norm of its components along all unobservable directions is smaller than this.
const IDENTIFIABLE_BELOW: f64 = 1e-3;
/// Minimum number of lags of Bartlett's window for averaged rows: their averaging windows overlap and correlate them.
const MIN_LAGS: usize = 48;
/// Maximum number of iterations of the singular value solver.
const MAX_ITERATIONS: usize = 10_000;
/// Rounding level, as a fraction of the largest force and moment of the machine.
const ROUNDING_LEVEL: f64 = 1e-14;
/// Minimum degrees of freedom, as a fraction of the effective number of rows.
const MIN_FREEDOM: f64 = 0.1;
/// Residuals below this fraction of the measured values are treated as rounding errors.
const EXACT_BELOW: f64 = 1e-9;

/// Fits the unknowns by least squares about the machine's file, with weights from the residuals of force and moment.
///
/// # Errors
/// Fails if there are too few rows, the residuals are too strongly correlated, or a result is not finite.
pub fn fit(machine: &Machine, rows: &Regressor) -> Result<Fit, TrimError> {
    let Estimate { fit, rank, share } = estimate(machine, rows)?;
    if share < MIN_FREEDOM {
        return Err(TrimError::Correlated { effective: fit.effective.iter().sum(), unknowns: rank });
    }
    Ok(fit)
}

/// A fit, without a check of the degrees of freedom.
pub(super) struct Estimate {
    pub fit: Fit,
    /// Number of identifiable parameters, including offset and drift of the sensors.
    pub rank: usize,
    /// Degrees of freedom as a fraction of the effective number of rows; negative if the rows are too few.
    pub share: f64,
}

/// Fits the unknowns by weighted least squares and estimates the correlation of the residuals.
///
/// # Errors
/// Fails if a result is not finite.
pub(super) fn estimate(machine: &Machine, rows: &Regressor) -> Result<Estimate, TrimError> {
    let (inertia, p) = (Inertia::of(machine), rows.unknowns.count());
    let nominal = DVector::from_vec(rows.unknowns.nominal(&inertia));
    let scales = DVector::from_vec(rows.unknowns.scales(&inertia));
    // The deviation from the nominal machine is fitted, so that unidentifiable directions stay nominal.
    let deviation = |channel: &Channel| DVector::from_column_slice(&channel.y) - &channel.x * &nominal;
    let [fx, fy, n] = rows.channels.each_ref().map(deviation);
    let deviations = [fx, fy, n];
    let largest = largest(rows, &scales);
    let floors = largest.map(|largest| (ROUNDING_LEVEL * largest).max(f64::MIN_POSITIVE.sqrt()));
    let groups = [compressed(rows, &deviations, &[0, 1]), compressed(rows, &deviations, &[2])];
    let mut sigma = [rms(&[&deviations[0], &deviations[1]]).max(floors[0]), rms(&[&deviations[2]]).max(floors[1])];
    let mut solved = None;
    // Iterate the weights until they converge, at most four times.
    for _ in 0..4 {
        let own = Solved::of(rows, &groups, &sigma, &nominal);
        let errors: Vec<DVector<f64>> =
            rows.channels.iter().zip(&deviations).map(|(c, y)| y - &c.x * &own.deviation).collect();
        let now = [rms(&[&errors[0], &errors[1]]).max(floors[0]), rms(&[&errors[2]]).max(floors[1])];
        let same = now.iter().zip(&sigma).all(|(now, was)| (now / was - 1.0).abs() < 1e-3);
        sigma = now;
        solved = Some((own, errors));
        if same {
            break;
        }
    }
    let (solved, errors) = solved.ok_or(TrimError::NotFinite)?;
    let (confounded, identifiable) = confounded(&solved.free, p);
    let count = rows.count();
    let least = if rows.source == RegressorSource::Samples { 1 } else { MIN_LAGS };
    let parts: Vec<&[f64]> = errors.iter().map(|e| e.as_slice()).collect();
    let lags = bartlett_lags(&parts, &rows.motions, least);
    // For windows the larger number of lags compensates for the second parameter of the line.
    let fitted = if rows.source == RegressorSource::Samples { TREND_PARAMETERS as i32 } else { 1 };
    // Ratio of the long-run variance to the variance of one row: correlation length in rows.
    let correlation = |of: &[usize]| {
        let columns: Vec<DVector<f64>> = of.iter().map(|c| errors[*c].clone()).collect();
        correlation_length(&DMatrix::from_columns(&columns), &rows.motions, lags, fitted)
    };
    let y = |of: usize| DVector::from_column_slice(&rows.channels[of].y);
    let size = [rms(&[&y(0), &y(1)]), rms(&[&y(2)])];
    // Residuals at rounding level are not treated as correlated noise.
    let exact = [0, 1].map(|of| sigma[of] <= EXACT_BELOW * size[of] || sigma[of] <= 10.0 * floors[of]);
    let correlation =
        [if exact[0] { 1.0 } else { correlation(&[0, 1]) }, if exact[1] { 1.0 } else { correlation(&[2]) }];
    let channels = [2.0, 1.0];
    let effective = [0, 1].map(|of| channels[of] * (count as f64 / correlation[of]));
    let all = effective[0] + effective[1];
    // Offset and drift of each channel of each motion are fitted too.
    let nuisance = 3 * TREND_PARAMETERS * rows.motions.len();
    let rank = p - solved.free.ncols() + nuisance;
    let share = (all - rank as f64) / all;
    let weights = [sigma[0], sigma[0], sigma[1]].map(|sigma| 1.0 / (sigma * sigma));
    let mut scores = DMatrix::zeros(count, p);
    for ((channel, error), weight) in rows.channels.iter().zip(&errors).zip(weights) {
        for (j, column) in channel.x.column_iter().enumerate() {
            (0..count).for_each(|i| scores[(i, j)] += weight * column[i] * error[i]);
        }
    }
    let meat = long_run(&scores, &rows.motions, lags, fitted) / share.max(MIN_FREEDOM);
    let covariance = &solved.inverse * meat * solved.inverse.transpose();
    let gram = |of: usize| rows.channels[of].x.tr_mul(&rows.channels[of].x);
    let force = (gram(0) + gram(1)) * (weights[0] / correlation[0]);
    let information = force + gram(2) * (weights[2] / correlation[1]);
    let density = [0, 1].map(|of| sigma[of] * sigma[of] * correlation[of] * rows.spacing);
    let numbers = IdentifiedNumbers {
        unknowns: rows.unknowns.clone(),
        measured: &nominal + &solved.deviation,
        nominal,
        covariance,
        critical: t_quantile(lags as f64 / count as f64),
        identifiable,
        information,
    };
    let fit = Fit { numbers, confounded, noise: sigma, size, largest, effective, inverse: solved.inverse, density };
    let finite = fit.numbers.measured.iter().chain(fit.numbers.covariance.iter()).all(|x| x.is_finite());
    if finite { Ok(Estimate { fit, rank, share }) } else { Err(TrimError::NotFinite) }
}

impl IdentifiedNumbers {
    /// Returns the half width of the 95 % interval of an unknown.
    pub fn half_width(&self, place: usize) -> f64 {
        self.critical * self.covariance[(place, place)].max(0.0).sqrt()
    }
}

fn rms(all: &[&DVector<f64>]) -> f64 {
    let (sum, count) = all.iter().fold((0.0, 0), |(sum, count), y| (sum + y.norm_squared(), count + y.len()));
    (sum / count.max(1) as f64).sqrt()
}

/// Merges groups that share an unknown.
fn joined(groups: Vec<Vec<usize>>) -> Vec<Vec<usize>> {
    let mut all: Vec<Vec<usize>> = Vec::new();
    for mut group in groups {
        let (tied, apart): (Vec<_>, Vec<_>) = all.into_iter().partition(|own| own.iter().any(|i| group.contains(i)));
        all = apart;
        group.extend(tied.into_iter().flatten());
        group.sort_unstable();
        group.dedup();
        all.push(group);
    }
    all
}

/// Returns the largest root mean square force and moment that a machine of this size could have.
fn largest(rows: &Regressor, scales: &DVector<f64>) -> [f64; 2] {
    let of = |channels: &[usize]| {
        let size = |c: &usize| {
            let columns = rows.channels[*c].x.column_iter().zip(scales.iter());
            columns.map(|(column, scale)| column.norm_squared() * scale * scale).sum::<f64>()
        };
        let all = channels.iter().map(size).sum::<f64>();
        (all / rows.count() as f64).sqrt()
    };
    [of(&[0, 1]), of(&[2])]
}

/// Compresses the rows and right sides of some channels to the R factor of their QR decomposition; also returns the sum
/// of their noise matrices.
fn compressed(rows: &Regressor, deviations: &[DVector<f64>; 3], channels: &[usize]) -> (DMatrix<f64>, DMatrix<f64>) {
    let (count, p) = (rows.count(), rows.unknowns.count());
    let mut all = DMatrix::zeros(channels.len() * count, p + 1);
    let mut noise = DMatrix::zeros(p, p);
    for (i, &c) in channels.iter().enumerate() {
        all.view_mut((i * count, 0), (count, p)).copy_from(&rows.channels[c].x);
        all.view_mut((i * count, p), (count, 1)).copy_from(&deviations[c]);
        noise += &rows.channels[c].noise;
    }
    (all.qr().unpack_r(), noise)
}

/// Solution for given weights.
struct Solved {
    /// Deviation of each unknown from its nominal value.
    deviation: DVector<f64>,
    /// Pseudo-inverse of XᵀX over the identifiable directions, weighted.
    inverse: DMatrix<f64>,
    /// Orthonormal basis of the unobservable directions, in unknowns scaled by their column norms.
    free: DMatrix<f64>,
}

impl Solved {
    fn of(
        rows: &Regressor,
        groups: &[(DMatrix<f64>, DMatrix<f64>); 2],
        sigma: &[f64; 2],
        nominal: &DVector<f64>,
    ) -> Self {
        let p = nominal.len();
        let heights = groups.each_ref().map(|(r, _)| r.nrows());
        let mut all = DMatrix::zeros(heights[0] + heights[1], p + 1);
        let mut noise = DMatrix::zeros(p, p);
        let mut from = 0;
        for ((r, own), sigma) in groups.iter().zip(sigma) {
            all.view_mut((from, 0), r.shape()).copy_from(&(r / *sigma));
            noise += own / (sigma * sigma);
            from += r.nrows();
        }
        // Scale columns to unit norm; set negligible columns to zero.
        let sizes: Vec<f64> = all.columns(0, p).column_iter().map(|c| c.norm()).collect();
        let largest = sizes.iter().copied().fold(0.0, f64::max);
        let size = |j: usize| if sizes[j] > 1e-14 * largest { sizes[j] } else { f64::INFINITY };
        (0..p).for_each(|j| all.column_mut(j).scale_mut(1.0 / size(j)));
        // Pad R to a square matrix, so that the SVD returns all directions, including the null space.
        let r = all.qr().unpack_r().resize(p + 1, p + 1, 0.0);
        let (x, right) = (r.view((0, 0), (p, p)).clone_owned(), r.view((0, p), (p, 1)).column(0).clone_owned());
        let svd = SVD::try_new(x, true, true, 5.0 * f64::EPSILON, MAX_ITERATIONS);
        let parts = svd.and_then(|svd| Some((svd.u?, svd.singular_values, svd.v_t?)));
        let Some((u, singular, v)) = parts else {
            return Self { deviation: DVector::zeros(p), inverse: DMatrix::zeros(p, p), free: DMatrix::identity(p, p) };
        };
        let share = if let RegressorSource::Windows { noise, .. } = rows.source { noise } else { 0.0 };
        let threshold = singular.max() * RANK_TOLERANCE.max(NOISE_FACTOR * share);
        let kept: Vec<usize> = (0..p).filter(|i| singular[*i] > threshold).collect();
        let rest: Vec<usize> = (0..p).filter(|i| singular[*i] <= threshold).collect();
        let v = v.transpose();
        let scaled = DVector::from_fn(p, |j, _| 1.0 / size(j));
        let of = |i: usize| v.column(i).component_mul(&scaled);
        let mut inverse = DMatrix::zeros(p, p);
        let mut by = DVector::zeros(p);
        for &i in &kept {
            let (s, column) = (singular[i], of(i));
            by += &column * (u.column(i).dot(&right) / s);
            inverse += &column * column.transpose() / (s * s);
        }
        // Noise in the regressors biases the estimate towards 0; correct this to first order.
        let (plain, mut all) = (by.clone(), by);
        for _ in 0..2 {
            all = &plain + &inverse * (&noise * (nominal + &all));
        }
        Self { deviation: all, inverse, free: v.select_columns(&rest) }
    }
}

/// Returns the groups of unknowns that are only identifiable in combination, and whether each unknown is
/// identifiable. `free` is an orthonormal basis of the unobservable directions.
pub(super) fn confounded(free: &DMatrix<f64>, p: usize) -> (Vec<Vec<usize>>, Vec<bool>) {
    let mut rows: Vec<DVector<f64>> = free.column_iter().map(|c| c.clone_owned()).collect();
    let identifiable: Vec<bool> = (0..p).map(|j| free.row(j).norm() < IDENTIFIABLE_BELOW).collect();
    // Gauss–Jordan elimination, so that each unobservable direction involves few unknowns.
    let mut at = 0;
    for j in 0..p {
        let Some(best) = (at..rows.len()).max_by(|a, b| rows[*a][j].abs().total_cmp(&rows[*b][j].abs())) else {
            break;
        };
        if rows[best][j].abs() < 10.0 * IDENTIFIABLE_BELOW {
            continue;
        }
        rows.swap(at, best);
        let own = &rows[at] / rows[at][j];
        for (i, row) in rows.iter_mut().enumerate() {
            if i == at {
                row.copy_from(&own);
            } else {
                let by = row[j];
                row.axpy(-by, &own, 1.0);
            }
        }
        at += 1;
    }
    let group = |row: &DVector<f64>| {
        let most = row.amax();
        (0..p).filter(|j| row[*j].abs() > 10.0 * IDENTIFIABLE_BELOW * most && !identifiable[*j]).collect::<Vec<_>>()
    };
    let groups = rows.iter().map(group).filter(|group| !group.is_empty()).collect();
    (joined(groups), identifiable)
}
