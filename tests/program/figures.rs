//! Figures fit for print: their numbers are those of the paper, the drawn curves pass through them, and the command in
//! each file writes it again.

use std::collections::BTreeMap;
use std::fs;
use std::io::Read;

use super::{stillbase_in, text};
use crate::folder::Folder;

const FIGURES: [&str; 6] = ["fig-3", "fig-4", "fig-5a", "fig-5b", "fig-5c", "table-1"];

fn draw(folder: &Folder, args: &[&str]) {
    let out = folder.run(args);
    assert!(out.status.success(), "{args:?}: {}", text(&out.stderr));
}

fn read(folder: &Folder, name: &str) -> String {
    fs::read_to_string(folder.path(name)).unwrap_or_else(|why| panic!("{name}: {why}"))
}

/// Rows of a table of numbers, below its lines and its head.
fn rows(csv: &str) -> Vec<Vec<String>> {
    let data: String = csv.lines().filter(|line| !line.starts_with('#')).map(|line| format!("{line}\n")).collect();
    let mut reader = csv::Reader::from_reader(data.as_bytes());
    reader.records().map(|row| row.expect("a row").iter().map(str::to_owned).collect()).collect()
}

/// The points of a curve.
type Points = Vec<[f64; 2]>;

/// The points of each curve with the names of its plot and of itself, in the order of the file.
fn curves(csv: &str) -> Vec<((String, String), Points)> {
    let mut all: Vec<((String, String), Points)> = Vec::new();
    for row in rows(csv) {
        let [plot, curve, x, y] = &row[..] else { panic!("{row:?}") };
        let point = [x, y].map(|x| x.parse().expect("a number"));
        let key = (plot.clone(), curve.clone());
        match all.last_mut().filter(|(known, _)| *known == key) {
            Some((_, points)) => points.push(point),
            None => all.push((key, vec![point])),
        }
    }
    all
}

fn range(points: impl Iterator<Item = f64>) -> [f64; 2] {
    points.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
}

fn close(what: &str, got: f64, want: f64, tolerance: f64) {
    assert!((got - want).abs() <= tolerance, "{what}: {got}, want {want}");
}

fn peak(csv: &str, curve: &str) -> f64 {
    let all = curves(csv);
    let (_, points) = all.iter().find(|((_, name), _)| name == curve).unwrap_or_else(|| panic!("{curve}"));
    points.iter().fold(0.0, |most, [_, y]| most.max(y.abs()))
}

/// Figures 3 to 5 and Table I of the paper's machine, each with the known answer of its equation.
#[test]
fn numbers_of_the_papers_figures_are_its_answers() {
    let folder = Folder::new("paper");
    draw(&folder, &["figures", "--paper", "all", "-o", "all"]);
    let csv = |name: &str| read(&folder, &format!("all/{name}.csv"));
    // Eq. (13): the b of A and B.
    let fig_3 = curves(&csv("fig-3"));
    for (point, [low, high]) in
        [("A (", [1.649_537_096_9, 2.901_299_106_1]), ("B (", [2.215_749_658_2, 2.661_072_721_1])]
    {
        let own = fig_3.iter().filter(|((_, name), _)| name.starts_with(point)).flat_map(|(_, points)| points);
        let [from, to] = range(own.map(|[b, _]| *b));
        close("least b", from, low, 1e-9);
        close("largest b", to, high, 1e-9);
    }
    // Eq. (16): both workspaces have one area, 2π l₅ (l₉ + λ₃ l₁)/Σλ, and are one turned by (5 − 2.4)/Σλ.
    let fig_4 = curves(&csv("fig-4"));
    assert_eq!(fig_4.len(), 2);
    for (_, points) in &fig_4 {
        let twice: f64 = points.windows(2).map(|p| p[0][0] * p[1][1] - p[1][0] * p[0][1]).sum();
        close("area", 0.5 * twice, 0.845_144_847_1, 2e-5);
    }
    // Fig. 5, Eq. (11) and n_B = −D₁ b̈: peaks of torques and of the base moment.
    close("case 1", peak(&csv("fig-5a"), "n_B"), 1.0891, 5e-5);
    close("case 2", peak(&csv("fig-5b"), "n_B"), 0.4853, 5e-5);
    let fig_5c = csv("fig-5c");
    close("case 3", peak(&fig_5c, "n_B"), 0.0, 1e-9);
    for (drive, torque) in [("τ₁", 1.42194), ("τ₂", 0.46385), ("τ₃", 0.95808)] {
        close(drive, peak(&fig_5c, drive), torque, 1e-5);
    }
    // Table I leaves 2.5e-4 kg m of Eq. (7) and 2.25e-5 kg m² of Eq. (8) as printed, nothing when solved again.
    let mut left: BTreeMap<&str, [f64; 2]> = BTreeMap::new();
    let table = rows(&csv("table-1"));
    for row in table.iter().filter(|row| row[0].starts_with("Eq.")) {
        let most = left.entry(&row[0][..7]).or_default();
        let number = |cell: &String| cell.parse::<f64>().expect("a number").abs();
        *most = [most[0].max(number(&row[4])), most[1].max(number(&row[5]))];
    }
    close("Eq. (7)", left["Eq. (7)"][0], 2.5e-4, 5e-6);
    close("Eq. (8)", left["Eq. (8)"][0], 2.25e-5, 1e-10);
    assert!(left.values().all(|[_, again]| *again < 1e-12), "{left:?}");
    assert_eq!(table[0][..6], ["1", "0.5", "7", "0.2501", "-0.2214", table[0][5].as_str()]);
}

