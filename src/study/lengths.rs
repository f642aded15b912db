//! [`search`]: lengths of the links with which counterweights are least.
//!
//! For given lengths the counterweights are a cone program, and certified. Over the lengths nothing is convex, so the
//! search starts at several places that a seed draws (Nelder–Mead from each) and says how many of them ended alike. What it
//! finds is the best of what it has seen, and no proof.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};
use serde::Serialize;
use thiserror::Error;

use crate::mechanics::counterweights::{NoWeights, Objective, Placed, Sites, Weighing, place};
use crate::mechanics::machine::{Length, Link, Machine, MachineSpec};
use crate::planning::pose_space::plane_area;
use crate::query::{Portion, Query, Shared, Watch};
use crate::session::design::Brief;

/// A length that is sought: one under `[lengths]`, which several links may share, or that of one link.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeLength {
    /// Its name, or the link's.
    pub name: String,
    /// From, to, m.
    pub ends: [f64; 2],
}

/// What is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct LengthSearch {
    /// Lengths that are sought. Links keep their mass per metre: centre of mass and inertia follow the length.
    pub lengths: Vec<FreeLength>,
    /// Counterweights, and what is to be least.
    pub weighing: Weighing,
    /// Whether places at the ends of links, or as far behind them, follow their lengths.
    pub anywhere: bool,
    /// How far the arms have to reach together at least, Σ |L_k|, m.
    pub least_reach: Option<f64>,
    /// How large the reactionless workspace has to be at least, m².
    pub least_workspace: Option<f64>,
    /// From how many places it starts: first from the lengths that the machine has.
    pub starts: usize,
    /// For the others.
    pub seed: u64,
}

/// What was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The machine with its counterweights; certified for these lengths.
    pub placed: Placed,
    /// m, in the order of what was sought.
    pub lengths: Vec<f64>,
    /// How many starts were made, and how many of them ended within a thousandth of the best.
    pub starts: [usize; 2],
    /// How many machines were looked at.
    pub machines: usize,
}

/// How far a search has come.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Progress {
    /// Starts that have ended.
    pub starts: usize,
    /// Machines looked at.
    pub machines: usize,
    /// The least so far; infinite if there is none.
    pub best: f64,
}

