//! What the machine stands on: a plate that floats or stands on springs, its wheel, what it holds, and where all would
//! be had the base not moved.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::reaction::head;
use super::{Stage, ViewOptions, brief_number, label, point, signed};
use crate::mechanics::planar::{Pose2, Units, Vector, unit};
use crate::picture::scene::linkage::mix;
use crate::picture::scene::palette::{Palette, faded};
use crate::picture::scene::{Anchor, Line, Marker, Rgba, Scene};
use crate::simulation::frame::Frame;
use crate::simulation::plant::{Base, BaseKind, Load};

/// What a stage knows of base and payload; it can change without a new stage.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Ground {
    pub base: Base,
    pub load: Load,
    /// No gravity.
    pub weightless: bool,
}

/// Newtons for each metre that a hand pulls.
pub const PULL: f64 = 20.0;

/// Half the length and half the width of the plate, parts of the reach.
pub(in crate::picture::scene) const PLATE: [f64; 2] = [0.2, 0.105];

/// Motion of the base below this is not spoken of, m and rad.
const SILENT: f64 = 1e-12;

impl Stage {
    fn floor_line(&self, name: &str, points: Vec<[f32; 3]>, width: f32, colour: Rgba) -> Line {
        Line { name: name.into(), points, width, colour, dash: None, on_top: false }
    }

    /// Glyphs under the machine: panels of a spacecraft, or springs between the plate and the ground.
    pub(super) fn ground(&self, scene: &mut Scene, palette: &Palette, frame: &Frame) {
        let reach = self.linkage.reach();
        let (z, top) = (self.linkage.bottom(), self.handle_height());
        let place = |p: Vector| frame.base.at + p * unit(frame.base.angle);
        let [length, width] = PLATE.map(|part| part * reach);
        match self.ground.base.kind {
            BaseKind::Fixed => {}
            BaseKind::Free => {
                let edge = mix(palette.dim, palette.line, 0.4);
                for side in [-1.0, 1.0] {
                    let at = |x: f64, y: f64| point(place(Vector::new(side * x * reach, y * reach)), z);
                    let (near, far, half) = (PLATE[0] + 0.035, PLATE[0] + 0.19, 0.075);
                    let panel = vec![at(near, -half), at(far, -half), at(far, half), at(near, half), at(near, -half)];
                    scene.lines.push(self.floor_line("base/panel", panel, 1.6, edge));
                    scene.lines.push(self.floor_line("base/panel", vec![at(PLATE[0], 0.0), at(far, 0.0)], 1.6, edge));
                    for i in 1..3 {
                        let x = near + f64::from(i) * (far - near) / 3.0;
                        let rib = vec![at(x, -half), at(x, half)];
                        scene.lines.push(self.floor_line("base/panel", rib, 1.0, faded(edge, 0.7)));
                    }
                }
            }
            BaseKind::Compliant => {
                let colour = mix(palette.dim, palette.ink, 0.2);
                let ends = [
                    (Vector::new(-length, 0.0), Vector::new(-1.0, 0.0)),
                    (Vector::new(length, 0.0), Vector::new(1.0, 0.0)),
                    (Vector::new(0.0, -width), Vector::new(0.0, -1.0)),
                ];
                for (from, out) in ends {
                    let foot = from + out * (0.13 * reach);
                    scene.lines.push(self.floor_line(
                        "base/spring",
                        spring(place(from), foot, 0.018 * reach, z),
                        1.6,
                        colour,
                    ));
                    let across = out * Vector::new(0.0, 1.0) * (0.04 * reach);
                    let wall = vec![point(foot - across, z), point(foot + across, z)];
                    scene.lines.push(self.floor_line("base/foot", wall, 2.2, colour));
                    for i in -2..=2 {
                        let at = foot + across * (0.45 * f64::from(i));
                        let hatch = vec![point(at, z), point(at + (out - across * (4.0 / reach)) * (0.014 * reach), z)];
                        scene.lines.push(self.floor_line("base/foot", hatch, 1.0, faded(colour, 0.8)));
                    }
                }
            }
        }
        if self.ground.base.moves() {
            let [x, y] = self.ground.base.com;
            scene.markers.push(Marker {
                name: "base/com".into(),
                at: point(place(Vector::new(x, y)), top),
                radius: 4.5,
                fill: faded(palette.background, 0.6),
                stroke: palette.dim,
                stroke_width: 1.8,
            });
        }
        if self.ground.base.wheel.is_some() {
            self.wheel(scene, palette, frame);
        }
    }

    fn wheel(&self, scene: &mut Scene, palette: &Palette, frame: &Frame) {
        let (z, radius) = (self.handle_height(), 0.082 * self.linkage.reach());
        let b = frame.base.at;
        let colour = if frame.wheel.saturated { palette.reaction } else { palette.dim };
        let rim = (0..=72).map(|i| point(b + unit(TAU * f64::from(i) / 72.0) * radius, z)).collect();
        let line = |points, width| Line { on_top: true, ..self.floor_line("wheel", points, width, colour) };
        scene.lines.push(line(rim, 2.0));
        let mark = unit(frame.totals.wheel_turn.rem_euclid(TAU));
        for i in 0..3 {
            let spoke = mark * unit(TAU * f64::from(i) / 3.0);
            scene.lines.push(line(vec![point(b + spoke * (0.72 * radius), z), point(b + spoke * radius, z)], 1.6));
        }
        scene.markers.push(Marker {
            name: "wheel/mark".into(),
            at: point(b + mark * radius, z),
            radius: 4.0,
            fill: colour,
            stroke: palette.background,
            stroke_width: 1.0,
        });
    }

