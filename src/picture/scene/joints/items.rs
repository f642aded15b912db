//! Items of joint space for any number of drives: axes, pose, and ends of the planned path.

use crate::notation::Notation;
use crate::numbers::round_up;
use crate::scene::axes::Axis;
use crate::scene::palette::{Palette, faded};
use crate::scene::{Anchor, Label, Marker, Scene};
use stillbase_session::Run;
use stillbase_simulation::frame::Frame;

/// Symbols of the drive angles.
pub const SYMBOLS: [&str; 8] = ["q₁", "q₂", "q₃", "q₄", "q₅", "q₆", "q₇", "q₈"];
/// Symbols of the drive angles relative to a base that moves: θ is its angle.
const SYMBOLS_ON_BASE: [&str; 8] = ["q₁ − θ", "q₂ − θ", "q₃ − θ", "q₄ − θ", "q₅ − θ", "q₆ − θ", "q₇ − θ", "q₈ − θ"];

/// Returns the symbols of the angles along the axes in a run.
pub(super) fn symbols(run: &Run) -> &'static [&'static str; 8] {
    if run.scenario().base.moves() { &SYMBOLS_ON_BASE } else { &SYMBOLS }
}

/// Maximum number of ticks on the longest axis.
const MAX_TICKS: f64 = 10.0;

/// Returns the axes of three drives over their bounds in the scene, with the current values. `origin` is q of all
/// drives at the origin of the scene, rad.
pub(super) fn axes(
    palette: &Palette,
    frame: &Frame,
    (drives, symbols): ([usize; 3], &[&'static str; 8]),
    bounds: [[f64; 2]; 3],
    origin: &[f64],
    notation: Notation,
) -> [Axis; 3] {
    let longest = bounds.iter().map(|[from, to]| to - from).fold(0.0, f64::max);
    [0, 1, 2].map(|i| {
        let (k, [from, to]) = (drives[i], bounds[i]);
        Axis {
            symbol: symbols[k],
            unit: "rad",
            colour: palette.drive(k),
            ends: [from, to],
            values: [from + origin[k], to + origin[k]],
            step: round_up(longest / MAX_TICKS),
            decimals: 0,
            now: Some((frame.relative(k), palette.drive(k))),
            now_decimals: 3,
        }
        .shown_in(notation)
    })
}

/// Draws a dot at the pose, and the ring by which it is dragged.
pub(super) fn draw_pose(scene: &mut Scene, palette: &Palette, pose: [f64; 3], hot: bool) {
    let at = pose.map(|x| x as f32);
    scene.markers.push(Marker::disc("pose", at, 4.5, palette.ink));
    let ring = Marker::disc("target", at, if hot { 12.0 } else { 10.0 }, faded(palette.ink, 0.0));
    scene.markers.push(ring.edged(palette.ink, 2.0));
}

/// Returns the label of the surface of b, rad. It says "nearly reactionless" if λ varies slightly with the pose, so
/// that a small part of the moment reaches the base.
pub(super) fn named(b: f64, is_reactionless: bool) -> String {
    format!("b = {b:.3} rad{}", if is_reactionless { "" } else { ", nearly reactionless" })
}

/// Draws the ends of a path with their names; of a closed path, only the first.
pub(super) fn draw_ends(scene: &mut Scene, palette: &Palette, [first, last]: [[f32; 3]; 2]) {
    let ends = [("A", first, Anchor::Right, -11.0), ("B", last, Anchor::Left, 11.0)];
    let is_closed = first.iter().zip(last).all(|(s, t)| (s - t).abs() < 1e-3);
    for (name, at, anchor, aside) in ends.into_iter().take(if is_closed { 1 } else { 2 }) {
        scene.markers.push(Marker::disc("path/ends", at, 4.5, palette.background).edged(palette.ink, 1.6));
        scene.labels.push(Label::new("path/names", at, [aside, -10.0], name, palette.ink, 13.0, anchor));
    }
}
