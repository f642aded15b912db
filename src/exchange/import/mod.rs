//! Import of machines from other programs: planar URDF and MJCF whose links each follow one drive.
//!
//! A reader for each format (`urdf`, `mjcf`) returns a `linkage` in space. It contains parts, their hinges in a
//! reference pose, the sets of parts that turn together, motors and rotors. `family` projects the linkage onto the
//! plane of motion and makes a machine of it. If that is impossible, the error names the reason.

mod bodies;
mod compiler;
mod defaults;
mod family;
mod floating;
mod linkage;
mod mjcf;
mod read;
mod refusal;
mod scan;
mod shapes;
mod urdf;

pub use family::ImportedMachine;
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
    let (mut found, mut mended) = (vec![first.fault()], first.mended(text));
    let mut is_cut = false;
    for _ in 0..MAX_ROUNDS {
        let Some(Err(error)) = mended.take().map(|text| import(&text).map_err(|error| (error.mended(&text), error)))
        else {
            break;
        };
        let fault = error.1.fault();
        is_cut = error.0.is_none() || found.contains(&fault);
        if is_cut {
            break;
        }
        mended = error.0;
        found.push(fault);
    }
    let options = ParsingOptions { allow_dtd: false, nodes_limit: MAX_NODES, ..ParsingOptions::default() };
    let document = Document::parse_with_options(text, options).ok();
    let robot = document.as_ref().map(Document::root_element).filter(|root| root.has_tag_name("robot"));
    for error in robot.map(urdf::wrong_values).unwrap_or_default() {
        let fault = error.located(text).fault();
        if !found.contains(&fault) {
            found.push(fault);
        }
    }
    Faults::of(found, is_cut)
}
