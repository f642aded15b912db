//! [`Layers`]: poses at stations along a path, spread over all that can be reached from its start.
//!
//! # Method
//! The first layer begins with the poses from which every piece of the set of poses is reached. A layer is filled along
//! the free directions until every pose has others about it; then each pose is taken along to the next station, within
//! the limits. What no pose reaches so, no path from the start does.

use super::rows::{left_free, lifted};
use super::stations::Stations;
use crate::mechanics::planar::{DriveAngles, MAX_DRIVES, PerDrive, Vector};
use crate::planning::pose_space::PoseSpace;

/// How finely is looked.
#[derive(Clone, Copy, Debug)]
pub(super) struct Detail {
    /// Layers along the whole path, about.
    pub layers: usize,
    /// How far poses of a layer are apart, rad, and how many there are at most.
    pub apart: f64,
    pub most: usize,
}

/// Poses of one station.
#[derive(Clone, Debug)]
pub(super) struct Layer {
    /// The station.
    pub at: usize,
    /// Relative angles, rad.
    pub angles: Vec<PerDrive>,
    /// The same as drive angles, rad.
    pub poses: Vec<PerDrive>,
    /// Where each one goes in the next layer, if it can.
    pub next: Vec<Option<PerDrive>>,
}

/// All layers of a path.
#[derive(Clone, Debug)]
pub(super) struct Layers<'a> {
    pub space: &'a PoseSpace,
    pub b: f64,
    pub all: Vec<Layer>,
    pub apart: f64,
}

/// Poses nearer to another than this share of the distance are left out.
const THINNING_SHARE: f64 = 0.5;
/// Fewer poses than this that can be taken along are few.
pub(super) const FEW_POSES: usize = 8;
/// Directions that keep less than this share of the reach depend on each other.
const NO_RANK: f64 = 1e-9;
/// How far beyond its window an angle without limits is filled, rad.
const FILLED_BEYOND: f64 = std::f64::consts::PI;

