//! The time line: the clock, a slider over the run, and above it marks for bookmarks, notes, events and branches.

use egui::{
    Key, Popup, PopupCloseBehavior, Rect, Response, RichText, Sense, Shape, Stroke, TextEdit, Tooltip, Ui, pos2, vec2,
};

use super::icon::{Icon, IconButton};
use super::marks::{MarkGroup, Marks, Tone};
use super::theme::{bold, colour, plain};
use super::widgets::name;
use super::{Command, NoteDraft, SessionCommand, Switch, ViewChange, ViewState};
use stillbase_picture::scene::palette::{Palette, faded};
use stillbase_session::Session;
use stillbase_session::scenario::NoteTime;

/// Gap between a mark and its tooltip or card, points, so that these do not cover the bar.
const POPUP_GAP_PT: f32 = 32.0;

/// Draws the time line, from right to left; `behind` is the playback rate if it lags behind the requested one.
pub fn show(
    ui: &mut Ui,
    session: &Session,
    (marks, behind): (&Marks, Option<f64>),
    view_state: &ViewState,
    commands: &mut Vec<Command>,
) {
    let p = view_state.palette();
    let (mut time, length) = (session.frame().time, session.length().max(1e-3));
    clock(ui, &p, time, length, behind);
    let tip = "Play over and over: the time range chosen in the plots, or else the whole run (O)";
    let again = IconButton { on: Some(view_state.loops), ..IconButton::of(Icon::Loop, "loop", tip) };
    if again.show(ui, &p).clicked() {
        commands.push(ViewChange::Switch(Switch::Loop, !view_state.loops).into());
    }
    ui.spacing_mut().slider_width = (ui.available_width() - 16.0).max(60.0);
    ui.spacing_mut().interact_size.y = 15.0;
    let slider = egui::Slider::new(&mut time, 0.0..=length).show_value(false).step_by(session.scenario().step);
    let response = ui.add(slider).on_hover_text("Time, s");
    name(&response, "Time");
    if response.changed() {
        commands.push(SessionCommand::Seek(time).into());
    }
    // The centre of the slider's handle stays one radius of the handle away from both ends of the slider.
    let line = response.rect.shrink2(vec2(response.rect.height() / 2.5, 0.0));
    intervals(ui, &p, session, line, length);
    let mut taken = false;
    let naming_time = view_state.open.naming.filter(|time| session.bookmark_at(*time).is_some());
    let mut named = false;
    for group in marks.on_line(length, f64::from(line.width())).iter() {
        let x = line.left() + line.width() * (group.time / length) as f32;
        let response = mark(ui, &p, group, [x, line.top()], commands);
        taken |= response.secondary_clicked();
        let near = 0.5 * session.scenario().step;
        let within = |time: &f64| (group.span[0] - near..=group.span[1] + near).contains(time);
        if group.tone == Tone::Note && response.secondary_clicked() {
            let note = session.notes().iter().position(|note| note.time.start().is_some_and(|time| within(&time)));
            let draft = note.and_then(|i| NoteDraft::of(session, i, Some(response.rect.left_bottom())));
            commands.push(ViewChange::WriteNote(draft).into());
        }
        if let Some(time) = naming_time.filter(within).filter(|_| !named) {
            naming(&response, &p, session, time, commands);
            named = true;
        }
    }
    // Beside the marks, the right button writes a note for the time under the pointer.
    let pressed = ui.input(|i| i.pointer.secondary_clicked().then(|| i.pointer.interact_pos()).flatten());
    if let Some(pos) = pressed.filter(|_| response.contains_pointer() && !taken) {
        let share = f64::from(((pos.x - line.left()) / line.width().max(1.0)).clamp(0.0, 1.0));
        let step = session.scenario().step;
        let time = NoteTime::At((share * length / step).round() * step);
        commands.push(ViewChange::WriteNote(Some(NoteDraft::new(None, time, Some(pos)))).into());
    }
    // The field closes when its bookmark does not exist any more.
    if view_state.open.naming.is_some() && !named {
        commands.push(ViewChange::LeaveNaming.into());
    }
}

/// Draws a bar for the interval of each note that has one.
fn intervals(ui: &Ui, p: &Palette, session: &Session, line: Rect, length: f64) {
    let x = |time: f64| line.left() + line.width() * (time / length).clamp(0.0, 1.0) as f32;
    for note in session.notes() {
        let NoteTime::Between([from, to]) = note.time else { continue };
        if from <= length {
            let bar = Rect::from_x_y_ranges(x(from)..=x(to), line.top() - 2.0..=line.top());
            ui.painter().rect_filled(bar, 1.0, colour(faded(p.ink, 0.55)));
        }
    }
}

/// Draws the clock, and below it the playback rate if it lags.
fn clock(ui: &mut Ui, p: &Palette, time: f64, length: f64, behind: Option<f64>) {
    // A narrow window keeps the space for the slider.
    let text = match ui.available_width() > 290.0 {
        true => format!("{time:.3} / {length:.3} s"),
        false => format!("{time:.3} s"),
    };
    let clock = ui.label(RichText::new(text).font(plain(12.5)).color(colour(p.dim)));
    let Some(rate) = behind else { return };
    // The playback rate takes no space in the layout, so that nothing beside it moves.
    let below =
        Rect::from_min_max(clock.rect.left_bottom() - vec2(30.0, 1.0), clock.rect.right_bottom() + vec2(0.0, 12.0));
    let words = RichText::new(pace(rate)).font(plain(10.5)).color(colour(p.ink));
    let layout = egui::Layout::right_to_left(egui::Align::Center);
    let mut below = ui.new_child(egui::UiBuilder::new().max_rect(below).layout(layout));
    below
        .label(words)
        .on_hover_text("The run takes longer to compute than it lasts: time is slowed, and no frame is left out");
}

