//! Closed motions of the drives that turn a free base by a wanted angle, the shortest of their kind.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | A | θ̇ = A q̇ at zero momentum, [`TurnForm`](super::momentum::TurnForm) | |
//! | θ(x), θ* | turn of the base around the loop with coefficients x, ∮ A dq; the wanted one | rad |
//! | E | ∫ \|q′\|² ds, the square of the length of a loop that is run through evenly | rad² |
//! | μ | multiplier: E changes by μ per change of θ* | rad |
//!
//! # Method
//! A loop is a spline of degree 5 from the start and back. min E(x) subject to θ(x) = θ* and the limits of the relative
//! angles is solved by sequential quadratic programming. Second derivatives are differences of exact first ones. The turn
//! that is missing costs a penalty, and a line search bounds each step. The search starts from circles in the plane where small loops turn the base most, and in
//! the planes of two drives. The shortest loop found is returned: other minima may exist.
//!
//! # Source
//! A small loop turns the base by the curl of A in its plane times its area. So the shortest has E = 4π |θ*|/β, with β the
//! largest curl in a plane: a circle.

use std::f64::consts::{PI, TAU};

use nalgebra::{DMatrix, DVector};
use thiserror::Error;

use super::loop_spline::{INNER, Station, gram, interpolated, stations, table};
use super::momentum::{MomentumModel, TurnForm};
use crate::curves::table::PathTable;
use stillbase_convex::{LinearRow, Program};
use stillbase_mechanics::machine::{Inertia, RelativeAngle};
use stillbase_mechanics::planar::{DriveAngles, MAX_DRIVES, PerDrive};
use stillbase_settings::number::significant;

/// A closed motion of the drives.
#[derive(Clone, Debug, PartialEq)]
pub struct TurningLoop {
    /// The loop, run through evenly up to the error of the spline.
    pub path: PathTable,
    /// Its length in drive angles, rad.
    pub length: f64,
    /// By how much it turns the base, rad.
    pub turn: f64,
}

/// Why no loop turns the base by the wanted angle.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum NoLoop {
    /// The base is not free.
    #[error("the base is held: want base.kind = free")]
    Held,
    /// One drive can only retrace its way.
    #[error("one drive retraces its way, which turns the base back: want two drives or more")]
    OneDrive,
    /// The momentum that the rate of a drive brings is the same in every pose.
    #[error(
        "no closed motion turns the base of a balanced arm: its mass matrix is constant, so the base turns back as the arm \
         returns; want an arm that is not balanced, or a motion that ends in another pose"
    )]
    Balanced,
    /// Small loops do not turn the base in any plane.
    #[error("no closed motion of this arm turns its base: how far the base turns depends on the pose alone")]
    Flat,
    /// The loops found within the limits turn the base by less.
    #[error("no loop was found that turns the base by more than {}°", significant(turn.to_degrees()))]
    Short {
        /// The largest turn in the wanted sense, rad.
        turn: f64,
    },
}

impl NoLoop {
    /// Returns why an arm turns no base, wherever it starts; `None` if some loop of it may.
    pub fn of(arm: &Inertia) -> Option<Self> {
        if arm.drives < 2 {
            return Some(Self::OneDrive);
        }
        // Without couplings and first moments, neither D nor I depends on the pose, so A = −D/I has no curl.
        arm.is_balanced().then_some(Self::Balanced)
    }
}

/// Number of directions of the circles in a plane.
const DIRECTIONS: usize = 8;
/// Number of circles from which the search starts.
const MAX_STARTS: usize = 8;
/// Number of intervals of a circle, and the number of radii that are tried up to the largest, rad.
const CIRCLE: (usize, usize, f64) = (96, 48, PI);
/// Number of quadratic programs from each circle, and of those that follow from the best.
const FIRST_ROUNDS: usize = 8;
const MAX_ROUNDS: usize = 100;
/// Number of loops of the wanted turn that are found before the shortest of them is taken.
const MAX_WHOLE: usize = 2;
/// Maximum number of times that a step is halved.
const MAX_HALVINGS: i32 = 30;
/// A search ends when a step is below this fraction of the loop.
const STEP_TOLERANCE: f64 = 1e-9;
/// Largest difference between turn and wanted turn, rad.
const TURN_TOLERANCE: f64 = 1e-12;
/// A loop that lacks more of the wanted turn than this fraction does not reach it.
const SHORT_SHARE: f64 = 1e-6;
/// Loops keep this distance from the limits, rad.
const MARGIN: f64 = 1e-7;
/// Curls below this count as zero, 1/rad.
const MIN_CURL: f64 = 1e-9;
/// Cost of the turn that a quadratic program leaves missing, as a multiple of what it would cost to bring it.
const SLACK_COST: f64 = 1e2;
/// Number of parts of a piece of the spline in the quadrature of the search, and in that of the turn that is told.
const PARTS: usize = 2;
const FINE_PARTS: usize = 12;
/// Step of the differences of ∂A/∂q, rad.
const DIFFERENCE: f64 = 1e-5;

