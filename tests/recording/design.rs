//! The design of a machine in its recording: in front where it is what the scenario is about, and each state of it.

use super::*;
use stillbase::mechanics::balance::Condition;
use stillbase::mechanics::counterweights::{
    CounterweightSite, CounterweightSpec, CounterweightStock, Objective, place_weights,
};
use stillbase::mechanics::machine::{Inertia, builtin};
use stillbase::session::{DesignVersion, designs};

/// A session that changes its machine four times before it begins and once in motion, there in a drag of three steps.
fn session() -> Scenario {
    let mut scenario = short("nine-link-bare");
    let weights: toml::Table = toml::from_str(
        "counterweight = [{ link = '1', mass = 7.2, at = -0.2, radius = 0.1 }, { link = '5', mass = 1.1, at = -0.3 }]",
    )
    .expect("a table");
    let at = |step, edit| TimedEdit { step, edit };
    scenario.edits = vec![
        at(0, Edit::set("link.5.com", -0.02)),
        at(0, Edit::set("task.time", 1.2)),
        at(0, Edit::set("link.1.mass", 0.8)),
        at(0, Edit::Set { change: weights }),
        at(0, Edit::set("counterweight.1.mass", 5.0)),
        at(40, Edit::set("link.3.com", 0.09)),
        at(41, Edit::set("link.3.com", 0.07)),
        at(60, Edit::set("link.3.com", 0.05)),
    ];
    scenario
}

/// The nine bars with the counterweights of least inertia, on a plane that reaches both ends.
fn heavy() -> Scenario {
    let bare = builtin("nine-link-bare").expect("built in");
    let asked =
        CounterweightSpec::least(Objective::inertia(), CounterweightSite::anywhere(bare), CounterweightStock::STEEL);
    let mut scenario = short("nine-link-bare");
    scenario.machine = place_weights(bare, &asked).expect("it can be balanced").machine;
    scenario.task.b = 3.4;
    scenario
}

/// What the outermost tabs of a layout are called, and which of them is in front.
fn front(contents: &Contents) -> (Vec<String>, usize) {
    let layouts = contents.stores.iter().filter(|(id, _)| id.kind() == StoreKind::Blueprint);
    let chunks: Vec<&Chunk> = layouts.flat_map(|(_, chunks)| chunks).collect();
    let texts = |path: &str, component: &'static str| -> Vec<String> {
        let of = chunks.iter().filter(|chunk| chunk.entity_path().to_string() == path);
        let columns = of.filter_map(|chunk| chunk.components().get_array(component.into()));
        let flat = columns.filter_map(|column| column.values().as_any().downcast_ref::<StringArray>().cloned());
        flat.flat_map(|words| words.iter().flatten().map(str::to_owned).collect::<Vec<_>>()).collect()
    };
    let named = |chunk: &&&Chunk| texts(&chunk.entity_path().to_string(), "ContainerBlueprint:display_name");
    let design =
        chunks.iter().find(|chunk| named(chunk) == ["Design"]).expect("a tab Design").entity_path().to_string();
    let holder = chunks.iter().find(|chunk| {
        let path = chunk.entity_path().to_string();
        texts(&path, "ContainerBlueprint:contents").contains(&design)
    });
    let holder = holder.expect("tabs").entity_path().to_string();
    let parts = texts(&holder, "ContainerBlueprint:contents");
    let active = texts(&holder, "ContainerBlueprint:active_tab");
    let names = parts.iter().map(|part| texts(part, "ContainerBlueprint:display_name").join(" "));
    (names.collect(), parts.iter().position(|part| *part == active[0]).expect("one of them is in front"))
}

