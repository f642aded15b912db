//! The layout with which a recording opens: scene on the left with tabs of joint space and tower, below it lanes of
//! phases and refusals, events and notes; plots on the right. Several cases are compared in a first tab, and each also
//! has a separate tab.
//!
//! Views are rows of a separate store. The builders of the SDK set neither the eye of a 3D view nor axis ranges nor
//! backgrounds, so the rows are written here.

use crate::rerun::Uuid;
use crate::rerun::blueprint::archetypes as view;
use crate::rerun::blueprint::components::VisualBounds2D;
use crate::rerun::blueprint::components::VisualizerInstructionId;
use crate::rerun::blueprint::components::{
    ActiveTab, BackgroundKind, ColumnShare, ContainerKind, Corner2D, IncludedContent, LinkAxis, LoopMode, PanelState,
    PlayState, QueryExpression, RootContainer, RowShare, ViewClass,
};
use crate::rerun::blueprint::datatypes::{TextLogColumn, TextLogColumnKind, TimelineColumn};
use crate::rerun::components::Range1D;
use crate::rerun::datatypes::Range2D;
use crate::rerun::{AsComponents, EntityPath, SeriesLines};

use super::design::FRONT_VIEW;
use super::events::{PHASE_PATH, REFUSALS_PATH};
use super::eye::Eye;
use super::hash::Hash;
use super::notes::NOTES_PATH;
use super::preview::{DESIGNS_PATH, Preview, machines_differ};
use super::store::{Store, StoreError, TIME_TIMELINE};
use super::style::{CombinedArchetypes, colour, series_name, under};
use super::ticks::with_ticks;
use super::topic::Topic;
use stillbase_mechanics::balance::Condition;
use stillbase_picture::charts::{Chart, ChartPlace};
use stillbase_picture::scene::palette::{Palette, Theme, palette};
use stillbase_simulation::signals::{Signal, group_of};

/// Writes the layout and makes the viewer open with it. `pictured` says whether there are offscreen pictures.
///
/// # Errors
/// If it cannot be written.
pub fn lay_out(store: &mut Store, cases: &[Preview], pictured: bool) -> Result<(), StoreError> {
    let mut layout =
        Layout { store, palette: palette(Theme::Dark), tab: String::new(), charts: shared(cases), pictured };
    let (mut tabs, mut active) = (Vec::new(), 0);
    if cases.len() > 1 {
        tabs.push(layout.comparison(cases)?);
    }
    for case in cases {
        let (parts, front) = match case.ranges.is_empty() {
            true => (layout.case(case, cases.len() == 1)?, usize::from(case.design.leads)),
            false => (vec![layout.assembly(case, cases.len() == 1)?], 0),
        };
        match cases {
            // A single case needs no enclosing tab.
            [_] => (tabs, active) = (parts, front),
            _ => tabs.push(layout.tabs(&case.title, &parts, front)?),
        }
    }
    layout.tab.clear();
    let root = layout.tabs("", &tabs, active)?;
    layout.open_with(&root)
}

/// Number of plots on a page of an assembly.
const PLOTS_PER_PAGE: usize = 4;

/// Returns the title of the plot of a topic of an assembly, by the name of the topic; `None` if it is not plotted.
fn title_of_topic(name: &str) -> Option<String> {
    Some(match name.split_once('/').unwrap_or((name, "")) {
        ("torque", of) => format!("Torques of {of}  N m"),
        ("pose", of) => format!("Pose constant b of {of}  rad"),
        ("force", "dynamic") => "Force on the base, from motion: x, y, z  N".into(),
        ("moment", "dynamic") => "Moment on the base, from motion: x, y, z  N m".into(),
        ("attitude", _) => "Attitude of the base: quaternion w, x, y, z".into(),
        ("base", _) => "Place of the base: x, y, z  m".into(),
        _ => return None,
    })
}

/// Widens a range so that a constant can be seen.
fn room_for([low, high]: [f64; 2]) -> [f64; 2] {
    // Below this all is rounding.
    let room = (0.05 * (high - low)).max(1e-6 * low.abs().max(high.abs())).max(1e-6);
    [low - room, high + room]
}

