//! A scene made ready for rays, within the memory there is.

use std::sync::Arc;

use phong::geometry::{Geometry, GeometryError, GeometryOptions};
use phong::look::Look;
use phong::view::{View, ViewError};
use phong_scene::{Diagnostic, Place, Scene, Span};

use crate::args::InputArgs;
use crate::failure::Failure;
use crate::memory;

/// Makes a scene ready beside which `beside` bytes of memory are needed for something else.
pub(crate) fn compile(scene: &Scene, args: &InputArgs, beside: u64) -> Result<View, Failure> {
    compile_for(1, scene, args, beside)
}

/// The same for so many pictures, which are worth more time for building.
pub(crate) fn compile_for(
    pictures: u32,
    scene: &Scene,
    args: &InputArgs,
    beside: u64,
) -> Result<View, Failure> {
    memory::want(beside)?;
    let limit = Some(memory::limit()).filter(|&limit| limit < u64::MAX);
    let max_bytes = limit.map(|limit| limit - beside);
    let options = GeometryOptions::of(scene);
    let rays = options.rays.saturating_mul(pictures.into());
    let options = GeometryOptions { max_bytes, rays, ..options };
    let geometry = Geometry::new(scene, options).map_err(ViewError::from);
    let view = geometry.and_then(|geometry| View::new(Arc::new(geometry), Look::new(scene)));
    view.map_err(|error| failure(error, args, beside))
}

/// Makes a scene ready that differs from an earlier one in some objects: what is the same is not built
/// again.
pub(crate) fn compile_again(
    earlier: &View,
    scene: &Scene,
    args: &InputArgs,
) -> Result<View, Failure> {
    let geometry = earlier.geometry().update(scene).map_err(ViewError::from);
    let view = geometry.and_then(|geometry| View::new(Arc::new(geometry), Look::new(scene)));
    view.map_err(|error| failure(error, args, 0))
}

/// Why a scene cannot be made ready.
fn failure(error: ViewError, args: &InputArgs, beside: u64) -> Failure {
    match error {
        ViewError::Geometry(GeometryError::Memory { needed, limit }) => {
            memory::over(needed + beside, limit + beside)
        }
        error => {
            let place = Place { file: args.input.as_str().into(), ..Place::default() };
            let span = Span { place, ..Span::default() };
            Failure::Input(vec![Diagnostic::error(error.to_string(), span)])
        }
    }
}
