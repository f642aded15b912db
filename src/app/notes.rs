//! The card in which the user writes, changes or removes a note, and the notes of the scene that open it.

use egui::{Align2, Area, ComboBox, CursorIcon, DragValue, Frame, Id, Key, Order, Pos2, RichText, Sense, TextEdit, Ui};

use super::theme::{bold, colour, plain};
use super::widgets::{self, name};
use super::{Command, SessionCommand, Tool, ViewChange, ViewState};
use stillbase_picture::paint::labels::PlacedLabel;
use stillbase_picture::scene::views::Views;
use stillbase_picture::scene::{Label, NOTES};
use stillbase_session::Session;
use stillbase_session::scenario::{MAX_NOTE, MAX_TIME, Note, NoteTime, SnapPoint};

/// A note that is being written.
#[derive(Clone, Debug)]
pub struct NoteDraft {
    /// Index of the note in the session and its state there, if it is not new.
    known: Option<(usize, Note)>,
    note: Note,
    /// Position of the card on the screen.
    place: Option<Pos2>,
    /// Whether the field of the text has had the focus.
    has_begun: bool,
}

/// Width of the card, and distance between it and the place that it belongs to, points.
const WIDTH_PT: f32 = 300.0;
const GAP_PT: f32 = 14.0;
/// Maximum height of the list of points, points.
const LIST_HEIGHT_PT: f32 = 380.0;
/// Distance of a card that belongs to no place from the upper edge of the window, points.
const TOP_PT: f32 = 96.0;

impl NoteDraft {
    /// Begins a new note; the card stands beside `place`, points of the screen.
    pub fn new(point: Option<SnapPoint>, time: NoteTime, place: Option<Pos2>) -> Self {
        Self { known: None, note: Note { text: String::new(), point, time }, place, has_begun: false }
    }

    /// Begins a change of the note with an index, if there is one.
    pub fn of(session: &Session, index: usize, place: Option<Pos2>) -> Option<Self> {
        let note = session.notes().get(index)?.clone();
        Some(Self { known: Some((index, note.clone())), note, place, has_begun: false })
    }

    /// Whether the note that is changed still exists as it was.
    fn is_current(&self, session: &Session) -> bool {
        self.known.as_ref().is_none_or(|(i, was)| session.notes().get(*i) == Some(was))
    }
}

/// Makes the drawn notes of the scene react: a click opens the card of a note.
pub fn labels(ui: &Ui, placed: &[PlacedLabel], session: &Session, tool: &Tool, commands: &mut Vec<Command>) {
    let own = |label: &Label| label.name.strip_prefix(NOTES)?.strip_prefix('/')?.parse::<usize>().ok()?.checked_sub(1);
    for (i, rect) in placed.iter().filter_map(|it| Some((own(&it.label)?, it.place))) {
        let Some(note) = session.notes().get(i).filter(|_| *tool == Tool::Hold) else { continue };
        let response = ui.interact(rect, ui.scope_id().with(("note", i)), Sense::click());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, format!("Note: {}", note.text)));
        let response = response.on_hover_cursor(CursorIcon::PointingHand);
        if response.clicked() || response.secondary_clicked() {
            commands.push(ViewChange::WriteNote(NoteDraft::of(session, i, Some(rect.left_bottom()))).into());
        }
    }
}

