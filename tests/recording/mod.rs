//! Recordings, read back with Rerun's own decoder and compared with the frames of the run.

use std::collections::BTreeMap;
use std::path::PathBuf;

use rerun::external::arrow::array::{Array, FixedSizeListArray, Float32Array, Float64Array, ListArray, StringArray};
use rerun::external::re_log_encoding::DecoderApp;
use rerun::external::re_log_types::StoreId;
use rerun::log::{Chunk, LogMsg};
use rerun::{EntityPath, StoreKind, TimelineName};
use stillbase::files::WriteError;
use stillbase::mechanics::planar::{Vector, unit};
use stillbase::planning::timing::TimeLaw;
use stillbase::recording::{Options, Pictures, Progress, RecordError, Recording, record};
use stillbase::session::scenario::Scenario;
use stillbase::session::{Edit, TimedEdit, replay};
use stillbase::simulation::frame::Frame;
use stillbase::simulation::signals::signals;

use crate::folder::Folder;

/// Everything in a file, store by store.
struct Contents {
    stores: BTreeMap<StoreId, Vec<Chunk>>,
    activated: usize,
}

impl Contents {
    fn of(file: &std::path::Path) -> Self {
        let reader = std::io::BufReader::new(std::fs::File::open(file).expect("the recording"));
        let mut contents = Self { stores: BTreeMap::new(), activated: 0 };
        for message in DecoderApp::decode_lazy(reader) {
            match message.expect("a message") {
                LogMsg::SetStoreInfo(info) => _ = contents.stores.insert(info.info.store_id, Vec::new()),
                LogMsg::ArrowMsg(store, message) => {
                    let chunk = Chunk::from_arrow_msg(&message).expect("a chunk");
                    contents.stores.get_mut(&store).expect("a store that was announced").push(chunk);
                }
                LogMsg::BlueprintActivationCommand(_) => contents.activated += 1,
            }
        }
        contents
    }

    fn recording(&self) -> &[Chunk] {
        let mut recordings = self.stores.iter().filter(|(id, _)| id.kind() == StoreKind::Recording);
        let (id, chunks) = recordings.next().expect("a recording");
        assert!(recordings.next().is_none(), "one recording");
        assert_eq!(id.application_id().as_str(), "stillbase");
        chunks
    }

    fn at(&self, path: &str) -> Vec<&Chunk> {
        let path = EntityPath::from(path);
        self.recording().iter().filter(|c| *c.entity_path() == path).collect()
    }

    /// The only column of a component at an entity, row by row, and the steps.
    fn scalars(&self, path: &str) -> (Vec<i64>, Vec<i64>, Vec<f64>) {
        let moving = self.at(path).into_iter().filter(|c| !c.is_static());
        let (mut steps, mut nanos, mut values) = (Vec::new(), Vec::new(), Vec::new());
        for chunk in moving {
            steps.extend_from_slice(chunk.timelines()[&TimelineName::from("step")].times_raw());
            nanos.extend_from_slice(chunk.timelines()[&TimelineName::from("sim_time")].times_raw());
            let column = chunk.components().get_array("Scalars:scalars".into()).expect("scalars");
            let flat = column.values().as_any().downcast_ref::<Float64Array>().expect("numbers");
            assert_eq!(flat.len(), chunk.num_rows(), "one number a row");
            values.extend_from_slice(flat.values());
        }
        (steps, nanos, values)
    }

    /// Points of strips, or places, of an entity: row by row, strip by strip.
    fn strips(&self, path: &str) -> Vec<Vec<[f32; 3]>> {
        let columns = self.at(path).into_iter().filter_map(|c| c.components().get_array("LineStrips3D:strips".into()));
        columns
            .flat_map(|rows| {
                let strips = rows.values();
                let strips = strips.as_any().downcast_ref::<ListArray>().expect("strips").clone();
                (0..strips.len()).map(|i| vectors(&strips.value(i))).collect::<Vec<_>>()
            })
            .collect()
    }

    /// All vectors of a component of an entity, whatever the rows, and the steps of the rows that move.
    fn vectors(&self, path: &str, component: &'static str) -> (Vec<i64>, Vec<[f32; 3]>) {
        let chunks = self.at(path).into_iter().filter(|c| c.components().contains_component(component.into()));
        let (mut steps, mut values) = (Vec::new(), Vec::new());
        for chunk in chunks {
            if let Some(times) = chunk.timelines().get(&TimelineName::from("step")) {
                steps.extend_from_slice(times.times_raw());
            }
            let column = chunk.components().get_array(component.into()).expect("a column");
            values.extend(vectors(column.values()));
        }
        (steps, values)
    }

    /// All numbers of a component of an entity.
    fn numbers(&self, path: &str, component: &'static str) -> Vec<f64> {
        let columns = self.at(path).into_iter().filter_map(|c| c.components().get_array(component.into()));
        let numbers = columns.flat_map(|column| {
            let flat = column.values().as_any().downcast_ref::<Float64Array>().expect("numbers");
            flat.values().to_vec()
        });
        numbers.collect()
    }

    /// Whether anything is said of an entity.
    fn holds(&self, path: &str) -> bool {
        !self.at(path).is_empty()
    }

    /// All text in a component of an entity.
    fn texts(&self, path: &str, component: &'static str) -> Vec<String> {
        let columns = self.at(path).into_iter().filter_map(|c| c.components().get_array(component.into()));
        let texts = columns.flat_map(|column| {
            let flat = column.values().as_any().downcast_ref::<StringArray>().expect("text");
            flat.iter().flatten().map(str::to_owned).collect::<Vec<_>>()
        });
        texts.collect()
    }
}

fn vectors(flat: &dyn Array) -> Vec<[f32; 3]> {
    let list = flat.as_any().downcast_ref::<FixedSizeListArray>().expect("vectors");
    let numbers = list.values().as_any().downcast_ref::<Float32Array>().expect("numbers").values();
    numbers.chunks_exact(3).map(|v| [v[0], v[1], v[2]]).collect()
}

fn near(p: [f32; 3], q: [f64; 3]) -> bool {
    p.iter().zip(q).all(|(p, q)| (f64::from(*p) - q).abs() < 1e-5)
}

fn cases() -> Vec<Scenario> {
    Scenario::cases().map(|name| Scenario::builtin(name).expect("built in")).collect()
}

fn short(name: &str) -> Scenario {
    let mut scenario = Scenario::builtin(name).expect("built in");
    scenario.duration = Some(0.1);
    scenario
}

fn quietly(_: Progress) {}

fn record_in(folder: &Folder, name: &str, scenarios: &[Scenario]) -> Result<Vec<Recording>, RecordError> {
    record(scenarios, &folder.path(name), &Options::default(), &mut quietly)
}

