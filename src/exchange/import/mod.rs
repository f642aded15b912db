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
