//! [`PerDrive`], one number for each drive, and [`DriveAngles`].

use std::ops::{Deref, DerefMut};

use serde::{Deserialize, Serialize};

use super::{Vector, unit};
use stillbase_settings::number::counted;

/// Maximum number of drives of a machine.
pub const MAX_DRIVES: usize = 8;

/// One number for each drive, without allocation. It dereferences to a slice with one element for each drive.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(into = "Vec<f64>", try_from = "Vec<f64>")]
pub struct PerDrive {
    len: usize,
    values: [f64; MAX_DRIVES],
}

impl PerDrive {
    /// Zero for each of `n` drives.
    ///
    /// # Panics
    /// If `n` exceeds [`MAX_DRIVES`]; a [`Machine`](crate::machine::Machine) never does.
    #[inline]
    pub fn zeros(n: usize) -> Self {
        assert!(n <= MAX_DRIVES, "at most {MAX_DRIVES} drives");
        Self { len: n, values: [0.0; MAX_DRIVES] }
    }

    /// The value of `f` for each of `n` drives, counted from 0.
    #[inline]
    pub fn from_fn(n: usize, f: impl FnMut(usize) -> f64) -> Self {
        let mut v = Self::zeros(n);
        v.iter_mut().zip((0..n).map(f)).for_each(|(v, x)| *v = x);
        v
    }

    /// The values of the first `n` drives.
    #[inline]
    #[must_use]
    pub fn first(&self, n: usize) -> Self {
        if self.len == n { *self } else { Self::from_fn(n, |k| self[k]) }
    }

    /// A copy of a slice, or `None` if the slice has more than [`MAX_DRIVES`] elements.
    pub fn from_slice(values: &[f64]) -> Option<Self> {
        (values.len() <= MAX_DRIVES).then(|| Self::from_fn(values.len(), |k| values[k]))
    }

    /// Σ_k a_k b_k.
    #[inline]
    pub fn dot(&self, other: &[f64]) -> f64 {
        // Plain loops are also fast in unoptimised builds.
        let (count, mut sum, mut k) = (self.len.min(other.len()), 0.0, 0);
        while k < count {
            sum += self.values[k] * other[k];
            k += 1;
        }
        sum
    }

    /// self + factor · other.
    #[inline]
    #[must_use]
    pub fn plus(&self, factor: f64, other: &Self) -> Self {
        let mut v = *self;
        let mut k = 0;
        while k < MAX_DRIVES {
            v.values[k] += factor * other.values[k];
            k += 1;
        }
        v
    }

    /// factor · self.
    #[inline]
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let mut v = *self;
        let mut k = 0;
        while k < MAX_DRIVES {
            v.values[k] *= factor;
            k += 1;
        }
        v
    }

    /// self − other.
    #[inline]
    #[must_use]
    pub fn minus(&self, other: &Self) -> Self {
        let mut v = *self;
        let mut k = 0;
        while k < MAX_DRIVES {
            v.values[k] -= other.values[k];
            k += 1;
        }
        v
    }

    /// The largest magnitude, 0 for no drives.
    pub fn max_abs(&self) -> f64 {
        self.iter().fold(0.0, |m, x| m.max(x.abs()))
    }

    /// The padded array: zero beyond the last drive.
    #[inline]
    pub fn padded(&self) -> &[f64; MAX_DRIVES] {
        &self.values
    }
}

impl PerDrive {
    /// Returns the first N elements of the padded array.
    #[inline]
    pub fn array<const N: usize>(&self) -> &[f64; N] {
        const { assert!(N <= MAX_DRIVES) }
        &self.values.as_chunks().0[0]
    }

    /// Returns the first N elements of the padded array, mutable.
    #[inline]
    pub fn array_mut<const N: usize>(&mut self) -> &mut [f64; N] {
        const { assert!(N <= MAX_DRIVES) }
        &mut self.values.as_chunks_mut().0[0]
    }

    /// Makes one from the first `n` elements of an array; its other elements must be zero.
    #[inline]
    pub fn of_array<const N: usize>(n: usize, values: [f64; N]) -> Self {
        Self { len: n, ..Self::from(values) }
    }
}

impl<const N: usize> From<[f64; N]> for PerDrive {
    #[inline]
    fn from(values: [f64; N]) -> Self {
        const { assert!(N <= MAX_DRIVES) }
        let mut padded = [0.0; MAX_DRIVES];
        padded[..N].copy_from_slice(&values);
        Self { len: N, values: padded }
    }
}

impl From<PerDrive> for Vec<f64> {
    fn from(v: PerDrive) -> Self {
        v.to_vec()
    }
}

impl TryFrom<Vec<f64>> for PerDrive {
    type Error = String;
    fn try_from(v: Vec<f64>) -> Result<Self, String> {
        Self::from_slice(&v)
            .ok_or_else(|| format!("{}, where a machine has at most {MAX_DRIVES} drives", counted(v.len(), "number")))
    }
}

impl Deref for PerDrive {
    type Target = [f64];
    #[inline]
    fn deref(&self) -> &[f64] {
        &self.values[..self.len]
    }
}

impl DerefMut for PerDrive {
    #[inline]
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.values[..self.len]
    }
}

impl PartialEq for PerDrive {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

/// Absolute drive angles q_k, rad: never wrapped, because turning one drive by 2π changes b by 2π λ_k.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct DriveAngles(pub PerDrive);

impl DriveAngles {
    /// e(q_k) of every drive; after the last that of the ground, 1.
    #[inline]
    pub fn units(&self) -> UnitVectors {
        let mut e = [Vector::new(0.0, 0.0); MAX_DRIVES];
        for (e, &q) in e.iter_mut().zip(self.0.iter()) {
            *e = unit(q);
        }
        if let Some(ground) = e.get_mut(self.0.len()) {
            *ground = GROUND_UNIT;
        }
        e
    }
}

impl<const N: usize> From<[f64; N]> for DriveAngles {
    fn from(values: [f64; N]) -> Self {
        Self(values.into())
    }
}

impl Deref for DriveAngles {
    type Target = [f64];
    #[inline]
    fn deref(&self) -> &[f64] {
        &self.0
    }
}

/// Unit vector of links that keep their orientation.
const GROUND_UNIT: Vector = Vector::new(1.0, 0.0);

/// Returns the unit vectors of drives, with that of the ground after the last.
#[inline]
pub fn with_ground<const N: usize>(drives: &[Vector; N]) -> UnitVectors {
    let mut e = [Vector::new(0.0, 0.0); MAX_DRIVES];
    e[..N].copy_from_slice(drives);
    if let Some(ground) = e.get_mut(N) {
        *ground = GROUND_UNIT;
    }
    e
}

/// The unit vectors e(q_k): the only trigonometric functions that the dynamics needs.
pub type UnitVectors = [Vector; MAX_DRIVES];
