//! [`Made`]: which making of a run its frames are of, so that who keeps something of them knows what is still true.

use std::sync::Arc;

/// How many changes back are remembered.
const REMEMBERED: usize = 8;

/// As long as it is the same, frames are only added to those that are known.
#[derive(Clone, Debug)]
pub struct Made {
    own: Arc<()>,
    /// Earlier ones, and how many of their first frames are still the same.
    before: Vec<(Arc<()>, usize)>,
}

impl Made {
    /// Another one than all before.
    #[allow(clippy::new_without_default, reason = "each is another one")]
    pub fn new() -> Self {
        Self { own: Arc::new(()), before: Vec::new() }
    }

    /// What it becomes where frames change, all but the first so many.
    #[must_use]
    pub fn changed_after(&self, kept: usize) -> Self {
        let older = self.before.iter().map(|(made, count)| (made.clone(), kept.min(*count)));
        let before = std::iter::once((self.own.clone(), kept)).chain(older).take(REMEMBERED).collect();
        Self { own: Arc::new(()), before }
    }

    /// How many of the first frames are those of an earlier one; none where nothing is known of it.
    pub fn kept_of(&self, earlier: &Self) -> usize {
        if self == earlier {
            return usize::MAX;
        }
        self.before.iter().find(|(made, _)| Arc::ptr_eq(made, &earlier.own)).map_or(0, |(_, count)| *count)
    }
}

impl PartialEq for Made {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.own, &other.own)
    }
}
