//! Links made of parts: closed forms against integration, sums against sums by hand, files, keys, and what is refused.

use std::f64::consts::PI;

use stillbase::mechanics::counterweights::{
    CounterweightSite, CounterweightSpec, CounterweightStock, Objective, place_weights,
};
use stillbase::mechanics::machine::{
    FileError, Inertia, Lump, Machine, MachineError, MachineSpec, Part, PlaceOnLink, PlaneBody, builtins, parse,
    to_toml,
};
use stillbase::settings::change::typed;

use crate::support::Noise;

const ARM: &str = include_str!("parts.toml");

fn arm() -> Machine {
    parse(ARM, "parts.toml").expect("an arm")
}

/// The body of the only part of a link of 0.3 m, from the keys of the part.
fn only(part: &str) -> PlaneBody {
    one_link(part).unwrap_or_else(|why| panic!("{why}\n{part}")).part_bodies()[0].body
}

fn one_link(part: &str) -> Result<Machine, FileError> {
    let text = "name = \"one\"\ndrive = [{ name = \"1\" }]\nend_effector = { link = \"a\" }\n\
                material = [{ name = \"unit\", density = 1.0 }]\n[lengths]\nl = 0.2\n\
                [[link]]\nname = \"a\"\ndrive = \"1\"\nattach = \"base\"\nlength = 0.3\n";
    parse(&format!("{text}[[part]]\nlink = \"a\"\n{part}"), "one.toml")
}

fn near(found: f64, want: f64, tolerance: f64, what: &str) {
    assert!((found - want).abs() <= tolerance * want.abs().max(1e-12), "{what}: {found}, want {want}");
}

/// A body by summing squares of a fine grid: what is inside, and its density per area there.
fn by_grid(low: [f64; 2], high: [f64; 2], density: impl Fn(f64, f64) -> f64) -> PlaneBody {
    const CELLS: usize = 1500;
    let size = [0, 1].map(|i| (high[i] - low[i]) / CELLS as f64);
    let mut sums = [0.0; 4];
    for i in 0..CELLS {
        for j in 0..CELLS {
            let [x, y] = [low[0] + (i as f64 + 0.5) * size[0], low[1] + (j as f64 + 0.5) * size[1]];
            let mass = density(x, y) * size[0] * size[1];
            sums.iter_mut().zip([1.0, x, y, x * x + y * y]).for_each(|(sum, of)| *sum += mass * of);
        }
    }
    let [mass, x, y, second] = sums;
    let (at, across) = (x / mass, y / mass);
    PlaneBody { mass, at, across, inertia: second - mass * (at * at + across * across) }
}

fn alike(found: PlaneBody, want: PlaneBody, tolerance: f64, what: &str) {
    near(found.mass, want.mass, tolerance, &format!("mass of {what}"));
    near(found.inertia, want.inertia, tolerance, &format!("inertia of {what}"));
    assert!((found.at - want.at).abs() < 0.3 * tolerance, "{what}: {found:?}, want {want:?}");
    assert!((found.across - want.across).abs() < 0.3 * tolerance, "{what}: {found:?}, want {want:?}");
}

