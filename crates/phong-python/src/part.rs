//! `phong.Part`: what an `add_…` has added to a scene.

use pyo3::prelude::*;

/// A part of a scene: what an `add_…` has added.
#[pyclass(module = "phong", frozen, eq, hash, from_py_object)]
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Part {
    pub(crate) number: u64,
    pub(crate) name: String,
}

#[pymethods]
impl Part {
    #[new]
    fn new(number: u64, name: String) -> Self {
        Self { number, name }
    }

    /// What `explain` calls it.
    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    fn __repr__(&self) -> String {
        format!("<phong.Part {:?}>", self.name)
    }

    fn __reduce__(slf: &Bound<'_, Self>) -> (Py<PyAny>, (u64, String)) {
        let this = slf.get();
        (slf.get_type().into_any().unbind(), (this.number, this.name.clone()))
    }
}