/// Returns the charts of all cases with common ranges, so that cases can be compared.
fn shared(cases: &[Preview]) -> Vec<(Chart, [f64; 2])> {
    let mut all: Vec<(Chart, [f64; 2])> = Vec::new();
    for (chart, [low, high]) in cases.iter().flat_map(|case| &case.charts) {
        match all.iter_mut().find(|(known, _)| known.title == chart.title) {
            Some((_, range)) => *range = [range[0].min(*low), range[1].max(*high)],
            None => all.push((*chart, [*low, *high])),
        }
    }
    // Recordings contain SI values, also where the window shows thousandths.
    all.iter_mut().for_each(|(chart, range)| *range = chart.si_span(range[0], range[1]));
    all
}

/// A view or container.
struct Part {
    path: EntityPath,
    id: Uuid,
}

struct Layout<'a> {
    store: &'a mut Store,
    palette: Palette,
    /// Name of the case of the current tab; empty for the comparison of all cases.
    tab: String,
    charts: Vec<(Chart, [f64; 2])>,
    pictured: bool,
}

/// Version and variant of a custom identifier (UUID version 8), and the mask of their bits.
const VERSION: u128 = 0x0000_0000_0000_8000_8000_0000_0000_0000;
const VERSION_BITS: u128 = 0x0000_0000_0000_f000_c000_0000_0000_0000;

/// Maximum number of conditions of (7) or (8) in a title.
const MAX_TITLE_CONDITIONS: usize = 6;

/// Maximum number of cases in a legend; more do not fit.
const MAX_LEGEND_CASES: usize = 5;

