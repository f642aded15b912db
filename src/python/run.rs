//! [`Run`]: a simulation, with its signals as arrays.

use std::ffi::OsString;
use std::fmt::Write as _;

use numpy::{IntoPyArray, PyArray1};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyInt, PyIterator};
use stillbase_settings::number::significant;
use stillbase_settings::results::find;
use stillbase_simulation::signal_table::SignalTable;

use crate::asked::{carried_out, options, parsed};

/// A simulated motion: a mapping of names to the arrays of its signals, the time, and the verdict.
///
/// ```python
/// >>> import stillbase as sb
/// >>> run = sb.simulate("case-3")
/// >>> float(abs(run["moment/total"]).max()) < 1e-8
/// True
/// >>> "torque/1" in run, dict(run)["torque/1"] is run["torque/1"], run.get("torque/9") is None
/// (True, True, True)
///
/// ```
#[pyclass(frozen, mapping, module = "stillbase")]
pub struct Run {
    /// Time of each row, s.
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> float(sb.simulate("case-1").time[-1])
    /// 1.0
    ///
    /// ```
    #[pyo3(get)]
    time: Py<PyArray1<f64>>,
    /// Names and arrays of all signals.
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> list(sb.simulate("case-1", signals="torque").signals)
    /// ['torque/1', 'torque/2', 'torque/3']
    ///
    /// ```
    #[pyo3(get)]
    signals: Py<PyDict>,
    /// Name and unit of each signal.
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> sb.simulate("case-1").units["torque/1"]
    /// 'N m'
    ///
    /// ```
    #[pyo3(get)]
    units: Py<PyDict>,
    /// The verdict of the command line, with peaks and audit.
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> sb.simulate("case-3").verdict["reactionless"]
    /// True
    ///
    /// ```
    #[pyo3(get)]
    verdict: Py<PyDict>,
    /// Name of the scenario.
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> sb.simulate("case-3").scenario
    /// 'case-3'
    ///
    /// ```
    #[pyo3(get)]
    scenario: String,
}

impl Run {
    fn of(py: Python<'_>, table: SignalTable, answer: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (signals, units) = (PyDict::new(py), PyDict::new(py));
        for column in table.columns {
            units.set_item(&column.path, column.unit)?;
            // The array takes over the numbers.
            signals.set_item(column.path, column.values.into_pyarray(py))?;
        }
        Ok(Self {
            time: table.time.into_pyarray(py).unbind(),
            signals: signals.unbind(),
            units: units.unbind(),
            verdict: answer.get_item("verdict")?.cast_into::<PyDict>()?.unbind(),
            scenario: answer.get_item("scenario")?.extract()?,
        })
    }
}

