//! [`fit`]: least squares of all that was measured, and how well each number is known.

use nalgebra::{DMatrix, DVector, SVD};

use super::error::TrimError;
use super::long_run::{critical, lags, long_run};
use super::rows::{Channel, LINE, Made, Rows};
use super::unknowns::Unknowns;
use crate::mechanics::machine::{Inertia, Machine};

/// What the measurement says.
#[derive(Clone, Debug)]
pub struct Fit {
    /// Of what.
    pub unknowns: Unknowns,
    /// What the machine's file says of each.
    pub nominal: DVector<f64>,
    /// What was measured; nominal where that says nothing.
    pub measured: DVector<f64>,
    /// Of what was measured; nothing of what was not.
    pub covariance: DMatrix<f64>,
    /// How many standard deviations an interval of 95 % reaches to either side.
    pub critical: f64,
    /// Whether the data say anything of each.
    pub told: Vec<bool>,
    /// Groups of numbers that the data cannot tell apart; of a number alone they say nothing.
    pub confused: Vec<Vec<usize>>,
    /// σ of what is left of force, N, and of moment, N m.
    pub noise: [f64; 2],
    /// Root mean square of what was measured of force, N, and of moment, N m, less offsets.
    pub size: [f64; 2],
    /// The largest force, N, and moment, N m, that the machine could have in these motions.
    pub(super) largest: [f64; 2],
    /// As how many independent rows those of force and of moment count.
    pub effective: [f64; 2],
    /// (XᵀX)⁻¹ of what is told, rows weighted by σ.
    pub(super) inverse: DMatrix<f64>,
    /// XᵀX by σ² and what correlation leaves of each row.
    pub(super) information: DMatrix<f64>,
    /// σ² times the time that errors stay alike, of force and of moment, N² s and N² m² s.
    pub(super) density: [f64; 2],
}

/// Singular values below this part of the largest are none, whatever the noise.
const NOTHING: f64 = 1e-9;
/// So many times the noise of accelerations, too.
const ABOVE_NOISE: f64 = 4.0;
/// A number whose part of a direction that is not told is below this is told.
const PART: f64 = 1e-3;
/// Rows over which windows make errors alike, as many as Bartlett's window wants of it.
const LEAST_LAGS: usize = 48;
/// Steps of the solver of singular values.
const MOST_STEPS: usize = 10_000;
/// Rounding, as a part of the largest force and moment that a machine could have.
const ROUNDING: f64 = 1e-14;
/// Of the effective rows the numbers to be found have to leave this share.
const LEAST_SHARE: f64 = 0.1;
/// What is left below this part of what was measured is rounding.
const EXACT: f64 = 1e-9;

/// Least squares, weighted by what force and moment leave; about the machine as its file has it.
///
/// # Errors
/// If there is too little, or what is left is too slow.
pub fn fit(machine: &Machine, rows: &Rows) -> Result<Fit, TrimError> {
    let Estimate { fit, rank, share } = estimate(machine, rows)?;
    if share < LEAST_SHARE {
        return Err(TrimError::Correlated { effective: fit.effective.iter().sum(), unknowns: rank });
    }
    Ok(fit)
}

/// A fit, however much of what is left of it is correlated.
pub(super) struct Estimate {
    pub fit: Fit,
    /// Numbers that the data determine, and the lines of the sensors.
    pub rank: usize,
    /// The share of the effective rows that these leave; below 0 where there are fewer.
    pub share: f64,
}

