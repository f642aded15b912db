//! From a run and a frame to a [`Scene`]. A [`Stage`] holds what does not change from frame to frame.

mod base;
mod path;
mod pins;
mod reaction;
mod snapshots;
mod target;
mod workspace;

use base::Ground;
pub(super) use base::PLATE;
pub use base::PULL;
use path::Course;
pub(super) use path::looks;
pub(crate) use path::waypoints;
use pins::{Bearing, bearings};
pub use snapshots::Other;
pub(super) use target::target_handle;
use workspace::{Inside, inside, roomiest};

use super::linkage::Linkage;
use super::palette::{Palette, Theme, faded, palette};
use super::sway::swayed;
use super::{Anchor, Label, Line, Measure, Rgba, Scene};
use crate::mechanics::machine::Chain;
use crate::mechanics::planar::{DriveAngles, Vector, unit};
use crate::planning::pose_constant::Planes;
use crate::session::{Refusal, Run, Waiting};
use crate::simulation::frame::Frame;
use std::sync::{Arc, OnceLock};

/// What a person has chosen to see.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewOptions {
    /// Light or dark.
    pub theme: Theme,
    /// The workspace is shaded by this measure.
    pub dexterity: Option<Measure>,
    /// The pointer is on this handle, or drags it.
    pub hot: Option<Handle>,
    /// Where the pointer holds what it drags, m.
    pub held: Option<[f64; 2]>,
    /// A pose constant to show A, or the target, on, rad.
    pub preview_b: Option<f64>,
    /// What the pointer has drawn so far, m.
    pub stroke: Vec<[f64; 2]>,
    /// What was asked for last and refused.
    pub refused: Option<Arc<Refused>>,
    /// Poses along the motion, in the order of time, as in Fig. 5.
    pub snapshots: Vec<DriveAngles>,
    /// Other runs at the same instant.
    pub others: Vec<Other>,
    /// Arrows show what the pins carry.
    pub pin_forces: bool,
    /// How many times the base's motion is shown.
    pub sway: f64,
    /// A force at the end effector, N.
    pub push: Option<[f64; 2]>,
}

impl Default for ViewOptions {
    fn default() -> Self {
        Self {
            theme: Theme::Dark,
            dexterity: None,
            hot: None,
            held: None,
            preview_b: None,
            stroke: Vec::new(),
            refused: None,
            snapshots: Vec::new(),
            others: Vec::new(),
            pin_forces: false,
            sway: 1.0,
            push: None,
        }
    }
}

/// What the target's label says while it can be dragged; a picture that nobody can touch goes without.
pub const INVITATION: &str = "drag me";

/// What can be dragged in the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Handle {
    /// The end effector's target.
    Target,
    /// The end effector, to be pushed.
    Tip,
    /// The knob of the b ring.
    Ring,
    /// The plane b = const, in joint space or as a slice of the tower.
    Plane,
    /// A bar of the tower: the b that reach a point.
    Bar,
    /// A point of the planned path, counted from A.
    Waypoint(usize),
}

/// What somebody asked for and did not get: a curve, m, and where it cannot be followed.
#[derive(Clone, Debug, PartialEq)]
pub struct Refused {
    /// m.
    pub curve: Vec<Vector>,
    /// m.
    pub at: Vector,
    /// Why, in a few words.
    pub why: String,
}

impl Refused {
    /// The curve of a refusal, if it is of one.
    pub fn of(refusal: &Refusal) -> Option<Self> {
        let Refusal::Blocked(blocked) = refusal else { return None };
        Some(Self { curve: blocked.curve.clone(), at: blocked.at, why: blocked.stop.to_string() })
    }
}

/// What stays the same from frame to frame.
#[derive(Clone, Debug)]
pub struct Stage {
    linkage: Linkage,
    planes: Option<Arc<Planes>>,
    boundary: Vec<Vec<Vector>>,
    /// Where words about the workspace have the most room, before it is turned.
    middle: Option<Vector>,
    compare_b: Option<f64>,
    motion: Option<Course>,
    /// Why the run waits, and the curve that cannot be followed, if that is it.
    waiting: Option<(Waiting, Option<Refused>)>,
    /// Least and greatest of each measure of dexterity within the limits, found when first shown.
    dexterity: [OnceLock<[f64; 2]>; 3],
    /// Curves in the workspace, and where folds turn back, before it is turned, m.
    inside: Vec<(Inside, Vec<Vector>)>,
    cusps: Vec<Vector>,
    pins: Vec<Bearing>,
    ground: Ground,
    /// Drive that the link with the end effector follows, and which way.
    holder: (usize, f64),
}

