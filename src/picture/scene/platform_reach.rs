//! [`PlatformReach`]: where the last platform of blocks that carry each other can be while each holds its b, as lines on
//! surfaces in space.
//!
//! The last block reaches a region or a curve in its plane, from wherever its carrier has its platform. So the reach is the
//! sum of both sets, and its surfaces are among the sums of their boundaries: of two regions, sums of points at which both
//! boundaries face the same way along the line in which their planes cross. Each b turns its own set about its pin.

use std::sync::Arc;

use nalgebra::{Matrix3, Vector3};

use super::palette::{Palette, faded};
use super::{Polyline, Scene, Strips};
use stillbase_mechanics::planar::{Vector, unit};
use stillbase_planning::pose_space::{Outline, PoseSpace};
use stillbase_session::Run;
use stillbase_session::assembly::SharedRun;
use stillbase_simulation::frame::Frame;

/// Number of lines along each boundary, and of points on each line.
const LINES: [usize; 2] = [16, 36];
const POINTS: usize = 72;

/// Opacity and width, px, of the lines.
const OPACITY: f32 = 0.3;
const WIDTH_PX: f32 = 0.8;

/// The boundary of what a block reaches in its plane at a b.
#[derive(Clone, Debug)]
struct BlockReach {
    block: usize,
    /// Closed loops or one curve, m from the base pin.
    lines: Vec<Vec<Vector>>,
    /// Whether the lines bound a region, which is to their left.
    bounds: bool,
    b: f64,
    lambda_sum: f64,
    axes: Matrix3<f64>,
    height: f64,
}

impl BlockReach {
    fn of(block: usize, run: &Run, axes: Matrix3<f64>, height: f64) -> Option<Self> {
        let space: &Arc<PoseSpace> = run.pose_space().ok()?;
        let b = run.frame().b_reference;
        let Outline { loops, curve, .. } = space.outline(b);
        let close = |mut line: Vec<[f64; 2]>| {
            line.extend(line.first().copied());
            line
        };
        let bounds = !loops.is_empty();
        let all = if loops.is_empty() { vec![curve] } else { loops.into_iter().map(close).collect() };
        let lines = all.iter().filter(|line| line.len() > 1).map(|line| evenly(line, POINTS)).collect();
        Some(Self { block, lines, bounds, b, lambda_sum: space.lambda_sum(), axes, height })
    }

    /// Returns the lines at another b, in axes of the base; each point with how far the boundary faces along a direction,
    /// 0 on a curve.
    fn at(&self, b: f64, along: &Vector3<f64>) -> Vec<Vec<(Vector3<f64>, f64)>> {
        let turn = unit((b - self.b) / self.lambda_sum);
        let place = |p: &Vector| {
            let p = turn * p;
            self.axes * Vector3::new(p.re, p.im, self.height)
        };
        let facing = |way: Vector3<f64>| if self.bounds { way.cross(&self.axes.column(2)).dot(along) } else { 0.0 };
        let line = |line: &Vec<Vector>| {
            let places: Vec<Vector3<f64>> = line.iter().map(place).collect();
            let way = |i: usize| places[(i + 1).min(places.len() - 1)] - places[i.saturating_sub(1)];
            (0..places.len()).map(|i| (places[i], facing(way(i)))).collect()
        };
        self.lines.iter().map(line).collect()
    }
}

/// Returns points at even distances along a line.
fn evenly(line: &[[f64; 2]], count: usize) -> Vec<Vector> {
    let points: Vec<Vector> = line.iter().map(|[x, y]| Vector::new(*x, *y)).collect();
    let mut way = vec![0.0];
    way.extend(points.windows(2).scan(0.0, |sum, pair| {
        *sum += (pair[1] - pair[0]).norm();
        Some(*sum)
    }));
    let whole = way[way.len() - 1];
    let at = |i: usize| {
        let wanted = whole * i as f64 / count as f64;
        let k = way.partition_point(|x| *x < wanted).clamp(1, points.len() - 1);
        let run = way[k] - way[k - 1];
        let share = if run > 0.0 { ((wanted - way[k - 1]) / run).clamp(0.0, 1.0) } else { 0.0 };
        points[k - 1] + share * (points[k] - points[k - 1])
    };
    (0..=count).map(at).collect()
}

/// The reach of the last platform.
#[derive(Clone, Debug)]
pub struct PlatformReach {
    carrier: BlockReach,
    last: BlockReach,
    /// Place of the last block from the end effector of its carrier, m, in axes of the base.
    between: Vector3<f64>,
}

impl PlatformReach {
    /// Returns the reach of a block that carries no other; `None` if no block carries another, or one of
    /// the two has no b.
    pub fn of(run: &Run, shared: &SharedRun) -> Option<Self> {
        let assembly = &shared.block().scenario.assembly;
        let carried = |i: &&usize| assembly.blocks()[**i].mount.on.is_some();
        let last = *assembly.order().iter().rev().find(carried)?;
        let carrier = assembly.blocks()[last].mount.on?;
        let led = shared.block().block;
        let reach = |i: usize| {
            let own =
                if i == led { Some(run) } else { shared.others().find(|(other, _)| *other == i).map(|(_, run)| run) };
            let block = &assembly.blocks()[i];
            BlockReach::of(i, own?, block.mount.axes, block.platform_height())
        };
        let between = assembly.blocks()[last].mount.at;
        Some(Self { carrier: reach(carrier)?, last: reach(last)?, between })
    }

    /// Returns the carrier, from whose mount the lines are.
    pub fn carrier(&self) -> usize {
        self.carrier.block
    }

    /// Adds the lines; `frame` returns that of a block, and `place` takes a point in axes of the base, from the mount of
    /// the carrier, to the world.
    pub fn draw<'a>(
        &self,
        scene: &mut Scene,
        palette: &Palette,
        frame: impl Fn(usize) -> Option<&'a Frame>,
        place: impl Fn(&Vector3<f64>) -> [f32; 3],
    ) {
        let (Some(below), Some(above)) = (frame(self.carrier.block), frame(self.last.block)) else { return };
        let crossing = self.carrier.axes.column(2).cross(&self.last.axes.column(2));
        let (first, second) =
            (self.carrier.at(below.b_reference, &crossing), self.last.at(above.b_reference, &crossing));
        let mut strips: Vec<Vec<[f32; 3]>> = Vec::new();
        // Each boundary at points of the other one.
        for ((along, across), count) in [((&first, &second), LINES[0]), ((&second, &first), LINES[1])] {
            for other in across {
                let step = (other.len() - 1).div_ceil(count).max(1);
                for (p, facing) in other.iter().step_by(step) {
                    for line in along {
                        let parts = line.split(|(_, own)| own * facing < 0.0).filter(|part| part.len() > 1);
                        strips.extend(
                            parts.map(|part| {
                                part.iter().map(|(q, _)| place(&(self.between + p + q))).collect::<Vec<_>>()
                            }),
                        );
                    }
                }
            }
        }
        let strips: Strips = strips.into();
        scene.lines.push(Polyline::new("reach", strips, WIDTH_PX, faded(palette.amber, OPACITY)));
    }
}
