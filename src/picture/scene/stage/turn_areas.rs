//! Nested areas that straight rays of the end effector reach at zero momentum, and while the base turns a little.

use std::sync::Arc;

use crate::scene::exaggeration::DrawnFrame;
use crate::scene::linkage::LinkageModel;
use crate::scene::palette::{Palette, faded};
use crate::scene::{Anchor, ItemChanges, Label, Mesh, Polyline, Scene, Solid, Strips, fill, point, posed};
use stillbase_mechanics::planar::{Pose2, Vector, unit};
use stillbase_planning::off_plane::momentum::MomentumModel;
use stillbase_planning::off_plane::rays::Rays;
use stillbase_query::ProgressCallback;
use stillbase_study::turn_map::{TurnMap, TurnRay, turn_limits};

/// Opacity of the fill of each area; inner areas lie on outer ones and so are darker.
const FILL_OPACITY: f32 = 0.07;
/// Distance of the fills below their boundaries and from each other, as a fraction of the reach.
const FILL_DEPTH: f64 = 1e-3;
/// Labels lie at least this far apart, and their boundaries go on evenly around them, as fractions of the reach.
const LABEL_GAP: f64 = 0.12;
const EVEN: f64 = 0.05;

/// Nested areas around the start of a task.
#[derive(Clone, Debug)]
pub struct TurnAreas {
    areas: Vec<TurnArea>,
    /// Where dynamic singularities end zero momentum, m.
    singular: Strips,
    /// Place of the label of the longest such curve, m.
    singular_label: Option<Vector>,
    /// The arm and its base.
    model: MomentumModel,
    /// Whether they move with the base.
    carried: bool,
}

/// What is reached within a turn of the base.
#[derive(Clone, Debug)]
struct TurnArea {
    boundary: Strips,
    mesh: Arc<Mesh>,
    /// Place of its label, m, if there is room for it.
    label: Option<(Vector, String)>,
}

impl TurnAreas {
    /// Follows the rays of a run whose base floats, or does not. `goes_on` is called with the completed fraction; returns
    /// `None` if it returns false.
    pub fn of(rays: &Rays, floats: bool, goes_on: ProgressCallback<'_>) -> Option<Self> {
        let map = TurnMap::of(rays, turn_limits(floats), goes_on)?;
        let places = label_places(&map, rays.model().reach());
        let area = |i: usize| {
            let outline = map.outline(i);
            let line = outline.iter().chain(outline.first()).map(|p| point(*p, 0.0)).collect::<Vec<_>>();
            let loops = [outline.iter().map(|p| [p.re, p.im]).collect()];
            let label = places[i].map(|at| (at, limit_words(map.turn_limits[i])));
            TurnArea { boundary: [line].into(), mesh: Arc::new(fill::mesh(&loops)), label }
        };
        let curves = map.singular_curves();
        let length = |curve: &[Vector]| curve.windows(2).map(|ends| (ends[1] - ends[0]).norm()).sum::<f64>();
        let longest = curves.iter().max_by(|a, b| length(a).total_cmp(&length(b)));
        let has_room = |curve: &&Vec<Vector>| length(curve) > LABEL_GAP * rays.model().reach();
        Some(Self {
            singular_label: longest.filter(has_room).map(|curve| curve[curve.len() / 2]),
            singular: curves.iter().map(|curve| curve.iter().map(|p| point(*p, 0.0)).collect::<Vec<_>>()).collect(),
            areas: (0..map.turn_limits.len()).map(area).collect(),
            model: rays.model().clone(),
            carried: rays.model().is_carried(),
        })
    }

    /// Returns whether these are areas of an arm on a base, from whatever start.
    pub fn is_of(&self, model: &MomentumModel) -> bool {
        self.model.is_same_craft(model)
    }

    /// Returns the triangles of each area.
    pub fn fills(&self) -> impl Iterator<Item = &Mesh> {
        self.areas.iter().map(|area| &*area.mesh)
    }

