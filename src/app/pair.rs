//! [`Pair`]: the run on display and another one, beside each other or one above the other, on one clock.

use std::sync::Arc;

use egui::{Button, ComboBox, Rect, Ui, UiBuilder, pos2, vec2};

use super::notation;
use super::theme::{bold, colour, plain};
use super::widgets::name;
use super::{Command, Switch, ViewChange, ViewState, present};
use stillbase_mechanics::machine::builtins;
use stillbase_picture::numbers::signed;
use stillbase_picture::paint::labels::draw_labels;
use stillbase_picture::paint::{SceneViewport, paint};
use stillbase_picture::scene::Rgba;
use stillbase_picture::scene::beside::Beside;
use stillbase_picture::scene::camera::Camera;
use stillbase_picture::scene::exaggeration::Exaggeration;
use stillbase_picture::scene::framing::PictureArea;
use stillbase_picture::scene::options::ViewOptions;
use stillbase_picture::scene::palette::Palette;
use stillbase_session::scenario::{Scenario, TaskKind};
use stillbase_session::{Fork, Session};
use stillbase_simulation::frame::Frame;
use stillbase_study::comparison::{Alternative, Comparison};

/// Two runs in one view.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// The other run.
    pub with: PairWith,
    /// Whether the runs stand one above the other; `None`: as the shape of the view wants it.
    pub above: Option<bool>,
    /// Whether it is the demonstration before the hints, which ends when the machine is touched.
    pub demonstrates: bool,
}

/// The run beside that on display.
#[derive(Clone, Debug, PartialEq)]
pub enum PairWith {
    /// The same task done in another way.
    Way(Alternative),
    /// The same task on the built-in machine of this name.
    Machine(String),
    /// A branch or a kept run, with its title.
    Kept(String, Box<Scenario>),
}

impl PairWith {
    /// Returns the title.
    pub fn title(&self) -> String {
        match self {
            Self::Way(way) => way.title().to_owned(),
            Self::Machine(name) => format!("Machine {name}"),
            Self::Kept(title, _) => title.clone(),
        }
    }

    /// Returns the scenario beside a session; `None` for a machine that is not built in.
    pub fn scenario(&self, session: &Session) -> Option<Scenario> {
        let own = session.scenario();
        match self {
            Self::Way(way) => Some(Scenario { compare_b: None, ..way.of(own) }),
            Self::Machine(name) => {
                let machine = builtins().iter().find(|machine| machine.name() == name)?;
                Some(Scenario { name: format!("{}-{name}", own.name), ..own.on_machine(machine) })
            }
            Self::Kept(_, scenario) => Some(Scenario::clone(scenario)),
        }
    }

    /// Returns all runs that may stand beside a session; `table` is the table of runs, if it is open.
    fn all(session: &Session, table: Option<&Comparison>) -> Vec<Self> {
        let own = session.scenario();
        let ways = Alternative::ALL.into_iter().filter(|way| way.is_of(own)).map(Self::Way);
        let branches = session.forks();
        let branch = |(i, fork): (usize, &Fork)| {
            Some(Self::Kept(format!("Branch: {}", fork.title), Box::new(session.branch(i)?)))
        };
        let branches = branches.iter().enumerate().filter_map(branch);
        let rows = table.into_iter().flat_map(Comparison::entries).filter(|entry| entry.added_by_user);
        let kept = rows.filter_map(|entry| {
            let run = entry.outcome.as_ref().ok()?;
            Some(Self::Kept(format!("Kept: {}", entry.title), Box::new(run.scenario.clone())))
        });
        let machines = builtins().iter().filter(|machine| machine.name() != own.machine.name());
        let machines = machines.map(|machine| Self::Machine(machine.name().to_owned()));
        ways.chain(branches).chain(kept).chain(machines).collect()
    }
}

