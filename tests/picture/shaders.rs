//! Every shader is valid, and every struct it shares with Rust lies alike on both sides.

use std::collections::BTreeSet;
use std::path::Path;

use naga::{AddressSpace, TypeInner, valid};
use stillbase::picture::{gui, render};

/// All structs that Rust shares with a shader.
fn twins() -> Vec<render::SharedLayout> {
    render::TWINS.into_iter().chain(gui::TWINS).collect()
}

/// Names and modules of all shaders in the repository.
fn shaders() -> Vec<(String, naga::Module)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
    let mut shaders: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| {
            let path = entry.unwrap().path();
            assert_eq!(path.extension().unwrap(), "wgsl", "{}", path.display());
            let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
            let text = std::fs::read_to_string(&path).unwrap();
            let module = naga::front::wgsl::parse_str(&text)
                .unwrap_or_else(|error| panic!("{name}.wgsl: {}", error.emit_to_string(&text)));
            (name, module)
        })
        .collect();
    shaders.sort_by(|a, b| a.0.cmp(&b.0));
    shaders
}

#[test]
fn shaders_are_valid() {
    let shaders = shaders();
    let names: Vec<_> = shaders.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["blit", "gui", "lines", "markers", "shadows", "solids", "workspace"]);
    for (name, module) in &shaders {
        valid::Validator::new(valid::ValidationFlags::all(), valid::Capabilities::default())
            .validate(module)
            .unwrap_or_else(|error| panic!("{name}.wgsl: {:?}", error.into_inner()));
    }
}

#[test]
fn twins_lie_alike_in_rust_and_wgsl() {
    let (twins, mut seen) = (twins(), BTreeSet::new());
    for (shader, module) in &shaders() {
        for (_, ty) in module.types.iter() {
            let (Some(name), TypeInner::Struct { members, span }) = (&ty.name, &ty.inner) else { continue };
            let Some(twin) = twins.iter().find(|twin| twin.name == name) else { continue };
            let wgsl: Vec<_> =
                members.iter().map(|member| (member.name.as_deref().unwrap(), member.offset as usize)).collect();
            let rust: Vec<_> = twin.fields.iter().copied().filter(|(field, _)| !field.starts_with('_')).collect();
            assert_eq!(wgsl, rust, "{shader}.wgsl: {name}");
            assert_eq!(*span as usize, twin.size, "{shader}.wgsl: size of {name}");
            seen.insert(twin.name);
        }
    }
    assert_eq!(seen, twins.iter().map(|twin| twin.name).collect(), "a twin that no shader has");
}

#[test]
fn every_struct_in_a_buffer_has_a_twin() {
    let twins = twins();
    for (shader, module) in &shaders() {
        for (_, variable) in module.global_variables.iter() {
            if !matches!(variable.space, AddressSpace::Uniform | AddressSpace::Storage { .. }) {
                continue;
            }
            let mut ty = &module.types[variable.ty];
            if let TypeInner::Array { base, .. } = ty.inner {
                ty = &module.types[base];
            }
            let name = ty.name.as_deref().unwrap_or("without a name");
            assert!(twins.iter().any(|twin| twin.name == name), "{shader}.wgsl: struct {name} has no twin in Rust");
        }
    }
}
