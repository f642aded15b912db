//! Icons, drawn as strokes with the painter.

use std::f32::consts::TAU;

use egui::{Color32, Painter, Pos2, Response, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo, pos2, vec2};

use super::theme::{bold, colour};
use stillbase_picture::scene::palette::{Palette, faded};

/// An icon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Icon {
    /// The pointer drags objects.
    Pointer,
    /// A curve drawn by hand.
    Curve,
    /// A force.
    Push,
    /// A distance between two points.
    Ruler,
    /// Dexterity by direction.
    Ellipse,
    /// Poses one after the other.
    Fan,
    /// A pin with two links.
    Pin,
    /// A spread of values.
    Bell,
    /// Samples of a motion.
    Samples,
    /// Two things beside each other.
    Beside,
    /// The whole scene.
    Corners,
    /// The parts of a window.
    Panes,
    /// The list of changes.
    History,
    /// To the start.
    Start,
    /// Play.
    Play,
    /// Pause.
    Pause,
    /// One step forward.
    Step,
    /// Play in a loop.
    Loop,
    /// Light and dark.
    Halves,
    /// Remove.
    Cross,
    /// Record.
    Record,
    /// A bar with its two pins.
    Bar,
    /// A motor about a pin.
    Motor,
    /// A known mass: the sign of a centre of mass.
    Lump,
    /// The end effector at the end of a bar.
    Tip,
}

/// Half the width of the square in which an icon is drawn, points.
const HALF_SIZE_PT: f32 = 8.0;

