//! [`TrimReport`]: what a person wants to know of a measurement.

use serde::Serialize;

use super::fit::Fit;
use super::mend::{Change, Mended};
use super::next::{Candidate, Next};
use super::rows::{Made, Rows};
use super::taken::Taken;
use super::worth::Worth;
use crate::mechanics::machine::Machine;
use crate::mechanics::planar::Vector;
use crate::settings::number::{fixed, shown};

/// What a measurement says of a machine, what mends it, and what to measure next.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TrimReport {
    /// The machine's name.
    pub machine: String,
    /// How many motions were measured.
    pub motions: usize,
    /// How many rows they give.
    pub rows: usize,
    /// `samples` with their accelerations, or `windows`.
    pub made_of: &'static str,
    /// Half the width of a window, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub window: Option<f64>,
    /// Root mean square of force, N, and moment, N m, less offsets.
    pub size: [f64; 2],
    /// σ of what is not explained of them.
    pub noise: [f64; 2],
    /// As how many independent rows those of force and of moment count.
    pub effective_rows: [f64; 2],
    /// Every line of (7) and (8), and the momenta.
    pub numbers: Vec<Number>,
    /// Groups of numbers that the data cannot tell apart.
    pub untold: Vec<Vec<String>>,
    /// What changes.
    pub changes: Vec<Change>,
    /// What the change does over these motions, or would do where it is not shown to help.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub worth: Option<Gain>,
    /// What to measure next.
    pub next: Suggestion,
}

/// What a change is worth, and whether it is shown to help.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Gain {
    /// What it is worth.
    #[serde(flatten)]
    pub worth: Worth,
    /// Whether the interval of the gain lies above 0.
    pub helps: bool,
}

/// One number of (7) and (8), or a momentum.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Number {
    /// Which.
    pub name: String,
    /// Its unit.
    pub unit: &'static str,
    /// In the machine's file.
    pub nominal: f64,
    /// Whether the data say anything of it.
    pub told: bool,
    /// As measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measured: Option<f64>,
    /// Half the interval of 95 %.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub half_width: Option<f64>,
    /// Whether it is shown to differ from the machine's file, given what is taken of the others.
    pub off: bool,
    /// What it is taken to be for the change: as measured where it is off, else as in the file.
    pub taken: f64,
    /// Half the interval of 95 % of that; 0 of what is taken from the file.
    pub taken_half_width: f64,
    /// What the change leaves of it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub left: Option<f64>,
    /// Whether it is one of (7) and (8).
    #[serde(skip)]
    pub balance: bool,
}

/// What to measure next.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Suggestion {
    /// The number that is least known.
    pub worst: String,
    /// Half its interval of 95 % now; none if nothing is known of it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub half_width: Option<f64>,
    /// Its unit.
    pub unit: &'static str,
    /// How long each motion takes, s.
    pub duration: f64,
    /// The best first.
    pub candidates: Vec<Tried>,
}

impl Suggestion {
    /// What is least known, and what the best motion would make of that; none if there is no motion.
    pub fn words(&self) -> Option<String> {
        let best = self.candidates.first()?;
        let now = match self.half_width {
            Some(half) => format!("Least known is {}, ± {} {}", self.worst, shown(half, 6), self.unit),
            None => format!("Nothing is known of {} yet", self.worst),
        };
        let then = match best.candidate.half_width {
            half if half.is_finite() => format!("would make that ± {} {}", shown(half, 6), self.unit),
            _ => "would not tell it either".into(),
        };
        Some(format!("{now}; {} s of {} {then}.", fixed(self.duration, 2), best.motion))
    }
}

/// A motion that could be driven.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tried {
    /// In words.
    pub motion: String,
    /// How, and what it would tell.
    #[serde(flatten)]
    pub candidate: Candidate,
}

impl TrimReport {
    /// The numbers that change.
    pub fn changed(&self) -> impl Iterator<Item = &Change> {
        self.changes.iter().filter(|change| change.to != change.from)
    }

    /// Why nothing changes, in words, where nothing does.
    pub fn why_no_change(&self) -> String {
        let off = self.numbers.iter().any(|number| number.balance && number.off);
        match self.worth.filter(|_| off) {
            Some(gain) => {
                let worth = gain.worth.words();
                format!("No change is shown to help. What is off could be mended so over these motions: {worth}.")
            }
            None => "Nothing to change: no line of (7) and (8) is shown to be off that a change could mend.".into(),
        }
    }

    /// What the data cannot tell, a sentence for each group of numbers.
    pub fn untold_words(&self) -> impl Iterator<Item = String> {
        self.untold.iter().map(|group| match group.as_slice() {
            [one] => format!("The data say nothing of {one}: it is taken from the machine's file."),
            several => {
                format!("The data cannot tell {} apart: they are taken from the machine's file.", several.join(", "))
            }
        })
    }

    /// Of what was found, and of what mends it and is worth it, if anything does.
    pub(super) fn of(
        machine: &Machine,
        rows: &Rows,
        (fit, taken): (&Fit, &Taken),
        (mended, worth): (Option<&Mended>, Option<Worth>),
        next: &Next,
    ) -> Self {
        let unknowns = &fit.unknowns;
        let number = |i: usize| {
            let what = unknowns.at(i);
            let told = fit.told[i];
            let part = |left: &Vector| if i.is_multiple_of(2) { left.re } else { left.im };
            let balance = i < unknowns.of_balance();
            Number {
                name: what.name(machine),
                unit: what.unit(),
                nominal: fit.nominal[i] + 0.0,
                told,
                measured: told.then_some(fit.measured[i] + 0.0),
                half_width: told.then_some(fit.half_width(i)),
                off: taken.off[i],
                taken: taken.values[i] + 0.0,
                taken_half_width: taken.half_widths[i],
                left: mended.filter(|_| balance).and_then(|m| m.left.get(i / 2)).map(|left| part(left) + 0.0),
                balance,
            }
        };
        let name = |i: &usize| unknowns.at(*i).name(machine);
        let worst = unknowns.at(next.worst);
        let tried = |candidate: &Candidate| Tried { motion: candidate.words(machine), candidate: candidate.clone() };
        Self {
            machine: machine.name().to_owned(),
            motions: rows.motions.len(),
            rows: rows.count(),
            made_of: if rows.made == Made::Samples { "samples" } else { "windows" },
            window: if let Made::Windows { half, .. } = rows.made { Some(half) } else { None },
            size: fit.size,
            noise: fit.noise,
            effective_rows: fit.effective,
            numbers: (0..unknowns.count()).map(number).collect(),
            untold: fit.confused.iter().map(|group| group.iter().map(name).collect()).collect(),
            changes: mended.map_or_else(Vec::new, |mended| mended.changes.clone()),
            worth: worth.map(|worth| Gain { worth, helps: worth.helps() }),
            next: Suggestion {
                worst: worst.name(machine),
                half_width: Some(next.half_width).filter(|half| half.is_finite()),
                unit: worst.unit(),
                duration: next.duration,
                candidates: next.candidates.iter().map(tried).collect(),
            },
        }
    }
}
