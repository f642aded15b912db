//! What reaches the base: a force arrow and a moment arc at B, in proportion, with their scale in words.

use std::f64::consts::FRAC_PI_2;

use super::{Stage, ViewOptions, label, point, round_up, signed};
use crate::frame::{Frame, REACTIONLESS};
use crate::planar::{Vector, unit};
use crate::scene::palette::Palette;
use crate::scene::{Anchor, Line, Scene};

/// The two barbs of an arrow head at a point, along a unit vector.
pub(super) fn head(at: Vector, along: Vector, size: f64, z: f64) -> Vec<[f32; 3]> {
    let barb = |turn: f64| at - along * unit(turn) * size;
    vec![point(barb(0.5), z), point(at, z), point(barb(-0.5), z)]
}

/// A reaction: three decimals, or its order of magnitude where they would hide it.
pub(super) fn reading(x: f64, real: bool) -> String {
    if real && x.abs() < 5e-4 { format!("{x:.1e}").replace('-', "−") } else { signed(x, 3) }
}

pub(super) fn brief(x: f64) -> String {
    format!("{x:.6}").trim_end_matches('0').trim_end_matches('.').into()
}

impl Stage {
    /// A force arrow and a moment arc at B, in proportion, with their scale in words.
    pub(super) fn reaction(&self, scene: &mut Scene, palette: &Palette, frame: &Frame, options: &ViewOptions) {
        let (z, reach) = (self.handle_height(), self.linkage.reach());
        let b = frame.base.at;
        let (force, moment) = (frame.wrench.dynamic.force, frame.felt_moment());
        let weight = frame.wrench.statical.force.norm();
        let tone = |still: bool| if still { palette.zero } else { palette.reaction };
        let pulls = frame.wrench.dynamic.force.norm() > REACTIONLESS * frame.peaks.inertial_pull.max(1e-9);
        let turns = moment.abs() > REACTIONLESS * frame.peaks.torque_sum.max(1e-9);
        let line = |name: &str, points: Vec<[f32; 3]>| Line {
            name: name.into(),
            points,
            width: 3.0,
            colour: palette.reaction,
            dash: None,
            on_top: true,
        };
        let per_newton = 0.25 * reach / round_up(frame.peaks.force.max(force.norm()).max(1e-3));
        let arrow = force * per_newton;
        if arrow.norm() > 0.004 * reach {
            scene.lines.push(line("reaction/force", vec![point(b, z), point(b + arrow, z)]));
            scene.lines.push(line("reaction/force", head(b + arrow, force / force.norm(), 0.025 * reach, z)));
        }
        let full = round_up(frame.peaks.moment.max(1e-3));
        let sweep = moment / full * 1.5 * FRAC_PI_2;
        let radius = 0.17 * reach;
        if sweep.abs() > 0.02 {
            let n = ((sweep.abs() * 24.0).ceil() as usize).max(2);
            let from = -FRAC_PI_2;
            let arc: Vec<_> =
                (0..=n).map(|i| point(b + unit(from + sweep * i as f64 / n as f64) * radius, z)).collect();
            scene.lines.push(line("reaction/moment", arc));
            let end = unit(from + sweep);
            let along = end * Vector::new(0.0, sweep.signum());
            scene.lines.push(line("reaction/moment", head(b + end * radius, along, 0.025 * reach, z)));
        }
        let com = frame.com;
        let arm = 0.014 * reach;
        for d in [Vector::new(arm, 0.0), Vector::new(0.0, arm)] {
            scene.lines.push(Line {
                name: "com".into(),
                points: vec![point(com - d, z), point(com + d, z)],
                width: 1.8,
                colour: palette.ink,
                dash: None,
                on_top: true,
            });
        }
        let at = Vector::new(0.2 * reach, -0.11 * reach);
        let off = (com - b).norm();
        let still = off < 1e-6 * reach;
        let com_words = if still {
            "centre of mass at rest in B".into()
        } else {
            format!("centre of mass {:.2} mm off B", 1e3 * off)
        };
        let scale = match (arrow.norm() > 0.004 * reach, sweep.abs() > 0.02) {
            (false, false) => String::new(),
            (true, false) => format!("arrow: {:.3} m = {} N", 0.25 * reach, brief(0.25 * reach / per_newton)),
            (false, true) => format!("arc: 135° = {} N m", brief(full)),
            (true, true) => {
                format!(
                    "arrow: {:.3} m = {} N · arc: 135° = {} N m",
                    0.25 * reach,
                    brief(0.25 * reach / per_newton),
                    brief(full)
                )
            }
        };
        let of = match options.push {
            Some([x, y]) if x.hypot(y) > 0.0 && self.ground.weightless => "the push",
            Some([x, y]) if x.hypot(y) > 0.0 => "its weight with the push",
            _ => "its weight",
        };
        let rows = [
            (format!("f_B {} N", reading(force.norm(), pulls)), tone(!pulls), 13.0),
            (format!("n_B {} N m", reading(moment, turns)), tone(!turns), 13.0),
            (if weight > 0.0 { format!("and {of}, {weight:.1} N") } else { String::new() }, palette.dim, 11.5),
            (com_words, palette.dim, 11.5),
            (scale, palette.dim, 11.5),
        ];
        let mut down = 0.0;
        for (text, colour, size) in rows.into_iter().filter(|(t, ..)| !t.is_empty()) {
            scene.labels.push(label(at, z, [0.0, down], &text, colour, size, Anchor::Left));
            down += 17.0;
        }
    }
}
