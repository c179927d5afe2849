//! A scene made ready for rays, within the memory there is.

use std::sync::Arc;

use phong::geometry::{Geometry, GeometryError, GeometryOptions};
use phong::look::Look;
use phong::view::{View, ViewError};
use phong_scene::{Diagnostic, Place, Scene, Span};

use crate::args::InputArgs;
use crate::failure::Failure;
use crate::memory;
use crate::report::readable;

/// Makes a scene ready beside which `beside` bytes of memory are needed for something else.
pub(crate) fn compile(scene: &Scene, args: &InputArgs, beside: u64) -> Result<View, Failure> {
    let limit = Some(memory::limit()).filter(|&limit| limit < u64::MAX);
    let over = |needed: u64, limit: u64| {
        let (needed, limit) = (readable(needed), readable(limit));
        let message = format!("this needs about {needed} of memory, over the limit of {limit}");
        Failure::usage(message).with_help(if memory::is_said() {
            "allow more with --max-memory, or render a smaller picture"
        } else {
            "there is no more in this machine; render a smaller picture, or a --crop of it"
        })
    };
    if let Some(limit) = limit.filter(|&limit| beside > limit) {
        return Err(over(beside, limit));
    }
    let max_bytes = limit.map(|limit| limit - beside);
    let options = GeometryOptions { max_bytes, ..GeometryOptions::of(scene) };
    let geometry = Geometry::new(scene, options).map_err(ViewError::from);
    let view = geometry.and_then(|geometry| View::new(Arc::new(geometry), Look::new(scene)));
    view.map_err(|error| match error {
        ViewError::Geometry(GeometryError::Memory { needed, limit }) => {
            over(needed + beside, limit + beside)
        }
        error => {
            let place = Place { file: args.input.as_str().into(), ..Place::default() };
            let span = Span { place, ..Span::default() };
            Failure::Input(vec![Diagnostic::error(error.to_string(), span)])
        }
    })
}