impl Icon {
    /// Draws it with its centre at a position.
    pub fn draw(self, painter: &Painter, at: Pos2, ink: Color32) {
        // The centre is rounded to whole pixels, so that vertical and horizontal lines are sharp.
        let scale = painter.ctx().pixels_per_point();
        let at = (at * scale).round() / scale;
        let pen = Pen { painter, at, stroke: Stroke::new(1.5, ink) };
        match self {
            Self::Pointer => pen.closed(&[[-4.5, -7.5], [6.5, 2.5], [0.5, 3.0], [-3.5, 7.5]]),
            Self::Curve => {
                pen.line(&sampled(|t| [-6.5 + 13.0 * t, 5.5 * (TAU * 0.5 * t).cos()]));
                pen.dot([-6.5, 5.5], 1.8);
                pen.dot([6.5, -5.5], 1.8);
            }
            Self::Push => {
                pen.ring([-5.5, 0.0], 2.5);
                pen.arrow([-2.0, 0.0], [7.5, 0.0]);
            }
            Self::Ruler => {
                pen.line(&[[-6.0, 4.5], [6.0, -4.5]]);
                pen.line(&[[-7.8, 2.1], [-4.2, 6.9]]);
                pen.line(&[[4.2, -6.9], [7.8, -2.1]]);
                pen.line(&[[-1.2, -1.6], [1.2, 1.6]]);
            }
            Self::Ellipse => {
                let (c, s) = (0.82, -0.57);
                let turned = |x: f32, y: f32| [c * x - s * y, s * x + c * y];
                pen.line(&sampled(|t| turned(8.0 * (TAU * t).cos(), 4.0 * (TAU * t).sin())));
                pen.dot([0.0, 0.0], 1.6);
            }
            Self::Fan => {
                for (end, faint) in [([-6.5, -3.5], 0.45), ([0.0, -7.5], 0.7), ([6.5, -3.5], 1.0)] {
                    let pen = pen.fainter(faint);
                    pen.line(&[[0.0, 6.0], end]);
                    pen.dot(end, 1.7);
                }
                pen.dot([0.0, 6.0], 2.0);
            }
            Self::Pin => {
                pen.ring([0.0, -3.0], 4.0);
                pen.dot([0.0, -3.0], 1.4);
                pen.line(&[[-2.4, 0.2], [-7.0, 7.0]]);
                pen.line(&[[2.4, 0.2], [7.0, 7.0]]);
            }
            Self::Bell => {
                pen.line(&sampled(|t| {
                    let x = 2.0 * t - 1.0;
                    [8.0 * x, 6.0 - 12.5 * (-6.0 * x * x).exp()]
                }));
            }
            Self::Samples => {
                pen.line(&[[-7.0, -7.0], [-7.0, 6.5], [7.5, 6.5]]);
                for at in [[-3.6, 2.4], [-0.8, -2.2], [2.4, -0.2], [5.8, -5.4]] {
                    pen.dot(at, 1.6);
                }
            }
            Self::Beside => {
                pen.closed(&[[-7.0, -6.0], [-1.5, -6.0], [-1.5, 6.0], [-7.0, 6.0]]);
                pen.closed(&[[1.5, -6.0], [7.0, -6.0], [7.0, 6.0], [1.5, 6.0]]);
            }
            Self::Corners => {
                for [x, y] in [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]] {
                    pen.line(&[[3.0 * x, 7.0 * y], [7.0 * x, 7.0 * y], [7.0 * x, 3.0 * y]]);
                }
                pen.dot([0.0, 0.0], 1.8);
            }
            Self::Panes => {
                pen.closed(&[[-7.5, -6.5], [7.5, -6.5], [7.5, 6.5], [-7.5, 6.5]]);
                pen.line(&[[-3.0, -6.5], [-3.0, 6.5]]);
                pen.line(&[[-3.0, 1.5], [7.5, 1.5]]);
            }
            Self::History => {
                pen.line(&sampled(|t| on_circle([0.5, 0.0], 6.5, 0.55 + 0.86 * t)));
                let [x, y] = on_circle([0.5, 0.0], 6.5, 0.55);
                pen.line(&[[x - 2.6, y - 2.2], [x, y + 0.6], [x + 3.2, y - 1.6]]);
                pen.line(&[[0.5, -3.5], [0.5, 0.0], [3.2, 1.8]]);
            }
            Self::Start => {
                pen.bar(-5.0);
                pen.solid(&[[-4.0, 0.0], [5.5, -6.0], [5.5, 6.0]]);
            }
            Self::Play => pen.solid(&[[-4.0, -6.0], [5.5, 0.0], [-4.0, 6.0]]),
            Self::Pause => {
                pen.bar(-3.0);
                pen.bar(3.0);
            }
            Self::Step => {
                pen.solid(&[[-6.0, -6.0], [3.5, 0.0], [-6.0, 6.0]]);
                pen.bar(5.0);
            }
            Self::Loop => {
                pen.line(&[[-7.0, 0.5], [-7.0, -2.0], [-5.0, -4.5], [6.5, -4.5]]);
                pen.line(&[[7.0, -0.5], [7.0, 2.0], [5.0, 4.5], [-6.5, 4.5]]);
                pen.line(&[[4.0, -7.2], [6.8, -4.5], [4.0, -1.8]]);
                pen.line(&[[-4.0, 7.2], [-6.8, 4.5], [-4.0, 1.8]]);
            }
            Self::Halves => {
                pen.ring([0.0, 0.0], 6.5);
                let half: Vec<[f32; 2]> = sampled(|t| on_circle([0.0, 0.0], 6.5, 0.25 + 0.5 * t));
                pen.solid(&half);
            }
            Self::Cross => {
                pen.line(&[[-4.0, -4.0], [4.0, 4.0]]);
                pen.line(&[[-4.0, 4.0], [4.0, -4.0]]);
            }
            Self::Record => pen.dot([0.0, 0.0], 5.0),
            Self::Bar => {
                pen.line(&[[-4.0, 4.0], [4.0, -4.0]]);
                pen.ring([-5.5, 5.5], 2.0);
                pen.ring([5.5, -5.5], 2.0);
            }
            Self::Motor => {
                pen.ring([0.0, 0.0], 6.5);
                pen.ring([0.0, 0.0], 3.4);
                pen.dot([0.0, 0.0], 1.4);
            }
            Self::Lump => {
                pen.ring([0.0, 0.0], 6.5);
                for side in [1.0, -1.0] {
                    let arc = (0..=4).map(|i| on_circle([0.0, 0.0], 6.5, 0.0625 * i as f32));
                    let quarter: Vec<[f32; 2]> =
                        std::iter::once([0.0, 0.0]).chain(arc).map(|[x, y]| [side * x, side * y]).collect();
                    pen.solid(&quarter);
                }
            }
            Self::Tip => {
                pen.line(&[[-7.0, 6.0], [0.5, -0.5]]);
                pen.ring([3.0, -3.0], 3.6);
                pen.dot([3.0, -3.0], 1.4);
            }
        }
    }
}

