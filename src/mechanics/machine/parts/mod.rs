//! Parts of links: bars and plates of a material, and lumps such as motors. From them follow mass, centre of mass and
//! inertia of a link.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | m | mass, or area or volume of a body of density 1 | kg |
//! | d | distance between two centres of mass | m |
//! | I | inertia about the body's own centre of mass; two bodies have I₁ + I₂ + d² m₁ m₂ / (m₁ + m₂) | kg m² |

mod bars;
mod body;
mod cylinder;
mod derived;
mod hole;
mod material;
mod part;
mod polygon;
mod section;
mod weigh;

pub use bars::BarStock;
pub use body::PlaneBody;
pub use cylinder::Cylinder;
pub use derived::{DerivedNumbers, LinkNumber};
pub use material::{MATERIALS, Material};
pub use part::{Ends, Hole, Lump, Part, Shape};
pub use weigh::{PartBody, PartSource};

pub(super) use derived::LinkInFile;
pub(crate) use weigh::{sum_of, weigh};
