//! `kolk._core.Simulation`: the engine behind Python's `kolk.Simulation`.

use crate::error::Error;
use crate::particles::Given;
use crate::simulation::{
    BodyInput, Config, Entry, Precision, Progress, Simulation, SurfaceInput, Trouble,
};
use crate::step::Limit;
use numpy::{
    PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3,
    PyUntypedArrayMethods,
};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::time::Duration;

pyo3::import_exception!(kolk.errors, KolkError);
pyo3::import_exception!(kolk.errors, SceneError);
pyo3::import_exception!(kolk.errors, InstabilityError);

/// How long a call computes before it looks for Ctrl-C.
const PATIENCE: Duration = Duration::from_millis(50);

/// The Python exception of an engine's error; each error is turned in this one place.
fn raise(py: Python<'_>, error: Error) -> PyErr {
    match error {
        Error::Input(message) => SceneError::new_err(message),
        Error::Instability(what) => {
            let exception = InstabilityError::new_err(what.to_string());
            let value = exception.value(py);
            let set = || -> PyResult<()> {
                value.setattr("time", what.time)?;
                value.setattr("step", what.step)?;
                value.setattr("particle", what.particle)?;
                value.setattr("position", what.position.clone())?;
                value.setattr("quantity", what.quantity)?;
                value.setattr("value", what.value)?;
                value.setattr("cause", what.cause.clone())?;
                value.setattr("remedy", what.remedy.clone())
            };
            match set() {
                Ok(()) => exception,
                Err(other) => other,
            }
        }
    }
}

/// `name, kind, position, velocity, density, mass` of a body.
type BodyArrays<'py> = (
    String,
    String,
    PyReadonlyArray2<'py, f64>,
    PyReadonlyArray2<'py, f64>,
    PyReadonlyArray1<'py, f64>,
    PyReadonlyArray1<'py, f64>,
);

/// Rotation and displacement of a body.
type Pose<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray1<f64>>);

/// A simulation in Rust; see `kolk.Simulation`.
#[pyclass(name = "Simulation", module = "kolk._core")]
pub(super) struct PySimulation(Simulation);

