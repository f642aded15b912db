//! Small pictures of machines stay within their frames, painted and as SVG.

use egui::{Context, LayerId, Painter, RawInput, Rect, pos2};
use stillbase::mechanics::machine::{BarStock, Counterweight, CounterweightShape, Machine, builtin, builtins};
use stillbase::picture::scene::palette::{Theme, palette};
use stillbase::picture::scene::portrait::{Portrait, portrait_svg};

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

/// Machines with counterweights of every shape on a machine without bars of its own and on bars, and all that come
/// along.
fn machines() -> Vec<Machine> {
    let shapes = [
        CounterweightShape::Disc { radius: 0.06 },
        CounterweightShape::Ring { radius: 0.06, inner_radius: 0.02 },
        CounterweightShape::HalfRing { radius: 0.06, inner_radius: 0.055 },
        CounterweightShape::HalfRing { radius: 0.06, inner_radius: 0.0 },
        CounterweightShape::Box { length: 0.2, width: 0.002 },
    ];
    let shaped = shapes.into_iter().flat_map(|shape| {
        let mut spec = builtin("nine-link-bare").expect("built in").spec().clone();
        for link in ["1", "2", "5"] {
            spec.counterweights.push(Counterweight::new(link, 1.0, [-0.1, 0.0], shape));
        }
        let machine = Machine::new(spec).expect("valid");
        let on_bars = machine.with_bars(&BarStock::default(), &[[-0.2, 0.6]; 9]).expect("bars");
        [machine, on_bars]
    });
    shaped.chain(builtins().iter().cloned()).collect()
}

/// Counterweights of every shape, also those that consist of thin pieces, have no spikes.
#[test]
fn counterweights_of_every_shape_stay_in_the_picture() {
    let frame = Rect::from_min_max(pos2(100.0, 100.0), pos2(280.0, 182.0));
    for machine in machines() {
        for bounds in painted(&machine, frame) {
            assert!(frame.expand(8.0).contains_rect(bounds), "{}: {bounds:?}", machine.name());
        }
    }
}

/// Ratio of contrast of two sRGB colours by WCAG.
fn contrast(colours: [&str; 2]) -> f64 {
    let luminance = |colour: &str| {
        let part = |i: usize| {
            let c = f64::from(u8::from_str_radix(&colour[i..i + 2], 16).expect("hexadecimal")) / 255.0;
            if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
        };
        0.2126 * part(1) + 0.7152 * part(3) + 0.0722 * part(5)
    };
    let [a, b] = colours.map(luminance);
    (a.max(b) + 0.05) / (a.min(b) + 0.05)
}

/// As SVG, all lies within the picture, each link and pin is there, and what has no edge stands out on white and on
/// black.
#[test]
fn a_portrait_is_an_svg_for_every_page() {
    for machine in machines() {
        let text = portrait_svg(&machine);
        let document = roxmltree::Document::parse(&text).expect("XML");
        let root = document.root_element();
        let size = |name: &str| root.attribute(name).expect("a size").parse::<f64>().expect("a number");
        let [width, height] = [size("width"), size("height")];
        assert!(width < 460.0 && height < 340.0, "{}: {width} x {height}", machine.name());
        let label = root.attribute("aria-label").expect("a label");
        assert!(label.starts_with(&format!("{}: ", machine.name())), "{label}");
        let named = |tag: &str| document.descendants().filter(|node| node.has_tag_name(tag)).count();
        assert_eq!(named("g"), machine.links().len());
        assert_eq!(named("title"), 1 + machine.links().len());
        let is_inside =
            |at: [f64; 2], by: f64| at[0] >= by && at[1] >= by && at[0] + by <= width && at[1] + by <= height;
        let number = |word: &str| word.parse::<f64>().expect("a number");
        for node in document.descendants() {
            let thick = node.attribute("stroke-width").map_or(0.0, number) / 2.0;
            if node.has_tag_name("circle") {
                let [x, y, r] = ["cx", "cy", "r"].map(|name| number(node.attribute(name).expect("a number")));
                assert!(is_inside([x, y], r + thick), "{}: circle at {x} {y}", machine.name());
            }
            for corner in node.attribute("d").into_iter().flat_map(|d| d.split(['M', 'L', 'Z'])) {
                if let Some((x, y)) = corner.trim().split_once(' ') {
                    assert!(is_inside([number(x), number(y)], thick), "{}: {corner}", machine.name());
                }
            }
            let Some(fill) = node.attribute("fill").filter(|_| node.has_tag_name("tspan")) else { continue };
            assert!(contrast([fill, "#ffffff"]) > 2.9 && contrast([fill, "#1e1e1e"]) > 2.9, "{fill}");
        }
    }
}
