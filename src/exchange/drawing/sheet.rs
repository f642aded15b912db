//! [`Sheet`]: every link of a machine laid out flat, in rows, without overlap.
//!
//! Lengths are mm, x to the right and y up from the lower left corner of the sheet. A link lies with its axis along x,
//! its root to the left of its tip.

use super::layout::laid_out;
use super::outline::{Corner, PieceOutline, pieces_of};
use super::piece::Piece;
use crate::cut::{Cut, CutError};
use stillbase_mechanics::machine::Machine;

/// A drawing as plain shapes.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// Its title.
    pub title: String,
    /// Width and height, mm.
    pub size: [f64; 2],
    /// Its shapes, in the order in which they are painted.
    pub shapes: Vec<SheetShape>,
}

/// A shape on the sheet, mm.
#[derive(Clone, Debug, PartialEq)]
pub enum SheetShape {
    /// The outline of a link: a horizontal bar with round ends.
    Bar {
        /// Centre of its left end.
        from: [f64; 2],
        /// Distance to the centre of its right end.
        length: f64,
        /// Radius of its ends, half its width.
        radius: f64,
        /// The drive that it follows, counted from 0.
        drive: usize,
        /// The layer of its link; `None` if links lie in no layers.
        layer: Option<usize>,
    },
    /// The outline of a part.
    Outline {
        /// Its corners, counter-clockwise.
        corners: Vec<Corner>,
        /// The drive that it follows, counted from 0.
        drive: usize,
        /// The layer of its link; `None` if links lie in no layers.
        layer: Option<usize>,
    },
    /// A hole.
    Hole {
        /// Its centre.
        at: [f64; 2],
        /// Its radius.
        radius: f64,
        /// The layer of its link; `None` if links lie in no layers.
        layer: Option<usize>,
    },
    /// The outline of a counterweight that is half a ring or a box.
    Weight {
        /// Its corners, counter-clockwise.
        corners: Vec<Corner>,
        /// The drive that it follows, counted from 0.
        drive: usize,
        /// The layer of its link; `None` if links lie in no layers.
        layer: Option<usize>,
    },
    /// The outline of a counterweight that is a disc or a ring.
    Disc {
        /// Its centre.
        at: [f64; 2],
        /// Its radius.
        radius: f64,
        /// Its inner radius; 0 for a disc.
        inner_radius: f64,
        /// The drive that it follows, counted from 0.
        drive: usize,
        /// The layer of its link; `None` if links lie in no layers.
        layer: Option<usize>,
    },
    /// A thin line.
    Line([[f64; 2]; 2]),
    /// A centre of mass.
    Mark {
        /// Its centre.
        at: [f64; 2],
        /// Radius of its symbol.
        radius: f64,
    },
    /// A line of text.
    Words {
        /// Position of its anchor on the baseline.
        at: [f64; 2],
        /// Approximate height of its capitals.
        height: f64,
        /// The point of the text that lies at this position.
        anchor: TextAlign,
        /// Its emphasis.
        paint: TextEmphasis,
        /// Its content.
        text: String,
    },
}

/// The point of a text that is at its position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TextAlign {
    /// Its left end.
    Start,
    /// Its middle.
    Middle,
}

/// Emphasis of a text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TextEmphasis {
    /// For a name.
    Strong,
    /// For all other text.
    Plain,
}

impl Sheet {
    /// Draws all links of a machine.
    ///
    /// # Errors
    /// If the links cannot be cut with these dimensions.
    pub fn of(machine: &Machine, cut: &Cut) -> Result<Self, CutError> {
        cut.check(machine)?;
        let longest = machine.resolved_links().iter().map(|part| part.length).fold(0.0, f64::max);
        let height = (1e3 * longest / 140.0).clamp(3.5, 10.0);
        let layers = cut.layers_of(machine);
        let links = 0..machine.links().len();
        let pieces = links.flat_map(|j| {
            let layer = layers.as_ref().map(|layers| layers[j]);
            match pieces_of(machine, j) {
                outlines if outlines.is_empty() => vec![Piece::of(machine, cut, (j, layer), height)],
                outlines => {
                    let of = |(k, outline): (usize, &PieceOutline)| {
                        Piece::of_part(machine, cut, (j, layer), outline, k == 0, height)
                    };
                    outlines.iter().enumerate().map(of).collect()
                }
            }
        });
        let pieces = pieces.collect();
        Ok(laid_out(machine, cut, pieces, height))
    }
}

impl SheetShape {
    /// Returns whether the shape is a bar or an outline that contains a point, apart from its round ends.
    pub(super) fn is_around(&self, [x, y]: [f64; 2]) -> bool {
        match self {
            Self::Bar { from, length, radius, .. } => {
                (from[0]..=from[0] + length).contains(&x) && (y - from[1]).abs() <= *radius
            }
            Self::Outline { corners, .. } => {
                let sides = corners.iter().zip(corners.iter().cycle().skip(1)).map(|(a, b)| (a.at, b.at));
                // Even and odd numbers of sides to the right of the point.
                let crossed = sides
                    .filter(|(a, b)| (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]));
                crossed.count() % 2 == 1
            }
            _ => false,
        }
    }

    pub(super) fn shift(&mut self, [x, y]: [f64; 2]) {
        let move_it = |p: &mut [f64; 2]| *p = [p[0] + x, p[1] + y];
        match self {
            Self::Bar { from, .. } => move_it(from),
            Self::Outline { corners, .. } | Self::Weight { corners, .. } => {
                corners.iter_mut().for_each(|corner| move_it(&mut corner.at))
            }
            Self::Hole { at, .. } | Self::Disc { at, .. } | Self::Mark { at, .. } | Self::Words { at, .. } => {
                move_it(at)
            }
            Self::Line(ends) => ends.iter_mut().for_each(move_it),
        }
    }
}
