//! [`Dimensions`]: options for the dimensions of parts, which commands share.

use clap::Args;
use stillbase_exchange::cut::Cut;
use stillbase_mechanics::machine::{MATERIALS, Machine};

/// Dimensions of bars, pins and discs.
#[derive(Args)]
pub struct Dimensions {
    /// Width of the bars, m; default: that of the machine's parts, or 0.03
    #[arg(long, value_name = "W")]
    pub bar_width: Option<f64>,
    /// Diameter of the pins and their holes, m; default: that of the machine's parts, or 0.008
    #[arg(long, value_name = "D")]
    pub pin_diameter: Option<f64>,
    /// Material of the counterweights: aluminium, steel, brass, lead, tungsten, or a density, kg/m³; default: steel
    #[arg(long, value_parser = density, value_name = "MATERIAL")]
    pub material: Option<f64>,
    /// Thickness of the counterweights, m; default: the thickness that gives each its mass
    #[arg(long, value_name = "T")]
    pub thickness: Option<f64>,
    /// Thickness of the bars, m; default: that of the machine's parts, or 0.006
    #[arg(long, value_name = "T")]
    pub plate_thickness: Option<f64>,
    /// Gap between bars of neighbouring layers, m; default: 0.001
    #[arg(long, value_name = "M")]
    pub spacer: Option<f64>,
}

impl Dimensions {
    /// Returns the dimensions for a machine: where none are given those of its parts, or else the usual ones.
    pub fn cut(&self, machine: &Machine) -> Cut {
        let usual = Cut::default().fitting(machine);
        Cut {
            bar_width: self.bar_width.unwrap_or(usual.bar_width),
            pin_diameter: self.pin_diameter.unwrap_or(usual.pin_diameter),
            density: self.material.unwrap_or(usual.density),
            thickness: self.thickness,
            plate_thickness: self.plate_thickness.unwrap_or(usual.plate_thickness),
            spacer: self.spacer.unwrap_or(usual.spacer),
        }
    }
}

/// Parses a density, kg/m³, or the name of a material.
pub fn density(text: &str) -> Result<f64, String> {
    let known = MATERIALS.iter().find(|(name, _)| name.eq_ignore_ascii_case(text.trim()));
    let want = || format!("want a density in kg/m³, or {}", MATERIALS.map(|(name, _)| name).join(", "));
    known.map_or_else(|| text.trim().parse().map_err(|_| want()), |(_, density)| Ok(*density))
}