/// Turn of the base around a loop with its derivatives by the coefficients.
struct Turn {
    value: f64,
    gradient: DVector<f64>,
    hessian: DMatrix<f64>,
}

/// A search from one loop.
#[derive(Default)]
struct Descent {
    x: DVector<f64>,
    /// Cost of missing turn in the merit, rad.
    penalty: f64,
    /// μ of the last round.
    multiplier: Option<f64>,
    has_ended: bool,
}

/// The problem.
struct Search<'a> {
    model: &'a MomentumModel,
    start: DriveAngles,
    wanted: f64,
    stations: Vec<Station>,
    /// Places of a finer quadrature, for the turn that is told.
    fine: Vec<Station>,
    /// Half the second derivatives of E.
    gram: DMatrix<f64>,
    /// Its inverse.
    softness: DMatrix<f64>,
    /// Drives of a relative angle, and the least and greatest change of the angle from the start, rad.
    limits: Vec<(usize, usize, [f64; 2])>,
}

impl TurningLoop {
    /// Finds the shortest loop from a pose of the drives that turns the base by `wanted`, rad, which is not 0. The pose is
    /// seen from the base, and the loop keeps the limits of the relative angles.
    ///
    /// # Errors
    /// If there is none, or none was found.
    pub fn shortest(
        model: &MomentumModel,
        angles: &[RelativeAngle],
        start: &DriveAngles,
        wanted: f64,
    ) -> Result<Self, NoLoop> {
        let search = Search::new(model, angles, start, wanted)?;
        if search.is_flat() {
            return Err(NoLoop::Flat);
        }
        let begun = |x: DVector<f64>| Descent { x: search.within_limits(x), ..Descent::default() };
        let mut descents: Vec<Descent> = search.circles().into_iter().map(begun).collect();
        descents.iter_mut().for_each(|descent| search.descend(descent, FIRST_ROUNDS));
        descents.sort_by(|a, b| search.foreseen(a).total_cmp(&search.foreseen(b)));
        let (mut best, mut most, mut whole): (Option<(f64, DVector<f64>)>, f64, usize) = (None, 0.0, 0);
        for mut descent in descents {
            if whole == MAX_WHOLE {
                break;
            }
            search.descend(&mut descent, MAX_ROUNDS);
            let (x, turn) = search.completed(descent.x);
            most = most.max(turn * wanted.signum());
            let length = search.length(&x);
            if (turn - wanted).abs() <= TURN_TOLERANCE.max(1e-12 * wanted.abs()) {
                whole += 1;
                if best.as_ref().is_none_or(|(least, _)| length < *least) {
                    best = Some((length, x));
                }
            }
        }
        let short = NoLoop::Short { turn: most };
        let (length, x) = best.ok_or(short)?;
        let path = table(start, x.as_slice()).ok_or(short)?;
        Ok(Self { path, length, turn: search.turn_by(&x, &search.fine) })
    }
}

