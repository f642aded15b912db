//! Links with parts, and links of a machine with heights, are drawn as they are cut.

use stillbase::exchange::cut::Cut;
use stillbase::exchange::mjcf::middle;
use stillbase::exchange::solids::{axles, has_heights, link_solids};
use stillbase::exchange::stl::solids;
use stillbase::mechanics::machine::{Machine, builtins, parse};
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Pose2};
use stillbase::mechanics::sketch::Template;
use stillbase::picture::scene::linkage::LinkageModel;
use stillbase::picture::scene::palette::{Theme, palette};
use stillbase::picture::scene::{Mesh, Solid};

/// The machine of the guide whose links have bars, a plate, pipes and a lump.
fn made_arm() -> Machine {
    let guide = include_str!("../../src/guide/files.md");
    let (_, rest) = guide.split_once("```toml made-arm.toml\n").expect("the machine of the guide");
    let (text, _) = rest.split_once("```").expect("its end");
    parse(text, "made-arm.toml").expect("a machine")
}

fn machines() -> Vec<Machine> {
    let drawn = Template::ALL.iter().filter_map(|template| template.sketch().machine());
    builtins().iter().cloned().chain(drawn).chain([made_arm()]).collect()
}

/// The machine with each link at a height of its own, so far apart that no two solids meet.
fn spread(machine: &Machine) -> Machine {
    let mut spec = machine.spec().clone();
    for (j, link) in spec.links.iter_mut().enumerate() {
        link.axial = 0.1 * j as f64;
    }
    Machine::new(spec).expect("a machine")
}

