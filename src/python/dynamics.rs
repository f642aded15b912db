//! [`Dynamics`]: torques and base reactions of many states of motion at once, Eqs (1) to (6).

use numpy::{PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use stillbase_mechanics::dynamics::{ExternalLoads, inverse_with_wrench};
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_mechanics::planar::{DriveAngles, PerDrive};

/// Loads of states of motion, as `stillbase dynamics`.
#[pyclass(frozen, module = "stillbase")]
pub struct Dynamics {
    /// Torque of each motor, N m, of shape (n, drives).
    #[pyo3(get)]
    torque: Py<PyArrayDyn<f64>>,
    /// Force on the base, weight included, N, of shape (n, 2).
    #[pyo3(get)]
    base_force: Py<PyArrayDyn<f64>>,
    /// Moment about B on the base, weight included, counter-clockwise, N m, of shape (n,).
    #[pyo3(get)]
    base_moment: Py<PyArrayDyn<f64>>,
}

#[pymethods]
impl Dynamics {
    fn __repr__(&self, py: Python<'_>) -> String {
        format!("<stillbase.Dynamics of {} states>", self.base_moment.bind(py).len())
    }
}

/// States with a state in each row, or one state for all.
struct States<'a> {
    values: &'a [f64],
    stride: usize,
}

impl States<'_> {
    fn at(&self, row: usize, drives: usize) -> PerDrive {
        let from = row * self.stride;
        PerDrive::from_fn(drives, |k| self.values[from + k])
    }
}

/// Results of some rows.
struct Rows<'a> {
    torque: &'a mut [f64],
    force: &'a mut [f64],
    moment: &'a mut [f64],
}

impl Rows<'_> {
    /// Splits off the first rows.
    fn split(self, rows: usize, drives: usize) -> (Self, Self) {
        let (torque, torques) = self.torque.split_at_mut(rows * drives);
        let (force, forces) = self.force.split_at_mut(rows * 2);
        let (moment, moments) = self.moment.split_at_mut(rows);
        (Self { torque, force, moment }, Self { torque: torques, force: forces, moment: moments })
    }

    fn fill(self, inertia: &Inertia, around: &ExternalLoads, states: &[States<'_>; 3], from: usize) {
        let drives = inertia.drives();
        for i in 0..self.moment.len() {
            let [q, qd, qdd] = [0, 1, 2].map(|which: usize| states[which].at(from + i, drives));
            let (torque, wrench) = inverse_with_wrench(inertia, &DriveAngles(q).units(), &qd, &qdd, around);
            let total = wrench.total();
            self.torque[i * drives..(i + 1) * drives].copy_from_slice(&inertia.motors().motor_torques(&torque));
            (self.force[2 * i], self.force[2 * i + 1]) = (total.force.re, total.force.im);
            self.moment[i] = total.moment;
        }
    }
}

/// Returns what may be an array as one of numbers without gaps: the same if it is one.
fn dense<'py>(py: Python<'py>, of: &Bound<'py, PyAny>) -> PyResult<PyReadonlyArrayDyn<'py, f64>> {
    let options = PyDict::new(py);
    options.set_item("dtype", "float64")?;
    options.set_item("order", "C")?;
    py.import("numpy")?.call_method("asarray", (of,), Some(&options))?.extract()
}

/// Evaluates states of motion on a number of threads; the interpreter is free meanwhile.
///
/// # Errors
/// If shapes do not fit.
pub fn evaluate(
    py: Python<'_>,
    machine: &Machine,
    states: [&Bound<'_, PyAny>; 3],
    out: Option<Py<Dynamics>>,
    threads: usize,
) -> PyResult<Py<Dynamics>> {
    let drives = machine.drives();
    let arrays = [dense(py, states[0])?, dense(py, states[1])?, dense(py, states[2])?];
    let mut rows: Option<usize> = None;
    for (name, array) in ["q", "qd", "qdd"].into_iter().zip(&arrays) {
        let own = match *array.shape() {
            [n] if n == drives => None,
            // One row serves all.
            [1, n] if n == drives => Some(1),
            [m, n] if n == drives => Some(m),
            ref other => {
                let why =
                    format!("{name} has the shape {other:?}: want ({drives},) or (n, {drives}), a column a drive");
                return Err(PyValueError::new_err(why));
            }
        };
        if let (Some(rows), Some(own)) = (rows, own)
            && rows != own
            && rows != 1
            && own != 1
        {
            return Err(PyValueError::new_err(format!(
                "{name} has {own} rows: want {rows}, as the others have, or one"
            )));
        }
        rows = rows.max(own);
    }
    let count = rows.unwrap_or(1);
    let result = match out {
        Some(out) => out,
        None => {
            let shape = |tail: &[usize]| rows.into_iter().chain(tail.iter().copied()).collect::<Vec<_>>();
            let empty = |tail: &[usize]| PyArrayDyn::zeros(py, shape(tail), false).unbind();
            let new = Dynamics { torque: empty(&[drives]), base_force: empty(&[2]), base_moment: empty(&[]) };
            Py::new(py, new)?
        }
    };
    {
        let own = result.get();
        let [torque, force, moment] = [&own.torque, &own.base_force, &own.base_moment].map(|array| array.bind(py));
        if [torque.len(), force.len(), moment.len()] != [count * drives, count * 2, count] {
            let why = format!("out holds {} states of another shape: want {count} of {drives} drives", moment.len());
            return Err(PyValueError::new_err(why));
        }
        let [mut torque, mut force, mut moment] =
            [torque.try_readwrite()?, force.try_readwrite()?, moment.try_readwrite()?];
        let results =
            Rows { torque: torque.as_slice_mut()?, force: force.as_slice_mut()?, moment: moment.as_slice_mut()? };
        let given = [arrays[0].as_slice()?, arrays[1].as_slice()?, arrays[2].as_slice()?];
        let stride = |which: usize| if arrays[which].len() == drives { 0 } else { drives };
        let states = [0, 1, 2].map(|which| States { values: given[which], stride: stride(which) });
        let inertia = Inertia::of(machine);
        let around = ExternalLoads { gravity: machine.gravity(), ..ExternalLoads::default() };
        let most = std::thread::available_parallelism().map_or(1, usize::from);
        py.detach(|| in_threads(results, &inertia, &around, &states, threads.clamp(1, most)));
    }
    Ok(result)
}

fn in_threads(results: Rows<'_>, inertia: &Inertia, around: &ExternalLoads, states: &[States<'_>; 3], threads: usize) {
    let count = results.moment.len();
    let each = count.div_ceil(threads).max(1);
    if threads == 1 || count <= each {
        return results.fill(inertia, around, states, 0);
    }
    std::thread::scope(|scope| {
        let (mut rest, mut from) = (results, 0);
        while from < count {
            let own = each.min(count - from);
            let (now, later) = rest.split(own, inertia.drives());
            scope.spawn(move || now.fill(inertia, around, states, from));
            (rest, from) = (later, from + own);
        }
    });
}
