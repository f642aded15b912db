//! Steps of many simulations at once.

use numpy::{PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use stillbase_mechanics::machine::Machine;
use stillbase_mechanics::planar::{DriveAngles, PerDrive};
use stillbase_simulation::plant::{Base, EqualSteps, Friction, MovingBody};

use crate::arrays::{Rows, empty, in_threads, rows_of_a_part};

/// Angles and rates.
pub type Angles<'py> = (Bound<'py, PyArrayDyn<f64>>, Bound<'py, PyArrayDyn<f64>>);

/// Evaluations of dynamics in a step of the fourth order.
const EVALUATIONS_PER_STEP: usize = 4;

/// Advances states of motion under constant torques on a number of threads; the interpreter is free meanwhile.
///
/// # Errors
/// If shapes do not fit, the step is not finite, or a signal stops the work.
pub fn step<'py>(
    py: Python<'py>,
    machine: &Machine,
    [q, qd, force]: [&Bound<'py, PyAny>; 3],
    steps: EqualSteps,
    out: Option<Angles<'py>>,
    threads: usize,
) -> PyResult<Angles<'py>> {
    let drives = machine.drives();
    if !steps.length.is_finite() {
        return Err(PyValueError::new_err(format!("dt is {}: want a finite time in s", steps.length)));
    }
    // Only the torques stay borrowed: the results may be the arrays that are given.
    let Rows { shape, arrays: [_, _, (torque, has_all)] } =
        Rows::of([("q", q), ("qd", qd), ("torque", force)], drives)?;
    let numpy = py.import("numpy")?;
    let result = match out {
        Some(out) => out,
        None => (empty(py, &shape, &[drives])?, empty(py, &shape, &[drives])?),
    };
    for (name, out) in ["q", "qd"].into_iter().zip([&result.0, &result.1]) {
        if *out.shape() != *[&shape[..], &[drives]].concat() {
            let why =
                format!("out has {name} of the shape {:?}: want {drives} for each state of {shape:?}", out.shape());
            return Err(PyValueError::new_err(why));
        }
        if !out.is_c_contiguous() {
            let why = format!("out has {name} with gaps or in Fortran order: want an array without gaps in order C");
            return Err(PyValueError::new_err(why));
        }
        // Written at once, one of them would spoil what is read after it.
        let others = [("q", q), ("qd", qd), ("torque", force), ("qd of out", result.1.as_any())];
        for (other, array) in
            others.into_iter().filter(|(other, _)| *other != name && *other != format!("{name} of out"))
        {
            if numpy.call_method1("may_share_memory", (out, array))?.extract()? {
                let why = format!("out has {name} in the memory of {other}: want memory of its own, or that of {name}");
                return Err(PyValueError::new_err(why));
            }
        }
    }
    for (out, given) in [(&result.0, q), (&result.1, qd)] {
        numpy.call_method1("copyto", (out, given))?;
    }
    let still = DriveAngles(PerDrive::zeros(drives));
    let body = MovingBody::of(machine, &Friction::default(), &Base::default(), &still);
    let body = body.map_err(|why| PyValueError::new_err(why.to_string()))?;
    {
        let torque = torque.array.as_slice()?;
        let count = shape.iter().product();
        let part = rows_of_a_part(count, threads);
        let (mut q, mut qd) = (result.0.try_readwrite()?, result.1.try_readwrite()?);
        let (q, qd) = (q.as_slice_mut()?, qd.as_slice_mut()?);
        let parts = q.chunks_mut(part * drives).zip(qd.chunks_mut(part * drives));
        let evaluations = count.saturating_mul(steps.count).saturating_mul(EVALUATIONS_PER_STEP);
        in_threads(py, evaluations, parts, |i, (q, qd), stop| {
            let own = if has_all { &torque[i * part * drives..][..q.len()] } else { torque };
            body.advance_under(own, steps, [q, qd], &|| stop.goes_on());
        })?;
    }
    Ok(result)
}
