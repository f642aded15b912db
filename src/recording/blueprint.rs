//! The layout that a recording opens with: scene left, joint space and tower behind it, plots by unit right, events below; several cases side by side
//! first, and each in a tab of its own.
//!
//! Views are rows of a store of their own. The SDK's builders reach neither the eye of a 3D view, nor axis ranges, nor
//! backgrounds, so the rows are written here.

use rerun::blueprint::components::{
    ActiveTab, BackgroundKind, ColumnShare, ContainerKind, Corner2D, GridSpacing, IncludedContent, LinkAxis, LoopMode,
    PanelState, PlayState, QueryExpression, RootContainer, RowShare, ViewClass,
};
use rerun::blueprint::datatypes::{TextLogColumn, TextLogColumnKind, TimelineColumn};
use rerun::components::{Plane3D, Range1D};
use rerun::external::re_sdk_types::blueprint::archetypes as view;
use rerun::external::re_sdk_types::blueprint::components::VisualizerInstructionId;
use rerun::external::uuid::Uuid;
use rerun::{AsComponents, EntityPath, SeriesLines};

use super::Hash;
use super::eye::Eye;
use super::rehearsal::Rehearsal;
use super::store::{Store, StoreError, TIME};
use super::style::{Both, colour, series_name, under};
use crate::picture::scene::Rgba;
use crate::picture::scene::camera::Orbit;
use crate::picture::scene::linkage::mix;
use crate::picture::scene::palette::{Palette, Theme, faded, palette};

/// Writes the layout and has the viewer open with it.
///
/// # Errors
/// If it cannot be written.
pub fn lay_out(store: &mut Store, cases: &[Rehearsal], pictured: bool) -> Result<(), StoreError> {
    let mut layout =
        Layout { store, palette: palette(Theme::Dark), tab: String::new(), axes: Axes::of(cases), pictured };
    let mut tabs = Vec::new();
    if cases.len() > 1 {
        tabs.push(layout.comparison(cases)?);
    }
    for case in cases {
        tabs.push(layout.case(case)?);
    }
    layout.tab.clear();
    let root = layout.container(ContainerKind::Tabs, "", &tabs, &[])?;
    let viewport = view::ViewportBlueprint::new()
        .with_root_container(RootContainer(root.id.into()))
        .with_auto_layout(false)
        .with_auto_views(false);
    layout.store.layout(&"viewport".into(), &viewport)?;
    for panel in ["selection_panel", "blueprint_panel"] {
        layout.store.layout(&panel.into(), &view::PanelBlueprint::new().with_state(PanelState::Collapsed))?;
    }
    let time = view::TimePanelBlueprint::new()
        .with_state(PanelState::Collapsed)
        .with_timeline(TIME)
        .with_loop_mode(LoopMode::All)
        // A layout cannot say at what instant to stop; in motion, the first look shows more than the start.
        .with_play_state(PlayState::Playing);
    layout.store.layout(&"time_panel".into(), &time)?;
    layout.store.activate_layout()
}

/// Ranges that plots of all cases share, so that they can be compared, and so that noise is not shown as if it were
/// something.
struct Axes {
    /// |n_B|, N m.
    moment: f64,
    /// |f_B|, N.
    force: f64,
    /// b, rad.
    b: [f64; 2],
}

impl Axes {
    fn of(cases: &[Rehearsal]) -> Self {
        let largest = |of: fn(&Rehearsal) -> f64| cases.iter().map(of).fold(0.0, f64::max);
        // Where nothing reaches the base, what would if nothing cancelled gives the scale.
        let scale = |peak: f64, whole: f64| match peak > 1e-6 * whole {
            true => 1.08 * marked(peak),
            false if whole > 0.0 => 1.08 * marked(whole),
            false => 1.0,
        };
        let low = cases.iter().map(|c| c.b[0]).fold(f64::INFINITY, f64::min);
        let high = cases.iter().map(|c| c.b[1]).fold(f64::NEG_INFINITY, f64::max);
        let margin = (0.1 * (high - low)).max(0.05);
        Self {
            moment: scale(largest(|c| c.peaks.moment), largest(|c| c.peaks.torque_sum)),
            force: scale(largest(|c| c.peaks.force), largest(|c| c.peaks.inertial_pull)),
            b: [low - margin, high + margin],
        }
    }
}

