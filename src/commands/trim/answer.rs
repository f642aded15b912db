//! The answer of `stillbase trim` as text.

use stillbase_mechanics::machine::Machine;
use stillbase_settings::number::{counted, fixed, fixed_or_scientific};
use stillbase_study::trim::{ExcitationReport, MeasuredUnknown, OrbitReport, ParameterChange, Suggestion, TrimReport};

use super::super::output::{TextTable, yes};

/// Maximum number of motions in the list.
const MAX_LISTED_MOTIONS: usize = 8;

/// Formats the report as text.
pub fn text(report: &TrimReport, machine: &Machine) -> String {
    let how = match report.window {
        None => "measured accelerations".into(),
        Some(half) => format!("windows of ± {} s over the angles", fixed(half, 4)),
    };
    let mut text = format!(
        "{} · {}, {} · {how}\nforce  {} N rms, not explained {} N\nmoment {} N m rms, not explained {} N m\n\n",
        machine.name(),
        counted(report.motions, "motion"),
        counted(report.rows, "row"),
        fixed_or_scientific(report.size[0], 4),
        fixed_or_scientific(report.noise[0], 4),
        fixed_or_scientific(report.size[1], 4),
        fixed_or_scientific(report.noise[1], 4),
    );
    let mut table =
        TextTable::new(["", "machine", "measured", "± 95 %", "off", "taken as", "±", "after the change", "unit"]);
    for number in &report.numbers {
        let taken = [
            fixed(number.taken, 6),
            if number.taken_half_width > 0.0 { fixed_or_scientific(number.taken_half_width, 6) } else { "–".into() },
            number.residual.filter(|_| number.balance).map_or_else(|| "–".into(), |x| fixed(x, 6)),
        ];
        table.row(measured(&number.unknown).into_iter().chain(taken).chain([number.unknown.unit.into()]));
    }
    text.push_str(&table.to_string());
    for words in report.untold_words() {
        text.push_str(&words);
        text.push('\n');
    }
    text.push('\n');
    text.push_str(&change_text(report));
    text.push_str(&suggestion_text(&report.next));
    text
}

fn change_text(report: &TrimReport) -> String {
    let changed: Vec<&ParameterChange> = report.changed().collect();
    let worth = report.worth.as_ref().map(|gain| gain.worth.words());
    if changed.is_empty() {
        return format!("{}\n\n", report.why_no_change());
    }
    let mut table = TextTable::new(["change", "before", "now", "by", "unit"]);
    for ParameterChange { key, from, to, unit, .. } in changed {
        let grams = *unit == "kg";
        let (from, to, unit) = (1e3 * from, 1e3 * to, if grams { "g" } else { "mm" });
        table.row([key.clone(), fixed(from, 1), fixed(to, 1), format!("{:+.1}", to - from), unit.into()]);
    }
    let worth = worth.map_or_else(String::new, |worth| format!("Over these motions it lowers {worth}.\n"));
    format!("{table}Rounded to 0.1 g and 0.1 mm; the imbalance after the change is in the table above.\n{worth}\n")
}

/// Returns the cells of an unknown up to whether it is off.
fn measured(number: &MeasuredUnknown) -> [String; 5] {
    let or = |x: Option<f64>, none: &str| x.map_or_else(|| none.into(), |x| fixed_or_scientific(x, 6));
    [
        number.name.clone(),
        fixed(number.nominal, 6),
        or(number.measured, "not told"),
        or(number.half_width, "–"),
        if number.identifiable { yes(number.off).into() } else { "–".into() },
    ]
}

/// Formats the report of a machine in orbit as text.
pub fn orbit_text(report: &OrbitReport) -> String {
    let mut table = TextTable::new(["", "machine", "measured", "± 95 %", "off", "± if known is 1 % off", "unit"]);
    for number in &report.numbers {
        let known = number.per_percent.map_or_else(|| "–".into(), |x| fixed_or_scientific(x, 6));
        table.row(measured(number).into_iter().chain([known, number.unit.into()]));
    }
    let lines = |words: Vec<String>| words.into_iter().map(|words| format!("{words}\n")).collect::<String>();
    let doubts = lines(report.doubts());
    let untold = lines(report.untold_words().chain(report.advice.clone()).collect());
    format!(
        "{} · {}, {} · rates of a base that floats\n{}\n{doubts}\n{table}{}\n{untold}\n{}",
        report.machine,
        counted(report.motions, "motion"),
        counted(report.rows, "row"),
        report.rate_words(),
        OrbitReport::KNOWN_WORDS,
        suggestion_text(&report.next),
    )
}

fn suggestion_text(next: &Suggestion) -> String {
    let Some(words) = next.words() else { return String::new() };
    let (time, mut text) = (fixed(next.duration, 2), format!("{words}\n\n"));
    let mut table = TextTable::new([
        format!("{time} s more of"),
        "amplitude rad".into(),
        "frequency Hz".into(),
        format!("{} ±", next.worst),
        "all narrower by".into(),
    ]);
    for ExcitationReport { motion, candidate } in next.candidates.iter().take(MAX_LISTED_MOTIONS) {
        let list = |all: &[f64]| all.iter().map(|x| fixed(*x, 2)).collect::<Vec<_>>().join(" ");
        let alike = candidate.frequency.windows(2).all(|w| w[0] == w[1]);
        let frequencies = if alike { &candidate.frequency[..1] } else { &candidate.frequency };
        let half = candidate.half_width;
        table.row([
            motion.clone(),
            list(&candidate.amplitude),
            list(frequencies),
            if half.is_finite() { fixed_or_scientific(half, 6) } else { "not told".into() },
            fixed(candidate.all, 2),
        ]);
    }
    text.push_str(&table.to_string());
    text
}
