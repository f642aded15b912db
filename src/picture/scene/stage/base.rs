//! The base (a plate that floats or is mounted on springs), its reaction wheel and the payload. If the base moves,
//! dashed outlines show base and machine as if it had not moved.

use std::f64::consts::{FRAC_PI_2, TAU};

use crate::numbers::{signed, three_digits};
use crate::scene::arrow::head;
use crate::scene::exaggeration::DrawnFrame;
use crate::scene::linkage::{LinkageModel, PLATE_HALF_SIZE};
use crate::scene::options::{Handle, ViewOptions};
use crate::scene::palette::{Palette, faded, mix};
use crate::scene::{Anchor, Label, Marker, Polyline, Scene, Transform, point, posed};
use stillbase_mechanics::machine::{Machine, Payload};
use stillbase_mechanics::planar::{Pose2, UnitVectors, Vector, unit};
use stillbase_session::Run;
use stillbase_simulation::frame::Frame;
use stillbase_simulation::plant::{Base, BaseKind, Load};

/// Base and payload of a stage; they can change without a new stage.
#[derive(Clone, Debug)]
pub struct BaseStage {
    base: Base,
    load: Load,
    /// Whether there is no gravity.
    weightless: bool,
    /// Index of the drive of the link with the end effector, and its sign: 1 along the drive, −1 opposite.
    holder: (usize, f64),
    /// Outlines and ribs of the panels of a floating base, in the frame of the base.
    panels: [Vec<Vec<[f32; 3]>>; 2],
}

/// Applied force per distance that the pointer is dragged from the end effector, N/m.
pub const PULL_STIFFNESS: f64 = 20.0;

/// Motion of the base below this counts as rest, m and rad.
const REST_THRESHOLD: f64 = 1e-12;
/// Turn and shift below this fraction of the other, rad and m, count for nothing.
const NEGLIGIBLE: f64 = 1e-6;

impl BaseStage {
    /// Prepares base and payload of a run; `plant` is the machine with the lengths of the plant.
    pub fn of(run: &Run, plant: &Machine, linkage: &LinkageModel) -> Self {
        let scenario = run.scenario();
        let holder = &plant.resolved_links()[plant.end_link()];
        Self {
            base: scenario.base,
            load: scenario.plant.payload,
            weightless: scenario.machine.gravity().norm() == 0.0,
            holder: (holder.drive, holder.sign),
            panels: panels(linkage),
        }
    }

    /// Updates base and payload from a run.
    pub fn refresh(&mut self, run: &Run) {
        let scenario = run.scenario();
        (self.base, self.load) = (scenario.base, scenario.plant.payload);
        self.weightless = scenario.machine.gravity().norm() == 0.0;
    }

    /// Whether the base can move.
    pub fn moves(&self) -> bool {
        self.base.moves()
    }

    /// Returns the corners of the plate of a base that can move, in its frame, m; none of one that is fixed.
    pub fn corners(&self, linkage: &LinkageModel) -> Vec<Vector> {
        let [x, y] = PLATE_HALF_SIZE.map(|part| part * linkage.reach());
        let corners = [[x, y], [-x, y], [-x, -y], [x, -y]].map(|[x, y]| Vector::new(x, y));
        if self.moves() { corners.to_vec() } else { Vec::new() }
    }

    /// Whether the moment that turns the base may differ from n_B.
    pub fn feels_more_than_n_b(&self) -> bool {
        self.base.feels_more_than_n_b()
    }

