//! The reactionless workspaces: area and boundary once, and how b turns them.

use std::sync::Arc;

use rerun::{Clear, EntityPath, Mesh3D, Points3D, Quaternion, Transform3D};

use super::inside;
use super::rows::Track;
use super::store::{Instant, Store, StoreError};
use super::style::{colour, dots, lines, named, point, turned, under};
use crate::mechanics::planar::{Pose2, Vector, unit};
use crate::picture::scene::Rgba;
use crate::picture::scene::linkage::Linkage;
use crate::picture::scene::palette::{Palette, faded};
use crate::planning::pose_constant::Planes;
use crate::planning::reactionless::{AngleLimit, PlaneMap};
use crate::simulation::frame::Frame;

/// Cells of a workspace along each angle.
const CELLS: u32 = 40;

/// The workspace of the machine's b, and the one to compare with.
#[derive(Debug)]
pub struct Areas {
    root: EntityPath,
    palette: Palette,
    planes: Option<Arc<Planes>>,
    own: Option<Area>,
    compared: Option<Area>,
}

#[derive(Debug)]
struct Area {
    path: EntityPath,
    b: f64,
    pose: Track<([f32; 3], Quaternion)>,
    label: Track<String>,
}

/// What an area looks like: edges are a little stronger than fills, the compared one lies under the other.
struct Look {
    fill: Rgba,
    edge: Rgba,
    words: Rgba,
    width: f32,
    z: f64,
}

impl Areas {
    /// None yet, of a case.
    pub fn new(root: &EntityPath, palette: Palette) -> Self {
        Self { root: root.clone(), palette, planes: None, own: None, compared: None }
    }

    fn path(&self, b: f64) -> EntityPath {
        named(&self.root, "workspace", &format!("{b:.3}"))
    }

    /// Writes what is new of the workspaces at an instant: for good, or from an instant on. Words keep off points, m.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn show(
        &mut self,
        store: &mut Store,
        (at, since): (Instant, Option<Instant>),
        planes: &Arc<Planes>,
        linkage: &Linkage,
        (b, compare, base): (f64, Option<f64>, Pose2),
        avoid: &[Vector],
    ) -> Result<(), StoreError> {
        let palette = self.palette;
        let fresh = !self.planes.as_ref().is_some_and(|known| Arc::ptr_eq(known, planes));
        self.planes = Some(planes.clone());
        if fresh {
            let look = Look {
                fill: faded(palette.amber, 0.14),
                edge: palette.amber,
                words: palette.amber,
                width: 1.8,
                z: linkage.floor(),
            };
            let own = self.own.take().unwrap_or_else(|| Area::new(self.path(b), b));
            let back = unit(-planes.map().turn(b));
            // The arm reaches from B to the path.
            let way = |p: Vector| [0.25, 0.5, 0.75, 1.0].map(|share| p * back * share);
            let avoid: Vec<Vector> = avoid.iter().step_by(4).flat_map(|p| way(*p)).collect();
            own.show(store, since, planes, &avoid, &look)?;
            inside::show(store, &own.path, since, planes, [linkage.reach(), look.z], &palette)?;
            self.own = Some(own);
        }
        if !fresh && compare == self.compared.as_ref().map(|area| area.b) {
            return Ok(());
        }
        if let Some(mut old) = self.compared.take() {
            old.write(store)?;
            store.shape(Some(at), &old.path, &Clear::recursive())?;
        }
        if let Some(b) = compare {
            let look = Look {
                fill: faded(palette.dim, 0.09),
                edge: faded(palette.dim, 0.6),
                words: palette.dim,
                width: 1.2,
                z: linkage.floor() - 0.004 * linkage.reach(),
            };
            let mut path = self.path(b);
            if self.own.as_ref().is_some_and(|own| own.path == path) {
                path = named(&self.root, "workspace", &format!("{b:.3} compared"));
            }
            let mut area = Area::new(path, b);
            area.show(store, since, planes, &[], &look)?;
            area.place(at, planes, b, base);
            self.compared = Some(area);
        }
        Ok(())
    }

    /// How the workspace stands at an instant.
    pub fn place(&mut self, at: Instant, frame: &Frame) {
        if let (Some(planes), Some(own)) = (&self.planes, &mut self.own) {
            own.place(at, planes, frame.b_reference, frame.base);
            if let Some(compared) = &mut self.compared {
                let b = compared.b;
                compared.place(at, planes, b, frame.base);
            }
        }
    }

    /// Writes the rows since the last time.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn write(&mut self, store: &mut Store) -> Result<(), StoreError> {
        [&mut self.own, &mut self.compared].into_iter().flatten().try_for_each(|area| area.write(store))
    }
}

