//! Meshes stay, bodies move, each under its case.

use super::*;

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
        // A short run has a row at each of its 101 frames, but for the first ones, in which it hardly moves.
        for component in ["Transform3D:translation", "Transform3D:quaternion"] {
            assert!((96..=101).contains(&has(&path, component, false)), "{path} {component}");
        }
    }
    for path in ["machine/base", "machine/base/cap", "machine/base/drive/2", "machine/joints", "plan/start/9"] {
        assert_eq!(has(&format!("/case-3/{path}"), "Mesh3D:vertex_positions", true), 1, "{path}");
    }
    assert_eq!(has("/case-3/machine/base", "Transform3D:translation", true), 1, "a fixed base stays");
    assert!((96..=101).contains(&has("/case-3/machine/joints", "InstancePoses3D:translations", false)));
    assert!((96..=101).contains(&has("/case-3/end_effector", "Points3D:positions", false)));
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
            let rows = rows.as_any().downcast_ref::<arrow::array::FixedSizeListArray>();
            let flat = rows.expect("vectors").values().clone();
            let flat = flat.as_any().downcast_ref::<arrow::array::Float32Array>();
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