    /// Returns the name of the constant force on the base.
    pub fn static_force_name(&self, options: &ViewOptions) -> &'static str {
        match options.external_force {
            Some([x, y]) if x.hypot(y) > 0.0 && self.weightless => "the push",
            Some([x, y]) if x.hypot(y) > 0.0 => "its weight with the push",
            _ => "its weight",
        }
    }

    /// Draws the symbols of the base: panels or springs, the centre of mass of a base that can move, and the wheel.
    pub fn draw(&self, scene: &mut Scene, linkage: &LinkageModel, palette: &Palette, shown: &DrawnFrame<'_>) {
        let reach = linkage.reach();
        let (z, top) = (linkage.bottom(), linkage.top());
        let place = |p: Vector| shown.base.at + p * unit(shown.base.angle);
        let [length, width] = PLATE_HALF_SIZE.map(|part| part * reach);
        match self.base.kind {
            BaseKind::Fixed => {}
            BaseKind::Free => {
                let edge = mix(palette.dim, palette.line, 0.4);
                let with_base = posed(shown.base.at, unit(shown.base.angle), 0.0);
                let [outlines, ribs] = &self.panels;
                let line = |name: &'static str, strips: &[Vec<[f32; 3]>], width, colour| {
                    Polyline::new(name, strips, width, colour).moving(with_base)
                };
                scene.lines.push(line("machine/base/panels", outlines, 1.6, edge));
                scene.lines.push(line("machine/base/panels/ribs", ribs, 1.0, faded(edge, 0.7)));
            }
            BaseKind::Compliant => {
                let colour = mix(palette.dim, palette.ink, 0.2);
                let ends = [
                    (Vector::new(-length, 0.0), Vector::new(-1.0, 0.0)),
                    (Vector::new(length, 0.0), Vector::new(1.0, 0.0)),
                    (Vector::new(0.0, -width), Vector::new(0.0, -1.0)),
                ];
                let (mut springs, mut walls, mut hatches) = (Vec::new(), Vec::new(), Vec::new());
                for (from, out) in ends {
                    let foot = from + out * (0.13 * reach);
                    springs.push(spring(place(from), foot, 0.018 * reach, z));
                    let across = out * Vector::new(0.0, 1.0) * (0.04 * reach);
                    walls.push(vec![point(foot - across, z), point(foot + across, z)]);
                    hatches.extend((-2..=2).map(|i| {
                        let at = foot + across * (0.45 * f64::from(i));
                        vec![point(at, z), point(at + (out - across * (4.0 / reach)) * (0.014 * reach), z)]
                    }));
                }
                scene.lines.push(Polyline::new("springs", springs, 1.6, colour));
                scene.lines.push(Polyline::new("springs/feet", walls, 2.2, colour).constant());
                scene.lines.push(Polyline::new("springs/feet/ground", hatches, 1.0, faded(colour, 0.8)).constant());
            }
        }
        if self.base.moves() {
            let [x, y] = self.base.com;
            let at = point(place(Vector::new(x, y)), top);
            let disc = Marker::disc("base_com", at, 4.5, faded(palette.background, 0.6));
            scene.markers.push(disc.edged(palette.dim, 1.8));
        }
        if self.feels_more_than_n_b() {
            self.wheel(scene, linkage, palette, shown);
        }
    }

    fn wheel(&self, scene: &mut Scene, linkage: &LinkageModel, palette: &Palette, shown: &DrawnFrame<'_>) {
        let (z, radius, frame) = (linkage.top(), 0.082 * linkage.reach(), shown.frame);
        let colour = if frame.wheel.saturated { palette.reaction } else { palette.dim };
        let spun = unit(frame.totals.wheel_turn.rem_euclid(TAU));
        let pose: Transform = posed(shown.base.at, spun, z);
        let on = |angle: f64, share: f64| point(unit(angle) * (share * radius), 0.0);
        let rim: Vec<_> = (0..=72).map(|i| on(TAU * f64::from(i) / 72.0, 1.0)).collect();
        let spokes = (0..3).map(|i| TAU * f64::from(i) / 3.0).map(|angle| vec![on(angle, 0.72), on(angle, 1.0)]);
        // Not `moving`, which would mean that only the pose changes: the colour changes when the wheel saturates.
        let line = |name: &'static str, strips: Vec<_>, width| Polyline {
            world_from_item: pose,
            ..Polyline::new(name, strips, width, colour).on_top()
        };
        scene.lines.push(line("wheel", vec![rim], 2.0));
        scene.lines.push(line("wheel/spokes", spokes.collect(), 1.6));
        let at = point(shown.base.at + spun * radius, z);
        scene.markers.push(Marker::disc("wheel/mark", at, 4.0, colour).edged(palette.background, 1.0));
    }

    /// Returns the drawn position of the payload, m, while the machine holds it.
    pub fn load_at(&self, shown: &DrawnFrame<'_>) -> Option<Vector> {
        shown.frame.loaded.then(|| self.held_at(shown, self.load.offset))
    }

    /// Returns the drawn position of what is held at offsets along and across the link that holds it, m.
    fn held_at(&self, shown: &DrawnFrame<'_>, [x, y]: [f64; 2]) -> Vector {
        let (drive, sign) = self.holder;
        shown.end_effector + shown.q.units()[drive] * Vector::new(x, y) * sign
    }

    /// Converts a drawn position of the payload, m, to offsets along and across the link that holds it, m.
    pub fn offset_at(&self, shown: &DrawnFrame<'_>, at: Vector) -> [f64; 2] {
        let (drive, sign) = self.holder;
        let off = (at - shown.end_effector) * shown.q.units()[drive].conj() * sign;
        [off.re, off.im]
    }

    /// Draws the payload, and the arrow of the applied force.
    pub fn load(
        &self,
        scene: &mut Scene,
        linkage: &LinkageModel,
        palette: &Palette,
        shown: &DrawnFrame<'_>,
        options: &ViewOptions,
    ) {
        let z = linkage.top();
        let of_block = shown.frame.shared.map(|shared| shared.held).filter(|held| held.mass > 0.0);
        let of_plant = || Some((point(self.load_at(shown)?, z), self.load.mass));
        // In space a load is where it counts, whatever the heights at which bars are drawn: two arms meet there.
        let in_space = |held: Payload| (point(self.held_at(shown, held.offset), held.axial), held.mass);
        if let Some((at, mass)) = of_block.map(in_space).or_else(of_plant) {
            let tip = point(shown.end_effector, z);
            if (0..3).any(|i| (at[i] - tip[i]).abs() > 1e-6) {
                let stem = vec![tip, at];
                scene.lines.push(Polyline::new("payload/stem", [stem], 2.0, palette.ink).on_top());
            }
            let hot = options.highlighted == Some(Handle::Payload);
            let radius = (5.0 + 5.0 * mass.sqrt()).min(12.0) as f32;
            let disc = Marker::disc("payload", at, radius, mix(palette.background, palette.ink, 0.55));
            scene.markers.push(disc.edged(palette.ink, if hot { 3.0 } else { 1.6 }));
            let words = format!("{} kg", three_digits(mass));
            let offset = [0.0, -22.0];
            let own = Label::new("payload/mass", at, offset, words, palette.dim, 11.5, Anchor::Centre);
            // What a block holds belongs to its assembly's file.
            scene.labels.push(if of_block.is_some() { own } else { own.of_handle(Handle::Payload) });
        }
        let Some([x, y]) = options.external_force else { return };
        let force = Vector::new(x, y);
        let size = force.norm();
        if size < 1e-9 {
            return;
        }
        let reach = linkage.reach();
        let along = force / size;
        let to = shown.end_effector + along * (size / PULL_STIFFNESS).clamp(0.03 * reach, 0.6 * reach);
        let arrow = [vec![point(shown.end_effector, z), point(to, z)], head(to, along, 0.025 * reach, z)];
        scene.lines.push(Polyline::new("push", arrow, 2.6, palette.amber).on_top());
        let words = format!("{size:.2} N");
        let (aside, anchor) = if along.re < 0.0 { (-8.0, Anchor::Right) } else { (8.0, Anchor::Left) };
        scene.labels.push(Label::new("push/size", point(to, z), [aside, 0.0], words, palette.amber, 12.5, anchor));
    }

    /// Writes the motion of a base that can move. If it has moved visibly, also draws base and machine as if it had
    /// not. `times` is the factor of exaggeration.
    pub fn unmoved(
        &self,
        scene: &mut Scene,
        linkage: &LinkageModel,
        palette: &Palette,
        shown: &DrawnFrame<'_>,
        times: f64,
    ) {
        let Pose2 { at, angle } = shown.base;
        let reach = linkage.reach();
        if !self.base.moves() {
            return;
        }
        if at.norm() + angle.abs() * reach > 0.002 * reach {
            let (z, colour) = (linkage.floor(), faded(palette.dim, 0.75));
            let mut e: UnitVectors = shown.q.units();
            e.iter_mut().for_each(|e| *e *= unit(-angle));
            let mut strips: Vec<_> = linkage.outlines(&e).map(|ends| ends.map(|p| point(p, z)).to_vec()).collect();
            let [length, width] = PLATE_HALF_SIZE.map(|part| part * reach);
            let straight = length - width;
            let cap = |side: f64| {
                (0..=16).map(move |i| {
                    Vector::new(side * straight, 0.0)
                        + unit(side * (-FRAC_PI_2 + std::f64::consts::PI * f64::from(i) / 16.0)) * side * width
                })
            };
            let mut outline: Vec<_> = cap(1.0).chain(cap(-1.0)).map(|p| point(p, linkage.bottom())).collect();
            outline.extend(outline.first().copied());
            strips.push(outline);
            scene.lines.push(Polyline::new("unmoved", strips, 1.2, colour).dashed(3.0, 3.0));
        }
        let exaggerated = if times == 1.0 { String::new() } else { format!(" · shown ×{times}") };
        let text = format!("{}{exaggerated}", motion(shown.frame));
        let at = point(Vector::new(0.2 * reach, -0.11 * reach), linkage.top());
        scene.labels.push(Label::new("base_motion", at, [0.0, -17.0], text, palette.dim, 11.5, Anchor::Left));
    }
}