impl<'a> Search<'a> {
    fn new(
        model: &'a MomentumModel,
        angles: &[RelativeAngle],
        start: &DriveAngles,
        wanted: f64,
    ) -> Result<Self, NoLoop> {
        let n = model.drives();
        if !model.floats() {
            return Err(NoLoop::Held);
        }
        if let Some(why) = NoLoop::of(model.arm()) {
            return Err(why);
        }
        let (stations, fine) = (stations(PARTS), stations(FINE_PARTS));
        let small = gram(&stations);
        let gram = small.kronecker(&DMatrix::identity(n, n));
        // The splines are independent, so E is positive definite.
        let softness = gram.clone().try_inverse().ok_or(NoLoop::Flat)?;
        let limited = angles.iter().filter(|angle| angle.limits.start().is_finite() || angle.limits.end().is_finite());
        let room = |angle: &RelativeAngle| {
            let at = angle.value(start);
            [(angle.limits.start() + MARGIN - at).min(0.0), (angle.limits.end() - MARGIN - at).max(0.0)]
        };
        let limits = limited.map(|angle| (angle.to, angle.from, room(angle))).collect();
        Ok(Self { model, start: *start, wanted, stations, fine, gram, softness, limits })
    }

    fn drives(&self) -> usize {
        self.start.len()
    }

    /// Returns the turn around a loop, rad.
    fn turn(&self, x: &DVector<f64>) -> f64 {
        self.turn_by(x, &self.stations)
    }

    /// Returns the turn around a loop by a quadrature, rad.
    fn turn_by(&self, x: &DVector<f64>, stations: &[Station]) -> f64 {
        let at = |station: &Station| {
            let p = station.point(&self.start, x.as_slice());
            station.weight * self.slope(&p.q, &p.first)
        };
        stations.iter().map(at).sum()
    }

    /// Returns by how much the base turns per change of the drives at a pose.
    fn slope(&self, q: &DriveAngles, change: &PerDrive) -> f64 {
        self.model.turn_coefficients(&q.units()).map_or(0.0, |turn| turn.dot(change))
    }

    /// Returns the length of a loop, rad.
    fn length(&self, x: &DVector<f64>) -> f64 {
        let at = |station: &Station| {
            let rate = station.point(&self.start, x.as_slice()).first;
            station.weight * rate.dot(&rate).sqrt()
        };
        self.stations.iter().map(at).sum()
    }

    fn turn_with_derivatives(&self, x: &DVector<f64>) -> Turn {
        let n = self.drives();
        let (mut value, mut gradient) = (0.0, DVector::zeros(x.len()));
        let mut hessian = DMatrix::zeros(x.len(), x.len());
        for station in &self.stations {
            let p = station.point(&self.start, x.as_slice());
            let Some(form) = self.model.turn_form(&p.q) else { continue };
            let (a, slopes) = (form.coefficients, form.slopes);
            let moved = |m: usize, by: f64| {
                let alone = PerDrive::from_fn(n, |k| f64::from(k == m));
                self.model.turn_form(&DriveAngles(p.q.0.plus(by, &alone))).unwrap_or(form)
            };
            // ∂²(A q′)/∂q_m ∂q_l at fixed q′.
            let mut bends = [[0.0; MAX_DRIVES]; MAX_DRIVES];
            for (m, bends) in bends.iter_mut().enumerate().take(n) {
                let (after, before) = (moved(m, DIFFERENCE), moved(m, -DIFFERENCE));
                for (l, bend) in bends.iter_mut().enumerate().take(n) {
                    let side = |side: &TurnForm| side.slopes[l].dot(&p.first);
                    *bend = (side(&after) - side(&before)) / (2.0 * DIFFERENCE);
                }
            }
            value += station.weight * a.dot(&p.first);
            for (i, u) in station.splines() {
                for m in 0..n {
                    gradient[i * n + m] += station.weight * (u[0] * slopes[m].dot(&p.first) + u[1] * a[m]);
                }
                for (j, v) in station.splines() {
                    for m in 0..n {
                        for l in 0..n {
                            let both = u[0] * v[0] * 0.5 * (bends[m][l] + bends[l][m]);
                            let mixed = u[0] * v[1] * slopes[m][l] + u[1] * v[0] * slopes[l][m];
                            hessian[(i * n + m, j * n + l)] += station.weight * (both + mixed);
                        }
                    }
                }
            }
        }
        Turn { value, gradient, hessian }
    }

    /// Returns whether small loops turn the base in no plane, at poses around the start.
    fn is_flat(&self) -> bool {
        let n = self.drives();
        let pose = |i: usize| DriveAngles(self.start.0.plus(1.0, &PerDrive::from_fn(n, |k| (i * (2 * k + 1)) as f64)));
        let turns = |form: TurnForm| Inertia::pairs(n).any(|(k, l)| form.curl(k, l).abs() > MIN_CURL);
        !(0..8).any(|i| self.model.turn_form(&pose(i)).is_some_and(turns))
    }