/// The next bound at which a low plot still has room for its marks: they stand at powers of ten.
fn marked(x: f64) -> f64 {
    let decade = 10f64.powf(x.log10().floor());
    [1.0, 2.0, 3.0].map(|m| m * decade).into_iter().find(|bound| *bound > x).unwrap_or(10.0 * decade)
}

/// A view or container.
struct Part {
    path: EntityPath,
    id: Uuid,
}

struct Layout<'a> {
    store: &'a mut Store,
    palette: Palette,
    /// The tab that is being laid out: the name of its case, or none where all are side by side.
    tab: String,
    axes: Axes,
    pictured: bool,
}

/// What marks an identifier as one that its maker chose (version 8).
const VERSION: u128 = 0x0000_0000_0000_8000_8000_0000_0000_0000;
const VERSION_BITS: u128 = 0x0000_0000_0000_f000_c000_0000_0000_0000;

/// How many cases a legend names; it has room for no more.
const LEGEND: usize = 5;

impl Layout<'_> {
    /// The identifier of a view or container: always the same for the same thing. A viewer keeps what it knows of a view
    /// by its identifier, also from one recording to the next, and shows nothing where that turns out to be of another
    /// class.
    fn id(&self, class: &str, words: &[&str]) -> Uuid {
        let mut hash = Hash::new();
        [class, &self.tab].iter().chain(words).for_each(|word| hash.add(word));
        Uuid::from_u128(hash.0 & !VERSION_BITS | VERSION)
    }

    fn container(
        &mut self,
        kind: ContainerKind,
        name: &str,
        parts: &[Part],
        shares: &[f32],
    ) -> Result<Part, StoreError> {
        let parted: Vec<String> = parts.iter().map(|part| part.id.to_string()).collect();
        let words: Vec<&str> = parted.iter().map(String::as_str).collect();
        let id = self.id(&format!("container {kind:?}"), &words);
        let path = EntityPath::from(format!("container/{id}"));
        let mut container = view::ContainerBlueprint::new(kind)
            .with_contents(parts.iter().map(|p| IncludedContent(p.path.to_string().into())));
        if !name.is_empty() {
            container = container.with_display_name(name);
        }
        container = match kind {
            ContainerKind::Horizontal => container.with_col_shares(shares.iter().map(|s| ColumnShare((*s).into()))),
            ContainerKind::Vertical => container.with_row_shares(shares.iter().map(|s| RowShare((*s).into()))),
            ContainerKind::Tabs | ContainerKind::Grid => match parts.first() {
                Some(first) => container.with_active_tab(ActiveTab(first.path.to_string().into())),
                None => container,
            },
        };
        self.store.layout(&path, &container)?;
        Ok(Part { path, id })
    }

    fn view(
        &mut self,
        class: &str,
        name: &str,
        origin: &EntityPath,
        contents: &[String],
        properties: &[(&str, &dyn AsComponents)],
    ) -> Result<Part, StoreError> {
        let from = origin.to_string();
        let words: Vec<&str> = [from.as_str()].into_iter().chain(contents.iter().map(String::as_str)).collect();
        let id = self.id(class, &words);
        let path = EntityPath::from(format!("view/{id}"));
        let query = view::ViewContents::new(contents.iter().map(|q| QueryExpression(q.as_str().into())));
        self.store.layout(&under(&path, "ViewContents"), &query)?;
        let view =
            view::ViewBlueprint::new(ViewClass(class.into())).with_display_name(name).with_space_origin(from.as_str());
        self.store.layout(&path, &view)?;
        for (property, value) in properties {
            self.store.layout(&under(&path, property), *value)?;
        }
        Ok(Part { path, id })
    }

    /// Several cases side by side: scenes above, what differs below.
    fn comparison(&mut self, cases: &[Rehearsal]) -> Result<Part, StoreError> {
        let scenes = cases.iter().map(|case| self.scene(case, &case.title)).collect::<Result<Vec<_>, _>>()?;
        let mut top = self.container(ContainerKind::Horizontal, "Scenes", &scenes, &vec![1.0; scenes.len()])?;
        if self.pictured {
            let pictures = cases.iter().map(|case| self.pictures(case, &case.title)).collect::<Result<Vec<_>, _>>()?;
            let pictures =
                self.container(ContainerKind::Horizontal, "Pictures", &pictures, &vec![1.0; pictures.len()])?;
            top = self.container(ContainerKind::Tabs, "", &[top, pictures], &[])?;
        }
        let axes = [-self.axes.moment, self.axes.moment];
        let moment = self.compared(cases, "Base moment n_B  N m", "moment/total", Some(axes))?;
        let b = self.compared(cases, "Pose constant b  rad", "pose/b", Some(self.axes.b))?;
        let events = self.events(cases)?;
        let bottom = self.container(ContainerKind::Horizontal, "", &[moment, b, events], &[1.2, 1.0, 1.0])?;
        self.container(ContainerKind::Vertical, "All cases", &[top, bottom], &[1.25, 1.0])
    }

    /// One case: scene left, plots right, events below.
    fn case(&mut self, case: &Rehearsal) -> Result<Part, StoreError> {
        self.tab.clone_from(&case.name);
        let mut scenes = vec![self.scene(case, "Scene")?];
        if self.pictured {
            scenes.push(self.pictures(case, "Pictures")?);
        }
        let others = [("Joint space", "joint_space", case.joints), ("Tower", "tower", case.tower)];
        for (name, path, eye) in others {
            if let Some(eye) = eye {
                scenes.push(self.drawing(name, &under(&case.root, path), &eye)?);
            }
        }
        let scene = self.container(ContainerKind::Tabs, "", &scenes, &[])?;
        let Axes { moment, force, b } = self.axes;
        let moment = Some([-moment, moment]);
        let plots = [
            self.plot(case, "Torque  N m", &["torque/**"], None)?,
            self.plot(case, "Base moment n_B  N m", &["moment/total"], moment)?,
            self.plot(case, "Base force |f_B|  N", &["force/dynamic"], Some([-0.05 * force, force]))?,
            self.plot(case, "Drive angles  rad", &["angle/**"], None)?,
            self.plot(case, "Pose constant  rad", &["pose/**"], Some(b))?,
        ];
        let plots = self.container(ContainerKind::Vertical, "Drives and base", &plots, &[1.2, 1.0, 1.0, 1.0, 1.0])?;
        let inside = self.inside(case)?;
        let plots = self.container(ContainerKind::Tabs, "", &[plots, inside], &[])?;
        let top = self.container(ContainerKind::Horizontal, "", &[scene, plots], &[1.25, 1.0])?;
        let events = self.events(std::slice::from_ref(case))?;
        let phase = self.view("StateTimeline", "Phase", &under(&case.root, "phase"), &["$origin/**".into()], &[])?;
        let bottom = self.container(ContainerKind::Horizontal, "", &[events, phase], &[1.6, 1.0])?;
        self.container(ContainerKind::Vertical, &case.title, &[top, bottom], &[3.0, 1.0])
    }

    /// Pins in one plot, what tilts the base, and how near change points are.
    fn inside(&mut self, case: &Rehearsal) -> Result<Part, StoreError> {
        let has = |path: &str| case.signals.iter().any(|s| path.split('/').next() == Some(s.group()));
        let plots = [
            ("Pin forces  N", "pin/**", 1.6),
            ("Tilting moment  N m", "tilt/**", 1.0),
            ("Transmission |sin(q_k − q_l)|", "transmission/**", 1.0),
            ("To the nearest change point  rad", "change_point/distance", 1.0),
        ];
        let (mut parts, mut shares) = (Vec::new(), Vec::new());
        for (name, signals, share) in plots.into_iter().filter(|(_, signals, _)| has(signals)) {
            parts.push(self.plot(case, name, &[signals], None)?);
            shares.push(share);
        }
        self.container(ContainerKind::Vertical, "Inside", &parts, &shares)
    }

    fn scene(&mut self, case: &Rehearsal, name: &str) -> Result<Part, StoreError> {
        let background = view::Background::new(BackgroundKind::SolidColor).with_color(colour(self.palette.background));
        let grid = view::LineGrid3D::new()
            .with_visible(true)
            .with_spacing(GridSpacing(0.1.into()))
            .with_plane(Plane3D::new([0.0, 0.0, 1.0], -0.02 * case.reach as f32))
            .with_stroke_width(0.7)
            .with_color(colour(faded(self.palette.line, 0.6)));
        let eye = eye(case.reach).controls();
        let properties: [(&str, &dyn AsComponents); 3] =
            [("Background", &background), ("LineGrid3D", &grid), ("EyeControls3D", &eye)];
        let contents = ["machine", "com", "end_effector", "target", "plan", "workspace", "reaction"];
        let contents: Vec<_> = contents.iter().map(|part| format!("$origin/{part}/**")).collect();
        self.view("3D", name, &case.root, &contents, &properties)
    }

    /// What was drawn offscreen.
    fn pictures(&mut self, case: &Rehearsal, name: &str) -> Result<Part, StoreError> {
        self.view("2D", name, &under(&case.root, "view"), &["$origin/**".into()], &[])
    }

    /// A space with axes of its own.
    fn drawing(&mut self, name: &str, origin: &EntityPath, eye: &Eye) -> Result<Part, StoreError> {
        let background = view::Background::new(BackgroundKind::SolidColor).with_color(colour(self.palette.background));
        let grid = view::LineGrid3D::new().with_visible(false);
        let eye = eye.controls();
        let properties: [(&str, &dyn AsComponents); 3] =
            [("Background", &background), ("LineGrid3D", &grid), ("EyeControls3D", &eye)];
        self.view("3D", name, origin, &["$origin/**".into()], &properties)
    }

    fn plot(
        &mut self,
        case: &Rehearsal,
        name: &str,
        signals: &[&str],
        range: Option<[f64; 2]>,
    ) -> Result<Part, StoreError> {
        let contents: Vec<_> = signals.iter().map(|s| format!("$origin/{s}")).collect();
        let name = titled(name, case, signals);
        self.time_series(&name, &under(&case.root, "signals"), &contents, range, false)
    }

    fn time_series(
        &mut self,
        name: &str,
        origin: &EntityPath,
        contents: &[String],
        range: Option<[f64; 2]>,
        legend: bool,
    ) -> Result<Part, StoreError> {
        let time = view::TimeAxis::new().with_link(LinkAxis::LinkToGlobal);
        let legend = view::PlotLegend::new().with_visible(legend).with_corner(Corner2D::LeftBottom);
        let mut properties: Vec<(&str, &dyn AsComponents)> = vec![("TimeAxis", &time), ("PlotLegend", &legend)];
        let scalar = range.map(|[low, high]| view::ScalarAxis::new().with_range(Range1D::new(low, high)));
        properties.extend(scalar.as_ref().map(|s| ("ScalarAxis", s as &dyn AsComponents)));
        self.view("TimeSeries", name, origin, contents, &properties)
    }

    /// The same signal of every case in one plot, each named by its case.
    fn compared(
        &mut self,
        cases: &[Rehearsal],
        name: &str,
        signal: &str,
        range: Option<[f64; 2]>,
    ) -> Result<Part, StoreError> {
        let paths: Vec<_> = cases.iter().map(|case| under(&case.root, &format!("signals/{signal}"))).collect();
        let contents: Vec<_> = paths.iter().map(|p| p.to_string()).collect();
        let legend = cases.len() <= LEGEND;
        let range = range.map(|range| if legend { with_room(range, cases.len()) } else { range });
        let plot = self.time_series(name, &EntityPath::root(), &contents, range, legend)?;
        for (i, (case, path)) in cases.iter().zip(&paths).enumerate() {
            let rgba = case_colour(i, case.peaks.is_reactionless(), &self.palette);
            let unit = case.signals.iter().find(|s| s.path == signal).map_or(String::new(), series_name);
            let style = SeriesLines::new()
                .with_names([format!("{} · {unit}", case.name)])
                .with_colors([colour(rgba)])
                .with_widths([1.8]);
            let base = view::ViewContents::blueprint_base_visualizer_path_for_entity(plot.id, path);
            let id = VisualizerInstructionId::new_deterministic(path, i);
            let instruction = under(&base, &id.0.to_string());
            self.store.layout(&instruction, &Both(&view::VisualizerInstruction::new("SeriesLines"), &style))?;
            self.store.layout(&base, &view::ActiveVisualizers::new([id]))?;
        }
        Ok(plot)
    }

    fn events(&mut self, cases: &[Rehearsal]) -> Result<Part, StoreError> {
        let shown = |kind, visible: bool| TextLogColumn { visible: visible.into(), kind };
        let columns = view::TextLogColumns::new()
            .with_timeline_columns([TimelineColumn { visible: true.into(), timeline: TIME.into() }])
            .with_text_log_columns([
                shown(TextLogColumnKind::EntityPath, false),
                shown(TextLogColumnKind::LogLevel, false),
                shown(TextLogColumnKind::Body, true),
            ]);
        let contents: Vec<_> = cases.iter().map(|case| under(&case.root, "events").to_string()).collect();
        self.view("TextLog", "Events", &EntityPath::root(), &contents, &[("TextLogColumns", &columns)])
    }
}

