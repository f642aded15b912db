//! `stillbase check` of an assembly of several machines.

use stillbase_mechanics::assembly::Assembly;
use stillbase_study::assembly_check::{AssemblyReport, BlockReport};

use super::failure::Failure;
use super::output::{Format, TextTable, yes};
use super::strict::Strict;
use stillbase_settings::number::fixed;

/// Prints whether the blocks are silent; one that reacts is no failure.
pub fn check(assembly: &Assembly, format: &Format, strict: &Strict) -> Result<(), Failure> {
    let report = AssemblyReport::of(assembly);
    format.print(&report, |report| text(assembly, report))?;
    let reacting = report.blocks.iter().flat_map(|block| block.reasons.iter().map(move |why| (&block.block, why)));
    strict.require(reacting.map(|(block, why)| format!("block {block}: {why}")))
}

fn text(assembly: &Assembly, report: &AssemblyReport) -> String {
    let mut blocks = TextTable::new(["block", "machine", "on", "kg", "carries kg", "silent"]).with_words(3);
    let mut left = TextTable::new(["block", "|g_k| kg m", "|C_kl| kg m²", "|C_0k| kg m²", "|Σ m h a_k| kg m²"]);
    for of in &report.blocks {
        let BlockReport { block, machine, on, mass, carried_mass, .. } = of;
        let masses = [*mass, *carried_mass].map(|kg| fixed(kg, 3));
        let names = [block, machine, on].map(String::clone);
        blocks.row(names.into_iter().chain(masses).chain([yes(of.silent).to_owned()]));
        let residuals = [of.force_left, of.coupling_left, of.ground_left, of.tilt_left].map(|x| format!("{x:.1e}"));
        left.row([block.clone()].into_iter().chain(residuals));
    }
    let verdict = match report.silent {
        true => "silent: nothing reaches the base in any of six components while every block holds its b",
        false => "reacts even while every block holds its b",
    };
    let mut text = format!(
        "{}{}\n\nassembly         {verdict}\nmass             {} kg\n\n{blocks}\nlargest residuals, with what each block carries\n\n{left}",
        assembly.name,
        if assembly.summary.is_empty() { String::new() } else { format!(" · {}", assembly.summary) },
        fixed(report.mass, 3)
    );
    for of in &report.blocks {
        of.reasons.iter().for_each(|why| text.push_str(&format!("\nblock {}: {why}\n", of.block)));
    }
    for group in &report.parallel {
        let names = group.join(", ");
        text.push_str(&format!(
            "\nblocks {names}: parallel planes, so each may change its b if Σ D_1 b̈ = 0 over them, counted about one axis\n"
        ));
    }
    text
}
