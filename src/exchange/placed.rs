//! [`Modelled`]: what a model for another program shows, a machine by itself or the blocks of an assembly, on one base.

use nalgebra::{Matrix3, Vector3};

use super::base_body::BaseBody;
use super::look::DRAWN_BAR_RADIUS;
use super::tree::Tree;
use super::xml::quoted;
use stillbase_mechanics::assembly::{Assembly, Block, Mount, SpatialBase};
use stillbase_mechanics::machine::{Machine, TransverseInertia};

/// Least inertia that is written for a body that moves, kg m²: MuJoCo treats less as none.
const LEAST_INERTIA: f64 = 1e-12;
/// Part of an inertia that a sum of moments may be off by.
const ROUNDING: f64 = 1e-14;

/// What a model shows.
pub struct Modelled<'a> {
    pub name: &'a str,
    /// Acceleration of gravity in axes of the base, m/s².
    pub gravity: [f64; 3],
    /// The base, if it floats.
    pub base: Option<FloatingBase<'a>>,
    /// The machine, or all blocks in the order of the file.
    pub machines: Vec<Placed<'a>>,
    /// Places of the machines: each after the one that carries it.
    pub order: Vec<usize>,
}

/// A base that floats.
pub enum FloatingBase<'a> {
    /// In the plane of its machine.
    Planar(&'a BaseBody),
    /// In space, with what rotors have too much taken off.
    Spatial(SpatialBase),
}

/// A machine in a model.
pub struct Placed<'a> {
    pub machine: &'a Machine,
    /// Its parts and their names.
    pub tree: Tree<'a>,
    /// Its block; `None` for a machine by itself.
    pub block: Option<&'a Block>,
    /// Machines on its platform.
    pub carries: Vec<usize>,
}

impl<'a> Modelled<'a> {
    /// Returns a machine by itself, on a base that floats if there is one.
    pub fn machine(machine: &'a Machine, base: Option<&'a BaseBody>) -> Self {
        let [x, y] = machine.spec().gravity;
        let tree = Tree::of(machine, String::new(), false);
        Self {
            name: &machine.spec().name,
            gravity: [x, y, 0.0],
            base: base.map(FloatingBase::Planar),
            machines: vec![Placed { machine, tree, block: None, carries: Vec::new() }],
            order: vec![0],
        }
    }

    /// Returns an assembly, on a base that floats if there is one.
    pub fn assembly(assembly: &'a Assembly, base: Option<&SpatialBase>) -> Self {
        let placed = |i: usize| {
            let (block, carries) = (&assembly.blocks()[i], assembly.carried_by(Some(i)).collect::<Vec<_>>());
            let tree = Tree::of(&block.machine, format!("{}/", quoted(&block.name)), !carries.is_empty());
            Placed { machine: &block.machine, tree, block: Some(block), carries }
        };
        Self {
            name: &assembly.name,
            gravity: assembly.gravity.into(),
            base: base.map(|base| FloatingBase::Spatial(lighter(assembly, base).unwrap_or_else(|| base.clone()))),
            machines: (0..assembly.blocks().len()).map(placed).collect(),
            order: assembly.order().to_vec(),
        }
    }

    /// Returns the machines on the base.
    pub fn on_base(&self) -> impl Iterator<Item = usize> {
        (0..self.machines.len()).filter(|i| self.machines[*i].mount().is_none_or(|mount| mount.on.is_none()))
    }

    /// Mass of all machines, kg.
    pub fn mass(&self) -> f64 {
        self.machines.iter().map(|of| of.machine.mass()).sum()
    }

    /// Returns place and directions of a block in the axes of what carries it, which are those of the base or of the
    /// plane of its carrier.
    pub fn seat(&self, mount: &Mount) -> (Vector3<f64>, Matrix3<f64>) {
        match mount.on.and_then(|on| self.machines[on].mount()) {
            // A platform keeps its orientation, so what it carries does not turn in its axes.
            Some(carrier) => (carrier.axes.tr_mul(&mount.at), carrier.axes.tr_mul(&mount.axes)),
            None => (mount.at, mount.axes),
        }
    }
}

