//! The box with three labelled axes about a drawing, as it is seen at first.

use rerun::{EntityPath, LineStrips3D, Points3D, Radius};

use super::eye::Eye;
use super::store::{Instant, Store, StoreError};
use super::style::{colour, under};
use crate::picture::scene::axes::{Axis, draw};
use crate::picture::scene::linkage::mix;
use crate::picture::scene::palette::Palette;
use crate::picture::scene::{Rgba, Scene};

/// Writes a box: grid, ticks and words.
///
/// # Errors
/// If it cannot be written.
pub fn show(
    store: &mut Store,
    path: &EntityPath,
    since: Option<Instant>,
    axes: &[Axis; 3],
    eye: &Eye,
    palette: &Palette,
) -> Result<(), StoreError> {
    let mut scene = Scene {
        background: palette.background,
        model: Default::default(),
        areas: Vec::new(),
        solids: Vec::new(),
        lines: Vec::new(),
        markers: Vec::new(),
        labels: Vec::new(),
    };
    draw(&mut scene, palette, axes, eye.direction());
    let solid = |[r, g, b, a]: Rgba| colour(mix(palette.background, [r, g, b, 1.0], a));
    let strips = scene.lines.iter().map(|line| line.points.iter().map(|p| eye.place(*p)).collect::<Vec<_>>());
    let lines = LineStrips3D::new(strips)
        .with_radii(scene.lines.iter().map(|line| Radius::new_ui_points(0.5 * line.width)))
        .with_colors(scene.lines.iter().map(|line| solid(line.colour)));
    store.shape(since, path, &lines)?;
    let beside = scene.labels.iter().map(|label| {
        let shift = eye.shift(label.offset);
        eye.place([0, 1, 2].map(|i| label.at[i] + shift[i]))
    });
    let words = Points3D::new(beside)
        .with_radii([Radius::ZERO])
        .with_colors(scene.labels.iter().map(|label| solid(label.colour)))
        .with_labels(scene.labels.iter().map(|label| label.text.as_str()))
        .with_show_labels(true);
    store.shape(since, &under(path, "words"), &words)
}
