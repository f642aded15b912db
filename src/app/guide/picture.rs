//! Pictures of the guide, as they are compiled into the program: one for each theme.

use egui::{Color32, ColorImage, Image, Response, TextureHandle, TextureOptions, Ui};

use super::document::{Span, plain_text};
use crate::widgets::name;
use stillbase_picture::render::offscreen::Picture;
use stillbase_picture::scene::palette::Theme;

/// Declares the pictures by their names.
macro_rules! pictures {
    ($($name:literal),* $(,)?) => {
        /// Returns the PNG file of a picture in a theme.
        fn file_of(name: &str, theme: Theme) -> Option<&'static [u8]> {
            match (name, theme) {
                $(
                    ($name, Theme::Dark) => {
                        Some(include_bytes!(concat!("../../../assets/pictures/", $name, "-dark.png")))
                    }
                    ($name, Theme::Light) => {
                        Some(include_bytes!(concat!("../../../assets/pictures/", $name, "-light.png")))
                    }
                )*
                _ => None,
            }
        }
    };
}

/// Largest width on the display, pixels, at which the texture has half the resolution of the picture.
const SMALL_WIDTH_PX: f32 = 800.0;

pictures!["window", "tower", "joints", "design", "spacecraft", "compare", "tolerances"];

/// Returns the name of a picture from its address: the file without theme and extension.
pub fn name_of(address: &str) -> &str {
    let file = address.rsplit('/').next().unwrap_or_default();
    let stem = file.strip_suffix(".png").unwrap_or(file);
    stem.strip_suffix("-dark").or(stem.strip_suffix("-light")).unwrap_or(stem)
}

/// Draws a picture in the theme of the window, as wide as the page, with what it shows for screen readers; `None` if the
/// program has no picture of this name.
pub fn show(ui: &mut Ui, picture: &str, shows: &[Span]) -> Option<Response> {
    let theme = if ui.visuals().dark_mode { Theme::Dark } else { Theme::Light };
    let width = ui.available_width();
    let texture = texture(ui, picture, theme, width * ui.pixels_per_point())?;
    let shows = plain_text(shows);
    let image = Image::new(&texture).max_width(width).corner_radius(6).alt_text(&shows);
    let response = ui.add(image);
    name(&response, &shows);
    Some(response)
}

/// Returns the texture of a picture that is shown this wide, pixels; it is decoded once and kept while the window is open.
fn texture(ui: &Ui, picture: &str, theme: Theme, width: f32) -> Option<TextureHandle> {
    // The texture is shrunk to hardly less than half its width on the display, so that letters stay smooth.
    let is_small = width <= SMALL_WIDTH_PX;
    let id = egui::Id::unique(("picture of the guide", picture, theme == Theme::Dark, is_small));
    if let Some(texture) = ui.data(|d| d.get_temp::<TextureHandle>(id)) {
        return Some(texture);
    }
    let decoded = Picture::from_png(file_of(picture, theme)?)?;
    let decoded = if is_small { decoded.halved() } else { decoded };
    let pixels = decoded.rgba.chunks_exact(4).map(|c| Color32::from_rgba_unmultiplied(c[0], c[1], c[2], c[3]));
    let image = ColorImage::new([decoded.width, decoded.height].map(|n| n as usize), pixels.collect());
    let texture = ui.ctx().load_texture(picture, image, TextureOptions::LINEAR);
    ui.data_mut(|d| d.insert_temp(id, texture.clone()));
    Some(texture)
}
