//! Pictures of the guide, as they are compiled into the program: one for each theme.

use std::sync::Arc;

use egui::{Color32, ColorImage, Image, Response, Sense, TextureHandle, TextureOptions, Ui};

use super::document::{Span, plain_text};
use crate::widgets::name;
use stillbase_picture::render::offscreen::Picture;
use stillbase_picture::scene::palette::Theme;
use stillbase_query::{Queries, QuickQuery, QuickWork};

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

pictures![
    "window",
    "tower",
    "joints",
    "design",
    "draw",
    "workshop",
    "spacecraft",
    "assembly",
    "assembly-hand-over",
    "assembly-wrist",
    "assembly-in-space",
    "assembly-off-its-pin",
    "compare",
    "tolerances",
    "paper-table-1",
    "paper-fig-3",
    "paper-fig-4",
    "paper-fig-5",
];

/// Returns the name of a picture from its address: the file without theme and extension.
pub fn name_of(address: &str) -> &str {
    let file = address.rsplit('/').next().unwrap_or_default();
    let stem = file.strip_suffix(".png").unwrap_or(file);
    stem.strip_suffix("-dark").or(stem.strip_suffix("-light")).unwrap_or(stem)
}

/// Draws a picture in the window's theme, at most as wide as the page, with text for screen readers; `None` if the
/// program has no picture of this name. Until it is decoded, its place is empty.
pub fn show(ui: &mut Ui, queries: &Queries, picture: &str, shows: &[Span]) -> Option<Response> {
    let theme = if ui.visuals().dark_mode { Theme::Dark } else { Theme::Light };
    let width = ui.available_width();
    let is_small = width * ui.pixels_per_point() <= SMALL_WIDTH_PX;
    let variant = PictureVariant { name: picture.to_owned(), theme, is_small };
    let shows = plain_text(shows);
    let response = match texture(ui, queries, &variant) {
        Some(texture) => ui.add(Image::new(&texture).max_width(width).corner_radius(6).alt_text(&shows)),
        None => {
            let size = variant.size()?;
            let size = size * (width / size.x).min(1.0);
            ui.allocate_response(size, Sense::hover())
        }
    };
    name(&response, &shows);
    Some(response)
}

/// A picture of the guide as it is drawn.
#[derive(Clone, Debug, PartialEq)]
struct PictureVariant {
    /// Name of the picture.
    name: String,
    theme: Theme,
    /// Whether it has half the resolution. So the display hardly shrinks a texture to less than half its width, and
    /// letters stay smooth.
    is_small: bool,
}

impl PictureVariant {
    /// Returns width and height, pixels, from the head of the file.
    fn size(&self) -> Option<egui::Vec2> {
        let [width, height] = Picture::size_of_png(file_of(&self.name, self.theme)?)?;
        let shrink = if self.is_small { 2 } else { 1 };
        Some(egui::vec2((width / shrink) as f32, (height / shrink) as f32))
    }
}

/// Query for the pixels of a picture.
struct DecodedPicture;

impl QuickQuery for DecodedPicture {
    type Input = PictureVariant;
    type Answer = Option<Arc<ColorImage>>;

    fn answer(variant: &PictureVariant) -> Self::Answer {
        let decoded = Picture::from_png(file_of(&variant.name, variant.theme)?)?;
        let decoded = if variant.is_small { decoded.halved() } else { decoded };
        let pixels = decoded.rgba.chunks_exact(4).map(|c| Color32::from_rgba_unmultiplied(c[0], c[1], c[2], c[3]));
        Some(Arc::new(ColorImage::new([decoded.width, decoded.height].map(|n| n as usize), pixels.collect())))
    }
}

/// Returns the texture of a picture, in the last variant that has been decoded; `None` before the first one. The texture
/// of a new variant takes the place of the one before.
fn texture(ui: &Ui, queries: &Queries, wanted: &PictureVariant) -> Option<TextureHandle> {
    let id = egui::Id::unique(("picture of the guide", &wanted.name));
    let kept = ui.data(|d| d.get_temp::<(PictureVariant, TextureHandle)>(id));
    if let Some((_, texture)) = kept.as_ref().filter(|(variant, _)| variant == wanted) {
        return Some(texture.clone());
    }
    let decoded = queries.ask_in_background::<QuickWork<DecodedPicture>>(wanted);
    let Some(image) = decoded.known().and_then(|image| Option::clone(image)) else {
        return kept.map(|(_, texture)| texture);
    };
    // From here on the texture holds the pixels.
    queries.forget::<QuickWork<DecodedPicture>>();
    let texture = ui.ctx().load_texture(&wanted.name, image, TextureOptions::LINEAR);
    ui.data_mut(|d| d.insert_temp(id, (wanted.clone(), texture.clone())));
    Some(texture)
}