/// Least squares, and how independent their residuals are.
///
/// # Errors
/// If numbers are not finite.
pub(super) fn estimate(machine: &Machine, rows: &Rows) -> Result<Estimate, TrimError> {
    let (inertia, p) = (Inertia::of(machine), rows.unknowns.count());
    let nominal = DVector::from_vec(rows.unknowns.nominal(&inertia));
    let scales = DVector::from_vec(rows.unknowns.scales(&inertia));
    // About the nominal machine, so that what is not told stays nominal.
    let deviation = |channel: &Channel| DVector::from_column_slice(&channel.y) - &channel.x * &nominal;
    let [fx, fy, n] = rows.channels.each_ref().map(deviation);
    let left = [fx, fy, n];
    let largest = largest(rows, &scales);
    let floors = largest.map(|largest| (ROUNDING * largest).max(f64::MIN_POSITIVE.sqrt()));
    let groups = [compressed(rows, &left, &[0, 1]), compressed(rows, &left, &[2])];
    let mut sigma = [rms(&[&left[0], &left[1]]).max(floors[0]), rms(&[&left[2]]).max(floors[1])];
    let mut solved = None;
    // Where weights do not change any more, sooner.
    for _ in 0..4 {
        let own = Solved::of(rows, &groups, &sigma, &nominal);
        let errors: Vec<DVector<f64>> = rows.channels.iter().zip(&left).map(|(c, y)| y - &c.x * &own.by).collect();
        let now = [rms(&[&errors[0], &errors[1]]).max(floors[0]), rms(&[&errors[2]]).max(floors[1])];
        let same = now.iter().zip(&sigma).all(|(now, was)| (now / was - 1.0).abs() < 1e-3);
        sigma = now;
        solved = Some((own, errors));
        if same {
            break;
        }
    }
    let (solved, errors) = solved.ok_or(TrimError::NotFinite)?;
    let (confused, told) = solved.confused(p);
    let count = rows.count();
    let least = if rows.made == Made::Samples { 1 } else { LEAST_LAGS };
    let parts: Vec<&[f64]> = errors.iter().map(|e| e.as_slice()).collect();
    let lags = lags(&parts, &rows.motions, least);
    // Windows take more lags than they need, which makes up for the second parameter.
    let fitted = if rows.made == Made::Samples { LINE as i32 } else { 1 };
    // How much longer errors stay alike than one row.
    let alike = |of: &[usize]| {
        let both = |f: &dyn Fn(usize) -> f64| of.iter().map(|c| f(*c)).sum::<f64>();
        let long =
            both(&|c| long_run(&DMatrix::from_column_slice(count, 1, parts[c]), &rows.motions, lags, fitted)[(0, 0)]);
        let own = both(&|c| errors[c].norm_squared());
        if own > 0.0 { (long / own).max(1.0) } else { 1.0 }
    };
    let y = |of: usize| DVector::from_column_slice(&rows.channels[of].y);
    let size = [rms(&[&y(0), &y(1)]), rms(&[&y(2)])];
    // Rounding is no noise.
    let exact = [0, 1].map(|of| sigma[of] <= EXACT * size[of] || sigma[of] <= 10.0 * floors[of]);
    let alike = [if exact[0] { 1.0 } else { alike(&[0, 1]) }, if exact[1] { 1.0 } else { alike(&[2]) }];
    let channels = [2.0, 1.0];
    let effective = [0, 1].map(|of| channels[of] * (count as f64 / alike[of]));
    let all = effective[0] + effective[1];
    // Offset and drift of each channel of each motion are fitted, too.
    let nuisance = 3 * LINE * rows.motions.len();
    let rank = p - solved.free.ncols() + nuisance;
    let share = (all - rank as f64) / all;
    let weights = [sigma[0], sigma[0], sigma[1]].map(|sigma| 1.0 / (sigma * sigma));
    let mut scores = DMatrix::zeros(count, p);
    for ((channel, error), weight) in rows.channels.iter().zip(&errors).zip(weights) {
        for (j, column) in channel.x.column_iter().enumerate() {
            (0..count).for_each(|i| scores[(i, j)] += weight * column[i] * error[i]);
        }
    }
    let middle = long_run(&scores, &rows.motions, lags, fitted) / share.max(LEAST_SHARE);
    let covariance = &solved.inverse * middle * solved.inverse.transpose();
    let gram = |of: usize| rows.channels[of].x.tr_mul(&rows.channels[of].x);
    let force = (gram(0) + gram(1)) * (weights[0] / alike[0]);
    let information = force + gram(2) * (weights[2] / alike[1]);
    let density = [0, 1].map(|of| sigma[of] * sigma[of] * alike[of] * rows.spacing);
    let fit = Fit {
        unknowns: rows.unknowns.clone(),
        measured: &nominal + &solved.by,
        nominal,
        covariance,
        critical: critical(lags as f64 / count as f64),
        told,
        confused,
        noise: sigma,
        size,
        largest,
        effective,
        inverse: solved.inverse,
        information,
        density,
    };
    let finite = fit.measured.iter().chain(fit.covariance.iter()).all(|x| x.is_finite());
    if finite { Ok(Estimate { fit, rank, share }) } else { Err(TrimError::NotFinite) }
}

impl Fit {
    /// Half of the interval of 95 % of a number.
    pub fn half_width(&self, place: usize) -> f64 {
        self.critical * self.covariance[(place, place)].max(0.0).sqrt()
    }
}

