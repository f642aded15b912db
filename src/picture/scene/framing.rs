//! Where a camera has to stand so that everything is seen and nothing that lies over the picture covers it.

use super::camera::Camera;

/// The picture, px, and what lies over it.
#[derive(Clone, Debug, PartialEq)]
pub struct Room {
    /// Width and height.
    pub size: [f64; 2],
    /// Left, top, right and bottom of what covers a part of it.
    pub covered: Vec<[f64; 4]>,
}

/// What is to be seen, m.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Content {
    /// What is seen in any case.
    pub first: Vec<[f64; 3]>,
    /// What is seen too where that costs little.
    pub then: Vec<[f64; 3]>,
}

/// Kept free around everything, px: names stand beside points.
const MARGIN: f64 = 26.0;
/// The share of its size that the first may lose to what comes then.
const LOSS: f64 = 0.15;
/// In perspective what is nearer grows by more than what is farther: found in so many rounds.
const ROUNDS: usize = 12;

impl Content {
    /// The camera in the same direction that sees it.
    pub fn framed(&self, camera: Camera, room: &Room) -> Camera {
        let (alone, scale) = framed(camera, &self.first, room);
        if self.then.is_empty() {
            return alone;
        }
        let (both, smaller) = framed(camera, &[self.first.as_slice(), &self.then].concat(), room);
        if smaller > (1.0 - LOSS) * scale { both } else { alone }
    }
}

/// The same of points, and how large they are seen.
fn framed(mut camera: Camera, points: &[[f64; 3]], room: &Room) -> (Camera, f64) {
    let [width, height] = room.size.map(|x| x.max(1.0));
    let aspect = width / height;
    for round in 0..ROUNDS {
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
        // From where the middle is now to the middle of what is free.
        let wanted = [0.5 * (free[0] + free[2]) / width, 0.5 * (free[1] + free[3]) / height];
        camera.pan((wanted[0] - middle[0]) * aspect, wanted[1] - middle[1], aspect);
        if camera.is_flat() && round > 0 {
            break;
        }
    }
    (camera, camera.scale(aspect))
}

/// Left, top, right and bottom of points in the picture, 0..1; none if one is behind the eye.
fn bounds(camera: &Camera, points: &[[f64; 3]], aspect: f64) -> Option<[f64; 4]> {
    let seen: Option<Vec<[f64; 2]>> = points.iter().map(|point| camera.project(*point, aspect)).collect();
    let start = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
    let around = |[l, t, r, b]: [f64; 4], [x, y]: [f64; 2]| [l.min(x), t.min(y), r.max(x), b.max(y)];
    let found = seen?.into_iter().fold(start, around);
    found.iter().all(|x| x.is_finite()).then_some(found)
}

/// The part of the picture, px, in which something of these proportions is seen largest beside all that lies over it.
fn free(seen: [f64; 2], room: &Room) -> [f64; 4] {
    let [width, height] = room.size;
    // A small picture has no room for wide margins.
    let margin = MARGIN.min(0.06 * width.min(height));
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
    // What covers nearly everything is not avoided.
    best.filter(|free| size(*free) > 0.3 * size(whole)).unwrap_or(whole)
}
