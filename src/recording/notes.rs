//! The document of a case: its verdict, what the user has written, and the equations with their numbers.

use super::markdown::cell;
use stillbase_mechanics::balance::Preset;
use stillbase_session::Run;
use stillbase_session::scenario::{Bookmark, Note, Scenario};
use stillbase_session::verdict::{Statements, Verdict};
use stillbase_settings::number::fixed;
use stillbase_simulation::frame::Frame;
use stillbase_study::assembly_check::AssemblyReport;
use stillbase_study::equations::{DriveState, Equation, equation_text, equations, state_text};

/// Path of the document.
pub const NOTES_PATH: &str = "notes";

/// Equations of the document: what reaches the base, what makes it zero, and the planes on which it stays so.
const EQUATIONS: [&str; 6] = ["5", "7", "8", "11", "12", "13"];

/// Maximum width of a line of terms, characters: more do not fit beside the plots.
const MAX_WIDTH: usize = 62;

/// Maximum number of characters of a note or of a name.
const MAX_CHARS: usize = 300;

/// Returns the document of a scenario whose run has ended at a frame.
pub fn document(
    scenario: &Scenario,
    (run, frame): (&Run, &Frame),
    verdict: &Verdict,
    statements: &Statements,
) -> String {
    if let Some(shared) = run.shared() {
        let is_fixed = frame.shared.is_none_or(|shared| !shared.moves);
        let report = AssemblyReport::of(&shared.block().scenario.assembly);
        return report.markdown(&title(scenario), &shared.verdict().sentence(is_fixed))
            + &written(&scenario.notes, &scenario.bookmarks);
    }
    let mut text = format!("# {}\n\n{}.\n\n", title(scenario), cell(&verdict.sentence(), MAX_CHARS));
    let Statements { machine: built, plan, run: ended } = statements;
    for (what, statement) in [("Machine", built), ("Plan", plan), ("Run", ended)] {
        let [words, why] = [statement.words.as_ref(), statement.why.as_ref()].map(|words: &str| cell(words, MAX_CHARS));
        text += &format!("* **{what}:** {words} ({why})\n");
    }
    text += &written(&scenario.notes, &scenario.bookmarks);
    let state = DriveState::of(run, frame);
    // Edits may have changed the machine.
    let machine = &run.scenario().machine;
    let instant = state_text(machine, &state).lines().map(|line| cell(line, MAX_CHARS)).collect::<Vec<_>>();
    text += &format!("\n## Equations of the paper, with numbers\n\n{}.\n", instant.join(". "));
    text += "\nIn them, ′ and ″ are the first and the second derivative by time.\n";
    let all = equations(machine, &state, Preset::Table1);
    let chosen: Vec<&Equation> = all.iter().filter(|equation| EQUATIONS.contains(&equation.number)).collect();
    chosen.into_iter().for_each(|equation| text += &block(&equation_text(equation, MAX_WIDTH)));
    text
}

fn title(scenario: &Scenario) -> String {
    let title = if scenario.title.is_empty() { &scenario.name } else { &scenario.title };
    cell(title, MAX_CHARS)
}

/// Returns the notes and bookmarks of the user; empty if there are none.
fn written(notes: &[Note], bookmarks: &[Bookmark]) -> String {
    let mut text = String::new();
    if !notes.is_empty() {
        text += "\n## Notes\n\n";
        notes.iter().for_each(|note| text += &format!("* {}\n", cell(&note.in_one_line(), MAX_CHARS)));
    }
    if !bookmarks.is_empty() {
        text += "\n## Bookmarks\n\n";
        let line = |mark: &Bookmark| format!("* {} s: {}\n", fixed(mark.time, 3), cell(&mark.name, MAX_CHARS));
        bookmarks.iter().for_each(|mark| text += &line(mark));
    }
    text
}

/// Returns a block in letters of one width, so that values stand below their symbols.
fn block(text: &str) -> String {
    // Names of links come from the user, and must not end the block. The viewer's letters of one width have no dots.
    let text = text.trim_end().replace("```", "‵‵‵").replace('ṙ', "r′").replace('\u{307}', "′").replace('\u{308}', "″");
    format!("\n```text\n{text}\n```\n")
}
