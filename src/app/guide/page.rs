//! Drawing of a page of the guide: headings, paragraphs with links, lists, tables, blocks of code.

use egui::text::LayoutJob;
use egui::{Color32, FontId, Frame, Key, Label, Link, Modifiers, RichText, ScrollArea, Stroke, TextFormat, Ui, vec2};

use super::document::{Block, Content, Document, Span, Target};
use super::{GuideStep, Scroll, picture, plain_words};
use crate::theme::{bold, code, colour, plain};
use crate::widgets::name;
use crate::{Command, ViewChange, WindowCommand};
use stillbase_picture::scene::palette::Palette;
use stillbase_query::Queries;

/// Sizes of text, of headings by level, and of code, points.
const TEXT_PT: f32 = 13.5;
const HEADING_PT: [f32; 3] = [22.0, 16.5, 14.0];
const CODE_PT: f32 = 12.0;
/// Indent of a list, and width of its markers, points.
const INDENT_PT: f32 = 18.0;
/// Gap between paragraphs, and between columns of a table, points.
const GAP_PT: f32 = 8.0;
const COLUMN_GAP_PT: f32 = 14.0;
/// Fraction of the height by which a key scrolls.
const PAGE_FRACTION: f32 = 0.85;
/// Width of a letter of tables on average, points, and the exponent that gives long columns less than their share.
const LETTER_PT: f32 = 6.9;
const COLUMN_POWER: f32 = 0.8;

/// Draws a page and scrolls to what is asked for; returns the distance of the display from the top, points.
pub fn show(
    ui: &mut Ui,
    p: &Palette,
    (queries, document): (&Queries, &Document),
    (anchor, scroll): (&str, Option<Scroll>),
    salt: &str,
    commands: &mut Vec<Command>,
) -> f32 {
    let mut area = ScrollArea::vertical().id_salt(("guide", salt)).auto_shrink(false);
    if let Some(Scroll::Offset(offset)) = scroll {
        area = area.vertical_scroll_offset(offset);
    } else if scroll == Some(Scroll::Anchor) && anchor.is_empty() {
        area = area.vertical_scroll_offset(0.0);
    }
    let shown = area.show(ui, |ui| {
        ui.set_width(ui.available_width() - 14.0);
        ui.style_mut().interaction.selectable_labels = true;
        ui.spacing_mut().item_spacing = vec2(0.0, 3.0);
        let page = PAGE_FRACTION * ui.clip_rect().height();
        for (key, down) in [(Key::PageDown, -page), (Key::PageUp, page)] {
            if ui.input_mut(|i| i.consume_key(Modifiers::NONE, key)) {
                ui.scroll_with_delta(vec2(0.0, down));
            }
        }
        for (i, block) in document.blocks.iter().enumerate() {
            let heading = draw(ui, p, queries, (block, i), commands);
            let is_here = matches!(&block.content, Content::Heading(_, own, _) if own == anchor);
            if is_here && scroll == Some(Scroll::Anchor) {
                ui.scroll_to_rect_animation(heading, Some(egui::Align::TOP), egui::style::ScrollAnimation::none());
            }
        }
        ui.add_space(40.0);
    });
    shown.state.clamped_offset().y
}

