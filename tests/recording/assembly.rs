//! Recordings of assemblies: blocks are where the run has them, and signals are those of the run.

use arrow::array::{Array, FixedSizeListArray, Float32Array};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use stillbase::files::recorded::cases;
use stillbase::recording::{Options, RecordError, record};
use stillbase::session::assembly::{AssemblyFrame, AssemblyScenario};
use stillbase::session::{WholeFrame, replay, signals_of_whole};

use super::Contents;
use crate::folder::Folder;

fn whole(name: &str) -> AssemblyScenario {
    let keep = |assembly| Ok::<_, stillbase::session::scenario::ScenarioError>(assembly);
    let scenario = stillbase::files::assembly_scenario(name, &toml::Table::new(), keep).expect("valid");
    scenario.expect("an assembly")
}

fn frames(whole: &AssemblyScenario) -> Vec<AssemblyFrame> {
    let mut all = Vec::new();
    let see = |frame: &AssemblyFrame| {
        all.push(frame.clone());
        true
    };
    whole.run(see).expect("a run");
    all
}

#[test]
fn blocks_are_recorded_where_they_are() {
    let folder = Folder::new("recording-assembly");
    for name in ["wrist-across", "arm-against-arm"] {
        let (whole, file) = (whole(name), folder.path(&format!("{name}.rrd")));
        let scenario = whole.leading(whole.lead);
        let to = |file, options: &Options| record(std::slice::from_ref(&scenario), file, options, &mut |_| true);
        let recorded = to(&file, &Options::default()).expect("recorded");
        let (frames, contents) = (frames(&whole), Contents::of(&file));
        assert_eq!(recorded[0].steps as usize + 1, frames.len());
        assert_eq!(contents.activated, 1);
        for (i, block) in whole.assembly.blocks().iter().enumerate() {
            let path = format!("/{name}/{}", block.name);
            let (steps, places) = contents.vectors(&path, "Transform3D:translation");
            assert_eq!(steps.len(), places.len());
            let turned = contents.at(&path);
            let turned = turned.iter().filter_map(|c| c.components().get_array("Transform3D:quaternion".into()));
            let turns: Vec<f32> = turned
                .flat_map(|column| {
                    let rows =
                        column.values().as_any().downcast_ref::<FixedSizeListArray>().expect("quaternions").clone();
                    rows.values().as_any().downcast_ref::<Float32Array>().expect("numbers").values().to_vec()
                })
                .collect();
            for ((step, place), turn) in steps.iter().zip(&places).zip(turns.chunks(4)) {
                let frame = &frames[*step as usize];
                let below = block.mount.on.map_or_else(Vector3::zeros, |on| frame.tips[on]);
                let want = frame.in_space(&(below + block.mount.at));
                let off = Vector3::from(place.map(f64::from)) - want;
                assert!(off.norm() < 1e-6, "{path} at step {step}: {place:?} {want:?}");
                let [x, y, z, w] = [0, 1, 2, 3].map(|k| f64::from(turn[k]));
                let turn = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
                let want = frame.attitude.0.to_rotation_matrix() * block.mount.axes;
                assert!((turn.to_rotation_matrix().matrix() - want).amax() < 1e-6, "{path} at step {step}");
            }
            // A block on a base that rests has one row.
            let moves = block.mount.on.is_some() || name == "arm-against-arm" && places.len() > 1;
            assert!(places.len() > 40 || !moves, "{path}: {}", places.len());
            assert!(contents.holds(&format!("{path}/machine/link/1")), "{path}");
            let trail = contents.strips(&format!("/{name}/trail/{}", block.name));
            let end = trail[0].last().expect("a point").map(f64::from);
            let want = frames.last().map(|frame| frame.in_space(&frame.tips[i])).expect("a frame");
            assert!((Vector3::from(end) - want).norm() < 1e-6);
        }
        // Where the wrist reaches is there once: each block holds its b.
        let reach = contents.at(&format!("/{name}/base/reach"));
        let shapes = reach.iter().filter_map(|c| c.components().get_array("Mesh3D:vertex_positions".into()));
        assert_eq!(shapes.map(|rows| rows.len()).sum::<usize>(), usize::from(name == "wrist-across"), "{name}");
        // Every signal, row by row; and the recording is simulated again to the same numbers.
        let (signals, mut rows) = (signals_of_whole(&scenario), Vec::new());
        replay(&scenario, |run, frame| {
            let whole = WholeFrame::of(run, frame);
            rows.push((frame.time, signals.iter().map(|signal| whole.value(signal)).collect::<Vec<f64>>()));
        })
        .expect("a run");
        let case = cases(&file).expect("it is read").remove(0);
        assert_eq!(case.table.columns.len(), signals.len());
        assert!(case.table.time.len() > 400);
        for (k, signal) in signals.iter().enumerate() {
            let column = case.table.column(&signal.path).unwrap_or_else(|| panic!("{}", signal.path));
            assert_eq!(column.unit, signal.unit);
            for (time, own) in case.table.time.iter().zip(&column.values) {
                let (_, want) = rows.iter().find(|(at, _)| (at - time).abs() < 1e-9).expect("a step");
                assert_eq!(*own, want[k], "{} at {time} s", signal.path);
            }
        }
        let again = case.scenario().expect("it is read");
        let difference = case.simulated_again(&again, &case.tolerances(), || true).expect("a run");
        assert!(difference.is_equal(), "{difference:?}");
        assert_eq!(
            contents.texts(&format!("/{name}/notes"), "TextDocument:text")[0].lines().next(),
            Some(format!("# {}", whole.title).as_str())
        );
        // The same again, but for when it was written; and nothing is replaced or left behind.
        let again = folder.path("again.rrd");
        to(&again, &Options::default()).expect("recorded");
        assert!(super::told(&again) == super::told(&file));
        to(&file, &Options::default()).expect_err("it is there");
        let stopped = folder.path("stopped.rrd");
        let none = record(&[scenario], &stopped, &Options::default(), &mut |_| false);
        assert!(matches!(none, Err(RecordError::Stopped)) && !stopped.exists());
        std::fs::remove_file(&again).expect("there");
    }
    assert_eq!(folder.names(), ["arm-against-arm.rrd", "wrist-across.rrd"]);
}
