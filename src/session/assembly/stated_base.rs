//! [`StatedBase`]: the table `[base]` of a scenario of an assembly.

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};
use toml::Table;

use stillbase_settings::key::{Key, KeyType};
use stillbase_settings::keyed::{ANY_NUMBER, HasKeyType, keyed};
use stillbase_settings::number::counted;
use stillbase_settings::range::Range;
use stillbase_simulation::plant::BaseKind;

keyed! {
    /// A base in six directions, as a file states it.
    #[derive(Clone, Debug, PartialEq)]
    pub struct StatedBase at "base" {
        /// How the base of the assembly is held: it cannot move, it stands on springs and dampers, or it floats.
        kind: BaseKind = "fixed";
        /// Mass of the base without its blocks.
        mass: Option<f64> = Key::REQUIRED, range: Range::new(1e-9, 1e9, "kg"), when: WHEN_MOVING => StatedBase::moves;
        /// Inertia of the base about its own centre of mass, in its axes: three moments, or nine numbers row by row.
        inertia: Option<NumberList<3, 9>> = Key::REQUIRED, range: Range::either_way(1e9, "kg m²"),
            when: WHEN_MOVING => StatedBase::moves;
        /// Centre of mass of the base, from its origin in its axes.
        com: [f64; 3] = "0,0,0", range: Range::either_way(1e6, "m"), when: WHEN_MOVING => StatedBase::moves;
        /// Momentum of base and blocks, which is kept, in axes of space.
        momentum: [f64; 3] = "0,0,0", range: Range::either_way(1e9, "kg m/s"),
            when: WHEN_FREE => |base| base.kind == BaseKind::Free;
        /// Angular momentum of base and blocks about the common centre of mass, which is kept, in axes of space.
        angular_momentum: [f64; 3] = "0,0,0", range: Range::either_way(1e9, "kg m²/s"),
            when: WHEN_FREE => |base| base.kind == BaseKind::Free;
        /// Springs at the origin of the base, along and about x, y, z: six numbers, or all 36 row by row.
        stiffness: Option<NumberList<6, 36>> = Key::REQUIRED, range: Range::either_way(1e9, "N/m, N m/rad"),
            when: WHEN_COMPLIANT => |base| base.kind == BaseKind::Compliant;
        /// Dampers at the origin of the base, along and about x, y, z: six numbers, or all 36 row by row.
        damping: Option<NumberList<6, 36>> = Key::NONE, range: Range::either_way(1e9, "N s/m, N m s"),
            instead: "nothing damps the base", when: WHEN_COMPLIANT => |base| base.kind == BaseKind::Compliant;
    }
}

const WHEN_MOVING: &str = "base.kind = free or compliant: a fixed base does not move";
const WHEN_FREE: &str = "base.kind = free";
const WHEN_COMPLIANT: &str = "base.kind = compliant";

impl StatedBase {
    /// Returns whether the base can move.
    fn moves(&self) -> bool {
        self.kind != BaseKind::Fixed
    }

    /// Returns those keys of the table of the base of which its kind has no use.
    pub(super) fn idle(&self, stated: &Table) -> Table {
        let idle = stated.iter().filter(|(key, _)| !self.uses(key));
        idle.map(|(key, value)| (key.clone(), value.clone())).collect()
    }
}

/// A or B numbers.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(transparent)]
pub struct NumberList<const A: usize, const B: usize>(pub Vec<f64>);

impl<const A: usize, const B: usize> HasKeyType for NumberList<A, B> {
    const HOLDS: KeyType = KeyType::EitherList([A, B], ANY_NUMBER);
}

impl<'de, const A: usize, const B: usize> Deserialize<'de> for NumberList<A, B> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let numbers = Vec::deserialize(from)?;
        match numbers.len() {
            count if [A, B].contains(&count) => Ok(Self(numbers)),
            count => Err(D::Error::custom(format!("has {}", counted(count, "number")))),
        }
    }
}