    /// What the plant holds and the model does not know of, and what pushes.
    pub(super) fn burden(&self, scene: &mut Scene, palette: &Palette, frame: &Frame, options: &ViewOptions) {
        let z = self.handle_height();
        if frame.loaded {
            let (drive, sign) = self.holder;
            let [x, y] = self.ground.load.offset;
            let at = frame.tip + frame.q.units()[drive] * Vector::new(x, y) * sign;
            if (at - frame.tip).norm() > 1e-9 {
                let stem = vec![point(frame.tip, z), point(at, z)];
                scene.lines.push(Line { on_top: true, ..self.floor_line("payload", stem, 2.0, palette.ink) });
            }
            scene.markers.push(Marker {
                name: "payload".into(),
                at: point(at, z),
                radius: (5.0 + 5.0 * self.ground.load.mass.sqrt()).min(12.0) as f32,
                fill: mix(palette.background, palette.ink, 0.55),
                stroke: palette.ink,
                stroke_width: 1.6,
            });
            let words = format!("{} kg", brief_number(self.ground.load.mass));
            scene.labels.push(label(at, z, [0.0, -22.0], &words, palette.dim, 11.5, Anchor::Centre));
        }
        let Some([x, y]) = options.push else { return };
        let force = Vector::new(x, y);
        let size = force.norm();
        if size < 1e-9 {
            return;
        }
        let reach = self.linkage.reach();
        let along = force / size;
        let to = frame.tip + along * (size / PULL).clamp(0.03 * reach, 0.6 * reach);
        let line = |points| Line { on_top: true, ..self.floor_line("push", points, 2.6, palette.amber) };
        scene.lines.push(line(vec![point(frame.tip, z), point(to, z)]));
        scene.lines.push(line(head(to, along, 0.025 * reach, z)));
        let words = format!("{size:.2} N");
        let side = if along.re < 0.0 { (-8.0, Anchor::Right) } else { (8.0, Anchor::Left) };
        scene.labels.push(label(to, z, [side.0, 0.0], &words, palette.amber, 12.5, side.1));
    }

    /// Where base and machine would be, had the base not moved; nothing if it has not.
    pub(super) fn unmoved(&self, scene: &mut Scene, palette: &Palette, frame: &Frame, times: f64) {
        let Pose2 { at, angle } = frame.base;
        let reach = self.linkage.reach();
        if !self.ground.base.moves() {
            return;
        }
        if at.norm() + angle.abs() * reach > 0.002 * reach {
            let (z, colour) = (self.linkage.floor(), faded(palette.dim, 0.75));
            let line = |points| Line { dash: Some([3.0, 3.0]), ..self.floor_line("unmoved", points, 1.2, colour) };
            let mut e: Units = frame.q.units();
            e.iter_mut().for_each(|e| *e *= unit(-angle));
            let arms = self.linkage.outlines(&e).map(|ends| line(ends.map(|p| point(p, z)).to_vec()));
            scene.lines.extend(arms.collect::<Vec<_>>());
            let [length, width] = PLATE.map(|part| part * reach);
            let straight = length - width;
            let cap = |side: f64| {
                (0..=16).map(move |i| {
                    Vector::new(side * straight, 0.0)
                        + unit(side * (-FRAC_PI_2 + std::f64::consts::PI * f64::from(i) / 16.0)) * side * width
                })
            };
            let mut outline: Vec<_> = cap(1.0).chain(cap(-1.0)).map(|p| point(p, self.linkage.bottom())).collect();
            outline.extend(outline.first().copied());
            scene.lines.push(line(outline));
        }
        // As many digits as the peak so far has; they do not change as it comes to rest.
        let written = |x: f64, peak: f64| match peak > SILENT {
            true => signed(1e3 * x, (2 - (1e3 * peak).log10().floor() as i32).clamp(0, 9) as usize),
            false => "0".into(),
        };
        let words = match frame.totals.shift > SILENT || frame.totals.tilt > SILENT {
            true => format!(
                "base {} mm, {} mrad",
                written(at.norm() / times, frame.totals.shift),
                written(angle / times, frame.totals.tilt)
            ),
            false => "base at rest".into(),
        };
        let shown = if times == 1.0 { String::new() } else { format!(" · shown ×{times}") };
        let at = Vector::new(0.2 * reach, -0.11 * reach);
        scene.labels.push(label(
            at,
            self.handle_height(),
            [0.0, -17.0],
            &format!("{words}{shown}"),
            palette.dim,
            11.5,
            Anchor::Left,
        ));
    }
}

/// A zigzag between two points.
fn spring(from: Vector, to: Vector, half: f64, z: f64) -> Vec<[f32; 3]> {
    const TURNS: i32 = 9;
    let way = to - from;
    let across = way / way.norm().max(1e-12) * Vector::new(0.0, half);
    let at = |i: i32| {
        let side = match i {
            0 | TURNS => 0.0,
            i if i % 2 == 0 => 1.0,
            _ => -1.0,
        };
        // Straight at both ends.
        let share = if i == 0 { 0.0 } else { 0.12 + 0.76 * f64::from(i) / f64::from(TURNS) };
        point(from + way * share + across * side, z)
    };
    (0..=TURNS).map(at).chain([point(to, z)]).collect()
}
