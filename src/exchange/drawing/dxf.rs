//! A sheet as DXF of release 12, which every program for cutting reads: lines, circles, closed polylines and text, on
//! one layer for each purpose. A unit of the drawing is a millimetre.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::outline::Corner;
use super::sheet::{Sheet, SheetShape, TextAlign};
use stillbase_settings::number::fixed;

/// Layers of the drawing with their colour numbers: outlines to cut, holes to drill, discs, and annotations.
const OUTLINE: (&str, u8) = ("OUTLINE", 7);
const HOLES: (&str, u8) = ("HOLES", 5);
const COUNTERWEIGHT: (&str, u8) = ("COUNTERWEIGHT", 1);
const TEXT: (&str, u8) = ("TEXT", 8);

/// Returns the name of a layer of the drawing for links in a layer of the machine: `OUTLINE_2`.
fn named((name, _): (&str, u8), layer: Option<usize>) -> String {
    layer.map_or_else(|| name.to_owned(), |layer| format!("{name}_{layer}"))
}

/// Returns the layers of a drawing with their colour numbers. In a machine whose links lie in layers, each of these has
/// its own.
fn layers(sheet: &Sheet) -> Vec<(String, u8)> {
    let layer = |shape: &SheetShape| match shape {
        SheetShape::Bar { layer, .. }
        | SheetShape::Outline { layer, .. }
        | SheetShape::Hole { layer, .. }
        | SheetShape::Disc { layer, .. }
        | SheetShape::Weight { layer, .. } => *layer,
        SheetShape::Line(_) | SheetShape::Mark { .. } | SheetShape::Words { .. } => None,
    };
    let stacked: BTreeSet<usize> = sheet.shapes.iter().filter_map(layer).collect();
    let own = match stacked.is_empty() {
        true => vec![None],
        false => stacked.into_iter().map(Some).collect(),
    };
    let of_links = own
        .into_iter()
        .flat_map(|layer| [OUTLINE, HOLES, COUNTERWEIGHT].map(|purpose| (named(purpose, layer), purpose.1)));
    of_links.chain([(named(TEXT, None), TEXT.1)]).collect()
}

/// Returns the text of the file, in ASCII.
pub fn dxf(sheet: &Sheet) -> String {
    let mut out = Tags::default();
    out.header(sheet.size);
    out.tables(&layers(sheet));
    out.text(0, "SECTION");
    out.text(2, "ENTITIES");
    for shape in &sheet.shapes {
        out.shape(shape);
    }
    out.text(0, "ENDSEC");
    out.text(0, "EOF");
    out.out
}

/// Writes pairs of a group code and a value, each on its own line.
#[derive(Default)]
struct Tags {
    out: String,
}

impl Tags {
    fn text(&mut self, code: u16, value: &str) {
        // Writing to a `String` never fails.
        let _ = writeln!(self.out, "{code}\n{value}");
    }

    fn number(&mut self, code: u16, value: f64) {
        self.text(code, &fixed(value, 6));
    }

    fn count(&mut self, code: u16, value: u8) {
        self.text(code, &value.to_string());
    }

    fn point(&mut self, code: u16, [x, y]: [f64; 2]) {
        self.number(code, x);
        self.number(code + 10, y);
        self.number(code + 20, 0.0);
    }

    fn header(&mut self, size: [f64; 2]) {
        self.text(0, "SECTION");
        self.text(2, "HEADER");
        self.text(9, "$ACADVER");
        self.text(1, "AC1009");
        // Millimetres.
        self.text(9, "$INSUNITS");
        self.count(70, 4);
        self.text(9, "$EXTMIN");
        self.point(10, [0.0; 2]);
        self.text(9, "$EXTMAX");
        self.point(10, size);
        self.text(0, "ENDSEC");
    }

