//! `stillbase workspace`

use clap::Args;
use serde::Serialize;
use stillbase::reactionless::Boundary;

use super::failure::Failure;
use super::input::{MachineArgument, planes_of, pose_constant};
use super::output::{Format, Table, fixed, yes};

/// The reactionless workspace of b: its exact boundary and area, Eqs (15), (16)
///
/// It is the region that the end effector reaches while b is held; b only turns it. Vertices lie on the boundary to 1e-9 m and chords to 1e-5 m; outer loops run counter-clockwise.
/// The area of all sheets, ∫|det|, exceeds the region's where several poses reach one point.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase workspace nine-link --b 2.4
  stillbase workspace nine-link --b 2.4 --set limits.a1=0.4,2.7 --json")]
pub struct Workspace {
    #[command(flatten)]
    machine: MachineArgument,
    /// Pose constant b, rad
    #[arg(long, value_name = "B", value_parser = pose_constant)]
    b: f64,
    #[command(flatten)]
    format: Format,
}

#[derive(Serialize)]
struct Answer {
    area: f64,
    sheet_area: f64,
    x_min: f64,
    x_max: f64,
    y_min: f64,
    y_max: f64,
    loops: Vec<Vec<[f64; 2]>>,
    interior_singularity: bool,
}

impl Workspace {
    /// Prints area, extent and boundary.
    pub fn run(&self) -> Result<(), Failure> {
        let boundary = Boundary::of(&planes_of(&self.machine.load()?)?);
        let extent = boundary.extent(self.b);
        let answer = Answer {
            area: boundary.area(),
            sheet_area: boundary.sheet_area(),
            x_min: extent.x_min,
            x_max: extent.x_max,
            y_min: extent.y_min,
            y_max: extent.y_max,
            loops: boundary.turned(self.b),
            interior_singularity: boundary.interior_singularity(),
        };
        self.format.print(&answer, |a| {
            let mut table = Table::new(["", "", ""]).with_words(2);
            for (name, value, unit) in [
                ("area", a.area, "m²"),
                ("area of all sheets", a.sheet_area, "m²"),
                ("x from", a.x_min, "m"),
                ("x to", a.x_max, "m"),
                ("y from", a.y_min, "m"),
                ("y to", a.y_max, "m"),
            ] {
                table.row([name.into(), fixed(value, 9), unit.into()]);
            }
            let vertices: usize = a.loops.iter().map(Vec::len).sum();
            format!(
                "{}\nsingular inside: {}; boundary: {} of {vertices} vertices (--json lists them)\n",
                table.to_string().trim_start(),
                yes(a.interior_singularity),
                match a.loops.len() {
                    1 => "one loop".into(),
                    n => format!("{n} loops"),
                },
            )
        })
    }
}
