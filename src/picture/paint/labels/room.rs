//! [`Room`]: what labels leave free: the machine, discs, arrows, and what lies over the scene.

use egui::{Pos2, Rect, Vec2, pos2};

use crate::paint::SceneViewport;
use crate::scene::{Body, Scene, segment};

/// Radius, px, up to which a disc is a dot, which labels may cover.
const MIN_DISC_PX: f32 = 2.9;
/// Minimum width, px, and maximum number of vertices of arrows: solid lines that are drawn over everything.
const MIN_ARROW_PX: f32 = 2.0;
const MAX_ARROW_VERTICES: usize = 72;
/// Maximum number of layers that stand for the sides of a tall part.
const MAX_SIDES: f32 = 16.0;
/// Minimum distance of labels from the drawn edge of a part, points.
const CLEARANCE_PT: f32 = 1.5;

/// A strip with round ends on the screen; a disc if both ends are equal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strip {
    ends: [Pos2; 2],
    radius: f32,
}

/// The screen as labels find it.
#[derive(Clone, Debug, PartialEq)]
pub struct Room {
    /// The view.
    pub view: Rect,
    /// Rectangles that are taken: by what lies over the scene, and by labels placed before.
    pub taken: Vec<Rect>,
    /// Parts of the machine, discs, and lines that lead to labels.
    strips: Vec<Strip>,
    /// Arrows, which labels cover only if there is no other place.
    arrows: Vec<[Pos2; 2]>,
}

impl Room {
    /// Returns the room that a scene leaves in a viewport, outside the rectangles `taken`.
    pub fn of(scene: &Scene, spot: &SceneViewport, taken: &[Rect]) -> Self {
        let seen = |at: [f32; 3]| spot.screen(at.map(f64::from));
        let face = |[a, b]: [[f32; 3]; 2], radius: f32| {
            let ends = [seen(a)?, seen(b)?];
            // In perspective the nearer end looks larger.
            let around = |c: [f32; 3], end: Pos2| {
                let aside = [[radius, 0.0], [0.0, radius]].map(|[x, y]| seen([c[0] + x, c[1] + y, c[2]]));
                aside.into_iter().flatten().fold(0.0, |most: f32, at| end.distance(at).max(most))
            };
            let radius = around(a, ends[0]).max(around(b, ends[1]));
            Some(Strip { ends, radius: radius + CLEARANCE_PT })
        };
        let body = |body: &Body| {
            let at = |share: f32| face(body.ends.map(|[x, y, z]| [x, y, z + share * body.height]), body.radius);
            let (low, high) = (at(0.0), at(1.0));
            let apart = low.zip(high).map_or(0.0, |(low, high)| low.ends[0].distance(high.ends[0]));
            // Seen from above, the upper face covers the lower one. Of a tall part, layers between them are its sides.
            let sides = high.map_or(0.0, |high| (apart / high.radius.max(1.0)).ceil().min(MAX_SIDES)) as usize;
            let between = (1..sides).filter_map(move |i| at(i as f32 / sides as f32)).collect::<Vec<_>>();
            let is_seen = apart > 0.5 || low.is_none() || high.is_none();
            low.filter(|_| is_seen).into_iter().chain(high).chain(between)
        };
        let discs = scene.markers.iter().filter(|marker| marker.radius > MIN_DISC_PX).filter_map(|marker| {
            let at = seen(marker.at)?;
            Some(Strip { ends: [at; 2], radius: marker.radius + CLEARANCE_PT })
        });
        let arrows = scene.lines.iter().filter(|line| line.on_top && line.width >= MIN_ARROW_PX && line.dash.is_none());
        let short =
            |line: &&crate::scene::Polyline| line.strips.iter().map(Vec::len).sum::<usize>() <= MAX_ARROW_VERTICES;
        let pairs = |line: &crate::scene::Polyline| {
            let at = |p: &[f32; 3]| seen(crate::scene::place(&line.world_from_item, *p));
            let strips = line.strips.iter().flat_map(|strip| strip.windows(2));
            strips.filter_map(|pair| Some([at(&pair[0])?, at(&pair[1])?])).collect::<Vec<_>>()
        };
        Self {
            view: spot.rect,
            taken: taken.to_vec(),
            strips: scene.bodies.iter().flat_map(body).chain(discs).collect(),
            arrows: arrows.filter(short).flat_map(pairs).collect(),
        }
    }

    /// Adds a line that leads to a label, so that later labels leave it free.
    pub fn take_line(&mut self, ends: [Pos2; 2]) {
        self.strips.push(Strip { ends, radius: 1.0 });
    }

    /// Whether a rectangle is in view and `margin`, points, away from what is taken and from all strips. A disc at
    /// `own`, the point of the label, may be nearer than that.
    pub fn is_free(&self, place: Rect, margin: f32, own: Pos2) -> bool {
        let wide = place.expand(margin);
        self.view.contains_rect(place)
            && !self.taken.iter().any(|other| other.intersects(wide))
            && !self.strips.iter().any(|strip| strip.touches(if strip.ends == [own; 2] { place } else { wide }))
    }

    /// Whether a line crosses a rectangle that is taken.
    pub fn crosses_taken(&self, ends: [Pos2; 2]) -> bool {
        self.taken.iter().any(|place| crosses(ends, *place))
    }

    /// Whether a rectangle covers a part of an arrow.
    pub fn covers_arrow(&self, place: Rect) -> bool {
        self.arrows.iter().any(|ends| crosses(*ends, place))
    }
}

impl Strip {
    fn touches(&self, place: Rect) -> bool {
        let Self { ends, radius } = *self;
        let near = place.expand(radius);
        if !near.intersects(Rect::from_two_pos(ends[0], ends[1])) {
            return false;
        }
        let corners = [place.left_top(), place.right_top(), place.left_bottom(), place.right_bottom()];
        crosses(ends, place)
            || ends.iter().any(|end| place.distance_to_pos(*end) < radius)
            || corners.iter().any(|corner| distance(ends, *corner) < radius)
    }
}

/// Returns the distance of a point from a segment.
fn distance([a, b]: [Pos2; 2], at: Pos2) -> f32 {
    let along: Vec2 = b - a;
    let share = ((at - a).dot(along) / along.length_sq().max(1e-9)).clamp(0.0, 1.0);
    (a + share * along).distance(at)
}

/// Whether a segment meets a rectangle.
fn crosses(ends: [Pos2; 2], place: Rect) -> bool {
    segment::crosses(ends.map(Into::into), [place.left(), place.top(), place.right(), place.bottom()])
}

/// Returns the nearest point of a rectangle to a point.
pub fn nearest(place: Rect, at: Pos2) -> Pos2 {
    pos2(at.x.clamp(place.left(), place.right()), at.y.clamp(place.top(), place.bottom()))
}