    fn tables(&mut self, layers: &[(String, u8)]) {
        self.text(0, "SECTION");
        self.text(2, "TABLES");
        self.table("LTYPE", 1);
        self.text(0, "LTYPE");
        self.text(2, "CONTINUOUS");
        self.count(70, 0);
        self.text(3, "Solid line");
        self.count(72, 65);
        self.count(73, 0);
        self.number(40, 0.0);
        self.text(0, "ENDTAB");
        self.table("LAYER", layers.len());
        for (name, colour) in layers {
            self.text(0, "LAYER");
            self.text(2, name);
            self.count(70, 0);
            self.count(62, *colour);
            self.text(6, "CONTINUOUS");
        }
        self.text(0, "ENDTAB");
        self.text(0, "ENDSEC");
    }

    fn table(&mut self, name: &str, count: usize) {
        self.text(0, "TABLE");
        self.text(2, name);
        self.text(70, &count.to_string());
    }

    fn entity(&mut self, kind: &str, layer: &str) {
        self.text(0, kind);
        self.text(8, layer);
    }

    fn circle(&mut self, layer: &str, at: [f64; 2], radius: f64) {
        self.entity("CIRCLE", layer);
        self.point(10, at);
        self.number(40, radius);
    }

    fn line(&mut self, [from, to]: [[f64; 2]; 2]) {
        self.entity("LINE", "TEXT");
        self.point(10, from);
        self.point(11, to);
    }

    /// Writes a closed outline of two straight sides and two half circles.
    fn bar(&mut self, on: &str, [x, y]: [f64; 2], length: f64, radius: f64) {
        let (right, low, high) = (x + length, y - radius, y + radius);
        let corners = [([x, low], 0.0), ([right, low], 1.0), ([right, high], 0.0), ([x, high], 1.0)];
        self.outline(on, &corners.map(|(at, bulge)| Corner { at, bulge }));
    }

    fn outline(&mut self, on: &str, corners: &[Corner]) {
        self.entity("POLYLINE", on);
        self.count(66, 1);
        self.point(10, [0.0; 2]);
        self.count(70, 1);
        for corner in corners {
            self.entity("VERTEX", on);
            self.point(10, corner.at);
            self.number(42, corner.bulge);
        }
        self.entity("SEQEND", on);
    }

    fn shape(&mut self, shape: &SheetShape) {
        match shape {
            SheetShape::Bar { from, length, radius, layer, .. } => {
                self.bar(&named(OUTLINE, *layer), *from, *length, *radius);
            }
            SheetShape::Outline { corners, layer, .. } => self.outline(&named(OUTLINE, *layer), corners),
            SheetShape::Hole { at, radius, layer } => self.circle(&named(HOLES, *layer), *at, *radius),
            SheetShape::Disc { at, radius, inner_radius, layer, .. } => {
                let circles = [radius, inner_radius].into_iter().filter(|radius| **radius > 0.0);
                circles.for_each(|radius| self.circle(&named(COUNTERWEIGHT, *layer), *at, *radius));
            }
            SheetShape::Weight { corners, layer, .. } => self.outline(&named(COUNTERWEIGHT, *layer), corners),
            SheetShape::Line(ends) => self.line(*ends),
            SheetShape::Mark { at: [x, y], radius: r } => {
                self.line([[x - r, *y], [x + r, *y]]);
                self.line([[*x, y - r], [*x, y + r]]);
            }
            SheetShape::Words { at, height, anchor, text, .. } => {
                self.entity("TEXT", "TEXT");
                self.point(10, *at);
                self.number(40, *height);
                self.text(1, &ascii(text));
                // Relative width, because letters of the default font are wide.
                self.number(41, 0.75);
                if *anchor == TextAlign::Middle {
                    self.count(72, 1);
                    self.point(11, *at);
                }
            }
        }
    }
}

/// Escapes text for a line of the file.
fn ascii(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            'Ø' => out.push_str("%%c"),
            '\u{2212}' => out.push('-'),
            '·' => out.push(','),
            '²' => out.push('2'),
            '³' => out.push('3'),
            c if c.is_control() => out.push(' '),
            c if c.is_ascii() => out.push(c),
            c => {
                let mut units = [0; 2];
                for unit in c.encode_utf16(&mut units) {
                    let _ = write!(out, "\\U+{unit:04X}");
                }
            }
        }
    }
    out
}
