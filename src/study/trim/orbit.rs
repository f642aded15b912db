//! [`orbit_trim`]: identifies first moments and couplings of a machine in orbit, from the rates of its base.
//!
//! Nothing acts on a spacecraft whose thrusters are off, so its angular momentum L about the common centre of mass stays
//! constant. Base and drives turn about this point, which moves with the drives; so the momentum has the form of a fixed
//! base, with the base as one more drive 0 and other coefficients:
//!
//! L = D₀ ω + Σ D′_k q̇_k + Σ Re(C₀_k e^{i φ_k}) (ω + q̇_k) + Σ_{k<l} Re(C′_kl e^{i(φ_l − φ_k)}) (q̇_k + q̇_l) + J Ω
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | ω | rate of the base | rad/s |
//! | φ_k, r_k | angle and rate of drive k relative to the base; q̇_k = ω + r_k | rad, rad/s |
//! | M, m | mass of all, and of the base | kg |
//! | ρ | centre of mass of the base, seen from the base pin | m |
//! | D₀ | I_b + m (1 − m/M) ρρ̄, and what rotors add: known | kg m² |
//! | C₀_k, C′_kl | −m ρ̄ g_k/M, and C_kl − ḡ_k g_l/M | kg m² |
//! | D′_k | D_k − g_k ḡ_k/M | kg m² |
//! | J, Ω | inertia of a reaction wheel, and its absolute rate | kg m², rad/s |
//!
//! # What can be found
//! Momenta are equal up to a factor: without a wheel only ratios to D₀ can be found. Mass, inertia and centre of mass of
//! the base are therefore taken as known, and M from the machine; [`KnownValue`] tells what that is worth. First moments appear through C₀_k, so they are found
//! only if the centre of mass of the base lies off the base pin; at the pin, g_k is not told apart from C_kl and D_k.
//!
//! # Method
//! ω is predicted from angles and rates of the drives, and L is fitted for each motion. Least squares of measured less
//! predicted ω have no bias from its noise, which a fit of L itself would have. Gauss–Newton steps begin at the machine's
//! file. Intervals are those of [`fit`](super::fit()).
//!
//! r_k is the absolute rate less ω as measured. Encoders measure r_k, and absolute rates are their sum with ω: the noise of
//! ω cancels in r_k. Absolute rates from elsewhere leave it there, where it bends the fit: the intervals do not hold.

use nalgebra::{DMatrix, DVector, SVD};
use schemars::JsonSchema;
use serde::Serialize;

use super::error::TrimError;
use super::fit::confounded;
use super::known::{Explained, KnownValue, one_percent_off};
use super::long_run::{bartlett_lags, long_run, t_quantile};
use super::report::{MeasuredUnknown, untold_words};
use super::unknowns::{ComplexPart, Unknown, Unknowns};
use stillbase_mechanics::arm_on_base::FloatingBase;
use stillbase_mechanics::balance::Condition;
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_mechanics::planar::{MAX_DRIVES, PerDrive, Vector, unit};
use stillbase_settings::number::{counted, fixed_or_scientific};
use stillbase_simulation::plant::Base;
use stillbase_simulation::signal_table::{SignalColumn, SignalTable};

/// Maximum number of Gauss–Newton steps.
const MAX_STEPS: usize = 40;
/// Steps below this fraction of the scales of the unknowns end the iteration.
const STEP_TOLERANCE: f64 = 1e-10;
/// Singular values below this fraction of the largest are treated as zero.
const RANK_TOLERANCE: f64 = 1e-9;
/// Steps with a threshold of their own; later ones share one, so that they converge.
const FREE_STEPS: usize = 10;
/// A direction is determined if the standard deviation along it is below this fraction of the scales: the fit is linear
/// in no larger region.
const MAX_DEVIATION: f64 = 0.2;
/// The file explains the rates if all unknowns leave less than this fraction less of them unexplained.
const EXPLAINED: f64 = 0.5;
/// One known value explains the rates if it leaves at most this fraction of what the file leaves, however small the noise.
const NEARLY_ALL: f64 = 1e-3;
/// Residuals whose neighbours are correlated more strongly than this vary slowly, unlike noise.
const SLOW: f64 = 0.9;
/// Residuals below this fraction of the base rate count for nothing.
const NEGLIGIBLE: f64 = 1e-4;
/// Angles that vary by less than this do not move, rad.
const STILL_RAD: f64 = 1e-3;
/// Motions that tell all numbers, if they differ enough.
const ENOUGH_MOTIONS: usize = 3;

