//! The card with the choices for a result that becomes a file.

use egui::{Align2, ComboBox, DragValue, Grid, ScrollArea, Ui};

use super::values_card::{self, ValuesContext};
use super::values_choice::{refusal, times_in_words};
use super::{DisplaySize, Export, FilmChoice, FilmForm, Look, PictureChoice, PictureForm, PictureSize, TimeChoice};
use crate::shot::Shot;
use crate::theme::{colour, plain};
use crate::widgets::name;
use crate::{Command, FileDialog, FilePurpose, ViewChange, ViewState};
use stillbase_picture::scene::palette::Theme;
use stillbase_query::Queries;
use stillbase_session::Session;
use stillbase_simulation::signals::Signal;

/// Width of the column of choices, points.
const WIDTH_PT: f32 = 330.0;

/// Distance of the card from the upper edge of a large window, points.
const MAX_TOP_PT: f32 = 120.0;
/// Height of title and buttons of the card, and of the status line, points.
const FRAME_HEIGHT_PT: f32 = 160.0;

/// Draws the card, if it is open.
pub fn show(
    ctx: &egui::Context,
    session: &Session,
    (queries, signals): (&Queries, &[Signal]),
    view_state: &ViewState,
    commands: &mut Vec<Command>,
) {
    let Some(before) = &view_state.open.export else { return };
    let (mut export, mut open) = (before.clone(), true);
    // A change of the choice shows from the next pass on.
    let chosen = match before {
        Export::Values(choice) => choice.signals.of(session, view_state, signals),
        _ => Vec::new(),
    };
    let height = ctx.content_rect().height();
    let top = (0.13 * height).min(MAX_TOP_PT);
    egui::Window::new(export.title())
        .open(&mut open)
        .collapsible(false)
        .resizable(false)
        .anchor(Align2::CENTER_TOP, [0.0, top])
        .show(ctx, |ui| {
            // In a small window the choices scroll, so that the buttons stay in view.
            let choices = ScrollArea::vertical().max_height((height - top - FRAME_HEIGHT_PT).max(60.0));
            let rows = |ui: &mut Ui| match &mut export {
                Export::Picture(PictureChoice { look, form }) => {
                    look_rows(ui, look, &view_state.displayed);
                    let words = PictureForm::ALL.map(|form| (form, form.words()));
                    form_row(ui, form, &words, "Format of the picture", view_state);
                    background_row(ui, look, None);
                }
                Export::Film(choice) => film_rows(ui, choice, session, view_state),
                Export::Values(choice) => {
                    let what = ValuesContext { session, queries, signals, chosen: &chosen, view_state };
                    values_card::rows(ui, choice, &what, commands);
                }
                Export::Report => {}
            };
            choices.show(ui, |ui| Grid::new("choices").num_columns(2).spacing([14.0, 8.0]).show(ui, rows));
            ui.add_space(6.0);
            ui.horizontal(|ui| {
                let nothing = match &export {
                    Export::Picture(choice) => choice.refusal(view_state.view),
                    Export::Values(choice) => refusal(&chosen, choice.times.of(session, view_state), session),
                    _ => None,
                };
                let choose = ui.add_enabled(nothing.is_none(), egui::Button::new("Choose a file…"));
                let choose = choose.on_disabled_hover_text(nothing.unwrap_or_default());
                if ctx.memory(|m| m.focused().is_none()) {
                    choose.request_focus();
                }
                if choose.clicked() {
                    let dialog = FileDialog::suggest(session, FilePurpose::Export(export.clone()));
                    commands.push(ViewChange::Export(None).into());
                    commands.push(ViewChange::Dialog(Some(dialog)).into());
                }
                if ui.button("Cancel").clicked() {
                    commands.push(ViewChange::Export(None).into());
                }
            });
        });
    if !open {
        commands.push(ViewChange::Export(None).into());
    } else if export != *before && commands.is_empty() {
        commands.push(ViewChange::Export(Some(export)).into());
    }
}

