//! The results of a run of several machines on one base.

use schemars::JsonSchema;
use serde::Serialize;
use stillbase_session::assembly::{AssemblyBlock, AssemblyVerdict};
use stillbase_session::verdict::{ATTITUDE_TOLERANCE, Verdict};
use stillbase_session::{Run, WholeFrame};
use stillbase_settings::number::{counted, fixed};
use stillbase_simulation::frame::SharedBase;

use super::output::TextTable;

/// What the blocks of an assembly did to the base that they share.
#[derive(JsonSchema, Serialize)]
pub struct SharedOutcome {
    /// Peaks of the force on a fixed base from motion, x, y, z, N.
    #[serde(skip_serializing_if = "Option::is_none")]
    peak_force: Option<[f64; 3]>,
    /// Peaks of the moment on a fixed base about its origin from motion, x, y, z, N m.
    #[serde(skip_serializing_if = "Option::is_none")]
    peak_moment: Option<[f64; 3]>,
    /// Whether each component of the force is silent.
    #[serde(skip_serializing_if = "Option::is_none")]
    silent_force: Option<[bool; 3]>,
    /// Whether each component of the moment is silent.
    #[serde(skip_serializing_if = "Option::is_none")]
    silent_moment: Option<[bool; 3]>,
    /// Largest angle by which a free base turns, rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    base_angle: Option<f64>,
    /// The same at the end, rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    base_angle_end: Option<f64>,
    #[serde(skip)]
    pub sentence: String,
}

/// Results of a run of an assembly.
#[derive(JsonSchema, Serialize)]
pub struct AssemblyOutcome {
    steps: u64,
    #[serde(flatten)]
    shared: SharedOutcome,
    sentence: String,
    /// Limits that a block exceeds, and targets that it misses.
    remarks: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub audit_failed: Option<String>,
}

impl SharedOutcome {
    /// Returns what reached a base up to a step.
    pub fn of(step: u64, shared: &SharedBase) -> Self {
        let (verdict, is_fixed) = (AssemblyVerdict::of(step, shared), !shared.moves);
        let three = |from: usize| std::array::from_fn(|i| verdict.peaks[from + i]);
        let silent = verdict.silent();
        let each = |from: usize| std::array::from_fn(|i| silent[from + i]);
        Self {
            peak_force: is_fixed.then(|| three(0)),
            peak_moment: is_fixed.then(|| three(3)),
            silent_force: is_fixed.then(|| each(0)),
            silent_moment: is_fixed.then(|| each(3)),
            base_angle: shared.moves.then_some(verdict.turn[0]),
            base_angle_end: shared.moves.then_some(verdict.turn[1]),
            sentence: verdict.sentence(is_fixed),
        }
    }

    /// Returns what fails with `--strict`.
    pub fn fault(&self) -> Option<&str> {
        let silent = self.silent_force.into_iter().chain(self.silent_moment).flatten().all(|is_so| is_so);
        let kept = self.base_angle.is_none_or(|angle| angle <= ATTITUDE_TOLERANCE);
        (!(silent && kept)).then_some(&self.sentence)
    }
}

impl AssemblyOutcome {
    /// Returns the results of a run at its last step; `None` if its machine is no block of an assembly.
    pub fn of(run: &Run) -> Option<Self> {
        let (shared, last) = (run.shared()?, run.frame());
        let AssemblyBlock { scenario, .. } = &**shared.block();
        let whole = WholeFrame::of(run, &last);
        let tasks = scenario.tasks.iter().zip(scenario.assembly.blocks()).enumerate();
        let blocks = tasks.map(|(i, (task, block))| {
            let own = if i == shared.block().block { run.scenario() } else { &task.scenario };
            (&block.name, Verdict::of(own, whole.frame(i)))
        });
        let blocks: Vec<(&String, Verdict)> = blocks.collect();
        let remarks = blocks.iter().flat_map(|(name, verdict)| {
            verdict.misses().into_iter().map(move |remark| format!("{name}: {}", remark.long))
        });
        let audit = blocks.iter().find_map(|(name, verdict)| Some(format!("{name}: {}", verdict.fault.as_ref()?)));
        let shared = SharedOutcome::of(last.step, &last.shared?);
        Some(Self {
            steps: last.step,
            sentence: shared.sentence.clone(),
            shared,
            remarks: remarks.collect(),
            audit_failed: audit,
        })
    }

    /// Returns what fails with `--strict`.
    pub fn faults(&self, name: &str) -> Vec<String> {
        let remarks = self.remarks.iter().map(String::as_str);
        self.shared.fault().into_iter().chain(remarks).map(|why| format!("{name}: {why}")).collect()
    }

    /// Returns the lines of the message that rows were written.
    pub fn lines(&self) -> Vec<String> {
        let first = format!("{}, {}", counted(self.steps, "step"), self.sentence);
        [first].into_iter().chain(self.remarks.iter().cloned()).collect()
    }

    /// Returns the summary that a terminal gets instead of rows.
    pub fn summary(&self, name: &str, signals: usize) -> String {
        let mut table = TextTable::new(["", "", ""]).with_words(2);
        let peaks = [(self.shared.peak_force, "N"), (self.shared.peak_moment, "N m")];
        let all = peaks.into_iter().flat_map(|(three, unit)| three.into_iter().flatten().map(move |peak| (peak, unit)));
        for (component, (peak, unit)) in AssemblyVerdict::COMPONENTS.iter().zip(all) {
            table.row([format!("peak |{component}|"), fixed(peak, 9), unit.into()]);
        }
        let turns = [
            ("the base turns by up to", self.shared.base_angle),
            ("turn of the base at the end", self.shared.base_angle_end),
        ];
        for (what, turn) in turns {
            if let Some(turn) = turn {
                table.row([what.to_owned(), fixed(turn, 9), "rad".into()]);
            }
        }
        let lines = [&self.sentence].into_iter().chain(&self.remarks).map(|line| format!("{name}: {line}\n"));
        format!(
            "{}\n{}\n{} of {}: -o FILE.csv writes every row, a pipe gets them too\n",
            lines.collect::<String>(),
            table.to_string().trim_start(),
            counted(self.steps, "step"),
            counted(signals, "signal")
        )
    }
}
