//! Drawings of machines: bars from pin to pin in one reference pose, motors on pins, and what makes them a machine.
//!
//! A [`Sketch`] is plain data and may be incomplete. [`Sketch::with`] applies one [`SketchStep`], everything that a
//! person does to a drawing; [`resolve`] recognises parallelograms, lists what is missing with steps that mend it, and
//! makes the [`Machine`](crate::machine::Machine) once nothing is. [`Sketch::of`] draws a machine, and [`snap`] helps
//! the hand.
//!
//! # Mass
//! A new bar is made of a drawn part, which reaches over its pins and has a hole for each; typed numbers overrule parts,
//! as in a machine file, and a bar without either is slender. Where a bar becomes longer, what reaches from its root to
//! its tip grows with it, and what lies at a pin follows that pin; else parts, lumps and counterweights stay where they
//! are. A bar that is split divides what it has, and one that is joined keeps it: in the straight pose mass, centre of
//! mass and inertia stay, but for round ends at the cut.
//!
//! # The family
//! Every bar stays parallel to the arm of one drive. So loops are parallelograms, or sums of parallelograms.

mod apply;
mod body;
mod classes;
mod division;
mod drawing;
mod emit;
mod ends;
mod graph;
mod joining;
mod lengths;
mod limits;
mod loops;
mod mends;
mod missing;
mod motors;
mod moving;
mod parts;
mod posing;
mod recount;
mod refusal;
mod removal;
mod resolve;
mod snap;
mod step;
mod stock;
mod template;
mod trace;
mod valid;
mod weights;

pub use body::Body;
pub use drawing::{Bar, BarId, EndEffector, Motor, Pin, PinId, Place, Sketch};
pub use limits::LimitArc;
pub use loops::{LoopShape, LoopState};
pub use mends::Mend;
pub use missing::{Lack, Missing};
pub use refusal::SketchRefusal;
pub use resolve::{Follow, Resolved, resolve};
pub use snap::{Onto, Snap, SnapOptions, snap};
pub use step::{BarEnd, SketchStep};
pub use template::Template;
