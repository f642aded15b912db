//! [`Assembly`]: checked blocks, with the order in which they carry each other.

use nalgebra::{Matrix3, Vector3};
use toml::Value;

use super::block::{Block, Mount};
use super::file::{AssemblyKind, AssemblySpec, BlockSpec, FindMachine};
use crate::machine::{KeyPath, Machine, MachineSpec};
use crate::planar::MAX_DRIVES;
use stillbase_settings::range::{MAX_SAID, quote_clipped, shortened};
use stillbase_settings::text::control_character;

/// Maximum number of blocks.
pub const MAX_BLOCKS: usize = 8;

/// Largest distance of a mount from what carries it, m, and largest gravity, m/s².
const MAX_PLACE: f64 = 1e6;

/// Largest angle by which x and y may miss a right angle, rad.
const MAX_SKEW_RAD: f64 = 1e-6;

/// The word for the base.
const BASE: &str = "base";

/// Planar machines on one base.
#[derive(Clone, Debug, PartialEq)]
pub struct Assembly {
    /// Its name.
    pub name: String,
    /// Summary in one line.
    pub summary: String,
    /// Acceleration of gravity in axes of the base, m/s².
    pub gravity: Vector3<f64>,
    blocks: Vec<Block>,
    /// Places of the blocks: each after the one that carries it.
    order: Vec<usize>,
}

/// Why a text describes no assembly.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{said}")]
pub struct AssemblyError {
    /// Place in the file.
    pub place: KeyPath,
    /// What is wrong, and what would be right.
    pub said: String,
    /// Names of which one is meant, if the place holds a name that does not exist.
    pub known: Vec<String>,
}

impl AssemblyError {
    pub(super) fn at(block: usize, key: &str, said: impl Into<String>) -> Self {
        Self { place: KeyPath::new(&[&"block", &block, &key]), said: said.into(), known: Vec::new() }
    }
}

impl From<Machine> for Assembly {
    /// A machine by itself: an assembly of one block, whose gravity is in its plane.
    fn from(machine: Machine) -> Self {
        let [x, y] = machine.spec().gravity;
        let (name, summary) = (machine.name().to_owned(), machine.spec().summary.clone());
        let block = Block::new(&name, machine, Mount::on_base());
        Self { name, summary, gravity: Vector3::new(x, y, 0.0), blocks: vec![block], order: vec![0] }
    }
}

impl Assembly {
    /// Makes an assembly of what a file states; `find` looks up the machines of its blocks.
    ///
    /// # Errors
    /// The first thing that is wrong, with its place.
    pub fn new(spec: &AssemblySpec, find: FindMachine<'_>) -> Result<Self, AssemblyError> {
        let whole = |key: &str, said: String| AssemblyError { place: KeyPath::new(&[&key]), said, known: Vec::new() };
        for (key, text) in [("name", &spec.name), ("summary", &spec.summary)] {
            if let Some(character) = control_character(text) {
                let code = u32::from(character);
                return Err(whole(key, format!("holds the control character U+{code:04X}: want printable text")));
            }
        }
        if spec.blocks.is_empty() || spec.blocks.len() > MAX_BLOCKS {
            let count = spec.blocks.len();
            return Err(whole("block", format!("{count} blocks: want 1 to {MAX_BLOCKS}, each a [[block]]")));
        }
        let mut blocks = Vec::with_capacity(spec.blocks.len());
        for (i, block) in spec.blocks.iter().enumerate() {
            blocks.push(resolved(spec, i, block, find)?);
        }
        let order = carrying_order(&blocks)?;
        let (name, summary, gravity) = (spec.name.clone(), spec.summary.clone(), Vector3::zeros());
        let mut assembly = Self { name, summary, gravity, blocks, order };
        assembly.set_gravity(spec.gravity)?;
        Ok(assembly)
    }

    /// Changes the acceleration of gravity, m/s², in axes of the base.
    ///
    /// # Errors
    /// If a number is not finite, or too large.
    pub fn set_gravity(&mut self, gravity: [f64; 3]) -> Result<(), AssemblyError> {
        let place = KeyPath::new(&[&"gravity"]);
        let wrong = || AssemblyError { place, said: numbers_wanted(&gravity, "m/s²"), known: Vec::new() };
        self.gravity = vector(&gravity).ok_or_else(wrong)?;
        Ok(())
    }

    /// Returns the content of its file, with all machines written out.
    ///
    /// # Panics
    /// Never: every machine can be written.
    pub fn spec(&self) -> AssemblySpec {
        let name_of = |on: Option<usize>| on.map_or(BASE, |on| &self.blocks[on].name).to_owned();
        let block = |block: &Block| BlockSpec {
            name: block.name.clone(),
            machine: Value::try_from(block.machine.spec()).expect("a machine is plain data"),
            set: Vec::new(),
            on: name_of(block.mount.on),
            at: block.mount.at.into(),
            x: block.mount.axes.column(0).into_owned().into(),
            y: block.mount.axes.column(1).into_owned().into(),
        };
        AssemblySpec {
            kind: AssemblyKind::Assembly,
            name: self.name.clone(),
            summary: self.summary.clone(),
            gravity: self.gravity.into(),
            blocks: self.blocks.iter().map(block).collect(),
        }
    }

