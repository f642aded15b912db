//! [`Ensemble`]: random machines around a nominal one on one motion, a million per second.
//!
//! With perfect tracking of the motion, the wrench is linear in the constants θ of the machine. The factors that depend
//! on the motion are tabulated once; each machine then requires only its θ and one sum per instant. Several machines
//! are evaluated side by side, so that a vector instruction processes one value of each.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | t_s | instants (s + ½) T / S, over which means are taken (midpoint rule), and both ends, for peaks | s |
//! | δθ | θ of a machine less θ of the nominal one | kg m; kg m² |
//! | φ_i(t) | n_B(t) of a machine with θ_i = 1 and all other constants 0 | N m per unit of θ_i |
//! | ψ_i(t) | dynamic f_B(t) of that machine | N per unit of θ_i |
//! | n_B(t) | n_B(t) of the nominal machine + Σ φ_i δθ_i | N m |
//!
//! n_B includes the moment of the weight. f_B is the dynamic part only, without the constant weight M g.

use std::borrow::Cow;
use std::collections::BTreeMap;

use nalgebra::DVector;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Serialize;

use super::ToleranceError;
use super::constants::{self, BLOCK_MACHINES, Lanes, LinkConstants, count, evaluate, unit};
use super::deviate::{CHUNK, RandomStream};
use super::moments::Moments;
use super::parameter::{UncertainParameter, parameters};
use stillbase_mechanics::dynamics::{ExternalLoads, base_wrench};
use stillbase_mechanics::machine::{Inertia, Machine, MachineError};
use stillbase_mechanics::planar::{MAX_DRIVES, Vector};
use stillbase_planning::{Motion, Reference};
use stillbase_session::scenario::Spread;

/// Reactions of one machine on the motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[serde(into = "StatedOutcome")]
pub struct SampleOutcome {
    /// Largest |n_B|, N m.
    pub peak_moment: f64,
    /// Largest dynamic |f_B|, N.
    pub peak_force: f64,
    /// Root mean square of n_B over time, N m.
    pub rms_moment: f64,
    /// Root mean square of the dynamic |f_B| over time, N.
    pub rms_force: f64,
}

impl SampleOutcome {
    /// How many numbers an outcome has.
    pub const NUMBERS: usize = 4;

    /// Name of each number, as in answers.
    pub const NAMES: [&str; Self::NUMBERS] =
        ["peak_base_moment", "peak_base_force", "rms_base_moment", "rms_base_force"];

    /// Returns the numbers, N m and N, in the order of their names.
    pub fn numbers(&self) -> [f64; Self::NUMBERS] {
        [self.peak_moment, self.peak_force, self.rms_moment, self.rms_force]
    }

    /// Returns the outcome of numbers, in the order of their names.
    pub fn of_numbers([peak_moment, peak_force, rms_moment, rms_force]: [f64; Self::NUMBERS]) -> Self {
        Self { peak_moment, peak_force, rms_moment, rms_force }
    }
}

/// How an outcome is serialised: its four numbers, and each once more under an older name that version 0.3 drops.
#[derive(JsonSchema, Serialize)]
struct StatedOutcome {
    peak_base_moment: f64,
    peak_base_force: f64,
    rms_base_moment: f64,
    rms_base_force: f64,
    peak_moment: f64,
    peak_force: f64,
    rms_moment: f64,
    rms_force: f64,
}

impl From<SampleOutcome> for StatedOutcome {
    fn from(SampleOutcome { peak_moment, peak_force, rms_moment, rms_force }: SampleOutcome) -> Self {
        Self {
            peak_base_moment: peak_moment,
            peak_base_force: peak_force,
            rms_base_moment: rms_moment,
            rms_base_force: rms_force,
            peak_moment,
            peak_force,
            rms_moment,
            rms_force,
        }
    }
}

impl JsonSchema for SampleOutcome {
    fn schema_name() -> Cow<'static, str> {
        StatedOutcome::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        StatedOutcome::json_schema(generator)
    }
}

/// Random machines around a nominal one, and a motion that all of them track perfectly.
#[derive(Clone, Debug)]
pub struct Ensemble {
    machine: Machine,
    parameters: Vec<UncertainParameter>,
    bodies: Vec<LinkConstants>,
    seed: u64,
    references: Vec<Reference>,
    time: Vec<f64>,
    /// n_B and f_B of the nominal machine, by instant.
    nominal: Vec<(f64, Vector)>,
    /// φ and ψ, by constant, then by instant.
    influence: Vec<Vec<(f64, Vector)>>,
    moments: Moments,
    table: MotionTable,
}