#[pymethods]
impl Run {
    /// Returns the signal of a name, such as `torque/1`.
    fn __getitem__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        match self.signals.bind(py).get_item(name)? {
            Some(signal) => Ok(signal),
            None => Err(PyKeyError::new_err(format!("no signal {name:?}: want one of run.signals"))),
        }
    }

    /// Returns the number of signals; `len(run.time)` is that of the rows.
    fn __len__(&self, py: Python<'_>) -> usize {
        self.signals.bind(py).len()
    }

    fn __contains__(&self, py: Python<'_>, name: &Bound<'_, PyAny>) -> PyResult<bool> {
        self.signals.bind(py).contains(name)
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyIterator>> {
        self.signals.bind(py).try_iter()
    }

    /// Names of the signals.
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> list(sb.simulate("case-1", signals="torque").keys())
    /// ['torque/1', 'torque/2', 'torque/3']
    ///
    /// ```
    #[pyo3(signature = () -> "typing.KeysView[str]")]
    fn keys<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.signals.bind(py).call_method0("keys")
    }

    /// Arrays of the signals.
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> [array.shape for array in sb.simulate("case-1", signals="torque").values()]
    /// [(1001,), (1001,), (1001,)]
    ///
    /// ```
    #[pyo3(signature = () -> "typing.ValuesView[numpy.typing.NDArray[numpy.float64]]")]
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.signals.bind(py).call_method0("values")
    }

    /// Names and arrays of the signals.
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> {name: array.shape for name, array in sb.simulate("case-1", signals="torque/1").items()}
    /// {'torque/1': (1001,)}
    ///
    /// ```
    #[pyo3(signature = () -> "typing.ItemsView[str, numpy.typing.NDArray[numpy.float64]]")]
    fn items<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.signals.bind(py).call_method0("items")
    }

    /// The signal of a name, or `default` if there is none.
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> sb.simulate("case-1").get("torque/9", 0)
    /// 0
    ///
    /// ```
    #[pyo3(signature = (name, default: "typing.Any" = None) -> "typing.Any")]
    fn get<'py>(
        &self,
        py: Python<'py>,
        name: &Bound<'py, PyAny>,
        default: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        Ok(self.signals.bind(py).get_item(name)?.or(default))
    }

    /// A table of scenario, verdict and figures of the run with their units, which notebooks show.
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> table = sb.simulate("case-1")._repr_html_()
    /// >>> "<th>peak_base_moment</th><td>1.089" in table and "N m" in table
    /// True
    ///
    /// ```
    fn _repr_html_(&self, py: Python<'_>) -> PyResult<String> {
        let verdict = self.verdict.bind(py);
        let escape = py.import("html")?.getattr("escape")?;
        let escaped = |text: &Bound<'_, PyAny>| -> PyResult<String> { escape.call1((text,))?.extract() };
        let (name, sentence) = (self.scenario.as_str().into_pyobject(py)?, verdict.as_any().get_item("sentence")?);
        let mut html = format!("<table><caption>{}: {}</caption>\n", escaped(&name)?, escaped(&sentence)?);
        for (key, value) in verdict.iter() {
            let key: String = key.extract()?;
            let Some(row) =
                find(&["simulate", "verdict", &key]).filter(|row| !row.unit.is_empty() && row.newer.is_empty())
            else {
                continue;
            };
            let all = value.extract::<Vec<Bound<'_, PyAny>>>().unwrap_or_else(|_| vec![value]);
            let Ok(numbers) = all.iter().map(number).collect::<PyResult<Vec<_>>>() else { continue };
            // Writing to a string cannot fail.
            let unit = if row.unit == "1" { "" } else { row.unit };
            let _ = writeln!(html, "<tr><th>{key}</th><td>{} {unit}</td></tr>", numbers.join(", "));
        }
        Ok(html + "</table>")
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (rows, signals) = (self.time.bind(py).len()?, self.__len__(py));
        Ok(format!("<stillbase.Run of {}: {signals} signals in {rows} rows>", self.scenario))
    }
}

/// Returns a number in words; those that count are whole.
fn number(value: &Bound<'_, PyAny>) -> PyResult<String> {
    match value.is_instance_of::<PyInt>() {
        true => Ok(value.str()?.to_string()),
        false => Ok(significant(value.extract()?)),
    }
}

/// Simulates a scenario, built in or a file.
///
/// Options are those of `stillbase simulate`: `set={"plant.payload.mass": 0.1}`, `signals=["torque", "moment/total"]`,
/// `every=10`.
///
/// ```python
/// >>> import stillbase as sb
/// >>> sb.simulate("case-1", signals=["torque", "moment/total"], every=10)
/// <stillbase.Run of case-1: 4 signals in 101 rows>
///
/// ```
#[pyfunction]
#[pyo3(signature = (scenario: "str | os.PathLike[str]", **given: "typing.Any"))]
pub fn simulate(py: Python<'_>, scenario: &Bound<'_, PyAny>, given: Option<&Bound<'_, PyDict>>) -> PyResult<Run> {
    let mut words: Vec<OsString> = vec!["simulate".into(), scenario.str()?.to_string().into(), "--json".into()];
    words.extend(options("simulate", given)?);
    let said = carried_out(py, words, None)?;
    let answer = parsed(py, said.json.as_deref().unwrap_or("{}"))?;
    Run::of(py, said.signals.unwrap_or_default(), &answer)
}
