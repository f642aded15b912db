//! [`doubt`]: whether a measurement is what it says it is.
//!
//! Least squares believe every column: a moment of the wrong sign gives momenta of the wrong sign, and exchanged columns
//! give another machine. So each plausible [`Fault`] is a hypothesis, too: the measurement is fitted as it would be without
//! it, and the data decide.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | σ | what the fit leaves of force and of moment, root mean square, as a share of what was measured | |
//! | N | independent rows: the fewer of both fits, less those that the numbers use up | |
//! | d_D², d² | squared distance of the momenta, and of all numbers, from the file in standard deviations of [`Tolerances`] | |
//! | c² | that of first moments and couplings, the larger of both fits, and one for each of the p numbers | |
//! | Λ | likelihood ratio of a hypothesis to the measurement as given | |
//!
//! # How
//! ln Λ = Σ N ln(σ₀/σ) + p/2 ln((d_D0² + c²)/(d_D² + c²)) ± ln 10⁶ where one keeps the joint limits and the other leaves
//! them. The first term is the F-test of the residuals. The second compares the momenta with the file on the scale of
//! its other errors, which is unknown: a machine that is far off in everything is no evidence of a fault. The signs of
//! first moments are no part of it, because a balanced machine can be off either way. A machine that is not balanced
//! cannot: with d² of the momenta and of those first moments and couplings that its file has, p/2 ln(d₀²/(`FAR` d²)) is
//! the second term if that is more.
//! The measurement as given is refused where Λ is above 10⁴, or where no machine can have what was found
//! ([`impossible`]).
//!
//! Some faults leave the same residuals: a machine that is balanced does not tell whether fx or fy is reversed. Then
//! faults are ordered by all of d², and the message names each that is not clearly less likely than the first.
//!
//! # Source
//! Wilks (1938) for ratios; Kass and Raftery (1995) for what they mean.

mod fault;
mod possible;
mod tolerances;

use std::fmt;

use fault::Fault;
use possible::impossible;
use tolerances::{Tolerances, known};

use super::error::TrimError;
use super::fit::{Fit, estimate};
use super::recording::{Motion, Recording};
use super::rows::Rows;
use super::unknowns::Unknown;
use crate::mechanics::machine::Machine;
use crate::mechanics::planar::Vector;
use crate::settings::number::shown;

/// ln Λ above which a fault is believed: odds of 10⁴.
const BELIEVED: f64 = 9.21;
/// ln Λ of joint limits that are kept instead of left: odds of 10⁶.
const LIMITS: f64 = 13.8;
/// By how many times all numbers have to come closer to the file, in squares, before that is evidence of a fault: errors
/// of which the tolerances know nothing make them come closer by less.
const FAR: f64 = 30.0;
/// Numbers that differ from each other by a smaller share are not told as different.
const SAME: f64 = 1e-3;
/// Limits are left by more than this, rad.
const LEFT: f64 = 0.1;
/// Limits are kept within this, rad.
const KEPT: f64 = 0.02;
/// Each further mistake that a fault consists of is less likely by these odds, in logarithm.
const MISTAKE: f64 = 2.3;
/// Faults less likely than the first by more than this ln Λ are not named.
const NAMED: f64 = 6.9;
/// As many are named at most.
const MAX_NAMED: usize = 5;
/// As few rows tell how correlated they are, this share of the independent ones is counted.
const CORRELATED: f64 = 0.5;
/// Residuals below this share of what was measured are those of differences between samples, and no evidence.
const EXACT: f64 = 1e-6;
/// Samples that are looked at: so many by the square of the number of unknowns.
const MAX_WORK: usize = 4_000_000;

/// Why a measurement is not believed.
#[derive(Clone, Debug, PartialEq)]
pub struct Doubt {
    /// What is wrong with it, the likeliest first; none where no fault that is known explains it.
    pub causes: Vec<Cause>,
    /// Numbers that no machine has.
    pub impossible: Vec<Said>,
    /// The number that is furthest from the file.
    pub furthest: Option<Said>,
    /// What is not explained of force, N, and of moment, N m, as given.
    pub noise: [f64; 2],
    /// The same as shares of what was measured.
    pub shares: [f64; 2],
    /// By how much angles leave their limits as given, rad.
    pub leaves: f64,
}

