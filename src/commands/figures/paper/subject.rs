//! What the figures of the paper are of.

use stillbase_app::{AppState, SessionCommand};
use stillbase_mechanics::machine::Machine;
use stillbase_mechanics::planar::Vector;
use stillbase_picture::print::PrintPlot;
use stillbase_picture::print::paper::{
    PrintPart, PrintedFigure, TableColumn, parameters, snapshots_plot, torque_plot, which_b, workspaces,
};
use stillbase_picture::scene::palette::Theme;
use stillbase_planning::common::{common_b_set, starting_b};
use stillbase_planning::pose_constant::Unreachable;
use stillbase_planning::pose_space::PoseSpace;
use stillbase_session::scenario::{Scenario, TaskChange, Value};
use stillbase_settings::text::shell_word;
use stillbase_simulation::signals::signals;
use stillbase_study::pose_curves::PoseCurves;
use stillbase_study::workspace::WorkspaceReport;

use super::PaperFigure;
use super::option::PaperOption;
use crate::failure::Failure;
use crate::figures::FiguresArguments;
use crate::input::{Settings, change_task, machine, overlay_used, pose_space};

/// The paper's machine as this program solves it again, and as it is printed.
const MACHINES: [&str; 2] = ["nine-link", "nine-link-table-1"];
/// The paper's points A and B, m.
const POINTS: [[f64; 2]; 2] = [[0.50, 0.50], [0.55, 0.90]];
/// The paper's pose constants, rad.
const POSE_CONSTANTS: [f64; 2] = [2.4, 5.0];

/// The paper's cases.
const CASES: [&str; 3] = ["case-1", "case-2", "case-3"];

/// Heights of the axes as fractions of the width of the figure.
const PLOT_HEIGHT: f32 = 0.52;
const DRAWING_HEIGHT: f32 = 0.95;

/// Machine, points and b of the figures.
pub struct Subject<'a> {
    wanted: &'a FiguresArguments,
    theme: Theme,
    /// The machine without the settings, which each figure takes as far as it uses them.
    machine: Machine,
    points: Vec<(String, Vector)>,
    b: Vec<f64>,
}

impl<'a> Subject<'a> {
    pub fn of(wanted: &'a FiguresArguments, theme: Theme) -> Result<Self, Failure> {
        let machine = machine(wanted.machine.as_deref().unwrap_or(MACHINES[0]))?.machine;
        let points: Vec<Vector> = match &wanted.point[..] {
            [] => POINTS.map(|[x, y]| Vector::new(x, y)).to_vec(),
            own => own.to_vec(),
        };
        // Another machine, or other points, may not be served by the paper's b.
        let is_paper = wanted.machine.is_none() && wanted.point.is_empty();
        let settings = settings_of(wanted, PaperFigure::Fig4);
        let serves = |space: &PoseSpace| {
            let common = common_b_set(space, &points).map_or_else(Vec::new, |set| set.intervals);
            common.iter().any(|[from, to]| (*from..=*to).contains(&POSE_CONSTANTS[0]))
        };
        let b = match &wanted.b[..] {
            [] if is_paper && settings.is_empty() => POSE_CONSTANTS.to_vec(),
            [] => match PoseSpace::of(&settings.apply(machine.clone())?) {
                Ok(space) if is_paper && serves(&space) => POSE_CONSTANTS.to_vec(),
                Ok(space) => starting_b(&space, &points).into_iter().collect(),
                Err(_) => Vec::new(),
            },
            own => own.to_vec(),
        };
        let b = if b.is_empty() { POSE_CONSTANTS.to_vec() } else { b };
        let points = ["A", "B"].map(String::from).into_iter().zip(points).collect();
        Ok(Self { wanted, theme, machine, points, b })
    }

    /// Returns the command that writes a figure, with the options that the figure uses.
    fn made(&self, figure: PaperFigure) -> String {
        let FiguresArguments { machine, point, b, time, .. } = self.wanted;
        let machine = machine.as_ref().map_or_else(String::new, |name| format!(" --machine {}", shell_word(name)));
        let uses = |option| figure.uses(option);
        let points = point.iter().filter(|_| uses(PaperOption::Points));
        let points: String = points.map(|p| format!(" --point {},{}", p.re, p.im)).collect();
        let place = |i| if i == 0 { PaperOption::FirstB } else { PaperOption::FurtherB };
        let b = b.iter().enumerate().filter(|(i, _)| uses(place(*i)));
        let b: String = b.map(|(_, b)| format!(" --b {b}")).collect();
        let time = time.filter(|_| uses(PaperOption::Time));
        let time = time.map_or_else(String::new, |time| format!(" --time {time}"));
        let settings = settings_of(self.wanted, figure).as_typed();
        let (word, form) = (figure.word(), self.wanted.typed_form());
        format!("stillbase figures --paper {word}{machine}{points}{b}{time}{form}{settings}")
    }

    pub fn figure(&self, figure: PaperFigure) -> Result<PrintedFigure, Failure> {
        let (width, made) = (self.wanted.width_points(), self.made(figure));
        match figure {
            PaperFigure::All | PaperFigure::Table1 => self.table(&made, width),
            PaperFigure::Fig3 => self.poses(&made, width),
            PaperFigure::Fig4 => self.workspaces(&made, width),
            PaperFigure::Fig5a => self.motion(CASES[0], "(a) path planned in Cartesian space", &made, width),
            PaperFigure::Fig5b => self.motion(CASES[1], "(b) path planned in joint space", &made, width),
            PaperFigure::Fig5c => self.motion(CASES[2], "(c) reactionless path", &made, width),
        }
    }