/// Minimum width of two views beside each other, points.
const MIN_WIDTH_OF_BOTH_PT: f32 = 680.0;
/// Minimum height of two views one above the other, points.
const MIN_HEIGHT_OF_BOTH_PT: f32 = 420.0;
/// Width of the panel of plots and the tool bar, for which a window needs room beside both views, points.
const PANELS_WIDTH_PT: f32 = 360.0;
/// Height that a caption covers, points; in low views it is short.
const CAPTION_HEIGHT_PT: f32 = 116.0;
const SHORT_CAPTION_HEIGHT_PT: f32 = 62.0;
/// Views below this height have short captions, points.
const LOW_VIEW_PT: f32 = 320.0;
/// Smaller moments are shown as zero, N m.
const ZERO_BELOW_N_M: f64 = 0.005;

impl Pair {
    /// Returns the pair with the straight line, or the reactionless run if the session's task has minimum norm.
    pub fn of(session: &Session) -> Self {
        let shakes = session.scenario().task.kind == TaskKind::MinimumNorm;
        let way = if shakes { Alternative::Reactionless } else { Alternative::StraightLine };
        Self { with: PairWith::Way(way), above: None, demonstrates: false }
    }

    /// Returns the demonstration before the hints.
    pub fn demonstration() -> Self {
        Self { with: PairWith::Way(Alternative::StraightLine), above: None, demonstrates: true }
    }

    /// Whether the demonstration takes the space of the settings in a window of this width, points.
    pub fn hides_settings(&self, width: f32) -> bool {
        self.demonstrates && width >= MIN_WIDTH_OF_BOTH_PT + PANELS_WIDTH_PT
    }

    /// Divides a view into that of the other run and that of the session; `None` for a demonstration without room.
    pub fn divide(&self, view: Rect) -> Option<[Rect; 2]> {
        let (wide, high) = (view.width() >= MIN_WIDTH_OF_BOTH_PT, view.height() >= MIN_HEIGHT_OF_BOTH_PT);
        if self.demonstrates && !wide {
            return None;
        }
        let above = self.above.unwrap_or(!wide && high);
        let (left, right) = view.split_left_right_at_fraction(0.5);
        let (top, bottom) = view.split_top_bottom_at_fraction(0.5);
        Some(if above { [top, bottom] } else { [left, right] })
    }

    /// Returns how both bases are drawn: a fixed one on a soft mount, so that its shaking is seen.
    pub fn exaggeration(&self, beside: Option<&Beside>, session: &Session, usual: Exaggeration) -> Exaggeration {
        match beside {
            Some(other) if !session.scenario().base.moves() => {
                Exaggeration::Mount(other.compliance(session.frame().peaks.moment))
            }
            _ => usual,
        }
    }
}

/// What the view of the other run shows.
pub struct Other<'a> {
    pub pair: &'a Pair,
    /// The run, or why there is none; `None` while it is being made.
    pub found: Option<&'a Result<Beside, String>>,
    pub session: &'a Session,
    /// The table of runs, if it is open.
    pub table: Option<&'a Comparison>,
    pub exaggeration: Exaggeration,
}

