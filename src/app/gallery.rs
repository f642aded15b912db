//! The built-in machines and scenarios as pictures to choose from.

use std::path::PathBuf;
use std::sync::LazyLock;

use egui::{Align2, Key, RichText, Sense, Stroke, TextStyle, TextWrapMode, Ui, WidgetText, vec2};

use super::own_files::{OwnFile, own_files};
use super::theme::{bold, colour, plain};
use super::widgets::name;
use stillbase_mechanics::machine::{self, Machine};
use stillbase_mechanics::sketch::Template;
use stillbase_picture::paint::thumbnail::Thumbnail;
use stillbase_picture::scene::palette::Palette;
use stillbase_picture::scene::portrait::Portrait;
use stillbase_query::{Queries, QuickQuery, QuickWork};
use stillbase_session::Run;
use stillbase_session::scenario::Scenario;

/// A choice of the gallery.
pub struct Choice<'a> {
    /// Its name.
    pub title: &'a str,
    /// A few words beside the name.
    pub second: String,
    /// What it is, in a sentence or two.
    pub summary: &'a str,
    /// Its picture, once it has been drawn.
    pub portrait: Option<&'a Portrait>,
    /// Whether it is the present one.
    pub is_present: bool,
}

/// Pictures of the built-in machines, in their order; drawn when the list is first opened.
static MACHINES: LazyLock<Vec<Portrait>> = LazyLock::new(|| machine::builtins().iter().map(Portrait::of).collect());

/// A choice of the list of machines.
pub enum Choosable {
    /// A built-in machine.
    Machine(&'static Machine),
    /// A new drawing.
    New(Template),
    /// A file of the user.
    File(PathBuf),
    /// A file that is not there any more, to be taken off the list.
    Forget(PathBuf),
}

/// Pictures of the drawings from which a person starts.
static TEMPLATES: LazyLock<Vec<Thumbnail>> =
    LazyLock::new(|| Template::ALL.into_iter().map(|template| Thumbnail::of(template.sketch())).collect());

/// Draws the drawings from which a person starts, the user's own files, and the built-in machines; returns the choice
/// of the user.
pub fn machines(
    ui: &mut Ui,
    present: &Machine,
    (queries, recent): (&Queries, &[PathBuf]),
    p: &Palette,
) -> Option<Choosable> {
    let new = templates(ui, p).map(Choosable::New);
    let own = own(ui, queries, recent, p);
    title(ui, "BUILT IN", p);
    new.or(own).or(builtins(ui, present, p).map(Choosable::Machine))
}

fn title(ui: &mut Ui, words: &str, p: &Palette) {
    ui.label(RichText::new(words).font(bold(11.0)).color(colour(p.dim)));
}

/// Draws the user's own files; nothing before the first is opened or saved.
fn own(ui: &mut Ui, queries: &Queries, recent: &[PathBuf], p: &Palette) -> Option<Choosable> {
    if recent.is_empty() {
        return None;
    }
    title(ui, "MY MACHINES", p);
    let Some(files) = own_files(queries, recent, true) else {
        ui.label(RichText::new("reading them …").font(plain(12.0)).color(colour(p.dim)));
        return None;
    };
    let mut chosen = None;
    for row in files.chunks(columns(ui)) {
        ui.horizontal(|ui| {
            for file in row {
                if let Some(choice) = own_card(ui, file, p) {
                    chosen = Some(choice);
                    ui.close();
                }
            }
        });
    }
    chosen
}

fn own_card(ui: &mut Ui, file: &OwnFile, p: &Palette) -> Option<Choosable> {
    let name = file.name();
    let folder = file.path.parent().map_or_else(String::new, |folder| folder.display().to_string());
    let about = match &file.content {
        Ok(content) if content.summary.is_empty() => folder,
        Ok(content) => format!("{}\n{folder}", content.summary),
        Err(why) => format!("{why}\n{folder}"),
    };
    let content = file.content.as_ref();
    let second = content.map_or_else(
        |_| if file.path.exists() { String::new() } else { "click takes it off".to_owned() },
        |content| match (content.is_machine, content.drives) {
            (false, _) => name.clone(),
            (true, 1) => "1 drive".to_owned(),
            (true, drives) => format!("{drives} drives"),
        },
    );
    let choice = Choice {
        title: content.map_or(name.as_str(), |content| content.title.as_str()),
        second,
        summary: &about,
        portrait: content.ok().map(|content| &content.portrait),
        is_present: false,
    };
    let response = card(ui, p, &choice).on_hover_text(file.path.display().to_string());
    let forgets = file.is_recent && !file.path.exists();
    response.clicked().then(|| match forgets {
        true => Choosable::Forget(file.path.clone()),
        false => Choosable::File(file.path.clone()),
    })
}

/// Draws a row of drawings from which a person starts; returns the one that the user has chosen.
fn templates(ui: &mut Ui, p: &Palette) -> Option<Template> {
    let mut chosen = None;
    title(ui, "NEW", p);
    let width = columns(ui) as f32 * (CARD_SIZE.x + GAP) - GAP;
    let per_row = (((width + GAP) / (LEAST_NEW_WIDTH + GAP)).floor() as usize).clamp(1, Template::ALL.len());
    let size = vec2(((width + GAP) / per_row as f32 - GAP).floor(), NEW_HEIGHT);
    ui.spacing_mut().item_spacing = vec2(GAP, GAP);
    let all: Vec<(Template, &Thumbnail)> = Template::ALL.into_iter().zip(TEMPLATES.iter()).collect();
    for row in all.chunks(per_row) {
        ui.horizontal(|ui| {
            for (template, picture) in row {
                if template_card(ui, p, *template, picture, size).clicked() {
                    chosen = Some(*template);
                    ui.close();
                }
            }
        });
    }
    chosen
}

fn template_card(
    ui: &mut Ui,
    p: &Palette,
    template: Template,
    picture: &Thumbnail,
    size: egui::Vec2,
) -> egui::Response {
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    name(&response, &format!("new machine: {}. {}", template.title(), template.summary()));
    if !ui.is_rect_visible(rect) {
        return response;
    }
    let edge = match (response.has_focus(), response.hovered()) {
        (true, _) => Stroke::new(2.0, colour(p.ink)),
        (_, true) => Stroke::new(1.0, colour(p.dim)),
        _ => Stroke::new(1.0, colour(p.line)),
    };
    ui.painter().rect(rect, 8.0, colour(p.background), edge, egui::StrokeKind::Inside);
    let inner = rect.shrink(10.0);
    let above = egui::Rect::from_min_size(inner.min, vec2(inner.width(), NEW_PICTURE_HEIGHT));
    picture.paint(ui.painter(), above.shrink(8.0), p);
    let write = |ui: &Ui, text: &str, font, tone, top: f32| {
        let text = WidgetText::from(RichText::new(text).font(font).color(colour(tone)));
        let text = text.into_galley(ui, Some(TextWrapMode::Wrap), inner.width(), TextStyle::Small);
        let height = text.size().y;
        ui.painter().galley(egui::pos2(inner.left(), top), text, colour(tone));
        top + height + 2.0
    };
    let top = write(ui, template.title(), bold(12.5), p.ink, above.bottom() + 4.0);
    write(ui, template.summary(), plain(11.0), p.dim, top);
    response
}

/// Draws the built-in machines; returns the machine that the user has chosen, if it differs from the present one.
fn builtins(ui: &mut Ui, present: &Machine, p: &Palette) -> Option<&'static Machine> {
    let choice = |(machine, portrait): (&'static Machine, &'static Portrait)| Choice {
        title: machine.name(),
        second: format!("{} {}", machine.drives(), if machine.drives() == 1 { "drive" } else { "drives" }),
        summary: &machine.spec().summary,
        portrait: Some(portrait),
        is_present: machine.name() == present.name(),
    };
    let choices: Vec<Choice<'_>> = machine::builtins().iter().zip(MACHINES.iter()).map(choice).collect();
    show(ui, &choices, p).map(|i| &machine::builtins()[i]).filter(|machine| *machine != present)
}