/// Data for evaluating a machine at each instant, packed.
#[derive(Clone, Debug)]
struct MotionTable {
    /// Constants that n_B depends on, and those that f_B depends on.
    moment: Vec<usize>,
    force: Vec<usize>,
    /// For each instant: n_B, f_Bx, f_By of the nominal machine, then all φ, then ψ_x and ψ_y alternating.
    rows: Vec<f64>,
    /// Nominal θ of the bodies that vary, which is subtracted to give δθ.
    offset: Vec<f64>,
}

impl Ensemble {
    /// Builds the ensemble around `machine` that `seed` determines. The motion is evaluated at the midpoints of
    /// `instants` intervals, at least one. Both ends are added, because the weight may load the base most there.
    ///
    /// # Errors
    /// Fails if nothing varies, a key or spread is wrong, or a length cannot vary alone.
    pub fn new(
        machine: &Machine,
        motion: &Motion,
        instants: usize,
        spreads: &BTreeMap<String, Spread>,
        seed: u64,
    ) -> Result<Self, ToleranceError> {
        machine.check_all_turn("tolerances").map_err(ToleranceError::Machine)?;
        let (n, parameters, instants) = (machine.drives(), parameters(machine, spreads)?, instants.max(1));
        let bodies = constants::bodies(machine, &parameters).map_err(ToleranceError::Machine)?;
        let moments = Moments::of(n, &bodies, &parameters);
        let step = motion.duration() / instants as f64;
        let middles = (0..instants).map(|s| (s as f64 + 0.5) * step);
        let time: Vec<f64> = [0.0].into_iter().chain(middles).chain([motion.duration()]).collect();
        let references: Vec<Reference> = time.iter().map(|t| motion.at(*t)).collect();
        let (inertia, around) = (Inertia::of(machine), surroundings(machine));
        let wrenches = |inertia: &Inertia| references.iter().map(|r| wrench(inertia, r, &around)).collect::<Vec<_>>();
        let nominal = wrenches(&inertia);
        let influence: Vec<_> = (0..count(n)).map(|i| wrenches(&unit(n, i, &inertia))).collect();
        let table = MotionTable::of(n, parameters.len(), &bodies, &nominal, &influence, &moments.varies);
        let machine = machine.clone();
        Ok(Self { machine, parameters, bodies, seed, references, time, nominal, influence, moments, table })
    }

    /// Returns the parameters that vary.
    pub fn parameters(&self) -> &[UncertainParameter] {
        &self.parameters
    }

    /// Returns the nominal machine.
    pub fn machine(&self) -> &Machine {
        &self.machine
    }

    /// Returns the seed of the random machines.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// Returns the instants, s.
    pub fn time(&self) -> &[f64] {
        &self.time
    }

    /// Returns the indices of the instants over which means are taken: all but both ends.
    pub fn between(&self) -> std::ops::Range<usize> {
        1..self.time.len() - 1
    }

    /// Returns the motion at the instants.
    pub fn references(&self) -> &[Reference] {
        &self.references
    }

    /// Returns n_B, N m, and dynamic f_B, N, of the nominal machine at the instants.
    pub fn nominal(&self) -> &[(f64, Vector)] {
        &self.nominal
    }

    /// Returns the outcome of the nominal machine.
    pub fn nominal_outcome(&self) -> SampleOutcome {
        let between = &self.nominal[self.between()];
        let peak = |f: fn(&(f64, Vector)) -> f64| self.nominal.iter().map(f).fold(0.0, f64::max);
        let rms = |f: fn(&(f64, Vector)) -> f64| (between.iter().map(f).sum::<f64>() / between.len() as f64).sqrt();
        SampleOutcome {
            peak_moment: peak(|w| w.0.abs()),
            peak_force: peak(|w| w.1.norm()),
            rms_moment: rms(|w| w.0 * w.0),
            rms_force: rms(|w| w.1.norm_sqr()),
        }
    }

    /// Returns the machine with given deviations, in the order of the parameters.
    ///
    /// # Errors
    /// Fails if the machine is not valid, which does not occur for drawn deviations.
    pub fn machine_of(&self, deviations: &[f64]) -> Result<Machine, MachineError> {
        let mut spec = self.machine.spec().clone();
        for (parameter, deviation) in self.parameters.iter().zip(deviations) {
            parameter.set(&mut spec, parameter.nominal + deviation);
        }
        Machine::new(spec)
    }