impl FloatingBase<'_> {
    /// Returns the middle and the sides of the box that is drawn for it, m.
    pub fn drawn(&self) -> ([f64; 3], [f64; 3]) {
        match self {
            Self::Planar(base) => {
                let side = base.drawn_side();
                ([base.com.re, base.com.im, 0.0], [side, side, DRAWN_BAR_RADIUS])
            }
            // A cube with this mass and mean inertia.
            Self::Spatial(base) => (base.com.into(), [(2.0 * base.inertia.trace() / base.mass).sqrt(); 3]),
        }
    }
}

impl<'a> Placed<'a> {
    /// Where the block is; `None` for a machine by itself.
    pub fn mount(&self) -> Option<&'a Mount> {
        self.block.map(|block| &block.mount)
    }

    /// Returns the name of a part as it is told, with that of the block.
    pub fn told(&self, name: &str) -> String {
        self.block.map_or_else(|| name.to_owned(), |block| format!("{}/{name}", block.name))
    }

    /// Returns where the end effector is along its link, and its height over the plane, m. A machine by itself is flat.
    pub fn end(&self) -> [f64; 2] {
        let machine = self.machine;
        let part = &machine.resolved_links()[machine.end_link()];
        let height = self.block.map_or(0.0, |_| machine.spec().payload.axial);
        [machine.end_effector()[part.drive] - part.root[part.drive], height]
    }

    /// Returns the inertia of a link with its counterweights about the axes of the link, kg m².
    pub fn of_link(&self, j: usize) -> Matrix3<f64> {
        let (stated, inertia) = (self.machine.spec().links[j].states_transverse(), self.machine.links()[j].inertia);
        self.of_body(inertia, stated, || self.machine.link_transverse(j))
    }

    /// Returns the inertia of the payload about the axes of the link that holds it, kg m².
    pub fn of_payload(&self) -> Matrix3<f64> {
        let payload = self.machine.spec().payload;
        self.of_body(payload.inertia, payload.states_transverse(), || payload.transverse())
    }

    /// Returns the inertia of a body. In space all of it counts, as for [`SpatialBase`]. Of a machine by itself that does
    /// not state the rest only the last number counts, and any of at least half of it go with it.
    fn of_body(&self, inertia: f64, stated: bool, transverse: impl Fn() -> TransverseInertia) -> Matrix3<f64> {
        if self.block.is_none() && !stated {
            return Matrix3::from_diagonal(&Vector3::new(0.6 * inertia, 0.6 * inertia, inertia));
        }
        let TransverseInertia { along, across, product } = transverse();
        if along == 0.0 && product == 0.0 {
            return Matrix3::from_diagonal(&Vector3::new(inertia.min(LEAST_INERTIA), across, inertia));
        }
        // Of flat bodies rounding must not break the triangle inequality.
        let more = inertia.min(LEAST_INERTIA) + ROUNDING * inertia;
        Matrix3::new(along + more, -product, 0.0, -product, across + more, 0.0, 0.0, 0.0, inertia)
    }

    /// Returns the same of a rotor about the axes of its seat; in space it has the least that a body of this inertia can
    /// have about axes across its own.
    pub fn of_rotor(&self, inertia: f64) -> [f64; 3] {
        let share = if self.block.is_some() { 0.5 } else { 0.6 };
        [share * inertia, share * inertia, inertia]
    }
}

/// Returns a base without what rotors add in a model: they spin about the axes of their blocks alone, but no body has
/// inertia about one axis only. These axes stand still in the base, so the surplus is a constant of it. `None` if no body
/// has what is left.
pub fn lighter(assembly: &Assembly, base: &SpatialBase) -> Option<SpatialBase> {
    let mut inertia = base.inertia;
    for block in assembly.blocks() {
        let rotors = block.machine.spec().drives.iter().filter_map(|drive| drive.rotor);
        let (sum, axis) = (rotors.map(|rotor| rotor.inertia).sum::<f64>(), block.mount.axes.column(2));
        inertia -= 0.5 * sum * (Matrix3::identity() - axis * axis.transpose());
    }
    let mut own: [f64; 3] = inertia.symmetric_eigenvalues().into();
    own.sort_by(f64::total_cmp);
    let is_body = own[0] >= LEAST_INERTIA && own[0] + own[1] >= own[2];
    (is_body || inertia == base.inertia).then(|| SpatialBase { inertia, ..base.clone() })
}