    /// Returns whether it is a machine by itself.
    pub fn is_of_one(&self) -> bool {
        self.blocks.len() == 1
    }

    /// Returns the same assembly of other machines: `change` gets the name and the machine of each block.
    ///
    /// # Errors
    /// That of `change`.
    pub fn with_machines<E>(mut self, change: impl Fn(&str, Machine) -> Result<Machine, E>) -> Result<Self, E> {
        for block in &mut self.blocks {
            let machine = change(&block.name, block.machine.clone())?;
            *block = Block::new(std::mem::take(&mut block.name), machine, block.mount.clone());
        }
        Ok(self)
    }

    /// Returns its blocks, in the order of the file.
    pub fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    /// Returns the places of the blocks, each after the one that carries it.
    pub fn order(&self) -> &[usize] {
        &self.order
    }

    /// Returns the blocks that sit on the platform of a block, or on the base.
    pub fn carried_by(&self, carrier: Option<usize>) -> impl Iterator<Item = usize> {
        (0..self.blocks.len()).filter(move |i| self.blocks[*i].mount.on == carrier)
    }

    /// Returns a block after all that carry it, the one on the base first.
    ///
    /// # Panics
    /// If there is no such block.
    pub fn chain(&self, block: usize) -> Vec<usize> {
        let mut chain: Vec<usize> = std::iter::successors(Some(block), |i| self.blocks[*i].mount.on).collect();
        chain.reverse();
        chain
    }

    /// Returns the first of the longest chains of blocks that carry each other, the one on the base first.
    pub fn longest_chain(&self) -> Vec<usize> {
        let chains = (0..self.blocks.len()).rev().map(|block| self.chain(block));
        chains.max_by_key(Vec::len).unwrap_or_default()
    }

    /// Returns a block with all that it carries, on the base, and which blocks these are.
    pub fn branch(&self, block: usize) -> (Self, Vec<usize>) {
        let mut kept = vec![block];
        kept.extend(self.order.iter().filter(|i| **i != block && self.is_carried_by(**i, block)));
        let place = |i: usize| kept.iter().position(|own| *own == i);
        let own = kept.iter().map(|i| {
            let mut own = self.blocks[*i].clone();
            own.mount.on = own.mount.on.and_then(place);
            own
        });
        let blocks: Vec<Block> = own.collect();
        let order = (0..kept.len()).collect();
        (Self { name: self.name.clone(), summary: self.summary.clone(), gravity: self.gravity, blocks, order }, kept)
    }

    /// Returns whether a block is carried by another, directly or by way of others.
    fn is_carried_by(&self, block: usize, carrier: usize) -> bool {
        self.blocks[block].mount.on.is_some_and(|on| on == carrier || self.is_carried_by(on, carrier))
    }

    /// Number of the first link of a block, if the links of all blocks are counted in their order, from 0.
    pub fn first_link(&self, block: usize) -> usize {
        self.blocks[..block].iter().map(|own| own.machine.links().len()).sum()
    }

    /// Returns the block of a link that is counted through all blocks, and its number there; `None` if there is no such
    /// link.
    pub fn link_at(&self, number: usize) -> Option<(usize, usize)> {
        let all = self.blocks.iter().enumerate();
        let mut each = all.flat_map(|(i, own)| (0..own.machine.links().len()).map(move |link| (i, link)));
        each.nth(number)
    }

    /// Mass of a block and of all that it carries, kg.
    pub fn mass_above(&self, block: usize) -> f64 {
        // Carriers come first, so no block is met twice and the recursion ends.
        self.blocks[block].inertia.mass() + self.carried_by(Some(block)).map(|i| self.mass_above(i)).sum::<f64>()
    }

    /// Total mass, kg.
    pub fn mass(&self) -> f64 {
        self.blocks.iter().map(|block| block.inertia.mass()).sum()
    }
}

/// Returns three numbers as a vector, if they are finite and not too large.
fn vector(numbers: &[f64; 3]) -> Option<Vector3<f64>> {
    numbers.iter().all(|x| x.abs() <= MAX_PLACE).then(|| Vector3::from(*numbers))
}

fn numbers_wanted(numbers: &[f64; 3], unit: &str) -> String {
    format!("is {numbers:?}: want three numbers from -1000000 to 1000000 {unit}")
}

