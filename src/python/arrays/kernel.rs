//! Smoothing kernels.

use super::input::{self, Numbers};
use super::output::array_or_number;
use crate::kernel::KernelName;
use pyo3::prelude::*;
use rayon::prelude::*;

/// A smoothing kernel W(r, h) in one, two or three dimensions; made by :func:`kernel`.
#[pyclass(frozen, module = "kolk._core")]
pub(super) struct Kernel {
    name: KernelName,
    dim: usize,
}

/// The smoothing kernel of a name.
///
/// Parameters
/// ----------
/// name : str
///     ``"wendland-c2"``, ``"wendland-c4"``, ``"wendland-c6"``, ``"cubic"`` or ``"quintic"``.
/// dim : int
///     1, 2 or 3. Wendland's functions are other polynomials in one dimension.
///
/// Returns
/// -------
/// Kernel
///
/// Raises
/// ------
/// kolk.ArrayError
///     For another name or dimension.
#[pyfunction]
pub(super) fn kernel(name: &Bound<'_, PyAny>, dim: &Bound<'_, PyAny>) -> PyResult<Kernel> {
    let name = input::kernel_name("name", Some(name))?;
    match dim.extract::<usize>() {
        Ok(dim @ 1..=3) => Ok(Kernel { name, dim }),
        _ => Err(input::wrong("dim", dim.repr()?, "1, 2 or 3")),
    }
}

#[pymethods]
impl Kernel {
    /// Its name.
    #[getter]
    fn name(&self) -> &'static str {
        self.name.as_str()
    }

    /// Its dimension: 1, 2 or 3.
    #[getter]
    fn dim(&self) -> usize {
        self.dim
    }

    /// Radius of its support in smoothing lengths.
    #[getter]
    fn support(&self) -> f64 {
        self.name.support()
    }

    /// W(r, h).
    ///
    /// Parameters
    /// ----------
    /// r : array_like
    ///     Distances [m], zero or positive, of any shape.
    /// h : float
    ///     Smoothing length [m].
    ///
    /// Returns
    /// -------
    /// float or ndarray
    ///     W [m^-dim], of r's shape; zero beyond the support.
    ///
    /// Raises
    /// ------
    /// kolk.ArrayError
    ///     For negative or non-finite distances, or a smoothing length that is not positive.
    fn value<'py>(
        &self,
        r: &Bound<'py, PyAny>,
        h: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (name, dim) = (self.name, self.dim);
        evaluate(r, h, move |r, h| name.value(dim, r, h))
    }

    /// dW/dr (r, h): the gradient of W along the line to the other particle.
    ///
    /// Parameters
    /// ----------
    /// r : array_like
    ///     Distances [m], zero or positive, of any shape.
    /// h : float
    ///     Smoothing length [m].
    ///
    /// Returns
    /// -------
    /// float or ndarray
    ///     dW/dr [m^-(dim+1)], of r's shape; zero or negative.
    ///
    /// Raises
    /// ------
    /// kolk.ArrayError
    ///     For negative or non-finite distances, or a smoothing length that is not positive.
    fn gradient<'py>(
        &self,
        r: &Bound<'py, PyAny>,
        h: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (name, dim) = (self.name, self.dim);
        evaluate(r, h, move |r, h| name.gradient(dim, r, h))
    }

    fn __repr__(&self) -> String {
        format!("kolk.kernel({:?}, {})", self.name.as_str(), self.dim)
    }
}

fn evaluate<'py>(
    r: &Bound<'py, PyAny>,
    h: &Bound<'py, PyAny>,
    f: impl Fn(f64, f64) -> f64 + Sync + Send,
) -> PyResult<Bound<'py, PyAny>> {
    let py = r.py();
    let r = Numbers::read("r", r)?;
    r.each(|r| r >= 0.0, "zero or positive distances")?;
    let h = input::positive("h", h)?;
    let values = r.values();
    let result: Vec<f64> = py.detach(|| {
        values
            .par_iter()
            .with_min_len(4096)
            .map(|&r| f(r, h))
            .collect()
    });
    array_or_number(py, r.shape(), &result)
}
