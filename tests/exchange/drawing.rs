//! Drawings: what is on them, and that nothing lies over anything else. What another reader makes of DXF is in
//! `tests/outside/`.

use roxmltree::Document;
use stillbase::exchange::cut::{Cut, CutError};
use stillbase::exchange::drawing::{Sheet, SheetShape, TextAlign, dxf, svg};
use stillbase::mechanics::machine::{Counterweight, Machine, builtin, builtins};

/// The machines that come along, some with a disc on each link.
fn machines() -> Vec<Machine> {
    let with_discs = |machine: &Machine| {
        let mut spec = machine.spec().clone();
        for (i, link) in spec.links.iter().enumerate() {
            let (link, radius) = (link.name.clone(), 0.02 * i as f64);
            spec.counterweights.push(Counterweight {
                link,
                mass: 0.5 + i as f64,
                at: -0.05,
                across: 0.0,
                radius,
                ..Default::default()
            });
        }
        Machine::new(spec).expect("a machine")
    };
    builtins().iter().cloned().chain(builtins().iter().map(with_discs)).collect()
}

fn sheet(machine: &Machine) -> Sheet {
    Sheet::of(machine, &Cut::default()).unwrap_or_else(|why| panic!("{}: {why}", machine.name()))
}

/// Left, bottom, right and top of a part that is cut.
fn extent(shape: &SheetShape) -> Option<[f64; 4]> {
    match shape {
        SheetShape::Bar { from: [x, y], length, radius: r, .. } => Some([x - r, y - r, x + length + r, y + r]),
        SheetShape::Disc { at: [x, y], radius: r, .. } => Some([x - r, y - r, x + r, y + r]),
        _ => None,
    }
}

