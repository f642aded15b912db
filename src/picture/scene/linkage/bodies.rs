//! The room that a machine takes: its parts as strips and discs, which labels leave free.

use super::LinkageModel;
use super::schematic::THIN_BAR_RADIUS;
use crate::scene::{Body, point};
use stillbase_mechanics::machine::place_of;
use stillbase_mechanics::planar::{Pose2, UnitVectors, Vector, unit};

impl LinkageModel {
    /// Returns the pins between links as discs, at the top of the machine.
    pub fn pin_discs(&self, e: &UnitVectors, base: Vector) -> impl Iterator<Item = Body> {
        let (e, radius, top) = (*e, (THIN_BAR_RADIUS * self.reach) as f32, self.top());
        let at = move |pin: &super::Pin| point(base + place_of(&pin.at, &e), top);
        self.pins.iter().map(move |pin| Body { ends: [at(pin); 2], radius, height: 0.0 })
    }

    /// Returns links, counterweights, drives and base as strips and discs; `moves` says whether the base can move.
    pub fn bodies(&self, e: &UnitVectors, base: Pose2, moves: bool) -> impl Iterator<Item = Body> {
        let e = *e;
        let body = move |ends: [(Vector, f64); 2], radius: f64, height: f64| Body {
            ends: ends.map(|(p, z)| point(base.at + p, z)),
            radius: radius as f32,
            height: height as f32,
        };
        let links = self.bars.iter().flat_map(move |bar| {
            let (root, along, z) = bar.pose(&e);
            let link = body(bar.span.map(|s| (root + along * s, z)), bar.radius, bar.height);
            let discs = bar.covers.iter().map(move |disc| {
                let ends = disc.ends.map(|end| (root + along * end, z + disc.z));
                body(ends, disc.radius, disc.height)
            });
            discs.chain([link])
        });
        let drives = self.motors.iter().filter_map(move |motor| {
            let at = (place_of(motor.at.as_ref()?, &e), motor.z);
            Some(body([at; 2], motor.disc.radius, motor.disc.height))
        });
        let (centre, bottom) = (Vector::default(), self.bottom());
        let foot = body([(centre, bottom); 2], self.plate.radius, self.plate.height);
        // The drives on the base and the cap above the links.
        let on_base = self.motors.iter().filter(|motor| motor.at.is_none());
        let widest = on_base.fold(self.cap.radius, |most, motor| most.max(motor.disc.radius));
        let column = body([(centre, bottom), (centre, self.top())], widest, 0.0);
        let end = move |side: f64| (unit(base.angle) * (side * self.body.half_length), bottom);
        let plate = moves.then(|| body([end(-1.0), end(1.0)], self.body.radius, self.body.height));
        links.chain(drives).chain([foot, column]).chain(plate)
    }
}