#[test]
fn closed_forms_are_what_a_grid_gives() {
    let hole = |x: f64, y: f64, [a, b, d]: [f64; 3]| (x - a).hypot(y - b) < 0.5 * d;
    // A bar with round ends off the axis, from the root back, with two holes.
    let flat = "shape = \"flat\"\nfrom = -0.05\nto = \"l\"\nacross = 0.02\nwidth = 0.06\nthickness = 0.004\n\
                holes = [{ at = 0.0, diameter = 0.03 }, { at = \"l\", across = 0.01, diameter = 0.02 }]\n";
    let grid = by_grid([-0.09, -0.02], [0.24, 0.06], |x, y| {
        let away = (x - x.clamp(-0.05, 0.2)).hypot(y - 0.02);
        let through = hole(x, y, [0.0, 0.02, 0.03]) || hole(x, y, [0.2, 0.03, 0.02]);
        if away <= 0.03 && !through { 2700.0 * 0.004 } else { 0.0 }
    });
    alike(only(flat), grid, 1e-3, "a flat bar");
    // A plate that is not convex, its corners clockwise, with a hole.
    let plate = "shape = \"plate\"\nmaterial = \"steel\"\nthickness = 0.003\nacross = 0.01\n\
                 polygon = [[0.0, 0.0], [0.1, 0.2], [0.3, 0.15], [0.15, 0.1], [0.25, -0.05]]\n\
                 holes = [{ at = 0.11, across = 0.12, diameter = 0.06 }]\n";
    let inside = |x: f64, y: f64| {
        // By angles: the corners turn once around what is inside.
        let corners = [[0.0, 0.01], [0.1, 0.21], [0.3, 0.16], [0.15, 0.11], [0.25, -0.04]];
        let angle = |[a, b]: [f64; 2]| (b - y).atan2(a - x);
        let turn: f64 =
            (0..5).map(|i| (angle(corners[(i + 1) % 5]) - angle(corners[i]) + PI).rem_euclid(2.0 * PI) - PI).sum();
        turn.abs() > 3.0 && !hole(x, y, [0.11, 0.13, 0.06])
    };
    let grid = by_grid([0.0, -0.05], [0.3, 0.22], |x, y| if inside(x, y) { 7850.0 * 0.003 } else { 0.0 });
    alike(only(plate), grid, 1e-3, "a plate");
    // Hollow bars: what lies above a point of the plane counts.
    let tube = "shape = \"tube\"\ndiameter = 0.05\nwall = 0.008\nmaterial = \"brass\"\n";
    let chord = |r: f64, y: f64| 2.0 * (r * r - y * y).max(0.0).sqrt();
    let grid = by_grid([0.0, -0.025], [0.3, 0.025], |_, y| 8500.0 * (chord(0.025, y) - chord(0.017, y)));
    alike(only(tube), grid, 1e-3, "a tube");
    let profile =
        "shape = \"profile\"\nfrom = \"tip\"\nto = 0.1\nwidth = 0.06\nheight = 0.03\nwall = 0.004\nacross = -0.1\n";
    let grid = by_grid([0.1, -0.13], [0.3, -0.07], |_, y| 2700.0 * if (y + 0.1).abs() < 0.026 { 0.008 } else { 0.03 });
    alike(only(profile), grid, 1e-3, "a profile");
}

#[test]
fn shapes_agree_with_one_another() {
    let tight = 1e-12;
    // A square-ended bar is a plate with four corners, whichever way round.
    let bar = only("shape = \"flat\"\nends = \"square\"\nfrom = 0.1\nwidth = 0.04\nthickness = 0.005\nacross = 0.03\n");
    for corners in
        ["[0.1, 0.01], [0.3, 0.01], [0.3, 0.05], [0.1, 0.05]", "[0.1, 0.05], [0.3, 0.05], [0.3, 0.01], [0.1, 0.01]"]
    {
        let plate = only(&format!("shape = \"plate\"\nthickness = 0.005\npolygon = [{corners}]\n"));
        alike(bar, plate, tight, "a rectangle");
    }
    // A full tube and a full profile are solid; a bar as long as nothing is a disc.
    let solid = only("shape = \"tube\"\ndiameter = 0.04\nwall = 0.02\nmaterial = \"unit\"\n");
    let volume = PI * 0.02 * 0.02 * 0.3;
    near(solid.mass, volume, tight, "a rod");
    near(solid.inertia, volume * (0.02 * 0.02 / 4.0 + 0.3 * 0.3 / 12.0), tight, "a rod");
    let solid = only("shape = \"profile\"\nwidth = 0.05\nheight = 0.02\nwall = 0.01\n");
    let flat = only("shape = \"flat\"\nends = \"square\"\nwidth = 0.05\nthickness = 0.02\n");
    alike(solid, flat, tight, "a solid profile");
    let disc = only("shape = \"flat\"\nfrom = 0.1\nto = 0.1\nwidth = 0.1\nthickness = 1.0\nmaterial = \"unit\"\n");
    near(disc.mass, PI * 0.0025, tight, "a disc");
    near(disc.inertia, PI * 0.05_f64.powi(4) / 2.0, tight, "a disc");
    // A ring: a disc with a hole.
    let ring = only(
        "shape = \"flat\"\nfrom = 0.1\nto = 0.1\nwidth = 0.1\nthickness = 1.0\nmaterial = \"unit\"\nholes = [{ at = 0.1, diameter = 0.06 }]\n",
    );
    near(ring.inertia, PI / 2.0 * (0.05_f64.powi(4) - 0.03_f64.powi(4)), tight, "a ring");
    // Far from the root nothing is lost.
    let far = only(
        "shape = \"plate\"\nthickness = 0.005\npolygon = [[1000.1, 0.01], [1000.3, 0.01], [1000.3, 0.05], [1000.1, 0.05]]\n",
    );
    near(far.inertia, bar.inertia, 1e-9, "a plate far away");
}

