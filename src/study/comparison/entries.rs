//! [`Comparison`]: a table of runs that the user extends, sorts, and overlays on the present run.

use std::fmt;
use std::sync::Arc;

use super::summary::OLD_NAMES;
use super::{
    Alternative, BaselineMachines, ComparedRun, DESIGN_COLUMNS, DesignMeasures, SUMMARY_COLUMNS, alternatives,
};
use stillbase_query::{ByIdentity, Portion, ProgressCallback, Query, Shared, part};
use stillbase_session::scenario::Scenario;
use stillbase_session::{Proposal, Refusal, proposals_while};
use stillbase_settings::number::nine_digits;

/// One row of the comparison.
#[derive(Clone, Debug)]
pub struct ComparisonEntry {
    /// Title of the row.
    pub title: String,
    /// The run, or why there is none.
    pub outcome: Result<Arc<ComparedRun>, Arc<RefusedRun>>,
    /// Whether the run is overlaid on plots and scene.
    pub shown: bool,
    /// Whether the user added the row, which then remains when the task changes.
    pub added_by_user: bool,
    /// Comparison of the run's machine with the machine of the first run in the table.
    pub design: Option<DesignMeasures>,
}

impl ComparisonEntry {
    /// Returns the name of the run in plots and pictures: for a run of the user its scenario's title, else the row's.
    pub fn shown_title(&self) -> &str {
        let scenario = self.outcome.as_ref().map(|run| run.scenario.title.as_str()).unwrap_or_default();
        if self.added_by_user && !scenario.is_empty() { scenario } else { &self.title }
    }

    /// Returns the value in a column; columns of runs come first, then those of designs.
    pub fn value(&self, column: usize) -> Option<f64> {
        match column.checked_sub(SUMMARY_COLUMNS.len()) {
            None => (SUMMARY_COLUMNS.get(column)?.value)(&self.outcome.as_ref().ok()?.summary),
            Some(own) => (DESIGN_COLUMNS.get(own)?.value)(self.design.as_ref()?),
        }
    }
}

/// Table of runs: the alternatives for one task, and the runs that the user added.
#[derive(Clone, Debug)]
pub struct Comparison {
    task: Scenario,
    entries: Vec<ComparisonEntry>,
    sort: Option<(usize, bool)>,
    baseline: BaselineMachines,
    /// Replaced at each change of rows or of their order.
    version: Arc<()>,
    /// Titles of alternatives that are laid over as soon as they are there.
    awaited: Vec<String>,
    /// The alternatives that the table shows.
    ways: Option<Arc<<AlternativeRuns as Query>::Answer>>,
}

/// Keys of all columns: of runs, then of designs.
fn column_keys() -> impl Iterator<Item = &'static str> {
    SUMMARY_COLUMNS.iter().map(|column| column.key).chain(DESIGN_COLUMNS.iter().map(|column| column.key))
}

/// Title of an alternative, and its run or why there is none.
pub type ComparisonOutcome = (String, Result<Arc<ComparedRun>, Arc<RefusedRun>>);

/// A scenario that cannot be run, with ways out.
#[derive(Clone, Debug)]
pub struct RefusedRun {
    scenario: Scenario,
    /// Reason.
    pub why: String,
    /// Changes after which it runs.
    pub proposals: Vec<Proposal>,
}

impl RefusedRun {
    /// Searches for the ways out; `None` if `goes_on` stops the search.
    fn of_while(title: &str, scenario: &Scenario, refusal: &Refusal, goes_on: ProgressCallback<'_>) -> Option<Self> {
        let scenario = Scenario { name: title.into(), ..scenario.clone() };
        let proposals = proposals_while(&scenario, refusal, goes_on)?;
        Some(Self { why: refusal.to_string(), proposals, scenario })
    }

    /// Returns the scenario after a proposal.
    pub fn with(&self, proposal: &Proposal) -> Option<Scenario> {
        self.scenario.with_settings(proposal.change()?).ok()
    }

    /// Returns all proposals in words, one a line, each with what it changes.
    pub fn ways_in_words(&self) -> String {
        let line = |way: &Proposal| format!("{}: {}", way.text, way.how().replace('\n', ", "));
        self.proposals.iter().map(line).collect::<Vec<_>>().join("\n")
    }
}

impl fmt::Display for RefusedRun {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.why)
    }
}

/// Query for the runs of all alternatives for a scenario's task, one in each portion.
#[derive(Debug)]
pub struct AlternativeRuns {
    scenario: Shared<Scenario>,
    ways: Vec<(Alternative, Scenario)>,
    done: Vec<ComparisonOutcome>,
}

