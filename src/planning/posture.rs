//! What becomes of the freedoms that a point leaves to four drives and more while b is held.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | C | rows that are kept: ∂p/∂q, λ, and for the orientation the last link's own drive | m, 1 |
//! | M | what is kept small: ½ q′ᵀ M q′ | |
//! | T | motor torques are T q̈ from rest: A⁻ᵀ H | kg m² |
//! | x_i | relative angle a_i as a share of its range, −1 and 1 at its limits; 0 where it has none | 1 |
//!
//! # Method
//! Along a curve p(s) every choice gives rates by one linear system, M q′ + Cᵀ ν = 0 and C q′ = (p′, 0, 0): with M = 1 the
//! least rates, also of those that keep the last link's orientation; with M = TᵀT the rates that take the least motor
//! torques to set up (dynamically consistent on the set of poses of b, as T q̈ is all that the motors do there); and with
//! M the second derivatives of ½ Σ x_i² + ν·(p, b) the way of the pose that is nearest to the middle of all ranges, which
//! is sought at the start and put right at every node. The least torques would drive a light joint through its limits, so
//! there M grows without bound in the last tenth of each range at either end.

use nalgebra::{SMatrix, SVector};
use serde::{Deserialize, Serialize};

use crate::mechanics::machine::{Inertia, Machine};
use crate::mechanics::planar::{DriveAngles, MAX_DRIVES, PerDrive, Vector, unit};
use crate::planning::curves::path::{PathError, by_pieces};
use crate::planning::curves::{Curve, CurvePoint, PathPoint, PathTable};
use crate::planning::pose_space::PoseSpace;

/// How the freedoms that a point leaves are used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Posture {
    /// The drives turn as little as they can.
    #[default]
    LeastRates,
    /// The last link keeps its orientation.
    Orientation,
    /// The motors need the least torques.
    LeastTorque,
    /// All relative angles are as near to the middle of their ranges as can be.
    MidRange,
}

/// Rows of C: two of the point, b, and the last link's drive.
const ROWS: usize = 4;
/// Δq, and a multiplier for each row.
const SIZE: usize = MAX_DRIVES + ROWS;
/// Spaces between nodes along a curve, and steps in each.
const SPACES: usize = 256;
const STEPS: usize = 4;
/// How far off its curve the integration may come in a space, as a share of the reach.
const OFF_CURVE: f64 = 1e-6;
/// How far beside a place rates are looked at for their change, as a share of the curve.
const BESIDE: f64 = 1e-5;
/// Steps towards the middle of the ranges, and when they are done, rad.
const SETTLING: usize = 200;
const SETTLED: f64 = 1e-12;
/// From this share of its range on, either way, a joint turns less and less.
const BESIDE_LIMIT: f64 = 0.8;
/// A square of rows below this share of what they could be has lost rank.
const NO_RANK: f64 = 1e-14;

type Square = SMatrix<f64, SIZE, SIZE>;
type Side = SVector<f64, SIZE>;

/// A choice for one machine.
#[derive(Clone, Debug)]
pub struct Postures<'a> {
    space: &'a PoseSpace,
    posture: Posture,
    tip: PerDrive,
    /// The drive of the last link.
    hand: usize,
    /// TᵀT as a share of its trace.
    torque: [[f64; MAX_DRIVES]; MAX_DRIVES],
    /// ∂x_i/∂q_k.
    shares: Vec<PerDrive>,
}

