//! A [`Shot`]: what a picture shows, the window or one of its views, and how it is drawn.

use std::sync::Arc;

use super::{AppState, ViewChange};
use stillbase_picture::canvas::Canvas;
use stillbase_picture::render::offscreen::{NoAdapter, NoPicture, Picture, legible_scale};
use stillbase_picture::scene::options::ViewOptions;
use stillbase_picture::scene::palette::{Theme, palette};
use stillbase_picture::scene::views::ViewKind;

/// What a picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shot {
    /// The whole window.
    Window,
    /// The scene as on display: its view, camera and options.
    Scene,
    /// A view alone, framed anew.
    View(ViewKind),
}

/// A picture to be drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureOrder {
    /// What it shows.
    pub shot: Shot,
    /// Its colours.
    pub theme: Theme,
    /// Whether nothing is drawn behind the scene; without effect on the whole window.
    pub transparent: bool,
    /// Width and height, pixels.
    pub size_px: [u32; 2],
    /// Pixels per point.
    pub scale: f32,
}

impl PictureOrder {
    /// Returns an order of a size in pixels, with labels of legible size.
    pub fn new(shot: Shot, theme: Theme, size_px: [u32; 2]) -> Self {
        Self { shot, theme, transparent: false, size_px, scale: legible_scale(size_px[1]) }
    }

    /// Returns a canvas for its pictures, which loads fonts once.
    ///
    /// # Errors
    /// If there is no usable GPU adapter.
    pub fn canvas(&self) -> Result<Canvas, NoAdapter> {
        Canvas::new(self.size_px, self.scale)
    }

    /// Draws the instant that the window shows.
    ///
    /// # Errors
    /// If the picture cannot be read back.
    pub fn draw(&self, canvas: &mut Canvas, app_state: &mut AppState) -> Result<Picture, NoPicture> {
        let (mut scene, camera) = match self.shot {
            Shot::Window => {
                app_state.carry_out(ViewChange::Theme(self.theme));
                return canvas.draw(|ui| app_state.ui(ui));
            }
            Shot::Scene => {
                app_state.carry_out(ViewChange::Theme(self.theme));
                app_state.still_scene(self.size_px.map(|n| n as f32 / self.scale))
            }
            Shot::View(view) => {
                let notes = app_state.session().notes().to_vec();
                let options = ViewOptions { theme: self.theme, show_hints: false, notes, ..ViewOptions::default() };
                let camera = app_state.views().camera(view);
                (app_state.views().scene(view, app_state.session().frame(), &options, &camera), camera)
            }
        };
        if self.transparent {
            scene.lay_over_any(&palette(self.theme));
        }
        canvas.scene(&Arc::new(scene), &camera)
    }
}
