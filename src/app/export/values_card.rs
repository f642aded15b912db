//! The choices for values of signals: a list of signals by groups, times, and the command that writes the same.

use std::collections::BTreeSet;

use egui::{Button, Checkbox, DragValue, Id, Label, Response, RichText, ScrollArea, TextEdit, Ui};

use super::values_choice::{refusal, times_in_words};
use super::{RowForm, SignalChoice, TimeChoice, ValuesChoice};
use crate::theme::{bold, colour, plain};
use crate::widgets::name;
use crate::{Command, ViewState, WindowCommand};
use stillbase_picture::charts::search::search;
use stillbase_query::Queries;
use stillbase_session::{Session, session_command};
use stillbase_settings::text::capitalised;
use stillbase_simulation::signals::Signal;

/// Width of the column of choices, and height of the list of signals, points.
const WIDTH_PT: f32 = 430.0;
const LIST_HEIGHT_PT: f32 = 210.0;
/// Height of a row of the list, points.
const ROW_HEIGHT_PT: f32 = 18.0;

/// The data that the choices refer to.
pub struct ValuesContext<'a> {
    pub session: &'a Session,
    pub queries: &'a Queries,
    /// All signals.
    pub signals: &'a [Signal],
    /// The signals that were chosen before this pass, in the order of the table.
    pub chosen: &'a [&'a Signal],
    pub view_state: &'a ViewState,
}

/// Draws the choices.
pub fn rows(ui: &mut Ui, choice: &mut ValuesChoice, what: &ValuesContext<'_>, commands: &mut Vec<Command>) {
    ui.label("Signals");
    ui.vertical(|ui| signal_rows(ui, &mut choice.signals, what));
    ui.end_row();
    ui.label("Time");
    ui.vertical(|ui| time_rows(ui, &mut choice.times, what));
    ui.end_row();
    ui.label("Format");
    ui.horizontal(|ui| {
        for form in RowForm::ALL {
            ui.radio_value(&mut choice.form, form, form.words());
        }
    });
    ui.end_row();
    ui.label("Command line");
    ui.vertical(|ui| command_row(ui, choice, what, commands));
    ui.end_row();
}

fn signal_rows(ui: &mut Ui, choice: &mut SignalChoice, what: &ValuesContext<'_>) {
    let (p, all) = (what.view_state.palette(), what.signals);
    let mut paths: BTreeSet<String> = what.chosen.iter().map(|signal| signal.path.clone()).collect();
    let before = paths.clone();
    ui.horizontal(|ui| {
        ui.radio_value(choice, SignalChoice::Plots, "those of the plots on display");
        ui.radio_value(choice, SignalChoice::All, "all");
        let words = format!("these: {} of {}", what.chosen.len(), all.len());
        if ui.radio(matches!(choice, SignalChoice::These(_)), words).clicked() {
            *choice = SignalChoice::These(paths.clone());
        }
    });
    let id = Id::unique("part of the name of a signal to be written");
    let mut text: String = ui.data(|data| data.get_temp(id)).unwrap_or_default();
    ui.horizontal(|ui| {
        let hint = RichText::new("find a signal: name, symbol, unit").font(plain(11.5));
        let edit = TextEdit::singleline(&mut text).id(id.with("field")).hint_text(hint).font(plain(11.5));
        name(&ui.add(edit.desired_width(WIDTH_PT - 70.0)), "Find a signal to be written");
        if ui.small_button("none").on_hover_text("Takes all ticks away").clicked() {
            paths.clear();
        }
    });
    let found: BTreeSet<&str> = search(all, &text).into_iter().map(|signal| signal.path.as_str()).collect();
    ui.data_mut(|data| data.insert_temp(id, text));
    let frame = egui::Frame::new().stroke(egui::Stroke::new(1.0, colour(p.line))).inner_margin(6.0);
    frame.show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 1.0;
        ui.spacing_mut().interact_size.y = ROW_HEIGHT_PT;
        let seen: Vec<&Signal> = all.iter().filter(|signal| found.contains(signal.path.as_str())).collect();
        let groups = seen.chunk_by(|a, b| a.group() == b.group());
        let rows: Vec<ListRow<'_>> =
            groups.flat_map(|group| [ListRow::Group(group)].into_iter().chain(group.iter().map(ListRow::of))).collect();
        let list =
            ScrollArea::vertical().id_salt("signals").max_height(LIST_HEIGHT_PT).min_scrolled_height(LIST_HEIGHT_PT);
        let list = list.auto_shrink([false, true]);
        list.show_rows(ui, ROW_HEIGHT_PT, rows.len().max(1), |ui, shown| {
            ui.set_width(WIDTH_PT - 28.0);
            if rows.is_empty() {
                ui.label(RichText::new("no signal has all these words").color(colour(p.dim)));
            }
            for row in rows.get(shown).unwrap_or_default() {
                let tick = match row {
                    ListRow::Group(group) => group_row(ui, group, &mut paths, what),
                    ListRow::One(signal) => signal_row(ui, signal, &mut paths, what),
                };
                // The keyboard reaches the rows below and above those in view.
                if tick.gained_focus() && !ui.clip_rect().contains_rect(tick.rect) {
                    tick.scroll_to_me(None);
                }
            }
        });
    });
    if paths != before {
        *choice = SignalChoice::These(paths);
    }
}