/// Why nothing was found.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum NoLengths {
    /// There is no such length.
    #[error("no length {name}: want one of {known}")]
    Unknown {
        /// What was asked for.
        name: String,
        /// What there is.
        known: String,
    },
    /// A range that cannot be.
    #[error("length {name} from {from} to {to}: want two lengths above 0 in m, the first below the second")]
    Range {
        /// Of what.
        name: String,
        /// m.
        from: f64,
        /// m.
        to: f64,
    },
    /// One length is named twice.
    #[error("length {0} is sought in two ranges: want one")]
    Twice(String),
    /// Nothing to seek, or from nowhere.
    #[error("{0}")]
    Nothing(&'static str),
    /// No machine that was looked at does.
    #[error("none of {machines} machines with such lengths does: {why}")]
    None {
        /// How many.
        machines: usize,
        /// Why the present lengths do not.
        why: String,
    },
    /// The counterweights themselves.
    #[error(transparent)]
    Weights(#[from] NoWeights),
}

/// What a machine that is no answer counts at least: more than any that is one. Less of what is missing is better.
const NO_ANSWER: f64 = 1e30;

/// The search for lengths with which counterweights are least, as a query: [`search`], in one portion that says how many
/// of its starts have ended.
pub struct Seeking {
    machine: Shared<Machine>,
    asked: LengthSearch,
}

impl Query for Seeking {
    type Input = (Shared<Machine>, LengthSearch);
    type Answer = Result<Found, NoLengths>;

    fn begin((machine, asked): Self::Input) -> Self {
        Self { machine, asked }
    }

    fn go_on(&mut self, goes_on: Watch<'_>) -> Portion<Self::Answer> {
        let (starts, mut wanted) = (self.asked.starts.max(1) as f64, true);
        let found = search(&self.machine.0, &self.asked, &mut |progress| {
            wanted = goes_on(progress.starts as f64 / starts);
            wanted
        });
        if wanted { Portion::Done(found) } else { Portion::Stopped }
    }
}

/// Steps of one start for each length.
const STEPS: usize = 70;

/// A start has ended where its machines differ by less than this, of their range.
const ALIKE: f64 = 1e-5;

/// The best lengths that it comes across. `go_on` is asked after every machine; the best so far is the answer where it
/// says no.
///
/// # Errors
/// If what is asked for cannot be, or nothing is found.
pub fn search(
    machine: &Machine,
    asked: &LengthSearch,
    go_on: &mut dyn FnMut(Progress) -> bool,
) -> Result<Found, NoLengths> {
    check(machine, asked)?;
    let mut seen = Seen {
        machine,
        asked,
        go_on,
        stopped: false,
        machines: 0,
        ended: 0,
        best: None,
        nearest_misses: [f64::INFINITY; 2],
    };
    let present = asked.lengths.iter().map(|free| share(free.ends, length(machine.spec(), &free.name)));
    let present: Vec<f64> = present.collect();
    let mut draws = ChaCha8Rng::seed_from_u64(asked.seed);
    let mut ends = Vec::new();
    for start in 0..asked.starts {
        let drawn = present.iter().map(|_| (draws.next_u64() >> 11) as f64 / (1_u64 << 53) as f64).collect();
        let from = if start == 0 { present.clone() } else { drawn };
        ends.push(downhill(&mut seen, from));
        seen.ended += 1;
        if seen.stopped {
            break;
        }
    }
    let machines = seen.machines;
    let Some((value, lengths, placed)) = seen.best else {
        let why = match seen.asked.at(machine, &present) {
            Err(why) => why,
            Ok(_) => short(seen.nearest_misses),
        };
        return Err(NoLengths::None { machines, why });
    };
    let alike = ends.iter().filter(|end| (**end - value).abs() <= 1e-3 * value.abs()).count();
    Ok(Found { placed, lengths, starts: [ends.len(), alike], machines })
}

fn check(machine: &Machine, asked: &LengthSearch) -> Result<(), NoLengths> {
    if asked.lengths.is_empty() || asked.starts == 0 {
        return Err(NoLengths::Nothing("nothing to seek: want at least one length and one start"));
    }
    for (what, least) in [("reach", asked.least_reach), ("workspace", asked.least_workspace)] {
        if let Some(least) = least.filter(|least| !(least.is_finite() && *least >= 0.0)) {
            return Err(NoWeights::OutOfRange {
                what: format!("a {what} of at least"),
                value: least,
                want: "a number not below 0".into(),
            }
            .into());
        }
    }
    let known: Vec<&str> = machine.spec().own_lengths().map(|(name, _)| name).collect();
    for (i, FreeLength { name, ends: [from, to] }) in asked.lengths.iter().enumerate() {
        if !known.contains(&name.as_str()) {
            return Err(NoLengths::Unknown { name: name.clone(), known: known.join(", ") });
        }
        if !(*from > 0.0 && from < to && *to < 1e6) {
            return Err(NoLengths::Range { name: name.clone(), from: *from, to: *to });
        }
        if asked.lengths[..i].iter().any(|other| other.name == *name) {
            return Err(NoLengths::Twice(name.clone()));
        }
    }
    Ok(())
}

fn is_of(link: &Link, name: &str) -> bool {
    match &link.length {
        Length::Named(shared) => shared == name,
        Length::Metres(_) => link.name == name,
    }
}

fn length(spec: &MachineSpec, name: &str) -> f64 {
    spec.own_lengths().find(|(own, _)| *own == name).map(|(_, length)| length).unwrap_or_default()
}

fn share([from, to]: [f64; 2], x: f64) -> f64 {
    ((x - from) / (to - from)).clamp(0.0, 1.0)
}

/// From how many places a search starts that nobody has said more of.
const STARTS: usize = 6;

impl LengthSearch {
    /// As a brief has it for a machine, with what is to be least.
    pub fn of(brief: &Brief, machine: &Machine, objective: Objective) -> Self {
        let lengths = brief.length.iter().map(|(name, ends)| FreeLength { name: name.clone(), ends: *ends });
        Self {
            lengths: lengths.collect(),
            weighing: Weighing { objective, ..brief.weighing(machine) },
            anywhere: true,
            least_reach: brief.reach,
            least_workspace: brief.workspace,
            starts: STARTS,
            seed: 1,
        }
    }

    /// A machine with other lengths, as shares of their ranges; its links keep their mass per metre.
    fn changed(&self, machine: &Machine, shares: &[f64]) -> Result<(Vec<f64>, Machine), String> {
        let mut spec = machine.spec().clone();
        let mut lengths = Vec::with_capacity(shares.len());
        for (FreeLength { name, ends: [from, to] }, share) in self.lengths.iter().zip(shares) {
            let (was, now) = (length(&spec, name), from + (to - from) * share);
            let scale = now / was;
            for link in spec.links.iter_mut().filter(|link| is_of(link, name)) {
                link.mass *= scale;
                link.com *= scale;
                link.com_normal *= scale;
                link.inertia *= scale.powi(3);
                if let Length::Metres(x) = &mut link.length {
                    *x = now;
                }
            }
            if let Some(x) = spec.lengths.get_mut(name) {
                *x = now;
            }
            lengths.push(now);
        }
        Ok((lengths, Machine::new(spec).map_err(|why| why.to_string())?))
    }

    /// Counterweights for other lengths, and what misses; or why there are none.
    fn at(&self, machine: &Machine, shares: &[f64]) -> Result<(Vec<f64>, Placed, [f64; 2]), String> {
        let (lengths, changed) = self.changed(machine, shares)?;
        let mut misses = [(self.least_reach.unwrap_or(0.0) - changed.reach()).max(0.0), 0.0];
        let weighing = match self.anywhere {
            true => Weighing { sites: stretched(&self.weighing.sites, machine, &changed), ..self.weighing.clone() },
            false => self.weighing.clone(),
        };
        let placed = place(&changed, &weighing).map_err(|why| why.to_string())?;
        if let Some(least) = self.least_workspace {
            let area = plane_area(&placed.machine).unwrap_or(0.0);
            misses[1] = (least - area).max(0.0);
        }
        Ok((lengths, placed, misses))
    }
}

/// What the nearest machine misses, in words.
fn short([reach, area]: [f64; 2]) -> String {
    let missing = [(reach, "m", "reach"), (area, "m²", "workspace")];
    let missing = missing.iter().filter(|(by, ..)| *by > 0.0).map(|(by, unit, of)| format!("{by:.4} {unit} of {of}"));
    format!("the nearest is {} short", missing.collect::<Vec<_>>().join(" and "))
}

/// Places that go to the ends of their links, or as far behind them, go on to do so when these are longer or shorter.
fn stretched(sites: &[Sites], machine: &Machine, changed: &Machine) -> Vec<Sites> {
    let stretch = |site: &Sites| {
        let [was, is] = [machine, changed].map(|machine| machine.resolved_links()[site.link].length);
        let end = |at: f64| if at.abs() == was { is.copysign(at) } else { at };
        Sites { from: end(site.from), to: end(site.to), ..*site }
    };
    sites.iter().map(stretch).collect()
}

/// What a search has seen.
struct Seen<'a> {
    machine: &'a Machine,
    asked: &'a LengthSearch,
    go_on: &'a mut dyn FnMut(Progress) -> bool,
    stopped: bool,
    machines: usize,
    ended: usize,
    best: Option<(f64, Vec<f64>, Placed)>,
    /// What misses of reach, m, and of workspace, m², where both together are least.
    nearest_misses: [f64; 2],
}

