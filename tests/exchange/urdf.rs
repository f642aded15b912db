//! URDF: read back by another reader, the tree is that of the machine, and what is added up along it too.

use std::collections::BTreeMap;

use roxmltree::{Document, Node};
use stillbase::exchange::cut::Cut;
use stillbase::exchange::urdf::{joint, urdf};
use stillbase::mechanics::machine::{Machine, builtin, builtins, parse, place_of, to_toml};
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Vector};

use crate::support::Noise;
use crate::support::random::{a_chain, a_machine};

/// A joint as the file has it.
struct Joint {
    name: String,
    parent: String,
    at: f64,
    /// What it follows, how often it turns for one turn of that; itself where it is driven, none where it is fixed.
    follows: Option<(String, f64)>,
}

fn element<'a>(node: Node<'a, 'a>, name: &str) -> Option<Node<'a, 'a>> {
    node.children().find(|child| child.has_tag_name(name))
}

fn number(text: &str) -> f64 {
    text.parse().unwrap_or_else(|_| panic!("{text} is no number"))
}

/// Joints by the link that they hold.
fn joints(document: &Document) -> BTreeMap<String, Joint> {
    let mut all = BTreeMap::new();
    for node in document.root_element().children().filter(|node| node.has_tag_name("joint")) {
        let link = |what| element(node, what).and_then(|e| e.attribute("link")).expect("a link").to_owned();
        let name = node.attribute("name").expect("a name").to_owned();
        let origin = element(node, "origin").and_then(|e| e.attribute("xyz")).expect("an origin");
        let places: Vec<f64> = origin.split(' ').map(number).collect();
        assert_eq!(places[1..], [0.0, 0.0], "{name}");
        let mimic = element(node, "mimic").map(|mimic| {
            let of = |what| mimic.attribute(what).expect("an attribute");
            assert_eq!(number(of("offset")), 0.0);
            (of("joint").to_owned(), number(of("multiplier")))
        });
        let follows = match node.attribute("type") {
            Some("fixed") => None,
            Some("continuous" | "revolute") => Some(mimic.unwrap_or((name.clone(), 1.0))),
            kind => panic!("{name}: {kind:?}"),
        };
        let joint = Joint { name, parent: link("parent"), at: places[0], follows };
        assert!(all.insert(link("child"), joint).is_none(), "a link hangs on one joint");
    }
    all
}

/// The direction of a link and its place, added up from the base.
fn frame(joints: &BTreeMap<String, Joint>, motors: &BTreeMap<String, f64>, link: &str) -> (f64, Vector) {
    let Some(joint) = joints.get(link) else {
        assert_eq!(link, "base");
        return (0.0, Vector::new(0.0, 0.0));
    };
    let (direction, place) = frame(joints, motors, &joint.parent);
    let turn = joint.follows.as_ref().map_or(0.0, |(driver, times)| {
        times * motors.get(driver).unwrap_or_else(|| panic!("{} follows {driver}, which no motor turns", joint.name))
    });
    (direction + turn, place + joint.at * Vector::from_polar(1.0, direction))
}

fn machines() -> Vec<Machine> {
    let mut noise = Noise::of(7);
    let mut machines: Vec<Machine> = builtins().to_vec();
    machines.extend((0..60).map(|_| a_machine(&mut noise)));
    machines.extend((0..16).map(|i| a_chain(&mut noise, 1 + i % 8)));
    machines
}

/// A tree in which each link, rotor and point stands once, and joints add up to absolute angles and places.
#[test]
fn joints_add_up_to_directions_and_places() {
    let mut noise = Noise::of(8);
    for machine in machines() {
        let text = urdf(&machine, None, &Cut::default());
        let document = Document::parse(&text).unwrap_or_else(|why| panic!("{why}\n{text}"));
        let joints = joints(&document);
        let links: Vec<&str> = document
            .root_element()
            .children()
            .filter(|node| node.has_tag_name("link"))
            .map(|node| node.attribute("name").expect("a name"))
            .collect();
        assert_eq!(links.len(), joints.len() + 1, "a tree");
        let once = |name: &str| assert_eq!(links.iter().filter(|own| **own == name).count(), 1, "{name}");
        once("base");
        for link in machine.links() {
            once(&format!("link_{}", link.name));
        }
        for drive in machine.spec().drives.iter().filter(|drive| drive.rotor.is_some()) {
            once(&format!("rotor_{}", drive.name));
        }
        for _ in 0..5 {
            let q = PerDrive::from_fn(machine.drives(), |_| noise.between(-4.0, 4.0));
            let (turns, e) = (machine.motors().to_motors(&q), DriveAngles(q).units());
            let motors = (0..machine.drives()).map(|k| (joint(&machine, k), turns[k])).collect();
            for (link, part) in machine.links().iter().zip(machine.resolved_links()) {
                let (direction, place) = frame(&joints, &motors, &format!("link_{}", link.name));
                assert!((direction - q[part.drive]).abs() < 1e-12, "{} {}", machine.name(), link.name);
                assert!((place - place_of(&part.root, &e)).norm() < 1e-12, "{} {}", machine.name(), link.name);
            }
            let (_, tip) = frame(&joints, &motors, "end_effector");
            assert!((tip - place_of(machine.end_effector(), &e)).norm() < 1e-12, "{}", machine.name());
        }
    }
}