/// What may be wrong.
#[derive(Clone, Debug, PartialEq)]
pub struct Cause {
    /// What is.
    pub what: String,
    /// What would be right.
    pub want: String,
    /// log₁₀ of how much better it explains the measurement.
    pub odds: f64,
    /// What is not explained of force, N, and of moment, N m, without it.
    pub noise: [f64; 2],
    /// The same as shares of what would then be measured.
    pub shares: [f64; 2],
    /// The furthest number without it.
    pub furthest: Option<f64>,
    /// By how much angles leave their limits without it, rad.
    pub leaves: f64,
}

/// A number as the measurement as given has it.
#[derive(Clone, Debug, PartialEq)]
pub struct Said {
    /// Which.
    pub name: String,
    /// Its unit.
    pub unit: &'static str,
    /// As measured.
    pub value: f64,
    /// Half its interval of 95 %.
    pub half_width: f64,
    /// In the machine's file.
    pub file: f64,
}

/// A fit, and how far angles leave their limits.
struct Tried {
    fit: Fit,
    share: f64,
    leaves: f64,
}

/// Whether a measurement is not what it says; `None` where it can be believed. Of long recordings parts are looked at.
///
/// # Errors
/// If the recording cannot be used.
pub fn doubt(machine: &Machine, recording: &Recording, angles_only: bool) -> Result<Option<Doubt>, TrimError> {
    recording.check(machine.drives())?;
    let recording = &shortened(machine, recording);
    let rows = Rows::of(machine, recording, angles_only)?;
    let given = tried(machine, &rows, leaves(machine, recording))?;
    let tolerances = Tolerances::of(machine);
    let broken = impossible(machine, &given.fit);
    let mut likely: Vec<(f64, f64, Fault, Tried)> = Vec::new();
    for fault in Fault::all(machine) {
        let own = fault.angles.as_ref().map(|angles| angles.undo(recording));
        let (mut heard, mut as_given, mut left) = (rows.clone(), None, given.leaves);
        if let Some(own) = &own {
            left = leaves(machine, own);
            let Ok(fresh) = Rows::at_least(rows.half(), machine, own, angles_only) else { continue };
            // Residuals are compared over the same windows.
            if fresh.half() > rows.half() {
                let wide = Rows::at_least(fresh.half(), machine, recording, angles_only);
                as_given = wide.and_then(|rows| tried(machine, &rows, given.leaves)).ok();
            }
            heard = fresh;
        }
        heard.hear(|force, moment| fault.undo(force, moment));
        let Ok(other) = tried(machine, &heard, left) else { continue };
        let Some([decides, ranks]) = odds(&tolerances, as_given.as_ref().unwrap_or(&given), &other) else { continue };
        // What is impossible as given is explained by what is not, however little else speaks for it.
        let explains = match broken.as_slice() {
            [] => decides > BELIEVED,
            _ => ranks > 0.0,
        };
        if explains && impossible(machine, &other.fit).is_empty() {
            likely.push((decides.max(ranks), ranks - MISTAKE * (fault.mistakes - 1) as f64, fault, other));
        }
    }
    if likely.is_empty() && broken.is_empty() {
        return Ok(None);
    }
    likely.sort_by(|a, b| b.1.total_cmp(&a.1));
    let best = likely.first().map_or(0.0, |(_, ranks, ..)| *ranks);
    likely.retain(|(_, ranks, ..)| *ranks > best - NAMED);
    let said = |place: usize| Said {
        name: given.fit.unknowns.at(place).name(machine),
        unit: given.fit.unknowns.at(place).unit(),
        value: given.fit.measured[place],
        half_width: given.fit.half_width(place),
        file: given.fit.nominal[place],
    };
    let place = |unknown: &Unknown| (0..given.fit.unknowns.count()).find(|i| given.fit.unknowns.at(*i) == *unknown);
    let first = likely.first().map(|(.., tried)| tried);
    let furthest = furthest(machine, &given, first);
    let causes = likely.iter().map(|(odds, _, fault, tried)| Cause {
        what: fault.what.clone(),
        want: fault.want.clone(),
        odds: odds / std::f64::consts::LN_10,
        noise: tried.fit.noise,
        shares: shares(&tried.fit),
        furthest: furthest.map(|place| tried.fit.measured[place]),
        leaves: tried.leaves,
    });
    let mut causes: Vec<Cause> = causes.collect();
    causes.dedup_by(|a, b| a.what == b.what && a.want == b.want);
    causes.truncate(MAX_NAMED);
    Ok(Some(Doubt {
        causes,
        impossible: broken.iter().filter_map(place).map(said).collect(),
        furthest: furthest.map(said),
        noise: given.fit.noise,
        shares: shares(&given.fit),
        leaves: given.leaves,
    }))
}

