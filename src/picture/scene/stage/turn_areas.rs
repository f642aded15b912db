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
use stillbase_study::turn_map::{TurnMap, turn_limits};

/// Opacity of the fill of each area; inner areas lie on outer ones and so are darker.
const FILL_OPACITY: f32 = 0.07;
/// Distance of the fills below their boundaries and from each other, as a fraction of the reach.
const FILL_DEPTH: f64 = 1e-3;
/// Boundaries closer to each other than this fraction of the reach share a label.
const LABEL_GAP: f64 = 0.08;

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
        let last = map.turn_limits.len() - 1;
        // The ray with the most room between the boundaries carries the labels.
        let room = |reaches: &[f64]| match reaches {
            [one] => *one,
            many => many.windows(2).fold(f64::INFINITY, |least, pair| least.min(pair[1] - pair[0])),
        };
        let widest = map.rays.iter().enumerate().max_by(|a, b| room(&a.1.reaches).total_cmp(&room(&b.1.reaches)))?.0;
        let mut labelled = f64::NEG_INFINITY;
        let area = |i: usize| {
            let outline = map.outline(i);
            let gap = LABEL_GAP * rays.model().reach();
            let at = map.rays[widest].reaches[i];
            let has_room = at - labelled > gap && (i == last || map.rays[widest].reaches[last] - at > gap);
            let label = has_room.then(|| {
                labelled = at;
                let turn = map.turn_limits[i];
                (map.end(i, &map.rays[widest]), if turn == 0.0 { "zero momentum".into() } else { format!("{turn}°") })
            });
            let line = outline.iter().chain(outline.first()).map(|p| point(*p, 0.0)).collect::<Vec<_>>();
            let loops = [outline.iter().map(|p| [p.re, p.im]).collect()];
            TurnArea { boundary: [line].into(), mesh: Arc::new(fill::mesh(&loops)), label }
        };
        let curves = map.singular_curves();
        let length = |curve: &[Vector]| curve.windows(2).map(|ends| (ends[1] - ends[0]).norm()).sum::<f64>();
        let longest = curves.iter().max_by(|a, b| length(a).total_cmp(&length(b)));
        let has_room = |curve: &&Vec<Vector>| length(curve) > LABEL_GAP * rays.model().reach();
        Some(Self {
            singular_label: longest.filter(has_room).map(|curve| curve[curve.len() / 2]),
            singular: curves.iter().map(|curve| curve.iter().map(|p| point(*p, 0.0)).collect::<Vec<_>>()).collect(),
            areas: (0..=last).map(area).collect(),
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

    /// Returns points of the boundary of what zero momentum reaches, with the base of a frame, m.
    pub fn points(&self, base: Pose2) -> Vec<Vector> {
        let base = if self.carried { base } else { Pose2::default() };
        let all = self.areas.iter().take(1).flat_map(|area| area.boundary.iter().flatten());
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