/// The title of a plot with the colours of what it shows: a legend would cover the curves of so low a plot. Of one series
/// the title says everything already, and of many the pointer tells which is which.
fn titled(name: &str, case: &Rehearsal, signals: &[&str]) -> String {
    let shown = |path: &str| signals.iter().any(|s| s.strip_suffix("**").map_or(*s == path, |of| path.starts_with(of)));
    let all: Vec<_> = case.signals.iter().filter(|signal| shown(&signal.path)).collect();
    let of_drives = all.len() == COLOURS.len() && all.iter().enumerate().all(|(k, signal)| signal.drive == Some(k));
    let words: Vec<String> = match &all[..] {
        _ if of_drives => {
            all.iter().zip(COLOURS).map(|(signal, colour)| format!("{} {colour}", signal.symbol)).collect()
        }
        [now, wanted] if wanted.path == format!("{}_reference", now.path) => {
            vec![now.symbol.clone(), format!("{} pale", wanted.symbol)]
        }
        _ => Vec::new(),
    };
    [name.to_owned()].into_iter().chain(words).collect::<Vec<_>>().join("  ·  ")
}

/// What the colours of the first drives are called.
const COLOURS: [&str; 3] = ["blue", "orange", "green"];

/// A range with room below for a legend of so many lines.
fn with_room([low, high]: [f64; 2], lines: usize) -> [f64; 2] {
    // In parts of the height of a plot, of a viewer of a usual size.
    let share = 0.05 + 0.08 * lines as f64;
    [low - share / (1.0 - share) * (high - low), high]
}

/// Where nothing is felt, the green of zero; else reds that can be told apart.
fn case_colour(i: usize, quiet: bool, palette: &Palette) -> Rgba {
    match quiet {
        true => palette.zero,
        false => mix(palette.reaction, palette.amber, 0.9 * (i % 3) as f32 / 2.0),
    }
}

/// From the front and above, so near that the arm and its workspaces fill the view.
fn eye(reach: f64) -> Eye {
    Eye::upright(Orbit { centre: [-0.12 * reach, 0.06 * reach, 0.0], distance: 1.6 * reach, yaw: 0.3, pitch: 0.95 })
}