fn tried(machine: &Machine, rows: &Rows, leaves: f64) -> Result<Tried, TrimError> {
    let estimate = estimate(machine, rows)?;
    Ok(Tried { fit: estimate.fit, share: estimate.share.clamp(0.1, 1.0), leaves })
}

/// What a fit leaves of force and of moment, as shares of what was measured.
fn shares(fit: &Fit) -> [f64; 2] {
    [0, 1].map(|of| fit.noise[of] / fit.size[of].max(f64::MIN_POSITIVE))
}

/// ln Λ that decides, and ln Λ that ranks.
fn odds(tolerances: &Tolerances, given: &Tried, other: &Tried) -> Option<[f64; 2]> {
    let (was, now) = (&given.fit, &other.fit);
    let residuals = |of: usize| {
        let [before, after] = [was, now].map(|fit| shares(fit)[of].max(EXACT));
        CORRELATED * was.effective[of].min(now.effective[of]) * other.share * (before / after).ln()
    };
    let (before, after) = (tolerances.distance(was)?, tolerances.distance(now)?);
    // Units change what is known; more of it speaks.
    let p = before.numbers.max(after.numbers);
    let scale = before.balance.max(after.balance) + p;
    let limits = match [given.leaves, other.leaves] {
        [was, now] if was > LEFT && now < KEPT => LIMITS,
        [was, now] if was < KEPT && now > LEFT => -LIMITS,
        _ => 0.0,
    };
    let common = residuals(0) + residuals(1) + limits;
    let momenta = 0.5 * p * ((before.momenta + scale) / (after.momenta + scale)).ln();
    // Closer to the file than the tolerances is not better.
    let all = 0.5 * p * (before.all.max(p) / after.all.max(p)).ln();
    let far = before.known.zip(after.known).map_or(f64::NEG_INFINITY, |([was, p], [now, more])| {
        let p = p.max(more);
        0.5 * p * (was / (FAR * now.max(p))).ln()
    });
    Some([common + momenta.max(far), common + all]).filter(|odds| odds.iter().all(|x| x.is_finite()))
}

/// The momentum that is furthest from the file as given, by what another fit makes of it, else by the file; or a first
/// moment or coupling of a machine that is not balanced, where that is further.
fn furthest(machine: &Machine, given: &Tried, other: Option<&Tried>) -> Option<usize> {
    let (fit, known) = (&given.fit, known(machine));
    let off = |i: &usize| {
        let better = other.map_or(fit.nominal[*i], |other| other.fit.measured[*i]);
        (fit.measured[*i] - better).abs() / fit.nominal[*i].abs().max(f64::MIN_POSITIVE)
    };
    let told = (0..fit.unknowns.count()).filter(|i| fit.told[*i] && known[*i]);
    // What is as in the file is no evidence.
    let told = told.filter(|i| off(i) > SAME);
    told.max_by(|a, b| off(a).total_cmp(&off(b)))
}

