//! [`Pointed`]: things that the tour and the hints point at, in the scene and in the panels.

use egui::{Context, Id, LayerId, Order, Rect, Response, Stroke, Vec2};

use super::theme::colour;
use stillbase_picture::paint::SceneViewport;
use stillbase_picture::scene::exaggeration::DrawnFrame;
use stillbase_picture::scene::options::Handle;
use stillbase_picture::scene::palette::Palette;
use stillbase_picture::scene::stage::Stage;

/// A thing that is pointed at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pointed {
    /// The base, with the moment and the force on it.
    Base,
    /// The target at the end effector.
    Target,
    /// The ring of b around the base.
    Ring,
    /// A widget, by the beginning of its name for screen readers.
    Widget(&'static str),
}

/// Sizes of the rectangles around the base and around the target, points.
const BASE_PT: f32 = 84.0;
const TARGET_PT: f32 = 36.0;
/// The ring is enlarged by this factor, to make room for its label, which lies outside.
const RING_FACTOR: f32 = 1.4;

impl Pointed {
    /// Returns the rectangle of a thing of the scene on the screen.
    pub fn in_scene(self, spot: &SceneViewport, stage: &Stage, shown: &DrawnFrame<'_>) -> Option<Rect> {
        let base = || spot.screen([shown.base.at.re, shown.base.at.im, stage.handle_height()]);
        match self {
            Self::Base => Some(Rect::from_center_size(base()?, Vec2::splat(BASE_PT))),
            Self::Ring => {
                let knob = stage.handle(Handle::Ring, shown)?;
                let middle = spot.screen([shown.base.at.re, shown.base.at.im, knob[2]])?;
                let radius = RING_FACTOR * (spot.screen(knob)? - middle).length();
                Some(Rect::from_center_size(middle, Vec2::splat(2.0 * radius)))
            }
            Self::Target => {
                let at = spot.screen(stage.handle(Handle::Target, shown)?)?;
                Some(Rect::from_center_size(at, Vec2::splat(TARGET_PT)))
            }
            Self::Widget(_) => None,
        }
    }
}

/// Widgets that are sought, with their rectangles as soon as they have been drawn.
type Widgets = Vec<(&'static str, Option<Rect>)>;

fn id() -> Id {
    Id::unique("widgets pointed at")
}

/// Seeks the widgets among these things, and returns the rectangles of those that the last pass has drawn.
pub fn widgets(ctx: &Context, things: &[Pointed]) -> Vec<Rect> {
    let names = things.iter().filter_map(|thing| match thing {
        Pointed::Widget(name) => Some(*name),
        _ => None,
    });
    let sought: Widgets = names.map(|name| (name, None)).collect();
    if sought.is_empty() {
        ctx.data_mut(|data| data.remove_temp::<Widgets>(id()));
        return Vec::new();
    }
    let last = ctx.data(|data| data.get_temp::<Widgets>(id())).unwrap_or_default();
    if last.iter().map(|(name, _)| name).ne(sought.iter().map(|(name, _)| name)) {
        ctx.request_repaint();
    }
    ctx.data_mut(|data| data.insert_temp(id(), sought));
    last.into_iter().filter_map(|(_, rect)| rect).collect()
}

/// Records the rectangle of a widget if it is sought.
pub fn drawn(response: &Response, name: &str) {
    response.ctx.data_mut(|data| {
        let Some(sought) = data.get_temp::<Widgets>(id()) else { return };
        let found = |(of, rect): (&'static str, Option<Rect>)| match name.starts_with(of) && rect.is_none() {
            true => (of, Some(response.rect)),
            false => (of, rect),
        };
        data.insert_temp(id(), sought.into_iter().map(found).collect::<Widgets>());
    });
}

/// Draws an outline around each rectangle, over everything but dialogs.
pub fn outline(ctx: &Context, p: &Palette, rects: &[Rect]) {
    let painter = ctx.layer_painter(LayerId::new(Order::Middle, Id::unique("outlines")));
    for rect in rects {
        let rect = rect.expand(4.0);
        // Things of the scene are round, widgets are not.
        let is_round = (rect.width() - rect.height()).abs() < 1.0;
        let radius = if is_round { 0.5 * rect.width() } else { 0.5 * rect.height().min(16.0) };
        painter.rect_stroke(rect, radius, Stroke::new(2.0, colour(p.amber)), egui::StrokeKind::Outside);
    }
}