/// Checks a block, and finds its machine.
fn resolved(spec: &AssemblySpec, i: usize, block: &BlockSpec, find: FindMachine<'_>) -> Result<Block, AssemblyError> {
    let wrong = |key: &str, said: String| AssemblyError::at(i, key, said);
    if block.name.is_empty()
        || block.name == BASE
        || block.name.contains(['/', '.'])
        || control_character(&block.name).is_some()
    {
        let said = format!(
            "is {:?}: want a name of printable characters other than \"base\", without . and /",
            quote_clipped(&block.name)
        );
        return Err(wrong("name", said));
    }
    if spec.blocks[..i].iter().any(|other| other.name == block.name) {
        return Err(wrong(
            "name",
            format!("is {:?}, which is taken: want a name of its own", quote_clipped(&block.name)),
        ));
    }
    let names = || spec.blocks.iter().map(|other| other.name.clone());
    let on = match block.on.as_str() {
        BASE => None,
        name => Some(spec.blocks.iter().position(|other| other.name == name).ok_or_else(|| AssemblyError {
            known: [BASE.to_owned()].into_iter().chain(names()).collect(),
            ..wrong("on", format!("names the block {:?}, which does not exist", quote_clipped(name)))
        })?),
    };
    let at = vector(&block.at).ok_or_else(|| wrong("at", numbers_wanted(&block.at, "m")))?;
    let axes = axes(i, block)?;
    let machine = match &block.machine {
        Value::String(name) => find(name).map_err(|why| wrong("machine", shortened(&why.to_string(), MAX_SAID)))?,
        Value::Table(whole) => {
            let read: Result<MachineSpec, _> = whole.clone().try_into();
            let spec = read.map_err(|why| wrong("machine", shortened(why.message(), MAX_SAID)))?;
            Machine::new(spec).map_err(|why| wrong("machine", shortened(&why.to_string(), MAX_SAID)))?
        }
        _ => return Err(wrong("machine", "want the name or file of a machine, or a whole machine as a table".into())),
    };
    let mut settings = Vec::with_capacity(block.set.len());
    for setting in &block.set {
        let pair = setting.split_once('=').map(|(key, value)| (key.trim(), value.trim()));
        settings.push(pair.ok_or_else(|| wrong("set", format!("is {:?}: want KEY=VALUE", quote_clipped(setting))))?);
    }
    let machine = machine.set_all(settings).map_err(|why| wrong("set", shortened(&why.to_string(), MAX_SAID)))?;
    if machine.spec().gravity != [0.0; 2] {
        let said =
            "states gravity in its own plane: want gravity = [x, y, z] of the assembly, and none of its machines";
        return Err(wrong("machine", format!("{} {said}", quote_clipped(machine.name()))));
    }
    if machine.drives() >= MAX_DRIVES {
        let most = MAX_DRIVES - 1;
        return Err(wrong("machine", format!("has {} drives: want at most {most} in an assembly", machine.drives())));
    }
    Ok(Block::new(&block.name, machine, Mount { on, at, axes }))
}

/// Returns the directions of a block's plane, of unit length, and its axis.
fn axes(i: usize, block: &BlockSpec) -> Result<Matrix3<f64>, AssemblyError> {
    let direction = |key: &str, numbers: &[f64; 3]| {
        let wrong = || AssemblyError::at(i, key, format!("is {numbers:?}: want a direction in space, as [1, 0, 0]"));
        let length = vector(numbers).map_or(0.0, |v| v.norm());
        if length > 0.0 { Ok(Vector3::from(*numbers) / length) } else { Err(wrong()) }
    };
    let (x, y) = (direction("x", &block.x)?, direction("y", &block.y)?);
    let along = x.dot(&y);
    let across = y - along * x;
    if along.abs() > MAX_SKEW_RAD {
        let angle = along.clamp(-1.0, 1.0).acos().to_degrees();
        let mend = match across.norm() > 1e-9 {
            true => {
                let [a, b, c] = (across / across.norm()).map(|v| (v * 1e9).round() / 1e9 + 0.0).into();
                format!("a right angle, as y = [{a}, {b}, {c}]")
            }
            false => "y at a right angle to x".to_owned(),
        };
        return Err(AssemblyError::at(i, "y", format!("is {angle:.4}° from x: want {mend}")));
    }
    let y = across / across.norm();
    Ok(Matrix3::from_columns(&[x, y, x.cross(&y)]))
}

/// Returns the blocks each after its carrier.
fn carrying_order(blocks: &[Block]) -> Result<Vec<usize>, AssemblyError> {
    let mut order: Vec<usize> = Vec::with_capacity(blocks.len());
    while order.len() < blocks.len() {
        let next = (0..blocks.len())
            .find(|i| !order.contains(i) && blocks[*i].mount.on.is_none_or(|carrier| order.contains(&carrier)));
        let Some(next) = next else {
            let (i, _) = blocks.iter().enumerate().find(|(i, _)| !order.contains(i)).unwrap_or((0, &blocks[0]));
            return Err(AssemblyError::at(i, "on", loop_of(blocks, i)));
        };
        order.push(next);
    }
    Ok(order)
}

/// Says which blocks carry each other in a loop, from a block on.
fn loop_of(blocks: &[Block], from: usize) -> String {
    let (mut names, mut at) = (vec![blocks[from].name.as_str()], from);
    while let Some(on) = blocks[at].mount.on.filter(|_| names.len() <= blocks.len()) {
        names.push(&blocks[on].name);
        at = on;
        if on == from {
            break;
        }
    }
    let chain = shortened(&names.join(" on "), 200);
    format!("carries itself ({chain}): want a chain that ends on \"base\"")
}