/// A machine whose links have random parts and lumps.
fn with_random_parts(noise: &mut Noise) -> Machine {
    let mut spec = arm().spec().clone();
    (spec.parts, spec.lumps) = (Vec::new(), Vec::new());
    let text = |part: String| toml::from_str::<Part>(&part).expect("a part");
    for link in ["upper", "fore"] {
        for _ in 0..1 + noise.between(0.0, 4.0) as usize {
            let [a, b, c] = [0, 1, 2].map(|_| noise.between(0.01, 0.2));
            let (across, wall) = (noise.between(-0.1, 0.1), noise.between(0.1, 0.5) * a.min(b));
            let shape = match noise.between(0.0, 4.0) as usize {
                0 => format!("shape = \"flat\"\nwidth = {a}\nthickness = {b}\nto = {c}\n"),
                1 => format!("shape = \"tube\"\ndiameter = {a}\nwall = {wall}\n"),
                2 => {
                    format!("shape = \"profile\"\nwidth = {a}\nheight = {b}\nwall = {wall}\nfrom = {c}\nto = {}\n", -c)
                }
                _ => format!("shape = \"plate\"\nthickness = {a}\npolygon = [[0.0, 0.0], [{b}, 0.0], [0.1, {c}]]\n"),
            };
            spec.parts.push(text(format!("link = \"{link}\"\nmaterial = \"pom\"\nacross = {across}\n{shape}")));
        }
        spec.lumps.push(Lump {
            link: link.into(),
            name: String::new(),
            mass: noise.between(0.01, 1.0),
            at: PlaceOnLink::Metres(noise.between(-0.2, 0.4)),
            across: noise.between(-0.1, 0.1),
            inertia: noise.between(0.0, 1e-3),
        });
    }
    Machine::new(spec).expect("a machine")
}

#[test]
fn links_are_the_sums_of_their_parts() {
    let mut noise = Noise::of(77);
    for _ in 0..50 {
        let machine = with_random_parts(&mut noise);
        for (j, link) in machine.spec().links.iter().enumerate() {
            let own: Vec<PlaneBody> =
                machine.part_bodies().iter().filter(|part| part.link == j).map(|part| part.body).collect();
            // By hand: sums about the root, then moved to the centre of mass.
            let sum = |of: &dyn Fn(&PlaneBody) -> f64| own.iter().map(of).sum::<f64>();
            let mass = sum(&|b| b.mass);
            let [x, y] = [sum(&|b| b.mass * b.at) / mass, sum(&|b| b.mass * b.across) / mass];
            let about_root = sum(&|b| b.inertia + b.mass * (b.at * b.at + b.across * b.across));
            near(link.mass, mass, 1e-12, "mass");
            near(link.com, x, 1e-11, "along");
            assert!((link.com_normal - y).abs() < 1e-13, "across: {} and {y}", link.com_normal);
            near(link.inertia, about_root - mass * (x * x + y * y), 1e-10, "inertia");
        }
        // What moves is a machine in which these values are typed.
        let mut plain = machine.spec().clone();
        (plain.parts, plain.lumps, plain.materials) = (Vec::new(), Vec::new(), Vec::new());
        for link in &mut plain.links {
            for number in stillbase::mechanics::machine::LinkNumber::ALL {
                link.type_number(number, Some(link.number(number)));
            }
        }
        let plain = Machine::new(plain).expect("a machine");
        assert_eq!(Inertia::of(&machine), Inertia::of(&plain));
        // Files hold all of it.
        let text = to_toml(&machine);
        let again = parse(&text, "again.toml").expect("its own file");
        assert_eq!((to_toml(&again), &again), (text, &machine));
    }
}