/// Returns the text of the motion of the base.
fn motion(frame: &Frame) -> String {
    let (Pose2 { at, angle }, totals) = (frame.base, &frame.totals);
    // The peak so far determines the number of decimals, so that it is constant as the base comes to rest.
    let written = |x: f64, peak: f64| match peak > REST_THRESHOLD {
        true => signed(1e3 * x, (2 - (1e3 * peak).log10().floor() as i32).clamp(0, 9) as usize),
        false => "0".into(),
    };
    // What is negligible beside the other is not named: a millimetre of shift has no picoradians of turn.
    let [turns, shifts] = [
        totals.base_angle > REST_THRESHOLD.max(NEGLIGIBLE * totals.shift),
        totals.shift > REST_THRESHOLD.max(NEGLIGIBLE * totals.base_angle),
    ];
    let shift = shifts.then(|| format!("{} mm", written(at.norm(), totals.shift)));
    let turn = turns.then(|| format!("{} mrad", written(angle, totals.base_angle)));
    match [shift, turn].into_iter().flatten().collect::<Vec<_>>().as_slice() {
        [] => "base at rest".into(),
        moves => format!("base {}", moves.join(", ")),
    }
}

/// Returns outlines and ribs of the panels of a floating base, in the frame of the base.
fn panels(linkage: &LinkageModel) -> [Vec<Vec<[f32; 3]>>; 2] {
    let (reach, z) = (linkage.reach(), linkage.bottom());
    let (near, far, half) = (PLATE_HALF_SIZE[0] + 0.035, PLATE_HALF_SIZE[0] + 0.19, 0.075);
    let (mut outlines, mut ribs) = (Vec::new(), Vec::new());
    for side in [-1.0, 1.0] {
        let at = |x: f64, y: f64| point(Vector::new(side * x * reach, y * reach), z);
        outlines.push(vec![at(near, -half), at(far, -half), at(far, half), at(near, half), at(near, -half)]);
        outlines.push(vec![at(PLATE_HALF_SIZE[0], 0.0), at(far, 0.0)]);
        ribs.extend((1..3).map(|i| {
            let x = near + f64::from(i) * (far - near) / 3.0;
            vec![at(x, -half), at(x, half)]
        }));
    }
    [outlines, ribs]
}

/// Returns a zigzag line between two points; `half` is its half width, m.
fn spring(from: Vector, to: Vector, half: f64, z: f64) -> Vec<[f32; 3]> {
    const SEGMENTS: i32 = 9;
    let way = to - from;
    let across = way / way.norm().max(1e-12) * Vector::new(0.0, half);
    let at = |i: i32| {
        let side = match i {
            0 | SEGMENTS => 0.0,
            i if i % 2 == 0 => 1.0,
            _ => -1.0,
        };
        // Only the last piece, from 88 % of the way to `to`, lies straight along the spring.
        let share = if i == 0 { 0.0 } else { 0.12 + 0.76 * f64::from(i) / f64::from(SEGMENTS) };
        point(from + way * share + across * side, z)
    };
    (0..=SEGMENTS).map(at).chain([point(to, z)]).collect()
}