impl<'a> Postures<'a> {
    /// Of a machine with its poses of a b.
    pub fn of(machine: &Machine, space: &'a PoseSpace, posture: Posture) -> Self {
        let n = machine.drives();
        let inertia = Inertia::of(machine);
        let one = |k: usize| PerDrive::from_fn(n, |l| f64::from(u8::from(k == l)));
        let asked: Vec<PerDrive> =
            (0..n).map(|l| inertia.motors().torques(&PerDrive::from_fn(n, |k| inertia.constant(k, l)))).collect();
        let trace: f64 = asked.iter().map(|column| column.dot(column)).sum();
        let mut torque = [[0.0; MAX_DRIVES]; MAX_DRIVES];
        for (k, row) in torque.iter_mut().enumerate().take(n) {
            (0..n).for_each(|l| row[l] = asked[k].dot(&asked[l]) / trace);
            // A drive that turns nothing costs nothing: a little keeps rates finite.
            row[k] += 1e-9;
        }
        let turned: Vec<PerDrive> = (0..n).map(|k| space.angle_rates(&one(k))).collect();
        let half = |i: usize| {
            let [low, high] = space.joints()[i].bounds();
            if low.is_finite() { 0.5 * (high - low).max(1e-6) } else { f64::INFINITY }
        };
        let shares = (0..space.joints().len()).map(|i| PerDrive::from_fn(n, |k| turned[k][i] / half(i))).collect();
        let tip = PerDrive::from_fn(n, |k| machine.end_effector()[k]);
        Self { space, posture, tip, hand: machine.resolved_links()[machine.end_link()].drive, torque, shares }
    }

    /// The inverse of what weighs rates by the torques that they take, TᵀT as a share of its trace.
    pub fn least_torque(&self) -> Option<[[f64; MAX_DRIVES]; MAX_DRIVES]> {
        let n = self.drives();
        let weigh = |k: usize, l: usize| if k < n && l < n { self.torque[k][l] } else { f64::from(u8::from(k == l)) };
        let inverse = SMatrix::<f64, MAX_DRIVES, MAX_DRIVES>::from_fn(weigh).try_inverse()?;
        let sound = inverse.iter().all(|x| x.is_finite());
        sound.then(|| {
            std::array::from_fn(|k| std::array::from_fn(|l| if k < n && l < n { inverse[(k, l)] } else { 0.0 }))
        })
    }

    /// ½ Σ x_i²: how far relative angles are from the middle of their ranges.
    pub fn off_middle(&self, q: &DriveAngles) -> f64 {
        self.x(q).iter().map(|x| 0.5 * x * x).sum()
    }

    fn x(&self, q: &DriveAngles) -> Vec<f64> {
        let (a, middle) = (self.space.angles(q), self.space.middle());
        let half = |i: usize| {
            let [low, high] = self.space.joints()[i].bounds();
            if low.is_finite() { 0.5 * (high - low).max(1e-6) } else { f64::INFINITY }
        };
        (0..a.len()).map(|i| (a[i] - middle[i]) / half(i)).collect()
    }

    fn drives(&self) -> usize {
        self.tip.len()
    }

    /// Whether the last row counts.
    fn keeps_hand(&self) -> bool {
        self.posture == Posture::Orientation
    }

    /// C, with all rows as long as the arms.
    fn rows(&self, q: &DriveAngles) -> SMatrix<f64, ROWS, MAX_DRIVES> {
        let (n, reach) = (self.drives(), self.space.farthest());
        let scale = reach / self.space.lambda().max_abs();
        let mut rows = SMatrix::<f64, ROWS, MAX_DRIVES>::zeros();
        for k in 0..n {
            let column = Vector::new(0.0, self.tip[k]) * unit(q[k]);
            (rows[(0, k)], rows[(1, k)], rows[(2, k)]) = (column.re, column.im, scale * self.space.lambda()[k]);
        }
        if self.keeps_hand() {
            rows[(3, self.hand)] = reach;
        }
        rows
    }

    /// M q + Cᵀ ν = gradient, C q = wanted.
    fn solved(
        &self,
        q: &DriveAngles,
        weights: impl Fn(usize, usize) -> f64,
        gradient: &PerDrive,
        wanted: [f64; ROWS],
    ) -> Option<PerDrive> {
        let n = self.drives();
        let rows = self.rows(q);
        let mut gram = rows * rows.transpose();
        if !self.keeps_hand() {
            gram[(3, 3)] = self.space.farthest().powi(2);
        }
        if gram.determinant() <= NO_RANK * (0.25 * gram.trace()).powi(4) {
            return None;
        }
        let mut square = Square::identity();
        let mut side = Side::zeros();
        for k in 0..n {
            (0..n).for_each(|l| square[(k, l)] = weights(k, l));
            side[k] = gradient[k];
        }
        for i in 0..if self.keeps_hand() { ROWS } else { ROWS - 1 } {
            let at = MAX_DRIVES + i;
            square[(at, at)] = 0.0;
            side[at] = wanted[i];
            (0..n).for_each(|k| (square[(at, k)], square[(k, at)]) = (rows[(i, k)], rows[(i, k)]));
        }
        let x = square.lu().solve(&side)?;
        x.iter().all(|x| x.is_finite()).then(|| PerDrive::from_fn(n, |k| x[k]))
    }