#[pymethods]
impl PySimulation {
    /// `surfaces`: the name of a wall, and its facets (m, D, D).
    #[new]
    #[pyo3(signature = (config_json, bodies, precision, threads, surfaces=Vec::new()))]
    fn new(
        py: Python<'_>,
        config_json: &str,
        bodies: Vec<BodyArrays<'_>>,
        precision: &str,
        threads: usize,
        surfaces: Vec<(String, PyReadonlyArray3<'_, f64>)>,
    ) -> PyResult<Self> {
        let config: Config = serde_json::from_str(config_json)
            .map_err(|e| SceneError::new_err(format!("config: {e}")))?;
        let precision = match precision {
            "f64" => Precision::F64,
            "mixed" => Precision::Mixed,
            other => {
                return Err(SceneError::new_err(format!(
                    "precision: found {other:?}, allowed are \"f64\" and \"mixed\""
                )));
            }
        };
        let mut inputs = Vec::with_capacity(bodies.len());
        for (name, kind, position, velocity, density, mass) in bodies {
            for (array, found) in [
                ("position", position.shape()[1]),
                ("velocity", velocity.shape()[1]),
            ] {
                if found != config.dimension {
                    return Err(SceneError::new_err(format!(
                        "{name}.{array}: found {found} components, the scene has {}",
                        config.dimension
                    )));
                }
            }
            let fluid = match kind.as_str() {
                "fluid" => true,
                "wall" => false,
                other => {
                    return Err(SceneError::new_err(format!(
                        "{name}: found kind {other:?}, allowed are \"fluid\" and \"wall\""
                    )));
                }
            };
            let particles = Given {
                position: position.as_array().iter().copied().collect(),
                velocity: velocity.as_array().iter().copied().collect(),
                density: density.as_array().iter().copied().collect(),
                mass: mass.as_array().iter().copied().collect(),
            };
            inputs.push(BodyInput {
                name,
                fluid,
                particles,
            });
        }
        let surfaces: Vec<SurfaceInput> = surfaces
            .into_iter()
            .map(|(body, corners)| SurfaceInput {
                body,
                corners: corners.as_array().iter().copied().collect(),
            })
            .collect();
        py.detach(|| Simulation::with_surfaces(config, inputs, &surfaces, precision, threads))
            .map(PySimulation)
            .map_err(|e| raise(py, e))
    }

    /// Steps to `time` exactly; the interpreter runs other threads meanwhile, and Ctrl-C stops between two steps.
    #[pyo3(signature = (time, max_steps=None))]
    fn advance_to(&mut self, py: Python<'_>, time: f64, max_steps: Option<u64>) -> PyResult<u64> {
        if !time.is_finite() {
            return Err(KolkError::new_err(format!(
                "time: found {time}, allowed is a finite number of seconds"
            )));
        }
        let mut left = max_steps.unwrap_or(u64::MAX);
        let mut done = 0;
        loop {
            let result = py.detach(|| self.0.advance(time, left, PATIENCE));
            let (steps, progress) = result.map_err(|e| raise(py, e))?;
            done += steps;
            left -= steps;
            py.check_signals()?;
            if progress != Progress::Paused {
                return Ok(done);
            }
        }
    }

    #[getter]
    fn time(&self) -> f64 {
        self.0.status().time
    }
    #[getter]
    fn step_count(&self) -> u64 {
        self.0.status().step
    }
    #[getter]
    fn time_step(&self) -> f64 {
        self.0.status().time_step
    }
    #[getter]
    fn limit(&self) -> &'static str {
        self.0.status().limit.name()
    }
    #[getter]
    fn dimension(&self) -> usize {
        self.0.dimension()
    }
    #[getter]
    fn particles<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let status = self.0.status();
        let dict = PyDict::new(py);
        dict.set_item("fluid", status.fluid)?;
        dict.set_item("wall", status.wall)?;
        Ok(dict)
    }
    #[getter]
    fn threads(&self) -> usize {
        self.0.threads()
    }
    #[getter]
    fn precision(&self) -> &'static str {
        match self.0.precision() {
            Precision::F64 => "f64",
            Precision::Mixed => "mixed",
        }
    }
    /// Whether the flow has been faster than a tenth of the speed of sound by more than half.
    #[getter]
    fn mach_warning(&self) -> bool {
        self.0.status().mach_max > 0.15
    }

    fn body<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyDict>> {
        let state = py.detach(|| self.0.body(name)).map_err(|e| raise(py, e))?;
        let n = state.mass.len();
        let dict = PyDict::new(py);
        dict.set_item("position", self.vectors(py, state.position)?)?;
        dict.set_item("velocity", self.vectors(py, state.velocity)?)?;
        dict.set_item("density", PyArray1::from_vec(py, state.density))?;
        dict.set_item("pressure", PyArray1::from_vec(py, state.pressure))?;
        dict.set_item("mass", PyArray1::from_vec(py, state.mass))?;
        dict.set_item("id", PyArray1::from_iter(py, 0..n as i64))?;
        Ok(dict)
    }

    /// The whole state, name to array.
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for (name, entry) in py.detach(|| self.0.save()) {
            match entry {
                Entry::Reals(v) => dict.set_item(name, PyArray1::from_vec(py, v))?,
                Entry::Integers(v) => dict.set_item(name, PyArray1::from_vec(py, v))?,
            }
        }
        Ok(dict)
    }

    fn restore(&mut self, py: Python<'_>, state: &Bound<'_, PyDict>) -> PyResult<()> {
        let mut entries = Vec::with_capacity(state.len());
        for (name, value) in state {
            let name: String = name.extract()?;
            let entry = if let Ok(v) = value.extract::<PyReadonlyArray1<'_, f64>>() {
                Entry::Reals(v.as_array().to_vec())
            } else if let Ok(v) = value.extract::<PyReadonlyArray1<'_, u64>>() {
                Entry::Integers(v.as_array().to_vec())
            } else {
                continue;
            };
            entries.push((name, entry));
        }
        py.detach(|| self.0.restore(&entries))
            .map_err(|e| raise(py, e))
    }

    fn diagnostics<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let d = py.detach(|| self.0.diagnostics());
        let dict = PyDict::new(py);
        dict.set_item("time", d.time)?;
        dict.set_item("kinetic_energy", d.kinetic_energy)?;
        dict.set_item("potential_energy", d.potential_energy)?;
        dict.set_item("compression_energy", d.compression_energy)?;
        dict.set_item("momentum", d.momentum)?;
        dict.set_item("angular_momentum", d.angular_momentum)?;
        dict.set_item("density_min", d.density_min)?;
        dict.set_item("density_max", d.density_max)?;
        dict.set_item("speed_max", d.speed_max)?;
        dict.set_item("mach", d.mach)?;
        dict.set_item("pressure_min", d.pressure_min)?;
        dict.set_item("pressure_max", d.pressure_max)?;
        dict.set_item("closest_pair", d.closest_pair)?;
        dict.set_item("crowded", d.crowded)?;
        dict.set_item("leaks", d.leaks)?;
        let dissipated = PyDict::new(py);
        for (name, energy) in d.dissipated {
            dissipated.set_item(name, energy)?;
        }
        dict.set_item("dissipated", dissipated)?;
        Ok(dict)
    }

    fn timings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for (name, seconds, calls) in self.0.timings() {
            let entry = PyDict::new(py);
            entry.set_item("seconds", seconds)?;
            entry.set_item("calls", calls)?;
            dict.set_item(name, entry)?;
        }
        Ok(dict)
    }

    fn steps_by_limit<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for (limit, steps) in Limit::ALL.iter().zip(self.0.status().steps_by_limit) {
            dict.set_item(limit.name(), steps)?;
        }
        Ok(dict)
    }

    /// What the guard did: how often each trouble made it go back or was let pass, and the steps taken back,
    /// and the time of the state kept.
    fn retries<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let record = self.0.status().retries;
        let (retries, passed) = (PyDict::new(py), PyDict::new(py));
        for trouble in Trouble::ALL {
            retries.set_item(trouble.name(), record.retries[trouble as usize])?;
            passed.set_item(trouble.name(), record.passed[trouble as usize])?;
        }
        let dict = PyDict::new(py);
        dict.set_item("retries", retries)?;
        dict.set_item("passed", passed)?;
        dict.set_item("undone", record.undone)?;
        dict.set_item("kept", self.0.status().kept)?;
        Ok(dict)
    }

    fn sample<'py>(
        &self,
        py: Python<'py>,
        points: PyReadonlyArray2<'py, f64>,
        fields: Vec<String>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let dimension = self.0.dimension();
        if points.shape()[1] != dimension {
            return Err(KolkError::new_err(format!(
                "points: found {} components, the simulation has {dimension}",
                points.shape()[1]
            )));
        }
        let points: Vec<f64> = points.as_array().iter().copied().collect();
        let samples = py.detach(|| self.0.sample(&points));
        let dict = PyDict::new(py);
        for field in fields {
            match field.as_str() {
                "pressure" => dict.set_item(&field, PyArray1::from_slice(py, &samples.pressure))?,
                "density" => dict.set_item(&field, PyArray1::from_slice(py, &samples.density))?,
                "fill" => dict.set_item(&field, PyArray1::from_slice(py, &samples.fill))?,
                "wall_fill" => {
                    dict.set_item(&field, PyArray1::from_slice(py, &samples.wall_fill))?
                }
                "velocity" => dict.set_item(&field, self.vectors(py, samples.velocity.clone())?)?,
                other => {
                    return Err(KolkError::new_err(format!(
                        "fields: found {other:?}, allowed are pressure, velocity, density, fill and wall_fill"
                    )));
                }
            }
        }
        Ok(dict)
    }

    fn force<'py>(&self, py: Python<'py>, body: &str) -> PyResult<Bound<'py, PyDict>> {
        let (force, moment) = py
            .detach(|| self.0.force_on(body))
            .map_err(|e| raise(py, e))?;
        let dict = PyDict::new(py);
        dict.set_item("force", PyArray1::from_vec(py, force))?;
        dict.set_item("moment", PyArray1::from_vec(py, moment))?;
        Ok(dict)
    }

    /// Rotation (D, D) and displacement (D,) of a wall since the start; `None` for one that does not move.
    fn pose<'py>(&self, py: Python<'py>, body: &str) -> PyResult<Option<Pose<'py>>> {
        let Some(pose) = self.0.pose(body).map_err(|e| raise(py, e))? else {
            return Ok(None);
        };
        let d = self.0.dimension();
        let turn = (0..d * d).map(|k| pose.turn[(k / d, k % d)]).collect();
        let offset = pose.offset.as_slice()[..d].to_vec();
        Ok(Some((
            self.vectors(py, turn)?,
            PyArray1::from_vec(py, offset),
        )))
    }

    fn memory<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for (name, bytes) in self.0.memory() {
            dict.set_item(name, bytes)?;
        }
        Ok(dict)
    }

    fn effects<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let list = PyList::empty(py);
        for effect in self.0.effects() {
            let entry = PyDict::new(py);
            entry.set_item("name", effect.name)?;
            entry.set_item("on", effect.on)?;
            entry.set_item("columns", effect.columns)?;
            entry.set_item("bytes_per_particle", effect.bytes_per_particle)?;
            entry.set_item("sweeps", effect.sweeps)?;
            entry.set_item("dt_limit", effect.limit.map(|l| l.name()))?;
            entry.set_item("dissipates", effect.dissipates)?;
            entry.set_item("source", effect.source)?;
            list.append(entry)?;
        }
        Ok(list)
    }
}

impl PySimulation {
    /// Flattened vectors as an array (n, D).
    fn vectors<'py>(&self, py: Python<'py>, flat: Vec<f64>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let dimension = self.0.dimension();
        let n = flat.len() / dimension;
        PyArray1::from_vec(py, flat).reshape([n, dimension])
    }
}
