//! A [`Shot`]: what a picture shows, the window or one of its views.

use std::sync::Arc;

use stillbase_app::{AppState, ViewChange};
use stillbase_picture::canvas::Canvas;
use stillbase_picture::render::offscreen::{NoPicture, Picture};
use stillbase_picture::scene::options::ViewOptions;
use stillbase_picture::scene::palette::Theme;
use stillbase_picture::scene::views::ViewKind;

/// What a picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shot {
    /// The whole window.
    Window,
    /// A view alone.
    View(ViewKind),
}

impl Shot {
    /// Draws the instant that the window shows.
    ///
    /// # Errors
    /// If the picture cannot be read back.
    pub fn draw(self, canvas: &mut Canvas, app_state: &mut AppState, theme: Theme) -> Result<Picture, NoPicture> {
        match self {
            Self::Window => {
                app_state.carry_out(ViewChange::Theme(theme));
                canvas.draw(|ui| app_state.ui(ui))
            }
            Self::View(view) => {
                let notes = app_state.session().notes().to_vec();
                let (options, camera) =
                    (ViewOptions { theme, notes, ..ViewOptions::default() }, app_state.views().camera(view));
                let scene = Arc::new(app_state.views().scene(view, app_state.session().frame(), &options, &camera));
                canvas.scene(&scene, &camera)
            }
        }
    }
}
