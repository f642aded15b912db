//! `stillbase design --keep`

use clap::Args;
use serde::Serialize;
use stillbase::mechanics::balance::{Adjusted, Hold, Keep, NotKept, Parameter, Quantity, keep};
use stillbase::mechanics::machine::{Inertia, Machine};
use stillbase::planning::Motion;
use stillbase::settings::number::{fixed, significant};
use stillbase::study::measures::Measures;

use super::super::check::Balance;
use super::super::failure::Failure;
use super::super::output::Table;
use super::measures;

/// What may change, and how far.
#[derive(Args)]
pub struct KeepArguments {
    /// Change as little as possible instead: centres of mass along the links are free, from where they are, with the
    /// penalties as weights; everything else stays
    #[arg(long)]
    pub keep: bool,
    /// Leave these where they are: 3.com is link.3.com
    #[arg(long, value_name = "KEY,…", requires = "keep", value_delimiter = ',')]
    fix: Vec<String>,
    /// Change these, too: 4.mass, 4.com_normal, counterweight.1.mass, counterweight.1.at; a kilogram weighs as much as a
    /// metre with penalty 1
    #[arg(long, value_name = "KEY,…", requires = "keep", value_delimiter = ',')]
    free: Vec<String>,
    /// Change this one only from one value to another, m or kg
    #[arg(long, value_name = "KEY=LO,HI", requires = "keep", value_parser = bound, allow_hyphen_values = true)]
    bound: Vec<(String, [f64; 2])>,
}

fn bound(text: &str) -> Result<(String, [f64; 2]), String> {
    let want = || "want KEY=LO,HI in m or kg, as 2.com=-0.3,0.1".to_owned();
    let (key, ends) = text.split_once('=').ok_or_else(want)?;
    let (low, high) = ends.split_once(',').ok_or_else(want)?;
    let end = |text: &str| text.trim().parse::<f64>().ok().filter(|x| x.is_finite()).ok_or_else(want);
    Ok((key.trim().into(), [end(low)?, end(high)?]))
}

impl KeepArguments {
    /// The machine with the least change, and what has changed.
    pub fn run(
        &self,
        machine: &Machine,
        motion: Option<&Motion>,
        penalty: &[f64],
    ) -> Result<(Machine, Answer), Failure> {
        let mut asked = Keep::coms(machine, penalty);
        let (fixed, free) =
            (self.fix.iter().map(|key| (key, Hold::Fixed)), self.free.iter().map(|key| (key, Hold::Free)));
        let bounds = self.bound.iter().map(|(key, ends)| (key, Hold::Within(*ends)));
        let mut seen = Vec::new();
        for (key, hold) in fixed.chain(free).chain(bounds) {
            let parameter = find(machine, key)?;
            if seen.contains(&parameter) {
                return Err(Failure::wrong_input(format!(
                    "{key} is held in two ways: want one of --fix, --free, --bound"
                )));
            }
            seen.push(parameter);
            asked.hold(machine, parameter, hold);
        }
        let kept = keep(machine, &asked).map_err(unkept)?;
        let change = |(one, value): (&Adjusted, &f64)| Change {
            key: one.parameter.key(machine),
            from: one.parameter.value(machine.spec()).unwrap_or_default(),
            to: *value,
            unit: if one.parameter.quantity == Quantity::Mass { "kg" } else { "m" },
        };
        let changes = asked.parameters.iter().zip(&kept.values).map(change).collect();
        let answer = Answer {
            changes,
            cost: kept.cost,
            measures: Measures::of(machine, &kept.machine, motion),
            balance: Balance::of(&Inertia::of(&kept.machine)),
        };
        Ok((kept.machine, answer))
    }
}

fn find(machine: &Machine, key: &str) -> Result<Parameter, Failure> {
    let (key, link) = (key.trim(), format!("link.{}", key.trim()));
    let mut all = Parameter::all(machine).into_iter();
    let found = all.find(|parameter| [key, link.as_str()].contains(&parameter.key(machine).as_str()));
    found.ok_or_else(|| {
        let why =
            "want mass, com or com_normal of a link, as 3.com, or mass or at of a counterweight, as counterweight.1.at";
        Failure::wrong_input(format!("nothing of this machine that balance depends on is called {key:?}: {why}"))
    })
}

/// What is asked for is wrong, or has no answer.
fn unkept(why: NotKept) -> Failure {
    match why {
        NotKept::OutOfRange { .. } | NotKept::NoParameter(_) | NotKept::Twice(_) => Failure::wrong_input(why),
        why => Failure::no_answer(why),
    }
}

/// What has changed, and what it achieves.
#[derive(Serialize)]
pub struct Answer {
    changes: Vec<Change>,
    /// Σ (p x)².
    cost: f64,
    #[serde(flatten)]
    measures: Measures,
    #[serde(flatten)]
    balance: Balance,
}

#[derive(Serialize)]
struct Change {
    key: String,
    from: f64,
    to: f64,
    unit: &'static str,
}

impl Answer {
    /// As a person reads it.
    pub fn text(&self, machine: &Machine, by: &str) -> String {
        let mut table = Table::new(["", "before", "now", "change", "unit"]);
        for Change { key, from, to, unit } in &self.changes {
            table.row([key.clone(), fixed(*from, 9), fixed(*to, 9), fixed(to - from, 9), (*unit).into()]);
        }
        let (name, cost) = (machine.name(), significant(self.cost));
        format!(
            "{name} · the least change, {by} · Σ (p x)² {cost}\n\n{table}\n{}\n{}",
            measures::text(&self.measures),
            self.balance.tables(machine)
        )
    }
}
