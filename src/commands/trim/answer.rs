//! The answer of `stillbase trim`.

use serde::Serialize;
use stillbase::mechanics::machine::Machine;
use stillbase::mechanics::planar::Vector;
use stillbase::settings::number::{counted, fixed, shown};
use stillbase::study::trim::{Candidate, Fit, Made, Mended, Next, Rows, Taken, Unknown, Worth};

use super::super::output::{Table, yes};

/// What was found.
pub struct Asked<'a> {
    pub machine: &'a Machine,
    pub rows: &'a Rows,
    pub fit: &'a Fit,
    pub taken: &'a Taken,
    /// What a change is worth, if there is one.
    pub worth: Option<Worth>,
    pub next: &'a Next,
}

/// What a person wants to know.
#[derive(Serialize)]
pub struct Answer {
    machine: String,
    motions: usize,
    rows: usize,
    /// `samples` with their accelerations, or `windows`.
    made_of: &'static str,
    /// Half the width of a window, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    window: Option<f64>,
    /// Root mean square of force, N, and moment, N m, less offsets.
    size: [f64; 2],
    /// σ of what is not explained of them.
    noise: [f64; 2],
    /// As how many independent rows those of force and of moment count.
    effective_rows: [f64; 2],
    numbers: Vec<Number>,
    /// Groups of numbers that the data cannot tell apart.
    untold: Vec<Vec<String>>,
    changes: Vec<Changed>,
    #[serde(skip_serializing_if = "Option::is_none")]
    worth: Option<Gain>,
    next: Suggestion,
}

/// What the change does over these motions, or would do where it is not shown to help.
#[derive(Serialize)]
struct Gain {
    /// Root mean square before and after, N.
    force: [f64; 2],
    /// N m.
    moment: [f64; 2],
    /// Share by which the mean square becomes less, and half its interval of 95 %.
    gain: f64,
    half_width: f64,
    helps: bool,
}

/// One number of (7) and (8), or a momentum.
#[derive(Serialize)]
struct Number {
    name: String,
    unit: &'static str,
    nominal: f64,
    told: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    measured: Option<f64>,
    /// Half the interval of 95 %.
    #[serde(skip_serializing_if = "Option::is_none")]
    half_width: Option<f64>,
    /// Whether it is shown to differ from the machine's file, given what is taken of the others.
    off: bool,
    /// What it is taken to be for the change: as measured where it is off, else as in the file.
    taken: f64,
    /// Half the interval of 95 % of that; 0 of what is taken from the file.
    taken_half_width: f64,
    /// What the change leaves of it.
    #[serde(skip_serializing_if = "Option::is_none")]
    left: Option<f64>,
    #[serde(skip)]
    balance: bool,
}

/// One change.
#[derive(Serialize)]
struct Changed {
    key: String,
    from: f64,
    to: f64,
    /// Before it is rounded to what a person can set.
    exact: f64,
    unit: &'static str,
}

/// What to measure next.
#[derive(Serialize)]
struct Suggestion {
    /// The number that is least known.
    worst: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    half_width: Option<f64>,
    unit: &'static str,
    duration: f64,
    candidates: Vec<Tried>,
}

/// A motion that could be driven.
#[derive(Serialize)]
struct Tried {
    motion: String,
    amplitude: Vec<f64>,
    frequency: Vec<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    half_width: Option<f64>,
    narrower: f64,
}

/// As many motions are listed.
const LISTED: usize = 8;

fn some(x: f64) -> Option<f64> {
    Some(x).filter(|x| x.is_finite())
}

