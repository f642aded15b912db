//! [`Motion`]: a path and a timing make the [`Reference`] that control follows.

use super::reference::Reference;
use crate::planning::curves::Path;
use crate::planning::timing::{Profile, TimeLaw};

/// A path run through once, from rest to rest unless it is given otherwise.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// The path that is followed.
    pub path: Path,
    /// How far along it the motion is at each time.
    pub profile: Profile,
}

impl Motion {
    /// A path by a law in a time T, s.
    pub fn new(path: Path, law: TimeLaw, duration: f64) -> Self {
        Self { path, profile: Profile::of(law, duration) }
    }

    /// T, s.
    #[inline]
    pub fn duration(&self) -> f64 {
        self.profile.duration()
    }

    /// Times after the start at which q̈ jumps or bends, s, in order: no step of a simulation should pass one.
    pub fn kinks(&self) -> Vec<f64> {
        let mut all = self.profile.kinks();
        all.extend(self.path.kinks().into_iter().map(|s| self.profile.when(s)));
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }

    /// The reference t seconds after the start; at rest before it and after T.
    #[inline]
    pub fn at(&self, t: f64) -> Reference {
        let p = self.profile.at(t);
        self.path.at(p.s).timed(&p)
    }
}