/// A serial arm with a motor in each joint is what everybody writes: a joint for each link, and rotors.
#[test]
fn a_serial_arm_needs_nothing_between_its_links() {
    let text = urdf(builtin("scara").expect("built in"), None, &Cut::default());
    assert!(!text.contains("name=\"pin_") && !text.contains("name=\"shaft_"), "{text}");
    let document = Document::parse(&text).expect("XML");
    let elbow = document
        .descendants()
        .find(|node| node.has_tag_name("joint") && node.attribute("name") == Some("drive_2"))
        .expect("a joint");
    let limit = element(elbow, "limit").expect("limits");
    let of = |what| number(limit.attribute(what).expect("an attribute"));
    assert_eq!([of("lower"), of("upper"), of("effort")], [0.2, 2.7, 100.0]);
    let rotor = document.descendants().find(|node| node.attribute("name") == Some("joint_rotor_2")).expect("a joint");
    assert_eq!(element(rotor, "parent").and_then(|e| e.attribute("link")), Some("link_1"), "the stator sits there");
    assert_eq!(element(rotor, "mimic").and_then(|e| e.attribute("multiplier")), Some("50"));
}

/// What the format has no word for stands in an element that others pass over.
#[test]
fn what_urdf_cannot_say_stands_beside_it() {
    let machine = builtin("nine-link").expect("built in").set("gravity", "0,-9.81").expect("in range");
    let machine = machine.set("drive.2.jerk_limit", "900").expect("in range");
    let text = urdf(&machine, None, &Cut::default());
    let document = Document::parse(&text).expect("XML");
    let own = element(document.root_element(), "stillbase").expect("an element of its own");
    let count = |name: &str| own.children().filter(|node| node.has_tag_name(name)).count();
    assert_eq!((count("pin"), count("angle"), count("limit")), (machine.loops().len(), 2, 1), "{text}");
    let gravity = element(own, "gravity").expect("gravity");
    assert_eq!((gravity.attribute("x"), gravity.attribute("y")), (Some("0"), Some("-9.81")));
    let second = own.children().filter(|node| node.has_tag_name("angle")).nth(1).expect("a2");
    assert_eq!(["to", "from"].map(|what| second.attribute(what)), [Some("drive_3"), Some("drive_2")]);
}

/// Readers that build a tree from its root want what is followed before what follows, in the order of names or of the file.
#[test]
fn what_is_followed_comes_before_what_follows() {
    fn is_ordered(text: &str, by_name: bool) -> bool {
        let document = Document::parse(text).expect("XML");
        let mut all: Vec<Node> = document.root_element().children().filter(|node| node.has_tag_name("joint")).collect();
        if by_name {
            all.sort_by_key(|joint| joint.attribute("name").map(str::to_owned));
        }
        let link = |joint: &Node, what: &str| {
            let node = joint.children().find(|child| child.has_tag_name(what)).expect("an end");
            node.attribute("link").expect("a link").to_owned()
        };
        let (mut open, mut seen) = (vec!["base".to_owned()], Vec::new());
        while let Some(at) = open.pop() {
            // A joint is met when its child is.
            if let Some(joint) = all.iter().find(|joint| link(joint, "child") == at) {
                if let Some(mimic) = joint.children().find(|child| child.has_tag_name("mimic"))
                    && !seen.contains(&mimic.attribute("joint").expect("a joint").to_owned())
                {
                    return false;
                }
                seen.push(joint.attribute("name").expect("a name").to_owned());
            }
            let below = all.iter().rev().filter(|joint| link(joint, "parent") == at);
            open.extend(below.map(|joint| link(joint, "child")));
        }
        true
    }
    for machine in machines() {
        let text = urdf(&machine, None, &Cut::default());
        assert!(is_ordered(&text, true) && is_ordered(&text, false), "{}\n{text}", machine.name());
    }
}

#[test]
fn names_of_a_stranger_stay_in_their_place() {
    let text = to_toml(builtin("two-drive").expect("built in")).replace("link = \"2\"", "link = 'a--\"<&>->'");
    let text = text.replace("[[link]]\nname = \"2\"", "[[link]]\nname = 'a--\"<&>->'");
    let machine = parse(&text, "strange.toml").expect("a machine");
    let text = urdf(&machine, None, &Cut::default());
    let document = Document::parse(&text).unwrap_or_else(|why| panic!("{why}\n{text}"));
    assert!(document.descendants().any(|node| node.attribute("name") == Some("link_a--\"<&>->")));
}