#[test]
fn signals_are_the_frames_at_every_step() {
    let folder = Folder::new("signals");
    let mut heard = Vec::new();
    let recordings = record(&cases(), &folder.path("cases.rrd"), &Options::default(), &mut |p| {
        heard.push((p.done, p.of, p.what.to_owned()));
    })
    .expect("three cases");
    let contents = Contents::of(&folder.path("cases.rrd"));
    for (scenario, recording) in cases().iter().zip(&recordings) {
        let mut frames: Vec<Frame> = Vec::new();
        replay(scenario, |_, frame| frames.push(*frame)).expect("it runs");
        assert_eq!(frames.len(), 1001);
        for signal in signals(&scenario.machine) {
            let (steps, nanos, values) = contents.scalars(&format!("/{}/signals/{}", scenario.name, signal.path));
            assert!(steps.iter().copied().eq(0..=1000), "{}: a row at every step", signal.path);
            assert!(nanos.iter().copied().eq((0..=1000).map(|i| i * 1_000_000)), "{}: and its time", signal.path);
            let expected: Vec<f64> = frames.iter().map(|f| signal.value(f)).collect();
            assert_eq!(values, expected, "{} of {}", signal.path, scenario.name);
            let name = contents.texts(&format!("/{}/signals/{}", scenario.name, signal.path), "SeriesLines:names");
            assert!(signal.unit == "1" || name[0].ends_with(signal.unit), "{name:?} names {}", signal.unit);
        }
        let last = frames.last().expect("frames").peaks;
        assert_eq!(recording.scenario, scenario.name);
        assert_eq!(recording.file, folder.path("cases.rrd"));
        assert_eq!(recording.steps, 1000);
        assert_eq!(recording.peak_torque, last.torque.to_vec());
        assert_eq!(recording.peak_base_moment, last.moment);
        assert_eq!(recording.peak_base_force, last.force);
        assert_eq!(recording.reactionless, scenario.name == "case-3");
        assert!(recording.notes.is_empty());
    }
    assert!(heard.windows(2).all(|w| w[0].0 <= w[1].0), "progress only grows");
    assert_eq!(heard.last(), Some(&(6000, 6000, "case-3".to_owned())));
}

#[test]
fn geometry_is_static_and_bodies_move_under_their_case() {
    let folder = Folder::new("entities");
    record_in(&folder, "one.rrd", &[short("case-3")]).expect("a case");
    let contents = Contents::of(&folder.path("one.rrd"));
    let has = |path: &str, component: &'static str, fixed: bool| {
        let chunks = contents.at(path);
        let with = chunks.iter().filter(|c| c.components().contains_component(component.into()));
        let rows: usize = with.filter(|c| c.is_static() == fixed).map(|c| c.num_rows()).sum();
        rows
    };
    let machine = Scenario::builtin("case-3").expect("built in").machine;
    for link in machine.links() {
        let path = format!("/case-3/machine/link/{}", link.name);
        assert_eq!(has(&path, "Mesh3D:vertex_positions", true), 1, "{path}");
        assert_eq!(has(&path, "Mesh3D:albedo_factor", true), 1, "{path}");
        // Every fifth of 101 frames.
        assert_eq!(has(&path, "Transform3D:translation", false), 21, "{path}");
        assert_eq!(has(&path, "Transform3D:quaternion", false), 21, "{path}");
    }
    for path in ["machine/base", "machine/base/cap", "machine/base/drive/2", "machine/joints", "plan/start/9"] {
        assert_eq!(has(&format!("/case-3/{path}"), "Mesh3D:vertex_positions", true), 1, "{path}");
    }
    assert_eq!(has("/case-3/machine/base", "Transform3D:translation", true), 1, "a fixed base stays");
    assert_eq!(has("/case-3/machine/joints", "InstancePoses3D:translations", false), 21);
    assert_eq!(has("/case-3/end_effector", "Points3D:positions", false), 21);
    for path in ["end_effector/path", "com", "grid"] {
        assert_eq!(has(&format!("/case-3/{path}"), "LineStrips3D:strips", true), 1, "{path}");
    }
    assert_eq!(has("/case-3/target", "LineStrips3D:strips", true), 1);
    for b in ["2.400", "5.000"] {
        let path = format!("/case-3/workspace/{b}");
        assert_eq!(has(&path, "Mesh3D:vertex_positions", true), 1, "{path}");
        assert!(has(&path, "Transform3D:quaternion", false) >= 1, "{path}");
        assert_eq!(has(&format!("{path}/boundary"), "LineStrips3D:strips", true), 1, "{path}");
    }
    // Nothing to draw of a reaction that is nothing; that it is nothing is said once.
    assert_eq!(has("/case-3/reaction/force", "LineStrips3D:strips", false), 1);
    assert_eq!(has("/case-3/reaction/moment", "LineStrips3D:strips", false), 1);
    let timelines: std::collections::BTreeSet<String> =
        contents.recording().iter().flat_map(|c| c.timelines().keys().map(|name| name.to_string())).collect();
    assert!(timelines.into_iter().eq(["sim_time", "step"]), "no other time lines");
}

#[test]
fn links_stand_where_the_machine_is() {
    let folder = Folder::new("links");
    let scenario = short("case-2");
    record_in(&folder, "one.rrd", std::slice::from_ref(&scenario)).expect("a case");
    let contents = Contents::of(&folder.path("one.rrd"));
    let mut frames = Vec::new();
    replay(&scenario, |_, frame| frames.push(*frame)).expect("it runs");
    for (j, part) in scenario.machine.resolved_links().iter().enumerate() {
        let path = format!("/case-2/machine/link/{}", scenario.machine.links()[j].name);
        let chunks = contents.at(&path);
        let moving = chunks.iter().find(|c| !c.is_static()).expect("transforms");
        let steps = moving.timelines()[&TimelineName::from("step")].times_raw();
        let floats = |component: &'static str| -> Vec<f32> {
            let list = moving.components().get_array(component.into()).expect("a column");
            let rows = list.values();
            let rows = rows.as_any().downcast_ref::<rerun::external::arrow::array::FixedSizeListArray>();
            let flat = rows.expect("vectors").values().clone();
            let flat = flat.as_any().downcast_ref::<rerun::external::arrow::array::Float32Array>();
            flat.expect("numbers").values().to_vec()
        };
        let (places, turns) = (floats("Transform3D:translation"), floats("Transform3D:quaternion"));
        for (i, step) in steps.iter().enumerate() {
            let e = frames[*step as usize].q.units();
            let root = stillbase::mechanics::machine::place_of(&part.root, &e);
            assert!((f64::from(places[3 * i]) - root.re).abs() < 1e-6, "{path} x");
            assert!((f64::from(places[3 * i + 1]) - root.im).abs() < 1e-6, "{path} y");
            let half = f64::from(turns[4 * i + 2]).atan2(f64::from(turns[4 * i + 3]));
            let along = unit(2.0 * half) - e[part.drive] * part.sign;
            assert!(along.norm() < 1e-6, "{path} turn");
        }
    }
}

#[test]
fn what_happened_and_what_was_run_is_told() {
    let folder = Folder::new("told");
    let scenario = Scenario::builtin("case-1").expect("built in");
    record_in(&folder, "one.rrd", std::slice::from_ref(&scenario)).expect("a case");
    let contents = Contents::of(&folder.path("one.rrd"));
    let property = |name: &'static str| contents.texts("/__properties/case-1", name);
    let [text] = &property("scenario")[..] else { panic!("one scenario") };
    assert_eq!(Scenario::parse(text, "recorded", None).expect("a scenario"), scenario);
    let [text] = &property("machine")[..] else { panic!("one machine") };
    assert_eq!(stillbase::mechanics::machine::parse(text, "recorded").expect("a machine"), scenario.machine);
    assert_eq!(property("version"), [env!("CARGO_PKG_VERSION")]);
    assert!(property("verdict")[0].starts_with("not reactionless: peak |n_B| 1.0891 N m"), "{:?}", property("verdict"));
    let events = contents.texts("/case-1/events", "TextLog:text");
    for part in [
        "start: Case 1",
        "plan: minimum-norm, line, quintic, 2 points, T = 1.000 s",
        "peak |n_B| 1.0891 N m",
        "end of motion",
        "peak |τ| 2.42",
        "not reactionless",
    ] {
        assert!(events.iter().any(|e| e.starts_with(part)), "{part} in {events:?}");
    }
    assert_eq!(contents.texts("/case-1/phase", "StateChange:state"), ["motion", "rest"]);
}

