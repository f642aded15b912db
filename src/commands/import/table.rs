//! The answer of `stillbase import` as a table.

use stillbase_settings::number::{counted, fixed};
use stillbase_study::import::{ComparedNumber, ImportedMotion};

use crate::output::{TextTable, yes};

/// Formats the given and the proposed motion side by side.
pub fn table(answer: &ImportedMotion) -> String {
    let usual = if answer.content == "tip" { "minimum norm" } else { "as given" };
    let mut table = TextTable::new(["", usual, "proposed", ""]).with_words(3);
    for line in answer.lines() {
        let ComparedNumber { name, unit, given, proposed, decimals, of_both } = line;
        let none = if of_both { "-" } else { "" };
        let [given, proposed] = [given, proposed].map(|x| x.map_or_else(|| none.into(), |x| fixed(x, decimals)));
        table.row([name, given, proposed, unit.into()]);
    }
    let way = answer.proposal.as_ref().map(|p| {
        let (kept, clean, still) = (p.keeps(), yes(p.reactionless), yes(p.turns_no_base));
        let b = if p.holds_b() { format!("b = {} rad, ", fixed(p.b, 6)) } else { String::new() };
        format!("\nproposed: {b}{kept}: {}\nreactionless: {clean}\nturns no base: {still}\n", p.why)
    });
    let smoothed = answer
        .smoothed_at
        .zip(answer.smoothed_by)
        .map(|(at, by)| format!("smoothed at {} Hz, samples moved by up to {}\n", fixed(at, 3), fixed(by, 9)));
    format!(
        "{} over {} s\n{}{}{}",
        counted(answer.samples, "sample"),
        fixed(answer.duration, 6),
        smoothed.unwrap_or_default(),
        table.to_string().trim_start_matches('\n'),
        way.unwrap_or_default()
    )
}
