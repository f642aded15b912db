//! Machines of one to eight drives: every kind of task is recorded, with the views that the window has.

use super::*;
use stillbase::mechanics::machine::{Machine, builtin};
use stillbase::picture::scene::views::{ViewKind, Views};
use stillbase::planning::pose_space::PoseSpace;
use stillbase::session::Run;
use stillbase::session::scenario::TaskChange;

use crate::support::Noise;
use crate::support::random::{a_chain, a_pose, a_space};

/// A scenario of a machine with a task as it stands in a file, if it is one.
fn scenario(machine: &Machine, task: &str) -> Scenario {
    let base = Scenario::builtin("two-drive").expect("built in");
    let change: TaskChange = toml::from_str(task).expect("keys and values");
    let task = base.task.with_change(&change, machine).unwrap_or_else(|why| panic!("{why}: {task}"));
    Scenario { machine: machine.clone(), task, compare_b: None, duration: None, ..base }
}

/// Tasks of every kind between two poses that lie near each other.
fn tasks(noise: &mut Noise, machine: &Machine, space: &PoseSpace) -> Vec<(&'static str, Scenario)> {
    let n = machine.drives();
    let a = a_pose(noise, space);
    let b = noise.between(0.5, 3.0);
    let near: Vec<f64> = a.iter().map(|a| a + noise.between(-0.05, 0.05)).collect();
    let [q, r] = [space.lift(&a, b), space.lift(&space.clamped(&near), b)];
    let [from, to] = [&q, &r].map(|q| {
        let p = space.end_effector(q);
        [p.re, p.im]
    });
    let ends = format!("from = {from:?}\nto = {to:?}\nb = {b:?}\ntime = 0.02\n");
    let row = |t: f64, q: &[f64]| {
        let numbers: Vec<String> = std::iter::once(&t).chain(q).map(|x| format!("{x:?}")).collect();
        format!("[{}]", numbers.join(", "))
    };
    let rows: Vec<String> = (0..8)
        .map(|i| {
            row(0.01 * f64::from(i), &(0..n).map(|k| q[k] + f64::from(i) * (r[k] - q[k]) / 7.0).collect::<Vec<_>>())
        })
        .collect();
    let given = format!("kind = 'given'\n{ends}samples = [{}]\n", rows.join(", "));
    let mut all = vec![("given", given)];
    for kind in &KINDS[1..6] {
        all.push((kind, format!("kind = '{kind}'\n{ends}")));
    }
    // Two drives have one curve at zero momentum, so that only joint lines close there.
    let rounds = "closed = true\ncycles = 2\n";
    let shape = if n == 2 { "shape = 'joint-line'\n" } else { "" };
    all.push(("zero-momentum", format!("kind = 'zero-momentum'\n{ends}{rounds}{shape}")));
    all.into_iter().map(|(kind, text)| (kind, scenario(machine, &text))).collect()
}

const KINDS: [&str; 7] =
    ["given", "reactionless", "minimum-norm", "same-tip", "least-reaction", "change-b", "zero-momentum"];

/// Records the tasks of some kinds that can be planned, each with the views of the window; which kinds were.
fn recorded(
    folder: &Folder,
    noise: &mut Noise,
    (machine, space): (&Machine, &PoseSpace),
    kinds: &[&str],
) -> Vec<&'static str> {
    let mut done = Vec::new();
    for (kind, scenario) in tasks(noise, machine, space).into_iter().filter(|(kind, _)| kinds.contains(kind)) {
        let Ok(run) = Run::new(&scenario) else { continue };
        let file = format!("{}-{kind}.rrd", machine.drives());
        record(std::slice::from_ref(&scenario), &folder.path(&file), &Options::default(), &mut quietly)
            .unwrap_or_else(|why| panic!("{} drives, {kind}: {why}", machine.drives()));
        let contents = Contents::of(&folder.path(&file));
        let views = Views::of(&run);
        for (view, path) in [(ViewKind::Joints, "joint_space/pose"), (ViewKind::Tower, "tower/slice/boundary")] {
            let path = format!("/{}/{path}", scenario.name);
            assert_eq!(contents.holds(&path), views.shows(view), "{} drives, {kind}: {path}", machine.drives());
        }
        std::fs::remove_file(folder.path(&file)).expect("it is there");
        done.push(kind);
    }
    done
}

