//! Which figures an option changes.

use stillbase_mechanics::machine::is_of_machine;
use stillbase_session::scenario::key_of;
use stillbase_settings::key::names;

use super::PaperFigure;
use crate::failure::Failure;
use crate::figures::FiguresArguments;
use crate::input::{no_use, overlay_settings};

/// An option of the figures of the paper.
#[derive(Clone, Copy)]
pub enum PaperOption<'a> {
    /// The points A and B.
    Points,
    /// The first pose constant b.
    FirstB,
    /// Further b.
    FurtherB,
    /// Duration of the motions.
    Time,
    /// A setting with this key.
    Setting(&'a str),
}

/// Settings of a machine that concern neither its parameters of motion nor its poses.
const NOT_OF_POSES: [&str; 12] = [
    "gravity",
    "link.*.axial",
    "payload.axial",
    "link.*.inertia_along",
    "link.*.inertia_across",
    "payload.inertia_along",
    "payload.inertia_across",
    "counterweight.*.fixed",
    "drive.*.torque_limit",
    "drive.*.speed_limit",
    "drive.*.acceleration_limit",
    "drive.*.jerk_limit",
];

/// Parts of a scenario that concern studies, or what a user does in the window.
const NOT_OF_MOTIONS: [&str; 4] = ["tolerance", "design", "compare_b", "pose_acceleration"];

impl PaperFigure {
    /// Whether an option changes what the figure shows.
    pub fn uses(self, option: PaperOption<'_>) -> bool {
        let is_motion = matches!(self, Self::Fig5a | Self::Fig5b | Self::Fig5c);
        match option {
            PaperOption::Points => is_motion || self == Self::Fig3,
            PaperOption::FirstB => self != Self::Table1,
            PaperOption::FurtherB => self == Self::Fig4,
            PaperOption::Time => is_motion,
            PaperOption::Setting(key) if is_motion => !NOT_OF_MOTIONS.contains(&part_of(key)),
            PaperOption::Setting(key) => self.uses_of_machine(key),
        }
    }

    fn uses_of_machine(self, key: &str) -> bool {
        is_of_machine(key)
            && !NOT_OF_POSES.iter().any(|pattern| names(pattern, key))
            && !(part_of(key) == "limits" && self == Self::Table1)
    }
}

fn part_of(key: &str) -> &str {
    key.split('.').next().unwrap_or_default()
}

/// Refuses options that change none of these figures.
pub fn check_options(wanted: &FiguresArguments, figures: &[PaperFigure]) -> Result<(), Failure> {
    let FiguresArguments { point, b, time, settings, .. } = wanted;
    if settings.keys().any(|key| key_of(key).is_none()) {
        // The message about a wrong key names all there are.
        overlay_settings(stillbase_files::scenario("case-3")?.scenario, settings)?;
    }
    let settings = settings.keys().map(|key| (true, format!("--set {key}"), PaperOption::Setting(key)));
    let options = [
        (!point.is_empty(), "--point", PaperOption::Points),
        (!b.is_empty(), "--b", PaperOption::FirstB),
        (b.len() > 1, "a second --b", PaperOption::FurtherB),
        (time.is_some(), "--time", PaperOption::Time),
    ];
    let options = options.map(|(is_given, words, option)| (is_given, words.to_owned(), option));
    let given = options.into_iter().chain(settings).filter(|(is_given, ..)| *is_given);
    for (_, words, option) in given {
        if !figures.iter().any(|figure| figure.uses(option)) {
            let using = PaperFigure::EACH.into_iter().filter(|figure| figure.uses(option));
            let using: Vec<String> = using.map(PaperFigure::word).collect();
            let want = match &using[..] {
                [] => "a setting of the machine, the task, the plant, the base or control".to_owned(),
                using => format!("--paper {}", using.join(" or ")),
            };
            return Err(no_use(&words, &want));
        }
    }
    Ok(())
}