/// Via points within limits that fold the workspace.
fn folded() -> Scenario {
    let mut scenario = short("case-3");
    for key in ["limits.a1", "limits.a2"] {
        scenario.machine = scenario.machine.set(key, "-1,4").expect("wider limits");
    }
    scenario.task.via = vec![[0.52, 0.62], [0.58, 0.75]];
    scenario
}

#[test]
fn the_plan_is_drawn_from_point_to_point() {
    let folder = Folder::new("plan");
    let scenario = folded();
    record_in(&folder, "one.rrd", std::slice::from_ref(&scenario)).expect("a case");
    let contents = Contents::of(&folder.path("one.rrd"));
    let (steps, places) = contents.vectors("/case-3/plan/waypoints", "Points3D:positions");
    assert_eq!(steps, [0], "once");
    let points = scenario.task.points();
    let height = f64::from(places[0][2]);
    assert_eq!(places.len(), points.len());
    assert!(places.iter().zip(&points).all(|(at, p)| near(*at, [p.re, p.im, height])), "{places:?}");
    assert_eq!(contents.texts("/case-3/plan/names", "Points3D:labels"), ["A", "1", "2", "B"]);
    let dashes = contents.strips("/case-3/plan/path");
    let (first, last) = (dashes[0][0], *dashes.last().and_then(|d| d.last()).expect("a dash"));
    assert!(near(first, [points[0].re, points[0].im, height]) && near(last, [points[3].re, points[3].im, height]));
    // Dashes and gaps are as long as each other, so that half of the way is drawn.
    let length = |line: &[[f32; 3]]| -> f64 {
        line.windows(2).map(|w| f64::from((w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1]))).sum()
    };
    let run = stillbase::session::Run::new(&scenario).expect("it runs");
    let motion = run.motion().expect("a plan");
    let curve: Vec<_> = (0..=4096).map(|i| run.place(&motion.path.at(f64::from(i) / 4096.0).q)).collect();
    let whole: f64 = curve.windows(2).map(|w| (w[1] - w[0]).norm()).sum();
    let drawn: f64 = dashes.iter().map(|d| length(d)).sum();
    let n = dashes.len() as f64;
    assert!(n > 8.0 && (drawn - whole * n / (2.0 * n - 1.0)).abs() < 1e-3 * whole, "{drawn} of {whole} in {n}");
}

#[test]
fn what_runs_inside_a_workspace_turns_with_it() {
    let folder = Folder::new("inside");
    let (plain, scenario) = (short("case-2"), folded());
    record_in(&folder, "two.rrd", &[plain, scenario.clone()]).expect("two cases");
    let contents = Contents::of(&folder.path("two.rrd"));
    let planes = stillbase::planning::pose_constant::Planes::of(&scenario.machine).expect("planes");
    let boundary = planes.boundary();
    let height = 0.0;
    // Before they are turned and shifted: their transform is the workspace's.
    let flat = |line: &stillbase::planning::reactionless::BoundaryLine| -> Vec<[f64; 3]> {
        line.turned(0.0).iter().map(|[x, y]| [*x, *y, height]).collect()
    };
    for (name, curves) in [("folds", boundary.fold_curves()), ("inner_limits", boundary.inner_limits())] {
        let strips = contents.strips(&format!("/case-3/workspace/2.400/{name}"));
        assert!(!curves.is_empty() && strips.len() == curves.len(), "{name}");
        for (strip, curve) in strips.iter().zip(curves.iter().map(flat)) {
            assert!(strip.len() == curve.len() && strip.iter().zip(curve).all(|(p, q)| near(*p, q)), "{name}");
        }
    }
    let (_, cusps) = contents.vectors("/case-3/workspace/2.400/cusps", "Points3D:positions");
    assert_eq!(cusps.len(), boundary.cusps().len());
    assert!(cusps.iter().zip(boundary.cusps()).all(|(p, v)| near(*p, [v.at.re, v.at.im, height])));
    let dashes = contents.strips("/case-3/workspace/2.400/change_points");
    let first = &boundary.change_curves()[0].line;
    assert!(near(dashes[0][0], flat(first)[0]));
    // A workspace that folds nowhere has change points alone.
    for (name, there) in [("folds", false), ("inner_limits", false), ("cusps", false), ("change_points", true)] {
        assert_eq!(contents.holds(&format!("/case-2/workspace/2.400/{name}")), there, "{name}");
    }
}

#[test]
fn joint_space_has_the_drive_angles_as_coordinates() {
    let folder = Folder::new("joints");
    let mut scenario = Scenario::builtin("change-b").expect("built in");
    scenario.duration = Some(0.5);
    record_in(&folder, "one.rrd", std::slice::from_ref(&scenario)).expect("a case");
    let contents = Contents::of(&folder.path("one.rrd"));
    let mut frames = Vec::new();
    let run = replay(&scenario, |_, frame| frames.push(*frame)).expect("it runs");
    let root = "/change-b/joint_space";
    let (steps, poses) = contents.vectors(&format!("{root}/pose"), "Points3D:positions");
    assert_eq!(steps.len(), 101);
    for (step, pose) in steps.iter().zip(&poses) {
        let q = frames[*step as usize].q;
        assert!(near(*pose, [q[0], q[1], q[2]]), "step {step}");
    }
    // The plane where it was drawn, moved to where it is: its corners have the b of that instant.
    let lambda = run.planes().expect("planes").map().lambda();
    let (_, corners) = contents.vectors(&format!("{root}/plane"), "Mesh3D:vertex_positions");
    let (steps, shifts) = contents.vectors(&format!("{root}/plane"), "Transform3D:translation");
    assert_eq!((corners.len(), shifts.len()), (6, steps.len()), "two triangles");
    assert!(steps.len() > 50, "it moves with b");
    for (step, shift) in steps.iter().zip(&shifts) {
        for corner in &corners {
            let b: f64 = (0..3).map(|k| lambda[k] * f64::from(corner[k] + shift[k])).sum();
            assert!((b - frames[*step as usize].b_reference).abs() < 1e-5, "step {step}: {b}");
        }
    }
    let path = contents.strips(&format!("{root}/path"));
    let start = frames[0].q;
    assert!(near(path[0][0], [start[0], start[1], start[2]]), "the path begins at A");
    let words = contents.texts(&format!("{root}/axes/titles"), "Points3D:labels");
    assert!(["q₁, rad", "q₂, rad", "q₃, rad"].iter().all(|title| words.iter().any(|w| w == title)), "{words:?}");
}