    /// Returns coefficients of circles through the start from which to search, the smallest ones first.
    fn circles(&self) -> Vec<DVector<f64>> {
        let n = self.drives();
        let mut circles: Vec<(f64, f64, DVector<f64>)> = Vec::new();
        for [u, v] in self.planes() {
            for direction in 0..DIRECTIONS {
                let (sin, cos) = (TAU * direction as f64 / DIRECTIONS as f64).sin_cos();
                let (out, aside) = (u.scaled(cos).plus(sin, &v), u.scaled(-sin).plus(cos, &v));
                let place = |r: f64, s: f64| {
                    let (sin, cos) = (TAU * s).sin_cos();
                    out.scaled(r * (1.0 - cos)).plus(r * sin, &aside)
                };
                let Some((radius, missing)) = self.radius(&place) else { continue };
                let sense = if radius < 0.0 { -1.0 } else { 1.0 };
                let x = interpolated(n, |s| place(radius.abs(), sense * s));
                circles.extend(x.map(|x| (missing, radius.abs(), DVector::from_vec(x))));
            }
        }
        circles.sort_by(|a, b| (a.0, a.1).partial_cmp(&(b.0, b.1)).unwrap_or(std::cmp::Ordering::Equal));
        circles.truncate(MAX_STARTS);
        circles.into_iter().map(|(.., x)| x).collect()
    }

    /// Returns the planes of the circles, each by two orthonormal directions.
    fn planes(&self) -> Vec<[PerDrive; 2]> {
        let n = self.drives();
        let axis = |m: usize| PerDrive::from_fn(n, |k| f64::from(k == m));
        let mut planes: Vec<_> = Inertia::pairs(n).map(|(k, l)| [axis(k), axis(l)]).collect();
        let form = self.model.turn_form(&self.start);
        let curl = DMatrix::from_fn(n, n, |m, l| form.map_or(0.0, |form| form.curl(m, l)));
        // The two largest singular values of an antisymmetric matrix are equal: their vectors span the plane.
        let svd = curl.svd(true, false);
        if let (Some(u), true) = (svd.u, n > 2) {
            let column = |j: usize| PerDrive::from_fn(n, |k| u[(k, j)]);
            planes.insert(0, [column(0), column(1)]);
        }
        planes
    }

    /// Returns the smallest radius, rad, of a circle that turns the base as wanted, negative if it is run through the other
    /// way; and how much of the turn is missing, rad, if none does. `None` if no circle turns the base that way.
    fn radius(&self, place: &impl Fn(f64, f64) -> PerDrive) -> Option<(f64, f64)> {
        let (intervals, radii, largest) = CIRCLE;
        let turn = |r: f64| {
            let at = |i: usize| place(r, (i as f64 % intervals as f64) / intervals as f64);
            let chord = |i: usize| {
                let (from, to) = (at(i), at(i + 1));
                let middle = DriveAngles(self.start.0.plus(0.5, &from).plus(0.5, &to));
                self.slope(&middle, &to.minus(&from))
            };
            (0..intervals).map(chord).sum::<f64>() / self.wanted
        };
        let (mut last, mut most) = ((0.0, 0.0), (0.0, 0.0_f64));
        for i in 1..=radii {
            let r = largest * i as f64 / radii as f64;
            let now = turn(r);
            if now.abs() >= 1.0 {
                // The turn grows with the square of the radius at first.
                let share = ((1.0 - last.1) / (now.abs() - last.1)).clamp(0.0, 1.0);
                let found = (last.0 * last.0 + share * (r * r - last.0 * last.0)).sqrt();
                return Some((found.copysign(now), 0.0));
            }
            if now.abs() > most.1.abs() {
                most = (r, now);
            }
            last = (r, now.abs());
        }
        let least = MIN_CURL * PI * largest * largest / self.wanted.abs();
        (most.1.abs() > least).then(|| (most.0.copysign(most.1), (1.0 - most.1.abs()) * self.wanted.abs()))
    }

    /// Goes on with a descent for a number of rounds, or to its end.
    fn descend(&self, descent: &mut Descent, rounds: usize) {
        for _ in 0..rounds {
            if descent.has_ended {
                return;
            }
            descent.has_ended = self.round(descent).is_none();
        }
    }

