//! `stillbase workspace`

use clap::Args;
use serde::Serialize;
use stillbase::mechanics::machine::Machine;
use stillbase::mechanics::planar::{Vector, unit};
use stillbase::planning::pose_space::{Outline, Planes, PoseSpace};
use stillbase::planning::reactionless::{Boundary, ChangeCurve, PAIRS, PlaneMap};

use super::failure::Failure;
use super::input::{MachineArgument, point, pose_constant, pose_space};
use super::output::{Format, Table, yes};
use super::pose::Row;
use stillbase::settings::number::fixed;

/// The reactionless workspace of b: its exact boundary and area, what lies inside, Eqs (15), (16)
///
/// It is the region that the end effector reaches while b is held; b only turns it. Vertices lie on the boundary to
/// 1e-9 m and chords to 1e-5 m; outer loops run counter-clockwise. The area of all sheets, ∫|det|, exceeds the region's
/// where several poses reach one point. With two drives it is a curve, and --json has `curve` and `length`; --at tells how
/// far a point is from it. Folds, where two poses meet, turn back at cusps; at change points sin(q_k −
/// q_l) = 0 and the linkage goes flat.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase workspace nine-link --b 2.4
  stillbase workspace nine-link --b 2.4 --set limits.a1=0.4,2.7 --json
  stillbase workspace nine-link --b 2.4 --at 0.5,0.5 --at 0.55,0.9")]
pub struct Workspace {
    #[command(flatten)]
    machine: MachineArgument,
    /// Pose constant b, rad
    #[arg(long, value_name = "B", value_parser = pose_constant)]
    b: f64,
    /// Also tell of a point, m, as often as needed: its poses, its distance from the boundary (negative outside), the
    /// dexterity of each pose
    #[arg(long, value_name = "X,Y", value_parser = point)]
    at: Vec<Vector>,
    #[command(flatten)]
    format: Format,
}

#[derive(Serialize)]
struct Answer {
    area: f64,
    #[serde(flatten)]
    size: Size,
    x_min: f64,
    x_max: f64,
    y_min: f64,
    y_max: f64,
    loops: Vec<Vec<[f64; 2]>>,
    #[serde(flatten)]
    inside: Inside,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    points: Vec<OfPoint>,
}

/// Of all sheets on planes; elsewhere of a curve, 0 of a region.
#[derive(Serialize)]
#[serde(untagged)]
enum Size {
    Sheets { sheet_area: f64 },
    Curve { length: f64 },
}

/// What planes tell of the inside; elsewhere the curve of two drives.
#[derive(Serialize)]
#[serde(untagged)]
enum Inside {
    Sheets(Box<OfSheets>),
    Curve { curve: Vec<[f64; 2]> },
}

#[derive(Serialize)]
struct OfSheets {
    interior_singularity: bool,
    sheets: usize,
    areas_by_poses: Vec<f64>,
    fold_curves: Vec<Vec<[f64; 2]>>,
    cusps: Vec<[f64; 2]>,
    inner_limits: Vec<Vec<[f64; 2]>>,
    change_point_curves: Vec<OfChange>,
    areas_by_side: Vec<OfSide>,
}

/// Change points of two drives, counted from 1.
#[derive(Serialize)]
struct OfChange {
    pair: [usize; 2],
    half_turns: i32,
    line: Vec<[f64; 2]>,
}

/// What poses with `half_turns` π ≤ q_l − q_k ≤ (`half_turns` + 1) π reach.
#[derive(Serialize)]
struct OfSide {
    pair: [usize; 2],
    half_turns: i32,
    area: f64,
    sheet_area: f64,
}

#[derive(Serialize)]
struct OfPoint {
    point: [f64; 2],
    distance: f64,
    poses: Vec<Row>,
}

/// Drives as people count them.
fn drives(pair: usize) -> [usize; 2] {
    PAIRS[pair].map(|k| k + 1)
}

impl Workspace {
    /// Prints area, extent and boundary, what lies inside, and what is asked of points.
    pub fn run(&self) -> Result<(), Failure> {
        let machine = self.machine.load()?;
        let space = pose_space(&machine)?;
        let answer = match space.planes() {
            Ok(planes) => self.of_planes(&machine, (&space, planes)),
            Err(_) => self.outlined(&machine, &space)?,
        };
        self.format.print(&answer, |a| {
            let (mut text, apart) = match &a.inside {
                Inside::Sheets(of) => (format!("{}\n{}", table(a, of).to_string().trim_start(), remarks(a, of)), "\n"),
                Inside::Curve { .. } => (outline_table(a).to_string().trim_start().to_owned(), "\n\n"),
            };
            if !a.points.is_empty() {
                let names: Vec<String> = machine.angles().iter().map(|a| format!("{} rad", a.name)).collect();
                text.push_str(&format!("{apart}{}", points(a, &names)));
            }
            text
        })
    }