#[test]
fn a_bar_cut_in_two_is_the_same_link() {
    let mut noise = Noise::of(3);
    let at = |machine: &Machine| machine.parts_of_link(0).expect("parts");
    for _ in 0..40 {
        let [from, to] = [noise.between(-0.2, 0.1), noise.between(0.15, 0.5)];
        let [cut, across, width] = [noise.between(0.11, 0.14), noise.between(-0.1, 0.1), noise.between(0.001, 0.1)];
        let bar = |from: f64, to: f64| {
            format!(
                "shape = \"flat\"\nends = \"square\"\nfrom = {from}\nto = {to}\nacross = {across}\nwidth = {width}\n\
                 thickness = 0.005\n"
            )
        };
        let whole = at(&one_link(&bar(from, to)).expect("a bar"));
        let halves = format!("{}[[part]]\nlink = \"a\"\n{}", bar(from, cut), bar(cut, to));
        let halves = at(&one_link(&halves).expect("two bars"));
        alike(whole, halves, 1e-12, "a bar cut in two");
    }
}

#[test]
fn a_file_leaves_out_what_follows_and_keeps_what_is_typed() {
    let machine = arm();
    let text = to_toml(&machine);
    let links = &text[text.find("[[link]]").expect("links")..text.find("[[material]]").expect("materials")];
    assert!(!links.contains("mass") && !links.contains("inertia") && !links.contains("com"), "{links}");
    assert_eq!(to_toml(&parse(&text, "again.toml").expect("its own file")), text);
    // A typed number is the whole link's, lumps included, and stands in the file, 0 as well.
    let upper = machine.spec().links[0].clone();
    let heavy = machine.set("link.upper.mass", "2").expect("a mass").set("link.upper.com_normal", "0").expect("0");
    let own = &heavy.spec().links[0];
    assert_eq!((own.mass, own.com, own.com_normal, own.inertia), (2.0, upper.com, 0.0, upper.inertia));
    let text = to_toml(&heavy);
    assert!(text.contains("mass = 2.0") && text.contains("com_normal = 0.0"), "{text}");
    assert_eq!(parse(&text, "again.toml").expect("its own file"), heavy);
    // A change of a part leaves what is typed and moves what follows; then all follows again.
    let wide = heavy.set_all([("part.1.width", "0.05"), ("lump.1.mass", "0.5")]).expect("a part");
    let own = &wide.spec().links[0];
    assert!(own.mass == 2.0 && own.com_normal == 0.0 && own.com != upper.com && own.inertia > upper.inertia);
    let back = wide
        .set_all([("link.upper.mass", "default"), ("link.upper.com_normal", "none"), ("part.1.width", "0.03")])
        .and_then(|machine| machine.set("lump.1.mass", "0.42"))
        .expect("it follows");
    assert_eq!(back, machine);
}

#[test]
fn what_writes_a_number_types_it() {
    let mut spec = arm().spec().clone();
    spec.links[0].mass *= 1.01;
    let mass = spec.links[0].mass;
    let machine = Machine::new(spec).expect("a machine");
    assert_eq!(machine.spec().links[0].mass, mass);
    assert!(to_toml(&machine).contains(&format!("mass = {mass}")));
    // A link without parts is as it was.
    for machine in builtins() {
        assert!(machine.part_bodies().is_empty());
        assert_eq!(parse(&to_toml(machine), "again.toml").expect("its own file"), *machine);
    }
    let error = builtins()[0].set("link.1.mass", "default").expect_err("nothing gives it");
    assert!(matches!(error, MachineError::NoParts { .. }), "{error}");
    assert!(error.to_string().contains("[[lump]] of link \"1\""), "{error}");
    let on_axis = builtins()[0].set("link.1.com_normal", "0.1").and_then(|m| m.set("link.1.com_normal", "default"));
    assert_eq!(on_axis.expect("on the axis"), builtins()[0]);
}

