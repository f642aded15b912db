//! [`SharedRun`]: the blocks beside the one that a run leads, and the base that all of them share.

use std::collections::BTreeMap;
use std::sync::Arc;

use nalgebra::{DVector, Vector3};

use super::against::against;
use super::base::MovingSupport;
use super::block::AssemblyBlock;
use super::frame::{AssemblyFrame, AssemblyVerdict};
use crate::changes::in_order;
use crate::edit::{Edit, TimedEdit};
use crate::refusal::Refusal;
use crate::run::Run;
use stillbase_mechanics::assembly::{Assembly, BlockState, MAX_BLOCKS};
use stillbase_mechanics::planar::{DriveAngles, PerDrive};
use stillbase_planning::platform::{ChainBlock, FreedomChoice, PlatformChain, follow};
use stillbase_query::{ByIdentity, Queries, QuickQuery, QuickWork};
use stillbase_settings::range::quote_clipped;
use stillbase_simulation::frame::{Frame, Peaks, SharedBase};

/// The other blocks of an assembly in motion, step by step with the block that is led.
#[derive(Clone, Debug)]
pub struct SharedRun {
    block: Arc<AssemblyBlock>,
    /// The assembly from each step on at which its blocks have passed on what they held.
    handed: Vec<(u64, Arc<Assembly>)>,
    others: Vec<Option<OtherBlock>>,
    /// Blocks and base at the present step.
    now: AssemblyFrame,
    /// Peaks of |τ| of the motors of each block, N m.
    peaks: [PerDrive; MAX_BLOCKS],
    base: MovingSupport,
    verdict: AssemblyVerdict,
    /// The block whose b follows that of the block that is led, with `c` and `f` of b′ = c + f b.
    bound: Option<(usize, [f64; 2])>,
}

/// A block that is not led, with the edits of its scenario.
#[derive(Clone, Debug)]
struct OtherBlock {
    run: Run,
    /// Frame of the present step, of the block by itself.
    frame: Frame,
    script: Arc<[TimedEdit]>,
    /// Index of the first edit that is not applied yet.
    next: usize,
}

impl OtherBlock {
    /// Applies the edits that are due. They were applied before, when their block was led.
    fn edit(&mut self) {
        let step = self.run.simulation().step_count();
        while let Some(due) = self.script.get(self.next).filter(|timed| timed.step <= step) {
            self.next += 1;
            if self.run.apply(&due.edit).is_err() {
                break;
            }
            self.frame = self.run.frame();
        }
    }

    fn advance(&mut self) {
        self.run.advance();
        self.frame = self.run.frame();
    }
}

/// Returns the assembly after hand-overs; without one, that of the scenario.
fn held_by<'a>(handed: &'a [(u64, Arc<Assembly>)], block: &'a AssemblyBlock) -> &'a Assembly {
    handed.last().map_or(&block.scenario.assembly, |(_, assembly)| assembly)
}

/// Query for the other blocks at their start.
struct OtherBlocks;

impl QuickQuery for OtherBlocks {
    type Input = ByIdentity<AssemblyBlock>;
    type Answer = Result<Vec<Option<OtherBlock>>, Refusal>;

    fn answer(ByIdentity(block): &Self::Input) -> Self::Answer {
        let assembly = &block.scenario.assembly;
        let begun = |(i, task): (usize, &super::file::BlockTask)| {
            if i == block.block {
                return Ok(None);
            }
            let script: Arc<[TimedEdit]> = in_order(&task.scenario.edits).into();
            let begun = Run::begin(&task.scenario, &script, None).map_err(|failed| failed.named(&task.scenario.edits));
            let begun = begun.and_then(|(run, next)| match run.waiting() {
                Some(waiting) => Err(waiting.why.clone()),
                None => Ok((run, next)),
            });
            let (run, next) = begun
                .map_err(|why| Refusal::OfBlock { block: assembly.blocks()[i].name.clone(), why: Box::new(why) })?;
            let mut other = OtherBlock { frame: run.frame(), run, script, next };
            other.edit();
            Ok(Some(other))
        };
        block.scenario.tasks.iter().enumerate().map(begun).collect()
    }
}

/// Returns the state of motion of a frame.
fn state_of(frame: &Frame) -> BlockState {
    BlockState { q: frame.q, qd: frame.qd, qdd: frame.qdd }
}

