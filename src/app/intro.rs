//! The introduction: one task along a straight line and along a reactionless path. Both runs loop side by side until
//! the user touches the machine. Hints appear one after the other, each until the user has followed it.

use std::sync::Arc;

use egui::{Align2, Area, Id, RichText, Ui, vec2};

use super::theme::{bold, card, colour, plain};
use super::widgets::name;
use super::{Command, Layout, SessionCommand, Switch, ViewChange, ViewState, WindowCommand};
use stillbase_picture::numbers::signed;
use stillbase_picture::paint::labels::draw_labels;
use stillbase_picture::paint::{SceneViewport, paint};
use stillbase_picture::scene::camera::Camera;
use stillbase_picture::scene::exaggeration::Exaggeration;
use stillbase_picture::scene::options::ViewOptions;
use stillbase_picture::scene::palette::{Palette, Theme};
use stillbase_picture::scene::stage::Stage;
use stillbase_picture::scene::{Rgba, Scene};
use stillbase_session::scenario::Scenario;
use stillbase_session::{Edit, Refusal, Run, Session};
use stillbase_simulation::frame::{Frame as Instant, Reach};
use stillbase_study::comparison::Comparison;

/// State of the introduction.
pub struct Intro {
    /// The same task along a straight line; shown until the machine is touched.
    straight: Option<Straight>,
    /// The present hint, counted from 0.
    hint: usize,
    /// b at the start of the present hint, rad.
    b: f64,
    /// Wall time for which the run has rested at its end, s, and number of restarts.
    rested: f64,
    rounds: u32,
}

/// The run along a straight line, with base reactions.
struct Straight {
    run: Comparison,
    stage: Stage,
}

/// Number of hints.
const HINT_COUNT: usize = 3;

