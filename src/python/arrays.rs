//! Arrays of states, a drive a column: their shapes, and work on their rows in threads.

use numpy::{PyArrayDyn, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use stillbase_commands::StopFlag;

use crate::watched::watched;

/// An array of numbers without gaps.
pub struct Dense<'py> {
    pub array: PyReadonlyArrayDyn<'py, f64>,
}

impl<'py> Dense<'py> {
    /// Returns what may be an array as one of numbers without gaps: the same if it is one.
    pub fn of(of: &Bound<'py, PyAny>) -> PyResult<Self> {
        let options = PyDict::new(of.py());
        options.set_item("dtype", "float64")?;
        options.set_item("order", "C")?;
        Ok(Self { array: numpy(of.py())?.call_method("asarray", (of,), Some(&options))?.extract()? })
    }

    /// Returns the shape without the last axis, which has an element for each drive.
    ///
    /// # Errors
    /// If it has not.
    fn leading(&self, name: &str, drives: usize) -> PyResult<&[usize]> {
        match self.array.shape() {
            [leading @ .., n] if *n == drives => Ok(leading),
            other => {
                let why = format!("{name} has the shape {other:?}: want (..., {drives}), a column a drive");
                Err(PyValueError::new_err(why))
            }
        }
    }

    /// Returns the array with the rows of a shape, and whether it has them; otherwise it has one row for all.
    fn rows(self, shape: &[usize], drives: usize) -> PyResult<(Self, bool)> {
        let is_one = self.array.len() == drives;
        let count: usize = shape.iter().product();
        if is_one || self.array.len() == count * drives {
            return Ok((self, !is_one));
        }
        let all: Vec<usize> = shape.iter().copied().chain([drives]).collect();
        let wide = numpy(self.array.py())?.call_method1("broadcast_to", (self.array.as_any(), all))?;
        Ok((Self::of(&wide)?, true))
    }
}

fn numpy(py: Python<'_>) -> PyResult<Bound<'_, PyModule>> {
    py.import("numpy")
}

/// Rows of states that broadcast together as arrays of NumPy do.
pub struct Rows<'py, const K: usize> {
    /// Shape of the states: that of the arrays without the axis of the drives.
    pub shape: Vec<usize>,
    /// The arrays, and whether each has all rows; otherwise it has one row for all.
    pub arrays: [(Dense<'py>, bool); K],
}

impl<'py, const K: usize> Rows<'py, K> {
    /// Broadcasts arrays of a number of drives.
    ///
    /// # Errors
    /// If an array has another number of columns, or its rows do not fit those of the others.
    pub fn of(given: [(&str, &Bound<'py, PyAny>); K], drives: usize) -> PyResult<Self> {
        let mut shape: Vec<usize> = Vec::new();
        let mut arrays = Vec::with_capacity(K);
        for (name, of) in given {
            let dense = Dense::of(of)?;
            let own = dense.leading(name, drives)?;
            let more = own.len().saturating_sub(shape.len());
            shape.splice(0..0, own[..more].iter().copied());
            let from = shape.len() - own.len();
            for (all, one) in shape[from..].iter_mut().zip(own) {
                if *all != *one && *all != 1 && *one != 1 {
                    let why = format!("{name} has {one} rows where the arrays before it have {all}: want {all}, or 1");
                    return Err(PyValueError::new_err(why));
                }
                *all = if *all == 1 { *one } else { *all };
            }
            arrays.push(dense);
        }
        let mut arrays = arrays.into_iter().map(|dense| dense.rows(&shape, drives)).collect::<PyResult<Vec<_>>>()?;
        let arrays = std::array::from_fn(|_| arrays.remove(0));
        Ok(Self { shape, arrays })
    }
}

/// Returns a new array: for each state of a shape its own numbers, in one axis or none.
pub fn empty<'py>(py: Python<'py>, shape: &[usize], own: &[usize]) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    Ok(numpy(py)?.call_method1("empty", ([shape, own].concat(),))?.cast_into()?)
}

/// Returns the number of rows of a part, so that there are as many parts as threads, and not more than processors.
pub fn rows_of_a_part(count: usize, threads: usize) -> usize {
    let most = std::thread::available_parallelism().map_or(1, usize::from);
    count.div_ceil(threads.clamp(1, most)).max(1)
}

/// Most evaluations of dynamics that are made in the thread that asks: they take about a millisecond, and need no look
/// at signals.
const FEW_EVALUATIONS: usize = 10_000;

/// Does the work of each part in a thread of its own, until a signal of Python stops it; the interpreter is free
/// meanwhile. All parts together take a number of evaluations of dynamics; few are made in this thread.
///
/// # Errors
/// If a signal stops the work.
pub fn in_threads<T: Send>(
    py: Python<'_>,
    evaluations: usize,
    parts: impl ExactSizeIterator<Item = T> + Send,
    work: impl Fn(usize, T, &StopFlag) + Sync,
) -> PyResult<()> {
    if evaluations <= FEW_EVALUATIONS {
        let stop = StopFlag::default();
        py.detach(|| parts.enumerate().for_each(|(i, part)| work(i, part, &stop)));
        return Ok(());
    }
    watched(py, |stop| {
        if parts.len() < 2 {
            return parts.for_each(|part| work(0, part, stop));
        }
        std::thread::scope(|scope| {
            let work = &work;
            parts.enumerate().for_each(|(i, part)| _ = scope.spawn(move || work(i, part, stop)));
        });
    })
}
