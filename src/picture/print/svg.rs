//! Writes a page as SVG, with its size in millimetres.

use std::fmt::Write as _;

use super::page::Page;
use super::shape::{Paint, PathStep, Shape};
use crate::report::markup::escaped;
use crate::scene::Rgba;
use stillbase_settings::number::fixed;

/// Returns the text of the SVG file.
pub fn svg(page: &Page) -> String {
    let [width, height] = page.size;
    let mm = |points: f32| n(points * page.point_mm);
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let _ = writeln!(
        text,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}mm\" height=\"{}mm\" viewBox=\"0 0 {} {}\" role=\"img\">",
        mm(width),
        mm(height),
        n(width),
        n(height)
    );
    let _ = writeln!(text, "<title>{}</title>\n<desc>{}</desc>", escaped(&page.title), escaped(&page.made));
    let shapes = page.shapes();
    let mut clips: Vec<[f32; 4]> = Vec::new();
    for clip in shapes.iter().filter_map(|shape| shape.clip) {
        if !clips.contains(&clip) {
            clips.push(clip);
        }
    }
    for (i, [left, top, right, bottom]) in clips.iter().enumerate() {
        let [x, y, w, h] = [*left, *top, right - left, bottom - top].map(n);
        let _ = writeln!(
            text,
            "<clipPath id=\"axes-{}\"><rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\"/></clipPath>",
            i + 1
        );
    }
    for shape in &shapes {
        let clip = shape.clip.and_then(|clip| clips.iter().position(|known| *known == clip));
        let _ = writeln!(text, "{}", element(shape, clip));
    }
    text + "</svg>\n"
}

/// Writes a place in points with two decimals: to 4 µm.
fn place([x, y]: [f32; 2]) -> String {
    let [x, y] = [x, y].map(|x| short(x, 2));
    format!("{x} {y}")
}

/// Writes a length with three decimals.
fn n(x: f32) -> String {
    short(x, 3)
}

/// Writes a number without trailing zeros.
fn short(x: f32, decimals: usize) -> String {
    let text = fixed(f64::from(x), decimals);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

fn element(shape: &Shape, clip: Option<usize>) -> String {
    let mut path = String::new();
    for step in &shape.steps {
        let _ = match step {
            PathStep::Move(p) => write!(path, "M{}", place(*p)),
            PathStep::Line(p) => write!(path, "L{}", place(*p)),
            PathStep::Cubic(a, b, p) => write!(path, "C{} {} {}", place(*a), place(*b), place(*p)),
            PathStep::Close => write!(path, "Z"),
        };
    }
    let paint = match shape.paint {
        Paint::Fill(colour) => tone("fill", colour),
        Paint::FillEvenOdd(colour) => format!("{} fill-rule=\"evenodd\"", tone("fill", colour)),
        Paint::Stroke { colour, width, dash } => {
            let dash = dash.map_or_else(String::new, |lengths| {
                let [on, off] = lengths.map(n);
                format!(" stroke-dasharray=\"{on} {off}\"")
            });
            let stroke = tone("stroke", colour);
            format!(" fill=\"none\"{stroke} stroke-width=\"{}\" stroke-linejoin=\"round\"{dash}", n(width))
        }
    };
    let clip = clip.map_or_else(String::new, |i| format!(" clip-path=\"url(#axes-{})\"", i + 1));
    format!("<path d=\"{path}\"{paint}{clip}/>")
}

/// Returns the attributes of a colour; `what` is `fill` or `stroke`.
fn tone(what: &str, [r, g, b, a]: Rgba) -> String {
    let [r, g, b] = [r, g, b].map(|x| (255.0 * x).round() as u8);
    let opacity = if a < 1.0 { format!(" {what}-opacity=\"{}\"", n(a)) } else { String::new() };
    format!(" {what}=\"#{r:02x}{g:02x}{b:02x}\"{opacity}")
}
