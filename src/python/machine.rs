//! [`Machine`]: a machine and what the command line answers about it.

use std::ffi::OsString;
use std::sync::Arc;

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString, PyType};
use stillbase_files::found_machine;
use stillbase_files::text::with_standard_input;
use stillbase_mechanics::machine::{self, to_toml};
use stillbase_picture::scene::portrait::portrait_svg;
use stillbase_simulation::plant::EqualSteps;

use crate::asked::{answered, carried_out, options, setting, wrong_input};
use crate::dynamics::{Dynamics, evaluate};
use crate::steps::{Angles, step};

/// A robot arm: its links, drives and counterweights. It never changes; `set` returns another one.
///
/// ```python
/// >>> import stillbase as sb
/// >>> sb.Machine.builtin("nine-link")
/// <stillbase.Machine nine-link: 3 drives, 16.050 kg>
///
/// ```
#[pyclass(frozen, module = "stillbase")]
pub struct Machine {
    pub(crate) machine: Arc<machine::Machine>,
}

impl Machine {
    fn of(machine: machine::Machine) -> Self {
        Self { machine: machine.into() }
    }

    /// Returns the text that stands for this machine in the place of standard input, which needs no file.
    pub fn input(&self) -> String {
        to_toml(&self.machine)
    }

    /// Returns the words of a command on this machine, with its options.
    fn line(command: &str, words: &[&str], given: Option<&Bound<'_, PyDict>>) -> PyResult<Vec<OsString>> {
        let words = [command, "-"].into_iter().chain(words.iter().copied()).map(OsString::from);
        Ok(words.chain(options(command, given)?).collect())
    }

    /// Carries out a command on this machine.
    fn asked<'py>(
        &self,
        py: Python<'py>,
        command: &str,
        words: &[&str],
        given: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        answered(py, Self::line(command, words, given)?, Some(self.input()))
    }

    /// Returns the file of an ending that `export-model` makes of this machine.
    fn exported(&self, py: Python<'_>, ending: &str, given: Option<&Bound<'_, PyDict>>) -> PyResult<String> {
        let line = Self::line("export-model", &["--output", "-", "--format", ending], given)?;
        let file = carried_out(py, line, Some(self.input()))?.file.unwrap_or_default();
        String::from_utf8(file).map_err(wrong)
    }
}

/// Returns a point, m, as a word of the command line.
fn word([x, y]: [f64; 2]) -> String {
    format!("{x:?},{y:?}")
}

/// Returns the exception of wrong input.
fn wrong(why: impl ToString) -> PyErr {
    Python::attach(|py| wrong_input(py, why))
}

#[pymethods]
impl Machine {
    /// Returns a built-in machine.
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> sb.Machine.builtin("spot").drives
    /// ['shoulder', 'elbow', 'wrist']
    ///
    /// ```
    #[classmethod]
    fn builtin(_: &Bound<'_, PyType>, name: &str) -> PyResult<Self> {
        machine::named(name).map(Self::of).map_err(wrong)
    }

    /// Reads a machine from a file: TOML, URDF or MJCF.
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> machine = sb.Machine.builtin("scara")
    /// >>> with open("scara.toml", "w") as file:
    /// ...     _ = file.write(machine.to_toml())
    /// >>> sb.Machine.load("scara.toml") == machine
    /// True
    ///
    /// ```
    #[classmethod]
    #[pyo3(signature = (path: "str | os.PathLike[str]"))]
    fn load(_: &Bound<'_, PyType>, path: &Bound<'_, PyAny>) -> PyResult<Self> {
        found_machine(&path.str()?.to_string()).map(|found| Self::of(found.machine)).map_err(wrong)
    }

    /// Returns the machine that a text in TOML describes.
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> machine = sb.Machine.builtin("scara")
    /// >>> sb.Machine.from_toml(machine.to_toml()) == machine
    /// True
    ///
    /// ```
    #[classmethod]
    fn from_toml(_: &Bound<'_, PyType>, text: &str) -> PyResult<Self> {
        let read = || found_machine("-").map(|found| Self::of(found.machine));
        with_standard_input(text.into(), read).map_err(wrong)
    }