/// Returns the text and the explanation of a hint; `None` if the machine cannot be dragged, or if there is no such
/// hint.
fn hint(i: usize, session: &Session) -> Option<(String, String)> {
    let map = session.run().pose_space().ok().filter(|_| session.can_be_dragged())?;
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
/// Compliance of the drawn mount of the base, rad/(N m); it is soft, so that the rotation can be seen.
const MOUNT_COMPLIANCE: f64 = 0.03;
/// Minimum width of two scenes side by side, points.
const MIN_WIDTH_OF_BOTH_PT: f32 = 680.0;

impl Intro {
    /// Creates the introduction for a session on the built-in reactionless case.
    ///
    /// # Errors
    /// If the run along the straight line cannot be made.
    pub fn for_session(session: &Session) -> Result<Self, Refusal> {
        let straight = match Scenario::builtin("case-1") {
            Some(case) => {
                let scenario = Scenario { compare_b: None, ..case };
                let stage = Stage::begun(&Run::new(&scenario)?).without_workspace();
                let mut run = Comparison::empty(&scenario);
                run.keep(scenario)?;
                Some(Straight { run, stage })
            }
            None => None,
        };
        Ok(Self { straight, hint: 0, b: session.b_aim(), rested: 0.0, rounds: 0 })
    }

    /// Whether both runs are shown in a view of this width, points.
    pub fn shows_both(&self, width: f32) -> bool {
        self.straight.is_some() && width >= MIN_WIDTH_OF_BOTH_PT
    }

    /// Whether both runs are shown in a window of this width, points; the scenes then take the space of the settings.
    pub fn contrasts_in(&self, width: f32) -> bool {
        self.straight.is_some() && width >= MIN_WIDTH_OF_BOTH_PT + 360.0
    }

    /// Returns the run along the straight line, for the plots.
    pub fn straight_comparison(&self) -> Option<&Comparison> {
        self.straight.as_ref().map(|straight| &straight.run)
    }

    /// Whether the demonstration still runs, because the user has not touched the machine yet.
    pub fn demonstrates(&self) -> bool {
        self.straight.is_some()
    }

    /// Adds wall time, s, to the pause at the end of the run; returns whether the run must start over.
    pub fn advance_rest(&mut self, session: &Session, wall: f64) -> bool {
        let waits = self.straight.is_some()
            && session.is_playing()
            && session.is_at_end()
            && !session.is_moving()
            && self.rounds < MAX_RESTARTS;
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

    /// Observes a command that was carried out: it may end the demonstration or complete the hint. `held` is `true`
    /// during a drag.
    pub fn observe(&mut self, command: &Command, session: &Session, held: bool) {
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
        if touches {
            self.straight = None;
        }
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
    }

    /// Whether the user has touched the machine and followed all hints.
    pub fn is_over(&self) -> bool {
        self.straight.is_none() && self.hint >= HINT_COUNT
    }

    /// Returns the frame of the straight run at the time of another frame, and its scene.
    pub fn straight(&self, now: &Instant, theme: Theme) -> Option<(&Instant, Scene)> {
        let straight = self.straight.as_ref()?;
        let frame = straight.run.shown().next()?.1.at(now.time)?;
        let exaggeration = Exaggeration::Mount(MOUNT_COMPLIANCE);
        let options = ViewOptions { theme, show_hints: false, exaggeration, ..Default::default() };
        Some((frame, straight.stage.scene(frame, &options)))
    }

    /// Draws the straight run on the left of a view, with its caption.
    pub fn show_straight(&self, ui: &Ui, rect: egui::Rect, now: &Instant, camera: &Camera, view_state: &ViewState) {
        let Some((frame, scene)) = self.straight(now, view_state.arrangement.theme) else { return };
        let scene = Scene { notation: view_state.arrangement.notation, ..scene };
        let (p, scene) = (view_state.palette(), Arc::new(scene));
        paint(ui, 1, rect, &scene, camera);
        draw_labels(ui, &SceneViewport { rect, camera: *camera }, &scene, &[]);
        let turn = MOUNT_COMPLIANCE.to_degrees();
        let words = format!("From A to B along a line. The arm shakes its base, drawn {turn:.0}° for 1 N m.");
        let words = view_state.arrangement.notation.sentence(&words);
        caption(ui, rect, &p, "Straight line", &words, frame.wrench.total().moment, p.reaction);
        ui.painter().vline(rect.right(), rect.y_range(), egui::Stroke::new(1.0, colour(p.line)));
    }

    /// Draws the caption of the reactionless run, on the right.
    pub fn caption(&self, ui: &Ui, rect: egui::Rect, now: &Instant, view_state: &ViewState) {
        let p = view_state.palette();
        let words = "From A to B on one plane of joint space. The base feels nothing.";
        caption(ui, rect, &p, "Reactionless path", words, now.wrench.total().moment, p.zero);
    }

    /// Returns the rectangles covered in a scene: the present hint, and the caption while both runs are shown.
    pub fn covers(&self, ctx: &egui::Context, rect: egui::Rect, session: &Session, both: bool) -> Vec<egui::Rect> {
        let usual = egui::Rect::from_min_max(rect.right_bottom() - vec2(406.0, 140.0), rect.right_bottom());
        let hint = hint(self.hint, session).map(|_| ctx.memory(|m| m.area_rect(Id::unique("hint"))).unwrap_or(usual));
        let caption = egui::Rect::from_min_size(rect.min, vec2(rect.width().min(420.0), 108.0));
        hint.into_iter().chain(both.then_some(caption)).collect()
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
        let corner_id = Id::unique("corner of the hint");
        // During a drag the hint stays in its corner.
        let corner = view_state.gesture.grabbed.and_then(|_| ctx.data(|d| d.get_temp::<Corner>(corner_id)));
        let corner = corner.unwrap_or_else(|| Corner::freest(rect, size, mentioned));
        ctx.data_mut(|d| d.insert_temp(corner_id, corner));
        let area = Area::new(id).pivot(Align2::LEFT_TOP);
        area.fixed_pos(corner.place(rect, size).min).show(ctx, |ui| {
            card(&p).show(ui, |ui| {
                ui.set_width(width - 28.0);
                ui.horizontal(|ui| {
                    ui.label(RichText::new(title).font(bold(14.0)).color(colour(p.ink)));
                    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| dots(ui, &p, self.hint));
                });
                ui.add(egui::Label::new(RichText::new(why).font(plain(12.0)).color(colour(p.dim))).wrap());
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
enum Corner {
    RightBottom,
    LeftBottom,
    RightTop,
    LeftTop,
}

impl Corner {
    const ALL: [Self; 4] = [Self::RightBottom, Self::LeftBottom, Self::RightTop, Self::LeftTop];

    /// Returns the rectangle of a card of this size.
    fn place(self, rect: egui::Rect, size: egui::Vec2) -> egui::Rect {
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

fn dots(ui: &mut Ui, p: &Palette, present: usize) {
    for i in (0..HINT_COUNT).rev() {
        let (rect, _) = ui.allocate_exact_size(vec2(8.0, 8.0), egui::Sense::hover());
        let tone = if i == present { p.amber } else { p.line };
        ui.painter().circle_filled(rect.center(), 3.0, colour(tone));
    }
}

/// Draws a title over a scene; below it, a text and the moment on the base, N m.
fn caption(ui: &Ui, rect: egui::Rect, p: &Palette, title: &str, about: &str, moment: f64, tone: Rgba) {
    let painter = ui.painter().with_clip_rect(rect);
    let left = rect.left() + 22.0;
    let room = rect.width() - 40.0;
    let title = painter.layout_no_wrap(title.into(), bold(16.0), colour(p.ink));
    let about = painter.layout(about.into(), plain(12.0), colour(p.dim), room);
    let below = rect.top() + 36.0 + about.size().y + 8.0;
    painter.galley(egui::pos2(left, rect.top() + 12.0), title, colour(p.ink));
    painter.galley(egui::pos2(left, rect.top() + 36.0), about, colour(p.dim));
    let shown = signed(moment + 0.0, 2);
    let number = painter.text(egui::pos2(left, below), Align2::LEFT_TOP, shown, bold(26.0), colour(tone));
    let unit = number.right_bottom() + vec2(8.0, -4.0);
    painter.text(unit, Align2::LEFT_BOTTOM, "N m   turning moment on the base, n_B", plain(12.0), colour(p.dim));
}