#[test]
fn the_slice_of_the_tower_lies_at_the_height_of_b() {
    let folder = Folder::new("tower");
    let mut scenario = Scenario::builtin("change-b").expect("built in");
    scenario.duration = Some(0.5);
    record_in(&folder, "two.rrd", &[scenario.clone(), short("case-3")]).expect("two cases");
    let contents = Contents::of(&folder.path("two.rrd"));
    let mut frames = Vec::new();
    let run = replay(&scenario, |_, frame| frames.push(*frame)).expect("it runs");
    let root = "/change-b/tower";
    let (steps, heights) = contents.vectors(&format!("{root}/slice"), "Transform3D:translation");
    assert!(steps.len() > 50);
    let b = |i: usize| frames[steps[i] as usize].b_reference;
    let last = steps.len() - 1;
    assert!((b(last) - b(0)).abs() > 0.05, "b changes");
    let rise = f64::from(heights[last][2] - heights[0][2]) / (b(last) - b(0));
    assert!(rise > 0.0);
    for (i, height) in heights.iter().enumerate() {
        assert!(near(*height, [0.0, 0.0, f64::from(heights[0][2]) + rise * (b(i) - b(0))]), "row {i}");
    }
    let contours = contents.strips(&format!("{root}/contours"));
    assert!(contours.len() > 10);
    let levels = contours.iter().flatten().map(|p| p[2]);
    let window = [levels.clone().fold(f32::INFINITY, f32::min), levels.fold(0.0, f32::max)];
    // Every bar ends at b that just reach its point, or where the tower ends, and contours lie where the workspace of their b ends.
    let planes = run.planes().expect("planes");
    let floor = b(0) - f64::from(heights[0][2]) / rise;
    for (name, p) in [("A", scenario.task.from), ("B", scenario.task.to)] {
        let bars = contents.strips(&format!("{root}/reach/{name}"));
        let set = planes.map().reach(Vector::new(p[0], p[1])).expect("b that reach it");
        assert!(!bars.is_empty());
        for end in bars.iter().flatten().filter(|end| window.iter().all(|z| (end[2] - z).abs() > 1e-6)) {
            assert!((f64::from(end[0]) - p[0]).hypot(f64::from(end[1]) - p[1]) < 1e-6, "over {name}");
            let b = floor + f64::from(end[2]) / rise;
            let whole = |x: f64| (x / set.period - (x / set.period).round()).abs() * set.period;
            let ends = set.intervals.iter().flatten().map(|x| whole(x - b)).fold(f64::INFINITY, f64::min);
            assert!(ends < 1e-4, "b = {b} is no end of what reaches {name}");
        }
    }
    let outline = planes.boundary().turned(0.0).concat();
    for p in contours.iter().flatten().step_by(7) {
        let b = floor + f64::from(p[2]) / rise;
        let at = Vector::new(f64::from(p[0]), f64::from(p[1])) * unit(-planes.map().turn(b));
        let off = outline.iter().map(|[x, y]| (at - Vector::new(*x, *y)).norm()).fold(f64::INFINITY, f64::min);
        assert!(off < 1e-5, "{p:?}");
    }
    let (_, wall) = contents.vectors(&format!("{root}/wall"), "Mesh3D:vertex_positions");
    assert!((500..6000).contains(&wall.len()), "{} vertices", wall.len());
    // A b that is kept has the slice where it is.
    let (steps, _) = contents.vectors("/case-3/tower/slice", "Transform3D:translation");
    assert_eq!(steps, [0]);
}

#[test]
fn what_was_foreseen_is_told() {
    let folder = Folder::new("foreseen");
    let names = ["change-b", "circle", "drift", "circle"];
    let mut scenarios =
        names.map(|name| Scenario { duration: Some(0.02), ..Scenario::builtin(name).expect("built in") });
    // The last with limits on jerk.
    let smooth = &mut scenarios[3];
    (smooth.name, smooth.task.law) = ("smooth".into(), TimeLaw::FastestSmooth);
    for k in 1..=3 {
        smooth.machine = smooth.machine.set(&format!("drive.{k}.jerk_limit"), "900").expect("a limit");
    }
    record_in(&folder, "four.rrd", &scenarios).expect("four cases");
    let contents = Contents::of(&folder.path("four.rrd"));
    for scenario in &scenarios {
        let run = stillbase::session::Run::new(scenario).expect("it runs");
        let plan = run.plan();
        let told = |name: &'static str| contents.numbers(&format!("/__properties/{}", scenario.name), name);
        assert_eq!(told("forecast_time"), [plan.forecast.time]);
        assert_eq!(told("forecast_peak_base_moment"), [plan.forecast.moment]);
        assert_eq!(told("forecast_moment_impulse"), [plan.forecast.impulse]);
        let price: Vec<f64> = plan.price.iter().map(|p| p.delta_b()).collect();
        assert_eq!((told("delta_b"), price.len()), (price.clone(), usize::from(scenario.name == "change-b")));
        let least: Vec<f64> = plan.price.iter().map(|p| p.least_peak(plan.forecast.time)).collect();
        assert_eq!(told("least_peak_base_moment"), least);
        let gap: Vec<f64> = plan.pace.iter().filter_map(|pace| pace.gap()).collect();
        assert_eq!((told("gap"), gap.len()), (gap.clone(), usize::from(scenario.name == "smooth")));
        let drift = told("drift_2");
        assert_eq!(drift.len(), if scenario.name == "drift" { scenario.task.cycles as usize } else { 0 });
        if let (Some(drift), Some([start, .., end])) = (drift.last(), plan.cycles.get(..)) {
            assert_eq!(*drift, end[1] - start[1]);
        }
    }
    let limit = contents.texts("/__properties/circle", "limit");
    assert!(limit.iter().any(|l| l.contains("of drive")), "{limit:?}");
}

#[test]
fn the_layout_comes_along_and_is_activated() {
    let folder = Folder::new("layout");
    record_in(&folder, "two.rrd", &[short("case-1"), short("case-3")]).expect("two cases");
    let contents = Contents::of(&folder.path("two.rrd"));
    assert_eq!(contents.activated, 1);
    let layouts: Vec<_> = contents.stores.iter().filter(|(id, _)| id.kind() == StoreKind::Blueprint).collect();
    let [(_, chunks)] = layouts[..] else { panic!("one layout") };
    let views = chunks.iter().filter(|c| c.components().contains_component("ViewBlueprint:class_identifier".into()));
    // Side by side: two scenes, two plots, events; each case: scene, joint space, tower, five plots, five of
    // the inside, events, phase.
    assert_eq!(views.count(), 5 + 2 * 15);
    assert!(chunks.iter().any(|c| *c.entity_path() == EntityPath::from("/viewport")));
}

/// Views and containers of a layout: identifier, class or kind, and origin.
fn parts(contents: &Contents) -> Vec<(String, String, String)> {
    let layouts = contents.stores.iter().filter(|(id, _)| id.kind() == StoreKind::Blueprint);
    let chunks = layouts.flat_map(|(_, chunks)| chunks);
    let text = |chunk: &Chunk, component: &'static str| {
        let column = chunk.components().get_array(component.into())?;
        let flat = column.values().as_any().downcast_ref::<StringArray>()?;
        Some(flat.value(0).to_owned())
    };
    chunks
        .filter_map(|chunk| {
            let id = chunk.entity_path().to_string();
            if id.starts_with("/container/") && id.matches('/').count() == 2 {
                return Some((id, "container".into(), String::new()));
            }
            let class = text(chunk, "ViewBlueprint:class_identifier")?;
            Some((id, class, text(chunk, "ViewBlueprint:space_origin")?))
        })
        .collect()
}