/// The command in a table of numbers.
fn made(csv: &str) -> &str {
    csv.lines().find_map(|line| line.strip_prefix("# Made by: ")).expect("a command")
}

/// Settings change every figure that depends on them, and the command of a figure names no others.
#[test]
fn settings_reach_every_figure_of_the_paper() {
    let folder = Folder::new("settings");
    draw(&folder, &["figures", "--paper", "all", "-o", "plain"]);
    let all = ["--set", "length.l1=0.6", "--set", "limits.a1=0.4,2.9", "--set", "plant.payload.mass=0.1"];
    draw(&folder, &[&["figures", "--paper", "all", "-o", "changed", "--time", "2"][..], &all].concat());
    for name in FIGURES {
        let [plain, changed] = ["plain", "changed"].map(|from| read(&folder, &format!("{from}/{name}.csv")));
        assert_ne!(rows(&plain), rows(&changed), "{name}");
        let command = made(&changed);
        let is_motion = name.starts_with("fig-5");
        for (option, is_used) in [
            ("--set length.l1=0.6", true),
            ("--set limits.a1=0.4,2.9", name != "table-1"),
            ("--set plant.payload.mass=0.1", is_motion),
            ("--time 2", is_motion),
        ] {
            assert_eq!(command.contains(option), is_used, "{name}: {command}");
        }
        let other = Folder::new("settings");
        draw(&other, &command.split(' ').skip(1).collect::<Vec<_>>());
        assert_eq!(read(&other, &format!("{name}.csv")), changed, "{command}");
    }
    // Each setting by itself, with what it changes by the equation of the figure.
    draw(&folder, &["figures", "--paper", "table-1", "-o", "com", "--set", "link.5.com=0"]);
    let table = rows(&read(&folder, "com/table-1.csv"));
    let fifth = table.iter().find(|row| row[0] == "5").expect("link 5");
    assert_eq!(fifth[4..], ["0", "0"], "both columns");
    // Eq. (7) with the mass of link 5 moved to its root.
    let plain = rows(&read(&folder, "plain/table-1.csv"));
    let [mass, com]: [f64; 2] = {
        let own = plain.iter().find(|row| row[0] == "5").expect("link 5");
        [&own[2], &own[5]].map(|cell| cell.parse().expect("a number"))
    };
    let left = table.iter().filter(|row| row[0].starts_with("Eq. (7)")).map(|row| row[5].parse::<f64>().expect("left"));
    let most = left.fold(0.0, |most: f64, x| most.max(x.abs()));
    close("Eq. (7)", most, (mass * com).abs(), 1e-12);
}

/// The vertices of a path of straight lines.
fn vertices(path: &str) -> Vec<[f64; 2]> {
    let pairs = path.trim_end_matches('Z').split(['M', 'L']).filter(|part| !part.is_empty());
    pairs
        .map(|pair| {
            let (x, y) = pair.split_once(' ').expect("two numbers");
            [x, y].map(|x| x.parse().expect("a number"))
        })
        .collect()
}

fn distance(at: [f64; 2], from: [f64; 2], to: [f64; 2]) -> f64 {
    let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    let along = ((at[0] - from[0]) * dx + (at[1] - from[1]) * dy) / (dx * dx + dy * dy).max(1e-12);
    let along = along.clamp(0.0, 1.0);
    (at[0] - from[0] - along * dx).hypot(at[1] - from[1] - along * dy)
}