#[test]
fn every_kind_of_task_is_recorded_for_any_number_of_drives() {
    let folder = Folder::new("family");
    let mut noise = Noise::of(101);
    for n in 1..=8 {
        // Without a b, which saves the outline of many drives.
        let machine = a_chain(&mut noise, n);
        let Ok(space) = PoseSpace::nominal(&machine) else { panic!("{n} drives") };
        let done = recorded(&folder, &mut noise, (&machine, &space), &["given", "zero-momentum"]);
        assert!(done.contains(&"given") && (n < 4 || done.len() == 2), "{n} drives: {done:?}");
        if n == 2 || n == 4 {
            let (machine, space) = a_space(&mut noise, n);
            let done = recorded(&folder, &mut noise, (&machine, &space), &["zero-momentum", "change-b"]);
            assert_eq!(done.len(), 2, "{n} drives: {done:?}");
        }
    }
}

#[test]
#[ignore = "long: forty machines with outlines, of up to eight drives"]
fn every_kind_of_task_is_recorded_often() {
    let folder = Folder::new("family-often");
    let mut noise = Noise::of(103);
    let mut counts = BTreeMap::new();
    for _ in 0..5 {
        for n in 1..=8 {
            let (machine, space) = a_space(&mut noise, n);
            for kind in recorded(&folder, &mut noise, (&machine, &space), &KINDS) {
                *counts.entry((n, kind)).or_insert(0) += 1;
            }
        }
    }
    println!("{counts:?}");
    for n in 1..=8 {
        assert!(counts.contains_key(&(n, "zero-momentum")) || n == 1, "{n} drives");
    }
}

#[test]
fn sections_have_the_drive_angles_as_coordinates() {
    let folder = Folder::new("sections");
    for name in ["two-drive", "four-drive"] {
        let mut scenario = Scenario::builtin(name).expect("built in");
        scenario.duration = Some(0.2);
        record_in(&folder, name, std::slice::from_ref(&scenario)).expect("recorded");
        let contents = Contents::of(&folder.path(name));
        let mut frames = Vec::new();
        replay(&scenario, |_, frame| frames.push(*frame)).expect("it runs");
        let space = PoseSpace::of(builtin(name).expect("built in")).expect("balanced");
        let root = format!("/{name}/joint_space");
        let (steps, poses) = contents.vectors(&format!("{root}/pose"), "Points3D:positions");
        assert!(steps.len() > 30, "{name}: {} rows", steps.len());
        for (step, pose) in steps.iter().zip(&poses) {
            let q = frames[*step as usize].q;
            let third = if name == "two-drive" { 0.0 } else { q[2] };
            assert!(near(*pose, [q[0], q[1], third]), "{name}: step {step}");
        }
        let chunks: Vec<_> = contents.at(&format!("{root}/plane")).into_iter().filter(|c| !c.is_static()).collect();
        assert_eq!(chunks.is_empty(), name == "two-drive", "two drives have a line");
        let mut rows = 0;
        for chunk in chunks {
            let column = chunk.components().get_array("Mesh3D:vertex_positions".into()).expect("vertices");
            let steps = chunk.timelines()[&TimelineName::from("step")].times_raw();
            for (i, step) in steps.iter().enumerate() {
                let frame = &frames[*step as usize];
                let corners = vectors(&column.value(i));
                assert!(corners.len() > 2, "step {step}");
                for corner in corners {
                    // The drive without an axis stands where it is.
                    let mut q = frame.q.0;
                    (0..3).for_each(|k| q[k] = f64::from(corner[k]));
                    assert!((space.b(&q) - frame.b_reference).abs() < 1e-5, "step {step}: {corner:?}");
                }
                rows += 1;
            }
        }
        assert!(rows > 5 || name == "two-drive", "{name}: {rows} rows");
    }
}