/// The signal that only a measurement in orbit has.
pub const BASE_RATE: &str = "attitude_rate/base";

/// Samples of one motion in orbit. All lists have one entry per time.
#[derive(Clone, Debug, PartialEq)]
pub struct OrbitMotion {
    /// Angles of the drives relative to the base, rad.
    pub angles: Vec<PerDrive>,
    /// Rates of the drives relative to the base, rad/s.
    pub rates: Vec<PerDrive>,
    /// Rate of the base, rad/s.
    pub base_rate: Vec<f64>,
    /// Absolute rate of the reaction wheel, rad/s; 0 without one.
    pub wheel_rate: Vec<f64>,
}

/// The known base of a machine in orbit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrbitBase {
    /// Mass, inertia and centre of mass.
    pub body: FloatingBase,
    /// Inertia of a reaction wheel, kg m²; 0 without one.
    pub wheel: f64,
}

/// First moments, couplings and momenta of a machine in orbit, from momentum alone.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct OrbitReport {
    /// Name of the machine.
    pub machine: String,
    /// Number of measured motions.
    pub motions: usize,
    /// Number of rows.
    pub rows: usize,
    /// Standard deviation of the base rate that is not explained, rad/s.
    pub rate_noise: f64,
    /// Root mean square of the base rate that the machine's file does not explain, rad/s.
    pub rate_off: f64,
    /// Whether what is not explained varies slowly, unlike noise.
    pub residual_is_slow: bool,
    /// Known values one of which alone explains the rates as well as all numbers together.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub known: Vec<KnownValue>,
    /// What to measure, if not all is told.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub advice: Option<String>,
    /// Values of every line of (7) and (8), and of the momenta.
    pub numbers: Vec<MeasuredUnknown>,
    /// Groups of unknowns that are only identifiable in combination.
    #[serde(rename = "untold")]
    pub unidentifiable: Vec<Vec<String>>,
}

impl OrbitBase {
    /// Returns the base of a scenario, which floats.
    pub fn of(base: &Base) -> Self {
        Self { body: base.body(), wheel: base.wheel.map_or(0.0, |wheel| wheel.inertia) }
    }
}

impl OrbitReport {
    /// What is taken as known, and what the intervals are of.
    pub const KNOWN_WORDS: &str = "Known are mass and inertia of the base and the wheel, and the mass of the arm; \
                                   ± 95 % is of noise alone.";

    /// Returns in words how much of the base rate is not explained.
    pub fn rate_words(&self) -> String {
        let [off, noise] = [self.rate_off, self.rate_noise].map(|rate| fixed_or_scientific(rate, 4));
        format!("base rate not explained: by the machine's file {off} rad/s rms, by what was measured {noise} rad/s")
    }

    /// Returns sentences about what makes the intervals doubtful.
    pub fn doubts(&self) -> Vec<String> {
        let mut words = Vec::new();
        if self.rate_noise > self.rate_off {
            words.push(
                "The fit explains these rates worse than the machine's file does: the columns do not belong together. Check \
                 that angles and rates of drives and base count from the same axis with the same sign, and are in rad."
                    .into(),
            );
        }
        if let [first, others @ ..] = &self.known[..] {
            let value = |known: &KnownValue| {
                let [file, explains] = [known.file, known.explains].map(|x| fixed_or_scientific(x, 5));
                format!("{} = {explains} {} instead of {file}", known.key, known.unit)
            };
            let others = others.iter().map(|known| format!(", or {}", value(known))).collect::<String>();
            words.push(format!(
                "One known value alone explains these rates as well as the whole table: {}{others}. \
                 Then the intervals do not hold: weigh the parts, and check masses and the inertia of the base first.",
                value(first)
            ));
        }
        if self.residual_is_slow {
            words.push(
                "What is not explained varies slowly, unlike noise: the model does not explain the rates, and the \
                 intervals do not hold. Check masses, inertia of base and wheel, that no thruster is on, and that all angles \
                 and rates count from the same axis, with the same sign."
                    .into(),
            );
        }
        words
    }

    /// Returns a sentence for each group of unknowns that is not identifiable.
    pub fn untold_words(&self) -> impl Iterator<Item = String> {
        untold_words(&self.unidentifiable)
    }
}