/// A viewer keeps what it knows of a view under its identifier, from recording to recording.
#[test]
fn a_view_has_its_identifier_for_good_and_shares_it_with_nothing() {
    let folder = Folder::new("identifiers");
    let sets: [&[&str]; 5] = [
        &["case-1", "case-2", "case-3"],
        &["case-3"],
        &["spacecraft"],
        &["pick-up", "case-3", "case-1"],
        &["wheel", "spacecraft"],
    ];
    let mut known: BTreeMap<String, (String, String)> = BTreeMap::new();
    let mut tabs: BTreeMap<(String, String), Vec<std::collections::BTreeSet<String>>> = BTreeMap::new();
    for (i, names) in sets.iter().enumerate() {
        let scenarios: Vec<_> = names.iter().map(|name| short(name)).collect();
        record_in(&folder, &format!("{i}.rrd"), &scenarios).expect("cases");
        let parts = parts(&Contents::of(&folder.path(&format!("{i}.rrd"))));
        let ids: std::collections::BTreeSet<_> = parts.iter().map(|(id, ..)| id).collect();
        assert_eq!(ids.len(), parts.len(), "no two parts of a layout share an identifier");
        let mut views: BTreeMap<(String, String), std::collections::BTreeSet<String>> = BTreeMap::new();
        for (id, class, origin) in parts {
            let before = known.insert(id.clone(), (class.clone(), origin.clone()));
            assert!(before.is_none_or(|before| before == (class.clone(), origin.clone())), "{id} was another view");
            views.entry((class, origin)).or_default().insert(id);
        }
        views.into_iter().for_each(|(key, ids)| tabs.entry(key).or_default().push(ids));
    }
    // What a case shows in a tab of its own is the same view in every recording that has it.
    for (class, origin, recordings) in
        [("TimeSeries", "/case-3/signals", 3), ("3D", "/case-3/tower", 3), ("StateTimeline", "/spacecraft/phase", 2)]
    {
        let seen = &tabs[&(class.to_owned(), origin.to_owned())];
        assert!(seen.len() == recordings && seen.iter().all(|ids| *ids == seen[0]), "{class} of {origin}: {seen:?}");
    }
}

#[cfg(feature = "render")]
#[test]
fn pictures_stand_beside_each_other_and_in_their_case() {
    if stillbase::picture::render::offscreen::Gpu::new().is_err() {
        return;
    }
    let folder = Folder::new("pictured");
    let options =
        Options { pictures: Some(Pictures { fps: 10.0, width: 64, height: 40, pin_forces: false }), force: false };
    let cases = [short("case-1"), short("case-3")];
    record(&cases, &folder.path("two.rrd"), &options, &mut quietly).expect("two cases");
    let parts = parts(&Contents::of(&folder.path("two.rrd")));
    for case in cases {
        let origin = format!("/{}/view", case.name);
        assert_eq!(parts.iter().filter(|(_, class, from)| class == "2D" && *from == origin).count(), 2, "{origin}");
    }
}

#[test]
fn a_gesture_is_one_event() {
    let folder = Folder::new("gestures");
    let mut scenario = short("case-3");
    scenario.duration = Some(0.9);
    let push = |step, x: f64| TimedEdit { step, edit: Edit::Push { x, y: 0.0 } };
    let drag = |step, x: f64| TimedEdit { step, edit: Edit::DragTarget { x, y: 0.8 } };
    // A frame brings an edit; a still hand brings none for a while; then the pointer leads, rests, and leads again.
    scenario.edits = (0..10).map(|i| push(16 * i, 0.1 + 0.01 * i as f64)).collect();
    scenario.edits.extend([push(450, 0.05), push(466, 0.0), push(470, 0.02), push(480, 0.0)]);
    scenario.edits.extend((0..5).map(|i| drag(500 + 16 * i, 0.52 + 0.001 * i as f64)));
    scenario.edits.push(drag(840, 0.55));
    record_in(&folder, "one.rrd", std::slice::from_ref(&scenario)).expect("an edited case");
    let told = Contents::of(&folder.path("one.rrd")).texts("/case-3/events", "TextLog:text");
    let edits: Vec<&str> =
        told.iter().map(String::as_str).filter(|e| ["push", "let", "drag"].iter().any(|w| e.starts_with(w))).collect();
    assert_eq!(
        edits,
        [
            "push with up to 0.19 N, within 0.450 s",
            "let go",
            "push with 0.02, 0.00 N",
            "let go",
            "drag target to 0.524, 0.800 m, within 0.064 s",
            "drag target to 0.550, 0.800 m",
        ]
    );
}

/// Chunks without their identifiers.
fn data(file: &std::path::Path) -> Vec<(String, Vec<String>)> {
    let contents = Contents::of(file);
    contents
        .stores
        .iter()
        .map(|(id, chunks)| {
            let rows = chunks.iter().map(|c| {
                let mut columns: Vec<String> =
                    c.components().values().map(|x| format!("{} {:?}", x.descriptor, x.list_array)).collect();
                columns.sort();
                format!("{} {:?} {columns:?}", c.entity_path(), c.row_ids().collect::<Vec<_>>())
            });
            (id.to_string(), rows.collect())
        })
        .collect()
}

#[test]
fn recording_again_gives_the_same_recording() {
    let folder = Folder::new("again");
    let scenarios = [short("case-1"), short("case-2")];
    for name in ["a.rrd", "b.rrd"] {
        record_in(&folder, name, &scenarios).expect("two cases");
    }
    assert_eq!(data(&folder.path("a.rrd")), data(&folder.path("b.rrd")));
    let mut other = short("case-2");
    other.control.kp = stillbase::simulation::plant::Each::All(100.0);
    record_in(&folder, "c.rrd", &[short("case-1"), other]).expect("two cases");
    let ids = |name: &str| Contents::of(&folder.path(name)).stores.into_keys().collect::<Vec<_>>();
    assert_ne!(ids("a.rrd"), ids("c.rrd"), "another recording has another name");
}