#[test]
fn the_design_is_in_front_where_it_is_what_the_scenario_is_about() {
    let folder = Folder::new("in-front");
    let heavy = heavy();
    let mut aside = short("case-3");
    aside.edits = vec![TimedEdit { step: 0, edit: Edit::set("task.time", 1.1) }];
    for (name, scenario, want) in
        [("plain", short("case-3"), 0), ("aside", aside, 0), ("heavy", heavy, 1), ("session", session(), 1)]
    {
        let file = format!("{name}.rrd");
        record_in(&folder, &file, std::slice::from_ref(&scenario)).expect("recorded");
        let contents = Contents::of(&folder.path(&file));
        let (tabs, active) = front(&contents);
        assert_eq!((&tabs[..], active), (&[scenario.title.clone(), "Design".into()][..], want), "{name}");
        let root = format!("/{}/design", scenario.name);
        assert_eq!(contents.holds(&format!("{root}/front/curve")), want == 1, "{name}");
        // Only a session that changes its machine has states to step through.
        let mut timelines = contents.recording().iter().flat_map(|chunk| chunk.timelines().keys().copied());
        assert_eq!(timelines.any(|name| name == TimelineName::from("edit")), name == "session", "{name}");
    }
    let both = [short("case-1"), session()];
    record_in(&folder, "both.rrd", &both).expect("two cases");
    let (tabs, active) = front(&Contents::of(&folder.path("both.rrd")));
    assert_eq!((&tabs[..], active), (&["Motion".to_owned(), "Design".into()][..], 0), "the first of them is case 1");
    // Two machines are set side by side; one needs no table for that.
    let told = |file: &str| Contents::of(&folder.path(file)).texts("/comparison/designs", "TextDocument:text");
    assert!(told("both.rrd").iter().any(|table| table.contains("added") && table.contains("worst (7)")));
    record_in(&folder, "same.rrd", &[short("case-1"), short("case-3")]).expect("two cases");
    assert!(told("same.rrd").is_empty());
}

/// Rows of an entity on the time line of edits: numbers of the changes, steps, and the values of a component.
fn states<T>(
    contents: &Contents,
    path: &str,
    component: &'static str,
    read: impl Fn(&dyn Array) -> T,
) -> Vec<(i64, i64, T)> {
    let moving = contents.at(path).into_iter().filter(|c| !c.is_static());
    let mut rows = Vec::new();
    for chunk in moving {
        let Some(column) = chunk.components().get_array(component.into()) else { continue };
        let times = |name| chunk.timelines()[&TimelineName::from(name)].times_raw();
        for (i, (edit, step)) in times("edit").iter().zip(times("step")).enumerate() {
            rows.push((*edit, *step, read(&*column.value(i))));
        }
    }
    rows
}

