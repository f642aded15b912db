//! What the pins carry: an arrow at each, in proportion, with their scale in words.

use super::reaction::{brief, head};
use super::{Stage, label, point, round_up, signed};
use crate::mechanics::joint_forces::Joints;
use crate::mechanics::machine::{Chain, Machine, place_of};
use crate::picture::scene::palette::Palette;
use crate::picture::scene::{Anchor, Line, Scene};
use crate::simulation::frame::Frame;

/// A pin with its name.
#[derive(Clone, Debug)]
pub(super) struct Bearing {
    name: String,
    at: Chain,
}

/// The pins of a machine, none where statics does not determine their forces.
pub(super) fn bearings(machine: &Machine) -> Vec<Bearing> {
    let pins = Joints::of(machine).map(|joints| joints.pins().to_vec()).unwrap_or_default();
    pins.into_iter().map(|pin| Bearing { name: pin.name, at: pin.at }).collect()
}

impl Stage {
    /// Force of each pin, of its first link on its second: plain, the largest in the colour of reactions and named. The
    /// scale goes by the largest of the instant, because near a change point there is no bound to go by.
    pub(super) fn pin_forces(&self, scene: &mut Scene, palette: &Palette, frame: &Frame) {
        let (z, reach, e) = (self.handle_height(), self.linkage.reach(), frame.q.units());
        let full = round_up(frame.inside.worst.max(0.05 * frame.peaks.inertial_pull).max(1e-3));
        let per_newton = 0.25 * reach / full;
        for (i, pin) in self.pins.iter().enumerate() {
            let Some(force) = frame.inside.pin(i) else { continue };
            let worst = frame.inside.worst_pin() == Some(i);
            let (from, arrow) = (frame.base.at + place_of(&pin.at, &e), force * per_newton);
            if arrow.norm() <= 0.004 * reach {
                continue;
            }
            let colour = if worst { palette.reaction } else { palette.ink };
            let size = (0.3 * arrow.norm()).min(0.025 * reach);
            let to = from + arrow;
            for points in [vec![point(from, z), point(to, z)], head(to, arrow / arrow.norm(), size, z)] {
                let name = format!("pin/{}", pin.name);
                scene.lines.push(Line { name, points, width: 2.2, colour, dash: None, on_top: true });
            }
            if worst {
                let text = format!("{} {} N", pin.name, signed(force.norm(), 1));
                scene.labels.push(label(to, z, [8.0, 0.0], &text, colour, 12.0, Anchor::Left));
            }
        }
        let undefined =
            (0..self.pins.len().min(frame.inside.pins())).filter(|i| frame.inside.pin(*i).is_none()).count();
        let text = match undefined {
            0 => format!("pins: {:.3} m = {} N", 0.25 * reach, brief(full)),
            n => format!("pins: {n} undefined at a change point"),
        };
        // Below the words of the reaction.
        let at = crate::mechanics::planar::Vector::new(0.2 * reach, -0.11 * reach);
        scene.labels.push(label(at, z, [0.0, 90.0], &text, palette.dim, 11.5, Anchor::Left));
    }
}