/// Volume, m³, of a mesh that is stretched along z.
fn volume(mesh: &Mesh, stretch: f64) -> f64 {
    let about = mesh.positions.first().copied().unwrap_or_default();
    let corner = |k: u32| [0, 1, 2].map(|i| f64::from(mesh.positions[k as usize][i]) - f64::from(about[i]));
    let six = |t: &[u32; 3]| {
        let [a, b, c] = t.map(corner);
        a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    stretch * mesh.triangles.iter().map(six).sum::<f64>() / 6.0
}

fn drawn(machine: &Machine, cut: &Cut) -> (LinkageModel, Vec<Solid>) {
    let linkage = LinkageModel::cut(machine, cut);
    let q = middle(machine);
    let e = DriveAngles(PerDrive::from_fn(machine.drives(), |k| q[k])).units();
    let all = linkage.solids(&e, Pose2::default(), false, &palette(Theme::Dark));
    (linkage, all)
}

/// Interval of the coordinates of points along each axis.
fn box_of(points: impl Iterator<Item = [f64; 3]>) -> [[f64; 2]; 3] {
    points.fold([[f64::INFINITY, f64::NEG_INFINITY]; 3], |all, p| {
        [0, 1, 2].map(|i| [all[i][0].min(p[i]), all[i][1].max(p[i])])
    })
}

#[test]
fn links_are_drawn_with_the_volume_of_what_is_cut() {
    let mut compared = 0;
    for machine in machines().iter().map(spread).filter(has_heights) {
        let cut = Cut::default().fitting(&machine);
        let Ok(written) = solids(&machine, &middle(&machine), &cut) else { continue };
        let (linkage, all) = drawn(&machine, &cut);
        let total = written.iter().map(|solid| solid.volume()).sum::<f64>();
        let (mut seen, mut own_total) = (0.0, 0.0);
        for (j, link) in machine.links().iter().enumerate() {
            let own = link_solids(&machine, &cut).into_iter().filter(|solid| solid.link == j);
            let wanted: f64 = own.map(|solid| solid.mesh(&machine).volume()).sum();
            let mesh = &linkage.model.meshes[linkage.bars()[j].mesh];
            let drawn = volume(mesh, 1.0);
            assert!((drawn - wanted).abs() < 1e-4 * wanted, "{}, link {}: {drawn} {wanted}", machine.name(), link.name);
            (seen, own_total) = (seen + drawn, own_total + wanted);
            compared += 1;
        }
        // Pins and spacers, stretched to their lengths.
        let of_pins = all.iter().filter(|s| s.name == "machine/joints" || s.name == "machine/joints/spacers");
        let pins: f64 =
            of_pins.map(|s| volume(&linkage.model.meshes[s.mesh], f64::from(s.world_from_item[2][2]))).sum();
        let of_links: f64 = written.iter().take(link_solids(&machine, &cut).len()).map(|s| s.volume()).sum();
        assert!((of_links - own_total).abs() < 1e-9 * own_total, "{}", machine.name());
        // Circles of pins are drawn a little within those that are cut, as their corners lie on the circle; holes
        // that nothing passes are filled.
        let holes = axles(&machine).iter().filter(|axle| !axle.is_pin()).count();
        if holes == 0 {
            let (wanted, low) = (total - of_links, 0.995);
            assert!(pins > low * wanted && pins < 1.0001 * wanted, "{}: {pins} {wanted}", machine.name());
        }
        assert!(seen > 0.0);
    }
    assert!(compared > 50, "{compared} links");
}

#[test]
fn links_are_drawn_with_the_outlines_and_heights_of_what_is_cut() {
    for machine in machines().iter().map(spread).filter(has_heights) {
        let cut = Cut::default().fitting(&machine);
        let Ok(written) = solids(&machine, &middle(&machine), &cut) else { continue };
        let (linkage, all) = drawn(&machine, &cut);
        let count = link_solids(&machine, &cut).len();
        let lowest =
            written[..count].iter().flat_map(|s| s.triangles.iter().flatten()).map(|p| p[2]).fold(f64::MAX, f64::min);
        let wanted = box_of(written[..count].iter().flat_map(|s| s.triangles.iter().flatten().copied()));
        let of_links = all.iter().filter(|s| s.name.starts_with("machine/link/"));
        let seen = box_of(of_links.flat_map(|s| {
            linkage.model.meshes[s.mesh].positions.iter().map(|p| {
                let m = &s.world_from_item;
                [0, 1, 2]
                    .map(|i| f64::from(m[3][i]) + (0..3).map(|k| f64::from(m[k][i]) * f64::from(p[k])).sum::<f64>())
            })
        }));
        for i in 0..3 {
            for side in 0..2 {
                let up = if i == 2 { lowest } else { 0.0 };
                let gap = seen[i][side] + up - wanted[i][side];
                assert!(gap.abs() < 2e-6, "{}, axis {i}: {} off", machine.name(), gap);
            }
        }
    }
}

/// Links with parts are drawn with them, at the layer of their drives.
#[test]
fn a_link_with_parts_is_drawn_as_it_is_cut_without_heights() {
    let machine = made_arm();
    assert!(!has_heights(&machine));
    let cut = Cut::default().fitting(&machine);
    let linkage = LinkageModel::cut(&machine, &cut);
    let mesh = &linkage.model.meshes[linkage.bars()[0].mesh];
    // The tip of the bracket.
    assert!(mesh.positions.iter().any(|p| (p[0] - 0.13).abs() < 1e-6 && (p[1] - 0.05).abs() < 1e-6));
    // The fore-arm is a tube with a profile at its root, no bar of the usual width.
    let mesh = &linkage.model.meshes[linkage.bars()[1].mesh];
    let [x, y, z] = box_of(mesh.positions.iter().map(|p| p.map(f64::from)));
    let size = [x[1] - x[0], y[1] - y[0], z[1] - z[0]];
    for (own, wanted) in size.into_iter().zip([0.31, 0.03, 0.02]) {
        assert!((own - wanted).abs() < 2e-5, "{size:?}");
    }
}

/// Normals are of unit length, lean to the side that their triangles face, and are smooth around curves.
#[test]
fn normals_of_real_links_shade_curves_smoothly() {
    for machine in machines().iter().map(spread) {
        let linkage = LinkageModel::of(&machine);
        for bar in linkage.bars() {
            let mesh = &linkage.model.meshes[bar.mesh];
            for triangle in &mesh.triangles {
                let [a, b, c] = triangle.map(|k| nalgebra::Vector3::from(mesh.positions[k as usize].map(f64::from)));
                let face = (b - a).cross(&(c - a));
                if face.norm() < 1e-9 {
                    continue;
                }
                for k in triangle {
                    let normal = nalgebra::Vector3::from(mesh.normals[*k as usize].map(f64::from));
                    assert!((normal.norm() - 1.0).abs() < 1e-5);
                    assert!(normal.dot(&face.normalize()) > 0.97, "{}, link {}", machine.name(), bar.name);
                }
            }
        }
    }
}