#[test]
fn edits_on_the_way_are_recorded() {
    let folder = Folder::new("edits");
    let mut scenario = short("case-3");
    let edit = |step, edit| TimedEdit { step, edit };
    scenario.edits = vec![
        edit(22, Edit::DragTarget { x: 3.0, y: 0.0 }),
        edit(40, Edit::CompareB { b: Some(1.0) }),
        edit(60, Edit::SetMachine { key: "limits.a1".into(), value: "0.4,2.7".into() }),
    ];
    record_in(&folder, "edited.rrd", &[scenario]).expect("an edited case");
    let contents = Contents::of(&folder.path("edited.rrd"));
    let events = contents.texts("/case-3/events", "TextLog:text");
    for part in ["drag target to 3.000", "compare with b = 1.000 rad", "set limits.a1", "the target is outside"] {
        assert!(events.iter().any(|e| e.starts_with(part)), "{part} in {events:?}");
    }
    let steps = |path: &str, component: &'static str| -> Vec<i64> {
        let chunks = contents.at(path).into_iter().filter(|c| c.components().contains_component(component.into()));
        chunks.flat_map(|c| c.timelines()[&TimelineName::from("step")].times_raw().to_vec()).collect()
    };
    // What changes on the way is not static: with other limits workspaces are others from step 60 on, links are not.
    assert_eq!(steps("/case-3/machine/link/1", "Mesh3D:vertex_positions"), [0]);
    assert_eq!(steps("/case-3/workspace/2.400", "Mesh3D:vertex_positions"), [0, 60]);
    assert_eq!(steps("/case-3/workspace/5.000", "Mesh3D:vertex_positions"), [0]);
    assert_eq!(steps("/case-3/workspace/5.000", "Clear:is_recursive"), [40]);
    assert_eq!(steps("/case-3/workspace/1.000", "Mesh3D:vertex_positions"), [40, 60]);
    // The plan is there until the pointer leads.
    for (path, component) in [
        ("plan/path", "LineStrips3D:strips"),
        ("joint_space/path", "LineStrips3D:strips"),
        ("tower/reach/B", "LineStrips3D:strips"),
    ] {
        assert_eq!(steps(&format!("/case-3/{path}"), component), [0], "{path}");
    }
    for path in ["plan/path", "plan/start/1", "joint_space/path", "tower/reach/B", "tower/path"] {
        assert_eq!(steps(&format!("/case-3/{path}"), "Clear:is_recursive"), [22], "{path}");
    }
    assert_eq!(steps("/case-3/tower/wall", "Mesh3D:vertex_positions"), [0, 60]);
    assert_eq!(steps("/case-3/joint_space/plane", "Mesh3D:vertex_positions"), [0, 60]);
    // Also between the instants at which bodies have their rows.
    let moved = steps("/case-3/joint_space/pose", "Points3D:positions");
    assert!(moved.windows(2).all(|w| w[0] < w[1]) && moved[4..7] == [20, 22, 25], "{moved:?}");
    assert_eq!(contents.texts("/case-3/phase", "StateChange:state"), ["motion", "follow"]);
}

#[test]
fn a_file_is_never_replaced_unasked_and_never_left_half() {
    let folder = Folder::new("refused");
    let file = folder.path("there.rrd");
    std::fs::write(&file, "mine").expect("a file");
    let refused = record_in(&folder, "there.rrd", &[short("case-3")]);
    assert!(matches!(refused, Err(RecordError::Write(WriteError::Exists(f))) if f == file));
    assert_eq!(std::fs::read(&file).expect("the file"), b"mine");

    let unplannable =
        Scenario { task: stillbase::session::scenario::Task { b: 9.0, ..short("case-3").task }, ..short("case-3") };
    let force = Options { force: true, ..Options::default() };
    let refused = record(&[short("case-1"), unplannable], &file, &force, &mut quietly);
    assert!(matches!(&refused, Err(RecordError::Refused { scenario, .. }) if scenario == "case-3"), "{refused:?}");
    assert_eq!(std::fs::read(&file).expect("the file"), b"mine", "what was there is there still");
    assert_eq!(folder.names(), ["there.rrd"], "nothing half written beside");

    record(&[short("case-3")], &file, &force, &mut quietly).expect("it may replace it");
    assert!(!Contents::of(&file).recording().is_empty());
    assert_eq!(folder.names(), ["there.rrd"]);
}

#[test]
fn a_folder_that_cannot_be_written_is_named() {
    let folder = Folder::new("unwritable");
    std::fs::write(folder.path("plain"), "").expect("a file");
    for name in ["no/such/folder.rrd", "plain/inside.rrd"] {
        let error = record_in(&folder, name, &[short("case-3")]).expect_err("nowhere to write");
        assert!(matches!(&error, RecordError::Write(WriteError::NoFolder { file, .. }) if *file == folder.path(name)));
        assert!(error.to_string().contains(name), "{error}");
    }
    let error = record(&[short("case-3")], &folder.0, &Options { force: true, pictures: None }, &mut quietly);
    assert!(matches!(error, Err(RecordError::Write(WriteError::IsFolder(_)))), "a folder is no file");
    assert_eq!(folder.names(), ["plain"]);
    // Where not even root can write.
    #[cfg(target_os = "linux")]
    {
        let file = PathBuf::from("/proc/case.rrd");
        let error = record(&[short("case-3")], &file, &Options::default(), &mut quietly).expect_err("nowhere to write");
        assert!(matches!(&error, RecordError::Write(WriteError::Failed { file: named, .. }) if *named == file));
    }
}

#[test]
fn what_cannot_be_recorded_is_said() {
    let folder = Folder::new("said");
    assert!(matches!(record_in(&folder, "x.rrd", &[]), Err(RecordError::Nothing)));
    let twice = record_in(&folder, "x.rrd", &[short("case-1"), short("case-1")]);
    assert!(matches!(twice, Err(RecordError::SameName(name)) if name == "case-1"));
    for pictures in [
        Pictures { fps: 0.0, width: 10, height: 10, pin_forces: false },
        Pictures { fps: f64::NAN, width: 10, height: 10, pin_forces: false },
        Pictures { fps: 30.0, width: 0, height: 10, pin_forces: false },
    ] {
        let options = Options { pictures: Some(pictures), force: false };
        let refused = record(&[short("case-1")], &folder.path("x.rrd"), &options, &mut quietly);
        assert!(matches!(refused, Err(RecordError::Pictures(_))), "{pictures:?}");
    }
    assert!(folder.names().is_empty());
}

#[test]
fn names_with_slashes_and_blanks_stay_one_case() {
    let folder = Folder::new("names");
    let scenario = Scenario { name: "a/b c".into(), ..short("case-3") };
    record_in(&folder, "x.rrd", &[scenario]).expect("a case");
    let contents = Contents::of(&folder.path("x.rrd"));
    let of_case = contents.recording().iter().filter(|c| !c.entity_path().is_property());
    assert!(of_case.into_iter().all(|c| c.entity_path().iter().next().is_some_and(|p| p.unescaped_str() == "a/b c")));
}

#[cfg(feature = "render")]
#[test]
fn pictures_come_at_their_times_or_it_is_said_why_not() {
    let folder = Folder::new("pictures");
    let options =
        Options { pictures: Some(Pictures { fps: 30.0, width: 64, height: 40, pin_forces: false }), force: false };
    let recordings = record(&[short("case-3")], &folder.path("x.rrd"), &options, &mut quietly).expect("a case");
    let contents = Contents::of(&folder.path("x.rrd"));
    let chunks = contents.at("/case-3/view");
    if stillbase::picture::render::offscreen::Gpu::new().is_err() {
        assert!(chunks.is_empty() && recordings[0].notes[0].starts_with("recorded without pictures"));
        return;
    }
    assert!(recordings[0].notes.is_empty());
    let steps: Vec<i64> =
        chunks.iter().flat_map(|c| c.timelines()[&TimelineName::from("step")].times_raw().to_vec()).collect();
    assert_eq!(steps, [0, 33, 67, 100]);
    assert_eq!(contents.texts("/case-3/view", "EncodedImage:media_type"), vec!["image/png"; 4]);
    let huge =
        Options { pictures: Some(Pictures { fps: 30.0, width: u32::MAX, height: 1, pin_forces: false }), force: false };
    let refused = record(&[short("case-3")], &folder.path("y.rrd"), &huge, &mut quietly);
    assert!(matches!(refused, Err(RecordError::Pictures(_))));
    assert_eq!(folder.names(), ["x.rrd"]);
}