/// Returns the state at a share of a step of h seconds between two states: the polynomial of fifth degree with their
/// angles, rates and accelerations.
fn between(from: &BlockState, to: &BlockState, h: f64, share: f64) -> BlockState {
    let n = from.qd.len();
    let of = |k: usize| {
        let [p, v, a] = [from.q[k], h * from.qd[k], h * h * from.qdd[k]];
        let [end, end_v, end_a] = [to.q[k], h * to.qd[k], h * h * to.qdd[k]];
        // What the parabola from the start misses at the end.
        let (d, dv, da) = (end - p - v - 0.5 * a, end_v - v - a, end_a - a);
        let c = [10.0 * d - 4.0 * dv + 0.5 * da, -15.0 * d + 7.0 * dv - da, 6.0 * d - 3.0 * dv + 0.5 * da];
        let s = share;
        let angle = p + s * (v + s * (0.5 * a + s * (c[0] + s * (c[1] + s * c[2]))));
        let rate = v + s * (a + s * (3.0 * c[0] + s * (4.0 * c[1] + s * 5.0 * c[2])));
        let acceleration = a + s * (6.0 * c[0] + s * (12.0 * c[1] + s * 20.0 * c[2]));
        [angle, rate / h, acceleration / (h * h)]
    };
    BlockState {
        q: DriveAngles(PerDrive::from_fn(n, |k| of(k)[0])),
        qd: PerDrive::from_fn(n, |k| of(k)[1]),
        qdd: PerDrive::from_fn(n, |k| of(k)[2]),
    }
}

/// Length of the steps by which a way in space is followed, m, and their greatest number.
const STRIDE: f64 = 0.01;
const MAX_STRIDES: f64 = 200.0;

/// Returns the angles with which a chain comes along a way as far as it can, with least rates.
fn nearest_on(chain: &PlatformChain, from: DVector<f64>, way: &[Vector3<f64>]) -> DVector<f64> {
    let mut last = from;
    for pair in way.windows(2) {
        match follow(chain, FreedomChoice::LeastRates, last.clone(), pair) {
            Ok(mut all) => last = all.pop().unwrap_or(last),
            Err(_) => break,
        }
    }
    last
}

impl SharedRun {
    /// Returns the other blocks at their start, while the block that is led is in the state of a frame.
    ///
    /// # Errors
    /// If the task of a block cannot be planned.
    pub fn new(block: &Arc<AssemblyBlock>, led: &Frame, queries: &Queries) -> Result<Self, Refusal> {
        let others = queries.ask::<QuickWork<OtherBlocks>>(&ByIdentity(block.clone()));
        let follower = block.scenario.follower_of(block.block);
        let b_of = |i: usize| block.scenario.tasks[i].scenario.task.b;
        let AssemblyBlock { scenario, .. } = &**block;
        let others = Result::clone(&others)?;
        let none = PerDrive::zeros(0);
        let mut states = [BlockState { q: DriveAngles(none), qd: none, qdd: none }; MAX_BLOCKS];
        states[block.block] = state_of(led);
        for (i, other) in others.iter().enumerate() {
            states[i] = other.as_ref().map_or(states[i], |other| state_of(&other.frame));
        }
        let base = MovingSupport::of(&scenario.base, &scenario.assembly, &states, scenario.step)?;
        let drives = |i: usize| scenario.assembly.blocks().get(i).map_or(0, |block| block.machine.drives());
        let mut shared = Self {
            now: AssemblyFrame::of(&scenario.assembly, (led.step, led.time), states, &base),
            peaks: std::array::from_fn(|i| PerDrive::zeros(drives(i))),
            block: block.clone(),
            handed: Vec::new(),
            others,
            base,
            verdict: AssemblyVerdict::default(),
            bound: follower.map(|(i, factor)| (i, [b_of(i) - factor * led.b_reference, factor])),
        };
        shared.see(led);
        Ok(shared)
    }

    /// Returns the place of the block that is led.
    pub fn block(&self) -> &Arc<AssemblyBlock> {
        &self.block
    }

    /// Returns the runs of the other blocks, each with its place in the assembly.
    pub fn others(&self) -> impl Iterator<Item = (usize, &Run)> {
        self.others.iter().enumerate().filter_map(|(i, other)| Some((i, &other.as_ref()?.run)))
    }

    /// Returns the frames of the other blocks at the present step, each with its place in the assembly.
    pub fn frames(&self) -> impl Iterator<Item = (usize, Frame)> {
        let own = |(i, other): (usize, &Option<OtherBlock>)| Some((i, self.in_space(i, other.as_ref()?.frame)));
        self.others.iter().enumerate().filter_map(own)
    }

    /// Returns blocks and base at the present step.
    pub fn now(&self) -> &AssemblyFrame {
        &self.now
    }

