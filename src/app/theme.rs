//! Translation of the colour palette into egui's style.

use egui::{Color32, CornerRadius, Frame, Margin, Stroke, TextStyle, vec2};

pub use stillbase_picture::paint::{bold, code, colour, install_fonts, plain};
use stillbase_picture::scene::palette::{Palette, Theme, faded, palette};

/// Applies a theme to egui.
pub fn apply(ctx: &egui::Context, theme: Theme) {
    let p: Palette = palette(theme);
    let egui_theme = match theme {
        Theme::Dark => egui::Theme::Dark,
        Theme::Light => egui::Theme::Light,
    };
    ctx.set_theme(egui_theme);
    let mut style = (*ctx.style_of(egui_theme)).clone();
    style.text_styles = [
        (TextStyle::Heading, bold(17.0)),
        (TextStyle::Body, plain(13.0)),
        (TextStyle::Button, plain(13.0)),
        (TextStyle::Monospace, plain(13.0)),
        (TextStyle::Small, plain(11.5)),
    ]
    .into();
    let (ink, dim, line, panel) = (colour(p.ink), colour(p.dim), colour(p.line), colour(p.panel));
    let raised = colour(faded(p.line, 0.75));
    let v = &mut style.visuals;
    v.override_text_color = None;
    v.weak_text_color = Some(dim);
    v.panel_fill = panel;
    v.window_fill = panel;
    v.window_stroke = Stroke::new(1.0, line);
    v.window_corner_radius = CornerRadius::same(10);
    v.menu_corner_radius = CornerRadius::same(8);
    v.extreme_bg_color = colour(p.background);
    v.faint_bg_color = raised;
    v.selection.bg_fill = colour(p.amber);
    v.selection.stroke = Stroke::new(1.0, colour(p.background));
    v.slider_trailing_fill = true;
    v.handle_shape = egui::style::HandleShape::Circle;
    v.error_fg_color = colour(p.reaction);
    v.warn_fg_color = colour(p.amber);
    v.hyperlink_color = colour(p.drives[0]);
    let radius = CornerRadius::same(6);
    for (w, fill, stroke) in [
        (&mut v.widgets.noninteractive, panel, line),
        (&mut v.widgets.inactive, raised, Color32::TRANSPARENT),
        (&mut v.widgets.hovered, line, dim),
        (&mut v.widgets.active, line, ink),
        (&mut v.widgets.open, raised, dim),
    ] {
        w.bg_fill = fill;
        w.weak_bg_fill = fill;
        w.bg_stroke = Stroke::new(1.0, stroke);
        w.fg_stroke = Stroke::new(1.5, ink);
        w.corner_radius = radius;
        w.expansion = 0.0;
    }
    v.widgets.noninteractive.fg_stroke = Stroke::new(1.0, ink);
    style.spacing.item_spacing = vec2(8.0, 6.0);
    style.spacing.button_padding = vec2(9.0, 4.0);
    style.spacing.slider_rail_height = 3.0;
    style.spacing.interact_size = vec2(28.0, 22.0);
    // A list gets its full height where the window allows it.
    style.spacing.default_area_size.y = 1200.0;
    style.spacing.menu_margin = Margin::same(6);
    style.spacing.window_margin = Margin::same(14);
    style.spacing.scroll.floating = true;
    style.interaction.selectable_labels = false;
    ctx.set_style_of(egui_theme, style);
}

/// Returns the frame of a card over the scene.
pub fn card(p: &Palette) -> Frame {
    Frame::new().fill(colour(p.panel)).stroke((1.0, colour(p.line))).corner_radius(10).inner_margin(14)
}

/// Returns the other theme.
pub fn other(theme: Theme) -> Theme {
    if theme == Theme::Dark { Theme::Light } else { Theme::Dark }
}