    /// Returns a sampler, which draws and evaluates machines; use one for each thread.
    pub fn sampler(&self) -> Sampler<'_> {
        Sampler {
            ensemble: self,
            draws: RandomStream::new(self.seed),
            deviations: vec![[0.0; CHUNK]; self.parameters.len()],
            theta: vec![[0.0; BLOCK_MACHINES]; count(self.machine.drives())],
            outcomes: [SampleOutcome::default(); CHUNK],
        }
    }

    /// Returns the exact mean of n_B and of f_B over all machines, at an instant.
    pub(super) fn mean_at(&self, s: usize) -> (f64, Vector) {
        self.applied(s, &self.moments.mean)
    }

    /// Returns n_B and f_B of the nominal machine with constants changed by δθ.
    fn applied(&self, s: usize, change: &DVector<f64>) -> (f64, Vector) {
        let sum = |(n, f): (f64, Vector), (i, x): (usize, &f64)| {
            let (phi, psi) = self.influence[i][s];
            (n + phi * x, f + psi * *x)
        };
        change.iter().enumerate().fold(self.nominal[s], sum)
    }

    /// Returns the exact variance of n_B, f_Bx and f_By over all machines, at an instant.
    pub(super) fn variance_at(&self, s: usize) -> [f64; 3] {
        let rows = self.rows_at(s);
        rows.map(|row| (&self.moments.covariance * &row).dot(&row).max(0.0))
    }

    /// Returns ∂n_B/∂δ, ∂f_Bx/∂δ, ∂f_By/∂δ at an instant, each by parameter.
    pub(super) fn slopes_at(&self, s: usize) -> [DVector<f64>; 3] {
        self.rows_at(s).map(|row| self.moments.slope.tr_mul(&row))
    }

    fn rows_at(&self, s: usize) -> [DVector<f64>; 3] {
        let pick = |f: fn(&(f64, Vector)) -> f64| {
            DVector::from_iterator(self.influence.len(), self.influence.iter().map(|i| f(&i[s])))
        };
        [pick(|w| w.0), pick(|w| w.1.re), pick(|w| w.1.im)]
    }
}

fn surroundings(machine: &Machine) -> ExternalLoads {
    ExternalLoads { gravity: machine.gravity(), force: Vector::default() }
}

fn wrench(inertia: &Inertia, r: &Reference, around: &ExternalLoads) -> (f64, Vector) {
    let wrench = base_wrench(inertia, &r.q.units(), &r.qd, &r.qdd, around);
    (wrench.total().moment, wrench.dynamic.force)
}

impl MotionTable {
    fn of(
        n: usize,
        parameters: usize,
        bodies: &[LinkConstants],
        nominal: &[(f64, Vector)],
        influence: &[Vec<(f64, Vector)>],
        varies: &[bool],
    ) -> Self {
        let used = |counts: fn(&(f64, Vector)) -> bool| {
            (0..influence.len()).filter(|&i| varies[i] && influence[i].iter().any(counts)).collect::<Vec<_>>()
        };
        let (moment, force) = (used(|w| w.0 != 0.0), used(|w| w.1 != Vector::default()));
        let mut rows = Vec::with_capacity(nominal.len() * (3 + moment.len() + 2 * force.len()));
        for (s, (n, f)) in nominal.iter().enumerate() {
            rows.extend([*n, f.re, f.im]);
            rows.extend(moment.iter().map(|&i| influence[i][s].0));
            rows.extend(force.iter().flat_map(|&i| [influence[i][s].1.re, influence[i][s].1.im]));
        }
        let mut theta = vec![[0.0; BLOCK_MACHINES]; influence.len()];
        evaluate(n, bodies, &vec![[0.0; CHUNK]; parameters], 0, &mut theta);
        Self { moment, force, rows, offset: theta.iter().map(|t| t[0]).collect() }
    }

    fn width(&self) -> usize {
        3 + self.moment.len() + 2 * self.force.len()
    }
}

/// Draws and evaluates machines, one chunk at a time.
#[derive(Clone, Debug)]
pub struct Sampler<'a> {
    ensemble: &'a Ensemble,
    draws: RandomStream,
    /// Deviations, by parameter.
    deviations: Vec<[f64; CHUNK]>,
    theta: Vec<Lanes>,
    outcomes: [SampleOutcome; CHUNK],
}

