//! [`Stations`]: points along the curves of a task at which poses are computed.

use crate::curves::{Curve, CurvePoint};
use crate::timing::{Profile, TimeLaw};
use stillbase_mechanics::planar::Vector;

/// Minimum number of intervals of a curve, as a fraction of the number for the whole path.
const MIN_CURVE_SHARE: f64 = 1.0 / 3.0;
/// Minimum number of intervals of each piece of a curve, as a fraction of the number for the whole path.
const MIN_PIECE_SHARE: f64 = 1.0 / 16.0;
/// A curve with more ends of pieces than this needs only one interval per piece.
const MANY_JOINTS: usize = 100;
/// Points and weights of Gaussian quadrature on an interval of length 1.
pub(super) const GAUSS_NODES: [[f64; 2]; 3] =
    [[0.112_701_665_379_258_3, 5.0 / 18.0], [0.5, 4.0 / 9.0], [0.887_298_334_620_741_7, 5.0 / 18.0]];

/// A curve from rest to rest.
#[derive(Clone, Debug)]
pub(super) struct PathLeg {
    /// Index of its first station among all; its last one is the first of the next leg.
    pub first: usize,
    /// s of each station, from 0 at the start of this curve to 1 at its end.
    pub s: Vec<f64>,
    /// Point of the curve at each station, with its derivatives with respect to this s.
    pub points: Vec<CurvePoint>,
    /// Midpoints between the stations, where the path is checked as well: s and the point of the curve, m.
    pub between: Vec<(f64, Vector)>,
    /// Its length as a fraction of the total.
    pub share: f64,
    /// Its time law over a duration of `share`.
    pub profile: Profile,
}

impl PathLeg {
    /// Returns the index of its last station among all.
    pub fn last(&self) -> usize {
        self.first + self.s.len() - 1
    }

    /// Returns quadrature points over time: index of the interval, s, ṡ, s̈ and the weight in time.
    pub fn instants(&self) -> Vec<(usize, [f64; 4])> {
        let ends: Vec<f64> = self.s.iter().map(|s| self.profile.time_at(*s)).collect();
        let last = ends.len() - 2;
        let each = |i: usize| {
            let from = if i == 0 { 0.0 } else { ends[i] };
            let to = if i == last { self.profile.duration() } else { ends[i + 1] };
            GAUSS_NODES.map(|[share, weight]| {
                let now = self.profile.at(from + share * (to - from));
                (i, [now.s, now.rate, now.acceleration, weight * (to - from)])
            })
        };
        (0..=last).flat_map(each).collect()
    }
}

/// All stations of curves, one after another.
#[derive(Clone, Debug)]
pub(super) struct Stations {
    pub legs: Vec<PathLeg>,
    /// Position of the end effector at each station, m.
    pub places: Vec<Vector>,
}

impl Stations {
    /// Puts stations on curves with about `spaces` intervals in total. Each curve is passed from rest to rest by `law`,
    /// by the quintic if `law` is a fastest one, or at constant rate ṡ if there is none.
    pub fn of(curves: &[Curve], law: Option<TimeLaw>, spaces: usize) -> Self {
        let shares = shares(curves);
        let grid = |(curve, share): (&Curve, &f64)| {
            let own = (spaces as f64 * share.max(MIN_CURVE_SHARE)).ceil();
            let joints: Vec<f64> = curve.joints().collect();
            let min_count = if joints.len() > MANY_JOINTS { 1 } else { (MIN_PIECE_SHARE * spaces as f64) as usize };
            let mut s: Vec<f64> = Vec::new();
            for ends in joints.windows(2) {
                let run = ends[1] - ends[0];
                let count = ((own * run).ceil() as usize).max(min_count);
                s.extend((0..count).map(|i| ends[0] + run * i as f64 / count as f64));
            }
            s.push(1.0);
            s
        };
        Self::at(curves, law, curves.iter().zip(&shares).map(grid).collect())
    }

