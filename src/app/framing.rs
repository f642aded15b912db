//! Framing of the camera by *show everything*. It lasts until the user moves the view, and keeps the content clear of
//! cards that cover the scene.

use std::sync::Arc;

use egui::Rect;

use super::{Framing, ViewState};
use stillbase_picture::scene::framing::{PictureArea, ViewContent};
use stillbase_picture::scene::views::{ViewKind, Views};

/// Frames the camera of the present view, if the view must show everything. `rect` is the scene on the screen,
/// `covered` its covered parts; where the last one appears, changes or goes, the view is framed anew.
pub fn keep_framed(
    rect: Rect,
    (covered, lasting): (&[Rect], Option<Rect>),
    views: &Views,
    content: impl FnOnce(ViewKind) -> ViewContent,
    view_state: &mut ViewState,
) {
    let view = view_state.view;
    let size = [rect.width(), rect.height()];
    let room = [size[0], size[1], lasting.map_or(0.0, |rect| rect.height().round())];
    // During a drag the view stays still; it is framed after the release.
    if view_state.gesture.grabbed.is_some() {
        return;
    }
    let content = match &view_state.framing[view as usize] {
        Framing::Manual => return,
        Framing::Framed(_, last) if *last == room => return,
        Framing::Framed(content, _) => content.clone(),
        Framing::Pending => Arc::new(content(view)),
    };
    let area = area(rect, covered);
    view_state.cameras[view as usize] = content.framed(views.camera(view), &area);
    view_state.framing[view as usize] = Framing::Framed(content, room);
}

/// Returns the area of a scene on the screen, with its covered parts.
pub fn area(rect: Rect, covered: &[Rect]) -> PictureArea {
    let part = |part: &Rect| {
        let part = part.intersect(rect).translate(-rect.min.to_vec2());
        part.is_positive().then(|| [part.left(), part.top(), part.right(), part.bottom()].map(f64::from))
    };
    let size = [rect.width(), rect.height()].map(f64::from);
    PictureArea { size, covered: covered.iter().filter_map(part).collect() }
}
