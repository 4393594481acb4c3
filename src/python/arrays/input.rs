//! Arguments from Python, checked: every message names the argument, what was found, and what is allowed.

use crate::kernel::KernelName;
use crate::neighbours::search::Periods;
use crate::operators::Cloud;
use numpy::{PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

pyo3::import_exception!(kolk.errors, ArrayError);

/// The error for an argument.
pub(super) fn wrong(name: &str, found: impl std::fmt::Display, allowed: &str) -> PyErr {
    ArrayError::new_err(format!("{name}: found {found}; allowed: {allowed}"))
}

/// An array of finite doubles in C order: the caller's own where it is one, else a copy.
pub(super) struct Numbers<'py> {
    name: &'static str,
    array: PyReadonlyArrayDyn<'py, f64>,
}

impl<'py> Numbers<'py> {
    /// Reads anything that NumPy makes an array of real, finite numbers of.
    pub(super) fn read(name: &'static str, object: &Bound<'py, PyAny>) -> PyResult<Self> {
        const ALLOWED: &str = "an array of float64 (float32 and integers are converted)";
        let numpy = object.py().import("numpy")?;
        let array = numpy.call_method1("asarray", (object,)).map_err(|error| {
            wrong(
                name,
                format_args!("{} that is no array ({error})", kind_of(object)),
                ALLOWED,
            )
        })?;
        let dtype = array.getattr("dtype")?;
        if !matches!(
            dtype.getattr("kind")?.extract::<String>()?.as_str(),
            "f" | "i" | "u"
        ) {
            return Err(wrong(name, format_args!("dtype {}", dtype.str()?), ALLOWED));
        }
        let options = PyDict::new(object.py());
        options.set_item("dtype", "float64")?;
        options.set_item("requirements", ["C_CONTIGUOUS", "ALIGNED", "ENSUREARRAY"])?;
        let array = numpy.call_method("require", (array,), Some(&options))?;
        let array = array
            .cast_into::<PyArrayDyn<f64>>()
            .map_err(PyErr::from)?
            .readonly();
        let numbers = Self { name, array };
        numbers.each(|x| x.is_finite(), "finite numbers")?;
        Ok(numbers)
    }

    /// Its length along every axis.
    pub(super) fn shape(&self) -> &[usize] {
        self.array.shape()
    }

    /// All numbers, in C order.
    pub(super) fn values(&self) -> &[f64] {
        // `read`, which alone makes one, asks NumPy for C order: no array of a caller gets here otherwise.
        self.array.as_slice().expect("it was made contiguous")
    }

    /// Refuses the first number that is not `good`.
    pub(super) fn each(&self, good: impl Fn(f64) -> bool, allowed: &str) -> PyResult<()> {
        let values = self.values();
        let Some(mut place) = values.iter().position(|&x| !good(x)) else {
            return Ok(());
        };
        let found = values[place];
        let mut index: Vec<usize> = Vec::new();
        for &length in self.shape().iter().rev() {
            index.insert(0, place % length);
            place /= length;
        }
        let at = if index.is_empty() {
            String::new()
        } else {
            format!(" at {index:?}")
        };
        Err(wrong(self.name, format_args!("{found}{at}"), allowed))
    }

    /// Refuses another shape than one number for each of `count` particles.
    pub(super) fn one_each(&self, count: usize) -> PyResult<()> {
        if self.shape() == [count] {
            return Ok(());
        }
        Err(self.wrong_shape(&format!("({count},), one number per particle")))
    }

    /// Numbers per particle of an array of shape `(count,)` or `(count, columns)`.
    pub(super) fn columns(&self, count: usize) -> PyResult<usize> {
        match *self.shape() {
            [n] if n == count => Ok(1),
            [n, columns] if n == count => Ok(columns),
            _ => Err(self.wrong_shape(&format!("({count},) or ({count}, k), a row per particle"))),
        }
    }

    /// Refuses another shape than a vector for each of `count` particles.
    pub(super) fn vector_each(&self, count: usize, dimension: usize) -> PyResult<()> {
        if self.shape() == [count, dimension] {
            return Ok(());
        }
        Err(self.wrong_shape(&format!("({count}, {dimension}), a vector per particle")))
    }

