//! Layers of a machine: an order in which its links can be stacked so that nothing runs into itself.
//!
//! Bars, plates, counterweights with their arms, lumps, the payload and pins are solids of a height. [`contact`](Contact)
//! finds which of them overlap in plan in some pose within the joint limits, or along a task. Overlapping solids of
//! different links lie in different layers, and no link lies between the links of a pin over which it passes. The search
//! finds an order with the fewest layers, and among those the one that tilts the base least; or the fewest links that
//! have no order, and where they meet. A motor has a shape if it is a lump.

mod clash;
mod clearance;
mod contact;
mod overlap;
mod plan;
mod range;
mod report;
mod request;
mod side_view;
mod stack;
mod tilt;
mod way;

pub use clash::Clash;
pub use clearance::Clearance;
pub use contact::{Between, Contact};
pub use overlap::TOLERANCE;
pub use report::{Change, LayersReport, LinkLayer};
pub use request::{Conflict, LayersAnswer, LayersQuery, LayersRequest, NoLayers, find_contacts, find_layers};
pub use side_view::{SidePin, SideRow, SideView};
pub use stack::MAX_LAYERS;