    /// Returns points of the boundaries of all areas, with the base of a frame, m.
    pub fn points(&self, base: Pose2) -> Vec<Vector> {
        let base = if self.carried { base } else { Pose2::default() };
        let all = self.areas.iter().flat_map(|area| area.boundary.iter().flatten());
        all.map(|[x, y, _]| base.place(Vector::new(f64::from(*x), f64::from(*y)))).collect()
    }

    /// Draws the areas; `fills` are the indices of their meshes, `opacity` is 1 unless others will replace them.
    pub fn draw(
        &self,
        scene: &mut Scene,
        linkage: &LinkageModel,
        palette: &Palette,
        shown: &DrawnFrame<'_>,
        (fills, opacity): (&[usize], f32),
    ) {
        let base = if self.carried { shown.base } else { Pose2::default() };
        let z = linkage.floor();
        let pose = |z: f64| posed(base.at, unit(base.angle), z);
        for (i, (area, mesh)) in self.areas.iter().zip(fills).enumerate() {
            scene.solids.push(Solid {
                name: format!("turns/{i}").into(),
                mesh: *mesh,
                world_from_item: pose(z - (i + 1) as f64 * FILL_DEPTH * linkage.reach()),
                colour: faded(palette.amber, opacity * FILL_OPACITY),
                changes: ItemChanges::Pose,
            });
            let (width, of_line) = if i == 0 { (1.8, 1.0) } else { (1.0, 0.75) };
            let line = Polyline::new(
                format!("turns/{i}/boundary"),
                area.boundary.clone(),
                width,
                faded(palette.amber, opacity * of_line),
            );
            scene.lines.push(line.moving(pose(z)));
            if let Some((at, text)) = &area.label {
                let (at, name) = (point(base.place(*at), z), format!("turns/{i}/label"));
                scene.labels.push(Label::new(name, at, [0.0, 0.0], text, palette.ink, 11.5, Anchor::Centre));
            }
        }
        let line = Polyline::new("turns/singular", self.singular.clone(), 2.4, faded(palette.reaction, opacity));
        scene.lines.push(line.moving(pose(z)));
        if let Some(at) = self.singular_label {
            let (at, text) = (point(base.place(at), z), "dynamic singularity");
            scene.labels.push(Label::new(
                "turns/singular/label",
                at,
                [0.0, 0.0],
                text,
                palette.ink,
                11.5,
                Anchor::Centre,
            ));
        }
    }
}

/// Returns the words for the area within a turn of the base, °.
pub fn limit_words(turn: f64) -> String {
    if turn == 0.0 { "zero momentum".into() } else { format!("{turn}°") }
}

/// Returns a place for the label of each boundary, m: where the boundary is far from its neighbours, goes on evenly, and
/// no other label is near. `None` if the boundary lies on the next one throughout.
pub fn label_places(map: &TurnMap, reach: f64) -> Vec<Option<Vector>> {
    let count = map.turn_limits.len();
    let mut places: Vec<Option<Vector>> = vec![None; count];
    // The outer boundaries have most room.
    for i in (0..count).rev() {
        let rays: Vec<&TurnRay> = map.rays_of(i).collect();
        let ends: Vec<Vector> = rays.iter().map(|ray| map.end(i, ray)).collect();
        let n = ends.len();
        let room = |ray: &TurnRay| {
            let inner = if i == 0 { f64::INFINITY } else { ray.reaches[i] - ray.reaches[i - 1] };
            let outer = if i + 1 == count { f64::INFINITY } else { ray.reaches[i + 1] - ray.reaches[i] };
            inner.min(outer).min(ray.reaches[i])
        };
        let is_even =
            |k: usize| [(k + 1) % n, (k + n - 1) % n].iter().all(|next| (ends[*next] - ends[k]).norm() < EVEN * reach);
        let apart =
            |k: usize| places.iter().flatten().map(|other| (other - ends[k]).norm()).fold(f64::INFINITY, f64::min);
        let is_free = |k: &usize| is_even(*k) && apart(*k) > LABEL_GAP * reach && room(rays[*k]) > 0.0;
        let widest = (0..n).filter(is_free).max_by(|a, b| room(rays[*a]).total_cmp(&room(rays[*b])));
        places[i] = widest.map(|k| ends[k]);
    }
    places
}
