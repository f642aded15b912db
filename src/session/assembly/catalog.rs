//! The scenarios of assemblies that come with the program.

/// Name and text of each.
const TEXTS: [(&str, &str); 5] = [
    ("four-freedoms", include_str!("../../../assets/assemblies/four-freedoms.toml")),
    ("wrist-across", include_str!("../../../assets/assemblies/wrist-across.toml")),
    ("arm-against-arm", include_str!("../../../assets/assemblies/arm-against-arm.toml")),
    ("hand-over", include_str!("../../../assets/assemblies/hand-over.toml")),
    ("off-its-pin", include_str!("../../../assets/assemblies/off-its-pin.toml")),
];

/// Returns the names of the built-in scenarios of assemblies.
pub fn builtin_assembly_scenarios() -> impl Iterator<Item = &'static str> {
    TEXTS.into_iter().map(|(name, _)| name)
}

/// Returns the text of a built-in scenario of an assembly.
pub fn builtin_scenario_text(name: &str) -> Option<&'static str> {
    TEXTS.into_iter().find(|(own, _)| *own == name).map(|(_, text)| text)
}
