//! [`Form`]: in which a machine goes elsewhere, by the ending of a file's name.

use super::cut::{Cut, CutError};
use super::drawing::{Sheet, dxf, svg};
use super::mjcf::{MjcfError, mjcf};
use super::parts::Parts;
use super::urdf::urdf;
use crate::mechanics::machine::Machine;

/// In which a machine goes elsewhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// A model for MuJoCo.
    Mjcf,
    /// A model for ROS, Pinocchio and others.
    Urdf,
    /// Its links as a drawing to look at.
    Svg,
    /// Its links as a drawing to cut by.
    Dxf,
    /// Its parts, for a spreadsheet.
    Csv,
    /// Its parts, to read.
    Markdown,
}

/// Why a machine stays.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ExchangeError {
    /// MuJoCo could not move it.
    #[error(transparent)]
    Mjcf(#[from] MjcfError),
    /// It cannot be cut so.
    #[error(transparent)]
    Cut(#[from] CutError),
    /// Nothing is written under such a name.
    #[error("a name that ends in {ending:?}: want one that ends in .xml, .urdf, .svg, .dxf, .csv or .md")]
    Ending {
        /// As given.
        ending: String,
    },
}

impl Form {
    /// All of them.
    pub const ALL: [Self; 6] = [Self::Mjcf, Self::Urdf, Self::Svg, Self::Dxf, Self::Csv, Self::Markdown];
    /// How names of their files end, in the same order.
    pub const ENDINGS: [&str; 6] = ["xml", "urdf", "svg", "dxf", "csv", "md"];

    /// By how a name ends.
    ///
    /// # Errors
    /// If it ends in nothing that is written.
    pub fn of(ending: &str) -> Result<Self, ExchangeError> {
        let place = Self::ENDINGS.iter().position(|own| own.eq_ignore_ascii_case(ending));
        place.map(|i| Self::ALL[i]).ok_or_else(|| ExchangeError::Ending { ending: ending.chars().take(40).collect() })
    }

    /// The file's text; the pose, rad, is that of a keyframe.
    ///
    /// # Errors
    /// What stands in the way.
    pub fn written(self, machine: &Machine, pose: &[f64], cut: &Cut) -> Result<String, ExchangeError> {
        Ok(match self {
            Self::Mjcf => mjcf(machine, pose)?,
            Self::Urdf => urdf(machine),
            Self::Svg => svg(&Sheet::of(machine, cut)?),
            Self::Dxf => dxf(&Sheet::of(machine, cut)?),
            Self::Csv => Parts::of(machine, cut)?.csv(),
            Self::Markdown => Parts::of(machine, cut)?.markdown(),
        })
    }
}