    fn points(&self, machine: &Machine, space: &PoseSpace, distance: impl Fn(Vector) -> f64) -> Vec<OfPoint> {
        let poses = |p: Vector| Row::all(machine, space, p, self.b);
        self.at.iter().map(|p| OfPoint { point: [p.re, p.im], distance: distance(*p), poses: poses(*p) }).collect()
    }

    /// Where no planes tell of the inside: an outline, of two drives a curve.
    fn outlined(&self, machine: &Machine, space: &PoseSpace) -> Result<Answer, Failure> {
        let outline = space.outline(self.b);
        let points = self.points(machine, space, |p| outline.distance(p));
        let Outline { area, length, extent: [x_min, x_max, y_min, y_max], loops, curve } = outline;
        if loops.is_empty() && curve.is_empty() {
            return Err(Failure::no_answer("the joint limits leave no pose: want wider ones"));
        }
        let (size, inside) = (Size::Curve { length }, Inside::Curve { curve });
        Ok(Answer { area, size, x_min, x_max, y_min, y_max, loops, inside, points })
    }

    fn of_planes(&self, machine: &Machine, (space, planes): (&PoseSpace, &Planes)) -> Answer {
        let (map, boundary) = (planes.map(), planes.boundary());
        let extent = boundary.extent(self.b);
        let turn = map.turn(self.b);
        let changes = boundary.change_curves();
        let cusp = |at: Vector| {
            let p = at * unit(turn);
            [p.re, p.im]
        };
        Answer {
            area: boundary.area(),
            size: Size::Sheets { sheet_area: boundary.sheet_area() },
            x_min: extent.x_min,
            x_max: extent.x_max,
            y_min: extent.y_min,
            y_max: extent.y_max,
            loops: boundary.turned(self.b),
            inside: Inside::Sheets(Box::new(OfSheets {
                interior_singularity: boundary.interior_singularity(),
                sheets: boundary.sheets(),
                areas_by_poses: boundary.areas_by_poses(),
                fold_curves: boundary.fold_curves().iter().map(|l| l.turned(turn)).collect(),
                cusps: boundary.cusps().iter().map(|c| cusp(c.at)).collect(),
                inner_limits: boundary.inner_limits().iter().map(|l| l.turned(turn)).collect(),
                areas_by_side: sides(map, boundary, &changes),
                change_point_curves: changes
                    .iter()
                    .map(|c| OfChange { pair: drives(c.pair), half_turns: c.half_turns, line: c.line.turned(turn) })
                    .collect(),
            })),
            points: self.points(machine, space, |p| boundary.distance(p, self.b)),
        }
    }
}

/// Rows of an outline: its size and where it lies.
fn outline_table(a: &Answer) -> Table {
    let mut table = Table::new(["", "", ""]).with_words(2);
    let size = match (&a.size, &a.inside) {
        (Size::Curve { length }, Inside::Curve { curve }) if !curve.is_empty() => ("length of the curve", *length, "m"),
        _ => ("area", a.area, "m²"),
    };
    let rest = [("x from", a.x_min), ("x to", a.x_max), ("y from", a.y_min), ("y to", a.y_max)];
    for (name, value, unit) in [size].into_iter().chain(rest.map(|(name, x)| (name, x, "m"))) {
        table.row([name.into(), fixed(value, 6), unit.into()]);
    }
    table
}

/// The parts on the sides of each pair that has change points inside.
fn sides(map: &PlaneMap, boundary: &Boundary, changes: &[ChangeCurve]) -> Vec<OfSide> {
    let divided = (0..PAIRS.len()).filter(|&pair| changes.iter().any(|c| c.pair == pair));
    let part = |(pair, half_turns): (usize, i32)| {
        let mut sides = [None; 3];
        sides[pair] = Some(half_turns);
        let part = Boundary::on_sides(map, sides)?;
        Some(OfSide { pair: drives(pair), half_turns, area: part.area(), sheet_area: part.sheet_area() })
    };
    divided.flat_map(|pair| boundary.sides(pair).map(move |m| (pair, m))).filter_map(part).collect()
}

