//! The hints: the first things to do, one after the other, each until the user has done it. Before the first one two
//! runs of the task loop beside each other, along a straight line and along a reactionless path.

use egui::{Align2, Area, Id, RichText, Ui, vec2};

use super::pointing::Pointed;
use super::theme::{bold, card, colour, plain};
use super::widgets::name;
use super::{Command, Layout, SessionCommand, Switch, ViewChange, ViewState, WindowCommand};
use stillbase_picture::scene::palette::Palette;
use stillbase_session::{Edit, Session};
use stillbase_simulation::frame::Reach;

/// State of the hints.
pub struct Intro {
    /// The present hint, counted from 0.
    hint: usize,
    /// b at the start of the present hint, rad.
    b: f64,
    /// Wall time for which the run has rested at its end, s, and number of restarts.
    rested: f64,
    rounds: u32,
}

/// Width of a narrow view, points, and the length of an explanation that it shows in full, bytes.
const NARROW_VIEW_PT: f32 = 460.0;
const MAX_NARROW_WORDS: usize = 120;

/// Number of hints.
const HINT_COUNT: usize = 3;

/// Returns the text and the explanation of a hint; `None` if there is no such hint. Without a pose constant, or while
/// the run waits, there is one hint, which says why.
fn hint(i: usize, session: &Session) -> Option<(String, String)> {
    let machine = session.scenario().machine.name();
    let map = match (session.run().pose_space(), session.run().waiting()) {
        (Err(why), _) if i == 0 => {
            return Some((format!("{machine} has nothing amber to drag along."), format!("The reason: {why}.")));
        }
        (Ok(_), Some(waits)) if i == 0 => {
            return Some(("The run waits, so nothing can be dragged.".into(), format!("The reason: {}.", waits.why)));
        }
        (Ok(map), None) => map,
        _ => return None,
    };
    // The amber set of reachable points is a curve for two drives, and an area for more drives.
    let (on, off, amber) = if map.reaches_area() { ("inside", "out of", "area") } else { ("on", "off", "curve") };
    let (title, why) = match i {
        0 => (
            "Drag the white ring.".into(),
            format!("The arm follows without a reaction, as long as the ring stays {on} the amber {amber}."),
        ),
        1 => (
            format!("Now drag it {off} the amber {amber}."),
            "The arm waits at the edge, and says which pose constant b would reach it.".into(),
        ),
        2 => (
            "Turn b: the amber ring at the base, or the slider.".into(),
            format!("The amber {amber} turns. While time runs, the base feels what that costs."),
        ),
        _ => return None,
    };
    Some((title, why))
}

/// Pause at the end of the run before it starts over, wall time, s, and maximum number of restarts.
const REST_AT_END_S: f64 = 1.2;
const MAX_RESTARTS: u32 = 20;
impl Intro {
    /// Begins with the first hint.
    pub fn of(session: &Session) -> Self {
        Self { hint: 0, b: session.b_aim(), rested: 0.0, rounds: 0 }
    }

