//! Stillbase.
pub mod scene;