/// Each clipped line of the drawing is a curve of the table, in the same order; one scale for each axis puts every row
/// on it, to 1/50 mm.
#[test]
fn drawn_curves_pass_through_their_numbers() {
    let folder = Folder::new("curves");
    draw(&folder, &["figures", "--paper", "all", "-o", "all"]);
    draw(&folder, &["figures", "case-1", "--what", "torque,moment,workspace,snapshots", "-o", "all/run.svg"]);
    for name in FIGURES.into_iter().filter(|name| *name != "table-1").chain(["run"]) {
        let (drawing, table) = (read(&folder, &format!("all/{name}.svg")), read(&folder, &format!("all/{name}.csv")));
        let drawing = roxmltree::Document::parse(&drawing).unwrap_or_else(|why| panic!("{name}: {why}"));
        assert!(drawing.descendants().all(|node| node.tag_name().name() != "text"), "{name}: letters are outlines");
        let width = drawing.root_element().attribute("width");
        assert_eq!(width, Some("85mm"), "{name}");
        let is_curve =
            |node: &roxmltree::Node<'_, '_>| node.attribute("clip-path").is_some() && node.has_attribute("stroke");
        let lines: Vec<_> = drawing.descendants().filter(is_curve).collect();
        let curves = curves(&table);
        assert_eq!(lines.len(), curves.len(), "{name}");
        let mut of_plot: BTreeMap<&str, Vec<(&Points, Points)>> = BTreeMap::new();
        for (line, ((plot, _), points)) in lines.iter().zip(&curves) {
            let mut drawn = vertices(line.attribute("d").expect("a path"));
            if line.attribute("d").is_some_and(|path| path.ends_with('Z')) {
                drawn.push(drawn[0]);
            }
            of_plot.entry(plot).or_default().push((points, drawn));
        }
        for (plot, pairs) in of_plot {
            // The scale of each axis follows from the extremes of all curves.
            let scale = |i: usize| {
                let own = range(pairs.iter().flat_map(|(points, _)| points.iter().map(|p| p[i])));
                let drawn = range(pairs.iter().flat_map(|(_, drawn)| drawn.iter().map(|p| p[i])));
                let [from, to] = if i == 0 { drawn } else { [drawn[1], drawn[0]] };
                move |x: f64| from + (x - own[0]) / (own[1] - own[0]).max(1e-300) * (to - from)
            };
            let (across, up) = (scale(0), scale(1));
            for (points, drawn) in &pairs {
                for [x, y] in *points {
                    let at = [across(*x), up(*y)];
                    let off = drawn.windows(2).map(|ends| distance(at, ends[0], ends[1])).fold(f64::INFINITY, f64::min);
                    assert!(off < 0.06, "{name}, {plot}: ({x}, {y}) is {off} points off its line");
                }
            }
        }
    }
}

/// The command that a file names writes the same bytes in another folder.
#[test]
fn the_command_in_a_figure_writes_it_again() {
    let folder = Folder::new("again");
    let wanted = ["--machine", "nine-link-geared", "--point", "0.6,0.5", "--point", "0.5,0.8", "--time", "2"];
    draw(&folder, &[&["figures", "--paper", "fig-5c", "-o", ".", "--width", "120"][..], &wanted].concat());
    draw(&folder, &["figures", "--paper", "fig-3"]);
    let run = ["figures", "case-2", "--what", "linkage,torque", "--at", "0.5", "-o", "run.svg"];
    draw(&folder, &[&run[..], &["--set", "plant.payload.mass=0.1"]].concat());
    for name in ["fig-5c.svg", "fig-3.svg", "run.svg"] {
        let drawing = read(&folder, name);
        let page = roxmltree::Document::parse(&drawing).expect("an SVG");
        let made = page.descendants().find(|node| node.has_tag_name("desc")).and_then(|node| node.text());
        let command = made.and_then(|made| made.strip_prefix("Made by: stillbase ")).expect("a command").to_owned();
        assert!(read(&folder, &name.replace(".svg", ".csv")).contains(&command), "{name}: {command}");
        let other = Folder::new("again");
        let words: Vec<&str> = command.split(' ').collect();
        let out = stillbase_in(&other.0, &words);
        assert!(out.status.success(), "{command}: {}", text(&out.stderr));
        for file in other.names() {
            let bytes = |folder: &Folder| fs::read(folder.path(&file)).expect("a file");
            assert!(bytes(&folder) == bytes(&other), "{command}: {file} differs");
        }
    }
}

