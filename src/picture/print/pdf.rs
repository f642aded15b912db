//! Writes a page as PDF, with outlines in place of fonts.

use std::io::Write as _;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use pdf_writer::types::LineJoinStyle;
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, TextStr};

use super::page::{POINTS_PER_MM, Page};
use super::shape::{Paint, PathStep, Shape};
use crate::scene::Rgba;

/// Returns the bytes of the PDF file; equal pages give equal bytes.
pub fn pdf(page: &Page) -> Vec<u8> {
    let [catalog, tree, sheet, content, about] = [1, 2, 3, 4, 5].map(Ref::new);
    let shapes = page.shapes();
    let opacities = opacities(&shapes);
    let scale = page.point_mm * POINTS_PER_MM;
    let [width, height] = page.size.map(|side| side * scale);
    let mut pdf = Pdf::new();
    pdf.catalog(catalog).pages(tree);
    pdf.pages(tree).kids([sheet]).count(1);
    let mut own = pdf.page(sheet);
    own.media_box(Rect::new(0.0, 0.0, width, height)).parent(tree).contents(content);
    let mut resources = own.resources();
    let mut states = resources.ext_g_states();
    for (i, name) in (0..).zip(state_names(opacities.len())) {
        states.pair(Name(name.as_bytes()), Ref::new(6 + i));
    }
    states.finish();
    resources.finish();
    own.finish();
    for (i, opacity) in (0..).zip(&opacities) {
        pdf.ext_graphics(Ref::new(6 + i)).stroking_alpha(*opacity).non_stroking_alpha(*opacity);
    }
    let mut info = pdf.document_info(about);
    info.title(TextStr(&page.title)).subject(TextStr(&page.made)).creator(TextStr("Stillbase"));
    info.finish();
    let drawn = drawn(&shapes, &opacities, [scale, height]);
    match deflated(&drawn) {
        Some(packed) => _ = pdf.stream(content, &packed).filter(Filter::FlateDecode),
        None => _ = pdf.stream(content, &drawn),
    }
    pdf.finish()
}

fn deflated(bytes: &[u8]) -> Option<Vec<u8>> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes).ok()?;
    encoder.finish().ok()
}

fn opacity(shape: &Shape) -> f32 {
    let (Paint::Fill([.., a]) | Paint::FillEvenOdd([.., a]) | Paint::Stroke { colour: [.., a], .. }) = shape.paint;
    a
}

/// Returns the opacities that shapes have, each once.
fn opacities(shapes: &[Shape]) -> Vec<f32> {
    let mut all: Vec<f32> = Vec::new();
    for own in shapes.iter().map(opacity) {
        if !all.contains(&own) {
            all.push(own);
        }
    }
    all
}

fn state_names(count: usize) -> Vec<String> {
    (1..=count).map(|i| format!("A{i}")).collect()
}

fn drawn(shapes: &[Shape], opacities: &[f32], [scale, height]: [f32; 2]) -> Vec<u8> {
    let names = state_names(opacities.len());
    let mut content = Content::new();
    // From here on y points down, as in the figures.
    content.transform([scale, 0.0, 0.0, -scale, 0.0, height]);
    content.set_line_join(LineJoinStyle::RoundJoin);
    for shape in shapes {
        content.save_state();
        if let Some([left, top, right, bottom]) = shape.clip {
            content.rect(left, top, right - left, bottom - top).clip_nonzero().end_path();
        }
        if let Some(i) = opacities.iter().position(|known| *known == opacity(shape)) {
            content.set_parameters(Name(names[i].as_bytes()));
        }
        if let Paint::Stroke { colour: [r, g, b, _], width, dash } = shape.paint {
            content.set_stroke_rgb(r, g, b).set_line_width(width);
            if let Some(lengths) = dash {
                content.set_dash_pattern(lengths, 0.0);
            }
        }
        if let Paint::Fill(colour) | Paint::FillEvenOdd(colour) = shape.paint {
            let [r, g, b, _]: Rgba = colour;
            content.set_fill_rgb(r, g, b);
        }
        outline(&mut content, &shape.steps);
        match shape.paint {
            Paint::Fill(_) => content.fill_nonzero(),
            Paint::FillEvenOdd(_) => content.fill_even_odd(),
            Paint::Stroke { .. } => content.stroke(),
        };
        content.restore_state();
    }
    content.finish().into_vec()
}

fn outline(content: &mut Content, steps: &[PathStep]) {
    for step in steps {
        match *step {
            PathStep::Move([x, y]) => content.move_to(x, y),
            PathStep::Line([x, y]) => content.line_to(x, y),
            PathStep::Cubic([ax, ay], [bx, by], [x, y]) => content.cubic_to(ax, ay, bx, by, x, y),
            PathStep::Close => content.close_path(),
        };
    }
}
