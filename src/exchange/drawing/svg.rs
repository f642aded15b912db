//! A sheet as SVG at scale 1 : 1: a unit of the drawing is a millimetre.

use super::outline::Corner;
use super::sheet::{Sheet, SheetShape, TextAlign, TextEmphasis};
use crate::xml::{XmlWriter, quoted};
use stillbase_settings::number::fixed;

/// Colours of the drives, as the window shows them on white.
const COLOURS: [&str; 8] = ["#0072b2", "#c2410c", "#047857", "#a86d00", "#9c4f86", "#7a7100", "#1d4f91", "#5b6270"];
const INK: &str = "#1d2129";
const DIM: &str = "#6b7280";

/// Returns the text of the file.
pub fn svg(sheet: &Sheet) -> String {
    let [width, height] = sheet.size.map(|x| fixed(x, 2));
    let mut lines = XmlWriter::default();
    lines.add(0, format_args!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>"));
    lines.add(
        0,
        format_args!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}mm\" height=\"{height}mm\" viewBox=\"0 0 {width} \
             {height}\" font-family=\"Inter, DejaVu Sans, Verdana, sans-serif\" stroke-linecap=\"round\">"
        ),
    );
    lines.add(1, format_args!("<title>{}</title>", quoted(&sheet.title)));
    lines.add(1, format_args!("<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>"));
    for shape in &sheet.shapes {
        element(&mut lines, shape, sheet.size[1]);
    }
    lines.add(0, format_args!("</svg>"));
    lines.into_text()
}

/// Writes a length in mm with three decimals, that is, to a micrometre.
fn n(x: f64) -> String {
    fixed(x, 3)
}

fn element(lines: &mut XmlWriter, shape: &SheetShape, top: f64) {
    let at = |[x, y]: [f64; 2]| [n(x), n(top - y)];
    match shape {
        SheetShape::Bar { from, length, radius, drive, .. } => {
            let [x, y] = at([from[0] - radius, from[1] + radius]);
            let (width, height, r, colour) =
                (n(length + 2.0 * radius), n(2.0 * radius), n(*radius), COLOURS[drive % COLOURS.len()]);
            lines.add(
                1,
                format_args!(
                    "<rect class=\"outline\" x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" rx=\"{r}\" \
                     fill=\"{colour}\" fill-opacity=\"0.14\" stroke=\"{colour}\" stroke-width=\"0.5\"/>"
                ),
            );
        }
        SheetShape::Outline { corners, drive, .. } => {
            let colour = COLOURS[drive % COLOURS.len()];
            let path = path(corners, top);
            lines.add(
                1,
                format_args!(
                    "<path class=\"outline\" d=\"{path}\" fill=\"{colour}\" fill-opacity=\"0.14\" \
                     stroke=\"{colour}\" stroke-width=\"0.5\"/>"
                ),
            );
        }
        SheetShape::Hole { at: centre, radius, .. } => {
            let ([x, y], r) = (at(*centre), n(*radius));
            let round = format!("cx=\"{x}\" cy=\"{y}\" r=\"{r}\"");
            lines.add(
                1,
                format_args!(
                    "<circle class=\"hole\" {round} fill=\"#ffffff\" stroke=\"{INK}\" stroke-width=\"0.35\"/>"
                ),
            );
        }
        SheetShape::Disc { at: centre, radius, inner_radius, drive, .. } => {
            let ([x, y], colour) = (at(*centre), COLOURS[drive % COLOURS.len()]);
            for (radius, fill) in [(radius, colour), (inner_radius, "none")].into_iter().filter(|(r, _)| **r > 0.0) {
                let round = format!("cx=\"{x}\" cy=\"{y}\" r=\"{}\"", n(*radius));
                lines.add(
                    1,
                    format_args!(
                        "<circle class=\"counterweight\" {round} fill=\"{fill}\" fill-opacity=\"0.08\" \
                         stroke=\"{colour}\" stroke-width=\"0.5\"/>"
                    ),
                );
            }
        }
        SheetShape::Weight { corners, drive, .. } => {
            let (path, colour) = (path(corners, top), COLOURS[drive % COLOURS.len()]);
            lines.add(
                1,
                format_args!(
                    "<path class=\"counterweight\" d=\"{path}\" fill=\"{colour}\" fill-opacity=\"0.08\" \
                     stroke=\"{colour}\" stroke-width=\"0.5\"/>"
                ),
            );
        }
        SheetShape::Line([from, to]) => {
            let ([x1, y1], [x2, y2]) = (at(*from), at(*to));
            lines.add(
                1,
                format_args!(
                    "<line x1=\"{x1}\" y1=\"{y1}\" x2=\"{x2}\" y2=\"{y2}\" stroke=\"{DIM}\" stroke-width=\"0.25\"/>"
                ),
            );
        }
        SheetShape::Mark { at: centre, radius } => mark(lines, at(*centre), *radius),
        SheetShape::Words { at: place, height, anchor, paint, text } => {
            let ([x, y], text) = (at(*place), quoted(text));
            let (weight, fill) = match paint {
                TextEmphasis::Strong => (" font-weight=\"600\"", INK),
                TextEmphasis::Plain => ("", DIM),
            };
            let anchor = match anchor {
                TextAlign::Start => "",
                TextAlign::Middle => " text-anchor=\"middle\"",
            };
            // The height of capitals is about 0.72 of the font size.
            let size = n(height / 0.72);
            lines.add(
                1,
                format_args!(
                    "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\"{weight}{anchor} fill=\"{fill}\">{text}</text>"
                ),
            );
        }
    }
}

/// Returns a closed outline as data of a path; its curves are half circles.
fn path(corners: &[Corner], top: f64) -> String {
    let next = corners.iter().cycle().skip(1);
    let mut path = String::new();
    for (i, (corner, next)) in corners.iter().zip(next).enumerate() {
        let [x, y] = [n(corner.at[0]), n(top - corner.at[1])];
        if i == 0 {
            path.push_str(&format!("M{x} {y}"));
        }
        let [x, y] = [n(next.at[0]), n(top - next.at[1])];
        if corner.bulge == 0.0 {
            path.push_str(&format!("L{x} {y}"));
        } else {
            let radius = n(0.5 * (next.at[0] - corner.at[0]).hypot(next.at[1] - corner.at[1]));
            let sweep = i32::from(corner.bulge < 0.0);
            path.push_str(&format!("A{radius} {radius} 0 0 {sweep} {x} {y}"));
        }
    }
    path + "Z"
}

/// Draws the symbol of a centre of mass: a circle with two filled quadrants.
fn mark(lines: &mut XmlWriter, [x, y]: [String; 2], radius: f64) {
    let r = n(radius);
    let quarter = format!("M0 0V-{r}A{r} {r} 0 0 1 {r} 0ZM0 0V{r}A{r} {r} 0 0 1 -{r} 0Z");
    lines.add(1, format_args!("<g class=\"centre-of-mass\" transform=\"translate({x} {y})\">"));
    lines.add(2, format_args!("<circle r=\"{r}\" fill=\"#ffffff\" stroke=\"{INK}\" stroke-width=\"0.35\"/>"));
    lines.add(2, format_args!("<path d=\"{quarter}\" fill=\"{INK}\"/>"));
    lines.add(1, format_args!("</g>"));
}