/// A row of the list of signals.
enum ListRow<'a> {
    /// The title of a group of signals.
    Group(&'a [&'a Signal]),
    /// A signal.
    One(&'a Signal),
}

impl<'a> ListRow<'a> {
    fn of(signal: &&'a Signal) -> Self {
        Self::One(signal)
    }
}

/// Draws the tick of a group of signals.
fn group_row(ui: &mut Ui, group: &[&Signal], paths: &mut BTreeSet<String>, what: &ValuesContext<'_>) -> Response {
    let p = what.view_state.palette();
    let (group_name, unit) = group.first().map_or(("", ""), |first| (first.group(), first.unit));
    let ticked = group.iter().filter(|signal| paths.contains(&signal.path)).count();
    let mut whole = ticked == group.len();
    let row = ui.horizontal(|ui| {
        let title = capitalised(&group_name.replace('_', " "));
        let tick = Checkbox::new(&mut whole, RichText::new(&title).font(bold(12.0)));
        let tick = ui.add(tick.indeterminate(ticked > 0 && ticked < group.len()));
        name(&tick, &format!("{title}: all {}", group.len()));
        if tick.clicked() {
            group.iter().for_each(|signal| set(paths, signal, whole));
        }
        // Files hold SI units, whatever the window shows.
        let unit = if unit == "1" { "" } else { unit };
        ui.label(RichText::new(unit).font(plain(11.5)).color(colour(p.dim)));
        tick
    });
    row.inner
}

/// Draws the tick of a signal.
fn signal_row(ui: &mut Ui, signal: &Signal, paths: &mut BTreeSet<String>, what: &ValuesContext<'_>) -> Response {
    let notation = what.view_state.arrangement.notation;
    let row = ui.horizontal(|ui| {
        ui.add_space(18.0);
        let mut on = paths.contains(&signal.path);
        let words = notation.name(&signal.label, &signal.symbol);
        let tick = ui.checkbox(&mut on, RichText::new(words).font(plain(12.0))).on_hover_text(&signal.path);
        if tick.clicked() {
            set(paths, signal, on);
        }
        tick
    });
    row.inner
}

/// Adds a signal to the paths, or removes it.
fn set(paths: &mut BTreeSet<String>, signal: &Signal, on: bool) {
    if on {
        paths.insert(signal.path.clone())
    } else {
        paths.remove(&signal.path)
    };
}

fn time_rows(ui: &mut Ui, choice: &mut TimeChoice, what: &ValuesContext<'_>) {
    let (session, view_state) = (what.session, what.view_state);
    let end = session.length();
    let words = |of: TimeChoice| times_in_words(of.of(session, view_state));
    ui.radio_value(choice, TimeChoice::Whole, format!("the whole run, {}", words(TimeChoice::Whole)));
    ui.radio_value(choice, TimeChoice::Shown, format!("what the plots show, {}", words(TimeChoice::Shown)));
    let mut times = choice.of(session, view_state);
    let before = times;
    ui.horizontal(|ui| {
        let mut typed = matches!(choice, TimeChoice::Between(_));
        if ui.radio(typed, "from").clicked() {
            typed = true;
        }
        for (i, words) in ["First instant, s", "Last instant, s"].into_iter().enumerate() {
            if i > 0 {
                ui.label("to");
            }
            let field = DragValue::new(&mut times[i]).range(0.0..=end).speed(0.002 * end).max_decimals(6).suffix(" s");
            name(&ui.add(field), words);
        }
        if typed || times != before {
            *choice = TimeChoice::Between(times);
        }
    });
}

/// Draws the command that writes the same, with a button that copies it, or why nothing can be written.
fn command_row(ui: &mut Ui, choice: &ValuesChoice, what: &ValuesContext<'_>, commands: &mut Vec<Command>) {
    let p = what.view_state.palette();
    ui.set_width(WIDTH_PT);
    let say = |ui: &mut Ui, words: &str, tone| {
        ui.add(Label::new(RichText::new(words).font(plain(11.5)).color(colour(tone))).wrap())
    };
    let times = choice.times.of(what.session, what.view_state);
    if let Some(why) = refusal(what.chosen, times, what.session) {
        say(ui, why, p.reaction);
        return;
    }
    let Some(options) = choice.options((what.chosen, times), what.session, what.signals) else {
        say(ui, "no command can name a signal with a comma: want names of the machine's parts without commas", p.dim);
        return;
    };
    let known = session_command(what.session, what.queries);
    let command = format!("{}{options}", known.as_deref().unwrap_or("stillbase simulate FILE.toml"));
    ui.add(Label::new(RichText::new(&command).font(egui::FontId::monospace(11.5))).wrap());
    ui.horizontal(|ui| {
        let copy = ui.add(Button::new("Copy")).on_hover_text("Copies the command that writes the same file");
        name(&copy, "Copy the command");
        if copy.clicked() {
            commands.push(WindowCommand::Copy(command.clone()).into());
        }
        if known.is_none() {
            say(ui, "FILE.toml is this session, saved (Ctrl S)", p.dim);
        }
    });
}
