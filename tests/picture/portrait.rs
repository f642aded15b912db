//! Small pictures of machines stay within their frames.

use egui::{Context, LayerId, Painter, RawInput, Rect, pos2};
use stillbase::mechanics::machine::{BarStock, Counterweight, CounterweightShape, Machine, builtin};
use stillbase::picture::paint::portrait::Portrait;
use stillbase::picture::scene::palette::{Theme, palette};

fn painted(machine: &Machine, frame: Rect) -> Vec<Rect> {
    let ctx = Context::default();
    let input = RawInput {
        screen_rect: Some(Rect::from_min_max(pos2(-400.0, -400.0), pos2(800.0, 800.0))),
        ..RawInput::default()
    };
    let portrait = Portrait::of(machine);
    let output = ctx.run_ui(input, |ui| {
        let painter = Painter::new(ui.ctx().clone(), LayerId::background(), Rect::EVERYTHING);
        portrait.paint(&painter, frame, &palette(Theme::Dark));
    });
    let primitives = ctx.tessellate(output.shapes, 1.0);
    let meshes = primitives.into_iter().filter_map(|one| match one.primitive {
        egui::epaint::Primitive::Mesh(mesh) => Some(mesh.calc_bounds()),
        egui::epaint::Primitive::Callback(_) => None,
    });
    meshes.collect()
}

/// Counterweights of every shape, also those that consist of thin pieces, have no spikes.
#[test]
fn counterweights_of_every_shape_stay_in_the_picture() {
    let frame = Rect::from_min_max(pos2(100.0, 100.0), pos2(280.0, 182.0));
    let shapes = [
        CounterweightShape::Disc { radius: 0.06 },
        CounterweightShape::Ring { radius: 0.06, inner_radius: 0.02 },
        CounterweightShape::HalfRing { radius: 0.06, inner_radius: 0.055 },
        CounterweightShape::HalfRing { radius: 0.06, inner_radius: 0.0 },
        CounterweightShape::Box { length: 0.2, width: 0.002 },
    ];
    for shape in shapes {
        let mut spec = builtin("nine-link-bare").expect("built in").spec().clone();
        for link in ["1", "2", "5"] {
            spec.counterweights.push(Counterweight::new(link, 1.0, [-0.1, 0.0], shape));
        }
        let machine = Machine::new(spec).expect("valid");
        for machine in [machine.clone(), machine.with_bars(&BarStock::default(), &[[-0.2, 0.6]; 9]).expect("bars")] {
            for bounds in painted(&machine, frame) {
                assert!(frame.expand(8.0).contains_rect(bounds), "{shape:?}: {bounds:?}");
            }
        }
    }
}
