//! `stillbase dynamics`

use std::collections::BTreeMap;
use std::path::PathBuf;

use clap::Args;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use stillbase_mechanics::assembly::{Assembly, Block, BlockState, SpatialWrench};
use stillbase_mechanics::dynamics::ExternalLoads;
use stillbase_mechanics::loads::Loads;
use stillbase_mechanics::planar::{DriveAngles, PerDrive};
use stillbase_settings::range::{quote_clipped, shortened};

use super::failure::Failure;
use super::input::{MachineArgument, read};
use super::output::{Format, TextTable};
use stillbase_settings::number::{counted, fixed};

/// Compute the motor torques and the base reactions of given states of motion, Eqs (1) to (6)
///
/// Force and moment are those that the manipulator transmits to its base, weight included; the moment is about B,
/// positive counter-clockwise. Of an assembly of several machines they are vectors in axes of the base, the moment about its
/// origin.
#[derive(Args)]
#[command(after_help = "\
Examples:
  echo '[{\"q\": [0.1, 0.2, 0.3], \"qd\": [0, 0, 1], \"qdd\": [0, 1, 0]}]' > states.json
  stillbase dynamics nine-link --states states.json --set gravity=0,-9.81

States of an assembly name its blocks: [{\"arm\": [[q…], [q̇…], [q̈…]], \"wrist\": …}]")]
pub struct DynamicsArguments {
    #[command(flatten)]
    machine: MachineArgument,
    /// JSON: a list of states {"q": [rad], "qd": [rad/s], "qdd": [rad/s²]}, absolute angles, one number a drive; of an
    /// assembly {BLOCK: [[rad], [rad/s], [rad/s²]], …}
    #[arg(long, value_name = "FILE.json")]
    states: PathBuf,
    #[command(flatten)]
    format: Format,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct State {
    q: Vec<f64>,
    qd: Vec<f64>,
    qdd: Vec<f64>,
}

/// The states of an assembly, by block.
type BlockStates = BTreeMap<String, [Vec<f64>; 3]>;

#[derive(JsonSchema, Serialize)]
pub(crate) struct Answer {
    results: Vec<StateLoads>,
}

/// Loads in one state of motion.
#[derive(JsonSchema, Serialize)]
struct StateLoads {
    /// Force on the base, weight included, in axes of the base, N.
    force: [f64; 3],
    /// Moment on the base about its origin, weight included, in axes of the base, N m.
    moment: [f64; 3],
    /// Loads of a machine by itself.
    #[serde(flatten)]
    alone: Option<Loads>,
    /// The blocks of an assembly.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    blocks: Vec<BlockAnswer>,
}

/// What a block of an assembly does.
#[derive(JsonSchema, Serialize)]
struct BlockAnswer {
    /// Name of the block.
    block: String,
    /// Torque of each motor, with what the block carries, N m.
    torque: Vec<f64>,
    /// End effector from the origin of the base, m.
    end_effector: [f64; 3],
    /// Force of its own bodies on the base, N.
    force: [f64; 3],
    /// Moment of its own bodies on the base about its origin, N m.
    moment: [f64; 3],
}

impl DynamicsArguments {
    /// Prints one result for each state.
    pub fn run(&self) -> Result<(), Failure> {
        let assembly = self.machine.load_assembly()?;
        let file = self.states.display().to_string();
        let states = states_in(&read(&self.states, &["json"])?, &file, &assembly)?;
        let results = states.iter().map(|states| StateLoads::of(&assembly, states)).collect();
        self.format.print(&Answer { results }, |answer| tables(answer, &assembly))
    }
}

impl StateLoads {
    fn of(assembly: &Assembly, states: &[BlockState]) -> Self {
        let tips = assembly.end_effectors(states);
        let mut blocks = Vec::new();
        let SpatialWrench { force, moment } = assembly
            .loads(states, |i, loads| {
                let SpatialWrench { force, moment } = loads.on_base.total();
                blocks.push((
                    i,
                    BlockAnswer {
                        block: assembly.blocks()[i].name.clone(),
                        torque: loads.torque.to_vec(),
                        end_effector: tips[i].into(),
                        force: force.into(),
                        moment: moment.into(),
                    },
                ));
            })
            .total();
        blocks.sort_by_key(|(i, _)| *i);
        let alone = assembly.is_of_one().then(|| {
            let (block, BlockState { q, qd, qdd }) = (&assembly.blocks()[0], &states[0]);
            let around = ExternalLoads { gravity: block.mount.in_plane(&assembly.gravity), ..ExternalLoads::default() };
            Loads::of(&block.inertia, &around, &q.0, qd, qdd)
        });
        let blocks = if alone.is_some() { Vec::new() } else { blocks.into_iter().map(|(_, block)| block).collect() };
        Self { force: force.into(), moment: moment.into(), alone, blocks }
    }
}

/// Reads states of motion from text, one for each block of an assembly; errors name `file`.
pub fn states_in(text: &str, file: &str, assembly: &Assembly) -> Result<Vec<Vec<BlockState>>, Failure> {
    let names: Vec<&str> = assembly.blocks().iter().map(|block| block.name.as_str()).collect();
    let is_of_one = assembly.is_of_one();
    let want = match is_of_one {
        true => r#"want [{"q": [rad], "qd": [rad/s], "qdd": [rad/s²]}, …]"#.to_owned(),
        false => {
            let each: Vec<String> = names.iter().map(|name| format!("{name:?}: [[rad], [rad/s], [rad/s²]]")).collect();
            format!("want [{{{}}}, …]", each.join(", "))
        }
    };
    let wrong = |line: usize, what: String| Failure::WrongInput(format!("{file}:{line}: {what}"));
    let not_read = |e: serde_json::Error| {
        let said = e.to_string();
        let what = said.rsplit_once(" at line ").map_or(said.as_str(), |(what, _)| what);
        wrong(e.line(), format!("{}: {want}", shortened(what, 300)))
    };
    let states: Vec<BlockStates> = match is_of_one {
        true => {
            let alone: Vec<State> = serde_json::from_str(text).map_err(not_read)?;
            let named = |State { q, qd, qdd }| BlockStates::from([(names[0].to_owned(), [q, qd, qdd])]);
            alone.into_iter().map(named).collect()
        }
        false => serde_json::from_str(text).map_err(not_read)?,
    };
    // No string before the end of a state holds a brace but a name, so the i-th brace opens the i-th state.
    let mut line = 1;
    let starts = text.bytes().filter_map(|byte| {
        line += usize::from(byte == b'\n');
        (byte == b'{').then_some(line)
    });
    let state = |(i, (given, line)): (usize, (BlockStates, usize))| {
        let number = i + 1;
        if let Some(name) = given.keys().find(|name| !names.contains(&name.as_str())) {
            let name = quote_clipped(name);
            return Err(wrong(line, format!("state {number}: no block {name:?}: want one of {}", names.join(", "))));
        }
        let of = |block: &Block| {
            let n = block.machine.drives();
            let of = if is_of_one { String::new() } else { format!("block {}: ", block.name) };
            let numbers =
                given.get(&block.name).ok_or_else(|| wrong(line, format!("state {number}: {of}missing: {want}")))?;
            let take = |name: &str, values: &[f64]| {
                PerDrive::from_slice(values).filter(|v| v.len() == n).ok_or_else(|| {
                    let count = counted(values.len(), "number");
                    wrong(line, format!("state {number}: {of}{name} has {count}: want {n}, one a drive"))
                })
            };
            let [q, qd, qdd] = numbers;
            Ok(BlockState { q: DriveAngles(take("q", q)?), qd: take("qd", qd)?, qdd: take("qdd", qdd)? })
        };
        assembly.blocks().iter().map(of).collect()
    };
    states.into_iter().zip(starts).enumerate().map(state).collect()
}

fn tables(answer: &Answer, assembly: &Assembly) -> String {
    let axes = ["f_x N", "f_y N", "f_z N", "n_x N m", "n_y N m", "n_z N m"];
    let six =
        |force: &[f64; 3], moment: &[f64; 3]| force.iter().chain(moment).map(|x| fixed(*x, 6)).collect::<Vec<_>>();
    if !assembly.is_of_one() {
        let mut base = TextTable::new(["state"].into_iter().chain(axes));
        let mut blocks = TextTable::new(["state", "block"].into_iter().chain(axes).chain(["τ N m"])).with_words(2);
        for (i, r) in answer.results.iter().enumerate() {
            let state = (i + 1).to_string();
            base.row([state.clone()].into_iter().chain(six(&r.force, &r.moment)));
            for of in &r.blocks {
                let torque: Vec<String> = of.torque.iter().map(|x| fixed(*x, 6)).collect();
                let own = six(&of.force, &of.moment).into_iter().chain([torque.join("  ")]);
                blocks.row([state.clone(), of.block.clone()].into_iter().chain(own));
            }
        }
        return format!("{base}\n{blocks}");
    }
    let n = assembly.blocks()[0].machine.drives();
    let torques = (1..=n).map(|k| format!("τ_{k} N m"));
    let rest = ["f_Bx N", "f_By N", "n_B N m", "x_CM m", "y_CM m", "h_B kg m²/s"].map(String::from);
    let mut motion = TextTable::new(["state".to_string()].into_iter().chain(torques).chain(rest));
    let upper = || (0..n).flat_map(|k| (k..n).map(move |l| (k, l)));
    let entries = upper().map(|(k, l)| format!("H_{}{} kg m²", k + 1, l + 1));
    let mut matrix = TextTable::new(["state".to_string()].into_iter().chain(entries));
    for (i, r) in answer.results.iter().enumerate().filter_map(|(i, r)| Some((i, r.alone.as_ref()?))) {
        let name = || [(i + 1).to_string()].into_iter();
        let after =
            [r.base_force[0], r.base_force[1], r.base_moment, r.com[0], r.com[1], r.angular_momentum_about_base];
        motion.row(name().chain(r.torque.iter().chain(&after).map(|x| fixed(*x, 6))));
        matrix.row(name().chain(upper().map(|(k, l)| fixed(r.mass_matrix[k][l], 6))));
    }
    format!("{motion}\n{matrix}")
}