/// Query for pictures of the built-in scenarios: the machine at the start of its path, and the path. A scenario that
/// cannot be planned is shown by its machine alone.
pub struct ScenarioPortraits;

impl QuickQuery for ScenarioPortraits {
    type Input = ();
    type Answer = Vec<Portrait>;

    fn answer((): &()) -> Vec<Portrait> {
        Scenario::builtins().map(portrait_of).collect()
    }
}

/// Returns the picture of a scenario: with its path, or of its machine alone if there is no path.
pub fn portrait_of(scenario: &Scenario) -> Portrait {
    Run::new(scenario).map_or_else(
        |_| Portrait::of(&scenario.machine),
        |run| Portrait::of_path(&scenario.machine, &run.plan().motion),
    )
}

/// Draws the built-in scenarios; returns the one that the user has chosen.
pub fn scenarios(ui: &mut Ui, present: &Scenario, queries: &Queries, p: &Palette) -> Option<&'static Scenario> {
    let portraits = queries.ask_in_background::<QuickWork<ScenarioPortraits>>(&()).last;
    let count = Scenario::cases().count();
    let choice = |(i, scenario): (usize, &'static Scenario)| Choice {
        title: &scenario.title,
        second: if i < count { format!("key {}", i + 1) } else { String::new() },
        summary: &scenario.summary,
        portrait: portraits.as_ref().and_then(|all| all.get(i)),
        is_present: scenario.name == present.name,
    };
    let all: Vec<&'static Scenario> = Scenario::builtins().collect();
    let choices: Vec<Choice<'_>> = all.iter().copied().enumerate().map(choice).collect();
    show(ui, &choices, p).map(|i| all[i])
}

