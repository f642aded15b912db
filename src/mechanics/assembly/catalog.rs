//! The assemblies that come with the program.

use std::sync::LazyLock;

use super::file::parse;
use super::model::Assembly;
use crate::machine::named;

/// The files of the built-in assemblies.
const TEXTS: [(&str, &str); 5] = [
    ("carrier-and-arm", include_str!("../../../assets/assemblies/carrier-and-arm.toml")),
    ("carrier-and-wrist", include_str!("../../../assets/assemblies/carrier-and-wrist.toml")),
    ("two-arms", include_str!("../../../assets/assemblies/two-arms.toml")),
    ("two-loaded-arms", include_str!("../../../assets/assemblies/two-loaded-arms.toml")),
    ("wrist-off-its-pin", include_str!("../../../assets/assemblies/wrist-off-its-pin.toml")),
];

static BUILTINS: LazyLock<Vec<Assembly>> = LazyLock::new(|| {
    let read = |(name, text)| parse(text, name, &named).expect("the assemblies that come along are valid");
    TEXTS.into_iter().map(read).collect()
});

/// The built-in assemblies.
pub fn builtin_assemblies() -> &'static [Assembly] {
    &BUILTINS
}

/// Returns the text of the file of a built-in assembly.
pub fn builtin_text(name: &str) -> Option<&'static str> {
    TEXTS.into_iter().find(|(own, _)| *own == name).map(|(_, text)| text)
}