/// Draws a block; returns its rectangle.
fn draw(
    ui: &mut Ui,
    p: &Palette,
    queries: &Queries,
    (block, i): (&Block, usize),
    commands: &mut Vec<Command>,
) -> egui::Rect {
    let indent = INDENT_PT * block.depth as f32;
    let shown = match &block.content {
        Content::Heading(level, _, spans) => {
            let size = HEADING_PT[level.saturating_sub(1).min(HEADING_PT.len() - 1)];
            ui.add_space(if *level == 1 { 0.0 } else { 14.0 });
            let job = job(spans, p, |_| bold(size), colour(p.ink));
            ui.add(Label::new(job).wrap())
        }
        Content::Text(spans) => {
            let shown = ui.horizontal_top(|ui| {
                if block.depth > 0 {
                    ui.add_space(indent - INDENT_PT);
                    let marker = block.marker.as_deref().unwrap_or_default();
                    let (at, _) = ui.allocate_exact_size(vec2(INDENT_PT, 16.0), egui::Sense::hover());
                    let pos = at.left_top() + vec2(2.0, 1.0);
                    ui.painter().text(pos, egui::Align2::LEFT_TOP, marker, plain(TEXT_PT), colour(p.dim));
                }
                ui.vertical(|ui| text(ui, p, spans, TEXT_PT, commands));
            });
            shown.response
        }
        Content::Code(kind, text) => block_of_code(ui, p, kind, text, (indent, i)),
        Content::Table(rows) => ui.push_id(i, |ui| table(ui, p, rows, commands)).response,
        Content::Picture(picture, spans) => {
            let shown = picture::show(ui, queries, picture, spans);
            let caption = RichText::new(plain_words(spans)).font(plain(TEXT_PT - 1.5)).color(colour(p.dim));
            let caption = ui.add(Label::new(caption).wrap());
            shown.map_or(caption.clone(), |shown| shown.union(caption))
        }
    };
    let is_item = block.depth > 0;
    ui.add_space(if is_item { 2.0 } else { GAP_PT });
    shown.rect
}

/// Returns spans as a text to be laid out, in the fonts of `font`.
fn job(spans: &[Span], p: &Palette, font: impl Fn(&Span) -> FontId, ink: Color32) -> LayoutJob {
    let mut job = LayoutJob::default();
    for span in spans {
        let background = if span.code { colour(p.line).gamma_multiply(0.55) } else { Color32::TRANSPARENT };
        let format = TextFormat {
            font_id: font(span),
            color: ink,
            italics: span.emphasised,
            background,
            ..TextFormat::default()
        };
        job.append(&span.text, 0.0, format);
    }
    job
}

/// Returns the font of a span in text of this size.
fn font_of(span: &Span, size: f32) -> FontId {
    match (span.code, span.strong) {
        (true, _) => code(size - 1.0),
        (false, true) => bold(size),
        (false, false) => plain(size),
    }
}

/// Draws a paragraph. Links are widgets of their own, so that the keyboard and screen readers reach them.
fn text(ui: &mut Ui, p: &Palette, spans: &[Span], size: f32, commands: &mut Vec<Command>) {
    let ink = colour(p.ink);
    let font = |span: &Span| font_of(span, size);
    if spans.iter().all(|span| span.link.is_none()) {
        ui.add(Label::new(job(spans, p, font, ink)).wrap());
        return;
    }
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(0.0, 3.0);
        ui.spacing_mut().interact_size.y = size + 3.0;
        for part in spans.chunk_by(|a, b| a.link == b.link) {
            let Some(target) = part.first().and_then(|span| span.link.as_ref()) else {
                ui.add(Label::new(job(part, p, font, ink)).wrap());
                continue;
            };
            let link = ui.add(Link::new(job(part, p, font, Color32::PLACEHOLDER)));
            name(&link, &plain_words(part));
            match target {
                Target::Place(place) if link.clicked() => {
                    commands.push(ViewChange::Guide(GuideStep::Go(place.clone())).into());
                }
                Target::Place(_) => {}
                Target::Web(address) => {
                    let link = link.on_hover_text(format!("{address}\nclick: copies the address"));
                    if link.clicked() {
                        commands.push(WindowCommand::Copy(address.clone()).into());
                    }
                }
            }
        }
    });
}

/// Height that the scroll bar of a block of code takes, points.
const BAR_PT: f32 = 8.0;
/// Width of the button that copies a block of code, points.
const COPY_WIDTH_PT: f32 = 48.0;