impl OrbitMotion {
    /// Reads a motion from signals as a simulation records them: `angle/…` and `rate/…` of every drive,
    /// `attitude/base`, `attitude_rate/base`, and `wheel/rate` if there is a wheel.
    ///
    /// # Errors
    /// If a signal is missing, has another unit, or is not a number throughout.
    pub fn of(machine: &Machine, table: &SignalTable) -> Result<Self, TrimError> {
        let column = |path: String, want: &'static str| match table.column(&path) {
            Some(SignalColumn { unit, .. }) if ![want, ""].contains(&unit.as_str()) => {
                Err(TrimError::SignalUnit { path, unit: unit.clone(), want })
            }
            Some(column) if column.values.iter().all(|x| x.is_finite()) => Ok(column.values.as_slice()),
            _ => Err(TrimError::Signal { path }),
        };
        let drives = || machine.spec().drives.iter().map(|drive| drive.name.as_str());
        let each = |what: &str, unit: &'static str| {
            drives().map(|name| column(format!("{what}/{name}"), unit)).collect::<Result<Vec<_>, _>>()
        };
        let (angles, rates) = (each("angle", "rad")?, each("rate", "rad/s")?);
        let (turn, base_rate) = (column("attitude/base".into(), "rad")?, column(BASE_RATE.into(), "rad/s")?);
        let wheel = "wheel/rate";
        let wheel = table.column(wheel).map_or(Ok(None), |_| column(wheel.into(), "rad/s").map(Some))?;
        let less = |of: &[&[f64]], base: &[f64]| -> Vec<PerDrive> {
            base.iter().enumerate().map(|(i, base)| PerDrive::from_fn(of.len(), |k| of[k][i] - base)).collect()
        };
        Ok(Self {
            angles: less(&angles, turn),
            rates: less(&rates, base_rate),
            base_rate: base_rate.to_vec(),
            wheel_rate: wheel.map_or_else(|| vec![0.0; base_rate.len()], <[f64]>::to_vec),
        })
    }
}

/// Coefficients of the momentum about the common centre of mass.
pub(super) struct Coefficients {
    /// D₀ and the sum of all D′.
    base: f64,
    own: [f64; MAX_DRIVES],
    to_base: [Vector; MAX_DRIVES],
    between: [[Vector; MAX_DRIVES]; MAX_DRIVES],
    first_moments: [Vector; MAX_DRIVES],
}

/// The machine on its base.
pub(super) struct Craft {
    pub unknowns: Unknowns,
    /// M, kg.
    mass: f64,
    /// m ρ, kg m.
    moment: Vector,
    /// D₀, kg m².
    inertia: f64,
    pub wheel: f64,
}

impl Craft {
    pub fn of(machine: &Machine, base: &OrbitBase) -> Self {
        Self::with_mass(machine, base, machine.mass())
    }

    /// Returns the machine as if it had another mass, kg, with the same coefficients.
    pub fn with_mass(machine: &Machine, base: &OrbitBase, arm: f64) -> Self {
        let inertia = Inertia::of(machine);
        let FloatingBase { mass: own, inertia: about, com } = base.body;
        let mass = own + arm;
        // Rotors whose stators sit on the base turn with it, too.
        let rotors = inertia.locked() - inertia.total_momentum();
        Self {
            unknowns: Unknowns::of(machine.drives()),
            mass,
            moment: own * com,
            inertia: about + own * (1.0 - own / mass) * com.norm_sqr() + rotors,
            wheel: base.wheel,
        }
    }

    pub fn coefficients(&self, x: &DVector<f64>) -> Coefficients {
        let zero = Vector::default();
        let mut all = Coefficients {
            base: self.inertia,
            own: [0.0; MAX_DRIVES],
            to_base: [zero; MAX_DRIVES],
            between: [[zero; MAX_DRIVES]; MAX_DRIVES],
            first_moments: [zero; MAX_DRIVES],
        };
        for place in 0..self.unknowns.count() {
            let part =
                |part| if part == ComplexPart::Along { Vector::new(x[place], 0.0) } else { Vector::new(0.0, x[place]) };
            match self.unknowns.at(place) {
                Unknown::Of(Condition::Force(k), of) => all.first_moments[k] += part(of),
                Unknown::Of(Condition::Coupling(k, l), of) => all.between[k][l] += part(of),
                Unknown::Momentum(k) => all.own[k] = x[place],
            }
        }
        let (n, g) = (self.unknowns.drives(), all.first_moments);
        for k in 0..n {
            all.own[k] -= g[k].norm_sqr() / self.mass;
            all.to_base[k] = -self.moment.conj() * g[k] / self.mass;
            for l in k + 1..n {
                all.between[k][l] -= g[k].conj() * g[l] / self.mass;
            }
        }
        all
    }

