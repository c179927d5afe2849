//! What went wrong, as the exceptions of the Python package: its classes live in `phong._errors`.

use phong::geometry::GeometryError;
use phong::view::ViewError;
use phong_scene::Diagnostic;
use pyo3::exceptions::{
    PyFileNotFoundError, PyIsADirectoryError, PyMemoryError, PyOSError, PyPermissionError,
    PyRuntimeError, PyTypeError, PyValueError,
};
use pyo3::prelude::*;
use pyo3::types::PyList;

/// The module that the exceptions are defined in.
fn classes(py: Python<'_>) -> PyResult<Bound<'_, PyModule>> {
    py.import("phong._errors")
}

/// One diagnostic, as `phong.Diagnostic`.
pub(crate) fn diagnostic<'py>(
    py: Python<'py>,
    diagnostic: &Diagnostic,
) -> PyResult<Bound<'py, PyAny>> {
    let severity = diagnostic.severity.word();
    let place = diagnostic.span.as_ref().map(|span| &span.place);
    let file = place.map(|place| &*place.file).filter(|file| !file.is_empty());
    let number = |number: u32| (number > 0).then_some(number);
    let line = place.and_then(|place| number(place.line));
    let column = place.and_then(|place| number(place.column));
    let help = diagnostic.help.as_deref();
    classes(py)?.getattr("Diagnostic")?.call1((
        severity,
        &diagnostic.message,
        file,
        line,
        column,
        help,
    ))
}

/// Several of them, as a list.
pub(crate) fn diagnostics<'py>(
    py: Python<'py>,
    all: &[Diagnostic],
) -> PyResult<Bound<'py, PyList>> {
    let all: Vec<_> = all.iter().map(|one| diagnostic(py, one)).collect::<PyResult<_>>()?;
    PyList::new(py, all)
}

/// `phong.SceneError`, with all there is to say.
pub(crate) fn scene_error(py: Python<'_>, all: &[Diagnostic]) -> PyErr {
    let made = || -> PyResult<PyErr> {
        let message = all.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n");
        let error = classes(py)?.getattr("SceneError")?;
        Ok(PyErr::from_value(error.call1((message, diagnostics(py, all)?))?))
    };
    made().unwrap_or_else(|error| error)
}

/// `phong.Cancelled`.
pub(crate) fn cancelled(py: Python<'_>) -> PyErr {
    let made = || -> PyResult<PyErr> {
        Ok(PyErr::from_value(
            classes(py)?.getattr("Cancelled")?.call1(("the work was cancelled",))?,
        ))
    };
    made().unwrap_or_else(|error| error)
}

/// Why a scene is none that can be looked at.
pub(crate) fn view_error(py: Python<'_>, error: &ViewError) -> PyErr {
    match error {
        ViewError::Geometry(GeometryError::Scene(all)) | ViewError::Look(all) => {
            scene_error(py, all)
        }
        ViewError::Geometry(GeometryError::Memory { needed, limit }) => PyMemoryError::new_err(
            format!("the scene needs about {needed} bytes, over the limit of {limit}"),
        ),
        other => scene_error(py, &[Diagnostic::error(other.to_string(), None)]),
    }
}

/// A value that cannot be meant.
pub(crate) fn value_error(message: impl Into<String>) -> PyErr {
    PyValueError::new_err(message.into())
}

/// A value of a type that nothing can be made of.
pub(crate) fn type_error(message: impl Into<String>) -> PyErr {
    PyTypeError::new_err(message.into())
}

/// Something that is no argument's fault.
pub(crate) fn runtime_error(message: impl Into<String>) -> PyErr {
    PyRuntimeError::new_err(message.into())
}

/// A file that cannot be read; `what` names it.
pub(crate) fn unreadable(what: &str, error: &std::io::Error) -> PyErr {
    let message = format!("{what}: {}", phong_scene::trouble(error));
    match error.kind() {
        std::io::ErrorKind::NotFound => PyFileNotFoundError::new_err(message),
        std::io::ErrorKind::PermissionDenied => PyPermissionError::new_err(message),
        std::io::ErrorKind::IsADirectory => PyIsADirectoryError::new_err(message),
        _ => PyOSError::new_err(message),
    }
}

/// What the system says of a file.
pub(crate) fn os_error(message: impl Into<String>) -> PyErr {
    PyOSError::new_err(message.into())
}

/// More memory than there is.
pub(crate) fn memory_error(message: impl Into<String>) -> PyErr {
    PyMemoryError::new_err(message.into())
}

/// What a value is, for "…, not a list".
pub(crate) fn kind_of(value: &Bound<'_, PyAny>) -> String {
    value.get_type().name().map_or_else(|_| "object".to_owned(), |name| name.to_string())
}
