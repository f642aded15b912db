//! [`Dynamics`]: torques and base reactions of many states of motion at once, Eqs (1) to (6).

use numpy::{PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use stillbase_mechanics::dynamics::{ExternalLoads, by_drives, torques_with_wrench};
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_mechanics::planar::unit;

use crate::arrays::{Rows, empty, in_threads, rows_of_a_part};

/// Loads of states of motion, as `stillbase dynamics`.
///
/// ```python
/// >>> import stillbase as sb
/// >>> loads = sb.Machine.builtin("spot").dynamics([0, 1, 2], [0.1, 0, 0], [0, 0, 0])
/// >>> loads.torque.shape, loads.base_force.shape, loads.base_moment.shape
/// ((3,), (2,), ())
///
/// ```
#[pyclass(frozen, module = "stillbase")]
pub struct Dynamics {
    /// Torque of each motor, N m, of shape (..., drives).
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> loads = sb.Machine.builtin("nine-link").dynamics([0, 1, 2], [0, 0, 0], [1, 1, 1])
    /// >>> loads.torque.round(6)  # the mass matrix is diagonal
    /// array([1.367926, 0.159698, 0.174942])
    ///
    /// ```
    #[pyo3(get)]
    torque: Py<PyArrayDyn<f64>>,
    /// Force on the base in its axes, weight included, N, of shape (..., 2).
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> loads = sb.Machine.builtin("nine-link").dynamics([0, 1, 2], [1, 0, 0], [1, 0, 0])
    /// >>> bool(abs(loads.base_force).max() < 1e-12)  # the machine is balanced
    /// True
    ///
    /// ```
    #[pyo3(get)]
    base_force: Py<PyArrayDyn<f64>>,
    /// Moment about B on the base, weight included, counter-clockwise, N m, of shape (...).
    ///
    /// ```python
    /// >>> import stillbase as sb
    /// >>> loads = sb.Machine.builtin("nine-link").dynamics([0, 1, 2], [0, 0, 0], [1, 0, 0])
    /// >>> round(float(loads.base_moment), 6)
    /// -1.367926
    ///
    /// ```
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
    is_one: bool,
}

/// Results of some rows.
struct Results<'a> {
    torque: &'a mut [f64],
    force: &'a mut [f64],
    moment: &'a mut [f64],
}

/// Number of rows after which a thread asks again whether to go on; they take less than a millisecond.
const ROWS_PER_QUESTION: usize = 4096;

impl<'a> Results<'a> {
    /// Splits the results into parts of a number of rows.
    fn parts(self, rows: usize, drives: usize) -> impl ExactSizeIterator<Item = Self> + Send {
        let parts = self.torque.chunks_mut(rows * drives).zip(self.force.chunks_mut(2 * rows));
        parts.zip(self.moment.chunks_mut(rows)).map(|((torque, force), moment)| Results { torque, force, moment })
    }
}

/// Fills results with the loads of the states from a row on.
#[inline(never)]
fn fill<const N: usize>(of: (&Inertia, &ExternalLoads), states: &[States<'_>; 3], from: usize, results: Results<'_>) {
    let (inertia, around) = of;
    let is_one = states.each_ref().map(|states| states.is_one);
    let rows = states.each_ref().map(|states| {
        let all = states.values.as_chunks::<N>().0;
        if states.is_one { all } else { &all[from..][..results.moment.len()] }
    });
    let torques = results.torque.as_chunks_mut::<N>().0.iter_mut();
    let forces = results.force.as_chunks_mut::<2>().0.iter_mut();
    for (i, ((torque, force), moment)) in torques.zip(forces).zip(results.moment).enumerate() {
        let [q, qd, qdd] = std::array::from_fn(|k| &rows[k][if is_one[k] { 0 } else { i }]);
        let (own, wrench) = torques_with_wrench(inertia, &q.map(unit), qd, qdd, around);
        let total = wrench.total();
        *torque = own;
        inertia.motors().transform_to_motor_torques(torque);
        *force = [total.force.re, total.force.im];
        *moment = total.moment;
    }
}

/// Evaluates states of motion on a number of threads; the interpreter is free meanwhile.
///
/// # Errors
/// If shapes do not fit, or a signal stops the work.
pub fn evaluate(
    py: Python<'_>,
    machine: &Machine,
    [q, qd, qdd]: [&Bound<'_, PyAny>; 3],
    out: Option<Py<Dynamics>>,
    threads: usize,
) -> PyResult<Py<Dynamics>> {
    let drives = machine.drives();
    let rows = Rows::of([("q", q), ("qd", qd), ("qdd", qdd)], drives)?;
    let count: usize = rows.shape.iter().product();
    let result = match out {
        Some(out) => out,
        None => {
            let empty = |own: &[usize]| empty(py, &rows.shape, own).map(Bound::unbind);
            let new = Dynamics { torque: empty(&[drives])?, base_force: empty(&[2])?, base_moment: empty(&[])? };
            Py::new(py, new)?
        }
    };
    {
        let own = result.get();
        let [torque, force, moment] = [&own.torque, &own.base_force, &own.base_moment].map(|array| array.bind(py));
        if *moment.shape() != *rows.shape || torque.len() != count * drives {
            let why = format!(
                "out has torques of the shape {:?}: want {drives} for each state of {:?}",
                torque.shape(),
                rows.shape
            );
            return Err(PyValueError::new_err(why));
        }
        let [mut torque, mut force, mut moment] =
            [torque.try_readwrite()?, force.try_readwrite()?, moment.try_readwrite()?];
        let [torque, force, moment] = [torque.as_slice_mut()?, force.as_slice_mut()?, moment.as_slice_mut()?];
        let states = |k: usize| -> PyResult<_> {
            let (dense, has_all) = &rows.arrays[k];
            Ok(States { values: dense.array.as_slice()?, is_one: !has_all })
        };
        let states = [states(0)?, states(1)?, states(2)?];
        let inertia = Inertia::of(machine);
        let around = ExternalLoads { gravity: machine.gravity(), ..ExternalLoads::default() };
        let part = rows_of_a_part(count, threads);
        let results = Results { torque, force, moment };
        in_threads(py, count, results.parts(part, drives), |i, results, stop| {
            let portions = results.parts(ROWS_PER_QUESTION, drives).enumerate();
            for (k, results) in portions.take_while(|_| stop.goes_on()) {
                let from = i * part + k * ROWS_PER_QUESTION;
                by_drives!(drives, fill((&inertia, &around), &states, from, results));
            }
        })?;
    }
    Ok(result)
}
