//! Recordings, read back with Rerun's own decoder and compared with the frames of the run.

mod assembly;
mod design;
mod events;
mod family;
mod file;
mod geometry;
mod layout;
mod pictures;
mod planes;
mod signals;
mod window;

use std::collections::{BTreeMap, BTreeSet};
#[cfg(feature = "cli")]
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::path::PathBuf;

use arrow::array::{
    Array, BooleanArray, FixedSizeListArray, Float32Array, Float64Array, ListArray, StringArray, UInt32Array,
};
use re_chunk::Chunk;
use re_log_encoding::DecoderApp;
use re_log_types::{EntityPath, LogMsg, StoreId, StoreKind, TimelineName};
use stillbase::files::WriteError;
use stillbase::mechanics::planar::{Vector, unit};
use stillbase::planning::timing::TimeLaw;
use stillbase::recording::{Options, Pictures, RecordError, Recording, RecordingProgress, record};
use stillbase::session::scenario::Scenario;
use stillbase::session::{Edit, TimedEdit, replay};
use stillbase::simulation::frame::Frame;
use stillbase::simulation::signals::{Signal, signals};

use crate::folder::Folder;

/// Everything in a file, store by store.
struct Contents {
    stores: BTreeMap<StoreId, Vec<Chunk>>,
    activated: usize,
}

impl Contents {
    fn of(file: &std::path::Path) -> Self {
        let reader = std::io::BufReader::new(std::fs::File::open(file).expect("the recording"));
        let mut contents = Self { stores: BTreeMap::new(), activated: 0 };
        for message in DecoderApp::decode_lazy(reader) {
            match message.expect("a message") {
                LogMsg::SetStoreInfo(info) => _ = contents.stores.insert(info.info.store_id, Vec::new()),
                LogMsg::ArrowMsg(store, message) => {
                    let chunk = Chunk::from_arrow_msg(&message).expect("a chunk");
                    contents.stores.get_mut(&store).expect("a store that was announced").push(chunk);
                }
                LogMsg::BlueprintActivationCommand(_) => contents.activated += 1,
            }
        }
        contents
    }

    fn recording(&self) -> &[Chunk] {
        let mut recordings = self.stores.iter().filter(|(id, _)| id.kind() == StoreKind::Recording);
        let (id, chunks) = recordings.next().expect("a recording");
        assert!(recordings.next().is_none(), "one recording");
        assert_eq!(id.application_id().as_str(), "stillbase");
        chunks
    }

    fn at(&self, path: &str) -> Vec<&Chunk> {
        let path = EntityPath::from(path);
        self.recording().iter().filter(|c| *c.entity_path() == path).collect()
    }

    /// A series of a case by its name: its entity, and which of that entity's series it is.
    fn series(&self, case: &str, signal: &Signal) -> (String, usize) {
        let name = match signal.unit {
            "1" => signal.symbol.clone(),
            unit => format!("{} {unit}", signal.symbol),
        };
        let under = format!("/{case}/signals/");
        let paths: BTreeSet<String> = self.recording().iter().map(|chunk| chunk.entity_path().to_string()).collect();
        let mut found = paths.into_iter().filter(|path| path.starts_with(&under)).flat_map(|path| {
            let names = self.texts(&path, "SeriesLines:names");
            let places = names.iter().enumerate().filter(|(_, known)| **known == name).map(|(k, _)| k);
            places.map(|k| (path.clone(), k)).collect::<Vec<_>>()
        });
        let one = found.next().unwrap_or_else(|| panic!("{name} of {case}"));
        assert_eq!(found.next(), None, "{name} of {case} is one series");
        one
    }

    /// Steps, times and values of a signal of a case, row by row.
    fn signal(&self, case: &str, signal: &Signal) -> (Vec<i64>, Vec<i64>, Vec<f64>) {
        let (path, k) = self.series(case, signal);
        let width = self.texts(&path, "SeriesLines:names").len();
        let moving = self.at(&path).into_iter().filter(|c| !c.is_static());
        let (mut steps, mut nanos, mut values) = (Vec::new(), Vec::new(), Vec::new());
        for chunk in moving {
            steps.extend_from_slice(chunk.timelines()[&TimelineName::from("step")].times_raw());
            nanos.extend_from_slice(chunk.timelines()[&TimelineName::from("sim_time")].times_raw());
            let column = chunk.components().get_array("Scalars:scalars".into()).expect("scalars");
            let flat = column.values().as_any().downcast_ref::<Float64Array>().expect("numbers");
            assert!(column.offsets().lengths().all(|length| length == width), "a number of each series in a row");
            values.extend(flat.values().iter().skip(k).step_by(width));
        }
        (steps, nanos, values)
    }

    /// Points of strips, or places, of an entity: row by row, strip by strip.
    fn strips(&self, path: &str) -> Vec<Vec<[f32; 3]>> {
        let columns = self.at(path).into_iter().filter_map(|c| c.components().get_array("LineStrips3D:strips".into()));
        columns
            .flat_map(|rows| {
                let strips = rows.values();
                let strips = strips.as_any().downcast_ref::<ListArray>().expect("strips").clone();
                (0..strips.len()).map(|i| vectors(&strips.value(i))).collect::<Vec<_>>()
            })
            .collect()
    }

    /// All vectors of a component of an entity, whatever the rows, and the steps of the rows that move.
    fn vectors(&self, path: &str, component: &'static str) -> (Vec<i64>, Vec<[f32; 3]>) {
        let chunks = self.at(path).into_iter().filter(|c| c.components().contains_component(component.into()));
        let (mut steps, mut values) = (Vec::new(), Vec::new());
        for chunk in chunks {
            if let Some(times) = chunk.timelines().get(&TimelineName::from("step")) {
                steps.extend_from_slice(times.times_raw());
            }
            let column = chunk.components().get_array(component.into()).expect("a column");
            values.extend(vectors(column.values()));
        }
        (steps, values)
    }

