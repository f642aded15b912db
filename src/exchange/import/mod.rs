//! Import of machines from other programs: planar URDF and MJCF whose links each follow one drive.
//!
//! A reader for each format (`urdf`, `mjcf`) returns a `linkage` in space. It contains parts, their hinges in a
//! reference pose, the sets of parts that turn together, motors and rotors. `family` projects the linkage onto the
//! plane of motion and makes a machine of it. If that is impossible, the error names the reason.

mod bodies;
mod compiler;
mod defaults;
mod family;
mod linkage;
mod mjcf;
mod read;
mod refusal;
mod scan;
mod shapes;
mod urdf;

pub use family::{BaseBody, ImportedMachine};
pub use refusal::ImportError;

use roxmltree::{Document, ParsingOptions};

use stillbase_settings::fault::Faults;

/// Maximum number of XML nodes of a file: more would take gigabytes.
const MAX_NODES: u32 = 400_000;

/// Reads a machine from the text of a URDF or MJCF file.
///
/// # Errors
/// If the file is not a planar machine whose links each follow one drive. The error names the first wrong element,
/// its line, and the expected
/// input.
pub fn import(text: &str) -> Result<ImportedMachine, ImportError> {
    let options = ParsingOptions { allow_dtd: false, nodes_limit: MAX_NODES, ..ParsingOptions::default() };
    scan::check_bounds(text).map_err(|error| error.located(text))?;
    let document = Document::parse_with_options(text, options).map_err(|why| refusal::syntax(&why.to_string()))?;
    let root = document.root_element();
    let linkage = match root.tag_name().name() {
        "robot" => urdf::linkage(root),
        "mujoco" => mjcf::linkage(root),
        _ => Err(refusal::element_error(root, "neither a robot nor a model", "<robot> of URDF or <mujoco> of MJCF")),
    };
    linkage.and_then(|linkage| family::imported(&linkage)).map_err(|error| error.located(text))
}

/// Maximum number of times that a file is read to find its faults.
const MAX_ROUNDS: usize = 100;

/// Returns the faults of a text that [`import`] has refused for `first`. Values that are wrong or missing are all told.
/// What else is wrong is told if it is the first: behind values that were made up it might follow from these.
pub fn faults(text: &str, first: ImportError) -> Faults {
    let mut found = vec![first.fault()];
    let mut mended = first.mended(text);
    for _ in 0..MAX_ROUNDS {
        let Some(text) = mended.take() else { break };
        let Err(error) = import(&text) else { return Faults::of(found, false) };
        mended = error.mended(&text);
        let fault = error.fault();
        if mended.is_none() || found.contains(&fault) {
            return Faults::of(found, true);
        }
        found.push(fault);
    }
    let is_cut = found.len() > 1;
    Faults::of(found, is_cut)
}
