//! [`Advice`]: a sentence that may name remedies. The interface that shows it supplies their names, such as an option
//! of a command or a control of a panel.

use std::fmt::{self, Display};

use serde::ser::{Serialize, Serializer};

/// A remedy that a sentence may name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Remedy {
    /// Let the spline through samples bridge gaps in time.
    Gaps,
    /// Smooth the samples.
    Smoothing,
    /// Smooth the samples; the name may include a placeholder for the cut-off frequency, Hz.
    CutOff,
    /// Another pose constant.
    PoseConstant,
    /// The curves that a machine's end effector can follow at a pose constant.
    Workspace,
    /// A design that balances the machine.
    Design,
    /// A check of where the machine is not balanced.
    Check,
}

impl Remedy {
    /// Returns the default name.
    fn name(self) -> &'static str {
        match self {
            Self::Gaps => "gaps let pass",
            Self::Smoothing | Self::CutOff => "smoothing",
            Self::PoseConstant => "b",
            Self::Workspace => "its workspace",
            Self::Design => "a design",
            Self::Check => "a check",
        }
    }
}

/// A sentence that may name remedies.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Advice {
    pieces: Vec<Piece>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Piece {
    Text(String),
    Remedy(Remedy),
}

impl Advice {
    /// Appends text.
    #[must_use]
    pub fn then(mut self, text: impl Into<String>) -> Self {
        self.pieces.push(Piece::Text(text.into()));
        self
    }

    /// Inserts text at the beginning.
    #[must_use]
    pub fn after(mut self, text: impl Into<String>) -> Self {
        self.pieces.insert(0, Piece::Text(text.into()));
        self
    }

    /// Appends the name of a remedy.
    #[must_use]
    pub fn name(mut self, remedy: Remedy) -> Self {
        self.pieces.push(Piece::Remedy(remedy));
        self
    }

    /// Iterates over the remedies that the sentence names, in their order.
    pub fn remedies(&self) -> impl Iterator<Item = Remedy> {
        self.pieces.iter().filter_map(|piece| match piece {
            Piece::Text(_) => None,
            Piece::Remedy(remedy) => Some(*remedy),
        })
    }

    /// Returns the sentence with other names for its remedies.
    #[must_use]
    pub fn worded(&self, name: impl Fn(Remedy) -> &'static str) -> Self {
        let text = self.pieces.iter().map(|piece| match piece {
            Piece::Text(text) => text.as_str(),
            Piece::Remedy(remedy) => name(*remedy),
        });
        text.collect::<String>().into()
    }
}

impl From<String> for Advice {
    fn from(text: String) -> Self {
        Self::default().then(text)
    }
}

impl From<&str> for Advice {
    fn from(text: &str) -> Self {
        Self::default().then(text)
    }
}

/// The sentence with the default names of its remedies.
impl Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.pieces.iter().try_for_each(|piece| match piece {
            Piece::Text(text) => f.write_str(text),
            Piece::Remedy(remedy) => f.write_str(remedy.name()),
        })
    }
}

/// Serialised as text.
impl Serialize for Advice {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}