const CARD_SIZE: egui::Vec2 = vec2(282.0, 222.0);
const PICTURE_HEIGHT: f32 = 112.0;
/// Height of a card of a new drawing and of its picture, and the least width of a card.
const NEW_HEIGHT: f32 = 146.0;
const NEW_PICTURE_HEIGHT: f32 = 66.0;
/// Height of the headings above new and above built-in machines, points.
const HEADINGS: f32 = 48.0;
const LEAST_NEW_WIDTH: f32 = 150.0;
const GAP: f32 = 8.0;
const MARGIN: f32 = 12.0;
/// Maximum number of columns.
const MAX_COLUMNS: f32 = 4.0;

/// Returns the maximum height of the list, points.
pub fn room(ui: &Ui) -> f32 {
    (ui.ctx().content_rect().height() - 76.0).clamp(160.0, NEW_HEIGHT + HEADINGS + 3.0 * (CARD_SIZE.y + GAP))
}

/// Returns the number of columns that the window has room for.
fn columns(ui: &Ui) -> usize {
    let wide = ui.ctx().content_rect().width() - 60.0;
    ((wide + GAP) / (CARD_SIZE.x + GAP)).floor().clamp(1.0, MAX_COLUMNS) as usize
}

/// Draws the choices as cards; returns the index of the one that the user has chosen.
fn show(ui: &mut Ui, choices: &[Choice<'_>], p: &Palette) -> Option<usize> {
    let columns = columns(ui);
    ui.set_width(columns as f32 * (CARD_SIZE.x + GAP) - GAP);
    ui.spacing_mut().item_spacing = vec2(GAP, GAP);
    let opened = ui.ctx().memory(|memory| memory.focused()).is_none();
    let mut cards = Vec::with_capacity(choices.len());
    for row in choices.chunks(columns) {
        ui.horizontal(|ui| cards.extend(row.iter().map(|choice| card(ui, p, choice))));
    }
    if opened {
        // Arrow keys start from the present choice.
        let card = &cards[choices.iter().position(|choice| choice.is_present).unwrap_or(0)];
        card.request_focus();
        card.scroll_to_me(None);
    }
    if let Some(at) = cards.iter().position(egui::Response::has_focus) {
        move_focus(ui, &cards, at, columns);
    }
    let picked = cards.iter().position(egui::Response::clicked)?;
    ui.close();
    Some(picked)
}

/// Moves the keyboard focus between cards by the arrow keys, and consumes these keys.
fn move_focus(ui: &Ui, cards: &[egui::Response], at: usize, columns: usize) {
    let filter = egui::EventFilter { horizontal_arrows: true, vertical_arrows: true, ..Default::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(cards[at].id, filter));
    let pressed = |key| ui.input_mut(|i| i.consume_key(egui::Modifiers::NONE, key));
    let steps = [
        (Key::ArrowLeft, at.checked_sub(1)),
        (Key::ArrowRight, Some(at + 1)),
        (Key::ArrowUp, at.checked_sub(columns)),
        (Key::ArrowDown, Some(at + columns)),
    ];
    for (key, to) in steps {
        if pressed(key)
            && let Some(next) = to.and_then(|to| cards.get(to))
        {
            next.request_focus();
            next.scroll_to_me(None);
        }
    }
}

fn card(ui: &mut Ui, p: &Palette, choice: &Choice<'_>) -> egui::Response {
    let (rect, response) = ui.allocate_exact_size(CARD_SIZE, Sense::click());
    let Choice { title, second, summary, portrait, is_present: present } = choice;
    let present = *present;
    let beside = if second.is_empty() { String::new() } else { format!(", {second}") };
    let words = format!("{title}{beside}{}. {summary}", if present { ", on display" } else { "" });
    name(&response, &words);
    if !ui.is_rect_visible(rect) {
        return response;
    }
    let edge = match (response.has_focus(), present, response.hovered()) {
        (true, ..) => Stroke::new(2.0, colour(p.ink)),
        (_, true, _) => Stroke::new(2.0, colour(p.amber)),
        (.., true) => Stroke::new(1.0, colour(p.dim)),
        _ => Stroke::new(1.0, colour(p.line)),
    };
    let painter = ui.painter();
    painter.rect(rect, 8.0, colour(p.background), edge, egui::StrokeKind::Inside);
    let inner = rect.shrink(MARGIN);
    let picture = egui::Rect::from_min_size(inner.min, vec2(inner.width(), PICTURE_HEIGHT - MARGIN));
    if let Some(portrait) = portrait {
        portrait.paint(painter, picture.shrink2(vec2(8.0, 4.0)), p);
    }
    let line = inner.top() + PICTURE_HEIGHT;
    let at = |x| egui::pos2(x, line);
    let ink = if present { colour(p.amber) } else { colour(p.ink) };
    painter.text(at(inner.left()), Align2::LEFT_TOP, title, bold(13.5), ink);
    painter.text(at(inner.right()), Align2::RIGHT_TOP, second, plain(12.0), colour(p.dim));
    let about = RichText::new(*summary).font(plain(11.5)).color(colour(p.dim));
    let about = WidgetText::from(about).into_galley(ui, Some(TextWrapMode::Wrap), inner.width(), TextStyle::Small);
    ui.painter().galley(egui::pos2(inner.left(), line + 20.0), about, colour(p.dim));
    response
}
