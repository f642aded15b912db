//! [`LinkPart`]: a link of one of several blocks, with what a mass on it does to the drives of all of them.

use super::units::Units;
use crate::assembly::Assembly;
use crate::machine::{Chain, ResolvedLink};

/// Distances up to this, in the unit of length, are rounding of directions in space.
const ROUNDING: f64 = 1e-12;

/// A link, in the units of the problem.
pub(super) struct LinkPart {
    /// The block to which it belongs.
    pub block: usize,
    /// The drive that it follows, counted through all blocks.
    pub drive: usize,
    /// Direction of the link: +1 along e(q), −1 against it.
    pub sign: f64,
    /// Positions of pins along it.
    pub pins: Vec<f64>,
    /// Coefficients of the position of its root, for the drives of all blocks. A mass on it also moves with the end
    /// effectors of the blocks that carry its own.
    pub root: Vec<f64>,
    /// The link within its block.
    pub own: ResolvedLink,
    /// Height of its masses along the axis of its block.
    pub height: f64,
    /// The blocks that carry its own.
    pub carriers: Vec<Carrier>,
}

/// A block that carries others.
pub(super) struct Carrier {
    pub block: usize,
    /// Coefficients of its end effector.
    pub end: Chain,
    /// Where the carried link is from the end effector, along x and y of the plane of the carrier.
    pub beside: [f64; 2],
    /// Height of the carried link along the axis of the carrier, from its mount.
    pub height: f64,
}

impl LinkPart {
    /// Returns the links of all blocks, in their order.
    pub fn all(whole: &Assembly, units: Units) -> Vec<Self> {
        let drives: usize = whole.blocks().iter().map(|block| block.machine.drives()).sum();
        let first = |block: usize| -> usize { whole.blocks()[..block].iter().map(|own| own.machine.drives()).sum() };
        let cleaned = |x: f64| if (x / units.length).abs() > ROUNDING { x / units.length } else { 0.0 };
        let mut all = Vec::new();
        for (i, block) in whole.blocks().iter().enumerate() {
            for (link, resolved) in block.machine.links().iter().zip(block.machine.resolved_links()) {
                let own = units.link(resolved);
                let mut root = vec![0.0; drives];
                let mut enter = |block: usize, chain: &Chain, n: usize| {
                    let from = first(block);
                    root[from..from + n].copy_from_slice(&chain[..n]);
                };
                enter(i, &own.root, block.machine.drives());
                // From the platform on which the block below sits up to the link.
                let mut above = block.mount.axes.column(2) * link.axial;
                let (mut carriers, mut held) = (Vec::new(), block);
                while let Some(on) = held.mount.on {
                    let carrier = &whole.blocks()[on];
                    above += held.mount.at;
                    let end = carrier.inertia.end_effector.map(|x| x / units.length);
                    enter(on, &end, carrier.machine.drives());
                    let beside = carrier.mount.in_plane(&above);
                    let up = carrier.mount.axes.column(2).into_owned();
                    carriers.push(Carrier {
                        block: on,
                        end,
                        beside: [cleaned(beside.re), cleaned(beside.im)],
                        height: cleaned(carrier.platform_height() + up.dot(&above)),
                    });
                    above += up * carrier.platform_height();
                    held = carrier;
                }
                all.push(Self {
                    block: i,
                    drive: first(i) + own.drive,
                    sign: own.sign,
                    pins: own.pins.clone(),
                    root,
                    height: link.axial / units.length,
                    carriers,
                    own,
                });
            }
        }
        all
    }
}
