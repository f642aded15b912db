//! [`DriveValues`]: one number for all drives, or one for each.

use serde::{Deserialize, Serialize};

use stillbase_mechanics::planar::PerDrive;
use stillbase_settings::key::KeyType;
use stillbase_settings::keyed::{ANY_NUMBER, DefaultFromText, HasKeyType};
use stillbase_settings::range::RangeCheck;

/// One number for all drives, or one for each.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "want one number for all drives, or a list with one for each")]
pub enum DriveValues {
    /// One number for all drives.
    All(f64),
    /// One number for each drive, in order.
    Own(PerDrive),
}

impl Default for DriveValues {
    fn default() -> Self {
        Self::All(0.0)
    }
}

impl HasKeyType for DriveValues {
    const HOLDS: KeyType = KeyType::PerDrive(ANY_NUMBER);
}

impl DefaultFromText for DriveValues {
    fn typed(default: &str) -> Self {
        Self::All(f64::typed(default))
    }
}

impl DriveValues {
    /// Returns the values of `n` drives; a list that is too short is extended with its last value.
    pub fn of(&self, n: usize) -> PerDrive {
        PerDrive::from_fn(n, |k| match self {
            Self::All(x) => *x,
            Self::Own(list) => list.get(k).or(list.last()).copied().unwrap_or(0.0),
        })
    }

    /// Returns all given values.
    pub fn values(&self) -> Vec<f64> {
        match self {
            Self::All(x) => vec![*x],
            Self::Own(list) => list.to_vec(),
        }
    }

    /// Returns whether this is one number for all drives, or a list of `n`.
    pub fn fits(&self, n: usize) -> bool {
        matches!(self, Self::All(_)) || self.values().len() == n
    }

    /// Returns a failed check of the setting `key` if this is a list whose length is not `n`.
    pub fn misfit(&self, n: usize, key: &'static str) -> Option<RangeCheck> {
        let count = self.values().len();
        (!self.fits(n))
            .then(|| RangeCheck::count(key, count, "number", format!("one for all drives, or {n}, one for each")))
    }

    /// Returns a copy for `n` drives with the value of drive `k` changed; equal values become one number.
    #[must_use]
    pub fn with(&self, n: usize, k: usize, value: f64) -> Self {
        let mut list = self.of(n);
        if let Some(slot) = list.get_mut(k) {
            *slot = value;
        }
        match list.iter().all(|x| *x == value) {
            true => Self::All(value),
            false => Self::Own(list),
        }
    }

    /// Returns the value as a file states it: a number or a list.
    pub fn to_value(self) -> toml::Value {
        match self {
            Self::All(x) => x.into(),
            Self::Own(list) => list.to_vec().into(),
        }
    }
}
