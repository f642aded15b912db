//! [`Form`]: an export format, chosen by the ending of a file's name. [`FORMS`] lists all of them.

use super::base_body::BaseBody;
use super::cut::{Cut, CutError};
use super::drawing::{Sheet, dxf, svg};
use super::left_out;
use super::mjcf::{MjcfError, mjcf, mjcf_of_assembly};
use super::parts::PartsList;
use super::stl::{SolidsError, stl};
use super::urdf::{urdf, urdf_of_assembly};
use stillbase_mechanics::assembly::{Assembly, SpatialBase};
use stillbase_mechanics::machine::Machine;
use stillbase_settings::cell_table::CellTable;

/// An export format.
#[derive(Clone, Copy, Debug)]
pub struct Form {
    /// Ending of its files' names, without dot.
    pub ending: &'static str,
    /// The part of a machine that it shows.
    pub shows: ModelContent,
    write: fn(&Exported) -> Result<FormContent, ExchangeError>,
    /// Returns what a file leaves out of a machine.
    leaves_out: fn(&Machine) -> Vec<String>,
}

/// The part of a machine that a file shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModelContent {
    /// A model with an initial pose.
    Pose,
    /// A model with the joints of its motors.
    Joints,
    /// A drawing of its links for cutting.
    Links,
    /// Its links, pins and spacers as solids in a pose.
    Solids,
    /// Its parts list.
    Parts,
}

impl ModelContent {
    /// Returns whether it is a model for another program.
    pub fn is_model(self) -> bool {
        matches!(self, Self::Pose | Self::Joints)
    }
}

/// What is exported; each format takes what it shows.
#[derive(Clone, Copy, Debug)]
pub struct Exported<'a> {
    /// The machine.
    pub machine: &'a Machine,
    /// The base, if it floats: for models.
    pub base: Option<&'a BaseBody>,
    /// Angles of its drives, rad: for formats that show a pose.
    pub pose: &'a [f64],
    /// Dimensions of what is cut, and the thickness of counterweights.
    pub cut: &'a Cut,
}

/// What is exported of an assembly.
#[derive(Clone, Copy, Debug)]
pub struct ExportedAssembly<'a> {
    /// The assembly.
    pub assembly: &'a Assembly,
    /// The base, if it floats.
    pub base: Option<&'a SpatialBase>,
    /// Angles of the drives of each block, rad: for formats that show a pose.
    pub poses: &'a [&'a [f64]],
    /// The thickness of counterweights.
    pub cut: &'a Cut,
}

/// Content of a file.
#[derive(Clone, Debug, PartialEq)]
pub enum FormContent {
    /// A text.
    Text(String),
    /// A table, which the ending of the file's name makes CSV or another format of tables.
    Table(CellTable),
}

impl FormContent {
    /// Returns the content as text: a table as CSV.
    pub fn text(self) -> String {
        match self {
            Self::Text(text) => text,
            Self::Table(table) => table.csv(),
        }
    }
}