    /// Returns the machine that a dictionary describes, with the keys of a file.
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> spec = sb.Machine.builtin("nine-link").to_dict()
    /// >>> spec["gravity"] = [0.0, -9.81]
    /// >>> sb.Machine.from_dict(spec).drives
    /// ['1', '2', '3']
    ///
    /// ```
    #[classmethod]
    #[pyo3(signature = (spec: "dict[str, typing.Any]"))]
    fn from_dict(class: &Bound<'_, PyType>, spec: &Bound<'_, PyDict>) -> PyResult<Self> {
        let json: String = class.py().import("json")?.call_method1("dumps", (spec,))?.extract()?;
        let table: toml::Table = serde_json::from_str(&json).map_err(wrong)?;
        Self::from_toml(class, &table.to_string())
    }

    /// Returns the machine as text in TOML.
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> "[[link]]" in sb.Machine.builtin("spot").to_toml()
    /// True
    ///
    /// ```
    fn to_toml(&self) -> String {
        self.input()
    }

    /// Returns the machine as a dictionary, with the keys of a file.
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> spec = sb.Machine.builtin("spot").to_dict()
    /// >>> [link["name"] for link in spec["link"]]
    /// ['1', '2', '3']
    ///
    /// ```
    #[pyo3(signature = () -> "dict[str, typing.Any]")]
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let table: toml::Table = self.to_toml().parse().map_err(wrong)?;
        crate::asked::parsed(py, &serde_json::to_string(&table).map_err(wrong)?)
    }

    /// Returns the machine as a model for MuJoCo, MJCF. Options are those of `stillbase export-model`: `pose`, `base`.
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> sb.Machine.builtin("nine-link").to_mjcf(pose=[1.5, 4.2, 3.1]).count("<body ")  # the base is one
    /// 10
    ///
    /// ```
    #[pyo3(signature = (**given: "typing.Any"))]
    fn to_mjcf(&self, py: Python<'_>, given: Option<&Bound<'_, PyDict>>) -> PyResult<String> {
        self.exported(py, "xml", given)
    }

    /// Returns the machine as a model for ROS and Pinocchio, URDF. Options are those of `stillbase export-model`:
    /// `base`.
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> "drive_3" in sb.Machine.builtin("nine-link").to_urdf()
    /// True
    ///
    /// ```
    #[pyo3(signature = (**given: "typing.Any"))]
    fn to_urdf(&self, py: Python<'_>, given: Option<&Bound<'_, PyDict>>) -> PyResult<String> {
        self.exported(py, "urdf", given)
    }

    /// Draws the machine from above, with a scale; notebooks show it. The links for cutting are drawn by `export-model`.
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> sb.Machine.builtin("nine-link")._repr_svg_().count("</svg>")
    /// 1
    ///
    /// ```
    fn _repr_svg_(&self) -> String {
        portrait_svg(&self.machine)
    }

    /// Returns the machine with a key set, such as `set("link.2.com", 0.22)`, or with several, as a dictionary.
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> machine = sb.Machine.builtin("nine-link")
    /// >>> machine.set("link.5.com", 0).check()["force_balanced"]
    /// False
    /// >>> machine.set({"link.5.com": 0, "gravity": (0, -9.81)}) == machine.set("link.5.com", 0)
    /// False
    ///
    /// ```
    #[pyo3(signature = (keys: "dict[str, typing.Any] | str", value: "typing.Any" = None))]
    fn set(&self, keys: &Bound<'_, PyAny>, value: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let pairs = match (keys.cast::<PyDict>(), value) {
            (Ok(keys), None) => {
                let pairs = keys.iter().map(|(key, value)| Ok((key.str()?.to_string(), setting(&value)?)));
                pairs.collect::<PyResult<Vec<_>>>()?
            }
            (Err(_), Some(value)) => vec![(keys.extract()?, setting(value)?)],
            _ => return Err(PyTypeError::new_err("want a dictionary of keys and values, or one key and its value")),
        };
        let pairs = pairs.iter().map(|(key, value)| (key.as_str(), value.as_str()));
        self.machine.set_all(pairs).map(Self::of).map_err(wrong)
    }

    /// Name.
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> sb.Machine.builtin("spot").name
    /// 'spot'
    ///
    /// ```
    #[getter]
    fn name(&self) -> &str {
        self.machine.name()
    }

    /// Names of the drives.
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> sb.Machine.builtin("nine-link").drives
    /// ['1', '2', '3']
    ///
    /// ```
    #[getter]
    fn drives(&self) -> Vec<&str> {
        self.machine.spec().drives.iter().map(|drive| drive.name.as_str()).collect()
    }

    /// Whether the machine is balanced and its mass matrix constant, as `stillbase check`.
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> sb.Machine.builtin("nine-link").check()["invariant"]
    /// True
    ///
    /// ```
    #[pyo3(signature = () -> "dict[str, typing.Any]")]
    fn check<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.asked(py, "check", &[], None)
    }

    /// Places the links' centres of mass so that the machine is balanced, as `stillbase design` with its options.
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> design = sb.Machine.builtin("nine-link-table-1").design(preset="table-1")
    /// >>> round(design["com"][0], 6)
    /// -0.221438
    ///
    /// ```
    #[pyo3(signature = (**given: "typing.Any") -> "dict[str, typing.Any]")]
    fn design<'py>(&self, py: Python<'py>, given: Option<&Bound<'py, PyDict>>) -> PyResult<Bound<'py, PyAny>> {
        self.asked(py, "design", &[], given)
    }

    /// Finds the counterweights that balance the machine, as `stillbase design --counterweights` with its options.
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> found = sb.Machine.builtin("nine-link-bare").counterweights()
    /// >>> found["certified"], round(found["added_mass"], 2)
    /// (True, 6.33)
    ///
    /// ```
    #[pyo3(signature = (**given: "typing.Any") -> "dict[str, typing.Any]")]
    fn counterweights<'py>(&self, py: Python<'py>, given: Option<&Bound<'py, PyDict>>) -> PyResult<Bound<'py, PyAny>> {
        self.asked(py, "design", &["--counterweights"], given)
    }

    /// Finds the Pareto front of a number of designs, as `stillbase design --counterweights --front` with its options.
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> front = sb.Machine.builtin("nine-link-bare").front(3)
    /// >>> len(front["front"])
    /// 3
    ///
    /// ```
    #[pyo3(signature = (count=9, **given: "typing.Any") -> "dict[str, typing.Any]")]
    fn front<'py>(
        &self,
        py: Python<'py>,
        count: u32,
        given: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.asked(py, "design", &["--counterweights", "--front", &count.to_string()], given)
    }

    /// The reactionless workspace of b, rad, as `stillbase workspace` with its options.
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> round(sb.Machine.builtin("nine-link").workspace(2.4)["area"], 6)  # m²
    /// 0.845145
    ///
    /// ```
    #[pyo3(signature = (b, **given: "typing.Any") -> "dict[str, typing.Any]")]
    fn workspace<'py>(
        &self,
        py: Python<'py>,
        b: f64,
        given: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.asked(py, "workspace", &["--b", &format!("{b:?}")], given)
    }

    /// The poses that put the end effector on a point (x, y), m, at b, rad, as `stillbase pose`.
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> len(sb.Machine.builtin("nine-link").poses((0.5, 0.5), 2.4)["poses"])
    /// 1
    ///
    /// ```
    #[pyo3(signature = (point: "typing.Sequence[float]", b) -> "dict[str, typing.Any]")]
    fn poses<'py>(&self, py: Python<'py>, point: [f64; 2], b: f64) -> PyResult<Bound<'py, PyAny>> {
        self.asked(py, "pose", &[&word(point), "--b", &format!("{b:?}")], None)
    }

    /// The pose constants b that reach points (x, y), m, as `stillbase reach`.
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> answer = sb.Machine.builtin("nine-link").reach([(0.5, 0.5), (0.55, 0.9)])
    /// >>> [[round(b, 3) for b in interval] for interval in answer["overlap"]]
    /// [[2.216, 2.661]]
    ///
    /// ```
    #[pyo3(signature = (points: "typing.Sequence[typing.Sequence[float]]") -> "dict[str, typing.Any]")]
    fn reach<'py>(&self, py: Python<'py>, points: Vec<[f64; 2]>) -> PyResult<Bound<'py, PyAny>> {
        let words: Vec<String> = points.into_iter().map(word).collect();
        self.asked(py, "reach", &words.iter().map(String::as_str).collect::<Vec<_>>(), None)
    }

    /// Motor torques and base reactions of states of motion: absolute drive angles, rad, rates, rad/s, and
    /// accelerations, rad/s², each of shape (..., drives). They broadcast as arrays of NumPy do. `out` is an earlier
    /// result of the same shape, which is overwritten, after an interrupt in part. The numbers are those of `stillbase
    /// dynamics`, to the last bit.
    ///
    /// ```python
    /// >>> import numpy as np, stillbase as sb
    /// >>> machine = sb.Machine.builtin("nine-link")
    /// >>> machine.dynamics(np.zeros((4, 1, 3)), np.zeros((5, 3)), np.ones(3)).torque.shape
    /// (4, 5, 3)
    ///
    /// ```
    #[pyo3(signature = (
        q: "numpy.typing.ArrayLike",
        qd: "numpy.typing.ArrayLike",
        qdd: "numpy.typing.ArrayLike",
        *,
        out=None,
        threads=1,
    ))]
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

    /// Simulates states of motion on a base that is held, each for a number of steps of dt, s. Motor torques, N m, are
    /// constant meanwhile. Returns absolute drive angles, rad, and rates, rad/s, after the last step.
    ///
    /// `q`, `qd` and `torque` have the shape (..., drives), and broadcast as arrays of NumPy do. `out` is a pair of
    /// arrays for the results, which may be `(q, qd)` itself. After an interrupt some states are advanced, others not.
    ///
    /// A step is one of the classical fourth-order Runge–Kutta method, as `stillbase simulate` makes it: to the last
    /// bit, where that needs no substeps. Nothing chooses the step here: the error of a state is of order dt⁴. Rates
    /// become momenta at the beginning of a call, and rates again at its end. So two calls may differ from one in the
    /// last digits.
    ///
    /// ```python
    /// >>> import numpy as np, stillbase as sb
    /// >>> machine = sb.Machine.builtin("nine-link").set({"gravity": (0, -9.81)})
    /// >>> q, qd = machine.step_batch(np.zeros((1000, 3)), [1, 2, 3], [0, 0, 0], 1e-3, steps=100)
    /// >>> q.shape, q[0].round(6)  # it is balanced and decoupled
    /// ((1000, 3), array([0.1, 0.2, 0.3]))
    ///
    /// ```
    #[pyo3(signature = (
        q: "numpy.typing.ArrayLike",
        qd: "numpy.typing.ArrayLike",
        torque: "numpy.typing.ArrayLike",
        dt,
        *,
        steps=1,
        out=None,
        threads=1,
    ))]
    #[expect(clippy::too_many_arguments, reason = "all but one have a name where this is called")]
    fn step_batch<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        torque: &Bound<'py, PyAny>,
        dt: f64,
        steps: usize,
        out: Option<Angles<'py>>,
        threads: usize,
    ) -> PyResult<Angles<'py>> {
        step(py, &self.machine, [q, qd, torque], EqualSteps { length: dt, count: steps }, out, threads)
    }

    fn __repr__(&self) -> String {
        format!("<stillbase.Machine {}: {} drives, {:.3} kg>", self.name(), self.machine.drives(), self.machine.mass())
    }

    fn __eq__(&self, other: &Self) -> bool {
        *self.machine == *other.machine
    }

    fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        PyString::new(py, &self.to_toml()).hash()
    }

    /// Machines are copied, and sent to workers, as their text.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        Ok((py.get_type::<Self>().getattr("from_toml")?, (self.to_toml(),)))
    }
}
