//! Paints the items of a figure with egui.

use egui::text::{LayoutJob, TextFormat};
use egui::{Align, Painter, Pos2, Rect, Shape, Stroke, Vec2, vec2};

use super::{bold, colour, plain};
use crate::charts::figure::{Axes, Figure, FigureItem};
use crate::print::glyphs;
use crate::scene::fill;

/// Paints items; their coordinates are relative to `origin`.
pub fn items(painter: &Painter, origin: Pos2, axes: &Axes, items: &[FigureItem]) {
    let [left, top, right, bottom] = axes.clip();
    let at = |[x, y]: [f32; 2]| origin + vec2(x, y);
    let within = Rect::from_min_max(at([left, top]), at([right, bottom]));
    let inner = painter.with_clip_rect(within.intersect(painter.clip_rect()));
    for item in items {
        match item {
            FigureItem::Line { points, width, colour: tone, dash, inside } => {
                let points: Vec<Pos2> = points.iter().map(|p| at(*p)).collect();
                let stroke = Stroke::new(*width, colour(*tone));
                let painter = if *inside { &inner } else { painter };
                match dash {
                    None => _ = painter.add(Shape::line(points, stroke)),
                    Some([on, off]) => painter.extend(Shape::dashed_line(&points, stroke, *on, *off)),
                }
            }
            FigureItem::Dot { at: place, radius, colour: tone } => {
                painter.circle_filled(at(*place), *radius, colour(*tone));
            }
            FigureItem::Area { loops, colour: tone, inside } => {
                let wide = |line: &Vec<[f32; 2]>| line.iter().map(|p| p.map(f64::from)).collect::<Vec<_>>();
                let filled = fill::mesh(&loops.iter().map(wide).collect::<Vec<_>>());
                let mut mesh = egui::Mesh::default();
                filled.positions.iter().for_each(|[x, y, _]| mesh.colored_vertex(at([*x, *y]), colour(*tone)));
                filled.triangles.iter().for_each(|[a, b, c]| mesh.add_triangle(*a, *b, *c));
                let painter = if *inside { &inner } else { painter };
                painter.add(Shape::mesh(mesh));
            }
            FigureItem::Rectangle { sides: [left, top, right, bottom], colour: tone } => {
                painter.rect_filled(Rect::from_min_max(at([*left, *top]), at([*right, *bottom])), 0.0, colour(*tone));
            }
            FigureItem::Text { at: place, anchor: [across, down], words } => {
                let mut job = LayoutJob::default();
                for words in words {
                    for (piece, is_index) in glyphs::pieces(&words.text) {
                        let size = if is_index { glyphs::INDEX_SIZE * words.size } else { words.size };
                        let font = if words.bold { bold(size) } else { plain(size) };
                        let valign = if is_index { Align::BOTTOM } else { Align::Center };
                        let format = TextFormat { valign, ..TextFormat::simple(font, colour(words.colour)) };
                        job.append(&piece, 0.0, format);
                    }
                }
                let galley = painter.layout_job(job);
                let from = at(*place) - vec2(*across, *down) * galley.size();
                painter.galley(from, galley, egui::Color32::PLACEHOLDER);
            }
        }
    }
}

/// Paints a whole figure with its background; `corner` is its upper left corner.
pub fn paint_figure(painter: &Painter, corner: Pos2, figure: &Figure) {
    let [width, height] = figure.size;
    painter.rect_filled(Rect::from_min_size(corner, Vec2::new(width, height)), 0.0, colour(figure.background));
    items(painter, corner, &figure.axes, &figure.items);
}