/// A painter of strokes relative to an origin, in points; y points down.
struct Pen<'a> {
    painter: &'a Painter,
    at: Pos2,
    stroke: Stroke,
}

impl Pen<'_> {
    fn place(&self, [x, y]: [f32; 2]) -> Pos2 {
        self.at + vec2(x, y)
    }

    fn fainter(&self, share: f32) -> Self {
        let ink = self.stroke.color.gamma_multiply(share);
        Self { painter: self.painter, at: self.at, stroke: Stroke::new(self.stroke.width, ink) }
    }

    fn line(&self, points: &[[f32; 2]]) {
        self.painter.add(Shape::line(points.iter().map(|p| self.place(*p)).collect(), self.stroke));
    }

    fn closed(&self, points: &[[f32; 2]]) {
        self.painter.add(Shape::closed_line(points.iter().map(|p| self.place(*p)).collect(), self.stroke));
    }

    fn solid(&self, points: &[[f32; 2]]) {
        let points = points.iter().map(|p| self.place(*p)).collect();
        self.painter.add(Shape::convex_polygon(points, self.stroke.color, Stroke::NONE));
    }

    fn ring(&self, at: [f32; 2], radius: f32) {
        self.painter.circle_stroke(self.place(at), radius, self.stroke);
    }

    fn dot(&self, at: [f32; 2], radius: f32) {
        self.painter.circle_filled(self.place(at), radius, self.stroke.color);
    }

    fn bar(&self, x: f32) {
        let stroke = Stroke::new(2.5, self.stroke.color);
        self.painter.line_segment([self.place([x, -6.0]), self.place([x, 6.0])], stroke);
    }

    fn arrow(&self, from: [f32; 2], to: [f32; 2]) {
        self.line(&[from, to]);
        let along = vec2(to[0] - from[0], to[1] - from[1]).normalized() * 4.2;
        let side = |turn: f32| {
            let (s, c) = turn.sin_cos();
            [to[0] - c * along.x + s * along.y, to[1] - s * along.x - c * along.y]
        };
        self.line(&[side(0.7), to, side(-0.7)]);
    }
}

fn sampled(point: impl Fn(f32) -> [f32; 2]) -> Vec<[f32; 2]> {
    (0..=32).map(|i| point(i as f32 / 32.0)).collect()
}

/// Returns a point on a circle at an angle given in turns, clockwise from the right.
fn on_circle([x, y]: [f32; 2], radius: f32, turns: f32) -> [f32; 2] {
    [x + radius * (TAU * turns).cos(), y + radius * (TAU * turns).sin()]
}

/// A button of one icon.
pub struct IconButton<'a> {
    pub icon: Icon,
    /// Label for screen readers.
    pub label: &'a str,
    /// Tooltip: its name, its key, its effect.
    pub tip: &'a str,
    /// Whether it is on; `None` for a button that acts once.
    pub on: Option<bool>,
    /// Whether it can be used now.
    pub enabled: bool,
    pub size: Vec2,
}

impl<'a> IconButton<'a> {
    /// A button that acts once.
    pub fn of(icon: Icon, label: &'a str, tip: &'a str) -> Self {
        Self { icon, label, tip, on: None, enabled: true, size: vec2(28.0, 26.0) }
    }