    /// Returns the momentum without base rate, the inertia that it turns with, and the derivatives of ω by the unknowns,
    /// if `momentum` is L, kg m²/s, less that of the wheel.
    pub fn row(
        &self,
        of: &Coefficients,
        angles: &PerDrive,
        rates: &PerDrive,
        momentum: Option<f64>,
        row: &mut [f64],
    ) -> [f64; 2] {
        let n = self.unknowns.drives();
        let turn = |k: usize, l: usize| unit(angles[l] - angles[k]);
        let (mut still, mut turning) = (0.0, of.base);
        for k in 0..n {
            let coupled = (of.to_base[k] * unit(angles[k])).re;
            still += of.own[k] * rates[k] + coupled * rates[k];
            turning += of.own[k] + 2.0 * coupled;
            for l in k + 1..n {
                let coupled = (of.between[k][l] * turn(k, l)).re;
                still += coupled * (rates[k] + rates[l]);
                turning += 2.0 * coupled;
            }
        }
        let Some(momentum) = momentum else { return [still, turning] };
        let rate = (momentum - still) / turning;
        // The momentum that a change of each coefficient adds at this rate.
        let own = |k: usize| rates[k] + rate;
        let to_base = |k: usize, by: Vector| (by * unit(angles[k])).re * (rates[k] + 2.0 * rate);
        let between = |k: usize, l: usize, by: Vector| (by * turn(k, l)).re * (rates[k] + rates[l] + 2.0 * rate);
        for (place, value) in row.iter_mut().enumerate().take(self.unknowns.count()) {
            let part = |part| if part == ComplexPart::Along { Vector::new(1.0, 0.0) } else { Vector::i() };
            let added = match self.unknowns.at(place) {
                Unknown::Momentum(k) => own(k),
                Unknown::Of(Condition::Coupling(k, l), of) => between(k, l, part(of)),
                Unknown::Of(Condition::Force(k), part_of) => {
                    let (by, g) = (part(part_of) / self.mass, &of.first_moments);
                    let others: f64 = (0..n)
                        .map(|l| match k.cmp(&l) {
                            std::cmp::Ordering::Less => between(k, l, -by.conj() * g[l]),
                            std::cmp::Ordering::Greater => between(l, k, -g[l].conj() * by),
                            std::cmp::Ordering::Equal => -2.0 * (by.conj() * g[k]).re * own(k),
                        })
                        .sum();
                    others + to_base(k, -self.moment.conj() * by)
                }
            };
            *value = -added / turning;
        }
        [rate, turning]
    }
}