    /// The things that the present hint mentions.
    pub fn points_at(&self) -> &'static [Pointed] {
        match self.hint {
            0 | 1 => &[Pointed::Target],
            _ => &[Pointed::Ring, Pointed::Widget("b slider")],
        }
    }

    /// Adds wall time, s, to the pause at the end of the run; returns whether the run must start over.
    pub fn advance_rest(&mut self, session: &Session, wall: f64) -> bool {
        let waits = session.is_playing() && session.is_at_end() && !session.is_moving() && self.rounds < MAX_RESTARTS;
        self.rested = if waits && session.frame().time >= session.length() { self.rested + wall } else { 0.0 };
        let over = self.rested > REST_AT_END_S;
        if over {
            (self.rested, self.rounds) = (0.0, self.rounds + 1);
        }
        over
    }

    /// Whether the run rests at its end before it starts over.
    pub fn is_resting(&self) -> bool {
        self.rested > 0.0
    }

    /// Observes a command that was carried out: it may complete the hint. Returns whether it ends the demonstration:
    /// it touches the machine, or opens another view, panel or tool. `held` is `true` during a drag.
    pub fn observe(&mut self, command: &Command, session: &Session, held: bool) -> bool {
        let touches = match command {
            Command::Session(
                SessionCommand::Edit(_)
                | SessionCommand::Open(_)
                | SessionCommand::OpenFile(_)
                | SessionCommand::Case(_),
            ) => !held,
            Command::View(
                ViewChange::Switch(Switch::Drawing | Switch::Pushing, _)
                | ViewChange::Switch(Switch::Compare | Switch::Study | Switch::Table, true)
                | ViewChange::Reveal(_)
                | ViewChange::LookUp(_),
            ) => true,
            Command::View(ViewChange::Layout(layout)) => *layout != Layout::Explore,
            Command::View(ViewChange::Kind(view)) => !view.shows_machine(),
            Command::Session(SessionCommand::EndGesture) => {
                session.is_dragged() || (session.b_aim() - self.b).abs() > 1e-9
            }
            _ => false,
        };
        let frame = session.frame();
        let done = match self.hint {
            0 => {
                matches!(command, Command::Session(SessionCommand::Edit(Edit::DragTarget { .. })))
                    && session.is_dragged()
            }
            1 => session.is_dragged() && frame.target.reach != Reach::Inside,
            2 => (session.b_aim() - self.b).abs() > 0.05,
            _ => false,
        };
        if done {
            (self.hint, self.b) = (self.hint + 1, session.b_aim());
        }
        touches
    }

    /// Whether the user has followed all hints.
    pub fn is_over(&self) -> bool {
        self.hint >= HINT_COUNT
    }

    /// Returns the rectangle of a scene that the present hint covers.
    pub fn covers(&self, ctx: &egui::Context, rect: egui::Rect, session: &Session) -> Option<egui::Rect> {
        let usual = egui::Rect::from_min_max(rect.right_bottom() - vec2(406.0, 140.0), rect.right_bottom());
        hint(self.hint, session).map(|_| ctx.memory(|m| m.area_rect(Id::unique("hint"))).unwrap_or(usual))
    }

    /// Draws the present hint over a corner of the scene, if possible where it covers none of the objects that it
    /// mentions.
    pub fn show_hint(
        &self,
        ctx: &egui::Context,
        rect: egui::Rect,
        mentioned: &[egui::Rect],
        session: &Session,
        view_state: &ViewState,
        commands: &mut Vec<Command>,
    ) {
        let Some((title, why)) = hint(self.hint, session) else { return };
        let p = view_state.palette();
        let width = 390.0_f32.min(rect.width() - 32.0);
        let id = Id::unique("hint");
        let size = ctx.memory(|m| m.area_rect(id)).map_or(vec2(width, 100.0), |last| last.size());
        let corner = Corner::kept(ctx, id, view_state, rect, size, mentioned);
        let area = Area::new(id).pivot(Align2::LEFT_TOP);
        area.fixed_pos(corner.place(rect, size).min).show(ctx, |ui| {
            card(&p).show(ui, |ui| {
                ui.set_width(width - 28.0);
                ui.horizontal(|ui| {
                    ui.scope(|ui| {
                        ui.set_max_width(width - 28.0 - DOTS_WIDTH_PT);
                        ui.add(egui::Label::new(RichText::new(title).font(bold(14.0)).color(colour(p.ink))).wrap());
                    });
                    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| dots(ui, &p, self.hint));
                });
                let words = egui::Label::new(RichText::new(&why).font(plain(12.0)).color(colour(p.dim)));
                // A narrow view has no room for a long reason beside the machine.
                match rect.width() < NARROW_VIEW_PT && why.len() > MAX_NARROW_WORDS {
                    true => ui.add(words.truncate()).on_hover_text(&why),
                    false => ui.add(words.wrap()),
                };
                let skip = egui::Button::new(RichText::new("Esc: never again").font(plain(11.0)).color(colour(p.dim)));
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                    let skip = ui.add(skip.frame(false)).on_hover_text("No more hints, now and at the next start");
                    name(&skip, "No more hints");
                    if skip.clicked() {
                        commands.push(WindowCommand::SkipHints.into());
                    }
                });
            });
        });
    }
}

/// Corner of a scene for a card.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Corner {
    RightBottom,
    LeftBottom,
    RightTop,
    LeftTop,
}

impl Corner {
    const ALL: [Self; 4] = [Self::RightBottom, Self::LeftBottom, Self::RightTop, Self::LeftTop];

    /// Returns the freest corner for the card with this id; during a drag the card stays in its corner.
    pub fn kept(
        ctx: &egui::Context,
        id: Id,
        view_state: &ViewState,
        rect: egui::Rect,
        size: egui::Vec2,
        mentioned: &[egui::Rect],
    ) -> Self {
        let id = id.with("corner");
        let corner = view_state.gesture.grabbed.and_then(|_| ctx.data(|d| d.get_temp::<Self>(id)));
        let corner = corner.unwrap_or_else(|| Self::freest(rect, size, mentioned));
        ctx.data_mut(|d| d.insert_temp(id, corner));
        corner
    }

    /// Returns the rectangle of a card of this size.
    pub fn place(self, rect: egui::Rect, size: egui::Vec2) -> egui::Rect {
        // The card stays clear of the scene's numbers at the top and of its scale at the bottom.
        let (x, [top, bottom]) = ([16.0, rect.width() - 16.0 - size.x], [64.0, rect.height() - 40.0 - size.y]);
        let [x, y] = match self {
            Self::RightBottom => [x[1], bottom],
            Self::LeftBottom => [x[0], bottom],
            Self::RightTop => [x[1], top],
            Self::LeftTop => [x[0], top],
        };
        egui::Rect::from_min_size(rect.min + vec2(x, y), size)
    }

    /// Returns the corner whose card covers the least area of these rectangles; of equal corners, the first.
    fn freest(rect: egui::Rect, size: egui::Vec2, mentioned: &[egui::Rect]) -> Self {
        let covered = |corner: &Self| {
            let card = corner.place(rect, size).expand(6.0);
            let common = mentioned.iter().map(|part| card.intersect(*part)).filter(|part| part.is_positive());
            common.map(|part| part.area()).sum::<f32>()
        };
        Self::ALL.into_iter().min_by(|a, b| covered(a).total_cmp(&covered(b))).unwrap_or(Self::RightBottom)
    }
}

/// Space for the dots beside the title of a hint, points.
const DOTS_WIDTH_PT: f32 = 64.0;

fn dots(ui: &mut Ui, p: &Palette, present: usize) {
    for i in (0..HINT_COUNT).rev() {
        let (rect, _) = ui.allocate_exact_size(vec2(8.0, 8.0), egui::Sense::hover());
        let tone = if i == present { p.amber } else { p.line };
        ui.painter().circle_filled(rect.center(), 3.0, colour(tone));
    }
}