impl Stage {
    /// Prepares a run for drawing; to be made again when its machine or plan changes.
    pub fn of(run: &Run) -> Self {
        let model = &run.scenario().machine;
        // A machine with other lengths is drawn as it is.
        let plant = run.scenario().plant.machine(model).unwrap_or_else(|_| model.clone());
        let planes = run.planes().cloned();
        let boundary = planes.as_ref().map_or_else(Vec::new, |p| {
            let loops = p.boundary().turned(0.0);
            loops.into_iter().map(|l| l.into_iter().map(|[x, y]| Vector::new(x, y)).collect()).collect()
        });
        let tip = *model.tip();
        let motion = run.motion().map(|motion| Course {
            // What waits has points, but no path.
            points: match run.waiting() {
                Some(_) => Vec::new(),
                None => looks(motion).map(|s| place(&tip, &motion.path.at(s).q)).collect(),
            },
            start: motion.path.at(0.0).q.units(),
            waypoints: waypoints(run),
        });
        Self {
            linkage: Linkage::of(&plant),
            ground: ground(run),
            holder: (plant.parts()[plant.tip_link()].drive, plant.parts()[plant.tip_link()].sign),
            middle: planes.as_ref().and_then(|p| roomiest(p, &boundary)),
            inside: planes.as_ref().map_or_else(Vec::new, |p| inside(p)),
            cusps: planes.as_ref().map_or_else(Vec::new, |p| p.boundary().cusps().iter().map(|v| v.at).collect()),
            dexterity: Default::default(),
            pins: bearings(&plant),
            planes,
            boundary,
            compare_b: run.scenario().compare_b,
            motion,
            waiting: run.waiting().map(|waiting| (waiting.clone(), Refused::of(&waiting.why))),
        }
    }

    /// Takes over what has changed of base and payload.
    pub fn refresh(&mut self, run: &Run) {
        self.ground = ground(run);
    }

    /// The machine's body.
    pub fn linkage(&self) -> &Linkage {
        &self.linkage
    }

    /// From where to where a measure of dexterity is shaded.
    pub fn shaded(&self, measure: Measure) -> [f64; 2] {
        let range = || self.planes.as_ref().map_or([0.0, 1.0], |p| measure.range(p.map()));
        *self.dexterity[measure as usize].get_or_init(range)
    }

    /// How many poses of the present plane put the end effector where it is, and how far it is from the boundary of
    /// the workspace, m, positive inside. `None` for a machine without planes.
    pub fn standing(&self, frame: &Frame) -> Option<(usize, f64)> {
        let boundary = self.planes.as_ref()?.boundary();
        let at = frame.in_base(frame.tip);
        Some((boundary.pose_count(at, frame.b), boundary.distance(at, frame.b)))
    }

    /// Radius of the b ring, m.
    pub fn ring_radius(&self) -> f64 {
        0.118 * self.linkage.reach()
    }

    /// Height of the plane in which handles lie, m.
    pub fn handle_height(&self) -> f64 {
        self.linkage.top()
    }

    /// Where a handle is in a frame as shown, m.
    pub fn handle(&self, handle: Handle, frame: &Frame) -> Option<[f64; 3]> {
        let z = self.handle_height();
        match handle {
            Handle::Target => {
                let p = target_handle(frame);
                Some([p.re, p.im, z])
            }
            Handle::Ring => {
                let turn = self.planes.as_ref()?.map().turn(frame.b_reference) + frame.base.angle;
                let p = frame.base.at + unit(turn) * self.ring_radius();
                Some([p.re, p.im, z])
            }
            Handle::Tip => Some([frame.tip.re, frame.tip.im, z]),
            Handle::Waypoint(i) => {
                let course = self.motion.as_ref()?;
                let (.., p) = course.waypoints.iter().find(|(number, ..)| *number == i)?;
                Some([p.re, p.im, z])
            }
            Handle::Plane | Handle::Bar => None,
        }
    }

    /// The b that a place of the ring's knob stands for in a frame as shown, nearest to the present one, rad.
    pub fn ring_b(&self, at: [f64; 2], near: f64, frame: &Frame) -> Option<f64> {
        let map = self.planes.as_ref()?.map();
        let at = frame.in_base(Vector::new(at[0], at[1]));
        let turn = crate::mechanics::kinematics::closest_turn(at.arg(), map.turn(near));
        Some(turn * map.lambda_sum())
    }