impl Other<'_> {
    /// Draws the other run with its caption.
    pub fn show(&self, ui: &mut Ui, rect: Rect, camera: &Camera, view_state: &ViewState, commands: &mut Vec<Command>) {
        let p = view_state.palette();
        let large = view_state.arrangement.layout == super::Layout::Present;
        let title = self.pair.with.title();
        match self.found {
            Some(Ok(beside)) => {
                let Some(frame) = beside.at(self.session.frame().time) else { return };
                let camera = self.camera(beside, rect, camera);
                let options = ViewOptions {
                    theme: view_state.arrangement.theme,
                    show_hints: false,
                    exaggeration: self.exaggeration,
                    notation: view_state.arrangement.notation,
                    ..Default::default()
                };
                let scene = Arc::new(beside.stage.scene(frame, &options));
                paint(ui, 1, rect, &scene, &camera);
                let words = self.words(beside);
                let tone = if is_zero(frame) { p.zero } else { p.reaction };
                let tone = if self.pair.demonstrates { p.reaction } else { tone };
                let name = moment_name(view_state, beside.scenario().base.feels_more_than_n_b());
                let said = caption(ui, rect, &p, (&title, words), (frame, beside.peak_moment(), &name), (tone, large));
                let taken = [said, controls_cover(rect)];
                draw_labels(ui, 1, &SceneViewport { rect, camera }, &scene, &taken);
            }
            Some(Err(why)) => message(ui, rect, &p, &title, &format!("This cannot be run: {why}")),
            None => message(ui, rect, &p, &title, "running it …"),
        }
        let beside = rect.right() < ui.max_rect().right() - 1.0;
        let stroke = egui::Stroke::new(1.0, colour(p.line));
        match beside {
            true => ui.painter().vline(rect.right(), rect.y_range(), stroke),
            false => ui.painter().hline(rect.x_range(), rect.bottom(), stroke),
        };
        if !self.pair.demonstrates {
            self.controls(ui, rect, beside, commands);
        }
    }

    /// Returns the camera: that of the session for the same machine, else one that shows the other machine.
    fn camera(&self, beside: &Beside, rect: Rect, camera: &Camera) -> Camera {
        let (one, other) = (&beside.scenario().machine, &self.session.scenario().machine);
        if one.resolved_links() == other.resolved_links() {
            return *camera;
        }
        let covered = vec![[0.0, 0.0, f64::from(rect.width()), f64::from(caption_covers(rect).height())]];
        let size = [rect.width(), rect.height()].map(f64::from);
        beside.content().framed(*camera, &PictureArea { size, covered })
    }

    /// Returns what the caption says of the other run.
    fn words(&self, beside: &Beside) -> &'static str {
        let shakes = beside.peak_moment() > ZERO_BELOW_N_M;
        match (&self.pair.with, shakes) {
            (PairWith::Way(Alternative::StraightLine), true) => "From A to B along a line. The arm shakes its base.",
            (_, true) => "The arm shakes its base.",
            (_, false) => "The base feels nothing.",
        }
    }

    /// Draws the choice of the other run, the buttons of the arrangement, and the button that closes the view.
    fn controls(&self, ui: &mut Ui, rect: Rect, beside: bool, commands: &mut Vec<Command>) {
        let at = controls_cover(rect);
        let layout = egui::Layout::left_to_right(egui::Align::Center);
        let mut row = ui.new_child(UiBuilder::new().max_rect(at).layout(layout));
        let set = |pair: Pair| Command::View(ViewChange::Pair(pair));
        let width = (rect.width() - 160.0).clamp(90.0, 190.0);
        let combo = ComboBox::from_id_salt("other run").selected_text(self.pair.with.title()).width(width).truncate();
        let shown = combo.show_ui(&mut row, |ui| {
            for with in PairWith::all(self.session, self.table) {
                if ui.selectable_label(with == self.pair.with, with.title()).clicked() {
                    commands.push(set(Pair { with, ..self.pair.clone() }));
                }
            }
        });
        name(&shown.response.on_hover_text("The run beside this session"), "The other run");
        let (words, tip) = match beside {
            true => ("above", "One above the other"),
            false => ("beside", "Beside each other"),
        };
        if row.button(words).on_hover_text(tip).clicked() {
            commands.push(set(Pair { above: Some(beside), ..self.pair.clone() }));
        }
        let close = row.add(Button::new("×"));
        name(&close, "One run alone");
        if close.on_hover_text("One run alone (Esc)").clicked() {
            commands.push(ViewChange::Switch(Switch::Pair, false).into());
        }
    }
}

/// Draws the caption of the session's own run; returns its rectangle.
pub fn own_caption(ui: &Ui, rect: Rect, session: &Session, pair: &Pair, view_state: &ViewState) -> Rect {
    let (p, frame) = (view_state.palette(), session.frame());
    let scenario = session.scenario();
    let peak = frame.peaks.moment;
    let (title, words) = match pair.demonstrates {
        true => ("Reactionless path", "From A to B on one plane of joint space. The base feels nothing."),
        false if peak <= ZERO_BELOW_N_M => ("This session", "The base feels nothing."),
        false => ("This session", "The arm shakes its base."),
    };
    let title = match (pair.demonstrates, scenario.title.as_str()) {
        (true, _) | (false, "") => title.to_owned(),
        (false, own) => format!("{title}: {own}"),
    };
    let tone = if pair.demonstrates || is_zero(frame) { p.zero } else { p.reaction };
    let name = moment_name(view_state, scenario.base.feels_more_than_n_b());
    caption(ui, rect, &p, (&title, words), (frame, peak, &name), (tone, false))
}

