//! The row below the plots: search for a signal, the second cursor, and closed plots.

use egui::{
    Align, Button, Context, Id, Key, Layout, Panel, Popup, PopupCloseBehavior, RichText, ScrollArea, TextEdit, Ui,
};

use super::prepared::extent;
use super::shown::DisplayContext;
use crate::fit::fitted;
use crate::theme::{bold, colour, plain};
use crate::widgets::name;
use crate::{Command, ViewChange};
use stillbase_picture::charts::choice::{Plot, PlotChange};
use stillbase_picture::charts::search::search;
use stillbase_picture::numbers::at_step;

/// Purpose of the search for a signal.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum SearchPurpose {
    /// A new plot.
    #[default]
    Plot,
    /// A curve in the plot of this name.
    Curve(String),
    /// The abscissa of the plot of this name.
    Abscissa(String),
}

/// State of the search: its purpose, its text, and the index of the selected result.
#[derive(Clone, Debug, Default)]
struct Typed {
    purpose: SearchPurpose,
    text: String,
    place: usize,
    /// Whether the results are on display.
    open: bool,
}

/// Whether the search results are on display.
pub fn is_looking(ctx: &Context) -> bool {
    ctx.data(|data| data.get_temp::<Typed>(typed_id())).is_some_and(|typed| typed.open)
}

fn id() -> Id {
    Id::unique("signal sought")
}

fn typed_id() -> Id {
    Id::unique("text of the signal sought")
}

/// Moves the keyboard focus to the search field, for a new plot.
pub fn focus(ctx: &Context) {
    start(ctx, SearchPurpose::Plot);
}

/// Moves the keyboard focus to the empty search field, for the given purpose.
pub fn start(ctx: &Context, sought: SearchPurpose) {
    ctx.data_mut(|data| data.insert_temp(typed_id(), Typed { purpose: sought, ..Typed::default() }));
    ctx.memory_mut(|memory| memory.request_focus(id()));
}

/// Draws the row with a margin `right` at its right edge, points.
pub fn show(ui: &mut Ui, shown: &DisplayContext<'_>, plots: &[Plot<'_>], right: i8, commands: &mut Vec<Command>) {
    let frame = egui::Frame::new().inner_margin(egui::Margin { left: 0, right, top: 6, bottom: 0 });
    Panel::bottom("find a signal").resizable(false).show_separator_line(false).frame(frame).show(ui, |ui| {
        ui.horizontal(|ui| {
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ui.spacing_mut().item_spacing.x = 6.0;
                state(ui, shown, commands);
                field(ui, shown, plots, commands);
            });
        });
    });
}

/// Draws buttons that show the whole time range, remove the second cursor, and reopen closed plots.
fn state(ui: &mut Ui, shown: &DisplayContext<'_>, commands: &mut Vec<Command>) {
    let (view_state, session) = (shown.view_state, shown.session);
    let p = view_state.palette();
    let small = |text: String, tone| RichText::new(text).font(plain(11.0)).color(colour(tone));
    let step = session.scenario().step;
    let button = |ui: &mut Ui, text: String, tone, label: &str, tip: &str| {
        let button = ui.add(Button::new(small(text, tone)).frame(false)).on_hover_text(tip);
        name(&button, label);
        button.clicked()
    };
    if let Some(mark) = view_state.mark {
        let text = format!("Δt {} s ×", at_step(session.frame().time - mark, step));
        let tip = format!("The second cursor stands at {} s; a click removes it (Esc)", at_step(mark, step));
        if button(ui, text, p.amber, "Put the second cursor away", &tip) {
            commands.push(ViewChange::Mark(None).into());
        }
    }
    if let Some([from, to]) = view_state.charts.range {
        let fine = 0.01 * (to - from);
        let text = format!("{}–{} s ×", at_step(from, fine), at_step(to, fine));
        if button(ui, text, p.dim, "Show all time", "The time that plots show; click: all of it (Alt 0)") {
            commands.push(ViewChange::Charts(PlotChange::Range(extent(session).all(view_state.charts.range))).into());
        }
    }
    let closed = view_state.charts.closed();
    if closed > 0
        && button(ui, format!("+{closed}"), p.dim, "Bring plots back", "Brings back the plots that were put away")
    {
        commands.push(ViewChange::Charts(PlotChange::Reopen).into());
    }
}

