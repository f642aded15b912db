//! [`PostureCost`]: the objective of a path as a quadratic form of its poses at all stations.

use super::stations::{Stations, weights};
use stillbase_mechanics::planar::{MAX_DRIVES, PerDrive};

/// Number of stations coupled in a row of a form: its own and the next three.
const BAND: usize = 4;
/// Wavelength, in intervals, at which the smoothing term weighs as much as the rates.
const SMOOTHING_WAVELENGTH: f64 = 8.0;

/// A matrix over the drives.
pub(super) type WeightMatrix = [[f64; MAX_DRIVES]; MAX_DRIVES];

/// A form ½ Σ κ_ij (q_i − c)ᵀ S (q_j − c) over stations i and j.
#[derive(Clone, Debug)]
pub(super) struct CostTerm {
    /// κ_ij of j = i … i + 3.
    pub kappa: Vec<[f64; BAND]>,
    /// S.
    pub weight: WeightMatrix,
}

/// A sum of forms about one pose c.
#[derive(Clone, Debug)]
pub(super) struct PostureCost {
    pub terms: Vec<CostTerm>,
    pub centre: PerDrive,
}

/// Returns the identity matrix over n drives.
pub(super) fn even(n: usize) -> WeightMatrix {
    std::array::from_fn(|k| std::array::from_fn(|l| f64::from(u8::from(k == l && k < n))))
}

/// Returns S x.
pub(super) fn times(weight: &WeightMatrix, x: &PerDrive) -> PerDrive {
    PerDrive::from_fn(x.len(), |k| x.dot(&weight[k]))
}

/// Returns a weight matrix multiplied by a factor.
pub(super) fn scaled(weight: &WeightMatrix, by: f64) -> WeightMatrix {
    weight.map(|row| row.map(|x| by * x))
}

impl CostTerm {
    fn zeros(stations: &Stations, weight: WeightMatrix) -> Self {
        Self { kappa: vec![[0.0; BAND]; stations.places.len()], weight }
    }

    /// Adds weight · (Σ c_j q_(i+j))².
    fn add(&mut self, i: usize, c: &[f64], weight: f64) {
        for (j, x) in c.iter().enumerate() {
            c.iter().enumerate().skip(j).for_each(|(k, y)| self.kappa[i + j][k - j] += 2.0 * weight * x * y);
        }
    }

    /// Returns the form of ∫ |q′|²_S ds.
    pub fn rates(stations: &Stations, weight: WeightMatrix) -> Self {
        let mut term = Self::zeros(stations, weight);
        for leg in &stations.legs {
            for (i, w) in leg.s.windows(2).enumerate() {
                term.add(leg.first + i, &[-1.0, 1.0], 1.0 / (leg.share * (w[1] - w[0])));
            }
        }
        term
    }

    /// Returns the form of ∫ ½ |q − c|²_S ds.
    pub fn places(stations: &Stations, weight: WeightMatrix) -> Self {
        let mut term = Self::zeros(stations, weight);
        for leg in &stations.legs {
            for (i, w) in leg.s.windows(2).enumerate() {
                let part = 0.25 * leg.share * (w[1] - w[0]);
                (0..2).for_each(|j| term.add(leg.first + i + j, &[1.0], part));
            }
        }
        term
    }

    /// Returns the form of ∫ |q̈|²_S dt for a duration of 1.
    pub fn accelerations(stations: &Stations, weight: WeightMatrix) -> Self {
        let mut term = Self::zeros(stations, weight);
        for leg in &stations.legs {
            let stencil = BAND.min(leg.s.len());
            for (space, [s, rate, acceleration, time]) in leg.instants() {
                let from = space.saturating_sub(1).min(leg.s.len() - stencil);
                let w = weights(&leg.s[from..from + stencil], s);
                let c: [f64; BAND] = std::array::from_fn(|j| rate * rate * w[2][j] + acceleration * w[1][j]);
                term.add(leg.first + from, &c[..stencil], time);
            }
        }
        term
    }

    /// Returns a form in third derivatives that suppresses short waves. With `factor` = 1, a wave of
    /// [`SMOOTHING_WAVELENGTH`] intervals weighs as much as its rates.
    pub fn smooth(stations: &Stations, weight: WeightMatrix, factor: f64) -> Self {
        let mut term = Self::zeros(stations, weight);
        for leg in stations.legs.iter().filter(|leg| leg.s.len() >= BAND) {
            for i in 0..=leg.s.len() - BAND {
                let s = &leg.s[i..i + BAND];
                let h = (s[BAND - 1] - s[0]) / 3.0;
                let w = weights(s, 0.5 * (s[1] + s[2]));
                let wave = (SMOOTHING_WAVELENGTH * h / std::f64::consts::TAU).powi(4);
                term.add(leg.first + i, &w[3][..BAND], factor * wave * h / leg.share);
            }
        }
        term
    }
}

impl PostureCost {
    /// Returns the gradient at each station.
    pub fn gradient(&self, q: &[PerDrive]) -> Vec<PerDrive> {
        let n = self.centre.len();
        let mut all = vec![PerDrive::zeros(n); q.len()];
        let off: Vec<PerDrive> = q.iter().map(|q| q.minus(&self.centre)).collect();
        for term in &self.terms {
            let mut joined = vec![PerDrive::zeros(n); q.len()];
            for (i, row) in term.kappa.iter().enumerate() {
                for (j, kappa) in row.iter().enumerate().filter(|(_, kappa)| **kappa != 0.0) {
                    joined[i] = joined[i].plus(*kappa, &off[i + j]);
                    if j > 0 {
                        joined[i + j] = joined[i + j].plus(*kappa, &off[i]);
                    }
                }
            }
            for (all, joined) in all.iter_mut().zip(&joined) {
                *all = all.plus(1.0, &times(&term.weight, joined));
            }
        }
        all
    }

    /// Returns the value for given poses and their gradient.
    pub fn value(&self, q: &[PerDrive], gradient: &[PerDrive]) -> f64 {
        0.5 * q.iter().zip(gradient).map(|(q, g)| q.minus(&self.centre).dot(g)).sum::<f64>()
    }

    /// Returns the stiffness of a single pose: the trace of S times the median of κ_ii, per drive, summed over the
    /// terms.
    pub fn stiffness(&self) -> f64 {
        let of = |term: &CostTerm| {
            let trace: f64 = (0..MAX_DRIVES).map(|k| term.weight[k][k]).sum();
            let mut own: Vec<f64> = term.kappa.iter().map(|row| row[0]).collect();
            own.sort_by(f64::total_cmp);
            trace * own[own.len() / 2]
        };
        self.terms.iter().map(of).sum::<f64>() / self.centre.len() as f64
    }
}
