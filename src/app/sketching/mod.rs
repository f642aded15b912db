//! Drawing a machine in the design view: tools of the pointer, the card of a bar, and what is still missing.

mod bubble;
mod by_numbers;
mod card;
mod facts;
pub mod fields;
mod hand;
mod limits;
mod lump;
mod lump_hand;
mod missing;
mod motors;
mod panel;
mod pen;
mod pin_list;
mod rail;
mod scene;
mod section;
mod typed;
pub mod waits;

pub use card::{NumberField, renamed};
pub use facts::SketchFacts;
pub use panel::{balance_waits, show as panel};
pub use pen::{Pen, PenChange, PenTool};
pub use rail::show as rail;
pub use scene::{SketchScene, show};

use super::widgets::undoable_edit;
use super::{Command, ViewChange};
use stillbase_mechanics::sketch::{Sketch, SketchStep};
use stillbase_session::Edit;

/// Sends a step of drawing; a step that does not fit is told where it does not.
fn draw(sketch: &Sketch, step: SketchStep, commands: &mut Vec<Command>) {
    let step = step.plainly();
    match sketch.with(&step) {
        Ok(_) => {
            undoable_edit(commands, Edit::Sketch(step));
            commands.push(ViewChange::Pen(PenChange::Taken).into());
        }
        Err(refusal) => commands.push(ViewChange::Pen(PenChange::Refuse(refusal)).into()),
    }
}
