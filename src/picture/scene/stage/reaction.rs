//! What reaches the base: a force arrow and a moment arc at B, in proportion, with their scale in words.

use std::f64::consts::FRAC_PI_2;

use super::{Stage, ViewOptions, label, point, round_up};
use crate::mechanics::planar::{Vector, unit};
use crate::picture::scene::palette::Palette;
use crate::picture::scene::reaction::{ARROW, RADIUS, Reaction};
use crate::picture::scene::{Anchor, Line, Scene};
use crate::simulation::frame::Frame;

/// The two barbs of an arrow head at a point, along a unit vector.
pub(super) fn head(at: Vector, along: Vector, size: f64, z: f64) -> Vec<[f32; 3]> {
    let barb = |turn: f64| at - along * unit(turn) * size;
    vec![point(barb(0.5), z), point(at, z), point(barb(-0.5), z)]
}

pub(super) fn brief(x: f64) -> String {
    format!("{x:.6}").trim_end_matches('0').trim_end_matches('.').into()
}

impl Stage {
    /// A force arrow and a moment arc at B, in proportion, with their scale in words.
    pub(super) fn reaction(&self, scene: &mut Scene, palette: &Palette, frame: &Frame, options: &ViewOptions) {
        let (z, reach) = (self.handle_height(), self.linkage.reach());
        let (b, felt) = (frame.base.at, Reaction::of(frame));
        let line = |name: &str, points: Vec<[f32; 3]>| Line {
            name: name.into(),
            points,
            width: 3.0,
            colour: palette.reaction,
            dash: None,
            on_top: true,
        };
        let newtons = round_up(frame.peaks.force.max(felt.force.norm()).max(1e-3));
        let arrow = felt.arrow(newtons).map(|parts| parts * reach);
        if let Some(arrow) = arrow {
            scene.lines.push(line("reaction/force", vec![point(b, z), point(b + arrow, z)]));
            scene.lines.push(line("reaction/force", head(b + arrow, arrow / arrow.norm(), 0.025 * reach, z)));
        }
        let full = round_up(frame.peaks.moment.max(1e-3));
        let (sweep, radius) = (felt.sweep(full), RADIUS * reach);
        if let Some(sweep) = sweep {
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
        let scale: Vec<String> = [
            arrow.map(|_| format!("arrow: {:.3} m = {} N", ARROW * reach, brief(newtons))),
            sweep.map(|_| format!("arc: 135° = {} N m", brief(full))),
        ]
        .into_iter()
        .flatten()
        .collect();
        let of = match options.push {
            Some([x, y]) if x.hypot(y) > 0.0 && self.ground.weightless => "the push",
            Some([x, y]) if x.hypot(y) > 0.0 => "its weight with the push",
            _ => "its weight",
        };
        let [force, moment] = felt.readings(palette).map(|(text, tone)| (text, tone, 13.0));
        let rows = [
            force,
            moment,
            (felt.beside(of).unwrap_or_default(), palette.dim, 11.5),
            (com_words, palette.dim, 11.5),
            (scale.join(" · "), palette.dim, 11.5),
        ];
        let mut down = 0.0;
        for (text, colour, size) in rows.into_iter().filter(|(t, ..)| !t.is_empty()) {
            scene.labels.push(label(at, z, [0.0, down], &text, colour, size, Anchor::Left));
            down += 17.0;
        }
    }
}
