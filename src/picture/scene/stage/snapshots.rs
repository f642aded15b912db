//! Other poses beside the present one: snapshots along the motion as in Fig. 5, and other runs at the same instant.

use super::{Stage, ViewOptions, label, point};
use crate::mechanics::planar::{DriveAngles, Pose2, Vector, unit};
use crate::picture::scene::palette::{Palette, faded};
use crate::picture::scene::{Anchor, Line, Scene};

/// Another run at the present instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Other {
    /// Its number in the table.
    pub name: String,
    /// Absolute drive angles, rad.
    pub q: DriveAngles,
    /// Its base.
    pub base: Pose2,
}

impl Stage {
    /// The links that carry the end effector at instants along the motion, the later the stronger.
    pub(super) fn snapshots(&self, scene: &mut Scene, palette: &Palette, options: &ViewOptions) {
        let z = self.handle_height();
        let last = options.snapshots.len().saturating_sub(1).max(1) as f32;
        for (i, q) in options.snapshots.iter().enumerate() {
            let strength = 0.35 + 0.55 * i as f32 / last;
            for (drive, [from, to]) in self.linkage.skeleton(&q.units()) {
                scene.lines.push(Line {
                    name: format!("snapshot/{}", i + 1),
                    points: vec![point(from, z), point(to, z)],
                    width: 1.8,
                    colour: faded(palette.drive(drive), strength),
                    dash: None,
                    on_top: true,
                });
            }
        }
    }

    /// Other runs as thin skeletons, dashed, with their numbers.
    pub(super) fn others(&self, scene: &mut Scene, palette: &Palette, options: &ViewOptions) {
        let z = self.handle_height();
        for other in &options.others {
            let mut tip = Vector::default();
            let turned = |p: Vector| other.base.at + p;
            for (_, [from, to]) in self.linkage.skeleton(&other.q.units()) {
                tip = turned(to);
                scene.lines.push(Line {
                    name: format!("other/{}", other.name),
                    points: vec![point(turned(from), z), point(tip, z)],
                    width: 1.6,
                    colour: faded(palette.ink, 0.8),
                    dash: Some([5.0, 3.0]),
                    on_top: true,
                });
            }
            let size = 0.03 * self.linkage.reach();
            let mark = [-1.0, 1.0].map(|side| other.base.at + side * size * unit(other.base.angle));
            scene.lines.push(Line {
                name: format!("other/{}/base", other.name),
                points: mark.map(|p| point(p, z)).to_vec(),
                width: 1.6,
                colour: faded(palette.ink, 0.8),
                dash: None,
                on_top: true,
            });
            scene.labels.push(label(tip, z, [8.0, 12.0], &other.name, palette.ink, 12.0, Anchor::Left));
        }
    }
}
