//! The figures of the paper.

use std::path::Path;

use clap::ValueEnum;
use stillbase_app::{AppState, SessionCommand};
use stillbase_files::new_folder::make_folder;
use stillbase_mechanics::machine::Machine;
use stillbase_mechanics::planar::Vector;
use stillbase_picture::print::paper::{
    PrintedFigure, TableColumn, parameters, snapshots_plot, torque_plot, which_b, workspaces,
};
use stillbase_picture::scene::palette::Theme;
use stillbase_planning::common::starting_b;
use stillbase_planning::pose_constant::Unreachable;
use stillbase_planning::pose_space::PoseSpace;
use stillbase_session::scenario::{Scenario, TaskChange, Value};
use stillbase_settings::number::counted;
use stillbase_settings::text::shell_word;
use stillbase_simulation::signals::signals;
use stillbase_study::pose_curves::PoseCurves;
use stillbase_study::workspace::WorkspaceReport;

use super::{FiguresArguments, write};
use crate::exit::print_message;
use crate::failure::Failure;
use crate::input::{change_task, machine, overlay_used, pose_space};

/// A figure of the paper.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PaperFigure {
    /// Every one of them
    All,
    /// Table I: parameters of the links, with what they leave of Eqs (7) and (8)
    #[value(name = "table-1")]
    Table1,
    /// Fig. 3: the angle of drive 1 against the pose constants b of two points
    #[value(name = "fig-3")]
    Fig3,
    /// Fig. 4: the reactionless workspaces of two b
    #[value(name = "fig-4")]
    Fig4,
    /// Fig. 5 (a): along a straight line
    #[value(name = "fig-5a")]
    Fig5a,
    /// Fig. 5 (b): to another pose at the end
    #[value(name = "fig-5b")]
    Fig5b,
    /// Fig. 5 (c): on one plane of joint space, without reactions
    #[value(name = "fig-5c")]
    Fig5c,
}

/// The paper's machine as this program solves it again, and as it is printed.
const MACHINES: [&str; 2] = ["nine-link", "nine-link-table-1"];
/// The paper's points A and B, m.
const POINTS: [[f64; 2]; 2] = [[0.50, 0.50], [0.55, 0.90]];
/// The paper's pose constants, rad.
const POSE_CONSTANTS: [f64; 2] = [2.4, 5.0];

/// Heights of the axes as fractions of the width of the figure.
const PLOT_HEIGHT: f32 = 0.52;
const DRAWING_HEIGHT: f32 = 0.95;

impl PaperFigure {
    /// All figures.
    const EACH: [Self; 6] = [Self::Table1, Self::Fig3, Self::Fig4, Self::Fig5a, Self::Fig5b, Self::Fig5c];

    fn word(self) -> String {
        self.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
    }
}

/// Draws figures of the paper into a folder.
pub fn draw(wanted: &FiguresArguments, figure: PaperFigure, folder: &Path) -> Result<(), Failure> {
    if !(wanted.point.is_empty() || wanted.point.len() == 2) {
        let count = counted(wanted.point.len(), "point");
        return Err(Failure::wrong_input(format!("{count}: want A and B, each with --point X,Y")));
    }
    let all: &[PaperFigure] = if figure == PaperFigure::All { &PaperFigure::EACH } else { &[figure] };
    make_folder(folder)?;
    let subject = Subject::of(wanted)?;
    // A machine may lack what one figure shows; the others are drawn.
    let mut refused: Vec<(String, Failure)> = Vec::new();
    for figure in all {
        let word = figure.word();
        match subject.figure(*figure) {
            Ok(drawn) => {
                let files = ["svg", "pdf", "csv"].map(|ending| folder.join(format!("{word}.{ending}")));
                write(&drawn, &files, wanted.force)?;
            }
            Err(why) => refused.push((word, why)),
        }
    }
    if refused.len() > 1 {
        let words: Vec<&str> = refused.iter().map(|(word, _)| word.as_str()).collect();
        print_message(format!("not drawn: {}; the first because", words.join(", ")));
    }
    refused.into_iter().next().map_or(Ok(()), |(word, why)| Err(why.with_context(word)))
}

/// Machine, points and b of the figures.
struct Subject<'a> {
    wanted: &'a FiguresArguments,
    machine: Machine,
    points: Vec<(String, Vector)>,
    b: Vec<f64>,
}

impl<'a> Subject<'a> {
    fn of(wanted: &'a FiguresArguments) -> Result<Self, Failure> {
        let machine = machine(wanted.machine.as_deref().unwrap_or(MACHINES[0]))?.machine;
        let points: Vec<Vector> = match &wanted.point[..] {
            [] => POINTS.map(|[x, y]| Vector::new(x, y)).to_vec(),
            own => own.to_vec(),
        };
        // Another machine, or other points, may not be served by the paper's b.
        let is_paper = wanted.machine.is_none() && wanted.point.is_empty();
        let b = match &wanted.b[..] {
            [] if is_paper => POSE_CONSTANTS.to_vec(),
            [] => PoseSpace::of(&machine).ok().and_then(|space| starting_b(&space, &points)).into_iter().collect(),
            own => own.to_vec(),
        };
        let b = if b.is_empty() { POSE_CONSTANTS.to_vec() } else { b };
        let points = ["A", "B"].map(String::from).into_iter().zip(points).collect();
        Ok(Self { wanted, machine, points, b })
    }

