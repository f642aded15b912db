//! `--range`: links that may carry a counterweight, and the bounds of its place.

use stillbase_mechanics::assembly::Assembly;
use stillbase_mechanics::counterweights::CounterweightSite;
use stillbase_mechanics::machine::Machine;

use super::ends::named;
use super::failure::Failure;

/// Parses NAME=LO,HI, such as places on a link, m.
pub fn range(text: &str) -> Result<(String, [f64; 2]), String> {
    named(text).ok_or_else(|| "want NAME=LO,HI, as 1=-0.3,0.5".to_owned())
}

/// The links and drives that options name: of a machine, or of the blocks of an assembly with the name of the block before
/// them, as `wrist.2`. They are counted through all blocks.
pub struct Names {
    links: Vec<String>,
    drives: Vec<String>,
}

impl From<&Machine> for Names {
    fn from(machine: &Machine) -> Self {
        let drives = machine.spec().drives.iter().map(|drive| drive.name.clone());
        Self { links: machine.links().iter().map(|link| link.name.clone()).collect(), drives: drives.collect() }
    }
}

impl From<&Assembly> for Names {
    fn from(assembly: &Assembly) -> Self {
        let mut all = Self { links: Vec::new(), drives: Vec::new() };
        for block in assembly.blocks() {
            let Self { links, drives } = Self::from(&block.machine);
            let named = |own: String| format!("{}.{own}", block.name);
            all.links.extend(links.into_iter().map(named));
            all.drives.extend(drives.into_iter().map(named));
        }
        all
    }
}

impl Names {
    /// Returns the number of a link by its name.
    ///
    /// # Errors
    /// If there is no such link.
    pub fn link(&self, name: &str) -> Result<usize, Failure> {
        number("link", &self.links, name)
    }

    /// Returns the number of a drive by its name.
    ///
    /// # Errors
    /// If there is no such drive.
    pub fn drive(&self, name: &str) -> Result<usize, Failure> {
        number("drive", &self.drives, name)
    }

    /// Returns the number of links.
    pub fn links(&self) -> usize {
        self.links.len()
    }

    /// Returns the sites on the named links, up to `across`, m, off their axes.
    ///
    /// # Errors
    /// If there is no such link.
    pub fn sites(&self, ranges: &[(String, [f64; 2])], across: f64) -> Result<Vec<CounterweightSite>, Failure> {
        let site = |(name, [from, to]): &(String, [f64; 2])| {
            Ok(CounterweightSite { across, ..CounterweightSite::on_axis(self.link(name)?, *from, *to) })
        };
        ranges.iter().map(site).collect()
    }
}

fn number(kind: &str, all: &[String], name: &str) -> Result<usize, Failure> {
    let why = || Failure::wrong_input(format!("no {kind} {name}: want one of {}", all.join(", ")));
    all.iter().position(|own| own == name).ok_or_else(why)
}

/// Returns the sites on the named links, up to `across`, m, off their axes. By default, these are all links, each from
/// one link length behind its root to its tip.
///
/// # Errors
/// If there is no such link.
pub fn sites(machine: &Machine, ranges: &[(String, [f64; 2])], across: f64) -> Result<Vec<CounterweightSite>, Failure> {
    if ranges.is_empty() {
        let anywhere = CounterweightSite::anywhere(machine).into_iter();
        return Ok(anywhere.map(|site| CounterweightSite { across, ..site }).collect());
    }
    Names::from(machine).sites(ranges, across)
}
