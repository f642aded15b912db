//! [`Layers`]: samples, at stations along a path, of poses that can be reached from the start of the path.
//!
//! # Method
//! The first layer begins with at least one pose on each connected component that is found. A layer is filled
//! along the null space until it covers its components. Then each pose is continued to the next station within limits.
//! If no pose reaches a station in this way, the station is treated as unreachable.

use super::rows::{lifted, null_directions};
use super::stations::Stations;
use crate::pose_space::PoseSpace;
use stillbase_mechanics::planar::{DriveAngles, MAX_DRIVES, PerDrive, Vector};

/// Resolution of the search.
#[derive(Clone, Copy, Debug)]
pub(super) struct Detail {
    /// Approximate number of layers along the whole path.
    pub layers: usize,
    /// Distance between neighbouring poses of a layer, rad.
    pub spacing: f64,
    /// Maximum number of poses of a layer.
    pub max_poses: usize,
}

/// Poses of one station.
#[derive(Clone, Debug)]
pub(super) struct Layer {
    /// Index of the station.
    pub at: usize,
    /// Relative angles, rad.
    pub angles: Vec<PerDrive>,
    /// The poses as drive angles, rad.
    pub poses: Vec<PerDrive>,
    /// Each pose continued to the next layer, if that is possible.
    pub next: Vec<Option<PerDrive>>,
}

/// All layers of a path.
#[derive(Clone, Debug)]
pub(super) struct Layers<'a> {
    pub space: &'a PoseSpace,
    pub b: f64,
    pub all: Vec<Layer>,
    pub spacing: f64,
}

/// A pose nearer to another than this fraction of [`Detail::spacing`] is omitted.
const THINNING_SHARE: f64 = 0.5;
/// If fewer poses than this reach a station, all its poses are computed, to replace failed continuations.
pub(super) const FEW_POSES: usize = 8;
/// Rank tolerance: rows shorter than this fraction of the reach after orthogonalisation are treated as dependent.
const RANK_TOLERANCE: f64 = 1e-9;
/// Distance beyond [−π, π] up to which an angle without limits is sampled, rad.
const FILLED_BEYOND_RAD: f64 = std::f64::consts::PI;

impl<'a> Layers<'a> {
    /// Builds the layers at b, rad, within the limits, from the relative angles of the start poses.
    ///
    /// # Errors
    /// The index of the station that no pose reaches.
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
            let angles_here = filled(space, p, b, std::mem::take(&mut angles), &windows, detail);
            if angles_here.is_empty() {
                return Err(*at);
            }
            let mut next: Vec<Option<PerDrive>> = match ats.get(i + 1) {
                Some(to) => angles_here
                    .iter()
                    .map(|a| continued(space, b, a, &stations.places[*at..=*to], &windows, detail.spacing))
                    .collect(),
                None => vec![None; angles_here.len()],
            };
            angles.extend(next.iter().flatten());
            // With few poses, continuation may fail: take the nearest of all poses of the next station.
            if let Some(to) = ats.get(i + 1)
                && angles.len() < FEW_POSES
            {
                let all = space.representative_poses(stations.places[*to], b);
                for (a, next) in angles_here.iter().zip(&mut next).filter(|(_, next)| next.is_none()) {
                    *next = nearest(&all, a, 2.0 * detail.spacing);
                    angles.extend(*next);
                }
            }
            let poses = angles_here.iter().map(|a| lifted(space, a, b)).collect();
            all.push(Layer { at: *at, angles: angles_here, poses, next });
        }
        Ok(Self { space, b, all, spacing: detail.spacing })
    }
}

/// Returns the bounds of each relative angle, rad.
pub(super) fn bounds(space: &PoseSpace) -> [[f64; 2]; MAX_DRIVES] {
    std::array::from_fn(|i| space.joints().get(i).map_or([0.0; 2], |joint| joint.bounds()))
}

/// Chooses the stations of layers: both ends of every leg, and others between.
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

