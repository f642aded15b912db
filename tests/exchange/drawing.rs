//! Drawings: what is on them, and that nothing lies over anything else. What another reader makes of DXF is in
//! `tests/outside/`.

use roxmltree::Document;
use stillbase::exchange::cut::{Cut, CutError};
use stillbase::exchange::drawing::{Shape, Sheet, dxf, svg};
use stillbase::mechanics::machine::{Counterweight, Machine, builtin, builtins};

/// The machines that come along, some with a disc on each link.
fn machines() -> Vec<Machine> {
    let with_discs = |machine: &Machine| {
        let mut spec = machine.spec().clone();
        for (i, link) in spec.links.iter().enumerate() {
            let (link, radius) = (link.name.clone(), 0.02 * i as f64);
            spec.counterweights.push(Counterweight { link, mass: 0.5 + i as f64, at: -0.05, radius, fixed: false });
        }
        Machine::new(spec).expect("a machine")
    };
    builtins().iter().cloned().chain(builtins().iter().map(with_discs)).collect()
}

fn sheet(machine: &Machine) -> Sheet {
    Sheet::of(machine, &Cut::default()).unwrap_or_else(|why| panic!("{}: {why}", machine.name()))
}

/// Left, bottom, right and top of a part that is cut.
fn extent(shape: &Shape) -> Option<[f64; 4]> {
    match shape {
        Shape::Bar { from: [x, y], length, radius: r, .. } => Some([x - r, y - r, x + length + r, y + r]),
        Shape::Disc { at: [x, y], radius: r, .. } => Some([x - r, y - r, x + r, y + r]),
        _ => None,
    }
}

/// Every link is on the sheet once, with its pins, and no part lies over a part of another link.
#[test]
fn every_link_has_a_place_of_its_own() {
    for machine in machines() {
        let (sheet, name) = (sheet(&machine), machine.name());
        // What belongs to a link comes after its bar.
        let mut pieces: Vec<Vec<&Shape>> = Vec::new();
        for shape in sheet.shapes.iter().skip_while(|shape| !matches!(shape, Shape::Bar { .. })) {
            if matches!(shape, Shape::Bar { .. }) {
                pieces.push(Vec::new());
            }
            pieces.last_mut().expect("a bar is first").push(shape);
        }
        assert_eq!(pieces.len(), machine.links().len(), "{name}");
        for (j, piece) in pieces.iter().enumerate() {
            let (part, link) = (&machine.resolved_links()[j], &machine.links()[j]);
            let Shape::Bar { from, length, .. } = piece[0] else { panic!("a bar is first") };
            let hole = |shape: &&Shape| if let Shape::Hole { at, .. } = shape { Some(at[0]) } else { None };
            let holes: Vec<f64> = piece.iter().filter_map(hole).collect();
            let root = holes[0] - 1e3 * part.pins[0];
            let holes: Vec<f64> = holes.iter().map(|x| x - root).collect();
            assert!(from[0] + length >= root + 1e3 * part.length - 1e-6, "{name} {}", link.name);
            assert_eq!(holes.len(), part.pins.len(), "{name} {}", link.name);
            assert!(holes.iter().zip(&part.pins).all(|(hole, pin)| (hole - 1e3 * pin).abs() < 1e-6), "{holes:?}");
            let discs = piece.iter().filter_map(|s| if let Shape::Disc { at, .. } = s { Some(at[0]) } else { None });
            for at in discs {
                assert!(at > from[0] - 1e-6 && at < from[0] + length + 1e-6, "{name} {}: nothing holds it", link.name);
            }
            let com = piece.iter().find_map(|s| if let Shape::Mark { at, .. } = s { Some(*at) } else { None });
            let com = com.expect("a centre of mass");
            assert!((com[0] - root - 1e3 * link.com).abs() < 1e-6, "{name} {}", link.name);
            assert!((com[1] - from[1] - 1e3 * link.com_normal).abs() < 1e-6, "{name} {}", link.name);
        }
        let boxes: Vec<(usize, [f64; 4])> = pieces
            .iter()
            .enumerate()
            .flat_map(|(j, piece)| piece.iter().filter_map(move |shape| Some((j, extent(shape)?))))
            .collect();
        for (i, a) in &boxes {
            assert!(a[0] > 0.0 && a[1] > 0.0 && a[2] < sheet.size[0] && a[3] < sheet.size[1], "{name}: off the sheet");
            for (j, b) in boxes.iter().filter(|(j, _)| j != i) {
                let apart = a[2] < b[0] || b[2] < a[0] || a[3] < b[1] || b[3] < a[1];
                assert!(apart, "{name}: links {i} and {j} lie over each other");
            }
        }
    }
}