fn look_rows(ui: &mut Ui, look: &mut Look, display: &DisplaySize) {
    ui.label("Show");
    ui.horizontal(|ui| {
        ui.radio_value(&mut look.shot, Shot::Scene, "the scene");
        ui.radio_value(&mut look.shot, Shot::Window, "the whole window");
    });
    ui.end_row();
    ui.label("Plots");
    let tick = egui::Checkbox::new(&mut look.plots, "right of the scene");
    let has_scene = look.shot != Shot::Window;
    ui.add_enabled(has_scene, tick).on_disabled_hover_text("the window shows its own plots");
    look.plots &= has_scene;
    ui.end_row();
    ui.label("Size");
    ui.vertical(|ui| {
        ui.set_width(WIDTH_PT);
        let times = |[width, height]: [u32; 2]| format!("{width} × {height} pixels");
        let own = display.pixels(look.shot);
        let as_shown = format!("as on display, {}", times(own));
        let is_known = |size: &[u32; 2]| PictureSize::KNOWN.contains(size);
        let words = match look.size {
            PictureSize::Display => as_shown.clone(),
            PictureSize::Pixels(size) => times(size),
        };
        let chooser = ComboBox::from_id_salt("size").selected_text(words).width(240.0).show_ui(ui, |ui| {
            ui.selectable_value(&mut look.size, PictureSize::Display, as_shown);
            for size in PictureSize::KNOWN {
                ui.selectable_value(&mut look.size, PictureSize::Pixels(size), times(size));
            }
            let typed = matches!(&look.size, PictureSize::Pixels(size) if !is_known(size));
            if ui.selectable_label(typed, "another, typed below").clicked() && !typed {
                look.size = PictureSize::Pixels(own.map(|side| side + 1));
            }
        });
        name(&chooser.response, "Size of the picture");
        if let PictureSize::Pixels(size) = &mut look.size {
            let [least, most] = PictureSize::SIDES;
            ui.horizontal(|ui| {
                for (side, words) in size.iter_mut().zip(["Width, pixels", "Height, pixels"]) {
                    name(&ui.add(DragValue::new(side).range(least..=most)), words);
                }
                ui.label("pixels wide and high");
            });
        }
    });
    ui.end_row();
    ui.label("Colours");
    ui.horizontal(|ui| {
        ui.radio_value(&mut look.theme, Theme::Light, "light");
        ui.radio_value(&mut look.theme, Theme::Dark, "dark");
    });
    ui.end_row();
}

/// Draws the choice of the background; `opaque` is the format if it has no transparency.
fn background_row(ui: &mut Ui, look: &mut Look, opaque: Option<&str>) {
    ui.label("Background");
    let refusal = match opaque {
        _ if look.shot == Shot::Window => Some("the scene alone can be transparent".to_owned()),
        opaque => opaque.map(|form| format!("{form} has no transparency")),
    };
    let tick = egui::Checkbox::new(&mut look.transparent, "transparent, to lay over a page or a slide");
    ui.add_enabled(refusal.is_none(), tick).on_disabled_hover_text(refusal.as_deref().unwrap_or_default());
    look.transparent &= refusal.is_none();
    ui.end_row();
}

/// Draws the choice between the time that plots show and the whole run.
fn time_row(ui: &mut Ui, whole: &mut bool, session: &Session, view_state: &ViewState) {
    let words = |of: TimeChoice| times_in_words(of.of(session, view_state));
    ui.label("Time");
    ui.vertical(|ui| {
        ui.radio_value(whole, true, format!("the whole run, {}", words(TimeChoice::Whole)));
        ui.radio_value(whole, false, format!("what the plots show, {}", words(TimeChoice::Shown)));
    });
    ui.end_row();
}

/// Draws the choice between formats, each with its name and what it is good for.
fn form_row<F: Copy + PartialEq>(
    ui: &mut Ui,
    form: &mut F,
    all: &[(F, [&'static str; 2])],
    what: &str,
    view_state: &ViewState,
) {
    let words = |form: F| all.iter().find(|(own, _)| *own == form).map_or([""; 2], |(_, words)| *words);
    ui.label("Format");
    ui.vertical(|ui| {
        ui.set_width(WIDTH_PT);
        let chooser = ComboBox::from_id_salt("format").selected_text(words(*form)[0]).width(240.0);
        let chooser = chooser.show_ui(ui, |ui| {
            for (own, words) in all {
                ui.selectable_value(form, *own, words[0]);
            }
        });
        name(&chooser.response, what);
        let words = egui::RichText::new(words(*form)[1]).font(plain(11.5));
        ui.add(egui::Label::new(words.color(colour(view_state.palette().dim))).wrap());
    });
    ui.end_row();
}

fn film_rows(ui: &mut Ui, choice: &mut FilmChoice, session: &Session, view_state: &ViewState) {
    look_rows(ui, &mut choice.look, &view_state.displayed);
    time_row(ui, &mut choice.whole, session, view_state);
    let words = FilmForm::ALL.map(|form| (form, form.words()));
    form_row(ui, &mut choice.form, &words, "Format of the film", view_state);
    let opaque = (!choice.form.can_be_transparent()).then_some(choice.form.words()[0]);
    background_row(ui, &mut choice.look, opaque);
    ui.label("Pace");
    ui.horizontal(|ui| {
        name(&ui.add(DragValue::new(&mut choice.fps).range(1.0..=50.0).max_decimals(1)), "Pictures per second");
        ui.label("pictures per second,");
        name(&ui.add(DragValue::new(&mut choice.slow).range(0.01..=1000.0).speed(0.05)), "Times slower than the run");
        ui.label("times slower than the run");
    });
    ui.end_row();
}
