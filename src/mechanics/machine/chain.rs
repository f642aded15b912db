//! Points of a machine as sums of unit vectors.

use crate::planar::{MAX_DRIVES, UnitVectors, Vector};

/// A point as a sum of unit vectors: weight w_k, m, on e(q_k).
pub type Chain = [f64; MAX_DRIVES];

/// Returns the point of a chain, Σ_k w_k e(q_k), m.
pub fn place_of(chain: &Chain, e: &UnitVectors) -> Vector {
    chain.iter().zip(e).map(|(w, e)| e * *w).sum()
}