    /// Returns the command that writes a figure.
    fn made(&self, figure: PaperFigure) -> String {
        let FiguresArguments { machine, point, b, time, .. } = self.wanted;
        let machine = machine.as_ref().map_or_else(String::new, |name| format!(" --machine {}", shell_word(name)));
        let points: String = point.iter().map(|p| format!(" --point {},{}", p.re, p.im)).collect();
        let b: String = b.iter().map(|b| format!(" --b {b}")).collect();
        let time = time.map_or_else(String::new, |time| format!(" --time {time}"));
        format!("stillbase figures --paper {}{machine}{points}{b}{time}{}", figure.word(), self.wanted.as_typed())
    }

    fn figure(&self, figure: PaperFigure) -> Result<PrintedFigure, Failure> {
        let (width, made) = (self.wanted.width_points(), self.made(figure));
        let [plot, drawing] = [PLOT_HEIGHT, DRAWING_HEIGHT].map(|share| share * width);
        let name = self.machine.name();
        match figure {
            PaperFigure::All | PaperFigure::Table1 => self.table(&made, width),
            PaperFigure::Fig3 => {
                let space = pose_space(&self.machine)?;
                let places: Vec<Vector> = self.points.iter().map(|(_, at)| *at).collect();
                let curves = PoseCurves::of(&space, &places, self.b[0]);
                let curves = curves.map_err(Failure::no_answer)?;
                if let Some(i) = curves.of_points.iter().position(Vec::is_empty) {
                    let Vector { re: x, im: y } = places[i];
                    space.reach(places[i]).map_err(|reason| Unreachable::Anywhere { x, y, reason })?;
                }
                let title = format!("Fig. 3: range of q₁ and of the pose constants b of two points, {name}");
                Ok(PrintedFigure::of(&title, &made, width, &[(which_b(&self.points, &curves), plot)]))
            }
            PaperFigure::Fig4 => {
                let space = pose_space(&self.machine)?;
                let of = |b: &f64| {
                    let report = WorkspaceReport::of(&self.machine, &space, *b, &[]);
                    Some((*b, report?))
                };
                let all: Option<Vec<_>> = self.b.iter().map(of).collect();
                let all = all.ok_or_else(|| Failure::no_answer("the joint limits leave no pose: want wider ones"))?;
                let title = format!("Fig. 4: reactionless workspaces, {name}");
                Ok(PrintedFigure::of(&title, &made, width, &[(workspaces(&all), drawing)]))
            }
            PaperFigure::Fig5a => self.motion("case-1", "(a) path planned in Cartesian space", &made, width),
            PaperFigure::Fig5b => self.motion("case-2", "(b) path planned in joint space", &made, width),
            PaperFigure::Fig5c => self.motion("case-3", "(c) reactionless path", &made, width),
        }
    }

    fn table(&self, made: &str, width: f32) -> Result<PrintedFigure, Failure> {
        let column = |name: &str, machine: Machine| TableColumn { name: name.into(), machine };
        let columns = match &self.wanted.machine {
            Some(_) => vec![column("", self.machine.clone())],
            None => vec![
                column("printed", machine(MACHINES[1])?.machine),
                column("re-solved", machine(MACHINES[0])?.machine),
            ],
        };
        let title = match &self.wanted.machine {
            Some(_) => format!("Parameters of {}", self.machine.name()),
            None => "Table I: manipulator parameters, as printed and solved again".into(),
        };
        parameters(&title, made, &columns, width).map_err(Failure::no_answer)
    }

    /// Returns a part of Fig. 5: snapshots of a case above its torques.
    fn motion(&self, case: &str, what: &str, made: &str, width: f32) -> Result<PrintedFigure, Failure> {
        let scenario = self.scenario(case)?;
        let refused = |why| Failure::refused(&scenario, why);
        let mut app_state = AppState::new(scenario.clone(), Theme::Light).map_err(refused)?;
        app_state.run_to_end();
        app_state.carry_out(SessionCommand::Seek(0.0));
        let session = app_state.session();
        let (frames, linkage) = (session.frames(), app_state.views().stage().linkage());
        let mut snapshots = snapshots_plot(session.run(), linkage, frames);
        snapshots.head = what.into();
        let torques = torque_plot(&signals(&scenario.machine), frames);
        let title = format!("Fig. 5 {what}, {}", scenario.machine.name());
        let [plot, drawing] = [PLOT_HEIGHT, DRAWING_HEIGHT].map(|share| share * width);
        Ok(PrintedFigure::of(&title, made, width, &[(snapshots, drawing), (torques, plot)]))
    }

    /// Returns a case of the paper with the machine, the points, the b and the time that are asked for.
    fn scenario(&self, case: &str) -> Result<Scenario, Failure> {
        let mut scenario = stillbase_files::scenario(case)?.scenario;
        scenario.machine = self.machine.clone();
        let mut changes: Vec<(String, Value)> = Vec::new();
        for (key, (_, at)) in ["from", "to"].into_iter().zip(&self.points) {
            changes.push((key.into(), Value::Array(vec![at.re.into(), at.im.into()])));
        }
        changes.push(("b".into(), self.b[0].into()));
        changes.extend(self.wanted.time.map(|time| ("time".into(), time.into())));
        change_task(&mut scenario, &TaskChange::from_iter(changes))?;
        overlay_used(scenario, &self.wanted.settings)
    }
}