impl Answer {
    /// Of what was found, and what mends it if anything does.
    pub fn of(asked: &Asked, mended: Option<&Mended>) -> Self {
        let Asked { machine, rows, fit, taken, worth, next } = asked;
        let unknowns = &fit.unknowns;
        let number = |i: usize| {
            let what = unknowns.at(i);
            let (told, half) = (fit.told[i], fit.half_width(i));
            let part = |left: &Vector| if i.is_multiple_of(2) { left.re } else { left.im };
            let balance = i < unknowns.of_balance();
            Number {
                name: what.name(machine),
                unit: what.unit(),
                nominal: fit.nominal[i] + 0.0,
                told,
                measured: told.then_some(fit.measured[i] + 0.0),
                half_width: told.then_some(half),
                off: taken.off[i],
                taken: taken.values[i] + 0.0,
                taken_half_width: taken.half_widths[i],
                left: mended.filter(|_| balance).and_then(|m| m.left.get(i / 2)).map(|left| part(left) + 0.0),
                balance,
            }
        };
        let name = |i: &usize| unknowns.at(*i).name(machine);
        let changes = mended.into_iter().flat_map(|mended| &mended.changes).map(|change| Changed {
            key: change.key.clone(),
            from: change.from,
            to: change.to,
            exact: change.exact,
            unit: change.unit,
        });
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
            changes: changes.collect(),
            worth: worth.map(|worth| Gain {
                force: worth.force,
                moment: worth.moment,
                gain: worth.gain,
                half_width: worth.half_width,
                helps: worth.helps(),
            }),
            next: suggestion(machine, unknowns.at(next.worst), next),
        }
    }

    /// As a person reads it.
    pub fn text(&self, machine: &Machine) -> String {
        let how = match self.window {
            None => "measured accelerations".into(),
            Some(half) => format!("windows of ± {} s over the angles", fixed(half, 4)),
        };
        let mut text = format!(
            "{} · {}, {} · {how}\nforce  {} N rms, not explained {} N\nmoment {} N m rms, not explained {} N m\n\n",
            machine.name(),
            counted(self.motions, "motion"),
            counted(self.rows, "row"),
            shown(self.size[0], 4),
            shown(self.noise[0], 4),
            shown(self.size[1], 4),
            shown(self.noise[1], 4),
        );
        let mut table =
            Table::new(["", "machine", "measured", "± 95 %", "off", "taken as", "±", "after the change", "unit"]);
        for number in &self.numbers {
            let or = |x: Option<f64>, none: &str| x.map_or_else(|| none.into(), |x| shown(x, 6));
            table.row([
                number.name.clone(),
                fixed(number.nominal, 6),
                or(number.measured, "not told"),
                or(number.half_width, "–"),
                if number.told { yes(number.off).into() } else { "–".into() },
                fixed(number.taken, 6),
                if number.taken_half_width > 0.0 { shown(number.taken_half_width, 6) } else { "–".into() },
                number.left.filter(|_| number.balance).map_or_else(|| "–".into(), |x| fixed(x, 6)),
                number.unit.into(),
            ]);
        }
        text.push_str(&table.to_string());
        for group in &self.untold {
            text.push_str(&match group.as_slice() {
                [one] => format!("The data say nothing of {one}: it is taken from the machine's file.\n"),
                several => format!(
                    "The data cannot tell {} apart: they are taken from the machine's file.\n",
                    several.join(", ")
                ),
            });
        }
        text.push('\n');
        text.push_str(&self.change_text());
        text.push_str(&self.next.text());
        text
    }

    fn change_text(&self) -> String {
        let changed: Vec<&Changed> = self.changes.iter().filter(|c| c.to != c.from).collect();
        let worth = self.worth.as_ref().map(|worth| {
            let pair = |[from, to]: [f64; 2], unit: &str| format!("from {} to {} {unit}", shown(from, 4), shown(to, 4));
            let share = |x: f64| shown(100.0 * x, 1);
            format!(
                "force {} rms and moment {}, the mean square of both by {} ± {} %",
                pair(worth.force, "N"),
                pair(worth.moment, "N m"),
                share(worth.gain),
                share(worth.half_width)
            )
        });
        if changed.is_empty() {
            let off = self.numbers.iter().any(|number| number.balance && number.off);
            return match worth.filter(|_| off) {
                Some(worth) => {
                    format!(
                        "No change is shown to help. What is off could be mended so over these motions: {worth}.\n\n"
                    )
                }
                None => {
                    "Nothing to change: no line of (7) and (8) is shown to be off that a change could mend.\n\n".into()
                }
            };
        }
        let mut table = Table::new(["change", "before", "now", "by", "unit"]);
        for Changed { key, from, to, unit, .. } in changed {
            let grams = *unit == "kg";
            let (from, to, unit) = (1e3 * from, 1e3 * to, if grams { "g" } else { "mm" });
            table.row([key.clone(), fixed(from, 1), fixed(to, 1), format!("{:+.1}", to - from), unit.into()]);
        }
        let worth = worth.map_or_else(String::new, |worth| format!("Over these motions it lowers {worth}.\n"));
        format!("{table}Set to 0.1 g and 0.1 mm; what that leaves stands above, beside the intervals.\n{worth}\n")
    }
}

