//! [`ask`]: commands that are carried out within the interpreter.

use std::ffi::OsString;

use pyo3::create_exception;
use pyo3::exceptions::{PyException, PyTypeError, PyUserWarning};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyString, PyTuple};
use stillbase_commands::{InProcessAnswer, answer_until, takes_one_value_each};
use stillbase_files::text::with_standard_input;

use crate::machine::Machine;
use crate::watched::watched;

create_exception!(
    stillbase,
    StillbaseError,
    PyException,
    "Why a command did not finish; `answer` holds what it answered before.

>>> import stillbase as sb
>>> try:
...     sb.Machine.builtin('nine-link').reach([(0.5, 0.5), (-0.9, -0.8)])
... except sb.StillbaseError as why:
...     print(len(why.answer['points']))
2"
);
create_exception!(
    stillbase,
    NoAnswer,
    StillbaseError,
    "The question has no answer: the reason, and ways out of it.

>>> import stillbase as sb
>>> try:
...     sb.Machine.builtin('nine-link').reach([(5, 5)])
... except sb.NoAnswer as why:
...     print(str(why).splitlines()[0])
(5.000, 5.000) m: the point is 7.0711 m from the base, but the arms reach only 1.2600 m"
);
create_exception!(
    stillbase,
    WrongInput,
    StillbaseError,
    "The input is wrong: where, and what would be right.

>>> import stillbase as sb
>>> try:
...     sb.Machine.builtin('nine-link').set({'link.1.mass': -2})
... except sb.WrongInput as why:
...     print(why)
mass of link 1 (link.1.mass) is -2: want 1e-15 to 1000000 kg"
);

/// Returns a value as the command line takes it: lists with commas, `true` and `false` in small letters.
pub fn setting(value: &Bound<'_, PyAny>) -> PyResult<String> {
    if let Ok(is_so) = value.extract::<bool>() {
        return Ok(is_so.to_string());
    }
    if value.is_instance_of::<PyDict>() || value.is_instance_of::<PyBytes>() {
        return Err(PyTypeError::new_err(format!("{}: want a number, a word or a list", value.repr()?)));
    }
    if is_list(value)? {
        let parts = value.try_iter()?.map(|part| setting(&part?)).collect::<PyResult<Vec<_>>>()?;
        return Ok(parts.join(","));
    }
    Ok(value.str()?.to_string())
}

/// Returns options as words of the command line: `min_reach=1.2` is `--min-reach 1.2`, `keep=True` is `--keep`. A list
/// is one word with commas, or the option repeated where a command wants that; a list of lists, or a dictionary, is the
/// option repeated. `None` and `False` leave an option out.
pub fn options(command: &str, given: Option<&Bound<'_, PyDict>>) -> PyResult<Vec<OsString>> {
    let mut words: Vec<OsString> = Vec::new();
    for (key, value) in given.into_iter().flat_map(|given| given.iter()) {
        let name = key.str()?.to_string();
        let name = format!("--{}", name.trim_end_matches('_').replace('_', "-"));
        let mut add = |value: String| words.extend([name.clone().into(), value.into()]);
        if let Ok(pairs) = value.cast::<PyDict>() {
            for (key, value) in pairs.iter() {
                add(format!("{}={}", key.str()?, setting(&value)?));
            }
        } else if value.is_none() {
        } else if let Ok(is_given) = value.extract::<bool>() {
            words.extend(is_given.then(|| name.into()));
        } else if is_list(&value)? {
            let parts = value.try_iter()?.collect::<PyResult<Vec<_>>>()?;
            let are_lists = parts.iter().map(is_list).collect::<PyResult<Vec<_>>>()?;
            let parts = parts.iter().map(setting).collect::<PyResult<Vec<_>>>()?;
            let is_repeated = !are_lists.contains(&false) || takes_one_value_each(command, &name[2..]);
            if !parts.is_empty() && is_repeated {
                parts.into_iter().for_each(add);
            } else {
                add(parts.join(","));
            }
        } else {
            add(setting(&value)?);
        }
    }
    Ok(words)
}

fn is_list(value: &Bound<'_, PyAny>) -> PyResult<bool> {
    // An array without dimensions is a number, although it has the method.
    let is_number = value.hasattr("ndim")? && value.getattr("ndim")?.eq(0)?;
    Ok(value.hasattr("__iter__")? && !is_number && !value.is_instance_of::<PyString>())
}

/// Carries out a command line. `input` takes the place of standard input. Notes become warnings, and failures
/// exceptions.
///
/// # Errors
/// If the command fails, or a signal stops it.
pub fn carried_out(py: Python<'_>, words: Vec<OsString>, input: Option<String>) -> PyResult<InProcessAnswer> {
    let said = watched(py, |stop| match input {
        Some(text) => with_standard_input(text, || answer_until(words, stop)),
        None => answer_until(words, stop),
    })?;
    for note in &said.notes {
        let note = std::ffi::CString::new(note.as_str())?;
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &note, 1)?;
    }
    if said.status == 0 {
        return Ok(said);
    }
    let why = said.errors.join("\n");
    let error = if said.status == 1 { NoAnswer::new_err(why) } else { WrongInput::new_err(why) };
    let answer = said.json.as_deref().map(|json| parsed(py, json)).transpose()?;
    Err(with_answer(py, error, answer)?)
}

/// Returns an exception with what was answered before.
fn with_answer(py: Python<'_>, error: PyErr, answer: Option<Bound<'_, PyAny>>) -> PyResult<PyErr> {
    error.value(py).setattr("answer", answer)?;
    Ok(error)
}

/// Returns the exception of wrong input.
pub fn wrong_input(py: Python<'_>, why: impl ToString) -> PyErr {
    with_answer(py, WrongInput::new_err(why.to_string()), None).unwrap_or_else(|error| error)
}

