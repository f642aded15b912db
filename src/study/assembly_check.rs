//! [`AssemblyReport`]: whether the blocks of an assembly are silent, and if not, which ones react and why.

use schemars::JsonSchema;
use serde::Serialize;

use stillbase_mechanics::assembly::{Assembly, Block, BlockConditions, Reacting};
use stillbase_settings::number::{nine_digits, significant};

/// Smallest sine of the angle between the axes of blocks that are not parallel.
const PARALLEL_SINE: f64 = 1e-9;

/// Whether an assembly is silent if every block holds its b.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct AssemblyReport {
    /// Total mass, kg.
    pub mass: f64,
    /// Whether no block reacts, in any of the six components.
    pub silent: bool,
    /// The blocks.
    pub blocks: Vec<BlockReport>,
    /// Groups of blocks whose planes are parallel: they may change their b together, if Σ D_1 b̈ = 0.
    pub parallel: Vec<Vec<String>>,
}

/// Whether a block is silent if it holds its b.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct BlockReport {
    /// Name of the block.
    pub block: String,
    /// Name of its machine.
    pub machine: String,
    /// What carries it.
    pub on: String,
    /// Mass of the block alone, kg.
    pub mass: f64,
    /// Mass that it carries at its end effector, kg.
    pub carried_mass: f64,
    /// Largest |g_k| with what it carries, kg m.
    pub force_left: f64,
    /// Largest |C_kl| with what it carries, kg m².
    pub coupling_left: f64,
    /// Largest |C_0k|: coupling with what is carried off the end effector, and with links that keep their orientation,
    /// kg m².
    pub ground_left: f64,
    /// Largest first moment of a drive weighted with heights, about the height of the centre of mass, kg m².
    pub tilt_left: f64,
    /// D_k with what it carries, if all C_kl vanish, kg m².
    pub d: Vec<f64>,
    /// Coefficients λ_k of its pose constant, with what it carries.
    pub lambda: Vec<f64>,
    /// Whether it puts nothing on the base while it holds its b.
    pub silent: bool,
    /// Why it reacts, and what would be right.
    pub reasons: Vec<String>,
}

impl AssemblyReport {
    /// Returns the report on an assembly.
    pub fn of(assembly: &Assembly) -> Self {
        let blocks: Vec<BlockReport> = (0..assembly.blocks().len()).map(|i| BlockReport::of(assembly, i)).collect();
        Self {
            mass: assembly.mass(),
            silent: blocks.iter().all(|block| block.silent),
            blocks,
            parallel: parallel(assembly.blocks()),
        }
    }
}

impl AssemblyReport {
    /// Returns the report as Markdown, under a title and what a run of the assembly showed.
    pub fn markdown(&self, title: &str, run: &str) -> String {
        let mut text = format!(
            "# {title}\n\n{run}\n\n| block | machine | on | kg | carries kg | silent |\n|---|---|---|---|---|---|\n"
        );
        for of in &self.blocks {
            let silent = if of.silent { "yes" } else { "no" };
            text += &format!(
                "| {} | {} | {} | {:.3} | {:.3} | {silent} |\n",
                of.block, of.machine, of.on, of.mass, of.carried_mass
            );
        }
        for of in &self.blocks {
            for why in &of.reasons {
                text += &format!("\nBlock {}: {why}\n", of.block);
            }
        }
        text
    }
}

/// Returns the names of blocks whose axes are parallel, in groups of at least two.
fn parallel(blocks: &[Block]) -> Vec<Vec<String>> {
    let axis = |block: &Block| block.mount.axes.column(2).into_owned();
    let mut groups: Vec<Vec<&Block>> = Vec::new();
    for block in blocks {
        let own = axis(block);
        match groups.iter_mut().find(|group| axis(group[0]).cross(&own).norm() < PARALLEL_SINE) {
            Some(group) => group.push(block),
            None => groups.push(vec![block]),
        }
    }
    let several = groups.into_iter().filter(|group| group.len() > 1);
    several.map(|group| group.into_iter().map(|block| block.name.clone()).collect()).collect()
}