/// Returns the rectangle of a view that the choice of the other run covers.
fn controls_cover(rect: Rect) -> Rect {
    Rect::from_min_size(pos2(rect.left() + 16.0, rect.bottom() - 34.0), vec2(rect.width() - 32.0, 26.0))
}

/// Returns the rectangle of a view that a caption covers.
pub fn caption_covers(rect: Rect) -> Rect {
    let height = if rect.height() < LOW_VIEW_PT { SHORT_CAPTION_HEIGHT_PT } else { CAPTION_HEIGHT_PT };
    Rect::from_min_size(rect.min, vec2(rect.width().min(420.0), height))
}

/// Returns the names of the moment that both captions show.
fn moment_name(view_state: &ViewState, feels_more: bool) -> String {
    view_state.arrangement.notation.base_moment(feels_more || view_state.charts.wheels_differ)
}

fn is_zero(frame: &Frame) -> bool {
    frame.felt_moment.abs() < ZERO_BELOW_N_M
}

/// Draws a title with a text below it over the upper left corner of a view.
fn message(ui: &Ui, rect: Rect, p: &Palette, title: &str, words: &str) {
    let painter = ui.painter().with_clip_rect(rect);
    let title = painter.layout(title.to_owned(), bold(16.0), colour(p.ink), rect.width() - 40.0);
    let words = painter.layout(words.to_owned(), plain(12.0), colour(p.dim), rect.width() - 40.0);
    painter.galley(pos2(rect.left() + 22.0, rect.top() + 12.0), title, colour(p.ink));
    painter.galley(pos2(rect.left() + 22.0, rect.top() + 36.0), words, colour(p.dim));
}

/// Draws a title and a text over the upper left corner of a view; below them the moment on the base, its largest
/// value, N m, and its name. Returns their rectangle.
fn caption(
    ui: &Ui,
    rect: Rect,
    p: &Palette,
    (title, about): (&str, &str),
    (frame, peak, name): (&Frame, f64, &str),
    (tone, large): (Rgba, bool),
) -> Rect {
    let painter = ui.painter().with_clip_rect(rect);
    let scale = if large { present::size(rect) / 40.0 } else { 1.0 };
    let is_short = !large && rect.height() < LOW_VIEW_PT;
    let room = rect.width() - 40.0;
    let mut at = rect.min + vec2(22.0, 12.0);
    let mut covered = Rect::NOTHING;
    let mut row = |text: String, font: egui::FontId, ink: Rgba, gap: f32| {
        let galley = painter.layout(text, font, colour(ink), room);
        let place = Rect::from_min_size(at, galley.size());
        painter.galley(at, galley, colour(ink));
        at.y = place.bottom() + gap;
        covered = covered.union(place);
        place
    };
    row(title.to_owned(), bold(16.0 * scale), p.ink, 4.0);
    if !is_short {
        row(notation::sentence(ui.ctx(), about).into_owned(), plain(12.0 * scale), p.dim, 8.0);
    }
    let shown = signed(frame.felt_moment + 0.0, 2);
    let largest = format!("largest {} N m", signed(peak + 0.0, 2));
    if large {
        row(format!("{shown} N m"), bold(40.0 * scale), tone, 2.0);
        row(format!("{name}; {largest}"), plain(12.8 * scale), p.dim, 0.0);
        return covered;
    }
    let size = if is_short { 16.0 } else { 26.0 };
    let number = row(shown, bold(size), tone, 0.0);
    let unit = number.right_bottom() + vec2(8.0, if is_short { -2.0 } else { -4.0 });
    let words = if is_short { format!("N m, {largest}") } else { format!("N m   {name}; {largest}") };
    let words = painter.layout(words, plain(12.0), colour(p.dim), (rect.right() - unit.x - 8.0).max(80.0));
    let beside = Rect::from_min_size(unit - vec2(0.0, words.size().y), words.size());
    painter.galley(beside.min, words, colour(p.dim));
    covered.union(beside)
}