/// Parts stand one below the other in the order in which they are asked for.
#[test]
fn parts_of_a_run_stand_in_order() {
    let folder = Folder::new("order");
    let orders = ["linkage,torque,workspace", "torque,workspace,linkage", "torque,linkage,workspace"];
    let clips = orders.map(|order| {
        draw(&folder, &["figures", "case-1", "--what", order, "-o", "run.svg", "--force"]);
        let drawing = read(&folder, "run.svg");
        let page = roxmltree::Document::parse(&drawing).expect("an SVG");
        let number = |node: &roxmltree::Node<'_, '_>, name: &str| -> f64 {
            node.attribute(name).expect(name).parse().expect("a number")
        };
        // Each part clips its curves to its axes; those of the drawing are the widest.
        let mut clips: Vec<(f64, f64)> = Vec::new();
        for rect in page.descendants().filter(|node| node.has_tag_name("rect")) {
            clips.push((number(&rect, "y"), number(&rect, "width")));
        }
        clips.sort_by(|a, b| a.0.total_cmp(&b.0));
        let widest = clips.iter().fold(0.0_f64, |most, (_, width)| most.max(*width));
        let place = clips.iter().position(|(_, width)| *width == widest).expect("the drawing");
        (clips.len(), place)
    });
    assert_eq!(clips, [(3, 0), (3, 2), (3, 1)]);
}

/// An outline with how it is painted: the operator of PDF, colour, width of a line and dashes.
#[derive(Debug, PartialEq)]
struct Outline {
    places: Vec<f64>,
    operator: String,
    colour: [u8; 3],
    width: Option<f64>,
    dash: Option<[f64; 2]>,
    is_clipped: bool,
}

/// Outlines of an SVG in order of painting.
fn outlines_of_svg(drawing: &str) -> Vec<Outline> {
    let page = roxmltree::Document::parse(drawing).expect("an SVG");
    let outline = |node: roxmltree::Node<'_, '_>| {
        let number = |name: &str| node.attribute(name).map(|x| x.parse().expect("a number"));
        let path = node.attribute("d").expect("a path");
        let words = path.split(|c: char| c.is_ascii_alphabetic() || c == ' ').filter(|word| !word.is_empty());
        let is_line = node.has_attribute("stroke");
        let tone = node.attribute(if is_line { "stroke" } else { "fill" }).expect("a colour");
        let channel = |i: usize| u8::from_str_radix(&tone[2 * i + 1..2 * i + 3], 16).expect("a colour");
        let operator = match (is_line, node.has_attribute("fill-rule")) {
            (true, _) => "S",
            (false, true) => "f*",
            (false, false) => "f",
        };
        Outline {
            places: words.map(|x| x.parse().expect("a number")).collect(),
            operator: operator.into(),
            colour: [0, 1, 2].map(channel),
            width: number("stroke-width"),
            dash: node.attribute("stroke-dasharray").map(|lengths| {
                let (on, off) = lengths.split_once(' ').expect("two lengths");
                [on, off].map(|x| x.parse().expect("a number"))
            }),
            is_clipped: node.has_attribute("clip-path"),
        }
    };
    page.descendants().filter(|node| node.has_tag_name("path")).map(outline).collect()
}

/// Outlines of the content of a PDF in order of painting, with its transformation.
fn outlines_of_pdf(content: &str) -> (Vec<f64>, Vec<Outline>) {
    let (mut outlines, mut numbers, mut places): (Vec<Outline>, Vec<f64>, Vec<f64>) = Default::default();
    let (mut placed, mut colour, mut width, mut dash, mut is_clipped) = (Vec::new(), [0; 3], None, None, false);
    for word in content.split_whitespace() {
        let word = word.trim_matches(['[', ']']);
        if let Ok(x) = word.parse::<f64>() {
            numbers.push(x);
            continue;
        }
        let own = std::mem::take(&mut numbers);
        match word {
            "cm" => placed = own,
            "q" => (width, dash, is_clipped) = (None, None, false),
            "RG" | "rg" => colour = [0, 1, 2].map(|i| (255.0 * own[i]).round() as u8),
            "w" => width = Some(own[0]),
            "d" => dash = Some([own[0], own[1]]),
            "W" => is_clipped = true,
            "m" | "l" | "c" => places.extend(own),
            "S" | "f" | "f*" => {
                let (places, operator) = (std::mem::take(&mut places), word.into());
                outlines.push(Outline { places, operator, colour, width, dash, is_clipped });
            }
            _ => {}
        }
    }
    (placed, outlines)
}

