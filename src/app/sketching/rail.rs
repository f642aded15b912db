//! The tools of drawing in the tool bar.

use egui::{Ui, Vec2};

use super::{Pen, PenChange, PenTool};
use crate::icon::IconButton;
use crate::{Command, ViewChange};
use stillbase_picture::scene::palette::Palette;

/// Draws the tools.
pub fn show(ui: &mut Ui, p: &Palette, pen: &Pen, size: Vec2, commands: &mut Vec<Command>) {
    for tool in PenTool::ALL {
        let (icon, label, effect) = tool.words();
        let tip = format!("{label}\n{effect}");
        let label = format!("draw: {label}");
        let button = IconButton { icon, label: &label, tip: &tip, on: Some(pen.tool == tool), enabled: true, size };
        if button.show(ui, p).clicked() {
            commands.push(ViewChange::Pen(PenChange::Tool(tool)).into());
        }
    }
}