impl From<String> for FormContent {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

/// All export formats.
pub const FORMS: [Form; 8] = [
    // For MuJoCo.
    Form {
        ending: "xml",
        shows: ModelContent::Pose,
        write: |of| Ok(mjcf(of.machine, of.base, of.pose, of.cut)?.into()),
        leaves_out: left_out::of_mjcf,
    },
    // For ROS, Pinocchio and others.
    Form {
        ending: "urdf",
        shows: ModelContent::Joints,
        write: |of| Ok(urdf(of.machine, of.base, of.cut).into()),
        leaves_out: left_out::of_urdf,
    },
    // For viewing.
    Form {
        ending: "svg",
        shows: ModelContent::Links,
        write: |of| Ok(svg(&Sheet::of(of.machine, of.cut)?).into()),
        leaves_out: left_out::of_drawing,
    },
    // For cutting.
    Form {
        ending: "dxf",
        shows: ModelContent::Links,
        write: |of| Ok(dxf(&Sheet::of(of.machine, of.cut)?).into()),
        leaves_out: left_out::of_drawing,
    },
    // For a printer or a program for solids.
    Form {
        ending: "stl",
        shows: ModelContent::Solids,
        write: |of| Ok(stl(of.machine, of.pose, of.cut)?.into()),
        leaves_out: left_out::of_solids,
    },
    // For a spreadsheet.
    Form { ending: "csv", shows: ModelContent::Parts, write: parts_table, leaves_out: |_| Vec::new() },
    // For a program.
    Form { ending: "parquet", shows: ModelContent::Parts, write: parts_table, leaves_out: |_| Vec::new() },
    // For reading.
    Form {
        ending: "md",
        shows: ModelContent::Parts,
        write: |of| Ok(PartsList::of(of.machine, of.cut)?.markdown().into()),
        leaves_out: |_| Vec::new(),
    },
];

fn parts_table(of: &Exported) -> Result<FormContent, ExchangeError> {
    Ok(FormContent::Table(PartsList::of(of.machine, of.cut)?.cells()))
}

/// The default ending.
pub const DEFAULT_EXTENSION: &str = "urdf";

/// Error of an export.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ExchangeError {
    /// MuJoCo cannot simulate the machine.
    #[error(transparent)]
    Mjcf(#[from] MjcfError),
    /// The links cannot be cut with these dimensions.
    #[error(transparent)]
    Cut(#[from] CutError),
    /// The links make no solids.
    #[error(transparent)]
    Solids(#[from] SolidsError),
    /// Files of this format show one machine.
    #[error("a file that ends in .{ending} shows one machine: want {models} for an assembly, or one of its blocks", models = listed(ModelContent::is_model))]
    OneMachine {
        /// The ending.
        ending: &'static str,
    },
    /// No format has this ending.
    #[error("a name that ends in {ending:?}: want one that ends in {}", listed(|_| true))]
    Ending {
        /// The ending.
        ending: String,
    },
}

/// Returns the endings of all formats.
pub fn endings() -> [&'static str; FORMS.len()] {
    FORMS.map(|form| form.ending)
}

/// Returns the endings of the formats that `of` accepts, as a list in words: `.svg, .dxf or .csv`.
pub fn listed(of: impl Fn(ModelContent) -> bool) -> String {
    let endings: Vec<String> =
        FORMS.iter().filter(|form| of(form.shows)).map(|form| format!(".{}", form.ending)).collect();
    match endings.as_slice() {
        [first @ .., last] if !first.is_empty() => format!("{} or {last}", first.join(", ")),
        _ => endings.concat(),
    }
}

impl Form {
    /// Returns the format with an ending, in upper or lower case.
    ///
    /// # Errors
    /// If no format has this ending.
    pub fn of(ending: &str) -> Result<Self, ExchangeError> {
        let own = FORMS.into_iter().find(|form| form.ending.eq_ignore_ascii_case(ending));
        own.ok_or_else(|| ExchangeError::Ending { ending: ending.chars().take(40).collect() })
    }

    /// Returns whether a file is a model for another program, with the base if that floats.
    pub fn is_model(&self) -> bool {
        self.shows.is_model()
    }

    /// Returns what a file of the machine leaves out, or shows otherwise than it is weighed, in sentences.
    pub fn left_out(&self, machine: &Machine) -> Vec<String> {
        (self.leaves_out)(machine)
    }

    /// Returns the content of the file.
    ///
    /// # Errors
    /// If the machine cannot be exported in this format.
    pub fn written(&self, of: &Exported) -> Result<FormContent, ExchangeError> {
        of.cut.check_ranges()?;
        (self.write)(of)
    }
    /// Returns the content of the file of an assembly.
    ///
    /// # Errors
    /// If the format shows one machine only, or if the assembly cannot be exported in it.
    pub fn written_assembly(&self, of: &ExportedAssembly) -> Result<String, ExchangeError> {
        of.cut.check_ranges()?;
        match self.shows {
            ModelContent::Pose => Ok(mjcf_of_assembly(of.assembly, of.base, of.poses, of.cut)?),
            ModelContent::Joints => Ok(urdf_of_assembly(of.assembly, of.base, of.cut)),
            ModelContent::Links | ModelContent::Solids | ModelContent::Parts => {
                Err(ExchangeError::OneMachine { ending: self.ending })
            }
        }
    }

    /// Returns what a model of an assembly leaves out, in sentences: of the whole, then of each block.
    pub fn left_out_of_assembly(&self, of: &ExportedAssembly) -> Vec<String> {
        let blocks = of.assembly.blocks().iter().flat_map(|block| {
            let of_block = self.left_out(&block.machine).into_iter();
            of_block.map(move |what| format!("block {}: {what}", block.name))
        });
        left_out::of_assembly(of.assembly, of.base).into_iter().chain(blocks).collect()
    }
}
