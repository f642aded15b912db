//! `stillbase design ASSEMBLY --counterweights`

use stillbase_mechanics::assembly::Assembly;
use stillbase_mechanics::counterweights::CounterweightSpec;
use stillbase_session::scenario::DesignBrief;
use stillbase_settings::number::{fixed, fixed_or_finer, significant};
use stillbase_study::assembly_weights::{
    AssemblyWeightReport, AssemblyWeightRequest, BlockWeightReport, balance_assembly,
};

use super::super::check::balance_tables;
use super::super::failure::Failure;
use super::super::input::{Settings, assembly_scenario};
use super::super::output::TextTable;
use super::super::progress::goes_on;
use super::super::sites::Names;
use super::DesignArguments;
use super::measures;
use super::weighed::{front_table, report_removed, shape_words, weights_table};

impl DesignArguments {
    /// Prints the counterweights of all blocks, and writes the assembly that carries them.
    pub fn assembly(&self, assembly: &Assembly) -> Result<(), Failure> {
        let name = self.machine.name();
        if !self.weighing.counterweights {
            let why = format!("{name} is an assembly: want --counterweights, which balances all its blocks");
            return Err(Failure::wrong_input(why));
        }
        let varied = self.varying.is_asked().then_some(["--vary", "one design, or one machine"]);
        if let Some([option, want]) = self.weighing.of_one_machine().or(varied) {
            return Err(Failure::wrong_input(format!("{option}: {name} is an assembly: want {want}")));
        }
        self.new_machine.check(&self.format)?;
        let accelerations = self.task.as_ref().map(|task| greatest_accelerations(task, assembly)).transpose()?;
        let spec = self.problem(assembly, accelerations)?;
        for block in assembly.blocks() {
            report_removed(&block.machine, &format!("block {}: ", block.name));
        }
        let front = self.weighing.has_front().then(|| self.weighing.front_count());
        let (stock, in_plane) = (spec.stock, self.weighing.in_plane);
        let request = AssemblyWeightRequest { spec, in_plane, front };
        let found = balance_assembly(assembly, &request, &goes_on);
        let (balanced, answer) = found.map_err(|why| self.weighing.failure(why, &stock))?;
        self.new_machine.save_assembly(&balanced, format!("{}, balanced by counterweights", assembly.name))?;
        self.format.print(&answer, |answer| text(answer, &balanced, &assembly.name))?;
        let reacting = answer.blocks.iter().flat_map(|block| block.reasons.iter().map(move |why| (&block.block, why)));
        self.strict.require(reacting.map(|(block, why)| format!("block {block}: {why}")))
    }

    /// Returns the problem that the arguments define for all blocks.
    fn problem(&self, assembly: &Assembly, accelerations: Option<Vec<f64>>) -> Result<CounterweightSpec, Failure> {
        let first = &assembly.blocks()[0].machine;
        let brief = self.weighing.brief(first, &DesignBrief::default());
        let mut asked = CounterweightSpec { sites: Vec::new(), ..brief.lightest_problem(first) };
        for (i, block) in assembly.blocks().iter().enumerate() {
            let mut sites = brief.lightest_problem(&block.machine).sites;
            sites.iter_mut().for_each(|site| site.link += assembly.first_link(i));
            asked.sites.extend(sites);
        }
        self.weighing.spec_of(&Names::from(assembly), asked, &brief, accelerations)
    }
}

/// Returns the greatest |q̈_k| of the drives of all blocks, rad/s², in the scenario of an assembly.
fn greatest_accelerations(task: &str, assembly: &Assembly) -> Result<Vec<f64>, Failure> {
    let refused = |why: String| Failure::wrong_input(format!("--task {task}: {why}"));
    let scenario = assembly_scenario(task, &Settings::default())?
        .ok_or_else(|| refused("want the scenario of an assembly, as four-freedoms".to_owned()))?;
    let drives = |of: &Assembly| -> Vec<(String, usize)> {
        of.blocks().iter().map(|block| (block.name.clone(), block.machine.drives())).collect()
    };
    if drives(&scenario.assembly) != drives(assembly) {
        let has: Vec<String> = drives(assembly).into_iter().map(|(name, n)| format!("{name} ({n} drives)")).collect();
        return Err(refused(format!("its assembly has other blocks: want {}", has.join(", "))));
    }
    let mut greatest: Vec<Vec<f64>> = assembly.blocks().iter().map(|own| vec![0.0; own.machine.drives()]).collect();
    let run = scenario.run(|frame| {
        for (most, state) in greatest.iter_mut().zip(&frame.states) {
            most.iter_mut().zip(state.qdd.iter()).for_each(|(most, x)| *most = most.max(x.abs()));
        }
        goes_on()
    });
    run.map_err(|why| Failure::from(why).with_context(format!("--task {task}")))?;
    Ok(greatest.concat())
}

/// Formats the report as text: the whole, then each block.
fn text(report: &AssemblyWeightReport, balanced: &Assembly, name: &str) -> String {
    let sure = match report.certified {
        true => format!("within {:.1e} of the best", report.gap),
        false => format!("not certified: the best may lie {} below", significant(report.gap)),
    };
    let all: Vec<_> = report.blocks.iter().flat_map(|block| block.weights.iter().cloned()).collect();
    let verdict = match report.silent {
        true => "silent: nothing reaches the base in any of six components while every block holds its b",
        false => "reacts even while every block holds its b",
    };
    let mut blocks = TextTable::new(["block", "on", "added kg", "carries kg", "Σ D_k kg m²"]).with_words(2);
    for BlockWeightReport { block, on, measures, carried_mass, balance, .. } in &report.blocks {
        let numbers = [measures.added_mass, *carried_mass, balance.d.iter().sum()].map(|x| fixed_or_finer(x, 6));
        blocks.row([block.clone(), on.clone()].into_iter().chain(numbers));
    }
    let (added, in_plane) = (report.measures.added_mass, report.added_mass_in_plane);
    let price = match added - in_plane > 1e-6 * in_plane {
        true => format!("in their planes  {} kg would do; --in-plane takes these\n", fixed_or_finer(in_plane, 6)),
        false => String::new(),
    };
    let mut text = format!(
        "{name} · {} kg added{} · {sure}\n\nassembly         {verdict}\n{price}{}\n{blocks}",
        fixed_or_finer(added, 6),
        shape_words(&all),
        measures::text(&report.measures)
    );
    for (own, block) in report.blocks.iter().zip(balanced.blocks()) {
        let weights = match own.weights.is_empty() {
            true => "no counterweights\n".to_owned(),
            false => weights_table(&own.weights).to_string(),
        };
        let tables = balance_tables(&own.balance, &block.machine);
        text.push_str(&format!("\nblock {} · {}\n\n{weights}\n{tables}", own.block, own.machine));
        if !own.rotors.is_empty() {
            let mut table = TextTable::new(["rotor of drive", "inertia kg m²", "ratio"]);
            for rotor in &own.rotors {
                table.row([rotor.drive.clone(), fixed(rotor.inertia, 9), fixed(rotor.ratio, 6)]);
            }
            text.push_str(&format!("\n{table}"));
        }
    }
    for own in &report.blocks {
        own.reasons.iter().for_each(|why| text.push_str(&format!("\nblock {}: {why}\n", own.block)));
    }
    if let Some(torque) = report.torque {
        text.push_str(&format!("\ngreatest torque of the task {} N m\n", fixed(torque, 6)));
    }
    if !report.front_points.is_empty() {
        text.push_str(&format!("\n{}", front_table(&report.front_points)));
    }
    text
}