    /// What the choice weighs rates by.
    fn weight(&self, q: &DriveAngles) -> impl Fn(usize, usize) -> f64 + use<'_, 'a> {
        let own = |k: usize, l: usize| f64::from(u8::from(k == l));
        // ½ Σ x² on C(q) = const bends by the multipliers of p: ∇ = Cᵀ ν, by least squares.
        let bend = (self.posture == Posture::MidRange).then(|| {
            let rows = self.rows(q);
            let gram = (rows * rows.transpose()).fixed_view::<3, 3>(0, 0).into_owned();
            let gradient = self.gradient(q);
            let side = rows.fixed_rows::<3>(0)
                * SVector::<f64, MAX_DRIVES>::from_fn(|k, _| gradient.get(k).copied().unwrap_or(0.0));
            let nu = gram.try_inverse().map_or(SVector::<f64, 3>::zeros(), |inverse| inverse * side);
            // Second derivatives of p are −c_k e_k.
            PerDrive::from_fn(self.drives(), |k| {
                let arm = self.tip[k] * unit(q[k]);
                nu[0] * arm.re + nu[1] * arm.im
            })
        });
        let slowed: Vec<f64> =
            if self.posture == Posture::LeastTorque { self.x(q).iter().map(near_limit).collect() } else { Vec::new() };
        let slowed = move |k: usize, l: usize| -> f64 {
            self.shares.iter().zip(&slowed).map(|(share, slowed)| slowed * share[k] * share[l]).sum()
        };
        move |k: usize, l: usize| match self.posture {
            Posture::LeastRates | Posture::Orientation => own(k, l),
            Posture::LeastTorque => self.torque[k][l] + slowed(k, l),
            Posture::MidRange => self.ranges(k, l) + bend.map_or(0.0, |bend| bend[k]) * own(k, l),
        }
    }

    /// ∂²/∂q_k∂q_l of ½ Σ x².
    fn ranges(&self, k: usize, l: usize) -> f64 {
        self.shares.iter().map(|share| share[k] * share[l]).sum()
    }

    fn gradient(&self, q: &DriveAngles) -> PerDrive {
        let x = self.x(q);
        PerDrive::from_fn(self.drives(), |k| self.shares.iter().zip(&x).map(|(share, x)| share[k] * x).sum())
    }

    /// Rates that move the end effector at v, m/s or m a unit of s, with b held.
    pub fn rates(&self, q: &DriveAngles, v: Vector) -> Option<PerDrive> {
        self.solved(q, self.weight(q), &PerDrive::zeros(self.drives()), [v.re, v.im, 0.0, 0.0])
    }

    /// The pose beside another one that the choice takes for the same point and b: nearest to the middle of the ranges.
    pub fn settled(&self, q: DriveAngles, p: Vector, b: f64) -> Option<DriveAngles> {
        let mut q = q;
        if self.posture != Posture::MidRange {
            return Some(q);
        }
        for _ in 0..SETTLING {
            let step = self.settling(&q, p, b, |k, l| self.ranges(k, l) + if k == l { 1e-3 } else { 0.0 })?;
            let size = step.max_abs();
            q = DriveAngles(q.0.plus((0.2 / size).min(1.0), &step));
            if size < SETTLED {
                break;
            }
        }
        Some(q)
    }

    fn settling(&self, q: &DriveAngles, p: Vector, b: f64, weights: impl Fn(usize, usize) -> f64) -> Option<PerDrive> {
        let off = p - self.space.place(q);
        let scale = self.space.farthest() / self.space.lambda().max_abs();
        let down = match self.posture {
            Posture::MidRange => self.gradient(q).scaled(-1.0),
            _ => PerDrive::zeros(self.drives()),
        };
        self.solved(q, weights, &down, [off.re, off.im, scale * (b - self.space.b(q)), 0.0])
    }

