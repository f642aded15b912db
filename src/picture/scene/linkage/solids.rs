//! The solids of a machine in a pose, and the lines along slender bars.

use super::LinkageModel;
use crate::scene::palette::{Palette, faded, mix};
use crate::scene::{ItemChanges, Name, Polyline, Solid, posed};
use stillbase_mechanics::machine::place_of;
use stillbase_mechanics::planar::{Pose2, UnitVectors, Vector, unit};

impl LinkageModel {
    /// Returns all solids of the machine on a base in the given pose; `moves` says whether the base can move.
    pub fn solids(&self, e: &UnitVectors, base: Pose2, moves: bool, palette: &Palette) -> Vec<Solid> {
        let mut solids = Vec::with_capacity(self.bars.len() + 3 * self.pins.len() + self.motors.len() + 2);
        let upright = |name: Name, mesh, at: Vector, z, colour, changes| {
            let world_from_item = posed(base.at + at, Vector::new(1.0, 0.0), z);
            Solid { name, mesh, world_from_item, colour, changes }
        };
        let grey = mix(palette.dim, palette.line, 0.65);
        let under = self.bottom();
        let with_base = if moves { ItemChanges::Pose } else { ItemChanges::Nothing };
        let turned = |name: Name, mesh, z, colour| Solid {
            name,
            mesh,
            world_from_item: posed(base.at, unit(base.angle), z),
            colour,
            changes: with_base,
        };
        solids.push(turned("machine/base".into(), self.plate.mesh, under, grey));
        if moves {
            let colour = mix(grey, palette.line, 0.5);
            solids.push(turned("machine/base/body".into(), self.body.mesh, under - 0.002 * self.reach, colour));
        }
        for motor in &self.motors {
            let colour = mix(palette.drive(motor.drive), grey, 0.45);
            let name = motor.name.clone();
            solids.push(match &motor.at {
                Some(at) => upright(name, motor.disc.mesh, place_of(at, e), motor.z, colour, ItemChanges::Pose),
                None => turned(name, motor.disc.mesh, motor.z, colour),
            });
        }
        solids.extend(self.bars.iter().map(|bar| bar.solid(e, base.at, palette.drive(bar.drive))));
        for pin in self.pins.iter().chain(&self.axis) {
            let at = place_of(&pin.at, e);
            let stretched = |name: &'static str, mesh, z: [f64; 2], colour| {
                let mut solid = upright(name.into(), mesh, at, z[0], colour, ItemChanges::Pose);
                solid.world_from_item[2][2] = pin.size.stretch(z) as f32;
                solid
            };
            solids.push(stretched("machine/joints", pin.size.pin, pin.z, palette.ink));
            let spacers = pin.spacers.iter();
            solids.extend(spacers.map(|z| stretched("machine/joints/spacers", pin.size.spacer, *z, grey)));
            let (name, colour) = ("machine/joints/holes".into(), palette.background);
            solids.push(upright(name, pin.size.hole, at, pin.z[1], colour, ItemChanges::Pose));
        }
        if self.axis.is_none() {
            solids.push(turned("machine/base/cap".into(), self.cap.mesh, 0.0, grey));
        }
        solids
    }

    /// Returns lines along the bars that are too narrow to be seen from afar.
    pub fn threads(&self, e: &UnitVectors, base: Vector, palette: &Palette) -> impl Iterator<Item = Polyline> {
        self.bars.iter().filter_map(move |bar| bar.line(e, base, palette.drive(bar.drive)))
    }

    /// Returns the links between base and end effector in another pose, as translucent solids named `name/…`.
    pub fn ghost(&self, name: &str, e: &UnitVectors, palette: &Palette, alpha: f32) -> Vec<Solid> {
        let carriers = self.bars.iter().filter(|b| b.carries_tip);
        carriers
            .map(|bar| Solid {
                name: format!("{name}/{}", bar.name).into(),
                changes: ItemChanges::Nothing,
                ..bar.solid(e, Vector::default(), faded(palette.drive(bar.drive), alpha))
            })
            .collect()
    }
}