    /// All numbers of a component of an entity.
    fn numbers(&self, path: &str, component: &'static str) -> Vec<f64> {
        let columns = self.at(path).into_iter().filter_map(|c| c.components().get_array(component.into()));
        let numbers = columns.flat_map(|column| {
            let flat = column.values().as_any().downcast_ref::<Float64Array>().expect("numbers");
            flat.values().to_vec()
        });
        numbers.collect()
    }

    /// Whether anything is said of an entity.
    fn holds(&self, path: &str) -> bool {
        !self.at(path).is_empty()
    }

    /// All text in a component of an entity.
    fn texts(&self, path: &str, component: &'static str) -> Vec<String> {
        let columns = self.at(path).into_iter().filter_map(|c| c.components().get_array(component.into()));
        let texts = columns.flat_map(|column| {
            let flat = column.values().as_any().downcast_ref::<StringArray>().expect("text");
            flat.iter().flatten().map(str::to_owned).collect::<Vec<_>>()
        });
        texts.collect()
    }
}

/// A line for each component of each entity of a file: how many rows it has, and a number of all that stands in them and of
/// their times, but for when the file was written. The same content gives the same lines, however it is cut into chunks.
#[cfg(feature = "cli")]
pub fn told(file: &std::path::Path) -> String {
    let mut columns: BTreeMap<String, (usize, DefaultHasher)> = BTreeMap::new();
    for (store, chunks) in Contents::of(file).stores {
        for chunk in chunks {
            let written = |name: &str| ["log_time", "log_tick"].contains(&name);
            let timelines = chunk.timelines().iter().filter(|(name, _)| !written(name.as_str()));
            let timelines: BTreeMap<String, &[i64]> =
                timelines.map(|(name, at)| (name.to_string(), at.times_raw())).collect();
            for (component, column) in chunk.components().0.iter() {
                let name = format!("{:?} {} {component}", store.kind(), chunk.entity_path());
                if name.contains("start_time") {
                    continue;
                }
                let (count, hasher) = columns.entry(name).or_default();
                for row in 0..chunk.num_rows() {
                    timelines.iter().for_each(|(name, times)| (name, times[row]).hash(hasher));
                    told_of(&*column.list_array.value(row), hasher);
                    *count += 1;
                }
            }
        }
    }
    columns.iter().map(|(name, (count, hasher))| format!("{name}: {count} rows, {:x}\n", hasher.finish())).collect()
}

/// All that stands in an array.
#[cfg(feature = "cli")]
fn told_of(array: &dyn Array, hasher: &mut DefaultHasher) {
    let any = array.as_any();
    array.len().hash(hasher);
    if let Some(numbers) = any.downcast_ref::<Float32Array>() {
        numbers.values().iter().for_each(|x| x.to_bits().hash(hasher));
    } else if let Some(numbers) = any.downcast_ref::<Float64Array>() {
        numbers.values().iter().for_each(|x| x.to_bits().hash(hasher));
    } else if let Some(numbers) = any.downcast_ref::<UInt32Array>() {
        numbers.values().iter().for_each(|x| x.hash(hasher));
    } else if let Some(list) = any.downcast_ref::<FixedSizeListArray>() {
        told_of(&**list.values(), hasher);
    } else if let Some(list) = any.downcast_ref::<ListArray>() {
        (0..list.len()).for_each(|i| told_of(&*list.value(i), hasher));
    } else {
        format!("{array:?}").hash(hasher);
    }
}

fn vectors(flat: &dyn Array) -> Vec<[f32; 3]> {
    let list = flat.as_any().downcast_ref::<FixedSizeListArray>().expect("vectors");
    let numbers = list.values().as_any().downcast_ref::<Float32Array>().expect("numbers").values();
    numbers.chunks_exact(3).map(|v| [v[0], v[1], v[2]]).collect()
}

fn near(p: [f32; 3], q: [f64; 3]) -> bool {
    p.iter().zip(q).all(|(p, q)| (f64::from(*p) - q).abs() < 1e-5)
}

fn cases() -> Vec<Scenario> {
    Scenario::cases().map(|name| Scenario::builtin(name).expect("built in")).collect()
}

fn short(name: &str) -> Scenario {
    let mut scenario = Scenario::builtin(name).expect("built in");
    scenario.duration = Some(0.1);
    scenario
}

fn quietly(_: RecordingProgress) -> bool {
    true
}

fn record_in(folder: &Folder, name: &str, scenarios: &[Scenario]) -> Result<Vec<Recording>, RecordError> {
    record(scenarios, &folder.path(name), &Options::default(), &mut quietly)
}

/// Via points within limits that fold the workspace.
fn folded() -> Scenario {
    let mut scenario = short("case-3");
    for key in ["limits.a1", "limits.a2"] {
        scenario.machine = scenario.machine.set(key, "-1,4").expect("wider limits");
    }
    scenario.task.via = vec![[0.52, 0.62], [0.58, 0.75]];
    scenario
}

fn packed(rgba: [f32; 4]) -> u32 {
    rgba.iter().fold(0, |all, x| all << 8 | (x * 255.0).round() as u32)
}

impl Contents {
    /// All colours of a component of an entity.
    fn colours(&self, path: &str, component: &'static str) -> Vec<u32> {
        use arrow::array::UInt32Array;
        let columns = self.at(path).into_iter().filter_map(|c| c.components().get_array(component.into()));
        let colours = columns.flat_map(|column| {
            let flat = column.values().as_any().downcast_ref::<UInt32Array>().expect("colours");
            flat.values().to_vec()
        });
        colours.collect()
    }
}