    /// Returns the assessment up to the present step.
    pub fn verdict(&self) -> &AssemblyVerdict {
        &self.verdict
    }

    /// Returns the assembly with what its blocks hold at the present step.
    pub fn assembly(&self) -> &Assembly {
        held_by(&self.handed, &self.block)
    }

    /// Returns the same at a step that has passed.
    pub fn assembly_at(&self, step: u64) -> &Assembly {
        let count = self.handed.partition_point(|(from, _)| *from <= step);
        held_by(&self.handed[..count], &self.block)
    }

    /// Returns the place of a block by its name; `key` is where the name stands.
    fn named(&self, key: &str, name: &str) -> Result<usize, Refusal> {
        let blocks = self.block.scenario.assembly.blocks();
        blocks.iter().position(|block| block.name == name).ok_or_else(|| {
            let names: Vec<&str> = blocks.iter().map(|block| block.name.as_str()).collect();
            let name = quote_clipped(name);
            Refusal::Task(format!("{key} names no block: {name:?}; want one of {}", names.join(", ")))
        })
    }

    /// Checks that targets are those of blocks.
    ///
    /// # Errors
    /// If one is of no block.
    pub fn check_targets(&self, targets: &BTreeMap<String, [f64; 2]>) -> Result<(), Refusal> {
        targets.keys().try_for_each(|name| self.named("targets", name).map(|_| ()))
    }

    /// Passes what a block holds to another, and what that holds to the first. The caller sees the present step anew.
    ///
    /// # Errors
    /// If there is no such block, or as [`Assembly::exchanged`].
    pub fn hand_over(&mut self, from: &str, to: &str) -> Result<(), Refusal> {
        let pair = [self.named("from", from)?, self.named("to", to)?];
        let handed = self.assembly().exchanged(pair, &self.now.states);
        self.handed.push((self.now.step, Arc::new(handed.map_err(Refusal::Task)?)));
        Ok(())
    }

    /// Returns the targets of the blocks by which the end effector of the led one comes to a point of its plane with a
    /// height, m, in the axes of the block; of a point out of reach, as near as the way there leads. `run` is that of the
    /// led block; `None` if it carries itself, or a block of its chain holds no b.
    pub fn targets_in_space(&self, run: &Run, point: &Vector3<f64>) -> Option<BTreeMap<String, [f64; 2]>> {
        let own = &self.block.scenario.assembly.blocks()[self.block.block].mount;
        let below = own.on.map_or_else(Vector3::zeros, |on| self.now.tips[on]);
        self.targets_on_base(run, &(below + own.at + own.axes * point))
    }

    /// Does the same as [`targets_in_space`](Self::targets_in_space) for a place in axes of the base, m.
    pub fn targets_on_base(&self, run: &Run, to: &Vector3<f64>) -> Option<BTreeMap<String, [f64; 2]>> {
        let assembly = &self.block.scenario.assembly;
        let chain = assembly.chain(self.block.block);
        if chain.len() < 2 {
            return None;
        }
        let (mut parts, mut angles) = (Vec::new(), Vec::new());
        for i in &chain {
            let run = if *i == self.block.block { run } else { &self.others.get(*i)?.as_ref()?.run };
            let space = run.pose_space().ok()?;
            let (a, b) = space.project(&run.simulation().reference().q);
            parts.push(ChainBlock::of(&assembly.blocks()[*i], space.clone(), b));
            angles.extend(a.iter().copied());
        }
        let chain_of = PlatformChain::new(parts);
        let from = chain_of.place(&angles);
        let count = ((to - from).norm() / STRIDE).ceil().clamp(1.0, MAX_STRIDES) as usize;
        let way: Vec<Vector3<f64>> = (0..=count).map(|i| from + (i as f64 / count as f64) * (to - from)).collect();
        let reached = nearest_on(&chain_of, DVector::from_vec(angles), &way);
        let ends = chain_of.ends(reached.as_slice());
        Some(chain.iter().zip(ends).map(|(i, end)| (assembly.blocks()[*i].name.clone(), [end.re, end.im])).collect())
    }