/// Each object of a PDF begins where its table says; its title and its command are there; and it paints the outlines of
/// the SVG in the same order, colours, widths and dashes, to the decimals of the SVG, on a sheet of the same size.
#[test]
fn a_pdf_paints_what_the_svg_does() {
    let folder = Folder::new("pdf");
    draw(&folder, &["figures", "--paper", "all", "-o", "all"]);
    for ending in ["pdf", "svg"] {
        draw(
            &folder,
            &["figures", "case-3", "--what", "torque,linkage", "-o", &format!("all/run.{ending}"), "--force"],
        );
        let view = format!("all/view.{ending}");
        draw(&folder, &["render", "case-3", "-o", &view, "--theme", "light", "--transparent", "--plots"]);
    }
    for name in FIGURES.into_iter().chain(["run", "view"]) {
        let bytes = fs::read(folder.path(&format!("all/{name}.pdf"))).expect("a file");
        let words = String::from_utf8_lossy(&bytes);
        assert!(words.starts_with("%PDF-1.") && words.trim_end().ends_with("%%EOF"), "{name}");
        let from: usize = words
            .rsplit("startxref")
            .next()
            .and_then(|at| at.split_whitespace().next())
            .expect("a place")
            .parse()
            .expect("a number");
        let table = text(&bytes[from..]);
        let mut lines = table.lines();
        assert_eq!(lines.next(), Some("xref"), "{name}");
        let (_, count) = lines.next().and_then(|head| head.split_once(' ')).expect("a head");
        let places: Vec<&str> = lines.take(count.trim().parse().expect("a number")).collect();
        assert!(places.len() > 5, "{name}");
        let object = |i: usize| -> usize { places[i].split(' ').next().expect("a place").parse().expect("a number") };
        for (i, _) in places.iter().enumerate().filter(|(_, place)| place.contains(" n")) {
            assert!(bytes[object(i)..].starts_with(format!("{i} 0 obj").as_bytes()), "{name}: object {i}");
        }
        assert!(words.contains("/FlateDecode") && words.contains("/Subject"), "{name}");
        let content = &bytes[object(4)..];
        let begin = content.windows(7).position(|part| part == b"stream\n").expect("a stream") + 7;
        let mut unpacked = String::new();
        let unpacking = flate2::read::ZlibDecoder::new(&content[begin..]).read_to_string(&mut unpacked);
        unpacking.unwrap_or_else(|why| panic!("{name}: {why}"));
        let (placed, painted) = outlines_of_pdf(&unpacked);
        let drawing = read(&folder, &format!("all/{name}.svg"));
        let drawn = outlines_of_svg(&drawing);
        assert_eq!(painted.len(), drawn.len(), "{name}");
        assert!(drawn.len() > 20, "{name}");
        for (i, (own, other)) in painted.iter().zip(&drawn).enumerate() {
            let is_near = |a: &f64, b: &f64| (a - b).abs() < 0.006;
            let same = own.places.len() == other.places.len()
                && own.places.iter().zip(&other.places).all(|(a, b)| is_near(a, b))
                && (&own.operator, own.is_clipped) == (&other.operator, other.is_clipped)
                && own.colour.iter().zip(&other.colour).all(|(a, b)| a.abs_diff(*b) <= 1)
                && own.width.zip(other.width).is_none_or(|(a, b)| is_near(&a, &b))
                && own.width.is_some() == other.width.is_some()
                && own.dash.is_some() == other.dash.is_some()
                && own.dash.zip(other.dash).is_none_or(|(a, b)| is_near(&a[0], &b[0]) && is_near(&a[1], &b[1]));
            assert!(same, "{name}, outline {i}: {own:?}, in the SVG {other:?}");
        }
        // The sheet: y upwards from its lower edge, in points of 1/72 inch, as large as the SVG in mm.
        let page = roxmltree::Document::parse(&drawing).expect("an SVG");
        let mm = |name: &str| -> f64 {
            let side = page.root_element().attribute(name).and_then(|side| side.strip_suffix("mm")).expect("a length");
            side.parse().expect("a number")
        };
        let (_, sheet) = words.split_once("/MediaBox [").expect("a sheet");
        let sheet: Vec<f64> =
            sheet[..sheet.find(']').expect("an end")].split(' ').map(|x| x.parse().expect("a number")).collect();
        for (side, name) in sheet[2..].iter().zip(["width", "height"]) {
            close(name, side * 25.4 / 72.0, mm(name), 2e-3);
        }
        let [scale, _, _, up, _, above] = placed[..] else { panic!("{name}: {placed:?}") };
        let view: Vec<f64> = page
            .root_element()
            .attribute("viewBox")
            .map(|sides| sides.split(' ').map(|x| x.parse().expect("a number")).collect())
            .expect("a view");
        close("scale", scale * view[2], sheet[2], 2e-3);
        close("upwards", -up, scale, 1e-6);
        close("height", above, sheet[3], 1e-3);
    }
}