    fn table(&self, made: &str, width: f32) -> Result<PrintedFigure, Failure> {
        let settings = settings_of(self.wanted, PaperFigure::Table1);
        let column = |name: &str, machine: Machine| -> Result<TableColumn, Failure> {
            Ok(TableColumn { name: name.into(), machine: settings.apply(machine)? })
        };
        let columns = match &self.wanted.machine {
            Some(_) => vec![column("", self.machine.clone())?],
            None => vec![
                column("printed", machine(MACHINES[1])?.machine)?,
                column("re-solved", machine(MACHINES[0])?.machine)?,
            ],
        };
        let title = match &self.wanted.machine {
            Some(_) => format!("Parameters of {}", self.machine.name()),
            None if settings.is_empty() => "Table I: manipulator parameters, as printed and solved again".into(),
            None => "Table I with changes: manipulator parameters, from those printed and solved again".into(),
        };
        parameters(self.theme, &title, made, &columns, width).map_err(Failure::no_answer)
    }

    /// Returns Fig. 3.
    fn poses(&self, made: &str, width: f32) -> Result<PrintedFigure, Failure> {
        let machine = settings_of(self.wanted, PaperFigure::Fig3).apply(self.machine.clone())?;
        let space = pose_space(&machine)?;
        let places: Vec<Vector> = self.points.iter().map(|(_, at)| *at).collect();
        let curves = PoseCurves::of(&space, &places, self.b[0]);
        let curves = curves.map_err(Failure::no_answer)?;
        if let Some(i) = curves.of_points.iter().position(Vec::is_empty) {
            let Vector { re: x, im: y } = places[i];
            space.reach(places[i]).map_err(|reason| Unreachable::Anywhere { x, y, reason })?;
        }
        let title = format!("Fig. 3: range of q₁ and of the pose constants b of two points, {}", machine.name());
        Ok(PrintedFigure::of(
            &title,
            made,
            width,
            vec![PrintPart::Plot(which_b(self.theme, &self.points, &curves), PLOT_HEIGHT * width)],
        ))
    }

    /// Returns Fig. 4.
    fn workspaces(&self, made: &str, width: f32) -> Result<PrintedFigure, Failure> {
        let machine = settings_of(self.wanted, PaperFigure::Fig4).apply(self.machine.clone())?;
        let space = pose_space(&machine)?;
        let of = |b: &f64| Some((*b, WorkspaceReport::of(&machine, &space, *b, &[])?));
        let all: Option<Vec<_>> = self.b.iter().map(of).collect();
        let all = all.ok_or_else(|| Failure::no_answer("the joint limits leave no pose: want wider ones"))?;
        let title = format!("Fig. 4: reactionless workspaces, {}", machine.name());
        Ok(PrintedFigure::of(
            &title,
            made,
            width,
            vec![PrintPart::Plot(workspaces(self.theme, &all), DRAWING_HEIGHT * width)],
        ))
    }

    /// Simulates a case to its end and returns it at its start, with its torques.
    fn run(&self, case: &str) -> Result<(AppState, PrintPlot), Failure> {
        let scenario = self.scenario(case)?;
        let refused = |why| Failure::refused(&scenario, why);
        let mut app_state = AppState::new(scenario.clone(), Theme::Light).map_err(refused)?;
        app_state.run_to_end();
        app_state.carry_out(SessionCommand::Seek(0.0));
        let torques = torque_plot(self.theme, &signals(&scenario.machine), app_state.session().frames());
        Ok((app_state, torques))
    }

    /// Returns a part of Fig. 5: snapshots of a case above its torques.
    fn motion(&self, case: &str, what: &str, made: &str, width: f32) -> Result<PrintedFigure, Failure> {
        let (app_state, mut torques) = self.run(case)?;
        let session = app_state.session();
        let (frames, linkage) = (session.frames(), app_state.views().stage().linkage());
        let mut snapshots = snapshots_plot(self.theme, session.run(), linkage, frames);
        snapshots.head = what.into();
        // The three cases have one axis, so that they can be compared; one that cannot run is left out.
        let others = CASES.iter().filter(|other| **other != case).filter_map(|other| self.run(other).ok());
        let curves = others.flat_map(|(_, plot)| plot.curves);
        torques.covers = curves.flat_map(|curve| curve.points).map(|[_, torque]| torque).collect();
        let title = format!("Fig. 5 {what}, {}", session.scenario().machine.name());
        let [plot, drawing] = [PLOT_HEIGHT, DRAWING_HEIGHT].map(|share| share * width);
        let parts = vec![PrintPart::Plot(snapshots, drawing), PrintPart::Plot(torques, plot)];
        Ok(PrintedFigure::of(&title, made, width, parts))
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

/// Returns the settings that a figure uses.
fn settings_of(wanted: &FiguresArguments, figure: PaperFigure) -> Settings {
    wanted.settings.of_keys(|key| figure.uses(PaperOption::Setting(key)))
}