/// The point of the workspace, not turned, at shares of the ranges of a_1 and a_2.
fn within(map: &PlaneMap, shares: [f64; 2]) -> Vector {
    let between = |l: AngleLimit, share: f64| l.min + (l.max - l.min) * share;
    map.forward_unturned([0, 1].map(|i| between(map.limits()[i], shares[i])))
}

/// Where words have room in a workspace that is not turned: off its outline, off the arm's root, off what to avoid.
fn roomiest(planes: &Planes, avoid: &[Vector]) -> Vector {
    let map = planes.map();
    let outline = planes.boundary().turned(0.0).into_iter().flatten().step_by(16);
    let outline: Vec<Vector> = outline.map(|[x, y]| Vector::new(x, y)).collect();
    let off = |p: Vector, from: &[Vector]| from.iter().fold(f64::INFINITY, |m, q| m.min((p - q).norm()));
    let far = 0.35 * map.c().iter().map(|c| c.abs()).sum::<f64>();
    let places = (0..225).map(|i| [i / 15, i % 15].map(|i| (f64::from(i) + 0.5) / 15.0)).map(|at| within(map, at));
    let rooms = places.filter(|p| p.norm() > far).map(|p| (off(p, &outline).min(0.6 * off(p, avoid)), p));
    rooms.max_by(|s, t| s.0.total_cmp(&t.0)).map_or_else(Vector::default, |(_, p)| p)
}

/// A workspace that is not turned, at a height, m.
pub fn sheet(map: &PlaneMap, z: f64, fill: Rgba) -> Mesh3D {
    let share = |i: u32| f64::from(i) / f64::from(CELLS);
    let at = |i, j| point(within(map, [share(i), share(j)]), z);
    let corners = (0..=CELLS).flat_map(|i| (0..=CELLS).map(move |j| at(i, j)));
    let cells = (0..CELLS).flat_map(|i| (0..CELLS).map(move |j| i * (CELLS + 1) + j));
    let triangles = cells.flat_map(|c| [[c, c + CELLS + 1, c + 1], [c + 1, c + CELLS + 1, c + CELLS + 2]]);
    Mesh3D::new(corners).with_triangle_indices(triangles).with_albedo_factor(colour(fill).0)
}

/// The outlines of a workspace that is not turned, at a height, m, as closed lines.
pub fn outlines(planes: &Planes, z: f64) -> impl Iterator<Item = Vec<[f32; 3]>> {
    planes.boundary().turned(0.0).into_iter().map(move |mut outline| {
        outline.extend(outline.first().copied());
        outline.into_iter().map(|[x, y]| point(Vector::new(x, y), z)).collect()
    })
}

impl Area {
    fn new(path: EntityPath, b: f64) -> Self {
        Self { path, b, pose: Track::new(), label: Track::new() }
    }

    fn show(
        &self,
        store: &mut Store,
        since: Option<Instant>,
        planes: &Planes,
        avoid: &[Vector],
        look: &Look,
    ) -> Result<(), StoreError> {
        store.shape(since, &self.path, &sheet(planes.map(), look.z, look.fill))?;
        let boundary = lines(outlines(planes, look.z), look.width, look.edge);
        store.shape(since, &under(&self.path, "boundary"), &boundary)?;
        let middle = point(roomiest(planes, avoid), look.z);
        let words = dots(0.5, look.words).with_positions([middle]).with_show_labels(true);
        store.shape(since, &under(&self.path, "label"), &words)
    }

    /// In the axes of a base.
    fn place(&mut self, at: Instant, planes: &Planes, b: f64, base: Pose2) {
        self.pose.push(at, (point(base.at, 0.0), turned(unit(planes.map().turn(b) + base.angle))));
        self.label.push(at, format!("b = {b:.3} rad"));
    }

    fn write(&mut self, store: &mut Store) -> Result<(), StoreError> {
        let (clock, poses) = self.pose.take();
        let (places, turns): (Vec<_>, Vec<_>) = poses.into_iter().unzip();
        let pose = Transform3D::update_fields().with_many_translation(places).with_many_quaternion(turns);
        store.columns(&clock.columns(), &self.path, pose.columns_of_unit_batches()?)?;
        let (clock, labels) = self.label.take();
        let words = Points3D::update_fields().with_labels(labels.iter().map(String::as_str));
        store.columns(&clock.columns(), &under(&self.path, "label"), words.columns_of_unit_batches()?)
    }
}