/// Draws a block of code with a button that copies it.
fn block_of_code(ui: &mut Ui, p: &Palette, kind: &str, text: &str, (indent, i): (f32, usize)) -> egui::Response {
    let shown = ui.horizontal_top(|ui| {
        ui.add_space(indent);
        let frame = Frame::new().fill(colour(p.background)).stroke(Stroke::new(1.0, colour(p.line))).corner_radius(6);
        frame.inner_margin(8).show(ui, |ui| {
            ui.set_width(ui.available_width());
            let corner = ui.max_rect().right_top();
            // The button covers no code.
            let room = ui.available_width() - COPY_WIDTH_PT;
            let area = ScrollArea::horizontal().id_salt(("code", i)).auto_shrink([false, true]).max_width(room);
            area.show(ui, |ui| {
                let words = RichText::new(text.trim_end()).font(code(CODE_PT)).color(colour(p.ink));
                let words = ui.add(Label::new(words).extend());
                if words.rect.width() > room {
                    // The scroll bar covers no line.
                    ui.add_space(BAR_PT);
                }
            });
            let at = egui::Rect::from_min_size(corner + vec2(2.0 - COPY_WIDTH_PT, -2.0), vec2(COPY_WIDTH_PT, 18.0));
            let words = RichText::new("Copy").font(plain(11.0)).color(colour(p.dim));
            let words = egui::Button::new(words).wrap_mode(egui::TextWrapMode::Extend);
            let copy = ui.put(at, words.fill(colour(p.panel)).stroke((1.0, colour(p.line))));
            let copied = copied(kind, text);
            name(&copy, &format!("Copy: {}", copied.lines().next().unwrap_or_default()));
            if copy.on_hover_text("Copies these lines").clicked() {
                ui.ctx().copy_text(copied);
            }
        });
    });
    shown.response
}

/// Returns what the button of a block copies: of a console what was typed, else all of it.
fn copied(kind: &str, text: &str) -> String {
    let typed: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("$ ")).collect();
    if kind == "console" && !typed.is_empty() { typed.join("\n") } else { text.trim_end().to_owned() }
}

/// Draws a table; its columns share the width by the lengths of their texts.
fn table(ui: &mut Ui, p: &Palette, rows: &[Vec<Vec<Span>>], commands: &mut Vec<Command>) {
    let columns = rows.iter().map(Vec::len).max().unwrap_or_default();
    let widths = widths(rows, columns, ui.available_width());
    for (i, row) in rows.iter().enumerate() {
        let top = ui.cursor().top();
        ui.horizontal_top(|ui| {
            ui.spacing_mut().item_spacing.x = COLUMN_GAP_PT;
            for (cell, width) in row.iter().zip(&widths) {
                ui.allocate_ui_with_layout(vec2(*width, 0.0), egui::Layout::top_down(egui::Align::Min), |ui| {
                    ui.set_width(*width);
                    let strong: Vec<Span> =
                        cell.iter().map(|span| Span { strong: span.strong || i == 0, ..span.clone() }).collect();
                    text(ui, p, &strong, TEXT_PT - 1.0, commands);
                });
            }
        });
        if i > 0 {
            let stroke = Stroke::new(1.0, colour(p.line));
            ui.painter().hline(ui.max_rect().x_range(), top - 2.0, stroke);
        }
        ui.add_space(3.0);
    }
}

/// Returns the widths of the columns of a table in a room of this width, points.
fn widths(rows: &[Vec<Vec<Span>>], columns: usize, room: f32) -> Vec<f32> {
    let letters = |column: usize, of: fn(&str) -> usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        cells.map(|cell| of(&plain_words(cell))).max().unwrap_or_default().max(1) as f32
    };
    let whole: Vec<f32> = (0..columns).map(|i| LETTER_PT * letters(i, |text| text.chars().count()) + 4.0).collect();
    let room = room - COLUMN_GAP_PT * columns.saturating_sub(1) as f32;
    if whole.iter().sum::<f32>() <= room {
        return whole;
    }
    // No column is narrower than its longest word, as far as there is room.
    let longest = |text: &str| text.split_whitespace().map(|word| word.chars().count()).max().unwrap_or_default();
    let least: Vec<f32> = (0..columns).map(|i| (LETTER_PT * letters(i, longest)).min(0.3 * room)).collect();
    let shares: Vec<f32> = whole.iter().map(|width| width.powf(COLUMN_POWER)).collect();
    let (all, free) = (shares.iter().sum::<f32>(), (room - least.iter().sum::<f32>()).max(0.0));
    least.iter().zip(&shares).map(|(least, share)| least + free * share / all).collect()
}