#[test]
fn every_key_of_a_part_is_read_back_as_it_was_set() {
    let machine = arm();
    for (key, value) in [
        ("material.pom.density", "1500.0"),
        ("part.1.from", "-0.02"),
        ("part.1.to", "0.31"),
        ("part.1.across", "0.001"),
        ("part.1.width", "0.04"),
        ("part.2.thickness", "0.004"),
        ("part.4.diameter", "0.03"),
        ("part.4.wall", "0.001"),
        ("part.5.height", "0.05"),
        ("part.5.to", "tip"),
        ("lump.1.mass", "0.3"),
        ("lump.1.at", "root"),
        ("lump.1.across", "-0.01"),
        ("lump.1.inertia", "0.001"),
    ] {
        let was = typed(&machine.value(key).expect("a key"));
        let changed = machine.set(key, value).unwrap_or_else(|why| panic!("{key}: {why}"));
        assert_eq!(typed(&changed.value(key).expect("a key")), value, "{key}");
        assert_ne!(Inertia::of(&changed), Inertia::of(&machine), "{key}");
        assert_eq!(changed.set(key, &was).expect("it was so"), machine, "{key} back to {was}");
    }
    assert_eq!(machine.set("part.1.to", "0.31").and_then(|m| m.set("part.1.to", "default")).expect("the tip"), machine);
    for (key, value, words) in [
        ("part.9.width", "0.1", "want one of \"1\", \"2\""),
        ("part.1.wall", "0.001", "a flat bar has no wall: want width, thickness"),
        ("part.4.wall", "none", "a tube has a wall: want diameter, wall"),
        ("part.1.width", "0", "part[1].width) is 0: want 1e-6 to 1000000 m"),
        ("part.1.to", "elbow", "names the length \"elbow\""),
        ("lump.1.mass", "0", "lump[1].mass) is 0"),
        ("lump.1.at", "default", "a place along the link"),
        ("material.pom.density", "-1", "want 1 to 100000 kg/m³"),
        ("material.wood.density", "700", "want one of \"pom\""),
        ("part", "1", "a list of parts"),
    ] {
        let error = machine.set(key, value).expect_err(key).to_string();
        assert!(error.contains(words), "{key}={value}: {error}");
    }
}

#[test]
fn parts_follow_the_lengths_of_their_link() {
    let named = ARM.replacen("length = 0.3\n", "length = \"l\"\n", 1).replacen(
        "[[material]]",
        "[lengths]\nl = 0.3\n[[material]]",
        1,
    );
    let machine = parse(&named, "named.toml").expect("a named length");
    assert_eq!(machine.spec().links[0].mass, arm().spec().links[0].mass);
    let longer = machine.set("length.l", "0.4").expect("longer");
    let more = longer.spec().links[0].mass - machine.spec().links[0].mass;
    near(more, 2700.0 * 0.1 * 0.03 * 0.006, 1e-9, "what 0.1 m of bar weigh");
    near(longer.part_bodies()[5].body.at, 0.4, 1e-15, "the motor goes with the tip");
}

#[test]
fn designs_leave_lumps_where_they_are() {
    let machine = arm();
    // The motor sits off the axis, and so must what balances it.
    let sites = CounterweightSite::anywhere(&machine).into_iter().map(|site| CounterweightSite { across: 0.1, ..site });
    let spec = CounterweightSpec::least(Objective::mass(), sites.collect(), CounterweightStock::STEEL);
    let placed = place_weights(&machine, &spec).expect("counterweights").machine;
    let bodies = |spec: &MachineSpec| (spec.parts.clone(), spec.lumps.clone(), spec.links.clone());
    assert!(!placed.spec().counterweights.is_empty() && Inertia::of(&placed).is_balanced());
    assert_eq!(bodies(placed.spec()), bodies(machine.spec()));
    assert_eq!(placed.without_counterweights().expect("bare"), machine);
    let machine = machine.set("link.upper.com_normal", "0").expect("on the axis");
    let designed = stillbase::mechanics::balance::design(&machine, &[1.0, 1.0]).expect("balanced");
    assert_eq!(designed.spec().lumps, machine.spec().lumps);
    assert!(designed.spec().links[0].mass == machine.spec().links[0].mass && Inertia::of(&designed).is_balanced());
}

/// The error of the arm with a piece of its text replaced, which has to name the line of `line`.
fn refused(from: &str, to: &str, line: &str) -> String {
    let text = ARM.replacen(from, to, 1);
    assert_ne!(text, ARM, "{from}");
    let want = text[..text.find(line).unwrap_or_else(|| panic!("{line}"))].matches('\n').count() + 1;
    let error = parse(&text, "arm.toml").expect_err(to).to_string();
    assert!(error.starts_with(&format!("arm.toml:{want}: ")), "{to}: {error}, want line {want}");
    error
}