/// Draws the card, and handles Enter and Esc.
pub fn show(
    ctx: &egui::Context,
    session: &Session,
    views: &Views,
    view_state: &mut ViewState,
    commands: &mut Vec<Command>,
) {
    let Some(mut draft) = view_state.open.note.take().filter(|draft| draft.is_current(session)) else { return };
    let p = view_state.palette();
    let area = Area::new(Id::unique("note")).order(Order::Foreground).constrain(true);
    let area = match draft.place {
        Some(place) => area.fixed_pos(place + egui::vec2(0.0, GAP_PT)),
        None => area.anchor(Align2::CENTER_TOP, [0.0, TOP_PT]),
    };
    let frame = Frame::popup(&ctx.global_style()).fill(colour(p.panel)).inner_margin(10);
    // With a list open, Esc only closes the list.
    let leaves = !egui::Popup::is_any_open(ctx) && ctx.input(|i| i.key_pressed(Key::Escape));
    let mut done = leaves;
    area.show(ctx, |ui| {
        frame.show(ui, |ui| {
            ui.set_width(WIDTH_PT);
            ui.label(RichText::new("NOTE").font(bold(11.0)).color(colour(p.dim)));
            let entered = text(ui, &mut draft);
            egui::Grid::new("note sticks to").num_columns(2).spacing([10.0, 6.0]).show(ui, |ui| {
                ui.label(RichText::new("where").font(plain(12.0)).color(colour(p.dim)));
                point(ui, &mut draft.note, views);
                ui.end_row();
                ui.label(RichText::new("when").font(plain(12.0)).color(colour(p.dim)));
                ui.vertical(|ui| time(ui, &mut draft.note.time, session));
                ui.end_row();
            });
            let wrong = draft.note.check(&session.scenario().machine).err();
            if let Some(why) = wrong.as_ref().filter(|_| !draft.note.text.is_empty()) {
                ui.label(RichText::new(why).font(plain(12.0)).color(colour(p.reaction)));
            }
            ui.horizontal(|ui| {
                let word = if draft.known.is_some() { "Change" } else { "Write" };
                let writes = ui.add_enabled(wrong.is_none(), egui::Button::new(word)).clicked();
                if (writes || entered) && wrong.is_none() {
                    let index = draft.known.as_ref().map(|(i, _)| *i);
                    commands.push(SessionCommand::Note(index, draft.note.clone()).into());
                    done = true;
                }
                if let Some((i, _)) = &draft.known
                    && ui.button("Remove").clicked()
                {
                    commands.push(SessionCommand::DropNote(*i).into());
                    done = true;
                }
                done |= ui.button("Cancel").clicked();
            });
        });
    });
    if !done {
        view_state.open.note = Some(draft);
    }
}

/// Draws the field of the text; returns whether the user has pressed Enter in it.
fn text(ui: &mut Ui, draft: &mut NoteDraft) -> bool {
    let field = TextEdit::singleline(&mut draft.note.text).hint_text("a short text").char_limit(MAX_NOTE);
    let field = ui.add(field.desired_width(f32::INFINITY));
    name(&field, "Text of the note");
    if !std::mem::replace(&mut draft.has_begun, true) {
        field.request_focus();
    }
    field.lost_focus() && ui.input(|i| i.key_pressed(Key::Enter))
}

/// Draws the list of points to which the note can stick.
fn point(ui: &mut Ui, note: &mut Note, views: &Views) {
    let title = |point: &Option<SnapPoint>| match point {
        Some(point) => super::notation::sentence(ui.ctx(), &point.title()).into_owned(),
        None => "nowhere: on the time line alone".to_owned(),
    };
    let place = note.point.clone().filter(|point| matches!(point, SnapPoint::Place(_)));
    let all = std::iter::once(None).chain(place.map(Some)).chain(views.stage().snap_points().into_iter().map(Some));
    let all: Vec<(String, Option<SnapPoint>)> = all.map(|point| (title(&point), point)).collect();
    let list = ComboBox::from_id_salt("where").selected_text(title(&note.point));
    let list = list.width(WIDTH_PT - 60.0).height(LIST_HEIGHT_PT);
    let moved = widgets::steps(ui);
    let shown = list.show_ui(ui, |ui| {
        for (title, point) in &all {
            let line = ui.selectable_value(&mut note.point, point.clone(), title);
            if moved && note.point == *point {
                line.scroll_to_me(None);
            }
        }
    });
    name(&shown.response, "Where the note sticks");
    if let Some(next) = widgets::stepped(ui, &shown.response, all.iter().map(|(_, point)| point), &note.point) {
        note.point = next;
    }
}

/// Draws the choice of the time: always, an instant, or an interval.
fn time(ui: &mut Ui, time: &mut NoteTime, session: &Session) {
    let now = session.frame().time;
    let start = time.start().unwrap_or(now);
    ui.horizontal(|ui| {
        let kinds = [
            ("always", NoteTime::Always),
            ("an instant", NoteTime::At(start)),
            ("an interval", NoteTime::Between([start, session.length().max(start)])),
        ];
        for (word, kind) in kinds {
            let on = std::mem::discriminant(time) == std::mem::discriminant(&kind);
            if ui.selectable_label(on, word).clicked() && !on {
                *time = kind;
            }
        }
    });
    let seconds = |ui: &mut Ui, label: &str, time: &mut f64, low: f64| {
        let value = DragValue::new(time).range(low..=MAX_TIME).speed(session.scenario().step).max_decimals(3);
        let field = ui.add(value.min_decimals(3).suffix(" s"));
        name(&field, label);
    };
    match time {
        NoteTime::Always => {}
        NoteTime::At(at) => seconds(ui, "Instant of the note", at, 0.0),
        NoteTime::Between([from, to]) => {
            ui.horizontal(|ui| {
                seconds(ui, "Start of the note", from, 0.0);
                ui.label("to");
                *to = to.max(*from);
                seconds(ui, "End of the note", to, *from);
            });
        }
    }
}
