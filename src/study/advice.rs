//! [`Advice`]: a sentence that may name ways out. Whoever shows it names them by what is at hand there: an option of a
//! command, a control of a panel.

use std::fmt::{self, Display};

use serde::ser::{Serialize, Serializer};

/// A way out that a sentence names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Remedy {
    /// To let the spline through samples bridge gaps in time.
    Gaps,
    /// To smooth samples.
    Smoothing,
    /// The same by its cut-off, Hz.
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
    /// What it is, where nobody has another name for it.
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

/// A sentence that may name ways out.
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
    /// More of the sentence.
    #[must_use]
    pub fn then(mut self, text: impl Into<String>) -> Self {
        self.pieces.push(Piece::Text(text.into()));
        self
    }

    /// The same after some words.
    #[must_use]
    pub fn after(mut self, text: impl Into<String>) -> Self {
        self.pieces.insert(0, Piece::Text(text.into()));
        self
    }

    /// A way out, named next in the sentence.
    #[must_use]
    pub fn name(mut self, remedy: Remedy) -> Self {
        self.pieces.push(Piece::Remedy(remedy));
        self
    }

    /// The ways out that it names, in their order.
    pub fn remedies(&self) -> impl Iterator<Item = Remedy> {
        self.pieces.iter().filter_map(|piece| match piece {
            Piece::Text(_) => None,
            Piece::Remedy(remedy) => Some(*remedy),
        })
    }

    /// The sentence with other names for its ways out.
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

/// The sentence with plain names for its ways out.
impl Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.pieces.iter().try_for_each(|piece| match piece {
            Piece::Text(text) => f.write_str(text),
            Piece::Remedy(remedy) => f.write_str(remedy.name()),
        })
    }
}

/// As text.
impl Serialize for Advice {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}
