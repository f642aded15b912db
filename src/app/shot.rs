//! A [`Shot`]: what a picture shows, the window or one of its views, and how it is drawn.

use std::sync::Arc;

use super::{AppState, ViewChange};
use stillbase_picture::canvas::Canvas;
use stillbase_picture::charts::figure::Figure;
use stillbase_picture::print::{PIXEL_MM, Page, scene_figure};
use stillbase_picture::render::offscreen::{NoAdapter, NoPicture, Picture, legible_scale};
use stillbase_picture::scene::Scene;
use stillbase_picture::scene::camera::Camera;
use stillbase_picture::scene::options::ViewOptions;
use stillbase_picture::scene::palette::{Theme, faded, palette};
use stillbase_picture::scene::views::ViewKind;
use stillbase_settings::number::fixed;

/// Why a picture cannot be drawn as outlines.
pub const NO_OUTLINES: &str = "outlines are drawn of the view from above alone: want that, or .png or .webp";

/// Part of the width of a picture that plots beside the scene take.
const PLOTS_SHARE: f32 = 0.38;
/// Smallest and largest height of such a plot, points.
const MIN_PLOT_HEIGHT_PT: f32 = 130.0;
const MAX_PLOT_HEIGHT_PT: f32 = 320.0;

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
    /// Whether the plots of the window stand right of the scene; without effect on the whole window.
    pub plots: bool,
    /// Width and height, pixels.
    pub size_px: [u32; 2],
    /// Pixels per point.
    pub scale: f32,
}

impl PictureOrder {
    /// Returns an order of a size in pixels, with labels of legible size.
    pub fn new(shot: Shot, theme: Theme, size_px: [u32; 2]) -> Self {
        Self { shot, theme, transparent: false, plots: false, size_px, scale: legible_scale(size_px[1]) }
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
        app_state.await_outline();
        if self.shot == Shot::Window {
            app_state.carry_out(ViewChange::Theme(self.theme));
            return canvas.draw(|ui| app_state.ui(ui));
        }
        let (scene, camera) = self.scene(app_state);
        canvas.scene_beside(&Arc::new(scene), &camera, &self.plot_figures(app_state))
    }

    /// Returns the scene of the instant that the window shows, and its camera.
    pub fn scene(&self, app_state: &mut AppState) -> (Scene, Camera) {
        app_state.await_outline();
        let (mut scene, camera) = match self.shot {
            Shot::Window | Shot::Scene => {
                app_state.carry_out(ViewChange::Theme(self.theme));
                app_state.still_scene(self.scene_size())
            }
            Shot::View(view) => {
                let notes = app_state.session().notes().to_vec();
                let options = ViewOptions { theme: self.theme, show_hints: false, notes, ..ViewOptions::default() };
                let content = app_state.plain_content();
                let camera = crate::viewport::camera(&content, view, self.scene_size());
                (content.scene(view, &options, &camera), camera)
            }
        };
        if self.transparent {
            scene.lay_over_any(&palette(self.theme));
        }
        (scene, camera)
    }

    /// Returns the picture as outlines, for a scene seen from straight above.
    ///
    /// # Errors
    /// If it is not seen so; the text says what would be right.
    pub fn page(&self, app_state: &mut AppState) -> Result<Page, &'static str> {
        if self.shot == Shot::Window {
            return Err(NO_OUTLINES);
        }
        let (scene, camera) = self.scene(app_state);
        if !camera.is_flat() {
            return Err(NO_OUTLINES);
        }
        let mut figures = vec![([0.0; 2], scene_figure(&Arc::new(scene), &camera, self.scene_size()))];
        figures.extend(self.plot_figures(app_state));
        let scenario = app_state.session().scenario();
        let title = if scenario.title.is_empty() { &scenario.name } else { &scenario.title }.clone();
        let at = fixed(app_state.session().frame().time, 3);
        let made = format!("{} at {at} s", scenario.name);
        Ok(Page { size: self.size(), point_mm: self.scale * PIXEL_MM, title, made, figures })
    }

    /// Width and height, points.
    fn size(&self) -> [f32; 2] {
        self.size_px.map(|n| n as f32 / self.scale)
    }

    /// Width and height of the scene, points.
    fn scene_size(&self) -> [f32; 2] {
        let [width, height] = self.size();
        [if self.plots { width * (1.0 - PLOTS_SHARE) } else { width }, height]
    }

    /// Returns the plots right of the scene, with their upper left corners, points.
    fn plot_figures(&self, app_state: &mut AppState) -> Vec<([f32; 2], Figure)> {
        if !self.plots {
            return Vec::new();
        }
        let ([width, height], [left, _]) = (self.size(), self.scene_size());
        // As many plots as have room, of equal heights.
        let most = (height / MIN_PLOT_HEIGHT_PT).max(1.0) as usize;
        let count = app_state.plot_count().clamp(1, most);
        let own = (height / count as f32).min(MAX_PLOT_HEIGHT_PT);
        let mut figures = app_state.figures([width - left, own], self.theme);
        figures.truncate(count);
        let behind = palette(self.theme).background;
        let background = if self.transparent { faded(behind, 0.0) } else { behind };
        let placed = |(i, figure): (usize, Figure)| ([left, own * i as f32], Figure { background, ..figure });
        figures.into_iter().enumerate().map(placed).collect()
    }
}