/// A letter that the font lacks is drawn as a box, and named.
#[test]
fn letters_that_the_font_lacks_are_boxes() {
    let folder = Folder::new("letters");
    let machine = include_str!("../../assets/machines/two-drive.toml");
    let named = |name: &str| machine.replace("\"3\"", &format!("\"{name}\""));
    folder.file("foreign.toml", named("日本"));
    folder.file("known.toml", named("Ärmel"));
    let table = |file: &str| {
        let out = folder.run(&["figures", "--paper", "table-1", "--machine", file, "--force"]);
        let said = text(&out.stderr).to_owned();
        assert!(out.status.success(), "{said}");
        (read(&folder, "table-1.svg"), said)
    };
    let (drawing, said) = table("foreign.toml");
    assert!(said.contains("note: the font of pictures lacks 日 本: boxes stand in their places"), "{said}");
    let page = roxmltree::Document::parse(&drawing).expect("an SVG");
    let cell = page.descendants().find(|node| node.attribute("aria-label") == Some("日本")).expect("its cell");
    // Two boxes, each with an outer and an inner line.
    let outlines = cell.attribute("d").expect("a path").matches('M').count();
    assert!(outlines >= 4, "{outlines}");
    let (_, said) = table("known.toml");
    assert!(!said.contains("lacks"), "{said}");
}

/// The axis of a small magnitude begins at zero: in the drawing, its curve is in the lower part of the axes.
#[test]
fn small_magnitudes_stand_on_zero() {
    let folder = Folder::new("magnitudes");
    draw(&folder, &["figures", "space-arm", "--what", "pin", "-o", "pin.svg"]);
    let most = peak(&read(&folder, "pin.csv"), "F worst");
    assert!((0.05..0.5).contains(&most), "{most} N: below half of the least range of 1 N");
    let drawing = read(&folder, "pin.svg");
    let page = roxmltree::Document::parse(&drawing).expect("an SVG");
    let labels: Vec<&str> = page.descendants().filter_map(|node| node.attribute("aria-label")).collect();
    assert!(labels.contains(&"0.0") && !labels.iter().any(|label| label.starts_with('−')), "{labels:?}");
}

/// No outline passes the edges of a narrow page.
#[test]
fn nothing_is_cut_off_in_a_narrow_figure() {
    let folder = Folder::new("narrow");
    draw(&folder, &["figures", "case-1", "--what", "torque,force,snapshots,workspace", "-o", "a.svg", "--width", "40"]);
    draw(&folder, &["figures", "--paper", "all", "--width", "40"]);
    for name in FIGURES.into_iter().chain(["a"]) {
        let drawing = read(&folder, &format!("{name}.svg"));
        let page = roxmltree::Document::parse(&drawing).expect("an SVG");
        let view = page.root_element().attribute("viewBox").expect("a view");
        let view: Vec<f64> = view.split(' ').map(|x| x.parse().expect("a number")).collect();
        for outline in outlines_of_svg(&drawing).iter().filter(|outline| !outline.is_clipped) {
            let across = range(outline.places.iter().step_by(2).copied());
            let down = range(outline.places.iter().skip(1).step_by(2).copied());
            let is_inside = across[0] > -0.5 && across[1] < view[2] + 0.5 && down[0] > -0.5 && down[1] < view[3] + 0.5;
            assert!(is_inside, "{name}: {across:?} {down:?} on {view:?}");
        }
    }
}

/// A scenario without a title is called by its name.
#[test]
fn a_title_does_not_end_in_a_colon() {
    let folder = Folder::new("title");
    let scenario = include_str!("../../assets/scenarios/case-3.toml");
    let untitled: Vec<&str> = scenario.lines().filter(|line| !line.starts_with("title")).collect();
    folder.file("own.toml", untitled.join("\n"));
    draw(&folder, &["figures", "own.toml", "--what", "torque", "-o", "a.svg"]);
    draw(&folder, &["render", "own.toml", "-o", "b.svg"]);
    assert_eq!(read(&folder, "a.csv").lines().next(), Some("# case-3"));
    for name in ["a.svg", "b.svg"] {
        assert!(read(&folder, name).contains("<title>case-3</title>"), "{name}");
    }
}