impl<'a> Layers<'a> {
    /// Of poses at b, rad, within the limits.
    ///
    /// # Errors
    /// The station that no path reaches.
    pub fn of(
        (space, b): (&'a PoseSpace, f64),
        stations: &Stations,
        starts: &[PerDrive],
        detail: Detail,
    ) -> Result<Self, usize> {
        let windows = bounds(space);
        let mut all = Vec::new();
        let ats = chosen(stations, detail.layers);
        let mut angles = starts.to_vec();
        for (i, at) in ats.iter().enumerate() {
            let p = stations.places[*at];
            let angles_here = filled((space, p, b), std::mem::take(&mut angles), &windows, detail);
            if angles_here.is_empty() {
                return Err(*at);
            }
            let mut next: Vec<Option<PerDrive>> = match ats.get(i + 1) {
                Some(to) => angles_here
                    .iter()
                    .map(|a| taken((space, b), a, &stations.places[*at..=*to], &windows, detail.apart))
                    .collect(),
                None => vec![None; angles_here.len()],
            };
            angles.extend(next.iter().flatten());
            // Where few poses are left, steps along the path miss them: they are found from where they end.
            if let Some(to) = ats.get(i + 1)
                && angles.len() < FEW_POSES
            {
                let all = space.sheets(stations.places[*to], b);
                for (a, next) in angles_here.iter().zip(&mut next).filter(|(_, next)| next.is_none()) {
                    *next = nearest(&all, a, 2.0 * detail.apart);
                    angles.extend(*next);
                }
            }
            let poses = angles_here.iter().map(|a| lifted(space, a, b)).collect();
            all.push(Layer { at: *at, angles: angles_here, poses, next });
        }
        Ok(Self { space, b, all, apart: detail.apart })
    }
}

/// Where each relative angle may be, rad.
pub(super) fn bounds(space: &PoseSpace) -> [[f64; 2]; MAX_DRIVES] {
    std::array::from_fn(|i| space.joints().get(i).map_or([0.0; 2], |joint| joint.bounds()))
}

/// Stations of layers: both ends of every leg, and others between.
fn chosen(stations: &Stations, layers: usize) -> Vec<usize> {
    let mut all = vec![0];
    for leg in &stations.legs {
        let spaces = leg.s.len() - 1;
        let own = ((layers as f64 * leg.share).ceil() as usize).clamp(6, spaces.max(6)).min(spaces);
        all.extend((1..=own).map(|i| leg.first + i * spaces / own));
    }
    all.dedup();
    all
}

/// A pose taken along, in as few steps as keep it beside itself.
fn taken(
    (space, b): (&PoseSpace, f64),
    a: &PerDrive,
    places: &[Vector],
    windows: &[[f64; 2]; MAX_DRIVES],
    apart: f64,
) -> Option<PerDrive> {
    let last = places.len() - 1;
    let there = space.solved(places[last], b, a, windows);
    if let Some(there) = there.filter(|there| there.minus(a).max_abs() <= apart) {
        return Some(there);
    }
    let mut a = *a;
    for p in &places[1..] {
        a = space.solved(*p, b, &a, windows).filter(|next| next.minus(&a).max_abs() <= 2.0 * apart)?;
    }
    Some(a)
}

/// The nearest of some poses, if it is no farther than this, rad.
pub(super) fn nearest(all: &[PerDrive], a: &PerDrive, most: f64) -> Option<PerDrive> {
    let far = |other: &PerDrive| other.minus(a).max_abs();
    all.iter().copied().min_by(|x, y| far(x).total_cmp(&far(y))).filter(|other| far(other) <= most)
}

/// Orthonormal directions of the relative angles that move neither the end effector nor b.
fn free_directions(space: &PoseSpace, q: &PerDrive) -> Vec<PerDrive> {
    let n = space.joints().len();
    let (_, columns) = space.columns(&DriveAngles(*q));
    let rows = [PerDrive::from_fn(n, |i| columns[i].re), PerDrive::from_fn(n, |i| columns[i].im)];
    let mut across: Vec<PerDrive> = Vec::with_capacity(n);
    for row in rows {
        let left = across.iter().fold(row, |left, u| left.plus(-left.dot(u), u));
        let length = left.dot(&left).sqrt();
        if length > NO_RANK * space.farthest() {
            across.push(left.scaled(1.0 / length));
        }
    }
    left_free(&across, n)
}

/// Whether relative angles are less than a distance apart, its square given.
pub(super) fn near(a: &PerDrive, b: &PerDrive, square: f64) -> bool {
    let (a, b) = (a.padded(), b.padded());
    let (mut sum, mut k) = (0.0, 0);
    while k < MAX_DRIVES && sum <= square {
        sum += (a[k] - b[k]) * (a[k] - b[k]);
        k += 1;
    }
    sum <= square
}

/// Poses and what lies between and about them, thinned.
fn filled(
    (space, p, b): (&PoseSpace, Vector, f64),
    starts: Vec<PerDrive>,
    windows: &[[f64; 2]; MAX_DRIVES],
    detail: Detail,
) -> Vec<PerDrive> {
    let thin = THINNING_SHARE * detail.apart;
    let mut poses: Vec<PerDrive> = Vec::new();
    let is_new = |poses: &[PerDrive], a: &PerDrive| !poses.iter().any(|other| near(other, a, thin * thin));
    for a in starts {
        if poses.len() < detail.most && is_new(&poses, &a) {
            poses.push(a);
        }
    }
    let room: [[f64; 2]; MAX_DRIVES] = std::array::from_fn(|i| match space.joints().get(i) {
        Some(joint) if windows[i][0].is_infinite() => {
            [joint.limits()[0] - FILLED_BEYOND, joint.limits()[1] + FILLED_BEYOND]
        }
        Some(_) => windows[i],
        None => [0.0; 2],
    });
    let mut i = 0;
    let mut seed = 1u64;
    while i < poses.len() && poses.len() < detail.most {
        let a = poses[i];
        i += 1;
        let free = free_directions(space, &lifted(space, &a, b));
        let mut ways: Vec<PerDrive> = free.clone();
        if free.len() > 1 {
            // Between the axes, too.
            for _ in 0..free.len() {
                let mixed = free.iter().fold(PerDrive::zeros(a.len()), |sum, z| sum.plus(noise(&mut seed), z));
                let size = mixed.dot(&mixed).sqrt();
                ways.extend((size > 0.1).then(|| mixed.scaled(1.0 / size)));
            }
        }
        for way in ways.iter().flat_map(|way| [*way, way.scaled(-1.0)]) {
            let beside = PerDrive::from_fn(a.len(), |k| {
                let there = a[k] + detail.apart * way[k];
                there.clamp(room[k][0].min(a[k]), room[k][1].max(a[k]))
            });
            let Some(there) = space.solved(p, b, &beside, windows) else { continue };
            if there.minus(&a).max_abs() <= 2.0 * detail.apart && poses.len() < detail.most && is_new(&poses, &there) {
                poses.push(there);
            }
        }
    }
    poses
}

/// A number from −1 to 1 of a sequence that is the same every time.
fn noise(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}