#[test]
fn every_state_of_a_session_is_a_row() {
    let folder = Folder::new("states");
    let scenario = session();
    record_in(&folder, "session.rrd", std::slice::from_ref(&scenario)).expect("recorded");
    let contents = Contents::of(&folder.path("session.rrd"));
    let root = "/nine-link-bare/design";
    let text = |values: &dyn Array| values.as_any().downcast_ref::<StringArray>().expect("text").value(0).to_owned();
    let said = states(&contents, &format!("{root}/state"), "TextDocument:text", text);
    let steps: Vec<(i64, i64)> = said.iter().map(|(edit, step, _)| (*edit, *step)).collect();
    assert_eq!(steps, [(0, 0), (1, 0), (2, 0), (3, 0), (4, 0), (5, 60)], "the drag is one change");
    for (i, words) in [
        "Before 5 changes",
        "centre of mass along link 5",
        "mass of link 1",
        "8.30 kg on 2 links",
        "mass of counterweight 1 to 5 kg",
    ]
    .into_iter()
    .enumerate()
    {
        assert!(said[i].2.contains(words), "{words:?} in {:?}", said[i].2);
    }
    let all: Vec<DesignVersion> = designs(&scenario).expect("states");
    let run = replay(&scenario, |_, _| {}).expect("it runs");
    assert_eq!(all.last().expect("the last").machine, run.scenario().machine, "the last is what the run ends with");
    // What links bring sums to what is left of each line.
    for (kind, lines) in [("force", 3), ("coupling", 3)] {
        let tensor = |values: &dyn Array| tensor_values(values);
        let parts: Vec<_> = (1..=3)
            .map(|k| states(&contents, &format!("{root}/bars/{kind}/drive_{k}"), "BarChart:values", tensor))
            .collect();
        for state in &all {
            let inertia = Inertia::of(&state.machine);
            let at = state.changes as i64;
            // Rows that say nothing new are left out.
            let now = |rows: &Vec<(i64, i64, Vec<f64>)>| {
                rows.iter().rfind(|(edit, ..)| *edit <= at).expect("a row").2.clone()
            };
            let of_kind = Condition::all(3).filter(|c| matches!(c, Condition::Force(_)) == (kind == "force"));
            for (line, condition) in of_kind.enumerate() {
                let sum = |values: Vec<f64>| {
                    let each = values.len() / lines;
                    values[line * each..(line + 1) * each].iter().sum::<f64>()
                };
                let sum: f64 = parts.iter().map(now).map(sum).sum();
                let left = condition.residual(&inertia).re;
                assert!((sum - left).abs() < 1e-12, "{kind} {line} after {at} changes: {sum} is not {left}");
            }
        }
    }
    // The discs that are drawn: none before the third change, then two with what they weigh.
    let labels = |values: &dyn Array| {
        let words = values.as_any().downcast_ref::<StringArray>().expect("words");
        words.iter().flatten().map(str::to_owned).collect::<Vec<_>>()
    };
    let discs = states(&contents, &format!("{root}/marks/weights/kg"), "Points3D:labels", labels);
    let discs: Vec<_> = discs.iter().map(|(edit, _, words)| (*edit, words.join(" "))).collect();
    assert_eq!(discs, [(3, "7.20 1.10".to_owned()), (4, "5.00 1.10".to_owned())]);
}

/// The numbers of a tensor of one row.
pub fn tensor_values(values: &dyn Array) -> Vec<f64> {
    use re_sdk_types::Loggable as _;
    let tensors = re_sdk_types::components::TensorData::from_arrow(values).expect("a tensor");
    let buffer = &tensors.first().expect("one").0.buffer;
    match buffer {
        re_sdk_types::datatypes::TensorBuffer::F64(numbers) => numbers.to_vec(),
        other => panic!("{other:?}"),
    }
}

/// The machine of least inertia is the end of its own front, and nothing on that is better in both.
#[test]
fn the_machine_stands_on_its_front() {
    let folder = Folder::new("front");
    let scenario = heavy();
    record_in(&folder, "heavy.rrd", std::slice::from_ref(&scenario)).expect("recorded");
    let contents = Contents::of(&folder.path("heavy.rrd"));
    let places = |path: &str| -> Vec<[f32; 2]> {
        let columns =
            contents.at(path).into_iter().filter_map(|c| c.components().get_array("Points2D:positions".into()));
        let flat = columns.flat_map(|column| {
            let list = column.values().as_any().downcast_ref::<FixedSizeListArray>().expect("places").clone();
            list.values().as_any().downcast_ref::<Float32Array>().expect("numbers").values().to_vec()
        });
        flat.collect::<Vec<_>>().chunks_exact(2).map(|p| [p[0], p[1]]).collect()
    };
    let machines = places("/nine-link-bare/design/front/machines");
    let now = places("/nine-link-bare/design/front/now");
    assert!(machines.len() > 5 && now.len() == 1, "{machines:?}, {now:?}");
    // To the right is heavier; y points down.
    assert!(machines.windows(2).all(|p| p[1][0] > p[0][0] && p[1][1] > p[0][1]), "{machines:?}");
    // Within a millionth of the least inertia, the end of the front is as light as it can be.
    let [x, y] = [0, 1].map(|i| (machines[machines.len() - 1][i] - now[0][i]).abs());
    assert!(x < 1e-2 && y < 1e-3, "{machines:?} ends at {now:?}");
}
