//! Lists of parts.

use stillbase::exchange::cut::Cut;
use stillbase::exchange::mjcf::{middle, mjcf};
use stillbase::exchange::parts::PartsList;
#[cfg(feature = "cli")]
use stillbase::exchange::stl::solids;
use stillbase::exchange::thin::too_thin;
use stillbase::exchange::urdf::urdf;
use stillbase::mechanics::machine::{Counterweight, Machine, builtin, builtins};

fn parts(machine: &Machine) -> PartsList {
    PartsList::of(machine, &Cut::default()).expect("a list")
}

/// What the csv crate reads of it.
#[cfg(feature = "cli")]
fn rows(text: &str) -> Vec<std::collections::HashMap<String, String>> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    reader.deserialize().collect::<Result<_, _>>().expect("as many fields in each line")
}

/// Another reader finds every part, and masses that add up to the machine's.
#[cfg(feature = "cli")]
#[test]
fn another_reader_finds_every_part() {
    for machine in builtins() {
        let mut spec = machine.spec().clone();
        spec.payload.mass = 0.25;
        spec.links.iter_mut().for_each(|link| link.com_normal = 0.01);
        let link = spec.links[0].name.clone();
        spec.counterweights.push(Counterweight {
            link,
            mass: 1.5,
            at: -0.1,
            across: 0.0,
            radius: 0.05,
            ..Default::default()
        });
        let machine = Machine::new(spec).expect("a machine");
        let text = parts(&machine).cells().csv();
        assert!(text.lines().count() > 8 && text.ends_with('\n'));
        let rows = rows(&text);
        let of = |kind: &str| rows.iter().filter(|row| row["part"] == kind).collect::<Vec<_>>();
        let mass =
            |kind: &str| of(kind).iter().map(|row| row["mass kg"].parse::<f64>().expect("a number")).sum::<f64>();
        assert_eq!(of("link").len(), machine.links().len());
        assert_eq!(of("motor").len(), machine.drives());
        let all = mass("link") + mass("counterweight") + mass("payload");
        assert!((all - machine.mass()).abs() < 1e-12 * all, "{}", machine.name());
        let total = of("total").iter().find(|row| row["name"] == "all").map(|row| row["mass kg"].clone());
        let own = total.and_then(|x| x.parse::<f64>().ok()).expect("a number");
        assert!((own - machine.mass()).abs() <= 1e-14 * own, "{own}");
        let disc = of("counterweight").pop().expect("one");
        let [area, thickness, density] = [
            std::f64::consts::PI * disc["radius m"].parse::<f64>().expect("a number").powi(2),
            disc["thickness m"].parse().expect("a number"),
            disc["density kg/m³"].parse().expect("a number"),
        ];
        assert!((area * thickness * density - 1.5).abs() < 1e-12);
    }
}

/// The nine-link machine has a pin at B, one where links 5 and 7 hang on 1, and those that close its loops.
#[test]
fn a_pin_joins_all_that_meets_there() {
    let list = parts(builtin("nine-link").expect("built in"));
    let text = list.markdown();
    let pins: Vec<&str> =
        text.lines().skip_while(|line| *line != "## Pins").skip(4).take_while(|l| !l.is_empty()).collect();
    assert_eq!(pins.len(), 8, "{pins:#?}");
    assert!(pins[0].contains("base · link 1 at 0.0000 m · link 2 at 0.0000 m · link 3 at 0.0000 m"), "{}", pins[0]);
    let elbow = "link 1 at 0.5000 m · link 5 at 0.0000 m · link 7 at 0.0000 m";
    assert_eq!(pins.iter().filter(|pin| pin.contains(elbow)).count(), 1, "{pins:#?}");
    assert!(
        pins.iter().any(|pin| pin.contains("link 5 at -0.1800 m") && pin.contains("link 4 at 0.5000 m")),
        "{pins:#?}"
    );
}

/// Columns stand under each other.
#[test]
fn a_table_to_read_is_aligned() {
    let text = parts(builtin("serial-3r").expect("built in")).markdown();
    let mut tables = 0;
    for table in text.split("\n\n").filter(|block| block.starts_with('|')) {
        let bars = |line: &str| line.chars().enumerate().filter(|(_, c)| *c == '|').map(|(i, _)| i).collect::<Vec<_>>();
        let first = bars(table.lines().next().expect("a head"));
        assert!(table.lines().all(|line| bars(line) == first), "{table}");
        tables += 1;
    }
    assert_eq!(tables, 4, "links, motors, pins, totals");
    assert!(text.contains("| 2    |") && text.contains("-30.000"), "{text}");
}

/// Names may hold what separates fields.
#[test]
fn names_of_a_stranger_stay_in_their_field() {
    let mut spec = builtin("scara").expect("built in").spec().clone();
    let name = "a,\"b\"\nc|d";
    spec.links[1].name = name.into();
    spec.end_effector.as_mut().expect("an end").link = name.into();
    let list = parts(&Machine::new(spec).expect("a machine"));
    assert!(list.cells().csv().contains("\nlink,\"a,\"\"b\"\"\nc|d\",2,0.35,4,"), "{}", list.cells().csv());
    assert!(list.markdown().contains("| a,\"b\" c\\|d |"), "{}", list.markdown());
}

/// A spreadsheet computes no name; numbers stay numbers.
#[test]
fn names_are_no_formulas() {
    for name in ["=HYPERLINK(\"x\")", "+1", "-1+2", "@SUM(A1)", " =1"] {
        let mut spec = builtin("scara").expect("built in").spec().clone();
        spec.links[1].name = name.into();
        spec.end_effector.as_mut().expect("an end").link = name.into();
        let list = parts(&Machine::new(spec).expect("a machine"));
        let rows = list.cells().csv().lines().filter(|line| line.contains(&name.replace('"', "\"\""))).count();
        assert!(rows >= 1, "{}", list.cells().csv());
        for cell in list.cells().csv().replace('\n', ",").split(',') {
            let is_formula = cell.trim_start_matches(['"', ' ']).starts_with(['=', '+', '-', '@']);
            assert!(!is_formula || cell.parse::<f64>().is_ok(), "{cell} in {}", list.cells().csv());
        }
    }
}

