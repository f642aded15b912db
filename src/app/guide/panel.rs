//! The window of the guide: search, list of pages, the way back, and the page.

use std::sync::Arc;

use egui::{Button, Context, Key, Label, Layout, RichText, ScrollArea, TextEdit, Ui, Window, vec2};

use super::document::{ReadPage, Section, Sections};
use super::{GuidePlace, GuideStep, GuideView, Page, page};
use crate::theme::{bold, colour, plain};
use crate::widgets::name;
use crate::{Command, Switch, ViewChange, ViewState, search};
use stillbase_picture::scene::palette::Palette;
use stillbase_query::{ByIdentity, Queries, QuickQuery, QuickWork};

/// Size of the window, and the least one, points.
const SIZE_PT: egui::Vec2 = vec2(820.0, 640.0);
const MIN_SIZE_PT: egui::Vec2 = vec2(420.0, 300.0);
/// Width of the list of pages, and the width of a window that has room for it, points.
const LIST_WIDTH_PT: f32 = 196.0;
const MIN_WIDTH_WITH_LIST_PT: f32 = 600.0;
/// Maximum number of places found, and numbers of letters shown: before the word sought, and from its first letter.
const MAX_FOUND: usize = 40;
const LETTERS_BEFORE: usize = 24;
const LETTERS_AFTER: usize = 90;

/// Draws the window of the guide while it is open.
pub fn show(ctx: &Context, queries: &Queries, view_state: &mut ViewState, commands: &mut Vec<Command>) {
    let p = view_state.palette();
    let Some(mut view) = view_state.open.guide.take() else { return };
    let mut open = true;
    let room = ctx.content_rect().size() - vec2(48.0, 96.0);
    let window = Window::new("Guide").open(&mut open).collapsible(false).default_size(SIZE_PT.min(room));
    let window = window.min_size(MIN_SIZE_PT.min(room)).max_size(room).pivot(egui::Align2::CENTER_CENTER);
    window.default_pos(ctx.content_rect().center()).show(ctx, |ui| {
        // What does not fit is cut off: it must not make the window grow.
        let rect = ui.available_rect_before_wrap();
        ui.allocate_rect(rect, egui::Sense::hover());
        let ui = &mut ui.new_child(egui::UiBuilder::new().max_rect(rect));
        ui.set_clip_rect(rect.expand(2.0).intersect(ui.clip_rect()));
        let (text, enters) = bar(ui, &view, &p, commands);
        view.takes_keyboard = false;
        text.into_iter().for_each(|text| view.search_text = text);
        if enters {
            open_first_found(queries, &view, commands);
        }
        ui.add_space(4.0);
        let wide = ui.available_width() >= MIN_WIDTH_WITH_LIST_PT;
        let seeks = !view.search_text.trim().is_empty();
        ui.horizontal_top(|ui| {
            if wide || seeks {
                let width = if wide { LIST_WIDTH_PT } else { ui.available_width() };
                let (size, down) = (vec2(width, ui.available_height()), Layout::top_down(egui::Align::Min));
                ui.allocate_ui_with_layout(size, down, |ui| {
                    ui.set_width(width);
                    list(ui, queries, &view, &p, commands);
                });
            }
            if wide {
                ui.separator();
            }
            if wide || !seeks {
                let document = queries.ask::<QuickWork<ReadPage>>(&view.place.page);
                ui.vertical(|ui| {
                    let to = (view.place.anchor.as_str(), view.scroll.map(|(scroll, _)| scroll));
                    view.offset = page::show(ui, &p, (queries, &document), to, view.place.page.file(), commands);
                    // The first pass only measures a new window.
                    view.scroll = view.scroll.and_then(|(scroll, left)| Some((scroll, left.checked_sub(1)?)));
                    if view.scroll.is_some() {
                        ui.ctx().request_repaint();
                    }
                });
            }
        });
        let turned = |button| ui.input(|i| i.pointer.button_clicked(button));
        for (button, step) in
            [(egui::PointerButton::Extra1, GuideStep::Back), (egui::PointerButton::Extra2, GuideStep::Forward)]
        {
            if ui.ui_contains_pointer() && turned(button) {
                commands.push(ViewChange::Guide(step).into());
            }
        }
    });
    view_state.open.guide = Some(view);
    if !open {
        commands.push(ViewChange::Switch(Switch::Guide, false).into());
    }
}

/// Draws the buttons of the way back and the field of the search; returns the search text if it has changed, and whether
/// Enter was pressed in it.
fn bar(ui: &mut Ui, view: &GuideView, p: &Palette, commands: &mut Vec<Command>) -> (Option<String>, bool) {
    let mut text = view.search_text.clone();
    let enters = ui.horizontal(|ui| {
        for (sign, label, step) in [
            ("←", "Back: guide", GuideStep::Back),
            ("→", "Forward: guide", GuideStep::Forward),
            ("≡", "All pages: guide", GuideStep::Go(Page::Index.into())),
        ] {
            let button = ui.add_enabled(view.goes(&step), Button::new(RichText::new(sign).font(bold(13.0))));
            name(&button, label);
            if button.on_hover_text(label.trim_end_matches(": guide")).clicked() {
                commands.push(ViewChange::Guide(step).into());
            }
        }
        let field = TextEdit::singleline(&mut text).hint_text("search the guide").desired_width(f32::INFINITY);
        let field = ui.add(field.text_color(colour(p.ink)));
        name(&field, "Search the guide");
        if view.takes_keyboard {
            field.request_focus();
        }
        field.lost_focus() && ui.input(|i| i.key_pressed(Key::Enter))
    });
    ((text != view.search_text).then_some(text), enters.inner)
}