impl BlockReport {
    fn of(assembly: &Assembly, i: usize) -> Self {
        let (block, conditions) = (&assembly.blocks()[i], assembly.conditions(i));
        let reasons: Vec<String> = conditions.reasons().map(|why| reason(assembly, i, &conditions, why)).collect();
        let BlockConditions { carried, inertia, force, coupling, ground, tilt, .. } = conditions;
        Self {
            block: block.name.clone(),
            machine: block.machine.name().to_owned(),
            on: block.mount.on.map_or_else(|| "base".to_owned(), |on| assembly.blocks()[on].name.clone()),
            mass: block.inertia.mass(),
            carried_mass: carried.mass,
            force_left: force,
            coupling_left: coupling,
            ground_left: ground,
            tilt_left: tilt,
            d: inertia.momenta().to_vec(),
            lambda: inertia.lambda().to_vec(),
            silent: reasons.is_empty(),
            reasons,
        }
    }
}

/// Says why a block reacts, and what would be right.
fn reason(assembly: &Assembly, i: usize, of: &BlockConditions, why: Reacting) -> String {
    let mass = nine_digits(of.carried.mass);
    let carried: Vec<&Block> = assembly.carried_by(Some(i)).map(|i| &assembly.blocks()[i]).collect();
    let with = if carried.is_empty() { String::new() } else { format!(" with the {mass} kg that it carries") };
    let again = match carried.is_empty() {
        true => "want a machine that is balanced".to_owned(),
        false => {
            let own = assembly.blocks()[i].machine.spec().payload.mass;
            format!(
                "want it balanced with payload.mass = {} at its end effector, then without",
                nine_digits(own + of.carried.mass)
            )
        }
    };
    match why {
        Reacting::Force => {
            format!("its centre of mass moves{with}: |g_k| up to {} kg m; {again}", significant(of.force))
        }
        Reacting::Coupling => {
            format!(
                "its mass matrix depends on the pose{with}: |C_kl| up to {} kg m²; {again}",
                significant(of.coupling)
            )
        }
        Reacting::Ground if of.own_ground > 0.5 * of.ground || carried.is_empty() => format!(
            "its links that keep their orientation are not balanced{with}: |C_0k| up to {} kg m²; want counterweights or \
             centres of mass for which it is 0, as `stillbase design` finds them",
            significant(of.ground)
        ),
        Reacting::Ground => {
            let beside = of.carried.beside;
            let mend = match carried[..] {
                [only] => {
                    let own = &assembly.blocks()[i].mount;
                    let at = only.mount.at - own.in_space(beside, 0.0);
                    let [x, y, z] = at.map(nine_digits).into();
                    format!("block {} at = [{x}, {y}, {z}]", only.name)
                }
                _ => "what it carries on the axis of its end effector".to_owned(),
            };
            let names: Vec<&str> = carried.iter().map(|block| block.name.as_str()).collect();
            format!(
                "what it carries ({}) has its centre of mass {} m beside the end effector: |C_0k| up to {} kg m²; want {mend}",
                names.join(", "),
                significant(beside.norm()),
                significant(of.ground)
            )
        }
        Reacting::Tilt => {
            let mend = match (&carried[..], height_of_links(&assembly.blocks()[i])) {
                ([only], Some(height)) => {
                    let own = &assembly.blocks()[i];
                    let off = own.platform_height() + of.carried.above - height;
                    let at = only.mount.at - own.mount.axes.column(2) * off;
                    let [x, y, z] = at.map(nine_digits).into();
                    format!(", as with block {} at = [{x}, {y}, {z}]", only.name)
                }
                _ => String::new(),
            };
            format!(
                "its bodies are at different heights, which tilts the base: Σ m h a up to {} kg m²; want links and what \
                 it carries at one height{mend}, or mirrored about its plane",
                significant(of.tilt)
            )
        }
    }
}

/// Returns the height of all links of a block and of its payload, m; `None` if they are at several.
fn height_of_links(block: &Block) -> Option<f64> {
    let (spec, links) = (block.machine.spec(), block.machine.links());
    let held = Some(spec.payload.axial).filter(|_| spec.payload.mass > 0.0);
    let mut heights = links.iter().filter(|link| link.mass > 0.0).map(|link| link.axial).chain(held);
    let first = heights.next()?;
    heights.all(|height| height == first).then_some(first)
}
