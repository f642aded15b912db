//! [`PlatformReach`]: where the last platform of blocks that carry each other can be while each holds its b, as a
//! surface in space.
//!
//! Of the longest chain, the last block reaches a region or a curve in its plane, from wherever its carrier has its
//! platform. So the reach is the sum of both sets; that of parallel planes is flat. Each b turns its own set about its
//! pin. Where the carrier is carried itself, its reach is drawn from where the blocks below hold it now: what these add
//! is left out.

mod flat;
pub mod slices;
mod strips;
mod surface;
mod traced;

use std::array;

use nalgebra::{Matrix3, Vector3};

use self::flat::FlatSum;
use self::slices::{Lines, Slices};
use self::strips::outline;
use self::surface::{Axes, Surface};
use self::traced::Traced;
use super::palette::{Palette, faded};
use super::stage::Stage;
use super::{ItemChanges, Mesh, Polyline, Scene, Solid, Strips, Transform};
use stillbase_mechanics::assembly::Assembly;
use stillbase_mechanics::planar::{Vector, unit};

/// Largest deviation of the surface, as a share of the size of both sets together.
const CHORD: f64 = 4e-4;

/// Least sine of the angle at which planes cross, and least width of a set across u, as a share of the size: below, the
/// sum counts as flat.
const LEAST_ANGLE: f64 = 1e-6;
const LEAST_WIDTH: f64 = 1e-6;

/// Direction of the lines by which a flat sum is found, rad from x: none of the boundaries is likely to run along it.
const FLAT_LINES_RAD: f64 = 0.618;

/// The surface stays as it is for changes of b up to this, rad: they move it by less than is seen.
const SAME_B_RAD: f64 = 1e-6;

/// Opacity of the surface.
const OPACITY: f32 = 0.06;
/// Opacity and width, px, of the lines on it.
const LINE_OPACITY: f32 = 0.3;
const LINE_WIDTH_PX: f32 = 0.9;

/// What a block reaches in its plane.
#[derive(Clone, Debug)]
pub struct BlockReach {
    /// The set at b = 0, m from the base pin.
    pub set: Lines,
    /// Σλ.
    pub lambda_sum: f64,
    /// Directions x, y, z of its plane in axes of the base, as columns.
    pub axes: Matrix3<f64>,
    /// Height of the end effector along z, m.
    pub height: f64,
}

impl BlockReach {
    /// Returns the set at a b, rad, as vectors in axes of the base, along two directions.
    fn along(&self, b: f64, directions: [&Vector3<f64>; 2]) -> Lines {
        let turn = unit(b / self.lambda_sum);
        let [re, im] = directions.map(|way| Vector::new(way.dot(&self.axes.column(0)), way.dot(&self.axes.column(1))));
        self.set.mapped(|p| {
            let p = turn * p;
            Vector::new(p.re * re.re + p.im * re.im, p.re * im.re + p.im * im.im)
        })
    }

    fn normal(&self) -> Vector3<f64> {
        self.axes.column(2).into_owned()
    }

    fn size(&self) -> f64 {
        self.set.extent().map_or(0.0, |[s, v]| (s[1] - s[0]).hypot(v[1] - v[0]))
    }
}

/// The reach of the last platform.
#[derive(Clone, Debug)]
pub struct PlatformReach {
    /// Places of the carrier and the last block in the assembly.
    blocks: [usize; 2],
    reaches: [BlockReach; 2],
    /// Place of the last block from the end effector of its carrier, m, in axes of the base.
    between: Vector3<f64>,
    /// b of both blocks for which the surface was made, rad.
    made_for: Option<[f64; 2]>,
    lines: Strips,
}