    /// The error for its shape.
    pub(super) fn wrong_shape(&self, allowed: &str) -> PyErr {
        let lengths: Vec<String> = self.shape().iter().map(usize::to_string).collect();
        let comma = if lengths.len() == 1 { "," } else { "" };
        wrong(
            self.name,
            format_args!("shape ({}{comma})", lengths.join(", ")),
            allowed,
        )
    }
}

/// Positions, `(n, D)` with `D` 1, 2 or 3, of at most 2³² - 1 points.
pub(super) fn positions<'py>(
    name: &'static str,
    object: &Bound<'py, PyAny>,
) -> PyResult<(Numbers<'py>, usize)> {
    let numbers = Numbers::read(name, object)?;
    match *numbers.shape() {
        [n, dimension @ 1..=3] if u32::try_from(n).is_ok() => Ok((numbers, dimension)),
        [n, 1..=3] => Err(wrong(
            name,
            format_args!("{n} points"),
            "at most 4294967295 points",
        )),
        _ => Err(numbers.wrong_shape("(n, D) with D = 1, 2 or 3: a row per point")),
    }
}

/// One finite number.
pub(super) fn number(name: &str, object: &Bound<'_, PyAny>) -> PyResult<f64> {
    let found: f64 = object
        .extract()
        .map_err(|_| wrong(name, kind_of(object), "one number"))?;
    if found.is_finite() {
        Ok(found)
    } else {
        Err(wrong(name, found, "a finite number"))
    }
}

/// One positive number.
pub(super) fn positive(name: &str, object: &Bound<'_, PyAny>) -> PyResult<f64> {
    let found = number(name, object)?;
    if found > 0.0 {
        Ok(found)
    } else {
        Err(wrong(name, found, "a positive number"))
    }
}

/// One length, whose square must be a number, too: neither zero nor infinite.
pub(super) fn length(name: &str, object: &Bound<'_, PyAny>) -> PyResult<f64> {
    let found = positive(name, object)?;
    if (1e-150..=1e150).contains(&found) {
        Ok(found)
    } else {
        let found = format_args!("{found:e}");
        Err(wrong(name, found, "a length from 1e-150 to 1e150"))
    }
}

/// One number, zero or positive.
pub(super) fn not_negative(name: &str, object: &Bound<'_, PyAny>) -> PyResult<f64> {
    let found = number(name, object)?;
    if found >= 0.0 {
        Ok(found)
    } else {
        Err(wrong(name, found, "zero or a positive number"))
    }
}

/// One of a few words; the first where none is given.
pub(super) fn word(
    name: &str,
    object: Option<&Bound<'_, PyAny>>,
    allowed: &[&str],
) -> PyResult<String> {
    let Some(object) = object else {
        return Ok(allowed[0].to_owned());
    };
    let list = allowed.join(", ");
    let found: String = object
        .extract()
        .map_err(|_| wrong(name, kind_of(object), &list))?;
    if allowed.contains(&found.as_str()) {
        return Ok(found);
    }
    Err(wrong(name, format_args!("{found:?}"), &list))
}

/// A kernel's name; the default kernel where none is given.
pub(super) fn kernel_name(name: &str, object: Option<&Bound<'_, PyAny>>) -> PyResult<KernelName> {
    let Some(object) = object else {
        return Ok(KernelName::default());
    };
    let found = word(name, Some(object), &KernelName::ALL.map(KernelName::as_str))?;
    found
        .parse()
        .map_err(|unknown| wrong(name, unknown, "a kernel's name"))
}

