//! Writes a figure as SVG.

use std::fmt::Write as _;

use super::figure::{Figure, FigureItem, FigureText};
use crate::report::markup::escaped;
use crate::scene::Rgba;

/// Returns the text of the SVG file.
pub fn svg(figure: &Figure) -> String {
    format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{}", svg_element(figure, "axes"))
}

/// Returns the element of a drawing within a page; `id` names the rectangle that clips its curves.
pub fn svg_element(figure: &Figure, id: &str) -> String {
    let [width, height] = figure.size;
    let mut text = String::new();
    let _ = writeln!(
        text,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} \
         {height}\" font-family=\"Inter, DejaVu Sans, Verdana, sans-serif\">"
    );
    let [left, top, right, bottom] = figure.axes.sides;
    let _ = writeln!(text, "<clipPath id=\"{id}\">{}</clipPath>", rect([left, top, right, bottom + 4.0], ""));
    let _ = writeln!(text, "{}", rect([0.0, 0.0, width, height], &paint("fill", figure.background)));
    for item in &figure.items {
        let _ = writeln!(text, "{}", element(item, id));
    }
    text + "</svg>\n"
}

fn rect([left, top, right, bottom]: [f32; 4], paint: &str) -> String {
    let (width, height) = (right - left, bottom - top);
    format!("<rect x=\"{left:.2}\" y=\"{top:.2}\" width=\"{width:.2}\" height=\"{height:.2}\"{paint}/>")
}

/// Returns the attributes of a colour; `what` is `fill` or `stroke`.
fn paint(what: &str, [r, g, b, a]: Rgba) -> String {
    let [r, g, b] = [r, g, b].map(|x| (255.0 * x).round() as u8);
    let opacity = if a < 1.0 { format!(" {what}-opacity=\"{a:.3}\"") } else { String::new() };
    format!(" {what}=\"#{r:02x}{g:02x}{b:02x}\"{opacity}")
}

fn element(item: &FigureItem, id: &str) -> String {
    match item {
        FigureItem::Line { points, width, colour, dash, inside } => {
            let mut places = String::new();
            for [x, y] in points {
                let _ = write!(places, "{x:.2},{y:.2} ");
            }
            let dash = dash.map_or_else(String::new, |[on, off]| format!(" stroke-dasharray=\"{on} {off}\""));
            let clip = if *inside { format!(" clip-path=\"url(#{id})\"") } else { String::new() };
            format!(
                "<polyline points=\"{}\" fill=\"none\" stroke-width=\"{width}\" stroke-linejoin=\"round\"{}{dash}{clip}/>",
                places.trim_end(),
                paint("stroke", *colour)
            )
        }
        FigureItem::Dot { at: [x, y], radius, colour } => {
            format!("<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{radius}\"{}/>", paint("fill", *colour))
        }
        FigureItem::Area { loops, colour, inside } => {
            let mut path = String::new();
            for points in loops {
                for (i, [x, y]) in points.iter().enumerate() {
                    let _ = write!(path, "{}{x:.2} {y:.2}", if i == 0 { 'M' } else { 'L' });
                }
                path.push('Z');
            }
            let clip = if *inside { format!(" clip-path=\"url(#{id})\"") } else { String::new() };
            format!("<path d=\"{path}\" fill-rule=\"evenodd\"{}{clip}/>", paint("fill", *colour))
        }
        FigureItem::Rectangle { sides, colour } => rect(*sides, &paint("fill", *colour)),
        FigureItem::Text { at: [x, y], anchor: [across, down], words } => {
            let size = words.iter().fold(0.0_f32, |most, w| most.max(w.size));
            // The baseline is 0.93 of the font size below the top of the text; a line is 1.16 of the font size high.
            let base = y + size * (0.93 - 1.16 * down);
            let anchor = if *across == 0.0 {
                "start"
            } else if *across == 1.0 {
                "end"
            } else {
                "middle"
            };
            let spans: String = words.iter().map(span).collect();
            format!("<text x=\"{x:.2}\" y=\"{base:.2}\" text-anchor=\"{anchor}\" xml:space=\"preserve\">{spans}</text>")
        }
    }
}

fn span(words: &FigureText) -> String {
    let weight = if words.bold { " font-weight=\"bold\"" } else { "" };
    let text = escaped(&words.text);
    format!("<tspan font-size=\"{}\"{weight}{}>{text}</tspan>", words.size, paint("fill", words.colour))
}
