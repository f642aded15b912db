//! `stillbase workspace`

use clap::Args;
use stillbase_mechanics::planar::Vector;
use stillbase_study::workspace::{WorkspaceInterior, WorkspaceReport};

use super::failure::Failure;
use super::input::{MachineArgument, point, pose_constant, pose_space};
use super::output::{Format, TextTable, yes};
use stillbase_settings::number::fixed;

/// Compute the reactionless workspace of b: exact boundary, area, and curves inside, Eqs (15), (16)
///
/// The workspace is the region that the end effector reaches with constant b; a change of b only turns it. Vertices lie
/// on the boundary to 1e-9 m and chords to 1e-5 m; outer loops run counter-clockwise. The area of all sheets, ∫|det|,
/// exceeds that of the region if several poses reach one point. With two drives the workspace is a curve: --json has
/// `curve` and `length`, and --at gives the distance of a point from it. Folds are curves where two poses meet; they
/// turn back at cusps. At change points sin(q_k − q_l) = 0 and the linkage is flat.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase workspace nine-link --b 2.4
  stillbase workspace nine-link --b 2.4 --set limits.a1=0.4,2.7 --json
  stillbase workspace nine-link --b 2.4 --at 0.5,0.5 --at 0.55,0.9")]
pub struct WorkspaceArguments {
    #[command(flatten)]
    machine: MachineArgument,
    /// Pose constant b, rad
    #[arg(long, value_name = "B", value_parser = pose_constant)]
    b: f64,
    /// Also print the poses of a point, m, its distance from the boundary (negative outside), and the dexterity of each
    /// pose; may be repeated
    #[arg(long, value_name = "X,Y", value_parser = point)]
    at: Vec<Vector>,
    #[command(flatten)]
    format: Format,
}

impl WorkspaceArguments {
    /// Prints area, extent and boundary of the workspace, the curves inside, and the measures of given points.
    pub fn run(&self) -> Result<(), Failure> {
        let machine = self.machine.load()?;
        let space = pose_space(&machine)?;
        let report = WorkspaceReport::of(&machine, &space, self.b, &self.at);
        let report = report.ok_or_else(|| Failure::no_answer("the joint limits leave no pose: want wider ones"))?;
        self.format.print(&report, |a| {
            let names: Vec<String> = machine.angles().iter().map(|a| format!("{} rad", a.name)).collect();
            match &a.inside {
                Some(inside) => {
                    let points = if a.points.is_empty() { String::new() } else { format!("\n{}", points(a, &names)) };
                    format!("{}\n{}{points}", table(a, inside).to_string().trim_start(), remarks(a, inside))
                }
                None => {
                    let points = if a.points.is_empty() { String::new() } else { format!("\n\n{}", points(a, &names)) };
                    format!("{}{points}", outline(a).to_string().trim_start())
                }
            }
        })
    }
}

/// Returns the table for machines that do not have three drives; with two drives the workspace is a curve.
fn outline(a: &WorkspaceReport) -> TextTable {
    let mut table = TextTable::new(["", "", ""]).with_words(2);
    let size = match a.length.filter(|_| is_curve(a)) {
        Some(length) => ("length of the curve", length, "m"),
        None => ("area", a.area, "m²"),
    };
    let rest = [("x from", a.x_min), ("x to", a.x_max), ("y from", a.y_min), ("y to", a.y_max)];
    for (name, value, unit) in [size].into_iter().chain(rest.map(|(name, x)| (name, x, "m"))) {
        table.row([name.into(), fixed(value, 6), unit.into()]);
    }
    table
}

fn is_curve(a: &WorkspaceReport) -> bool {
    a.curve.as_ref().is_some_and(|curve| !curve.is_empty())
}

fn table(a: &WorkspaceReport, inside: &WorkspaceInterior) -> TextTable {
    let mut table = TextTable::new(["", "", ""]).with_words(2);
    // Nine decimals are too few digits for a workspace of millimetres.
    let small = (a.x_max - a.x_min).hypot(a.y_max - a.y_min) < 1e-2;
    let number = |x: f64| if small { format!("{x:.9e}") } else { fixed(x, 9) };
    for (name, value, unit) in [
        ("area", a.area, "m²"),
        ("area of all sheets", a.sheet_area.unwrap_or(a.area), "m²"),
        ("x from", a.x_min, "m"),
        ("x to", a.x_max, "m"),
        ("y from", a.y_min, "m"),
        ("y to", a.y_max, "m"),
    ] {
        table.row([name.into(), number(value), unit.into()]);
    }
    // One curve of change points makes two parts; with more parts the table would be too long.
    if let [first, second] = &inside.areas_by_side[..] {
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

fn remarks(a: &WorkspaceReport, inside: &WorkspaceInterior) -> String {
    let vertices: usize = a.loops.iter().map(Vec::len).sum();
    let count = |n: usize, one: &str, many: &str| match n {
        1 => format!("one {one}"),
        n => format!("{n} {many}"),
    };
    let mut found = vec![format!(
        "{} a point",
        if inside.sheets == 1 { "one pose".into() } else { format!("up to {} poses", inside.sheets) }
    )];
    for (n, one, many) in [
        (inside.fold_curves.len(), "fold", "folds"),
        (inside.cusps.len(), "cusp", "cusps"),
        (inside.change_point_curves.len(), "curve of change points", "curves of change points"),
    ] {
        if n > 0 {
            found.push(count(n, one, many));
        }
    }
    format!(
        "singular inside: {}; boundary: {} of {vertices} vertices (--json lists them)\ninside: {}\n",
        yes(inside.interior_singularity),
        count(a.loops.len(), "loop", "loops"),
        found.join(", "),
    )
}

/// Returns the table of points: angles and measures of each pose.
fn points(a: &WorkspaceReport, angles: &[String]) -> TextTable {
    let from = if is_curve(a) { "from curve m" } else { "from boundary m" };
    let det = a.inside.is_some().then_some("det m²");
    let measures = det.into_iter().chain(["√det(J Jᵀ) m²", "worst N m/N", "least |sin|"]).map(String::from);
    let head = ["point m", from].map(String::from).into_iter().chain(angles.iter().cloned());
    let mut table = TextTable::new(head.chain(measures));
    for p in &a.points {
        let numbers = p.poses.iter().map(|pose| {
            let measures = [pose.manipulability, pose.worst_torque_per_force, pose.transmission];
            pose.a.iter().copied().chain(pose.det).chain(measures).collect()
        });
        add_point(&mut table, p.point, p.distance, numbers.collect());
    }
    table
}

/// Adds the rows of a point, one for each pose; the first row states the point.
fn add_point(table: &mut TextTable, [x, y]: [f64; 2], distance: f64, poses: Vec<Vec<f64>>) {
    let mut first = [format!("{x}, {y}"), fixed(distance, 9)];
    if poses.is_empty() {
        table.row(first.clone().into_iter().chain(["no pose".into()]));
    }
    for numbers in poses {
        table.row(std::mem::take(&mut first).into_iter().chain(numbers.into_iter().map(|x| fixed(x, 6))));
    }
}