/// Every kind of export has a disc of the same size: its volume and density give its mass.
#[test]
fn a_disc_is_as_thick_in_every_export() {
    let mut spec = builtin("serial-3r").expect("built in").spec().clone();
    let disc = |link: &str, mass, at, radius| Counterweight {
        link: link.into(),
        mass,
        at,
        across: 0.0,
        radius,
        ..Default::default()
    };
    spec.counterweights = vec![disc("1", 10.737, -0.12, 0.1204), disc("2", 0.105, -0.46, 0.0119)];
    let machine = &Machine::new(spec).expect("a machine");
    let weights = &machine.spec().counterweights;
    for cut in
        [Cut::default(), Cut { density: 2700.0, ..Cut::default() }, Cut { thickness: Some(0.05), ..Cut::default() }]
    {
        let models = [
            (mjcf(machine, None, &middle(machine), &cut).expect("a model"), "geom", 2.0),
            (urdf(machine, None, &cut), "cylinder", 1.0),
        ];
        for (model, tag, heights) in models {
            let document = roxmltree::Document::parse(&model).expect("XML");
            let numbers = |node: roxmltree::Node, key: &str| -> Vec<f64> {
                let words = node.attribute(key).unwrap_or_default().split(' ');
                words.filter_map(|word| word.parse().ok()).collect()
            };
            let mut discs: Vec<[f64; 2]> = Vec::new();
            for node in document.descendants().filter(|node| node.has_tag_name(tag)) {
                match (node.attribute("type"), tag) {
                    (Some("cylinder"), _) => {
                        let size = numbers(node, "size");
                        discs.push([size[0], heights * size[1]]);
                    }
                    (_, "cylinder") => discs.push([numbers(node, "radius")[0], numbers(node, "length")[0]]),
                    _ => {}
                }
            }
            assert_eq!(discs.len(), weights.len(), "{tag}");
            for weight in weights {
                let listed = cut.thickness_of(weight).expect("a disc");
                let near = |[radius, thickness]: &[f64; 2]| {
                    (radius - weight.radius).abs() < 1e-12 && (thickness - listed).abs() < 1e-12
                };
                assert!(discs.iter().any(near), "{tag}: {discs:?}, want {} by {listed}", weight.radius);
                let mass = cut.mass_of(weight, listed);
                assert_eq!((mass - weight.mass).abs() < 1e-12, cut.thickness.is_none(), "{mass}");
            }
        }
    }
}

/// The list has the pins and spacers of the solids, with their sizes.
#[cfg(feature = "cli")]
#[test]
fn pins_and_spacers_are_those_of_the_solids() {
    let mut spec = builtin("two-drive").expect("built in").spec().clone();
    for (link, height) in spec.links.iter_mut().zip([0.0, 0.007, 0.021, 0.007]) {
        link.axial = height;
    }
    let machine = Machine::new(spec).expect("a machine");
    let cut = Cut::default();
    let all = solids(&machine, &middle(&machine), &cut).expect("solids");
    let list = rows(&PartsList::of(&machine, &cut).expect("a list").cells().csv());
    let of = |kind: &str| list.iter().filter(|row| row["part"] == kind).collect::<Vec<_>>();
    let number =
        |row: &std::collections::HashMap<String, String>, name: &str| row[name].parse::<f64>().expect("a number");
    let listed = of("spacer");
    let cut_rings: Vec<_> = all.iter().filter(|solid| solid.name.starts_with("spacer")).collect();
    assert_eq!(listed.len(), cut_rings.len());
    assert!(listed.len() > 2);
    for (row, ring) in listed.iter().zip(cut_rings) {
        let [inner, outer] = ["inner diameter m", "outer diameter m"].map(|name| number(row, name));
        let length = number(row, "spacer length m");
        let volume = 0.25 * std::f64::consts::PI * (outer * outer - inner * inner) * length;
        assert!((volume - ring.volume()).abs() < 1e-9 * volume, "{}", ring.name);
        assert!((number(row, "to height m") - number(row, "from height m") - length).abs() < 1e-12);
    }
    for row in of("pin") {
        assert_eq!(number(row, "pin diameter m"), cut.pin_diameter);
        let length = number(row, "to height m") - number(row, "from height m");
        assert!((number(row, "pin length m") - length).abs() < 1e-12 && length > 0.0);
    }
}

/// A wall or a plate below 1 mm is remarked on; one of 1 mm is not.
#[test]
fn what_is_too_thin_is_told() {
    let ring = |wall: f64| Counterweight {
        link: "1".into(),
        mass: 0.5,
        at: -0.05,
        radius: 0.05,
        inner_radius: 0.05 - wall,
        ..Default::default()
    };
    let thick = Cut { thickness: Some(0.01), ..Cut::default() };
    assert!(too_thin(&[ring(0.002)], &thick).is_empty());
    let [told] = &too_thin(&[ring(0.0004)], &thick)[..] else { panic!("one remark") };
    assert_eq!(told, "the ring of 0.500 kg on link 1 has a wall of 0.40 mm: under 1.00 mm it is hard to make");
    let thin = Cut { thickness: Some(0.0005), ..Cut::default() };
    let [told] = &too_thin(&[ring(0.002)], &thin)[..] else { panic!("one remark") };
    assert!(told.contains("a thickness of 0.50 mm"), "{told}");
}