/// Real size: a unit of the drawing is a millimetre, and a rectangle is as long as its link.
#[test]
fn a_drawing_has_its_real_size() {
    let machine = builtin("nine-link").expect("built in");
    let (sheet, text) = (sheet(machine), svg(&sheet(machine)));
    let document = Document::parse(&text).expect("XML");
    let root = document.root_element();
    let of = |what| root.attribute(what).expect("an attribute");
    let [width, height] = sheet.size.map(|x| format!("{x:.2}"));
    assert_eq!(of("width"), format!("{width}mm"));
    assert_eq!(of("height"), format!("{height}mm"));
    assert_eq!(of("viewBox"), format!("0 0 {width} {height}"));
    let class = |name: &'static str| document.descendants().filter(move |node| node.attribute("class") == Some(name));
    assert_eq!(class("outline").count(), 9);
    // Link 1 is 500 mm from pin to pin, and its round ends add 30.
    let lengths: Vec<&str> = class("outline").filter_map(|node| node.attribute("width")).collect();
    assert_eq!(lengths[0], "530.000");
    let holes: usize = machine.resolved_links().iter().map(|part| part.pins.len()).sum();
    assert_eq!(class("hole").count(), holes);
    assert!(class("hole").all(|node| node.attribute("r") == Some("4.000")));
}

#[test]
fn dxf_is_plain_text_with_pairs_of_lines() {
    for machine in machines() {
        let text = dxf(&sheet(&machine));
        assert!(text.is_ascii());
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len() % 2, 0);
        assert!(lines.chunks(2).all(|pair| pair[0].parse::<u16>().is_ok()), "codes are numbers");
        assert_eq!(lines[lines.len() - 2..], ["0", "EOF"]);
        let of = |kind: &str| lines.chunks(2).filter(|pair| pair[0] == "0" && pair[1] == kind).count();
        assert_eq!(of("POLYLINE"), machine.links().len());
        assert_eq!(of("VERTEX"), 4 * machine.links().len());
    }
}

/// A disc says what it weighs: area by thickness by density.
#[test]
fn a_disc_is_as_thick_as_its_mass_takes() {
    let mut spec = builtin("scara").expect("built in").spec().clone();
    spec.counterweights.push(Counterweight { link: "1".into(), mass: 3.0, at: -0.2, radius: 0.08, fixed: false });
    let machine = Machine::new(spec).expect("a machine");
    let told = |cut: &Cut| svg(&Sheet::of(&machine, cut).expect("a sheet"));
    // 3 kg / (7850 kg/m³ · 201.06 cm²) = 19.0 mm.
    assert!(told(&Cut::default()).contains("counterweight Ø 160.0 mm at −200.0 mm: 19.0 mm thick 3.000 kg<"));
    let thick = Cut { thickness: Some(0.03), ..Cut::default() };
    assert!(told(&thick).contains("30.0 mm thick 4.735 kg, not 3.000 kg"));
    let light = Cut { density: 2700.0, ..Cut::default() };
    assert!(told(&light).contains("55.3 mm thick 3.000 kg"));
}

#[test]
fn what_cannot_be_cut_is_refused() {
    let machine = builtin("nine-link").expect("built in");
    let why = |cut: Cut| Sheet::of(machine, &cut).expect_err("it cannot be cut");
    let usual = Cut::default();
    for width in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e300] {
        assert!(matches!(why(Cut { bar_width: width, ..usual }), CutError::Measure { what: "bar width", .. }));
        assert!(matches!(why(Cut { density: width, ..usual }), CutError::Measure { what: "material", .. }));
        assert!(matches!(why(Cut { thickness: Some(width), ..usual }), CutError::Measure { what: "thickness", .. }));
    }
    let narrow = why(Cut { bar_width: 0.008, ..usual });
    assert_eq!(narrow.to_string(), "holes of 8.000 mm in bars 8.000 mm wide: want bars wider than their holes");
    let wide = why(Cut { bar_width: 0.3, pin_diameter: 0.25, ..usual });
    assert!(wide.to_string().contains("link \"2\"") && wide.to_string().contains("180.000 mm apart"), "{wide}");
}
