//! The guide in the window: its pages, where they are open, and the way back.

mod document;
mod page;
mod pages;
mod panel;
mod picture;

use document::plain_text as plain_words;
pub use document::{Section, Sections};
pub use pages::Page;
pub use panel::{entries, show};

use egui::{Button, RichText, Ui};

use super::given::assess::TableContent;
use super::theme::{bold, colour};
use super::widgets::name;
use super::{BottomPanel, Command, FilePurpose, ViewChange, ViewState};
use stillbase_picture::scene::palette::Palette;
use stillbase_picture::scene::views::ViewKind;

/// A place of the guide.
#[derive(Clone, Debug, PartialEq)]
pub struct GuidePlace {
    /// The page.
    pub page: Page,
    /// Anchor of a heading; empty for the top of the page.
    pub anchor: String,
}

impl From<Page> for GuidePlace {
    fn from(page: Page) -> Self {
        Self { page, anchor: String::new() }
    }
}

impl GuidePlace {
    /// Returns the place of a heading of a page.
    pub fn under(page: Page, heading: &str) -> Self {
        Self { page, anchor: anchor_of(heading) }
    }

    /// Returns the place that explains a foldable section of the panel of settings.
    pub(super) fn of_section(title: &str) -> Self {
        match title {
            "Base" => Self::under(Page::Plants, "Bases"),
            "Control" => Self::under(Page::Plants, "Control"),
            "Plant" => Page::Plants.into(),
            _ => Page::Keys.into(),
        }
    }

    /// Returns the place that belongs to what is on display; `table` is the content of the open table, if it is known.
    pub(super) fn of_display(view_state: &ViewState, table: Option<TableContent>) -> Self {
        let purpose = view_state.open.dialog.as_ref().map(|dialog| &dialog.purpose);
        match (purpose, view_state.view, view_state.below) {
            (Some(FilePurpose::Record), ..) => Page::Recording.into(),
            (Some(FilePurpose::Machine), ..) => Page::Elsewhere.into(),
            (Some(FilePurpose::Plot(..)), ..) => Self::under(Page::FirstRun, "Plots"),
            (Some(_), ..) => Page::Files.into(),
            (None, ViewKind::Design, _) if view_state.drawing_pen().is_some() => Page::Draw.into(),
            (None, ViewKind::Design, _) if view_state.arrangement.shows_equations => {
                Self::under(Page::Design, "Every equation of the paper")
            }
            (None, ViewKind::Design, _) => Page::Design.into(),
            (None, _, Some(BottomPanel::Tolerances)) => Page::Tolerances.into(),
            (None, _, Some(BottomPanel::Runs)) => Self::under(Page::Plants, "Runs side by side"),
            (None, _, Some(BottomPanel::Table)) => match table {
                Some(TableContent::Measurement) => Page::Trim.into(),
                _ => Page::OwnMotion.into(),
            },
            _ if view_state.pins => Page::Inside.into(),
            _ if view_state.open.tour.is_some() => Page::Paper.into(),
            _ if view_state.status.refused.is_some() => Self::under(Page::Planning, "When a path is refused"),
            _ => Page::FirstRun.into(),
        }
    }
}

/// Returns further search words for a place of the guide.
pub fn search_words(place: &GuidePlace) -> &'static str {
    match (place.page, place.anchor.as_str()) {
        (Page::FirstRun, "") => "units degrees radians millimetres",
        (Page::Recording, "pictures-and-films") => "film movie video gif animation",
        (Page::Paper, "symbols") => "notation letters meaning",
        (Page::Trim, "") => "measure measurement real machine sensor identify calibrate lab",
        (Page::Planning, "") => "change of b motion trajectory refused",
        (Page::Draw, "") => "sketch new machine bars pins motors limits section",
        (Page::Design, "") => "balance counterweights machine optimise",
        (Page::Workshop, "") => "cut bars tails layers stack drawing build parts dxf stl",
        (Page::Elsewhere, "") => "export import urdf mjcf dxf cad",
        (Page::Tolerances, "") => "monte carlo manufacturing spread yield",
        (Page::Index, "") => "help manual documentation contents",
        _ => "",
    }
}