/// Identifies first moments, couplings and momenta of a machine from motions in orbit. What the motions do not determine
/// stays as in the machine's file.
///
/// # Errors
/// If there are too few rows, a motion has lists of different lengths, or a result is not finite.
pub fn orbit_trim(machine: &Machine, base: &OrbitBase, motions: &[OrbitMotion]) -> Result<OrbitReport, TrimError> {
    let (craft, inertia) = (Craft::of(machine, base), Inertia::of(machine));
    let (p, counts) = (craft.unknowns.count(), motions.iter().map(|m| m.base_rate.len()).collect::<Vec<_>>());
    let (rows, all) = (counts.iter().sum::<usize>(), p + motions.len());
    for (motion, of) in motions.iter().enumerate() {
        let n = of.base_rate.len();
        if n == 0 || [of.angles.len(), of.rates.len(), of.wheel_rate.len()].iter().any(|own| *own != n) {
            let what = "lists of different lengths, or none: want one entry for each time";
            return Err(TrimError::Motion { motion, what });
        }
        if let Some(got) = of.angles.iter().chain(&of.rates).map(|x| x.len()).find(|got| *got != machine.drives()) {
            return Err(TrimError::Drives { got, want: machine.drives() });
        }
    }
    let wheel_rate =
        motions.iter().flat_map(|motion| &motion.wheel_rate).fold(0.0_f64, |most, rate| most.max(rate.abs()));
    if base.wheel == 0.0 && wheel_rate > 0.0 {
        return Err(TrimError::NoWheel { rate: wheel_rate });
    }
    if rows < 2 * all {
        return Err(TrimError::TooFew { rows, unknowns: p });
    }
    let nominal = DVector::from_vec(craft.unknowns.nominal(&inertia));
    let scales = craft.unknowns.scales(&inertia);
    let samples = || {
        motions.iter().enumerate().flat_map(|(i, motion)| (0..motion.base_rate.len()).map(move |row| (i, motion, row)))
    };
    let wheel = |motion: &OrbitMotion, row: usize| craft.wheel * motion.wheel_rate[row];
    // L of each motion, as the machine's file has it on average.
    let mut x = nominal.clone().resize_vertically(all, 0.0);
    let of = craft.coefficients(&nominal);
    for (i, motion, row) in samples() {
        let [still, turning] = craft.row(&of, &motion.angles[row], &motion.rates[row], None, &mut []);
        x[p + i] += (still + turning * motion.base_rate[row] + wheel(motion, row)) / counts[i] as f64;
    }
    let scale = |j: usize| if j < p { scales[j] } else { craft.inertia };
    let mut first_residual = None;
    let mut solved = None;
    let (start, mut fixed_threshold) = (x.clone(), None);
    for iteration in 0..MAX_STEPS {
        let of = craft.coefficients(&x);
        let (mut slopes, mut errors) = (DMatrix::zeros(rows, all), DVector::zeros(rows));
        let mut own = vec![0.0; p];
        for (at, (i, motion, row)) in samples().enumerate() {
            let left = x[p + i] - wheel(motion, row);
            let [rate, turning] = craft.row(&of, &motion.angles[row], &motion.rates[row], Some(left), &mut own);
            errors[at] = motion.base_rate[row] - rate;
            own.iter().enumerate().for_each(|(j, slope)| slopes[(at, j)] = *slope);
            slopes[(at, p + i)] = 1.0 / turning;
        }
        let off = (errors.norm_squared() / rows as f64).sqrt();
        first_residual.get_or_insert(off);
        let mut scaled = slopes.clone();
        (0..all).for_each(|j| scaled.column_mut(j).scale_mut(scale(j)));
        let r = scaled.clone().qr().unpack_r();
        let svd = SVD::try_new(r, false, true, 5.0 * f64::EPSILON, 10_000).ok_or(TrimError::NotFinite)?;
        let v = svd.v_t.ok_or(TrimError::NotFinite)?.transpose();
        // A direction in which noise alone could lead far from the file is not determined.
        let threshold = match fixed_threshold {
            Some(fixed) => fixed,
            None => (RANK_TOLERANCE * svd.singular_values.max()).max(off / MAX_DEVIATION),
        };
        if iteration + 1 >= FREE_STEPS {
            fixed_threshold = Some(threshold);
        }
        let is_kept = |i: &usize| svd.singular_values[*i] > threshold;
        let (kept, rest): (Vec<usize>, Vec<usize>) = (0..all).partition(is_kept);
        let mut inverse = DMatrix::zeros(all, all);
        for i in kept {
            let column = DVector::from_fn(all, |j, _| v[(j, i)] * scale(j));
            inverse += &column * column.transpose() / svd.singular_values[i].powi(2);
        }
        let mut step = &inverse * slopes.tr_mul(&errors);
        // What is not determined goes back to where it was, whatever earlier steps have made of it.
        for i in &rest {
            let way: f64 = (0..all).map(|j| v[(j, *i)] * (start[j] - x[j]) / scale(j)).sum();
            (0..all).for_each(|j| step[j] += way * v[(j, *i)] * scale(j));
        }
        let size = (0..all).map(|j| (step[j] / scale(j)).abs()).fold(0.0, f64::max);
        if !size.is_finite() {
            return Err(TrimError::NotFinite);
        }
        x += &step;
        solved = Some((slopes, errors, inverse, v.select_columns(&rest), off));
        if size < STEP_TOLERANCE {
            break;
        }
    }
    let (slopes, errors, inverse, free, rate_noise) = solved.ok_or(TrimError::NotFinite)?;
    let lags = bartlett_lags(&[errors.as_slice()], &counts, 1);
    let scores = DMatrix::from_fn(rows, all, |i, j| slopes[(i, j)] * errors[i]);
    let share = 1.0 - (all - free.ncols()) as f64 / rows as f64;
    let covariance = &inverse * (long_run(&scores, &counts, lags, 1) / share) * inverse.transpose();
    let critical = t_quantile(lags as f64 / rows as f64);
    let (groups, told) = confounded(&free.rows(0, p).clone_owned(), p);
    // How far each number moves with each known value, in one Gauss–Newton step.
    let shifts: Vec<DVector<f64>> = one_percent_off(machine, base)
        .iter()
        .map(|craft| {
            let of = craft.coefficients(&x);
            let moved = samples().map(|(i, motion, row)| {
                let left = x[p + i] - craft.wheel * motion.wheel_rate[row];
                let [still, turning] = craft.row(&of, &motion.angles[row], &motion.rates[row], None, &mut []);
                motion.base_rate[row] - (left - still) / turning
            });
            let moved = DVector::from_iterator(rows, moved) - &errors;
            &inverse * slopes.tr_mul(&moved)
        })
        .collect();
    let number = |i: usize| {
        let (what, half) = (craft.unknowns.at(i), critical * covariance[(i, i)].max(0.0).sqrt());
        let is_told = told[i];
        MeasuredUnknown {
            name: what.name(machine),
            unit: what.unit(),
            nominal: nominal[i] + 0.0,
            identifiable: is_told,
            measured: is_told.then_some(x[i] + 0.0),
            half_width: is_told.then_some(half),
            per_percent: is_told.then(|| shifts.iter().map(|shift| shift[i].powi(2)).sum::<f64>().sqrt()),
            off: is_told && (x[i] - nominal[i]).abs() > half,
        }
    };
    let name = |i: &usize| craft.unknowns.at(*i).name(machine);
    let rate_off = first_residual.unwrap_or_default();
    // As much as the unknowns explain of noise alone, and some more.
    let chance = 1.0 + 3.0 * (p * lags) as f64 / rows as f64;
    let known = match rate_noise < (1.0 - EXPLAINED) * rate_off {
        true => {
            Explained::of(machine, base, motions).by_one_value((rate_noise * chance.sqrt()).max(NEARLY_ALL * rate_off))
        }
        false => Vec::new(),
    };
    let base_rate = (samples().map(|(_, motion, row)| motion.base_rate[row].powi(2)).sum::<f64>() / rows as f64).sqrt();
    let residual_is_slow = rate_noise > NEGLIGIBLE * base_rate && first_correlation(&errors, &counts) > SLOW;
    Ok(OrbitReport {
        machine: machine.name().to_owned(),
        motions: motions.len(),
        rows,
        rate_noise,
        rate_off,
        residual_is_slow,
        known,
        advice: told.contains(&false).then(|| advice(machine, base, motions)),
        numbers: (0..p).map(number).collect(),
        unidentifiable: groups.iter().map(|group| group.iter().map(name).collect()).collect(),
    })
}