/// On a base that floats the machine is where it truly is, its workspace with it, and what happens is told.
#[test]
fn a_base_that_moves_is_recorded_as_it_moves() {
    let folder = Folder::new("floating");
    let mut scenario = short("case-1");
    scenario.base.kind = stillbase::simulation::plant::BaseKind::Free;
    scenario.base.wheel = Some(stillbase::simulation::plant::Wheel { torque_limit: Some(0.02), ..Default::default() });
    scenario.plant.payload =
        stillbase::simulation::plant::Load { mass: 0.3, from: 0.02, until: Some(0.06), ..Default::default() };
    record_in(&folder, "one.rrd", std::slice::from_ref(&scenario)).expect("a case");
    let contents = Contents::of(&folder.path("one.rrd"));
    let mut frames = Vec::new();
    replay(&scenario, |_, frame| frames.push(*frame)).expect("it runs");
    let part = &scenario.machine.resolved_links()[4];
    let places = |path: &str| contents.vectors(path, "Transform3D:translation");
    let (steps, at) = places("/case-1/machine/link/5");
    for (step, at) in steps.iter().zip(&at) {
        let f = &frames[*step as usize];
        let root = f.base.at + stillbase::mechanics::machine::place_of(&part.root, &f.q.units());
        assert!((f64::from(at[0]) - root.re).hypot(f64::from(at[1]) - root.im) < 1e-6, "{step}");
    }
    for path in ["/case-1/machine/base", "/case-1/workspace/2.400"] {
        let (steps, at) = places(path);
        assert!(steps.len() > 10, "{path} moves");
        for (step, at) in steps.iter().zip(&at) {
            let b = frames[*step as usize].base.at;
            assert!((f64::from(at[0]) - b.re).hypot(f64::from(at[1]) - b.im) < 1e-6, "{path} at {step}");
        }
    }
    let last = frames.last().expect("frames");
    assert!(last.base.at.norm() > 1e-6 && last.base.angle.abs() > 1e-6, "{:?}", last.base);
    let events = contents.texts("/case-1/events", "TextLog:text").join("\n");
    for part in ["the payload is picked up", "the payload is let go", "the reaction wheel saturates"] {
        assert!(events.contains(part), "{part} in {events}");
    }
    assert!(!events.contains("audit failed"), "{events}");
}

/// What reaches the base is one thing in the window and in the recording, under gravity, with a load and with both: the
/// same numbers in the same words, each in its own colour.
#[test]
fn the_reaction_is_the_same_in_the_window() {
    use rerun::external::arrow::array::UInt32Array;
    use stillbase::picture::scene::options::ViewOptions;
    use stillbase::picture::scene::palette::{Theme, palette};
    use stillbase::picture::scene::stage::Stage;
    let folder = Folder::new("reaction");
    let p = palette(Theme::Dark);
    let packed = |c: [f32; 4]| c.iter().fold(0u32, |all, x| all << 8 | (x * 255.0).round() as u32);
    let mut kinds = std::collections::BTreeSet::new();
    for (name, gravity, mass) in
        [("case-1", -9.81, 0.0), ("case-1", -9.81, 0.4), ("case-3", -9.81, 0.0), ("case-3", 0.0, 0.3)]
    {
        let mut scenario = short(name);
        scenario.machine = scenario.machine.set("gravity", &format!("0,{gravity}")).expect("a machine");
        scenario.plant.payload.mass = mass;
        let file = format!("{name}-{gravity}-{mass}.rrd");
        record_in(&folder, &file, std::slice::from_ref(&scenario)).expect("recorded");
        let contents = Contents::of(&folder.path(&file));
        let mut frames: Vec<Frame> = Vec::new();
        let run = replay(&scenario, |_, frame| frames.push(*frame)).expect("it runs");
        let stage = Stage::of(&run);
        let mut rows = 0;
        for chunk in contents.at(&format!("/{name}/reaction/words")).into_iter().filter(|c| !c.is_static()) {
            let steps = chunk.timelines()[&TimelineName::from("step")].times_raw();
            let column = |component: &'static str| chunk.components().get_array(component.into()).expect("a column");
            let (labels, colours) = (column("Points3D:labels"), column("Points3D:colors"));
            for (i, step) in steps.iter().enumerate() {
                let (labels, colours) = (labels.value(i), colours.value(i));
                let labels = labels.as_any().downcast_ref::<StringArray>().expect("words");
                let colours = colours.as_any().downcast_ref::<UInt32Array>().expect("colours");
                let options = ViewOptions { invites: false, ..ViewOptions::default() };
                let scene = stage.scene(&frames[*step as usize], &options);
                for k in 0..2 {
                    let seen = scene.labels.iter().find(|l| l.text.starts_with(["f_B", "n_B"][k])).expect("a label");
                    assert_eq!(labels.value(k), seen.text, "{file} at {step}");
                    assert_eq!(colours.value(k), packed(seen.colour), "{file} at {step}: {}", seen.text);
                    kinds.insert((k, seen.colour == p.reaction));
                }
                let weight = (gravity != 0.0).then(|| frames[*step as usize].wrench.statical.force.norm());
                let words = weight.map(|w| format!("and its weight, {w:.1} N"));
                assert_eq!(
                    words.as_deref(),
                    labels.iter().flatten().find(|t| t.starts_with("and ")),
                    "{file} at {step}"
                );
                rows += 1;
            }
        }
        assert!(rows > 0, "{file}: {rows}");
        // Arrows lie along the force of motion; the static part has none.
        let arrows = contents.strips(&format!("/{name}/reaction/force"));
        assert_eq!(mass > 0.0, !arrows.is_empty(), "{file}");
    }
    assert_eq!(kinds.len(), 4, "each of the two was green and red: {kinds:?}");
}

/// A colour as the viewer has it: of lines, points and words over the background, because they hide what is behind them.
fn seen(rgba: [f32; 4], background: [f32; 4]) -> u32 {
    let [.., alpha] = rgba;
    let over = |i: usize| if i == 3 { 1.0 } else { background[i] * (1.0 - alpha) + rgba[i] * alpha };
    packed([0, 1, 2, 3].map(over))
}

fn packed(rgba: [f32; 4]) -> u32 {
    rgba.iter().fold(0, |all, x| all << 8 | (x * 255.0).round() as u32)
}

impl Contents {
    /// All colours of a component of an entity.
    fn colours(&self, path: &str, component: &'static str) -> Vec<u32> {
        use rerun::external::arrow::array::UInt32Array;
        let columns = self.at(path).into_iter().filter_map(|c| c.components().get_array(component.into()));
        let colours = columns.flat_map(|column| {
            let flat = column.values().as_any().downcast_ref::<UInt32Array>().expect("colours");
            flat.values().to_vec()
        });
        colours.collect()
    }
}