fn field(ui: &mut Ui, shown: &DisplayContext<'_>, plots: &[Plot<'_>], commands: &mut Vec<Command>) {
    let p = shown.view_state.palette();
    let mut typed: Typed = ui.data(|data| data.get_temp(typed_id())).unwrap_or_default();
    let title =
        |name: &String| plots.iter().find(|plot| plot.name == *name).map_or("it", |plot| &plot.title).to_owned();
    let hint = match &typed.purpose {
        SearchPurpose::Plot => "+ plot a signal: name, symbol, unit".to_owned(),
        SearchPurpose::Curve(plot) => format!("+ curve in {}", title(plot)),
        SearchPurpose::Abscissa(plot) => format!("{} against …", title(plot)),
    };
    // The arrow keys move through the results, not through the text.
    let focused = ui.memory(|memory| memory.has_focus(id()));
    let pressed = |key| focused && ui.input_mut(|i| i.consume_key(egui::Modifiers::NONE, key));
    let (up, down, enter) = (pressed(Key::ArrowUp), pressed(Key::ArrowDown), pressed(Key::Enter));
    let room = ui.available_width() - 2.0 * ui.spacing().button_padding.x;
    let hint = fitted(ui, &hint, &plain(11.5), room).into_owned();
    let edit = TextEdit::singleline(&mut typed.text).id(id()).hint_text(RichText::new(hint).font(plain(11.5)));
    let response = ui.add(edit.font(plain(11.5)).desired_width(ui.available_width()));
    name(&response, "Plot a signal");
    if response.changed() {
        typed.place = 0;
    }
    typed.open |= response.gained_focus();
    let found = search(shown.signals, &typed.text);
    typed.place = match (up, down) {
        (true, _) => typed.place.saturating_sub(1),
        (_, true) => typed.place + 1,
        _ => typed.place,
    }
    .min(found.len().saturating_sub(1));
    let mut chosen = found.get(typed.place).filter(|_| enter).map(|signal| signal.path.clone());
    let answers = Popup::from_response(&response)
        .open(typed.open)
        .close_behavior(PopupCloseBehavior::IgnoreClicks)
        .width(response.rect.width().max(280.0))
        .show(|ui| {
            ScrollArea::vertical().max_height(260.0).show(ui, |ui| {
                if found.is_empty() {
                    ui.label(RichText::new("no signal has all these words").font(plain(11.5)).color(colour(p.dim)));
                }
                for (i, signal) in found.iter().enumerate() {
                    let row = ui.horizontal(|ui| {
                        let symbol = RichText::new(&signal.symbol).font(bold(11.5));
                        let answer = ui.selectable_label(i == typed.place, symbol);
                        let unit = if signal.unit == "1" { "" } else { signal.unit };
                        let words = format!("{}  {unit}", signal.label);
                        name(&answer, &format!("{}, {}", signal.symbol, signal.label));
                        ui.label(RichText::new(words).font(plain(11.5)).color(colour(p.dim)));
                        answer
                    });
                    let answer = row.inner.on_hover_text(&signal.path);
                    if i == typed.place && (up || down || response.changed()) {
                        answer.scroll_to_me(None);
                    }
                    if answer.clicked() || row.response.interact(egui::Sense::click()).clicked() {
                        chosen = Some(signal.path.clone());
                    }
                }
            });
        });
    if let Some(path) = chosen {
        let change = match typed.purpose.clone() {
            SearchPurpose::Plot => PlotChange::Plot(path),
            SearchPurpose::Curve(plot) => PlotChange::Add(plot, path),
            SearchPurpose::Abscissa(plot) => PlotChange::Against(plot, Some(path)),
        };
        commands.push(ViewChange::Charts(change).into());
        typed = Typed::default();
        ui.memory_mut(|memory| memory.surrender_focus(id()));
    } else {
        // A press on a result takes the focus from the field. It is a click only when released, so the results stay
        // open until then.
        let (pressing, pressed) =
            ui.input(|i| (i.pointer.any_down() || i.pointer.any_released(), i.pointer.any_pressed()));
        let here = response.contains_pointer() || answers.is_some_and(|answers| answers.response.contains_pointer());
        if (!response.has_focus() && !pressing) || (pressed && !here) {
            typed = Typed::default();
        }
    }
    ui.data_mut(|data| data.insert_temp(typed_id(), typed));
}
