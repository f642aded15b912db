//! Typesetting of symbols with indices.

use std::sync::Arc;

use egui::text::{LayoutJob, TextFormat};
use egui::{Align, Color32, Galley, Ui};

use crate::theme::plain;
use stillbase_study::equations::{Level, pieces};

/// Size of an index, as a fraction of the size of its symbol.
const INDEX_SCALE: f32 = 0.74;

/// Lays out a symbol in a size and colour, wrapped at a width, points.
pub fn set(ui: &Ui, symbol: &str, size: f32, tone: Color32, width: f32) -> Arc<Galley> {
    let mut job = LayoutJob::default();
    for (text, level) in pieces(symbol) {
        let (size, valign) = match level {
            Level::Line => (size, Align::Center),
            Level::Index => (INDEX_SCALE * size, Align::BOTTOM),
            Level::Raised => (INDEX_SCALE * size, Align::TOP),
        };
        let font_id = plain(size);
        job.append(text, 0.0, TextFormat { font_id, color: tone, valign, ..TextFormat::default() });
    }
    job.wrap.max_width = width;
    ui.painter().layout_job(job)
}

/// Lays out plain text, wrapped at a width, points.
pub fn words(ui: &Ui, text: &str, size: f32, tone: Color32, width: f32) -> Arc<Galley> {
    ui.painter().layout(text.to_owned(), plain(size), tone, width)
}