impl Sampler<'_> {
    /// Draws the machines of a chunk: samples from `chunk` · [`CHUNK`] on.
    pub fn draw(&mut self, chunk: u64) {
        for (parameter, deviations) in self.ensemble.parameters.iter().zip(&mut self.deviations) {
            self.draws.uniform(parameter.stream, chunk, deviations);
            parameter.deviate(deviations);
        }
    }

    /// Returns the deviations of the drawn machines, in the units of the parameters: by parameter, then by machine.
    pub fn deviations(&self) -> &[[f64; CHUNK]] {
        &self.deviations
    }

    /// Draws the machines of a chunk and returns the outcome of each.
    pub fn outcomes(&mut self, chunk: u64) -> &[SampleOutcome; CHUNK] {
        self.draw(chunk);
        let table = &self.ensemble.table;
        let (mut moment, mut force) = ([[0.0; BLOCK_MACHINES]; MAX_CONSTANTS], [[0.0; BLOCK_MACHINES]; MAX_CONSTANTS]);
        let (moment, force) = (&mut moment[..table.moment.len()], &mut force[..table.force.len()]);
        for block in 0..CHUNK / BLOCK_MACHINES {
            self.constants(block);
            gather(&self.theta, &table.moment, &table.offset, moment);
            gather(&self.theta, &table.force, &table.offset, force);
            let [peak_n, peak_f, sum_n, sum_f] = sweep(&table.rows, moment, force);
            let mean = 1.0 / self.ensemble.between().len() as f64;
            for w in 0..BLOCK_MACHINES {
                self.outcomes[block * BLOCK_MACHINES + w] = SampleOutcome {
                    peak_moment: peak_n[w].sqrt(),
                    peak_force: peak_f[w].sqrt(),
                    rms_moment: (sum_n[w] * mean).sqrt(),
                    rms_force: (sum_f[w] * mean).sqrt(),
                };
            }
        }
        &self.outcomes
    }

    /// Draws the machines of a chunk and calls `see` with the indices of instant and machine, n_B, N m, and |f_B|, N.
    pub fn courses(&mut self, chunk: u64, mut see: impl FnMut(usize, usize, f64, f64)) {
        self.draw(chunk);
        let table = &self.ensemble.table;
        let (mut moment, mut force) =
            (vec![[0.0; BLOCK_MACHINES]; table.moment.len()], vec![[0.0; BLOCK_MACHINES]; table.force.len()]);
        for block in 0..CHUNK / BLOCK_MACHINES {
            self.constants(block);
            gather(&self.theta, &table.moment, &table.offset, &mut moment);
            gather(&self.theta, &table.force, &table.offset, &mut force);
            for (s, row) in table.rows.chunks_exact(table.width()).enumerate() {
                let (n, fx, fy) = wrenches(row, &moment, &force);
                (0..BLOCK_MACHINES).for_each(|w| see(s, block * BLOCK_MACHINES + w, n[w], fx[w].hypot(fy[w])));
            }
        }
    }

    /// Computes θ of the bodies that vary, for one block of the drawn machines.
    fn constants(&mut self, block: usize) {
        let Ensemble { machine, bodies, .. } = self.ensemble;
        evaluate(machine.drives(), bodies, &self.deviations, block, &mut self.theta);
    }
}

/// Maximum number of constants of a machine.
const MAX_CONSTANTS: usize = count(MAX_DRIVES);

/// Computes δθ of the constants in `which`.
fn gather(theta: &[Lanes], which: &[usize], offset: &[f64], out: &mut [Lanes]) {
    for (out, &i) in out.iter_mut().zip(which) {
        *out = theta[i].map(|x| x - offset[i]);
    }
}

/// Returns n_B, f_Bx, f_By of some machines at one instant.
#[inline(always)]
fn wrenches(row: &[f64], moment: &[Lanes], force: &[Lanes]) -> (Lanes, Lanes, Lanes) {
    let (nominal, row) = row.split_at(3);
    let (phi, psi) = row.split_at(moment.len());
    let (mut n, mut fx, mut fy) =
        ([nominal[0]; BLOCK_MACHINES], [nominal[1]; BLOCK_MACHINES], [nominal[2]; BLOCK_MACHINES]);
    for (phi, theta) in phi.iter().zip(moment) {
        for w in 0..BLOCK_MACHINES {
            n[w] += phi * theta[w];
        }
    }
    for ([x, y], theta) in psi.as_chunks().0.iter().zip(force) {
        for w in 0..BLOCK_MACHINES {
            fx[w] += x * theta[w];
            fy[w] += y * theta[w];
        }
    }
    (n, fx, fy)
}

/// Returns the largest n_B² and |f_B|² over all instants, and their sums over all but the first and the last.
fn sweep(rows: &[f64], moment: &[Lanes], force: &[Lanes]) -> [Lanes; 4] {
    let [mut peak_n, mut peak_f, mut sum_n, mut sum_f] = [[0.0; BLOCK_MACHINES]; 4];
    let width = 3 + moment.len() + 2 * force.len();
    let last = rows.len() / width - 1;
    for (s, row) in rows.chunks_exact(width).enumerate() {
        let (n, fx, fy) = wrenches(row, moment, force);
        let weight = if s == 0 || s == last { 0.0 } else { 1.0 };
        for w in 0..BLOCK_MACHINES {
            let (n, f) = (n[w] * n[w], fx[w] * fx[w] + fy[w] * fy[w]);
            // Not f64::max: its treatment of NaN, which does not occur here, takes longer than the rest of the loop.
            peak_n[w] = if n > peak_n[w] { n } else { peak_n[w] };
            peak_f[w] = if f > peak_f[w] { f } else { peak_f[w] };
            sum_n[w] += weight * n;
            sum_f[w] += weight * f;
        }
    }
    [peak_n, peak_f, sum_n, sum_f]
}
