//! Equations as plain text, for terminals and for text set in letters of one width.

use super::equation::{Equality, Equation};
use super::state::{DriveState, InstantKind};
use super::symbol::plain;
use super::written::{EquationCell, cells};
use stillbase_mechanics::machine::Machine;
use stillbase_settings::number::{fixed, fixed_or_scientific};

/// Formats the instant of a machine: its drives with angles, rates and accelerations.
pub fn state_text(machine: &Machine, state: &DriveState) -> String {
    let when = match state.when {
        InstantKind::Run(time) => format!("at {} s", fixed(time, 3)),
        InstantKind::Plan(time) => format!("{} s into the planned motion", fixed(time, 3)),
        InstantKind::Given => "in one pose".to_owned(),
    };
    let all = |values: &[f64]| values.iter().map(|x| fixed(*x, 4)).collect::<Vec<_>>().join(", ");
    let motion =
        format!("q {} rad · rates {} rad/s · accelerations {} rad/s²", all(&state.q), all(&state.qd), all(&state.qdd));
    format!("{}, {when}\n{motion}", machine.name())
}

/// Indent of lines, characters.
const INDENT: usize = 4;
/// Decimals of numbers.
const DECIMALS: usize = 6;

/// Formats an equation: number, title and meaning, then each line with its values below the symbols. A line of terms is at
/// most `width` characters long, behind its name.
pub fn equation_text(equation: &Equation, width: usize) -> String {
    let colon = if equation.form.is_empty() { "" } else { ": " };
    let mut text = format!("({}) {}{colon}{}\n", equation.number, equation.title, plain(equation.form));
    let mut say = |words: &str| text.push_str(&format!("{:INDENT$}{words}\n", ""));
    say(&plain(equation.says));
    equation.notes.iter().for_each(|note| say(&plain(note)));
    match &equation.lines {
        Err(why) => say(&format!("Not for this machine: {why}.")),
        Ok(lines) => {
            lines.iter().for_each(|line| text.push_str(&of_terms(line, width)));
            text.push_str(&format!("{:INDENT$}{}\n", "", verdict(equation)));
        }
    }
    text
}

/// States whether both sides of an equation agree.
fn verdict(equation: &Equation) -> String {
    let Some(worst) = equation.least_accurate() else { return String::new() };
    let off = worst.residual().abs();
    let unit = if worst.unit.is_empty() { String::new() } else { format!(" {}", worst.unit) };
    let name = if worst.name.is_empty() { String::new() } else { format!(" in {}", worst.name) };
    match equation.holds() {
        Some(true) if off == 0.0 => "holds: both sides are equal".into(),
        Some(true) => format!("holds: both sides differ by {off:.0e}{unit} at most"),
        _ if equation.is_choice() => "the centres of mass of this machine lie elsewhere, which is no fault".into(),
        _ => format!("does not hold: off by {}{unit}{name}", fixed_or_scientific(off, DECIMALS)),
    }
}

/// Formats a line of terms: symbols, and below each its number.
fn of_terms(line: &Equality, most: usize) -> String {
    let mut rows: Vec<[String; 2]> = Vec::new();
    let mut width = most;
    let cells = cells(line, DECIMALS);
    for (i, cell) in cells.iter().enumerate() {
        let [mut symbol, mut number] = both(cell);
        if i + 1 == cells.len() && !line.unit.is_empty() {
            number += &format!(" {}", line.unit);
        }
        let wide = symbol.chars().count().max(number.chars().count());
        for text in [&mut symbol, &mut number] {
            *text += &" ".repeat(wide - text.chars().count());
        }
        if width + wide + 1 > most {
            rows.push(Default::default());
            width = 0;
        }
        width += wide + 1;
        if let Some([symbols, numbers]) = rows.last_mut() {
            *symbols += &format!("{symbol} ");
            *numbers += &format!("{number} ");
        }
    }
    let label = |i: usize| if i == 0 { line.name.as_str() } else { "" };
    let both = rows.iter().enumerate().flat_map(|(i, [symbols, numbers])| [(label(i), symbols), ("", numbers)]);
    both.map(|(label, text)| format!("{:INDENT$}{label:<9}{}\n", "", text.trim_end())).collect()
}

fn both(cell: &EquationCell<'_>) -> [String; 2] {
    let joined = |sign: &str, text: &str| match (sign, text) {
        ("", text) => format!("  {text}"),
        (sign, "") => sign.to_owned(),
        (sign, text) => format!("{sign} {text}"),
    };
    [joined(cell.sign, &plain(cell.symbol)), joined(cell.number_sign, &cell.number)]
}
