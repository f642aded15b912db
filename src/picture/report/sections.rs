//! The sections of a report that hold words and numbers.

use super::Report;
use super::markup::escaped;
use super::quantity::headed;
use super::table::{NO_VALUE, PageTable};
use crate::columns::RunColumn;
use crate::notation::Notation;
use stillbase_mechanics::machine::{Counterweight, Inertia, MachineSpec};
use stillbase_session::verdict::{Statements, Verdict};
use stillbase_settings::change;
use stillbase_settings::key::Key;
use stillbase_settings::number::{counted, fixed, nine_digits, subscript};
use stillbase_study::balance_constants::BalanceConstants;
use stillbase_study::comparison::Comparison;

/// Decimals of torques, and of reactions and motions of the base, as on the command line.
const TORQUE_DECIMALS: usize = 6;
const REACTION_DECIMALS: usize = 9;

impl Report<'_> {
    /// Returns the verdict in a sentence and the three statements.
    pub(super) fn verdicts(&self) -> String {
        let scenario = self.run.scenario();
        let verdict = Verdict::of(scenario, self.frame);
        let machine = &scenario.machine;
        let mut text = format!(
            "<p class=\"dim\">Scenario {} with the machine {}, {}</p>\n<p>{}</p>\n",
            escaped(&scenario.name),
            escaped(machine.name()),
            escaped(&counted(machine.drives(), "drive")),
            escaped(&self.notation.sentence(&verdict.sentence()))
        );
        text += "<table>\n<tbody>\n";
        for (subject, statement) in Statements::of(self.run, self.frame).named() {
            text += &format!(
                "<tr><td>{subject}</td><td class=\"{}\">{}</td><td>{}</td></tr>\n",
                statement.outcome.name(),
                escaped(&self.notation.sentence(&statement.words)),
                escaped(&self.notation.sentence(&statement.why))
            );
        }
        text + "</tbody>\n</table>\n"
    }

    /// Returns the peaks and the means of the run.
    pub(super) fn results(&self) -> String {
        let (scenario, totals, peaks) = (self.run.scenario(), &self.frame.totals, &self.frame.peaks);
        let verdict = Verdict::of(scenario, self.frame);
        let mut table = PageTable::new(1, ["", "value", "unit"]);
        let notation = self.notation;
        let mut row = |(term, symbol): (&str, &str), value: f64, decimals: usize, unit: &str| {
            let (value, unit) = notation.fixed(value, decimals, unit);
            table.row([notation.name(term, symbol), value, unit.into()]);
        };
        row(("duration", ""), self.frame.time, 3, "s");
        let drives = &scenario.machine.spec().drives;
        for (k, torque) in peaks.torque.iter().enumerate() {
            let number = (k + 1).to_string();
            let drive = drives.get(k).map_or(number.as_str(), |drive| &drive.name);
            let (term, symbol) =
                (format!("peak torque of drive {drive} in the run"), format!("|τ{}|", subscript(k + 1)));
            row((&term, &symbol), *torque, TORQUE_DECIMALS, "N m");
        }
        let mean = "root mean square of the";
        row(("peak moment on the base", "|n_B|"), verdict.arm_moment, REACTION_DECIMALS, "N m");
        row((&format!("{mean} moment on the base"), "n rms"), totals.arm_moment_rms(), REACTION_DECIMALS, "N m");
        if let Some(past_wheel) = verdict.past_wheel {
            row(("peak moment past the wheel", ""), past_wheel, REACTION_DECIMALS, "N m");
        }
        row(("peak dynamic force on the base", "|f_B|"), verdict.force, REACTION_DECIMALS, "N");
        row((&format!("{mean} force on the base"), "f rms"), totals.force_rms(), REACTION_DECIMALS, "N");
        if scenario.base.moves() {
            row(("the base shifts by", ""), totals.shift, REACTION_DECIMALS, "m");
            row(("the base turns by up to", ""), totals.base_angle, REACTION_DECIMALS, "rad");
        }
        if let Some(attitude) = verdict.attitude {
            row(("angle of the base at the end", ""), attitude.end, REACTION_DECIMALS, "rad");
        }
        if let Some(wheel) = verdict.wheel {
            row(("peak momentum of the wheel", ""), wheel.momentum, REACTION_DECIMALS, "N m s");
            row(("peak torque of the wheel", "|τ_w|"), wheel.torque, REACTION_DECIMALS, "N m");
        }
        if let Some(distance) = verdict.target_distance {
            row(("end effector from its target at the end", ""), distance, REACTION_DECIMALS, "m");
        }
        table.html()
    }

    /// Returns the settings of the task that differ from their defaults.
    pub(super) fn task(&self) -> String {
        self.changed(|key| key.part() == "task")
    }

    /// Returns the other settings that differ from their defaults.
    pub(super) fn settings(&self) -> String {
        self.changed(|key| key.part() != "task" && key.default != Key::REQUIRED)
    }

    fn changed(&self, is_wanted: impl Fn(&Key) -> bool) -> String {
        let mut table = PageTable::new(1, ["setting", "value", "unit", "default", "meaning"]);
        for (path, key, value) in self.run.scenario().settings() {
            let typed = change::typed(&value);
            let is_default = typed == change::DEFAULT_WORD || change::same_value(&value, &change::value(key.default));
            if is_wanted(key) && !is_default {
                // Lists of mixed units, such as m and rad, stay in SI units.
                let unit = if key.unit_of_each().is_empty() { key.unit() } else { key.unit_of_each() };
                let shown = self.notation.shown_unit(unit).filter(|_| change::is_of_numbers(&value));
                let factor = shown.map(|shown| shown.factor);
                let unit = shown.map_or(unit, |shown| shown.name);
                let default = match key.default {
                    Key::REQUIRED => NO_VALUE.to_owned(),
                    default => change::typed_short(&change::value(default), factor),
                };
                let typed = shortened(&change::typed_short(&value, factor));
                table.row([path, typed, unit.into(), default, key.meaning.into()]);
            }
        }
        table.html()
    }

    /// Returns masses, lengths and balance of the machine.
    pub(super) fn machine(&self) -> String {
        let machine = &self.run.scenario().machine;
        let (spec, inertia) = (machine.spec(), Inertia::of(machine));
        let balance = BalanceConstants::of(&inertia);
        let summary = match spec.summary.trim().trim_end_matches('.') {
            "" => String::new(),
            summary => format!("{summary}. "),
        };
        let mut text = format!(
            "<p>{}</p>\n",
            escaped(&format!(
                "{summary}Mass {} kg{}, {}.",
                fixed(inertia.mass(), 3),
                if spec.counterweights.is_empty() { "" } else { " with its counterweights" },
                self.notation.sentence(&format!("reach {} m", fixed(machine.reach(), 3)))
            ))
        );
        if !spec.counterweights.is_empty() {
            text += "<p>The masses, inertias and centres of mass of links are without counterweights.</p>\n";
        }
        let notation = self.notation;
        let length = |x: f64| notation.nine_digits(x, "m");
        let heads = [notation.head("length", "m"), "mass (kg)".into(), "inertia (kg m²)".into()];
        let heads = ["link", "drive"].map(String::from).into_iter().chain(heads);
        let mut links = PageTable::new(2, heads.chain([notation.head("centre of mass", "m")]));
        for (link, part) in spec.links.iter().zip(machine.resolved_links()) {
            let numbers = [length(part.length), nine_digits(link.mass), nine_digits(link.inertia), length(link.com)];
            links.row([link.name.clone(), link.drive.clone()].into_iter().chain(numbers));
        }
        text += &links.html();
        text += &lengths(spec, notation);
        text += &counterweights(spec, notation);
        let constant = |term, symbol, unit| notation.head(&notation.name(term, symbol), unit);
        let heads = [
            "drive".to_owned(),
            constant("first moment", "g", "kg m"),
            constant("diagonal of the mass matrix", "H", "kg m²"),
            constant("angular momentum per rate", "D", "kg m²"),
            constant("coefficient of b", "λ", ""),
        ];
        let mut drives = PageTable::new(1, heads);
        for (k, drive) in spec.drives.iter().enumerate() {
            let constants = [&balance.gamma_coefficients, &balance.h, &balance.d, &balance.lambda];
            let constants = constants.map(|of| of.get(k).map_or_else(String::new, |x| fixed(*x, 9)));
            drives.row([drive.name.clone()].into_iter().chain(constants));
        }
        text + &drives.html()
    }
}