/// Whatever the window draws of a run is an entity of its recording, by its name, in its colour; in every view, of
/// machines that stand and float, with a wheel, a payload and friction, and with a target out of reach.
#[test]
fn all_that_the_window_draws_is_recorded_in_its_colour() {
    use stillbase::picture::scene::options::ViewOptions;
    use stillbase::picture::scene::palette::{Theme, palette};
    use stillbase::picture::scene::views::{ViewKind, Views};
    use stillbase::simulation::plant::{BaseKind, Load, Wheel};
    let folder = Folder::new("everything");
    let p = palette(Theme::Dark);
    let mut floating = short("case-1");
    floating.base.kind = BaseKind::Free;
    floating.duration = Some(0.4);
    floating.base.wheel = Some(Wheel { torque_limit: Some(0.02), ..Default::default() });
    floating.plant.payload = Load { mass: 0.3, from: 0.02, offset: [0.05, 0.0], ..Default::default() };
    let mut sprung = short("case-1");
    sprung.base.kind = BaseKind::Compliant;
    let mut outside = short("case-3");
    outside.edits = vec![TimedEdit { step: 10, edit: Edit::DragTarget { x: 0.2, y: 1.15 } }];
    let mut drawn = std::collections::BTreeSet::new();
    for (i, scenario) in [short("case-1"), folded(), floating, sprung, outside].into_iter().enumerate() {
        let file = format!("{i}.rrd");
        record_in(&folder, &file, std::slice::from_ref(&scenario)).expect("recorded");
        let contents = Contents::of(&folder.path(&file));
        let mut frames: Vec<Frame> = Vec::new();
        let run = replay(&scenario, |_, frame| frames.push(*frame)).expect("it runs");
        let views = Views::of(&run);
        let options = ViewOptions { invites: false, ..ViewOptions::default() };
        let root = format!("/{}", scenario.name);
        for (kind, space) in [(ViewKind::Flat, ""), (ViewKind::Joints, "/joint_space"), (ViewKind::Tower, "/tower")] {
            for frame in [frames.len() / 2, frames.len() - 1].map(|i| &frames[i / 5 * 5]) {
                let scene = views.scene(kind, frame, &options, &views.camera(kind));
                let path = |name: &str| {
                    let name = match name.strip_prefix("workspace") {
                        Some(rest) => match rest.strip_prefix("/compared") {
                            Some(rest) => format!("workspace/{:.3}{rest}", scenario.compare_b.expect("compared")),
                            None => format!("workspace/{:.3}{rest}", frames[0].b_reference),
                        },
                        None => name.to_owned(),
                    };
                    format!("{root}{space}/{name}")
                };
                let mut check = |name: &str, component: &'static str, want: u32| {
                    let colours = contents.colours(&path(name), component);
                    assert!(colours.contains(&want), "{file} {kind:?} {name}: {want:08x} in {colours:08x?}");
                    drawn.insert(name.split('/').next().unwrap_or_default().to_owned());
                };
                for solid in &scene.solids {
                    check(&solid.name, "Mesh3D:albedo_factor", packed(solid.colour));
                }
                for area in &scene.areas {
                    check(&area.name, "Mesh3D:albedo_factor", packed(area.colour));
                }
                // What the wall hides is told apart for one eye; a recording has as many as look at it.
                let lines = scene.lines.iter().filter(|l| !l.strips.is_empty() && l.name != "contours/hidden");
                for line in lines {
                    check(&line.name, "LineStrips3D:colors", seen(line.colour, p.background));
                }
                for marker in &scene.markers {
                    let edged = marker.stroke_width > 0.0 && marker.stroke != marker.fill;
                    let (component, tone) = match marker.fill[3] == 0.0 {
                        true => ("LineStrips3D:colors", marker.stroke),
                        false if edged => ("Points3D:colors", marker.stroke),
                        false => ("Points3D:colors", marker.fill),
                    };
                    check(&marker.name, component, seen(tone, p.background));
                    if edged && marker.fill[3] > 0.0 {
                        check(&format!("{}/inside", marker.name), component, seen(marker.fill, p.background));
                    }
                }
                for label in &scene.labels {
                    check(&label.name, "Points3D:colors", seen(label.colour, p.background));
                    let told = contents.texts(&path(&label.name), "Points3D:labels");
                    // The marks of a window that slides are others, and so are scales that go by the peaks so far.
                    let same = label.name.starts_with("axes") || label.text.starts_with("arc");
                    assert!(same || told.contains(&label.text), "{file} {kind:?}: {:?} in {told:?}", label.text);
                }
            }
        }
    }
    for name in ["machine", "workspace", "b_ring", "plan", "target", "wheel", "payload", "springs", "unmoved", "slice"]
    {
        assert!(drawn.contains(name), "{name} in {drawn:?}");
    }
}

/// Every plot of the window is a plot of the recording, of the same signals in the same colours.
#[test]
fn all_that_the_window_plots_is_in_the_layout() {
    use stillbase::picture::charts::{charts, colour};
    use stillbase::picture::scene::palette::{Theme, palette};
    use stillbase::simulation::plant::{BaseKind, Wheel};
    let folder = Folder::new("charts");
    let p = palette(Theme::Dark);
    let mut floating = short("case-1");
    floating.base.kind = BaseKind::Free;
    floating.base.wheel = Some(Wheel::default());
    for (i, scenario) in [short("case-1"), short("case-3"), floating].into_iter().enumerate() {
        let file = format!("{i}.rrd");
        record_in(&folder, &file, std::slice::from_ref(&scenario)).expect("recorded");
        let contents = Contents::of(&folder.path(&file));
        let layouts = contents.stores.iter().filter(|(id, _)| id.kind() == StoreKind::Blueprint);
        let chunks: Vec<&Chunk> = layouts.flat_map(|(_, chunks)| chunks).collect();
        let text = |chunk: &Chunk, component: &'static str| -> Vec<String> {
            let column = chunk.components().get_array(component.into());
            let flat = column.and_then(|c| c.values().as_any().downcast_ref::<StringArray>().cloned());
            flat.iter().flat_map(|words| words.iter().flatten().map(str::to_owned)).collect()
        };
        let run = replay(&scenario, |_, _| {}).expect("it runs");
        let table = signals(&scenario.machine);
        for chart in charts(&scenario).iter().filter(|chart| chart.in_window(true)) {
            let view = chunks.iter().find(|chunk| {
                let name = text(chunk, "ViewBlueprint:display_name");
                name.iter().any(|name| *name == chart.title || name.starts_with(&format!("{}  ", chart.title)))
            });
            let view = view.unwrap_or_else(|| panic!("{file}: {}", chart.title)).entity_path().to_string();
            let queries = chunks.iter().find(|c| c.entity_path().to_string() == format!("{view}/ViewContents"));
            let shown = text(queries.expect("contents"), "ViewContents:query");
            let held: Vec<_> = table.iter().filter(|signal| chart.holds(signal)).collect();
            let want: Vec<_> = held.iter().map(|signal| format!("$origin/{}", signal.path)).collect();
            assert!(!held.is_empty() && shown == want, "{file}: {}: {shown:?}", chart.title);
            for signal in held {
                let path = format!("/{}/signals/{}", scenario.name, signal.path);
                let want = packed(colour(signal, &p, &run.frame().peaks));
                assert_eq!(contents.colours(&path, "SeriesLines:colors"), [want], "{path}");
            }
        }
    }
}