    /// Draws it.
    pub fn show(&self, ui: &mut Ui, p: &Palette) -> Response {
        let ink = match self.on {
            Some(true) => p.amber,
            Some(false) => p.dim,
            None => p.ink,
        };
        self.show_in(ui, p, colour(ink))
    }

    /// Draws it in a given colour.
    pub fn show_in(&self, ui: &mut Ui, p: &Palette, ink: Color32) -> Response {
        let sense = if self.enabled { Sense::click() } else { Sense::hover() };
        let (rect, response) = ui.allocate_exact_size(self.size, sense);
        background(ui, p, &response, self.on == Some(true));
        let ink = if self.enabled { ink } else { ink.gamma_multiply(0.4) };
        debug_assert!(rect.width() >= 2.0 * HALF_SIZE_PT, "room for the icon");
        self.icon.draw(ui.painter(), rect.center(), ink);
        response.widget_info(|| accessible_info(self.label, self.enabled, self.on));
        response.on_hover_text(self.tip)
    }
}

/// Draws a button with a short word.
pub fn word_button(ui: &mut Ui, p: &Palette, word: &str, tip: &str, on: bool, size: Vec2) -> Response {
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    background(ui, p, &response, on);
    let ink = colour(if on { p.ink } else { p.dim });
    ui.painter().text(rect.center(), egui::Align2::CENTER_CENTER, word, bold(11.0), ink);
    response.widget_info(|| accessible_info(word, true, Some(on)));
    response.on_hover_text(tip)
}

fn accessible_info(label: &str, enabled: bool, on: Option<bool>) -> WidgetInfo {
    match on {
        Some(on) => WidgetInfo::selected(egui::Role::Button, enabled, on, label),
        None => WidgetInfo::labeled(egui::Role::Button, enabled, label),
    }
}

/// Draws the background of a button, which shows whether the button is on, under the pointer, or focused.
fn background(ui: &Ui, p: &Palette, response: &Response, on: bool) {
    let rect = response.rect;
    if on || response.hovered() {
        ui.painter().rect_filled(rect, 6.0, colour(if on { p.line } else { faded(p.line, 0.6) }));
    }
    if on {
        let mark = egui::Rect::from_center_size(rect.left_center() - vec2(2.0, 0.0), vec2(2.5, 14.0));
        ui.painter().rect_filled(mark, 1.5, colour(p.amber));
    }
    if response.has_focus() {
        ui.painter().rect_stroke(rect, 6.0, Stroke::new(1.5, colour(p.amber)), egui::StrokeKind::Inside);
    }
}

/// Draws a disabled button with a short word; its tooltip says why it is disabled.
pub fn disabled_word_button(ui: &mut Ui, p: &Palette, word: &str, tip: &str, size: Vec2) -> Response {
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    ui.painter().text(rect.center(), egui::Align2::CENTER_CENTER, word, bold(11.0), colour(faded(p.dim, 0.45)));
    response.widget_info(|| accessible_info(word, false, Some(false)));
    response.on_hover_text(tip)
}

/// Marks the present line of a list.
pub fn dot(ui: &Ui, p: &Palette, line: &Response) {
    ui.painter().circle_filled(line.rect.left_center() + vec2(12.0, 0.0), 3.5, colour(p.amber));
}

/// Height of a rule with the space around it, points.
pub const SEPARATOR_HEIGHT: f32 = 11.0;

/// Draws a thin line between groups.
pub fn rule(ui: &mut Ui, p: &Palette, width: f32) {
    let (rect, _) = ui.allocate_exact_size(vec2(width, SEPARATOR_HEIGHT), Sense::hover());
    let y = rect.center().y.round() + 0.5;
    let ends = [pos2(rect.left() + 6.0, y), pos2(rect.right() - 6.0, y)];
    ui.painter().line_segment(ends, Stroke::new(1.0, colour(p.line)));
}
