//! [`Base`]: settings of the base of the machine.

use super::Wheel;
use stillbase_mechanics::arm_on_base::FloatingBase;
use stillbase_mechanics::planar::Vector;
use stillbase_settings::keyed::keyed;
use stillbase_settings::range::Range;
use stillbase_settings::word::words;

keyed! {
    /// The base of the machine.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Base at "base" {
        /// How the base is held: it cannot move, it stands on springs and dampers, or it floats as a spacecraft does.
        kind: BaseKind = "fixed", saved: always;
        /// Mass m_b of the base.
        mass: f64 = "40", range: Range::new(1e-9, 1e6, "kg"), when: WHEN_MOVING => Base::moves;
        /// Inertia I_b of the base about its own centre of mass.
        inertia: f64 = "3", range: Range::new(1e-9, 1e6, "kg m²"), when: WHEN_MOVING => Base::moves;
        /// Centre of mass ρ of the base, seen from the base pin along the base's own axes.
        com: [f64; 2] = "0,0", range: Range::either_way(1e3, "m"), when: WHEN_MOVING => Base::moves;
        /// Springs under the base: along x and y, and against turning.
        stiffness: [f64; 3] = "20000,20000,2000", range: Range::new(0.0, 1e9, "N/m, N m/rad"),
            when: WHEN_COMPLIANT => |base| base.kind == BaseKind::Compliant;
        /// Dampers under the base: along x and y, and against turning.
        damping: [f64; 3] = "200,200,10", range: Range::new(0.0, 1e9, "N s/m, N m s"),
            when: WHEN_COMPLIANT => |base| base.kind == BaseKind::Compliant;
        tables:
        /// A reaction wheel in the base.
        wheel: Option<Wheel>;
    }
}

const WHEN_MOVING: &str = "base.kind = free or compliant: a fixed base does not move";
const WHEN_COMPLIANT: &str = "base.kind = compliant";

words! {
    /// Kind of support of the base.
    pub enum BaseKind {
        Fixed = "fixed", "fixed", "It cannot move";
        Compliant = "compliant", "compliant", "On springs and dampers, preloaded so that the start is an equilibrium";
        Free = "free", "free", "It floats, as a spacecraft does";
    }
}

impl Base {
    /// Returns whether the base floats and turns whenever b changes: it is free, and has no wheel.
    pub fn floats(&self) -> bool {
        self.kind == BaseKind::Free && self.wheel.is_none()
    }

    /// Returns whether the moment that turns the base may differ from n_B: a wheel takes up a part, or the base is free and
    /// its centre of mass is off the base pin.
    pub fn feels_more_than_n_b(&self) -> bool {
        self.wheel.is_some() || (self.kind == BaseKind::Free && self.com != [0.0; 2])
    }

    /// Returns its mass, inertia and centre of mass.
    pub fn body(&self) -> FloatingBase {
        FloatingBase { mass: self.mass, inertia: self.inertia, com: Vector::new(self.com[0], self.com[1]) }
    }

    /// Returns whether the base can move.
    pub fn moves(&self) -> bool {
        self.kind != BaseKind::Fixed
    }
}
