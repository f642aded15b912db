//! Every public error can be passed on as any other: `?` into a boxed error, to another thread, with its source.

use std::collections::BTreeSet;
use std::error::Error;

use stillbase::session::Refusal;
use stillbase::{exchange, files, mechanics, planning, session, settings, study};

use super::source::Source;

/// Compiles for what can be passed on only.
const fn is_error<E: Error + Send + Sync + 'static>() {}

/// Checks each type when it is compiled, and lists the names, also of those whose feature is off.
macro_rules! errors {
    ($($(#[$gate:meta])? $($path:ident)::+,)*) => {
        const _: () = {
            $($(#[$gate])? is_error::<$($path)::+>();)*
        };
        const LISTED: &[&[&str]] = &[$(&[$(stringify!($path)),+]),*];
    };
}

errors! {
    settings::quantity::QuantityError,
    mechanics::machine::FileError,
    mechanics::machine::MachineError,
    mechanics::assembly::AssemblyError,
    mechanics::assembly::ComplianceError,
    mechanics::balance::DesignError,
    mechanics::balance::RebalanceError,
    mechanics::counterweights::CounterweightError,
    mechanics::joint_forces::JointsError,
    mechanics::sketch::SketchRefusal,
    exchange::cut::CutError,
    exchange::form::ExchangeError,
    exchange::import::ImportError,
    exchange::mjcf::MjcfError,
    exchange::stl::SolidsError,
    planning::curves::CurveError,
    planning::curves::PathError,
    planning::curves::given::SamplesError,
    planning::following::Blocked,
    planning::following::nearest::NoClosestMotion,
    planning::following::nearest::NotMoved,
    planning::off_plane::corridor::CorridorError,
    planning::off_plane::drift::DriftError,
    planning::off_plane::least_reaction::LeastReactionError,
    planning::off_plane::price::PriceError,
    planning::off_plane::rays::NoRays,
    planning::off_plane::turning_loop::NoLoop,
    planning::pose_constant::Unreachable,
    planning::pose_space::NoPoseSpace,
    planning::pose_space::NotFollowable,
    planning::pose_space::PlaneError,
    planning::posture::NoPosturePath,
    planning::reactionless::NoReach,
    planning::reactionless::NotAPlaneMap,
    planning::timing::TimeError,
    session::Refusal,
    session::scenario::ScenarioError,
    session::scenario::SettingError,
    session::scenario::UnfinishedDrawing,
    study::base_spectrum::NoBaseSpectrum,
    study::counterweights::NoCounterweights,
    study::design_space::NoDesignSpace,
    study::equations::NoInstant,
    study::import::MotionImportError,
    study::layers::NoLayers,
    study::lengths::NoLengths,
    study::spectrum::SpectrumError,
    study::tolerance::ToleranceError,
    study::trim::NoCorrection,
    study::workshop::NoCut,
    study::trim::NoTrim,
    study::trim::TrimError,
    settings::spelling::UnknownName,
    #[cfg(feature = "record")]
    files::recorded::ReadError,
    files::WriteError,
    files::video::VideoError,
    #[cfg(feature = "cli")]
    files::row_file::RowError,
    #[cfg(feature = "tables")]
    files::table::NoTable,
    #[cfg(feature = "ui")]
    stillbase::app::export::ExportError,
    #[cfg(feature = "cli")]
    files::shards::ShardError,
    #[cfg(feature = "tables")]
    files::table::TableError,
    #[cfg(feature = "render")]
    stillbase::picture::render::offscreen::NoAdapter,
    #[cfg(feature = "render")]
    stillbase::picture::render::offscreen::NoPicture,
    #[cfg(feature = "record")]
    stillbase::recording::RecordError,
    #[cfg(feature = "record")]
    stillbase::recording::ViewerError,
    #[cfg(feature = "window")]
    stillbase::app::window::WindowError,
}

/// Errors that never leave their crate or the workspace: no path of `stillbase` names them.
const INNER: &[&str] = &["IncompleteTask", "NoOptimum", "StoreError", "WrongNumber"];

/// An error as the sources declare it.
struct Declared {
    name: String,
    file: String,
    /// From its attributes to its closing brace.
    body: String,
}

/// All types that derive or implement the trait.
fn declared() -> Vec<Declared> {
    let mut found = Vec::new();
    for Source { name: file, code } in Source::all() {
        for block in code.split("\n\n") {
            let Some(derived) = block.find("#[derive(") else { continue };
            let body = &block[derived..];
            let derives = body.split(')').next().unwrap_or_default();
            if !derives.split([',', '(', ' ', ':']).any(|word| word == "Error") {
                continue;
            }
            let named = ["pub enum ", "pub struct ", "enum ", "struct "].iter().find_map(|kind| body.split_once(kind));
            let (_, rest) = named.unwrap_or_else(|| panic!("{file}: {body}"));
            let name = rest.chars().take_while(|c| c.is_alphanumeric()).collect();
            found.push(Declared { name, file: file.clone(), body: body.to_owned() });
        }
        for (_, rest) in code.match_indices("Error for ").map(|(at, word)| (at, &code[at + word.len()..])) {
            let name = rest.chars().take_while(|c| c.is_alphanumeric()).collect();
            found.push(Declared { name, file: file.clone(), body: String::new() });
        }
    }
    found
}

#[test]
fn every_error_is_listed() {
    let declared = declared();
    let found: BTreeSet<&str> = declared.iter().map(|error| error.name.as_str()).collect();
    let listed = LISTED.iter().filter_map(|path| path.last().copied());
    assert_eq!(found, listed.chain(INNER.iter().copied()).collect());
    assert_eq!(found.len(), LISTED.len() + INNER.len(), "two errors have one name");
}

/// Where one error holds another, `source` gives it: the field is `source`, or marked.
#[test]
fn an_error_gives_the_one_it_holds() {
    let declared = declared();
    let mut held = 0;
    for error in &declared {
        let mut attribute = "";
        for line in error.body.lines().map(str::trim).skip_while(|line| !line.starts_with("pub ")).skip(1) {
            let field = line.split_once('(').map_or(line, |(_, inner)| inner);
            let words: Vec<&str> = field.split(|c: char| !c.is_alphanumeric()).collect();
            let is_field = !line.starts_with("#[") && !line.ends_with('{');
            let holds = is_field && declared.iter().any(|other| words.contains(&other.name.as_str()));
            if holds {
                let gives = ["#[from]", "#[source]"].iter().any(|mark| line.contains(mark) || attribute == *mark)
                    || line.starts_with("source:")
                    || attribute == "#[error(transparent)]";
                assert!(gives, "{}: {} holds {line}", error.file, error.name);
                held += 1;
            }
            if !line.is_empty() {
                attribute = line;
            }
        }
    }
    assert!(held > 30, "only {held} fields found");
}

/// A program that asks for the type of the cause finds it.
#[test]
fn the_source_is_the_error_that_is_held() {
    let refusal = Box::new(Refusal::Stopped);
    let edit = Refusal::Edit { entry: 1, step: 0, title: "b".into(), refusal };
    let source = edit.source().and_then(|source| source.downcast_ref::<Box<Refusal>>());
    assert_eq!(source, Some(&Box::new(Refusal::Stopped)));
    let file = mechanics::machine::parse("name = 1", "arm.toml").expect_err("a name is text");
    assert!(file.source().is_some_and(|source| source.is::<mechanics::machine::MachineError>()), "{file:?}");
}
