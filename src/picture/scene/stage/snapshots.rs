//! Further poses: snapshots along the motion as in Fig. 5 of the paper, and other runs at the same instant.

use crate::scene::exaggeration::DrawnFrame;
use crate::scene::linkage::LinkageModel;
use crate::scene::options::ViewOptions;
use crate::scene::palette::{Palette, faded};
use crate::scene::{Anchor, Label, Polyline, Scene, point};
use stillbase_mechanics::planar::{Vector, unit};

/// Draws the links between base and end effector at instants along the motion; later ones are more opaque.
pub fn snapshots(scene: &mut Scene, linkage: &LinkageModel, palette: &Palette, options: &ViewOptions) {
    let z = linkage.top();
    let last = options.snapshots.len().saturating_sub(1).max(1) as f32;
    for (i, q) in options.snapshots.iter().enumerate() {
        let strength = 0.35 + 0.55 * i as f32 / last;
        for (drive, ends) in linkage.skeleton(&q.units()) {
            let (strip, colour) = (ends.map(|p| point(p, z)).to_vec(), faded(palette.drive(drive), strength));
            scene.lines.push(Polyline::new(format!("snapshot/{}", i + 1), [strip], 1.8, colour).on_top());
        }
    }
}

/// Draws other runs as thin dashed lines, with their numbers.
pub fn others(scene: &mut Scene, linkage: &LinkageModel, palette: &Palette, options: &ViewOptions) {
    let (z, colour) = (linkage.top(), faded(palette.ink, 0.8));
    for other in &options.others {
        let shown = DrawnFrame::of(&other.frame, options.exaggeration);
        let base = shown.base.at;
        let skeleton = linkage.skeleton(&shown.q.units());
        let tip = skeleton.last().map_or(base, |(_, [_, to])| base + to);
        let strips: Vec<_> =
            skeleton.iter().map(|(_, ends)| ends.map(|p: Vector| point(base + p, z)).to_vec()).collect();
        let name = format!("other/{}", other.name);
        let size = 0.03 * linkage.reach();
        let mark = [-1.0, 1.0].map(|side| point(base + side * size * unit(shown.base.angle), z)).to_vec();
        scene.lines.push(Polyline::new(format!("{name}/base"), [mark], 1.6, colour).on_top());
        scene.lines.push(Polyline::new(name, strips, 1.6, colour).dashed(5.0, 3.0).on_top());
        let (at, offset) = (point(tip, z), [8.0, 12.0]);
        scene.labels.push(Label::new("other", at, offset, &other.name, palette.ink, 12.0, Anchor::Left));
    }
}
