//! Reasons why the recording of a case stops.

use super::store::StoreError;
use stillbase_session::Refusal;

/// Reasons why a case is not recorded.
#[derive(Debug)]
pub enum CaseError {
    /// The scenario cannot run.
    Refused {
        /// Name of the scenario.
        scenario: String,
        /// Reason.
        refusal: Refusal,
    },
    /// The requested pictures cannot be made.
    #[cfg_attr(not(feature = "render"), expect(dead_code, reason = "nothing to draw them with"))]
    Pictures(String),
    /// The recording cannot be written.
    Store(StoreError),
}

impl<E: Into<StoreError>> From<E> for CaseError {
    fn from(error: E) -> Self {
        Self::Store(error.into())
    }
}