/// Continues a pose along places, in one step if that keeps it close, else place by place. Returns `None` if it jumps.
fn continued(
    space: &PoseSpace,
    b: f64,
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

/// Returns the nearest of some poses if it is no farther than `max_distance`, rad.
pub(super) fn nearest(all: &[PerDrive], a: &PerDrive, max_distance: f64) -> Option<PerDrive> {
    let far = |other: &PerDrive| other.minus(a).max_abs();
    all.iter().copied().min_by(|x, y| far(x).total_cmp(&far(y))).filter(|other| far(other) <= max_distance)
}

/// Returns orthonormal directions of the relative angles that move neither the end effector nor b.
fn free_directions(space: &PoseSpace, q: &PerDrive) -> Vec<PerDrive> {
    let n = space.joints().len();
    let (_, columns) = space.columns(&DriveAngles(*q));
    let rows = [PerDrive::from_fn(n, |i| columns[i].re), PerDrive::from_fn(n, |i| columns[i].im)];
    let mut across: Vec<PerDrive> = Vec::with_capacity(n);
    for row in rows {
        let rest = across.iter().fold(row, |rest, u| rest.plus(-rest.dot(u), u));
        let length = rest.dot(&rest).sqrt();
        if length > RANK_TOLERANCE * space.farthest() {
            across.push(rest.scaled(1.0 / length));
        }
    }
    null_directions(&across, n)
}

/// Returns whether the squared distance of relative angles is at most `square`, rad².
pub(super) fn near(a: &PerDrive, b: &PerDrive, square: f64) -> bool {
    let (a, b) = (a.padded(), b.padded());
    let (mut sum, mut k) = (0.0, 0);
    while k < MAX_DRIVES && sum <= square {
        sum += (a[k] - b[k]) * (a[k] - b[k]);
        k += 1;
    }
    sum <= square
}

/// Extends the start poses of a point along the null space, with a minimum distance between poses.
fn filled(
    space: &PoseSpace,
    p: Vector,
    b: f64,
    starts: Vec<PerDrive>,
    windows: &[[f64; 2]; MAX_DRIVES],
    detail: Detail,
) -> Vec<PerDrive> {
    let thin = THINNING_SHARE * detail.spacing;
    let mut poses: Vec<PerDrive> = Vec::new();
    let is_new = |poses: &[PerDrive], a: &PerDrive| !poses.iter().any(|other| near(other, a, thin * thin));
    for a in starts {
        if poses.len() < detail.max_poses && is_new(&poses, &a) {
            poses.push(a);
        }
    }
    let room: [[f64; 2]; MAX_DRIVES] = std::array::from_fn(|i| match space.joints().get(i) {
        Some(joint) if windows[i][0].is_infinite() => {
            [joint.limits()[0] - FILLED_BEYOND_RAD, joint.limits()[1] + FILLED_BEYOND_RAD]
        }
        Some(_) => windows[i],
        None => [0.0; 2],
    });
    let mut i = 0;
    let mut seed = 1u64;
    while i < poses.len() && poses.len() < detail.max_poses {
        let a = poses[i];
        i += 1;
        let free = free_directions(space, &lifted(space, &a, b));
        let mut ways: Vec<PerDrive> = free.clone();
        if free.len() > 1 {
            // Add random directions between those of the basis.
            for _ in 0..free.len() {
                let mixed = free.iter().fold(PerDrive::zeros(a.len()), |sum, z| sum.plus(noise(&mut seed), z));
                let size = mixed.dot(&mixed).sqrt();
                ways.extend((size > 0.1).then(|| mixed.scaled(1.0 / size)));
            }
        }
        for way in ways.iter().flat_map(|way| [*way, way.scaled(-1.0)]) {
            let beside = PerDrive::from_fn(a.len(), |k| {
                let there = a[k] + detail.spacing * way[k];
                there.clamp(room[k][0].min(a[k]), room[k][1].max(a[k]))
            });
            let Some(there) = space.solved(p, b, &beside, windows) else { continue };
            if there.minus(&a).max_abs() <= 2.0 * detail.spacing
                && poses.len() < detail.max_poses
                && is_new(&poses, &there)
            {
                poses.push(there);
            }
        }
    }
    poses
}

/// Returns the next pseudo-random number from −1 to 1 of a reproducible sequence.
fn noise(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}
