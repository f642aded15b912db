//! Why recording a case stopped.

use super::store::StoreError;
use crate::session::Refusal;

/// Why a case was not recorded.
#[derive(Debug)]
pub enum Stop {
    /// It cannot run.
    Refused {
        /// Which.
        scenario: String,
        /// Why.
        refusal: Refusal,
    },
    /// The pictures asked for cannot be.
    #[cfg_attr(not(feature = "render"), expect(dead_code, reason = "nothing to draw them with"))]
    Pictures(String),
    /// It cannot be written.
    Store(StoreError),
}

impl<E: Into<StoreError>> From<E> for Stop {
    fn from(error: E) -> Self {
        Self::Store(error.into())
    }
}