    /// Rates and their change along a curve, where its velocity and acceleration are these.
    fn along(&self, q: &DriveAngles, way: &CurvePoint) -> Option<(PerDrive, PerDrive)> {
        let first = self.rates(q, way.first)?;
        let beside = |s: f64| self.rates(&DriveAngles(q.0.plus(s, &first)), way.first + s * way.second);
        let near = beside(BESIDE)?.minus(&beside(-BESIDE)?).scaled(0.5 / BESIDE);
        // What is known of it exactly: p″ = J q″ − Σ c e q′², λ q″ = 0.
        let pull: Vector = (0..self.drives()).map(|k| self.tip[k] * first[k] * first[k] * unit(q[k])).sum();
        let turned: Vector = (0..self.drives()).map(|k| Vector::new(0.0, self.tip[k] * near[k]) * unit(q[k])).sum();
        let left = way.second + pull - turned;
        let scale = self.space.farthest() / self.space.lambda().max_abs();
        let wanted =
            [left.re, left.im, -scale * self.space.lambda().dot(&near), -self.space.farthest() * near[self.hand]];
        let own = |k: usize, l: usize| f64::from(u8::from(k == l));
        let put_right = self.solved(q, own, &PerDrive::zeros(self.drives()), wanted)?;
        Some((first, near.plus(1.0, &put_right)))
    }

    /// A path along a curve of the end effector from a pose at its start.
    ///
    /// # Errors
    /// If the rows lose rank on the way.
    pub fn path(&self, start: DriveAngles, curve: &Curve) -> Result<PathTable, PathError> {
        let piece = |q: DriveAngles, [from, to]: [f64; 2], at: &dyn Fn(f64) -> CurvePoint, spaces: usize| {
            self.nodes(q, at, spaces).map_err(|s| PathError::Singular { s: from + s * (to - from) })
        };
        by_pieces(curve, start, SPACES, piece)?.ok_or(PathError::Singular { s: 0.0 })
    }

    /// Nodes of a path, or the s at which the rows lose rank.
    fn nodes(
        &self,
        start: DriveAngles,
        curve: &dyn Fn(f64) -> CurvePoint,
        spaces: usize,
    ) -> Result<Vec<PathPoint>, f64> {
        let off_curve = OFF_CURVE * self.space.farthest();
        let (b, hand) = (self.space.b(&start), start[self.hand]);
        let h = 1.0 / (spaces * STEPS) as f64;
        let mut q = start;
        let mut nodes = Vec::with_capacity(spaces + 1);
        for i in 0..=spaces {
            let s = i as f64 / spaces as f64;
            let way = curve(s);
            let gap = way.p - self.space.place(&q);
            if gap.is_nan() || gap.norm() > off_curve {
                return Err(s);
            }
            let back = self.settling(&q, way.p, b, self.weight(&q)).ok_or(s)?;
            q = DriveAngles(q.0.plus(1.0, &back));
            if self.keeps_hand() {
                q.0[self.hand] = hand;
            }
            let (first, second) = self.along(&q, &way).ok_or(s)?;
            nodes.push(PathPoint { q, first, second });
            if i == spaces {
                break;
            }
            for j in 0..STEPS {
                let s = (i * STEPS + j) as f64 * h;
                let slope = |q: &PerDrive, s: f64| self.rates(&DriveAngles(*q), curve(s).first).ok_or(s);
                let k1 = slope(&q.0, s)?;
                let k2 = slope(&q.0.plus(h / 2.0, &k1), s + h / 2.0)?;
                let k3 = slope(&q.0.plus(h / 2.0, &k2), s + h / 2.0)?;
                let k4 = slope(&q.0.plus(h, &k3), s + h)?;
                q = DriveAngles(q.0.plus(h / 6.0, &k1).plus(h / 3.0, &k2).plus(h / 3.0, &k3).plus(h / 6.0, &k4));
            }
        }
        Ok(nodes)
    }
}

/// What the share of a range weighs beside a limit.
fn near_limit(x: &f64) -> f64 {
    let past = (x.abs() - BESIDE_LIMIT).max(0.0);
    (past / (1.0 - x.abs()).max(1e-6)).powi(3)
}
