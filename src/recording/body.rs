//! The machine: meshes that never change while it moves, and where they are.

use rerun::{EntityPath, Points3D, Quaternion, Transform3D};

use super::rows::Track;
use super::store::{Clock, Instant, Store, StoreError};
use super::style::{Both, dots, named, point, solid, turned, under};
use crate::mechanics::machine::Machine;
use crate::mechanics::planar::{Pose2, unit};
use crate::picture::scene::linkage::Linkage;
use crate::picture::scene::palette::Palette;
use crate::simulation::frame::Frame;

/// The machine's body, and the rows that say where it is.
#[derive(Debug)]
pub struct Body {
    machine: Machine,
    linkage: Linkage,
    clock: Clock,
    links: Vec<Link>,
    joints: Vec<[f32; 3]>,
    com: Vec<[f32; 3]>,
    base: Track<([f32; 3], Quaternion)>,
}

#[derive(Debug)]
struct Link {
    path: EntityPath,
    places: Vec<[f32; 3]>,
    turns: Vec<Quaternion>,
}

impl Body {
    /// Writes the meshes of a machine, on a base that moves or not: for good, or from an instant on.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn show(
        store: &mut Store,
        root: &EntityPath,
        since: Option<Instant>,
        (machine, moves): (&Machine, bool),
        frame: &Frame,
        palette: &Palette,
    ) -> Result<Self, StoreError> {
        let linkage = Linkage::of(machine);
        let mesh = |i: usize, rgba| solid(&linkage.model.meshes[i], rgba);
        for part in linkage.solids(&frame.q.units(), Pose2::default(), moves, palette) {
            if let Some(name) = part.name.strip_prefix("base/") {
                let path = under(root, &format!("machine/base/{name}"));
                let [.., [x, y, z, _]] = part.world_from_mesh;
                let place = Transform3D::from_translation([x, y, z]);
                store.shape(since, &path, &Both(&mesh(part.mesh, part.colour), &place))?;
            }
        }
        let mut links = Vec::with_capacity(linkage.bars().len());
        for bar in linkage.bars() {
            let path = named(root, "machine/link", &bar.name);
            store.shape(since, &path, &mesh(bar.mesh, palette.drive(bar.drive)))?;
            links.push(Link { path, places: Vec::new(), turns: Vec::new() });
        }
        store.shape(since, &under(root, "machine/joints"), &dots(2.2, palette.background))?;
        store.shape(since, &under(root, "com"), &dots(4.0, palette.ink))?;
        let (joints, com) = (Vec::new(), Vec::new());
        Ok(Self { machine: machine.clone(), linkage, clock: Clock::default(), links, joints, com, base: Track::new() })
    }

    /// Whether it is the body of this machine.
    pub fn shows(&self, machine: &Machine) -> bool {
        self.machine == *machine
    }

    /// What is drawn.
    pub fn linkage(&self) -> &Linkage {
        &self.linkage
    }

    /// Where it is at an instant.
    pub fn place(&mut self, at: Instant, frame: &Frame) {
        let (e, b) = (frame.q.units(), frame.base.at);
        self.clock.push(at);
        for (bar, link) in self.linkage.bars().iter().zip(&mut self.links) {
            let (root, along, z) = bar.pose(&e);
            link.places.push(point(b + root, z));
            link.turns.push(turned(along));
        }
        self.joints.extend(self.linkage.pins(&e).map(|(p, z)| point(b + p, z)));
        self.com.push(point(frame.com, self.linkage.top()));
        self.base.push(at, (point(b, 0.0), turned(unit(frame.base.angle))));
    }

    /// Writes the rows since the last time.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn write(&mut self, store: &mut Store, root: &EntityPath) -> Result<(), StoreError> {
        let (clock, rows) = (self.clock.columns(), self.clock.len());
        self.clock.clear();
        for Link { path, places, turns } in &mut self.links {
            let pose = Transform3D::update_fields()
                .with_many_translation(std::mem::take(places))
                .with_many_quaternion(std::mem::take(turns));
            store.columns(&clock, path, pose.columns_of_unit_batches()?)?;
        }
        let (joints, com) = (std::mem::take(&mut self.joints), std::mem::take(&mut self.com));
        let pins = joints.len().checked_div(rows).unwrap_or(0);
        let joints = Points3D::update_fields().with_positions(joints).columns(std::iter::repeat_n(pins, rows))?;
        store.columns(&clock, &under(root, "machine/joints"), joints)?;
        let com = Points3D::update_fields().with_positions(com).columns_of_unit_batches()?;
        store.columns(&clock, &under(root, "com"), com)?;
        let (clock, poses) = self.base.take();
        let (places, turns): (Vec<_>, Vec<_>) = poses.into_iter().unzip();
        let pose = Transform3D::update_fields().with_many_translation(places).with_many_quaternion(turns);
        store.columns(&clock.columns(), &under(root, "machine/base"), pose.columns_of_unit_batches()?)
    }
}