    /// Returns stations with marked intervals divided in four and their neighbours in two. `marked` has one flag per
    /// leg and interval.
    pub fn parted(&self, curves: &[Curve], law: Option<TimeLaw>, marked: &[Vec<bool>]) -> Self {
        let grid = |(leg, marked): (&PathLeg, &Vec<bool>)| {
            let is_marked = |i: usize| marked.get(i).copied().unwrap_or(false);
            let parts = |i: usize| match () {
                () if is_marked(i) => 4,
                () if is_marked(i + 1) || (i > 0 && is_marked(i - 1)) => 2,
                () => 1,
            };
            let spaces = leg.s.windows(2).enumerate();
            let places = spaces.flat_map(|(i, w)| {
                let count = parts(i);
                (0..count).map(move |k| w[0] + (w[1] - w[0]) * k as f64 / count as f64)
            });
            places.chain([1.0]).collect()
        };
        Self::at(curves, law, self.legs.iter().zip(marked).map(grid).collect())
    }

    fn at(curves: &[Curve], law: Option<TimeLaw>, grids: Vec<Vec<f64>>) -> Self {
        let mut legs: Vec<PathLeg> = Vec::with_capacity(curves.len());
        let mut places: Vec<Vector> = Vec::new();
        for ((curve, share), s) in curves.iter().zip(shares(curves)).zip(grids) {
            let points: Vec<CurvePoint> = s.iter().map(|s| curve.at(*s)).collect();
            let between = s.windows(2).map(|w| 0.5 * (w[0] + w[1])).map(|s| (s, curve.at(s).p)).collect();
            let first = places.len().saturating_sub(1);
            places.extend(points.iter().skip(usize::from(!places.is_empty())).map(|point| point.p));
            let profile = match law {
                Some(law) => Profile::of(if law.is_fastest() { TimeLaw::Quintic } else { law }, share),
                None => Profile::running(share),
            };
            legs.push(PathLeg { first, s, points, between, share, profile });
        }
        Self { legs, places }
    }

    /// Returns the fraction of the whole length up to a station.
    pub fn done(&self, station: usize) -> f64 {
        let part = |leg: &PathLeg| match station {
            i if i >= leg.last() => leg.share,
            i if i > leg.first => leg.share * leg.s[i - leg.first],
            _ => 0.0,
        };
        self.legs.iter().map(part).sum()
    }
}

/// Returns the length of each curve as a fraction of the total.
fn shares(curves: &[Curve]) -> Vec<f64> {
    let total: f64 = curves.iter().map(Curve::length).sum();
    let share = |curve: &Curve| if total > 0.0 { curve.length() / total } else { 1.0 / curves.len() as f64 };
    curves.iter().map(share).collect()
}

/// Returns finite-difference weights of the values at up to five places, for the value and the first three derivatives
/// at `at` (Fornberg 1988).
pub(super) fn weights(places: &[f64], at: f64) -> [[f64; 5]; 4] {
    let mut w = [[0.0; 5]; 4];
    let mut c1 = 1.0;
    let mut c4 = places[0] - at;
    w[0][0] = 1.0;
    for i in 1..places.len() {
        let order = i.min(3);
        let (mut c2, c5) = (1.0, c4);
        c4 = places[i] - at;
        for j in 0..i {
            let c3 = places[i] - places[j];
            c2 *= c3;
            if j == i - 1 {
                for k in (1..=order).rev() {
                    w[k][i] = c1 * (k as f64 * w[k - 1][i - 1] - c5 * w[k][i - 1]) / c2;
                }
                w[0][i] = -c1 * c5 * w[0][i - 1] / c2;
            }
            for k in (1..=order).rev() {
                w[k][j] = (c4 * w[k][j] - k as f64 * w[k - 1][j]) / c3;
            }
            w[0][j] = c4 * w[0][j] / c3;
        }
        c1 = c2;
    }
    w
}
