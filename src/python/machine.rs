//! [`Machine`]: a machine and what the command line answers about it.

use std::ffi::OsString;
use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};
use stillbase_files::found_machine;
use stillbase_files::text::with_standard_input;
use stillbase_mechanics::machine::{self, to_toml};

use crate::asked::{answered, options, setting, wrong_input};
use crate::dynamics::{Dynamics, evaluate};

/// A robot arm: its links, drives and counterweights. It never changes; [`set`] returns another one.
#[pyclass(frozen, module = "stillbase")]
pub struct Machine {
    pub(crate) machine: Arc<machine::Machine>,
}

impl Machine {
    fn of(machine: machine::Machine) -> Self {
        Self { machine: machine.into() }
    }

    /// Carries out a command on this machine.
    fn asked<'py>(&self, py: Python<'py>, command: &str, words: Vec<OsString>) -> PyResult<Bound<'py, PyAny>> {
        // Standard input, unlike a file, needs no place.
        let line = [OsString::from(command), "-".into()].into_iter().chain(words);
        answered(py, line.collect(), Some(to_toml(&self.machine)))
    }
}

/// Returns the exception of wrong input.
fn wrong(why: impl ToString) -> PyErr {
    Python::attach(|py| wrong_input(py, why))
}

#[pymethods]
impl Machine {
    /// Returns a built-in machine.
    #[classmethod]
    fn builtin(_: &Bound<'_, PyType>, name: &str) -> PyResult<Self> {
        machine::named(name).map(Self::of).map_err(wrong)
    }

    /// Reads a machine from a file: TOML, URDF or MJCF.
    #[classmethod]
    fn load(_: &Bound<'_, PyType>, path: &Bound<'_, PyAny>) -> PyResult<Self> {
        found_machine(&path.str()?.to_string()).map(|found| Self::of(found.machine)).map_err(wrong)
    }

    /// Returns the machine that a text in TOML describes.
    #[classmethod]
    fn from_toml(_: &Bound<'_, PyType>, text: &str) -> PyResult<Self> {
        let read = || found_machine("-").map(|found| Self::of(found.machine));
        with_standard_input(text.into(), read).map_err(wrong)
    }

    /// Returns the machine that a dictionary describes, with the keys of a file.
    #[classmethod]
    fn from_dict(class: &Bound<'_, PyType>, spec: &Bound<'_, PyDict>) -> PyResult<Self> {
        let json: String = class.py().import("json")?.call_method1("dumps", (spec,))?.extract()?;
        let table: toml::Table = serde_json::from_str(&json).map_err(wrong)?;
        Self::from_toml(class, &table.to_string())
    }

    /// Returns the machine as text in TOML.
    fn to_toml(&self) -> String {
        to_toml(&self.machine)
    }

    /// Returns the machine as a dictionary, with the keys of a file.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let table: toml::Table = self.to_toml().parse().map_err(wrong)?;
        crate::asked::parsed(py, &serde_json::to_string(&table).map_err(wrong)?)
    }

    /// Returns the machine with keys set, such as `{"link.2.com": 0.22}`.
    fn set(&self, keys: &Bound<'_, PyDict>) -> PyResult<Self> {
        let pairs = keys.iter().map(|(key, value)| Ok((key.str()?.to_string(), setting(&value)?)));
        let pairs = pairs.collect::<PyResult<Vec<_>>>()?;
        let pairs = pairs.iter().map(|(key, value)| (key.as_str(), value.as_str()));
        self.machine.set_all(pairs).map(Self::of).map_err(wrong)
    }

    /// Name.
    #[getter]
    fn name(&self) -> &str {
        self.machine.name()
    }

    /// Names of the drives.
    #[getter]
    fn drives(&self) -> Vec<&str> {
        self.machine.spec().drives.iter().map(|drive| drive.name.as_str()).collect()
    }

    /// Whether the machine is balanced and its mass matrix constant, as `stillbase check`.
    fn check<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.asked(py, "check", Vec::new())
    }

    /// Places the links' centres of mass so that the machine is balanced, as `stillbase design` with its options.
    #[pyo3(signature = (**given))]
    fn design<'py>(&self, py: Python<'py>, given: Option<&Bound<'py, PyDict>>) -> PyResult<Bound<'py, PyAny>> {
        self.asked(py, "design", options(given)?)
    }

    /// Finds the counterweights that balance the machine, as `stillbase design --counterweights` with its options.
    #[pyo3(signature = (**given))]
    fn counterweights<'py>(&self, py: Python<'py>, given: Option<&Bound<'py, PyDict>>) -> PyResult<Bound<'py, PyAny>> {
        let words = ["--counterweights".into()].into_iter().chain(options(given)?);
        self.asked(py, "design", words.collect())
    }

    /// Finds the Pareto front of a number of designs, as `stillbase design --counterweights --front` with its options.
    #[pyo3(signature = (count=9, **given))]
    fn front<'py>(
        &self,
        py: Python<'py>,
        count: u32,
        given: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let words = ["--counterweights".into(), "--front".into(), count.to_string().into()];
        self.asked(py, "design", words.into_iter().chain(options(given)?).collect())
    }

    /// The reactionless workspace of b, rad, as `stillbase workspace` with its options.
    #[pyo3(signature = (b, **given))]
    fn workspace<'py>(
        &self,
        py: Python<'py>,
        b: f64,
        given: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let words = ["--b".into(), format!("{b:?}").into()].into_iter().chain(options(given)?);
        self.asked(py, "workspace", words.collect())
    }

    /// The poses that put the end effector on a point (x, y), m, at b, rad, as `stillbase pose`.
    fn poses<'py>(&self, py: Python<'py>, point: [f64; 2], b: f64) -> PyResult<Bound<'py, PyAny>> {
        let [x, y] = point;
        self.asked(py, "pose", vec![format!("{x:?},{y:?}").into(), "--b".into(), format!("{b:?}").into()])
    }

    /// The pose constants b that reach points (x, y), m, as `stillbase reach`.
    fn reach<'py>(&self, py: Python<'py>, points: Vec<[f64; 2]>) -> PyResult<Bound<'py, PyAny>> {
        self.asked(py, "reach", points.iter().map(|[x, y]| format!("{x:?},{y:?}").into()).collect())
    }

    /// Motor torques and base reactions of states of motion: absolute drive angles, rad, rates, rad/s, and accelerations,
    /// rad/s², each of shape (drives,) or (n, drives). `out` is an earlier result of the same shape that is overwritten.
    ///
    /// ```python
    /// >>> import numpy as np, stillbase as sb
    /// >>> machine = sb.Machine.builtin("nine-link")
    /// >>> machine.dynamics(np.zeros((4, 3)), np.zeros(3), np.ones(3)).torque.shape
    /// (4, 3)
    ///
    /// ```
    #[pyo3(signature = (q, qd, qdd, *, out=None, threads=1))]
    fn dynamics(
        &self,
        py: Python<'_>,
        q: &Bound<'_, PyAny>,
        qd: &Bound<'_, PyAny>,
        qdd: &Bound<'_, PyAny>,
        out: Option<Py<Dynamics>>,
        threads: usize,
    ) -> PyResult<Py<Dynamics>> {
        evaluate(py, &self.machine, [q, qd, qdd], out, threads)
    }

    fn __repr__(&self) -> String {
        format!("<stillbase.Machine {}: {} drives, {:.3} kg>", self.name(), self.machine.drives(), self.machine.mass())
    }

    fn __eq__(&self, other: &Self) -> bool {
        *self.machine == *other.machine
    }
}