impl Layout<'_> {
    /// Makes the viewer open with a container that holds all, panels closed and time running.
    fn open_with(&mut self, root: &Part) -> Result<(), StoreError> {
        let viewport = view::ViewportBlueprint::new()
            .with_root_container(RootContainer(root.id.into()))
            .with_auto_layout(false)
            .with_auto_views(false);
        self.store.layout(&"viewport".into(), &viewport)?;
        for panel in ["selection_panel", "blueprint_panel"] {
            self.store.layout(&panel.into(), &view::PanelBlueprint::new().with_state(PanelState::Collapsed))?;
        }
        let time = view::TimePanelBlueprint::new()
            .with_state(PanelState::Collapsed)
            .with_timeline(TIME_TIMELINE)
            .with_loop_mode(LoopMode::All)
            // A layout cannot set the displayed instant; playback is on so that more than the start is shown.
            .with_play_state(PlayState::Playing);
        self.store.layout(&"time_panel".into(), &time)?;
        self.store.activate_layout()
    }

    /// Returns the identifier of a view or container, a hash of its class, its tab and `words`. A viewer
    /// stores the state of a view by its identifier, even across recordings, and shows nothing if the stored class
    /// differs.
    fn id(&self, class: &str, words: &[&str]) -> Uuid {
        let mut hash = Hash::default();
        [class, &self.tab].iter().chain(words).for_each(|word| hash.add(word));
        Uuid::from_u128(hash.number() & !VERSION_BITS | VERSION)
    }

    /// Adds a container of tabs; `front` is the index of the active tab.
    fn tabs(&mut self, name: &str, parts: &[Part], front: usize) -> Result<Part, StoreError> {
        self.parted(ContainerKind::Tabs, name, parts, &[], front)
    }

    fn container(
        &mut self,
        kind: ContainerKind,
        name: &str,
        parts: &[Part],
        shares: &[f32],
    ) -> Result<Part, StoreError> {
        self.parted(kind, name, parts, shares, 0)
    }

    /// Adds a container; `shares` are the relative sizes of its parts, `front` is the index of the active tab.
    fn parted(
        &mut self,
        kind: ContainerKind,
        name: &str,
        parts: &[Part],
        shares: &[f32],
        front: usize,
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
            ContainerKind::Tabs | ContainerKind::Grid => match parts.get(front) {
                Some(front) => container.with_active_tab(ActiveTab(front.path.to_string().into())),
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
        // Charts of one case can have the same entities, so the name is part of the identifier.
        let words: Vec<&str> = [name, from.as_str()].into_iter().chain(contents.iter().map(String::as_str)).collect();
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

    /// Adds the comparison of several cases, with scenes above, and plots, machines and events below.
    fn comparison(&mut self, cases: &[Preview]) -> Result<Part, StoreError> {
        let eyes = beside_each_other(cases);
        let scenes = cases.iter().zip(&eyes).map(|(case, eye)| self.scene(case, &case.title, eye));
        let scenes = scenes.collect::<Result<Vec<_>, _>>()?;
        let mut top = self.container(ContainerKind::Horizontal, "Scenes", &scenes, &vec![1.0; scenes.len()])?;
        if self.pictured {
            let pictures = cases.iter().map(|case| self.pictures(case, &case.title)).collect::<Result<Vec<_>, _>>()?;
            let pictures =
                self.container(ContainerKind::Horizontal, "Pictures", &pictures, &vec![1.0; pictures.len()])?;
            top = self.container(ContainerKind::Tabs, "", &[top, pictures], &[])?;
        }
        let compared: Vec<_> = self.charts.iter().filter(|(chart, _)| chart.is_overlaid).copied().collect();
        let mut below = Vec::new();
        for (chart, range) in compared {
            below.push(self.compared(cases, &chart, range)?);
        }
        if machines_differ(cases) {
            below.push(self.document("Machines side by side", &EntityPath::from(DESIGNS_PATH))?);
        }
        let said = [self.events(cases)?, self.lanes(cases)?];
        below.push(self.container(ContainerKind::Tabs, "", &said, &[])?);
        let bottom = self.container(ContainerKind::Horizontal, "", &below, &vec![1.0; below.len()])?;
        self.container(ContainerKind::Vertical, "All cases", &[top, bottom], &[1.25, 1.0])
    }

    /// Adds the motion of one case, with its scene, lanes and events on the left and plots on the right, and its design.
    fn case(&mut self, case: &Preview, alone: bool) -> Result<Vec<Part>, StoreError> {
        self.tab.clone_from(&case.name);
        let mut scenes = vec![self.scene(case, "Scene", &case.scene)?];
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
        let one = std::slice::from_ref(case);
        let lanes = self.lanes(one)?;
        let said = [self.events(one)?, self.document("Notes and equations", &under(&case.root, NOTES_PATH))?];
        let said = self.container(ContainerKind::Tabs, "", &said, &[])?;
        let left = self.container(ContainerKind::Vertical, "", &[scene, lanes, said], &[3.1, 0.95, 1.0])?;
        let mut pages = Vec::new();
        for (name, holds) in PAGES {
            pages.extend(self.plots(case, name, holds)?);
        }
        let plots = self.container(ContainerKind::Tabs, "", &pages, &[])?;
        let name = if alone { &case.title } else { "Motion" };
        let motion = self.container(ContainerKind::Horizontal, name, &[left, plots], &[1.25, 1.0])?;
        Ok(vec![motion, self.design(case)?])
    }

    /// Adds an assembly: scene, notes and events on the left, plots on the right.
    fn assembly(&mut self, case: &Preview, alone: bool) -> Result<Part, StoreError> {
        self.tab.clone_from(&case.name);
        let contents = ["$origin/**", "- $origin/signals/**", "- $origin/notes/**"].map(String::from);
        let mut scenes = vec![self.space("Scene", &case.root, &contents, &case.scene)?];
        if self.pictured {
            scenes.push(self.pictures(case, "Pictures")?);
        }
        let scene = self.container(ContainerKind::Tabs, "", &scenes, &[])?;
        let one = std::slice::from_ref(case);
        let said = [self.document("Notes", &under(&case.root, NOTES_PATH))?, self.events(one)?, self.lanes(one)?];
        let said = self.container(ContainerKind::Tabs, "", &said, &[])?;
        let left = self.container(ContainerKind::Vertical, "", &[scene, said], &[2.6, 1.0])?;
        let topics = case.topics.iter().zip(&case.ranges);
        let mut shown: Vec<_> =
            topics.filter_map(|(topic, range)| Some((title_of_topic(&topic.name)?, topic, *range))).collect();
        // What the base feels comes first.
        let is_of_base = |topic: &Topic| topic.signals.iter().all(Signal::is_of_shared_base);
        shown.sort_by_key(|(_, topic, _)| !is_of_base(topic));
        let mut pages = Vec::new();
        for (i, plots) in shown.chunks(PLOTS_PER_PAGE).enumerate() {
            let mut parts = Vec::new();
            for (title, topic, range) in plots {
                let range = with_ticks(room_for(*range), plots.len());
                let contents = ["$origin/**".to_owned()];
                parts.push(self.time_series(title, &topic.path(&case.root), &contents, Some(range), false)?);
            }
            let name = if i == 0 { "Base and drives".to_owned() } else { format!("More {}", i + 1) };
            pages.push(self.container(ContainerKind::Vertical, &name, &parts, &vec![1.0; parts.len()])?);
        }
        let plots = self.container(ContainerKind::Tabs, "", &pages, &[])?;
        let name = if alone { &case.title } else { "Motion" };
        self.container(ContainerKind::Horizontal, name, &[left, plots], &[1.25, 1.0])
    }

    /// Adds the design of the machine: a drawing to scale, its masses and measures, and the residuals of (7) and (8).
    fn design(&mut self, case: &Preview) -> Result<Part, StoreError> {
        let (root, design) = (under(&case.root, "design"), &case.design);
        let shown = ["machine", "marks", "grid"].map(|part| format!("$origin/{part}/**"));
        let mut left = vec![self.space("Machine to scale, discs in kg", &root, &shown, &design.eye)?];
        if design.fronts.is_some() {
            left.push(self.front(&under(&root, "front"))?);
        }
        let left = self.container(ContainerKind::Vertical, "", &left, &[1.6, 1.0][..left.len()])?;
        let state = self.document("What it comes to", &under(&root, "state"))?;
        let links = self.document("Links and counterweights", &under(&root, "links"))?;
        let top = self.container(ContainerKind::Horizontal, "", &[state, links], &[1.0, 1.08])?;
        let table = self.document("Balance: what each link brings to (7) and (8)", &under(&root, "balance"))?;
        let mut bars = vec![self.bars("(7)  force", design.drives(), true, &under(&root, "bars/force"))?];
        if design.drives() > 1 {
            bars.push(self.bars("(8)  coupling", design.drives(), false, &under(&root, "bars/coupling"))?);
        }
        let bars = self.container(ContainerKind::Horizontal, "", &bars, &vec![1.0; bars.len()])?;
        let right = self.container(ContainerKind::Vertical, "", &[top, table, bars], &[1.25, 1.0, 0.62])?;
        self.container(ContainerKind::Horizontal, "Design", &[left, right], &[1.0, 1.3])
    }

    fn document(&mut self, name: &str, origin: &EntityPath) -> Result<Part, StoreError> {
        self.view("TextDocument", name, origin, &["$origin/**".into()], &[])
    }

    /// Adds the bar chart of (7) if `force`, otherwise of (8).
    fn bars(&mut self, name: &str, drives: usize, force: bool, origin: &EntityPath) -> Result<Part, StoreError> {
        let of = Condition::all(drives).filter(|c| matches!(c, Condition::Force(_)) == force);
        let lines: Vec<_> = of.collect();
        let symbols: Vec<String> = lines.iter().take(MAX_TITLE_CONDITIONS).map(|line| line.symbol(drives)).collect();
        let more = if lines.len() > MAX_TITLE_CONDITIONS { " …" } else { "" };
        let unit = lines.first().map_or("", |line| line.unit());
        let name = format!("{name}  {}{more}  {unit}, white: sum of all links", symbols.join(" "));
        let legend = view::PlotLegend::new().with_visible(false);
        self.view("BarChart", &name, origin, &["$origin/**".into()], &[("PlotLegend", &legend)])
    }

    /// Adds the Pareto front of added mass and inertia.
    fn front(&mut self, origin: &EntityPath) -> Result<Part, StoreError> {
        let background = view::Background::new(BackgroundKind::SolidColor).with_color(colour(self.palette.background));
        let [left, top, right, bottom] = FRONT_VIEW;
        let bounds = view::VisualBounds2D::new(VisualBounds2D(Range2D {
            x_range: Range1D::new(left, right).0,
            y_range: Range1D::new(top, bottom).0,
        }));
        let name = "Counterweights; amber: this machine; below the curve none is balanced";
        let properties: [(&str, &dyn AsComponents); 2] = [("Background", &background), ("VisualBounds2D", &bounds)];
        self.view("2D", name, origin, &["$origin/**".into()], &properties)
    }

    /// Adds the charts of a case on one page, one below the other; `None` if there are none.
    fn plots(
        &mut self,
        case: &Preview,
        name: &str,
        holds: fn(&Chart, &str) -> bool,
    ) -> Result<Option<Part>, StoreError> {
        let is_here = |chart: &&Chart| chart.place != ChartPlace::Compared && holds(chart, group_of(chart.signals[0]));
        let charts: Vec<&Chart> = case.charts.iter().map(|(chart, _)| chart).filter(is_here).collect();
        let mut parts = Vec::new();
        for chart in &charts {
            parts.push(self.plot(case, chart, charts.len())?);
        }
        let page = |parts: Vec<Part>| self.container(ContainerKind::Vertical, name, &parts, &vec![1.0; parts.len()]);
        Some(parts).filter(|parts| !parts.is_empty()).map(page).transpose()
    }

    fn range_of(&self, chart: &Chart) -> Option<[f64; 2]> {
        self.charts.iter().find(|(known, _)| known.title == chart.title).map(|(_, range)| *range)
    }

    fn scene(&mut self, case: &Preview, name: &str, eye: &Eye) -> Result<Part, StoreError> {
        let background = view::Background::new(BackgroundKind::SolidColor).with_color(colour(self.palette.background));
        // The scene contains its own grid.
        let grid = view::LineGrid3D::new().with_visible(false);
        let eye = eye.controls();
        let properties: [(&str, &dyn AsComponents); 3] =
            [("Background", &background), ("LineGrid3D", &grid), ("EyeControls3D", &eye)];
        // All entities of the case except those with views of their own.
        let others = ["signals", "events", PHASE_PATH, REFUSALS_PATH, "view", "joint_space", "tower", "design"];
        let without = others.iter().map(|part| format!("- $origin/{part}/**"));
        let contents: Vec<_> = ["$origin/**".to_owned()].into_iter().chain(without).collect();
        self.view("3D", name, &case.root, &contents, &properties)
    }

    /// Adds the view of the offscreen pictures.
    fn pictures(&mut self, case: &Preview, name: &str) -> Result<Part, StoreError> {
        self.view("2D", name, &under(&case.root, "view"), &["$origin/**".into()], &[])
    }

    /// Adds a 3D view of all entities under an origin.
    fn drawing(&mut self, name: &str, origin: &EntityPath, eye: &Eye) -> Result<Part, StoreError> {
        self.space(name, origin, &["$origin/**".into()], eye)
    }

    /// Adds a 3D view of some entities under an origin, seen from an eye.
    fn space(&mut self, name: &str, origin: &EntityPath, contents: &[String], eye: &Eye) -> Result<Part, StoreError> {
        let background = view::Background::new(BackgroundKind::SolidColor).with_color(colour(self.palette.background));
        let grid = view::LineGrid3D::new().with_visible(false);
        let eye = eye.controls();
        let properties: [(&str, &dyn AsComponents); 3] =
            [("Background", &background), ("LineGrid3D", &grid), ("EyeControls3D", &eye)];
        self.view("3D", name, origin, contents, &properties)
    }

    /// Adds the plot of a chart, one of `rows` on its page; other series of the same entities are hidden.
    fn plot(&mut self, case: &Preview, chart: &Chart, rows: usize) -> Result<Part, StoreError> {
        let held = |topic: &&Topic| topic.signals.iter().any(|signal| chart.contains(signal));
        let topics: Vec<_> = case.topics.iter().filter(held).collect();
        let is_shown = |topic: &Topic, (i, _): &(usize, f64)| chart.contains(&topic.signals[*i]);
        let limited = |topic: &&&Topic| topic.limits.iter().any(|limit| is_shown(topic, limit));
        let limits = topics.iter().filter(limited).map(|topic| format!("$origin/{}/limits", topic.name));
        let contents: Vec<_> = topics.iter().map(|topic| format!("$origin/{}", topic.name)).chain(limits).collect();
        let range = self.range_of(chart).map(|range| with_ticks(range, rows));
        let plot = self.time_series(&titled(chart, case), &under(&case.root, "signals"), &contents, range, false)?;
        for topic in topics {
            let shown: Vec<bool> = topic.signals.iter().map(|signal| chart.contains(signal)).collect();
            if shown.contains(&false) {
                let style = SeriesLines::update_fields().with_visible_series(shown);
                self.draw_as(&plot, &topic.path(&case.root), &style)?;
            }
            let shown: Vec<bool> = topic.limits.iter().flat_map(|limit| [is_shown(topic, limit); 2]).collect();
            if shown.contains(&true) && shown.contains(&false) {
                let style = SeriesLines::update_fields().with_visible_series(shown);
                self.draw_as(&plot, &topic.limits_path(&case.root), &style)?;
            }
        }
        Ok(plot)
    }

    /// Sets the style of the series of an entity in a plot. Which of its components are drawn as series the viewer
    /// chooses, as in plots without such a style.
    fn draw_as(&mut self, plot: &Part, path: &EntityPath, style: &SeriesLines) -> Result<(), StoreError> {
        let base = view::ViewContents::blueprint_base_visualizer_path_for_entity(plot.id, path);
        let id = VisualizerInstructionId::new_deterministic(path, 0);
        let instruction = under(&base, &id.0.to_string());
        self.store.layout(&instruction, &CombinedArchetypes(&[&view::VisualizerInstruction::new("SeriesLines"), style]))
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

    /// Adds a plot of one signal for all cases, with series named by case.
    fn compared(&mut self, cases: &[Preview], chart: &Chart, range: [f64; 2]) -> Result<Part, StoreError> {
        let of = |case: &Preview| case.topics.iter().find(|topic| topic.name == chart.signals[0]).cloned();
        // Each case keeps its colour, also where others have no such signal.
        let topics: Vec<_> = cases.iter().enumerate().filter_map(|(i, case)| Some((i, case, of(case)?))).collect();
        let contents: Vec<_> = topics.iter().map(|(_, case, topic)| topic.path(&case.root).to_string()).collect();
        let legend = cases.len() <= MAX_LEGEND_CASES;
        let range = if legend { with_legend_space(range, cases.len()) } else { range };
        // These plots take the lower half of the window.
        let range = with_ticks(range, 2);
        let plot = self.time_series(&name_of(chart), &EntityPath::root(), &contents, Some(range), legend)?;
        for (i, case, topic) in &topics {
            let style = SeriesLines::new()
                .with_names(topic.signals.iter().map(|signal| format!("{} · {}", case.name, series_name(signal))))
                .with_colors([colour(self.palette.run(*i))])
                .with_widths([1.8]);
            self.draw_as(&plot, &topic.path(&case.root), &style)?;
        }
        Ok(plot)
    }

    /// Adds the lanes of phases and refusals.
    fn lanes(&mut self, cases: &[Preview]) -> Result<Part, StoreError> {
        let lanes = cases.iter().flat_map(|case| [PHASE_PATH, REFUSALS_PATH].map(|lane| under(&case.root, lane)));
        let contents: Vec<_> = lanes.map(|lane| lane.to_string()).collect();
        self.view("StateTimeline", "Phases and refusals", &EntityPath::root(), &contents, &[])
    }

    fn events(&mut self, cases: &[Preview]) -> Result<Part, StoreError> {
        let shown = |kind, visible: bool| TextLogColumn { visible: visible.into(), kind };
        let columns = view::TextLogColumns::new()
            .with_timeline_columns([TimelineColumn { visible: true.into(), timeline: TIME_TIMELINE.into() }])
            .with_text_log_columns([
                shown(TextLogColumnKind::EntityPath, false),
                shown(TextLogColumnKind::LogLevel, false),
                shown(TextLogColumnKind::Body, true),
            ]);
        let contents: Vec<_> = cases.iter().map(|case| under(&case.root, "events").to_string()).collect();
        self.view("TextLog", "Events", &EntityPath::root(), &contents, &[("TextLogColumns", &columns)])
    }
}

/// Whether a chart of a group belongs to a page.
type IsOfPage = fn(&Chart, &str) -> bool;

/// Pages of plots: their names, and which charts stand on them, by chart and group of its first signal. The fewer stand
/// on a page, the more numbers fit beside their axes.
const PAGES: [(&str, IsOfPage); 4] = [
    ("Torque and base", |chart, group| is_beside(chart) && is_load(group)),
    ("Motion", |chart, group| is_beside(chart) && !is_load(group)),
    ("Pins and tilt", |chart, group| !is_beside(chart) && ["pin", "tilt"].contains(&group)),
    ("Transmission", |chart, group| !is_beside(chart) && !["pin", "tilt"].contains(&group)),
];

fn is_beside(chart: &Chart) -> bool {
    chart.place == ChartPlace::Beside
}

fn is_load(group: &str) -> bool {
    ["torque", "moment", "force"].contains(&group)
}

/// Width and height of what a viewer of usual size shows of the scenes of several cases, in any unit.
const SCENES_SIZE: [f64; 2] = [1400.0, 430.0];

/// Returns eyes of scenes that stand beside each other. Cases of one machine are seen from one place, so that they can be
/// compared; otherwise each machine fills its scene.
fn beside_each_other(cases: &[Preview]) -> Vec<Eye> {
    let [width, height] = SCENES_SIZE;
    let aspect = width / cases.len().max(1) as f64 / height;
    let eye = |of: &[Preview]| {
        let extent = of.iter().flat_map(|case| &case.extent).copied().collect::<Vec<_>>();
        of[0].scene.filled(&extent, aspect)
    };
    match machines_differ(cases) {
        true => cases.iter().map(|case| eye(std::slice::from_ref(case))).collect(),
        false => vec![eye(cases); cases.len()],
    }
}

/// Returns title and unit of a chart.
fn name_of(chart: &Chart) -> String {
    [chart.title, &chart.si_unit()].join("  ").trim_end().to_owned()
}

/// Returns the title of a plot, with symbol and colour of each series if there is one per drive, at most four. A legend
/// would cover the curves, as the plot is not high. With many series, the viewer names the series under the pointer.
fn titled(chart: &Chart, case: &Preview) -> String {
    let signals = case.topics.iter().flat_map(|topic| &topic.signals);
    let all: Vec<_> = signals.filter(|signal| chart.contains(signal)).collect();
    let of_drives = all.len() > 1 && all.iter().enumerate().all(|(k, signal)| signal.drive == Some(k));
    let of_drives = of_drives && all.len() <= COLOURS.len();
    let words = all.iter().zip(COLOURS).map(|(signal, colour)| format!("{} {colour}", signal.symbol));
    let words: Vec<String> = if of_drives { words.collect() } else { Vec::new() };
    [name_of(chart)].into_iter().chain(words).collect::<Vec<_>>().join("  ·  ")
}

/// Names of the colours of the first drives.
const COLOURS: [&str; 4] = ["blue", "orange", "green", "violet"];

/// Extends a range downwards by the space for a legend of `lines` lines.
fn with_legend_space([low, high]: [f64; 2], lines: usize) -> [f64; 2] {
    // Fraction of the height of a plot, in a viewer of usual size.
    let share = 0.04 + 0.065 * lines as f64;
    [low - share / (1.0 - share) * (high - low), high]
}
