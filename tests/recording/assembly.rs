//! Recordings of assemblies: blocks are where the run has them, and signals are those of the run.

use arrow::array::{Array, FixedSizeListArray, Float32Array};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use stillbase::recording::record_assembly;
use stillbase::session::assembly::{AssemblyFrame, AssemblyRun, assembly_signals};

use super::Contents;
use crate::folder::Folder;

fn run(name: &str) -> AssemblyRun {
    let keep = |assembly| Ok::<_, stillbase::session::scenario::ScenarioError>(assembly);
    let scenario = stillbase::files::assembly_scenario(name, &toml::Table::new(), keep).expect("valid");
    AssemblyRun::new(&scenario.expect("an assembly")).expect("a run")
}

fn frames(run: &AssemblyRun) -> Vec<AssemblyFrame> {
    let mut all = Vec::new();
    run.run(|frame| {
        all.push(frame.clone());
        true
    });
    all
}

#[test]
fn blocks_are_recorded_where_they_are() {
    let folder = Folder::new("recording-assembly");
    for name in ["four-freedoms", "arm-against-arm"] {
        let (run, file) = (run(name), folder.path(&format!("{name}.rrd")));
        let verdict = record_assembly(&run, (&file, false), &|| true).expect("recorded");
        let (frames, contents) = (frames(&run), Contents::of(&file));
        assert_eq!(verdict.steps as usize + 1, frames.len());
        assert_eq!(contents.activated, 1);
        for (i, block) in run.scenario().assembly.blocks().iter().enumerate() {
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
        // Every signal, row by row.
        let mut seen = 0;
        for signal in assembly_signals(&run) {
            let group =
                signal.path.rsplit_once(['.', '_']).or_else(|| signal.path.rsplit_once('/')).map_or("", |(g, _)| g);
            let path = format!("/{name}/signals/{group}");
            let paths = contents.texts(&path, "paths");
            let place = paths.iter().position(|own| *own == signal.path).expect("its place");
            let values = contents.numbers(&path, "Scalars:scalars");
            let own: Vec<f64> = values.into_iter().skip(place).step_by(paths.len()).collect();
            let want: Vec<f64> = frames.iter().filter(|f| f.step % 10 == 0).map(|frame| signal.value(frame)).collect();
            assert_eq!(own, want, "{}", signal.path);
            seen += 1;
        }
        assert!(seen > 20);
        assert_eq!(
            contents.texts(&format!("/{name}/notes"), "TextDocument:text")[0].lines().next(),
            Some(format!("# {}", run.scenario().title).as_str())
        );
        // The same again, but for when it was written; and nothing is replaced or left behind.
        let again = folder.path("again.rrd");
        record_assembly(&run, (&again, true), &|| true).expect("recorded");
        assert!(super::told(&again) == super::told(&file));
        record_assembly(&run, (&file, false), &|| true).expect_err("it is there");
        let stopped = folder.path("stopped.rrd");
        assert!(record_assembly(&run, (&stopped, false), &|| false).is_err() && !stopped.exists());
        std::fs::remove_file(&again).expect("there");
    }
    assert_eq!(folder.names(), ["arm-against-arm.rrd", "four-freedoms.rrd"]);
}