fn rms(all: &[&DVector<f64>]) -> f64 {
    let (sum, count) = all.iter().fold((0.0, 0), |(sum, count), y| (sum + y.norm_squared(), count + y.len()));
    (sum / count.max(1) as f64).sqrt()
}

/// Groups that have a number in common are one.
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

/// The largest force and moment, root mean square, that so large a machine could have.
fn largest(rows: &Rows, scales: &DVector<f64>) -> [f64; 2] {
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

/// Rows and right sides of some channels in as few rows as columns: R of their QR.
fn compressed(rows: &Rows, left: &[DVector<f64>; 3], channels: &[usize]) -> (DMatrix<f64>, DMatrix<f64>) {
    let (count, p) = (rows.count(), rows.unknowns.count());
    let mut all = DMatrix::zeros(channels.len() * count, p + 1);
    let mut noise = DMatrix::zeros(p, p);
    for (i, &c) in channels.iter().enumerate() {
        all.view_mut((i * count, 0), (count, p)).copy_from(&rows.channels[c].x);
        all.view_mut((i * count, p), (count, 1)).copy_from(&left[c]);
        noise += &rows.channels[c].noise;
    }
    (all.qr().unpack_r(), noise)
}

/// The solution for some weights.
struct Solved {
    /// By how much each number differs from the nominal one.
    by: DVector<f64>,
    /// (XᵀX)⁻¹ of what is told, weighted.
    inverse: DMatrix<f64>,
    /// Directions that are not told, orthonormal, in numbers divided by the sizes of their columns.
    free: DMatrix<f64>,
}

impl Solved {
    fn of(rows: &Rows, groups: &[(DMatrix<f64>, DMatrix<f64>); 2], sigma: &[f64; 2], nominal: &DVector<f64>) -> Self {
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
        // Of a size each; a column of nothing stays one.
        let sizes: Vec<f64> = all.columns(0, p).column_iter().map(|c| c.norm()).collect();
        let largest = sizes.iter().copied().fold(0.0, f64::max);
        let size = |j: usize| if sizes[j] > 1e-14 * largest { sizes[j] } else { f64::INFINITY };
        (0..p).for_each(|j| all.column_mut(j).scale_mut(1.0 / size(j)));
        // As high as wide, so that all directions are seen.
        let r = all.qr().unpack_r().resize(p + 1, p + 1, 0.0);
        let (x, right) = (r.view((0, 0), (p, p)).clone_owned(), r.view((0, p), (p, 1)).column(0).clone_owned());
        let svd = SVD::try_new(x, true, true, 5.0 * f64::EPSILON, MOST_STEPS);
        let parts = svd.and_then(|svd| Some((svd.u?, svd.singular_values, svd.v_t?)));
        let Some((u, singular, v)) = parts else {
            return Self { by: DVector::zeros(p), inverse: DMatrix::zeros(p, p), free: DMatrix::identity(p, p) };
        };
        let share = if let Made::Windows { noise, .. } = rows.made { noise } else { 0.0 };
        let cut = singular.max() * NOTHING.max(ABOVE_NOISE * share);
        let kept: Vec<usize> = (0..p).filter(|i| singular[*i] > cut).collect();
        let rest: Vec<usize> = (0..p).filter(|i| singular[*i] <= cut).collect();
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
        // Noise in the rows pulls towards 0 all that they say; by how much is known to first order.
        let (plain, mut all) = (by.clone(), by);
        for _ in 0..2 {
            all = &plain + &inverse * (&noise * (nominal + &all));
        }
        Self { by: all, inverse, free: v.select_columns(&rest) }
    }

    /// Groups of numbers that are told together only, and which numbers are told.
    fn confused(&self, p: usize) -> (Vec<Vec<usize>>, Vec<bool>) {
        let mut rows: Vec<DVector<f64>> = self.free.column_iter().map(|c| c.clone_owned()).collect();
        let told: Vec<bool> = (0..p).map(|j| self.free.row(j).norm() < PART).collect();
        // Reduced, so that each row names as few as can be.
        let mut at = 0;
        for j in 0..p {
            let Some(best) = (at..rows.len()).max_by(|a, b| rows[*a][j].abs().total_cmp(&rows[*b][j].abs())) else {
                break;
            };
            if rows[best][j].abs() < 10.0 * PART {
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
            (0..p).filter(|j| row[*j].abs() > 10.0 * PART * most && !told[*j]).collect::<Vec<_>>()
        };
        let groups = rows.iter().map(group).filter(|group| !group.is_empty()).collect();
        (joined(groups), told)
    }
}