impl PlatformReach {
    /// Returns the reach of a platform of an assembly, without its surface; `None` if no block carries another, or the
    /// workspace of one of the two is not known or is a point. `stage` returns that of a block.
    pub fn of<'a>(assembly: &Assembly, stage: impl Fn(usize) -> Option<&'a Stage>) -> Option<Self> {
        let chain = assembly.longest_chain();
        let [.., carrier, last] = chain[..] else { return None };
        let reach = |i: usize| {
            let (workspace, block) = (stage(i)?.outlined()?, &assembly.blocks()[i]);
            let space = workspace.space();
            let (axes, height) = (block.mount.axes, block.platform_height());
            Some(BlockReach { set: workspace.lines(), lambda_sum: space.lambda_sum(), axes, height })
        };
        let between = assembly.blocks()[last].mount.at;
        Some(Self::new([carrier, last], [reach(carrier)?, reach(last)?], between))
    }

    /// Returns the reach of two blocks, with the place of the last one from the end effector of its carrier, m.
    pub fn new(blocks: [usize; 2], reaches: [BlockReach; 2], between: Vector3<f64>) -> Self {
        let mut own = Self { blocks, reaches, between, made_for: None, lines: Strips::default() };
        let chord = 0.25 * own.chord();
        own.reaches.iter_mut().for_each(|reach| reach.set = reach.set.simplified(chord));
        own
    }

    /// Largest deviation of the surface, m.
    pub fn chord(&self) -> f64 {
        CHORD * self.reaches.iter().map(BlockReach::size).sum::<f64>()
    }

    /// Returns the carrier, from whose mount the surface is.
    pub fn carrier(&self) -> usize {
        self.blocks[0]
    }

    /// Returns the surface for the b of its blocks, rad, if it is another than the last one; `b` returns that of a
    /// block.
    pub fn remade(&mut self, b: impl Fn(usize) -> Option<f64>) -> Option<Mesh> {
        let [below, above] = self.blocks;
        let now = [b(below)?, b(above)?];
        let is_near = |made: [f64; 2]| (0..2).all(|i| (made[i] - now[i]).abs() <= SAME_B_RAD);
        if self.made_for.is_some_and(is_near) {
            return None;
        }
        self.made_for = Some(now);
        let (mesh, lines) = self.at(now);
        self.lines = lines.into();
        Some(mesh)
    }

    /// Returns surface and lines at the b of the carrier and the last block, rad, in axes of the base, from the mount
    /// of the carrier, m.
    pub fn at(&self, b: [f64; 2]) -> (Mesh, Vec<Vec<[f32; 3]>>) {
        let [below, above] = &self.reaches;
        let normals = [below.normal(), above.normal()];
        let crossing = normals[0].cross(&normals[1]);
        let origin = self.between + below.height * normals[0] + above.height * normals[1];
        let sine = crossing.norm();
        if sine < LEAST_ANGLE {
            return self.flat(0, b, origin);
        }
        let u = crossing / sine;
        let [v, w] = normals.map(|normal| normal.cross(&u));
        let sets = [below.along(b[0], [&u, &v]), above.along(b[1], [&u, &w])];
        let thin =
            |set: &Lines| set.extent().is_none_or(|[_, [from, to]]| to - from <= LEAST_WIDTH * self.chord() / CHORD);
        match (thin(&sets[0]), thin(&sets[1])) {
            // A set along u is in the plane of the other one, too.
            (_, true) => return self.flat(0, b, origin),
            (true, false) => return self.flat(1, b, origin),
            (false, false) => {}
        }
        let [first, second] = sets.map(|set| Slices::of(&set, self.chord()));
        Surface::of(&first, &second, Axes { directions: [u, v, w], origin })
    }

    /// Returns a flat sum, in the plane of one of both blocks.
    fn flat(&self, plane: usize, b: [f64; 2], origin: Vector3<f64>) -> (Mesh, Vec<Vec<[f32; 3]>>) {
        let (own, turn) = (&self.reaches[plane], unit(FLAT_LINES_RAD));
        let [x, y, normal] = array::from_fn(|i| own.axes.column(i).into_owned());
        let (u, v) = (x * turn.re + y * turn.im, y * turn.re - x * turn.im);
        let other = self.reaches[1 - plane].along(b[1 - plane], [&normal, &normal]);
        let off = other.lines.iter().flatten().next().map_or(0.0, |p| p.re);
        let origin = origin + off * normal;
        let [first, second] = array::from_fn(|i| Slices::of(&self.reaches[i].along(b[i], [&u, &v]), self.chord()));
        let pieces = FlatSum(&first, &second).pieces(self.chord());
        let place = |[s, level]: [f64; 2]| origin + s * u + level * v;
        let mut mesh = Mesh { shell: true, ..Mesh::default() };
        for piece in &pieces {
            let ([low, high], [from, to]) = (piece.ends, piece.range);
            let at = mesh.positions.len() as u32;
            let corners = [[low[0], from], [high[0], from], [high[1], to], [low[1], to]];
            mesh.positions.extend(corners.map(|p| <[f32; 3]>::from(place(p).map(|x| x as f32))));
            mesh.normals.extend([<[f32; 3]>::from(normal.map(|x| x as f32)); 4]);
            mesh.triangles.extend([[at, at + 1, at + 2], [at, at + 2, at + 3]]);
        }
        let mut lines = Traced::new(0.01 * self.chord());
        outline(&pieces, 0.5 * self.chord()).iter().for_each(|edge| lines.add(place(edge[0]), place(edge[1])));
        (mesh, lines.strips())
    }

    /// Adds the surface, a mesh of the scene, and its lines in a pose.
    pub fn draw(&self, scene: &mut Scene, palette: &Palette, mesh: usize, pose: Transform) {
        scene.solids.push(Solid {
            name: "reach".into(),
            mesh,
            world_from_item: pose,
            colour: faded(palette.amber, OPACITY),
            changes: ItemChanges::Pose,
        });
        let colour = faded(palette.amber, LINE_OPACITY);
        scene.lines.push(Polyline::new("reach/lines", self.lines.clone(), LINE_WIDTH_PX, colour).moving(pose));
    }
}
