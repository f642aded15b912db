//! The sections of a report that hold words and numbers.

use super::Report;
use super::markup::escaped;
use super::table::{NO_VALUE, PageTable};
use stillbase_mechanics::machine::{Inertia, MachineSpec};
use stillbase_session::verdict::{Statements, Verdict};
use stillbase_settings::change;
use stillbase_settings::key::Key;
use stillbase_settings::number::{counted, fixed, nine_digits};
use stillbase_study::balance_constants::BalanceConstants;
use stillbase_study::comparison::{Comparison, DESIGN_COLUMNS, SUMMARY_COLUMNS, Summary, SummaryColumn};

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
            escaped(&verdict.sentence())
        );
        text += "<table>\n<tbody>\n";
        for (subject, statement) in Statements::of(self.run, self.frame).named() {
            text += &format!(
                "<tr><td>{subject}</td><td class=\"{}\">{}</td><td>{}</td></tr>\n",
                statement.outcome.name(),
                escaped(&statement.words),
                escaped(&statement.why)
            );
        }
        text + "</tbody>\n</table>\n"
    }

    /// Returns the peaks and the means of the run.
    pub(super) fn results(&self) -> String {
        let (scenario, totals, peaks) = (self.run.scenario(), &self.frame.totals, &self.frame.peaks);
        let verdict = Verdict::of(scenario, self.frame);
        let mut table = PageTable::new(1, ["", "value", "unit"]);
        let mut row = |name: String, value: f64, decimals: usize, unit: &str| {
            table.row([name, fixed(value, decimals), unit.into()]);
        };
        row("duration".into(), self.frame.time, 3, "s");
        for (k, torque) in peaks.torque.iter().enumerate() {
            row(format!("peak torque of drive {} in the run, |τ_{}|", k + 1, k + 1), *torque, TORQUE_DECIMALS, "N m");
        }
        row("peak moment on the base, |n_B|".into(), verdict.arm_moment, REACTION_DECIMALS, "N m");
        row("root mean square of n_B".into(), totals.arm_moment_rms(), REACTION_DECIMALS, "N m");
        if let Some(past_wheel) = verdict.past_wheel {
            row("peak moment past the wheel".into(), past_wheel, REACTION_DECIMALS, "N m");
        }
        row("peak dynamic force on the base, |f_B|".into(), verdict.force, REACTION_DECIMALS, "N");
        row("root mean square of f_B".into(), totals.force_rms(), REACTION_DECIMALS, "N");
        row("the base shifts by".into(), totals.shift, REACTION_DECIMALS, "m");
        row("the base turns by".into(), totals.base_angle, REACTION_DECIMALS, "rad");
        if verdict.has_target {
            row("end effector from its target at the end".into(), verdict.target_distance, REACTION_DECIMALS, "m");
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
                let default = if key.default == Key::REQUIRED { NO_VALUE } else { key.default };
                table.row([path, shortened(&typed), key.unit().into(), default.into(), key.meaning.into()]);
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
            escaped(&format!("{summary}Mass {} kg, reach {} m.", fixed(inertia.mass(), 3), fixed(machine.reach(), 3)))
        );
        let heads = ["link", "drive", "length m", "mass kg", "inertia kg m²", "centre of mass m"];
        let mut links = PageTable::new(2, heads);
        for (link, part) in machine.links().iter().zip(machine.resolved_links()) {
            let numbers = [part.length, link.mass, link.inertia, link.com].map(nine_digits);
            links.row([link.name.clone(), link.drive.clone()].into_iter().chain(numbers));
        }
        text += &links.html();
        text += &lengths(spec);
        text += &counterweights(spec);
        let mut drives = PageTable::new(1, ["drive", "g kg m", "H kg m²", "D kg m²", "λ"]);
        for (k, drive) in spec.drives.iter().enumerate() {
            let constants = [&balance.gamma_coefficients, &balance.h, &balance.d, &balance.lambda];
            let constants = constants.map(|of| of.get(k).map_or_else(String::new, |x| fixed(*x, 9)));
            drives.row([drive.name.clone()].into_iter().chain(constants));
        }
        text + &drives.html()
    }
}

fn lengths(spec: &MachineSpec) -> String {
    let mut table = PageTable::new(1, ["shared length", "m"]);
    spec.lengths.iter().for_each(|(name, length)| table.row([name.clone(), nine_digits(*length)]));
    table.html()
}

fn counterweights(spec: &MachineSpec) -> String {
    let mut table = PageTable::new(1, ["counterweight of link", "mass kg", "along it m", "radius m"]);
    for weight in &spec.counterweights {
        table.row([weight.link.clone()].into_iter().chain([weight.mass, weight.at, weight.radius].map(nine_digits)));
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

/// A column of the table of runs.
struct Column {
    /// Its index among all columns.
    place: usize,
    head: &'static str,
    unit: &'static str,
    decimals: usize,
}

impl Column {
    fn of<T>(place: usize, column: &SummaryColumn<T>) -> Self {
        let SummaryColumn { head, unit, decimals, .. } = *column;
        Self { place, head, unit, decimals }
    }
}

/// Returns the table of runs in the order on display; columns without a value are left out.
pub(super) fn compared(comparison: &Comparison) -> String {
    let entries = comparison.entries();
    let runs = || entries.iter().filter_map(|entry| Some(&entry.outcome.as_ref().ok()?.summary));
    let moves = runs().any(|run: &Summary| run.base_shift > 0.0 || run.base_tilt > 0.0);
    let has_value = |c: &SummaryColumn| runs().any(|run| (c.value)(run).is_some());
    let is_shown = |c: &SummaryColumn| has_value(c) && (moves || !matches!(c.key, "base_shift" | "base_tilt"));
    let of_runs = SUMMARY_COLUMNS.iter().enumerate().filter(|(_, c)| is_shown(c)).map(|(i, c)| Column::of(i, c));
    let designs = if comparison.has_designs() { &DESIGN_COLUMNS[..] } else { &[] };
    let of_designs = designs.iter().enumerate().map(|(i, c)| Column::of(SUMMARY_COLUMNS.len() + i, c));
    let columns: Vec<Column> = of_runs.chain(of_designs).collect();
    let heads = columns.iter().map(|column| match column.unit {
        "1" => column.head.to_owned(),
        unit => format!("{} {unit}", column.head),
    });
    let mut table = PageTable::new(1, ["run".to_owned()].into_iter().chain(heads).chain(["reactionless".to_owned()]));
    let mut refused = String::new();
    for i in comparison.order() {
        let entry = &entries[i];
        match &entry.outcome {
            Ok(run) => {
                let value = |column: &Column| entry.value(column.place).map(|x| fixed(x, column.decimals));
                let cells = columns.iter().map(|column| value(column).unwrap_or_else(|| NO_VALUE.into()));
                let verdict = run.summary.verdict.answer();
                table.row([entry.title.clone()].into_iter().chain(cells).chain([verdict]));
            }
            Err(why) => refused += &format!("<p>{}</p>\n", escaped(&format!("{}: {why}", entry.title))),
        }
    }
    table.html() + &refused
}