    /// Applies to the bound block what an edit of b asks of it.
    ///
    /// # Errors
    /// If it cannot follow as fast.
    pub fn follow(&mut self, edit: &Edit) -> Result<(), Refusal> {
        if let Edit::DragBlocks { targets } = edit {
            let blocks = self.block.scenario.assembly.blocks();
            for (block, other) in blocks.iter().zip(&mut self.others) {
                let Some((other, [x, y])) = other.as_mut().zip(targets.get(&block.name)) else { continue };
                let why = |why| Refusal::OfBlock { block: block.name.clone(), why: Box::new(why) };
                other.run.apply(&Edit::DragTarget { x: *x, y: *y }).map_err(why)?;
                other.frame = other.run.frame();
            }
            return Ok(());
        }
        let Some((i, [relation, factor])) = self.bound else { return Ok(()) };
        let Some(edit) = against(edit, relation, factor) else { return Ok(()) };
        let name = &self.block.scenario.assembly.blocks()[i].name;
        let Some(other) = self.others.get_mut(i).and_then(Option::as_mut) else { return Ok(()) };
        other
            .run
            .apply(&edit)
            .map_err(|why| Refusal::Task(format!("block {name}, whose b is bound to this one: {why}")))?;
        other.frame = other.run.frame();
        let (wanted, bound) = (other.run.scenario().pose_acceleration, other.run.pose_bound().unwrap_or(f64::INFINITY));
        if bound < wanted * (1.0 - 1e-9) {
            let most = bound / factor.abs();
            return Err(Refusal::Task(format!(
                "block {name}, whose b is bound to this one, cannot follow as fast: want pose_acceleration of at most \
                 {most:.4} rad/s²"
            )));
        }
        Ok(())
    }

    /// Advances the other blocks by a step; `led` is the frame of the block that is led after it.
    pub fn advance(&mut self, led: &Frame) {
        let before = self.now.states;
        self.others.iter_mut().flatten().for_each(OtherBlock::advance);
        let AssemblyBlock { scenario, .. } = &*self.block;
        if scenario.base.moves() {
            let after = self.states(led);
            let (h, count) = (scenario.step, scenario.assembly.blocks().len());
            let assembly = held_by(&self.handed, &self.block);
            self.base.advance(assembly, (h, led.time), |share| {
                let mut states = before;
                for i in 0..count {
                    states[i] = match share {
                        0.0 => before[i],
                        1.0 => after[i],
                        share => between(&before[i], &after[i], h, share),
                    };
                }
                states
            });
        }
        // Edits that are due change accelerations from here on.
        self.others.iter_mut().flatten().for_each(OtherBlock::edit);
        self.see(led);
    }

    fn states(&self, led: &Frame) -> [BlockState; MAX_BLOCKS] {
        let mut states = self.now.states;
        states[self.block.block] = state_of(led);
        for (state, other) in states.iter_mut().zip(&self.others) {
            *state = other.as_ref().map_or(*state, |other| state_of(&other.frame));
        }
        states
    }

    /// Takes over the state of the block that is led at the present step: after a step, or after an edit.
    pub fn see(&mut self, led: &Frame) {
        let states = self.states(led);
        self.now = AssemblyFrame::of(self.assembly(), (led.step, led.time), states, &self.base);
        let assembly = held_by(&self.handed, &self.block);
        self.verdict.see(assembly, &self.now);
        for (peaks, torques) in self.peaks.iter_mut().zip(&self.now.torques) {
            (0..peaks.len()).for_each(|k| peaks[k] = peaks[k].max(torques[k].abs()));
        }
    }

    /// Returns the frame of a block at the present step, with what it feels from the others and what their base does; `own`
    /// is its frame by itself.
    pub fn in_space(&self, block: usize, own: Frame) -> Frame {
        let AssemblyFrame { loads, attitude, origin, rate, .. } = self.now;
        let AssemblyVerdict { peaks, scale, turn, shift, .. } = self.verdict;
        let moves = self.block.scenario.base.moves();
        let tip = self.now.in_space(&self.now.tips[block]);
        let held = self.assembly().blocks()[block].machine.spec().payload;
        let shared = SharedBase { held, loads, attitude, origin, rate, moves, peaks, scale, turn, shift, tip };
        let peaks = Peaks { torque: self.peaks[block], ..own.peaks };
        Frame { torque: self.now.torques[block], peaks, shared: Some(shared), ..own }
    }

    /// Duration of the longest planned motion of the other blocks, s.
    pub fn planned_time(&self) -> f64 {
        let longest =
            |(i, run): (usize, &Run)| if self.block.scenario.tasks[i].rests { 0.0 } else { run.planned_time() };
        self.others().map(longest).fold(0.0, f64::max)
    }

    /// Returns whether another block was edited while it was led.
    pub fn has_edits(&self) -> bool {
        self.others.iter().flatten().any(|other| !other.script.is_empty())
    }

    /// Returns whether the other blocks are at rest.
    pub fn is_settled(&self) -> bool {
        self.others().all(|(_, run)| run.simulation().is_settled())
    }
}
