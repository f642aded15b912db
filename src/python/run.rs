//! [`Run`]: a simulation, with its signals as arrays.

use std::ffi::OsString;

use numpy::{IntoPyArray, PyArray1};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use stillbase_simulation::signal_table::SignalTable;

use crate::asked::{carried_out, options, parsed};

/// A simulated motion: the time, every signal by its name, and the verdict.
///
/// ```python
/// >>> import stillbase as sb
/// >>> run = sb.simulate("case-3")
/// >>> float(abs(run["moment/total"]).max()) < 1e-8
/// True
///
/// ```
#[pyclass(frozen, module = "stillbase")]
pub struct Run {
    /// Time of each row, s.
    #[pyo3(get)]
    time: Py<PyArray1<f64>>,
    /// Names and arrays of all signals.
    #[pyo3(get)]
    signals: Py<PyDict>,
    /// Name and unit of each signal.
    #[pyo3(get)]
    units: Py<PyDict>,
    /// The verdict of the command line, with peaks and audit.
    #[pyo3(get)]
    verdict: Py<PyAny>,
    /// Name of the scenario.
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
            verdict: answer.get_item("verdict")?.unbind(),
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

    /// Returns the number of rows.
    fn __len__(&self, py: Python<'_>) -> PyResult<usize> {
        self.time.bind(py).len()
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (rows, signals) = (self.__len__(py)?, self.signals.bind(py).len());
        Ok(format!("<stillbase.Run of {}: {signals} signals in {rows} rows>", self.scenario))
    }
}

/// Simulates a scenario, built in or a file.
///
/// Options are those of `stillbase simulate`: `set={"plant.payload.mass": 0.1}`, `signals=["torque", "moment/total"]`, `every=10`.
#[pyfunction]
#[pyo3(signature = (scenario, **given))]
pub fn simulate(py: Python<'_>, scenario: &Bound<'_, PyAny>, given: Option<&Bound<'_, PyDict>>) -> PyResult<Run> {
    let mut words: Vec<OsString> = vec!["simulate".into(), scenario.str()?.to_string().into(), "--json".into()];
    words.extend(options(given)?);
    let said = carried_out(py, words, None)?;
    let answer = parsed(py, said.json.as_deref().unwrap_or("{}"))?;
    Run::of(py, said.signals.unwrap_or_default(), &answer)
}