    /// Makes one round of a descent; `None` if it leads no farther.
    fn round(&self, descent: &mut Descent) -> Option<()> {
        let x = &descent.x;
        let turn = self.turn_with_derivatives(x);
        let slope = &self.gram * x * 2.0;
        let soft = &self.softness * &turn.gradient;
        let stiffness = turn.gradient.dot(&soft);
        if stiffness <= 0.0 {
            return None;
        }
        let estimate = descent.multiplier.unwrap_or(turn.gradient.dot(x) * 2.0 / stiffness);
        let (step, rise, multiplier) = self.step(x, &turn, &slope, estimate)?;
        // Then the merit falls at first along the step.
        let missing = (turn.value - self.wanted).abs();
        let penalty = descent.penalty.max(1.5 * multiplier.abs()).max(2.0 * rise / missing.max(TURN_TOLERANCE));
        let merit = |x: &DVector<f64>| self.energy(x) + penalty * (self.turn(x) - self.wanted).abs();
        let before = self.energy(x) + penalty * missing;
        let next = (0..MAX_HALVINGS).find_map(|halvings| {
            let plain = x + &step * 0.5_f64.powi(halvings);
            // A full step leaves the wanted turn in second order, which one step of Newton's method mends.
            let missing = self.wanted - self.turn(&plain);
            let mended = &plain + &soft * (missing / stiffness);
            let mended = Some(mended).filter(|x| self.keeps_limits(x));
            mended.into_iter().chain([plain]).find(|x| merit(x) < before)
        })?;
        let moved = (&next - x).norm();
        descent.has_ended = moved <= STEP_TOLERANCE * next.norm();
        (descent.penalty, descent.multiplier) = (penalty, Some(multiplier));
        descent.x = next;
        (!descent.has_ended).then_some(())
    }

    fn energy(&self, x: &DVector<f64>) -> f64 {
        x.dot(&(&self.gram * x))
    }

    /// Returns E of a descent, with what the missing turn would add.
    fn foreseen(&self, descent: &Descent) -> f64 {
        let missing = (self.turn(&descent.x) - self.wanted).abs();
        self.energy(&descent.x) + descent.multiplier.map_or(0.0, f64::abs) * missing
    }

    /// Returns a loop with the last of the wanted turn, unless too much is missing, and its turn, rad.
    fn completed(&self, mut x: DVector<f64>) -> (DVector<f64>, f64) {
        let mut turn = self.turn_by(&x, &self.fine);
        for _ in 0..4 {
            let missing = self.wanted - turn;
            if missing.abs() <= 0.1 * TURN_TOLERANCE || missing.abs() > SHORT_SHARE * self.wanted.abs() {
                break;
            }
            // Loops at a limit grow elsewhere: the whole loop becomes larger, as far as its own turn allows.
            let gradient = self.turn_with_derivatives(&x).gradient;
            let soft = &self.softness * &gradient;
            let grown = &x + &soft * (missing / gradient.dot(&soft));
            x = if self.keeps_limits(&grown) { grown } else { &x * (1.0 + missing / gradient.dot(&x)) };
            turn = self.turn_by(&x, &self.fine);
        }
        (x, turn)
    }

    /// Returns the coefficients, of two drives, whose difference is at a limit.
    fn touched(&self, x: &DVector<f64>) -> Vec<(usize, usize)> {
        let n = self.drives();
        let all = self
            .limits
            .iter()
            .flat_map(|(to, from, bounds)| (0..INNER).map(move |i| (i * n + to, i * n + from, bounds)));
        let at = all.filter(|(to, from, bounds)| bounds.iter().any(|bound| (x[*to] - x[*from] - bound).abs() < MARGIN));
        at.map(|(to, from, _)| (to, from)).collect()
    }

    fn keeps_limits(&self, x: &DVector<f64>) -> bool {
        let n = self.drives();
        self.limits.iter().all(|(to, from, [low, high])| {
            (0..INNER).all(|i| {
                let change = x[i * n + to] - x[i * n + from];
                change >= low - 0.5 * MARGIN && change <= high + 0.5 * MARGIN
            })
        })
    }