impl Seen<'_> {
    fn value(&mut self, shares: &[f64]) -> f64 {
        self.machines += 1;
        let value = match self.asked.at(self.machine, shares) {
            Ok((lengths, placed, [0.0, 0.0])) => {
                let value = placed.value;
                if self.best.as_ref().is_none_or(|(best, ..)| value < *best) {
                    self.best = Some((value, lengths, placed));
                }
                value
            }
            Ok((.., misses)) => {
                let all = misses.iter().sum::<f64>();
                if all < self.nearest_misses.iter().sum::<f64>() {
                    self.nearest_misses = misses;
                }
                NO_ANSWER * (1.0 + all)
            }
            Err(_) => f64::INFINITY,
        };
        let best = self.best.as_ref().map_or(f64::INFINITY, |(best, ..)| *best);
        self.stopped |= !(self.go_on)(Progress { starts: self.ended, machines: self.machines, best });
        value
    }
}

/// Nelder–Mead within the box of all shares; the least value that it comes to.
fn downhill(seen: &mut Seen<'_>, from: Vec<f64>) -> f64 {
    let n = from.len();
    let mut corners: Vec<(f64, Vec<f64>)> = vec![(seen.value(&from), from.clone())];
    for i in 0..n {
        let mut corner = from.clone();
        corner[i] += if corner[i] > 0.5 { -0.25 } else { 0.25 };
        corners.push((seen.value(&corner), corner));
    }
    for _ in 0..STEPS * n {
        corners.sort_by(|a, b| a.0.total_cmp(&b.0));
        let wide = |i: usize| corners.iter().map(|(_, at)| (at[i] - corners[0].1[i]).abs()).fold(0.0, f64::max);
        if seen.stopped || (0..n).all(|i| wide(i) < ALIKE) {
            break;
        }
        let worst = corners[n].clone();
        let middle: Vec<f64> =
            (0..n).map(|i| corners[..n].iter().map(|(_, at)| at[i]).sum::<f64>() / n as f64).collect();
        // The worst corner, thrown over the middle of the others by so much.
        let thrown = |by: f64| -> Vec<f64> {
            middle.iter().zip(&worst.1).map(|(m, w)| (m + by * (m - w)).clamp(0.0, 1.0)).collect()
        };
        let over = thrown(1.0);
        let value = seen.value(&over);
        let better = match value {
            _ if value < corners[0].0 => {
                let far = thrown(2.0);
                let further = seen.value(&far);
                Some(if further < value { (further, far) } else { (value, over) })
            }
            _ if value < corners[n - 1].0 || (n == 1 && value < worst.0) => Some((value, over)),
            _ => {
                let near = thrown(if value < worst.0 { 0.5 } else { -0.5 });
                let nearer = seen.value(&near);
                (nearer < worst.0.min(value)).then_some((nearer, near))
            }
        };
        match better {
            Some(corner) => corners[n] = corner,
            None => {
                let best = corners[0].1.clone();
                for (value, at) in &mut corners[1..] {
                    at.iter_mut().zip(&best).for_each(|(x, best)| *x = 0.5 * (*x + best));
                    *value = seen.value(at);
                }
            }
        }
    }
    corners.iter().map(|(value, _)| *value).fold(f64::INFINITY, f64::min)
}
