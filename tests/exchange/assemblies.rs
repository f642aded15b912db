//! Assemblies as models. What other programs make of them is in `tests/outside/`.

use nalgebra::{Matrix3, Vector3};
use stillbase::exchange::cut::Cut;
use stillbase::exchange::form::{ExportedAssembly, Form};
use stillbase::exchange::mjcf::{MjcfError, mjcf_of_assembly, qpos_of_assembly, usual_pose};
use stillbase::exchange::urdf::urdf_of_assembly;
use stillbase::mechanics::assembly::{Assembly, SpatialBase, builtin_assemblies, parse};
use stillbase::mechanics::machine::named;

use crate::support::Noise;
use crate::support::random::an_assembly;

fn poses(assembly: &Assembly) -> Vec<Vec<f64>> {
    assembly.blocks().iter().map(|block| usual_pose(&block.machine)).collect()
}

fn count(text: &str, what: &str) -> usize {
    text.matches(what).count()
}

/// A body for each link, rotor, payload, block and platform, no name twice, and a number for each joint.
#[test]
fn every_part_of_every_block_is_in_the_model_once() {
    let mut noise = Noise::of(71);
    let random = (0..20).map(|_| an_assembly(&mut noise)).collect::<Vec<_>>();
    for assembly in builtin_assemblies().iter().chain(&random) {
        let (mut moving, mut held, mut platforms) = (0, assembly.blocks().len(), 0);
        for (i, block) in assembly.blocks().iter().enumerate() {
            let spec = block.machine.spec();
            moving += block.machine.links().len() + spec.drives.iter().filter(|drive| drive.rotor.is_some()).count();
            held += usize::from(spec.payload.mass > 0.0 || spec.payload.inertia > 0.0);
            platforms += usize::from(assembly.carried_by(Some(i)).next().is_some());
        }
        let poses = poses(assembly);
        let poses: Vec<&[f64]> = poses.iter().map(Vec::as_slice).collect();
        let text = mjcf_of_assembly(assembly, None, &poses, &Cut::default()).expect("a model");
        assert_eq!(count(&text, "<body "), 1 + moving + held + platforms);
        assert_eq!(count(&text, "</body>"), count(&text, "<body "));
        assert_eq!(count(&text, "<joint name="), moving + platforms + count(&text, "joint1="));
        let joints = qpos_of_assembly(assembly, None, &poses).expect("a pose");
        assert_eq!(joints.len(), moving + platforms);
        assert!(!text.contains("NaN") && !text.contains("inf"));
        for text in [text, urdf_of_assembly(assembly, None, &Cut::default())] {
            let tree = roxmltree::Document::parse(&text).expect("well-formed");
            let kinds = ["body", "joint", "site", "link", "fixed", "motor"];
            for kind in kinds {
                let all = tree.descendants().filter(|node| node.has_tag_name(kind));
                let names: Vec<&str> = all.filter_map(|node| node.attribute("name")).collect();
                let once: std::collections::BTreeSet<&str> = names.iter().copied().collect();
                assert_eq!(names.len(), once.len(), "{kind}");
            }
        }
    }
}

fn geared() -> Assembly {
    let text = "kind = \"assembly\"\nname = \"geared\"\n[[block]]\nname = 'a<\"b'\nmachine = \"nine-link-geared\"\n";
    parse(text, "geared", &named).expect("an assembly")
}

/// What rotors have too much about axes across theirs is taken off a base that has it, and told of one that has not.
#[test]
fn rotors_are_taken_off_the_base() {
    let (assembly, cut) = (geared(), Cut::default());
    let rotors = assembly.blocks()[0].machine.spec().drives.iter().filter_map(|drive| drive.rotor);
    let sum: f64 = rotors.map(|rotor| rotor.inertia).sum();
    assert!(sum > 0.0);
    let poses = poses(&assembly);
    let poses: Vec<&[f64]> = poses.iter().map(Vec::as_slice).collect();
    let form = Form::of("xml").expect("a format");
    for (least, is_told) in [(1.0, false), (sum / 4.0, true)] {
        let inertia = Matrix3::from_diagonal(&Vector3::repeat(least));
        let base = SpatialBase { mass: 9.0, com: Vector3::zeros(), inertia };
        let exported = ExportedAssembly { assembly: &assembly, base: Some(&base), poses: &poses, cut: &cut };
        let text = form.written_assembly(&exported).expect("a model");
        let across = if is_told { least } else { least - 0.5 * sum };
        assert!(text.contains(&format!("fullinertia=\"{across} {across} {least} 0 0 0\"")), "{text}");
        let told = form.left_out_of_assembly(&exported);
        assert_eq!(told.iter().any(|what| what.starts_with("rotors that spin")), is_told, "{told:?}");
    }
}

#[test]
fn names_and_faults_of_blocks_are_told() {
    let (assembly, cut) = (geared(), Cut::default());
    let text = mjcf_of_assembly(&assembly, None, &[&[0.0; 3]], &cut).expect("a model");
    assert!(text.contains("<body name=\"a&lt;&quot;b/link_1\""), "{text}");
    let wrong = |poses: &[&[f64]]| mjcf_of_assembly(&assembly, None, poses, &cut);
    assert_eq!(wrong(&[]), Err(MjcfError::Pose { given: 0, wanted: 3 }));
    assert_eq!(wrong(&[&[0.0; 3], &[0.0]]), Err(MjcfError::Pose { given: 4, wanted: 3 }));
    let light = assembly.clone().with_machines(|_, machine| machine.set("link.4.inertia", "0")).expect("in range");
    let why = mjcf_of_assembly(&light, None, &[&[0.0; 3]], &cut).expect_err("MuJoCo moves no such body");
    assert_eq!(why, MjcfError::Massless { link: "a<\"b/4".into(), what: "inertia" });
}