/// By how much relative angles leave their limits, whole turns aside, rad.
fn leaves(machine: &Machine, recording: &Recording) -> f64 {
    let mut most: f64 = 0.0;
    for angle in machine.angles() {
        let (low, high) = (*angle.limits.start(), *angle.limits.end());
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        if !half.is_finite() {
            continue;
        }
        for q in recording.motions.iter().flat_map(|motion| &motion.q) {
            let by = q[angle.to] - q[angle.from] + angle.offset - middle;
            let turns = std::f64::consts::TAU * (by / std::f64::consts::TAU).round();
            most = most.max((by - turns).abs() - half);
        }
    }
    most
}

/// A recording short enough to be fitted many times: of too long ones some motions, of these the first samples.
fn shortened(machine: &Machine, recording: &Recording) -> Recording {
    let unknowns = super::Unknowns::of(machine.drives()).count();
    let most = (MAX_WORK / unknowns.pow(2)).clamp(1_000, 20_000);
    let samples: usize = recording.motions.iter().map(|motion| motion.t.len()).sum();
    if samples <= most {
        return recording.clone();
    }
    let count = recording.motions.len().min(most / 250);
    let each = most / count;
    let cut = |motion: &Motion| {
        let rows = motion.t.len().min(each);
        let part = |all: &[_]| all.iter().copied().take(rows).collect();
        Motion {
            t: motion.t[..rows].to_vec(),
            q: part(&motion.q),
            qd: part(&motion.qd),
            qdd: part(&motion.qdd),
            force: motion.force[..rows].to_vec(),
            moment: motion.moment[..rows].to_vec(),
        }
    };
    let motions = (0..count).map(|i| cut(&recording.motions[i * recording.motions.len() / count])).collect();
    Recording { motions }
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = |x: f64| shown(x, 4);
        match self.causes.as_slice() {
            [] => {
                write!(f, "this measurement is of no machine: want the columns, their signs and their units checked")?
            }
            [first, rest @ ..] => {
                write!(f, "{}: want {}", first.what, first.want)?;
                for cause in rest {
                    write!(f, "\n  or {}: want {}", cause.what, cause.want)?;
                }
                let it = if rest.is_empty() { "It" } else { "The first" };
                write!(f, "\n  {it} explains the data 10^{:.0} times as well.", first.odds.min(99.0))?;
            }
        }
        let then = self.causes.first();
        for Said { name, unit, value, half_width, file } in &self.impossible {
            write!(f, "\n  As given, {name} = {} ± {} {unit}", number(*value), number(*half_width))?;
            write!(f, " (file: {}), which no masses above zero make.", number(*file))?;
        }
        if let Some(Said { name, unit, value, half_width, file }) = &self.furthest {
            if !self.impossible.iter().any(|said| said.name == *name) {
                write!(f, "\n  As given, {name} = {} ± {} {unit}", number(*value), number(*half_width))?;
                write!(f, " (file: {}).", number(*file))?;
            }
            if let Some(now) =
                then.and_then(|then| then.furthest).filter(|now| (now - value).abs() > 0.01 * value.abs())
            {
                write!(f, " Without the fault, {name} = {}.", number(now))?;
            }
        }
        if let Some(then) = then {
            for (i, unit) in ["N", "N m"].into_iter().enumerate() {
                // In another unit the same is no evidence.
                if self.shares[i] > 1.1 * then.shares[i] {
                    write!(f, "\n  As given, {} {unit} are not explained;", number(self.noise[i]))?;
                    write!(f, " without the fault {}.", number(then.noise[i]))?;
                }
            }
            if self.leaves > LEFT && then.leaves < KEPT {
                write!(f, "\n  As given, angles leave their limits by {} rad;", number(self.leaves))?;
                write!(f, " without the fault they keep them.")?;
            }
        }
        Ok(())
    }
}

impl Rows {
    /// What was measured, as something else; lines over time stay taken out.
    fn hear(&mut self, as_what: impl Fn(Vector, f64) -> (Vector, f64)) {
        let [fx, fy, n] = &mut self.channels;
        for ((fx, fy), n) in fx.y.iter_mut().zip(&mut fy.y).zip(&mut n.y) {
            let (force, moment) = as_what(Vector::new(*fx, *fy), *n);
            (*fx, *fy, *n) = (force.re, force.im, moment);
        }
    }
}