impl Query for AlternativeRuns {
    type Input = Shared<Scenario>;
    /// The scenario, and the outcomes of its alternatives.
    type Answer = (Shared<Scenario>, Vec<ComparisonOutcome>);

    fn begin(scenario: Self::Input) -> Self {
        Self { ways: alternatives(&scenario.0), done: Vec::new(), scenario }
    }

    fn go_on(&mut self, goes_on: ProgressCallback<'_>) -> Portion<Self::Answer> {
        let (known, count) = (self.done.len(), self.ways.len() as f64);
        let Some((way, scenario)) = self.ways.get(known) else {
            return Portion::Done((self.scenario.clone(), std::mem::take(&mut self.done)));
        };
        let share = |done: f64| (known as f64 + done) / count;
        let mut run_share = 0.0;
        let run = ComparedRun::of_while(scenario.clone(), &mut |done| {
            run_share = done;
            goes_on(share(done))
        });
        let outcome = match run {
            Ok(run) => Ok(Arc::new(run)),
            Err(Refusal::Stopped) => return Portion::Stopped,
            Err(refusal) => {
                // The search takes what the run has left of its share of the work.
                let mut rest = part(goes_on, [share(run_share), share(1.0)]);
                let Some(refused) = RefusedRun::of_while(way.title(), scenario, &refusal, &mut rest) else {
                    return Portion::Stopped;
                };
                Err(Arc::new(refused))
            }
        };
        self.done.push((way.title().to_owned(), outcome));
        Portion::More(share(1.0))
    }
}

impl Comparison {
    /// Returns a table without runs.
    pub fn empty(scenario: &Scenario) -> Self {
        Self {
            task: scenario.clone(),
            entries: Vec::new(),
            sort: None,
            baseline: BaselineMachines::default(),
            version: Arc::default(),
            awaited: Vec::new(),
            ways: None,
        }
    }

    /// Replaces the alternatives by those of another task, unless the table shows them already. Rows that the user
    /// added, overlays and the sort order remain.
    pub fn follow(&mut self, found: &Arc<<AlternativeRuns as Query>::Answer>) {
        if self.ways.as_ref().is_some_and(|ways| Arc::ptr_eq(ways, found)) {
            return;
        }
        self.ways = Some(found.clone());
        let (Shared(scenario), ways) = &**found;
        self.task = Scenario::clone(scenario);
        let shown = self.ticked();
        self.awaited.clear();
        let kept: Vec<ComparisonEntry> = self.entries.drain(..).filter(|e| e.added_by_user).collect();
        let own = ways.iter().cloned().map(|(title, outcome)| {
            let shown = outcome.is_ok() && shown.contains(&title);
            ComparisonEntry { title, outcome, shown, added_by_user: false, design: None }
        });
        self.entries = own.chain(kept).collect();
        self.compare_with_baseline();
    }

    /// Returns the scenario whose alternatives the table shows.
    pub fn task(&self) -> &Scenario {
        &self.task
    }

    /// Runs a scenario and adds it as a row that stays until it is removed.
    ///
    /// # Errors
    /// Fails if the scenario cannot be run.
    pub fn keep(&mut self, scenario: Scenario) -> Result<(), Refusal> {
        let run = ComparedRun::of(scenario)?;
        self.keep_run(run);
        Ok(())
    }

    /// Adds a finished run as a row that stays until it is removed.
    pub fn keep_run(&mut self, mut run: ComparedRun) {
        let own = run.scenario.name.clone();
        let taken = |name: &str| self.entries.iter().any(|e| e.title == name);
        let mut title = own.clone();
        for count in 2.. {
            if !taken(&title) {
                break;
            }
            title = format!("{own} {count}");
        }
        run.scenario.name.clone_from(&title);
        run.summary.name.clone_from(&title);
        self.restore(Arc::new(run), true);
    }

    /// Adds a run that was in a table before, under its own name; `shown` says whether it is overlaid.
    pub fn restore(&mut self, run: Arc<ComparedRun>, shown: bool) {
        let title = run.scenario.name.clone();
        self.entries.push(ComparisonEntry { title, outcome: Ok(run), shown, added_by_user: true, design: None });
        self.compare_with_baseline();
    }

    /// Overlays the alternatives with these titles, as soon as they are there.
    pub fn tick(&mut self, titles: Vec<String>) {
        self.awaited = titles;
    }

