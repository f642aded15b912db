//! [`KeyPath`]: a place in a file, as a path of keys and positions.

use std::fmt;

use super::range::quote_clipped;

/// A place in a file: a path of keys and positions. It is printed in the syntax of `--set`, such as `link.5.mass`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct KeyPath(pub Vec<KeyStep>);

/// One step of a [`KeyPath`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum KeyStep {
    /// A key of a table.
    Key(String),
    /// A position in an array, counted from 0.
    At(usize),
    /// A position in an array, counted from 0, with the name of the element, which is printed instead.
    Named(usize, String),
}

impl KeyPath {
    /// Makes a place from its steps; numbers become positions.
    pub fn new(path: &[&dyn AsKeyStep]) -> Self {
        Self(path.iter().map(|s| s.step()).collect())
    }

    /// Makes a place from a key in the syntax of `--set`: parts joined by dots, positions in brackets, such as
    /// `task.via[3]`. Positions in brackets count from 1.
    pub fn of_key(key: &str) -> Self {
        let steps = key.split('.').flat_map(|part| {
            let (name, position) = part.split_once('[').unwrap_or((part, ""));
            let position = position.trim_end_matches(']').parse().ok().and_then(|i: usize| i.checked_sub(1));
            std::iter::once(KeyStep::Key(name.into())).chain(position.map(KeyStep::At))
        });
        Self(steps.collect())
    }

    /// Makes the place of a key in a table; without one it is the table.
    pub fn of(key: Option<&str>) -> Self {
        Self(key.map(|key| KeyStep::Key(key.into())).into_iter().collect())
    }

    /// Returns the same place relative to an outer table, in which the present table has the key `key`.
    #[must_use]
    pub fn under(self, key: &str) -> Self {
        Self(std::iter::once(KeyStep::Key(key.into())).chain(self.0).collect())
    }

    /// Returns the place with elements of lists by their positions, not by names.
    #[must_use]
    pub fn by_position(&self) -> Self {
        let step = |step: &KeyStep| match step {
            KeyStep::Named(i, _) => KeyStep::At(*i),
            step => step.clone(),
        };
        Self(self.0.iter().map(step).collect())
    }

    /// Returns the place of a key in the table at this place.
    #[must_use]
    pub fn key(&self, key: &str) -> Self {
        Self(self.0.iter().cloned().chain([KeyStep::Key(key.into())]).collect())
    }

    /// Returns the place of the table or list that holds this place; `None` for the whole file.
    pub fn parent(&self) -> Option<Self> {
        let (_, outer) = self.0.split_last()?;
        Some(Self(outer.to_vec()))
    }

    /// Returns the key that is its last step; `None` for a position and for the whole file.
    pub fn last_key(&self) -> Option<&str> {
        match self.0.last()? {
            KeyStep::Key(key) => Some(key),
            KeyStep::At(_) | KeyStep::Named(..) => None,
        }
    }

    /// Returns whether it fits a pattern of keys joined by dots, in which `*` stands for any one step. Positions fit
    /// only `*`.
    pub fn fits(&self, pattern: &str) -> bool {
        let mut words = pattern.split('.');
        let all = self.0.iter().all(|step| match (step, words.next()) {
            (_, Some("*")) => true,
            (KeyStep::Key(key), Some(word)) => key == word,
            _ => false,
        });
        all && words.next().is_none()
    }
}

/// Types that can be a step of a place.
pub trait AsKeyStep {
    /// Returns the step.
    fn step(&self) -> KeyStep;
}

impl AsKeyStep for &str {
    fn step(&self) -> KeyStep {
        KeyStep::Key((*self).into())
    }
}

impl AsKeyStep for String {
    fn step(&self) -> KeyStep {
        KeyStep::Key(self.clone())
    }
}

impl AsKeyStep for usize {
    fn step(&self) -> KeyStep {
        KeyStep::At(*self)
    }
}

impl fmt::Display for KeyPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let [KeyStep::Key(angle), KeyStep::Named(_, name), KeyStep::Key(end)] = &self.0[..]
            && angle == "angle"
            && ["min", "max"].contains(&end.as_str())
        {
            return write!(f, "limits.{} ({end})", quote_clipped(name));
        }
        for (i, step) in self.0.iter().enumerate() {
            match step {
                // The table is `lengths`, the key of one length begins with `length`.
                KeyStep::Key(k) if i == 0 && k == "lengths" => f.write_str("length")?,
                KeyStep::Key(k) if i == 0 => f.write_str(&quote_clipped(k))?,
                KeyStep::Key(name) | KeyStep::Named(_, name) => write!(f, ".{}", quote_clipped(name))?,
                KeyStep::At(i) => write!(f, "[{}]", i + 1)?,
            }
        }
        Ok(())
    }
}