/// Names within one drawing differ from those of another, since both may stand in one page of the web.
#[test]
fn names_in_drawings_do_not_clash() {
    let folder = Folder::new("names");
    draw(&folder, &["figures", "--paper", "all"]);
    draw(&folder, &["figures", "case-1", "--what", "torque,moment", "-o", "run.svg"]);
    let mut known: BTreeMap<String, String> = BTreeMap::new();
    for name in FIGURES.into_iter().chain(["run"]) {
        let drawing = read(&folder, &format!("{name}.svg"));
        let page = roxmltree::Document::parse(&drawing).expect("an SVG");
        let ids: Vec<&str> = page.descendants().filter_map(|node| node.attribute("id")).collect();
        assert_eq!(ids.is_empty(), name == "table-1", "{name}");
        for id in &ids {
            if let Some(other) = known.insert((*id).to_owned(), name.to_owned()) {
                panic!("{id} is in {other} and in {name}");
            }
        }
        // Each name that is used is its own.
        for used in page.descendants().filter_map(|node| node.attribute("clip-path")) {
            let id = used.strip_prefix("url(#").and_then(|id| id.strip_suffix(')'));
            assert!(id.is_some_and(|id| ids.contains(&id)), "{name}: {used}");
        }
    }
}

/// Wrong requests name what would be right, and leave no file.
#[test]
fn wrong_figures_are_refused() {
    let folder = Folder::new("refused");
    folder.file("fig-4.csv", "mine");
    for (args, why) in [
        (&["figures", "--paper", "fig-4"][..], "fig-4.csv exists"),
        (&["figures", "--paper", "fig-6"], "fig-5a"),
        (&["figures", "--paper", "fig-3", "-o", "none/none"], "none"),
        (&["figures", "--paper", "fig-3", "--point", "0.5,0.5"], "1 point: want A and B"),
        (&["figures", "--paper", "fig-3", "--point", "9,9", "--point", "0.5,0.5"], "9"),
        (&["figures", "--paper", "fig-3", "--machine", "two-drive"], "three"),
        (&["figures", "--paper", "fig-3", "--width", "10"], "40 to 400"),
        (&["figures", "--paper", "fig-5a", "--b", "40"], "b"),
        (&["figures", "--paper", "all"], "fig-4.csv exists"),
        (&["figures", "--paper", "table-1", "--set", "limits.a1=0,2"], "--paper fig-3 or fig-4 or fig-5a"),
        (&["figures", "--paper", "fig-3", "--set", "task.time=2"], "--paper fig-5a or fig-5b or fig-5c"),
        (&["figures", "--paper", "fig-5a", "--set", "tolerance.seed=3"], "--set tolerance.seed has no use here"),
        (&["figures", "--paper", "all", "--set", "gravityy=0,1"], "no setting gravityy"),
        (&["figures", "--paper", "fig-4", "--time", "2"], "--paper fig-5a or fig-5b or fig-5c"),
        (&["figures", "--paper", "fig-4", "--point", "0.5,0.5", "--point", "0.4,0.5"], "--point has no use here"),
        (&["figures", "--paper", "fig-3", "--b", "2", "--b", "3"], "a second --b has no use here: want --paper fig-4"),
        (&["figures", "--paper", "table-1", "--b", "2"], "--b has no use here: want --paper fig-3 or fig-4"),
        (&["figures", "case-3", "--what", "torque", "-o", "a.png"], ".svg or .pdf"),
        (&["figures", "case-3", "--what", "torque,snapshots", "--at", "0.5", "-o", "a.svg"], "want --what linkage"),
        (&["figures", "case-3", "--what", "torque", "-o", "fig-4.svg"], "fig-4.csv exists"),
        (&["figures", "case-3", "--what", "torque"], "--output"),
        (&["figures", "case-3", "--what", "friction", "-o", "a.svg"], "this run has no friction"),
        (&["figures", "case-3", "--what", "linkage", "--at", "9", "-o", "a.svg"], "within the run, 0 to 1.000 s"),
        (&["figures", "--what", "torque", "-o", "a.svg"], "SCENARIO"),
        (&["figures", "window", "--width", "90"], "want --paper or --what"),
        (&["render", "case-3", "-o", "a.svg", "--view", "space"], "view from above"),
        (&["render", "case-3", "-o", "a.svg", "--view", "window"], "view from above"),
        (&["render", "case-3", "-o", "a.pdf", "--view", "joints"], "view from above alone"),
        (&["render", "case-3", "-o", "a.svg", "--film"], ".gif, .png, .webp or .mp4"),
        (
            &["render", "case-3", "-o", "a.mp4", "--film", "--transparent"],
            "no transparency: want .gif, .png, .webp, or a folder",
        ),
        (&["render", "case-3", "-o", "a.gif", "--film", "--transparent", "--view", "window"], "no background"),
        (&["render", "case-3", "-o", "a.bmp"], ".png or .webp or .svg or .pdf"),
        (&["render", "case-3", "-o", "a.svg", "--plots", "--view", "window"], "own plots"),
    ] {
        let out = folder.run(args);
        assert!(!out.status.success() && text(&out.stderr).contains(why), "{args:?}: {}", text(&out.stderr));
        assert_eq!(folder.names(), ["fig-4.csv"], "{args:?}");
    }
    assert_eq!(read(&folder, "fig-4.csv"), "mine");
}