/// Returns the places found for the search text, best first; `None` without a search.
fn found(queries: &Queries, sections: &Arc<Vec<Section>>, view: &GuideView) -> Option<Arc<Vec<(usize, String)>>> {
    let sought = view.search_text.trim();
    let seeks = !sought.is_empty();
    seeks.then(|| queries.ask::<QuickWork<Found>>(&(ByIdentity(sections.clone()), sought.to_owned())))
}

/// Opens the best place found and ends the search.
fn open_first_found(queries: &Queries, view: &GuideView, commands: &mut Vec<Command>) {
    let sections = queries.ask::<QuickWork<Sections>>(&());
    let Some((i, _)) = found(queries, &sections, view).and_then(|found| found.first().cloned()) else { return };
    commands.push(ViewChange::Guide(GuideStep::Go(sections[i].place.clone())).into());
    commands.push(ViewChange::LeaveGuideSearch.into());
}

/// Draws the list of pages, or of the places found.
fn list(ui: &mut Ui, queries: &Queries, view: &GuideView, p: &Palette, commands: &mut Vec<Command>) {
    let sections = queries.ask::<QuickWork<Sections>>(&());
    let found = found(queries, &sections, view);
    let seeks = found.is_some();
    let shown: Vec<(&Section, Option<&str>)> = match &found {
        Some(found) => found.iter().map(|(i, words)| (&sections[*i], Some(words.as_str()))).collect(),
        None => sections.iter().filter(|s| s.place.anchor.is_empty()).map(|s| (s, None)).collect(),
    };
    ScrollArea::vertical().id_salt(("pages of the guide", seeks)).auto_shrink(false).show(ui, |ui| {
        ui.set_width(ui.available_width() - 12.0);
        if shown.is_empty() {
            ui.label(RichText::new("no page says this").color(colour(p.dim)));
        }
        for (section, words) in shown {
            let chosen = match &words {
                Some(_) => view.place == section.place,
                None => view.place.page == section.place.page,
            };
            let row = ui.add(Button::selectable(chosen, RichText::new(&section.heading).font(plain(12.5))).truncate());
            let label = match words {
                Some(_) if section.heading != section.page => format!("{}: {}", section.page, section.heading),
                _ => section.heading.clone(),
            };
            name(&row, &format!("Page: {label}"));
            if row.clicked() {
                commands.push(ViewChange::Guide(GuideStep::Go(section.place.clone())).into());
                if words.is_some() && ui.available_width() > LIST_WIDTH_PT {
                    // In a narrow window the page takes the place of what was found.
                    commands.push(ViewChange::LeaveGuideSearch.into());
                }
            }
            if let Some(words) = words {
                let page = RichText::new(&section.page).font(bold(10.5)).color(colour(p.dim));
                ui.add(Label::new(page).truncate());
                ui.add(Label::new(RichText::new(words).font(plain(11.0)).color(colour(p.dim))).wrap());
                ui.add_space(4.0);
            }
        }
    });
}

/// Query for the sections that contain every word sought, best first: their indices, with the words around the first.
struct Found;

impl QuickQuery for Found {
    type Input = (ByIdentity<Vec<Section>>, String);
    type Answer = Vec<(usize, String)>;

    fn answer((ByIdentity(sections), sought): &Self::Input) -> Self::Answer {
        let title = |s: &Section| format!("{} {} {}", s.heading, s.page, super::search_words(&s.place));
        let score = |(_, s): &(usize, &Section)| search::score_of_prose(sought, &title(s), &s.text);
        let found = search::best_first(sections.iter().enumerate(), score, MAX_FOUND);
        found.into_iter().map(|(i, section)| (i, excerpt(&section.text, sought))).collect()
    }
}

/// Returns the part of a text around the first word sought.
fn excerpt(text: &str, sought: &str) -> String {
    let letters: Vec<char> = text.split_whitespace().collect::<Vec<_>>().join(" ").chars().collect();
    let lower: Vec<char> = letters.iter().map(|c| c.to_lowercase().next().unwrap_or(*c)).collect();
    let word: Vec<char> = sought.split_whitespace().next().unwrap_or_default().to_lowercase().chars().collect();
    let at = lower.windows(word.len().max(1)).position(|part| part == word).unwrap_or_default();
    let (from, to) = (at.saturating_sub(LETTERS_BEFORE), (at + LETTERS_AFTER).min(letters.len()));
    let [before, after] = [from > 0, to < letters.len()].map(|more| if more { "…" } else { "" });
    format!("{before}{}{after}", letters[from..to].iter().collect::<String>())
}

impl GuideView {
    /// Ends the search.
    pub fn leave_search(&mut self) {
        self.search_text.clear();
    }
}

/// Returns what the list of commands offers of the guide: titles and places of all pages and headings.
pub fn entries(sections: &[Section]) -> impl Iterator<Item = (String, GuidePlace)> {
    sections.iter().map(|section| {
        let title = match section.place.anchor.is_empty() {
            true => format!("Guide: {}", section.heading),
            false => format!("Guide: {}, {}", section.heading, section.page),
        };
        (title, section.place.clone())
    })
}
