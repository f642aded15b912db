//! [`Run`]: a simulation, with its signals as arrays.

use std::ffi::OsString;
use std::fmt::Write as _;

use numpy::{IntoPyArray, PyArray1};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use stillbase_settings::number::significant;
use stillbase_settings::results::find;
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

    /// Returns the number of rows.
    fn __len__(&self, py: Python<'_>) -> PyResult<usize> {
        self.time.bind(py).len()
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
            let numbers = value.extract::<Vec<f64>>().or_else(|_| value.extract().map(|number: f64| vec![number]));
            let Ok(numbers) = numbers else { continue };
            let numbers: Vec<String> = numbers.iter().map(|number| significant(*number)).collect();
            // Writing to a string cannot fail.
            let unit = if row.unit == "1" { "" } else { row.unit };
            let _ = writeln!(html, "<tr><th>{key}</th><td>{} {unit}</td></tr>", numbers.join(", "));
        }
        Ok(html + "</table>")
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (rows, signals) = (self.__len__(py)?, self.signals.bind(py).len());
        Ok(format!("<stillbase.Run of {}: {signals} signals in {rows} rows>", self.scenario))
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
