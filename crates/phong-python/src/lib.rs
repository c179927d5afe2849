//! `phong._phong`: the extension module behind the Python package `phong`.
//!
//! It is thin: arrays are read into the renderer's own, everything else goes through the reader of
//! scene text, and the work is that of the crates below. What is pleasant to use is made of it in
//! `python/phong`.

mod arrays;
mod bulk;
mod content;
mod errors;
mod files;
mod image;
mod keys;
mod lab;
mod look;
mod part;
mod raw;
mod render;
mod scene;
mod state;
mod work;

/// The extension module.
#[pyo3::pymodule(gil_used = false)]
mod _phong {
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::image::{_image_of_part, Image, Joining, merge};
    #[pymodule_export]
    use crate::keys::check_keys;
    #[pymodule_export]
    use crate::lab::{_check, _compare, _convert, _evaluate, _figure, _figures, _fit, _grade};
    #[pymodule_export]
    use crate::part::Part;
    #[pymodule_export]
    use crate::render::{_compile, _explain, _render, _render_part, _tiles, Token};
    #[pymodule_export]
    use crate::scene::Scene;

    /// What the module has beside functions and classes.
    #[pymodule_init]
    fn fill(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }

    /// The program: does what a command line asks for, and gives its exit code.
    #[pyfunction]
    fn main(py: Python<'_>, args: Vec<std::ffi::OsString>) -> u8 {
        py.detach(|| phong_cli::main(args))
    }

    /// Every key of a scene text as a JSON schema.
    #[pyfunction]
    fn schema() -> String {
        phong_scene::schema_json()
    }

    /// The version of the arithmetic: pictures of two versions may differ in bits.
    #[pyfunction]
    fn arithmetic() -> u32 {
        phong::part::ARITHMETIC
    }
}