/// One number where it is given, else `default`.
pub(super) fn or(
    default: f64,
    name: &str,
    object: Option<&Bound<'_, PyAny>>,
    read: fn(&str, &Bound<'_, PyAny>) -> PyResult<f64>,
) -> PyResult<f64> {
    object.map_or(Ok(default), |object| read(name, object))
}

/// Ends of the periodic axes: `None`, or for each axis `None` or a pair at least two radii apart.
pub(super) fn periods(
    object: Option<&Bound<'_, PyAny>>,
    dimension: usize,
    radius: f64,
) -> PyResult<[Option<[f64; 2]>; 3]> {
    const NAME: &str = "periodic";
    let mut periods = [None; 3];
    let Some(object) = object else {
        return Ok(periods);
    };
    let allowed = format!("None, or a sequence of {dimension}: for each axis None or (low, high)");
    let axes: Vec<Option<Bound<'_, PyAny>>> = object
        .extract()
        .map_err(|_| wrong(NAME, kind_of(object), &allowed))?;
    if axes.len() != dimension {
        return Err(wrong(NAME, format_args!("{} axes", axes.len()), &allowed));
    }
    for (axis, ends) in axes.into_iter().enumerate() {
        let Some(ends) = ends else { continue };
        let [low, high]: [f64; 2] = ends.extract().map_err(|_| {
            wrong(
                NAME,
                format_args!("{} for axis {axis}", kind_of(&ends)),
                &allowed,
            )
        })?;
        if !(low.is_finite() && high.is_finite() && high - low >= 2.0 * radius) {
            let found = format!("({low}, {high}) for axis {axis}");
            let allowed = format!(
                "finite ends, high - low at least {} (two search radii, so that no particle meets two images of another)",
                2.0 * radius
            );
            return Err(wrong(NAME, found, &allowed));
        }
        periods[axis] = Some([low, high]);
    }
    Ok(periods)
}

/// What an argument is that is not what it should be.
pub(super) fn kind_of(object: &Bound<'_, PyAny>) -> String {
    if object.is_none() {
        return "None".to_owned();
    }
    let kind = object
        .get_type()
        .name()
        .map_or_else(|_| "unknown".to_owned(), |k| k.to_string());
    format!("an object of type {kind}")
}

/// The particles that an operator sums over, as given.
pub(super) struct Particles<'py> {
    position: Numbers<'py>,
    mass: Numbers<'py>,
    density: Numbers<'py>,
    pub(super) dimension: usize,
    pub(super) count: usize,
    h: f64,
    kernel: KernelName,
    periods: [Option<[f64; 2]>; 3],
}

impl<'py> Particles<'py> {
    pub(super) fn read(
        position: &Bound<'py, PyAny>,
        mass: &Bound<'py, PyAny>,
        density: &Bound<'py, PyAny>,
        h: &Bound<'py, PyAny>,
        kernel: Option<&Bound<'py, PyAny>>,
        periodic: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Self> {
        let (position, dimension) = positions("position", position)?;
        let count = position.shape()[0];
        let mass = Numbers::read("mass", mass)?;
        mass.one_each(count)?;
        mass.each(|m| m >= 0.0, "zero or positive masses [kg]")?;
        let density = Numbers::read("density", density)?;
        density.one_each(count)?;
        density.each(|rho| rho > 0.0, "positive densities")?;
        let h = length("h", h)?;
        let kernel = kernel_name("kernel", kernel)?;
        let periods = periods(periodic, dimension, kernel.support() * h)?;
        Ok(Self {
            position,
            mass,
            density,
            dimension,
            count,
            h,
            kernel,
            periods,
        })
    }

    /// Support radius [m].
    pub(super) fn radius(&self) -> f64 {
        self.kernel.support() * self.h
    }

    /// What may cross to where the interpreter is released.
    pub(super) fn columns(&self) -> Columns<'_> {
        Columns {
            position: self.position.values(),
            mass: self.mass.values(),
            density: self.density.values(),
            h: self.h,
            kernel: self.kernel,
            periods: self.periods,
        }
    }
}

/// Checked particles without a tie to the interpreter.
#[derive(Clone, Copy)]
pub(super) struct Columns<'a> {
    position: &'a [f64],
    mass: &'a [f64],
    density: &'a [f64],
    h: f64,
    kernel: KernelName,
    periods: [Option<[f64; 2]>; 3],
}

impl<'a> Columns<'a> {
    /// Sorted for sums.
    pub(super) fn cloud<const D: usize>(self) -> Cloud<'a, D> {
        let (position, periods) = (vectors(self.position), first(&self.periods));
        Cloud::new(
            position,
            self.mass,
            self.density,
            self.kernel,
            self.h,
            &periods,
        )
    }
}

/// Rows of `D` numbers.
pub(super) fn vectors<const D: usize>(values: &[f64]) -> &[[f64; D]] {
    values.as_chunks::<D>().0
}

/// The periods of the axes that there are.
pub(super) fn first<const D: usize>(periods: &[Option<[f64; 2]>; 3]) -> Periods<D> {
    std::array::from_fn(|a| periods[a])
}