/// Every built-in machine that has a workspace of constant b has a Fig. 4 and a drawing.
#[test]
fn every_machine_is_drawn() {
    let folder = Folder::new("machines");
    let out = folder.run(&["machines", "--json"]);
    let machines: serde_json::Value = serde_json::from_slice(&out.stdout).expect("JSON");
    let mut with_workspace = 0;
    for machine in machines["machines"].as_array().expect("machines") {
        let name = machine["name"].as_str().expect("a name");
        let file = format!("{name}.svg");
        draw(&folder, &["figures", name, "--what", "linkage,torque,snapshots", "-o", &file]);
        draw(&folder, &["figures", "--paper", "table-1", "--machine", name, "-o", ".", "--force"]);
        let drawing = read(&folder, &file);
        roxmltree::Document::parse(&drawing).unwrap_or_else(|why| panic!("{name}: {why}"));
        assert!(!drawing.contains("NaN") && !drawing.contains("inf"), "{name}");
        let out = folder.run(&["figures", "--paper", "fig-4", "--machine", name, "--b", "1", "-o", ".", "--force"]);
        with_workspace += usize::from(out.status.success());
        assert!(!text(&out.stderr).contains("panicked"), "{name}: {}", text(&out.stderr));
    }
    assert!(with_workspace >= 6, "{with_workspace}");
}

/// A view as outlines has the size that is asked for, and nothing behind it if that is asked for.
#[test]
fn a_view_is_drawn_as_outlines() {
    let folder = Folder::new("outlines");
    let render = |file: &str, more: &[&str]| {
        draw(&folder, &[&["render", "case-3", "-o", file, "--at", "0.5", "--size", "900x600"][..], more].concat());
        read(&folder, file)
    };
    let (plain, clear) = (render("plain.svg", &[]), render("clear.svg", &["--transparent"]));
    let plots = render("plots.svg", &["--plots", "--theme", "light"]);
    for drawing in [&plain, &clear, &plots] {
        let page = roxmltree::Document::parse(drawing).expect("an SVG");
        // 900 pixels of 1/96 inch.
        assert_eq!(page.root_element().attribute("width"), Some("238.125mm"));
    }
    assert!(plain.contains("fill=\"#111317\"") && !clear.contains("<path d=\"M0 0L"), "the background");
    let count = |drawing: &str| drawing.matches("<path").count();
    assert!(count(&plots) > count(&plain) + 20, "the plots");
    assert_eq!(plain, {
        fs::remove_file(folder.path("plain.svg")).expect("a file");
        render("plain.svg", &[])
    });
}

/// The areas of the turn map are those of `turn-map`, and dynamic singularities lie on the inner one.
#[test]
fn a_turn_map_is_drawn_as_it_is_computed() {
    let folder = Folder::new("turns");
    draw(&folder, &["figures", "spot", "--what", "turn-map", "-o", "turns.svg"]);
    let out = folder.run(&["turn-map", "spot", "--json"]);
    let map: serde_json::Value = serde_json::from_slice(&out.stdout).expect("JSON");
    let drawn = curves(&read(&folder, "turns.csv"));
    let of = |name: &str| &drawn.iter().find(|((_, own), _)| own == name).unwrap_or_else(|| panic!("{name}")).1;
    let area = |points: &Points| points.windows(2).map(|w| 0.5 * (w[0][0] * w[1][1] - w[1][0] * w[0][1])).sum::<f64>();
    let numbers = |key: &str| map[key].as_array().expect(key).iter().map(|x| x.as_f64().expect("a number"));
    let mut last = 0.0;
    for (limit, want) in numbers("turn_limits").zip(numbers("areas")) {
        let name = if limit == 0.0 { "zero momentum".into() } else { format!("base turns by at most {limit}°") };
        close(&name, area(of(&name)), want, 1e-6);
        assert!(want > last, "{name}: the areas are nested");
        last = want;
    }
    let (inner, singular) = (of("zero momentum"), of("dynamic singularity"));
    assert!(singular.len() > 10 && singular.iter().all(|point| inner.contains(point)));
    let out = folder.run(&["figures", "two-drive", "--what", "turn-map", "-o", "none.svg"]);
    let why = text(&out.stderr);
    assert!(
        !out.status.success() && why.contains("want a machine of three") && !folder.path("none.svg").exists(),
        "{why}"
    );
}