/// Returns the correlation of neighbouring residuals within motions.
fn first_correlation(errors: &DVector<f64>, counts: &[usize]) -> f64 {
    let (mut from, mut next) = (0, 0.0);
    for count in counts {
        let own = &errors.as_slice()[from..from + count];
        next += own.windows(2).map(|pair| pair[0] * pair[1]).sum::<f64>();
        from += count;
    }
    next / errors.norm_squared().max(f64::MIN_POSITIVE)
}

/// Returns in words what to measure, if motions do not tell all unknowns.
fn advice(machine: &Machine, base: &OrbitBase, motions: &[OrbitMotion]) -> String {
    let n = machine.drives();
    let name = |k: usize| machine.spec().drives[k].name.as_str();
    let varies = |of: &dyn Fn(&PerDrive) -> f64| {
        motions.iter().any(|motion| {
            let each = || motion.angles.iter().map(of);
            each().fold(f64::NEG_INFINITY, f64::max) - each().fold(f64::INFINITY, f64::min) > STILL_RAD
        })
    };
    let still: Vec<&str> = (0..n).filter(|k| !varies(&|q| q[*k])).map(name).collect();
    if !still.is_empty() {
        return format!("{} did not move: want motions in which every drive moves.", still.join(", "));
    }
    let pairs = (0..n).flat_map(|k| (k + 1..n).map(move |l| (k, l)));
    let together: Vec<String> = pairs
        .filter(|(k, l)| !varies(&|q| q[*l] - q[*k]))
        .map(|(k, l)| format!("{} and {}", name(k), name(l)))
        .collect();
    if !together.is_empty() {
        let pairs = together.join(", ");
        return format!("Turned as one: {pairs}. Want motions in which they turn apart, one joint after the other.");
    }
    if motions.len() < ENOUGH_MOTIONS {
        return format!(
            "{} may not do: want {ENOUGH_MOTIONS} that begin in other poses and move other joints.",
            counted(motions.len(), "motion")
        );
    }
    if base.body.com.norm() < 1e-9 {
        return "With its centre of mass at the base pin, the base tells no first moments apart.".into();
    }
    "Want motions that go farther and faster, in other poses.".into()
}