    /// Everything there is to draw.
    pub fn scene(&self, frame: &Frame, options: &ViewOptions) -> Scene {
        let palette = palette(options.theme);
        let shown = swayed(frame, options.sway);
        let (frame, true_tip) = (&shown, frame.tip);
        let e = frame.q.units();
        let mut solids = Vec::new();
        if let Some(course) = self.motion.as_ref().filter(|_| self.waiting.is_none()) {
            solids.extend(self.linkage.ghost(&course.start, &palette, 0.16));
        }
        if let (Some(b), Some(planes)) = (options.preview_b, &self.planes) {
            let p = self.motion.as_ref().and_then(|c| c.points.first().copied()).unwrap_or(frame.target.at);
            for pose in planes.map().poses(p, b).iter() {
                let q = DriveAngles::from(planes.map().lift(*pose));
                solids.extend(self.linkage.ghost(&q.units(), &palette, 0.34));
            }
        }
        solids.extend(self.linkage.solids(&e, frame.base, self.ground.base.moves(), &palette));
        let mut scene = Scene {
            background: palette.background,
            model: self.linkage.model.clone(),
            areas: Vec::new(),
            solids,
            lines: Vec::new(),
            markers: Vec::new(),
            labels: Vec::new(),
        };
        self.grid(&mut scene, &palette);
        self.unmoved(&mut scene, &palette, frame, options.sway);
        self.ground(&mut scene, &palette, frame);
        if let Some(planes) = &self.planes {
            if let Some(b) = self.compare_b {
                self.workspace(&mut scene, &palette, planes, b, frame.base, true);
            }
            self.workspace(&mut scene, &palette, planes, frame.b_reference, frame.base, false);
            if let Some(b) = options.preview_b {
                self.preview(&mut scene, &palette, planes, b);
            }
            scene
                .areas
                .iter_mut()
                .rev()
                .take(1)
                .zip(options.dexterity)
                .for_each(|(area, measure)| self.shade(area, &palette, measure));
            self.ring(&mut scene, &palette, planes, frame, options);
        }
        self.course(&mut scene, &palette, options);
        self.snapshots(&mut scene, &palette, options);
        self.others(&mut scene, &palette, options);
        self.wishes(&mut scene, &palette, options);
        self.reaction(&mut scene, &palette, frame, options);
        if options.pin_forces && !self.pins.is_empty() {
            self.pin_forces(&mut scene, &palette, frame);
        }
        self.target(&mut scene, &palette, frame, options, true_tip);
        self.burden(&mut scene, &palette, frame, options);
        scene
    }

    fn grid(&self, scene: &mut Scene, palette: &Palette) {
        let (step, z) = (0.1, self.linkage.floor() - 0.004 * self.linkage.reach());
        let n = (1.7 * self.linkage.reach() / step).ceil().min(60.0) as i32;
        let far = f64::from(n) * step;
        let colour = faded(palette.line, 0.55);
        for i in -n..=n {
            let at = f64::from(i) * step;
            let strong = if i == 0 { palette.line } else { colour };
            for ends in [[[at, -far], [at, far]], [[-far, at], [far, at]]] {
                scene.lines.push(Line {
                    name: "grid".into(),
                    points: ends.map(|[x, y]| point(Vector::new(x, y), z)).to_vec(),
                    width: 1.0,
                    colour: strong,
                    dash: None,
                    on_top: false,
                });
            }
        }
    }
}

fn ground(run: &Run) -> Ground {
    let scenario = run.scenario();
    Ground { base: scenario.base, load: scenario.plant.payload, weightless: scenario.machine.gravity().norm() == 0.0 }
}

/// Three digits, without zeros at the end.
fn brief_number(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return "0".into();
    }
    let decimals = (2 - x.abs().log10().floor() as i32).clamp(0, 12) as usize;
    let text = signed(x, decimals);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

fn place(tip: &Chain, q: &DriveAngles) -> Vector {
    crate::mechanics::machine::place_of(tip, &q.units())
}

fn point(p: Vector, z: f64) -> [f32; 3] {
    [p.re as f32, p.im as f32, z as f32]
}

fn label(at: Vector, z: f64, offset: [f32; 2], text: &str, colour: Rgba, size: f32, anchor: Anchor) -> Label {
    Label { at: point(at, z), offset, text: text.into(), colour, size, anchor }
}

/// The next of 1, 2, 5 times a power of ten.
pub fn round_up(x: f64) -> f64 {
    let decade = 10f64.powf(x.log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * decade).find(|v| *v >= x * (1.0 - 1e-12)).unwrap_or(10.0 * decade)
}

/// Fixed decimals with a real minus sign, and no minus on zero.
pub fn signed(x: f64, decimals: usize) -> String {
    let text = format!("{:.decimals$}", x.abs());
    let zero = text.chars().all(|c| c == '0' || c == '.');
    if x < 0.0 && !zero { format!("−{text}") } else { text }
}