#[test]
fn what_is_wrong_with_a_part_is_told_with_its_line() {
    let flat = "width = 0.03\nthickness = 0.006\n";
    for (from, to, line, words) in [
        (
            "{ at = \"tip\", diameter = 0.008 }",
            "{ at = 0.32, diameter = 0.008 }",
            "holes =",
            "reaches 9 mm beyond the part",
        ),
        ("{ at = \"tip\", diameter = 0.008 }", "{ at = 0.005, diameter = 0.008 }", "holes =", "cuts into hole 1"),
        ("{ at = \"tip\", diameter = 0.008 }", "{ at = 0.1, diameter = 0.0 }", "holes =", "want 1e-6"),
        ("wall = 0.002", "wall = 0.011", "wall = 0.011", "want a wall of at most 0.01 m"),
        (
            "height = 0.02\nwall = 0.002",
            "height = 0.02\nwall = 0.02",
            "wall = 0.02\n",
            "the lesser of width and height",
        ),
        ("[0.16, 0.015], [0.13, 0.05]", "[0.16, 0.05], [0.16, 0.015], [0.1, 0.05]", "polygon =", "sides 1 and 3 meet"),
        ("[0.13, 0.05]", "[0.2, 0.015]", "polygon =", "meet"),
        (", [0.13, 0.05]", "", "polygon =", "at least three corners"),
        ("across = 0.025, diameter", "across = 0.048, diameter", "holes = [{ at = 0.13", "beyond the part"),
        ("material = \"pom\"", "material = \"wood\"", "material = \"wood\"", "or a [[material]] of this name"),
        (flat, "width = 0.03\n", "[[part]]", "a flat bar has a thickness: want width, thickness, in m"),
        (flat, "width = 0.03\nthickness = 0.006\nwall = 0.001\n", "wall = 0.001", "a flat bar has no wall"),
        (flat, "width = nan\nthickness = 0.006\n", "width = nan", "want a finite number"),
        (
            flat,
            "width = 0.03\nthickness = 0.006\npolygon = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]\n",
            "polygon =",
            "only a plate",
        ),
        ("thickness = 0.003\n", "thickness = 0.003\nfrom = 0.1\n", "from = 0.1", "neither from nor to"),
        ("diameter = 0.02\n", "diameter = 0.02\nto = \"root\"\n", "to = \"root\"", "want another place for to"),
        ("diameter = 0.02\n", "diameter = 0.02\nends = \"square\"\n", "ends = \"square\"\nwall", "a tube has no ends"),
        (
            "diameter = 0.02\n",
            "diameter = 0.02\nholes = [{ at = 0.1, diameter = 0.001 }]\n",
            "holes = [{ at = 0.1,",
            "a tube has no holes",
        ),
        (
            "link = \"fore\"\nshape = \"tube\"",
            "link = \"hand\"\nshape = \"tube\"",
            "link = \"hand\"",
            "the link \"hand\"",
        ),
        ("shape = \"tube\"", "shape = \"pipe\"", "shape = \"pipe\"", "tube"),
        ("name = \"pom\"", "name = \"steel\"", "name = \"steel\"", "taken"),
        ("density = 1410.0", "density = 0.0", "density = 0.0", "want 1 to 100000 kg/m³"),
        ("mass = 0.42", "mass = -0.42", "mass = -0.42", "want 1e-15"),
        ("at = 0.02\n", "at = \"elbow\"\n", "at = \"elbow\"", "names the length \"elbow\""),
        ("mass = 0.012\n", "", "[[lump]]\nlink = \"fore\"", "(lump[2].mass) is missing"),
    ] {
        let error = refused(from, to, line);
        assert!(error.contains(words), "{to}: {error}");
    }
    // A link without parts and without a mass.
    let end = ARM.find("[[part]]\nlink = \"fore\"").expect("parts");
    let text = format!("{}{}", &ARM[..end], &ARM[ARM.find("[end_effector]").expect("end")..]);
    let error = parse(&text, "arm.toml").expect_err("nothing gives a mass").to_string();
    assert!(error.contains("mass of link fore (link.fore.mass) is missing") && error.contains("[[part]]"), "{error}");
    let many = format!("{ARM}{}", "[[lump]]\nlink = \"fore\"\nmass = 1e-3\nat = 0.0\n".repeat(1000));
    assert!(parse(&many, "many.toml").expect_err("too many").to_string().contains("at most 1000"));
}