    /// Returns the nearest loop within the limits, by E of the difference.
    fn within_limits(&self, x: DVector<f64>) -> DVector<f64> {
        if self.keeps_limits(&x) {
            return x;
        }
        let mut program = Program::over(x.len());
        add_square(&mut program, &self.gram, 1.0);
        self.limit_steps(&mut program, &x);
        program.solve().map_or(x.clone(), |found| x + DVector::from_vec(found.x))
    }

    /// Returns the second derivatives of E − μ θ, made positive definite: by a multiple of the square of θ's gradient, across
    /// limits that the loop touches, and by as much of E as it takes. Also returns that multiple.
    fn convex(&self, x: &DVector<f64>, turn: &Turn, multiplier: f64) -> (DMatrix<f64>, f64) {
        let mut curved = &self.gram * 2.0 - &turn.hessian * multiplier;
        let size = curved.norm();
        let factor = size / turn.gradient.norm_squared();
        for (i, j) in self.touched(x) {
            curved[(i, i)] += size;
            curved[(j, j)] += size;
            curved[(i, j)] -= size;
            curved[(j, i)] -= size;
        }
        let along = &turn.gradient * turn.gradient.transpose() * factor;
        let mut more = 0.0;
        loop {
            let all = &curved + &along + &self.gram * more;
            if more > 1e3 || all.clone().cholesky().is_some() {
                return (all, factor);
            }
            more = if more == 0.0 { 1e-3 } else { 4.0 * more };
        }
    }

    /// Bounds the steps from a loop so that its control points keep the limits, and with them the loop.
    fn limit_steps(&self, program: &mut Program, x: &DVector<f64>) {
        let n = self.drives();
        for (to, from, [low, high]) in &self.limits {
            for i in 0..INNER {
                let (to, from) = (i * n + to, i * n + from);
                let now = x[to] - x[from];
                if high.is_finite() {
                    program.at_most.push(LinearRow::new([(to, 1.0), (from, -1.0)], high - now));
                }
                if low.is_finite() {
                    program.at_most.push(LinearRow::new([(to, -1.0), (from, 1.0)], now - low));
                }
            }
        }
    }

    /// Solves the quadratic program of a round. Returns the step, by how much it raises E, and the multiplier.
    fn step(
        &self,
        x: &DVector<f64>,
        turn: &Turn,
        slope: &DVector<f64>,
        multiplier: f64,
    ) -> Option<(DVector<f64>, f64, f64)> {
        let count = x.len();
        let (curvature, factor) = self.convex(x, turn, multiplier);
        // The square is that of the turn still missing, so that it does not hold steps back that bring it.
        let augmented = slope - &turn.gradient * (factor * (self.wanted - turn.value));
        let scale = 1.0 / self.energy(x).max(f64::MIN_POSITIVE);
        // The last two unknowns are the turn that is missing or too much, as fractions of the wanted one.
        let mut program = Program::over(count + 2);
        for i in 0..count {
            program.linear[i] = augmented[i] * scale;
        }
        add_square(&mut program, &curvature, 0.5 * scale);
        let wanted = self.wanted.abs();
        for slack in [count, count + 1] {
            program.linear[slack] = SLACK_COST * (multiplier.abs() * wanted * scale).max(1.0);
            program.at_most.push(LinearRow::new([(slack, -1.0)], 0.0));
        }
        let mut row: Vec<(usize, f64)> = (0..count).map(|i| (i, turn.gradient[i] / wanted)).collect();
        row.extend([(count, 1.0), (count + 1, -1.0)]);
        program.equal.push(LinearRow::new(row, (self.wanted - turn.value) / wanted));
        self.limit_steps(&mut program, x);
        let found = program.solve().ok()?;
        let step = DVector::from_iterator(count, found.x.into_iter().take(count));
        let rise = slope.dot(&step) + self.energy(&step);
        Some((step, rise, -found.multipliers.first()? / (wanted * scale)))
    }
}

/// Adds factor · xᵀ M x to the objective of a program, with M symmetric.
fn add_square(program: &mut Program, matrix: &DMatrix<f64>, factor: f64) {
    for i in 0..matrix.nrows() {
        for j in i..matrix.nrows() {
            program.add_product(i, j, if i == j { factor } else { 2.0 * factor } * matrix[(i, j)]);
        }
    }
}
