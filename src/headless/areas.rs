//! The reactionless workspaces: area and boundary once, and how b turns them.

use std::sync::Arc;

use rerun::{Clear, EntityPath, Mesh3D, Points3D, Transform3D};

use super::rows::Track;
use super::store::{Instant, Store, StoreError};
use super::style::{colour, dots, lines, named, point, turned, under};
use crate::frame::Frame;
use crate::planar::{Vector, unit};
use crate::pose_constant::Planes;
use crate::reactionless::Limit;
use crate::scene::linkage::Linkage;
use crate::scene::palette::{Palette, faded};

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
    turn: Track<f64>,
    label: Track<String>,
}

/// What an area looks like: edges are a little stronger than fills, the compared one lies under the other.
struct Look {
    fill: crate::scene::Rgba,
    edge: crate::scene::Rgba,
    words: crate::scene::Rgba,
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

    /// Writes what is new of the workspaces at an instant: for good, or from an instant on.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn show(
        &mut self,
        store: &mut Store,
        (at, since): (Instant, Option<Instant>),
        planes: &Arc<Planes>,
        linkage: &Linkage,
        b: f64,
        compare: Option<f64>,
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
            own.show(store, since, planes, &look)?;
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
            area.show(store, since, planes, &look)?;
            area.place(at, planes, b);
            self.compared = Some(area);
        }
        Ok(())
    }

    /// How the workspace stands at an instant.
    pub fn place(&mut self, at: Instant, frame: &Frame) {
        if let (Some(planes), Some(own)) = (&self.planes, &mut self.own) {
            own.place(at, planes, frame.b_reference);
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

impl Area {
    fn new(path: EntityPath, b: f64) -> Self {
        Self { path, b, turn: Track::new(), label: Track::new() }
    }

    fn show(&self, store: &mut Store, since: Option<Instant>, planes: &Planes, look: &Look) -> Result<(), StoreError> {
        let map = planes.map();
        let [first, second] = map.limits();
        let between = |l: Limit, share: f64| l.min + (l.max - l.min) * share;
        let at = |s: f64, t: f64| point(map.forward_unturned([between(first, s), between(second, t)]), look.z);
        let share = |i: u32| f64::from(i) / f64::from(CELLS);
        let corners = (0..=CELLS).flat_map(|i| (0..=CELLS).map(move |j| at(share(i), share(j))));
        let cells = (0..CELLS).flat_map(|i| (0..CELLS).map(move |j| i * (CELLS + 1) + j));
        let triangles = cells.flat_map(|c| [[c, c + CELLS + 1, c + 1], [c + 1, c + CELLS + 1, c + CELLS + 2]]);
        let fill = Mesh3D::new(corners).with_triangle_indices(triangles).with_albedo_factor(colour(look.fill).0);
        store.shape(since, &self.path, &fill)?;
        let outlines = planes.boundary().turned(0.0).into_iter().map(|mut outline| {
            outline.extend(outline.first().copied());
            outline.into_iter().map(|[x, y]| point(Vector::new(x, y), look.z)).collect()
        });
        store.shape(since, &under(&self.path, "boundary"), &lines(outlines, look.width, look.edge))?;
        // In the broad part, where the arm rarely is.
        let words = dots(0.5, look.words).with_positions([at(0.86, 0.88)]).with_show_labels(true);
        store.shape(since, &under(&self.path, "label"), &words)
    }

    fn place(&mut self, at: Instant, planes: &Planes, b: f64) {
        self.turn.push(at, planes.map().turn(b));
        self.label.push(at, format!("b = {b:.3} rad"));
    }

    fn write(&mut self, store: &mut Store) -> Result<(), StoreError> {
        let (clock, turns) = self.turn.take();
        let turns = turns.into_iter().map(|turn| turned(unit(turn)));
        let pose = Transform3D::update_fields().with_many_quaternion(turns);
        store.columns(&clock.columns(), &self.path, pose.columns_of_unit_batches()?)?;
        let (clock, labels) = self.label.take();
        let words = Points3D::update_fields().with_labels(labels.iter().map(String::as_str));
        store.columns(&clock.columns(), &under(&self.path, "label"), words.columns_of_unit_batches()?)
    }
}
