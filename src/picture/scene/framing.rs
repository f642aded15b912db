//! Choice of a camera that shows all content outside the panels that cover parts of the picture.

use super::camera::Camera;

/// Size of the picture and the rectangles that cover parts of it, px.
#[derive(Clone, Debug, PartialEq)]
pub struct PictureArea {
    /// Width and height.
    pub size: [f64; 2],
    /// Left, top, right and bottom of each covering rectangle.
    pub covered: Vec<[f64; 4]>,
}

/// Points to be shown, m.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ViewContent {
    /// Points that are always shown.
    pub first: Vec<[f64; 3]>,
    /// Points that are shown if they make the picture only slightly smaller.
    pub then: Vec<[f64; 3]>,
}

/// Margin around all points for their labels, px.
const MARGIN_PX: f64 = 26.0;
/// Maximum fraction by which the points of [`ViewContent::then`] may reduce the scale.
const MAX_LOSS: f64 = 0.15;
/// Number of iterations in perspective, where the scale depends on the distance.
const ITERATIONS: usize = 12;

impl ViewContent {
    /// Returns the camera of the same direction that shows the content.
    pub fn framed(&self, camera: Camera, room: &PictureArea) -> Camera {
        let (alone, scale) = framed(camera, &self.first, room);
        if self.then.is_empty() {
            return alone;
        }
        let (both, smaller) = framed(camera, &[self.first.as_slice(), &self.then].concat(), room);
        if smaller > (1.0 - MAX_LOSS) * scale { both } else { alone }
    }
}

/// Returns the camera of the same direction that shows the points, and its scale.
fn framed(mut camera: Camera, points: &[[f64; 3]], room: &PictureArea) -> (Camera, f64) {
    let [width, height] = room.size.map(|x| x.max(1.0));
    let aspect = width / height;
    for round in 0..ITERATIONS {
        let Some([left, top, right, bottom]) = bounds(&camera, points, aspect) else {
            camera.zoom(0.5, [0.5, 0.5], aspect);
            continue;
        };
        let seen = [(right - left) * width, (bottom - top) * height].map(|x| x.max(1e-6));
        let free = free(seen, room);
        let [free_width, free_height] = [free[2] - free[0], free[3] - free[1]];
        let factor = (free_width / seen[0]).min(free_height / seen[1]);
        let middle = [0.5 * (left + right), 0.5 * (top + bottom)];
        camera.zoom(factor, middle, aspect);
        // Moves the centre of the points to the centre of the free rectangle.
        let wanted = [0.5 * (free[0] + free[2]) / width, 0.5 * (free[1] + free[3]) / height];
        camera.pan((wanted[0] - middle[0]) * aspect, wanted[1] - middle[1], aspect);
        if camera.is_flat() && round > 0 {
            break;
        }
    }
    (camera, camera.scale(aspect))
}

/// Returns left, top, right and bottom of points in the picture, 0..1; `None` if one is behind the eye.
fn bounds(camera: &Camera, points: &[[f64; 3]], aspect: f64) -> Option<[f64; 4]> {
    let seen: Option<Vec<[f64; 2]>> = points.iter().map(|point| camera.project(*point, aspect)).collect();
    let start = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
    let around = |[l, t, r, b]: [f64; 4], [x, y]: [f64; 2]| [l.min(x), t.min(y), r.max(x), b.max(y)];
    let found = seen?.into_iter().fold(start, around);
    found.iter().all(|x| x.is_finite()).then_some(found)
}

/// Returns the uncovered rectangle of the picture, px, in which content of the given width and height is largest.
fn free(seen: [f64; 2], room: &PictureArea) -> [f64; 4] {
    let [width, height] = room.size;
    // Small pictures have narrower margins.
    let margin = MARGIN_PX.min(0.06 * width.min(height));
    let whole = [margin, margin, width - margin, height - margin];
    let size = |[l, t, r, b]: [f64; 4]| ((r - l) / seen[0]).min((b - t) / seen[1]);
    let mut best = vec![whole];
    for [left, top, right, bottom] in &room.covered {
        let beside = |[l, t, r, b]: [f64; 4]| {
            if *left >= r || *right <= l || *top >= b || *bottom <= t {
                return vec![[l, t, r, b]];
            }
            vec![
                [l.max(right + margin), t, r, b],
                [l, t.max(bottom + margin), r, b],
                [l, t, r.min(left - margin), b],
                [l, t, r, b.min(top - margin)],
            ]
        };
        best = best.into_iter().flat_map(beside).collect();
    }
    let best = best.into_iter().max_by(|a, b| size(*a).total_cmp(&size(*b)));
    // Covering rectangles are ignored if they reduce the content to less than 0.3 times its size in the whole picture.
    best.filter(|free| size(*free) > 0.3 * size(whole)).unwrap_or(whole)
}
