//! The context menu of the scene, for the object and the position under the pointer.

use egui::{Id, PointerButton, Pos2, Response, Ui};

use super::notation;
use super::widgets::CLICK_PAYLOAD;
use super::{Command, GuidePage, GuidePlace, GuideStep, NoteDraft, SessionCommand, ViewChange, place};
use stillbase_mechanics::planar::Vector;
use stillbase_picture::numbers::signed;
use stillbase_picture::scene::options::Handle;
use stillbase_session::scenario::{NoteTime, SnapPoint};
use stillbase_session::{Edit, Session};

/// Object and position of the menu.
#[derive(Clone, Default)]
pub struct MenuSubject {
    /// Object under the pointer.
    pub thing: Option<Handle>,
    /// Position in the plane of motion, m.
    pub at: Option<[f64; 2]>,
    /// Point to which a note would stick.
    pub point: Option<SnapPoint>,
    /// Index of the measurement under the pointer.
    pub measurement: Option<usize>,
    /// Position on the screen.
    pub pos: Option<Pos2>,
}

/// Draws the menu while it is open; `subject` returns what is under the pointer.
pub fn show(
    response: &Response,
    session: &Session,
    subject: impl FnOnce() -> MenuSubject,
    commands: &mut Vec<Command>,
) {
    let id = Id::unique("menu of the scene");
    if response.clicked_by(PointerButton::Secondary) {
        response.ctx.data_mut(|data| data.insert_temp(id, Some(subject())));
    }
    let Some(about) = response.ctx.data(|data| data.get_temp::<Option<MenuSubject>>(id)).flatten() else { return };
    response.context_menu(|ui| entries(ui, session, about, commands));
}

fn entries(ui: &mut Ui, session: &Session, about: MenuSubject, commands: &mut Vec<Command>) {
    let MenuSubject { thing, at, point, measurement, pos } = about;
    ui.set_min_width(200.0);
    let task = &session.scenario().task;
    let mut entry = |ui: &mut Ui, words: &str, new: Vec<Command>| {
        if ui.button(words).clicked() {
            commands.extend(new);
            ui.close();
        }
    };
    let once =
        |edit: Edit| vec![Command::Session(SessionCommand::Edit(edit)), Command::Session(SessionCommand::EndGesture)];
    if let Some(thing) = thing.filter(|thing| place::is_in_panel(*thing)) {
        entry(ui, "Show in the panel", vec![Command::View(ViewChange::Reveal(thing))]);
    }
    if let Some(Handle::Waypoint(i)) = thing
        && let Some(change) = task.removing(i)
    {
        entry(ui, &format!("Leave point {} out", task.name_of(i)), once(Edit::of("task", change)));
    }
    if thing == Some(Handle::Target) && session.is_dragged() {
        entry(ui, "Back to the path", vec![Command::Session(SessionCommand::BackToPath)]);
    }
    if thing == Some(Handle::Payload) {
        entry(ui, "Take the payload off", once(Edit::set("plant.payload", "default")));
    }
    let machine = &session.scenario().machine;
    let on_tip = thing == Some(Handle::Target) || thing == Some(Handle::Link(machine.end_link()));
    if on_tip && session.scenario().plant.payload.mass == 0.0 {
        let words = format!("Hang a payload of {CLICK_PAYLOAD} kg on it");
        entry(ui, &words, once(Edit::set("plant.payload.mass", CLICK_PAYLOAD)));
    }
    if let Some([x, y]) = at {
        if thing != Some(Handle::Target) && session.run().pose_space().is_ok() {
            entry(ui, "Send the target here", once(Edit::DragTarget { x, y }));
        }
        if let Some(change) = task.adding(Vector::new(x, y)) {
            entry(ui, "Add a point of the path here", once(Edit::of("task", change)));
        }
        let words = format!("Copy {}, {} m", signed(x, 3), signed(y, 3));
        if ui.button(notation::sentence(ui.ctx(), &words)).clicked() {
            ui.ctx().copy_text(format!("{x:.4}, {y:.4}"));
            ui.close();
        }
    }
    if let Some(point) = point {
        let draft = NoteDraft::new(Some(point), NoteTime::Always, pos);
        entry(ui, "Write a note here", vec![ViewChange::WriteNote(Some(draft)).into()]);
    }
    if measurement.is_some() {
        entry(ui, "Remove this measure", vec![ViewChange::DropMeasurement(measurement).into()]);
    }
    ui.separator();
    entry(ui, "Show everything", vec![Command::View(ViewChange::Fit)]);
    let about = guide_of(thing);
    entry(ui, "What the guide says of it", vec![Command::View(ViewChange::Guide(GuideStep::Go(about)))]);
}

/// Returns the place of the guide that explains an object of the scene.
fn guide_of(thing: Option<Handle>) -> GuidePlace {
    match thing {
        Some(Handle::Base | Handle::Force | Handle::Moment) => GuidePlace::under(GuidePage::Plants, "Bases"),
        Some(Handle::Payload) => GuidePlace::under(GuidePage::Plants, "What a payload is"),
        Some(Handle::Ring | Handle::Boundary) => GuidePlace::under(GuidePage::Planning, "Which b reaches a point"),
        Some(Handle::Waypoint(_)) => GuidePlace::under(GuidePage::Planning, "A motion through points"),
        Some(Handle::Mass(_) | Handle::Weight(_) | Handle::Lump(_) | Handle::End(_)) => GuidePage::Design.into(),
        _ => GuidePlace::under(GuidePage::FirstRun, "What you see"),
    }
}