fn suggestion(machine: &Machine, worst: Unknown, next: &Next) -> Suggestion {
    let drive = |k: usize| machine.spec().drives[k].name.as_str();
    let words = |candidate: &Candidate| {
        let names: Vec<&str> = candidate.drives.iter().map(|(k, _)| drive(*k)).collect();
        let apart = candidate.frequency.windows(2).any(|w| w[0] != w[1]);
        let [rest @ .., last] = names.as_slice() else { return String::new() };
        let all = if rest.is_empty() { (*last).to_owned() } else { format!("{} and {last}", rest.join(", ")) };
        match candidate.drives.as_slice() {
            [_] => format!("drive {all} alone"),
            _ if apart => format!("drives {all}, each at its own frequency"),
            both if both.iter().any(|(_, sign)| *sign < 0.0) => format!("drives {all} against each other"),
            _ => format!("drives {all} in step"),
        }
    };
    let tried = next.candidates.iter().map(|candidate| Tried {
        motion: words(candidate),
        amplitude: candidate.amplitude.clone(),
        frequency: candidate.frequency.clone(),
        half_width: some(candidate.half_width),
        narrower: candidate.all,
    });
    Suggestion {
        worst: worst.name(machine),
        half_width: some(next.half_width),
        unit: worst.unit(),
        duration: next.duration,
        candidates: tried.collect(),
    }
}

impl Suggestion {
    fn text(&self) -> String {
        let Some(best) = self.candidates.first() else { return String::new() };
        let time = fixed(self.duration, 2);
        let now = match self.half_width {
            Some(half) => format!("Least known is {}, ± {} {}", self.worst, shown(half, 6), self.unit),
            None => format!("Nothing is known of {} yet", self.worst),
        };
        let then = match best.half_width {
            Some(half) => format!("would make that ± {} {}", shown(half, 6), self.unit),
            None => "would not tell it either".into(),
        };
        let mut text = format!("{now}; {time} s of {} {then}.\n\n", best.motion);
        let mut table = Table::new([
            format!("{time} s more of"),
            "amplitude rad".into(),
            "frequency Hz".into(),
            format!("{} ±", self.worst),
            "all narrower by".into(),
        ]);
        for tried in self.candidates.iter().take(LISTED) {
            let list = |all: &[f64]| all.iter().map(|x| fixed(*x, 2)).collect::<Vec<_>>().join(" ");
            let frequency = if tried.frequency.windows(2).all(|w| w[0] == w[1]) {
                list(&tried.frequency[..1])
            } else {
                list(&tried.frequency)
            };
            table.row([
                tried.motion.clone(),
                list(&tried.amplitude),
                frequency,
                tried.half_width.map_or_else(|| "not told".into(), |x| shown(x, 6)),
                fixed(tried.narrower, 2),
            ]);
        }
        text.push_str(&table.to_string());
        text
    }
}