fn table(a: &Answer, of: &OfSheets) -> Table {
    let sheet_area = if let Size::Sheets { sheet_area } = a.size { sheet_area } else { a.area };
    let mut table = Table::new(["", "", ""]).with_words(2);
    // Nine decimals say nothing of a workspace of millimetres.
    let small = (a.x_max - a.x_min).hypot(a.y_max - a.y_min) < 1e-2;
    let number = |x: f64| if small { format!("{x:.9e}") } else { fixed(x, 9) };
    for (name, value, unit) in [
        ("area", a.area, "m²"),
        ("area of all sheets", sheet_area, "m²"),
        ("x from", a.x_min, "m"),
        ("x to", a.x_max, "m"),
        ("y from", a.y_min, "m"),
        ("y to", a.y_max, "m"),
    ] {
        table.row([name.into(), number(value), unit.into()]);
    }
    // One change curve makes two parts; where there are many, the table would no longer be calm.
    if let [first, second] = &of.areas_by_side[..] {
        for part in [first, second] {
            let [k, l] = part.pair;
            let turns = |m: i32| match m {
                0 => "0".into(),
                1 => "π".into(),
                -1 => "−π".into(),
                m if m < 0 => format!("−{}π", m.unsigned_abs()),
                m => format!("{m}π"),
            };
            let name = format!(
                "area, q_{l} − q_{k} from {} to {}",
                turns(part.half_turns),
                turns(part.half_turns.saturating_add(1))
            );
            table.row([name, number(part.area), "m²".into()]);
        }
    }
    table
}

fn remarks(a: &Answer, of: &OfSheets) -> String {
    let vertices: usize = a.loops.iter().map(Vec::len).sum();
    let count = |n: usize, one: &str, many: &str| match n {
        1 => format!("one {one}"),
        n => format!("{n} {many}"),
    };
    let mut inside = vec![format!(
        "{} a point",
        if of.sheets == 1 { "one pose".into() } else { format!("up to {} poses", of.sheets) }
    )];
    for (n, one, many) in [
        (of.fold_curves.len(), "fold", "folds"),
        (of.cusps.len(), "cusp", "cusps"),
        (of.change_point_curves.len(), "curve of change points", "curves of change points"),
    ] {
        if n > 0 {
            inside.push(count(n, one, many));
        }
    }
    format!(
        "singular inside: {}; boundary: {} of {vertices} vertices (--json lists them)\ninside: {}\n",
        yes(of.interior_singularity),
        count(a.loops.len(), "loop", "loops"),
        inside.join(", "),
    )
}

fn points(a: &Answer, angles: &[String]) -> Table {
    let from = match &a.inside {
        Inside::Curve { curve } if !curve.is_empty() => "from curve m",
        _ => "from boundary m",
    };
    let det: &[&str] = if matches!(a.inside, Inside::Sheets(_)) { &["det m²"] } else { &[] };
    let measures = [det, &["√det(J Jᵀ) m²", "worst N m/N", "least |sin|"]].concat();
    let mut table = poses(from, angles, &measures);
    for p in &a.points {
        let numbers = p.poses.iter().map(|pose| {
            let measures = [pose.manipulability, pose.worst_torque_per_force, pose.transmission];
            pose.a.iter().copied().chain(pose.det).chain(measures).collect()
        });
        add_point(&mut table, p.point, p.distance, numbers.collect());
    }
    table
}

/// A table of points with their poses: angles and measures of each.
fn poses(from: &str, angles: &[String], measures: &[&str]) -> Table {
    let head = ["point m", from].map(String::from).into_iter().chain(angles.iter().cloned());
    Table::new(head.chain(measures.iter().map(|words| (*words).to_owned())))
}

/// The rows of a point: one for each pose, the first with its place.
fn add_point(table: &mut Table, [x, y]: [f64; 2], distance: f64, poses: Vec<Vec<f64>>) {
    let mut first = [format!("{x}, {y}"), fixed(distance, 9)];
    if poses.is_empty() {
        table.row(first.clone().into_iter().chain(["no pose".into()]));
    }
    for numbers in poses {
        table.row(std::mem::take(&mut first).into_iter().chain(numbers.into_iter().map(|x| fixed(x, 6))));
    }
}