/// Returns JSON as Python's objects.
pub fn parsed<'py>(py: Python<'py>, json: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?.call_method1("loads", (json,))
}

/// Carries out a command line with `--json` and returns its answer; `None` if there is none.
pub fn answered<'py>(py: Python<'py>, mut words: Vec<OsString>, input: Option<String>) -> PyResult<Bound<'py, PyAny>> {
    words.push("--json".into());
    match carried_out(py, words, input)?.json {
        Some(json) => parsed(py, &json),
        None => Ok(py.None().into_bound(py)),
    }
}

/// Carries out a command of the command line, and returns its answer as dictionaries and lists. A machine is named, or
/// is a `Machine`. Options are keywords: `min_reach=1.2` is `--min-reach 1.2`, `keep=True` is `--keep`,
/// `set={"payload.mass": 0.1}` is `--set payload.mass=0.1`; a list repeats an option that may be repeated.
///
/// ```python
/// >>> import stillbase as sb
/// >>> sb.ask("reach", "nine-link", "0.5,0.5")["period"] > 6
/// True
///
/// ```
#[pyfunction]
#[pyo3(name = "ask", signature = (*words: "typing.Any", **given: "typing.Any") -> "typing.Any")]
pub fn ask<'py>(
    py: Python<'py>,
    words: &Bound<'py, PyTuple>,
    given: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let mut line = Line::default();
    words.iter().try_for_each(|word| line.add(&word))?;
    line.asked(py, given)
}

/// Plans a motion through points (x, y), m, as `stillbase plan` with its options: `shape="line"`, `b=2.4`,
/// `law="fastest"`. The first word is a machine, or a scenario, whose own points are the default. The plan is written
/// as a scenario to `output`, a new file.
///
/// ```python
/// >>> import stillbase as sb
/// >>> plan = sb.plan("nine-link", [(0.5, 0.5), (0.55, 0.9)], shape="line", b=2.4, output="line.toml", force=True)
/// >>> plan["peak_base_moment"] < 1e-9
/// True
/// >>> sb.simulate("line.toml").verdict["reactionless"]
/// True
///
/// ```
#[pyfunction]
#[pyo3(signature = (
    machine: "str | os.PathLike[str] | Machine",
    points: "typing.Iterable[typing.Sequence[float]] | None" = None,
    **given: "typing.Any",
) -> "dict[str, typing.Any]")]
pub fn plan<'py>(
    py: Python<'py>,
    machine: &Bound<'py, PyAny>,
    points: Option<&Bound<'py, PyAny>>,
    given: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let mut line = Line::of("plan");
    line.add(machine)?;
    points.into_iter().try_for_each(|points| points.try_iter()?.try_for_each(|point| line.add(&point?)))?;
    line.asked(py, given)
}

/// Records a scenario, or several, for the Rerun viewer, as `stillbase headless` with its options. `output` is the
/// file, which ends in .rrd.
///
/// ```python
/// >>> import stillbase as sb
/// >>> answer = sb.record(["case-1", "case-3"], "cases.rrd", force=True)
/// >>> [(run["scenario"], run["reactionless"]) for run in answer["recordings"]]
/// [('case-1', False), ('case-3', True)]
///
/// ```
#[pyfunction]
#[pyo3(signature = (
    scenario: "str | os.PathLike[str] | typing.Sequence[str | os.PathLike[str]]",
    output: "str | os.PathLike[str]",
    **given: "typing.Any",
) -> "dict[str, typing.Any]")]
pub fn record<'py>(
    py: Python<'py>,
    scenario: &Bound<'py, PyAny>,
    output: &Bound<'py, PyAny>,
    given: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let mut line = Line::of("headless");
    if is_list(scenario)? {
        scenario.try_iter()?.try_for_each(|one| line.add(&one?))?;
    } else {
        line.add(scenario)?;
    }
    line.words.extend(["--output".into(), setting(output)?.into()]);
    line.asked(py, given)
}

/// A command line, and the machine that stands in the place of standard input, if any.
#[derive(Default)]
struct Line {
    words: Vec<OsString>,
    input: Option<String>,
}

impl Line {
    fn of(command: &str) -> Self {
        Self { words: vec![command.into()], input: None }
    }

    /// Adds a word.
    fn add(&mut self, word: &Bound<'_, PyAny>) -> PyResult<()> {
        let Ok(machine) = word.cast::<Machine>() else {
            self.words.push(setting(word)?.into());
            return Ok(());
        };
        if self.input.replace(machine.get().input()).is_some() {
            return Err(PyTypeError::new_err("two machines without a name: want at most one, and files of the others"));
        }
        self.words.push("-".into());
        Ok(())
    }

    fn asked<'py>(mut self, py: Python<'py>, given: Option<&Bound<'py, PyDict>>) -> PyResult<Bound<'py, PyAny>> {
        let command = self.words.first().map(|word| word.to_string_lossy().into_owned()).unwrap_or_default();
        self.words.extend(options(&command, given)?);
        answered(py, self.words, self.input)
    }
}

/// Carries out a command line as the program does, and returns its exit status. The first word is the name of the
/// program. With `ends_process` signals end the process at once and leave no half-written file, as they do for the program.
///
/// ```python
/// >>> from stillbase._stillbase import main
/// >>> main(["stillbase", "check", "spot", "--strange"])
/// 2
///
/// ```
#[pyfunction]
#[pyo3(signature = (words, ends_process=false))]
pub fn main(py: Python<'_>, words: Vec<OsString>, ends_process: bool) -> u8 {
    if ends_process {
        stillbase_commands::watch();
    }
    py.detach(|| stillbase_commands::carry_out(words))
}