    /// Returns the titles of the alternatives that are overlaid, or will be as soon as they are there.
    pub fn ticked(&self) -> Vec<String> {
        let own = self.entries.iter().filter(|e| e.shown && !e.added_by_user).map(|e| e.title.clone());
        own.chain(self.awaited.iter().cloned()).collect()
    }

    /// Compares every machine with that of the first run.
    fn compare_with_baseline(&mut self) {
        self.version = Arc::default();
        self.baseline = BaselineMachines::default();
        for entry in &mut self.entries {
            entry.design = entry.outcome.as_ref().ok().map(|run| self.baseline.set(&run.candidate));
        }
    }

    /// Returns whether the machines of the runs differ, so that there are designs to compare.
    pub fn has_designs(&self) -> bool {
        self.baseline.differ()
    }

    /// Removes a run that the user added.
    pub fn remove(&mut self, entry: usize) {
        if self.entries.get(entry).is_some_and(|e| e.added_by_user) {
            self.entries.remove(entry);
            self.compare_with_baseline();
        }
    }

    /// Sets whether a run is overlaid on plots and scene.
    pub fn show(&mut self, entry: usize, shown: bool) {
        if let Some(entry) = self.entries.get_mut(entry) {
            entry.shown = shown && entry.outcome.is_ok();
        }
    }

    /// Sorts by a column: ascending the first time, descending the second, not at all the third.
    pub fn sort_by(&mut self, column: usize) {
        self.version = Arc::default();
        self.sort = match self.sort {
            Some((c, false)) if c == column => Some((c, true)),
            Some((c, true)) if c == column => None,
            _ => Some((column, false)),
        };
    }

    /// Sorts by the column with a key; the greatest value comes first if `descending`. An unknown key sorts by none.
    pub fn sort_by_key(&mut self, key: &str, descending: bool) {
        self.version = Arc::default();
        // Tables that are kept may still have an older name.
        let key = OLD_NAMES.iter().find(|(_, old)| *old == key).map_or(key, |(name, _)| name);
        self.sort = column_keys().position(|known| known == key).map(|column| (column, descending));
    }

    /// Returns the key of the sort column, and whether the order is descending.
    pub fn sorted_key(&self) -> Option<(&'static str, bool)> {
        let (column, descending) = self.sort?;
        column_keys().nth(column).map(|key| (key, descending))
    }

    /// Returns what identifies rows and order of the table: another one after each change of them.
    pub fn version(&self) -> ByIdentity<()> {
        ByIdentity(self.version.clone())
    }

    /// Returns the sort column, and whether the order is descending.
    pub fn sorted(&self) -> Option<(usize, bool)> {
        self.sort
    }

    /// Returns all rows: first the alternatives, then the runs that the user added, in the order of insertion.
    pub fn entries(&self) -> &[ComparisonEntry] {
        &self.entries
    }

    /// Returns the indices of the rows in the order of the table; rows without a value come last.
    pub fn order(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.entries.len()).collect();
        let Some((column, down)) = self.sort else { return order };
        let value = |i: usize| self.entries[i].value(column);
        order.sort_by(|a, b| match (value(*a), value(*b)) {
            (Some(a), Some(b)) if down => b.total_cmp(&a),
            (Some(a), Some(b)) => a.total_cmp(&b),
            (a, b) => a.is_none().cmp(&b.is_none()),
        });
        order
    }

    /// Iterates over the overlaid runs with their indices.
    pub fn shown(&self) -> impl Iterator<Item = (usize, &ComparedRun)> {
        let all = self.entries.iter().enumerate().filter(|(_, e)| e.shown);
        all.filter_map(|(i, e)| Some((i, e.outcome.as_deref().ok()?)))
    }

    /// Returns the table as tab-separated text for a spreadsheet, in the order shown.
    pub fn to_text(&self) -> String {
        let designs = if self.has_designs() { &DESIGN_COLUMNS[..] } else { &[] };
        let heads = SUMMARY_COLUMNS.iter().map(|c| format!("{} {}", c.head, c.unit));
        let heads = heads.chain(designs.iter().map(|c| format!("{} {}", c.head, c.unit)));
        let mut text = ["run".to_owned()].into_iter().chain(heads).collect::<Vec<_>>().join("\t") + "\n";
        for i in self.order() {
            let entry = &self.entries[i];
            let columns = 0..SUMMARY_COLUMNS.len() + designs.len();
            let cells = columns.map(|column| entry.value(column).map_or_else(String::new, nine_digits));
            text += &([entry.title.clone()].into_iter().chain(cells).collect::<Vec<_>>().join("\t") + "\n");
        }
        text
    }
}
