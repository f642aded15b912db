//! [`Motion`]: a path with a timing, which yields the [`Reference`] that control follows.

use super::reference::Reference;
use crate::curves::Path;
use crate::timing::{Profile, TimeLaw};

/// A path traversed once, from rest to rest unless the profile says otherwise.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// The path.
    pub path: Path,
    /// The path parameter over time.
    pub profile: Profile,
}

impl Motion {
    /// Returns the motion along a path by a time law in a duration T, s.
    pub fn new(path: Path, law: TimeLaw, duration: f64) -> Self {
        Self { path, profile: Profile::of(law, duration) }
    }

    /// Duration T, s.
    #[inline]
    pub fn duration(&self) -> f64 {
        self.profile.duration()
    }

    /// Returns the times after the start at which q̈ or its slope jumps, s, ascending: no integration step should cross
    /// one.
    pub fn kinks(&self) -> Vec<f64> {
        let mut all = self.profile.kinks();
        all.extend(self.path.kinks().into_iter().map(|s| self.profile.time_at(s)));
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }

    /// Returns the reference t seconds after the start; at rest before the start and after T.
    #[inline]
    pub fn at(&self, t: f64) -> Reference {
        let p = self.profile.at(t);
        self.path.at(p.s).timed(&p)
    }
}
