//! Pieces in rows on a sheet, below its title.

use super::lines::{mm, width_of};
use super::outline::pieces_of;
use super::piece::Piece;
use super::sheet::{Sheet, SheetShape, TextAlign, TextEmphasis};
use crate::cut::Cut;
use stillbase_mechanics::machine::Machine;
use stillbase_settings::number::{counted, fixed};

/// Arranges the pieces in rows from the top down, with a width that makes the sheet a little wider than high.
pub(super) fn laid_out(machine: &Machine, cut: &Cut, pieces: Vec<Piece>, height: f64) -> Sheet {
    let margin = 3.0 * height;
    let extent = |piece: &Piece| [piece.reach[2] - piece.reach[0], piece.reach[3] - piece.reach[1]];
    let gap = 2.5 * height;
    let area: f64 = pieces.iter().map(extent).map(|[across, up]| (across + gap) * (up + gap)).sum();
    let widest = pieces.iter().map(|piece| extent(piece)[0]).fold(0.0, f64::max);
    let title = title(machine, cut);
    let titled = title.iter().enumerate().map(|(i, line)| width_of(line, title_height(i, height))).fold(0.0, f64::max);
    let room = widest.max((1.5 * area).sqrt()).max(titled);
    let (mut shapes, mut y) = (Vec::new(), 0.0);
    for (i, text) in title.iter().enumerate() {
        let height = title_height(i, height);
        y -= if i == 0 { height } else { 1.9 * height };
        let paint = if i == 0 { TextEmphasis::Strong } else { TextEmphasis::Plain };
        shapes.push(SheetShape::Words { at: [0.0, y], height, anchor: TextAlign::Start, paint, text: text.clone() });
    }
    y -= height;
    let (mut across, mut row) = (0.0_f64, Vec::new());
    let mut right = titled;
    for piece in pieces {
        let width = extent(&piece)[0];
        if !row.is_empty() && across + width > room {
            y = put(&mut shapes, std::mem::take(&mut row), y - gap);
            across = 0.0;
        }
        row.push((across, piece));
        right = right.max(across + width);
        across += width + gap;
    }
    y = put(&mut shapes, row, y - gap);
    let size = [right + 2.0 * margin, 2.0 * margin - y];
    for shape in &mut shapes {
        shape.shift([margin, size[1] - margin]);
    }
    Sheet { title: machine.name().into(), size, shapes }
}

fn title_height(line: usize, height: f64) -> f64 {
    if line == 0 { 2.2 * height } else { height }
}

/// Returns the lines of the title.
fn title(machine: &Machine, cut: &Cut) -> [String; 3] {
    let links = counted(machine.links().len(), "link");
    let discs = match machine.spec().counterweights.len() {
        0 => String::new(),
        count => {
            let material = format!("{} kg/m³", fixed(cut.density, 0));
            format!(" · {} of {material}", counted(count, "counterweight"))
        }
    };
    let (bars, pins) = (mm(cut.bar_width), mm(cut.pin_diameter));
    let is_of_parts = |j: usize| !pieces_of(machine, j).is_empty();
    let outlines = match (0..machine.links().len()).all(is_of_parts) {
        true => "outlines and holes as they are weighed".into(),
        false => format!("bars {bars} wide with round ends · holes Ø {pins}"),
    };
    [
        machine.name().into(),
        format!("{links}{discs} · scale 1 : 1 · all lengths in mm"),
        format!("{outlines} · places along a link from its root towards its tip"),
    ]
}

/// Places pieces side by side below the height `top`, and returns the height of their lower edge.
fn put(shapes: &mut Vec<SheetShape>, row: Vec<(f64, Piece)>, top: f64) -> f64 {
    // The axes of all links in a row are at the same height.
    let up = row.iter().map(|(_, piece)| piece.reach[3]).fold(0.0, f64::max);
    let down = row.iter().map(|(_, piece)| piece.reach[1]).fold(0.0, f64::min);
    for (x, piece) in row {
        let by = [x - piece.reach[0], top - up];
        shapes.extend(piece.shapes.into_iter().map(|mut shape| {
            shape.shift(by);
            shape
        }));
    }
    top - up + down
}