/// Every link is on the sheet once, with its pins, and no part lies over a part of another link.
#[test]
fn every_link_has_a_place_of_its_own() {
    for machine in machines() {
        let (sheet, name) = (sheet(&machine), machine.name());
        // What belongs to a link comes after its bar.
        let mut pieces: Vec<Vec<&SheetShape>> = Vec::new();
        for shape in sheet.shapes.iter().skip_while(|shape| !matches!(shape, SheetShape::Bar { .. })) {
            if matches!(shape, SheetShape::Bar { .. }) {
                pieces.push(Vec::new());
            }
            pieces.last_mut().expect("a bar is first").push(shape);
        }
        assert_eq!(pieces.len(), machine.links().len(), "{name}");
        for (j, piece) in pieces.iter().enumerate() {
            let (part, link) = (&machine.resolved_links()[j], &machine.links()[j]);
            let SheetShape::Bar { from, length, .. } = piece[0] else { panic!("a bar is first") };
            let hole = |shape: &&SheetShape| if let SheetShape::Hole { at, .. } = shape { Some(at[0]) } else { None };
            let holes: Vec<f64> = piece.iter().filter_map(hole).collect();
            let root = holes[0] - 1e3 * part.pins[0];
            let holes: Vec<f64> = holes.iter().map(|x| x - root).collect();
            assert!(from[0] + length >= root + 1e3 * part.length - 1e-6, "{name} {}", link.name);
            assert_eq!(holes.len(), part.pins.len(), "{name} {}", link.name);
            assert!(holes.iter().zip(&part.pins).all(|(hole, pin)| (hole - 1e3 * pin).abs() < 1e-6), "{holes:?}");
            let discs =
                piece.iter().filter_map(|s| if let SheetShape::Disc { at, .. } = s { Some(at[0]) } else { None });
            for at in discs {
                assert!(at > from[0] - 1e-6 && at < from[0] + length + 1e-6, "{name} {}: nothing holds it", link.name);
            }
            let com = piece.iter().find_map(|s| if let SheetShape::Mark { at, .. } = s { Some(*at) } else { None });
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

/// Every bar, hole and disc of the sheet is in the DXF where it is on the sheet, by what the codes mean to a reader: a
/// bulge of 1 is half a circle.
#[test]
fn dxf_has_what_is_on_the_sheet() {
    for machine in machines() {
        let (sheet, name) = (sheet(&machine), machine.name());
        let text = dxf(&sheet);
        let lines: Vec<&str> = text.lines().collect();
        let mut entities: Vec<(&str, Vec<(&str, &str)>)> = Vec::new();
        for pair in lines.chunks(2) {
            match pair[0] {
                "0" => entities.push((pair[1], Vec::new())),
                code => entities.last_mut().expect("a kind is first").1.push((code, pair[1])),
            }
        }
        let number = |of: &[(&str, &str)], code: &str| -> f64 {
            let known =
                of.iter().find(|(own, _)| *own == code).unwrap_or_else(|| panic!("{name}: no {code} in {of:?}"));
            known.1.parse().expect("a number")
        };
        let layer = |of: &[(&str, &str)]| of.iter().find(|(own, _)| *own == "8").map(|(_, name)| name.to_string());
        let vertices = entities.iter().filter(|(kind, _)| *kind == "VERTEX");
        let vertices: Vec<[f64; 3]> = vertices.map(|(_, of)| ["10", "20", "42"].map(|code| number(of, code))).collect();
        let bars = sheet.shapes.iter().filter_map(|shape| match shape {
            SheetShape::Bar { length, radius, .. } => Some((extent(shape).expect("a bar"), *length, *radius)),
            _ => None,
        });
        let close = |got: f64, want: f64, what: &str| {
            assert!((got - want).abs() <= 1e-3 * (1.0 + want.abs()), "{name}: {what}: {got}, want {want}");
        };
        for (corners, (box_of, length, radius)) in vertices.chunks(4).zip(bars) {
            // Area and extent of what is drawn: the polygon, and half a disc over each side with a bulge of 1.
            let (mut area, mut drawn) = (0.0, [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY]);
            for i in 0..4 {
                let ([ax, ay, bulge], [bx, by, _]) = (corners[i], corners[(i + 1) % 4]);
                area += 0.5 * (ax * by - bx * ay);
                assert!(bulge == 0.0 || bulge == 1.0, "{name}: {bulge}");
                let half = 0.5 * (bx - ax).hypot(by - ay);
                area += bulge * 0.5 * std::f64::consts::PI * half * half;
                let (x, y, r) = (0.5 * (ax + bx), 0.5 * (ay + by), bulge * half);
                drawn = [
                    drawn[0].min(ax).min(x - r),
                    drawn[1].min(ay).min(y - r),
                    drawn[2].max(ax).max(x + r),
                    drawn[3].max(ay).max(y + r),
                ];
            }
            close(area, 2.0 * radius * length + std::f64::consts::PI * radius * radius, "area of a bar");
            drawn.iter().zip(box_of).for_each(|(got, want)| close(*got, want, "extent of a bar"));
        }
        let circles = entities.iter().filter(|(kind, _)| *kind == "CIRCLE");
        let mut circles =
            circles.map(|(_, of)| (layer(of), ["10", "20", "40"].map(|code| number(of, code)))).collect::<Vec<_>>();
        for shape in &sheet.shapes {
            let (on, want) = match shape {
                SheetShape::Hole { at, radius, .. } => ("HOLES", [at[0], at[1], *radius]),
                SheetShape::Disc { at, radius, .. } => ("COUNTERWEIGHT", [at[0], at[1], *radius]),
                _ => continue,
            };
            let (got_on, got) = circles.remove(0);
            assert_eq!(got_on.as_deref(), Some(on), "{name}");
            got.iter().zip(want).for_each(|(got, want)| close(*got, want, "a circle"));
        }
        assert!(circles.is_empty(), "{name}: {circles:?}");
        // A mark is a cross about its place; other lines are as on the sheet.
        let drawn = entities.iter().filter(|(kind, _)| *kind == "LINE");
        let mut drawn = drawn.map(|(_, of)| ["10", "20", "11", "21"].map(|code| number(of, code)));
        for shape in &sheet.shapes {
            match shape {
                SheetShape::Line([a, b]) => {
                    let line = drawn.next().expect("a line");
                    line.iter().zip([a[0], a[1], b[0], b[1]]).for_each(|(got, want)| close(*got, want, "a line"));
                }
                SheetShape::Mark { at: [x, y], radius } => {
                    for _ in 0..2 {
                        let [ax, ay, bx, by] = drawn.next().expect("half a cross");
                        close(0.5 * (ax + bx), *x, "middle of a mark");
                        close(0.5 * (ay + by), *y, "middle of a mark");
                        close((bx - ax).hypot(by - ay), 2.0 * radius, "a mark");
                        assert!(ax == bx || ay == by, "{name}: across or up");
                    }
                }
                _ => {}
            }
        }
        assert_eq!(drawn.next(), None, "{name}");
    }
}

/// Links lie beside each other as well as above each other: a sheet is no strip.
#[test]
fn a_sheet_is_about_as_high_as_wide() {
    for machine in machines().iter().filter(|machine| machine.links().len() > 3) {
        let [width, height] = sheet(machine).size;
        assert!(height < 2.0 * width && width < 3.0 * height, "{}: {width} by {height}", machine.name());
    }
}

/// A bar goes over its length and its pins, and further only for discs of its own.
#[test]
fn bars_are_as_long_as_what_they_hold() {
    for machine in builtins() {
        let mut spec = machine.spec().clone();
        let link = spec.links[0].name.clone();
        let at = -2.0 * machine.reach();
        spec.counterweights =
            vec![Counterweight { link, mass: 1.0, at, across: 0.0, radius: 0.05, ..Default::default() }];
        let machine = Machine::new(spec).expect("a machine");
        let sheet = sheet(&machine);
        let bars = sheet.shapes.iter().filter_map(|shape| match shape {
            SheetShape::Bar { length, .. } => Some(*length),
            _ => None,
        });
        for (j, (length, part)) in bars.zip(machine.resolved_links()).enumerate() {
            let all = part.pins.iter().chain([&0.0, &part.length]).chain((j == 0).then_some(&at));
            let [from, to] = all.fold([0.0_f64; 2], |[a, b], x| [a.min(*x), b.max(*x)]);
            assert!((length - 1e3 * (to - from)).abs() < 1e-6, "{} {j}: {length}", machine.name());
        }
    }
}

/// Where a length is written between two strokes, these stand across its line and end at both sides alike.
#[test]
fn strokes_stand_across_their_line() {
    for machine in machines() {
        let sheet = sheet(&machine);
        let lines: Vec<[[f64; 2]; 2]> = sheet
            .shapes
            .iter()
            .filter_map(|s| if let SheetShape::Line(ends) = s { Some(*ends) } else { None })
            .collect();
        let near = |x: f64, y: f64| (x - y).abs() < 1e-6;
        let mut strokes = 0;
        for [low, high] in lines.iter().filter(|[a, b]| near(a[0], b[0]) && a[1] != b[1]) {
            let middle = 0.5 * (low[1] + high[1]);
            let ends = lines.iter().filter(|[a, b]| near(a[1], b[1]) && near(a[1], middle)).flatten();
            assert!(ends.clone().any(|end| near(end[0], low[0])), "{}: {low:?} to {high:?}", machine.name());
            strokes += 1;
        }
        assert!(strokes > machine.links().len(), "{}", machine.name());
    }
}

/// Words about a link keep off its bar, its discs and each other, and stay on the sheet.
#[test]
fn words_keep_off_parts_and_each_other() {
    for machine in machines() {
        let sheet = sheet(&machine);
        // A letter is no wider than it is high.
        let words = sheet.shapes.iter().filter_map(|shape| match shape {
            SheetShape::Words { at: [x, y], height, anchor: TextAlign::Start, text, .. } => {
                Some(([*x, *y, x + 0.5 * height * text.chars().count() as f64, y + 0.7 * height], text))
            }
            _ => None,
        });
        let words: Vec<([f64; 4], &String)> = words.collect();
        let apart = |a: &[f64; 4], b: &[f64; 4]| a[2] < b[0] || b[2] < a[0] || a[3] < b[1] || b[3] < a[1];
        for (i, (own, text)) in words.iter().enumerate() {
            assert!(own[0] > 0.0 && own[1] > 0.0 && own[2] < sheet.size[0] && own[3] < sheet.size[1], "{text}");
            for (other, words) in &words[..i] {
                assert!(apart(own, other), "{}: {text} over {words}", machine.name());
            }
            for part in sheet.shapes.iter().filter_map(extent) {
                assert!(apart(own, &part), "{}: {text} over a part", machine.name());
            }
        }
    }
}

/// A disc says what it weighs: area by thickness by density.
#[test]
fn a_disc_is_as_thick_as_its_mass_takes() {
    let mut spec = builtin("scara").expect("built in").spec().clone();
    spec.counterweights.push(Counterweight {
        link: "1".into(),
        mass: 3.0,
        at: -0.2,
        across: 0.0,
        radius: 0.08,
        ..Default::default()
    });
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
