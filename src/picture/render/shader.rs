//! Shaders, embedded in the binary; debug builds reload them when their file changes.

use std::ops::Deref;

/// Memory layout of a struct that Rust and WGSL share; a test compares it with the shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SharedLayout {
    /// Name in Rust and in WGSL.
    pub name: &'static str,
    /// Size with padding, bytes.
    pub size: usize,
    /// Names and offsets in bytes, in order. Names of padding begin with `_` and do not exist in WGSL.
    pub fields: &'static [(&'static str, usize)],
}

/// Defines a struct that is copied to the GPU byte by byte, with its [`SharedLayout`].
macro_rules! twin {
    ($(#[$doc:meta])* struct $name:ident { $($field:ident: $type:ty,)* }) => {
        $(#[$doc])*
        #[repr(C)]
        #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
        pub(super) struct $name { $(pub(super) $field: $type,)* }
        impl $name {
            pub(super) const TWIN: $crate::render::shader::SharedLayout = $crate::render::shader::SharedLayout {
                name: stringify!($name),
                size: size_of::<Self>(),
                fields: &[$((stringify!($field), std::mem::offset_of!(Self, $field))),*],
            };
        }
    };
}
pub(crate) use twin;

/// Expands to the name of the file `shaders/NAME.wgsl` and its text at build time.
macro_rules! embedded {
    ($name:literal) => {
        ($name, include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shaders/", $name, ".wgsl")))
    };
}
pub(crate) use embedded;

type Build<P> = Box<dyn Fn(&wgpu::Device, &wgpu::ShaderModule) -> P + Send + Sync>;

/// The pipelines `P` built from one shader.
pub(crate) struct Shader<P> {
    pipelines: P,
    #[cfg(debug_assertions)]
    build: Build<P>,
    #[cfg(debug_assertions)]
    watch: watch::ShaderWatch,
}

impl<P> Shader<P> {
    pub(crate) fn new(device: &wgpu::Device, (name, text): (&'static str, &'static str), build: Build<P>) -> Self {
        let pipelines = build(device, &module(device, name, text));
        #[cfg(debug_assertions)]
        return Self { pipelines, build, watch: watch::ShaderWatch::new(name, text) };
        #[cfg(not(debug_assertions))]
        Self { pipelines }
    }

    /// Reloads a changed file; if it is not valid, the last valid pipelines remain, and a line on standard error says
    /// why.
    #[cfg(debug_assertions)]
    pub(crate) fn reload(&mut self, device: &wgpu::Device) {
        let Some(text) = self.watch.changed() else { return };
        let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
        let pipelines = (self.build)(device, &module(device, self.watch.name, &text));
        match pollster::block_on(scope.pop()) {
            None => self.pipelines = pipelines,
            Some(error) => {
                let words: Vec<_> = error.to_string().split_whitespace().map(str::to_owned).collect();
                eprintln!("shaders/{}.wgsl: keeping the last good one: {}", self.watch.name, words.join(" "));
            }
        }
    }

    #[cfg(not(debug_assertions))]
    pub(crate) fn reload(&mut self, _: &wgpu::Device) {}
}

impl<P> Deref for Shader<P> {
    type Target = P;
    fn deref(&self) -> &P {
        &self.pipelines
    }
}

fn module(device: &wgpu::Device, name: &str, text: &str) -> wgpu::ShaderModule {
    let source = wgpu::ShaderSource::Wgsl(text.into());
    device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(name), source })
}

#[cfg(debug_assertions)]
mod watch {
    use std::path::PathBuf;
    use std::time::{Duration, Instant, SystemTime};

    /// Polls the file of a shader, at most twice a second.
    pub(super) struct ShaderWatch {
        pub(super) name: &'static str,
        path: PathBuf,
        text: String,
        modified: Option<SystemTime>,
        looked: Option<Instant>,
    }

    impl ShaderWatch {
        pub(super) fn new(name: &'static str, text: &str) -> Self {
            let path = [env!("CARGO_MANIFEST_DIR"), "../../shaders", &format!("{name}.wgsl")].iter().collect();
            Self { name, path, text: text.to_owned(), modified: None, looked: None }
        }

        /// Returns the text of the file once after each change. A missing file is no change: the binary may have moved.
        pub(super) fn changed(&mut self) -> Option<String> {
            if self.looked.is_some_and(|at| at.elapsed() < Duration::from_millis(500)) {
                return None;
            }
            self.looked = Some(Instant::now());
            let modified = std::fs::metadata(&self.path).and_then(|file| file.modified()).ok()?;
            if self.modified.replace(modified) == Some(modified) {
                return None;
            }
            let text = std::fs::read_to_string(&self.path).ok().filter(|text| *text != self.text)?;
            self.text.clone_from(&text);
            Some(text)
        }
    }
}