fn lengths(spec: &MachineSpec, notation: Notation) -> String {
    let mut table = PageTable::new(1, ["shared length", notation.unit_name("m")]);
    spec.lengths.iter().for_each(|(name, length)| table.row([name.clone(), notation.nine_digits(*length, "m")]));
    table.html()
}

/// Returns the table of counterweights, counted from 1 as in their settings.
fn counterweights(spec: &MachineSpec, notation: Notation) -> String {
    let heads = ["counterweight", "on link", "mass (kg)"].map(String::from).into_iter();
    let sizes = Counterweight::sizes_of(&spec.counterweights);
    let lengths = ["place along it", "left of its axis"].into_iter().chain(sizes.clone());
    let mut table = PageTable::new(2, heads.chain(lengths.map(|name| notation.head(name, "m"))));
    for (i, weight) in spec.counterweights.iter().enumerate() {
        let size = |name: &&str| weight.sizes().find(|(own, _)| own == name).map_or(0.0, |(_, size)| size);
        let lengths = [weight.at, weight.across].into_iter().chain(sizes.iter().map(size));
        let names = [(i + 1).to_string(), weight.link.clone(), nine_digits(weight.mass)];
        table.row(names.into_iter().chain(lengths.map(|x| notation.nine_digits(x, "m"))));
    }
    table.html()
}

/// Maximum length of a value, characters: samples of a motion may have thousands.
const MAX_VALUE_CHARS: usize = 300;

fn shortened(value: &str) -> String {
    match value.char_indices().nth(MAX_VALUE_CHARS) {
        Some((end, _)) => format!("{} … ({} characters in all)", &value[..end], value.chars().count()),
        None => value.to_owned(),
    }
}

/// Returns the table of runs in the order on display; columns without a value are left out.
pub(super) fn compared(comparison: &Comparison, notation: Notation) -> String {
    let entries = comparison.entries();
    let columns = RunColumn::all(comparison, notation);
    let heads = columns.iter().map(|column| headed(column.head, column.unit()));
    let names = ["number", "run"].map(String::from).into_iter();
    let mut table = PageTable::new(2, names.chain(heads).chain(["reactionless".to_owned()]));
    let mut refused = String::new();
    for i in comparison.order() {
        let entry = &entries[i];
        match &entry.outcome {
            Ok(run) => {
                let value = |column: &RunColumn| column.value(entry).map(|x| fixed(x, column.format.decimals));
                let cells = columns.iter().map(|column| value(column).unwrap_or_else(|| NO_VALUE.into()));
                let verdict = run.summary.verdict.answer();
                table.row([(i + 1).to_string(), entry.title.clone()].into_iter().chain(cells).chain([verdict]));
            }
            Err(why) => {
                let why = format!("{}: {}", entry.title, notation.sentence(&why.to_string()));
                refused += &format!("<p>{}</p>\n", escaped(&why));
            }
        }
    }
    table.html() + &refused
}