/// Returns the text of a playback rate, such as `0.6× real time`.
fn pace(rate: f64) -> String {
    match rate {
        rate if rate < 0.095 => format!("{rate:.2}× real time"),
        rate => format!("{rate:.1}× real time"),
    }
}

/// Draws a mark: a triangle above the line, or a disc for a note. A click shows its instant; the right button edits a
/// bookmark or lists the branches.
fn mark(ui: &Ui, p: &Palette, group: &MarkGroup, [x, top]: [f32; 2], commands: &mut Vec<Command>) -> Response {
    let tone = match group.tone {
        Tone::Bookmark => p.amber,
        Tone::Peak => p.reaction,
        Tone::Event => p.dim,
        Tone::Fork | Tone::Note => p.ink,
    };
    let rect = Rect::from_min_max(pos2(x - 6.0, top - 10.0), pos2(x + 6.0, top + 2.0));
    let response = ui.interact(rect, ui.scope_id().with(("mark", (group.time * 1e6) as i64)), Sense::click());
    let [low, high] = [top, top - if response.hovered() { 7.5 } else { 6.0 }];
    let corners = vec![pos2(x - 4.0, low), pos2(x, high), pos2(x + 4.0, low)];
    ui.painter().add(match group.tone {
        Tone::Fork => Shape::closed_line(corners, Stroke::new(1.0, colour(tone))),
        Tone::Note => Shape::circle_filled(pos2(x, 0.5 * (low + high)), 0.5 * (low - high), colour(tone)),
        _ => Shape::convex_polygon(corners, colour(tone), Stroke::NONE),
    });
    if response.has_focus() {
        ui.painter().rect_stroke(rect, 3.0, Stroke::new(1.5, colour(p.amber)), egui::StrokeKind::Inside);
    }
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &group.words));
    Tooltip::for_enabled(&response).gap(POPUP_GAP_PT).show(|ui| descriptions(ui, p, group));
    if response.clicked() {
        commands.push(SessionCommand::Seek(group.time).into());
    }
    match group.tone {
        Tone::Bookmark if response.secondary_clicked() => {
            commands.push(SessionCommand::NameBookmark(group.time).into())
        }
        // The list of changes contains the branches.
        Tone::Fork if response.secondary_clicked() => commands.push(ViewChange::Switch(Switch::History, true).into()),
        _ => {}
    }
    response
}

/// Draws time and description of each mark of a group.
fn descriptions(ui: &mut Ui, p: &Palette, group: &MarkGroup) {
    let dim = |text: String| RichText::new(text).font(plain(12.5)).color(colour(p.dim));
    egui::Grid::new("mark told").num_columns(2).spacing([12.0, 3.0]).show(ui, |ui| {
        for (when, what) in &group.lines {
            ui.label(dim(when.clone()));
            ui.add(egui::Label::new(RichText::new(what).font(plain(12.5))).extend());
            ui.end_row();
        }
        if group.more > 0 {
            ui.label("");
            ui.label(dim(format!("and {} more", group.more)));
            ui.end_row();
        }
    });
}

/// Draws a card below a bookmark, in which the user renames or removes it.
fn naming(mark: &Response, p: &Palette, session: &Session, time: f64, commands: &mut Vec<Command>) {
    let Some(known) = session.bookmark_at(time) else { return };
    let id = egui::Id::unique(("bookmark name", (time * 1e6) as i64));
    let mut open = true;
    let popup = Popup::from_response(mark).open_bool(&mut open).gap(POPUP_GAP_PT).width(220.0);
    popup.close_behavior(PopupCloseBehavior::CloseOnClickOutside).show(|ui| {
        ui.label(RichText::new(format!("BOOKMARK AT {time:.3} s")).font(bold(11.0)).color(colour(p.dim)));
        let typed = ui.data(|data| data.get_temp::<String>(id));
        let begins = typed.is_none();
        let mut typed = typed.unwrap_or_else(|| known.name.clone());
        let field = ui.add(TextEdit::singleline(&mut typed).desired_width(f32::INFINITY).char_limit(59));
        name(&field, "Name of the bookmark");
        if begins {
            field.request_focus();
        }
        let enter = field.lost_focus() && ui.input(|i| i.key_pressed(Key::Enter));
        ui.horizontal(|ui| {
            if enter || ui.button("Rename").clicked() {
                let new = if typed.trim().is_empty() { known.name.clone() } else { typed.clone() };
                commands.push(SessionCommand::Bookmark(time, new).into());
                commands.push(ViewChange::LeaveNaming.into());
            }
            if ui.button("Remove").clicked() {
                commands.push(SessionCommand::Bookmark(time, String::new()).into());
                commands.push(ViewChange::LeaveNaming.into());
            }
        });
        ui.data_mut(|data| data.insert_temp(id, typed));
    });
    let done = commands.iter().any(|command| matches!(command, Command::View(ViewChange::LeaveNaming)));
    if !open && !done {
        commands.push(ViewChange::LeaveNaming.into());
    }
    if !open || done {
        mark.ctx.data_mut(|data| data.remove_temp::<String>(id));
    }
}
