//! The answer of `stillbase import`.

use serde::Serialize;

use super::judge::{Account, Proposal};

#[derive(Serialize)]
pub(super) struct Answer {
    pub(super) file: String,
    pub(super) machine: String,
    /// `drives` or `tip`.
    pub(super) content: &'static str,
    pub(super) samples: usize,
    pub(super) start: f64,
    pub(super) duration: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) smoothed_at: Option<f64>,
    /// Greatest change of a sample by smoothing, rad or m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) smoothed_by: Option<f64>,
    /// How far the second derivative of each column can be trusted, rad/s² or m/s².
    pub(super) uncertainty: Vec<f64>,
    /// Least and greatest b of the samples themselves, rad: the spline between them may go beyond; none for the end
    /// effector.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) b_samples: Option<[f64; 2]>,
    /// For the end effector: with minimum-norm rates; none where these cannot follow.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) given: Option<Account>,
    pub(super) feasible: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) reason: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) proposal: Option<Proposal>,
}