/// Returns the anchor of a heading, as code hosts make it.
pub fn anchor_of(heading: &str) -> String {
    let kept = heading.trim().chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
    kept.flat_map(char::to_lowercase).map(|c| if c == ' ' { '-' } else { c }).collect()
}

/// The guide while it is open.
#[derive(Clone, Debug, PartialEq)]
pub struct GuideView {
    /// The place on display.
    pub place: GuidePlace,
    /// Distance of the display from the top of the page, points.
    offset: f32,
    /// Where the next pass scrolls to, and how many passes after it scroll there too.
    scroll: Option<(Scroll, u8)>,
    /// Places before and after this one, the nearest last, with their offsets.
    back: Vec<(GuidePlace, f32)>,
    forward: Vec<(GuidePlace, f32)>,
    /// The search text.
    pub search_text: String,
    /// Whether the field of the search takes the keyboard in the next pass.
    takes_keyboard: bool,
}

/// A place within a page to scroll to.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Scroll {
    Anchor,
    Offset(f32),
}

/// A step of the reader.
#[derive(Clone, Debug, PartialEq)]
pub enum GuideStep {
    /// Open a place.
    Go(GuidePlace),
    /// Open the place before this one.
    Back,
    /// Open the place after this one.
    Forward,
}

/// Passes after the first one until the layout of a page is settled.
const MORE_PASSES: u8 = 2;

/// Maximum number of places to go back to.
const MAX_PLACES: usize = 100;

impl GuideView {
    /// Opens the guide at a place.
    pub fn at(place: GuidePlace) -> Self {
        let (back, forward) = (Vec::new(), Vec::new());
        Self {
            place,
            offset: 0.0,
            scroll: Some((Scroll::Anchor, MORE_PASSES)),
            back,
            forward,
            search_text: String::new(),
            takes_keyboard: true,
        }
    }

    /// Takes a step; without a place to go to, nothing changes.
    pub fn take(&mut self, step: GuideStep) {
        let here = (self.place.clone(), self.offset);
        match step {
            GuideStep::Go(place) => {
                if here.0 != place {
                    self.back.push(here);
                    self.forward.clear();
                    if self.back.len() > MAX_PLACES {
                        self.back.remove(0);
                    }
                }
                (self.place, self.scroll) = (place, Some((Scroll::Anchor, MORE_PASSES)));
            }
            GuideStep::Back => {
                let Some((place, offset)) = self.back.pop() else { return };
                self.forward.push(here);
                (self.place, self.scroll) = (place, Some((Scroll::Offset(offset), MORE_PASSES)));
            }
            GuideStep::Forward => {
                let Some((place, offset)) = self.forward.pop() else { return };
                self.back.push(here);
                (self.place, self.scroll) = (place, Some((Scroll::Offset(offset), MORE_PASSES)));
            }
        }
    }

    /// Whether there is a place to go to, backwards or forwards.
    pub fn goes(&self, step: &GuideStep) -> bool {
        match step {
            GuideStep::Go(_) => true,
            GuideStep::Back => !self.back.is_empty(),
            GuideStep::Forward => !self.forward.is_empty(),
        }
    }
}

/// Draws the title of a section of a panel, with a button that opens the guide at the place that explains it.
pub fn section(ui: &mut Ui, p: &Palette, title: &str, place: impl Into<GuidePlace>, commands: &mut Vec<Command>) {
    ui.add_space(10.0);
    ui.horizontal(|ui| {
        ui.set_height(16.0);
        ui.label(RichText::new(title.to_uppercase()).font(bold(11.0)).color(colour(p.dim)));
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| button(ui, p, title, place, commands));
    });
}

/// Draws a button that opens the guide at the place that explains a panel.
pub fn button(ui: &mut Ui, p: &Palette, what: &str, place: impl Into<GuidePlace>, commands: &mut Vec<Command>) {
    let words = RichText::new("?").font(bold(11.5)).color(colour(p.dim));
    let button = ui.add(Button::new(words).frame(false).min_size(egui::vec2(16.0, 16.0)));
    name(&button, &format!("Guide: {what}"));
    if button.on_hover_text(format!("What the guide says of {what}")).clicked() {
        commands.push(ViewChange::Guide(GuideStep::Go(place.into())).into());
    }
}
