//! Pin forces: an arrow at each pin, and a label with their scale.

use crate::numbers::{round_number, round_up, signed};
use crate::scene::arrow::head;
use crate::scene::exaggeration::DrawnFrame;
use crate::scene::linkage::LinkageModel;
use crate::scene::palette::Palette;
use crate::scene::{Anchor, Label, Name, Polyline, Scene, point};
use stillbase_mechanics::joint_forces::Joints;
use stillbase_mechanics::machine::{Chain, Machine, place_of};
use stillbase_mechanics::planar::Vector;

/// The pins of a machine; empty if their forces are statically indeterminate.
#[derive(Clone, Debug)]
pub struct Pins(Vec<Pin>);

#[derive(Clone, Debug)]
struct Pin {
    name: String,
    item: Name,
    at: Chain,
}

impl Pins {
    /// Returns the pins of a machine.
    pub fn of(machine: &Machine) -> Self {
        let pins = Joints::of(machine).map(|joints| joints.pins().to_vec()).unwrap_or_default();
        let named = |name: &str| format!("pin_forces/{name}").into();
        Self(pins.into_iter().map(|pin| Pin { item: named(&pin.name), name: pin.name, at: pin.at }).collect())
    }

    /// Draws the force at each pin that its first link exerts on its second. The largest force has the colour of
    /// reactions and a label. The scale depends on the largest force of the instant, because near a change point
    /// forces are unbounded.
    pub fn draw(&self, scene: &mut Scene, linkage: &LinkageModel, palette: &Palette, shown: &DrawnFrame<'_>) {
        let Self(pins) = self;
        if pins.is_empty() {
            return;
        }
        let (z, reach, e, frame) = (linkage.top(), linkage.reach(), shown.q.units(), shown.frame);
        let full = round_up(frame.inside.largest_force.max(0.05 * frame.peaks.inertial_pull).max(1e-3));
        let per_newton = 0.25 * reach / full;
        for (i, pin) in pins.iter().enumerate() {
            let Some(force) = frame.inside.pin(i) else { continue };
            let worst = frame.inside.worst_pin() == Some(i);
            let (from, arrow) = (shown.base.at + place_of(&pin.at, &e), force * per_newton);
            if arrow.norm() <= 0.004 * reach {
                continue;
            }
            let colour = if worst { palette.reaction } else { palette.ink };
            let size = (0.3 * arrow.norm()).min(0.025 * reach);
            let to = from + arrow;
            let strips = [vec![point(from, z), point(to, z)], head(to, arrow / arrow.norm(), size, z)];
            scene.lines.push(Polyline::new(pin.item.clone(), strips, 2.2, colour).on_top());
            if worst {
                let text = format!("{} {} N", pin.name, signed(force.norm(), 1));
                let at = point(to, z);
                scene.labels.push(Label::new("pin_forces/worst", at, [8.0, 0.0], text, colour, 12.0, Anchor::Left));
            }
        }
        let undefined = (0..pins.len().min(frame.inside.pins())).filter(|i| frame.inside.pin(*i).is_none()).count();
        let text = match undefined {
            0 => format!("pins: {:.3} m = {} N", 0.25 * reach, round_number(full)),
            n => format!("pins: {n} undefined at a change point"),
        };
        // The label is below those of the reaction.
        let at = point(Vector::new(0.2 * reach, -0.11 * reach), z);
        scene.labels.push(Label::new("pin_forces/scale", at, [0.0, 90.0], text, palette.dim, 11.5, Anchor::Left));
    }
}
